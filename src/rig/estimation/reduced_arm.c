#include "src/rig/estimation/reduced_arm.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/arm/modes.h"
#include "src/base/dense.h"

#define PI 3.14159265358979323846

// Modes above this share of the Nyquist frequency are left out: a sample would follow
// them at least a quarter of their period late.
#define MODES_BELOW 0.5

// The chain that the setup describes, without motor and wall.
static void nominal_arm(arm *a, const controller_setup *setup, double tip_mass)
{
    parameters p;
    parameters_defaults(&p, ARM_CORRECTED);
    p.arm.links = setup->links;
    p.arm.mass = 2 * setup->link_mass;
    p.arm.tip_mass = tip_mass;
    p.arm.length = 2 * setup->link_length;
    p.arm.hub_inertia = setup->hub_inertia;
    p.arm.k2 = setup->k2;
    p.arm.damping_ratio = setup->damping_ratio;
    p.arm.hub_joint = HUB_RIGID;
    if (isfinite(setup->hub_spring)) {
        p.arm.hub_joint = HUB_SPRING;
        p.arm.k1 = setup->hub_spring;
    }

    // a link's inertia is the setup's for two links, that of a rod for more
    double m = p.arm.mass / p.arm.links, l = p.arm.length / p.arm.links;
    if (setup->links == 2) {
        p.arm.link_inertia = setup->link_inertia;
    } else {
        p.arm.link_inertia = m * l * l / 12;
    }
    arm_init(a, &p);
}

// Fills a set with the lowest of the modes found, up to a frequency [rad/s], but at least
// one that bends. The shapes may have any scale; those that are kept are normalised to
// x'M x = 1.
static void take_modes(mode_set *set, const arm *a, const double *mass, double highest,
                       int found, const double *frequencies, double *shapes)
{
    const int n = a->dof;
    double per_stiffness =
        a->joint_stiffness > 0 ? a->joint_damping / a->joint_stiffness : 0;
    set->count = 0;
    for (int k = 0; k < found && set->count < REDUCED_MODES; k++) {
        bool bends_already = set->count > 0 && set->square[set->count - 1] > 0;
        if (frequencies[k] > highest && bends_already) {
            break;
        }

        // x'M x, the momentum x'M r for the rotation r = (1 ... 1), and the tip
        double *x = &shapes[k * n], norm = 0, momentum = 0, tip = 0;
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < n; j++) {
                norm += x[i] * mass[i * n + j] * x[j];
                momentum += x[i] * mass[i * n + j];
            }
            if (i >= a->first) {
                tip += x[i] / a->links;
            }
        }

        // the shape normalised, and what the set says of it
        double scale = 1 / sqrt(norm);
        for (int i = 0; i < n; i++) {
            x[i] *= scale;
        }
        int at = set->count++;
        set->square[at] = frequencies[k] * frequencies[k];
        set->damping[at] = per_stiffness * set->square[at];
        set->hub[at] = x[0];
        set->tip[at] = tip * scale;
        set->momentum[at] = momentum * scale;
    }
}

// Matrices and shapes of the whole chain, while it is reduced.
typedef struct chain_modes {
    double *mass, *stiffness, *frequencies, *free, *contact;
    double *copy, *scratch; // of mass; 2 dof
} chain_modes;

const char reduced_arm_no_memory[] = "there is no memory for its model";

