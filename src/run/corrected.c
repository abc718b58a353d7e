#include "src/base/text_stream.h"
#include "src/run/corrected.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/run/resume.h"
#include "src/run/recording.h"
#include "src/base/extremes.h"
#include "src/base/instant.h"

#define SMALL_FLIGHT   1e-10 // motions of this size are followed to 1e-5 of it [rad, m, N m]
#define SMALL_CONTACT  1e-7  // the same of those that meet the wall
#define DEEPEST        1e-9  // that an arm may be in a rigid wall by rounding [m]
#define ANGLE_ROUNDING 1e-16 // of an arm that something holds [rad]
#define GRID_TOLERANCE 1e-9  // of a step: the end so near a row of the grid has that row

// Whether the stretch between two stops is through.
static bool stretch_is_over(const corrected_run *c)
{
    return !(corrected_now(c) < smaller(c->stop, c->motion->record.tstop));
}

// The next instant that steps end at: the rig's, or the end.
static double next_stop(const recording *r)
{
    double stop = r->scenario->parameters.run.duration;
    return r->rig != NULL ? smaller(rig_next_time(r->rig), stop) : stop;
}

// The next instant at which steps are cut without being planned for it: an action, or the start of
// the window of the steady force. The motion before it does not depend on it.
static double next_cut(const recording *r, double window, double now)
{
    const scenario *s = r->scenario;
    double cut =
        r->state.next_action < s->action_count ? s->actions[r->state.next_action].time : HUGE_VAL;
    return instant_after(window, now) ? smaller(window, cut) : cut;
}

// Puts the arm where it starts.
static status begin(corrected_run *c, fault *f)
{
    recording *r = c->recording;
    motion *m = c->motion;
    const parameters *p = &r->scenario->parameters;
    summary *s = &r->result->summary;
    memccpy(s->method, m->engine->name, 0, sizeof s->method - 1);

    if (motion_unresolved(&c->arm, m)) {
        decimal_print(
            s->message, sizeof s->message,
            "steps of %g s do not resolve the fastest modes of %d links (%.3g rad/s): the "
            "method was %s, what happens within a few steps of an impact is rough; a shorter "
            "method.step resolves it",
            p->method.step, c->arm.links, c->arm.highest_frequency, m->engine->name);
    }

    status failed = recording_open_trace(r, c->arm.dof, f);
    if (failed != STATUS_OK) {
        return failed;
    }

    r->state.earlier_peak = -1;
    motion_start(&c->arm, m, p->initial.angle, p->initial.velocity);
    if (m->wall_moves && m->state[SLOT_GAP] < -DEEPEST) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, "wall.motion",
                            "at t = 0 the wall has moved %.4g m past the arm, which must start in "
                            "front of it (initial.angle)",
                            -m->state[SLOT_GAP]);
    }
    failed = corrected_begin_in_contact(c);
    return failed == STATUS_OK ? failed : fault_no_memory(f);
}

// Samples the sensors and changes the command where the time for it has come. A step under way goes
// on unless something changes.
static status run_rig(corrected_run *c, fault *f)
{
    rig *on = c->recording->rig;
    const double now = corrected_now(c);
    if (on == NULL || instant_after(rig_next_time(on), now)) {
        return STATUS_OK;
    }
    bool changed;
    const sensed_motion sensed = corrected_sensed_now(c);
    status s = rig_act(on, now, &sensed, &changed, f);
    if (s == STATUS_OK && changed) {
        s = corrected_end_step(c, f);
        s = s == STATUS_OK ? corrected_apply_command(c) : s;
    }
    return s;
}

// The rig's first sample, and the row of the start, which is there even where that sample fails.
static status record_start(corrected_run *c, fault *f)
{
    recording *r = c->recording;
    status failed = run_rig(c, f);
    r->state.grid_row = 1;
    status recorded = corrected_record_row(c, c->motion->state, 0);
    return failed == STATUS_OK ? recorded : failed;
}

