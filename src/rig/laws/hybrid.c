// The thesis's hybrid impact and force controller, 5.2 to 5.4, and its variants, in a
// table at the end: another approach (speed-limit, bang-bang), another answer to the
// impact (reverse-torque), and the controller that 5.4 calls ideal (recovering).
//
// In contact the arm has one degree of freedom, theta, with the wall at theta_imp
// (docs/explanation/control-design.md):
//
//     M theta'' = K u - D theta' - k_st sign(theta') + 4 k2 (theta_imp - theta)    (5.13)
//     M = I1 + 2 I + m l^2/2                                                       (5.21)
//
// APPROACH sends the constant command. IMPACT follows the quintic (5.15) from the state
// at contact to rest at the angle at which the beam presses with the wanted force f,
//
//     theta_f = theta_imp + f l/(2 k2)                                             (5.23)
//
// by the inverse of the model along it and feedback of both errors, (5.24). FORCE holds
// theta_f with the static torque 2 f l in advance, (5.25). Printed coefficients have 6
// k2, 3 f l and M = 2 m eps^2 instead (errata B2).
//
// theta_imp is what the law is told, or in IMPACT the mean of what a sensor says of it,
// as 5.2 suggests: of film, theta3 - theta2, by (5.8) theta2 + theta3 = 2 theta_imp, or
// of an accelerometer by (5.13).
#include <math.h>
#include <string.h>

#include "src/rig/laws/law_parts.h"
#include "src/base/extremes.h"

enum { APPROACH, IMPACT, FORCE, RECOVER }; // modes; the last is recovering's alone

// Values of control.gains.
enum { GAINS_TORQUE, GAINS_VOLTS, GAINS_PRINTED };

// Values of control.impact_angle.
enum { ANGLE_TOLD, ANGLE_BY_FILM, ANGLE_BY_ACCELEROMETER };

// Parameters that these laws share, in this order; OWN is the law's own behind them.
enum {
    FORCE_WANTED,
    APPROACH_VOLTAGE,
    KP,
    KV,
    GAINS,
    COEFFICIENTS,
    TRANSITION,
    THRESHOLD,
    IMPACT_ANGLE,
    OWN,
    OWN_FORCE_LIMIT, // of the law speed-limit [N]
    PARAMETERS
};
#define HYBRID_PARAMETERS                                                                \
    {.name = "force"}, {.name = "approach_voltage"}, {.name = "kp"}, {.name = "kv"},     \
        {.name = "gains"}, {.name = "coefficients"}, {.name = "transition_time"},        \
        {.name = "contact_threshold"},                                                   \
    {                                                                                    \
        .name = "impact_angle"                                                           \
    }

typedef struct hybrid_memory {
    controller_setup rig;
    double p[PARAMETERS]; // the shared ones and the law's own
    set_point wanted;     // of which the force is the aim
    bool printed;         // coefficients
    double impact_angle;  // theta_imp, as told or as the sensors have shown [rad]
    int readings;         // that it is the mean of; 0: as told
    int mode;
    double since;       // start of the present mode [s]
    double a[6];        // quintic of the impact mode, (5.15)
    double begun;       // when the quintic begins [s]
    double length;      // and how long it is [s]
    bool replans;       // t_f has changed since the quintic was planned
    double planned;     // force at the quintic's end [N]
    double start_angle; // at the first sample [rad]
    bool started;       // the first sample is over
    bool reversed;      // bang-bang has braked until the hub rested
    int readings_without_contact;
} hybrid_memory;

