// Instantaneous velocity increments, (4.10)-(4.17).
#include "src/arm/impact.h"
#include "tests/arm_fixture.h"

enum { LARGEST = 16 };

// Near the wall, bent and closing in; different for each seed.
static void approaching_state(const arm *a, int seed, double *q, double *w)
{
    for (int i = 0; i < a->dof; i++) {
        q[i] = 0.1 + 0.05 * sin(1.7 * i + seed);
        w[i] = 1.5 + sin(2.3 * i + 0.7 * seed);
    }
}

// M v by direct summation over the links' centres.
static void momentum(const arm *a, const double *q, const double *v, double *out)
{
    for (int i = 0; i < a->dof; i++) {
        out[i] = i == 0 ? a->hub_inertia * v[0] : 0;
        for (int j = a->first; j < a->dof && i >= a->first; j++) {
            for (int body = a->first; body < a->dof; body++) {
                double ri = body > i    ? a->link_length
                            : body == i ? a->link_length / 2
                                        : 0;
                double rj = body > j    ? a->link_length
                            : body == j ? a->link_length / 2
                                        : 0;
                out[i] += a->link_mass * ri * rj * cos(q[i] - q[j]) * v[j];
            }
        }
        out[i] += i >= a->first ? a->link_inertia * v[i] : 0;
    }
}

// J_i, the i-th component of the contact Jacobian: the rate of penetration under a unit
// velocity of coordinate i.
static double jacobian(const arm *a, const double *q, int i)
{
    double unit[LARGEST] = {0};
    unit[i] = 1;
    return chain_penetration_rate(a, q, unit);
}

// The laws of an impact of 1 to 12 links: the momentum M dw changes by -J times the
// impulse, the tip leaves with e times the speed it came with, and the kinetic energy
// falls by the loss that is reported. The bits of `kind` choose the hub's joint, the kind
// of wall and the restitution e.
TEST(impulse_is_the_change_of_momentum)
{
    for (int links = 1; links <= 12; links++) {
        for (int kind = 0; kind < 8; kind++) {
            arm a =
                arm_with(given("arm.links=%d %s %s", links,
                               kind & 1 ? "arm.hub_joint=spring" : "arm.hub_joint=rigid",
                               kind & 2 ? "wall.kind=plane" : "wall.kind=point"));
            double e = kind & 4 ? 0.6 : 0, q[LARGEST], w[LARGEST], dw[LARGEST],
                   after[LARGEST];
            double change[LARGEST];
            chain_link work[LARGEST];
            approaching_state(&a, kind, q, w);
            impact_result r = impact_velocity_increments(&a, work, q, w, 0, e, dw);
            momentum(&a, q, dw, change);
            for (int i = 0; i < a.dof; i++) {
                check_close(change[i], -r.impulse * jacobian(&a, q, i), 1e-12);
                after[i] = w[i] + dw[i];
            }
            assert_true(r.impulse > 0);
            check_close(chain_penetration_rate(&a, q, after), -e * r.speed, 1e-12);
            double before = chain_kinetic_energy(&a, q, w);
            check_close(before - chain_kinetic_energy(&a, q, after), r.loss,
                        1e-12 * (1 + before));
            assert_true(r.loss >= 0);
        }
    }
}

// The impact turns the two links in opposite directions, in each of fifty random states.
TEST(increments_of_the_two_links_have_opposite_signs)
{
    for (int seed = 0; seed < 50; seed++) {
        for (int rigid = 0; rigid < 2; rigid++) {
            arm a = arm_with(
                given("%s", rigid ? "arm.hub_joint=rigid" : "arm.hub_joint=spring"));
            double q[3], w[3], dw[3];
            chain_link work[2];
            approaching_state(&a, seed, q, w);
            impact_velocity_increments(&a, work, q, w, 0, 0, dw);
            assert_true(dw[a.first] * dw[a.first + 1] < 0);
        }
    }
}

