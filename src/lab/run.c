#include "src/lab/run.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "src/lab/run_snapshot.h"
#include "src/rig/rig.h"
#include "src/solve/motion.h"
#include "src/solve/printed_algorithm.h"

#define AT(field) offsetof(summary, field)

const summary_info summary_table[] = {
    {"first_contact_s", AT(first_contact_s), false},
    {"contact_impulse_Ns", AT(contact_impulse_Ns), false},
    {"first_pulse_peak_N", AT(first_pulse_peak_N), false},
    {"first_pulse_time_to_peak_s", AT(first_pulse_time_to_peak_s), false},
    {"first_pulse_s", AT(first_pulse_s), false},
    {"peak_force_N", AT(peak_force_N), false},
    {"time_to_peak_s", AT(time_to_peak_s), false},
    {"impacts", AT(impacts), false},
    {"separations", AT(separations), false},
    {"steady_force_N", AT(steady_force_N), false},
    {"force_overshoot_percent", AT(force_overshoot_percent), false},
    {"settling_time_s", AT(settling_time_s), false},
    {"max_penetration_m", AT(max_penetration_m), false},
    {"motor_work_J", AT(motor_work_J), false},
    {"energy_residual_J", AT(energy_residual_J), false},
    {"force_command_N", AT(force_command_N), false},
    {"force_over_command_N", AT(force_over_command_N), false},
    {"steady_error_N", AT(steady_error_N), false},
    {"largest_command_V", AT(largest_command_V), false},
    {"electrical_energy_J", AT(electrical_energy_J), false},
    {"steps", AT(steps), false},
    {"wall_time_s", AT(wall_time_s), true},
};
const int summary_count = (int)(sizeof summary_table / sizeof summary_table[0]);

bool summary_get(const summary *s, const char *key, double *value)
{
    for (int i = 0; i < summary_count; i++) {
        if (strcmp(summary_table[i].key, key) == 0) {
            memcpy(value, (const char *)s + summary_table[i].offset, sizeof *value);
            return true;
        }
    }
    return false;
}

#define SEPARATION_GAP      1e-6 // a smaller gap is no separation [m]
#define SHORTEST_MEAN       1e-9 // a stride shorter than this has the mean of its ends [s]
#define TINY_ENERGY         1e-9 // below it nothing is called unstable [J]
#define TINY_TURN           1e-2 // nor below what the motor does in this turn [rad]
#define WRONG_ENERGY        0.1  // share of the energy turned over that may not be unaccounted for
#define MOST_EVENTS_AT_ONCE 100  // events without time passing before the run is given up

enum { SNAPSHOT_ROWS = 512 }; // rows from one snapshot to the next

// What a run in progress remembers besides the rows.
typedef struct recording {
    const scenario *scenario;
    run_result *result;
    run_options options;
    bool keep_trace;
    bool keeps_history; // and not only what is needed until the end
    parameters now;     // parameters as changed by the script so far
    int next_action;
    long_array own_strides; // where the next lies unless it is in the history
    force_stride *strides;  // the force all along
    size_t count, capacity;
    double integral_at_window; // of the force, where the steady force's window begins [N s]
    long grid_row;             // number of the next row of the grid
    bool separated;            // gap above SEPARATION_GAP in the present flight
    bool pulse_open;           // the first pulse has not ended
    rig *rig;                  // NULL for the bare arm
    double command_time, command_angle; // when and where the present command took effect [s], [rad]
    sensed_motion after_step;           // printed model: what the sensors see
    fault *rig_fault;                   // printed model: where the rig's fault goes
    status rig_status;
} recording;

static void summary_clear(summary *s)
{
    memset(s, 0, sizeof *s);
    for (int i = 0; i < summary_count; i++) {
        double none = (double)NAN;
        memcpy((char *)s + summary_table[i].offset, &none, sizeof none);
    }
    s->impacts = s->separations = s->steps = s->max_penetration_m = 0;
    s->motor_work_J = s->energy_residual_J = 0;
}

static status remember_stride(recording *r, force_stride stride)
{
    if (r->count == r->capacity) {
        long_array *c = r->keeps_history ? &r->result->history.strides : &r->own_strides;
        if (!long_array_grow(c, r->count + 1)) {
            return STATUS_NO_MEMORY;
        }
        r->strides = c->base;
        r->capacity = c->capacity;
    }
    r->strides[r->count++] = stride;
    r->result->history.stride_count = r->keeps_history ? r->count : 0;
    return STATUS_OK;
}

static bool asked_to_stop(const recording *r)
{
    const run_monitor *m = r->options.monitor;
    return m != NULL && atomic_load_explicit(&m->stop, memory_order_relaxed);
}

// Tells those who look on how far the run is: what they count is complete.
static void publish(const recording *r, double time)
{
    run_monitor *m = r->options.monitor;
    if (m != NULL) {
        const trace *t = &r->result->trace;
        atomic_store_explicit(&m->time, time, memory_order_relaxed);
        atomic_store_explicit(&m->events, t->event_count, memory_order_release);
        atomic_store_explicit(&m->rows, t->row_count, memory_order_release);
    }
}

// Adds a row and lets it be seen.
static status add_row(recording *r, const sample *row, const double *angles,
                      const double *velocities)
{
    status s = trace_add_row(&r->result->trace, row, angles, velocities);
    publish(r, row->time);
    return s;
}

