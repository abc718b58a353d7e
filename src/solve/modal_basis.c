#include "src/solve/modal_basis.h"

#include <math.h>
#include <string.h>

#include "src/base/symmetric.h"

size_t modal_basis_size(int n)
{
    return (size_t)n * (2 * (size_t)n + 2);
}

size_t modal_basis_scratch(int n)
{
    return (size_t)n * (3 * (size_t)n + 6);
}

void modal_basis_place(modal_basis *b, int n, double *storage)
{
    b->count = 0;
    b->rate = storage;
    b->pull = storage + n;
    b->by_mode = storage + 2 * n;
    b->by_dof = b->by_mode + (size_t)n * (size_t)n;
}

// --- the straight chain ---------------------------------------------------------------------

void modal_mass_times(const arm *a, const double *x, double *y)
{
    const int N = a->links;
    const double l = a->link_length, m = a->link_mass, unit = m * l * l;
    const double own = a->link_inertia - 0.25 * unit; // A_ii beyond what A_ij would give
    const double *in = x + a->first;
    double *out = y + a->first;

    // A_ij = unit (N - 1 - max(i, j) + 1/2): links beyond, then links before
    double beyond = 0, before = 0;
    for (int i = N - 1; i >= 0; i--) {
        out[i] = beyond;
        beyond += unit * (N - 0.5 - i) * in[i];
    }
    for (int i = 0; i < N; i++) {
        before += in[i];
        out[i] += unit * (N - 0.5 - i) * before + own * in[i];
    }
    y[0] = (a->first > 0 ? 0 : y[0]) + a->hub_inertia * x[0];
}

void modal_stiffness_times(const arm *a, const double *x, double *y)
{
    double inner = 0;
    for (int k = 0; k < a->dof; k++) {
        double outer = 0;
        if (k + 1 < a->dof) {
            double s = k + 1 == a->first ? a->hub_stiffness : a->joint_stiffness;
            outer = s * (x[k + 1] - x[k]);
        }
        y[k] = inner - outer;
        inner = outer;
    }
}

// --- modes ------------------------------------------------------------------------------------

// M and K on the angles that are allowed, by applying them to a basis of those: unit vectors, less
// the last one where the tip touches.
typedef struct allowed {
    int columns, start, last; // degrees of freedom start.. ; last: the one that follows, or -1
    const arm *arm;
} allowed;

static void allowed_vector(const allowed *w, int column, double *x)
{
    int dof = w->start + column;
    memset(x, 0, (size_t)w->arm->dof * sizeof *x);
    x[dof] = 1;
    if (w->last >= 0 && dof >= w->arm->first) {
        x[w->last] = -1;
    }
}

static void reduce(const allowed *w, void (*times)(const arm *, const double *, double *),
                   double *matrix, double *x, double *y)
{
    for (int c = 0; c < w->columns; c++) {
        allowed_vector(w, c, x);
        times(w->arm, x, y);
        for (int r = 0; r < w->columns; r++) {
            int dof = w->start + r;
            double last = w->last >= 0 && dof >= w->arm->first ? y[w->last] : 0;
            matrix[(size_t)c * (size_t)w->columns + (size_t)r] = y[dof] - last;
        }
    }
}

// The vector M0^-1 of the gradient of sum q_k, of unit length in M0, as one more mode.
static bool add_gradient(modal_basis *b, const arm *a, int start, double *factor, double *x,
                         double *y)
{
    const int n = a->dof - start;
    const allowed all = {n, start, -1, a};

    // M0 = L L', so that its length in M0 is that of L^-1 times the gradient
    reduce(&all, modal_mass_times, factor, x, y);
    if (!symmetric_factor(n, factor)) {
        return false;
    }
    for (int i = 0; i < n; i++) {
        y[i] = start + i >= a->first;
    }
    symmetric_forward(n, factor, y);
    double square = 0;
    for (int i = 0; i < n; i++) {
        square += y[i] * y[i];
    }
    symmetric_backward(n, factor, y);

    double *row = b->by_mode + (size_t)b->count * (size_t)a->dof;
    memset(row, 0, (size_t)a->dof * sizeof *row);
    for (int i = 0; i < n; i++) {
        row[start + i] = y[i] / sqrt(square);
    }

    // what the modes and it itself pull at it
    modal_stiffness_times(a, row, y);
    for (int k = 0; k <= b->count; k++) {
        const double *mode = b->by_mode + (size_t)k * (size_t)a->dof;
        for (int i = 0; i < a->dof; i++) {
            b->pull[k] += mode[i] * y[i];
        }
    }
    b->across = b->count;
    b->rate[b->count++] = 0;
    return true;
}

