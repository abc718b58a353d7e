#include "tests/check.h"

#include <string.h>

#include "src/predict/predict.h"

static double noise(unsigned *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / (double)(1u << 23) - 1;
}

static parameters parameters_of(arm_model_kind model)
{
    parameters p;
    parameters_defaults(&p, model);
    assert_int_equal(parameters_resolve(&p, NULL), STATUS_OK);
    return p;
}

static parameters corrected_with(hub_joint_kind joint)
{
    parameters p;
    parameters_defaults(&p, ARM_CORRECTED);
    assert_int_equal(parameter_set_number(&p, PARAMETER_INDEX(arm.hub_joint), joint, NULL),
                     STATUS_OK);
    assert_int_equal(parameters_resolve(&p, NULL), STATUS_OK);
    return p;
}

// A state as it comes to the wall at 0.1 rad: little bend, hub and links about equally fast.
static three_body_state state_at_wall(const parameters *p, unsigned *seed)
{
    three_body_state s;
    double speed = 1 + 0.7 * noise(seed), bend = 0.03 * noise(seed);
    s.angle[1] = p->wall.angle - bend / 2;
    s.angle[2] = p->wall.angle + bend / 2;
    s.angle[0] = s.angle[1] + 0.005 * noise(seed);
    for (int i = 0; i < 3; i++) {
        s.velocity[i] = speed * (1 + 0.1 * noise(seed));
    }
    if (p->arm.model == ARM_CORRECTED && p->arm.hub_joint == HUB_RIGID) {
        s.angle[0] = s.angle[1];
        s.velocity[0] = s.velocity[1];
    }
    return s;
}

// (3.12): rate at which the contact point comes through the second link's line.
static double penetration_rate(const parameters *p, const double q[3], const double w[3])
{
    double l = p->arm.length / 2, c = cos(q[2] - q[1]);
    double a = 2 * l * cos(p->wall.angle), b = 2 * l * sin(p->wall.angle);
    return l * c * w[1] + (a * cos(q[2]) + b * sin(q[2]) - l * c) * w[2];
}

static double kinetic_energy(const parameters *p, const double q[3], const double w[3])
{
    double l = p->arm.length / 2, e = l / 2, m = p->arm.mass / 2, in = p->arm.link_inertia;
    double x = -l * sin(q[1]) * w[1] - e * sin(q[2]) * w[2];
    double y = l * cos(q[1]) * w[1] + e * cos(q[2]) * w[2];
    return 0.5 * (p->arm.hub_inertia * w[0] * w[0] + (in + m * e * e) * w[1] * w[1] +
                  in * w[2] * w[2] + m * (x * x + y * y));
}

static void springs_share_energy_by_their_compliance(void **state)
{
    (void)state;
    const double k[3] = {1, 3, 6}; // compliances 6 : 2 : 1
    double deflection[3], torque = 0, energy = 0;
    quasi_principle_deflections(3, k, 9, deflection);
    check_close(0.5 * k[0] * deflection[0] * deflection[0], 6, 1e-12);
    check_close(0.5 * k[1] * deflection[1] * deflection[1], 2, 1e-12);
    check_close(0.5 * k[2] * deflection[2] * deflection[2], 1, 1e-12);
    // springs in series carry one torque
    torque = k[0] * deflection[0];
    for (int i = 0; i < 3; i++) {
        check_close(k[i] * deflection[i], torque, 1e-12);
        energy += 0.5 * k[i] * deflection[i] * deflection[i];
    }
    check_close(energy, 9, 1e-12);
}

// Links without inertia of their own, at rest, bent by a small D: all masses are multiples of
// u = m e^2, cosines are 1, the levers 2l and l, and the second link turns against the first.
static void energy_of_a_small_bend_can_be_computed_by_hand(void **state)
{
    (void)state;
    const double D = 1e-4;
    three_body_state s = {{0.1 + D / 2, 0.1 + D / 2, 0.1 - D / 2}, {0, 0, 0}};
    prediction out;

    // printed: 4u a + 2l f = S - k D, u a + l f = k D, so l f = (5 k D - S) / 2
    parameters p = parameters_of(ARM_PRINTED);
    p.arm.link_inertia = 0;
    p.motor.voltage = 1e-3;
    double u = p.arm.mass / 2 * 0.0625, torque = 0.4377e-3, k = p.arm.k2;
    assert_int_equal(predict_energy(&p, &s, &out, NULL), STATUS_OK);
    check_close(out.force, (5 * k * D - torque) / 2 / 0.5, 1e-6);
    assert_true(isnan(out.delay) && isnan(out.impulse));

    // corrected, rigid hub: (I1 + 4u) a + 2l f = S, u a + l f = k D, no friction at rest
    p = corrected_with(HUB_RIGID);
    p.arm.link_inertia = 0;
    p.motor.voltage = 1e-3;
    double a = (torque - 2 * k * D) / (p.arm.hub_inertia + 2 * u);
    assert_int_equal(predict_energy(&p, &s, &out, NULL), STATUS_OK);
    check_close(out.force, (k * D - u * a) / 0.5, 1e-6);
}