// corrected_approach_stride where a stretch is over, or the run is to begin; apart from it, which
// then has little to do for most strides.
static __attribute__((noinline)) status begin_stretch(corrected_run *c, bool *ended, fault *f)
{
    recording *r = c->recording;
    motion *m = c->motion;
    const parameters *p = &r->scenario->parameters;
    const double duration = p->run.duration, window = larger(duration - STEADY_WINDOW, 0);
    status failed = r->state.grid_row == 0 ? record_start(c, f) : STATUS_OK;

    // script and rig act between stretches of motion, each ending where one of them is due
    while (failed == STATUS_OK && stretch_is_over(c)) {
        *ended = !(corrected_now(c) < duration);
        if (*ended) {
            break;
        }

        // the mean force of the end begins to count here
        if (!c->under_way.goes_on && same_instant(m->state[SLOT_TIME], window)) {
            r->state.integral_at_window = state_quadratures(m, m->state)[QUADRATURE_FORCE];
            r->state.in_window = (force_bounds){0};
        }

        // what is due now, then how far the motion may go on its own
        if (r->state.next_action < r->scenario->action_count) {
            failed = corrected_run_script(c, f);
        }
        if (failed == STATUS_OK && r->rig != NULL) {
            failed = run_rig(c, f);
        }
        m->record.tstop = next_cut(r, window, m->state[SLOT_TIME]);
        c->stop = next_stop(r);
        c->last_event = -1;
        c->at_once = 0;
    }

    // the end may lie between rows of the grid
    double last_row = (double)(r->state.grid_row - 1) * p->method.step;
    if (*ended && last_row < duration - GRID_TOLERANCE * p->method.step) {
        failed = corrected_record_row(c, m->state, 0);
    }
    return failed;
}

status corrected_approach_stride(corrected_run *c, bool *ended, fault *f)
{
    *ended = false;
    const bool within = c->recording->state.grid_row > 0 && !stretch_is_over(c);
    return within ? STATUS_OK : begin_stretch(c, ended, f);
}

// Adds a sentence to the remarks.
static __attribute__((format(printf, 2, 3))) void remark(summary *s, const char *format, ...)
{
    size_t length = strlen(s->message);
    if (length > 0 && length + 2 < sizeof s->message) {
        length += (size_t)snprintf(s->message + length, sizeof s->message - length, "; ");
    }
    va_list values;
    va_start(values, format);
    decimal_vprint(s->message + length, sizeof s->message - length, format, values);
    va_end(values);
}

// The beam as one spring, 0: one link on a rigid hub [N m/rad].
static double beam_stiffness(const arm *a)
{
    return a->links > 1 ? 2 * a->joint_stiffness / a->links : a->hub_stiffness;
}

// How far so much energy [J] bends the beam, or turns one rigid link in the time [s] it has [rad].
static double turn_of_energy(const arm *a, double energy, double duration)
{
    const double length = a->links * a->link_length;
    const double inertia = a->hub_inertia + a->links * a->link_mass * length * length / 3;
    const double beam = beam_stiffness(a);
    return sqrt(energy / (beam > 0 ? beam : inertia / (duration * duration)));
}

// Adds a remark where the whole motion is so small that the tolerances of events (absolute lengths,
// speeds and torques) are too large a share of it. An arm that has not moved is held by friction,
// or by the wall with more than that.
static void judge_size(const corrected_run *c, double energy)
{
    const arm *a = &c->arm;
    summary *s = &c->recording->result->summary;
    const double duration = c->recording->scenario->parameters.run.duration;
    const double turn = turn_of_energy(a, energy, duration);
    const double travel = turn * a->links * a->link_length;
    const double torque = turn > 0 ? energy / turn : fabs(a->motor.torque) - a->motor.stiction;

    const double size = turn > 0 ? smaller(smaller(turn, travel), torque) : torque;
    const double least = isnan(s->first_contact_s) ? SMALL_FLIGHT : SMALL_CONTACT;
    if (size > 0 && size < least) {
        s->inaccurate = true;
        remark(s,
               "the %.3g J put in %s by some %.2g rad only (%.2g m at the tip, with torques of "
               "%.2g N m), so little that the tolerances of contact and friction show",
               energy, beam_stiffness(a) > 0 ? "bend the beam" : "turn the arm", turn, travel,
               torque);
    }
}

