// How far a number of links is from a beam.
#include "src/study/links.h"

#include "tests/shipped_scenario.h"

static links_study studied(const char *name, char *const *changes, int count)
{
    SCOPED(scenario_finish) scenario s = shipped(name);
    links_study study;
    assert_int_equal(scenario_override_all(&s, changes, count, NULL, NULL), STATUS_OK);
    DONE(links_study_compute(&s, NULL, &study, &f));
    assert_int_equal(study.count, LINKS_LENGTHS);
    return study;
}

static const links_row *row_of(const links_study *study, const char *key)
{
    for (int k = 0; k < LINKS_QUANTITIES; k++) {
        if (strcmp(study->rows[k].key, key) == 0) {
            return &study->rows[k];
        }
    }
    fail_msg("there is no %s", key);
    return NULL;
}

// Frequencies and statics have the beam's as their limit, whether the first link is held by the hub
// (an error of order one) or by the beam's root (order two).
TEST(small_motion_tends_to_the_beam)
{
    static const char *const keys[] = {"frequency_tip_free_Hz", "frequency_tip_pinned_Hz",
                                       "tip_compliance_m_per_N"};
    char *hubs[] = {"arm.hub_joint=rigid", "arm.hub_joint=beam"};
    for (int order = 1; order <= 2; order++) {
        const links_study study = studied("corrected/damped-beam", &hubs[order - 1], 1);
        for (int k = 0; k < 3; k++) {
            const links_row *row = row_of(&study, keys[k]);
            check_close(row->order, order, 0.15);
            check_relative(row->limit, row->beam, order == 1 ? 2e-3 : 1e-5);
            check_below(fabs(row->limit - row->beam), row->error);
        }
    }
}

// The stopped half-infinite beam: 4 EI v (rho A / 4 EI)^(3/4) sqrt(t / pi), which many links meet
// within a hundredth. An undamped beam has it, a damped one and a wall that gives do not.
TEST(a_blow_tends_to_the_stopped_beam)
{
    const links_study study = studied("corrected/plane-wall-fast", NULL, 0);
    const links_row *momentum = row_of(&study, "momentum_2ms_Ns"),
                    *sensed = row_of(&study, "sensed_1ms_N");
    check_relative(momentum->value[LINKS_LENGTHS - 1], momentum->beam, 5e-3);
    check_relative(sensed->value[LINKS_LENGTHS - 1], sensed->beam, 5e-3);
    assert_true(momentum->enough >= 8 && momentum->enough <= 32);
    check_below(2 * momentum->beam, momentum->value[0]);

    char *damped[] = {"arm.damping_ratio=0.05"};
    char *giving[] = {"wall.contact=kelvin-voigt"};
    const links_study soft = studied("corrected/plane-wall-fast", giving, 1),
                      slow = studied("corrected/plane-wall-fast", damped, 1);
    assert_true(isnan(row_of(&soft, "momentum_2ms_Ns")->beam));
    assert_true(isnan(row_of(&slow, "sensed_1ms_N")->beam));
}

// Enough is the fewest from which on all are near, not the first that happens to be.
TEST(enough_is_enough_for_all_that_follow)
{
    links_row row = {.value = {100, 140, 103, 98, 101, 100}, .beam = 100, .limit = 5};
    assert_int_equal(links_enough(&row), 8);
    row.value[LINKS_LENGTHS - 1] = 110;
    assert_int_equal(links_enough(&row), 0);

    // without a beam the limit counts; without either there is no answer
    row = (links_row){.value = {1, 1, 1, 1, 1, 1}, .beam = (double)NAN, .limit = 1.01};
    assert_int_equal(links_enough(&row), 2);
    row.limit = (double)NAN;
    assert_int_equal(links_enough(&row), 0);
}

// A mass at the tip has no closed form here, but limits of its own.
TEST(uneven_arms_have_no_beam)
{
    char *changes[] = {"arm.tip_mass=0.05", "arm.hub_joint=beam"};
    const links_study study = studied("corrected/damped-beam", changes, 2);
    for (int k = 0; k < LINKS_QUANTITIES; k++) {
        assert_true(isnan(study.rows[k].beam));
    }
    const links_row *row = row_of(&study, "frequency_tip_free_Hz");
    check_close(row->order, 2, 0.15);
    assert_true(row->enough > 0);
}

TEST(what_has_no_contact_is_refused)
{
    SCOPED(scenario_finish)
    scenario s = shipped_with("corrected/damped-beam", "motor.voltage=0");
    links_study study;
    REFUSED(STATUS_BAD_SCENARIO, "no contact", links_study_compute(&s, NULL, &study, &f));
    assert_int_equal(study.count, 0);

    run_monitor monitor = {0};
    atomic_store(&monitor.stop, true);
    REFUSED(STATUS_STOPPED, "", links_study_compute(&s, &monitor, &study, &f));
}
