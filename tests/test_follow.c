// Laws that follow a set-point and a wall that move, over frequency.
#include "src/study/follow.h"
#include "tests/shipped_scenario.h"

// Of two links: a law that waits for the error falls behind by delay and zero, which
// these beat.
TEST(laws_follow_slow_waves)
{
    follow_study study;
    KEPT_SCENARIO(s) = shipped("compare/observer");
    DONE(follow_study_compute(&s, NULL, &study, &f));
    assert_int_equal(study.done, FOLLOW_RUNS);

    // half a period of 5 ms; s^2 = 2 k2/(m l^2/6) of each link
    check_close(study.later, 2.5e-3, 1e-15);
    const double zero = sqrt(12 * 4.92 / (0.20054 * 0.25)),
                 w = 2 * M_PI * follow_frequencies[2];
    const double waits = 2 * sin(atan(w / zero) + w * study.later / 2);

    // slow waves are followed; a slow wall does not turn the hub, which friction holds:
    // the tip's stiffness k2/l^2 is all there is to feel
    for (int k = 0; k < FOLLOW_LAWS; k++) {
        check_close(study.points[k][2].gain, 1, 0.15);
        check_close(study.points[k][2].phase, 0, 6);
        check_below(study.points[k][2].error, 0.5 * waits);
        check_below(study.points[k][1].error, 0.06);

        // the integral of touch moves the hub a little
        const double most = strcmp(follow_laws[k], "touch") == 0 ? 0.1 : 0.08;
        if (strcmp(follow_laws[k], "admittance") != 0) {
            check_relative(study.points[k][0].shaken, 4.92 / 0.25, most);
        }
        for (int i = 1; i < FOLLOW_FREQUENCIES; i++) {
            check_below(fabs(study.points[k][i].phase - study.points[k][i - 1].phase),
                        180);
        }
    }
}

// There is nothing to follow without a law, a wall or a force.
TEST(a_scenario_with_nothing_to_follow_is_refused)
{
    static const char *const without[][3] = {
        {"corrected/first-impact", "motor.voltage=2", "no control law"},
        {"compare/observer", "wall.kind=none", "no wall"},
        {"compare/hybrid", "control.force=0", "no commanded force"}};
    for (size_t i = 0; i < 3; i++) {
        follow_study study;
        KEPT_SCENARIO(s) = shipped(without[i][0]);
        DONE(scenario_override(&s, without[i][1], &f));
        REFUSED(STATUS_BAD_SCENARIO, without[i][2],
                follow_study_compute(&s, NULL, &study, &f));
        assert_int_equal(study.done, 0);
    }
}