// What friction leaves open of the force of one link.
static void remark_on_single_link(const corrected_run *c)
{
    const motion *m = c->motion;
    summary *s = &c->recording->result->summary;
    if (!isnan(s->peak_force_high_N)) {
        const bool steady = !isnan(s->steady_force_high_N);
        remark(s,
               "wall and friction hold the one link both, so that its force on the wall is "
               "determined within bounds only, the %s from %.6g to %.6g N; the number given is "
               "that without friction",
               steady ? "steady one" : "largest",
               steady ? s->steady_force_low_N : s->peak_force_low_N,
               steady ? s->steady_force_high_N : s->peak_force_high_N);
        return;
    }

    // within a wall that gives the depth says the force
    const bool within = !motion_wall_is_rigid(m) && m->state[SLOT_CONTACT] != 0;
    if (within && m->dof == 1 && m->state[SLOT_FRICTION] == HUB_STICK) {
        const force_bounds held = motion_held_forces(&c->arm, m, m->state);
        remark(s,
               "friction holds the link where it came to rest in the wall, and would at any force "
               "from %.6g to %.6g N: on another way there it is another one",
               held.low, held.high);
    }
}

// What rounding of the angles makes of the largest torque and the beam's stiffness [J]: an arm that
// something holds seems to have so much put in.
static double rounding_energy(const corrected_run *c)
{
    const arm *a = &c->arm;
    const double force = larger(c->motion->record.pulse_peak, 0);
    const double torque = larger(fabs(a->motor.torque), force * a->links * a->link_length);
    return ANGLE_ROUNDING * (torque + ANGLE_ROUNDING * beam_stiffness(a));
}

// Judges whether the numbers can be relied on, and remarks on what the run left out.
static void judge(const corrected_run *c)
{
    const recording *r = c->recording;
    const motion *m = c->motion;
    summary *s = &r->result->summary;
    double bound = r->scenario->parameters.method.residual_bound;
    double energy = m->record.start_energy + r->state.energy_put_in;
    const double rounding = rounding_energy(c);
    if (r->state.chatters > 0) {
        remark(s,
               "the wall's restitution would have made the arm bounce without end: %ld times more "
               "than %d flights in a row were shorter than a hundredth of its shortest period, and "
               "the impact after them took all the approach speed (chatter)",
               r->state.chatters, MOTION_MOST_SHORT_FLIGHTS);
    }

    if (r->state.from_behind > 0) {
        remark(s,
               "a point stops the line of the last link on both sides of its base: %ld of the "
               "touches were behind it, where no link is",
               r->state.from_behind);
    }

    remark_on_single_link(c);
    s->inaccurate = s->energy_residual_J > bound * energy + rounding;
    if (s->inaccurate) {
        remark(s,
               "the energy ledger lacks up to %.3g J of the %.3g J put in, more than "
               "method.residual_bound = %g allows: the method was %s%s",
               s->energy_residual_J, energy, bound, m->engine->name, corrected_advice(m));
    }

    if (motion_wall_is_rigid(m) && s->max_penetration_m > DEEPEST) {
        s->inaccurate = true;
        remark(s, "the arm was %.3g m inside a rigid wall: the method was %s%s",
               s->max_penetration_m, m->engine->name, corrected_advice(m));
    }
    if (m->record.overheld > 0) {
        s->inaccurate = true;
        remark(s,
               "friction held the hub by %.3g N m more than motor.stiction allows, a slip was "
               "missed: the method was %s%s",
               m->record.overheld, m->engine->name, corrected_advice(m));
    }
    judge_size(c, energy > rounding ? energy : 0);
}

// The bounds of the mean force over the last of the run.
static void tell_steady_bounds(const corrected_run *c)
{
    const recording *r = c->recording;
    summary *s = &r->result->summary;
    const double window = fmin(STEADY_WINDOW, r->scenario->parameters.run.duration);
    const force_bounds mean = {r->state.in_window.low / window, r->state.in_window.high / window};
    corrected_tell_bounds(mean, &s->steady_force_low_N, &s->steady_force_high_N);
}