// Takes setup and `count` parameters, at the start or later. If t_f changes in the impact
// mode, the trajectory is planned again, from where the arm is and for the time left.
static void hybrid_tell(hybrid_memory *m, const controller_setup *setup, size_t count)
{
    const double *p = setup->parameters;

    m->replans = m->mode == IMPACT && m->p[TRANSITION] != p[TRANSITION];
    set_point_tell(&m->wanted, SET_POINT_PACE, p[FORCE_WANTED], setup->period,
                   m->rig.period == 0);
    m->rig = setup_kept(setup);
    memcpy(m->p, p, count * sizeof p[0]);
    m->printed = p[COEFFICIENTS] != 0;
    if (m->readings == 0) {
        m->impact_angle = setup->wall_angle;
    }
}

// Stiffness of the hub in contact: 6 k2 in (5.13) as printed, 4 k2 once the spring is
// counted right (errata B2) [N m/rad].
static double contact_stiffness(const hybrid_memory *m)
{
    const double factor = m->printed ? 6 : 4;
    return factor * m->rig.k2;
}

// Torque of the beam's spring on the hub at an angle.
static double spring_torque(const hybrid_memory *m, double angle)
{
    return contact_stiffness(m) * (m->impact_angle - angle);
}

// Inertia of the arm in contact: 2 m eps^2 in (5.13) with eps = l/2; corrected, the
// bodies' own moments of inertia are there too (errata B2).
static double contact_inertia(const hybrid_memory *m)
{
    const controller_setup *r = &m->rig;
    if (m->printed) {
        return r->link_mass * r->link_length * r->link_length / 2;
    }
    return pressed_inertia(r);
}

// Hub angle at which the beam presses with a force, (5.23) [rad].
static double pressing_angle(const hybrid_memory *m, double force)
{
    return m->impact_angle + force * m->rig.link_length / (2 * m->rig.k2);
}

// Hub acceleration in contact under the command u, (5.13), (5.21) [rad/s2].
static double contact_acceleration(const hybrid_memory *m, double angle, double velocity,
                                   double u)
{
    const controller_setup *r = &m->rig;
    double torque = r->torque_per_volt * u - r->hub_damping * velocity -
                    coulomb_friction(r, velocity) + spring_torque(m, angle);
    return torque / contact_inertia(m);
}

// Tip force that (5.14) calculates from the hub's angle and acceleration [N].
static double hybrid_calculated_force(const hybrid_memory *m, const controller_input *in)
{
    const controller_setup *r = &m->rig;
    const double eps2 = r->link_length * r->link_length / 4;
    const double acceleration =
        contact_acceleration(m, in->encoder, in->tachometer, in->voltage);

    // corrected: link 3 turns back while its joint moves on, which gives m l^2/2 - (m
    // l^2/4 + I3)
    double coupling;
    if (m->printed) {
        coupling = r->link_mass * eps2;
    } else {
        coupling = 2 * r->link_mass * eps2 - (r->link_mass * eps2 + r->link_inertia);
    }
    return (2 * r->k2 * (in->encoder - r->wall_angle) - coupling * acceleration) /
           r->link_length;
}

// Volts of the feedback kp (angle error) + kv (velocity error), read as torque or as
// volts (B7).
static double feedback(const hybrid_memory *m, double angle_error, double velocity_error)
{
    const int gains = (int)m->p[GAINS];
    bool volts = gains == GAINS_VOLTS || (gains == GAINS_PRINTED && m->mode == FORCE);
    double sum = m->p[KP] * angle_error + m->p[KV] * velocity_error;
    if (volts) {
        return sum;
    }
    return sum / m->rig.torque_per_volt;
}

// Computes the last three coefficients of the quintic (5.15), with which it ends at rest
// at the final angle, by (5.18)-(5.20). The first three, which are set, give its angle,
// velocity and acceleration at the beginning.
static void set_quintic_end(hybrid_memory *m)
{
    const double T = m->length, distance = pressing_angle(m, m->planned) - m->a[0];
    const double velocity = m->a[1], acceleration = 2 * m->a[2];
    m->a[3] =
        (20 * distance - 12 * velocity * T - 3 * acceleration * T * T) / (2 * T * T * T);
    m->a[4] = (-30 * distance + 16 * velocity * T + 3 * acceleration * T * T) /
              (2 * T * T * T * T);
    m->a[5] = (12 * distance - 6 * velocity * T - acceleration * T * T) /
              (2 * T * T * T * T * T);
}

