// Control laws over many beliefs: the set, the judgement, and that it depends on the seed
// alone.
#include "src/study/robust/robust.h"
#include "tests/rig_fixture.h"

static const char path[] = "the.set";

static status read_set(robust_set *set, const char *text, fault *f)
{
    put_file(path, text);
    return robust_set_read(set, path, f);
}

static robust_set set_of(const char *text)
{
    robust_set set;
    DONE(read_set(&set, text, &f));
    return set;
}

// The scenario in a case of it, or in none.
static scenario derived_of(const scenario *base, const robust_case *of)
{
    scenario derived;
    DONE(robust_case_scenario(&derived, base, of, &f));
    return derived;
}

// Both of them, and the judgement of a law, until their block is left.
#define SET(set, text) SCOPED(robust_set_finish) robust_set set = set_of(text)
#define DERIVED(name, ...)                                                               \
    SCOPED(robust_case_finish) scenario name = derived_of(__VA_ARGS__)
#define JUDGED(found, law, ...)                                                          \
    SCOPED(robust_law_finish) robust_law found;                                          \
    free(judged(&found, law, __VA_ARGS__))

// Comments, blank lines and the space around a line do not count.
TEST(a_set_is_its_lines)
{
    SET(set, "# beliefs\n\n  belief.k2_factor=0.75:1.25 \r\nwall.kind=point,plane");
    assert_int_equal(set.count, 2);
    assert_string_equal(set.lines[0], "belief.k2_factor=0.75:1.25");
    assert_string_equal(set.lines[1], "wall.kind=point,plane");

    // a file without a line, and none
    robust_set none;
    REFUSED(STATUS_BAD_ARGUMENT, "", read_set(&none, "\n# nothing\n", &f));
    unlink(path);
    REFUSED(STATUS_CANNOT_READ, "", robust_set_read(&none, path, &f));
}

// A line "case TITLE: CHANGES" is read as a title, settings and pushes, which are applied
// to the scenario and added to its script.
TEST(cases_are_what_differs)
{
    SET(set, "control.seed=1,2\ncase plain:\n"
             "case two at once : belief.k2_factor=0.5; arm.links=3 ;push=-0.05@0.8\n");
    assert_int_equal(set.count, 1);
    assert_int_equal(set.case_count, 2);
    assert_string_equal(set.cases[1].title, "two at once");

    // the first is the scenario itself, the second differs in what it says
    scenario base = {.name = "test", .parameters = rig_parameters_with("run.duration=1")};
    DERIVED(plain, &base, &set.cases[0]);
    assert_int_equal(plain.action_count, 0);
    assert_int_equal(plain.parameters.arm.links, 2);
    DERIVED(two, &base, &set.cases[1]);
    assert_int_equal(two.parameters.arm.links, 3);
    check_close(two.parameters.belief.k2_factor, 0.5, 0);
    assert_int_equal(two.action_count, 1);
    assert_int_equal(two.actions[0].kind, ACTION_PUSH);
    check_close(two.actions[0].value, -0.05, 0);
    check_close(two.actions[0].time, 0.8, 0);

    // the scenario's own script stays, with a case and without one
    base.actions = &PUSHES(0.5, 0.02);
    base.action_count = 1;
    DERIVED(without, &base, NULL);
    assert_int_equal(without.action_count, 1);
    check_close(without.actions[0].value, 0.02, 0);
    DERIVED(with, &base, &set.cases[1]);
    assert_int_equal(with.action_count, 2);
    check_close(with.actions[0].value, 0.02, 0);
    check_close(with.actions[1].value, -0.05, 0);
}

