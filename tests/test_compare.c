// Rows of a comparison and what counts as a difference.
#include "src/study/compare.h"
#include "tests/rig_fixture.h"

TEST(differences_are_shares_of_the_larger_value)
{
    const double none = (double)NAN;
    assert_false(compare_differs(1.0, 1.05, 0.05));
    assert_true(compare_differs(1.0, 1.06, 0.05));
    assert_true(compare_differs(-1.0, 1.0, 0.5));
    assert_false(compare_differs(0, 0, 0));
    assert_true(compare_differs(0, 1e-9, 0.05));
    assert_false(compare_differs(none, none, 0.05));
    assert_true(compare_differs(none, 1, 0.05));
}

static sweep_axis varied_axis(const char *name)
{
    sweep_axis axis = {0};
    assert_int_equal(sweep_axis_find(&axis, name, NULL), STATUS_OK);
    return axis;
}

// The row of the impact of 5.4 under a law, named like it.
static compare_row row_of(scenario *s, const char *name, const char *law)
{
    *s = (scenario){.name = (char *)name, .parameters = rig_parameters_with("%s", law)};
    KEPT_RUN(r) = run_done(s, false);
    return compare_row_of(s, &r);
}

// What is written about a table.
typedef struct forms {
    char *page, *text, *csv, *json;
} forms;

static forms forms_of(const compare_table *t)
{
    WRITTEN(page, compare_text(stream, t, true));
    WRITTEN(text, compare_text(stream, t, false));
    WRITTEN(csv, compare_csv(stream, t));
    json_t *whole = compare_json(t);
    forms f = {page, text, csv, json_dumps(whole, JSON_COMPACT)};
    json_decref(whole);
    return f;
}

static void forget(forms *f)
{
    free(f->page);
    free(f->text);
    free(f->csv);
    free(f->json);
}

TEST(rows_reach_every_form)
{
    scenario a, b;
    compare_row rows[2] = {row_of(&a, "a \"b\"", "control.law=hybrid"),
                           row_of(&b, "bare", "control.law=none")};
    assert_string_equal(rows[0].law, "hybrid");
    assert_string_equal(rows[1].law, "none");
    compare_table table = {
        .rows = rows, .count = 2, .against = rows, .group = 2, .tolerance = 0.05};
    SCOPED(forget) forms of = forms_of(&table);
    // the reference differs from itself in nothing, the bare arm in its peak
    char *second = strchr(of.text, '\n') + 1, *third = strchr(second, '\n') + 1;
    assert_null(memchr(second, '*', (size_t)(third - second)));
    assert_non_null(strchr(third, '*'));
    assert_non_null(strstr(of.csv, "\n\"a \"\"b\"\"\",hybrid,ok,"));
    assert_non_null(
        strstr(of.csv, ",,,\n")); // no error, command and energy without a rig
    const char *run = strstr(of.json, "\"runs\":[{"), *next = strstr(run, "},{");
    assert_non_null(strstr(next, "\"steady_error_N\":null"));
    assert_null(strstr(next + 1, "},{"));
    const char *own =
                   strstr(run, formatted("\"peak_force_N\":%.17g,", rows[0].values[0])),
               *same = strstr(run, "\"differs\":[]");
    assert_true(own != NULL && own < next && same != NULL && same < next);
    assert_non_null(strstr(of.json, "\"against\":\"a \\\"b\\\"\""));
    assert_non_null(strstr(of.json, "\"tolerance\":0.05"));
    assert_null(strstr(of.json, "varied"));

    // without a reference nothing is said of one
    table.against = NULL;
    SCOPED(forget) forms alone = forms_of(&table);
    for (EACH_TEXT(c, "against", "tolerance", "differs")) {
        assert_null(strstr(alone.json, *c));
    }
}

// Two scenarios at two forces, each pair compared with the reference of its own force.
TEST(varied_values_have_columns)
{
    const sweep_axis varied[] = {varied_axis("control.force"),
                                 varied_axis("control.gains")};
    compare_row rows[4], references[2];
    for (int i = 0; i < 4; i++) {
        rows[i] = (compare_row){.scenario = i % 2 ? "b" : "a",
                                .law = "hybrid",
                                .ok = true,
                                .varied = {i / 2 ? 2 : 0.5, 1},
                                .values = {1.5 + i / 2}};
        references[i / 2] = rows[i];
    }
    rows[3].values[0] = 9;
    rows[3].idle[1] = "it is idle";
    compare_table t = {.rows = rows,
                       .count = 4,
                       .varied = varied,
                       .varied_count = 2,
                       .against = references,
                       .group = 2,
                       .tolerance = 0.05};
    DONE(compare_choose(&t, "peak_force_N,impacts", &f));
    SCOPED(forget) forms of = forms_of(&t);
    assert_non_null(strstr(of.page,
                           "| scenario | law | force [N] | gains | peak [N] | impacts |\n"
                           "|---|---|---|---|---|---|\n"
                           "| a | hybrid | 0.5 | volts | 1.5 | 0 |\n"));
    const char *idle = strstr(of.text, "volts (no effect)");
    assert_true(idle != NULL && strstr(idle + strlen("volts ("), "(no effect)") == NULL);
    idle = strstr(of.json, "\"without_effect\":[{\"path\":\"control.gains\","
                           "\"why\":\"it is idle\"}]");
    assert_true(idle != NULL && strstr(idle + 2, "without_effect") == NULL);
    assert_null(strstr(of.text, "error"));
    assert_non_null(strstr(of.text, "9*"));
    assert_null(strstr(of.text, "1.5*"));
    assert_non_null(strstr(
        of.csv,
        "scenario[],law[],control.force[N],control.gains[],status[],peak_force[N],"));
    assert_non_null(
        strstr(of.json,
               "\"varied\":{\"control.force\":2.0,\"control.gains\":\"volts\"}"));
    REFUSED(STATUS_BAD_ARGUMENT, "did you mean 'impacts'?",
            compare_choose(&t, "peak_force_N,impact", &f));
}

