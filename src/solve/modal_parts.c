#include "src/solve/modal_parts.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/sincos.h"
#include "src/solve/by_width.h"
#include "src/solve/modal_loops.h"
#include "src/solve/taylor_lanes.h"

#define REACH_STEP 1.05
#define MOST_REACH 1e3 // a fold of the arm would have any

typedef double real;
#include "src/solve/modal_straight.h"

const modal_loops *modal_loops_here(void)
{
    return BY_WIDTH(&modal_loops_, taylor_width());
}

// --- the linear part --------------------------------------------------------------------------

void modal_fill_table(const modal_stride *s, double t, int powers, int count, const modal_table *at)
{
    for (int k = 0; k < count; k++) {
        modal_response r;
        modal_respond(s->damping[k], s->modes->rate[k], t, powers, &r);
        at->impulse[k] = r.impulse;
        at->impulse_rate[k] = r.impulse_rate;
        for (int j = 0; j < powers; j++) {
            at->power[j][k] = r.power[j];
        }
    }

    // those behind them do nothing
    for (int k = count; k % MODAL_LANES != 0; k++) {
        at->impulse[k] = at->impulse_rate[k] = 0;
        for (int j = 0; j < powers; j++) {
            at->power[j][k] = 0;
        }
    }
}

void modal_momenta_at(const modal_stride *s, const modal_table *at, double *x, double *y)
{
    modal_loops_here()->momenta(s, at, x, y);

    // across the constraint of a contact nothing vibrates: x' = r(t), y' = s(t)
    const int e = s->modes->across;
    if (e >= 0) {
        double place = 0, lower = at->impulse[e];
        for (int j = 0; j < MODAL_NODES; j++) {
            place += s->drift[j][e] * lower;
            lower = at->power[j][e];
        }
        x[e] = place;
    }
}

double modal_to_momenta(const modal_stride *s, const arm *a, const double *x, double *y)
{
    const double *hub = s->modes->by_dof;
    double turned = 0;
    for (int k = 0; k < s->count; k++) {
        turned += hub[k] * x[k];
    }
    for (int k = 0; k < s->count; k++) {
        y[k] += s->viscous[k] * x[k] - a->motor.damping * hub[k] * turned - s->start[k];
    }

    // what is beyond the modes acts where the wall does
    const int e = s->modes->across;
    if (e < 0) {
        return 0;
    }
    double tip = y[e];
    for (int k = 0; k < e; k++) {
        tip -= s->modes->shared[k] * y[k];
    }
    y[e] = 0;
    return tip / s->modes->reach;
}

// x and y of all modes at t within the stride, into s->place and s->momenta.
static void modal_stride_modes(modal_stride *s, double t)
{
    s->time = t;
    s->ending = t == s->length ? &s->at[MODAL_NODES - 1] : &s->at[0];
    if (t != s->length) {
        modal_fill_table(s, t, MODAL_POWERS, s->count, &s->at[0]);
    }
    modal_momenta_at(s, s->ending, s->place, s->momenta);
}

void modal_stride_state(modal_stride *s, const arm *a, chain_link *links, double t, const double *q,
                        double *qt, double *wt, double *impulse)
{
    const int n = s->dof, row = s->row;
    double *x = s->columns, *y = x + row, *turn = s->more_columns;

    // of the modes
    modal_stride_modes(s, t);
    memcpy(x, s->place, (size_t)row * sizeof *x);
    memcpy(y, s->momenta, (size_t)row * sizeof *y);
    const double tip = modal_to_momenta(s, a, x, y);

    // of the links
    modal_to_angles(s->modes, n, 2, x, turn, row);
    modal_mass_times(a, turn + row, y);
    for (int i = 0; i < n; i++) {
        qt[i] = q[i] + turn[i];
        y[i] += s->momentum[i] + (i >= a->first ? tip : 0);
    }
    y[n - 1] += s->modes->lever * tip;
    chain_from_momentum(a, links, s->mode, qt, y, wt, s->rates, impulse);
}

