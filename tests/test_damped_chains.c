// Chains of many links with decaying fast modes: long strides for any bend of the arm,
// bounces that do not depend on the recorded rows, and arbitrarily small motions. Numbers
// stated are those of power series of the chain of order 32.

#include "tests/passage.h"

// 256 links from rest into a wall, against which they bend: the last link's line meets a
// point by a fifth of a link beyond its end.
TEST(a_chain_that_bends_keeps_its_strides)
{
    for (int kind = 0; kind < 2; kind++) {
        const parameters p =
            parameters_with("arm.links=256 arm.damping_ratio=0.01 motor.voltage=1 %s",
                            kind == 0 ? "wall.kind=point" : "wall.kind=plane");
        const passage all = passage_of(&p, 0, 0, 0.36, 200);
        assert_int_equal(all.impacts, 1);
        check_below(all.open, 1e-7);
    }
}

// 64 links that bounce with all but the slowest modes overdamped: after an impact strides
// are much shorter than any of the slow decays take, and soon as long again as before.
TEST(a_strongly_damped_chain_that_bounces_keeps_its_strides)
{
    const parameters p =
        parameters_with("arm.links=64 arm.damping_ratio=0.3 arm.hub_joint=spring "
                        "wall.restitution=0.8 wall.angle=2.1 motor.voltage=5");
    const passage all = passage_of(&p, 0, 0, 0.9, 400);
    assert_true(all.impacts > 1);
    check_below(all.open, 1e-7);
}

// Impacts of an arm in front of its wall, and the largest force of what follows them.
typedef struct bounces {
    int impacts;
    double first;   // instant of the first [s]
    double slowest; // of them [m/s]
    double peak;    // [N]
    double peak_time;
} bounces;

static bounces bounces_of(const parameters *p, double gap, double velocity, double until)
{
    STARTED(a, m, p, &stiff_engine, p->wall.angle - gap, velocity);
    bounces all = {0};
    for (int steps = 0; m->state[SLOT_TIME] < until; steps++) {
        assert_in_range(steps, 0, 100000);
        const motion_report r = step_on(&a, m, until, 1e-3);
        if (r.event == MOTION_IMPACT) {
            all.first = all.impacts == 0 ? m->state[SLOT_TIME] : all.first;
            all.impacts++;
            all.slowest = r.speed;
        }
    }
    all.peak = m->record.pulse_peak;
    all.peak_time = m->record.pulse_peak_time;
    return all;
}

// Strongly damped chains bounce ever lower, to flights of 1e-9 s and 1e-13 m, and what is
// left of their speed makes the peak force, however long the run is.
TEST(low_bounces_are_those_of_power_series)
{
    const parameters p = parameters_with(
        "arm.links=18 arm.damping_ratio=0.9149 arm.k2=50.78 arm.mass=1.48 "
        "arm.hub_inertia=0.02198 motor.voltage=2.55 motor.stiction=0 "
        "wall.kind=plane wall.angle=0.1 wall.restitution=0.2228783812");
    for (int i = 1; i <= 4; i++) {
        const bounces stiff = bounces_of(&p, 1e-4, 0.65, 1.6e-4 * i * i);
        assert_int_equal(stiff.impacts, 7);
        check_relative(stiff.slowest, 4.79033149495e-5, 1e-6);
        check_relative(stiff.peak, 14126.0309154, 1e-6);
        check_close(stiff.peak_time, 1.5419102067582e-4, 1e-12);
    }
}

// With a rest speed of 1e-7 m/s flights become as short as 4e-14 s and as low as 1e-22 m,
// which is less than what angles are rounded to. None of them regains any speed.
TEST(flights_lower_than_any_rounding_are_those_of_power_series)
{
    static const char *const arms[2][10] = {
        {"arm.links=23", "arm.hub_joint=beam", "arm.damping_ratio=0.595492",
         "wall.restitution=0.223733", "motor.voltage=0.587403", "arm.k2=32.794",
         "arm.mass=1.31544", "arm.hub_inertia=0.00196971", "motor.stiction=0.00418453"},
        {"arm.links=19", "arm.hub_joint=beam", "arm.damping_ratio=0.340306",
         "wall.kind=plane", "wall.restitution=0.162903", "motor.voltage=0.624174",
         "arm.k2=8.1031", "arm.mass=0.276462", "arm.hub_inertia=0.00200183"}};
    static const bounces found[2] = {
        {13, 0, 3.39641719194e-8, 85014.2093903, 1.0022161819222e-4},
        {11, 0, 3.34583094563e-8, 7835.73135493, 1.0048643781657e-4},
    };
    for (int i = 0; i < 2; i++) {
        parameters p = fixture_parameters(arms[i]);
        p.wall.angle = 0.1;
        p.method.rest_speed = 1e-7;
        const bounces stiff = bounces_of(&p, 1e-4 * 3.6, 3.6, 1.1e-4);
        assert_int_equal(stiff.impacts, found[i].impacts);
        check_relative(stiff.slowest, found[i].slowest, 1e-4);
        check_relative(stiff.peak, found[i].peak, 1e-6);
        check_close(stiff.peak_time, found[i].peak_time, 1e-12);
    }
}

