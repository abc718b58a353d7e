// What a run of the corrected arm comes to, whether its numbers can be relied on, and why
// one ended early.
#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "src/base/extremes.h"
#include "src/base/numbers.h"
#include "src/base/text_stream.h"
#include "src/run/arm_run.h"
#include "src/run/recording.h"

// The smallest turn [rad], travel of the tip [m] and torque [N m] of a run whose events
// are located to 1e-5 of its motion, in free flight and with contact. The tolerances of
// events are fixed numbers that do not scale with the arm, and so is this limit: one
// number in each of the three units.
#define SMALL_FLIGHT  1e-10
#define SMALL_CONTACT 1e-7

// How deep rounding may put an arm into a rigid wall [m].
#define DEEPEST 1e-9

// Rounding error of the angles of an arm that friction or the wall holds [rad].
#define ANGLE_ROUNDING 1e-16

// --- why it ended early ----------------------------------------------------------------

// Advice to the user where the energy balance does not close. Dense engines choose their
// steps themselves, so that a shorter method.step would not help them.
static const char *advice(const motion *m)
{
    if (engine_is_dense(m->engine)) {
        return "";
    }
    return ", a shorter method.step may help";
}

status arm_run_explain(const arm_run *run, status s, fault *f)
{
    const motion *m = run->motion;
    FAULT_IF(s == STATUS_UNSTABLE, f, s,
             "at t = %.9g s: %s (residual %.3g J); the method was %s%s",
             m->state[SLOT_TIME], status_text(s),
             motion_energy_residual(&run->arm, m, m->state), m->engine->name, advice(m));
    return fault_set(f, s, "at t = %.9g s: %s", arm_run_time(run), status_text(s));
}

// Writes the message of a run that ends because the arm is folded across the hub's axis,
// where no force of a flat wall can hold the tip.
static status explain_fold(const arm_run *run, fault *f)
{
    const motion *m = run->motion;
    const double *q = state_angles(m, m->state);
    return fault_set(f, STATUS_FOLDED,
                     "at t = %.9g s: the arm is folded across the hub's axis, its tip on "
                     "the flat wall there, first and last link at %.4g and %.4g rad, "
                     "across the wall within %g rad: no force of a rigid wall holds it "
                     "so, and the model ends there",
                     m->state[SLOT_TIME], q[run->arm.first], q[run->arm.dof - 1],
                     CHAIN_FOLDED);
}

status arm_run_explain_standstill(const arm_run *run, motion_event last, fault *f)
{
    const motion *m = run->motion;
    char cause[ZENO_CAUSE_SIZE];
    zeno_monitor_cause(&run->arm, m, last, cause, sizeof cause);
    return fault_set(f, STATUS_NO_PROGRESS, "at t = %.9g s: %s; the method was %s: %s",
                     m->state[SLOT_TIME], status_text(STATUS_NO_PROGRESS),
                     m->engine->name, cause);
}

status arm_run_explain_step(const arm_run *run, status s, fault *f)
{
    const motion *m = run->motion;
    if (s == STATUS_FOLDED) {
        return explain_fold(run, f);
    }
    if (s == STATUS_NO_PROGRESS) {
        return arm_run_explain_standstill(run, MOTION_REACHED, f);
    }
    return fault_set(f, s,
                     "at t = %.9g s (last good state at %.9g s): %s; the method was %s",
                     m->failure_time, m->state[SLOT_TIME], status_text(s),
                     m->engine->name);
}

// --- remarks ---------------------------------------------------------------------------

// Appends a sentence, printf-like, to the message of the summary, after a semicolon if
// there is one already.
static __attribute__((format(printf, 2, 3))) void remark(summary *s, const char *format,
                                                         ...)
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

// The stiffness of the whole beam as one spring [N m/rad]: the joints of n links in
// series have the stiffness of one joint times 2 / n. A single link has the spring of its
// hub, 0 if that is rigid.
static double beam_stiffness(const arm *a)
{
    if (a->links > 1) {
        return 2 * a->joint_stiffness / a->links;
    }
    return a->hub_stiffness;
}

