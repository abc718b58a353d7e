// The machine of free flight, impact, contact, release, stick and slip, on motions with
// closed forms and by what must hold at every row.

#include "tests/arm_fixture.h"
#include "tests/told_events.h"

// A run of these settings under a script.
static run_result run_acted(action *todo, int count, const char *const *settings)
{
    const scenario s = {.parameters = fixture_parameters(settings),
                        .actions = todo,
                        .action_count = count};
    return run_done(&s, true);
}

// One link on a rigid hub: I w' = T - D w, first order.
typedef struct rod {
    double inertia, torque, damping, rate; // rate = damping / inertia
} rod;

static rod one_rod(void)
{
    rod r;
    double kt = 0.249092 * 9.80665;
    r.inertia = 0.40108 / 3 + 5.2e-3;
    r.torque = 6.02 * kt / 33.6 - 0.045;
    r.damping = 5.4192e-3 + kt * 2.443 / 33.6;
    r.rate = r.damping / r.inertia;
    return r;
}

static double rod_angle(const rod *r, double t)
{
    return r->torque / r->damping * (t + (exp(-r->rate * t) - 1) / r->rate);
}

TEST(a_single_rod_follows_its_closed_form)
{
    rod r = one_rod();
    RUN(result, "arm.links=1", "run.duration=0.6");
    double t = 0.2823; // contact: rod_angle(t) = 0.1, by Newton's method
    for (int i = 0; i < 20; i++) {
        t -= (rod_angle(&r, t) - 0.1) / (r.torque / r.damping * (1 - exp(-r.rate * t)));
    }
    double w = r.torque / r.damping * (1 - exp(-r.rate * t));
    check_close(result.summary.first_contact_s, t, 1e-12);
    check_relative(result.summary.contact_impulse_Ns, r.inertia * w / 1.0, 1e-11);
    check_close(result.summary.impacts, 1, 0);
    check_relative(result.summary.steady_force_N, r.torque + 0.045, 1e-12);
    check_close(result.trace.rows[200].last_angle, rod_angle(&r, 0.2), 1e-13);
    check_close(find_event(&result, EVENT_IMPACT, 0)->loss, 0.5 * r.inertia * w * w,
                1e-12);
}

// Without any damping its velocity is a straight line, however long the stride: what the
// gap makes of it, the sine of a parabola, has its say in how long that is.
TEST(a_rod_that_gathers_speed_meets_the_wall_where_it_is)
{
    for (EACH_TEXT(c, "wall.kind=point", "wall.kind=plane")) {
        RUN(r, "arm.links=1", "motor.back_emf=0", "motor.viscous_friction=0",
            "motor.stiction=0", "motor.voltage=8", "wall.angle=2.5",
            "wall.restitution=0.95", *c, "run.duration=3");
        const double torque = 8 * 6.02 * 0.249092 * 9.80665 / 33.6;
        const double t = sqrt(2 * 2.5 * (0.40108 / 3 + 5.2e-3) / torque);
        check_close(r.summary.first_contact_s, t, 1e-12);
        check_below(r.summary.max_penetration_m, 1e-13);
        assert_true(r.summary.impacts >= 2);
    }
}

TEST(a_coasting_rod_sticks_when_friction_says)
{
    rod r = one_rod();
    RUN(result, "arm.links=1", "wall.kind=none", "motor.voltage=0",
        "initial.velocity=0.5", "run.duration=1.2");
    // I w' = -D w - c: w = 0 at t = ln(1 + D w0 / c) I / D
    double t = log(1 + r.damping * 0.5 / 0.045) / r.rate;
    check_close(find_event(&result, EVENT_STICK, 0)->time, t, 1e-11);
    const sample *last = LAST_ROW(&result.trace);
    check_close(last->sticking, 1, 0);
    check_close(last->hub_velocity, 0, 0);
}

