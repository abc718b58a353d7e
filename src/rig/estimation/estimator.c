#include "src/rig/estimation/estimator.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { N = ESTIMATOR_STATES, EXTENDED = N + 1 };

static void multiply(int size, double out[EXTENDED][EXTENDED], double x[EXTENDED][EXTENDED],
                     double y[EXTENDED][EXTENDED], double factor)
{
    double product[EXTENDED][EXTENDED] = {{0}};
    for (int i = 0; i < size; i++) {
        for (int j = 0; j < size; j++) {
            double sum = 0;
            for (int k = 0; k < size; k++) {
                sum += x[i][k] * y[k][j];
            }
            product[i][j] = factor * sum;
        }
    }
    memcpy(out, product, sizeof product);
}

void sampled_model_init(sampled_model *m, int n, double rate[N][N], const double input[N], double h)
{
    assert(n > 0 && n <= N && isfinite(h));

    // exponential of the system extended by its constant input: Taylor's series of a 2^-HALVINGS
    // part of the step, squared back
    enum { HALVINGS = 8, TERMS = 12 };
    double x[EXTENDED][EXTENDED] = {{0}}, power[EXTENDED][EXTENDED] = {{0}};
    double sum[EXTENDED][EXTENDED] = {{0}};
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            x[i][j] = rate[i][j];
        }
        x[i][n] = input[i];
    }

    for (int i = 0; i < EXTENDED; i++) {
        sum[i][i] = power[i][i] = 1;
    }
    for (int term = 1; term <= TERMS; term++) {
        multiply(n + 1, power, power, x, ldexp(h, -HALVINGS) / term);
        for (int i = 0; i < EXTENDED * EXTENDED; i++) {
            (&sum[0][0])[i] += (&power[0][0])[i];
        }
    }
    for (int i = 0; i < HALVINGS; i++) {
        multiply(n + 1, sum, sum, sum, 1);
    }

    // the state's part, and the constant input's column
    memset(m, 0, sizeof *m);
    m->n = n;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            m->a[i][j] = sum[i][j];
        }
        m->b[i] = sum[i][n];
    }
}

void sampled_model_step(const sampled_model *m, double *z, double u)
{
    double next[N];
    for (int i = 0; i < m->n; i++) {
        next[i] = m->b[i] * u;
        for (int j = 0; j < m->n; j++) {
            next[i] += m->a[i][j] * z[j];
        }
    }
    memcpy(z, next, (size_t)m->n * sizeof z[0]);
}

void estimator_predict(estimator *e, const sampled_model *m, double u, const double *noise)
{
    const int n = m->n;
    double ap[N][N];
    sampled_model_step(m, e->z, u);

    // A P on the way to A P A'
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            ap[i][j] = 0;
            for (int k = 0; k < n; k++) {
                ap[i][j] += m->a[i][k] * e->p[k][j];
            }
        }
    }

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

void estimator_transform(estimator *e, int from, int to,
                         double t[ESTIMATOR_STATES][ESTIMATOR_STATES])
{
    assert(from <= ESTIMATOR_STATES && to <= ESTIMATOR_STATES);
    const estimator before = *e;
    double product[ESTIMATOR_STATES][ESTIMATOR_STATES];
    memset(e, 0, sizeof *e);

    // t z and t p
    for (int i = 0; i < to; i++) {
        for (int j = 0; j < from; j++) {
            e->z[i] += t[i][j] * before.z[j];
            product[i][j] = 0;
            for (int k = 0; k < from; k++) {
                product[i][j] += t[i][k] * before.p[k][j];
            }
        }
    }

    // times t'
    for (int i = 0; i < to; i++) {
        for (int j = 0; j < to; j++) {
            for (int k = 0; k < from; k++) {
                e->p[i][j] += product[i][k] * t[j][k];
            }
        }
    }
}
