// The law inverse-dynamics: against an inverse computed with nothing but sums over
// frequencies, and on the arm: the tip goes as planned, rests afterwards, meets the wall
// as fast as planned, and the force follows its plan.
#include <complex.h>

#include "src/rig/laws/laws.h"
#include "tests/rig_fixture.h"

#define PI          3.14159265358979323846
#define TRAVEL_TIME 0.25 // [s]
#define WAY         0.1  // from the start to the wall of the fixture [rad]

static const double complex i_ = (double complex)_Complex_I;

// --- the plan itself -------------------------------------------------------------------

enum { FORCE, ARRIVAL_SPEED, TRAVEL, TRANSITION, THRESHOLD };

// The default arm without stiction, sampled continuously; parameters in the law's order.
static controller_setup default_setup(const double *values)
{
    return (controller_setup){.voltage_limit = 10,
                              .torque_per_volt = 0.44,
                              .hub_damping = 0.18,
                              .hub_inertia = 5.2e-3,
                              .link_mass = 0.2,
                              .link_length = 0.5,
                              .link_inertia = 0.2 * 0.25 / 12,
                              .k2 = 4.92,
                              .wall_angle = WAY,
                              .parameters = values};
}

// When the tip of the default arm departs: the law takes 8/s for what the hub does
// before.
static double departure(const controller_setup *r)
{
    double ml2 = r->link_mass * r->link_length * r->link_length;
    return 8 / sqrt(2 * r->k2 / (0.25 * ml2 - r->link_inertia));
}

// Planned angle of the tip since its departure, without arrival speed [rad].
static double planned_tip(double time)
{
    double share = fmax(0, fmin(time / TRAVEL_TIME, 1));
    return WAY * (share - sin(2 * PI * share) / (2 * PI));
}

// Torque at w of a unit tip acceleration, from (K + iwC - w^2 M) q = (1, 0) torque.
static double complex torque_per_acceleration(const controller_setup *r, double w)
{
    double ml2 = r->link_mass * r->link_length * r->link_length, k2 = r->k2;
    double complex a = k2 + i_ * w * r->hub_damping -
                       w * w * (r->hub_inertia + r->link_inertia + 1.25 * ml2);
    double complex b = -k2 - w * w * 0.5 * ml2;
    double complex d = k2 - w * w * (r->link_inertia + 0.25 * ml2);
    double complex det = a * d - b * b, tip = (d - b) / 2 / det;
    return 1 / (-w * w * tip);
}

// The law's plan against the same plan by a Fourier series. A window of two seconds has
// 1024 instants, and the tip departs in its middle. Each frequency w of the tip's
// acceleration is multiplied by the arm's torque per acceleration at w, and the sum of
// all is the torque. At w = 0 the arm is a rigid body: the mean of its acceleration is
// zero, and that of the torque is what the hub's damping takes.
TEST(plan_is_the_inverse_of_every_frequency)
{
    enum { COUNT = 1024 };
    const double window = 2, step = window / COUNT;
    const double values[] = {
        [FORCE] = 0, [TRAVEL] = TRAVEL_TIME, [TRANSITION] = 0.35, [THRESHOLD] = 1};
    const controller_setup setup = default_setup(values);
    double torque[COUNT] = {0};
    for (int n = 0; n < COUNT / 2; n++) {
        // the coefficient of the acceleration
        double w = 2 * PI * n / window;
        double complex acceleration = 0;
        for (int k = 0; k < COUNT; k++) {
            double t = k * step - window / 2;
            double there = t > 0 && t < TRAVEL_TIME ? sin(2 * PI * t / TRAVEL_TIME) : 0;
            acceleration += there * 2 * PI * WAY / (TRAVEL_TIME * TRAVEL_TIME) *
                            cexp(-i_ * w * k * step) / COUNT;
        }

        // that of the torque; 2 as the coefficients of w and -w are added
        double complex part = setup.hub_damping * WAY / window;
        if (n > 0) {
            part = 2 * torque_per_acceleration(&setup, w) * acceleration;
        }
        for (int k = 0; k < COUNT; k++) {
            torque[k] += creal(part * cexp(i_ * w * k * step));
        }
    }

    // the law, whose plan counts from the first sample
    void *memory = calloc(1, inverse_dynamics_law.memory_size);
    controller_output out;
    assert_non_null(memory);
    assert_null(inverse_dynamics_law.start(memory, &setup));
    inverse_dynamics_law.sample(memory, &(controller_input){.time = 0}, &out);

    // both at the same instants: the largest torque, the largest difference, and the
    // largest torque before the tip departs
    double largest = 0, largest_error = 0, largest_ahead = 0;
    for (int k = 0; k < COUNT; k++) {
        double time = k * step - window / 2 + departure(&setup);
        if (time < 0) {
            continue;
        }
        inverse_dynamics_law.sample(memory, &(controller_input){.time = time}, &out);
        double planned = out.command * setup.torque_per_volt;
        largest = fmax(largest, fabs(planned));
        largest_error = fmax(largest_error, fabs(planned - torque[k]));
        if (time < departure(&setup)) {
            largest_ahead = fmax(largest_ahead, planned);
        }
    }
    free(memory);
    check_below(largest_error, 1e-3 * largest);

    // it is not causal: before the tip departs the torque is a good part of its largest
    check_below(0.1 * largest, largest_ahead);
}

