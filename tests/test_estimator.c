// The Kalman filter that controllers use.
#include "src/rig/estimation/estimator.h"
#include "tests/rig_fixture.h"

TEST(estimator_finds_a_constant)
{
    estimator e = {.z = {0}, .p = {{4}}};
    const double row[4] = {2};
    for (int i = 0; i < 100; i++) {
        estimator_correct(&e, 1, row, 1, 7 + (i % 2 ? 0.1 : -0.1), 0.01);
    }
    check_close(e.z[0], 3, 1e-3);
    // variance of the mean of 100 readings of 2 z
    check_relative(e.p[0][0], 0.01 / 4 / 100, 1e-3);
}

// Arrays have room for the most states; those that a model does not use neither count nor
// change.
TEST(states_beyond_the_model_are_left_alone)
{
    enum { STATES = 2, ALL = ESTIMATOR_STATES };
    const double nothing = (double)NAN;
    double rate[ALL][ALL] = {{0, 1}, {-4, -0.1}}, input[ALL] = {0, 2},
           row[ALL] = {1, 0.5};
    double noise[ALL] = {1e-3, 2e-3};
    sampled_model plain, m;
    sampled_model_init(&plain, STATES, rate, input, 0.01);
    for (int i = STATES; i < ALL; i++) {
        input[i] = row[i] = noise[i] = nothing;
        for (int j = 0; j < ALL; j++) {
            rate[i][j] = rate[j][i] = nothing;
        }
    }
    sampled_model_init(&m, STATES, rate, input, 0.01);

    // two filters, one of which has numbers in the place of missing states
    estimator one = {.z = {1, -1}, .p = {{2, 0.1}, {0.1, 3}}}, other = one;
    for (int i = STATES; i < ALL; i++) {
        other.z[i] = other.p[i][i] = other.p[i][0] = other.p[0][i] = 7;
    }
    estimator_predict(&one, &plain, 0.3, noise);
    estimator_correct(&one, STATES, row, 0.2, 1.5, 0.04);
    estimator_predict(&other, &m, 0.3, noise);
    estimator_correct(&other, STATES, row, 0.2, 1.5, 0.04);
    for (int i = 0; i < ALL; i++) {
        const bool used = i < STATES;
        check_close(other.z[i], used ? one.z[i] : 7, 0);
        check_close(other.p[i][i], used ? one.p[i][i] : 7, 0);
        check_close(other.p[i][0], used ? one.p[i][0] : 7, 0);
        check_close(other.p[0][i], used ? one.p[0][i] : 7, 0);
    }
}

// x'' = -w^2 x + u over h: both parts in closed form.
TEST(a_sampled_oscillator_has_its_closed_form)
{
    const double w = 12, h = 0.02, c = cos(w * h), s = sin(w * h);
    double rate[ESTIMATOR_STATES][ESTIMATOR_STATES] = {{0, 1}, {-w * w, 0}};
    double input[ESTIMATOR_STATES] = {0, 1};
    sampled_model m;
    sampled_model_init(&m, 2, rate, input, h);
    check_close(m.a[0][0], c, 1e-14);
    check_close(m.a[0][1], s / w, 1e-15);
    check_close(m.a[1][0], -w * s, 1e-12);
    check_close(m.a[1][1], c, 1e-14);
    check_close(m.b[0], (1 - c) / (w * w), 1e-16);
    check_close(m.b[1], s / w, 1e-15);
}

