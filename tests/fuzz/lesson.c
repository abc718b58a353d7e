// Lessons of scenario files: what is read keeps the promises of lesson.h and reads back
// from its own copy; now and then it is gone through in the lab, by its own commands,
// with wrong answers before.
#include "tests/fuzz/fuzz_lab.h"

#include "src/tables/summary.h"

enum { PLAYED_OF = 8, MOST_STEPS = 12 };

static void check_step(const lesson_step *s)
{
    FUZZ_CHECK(s->say != NULL && s->say[0] != '\0' && s->then != NULL && s->hint != NULL);
    FUZZ_CHECK(s->check >= LESSON_READ && s->check <= LESSON_RATIO);
    FUZZ_CHECK(s->quantity >= 0 && s->quantity < summary_count);
    FUZZ_CHECK(s->parameter >= 0 && s->parameter < parameter_count);
    FUZZ_CHECK(isfinite(s->within) && s->within >= 0 && isfinite(s->offset) &&
               isfinite(s->value));
    FUZZ_CHECK(s->check != LESSON_RATIO || s->low <= s->high);
    FUZZ_CHECK(s->check != LESSON_CHOICE ||
               (s->right >= 0 && s->right < s->choice_count));
    FUZZ_CHECK(s->check != LESSON_PINNED ||
               (s->pinned >= 1 && s->pinned <= LESSON_PINNED_RUNS));
    FUZZ_CHECK(s->command_count >= 0 && s->command_count <= LESSON_COMMANDS);
}

static void check_lesson(const lesson *l)
{
    FUZZ_CHECK(l->parameter_count >= 0 && l->parameter_count <= LESSON_PARAMETERS);
    for (int i = 0; i < l->parameter_count; i++) {
        FUZZ_CHECK(l->parameters[i] >= 0 && l->parameters[i] < parameter_count);
    }
    for (int i = 0; i < l->step_count; i++) {
        check_step(&l->steps[i]);
    }
}

// What a scenario writes is read, and written the same again.
static void check_copy(const scenario *s)
{
    scenario copy;
    char *text = fuzz_written(s);
    fuzz_scenario(&copy, text);
    char *again = fuzz_written(&copy);
    FUZZ_CHECK(strcmp(text, again) == 0);
    FUZZ_CHECK(copy.lesson.step_count == s->lesson.step_count);
    scenario_finish(&copy);
    free(again);
    free(text);
}

// Whether a line may be carried out here: one that writes no file, asks for no consent
// and takes no minutes.
static bool is_harmless(const char *line)
{
    static const char *const words[] = {"set",  "seek", "pin",  "branch",
                                        "law",  "lock", "open", "answer",
                                        "undo", "redo", "touch"};
    const size_t length = strcspn(line, " ");
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        if (strlen(words[i]) == length && strncmp(words[i], line, length) == 0) {
            return strstr(line, "duration") == NULL && strstr(line, "links") == NULL;
        }
    }
    return strcmp(line, "continue") == 0;
}

// Goes through it: asks too early, answers wrongly, then does what the file says; the
// screen is drawn after each.
static void play(const scenario *s)
{
    static const char *const before[] = {"continue", "answer 0", "answer 1e9",
                                         "answer x"};
    explorer ex;
    scenario own;
    screen shown = {0};
    fault f = {0};
    FUZZ_CHECK(scenario_copy(&own, s) == STATUS_OK);
    if (!fuzz_done(explorer_init(&ex, &own, HUGE_VAL, &f), &f)) {
        return;
    }
    ex.view.size = (screen_size){100, 30};

    const int steps =
        s->lesson.step_count < MOST_STEPS ? s->lesson.step_count : MOST_STEPS;
    for (int i = 0; i < steps && !ex.input.quit; i++) {
        const lesson_step *step = &s->lesson.steps[i];
        const int early = (int)(sizeof before / sizeof before[0]);
        for (int k = 0; k < early + step->command_count && !ex.input.quit; k++) {
            const char *line = k < early ? before[k] : step->commands[k - early];
            if (is_harmless(line)) {
                explorer_carry_out(&ex, line);
            }
        }
        fuzz_draw(&ex, &shown);
        explorer_carry_out(&ex, "continue");
    }
    screen_finish(&shown);
    explorer_finish(&ex);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static int inputs;
    scenario s;
    int reported = 0;
    char *text = fuzz_text(data, size);
    const status code =
        scenario_parse(&s, text, size, "f", "name", fuzz_count, &reported);
    FUZZ_CHECK((code == STATUS_OK) == (reported == 0));
    if (code == STATUS_OK) {
        check_lesson(&s.lesson);
        check_copy(&s);
        // long ones take too long
        const bool quick = s.parameters.run.duration <= 2 && s.parameters.arm.links <= 4;
        if (s.lesson.step_count > 0 && quick && inputs++ % PLAYED_OF == 0) {
            play(&s);
        }
        scenario_finish(&s);
    }
    free(text);
    return 0;
}
