#include "src/rig/estimation/estimator.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/dense.h"
#include "src/base/fault.h"

enum { N = ESTIMATOR_STATES, EXTENDED = N + 1, DOUBLINGS = 60 };

// out = factor x y, for matrices of the states extended by the input; `out` may be x or
// y.
static void multiply_extended(int size, double out[EXTENDED][EXTENDED],
                              double x[EXTENDED][EXTENDED], double y[EXTENDED][EXTENDED],
                              double factor)
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

void sampled_model_init(sampled_model *m, int n, double rate[N][N], const double input[N],
                        double h)
{
    assert(n > 0 && n <= N && isfinite(h));

    // exponential of the system extended by its constant input: Taylor's series of a
    // 2^-HALVINGS part of the step, squared back
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
        multiply_extended(n + 1, power, power, x, ldexp(h, -HALVINGS) / term);
        for (int i = 0; i < EXTENDED * EXTENDED; i++) {
            (&sum[0][0])[i] += (&power[0][0])[i];
        }
    }
    for (int i = 0; i < HALVINGS; i++) {
        multiply_extended(n + 1, sum, sum, sum, 1);
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

// A matrix over the states, of which only the first rows and columns are in use.
typedef double matrix[N][N];

// out = a b, where a has `rows` rows and `inner` columns and b `inner` rows and `columns`
// columns; each factor may be stored transposed. Rows of all three are N apart.
static inline void multiply_states(int rows, int inner, int columns, double *out,
                                   const double *a, bool transpose_a, const double *b,
                                   bool transpose_b)
{
    // from one row, and from one column, to the next
    const int a_row = transpose_a ? 1 : N, a_column = transpose_a ? N : 1;
    const int b_row = transpose_b ? 1 : N, b_column = transpose_b ? N : 1;
    for (int i = 0; i < rows; i++) {
        for (int j = 0; j < columns; j++) {
            double sum = 0;
            for (int k = 0; k < inner; k++) {
                sum += a[i * a_row + k * a_column] * b[k * b_row + j * b_column];
            }
            out[i * N + j] = sum;
        }
    }
}

// --- modes -----------------------------------------------------------------------------

void modal_model_init(modal_model *m, const modal_motion *of, double h)
{
    assert(of->modes <= MODAL_MOST);
    memset(m, 0, sizeof *m);
    m->modes = of->modes;
    for (int i = 0; i < of->modes; i++) {
        // each mode with its own part of the damper
        const double hub = of->hub[i], own = of->hub_damping * hub;
        const double input[N] = {0, hub};
        double rate[N][N] = {{0, 1}, {-of->square[i], -of->damping[i] - own * hub}};
        sampled_model one;
        sampled_model_init(&one, 2, rate, input, h);
        for (int k = 0; k < 2; k++) {
            m->gain[i][k] = one.b[k];
            m->keep[i][k][0] = one.a[k][0];
            // which modal_model_step and estimator_predict count once more
            m->keep[i][k][1] = one.a[k][1] + one.b[k] * own;
        }
        m->damper[i] = -own;
    }
}

void modal_model_step(const modal_model *m, double *z, double u)
{
    const int modes = m->modes;
    for (int i = 0; i < modes; i++) {
        u += m->damper[i] * z[modes + i];
    }
    for (int i = 0; i < modes; i++) {
        const double a = z[i], rate = z[modes + i];
        z[i] = m->keep[i][0][0] * a + m->keep[i][0][1] * rate + m->gain[i][0] * u;
        z[modes + i] = m->keep[i][1][0] * a + m->keep[i][1][1] * rate + m->gain[i][1] * u;
    }
}

// --- the filter ------------------------------------------------------------------------

void estimator_predict(estimator *e, int n, const modal_model *m, double u,
                       const double *noise)
{
    const int modes = m->modes, torque = n - 1;

    // the torque is u + c z: its covariance P c' with the states, and its variance
    double with[N] = {0};
    for (int i = 0; i < n; i++) {
        with[i] = e->p[torque][i];
        for (int j = 0; j < modes; j++) {
            with[i] += m->damper[j] * e->p[modes + j][i];
        }
    }
    double variance = with[torque];
    for (int j = 0; j < modes; j++) {
        variance += m->damper[j] * with[modes + j];
    }
    modal_model_step(m, e->z, u + e->z[torque]);

    // K P K', and the same of the covariance with the torque, K the modes' own motion
    for (int i = 0; i < modes; i++) {
        const double(*k)[2] = m->keep[i];
        for (int j = 0; j < n; j++) {
            const double a = e->p[i][j], rate = e->p[modes + i][j];
            e->p[i][j] = k[0][0] * a + k[0][1] * rate;
            e->p[modes + i][j] = k[1][0] * a + k[1][1] * rate;
        }
        const double a = with[i], rate = with[modes + i];
        with[i] = k[0][0] * a + k[0][1] * rate + m->gain[i][0] * variance / 2;
        with[modes + i] = k[1][0] * a + k[1][1] * rate + m->gain[i][1] * variance / 2;
    }
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < modes; i++) {
            const double(*k)[2] = m->keep[i];
            const double a = e->p[j][i], rate = e->p[j][modes + i];
            e->p[j][i] = k[0][0] * a + k[0][1] * rate;
            e->p[j][modes + i] = k[1][0] * a + k[1][1] * rate;
        }
    }

    // and what the torque adds: g q' + q g' with q = K P c' + g c P c'/2
    for (int i = 0; i < modes; i++) {
        for (int j = 0; j < n; j++) {
            for (int k = 0; k < 2; k++) {
                const double added = m->gain[i][k] * with[j];
                e->p[k * modes + i][j] += added;
                e->p[j][k * modes + i] += added;
            }
        }
    }
    for (int i = 0; i < n; i++) {
        e->p[i][i] += noise[i];
    }
}