// Any model of any number of states does what the matrices say; what lies behind its
// states is NaN everywhere and reaches nothing.
TEST(any_model_follows_its_matrices)
{
    enum { ALL = ESTIMATOR_STATES };
    random_generator g = seeded(4);
    for (int n = 1; n <= ALL; n++) {
        const double nothing = (double)NAN;
        double rate[ALL][ALL], input[ALL], row[ALL], noise[ALL];
        estimator e;
        for (int i = 0; i < ALL; i++) {
            const bool own = i < n;
            input[i] = own ? random_uniform(&g) - 0.5 : nothing;
            row[i] = own ? random_uniform(&g) - 0.5 : nothing;
            noise[i] = own ? 0.1 * random_uniform(&g) : nothing;
            e.z[i] = own ? random_uniform(&g) - 0.5 : nothing;
            for (int j = 0; j < ALL; j++) {
                rate[i][j] = own && j < n ? 4 * random_uniform(&g) - 2 : nothing;
                e.p[i][j] = own && j < n ? random_uniform(&g) + 2 * (i == j) : nothing;
            }
        }

        // the sampled model by many small steps of the midpoint rule in time
        sampled_model m;
        sampled_model_init(&m, n, rate, input, 0.25);
        for (int from = 0; from <= n; from++) {
            double x[ALL] = {0};
            x[from < n ? from : 0] = from < n;
            const double u = from == n;
            for (int step = 0; step < 2000; step++) {
                double half[ALL], slope[ALL];
                for (int pass = 0; pass < 2; pass++) {
                    for (int i = 0; i < n; i++) {
                        slope[i] = input[i] * u;
                        for (int j = 0; j < n; j++) {
                            slope[i] += rate[i][j] * (pass == 0 ? x[j] : half[j]);
                        }
                    }
                    for (int i = 0; i < n; i++) {
                        half[i] = x[i] + slope[i] * 0.25 / 4000;
                    }
                }
                for (int i = 0; i < n; i++) {
                    x[i] += slope[i] * 0.25 / 2000;
                }
            }
            for (int i = 0; i < n; i++) {
                check_close(from < n ? m.a[i][from] : m.b[i], x[i], 2e-6);
            }
        }

        // one step ahead
        estimator next = e;
        estimator_predict(&next, &m, 0.7, noise);
        for (int i = 0; i < n; i++) {
            double z = 0.7 * m.b[i];
            for (int j = 0; j < n; j++) {
                double spread = i == j ? noise[i] : 0;
                z += m.a[i][j] * e.z[j];
                for (int k = 0; k < n; k++) {
                    for (int l = 0; l < n; l++) {
                        spread += m.a[i][k] * e.p[k][l] * m.a[j][l];
                    }
                }
                check_close(next.p[i][j], spread, 1e-13);
            }
            check_close(next.z[i], z, 1e-14);
        }

        // one reading; p need not be symmetric for the formula
        estimator seen = e;
        double expected = 0.2, total = 0.3, gain[ALL] = {0};
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < n; j++) {
                gain[i] += e.p[i][j] * row[j];
            }
            expected += row[i] * e.z[i];
            total += row[i] * gain[i];
        }
        estimator_correct(&seen, n, row, 0.2, 1.4, 0.3);
        for (int i = 0; i < n; i++) {
            check_close(seen.z[i], e.z[i] + gain[i] * (1.4 - expected) / total, 1e-13);
            for (int j = 0; j < n; j++) {
                check_close(seen.p[i][j], e.p[i][j] - gain[i] * gain[j] / total, 1e-13);
            }
        }
        for (int i = n; i < ALL; i++) {
            assert_true(isnan(next.z[i]) && isnan(seen.z[i]));
        }
    }
}

// Another view of any number of states is that of the matrices; what lies behind either
// view is NaN before and nothing after.
TEST(another_view_is_that_of_its_matrix)
{
    enum { ALL = ESTIMATOR_STATES };
    random_generator g = seeded(6);
    for (int from = 1; from <= ALL; from++) {
        for (int to = 1; to <= ALL; to++) {
            double t[ALL][ALL];
            estimator e, seen;
            for (int i = 0; i < ALL; i++) {
                e.z[i] = i < from ? random_uniform(&g) : (double)NAN;
                for (int j = 0; j < ALL; j++) {
                    e.p[i][j] = i < from && j < from ? random_uniform(&g) : (double)NAN;
                    t[i][j] = i < to && j < from ? random_uniform(&g) - 0.5 : (double)NAN;
                }
            }
            seen = e;
            estimator_transform(&seen, from, to, t);
            for (int i = 0; i < ALL; i++) {
                double z = 0;
                for (int k = 0; i < to && k < from; k++) {
                    z += t[i][k] * e.z[k];
                }
                check_close(seen.z[i], z, 1e-14);
                for (int j = 0; j < ALL; j++) {
                    double spread = 0;
                    for (int k = 0; i < to && j < to && k < from * from; k++) {
                        spread +=
                            t[i][k / from] * e.p[k / from][k % from] * t[j][k % from];
                    }
                    check_close(seen.p[i][j], spread, 1e-13);
                }
            }
        }
    }
}