// The angle by which an energy [J] moves the arm [rad]: where there is a spring, the
// angle theta at which it holds that energy, E = k theta^2; for one rigid link, the angle
// that it turns within the run's duration T [s], E = I (theta / T)^2. Both are orders of
// magnitude, without factors of 1/2.
static double turn_of_energy(const arm *a, double energy, double duration)
{
    const double length = a->links * a->link_length;
    const double inertia = a->hub_inertia + a->links * a->link_mass * length * length / 3;
    const double beam = beam_stiffness(a);
    if (beam > 0) {
        return sqrt(energy / beam);
    }
    return sqrt(energy / (inertia / (duration * duration)));
}

// Says that a run of so little energy [J] is inaccurate, with the turn [rad], the travel
// of the tip [m] and the torque [N m] that it comes to.
static void remark_on_small_motion(const arm_run *run, double energy, double turn,
                                   double travel, double torque)
{
    summary *s = &run->recording->result->summary;
    const char *effect = "turn the arm";
    if (beam_stiffness(&run->arm) > 0) {
        effect = "bend the beam";
    }
    s->inaccurate = true;
    remark(s,
           "the %.3g J put in %s by some %.2g rad only (%.2g m at the tip, with "
           "torques of %.2g N m), so little that the tolerances of contact and "
           "friction show",
           energy, effect, turn, travel, torque);
}

// Adds a remark where turn, travel of the tip or torque of the whole motion is so small
// that the tolerances of events are too large a share of it.
static void judge_size(const arm_run *run, double energy)
{
    const arm *a = &run->arm;
    const summary *s = &run->recording->result->summary;
    const double limit = isnan(s->first_contact_s) ? SMALL_FLIGHT : SMALL_CONTACT;

    // how far the energy moved the arm, at the hub and at the tip
    const double duration = run->recording->scenario->parameters.run.duration;
    const double turn = turn_of_energy(a, energy, duration);
    const double travel = turn * a->links * a->link_length;

    // a mean torque did that work over the turn
    if (turn > 0) {
        const double mean_torque = energy / turn;
        if (turn < limit || travel < limit || mean_torque < limit) {
            remark_on_small_motion(run, energy, turn, travel, mean_torque);
        }
        return;
    }

    // an arm that has not moved although the motor overcomes stiction is held by the
    // wall, with the rest of the torque
    const double torque_on_wall = fabs(a->motor.torque) - a->motor.stiction;
    if (torque_on_wall > 0 && torque_on_wall < limit) {
        remark_on_small_motion(run, energy, turn, travel, torque_on_wall);
    }
}

// Says between which bounds the force on the wall lies where wall and friction hold a
// single link together, so that neither force is determined: the bounds of the steady
// force where there is one, else those of the largest force.
static void remark_on_bounds(summary *s)
{
    const char *which = "largest";
    double low = s->peak_force_low_N, high = s->peak_force_high_N;
    if (!isnan(s->steady_force_high_N)) {
        which = "steady one";
        low = s->steady_force_low_N;
        high = s->steady_force_high_N;
    }
    remark(s,
           "wall and friction hold the one link both, so that its force on the "
           "wall is determined within bounds only, the %s from %.6g to %.6g N; "
           "the number given is that without friction",
           which, low, high);
}

// Remarks on a single link that friction holds against the wall, where the force could be
// another one: between bounds for a rigid wall, and by another way to the same depth for
// a wall that gives.
static void remark_on_single_link(const arm_run *run)
{
    const motion *m = run->motion;
    summary *s = &run->recording->result->summary;
    // bounds were recorded: the wall is rigid
    if (!isnan(s->peak_force_high_N)) {
        remark_on_bounds(s);
        return;
    }

    // the link rests within a wall that gives, whose depth determines the force
    const bool within = !motion_wall_is_rigid(m) && m->state[SLOT_CONTACT] != 0;
    if (within && m->dof == 1 && m->state[SLOT_FRICTION] == HUB_STICK) {
        const force_bounds held = motion_held_forces(&run->arm, m, m->state);
        remark(s,
               "friction holds the link where it came to rest in the wall, and "
               "would at any force from %.6g to %.6g N: on another way there it is "
               "another one",
               held.low, held.high);
    }
}

