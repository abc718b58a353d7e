#include "src/thesis/printed_arm.h"

#include <string.h>

#include "src/arm/arm.h"
#include "src/base/dense.h"
#include "src/base/sincos.h"

void printed_arm_init(printed_arm *a, const parameters *p)
{
    memset(a, 0, sizeof *a);
    a->link_length = p->arm.length / 2;
    a->centre = a->link_length / 2;
    a->link_mass = p->arm.mass / 2;
    a->link_inertia = p->arm.link_inertia;
    a->hub_inertia = p->arm.hub_inertia;
    a->k1 = p->arm.k1;
    a->k2 = p->arm.k2;
    motor_init(&a->motor, &p->motor);
    wall_init(&a->wall, p);
    a->switches = p->printed;
}

double printed_sign(double velocity)
{
    const double edge = 1e-5;
    if (velocity > edge) {
        return 1;
    }
    if (velocity < -edge) {
        return -1;
    }
    return 0;
}

// The mass terms of (2.16) and (2.17) at a bend d = theta3 - theta2 between the links.
typedef struct mass_terms {
    double m22, m23; // factors of alpha2, alpha3 in (2.16) [kg m2]
    double m32, m33; // the same in (2.17) [kg m2]
    double coupling; // m l e [kg m2]
    double c, s;     // cos d, sin d
} mass_terms;

// Computes the mass terms at the angles q.
static mass_terms mass_terms_at(const printed_arm *a, const double q[3])
{
    double l = a->link_length, e = a->centre, m = a->link_mass;
    mass_terms t = {.coupling = m * l * e,
                    .c = inline_cos(q[2] - q[1]),
                    .s = inline_sin(q[2] - q[1])};
    t.m22 = m * e * e + m * l * l + a->link_inertia + t.coupling * t.c;
    t.m23 = m * e * e + a->link_inertia + t.coupling * t.c;
    t.m32 = t.coupling * t.c;
    t.m33 = m * e * e + a->link_inertia;
    return t;
}

// Lever arms of the contact force [m]: `both` in (2.16), the balance of both links, and
// `last` in (2.17), that of the last link. The listing puts the force at the link's end.
static void force_levers(const printed_arm *a, const double q[3], double *both,
                         double *last)
{
    const double l = a->link_length, c = inline_cos(q[2] - q[1]);
    if (a->switches.force_at_link_end) {
        *both = l + l * c;
        *last = l;
    } else {
        // how far from the hub's axis the contact point lies along the last link's
        // direction
        const double reach = wall_along(&a->wall, inline_cos(q[2]), inline_sin(q[2]));
        *both = reach;
        *last = reach - l * c;
    }
}

void printed_residual(const printed_arm *a, const double q[3], const double w[3],
                      const double alpha[3], double force, double residual[4])
{
    mass_terms t = mass_terms_at(a, q);
    double bend = q[2] - q[1], hub_bend = q[1] - q[0], both, last;
    force_levers(a, q, &both, &last);

    // (2.15): the hub
    residual[0] = a->hub_inertia * alpha[0] - a->k1 * hub_bend + a->motor.damping * w[0] +
                  a->motor.stiction * printed_sign(w[0]) - a->motor.torque;

    // (2.16): both links, (2.17): the last one
    residual[1] = a->k1 * hub_bend + t.m22 * alpha[1] + t.m23 * alpha[2] -
                  t.coupling * t.s * (w[2] * w[2] - w[1] * w[1]) + force * both;
    if (a->switches.spring_counted_twice) {
        residual[1] -= a->k2 * bend;
    }
    residual[2] = a->k2 * bend + t.m32 * alpha[1] + t.m33 * alpha[2] +
                  t.coupling * t.s * w[1] * w[1] + force * last;

    // (3.9): the constraint
    residual[3] = printed_penetration(a, q);
}

// Adds to the Jacobian what the contact force contributes to (2.16) and (2.17): its lever
// arms in the force's own column, and how they change with theta2 and theta3.
static void add_force_derivatives(const printed_arm *a, const double q[3],
                                  const mass_terms *t, double force,
                                  double jacobian[4][4])
{
    double l = a->link_length, both, last;
    force_levers(a, q, &both, &last);

    jacobian[1][3] = both;
    jacobian[2][3] = last;

    // the derivatives of the lever arms, times the force
    if (a->switches.force_at_link_end) {
        jacobian[1][1] += force * l * t->s;
        jacobian[1][2] -= force * l * t->s;
    } else {
        double turn = -wall_right_of(&a->wall, inline_cos(q[2]),
                                     inline_sin(q[2])); // d reach / d theta3
        jacobian[1][2] += force * turn;
        jacobian[2][1] -= force * l * t->s;
        jacobian[2][2] += force * (turn + l * t->s);
    }
}