// --- start ------------------------------------------------------------------------------------

// Damping of all modes, and the hub's part of it.
static void take_damping(modal_stride *s, const arm *a)
{
    double square = 0;
    s->per_stiffness = a->joint_stiffness > 0 ? a->joint_damping / a->joint_stiffness : 0;
    for (int k = 0; k < s->modes->count; k++) {
        const double rate = s->modes->rate[k], hub = s->modes->by_dof[k];
        s->viscous[k] = k == s->modes->across ? 0 : a->motor.damping * hub * hub;
        s->damping[k] = (s->per_stiffness * rate * rate + s->viscous[k]) / 2;
        s->softness[k] = rate > 0 ? 1 / (rate * rate) : 0;
        square += hub * hub;
    }
    for (int k = s->modes->count; k < s->row; k++) {
        s->viscous[k] = s->damping[k] = s->softness[k] = 0;
    }
    s->hub_response = sqrt(square);
}

// How far beyond the last link's end the wall holds it at angles q, in link lengths, in steps of a
// twentieth of its distance from the link's base: a basis may be as far from the arm as that.
static double lever_of(const arm *a, const double *q)
{
    if (a->wall.kind != WALL_POINT) {
        return 0;
    }
    const int last = a->dof - 1;
    double x = 0, y = 0, c = 1, s = 0;
    for (int k = a->first; k < last; k++) {
        inline_sincos(q[k], &s, &c);
        x += a->link_length * c;
        y += a->link_length * s;
    }
    inline_sincos(q[last], &s, &c);
    const wall_contact at = wall_contact_at(&a->wall, a->link_length, x, y, 0, 0, c, s, 0);
    const double reach = fmin(1 + at.lever / a->link_length, MOST_REACH);
    double taken = 1;
    while (taken * REACH_STEP < reach) {
        taken *= REACH_STEP;
    }
    return taken - 1;
}

// Takes the basis of a contact state at angles q, computed when it is first wanted. False if it is
// singular.
static bool take_basis(modal_stride *s, const arm *a, contact_state mode, const double *q)
{
    const double now[5] = {a->hub_stiffness, a->joint_stiffness, a->hub_joint_damping,
                           a->joint_damping, a->motor.damping};

    // springs that changed make all bases wrong
    if (memcmp(now, s->stiffness, sizeof now) != 0) {
        memcpy(s->stiffness, now, sizeof now);
        memset(s->known, 0, sizeof s->known);
    }

    const bool stuck = mode.friction == HUB_STICK;
    const int i = mode.contact + 2 * stuck;
    const modal_ends ends = {mode.contact, mode.contact ? lever_of(a, q) : 0, stuck};
    s->known[i] = s->known[i] && s->basis[i].lever == ends.lever;
    if (!s->known[i] && modal_basis_compute(&s->basis[i], a, ends, s->scratch) != STATUS_OK) {
        return false;
    }

    s->modes = &s->basis[i];
    s->now = &s->vibrations[i];
    take_damping(s, a);
    if (!s->known[i]) {
        for (int j = 0; j < MODAL_KEPT; j++) {
            s->kept[i][j].length = 0;
        }
        modal_vibrations_compute(s->now, s->modes, s->damping);
        s->known[i] = true;
    }
    return true;
}

// What modal_take_remainders wants of the start, still to be brought to the modes, into
// s->columns[2 row], from the velocities w[dof] and dT/dq + J'^T L in s->rates.
static void prepare_remainders(modal_stride *s, const arm *a, const double *w)
{
    // velocities without what is across the constraint
    const int e = s->modes->across;
    double *along = s->columns + s->row;
    memcpy(along, w, (size_t)s->dof * sizeof *w);
    if (e >= 0) {
        const double *shift = s->modes->by_mode + (ptrdiff_t)e * s->dof;
        s->drifts[0][e] = modal_basis_across(s->modes, a, w) / s->modes->reach;
        for (int k = 0; k < s->dof; k++) {
            along[k] -= s->drifts[0][e] * shift[k];
        }
    }

    // their momenta, and the forces
    modal_mass_times(a, along, s->columns);
    straight_forces_left(a, modal_hub_torque(s, a), s->angles, w, s->rates, along);
}

