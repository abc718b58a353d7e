// The law `observer`: its gain, its reduced arm, and what it has to show on the rig; and
// that laws see sensors only.

#include "src/rig/estimation/arm_observer.h"
#include "src/rig/controller_values.h"
#include "src/rig/laws/observer_design.h"
#include "src/rig/estimation/reduced_arm.h"
#include "src/rig/estimation/estimator.h"
#include "src/rig/rig.h"
#include "tests/rig_fixture.h"

#define N ESTIMATOR_STATES

// --- synthesis -------------------------------------------------------------------------

// The cost that a feedback leaves, as z'P z: P = Q + r k k' + (A - b k)' P (A - b k),
// summed sample by sample; Q has the weights on its diagonal.
static void cost_of_feedback(const sampled_model *m, const double *weight, double effort,
                             const double *k, double p[N][N])
{
    double loop[N][N], product[N][N];
    memset(p, 0, N * sizeof p[0]);
    for (int i = 0; i < m->n; i++) {
        for (int j = 0; j < m->n; j++) {
            loop[i][j] = m->a[i][j] - m->b[i] * k[j];
        }
    }

    for (int passed = 0; passed < 4000; passed++) {
        memset(product, 0, sizeof product);
        for (int i = 0; i < m->n * m->n * m->n; i++) {
            int row = i / (m->n * m->n), column = i / m->n % m->n, l = i % m->n;
            product[row][column] += p[row][l] * loop[l][column];
        }
        for (int i = 0; i < m->n; i++) {
            for (int j = 0; j < m->n; j++) {
                p[i][j] = (i == j ? weight[i] : 0) + effort * k[i] * k[j];
                for (int l = 0; l < m->n; l++) {
                    p[i][j] += loop[l][i] * product[l][j];
                }
            }
        }
    }
}

// Where all that follows is paid for by P, no other first command is better.
static void check_optimal(const sampled_model *m, const double *weight, double effort,
                          double tolerance)
{
    double k[N], p[N][N], sum = effort, size = 0;
    assert_true(quadratic_gain(m, weight, effort, k));
    cost_of_feedback(m, weight, effort, k, p);
    double bp[N] = {0};
    for (int j = 0; j < m->n; j++) {
        for (int i = 0; i < m->n; i++) {
            bp[j] += m->b[i] * p[i][j];
        }
        sum += bp[j] * m->b[j];
        size = fmax(size, fabs(k[j]));
    }
    for (int j = 0; j < m->n; j++) {
        double best = 0;
        for (int i = 0; i < m->n; i++) {
            best += bp[i] * m->a[i][j];
        }
        check_close(k[j], best / sum, tolerance * size);
    }
}

// check_optimal asks for the condition under which no other gain costs less. The models
// are invented: two states as of the arm in contact, and five states that are coupled.
TEST(doubling_makes_the_cost_least)
{
    // the arm in contact at 200 Hz
    double rate[N][N] = {{0, 1}, {-510, -4.7}}, input[N] = {0, 11.3};
    sampled_model m;
    sampled_model_init(&m, 2, rate, input, 0.005);
    check_optimal(&m, (double[]){795, 0.0064}, 2e-3, 1e-9);
    check_optimal(&m, (double[]){0, 1}, 2e-3, 1e-9);

    // two vibrations and a drift under one input, several weights
    double chain[N][N] = {[0] = {[1] = 1},
                          [1] = {-900, -0.5, 200},
                          [2] = {[3] = 1},
                          [3] = {200, 0, -4000, -1},
                          [4] = {[0] = 3, [4] = 0.2}};
    double force[N] = {0, 5, 0, -2, 1};
    sampled_model_init(&m, 5, chain, force, 0.004);
    check_optimal(&m, (double[]){1, 2, 3, 4, 5}, 0.3, 1e-9);
}

