// Impedance control (Hogan, Impedance control, ASME Journal of Dynamic Systems,
// Measurement and Control 107, 1985): the hub behaves as if a spring and a damper tied it
// to a point that moves into the wall.
//
//     T = k (theta_v - theta) + d (theta_v' - w) + friction of the point's motion
//
// The point goes with the speed that the approach's voltage holds from where the arm
// starts to
//
//     theta_e = theta_f + 2 f l/k
//     theta_f = theta_imp + f l/(2 k2)                                             (5.23)
//
// where spring and beam balance with the wanted force f. It uses no force reading: k sets
// how much a wrong wall or stiffness changes f, namely by k/(k + 4 k2) of the error under
// a hard position control. The damper makes the arm in contact critical,
//
//     d = 2 sqrt(M (k + 4 k2)) - D,      M = I1 + 2 I + m l^2/2
#include <math.h>
#include <string.h>

#include "src/rig/laws/law_parts.h"

enum { APPROACH, CONTACT };
static const char *const mode_names[] = {"approach", "contact", NULL};

enum { FORCE_WANTED, APPROACH_VOLTAGE, THRESHOLD, STIFFNESS, PARAMETERS };
static const controller_parameter table[PARAMETERS] = {
    [FORCE_WANTED] = {.name = "force"},
    [APPROACH_VOLTAGE] = {.name = "approach_voltage"},
    [THRESHOLD] = {.name = "contact_threshold"},
    [STIFFNESS] = {"stiffness", "N m/rad", 10, 0.1, 1000,
                   "of the spring between the hub and the point that leads it"},
};

typedef struct impedance_memory {
    controller_setup rig;
    double p[PARAMETERS];
    double speed;   // of the point [rad/s]
    double damping; // d [N m s/rad]
    double point;   // theta_v [rad]
    set_point wanted;
    bool started, arrived; // the point, where it belongs
    int mode;
} impedance_memory;

static const char *impedance_tune(void *memory, const controller_setup *setup)
{
    impedance_memory *m = memory;
    set_point_tell(&m->wanted, SET_POINT_PACE, setup->parameters[FORCE_WANTED],
                   setup->period, m->rig.period == 0);
    m->rig = setup_kept(setup);
    memcpy(m->p, setup->parameters, sizeof m->p);

    // the approach's speed, and the damper
    double held = setup->torque_per_volt * fabs(m->p[APPROACH_VOLTAGE]) - setup->stiction;
    m->speed =
        copysign(fmax(0, held) / fmax(setup->hub_damping, 1e-9), m->p[APPROACH_VOLTAGE]);
    m->damping = 2 * sqrt(pressed_inertia(setup) * (m->p[STIFFNESS] + 4 * setup->k2)) -
                 setup->hub_damping;
    return NULL;
}

static void impedance_sample(void *memory, const controller_input *in,
                             controller_output *out)
{
    impedance_memory *m = memory;
    const controller_setup *r = &m->rig;
    if (!m->started) {
        m->started = true;
        m->point = in->encoder;
    }
    if (in->force > m->p[THRESHOLD]) {
        m->mode = CONTACT;
    }

    // where the point belongs: theta_e = theta_imp + 2 f l (1/(4 k2) + 1/k)
    set_point_follow(&m->wanted, r->period);
    const double k = m->p[STIFFNESS], torque = 2 * m->wanted.force * r->link_length;
    const double end = r->wall_angle + torque / (4 * r->k2) + torque / k;

    // it moves on until it is there, and then goes with that
    const double step = m->speed * r->period, left = end - m->point;
    const bool moves = !m->arrived && step * left > 0 && fabs(step) < fabs(left);
    double rate, drag, friction;
    if (moves) {
        m->point = m->point + step;
        rate = m->speed;
        drag = r->hub_damping * rate;
        friction = coulomb_friction(r, rate);
    } else {
        m->arrived = true;
        m->point = end;
        rate = set_point_turn(&m->wanted, r);
        drag = set_point_torque(&m->wanted, r);
        friction = 0;
    }

    // spring and damper, and what the point's own motion takes
    out->command = (k * (m->point - in->encoder) + m->damping * (rate - in->tachometer) +
                    drag + friction) /
                   r->torque_per_volt;
    out->mode = m->mode;
    out->desired_angle = m->point;
    out->desired_velocity = rate;
}

const controller impedance_law =
    CONTROLLER_LAW("impedance", mode_names, table, impedance_memory,
                   .start = impedance_tune, .sample = impedance_sample,
                   .tune = impedance_tune);
