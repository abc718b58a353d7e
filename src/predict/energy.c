// The peak force by the principle of energy: all that the arm has at the touch becomes
// strain of its springs, section 4.3 of the thesis.
#include "src/predict/predict.h"

#include <assert.h>
#include <math.h>

#include "src/arm/arm.h"
#include "src/predict/two_link.h"
#include "src/base/sincos.h"
#include "src/base/plain_math.h"

void quasi_principle_deflections(int n, const double *k, double energy,
                                 double *deflection)
{
    assert(n > 0);
    double compliance = 0;
    for (int i = 0; i < n; i++) {
        compliance += 1 / k[i];
    }

    // soft springs get the larger share
    for (int i = 0; i < n; i++) {
        double share = energy / k[i] / compliance;
        deflection[i] = sqrt(2 * share / k[i]);
    }
}

// Energy before contact as the listing sums it up: I2 and I3 left out, the hub spring's
// strain left out, and with `energy_cross_term` e w2 w3 cos d for 2 l e w2 w3 cos d
// (equal in number at l = 0.5).
static double listed_energy(const parameters *p, const three_body_state *s)
{
    double l = p->arm.length / 2, e = l / 2, m = p->arm.mass / 2;
    const double *q = s->angle, *w = s->velocity;
    double bend = q[2] - q[1];
    double cross = p->printed.energy_cross_term ? e : 2 * l * e;
    double hub = p->arm.hub_inertia * w[0] * w[0];
    double first = m * e * e * w[1] * w[1];
    double last = m * (l * l * w[1] * w[1] + e * e * w[2] * w[2] +
                       cross * w[1] * w[2] * inline_cos(bend));
    return (hub + first + last + p->arm.k2 * bend * bend) / 2;
}

// Kinetic and strain energy before contact, (4.23), whole.
static double whole_energy(const parameters *p, const three_body_state *s)
{
    const double l = p->arm.length / 2, e = l / 2, m = p->arm.mass / 2;
    const double inertia = two_link_inertia(p);
    const double *q = s->angle, *w = s->velocity;

    // a rigid hub turns with the first link
    const double bend = q[2] - q[1];
    double hub_speed = w[0], hub_strain = p->arm.k1 * (q[1] - q[0]) * (q[1] - q[0]);
    if (p->arm.hub_joint == HUB_RIGID) {
        hub_speed = w[1];
        hub_strain = 0;
    }

    const double kinetic = p->arm.hub_inertia * hub_speed * hub_speed +
                           (inertia + m * e * e + m * l * l) * w[1] * w[1] +
                           (inertia + m * e * e) * w[2] * w[2] +
                           2 * m * l * e * inline_cos(bend) * w[1] * w[2];
    const double strain = p->arm.k2 * bend * bend + hub_strain;
    return (kinetic + strain) / 2;
}

// Printed form. All energy goes to k2 (4.26 with k1 far stiffer), which it bends by D
// against the drive: theta3 - theta2 = -D. With all velocities zero (4.28), (4.29),
// (4.34) give accelerations and force, where k1 (theta2 - theta1) is replaced by the
// motor torque, (4.27) without its acceleration term.
static bool printed_energy_force(const parameters *p, const three_body_state *s,
                                 double *force)
{
    two_link t;
    double bend = sqrt(2 * listed_energy(p, s) / p->arm.k2);
    two_link_at(&t, p, FORM_LISTED_ENERGY, s->angle[1], s->angle[1] - bend);
    double r[3] = {-p->arm.k2 * bend + t.motor_torque, p->arm.k2 * bend, 0};
    bool solved = two_link_solve(&t, r);
    *force = r[2];
    return solved;
}