// An empty trace of the kind that is asked for.
static status open_trace(recording *r, int angle_count, fault *f)
{
    size_t expected = r->options.rows_expected;
    if (expected == 0) {
        trace_init(&r->result->trace, angle_count);
        return STATUS_OK;
    }
    size_t most = rows_at_most(expected);
    status s = trace_reserve(&r->result->trace, angle_count, expected, most);
    return s == STATUS_OK ? s : fault_set(f, s, "no address space for %zu rows", expected);
}

// The last instant within a stride at which the force is `edge`, as a share of it; -1 if none.
static double last_crossing(const force_stride *stride, double edge)
{
    double curve = 3 * (stride->first + stride->last) - 6 * stride->mean;
    double slope = stride->last - stride->first - curve, offset = stride->first - edge;
    double latest = -1;
    if (fabs(curve) < 1e-12 * (fabs(slope) + fabs(offset))) {
        double s = slope != 0 ? -offset / slope : -1;
        return s >= 0 && s <= 1 ? s : -1;
    }
    double square = slope * slope - 4 * curve * offset;
    for (int sign = -1; sign <= 1 && square >= 0; sign += 2) {
        double s = (-slope + sign * sqrt(square)) / (2 * curve);
        latest = s >= 0 && s <= 1 && s > latest ? s : latest;
    }
    return latest;
}

// Time after which the force stays within the band round `final` for good, each stride taken as the
// parabola through its ends with its mean; NaN if the run ends outside.
static double settled_since(const recording *r, double final)
{
    double band = SETTLED_BAND * fabs(final);
    for (size_t i = r->count; i-- > 0;) {
        const force_stride *stride = &r->strides[i];
        double upper = last_crossing(stride, final + band),
               lower = last_crossing(stride, final - band);
        double left = fmax(upper, lower);
        if (fabs(stride->last - final) > band) {
            // outside at its end: inside only from the next stride's start on
            return i + 1 == r->count ? (double)NAN : stride->end;
        }
        if (left >= 0) {
            return stride->start + left * (stride->end - stride->start);
        }
    }
    return r->count > 0 ? r->strides[0].start : (double)NAN;
}

// Copies what the rig knows into a row.
static void add_rig_signals(const recording *r, sample *row)
{
    const rig *on = r->rig;
    bool sampled = on != NULL && on->samples > 0;
    row->encoder = sampled ? on->reading.angle : (double)NAN;
    row->tachometer = sampled ? on->reading.velocity : (double)NAN;
    row->force_reading = sampled ? on->reading.fsr_force : (double)NAN;
    row->piezo_force = sampled ? on->reading.piezo_force : (double)NAN;
    row->film = sampled ? on->reading.bending : (double)NAN;
    row->accelerometer = sampled ? on->reading.acceleration : (double)NAN;
    row->command = sampled ? on->output.command : (double)NAN;
    row->controller_mode = sampled ? on->output.mode : (double)NAN;
    row->desired_angle = sampled ? on->output.desired_angle : (double)NAN;
    row->desired_velocity = sampled ? on->output.desired_velocity : (double)NAN;
    row->calculated_force = sampled ? on->output.force_estimate : (double)NAN;
}

// Books what the amplifier fed in since the present command took effect: the integral of
// V (V - kB w) / Ra with the motor's voltage V constant.
static void book_electrical_energy(recording *r, double time, double hub_angle)
{
    const motor_parameters *motor = &r->now.motor;
    double volts = motor->amplifier_gain * motor_limited_voltage(motor);
    r->result->summary.electrical_energy_J +=
        volts / motor->resistance *
        (volts * (time - r->command_time) - motor->back_emf * (hub_angle - r->command_angle));
    r->command_time = time;
    r->command_angle = hub_angle;
}

// Sets up the rig, if the scenario has a control law; until its first command the motor rests.
static status start_rig(recording *r, fault *f)
{
    const parameters *p = &r->scenario->parameters;
    if (p->control.law == LAW_NONE) {
        return STATUS_OK;
    }
    r->now.motor.voltage = 0;
    r->command_angle = p->initial.angle;
    r->result->summary.electrical_energy_J = 0;
    status s = rig_create(&r->rig, p, f);
    return s == STATUS_OK ? scenario_check_locks(r->scenario, r->rig->law, f) : s;
}

static void finish_rig_summary(recording *r, double hub_angle)
{
    summary *s = &r->result->summary;
    const parameters *p = &r->scenario->parameters;
    if (r->rig != NULL) {
        book_electrical_energy(r, p->run.duration, hub_angle);
        s->largest_command_V = r->rig->largest_command;
        s->force_command_N = p->control.force;
        s->force_over_command_N = s->peak_force_N - p->control.force;
        s->steady_error_N = s->steady_force_N - p->control.force;
    }
}

static void finish_summary(recording *r, double force_integral)
{
    summary *s = &r->result->summary;
    double duration = r->scenario->parameters.run.duration;
    s->steady_force_N =
        isnan(s->first_contact_s) ? (double)NAN : force_integral / fmin(STEADY_WINDOW, duration);
    if (isnan(s->first_contact_s)) {
        return;
    }
    if (s->steady_force_N > 0) {
        s->force_overshoot_percent = 100 * (s->peak_force_N / s->steady_force_N - 1);
        double settled = settled_since(r, s->steady_force_N);
        s->settling_time_s = fmax(0, settled - s->first_contact_s);
        if (isnan(settled)) {
            s->settling_time_s = (double)NAN;
        }
    }
}

// --- the corrected arm ----------------------------------------------------------------------