// As many states as there may be: six vibrations, in any unit of the cost.
TEST(all_states_have_a_gain_in_any_unit)
{
    double rate[N][N] = {{0}}, input[N] = {0}, gain[3][N];
    for (int i = 0; i < N; i += 2) {
        rate[i][i + 1] = 1;
        rate[i + 1][i] = -100 * (i + 1) * (i + 1);
        rate[i + 1][i + 1] = -0.4 * (i + 1);
        input[i + 1] = 1 + 0.3 * i;
    }
    sampled_model m;
    sampled_model_init(&m, N, rate, input, 0.004);
    for (int k = 0; k < 3; k++) {
        const double unit = (double[]){1, 1e-12, 1e12}[k];
        double weight[N];
        for (int i = 0; i < N; i++) {
            weight[i] = (1 + i) * unit;
        }
        check_optimal(&m, weight, 0.3 * unit, 1e-9);
        assert_true(quadratic_gain(&m, weight, 0.3 * unit, gain[k]));
        for (int i = 0; i < N; i++) {
            check_close(gain[k][i], gain[0][i], 1e-9 * fabs(gain[0][1]));
        }
    }
}

// A scalar: p = a^2 p/(1 + p b^2/r) + q has a root in closed form.
TEST(doubling_solves_the_scalar_equation)
{
    sampled_model m = {.n = 1, .a = {{1.2}}, .b = {0.5}};
    double gain[N], a = 1.2, b = 0.5, q = 2, r = 3;
    assert_true(quadratic_gain(&m, &q, r, gain));
    double half = (r * (1 - a * a) - b * b * q) / (2 * b * b);
    double p = -half + sqrt(half * half + q * r / (b * b));
    check_relative(gain[0], a * b * p / (r + b * b * p), 1e-12);

    // what no command reaches and is unstable has no gain
    sampled_model lost = {.n = 1, .a = {{1.2}}, .b = {0}};
    assert_false(quadratic_gain(&lost, &q, r, gain));

    // nor has what costs nothing or no number
    const double none = (double)NAN;
    assert_false(quadratic_gain(&m, &q, 0, gain));
    assert_false(quadratic_gain(&m, &none, r, gain));
}

static controller_setup two_links(void)
{
    return (controller_setup){.period = 0.005,
                              .voltage_limit = 10,
                              .torque_per_volt = 0.44,
                              .hub_inertia = 5.2e-3,
                              .link_mass = 0.2,
                              .link_length = 0.5,
                              .link_inertia = 0.2 * 0.25 / 12,
                              .k2 = 4.92,
                              .links = 2,
                              .hub_spring = HUGE_VAL};
}

// Two links have one degree of freedom in contact: M x'' = T - 4 k2 x, f = 4 k2 x - mu
// x''.
TEST(two_links_reduce_to_themselves)
{
    controller_setup s = two_links();
    reduced_arm reduced;
    assert_null(reduced_arm_init(&reduced, &s, 0, HUGE_VAL));
    double quarter = s.link_mass * 0.25 / 4, inertia = s.hub_inertia + 2 * s.link_inertia;
    double mass = inertia + 2 * quarter, mu = (quarter - s.link_inertia) / 0.5;
    assert_int_equal(reduced.contact.count, 1);
    check_relative(reduced.contact.square[0], 4 * s.k2 / mass, 1e-9);
    check_relative(reduced.contact.hub[0] * reduced.contact.hub[0], 1 / mass, 1e-9);

    // the torque's immediate part of the force
    double at_once = 1 - reduced.contact.momentum[0] * reduced.contact.hub[0];
    check_relative(at_once, -mu / mass, 1e-9);

    // a rotation of all bodies has p of the free modes and bends nothing
    check_relative(reduced.free.momentum[0] * reduced.free.momentum[0], reduced.inertia,
                   1e-9);
    check_close(reduced.free.momentum[1], 0, 1e-9);
    check_close(reduced.free.square[0], 0, 1e-6);
}

// A plastic touch keeps what M projects: it loses energy, and nothing of a motion that
// the contact allows.
TEST(a_touch_loses_energy)
{
    controller_setup s = two_links();
    s.links = 8;
    s.period = 1e-3;
    reduced_arm reduced;
    assert_null(reduced_arm_init(&reduced, &s, 0, HUGE_VAL));
    assert_true(reduced.contact.count >= 3);
    double before = 0, after = 0;
    for (int i = 0; i < reduced.contact.count; i++) {
        double rate = 0;
        for (int k = 0; k < reduced.free.count; k++) {
            rate += reduced.touch[i][k] * reduced.free.momentum[k];
        }
        after += rate * rate;
        // uniform rotation is the rigid mode alone
        check_close(rate, reduced.contact.momentum[i], 1e-6);
    }
    before = reduced.free.momentum[0] * reduced.free.momentum[0];
    check_below(after, before);
}