// Frequencies and shapes of the modes in contact with a wall of a stiffness [N/m],
// HUGE_VAL for a rigid one; `count` becomes their number.
static status contact_modes(const arm *a, double wall_stiffness, const chain_modes *work,
                            int *count)
{
    const int n = a->dof;
    if (!isfinite(wall_stiffness)) {
        return modes_compute(a, HUB_FREE, TIP_PINNED, count, work->frequencies,
                             work->contact);
    }

    // the wall's spring acts on the tip, which all links move by their length
    const double l = a->link_length;
    memcpy(work->copy, work->mass, (size_t)(n * n) * sizeof *work->copy);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            const bool moves_tip = i >= a->first && j >= a->first;
            const double spring = moves_tip ? wall_stiffness * l * l : 0;
            work->contact[i * n + j] = work->stiffness[i * n + j] + spring;
        }
    }

    // the eigenvalues are squared frequencies, which rounding may leave below zero
    *count = n;
    if (!symmetric_eigen_pair(n, work->contact, work->copy, work->frequencies,
                              work->scratch)) {
        return STATUS_SINGULAR;
    }
    for (int i = 0; i < n; i++) {
        work->frequencies[i] = sqrt(fmax(work->frequencies[i], 0));
    }
    return STATUS_OK;
}

// Computes the projection of free modes onto those in contact at a touch, X = x_c'M x_f,
// and the inertia of the rotation, r'M r with r = (1 ... 1).
static void project_touch(reduced_arm *r, int n, const chain_modes *work)
{
    r->inertia = 0;
    for (int i = 0; i < n * n; i++) {
        r->inertia += work->mass[i];
    }

    for (int c = 0; c < r->contact.count; c++) {
        for (int f = 0; f < r->free.count; f++) {
            r->touch[c][f] = 0;
            for (int i = 0; i < n; i++) {
                for (int j = 0; j < n; j++) {
                    r->touch[c][f] += work->contact[c * n + i] * work->mass[i * n + j] *
                                      work->free[f * n + j];
                }
            }
        }
    }
}

// Computes the modes of a chain that are kept, free and in contact. NULL, or a sentence
// that says why there are none.
static const char *reduce(reduced_arm *r, const arm *a, const controller_setup *setup,
                          double wall_stiffness, const chain_modes *work)
{
    const int n = a->dof;
    const double highest = MODES_BELOW * PI / setup->period;
    int free_count = 0, contact_count = 0;
    modes_matrices(a, work->mass, work->stiffness);

    // the free modes, then those in contact, whose shapes have their own memory
    status code =
        modes_compute(a, HUB_FREE, TIP_FREE, &free_count, work->frequencies, work->free);
    if (code == STATUS_OK) {
        take_modes(&r->free, a, work->mass, highest, free_count, work->frequencies,
                   work->free);
        code = contact_modes(a, wall_stiffness, work, &contact_count);
    }
    if (code == STATUS_NO_MEMORY) {
        return reduced_arm_no_memory;
    }
    if (code != STATUS_OK) {
        return "the modes of the arm it believes in cannot be computed";
    }
    take_modes(&r->contact, a, work->mass, highest, contact_count, work->frequencies,
               work->contact);
    if (r->contact.count == 0 || r->free.count < 2) {
        return "the arm it believes in does not bend";
    }

    project_touch(r, n, work);
    return NULL;
}

const char *reduced_arm_init(reduced_arm *r, const controller_setup *setup,
                             double tip_mass, double wall_stiffness)
{
    arm a;
    memset(r, 0, sizeof *r);
    nominal_arm(&a, setup, tip_mass);
    r->length = 2 * setup->link_length;

    // one block for the matrices and shapes of the whole chain
    size_t square = (size_t)a.dof * (size_t)a.dof;
    double *block = calloc(5 * square + 3 * (size_t)a.dof, sizeof *block);
    if (block == NULL) {
        return reduced_arm_no_memory;
    }
    chain_modes work = {.mass = block,
                        .stiffness = block + square,
                        .free = block + 2 * square,
                        .contact = block + 3 * square,
                        .copy = block + 4 * square,
                        .frequencies = block + 5 * square,
                        .scratch = block + 5 * square + a.dof};
    const char *refusal = reduce(r, &a, setup, wall_stiffness, &work);
    free(block);
    return refusal;
}

double reduced_arm_compliance(const reduced_arm *r)
{
    double sum = 0;
    for (int i = 0; i < r->contact.count; i++) {
        sum += r->contact.hub[i] * r->contact.hub[i] / r->contact.square[i];
    }
    return sum;
}
