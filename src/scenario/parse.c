// A scenario file from its first key to its last: what each is, and in which order they
// are read.
#include <stdlib.h>
#include <string.h>

#include "src/scenario/reader.h"
#include "src/base/words.h"
#include "src/tables/signals.h"

// Whether a control character begins at a byte of a text in UTF-8: C0, DEL, or C1, which
// is 0xc2 and a byte below 0xa0.
static bool begins_control(const char *at)
{
    const unsigned char c = (unsigned char)at[0];
    return c < 0x20 || c == 0x7f || (c == 0xc2 && (unsigned char)at[1] < 0xa0);
}

// How many lines a text of prose may have.
typedef enum prose_lines { ONE_LINE, MANY_LINES } prose_lines;

// Copies a text of prose without blanks at its end. A text of one line has at most
// SCENARIO_TITLE bytes. NULL after a fault.
static char *parse_prose(reader *r, const tree_node *node, const char *what,
                         prose_lines lines)
{
    // trailing blanks are no part of it
    const size_t length = node_text_length(node);
    if (length == 0) {
        report_node(r, node, "%s is %s, expected text", what, node_kind_name(node));
        return NULL;
    }

    // control characters are not allowed, but line ends and tabs in many lines are
    const bool many_lines = lines == MANY_LINES;
    for (size_t i = 0; i < length; i++) {
        const char c = node->text[i];
        if (begins_control(node->text + i) && !(many_lines && (c == '\n' || c == '\t'))) {
            report_node(r, node, "%s holds %s, expected %s", what,
                        c == '\n' ? "several lines" : "a control character",
                        many_lines ? "text" : "one line of text");
            return NULL;
        }
    }

    // a title fits on a line
    if (!many_lines && length > SCENARIO_TITLE) {
        report_node(r, node, "%s has %zu bytes, expected at most %d", what, length,
                    SCENARIO_TITLE);
        return NULL;
    }

    char *copy = strndup(node->text, length);
    reader_have_memory(r, copy);
    return copy;
}

// Reports a key that no scenario file has at its top level, with the nearest one that it
// may have there.
static void report_unknown_top(reader *r, const tree_node *key)
{
    static const char *const others[] = {"title",  "description", "panes", "script",
                                         "expect", "lesson",      "fit"};
    nearest_word near = nearest_begin(key->text);

    // the whole path of a parameter, which a file has as a key under its group
    int index = parameter_find(key->text);
    if (index >= 0) {
        const char *dot = strchr(key->text, '.');
        report_node(r, key, "unknown key '%s', expected '%s:' under '%.*s:'", key->text,
                    dot + 1, (int)(dot - key->text), key->text);
        return;
    }

    // the groups of parameters: a list of all, and the nearest
    char groups[256] = "";
    for (int i = 0; i < parameter_count; i++) {
        const char *path = parameter_table[i].path;
        char group[64];
        snprintf(group, sizeof group, "%.*s", (int)strcspn(path, "."), path);
        if (i == 0 || !parameter_in_group(parameter_table[i - 1].path, group)) {
            size_t used = strlen(groups);
            snprintf(groups + used, sizeof groups - used, ", %s", group);
        }

        // the nearest is kept as the path it begins, as `group` does not last
        if (edit_distance(key->text, group, near.distance) < near.distance) {
            near.distance = edit_distance(key->text, group, near.distance);
            near.best = path;
        }
    }

    // the other keys
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        nearest_try(&near, others[i]);
    }

    // the nearest word, or all there are
    if (near.best != NULL) {
        report_node(r, key, "unknown key '%.60s', did you mean '%.*s'?", key->text,
                    (int)strcspn(near.best, "."), near.best);
        return;
    }
    report_node(r, key,
                "unknown key '%.60s', expected title, description, panes%s, fit, "
                "script, expect or lesson",
                key->text, groups);
}

// Reads the list of signals that the panes of a scenario show.
static void reader_panes(reader *r, const tree_node *list)
{
    if (list->kind != TREE_LIST) {
        report_node(r, list,
                    "panes is %s, expected a list of signals: [force, hub_angle]",
                    node_kind_name(list));
        return;
    }

    // each is a known signal, and there is a pane for it
    for (const tree_node *child = list->first; child != NULL; child = child->next) {
        const int signal = node_is_scalar(child) ? signal_find(child->text) : -1;
        if (signal < 0) {
            report_node(r, child, "panes: there is no signal '%.60s'",
                        node_is_scalar(child) ? child->text : node_kind_name(child));
        } else if (r->s->pane_count == SCENARIO_PANES) {
            report_node(r, child, "panes: more than %d signals", SCENARIO_PANES);
            return;
        } else {
            r->s->panes[r->s->pane_count++] = signal;
        }
    }
}

