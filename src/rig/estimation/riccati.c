#include "src/rig/estimation/riccati.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/dense.h"

enum { N = ESTIMATOR_STATES, DOUBLINGS = 60 };

// A square matrix of the states in use.
typedef double matrix[N][N];

static void multiply(int n, matrix out, matrix a, bool transpose_a, matrix b, bool transpose_b)
{
    matrix product;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            product[i][j] = 0;
            for (int k = 0; k < n; k++) {
                product[i][j] +=
                    (transpose_a ? a[k][i] : a[i][k]) * (transpose_b ? b[j][k] : b[k][j]);
            }
        }
    }

    // `out` may be one of the factors
    for (int i = 0; i < n; i++) {
        memcpy(out[i], product[i], (size_t)n * sizeof(double));
    }
}

// x = (I + g h)^-1 b. False if that is singular.
static bool solve(int n, matrix x, matrix g, matrix h, matrix b)
{
    matrix product;
    double left[N * N], right[N * N];
    multiply(n, product, g, false, h, false);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            left[i * n + j] = product[i][j] + (i == j);
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

// The solution x of x = a'x (I + g x)^-1 a + q by doubling.
static bool riccati(int n, matrix a, matrix g, matrix q, matrix x)
{
    memcpy(x, q, sizeof(matrix));
    for (int k = 0; k < DOUBLINGS; k++) {
        matrix fa, fg, step;
        if (!solve(n, fa, g, x, a) || !solve(n, fg, g, x, g)) {
            return false;
        }

        // x + a'x f a, g + a f g a', a f a with f = (I + g x)^-1
        multiply(n, step, x, false, fa, false);
        multiply(n, step, a, true, step, false);
        multiply(n, fg, a, false, fg, false);
        multiply(n, fg, fg, false, a, true);
        multiply(n, a, a, false, fa, false);
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

void quadratic_cost_add(quadratic_cost *c, int n, const double *row, double direct, double weight)
{
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            c->state[i][j] += weight * row[i] * row[j];
        }
        c->cross[i] += weight * row[i] * direct;
    }
    c->effort += weight * direct * direct;
}

bool quadratic_gain(const sampled_model *m, const quadratic_cost *c, double *gain)
{
    assert(m->n > 0 && m->n <= N && c->growth > 0);
    const int n = m->n;
    if (!(c->effort > 0)) {
        return false;
    }

    // the cross term goes with u = v - s'z / r
    matrix a = {{0}}, g = {{0}}, q = {{0}}, x = {{0}};
    double b[N];
    for (int i = 0; i < n; i++) {
        b[i] = c->growth * m->b[i];
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            a[i][j] = c->growth * m->a[i][j] - b[i] * c->cross[j] / c->effort;
            g[i][j] = b[i] * b[j] / c->effort;
            q[i][j] = c->state[i][j] - c->cross[i] * c->cross[j] / c->effort;
        }
    }
    if (!riccati(n, a, g, q, x)) {
        return false;
    }

    // (r + b'x b)^-1 (b'x A + s')
    double bx[N], weight = c->effort;
    for (int j = 0; j < n; j++) {
        bx[j] = 0;
        for (int i = 0; i < n; i++) {
            bx[j] += b[i] * x[i][j];
        }
        weight += bx[j] * b[j];
    }
    bool finite = true;
    for (int j = 0; j < n; j++) {
        gain[j] = c->cross[j];
        for (int i = 0; i < n; i++) {
            gain[j] += bx[i] * c->growth * m->a[i][j];
        }
        gain[j] /= weight;
        finite = finite && isfinite(gain[j]);
    }
    return finite;
}
