// Events of a run of the corrected arm: their record, and the contacts, landing and
// pulses that they open and close.
#include <math.h>

#include "src/base/sincos.h"
#include "src/engines/motion_create.h"
#include "src/run/arm_run.h"
#include "src/run/recording.h"

// An arm that starts on the wall and leaves it within AT_ONCE [s], without a force above
// NO_FORCE [N] until then, was never in contact: it only takes that long to show, as a
// derivative of the gap higher than the second moves it.
#define AT_ONCE  1e-6
#define NO_FORCE 1e-9

// The face of a wall has returned to where it rests if it is pushed in by less [m].
#define FACE_RETURNED 1e-9

// --- events of the motion --------------------------------------------------------------

// Adds an event at the motion's present instant to the trace; an impact has the numbers
// of the report.
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

// Notes that the run's first contact, and with it its first pulse, begins now. Force
// bounds and peak are counted from here.
static void open_first_pulse(arm_run *run, double impulse)
{
    recording *r = run->recording;
    summary *s = &r->result->summary;
    s->first_contact_s = run->motion->state[SLOT_TIME];
    s->contact_impulse_Ns = impulse;
    r->state.contact.pulse_open = true;
    arm_run_begin_bounds(run);
    motion_reset_peak(run->motion);
}

// Whether a point stops the line of the last link behind the link's base, where there is
// no link: the component of base to point along the link is negative there.
static bool touches_behind_link(const arm_run *run)
{
    const arm *a = &run->arm;
    if (a->wall.kind != WALL_POINT) {
        return false;
    }
    const double *q = state_angles(run->motion, run->motion->state);
    const double link_angle = q[a->dof - 1];
    double base_x, base_y;
    chain_node(a, q, a->links - 1, &base_x, &base_y);
    return (a->wall.x - base_x) * inline_cos(link_angle) +
               (a->wall.y - base_y) * inline_sin(link_angle) <
           0;
}

// Whether an arm that comes to the wall meets its face at rest: a face with a mass may
// still be on its way back from an earlier contact.
static bool meets_face_at_rest(const motion *m)
{
    return m->state[SLOT_FACE] < FACE_RETURNED;
}

// Notes that the landing, the contact that ends the first free flight, begins now. The
// motion's record of the peak begins again, so that the peak before is put aside.
static void open_landing(arm_run *run, double impulse)
{
    contact_history *contact = &run->recording->state.contact;
    motion *m = run->motion;
    contact->landing_open = true;
    contact->landing.time = m->state[SLOT_TIME];
    contact->landing.impulse = impulse;
    contact->landing.peak = (double)NAN;
    contact->landing.time_to_peak = (double)NAN;

    // an arm that started on the wall has pressed on it before
    contact->earlier_peak = -1;
    if (!isnan(run->recording->result->summary.first_contact_s)) {
        contact->earlier_peak = m->record.pulse_peak;
    }
    contact->earlier_peak_time = m->record.pulse_peak_time;
    motion_reset_peak(m);
}

void arm_run_close_landing(arm_run *run)
{
    contact_history *contact = &run->recording->state.contact;
    const motion *m = run->motion;
    contact->landing_open = false;
    if (m->record.pulse_peak >= 0) {
        contact->landing.peak = m->record.pulse_peak;
        contact->landing.time_to_peak = m->record.pulse_peak_time - contact->landing.time;
    }
}

status arm_run_begin_in_contact(arm_run *run)
{
    contact_history *contact = &run->recording->state.contact;
    contact->earlier_peak = -1;
    contact->landing.before.angle[0] = (double)NAN;

    // an arm at a wall that gives leaves it unless it moves into it, or is not pushed
    // away
    const motion *m = run->motion;
    const bool leaves = m->wall_gives && m->state[SLOT_GAP_VELOCITY] >= 0 &&
                        m->state[SLOT_GAP_ACCELERATION] > 0;
    if (m->state[SLOT_CONTACT] == 0 || leaves) {
        return STATUS_OK;
    }

    // it is in its first contact
    const motion_report none = {.event = MOTION_TOUCH, .holds = true};
    open_first_pulse(run, 0);
    if (touches_behind_link(run)) {
        contact->touches_behind_link++;
    }
    return record_event(run->recording, m, EVENT_CONTACT, &none);
}

