#include "src/arm/chain.h"

#include <math.h>

#include "src/arm/chain_pair.h"
#include "src/arm/forces.h"
#include "src/base/sincos.h"

void chain_node(const arm *a, const double *q, int k, double *x, double *y)
{
    *x = *y = 0;
    for (int i = 0; i < k; i++) {
        *x += arm_link_of(a, i).length * inline_cos(q[a->first + i]);
        *y += arm_link_of(a, i).length * inline_sin(q[a->first + i]);
    }
}

// Geometry of contact at q, w: how the wall meets the last link, the link's entry of
// dg/dq, and the velocity of its base.
typedef struct tip_contact {
    wall_contact wall;
    double lever, vx, vy;
} tip_contact;

// Computes that geometry: sums place and velocity of the last link's base, and meets the
// wall there.
static tip_contact contact_of(const arm *a, const double *q, const double *w)
{
    const int last = a->dof - 1;
    tip_contact at = {.vx = 0, .vy = 0};
    double x = 0, y = 0, c, s;
    for (int k = a->first; k < last; k++) {
        const double l = arm_link_of(a, k - a->first).length;
        inline_sincos(q[k], &s, &c);
        x += l * c;
        y += l * s;
        at.vx -= l * s * w[k];
        at.vy += l * c * w[k];
    }
    const double l = arm_link_of(a, a->links - 1).length;
    inline_sincos(q[last], &s, &c);
    at.wall = wall_contact_at(&a->wall, l, x, y, at.vx, at.vy, c, s, w[last]);
    at.lever = wall_last_lever(&at.wall, l, c, s);
    return at;
}

double chain_penetration_rate(const arm *a, const double *q, const double *v)
{
    if (pair_suits(a)) {
        const pair_contact at = pair_contact_at(a, q);
        return at.j1 * v[0] + at.j2 * v[1];
    }
    const tip_contact at = contact_of(a, q, v);
    return wall_penetration_rate(&at.wall, at.vx, at.vy, at.lever, v[a->dof - 1]);
}

penetration chain_penetration(const arm *a, const double *q, const double *w)
{
    if (pair_suits(a)) {
        const pair_contact at = pair_contact_at(a, q);
        return (penetration){-at.gap, at.j1 * w[0] + at.j2 * w[1]};
    }
    if (!wall_stands(&a->wall)) {
        return (penetration){-HUGE_VAL, 0};
    }
    const tip_contact at = contact_of(a, q, w);
    return (penetration){at.wall.penetration,
                         wall_penetration_rate(&at.wall, at.vx, at.vy, at.lever,
                                               w[a->dof - 1]) +
                             wall_comes(&a->wall, at.wall.ex, at.wall.ey)};
}

bool chain_is_folded(const arm *a, const double *q)
{
    bool folded = a->wall.kind == WALL_PLANE && a->links > 1;
    for (int k = a->first; k < a->dof && folded; k++) {
        double along =
            inline_cos(q[k]) * a->wall.cosine + inline_sin(q[k]) * a->wall.sine;
        folded = fabs(along) < CHAIN_FOLDED;
    }
    return folded;
}

