// The columns of a run's table: those that a run of the scenario has values of, and those
// that are chosen among them.
#include "src/run/run_columns.h"

#include "src/run/run.h"
#include "tests/shipped_scenario.h"

static bool has_column(const run_columns *c, int signal)
{
    for (int i = 0; i < c->count; i++) {
        if (c->all[i].signal == signal) {
            return true;
        }
    }
    return false;
}

// Of every shipped scenario: a signal with a value in some row has its column, and a
// column that not every run has has a value in some row.
TEST(a_scenario_tells_which_signals_its_run_has)
{
    char **names;
    int count, special = 0;
    DONE(scenario_list(&names, &count, &f));
    for (int k = 0; k < count; k++) {
        SCOPED(run_columns_finish) run_columns c;
        SCOPED(free_kept) char *name = names[k];
        KEPT_SCENARIO(s) = shipped_with(name, "run.duration=2");
        KEPT_RUN(r);
        (void)run_scenario(&s, true, &r);
        assert_int_equal(run_columns_init(&c, &s, NULL, NULL), STATUS_OK);
        for (int i = 0; i < signal_count; i++) {
            const bool has = trace_has(&r.trace, i), told = has_column(&c, i);
            fail_if(has && !told, "%s: no column %s", s.name, signal_table[i].name);
            fail_if(told && signal_table[i].needs != 0 && !has, "%s: nothing in %s",
                    s.name, signal_table[i].name);
            special += told && signal_table[i].needs != 0;
        }
        const int angles = s.parameters.arm.links > 2 ? r.trace.angle_count : 0;
        assert_int_equal(c.all[c.count - 1].signal == -1, angles > 0);
        if (angles > 0) {
            assert_int_equal(c.all[c.count - 1].angle, angles - 1);
        }
    }
    free(names);
    assert_true(special > 10);
}

// --- chosen ones -----------------------------------------------------------------------

static void check_chosen(const char *chosen, const char *expected)
{
    char found[512] = "";
    SCOPED(run_columns_finish) run_columns c;
    KEPT_SCENARIO(s) = shipped("corrected/three-links");
    DONE(run_columns_init(&c, &s, chosen, &f));
    for (int i = 0; i < c.count; i++) {
        snprintf(found + strlen(found), sizeof found - strlen(found), "%s[%s] ",
                 c.all[i].name, c.all[i].unit);
    }
    assert_string_equal(found, expected);
}

TEST(columns_come_in_the_order_asked_for)
{
    check_chosen("force", "force[N] ");
    check_chosen("angle_2,force,time", "angle_2[rad] force[N] time[s] ");
    check_chosen(" time , contact", "time[s] contact[] ");
}

static void check_refused(const char *chosen, const char *sentence)
{
    SCOPED(run_columns_finish) run_columns c;
    fault f = {0};
    KEPT_SCENARIO(s) = shipped("corrected/three-links");
    assert_int_equal(run_columns_init(&c, &s, chosen, &f), STATUS_BAD_ARGUMENT);
    fail_if(strstr(f.text, sentence) == NULL, "'%s' does not say '%s'", f.text, sentence);
}

TEST(what_names_no_column_is_refused)
{
    check_refused("", "a name is missing");
    check_refused("time,,force", "a name is missing");
    check_refused("time,", "a name is missing");
    check_refused("forc", "there is no column 'forc', did you mean 'force'?");
    check_refused("angle_5", "there is no column 'angle_5'");
    check_refused("force - impulse", "there is no column 'force - impulse'");
    check_refused("time,force,time", "the column 'time' is there twice");
    check_refused("piezo_force", "no values of 'piezo_force'");
}

// A value is that of the row: of a signal, or of a link's angle.
TEST(a_column_has_its_value_of_a_row)
{
    SCOPED(run_columns_finish) run_columns c;
    KEPT_SCENARIO(s) = shipped("corrected/three-links");
    DONE(run_columns_init(&c, &s, "angle_3,gap", &f));
    const sample row = {.gap = 0.5};
    const double angles[] = {1, 2, 3};
    check_close(run_column_value(&c.all[0], &row, angles), 3, 0);
    check_close(run_column_value(&c.all[1], &row, angles), 0.5, 0);
}
