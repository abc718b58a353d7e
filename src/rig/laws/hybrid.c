// The thesis's hybrid impact and force controller, 5.2 to 5.4, and the laws that share its modes:
// another approach (speed-limit, bang-bang), another answer to the impact (reverse-torque), and the
// controller that 5.4 calls ideal (recovering).
#include <math.h>

#include "src/rig/laws/laws.h"

enum { APPROACH, IMPACT, FORCE, RECOVER };
enum { GAINS_TORQUE, GAINS_VOLTS, GAINS_PRINTED };

static const char *const mode_names[] = {"approach", "impact", "force", NULL};
static const char *const recovering_names[] = {"approach", "impact", "force", "recover", NULL};

// Parameters that all these laws share, in this order, then one of the law's own.
enum { FORCE_WANTED, APPROACH_VOLTAGE, KP, KV, GAINS, COEFFICIENTS, TRANSITION, THRESHOLD, OWN };
#define SHARED_PARAMETERS                                                                          \
    {.name = "force"}, {.name = "approach_voltage"}, {.name = "kp"}, {.name = "kv"},               \
        {.name = "gains"}, {.name = "coefficients"}, {.name = "transition_time"},                  \
    {                                                                                              \
        .name = "contact_threshold"                                                                \
    }

typedef struct hybrid_memory {
    controller_setup rig;
    double force, approach_voltage, kp, kv, transition, threshold, own;
    int gains;
    bool printed; // coefficients
    int mode;
    double since;       // start of the present mode [s]
    double a[6];        // quintic of the impact mode, (5.15)
    double start_angle; // at the first sample [rad]
    bool started, reversed;
    int readings_without_contact;
} hybrid_memory;

static const char *start(void *memory, const controller_setup *setup)
{
    hybrid_memory *m = memory;
    const double *p = setup->parameters;
    m->rig = *setup;
    m->force = p[FORCE_WANTED];
    m->approach_voltage = p[APPROACH_VOLTAGE];
    m->kp = p[KP];
    m->kv = p[KV];
    m->gains = (int)p[GAINS];
    m->printed = p[COEFFICIENTS] != 0;
    m->transition = p[TRANSITION];
    m->threshold = p[THRESHOLD];
    return NULL;
}

// The same for laws with a parameter of their own behind the shared ones.
static const char *start_with_own(void *memory, const controller_setup *setup)
{
    hybrid_memory *m = memory;
    m->own = setup->parameters[OWN];
    return start(memory, setup);
}

static double sign(double x)
{
    return x > 0 ? 1 : x < 0 ? -1 : 0;
}

// Torque of the beam's spring on the hub at an angle: 6 k2 (theta_imp - theta) in (5.13) as
// printed, 4 k2 once the spring is counted right (errata B2).
static double spring_torque(const hybrid_memory *m, double angle)
{
    return (m->printed ? 6 : 4) * m->rig.k2 * (m->rig.wall_angle - angle);
}

// Inertia of the arm in contact: 2 m eps^2 in (5.13) with eps = l/2; corrected, the bodies' own
// moments of inertia are there too (errata B2).
static double contact_inertia(const hybrid_memory *m)
{
    const controller_setup *r = &m->rig;
    double own = m->printed ? 0 : r->hub_inertia + 2 * r->link_inertia;
    return 2 * r->link_mass * r->link_length * r->link_length / 4 + own;
}

// Hub angle at which the beam presses with the wanted force, (5.23).
static double final_angle(const hybrid_memory *m)
{
    return m->rig.wall_angle + m->force * m->rig.link_length / (2 * m->rig.k2);
}

// Hub acceleration in contact under the command u, (5.13), (5.21) [rad/s2].
static double contact_acceleration(const hybrid_memory *m, double angle, double velocity, double u)
{
    const controller_setup *r = &m->rig;
    double torque = r->torque_per_volt * u - r->hub_damping * velocity -
                    r->stiction * sign(velocity) + spring_torque(m, angle);
    return torque / contact_inertia(m);
}

// Tip force that (5.14) calculates from the hub's angle and acceleration.
static double calculated_force(const hybrid_memory *m, const controller_input *in)
{
    const controller_setup *r = &m->rig;
    double eps2 = r->link_length * r->link_length / 4;
    double mass_term = r->link_mass * eps2 + (m->printed ? 0 : r->link_inertia);
    // corrected: link 3 turns back about a joint that moves on: (m l^2/2 - m l^2/4 - I3)
    double coupling = m->printed ? mass_term : 2 * r->link_mass * eps2 - mass_term;
    double acceleration = contact_acceleration(m, in->encoder, in->tachometer, in->voltage);
    return (2 * r->k2 * (in->encoder - r->wall_angle) - coupling * acceleration) / r->link_length;
}

