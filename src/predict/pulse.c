#include "src/predict/pulse.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/predict/exponential.h"

// Samples a radian of the fastest mode.
#define SAMPLES_A_RADIAN 10
// The first sample after a command changes, in times that the current lags behind; others double.
#define FIRST_SAMPLE 0.1
// What a linear arm may be off in the force, or by its gap bring into it, of the largest force so
// far.
#define FORCE_DEFECT 5e-4
// Between this share of the peak above and below zero, a force may vanish or not.
#define GRAZE 0.02
// A peak after such a force that is no larger than this times the one before changes nothing.
#define SAME_PEAK 1.005
// The peak is known if it does not grow between this share of the horizon and its end.
#define SETTLED_FROM 0.8

enum { MOST_PIECES = 1000, MOST_SAMPLES = 60000 };

// The arm at an instant of the pulse, with what the true equations say there.
typedef struct instant_of_pulse {
    double time;           // since the touch [s]
    double *q, *w, *alpha; // [dof]
    double current;        // of a motor with inductance [A]
    chain_reaction reaction;
} instant_of_pulse;

typedef struct follower {
    arm arm; // with the command in force
    chain_link *links;
    int n, size;          // dof; of z
    bool flows;           // the current is the last element of z
    bool held;            // at its limit, by the linear arm in use
    double current_limit; // HUGE_VAL: none [A]
    contact_state mode;
    voltage_profile command;
    int next_command;
    double sample;    // usual time between two samples [s]
    double step;      // to the next one, shorter where a current begins to change [s]
    double reach;     // of the propagator, 0: of none yet [s]
    double stiffness; // of the outermost joint at the tip, zero at a wall that gives [N/m]

    // the linear arm in use
    double *matrix, *propagator, *power, *product; // [size * size]
    double *output;                                // force = output z [size]
    double *z, *next, *scratch, *base;             // [size], [size], [4 dof], [dof]

    instant_of_pulse now, then; // this sample and the next one

    // what was seen so far
    double before_last, last;           // the two forces before, NaN at the start of a piece [N]
    double earlier_times[2];            // when they were [s]
    double turning;                     // force where friction changes, before that; else NaN [N]
    double most_strain, kinetic_there;  // [J]
    double first_zero, kinetic_at_zero; // where the force vanished [s], [J]
    double peak_at_graze;               // NaN if it never grazed zero [N]
    double lowest;                      // the last force [N]
    bool falling;                       // it was below the one before
} follower;

// --- storage --------------------------------------------------------------------------------

static double *take(double **next, size_t count)
{
    double *taken = *next;
    *next += count;
    return taken;
}

// One block for all vectors and matrices, to be freed by the caller; NULL if out of memory.
static double *allocate(follower *f)
{
    const size_t n = (size_t)f->n, size = (size_t)f->size, square = size * size;
    double *block = calloc(4 * square + 3 * size + 11 * n, sizeof *block), *next = block;
    if (block == NULL) {
        return NULL;
    }

    f->matrix = take(&next, square);
    f->propagator = take(&next, square);
    f->power = take(&next, square);
    f->product = take(&next, square);
    f->output = take(&next, size);
    f->z = take(&next, size);
    f->next = take(&next, size);
    f->scratch = take(&next, 4 * n);
    f->base = take(&next, n);
    for (int i = 0; i < 2; i++) {
        instant_of_pulse *at = i == 0 ? &f->now : &f->then;
        at->q = take(&next, n);
        at->w = take(&next, n);
        at->alpha = take(&next, n);
    }
    return block;
}

// --- one linear arm -------------------------------------------------------------------------

static void evaluate(follower *f, instant_of_pulse *at)
{
    f->mode.current = at->current;
    chain_accelerations(&f->arm, f->links, at->q, at->w, f->mode, at->alpha, &at->reaction);
}

// How fast the current of a motor with inductance changes [A/s].
static double current_slope(const motor_model *m, double current, double w)
{
    return (m->gain * m->voltage - m->resistance * current - m->back_emf * w) / m->inductance;
}

// Whether it stays at its limit, where the voltage would drive it on.
static bool current_is_held(const follower *f, const instant_of_pulse *at)
{
    const bool there = fabs(at->current) >= f->current_limit;
    return f->flows && there &&
           at->current * current_slope(&f->arm.motor, at->current, at->w[0]) > 0;
}

