// What another torque of the motor does at once to a two-link arm whose hub slides.
#include "src/arm/chain_pair.h"
#include "src/base/sincos.h"
#include "src/engines/pair/taylor_lanes.h"

// J, the entries of dg/dq, as taylor_order.h has them [m].
static void levers(const arm *a, const double *q, double bend_cosine, double j[2])
{
    const wall_model *w = &a->wall;
    double s, c;
    inline_sincos(q[1], &s, &c);
    if (w->kind == WALL_POINT) {
        j[0] = a->link_length * bend_cosine;
        j[1] = w->x * c + w->y * s - j[0];
        return;
    }
    j[1] = a->link_length * (w->cosine * c + w->sine * s);
    inline_sincos(q[0], &s, &c);
    j[0] = a->link_length * (w->cosine * c + w->sine * s);
}

void taylor_retorque(const arm *a, motion *m, double change)
{
    double *state = m->state, *acceleration = state_accelerations(m, state);
    if (a->hub_spring) {
        acceleration[0] += change / a->hub_inertia; // the links do not feel it yet
        return;
    }

    // M^-1 of a unit torque on the first link
    const double *q = state_angles(m, state), c = inline_cos(q[1] - q[0]);
    const pair_mass mass = pair_mass_of(a);
    double first, second;
    pair_solve(&mass, mass.m12 * c, false, 1, 0, &first, &second);

    // and what the wall makes of it: in contact its force keeps the gap's rate from changing
    if (wall_stands(&a->wall)) {
        double j[2], y1, y2;
        levers(a, q, c, j);
        const double closing = j[0] * first + j[1] * second;
        if (state[SLOT_CONTACT] != 0) {
            pair_solve(&mass, mass.m12 * c, false, j[0], j[1], &y1, &y2);
            const double force = closing / (j[0] * y1 + j[1] * y2);
            first -= y1 * force;
            second -= y2 * force;
            state[SLOT_FORCE] += force * change;
        } else {
            state[SLOT_GAP_ACCELERATION] -= closing * change;
        }
    }
    acceleration[0] += first * change;
    acceleration[1] += second * change;
}
