// The groups of a scenario file: its parameters.
#include "src/scenario/reader.h"

#include <assert.h>
#include <string.h>

#include "src/base/words.h"
#include "src/rig/rig.h"

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

// Reports a key that its group does not have: in another group, or near to one of its own.
static void report_unknown_parameter(reader *r, const tree_node *key, const char *group)
{
    const char *elsewhere = parameter_suggest(key->text);
    if (elsewhere != NULL && strcmp(strchr(elsewhere, '.') + 1, key->text) == 0) {
        report_node(r, key, "unknown key '%.60s' in %s, did you mean %s?", key->text, group,
                    elsewhere);
        return;
    }

    // misspelt
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
        report_node(r, key, "unknown key '%.60s' in %s, did you mean '%s'?", key->text, group,
                    near.best);
    } else {
        report_node(r, key, "unknown key '%.60s' in %s, expected one of %s", key->text, group,
                    known);
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

// The numbers of a YAML list with commas between them, each checked where it stands; a value that
// is no list stays as it is. NULL after a fault.
static const char *list_text(reader *r, const tree_node *node, int index,
                             char list[PARAMETER_TEXT_SIZE])
{
    const char *path = parameter_table[index].path;
    if (node->kind != TREE_LIST) {
        return reader_value_text(r, node, path);
    }

    // a number at a time
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
        used += (size_t)snprintf(list + used, PARAMETER_TEXT_SIZE - used, "%s%s",
                                 used > 0 ? ", " : "", text);
        if (used >= PARAMETER_TEXT_SIZE) {
            report_node(r, child, "%s is too long, expected at most %d characters", path,
                        PARAMETER_TEXT_SIZE - 1);
            return NULL;
        }
    }
    return list;
}

void reader_group(reader *r, const tree_node *map, const char *group)
{
    fault f;

    // a group that is no map is shown the first of its parameters
    int first = 0;
    while (!parameter_in_group(parameter_table[first].path, group)) {
        first++;
    }
    char example[64];
    snprintf(example, sizeof example, "%s: ...", strchr(parameter_table[first].path, '.') + 1);
    if (!reader_expect_map(r, map, group, example)) {
        return;
    }

    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        r->about = NULL;
        const char *key = reader_key(r, map, child);
        if (key == NULL) {
            continue;
        }

        // the parameter's whole path
        char path[128];
        snprintf(path, sizeof path, "%s.%s", group, key);
        int index = parameter_find(path);
        if (index < 0) {
            report_unknown_parameter(r, child->key, group);
            continue;
        }

        // its value, and where it stands
        r->about = parameter_table[index].path;
        char list[PARAMETER_TEXT_SIZE];
        const char *text = parameter_table[index].type == PARAMETER_LIST
                               ? list_text(r, child, index, list)
                               : reader_value_text(r, child, path);
        if (text != NULL && parameter_set_text(&r->s->parameters, index, text, &f) != STATUS_OK) {
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
        // defaults go together, so that a parameter which the file gives is to blame
        const int blamed = parameter_find(f.path);
        assert(blamed >= 0 && r->given[blamed].line > 0);
        r->about = parameter_table[blamed].path;
        reader_report_at(r, r->given[blamed].line, r->given[blamed].column, "%s", f.text);

        // with its default the others may show faults of their own
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
