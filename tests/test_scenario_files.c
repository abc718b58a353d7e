// Scenarios as files: found by name, listed, changed by --set, and written so that they
// can be read back.
#include "tests/scenario_fixture.h"

#include "src/run/run.h"

// ---- files ----------------------------------------------------------------------------

// A folder of scenarios.
static int make_folder(void **state)
{
    static const char *const files[][2] = {{"beta.yaml", "title: Beta\n"},
                                           {"deep/alpha-10.yaml", "title: Ten\n"},
                                           {"deep/alpha-9.yaml", "title: Nine\n"},
                                           {"deep/notes.txt", "not a scenario\n"},
                                           {"deep/n", "nor is this\n"},
                                           {".hidden.yaml", "title: Hidden\n"}};
    if (enter_folder(state) != 0 || mkdir("deep", 0700) != 0) {
        return -1;
    }
    for (EACH(file, files)) {
        put_file((*file)[0], (*file)[1]);
    }
    return 0;
}

// Scenarios are looked for in these folders; what they were looked for in before.
static char *look_in(const char *folders)
{
    const char *before = getenv("IMPACTLAB_SCENARIOS");
    char *kept = strdup(before != NULL ? before : "");
    setenv("IMPACTLAB_SCENARIOS", folders, 1);
    return kept;
}

static void look_back(char **before)
{
    setenv("IMPACTLAB_SCENARIOS", *before, 1);
    free(*before);
}

// The same until the block is left.
#define LOOKING_IN(folders)                                                              \
    SCOPED(look_back) char *before __attribute__((unused)) = look_in(folders)

// Opens with the folder of this test as the scenario folder.
static status open_here(scenario *s, const char *name, sentences *all)
{
    LOOKING_IN(test_folder);
    *all = (sentences){0};
    return scenario_open(s, name, keep_sentence, all);
}

TEST_BETWEEN(scenarios_open_by_name_and_by_file, make_folder, leave_folder)
{
    KEPT_SCENARIO(s);
    sentences all;
    const char *path = formatted("%s/deep/alpha-9.yaml", test_folder);
    assert_int_equal(open_here(&s, "deep/alpha-9", &all), STATUS_OK);
    assert_string_equal(s.name, "deep/alpha-9");
    assert_string_equal(s.title, "Nine");
    assert_string_equal(s.file, path);
    scenario_finish(&s);
    assert_int_equal(open_here(&s, path, &all), STATUS_OK);
    assert_string_equal(s.name, path);
    scenario_finish(&s);
    assert_int_equal(open_here(&s, formatted("%s/deep/alpha-10", test_folder), &all),
                     STATUS_OK);
    assert_string_equal(s.title, "Ten");
}

TEST_BETWEEN(an_unknown_name_suggests_the_nearest, make_folder, leave_folder)
{
    static const char *const cases[][2] = {{"deep/alpha-8",
                                            "did you mean 'deep/alpha-9'?"},
                                           {"alpha-10", "did you mean 'deep/alpha-10'?"},
                                           {"alpha-9.yaml",
                                            "did you mean 'deep/alpha-9'?"},
                                           {"zzzzzzzzzz", "impactlab list"},
                                           {"../etc/passwd", ""},
                                           {"", ""}};
    for (EACH(c, cases)) {
        scenario s;
        sentences all;
        assert_int_equal(open_here(&s, (*c)[0], &all), STATUS_BAD_ARGUMENT);
        assert_int_equal(all.count, 1);
        assert_non_null(strstr(all.text, (*c)[1]));
    }
}

