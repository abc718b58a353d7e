// Faults of a scenario file with their places, and what its nodes hold.
#include "src/scenario/reader.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/base/words.h"
#include "src/rig/rig.h"
#include "src/tables/settings.h"

bool reader_report_at(reader *r, int line, int column, const char *format, ...)
{
    assert(line > 0 && column > 0);
    char what[1280];
    found_fault found = {{line, column}, r->about, r->faults, NULL};
    va_list args;
    va_start(args, format);
    decimal_vprint(what, sizeof what, format, args);
    va_end(args);

    // the list has the place of each fault, so that they can be sorted
    found_fault *grown = realloc(r->found, (size_t)(r->faults + 1) * sizeof *grown);
    if (grown != NULL) {
        r->found = grown;
    }
    if (grown == NULL ||
        asprintf(&found.sentence, "%s:%d:%d: %s", r->path, line, column, what) < 0) {
        r->no_memory = true;
        return false;
    }
    make_printable(found.sentence, 0);
    r->found[r->faults++] = found;
    return false;
}

// Orders faults by their place in the file, and those of one place in the order found.
static int compare_places(const void *a, const void *b)
{
    const found_fault *x = a, *y = b;
    int order = (x->at.line > y->at.line) - (x->at.line < y->at.line);
    if (!order) {
        order = (x->at.column > y->at.column) - (x->at.column < y->at.column);
    }
    if (order) {
        return order;
    }
    return (x->number > y->number) - (x->number < y->number);
}

void reader_report_all(reader *r, fault_handler report, void *context)
{
    if (r->faults > 0) {
        qsort(r->found, (size_t)r->faults, sizeof *r->found, compare_places);
        const found_fault *first = &r->found[0];
        r->refused = (fault_place){first->at.line, first->at.column, first->about};
    }
    for (int i = 0; i < r->faults; i++) {
        report(context, r->found[i].sentence);
        free(r->found[i].sentence);
    }
    free(r->found);
    r->found = NULL;

    // faults for which there was no memory are reported as that
    if (r->no_memory) {
        report(context, status_text(STATUS_NO_MEMORY));
    }
}

bool reader_have_memory(reader *r, const void *memory)
{
    r->no_memory = r->no_memory || memory == NULL;
    return memory != NULL;
}

bool node_is_scalar(const tree_node *node)
{
    return node->kind == TREE_SCALAR;
}

bool node_is_empty(const tree_node *node)
{
    return node_is_scalar(node) && node->plain && node->text[0] == '\0';
}

size_t node_text_length(const tree_node *node)
{
    size_t length = node_is_scalar(node) ? strlen(node->text) : 0;
    while (length > 0 && strchr(" \t\r\n", node->text[length - 1]) != NULL) {
        length--;
    }
    return length;
}

const char *node_kind_name(const tree_node *node)
{
    static const char *const names[] = {"a single value", "a list", "a map of keys"};
    const bool blank = node_is_scalar(node) && node_text_length(node) == 0;
    if (blank) {
        return "empty";
    }
    return names[node->kind];
}

const char *reader_key(reader *r, const tree_node *map, const tree_node *child)
{
    const tree_node *key = child->key;
    if (!node_is_scalar(key)) {
        report_node(r, key, "the key is %s, expected a word", node_kind_name(key));
        return NULL;
    }

    // YAML allows a key twice, and would keep the last
    for (const tree_node *other = map->first; other != child; other = other->next) {
        if (node_is_scalar(other->key) && strcmp(other->key->text, key->text) == 0) {
            report_node(r, key,
                        "'%.60s' is there twice, expected it once (first at line %d)",
                        key->text, other->key->line);
            return NULL;
        }
    }
    return key->text;
}

bool reader_expect_map(reader *r, const tree_node *node, const char *what,
                       const char *example)
{
    return node->kind == TREE_MAP ||
           report_node(r, node, "%s is %s, expected keys such as '%s'", what,
                       node_kind_name(node), example);
}