TEST(plan_needs_an_arm_that_it_can_invert)
{
    const double values[] = {1, 0, TRAVEL_TIME, 0.35, 0.05};
    controller_setup heavy = default_setup(values), loose = heavy;
    SCOPED(free_kept) void *memory = calloc(1, inverse_dynamics_law.memory_size);
    assert_non_null(memory);
    heavy.link_inertia = 0.2 * 0.25 / 4;
    assert_non_null(strstr(inverse_dynamics_law.start(memory, &heavy), "link inertia"));
    loose.torque_per_volt = 0;
    assert_non_null(strstr(inverse_dynamics_law.start(memory, &loose), "motor"));
}

// --- on the arm, in free motion --------------------------------------------------------

typedef struct travelled {
    double tip_error;   // root mean square over the whole run, share of the way
    double hub_ahead;   // hub angle when the tip departs, share of the way
    double tip_ahead;   // the same of the tip
    double left_moving; // span of the tip's angle after its arrival, share of the way
} travelled;

// Moves the arm with these settings in free space, and says how its tip kept to the plan.
static travelled travel(const char *const *settings)
{
    const char *all[16] = {"control.law=inverse-dynamics", "control.force=0",
                           "wall.kind=none", "control.travel_time=0.25",
                           "sensor.ideal=true"};
    for (int i = 5; *settings != NULL; i++) {
        all[i] = *settings++;
    }

    // when the tip departs and arrives, by the arm that the law takes for granted
    parameters p = rig_parameters(all);
    controller_setup believed = {.link_mass = p.arm.mass / 2,
                                 .link_length = p.arm.length / 2,
                                 .link_inertia = p.arm.link_inertia,
                                 .k2 = p.arm.k2 * p.belief.k2_factor};
    double departs = departure(&believed), arrives = departs + TRAVEL_TIME;

    // the run
    KEPT_RUN(r) = rig_run(all, true);
    travelled result = {0};
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (size_t i = 0; i < r.trace.row_count; i++) {
        const sample *row = &r.trace.rows[i];
        // the tip's deviation from its plan, as a share of the way
        double tip = (row->first_angle + row->last_angle) / 2 + WAY;
        double error = (tip - planned_tip(row->time - departs)) / WAY;
        result.tip_error += error * error / (double)r.trace.row_count;

        // how far hub and tip have come when the tip is to depart
        if (row->time <= departs) {
            result.hub_ahead = (row->hub_angle + WAY) / WAY;
            result.tip_ahead = tip / WAY;
        }

        // what the tip moves after its arrival, when the hub has come to rest
        if (row->time > arrives + 0.25) {
            low = fmin(low, tip);
            high = fmax(high, tip);
        }
    }
    result.tip_error = sqrt(result.tip_error);
    result.left_moving = (high - low) / WAY;
    return result;
}

