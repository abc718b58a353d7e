// What happens at an event of a run of the corrected model: the record of it, the pulses
// that it opens or closes, and the changes of the script.
#include "src/run/corrected.h"

#include <math.h>

#include "src/run/recording.h"
#include "src/engines/motion_create.h"
#include "src/base/instant.h"
#include "src/base/sincos.h"

// What swings off the wall sooner than this after the start [s], with no larger force
// before [N], does so at once; a derivative higher than the second decides.
#define AT_ONCE  1e-6
#define NO_FORCE 1e-9

// A face pushed in by less is back [m].
#define FACE_RETURNED 1e-9

void corrected_bind_arm(corrected_run *c)
{
    const recording *r = c->recording;
    arm_init(&c->arm, &r->now);
    c->arm.wall.motion.path = c->path;
    if (r->rig != NULL) {
        arm_set_voltage(&c->arm, r->rig->voltage); // the controller's, not motor.voltage
    }
}

// --- events of the motion --------------------------------------------------------------

static status record_event(recording *r, const motion *m, event_kind kind,
                           const motion_report *report)
{
    event e = {.time = m->state[SLOT_TIME], .kind = kind, .index = -1};
    if (kind == EVENT_IMPACT) {
        e.delivered_by_step = m->state[SLOT_IMPULSE] != 0;
        e.impulse = report->impulse;
        e.speed = report->speed;
        e.loss = report->loss;
    }
    return trace_add_event(&r->result->trace, e);
}

// The first contact, and with it the first pulse, begins now.
static void open_first_pulse(corrected_run *c, double impulse)
{
    recording *r = c->recording;
    summary *s = &r->result->summary;
    s->first_contact_s = c->motion->state[SLOT_TIME];
    s->contact_impulse_Ns = impulse;
    r->state.pulse_open = true;
    r->state.largest = (force_bounds){0};
    motion_reset_peak(c->motion);
}

// Whether it is not the last link that meets a point but its line, on the other side of
// its base.
static bool touches_from_behind(const corrected_run *c)
{
    const arm *a = &c->arm;
    if (a->wall.kind != WALL_POINT) {
        return false;
    }
    const double *q = state_angles(c->motion, c->motion->state);
    const double last = q[a->dof - 1];
    double x, y;
    chain_node(a, q, a->links - 1, &x, &y);
    return (a->wall.x - x) * inline_cos(last) + (a->wall.y - y) * inline_sin(last) < 0;
}

// Whether an arm that comes to the wall meets it where it stands at rest, not a face on
// its way back.
static bool lands(const motion *m)
{
    return m->state[SLOT_FACE] < FACE_RETURNED;
}

// The landing, and with it its pulse, begins now: its peak counts from here.
static void open_landing(corrected_run *c, double impulse)
{
    recording_state *r = &c->recording->state;
    motion *m = c->motion;
    r->landing_open = true;
    r->landing = (landing){m->state[SLOT_TIME], impulse, (double)NAN, (double)NAN,
                           r->landing.before};
    if (isnan(c->recording->result->summary.first_contact_s)) {
        r->earlier_peak = -1;
    } else {
        r->earlier_peak = m->record.pulse_peak;
    }
    r->earlier_peak_time = m->record.pulse_peak_time;
    motion_reset_peak(m);
}

void corrected_close_landing(corrected_run *c)
{
    recording_state *r = &c->recording->state;
    const motion *m = c->motion;
    r->landing_open = false;
    if (m->record.pulse_peak >= 0) {
        r->landing.peak = m->record.pulse_peak;
        r->landing.time_to_peak = m->record.pulse_peak_time - r->landing.time;
    }
}

status corrected_begin_in_contact(corrected_run *c)
{
    // held by a rigid wall, or on one that gives: what goes into that is in contact,
    // however hard the wall throws it back
    const motion *m = c->motion;
    const bool leaves = m->wall_gives && m->state[SLOT_GAP_VELOCITY] >= 0 &&
                        m->state[SLOT_GAP_ACCELERATION] > 0;
    if (m->state[SLOT_CONTACT] == 0 || leaves) {
        return STATUS_OK;
    }
    const motion_report none = {.event = MOTION_TOUCH, .holds = true};
    open_first_pulse(c, 0);
    c->recording->state.from_behind += touches_from_behind(c);
    return record_event(c->recording, m, EVENT_CONTACT, &none);
}