void printed_newmark_jacobian(const printed_arm *a, newmark_slopes slopes,
                              const double q[3], const double w[3], const double alpha[3],
                              double force, double jacobian[4][4])
{
    mass_terms t = mass_terms_at(a, q);
    double da = slopes.acceleration, dv = slopes.velocity;
    double ps = t.coupling * t.s, pc = t.coupling * t.c;
    double counted_twice = a->switches.spring_counted_twice ? a->k2 : 0;

    // Derivatives of (2.16) and (2.17) by the bend alone, through the cosines of the mass
    // terms, the sines of the velocity terms and the spring. The bend increases with
    // theta3 and decreases with theta2.
    double bend2 =
        -ps * (alpha[1] + alpha[2]) - pc * (w[2] * w[2] - w[1] * w[1]) - counted_twice;
    double bend3 = -ps * alpha[1] + pc * w[1] * w[1] + a->k2;

    // Derivatives by the angles: directly, by the velocities and accelerations that
    // Newmark's rule makes of them (dv, da), and by the contact force.
    memset(jacobian, 0, 16 * sizeof(double));
    jacobian[0][0] = a->hub_inertia * da + a->k1 + a->motor.damping * dv;
    jacobian[0][1] = -a->k1;
    jacobian[1][0] = -a->k1;
    jacobian[1][1] = a->k1 + t.m22 * da + 2 * ps * w[1] * dv - bend2;
    jacobian[1][2] = t.m23 * da - 2 * ps * w[2] * dv + bend2;
    jacobian[2][1] = t.m32 * da + 2 * ps * w[1] * dv - bend3;
    jacobian[2][2] = t.m33 * da + bend3;
    add_force_derivatives(a, q, &t, force, jacobian);
    printed_constraint_gradient(a, q, jacobian[3]);
}

double printed_penetration(const printed_arm *a, const double q[3])
{
    return wall_right_of(&a->wall, inline_cos(q[2]), inline_sin(q[2])) -
           a->link_length * inline_sin(q[2] - q[1]);
}

void printed_constraint_gradient(const printed_arm *a, const double q[3],
                                 double gradient[3])
{
    double projected = a->link_length * inline_cos(q[2] - q[1]);
    gradient[0] = 0;
    gradient[1] = projected;
    gradient[2] = wall_along(&a->wall, inline_cos(q[2]), inline_sin(q[2])) - projected;
}

bool printed_reevaluate(const printed_arm *a, const double q[3], const double w[3],
                        double alpha[3], double *force)
{
    static const double rest[3] = {0, 0, 0};
    mass_terms t = mass_terms_at(a, q);
    double residual[4], gradient[3], both, last, l = a->link_length;
    force_levers(a, q, &both, &last);
    printed_constraint_gradient(a, q, gradient);

    // the right side of the linear system: the residuals without accelerations and force
    printed_residual(a, q, w, rest, 0, residual);

    // The balances of the two links, and (3.13): d2g/dt2 = 0. The listing puts the
    // latter's term with w2 w3 into the matrix instead of the vector.
    double curvature =
        -wall_right_of(&a->wall, inline_cos(q[2]), inline_sin(q[2])) + l * t.s;
    double cross = 2 * l * t.s * w[1] * w[2];
    double cross_in_matrix = 0, cross_in_vector = cross;
    if (a->switches.reevaluation == REEVALUATE_LISTING) {
        cross_in_matrix = cross;
        cross_in_vector = 0;
    }
    double matrix[9] = {t.m22,       t.m23,       both, //
                        t.m32,       t.m33,       last, //
                        gradient[1], gradient[2], cross_in_matrix};
    double vector[3] = {-residual[1], -residual[2],
                        -l * t.s * w[1] * w[1] - curvature * w[2] * w[2] +
                            cross_in_vector};
    if (!dense_solve(3, matrix, vector)) {
        return false;
    }

    alpha[0] = -residual[0] / a->hub_inertia;
    alpha[1] = vector[0];
    alpha[2] = vector[1];
    *force = vector[2];
    return true;
}
