// What acts on a run of the corrected arm from outside: changes of parameters, pushes,
// and commands of the rig.
#include <math.h>

#include "src/base/instant.h"
#include "src/engines/motion_create.h"
#include "src/run/arm_run.h"
#include "src/run/recording.h"

// How far rounding may put an arm in contact behind a wall that the script turns [m].
#define WALL_ROUNDING 1e-12

// --- the arm as its parameters and the command make it ---------------------------------

void arm_run_bind_arm(arm_run *run)
{
    const recording *r = run->recording;
    arm_init(&run->arm, &r->now);
    run->arm.wall.motion.path = run->path;
    if (r->rig != NULL) {
        arm_set_voltage(&run->arm,
                        r->rig->voltage); // the controller's, not motor.voltage
    }
}

status arm_run_read_path(arm_run *run, fault *f)
{
    const parameters *known = &run->recording->scenario->parameters;
    const wall_parameters *wall = &known->wall;
    if (wall->motion != MOTION_FILE || wall->kind == WALL_NONE) {
        return STATUS_OK;
    }
    TRY(wall_path_create(&run->path, known, f));
    run->arm.wall.motion.path = run->path;
    return STATUS_OK;
}

// --- changes of parameters -------------------------------------------------------------

// Checks that the wall still stands in front of the arm after an action that turns it.
static status check_wall(const arm_run *run, const action *todo, fault *f)
{
    // only a new wall.angle turns it
    motion *m = run->motion;
    const wall_parameters *now = &run->recording->now.wall;
    if (todo->parameter != PARAMETER_INDEX(wall.angle) || todo->value == now->angle ||
        now->kind == WALL_NONE) {
        return STATUS_OK;
    }

    // the wall as the action would leave it
    parameters p = run->recording->now;
    TRY(action_apply(todo, &p, f));
    arm after = run->arm;
    wall_init(&after.wall, &p);

    // its gap to the arm as it is
    const double gap = motion_gap_with(&after, m);
    double least = 0;
    if (m->state[SLOT_CONTACT] != 0) {
        least = -WALL_ROUNDING;
    }
    if (gap >= least) {
        return STATUS_OK;
    }
    return fault_set_at(f, STATUS_BAD_SCENARIO, "wall.angle",
                        "at t = %.9g s wall.angle = %.9g rad would leave the arm %.4g m "
                        "behind the wall, expected one in front of it",
                        m->state[SLOT_TIME], p.wall.angle, -gap);
}

// Sets a parameter; the arm continues in its present state under the new value. If that
// fails, the arm has the parameters as far as they were set.
static status set_parameter(arm_run *run, const action *todo, fault *f)
{
    recording *r = run->recording;
    motion *m = run->motion;

    // the parameter, and the rig's view of it
    const double now = m->state[SLOT_TIME];
    recording_before_change(r, todo, now, state_angles(m, m->state)[0]);
    const status failed = recording_set(r, todo, now, f);

    // a voltage changes the torque alone; under a rig the controller's voltage acts
    if (todo->parameter == PARAMETER_INDEX(motor.voltage)) {
        const double torque = run->arm.motor.torque;
        if (r->rig == NULL) {
            arm_set_voltage(&run->arm, r->now.motor.voltage);
        }
        motion_retorque(&run->arm, m, torque);
        return failed;
    }

    // anything else makes another arm, with which the motion continues
    const arm before = run->arm;
    arm_run_bind_arm(run);
    motion_follow_arm(&run->arm, m);
    motion_rebind(&before, &run->arm, m);
    return failed;
}

// --- actions ---------------------------------------------------------------------------

// Gives the tip an impulse; in contact that is an impact on the wall, which goes into the
// report. STATUS_NOT_FINITE if the energy overflows.
static status push(arm_run *run, const action *todo, motion_report *report, fault *f)
{
    const motion *m = run->motion;
    motion_push(&run->arm, run->motion, todo->value, report);
    arm_run_strike_sensors(run, report);
    if (isfinite(m->state[SLOT_EXTERNAL_WORK])) {
        return STATUS_OK;
    }
    return fault_set(f, STATUS_NOT_FINITE,
                     "at t = %.9g s: a push of %g N s gives the arm more energy than "
                     "there are numbers for",
                     m->state[SLOT_TIME], todo->value);
}

status arm_run_apply_action(arm_run *run, const action *todo, int index, fault *f)
{
    // a row before the action, which must be possible
    motion *m = run->motion;
    motion_report report = {.event = MOTION_REACHED};
    const double work_before = m->state[SLOT_EXTERNAL_WORK];
    const contact_state before = contact_state_of(m->state);
    if (todo->kind == ACTION_SET) {
        TRY(check_wall(run, todo, f));
    }
    TRY(arm_run_record_row(run, m->state, 0));

    // the arm continues under another parameter, or with the push's impulse
    event e = {.time = m->state[SLOT_TIME], .kind = EVENT_CHANGE, .index = index};
    status failed;
    if (todo->kind == ACTION_SET) {
        failed = set_parameter(run, todo, f);
    } else {
        e.kind = EVENT_PUSH;
        e.impulse = todo->value;
        failed = push(run, todo, &report, f);
    }

    // accelerations jump here; the work of the push counts even if the rest fails
    arm_run_note_jump(run);
    arm_run_note_work(run, m->state[SLOT_EXTERNAL_WORK] - work_before);
    TRY(failed);
    TRY(trace_add_event(&run->recording->result->trace, e));

    // either may change the contact; then a row after the action
    TRY(arm_run_record_change(run, before, &report));
    return arm_run_record_row(run, m->state, report.impulse);
}

status arm_run_script(arm_run *run, fault *f)
{
    const scenario *s = run->recording->scenario;
    int *next = &run->recording->state.next_action;
    const double now = run->motion->state[SLOT_TIME];
    for (; *next < s->action_count && !instant_after(s->actions[*next].time, now);
         ++*next) {
        TRY(arm_run_apply_action(run, &s->actions[*next], *next, f));
    }
    return STATUS_OK;
}

// --- the rig ---------------------------------------------------------------------------

// Puts the rig's present command into effect: the motor's torque changes, and with it
// possibly the contact and what friction holds.
static status apply_command(arm_run *run)
{
    recording *r = run->recording;
    motion *m = run->motion;
    contact_state before = contact_state_of(m->state);
    const double now = m->state[SLOT_TIME], torque = run->arm.motor.torque;

    // the energy of the command until now, then the new torque
    recording_change_command(r, now, state_angles(m, m->state)[0]);
    arm_set_voltage(&run->arm, r->rig->voltage);
    motion_retorque(&run->arm, m, torque);

    // the contact may end and friction may hold or let go the hub; at the first command,
    // at the start of the run, a change of friction is no event
    if (!(now > 0)) {
        before.friction = contact_state_of(m->state).friction;
    }
    motion_report report = {.event = MOTION_REACHED};
    return arm_run_record_change(run, before, &report);
}

status arm_run_apply_sample(arm_run *run, bool changed)
{
    recording *r = run->recording;
    const bool sampled = recording_has_new_sample(r);
    const bool jumps = arm_run_has_first_row(run) && (changed || sampled);

    // the row before the sample, unless the grid has one here
    if (jumps && !recording_has_row_at(r, arm_run_time(run))) {
        TRY(arm_run_record_row(run, arm_run_present_state(run), 0));
    }
    if (sampled) {
        recording_show_sample(r);
    }
    if (changed) {
        TRY(apply_command(run));
    }

    // the row after it
    if (jumps) {
        return arm_run_record_row(run, arm_run_present_state(run), 0);
    }
    return STATUS_OK;
}
