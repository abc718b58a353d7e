// One link on a wall under a motor with friction: what holds the link, what its force is,
// and what can only be said of it within bounds.

#include "src/contact/zeno_monitor.h"
#include "tests/arm_fixture.h"
#include "tests/scenario_fixture.h"

// The last row at or before an instant [s].
static const sample *row_at(const run_result *r, double time)
{
    return &r->trace.rows[trace_row_at(&r->trace, time)];
}

// A link that friction holds within a wall stays there while the current changes, until
// the motor no longer outweighs what the wall gives and friction holds: T e^(-t R/L) = f
// l - kst.
TEST(a_link_stuck_within_a_wall_slips_when_its_current_lets_it)
{
    static const struct {
        const char *wall;
        double inductance; // [H]
        const char *limit;
    } cases[] = {{"kind: point, contact: kelvin-voigt", 2, ""},
                 {"kind: plane, contact: kelvin-voigt", 2, ""},
                 {"kind: point, contact: kelvin-voigt", 5, ", current_limit: 0.5"},
                 {"kind: plane, contact: kelvin-voigt, mass: 0.1", 5,
                  ", current_limit: 0.5"},
                 {"kind: point, contact: kelvin-voigt, mass: 0.1", 2, ""},
                 {"kind: point, contact: hunt-crossley, damping: 1e8", 2, ""},
                 {"kind: plane, contact: hunt-crossley, damping: 1e7", 5,
                  ", current_limit: 0.5"}};
    const double stiction = 0.045, resistance = 33.6;
    for (EACH(c, cases)) {
        const double inductance = c->inductance;
        KEPT_RUN(r) = run_told(formatted("arm: {links: 1}\nmotor: {voltage: 3, "
                                         "inductance: %g%s}\nwall: {angle: 0.1, %s}\n"
                                         "script:\n  - at: 2.4 s\n    set: "
                                         "{motor.voltage: 0}\nrun: {duration: 2.42}\n",
                                         inductance, c->limit, c->wall));
        const event *change = find_event(&r, EVENT_CHANGE, 0);
        assert_int_equal(change[-1].kind, EVENT_STICK);
        assert_int_equal(change[1].kind, EVENT_SLIP);

        // held until the change, and on, by the wall's force of that depth
        const sample *last = row_at(&r, 2.4);
        const double left = last->force - stiction;
        assert_true(last->contact != 0 && last->sticking != 0);
        const double slips =
            2.4 + inductance / resistance * log(last->motor_torque / left);
        check_close(change[1].time, slips, 1e-9);
        check_close(row_at(&r, slips - 1e-3)->force, last->force, 1e-12);
    }
}

// Where the hub sticks and slips without end, the hub is named, whatever it is in contact
// with.
TEST(what_stands_still_names_the_event_that_repeats)
{
    KEPT_SCENARIO(s) = good("arm: {links: 1}\nwall: {contact: kelvin-voigt}\n"
                            "initial: {angle: 0.1}\n");
    STARTED(a, m, &s.parameters, NULL, 0.1, 0);
    assert_true(m->state[SLOT_CONTACT] != 0);
    static const struct {
        motion_event last;
        const char *cause;
    } cases[] = {{MOTION_STICK, "motor.stiction"},
                 {MOTION_SLIP, "motor.stiction"},
                 {MOTION_RELEASE, "wall.stiffness"},
                 {MOTION_REACHED, "wall.stiffness"}};
    for (EACH(c, cases)) {
        char text[ZENO_CAUSE_SIZE];
        zeno_monitor_cause(&a, m, c->last, text, sizeof text);
        assert_non_null(strstr(text, c->cause));
    }
}

// A script that changes the command.
#define COMMANDED "script:\n  - at: %g s\n    set: {motor.voltage: %g}\n"

static const double kst = 0.045; // [N m]

// Torque of the motor at rest under a command [N m].
static double torque_of(double volts)
{
    KEPT_SCENARIO(s) = good("arm: {links: 1}\n");
    return motor_torque_per_volt(&s.parameters.motor) * volts;
}

static void check_bounds(double low, double high, double least, double most)
{
    check_close(low, fmax(least, 0), 1e-12);
    check_close(high, most, 1e-12);
}

static void check_determined(const summary *s)
{
    assert_true(isnan(s->first_pulse_peak_low_N) && isnan(s->first_pulse_peak_high_N));
    assert_true(isnan(s->peak_force_low_N) && isnan(s->peak_force_high_N));
    assert_true(isnan(s->steady_force_low_N) && isnan(s->steady_force_high_N));
}

