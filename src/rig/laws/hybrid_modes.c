#include "src/rig/laws/hybrid_modes.h"

#include <assert.h>
#include <math.h>

#include "src/base/extremes.h"

const char *const hybrid_modes[] = {"approach", "impact", "force", NULL};

const char *hybrid_start(void *memory, const controller_setup *setup)
{
    assert(memory != NULL && setup != NULL && setup->parameters != NULL);
    hybrid_memory *m = memory;
    const double *p = setup->parameters;

    // a trajectory under way is planned anew if it leads elsewhere now
    m->replans =
        m->mode == IMPACT && (m->force != p[FORCE_WANTED] || m->transition != p[TRANSITION]);

    m->rig = *setup;
    m->force = p[FORCE_WANTED];
    m->approach_voltage = p[APPROACH_VOLTAGE];
    m->kp = p[KP];
    m->kv = p[KV];
    m->gains = (int)p[GAINS];
    m->printed = p[COEFFICIENTS] != 0;
    m->transition = p[TRANSITION];
    m->threshold = p[THRESHOLD];
    m->source = (int)p[IMPACT_ANGLE];
    if (m->readings == 0) {
        m->impact_angle = setup->wall_angle;
    }
    return NULL;
}

const char *hybrid_start_with_own(void *memory, const controller_setup *setup)
{
    hybrid_memory *m = memory;
    m->own = setup->parameters[OWN];
    return hybrid_start(memory, setup);
}

static double sign(double x)
{
    return (x > 0) - (x < 0);
}

// Stiffness of the hub in contact: 6 k2 in (5.13) as printed, 4 k2 once the spring is counted right
// (errata B2) [N m/rad].
static double contact_stiffness(const hybrid_memory *m)
{
    return (m->printed ? 6 : 4) * m->rig.k2;
}

// Torque of the beam's spring on the hub at an angle.
static double spring_torque(const hybrid_memory *m, double angle)
{
    return contact_stiffness(m) * (m->impact_angle - angle);
}

// Inertia of the arm in contact: 2 m eps^2 in (5.13) with eps = l/2; corrected, the bodies' own
// moments of inertia are there too (errata B2).
static double contact_inertia(const hybrid_memory *m)
{
    const controller_setup *r = &m->rig;
    double own = m->printed ? 0 : r->hub_inertia + 2 * r->link_inertia;
    return 2 * r->link_mass * r->link_length * r->link_length / 4 + own;
}

double hybrid_final_angle(const hybrid_memory *m)
{
    return m->impact_angle + m->force * m->rig.link_length / (2 * m->rig.k2);
}

// Hub acceleration in contact under the command u, (5.13), (5.21) [rad/s2].
static double contact_acceleration(const hybrid_memory *m, double angle, double velocity, double u)
{
    const controller_setup *r = &m->rig;
    double torque = r->torque_per_volt * u - r->hub_damping * velocity -
                    r->stiction * sign(velocity) + spring_torque(m, angle);
    return torque / contact_inertia(m);
}

double hybrid_calculated_force(const hybrid_memory *m, const controller_input *in)
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

// The coefficients of the quintic (5.15) that lead it to rest at the final angle from what the
// first three say of its start: the solution of (5.18)-(5.20).
static void lead_to_end(hybrid_memory *m)
{
    const double T = m->length, way = hybrid_final_angle(m) - m->a[0];
    const double velocity = m->a[1], acceleration = 2 * m->a[2];
    m->a[3] = (20 * way - 12 * velocity * T - 3 * acceleration * T * T) / (2 * T * T * T);
    m->a[4] = (-30 * way + 16 * velocity * T + 3 * acceleration * T * T) / (2 * T * T * T * T);
    m->a[5] = (12 * way - 6 * velocity * T - acceleration * T * T) / (2 * T * T * T * T * T);
}

// Plans from the state at contact.
static void plan(hybrid_memory *m, double angle, double velocity, double acceleration)
{
    m->a[0] = angle;
    m->a[1] = velocity;
    m->a[2] = acceleration / 2;
    lead_to_end(m);
}

// The impact angle that a sample's readings show, NaN where the sensor is not fitted [rad].
static double angle_shown(const hybrid_memory *m, const controller_input *in)
{
    if (m->source == ANGLE_BY_FILM) {
        return in->encoder + in->film / 2;
    }

    // what of the measured acceleration the motor and friction do not account for is the beam's
    double missing =
        in->accelerometer - contact_acceleration(m, in->encoder, in->tachometer, in->voltage);
    return m->impact_angle + contact_inertia(m) * missing / contact_stiffness(m);
}

