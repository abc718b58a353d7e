#include "tests/three_body_states.h"

// (3.12): rate at which the contact point comes through the second link's line.
static double penetration_rate(const parameters *p, const double q[3], const double w[3])
{
    double l = p->arm.length / 2, c = cos(q[2] - q[1]);
    double a = 2 * l * cos(p->wall.angle), b = 2 * l * sin(p->wall.angle);
    return l * c * w[1] + (a * cos(q[2]) + b * sin(q[2]) - l * c) * w[2];
}

typedef status (*predictor)(const parameters *, const three_body_state *, prediction *,
                            fault *);
static const predictor predictors[3] = {predict_energy, predict_impact_dynamics,
                                        predict_impact_quadratic};

static prediction predicted(predictor which, const parameters *p,
                            const three_body_state *s)
{
    prediction out;
    DONE(which(p, s, &out, &f));
    return out;
}

// The impulse of an impact, and the velocities after it.
static double impulse_of(const parameters *p, const three_body_state *s, double after[3])
{
    double impulse;
    DONE(predict_velocity_jump(p, s, after, &impulse, &f));
    return impulse;
}

TEST(springs_share_energy_by_their_compliance)
{
    const double k[3] = {1, 3, 6}; // compliances 6 : 2 : 1
    double deflection[3], energy = 0;
    quasi_principle_deflections(3, k, 9, deflection);
    check_close(0.5 * k[0] * deflection[0] * deflection[0], 6, 1e-12);
    check_close(0.5 * k[1] * deflection[1] * deflection[1], 2, 1e-12);
    check_close(0.5 * k[2] * deflection[2] * deflection[2], 1, 1e-12);
    // springs in series carry one torque
    for (int i = 0; i < 3; i++) {
        check_close(k[i] * deflection[i], k[0] * deflection[0], 1e-12);
        energy += 0.5 * k[i] * deflection[i] * deflection[i];
    }
    check_close(energy, 9, 1e-12);
}

// Links without inertia of their own, at rest, bent by a small D: all masses are
// multiples of u = m e^2, cosines are 1, the levers 2l and l, and the second link turns
// against the first.
TEST(energy_of_a_small_bend_can_be_computed_by_hand)
{
    const double D = 1e-4;
    three_body_state s = {{0.1 + D / 2, 0.1 + D / 2, 0.1 - D / 2}, {0, 0, 0}};

    // printed: 4u a + 2l f = S - k D, u a + l f = k D, so l f = (5 k D - S) / 2
    parameters p = defaults_of(ARM_PRINTED);
    p.arm.link_inertia = 0;
    p.motor.voltage = 1e-3;
    double u = p.arm.mass / 2 * 0.0625, torque = 0.4377e-3, k = p.arm.k2;
    prediction out = predicted(predict_energy, &p, &s);
    check_close(out.force, (5 * k * D - torque) / 2 / 0.5, 1e-6);
    assert_true(isnan(out.delay) && isnan(out.impulse));

    // corrected, rigid hub: (I1 + 4u) a + 2l f = S, u a + l f = k D, no friction at rest
    p = corrected_with(HUB_RIGID);
    p.arm.link_inertia = 0;
    p.motor.voltage = 1e-3;
    double a = (torque - 2 * k * D) / (p.arm.hub_inertia + 2 * u);
    out = predicted(predict_energy, &p, &s);
    check_close(out.force, (k * D - u * a) / 0.5, 1e-6);
}

// 4.3 on damping: a straight arm that strikes with no drive bends for a quarter of a
// period, in which the oscillator with mass I1 + 2u and stiffness 4 k2 loses exp(-pi d /
// w) of its energy.
TEST(damping_takes_its_share_of_the_energy)
{
    const double ratio = 0.02;
    three_body_state s = {{0.1, 0.1, 0.1}, {1e-4, 1e-4, 1e-4}};
    parameters p = corrected_with(HUB_RIGID);
    p.arm.link_inertia = 0;
    p.motor.voltage = p.motor.stiction = 0;
    const prediction undamped = predicted(predict_energy, &p, &s);
    s.velocity[2] = 1e-4 + 1e-12; // bends from here on
    p.arm.damping_ratio = ratio;
    const prediction damped = predicted(predict_energy, &p, &s);

    double u = p.arm.mass / 2 * 0.0625,
           square = 4 * p.arm.k2 / (p.arm.hub_inertia + 2 * u);
    double d = square * ratio / sqrt(p.arm.k2 / u), w = sqrt(square - d * d);
    check_relative(damped.force, undamped.force * exp(-M_PI_2 * d / w), 1e-4);
}