// Volts of the feedback kp (angle error) + kv (velocity error), read as torque or as volts (B7).
static double feedback(const hybrid_memory *m, double angle_error, double velocity_error)
{
    bool volts = m->gains == GAINS_VOLTS || (m->gains == GAINS_PRINTED && m->mode == FORCE);
    double sum = m->kp * angle_error + m->kv * velocity_error;
    return volts ? sum : sum / m->rig.torque_per_volt;
}

// Coefficients of the quintic (5.15) from the state at contact to rest at the final angle: the
// solution of (5.18)-(5.20).
static void plan(hybrid_memory *m, double angle, double velocity, double acceleration)
{
    double T = m->transition, way = final_angle(m) - angle;
    m->a[0] = angle;
    m->a[1] = velocity;
    m->a[2] = acceleration / 2;
    m->a[3] = (20 * way - 12 * velocity * T - 3 * acceleration * T * T) / (2 * T * T * T);
    m->a[4] = (-30 * way + 16 * velocity * T + 3 * acceleration * T * T) / (2 * T * T * T * T);
    m->a[5] = (12 * way - 6 * velocity * T - acceleration * T * T) / (2 * T * T * T * T * T);
}

// Goes into a mode. Entering the impact mode plans the trajectory from the present state and
// command on, so that the command goes on from where it is.
static void begin(hybrid_memory *m, int mode, const controller_input *in)
{
    m->mode = mode;
    m->since = in->time;
    if (mode == IMPACT) {
        plan(m, in->encoder, in->tachometer,
             contact_acceleration(m, in->encoder, in->tachometer, in->voltage));
    }
}

// Goes into the mode the law is held in. False if it is not: then it chooses itself, beginning with
// the mode that it is in.
static bool held(hybrid_memory *m, const controller_input *in)
{
    if (in->wanted_mode >= 0 && in->wanted_mode != m->mode) {
        begin(m, in->wanted_mode, in);
    }
    return in->wanted_mode >= 0;
}

// Impact mode: the quintic and the law (5.24).
static double impact_command(const hybrid_memory *m, const controller_input *in,
                             controller_output *out)
{
    // held in this mode beyond t_f it stays at the trajectory's end
    const double *a = m->a, t = fmin(in->time - m->since, m->transition);
    double angle = a[0] + t * (a[1] + t * (a[2] + t * (a[3] + t * (a[4] + t * a[5]))));
    double velocity = a[1] + t * (2 * a[2] + t * (3 * a[3] + t * (4 * a[4] + t * 5 * a[5])));
    double acceleration = 2 * a[2] + t * (6 * a[3] + t * (12 * a[4] + t * 20 * a[5]));
    double torque = m->rig.hub_damping * velocity + m->rig.stiction * sign(velocity) -
                    spring_torque(m, angle) + contact_inertia(m) * acceleration;
    out->desired_angle = angle;
    out->desired_velocity = velocity;
    return torque / m->rig.torque_per_volt +
           feedback(m, angle - in->encoder, velocity - in->tachometer);
}

// Force mode: PD round the final angle with the static torque in advance, (5.25).
static double force_command(const hybrid_memory *m, const controller_input *in,
                            controller_output *out)
{
    double torque = (m->printed ? 3 : 2) * m->force * m->rig.link_length;
    out->desired_angle = final_angle(m);
    out->desired_velocity = 0;
    return torque / m->rig.torque_per_volt +
           feedback(m, final_angle(m) - in->encoder, -in->tachometer);
}

// The three modes with their switching: contact, then t_f.
static double hybrid_command(hybrid_memory *m, const controller_input *in, controller_output *out,
                             double approach)
{
    bool chooses = !held(m, in);
    if (chooses && (m->mode == APPROACH || m->mode == RECOVER) && in->force > m->threshold) {
        begin(m, IMPACT, in);
    }
    if (chooses && m->mode == IMPACT && in->time - m->since >= m->transition) {
        begin(m, FORCE, in);
    }
    out->mode = m->mode;
    out->calculated_force = m->mode == APPROACH ? 0 : calculated_force(m, in);
    return m->mode == IMPACT  ? impact_command(m, in, out)
           : m->mode == FORCE ? force_command(m, in, out)
                              : approach;
}

