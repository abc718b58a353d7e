#include "ui/explorer/state/scenario_menu.h"

#include <assert.h>
#include <glib.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/text_stream.h"
#include "src/scenario/scenario.h"
#include "ui/explorer/state/view.h"

void scenario_menu_read(scenario_menu *menu)
{
    const status code = scenario_list(&menu->names, &menu->count, NULL);
    loss_unless(code != STATUS_NO_MEMORY);
    if (code != STATUS_OK) {
        menu->count = 0;
    }
}

// Whether two neighbours are lessons in the wrong order, which is that of the numbers in
// their titles.
static bool are_swapped_lessons(const menu_text *before, const menu_text *after)
{
    return before->is_lesson && after->is_lesson &&
           strcmp(after->title, before->title) < 0;
}

// Puts the lessons, which lie side by side, in order.
static void sort_lessons(scenario_menu *menu)
{
    menu_text *texts = menu->texts;
    char **names = menu->names;
    for (int i = 1; i < menu->count; i++) {
        for (int k = i; k > 0 && are_swapped_lessons(&texts[k - 1], &texts[k]); k--) {
            const menu_text text = texts[k];
            char *const name = names[k];
            texts[k] = texts[k - 1];
            names[k] = names[k - 1];
            texts[k - 1] = text;
            names[k - 1] = name;
        }
    }
}

void scenario_menu_read_titles(scenario_menu *menu)
{
    // read once, as it opens every file
    if (menu->texts != NULL || menu->count == 0) {
        return;
    }
    menu->texts = g_new0(menu_text, menu->count);

    // a file that cannot be read has only its name; opening it says its faults
    for (int i = 0; i < menu->count; i++) {
        scenario s;
        fault f = {0};
        const status code = scenario_open(&s, menu->names[i], keep_first_fault, &f);
        if (code == STATUS_OK) {
            menu->texts[i] = (menu_text){s.title, s.lesson.step_count > 0};
            s.title = NULL;
            scenario_finish(&s);
        }
        loss_unless(code != STATUS_NO_MEMORY);
    }
    sort_lessons(menu);
}

void scenario_menu_finish(scenario_menu *menu)
{
    for (int i = 0; i < menu->count; i++) {
        free(menu->names[i]);
        if (menu->texts != NULL) {
            free(menu->texts[i].title);
        }
    }
    g_free(menu->texts);
    free(menu->names);
    *menu = (scenario_menu){0};
}

int scenario_menu_find(const scenario_menu *menu, const char *name)
{
    for (int i = 0; i < menu->count; i++) {
        if (strcmp(menu->names[i], name) == 0) {
            return i;
        }
    }
    return -1;
}

menu_text scenario_menu_text(const scenario_menu *menu, int index)
{
    assert(index >= 0 && index < menu->count);
    menu_text text = {0};
    if (menu->texts != NULL) {
        text = menu->texts[index];
    }
    if (text.title == NULL) {
        text.title = "";
    }
    return text;
}

// --- lessons ---------------------------------------------------------------------------

// A quantity of the present run, which must have come to its end; NaN if it did not
// occur.
static double quantity_of(const session *s, int quantity)
{
    if (s->computing == NULL) {
        return summary_value(&s->run.summary, quantity);
    }
    return (double)NAN;
}

bool lesson_step_is_done(const lesson_step *step, const lesson_progress *p,
                         const session *s, const run_list *pinned)
{
    // to be read or answered
    switch (step->check) {
    case LESSON_READ:
        return true;
    case LESSON_NUMBER: {
        const double truth = quantity_of(s, step->quantity);
        return p->answered && fabs(p->answer - truth) <= step->within * fabs(truth);
    }
    case LESSON_CHOICE:
        return p->answered && p->answer == step->right + 1;

    // to be done: with the cursor, a parameter or the runs
    case LESSON_CURSOR: {
        const double instant = quantity_of(s, step->quantity) + step->offset;
        return fabs(s->now - instant) <= step->within;
    }
    case LESSON_VALUE: {
        const parameters now = session_parameters_at(s, s->now);
        const double value = parameter_get(&now, step->parameter);
        return fabs(value - step->value) <= step->within * fabs(step->value);
    }
    case LESSON_PINNED:
        return run_list_of_scenario(pinned, s) >= step->pinned;
    case LESSON_RATIO: {
        if (!s->has_other) {
            return false;
        }
        const double ratio = quantity_of(s, step->quantity) /
                             summary_value(&s->other.summary, step->quantity);
        return ratio >= step->low && ratio <= step->high;
    }
    }
    return false;
}
