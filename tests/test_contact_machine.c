// Transitions of the contact machine on one rod, taken one by one: what each event does
// to the state, and what the state is found to be afterwards. Whole runs are in
// test_motion.c.
#include "tests/arm_fixture.h"
#include "tests/explicit_stepper.h"

// A rod on its hub with its motion.
typedef struct moving_rod {
    arm arm;
    motion *motion;
    double inertia; // about the hub [kg m2]
} moving_rod;

// By the engine of the arm's own, or a chosen one.
static moving_rod start_rod_by(const char *const *settings, const engine *by)
{
    parameters p = fixture_parameters(settings);
    moving_rod r = {.inertia =
                        p.arm.mass * p.arm.length * p.arm.length / 3 + p.arm.hub_inertia};
    arm_init(&r.arm, &p);
    r.motion = motion_create_by(&r.arm, &p.method, by);
    assert_non_null(r.motion);
    motion_start(&r.arm, r.motion, p.initial.angle, p.initial.velocity);
    return r;
}

static void drop_rod(moving_rod *r)
{
    motion_destroy(r->motion);
}

#define START_ROD_BY(r, by, ...)                                                         \
    SCOPED(drop_rod) moving_rod r = start_rod_by(given(__VA_ARGS__), by)
#define START_ROD(r, ...) START_ROD_BY(r, NULL, __VA_ARGS__)

// A step, and its event, which is not applied.
static motion_report step_of(moving_rod *r, double until)
{
    motion_report report;
    assert_int_equal(motion_step(&r->arm, r->motion, until, 1e-3, &report), STATUS_OK);
    return report;
}

static double speed_of(const moving_rod *r)
{
    return state_velocities(r->motion, r->motion->state)[0];
}

static bool touches(const moving_rod *r)
{
    return r->motion->state[SLOT_CONTACT] != 0;
}

// Steps to the next event before `until` and applies it.
static motion_report next_event(moving_rod *r, double until)
{
    motion_report report = {.event = MOTION_REACHED};
    while (r->motion->state[SLOT_TIME] < until && report.event == MOTION_REACHED) {
        report = step_on(&r->arm, r->motion, until, 1e-3);
    }
    return report;
}

TEST(the_state_at_the_start_follows_from_where_the_arm_is)
{
    // pressed at the wall, the wall answers with all of the motor's torque
    START_ROD(pressed, "arm.links=1 initial.angle=0.1");
    assert_true(touches(&pressed));
    check_relative(pressed.motion->state[SLOT_FORCE], pressed.arm.motor.torque, 1e-12);

    // less torque than stiction away from the wall: the hub sticks
    START_ROD(stuck, "arm.links=1 motor.voltage=0.05");
    assert_false(touches(&stuck));
    assert_true(stuck.motion->state[SLOT_FRICTION] == HUB_STICK);
    check_close(stuck.motion->state[SLOT_FRICTION_TORQUE], -stuck.arm.motor.torque,
                1e-15);

    // more, and it slides
    START_ROD(driven, "arm.links=1 motor.voltage=1");
    assert_true(driven.motion->state[SLOT_FRICTION] == HUB_FORWARD);
}

// A face stands at rest: an arm that starts on it and moves into it strikes it at once,
// as one does that comes from next to it.
TEST(an_arm_that_starts_on_a_face_strikes_it)
{
    const double speed = 0.2, mass = 0.5;
    START_ROD(r, "arm.links=1 wall.contact=kelvin-voigt wall.stiffness=1e4 "
                 "wall.mass=0.5 initial.angle=0.1 initial.velocity=0.2");
    motion *m = r.motion;
    const double inertia = r.inertia, length = r.arm.link_length;
    assert_false(touches(&r));
    check_relative(m->record.start_energy, inertia * speed * speed / 2, 1e-12);

    motion_report report = step_of(&r, 0.01);
    assert_int_equal(report.event, MOTION_IMPACT);
    check_below(m->state[SLOT_TIME], 1e-12);
    motion_apply(&r.arm, m, &report);
    check_relative(report.speed, speed * length, 1e-9);
    check_relative(m->state[SLOT_FACE_VELOCITY],
                   inertia * speed * length / (inertia + mass * length * length), 1e-9);
}