TEST_BETWEEN(files_that_cannot_be_read, make_folder, leave_folder)
{
    const struct {
        const char *path, *says;
        status code;
    } cases[] = {{"/nonexistent/x.yaml", "cannot be opened (No such file",
                  STATUS_CANNOT_READ},
                 {test_folder, "it is a folder", STATUS_CANNOT_READ},
                 // one that opens and gives nothing
                 {"/proc/self/mem", "cannot be read (Input/output error)",
                  STATUS_CANNOT_READ}};
    scenario s;
    for (EACH(c, cases)) {
        sentences all = {0};
        assert_int_equal(scenario_read(&s, c->path, NULL, keep_sentence, &all), c->code);
        assert_non_null(strstr(all.text, formatted("%s:1:1: %s", c->path, c->says)));
    }
    sentences all;
    assert_int_equal(open_here(&s, test_folder, &all), STATUS_CANNOT_READ);
    assert_int_equal(all.count, 1);

    // what need have no end
    all = (sentences){0};
    assert_int_equal(scenario_read(&s, "/dev/zero", NULL, keep_sentence, &all),
                     STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(all.text, "'/dev/zero' is a device or a pipe"));
}

// A link to a folder above would be listed for ever.
TEST_BETWEEN(links_in_a_circle_end, make_folder, leave_folder)
{
    char **names;
    int count, found = 0;
    assert_int_equal(symlink("..", formatted("%s/deep/again", test_folder)), 0);
    LOOKING_IN(test_folder);
    DONE(scenario_list(&names, &count, &f));
    for (int i = 0; i < count; i++) {
        found += strstr(names[i], "alpha-9") != NULL;
    }
    free_names(names, count);
    assert_in_range(found, 2, 10);
}

TEST_BETWEEN(the_list_is_complete_and_sorted, make_folder, leave_folder)
{
    char **names;
    int count;
    LOOKING_IN(test_folder);
    DONE(scenario_list(&names, &count, &f));
    const char *const own[] = {"beta", "deep/alpha-9", "deep/alpha-10"};
    int found = 0, shipped = 0;
    for (int i = 0; i < count; i++) {
        found += found < 3 && strcmp(names[i], own[found]) == 0;
        shipped += strcmp(names[i], "corrected/first-impact") == 0;
    }
    assert_int_equal(found, 3);
    assert_int_equal(shipped, 1);
    free_names(names, count);
    setenv("IMPACTLAB_SCENARIOS", "/nonexistent", 1);
    REFUSED(STATUS_CANNOT_READ, "/nonexistent: no such folder",
            scenario_list(&names, &count, &f));
    assert_int_equal(count, 0);
    assert_null(names);

    // every caller that opens the scenario gets it, too
    scenario s;
    sentences all = {0};
    assert_int_equal(scenario_open(&s, "corrected/first-impact", keep_sentence, &all),
                     STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(all.text, "/nonexistent: no such folder"));
}

// However many folders are named, the last one counts too.
TEST_BETWEEN(every_folder_is_looked_into, make_folder, leave_folder)
{
    enum { FOLDERS = 100 };
    const char *all = "";
    for (int i = 1; i < FOLDERS; i++) {
        all = formatted("%s%s/deep:", all, test_folder);
    }
    LOOKING_IN(formatted("%s:%s::", all, test_folder)); // one without a name is none

    // listed once each, and opened
    char **names;
    int count, found = 0;
    DONE(scenario_list(&names, &count, &f));
    for (int i = 0; i < count; i++) {
        found += strcmp(names[i], "beta") == 0 || strcmp(names[i], "alpha-9") == 0;
    }
    free_names(names, count);
    assert_int_equal(found, 2);
    KEPT_SCENARIO(s);
    assert_int_equal(scenario_open(&s, "deep/alpha-9", NULL, NULL), STATUS_OK);
}

TEST(every_shipped_scenario_reads_clean)
{
    char **names;
    int count, thesis = 0;
    DONE(scenario_list(&names, &count, &f));
    for (int i = 0; i < count; i++) {
        KEPT_SCENARIO(s);
        sentences all = {0};
        fail_if(scenario_open(&s, names[i], keep_sentence, &all) != STATUS_OK ||
                    all.count != 0,
                "%s", all.text);
        // a title of its own, a description, and the thesis's figures on the thesis's
        // model
        assert_string_not_equal(s.title, names[i]);
        assert_in_range(strlen(s.title), 8, 72);
        assert_true(strlen(s.description) > 20);
        bool of_thesis = strncmp(names[i], "thesis/", 7) == 0;
        thesis += of_thesis;
        // (what the thesis measured comes from the rig, on whatever arm it is; lessons
        // are about both)
        if (s.parameters.control.law == LAW_NONE && s.lesson.step_count == 0) {
            assert_int_equal(s.parameters.arm.model,
                             of_thesis ? ARM_PRINTED : ARM_CORRECTED);
        }
    }
    free_names(names, count);
    assert_in_range(thesis, 14, 1000);
    assert_in_range(count - thesis, 10, 1000);
}

