// Events within strides of the stiff engine: what a motion meets there is what the
// explicit formula meets, down to bounces lower than rounding. Where the formula itself
// tells a touch too coarsely (1e-12 m), numbers are those of power series of the chain of
// order 32.

#include "tests/arm_fixture.h"
#include "tests/explicit_stepper.h"

// What a motion met, in order, and the largest force of its last pulse.
enum { MOST_MEETINGS = 60 };
typedef struct meetings {
    int count;
    motion_event event[MOST_MEETINGS];
    double time[MOST_MEETINGS]; // [s]
    double peak, peak_time;     // [N], [s]
} meetings;

static meetings meetings_by(const parameters *p, const engine *by, double angle,
                            double velocity, double until)
{
    const double step = by == &explicit_engine ? 1e-5 : p->method.step;
    STARTED(a, m, p, by, angle, velocity);

    meetings all = {0};
    while (m->state[SLOT_TIME] < until) {
        const motion_event met = step_on(&a, m, until, step).event;
        if (met != MOTION_REACHED) {
            assert_in_range(all.count, 0, MOST_MEETINGS - 1);
            all.event[all.count] = met;
            all.time[all.count++] = m->state[SLOT_TIME];
        }
    }

    all.peak = m->record.pulse_peak;
    all.peak_time = m->record.pulse_peak_time;
    return all;
}

// What happens within a stride is what the explicit formula finds at steps a thousand
// times shorter.
TEST(events_within_a_stride_are_the_formulas)
{
    static const struct {
        const char *what;
        int links;
        const char *settings[7];
        double angle, velocity, until;
        int events;
        double tolerance; // of an event's time [s]
    } cases[] = {
        // a stuck hub whose friction passes stiction between two instants within it
        {"a dip of what is left of friction",
         4,
         {"arm.hub_inertia=3.89323e-4", "arm.damping_ratio=0.00176877",
          "motor.voltage=0.265999", "arm.k1=169468", "wall.restitution=0.639306"},
         0.0987279,
         0.157084,
         0.146,
         8,
         1e-7},
        // bounces that each begin on the wall, and a hub that turns back for 1 ms of a
        // stride
        {"bounces and a dip of the hub's velocity",
         4,
         {"arm.hub_inertia=2.29663e-4", "arm.damping_ratio=7.92665e-4", "motor.voltage=1",
          "arm.k1=169468", "wall.restitution=0.518344"},
         0.0882041,
         0.478145,
         0.17,
         22,
         1e-7},
        // the arm pressed to the wall, whose force has summits within strides
        {"summits of the force",
         4,
         {"arm.hub_inertia=1.21604e-6", "arm.damping_ratio=1.31537e-4",
          "motor.voltage=1.55163", "arm.k1=169468", "motor.stiction=0"},
         0.098874,
         0.160059,
         0.03,
         1,
         1e-8},
    };
    for (EACH(c, cases)) {
        parameters p = fixture_parameters(c->settings);
        p.arm.links = c->links; // with the springs of the default arm
        p.arm.hub_joint = HUB_SPRING;
        p.wall.kind = WALL_POINT;
        STARTED(a, m, &p, NULL, 0, 0);
        assert_ptr_equal(m->engine, &stiff_engine);

        // by the stiff engine, and by the formula
        const double angle = c->angle, velocity = c->velocity, until = c->until;
        meetings stiff = meetings_by(&p, NULL, angle, velocity, until);
        meetings formula = meetings_by(&p, &explicit_engine, angle, velocity, until);

        // the same events at the same times
        fail_if(stiff.count != c->events || formula.count != c->events,
                "%s: %d events by the stiff engine, %d by the formula", c->what,
                stiff.count, formula.count);
        for (int k = 0; k < stiff.count; k++) {
            assert_int_equal(stiff.event[k], formula.event[k]);
            check_close(stiff.time[k], formula.time[k], c->tolerance);
        }
        check_close(stiff.peak, formula.peak, 1e-6 * fabs(formula.peak));
        check_close(stiff.peak_time, formula.peak_time, 1e-6);
    }
}