// How fast a face is met decides whether the arm bounces: one that flees is met slowly.
TEST(a_face_that_flees_is_met_slowly)
{
    for (int i = 0; i < 2; i++) {
        START_ROD(r, "arm.links=1 wall.contact=kelvin-voigt wall.stiffness=1e4 "
                     "wall.mass=0.5 wall.restitution=0.5 method.rest_speed=0.02 "
                     "initial.velocity=0.2");
        motion *m = r.motion;
        const double *q = state_angles(m, m->state), *w = state_velocities(m, m->state);
        const double met = i == 0 ? 0.01 : 0.03;
        m->state[SLOT_FACE_VELOCITY] = chain_penetration_rate(&r.arm, q, w) - met;
        motion_report impact = {.event = MOTION_IMPACT};
        motion_apply(&r.arm, m, &impact);
        const double left =
            chain_penetration_rate(&r.arm, q, w) - m->state[SLOT_FACE_VELOCITY];
        check_relative(impact.speed, met, 1e-9);
        check_close(left, i == 0 ? 0 : -0.5 * met, 1e-12);
    }
}

TEST(a_plastic_impact_stops_the_rod_and_holds_it)
{
    START_ROD(r, "arm.links=1");
    motion_report impact = next_event(&r, 1);
    assert_int_equal(impact.event, MOTION_IMPACT);
    assert_true(impact.holds && touches(&r));
    check_relative(impact.impulse, r.inertia * impact.speed, 1e-12);
    check_relative(impact.loss, r.inertia * impact.speed * impact.speed / 2, 1e-12);
    check_close(speed_of(&r), 0, 1e-15);
}

TEST(an_elastic_impact_turns_the_rod_back)
{
    START_ROD(r, "arm.links=1 wall.restitution=0.8");
    motion_report impact = next_event(&r, 1);
    assert_int_equal(impact.event, MOTION_IMPACT);
    assert_false(impact.holds || touches(&r));
    check_relative(speed_of(&r), -0.8 * impact.speed, 1e-12);
    check_close(r.motion->state[SLOT_FORCE], 0, 0);
}

// The face of a wall that gives stays on an arm that is pushed as long as it presses,
// parts from one that is torn away faster than it follows, and is met again.
TEST(a_push_parts_arm_and_face)
{
    for (int i = 0; i < 2; i++) {
        START_ROD(r,
                  "arm.links=1 wall.contact=kelvin-voigt wall.damping=%d "
                  "wall.stiffness=1e5 wall.angle=0 motor.voltage=1 initial.velocity=0.1",
                  50 * i);
        motion_report report;
        assert_true(touches(&r));

        // at the touch, the spring still straight
        motion_push(&r.arm, r.motion, 1e-3, &report);
        assert_true(report.holds && touches(&r));
        assert_int_equal(report.event, MOTION_REACHED);
        assert_int_equal(motion_advance(&r.arm, r.motion, 1e-3, 1e-3, &report),
                         STATUS_OK);
        const double depth = -r.motion->state[SLOT_GAP];
        check_below(0, depth);

        // away: without a damper the spring goes along, with one the face is left behind
        motion_push(&r.arm, r.motion, -100, &report);
        assert_int_equal(touches(&r), i == 0);
        assert_int_equal(state_face_swings(r.motion, r.motion->state), i == 1);
        assert_true(i == 0 || r.motion->state[SLOT_FORCE] == 0);

        // back, and there it is again
        motion_push(&r.arm, r.motion, 100, &report);
        report = i == 1 ? next_event(&r, 1) : report;
        assert_int_equal(report.event, i == 1 ? MOTION_TOUCH : MOTION_REACHED);
        check_close(r.motion->state[SLOT_TIME], 1e-3, 1e-12);
        assert_true(touches(&r) && !state_face_swings(r.motion, r.motion->state));
        check_close(-r.motion->state[SLOT_GAP], depth, 1e-12);
        check_below(0, r.motion->state[SLOT_FORCE]);

        // away again, and pushed on after that
        motion_push(&r.arm, r.motion, -100, &report);
        motion_push(&r.arm, r.motion, -100, &report);
        assert_int_equal(touches(&r), i == 0);
    }
}

// Stiction is a limit without a margin: a torque beyond it by a hundred millionth moves
// the rod.
TEST(a_torque_just_beyond_stiction_moves_the_rod)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        START_ROD(r, "arm.links=1 motor.voltage=0.05");
        assert_int_equal(contact_state_of(r.motion->state).friction, HUB_STICK);
        const double per_volt = r.arm.motor.torque / 0.05,
                     stiction = r.arm.motor.stiction;
        arm_set_voltage(&r.arm, sign * (1 + 1e-8) * stiction / per_volt);
        motion_start(&r.arm, r.motion, 0, 0);
        assert_int_equal(contact_state_of(r.motion->state).friction,
                         sign < 0 ? HUB_BACKWARD : HUB_FORWARD);
        check_relative(state_accelerations(r.motion, r.motion->state)[0],
                       sign * 1e-8 * stiction / r.inertia, 1e-6);
    }
}