TEST(a_bouncing_rod_rebounds_by_e_and_comes_to_rest)
{
    rod r = one_rod();
    RUN(result, "arm.links=1", "wall.restitution=0.5", "run.duration=1.5");
    const event *first = find_event(&result, EVENT_IMPACT, 0);
    check_relative(first->impulse, 1.5 * r.inertia * first->speed, 1e-12);
    check_relative(first->loss, 0.5 * r.inertia * first->speed * first->speed * 0.75,
                   1e-12);
    // the speeds fall at least by e from bounce to bounce: back EMF takes its share too
    int impacts = (int)result.summary.impacts;
    assert_in_range(impacts, 8, 20);
    for (int i = 1; i < impacts; i++) {
        assert_true(find_event(&result, EVENT_IMPACT, i)->speed <
                    0.5 * find_event(&result, EVENT_IMPACT, i - 1)->speed);
    }
    // the rest rule: the last impact is slower than the rest speed, and the wall then
    // holds the rod
    check_below(find_event(&result, EVENT_IMPACT, impacts - 1)->speed, 1e-4);
    assert_true(find_event(&result, EVENT_IMPACT, impacts - 2)->speed >= 1e-4);
    check_relative(result.summary.steady_force_N, r.torque + 0.045, 1e-12);
}

// Parameters refuse an arm that starts behind the wall; put there regardless, it cannot
// be relied on, whatever moves it.
TEST(an_arm_inside_a_rigid_wall_is_never_ok)
{
    static const char *const methods[] = {"method.name=event", "method.name=newmark",
                                          "method.name=generalized-alpha"};
    static const char *const kinds[] = {"wall.kind=point", "wall.kind=plane"};
    for (int i = 0; i < 12; i++) {
        scenario s = {.parameters = fixture_parameters(
                          SETTINGS(methods[i % 3], kinds[i / 3 % 2], "wall.angle=2.9",
                                   i < 6 ? "arm.links=1" : "arm.links=2"))};
        KEPT_RUN(r);
        s.parameters.initial.angle = -0.4;
        if (run_scenario(&s, true, &r) == STATUS_OK) {
            assert_true(r.summary.max_penetration_m > 0.1);
            assert_true(r.summary.inaccurate);
            assert_non_null(strstr(r.summary.message, "inside a rigid wall"));
        }
    }
}

// A torque that nobody tells the motion of takes a stuck hub beyond stiction: that is
// noted, and what is within stiction or slides is not.
TEST(a_hub_held_beyond_stiction_is_noted)
{
    for (EACH_TEXT(c, "method.engine=pair", "method.engine=stiff")) {
        const parameters p = fixture_parameters(SETTINGS("motor.stiction=1e3", *c));
        STARTED(a, m, &p, NULL, 0, 0);
        motion_report r;
        assert_int_equal(motion_step(&a, m, 1e-3, 1e-3, &r), STATUS_OK);
        assert_true(m->state[SLOT_FRICTION] == HUB_STICK && m->record.overheld == 0);
        a.motor.stiction = 0.5 * fabs(a.motor.torque);
        motion_end_internal_step(m);
        assert_int_equal(motion_step(&a, m, 2e-3, 1e-3, &r), STATUS_OK);
        check_close(m->record.overheld, 0.5 * fabs(a.motor.torque), 1e-6);
    }
}

// A point stops the line through the link on both sides of the hub: an arm may start, and
// press, on its far side, which the run says.
TEST(a_start_on_the_point_behind_the_hub_is_a_touch_from_behind)
{
    RUN(r, "arm.links=1", "wall.angle=3", "initial.angle=-0.14159265358979312",
        "motor.voltage=-1", "run.duration=0.2");
    check_close(r.summary.first_contact_s, 0, 0);
    check_relative(r.summary.steady_force_N, one_rod().torque + 0.045, 1e-12);
    assert_non_null(strstr(r.summary.message, "1 of the touches were behind it"));
}