void arm_run_close_first_pulse(arm_run *run)
{
    recording *r = run->recording;
    const motion *m = run->motion;
    summary *s = &r->result->summary;
    r->state.contact.pulse_open = false;
    s->first_pulse_s = m->state[SLOT_TIME] - s->first_contact_s;
    if (m->record.pulse_peak >= 0) {
        s->first_pulse_peak_N = m->record.pulse_peak;
        s->first_pulse_time_to_peak_s = m->record.pulse_peak_time - s->first_contact_s;
    }
    arm_run_write_bounds(r->state.force.largest, &s->first_pulse_peak_low_N,
                         &s->first_pulse_peak_high_N);
}

// Whether an arm that started on the wall has swung off at once, without ever pressing on
// it.
static bool has_not_touched(const arm_run *run)
{
    const summary *s = &run->recording->result->summary;
    return s->first_contact_s < AT_ONCE && s->contact_impulse_Ns == 0 &&
           run->motion->state[SLOT_TIME] < AT_ONCE &&
           !(run->motion->record.pulse_peak > NO_FORCE);
}

// What the trace calls the event.
static event_kind kind_of(const motion *m, const motion_report *report)
{
    static const event_kind kinds[] = {[MOTION_IMPACT] = EVENT_IMPACT,
                                       [MOTION_TOUCH] = EVENT_CONTACT,
                                       [MOTION_RELEASE] = EVENT_RELEASE,
                                       [MOTION_STICK] = EVENT_STICK,
                                       [MOTION_SLIP] = EVENT_SLIP};
    // a hub that came to rest and is not held by friction turns back
    bool turns_back =
        report->event == MOTION_STICK && m->state[SLOT_FRICTION] != HUB_STICK;
    if (turns_back) {
        return EVENT_REVERSAL;
    }
    return kinds[report->event];
}

// Records the further events that an event or a change from outside has brought with it:
// the arm is released from the wall, or friction begins or ceases to hold the hub.
// `before` is the state of contact and friction until then.
static status record_consequences(arm_run *run, contact_state before,
                                  const motion_report *report)
{
    recording *r = run->recording;
    const motion *m = run->motion;

    // the wall
    const bool contact = m->state[SLOT_CONTACT] != 0;
    if (before.contact && !contact && report->event != MOTION_RELEASE) {
        TRY(record_event(r, m, EVENT_RELEASE, report));
    }

    // friction at the hub
    const bool held = before.friction == HUB_STICK;
    const bool holds = m->state[SLOT_FRICTION] == HUB_STICK;
    if (holds && !held && report->event != MOTION_STICK) {
        TRY(record_event(r, m, EVENT_STICK, report));
    }
    const bool slips = held && !holds && report->event != MOTION_SLIP;
    if (slips) {
        return record_event(r, m, EVENT_SLIP, report);
    }
    return STATUS_OK;
}

// Records that the arm has come to the wall: a flight ends there, the landing and the
// first pulse may begin, and an impact after which the arm stays begins a contact.
static status record_touch(arm_run *run, const motion_report *report)
{
    recording *r = run->recording;
    contact_history *contact = &r->state.contact;
    summary *s = &r->result->summary;

    // how it came there
    if (touches_behind_link(run)) {
        contact->touches_behind_link++;
    }
    if (arm_run_end_flight(run)) {
        s->separations++;
    }

    // what begins with it
    if (contact->landing.time == 0 && meets_face_at_rest(run->motion)) {
        open_landing(run, report->impulse);
    }
    if (isnan(s->first_contact_s)) {
        open_first_pulse(run, report->impulse);
    }
    if (report->holds && report->event == MOTION_IMPACT) {
        return record_event(r, run->motion, EVENT_CONTACT, report);
    }
    return STATUS_OK;
}