// x' K y from the bends of both, a sum in which nothing cancels where modes bend little.
static double strain_product(const arm *a, const double *x, const double *y)
{
    double sum = 0;
    for (int k = 0; k + 1 < a->dof; k++) {
        const double s = k + 1 == a->first ? a->hub_stiffness : a->joint_stiffness;
        sum += s * (x[k + 1] - x[k]) * (y[k + 1] - y[k]);
    }
    return sum;
}

// The slow modes anew. All come with an absolute error of rounding times the fastest one's square,
// which of hundreds of links is more than the slow ones' squares. But it hardly mixes fast modes
// into the slow ones: so these are found again among themselves, from products that have their own
// size; of them the slower ones again, and so on. Storage: 2 (columns / REFINED_SHARE)^2 doubles in
// `small`, as many times n in `rows`, 3 n in `more`.
static bool refine_slow(modal_basis *b, const arm *a, double *small, double *rows, double *more)
{
    enum { REFINED_SHARE = 4, FEWEST = 4 };
    const size_t n = (size_t)a->dof;
    for (int m = b->count / REFINED_SHARE; m >= FEWEST; m /= REFINED_SHARE) {
        const size_t side = (size_t)m;
        double *stiffness = small, *mass = small + side * side;

        // both matrices on their span
        for (size_t i = 0; i < side; i++) {
            const double *mode = b->by_mode + i * n;
            modal_mass_times(a, mode, more);
            for (size_t j = 0; j <= i; j++) {
                const double *other = b->by_mode + j * n;
                double sum = 0;
                for (size_t k = 0; k < n; k++) {
                    sum += more[k] * other[k];
                }
                mass[i * side + j] = mass[j * side + i] = sum;
                const double strain = strain_product(a, mode, other);
                stiffness[i * side + j] = stiffness[j * side + i] = strain;
            }
        }
        if (!symmetric_eigen_pair(m, stiffness, mass, b->rate, more)) {
            return false;
        }

        // the modes, as combinations of what they were
        for (size_t i = 0; i < side; i++) {
            double *row = rows + i * n;
            memset(row, 0, n * sizeof *row);
            for (size_t j = 0; j < side; j++) {
                const double share = stiffness[i * side + j];
                for (size_t k = 0; k < n; k++) {
                    row[k] += share * b->by_mode[j * n + k];
                }
            }
        }
        memcpy(b->by_mode, rows, side * n * sizeof *rows);
    }
    return true;
}