void corrected_close_first_pulse(corrected_run *c)
{
    recording *r = c->recording;
    const motion *m = c->motion;
    summary *s = &r->result->summary;
    r->state.pulse_open = false;
    s->first_pulse_s = m->state[SLOT_TIME] - s->first_contact_s;
    if (m->record.pulse_peak >= 0) {
        s->first_pulse_peak_N = m->record.pulse_peak;
        s->first_pulse_time_to_peak_s = m->record.pulse_peak_time - s->first_contact_s;
    }
    corrected_tell_bounds(r->state.largest, &s->first_pulse_peak_low_N,
                          &s->first_pulse_peak_high_N);
}

void corrected_tell_bounds(force_bounds bounds, double *low, double *high)
{
    if (bounds.high > bounds.low) {
        *low = bounds.low;
        *high = bounds.high;
    }
}

// Whether an arm that started on the wall has swung off at once, without ever pressing on
// it.
static bool has_not_touched(const corrected_run *c)
{
    const summary *s = &c->recording->result->summary;
    return s->first_contact_s < AT_ONCE && s->contact_impulse_Ns == 0 &&
           c->motion->state[SLOT_TIME] < AT_ONCE &&
           !(c->motion->record.pulse_peak > NO_FORCE);
}

// What the trace calls the event.
static event_kind kind_of(const motion *m, const motion_report *report)
{
    static const event_kind kinds[] = {[MOTION_IMPACT] = EVENT_IMPACT,
                                       [MOTION_TOUCH] = EVENT_CONTACT,
                                       [MOTION_RELEASE] = EVENT_RELEASE,
                                       [MOTION_STICK] = EVENT_STICK,
                                       [MOTION_SLIP] = EVENT_SLIP};
    // the hub came to rest: does friction hold it?
    bool turns_back =
        report->event == MOTION_STICK && m->state[SLOT_FRICTION] != HUB_STICK;
    if (turns_back) {
        return EVENT_REVERSAL;
    }
    return kinds[report->event];
}

// Adds the events that one which has just been recorded brought with it, or a change from
// outside: what was in contact no longer is, friction holds or lets go the hub.
static status record_consequences(corrected_run *c, contact_state before,
                                  const motion_report *report)
{
    recording *r = c->recording;
    const motion *m = c->motion;
    const bool holds = m->state[SLOT_FRICTION] == HUB_STICK,
               held = before.friction == HUB_STICK;
    const bool contact = m->state[SLOT_CONTACT] != 0;
    if (before.contact && !contact && report->event != MOTION_RELEASE) {
        TRY(record_event(r, m, EVENT_RELEASE, report));
    }
    if (holds && !held && report->event != MOTION_STICK) {
        TRY(record_event(r, m, EVENT_STICK, report));
    }
    const bool slips = held && !holds && report->event != MOTION_SLIP;
    if (slips) {
        return record_event(r, m, EVENT_SLIP, report);
    }
    return STATUS_OK;
}

// Puts an event that has just been applied into trace and summary; `before`: the contact
// state that it ended.
static status record_applied_event(corrected_run *c, contact_state before,
                                   const motion_report *report)
{
    recording *r = c->recording;
    motion *m = c->motion;
    summary *s = &r->result->summary;
    const bool closes = report->event == MOTION_IMPACT || report->event == MOTION_TOUCH;

    // the event itself; where a start on the wall was no touch, what follows has nothing
    // to release
    if (report->event != MOTION_RELEASE || !isnan(s->first_contact_s)) {
        TRY(record_event(r, m, kind_of(m, report), report));
    }
    s->impacts += report->event == MOTION_IMPACT;

    // the gap closes: a flight ends, at the first time the pulse begins
    if (closes) {
        r->state.from_behind += touches_from_behind(c);
        s->separations += r->state.separated;
        r->state.separated = false;
        if (r->state.landing.time == 0 && lands(m)) {
            open_landing(c, report->impulse);
        }
        if (isnan(s->first_contact_s)) {
            open_first_pulse(c, report->impulse);
        }
        if (report->holds && report->event == MOTION_IMPACT) {
            TRY(record_event(r, m, EVENT_CONTACT, report));
        }
    }

    if (report->chatter) {
        TRY(record_event(r, m, EVENT_CHATTER, report));
        r->state.chatters++;
    }
    TRY(record_consequences(c, before, report));

    // it opens again, for the first time the pulse ends
    bool apart = m->state[SLOT_CONTACT] == 0 && (closes || before.contact);
    if (apart && r->state.pulse_open && !closes && has_not_touched(c)) {
        r->state.pulse_open = false; // its first contact is still to come
        s->first_contact_s = s->contact_impulse_Ns = (double)NAN;
    } else if (apart && r->state.pulse_open) {
        corrected_close_first_pulse(c);
    }
    if (apart && r->state.landing_open) {
        corrected_close_landing(c);
    }
    return STATUS_OK;
}

