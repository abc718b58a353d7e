#include "src/scenario/scenario.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/words.h"
#include "src/rig/rig.h"
#include "src/tables/settings.h"

// Frees the steps of a lesson and their texts; nothing else of a lesson is allocated.
static void finish_lesson(lesson *l)
{
    for (int i = 0; i < l->step_count * LESSON_TEXTS; i++) {
        free(l->steps[i / LESSON_TEXTS].texts[i % LESSON_TEXTS]);
    }
    free(l->steps);
    *l = (lesson){0};
}

void scenario_finish(scenario *s)
{
    free(s->name);
    free(s->file);
    free(s->title);
    free(s->description);
    free(s->written);
    free(s->actions);
    free(s->expectations);
    finish_lesson(&s->lesson);
    free(s->fit);
    *s = (scenario){0};
}

void keep_first_fault(void *context, const char *sentence)
{
    fault *f = context;
    if (f->code == STATUS_OK) {
        fault_set(f, STATUS_BAD_SCENARIO, "%s", sentence);
    }
}

// A copy of `size` bytes on the heap, or NULL if there is no original. Sets *good to
// false without memory.
static void *copy_of(const void *original, size_t size, bool *good)
{
    void *copy = original != NULL ? malloc(size + 1) : NULL;
    if (copy != NULL) {
        memcpy(copy, original, size);
    }
    *good = *good && (original == NULL || copy != NULL);
    return copy;
}

static char *text_of(const char *text, bool *good)
{
    return copy_of(text, text != NULL ? strlen(text) + 1 : 0, good);
}

status scenario_copy(scenario *copy, const scenario *s)
{
    const lesson *l = &s->lesson;
    bool good = true;
    *copy = *s;

    // every pointer is replaced, even after a failure: none may remain the original's
    copy->name = text_of(s->name, &good);
    copy->file = text_of(s->file, &good);
    copy->title = text_of(s->title, &good);
    copy->description = text_of(s->description, &good);
    copy->fit = copy_of(s->fit, sizeof *s->fit, &good);
    copy->written = copy_of(s->written, sizeof *s->written, &good);
    copy->actions =
        copy_of(s->actions, (size_t)s->action_count * sizeof *s->actions, &good);
    copy->expectations =
        copy_of(s->expectations, (size_t)s->expectation_count * sizeof *s->expectations,
                &good);

    // the lesson's steps, and the texts of each
    copy->lesson.steps =
        copy_of(l->steps, (size_t)l->step_count * sizeof *l->steps, &good);
    if (copy->lesson.steps != NULL) {
        copy->lesson.step_count = l->step_count;
    } else {
        copy->lesson.step_count = 0;
    }
    for (int i = 0; i < copy->lesson.step_count * LESSON_TEXTS; i++) {
        char **text = &copy->lesson.steps[i / LESSON_TEXTS].texts[i % LESSON_TEXTS];
        *text = text_of(*text, &good);
    }

    // an incomplete copy is discarded
    if (!good) {
        scenario_finish(copy);
        return STATUS_NO_MEMORY;
    }
    return STATUS_OK;
}

// Carries out one assignment, PATH=VALUE, on a set of parameters. The sentence in f lacks
// the assignment itself, which the caller puts before it.
static status assign(parameters *p, const char *assignment, fault *f)
{
    // PATH ends at the first equals sign
    char path[128], room[PARAMETER_TEXT_SIZE];
    const char *value;
    size_t length = strcspn(assignment, "=");
    FAULT_IF(assignment[length] == '\0' || length == 0 || length >= sizeof path, f,
             STATUS_BAD_ARGUMENT,
             "not an assignment, expected PATH=VALUE such as arm.k2=49.2");

    // the parameter and its value; a single setting has its value written into `room`
    snprintf(path, sizeof path, "%.*s", (int)length, assignment);
    value = assignment + length + 1;
    const int index = settings_look_up_value(path, &value, room, f);
    if (index < 0) {
        return STATUS_BAD_ARGUMENT;
    }
    return parameter_set_text(p, index, value, f);
}