status modal_basis_compute(modal_basis *b, const arm *a, bool contact, bool stuck, double *scratch)
{
    const int n = a->dof;
    const allowed w = {.columns = n - stuck - contact,
                       .start = stuck ? 1 : 0,
                       .last = contact ? n - 1 : -1,
                       .arm = a};
    const int columns = w.columns;
    const size_t size = (size_t)n * (size_t)n, side = (size_t)columns;
    double *mass = scratch, *matrix = scratch + size, *x = scratch + 3 * size, *y = x + n;
    double *more = y + n; // 3 n

    // K x = omega^2 M0 x on the angles allowed
    reduce(&w, modal_mass_times, mass, x, y);
    reduce(&w, modal_stiffness_times, matrix, x, y);
    if (columns > 0 && !symmetric_eigen_pair(columns, matrix, mass, b->rate, more)) {
        return STATUS_SINGULAR;
    }

    // modes as angles
    b->count = columns;
    b->across = -1;
    memset(b->pull, 0, (size_t)n * sizeof *b->pull);
    for (int k = 0; k < columns; k++) {
        double *row = b->by_mode + (size_t)k * (size_t)n, *z = matrix + (size_t)k * side;
        memset(row, 0, (size_t)n * sizeof *row);
        for (int c = 0; c < columns; c++) {
            row[w.start + c] += z[c];
            if (w.last >= 0 && w.start + c >= a->first) {
                row[w.last] -= z[c];
            }
        }
    }
    if (!refine_slow(b, a, mass, matrix, more)) {
        return STATUS_SINGULAR;
    }

    // a rigid mode's zero comes out as rounding of a faster mode's square
    for (int k = 0; k < columns; k++) {
        const double faster = b->rate[k + 4 < columns ? k + 4 : columns - 1];
        b->rate[k] = sqrt(b->rate[k] > 1e-13 * faster ? b->rate[k] : 0);
    }
    if (contact && !add_gradient(b, a, w.start, mass, x, y)) {
        return STATUS_SINGULAR;
    }

    // the same by degree of freedom
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < b->count; k++) {
            b->by_dof[(size_t)i * (size_t)n + (size_t)k] =
                b->by_mode[(size_t)k * (size_t)n + (size_t)i];
        }
    }
    return STATUS_OK;
}

// --- between angles and modes -----------------------------------------------------------------

// out[column][j] = sum over i < rows of in[column][i] matrix[i][j], j < width.
static inline __attribute__((always_inline)) void combine(const double *matrix, int side, int rows,
                                                          int width, int columns, const double *in,
                                                          double *out, int stride)
{
    for (int c = 0; c < columns; c++) {
        memset(out + (size_t)c * (size_t)stride, 0, (size_t)width * sizeof *out);
    }

    // four rows at a time, so that a sum is loaded and stored once for them
    int i = 0;
    for (; i + 4 <= rows; i += 4) {
        const double *restrict r0 = matrix + (size_t)i * (size_t)side;
        const double *restrict r1 = r0 + side, *restrict r2 = r1 + side, *restrict r3 = r2 + side;
        for (int c = 0; c < columns; c++) {
            const double *x = in + (size_t)c * (size_t)stride + i;
            const double x0 = x[0], x1 = x[1], x2 = x[2], x3 = x[3];
            double *restrict y = out + (size_t)c * (size_t)stride;
            for (int j = 0; j < width; j++) {
                y[j] += (x0 * r0[j] + x1 * r1[j]) + (x2 * r2[j] + x3 * r3[j]);
            }
        }
    }

    for (; i < rows; i++) {
        const double *restrict row = matrix + (size_t)i * (size_t)side;
        for (int c = 0; c < columns; c++) {
            const double x = in[(size_t)c * (size_t)stride + (size_t)i];
            double *restrict y = out + (size_t)c * (size_t)stride;
            for (int j = 0; j < width; j++) {
                y[j] += x * row[j];
            }
        }
    }
}

// The same operations in the same order, with as many at once as the processor can.
#if defined(__x86_64__)
__attribute__((target("avx2"))) static void combine_by_four(const double *matrix, int side,
                                                            int rows, int width, int columns,
                                                            const double *in, double *out,
                                                            int stride)
{
    combine(matrix, side, rows, width, columns, in, out, stride);
}
#endif

static void combine_rows(const double *matrix, int side, int rows, int width, int columns,
                         const double *in, double *out, int stride)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) {
        combine_by_four(matrix, side, rows, width, columns, in, out, stride);
        return;
    }
#endif
    combine(matrix, side, rows, width, columns, in, out, stride);
}

void modal_to_angles(const modal_basis *b, int dof, int columns, const double *coordinates,
                     double *angles, int stride)
{
    combine_rows(b->by_mode, dof, b->count, dof, columns, coordinates, angles, stride);
}

void modal_from_angles(const modal_basis *b, int dof, int columns, const double *angles,
                       double *coordinates, int stride)
{
    combine_rows(b->by_dof, dof, dof, b->count, columns, angles, coordinates, stride);
}