// Cases without colon, title, time or number, or with more pushes than there is room for.
TEST(what_is_no_case_is_refused)
{
    for (EACH_TEXT(c, "control.seed=1,2\ncase no colon\n",
                   "control.seed=1,2\ncase a: push=0.05\n",
                   "control.seed=1,2\ncase a: nonsense\n", "case a:\n",
                   "control.seed=1,2\ncase : arm.links=3\n",
                   "control.seed=1,2\ncase a: push=0.1@-1\n",
                   "control.seed=1,2\ncase a: push=0.1@1 s\n",
                   "control.seed=1,2\ncase a: push=1e999@0.1\n",
                   "control.seed=1,2\ncase a: push=0.1@1e999\n",
                   "control.seed=1,2\ncase a: push=much@1\n",
                   "control.seed=1,2\ncase a: push=0.1@soon\n",
                   ("control.seed=1,2\ncase a: push=1@1; push=1@2; push=1@3;"
                    "push=1@4; push=1@5\n"))) {
        SCOPED(robust_set_finish) robust_set set; // as callers do
        REFUSED(STATUS_BAD_ARGUMENT, "", read_set(&set, *c, &f));
    }

    // of several settings that cannot be the first is named
    SET(set, "control.seed=1,2\ncase a: arm.k2=4; arm.links=-3; wall.restitution=7\n");
    const scenario base = {.name = "test",
                           .parameters = rig_parameters_with("run.duration=1")};
    SCOPED(robust_case_finish) scenario derived;
    fault f = {0};
    assert_int_equal(robust_case_scenario(&derived, &base, &set.cases[0], &f),
                     STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(f.text, "case 'a'"));
    assert_non_null(strstr(f.text, "arm.links"));
    assert_null(strstr(f.text, "wall.restitution"));
    assert_non_null(strstr(f.text, path));
    assert_int_equal(f.line, 2);
}

// A push that would never act, or not on this arm, and what the scenario has besides.
TEST(pushes_of_a_case_must_act)
{
    static const struct {
        const char *text, *says;
    } wrong[] = {{"a=1\n\ncase late: push=1@1.1\n",
                  ":3: case 'late': a push at 1.1 s is outside"},
                 {"a=1\ncase later: push=1@0.1; push=1@9\n", "a push at 9 s is outside"},
                 {"a=1\ncase short: run.duration=0.4; push=1@0.5\n",
                  "expected 0 to 0.4 s"},
                 {"a=1\ncase old: arm.model=printed; push=1@0.1\n", "takes no pushes"}};
    scenario base = {.name = "test", .parameters = rig_parameters_with("run.duration=1")};
    base.parameters.control.law = LAW_NONE;
    for (EACH(c, wrong)) {
        SET(set, c->text);
        SCOPED(robust_case_finish) scenario derived;
        fault f = {0};
        assert_int_not_equal(robust_case_scenario(&derived, &base, &set.cases[0], &f),
                             STATUS_OK);
        fail_if(strstr(f.text, c->says) == NULL, "'%s' does not say '%s'", f.text,
                c->says);
    }

    // at the very end there is still a run
    SET(set, "a=1\ncase last: push=1@1\n");
    DERIVED(derived, &base, &set.cases[0]);
}

// Whatever stands in the place of a set is refused once, and the caller goes on.
TEST(what_is_no_set_is_refused)
{
    static const struct {
        const char *path;
        status code;
    } cases[] = {{".", STATUS_CANNOT_READ},
                 {"/dev/full", STATUS_BAD_ARGUMENT},
                 {"/dev/zero", STATUS_BAD_ARGUMENT},
                 {"/dev/null", STATUS_BAD_ARGUMENT},
                 {"/nowhere", STATUS_CANNOT_READ}};
    for (EACH(c, cases)) {
        SCOPED(robust_set_finish) robust_set set;
        REFUSED(c->code, c->path, robust_set_read(&set, c->path, &f));
    }
}

// Judges a law over the lines of a set (`count` of them), in `runs` runs on `jobs`
// threads. Returns the table as JSON; free it.
static char *judged(robust_law *found, int law, size_t runs, int jobs, int count,
                    char *const *lines)
{
    KEPT_SWEEP(s);
    KEPT_STORE(store);
    sweep_progress progress;
    scenario base = {.name = "test",
                     .parameters = rig_parameters_with("run.duration=1.5")};
    base.parameters.control.law = law;
    base.parameters.set[PARAMETER_INDEX(control.law)] = 1; // a default would come back
    sweep_request request = {.vary = lines,
                             .vary_count = count,
                             .sampling = SWEEP_LATIN,
                             .runs = runs,
                             .seed = 3};
    DONE(sweep_init(&s, &base, &request, &f));
    DONE(sweep_store_open(&store, NULL, &s, &f));
    sweep_options options = {.jobs = jobs};
    DONE(sweep_run(&s, store, &options, &progress, &f));
    DONE(robust_law_of(found, "law", &s, (sweep_share){0}, store, &f));

    robust_table table = {"test", found, 1, NULL};
    json_t *json = robust_json(&table);
    char *text = json_dumps(json, JSON_INDENT(2));
    json_decref(json);
    return text;
}