// 4.3 on damping: a straight arm that strikes with no drive bends for a quarter of a period, in
// which the oscillator with mass I1 + 2u and stiffness 4 k2 loses exp(-pi d / w) of its energy.
static void damping_takes_its_share_of_the_energy(void **state)
{
    (void)state;
    const double ratio = 0.02;
    three_body_state s = {{0.1, 0.1, 0.1}, {1e-4, 1e-4, 1e-4}};
    parameters p = corrected_with(HUB_RIGID);
    prediction undamped, damped;
    p.arm.link_inertia = 0;
    p.motor.voltage = p.motor.stiction = 0;
    assert_int_equal(predict_energy(&p, &s, &undamped, NULL), STATUS_OK);
    s.velocity[2] = 1e-4 + 1e-12; // bends from here on
    p.arm.damping_ratio = ratio;
    assert_int_equal(predict_energy(&p, &s, &damped, NULL), STATUS_OK);

    double u = p.arm.mass / 2 * 0.0625, square = 4 * p.arm.k2 / (p.arm.hub_inertia + 2 * u);
    double d = square * ratio / sqrt(p.arm.k2 / u), w = sqrt(square - d * d);
    check_relative(damped.force, undamped.force * exp(-M_PI_2 * d / w), 1e-4);
}

static void energy_cross_term_makes_no_difference_at_half_a_metre_only(void **state)
{
    (void)state;
    unsigned seed = 2;
    for (int longer = 0; longer <= 1; longer++) {
        parameters listed = parameters_of(ARM_PRINTED), meant;
        listed.arm.length = longer ? 1.4 : 1;
        meant = listed;
        meant.printed.energy_cross_term = false;
        three_body_state s = state_at_wall(&listed, &seed);
        prediction a, b;
        assert_int_equal(predict_energy(&listed, &s, &a, NULL), STATUS_OK);
        assert_int_equal(predict_energy(&meant, &s, &b, NULL), STATUS_OK);
        if (longer) {
            check_below(a.force, b.force);
        } else {
            check_close(a.force, b.force, 1e-12);
        }
    }
}

static void impact_stops_the_contact_point(void **state)
{
    (void)state;
    unsigned seed = 4;
    for (int trial = 0; trial < 60; trial++) {
        parameters p = trial % 3 == 0   ? parameters_of(ARM_PRINTED)
                       : trial % 3 == 1 ? corrected_with(HUB_RIGID)
                                        : corrected_with(HUB_SPRING);
        three_body_state s = state_at_wall(&p, &seed);
        double after[3], impulse;
        assert_int_equal(predict_velocity_jump(&p, &s, after, &impulse, NULL), STATUS_OK);
        assert_true(impulse > 0);
        assert_true(penetration_rate(&p, s.angle, s.velocity) > 0);
        // the corrected form has the contact point on the arm, second order in the bend from (a, b)
        check_close(penetration_rate(&p, s.angle, after), 0, trial % 3 == 0 ? 1e-14 : 1e-4);
        if (trial % 3 != 1) {
            check_close(after[0], s.velocity[0], 0);
        } else {
            check_close(after[0], after[1], 0);
        }
    }
}

static void plastic_impact_loses_half_impulse_times_speed(void **state)
{
    (void)state;
    unsigned seed = 6;
    for (int trial = 0; trial < 20; trial++) {
        parameters p = corrected_with(trial % 2 ? HUB_SPRING : HUB_RIGID);
        three_body_state s = state_at_wall(&p, &seed);
        double after[3], impulse;
        assert_int_equal(predict_velocity_jump(&p, &s, after, &impulse, NULL), STATUS_OK);
        double loss = kinetic_energy(&p, s.angle, s.velocity) - kinetic_energy(&p, s.angle, after);
        assert_true(loss > 0);
        check_relative(loss, 0.5 * impulse * penetration_rate(&p, s.angle, s.velocity), 1e-3);
    }
}

// What (4.20)-(4.22) leave over at a prediction; the hub's velocity is taken from (4.20).
static void thesis_equations(const parameters *p, const three_body_state *s, const prediction *out,
                             double left[2])
{
    double l = 0.5, T = out->delay, f = out->force, u = p->arm.mass / 2 * 0.0625;
    double after[3], impulse, d1 = s->angle[1] - s->angle[0], d2 = s->angle[2] - s->angle[1];
    double kt = p->motor.torque_constant, ra = p->motor.resistance;
    double load = p->motor.amplifier_gain * kt / ra * p->motor.voltage;
    double kv = p->motor.viscous_friction + kt * p->motor.back_emf / ra;
    assert_int_equal(predict_velocity_jump(p, s, after, &impulse, NULL), STATUS_OK);
    double w2 = after[1], w3 = after[2];
    double w1 = (load * T - p->motor.stiction * T + p->arm.k1 * T * (d1 + T / 4 * w2)) /
                (p->arm.k1 * T * T / 4 - p->arm.hub_inertia + kv * T / 2);
    double spring1 = p->arm.k1 * T * (d1 + T / 4 * (w2 - w1));
    double spring2 = p->arm.k2 * T * (d2 + T / 4 * (w3 - w2));
    left[0] = -spring2 + spring1 - 7 * u * w2 - 3 * u * w3 + T / 2 * l * (1 + cos(d2)) * f;
    left[1] = spring2 + T / 2 * l * f - 2 * u * cos(d2) * w2 - (u + p->arm.link_inertia) * w3;
}

