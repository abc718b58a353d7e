// The way to the wall in the least time, and the rise of the force after a touch.
#include "src/predict/least_time.h"
#include "src/rig/laws/observer_paths.h"
#include "tests/rig_fixture.h"

// --- the rise --------------------------------------------------------------------------

// The force of a point of the way, by a'' = s^2 (a - f).
static double force_of(const force_rise_task *t, const double way[3])
{
    return way[0] - way[2] / (t->divergence * t->divergence);
}

static force_rise_task random_task(random_generator *r)
{
    force_rise_task t = {.divergence = 20 + 40 * random_uniform(r),
                         .end = 0.01 + random_uniform(r),
                         .time = random_uniform(r)};
    t.coordinate = t.end * (random_uniform(r) - 0.5);
    t.least = 0.1 * t.end;
    t.most = random_uniform(r) < 0.5 ? HUGE_VAL : 1.5 * t.end;

    // a stopping force from 0.15 to 1.45 times the wanted one
    double stopping = t.end * (0.15 + 1.3 * random_uniform(r));
    t.rate = t.divergence * (stopping - t.coordinate);
    return t;
}

TEST(the_way_is_one_that_its_force_makes)
{
    random_generator r = seeded(7);
    for (int trial = 0; trial < 200; trial++) {
        force_rise_task t = random_task(&r);
        force_rise rise = force_rise_begin(&t);

        // from where the arm is
        double way[3], before[3], after[3];
        force_rise_at(&rise, t.time, way);
        check_close(way[0], t.coordinate, 1e-12);
        check_close(way[1], t.rate, 1e-9);

        // its rates are derivatives, its force keeps to the bounds
        const double h = 1e-6;
        for (int i = 1; i < 60; i++) {
            double time = t.time + 0.004 * i;
            force_rise_at(&rise, time - h, before);
            force_rise_at(&rise, time, way);
            force_rise_at(&rise, time + h, after);
            check_close((after[0] - before[0]) / (2 * h), way[1],
                        1e-6 * t.divergence * t.end);
            double force = force_of(&t, way);
            check_below(t.least - 1e-9, force);
            check_below(force, fmin(t.most, 2 * t.end) + 1e-9);
            if (!force_rise_moves(&rise, time)) {
                check_close(force, t.end, 0.0501 * t.end);
            }
        }

        // and to rest under the wanted force
        force_rise_at(&rise, t.time + 40 / t.divergence, way);
        check_relative(way[0], t.end, 1e-9);
        check_close(way[1], 0, 1e-6);
    }
}

// What any other force that ends at rest costs is more: some forces added that leave no
// motion.
TEST(no_other_force_costs_less)
{
    const double s = 34, end = 1, stopping = 0.6, step = 1e-4;
    const force_rise_task task = {.coordinate = 0,
                                  .rate = s * stopping,
                                  .divergence = s,
                                  .end = end,
                                  .least = 0.1,
                                  .most = HUGE_VAL};
    force_rise rise = force_rise_begin(&task);
    random_generator r = seeded(3);

    for (int trial = 0; trial < 50; trial++) {
        // a pulse and the one that undoes what it does to x: the integral of exp(-s t) f
        // is kept
        double first = 0.1 * random_uniform(&r), second = 0.1 + 0.1 * random_uniform(&r);
        double height = random_uniform(&r) - 0.5, width = 0.02;
        double undo = -height * exp(-s * (first - second)), least = 0, other = 0;
        for (double t = 0; t < 0.5; t += step) {
            double way[3];
            force_rise_at(&rise, t, way);
            double off = force_of(&task, way) - end, more = 0;
            more += t >= first && t < first + width ? height : 0;
            more += t >= second && t < second + width ? undo : 0;
            least += off * off * step;
            other += (off + more) * (off + more) * step;
        }
        check_below(least, other + 1e-3 * least);
    }
}

// --- the quickest touch ----------------------------------------------------------------

#define VOLTS 10.0

static controller_setup believed_of(const parameters *p)
{
    return (controller_setup){.period = 0.005,
                              .voltage_limit = p->motor.voltage_limit,
                              .torque_per_volt = motor_torque_per_volt(&p->motor),
                              .hub_damping = motor_damping(&p->motor),
                              .stiction = p->motor.stiction,
                              .hub_inertia = p->arm.hub_inertia,
                              .link_mass = p->arm.mass / 2,
                              .link_length = p->arm.length / 2,
                              .link_inertia = p->arm.link_inertia,
                              .k2 = p->arm.k2,
                              .links = 2,
                              .hub_spring = HUGE_VAL};
}

static observer_design design_of(const parameters *p)
{
    const controller_setup setup = believed_of(p);
    const observer_task task = {.force = 1,
                                .stopping_force = 1,
                                .approach_voltage = VOLTS};
    observer_design d;
    assert_null(observer_design_init(&d, &setup, &task));
    return d;
}

