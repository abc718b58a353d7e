// The least time to the wanted force: its touch can be had, nothing does better, and limits that
// leave less take longer.
#include "src/base/random.h"
#include "src/predict/least_time.h"
#include "tests/arm_fixture.h"

#define START "initial.angle=-0.1", "wall.angle=0"

static least_time of(const char *const *settings, double force, double peak)
{
    parameters p = fixture_parameters(settings);
    return least_time_of(&p, force, 0.05, peak);
}

// The torque of the solution's multiplier: full either way, by the sign of what a step comes to.
static int torque_of(const parameters *p, const least_time *t, double *torque)
{
    const int n = (int)lround(t->touch / LEAST_TIME_STEP);
    const double most =
        motor_torque_per_volt(&p->motor) * p->motor.voltage_limit + p->motor.stiction;
    for (int k = 0; k < n; k++) {
        double kick[4000] = {0}, rest[2], kicked[2];
        least_time_follow(p, kick, n, &rest[0], &rest[1]);
        kick[k] = 1;
        least_time_follow(p, kick, n, &kicked[0], &kicked[1]);
        double press = kicked[1] - rest[1], tip = kicked[0] - rest[0];
        bool more = press - t->weight * tip > 0;
        torque[k] = more == t->largest ? most : -most;
    }
    return n;
}

static void full_voltage_either_way_has_it(void **state)
{
    (void)state;
    parameters p = fixture_parameters(SETTINGS(START));
    static const double forces[] = {0.5, 1, 4};
    for (int i = 0; i < 3; i++) {
        least_time t = least_time_of(&p, forces[i], 0.05, 2 * forces[i]);
        double torque[4000], tip, press;
        int n = torque_of(&p, &t, torque);
        least_time_follow(&p, torque, n, &tip, &press);

        // but for one step, whose torque lies between both
        check_below(t.slack, 1e-6);
        check_close(tip, 0, 1e-3);
        check_close(press, t.press, 0.2);
        assert_true(t.total >= t.touch);

        // the tip is nowhere further than at the end, so this touch is its first
        for (int k = 1; k < n; k++) {
            double on_the_way, unused;
            least_time_follow(&p, torque, k, &on_the_way, &unused);
            check_below(on_the_way, fmax(0, tip) + 1e-9);
        }
    }
}

// Weak duality: whatever the torque, K xi less the weighted tip is on this side of the solution's.
static void no_torque_does_better(void **state)
{
    (void)state;
    parameters p = fixture_parameters(SETTINGS(START));
    const double most = motor_torque_per_volt(&p.motor) * p.motor.voltage_limit + p.motor.stiction;
    least_time t = least_time_of(&p, 1, 0.05, 2);
    const int n = (int)lround(t.touch / LEAST_TIME_STEP);
    const double side = t.largest ? 1 : -1;
    random_generator r;
    random_seed(&r, 4);
    for (int trial = 0; trial < 300; trial++) {
        double torque[4000], tip, press, sign = 1;
        for (int k = 0; k < n; k++) {
            sign = random_uniform(&r) < 0.02 ? -sign : sign;
            torque[k] = sign * most * (trial % 2 == 0 ? 1 : random_uniform(&r));
        }
        least_time_follow(&p, torque, n, &tip, &press);
        check_below(side * (press - t.weight * tip), side * t.press + 1e-3 * fabs(t.weight));
    }
}

static void less_voltage_and_less_force_take_longer(void **state)
{
    (void)state;
    static const char *const volts[] = {"motor.voltage_limit=10", "motor.voltage_limit=5",
                                        "motor.voltage_limit=3", "motor.voltage_limit=2.5"};
    double before = 0;
    for (int i = 0; i < 4; i++) {
        double total = of(SETTINGS(START, volts[i]), 1, 1.5).total;
        check_below(before, total);
        before = total;
    }

    // twice the way takes longer too, a harder peak never
    assert_true(of(SETTINGS("initial.angle=-0.2", "wall.angle=0"), 1, 1.5).total >
                of(SETTINGS(START), 1, 1.5).total);
    assert_true(of(SETTINGS(START, volts[3]), 1, 4).total <=
                of(SETTINGS(START, volts[3]), 1, 1.05).total);
}

// A beam that hardly bends goes as one rod about the hub, braked by the motor: I w' = T - D w. A
// touch throws both links onto x' = (M11 - M22)/M w, (2.16) and (2.17), hub and first link one
// body.
static void a_stiff_arm_goes_as_a_rod(void **state)
{
    (void)state;
    enum { STEPS = 200 };
    parameters p = fixture_parameters(SETTINGS(START, "arm.k2=1000"));
    const double damping = motor_damping(&p.motor), most = 0.5;
    const double inertia = p.arm.hub_inertia + p.arm.mass * p.arm.length * p.arm.length / 3;
    double torque[STEPS], tip, press;
    for (int k = 0; k < STEPS; k++) {
        torque[k] = most;
    }
    least_time_follow(&p, torque, STEPS, &tip, &press);
    const double time = STEPS * LEAST_TIME_STEP, lag = inertia / damping;
    const double angle = most / damping * (time - lag * (1 - exp(-time / lag)));
    check_relative(tip + 0.1 * p.arm.length, angle * p.arm.length, 5e-3);

    pressed_arm_model m;
    assert_true(pressed_arm_model_of(&p, &m));
    const double rate = most / damping * (1 - exp(-time / lag));
    const double share =
        (p.arm.hub_inertia + p.arm.mass * p.arm.length * p.arm.length / 8) / m.inertia;
    check_relative(
        press, m.spring_force * (angle - 0.1) + sqrt(m.spring_force * m.mass_force) * share * rate,
        1e-2);
}

static void where_there_is_no_way_it_says_so(void **state)
{
    (void)state;
    assert_true(isnan(of(SETTINGS("arm.links=3", START), 1, 2).total));
    assert_true(isnan(of(SETTINGS("initial.angle=0", "wall.angle=0"), 1, 2).total));
    assert_true(isnan(of(SETTINGS(START), 0, 2).total));
    assert_true(
        isnan(of(SETTINGS(START, "motor.voltage_limit=0", "motor.stiction=0"), 1, 2).total));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(full_voltage_either_way_has_it),
        cmocka_unit_test(no_torque_does_better),
        cmocka_unit_test(less_voltage_and_less_force_take_longer),
        cmocka_unit_test(a_stiff_arm_goes_as_a_rod),
        cmocka_unit_test(where_there_is_no_way_it_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