static void printed_dynamics_solves_the_printed_equations(void **state)
{
    (void)state;
    unsigned seed = 8;
    int held = 0;
    for (int trial = 0; trial < 60; trial++) {
        const double factor[3] = {1, 10, 100};
        parameters p = parameters_of(ARM_PRINTED);
        p.arm.k2 *= factor[trial % 3];
        three_body_state s = state_at_wall(&p, &seed);
        prediction out;
        assert_int_equal(predict_impact_dynamics(&p, &s, &out, NULL), STATUS_OK);
        if (out.holds) {
            double left[2];
            thesis_equations(&p, &s, &out, left);
            check_close(left[0], 0, 1e-9);
            check_close(left[1], 0, 1e-9);
            held++;
        }
    }
    assert_true(held >= 50);
}

// Hubs and beams far softer and stiffer than the thesis's: what is predicted solves the equations,
// and what has no solution nearby is said to have none.
static void any_springs_solve_the_printed_equations(void **state)
{
    (void)state;
    unsigned seed = 12;
    int held = 0;
    for (int trial = 0; trial < 4000; trial++) {
        parameters p = parameters_of(ARM_PRINTED);
        p.arm.k1 *= pow(10, 4 * noise(&seed));
        p.arm.k2 *= pow(10, 4 * noise(&seed));
        p.arm.hub_inertia *= pow(10, 3 * noise(&seed));
        three_body_state s = state_at_wall(&p, &seed);
        prediction out;
        fault f = {0};
        const status code = predict_impact_dynamics(&p, &s, &out, &f);
        if (code != STATUS_OK) {
            assert_int_equal(code, STATUS_NEWTON_FAILED);
            assert_non_null(strstr(f.text, "no solution of (4.20)-(4.22)"));
        } else if (out.holds) {
            // small against the terms that have to cancel
            double left[2];
            const double terms = 1e-3 + p.arm.k1 * out.delay * (0.005 + out.delay) +
                                 p.arm.k2 * out.delay * (0.03 + out.delay);
            thesis_equations(&p, &s, &out, left);
            check_close(left[0] / terms, 0, 1e-6);
            check_close(left[1] / terms, 0, 1e-6);
            held++;
        }
    }
    assert_true(held >= 2000);
}

// Hub and first link one body, straight beam, no motor, no friction: after the impact the beam
// swings with d = -2 theta2, (I1 + 2u) theta2'' = -4 k theta2 for small bends, u = m e^2. Its first
// peak is known; the thesis's assumptions meet the force and are 4/pi too late.
static void corrected_dynamics_meets_the_peak_of_a_half_oscillation(void **state)
{
    (void)state;
    parameters p = corrected_with(HUB_RIGID);
    p.arm.link_inertia = 0;
    p.arm.k2 = 5000;
    p.motor.voltage = p.motor.stiction = p.motor.viscous_friction = p.motor.back_emf = 0;
    three_body_state s = {{0.1, 0.1, 0.1}, {0.8, 0.8, 0.8}};
    double u = p.arm.mass / 2 * 0.0625, inertia = p.arm.hub_inertia, after[3], impulse;
    assert_int_equal(predict_velocity_jump(&p, &s, after, &impulse, NULL), STATUS_OK);
    double frequency = sqrt(4 * p.arm.k2 / (inertia + 2 * u));
    double peak = after[1] * (p.arm.k2 * 2 / frequency + u * frequency) / 0.5;
    prediction out, quadratic;
    assert_int_equal(predict_impact_dynamics(&p, &s, &out, NULL), STATUS_OK);
    assert_true(out.holds);
    check_relative(out.force, peak, 1e-9);
    check_relative(out.delay, 4 / M_PI * M_PI / 2 / frequency, 1e-9);
    check_close(out.impulse, impulse, 0);
    assert_int_equal(predict_impact_quadratic(&p, &s, &quadratic, NULL), STATUS_OK);
    check_close(quadratic.force, out.force, 0);
}

static void a_stiff_hub_spring_predicts_like_a_rigid_hub(void **state)
{
    (void)state;
    unsigned seed = 9;
    parameters rigid = corrected_with(HUB_RIGID), spring = corrected_with(HUB_SPRING);
    // without hub inertia the velocity jumps agree as well
    rigid.arm.hub_inertia = spring.arm.hub_inertia = 1e-9;
    for (int trial = 0; trial < 20; trial++) {
        three_body_state s = state_at_wall(&rigid, &seed);
        s.angle[0] = s.angle[1] + (0.4377 - 0.045) / spring.arm.k1;
        prediction a, b;
        assert_int_equal(predict_impact_dynamics(&rigid, &s, &a, NULL), STATUS_OK);
        assert_int_equal(predict_impact_dynamics(&spring, &s, &b, NULL), STATUS_OK);
        check_relative(b.force, a.force, 0.01);
        check_relative(b.delay, a.delay, 0.01);
    }
}