// On a rigid wall friction may take from the force what it can hold, and add as much.
TEST(wall_and_friction_leave_open_what_the_force_is)
{
    static const char *const ways[] = {
        "wall: {kind: point}\n",
        "wall: {kind: plane}\n",
        "method: {name: newmark}\n",
        "method: {name: generalized-alpha}\n",
        "motor: {inductance: 0.01}\n",
        "motor: {current_limit: 10}\n",
        "arm: {links: 1, length: 0.5 m}\n",
        "wall: {restitution: 0.5}\n",
        "wall: {angle: 0.1, kind: plane}\ninitial: {angle: 0.1}\n",
    };
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        for (EACH_OF(double, c, 1, 0.2, 9)) {
            KEPT_RUN(r) = run_told(
                formatted("%s%srun: {duration: 4}\n" COMMANDED,
                          strncmp(ways[i], "arm", 3) == 0 ? "" : "arm: {links: 1}\n",
                          ways[i], 0.0, *c));
            const summary *s = &r.summary;
            const double length = i == 6 ? 0.5 : 1;
            const double least = (torque_of(*c) - kst) / length;
            const double most = (torque_of(*c) + kst) / length;
            check_bounds(s->steady_force_low_N, s->steady_force_high_N, least, most);
            check_bounds(s->peak_force_low_N, s->peak_force_high_N, least, most);
            if (i == 7) {
                assert_true(isnan(s->first_pulse_peak_low_N)); // a bounce
            } else {
                check_bounds(s->first_pulse_peak_low_N, s->first_pulse_peak_high_N, least,
                             most);
            }
            check_close(s->steady_force_N, (least + most) / 2, 1e-12);
            assert_non_null(strstr(s->message, "within bounds only"));

            // it comes to rest there, and is told so
            const size_t last = r.trace.event_count - 1;
            assert_int_equal(r.trace.events[last].kind,
                             i == 8 ? EVENT_CHANGE : EVENT_STICK);
        }
    }
}

// In a tilted plane the weight presses, too, or pulls.
TEST(the_weight_of_a_link_shifts_what_is_open)
{
    for (EACH_OF(double, tilt, -0.4, 0.2, 0.5)) {
        KEPT_RUN(r) = run_told(
            formatted("arm: {links: 1, mass: 0.4, tilt: %g}\nmotor: {voltage: 4}\n"
                      "wall: {angle: 0.2}\nrun: {duration: 4}\n",
                      *tilt));
        const summary *s = &r.summary;
        const double balanced = torque_of(4) - 0.4 * 9.80665 * sin(*tilt) / 2 * cos(0.2);
        check_bounds(s->steady_force_low_N, s->steady_force_high_N, balanced - kst,
                     balanced + kst);
        check_close(s->steady_force_N, balanced, 1e-12);
    }
}

// A force that stays the same is largest at once, whatever rounding says later.
TEST(a_force_that_stays_is_largest_at_once)
{
    static const char *const ways[] = {
        "current_limit: 0.2}", "current_limit: 100}\nwall: {kind: plane}",
        "current_limit: 0.2}\nwall: {angle: 0.3, restitution: 0}"};
    for (EACH(way, ways)) {
        KEPT_RUN(r) = run_told(formatted("arm: {links: 1, tilt: 0.1, air_drag: 0.6}\n"
                                         "motor: {voltage: 4, %s\n",
                                         *way));
        assert_true(r.summary.steady_force_N > 0.05);
        assert_true(r.summary.time_to_peak_s == 0 &&
                    r.summary.first_pulse_time_to_peak_s == 0);
    }
}

// Where the motor pulls, less than friction holds, the wall may press as hard as that.
TEST(a_link_that_rests_may_be_pressed_or_not)
{
    for (EACH_OF(double, c, 0.05, 0, -0.05)) {
        KEPT_RUN(at_start) = run_told(
            formatted("arm: {links: 1}\nmotor: {voltage: %g}\ninitial: {angle: 0.1}\n",
                      *c));
        const double least = torque_of(*c) - kst, most = torque_of(*c) + kst;
        const summary *s = &at_start.summary;
        check_bounds(s->steady_force_low_N, s->steady_force_high_N, least, most);
        check_bounds(s->peak_force_low_N, s->peak_force_high_N, least, most);

        // the same after an impact and less and less of a command
        KEPT_RUN(later) = run_told(formatted("arm: {links: 1}\n" COMMANDED, 0.5, *c));
        s = &later.summary;
        check_bounds(s->steady_force_low_N, s->steady_force_high_N, least, most);
        check_bounds(s->peak_force_low_N, s->peak_force_high_N, torque_of(1) - kst,
                     torque_of(1) + kst);
    }
}