// Plans a quintic of a length [s] that begins with the present state and, so that the
// command has no jump, with the acceleration under the present command.
static void plan_quintic(hybrid_memory *m, const controller_input *in, double length)
{
    m->begun = in->time;
    m->length = length;
    m->planned = m->wanted.force;
    m->a[0] = in->encoder;
    m->a[1] = in->tachometer;
    m->a[2] = contact_acceleration(m, in->encoder, in->tachometer, in->voltage) / 2;
    set_quintic_end(m);
}

// The impact angle that a sample's readings show [rad], NaN where the sensor is not
// fitted: by (5.8) from the film, or by (5.13) from the accelerometer.
static double impact_angle_shown(const hybrid_memory *m, const controller_input *in)
{
    if ((int)m->p[IMPACT_ANGLE] == ANGLE_BY_FILM) {
        return in->encoder + in->film / 2;
    }

    // the measured acceleration differs from that of the model by the spring torque of
    // the impact angle's error
    double missing = in->accelerometer -
                     contact_acceleration(m, in->encoder, in->tachometer, in->voltage);
    return m->impact_angle + contact_inertia(m) * missing / contact_stiffness(m);
}

// Averages the impact angles that the first readings of the impact mode show, and moves
// the trajectory's end to the average. The first readings of the accelerometer are left
// out, since it is off scale at the impact and lags behind for a while. Later readings
// are left out because the film loses its charge.
static void average_impact_angle(hybrid_memory *m, const controller_input *in)
{
    const double lag = 0.01, window = 0.1; // [s]
    const int source = (int)m->p[IMPACT_ANGLE];
    const double time = in->time - m->since;
    const double from = source == ANGLE_BY_ACCELEROMETER ? lag : 0;
    if (source == ANGLE_TOLD || time < from || time > window) {
        return;
    }

    const double shown = impact_angle_shown(m, in);
    if (!isnan(shown)) {
        m->readings++;
        m->impact_angle += (shown - m->impact_angle) / m->readings;
        set_quintic_end(m);
    }
}

// Goes over to a mode; the impact mode begins with a plan of its trajectory.
static void hybrid_begin(hybrid_memory *m, int mode, const controller_input *in)
{
    m->mode = mode;
    m->since = in->time;
    if (mode == IMPACT) {
        m->readings = 0;
        plan_quintic(m, in, m->p[TRANSITION]);
    }
}

// Plans the trajectory again, for the time that is left of the transition, unless that is
// within a period.
static void replan(hybrid_memory *m, const controller_input *in)
{
    const double left = m->since + m->p[TRANSITION] - in->time;
    m->replans = false;
    if (left > m->rig.period) {
        plan_quintic(m, in, left);
    }
}

// Goes over to the mode in which the user holds the law. False if it is not held in one
// and chooses its modes itself.
static bool hybrid_held(hybrid_memory *m, const controller_input *in)
{
    if (in->wanted_mode >= 0 && in->wanted_mode != m->mode) {
        hybrid_begin(m, in->wanted_mode, in);
    }
    return in->wanted_mode >= 0;
}

// The command for a torque, with feedback of the errors of angle and velocity [V];
// reports the wanted angle and velocity.
static double tracking_command(const hybrid_memory *m, const controller_input *in,
                               controller_output *out, double angle, double velocity,
                               double torque)
{
    out->desired_angle = angle;
    out->desired_velocity = velocity;
    return torque / m->rig.torque_per_volt +
           feedback(m, angle - in->encoder, velocity - in->tachometer);
}

