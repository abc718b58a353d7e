#include "src/run/run_columns.h"

#include <stdlib.h>
#include <string.h>

#include "src/base/words.h"
#include "src/tables/features.h"

enum { ANGLE_NAME = 24, COLUMN_NAME = 64 };

// The features that the scenario has from the start or that its script gives it.
static feature_set features_in_time(const scenario *s)
{
    feature_set features = features_of(&s->parameters);
    for (int i = 0; i < s->action_count; i++) {
        const parameters then = scenario_parameters_at(s, s->actions[i].time);
        features |= features_of(&then);
    }
    return features;
}

// Whether a run with these features has values of a signal.
static bool has_signal(feature_set features, int signal)
{
    const feature_set needs = signal_table[signal].needs;
    return needs == 0 || (needs & features) != 0;
}

int run_angle_count(const scenario *s)
{
    const arm_parameters *a = &s->parameters.arm;
    return a->links + (a->hub_joint != HUB_RIGID || a->model == ARM_PRINTED);
}

// How many columns of angles there are: one for each body of a longer arm.
static int angle_columns(const scenario *s)
{
    if (s->parameters.arm.links <= 2) {
        return 0;
    }
    return run_angle_count(s);
}

// Fills in all columns of the scenario; there is room for them.
static void add_all(run_columns *c, feature_set features, int angles)
{
    // the signals
    for (int i = 0; i < signal_count; i++) {
        if (has_signal(features, i)) {
            const signal_info *info = &signal_table[i];
            c->all[c->count++] = (run_column){info->name, info->unit, i, -1};
        }
    }

    // the angles, counted from 1
    for (int i = 0; i < angles; i++) {
        char *name = c->names + i * ANGLE_NAME;
        snprintf(name, ANGLE_NAME, "angle_%d", i + 1);
        c->all[c->count++] = (run_column){name, "rad", -1, i};
    }
}

// The column of that name among the first `count`; -1 if there is none.
static int find_column(const run_column *columns, int count, const char *name)
{
    return name_find(columns, sizeof *columns, count, name);
}

// Says why a name is that of no column.
static status no_column(const run_columns *c, const char *name, fault *f)
{
    // a signal, but none of this run
    FAULT_IF(signal_find(name) >= 0, f, STATUS_BAD_ARGUMENT,
             "the run has no values of '%s': nothing in the scenario gives it any", name);

    char hint[HINT_TEXT];
    const char *near = name_nearest(c->all, sizeof *c->all, c->count, name);
    return fault_set(f, STATUS_BAD_ARGUMENT, "there is no column '%s'%s", name,
                     did_you_mean(hint, near,
                                  ", expected names of recorded signals such as "
                                  "time,force, with commas between them"));
}

// Adds the column that the first `length` characters of `text` name to those that are
// chosen.
static status choose_column(const run_columns *c, const char *text, size_t length,
                            run_columns *chosen, fault *f)
{
    // the name without blanks around it
    while (length > 0 && *text == ' ') {
        text++;
        length--;
    }
    while (length > 0 && text[length - 1] == ' ') {
        length--;
    }
    char name[COLUMN_NAME];
    snprintf(name, sizeof name, "%.*s", (int)length, text);
    FAULT_IF(length == 0, f, STATUS_BAD_ARGUMENT,
             "a name is missing, expected names of recorded signals such as time,force, "
             "with commas between them");

    // the column, once
    const int found = find_column(c->all, c->count, name);
    if (found < 0) {
        return no_column(c, name, f);
    }
    FAULT_IF(find_column(chosen->all, chosen->count, name) >= 0, f, STATUS_BAD_ARGUMENT,
             "the column '%s' is there twice", name);
    chosen->all[chosen->count++] = c->all[found];
    return STATUS_OK;
}

// Keeps the columns that a text names, in its order.
static status choose(run_columns *c, const char *text, fault *f)
{
    SCOPED(free_kept) run_column *own = calloc((size_t)c->count, sizeof *own);
    run_columns chosen = {.all = own};
    if (own == NULL) {
        return fault_no_memory(f);
    }

    // name after name
    size_t length = strcspn(text, ",");
    TRY(choose_column(c, text, length, &chosen, f));
    while (text[length] == ',') {
        text += length + 1;
        length = strcspn(text, ",");
        TRY(choose_column(c, text, length, &chosen, f));
    }

    memcpy(c->all, own, (size_t)chosen.count * sizeof *own);
    c->count = chosen.count;
    return STATUS_OK;
}

status run_columns_init(run_columns *c, const scenario *s, const char *chosen, fault *f)
{
    // room for all
    const int angles = angle_columns(s);
    *c = (run_columns){.count = 0};
    c->all = calloc((size_t)signal_count + (size_t)angles, sizeof *c->all);
    c->names = calloc((size_t)angles + 1, ANGLE_NAME);
    if (c->all == NULL || c->names == NULL) {
        return fault_no_memory(f);
    }

    add_all(c, features_in_time(s), angles);
    if (chosen == NULL) {
        return STATUS_OK;
    }
    return choose(c, chosen, f);
}

void run_columns_finish(run_columns *c)
{
    free(c->all);
    free(c->names);
    *c = (run_columns){.count = 0};
}
