// What a run of the corrected arm comes to, whether its numbers can be relied on, and why
// one ended early.
#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "src/base/extremes.h"
#include "src/base/numbers.h"
#include "src/base/text_stream.h"
#include "src/run/corrected.h"
#include "src/run/recording.h"

// motions of this size are followed to 1e-5 of it [rad, m, N m]
#define SMALL_FLIGHT   1e-10
#define SMALL_CONTACT  1e-7  // the same of those that meet the wall
#define DEEPEST        1e-9  // that an arm may be in a rigid wall by rounding [m]
#define ANGLE_ROUNDING 1e-16 // of an arm that something holds [rad]

// --- why it ended early ----------------------------------------------------------------

// Advice to the user where the energy balance does not close: dense engines choose their
// steps themselves.
static const char *advice(const motion *m)
{
    if (engine_is_dense(m->engine)) {
        return "";
    }
    return ", a shorter method.step may help";
}

status corrected_explain(const corrected_run *c, status s, fault *f)
{
    const motion *m = c->motion;
    FAULT_IF(s == STATUS_UNSTABLE, f, s,
             "at t = %.9g s: %s (residual %.3g J); the method was %s%s",
             m->state[SLOT_TIME], status_text(s),
             motion_energy_residual(&c->arm, m, m->state), m->engine->name, advice(m));
    return fault_set(f, s, "at t = %.9g s: %s", corrected_now(c), status_text(s));
}

// Says where a flat wall could no longer hold the arm.
static status explain_fold(const corrected_run *c, fault *f)
{
    const motion *m = c->motion;
    const double *q = state_angles(m, m->state);
    return fault_set(f, STATUS_FOLDED,
                     "at t = %.9g s: the arm is folded across the hub's axis, its tip on "
                     "the flat wall there, first and last link at %.4g and %.4g rad, "
                     "across the wall within %g rad: no force of a rigid wall holds it "
                     "so, and the model ends there",
                     m->state[SLOT_TIME], q[c->arm.first], q[c->arm.dof - 1],
                     CHAIN_FOLDED);
}

status corrected_explain_standstill(const corrected_run *c, motion_event last, fault *f)
{
    const motion *m = c->motion;
    char cause[ZENO_CAUSE_SIZE];
    zeno_monitor_cause(&c->arm, m, last, cause, sizeof cause);
    return fault_set(f, STATUS_NO_PROGRESS, "at t = %.9g s: %s; the method was %s: %s",
                     m->state[SLOT_TIME], status_text(STATUS_NO_PROGRESS),
                     m->engine->name, cause);
}

status corrected_explain_step(const corrected_run *c, status s, fault *f)
{
    const motion *m = c->motion;
    if (s == STATUS_FOLDED) {
        return explain_fold(c, f);
    }
    if (s == STATUS_NO_PROGRESS) {
        return corrected_explain_standstill(c, MOTION_REACHED, f);
    }
    return fault_set(f, s,
                     "at t = %.9g s (last good state at %.9g s): %s; the method was %s",
                     m->failure_time, m->state[SLOT_TIME], status_text(s),
                     m->engine->name);
}

// --- remarks ---------------------------------------------------------------------------

// Adds a sentence to the remarks.
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

// The beam as one spring, 0: one link on a rigid hub [N m/rad].
static double beam_stiffness(const arm *a)
{
    if (a->links > 1) {
        return 2 * a->joint_stiffness / a->links;
    }
    return a->hub_stiffness;
}

// How far so much energy [J] bends the beam, or turns one rigid link in the time [s] it
// has [rad].
static double turn_of_energy(const arm *a, double energy, double duration)
{
    const double length = a->links * a->link_length;
    const double inertia = a->hub_inertia + a->links * a->link_mass * length * length / 3;
    const double beam = beam_stiffness(a);
    return sqrt(energy / (beam > 0 ? beam : inertia / (duration * duration)));
}

// Adds a remark where the whole motion is so small that the tolerances of events
// (absolute lengths, speeds and torques) are too large a share of it. An arm that has not
// moved is held by friction, or by the wall with more than that.
static void judge_size(const corrected_run *c, double energy)
{
    const arm *a = &c->arm;
    summary *s = &c->recording->result->summary;
    const double duration = c->recording->scenario->parameters.run.duration;
    const double turn = turn_of_energy(a, energy, duration);
    const double travel = turn * a->links * a->link_length;
    const double torque =
        turn > 0 ? energy / turn : fabs(a->motor.torque) - a->motor.stiction;

    const double size = turn > 0 ? smaller(smaller(turn, travel), torque) : torque;
    const double least = isnan(s->first_contact_s) ? SMALL_FLIGHT : SMALL_CONTACT;
    if (size > 0 && size < least) {
        s->inaccurate = true;
        remark(s,
               "the %.3g J put in %s by some %.2g rad only (%.2g m at the tip, with "
               "torques of %.2g N m), so little that the tolerances of contact and "
               "friction show",
               energy, beam_stiffness(a) > 0 ? "bend the beam" : "turn the arm", turn,
               travel, torque);
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
               "wall and friction hold the one link both, so that its force on the "
               "wall is determined within bounds only, the %s from %.6g to %.6g N; "
               "the number given is that without friction",
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
               "friction holds the link where it came to rest in the wall, and "
               "would at any force from %.6g to %.6g N: on another way there it is "
               "another one",
               held.low, held.high);
    }
}