bool reader_quantity(reader *r, const tree_node *node, const char *what, const char *unit,
                     double *value)
{
    // a number
    const char *rest, *space = unit[0] != '\0' ? " in " : "";
    if (!node_is_scalar(node) || node_is_empty(node)) {
        return report_node(r, node, "%s is %s, expected a number%s%s", what,
                           node_kind_name(node), space, unit);
    }
    if (!decimal_read(node->text, value, &rest)) {
        return report_node(r, node,
                           "%s = '%.60s' is not a finite number, expected a number%s%s",
                           what, node->text, space, unit);
    }

    // with its unit or without, and finite
    if (*rest != '\0' && strcmp(rest, unit) != 0) {
        return report_node(r, node, "%s = '%.60s' carries '%.20s', expected %s", what,
                           node->text, rest,
                           unit[0] != '\0' ? unit : "a number without a unit");
    }
    if (!isfinite(*value)) {
        return report_node(r, node, "%s = '%.60s' is too large, expected a finite number",
                           what, node->text);
    }
    return true;
}

// --- parameters ------------------------------------------------------------------------

bool parameter_in_group(const char *path, const char *group)
{
    size_t length = strlen(group);
    return strncmp(path, group, length) == 0 && path[length] == '.';
}

bool reader_is_group(const char *word)
{
    for (int i = 0; i < parameter_count; i++) {
        if (parameter_in_group(parameter_table[i].path, word)) {
            return true;
        }
    }
    return false;
}

// Reports a key that its group does not have, with the group that has it, or else with
// the nearest key of its own group.
static void report_unknown_parameter(reader *r, const tree_node *key, const char *group)
{
    const char *elsewhere = parameter_suggest(key->text);
    if (elsewhere != NULL && strcmp(strchr(elsewhere, '.') + 1, key->text) == 0) {
        report_node(r, key, "unknown key '%.60s' in %s, did you mean %s?", key->text,
                    group, elsewhere);
        return;
    }

    // misspelt: the nearest of the group's keys, or all of them
    nearest_word near = nearest_begin(key->text);
    char known[640] = "";
    for (int i = 0; i < parameter_count; i++) {
        const char *path = parameter_table[i].path;
        if (parameter_in_group(path, group)) {
            size_t used = strlen(known);
            const char *tail = path + strlen(group) + 1;
            snprintf(known + used, sizeof known - used, "%s%s", used ? ", " : "", tail);
            nearest_try(&near, tail);
        }
    }
    if (near.best != NULL) {
        report_node(r, key, "unknown key '%.60s' in %s, did you mean '%s'?", key->text,
                    group, near.best);
    } else {
        report_node(r, key, "unknown key '%.60s' in %s, expected one of %s", key->text,
                    group, known);
    }
}

const char *reader_value_text(reader *r, const tree_node *node, const char *path)
{
    if (!node_is_scalar(node) || node_is_empty(node)) {
        report_node(r, node, "%s is %s, expected a value", path, node_kind_name(node));
        return NULL;
    }
    return node->text;
}

// The text of a parameter's list: the numbers of a YAML list with commas between them, in
// `list`, each checked so that a fault is reported at its place. A value that is no YAML
// list is returned as it is. NULL after a fault.
static const char *list_text(reader *r, const tree_node *node, int index,
                             char list[PARAMETER_VALUE_SIZE])
{
    const char *path = parameter_table[index].path;
    if (node->kind != TREE_LIST) {
        return reader_value_text(r, node, path);
    }

    // each number by itself
    size_t used = 0;
    list[0] = '\0';
    for (const tree_node *child = node->first; child != NULL; child = child->next) {
        fault f;
        parameters scratch = r->s->parameters;
        const char *text = reader_value_text(r, child, path);
        if (text == NULL) {
            return NULL;
        }
        if (parameter_set_text(&scratch, index, text, &f) != STATUS_OK) {
            report_node(r, child, "%s", f.text);
            return NULL;
        }
        used += (size_t)snprintf(list + used, PARAMETER_VALUE_SIZE - used, "%s%s",
                                 used > 0 ? ", " : "", text);
        if (used >= PARAMETER_VALUE_SIZE) {
            report_node(r, child, "%s is too long, expected at most %d characters", path,
                        PARAMETER_VALUE_SIZE - 1);
            return NULL;
        }
    }
    return list;
}