// Where the engine steps, a summit of the force is found by stepping again from the
// step's start; the step then ends as if it had not been looked for. The series of the
// same arm have no need to.
TEST(a_located_peak_leaves_the_step_as_it_was)
{
    START_ROD_BY(steps, &explicit_engine, "arm.links=2");
    START_ROD(series, "arm.links=2");
    assert_ptr_not_equal(steps.motion->engine, series.motion->engine);
    moving_rod *const both[] = {&steps, &series};
    for (int i = 0; i < 2; i++) {
        motion *m = both[i]->motion;
        while (m->state[SLOT_TIME] < 0.4) {
            const double start = m->state[SLOT_TIME];
            motion_report report = step_of(both[i], 0.4);
            check_close(m->state[SLOT_TIME], start + m->step.last, 1e-14);
            motion_apply(&both[i]->arm, m, &report);
        }
    }

    // after its first pulses
    assert_true(series.motion->record.pulse_peak > 1);
    check_relative(steps.motion->record.pulse_peak, series.motion->record.pulse_peak,
                   1e-9);
    check_close(steps.motion->record.pulse_peak_time,
                series.motion->record.pulse_peak_time, 1e-5);
    for (int i = 0; i < 2 * series.motion->dof + QUADRATURE_COUNT; i++) {
        check_close(steps.motion->state[SLOT_COUNT + i],
                    series.motion->state[SLOT_COUNT + i], 1e-8);
    }
}

TEST(a_push_in_flight_adds_its_impulse)
{
    START_ROD(r, "arm.links=1 wall.kind=none initial.velocity=1");
    motion_report report = {0};
    motion_push(&r.arm, r.motion, 0.03, &report);
    assert_int_equal(report.event, MOTION_REACHED);
    check_relative(speed_of(&r), 1 + 0.03 / r.inertia, 1e-13);
    // its work is that of the mean velocity
    check_relative(r.motion->state[SLOT_EXTERNAL_WORK], 0.03 * (1 + speed_of(&r)) / 2,
                   1e-12);
}

TEST(a_push_into_the_wall_is_answered_by_it)
{
    START_ROD(r, "arm.links=1 initial.angle=0.1");
    motion_report report = {0};
    motion_push(&r.arm, r.motion, 0.03, &report);
    assert_int_equal(report.event, MOTION_IMPACT);
    check_relative(report.impulse, 0.03, 1e-12);
    check_close(speed_of(&r), 0, 1e-14);
    assert_true(report.holds && touches(&r));
}

TEST(a_push_away_ends_the_contact)
{
    START_ROD(r, "arm.links=1 initial.angle=0.1");
    motion_report report = {0};
    motion_push(&r.arm, r.motion, -0.03, &report);
    assert_false(report.holds || touches(&r));
    check_relative(speed_of(&r), -0.03 / r.inertia, 1e-12);
}

TEST(a_torque_away_from_the_wall_ends_the_contact)
{
    START_ROD(r, "arm.links=1 initial.angle=0.1");
    double before = r.arm.motor.torque;
    arm_set_voltage(&r.arm, -1);
    motion_retorque(&r.arm, r.motion, before);
    assert_false(touches(&r));
    double torque = r.arm.motor.torque + r.arm.motor.stiction;
    check_relative(state_accelerations(r.motion, r.motion->state)[0], torque / r.inertia,
                   1e-12);
}

// A release is looked at, not obeyed: what is pressed at the wall stays there.
TEST(a_release_of_what_is_pressed_is_none)
{
    START_ROD(r, "arm.links=1 initial.angle=0.1");
    const double force = r.motion->state[SLOT_FORCE];
    motion_report release = {.event = MOTION_RELEASE};
    motion_apply(&r.arm, r.motion, &release);
    assert_true(touches(&r));
    check_relative(r.motion->state[SLOT_FORCE], force, 1e-12);
}

// Without stiction a hub that begins to turn meets no event of friction on its way to the
// wall.
TEST(a_hub_without_stiction_never_sticks)
{
    START_ROD(r, "arm.links=1 motor.stiction=0");
    assert_int_equal(next_event(&r, 1).event, MOTION_IMPACT);
}

