#include "tests/three_body_states.h"

#include "src/thesis/printed_arm.h"
#include "src/base/dense.h"

typedef struct motion_state {
    double q[3], w[3], alpha[3], force;
} motion_state;

// Bent by tenths of a radian, moving, pressed or not.
static motion_state some_state(unsigned *seed, bool contact)
{
    motion_state m = {.force = contact ? 20 + 15 * noise(seed) : 0};
    for (int i = 0; i < 3; i++) {
        m.q[i] = 0.1 + 0.4 * noise(seed);
        m.w[i] = 3 * noise(seed);
        m.alpha[i] = 300 * noise(seed);
    }
    m.w[0] += m.w[0] > 0 ? 0.5 : -0.5; // away from the jump of the friction
    return m;
}

static printed_arm arm_with(unsigned switches)
{
    parameters p = defaults_of(ARM_PRINTED);
    p.printed.spring_counted_twice = switches & 1;
    p.printed.force_at_link_end = switches & 2;
    p.printed.sign_dead_band = switches & 4;
    p.printed.reevaluation = switches & 8 ? REEVALUATE_LISTING : REEVALUATE_RHS;
    p.printed.force_after_release = switches & 16;
    p.printed.feed_newmark_acceleration = switches & 32;
    printed_arm a;
    printed_arm_init(&a, &p);
    return a;
}

enum { SWITCHINGS = 64 }; // every combination of the six switches above

// The residual with angle or force number `column` moved by `change`.
static void moved_residual(const printed_arm *a, newmark_slopes slopes, motion_state m,
                           int column, double change, double residual[4])
{
    if (column == 3) {
        m.force += change;
    } else {
        m.q[column] += change;
        m.w[column] += slopes.velocity * change;
        m.alpha[column] += slopes.acceleration * change;
    }
    printed_residual(a, m.q, m.w, m.alpha, m.force, residual);
}

TEST(jacobian_is_the_derivative_of_the_residual)
{
    const newmark_slopes slopes = {1 / (0.4 * 1e-6), 0.5 / (0.4 * 1e-3)};
    const double change = 1e-5;
    unsigned seed = 7;
    for (unsigned switches = 0; switches < SWITCHINGS; switches++) {
        printed_arm a = arm_with(switches);
        for (int trial = 0; trial < 20; trial++) {
            motion_state m = some_state(&seed, trial % 2);
            double jacobian[4][4];
            printed_newmark_jacobian(&a, slopes, m.q, m.w, m.alpha, m.force, jacobian);
            for (int column = 0; column < 4; column++) {
                double above[4], below[4];
                moved_residual(&a, slopes, m, column, change, above);
                moved_residual(&a, slopes, m, column, -change, below);
                for (int row = 0; row < 4; row++) {
                    double slope = (above[row] - below[row]) / (2 * change);
                    check_close(jacobian[row][column], slope, 1e-6 * fabs(slope) + 1e-8);
                }
            }
        }
    }
}

// Kinetic and strain energy from the speeds of the two centres of mass, not from the
// equations.
static double energy(const printed_arm *a, const double q[3], const double w[3])
{
    double l = a->link_length, e = a->centre;
    double x2 = -e * sin(q[1]) * w[1], y2 = e * cos(q[1]) * w[1];
    double x3 = -l * sin(q[1]) * w[1] - e * sin(q[2]) * w[2];
    double y3 = l * cos(q[1]) * w[1] + e * cos(q[2]) * w[2];
    return 0.5 *
           (a->hub_inertia * w[0] * w[0] + a->link_inertia * (w[1] * w[1] + w[2] * w[2]) +
            a->link_mass * (x2 * x2 + y2 * y2 + x3 * x3 + y3 * y3) +
            a->k1 * (q[1] - q[0]) * (q[1] - q[0]) +
            a->k2 * (q[2] - q[1]) * (q[2] - q[1]));
}