TEST(energy_cross_term_makes_no_difference_at_half_a_metre_only)
{
    unsigned seed = 2;
    for (int longer = 0; longer <= 1; longer++) {
        parameters listed = defaults_of(ARM_PRINTED), meant;
        listed.arm.length = longer ? 1.4 : 1;
        meant = listed;
        meant.printed.energy_cross_term = false;
        three_body_state s = state_at_wall(&listed, &seed);
        const prediction a = predicted(predict_energy, &listed, &s);
        const prediction b = predicted(predict_energy, &meant, &s);
        if (longer) {
            check_below(a.force, b.force);
        } else {
            check_close(a.force, b.force, 1e-12);
        }
    }
}

TEST(impact_stops_the_contact_point)
{
    unsigned seed = 4;
    for (int trial = 0; trial < 60; trial++) {
        parameters p = trial % 3 == 0   ? defaults_of(ARM_PRINTED)
                       : trial % 3 == 1 ? corrected_with(HUB_RIGID)
                                        : corrected_with(HUB_SPRING);
        three_body_state s = state_at_wall(&p, &seed);
        double after[3], impulse = impulse_of(&p, &s, after);
        assert_true(impulse > 0);
        assert_true(penetration_rate(&p, s.angle, s.velocity) > 0);
        // the corrected form has the contact point on the arm, second order in the bend
        // from (a, b)
        check_close(penetration_rate(&p, s.angle, after), 0,
                    trial % 3 == 0 ? 1e-14 : 1e-4);
        if (trial % 3 != 1) {
            check_close(after[0], s.velocity[0], 0);
        } else {
            check_close(after[0], after[1], 0);
        }
    }
}

TEST(plastic_impact_loses_half_impulse_times_speed)
{
    unsigned seed = 6;
    for (int trial = 0; trial < 20; trial++) {
        parameters p = corrected_with(trial % 2 ? HUB_SPRING : HUB_RIGID);
        three_body_state s = state_at_wall(&p, &seed);
        double after[3], impulse = impulse_of(&p, &s, after);
        double loss =
            kinetic_energy(&p, s.angle, s.velocity) - kinetic_energy(&p, s.angle, after);
        assert_true(loss > 0);
        check_relative(loss, 0.5 * impulse * penetration_rate(&p, s.angle, s.velocity),
                       1e-3);
    }
}

// What (4.20)-(4.22) leave over at a prediction; the hub's velocity is taken from (4.20).
static void thesis_equations(const parameters *p, const three_body_state *s,
                             const prediction *out, double left[2])
{
    double l = 0.5, T = out->delay, f = out->force, u = p->arm.mass / 2 * 0.0625;
    double after[3], impulse, d1 = s->angle[1] - s->angle[0],
                              d2 = s->angle[2] - s->angle[1];
    double kt = p->motor.torque_constant, ra = p->motor.resistance;
    double load = p->motor.amplifier_gain * kt / ra * p->motor.voltage;
    double kv = p->motor.viscous_friction + kt * p->motor.back_emf / ra;
    assert_int_equal(predict_velocity_jump(p, s, after, &impulse, NULL), STATUS_OK);
    double w2 = after[1], w3 = after[2];
    double w1 = (load * T - p->motor.stiction * T + p->arm.k1 * T * (d1 + T / 4 * w2)) /
                (p->arm.k1 * T * T / 4 - p->arm.hub_inertia + kv * T / 2);
    double spring1 = p->arm.k1 * T * (d1 + T / 4 * (w2 - w1));
    double spring2 = p->arm.k2 * T * (d2 + T / 4 * (w3 - w2));
    left[0] =
        -spring2 + spring1 - 7 * u * w2 - 3 * u * w3 + T / 2 * l * (1 + cos(d2)) * f;
    left[1] =
        spring2 + T / 2 * l * f - 2 * u * cos(d2) * w2 - (u + p->arm.link_inertia) * w3;
}