// Takes note of the ledger; a run that makes energy is stopped.
static status audit(recording *r, const arm *a, motion *m)
{
    const double *state = m->state;
    double residual = motion_energy_residual(a, m, m->state);
    double turned_over = fabs(state[SLOT_MOTOR_WORK]) + fabs(state[SLOT_EXTERNAL_WORK]) +
                         m->start_energy + fabs(a->motor_torque) * TINY_TURN + TINY_ENERGY;
    summary *s = &r->result->summary;
    s->energy_residual_J = fmax(s->energy_residual_J, fabs(residual));
    // steps that do not resolve the fastest modes damp them: there energy may vanish, not appear
    double wrong = motion_unresolved(a, m) ? residual : fabs(residual);
    return wrong > WRONG_ENERGY * turned_over ? STATUS_UNSTABLE : STATUS_OK;
}

static status record_row(recording *r, const arm *a, motion *m, double *state, double impulse)
{
    if (!r->keep_trace) {
        return STATUS_OK;
    }
    double *q = state_angles(m, state), *w = state_velocities(m, state);
    double *al = state_accelerations(m, state), *quadrature = state_quadratures(m, state);
    int first = a->first, last = a->dof - 1;
    sample row = {
        .time = state[SLOT_TIME],
        .hub_angle = q[0],
        .first_angle = q[first],
        .last_angle = q[last],
        .hub_velocity = w[0],
        .first_velocity = w[first],
        .last_velocity = w[last],
        .hub_acceleration = al[0],
        .first_acceleration = al[first],
        .last_acceleration = al[last],
        .gap = state[SLOT_GAP],
        .gap_velocity = state[SLOT_GAP_RATE],
        .force = state[SLOT_FORCE],
        .impulse = impulse,
        .contact = state[SLOT_CONTACT],
        .sticking = state[SLOT_FRICTION] == HUB_STICK,
        .voltage = motor_limited_voltage(&r->now.motor),
        .motor_torque = a->motor_torque,
        .friction_torque = state[SLOT_FRICTION_TORQUE],
        .kinetic_energy = chain_kinetic_energy(a, q, w),
        .strain_energy = chain_strain_energy(a, q),
        .motor_work = state[SLOT_MOTOR_WORK],
        .external_work = state[SLOT_EXTERNAL_WORK],
        .viscous_loss = quadrature[QUADRATURE_VISCOUS],
        .friction_loss = state[SLOT_FRICTION_LOSS],
        .damping_loss = quadrature[QUADRATURE_DAMPING],
        .impact_loss = state[SLOT_IMPACT_LOSS],
        .energy_residual = motion_energy_residual(a, m, state),
    };
    add_rig_signals(r, &row);
    return add_row(r, &row, q, w);
}

static status record_event(recording *r, double time, event_kind kind, const motion_report *report)
{
    event e = {.time = time, .kind = kind, .index = -1};
    if (kind == EVENT_IMPACT) {
        e.impulse = report->impulse;
        e.speed = report->speed;
        e.loss = report->loss;
    }
    return trace_add_event(&r->result->trace, e);
}

// The first pulse is over: what was the largest force until now?
static void close_first_pulse(recording *r, const motion *m)
{
    summary *s = &r->result->summary;
    r->pulse_open = false;
    s->first_pulse_s = m->state[SLOT_TIME] - s->first_contact_s;
    if (m->pulse_peak >= 0) {
        s->first_pulse_peak_N = m->pulse_peak;
        s->first_pulse_time_to_peak_s = m->pulse_peak_time - s->first_contact_s;
    }
}

// Books an event that has just been applied.
static status book_event(recording *r, motion *m, const motion_report *report)
{
    static const event_kind kinds[] = {[MOTION_IMPACT] = EVENT_IMPACT,
                                       [MOTION_TOUCH] = EVENT_CONTACT,
                                       [MOTION_RELEASE] = EVENT_RELEASE,
                                       [MOTION_STICK] = EVENT_STICK,
                                       [MOTION_SLIP] = EVENT_SLIP};
    summary *s = &r->result->summary;
    double now = m->state[SLOT_TIME];
    bool touches = report->event == MOTION_IMPACT || report->event == MOTION_TOUCH;
    event_kind kind = kinds[report->event];
    if (kind == EVENT_STICK && m->state[SLOT_FRICTION] != HUB_STICK) {
        kind = EVENT_REVERSAL; // the hub came to rest and friction does not hold it
    }
    status failed = record_event(r, now, kind, report);
    if (report->event == MOTION_IMPACT) {
        s->impacts++;
    }
    if (touches) {
        s->separations += r->separated;
        r->separated = false;
        if (isnan(s->first_contact_s)) {
            s->first_contact_s = now;
            s->contact_impulse_Ns = report->impulse;
            r->pulse_open = true;
            motion_watch(m);
        }
        if (report->holds && failed == STATUS_OK && report->event == MOTION_IMPACT) {
            failed = record_event(r, now, EVENT_CONTACT, report);
        }
    }
    bool apart = m->state[SLOT_CONTACT] == 0 && (touches || report->event == MOTION_RELEASE);
    if (apart && r->pulse_open) {
        close_first_pulse(r, m);
    }
    return failed;
}

// Lets the force sensors feel an impact that has just been applied.
static void strike(recording *r, const arm *a, const motion *m, const motion_report *report)
{
    // steps that do not resolve the impact carry its impulse in their force
    if (r->rig != NULL && report->event == MOTION_IMPACT && !motion_unresolved(a, m)) {
        sensors_strike(&r->rig->sensors, report->impulse);
    }
}