// A spring between hub and first link carries no impulse, so the hub's velocity does not
// jump. A rigid joint makes the hub part of the first link.
TEST(hub_jumps_only_with_a_rigid_joint)
{
    double q[3], w[3], dw[3];
    chain_link work[2];
    arm spring = arm_with(given("arm.hub_joint=spring"));
    approaching_state(&spring, 1, q, w);
    impact_velocity_increments(&spring, work, q, w, 0, 0, dw);
    check_close(dw[0], 0, 0); // equation (4.10)
    assert_true(fabs(dw[1]) > 1e-3);

    // with the hub's inertia the first link is heavier, and its jump smaller
    arm rigid = arm_with(given("arm.hub_joint=rigid"));
    double q2[2] = {q[1], q[2]}, w2[2] = {w[1], w[2]}, dw2[2];
    impact_velocity_increments(&rigid, work, q2, w2, 0, 0, dw2);
    assert_true(fabs(dw2[0]) > 0 && fabs(dw2[0]) < fabs(dw[1]));
}

// Equations (4.11), (4.12) and (4.14), with the contact force at the contact point
// (errata B5). The expected values solve M dw = -J p with p such that the tip stops, J (w
// + dw) = 0, for the two links by Cramer's rule: M dw = -J p gives dw = -p (i2, i3).
TEST(agrees_with_the_closed_form)
{
    arm a = arm_with(given("arm.hub_joint=spring"));
    double q[3], w[3], dw[3];
    chain_link work[2];
    approaching_state(&a, 3, q, w);
    impact_result r = impact_velocity_increments(&a, work, q, w, 0, 0, dw);

    // a link's mass, length, distance of the mass's centre and inertia about the centre;
    // the wall's point lies 0.1 rad round the circle of the tip
    double m = 0.20054, l = 0.5, e = 0.25, I = m * l * l / 12, c = cos(q[2] - q[1]);
    double x = cos(0.1), y = sin(0.1), s = x * cos(q[2]) + y * sin(q[2]) - l * c;
    double m22 = m * e * e + m * l * l + I, m33 = m * e * e + I, m23 = m * l * e * c;
    double j2 = l * c, j3 = s, det = m22 * m33 - m23 * m23;
    double i2 = (m33 * j2 - m23 * j3) / det, i3 = (m22 * j3 - m23 * j2) / det;

    // the impulse
    double p = (j2 * w[1] + j3 * w[2]) / (j2 * i2 + j3 * i3);
    check_relative(r.impulse, p, 1e-12);
    check_relative(dw[1], -p * i2, 1e-12);
    check_relative(dw[2], -p * i3, 1e-12);
}

// Arm and face are two bodies: the impulse that turns the arm moves the face, which then
// leaves at the share e of the speed they met at; what both lose is the loss.
TEST(a_face_takes_the_impulse_that_the_arm_gives)
{
    const double mass = 0.05; // of the face [kg]
    for (int kind = 0; kind < 4; kind++) {
        // restitution, and the face's velocity before the impact [m/s]
        const double e = kind & 1 ? 0.6 : 0, face = kind & 2 ? -0.3 : 0.2;
        arm a = arm_with(
            given("wall.contact=kelvin-voigt wall.stiffness=1e5 wall.mass=0.05"));
        double q[LARGEST], w[LARGEST], dw[LARGEST], after[LARGEST];
        chain_link work[LARGEST];
        approaching_state(&a, kind, q, w);
        impact_result r = impact_velocity_increments(&a, work, q, w, face, e, dw);
        check_close(r.speed, chain_penetration_rate(&a, q, w) - face, 1e-14);
        for (int i = 0; i < a.dof; i++) {
            after[i] = w[i] + dw[i];
        }

        // the face moves on by impulse/mass; kinetic energy counts arm and face
        const double face_after = face + r.impulse / mass;
        check_close(chain_penetration_rate(&a, q, after) - face_after, -e * r.speed,
                    1e-12);
        const double before = chain_kinetic_energy(&a, q, w) + mass / 2 * face * face;
        const double left =
            chain_kinetic_energy(&a, q, after) + mass / 2 * face_after * face_after;
        check_close(before - left, r.loss, 1e-12 * (1 + before));
    }
}