// The command of the impact mode: along the quintic, by the law (5.24) [V].
static double impact_command(const hybrid_memory *m, const controller_input *in,
                             controller_output *out)
{
    // held in this mode beyond t_f it stays at the trajectory's end
    const double *a = m->a, t = smaller(in->time - m->begun, m->length);
    double angle = a[0] + t * (a[1] + t * (a[2] + t * (a[3] + t * (a[4] + t * a[5]))));
    double velocity =
        a[1] + t * (2 * a[2] + t * (3 * a[3] + t * (4 * a[4] + t * 5 * a[5])));
    double acceleration = 2 * a[2] + t * (6 * a[3] + t * (12 * a[4] + t * 20 * a[5]));

    // a set-point that has moved since the plan moves the trajectory with it
    angle += pressing_angle(m, m->wanted.force) - pressing_angle(m, m->planned);
    velocity += set_point_turn(&m->wanted, &m->rig);
    acceleration += m->rig.link_length / (2 * m->rig.k2) * m->wanted.acceleration;

    // the model's torque along the plan, (5.24)
    double torque = m->rig.hub_damping * velocity + coulomb_friction(&m->rig, velocity) -
                    spring_torque(m, angle) + contact_inertia(m) * acceleration;
    return tracking_command(m, in, out, angle, velocity, torque);
}

// The command of the force mode: PD feedback about the final angle with the static torque
// in advance, (5.25) [V]. While the set-point moves, the angle moves with it and the
// model's torque for that motion is added.
static double hybrid_force_command(const hybrid_memory *m, const controller_input *in,
                                   controller_output *out)
{
    const double factor = m->printed ? 3 : 2;
    double torque = factor * m->wanted.force * m->rig.link_length;
    torque += set_point_torque(&m->wanted, &m->rig);
    return tracking_command(m, in, out, pressing_angle(m, m->wanted.force),
                            set_point_turn(&m->wanted, &m->rig), torque);
}

// Begins a sample: follows the set-point and chooses the mode. Approach and recovery end
// with contact, the impact mode after a time [s].
static void choose_mode(hybrid_memory *m, const controller_input *in, double impact_time)
{
    set_point_follow(&m->wanted, m->rig.period);
    if (hybrid_held(m, in)) {
        return;
    }
    const bool waits = m->mode == APPROACH || m->mode == RECOVER;
    if (waits && in->force > m->p[THRESHOLD]) {
        hybrid_begin(m, IMPACT, in);
    }
    if (m->mode == IMPACT && in->time - m->since >= impact_time) {
        hybrid_begin(m, FORCE, in);
    }
}

// Command that keeps the hub at a speed [rad/s], friction included, with a proportional
// correction [V].
static double hybrid_speed_command(const hybrid_memory *m, const controller_input *in,
                                   double speed)
{
    const double gain = 0.5; // [N m s/rad]
    double torque = m->rig.hub_damping * speed + coulomb_friction(&m->rig, speed) +
                    gain * (speed - in->tachometer);
    return torque / m->rig.torque_per_volt;
}

// --- before contact --------------------------------------------------------------------

// What a variant does before contact, or between contact and the force mode [V].
typedef double variant_command(hybrid_memory *m, const controller_input *in,
                               controller_output *out);

// The constant command.
static double approach_plainly(hybrid_memory *m, const controller_input *in,
                               controller_output *out)
{
    (void)in, (void)out;
    return m->p[APPROACH_VOLTAGE];
}

// The constant command, or after a loss a slow return to the pressing angle.
static double approach_again(hybrid_memory *m, const controller_input *in,
                             controller_output *out)
{
    const int lost = 2; // readings without contact in a row
    if (in->force > m->p[THRESHOLD]) {
        m->readings_without_contact = 0;
    } else {
        m->readings_without_contact++;
    }

    // a lost contact ends the impact mode and the force mode
    bool pressing = m->mode == IMPACT || m->mode == FORCE;
    if (!hybrid_held(m, in) && pressing && m->readings_without_contact >= lost) {
        hybrid_begin(m, RECOVER, in);
    }

    // the hub returns slowly towards the angle at which the beam would press
    if (m->mode == RECOVER) {
        const double left = pressing_angle(m, m->p[FORCE_WANTED]) - in->encoder;
        return hybrid_speed_command(m, in, fmin(0.3, 5 * left));
    }
    return approach_plainly(m, in, out);
}