// What rounding of the angles makes of the largest torque and the beam's stiffness [J]:
// an arm that something holds seems to have so much put in.
static double rounding_energy(const corrected_run *c)
{
    const arm *a = &c->arm;
    const double force = larger(c->motion->record.pulse_peak, 0);
    const double torque =
        larger(fabs(a->motor.torque), force * a->links * a->link_length);
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
               "the wall's restitution would have made the arm bounce without end: "
               "%ld times more than %d flights in a row were shorter than a "
               "hundredth of its shortest period, and the impact after them took "
               "all the approach speed, less than %g of the energy (chatter)",
               r->state.chatters, MOTION_MOST_SHORT_FLIGHTS, MOTION_CHATTER_SHARE);
    }

    if (r->state.from_behind > 0) {
        remark(s,
               "a point stops the line of the last link on both sides of its base: "
               "%ld of the touches were behind it, where no link is",
               r->state.from_behind);
    }

    const parameters *p = &r->scenario->parameters;
    if (p->arm.tilt != 0 && r->rig != NULL && p->control.law != LAW_PLAYBACK) {
        remark(
            s,
            "the law is not told of the weight in the tilted plane (arm.tilt = %g rad)%s",
            p->arm.tilt,
            isnan(s->first_contact_s) && wall_stands(&c->arm.wall)
                ? ", and its arm does not come to the wall"
                : "");
    }

    remark_on_single_link(c);
    s->inaccurate = s->energy_residual_J > bound * energy + rounding;
    if (s->inaccurate) {
        remark(s,
               "the energy ledger lacks up to %.3g J of the %.3g J put in, more "
               "than method.residual_bound = %g allows: the method was %s%s",
               s->energy_residual_J, energy, bound, m->engine->name, advice(m));
    }

    if (motion_wall_is_rigid(m) && s->max_penetration_m > DEEPEST) {
        s->inaccurate = true;
        remark(s, "the arm was %.3g m inside a rigid wall: the method was %s%s",
               s->max_penetration_m, m->engine->name, advice(m));
    }
    if (m->record.overheld > 0) {
        s->inaccurate = true;
        remark(s,
               "friction held the hub by %.3g N m more than motor.stiction allows, "
               "a slip was missed: the method was %s%s",
               m->record.overheld, m->engine->name, advice(m));
    }
    judge_size(c, energy > rounding ? energy : 0);
}

void corrected_summarise(corrected_run *c, status failed)
{
    recording *r = c->recording;
    motion *m = c->motion;
    summary *s = &r->result->summary;
    s->steps = (double)m->record.steps;
    s->max_penetration_m = fmax(0, m->record.largest_penetration);
    s->motor_work_J = motion_motor_work(m, m->state);
    if (!motion_wall_is_rigid(m)) {
        s->wall_loss_J = state_quadratures(m, m->state)[QUADRATURE_WALL];
    }
    if (wall_moves(&c->arm.wall)) {
        s->wall_work_J = state_quadratures(m, m->state)[QUADRATURE_PUSHED];
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
        const double when =
            earlier ? r->state.earlier_peak_time : m->record.pulse_peak_time;
        if (peak >= 0) {
            s->peak_force_N = peak;
            s->time_to_peak_s = when - s->first_contact_s;
        }
        s->sensor_1ms_peak_N = force_largest_sensed(r->result, 1e-3, HUGE_VAL);
    }
    corrected_tell_bounds(r->state.largest, &s->peak_force_low_N, &s->peak_force_high_N);

    // results that only a complete run has
    if (failed == STATUS_OK) {
        double integral = state_quadratures(m, m->state)[QUADRATURE_FORCE];
        recording_finish_summary(r, integral - r->state.integral_at_window);
        const double window = fmin(STEADY_WINDOW, r->scenario->parameters.run.duration);
        const force_bounds sum = r->state.in_window,
                           mean = {sum.low / window, sum.high / window};
        corrected_tell_bounds(mean, &s->steady_force_low_N, &s->steady_force_high_N);
        recording_finish_rig_summary(r, state_angles(m, m->state)[0]);
        judge(c);
    }
}