// An arm of 1e-7 rad with bounces down to 1e-9 m/s: the stiff engine resolves them as far
// as the formula does, and what comes afterwards is the same.
TEST(bounces_end_where_no_engine_tells_them)
{
    const parameters p =
        parameters_with("arm.links=11 arm.hub_joint=spring arm.damping_ratio=0.0211439 "
                        "wall.restitution=0.2997 wall.angle=1.2349084692906555e-7 "
                        "motor.voltage=5.7081e-6 arm.k2=4.64501 arm.k1=211.051 "
                        "arm.mass=0.12368 arm.hub_inertia=0.050495 motor.stiction=0 "
                        "method.rest_speed=8.56e-10");
    const meetings stiff =
        meetings_by(&p, &stiff_engine, 1.20397e-7, 1.24542e-6, 0.00753);
    const meetings formula =
        meetings_by(&p, &explicit_engine, 1.20397e-7, 1.24542e-6, 0.00753);
    assert_int_equal(stiff.count, formula.count);
    check_close(stiff.peak, formula.peak, 1e-4 * formula.peak);
}

// An arm that strikes at 3e-7 m/s and comes to rest in some microseconds: an impact that
// is a nanosecond late would leave another force.
TEST(slow_impacts_are_in_time)
{
    const parameters p = parameters_with(
        "arm.links=14 arm.hub_joint=spring arm.damping_ratio=0.769416 "
        "wall.restitution=0.600972 wall.angle=1.0272161409848381e-7 "
        "motor.voltage=2.00084e-6 arm.k2=6.35355 arm.mass=0.290645 arm.k1=230.417 "
        "arm.hub_inertia=2.04816e-4 motor.stiction=8.7131e-9 method.rest_speed=1e-13");
    const meetings stiff = meetings_by(&p, &stiff_engine, 1.02316e-7, 3.07823e-7, 0.003);
    assert_int_equal(stiff.count, 7);
    check_close(stiff.time[6], 1.3360170227229612e-3, 1e-10);
    check_relative(stiff.peak, 1.19929837665e-4, 1e-5);
}

// An arm that comes to the wall at 7e-9 m/s: first contact is no later for the tolerance
// of the gap, which is a length.
TEST(a_slow_arm_touches_in_time)
{
    const parameters p =
        parameters_with("arm.links=10 arm.hub_joint=beam arm.damping_ratio=0.423252 "
                        "wall.angle=7.8856745847127184e-7 motor.voltage=1.605e-7 "
                        "arm.k2=2.07622 arm.mass=0.14437 arm.hub_inertia=0.042581 "
                        "motor.stiction=5.1311e-8 method.rest_speed=1.66e-10");
    const meetings stiff = meetings_by(&p, &stiff_engine, 7.88542e-7, 6.75857e-9, 0.01);
    assert_true(stiff.count > 0);
    assert_int_equal(stiff.event[0], MOTION_IMPACT);
    check_close(stiff.time[0], 3.7711674825279e-3, 1e-7);
}

// An arm that presses with 5e-7 N leaves the wall where the force is zero to a share of
// what it was: a fixed tolerance of 1e-9 N would be 1e-4 s late.
TEST(a_slow_arm_leaves_in_time)
{
    const parameters p =
        parameters_with("arm.links=24 arm.hub_joint=spring arm.damping_ratio=0.00164715 "
                        "wall.angle=5.1124406976777767e-8 motor.voltage=1.6161e-6 "
                        "arm.k2=3.51557 arm.k1=19.0639 arm.mass=0.10088 "
                        "arm.hub_inertia=0.0012667 motor.stiction=4.1505e-8 "
                        "method.rest_speed=9.31e-10");
    const meetings stiff = meetings_by(&p, &stiff_engine, 5.1118e-8, 2.19239e-9, 0.0065);
    assert_int_equal(stiff.count, 2);
    assert_int_equal(stiff.event[0], MOTION_IMPACT);
    assert_int_equal(stiff.event[1], MOTION_RELEASE);
    check_close(stiff.time[0], 2.92238891368e-3, 1e-9);
    check_close(stiff.time[1], 5.87357456518e-3, 1e-9);
    check_relative(stiff.peak, 3.17925033672e-8, 1e-6);
}