TEST(printed_dynamics_solves_the_printed_equations)
{
    unsigned seed = 8;
    int held = 0;
    for (int trial = 0; trial < 60; trial++) {
        const double factor[3] = {1, 10, 100};
        parameters p = defaults_of(ARM_PRINTED);
        p.arm.k2 *= factor[trial % 3];
        three_body_state s = state_at_wall(&p, &seed);
        const prediction out = predicted(predict_impact_dynamics, &p, &s);
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

// Hubs and beams far softer and stiffer than the thesis's: what is predicted solves the
// equations, and what has no solution nearby is said to have none.
TEST(any_springs_solve_the_printed_equations)
{
    unsigned seed = 12;
    int held = 0;
    for (int trial = 0; trial < 4000; trial++) {
        parameters p = defaults_of(ARM_PRINTED);
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

// Hub and first link one body, straight beam, no motor, no friction: after the impact the
// beam swings with d = -2 theta2, (I1 + 2u) theta2'' = -4 k theta2 for small bends, u = m
// e^2. Its first peak is known; the thesis's assumptions meet the force and are 4/pi too
// late.
TEST(corrected_dynamics_meets_the_peak_of_a_half_oscillation)
{
    parameters p = corrected_with(HUB_RIGID);
    p.arm.link_inertia = 0;
    p.arm.k2 = 5000;
    p.motor.voltage = p.motor.stiction = p.motor.viscous_friction = p.motor.back_emf = 0;
    three_body_state s = {{0.1, 0.1, 0.1}, {0.8, 0.8, 0.8}};
    double u = p.arm.mass / 2 * 0.0625, inertia = p.arm.hub_inertia, after[3], impulse;
    assert_int_equal(predict_velocity_jump(&p, &s, after, &impulse, NULL), STATUS_OK);
    double frequency = sqrt(4 * p.arm.k2 / (inertia + 2 * u));
    double peak = after[1] * (p.arm.k2 * 2 / frequency + u * frequency) / 0.5;
    const prediction out = predicted(predict_impact_dynamics, &p, &s);
    assert_true(out.holds);
    check_relative(out.force, peak, 1e-9);
    check_relative(out.delay, 4 / M_PI * M_PI / 2 / frequency, 1e-9);
    check_close(out.impulse, impulse, 0);
    const prediction quadratic = predicted(predict_impact_quadratic, &p, &s);
    check_close(quadratic.force, out.force, 0);
}

TEST(a_stiff_hub_spring_predicts_like_a_rigid_hub)
{
    unsigned seed = 9;
    parameters rigid = corrected_with(HUB_RIGID), spring = corrected_with(HUB_SPRING);
    // without hub inertia the velocity jumps agree as well
    rigid.arm.hub_inertia = spring.arm.hub_inertia = 1e-9;
    for (int trial = 0; trial < 20; trial++) {
        three_body_state s = state_at_wall(&rigid, &seed);
        s.angle[0] = s.angle[1] + (0.4377 - 0.045) / spring.arm.k1;
        const prediction a = predicted(predict_impact_dynamics, &rigid, &s);
        const prediction b = predicted(predict_impact_dynamics, &spring, &s);
        check_relative(b.force, a.force, 0.01);
        check_relative(b.delay, a.delay, 0.01);
    }
}

TEST(prediction_does_not_depend_on_where_the_corrected_arm_stands)
{
    unsigned seed = 10;
    for (int kind = WALL_POINT; kind <= WALL_PLANE; kind++) {
        parameters p = corrected_with(HUB_RIGID);
        p.wall.kind = kind;
        three_body_state near = state_at_wall(&p, &seed), far = near;
        for (int i = 0; i < 3; i++) {
            far.angle[i] -= 0.7;
        }
        prediction a = predicted(predict_impact_dynamics, &p, &near);
        prediction b = predicted(predict_impact_dynamics, &p, &far);
        check_relative(a.force, b.force, 1e-9);
        a = predicted(predict_energy, &p, &near);
        b = predicted(predict_energy, &p, &far);
        check_relative(a.force, b.force, 1e-9);
    }
}

// The arm of a trial: the printed one, or the corrected one on a rigid hub or a spring.
static parameters arm_of_trial(int trial)
{
    if (trial % 3 == 0) {
        return defaults_of(ARM_PRINTED);
    }
    if (trial % 3 == 1) {
        return corrected_with(HUB_RIGID);
    }
    return corrected_with(HUB_SPRING);
}

static int wall_of_trial(int trial)
{
    if (trial % 5 == 0) {
        return WALL_NONE;
    }
    if (trial % 2 != 0 && trial % 3 != 0) {
        return WALL_PLANE;
    }
    return WALL_POINT;
}

// What a predictor says of any arm in any state is possible: a force above zero and below
// 10 kN and, by all but the first, which knows neither, a delay up to 100 s and an
// impulse that pushes.
TEST(no_state_gives_garbage)
{
    unsigned seed = 12;
    int held = 0;
    for (int trial = 0; trial < 3000; trial++) {
        // the arm
        parameters p = arm_of_trial(trial);
        p.arm.k2 *= pow(10, 1 + noise(&seed));
        p.arm.k1 *= pow(10, 2 * noise(&seed));
        p.motor.voltage = 10 * noise(&seed);
        p.wall.kind = wall_of_trial(trial);

        // its state; the hub's joint bends by no more than a motor and a beam can bend it
        three_body_state s;
        for (int i = 0; i < 3; i++) {
            s.angle[i] = 0.2 * noise(&seed);
            s.velocity[i] = 5 * noise(&seed);
        }
        s.angle[0] = s.angle[1] + 10 * noise(&seed) / p.arm.k1;

        // the predictions
        for (int i = 0; i < 3; i++) {
            const prediction out = predicted(predictors[i], &p, &s);
            if (!out.holds) {
                continue;
            }
            held++;
            assert_true(out.force > 0 && out.force < 1e4);
            if (i == 0) {
                assert_true(isnan(out.delay));
            } else {
                assert_true(out.delay > 0 && out.delay <= 100);
                assert_true(out.impulse >= 0);
            }
        }
    }
    assert_true(held > 1000);
}

TEST(an_arm_that_moves_away_does_not_touch)
{
    for (int model = ARM_CORRECTED; model <= ARM_PRINTED; model++) {
        parameters p = defaults_of((arm_model_kind)model);
        three_body_state s = {{0.1, 0.1, 0.1}, {-1, -1, -1}};
        for (int i = 0; i < 3; i++) {
            const prediction out = predicted(predictors[i], &p, &s);
            assert_false(out.holds);
        }
    }
}

// A link bent away from the wall by much springs back from it.
TEST(a_link_that_is_bent_forwards_loses_contact_at_once)
{
    parameters p = corrected_with(HUB_RIGID);
    for (int i = 0; i < 3; i++) {
        three_body_state forwards = {{0.05, 0.05, 0.15}, {0.3, 0.3, 0.3}};
        three_body_state backwards = {{0.15, 0.15, 0.05}, {0.3, 0.3, 0.3}};
        prediction out = predicted(predictors[i], &p, &forwards);
        assert_false(out.holds);
        out = predicted(predictors[i], &p, &backwards);
        assert_true(out.holds);
    }
}

TEST(faster_hits_harder)
{
    for (int model = ARM_CORRECTED; model <= ARM_PRINTED; model++) {
        parameters p = defaults_of((arm_model_kind)model);
        p.arm.k2 *= 10;
        for (int i = 0; i < 3; i++) {
            double last = 0;
            for (double speed = 0.5; speed < 4; speed += 0.5) {
                // bent backwards, so that back EMF does not pull it off the wall
                three_body_state s = {{0.11, 0.11, 0.09}, {speed, speed, speed}};
                const prediction out = predicted(predictors[i], &p, &s);
                assert_true(out.holds);
                check_below(last, out.force);
                last = out.force;
            }
        }
    }
}

TEST(more_links_are_predicted_as_the_two_link_arm)
{
    const parameters two = corrected_with(HUB_RIGID), many = resolved("arm.links=12");
    three_body_state s = {{0.1, 0.1, 0.1}, {1, 1, 1}};
    for (int i = 0; i < 3; i++) {
        const prediction a = predicted(predictors[i], &two, &s);
        const prediction b = predicted(predictors[i], &many, &s);
        check_relative(b.force, a.force, 1e-12);
    }
}

// Equal links are the same arm whether a list says so or not, damping included.
TEST(a_list_of_equal_joints_changes_no_prediction)
{
    parameters plain, listed;
    parameters_defaults(&plain, ARM_CORRECTED);
    assert_int_equal(parameter_set_number(&plain, PARAMETER_INDEX(arm.links), 4, NULL),
                     STATUS_OK);
    plain.arm.damping_ratio = 0.1;
    listed = plain;
    assert_int_equal(parameter_set_text(&listed, PARAMETER_INDEX(arm.joint_stiffness),
                                        "9.84,9.84,9.84", NULL),
                     STATUS_OK);
    assert_int_equal(parameters_resolve(&plain, NULL), STATUS_OK);
    assert_int_equal(parameters_resolve(&listed, NULL), STATUS_OK);
    three_body_state s = {{0.1, 0.1, 0.1}, {1, 1, 1}};
    for (int i = 0; i < 3; i++) {
        prediction a, b;
        assert_int_equal(predictors[i](&plain, &s, &a, NULL), STATUS_OK);
        assert_int_equal(predictors[i](&listed, &s, &b, NULL), STATUS_OK);
        check_relative(b.force, a.force, 1e-12);
    }
}

TEST(a_state_that_is_not_finite_is_refused)
{
    parameters p = defaults_of(ARM_CORRECTED);
    three_body_state s = {{0.1, 0.1, 0.1}, {1, 1, (double)NAN}};
    for (int i = 0; i < 3; i++) {
        prediction out;
        REFUSED(STATUS_NOT_FINITE, "second link's velocity",
                predictors[i](&p, &s, &out, &f));
        assert_false(out.holds);
    }

    // an angle, and the velocities alone after an impact
    double after[3], impulse;
    s = (three_body_state){{0.1, (double)INFINITY, 0.1}, {1, 1, 1}};
    REFUSED(STATUS_NOT_FINITE, "first link's angle is inf",
            predict_velocity_jump(&p, &s, after, &impulse, &f));
}

// A state too fast for its impulse to be a number is said to have none.
TEST(an_impact_without_a_finite_impulse_is_refused)
{
    const three_body_state s = {{0.1, 0.1, 0.1}, {1e308, 1e308, 1.5e308}};
    for (int model = ARM_CORRECTED; model <= ARM_PRINTED; model++) {
        parameters p = defaults_of((arm_model_kind)model);
        p.arm.mass = 1000;
        double after[3], impulse;
        REFUSED(STATUS_SINGULAR, "no single impulse",
                predict_velocity_jump(&p, &s, after, &impulse, &f));
        for (int i = 0; i < 3; i++) {
            prediction out;
            REFUSED(STATUS_SINGULAR, "", predictors[i](&p, &s, &out, &f));
            assert_false(out.holds);
        }
    }
}

// Joints damped beyond the critical give no energy back.
TEST(an_overdamped_arm_gives_no_energy_back)
{
    parameters p = corrected_with(HUB_RIGID), plain = p;
    p.arm.damping_ratio = 4;
    const three_body_state s = {{0.11, 0.11, 0.09}, {1, 1, 1}};
    const prediction damped = predicted(predict_energy, &p, &s);
    const prediction free = predicted(predict_energy, &plain, &s);
    check_below(damped.force, free.force);
    assert_true(isfinite(damped.force));
}
