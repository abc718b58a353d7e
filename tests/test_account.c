// The account of a run says what its rows, events and energies say.
#include "tests/session_fixture.h"

#include "src/base/random.h"
#include "src/session/account.h"

static char sentences[ACCOUNT_SENTENCES][ACCOUNT_SENTENCE];

static void check_says(const char *wanted)
{
    for (int i = 0; i < ACCOUNT_SENTENCES; i++) {
        if (strstr(sentences[i], wanted) != NULL) {
            return;
        }
    }
    fail_msg("no sentence says '%s': '%s' '%s' '%s' '%s' '%s'", wanted, sentences[0],
             sentences[1], sentences[2], sentences[3], sentences[4]);
}

// Numbers found independently: touch and release from the summary, energies from the
// rows.
TEST(test_a_first_impact_is_told_in_five_sentences)
{
    OPEN_SESSION(s, "corrected/first-impact");
    const summary *m = &s.run.summary;
    const trace *t = &s.run.trace;
    assert_int_equal(run_account(&s.effective, &s.run, sentences), 5);
    check_says(formatted("touches the wall at %.4g s", m->first_contact_s));
    check_says(formatted("impulse of %.3g N s", m->contact_impulse_Ns));
    check_says(formatted("lets go at %.4g s", m->first_contact_s + m->first_pulse_s));

    // the first turn of the hub in contact, seen in its velocity
    size_t r = trace_row_at(t, m->first_contact_s + 0.001);
    while (t->rows[r].hub_velocity > 0) {
        r++;
    }
    check_says(formatted("at %.3g", t->rows[r].time));

    // what the springs lose from the peak on, and what the motor does
    const sample *high =
        &t->rows[trace_row_at(t, m->first_contact_s + m->first_pulse_time_to_peak_s)];
    const sample *free = &t->rows[trace_row_at(t, m->first_contact_s + m->first_pulse_s)];
    check_says(
        formatted("given by springs %.3g J", high->strain_energy - free->strain_energy));
    check_says(formatted("motor %.3g J", high->motor_work - free->motor_work));
}

// The number in front of a word, or NaN.
static double number_before(const char *text, const char *word)
{
    const char *at = strstr(text, word);
    while (at != NULL && at > text && strchr("0123456789.e-+ ", at[-1]) != NULL) {
        at--;
    }
    return at != NULL ? strtod(at, NULL) : (double)NAN;
}

// The sum of all numbers in J between two places.
static double sum_of_energies(const char *from, const char *to)
{
    double sum = 0;
    for (; from < to; from++) {
        char *end;
        const double number = strtod(from, &end);
        if (end != from && strncmp(end, " J", 2) == 0) {
            sum += number;
        }
        from = end != from ? end : from;
    }
    return sum;
}

// No share is above all or below nothing, no energy above what the arm began with, was
// given and fell through; and what is given is taken.
static void check_account(const scenario *s, const run_result *run, const char *of)
{
    const int count = run_account(s, run, sentences);
    const trace *t = &run->trace;
    const sample *row = t->rows;
    double there = row->kinetic_energy + row->strain_energy, high = -HUGE_VAL,
           low = HUGE_VAL;
    there += isnan(row->wall_energy) ? 0 : row->wall_energy;
    for (size_t r = 0; r < t->row_count; r++) {
        const sample *now = row + r, *before = row + (r > 0 ? r - 1 : 0);
        const double wall = now->wall_work - before->wall_work;
        there += fabs(now->motor_work - before->motor_work) +
                 fabs(now->external_work - before->external_work) +
                 (isnan(wall) ? 0 : fabs(wall));
        high = fmax(high, now->weight_energy);
        low = fmin(low, now->weight_energy);
    }
    there += high > low ? high - low : 0;
    assert_true(count >= 1 && count <= ACCOUNT_SENTENCES);
    for (int k = 0; k < count; k++) {
        const char *text = sentences[k], *end = text + strlen(text);
        fail_if(end[-1] != '.' || strstr(text, "nan") != NULL ||
                    strstr(text, "inf") != NULL,
                "%s: %s", of, text);
        const double share = number_before(text, " %"),
                     lasts = number_before(text, " s,");
        fail_if(share < 0 || share > 100, "%s: %s", of, text);
        fail_if(lasts < 0 || lasts > t->rows[t->row_count - 1].time * 1.001, "%s: %s", of,
                text);
        for (const char *at = text; (at = strstr(at, " J")) != NULL; at++) {
            const double energy = number_before(at - 12 > text ? at - 12 : text, " J");
            fail_if(energy < 0 || energy > 1.006 * there, "%s: %g J: %s", of, there,
                    text);
        }
        const char *given = strstr(text, "given by"), *taken = strstr(text, "taken by");
        if (given != NULL && taken != NULL) {
            const double gives = sum_of_energies(given, taken),
                         takes = sum_of_energies(taken, end);
            fail_if(fabs(gives - takes) > 0.01 * (gives + takes) + 1e-9, "%s: %s", of,
                    text);
        }
    }
}

TEST(test_every_scenario_has_an_account_within_bounds)
{
    char **names;
    int count;
    DONE(scenario_list(&names, &count, &f));
    for (int i = 0; i < count; i++) {
        KEPT_SCENARIO(s) = shipped(names[i]);
        KEPT_RUN(result);
        run_scenario(&s, true, &result);
        check_account(&s, &result, names[i]);
    }
    free_names(names, count);
}

// Five hundred arms with walls and drives that are drawn.
TEST(test_random_arms_have_accounts_within_bounds)
{
    static const char *const joints[] = {"rigid", "spring arm.k1=90", "beam"};
    static const char *const walls[] = {"",
                                        "wall.restitution=0.6",
                                        "wall.kind=plane",
                                        "wall.contact=kelvin-voigt wall.stiffness=2000",
                                        "wall.contact=kelvin-voigt wall.mass=0.05",
                                        "wall.contact=hunt-crossley",
                                        "wall.motion=sine wall.motion_frequency=7"};
    static const char *const drives[] = {"",
                                         "motor.voltage=0",
                                         "motor.inductance=0.01",
                                         "control.law=hybrid",
                                         "control.law=force-pd sensor.ideal=true",
                                         "motor.voltage=-0.5 initial.velocity=3"};
    random_generator g;
    random_seed(&g, 2);
    for (int i = 0; i < 500; i++) {
        const char *changes =
            formatted("arm.links=%d arm.hub_joint=%s arm.damping_ratio=%g arm.tilt=%g "
                      "arm.tip_mass=%g wall.angle=0 initial.angle=-0.05 "
                      "initial.velocity=%g run.duration=0.3 %s %s",
                      2 + (int)random_below(&g, 5), joints[random_below(&g, 3)],
                      0.04 * (double)random_below(&g, 2),
                      0.3 * (double)random_below(&g, 3) - 0.3,
                      0.02 * (double)random_below(&g, 2), 3 * random_uniform(&g),
                      walls[random_below(&g, 7)], drives[random_below(&g, 6)]);
        KEPT_SCENARIO(s) = shipped_with("corrected/first-impact", changes);
        KEPT_RUN(result);
        run_scenario(&s, true, &result);
        check_account(&s, &result, changes);
    }
}