// The energy [J] that rounding of the angles alone seems to put into an arm that is held
// still: the work of the largest torque T over the rounding error e of an angle, and the
// strain of the beam at that error, T e + k e^2.
static double rounding_energy(const arm_run *run)
{
    const arm *a = &run->arm;
    const double force = larger(run->motion->record.pulse_peak, 0);
    const double torque =
        larger(fabs(a->motor.torque), force * a->links * a->link_length);
    return ANGLE_ROUNDING * (torque + ANGLE_ROUNDING * beam_stiffness(a));
}

// Remarks on contacts that the model of the wall simplifies: bounces without end, which
// it cuts off, and touches of a point behind the base of the last link.
static void remark_on_contacts(const arm_run *run)
{
    summary *s = &run->recording->result->summary;
    const contact_history *contact = &run->recording->state.contact;
    if (contact->chatters > 0) {
        remark(s,
               "the wall's restitution would have made the arm bounce without end: "
               "%ld times more than %d flights in a row were shorter than a "
               "hundredth of its shortest period, and the impact after them took "
               "all the approach speed, less than %g of the energy (chatter)",
               contact->chatters, MOTION_MOST_SHORT_FLIGHTS, MOTION_CHATTER_SHARE);
    }
    if (contact->touches_behind_link > 0) {
        remark(s,
               "a point stops the line of the last link on both sides of its base: "
               "%ld of the touches were behind it, where no link is",
               contact->touches_behind_link);
    }
}

// Remarks that the control law does not know the weight of an arm in a tilted plane. A
// recorded command (playback) is no law, and gets no remark.
static void remark_on_weight(const arm_run *run)
{
    const recording *r = run->recording;
    const parameters *p = &r->scenario->parameters;
    summary *s = &r->result->summary;
    if (p->arm.tilt == 0 || r->rig == NULL || p->control.law == LAW_PLAYBACK) {
        return;
    }

    // the weight may be what keeps the arm from the wall
    const char *missed = "";
    if (isnan(s->first_contact_s) && wall_stands(&run->arm.wall)) {
        missed = ", and its arm does not come to the wall";
    }
    remark(s,
           "the law is not told of the weight in the tilted plane (arm.tilt = %g rad)%s",
           p->arm.tilt, missed);
}

// Remarks what a person should know of the files that a command or a wall's motion was
// read from.
static void remark_on_recordings(const arm_run *run)
{
    const recording *r = run->recording;
    const parameters *p = &r->scenario->parameters;
    summary *s = &r->result->summary;
    if (r->rig != NULL && r->rig->played.told[0] != '\0') {
        remark(s, "%s: %s", p->control.playback_file, r->rig->played.told);
    }
    if (run->path != NULL && run->path->told[0] != '\0') {
        remark(s, "%s: %s", p->wall.motion_file, run->path->told);
    }
}

// Calls the run inaccurate, with a remark each, where its energy ledger does not close,
// where the arm was inside a rigid wall, and where friction held more than it can.
static void judge_accuracy(const arm_run *run, double energy, double rounding)
{
    const motion *m = run->motion;
    summary *s = &run->recording->result->summary;
    const double bound = run->recording->scenario->parameters.method.residual_bound;

    // the ledger of energy
    s->inaccurate = s->energy_residual_J > bound * energy + rounding;
    if (s->inaccurate) {
        remark(s,
               "the energy ledger lacks up to %.3g J of the %.3g J put in, more "
               "than method.residual_bound = %g allows: the method was %s%s",
               s->energy_residual_J, energy, bound, m->engine->name, advice(m));
    }

    // the rigid wall
    if (motion_wall_is_rigid(m) && s->max_penetration_m > DEEPEST) {
        s->inaccurate = true;
        remark(s, "the arm was %.3g m inside a rigid wall: the method was %s%s",
               s->max_penetration_m, m->engine->name, advice(m));
    }

    // friction at the hub
    if (m->record.overheld > 0) {
        s->inaccurate = true;
        remark(s,
               "friction held the hub by %.3g N m more than motor.stiction allows, "
               "a slip was missed: the method was %s%s",
               m->record.overheld, m->engine->name, advice(m));
    }
}