static void prediction_does_not_depend_on_where_the_corrected_arm_stands(void **state)
{
    (void)state;
    unsigned seed = 10;
    for (int kind = WALL_POINT; kind <= WALL_PLANE; kind++) {
        parameters p = corrected_with(HUB_RIGID);
        p.wall.kind = kind;
        three_body_state near = state_at_wall(&p, &seed), far = near;
        for (int i = 0; i < 3; i++) {
            far.angle[i] -= 0.7;
        }
        prediction a, b;
        assert_int_equal(predict_impact_dynamics(&p, &near, &a, NULL), STATUS_OK);
        assert_int_equal(predict_impact_dynamics(&p, &far, &b, NULL), STATUS_OK);
        check_relative(a.force, b.force, 1e-9);
        assert_int_equal(predict_energy(&p, &near, &a, NULL), STATUS_OK);
        assert_int_equal(predict_energy(&p, &far, &b, NULL), STATUS_OK);
        check_relative(a.force, b.force, 1e-9);
    }
}

typedef status (*predictor)(const parameters *, const three_body_state *, prediction *, fault *);
static const predictor predictors[3] = {predict_energy, predict_impact_dynamics,
                                        predict_impact_quadratic};

static void no_state_gives_garbage(void **state)
{
    (void)state;
    unsigned seed = 12;
    int held = 0;
    for (int trial = 0; trial < 3000; trial++) {
        parameters p = trial % 3 == 0   ? parameters_of(ARM_PRINTED)
                       : trial % 3 == 1 ? corrected_with(HUB_RIGID)
                                        : corrected_with(HUB_SPRING);
        p.arm.k2 *= pow(10, 1 + noise(&seed));
        p.arm.k1 *= pow(10, 2 * noise(&seed));
        p.motor.voltage = 10 * noise(&seed);
        p.wall.kind = trial % 5 == 0 ? WALL_NONE : trial % 2 && trial % 3 ? WALL_PLANE : WALL_POINT;
        three_body_state s;
        for (int i = 0; i < 3; i++) {
            s.angle[i] = 0.2 * noise(&seed);
            s.velocity[i] = 5 * noise(&seed);
        }
        // what a motor and a beam can bend the hub's joint by
        s.angle[0] = s.angle[1] + 10 * noise(&seed) / p.arm.k1;
        for (int i = 0; i < 3; i++) {
            prediction out;
            fault f = {.text = ""};
            if (predictors[i](&p, &s, &out, &f) != STATUS_OK) {
                fail_msg("trial %d, predictor %d: %s", trial, i, f.text);
            }
            if (out.holds) {
                held++;
                assert_true(out.force > 0 && out.force < 1e4);
                assert_true(i == 0 ? isnan(out.delay) : out.delay > 0 && out.delay <= 100);
                assert_true(i == 0 || out.impulse >= 0);
            }
        }
    }
    assert_true(held > 1000);
}

static void an_arm_that_moves_away_does_not_touch(void **state)
{
    (void)state;
    for (int model = ARM_CORRECTED; model <= ARM_PRINTED; model++) {
        parameters p = parameters_of((arm_model_kind)model);
        three_body_state s = {{0.1, 0.1, 0.1}, {-1, -1, -1}};
        for (int i = 0; i < 3; i++) {
            prediction out;
            assert_int_equal(predictors[i](&p, &s, &out, NULL), STATUS_OK);
            assert_false(out.holds);
        }
    }
}

// A link bent away from the wall by much springs back from it.
static void a_link_that_is_bent_forwards_loses_contact_at_once(void **state)
{
    (void)state;
    parameters p = corrected_with(HUB_RIGID);
    for (int i = 0; i < 3; i++) {
        three_body_state forwards = {{0.05, 0.05, 0.15}, {0.3, 0.3, 0.3}};
        three_body_state backwards = {{0.15, 0.15, 0.05}, {0.3, 0.3, 0.3}};
        prediction out;
        assert_int_equal(predictors[i](&p, &forwards, &out, NULL), STATUS_OK);
        assert_false(out.holds);
        assert_int_equal(predictors[i](&p, &backwards, &out, NULL), STATUS_OK);
        assert_true(out.holds);
    }
}

static void faster_hits_harder(void **state)
{
    (void)state;
    for (int model = ARM_CORRECTED; model <= ARM_PRINTED; model++) {
        parameters p = parameters_of((arm_model_kind)model);
        p.arm.k2 *= 10;
        for (int i = 0; i < 3; i++) {
            double last = 0;
            for (double speed = 0.5; speed < 4; speed += 0.5) {
                // bent backwards, so that back EMF does not pull it off the wall
                three_body_state s = {{0.11, 0.11, 0.09}, {speed, speed, speed}};
                prediction out;
                assert_int_equal(predictors[i](&p, &s, &out, NULL), STATUS_OK);
                assert_true(out.holds);
                check_below(last, out.force);
                last = out.force;
            }
        }
    }
}

