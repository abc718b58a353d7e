// The account of a run says what its rows, events and energies say.
#include "tests/session_fixture.h"

#include "src/session/session.h"

static char sentences[ACCOUNT_SENTENCES][ACCOUNT_SENTENCE];

static void check_says(const char *wanted)
{
    for (int i = 0; i < ACCOUNT_SENTENCES; i++) {
        if (strstr(sentences[i], wanted) != NULL) {
            return;
        }
    }
    fail_msg("no sentence says '%s': '%s' '%s' '%s' '%s' '%s'", wanted, sentences[0], sentences[1],
             sentences[2], sentences[3], sentences[4]);
}

// Numbers found independently: touch and release from the summary, energies from the rows.
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

    // of the strain energy at the peak, that much is motion when it lets go
    const size_t high = trace_row_at(t, m->first_contact_s + m->first_pulse_time_to_peak_s);
    const size_t free = trace_row_at(t, m->first_contact_s + m->first_pulse_s);
    check_says(formatted("give back %.2g %%",
                         100 * t->rows[free].kinetic_energy / t->rows[high].strain_energy));
}

// Whatever ships: at least a sentence, each ends, and no number is missing.
TEST(test_every_scenario_has_an_account)
{
    for (EACH_TEXT(c, "corrected/free-vibration", "corrected/hertz-wall", "corrected/restitution",
                   "corrected/three-links", "corrected/stuck-hub", "corrected/pull-away",
                   "thesis/fig-3-4", "thesis/fig-2-4", "compare/hybrid", "compare/force-pd",
                   "compare/observer", "corrected/push-in-contact", "corrected/spring-hub",
                   "corrected/newmark", "corrected/clamped-vibration")) {
        OPEN_SESSION(s, *c);
        const int count = run_account(&s.effective, &s.run, sentences);
        assert_true(count >= 1 && count <= ACCOUNT_SENTENCES);
        for (int k = 0; k < count; k++) {
            const size_t length = strlen(sentences[k]);
            fail_if(sentences[k][length - 1] != '.' || strstr(sentences[k], "nan") != NULL ||
                        strstr(sentences[k], "inf") != NULL,
                    "%s: %s", *c, sentences[k]);
        }
    }
}