static void sample_hybrid(void *memory, const controller_input *in, controller_output *out)
{
    hybrid_memory *m = memory;
    out->command = hybrid_command(m, in, out, m->approach_voltage);
}

// Torque that keeps the hub at a speed, friction included, with a proportional correction [V].
static double speed_command(const hybrid_memory *m, const controller_input *in, double speed)
{
    const double gain = 0.5; // [N m s/rad]
    double torque = m->rig.hub_damping * speed + m->rig.stiction * sign(speed) +
                    gain * (speed - in->tachometer);
    return torque / m->rig.torque_per_volt;
}

static void sample_speed_limit(void *memory, const controller_input *in, controller_output *out)
{
    hybrid_memory *m = memory;
    double limited = fmin(m->approach_voltage, speed_command(m, in, m->own));
    out->command = hybrid_command(m, in, out, limited);
}

// Full command to a share of the way, full command back until the hub rests, then the plain
// approach.
static void sample_bang_bang(void *memory, const controller_input *in, controller_output *out)
{
    hybrid_memory *m = memory;
    double limit = m->rig.voltage_limit, approach = limit;
    if (!m->started) {
        m->started = true;
        m->start_angle = in->encoder;
    }
    double gone = in->encoder - m->start_angle, way = m->rig.wall_angle - m->start_angle;
    if (gone >= m->own * way) {
        m->reversed = m->reversed || in->tachometer <= 0;
        approach = m->reversed ? m->approach_voltage : -limit;
    }
    out->command = hybrid_command(m, in, out, m->reversed ? m->approach_voltage : approach);
}

// Until contact as the others; then the largest command back for a while; then the force mode.
static void sample_reverse_torque(void *memory, const controller_input *in, controller_output *out)
{
    hybrid_memory *m = memory;
    bool chooses = !held(m, in);
    if (chooses && m->mode == APPROACH && in->force > m->threshold) {
        begin(m, IMPACT, in);
    }
    if (chooses && m->mode == IMPACT && in->time - m->since >= m->own) {
        begin(m, FORCE, in);
    }
    out->mode = m->mode;
    out->calculated_force = m->mode == APPROACH ? 0 : calculated_force(m, in);
    out->command = m->mode == APPROACH ? m->approach_voltage
                   : m->mode == IMPACT ? -m->rig.voltage_limit
                                       : force_command(m, in, out);
}

// Goes back to position control where contact is lost, and through the impact mode again when it
// returns.
static void sample_recovering(void *memory, const controller_input *in, controller_output *out)
{
    hybrid_memory *m = memory;
    const int lost = 2; // readings without contact in a row
    m->readings_without_contact = in->force > m->threshold ? 0 : m->readings_without_contact + 1;
    bool pressing = m->mode == IMPACT || m->mode == FORCE;
    if (!held(m, in) && pressing && m->readings_without_contact >= lost) {
        begin(m, RECOVER, in);
    }
    // a slow move towards the angle at which the beam would press
    double speed = fmin(0.3, 5 * (final_angle(m) - in->encoder));
    double approach = m->mode == RECOVER ? speed_command(m, in, speed) : m->approach_voltage;
    out->command = hybrid_command(m, in, out, approach);
}

static const controller_parameter shared[] = {SHARED_PARAMETERS};
static const controller_parameter with_speed[] = {SHARED_PARAMETERS, {.name = "speed_limit"}};
static const controller_parameter with_share[] = {SHARED_PARAMETERS, {.name = "switch_share"}};
static const controller_parameter with_time[] = {SHARED_PARAMETERS, {.name = "reverse_time"}};

#define LAW(law, names, table, starts, samples)                                                    \
    {                                                                                              \
        .interface = CONTROLLER_INTERFACE, .name = law, .modes = names, .lockable = true,          \
        .parameters = table, .parameter_count = (int)(sizeof table / sizeof table[0]),             \
        .memory_size = sizeof(hybrid_memory), .start = starts, .sample = samples                   \
    }

const controller hybrid_law = LAW("hybrid", mode_names, shared, start, sample_hybrid);
const controller recovering_law =
    LAW("recovering", recovering_names, shared, start, sample_recovering);
const controller speed_limit_law =
    LAW("speed-limit", mode_names, with_speed, start_with_own, sample_speed_limit);
const controller bang_bang_law =
    LAW("bang-bang", mode_names, with_share, start_with_own, sample_bang_bang);
const controller reverse_torque_law =
    LAW("reverse-torque", mode_names, with_time, start_with_own, sample_reverse_torque);