// Applies an event that the machine stopped at and records the rows on its both sides.
static status pass_event(recording *r, const arm *a, motion *m, motion_report *report)
{
    status failed = record_row(r, a, m, m->state, 0);
    if (report->event == MOTION_IMPACT && r->result->touch == NULL) {
        size_t size = 2 * (size_t)m->dof * sizeof(double); // velocities stand behind the angles
        r->result->touch = malloc(size);
        if (r->result->touch == NULL) {
            return STATUS_NO_MEMORY;
        }
        memcpy(r->result->touch, state_angles(m, m->state), size);
        r->result->touch_size = size;
    }
    motion_apply(a, m, report);
    strike(r, a, m, report);
    if (failed == STATUS_OK) {
        failed = book_event(r, m, report);
    }
    if (failed == STATUS_OK) {
        failed = audit(r, a, m);
    }
    return failed == STATUS_OK ? record_row(r, a, m, m->state, report->impulse) : failed;
}

// Carries out the script's actions that are due.
static status act(recording *r, arm *a, motion *m, fault *f)
{
    const scenario *s = r->scenario;
    double now = m->state[SLOT_TIME];
    for (; r->next_action < s->action_count && s->actions[r->next_action].time <= now;
         r->next_action++) {
        const action *todo = &s->actions[r->next_action];
        motion_report report = {.event = MOTION_REACHED};
        event e = {.time = now, .kind = EVENT_CHANGE, .index = r->next_action};
        status failed = record_row(r, a, m, m->state, 0);
        if (todo->kind == ACTION_SET) {
            failed = action_apply(todo, &r->now, f);
            if (r->rig != NULL) {
                r->now.motor.voltage = r->rig->applied; // the command is the controller's
                failed = failed == STATUS_OK ? rig_lock(r->rig, r->now.control.lock, f) : failed;
            }
            arm before = *a;
            arm_init(a, &r->now);
            motion_rebind(&before, a, m);
        } else {
            e.kind = EVENT_PUSH;
            e.impulse = todo->value;
            motion_push(a, m, todo->value, &report);
            strike(r, a, m, &report);
        }
        if (failed == STATUS_OK) {
            failed = trace_add_event(&r->result->trace, e);
        }
        if (failed == STATUS_OK && report.event == MOTION_IMPACT) {
            failed = book_event(r, m, &report);
        } else if (failed == STATUS_OK && m->state[SLOT_CONTACT] == 0 && r->pulse_open) {
            close_first_pulse(r, m);
        }
        if (failed == STATUS_OK) {
            failed = record_row(r, a, m, m->state, report.impulse);
        }
        if (failed != STATUS_OK) {
            return failed;
        }
    }
    return STATUS_OK;
}

// Lets another command take effect: the torque jumps, and with it accelerations and force.
static status take_command(recording *r, arm *a, motion *m)
{
    bool contact = m->state[SLOT_CONTACT] != 0;
    double now = m->state[SLOT_TIME];
    book_electrical_energy(r, now, state_angles(m, m->state)[0]);
    r->now.motor.voltage = r->rig->applied;
    double before = a->motor_torque;
    arm_set_voltage(a, &r->now.motor, r->rig->applied);
    motion_retorque(a, m, before);
    status failed = STATUS_OK;
    if (contact && m->state[SLOT_CONTACT] == 0) {
        motion_report lost = {.event = MOTION_RELEASE};
        failed = book_event(r, m, &lost);
    }
    return failed == STATUS_OK && now > 0 ? record_row(r, a, m, m->state, 0) : failed;
}

// What the sensors are fixed to, in a state of the motion.
static sensed_motion sense(const arm *a, const motion *m, double *state)
{
    const double *q = state_angles(m, state), *w = state_velocities(m, state);
    int first = a->first, last = a->dof - 1;
    return (sensed_motion){.angle = q[0],
                           .velocity = w[0],
                           .acceleration = state_accelerations(m, state)[0],
                           .bending = q[last] - q[first],
                           .bending_rate = w[last] - w[first],
                           .force = state[SLOT_FORCE]};
}

// Samples the sensors and changes the command where the time for it has come.
static status control(recording *r, arm *a, motion *m, fault *f)
{
    bool changed;
    double now = m->state[SLOT_TIME];
    if (r->rig == NULL || rig_next_time(r->rig) > now) {
        return STATUS_OK;
    }
    sensed_motion sensed = sense(a, m, m->state);
    status s = rig_act(r->rig, now, &sensed, &changed, f);
    return s == STATUS_OK && changed ? take_command(r, a, m) : s;
}

// Records the rows of the grid that lie within the stride just made, and steps over one at its end.
static status record_grid(recording *r, const arm *a, motion *m, bool at_event)
{
    const double step = r->scenario->parameters.method.step, now = m->state[SLOT_TIME];
    if (!r->keep_trace) {
        return STATUS_OK;
    }
    for (;; r->grid_row++) {
        double time = (double)r->grid_row * step;
        bool at_end = fabs(time - now) <= 1e-9 * step;
        if (time > now && !at_end) {
            return STATUS_OK;
        }
        if (at_end && at_event) {
            continue; // an event records its own rows
        }
        double *state = at_end ? m->state : motion_between(a, m, time);
        status failed = state ? record_row(r, a, m, state, 0) : STATUS_NOT_FINITE;
        failed = failed == STATUS_OK && asked_to_stop(r) ? STATUS_STOPPED : failed;
        if (failed != STATUS_OK) {
            return failed;
        }
    }
}

