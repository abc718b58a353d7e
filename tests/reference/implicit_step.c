// Steps of the implicit simulation: Radau IIA of three stages.
#include "tests/reference/implicit_parts.h"

enum { MOST_ITERATIONS = 12 };

static double node[STAGES], weight[STAGES][STAGES];

// Butcher's matrix from the nodes (4 -+ sqrt 6)/10, 1: the integrals of Lagrange's
// polynomials.
static void find_coefficients(void)
{
    const double root = sqrt(6.0);
    node[0] = (4 - root) / 10;
    node[1] = (4 + root) / 10;
    node[2] = 1;
    for (int j = 0; j < STAGES; j++) {
        const double u = node[(j + 1) % 3], v = node[(j + 2) % 3];
        const double under = (node[j] - u) * (node[j] - v);
        for (int i = 0; i < STAGES; i++) {
            const double c = node[i];
            weight[i][j] = (c * c * c / 3 - (u + v) * c * c / 2 + u * v * c) / under;
        }
    }
}

void find_jacobian(simulation *s)
{
    const int d = 2 * s->n + 3;
    double base[MOST], moved[MOST], y[MOST];
    answer r;
    rate_of(s, &s->now, s->y, base, &r);
    memcpy(y, s->y, sizeof y);
    for (int k = 0; k < d; k++) {
        const double scale = k < s->n       ? 1
                             : k < 2 * s->n ? s->largest_rate
                                            : fmax(fabs(y[k]), 1e-3);
        const double by = 1e-7 * scale;
        y[k] = s->y[k] + by;
        rate_of(s, &s->now, y, moved, &r);
        y[k] = s->y[k] - by;
        double back[MOST];
        rate_of(s, &s->now, y, back, &r);
        y[k] = s->y[k];
        for (int i = 0; i < d; i++) {
            s->jacobian[i][k] = (moved[i] - back[i]) / (2 * by);
        }
    }
}

// The largest entry of a difference of two states, each as a share of its scale: of an
// iteration the arm's, of an error each body's own, as one on a stiff wall moves far less
// than the hub.
static double size_of(const simulation *s, const double *y, bool error)
{
    double most = 0;
    for (int i = 0; i < s->n; i++) {
        most = fmax(most, fabs(y[i]) / (error ? s->turned[i] : s->largest_angle));
        most = fmax(most, fabs(y[s->n + i]) / (error ? s->rate[i] : s->largest_rate));
    }
    for (int i = 2 * s->n; i < 2 * s->n + 3; i++) {
        most = fmax(most, fabs(y[i]) / fmax(fabs(s->y[i]), 1e-4));
    }
    return most;
}

// Rates at the stages that are z away from the start.
static void find_rates(simulation *s, double z[][MOST], double rate[][MOST], answer *r)
{
    for (int i = 0; i < STAGES; i++) {
        for (int k = 0; k < 2 * s->n + 3; k++) {
            s->stage[i][k] = s->y[k] + z[i][k];
        }
        rate_of(s, &s->now, s->stage[i], rate[i], &r[i]);
    }
}

// Newton's iteration for z = h A f(y + z). False where it does not converge.
static bool find_stages(simulation *s, double h, double z[][MOST], double rate[][MOST],
                        answer *r)
{
    enum { WIDTH = STAGES * MOST };
    static double m[WIDTH * WIDTH];
    const int d = 2 * s->n + 3, all = STAGES * d;
    int pivot[WIDTH];
    for (int i = 0; i < all; i++) {
        for (int k = 0; k < all; k++) {
            m[i * WIDTH + k] =
                (i == k) - h * weight[i / d][k / d] * s->jacobian[i % d][k % d];
        }
    }
    factor(all, WIDTH, m, pivot);
    double last = HUGE_VAL;
    for (int it = 0; it < MOST_ITERATIONS; it++) {
        double change[WIDTH], most = 0;
        find_rates(s, z, rate, r);
        for (int i = 0; i < all; i++) {
            change[i] = -z[i / d][i % d];
            for (int j = 0; j < STAGES; j++) {
                change[i] += h * weight[i / d][j] * rate[j][i % d];
            }
        }
        solve_factored(all, WIDTH, m, pivot, change);
        for (int i = 0; i < STAGES; i++) {
            for (int k = 0; k < d; k++) {
                z[i][k] += change[i * d + k];
            }
            most = fmax(most, size_of(s, change + i * d, false));
        }
        if (!(most < 1e3) || (it > 2 && most > 2 * last)) {
            return most < 1e-11;
        }
        if (most < 1e-14 || (it > 2 && most < 1e-12 && most > 0.5 * last)) {
            return true;
        }
        last = most;
    }
    return last < 1e-11;
}

double try_step(simulation *s, double h)
{
    const int d = 2 * s->n + 3;
    double z[STAGES][MOST] = {{0}}, rate[STAGES][MOST];
    answer r[STAGES];
    find_coefficients();
    if (!find_stages(s, h, z, rate, r)) {
        return HUGE_VAL;
    }
    find_rates(s, z, rate, r);
    memcpy(s->end, s->stage[STAGES - 1], sizeof s->end);
    memset(s->added, 0, sizeof s->added);
    for (int i = 0; i < STAGES; i++) {
        const double b = h * weight[STAGES - 1][i];
        const double hub = s->stage[i][s->n];
        s->added[SUM_FORCE] += b * r[i].force;
        s->added[SUM_VISCOUS] += b * r[i].viscous;
        s->added[SUM_DAMPING] += b * r[i].damping;
        s->added[SUM_WALL] += b * r[i].wall;
        s->added[SUM_WORK] += b * r[i].work;
        s->added[SUM_FRICTION] += s->now.friction != 0 ? b * r[i].friction * hub : 0;
    }

    // the embedded formula of order 3 (Hairer and Wanner, IV.8): its weight at the start
    // is the inverse of the real eigenvalue of the inverse of Butcher's matrix
    const double gamma = (6 + cbrt(81) - cbrt(9)) / 30, root = sqrt(6.0);
    const double e[] = {-(13 + 7 * root) / 3, (-13 + 7 * root) / 3, -1.0 / 3};
    static double m[MOST][MOST];
    double error[MOST];
    int pivot[MOST];
    answer unused;
    rate_of(s, &s->now, s->y, error, &unused);
    for (int i = 0; i < d; i++) {
        for (int k = 0; k < d; k++) {
            m[i][k] = (i == k ? 1 / (gamma * h) : 0) - s->jacobian[i][k];
        }
        for (int k = 0; k < STAGES; k++) {
            error[i] += e[k] / h * z[k][i];
        }
    }
    factor(d, MOST, m[0], pivot);
    solve_factored(d, MOST, m[0], pivot, error);
    return size_of(s, error, true) / s->tolerance;
}

void between_stages(const simulation *s, double x, double *y)
{
    const double at[] = {0, node[0], node[1], 1};
    for (int k = 0; k < 2 * s->n + 3; k++) {
        y[k] = 0;
        for (int i = 0; i < 4; i++) {
            double share = 1;
            for (int j = 0; j < 4; j++) {
                share *= j == i ? 1 : (x - at[j]) / (at[i] - at[j]);
            }
            y[k] += share * (i == 0 ? s->y[k] : s->stage[i - 1][k]);
        }
    }
}