// Command for each newton that the predicted force is off its limit [V/N]. The prediction
// has the command in it, by the torque at the hub over the arm's length: less than half a
// newton a volt.
#define VOLTS_PER_NEWTON 1
// Share of the limit to which the predicted force is held. The prediction assumes that
// the command in effect stays, but the impact mode follows its plan and presses up to a
// fifth harder.
#define SHARE 0.8
// Speed at which a resting hub is taken, for the sign of its friction [rad/s].
#define CREEP 1e-3

// The constant command, or less where a limit would be exceeded.
static double approach_within_limits(hybrid_memory *m, const controller_input *in,
                                     controller_output *out)
{
    double limited =
        fmin(approach_plainly(m, in, out), hybrid_speed_command(m, in, m->p[OWN]));
    if (m->p[OWN_FORCE_LIMIT] > 0 && isfinite(in->predicted_force)) {
        // keeps up the present speed, plus a command in proportion to the margin left
        const double left = SHARE * m->p[OWN_FORCE_LIMIT] - in->predicted_force;
        limited = fmin(limited, hybrid_speed_command(m, in, fmax(in->tachometer, CREEP)) +
                                    VOLTS_PER_NEWTON * left);
    }
    return limited;
}

// Full command one way, then the other, then the constant one.
static double approach_fast(hybrid_memory *m, const controller_input *in,
                            controller_output *out)
{
    // the way is measured from where the run begins
    if (!m->started) {
        m->started = true;
        m->start_angle = in->encoder;
    }
    double travelled = in->encoder - m->start_angle;
    double distance = m->rig.wall_angle - m->start_angle;
    const bool behind_switch = travelled >= m->p[OWN] * distance;
    m->reversed = m->reversed || (behind_switch && in->tachometer <= 0);
    if (m->reversed) {
        return approach_plainly(m, in, out);
    }
    if (behind_switch) {
        return -m->rig.voltage_limit;
    }
    return m->rig.voltage_limit;
}

// --- after it --------------------------------------------------------------------------

// Along the quintic.
static double follow_quintic(hybrid_memory *m, const controller_input *in,
                             controller_output *out)
{
    if (m->replans) {
        replan(m, in);
    }
    average_impact_angle(m, in);
    return impact_command(m, in, out);
}

// The largest command away from the wall.
static double pull_back(hybrid_memory *m, const controller_input *in,
                        controller_output *out)
{
    (void)in, (void)out;
    return -m->rig.voltage_limit;
}

// A sample: chooses the mode and gives its command. The impact mode lasts as long as
// parameter `length` says.
static void hybrid_act(hybrid_memory *m, const controller_input *in,
                       controller_output *out, variant_command *before,
                       variant_command *after, int length)
{
    const double approach = before(m, in, out);
    choose_mode(m, in, m->p[length]);
    out->mode = m->mode;
    if (m->mode == IMPACT) {
        out->command = after(m, in, out);
    } else if (m->mode == FORCE) {
        out->command = hybrid_force_command(m, in, out);
    } else {
        out->command = approach;
    }
    if (m->mode == APPROACH) {
        out->calculated_force = 0;
    } else {
        out->calculated_force = hybrid_calculated_force(m, in);
    }
}

// --- the variants ----------------------------------------------------------------------

static const char *const hybrid_modes[] = {"approach", "impact", "force", NULL};
static const char *const recovering_modes[] = {"approach", "impact", "force", "recover",
                                               NULL};