static void more_links_are_predicted_as_the_two_link_arm(void **state)
{
    (void)state;
    parameters two = corrected_with(HUB_RIGID), many;
    parameters_defaults(&many, ARM_CORRECTED);
    assert_int_equal(parameter_set_number(&many, PARAMETER_INDEX(arm.links), 12, NULL), STATUS_OK);
    assert_int_equal(parameters_resolve(&many, NULL), STATUS_OK);
    three_body_state s = {{0.1, 0.1, 0.1}, {1, 1, 1}};
    for (int i = 0; i < 3; i++) {
        prediction a, b;
        assert_int_equal(predictors[i](&two, &s, &a, NULL), STATUS_OK);
        assert_int_equal(predictors[i](&many, &s, &b, NULL), STATUS_OK);
        check_relative(b.force, a.force, 1e-12);
    }
}

static void a_state_that_is_not_finite_is_refused(void **state)
{
    (void)state;
    parameters p = parameters_of(ARM_CORRECTED);
    three_body_state s = {{0.1, 0.1, 0.1}, {1, 1, (double)NAN}};
    for (int i = 0; i < 3; i++) {
        prediction out;
        fault f = {.text = ""};
        assert_int_equal(predictors[i](&p, &s, &out, &f), STATUS_NOT_FINITE);
        assert_non_null(strstr(f.text, "second link's velocity"));
        assert_false(out.holds);
    }

    // an angle, and the velocities alone after an impact
    fault f = {.text = ""};
    double after[3], impulse;
    s = (three_body_state){{0.1, (double)INFINITY, 0.1}, {1, 1, 1}};
    assert_int_equal(predict_velocity_jump(&p, &s, after, &impulse, &f), STATUS_NOT_FINITE);
    assert_non_null(strstr(f.text, "first link's angle is inf"));
}

// A state too fast for its impulse to be a number is said to have none.
static void an_impact_without_a_finite_impulse_is_refused(void **state)
{
    (void)state;
    const three_body_state s = {{0.1, 0.1, 0.1}, {1e308, 1e308, 1.5e308}};
    for (int model = ARM_CORRECTED; model <= ARM_PRINTED; model++) {
        parameters p = parameters_of((arm_model_kind)model);
        p.arm.mass = 1000;
        double after[3], impulse;
        fault f = {.text = ""};
        assert_int_equal(predict_velocity_jump(&p, &s, after, &impulse, &f), STATUS_SINGULAR);
        assert_non_null(strstr(f.text, "no single impulse"));
        for (int i = 0; i < 3; i++) {
            prediction out;
            assert_int_equal(predictors[i](&p, &s, &out, &f), STATUS_SINGULAR);
            assert_false(out.holds);
        }
    }
}

// Joints damped beyond the critical give no energy back.
static void an_overdamped_arm_gives_no_energy_back(void **state)
{
    (void)state;
    parameters p = corrected_with(HUB_RIGID), plain = p;
    p.arm.damping_ratio = 4;
    const three_body_state s = {{0.11, 0.11, 0.09}, {1, 1, 1}};
    prediction damped, free;
    assert_int_equal(predict_energy(&p, &s, &damped, NULL), STATUS_OK);
    assert_int_equal(predict_energy(&plain, &s, &free, NULL), STATUS_OK);
    check_below(damped.force, free.force);
    assert_true(isfinite(damped.force));
}

// --- the corrected arm of two links, derived anew ------------------------------------------------

// Masses of both links' angles and levers of a force on the tip's side at a bend, hub included
// where it is one body with the first link.
typedef struct links {
    double m22, m23, m33; // [kg m2]
    double j2, j3;        // the way that the contact point makes by each angle [m]
    double i1;            // the hub's own [kg m2]
} links;

static links links_of(const parameters *p, double bend)
{
    const double l = p->arm.length / 2, m = p->arm.mass / 2, e = l / 2, in = p->arm.link_inertia;
    const bool rigid = p->arm.hub_joint == HUB_RIGID;
    links a = {.m22 = m * (e * e + l * l) + in + (rigid ? p->arm.hub_inertia : 0),
               .m23 = m * l * e * cos(bend),
               .m33 = m * e * e + in,
               .i1 = rigid ? 0 : p->arm.hub_inertia};
    if (p->wall.kind == WALL_PLANE) {
        a.j2 = a.j3 = l * cos(bend / 2);
    } else {
        // the point of the second link that is a beam's length away from the hub
        a.j2 = l * cos(bend);
        a.j3 = -l * cos(bend) + sqrt(l * l * cos(bend) * cos(bend) + 3 * l * l);
    }
    return a;
}

