// The chain at LANES points of a stride side by side (modal_parts.h), one after the other of those
// that are given; the lanes left over repeat the last one. Whoever includes this gives LANES.
#pragma once

#include "src/solve/modal_parts.h"
#include "src/solve/modal_points.h"
#include "src/solve/taylor_numbers.h"

// Vectors are handed to inline functions only.
#pragma GCC diagnostic ignored "-Wpsabi"

typedef struct momentum_link {
    real c, s, inv_d, ux, uy, free, unit;
} momentum_link;
#include "src/arm/chain_momentum_kernel.h"
#include "src/solve/modal_straight.h"

// A lane's number.
#define LANE(x, i)  (((double *)&(x))[i])

#define SMALL_ANGLE 0.78539816339744831 // up to which sine and cosine need no reduction [rad]
#define LARGE_ANGLE 1e5                 // beyond which their reduction is not exact [rad]

// Arrays of one chain a lane, by degree of freedom or link.
typedef struct lanes {
    real *angles, *momentum, *velocities, *rates, *products;
    momentum_link *links;
} lanes;

static lanes lanes_of(const modal_stride *s)
{
    real *arrays = (real *)(void *)s->lanes;
    const int n = s->dof;
    return (lanes){.angles = arrays,
                   .momentum = arrays + n,
                   .velocities = arrays + 2 * n,
                   .rates = arrays + 3 * n,
                   .products = arrays + 4 * n,
                   .links = (momentum_link *)(arrays + 5 * n)};
}

// Element k of every lane's vector.
KERNEL real gather(const double *const from[LANES], int k)
{
#if LANES == 8
    return (real){from[0][k], from[1][k], from[2][k], from[3][k],
                  from[4][k], from[5][k], from[6][k], from[7][k]};
#elif LANES == 4
    return (real){from[0][k], from[1][k], from[2][k], from[3][k]};
#elif LANES == 2
    return (real){from[0][k], from[1][k]};
#else
    return from[0][k];
#endif
}

// Directions of all links, at angles of any size.
KERNEL void directions(const arm *a, const lanes *l)
{
    const real *theta = l->angles + a->first;
    mask large = {0}, huge = {0};
    for (int k = 0; k < a->links; k++) {
        large |= ~MASK(magnitude(theta[k]) <= SMALL_ANGLE);
        huge |= ~MASK(magnitude(theta[k]) < LARGE_ANGLE);
    }
    const bool far = any(large), beyond = any(huge);

    for (int k = 0; k < a->links; k++) {
        momentum_link *link = &l->links[k];
        if (!far) {
            SINCOS_NEAR_ZERO(real, theta[k], link->s, link->c);
            continue;
        }
        sine_cosine(theta[k], &link->s, &link->c);
        for (int i = 0; i < LANES && beyond; i++) {
            inline_sincos(LANE(theta[k], i), &LANE(link->s, i), &LANE(link->c, i));
        }
    }
}

// The wall as every lane meets it.
KERNEL momentum_wall wall_of(const arm *a, const lanes *l)
{
    const double length = a->link_length;
    const int last = a->links - 1;
    momentum_wall wall;
    real x = {0}, y = {0};
    for (int k = 0; k < last; k++) {
        x += length * l->links[k].c;
        y += length * l->links[k].s;
    }
    for (int i = 0; i < LANES; i++) {
        const wall_contact at =
            wall_contact_at(&a->wall, length, LANE(x, i), LANE(y, i), 0, 0,
                            LANE(l->links[last].c, i), LANE(l->links[last].s, i), 0);
        LANE(wall.ex, i) = at.ex;
        LANE(wall.ey, i) = at.ey;
        LANE(wall.lever, i) = at.lever;
        LANE(wall.penetration, i) = at.penetration;
    }
    return wall;
}

void GLUE(modal_sweep_points_, LANES)(modal_stride *s, const arm *a, const double *q, int first)
{
    const lanes l = lanes_of(s);
    const int n = s->dof;
    const ptrdiff_t row = s->row;
    const bool stuck = s->mode.friction == HUB_STICK;

    // angles, and momenta by the straight chain's mass
    const double *turns[LANES], *moved[LANES], *tips[LANES];
    for (int i = 0; i < LANES; i++) {
        const int point = first + i < MODAL_NODES ? first + i : MODAL_NODES - 1;
        turns[i] = s->more_columns + 2 * point * row;
        moved[i] = turns[i] + row;
        tips[i] = &s->tip[point];
    }
    for (int k = 0; k < n; k++) {
        l.angles[k] = q[k] + gather(turns, k);
        l.products[k] = gather(moved, k);
    }
    straight_mass_times(a, l.products, l.momentum);
    const real tip = gather(tips, 0);
    for (int k = 0; k < n; k++) {
        l.momentum[k] += s->momentum[k] + (k >= a->first ? tip : (real){0});
    }
    l.momentum[n - 1] += s->modes->lever * tip;

    // velocities and forces
    directions(a, &l);
    real impulse;
    if (s->mode.contact) {
        const momentum_wall wall = wall_of(a, &l);
        momentum_sweep(a, true, stuck, l.links, &wall, l.momentum, l.velocities, l.rates, &impulse);
    } else {
        const momentum_wall none = {0};
        momentum_sweep(a, false, stuck, l.links, &none, l.momentum, l.velocities, l.rates,
                       &impulse);
    }
    straight_forces_left(a, modal_hub_torque(s, a), l.angles, l.velocities, l.rates, l.momentum);

    // momenta of the straight chain without what is across the constraint
    const real speed = straight_across(a, s->modes->lever, l.velocities) / s->modes->reach;
    const double *shift =
        s->modes->by_mode + (s->modes->across > 0 ? s->modes->across : 0) * (ptrdiff_t)n;
    for (int k = 0; k < n; k++) {
        l.products[k] = l.velocities[k] - (s->mode.contact ? speed * shift[k] : (real){0});
    }
    straight_mass_times(a, l.products, l.rates);

    // back to every point
    for (int i = 0; i < LANES && first + i < MODAL_NODES; i++) {
        const int point = first + i;
        double *columns = s->more_columns + 2 * point * row, *forces = columns + row;
        for (int k = 0; k < n; k++) {
            columns[k] = LANE(l.rates[k], i);
            forces[k] = LANE(l.momentum[k], i);
            s->point_angles[point][k] = LANE(l.angles[k], i);
            s->point_velocities[point][k] = LANE(l.velocities[k], i);
        }
        if (s->mode.contact) {
            s->drifts[point][s->modes->across] = LANE(speed, i);
        }
    }
}
