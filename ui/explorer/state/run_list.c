#include "ui/explorer/state/run_list.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "src/run/resume.h"

static bool same_input(const session_input *a, const session_input *b)
{
    return a->kind == b->kind && a->parameter == b->parameter && a->value == b->value &&
           (a->kind == SESSION_INPUT_START || a->time == b->time) && strcmp(a->text, b->text) == 0;
}

static bool has_input(const session_input *inputs, int count, const session_input *wanted)
{
    for (int i = 0; i < count; i++) {
        if (same_input(&inputs[i], wanted)) {
            return true;
        }
    }
    return false;
}

bool run_list_is_present(const pinned_run *p, const session *s)
{
    assert(p != NULL && s != NULL);
    bool same = p->input_count == s->input_count;
    for (int i = 0; same && i < p->input_count; i++) {
        same = same_input(&p->inputs[i], &s->inputs[i]);
    }
    return same;
}

// A change as a line of text: what it gives what, and from when on.
static void run_list_input_text(const session_input *in, char *text, size_t size)
{
    assert(in != NULL && text != NULL);
    if (in->kind == SESSION_INPUT_PUSH) {
        snprintf(text, size, "push %g at %.4g s", in->value, in->time);
        return;
    }
    const char *name = strchr(parameter_table[in->parameter].path, '.') + 1;
    if (in->kind == SESSION_INPUT_TIMED) {
        snprintf(text, size, "%s %s from %.4g s", name, in->text, in->time);
    } else {
        snprintf(text, size, "%s %s", name, in->text);
    }
}

// Appends the changes of one list that another one does not have.
static void append_others(const session_input *of, int count, const session_input *other,
                          int other_count, char *text, size_t size)
{
    bool first = true;
    for (int i = 0; i < count; i++) {
        char one[SESSION_INPUT_TEXT + 80];
        const size_t used = strlen(text);
        if (!has_input(other, other_count, &of[i]) && used < size) {
            run_list_input_text(&of[i], one, sizeof one);
            snprintf(text + used, size - used, "%s%s", first ? "" : ", ", one);
            first = false;
        }
    }
}

void run_list_differences(const pinned_run *p, const session *s, char *text, size_t size)
{
    assert(p != NULL && s != NULL && text != NULL && size > 0);
    char here[256] = "";
    text[0] = '\0';
    append_others(p->inputs, p->input_count, s->inputs, s->input_count, text, size);
    append_others(s->inputs, s->input_count, p->inputs, p->input_count, here, sizeof here);
    const size_t used = strlen(text);
    if (here[0] != '\0' && used < size) {
        snprintf(text + used, size - used, "%s(now: %s)", used > 0 ? " " : "", here);
    } else if (used == 0) {
        snprintf(text, size, "the same");
    }
}

// A name for the present run that no other of the list has.
static void propose_name(const run_list *list, const session *s, char name[RUN_NAME])
{
    char text[SESSION_INPUT_TEXT + 80] = "as opened";

    // the last change describes best what is new
    if (s->input_count > 0) {
        run_list_input_text(&s->inputs[s->input_count - 1], text, sizeof text);
    }

    // a number follows where that name is taken
    snprintf(name, RUN_NAME, "%s", text);
    for (int n = 2; n < 100; n++) {
        bool taken = false;
        for (int i = 0; i < list->count; i++) {
            taken = taken || strcmp(list->runs[i].name, name) == 0;
        }
        if (!taken) {
            return;
        }
        snprintf(name, RUN_NAME, "%s (%d)", text, n);
    }
}

status run_list_pin(run_list *list, const session *s, const char *name, fault *f)
{
    assert(list != NULL && s != NULL && name != NULL);
    pinned_run p = {.id = list->pinned + 1};

    // one of the same changes only becomes the baseline
    for (int i = 0; i < list->count; i++) {
        if (run_list_is_present(&list->runs[i], s)) {
            list->baseline = list->selected = i;
            list->runs[i].hidden = false;
            return STATUS_OK;
        }
    }
    if (list->count == PINNED_RUNS) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "%d runs are pinned already: R lists them, d there drops one",
                         PINNED_RUNS);
    }

    // the rows are shared, the changes are copied
    if (name[0] != '\0') {
        snprintf(p.name, sizeof p.name, "%s", name);
    } else {
        propose_name(list, s, p.name);
    }
    p.input_count = s->input_count;
    p.inputs = calloc((size_t)s->input_count + 1, sizeof *p.inputs);
    if (p.inputs == NULL || run_share(&s->run, s->run.trace.row_count, &p.run) != STATUS_OK) {
        free(p.inputs);
        return fault_no_memory(f);
    }
    if (s->input_count > 0) {
        memcpy(p.inputs, s->inputs, (size_t)s->input_count * sizeof *p.inputs);
    }
    list->pinned++;
    list->baseline = list->selected = list->count;
    list->runs[list->count++] = p;
    return STATUS_OK;
}

void run_list_drop(run_list *list, int index)
{
    assert(list != NULL && index >= 0 && index < list->count);
    run_finish(&list->runs[index].run);
    free(list->runs[index].inputs);
    memmove(&list->runs[index], &list->runs[index + 1],
            (size_t)(list->count - index - 1) * sizeof list->runs[0]);
    list->count--;

    // without the baseline the last one takes its place
    if (list->baseline == index) {
        list->baseline = list->count - 1;
    } else if (list->baseline > index) {
        list->baseline--;
    }
    list->selected = list->selected >= list->count ? list->count - 1 : list->selected;
    list->selected = list->selected < 0 ? 0 : list->selected;
}

void run_list_clear(run_list *list)
{
    assert(list != NULL);
    while (list->count > 0) {
        run_list_drop(list, list->count - 1);
    }
    list->baseline = -1;
}