// Whether the gap was a separation at any instant of the stride just made. A whole flight may lie
// within one stride, so the end says little: look where the gap stops growing.
static bool stride_separated(const arm *a, motion *m)
{
    double from = m->trial[SLOT_TIME], to = m->state[SLOT_TIME];
    if (m->state[SLOT_GAP] > SEPARATION_GAP) {
        return true;
    }
    if (m->state[SLOT_CONTACT] != 0 || m->state[SLOT_GAP_RATE] >= 0) {
        return false;
    }
    for (int i = 0; i < 30; i++) {
        double middle = 0.5 * (from + to);
        const double *state = motion_between(a, m, middle);
        if (state == NULL || state[SLOT_GAP] > SEPARATION_GAP) {
            return state != NULL;
        }
        if (state[SLOT_GAP_RATE] > 0) {
            from = middle;
        } else {
            to = middle;
        }
    }
    return false;
}

// Books the stride just made: force, separation, ledger, rows.
static status book_stride(recording *r, const arm *a, motion *m, bool at_event)
{
    const double *start = m->trial; // where the stride left its beginning
    double length = m->state[SLOT_TIME] - start[SLOT_TIME];
    double integral = state_quadratures(m, m->state)[QUADRATURE_FORCE] -
                      state_quadratures(m, m->trial)[QUADRATURE_FORCE];
    if (!isnan(r->result->summary.first_contact_s) && !r->separated) {
        r->separated = stride_separated(a, m);
    }
    // an arm held still has the energy it had
    status s = motion_held_still(m) ? STATUS_OK : audit(r, a, m);
    // between stops that differ by rounding only, the integral's difference is all rounding
    double ends = (start[SLOT_FORCE] + m->state[SLOT_FORCE]) / 2;
    double mean = length > SHORTEST_MEAN ? integral / length : ends;
    if (r->rig != NULL) {
        sensed_motion first = sense(a, m, m->trial), last = sense(a, m, m->state);
        sensors_follow(&r->rig->sensors, length, &first, &last, mean);
    }
    if (s == STATUS_OK && length > 0) {
        s = remember_stride(r, (force_stride){start[SLOT_TIME], m->state[SLOT_TIME],
                                              start[SLOT_FORCE], m->state[SLOT_FORCE], mean});
    }
    return s == STATUS_OK ? record_grid(r, a, m, at_event) : s;
}

// Snapshots: where a run can be taken up again.

// Prepares the history of a run that keeps one.
static status open_history(recording *r, const motion *m, fault *f)
{
    run_history *h = &r->result->history;
    size_t expected = r->options.rows_expected, most = rows_at_most(expected);
    size_t size = sizeof(run_snapshot) + (size_t)m->size * sizeof(double);
    r->keeps_history = expected > 0 && r->rig == NULL;
    if (!r->keeps_history || h->strides.reserved > 0) {
        return STATUS_OK;
    }
    bool reserved = long_array_reserve(&h->strides, sizeof(force_stride), expected, most) &&
                    long_array_reserve(&h->snapshots, size, expected / 64, most);
    return reserved ? STATUS_OK
                    : fault_set(f, STATUS_NO_MEMORY, "no address space for %zu rows", expected);
}

// Keeps the state at the beginning of a stride, if the last time is some rows ago. Not right after
// an event: how many come at once is not part of a snapshot.
static bool take_snapshot(recording *r, const motion *m, double last_event)
{
    run_history *h = &r->result->history;
    const trace *t = &r->result->trace;
    double now = m->state[SLOT_TIME];
    if (!r->keeps_history || now - last_event < 1e-12) {
        return true;
    }
    size_t before = h->snapshot_count > 0 ? run_snapshot_at(h, h->snapshot_count - 1)->rows : 0;
    if (t->row_count < before + SNAPSHOT_ROWS) {
        return true;
    }
    if (!long_array_grow(&h->snapshots, h->snapshot_count + 1)) {
        return false;
    }
    run_snapshot *kept = run_snapshot_at(h, h->snapshot_count++);
    *kept = (run_snapshot){.time = now,
                           .rows = t->row_count,
                           .events = t->event_count,
                           .strides = r->count,
                           .next_action = r->next_action,
                           .grid_row = r->grid_row,
                           .separated = r->separated,
                           .pulse_open = r->pulse_open,
                           .touched = r->result->touch != NULL,
                           .integral_at_window = r->integral_at_window,
                           .summary = r->result->summary,
                           .steps = m->steps,
                           .start_energy = m->start_energy,
                           .pulse_peak = m->pulse_peak,
                           .pulse_peak_time = m->pulse_peak_time,
                           .largest_penetration = m->largest_penetration};
    memcpy(kept->state, m->state, (size_t)m->size * sizeof(double));
    return true;
}

// Goes back to the last snapshot of a result that run_take_up has prepared.
static void take_up(recording *r, arm *a, motion *m)
{
    const run_history *h = &r->result->history;
    const run_snapshot *kept = run_snapshot_at(h, h->snapshot_count - 1);
    r->count = kept->strides;
    r->strides = h->strides.base;
    r->capacity = h->strides.capacity;
    r->grid_row = kept->grid_row;
    r->separated = kept->separated;
    r->pulse_open = kept->pulse_open;
    r->integral_at_window = kept->integral_at_window;
    for (; r->next_action < kept->next_action; r->next_action++) {
        action_apply(&r->scenario->actions[r->next_action], &r->now, NULL);
    }
    arm_init(a, &r->now);
    memcpy(m->state, kept->state, (size_t)m->size * sizeof(double));
    m->steps = kept->steps;
    m->start_energy = kept->start_energy;
    m->pulse_peak = kept->pulse_peak;
    m->pulse_peak_time = kept->pulse_peak_time;
    m->largest_penetration = kept->largest_penetration;
    publish(r, kept->time);
}

