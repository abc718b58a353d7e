#include <stdint.h>
#include <string.h>

#include "src/solve/modal_loops.h"
#include "src/solve/modal_parts.h"
#include "src/solve/modal_points.h"

enum { COLUMNS = 2 * MODAL_NODES, TRANSIENT_ARRAYS = 6 };

// Doubles of an array by mode.
static size_t row_of(int dof)
{
    return ((size_t)dof + MODAL_LANES - 1) / MODAL_LANES * MODAL_LANES;
}

// Doubles of an array of transients, of which an overdamped mode has two.
static size_t transients_of(size_t n)
{
    return 2 * n + MODAL_LANES;
}

static size_t table_size(size_t n)
{
    return n * (MODAL_POWERS + 2);
}

static size_t kept_size(size_t n)
{
    size_t doubles = 0;
    for (int i = 1; i < MODAL_NODES; i++) {
        doubles += n * (size_t)(modal_kept_powers(i) + 2);
    }
    return doubles;
}

size_t modal_stride_size(const arm *a)
{
    const size_t n = row_of(a->dof);

    // bases and their scratch, tables, vectors
    size_t doubles =
        MODAL_CONTACT_STATES * (modal_basis_size(a->dof) + modal_vibrations_size(a->dof)) +
        modal_basis_scratch(a->dof);
    doubles += table_size(n);
    doubles += MODAL_CONTACT_STATES * MODAL_KEPT * kept_size(n);
    doubles += n * (10 + 7 * MODAL_NODES + 3 * COLUMNS);
    doubles += TRANSIENT_ARRAYS * transients_of(n);
    doubles += modal_points_size(a->dof) + MODAL_LANES;
    return sizeof(modal_stride) + doubles * sizeof(double);
}

static double *take(double **storage, size_t count)
{
    double *taken = *storage;
    *storage += count;
    return taken;
}

static void place_table(modal_table *at, double **storage, size_t n, int powers)
{
    at->impulse = take(storage, n);
    at->impulse_rate = take(storage, n);
    for (int j = 0; j < powers; j++) {
        at->power[j] = take(storage, n);
    }
}

static void place_kept(modal_kept *keep, double **storage, size_t n)
{
    for (int i = 1; i < MODAL_NODES; i++) {
        place_table(&keep->at[i], storage, n, modal_kept_powers(i));
    }
}

void modal_stride_place(modal_stride *s, const arm *a)
{
    const size_t n = row_of(a->dof);
    double *storage = (double *)(s + 1);
    memset(s, 0, sizeof *s);
    s->dof = a->dof;
    s->row = (int)n;

    // lanes and arrays by mode begin at whole vectors
    const size_t beyond = (uintptr_t)storage / sizeof(double) % MODAL_LANES;
    (void)take(&storage, (MODAL_LANES - beyond) % MODAL_LANES);
    s->lanes = take(&storage, modal_points_size(a->dof));

    // what there is once a point of collocation
    for (int i = 0; i < MODAL_NODES; i++) {
        s->point_angles[i] = take(&storage, n);
        s->point_velocities[i] = take(&storage, n);
        s->drift[i] = take(&storage, n);
        s->force[i] = take(&storage, n);
        s->followed[i] = take(&storage, n);
        s->drifts[i] = take(&storage, n);
        s->forces[i] = take(&storage, n);
    }

    // what there is once a stride
    s->damping = take(&storage, n);
    s->viscous = take(&storage, n);
    s->softness = take(&storage, n);
    s->start = take(&storage, n);
    s->momentum = take(&storage, n);
    s->columns = take(&storage, n * COLUMNS);
    s->more_columns = take(&storage, n * COLUMNS);
    s->modal = take(&storage, n * COLUMNS);

    // what there is once an instant
    s->angles = take(&storage, n);
    s->velocities = take(&storage, n);
    s->rates = take(&storage, n);
    s->place = take(&storage, n);
    s->momenta = take(&storage, n);
    s->transients.decay = take(&storage, transients_of(n));
    s->transients.turn = take(&storage, transients_of(n));
    s->transients.cosine = take(&storage, transients_of(n));
    s->transients.sine = take(&storage, transients_of(n));
    s->transients.end_cosine = take(&storage, transients_of(n));
    s->transients.end_sine = take(&storage, transients_of(n));
    place_table(&s->at[0], &storage, n, MODAL_POWERS);
    for (int i = 0; i < MODAL_CONTACT_STATES; i++) {
        for (int j = 0; j < MODAL_KEPT; j++) {
            place_kept(&s->kept[i][j], &storage, n);
        }
    }

    // bases
    for (int i = 0; i < MODAL_CONTACT_STATES; i++) {
        modal_basis_place(&s->basis[i], a->dof, take(&storage, modal_basis_size(a->dof)));
        modal_vibrations_place(&s->vibrations[i], a->dof,
                               take(&storage, modal_vibrations_size(a->dof)));
    }
    s->scratch = take(&storage, modal_basis_scratch(a->dof));
}