TEST(every_figure_and_table_of_the_thesis_has_its_scenario)
{
    for (int i = 1; i <= 14; i++) {
        KEPT_SCENARIO(s);
        sentences all = {0};
        const char *name = formatted(i <= 11 ? "thesis/fig-3-%d" : "thesis/table-4-%d",
                                     i <= 11 ? i : i - 11);
        assert_int_equal(scenario_open(&s, name, keep_sentence, &all), STATUS_OK);
        bool coarse = i >= 6 && i <= 8, fast = i >= 9 && i <= 11;
        check_close(s.parameters.method.step, coarse ? 0.01 : 0.001, 0);
        check_close(s.parameters.motor.voltage, fast ? 5 : 1, 0);
        check_close(s.parameters.method.beta, 0.4, 0);
        check_close(s.parameters.method.gamma, 0.5, 0);
        check_close(s.parameters.wall.angle, 0.1, 0);
        double factor = i == 12 ? 100 : i == 13 ? 10 : 1;
        check_relative(s.parameters.arm.k2, 4.92 * factor, 1e-12);
    }
}

// ---- --set ----------------------------------------------------------------------------

TEST(an_override_sets_and_resolves)
{
    KEPT_SCENARIO(s) = good("arm: {k2: 5}\n");
    DONE(scenario_override(&s, "arm.k2=49.2 N m/rad", &f));
    check_close(s.parameters.arm.k2, 49.2, 0);
    DONE(scenario_override(&s, "arm.model=printed", &f));
    assert_int_equal(s.parameters.arm.hub_joint, HUB_SPRING);
    check_close(s.parameters.arm.link_inertia, 1.67e-5, 0);
}

// The assignment is refused with a sentence that says `what`, and nothing changes.
static void check_override(const char *text, const char *assignment, const char *what)
{
    KEPT_SCENARIO(s) = good(text);
    parameters before = s.parameters;
    fault f = {0};
    assert_int_not_equal(scenario_override(&s, assignment, &f), STATUS_OK);
    assert_int_not_equal(f.code, STATUS_OK);
    const char *beginning = formatted("--set %s: ", assignment);
    fail_if(strncmp(f.text, beginning, strlen(beginning)) != 0 ||
                strstr(f.text, what) == NULL,
            "'%s' does not begin with '%s' and say '%s'", f.text, beginning, what);
    assert_memory_equal(&s.parameters, &before, sizeof before);
}

TEST(a_wrong_override_changes_nothing)
{
    check_override("{}", "arm.k2", "PATH=VALUE");
    check_override("{}", "=3", "PATH=VALUE");
    check_override("{}", "", "PATH=VALUE");
    check_override("{}", "arm.k22=3", "did you mean 'arm.k2'?");
    check_override("{}", "completely.unknown=3", "'show' lists");
    check_override("{}", "arm.k2=stiff", "not a number");
    check_override("{}", "arm.k2=", "no value");
    check_override("{}", "arm.k2=-1", "out of range");
    check_override("{}", "arm.k2=1=2", "expected N m/rad");
    check_override("arm: {links: 5}", "arm.model=printed", "two links");
    check_override("script: [{at: 0.5, push: 1}]", "arm.model=printed", "push");
    check_override("script: [{at: 0.5, push: 1}, {at: 0.6, push: 1}]",
                   "arm.model=printed", "0.5 s");
    check_override("arm: {hub_joint: spring}\n"
                   "script: [{at: 0.1, set: {arm.k1: 90}}, {at: 0.2, set: {arm.k2: 5}}]",
                   "arm.hub_joint=beam", "arm.k1");

    // nor does a whole set of parameters that contradict one another
    KEPT_SCENARIO(s) = good("{}");
    parameters wrong = s.parameters, before = s.parameters;
    DONE(parameter_set_text(&wrong, PARAMETER_INDEX(wall.angle), "-2", &f));
    REFUSED(STATUS_BAD_SCENARIO, "", scenario_take_parameters(&s, &wrong, &f));
    assert_memory_equal(&s.parameters, &before, sizeof before);
}