// --- on the rig ------------------------------------------------------------------------

TEST(overshoot_is_small_when_told_the_truth)
{
    for (EACH_TEXT(c, "control.force=0.5", "control.force=1", "control.force=2",
                   "control.force=4")) {
        summary hybrid = rig_summary_with("control.law=hybrid %s", *c);
        summary s = rig_summary_with("control.law=observer %s", *c);
        check_below(s.force_over_command_N, 0.1 * s.force_command_N);
        check_below(s.settling_time_s, 0.3);
        check_below(s.first_contact_s + s.settling_time_s,
                    1.2 * (hybrid.first_contact_s + hybrid.settling_time_s));
        check_close(s.steady_error_N, 0, 0.05 * s.force_command_N);
    }
}

// What no table covered: each within 30 %, settled, steady within 5 %.
TEST(wrong_beliefs_do_no_harm)
{
    for (EACH_TEXT(c, "belief.mass_factor=0.85", "belief.mass_factor=1.15",
                   "belief.friction_factor=0.7", "belief.friction_factor=1.3",
                   "belief.wall_error=0.03", "belief.wall_error=-0.03",
                   "belief.k2_factor=0.75", "belief.k2_factor=1.25",
                   "belief.torque_factor=0.85", "belief.torque_factor=1.15",
                   "initial.angle=-0.6", "wall.kind=plane", "wall.restitution=0.3",
                   "belief.hub_spring_factor=10", "sensor.fsr_noise=0.06",
                   "sensor.tachometer_offset=0.02", "sensor.tachometer_offset=-0.02")) {
        summary s = rig_summary_with("control.law=observer run.duration=2 %s", *c);
        check_below(s.force_over_command_N, 0.3);
        assert_false(isnan(s.settling_time_s));
        check_close(s.steady_error_N, 0, 0.05);
    }
}

// A tip thrown back is met softly: the second meeting is no harder than the command
// allows.
TEST(walls_that_throw_back_are_met_softly)
{
    for (EACH_TEXT(c, "wall.restitution=0.1", "wall.restitution=0.2",
                   "wall.contact=kelvin-voigt wall.stiffness=1000",
                   "wall.contact=kelvin-voigt wall.stiffness=5000")) {
        for (int newtons = 1; newtons <= 3; newtons += 2) {
            summary s = rig_summary_with(
                "control.law=observer run.duration=2 control.force=%d %s", newtons, *c);
            check_below(s.smoothed_over_command_N, 0.3 * newtons);
            check_below(s.settling_time_s, 0.3);
            check_below(s.first_contact_s, 1.5 * 0.293); // open-loop's
        }
    }
}

TEST(a_delay_untold_does_no_harm)
{
    summary s = rig_summary_with(
        "control.law=observer control.delay=5e-3 belief.delay_error=-5e-3");
    check_below(s.force_over_command_N, 0.3);
    check_below(s.settling_time_s, 0.3);
    check_close(s.steady_error_N, 0, 0.05);
}

// Arms of more links than it is told of, and arms that it is told of.
TEST(it_settles_on_many_links)
{
    for (EACH_OF(int, c, 3, 5, 8)) {
        for (int told = 0; told < 2; told++) {
            summary s = rig_summary_with("control.law=observer arm.damping_ratio=0.01 "
                                         "arm.links=%d belief.links=%d",
                                         *c, told ? *c : 2);
            check_below(s.smoothed_over_command_N, 0.3);
            check_below(s.settling_time_s, 0.3);
            check_close(s.steady_error_N, 0, 0.05);
        }
    }
}

