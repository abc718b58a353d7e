#include "src/solve/modal_loops.h"
#include "src/solve/modal_parts.h"

#include <math.h>
#include <string.h>

typedef double real;
#include "src/solve/modal_straight.h"

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

// Across the constraint of a contact nothing vibrates: x' = r(t), while y' = s(t) less what the
// modes pull, x and its integral by K and C, carries the force's impulse.
static void state_across(const modal_stride *s, const modal_table *at, double *x, double *y)
{
    const int e = s->modes->across;

    // its own polynomials
    double place = 0, rate = s->start[e], lower = at->impulse[e];
    for (int j = 0; j < MODAL_NODES; j++) {
        place += s->drift[j][e] * lower;
        rate += s->force[j][e] * lower;
        lower = at->power[j][e];
    }

    // what the modes pull
    for (int k = 0; k < e; k++) {
        const double twice = 2 * s->damping[k];
        double integral = s->start[k] * at->power[0][k];
        for (int j = 0; j < MODAL_NODES; j++) {
            const double power = at->power[j + 1][k];
            integral += s->force[j][k] * power + s->drift[j][k] * (at->power[j][k] + twice * power);
        }
        rate -= s->modes->pull[k] * (integral + s->per_stiffness * x[k]);
    }
    x[e] = place;
    y[e] = rate;
}

void modal_momenta_at(const modal_stride *s, const modal_table *at, double *x, double *y)
{
    modal_loops_here()->momenta(s, at, x, y);

    // across the constraint they add up
    if (s->modes->across >= 0) {
        state_across(s, at, x, y);
    }
}

void modal_to_momenta(const modal_stride *s, const arm *a, const double *x, double *y)
{
    const double *hub = s->modes->by_dof;
    double turned = 0;
    for (int k = 0; k < s->count; k++) {
        turned += hub[k] * x[k];
    }
    for (int k = 0; k < s->count; k++) {
        y[k] += s->viscous[k] * x[k] - a->motor.damping * hub[k] * turned - s->start[k];
    }
}

void modal_stride_modes(modal_stride *s, double t)
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
    double *x = s->columns, *y = x + row, *turn = s->more_columns, *momentum = turn + row;

    // of the modes
    modal_stride_modes(s, t);
    memcpy(x, s->place, (size_t)row * sizeof *x);
    memcpy(y, s->momenta, (size_t)row * sizeof *y);
    modal_to_momenta(s, a, x, y);

    // of the links
    modal_to_angles(s->modes, n, 2, x, turn, row);
    modal_mass_times(a, momentum, y);
    for (int i = 0; i < n; i++) {
        qt[i] = q[i] + turn[i];
        y[i] += s->momentum[i];
    }
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

// Takes the basis of a contact state, computed when it is first wanted. False if it is singular.
static bool take_basis(modal_stride *s, const arm *a, contact_state mode)
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
    if (!s->known[i]) {
        if (modal_basis_compute(&s->basis[i], a, mode.contact, stuck, s->scratch) != STATUS_OK) {
            return false;
        }
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

void modal_prepare_remainders(modal_stride *s, const arm *a, const double *w, double *columns)
{
    modal_mass_times(a, w, columns);
    straight_forces_left(a, modal_hub_torque(s, a), s->angles, w, s->rates, columns + s->row);
}

void modal_take_remainders(const modal_stride *s, int point, const double *x, const double *y,
                           const double *modal)
{
    const double *v = modal, *force = modal + s->row;
    modal_loops_here()->take(s, point, x, y, modal);

    // across the constraint there is only what the modes pull
    const int e = s->modes->across;
    if (e >= 0) {
        double sum = force[e];
        for (int k = 0; k < e; k++) {
            sum += s->modes->pull[k] * (x[k] + s->per_stiffness * v[k]);
        }
        s->drifts[point][e] = v[e];
        s->forces[point][e] = sum;
    }
}

status modal_stride_start(modal_stride *s, const arm *a, chain_link *links, contact_state mode,
                          const double *q, const double *w)
{
    const int n = a->dof;
    if (!take_basis(s, a, mode)) {
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
    modal_prepare_remainders(s, a, w, s->columns);
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

double modal_stride_quickest(const modal_stride *s)
{
    double quickest = 1e-300;
    for (int e = 0; e < s->now->count; e++) {
        quickest = fmax(quickest, s->now->square[e]);
    }
    return sqrt(quickest);
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
