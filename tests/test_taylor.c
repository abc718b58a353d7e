// The two-link arm by power series: that they solve the equations of chain.h all over the
// stride, that the bounds hold, and that whole runs through events come out of it.
#include "src/engines/pair/taylor_integrator.h"
#include "tests/arm_fixture.h"

// An arm in some state of motion, in free flight or on the wall.
typedef struct moving_arm {
    arm arm;
    motion *motion;
} moving_arm;

static moving_arm started(const char *const *settings)
{
    moving_arm made;
    const parameters p = fixture_parameters(settings);
    arm_init(&made.arm, &p);
    made.motion = motion_create(&made.arm, &p.method);
    assert_ptr_equal(made.motion->engine, &taylor_engine);
    motion_start(&made.arm, made.motion, p.initial.angle, p.initial.velocity);
    return made;
}

static moving_arm some_motion(const char *const *settings, bool contact,
                              random_generator *g)
{
    moving_arm made = started(settings);
    motion *m = made.motion;

    // on the wall: the state nearest to a random one that is admissible
    double *q = state_angles(m, m->state), *w = state_velocities(m, m->state);
    for (int i = 0; i < m->dof; i++) {
        q[i] = (contact ? 0.1 : 0) + 0.05 * (random_uniform(g) - 0.5);
        w[i] = 2 * (random_uniform(g) - 0.5);
    }
    if (made.arm.hub_spring) {
        q[0] = q[1] + 1e-5 * (random_uniform(g) - 0.5);
    }
    m->state[SLOT_CONTACT] = contact;
    m->state[SLOT_FRICTION] = w[0] < 0 ? HUB_BACKWARD : HUB_FORWARD;
    if (random_uniform(g) < 0.25) {
        m->state[SLOT_FRICTION] = HUB_STICK;
        w[0] = 0;
    }
    for (int i = 0; i < 3; i++) { // the metric is that of the state before
        motion_evaluate(&made.arm, m, m->state);
        if (contact) {
            motion_project(&made.arm, m, m->state);
        }
    }
    m->state[SLOT_JUMPED] = 0;
    return made;
}

static const char *const *const arms[] = {
    SETTINGS("wall.kind=point"),
    SETTINGS("wall.kind=plane"),
    SETTINGS("wall.kind=point", "arm.damping_ratio=0.05"),
    SETTINGS("wall.kind=plane", "arm.hub_joint=spring", "arm.k1=90"),
    SETTINGS("wall.kind=point", "arm.hub_joint=spring", "arm.k1=20000",
             "arm.damping_ratio=0.01"),
};
enum { ARM_COUNT = sizeof arms / sizeof arms[0], STATES = 40, PLACES = 8 };

// What the series give at a place of the stride is what the chain's sweeps give for its
// angles and velocities.
static void check_place(moving_arm *moving, double h)
{
    const arm *a = &moving->arm;
    motion *m = moving->motion;
    assert_int_equal(motion_try_step(a, m, h, STATE_WHOLE), STATUS_OK);
    double alpha[3], *at = state_accelerations(m, m->trial);
    memcpy(alpha, at, (size_t)m->dof * sizeof(double));
    double force = m->trial[SLOT_FORCE], friction = m->trial[SLOT_FRICTION_TORQUE];
    double gap = m->trial[SLOT_GAP], gap_velocity = m->trial[SLOT_GAP_VELOCITY];
    double gap_acceleration = m->trial[SLOT_GAP_ACCELERATION];

    motion_evaluate(a, m, m->trial);
    double scale = 1 + fabs(at[0]) + fabs(at[m->dof - 1]) + a->hub_stiffness * 1e-5;
    for (int i = 0; i < m->dof; i++) {
        check_close(alpha[i], at[i], 2e-10 * scale);
    }
    check_close(force, m->trial[SLOT_FORCE], 1e-10 * scale);
    check_close(friction, m->trial[SLOT_FRICTION_TORQUE], 1e-10 * scale);
    check_close(gap, m->trial[SLOT_GAP], 1e-15);
    check_close(gap_velocity, m->trial[SLOT_GAP_VELOCITY], 1e-13);
    check_close(gap_acceleration, m->trial[SLOT_GAP_ACCELERATION], 2e-10 * scale);
}