// Records that the arm has left the wall, which ends the landing and the first pulse. An
// arm that started on the wall and left it at once, without pressing on it, has its first
// contact still to come.
static void record_separation(arm_run *run, bool touched_now)
{
    contact_history *contact = &run->recording->state.contact;
    summary *s = &run->recording->result->summary;
    if (contact->pulse_open && !touched_now && has_not_touched(run)) {
        contact->pulse_open = false;
        s->first_contact_s = s->contact_impulse_Ns = (double)NAN;
    } else if (contact->pulse_open) {
        arm_run_close_first_pulse(run);
    }
    if (contact->landing_open) {
        arm_run_close_landing(run);
    }
}

// Whether the arm comes to the wall.
static bool touches(const motion_report *report)
{
    return report->event == MOTION_IMPACT || report->event == MOTION_TOUCH;
}

// Records in trace and summary an event that has just been applied to the motion.
// `before` is the state of contact and friction that the event ended.
static status record_applied_event(arm_run *run, contact_state before,
                                   const motion_report *report)
{
    recording *r = run->recording;
    const motion *m = run->motion;
    summary *s = &r->result->summary;

    // the event itself, except for a release from a contact that never was one: the arm
    // started on the wall without pressing on it
    if (report->event != MOTION_RELEASE || !isnan(s->first_contact_s)) {
        TRY(record_event(r, m, kind_of(m, report), report));
    }
    if (report->event == MOTION_IMPACT) {
        s->impacts++;
    }

    // what it brought with it
    if (touches(report)) {
        TRY(record_touch(run, report));
    }
    if (report->chatter) {
        TRY(record_event(r, m, EVENT_CHATTER, report));
        r->state.contact.chatters++;
    }
    TRY(record_consequences(run, before, report));

    // it may have left the wall
    const bool apart = m->state[SLOT_CONTACT] == 0;
    if (apart && (touches(report) || before.contact)) {
        record_separation(run, touches(report));
    }
    return STATUS_OK;
}

status arm_run_record_change(arm_run *run, contact_state before, motion_report *report)
{
    const bool contact = run->motion->state[SLOT_CONTACT] != 0;
    if (report->event == MOTION_REACHED && contact != before.contact) {
        if (contact) {
            report->event = MOTION_TOUCH;
        } else {
            report->event = MOTION_RELEASE;
        }
    }
    if (report->event == MOTION_REACHED) {
        return record_consequences(run, before, report);
    }
    return record_applied_event(run, before, report);
}

void arm_run_strike_sensors(arm_run *run, const motion_report *report)
{
    rig *on = run->recording->rig;

    // an impulse that the next step is to deliver is part of that step's force
    if (on != NULL && report->event == MOTION_IMPACT &&
        run->motion->state[SLOT_IMPULSE] == 0) {
        sensors_strike(&on->sensors, report->impulse);
    }
}

// Angles and velocities of hub, first and last link at present.
static three_body_state three_bodies(const arm_run *run)
{
    const motion *m = run->motion;
    const double *q = state_angles(m, m->state), *w = state_velocities(m, m->state);
    const int first = run->arm.first, last = run->arm.dof - 1;
    return (three_body_state){{q[0], q[first], q[last]}, {w[0], w[first], w[last]}};
}

status arm_run_apply_event(arm_run *run, motion_report *report)
{
    motion *m = run->motion;
    landing *first = &run->recording->state.contact.landing;

    // before it
    TRY(arm_run_record_row(run, m->state, 0));
    if (touches(report) && meets_face_at_rest(m) && first->time == 0) {
        first->before = three_bodies(run);
    }

    // and after it
    const contact_state before = contact_state_of(m->state);
    motion_apply(&run->arm, m, report);
    arm_run_note_jump(run);
    arm_run_strike_sensors(run, report);
    TRY(record_applied_event(run, before, report));
    TRY(arm_run_audit(run));
    return arm_run_record_row(run, m->state, report->impulse);
}