TEST(an_endless_override_is_refused)
{
    KEPT_SCENARIO(s) = good("{}");
    fault f;
    char *text = repeated('a', 4999);
    assert_int_equal(scenario_override(&s, text, &f), STATUS_BAD_ARGUMENT);
    memcpy(text, "arm.k2=", 7);
    assert_int_not_equal(scenario_override(&s, text, &f), STATUS_OK);
    assert_int_not_equal(scenario_override(&s, text, NULL), STATUS_OK);
}

// ---- writing --------------------------------------------------------------------------

// Everything but the expectations comes back from what scenario_write writes.
static void check_written(const scenario *s)
{
    SCOPED(free_kept) WRITTEN(text, scenario_write(stream, s));
    KEPT_SCENARIO(back) = good(text);
    assert_string_equal(back.title, s->title);
    assert_string_equal(back.description, s->description);
    assert_int_equal(back.action_count, s->action_count);
    for (int i = 0; i < s->action_count; i++) {
        const action *a = &s->actions[i], *b = &back.actions[i];
        assert_true(a->time == b->time && a->kind == b->kind && a->value == b->value);
        assert_true(a->kind == ACTION_PUSH || a->parameter == b->parameter);
    }
    for (int i = 0; i < parameter_count; i++) {
        char one[PARAMETER_VALUE_SIZE], other[PARAMETER_VALUE_SIZE];
        parameter_format(&s->parameters, i, one, sizeof one);
        parameter_format(&back.parameters, i, other, sizeof other);
        assert_string_equal(one, other);
        assert_int_equal(s->parameters.set[i], back.parameters.set[i]);
    }
}

TEST(written_scenarios_read_back)
{
    char **names;
    int count;
    assert_int_equal(scenario_list(&names, &count, NULL), STATUS_OK);
    for (int i = 0; i < count; i++) {
        KEPT_SCENARIO(s);
        assert_int_equal(scenario_open(&s, names[i], NULL, NULL), STATUS_OK);
        check_written(&s);
    }
    free_names(names, count);
    KEPT_SCENARIO(odd) =
        good("title: '\"a\\b\" # no comment: {'\ndescription: \"one\\ntwo\\t'\"\n"
             "control: {plugin: \"a b: 'c'\"}\n"
             "script: [{at: 0.1 s, push: -0.02 N s}, {at: 0.2, set: {wall.restitution: "
             "0.5}}]\n");
    check_written(&odd);
}

// The file that a scenario would be written as, to be freed.
static char *file_of(const scenario *s)
{
    WRITTEN(text, scenario_write(stream, s));
    return text;
}

// What YAML takes for the end of a line within a text comes back as it was.
TEST(other_line_ends_read_back)
{
    KEPT_SCENARIO(s) = good("title: \"a \\L b\\P c\\\"f\"\n");
    assert_string_equal(s.title, "a \xe2\x80\xa8 b\xe2\x80\xa9 c\"f");
    KEPT_TEXT(file) = file_of(&s);
    KEPT_SCENARIO(again) = good(file);
    assert_string_equal(again.title, s.title);
}

// What is no text in UTF-8, such as a name of a file, leaves a file that can be read.
TEST(broken_texts_read_back)
{
    KEPT_SCENARIO(s) = good("title: a\n");
    DONE(parameter_set_text(&s.parameters, parameter_find("control.plugin"), "a\xff.so",
                            &f));
    KEPT_TEXT(file) = file_of(&s);
    KEPT_SCENARIO(again) = good(file);
    assert_string_equal(again.parameters.control.plugin, "a?.so");
}