// The share of the energy at the touch that structural damping leaves until the bend is
// largest, as 4.3 proposes. The arm on the wall is a damped oscillator of one degree of
// freedom with the decay d and the frequency w. From a bend b that grows at b' it is
// largest after the phase atan(b'/(w b)), and the energy has fallen by exp(-2 d phase/w).
// 1 without such damping.
static double share_undamped(const parameters *p, const two_link *t,
                             const three_body_state *s)
{
    const bool singly = p->arm.joint_damping[0] != '\0';
    if (p->arm.damping_ratio == 0 && !singly) {
        return 1;
    }

    // the time constant, joint damping over joint stiffness: of this arm with two links,
    // or that of every joint
    arm a;
    parameters two_links = *p;
    if (!singly) {
        two_links.arm.links = 2;
        two_links.arm.hub_joint = HUB_RIGID;
        two_links.arm.link_inertia = two_link_inertia(p);
        two_links.arm.joint_stiffness[0] = two_links.arm.link_lengths[0] =
            two_links.arm.link_masses[0] = two_links.arm.link_inertias[0] = '\0';
    }
    arm_init(&a, &two_links);
    const double time_constant = a.joint_damping / a.joint_stiffness;

    // the constrained arm, whose links turn as (1, ratio): its mass v'Mv, w0^2 and decay
    const double ratio = -t->j2 / t->j3, last = t->m32 + t->m33 * ratio;
    const double mass = t->m22 + t->m23 * ratio - last + ratio * last;
    const double undamped_square = p->arm.k2 * (ratio - 1) * (ratio - 1) / mass;
    const double decay = undamped_square * time_constant / 2;
    const double frequency = sqrt(fmax(undamped_square - decay * decay, 0));

    // the phase from the touch to the largest bend
    const double bend = s->angle[2] - s->angle[1];
    const double rate = s->velocity[2] - s->velocity[1];
    const double phase = plain_atan2(fabs(rate), frequency * copysign(bend, rate * bend));
    if (frequency > 0) {
        return plain_exp(-2 * decay * phase / frequency);
    }
    return 0;
}

// The peak force in the corrected form: the whole energy (4.23) is shared by the springs
// as in (4.24), and (4.28) goes without the k2 term that does not belong there. A hub
// spring drives both links with its torque k1 D1. With a rigid hub, the hub and the first
// link are one body, driven by the motor less the Coulomb friction that slowed it.
static bool corrected_energy_force(const parameters *p, const three_body_state *s,
                                   double *force)
{
    // the energy, and how far it bends each spring: k2, and k1 at a hub with a spring
    two_link t;
    double stiffness[2] = {p->arm.k2, p->arm.k1}, bend[2];
    bool rigid = p->arm.hub_joint == HUB_RIGID;
    two_link_at(&t, p, FORM_CORRECTED, s->angle[1], s->angle[2]);
    double energy = whole_energy(p, s) * share_undamped(p, &t, s);
    const int springs = rigid ? 1 : 2;
    quasi_principle_deflections(springs, stiffness, energy, bend);
    two_link_at(&t, p, FORM_CORRECTED, s->angle[1], s->angle[1] - bend[0]);

    // what drives the links while they are stopped: the motor, or the hub's spring
    double drive;
    if (rigid) {
        drive = t.motor_torque - p->motor.stiction * sign_of(s->velocity[1]);
    } else {
        drive = p->arm.k1 * bend[1];
    }
    double r[3] = {drive, p->arm.k2 * bend[0], 0};
    bool solved = two_link_solve(&t, r);
    *force = r[2];
    return solved;
}

status predict_energy(const parameters *p, const three_body_state *s, prediction *out,
                      fault *f)
{
    bool printed = p->arm.model == ARM_PRINTED;
    two_link touch;
    *out = prediction_none();
    TRY(three_body_state_check(s, f));
    double force, after[3], impulse;
    bool solved;
    if (printed) {
        solved = printed_energy_force(p, s, &force);
    } else {
        solved = corrected_energy_force(p, s, &force);
    }
    FAULT_IF(!solved || !isfinite(force), f, STATUS_SINGULAR,
             "the energy principle has no single force for this state: its system "
             "(4.28), (4.29), (4.34) is singular");

    // it holds for an arm that comes near and, corrected, stays on the wall
    const two_link_form form = printed ? FORM_LISTED_IMPACT : FORM_CORRECTED;
    two_link_at(&touch, p, form, s->angle[1], s->angle[2]);
    out->force = force;
    out->holds = force > 0 && two_link_approach_speed(&touch, s) >= 0;
    if (!printed) {
        TRY(two_link_velocity_jump(&touch, s, after, &impulse, f));
        out->holds = out->holds && two_link_first_force(&touch, p, s, after) >= 0 &&
                     two_link_restitution(&touch, p, s) == 0;
    }
    return STATUS_OK;
}