estimator_view estimator_look(const estimator *e, int n, const double *row, double offset)
{
    estimator_view view = {.expected = offset};
    for (int j = 0; j < n; j++) {
        if (row[j] != 0) {
            view.expected += row[j] * e->z[j];
            for (int i = 0; i < n; i++) {
                view.spread[i] += e->p[j][i] * row[j];
            }
        }
    }
    for (int i = 0; i < n; i++) {
        view.variance += row[i] * view.spread[i];
    }
    return view;
}

void estimator_correct(estimator *e, int n, const estimator_view *view, double reading,
                       double variance)
{
    // gain P row'/(row P row' + variance)
    const double share = 1 / (view->variance + variance);
    const double error = share * (reading - view->expected);
    for (int i = 0; i < n; i++) {
        const double spread = view->spread[i], less = share * spread;
        e->z[i] += spread * error;
        for (int j = 0; j < n; j++) {
            e->p[i][j] -= less * view->spread[j];
        }
    }
}

void estimator_transform(estimator *e, int from, int to,
                         double t[ESTIMATOR_STATES][ESTIMATOR_STATES])
{
    assert(from <= N && to <= N);
    const estimator before = *e;
    matrix product;
    memset(e, 0, sizeof *e);
    for (int i = 0; i < to; i++) {
        for (int j = 0; j < from; j++) {
            e->z[i] += t[i][j] * before.z[j];
        }
    }
    multiply_states(to, from, from, product[0], t[0], false, before.p[0], false);
    multiply_states(to, from, to, e->p[0], product[0], false, t[0], true);
}

// --- the gain of a regulator -----------------------------------------------------------

// The product of two square matrices; `out` may be one of them.
static void multiply(int n, matrix out, matrix a, bool transpose_a, matrix b,
                     bool transpose_b)
{
    matrix product;
    multiply_states(n, n, n, product[0], a[0], transpose_a, b[0], transpose_b);
    for (int i = 0; i < n; i++) {
        memcpy(out[i], product[i], (size_t)n * sizeof(double));
    }
}

// x = (I + g h)^-1 b. False if that is singular.
static bool solve_resolvent(int n, matrix x, matrix g, matrix h, matrix b)
{
    matrix product;
    double left[N * N], right[N * N];
    multiply(n, product, g, false, h, false);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            left[i * n + j] = product[i][j] + (i == j ? 1 : 0);
            right[i * n + j] = b[i][j];
        }
    }

    if (!dense_solve_columns(n, n, left, right)) {
        return false;
    }
    for (int i = 0; i < n; i++) {
        memcpy(x[i], right + i * n, (size_t)n * sizeof(double));
    }
    return true;
}

// The solution x of x = a'x (I + g x)^-1 a + q by doubling: with f = (I + g x)^-1
//
//     x <- x + a'x f a,    g <- g + a f g a',    a <- a f a
//
// from x = q on. False if it does not converge.
static bool riccati(int n, matrix a, matrix g, matrix q, matrix x)
{
    memcpy(x, q, sizeof(matrix));
    for (int k = 0; k < DOUBLINGS; k++) {
        matrix fa, fg, step;
        if (!solve_resolvent(n, fa, g, x, a) || !solve_resolvent(n, fg, g, x, g)) {
            return false;
        }

        // x grows by a'x f a and g by a f g a'; a becomes a f a
        multiply(n, step, x, false, fa, false);
        multiply(n, step, a, true, step, false);
        multiply(n, fg, a, false, fg, false);
        multiply(n, fg, fg, false, a, true);
        multiply(n, a, a, false, fa, false);

        // until x does not change any more
        double change = 0, size = 0;
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < n; j++) {
                x[i][j] += step[i][j];
                g[i][j] += fg[i][j];
                change = fmax(change, fabs(step[i][j]));
                size = fmax(size, fabs(x[i][j]));
            }
        }
        if (!isfinite(size)) {
            return false;
        }
        if (change <= 1e-14 * size) {
            return true;
        }
    }
    return false;
}

bool quadratic_gain(const sampled_model *m, const double *weight, double effort,
                    double *gain)
{
    assert(m->n > 0 && m->n <= N);
    const int n = m->n;
    if (!(effort > 0)) {
        return false;
    }
    matrix a = {{0}}, g = {{0}}, q = {{0}}, x = {{0}};
    for (int i = 0; i < n; i++) {
        q[i][i] = weight[i];
        for (int j = 0; j < n; j++) {
            a[i][j] = m->a[i][j];
            g[i][j] = m->b[i] * m->b[j] / effort;
        }
    }
    if (!riccati(n, a, g, q, x)) {
        return false;
    }

    // the gain (r + b'x b)^-1 b'x A
    double bx[N] = {0}, sum = effort;
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++) {
            bx[j] += m->b[i] * x[i][j];
        }
        sum += bx[j] * m->b[j];
    }
    bool finite = true;
    for (int j = 0; j < n; j++) {
        gain[j] = 0;
        for (int i = 0; i < n; i++) {
            gain[j] += bx[i] * m->a[i][j];
        }
        gain[j] /= sum;
        finite = finite && isfinite(gain[j]);
    }
    return finite;
}