// Advances to `until` or the cut, passing all events on the way and recording rows on the grid.
static status travel(recording *r, const arm *a, motion *m, double until, fault *f)
{
    double last_event = -1;
    int at_once = 0;
    while (m->state[SLOT_TIME] < fmin(until, m->cut)) {
        motion_report report;
        if (!take_snapshot(r, m, last_event)) {
            return fault_set(f, STATUS_NO_MEMORY, "%s", status_text(STATUS_NO_MEMORY));
        }
        status s = motion_stride(a, m, until, r->now.method.step, &report);
        if (s != STATUS_OK) {
            return fault_set(
                f, s, "at t = %.9g s (last good state at %.9g s): %s; the method was %s",
                m->failure_time, m->state[SLOT_TIME], status_text(s), m->stepper->name);
        }
        bool at_event = report.event != MOTION_REACHED;
        s = book_stride(r, a, m, at_event);
        if (s == STATUS_OK && at_event) {
            s = pass_event(r, a, m, &report);
            at_once = m->state[SLOT_TIME] - last_event < 1e-13 ? at_once + 1 : 0;
            last_event = m->state[SLOT_TIME];
        }
        if (s == STATUS_OK && at_once > MOST_EVENTS_AT_ONCE) {
            s = STATUS_NO_PROGRESS;
        }
        if (s == STATUS_OK && asked_to_stop(r)) {
            s = STATUS_STOPPED;
        }
        publish(r, m->state[SLOT_TIME]);
        if (s == STATUS_UNSTABLE) {
            return fault_set(f, s,
                             "at t = %.9g s: %s (residual %.3g J); the method was %s, a "
                             "shorter method.step may help",
                             m->state[SLOT_TIME], status_text(s),
                             motion_energy_residual(a, m, m->state), m->stepper->name);
        }
        if (s != STATUS_OK) {
            return fault_set(f, s, "at t = %.9g s: %s", m->state[SLOT_TIME], status_text(s));
        }
    }
    return STATUS_OK;
}

// The next instant that strides are made for: the rig's, or the end.
static double next_stop(const recording *r)
{
    double stop = r->scenario->parameters.run.duration;
    return r->rig != NULL ? fmin(stop, rig_next_time(r->rig)) : stop;
}

// The next instant at which strides are cut without being made for it: an action, the start of the
// window over which the steady force is taken. What comes before does not depend on it.
static double next_cut(const recording *r, double window, double now)
{
    const scenario *s = r->scenario;
    double cut = r->next_action < s->action_count ? s->actions[r->next_action].time : HUGE_VAL;
    return window > now ? fmin(window, cut) : cut;
}

// Puts the arm where it starts, and records the row of that instant.
static status begin_corrected(recording *r, arm *a, motion *m, fault *f)
{
    const parameters *p = &r->scenario->parameters;
    summary *s = &r->result->summary;
    snprintf(s->method, sizeof s->method, "%s", m->stepper->name);
    if (motion_unresolved(a, m)) {
        snprintf(s->message, sizeof s->message,
                 "steps of %g s do not resolve the fastest modes of %d links (%.3g rad/s): the "
                 "method was %s, what happens within a few steps of an impact is rough; a shorter "
                 "method.step resolves it",
                 p->method.step, a->links, a->highest_frequency, m->stepper->name);
    }
    status failed = open_trace(r, a->dof, f);
    if (failed != STATUS_OK) {
        return failed;
    }
    motion_start(a, m, p->initial.angle, p->initial.velocity);
    failed = control(r, a, m, f);
    r->grid_row = 1;
    return failed == STATUS_OK ? record_row(r, a, m, m->state, 0) : failed;
}

static status run_corrected(recording *r, fault *f)
{
    const parameters *p = &r->scenario->parameters;
    arm a;
    arm_init(&a, &r->now);
    motion *m = motion_create(&a, &p->method);
    if (m == NULL) {
        return fault_set(f, STATUS_NO_MEMORY, "no memory for an arm of %d links", p->arm.links);
    }
    summary *s = &r->result->summary;
    double duration = p->run.duration, window = fmax(0, duration - STEADY_WINDOW);
    status failed = open_history(r, m, f);
    if (failed == STATUS_OK && r->options.take_up) {
        take_up(r, &a, m);
    } else if (failed == STATUS_OK) {
        failed = begin_corrected(r, &a, m, f);
    }
    while (failed == STATUS_OK && m->state[SLOT_TIME] < duration) {
        if (m->state[SLOT_TIME] == window) {
            r->integral_at_window = state_quadratures(m, m->state)[QUADRATURE_FORCE];
        }
        failed = act(r, &a, m, f);
        if (failed == STATUS_OK) {
            failed = control(r, &a, m, f);
        }
        if (failed == STATUS_OK) {
            m->cut = next_cut(r, window, m->state[SLOT_TIME]);
            failed = travel(r, &a, m, next_stop(r), f);
        }
    }
    if (failed == STATUS_OK &&
        (double)(r->grid_row - 1) * p->method.step < duration - 1e-9 * p->method.step) {
        failed = record_row(r, &a, m, m->state, 0); // the end lies between rows of the grid
    }
    s->steps = (double)m->steps;
    s->max_penetration_m = fmax(0, m->largest_penetration);
    s->motor_work_J = m->state[SLOT_MOTOR_WORK];
    s->separations += r->separated;
    if (!isnan(s->first_contact_s)) {
        if (r->pulse_open) {
            close_first_pulse(r, m);
            s->first_pulse_s = (double)NAN; // it never ended
        }
        if (m->pulse_peak >= 0) {
            s->peak_force_N = m->pulse_peak;
            s->time_to_peak_s = m->pulse_peak_time - s->first_contact_s;
        }
    }
    if (failed == STATUS_OK) {
        finish_summary(r, state_quadratures(m, m->state)[QUADRATURE_FORCE] - r->integral_at_window);
        finish_rig_summary(r, state_angles(m, m->state)[0]);
    }
    motion_destroy(m);
    return failed;
}