// Full knowledge of the state bounds every law, and only where its model holds.
TEST(nothing_beats_the_best)
{
    for (EACH_TEXT(c, "control.law=hybrid", "control.law=recovering",
                   "control.law=reverse-torque", "control.law=force-pd")) {
        for (int k = 1; k <= 8; k++) {
            scenario s = {.name = (char *)"it",
                          .parameters =
                              rig_parameters_with("%s control.force=%g", *c, 0.5 * k)};
            KEPT_RUN(r) = run_done(&s, false);
            compare_row row = compare_row_of(&s, &r);
            check_below(row.values[2], row.values[0]);
            check_below(row.values[5], row.values[4]);
            check_below(0.3, row.values[2]);
        }
    }
    scenario s;
    for (EACH_TEXT(each, "arm.links=3", "arm.hub_joint=spring", "wall.restitution=0.5",
                   "arm.model=printed", "arm.damping_ratio=0.01")) {
        KEPT_RUN(r);
        s = (scenario){.name = (char *)"it",
                       .parameters = rig_parameters_with("control.law=hybrid %s", *each)};
        run_scenario(&s, false, &r);
        compare_row row = compare_row_of(&s, &r);
        assert_true(isnan(row.values[2]) && isnan(row.values[5]));
    }
}

// The best settling time may press as hard as the run did, and at least up to the end of
// its band: after this impact no less than 0.789 N is possible.
TEST(a_gentle_run_is_held_against_its_band)
{
    static const double command[] = {0.7, 0.77}, pressed[] = {0, 0.8};
    for (int i = 0; i < 4; i++) {
        scenario s = {.name = (char *)"it",
                      .parameters =
                          rig_parameters_with("control.law=hybrid control.force=%g",
                                              command[i / 2])};
        KEPT_RUN(r) = run_done(&s, false);
        r.summary.peak_force_N = pressed[i % 2];
        const compare_row row = compare_row_of(&s, &r);
        const double allowed = fmax(1.05 * command[i / 2], pressed[i % 2]);
        check_relative(row.values[2], 0.789, 1e-3);
        assert_int_equal(isnan(row.values[5]), allowed < row.values[2]);
    }
}

// What failed says so in every form and has no numbers; values of each type have theirs.
TEST(a_failed_run_says_so)
{
    const sweep_axis varied[] = {varied_axis("printed.spring_counted_twice"),
                                 varied_axis("arm.model")};
    compare_row rows[2] = {
        {.scenario = "a", .law = "none", .ok = true, .varied = {1, ARM_PRINTED}},
        {.scenario = "b", .law = "none", .varied = {0, ARM_CORRECTED}}};
    for (int k = 0; k < COMPARE_QUANTITIES; k++) {
        rows[0].values[k] = 1234.5;
        rows[1].values[k] = (double)NAN;
    }
    const compare_table t = {
        .rows = rows, .count = 2, .varied = varied, .varied_count = 2, .group = 1};
    SCOPED(forget) forms of = forms_of(&t);
    assert_non_null(strstr(of.text, " failed\n"));
    assert_null(strstr(strstr(of.text, " failed\n") + 1, " failed\n"));
    assert_non_null(strstr(of.csv, "\nb,none,"));
    assert_non_null(strstr(of.csv, ",failed,,"));
    assert_non_null(strstr(of.page, " 1234 | 1234 |"));
    assert_non_null(strstr(of.page, " – | – |"));
    assert_non_null(strstr(of.json, "\"varied\":{\"printed.spring_counted_twice\":true,"
                                    "\"arm.model\":\"printed\"},\"status\":\"ok\""));
    assert_non_null(strstr(of.json, "\"status\":\"failed\",\"peak_force_N\":null"));
}

