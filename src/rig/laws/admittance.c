// Admittance control: the force's error moves a mass against a damper, and the hub
// follows that mass under position control.
//
//     m_a v' + d_a v = f - reading,    theta_a' = v,
//     T = kp (theta_a - theta) + kv (v - w) + D v + friction + 2 l reading
//
// In flight the reading is zero and the mass approaches the speed f/d_a; in contact it
// comes to rest where the reading is f, whatever the wall's place and the stiffness are.
// One law for both, without a switch. The last term balances the force with which the
// beam presses, so that the position control acts on its error only.
#include <string.h>

#include "src/rig/laws/law_parts.h"
#include "src/base/plain_math.h"

#define READING_LAG 3 // periods by which a reading lags behind the force

enum { APPROACH, CONTACT };
static const char *const mode_names[] = {"approach", "contact", NULL};

enum { FORCE_WANTED, KP, KV, THRESHOLD, DAMPING, MASS_TIME, PARAMETERS };
static const controller_parameter table[PARAMETERS] = {
    [FORCE_WANTED] = {.name = "force"},
    [KP] = {.name = "kp"},
    [KV] = {.name = "kv"},
    [THRESHOLD] = {.name = "contact_threshold"},
    [DAMPING] = {"damping", "N s/rad", 3, 0.01, 1000,
                 "force's error over the speed that it moves the hub with"},
    [MASS_TIME] = {"mass_time", "s", 0.02, 0, 10, "in which the hub takes up that speed"},
};

typedef struct admittance_memory {
    controller_setup rig;
    double p[PARAMETERS];
    set_point wanted;
    double angle; // theta_a [rad]
    double speed; // v [rad/s]
    bool started;
    int mode;
} admittance_memory;

static const char *admittance_tune(void *memory, const controller_setup *setup)
{
    admittance_memory *m = memory;
    set_point_tell(&m->wanted, SET_POINT_PACE, setup->parameters[FORCE_WANTED],
                   setup->period, m->rig.period == 0);
    m->rig = setup_kept(setup);
    memcpy(m->p, setup->parameters, sizeof m->p);
    return NULL;
}

static void admittance_sample(void *memory, const controller_input *in,
                              controller_output *out)
{
    admittance_memory *m = memory;
    const controller_setup *r = &m->rig;
    if (!m->started) {
        m->started = true;
        m->angle = in->encoder;
    }
    if (in->force > m->p[THRESHOLD]) {
        m->mode = CONTACT;
    } else {
        m->mode = APPROACH;
    }

    // the speed at which the damper balances the force error; a moving set-point is
    // compared where it was when the force was read
    set_point_follow(&m->wanted, r->period);
    const double rise = (READING_LAG * r->period + r->delay) * m->wanted.rate;
    const double wanted = (m->wanted.force - rise - in->force) / m->p[DAMPING];

    // the mass approaches that speed, v' = (wanted - v)/mass_time, solved over a period
    const double decay =
        m->p[MASS_TIME] > 0 ? plain_exp(-r->period / m->p[MASS_TIME]) : 0;
    m->speed = wanted + decay * (m->speed - wanted);

    // in contact a set-point that moves takes the hub with it
    double speed = m->speed, following = 0;
    if (m->mode == CONTACT) {
        speed = m->speed + set_point_turn(&m->wanted, r);
        following = set_point_torque(&m->wanted, r);
    }
    m->angle += speed * r->period;

    // position control of the hub, and the torques that damping, friction and the pressed
    // beam take
    double torque =
        m->p[KP] * (m->angle - in->encoder) + m->p[KV] * (speed - in->tachometer);
    torque += following;
    out->command = (torque + r->hub_damping * m->speed + coulomb_friction(r, m->speed) +
                    2 * r->link_length * in->force) /
                   r->torque_per_volt;
    out->mode = m->mode;
    out->desired_angle = m->angle;
    out->desired_velocity = speed;
}

const controller admittance_law =
    CONTROLLER_LAW("admittance", mode_names, table, admittance_memory,
                   .start = admittance_tune, .sample = admittance_sample,
                   .tune = admittance_tune);