// Behind a spring a torque is no force at once, and a limit on that force is none of the
// command.
TEST(a_hub_on_a_spring_does_not_swing)
{
    for (EACH_TEXT(c, "arm.k1=90", "arm.k1=150", "arm.k1=300")) {
        summary s = rig_summary_with(
            "control.law=observer control.force=2 arm.hub_joint=spring %s", *c);
        check_below(s.settling_time_s, 0.3);
        check_close(s.steady_error_N, 0, 0.05);
    }
}

// What a law gets at sample k, with this voltage so far: what the first row of these
// shows that is between it and the next sample.
static controller_input input_of(const sample **rows, int k, double period,
                                 double voltage)
{
    const sample *read = *rows;
    while (read->time < (k + 0.5) * period) {
        read++;
    }
    *rows = read;
    return (controller_input){.time = k * period,
                              .encoder = read->encoder,
                              .tachometer = read->tachometer,
                              .force = read->force_reading,
                              .voltage = voltage,
                              .piezo_force = read->piezo_force,
                              .film = read->film,
                              .accelerometer = read->accelerometer,
                              .wanted_mode = -1};
}

// The readings of a run with these settings, as all observers of the arms held possible
// see them: which of them the law ends with.
static observer_arms arms_after(const char *const *settings)
{
    scenario s = {.parameters = rig_parameters(settings)};
    KEPT_RUN(r) = run_done(&s, true);
    controller_setup setup = setup_of(&s.parameters);
    observer_task task = {.force = 1, .stopping_force = 1, .approach_voltage = 1};
    observer_arms arms;
    memset(&arms, 0, sizeof arms);
    assert_null(observer_arms_init(&arms, &setup, &task));

    const sample *read = r.trace.rows;
    int felt = 0;
    double voltage = 0;
    for (int k = 0; k < 160; k++) {
        controller_input in = input_of(&read, k, setup.period, voltage);
        felt = in.force > s.parameters.control.contact_threshold ? felt + 1 : 0;
        if (k == 0) {
            observer_arms_start(&arms, &in);
        } else {
            observer_arms_sample(&arms, &in, felt);
            observer_arms_choose(&arms);
        }
        if (felt > 0 && !observer_arms_observer(&arms)->touches) {
            observer_arms_touch(&arms, in.time);
        }
        voltage = read->voltage;
    }
    return arms;
}

// Told the truth, the arm told of; told something else, the one that is nearest: of eight
// links six, the tip's mass, and the hub that gives. A stiffness or an inertia believed
// wrongly is no other arm.
TEST(readings_tell_which_arm_it_is)
{
    for (EACH_TEXT(c, "", "belief.k2_factor=1.2", "belief.mass_factor=0.87",
                   "arm.links=3 belief.links=3",
                   "arm.links=8 belief.links=8 arm.damping_ratio=0.01")) {
        assert_int_equal(arms_after(given("control.law=observer %s", *c)).on, 0);
    }

    observer_arms three = arms_after(given("control.law=observer arm.links=3"));
    assert_int_equal(three.on, 1);
    observer_arms eight = arms_after(given("control.law=observer arm.links=8"));
    assert_int_equal(eight.on, 2);
    observer_arms loaded = arms_after(given("control.law=observer arm.tip_mass=0.08"));
    check_close(loaded.arms[loaded.on].observer.arm.inertia, 0.139 + 0.06, 0.005);
    observer_arms gives = arms_after(given("control.law=observer arm.hub_joint=spring "
                                           "arm.k1=90 belief.hub_spring_factor=100"));
    assert_int_equal(gives.on, 3);
    assert_int_equal(gives.count, 9);
}

