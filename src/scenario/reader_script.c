// The script of a scenario file: changes and pushes at their times.
#include <stdlib.h>
#include <string.h>

#include "src/base/words.h"
#include "src/scenario/reader.h"
#include "src/tables/settings.h"
#include "src/tables/summary.h"

// Adds an action to the scenario's script, in the order of time.
static void add_action(reader *r, action a)
{
    scenario *s = r->s;
    action *grown = realloc(s->actions, (size_t)(s->action_count + 1) * sizeof *grown);
    if (!reader_have_memory(r, grown)) {
        return;
    }
    s->actions = grown;
    scenario_insert_action(s, a);
}

// The index of the parameter that a key of `set` names; -1 after a fault. *text is the
// value in the file, and becomes the text to be given to that parameter: for a single
// setting,
// ".NAME=VALUE" in `room`.
static int find_timed_parameter(reader *r, const tree_node *key, const char **text,
                                char room[PARAMETER_TEXT_SIZE])
{
    fault f;
    int index = settings_look_up_value(key->text, text, room, &f);
    if (index < 0) {
        report_node(r, key, "%s", f.text);
    } else if (!parameter_table[index].timed) {
        report_node(r, key,
                    "%s cannot change during a run, expected it at the top of the file",
                    key->text);
        index = -1;
    }
    return index;
}

// Parses `set`, a map of parameters and values, and adds an action for each. Without a
// valid time (`timed` is false) the values are only checked.
static void parse_set(reader *r, const tree_node *map, bool timed, double time)
{
    if (!reader_expect_map(r, map, "set", "motor.voltage: 2 V")) {
        return;
    }

    // each parameter by itself, so that one fault does not hide the next
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        const char *path = reader_key(r, map, child);

        // the parameter and its value
        char room[PARAMETER_TEXT_SIZE];
        const char *text =
            node_is_scalar(child) && child->text != NULL ? child->text : "";
        const int index =
            path != NULL ? find_timed_parameter(r, child->key, &text, room) : -1;
        if (index < 0 || reader_value_text(r, child, path) == NULL) {
            continue;
        }

        // a copy of the parameters checks and converts the value
        fault f;
        parameters scratch = r->s->parameters;
        if (parameter_may_change(&scratch, index, &f) != STATUS_OK ||
            parameter_set_text(&scratch, index, text, &f) != STATUS_OK) {
            report_node(r, child, "%s", f.text);
        } else if (timed) {
            // it is in force from its time on
            action a = action_of(time, &scratch, index, text);
            a.line = child->line;
            if (index == PARAMETER_INDEX(control.lock)) {
                reader_check_lock(r, &scratch, (place){child->line, child->column});
            }
            add_action(r, a);
        }
    }
}

// Parses `push`, an impulse, and adds an action for it. Without a valid time (`timed` is
// false) it is only checked.
static void parse_push(reader *r, const tree_node *node, bool timed, double time)
{
    double impulse;
    if (r->s->parameters.arm.model == ARM_PRINTED) {
        report_node(r, node->key,
                    "push: the printed model takes no pushes, expected 'set' or "
                    "arm.model = corrected");
    }
    if (reader_quantity(r, node, "push", "N s", &impulse) && timed) {
        add_action(r, (action){.time = time,
                               .kind = ACTION_PUSH,
                               .parameter = -1,
                               .value = impulse});
    }
}

// Parses the instant of an action and checks it against the run's duration.
static bool parse_time(reader *r, const tree_node *node, double *time)
{
    const double duration = r->s->parameters.run.duration;
    if (!reader_quantity(r, node, "at", "s", time)) {
        return false;
    }
    if (*time < 0 || (r->duration_known && *time > duration)) {
        return report_node(
            r, node, "at = %g s is outside the run, expected 0 to %g s (run.duration)",
            *time, duration);
    }
    return true;
}

// Finds the nodes of an action's time (`at`) and of its effect (`set` or `push`). A node
// that is missing stays NULL.
static void find_action_parts(reader *r, const tree_node *map, const tree_node **at,
                              const tree_node **effect)
{
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        const char *key = reader_key(r, map, child);
        if (key == NULL) {
            continue;
        }

        // one time, and one of set and push
        if (strcmp(key, "at") == 0) {
            *at = child;
        } else if (strcmp(key, "set") != 0 && strcmp(key, "push") != 0) {
            static const char *const words[] = {"at", "set", "push"};
            const char *near = name_nearest(words, sizeof *words, 3, key);
            char hint[HINT_TEXT];
            report_node(r, child->key, "unknown key '%.60s' in an action%s", key,
                        did_you_mean(hint, near, ", expected at, set or push"));
        } else if (*effect != NULL) {
            report_node(r, child->key,
                        "'%s' after '%s' in one action, expected one of them (begin a "
                        "new '- at:')",
                        key, (*effect)->key->text);
        } else {
            *effect = child;
        }
    }
}

