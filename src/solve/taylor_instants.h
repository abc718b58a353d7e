// What the series of one arm come to at LANES instants of their stride at once: what state_at of
// taylor_engine.c and chain_kinetic_energy, chain_strain_energy find for one, to the last bit.
//
// With u = t^2 a polynomial is E(u) + t O(u), its even and its odd terms.
#include "src/solve/taylor_numbers.h"
#include "src/solve/taylor_series.h"

#define INSTANTS GLUE(taylor_instants_, LANES)

KERNEL real lanes_at(const double *place)
{
    real x;
    memcpy(&x, place, sizeof x);
    return x;
}

KERNEL void put(double *place, real x)
{
    memcpy(place, &x, sizeof x);
}

KERNEL real value_of(const double *terms, int count, real t, real u)
{
    real even = (real){0} + terms[count - 2], odd = (real){0} + terms[count - 1];
    for (int n = count - 4; n >= 0; n -= 2) {
        even = even * u + terms[n];
        odd = odd * u + terms[n + 1];
    }
    return even + t * odd;
}

KERNEL real integral_of(const double *terms, int count, real t, real u)
{
    real even = (real){0} + terms[count - 2] * inverse[count - 1];
    real odd = (real){0} + terms[count - 1] * inverse[count];
    for (int n = count - 4; n >= 0; n -= 2) {
        even = even * u + terms[n] * inverse[n + 1];
        odd = odd * u + terms[n + 1] * inverse[n + 2];
    }
    return t * (even + t * odd);
}

// Value, first and second derivative, p' = O + 2 t (E' + t O'), p'' = 2 E' + 6 t O' + 4 u (E'' + t
// O''), the dashes on the right by u.
KERNEL void derivatives_of(const double *terms, int count, real t, real u, real result[3])
{
    const real zero = (real){0};
    real even = zero + terms[count - 2], odd = zero + terms[count - 1];
    real even1 = zero, odd1 = zero, even2 = zero, odd2 = zero;
    for (int n = count - 4; n >= 0; n -= 2) {
        even2 = even2 * u + even1;
        odd2 = odd2 * u + odd1;
        even1 = even1 * u + even;
        odd1 = odd1 * u + odd;
        even = even * u + terms[n];
        odd = odd * u + terms[n + 1];
    }
    result[0] = even + t * odd;
    result[1] = odd + 2 * t * (even1 + t * odd1);
    result[2] = 2 * even1 + 6 * t * odd1 + 8 * u * (even2 + t * odd2);
}

// Gap, its rate and second derivative from directions, velocities and accelerations of the links.
KERNEL void gap_of(const arm *a, const real s[2], const real c[2], const real w[2],
                   const real al[2], taylor_instants *at)
{
    const double l = a->link_length;
    const wall_model *wall = &a->wall;
    const real vx = -l * s[0] * w[0], vy = l * c[0] * w[0];
    const real x = l * c[0], y = l * s[0], omega = w[1];
    real ex = -s[1], ey = c[1], off = (real){0}, penetration, convective;

    // a point pushes across the link, a plane across its own surface
    if (wall->kind == WALL_POINT) {
        const real dx = wall->x - x, dy = wall->y - y;
        off = c[1] * dx + s[1] * dy - l;
        penetration = s[1] * dx - c[1] * dy;
        convective = -penetration * omega * omega - 2 * omega * (c[1] * vx + s[1] * vy);
    } else {
        ex = (real){0} + -wall->sine;
        ey = (real){0} + wall->cosine;
        penetration = ex * (x + l * c[1]) + ey * (y + l * s[1]);
        convective = -l * omega * omega * (ex * c[1] + ey * s[1]);
    }
    const real lever = off + l * (c[1] * ey - s[1] * ex);

    const real ax = -l * (s[0] * al[0] + c[0] * w[0] * w[0]);
    const real ay = l * (c[0] * al[0] - s[0] * w[0] * w[0]);
    put(at->gap, -penetration);
    put(at->gap_velocity, -(ex * vx + ey * vy + lever * omega));
    put(at->gap_acceleration, -(ex * ax + ey * ay + lever * al[1] + convective));
}

// Energies of motion and of bending.
KERNEL void energies_of(const arm *a, const real s[2], const real c[2], const real q[3],
                        const real w[3], taylor_instants *at)
{
    const double l = a->link_length;
    const int hub = 1 - a->first;
    real vx = (real){0}, vy = vx, kinetic = a->hub_inertia * w[hub] * w[hub], strain = vx;
    for (int k = 0; k < 2; k++) {
        const real turn = w[k + 1], across_x = -l * s[k] * turn, across_y = l * c[k] * turn;
        const real cx = vx + across_x / 2, cy = vy + across_y / 2;
        kinetic += a->link_mass * (cx * cx + cy * cy) + a->link_inertia * turn * turn;
        vx += across_x;
        vy += across_y;
    }
    if (a->hub_spring) {
        const real bend = q[1] - q[0];
        strain += a->hub_stiffness * bend * bend;
    }
    const real bend = q[2] - q[1];
    strain += a->joint_stiffness * bend * bend;
    put(at->kinetic, kinetic / 2);
    put(at->strain, strain / 2);
}

void INSTANTS(const arm *a, const double *block, taylor_form form, taylor_instants *at)
{
    const real t = lanes_at(at->time), u = t * t;
    const bool rests = block[AT_STUCK] != 0;
    const int order = form.order, first = a->first;
    real q[3] = {0}, w[3] = {0}, al[3] = {0};

    // the motion; a stuck hub has none
    for (int i = 1 - first; i < 3; i++) {
        real d[3];
        derivatives_of(block + AT_ANGLE_0 + i * (TAYLOR_MOST + 2), order + 2, t, u, d);
        const bool still = rests && i == 1 - first;
        q[i] = d[0];
        w[i] = still ? (real){0} : d[1];
        al[i] = still ? (real){0} : d[2];
        put(at->angle[i], q[i]);
        put(at->velocity[i], w[i]);
        put(at->acceleration[i], al[i]);
    }

    // what it has lost and pressed
    put(at->hub_square, integral_of(block + AT_HUB_SQUARE, order, t, u));
    if (form.damped) {
        put(at->dissipated, integral_of(block + AT_DISSIPATION, order, t, u));
        put(at->dissipation, value_of(block + AT_DISSIPATION, order, t, u));
    }
    if (rests) {
        put(at->hold, value_of(block + AT_HOLD, order, t, u));
    }
    if (form.contact) {
        put(at->force, value_of(block + AT_FORCE, order, t, u));
        put(at->pressed, integral_of(block + AT_FORCE, order, t, u));
    }

    // where the links point, and what follows from that
    real s[2], c[2];
    sine_cosine(q[1], &s[0], &c[0]);
    sine_cosine(q[2], &s[1], &c[1]);
    if (wall_stands(&a->wall)) {
        gap_of(a, s, c, w + 1, al + 1, at);
    }
    energies_of(a, s, c, q, w, at);
}
