#include "src/rig/estimator.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { N = ESTIMATOR_STATES, EXTENDED = N + 1 };

// LAPACK: Schur form of a general real matrix, wanted eigenvalues first.
extern void dgees_(const char *jobvs, const char *sort,
                   int (*select)(const double *, const double *), const int *n, double *a,
                   const int *lda, int *sdim, double *wr, double *wi, double *vs, const int *ldvs,
                   double *work, const int *lwork, int *bwork, int *info);

static void multiply(double out[EXTENDED][EXTENDED], double x[EXTENDED][EXTENDED],
                     double y[EXTENDED][EXTENDED], double factor)
{
    double product[EXTENDED][EXTENDED];
    for (int i = 0; i < EXTENDED; i++) {
        for (int j = 0; j < EXTENDED; j++) {
            double sum = 0;
            for (int k = 0; k < EXTENDED; k++) {
                sum += x[i][k] * y[k][j];
            }
            product[i][j] = factor * sum;
        }
    }
    memcpy(out, product, sizeof product);
}

void sampled_model_init(sampled_model *m, int n, double rate[N][N], const double input[N], double h)
{
    assert(m != NULL && n > 0 && n <= N && isfinite(h));

    // exponential of the system extended by its constant input: Taylor's series of a 2^-HALVINGS
    // part of the step, squared back
    enum { HALVINGS = 8, TERMS = 12 };
    double x[EXTENDED][EXTENDED] = {{0}}, power[EXTENDED][EXTENDED] = {{0}};
    double sum[EXTENDED][EXTENDED] = {{0}};
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            x[i][j] = rate[i][j];
        }
        x[i][N] = input[i];
    }

    for (int i = 0; i < EXTENDED; i++) {
        sum[i][i] = power[i][i] = 1;
    }
    for (int term = 1; term <= TERMS; term++) {
        multiply(power, power, x, ldexp(h, -HALVINGS) / term);
        for (int i = 0; i < EXTENDED * EXTENDED; i++) {
            (&sum[0][0])[i] += (&power[0][0])[i];
        }
    }
    for (int i = 0; i < HALVINGS; i++) {
        multiply(sum, sum, sum, 1);
    }

    // the state's part, and the constant input's column
    memset(m, 0, sizeof *m);
    m->n = n;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            m->a[i][j] = sum[i][j];
        }
        m->b[i] = sum[i][N];
    }
}

void estimator_predict(estimator *e, const sampled_model *m, double u, const double *noise)
{
    const int n = m->n;
    double z[N], ap[N][N];

    // z = A z + b u, and A P on the way to A P A'
    for (int i = 0; i < n; i++) {
        z[i] = m->b[i] * u;
        for (int j = 0; j < n; j++) {
            z[i] += m->a[i][j] * e->z[j];
            ap[i][j] = 0;
            for (int k = 0; k < n; k++) {
                ap[i][j] += m->a[i][k] * e->p[k][j];
            }
        }
    }
    memcpy(e->z, z, (size_t)n * sizeof z[0]);

    // P = A P A' + noise
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            e->p[i][j] = i == j ? noise[i] : 0;
            for (int k = 0; k < n; k++) {
                e->p[i][j] += ap[i][k] * m->a[j][k];
            }
        }
    }
}

void estimator_correct(estimator *e, int n, const double *row, double offset, double reading,
                       double variance)
{
    double spread[N], expected = offset, total = variance;

    // P row', the reading expected, and its variance row P row' + variance
    for (int i = 0; i < n; i++) {
        spread[i] = 0;
        for (int j = 0; j < n; j++) {
            spread[i] += e->p[i][j] * row[j];
        }
        expected += row[i] * e->z[i];
        total += row[i] * spread[i];
    }

    // gain P row' / total
    for (int i = 0; i < n; i++) {
        e->z[i] += spread[i] / total * (reading - expected);
        for (int j = 0; j < n; j++) {
            e->p[i][j] -= spread[i] * spread[j] / total;
        }
    }
}

static int is_stable(const double *real, const double *imaginary)
{
    return *real * *real + *imaginary * *imaginary < 1;
}

// P of the discrete Riccati equation of (a, g = b b'/r, q): the stable invariant subspace of the
// symplectic matrix, columns as LAPACK wants them.
static bool riccati(double a[2][2], double g[2][2], double q[2][2], double p[2][2])
{
    double det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    double t[2][2] = {{a[1][1] / det, -a[1][0] / det}, {-a[0][1] / det, a[0][0] / det}}; // a^-T
    double z[16], vs[16], wr[4], wi[4], work[64];

    // [a + g a^-T q, -g a^-T; -a^-T q, a^-T]
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            double gt = g[i][0] * t[0][j] + g[i][1] * t[1][j];
            double gtq = 0, tq = t[i][0] * q[0][j] + t[i][1] * q[1][j];
            for (int k = 0; k < 2; k++) {
                gtq += (g[i][0] * t[0][k] + g[i][1] * t[1][k]) * q[k][j];
            }
            z[i + 4 * j] = a[i][j] + gtq;
            z[i + 4 * (j + 2)] = -gt;
            z[i + 2 + 4 * j] = -tq;
            z[i + 2 + 4 * (j + 2)] = t[i][j];
        }
    }

    // its Schur vectors, those of stable eigenvalues first
    const int four = 4, length = 64;
    int found = 0, info = 0, flags[4];
    dgees_("V", "S", is_stable, &four, z, &four, &found, wr, wi, vs, &four, work, &length, flags,
           &info);

    // p = u21 u11^-1 of the first two Schur vectors
    double u = vs[0] * vs[5] - vs[4] * vs[1];
    if (info != 0 || found != 2 || !(fabs(u) > 1e-12)) {
        return false;
    }
    double inverse[2][2] = {{vs[5] / u, -vs[4] / u}, {-vs[1] / u, vs[0] / u}};
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            p[i][j] = vs[2 + i] * inverse[0][j] + vs[6 + i] * inverse[1][j];
        }
    }
    return true;
}

bool optimal_gain(const sampled_model *m, const double output[2], double direct, double effort,
                  double growth, double k[2])
{
    assert(m != NULL && m->n == 2 && growth > 0);

    // the cross term output x direct goes with u = v - s z / r
    double r = direct * direct + effort, grown[2][2], a[2][2], b[2], q[2][2], g[2][2], p[2][2];
    double s[2] = {output[0] * direct, output[1] * direct};
    if (!(r > 0)) {
        return false;
    }
    for (int i = 0; i < 2; i++) {
        b[i] = growth * m->b[i];
        for (int j = 0; j < 2; j++) {
            grown[i][j] = growth * m->a[i][j];
            a[i][j] = grown[i][j] - b[i] * s[j] / r;
            q[i][j] = output[i] * output[j] - s[i] * s[j] / r;
        }
    }
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            g[i][j] = b[i] * b[j] / r;
        }
    }
    if (!riccati(a, g, q, p)) {
        return false;
    }

    // k = (r + b' P b)^-1 (b' P a + s)
    double bp[2] = {b[0] * p[0][0] + b[1] * p[1][0], b[0] * p[0][1] + b[1] * p[1][1]};
    double weight = r + bp[0] * b[0] + bp[1] * b[1];
    for (int j = 0; j < 2; j++) {
        k[j] = (bp[0] * grown[0][j] + bp[1] * grown[1][j] + s[j]) / weight;
    }
    return isfinite(k[0]) && isfinite(k[1]);
}