// An arm that closes a gap of less than 1e-9 m meets the wall where the gap is none,
// wherever its strides end before it.
TEST(a_slow_arm_meets_its_wall_in_time)
{
    const parameters p =
        parameters_with("arm.links=11 arm.hub_joint=beam arm.damping_ratio=0.1 arm.k2=15 "
                        "arm.mass=0.28 arm.hub_inertia=1.4e-4 motor.voltage=4e-6 "
                        "motor.stiction=3e-7 wall.angle=1e-5 method.rest_speed=1e-8");
    static const double first[] = {4.0014973e-4,  7.9890865e-4,  1.19090023e-3,
                                   1.57891664e-3, 1.96957387e-3, 2.36983598e-3,
                                   2.78682441e-3, 3.22850009e-3, 3.70475134e-3,
                                   4.22916186e-3};
    for (int i = 1; i <= 10; i++) {
        const bounces stiff = bounces_of(&p, 5e-11 * i, 1.25e-7, 5e-3);
        assert_true(stiff.impacts > 0);
        check_close(stiff.first, first[i - 1], 1e-6);
    }
}

// Instants at which the hub of an arm that presses on a plane comes to rest, breaks away
// and comes to rest for good [s], all that moves it being `share` of what it is at a wall
// at 1 rad.
static void hub_events(double share, double instant[3])
{
    parameters p = parameters_with("arm.links=32 arm.damping_ratio=0.05 wall.kind=plane "
                                   "wall.angle=1 motor.voltage=10 motor.stiction=0.45");
    p.wall.angle *= share;
    p.motor.voltage *= share;
    p.motor.stiction *= share;
    STARTED(a, m, &p, &stiff_engine, 0, 0);

    // from the turn at 0.382 s on
    const motion_event expected[3] = {MOTION_STICK, MOTION_SLIP, MOTION_STICK};
    int count = 0, steps = 0;
    while (m->state[SLOT_TIME] < 0.7) {
        const motion_event met = step_on(&a, m, 0.7, 1e-3).event;
        assert_true(++steps < 5000);
        if ((met == MOTION_STICK || met == MOTION_SLIP) && m->state[SLOT_TIME] > 0.45) {
            assert_in_range(count, 0, 2);
            assert_int_equal(met, expected[count]);
            instant[count++] = m->state[SLOT_TIME];
        }
    }
    assert_int_equal(count, 3);
}

// Within a stride a small arm's friction comes to its limit from next to it, and only
// there does the hub break away: at the instant at which a larger arm's does.
TEST(a_small_motion_slips_as_a_larger_one)
{
    double larger[3], small[3];
    hub_events(1e-4, larger);
    hub_events(1e-6, small);
    for (int i = 0; i < 3; i++) {
        check_close(small[i], larger[i], 5e-6);
    }
}

// After an impact the hub's velocity has transients of all modes, damped and not: the
// ledger closes only where all products of them are in the hub's loss. Arms so small that
// a stride's own check of its ledger does not shorten it.
TEST(small_arms_close_the_ledger)
{
    static const char *const arms[2][8] = {
        {"arm.links=21", "arm.damping_ratio=0.0453325", "motor.voltage=5.33721e-7",
         "arm.k2=13.7651", "arm.mass=0.171243", "arm.hub_inertia=0.00846674",
         "motor.stiction=2.47171e-8"},
        {"arm.links=23", "arm.damping_ratio=0.125187", "motor.voltage=6.4098e-6",
         "arm.k2=30.7309", "arm.mass=0.137169", "arm.hub_inertia=0.0492825",
         "motor.stiction=0"}};
    for (int i = 0; i < 2; i++) {
        parameters p = fixture_parameters(arms[i]);
        p.wall.angle = 1e-7;
        const passage all = passage_by(&p, &stiff_engine,
                                       i == 0 ? 9.43312e-8 : 9.22576e-8, 1e-6, 0.1, 100);
        assert_int_equal(all.impacts, 1);
        check_below(all.open, 1e-7);
    }
}