void modal_take_remainders(const modal_stride *s, int point, const double *x, const double *y,
                           const double *modal)
{
    // the speed across the constraint is there already
    const int e = s->modes->across;
    const double speed = e >= 0 ? s->drifts[point][e] : 0;
    modal_loops_here()->take(s, point, x, y, modal);
    if (e >= 0) {
        s->drifts[point][e] = speed;
    }
}

status modal_stride_start(modal_stride *s, const arm *a, chain_link *links, contact_state mode,
                          const double *q, const double *w)
{
    const int n = a->dof;
    if (!take_basis(s, a, mode, q)) {
        return STATUS_SINGULAR;
    }

    // momenta, and what the sweeps say
    s->mode = mode;
    s->start_holds = true;
    s->count = s->modes->count;
    chain_momentum(a, q, w, s->momentum);
    double impulse;
    chain_from_momentum(a, links, mode, q, s->momentum, s->velocities, s->rates, &impulse);
    memcpy(s->angles, q, (size_t)n * sizeof *q);
    prepare_remainders(s, a, w);
    memcpy(s->columns + 2 * s->row, s->momentum, (size_t)n * sizeof *q);
    modal_from_angles(s->modes, n, 3, s->columns, s->more_columns, s->row);

    // the same of the modes
    for (int k = 0; k < s->count; k++) {
        s->start[k] = s->more_columns[2 * s->row + k];
    }
    for (int k = s->count; k < s->row; k++) {
        s->start[k] = 0;
    }
    memset(s->columns, 0, (size_t)s->row * sizeof *q);
    modal_take_remainders(s, 0, s->columns, s->start, s->more_columns);
    return STATUS_OK;
}

// --- rates -------------------------------------------------------------------------------------

double modal_stride_fastest(const modal_stride *s)
{
    double fastest = 1e-300;
    for (int k = 0; k < s->count; k++) {
        if (k != s->modes->across && s->damping[k] < s->modes->rate[k]) {
            fastest = fmax(fastest, s->modes->rate[k]);
        }
    }
    return fastest;
}

double modal_stride_shown(const modal_stride *s, double energy)
{
    double faster = 0;
    for (int k = s->count - 1; k >= 0; k--) {
        const double rate = s->modes->rate[k];
        if (k == s->modes->across || s->damping[k] >= rate) {
            continue;
        }

        // about where the force of this instant would hold it
        const double speed = s->start[k] + s->drifts[0][k], place = s->forces[0][k] / rate;
        faster += (speed * speed + place * place) / 2;
        if (faster > energy) {
            return rate;
        }
    }
    return 1e-300;
}

// --- decays -----------------------------------------------------------------------------------

bool modal_add_decay(const modal_decay_course *u, double weight, double *amplitude, double *total)
{
    assert(u != NULL && u->n != NULL && amplitude != NULL && total != NULL);
    double g = u->start;
    if (u->rate * u->length <= MODAL_SLOW_TURN) {
        for (int j = 0; j < MODAL_SERIES; j++) {
            total[j] += weight * g;
            g = (j < MODAL_NODES ? u->n[j] : 0) - u->rate * g;
        }
        return false;
    }

    // what it settles at, and how far from that it starts
    const double per_rate = 1 / u->rate;
    g = 0;
    for (int j = MODAL_NODES - 1; j >= 0; j--) {
        g = (u->n[j] - g) * per_rate;
        total[j] += weight * g;
    }
    *amplitude += weight * (u->start - g);
    return true;
}