// Records what a push, which may be an impact, a change of a parameter or a command has
// done to the contact state.
static status record_change(corrected_run *c, contact_state before, motion_report *report)
{
    const bool contact = c->motion->state[SLOT_CONTACT] != 0;
    if (report->event == MOTION_REACHED && contact != before.contact) {
        if (contact) {
            report->event = MOTION_TOUCH;
        } else {
            report->event = MOTION_RELEASE;
        }
    }
    if (report->event == MOTION_REACHED) {
        return record_consequences(c, before, report);
    }
    return record_applied_event(c, before, report);
}

// Adds the impulse of an impact that has just been applied to the force sensors' lag.
static void add_impulse_to_sensors(corrected_run *c, const motion_report *report)
{
    rig *on = c->recording->rig;
    // an impulse that the next step is to deliver is part of that step's force
    if (on != NULL && report->event == MOTION_IMPACT &&
        c->motion->state[SLOT_IMPULSE] == 0) {
        sensors_strike(&on->sensors, report->impulse);
    }
}

status corrected_pass_event(corrected_run *c, motion_report *report)
{
    motion *m = c->motion;
    landing *first = &c->recording->state.landing;

    // before it
    TRY(corrected_record_row(c, m->state, 0));
    const bool closes = report->event == MOTION_IMPACT || report->event == MOTION_TOUCH;
    if (closes && lands(m) && first->time == 0) {
        const double *q = state_angles(m, m->state), *w = state_velocities(m, m->state);
        const int link = c->arm.first, last = c->arm.dof - 1;
        first->before =
            (three_body_state){{q[0], q[link], q[last]}, {w[0], w[link], w[last]}};
    }

    // and after it
    const contact_state ended = contact_state_of(m->state);
    motion_apply(&c->arm, m, report);
    c->recording->state.last_jump = m->state[SLOT_TIME];
    add_impulse_to_sensors(c, report);
    TRY(record_applied_event(c, ended, report));
    TRY(corrected_audit(c));
    return corrected_record_row(c, m->state, report->impulse);
}

// --- the script ------------------------------------------------------------------------

// Whether the wall stays in front of the arm, if the action moves it.
static status check_wall(const corrected_run *c, const action *todo, fault *f)
{
    motion *m = c->motion;
    const wall_parameters *now = &c->recording->now.wall;
    if (todo->parameter != PARAMETER_INDEX(wall.angle) || todo->value == now->angle ||
        now->kind == WALL_NONE) {
        return STATUS_OK;
    }
    parameters p = c->recording->now;
    const status code = action_apply(todo, &p, f);
    arm after = c->arm;
    wall_init(&after.wall, &p);
    const double gap = motion_gap_with(&after, m),
                 least = m->state[SLOT_CONTACT] != 0 ? -1e-12 : 0;
    if (code != STATUS_OK || gap >= least) {
        return code;
    }
    return fault_set_at(f, STATUS_BAD_SCENARIO, "wall.angle",
                        "at t = %.9g s wall.angle = %.9g rad would leave the arm %.4g m "
                        "behind the wall, expected one in front of it",
                        m->state[SLOT_TIME], p.wall.angle, -gap);
}