// Free coordinates at rest at an angle.
static void rest_at(const observer_design *d, double angle, double *z)
{
    memset(z, 0, ESTIMATOR_STATES * sizeof *z);
    for (int i = 0; i < d->observer.arm.free.count; i++) {
        z[i] = d->observer.arm.free.momentum[i] * angle;
    }
}

static void fly(const observer_design *d, double *z, double torque)
{
    double next[ESTIMATOR_STATES] = {0};
    sampled_model flight;
    observer_design_flight(d, &flight);
    for (int i = 0; i < flight.n; i++) {
        next[i] = flight.b[i] * torque;
        for (int j = 0; j < flight.n; j++) {
            next[i] += flight.a[i][j] * z[j];
        }
    }
    memcpy(z, next, sizeof next);
}

// Flown as planned, each period planned anew, the tip is at the wall with the wanted
// motion, no torque beyond the limits, and hardly later than by the bound.
TEST(the_plan_does_what_it_says)
{
    for (EACH_TEXT(c, "initial.angle=-0.06", "initial.angle=-0.1",
                   "initial.angle=-0.35")) {
        parameters p = fixture_parameters(SETTINGS(*c, "wall.angle=0"));
        const observer_design d = design_of(&p);
        const double most = motor_torque_per_volt(&p.motor) * VOLTS;
        double z[ESTIMATOR_STATES];
        rest_at(&d, p.initial.angle, z);
        quickest_touch q;
        quickest_touch_init(&q, &d);
        const quickest_task task = {.z = z, .low = -most, .high = most, .force = 1};

        int periods = 0;
        for (; periods == 0 || q.left > 0; periods++) {
            assert_true(quickest_touch_plan(&q, &task));
            double torque = quickest_touch_next(&q);
            check_below(fabs(torque), most * (1 + 1e-12));
            fly(&d, z, torque);
        }

        // the touch that was wanted
        double tip = 0, force = 0;
        for (int k = 0; k < 2 * d.observer.arm.free.count; k++) {
            tip += q.tip[k] * z[k];
            force += q.force[k] * z[k];
        }
        check_close(tip, 0, 1e-5);
        check_close(force, 1, 1e-3);
        double bound = least_time_of(&p, 1, 0.05, 2).touch;
        check_below(bound, periods * 0.005 + 0.005);
        check_below(periods * 0.005, 1.25 * bound + 0.005);
    }
}

// A voltage that does not get there plans nothing.
TEST(without_a_way_there_is_no_plan)
{
    parameters p = fixture_parameters(SETTINGS("initial.angle=-0.1", "wall.angle=0"));
    const observer_design d = design_of(&p);
    double z[ESTIMATOR_STATES];
    rest_at(&d, -0.1, z);
    quickest_touch q;
    quickest_touch_init(&q, &d);
    const quickest_task task = {.z = z, .low = -1e-6, .high = 1e-6, .force = 1};
    assert_false(quickest_touch_plan(&q, &task));
}

// On the rig, with its noise and friction: near the bound, below the limit, without
// separation.
TEST(the_law_comes_near_the_least_time)
{
    static const char *const starts[] = {"initial.angle=-0.09", "initial.angle=-0.1",
                                         "initial.angle=-0.13"};
    static const char *const seeds[] = {"control.seed=5", "control.seed=6",
                                        "control.seed=7"};
    for (int i = 0; i < 9; i++) {
        const char *const *settings =
            SETTINGS("control.law=observer", "control.settings=wall_doubt=0",
                     "control.approach_voltage=10", "control.force_limit=1.5",
                     starts[i / 3], seeds[i % 3]);
        parameters p = rig_parameters(settings);
        summary s = rig_summary(settings);
        double bound = least_time_of(&p, 1, 0.05, s.peak_force_N).total;
        check_below(bound, s.first_contact_s + s.settling_time_s);
        check_below(s.first_contact_s + s.settling_time_s, 1.9 * bound);
        if (i / 3 == 1) {
            check_below(s.first_contact_s + s.settling_time_s, 1.45 * bound);
        }
        check_below(s.peak_force_N, 1.5);
        assert_int_equal(s.separations, 0);
    }
}

// The force at once falls with a command, but a motion that the limit does not stop is
// not to be answered by pressing on.
TEST(beyond_its_limit_it_brakes)
{
    summary s =
        rig_summary(SETTINGS("control.law=observer", "control.settings=wall_doubt=0",
                             "control.approach_voltage=10", "control.force_limit=1.5",
                             "initial.angle=-0.35", "belief.k2_factor=0.76"));
    check_below(1.5, s.peak_force_N);
    check_close(s.steady_error_N, 0, 0.05);
}

// A wall that is not where it is believed to be is still found.
TEST(a_wall_further_away_is_found)
{
    summary s =
        rig_summary(SETTINGS("control.law=observer", "control.settings=wall_doubt=0",
                             "control.approach_voltage=10", "belief.wall_error=-0.03"));
    check_close(s.steady_error_N, 0, 0.05);
    assert_false(isnan(s.settling_time_s));
}