// On a wall that gives, the arm at one that gives about as much, 1.5 k^(2/3) f^(1/3) of
// Hertz's law; the force then settles as on a rigid one.
TEST(a_wall_that_gives_is_found)
{
    static const double stiffness[] = {400, 1600, 6000};
    for (int i = 0; i < 3; i++) {
        const observer_arms soft = arms_after(
            given("control.law=observer wall.contact=hunt-crossley wall.stiffness=%g",
                  stiffness[i]));
        const double tangent = 1.5 * pow(stiffness[i], 2.0 / 3);
        static const double walls[] = {60, 150, 375, 940};
        assert_in_range(soft.on, soft.giving, soft.loaded - 1);
        assert_in_range(100 * walls[soft.on - soft.giving] / tangent, 50, 250);

        scenario s = {
            .parameters = rig_parameters(
                given("control.law=observer wall.contact=hunt-crossley "
                      "wall.stiffness=%g wall.angle=0 initial.angle=-0.1 run.duration=2",
                      stiffness[i]))};
        KEPT_RUN(r) = run_done(&s, false);
        check_below(r.summary.settling_time_s, 0.3);
        check_below(r.summary.smoothed_over_command_N, 0.15);
    }

    // a rigid one that throws the tip back is none
    const observer_arms rigid =
        arms_after(given("control.law=observer wall.restitution=0.3"));
    assert_int_equal(rigid.on, 0);
}

// A stiffness believed wrongly is learned from the readings: half the way to it counts as
// much as what was believed, and the force at the end does not depend on it.
TEST(it_learns_how_stiff_the_arm_is)
{
    for (EACH_OF(double, c, 0.75, 1.25)) {
        parameters p = rig_parameters_with("control.law=observer");
        p.belief.k2_factor = *c;
        controller_setup setup = setup_of(&p);
        arm_observer o;
        hub_sensors hub;
        assert_null(arm_observer_init(&o, &setup, 1, 0, HUGE_VAL));

        // the hub bends the arm against the wall, the readings are those of the true
        // stiffness
        const double stiffness = 4 * setup.k2 / *c;
        controller_input in = {.piezo_force = (double)NAN,
                               .film = (double)NAN,
                               .accelerometer = (double)NAN,
                               .wanted_mode = -1};
        hub_sensors_start(&hub, &in);
        arm_observer_start(&o, &in);
        arm_observer_touch(&o, 0);
        for (int k = 1; k <= 200; k++) {
            in.time = k * setup.period;
            in.encoder = fmin(0.05, 0.5 * in.time);
            in.tachometer = in.encoder < 0.05 ? 0.5 : 0;
            in.force = stiffness * in.encoder;
            in.voltage = in.force * 2 * setup.link_length / setup.torque_per_volt;
            const controller_input read = hub_sensors_read(&hub, &in, setup.period);
            arm_observer_sample(&o, &hub, &read, 2);
        }

        // from the believed one towards the true one, and not beyond
        double share = (o.stiffness - 1) / (1 / *c - 1);
        check_below(0.3, share);
        check_below(share, 1.05);
    }
}

// Pushed off the wall it finds back: the force is there again at the end.
TEST(it_finds_the_wall_again)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        scenario s = SCRIPTED(rig_parameters_with("control.law=observer run.duration=2"),
                              PUSHES(1, sign * 0.05));
        KEPT_RUN(r) = run_done(&s, false);
        check_close(r.summary.steady_error_N, 0, 0.05);
        // a blow against the wall does not reach the hub, and is not answered
        check_below(r.summary.force_over_command_N, sign > 0 ? 0.1 : 0.3);
        check_below(r.summary.first_contact_s + r.summary.settling_time_s, 1.6);
    }
}

// The speeds of the summary are those that the rows show, and the tip does not come back
// faster than it came.
TEST(the_tip_comes_back_no_faster_than_it_came)
{
    scenario s =
        SCRIPTED(rig_parameters_with("control.law=observer wall.restitution=0.3"),
                 PUSHES(0.8, -0.05));
    KEPT_RUN(r) = run_done(&s, true);

    double there = 0, back = 0;
    for (EACH_ROW(row, &r.trace)) {
        double *largest = row->time <= r.summary.first_contact_s ? &there : &back;
        if (row->contact == 0) {
            *largest = fmax(*largest, -row->gap_velocity);
        }
    }
    check_relative(r.summary.approach_speed_m_s, there, 1e-3);
    check_relative(r.summary.return_speed_m_s, back, 1e-3);
    check_below(0.01, back);
    check_below(back, there);

    // contact that is never lost has nothing to come back from
    check_close(rig_summary_with("control.law=observer").return_speed_m_s, 0, 0);
}