// The drive that the motor leaves when the hub turns at w.
static double drive_of(const parameters *p, double w, double *damping)
{
    const motor_parameters *m = &p->motor;
    const double per_volt = m->amplifier_gain * m->torque_constant / m->resistance;
    *damping = m->viscous_friction + m->torque_constant * m->back_emf / m->resistance;
    return per_volt * m->voltage - m->stiction * ((w > 0) - (w < 0));
}

// An arm of other lengths, masses and motors, moving any way.
static parameters any_arm(int trial, unsigned *seed, three_body_state *s)
{
    parameters p = corrected_with(trial % 2 ? HUB_SPRING : HUB_RIGID);
    p.wall.kind = trial % 4 < 2 ? WALL_POINT : WALL_PLANE;
    p.arm.length *= 1 + 0.4 * noise(seed);
    p.arm.mass *= 1 + 0.4 * noise(seed);
    p.arm.link_inertia *= 2 + noise(seed);
    p.arm.hub_inertia *= 1 + 0.5 * noise(seed);
    p.arm.k1 *= 1 + 0.5 * noise(seed);
    p.arm.k2 *= pow(10, 0.5 + 0.5 * noise(seed));
    p.motor.voltage = 1.5 * noise(seed);
    p.motor.stiction = 0.05 * (1 + noise(seed));
    for (int i = 0; i < 3; i++) {
        s->angle[i] = 0.1 + 0.08 * noise(seed);
        s->velocity[i] = trial % 8 == 7 ? 0 : 2 * noise(seed);
    }
    return p;
}

// Energy of all bodies, shared by the springs in series; then both links rest, bent back, and the
// wall's force is what the drive and the spring press with.
static double energy_force(const parameters *p, const three_body_state *s)
{
    const bool rigid = p->arm.hub_joint == HUB_RIGID;
    const double w[3] = {s->velocity[rigid ? 1 : 0], s->velocity[1], s->velocity[2]};
    const double bend = s->angle[2] - s->angle[1], hub_bend = s->angle[1] - s->angle[0];
    double energy = kinetic_energy(p, s->angle, w) + 0.5 * p->arm.k2 * bend * bend +
                    (rigid ? 0 : 0.5 * p->arm.k1 * hub_bend * hub_bend);

    // what an oscillator with the damping of the beam keeps until it is bent most
    if (p->arm.damping_ratio > 0) {
        const links a = links_of(p, bend);
        const double turn = -a.j2 / a.j3, mass = a.m22 + 2 * a.m23 * turn + a.m33 * turn * turn;
        const double square = p->arm.k2 * (turn - 1) * (turn - 1) / mass;
        const double d = square * p->arm.damping_ratio / sqrt(p->arm.k2 / a.m33);
        const double rate = w[2] - w[1], frequency = sqrt(square - d * d);
        const double angle = atan(fabs(rate / (frequency * bend)));
        energy *= exp(-2 * d / frequency * (rate * bend > 0 ? angle : M_PI - angle));
    }

    // the softer spring takes more of it
    const double share = rigid ? 1 : p->arm.k1 / (p->arm.k1 + p->arm.k2);
    const double most = sqrt(2 * energy * share / p->arm.k2);
    const double hub_most = sqrt(2 * energy * (1 - share) / p->arm.k1);
    const links a = links_of(p, -most);
    double damping, drive = drive_of(p, w[0], &damping);
    drive = rigid ? drive : p->arm.k1 * hub_most;

    // along the wall nothing but the drive and the spring acts
    const double k = p->arm.k2 * most, turn = -a.j2 / a.j3;
    const double mass = a.m22 + 2 * a.m23 * turn + a.m33 * turn * turn;
    const double acceleration = (drive - k + turn * k) / mass;
    return (k - (a.m23 + a.m33 * turn) * acceleration) / a.j3;
}

static void energy_of_any_state_is_shared_by_the_springs(void **state)
{
    (void)state;
    unsigned seed = 21;
    for (int trial = 0; trial < 400; trial++) {
        three_body_state s;
        parameters p = any_arm(trial, &seed, &s);
        p.arm.damping_ratio = trial % 3 == 0 && trial % 8 != 7 ? 0.05 * (1.1 + noise(&seed)) : 0;
        prediction out;
        assert_int_equal(predict_energy(&p, &s, &out, NULL), STATUS_OK);
        check_relative(out.force, energy_force(&p, &s), 1e-9);
        assert_true(isnan(out.delay) && isnan(out.impulse) && isnan(out.restitution));
    }
}

// Without any oscillation to speak of, more than critically damped, no energy is left.
static void what_only_creeps_keeps_no_energy(void **state)
{
    (void)state;
    unsigned seed = 23;
    three_body_state s;
    parameters p = any_arm(0, &seed, &s);
    p.arm.damping_ratio = 5;
    prediction out;
    assert_int_equal(predict_energy(&p, &s, &out, NULL), STATUS_OK);

    // the drive alone, with a straight arm
    const links a = links_of(&p, 0);
    double damping;
    const double drive = drive_of(&p, s.velocity[1], &damping), turn = -a.j2 / a.j3;
    const double mass = a.m22 + 2 * a.m23 * turn + a.m33 * turn * turn;
    check_relative(out.force, -(a.m23 + a.m33 * turn) * drive / mass / a.j3, 1e-9);
}

