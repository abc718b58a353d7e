// A scenario file from its first key to its last: what each is, and in which order they
// are read.
#include <string.h>

#include "src/scenario/reader.h"
#include "src/base/words.h"
#include "src/tables/signals.h"

// Whether a control character of UTF-8 begins there.
static bool begins_control(const char *at)
{
    const unsigned char c = (unsigned char)at[0];
    return c < 0x20 || c == 0x7f || (c == 0xc2 && (unsigned char)at[1] < 0xa0);
}

// Copies prose; only the description may have several lines. NULL after a fault.
static char *parse_prose(reader *r, const tree_node *node, const char *what,
                         bool many_lines)
{
    // trailing blanks are no part of it
    const size_t length = node_text_length(node);
    if (length == 0) {
        report_node(r, node, "%s is %s, expected text", what, node_kind_name(node));
        return NULL;
    }

    // control characters are not allowed
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

// Reports a key that a file does not have at its top, with the nearest one that it may
// have.
static void report_unknown_top(reader *r, const tree_node *key)
{
    static const char *const others[] = {"title",  "description", "panes",
                                         "script", "expect",      "lesson"};
    nearest_word near = nearest_begin(key->text);

    // a parameter's whole path, which belongs under its group
    int index = parameter_find(key->text);
    if (index >= 0) {
        const char *dot = strchr(key->text, '.');
        report_node(r, key, "unknown key '%s', expected '%s:' under '%.*s:'", key->text,
                    dot + 1, (int)(dot - key->text), key->text);
        return;
    }

    // all groups, in case none is near
    char groups[256] = "";
    for (int i = 0; i < parameter_count; i++) {
        const char *path = parameter_table[i].path;
        char group[64];
        snprintf(group, sizeof group, "%.*s", (int)strcspn(path, "."), path);
        if (i == 0 || !parameter_in_group(parameter_table[i - 1].path, group)) {
            size_t used = strlen(groups);
            snprintf(groups + used, sizeof groups - used, ", %s", group);
        }

        // compared as a word of its own, kept as the beginning of its path, which lasts
        if (edit_distance(key->text, group, near.distance) < near.distance) {
            near.distance = edit_distance(key->text, group, near.distance);
            near.best = path;
        }
    }

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
                "unknown key '%.60s', expected title, description, panes%s, script, "
                "expect or lesson",
                key->text, groups);
}

// The signals that a scenario is to be looked at by.
static void reader_panes(reader *r, const tree_node *list)
{
    if (list->kind != TREE_LIST) {
        report_node(r, list,
                    "panes is %s, expected a list of signals: [force, hub_angle]",
                    node_kind_name(list));
        return;
    }

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

// Reads everything; script, expect and lesson come after the parameters that they depend
// on.
static void parse_root(reader *r, const tree_node *root)
{
    const tree_node *script = NULL, *expect = NULL, *steps = NULL;
    if (!reader_expect_map(r, root, "the file", "title: ...")) {
        return;
    }

    // each key once; what depends on parameters is kept for later
    for (const tree_node *child = root->first; child != NULL; child = child->next) {
        const char *key = reader_key(r, root, child);
        if (key == NULL) {
            continue;
        }

        if (strcmp(key, "title") == 0) {
            r->s->title = parse_prose(r, child, "title", false);
        } else if (strcmp(key, "description") == 0) {
            r->s->description = parse_prose(r, child, "description", true);
        } else if (strcmp(key, "panes") == 0) {
            reader_panes(r, child);
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

    // what depends on all parameters
    r->duration_known =
        r->given[PARAMETER_INDEX(run.duration)].line > 0 || r->faults == 0;
    reader_resolve(r);
    const place lock = r->given[PARAMETER_INDEX(control.lock)];
    if (lock.line > 0) {
        reader_check_lock(r, &r->s->parameters, lock);
    }
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

// Fills in name, file and what the file left out.
static void complete(reader *r, const char *name)
{
    scenario *s = r->s;
    const char *called = name != NULL ? name : r->path;
    s->written = s->parameters;
    for (int i = 0; i < parameter_count; i++) {
        s->lines[i] = r->given[i].line;
    }
    s->name = strdup(called);
    s->file = strdup(r->path);

    // the name stands in for a title, if it can
    bool can = strlen(called) <= SCENARIO_TITLE;
    for (const char *c = called; *c != '\0'; c++) {
        can = can && !begins_control(c);
    }
    if (s->title == NULL) {
        s->title = strdup(can ? called : "untitled");
    }
    if (s->description == NULL) {
        s->description = strdup("");
    }

    // any of the copies may have failed
    r->no_memory =
        s->name == NULL || s->file == NULL || s->title == NULL || s->description == NULL;
}

status scenario_parse(scenario *s, const char *text, size_t length, const char *path,
                      const char *name, fault_handler report, void *context)
{
    fault f;
    reader r = {.path = path, .s = s};
    *s = (scenario){0};
    parameters_defaults(&s->parameters, ARM_CORRECTED);

    tree_node *root = tree_parse(text, length, &f);
    if (root == NULL) {
        r.no_memory = f.code == STATUS_NO_MEMORY;
        reader_report_at(&r, f.line, f.column, "%s", f.text);
    } else {
        parse_root(&r, root);
        tree_free(root);
    }

    // faults are reported together, and whoever has some gets no scenario
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