// The mean of bounds that change in the window: at once, with a current, where one
// reaches zero.
TEST(steady_bounds_are_means)
{
    KEPT_RUN(r) = run_told("arm: {links: 1}\nscript:\n  - at: 0.95 s\n"
                           "    set: {motor.voltage: 0.05}\n");
    const double before = torque_of(1), after = torque_of(0.05);
    check_bounds(r.summary.steady_force_low_N, r.summary.steady_force_high_N,
                 (before - kst) / 2, (before + after) / 2 + kst);
    run_finish(&r);

    r = run_told("arm: {links: 1}\nmotor: {inductance: 0.5}\nscript:\n  - at: 0.9 s\n"
                 "    set: {motor.voltage: 0}\n");
    const double rate = 33.6 / 0.5, zero = log(before / kst) / rate;
    const double low = before * (1 - exp(-rate * zero)) / rate - kst * zero;
    const double high = before * (1 - exp(-rate * 0.1)) / rate + kst * 0.1;
    check_relative(r.summary.steady_force_low_N, low / 0.1, 1e-4);
    check_relative(r.summary.steady_force_high_N, high / 0.1, 1e-6);
    run_finish(&r);

    // the same without rows
    KEPT_SCENARIO(s) = good("arm: {links: 1}\n");
    r = run_done(&s, false);
    check_bounds(r.summary.steady_force_low_N, r.summary.steady_force_high_N,
                 before - kst, before + kst);
}

// Once it has left, the first pulse's bounds stay, and no force is open any more.
TEST(a_link_that_was_pushed_off_has_no_open_force)
{
    KEPT_RUN(r) = run_told("arm: {links: 1}\nscript:\n  - at: 0.5 s\n"
                           "    set: {motor.voltage: -3}\n");
    check_bounds(r.summary.first_pulse_peak_low_N, r.summary.first_pulse_peak_high_N,
                 torque_of(1) - kst, torque_of(1) + kst);
    check_bounds(r.summary.peak_force_low_N, r.summary.peak_force_high_N,
                 torque_of(1) - kst, torque_of(1) + kst);
    assert_true(isnan(r.summary.steady_force_low_N) &&
                isnan(r.summary.steady_force_high_N));
}

// Springs, depths and no friction determine the force; within a wall that gives the way
// there says which one it is.
TEST(what_else_holds_still_has_one_force)
{
    static const char *const texts[] = {
        "arm: {links: 2}\n",
        "arm: {links: 1, hub_joint: spring}\n",
        "arm: {links: 1, hub_joint: beam}\n",
        "arm: {links: 1}\nmotor: {stiction: 0}\n",
        "arm: {links: 1}\nwall: {kind: none}\n",
        "arm: {links: 1}\nwall: {contact: kelvin-voigt}\n",
        "arm: {links: 1}\nwall: {contact: kelvin-voigt, damping: 100}\n",
        "arm: {links: 1}\nwall: {contact: kelvin-voigt, mass: 0.1}\n",
        "arm: {links: 1}\nwall: {contact: hunt-crossley, damping: 1e8}\n",
    };
    for (int i = 0; i < 9; i++) {
        KEPT_RUN(r) = run_told(formatted("%srun: {duration: 4}\n", texts[i]));
        check_determined(&r.summary);
        const bool tells = strstr(r.summary.message, "where it came to rest") != NULL;
        const sample *last = LAST_ROW(&r.trace);
        assert_int_equal(tells, i >= 5 && last->sticking != 0);
        if (tells) { // with the bounds of the rest, in which it is
            assert_true(last->force >= torque_of(1) - kst &&
                        last->force <= torque_of(1) + kst);
            assert_non_null(strstr(r.summary.message, "0.392661 to 0.482661 N"));
        }
    }
}

// A link that the wall stops rests, to the last bit: friction holds it.
TEST(a_link_that_is_stopped_sticks_whatever_rounding_says)
{
    random_generator g = seeded(5);
    for (int i = 0; i < 100; i++) {
        KEPT_RUN(r) = run_told(formatted(
            "arm: {links: 1, mass: %.17g, length: %.17g}\nmotor: {voltage: %.17g}\n"
            "wall: {kind: %s, angle: %.17g}\nrun: {duration: 6}\n",
            evenly(&g, 0.1, 1), evenly(&g, 0.3, 2), evenly(&g, 0.5, 9),
            i % 2 ? "plane" : "point", evenly(&g, 0.05, 2.5)));
        const trace *t = &r.trace;
        assert_int_equal(t->event_count, 3);
        assert_int_equal(t->events[2].kind, EVENT_STICK);
        assert_true(LAST_ROW(t)->sticking != 0);
    }
}