// Walls that give, and that throw the tip back: it comes to rest on them with the wanted
// force.
TEST(it_settles_on_walls_that_give)
{
    for (EACH_TEXT(c, "kelvin-voigt wall.stiffness=200",
                   "kelvin-voigt wall.stiffness=2e4", "kelvin-voigt wall.stiffness=1e6",
                   "kelvin-voigt wall.stiffness=1e5 wall.mass=0.01",
                   "hunt-crossley wall.stiffness=5000",
                   "hunt-crossley wall.stiffness=7.5e4",
                   "hunt-crossley wall.stiffness=1e6")) {
        summary s =
            rig_summary_with("control.law=observer run.duration=2.5 wall.contact=%s", *c);
        check_below(s.settling_time_s, 1.5);
        check_below(s.separations, 40);
        check_close(s.steady_error_N, 0, 0.05);
    }
}

// The force of a run in contact whose set-point goes from one value to another at 1 s
// [N], at a rate or at once (0).
static run_result force_after_change(double from, double to, double rate)
{
    scenario s = SCRIPTED(
        rig_parameters_with("control.law=observer control.force=%g control.force_rate=%g "
                            "run.duration=2",
                            from, rate),
        SETS(1, control.force, to));
    return run_done(&s, true);
}

// A step of the set-point settles in 0.15 s with at most a tenth of it over; a ramp is
// followed within a twentieth of the force, once the force that first goes the other way
// is over it.
TEST(it_follows_a_setpoint_in_contact)
{
    static const double steps[][2] = {{1, 1.5}, {1.5, 1}, {0.5, 1}, {1, 0.5}, {2.5, 3}};
    for (EACH(c, steps)) {
        const double to = (*c)[1], step = to - (*c)[0];
        KEPT_RUN(r) = force_after_change((*c)[0], to, 0);
        for (EACH_ROW(row, &r.trace)) {
            if (row->time > 1) {
                check_below((row->force - to) * copysign(1, step), 0.1 * fabs(step));
            }
            if (row->time > 1.15) {
                check_close(row->force, to, 0.05 * to);
            }
        }
    }

    KEPT_RUN(r) = force_after_change(1, 3, 5);
    for (EACH_ROW(row, &r.trace)) {
        if (row->time > 1.07 && row->time < 1.4) {
            check_close(row->force, 1 + 5 * (row->time - 1), 0.05 * row->force);
        }
    }
}

// A tip that drifts to the wall where no force is wanted is touched by, and nothing
// presses on it.
TEST(no_force_is_wanted_and_none_is_held)
{
    const summary m =
        rig_summary_with("control.law=observer control.force=0 initial.velocity=2");
    check_below(0, m.first_contact_s);
    check_below(fabs(m.steady_force_N), 0.05);
}

// --- laws see sensors only -------------------------------------------------------------

// The plant is replaced by a recording of what its sensors read: the commands are the
// same.
TEST(the_same_readings_give_the_same_commands)
{
    for (int law = LAW_NONE + 1; law < LAW_PLUGIN; law++) {
        scenario s = {.parameters = rig_parameters_with(
                          "sensor.film=true sensor.accelerometer=true run.duration=0.8")};
        s.parameters.control.law = law;
        KEPT_RUN(r) = run_done(&s, true);

        // the law alone, with its beliefs
        const controller *c = controller_of(law);
        double values[32];
        controller_setup setup = setup_of(&s.parameters);
        assert_true(c->parameter_count <= 32);
        DONE(controller_values(c, &s.parameters, values, &f));
        setup.parameters = values;
        SCOPED(free_kept) void *memory = calloc(1, c->memory_size + 1);
        assert_non_null(memory);
        assert_null(c->start != NULL ? c->start(memory, &setup) : NULL);

        double voltage = 0;
        const sample *read = r.trace.rows;
        const converter dac =
            converter_of(s.parameters.sensor.dac_bits, setup.voltage_limit);
        for (int k = 0; k < 159; k++) {
            controller_input in = input_of(&read, k, setup.period, voltage);
            controller_output out = {0};
            c->sample(memory, &in, &out);
            check_close(out.command, read->command, 0);
            voltage = converter_value(&dac, out.command);
        }
    }
}
