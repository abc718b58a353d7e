#include "ui/explorer/state/scenario_menu.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/text_stream.h"
#include "src/scenario/scenario.h"
#include "ui/explorer/state/view.h"

void scenario_menu_read(scenario_menu *menu)
{
    const status code = scenario_list(&menu->names, &menu->count, NULL);
    if (code != STATUS_OK) {
        menu->count = 0;
    }
    menu->shown = calloc((size_t)menu->count + 1, sizeof *menu->shown);
    loss_unless(code != STATUS_NO_MEMORY && menu->shown != NULL);
}

// Puts the lessons, which lie side by side, in the order of the numbers in their titles.
static void sort_lessons(scenario_menu *menu)
{
    for (int i = 1; i < menu->count; i++) {
        for (int k = i;
             k > 0 && menu->texts[k].is_lesson && menu->texts[k - 1].is_lesson &&
             strcmp(menu->texts[k].title, menu->texts[k - 1].title) < 0;
             k--) {
            const menu_text text = menu->texts[k];
            char *const name = menu->names[k];
            menu->texts[k] = menu->texts[k - 1];
            menu->names[k] = menu->names[k - 1];
            menu->texts[k - 1] = text;
            menu->names[k - 1] = name;
        }
    }
}

void scenario_menu_read_titles(scenario_menu *menu)
{
    // read once, as it opens every file
    if (menu->texts != NULL || menu->count == 0) {
        return;
    }
    menu->texts = calloc((size_t)menu->count, sizeof *menu->texts);
    loss_unless(menu->texts != NULL);
    if (menu->texts == NULL) {
        return;
    }

    // a file that cannot be read has only its name; opening it tells its faults
    for (int i = 0; i < menu->count; i++) {
        scenario s;
        fault f = {0};
        const status code = scenario_open(&s, menu->names[i], keep_first_fault, &f);
        if (code == STATUS_OK) {
            menu->texts[i] = (menu_text){s.title, s.description, s.lesson.step_count > 0};
            s.title = s.description = NULL;
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
        free(menu->texts != NULL ? menu->texts[i].title : NULL);
        free(menu->texts != NULL ? menu->texts[i].description : NULL);
    }
    free(menu->texts);
    free(menu->names);
    free(menu->shown);
    *menu = (scenario_menu){0};
}

int scenario_menu_find(const scenario_menu *menu, const char *name)
{
    int at = -1;
    for (int i = 0; i < menu->count; i++) {
        if (strcmp(menu->names[i], name) == 0) {
            at = i;
        }
    }
    return at;
}

menu_text scenario_menu_text(const scenario_menu *menu, int index)
{
    assert(index >= 0 && index < menu->count);
    menu_text text = menu->texts != NULL ? menu->texts[index] : (menu_text){0};
    if (text.title == NULL) {
        text.title = "";
    }
    if (text.description == NULL) {
        text.description = "";
    }
    return text;
}

int scenario_menu_lines(const scenario_menu *menu, int *selected)
{
    int count = 0;
    *selected = -1;
    for (int i = 0; i < menu->count && menu->shown != NULL; i++) {
        char text[1024];
        snprintf(text, sizeof text, "%s %s", menu->names[i],
                 scenario_menu_text(menu, i).title);
        if (filter_passes(menu->filter, text)) {
            if (i == menu->selected) {
                *selected = count;
            }
            menu->shown[count++] = i;
        }
    }
    return count;
}

void scenario_menu_move(scenario_menu *menu, int lines)
{
    int at;
    const int count = scenario_menu_lines(menu, &at);
    if (count == 0) {
        menu->selected = 0;
        return;
    }

    // from the selected line if the filter lets it pass, within the list
    int to = 0;
    if (at >= 0) {
        to = at + lines;
    }
    if (to > count - 1) {
        to = count - 1;
    } else if (to < 0) {
        to = 0;
    }
    menu->selected = menu->shown[to];
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
        const double other =
            s->has_other ? summary_value(&s->other.summary, step->quantity) : (double)NAN;
        const double ratio = quantity_of(s, step->quantity) / other;
        return ratio >= step->low && ratio <= step->high;
    }
    }
    return false;
}