// Every form to the last character: widths, marks, units, and a thousand without digits
// behind it.
TEST(forms_are_written_to_the_letter)
{
    const sweep_axis varied[] = {varied_axis("control.force"),
                                 varied_axis("sensor.ideal")};
    compare_row rows[3] = {{.scenario = "a",
                            .law = "hybrid",
                            .ok = true,
                            .varied = {0.5, 1},
                            .values = {1.5}},
                           {.scenario = "much longer",
                            .law = "none",
                            .varied = {12.25, 0},
                            .values = {(double)NAN}},
                           {.scenario = "c",
                            .law = "recovering",
                            .ok = true,
                            .varied = {1, 1},
                            .values = {1.6}}};
    rows[0].values[8] = 1000;
    rows[1].values[8] = 999.75;
    rows[2].values[8] = -1000;
    compare_table t = {.rows = rows,
                       .count = 3,
                       .varied = varied,
                       .varied_count = 2,
                       .against = rows,
                       .group = 3,
                       .tolerance = 0.05};
    DONE(compare_choose(&t, "impacts,peak_force_N", &f));
    SCOPED(forget) forms of = forms_of(&t);
    assert_string_equal(of.page,
                        "| scenario | law | force [N] | ideal | peak [N] | impacts |\n"
                        "|---|---|---|---|---|---|\n"
                        "| a | hybrid | 0.5 | true | 1.5 | 1000 |\n"
                        "| much longer | none | 12.25 | false | – | 1000 |\n"
                        "| c | recovering | 1 | true | 1.6 | -1000 |\n");
    assert_string_equal(
        of.text,
        "scenario     law         force/N  ideal       peak/N       impacts \n"
        "a            hybrid          0.5   true          1.5          1000 \n"
        "much longer  none          12.25  false            -*        999.8  failed\n"
        "c            recovering        1   true          1.6*        -1000*\n");
    const char *rows_of_csv = strchr(of.csv, '\n') + 1;
    assert_string_equal(
        rows_of_csv, "a,hybrid,0.5,true,ok,1.5,0,0,0,0,0,0,0,1000,0,0,0,0\n"
                     "much longer,none,12.25,false,failed,,0,0,0,0,0,0,0,999.75,0,0,0,0\n"
                     "c,recovering,1,true,ok,1.6,0,0,0,0,0,0,0,-1000,0,0,0,0\n");
}

// Each number of a row is the summary's, or a bound that holds for such an arm only.
TEST(a_row_has_the_numbers_of_its_run)
{
    const char *const *const cases[] = {
        given("control.law=hybrid control.force=2"),
        given("control.law=none"),
        given("control.law=hybrid initial.velocity=0.1"),
        given("control.law=hybrid wall.restitution=0.3"),
        given("control.law=hybrid arm.links=3"),
        given("control.law=force-pd control.force=0"),
        given("control.law=hybrid run.duration=0.01"),
    };
    const action push = {.time = 0.5,
                         .kind = ACTION_PUSH,
                         .parameter = -1,
                         .value = 1e-3};
    for (size_t i = 0; i < 1 + sizeof cases / sizeof cases[0]; i++) {
        const bool scripted = i == sizeof cases / sizeof cases[0];
        action script[1] = {push};
        scenario s = {.name = (char *)"it",
                      .parameters = rig_parameters(cases[scripted ? 0 : i]),
                      .actions = scripted ? script : NULL,
                      .action_count = scripted};
        KEPT_RUN(r) = run_done(&s, false);
        const summary *m = &r.summary;
        const compare_row row = compare_row_of(&s, &r);
        const bool on_rig = i != 1 && i != 5;
        const double expected[COMPARE_QUANTITIES] = {
            [0] = m->peak_force_N,
            [1] = m->sensor_1ms_peak_N,
            [3] = on_rig ? 100 * m->force_over_command_N / m->force_command_N
                         : m->force_overshoot_percent,
            [4] = m->settling_time_s,
            [6] = m->first_contact_s + m->settling_time_s,
            [8] = m->impacts,
            [9] = m->separations,
            [10] = m->steady_error_N,
            [11] = m->largest_command_V,
            [12] = m->electrical_energy_J,
        };
        for (int k = 0; k < COMPARE_QUANTITIES; k++) {
            if (k == 2 || k == 5 || k == 7) {
                // bounds of a plastic impact of two links without a script; the least
                // time is for an arm that starts at rest with a commanded force
                const bool impact = i < 3 || i == 5;
                const bool known = k == 2 ? impact : k == 5 ? i == 0 || i == 2 : i == 0;
                fail_if(isnan(row.values[k]) == known, "case %zu: %s is %g", i,
                        compare_quantities[k].key, row.values[k]);
            } else if (!(row.values[k] == expected[k] ||
                         (isnan(row.values[k]) && isnan(expected[k])))) {
                fail_msg("case %zu: %s is %g, not %g", i, compare_quantities[k].key,
                         row.values[k], expected[k]);
            }
        }
        assert_true(row.ok);
        assert_ptr_equal(row.scenario, s.name);
    }
}