// The energy predictor of the listing: its masses and its levers, (4.28), (4.29), (4.34).
static void listed_energy_of_any_state(void **state)
{
    (void)state;
    unsigned seed = 22;
    for (int trial = 0; trial < 200; trial++) {
        three_body_state s;
        const parameters other = any_arm(trial, &seed, &s);
        parameters p = parameters_of(ARM_PRINTED);
        p.arm.length = other.arm.length, p.arm.mass = other.arm.mass;
        p.arm.link_inertia = other.arm.link_inertia, p.arm.hub_inertia = other.arm.hub_inertia;
        p.arm.k2 = other.arm.k2, p.motor.voltage = other.motor.voltage;
        p.printed.energy_cross_term = trial % 2;

        // I2 and I3 left out, and one length too many or not
        const double l = p.arm.length / 2, e = l / 2, m = p.arm.mass / 2, *w = s.velocity;
        const double b = s.angle[2] - s.angle[1], cross = trial % 2 ? e : 2 * l * e;
        const double twice = p.arm.hub_inertia * w[0] * w[0] +
                             m * e * e * (w[1] * w[1] + w[2] * w[2]) + m * l * l * w[1] * w[1] +
                             m * cross * w[1] * w[2] * cos(b) + p.arm.k2 * b * b;

        // (m22 + m23) a + l (1 + c) f = S - k d, (m32 - c m33) ... with l (c a2 + a3) = 0
        double damping;
        p.motor.stiction = 0;
        const double d = sqrt(twice / p.arm.k2), c = cos(d), drive = drive_of(&p, 1, &damping);
        const double m33 = m * e * e + p.arm.link_inertia, m23 = m * l * e * c;
        const double m22 = m33 + m * l * l;
        const double both = m22 + m23 - c * (m33 + m23), last = m23 - c * m33, k = p.arm.k2 * d;
        const double force = (both * k - last * (drive - k)) / (both * l - last * l * (1 + c));
        prediction out;
        assert_int_equal(predict_energy(&p, &s, &out, NULL), STATUS_OK);
        check_relative(out.force, force, 1e-9);
    }
}

// What (4.20)-(4.22) leave of the corrected arm at a delay, force and hub velocity from the others.
typedef struct motion_left {
    double left;  // balance of both links [N m s]
    double force; // [N]
    double hub;   // [rad/s]
} motion_left;

static motion_left left_at(const parameters *p, const three_body_state *s, const double after[3],
                           double T)
{
    const bool rigid = p->arm.hub_joint == HUB_RIGID;
    const double d1 = s->angle[1] - s->angle[0], d2 = s->angle[2] - s->angle[1];
    const links a = links_of(p, d2);
    double damping;
    const double drive = drive_of(p, s->velocity[rigid ? 1 : 0], &damping);
    const double w2 = after[1], w3 = after[2];
    const double both = (a.m22 + a.m23) * w2 + (a.m23 + a.m33) * w3;
    const double last = a.m23 * w2 + a.m33 * w3;
    const double spring = p->arm.k2 * (T * d2 + T * T * (w3 - w2) / 4);
    motion_left out = {.force = 2 * (last - spring) / (T * a.j3), .hub = w2};
    double hub_spring = -drive * T + damping * T * w2 / 2;
    if (!rigid) {
        const double k1 = p->arm.k1;
        out.hub = (T * (k1 * d1 + drive) + T * T * k1 * w2 / 4) /
                  (k1 * T * T / 4 + damping * T / 2 - a.i1);
        hub_spring = k1 * T * d1 + k1 * T * T * (w2 - out.hub) / 4;
    }
    out.left = hub_spring - both + (a.j2 + a.j3) * T * out.force / 2;
    return out;
}