// --- the printed arm ------------------------------------------------------------------------

static bool observe_printed(void *context, const printed_row *row)
{
    recording *r = context;
    summary *s = &r->result->summary;
    bool was_in_contact = r->pulse_open;
    s->steps += row->time > 0;
    s->max_penetration_m = fmax(s->max_penetration_m, -row->gap);
    if (row->contact && isnan(s->first_contact_s)) {
        s->first_contact_s = row->time;
        s->peak_force_N = s->first_pulse_peak_N = -1;
        r->pulse_open = was_in_contact = true;
        s->first_pulse_s = (double)NAN;
        trace_add_event(&r->result->trace,
                        (event){.time = row->time, .kind = EVENT_CONTACT, .index = -1});
    }
    if (!isnan(s->first_contact_s)) {
        double since = row->time - s->first_contact_s;
        if (row->force > s->peak_force_N) {
            s->peak_force_N = row->force;
            s->time_to_peak_s = since;
        }
        bool first_pulse = isnan(s->first_pulse_s);
        if (first_pulse && row->force > s->first_pulse_peak_N) {
            s->first_pulse_peak_N = row->force;
            s->first_pulse_time_to_peak_s = since;
        }
        if (was_in_contact && !row->contact) {
            r->pulse_open = false;
            if (first_pulse) {
                s->first_pulse_s = since;
            }
            trace_add_event(&r->result->trace,
                            (event){.time = row->time, .kind = EVENT_RELEASE, .index = -1});
        } else if (!was_in_contact && row->contact) {
            r->pulse_open = true;
            s->separations += r->separated;
            r->separated = false;
            trace_add_event(&r->result->trace,
                            (event){.time = row->time, .kind = EVENT_CONTACT, .index = -1});
        }
        s->impacts += row->contact && (!was_in_contact || since == 0);
        r->separated |= row->gap > SEPARATION_GAP;
    }
    const motor_parameters *motor = &r->now.motor;
    sample sampled = {
        .time = row->time,
        .hub_angle = row->angle[0],
        .first_angle = row->angle[1],
        .last_angle = row->angle[2],
        .hub_velocity = row->velocity[0],
        .first_velocity = row->velocity[1],
        .last_velocity = row->velocity[2],
        .hub_acceleration = row->acceleration[0],
        .first_acceleration = row->acceleration[1],
        .last_acceleration = row->acceleration[2],
        .gap = row->gap,
        .gap_velocity = (double)NAN,
        .force = row->force,
        .contact = row->contact,
        .voltage = motor_limited_voltage(motor),
        .motor_torque = motor_torque_per_volt(motor) * motor_limited_voltage(motor),
        .friction_torque = (double)NAN,
        .kinetic_energy = (double)NAN,
        .strain_energy = (double)NAN,
        .motor_work = (double)NAN,
        .external_work = (double)NAN,
        .viscous_loss = (double)NAN,
        .friction_loss = (double)NAN,
        .damping_loss = (double)NAN,
        .impact_loss = (double)NAN,
        .energy_residual = (double)NAN,
    };
    add_rig_signals(r, &sampled);
    double before = r->count > 0 ? r->strides[r->count - 1].last : 0;
    double start = r->count > 0 ? r->strides[r->count - 1].end : row->time;
    force_stride stride = {start, row->time, before, row->force, (before + row->force) / 2};
    if (r->rig != NULL) {
        sensed_motion last = {.angle = row->angle[0],
                              .velocity = row->velocity[0],
                              .acceleration = row->acceleration[0],
                              .bending = row->angle[2] - row->angle[1],
                              .bending_rate = row->velocity[2] - row->velocity[1],
                              .force = row->force};
        sensed_motion first = r->count > 0 ? r->after_step : last;
        sensors_follow(&r->rig->sensors, row->time - start, &first, &last, stride.mean);
        r->after_step = last;
    }
    if (r->rig_status == STATUS_OK && asked_to_stop(r)) {
        r->rig_status = fault_set(r->rig_fault, STATUS_STOPPED, "at t = %.9g s: %s", row->time,
                                  status_text(STATUS_STOPPED));
    }
    return r->rig_status == STATUS_OK && remember_stride(r, stride) == STATUS_OK &&
           (!r->keep_trace ||
            add_row(r, &sampled, row->angle, row->velocity) == STATUS_OK);
}

// Scripted changes take effect at the next step; the printed model knows no pushes.
static void script_printed(void *context, double time, parameters *p)
{
    recording *r = context;
    const scenario *s = r->scenario;
    for (; r->next_action < s->action_count && s->actions[r->next_action].time <= time;
         r->next_action++) {
        const action *todo = &s->actions[r->next_action];
        if (todo->kind == ACTION_SET) {
            action_apply(todo, p, NULL); // the reader has checked the value
            if (r->rig != NULL && r->rig_status == STATUS_OK) {
                r->rig_status = rig_lock(r->rig, p->control.lock, r->rig_fault);
            }
            trace_add_event(&r->result->trace,
                            (event){.time = time, .kind = EVENT_CHANGE, .index = r->next_action});
        }
    }
    if (r->rig != NULL && r->rig_status == STATUS_OK) {
        bool changed;
        r->rig_status = rig_act(r->rig, time, &r->after_step, &changed, r->rig_fault);
        if (changed) {
            book_electrical_energy(r, time, r->after_step.angle);
        }
        p->motor.voltage = r->rig->applied;
    }
    r->now = *p;
}