// Random states of all arms, in flight and on the wall: at nine places of each stride the
// series satisfy the equations of motion.
TEST(the_series_solve_the_equations_all_over_the_stride)
{
    random_generator g = seeded(1);
    for (int i = 0; i < ARM_COUNT * STATES; i++) {
        moving_arm moving = some_motion(arms[i % ARM_COUNT], i / ARM_COUNT % 2, &g);
        // strides that something cuts short take lower orders
        for (double remaining = 0.1; remaining > 1e-4; remaining /= 3) {
            motion_end_internal_step(moving.motion);
            double h = moving.motion->engine->advance(&moving.arm, moving.motion,
                                                      remaining, 1e-3);
            assert_true(h > 0 && h <= remaining);
            for (int k = 0; k <= PLACES; k++) {
                check_place(&moving, h * k / PLACES);
            }
        }
        motion_destroy(moving.motion);
    }
}

// Several instants side by side, in vectors of any width, are those that are taken one by
// one.
TEST(instants_together_are_those_one_by_one)
{
    random_generator g = seeded(3);
    for (int i = 0; i < ARM_COUNT * STATES; i++) {
        moving_arm moving = some_motion(arms[i % ARM_COUNT], i / ARM_COUNT % 2, &g);
        const arm *a = &moving.arm;
        KEPT_MOTION(m) = moving.motion;
        taylor_limit_width(1 << i % 4);
        double h = m->engine->advance(a, m, 0.1, 1e-3), times[PLACES], *now = m->state;
        state_energy energies[PLACES];
        for (int k = 0; k < PLACES; k++) {
            times[k] = h * (k + 1) / PLACES;
        }

        // the step is made: m->trial is where it began
        if (motion_held_still(m)) {
            continue;
        }
        m->state = m->trial;
        m->trial = now;
        const int count = 1 + i % PLACES;
        assert_true(motion_between_all(a, m, times, count, energies));
        m->trial = m->state;
        m->state = now;
        for (int k = 0; k < count; k++) {
            double *at = m->between + k * m->size;
            assert_int_equal(motion_try_step(a, m, times[k], STATE_WHOLE), STATUS_OK);
            m->trial[SLOT_TIME] = times[k];
            assert_memory_equal(at, m->trial, (size_t)m->size * sizeof *at);
            const state_energy has = motion_energy(a, m, at);
            assert_memory_equal(&energies[k], &has, sizeof has);
        }
    }
    taylor_limit_width(0);
}

// A long stride and the short ones of lower order that make it up end in the same state.
TEST(orders_agree_and_the_ledger_closes)
{
    random_generator g = seeded(2);
    for (int i = 0; i < ARM_COUNT * STATES; i++) {
        moving_arm moving = some_motion(arms[i % ARM_COUNT], i / ARM_COUNT % 2, &g);
        KEPT_MOTION(m) = moving.motion;
        double *q = state_angles(m, m->state);
        m->record.start_energy =
            chain_kinetic_energy(&moving.arm, q, state_velocities(m, m->state)) +
            chain_strain_energy(&moving.arm, q);
        double h = m->engine->advance(&moving.arm, m, 0.1, 1e-3),
               whole[SLOT_COUNT + 4 * 3 + QUADRATURE_COUNT + KEPT_COUNT];
        assert_int_equal(motion_try_step(&moving.arm, m, h, STATE_WHOLE), STATUS_OK);
        check_below(fabs(motion_energy_residual(&moving.arm, m, m->trial)), 1e-12);
        memcpy(whole, m->trial, (size_t)m->size * sizeof(double));

        int strides = 0;
        for (int k = 1; k <= 8; k++) {
            while (m->state[SLOT_TIME] < h * k / 8 - 1e-15) {
                double left = h * k / 8 - m->state[SLOT_TIME];
                motion_end_internal_step(m);
                double step = m->engine->advance(&moving.arm, m, left, 1e-3);
                assert_int_equal(motion_try_step(&moving.arm, m, step, STATE_WHOLE),
                                 STATUS_OK);
                memcpy(m->state, m->trial, (size_t)m->size * sizeof(double));
                strides++;
            }
        }
        assert_in_range(strides, 8, 32);
        for (int k = 0; k < 2 * m->dof + QUADRATURE_COUNT; k++) {
            check_close(m->state[SLOT_COUNT + k], whole[SLOT_COUNT + k], 1e-12);
        }
    }
}

// A step of a motion that is to be cut before the stride ends.
static motion_event step_cut(const moving_arm *moving, double until, double after)
{
    motion_report report;
    motion *m = moving->motion;
    m->record.tstop = m->state[SLOT_TIME] + after;
    assert_int_equal(motion_step(&moving->arm, m, until, 1e-3, &report), STATUS_OK);
    m->record.tstop = HUGE_VAL;
    return report.event;
}