static void corrected_dynamics_solves_its_equations(void **state)
{
    (void)state;
    unsigned seed = 24;
    int found = 0, none = 0;
    for (int trial = 0; trial < 400; trial++) {
        three_body_state s;
        parameters p = any_arm(trial, &seed, &s);
        prediction out, quadratic;
        double after[3], impulse;
        assert_int_equal(predict_velocity_jump(&p, &s, after, &impulse, NULL), STATUS_OK);
        assert_int_equal(predict_impact_dynamics(&p, &s, &out, NULL), STATUS_OK);
        check_close(out.impulse, impulse, 0);

        // every delay at which the balance changes its sign, but for where the hub's has a pole
        double best = HUGE_VAL, delay = (double)NAN, before = 1e-9;
        const bool rigid = p.arm.hub_joint == HUB_RIGID;
        for (double T = 1.01e-9; T < 100; before = T, T *= 1.006) {
            double low = before, high = T;
            const double sign = left_at(&p, &s, after, low).left;
            if (sign * left_at(&p, &s, after, high).left > 0) {
                continue;
            }
            for (int i = 0; i < 80; i++) {
                const double middle = (low + high) / 2;
                *(left_at(&p, &s, after, middle).left * sign > 0 ? &low : &high) = middle;
            }
            const motion_left at = left_at(&p, &s, after, low);
            const double away = rigid ? low : fabs(at.hub - s.velocity[0]);
            if (fabs(at.left) < 1e-6 && (rigid || at.force > 0) && away < best) {
                best = away;
                delay = low;
            }
        }
        if (isnan(delay)) {
            none++;
            assert_false(out.holds);
        } else if (fabs(delay - out.delay) > 1e-6 * delay) {
            fail_msg("trial %d: delay %.9g, expected %.9g", trial, out.delay, delay);
        } else {
            found++;
            check_close(out.force, left_at(&p, &s, after, delay).force,
                        1e-4 * (1 + fabs(out.force)));
            assert_true(!out.holds || (impulse >= 0 && out.force > 0));
        }

        // the quadratic form is that of a rigid hub, whatever the hub
        assert_int_equal(predict_impact_quadratic(&p, &s, &quadratic, NULL), STATUS_OK);
        p.arm.hub_joint = HUB_RIGID;
        assert_int_equal(predict_impact_dynamics(&p, &s, &out, NULL), STATUS_OK);
        assert_true(quadratic.force == out.force || (isnan(quadratic.force) && isnan(out.force)));
        assert_int_equal(quadratic.holds, out.holds);
    }
    assert_true(found > 200 && none > 0);
}

// The printed quadratic form: the hub jumps with the first link, (4.21) and (4.22) remain.
static void the_printed_quadratic_form_solves_two_of_the_equations(void **state)
{
    (void)state;
    unsigned seed = 25;
    int found = 0;
    for (int trial = 0; trial < 200; trial++) {
        parameters p = parameters_of(ARM_PRINTED);
        p.arm.k2 *= pow(10, 1 + noise(&seed));
        p.printed.spring_counted_twice = trial % 2;
        const three_body_state s = state_at_wall(&p, &seed);
        prediction out;
        double after[3], impulse;
        assert_int_equal(predict_velocity_jump(&p, &s, after, &impulse, NULL), STATUS_OK);
        assert_int_equal(predict_impact_quadratic(&p, &s, &out, NULL), STATUS_OK);
        if (!out.holds) {
            continue;
        }

        // with all that jumps, the hub's angle is its bend away
        const double l = 0.5, u = p.arm.mass / 2 * 0.0625, w2 = after[1], w3 = after[2];
        const double w1 = s.velocity[0] + w2 - s.velocity[1], T = out.delay, f = out.force;
        const double d1 = s.angle[1] - s.angle[0], d2 = s.angle[2] - s.angle[1];
        const double spring1 = p.arm.k1 * T * (d1 + T / 4 * (w2 - w1));
        const double spring2 = p.arm.k2 * T * (d2 + T / 4 * (w3 - w2));
        check_close(spring1 - (trial % 2) * spring2 - 7 * u * w2 - 3 * u * w3 +
                        T / 2 * l * (1 + cos(d2)) * f,
                    0, 1e-9);
        check_close(spring2 + T / 2 * l * f - 2 * u * cos(d2) * w2 - (u + p.arm.link_inertia) * w3,
                    0, 1e-9);
        found++;
    }
    assert_true(found > 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(springs_share_energy_by_their_compliance),
        cmocka_unit_test(energy_of_a_small_bend_can_be_computed_by_hand),
        cmocka_unit_test(damping_takes_its_share_of_the_energy),
        cmocka_unit_test(energy_cross_term_makes_no_difference_at_half_a_metre_only),
        cmocka_unit_test(energy_of_any_state_is_shared_by_the_springs),
        cmocka_unit_test(what_only_creeps_keeps_no_energy),
        cmocka_unit_test(listed_energy_of_any_state),
        cmocka_unit_test(corrected_dynamics_solves_its_equations),
        cmocka_unit_test(the_printed_quadratic_form_solves_two_of_the_equations),
        cmocka_unit_test(impact_stops_the_contact_point),
        cmocka_unit_test(plastic_impact_loses_half_impulse_times_speed),
        cmocka_unit_test(printed_dynamics_solves_the_printed_equations),
        cmocka_unit_test(any_springs_solve_the_printed_equations),
        cmocka_unit_test(corrected_dynamics_meets_the_peak_of_a_half_oscillation),
        cmocka_unit_test(a_stiff_hub_spring_predicts_like_a_rigid_hub),
        cmocka_unit_test(prediction_does_not_depend_on_where_the_corrected_arm_stands),
        cmocka_unit_test(no_state_gives_garbage),
        cmocka_unit_test(an_arm_that_moves_away_does_not_touch),
        cmocka_unit_test(a_link_that_is_bent_forwards_loses_contact_at_once),
        cmocka_unit_test(faster_hits_harder),
        cmocka_unit_test(more_links_are_predicted_as_the_two_link_arm),
        cmocka_unit_test(a_state_that_is_not_finite_is_refused),
        cmocka_unit_test(an_impact_without_a_finite_impulse_is_refused),
        cmocka_unit_test(an_overdamped_arm_gives_no_energy_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