// An arm that starts on its wall does not know at what angle that is, which rounding of
// the gap does: of every arm, motor and wall the run is the same, and comes to its end.
TEST(a_start_on_the_wall_is_the_same_at_any_angle)
{
    static const char *const walls[] = {"wall.contact=rigid", "wall.contact=kelvin-voigt",
                                        "wall.contact=hunt-crossley"};
    static const char *const arms[] = {"arm.links=1", "arm.links=2", "arm.links=4"};
    static const char *const motors[] = {"motor.inductance=0", "motor.inductance=0.0004",
                                         "motor.inductance=0.1", "motor.current_limit=2"};
    static const double angles[] = {0, 0.44995051704215783, -1.0452626829386438,
                                    -1.6363530097793064, -2.9183526112184675};
    for (int i = 0; i < 72; i++) {
        const char *kind = i % 2 == 0 ? "wall.kind=point" : "wall.kind=plane";
        double peak = 0;
        for (int k = 0; k < 5; k++) {
            RUN(r, kind, walls[i / 2 % 3], arms[i / 6 % 3], motors[i / 18],
                formatted("wall.angle=%.17g", angles[k]),
                formatted("initial.angle=%.17g", angles[k]), "motor.voltage=1.2",
                "run.duration=0.1");
            peak = k == 0 ? r.summary.peak_force_N : peak;
            check_relative(r.summary.peak_force_N, peak, 1e-5);
            assert_false(r.summary.inaccurate);
        }
    }
}

static void check_complementarity(const run_result *r)
{
    for (EACH_ROW(row, &r->trace)) {
        assert_true(row->gap >= -1e-11);
        assert_true(row->force >= -1e-8);
        assert_true(fabs(row->gap * row->force) < 1e-10);
        assert_true(row->contact == 0 ? row->force == 0
                                      : fabs(row->gap_velocity) < 1e-10);
        assert_true(fabs(row->friction_torque) <= 0.045 + 1e-10);
        assert_true(row->sticking == 0 || row->hub_velocity == 0);
    }
    assert_true(r->summary.max_penetration_m < 1e-11);
}

static void check_ledger(const run_result *r)
{
    check_below(r->summary.energy_residual_J, 1e-6 * fabs(r->summary.motor_work_J));
    for (EACH_EVENT(e, &r->trace)) {
        assert_true(e->loss >= 0);
    }
    for (size_t i = 1; i < r->trace.row_count; i++) {
        assert_true(r->trace.rows[i].time >= r->trace.rows[i - 1].time);
        assert_true(r->trace.rows[i].friction_loss >=
                    r->trace.rows[i - 1].friction_loss - 1e-15);
        assert_true(r->trace.rows[i].impact_loss >= r->trace.rows[i - 1].impact_loss);
    }
}

TEST(gap_and_force_stay_complementary_and_energy_is_accounted_for)
{
    const char *const links[] = {"arm.links=1", "arm.links=2", "arm.links=3",
                                 "arm.links=5"};
    for (int i = 0; i < 4 * 8; i++) {
        RUN(r, links[i % 4], i & 4 ? "wall.kind=plane" : "wall.kind=point",
            i & 8 ? "motor.voltage=5" : "motor.voltage=1",
            i & 16 ? "wall.restitution=0.4" : "wall.restitution=0");
        check_complementarity(&r);
        check_ledger(&r);
    }
    RUN(r, "arm.hub_joint=spring", "run.duration=0.6");
    check_complementarity(&r);
    check_ledger(&r);
}

// With the arm at rest on the wall and the hub held by friction, the middle spring alone
// presses.
TEST(the_steady_force_is_the_springs)
{
    RUN(r, "run.duration=2");
    const sample *last = LAST_ROW(&r.trace);
    double d = last->last_angle - last->first_angle;
    double lever = cos(0.1) * cos(last->last_angle) + sin(0.1) * sin(last->last_angle) -
                   0.5 * cos(d);
    check_close(last->sticking, 1, 0);
    check_relative(last->force, -4.92 * d / lever, 1e-9);
    check_relative(r.summary.steady_force_N, last->force, 1e-9);
}