// The same motion is taken to its first event in three ways. `whole` goes there without a
// cut. `cut` is stopped at random instants and goes on in the same stride: the state at
// the event is that of `whole`, but for rounding. The third way is stopped at the same
// instants, but each time the state is handed to another motion that knows nothing else;
// made[2] and made[3] take turns. Its state at the event is that of `cut`, to the last
// bit.
TEST(cut_strides_go_on)
{
    enum { UNTIL = 1 };
    random_generator g = seeded(7);
    for (int i = 0; i < ARM_COUNT * STATES; i++) {
        moving_arm made[4]; // whole, cut, and two that take turns
        const random_generator before = g;
        for (int k = 0; k < 4; k++) {
            g = before;
            made[k] = some_motion(arms[i % ARM_COUNT], i / ARM_COUNT % 2, &g);
        }
        motion *whole = made[0].motion, *cut = made[1].motion;
        const size_t size = (size_t)cut->size * sizeof(double);

        // each to its first event; 5 - turn is the motion that waits, 3 or 2
        motion_report report;
        motion_event met = MOTION_REACHED, handed = MOTION_REACHED;
        int turn = 2;
        assert_int_equal(motion_advance(&made[0].arm, whole, UNTIL, 1e-3, &report),
                         STATUS_OK);
        while (met == MOTION_REACHED && cut->state[SLOT_TIME] < UNTIL) {
            const double after = 1e-4 + 0.01 * random_uniform(&g);
            const long steps = cut->record.steps;
            met = step_cut(&made[1], UNTIL, after);
            handed = step_cut(&made[turn], UNTIL, after);
            assert_true(cut->record.steps > steps);
            memcpy(made[5 - turn].motion->state, made[turn].motion->state, size);
            motion_invalidate_history(made[5 - turn].motion);
            turn = 5 - turn;
        }

        // the same event, in the same state
        assert_int_equal(met, report.event);
        assert_int_equal(handed, report.event);
        assert_memory_equal(cut->state, made[turn].motion->state, size);

        // angles, velocities and integrals of the motion that nobody cut
        for (int k = 0; k < 2 * cut->dof + QUADRATURE_COUNT; k++) {
            const double scale = 1 + fabs(whole->state[SLOT_COUNT + k]);
            check_close(cut->state[SLOT_COUNT + k], whole->state[SLOT_COUNT + k],
                        1e-12 * scale);
        }
        for (int k = 0; k < 4; k++) {
            motion_destroy(made[k].motion);
        }
    }
}

// No watched function is anywhere below what its ends and the bound on its bend leave
// room for, and none falls in a stride over which the kernel has it stay above zero, nor
// is the force above the kernel's bound.
TEST(the_bounds_hold)
{
    random_generator g = seeded(3);
    int looked_at = 0;
    for (int i = 0; i < ARM_COUNT * STATES; i++) {
        moving_arm moving = some_motion(arms[i % ARM_COUNT], i / ARM_COUNT % 2, &g);
        KEPT_MOTION(m) = moving.motion;
        const engine *e = m->engine;
        // an arm that is held still has no series
        if (motion_held_still(m)) {
            continue;
        }
        double h = m->engine->advance(&moving.arm, m, 0.1, 1e-3);
        looked_at++;
        bool contact = m->state[SLOT_CONTACT] != 0,
             stuck = m->state[SLOT_FRICTION] == HUB_STICK;
        const event_function watched[] = {contact ? EVENT_OF_FORCE : EVENT_OF_GAP,
                                          stuck ? EVENT_OF_STICTION : EVENT_OF_HUB};
        for (int n = 0; n < 2; n++) {
            event_function w = watched[n];
            for (int part = 0; part < 4; part++) {
                double from = h * part / 4, to = h * (part + 1) / 4, width = to - from;
                double lower =
                    fmin(e->event_function(&moving.arm, m, w, from).value,
                         e->event_function(&moving.arm, m, w, to).value) -
                    e->second_derivative(&moving.arm, m, w, from, to) * width * width / 8;
                for (int k = 1; k < 16; k++) {
                    double t = from + width * k / 16;
                    check_below(lower,
                                e->event_function(&moving.arm, m, w, t).value + 1e-12);
                }
            }
        }

        const double *block = ((const taylor_integrator *)m->memory)->lane.block;
        const double least[] = {block[AT_WALL_LEAST], block[AT_HUB_LEAST]};
        for (int k = 1; k <= 64; k++) {
            const double t = h * k / 64;
            for (int n = 0; n < 2; n++) {
                assert_true(!(least[n] > 0) ||
                            e->event_function(&moving.arm, m, watched[n], t).value > 0);
            }
            if (contact) {
                check_below(motion_output(&moving.arm, m, OUTPUT_FORCE, t).value,
                            block[AT_FORCE_MOST] + 1e-12);
            }
        }
    }
    assert_true(looked_at > ARM_COUNT * STATES / 2);
}