// Accelerations that make R1..R3 vanish, from the residual alone (it is linear in them).
static void accelerate(const printed_arm *a, motion_state *m)
{
    static const double rest[3] = {0, 0, 0};
    double residual[4], matrix[9], at_rest[4];
    printed_residual(a, m->q, m->w, rest, m->force, at_rest);
    for (int column = 0; column < 3; column++) {
        double unit[3] = {column == 0, column == 1, column == 2};
        printed_residual(a, m->q, m->w, unit, m->force, residual);
        for (int row = 0; row < 3; row++) {
            matrix[3 * row + column] = residual[row] - at_rest[row];
        }
        m->alpha[column] = -at_rest[column];
    }
    assert_true(dense_solve(3, matrix, m->alpha));
}

// Rate of energy less the power of motor, friction and contact force.
static double energy_defect(const printed_arm *a, motion_state m)
{
    const double h = 1e-6;
    accelerate(a, &m);
    double after[3], before[3], faster[3], slower[3], gradient[3], rate_of_gap = 0;
    printed_constraint_gradient(a, m.q, gradient);
    for (int i = 0; i < 3; i++) {
        after[i] = m.q[i] + h * m.w[i];
        before[i] = m.q[i] - h * m.w[i];
        faster[i] = m.w[i] + h * m.alpha[i];
        slower[i] = m.w[i] - h * m.alpha[i];
        rate_of_gap += gradient[i] * m.w[i];
    }
    double rate = (energy(a, after, faster) - energy(a, before, slower)) / (2 * h);
    double drive =
        a->motor.torque - a->motor.damping * m.w[0] - copysign(a->motor.stiction, m.w[0]);
    return rate - drive * m.w[0] + m.force * rate_of_gap;
}

TEST(sound_switches_balance_the_energy)
{
    printed_arm a = arm_with(0);
    unsigned seed = 11;
    for (int trial = 0; trial < 50; trial++) {
        check_close(energy_defect(&a, some_state(&seed, trial % 2)), 0, 1e-5);
    }
}

TEST(doubled_spring_gives_power_from_nowhere)
{
    printed_arm a = arm_with(1);
    unsigned seed = 11;
    for (int trial = 0; trial < 50; trial++) {
        motion_state m = some_state(&seed, false);
        check_close(energy_defect(&a, m), a.k2 * (m.q[2] - m.q[1]) * m.w[1], 1e-5);
    }
}

TEST(levers_of_the_force_agree_to_second_order_in_the_bend)
{
    printed_arm end = arm_with(2), point = arm_with(0);
    for (double bend = 0.1; bend > 0.01; bend /= 2) {
        // both links touch the contact point's circle: half the bend either way
        double q[3] = {0.1, 0.1 + bend / 2, 0.1 - bend / 2}, rest[3] = {0, 0, 0};
        double with[4], other[4];
        printed_residual(&end, q, rest, rest, 1, with);
        printed_residual(&point, q, rest, rest, 1, other);
        double difference = fabs(other[1] - with[1]) + fabs(other[2] - with[2]);
        assert_true(difference > 0);
        check_below(difference, 0.5 * bend * bend);
    }
}

TEST(gradient_is_the_derivative_of_the_penetration)
{
    printed_arm a = arm_with(0);
    unsigned seed = 3;
    for (int trial = 0; trial < 20; trial++) {
        motion_state m = some_state(&seed, false);
        double gradient[3];
        printed_constraint_gradient(&a, m.q, gradient);
        for (int i = 0; i < 3; i++) {
            double q[3], change = 1e-6;
            memcpy(q, m.q, sizeof q);
            q[i] += change;
            double above = printed_penetration(&a, q);
            q[i] -= 2 * change;
            check_close(gradient[i], (above - printed_penetration(&a, q)) / (2 * change),
                        1e-9);
        }
    }
}

// Second derivative of the penetration along the motion.
static double penetration_acceleration(const printed_arm *a, const motion_state *m)
{
    const double h = 1e-4;
    double sum = -2 * printed_penetration(a, m->q);
    for (int side = -1; side <= 1; side += 2) {
        double q[3];
        for (int i = 0; i < 3; i++) {
            q[i] = m->q[i] + side * h * m->w[i] + h * h / 2 * m->alpha[i];
        }
        sum += printed_penetration(a, q);
    }
    return sum / (h * h);
}

