// The Kalman filter that controllers use.
#include "src/rig/estimation/estimator.h"
#include "tests/rig_fixture.h"

TEST(estimator_finds_a_constant)
{
    estimator e = {.z = {0}, .p = {{4}}};
    const double row[4] = {2};
    for (int i = 0; i < 100; i++) {
        const estimator_view view = estimator_look(&e, 1, row, 1);
        estimator_correct(&e, 1, &view, 7 + (i % 2 ? 0.1 : -0.1), 0.01);
    }
    check_close(e.z[0], 3, 1e-3);
    // variance of the mean of 100 readings of 2 z
    check_relative(e.p[0][0], 0.01 / 4 / 100, 1e-3);
}

// Arrays have room for the most states; those that a model does not use neither count nor
// change.
TEST(states_beyond_the_model_are_left_alone)
{
    enum { STATES = 3, ALL = ESTIMATOR_STATES };
    const double nothing = (double)NAN;
    const modal_motion mode = {1, (double[]){4}, (double[]){0.1}, (double[]){2}, 0.3};
    double row[ALL] = {1, 0.5, 0.2}, noise[ALL] = {1e-3, 2e-3, 3e-3};
    modal_model m;
    modal_model_init(&m, &mode, 0.01);
    for (int i = STATES; i < ALL; i++) {
        row[i] = noise[i] = nothing;
    }

    estimator e = {.z = {1, -1, 0.2}, .p = {{2, 0.1}, {0.1, 3}, {0, 0, 1}}};
    for (int i = STATES; i < ALL; i++) {
        e.z[i] = e.p[i][i] = e.p[i][0] = e.p[0][i] = 7;
    }
    estimator_predict(&e, STATES, &m, 0.3, noise);
    const estimator_view view = estimator_look(&e, STATES, row, 0.2);
    estimator_correct(&e, STATES, &view, 1.5, 0.04);
    for (int i = 0; i < ALL; i++) {
        const bool used = i < STATES;
        assert_true(isfinite(e.z[i]) && isfinite(e.p[i][i]));
        if (!used) {
            check_close(e.z[i], 7, 0);
            check_close(e.p[i][i], 7, 0);
            check_close(e.p[i][0], 7, 0);
            check_close(e.p[0][i], 7, 0);
        }
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
        double rate[ALL][ALL], input[ALL], row[ALL];
        estimator e;
        for (int i = 0; i < ALL; i++) {
            const bool own = i < n;
            input[i] = own ? random_uniform(&g) - 0.5 : nothing;
            row[i] = own ? random_uniform(&g) - 0.5 : nothing;
            e.z[i] = own ? random_uniform(&g) - 0.5 : nothing;
            for (int j = 0; j < ALL; j++) {
                rate[i][j] = own && j < n ? 4 * random_uniform(&g) - 2 : nothing;
                e.p[i][j] = own && j < n ? random_uniform(&g) + 2 * (i == j) : nothing;
                if (j < i) {
                    e.p[i][j] = e.p[j][i];
                }
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

        // one reading
        estimator seen = e;
        double expected = 0.2, total = 0.3, gain[ALL] = {0};
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < n; j++) {
                gain[i] += e.p[i][j] * row[j];
            }
            expected += row[i] * e.z[i];
            total += row[i] * gain[i];
        }
        const estimator_view view = estimator_look(&seen, n, row, 0.2);
        estimator_correct(&seen, n, &view, 1.4, 0.3);
        for (int i = 0; i < n; i++) {
            check_close(seen.z[i], e.z[i] + gain[i] * (1.4 - expected) / total, 1e-13);
            for (int j = 0; j < n; j++) {
                check_close(seen.p[i][j], e.p[i][j] - gain[i] * gain[j] / total, 1e-13);
            }
        }
        for (int i = n; i < ALL; i++) {
            assert_true(isnan(seen.z[i]));
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

// The largest difference of a prediction of three modes, a
// wall and a torque over h from the matrices of all states at once, P' = A P A' + noise.
static double prediction_error(double damper, double h)
{
    enum { MODES = 3, STATES = 2 * MODES + 2, TORQUE = STATES - 1 };
    const double square[] = {0, 90, 300}, damping[] = {0, 0.4, 1};
    const double hub[] = {2, 5, -3};
    const modal_motion moved = {MODES, square, damping, hub, damper};
    random_generator g = seeded(8);
    double rate[ESTIMATOR_STATES][ESTIMATOR_STATES] = {{0}},
           input[ESTIMATOR_STATES] = {0};
    double noise[STATES], most = 0;
    for (int i = 0; i < MODES; i++) {
        rate[i][MODES + i] = 1;
        rate[MODES + i][i] = -square[i];
        rate[MODES + i][MODES + i] = -damping[i];
        for (int j = 0; j < MODES; j++) {
            rate[MODES + i][MODES + j] -= damper * hub[i] * hub[j];
        }
        rate[MODES + i][TORQUE] = input[MODES + i] = hub[i];
    }

    estimator e = {.z = {0}};
    for (int i = 0; i < STATES; i++) {
        e.z[i] = random_uniform(&g) - 0.5;
        noise[i] = 0.1 * random_uniform(&g);
        for (int j = 0; j <= i; j++) {
            e.p[i][j] = e.p[j][i] = random_uniform(&g) + 2 * (i == j);
        }
    }
    const estimator before = e;
    sampled_model whole;
    modal_model parts;
    sampled_model_init(&whole, STATES, rate, input, h);
    modal_model_init(&parts, &moved, h);
    estimator_predict(&e, STATES, &parts, 0.7, noise);

    for (int i = 0; i < STATES; i++) {
        double z = 0.7 * whole.b[i];
        for (int j = 0; j < STATES; j++) {
            double spread = i == j ? noise[i] : 0;
            z += whole.a[i][j] * before.z[j];
            for (int k = 0; k < STATES; k++) {
                for (int l = 0; l < STATES; l++) {
                    spread += whole.a[i][k] * before.p[k][l] * whole.a[j][l];
                }
            }
            most = fmax(most, fabs(e.p[i][j] - spread));
        }
        most = fmax(most, fabs(e.z[i] - z));
    }
    return most;
}

// Without a damper between the modes their prediction is that of all states at once; with
// one, to second order in the period.
TEST(modes_move_as_the_whole)
{
    check_below(prediction_error(0, 0.005), 1e-12);
    const double coarse = prediction_error(0.3, 0.002);
    const double fine = prediction_error(0.3, 0.001);
    check_below(coarse, 0.02);
    check_below(3.2 * fine, coarse);
}