// The printed algorithm knows its force at its rows only: moves a peak that lies at one of them,
// `*since` after first contact, to the top of the parabola through it and its neighbours.
static void refine_sampled_peak(const recording *r, double *force, double *since)
{
    double at = r->result->summary.first_contact_s + *since;
    for (size_t i = 1; i + 1 < r->count; i++) {
        if (r->strides[i].end != at) {
            continue;
        }
        double before = r->strides[i - 1].last, after = r->strides[i + 1].last;
        double h = r->strides[i].end - r->strides[i - 1].end;
        double second = before - 2 * *force + after, slope = (after - before) / 2;
        bool inside = before > 0 && after > 0 && second < 0; // not at the edge of a pulse
        if (inside && fabs(slope) <= -second) {
            *since += -slope / second * h;
            *force -= slope * slope / (2 * second);
        }
        return;
    }
}

static status run_printed(recording *r, fault *f)
{
    const parameters *p = &r->scenario->parameters;
    status opened = open_trace(r, 3, f);
    if (opened != STATUS_OK) {
        return opened;
    }
    for (int i = 0; i < r->scenario->action_count; i++) {
        if (r->scenario->actions[i].kind == ACTION_PUSH) {
            return fault_set(
                f, STATUS_BAD_SCENARIO,
                "the script pushes the arm at %g s, but the printed model knows no pushes",
                r->scenario->actions[i].time);
        }
    }
    r->rig_fault = f;
    status s = printed_run(&r->now, observe_printed, script_printed, r, f);
    s = s == STATUS_OK ? r->rig_status : s;
    summary *sum = &r->result->summary;
    sum->motor_work_J = sum->energy_residual_J =
        (double)NAN; // (2.16) as printed conserves no energy
    sum->separations += r->separated;
    if (!isnan(sum->first_contact_s)) {
        refine_sampled_peak(r, &sum->first_pulse_peak_N, &sum->first_pulse_time_to_peak_s);
        refine_sampled_peak(r, &sum->peak_force_N, &sum->time_to_peak_s);
    }
    snprintf(sum->method, sizeof sum->method, "Newmark, as printed");
    if (s == STATUS_OK && r->count > 0) {
        double window = p->run.duration - STEADY_WINDOW, total = 0, weight = 0;
        for (size_t i = 1; i < r->count; i++) {
            if (r->strides[i].end > window) {
                total += r->strides[i].last;
                weight++;
            }
        }
        finish_summary(r, weight > 0 ? total / weight * fmin(STEADY_WINDOW, p->run.duration) : 0);
        finish_rig_summary(r, r->after_step.angle);
    }
    return s;
}

// --- either ---------------------------------------------------------------------------------

static double computing_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

status run_scenario(const scenario *s, bool keep_trace, run_result *result)
{
    const run_options options = {.keep_trace = keep_trace};
    return run_scenario_with(s, &options, result);
}

status run_scenario_with(const scenario *s, const run_options *options, run_result *result)
{
    recording r = {.scenario = s,
                   .result = result,
                   .options = *options,
                   .keep_trace = options->keep_trace,
                   .now = s->parameters};
    fault f = {STATUS_OK, ""};
    double start = computing_time();
    long_array_init(&r.own_strides, sizeof(force_stride));
    if (!options->take_up) {
        memset(result, 0, sizeof *result);
        summary_clear(&result->summary);
    }
    status code = start_rig(&r, &f);
    if (code == STATUS_OK) {
        code = s->parameters.arm.model == ARM_PRINTED ? run_printed(&r, &f) : run_corrected(&r, &f);
    }
    rig_destroy(r.rig);
    if (code != STATUS_OK && f.code == STATUS_OK) {
        fault_set(&f, code, "%s", status_text(code));
    }
    result->summary.status = code;
    if (code != STATUS_OK) {
        snprintf(result->summary.message, sizeof result->summary.message, "%s", f.text);
    }
    result->summary.wall_time_s = computing_time() - start;
    long_array_finish(&r.own_strides);
    return code;
}

void run_finish(run_result *result)
{
    trace_finish(&result->trace);
    long_array_finish(&result->history.strides);
    long_array_finish(&result->history.snapshots);
    free(result->touch);
    result->touch = NULL;
}

int run_check_expectations(const scenario *s, const run_result *result, fault_handler report,
                           void *context)
{
    int missed = 0;
    for (int i = 0; i < s->expectation_count; i++) {
        const expectation *e = &s->expectations[i];
        char sentence[512], found[64] = "nothing (null)";
        double value = (double)NAN;
        summary_get(&result->summary, e->quantity, &value);
        bool met = e->is_null ? isnan(value) : fabs(value - e->value) <= e->tolerance;
        if (met) {
            continue;
        }
        if (!isnan(value)) {
            snprintf(found, sizeof found, "%.9g", value);
        }
        if (e->is_null) {
            snprintf(sentence, sizeof sentence, "%s:%d:%d: %s is %s, expected null", s->file,
                     e->line, e->column, e->quantity, found);
        } else {
            snprintf(sentence, sizeof sentence, "%s:%d:%d: %s is %s, expected %.9g within %g",
                     s->file, e->line, e->column, e->quantity, found, e->value, e->tolerance);
        }
        report(context, sentence);
        missed++;
    }
    return missed;
}