// Sets as short and as long as they may be, cases with as many pushes and settings as
// there are.
TEST(sets_have_limits)
{
    enum { LONGEST = 65536 };
    fault f = {0};
    SET(shortest, "x");
    assert_int_equal(shortest.count, 1);
    assert_string_equal(shortest.lines[0], "x");

    // lines of one character, and one with as many as the file may have, or one more
    static char text[LONGEST + 2];
    for (int i = 0; i < 200; i++) {
        text[2 * i] = (char)('a' + i % 26);
        text[2 * i + 1] = '\n';
    }
    text[400] = '\0';
    robust_set set = set_of(text);
    assert_int_equal(set.count, SWEEP_MOST_AXES + 1);
    for (int i = 0; i < set.count; i++) {
        assert_int_equal(set.lines[i][0], 'a' + i % 26);
        assert_int_equal(set.lines[i][1], '\0');
    }
    robust_set_finish(&set);
    for (int over = 0; over < 2; over++) {
        memset(text, '1', LONGEST + 1);
        text[LONGEST + over] = '\0';
        assert_int_equal(read_set(&set, text, &f),
                         over ? STATUS_BAD_ARGUMENT : STATUS_OK);
        if (!over) {
            assert_int_equal(strlen(set.lines[0]), LONGEST);
        }
        robust_set_finish(&set);
    }

    // a byte that ends texts
    put_bytes(path, "a=1\0b=2\n", 8);
    assert_int_equal(robust_set_read(&set, path, &f), STATUS_BAD_ARGUMENT);
    robust_set_finish(&set);

    // four pushes, from the start on, and settings of several cases behind one another
    set = set_of("a=1\ncase one: a=1; push=1@0; push=-2@0.5;push=3@1 ; push=4@2; b=2;\n"
                 "\t# nothing\n  case  two : c=3 \ncase three:;\nb=2");
    assert_int_equal(set.count, 2);
    assert_string_equal(set.lines[1], "b=2");
    assert_int_equal(set.line_numbers[0], 1);
    assert_int_equal(set.line_numbers[1], 6);
    assert_int_equal(set.case_count, 3);
    const robust_case *c = set.cases;
    assert_string_equal(c[0].title, "one");
    assert_string_equal(c[1].title, "two");
    assert_string_equal(c[2].title, "three");
    static const int settings[] = {2, 1, 0}, lines[] = {2, 4, 5};
    for (int i = 0; i < 3; i++) {
        assert_int_equal(c[i].line, lines[i]);
        assert_int_equal(c[i].setting_count, settings[i]);
        assert_int_equal(c[i].push_count, i == 0 ? 4 : 0);
    }
    assert_string_equal(c[0].settings[0], "a=1");
    assert_string_equal(c[0].settings[1], "b=2");
    assert_string_equal(c[1].settings[0], "c=3");
    static const double impulses[] = {1, -2, 3, 4}, times[] = {0, 0.5, 1, 2};
    for (int i = 0; i < 4; i++) {
        check_close(c[0].push_impulse[i], impulses[i], 0);
        check_close(c[0].push_time[i], times[i], 0);
    }
    robust_set_finish(&set);
    assert_int_equal(set.count + set.case_count, 0);
    assert_null(set.text);

    // one push too many, with the line that has it
    assert_int_equal(
        read_set(&set,
                 "a=1\n\ncase one: push=1@1; push=1@1; push=1@1; push=1@1; push=1@1\n",
                 &f),
        STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(f.text, formatted("%s:3: no case", path)));
    assert_int_equal(f.line, 3);
    robust_set_finish(&set);
}

// One thread and three judge a law alike: the same table and the same overshoots.
TEST(threads_change_nothing)
{
    enum { RUNS = 12, LINES = 2 };
    char *const lines[] = {"belief.k2_factor=0.75:1.25", "control.seed=1:1000"};
    SCOPED(robust_law_finish) robust_law one, two;
    KEPT_TEXT(alone) = judged(&one, LAW_HYBRID, RUNS, 1, LINES, lines);
    KEPT_TEXT(shared) = judged(&two, LAW_HYBRID, RUNS, 3, LINES, lines);
    assert_string_equal(alone, shared);
    assert_memory_equal(one.overshoots, two.overshoots, RUNS * sizeof(double));
}

