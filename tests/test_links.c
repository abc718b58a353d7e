// How far a number of links is from a beam.
#include "src/study/links.h"

#include "tests/given_parameters.h"
#include "tests/shipped_scenario.h"

static links_study studied(const char *name, const char *changes)
{
    KEPT_SCENARIO(s) = shipped_with(name, changes);
    links_study study;
    DONE(links_study_compute(&s, NULL, &study, &f));
    assert_int_equal(study.count, LINKS_LENGTHS);
    return study;
}

// That of a fast arm and a rigid wall.
static const links_study *of_fast_arm(void)
{
    static links_study study;
    if (study.count == 0) {
        study = studied("corrected/plane-wall-fast", "");
    }
    return &study;
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

// Frequencies and statics have the beam's as their limit, whether the first link is held
// by the hub (an error of order one) or by the beam's root (order two).
TEST(small_motion_tends_to_the_beam)
{
    static const char *const keys[] = {"frequency_tip_free_Hz", "frequency_tip_pinned_Hz",
                                       "tip_compliance_m_per_N"};
    static const char *const hubs[] = {"arm.hub_joint=rigid", "arm.hub_joint=beam"};
    for (int order = 1; order <= 2; order++) {
        const links_study study = studied("corrected/damped-beam", hubs[order - 1]);
        for (int k = 0; k < 3; k++) {
            const links_row *row = row_of(&study, keys[k]);
            check_close(row->order, order, 0.15);
            check_relative(row->limit, row->beam, order == 1 ? 2e-3 : 1e-5);
            check_below(fabs(row->limit - row->beam), row->error);
        }
    }
}

// The stopped half-infinite beam: 4 EI v (rho A / 4 EI)^(3/4) sqrt(t / pi), which many
// links meet within a hundredth. An undamped beam has it, a damped one and a wall that
// gives do not.
TEST(a_blow_tends_to_the_stopped_beam)
{
    const links_row *momentum = row_of(of_fast_arm(), "momentum_2ms_Ns"),
                    *sensed = row_of(of_fast_arm(), "sensed_1ms_N");
    check_relative(momentum->value[LINKS_LENGTHS - 1], momentum->beam, 5e-3);
    check_relative(sensed->value[LINKS_LENGTHS - 1], sensed->beam, 5e-3);
    assert_true(momentum->enough >= 8 && momentum->enough <= 32);
    check_below(2 * momentum->beam, momentum->value[0]);

    const links_study soft = studied("corrected/plane-wall-fast",
                                     "wall.contact=kelvin-voigt"),
                      slow =
                          studied("corrected/plane-wall-fast", "arm.damping_ratio=0.05");
    assert_true(isnan(row_of(&soft, "momentum_2ms_Ns")->beam));
    assert_true(isnan(row_of(&slow, "sensed_1ms_N")->beam));
}

// What a blow amounts to, by the rows and events of a run.
typedef struct blow_numbers {
    double first_impulse; // [N s]
    double momentum;      // of the first 2 ms [N s]
    double peak;          // of the first 20 ms [N]
    double sensed;        // the peak behind a lag of 1 ms [N]
} blow_numbers;

// Goes through the first 20 ms of contact: impulses at their instants, forces between
// them. Between two rows the lag follows the mean of their forces: its distance from that
// mean shrinks by exp(-h / T).
static blow_numbers blow_of(const run_result *r)
{
    const double touch = r->summary.first_contact_s, end = touch + 0.02, lag = 1e-3;
    blow_numbers blow = {0};
    double sensed_now = 0;
    size_t next = 0;
    for (size_t k = 0; k + 1 < r->trace.row_count; k++) {
        // the events up to this row; an impulse J makes the lag jump by J / T
        const sample *a = &r->trace.rows[k], *b = a + 1;
        for (; next < r->trace.event_count && r->trace.events[next].time <= a->time;
             next++) {
            const event *e = &r->trace.events[next];
            if (e->kind != EVENT_IMPACT || e->time > end) {
                continue;
            }
            if (e->time == touch) {
                blow.first_impulse = e->impulse;
            }
            if (e->time <= touch + 2e-3) {
                blow.momentum += e->impulse;
            }
            sensed_now += e->impulse / lag;
        }
        if (a->time < touch || b->time > end + 1e-9) {
            continue;
        }

        // the force from this row to the next
        const double h = b->time - a->time, mean = (a->force + b->force) / 2;
        blow.sensed = fmax(blow.sensed, sensed_now);
        if (b->time <= touch + 2e-3 + 1e-9) {
            blow.momentum += h * mean;
        }
        blow.peak = fmax(blow.peak, fmax(a->force, b->force));
        sensed_now = mean + (sensed_now - mean) * exp(-h / lag);
    }
    return blow;
}

// The study of arms with several numbers of links says of their blows what runs of the
// same arms do.
TEST(a_blow_is_what_rows_and_events_come_to)
{
    static const char *const bounces[] = {"wall.restitution=0", "wall.restitution=0.3"};
    for (int kind = 0; kind < 2; kind++) {
        const links_study study = studied("corrected/plane-wall-fast", bounces[kind]);
        for (int i = 0; i < 3; i++) {
            KEPT_SCENARIO(s) = shipped_with("corrected/plane-wall-fast",
                                            formatted("arm.links=%d method.step=1e-5 %s",
                                                      links_numbers[i], bounces[kind]));
            KEPT_RUN(r) = run_done(&s, true);
            const blow_numbers blow = blow_of(&r);
            check_relative(row_of(&study, "first_impulse_Ns")->value[i],
                           blow.first_impulse, 1e-9);
            check_relative(row_of(&study, "momentum_2ms_Ns")->value[i], blow.momentum,
                           1e-3);
            check_relative(row_of(&study, "peak_20ms_N")->value[i], blow.peak, 1e-3);
            check_relative(row_of(&study, "sensed_1ms_N")->value[i], blow.sensed, 1e-4);
        }
    }
}

// With two links a sensor reads the first impulse over its time constant.
TEST(two_links_read_as_one_impulse)
{
    const double impulse = row_of(of_fast_arm(), "first_impulse_Ns")->value[0];
    check_relative(row_of(of_fast_arm(), "sensed_500us_N")->value[0], impulse / 0.5e-3,
                   1e-12);
    check_relative(row_of(of_fast_arm(), "sensed_2ms_N")->value[0], impulse / 2e-3,
                   1e-12);
    check_close(impulse, 0.15583707, 1e-6); // docs/explanation/trust.md
}

// The force of the ideal contact has no limit, its first impulse neither.
TEST(a_rigid_contact_has_no_limit)
{
    const links_row *peak = row_of(of_fast_arm(), "peak_20ms_N"),
                    *impulse = row_of(of_fast_arm(), "first_impulse_Ns");
    for (int i = 1; i < LINKS_LENGTHS; i++) {
        check_below(1.5 * peak->value[i - 1], peak->value[i]);
        check_below(impulse->value[i], 0.6 * impulse->value[i - 1]);
    }
    assert_int_equal(peak->enough + impulse->enough, 0);
}

// The limit against the transform it comes from: y(t) of K / sqrt(t) by the substitution
// u = sqrt(t).
TEST(the_beams_limit_is_the_lag_of_an_inverse_root)
{
    const parameters p = defaults_of(ARM_CORRECTED);
    const double tau = 1e-3, k = links_beam_momentum(&p, 2, 1) / 2;
    double largest = 0;
    for (double t = 0.5 * tau; t < 1.5 * tau; t += 0.002 * tau) {
        enum { PIECES = 2000 };
        double sum = 0, width = sqrt(t) / PIECES;
        for (int i = 0; i < PIECES; i++) {
            double u = (i + 0.5) * width;
            sum += 2 * k / tau * exp((u * u - t) / tau) * width;
        }
        largest = fmax(largest, sum);
    }
    check_relative(links_beam_sensed(&p, 2, tau), largest, 1e-5);
    // K itself for the default beam, by hand: EI = 2.46 N m2, rho A = 0.40108 kg/m
    check_relative(k,
                   2 * pow(2.46, 0.25) * pow(0.40108, 0.75) / sqrt(2 * 3.14159265358979),
                   1e-12);
}

// Enough is the fewest from which on all are near, not the first that happens to be.
TEST(enough_is_enough_for_all_that_follow)
{
    links_row row = {.value = {100, 140, 103, 98, 101, 100}, .beam = 100, .limit = 5};
    links_judge(&row);
    assert_int_equal(row.enough, 8);
    check_close(row.off, 0.03, 1e-12);
    row.value[LINKS_LENGTHS - 1] = 110;
    links_judge(&row);
    assert_int_equal(row.enough, 0);

    // without a beam the limit counts, without either whether the last ones agree
    row = (links_row){.value = {1, 1, 1, 1, 1, 1}, .beam = (double)NAN, .limit = 1.01};
    links_judge(&row);
    assert_int_equal(row.enough, 2);
    row = (links_row){.value = {(double)NAN, 0.3, 0.28331, 0.28378, 0.28377, 0.28376},
                      .beam = (double)NAN,
                      .limit = (double)NAN};
    links_judge(&row);
    assert_int_equal(row.enough, 8);
    check_close(row.off, 0.00045 / 0.28376, 1e-12);
    row.value[3] = 0.2;
    links_judge(&row);
    assert_int_equal(row.enough, 0);
}

// A mass at the tip has no closed form here, but limits of its own.
TEST(uneven_arms_have_no_beam)
{
    const links_study study =
        studied("corrected/damped-beam", "arm.tip_mass=0.05 arm.hub_joint=beam");
    for (int k = 0; k < LINKS_QUANTITIES; k++) {
        assert_true(isnan(study.rows[k].beam));
    }
    const links_row *row = row_of(&study, "frequency_tip_free_Hz");
    check_close(row->order, 2, 0.15);
    assert_true(row->enough > 0);
}

TEST(what_has_no_contact_is_refused)
{
    KEPT_SCENARIO(s) = shipped_with("corrected/damped-beam", "motor.voltage=0");
    links_study study;
    REFUSED(STATUS_BAD_SCENARIO, "no contact", links_study_compute(&s, NULL, &study, &f));
    assert_int_equal(study.count, 0);
    KEPT_SCENARIO(two) = shipped("thesis/fig-3-4");
    REFUSED(STATUS_BAD_SCENARIO, "printed", links_study_compute(&two, NULL, &study, &f));

    run_monitor monitor = {0};
    atomic_store(&monitor.stop, true);
    REFUSED(STATUS_STOPPED, "", links_study_compute(&s, &monitor, &study, &f));
}