// A wall that gives stops nothing at once: the rod of 1 m keeps its speed, the damper
// answers it.
TEST(a_wall_that_gives_takes_the_rod_at_its_speed)
{
    START_ROD(r,
              "arm.links=1 wall.contact=kelvin-voigt wall.stiffness=1e4 wall.damping=20");
    motion_report report;
    while ((report = step_of(&r, 1)).event == MOTION_REACHED) {
    }
    assert_int_equal(report.event, MOTION_TOUCH);
    const double speed = speed_of(&r);
    motion_apply(&r.arm, r.motion, &report);
    assert_true(report.holds && touches(&r));
    check_close(speed_of(&r), speed, 0);
    check_relative(r.motion->state[SLOT_FORCE], 20 * speed, 1e-9);
}

// A hub behind its spring under a torque that jumps: one that slides is accelerated by
// all of it, one that sticks lets friction take it.
TEST(a_sliding_hub_feels_a_jump_of_the_torque_and_a_stuck_one_does_not)
{
    START_ROD(sliding, "arm.hub_joint=spring initial.velocity=1");
    const double torque = sliding.arm.motor.torque;
    const double before = state_accelerations(sliding.motion, sliding.motion->state)[0];
    arm_set_voltage(&sliding.arm, 0.5);
    const double jump = sliding.arm.motor.torque - torque;
    assert_true(jump < 0);
    motion_retorque(&sliding.arm, sliding.motion, torque);
    check_close(sliding.motion->state[SLOT_FRICTION_TORQUE], -sliding.arm.motor.stiction,
                0);
    check_relative(state_accelerations(sliding.motion, sliding.motion->state)[0] - before,
                   jump / sliding.arm.hub_inertia, 1e-9);

    START_ROD(stuck, "arm.hub_joint=spring motor.voltage=0.05");
    const double held = stuck.arm.motor.torque;
    assert_true(stuck.motion->state[SLOT_FRICTION] == HUB_STICK);
    stuck.motion->state[SLOT_JUMPED] = 0;
    arm_set_voltage(&stuck.arm, 0.06);
    motion_retorque(&stuck.arm, stuck.motion, held);
    assert_true(stuck.motion->state[SLOT_FRICTION] == HUB_STICK);
    check_close(stuck.motion->state[SLOT_FRICTION_TORQUE], -stuck.arm.motor.torque,
                1e-15);
    check_close(state_accelerations(stuck.motion, stuck.motion->state)[0], 0, 0);
    assert_true(stuck.motion->state[SLOT_JUMPED] ==
                0); // the implicit methods go on as they were
}

TEST(a_cut_changes_nothing_before_it)
{
    START_ROD(free, "arm.links=1");
    START_ROD(cut, "arm.links=1");
    cut.motion->record.tstop = 0.35; // after the impact
    motion_report a = next_event(&free, 1), b = next_event(&cut, 1);
    assert_int_equal(a.event, MOTION_IMPACT);
    assert_int_equal(b.event, MOTION_IMPACT);
    assert_memory_equal(free.motion->state, cut.motion->state,
                        (size_t)free.motion->size * sizeof(double));
}

// A motion that was begun anew is the one it was the first time, to the last bit.
TEST(a_motion_can_be_started_again)
{
    START_ROD(r, "arm.links=1 motor.voltage=3");
    double first[256];
    const size_t size = (size_t)r.motion->size;
    assert_true(size <= sizeof first / sizeof first[0]);
    for (int i = 0; i < 2; i++) {
        motion_start(&r.arm, r.motion, 0, 0);
        next_event(&r, 1);
        assert_true(touches(&r));
        step_of(&r, 1);
        if (i == 0) {
            memcpy(first, r.motion->state, size * sizeof *first);
        }
    }
    assert_memory_equal(first, r.motion->state, size * sizeof *first);
}

// The algorithmic accelerations that the implicit methods go on with are those of the
// instant; where those say nothing, the next step finds out.
static void assert_starts_anew(const moving_rod *r)
{
    motion *m = r->motion;
    if (motion_unresolved(&r->arm, m)) {
        return;
    }
    assert_memory_equal(state_algorithmic(m, m->state), state_accelerations(m, m->state),
                        (size_t)m->dof * sizeof(double));
    assert_true(m->state[SLOT_JUMPED] == 1);
}