TEST(the_located_peak_does_not_depend_on_the_step)
{
    RUN(coarse, "method.step=4e-3");
    RUN(fine, "method.step=1e-4");
    check_relative(coarse.summary.first_pulse_peak_N, fine.summary.first_pulse_peak_N,
                   1e-9);
    check_close(coarse.summary.first_pulse_time_to_peak_s,
                fine.summary.first_pulse_time_to_peak_s, 1e-5);
    check_close(coarse.summary.first_contact_s, fine.summary.first_contact_s, 1e-11);
    check_relative(coarse.summary.contact_impulse_Ns, fine.summary.contact_impulse_Ns,
                   1e-9);
}

TEST(without_a_trace_the_summary_is_the_same)
{
    KEPT_RUN(with) = run_arm(fixture_parameters(NULL), true);
    KEPT_RUN(without) = run_arm(fixture_parameters(NULL), false);
    assert_int_equal(without.trace.row_count, 0);
    assert_same_summary(&with.summary, &without.summary);
}

TEST(script_acts_at_its_time_and_is_booked)
{
    action todo[] = {
        PUSHES(0.70005, 0.02), SETS(1.0, motor.voltage, 2), SETS(1.2, arm.k2, 10),
        PUSHES(1.4, -0.2), // away from the wall
    };
    KEPT_RUN(r) = run_acted(todo, 4, SETTINGS("run.duration=2"));
    check_close(find_event(&r, EVENT_PUSH, 0)->time, 0.70005, 1e-12);
    check_close(find_event(&r, EVENT_CHANGE, 0)->time, 1.0, 1e-12);
    const sample *last = LAST_ROW(&r.trace);
    check_close(last->voltage, 2, 0);
    assert_true(last->external_work != 0);
    check_below(r.summary.energy_residual_J, 1e-9);
    // pressed into the wall the push is answered by the wall, at once
    check_close(find_event(&r, EVENT_IMPACT, 2)->time, 0.70005, 1e-12);
    // pulled off, the arm leaves and comes back
    bool apart = false;
    for (EACH_ROW(row, &r.trace)) {
        apart |= row->time > 1.4 && row->gap > 1e-3;
    }
    assert_true(apart);
    check_complementarity(&r);
}

static void check_events_tell_the_state(const run_result *r)
{
    const event *wrong = contradicting_event(r);
    fail_if(wrong != NULL, "%s at %.9g s", event_name(wrong->kind), wrong->time);
}

TEST(events_tell_what_is_in_contact_and_what_sticks)
{
    static const char *const arms[] = {"arm.links=1", "arm.links=2", "arm.links=3",
                                       "arm.hub_joint=spring"};
    static const char *const walls[][3] = {
        {"wall.contact=rigid", "wall.restitution=0", "wall.mass=0"},
        {"wall.contact=rigid", "wall.restitution=0.5", "wall.mass=0"},
        {"wall.contact=kelvin-voigt", "wall.damping=200", "wall.mass=0"},
        {"wall.contact=kelvin-voigt", "wall.damping=20", "wall.mass=0.05"},
        {"wall.contact=hunt-crossley", "wall.damping=1e6", "wall.mass=0"}};
    for (int i = 0; i < 4 * 5 * 2; i++) {
        action todo[] = {PUSHES(0.9, -0.05),           PUSHES(1.4, 0.05),
                         SETS(1.5, motor.voltage, -3), SETS(1.7, motor.voltage, 4),
                         SETS(2.3, motor.stiction, 2), PUSHES(2.4, -0.02),
                         SETS(2.6, motor.stiction, 0)};
        const char *const *wall = walls[i / 4 % 5];
        KEPT_RUN(r) = run_acted(todo, sizeof todo / sizeof *todo,
                                SETTINGS(arms[i % 4], wall[0], wall[1], wall[2],
                                         "run.duration=3", "arm.k1=300",
                                         i < 20 ? "wall.kind=point" : "wall.kind=plane"));
        check_events_tell_the_state(&r);
    }
}