// The current's equation, and what it does to accelerations and force, of which the other terms are
// those of one that stays.
static void linearise_current(follower *f)
{
    const int n = f->n, size = f->size, last = size - 1;
    const motor_model *m = &f->arm.motor;
    double *alpha = f->scratch, *matrix = f->matrix;
    chain_reaction r;

    // they are straight lines of it
    f->mode.current = f->now.current + 1;
    chain_accelerations(&f->arm, f->links, f->now.q, f->now.w, f->mode, alpha, &r);
    f->output[last] = r.force - f->now.reaction.force;
    f->output[2 * n] -= f->output[last] * f->now.current;
    for (int i = 0; i < n; i++) {
        const double slope = alpha[i] - f->now.alpha[i];
        matrix[(n + i) * size + last] = slope;
        matrix[(n + i) * size + 2 * n] -= slope * f->now.current;
    }

    // at its limit it stays
    f->held = current_is_held(f, &f->now);
    if (!f->held) {
        matrix[last * size + last] = -m->resistance / m->inductance;
        matrix[last * size + n] = -m->back_emf / m->inductance;
        matrix[last * size + 2 * n] = m->gain * m->voltage / m->inductance;
    }
    f->z[last] = f->now.current;
}

// Puts the arm back onto a rigid wall, from which linear motion drifts, along M^-1 J^T.
static void put_on_wall(follower *f)
{
    const bool locked = f->mode.friction == HUB_STICK;
    double *response = f->scratch, compliance, depth;
    if (wall_gives(&f->arm.wall) || f->n == 1) {
        return;
    }

    // the angles first, then the velocities there
    chain_contact_response(&f->arm, f->links, f->now.q, locked, response, &compliance);
    chain_penetration(&f->arm, f->now.q, f->now.w, &depth, NULL);
    for (int i = 0; i < f->n; i++) {
        f->now.q[i] += depth / compliance * response[i];
    }
    double rate = chain_penetration_rate(&f->arm, f->now.q, f->now.w);
    for (int i = 0; i < f->n; i++) {
        f->now.w[i] += rate / compliance * response[i];
    }
}

// The equations of motion linearised at f->now: d(alpha, force)/d(q, w) by central differences.
static void linearise(follower *f)
{
    const int n = f->n, size = f->size;
    double *at = f->scratch, *alpha = f->scratch + 2 * n, *matrix = f->matrix;
    chain_reaction r;

    // d(angle)/dt = velocity, and the constant terms
    memset(matrix, 0, (size_t)(size * size) * sizeof *matrix);
    f->output[2 * n] = f->now.reaction.force;
    for (int i = 0; i < n; i++) {
        matrix[i * size + n + i] = 1;
        matrix[(n + i) * size + 2 * n] = f->now.alpha[i];
        at[i] = f->now.q[i];
        at[n + i] = f->now.w[i];
    }

    // slopes, one column of A after the other
    for (int j = 0; j < 2 * n; j++) {
        double e = 1e-6 * (1 + fabs(at[j])), value = at[j], slope = 0;
        for (int side = 1; side >= -1; side -= 2) {
            at[j] = value + side * e;
            chain_accelerations(&f->arm, f->links, at, at + n, f->mode, alpha, &r);
            slope += side * r.force / (2 * e);
            for (int i = 0; i < n; i++) {
                matrix[(n + i) * size + j] += side * alpha[i] / (2 * e);
            }
        }
        at[j] = value;
        f->output[j] = slope;
    }

    // velocities enter as they are: take the linear terms at w out of the constant ones
    for (int j = 0; j < n; j++) {
        f->output[2 * n] -= f->output[n + j] * f->now.w[j];
        for (int i = 0; i < n; i++) {
            matrix[(n + i) * size + 2 * n] -= matrix[(n + i) * size + n + j] * f->now.w[j];
        }
    }

    // from here, z = (0, w, 1)
    memcpy(f->base, f->now.q, (size_t)n * sizeof *f->base);
    memset(f->z, 0, (size_t)size * sizeof *f->z);
    memcpy(f->z + n, f->now.w, (size_t)n * sizeof *f->z);
    f->z[2 * n] = 1;
    if (f->flows) {
        linearise_current(f);
    }
}

// Begins the next linear arm where the arm is now.
static void begin_piece(follower *f)
{
    put_on_wall(f);
    evaluate(f, &f->now);
    linearise(f);
    f->reach = 0;
    f->last = f->before_last = (double)NAN;
}

