// Lessons: every one that ships can be gone through to its end by its own commands, no step is done
// before it is, and wrong files are reported.
#include "tests/explorer_on_screen.h"

// Goes through a lesson by its own commands.
static void go_through(explorer *ex, const char *name)
{
    const lesson *l = &ex->state.session.base.lesson;
    for (int i = 0; i < l->step_count; i++) {
        const lesson_step *step = &l->steps[i];
        if (ex->state.lesson.step != i || !ex->state.lesson.on) {
            fail_msg("%s is at step %d, expected %d", name, ex->state.lesson.step + 1, i + 1);
        }

        // asked before it is done it gives a hint and stays
        if (step->check != LESSON_READ) {
            explorer_carry_out(ex, "continue");
            if (ex->state.lesson.step != i || strlen(step->hint) < 5) {
                fail_msg("%s: step %d is done before anything is, or has no hint", name, i + 1);
            }
        }
        for (int k = 0; k < step->command_count; k++) {
            if (!explorer_carry_out(ex, step->commands[k])) {
                fail_msg("%s: step %d: '%s': %s", name, i + 1, step->commands[k],
                         ex->state.message.text);
            }
        }
        if (step->check != LESSON_READ && !ex->state.lesson.passed) {
            fail_msg("%s: step %d is not done by its own commands", name, i + 1);
        }
        explorer_carry_out(ex, "continue");
    }
    assert_false(ex->state.lesson.on);
}

// A scenario read from its own copy.
static void read_copy(const scenario *s, scenario *copy)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    assert_non_null(stream);
    scenario_write(stream, s);
    fclose(stream);
    const status code = scenario_parse(copy, text, size, "copy.yaml", NULL, fail_on_fault, NULL);
    assert_int_equal(code, STATUS_OK);
    free(text);
}

static void test_a_copy_keeps_its_lesson(void **state)
{
    (void)state;
    static const char *const names[] = {"lessons/impulse-and-force", "lessons/two-predictors",
                                        "lessons/step-size",         "lessons/beta-and-gamma",
                                        "lessons/hybrid-law",        "lessons/what-a-sensor-sees"};
    for (size_t n = 0; n < sizeof names / sizeof names[0]; n++) {
        scenario s, copy;
        fault f = {0};
        explorer ex;
        assert_int_equal(scenario_open(&s, names[n], fail_on_fault, NULL), STATUS_OK);
        read_copy(&s, &copy);
        assert_int_equal(copy.lesson.step_count, s.lesson.step_count);
        assert_int_equal(copy.lesson.parameter_count, s.lesson.parameter_count);
        for (int i = 0; i < s.lesson.step_count; i++) {
            const lesson_step *a = &s.lesson.steps[i], *b = &copy.lesson.steps[i];
            assert_string_equal(a->say, b->say);
            assert_string_equal(a->hint, b->hint);
            assert_string_equal(a->then, b->then);
            assert_int_equal(a->check, b->check);
        }

        // and can be gone through like the lesson itself
        assert_int_equal(explorer_init(&ex, &copy, HUGE_VAL, &f), STATUS_OK);
        go_through(&ex, names[n]);
        explorer_finish(&ex);
        scenario_finish(&s);
    }
}

static void test_every_lesson_can_be_gone_through(void **state)
{
    (void)state;
    char **names;
    int count, lessons = 0;
    fault f = {0};
    assert_int_equal(scenario_list(&names, &count, &f), STATUS_OK);
    for (int i = 0; i < count; i++) {
        scenario s;
        assert_int_equal(scenario_open(&s, names[i], fail_on_fault, NULL), STATUS_OK);
        const bool is_lesson = s.lesson.step_count > 0;
        scenario_finish(&s);
        if (is_lesson) {
            explorer ex;
            open_explorer(&ex, names[i]);
            go_through(&ex, names[i]);
            explorer_finish(&ex);
            lessons++;
        }
        free(names[i]);
    }
    free(names);
    assert_int_equal(lessons, 6);
}

static void test_every_step_fits_a_small_screen(void **state)
{
    (void)state;
    explorer ex;
    open_explorer(&ex, "lessons/impulse-and-force");
    const lesson *l = &ex.state.session.base.lesson;
    for (int i = 0; i < l->step_count; i++) {
        ex.state.lesson = (lesson_progress){.on = true, .step = i};
        char *text = picture(&ex, 80, 24, GLYPHS_BRAILLE);
        assert_non_null(strstr(text, "lesson, step"));
        assert_non_null(strstr(text, "energy"));
        free(text);

        // its last word is on the screen
        const char *say = l->steps[i].say, *last = strrchr(say, ' ');
        text = picture(&ex, 80, 24, GLYPHS_BRAILLE);
        assert_non_null(strstr(text, l->steps[i].choice_count == 0 ? last + 1 : say));
        free(text);
    }
    explorer_finish(&ex);
}

static void test_wrong_answers_are_not_taken(void **state)
{
    (void)state;
    explorer ex;
    open_explorer(&ex, "lessons/hybrid-law");
    press(&ex, "A1<Enter>");
    assert_false(ex.state.lesson.passed);
    assert_true(ex.state.message.warning);
    press(&ex, "A3<Enter>");
    assert_true(ex.state.lesson.passed);
    press(&ex, "y");
    press(&ex, "A3<Enter>");
    assert_false(ex.state.lesson.passed);
    press(&ex, "A1.76<Enter>");
    assert_true(ex.state.lesson.passed);

    // by name, from anywhere; and out of it
    press(&ex, ":open corrected/first-impact<Enter>");
    assert_false(ex.state.lesson.on);
    press(&ex, ":lesson step-size<Enter>");
    assert_true(ex.state.lesson.on);
    press(&ex, ":lesson off<Enter>");
    assert_false(ex.state.lesson.on);
    press(&ex, ":lesson no-such<Enter>");
    assert_true(ex.state.message.warning);
    explorer_finish(&ex);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_lesson_can_be_gone_through),
        cmocka_unit_test(test_a_copy_keeps_its_lesson),
        cmocka_unit_test(test_every_step_fits_a_small_screen),
        cmocka_unit_test(test_wrong_answers_are_not_taken),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