// Sets a parameter, under which the arm continues in its present state.
static status set_parameter(corrected_run *c, const action *todo, fault *f)
{
    recording *r = c->recording;
    const double now = c->motion->state[SLOT_TIME];
    recording_before_change(r, todo, now, state_angles(c->motion, c->motion->state)[0]);
    const status failed = recording_set(r, todo, now, f);

    // a voltage changes nothing but the torque; else the motion continues with an arm
    // bound anew
    if (todo->parameter == PARAMETER_INDEX(motor.voltage)) {
        const double before = c->arm.motor.torque;
        if (r->rig == NULL) {
            arm_set_voltage(&c->arm, r->now.motor.voltage);
        }
        motion_retorque(&c->arm, c->motion, before);
        return failed;
    }
    const arm before = c->arm;
    corrected_bind_arm(c);
    motion_follow_arm(&c->arm, c->motion);
    motion_rebind(&before, &c->arm, c->motion);
    return failed;
}

status corrected_act(corrected_run *c, const action *todo, int index, fault *f)
{
    recording *r = c->recording;
    motion *m = c->motion;
    motion_report report = {.event = MOTION_REACHED};
    event e = {.time = m->state[SLOT_TIME], .kind = EVENT_CHANGE, .index = index};
    const double work = m->state[SLOT_EXTERNAL_WORK];
    const contact_state before = contact_state_of(m->state);
    status failed = STATUS_OK;
    if (todo->kind == ACTION_SET) {
        TRY(check_wall(c, todo, f));
    }
    TRY(corrected_record_row(c, m->state, 0));

    // the arm continues under another parameter, or with the push's impulse
    if (todo->kind == ACTION_SET) {
        failed = set_parameter(c, todo, f);
    } else {
        e.kind = EVENT_PUSH;
        e.impulse = todo->value;
        motion_push(&c->arm, m, todo->value, &report);
        add_impulse_to_sensors(c, &report);
        if (!isfinite(m->state[SLOT_EXTERNAL_WORK])) {
            failed = fault_set(
                f, STATUS_NOT_FINITE,
                "at t = %.9g s: a push of %g N s gives the arm more energy than "
                "there are numbers for",
                m->state[SLOT_TIME], todo->value);
        }
    }
    r->state.last_jump = m->state[SLOT_TIME];
    r->state.energy_put_in += fabs(m->state[SLOT_EXTERNAL_WORK] - work);
    TRY(failed);
    TRY(trace_add_event(&r->result->trace, e));

    // a push in contact is an impact; either may end the contact
    TRY(record_change(c, before, &report));
    return corrected_record_row(c, m->state, report.impulse);
}

status corrected_run_script(corrected_run *c, fault *f)
{
    const scenario *s = c->recording->scenario;
    int *next = &c->recording->state.next_action;
    const double now = c->motion->state[SLOT_TIME];
    for (; *next < s->action_count && !instant_after(s->actions[*next].time, now);
         ++*next) {
        TRY(corrected_act(c, &s->actions[*next], *next, f));
    }
    return STATUS_OK;
}

// --- the rig ---------------------------------------------------------------------------

// Puts the rig's command into effect.
static status apply_command(corrected_run *c)
{
    recording *r = c->recording;
    motion *m = c->motion;
    contact_state before = contact_state_of(m->state);
    const double now = m->state[SLOT_TIME], torque = c->arm.motor.torque;

    // the motor's torque until now is done with
    recording_change_command(r, now, state_angles(m, m->state)[0]);
    arm_set_voltage(&c->arm, r->rig->voltage);
    motion_retorque(&c->arm, m, torque);

    // less torque may let the contact go, or hold the hub no more; the first command
    // finds it so
    if (!(now > 0)) {
        before.friction = contact_state_of(m->state).friction;
    }
    motion_report done = {.event = MOTION_REACHED};
    return record_change(c, before, &done);
}

status corrected_pass_sample(corrected_run *c, bool changed)
{
    recording *r = c->recording;
    const double now = corrected_now(c);
    const bool sampled = recording_has_new_sample(r);
    const bool jumps = r->state.grid_row > 0 && (changed || sampled);

    // before it, unless the grid has a row here, and after it
    if (jumps && !recording_has_row_at(r, now)) {
        TRY(corrected_record_row(c, corrected_present(c), 0));
    }
    if (sampled) {
        recording_show_sample(r);
    }
    if (changed) {
        TRY(apply_command(c));
    }
    if (jumps) {
        return corrected_record_row(c, corrected_present(c), 0);
    }
    return STATUS_OK;
}