// Starts with the parameters that all share; with one of the law's own; with two.
static const char *start_shared(void *memory, const controller_setup *setup)
{
    hybrid_tell(memory, setup, OWN);
    return NULL;
}

static const char *start_with_own(void *memory, const controller_setup *setup)
{
    hybrid_tell(memory, setup, OWN + 1);
    return NULL;
}

static const char *start_with_two(void *memory, const controller_setup *setup)
{
    hybrid_tell(memory, setup, OWN + 2);
    return NULL;
}

#define HYBRID_LAW(word, names, table, begin, act)                                       \
    CONTROLLER_LAW(word, names, table, hybrid_memory, .lockable = true, .start = begin,  \
                   .sample = act, .tune = begin)

// Each does something before contact, something after it, for as long as one of its
// parameters says.

// --- hybrid ---

// The thesis's hybrid impact and force controller, 5.2 to 5.4: approach, impact mode,
// force mode.
static const controller_parameter hybrid_parameters[] = {HYBRID_PARAMETERS};

static void sample_hybrid(void *memory, const controller_input *in,
                          controller_output *out)
{
    hybrid_act(memory, in, out, approach_plainly, follow_quintic, TRANSITION);
}
const controller hybrid_law =
    HYBRID_LAW("hybrid", hybrid_modes, hybrid_parameters, start_shared, sample_hybrid);

// --- recovering ---

// The controller that 5.4 calls ideal: hybrid, but going back to position control where
// contact is lost, and through the impact mode again when it returns.
static void sample_recovering(void *memory, const controller_input *in,
                              controller_output *out)
{
    hybrid_act(memory, in, out, approach_again, follow_quintic, TRANSITION);
}
const controller recovering_law =
    HYBRID_LAW("recovering", recovering_modes, hybrid_parameters, start_shared,
               sample_recovering);

// --- reverse-torque ---

// The hybrid controller until contact; then the largest command away from the wall for
// control.reverse_time; then the hybrid controller's force mode.
static const controller_parameter reverse_torque_parameters[] = {HYBRID_PARAMETERS,
                                                                 {.name =
                                                                      "reverse_time"}};

static void sample_reverse_torque(void *memory, const controller_input *in,
                                  controller_output *out)
{
    hybrid_act(memory, in, out, approach_plainly, pull_back, OWN);
}
const controller reverse_torque_law =
    HYBRID_LAW("reverse-torque", hybrid_modes, reverse_torque_parameters, start_with_own,
               sample_reverse_torque);

// --- speed-limit ---

// The hybrid controller with the hub kept below control.speed_limit on the way to the
// wall and, where there is a control.force_limit, to speeds at which the impact that the
// rig predicts for a touch at this instant (predicted_force, (4.20)-(4.22)) keeps to it.
static const controller_parameter speed_limit_parameters[] = {HYBRID_PARAMETERS,
                                                              {.name = "speed_limit"},
                                                              {.name = "force_limit"}};

static void sample_speed_limit(void *memory, const controller_input *in,
                               controller_output *out)
{
    hybrid_act(memory, in, out, approach_within_limits, follow_quintic, TRANSITION);
}
const controller speed_limit_law =
    HYBRID_LAW("speed-limit", hybrid_modes, speed_limit_parameters, start_with_two,
               sample_speed_limit);

// --- bang-bang ---

// Full command to control.switch_share of the way, full command back until the hub rests,
// then the plain approach and the hybrid controller.
static const controller_parameter bang_bang_parameters[] = {HYBRID_PARAMETERS,
                                                            {.name = "switch_share"}};

static void sample_bang_bang(void *memory, const controller_input *in,
                             controller_output *out)
{
    hybrid_act(memory, in, out, approach_fast, follow_quintic, TRANSITION);
}
const controller bang_bang_law =
    HYBRID_LAW("bang-bang", hybrid_modes, bang_bang_parameters, start_with_own,
               sample_bang_bang);