// Where the kernel has found a root, the watched function falls there, and not before.
TEST(known_roots_are_the_first)
{
    enum { LOOKS = 100 };
    random_generator g = seeded(8);
    int known = 0;
    for (int i = 0; i < ARM_COUNT * STATES; i++) {
        moving_arm moving = some_motion(arms[i % ARM_COUNT], i / ARM_COUNT % 2, &g);
        KEPT_MOTION(m) = moving.motion;
        if (motion_held_still(m)) {
            continue;
        }
        const double h = m->engine->advance(&moving.arm, m, 0.1, 1e-3);
        const taylor_integrator *s = m->memory;
        const bool contact = m->state[SLOT_CONTACT] != 0;
        const event_function watched[] = {contact ? EVENT_OF_FORCE : EVENT_OF_GAP,
                                          EVENT_OF_HUB};
        const double roots[] = {s->lane.block[AT_WALL_ROOT], s->lane.block[AT_HUB_ROOT]};
        for (int n = 0; n < 2; n++) {
            const double root = roots[n], near = 1e-9 * h;
            for (int k = 1; k < LOOKS && root > 0; k++) {
                const double t = root * k / LOOKS;
                assert_true(
                    m->engine->event_function(&moving.arm, m, watched[n], t).value > 0);
            }
            if (root > near) {
                known++;
                assert_true(
                    m->engine->event_function(&moving.arm, m, watched[n], root - near)
                        .value > 0);
                assert_true(
                    m->engine->event_function(&moving.arm, m, watched[n], root + near)
                        .value < 0);
            }
        }
    }
    assert_true(known > STATES / 4);
}

// Rows so near each other that none of them misses the peak by more than rounding.
TEST(peaks_are_the_largest_force_there_is)
{
    for (EACH_TEXT(c, "motor.voltage=0.5537109375", "motor.voltage=1",
                   "motor.voltage=3.3")) {
        RUN(r, *c, "method.step=2e-6", "run.duration=0.7");
        double largest = 0;
        for (EACH_ROW(row, &r.trace)) {
            largest = fmax(largest, row->force);
        }
        check_close(r.summary.peak_force_N, largest, 1e-9);
        check_below(largest, r.summary.peak_force_N * (1 + 1e-13));
    }
}

// Rows are read off the stride: the more of them, the more strides are the same.
TEST(rows_change_nothing)
{
    RUN(few, "method.step=0.1");
    RUN(many, "method.step=1e-4");
    assert_true(few.summary.first_contact_s == many.summary.first_contact_s);
    assert_true(few.summary.peak_force_N == many.summary.peak_force_N);
    assert_true(few.summary.motor_work_J == many.summary.motor_work_J);
    assert_true(few.summary.energy_residual_J == many.summary.energy_residual_J);
}

// An impact, a release and a touch within microseconds of each other.
TEST(events_that_nearly_coincide_are_told_apart)
{
    RUN(r, "motor.voltage=0.63671875", "arm.k2=6.909140625", "wall.angle=0.141015625");
    check_close(r.summary.first_contact_s, 0.452259, 1e-6);
    check_below(r.summary.energy_residual_J, 1e-13);
}

// Motor, arm, wall and restitution at random.
TEST(random_runs_neither_fail_nor_lose_energy)
{
    enum { RUNS = 3000 };
    random_generator g = seeded(4);
    for (int i = 0; i < RUNS; i++) {
        double u[6];
        for (int k = 0; k < 6; k++) {
            u[k] = random_uniform(&g);
        }
        scenario s = {.parameters = fixture_parameters(NULL)};
        parameters *p = &s.parameters;
        p->motor.voltage = 0.3 + 3 * u[0];
        p->motor.stiction = u[1] < 0.2 ? 0 : 0.1 * u[1];
        p->arm.k2 = 2.5 + 10 * u[2];
        p->wall.angle = 0.02 + 0.3 * u[3];
        p->wall.restitution = u[4] < 0.4 ? 0 : u[4];
        p->wall.kind = i % 2 ? WALL_POINT : WALL_PLANE;
        p->arm.damping_ratio = u[5] < 0.5 ? 0 : 0.1 * (u[5] - 0.5);
        KEPT_RUN(r);
        fail_if(run_scenario(&s, false, &r) != STATUS_OK, "run %d: %s", i,
                r.summary.message);
        check_below(r.summary.energy_residual_J, 1e-11 * (1 + r.summary.motor_work_J));
    }
}

