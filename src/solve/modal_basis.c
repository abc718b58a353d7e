#include "src/solve/modal_basis.h"

#include <math.h>
#include <string.h>

#include "src/solve/modal_product.h"

typedef double real;
#include "src/solve/modal_straight.h"

// Rates that may be read behind the last, as of modes that do nothing.
enum { BEHIND = 7 };

size_t modal_basis_size(int n)
{
    return (size_t)n * (2 * (size_t)n + 2) + BEHIND;
}

size_t modal_basis_scratch(int n)
{
    return modal_shapes_scratch(n);
}

void modal_basis_place(modal_basis *b, int n, double *storage)
{
    b->count = 0;
    b->rate = storage;
    b->shared = storage + n + BEHIND;
    b->by_mode = b->shared + n;
    b->by_dof = b->by_mode + (size_t)n * (size_t)n;
}

// --- modes ------------------------------------------------------------------------------------

static double product_of(int n, const double *x, const double *y)
{
    double sum = 0;
    for (int i = 0; i < n; i++) {
        sum += x[i] * y[i];
    }
    return sum;
}

// The vector e, of unit length in M0, as one more mode.
static void add_shift(modal_basis *b, const arm *a, modal_ends ends, double *scratch)
{
    const int n = a->dof;
    double *row = b->by_mode + (size_t)b->count * (size_t)n, *product = scratch;
    modal_tip_shift(a, ends, row);
    modal_mass_times(a, row, product);
    const double length = sqrt(product_of(n, row, product));
    for (int i = 0; i < n; i++) {
        row[i] /= length;
        product[i] /= length;
    }
    b->reach = modal_basis_across(b, a, row);

    // what it has in common with the modes, and its stiffness
    for (int k = 0; k < b->count; k++) {
        b->shared[k] = product_of(n, b->by_mode + (size_t)k * (size_t)n, product);
    }
    modal_stiffness_times(a, row, product);
    b->stiff = ends.stuck ? product_of(n, row, product) : 0;
    b->across = b->count;
    b->rate[b->count++] = 0;
}

double modal_basis_across(const modal_basis *b, const arm *a, const double *x)
{
    return straight_across(a, b->lever, x);
}

status modal_basis_compute(modal_basis *b, const arm *a, modal_ends ends, double *scratch)
{
    const size_t n = (size_t)a->dof;
    const int modes = modal_shapes(a, ends, b->rate, b->by_mode, scratch);
    if (modes < 0) {
        return STATUS_SINGULAR;
    }
    b->count = modes;
    b->across = -1;
    b->lever = ends.lever;
    if (ends.contact) {
        add_shift(b, a, ends, scratch);
    }

    // the same by degree of freedom
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < (size_t)b->count; k++) {
            b->by_dof[i * n + k] = b->by_mode[k * n + i];
        }
    }
    return STATUS_OK;
}

// --- between angles and modes -----------------------------------------------------------------

void modal_to_angles(const modal_basis *b, int dof, int columns, const double *coordinates,
                     double *angles, int stride)
{
    const modal_product p = {b->by_mode, dof, b->count, dof, columns, stride};
    modal_multiply(&p, coordinates, angles);
}

void modal_from_angles(const modal_basis *b, int dof, int columns, const double *angles,
                       double *coordinates, int stride)
{
    const modal_product p = {b->by_dof, dof, dof, b->count, columns, stride};
    modal_multiply(&p, angles, coordinates);
}