// The hub stops, friction turns round, and the arm lifts off: that is a release, too.
TEST(a_hub_that_stops_may_release_the_arm)
{
    action todo = SETS(0.284, motor.voltage, 0.3);
    KEPT_RUN(r) = run_acted(&todo, 1, SETTINGS("motor.voltage=2", "motor.stiction=0.35"));
    int lifted = 0;
    for (size_t i = 0; i + 1 < r.trace.event_count; i++) {
        const event *e = &r.trace.events[i];
        lifted +=
            e->kind == EVENT_STICK && e[1].kind == EVENT_RELEASE && e[1].time == e->time;
    }
    assert_int_equal(lifted, 1);
    check_events_tell_the_state(&r);
}

// A contact that a push or the script ends is released then.
TEST(a_contact_ended_from_outside_is_released)
{
    const struct {
        const char *restitution;
        action todo;
    } cases[] = {
        {"wall.restitution=0", PUSHES(1, -0.02)},
        {"wall.restitution=0.5", PUSHES(1, 0.02)},
        {"wall.restitution=0", SETS(1, motor.voltage, -1)},
    };
    for (EACH(c, cases)) {
        action todo = c->todo;
        KEPT_RUN(r) =
            run_acted(&todo, 1,
                      SETTINGS("arm.links=1", c->restitution, "run.duration=1.2"));
        check_close(find_event(&r, EVENT_RELEASE, 0)->time, 1, 0);
        check_events_tell_the_state(&r);
    }
}

// An arm that starts at rest on the wall is in its first contact at once, held still or
// not, for any wall; one that swings off at once is not.
TEST(an_arm_that_starts_on_the_wall_is_in_contact)
{
    static const struct {
        const char *links, *wall;
        double released; // [s], 0: never
    } cases[] = {{"arm.links=1", "wall.contact=rigid", 0},
                 {"arm.links=3", "wall.contact=rigid", 7.2441e-3},
                 {"arm.links=3", "wall.contact=kelvin-voigt", 7.5573e-3}};
    for (EACH(c, cases)) {
        RUN(r, c->links, c->wall, "wall.angle=0");
        double largest = 0;
        for (EACH_ROW(row, &r.trace)) {
            largest = fmax(largest, row->force);
        }
        check_close(r.summary.first_contact_s, 0, 0);
        check_close(r.summary.contact_impulse_Ns, 0, 0);
        check_close(find_event(&r, EVENT_CONTACT, 0)->time, 0, 0);
        check_below(largest, r.summary.peak_force_N * (1 + 1e-12));
        assert_true(r.summary.steady_force_N > 0.35);
        assert_true(r.summary.first_pulse_peak_N > 0.05);
        if (c->released == 0) {
            assert_true(isnan(r.summary.first_pulse_s));
        } else {
            check_close(r.summary.first_pulse_s, c->released, 1e-6);
        }
    }
    for (EACH_TEXT(each, "wall.contact=rigid", "wall.contact=kelvin-voigt")) {
        RUN(r, "arm.links=2", *each, "wall.angle=0");
        assert_true(r.summary.first_contact_s > 0.05);
        run_finish(&r);

        // behind a spring the tip swings off as the fourth power of the time
        r = RUN_OF("arm.hub_joint=spring", "arm.k1=276", "arm.k2=64", "motor.voltage=2",
                   *each, "wall.angle=0");
        check_close(r.summary.first_contact_s, 0.0262512050, 1e-9);
        assert_true(r.summary.first_pulse_peak_N > 1);
    }
}

// One that starts on a wall that gives and moves into it is in contact from the start: as
// one that comes from 1 nm in front of it.
TEST(an_arm_that_moves_into_the_wall_is_in_contact)
{
    for (EACH_TEXT(c, "wall.contact=kelvin-voigt", "wall.contact=hunt-crossley")) {
        RUN(at, *c, "wall.angle=0", "initial.velocity=1");
        RUN(before, *c, "wall.angle=0", "initial.velocity=1", "initial.angle=-1e-9");
        check_close(at.summary.first_contact_s, 0, 0);
        check_relative(at.summary.first_pulse_peak_N, before.summary.first_pulse_peak_N,
                       1e-5);
        check_relative(at.summary.peak_force_N, before.summary.peak_force_N, 1e-5);
        check_close(find_event(&at, EVENT_CONTACT, 0)->time, 0, 0);
    }
}