// One sample on, into f->then; returns how far the linear arm's force is off the true one [N].
static double advance(follower *f, double h)
{
    const int n = f->n, size = f->size;
    double force = 0;
    if (f->reach != h) {
        matrix_exponential(f->matrix, size, h, f->propagator, f->power, f->product);
        f->reach = h;
    }
    for (int i = 0; i < size; i++) {
        double sum = 0;
        for (int j = 0; j < size; j++) {
            sum += f->propagator[i * size + j] * f->z[j];
        }
        f->next[i] = sum;
        force += f->output[i] * sum;
    }

    // what the true equations say there
    for (int i = 0; i < n; i++) {
        f->then.q[i] = f->base[i] + f->next[i];
        f->then.w[i] = f->next[n + i];
    }
    f->then.current = f->flows ? f->next[size - 1] : 0;
    f->then.time = f->now.time + h;
    evaluate(f, &f->then);
    return fabs(force - f->then.reaction.force);
}

// Whether the current meets its limit between the two samples, where it then is, or leaves it.
static bool current_turns(follower *f)
{
    if (f->held || !(fabs(f->then.current) > f->current_limit)) {
        return f->held && !current_is_held(f, &f->then);
    }
    f->then.current = copysign(f->current_limit, f->then.current);
    evaluate(f, &f->then);
    return true;
}

// f->then moved back to a share of the way from f->now: cubics through both ends' values and rates.
static void move_back(follower *f, double share)
{
    const double h = f->then.time - f->now.time, s = share;
    const double last = s * s * (3 - 2 * s), rate0 = h * s * (1 - s) * (1 - s),
                 rate1 = h * s * s * (s - 1);
    for (int i = 0; i < f->n; i++) {
        double w0 = f->now.w[i], w1 = f->then.w[i];
        f->then.q[i] = f->now.q[i] + last * (f->then.q[i] - f->now.q[i]) + rate0 * w0 + rate1 * w1;
        f->then.w[i] = w0 + last * (w1 - w0) + rate0 * f->now.alpha[i] + rate1 * f->then.alpha[i];
    }
    if (f->flows && !f->held) {
        const double i0 = f->now.current, i1 = f->then.current;
        f->then.current = i0 + last * (i1 - i0) +
                          rate0 * current_slope(&f->arm.motor, i0, f->now.w[0]) +
                          rate1 * current_slope(&f->arm.motor, i1, f->then.w[0]);
    }
    f->then.time = f->now.time + share * h;
    evaluate(f, &f->then);
    f->turning = f->then.reaction.force;
}

// --- what happens on the way ----------------------------------------------------------------

// Hub friction after the hub has come to rest or broken away: it sticks if friction can hold it,
// else slides the way it is pushed.
static void settle_friction(follower *f, instant_of_pulse *at)
{
    f->mode.friction = HUB_STICK;
    at->w[0] = 0;
    evaluate(f, at);
    if (fabs(at->reaction.friction) > f->arm.motor.stiction) {
        f->mode.friction = at->reaction.friction < 0 ? HUB_FORWARD : HUB_BACKWARD;
        evaluate(f, at);
    }
}

// Whether the hub comes to rest or breaks away between the two samples. Moves f->then there and
// puts the friction after it in force.
static bool friction_changes(follower *f)
{
    const hub_friction friction = f->mode.friction;
    if (f->n == 1 && !wall_gives(&f->arm.wall)) {
        return false; // held by the wall alone
    }

    if (friction != HUB_STICK) {
        // at a start from rest the velocity may be zero and grow
        const double way = friction == HUB_FORWARD ? 1 : -1;
        double before = way * f->now.w[0], after = way * f->then.w[0];
        if (!(after < 0)) {
            return false;
        }
        move_back(f, before > 0 ? before / (before - after) : 0);
        settle_friction(f, &f->then);
        return true;
    }

    double before = fabs(f->now.reaction.friction), after = fabs(f->then.reaction.friction);
    double most = f->arm.motor.stiction;
    if (!(after > most)) {
        return false;
    }
    hub_friction way = f->then.reaction.friction < 0 ? HUB_FORWARD : HUB_BACKWARD;
    move_back(f, before < most ? (most - before) / (after - before) : 0);
    f->mode.friction = way;
    f->then.w[0] = 0;
    evaluate(f, &f->then);
    return true;
}

// A command, or the touch, changes how fast the current does: samples are near each other at first.
static void begin_samples(follower *f)
{
    const motor_model *m = &f->arm.motor;
    const double lag = f->flows ? m->inductance / m->resistance : HUGE_VAL;
    f->step = fmin(f->sample, FIRST_SAMPLE * lag);
}

