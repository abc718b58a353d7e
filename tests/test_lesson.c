// Lessons: every one that ships can be gone through to its end by its own commands, no
// step is done before it is, and wrong files are reported.
#include "tests/explorer_on_screen.h"

// Goes through a lesson by its own commands.
static void go_through(explorer *ex, const char *name)
{
    const lesson *l = &ex->model.session.base.lesson;
    for (int i = 0; i < l->step_count; i++) {
        const lesson_step *step = &l->steps[i];
        fail_if(ex->model.lesson.step != i || !ex->model.lesson.on,
                "%s is at step %d, expected %d", name, ex->model.lesson.step + 1, i + 1);

        // asked before it is done it gives a hint and stays
        if (step->check != LESSON_READ) {
            explorer_carry_out(ex, "continue");
            fail_if(ex->model.lesson.step != i || strlen(step->hint) < 5,
                    "%s: step %d is done before anything is, or has no hint", name,
                    i + 1);
        }
        for (int k = 0; k < step->command_count; k++) {
            fail_if(!explorer_carry_out(ex, step->commands[k]), "%s: step %d: '%s': %s",
                    name, i + 1, step->commands[k], ex->input.message.text);
        }
        fail_if(step->check != LESSON_READ && !ex->model.lesson.passed,
                "%s: step %d is not done by its own commands", name, i + 1);
        explorer_carry_out(ex, "continue");
    }
    assert_false(ex->model.lesson.on);
}

TEST(test_a_copy_keeps_its_lesson)
{
    for (EACH_TEXT(c, "lessons/impulse-and-force", "lessons/two-predictors",
                   "lessons/step-size", "lessons/beta-and-gamma", "lessons/hybrid-law",
                   "lessons/what-a-sensor-sees")) {
        KEPT_SCENARIO(s) = shipped(*c);
        scenario copy = read_again(&s);
        SCOPED(explorer_finish) explorer ex;
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
        DONE(explorer_init(&ex, &copy, HUGE_VAL, &f));
        go_through(&ex, *c);
    }
}

TEST(test_every_lesson_can_be_gone_through)
{
    char **names;
    int count, lessons = 0;
    DONE(scenario_list(&names, &count, &f));
    for (int i = 0; i < count; i++) {
        KEPT_SCENARIO(s) = shipped(names[i]);
        if (s.lesson.step_count > 0) {
            OPEN_EXPLORER(ex, names[i]);
            go_through(&ex, names[i]);
            lessons++;
        }
    }
    free_names(names, count);
    assert_int_equal(lessons, 6);
}

TEST(test_every_step_fits_a_small_screen)
{
    OPEN_EXPLORER(ex, "lessons/impulse-and-force");
    const lesson *l = &ex.model.session.base.lesson;
    for (int i = 0; i < l->step_count; i++) {
        ex.model.lesson = (lesson_progress){.on = true, .step = i};
        assert_shows_at(&ex, 80, 24, "lesson, step");
        assert_shows_at(&ex, 80, 24, "touching now");

        // its last word is on the screen
        const char *say = l->steps[i].say, *last = strrchr(say, ' ');
        assert_shows_at(&ex, 80, 24, l->steps[i].choice_count == 0 ? last + 1 : say);
    }
}

// What a step names is on a screen of 80 x 24: when it is asked, or once it is done.
TEST(test_what_a_step_names_is_on_the_screen)
{
    static const struct {
        const char *lesson;
        int step; // from 1
        bool done;
        const char *shown;
    } named[] = {
        {"impulse-and-force", 1, false, "\u25c6"}, // the diamond
        {"impulse-and-force", 2, false, "impact at 0.293"},
        {"impulse-and-force", 2, false, "0.04426"},
        {"impulse-and-force", 3, true, "force 1.337"},
        {"impulse-and-force", 4, true, "as opened"},
        {"impulse-and-force", 5, false, "voltage"},
        {"two-predictors", 1, true, "energy 1.48 N"},
        {"two-predictors", 2, false, "energy 1.48 N"},
        {"two-predictors", 3, true, "touched: 1.34 N"},
        {"two-predictors", 3, true, "linearised 1.34 N"},
        {"two-predictors", 5, false, "k2"},
        {"step-size", 1, true, "force"},
        {"step-size", 2, false, "step"},
        {"step-size", 2, true, "as opened"},
        {"beta-and-gamma", 1, false, "force 0"},
        {"beta-and-gamma", 1, false, "resid"},
        {"beta-and-gamma", 1, true, "as opened"},
        {"beta-and-gamma", 3, false, "beta"},
        {"beta-and-gamma", 3, true, "ledger"},
        {"hybrid-law", 1, true, "hybrid: force"},
        {"hybrid-law", 2, false, "force 0.999"},
        {"hybrid-law", 3, false, "transition_time"},
        {"hybrid-law", 4, false, "transition_time"},
        {"what-a-sensor-sees", 1, true, "fsr"},
        {"what-a-sensor-sees", 1, true, "force"},
        {"what-a-sensor-sees", 3, false, "fsr_rise_time"},
        {"what-a-sensor-sees", 5, false, "fsr_rise_time"},
    };
    for (EACH(c, named)) {
        OPEN_EXPLORER(ex, formatted("lessons/%s", c->lesson));
        const lesson *l = &ex.model.session.base.lesson;
        for (int i = 0; i < c->step - !c->done; i++) {
            for (int k = 0; k < l->steps[i].command_count; k++) {
                assert_true(explorer_carry_out(&ex, l->steps[i].commands[k]));
            }
            if (i < c->step - 1) {
                press(&ex, "y");
            }
        }
        assert_shows_at(&ex, 80, 24, c->shown);
    }
}

// Two keys open the first lesson of the list, which goes by number.
TEST(test_the_list_of_lessons_opens_the_first)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":lesson<Enter>");
    KEPT_TEXT(text) = picture(&ex, 80, 24, GLYPHS_BRAILLE);
    const char *at = text;
    for (int i = 1; i <= 6; i++) {
        at = strstr(at, formatted("Lesson %d", i));
        assert_non_null(at);
    }
    press_opens(&ex, "<Enter>", "lessons/impulse-and-force");
}

TEST(test_wrong_answers_are_not_taken)
{
    OPEN_EXPLORER(ex, "lessons/hybrid-law");
    press_warns(&ex, "A1<Enter>", "");
    assert_false(ex.model.lesson.passed);
    press(&ex, "A3<Enter>");
    assert_true(ex.model.lesson.passed);
    press(&ex, "yA3<Enter>");
    assert_false(ex.model.lesson.passed);
    press(&ex, "A1.76<Enter>");
    assert_true(ex.model.lesson.passed);

    // by name, from anywhere; and out of it
    press(&ex, ":open corrected/first-impact<Enter>");
    assert_false(ex.model.lesson.on);
    press(&ex, ":lesson step-size<Enter>");
    assert_true(ex.model.lesson.on);
    press(&ex, ":lesson off<Enter>");
    assert_false(ex.model.lesson.on);
    press_warns(&ex, ":lesson no-such<Enter>", "");
}