// The gap of an arm that starts on the wall is zero, whatever rounding makes of it.
TEST(an_arm_on_the_wall_does_not_strike_it)
{
    static const char *const arms[] = {"arm.links=3",
                                       "arm.link_lengths=0.294,0.386,0.314"};
    static const char *const walls[] = {"wall.contact=rigid",
                                        "wall.contact=kelvin-voigt"};
    for (int i = 0; i < 400; i++) {
        scenario s = {.parameters = fixture_parameters(
                          SETTINGS("arm.links=3", arms[i & 1], walls[i >> 1 & 1],
                                   "run.duration=1e-3"))};
        s.parameters.wall.kind = i & 4 ? WALL_PLANE : WALL_POINT;
        s.parameters.wall.angle = s.parameters.initial.angle = 0.01 * (i / 2 - 100);
        KEPT_RUN(r) = run_done(&s, false);
        check_close(r.summary.first_contact_s, 0, 0);
        check_close(r.summary.impacts, 0, 0);
    }
}

// What rounding leaves of the gap's rate in contact neither strikes nor lifts off.
TEST(a_push_of_nothing_changes_nothing)
{
    for (EACH_TEXT(c, "arm.links=2", "arm.links=12", "arm.tip_mass=0.01")) {
        enum { PUSHES = 20 };
        action todo[PUSHES];
        for (int k = 0; k < PUSHES; k++) {
            todo[k] = (action){.time = 0.1 + 0.093 * k, .kind = ACTION_PUSH};
        }
        const char *const *settings =
            SETTINGS(*c, "arm.damping_ratio=0.05", "run.duration=2");
        KEPT_RUN(pushed) = run_acted(todo, PUSHES, settings);
        KEPT_RUN(free) = run_acted(NULL, 0, settings);
        check_close(pushed.summary.impacts, free.summary.impacts, 0);
        check_close(pushed.summary.separations, free.summary.separations, 0);
        check_relative(pushed.summary.steady_force_N, free.summary.steady_force_N, 1e-7);
    }
}

TEST(a_step_that_cannot_be_taken_stops_with_time_and_reason)
{
    scenario s = {.parameters = fixture_parameters(
                      SETTINGS("method.name=newmark", "method.step=0.5",
                               "motor.voltage=10", "arm.k2=1e5"))};
    s.parameters.motor.stiction = (double)NAN; // a bad number that slipped in
    KEPT_RUN(r);
    assert_int_equal(run_scenario(&s, true, &r), STATUS_NOT_FINITE);
    assert_non_null(strstr(r.summary.message, "t = "));
    assert_true(r.trace.row_count >= 1);
}

// Newmark with gamma below 1/2 feeds energy into the motion: the ledger notices and the
// run stops.
TEST(a_run_that_makes_energy_from_nothing_is_stopped)
{
    scenario s = {.parameters = fixture_parameters(
                      SETTINGS("method.name=newmark", "method.gamma=0.3", "arm.links=8",
                               "run.duration=3"))};
    KEPT_RUN(r);
    assert_int_equal(run_scenario(&s, true, &r), STATUS_UNSTABLE);
    assert_non_null(strstr(r.summary.message, "method.step"));
}

