// The sweeps of chain_momentum.h as an inline function of numbers of the type `real`, which whoever
// includes this names with momentum_link, a chain_link of such numbers: doubles, or vectors with a
// chain in each lane. The same operations in the same order, so that all get the same bits.
#pragma once

#include "src/arm/arm.h"

#define MOMENTUM_KERNEL static inline __attribute__((always_inline))

// The wall as the last link meets it (wall_contact).
typedef struct momentum_wall {
    real ex, ey, lever, penetration;
} momentum_wall;

// J_N, and the rate of penetration with the last link's base moving at (vx, vy).
MOMENTUM_KERNEL real momentum_lever(const momentum_wall *wall, double l, const momentum_link *last)
{
    return wall->lever + l * (last->c * wall->ey - last->s * wall->ex);
}
MOMENTUM_KERNEL real momentum_closing(const momentum_wall *wall, real vx, real vy, real lever,
                                      real omega)
{
    return wall->ex * vx + wall->ey * vy + lever * omega;
}

// dT/dq and J'^T L at velocities w, the last link's base moving at (vx, vy).
MOMENTUM_KERNEL void momentum_rate(const arm *a, bool contact, const momentum_link *link,
                                   const momentum_wall *wall, real impulse, real vx, real vy,
                                   const real *w, real *rate)
{
    const double l = a->link_length, m = a->link_mass;
    const real *omega = w + a->first, zero = {0};
    const int last = a->links - 1;
    const bool moves = a->wall.kind == WALL_POINT; // the force's direction turns with the last link
    const real base_x = vx, base_y = vy;
    real px = zero, py = zero;
    real ex = vx - l * link[last].s * omega[last], ey = vy + l * link[last].c * omega[last];

    // from the tip inwards: px, py is the momentum of the links beyond, ex, ey the end's velocity
    for (int k = last; k >= 0; k--) {
        const real c = link[k].c, s = link[k].s;
        const real dx = -l * s * omega[k], dy = l * c * omega[k];
        const real mx = m * (ex - dx / 2), my = m * (ey - dy / 2);
        real sum = -omega[k] * (c * l * (px + mx / 2) + s * l * (py + my / 2));

        // the impulse's share, at a point with a direction that turns
        if (contact && (k < last || !moves)) {
            real turn = -l * omega[k] * (c * wall->ex + s * wall->ey);
            if (moves) { // e = t_N, e' = -w_N r_N
                turn -= l * omega[last] * (-s * link[last].c + c * link[last].s);
            }
            sum += impulse * turn;
        } else if (contact) {
            // the point's distance along the last link
            sum += impulse * (-wall->penetration * omega[last] -
                              (link[last].c * base_x + link[last].s * base_y));
        }

        // on to the link before
        rate[a->first + k] = sum;
        px += mx;
        py += my;
        ex -= dx;
        ey -= dy;
    }

    // the energy of motion does not depend on the angle of a hub of its own
    if (a->first > 0) {
        rate[0] = zero;
    }
}

// What chain_from_momentum gives, the links' directions standing in link[].c and s.
MOMENTUM_KERNEL void momentum_sweep(const arm *a, bool contact, bool stuck, momentum_link *link,
                                    const momentum_wall *wall, const real *momentum, real *w,
                                    real *rate, real *impulse)
{
    const double l = a->link_length, m = a->link_mass, half = 0.5 * l;
    const real *p = momentum + a->first, zero = {0};
    const int last = a->links - 1;

    // tip to hub
    real pxx = zero, pxy = zero, pyy = zero, fx = zero, fy = zero, gx = wall->ex, gy = wall->ey;
    for (int k = last; k >= 0; k--) {
        const real c = link[k].c, s = link[k].s;
        const real ptx = -pxx * s + pxy * c, pty = -pxy * s + pyy * c;
        const real ux = l * ptx - m * half * s, uy = l * pty + m * half * c;
        real d = a->link_inertia + m * half * half + l * l * (c * pty - s * ptx);
        real moment = p[k] - l * (c * fy - s * fx);
        if (k == 0 && !a->hub_spring) {
            d += a->hub_inertia;
            moment = stuck ? zero : moment;
        }
        const real inv_d = 1 / d;
        link[k].inv_d = inv_d;
        link[k].ux = ux;
        link[k].uy = uy;
        link[k].free = moment * inv_d;
        fx += ux * link[k].free;
        fy += uy * link[k].free;
        if (contact) {
            real unit = -l * (c * gy - s * gx) - (k == last ? wall->lever : zero);
            unit = k == 0 && !a->hub_spring && stuck ? zero : unit;
            link[k].unit = unit * inv_d;
            gx += ux * link[k].unit;
            gy += uy * link[k].unit;
        }
        pxx += m - ux * ux * inv_d;
        pxy -= ux * uy * inv_d;
        pyy += m - uy * uy * inv_d;
    }

    // hub to tip, and the impulse that keeps the contact
    real *omega = w + a->first, vx = zero, vy = zero, bx = zero, by = zero;
    for (int k = 0; k <= last; k++) {
        const real c = link[k].c, s = link[k].s;
        omega[k] = link[k].free - (link[k].ux * vx + link[k].uy * vy) * link[k].inv_d;
        if (contact) {
            link[k].unit -= (link[k].ux * bx + link[k].uy * by) * link[k].inv_d;
        }
        if (k < last) {
            vx -= l * s * omega[k];
            vy += l * c * omega[k];
        }
        if (contact && k < last) {
            bx -= l * s * link[k].unit;
            by += l * c * link[k].unit;
        }
    }
    *impulse = zero;
    if (contact) {
        const real lever = momentum_lever(wall, l, &link[last]);
        *impulse = -momentum_closing(wall, vx, vy, lever, omega[last]) /
                   momentum_closing(wall, bx, by, lever, link[last].unit);
        for (int k = 0; k <= last; k++) {
            omega[k] += *impulse * link[k].unit;
        }
        vx += *impulse * bx;
        vy += *impulse * by;
    }
    if (a->first > 0) {
        w[0] = stuck ? zero : momentum[0] / a->hub_inertia;
    }
    momentum_rate(a, contact, link, wall, *impulse, vx, vy, w, rate);
}