TEST(reevaluation_satisfies_the_equations_of_motion_and_the_constraint)
{
    unsigned seed = 5;
    for (unsigned switches = 0; switches < 4; switches++) {
        printed_arm a = arm_with(switches);
        for (int trial = 0; trial < 20; trial++) {
            motion_state m = some_state(&seed, false);
            double residual[4];
            assert_true(printed_reevaluate(&a, m.q, m.w, m.alpha, &m.force));
            printed_residual(&a, m.q, m.w, m.alpha, m.force, residual);
            for (int row = 0; row < 3; row++) {
                check_close(residual[row], 0, 1e-10);
            }
            check_close(penetration_acceleration(&a, &m), 0, 1e-2);
        }
    }
}

// The listing multiplies the force by what belongs on the right side: the penetration
// then accelerates by -(1 + f) times that term.
TEST(listed_reevaluation_breaks_the_constraint_by_the_misplaced_term)
{
    printed_arm a = arm_with(8);
    unsigned seed = 5;
    for (int trial = 0; trial < 20; trial++) {
        motion_state m = some_state(&seed, false);
        assert_true(printed_reevaluate(&a, m.q, m.w, m.alpha, &m.force));
        double term = 2 * a.link_length * sin(m.q[2] - m.q[1]) * m.w[1] * m.w[2];
        check_close(penetration_acceleration(&a, &m), -term * (1 + m.force),
                    1e-2 + 1e-4 * fabs(term * m.force));
    }
}

TEST(sign_has_a_dead_band_of_1e_5_either_way_as_listed_too)
{
    assert_true(printed_sign(1e-4) == 1);
    assert_true(printed_sign(1e-5) == 0);
    assert_true(printed_sign(5e-6) == 0);
    assert_true(printed_sign(-5e-6) == 0);
    assert_true(printed_sign(-1e-5) == 0);
    assert_true(printed_sign(-1e-4) == -1);
    assert_true(printed_sign(-1) == -1);
}

TEST(constants_are_those_of_the_thesis)
{
    printed_arm a = arm_with(63);
    check_close(a.motor.torque, 0.4377, 5e-5); // 1 V
    check_close(a.link_mass, 0.20054, 1e-12);
    check_close(a.centre, 0.25, 1e-12);
    check_close(a.wall.x, cos(0.1), 1e-12);
    check_close(a.wall.y, sin(0.1), 1e-12);
    assert_true(wall_stands(&a.wall));
}

TEST(dense_solve_pivots_and_refuses_the_singular)
{
    double swap[4] = {0, 2, 3, 1}, right[2] = {4, 5};
    assert_true(dense_solve(2, swap, right));
    check_close(right[0], 1, 1e-15);
    check_close(right[1], 2, 1e-15);
    double twin[4] = {1, 2, 2, 4}, any[2] = {1, 1};
    assert_false(dense_solve(2, twin, any));
    double bad[4] = {(double)NAN, 1, 1, 1}, more[2] = {1, 1};
    assert_false(dense_solve(2, bad, more));
}

// Coulomb friction takes its torque while the hub turns, either way, and none at rest.
TEST(a_resting_hub_has_no_friction)
{
    printed_arm a = arm_with(4);
    assert_true(a.motor.stiction > 0);
    const double q[3] = {0.1, 0.1, 0.1}, alpha[3] = {0};
    double at_rest[4], forwards[4], backwards[4];
    printed_residual(&a, q, (const double[3]){0, 0, 0}, alpha, 0, at_rest);
    printed_residual(&a, q, (const double[3]){1e-4, 0, 0}, alpha, 0, forwards);
    printed_residual(&a, q, (const double[3]){-1e-4, 0, 0}, alpha, 0, backwards);
    const double damping = 1e-4 * a.motor.damping;
    check_close(fabs(forwards[0] - at_rest[0]), a.motor.stiction + damping, 1e-15);
    check_close(forwards[0] + backwards[0], 2 * at_rest[0], 1e-15);
}