// Computes the jumps of the velocities, response[dof], by an impulse -(ex, ey) at the tip
// and an angular impulse -lever on the last link: M^-1 times their generalised force, by
// the two sweeps of chain_accelerations (chain.h) without velocities and springs.
static void unit_response(const arm *a, chain_link *link, const double *q, double ex,
                          double ey, double lever, bool hub_locked, double *response)
{
    // tip to hub: `unit` is each link's jump if its base rested; p is the mass, and f the
    // impulse, that the links from it on show to the link before
    double pxx = a->tip_mass, pxy = 0, pyy = a->tip_mass, fx = ex, fy = ey;
    for (int k = a->links - 1; k >= 0; k--) {
        const arm_link own = arm_link_of(a, k);
        const double l = own.length, m = own.mass, half = 0.5 * l;
        double c, s;
        inline_sincos(q[a->first + k], &s, &c);
        double ptx = -pxx * s + pxy * c, pty = -pxy * s + pyy * c;
        double ux = l * ptx - m * half * s, uy = l * pty + m * half * c;
        double d = own.inertia + m * half * half + l * l * (c * pty - s * ptx);
        double moment = -l * (c * fy - s * fx) - (k == a->links - 1 ? lever : 0);
        if (k == 0 && !a->hub_spring) {
            d += a->hub_inertia;
        }
        if (k == 0 && !a->hub_spring && hub_locked) {
            moment = 0;
        }
        link[k] = (chain_link){
            .c = c, .s = s, .inv_d = 1 / d, .ux = ux, .uy = uy, .unit = moment / d};
        fx += ux * link[k].unit;
        fy += uy * link[k].unit;
        pxx += m - ux * ux / d;
        pxy -= ux * uy / d;
        pyy += m - uy * uy / d;
    }

    // hub to tip: less what the jump (bx, by) of its base takes off; a hub behind a
    // spring does not feel an impulse
    double bx = 0, by = 0;
    response[0] = 0;
    for (int k = 0; k < a->links; k++) {
        double jump = link[k].unit - (link[k].ux * bx + link[k].uy * by) * link[k].inv_d;
        bx -= arm_link_of(a, k).length * link[k].s * jump;
        by += arm_link_of(a, k).length * link[k].c * jump;
        response[a->first + k] = jump;
    }
}

double chain_contact_response(const arm *a, chain_link *work, const double *q,
                              bool hub_locked, double *response)
{
    if (pair_suits(a)) {
        return pair_contact_response(a, q, hub_locked, response);
    }
    const wall_contact wall = contact_of(a, q, q).wall; // velocities play no part here
    unit_response(a, work, q, wall.ex, wall.ey, wall.lever, hub_locked, response);
    return -chain_penetration_rate(a, q, response);
}

void chain_tip_response(const arm *a, chain_link *work, const double *q, double *response)
{
    int last = a->first + a->links - 1;
    unit_response(a, work, q, inline_sin(q[last]), -inline_cos(q[last]), 0, false,
                  response);
}

double chain_kinetic_energy(const arm *a, const double *q, const double *w)
{
    double vx = 0, vy = 0, twice = a->hub_inertia * w[0] * w[0];

    // each link about its centre, its base moving with the links before
    for (int k = a->first; k < a->dof; k++) {
        double s, c;
        inline_sincos(q[k], &s, &c);
        const arm_link own = arm_link_of(a, k - a->first);
        const double l = own.length;
        double across_x = -l * s * w[k], across_y = l * c * w[k];
        double cx = vx + across_x / 2, cy = vy + across_y / 2;
        twice += own.mass * (cx * cx + cy * cy) + own.inertia * w[k] * w[k];
        vx += across_x;
        vy += across_y;
    }

    twice += a->tip_mass * (vx * vx + vy * vy);
    return twice / 2;
}

double chain_strain_energy(const arm *a, const double *q)
{
    double energy = 0;
    for (int k = 1; k < a->dof; k++) {
        const force_constants joint = force_constants_of(a, k - a->first);
        energy += joint_forces(&joint, &a->amount, q[k] - q[k - 1], 0).energy;
    }
    return energy;
}

double chain_weight(const arm *a, int k)
{
    double mass = a->tip_mass + arm_link_of(a, k).mass / 2;
    for (int i = k + 1; i < a->links; i++) {
        mass += arm_link_of(a, i).mass;
    }
    return a->amount.gravity * mass * arm_link_of(a, k).length;
}

double chain_weight_energy(const arm *a, const double *q)
{
    double y = 0, moment = 0;
    for (int k = 0; k < a->links && a->amount.gravity != 0; k++) {
        const double rise = arm_link_of(a, k).length * inline_sin(q[a->first + k]);
        moment += arm_link_of(a, k).mass * (y + rise / 2);
        y += rise;
    }
    return a->amount.gravity * (moment + a->tip_mass * y);
}

double chain_stiffened(const arm *a, const double *q)
{
    if (a->amount.stiffening == 0) {
        return 1;
    }
    double most = 0;
    for (int i = 1; i < a->dof; i++) {
        const double bend = (i == a->first ? 2 : 1) * (q[i] - q[i - 1]);
        most = fmax(most, bend * bend);
    }
    return sqrt(1 + 4.5 * a->amount.stiffening * most);
}