// Reads control.settings given as a map of NAME: NUMBER.
static void read_settings(reader *r, const tree_node *map)
{
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        fault f;
        const char *key = reader_key(r, map, child), *name;
        char path[PARAMETER_TEXT_SIZE];
        if (key == NULL) {
            continue;
        }

        // a name that a setting can have, and its number
        snprintf(path, sizeof path, "control.settings.%s", key);
        if (settings_look_up(path, &name, &f) < 0) {
            report_node(r, child->key, "%s", f.text);
            continue;
        }
        const char *text = reader_value_text(r, child, path);
        if (text != NULL &&
            settings_set_text(&r->s->parameters, name, text, &f) != STATUS_OK) {
            report_node(r, child, "%s", f.text);
        }
    }
}

void reader_group(reader *r, const tree_node *map, const char *group)
{
    fault f;

    // a group must be a map; the report shows its first parameter as an example
    int first = 0;
    while (!parameter_in_group(parameter_table[first].path, group)) {
        first++;
    }
    char example[64];
    snprintf(example, sizeof example, "%s: ...",
             strchr(parameter_table[first].path, '.') + 1);
    if (!reader_expect_map(r, map, group, example)) {
        return;
    }

    // its parameters
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        r->about = NULL;
        const char *key = reader_key(r, map, child);
        if (key == NULL) {
            continue;
        }

        // the whole path of the parameter
        char path[128];
        snprintf(path, sizeof path, "%s.%s", group, key);
        int index = parameter_find(path);
        if (index < 0) {
            report_unknown_parameter(r, child->key, group);
            continue;
        }

        // settings that are given as a map
        r->about = parameter_table[index].path;
        if (index == PARAMETER_INDEX(control.settings) && child->kind == TREE_MAP) {
            read_settings(r, child);
            r->given[index] = (place){child->line, child->column};
            continue;
        }

        // any other value, and its place in the file
        char list[PARAMETER_VALUE_SIZE];
        const char *text;
        if (parameter_table[index].type == PARAMETER_LIST) {
            text = list_text(r, child, index, list);
        } else {
            text = reader_value_text(r, child, path);
        }
        if (text != NULL &&
            parameter_set_text(&r->s->parameters, index, text, &f) != STATUS_OK) {
            report_node(r, child, "%s", f.text);
        } else if (text != NULL) {
            r->given[index] = (place){child->line, child->column};
        }
    }
    r->about = NULL;
}

void reader_resolve(reader *r)
{
    fault f;
    parameters trial = r->s->parameters;
    while (parameters_resolve(&trial, &f) != STATUS_OK) {
        // defaults suit one another, so that the parameter to blame is one of the file's
        const int blamed = parameter_find(f.path);
        assert(blamed >= 0 && r->given[blamed].line > 0);
        r->about = parameter_table[blamed].path;
        reader_report_at(r, r->given[blamed].line, r->given[blamed].column, "%s", f.text);

        // with its default instead, faults of the others can be found
        trial.set[blamed] = 0;
    }
    r->about = NULL;
    r->s->parameters = trial;
}

void reader_check_lock(reader *r, const parameters *p, place at)
{
    fault f;
    const scenario locked = {.parameters = *p};
    if (scenario_check_locks(&locked, controller_of(p->control.law), &f) != STATUS_OK) {
        reader_report_at(r, at.line, at.column, "%s", f.text);
    }
}