// With a single run every quantile is the value of that run, in percent of the command.
TEST(one_run_is_all_its_quantiles)
{
    JUDGED(found, LAW_HYBRID, 1, 1, 1, ((char *const[]){"wall.kind=point"}));
    summary s = rig_summary_with("control.law=hybrid run.duration=1.5");
    for (int i = 0; i < ROBUST_QUANTILES; i++) {
        check_relative(found.overshoot[i],
                       100 * s.force_over_command_N / s.force_command_N, 1e-12);
        check_relative(found.settling[i], s.settling_time_s, 1e-12);
        check_relative(found.error[i], 100 * fabs(s.steady_error_N) / s.force_command_N,
                       1e-12);
    }
    check_close(found.settled, 1, 0);
    check_close(found.exceeded, 1, 0); // by 77 % of the command
}

// Twenty-four arms whose mass, torque, friction and wall differ from what the laws
// believe, judged for both laws on two threads. The quantiles of a law rise to the worst
// run. The bounds for the observer law (30 % overshoot, 5 % error) are what it is meant
// to keep, and its worst run is better than the median of the hybrid law.
TEST(quantiles_rise_and_the_observer_law_stands_the_set)
{
    enum { RUNS = 24, JOBS = 2, LINES = 5 };
    char *const lines[] = {"belief.mass_factor=0.85:1.15",
                           "belief.torque_factor=0.85:1.15",
                           "belief.friction_factor=0.7:1.3",
                           "belief.wall_error=-0.03:0.03", "control.seed=1:1000"};
    SCOPED(robust_law_finish) robust_law hybrid, observer;

    // the table itself is not looked at here
    free(judged(&hybrid, LAW_HYBRID, RUNS, JOBS, LINES, lines));
    free(judged(&observer, LAW_OBSERVER, RUNS, JOBS, LINES, lines));

    // overshoots are sorted: the worst is the last
    check_below(hybrid.overshoot[ROBUST_MEDIAN], hybrid.overshoot[ROBUST_WORST]);
    check_close(hybrid.overshoot[ROBUST_WORST], hybrid.overshoots[RUNS - 1], 0);

    // the observer law keeps its bounds and settles in every run
    check_below(observer.overshoot[ROBUST_WORST], 30);
    check_below(observer.error[ROBUST_WORST], 5);
    check_below(observer.overshoot[ROBUST_WORST], hybrid.overshoot[ROBUST_MEDIAN]);
    check_close(observer.settled, 1, 0);
}

// Of the two starting angles only the second is near enough to the wall to settle: half
// of the runs settle, and the worst settling time is none at all.
TEST(what_never_settles_is_in_no_quantile)
{
    JUDGED(found, LAW_HYBRID, 4, 1, 1, ((char *const[]){"initial.angle=-2.9,-0.1"}));
    check_close(found.settled, 0.5, 0);
    assert_true(isnan(found.settling[ROBUST_WORST]));
}

// How often a character stands in a line.
static int count_in_line(const char *line, char sought)
{
    int count = 0;
    for (; *line != '\0' && *line != '\n'; line++) {
        count += *line == sought;
    }
    return count;
}

static void write_page(FILE *stream, const robust_table *t)
{
    robust_text(stream, t, true);
}

// Every line of a table has as many columns as its heading, and the laws stand in it.
static void check_table(void (*writes)(FILE *, const robust_table *),
                        const robust_table *t, char separator, int lines)
{
    SCOPED(free_kept) WRITTEN(text, writes(stream, t));
    const char *line = text;
    const int columns = count_in_line(text, separator);
    assert_true(columns > 5);
    for (int i = 0; i < lines; i++) {
        fail_if(count_in_line(line, separator) != columns, "not %d columns in: %s",
                columns, line);
        line = strchr(line, '\n') + 1;
    }
    assert_string_equal(line, "");
    for (int i = 0; i < t->count; i++) {
        assert_non_null(strstr(text, t->laws[i].law));
        assert_true(t->laws[i].case_title == NULL ||
                    strstr(text, t->laws[i].case_title) != NULL);
    }
}

// Tables as text (a head of two lines) and as CSV (a head of one line) have a line for
// each law, with and without a law to compare with.
TEST(tables_have_a_line_a_law)
{
    const double never = (double)NAN;
    robust_law laws[] = {{.law = "hybrid",
                          .runs = 10,
                          .settled = 1,
                          .overshoot_of = "peak",
                          .overshoot = {3, 8, never},
                          .against = never},
                         {.law = "touch",
                          .runs = 10,
                          .failed = 2,
                          .settled = 0.8,
                          .overshoot_of = "peak",
                          .against = 1.25}};
    robust_table table = {"test", laws, 2, NULL};
    check_table(write_page, &table, '|', 4);
    check_table(robust_csv, &table, ',', 3);
    table.against = "hybrid";
    check_table(write_page, &table, '|', 4);

    // of cases, by their titles
    laws[0].case_title = "plain";
    laws[1].case_title = "late";
    check_table(write_page, &table, '|', 4);
    check_table(robust_csv, &table, ',', 3);
    table.against = NULL;
    check_table(write_page, &table, '|', 4);
}