// Commands that are due.
static bool command_changes(follower *f)
{
    bool changed = false;
    while (f->next_command < f->command.count &&
           f->command.times[f->next_command] <= f->now.time * (1 + 1e-12)) {
        arm_set_voltage(&f->arm, f->command.volts[f->next_command++]);
        changed = true;
    }

    if (changed) {
        begin_samples(f);
    }

    // a stuck hub may break away under the new one
    if (changed && f->mode.friction == HUB_STICK) {
        settle_friction(f, &f->now);
    }
    return changed;
}

static double next_command_time(const follower *f)
{
    return f->next_command < f->command.count ? f->command.times[f->next_command] : HUGE_VAL;
}

// Whether wall and friction leave the arm no way to move, and no current changes.
static bool held_still(const follower *f)
{
    int holds = !wall_gives(&f->arm.wall) + (f->mode.friction == HUB_STICK);
    return !f->flows && (f->n == 1 ? holds > 0 : holds >= f->n);
}

// --- what is seen on the way ----------------------------------------------------------------

// The top of the parabola through the last three forces, if it lies between them.
static void see_peak(follower *f, pulse *out)
{
    const bool turns = !isnan(f->turning);
    const double now = f->now.time, last = f->earlier_times[1], first = f->earlier_times[0];
    const double force = fmax(f->now.reaction.force, f->turning);
    if (force > out->peak) {
        out->peak = force;
        out->delay = now;
    }

    // within its last interval where no other will see that
    const double end = turns ? f->turning : f->now.reaction.force;
    const double rise = (f->last - f->before_last) / (last - first);
    const double bend = ((end - f->last) / (now - last) - rise) / (now - first);
    const double when = (first + last) / 2 - rise / (2 * bend);
    const bool tops = f->last > f->before_last && f->last >= end;
    if (bend < 0 && (tops || (turns && when > last && when < now))) {
        const double top = f->before_last + (when - first) * (rise + bend * (when - last));
        if (top > out->peak) {
            out->peak = top;
            out->delay = when;
        }
    }
}

// Where the strain is largest, and what moves there.
static void see_energy(follower *f)
{
    double strain = chain_strain_energy(&f->arm, f->now.q);
    if (strain > f->most_strain) {
        f->most_strain = strain;
        f->kinetic_there = chain_kinetic_energy(&f->arm, f->now.q, f->now.w);
    }
}

// Whether the force has vanished for good. A force that only comes near zero is remembered: what it
// would have done with other digits nobody knows.
static bool see_end(follower *f, double h, pulse *out)
{
    double force = f->now.reaction.force, margin = GRAZE * out->peak;
    if (force <= 0 && isnan(f->first_zero)) {
        // f->then is the sample before
        double before = f->then.reaction.force, share = before > 0 ? before / (before - force) : 1;
        double kinetic = chain_kinetic_energy(&f->arm, f->then.q, f->then.w);
        f->first_zero = f->now.time - (1 - share) * h;
        f->kinetic_at_zero =
            kinetic + share * (chain_kinetic_energy(&f->arm, f->now.q, f->now.w) - kinetic);
    }
    if (force < -margin) {
        out->length = f->first_zero;
        return true;
    }

    // a lowest force near zero
    bool lowest = f->falling && force > f->lowest && f->lowest < margin;
    if (lowest && isnan(f->peak_at_graze)) {
        f->peak_at_graze = out->peak;
    }
    f->falling = force < f->lowest || (f->falling && force == f->lowest);
    f->lowest = force;
    f->first_zero = force > 0 ? (double)NAN : f->first_zero;
    return false;
}

// --- the pulse ------------------------------------------------------------------------------

