#include "src/predict/two_link.h"

#include <math.h>
#include <string.h>

#include "src/arm/arm.h"
#include "src/base/dense.h"
#include "src/base/sincos.h"

double sign_of(double x)
{
    if (x > 0) {
        return 1;
    }
    if (x < 0) {
        return -1;
    }
    return 0;
}

double two_link_inertia(const parameters *p)
{
    double l = p->arm.length / 2, m = p->arm.mass / 2;
    if (p->arm.links == 2) {
        return p->arm.link_inertia;
    }
    return m * l * l / 12;
}

// The slopes j2, j3 of the corrected model's contact constraint, the wall being where the
// arm is. A point wall at the beam's length 2l from the hub lies at the distance A along
// the second link, with |l r2 + A r3| = 2l, so A = l (sqrt(c^2 + 3) - c), c = cos(bend).
// A flat wall contains the hub's axis and the tip: each link makes half the bend with it.
static void contact_on_the_arm(two_link *t, int wall, double bend)
{
    double l = t->length, c = inline_cos(bend);
    if (wall == WALL_PLANE) {
        t->j2 = t->j3 = l * inline_cos(bend / 2);
    } else {
        t->j2 = l * c;
        t->j3 = l * (sqrt(c * c + 3) - c);
    }
}

void two_link_at(two_link *t, const parameters *p, two_link_form form, double angle2,
                 double angle3)
{
    memset(t, 0, sizeof *t);
    double l = p->arm.length / 2, e = l / 2, m = p->arm.mass / 2,
           inertia = two_link_inertia(p);
    double bend = angle3 - angle2, c = inline_cos(bend);

    t->length = l;
    t->centre = e;
    t->motor_torque = motor_torque_per_volt(&p->motor) *
                      motor_limited_voltage(&p->motor, p->motor.voltage);
    t->hub_damping = motor_damping(&p->motor);

    // factors of the accelerations, as (2.16) and (2.17) have them
    t->m32 = m * l * e * c;
    t->m33 = m * e * e + inertia;
    t->m22 = m * e * e + m * l * l + inertia + m * l * e * c;
    t->m23 = t->m33 + t->m32;

    // where the listing takes cos d = 1 and leaves I2, I3 out
    if (form == FORM_LISTED_IMPACT) {
        t->m22 = m * e * e + m * l * l + m * l * e;
        t->m23 = m * e * e + m * l * e;
    }

    if (form == FORM_CORRECTED) {
        contact_on_the_arm(t, p->wall.kind, bend);
        t->both = t->j2 + t->j3;
        t->last = t->j3;
        t->rigid_hub = p->arm.hub_joint == HUB_RIGID;
        if (t->rigid_hub) {
            t->m22 += p->arm.hub_inertia;
        }
        return;
    }

    // printed: the force at the link's end, the constraint of (3.12)
    double a = p->arm.length * inline_cos(p->wall.angle),
           b = p->arm.length * inline_sin(p->wall.angle);
    t->both = l * (1 + c);
    t->last = l;
    t->j2 = l * c;
    if (form == FORM_LISTED_ENERGY) {
        t->j3 = l;
    } else {
        t->j3 = a * inline_cos(angle3) + b * inline_sin(angle3) - l * c;
    }
}

double two_link_approach_speed(const two_link *t, const three_body_state *s)
{
    return t->j2 * s->velocity[1] + t->j3 * s->velocity[2];
}

bool two_link_solve(const two_link *t, double r[3])
{
    double matrix[9] = {t->m22,  t->m23, t->both, t->m32, t->m33,
                        t->last, t->j2,  t->j3,   0};
    return dense_solve(3, matrix, r);
}

double two_link_restitution(const two_link *t, const parameters *p,
                            const three_body_state *s)
{
    wall_model wall;
    wall_init(&wall, p);
    const double e = wall_restitution(&wall, two_link_approach_speed(t, s));
    if (p->arm.model == ARM_PRINTED) {
        return 0;
    }
    return e;
}

status two_link_velocity_jump(const two_link *t, const three_body_state *s,
                              double after[3], double *impulse, fault *f)
{
    double r[3] = {0, 0, -two_link_approach_speed(t, s)};
    FAULT_IF(!two_link_solve(t, r) || !isfinite(r[2]), f, STATUS_SINGULAR,
             "the impact at this state has no single impulse: the system (4.11), "
             "(4.12), (4.14) is singular");

    after[1] = s->velocity[1] + r[0];
    after[2] = s->velocity[2] + r[1];
    if (t->rigid_hub) {
        after[0] = after[1];
    } else {
        after[0] = s->velocity[0];
    }
    *impulse = r[2];
    return STATUS_OK;
}

// With the contact point (a, b) on the second link's line the factor of w3^2 in (3.13)
// vanishes; a flat wall through tip and hub axis stands at half the bend to either link.
double two_link_first_force(const two_link *t, const parameters *p,
                            const three_body_state *s, const double after[3])
{
    double l = t->length, bend = s->angle[2] - s->angle[1], w2 = after[1], w3 = after[2];
    double coupling = p->arm.mass / 2 * l * t->centre * inline_sin(bend);

    // what acts at the hub: its spring, or the motor less friction
    double hub_torque = p->arm.k1 * (s->angle[0] - s->angle[1]);
    if (t->rigid_hub) {
        const double friction = p->motor.stiction * sign_of(w2);
        hub_torque = t->motor_torque - t->hub_damping * w2 - friction;
    }

    // d2g/dt2 = 0
    double curve;
    if (p->wall.kind == WALL_PLANE) {
        curve = l * inline_sin(bend / 2) * (w3 * w3 - w2 * w2);
    } else {
        curve = l * inline_sin(bend) * (2 * w2 * w3 - w2 * w2);
    }
    double r[3] = {hub_torque + coupling * (w3 * w3 - w2 * w2),
                   -p->arm.k2 * bend - coupling * w2 * w2, curve};
    if (two_link_solve(t, r)) {
        return r[2];
    }
    return (double)NAN;
}

status three_body_state_check(const three_body_state *s, fault *f)
{
    static const char *const names[3] = {"hub", "first link", "second link"};
    for (int i = 0; i < 3; i++) {
        FAULT_IF(!isfinite(s->angle[i]), f, STATUS_NOT_FINITE,
                 "a prediction needs a finite state, but the %s's angle is %g", names[i],
                 s->angle[i]);
        FAULT_IF(!isfinite(s->velocity[i]), f, STATUS_NOT_FINITE,
                 "a prediction needs a finite state, but the %s's velocity is %g",
                 names[i], s->velocity[i]);
    }
    return STATUS_OK;
}