// Steps too long for the hub's decay stop the link at the wall, too, and it presses.
TEST(a_link_stops_in_long_steps)
{
    for (EACH_TEXT(c, "newmark", "generalized-alpha")) {
        KEPT_RUN(r) = run_told(formatted(
            "arm: {links: 1}\nmotor: {viscous_friction: 150, voltage: 9}\n"
            "wall: {angle: 0.02}\nmethod: {name: %s, step: 0.01}\nrun: {duration: 2}\n",
            *c));
        check_relative(r.summary.steady_force_N, torque_of(9), 1e-12);
        check_close(row_at(&r, 2)->hub_velocity, 0, 0);
    }
}

// A link under a torque and nothing else, in front of a flat wall.
#define BOUNCING                                                                         \
    "arm: {links: 1, tilt: %g}\n"                                                        \
    "motor: {voltage: %g, stiction: 0, viscous_friction: 0, back_emf: 0}\n"              \
    "wall: {kind: plane, angle: %g, restitution: %.17g}\n"                               \
    "initial: {angle: %g}\nrun: {duration: %g}\n"

// Under a constant torque each flight lasts e times the one before it: Zeno's series, up
// to the first impact slower than the rest speed. There is no period that its flights are
// short against.
TEST(a_link_bounces_through_zenos_series)
{
    for (EACH_OF(double, e, 0.3, 0.9, 0.95, 0.98)) {
        const double start = 0.1, duration = 30;
        KEPT_SCENARIO(s) = good(formatted(BOUNCING, 0.0, 1.0, 0.0, *e, -start, duration));
        KEPT_RUN(r) = run_done(&s, true);
        const arm_parameters *p = &s.parameters.arm;
        const double inertia = p->hub_inertia + p->mass * p->length * p->length / 3;
        const double rate = torque_of(1) / inertia;
        double speed = sqrt(2 * rate * start), time = speed / rate;
        int impacts = 0;
        for (bool rests = false; !rests; impacts++) {
            const event *impact = find_event(&r, EVENT_IMPACT, impacts);
            check_close(impact->time, time, 1e-8);
            check_close(impact->speed, speed * p->length, 1e-8);
            rests = speed * p->length < s.parameters.method.rest_speed;
            speed *= *e;
            time += 2 * speed / rate;
        }
        check_close(r.summary.impacts, impacts, 0);
        check_close(r.summary.steady_force_N, torque_of(1) / p->length, 1e-12);
    }
}

// A lossless wall throws a link back as fast as it came, for as long as the run lasts.
TEST(a_lossless_link_bounces_on)
{
    static const struct {
        double tilt, voltage, angle, start;
    } cases[] = {{-0.3, 0, 0.2, 0}, {0, 1, 0, -0.01}, {0.5, 6, 0.3, 0.299}};
    for (EACH(c, cases)) {
        KEPT_RUN(r) = run_told(
            formatted(BOUNCING, c->tilt, c->voltage, c->angle, 1.0, c->start, 60.0));
        const event *first = find_event(&r, EVENT_IMPACT, 0), *last = first;
        const double flight =
            2 * first->time; // it begins at rest, where each flight turns
        for (int i = 0; i < r.summary.impacts; i++) {
            last = find_event(&r, EVENT_IMPACT, i);
            check_close(last->time, first->time + i * flight, 1e-7);
            check_relative(last->speed, first->speed, 1e-9);
        }
        assert_true(r.summary.impacts > 90 && 60 - last->time < flight);
    }
}

// Where vibrations take up the bounces' energy they end, by the chatter rule, in an
// impact that has next to none of it: a lossless wall takes no more.
TEST(chatter_takes_next_to_nothing)
{
    for (EACH_OF(double, volts, 2, 6)) {
        KEPT_SCENARIO(s) = shipped_with(
            "corrected/first-impact",
            formatted("motor.voltage=%g arm.damping_ratio=0.2 wall.restitution=1 "
                      "wall.kind=plane run.duration=1.5",
                      *volts));
        KEPT_RUN(r) = run_done(&s, true);
        const event *chatter = find_event(&r, EVENT_CHATTER, 0);
        const sample *then = row_at(&r, chatter->time), *last = row_at(&r, 1.5);
        assert_true(last->impact_loss > 0);
        check_below(last->impact_loss, 1.01 * MOTION_CHATTER_SHARE *
                                           (then->strain_energy + then->kinetic_energy));
    }
}