// Parses one action of the script: its time, and `set` or `push`.
static void parse_action(reader *r, const tree_node *map)
{
    const tree_node *at = NULL, *effect = NULL;
    double time = 0;
    if (!reader_expect_map(r, map, "an action", "at: 0.4 s")) {
        return;
    }

    // both parts are needed; after a fault of a key, which explains what is missing,
    // nothing more is reported
    int faults = r->faults;
    find_action_parts(r, map, &at, &effect);
    if (at == NULL && r->faults == faults) {
        report_node(r, map, "an action without a time, expected 'at: 0.4 s'");
    }
    if (effect == NULL && r->faults == faults) {
        report_node(r, map, "an action that does nothing, expected 'set:' or 'push:'");
    }

    // its effect is checked even without a valid time
    bool timed = at != NULL && parse_time(r, at, &time);
    if (effect != NULL && strcmp(effect->key->text, "set") == 0) {
        parse_set(r, effect, timed, time);
    } else if (effect != NULL) {
        parse_push(r, effect, timed, time);
    }
}

void reader_script(reader *r, const tree_node *list)
{
    if (list->kind != TREE_LIST) {
        report_node(r, list, "script is %s, expected a list of actions '- at: ...'",
                    node_kind_name(list));
        return;
    }
    for (const tree_node *child = list->first; child != NULL; child = child->next) {
        parse_action(r, child);
    }
}

// --- expectations ----------------------------------------------------------------------

// The index of a quantity of the summary that is the same on every machine; -1 after a
// fault.
static int parse_quantity(reader *r, const tree_node *key)
{
    int index = summary_find(key->text);
    if (index >= 0 && !summary_table[index].timing) {
        return index;
    }

    // a time of computing, or no quantity of the summary
    if (index >= 0) {
        report_node(r, key, "%s depends on the computer, expected a quantity of the arm",
                    key->text);
    } else {
        char hint[HINT_TEXT];
        report_node(r, key, "unknown quantity '%.60s'%s", key->text,
                    did_you_mean(hint, summary_suggest(key->text),
                                 ", expected a key of 'run --json'"));
    }
    return -1;
}

// Parses {value: ..., tolerance: ...}; false after a fault.
static bool parse_value_and_tolerance(reader *r, const tree_node *map, expectation *e)
{
    const char *quantity = summary_table[e->quantity].key;
    const tree_node *value = NULL, *tolerance = NULL;
    const int faults = r->faults;
    if (map->kind != TREE_MAP) {
        return report_node(r, map,
                           "%s is %s, expected {value: ..., tolerance: ...} or null",
                           quantity, node_kind_name(map));
    }

    // its two keys, which it must have
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        const char *key = reader_key(r, map, child);
        if (key == NULL) {
            continue;
        }
        if (strcmp(key, "value") == 0) {
            value = child;
        } else if (strcmp(key, "tolerance") == 0) {
            tolerance = child;
        } else {
            report_node(r, child->key,
                        "unknown key '%.60s' in %s, expected value and tolerance", key,
                        quantity);
        }
    }

    // either may be missing
    if (value == NULL || tolerance == NULL) {
        report_node(r, map, "%s has no %s, expected {value: ..., tolerance: ...}",
                    quantity, value == NULL ? "value" : "tolerance");
    }

    // their numbers
    if (value != NULL) {
        reader_quantity(r, value, "value", "", &e->value);
    }
    if (tolerance != NULL &&
        reader_quantity(r, tolerance, "tolerance", "", &e->tolerance) &&
        e->tolerance < 0) {
        report_node(r, tolerance, "tolerance = %g is negative, expected 0 or more",
                    e->tolerance);
    }

    return r->faults == faults;
}

void reader_expectations(reader *r, const tree_node *map)
{
    scenario *s = r->s;
    int most = 0;
    if (!reader_expect_map(r, map, "expect", "impacts: {value: 3, tolerance: 0}")) {
        return;
    }

    // memory for an expectation for every key
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        most++;
    }
    s->expectations = calloc((size_t)most + 1, sizeof *s->expectations);
    if (!reader_have_memory(r, s->expectations)) {
        return;
    }

    // each is null, or a value with a tolerance
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        const char *key = reader_key(r, map, child);
        int quantity = key != NULL ? parse_quantity(r, child->key) : -1;
        if (quantity < 0) {
            continue;
        }

        expectation e = {.quantity = quantity,
                         .line = child->key->line,
                         .column = child->key->column};
        e.is_null = node_is_scalar(child) && child->plain &&
                    (strcmp(child->text, "null") == 0 || strcmp(child->text, "~") == 0);
        if (e.is_null || parse_value_and_tolerance(r, child, &e)) {
            s->expectations[s->expectation_count++] = e;
        }
    }
}