// Between bounces of some 1e-9 s the tip flies 1e-13 m high, and the motor presses: no
// impact is faster than the one before, but for what it falls beyond the wall within
// 2e-14 m.
TEST(bounces_lower_than_rounding_do_not_gain)
{
    const parameters p =
        parameters_with("arm.links=14 arm.damping_ratio=0.477 arm.k2=23.7 arm.mass=0.865 "
                        "arm.hub_inertia=0.0217 motor.voltage=4.95 wall.kind=plane "
                        "wall.angle=1.043 wall.restitution=0.0189");
    for (int i = 0; i < 12; i++) {
        STARTED(a, m, &p, NULL, p.wall.angle - 2e-3, 0.4 + 2e-3 * i);

        // from first contact to rest on the wall
        int impacts = 0;
        for (double last = HUGE_VAL; m->state[SLOT_TIME] < 6e-3;) {
            motion_report r;
            assert_int_equal(motion_step(&a, m, 6e-3, 1e-3, &r), STATUS_OK);
            if (r.event == MOTION_REACHED) {
                continue;
            }
            const double speed = -m->state[SLOT_GAP_VELOCITY];
            motion_apply(&a, m, &r);
            if (r.event == MOTION_IMPACT) {
                check_below(speed, last + 1e-4);
                last = speed;
                impacts++;
            }
        }
        assert_true(impacts >= 2 && m->state[SLOT_CONTACT] != 0);
    }
}

// An arm of 5e-6 rad with flights lower than 1e-11 m: a step that ends while it rises
// changes nothing of the bounce that follows.
TEST(a_step_that_ends_in_a_flight_is_no_bounce)
{
    const parameters p =
        parameters_with("arm.links=12 arm.hub_joint=spring arm.damping_ratio=0.456079 "
                        "wall.kind=plane wall.restitution=0.868528 wall.angle=4.51e-6 "
                        "motor.voltage=-6.74594e-7 arm.k2=1.95253 arm.mass=0.583359 "
                        "arm.k1=136.203 arm.hub_inertia=1.37267e-5 motor.stiction=0 "
                        "motor.viscous_friction=0.00571998 method.rest_speed=1e-8");
    const double angle = 4.5e-6, velocity = 3.4e-6, until = 4e-3;
    const meetings all = meetings_by(&p, &stiff_engine, angle, velocity, until);
    assert_true(all.count > 10);

    // the same with a step that ends early in each flight
    STARTED(a, m, &p, &stiff_engine, angle, velocity);
    for (int k = 0; k < all.count; k++) {
        const double from = m->state[SLOT_TIME], flight = all.time[k] - from;
        motion_report r = {.event = MOTION_REACHED};
        for (double end = from + 0.2 * flight; r.event == MOTION_REACHED; end = until) {
            assert_true(m->state[SLOT_TIME] < end);
            r = step_on(&a, m, end, until);
        }
        assert_int_equal(r.event, all.event[k]);
        check_close(m->state[SLOT_TIME], all.time[k], 1e-7);
    }
}

// Whether an arm that swings towards the wall and is pulled back touches it.
static bool grazes(const parameters *p, const engine *by, double wall)
{
    parameters moved = *p;
    moved.wall.angle = wall;
    return meetings_by(&moved, by, 0, 0.5, 0.3).count > 0;
}

// The farthest wall that an arm which turns back just touches, the instant far within a
// stride, is the same by the stiff engine and by the formula: a graze is an impact
// however short it is.
TEST(a_graze_within_a_stride_is_found)
{
    for (int i = 0; i < 2; i++) {
        parameters p =
            parameters_with("arm.links=4 arm.hub_joint=spring arm.hub_inertia=2.29663e-4 "
                            "arm.damping_ratio=7.92665e-4 arm.k1=169468 motor.voltage=-1 "
                            "motor.stiction=0 %s",
                            i == 0 ? "wall.kind=point" : "wall.kind=plane");
        STARTED(a, m, &p, NULL, 0, 0);
        assert_ptr_equal(m->engine, &stiff_engine);

        double touched = 0.005, missed = 0.5;
        assert_true(grazes(&p, NULL, touched) && !grazes(&p, NULL, missed));
        while (missed - touched > 1e-12) {
            const double middle = (touched + missed) / 2;
            *(grazes(&p, NULL, middle) ? &touched : &missed) = middle;
        }

        // and by the formula
        const engine *by = &explicit_engine;
        assert_true(grazes(&p, by, touched - 1e-10) && !grazes(&p, by, touched + 1e-10));
    }
}