// Sums up what is known of the run, also of one that failed or has not come to its end (`failed`
// then says so). What it has recorded is then that of a run that ended here.
static void sum_up(corrected_run *c, status failed)
{
    recording *r = c->recording;
    motion *m = c->motion;
    summary *s = &r->result->summary;

    // as if the run ended here; a step that fails in this does not end the run, but may be lost
    fault none;
    loss_unless(corrected_end_step(c, &none) != STATUS_NO_MEMORY);
    s->steps = (double)m->record.steps;
    s->max_penetration_m = fmax(0, m->record.largest_penetration);
    s->motor_work_J = motion_motor_work(m, m->state);
    if (!motion_wall_is_rigid(m)) {
        s->wall_loss_J = state_quadratures(m, m->state)[QUADRATURE_WALL];
    }
    s->separations += r->state.separated;

    // results of the contact
    if (r->state.landing_open) {
        corrected_close_landing(c);
    }
    r->result->landing = r->state.landing;
    if (!isnan(s->first_contact_s)) {
        if (r->state.pulse_open) {
            corrected_close_first_pulse(c);
            s->first_pulse_s = (double)NAN; // it never ended
        }
        const bool earlier = r->state.earlier_peak > m->record.pulse_peak;
        const double peak = earlier ? r->state.earlier_peak : m->record.pulse_peak;
        const double when = earlier ? r->state.earlier_peak_time : m->record.pulse_peak_time;
        if (peak >= 0) {
            s->peak_force_N = peak;
            s->time_to_peak_s = when - s->first_contact_s;
        }
    }
    corrected_tell_bounds(r->state.largest, &s->peak_force_low_N, &s->peak_force_high_N);

    // results that only a complete run has
    if (failed == STATUS_OK) {
        double integral = state_quadratures(m, m->state)[QUADRATURE_FORCE];
        recording_finish_summary(r, integral - r->state.integral_at_window);
        tell_steady_bounds(c);
        recording_finish_rig_summary(r, state_angles(m, m->state)[0]);
        judge(c);
    }
}

void corrected_sum_up(corrected_run *c, status failed)
{
    assert(c != NULL && c->motion != NULL);
    rig *on = c->recording->rig;
    if (!c->under_way.goes_on) {
        sum_up(c, failed);
        return;
    }

    // all that the end of the step under way changes, but for what is summed up
    const motion moving = *c->motion;
    const open_step under_way = c->under_way;
    const pace paced = c->pace;
    const sensors felt = on->sensors;
    size_t *forces = &c->recording->result->history.forces.count;
    const size_t kept = *forces;
    sum_up(c, failed);

    // and back to where the step started, which is where it left that
    const double *start = c->motion->trial;
    *c->motion = moving;
    memmove(moving.state, start, (size_t)moving.size * sizeof *start);
    memmove(moving.trial, start, (size_t)moving.size * sizeof *start);
    c->under_way = under_way;
    c->pace = paced;
    on->sensors = felt;
    *forces = kept;
    corrected_present(c);
}

status corrected_open(corrected_run *c, recording *r, motion *spare, fault *f)
{
    assert(c != NULL && r != NULL && r->scenario->parameters.arm.model != ARM_PRINTED);
    const parameters *p = &r->scenario->parameters;
    memset(c, 0, offsetof(corrected_run, arm));
    c->recording = r;
    c->last_event = -1;
    c->pace = pace_begin();
    corrected_bind_arm(c);
    c->motion = motion_renew(spare, &c->arm, &p->method);
    if (c->motion == NULL) {
        return fault_set(f, STATUS_NO_MEMORY, "no memory for an arm of %d links", p->arm.links);
    }

    // where a file says how the wall moves
    if (p->wall.motion == MOTION_FILE && p->wall.kind != WALL_NONE) {
        const status read = wall_path_create(&c->path, p->wall.motion_file, f);
        if (read != STATUS_OK) {
            return read;
        }
        c->arm.wall.motion.path = c->path;
    }

    status failed = checkpoint_open_history(r, c->motion, f);
    if (failed == STATUS_OK && r->options->resume) {
        checkpoint_restore(r, &c->arm, c->motion);
        c->arm.wall.motion.path = c->path;
    } else if (failed == STATUS_OK) {
        failed = begin(c, f);
    }
    return failed;
}

motion *corrected_finish(corrected_run *c, status failed)
{
    motion *m = c->motion;
    if (m != NULL) {
        sum_up(c, failed);
    }
    wall_path_destroy(c->path);
    c->path = NULL;
    return m;
}

void corrected_close(corrected_run *c, status failed)
{
    motion_destroy(corrected_finish(c, failed));
}