// However long the title is and however much was changed, the file can be read, and tells
// of it.
TEST(changed_scenarios_read_back)
{
    for (int length = 1; length <= SCENARIO_TITLE; length++) {
        KEPT_SCENARIO(s) = good(formatted("title: %s\n", repeated('t', length)));
        for (int i = 0; i < parameter_count; i++) {
            // what goes together is no matter here: each is tried by itself
            parameters p = s.parameters;
            const double at = parameter_get(&p, i), most = parameter_table[i].maximum;
            if (parameter_table[i].type == PARAMETER_REAL && at != 0 &&
                parameter_set_number(&p, i, at < most / 2 ? at * 1.0123456789 : at / 1.1,
                                     NULL) == STATUS_OK) {
                scenario_take_parameters(&s, &p, NULL);
            }
            if (i != 0 && i != 20 && i != parameter_count - 1) {
                continue;
            }

            // with no change, some, and all of them
            KEPT_TEXT(text) = file_of(&s);
            KEPT_SCENARIO(back) = good(text);
            assert_memory_equal(back.title, s.title, strlen(s.title));
            char changes[SCENARIO_CHANGES];
            const bool told = strlen(back.title) > strlen(s.title);
            const bool any = scenario_changes(&s, changes)[0] != '\0';
            assert_true(told == any || (any && length > SCENARIO_TITLE - 20));
        }
    }
}

// A lesson with every check, with and without what may be left out, is read back as it
// was.
TEST(written_lessons_read_back)
{
    KEPT_SCENARIO(s) =
        good("title: t\n"
             "lesson:\n"
             "  parameters: [arm.k2]\n"
             "  steps:\n"
             "  - {say: \"with a bell\\a, and\\ttab\", hint: h, do: [seek 0, answer 1]}\n"
             "  - {say: b, number: {quantity: peak_force_N, within: 0.5}, then: right}\n"
             "  - {say: c, choice: {of: [x, y], right: 2}}\n"
             "  - {say: d, cursor: {at: first_contact_s, offset: 0.1, within: 0.01}}\n"
             "  - {say: e, value: {arm.k2: 5}}\n"
             "  - {say: f, pinned: 3}\n"
             "  - {say: g, ratio: {quantity: peak_force_N, from: 0.5, to: 2}}\n");
    KEPT_TEXT(first) = file_of(&s);
    KEPT_SCENARIO(back) = good(first);
    KEPT_TEXT(second) = file_of(&back);
    assert_string_equal(second, first);
    assert_int_equal(back.lesson.step_count, 7);
    for (int i = 0; i < 7; i++) {
        const lesson_step *a = &s.lesson.steps[i], *b = &back.lesson.steps[i];
        assert_int_equal(a->check, b->check);
        assert_int_equal(a->command_count, b->command_count);
        assert_string_equal(a->hint, b->hint);
        assert_string_equal(a->then, b->then);
    }
    assert_int_equal(back.lesson.steps[2].right, 1);
    check_close(back.lesson.steps[6].high, 2, 0);

    // a control character does not leave the program
    assert_string_equal(back.lesson.steps[0].say, "with a bell , and tab");
}

TEST(a_copy_shares_nothing_with_the_original)
{
    char **names;
    int count;
    DONE(scenario_list(&names, &count, &f));
    for (int i = 0; i < count; i++) {
        scenario s;
        KEPT_SCENARIO(copy);
        assert_int_equal(scenario_open(&s, names[i], NULL, NULL), STATUS_OK);
        KEPT_TEXT(before) = file_of(&s);
        const int expected = s.expectation_count;

        // the copy outlives it, and is freed by itself
        assert_int_equal(scenario_copy(&copy, &s), STATUS_OK);
        scenario_finish(&s);
        KEPT_TEXT(after) = file_of(&copy);
        assert_string_equal(after, before);
        assert_int_equal(copy.expectation_count, expected);
    }
    free_names(names, count);
}