// Follows the pulse piece by piece, sample by sample.
static void follow(follower *f, pulse *out)
{
    int pieces = 0;
    bool fresh = true;         // a linear arm begins
    double before = out->peak; // the peak some time before the horizon [N]
    for (int sample = 0; f->now.time < PULSE_HORIZON; sample++) {
        const bool early = f->now.time < SETTLED_FROM * PULSE_HORIZON;
        before = early ? out->peak : before;
        if (command_changes(f) || fresh) {
            evaluate(f, &f->now);
            if (held_still(f)) {
                see_peak(f, out);
                before = early ? out->peak : before; // it presses so until it is told otherwise
                f->now.time = next_command_time(f);
                fresh = true;
                continue;
            }
            begin_piece(f);
        }
        if (pieces > MOST_PIECES || sample > MOST_SAMPLES) {
            out->doubt = pieces > MOST_PIECES ? DOUBT_BEND : DOUBT_LENGTH;
            return;
        }

        // up to the next sample, or the next command
        const double due = next_command_time(f) - f->now.time, h = fmin(f->step, due);
        const bool cut = due < f->step;
        f->step = fmin(2 * f->step, f->sample);
        double defect = advance(f, h), gap = f->then.reaction.gap;
        f->turning = (double)NAN;
        bool changed = friction_changes(f);
        changed |= current_turns(f);
        bool off = defect + f->stiffness * fabs(gap) > FORCE_DEFECT * out->peak;

        // on to it
        f->before_last = f->last;
        f->last = f->now.reaction.force;
        f->earlier_times[0] = f->earlier_times[1];
        f->earlier_times[1] = f->now.time;
        instant_of_pulse behind = f->now;
        f->now = f->then;
        f->then = behind;
        memcpy(f->z, f->next, (size_t)f->size * sizeof *f->z);
        see_energy(f);
        see_peak(f, out);
        if (see_end(f, h, out)) {
            return;
        }
        fresh = changed || cut || off;
        pieces += off;
    }

    // a force that still rises at the horizon has its peak beyond it
    if (out->peak - before > FORCE_DEFECT * out->peak) {
        out->doubt = DOUBT_LENGTH;
    }
}

// Of the outermost joint, as a force across the tip meets it [N/m].
static double tip_stiffness(const arm *a)
{
    const double l = arm_link_length(a, a->links - 1);
    return arm_joint_stiffness(a, a->links - 1) / (l * l);
}

status pulse_follow(const arm *a, chain_link *work, const pulse_start *start, pulse *out)
{
    assert(a != NULL && work != NULL && start != NULL && out != NULL);
    assert(start->q != NULL && start->w != NULL && start->mode.contact);
    const double none = (double)NAN;
    follower f = {.arm = *a,
                  .links = work,
                  .n = a->dof,
                  .flows = a->motor.inductance > 0,
                  .current_limit = a->motor.inductance > 0 ? a->motor.current_limit : HUGE_VAL,
                  .mode = start->mode,
                  .command = start->command,
                  .stiffness = wall_gives(&a->wall) ? 0 : tip_stiffness(a),
                  .turning = none,
                  .first_zero = none,
                  .peak_at_graze = none};
    *out = (pulse){.length = none, .restitution = none};
    f.size = 2 * f.n + 1 + f.flows;
    if (f.flows) {
        f.arm.motor.current_limit = HUGE_VAL; // of which this file takes care
        f.now.current = fmax(-f.current_limit, fmin(start->mode.current, f.current_limit));
    }

    double *block = allocate(&f);
    if (block == NULL) {
        return STATUS_NO_MEMORY;
    }

    // at the touch
    memcpy(f.now.q, start->q, (size_t)f.n * sizeof *f.now.q);
    memcpy(f.now.w, start->w, (size_t)f.n * sizeof *f.now.w);
    evaluate(&f, &f.now);
    out->peak = f.lowest = f.now.reaction.force;
    see_energy(&f);

    // the fastest motion to come; a wall that gives has a say, and current and hub by turns
    double rate = fmax(a->highest_frequency, 1), compliance;
    if (f.flows) {
        const motor_model *motor = &a->motor;
        const double coupled = motor->torque_constant * motor->back_emf / motor->inductance /
                               (a->hub_inertia + a->link_inertia);
        const double decay = motor->resistance / (2 * motor->inductance);
        rate = coupled > decay * decay ? sqrt(rate * rate + coupled) : rate;
    }
    if (wall_gives(&a->wall)) {
        chain_contact_response(a, work, start->q, false, f.scratch, &compliance);
        double wall = wall_rate(&a->wall, compliance, fmax(-f.now.reaction.gap, 0),
                                -f.now.reaction.gap_velocity);
        rate = sqrt(rate * rate + wall * wall);
    }
    f.sample = 1 / (SAMPLES_A_RADIAN * rate);
    begin_samples(&f);
    follow(&f, out);

    // what is too close to call is left open
    if (out->doubt == DOUBT_NONE && out->peak > SAME_PEAK * f.peak_at_graze) {
        out->doubt = DOUBT_GRAZE;
    }
    if (!isnan(out->length) && f.most_strain > 0) {
        out->restitution = (f.kinetic_at_zero - f.kinetic_there) / f.most_strain;
    }
    free(block);
    return STATUS_OK;
}