// Steps that lose a share of the energy do not go by as if nothing were wrong.
TEST(a_ledger_that_does_not_close_makes_a_run_inaccurate)
{
    static const struct {
        const char *step, *bound;
        bool inaccurate;
    } cases[] = {{"method.step=1e-3", "method.gamma=0.5", false},
                 {"method.step=1e-3", "method.residual_bound=1e-9", true},
                 {"method.step=2e-2", "method.gamma=0.6", true}};
    for (EACH(c, cases)) {
        RUN(r, "method.name=newmark", c->step, c->bound);
        assert_int_equal(r.summary.inaccurate, c->inaccurate);
        assert_int_equal(r.summary.message[0] != '\0', c->inaccurate);
        assert_string_equal(summary_status(&r.summary),
                            c->inaccurate ? "inaccurate" : "ok");
    }

    // the event method's own bound is narrow, and kept
    RUN(r, "run.duration=1");
    check_below(r.summary.energy_residual_J, 1e-6 * r.summary.motor_work_J);
    assert_string_equal(summary_status(&r.summary), "ok");
}

// A motion so small that the tolerances of events are a share of it does not go by
// either; a large one, an arm that friction holds and one that the wall holds do.
TEST(a_motion_too_small_to_follow_is_inaccurate)
{
    static const struct {
        const char *voltage, *stiction, *angle, *links;
        bool inaccurate;
    } cases[] = {{"1", "0.045", "0.1", "arm.links=2", false},
                 {"1e-5", "4.5e-7", "1e-6", "arm.links=2", false},
                 {"1e-8", "4.5e-10", "1e-9", "arm.links=2", true},
                 {"1e-4", "4.5e-6", "1e-4", "arm.links=48", false},
                 {"1e-5", "4.5e-7", "1e-6", "arm.links=16", false},
                 {"1e-8", "4.5e-10", "1e-9", "arm.links=4", true},
                 {"1e-8", "4.5e-10", "1e-9", "arm.tip_mass=0.01", true},
                 {"1e-11", "4.5e-13", "0.1", "arm.links=2", true},
                 {"1e-10", "0", "0.1", "arm.tip_mass=0.01", true},
                 {"1e-8", "0.045", "0.1", "arm.links=2", false},
                 {"0.1", "0", "0", "arm.links=1", false}};
    for (EACH(c, cases)) {
        KEPT_RUN(r) = run_arm(
            parameters_with(
                "motor.voltage=%s motor.stiction=%s wall.angle=%s %s wall.kind=plane",
                c->voltage, c->stiction, c->angle, c->links),
            true);
        fail_if(r.summary.inaccurate != c->inaccurate, "%s V, %s rad, %s: %s %s",
                c->voltage, c->angle, c->links, summary_status(&r.summary),
                r.summary.message);
    }
}

// A fast arm's strides follow its rotation: where they may end does not matter.
TEST(fast_rotation_is_resolved_whatever_the_step)
{
    double contact[2], peak[2];
    for (int i = 0; i < 2; i++) {
        RUN(r, "arm.links=3", "motor.viscous_friction=0", "motor.amplifier_gain=1000",
            i == 0 ? "method.step=1e-3" : "method.step=1e-4", "run.duration=0.12");
        contact[i] = r.summary.first_contact_s;
        peak[i] = r.summary.first_pulse_peak_N;
    }
    check_close(contact[0], contact[1], 1e-10);
    check_close(peak[0], peak[1], 1e-7 * peak[1]);
}

// Pressed on an elastic wall the arm does not bounce for ever: the chatter rule, and says
// so.
TEST(elastic_chattering_is_bounded_and_said)
{
    RUN(r, "arm.links=20", "arm.damping_ratio=0.001", "wall.kind=plane",
        "wall.restitution=1", "motor.voltage=10", "run.duration=0.25");
    check_ledger(&r);
    check_below(r.summary.impacts, 2000);
    size_t chatters = 0;
    for (EACH_EVENT(e, &r.trace)) {
        chatters += e->kind == EVENT_CHATTER;
    }
    assert_true(chatters > 0);
    assert_non_null(strstr(r.summary.message, "chatter"));
}

TEST(structural_damping_does_not_upset_the_event_method)
{
    RUN(r, "arm.links=20", "arm.damping_ratio=0.01", "run.duration=0.4");
    check_ledger(&r);
    assert_true(LAST_ROW(&r.trace)->damping_loss > 0);
}