// Judges whether the numbers can be relied on, and remarks on what the run left out.
static void judge(const arm_run *run)
{
    double energy =
        run->motion->record.start_energy + run->recording->state.rows.energy_put_in;
    const double rounding = rounding_energy(run);
    remark_on_contacts(run);
    remark_on_weight(run);
    remark_on_single_link(run);
    remark_on_recordings(run);
    judge_accuracy(run, energy, rounding);

    // what rounding seems to have put in is nothing
    if (energy <= rounding) {
        energy = 0;
    }
    judge_size(run, energy);
}

// --- the summary -----------------------------------------------------------------------

// Writes the largest force and its time. The motion's record of it began anew at the
// landing, so that the peak before that counts as well.
static void summarise_peak(const arm_run *run)
{
    const contact_history *contact = &run->recording->state.contact;
    summary *s = &run->recording->result->summary;
    double peak = run->motion->record.pulse_peak;
    double time = run->motion->record.pulse_peak_time;
    if (contact->earlier_peak > peak) {
        peak = contact->earlier_peak;
        time = contact->earlier_peak_time;
    }
    if (peak >= 0) {
        s->peak_force_N = peak;
        s->time_to_peak_s = time - s->first_contact_s;
    }
}

// Writes what the summary says of contacts: separations, landing, first pulse, and the
// largest force with its bounds. Pulses that the end of the run cuts are closed.
static void summarise_contact(arm_run *run)
{
    recording *r = run->recording;
    const contact_history *contact = &r->state.contact;
    summary *s = &r->result->summary;

    // a flight that the run ends in, and the landing
    if (r->state.rows.separated) {
        s->separations++;
    }
    if (contact->landing_open) {
        arm_run_close_landing(run);
    }
    r->result->landing = contact->landing;

    // first pulse and largest force, also as a sensor of 1 ms reads it
    if (!isnan(s->first_contact_s)) {
        if (contact->pulse_open) {
            arm_run_close_first_pulse(run);
            s->first_pulse_s = (double)NAN; // it never ended
        }
        summarise_peak(run);
        s->sensor_1ms_peak_N = force_largest_sensed(r->result, 1e-3, HUGE_VAL);
    }
    arm_run_write_bounds(r->state.force.largest, &s->peak_force_low_N,
                         &s->peak_force_high_N);
}

// Writes what only a complete run has: the mean force over the window at its end, with
// its bounds, and what the rig's summary says of that force.
static void summarise_end(const arm_run *run)
{
    recording *r = run->recording;
    const motion *m = run->motion;
    const force_record *force = &r->state.force;
    summary *s = &r->result->summary;
    const double integral = state_quadratures(m, m->state)[QUADRATURE_FORCE];
    recording_finish_summary(r, integral - force->integral_at_window);

    // bounds of the mean, where the force is not determined
    const double window = fmin(STEADY_WINDOW, r->scenario->parameters.run.duration);
    const force_bounds mean = {force->in_window.low / window,
                               force->in_window.high / window};
    arm_run_write_bounds(mean, &s->steady_force_low_N, &s->steady_force_high_N);
    recording_finish_rig_summary(r, state_angles(m, m->state)[0]);
}

void arm_run_summarise(arm_run *run, status failed)
{
    const motion *m = run->motion;
    summary *s = &run->recording->result->summary;

    // steps, penetration and work
    s->steps = (double)m->record.steps;
    s->max_penetration_m = fmax(0, m->record.largest_penetration);
    s->motor_work_J = motion_motor_work(m, m->state);
    if (!motion_wall_is_rigid(m)) {
        s->wall_loss_J = state_quadratures(m, m->state)[QUADRATURE_WALL];
    }
    if (wall_moves(&run->arm.wall)) {
        s->wall_work_J = state_quadratures(m, m->state)[QUADRATURE_PUSHED];
    }

    summarise_contact(run);
    if (failed == STATUS_OK) {
        summarise_end(run);
        judge(run);
    }
}