// After every jump, of events and of torques, an implicit method starts anew.
TEST(implicit_methods_start_anew_after_a_jump)
{
    int events[MOTION_SLIP + 1] = {0}, moved = 0;
    for (int i = 0; i < 4; i++) {
        START_ROD(r,
                  "method.name=generalized-alpha arm.hub_joint=%s arm.links=%d "
                  "motor.stiction=0.02",
                  i / 2 ? "spring" : "rigid", i % 2 ? 5 : 2);
        assert_starts_anew(&r);
        const double start[] = {0.35, 0.5, 0.6, 0.7, 0.8, 0.9},
                     volts[] = {2, -0.5, 0.8, 0.3, 0, 1};
        for (int k = 0; k < 6; k++) {
            while (r.motion->state[SLOT_TIME] < start[k]) {
                motion_report next = next_event(&r, start[k]);
                events[next.event]++;
                if (next.event != MOTION_REACHED) {
                    assert_starts_anew(&r);
                }
            }

            // another torque accelerates a hub that is not stuck
            const bool sticks = contact_state_of(r.motion->state).friction == HUB_STICK;
            const double before = r.arm.motor.torque;
            arm_set_voltage(&r.arm, volts[k]);
            motion_retorque(&r.arm, r.motion, before);
            if (!sticks) {
                assert_starts_anew(&r);
                moved++;
            }
        }
    }
    assert_true(events[MOTION_IMPACT] > 3 && events[MOTION_RELEASE] > 1 && moved > 3);
}

// What is held at wall and hub has neither velocity nor acceleration, to the last bit,
// and stays.
TEST(what_is_held_does_not_move)
{
    for (int i = 0; i < 4; i++) {
        START_ROD(
            r, "motor.stiction=%g method.name=%s arm.damping_ratio=0.1 motor.voltage=2",
            i % 2 ? 0.4 : 0.1, i / 2 ? "generalized-alpha" : "event");
        motion *m = r.motion;
        const double *q = state_angles(m, m->state);
        int held = 0;
        double before[2] = {0};
        while (m->state[SLOT_TIME] < 4 && held < 20) {
            const motion_event next = next_event(&r, m->state[SLOT_TIME] + 0.01).event;
            if (!motion_held_still(m) || next != MOTION_REACHED) {
                held = 0;
                continue;
            }
            for (int k = 0; k < m->dof; k++) {
                check_close(state_velocities(m, m->state)[k], 0, 0);
                check_close(state_accelerations(m, m->state)[k], 0, 0);
                check_close(held > 0 ? q[k] : 0, held > 0 ? before[k] : 0, 1e-12);
                before[k] = q[k];
            }
            held++;
        }
        assert_int_equal(m->dof, 2);
        assert_int_equal(held, 20);
    }
}

// An arm with long flights keeps bouncing: the chatter rule counts only short flights.
TEST(bounces_in_long_flights_are_no_chatter)
{
    START_ROD(r, "arm.links=2 wall.restitution=0.95 motor.voltage=2 motor.stiction=0 "
                 "arm.damping_ratio=0.01");
    const double shortest = 2 * 3.14159265358979 / r.arm.highest_frequency;
    int far = 0, in_a_row = 0;
    double last = -HUGE_VAL;
    while (far <= MOTION_MOST_SHORT_FLIGHTS + 10) {
        // thrown back now and then
        motion_report next = next_event(&r, r.motion->state[SLOT_TIME] + 0.05);
        if (next.event == MOTION_REACHED) {
            motion_push(&r.arm, r.motion, -0.03, &next);
        }
        if (next.event == MOTION_IMPACT) {
            const double now = r.motion->state[SLOT_TIME];
            in_a_row = now - last < 0.01 * shortest ? in_a_row + 1 : 0;
            far += now - last > 0.02 * shortest;
            last = now;
            assert_true(!next.chatter || in_a_row > MOTION_MOST_SHORT_FLIGHTS);
        }
    }
}

// A force that only rises is largest at the last instant there was, one that only falls
// where it began.
TEST(the_peak_of_a_rising_force_is_at_its_end)
{
    for (int i = 0; i < 2; i++) {
        START_ROD_BY(r, i == 0 ? NULL : &explicit_engine, "arm.links=2");
        motion *m = r.motion;
        while (next_event(&r, 1).event != MOTION_IMPACT) {
        }
        const double touched = m->state[SLOT_TIME];
        double last = m->state[SLOT_FORCE];
        int rising = 0;
        for (int k = 1; k < 200 && m->state[SLOT_CONTACT] != 0; k++) {
            step_on(&r.arm, m, touched + k * 2e-4, 2e-4);
            assert_true(m->record.pulse_peak >= m->state[SLOT_FORCE] * (1 - 1e-12));
            assert_true(m->record.pulse_peak_time <= m->state[SLOT_TIME] + 1e-15);
            assert_true(m->record.pulse_peak_time >= touched);
            if (m->record.pulse_peak == m->state[SLOT_FORCE] &&
                m->state[SLOT_FORCE] > last) {
                check_close(m->record.pulse_peak_time, m->state[SLOT_TIME], 1e-15);
                rising++;
            }
            last = m->state[SLOT_FORCE];
        }
        assert_true(rising > 5);
    }
}