// The text says how many runs failed and rounds large numbers; JSON names what there is.
TEST(texts_and_json_say_what_is_there)
{
    robust_law laws[] = {{.law = "hybrid",
                          .runs = 10,
                          .failed = 3,
                          .overshoot_of = "peak",
                          .overshoot = {12345.6, 2, 3}}};
    robust_table table = {"test", laws, 1, NULL};
    WRITTEN(text, robust_text(stream, &table, false));
    assert_non_null(strstr(text, "3 failed"));
    assert_non_null(strstr(text, "12346"));
    free(text);

    json_t *json = robust_json(&table);
    assert_null(json_object_get(json, "against"));
    assert_null(
        json_object_get(json_array_get(json_object_get(json, "laws"), 0), "case"));
    json_decref(json);
    laws[0].case_title = "plain";
    table.against = "hybrid";
    json = robust_json(&table);
    assert_string_equal(json_string_value(json_object_get(json, "against")), "hybrid");
    assert_string_equal(json_string_value(json_object_get(
                            json_array_get(json_object_get(json, "laws"), 0), "case")),
                        "plain");
    json_decref(json);
}

// A scenario with a force limit counts the runs that exceed it. Arms of two links are
// judged by the peak force, chains of more links by the smoothed force.
TEST(a_limit_says_what_is_too_much)
{
    char *const low[] = {"control.force_limit=0.5"}, *const high[] = {
                                                         "control.force_limit=100"};
    char *const links[] = {"arm.links=3"};
    robust_law found;
    free(judged(&found, LAW_HYBRID, 1, 1, 1, low));
    check_close(found.exceeded, 1, 0);
    robust_law_finish(&found);
    free(judged(&found, LAW_HYBRID, 1, 1, 1, high));
    check_close(found.exceeded, 0, 0);
    robust_law_finish(&found);

    free(judged(&found, LAW_HYBRID, 1, 1, 1, links));
    const summary s = rig_summary_with("control.law=hybrid run.duration=1 arm.links=3");
    check_relative(found.overshoot[ROBUST_MEDIAN],
                   100 * s.smoothed_over_command_N / s.force_command_N, 1e-12);
    robust_law_finish(&found);

    // both kinds are there for any number of links, and it is said which is which
    static const struct {
        char *line;
        const char *of;
    } kinds[] = {{"arm.links=2", "peak"},
                 {"arm.links=3", "smoothed"},
                 {"arm.links=2,3", "peak and smoothed"}};
    for (int i = 0; i < 3; i++) {
        KEPT_TEXT(text) = judged(&found, LAW_HYBRID, 2, 1, 1, &kinds[i].line);
        assert_string_equal(found.overshoot_of, kinds[i].of);
        assert_non_null(strstr(text, formatted("\"overshoot_of\": \"%s\"", kinds[i].of)));
        for (int q = 0; q < ROBUST_QUANTILES; q++) {
            check_below(found.smoothed[q], found.raw[q]);
            assert_true(i == 2 ||
                        found.overshoot[q] == (i == 0 ? found.raw : found.smoothed)[q]);
        }
        for (EACH_TEXT(key, "median", "nine_tenths", "worst")) {
            assert_non_null(
                strstr(text, formatted("\"raw_overshoot_%s_percent\": ", *key)));
            assert_non_null(
                strstr(text, formatted("\"smoothed_overshoot_%s_percent\": ", *key)));
        }
        robust_law_finish(&found);
    }
    const summary two = rig_summary_with("control.law=hybrid run.duration=1");
    free(judged(&found, LAW_HYBRID, 1, 1, 1, &kinds[0].line));
    check_relative(found.smoothed[ROBUST_WORST],
                   100 * two.smoothed_over_command_N / two.force_command_N, 1e-12);
    robust_law_finish(&found);
    robust_law_finish(NULL);
    robust_set_finish(NULL);
    robust_case_finish(NULL);
}

ALL_BETWEEN(enter_folder, leave_folder)
