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

// The printed arm has no row of the state just before its touch, and no energies.
TEST(test_the_printed_arm_touches_and_does_not_start_on_the_wall)
{
    OPEN_SESSION(s, "thesis/fig-3-1");
    run_account(&s.effective, &s.run, sentences);
    check_says(formatted("touches the wall at %.4g s", s.run.summary.first_contact_s));
    char line[ACCOUNT_SENTENCE];
    run_account_line(&s.run, line);
    assert_non_null(strstr(line, "touches the wall at 0.314 s"));
}

// The number that stands before the first place of a word in a text; NaN if the text does
// not have the word.
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

static double zero_if_nan(double x)
{
    return isnan(x) ? 0 : x;
}

// The most energy [J] that any part of a run can have had: what the arm and the wall
// begin with, all that the motor, pushes and the wall's drive give or take from row to
// row, and what the weight gives between the highest and the lowest place.
static double most_energy_of(const trace *t)
{
    const sample *first = &t->rows[0];
    double energy =
        first->kinetic_energy + first->strain_energy + zero_if_nan(first->wall_energy);
    for (size_t i = 1; i < t->row_count; i++) {
        const sample *now = &t->rows[i], *before = now - 1;
        energy += fabs(now->motor_work - before->motor_work) +
                  fabs(now->external_work - before->external_work) +
                  zero_if_nan(fabs(now->wall_work - before->wall_work));
    }

    // there is no weight, but NaN, where the arm turns in a level plane
    double high = -HUGE_VAL, low = HUGE_VAL;
    for (EACH_ROW(row, t)) {
        high = fmax(high, row->weight_energy);
        low = fmin(low, row->weight_energy);
    }
    return energy + (high > low ? high - low : 0);
}

// One sentence of an account: its shares, times and energies are possible, and as much
// energy is taken as is given.
static void check_sentence(const char *text, double run_time, double most_energy,
                           const char *changes)
{
    const char *end = text + strlen(text);
    fail_if(end[-1] != '.' || strstr(text, "nan") != NULL || strstr(text, "inf") != NULL,
            "%s: %s", changes, text);

    // a share is between 0 and 100 %, and nothing lasts longer than the run
    const double share = number_before(text, " %"), lasts = number_before(text, " s,");
    fail_if(share < 0 || share > 100, "%s: %s", changes, text);
    fail_if(lasts < 0 || lasts > run_time * 1.001, "%s: %s", changes, text);

    // each energy, whose number has no more than 12 characters
    for (const char *at = text; (at = strstr(at, " J")) != NULL; at++) {
        const double energy = number_before(at - 12 > text ? at - 12 : text, " J");
        fail_if(energy < 0 || energy > 1.006 * most_energy, "%s: %g J: %s", changes,
                most_energy, text);
    }

    // the balance, to within the digits that are printed
    const char *given = strstr(text, "given by"), *taken = strstr(text, "taken by");
    if (given != NULL && taken != NULL) {
        const double gives = sum_of_energies(given, taken),
                     takes = sum_of_energies(taken, end);
        fail_if(fabs(gives - takes) > 0.01 * (gives + takes) + 1e-9, "%s: %s", changes,
                text);
    }
}

// The account of a run that these changes of a scenario led to.
static void check_account(const scenario *s, const run_result *run, const char *changes)
{
    const int count = run_account(s, run, sentences);
    assert_true(count >= 1 && count <= ACCOUNT_SENTENCES);
    const double most_energy = most_energy_of(&run->trace);
    for (int k = 0; k < count; k++) {
        check_sentence(sentences[k], LAST_ROW(&run->trace)->time, most_energy, changes);
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

// Five hundred arms whose joints, walls and drives are drawn at random.
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
