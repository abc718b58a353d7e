// The law touch: no faster to the wall than the force allows, without vibration, then a
// passive hub whose rest moves.

#include "src/rig/laws/laws.h"
#include "src/study/robust/law_exam.h"
#include "tests/rig_fixture.h"

#define TOUCH "control.law=touch"

static double initial_of(const char *name)
{
    for (int i = 0; i < touch_law.parameter_count; i++) {
        if (strcmp(touch_law.parameters[i].name, name) == 0) {
            return touch_law.parameters[i].initial;
        }
    }
    fail_msg("the law has no parameter '%s'", name);
    return 0;
}

// A board has a kilobyte for it, and each setting has a place in its range.
TEST(it_fits_a_small_board)
{
    assert_true(touch_law.memory_size <= 1024);
    for (int i = 0; i < touch_law.parameter_count; i++) {
        const controller_parameter *p = &touch_law.parameters[i];
        if (p->description != NULL) {
            fail_if(p->initial < p->minimum || p->initial > p->maximum, "%s", p->name);
        }
    }
}

// The thesis's rig, 1 N: settled within 0.3 s of first contact, which comes no later than
// 1.5 times open-loop's.
TEST(one_newton_is_there_in_time)
{
    const summary open = rig_summary_with("control.law=open-loop");
    const summary s = rig_summary_with(TOUCH " control.force=1");
    check_below(s.settling_time_s, 0.3);
    check_below(s.first_contact_s, 1.5 * open.first_contact_s);
    check_below(s.smoothed_over_command_N, 0.1);
    check_close(s.steady_error_N, 0, 0.05);
}

// The tip meets the believed wall with v0 + v1 f.
TEST(the_tip_touches_as_fast_as_the_force_allows)
{
    const double v0 = initial_of("touch_speed"),
                 v1 = initial_of("touch_speed_per_newton");
    for (int force = 1; force <= 3; force++) {
        RIG_RUN(r, TOUCH " control.force=%d motor.stiction=0", force);
        const event *e = find_event(&r, EVENT_IMPACT, 0);
        check_relative(e->speed, v0 + v1 * force, 0.1);
    }
}

// The largest bend of the beam over the last stretch before first contact [rad].
static double bend_before_contact(const char *const *settings)
{
    KEPT_RUN(r) = rig_run(settings, true);
    const double touch = r.summary.first_contact_s;
    double largest = 0;
    for (EACH_ROW(row, &r.trace)) {
        if (row->time > touch - 0.05 && row->time < touch) {
            largest = fmax(largest, fabs(row->last_angle - row->first_angle));
        }
    }
    return largest;
}

// Ramps of one period of the free mode leave no vibration; a law that is told another
// stiffness has another period, and the beam swings as it comes to the wall.
TEST(ramps_of_a_period_leave_no_vibration)
{
    const double told = bend_before_contact(given(TOUCH " motor.stiction=0"));
    const double wrong =
        bend_before_contact(given(TOUCH " motor.stiction=0 belief.k2_factor=0.25"));
    check_below(3 * told, wrong);
}

// Wherever the wall is, it is found, and pressed on.
TEST(a_wall_elsewhere_is_found)
{
    for (EACH_TEXT(c, "belief.wall_error=-0.04", "belief.wall_error=0.04")) {
        const summary s = rig_summary_with(TOUCH " run.duration=2.5 %s", *c);
        assert_false(isnan(s.settling_time_s));
        check_close(s.steady_error_N, 0, 0.05);
    }
}

// A wall that draws back is lost, and found again where it then is.
TEST(a_wall_that_draws_back_is_found_again)
{
    const summary s =
        rig_summary_with(TOUCH " run.duration=3 wall.motion=step "
                               "wall.motion_amplitude=-0.03 "
                               "wall.motion_frequency=20 wall.motion_time=1");
    assert_true(s.separations >= 1);
    check_close(s.steady_error_N, 0, 0.05);
}

// The command of a force may change in mid-run, both ways.
TEST(it_follows_another_force)
{
    const scenario s =
        SCRIPTED(rig_parameters_with(TOUCH " run.duration=2"),
                 SETS(0.8, control.force, 2), SETS(1.4, control.force, 0.5));
    KEPT_RUN(r) = run_done(&s, false);
    check_close(r.summary.steady_force_N, 0.5, 0.05);
}

// Three of four cases that nobody chose are within the bounds of the exam; of 60, less
// than 35 would be three deviations below that.
TEST(most_cases_are_within_the_bounds)
{
    const scenario s = {.name = "touch", .parameters = rig_parameters_with(TOUCH)};
    const exam_request asked = {.base = &s,
                                .laws = {LAW_TOUCH},
                                .law_count = 1,
                                .forces = {1},
                                .force_count = 1,
                                .cases = 60,
                                .seed = 30000};
    law_exam e;
    DONE(law_exam_run(&e, &asked, &(exam_options){.jobs = 1}, &f));
    assert_true(law_exam_share(&e, 0, 0, -1).within >= 35);
    law_exam_finish(&e);
}

TEST(a_motor_without_torque_is_said)
{
    check_refused(given(TOUCH " motor.amplifier_gain=0"), "it needs a motor");
}