// Averages what the first readings of the impact mode show; the trajectory's end goes with it. The
// accelerometer is off scale at the impact and lags behind it for a while, the film loses its
// charge.
static void follow_angle(hybrid_memory *m, const controller_input *in)
{
    const double lag = 0.01, window = 0.1; // [s]
    double time = in->time - m->since, from = m->source == ANGLE_BY_ACCELEROMETER ? lag : 0;
    bool tells = m->source != ANGLE_TOLD && time >= from && time <= window;
    double shown = tells ? angle_shown(m, in) : (double)NAN;
    if (!isnan(shown)) {
        m->readings++;
        m->impact_angle += (shown - m->impact_angle) / m->readings;
        lead_to_end(m);
    }
}

void hybrid_begin(hybrid_memory *m, int mode, const controller_input *in)
{
    m->mode = mode;
    m->since = m->begun = in->time;
    m->length = m->transition;
    if (mode == IMPACT) {
        m->readings = 0;
        plan(m, in->encoder, in->tachometer,
             contact_acceleration(m, in->encoder, in->tachometer, in->voltage));
    }
}

// Plans anew for what is left of the transition, if that is more than a sample.
static void plan_again(hybrid_memory *m, const controller_input *in)
{
    const double left = m->since + m->transition - in->time;
    m->replans = false;
    if (left > m->rig.period) {
        m->begun = in->time;
        m->length = left;
        plan(m, in->encoder, in->tachometer,
             contact_acceleration(m, in->encoder, in->tachometer, in->voltage));
    }
}

bool hybrid_held(hybrid_memory *m, const controller_input *in)
{
    if (in->wanted_mode >= 0 && in->wanted_mode != m->mode) {
        hybrid_begin(m, in->wanted_mode, in);
    }
    return in->wanted_mode >= 0;
}

// Impact mode: the quintic and the law (5.24).
static double impact_command(const hybrid_memory *m, const controller_input *in,
                             controller_output *out)
{
    // held in this mode beyond t_f it stays at the trajectory's end
    const double *a = m->a, t = smaller(in->time - m->begun, m->length);
    double angle = a[0] + t * (a[1] + t * (a[2] + t * (a[3] + t * (a[4] + t * a[5]))));
    double velocity = a[1] + t * (2 * a[2] + t * (3 * a[3] + t * (4 * a[4] + t * 5 * a[5])));
    double acceleration = 2 * a[2] + t * (6 * a[3] + t * (12 * a[4] + t * 20 * a[5]));

    // the model's torque along the plan, (5.24)
    double torque = m->rig.hub_damping * velocity + m->rig.stiction * sign(velocity) -
                    spring_torque(m, angle) + contact_inertia(m) * acceleration;
    out->desired_angle = angle;
    out->desired_velocity = velocity;
    return torque / m->rig.torque_per_volt +
           feedback(m, angle - in->encoder, velocity - in->tachometer);
}

double hybrid_force_command(const hybrid_memory *m, const controller_input *in,
                            controller_output *out)
{
    double torque = (m->printed ? 3 : 2) * m->force * m->rig.link_length;
    out->desired_angle = hybrid_final_angle(m);
    out->desired_velocity = 0;
    return torque / m->rig.torque_per_volt +
           feedback(m, hybrid_final_angle(m) - in->encoder, -in->tachometer);
}

double hybrid_command(hybrid_memory *m, const controller_input *in, controller_output *out,
                      double approach)
{
    // approach ends with contact, the impact mode with t_f
    bool chooses = !hybrid_held(m, in);
    if (chooses && (m->mode == APPROACH || m->mode == RECOVER) && in->force > m->threshold) {
        hybrid_begin(m, IMPACT, in);
    }
    if (chooses && m->mode == IMPACT && in->time - m->since >= m->transition) {
        hybrid_begin(m, FORCE, in);
    }

    if (m->replans && m->mode == IMPACT) {
        plan_again(m, in);
    }
    if (m->mode == IMPACT) {
        follow_angle(m, in);
    }

    out->mode = m->mode;
    out->calculated_force = m->mode == APPROACH ? 0 : hybrid_calculated_force(m, in);
    return m->mode == IMPACT  ? impact_command(m, in, out)
           : m->mode == FORCE ? hybrid_force_command(m, in, out)
                              : approach;
}

double hybrid_speed_command(const hybrid_memory *m, const controller_input *in, double speed)
{
    const double gain = 0.5; // [N m s/rad]
    double torque = m->rig.hub_damping * speed + m->rig.stiction * sign(speed) +
                    gain * (speed - in->tachometer);
    return torque / m->rig.torque_per_volt;
}
