// The least time to the wanted force: its touch can be had, nothing does better, and
// limits that leave less take longer.

#include "src/arm/modes.h"
#include "src/base/dense.h"
#include "src/predict/least_time.h"
#include "tests/arm_fixture.h"

#define START "initial.angle=-0.1", "wall.angle=0"

static least_time of(const char *const *settings, double force, double peak)
{
    parameters p = fixture_parameters(settings);
    return least_time_of(&p, force, 0.05, peak);
}

// The torque of the solution's multiplier: full either way, by the sign of what a step
// comes to.
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

TEST(full_voltage_either_way_has_it)
{
    parameters p = fixture_parameters(SETTINGS(START));
    for (EACH_OF(double, c, 0.5, 1, 4)) {
        least_time t = least_time_of(&p, *c, 0.05, 2 * *c);
        double torque[4000], tip, press;
        int n = torque_of(&p, &t, torque);
        least_time_follow(&p, torque, n, &tip, &press);

        // except for one step with a torque between both
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

// Weak duality: for any torque, K xi less the weighted tip is on this side of the
// solution's.
TEST(no_torque_does_better)
{
    parameters p = fixture_parameters(SETTINGS(START));
    const double most =
        motor_torque_per_volt(&p.motor) * p.motor.voltage_limit + p.motor.stiction;
    least_time t = least_time_of(&p, 1, 0.05, 2);
    const int n = (int)lround(t.touch / LEAST_TIME_STEP);
    const double side = t.largest ? 1 : -1;
    random_generator r = seeded(4);
    for (int trial = 0; trial < 300; trial++) {
        double torque[4000], tip, press, sign = 1;
        for (int k = 0; k < n; k++) {
            sign = random_uniform(&r) < 0.02 ? -sign : sign;
            torque[k] = sign * most * (trial % 2 == 0 ? 1 : random_uniform(&r));
        }
        least_time_follow(&p, torque, n, &tip, &press);
        check_below(side * (press - t.weight * tip),
                    side * t.press + 1e-3 * fabs(t.weight));
    }
}

TEST(less_voltage_and_less_force_take_longer)
{
    static const char *const volts[] = {"motor.voltage_limit=10", "motor.voltage_limit=5",
                                        "motor.voltage_limit=3",
                                        "motor.voltage_limit=2.5"};
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

// A beam that hardly bends goes as one rod about the hub, braked by the motor: I w' = T -
// D w. A touch throws both links onto x' = (M11 - M22)/M w, (2.16) and (2.17), hub and
// first link one body.
TEST(a_stiff_arm_goes_as_a_rod)
{
    enum { STEPS = 200 };
    parameters p = fixture_parameters(SETTINGS(START, "arm.k2=1000"));
    const double damping = motor_damping(&p.motor), most = 0.5;
    const double inertia =
        p.arm.hub_inertia + p.arm.mass * p.arm.length * p.arm.length / 3;
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
    check_relative(press,
                   m.spring_force * (angle - 0.1) +
                       sqrt(m.spring_force * m.mass_force) * share * rate,
                   1e-2);
}

// --- the same by sorting ---------------------------------------------------------------

enum { LONGEST = 400 }; // steps that are looked at

// The effect of one step of torque k steps after its beginning.
typedef struct response {
    double tip, press;
} response;

static int by_ratio(const void *a, const void *b)
{
    const response *x = a, *y = b;
    const double first = x->press / x->tip, second = y->press / y->tip;
    return (first > second) - (first < second);
}

// The largest press under torques up to `most` that bring the tip `way` on: a knapsack of
// n steps. False if none do.
static bool largest_press(const response *steps, int n, double most, double way,
                          double *press)
{
    response sorted[LONGEST];
    double tip = 0;
    *press = 0;
    for (int k = 0; k < n; k++) {
        sorted[k] = steps[k + 1];
        const double torque = sorted[k].tip > 0 ? most : -most;
        tip += torque * sorted[k].tip;
        *press += torque * sorted[k].press;
    }
    if (tip < way) {
        return false;
    }

    // the steps that press least for their way are turned round until the way is right
    qsort(sorted, (size_t)n, sizeof sorted[0], by_ratio);
    for (int k = 0; k < n && tip > way; k++) {
        const double back = 2 * most * fabs(sorted[k].tip),
                     part = fmin(1, (tip - way) / back);
        tip -= part * back;
        *press -= part * back * sorted[k].press / sorted[k].tip;
    }
    return true;
}

TEST(it_is_the_best_of_all_touches)
{
    static const struct {
        const char *limit;
        double force, peak;
    } cases[] = {{"motor.voltage_limit=10", 1, 2},
                 {"motor.voltage_limit=10", 4, 4},
                 {"motor.voltage_limit=5", 0.5, 0.6},
                 {"motor.voltage_limit=3", 2, 8},
                 {"motor.voltage_limit=10", 0.05, 1},
                 {"motor.voltage_limit=2.5", 1, 1.05},
                 {"motor.voltage_limit=10", 9, 1}};
    for (EACH(c, cases)) {
        parameters p = fixture_parameters(SETTINGS(START, c->limit, "arm.length=1.2"));
        const double band = 0.05,
                     most = motor_torque_per_volt(&p.motor) * p.motor.voltage_limit +
                            p.motor.stiction;
        response steps[LONGEST + 1];
        double kick[LONGEST] = {1}, rest[LONGEST] = {0}, at_rest[2];
        pressed_arm_model m;
        assert_true(pressed_arm_model_of(&p, &m));
        const double s = sqrt(m.spring_force / m.mass_force);
        least_time_follow(&p, rest, 1, &at_rest[0], &at_rest[1]);
        const double a = c->force * (1 - band), b = c->force * (1 + band);
        const double peak = fmax(c->peak, b);

        // later and later
        least_time best = {.total = HUGE_VAL};
        for (int n = 1; n <= LONGEST; n++) {
            double highest, lowest;
            response turned[LONGEST + 1];
            least_time_follow(&p, kick, n, &steps[n].tip, &steps[n].press);
            steps[n].tip -= at_rest[0];
            steps[n].press -= at_rest[1];
            for (int k = 1; k <= n; k++) {
                turned[k] = (response){steps[k].tip, -steps[k].press};
            }
            if (!largest_press(steps, n, most, -at_rest[0], &highest) ||
                !largest_press(turned, n, most, -at_rest[0], &lowest)) {
                continue;
            }
            highest += at_rest[1];
            lowest = at_rest[1] - lowest;

            // into the band from the nearest side
            const bool largest = highest < a;
            const double press = largest ? highest : fmax(lowest, a);
            double more = 0;
            if (press > b) {
                more = press < peak ? log((peak - b) / (peak - press)) / s : HUGE_VAL;
            } else if (press < a) {
                more = press > 0 ? log(a / press) / s : HUGE_VAL;
            }
            if (n * LEAST_TIME_STEP + more < best.total) {
                best = (least_time){.total = n * LEAST_TIME_STEP + more,
                                    .touch = n * LEAST_TIME_STEP,
                                    .press = largest ? highest : lowest,
                                    .largest = largest};
            }
        }

        const least_time t = least_time_of(&p, c->force, band, c->peak);
        check_relative(t.total, best.total, 1e-7);
        check_close(t.touch, best.touch, 1e-12);
        check_close(t.press, best.press, 1e-5 * (1 + fabs(best.press)));
        assert_int_equal(t.largest, best.largest);
        check_below(t.slack, 1e-9);
    }
}

// Before it touches, the arm moves as M q'' + C q' + K q = T e says, with the matrices
// that its modes are computed from; of its momentum the touch leaves what the constraint
// allows.
TEST(the_flight_is_that_of_the_straight_arm)
{
    enum { SIZE = 5, STEPS = 400 }; // q, q', 1
    const parameters p = fixture_parameters(SETTINGS(START));
    double m[4] = {0}, k[4] = {0};
    arm a = arm_of(&p);
    modes_matrices(&a, m, k);
    const double damping = motor_damping(&p.motor),
                 determinant = m[0] * m[3] - m[1] * m[2];
    const double inverse[4] = {m[3] / determinant, -m[1] / determinant,
                               -m[2] / determinant, m[0] / determinant};

    // the propagator of a step under a torque of 0.7 N m
    double matrix[SIZE * SIZE] = {0}, step[SIZE * SIZE], power[SIZE * SIZE],
                         product[SIZE * SIZE];
    for (int i = 0; i < 2; i++) {
        matrix[i * SIZE + 2 + i] = 1;
        for (int j = 0; j < 2; j++) {
            matrix[(2 + i) * SIZE + j] =
                -(inverse[2 * i] * k[j] + inverse[2 * i + 1] * k[2 + j]);
        }
        matrix[(2 + i) * SIZE + 2] = -inverse[2 * i] * damping;
        matrix[(2 + i) * SIZE + 4] = inverse[2 * i] * 0.7;
    }
    matrix_exponential(matrix, SIZE, LEAST_TIME_STEP, step, power, product);

    // what is left of a velocity along (1, -1), the motion on the wall
    pressed_arm_model on_wall;
    assert_true(pressed_arm_model_of(&p, &on_wall));
    const double mass = m[0] - m[1] - m[2] + m[3],
                 s = sqrt(on_wall.spring_force / on_wall.mass_force);

    double z[SIZE] = {-0.1, -0.1, 0, 0, 1}, torque[STEPS], tip, press;
    for (int n = 0; n < STEPS; n++) {
        double next[SIZE] = {0};
        torque[n] = 0.7;
        for (int i = 0; i < SIZE * SIZE; i++) {
            next[i / SIZE] += step[i] * z[i % SIZE];
        }
        memcpy(z, next, sizeof z);
        least_time_follow(&p, torque, n + 1, &tip, &press);
        const double x = ((m[0] - m[2]) * z[2] + (m[1] - m[3]) * z[3]) / mass;
        check_close(tip, p.arm.length / 2 * (z[0] + z[1]), 1e-9);
        check_close(press, on_wall.spring_force * (z[0] + x / s), 1e-7);
    }
}

TEST(where_there_is_no_way_it_says_so)
{
    assert_true(isnan(of(SETTINGS("arm.links=3", START), 1, 2).total));
    assert_true(isnan(of(SETTINGS("initial.angle=0", "wall.angle=0"), 1, 2).total));
    assert_true(isnan(of(SETTINGS(START), 0, 2).total));
    assert_true(isnan(
        of(SETTINGS(START, "motor.voltage_limit=0", "motor.stiction=0"), 1, 2).total));
}