status scenario_resolve(scenario *s, fault *f)
{
    // the parameters, and the locks and timing that the script sets
    parameters *p = &s->parameters;
    TRY(parameters_resolve(p, f));
    TRY(scenario_check_locks(s, controller_of(p->control.law), f));
    TRY(scenario_check_timing(s, f));

    // every parameter that the script sets may change in this run; pushes need the
    // corrected model
    const action *push = NULL;
    for (int i = 0; i < s->action_count; i++) {
        const action *a = &s->actions[i];
        if (a->kind == ACTION_SET) {
            TRY(parameter_may_change(p, a->parameter, f));
        }
        if (push == NULL && a->kind == ACTION_PUSH) {
            push = a;
        }
    }
    FAULT_IF(push != NULL && p->arm.model == ARM_PRINTED, f, STATUS_BAD_SCENARIO,
             "the printed model takes no pushes, but the script has one at %g s",
             push->time);
    return STATUS_OK;
}

status scenario_take_parameters(scenario *s, const parameters *changed, fault *f)
{
    const parameters before = s->parameters;
    s->parameters = *changed;
    const status failed = scenario_resolve(s, f);
    if (failed != STATUS_OK) {
        s->parameters = before;
    }
    return failed;
}

status scenario_with(const scenario *base, const parameter_change *changes, size_t count,
                     scenario *changed, fault *f)
{
    *changed = *base;
    parameters *p = &changed->parameters;
    for (const parameter_change *c = changes; c < changes + count; c++) {
        if (c->text != NULL) {
            TRY(parameter_set_text(p, c->parameter, c->text, f));
        } else {
            TRY(parameter_set_number(p, c->parameter, c->number, f));
        }
    }
    return scenario_resolve(changed, f);
}

// Applies all assignments at once: each is read, then all are resolved together. If that
// fails, nothing is changed.
static status override_together(scenario *s, char *const *assignments, int count,
                                fault *f)
{
    parameters p = s->parameters;
    for (int i = 0; i < count; i++) {
        TRY(assign(&p, assignments[i], f));
    }
    if (count > 0) {
        return scenario_take_parameters(s, &p, f);
    }
    return STATUS_OK;
}

status scenario_override(scenario *s, const char *assignment, fault *f)
{
    fault inner;
    char *const one = (char *)assignment;
    const status result = override_together(s, &one, 1, &inner);
    if (result != STATUS_OK && f != NULL) {
        fault_set_at(f, result, inner.path, "--set %.200s: %.700s", assignment,
                     inner.text);
        make_printable(f->text, 0);
    }
    return result;
}

// Applies the assignments one after the other. Returns how many failed; `report`, which
// may be NULL, gets a sentence for each.
static int override_each(scenario *s, char *const *assignments, int count,
                         fault_handler report, void *context)
{
    int failures = 0;
    for (int i = 0; i < count; i++) {
        fault f = {0};
        if (scenario_override(s, assignments[i], &f) != STATUS_OK) {
            if (failures++ == 0) {
                s->refused = (fault_place){.path = f.path};
            }
            if (report != NULL) {
                report(context, f.text);
            }
        }
    }
    return failures;
}

// Whether assignments set both control.settings as a whole and a single setting,
// control.settings.NAME: what they mean together would depend on their order.
static bool sets_settings_twice(char *const *assignments, int count)
{
    static const char path[] = "control.settings";
    bool whole = false, one = false;
    for (int i = 0; i < count; i++) {
        const char *behind = assignments[i] + sizeof path - 1;
        if (strncmp(assignments[i], path, sizeof path - 1) == 0) {
            whole = whole || *behind == '=';
            one = one || *behind == '.';
        }
    }
    return whole && one;
}

status scenario_override_all(scenario *s, char *const *assignments, int count,
                             fault_handler report, void *context)
{
    assert(count >= 0);

    // what contradicts itself
    if (sets_settings_twice(assignments, count)) {
        s->refused = (fault_place){.path = setting_info.path};
        if (report != NULL) {
            report(context,
                   "control.settings and control.settings.NAME are set together, "
                   "expected the text of all or the path of each");
        }
        return STATUS_BAD_ARGUMENT;
    }

    // nearly always all can be applied together
    if (override_together(s, assignments, count, NULL) == STATUS_OK) {
        return STATUS_OK;
    }

    // something is wrong. To find which assignments, they are applied one by one, again
    // as long as fewer of them fail than before; those that still fail are reported
    int failures_before, failures = count + 1;
    do {
        failures_before = failures;
        failures = override_each(s, assignments, count, NULL, NULL);
    } while (failures > 0 && failures < failures_before);
    if (failures == 0 || override_each(s, assignments, count, report, context) == 0) {
        return STATUS_OK;
    }
    return STATUS_BAD_ARGUMENT;
}