// Reads a whole file. Script, expectations and lesson are read last, as they depend on
// the parameters.
static void parse_root(reader *r, const tree_node *root)
{
    const tree_node *script = NULL, *expect = NULL, *steps = NULL;
    if (!reader_expect_map(r, root, "the file", "title: ...")) {
        return;
    }

    // every key of the top level; what depends on parameters is put aside
    for (const tree_node *child = root->first; child != NULL; child = child->next) {
        const char *key = reader_key(r, root, child);
        if (key == NULL) {
            continue;
        }

        if (strcmp(key, "title") == 0) {
            r->s->title = parse_prose(r, child, "title", ONE_LINE);
        } else if (strcmp(key, "description") == 0) {
            r->s->description = parse_prose(r, child, "description", MANY_LINES);
        } else if (strcmp(key, "panes") == 0) {
            reader_panes(r, child);
        } else if (strcmp(key, "fit") == 0) {
            reader_fit(r, child);
        } else if (strcmp(key, "script") == 0) {
            script = child;
        } else if (strcmp(key, "expect") == 0) {
            expect = child;
        } else if (strcmp(key, "lesson") == 0) {
            steps = child;
        } else if (reader_is_group(key)) {
            reader_group(r, child, key);
        } else {
            report_unknown_top(r, child->key);
        }
    }

    // all parameters together, and whether the lock is a mode of the law
    r->duration_known =
        r->given[PARAMETER_INDEX(run.duration)].line > 0 || r->faults == 0;
    reader_resolve(r);
    const place lock = r->given[PARAMETER_INDEX(control.lock)];
    if (lock.line > 0) {
        reader_check_lock(r, &r->s->parameters, lock);
    }

    // what depends on them
    if (script != NULL) {
        fault f;
        reader_script(r, script);
        if (scenario_check_timing(r->s, &f) != STATUS_OK) {
            reader_report_at(r, script->line, script->column, "%s", f.text);
        }
    }
    if (expect != NULL) {
        reader_expectations(r, expect);
    }
    if (steps != NULL) {
        reader_lesson(r, steps);
    }
}

// Fills in the scenario's name and file, what the file gives of each parameter, and empty
// texts for what the file left out.
static void complete(reader *r, const char *name)
{
    scenario *s = r->s;
    const char *scenario_name = name != NULL ? name : r->path;
    s->written = malloc(sizeof *s->written);
    if (s->written != NULL) {
        s->written->values = s->parameters;
        for (int i = 0; i < parameter_count; i++) {
            s->written->lines[i] = r->given[i].line;
        }
    }
    s->name = strdup(scenario_name);
    s->file = strdup(r->path);

    // without a title the name is the title, if it is one line that is short enough
    bool suits_title = strlen(scenario_name) <= SCENARIO_TITLE;
    for (const char *c = scenario_name; *c != '\0'; c++) {
        suits_title = suits_title && !begins_control(c);
    }
    if (s->title == NULL) {
        s->title = strdup(suits_title ? scenario_name : "untitled");
    }
    if (s->description == NULL) {
        s->description = strdup("");
    }

    // any of the copies may have failed
    r->no_memory = s->name == NULL || s->file == NULL || s->title == NULL ||
                   s->description == NULL || s->written == NULL;
}

status scenario_parse(scenario *s, const char *text, size_t length, const char *path,
                      const char *name, fault_handler report, void *context)
{
    fault f;
    reader r = {.path = path, .s = s};
    *s = (scenario){0};
    parameters_defaults(&s->parameters, ARM_CORRECTED);

    // the tree of keys and values, then what they mean
    tree_node *root = tree_parse(text, length, &f);
    if (root == NULL) {
        r.no_memory = f.code == STATUS_NO_MEMORY;
        reader_report_at(&r, f.line, f.column, "%s", f.text);
    } else {
        parse_root(&r, root);
        tree_free(root);
    }

    // all faults are reported together; a file with faults gives no scenario
    if (r.faults == 0 && !r.no_memory) {
        complete(&r, name);
    }
    reader_report_all(&r, report, context);
    if (r.no_memory || r.faults > 0) {
        scenario_finish(s);
        s->refused = r.refused;
        if (r.no_memory) {
            return STATUS_NO_MEMORY;
        }
        return STATUS_BAD_SCENARIO;
    }
    return STATUS_OK;
}