TEST(tip_follows_its_plan_and_rests)
{
    travelled ideal = travel(given("motor.stiction=0"));
    check_below(ideal.tip_error, 1e-3);
    check_below(ideal.left_moving, 1e-3);
    // the hub starts before the tip
    check_below(0.1, ideal.hub_ahead);
    check_close(ideal.tip_ahead, 0, 1e-3);
    // friction that is known costs little
    travelled rough = travel(given("motor.stiction=0.045"));
    check_below(rough.tip_error, 0.01);
    check_below(rough.left_moving, 0.01);
}

// The same law that believes in an arm a hundred times stiffer is the computed torque of
// a rigid body.
TEST(rigid_body_torque_leaves_vibration)
{
    travelled rigid = travel(given("motor.stiction=0 belief.k2_factor=100"));
    travelled flexible = travel(given("motor.stiction=0"));
    check_below(0.2, rigid.left_moving);
    check_below(100 * flexible.left_moving, rigid.left_moving);
    check_below(30 * flexible.tip_error, rigid.tip_error);
}

// Open-loop: what it believes of the stiffness is what it gets.
TEST(wrong_stiffness_costs)
{
    for (EACH_TEXT(c, "belief.k2_factor=0.8", "belief.k2_factor=1.2")) {
        travelled wrong = travel(given("motor.stiction=0 %s", *c));
        check_below(0.02, wrong.left_moving);
        check_below(0.01, wrong.tip_error);
        check_below(wrong.tip_error, 0.1);
    }
}

// --- at the wall -----------------------------------------------------------------------

static const event *first_impact(const run_result *r)
{
    return find_event(r, EVENT_IMPACT, 0);
}

TEST(tip_meets_the_wall_as_fast_as_planned)
{
    for (EACH_OF(double, c, 0.1, 0.2, 0.4, 0.8)) {
        for (int seed = 1; seed <= 5; seed++) {
            const char *speed = formatted("control.arrival_speed=%g", *c);
            KEPT_RUN(r) = rig_run(given("control.law=inverse-dynamics %s control.seed=%d",
                                        speed, seed),
                                  false);
            check_relative(first_impact(&r)->speed, *c, 0.03);
            check_close(first_impact(&r)->time, 0.583, 0.006);
            check_close(r.summary.steady_force_N, 1, 0.03);
        }
    }
}

// Sampled fast and without friction the force is the planned one through the impact and
// after it.
TEST(force_follows_its_plan)
{
    for (EACH_TEXT(c, "control.arrival_speed=0", "control.arrival_speed=0.3")) {
        RIG_RUN(r,
                "control.law=inverse-dynamics sensor.ideal=true motor.stiction=0 "
                "control.rate=5000 control.transition_time=0.1 %s",
                *c);
        for (EACH_ROW(row, &r.trace)) {
            // a touch without speed comes when the force is above what the tip is off its
            // plan
            check_close(row->force, row->calculated_force,
                        row->time < 0.62 ? 0.15 : 0.01);
        }
        check_close(first_impact(&r)->time, 0.583, 0.01);
        check_close(r.summary.steady_force_N, 1, 2e-3);
    }
}

// On the noisy default rig, and with the wall found 0.02 rad before or behind its
// believed place.
TEST(press_ends_near_its_force)
{
    const char *const errors[] = {"belief.wall_error=0", "belief.wall_error=0.02",
                                  "belief.wall_error=-0.02"};
    const double peaks[] = {1.05, 1.3, 1.5};
    for (int i = 0; i < 3; i++) {
        for (int seed = 1; seed <= 5; seed++) {
            summary s =
                rig_summary_with("control.law=inverse-dynamics %s control.seed=%d",
                                 errors[i], seed);
            check_close(s.steady_force_N, 1, 0.05);
            check_below(s.peak_force_N, peaks[i]);
        }
    }
}

TEST(early_touch_moves_the_plan_on)
{
    RIG_RUN(r, "control.law=inverse-dynamics belief.wall_error=0.02");
    double touch = first_impact(&r)->time;
    check_below(touch, 0.5);
    for (EACH_ROW(row, &r.trace)) {
        if (row->time < touch || row->time > touch + 0.0101) {
            check_close(row->controller_mode, row->time < touch ? 0 : 1, 0);
        }
    }
}
