// Damaged scenario files: the reader may refuse them, with a sentence and a place, but
// never crash, and what it accepts must keep the promises of scenario.h.
#include "tests/fuzz/fuzz.h"

#include "src/run/run.h"

static void check_sentence(void *count, const char *sentence)
{
    fuzz_count_placed(count, sentence, "f");
}

static void check_value(const parameters *p, int index)
{
    const parameter_info *info = &parameter_table[index];
    double numbers[PARAMETER_LIST_MOST];
    int count = 1;
    if (info->type == PARAMETER_LIST) {
        count = parameter_list_numbers((const char *)p + info->offset, numbers);
    } else {
        numbers[0] = parameter_get(p, index);
    }

    for (int i = 0; i < count; i++) {
        FUZZ_CHECK(isfinite(numbers[i]));
        FUZZ_CHECK(!p->set[index] ||
                   (numbers[i] >= info->minimum && numbers[i] <= info->maximum));
    }
}

static void check_accepted(const scenario *s)
{
    FUZZ_CHECK(s->name && s->file && s->title && s->description);
    FUZZ_CHECK(strchr(s->title, '\n') == NULL);
    for (int i = 0; i < parameter_count; i++) {
        check_value(&s->parameters, i);
    }
    for (int i = 0; i < s->action_count; i++) {
        const action *a = &s->actions[i];
        FUZZ_CHECK(isfinite(a->value) && a->time >= 0 &&
                   a->time <= s->parameters.run.duration);
        FUZZ_CHECK(i == 0 || s->actions[i - 1].time <= a->time);
        FUZZ_CHECK(a->kind == ACTION_PUSH || parameter_table[a->parameter].timed);
    }
    for (int i = 0; i < s->expectation_count; i++) {
        const expectation *e = &s->expectations[i];
        FUZZ_CHECK(e->is_null || (isfinite(e->value) && e->tolerance >= 0));
        FUZZ_CHECK(e->line >= 1 && e->column >= 1);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    scenario s;
    int count = 0;
    // a copy of exactly this size, so that reading one byte too far is noticed
    char *text = malloc(size + (size == 0));
    FUZZ_CHECK(text != NULL);
    if (size > 0) {
        memcpy(text, data, size);
    }
    status result = scenario_parse(&s, text, size, "f", "name", check_sentence, &count);
    FUZZ_CHECK((result == STATUS_OK) == (count == 0));
    if (result == STATUS_OK) {
        check_accepted(&s);
        scenario_finish(&s);
    }
    free(text);
    return 0;
}