// The next event of an arm, at the latest at an instant `until`; MOTION_REACHED if there
// is none.
static motion_event next_event(moving_arm *moving, double until)
{
    motion_report report;
    assert_int_equal(motion_advance(&moving->arm, moving->motion, until, 1e-3, &report),
                     STATUS_OK);
    motion_apply(&moving->arm, moving->motion, &report);
    return report.event;
}

// An arm that starts on the wall and goes into it, however slowly, strikes it at once,
// though the motor throws it back.
TEST(a_slow_start_into_the_wall_is_an_impact)
{
    for (EACH_TEXT(c, "wall.kind=point", "wall.kind=plane")) {
        for (double speed = 1e-8; speed < 1e-3; speed *= 10) {
            moving_arm moving = started(
                SETTINGS(*c, "arm.k2=20000", "motor.voltage=10",
                         "motor.amplifier_gain=1000", "wall.angle=3", "initial.angle=3",
                         formatted("initial.velocity=%g", speed)));
            assert_int_equal(next_event(&moving, 1e-3), MOTION_IMPACT);
            assert_true(moving.motion->state[SLOT_TIME] == 0);
            motion_destroy(moving.motion);
        }
    }
}

// Counts the releases of an arm until an instant [s]; each ends a contact.
static int count_releases(moving_arm moving, double until)
{
    int releases = 0;
    bool holds = false;
    for (motion_event e; (e = next_event(&moving, until)) != MOTION_REACHED;) {
        assert_true(e != MOTION_RELEASE || holds);
        holds = moving.motion->state[SLOT_CONTACT] != 0;
        assert_true(e != MOTION_RELEASE || !holds);
        releases += e == MOTION_RELEASE;
    }
    motion_destroy(moving.motion);
    return releases;
}

// Light arms that turn at a hundred rad/s leave the wall once for each time that they
// have touched it: what the series leave out is no force that holds them.
TEST(an_arm_in_fast_rotation_is_released_once)
{
    int releases = 0;
    for (int i = 0; i < 60; i++) {
        moving_arm moving = started(
            SETTINGS(formatted("motor.voltage=%g", 8 + 0.1 * i), "arm.length=2.4",
                     "arm.mass=0.022", "arm.hub_inertia=0.0096",
                     "motor.torque_constant=9", "motor.back_emf=0", "motor.resistance=8",
                     "motor.stiction=0", "wall.angle=0.8", "initial.angle=-0.3"));
        releases += count_releases(moving, 0.2);
    }
    assert_true(releases >= 60);
}

// Arms with an amplifier a hundred times too strong, for which rounding counts for more,
// also leave the wall once for each touch (count_releases checks it). Their
// numbers have all their digits for that reason.
TEST(a_strong_motor_releases_once)
{
    const char *const *const strong[] = {
        SETTINGS("motor.amplifier_gain=1000", "motor.voltage=-9.8976274932817212",
                 "motor.viscous_friction=0", "wall.angle=0.0087266395815328579",
                 "arm.length=3.0082092444542567", "arm.k2=2.3498517744129486"),
        SETTINGS("motor.amplifier_gain=1000", "motor.voltage=8.4197388390802779",
                 "motor.torque_constant=16.42653521822491", "motor.back_emf=0",
                 "motor.resistance=9.0298977243827725", "motor.viscous_friction=0",
                 "motor.stiction=0.000139851492901509", "wall.angle=-0.90540409675491051",
                 "wall.restitution=0.32090749280125364", "arm.length=2.5058063083989945",
                 "arm.mass=0.1091521425349667", "arm.k2=0.71729569257682524",
                 "arm.damping_ratio=0.00098877030493864739",
                 "initial.angle=-2.3385806938907905",
                 "initial.velocity=-1.6613505629975811"),
    };
    for (int i = 0; i < 2; i++) {
        assert_true(count_releases(started(strong[i]), 0.6) > 0);
    }
}
