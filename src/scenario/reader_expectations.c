// What a scenario file expects of its run.
#include "src/scenario/reader.h"

#include <stdlib.h>
#include <string.h>

#include "src/tables/summary.h"

// Index in the summary of a quantity that two machines agree about; -1 after a fault.
static int parse_quantity(reader *r, const tree_node *key)
{
    int index = summary_find(key->text);
    if (index >= 0 && !summary_table[index].timing) {
        return index;
    }

    // one that the computer decides, or none of the summary
    if (index >= 0) {
        report_node(r, key, "%s depends on the computer, expected a quantity of the arm",
                    key->text);
    } else {
        const char *near = summary_suggest(key->text);
        report_node(r, key, "unknown quantity '%.60s', %s%s%s", key->text,
                    near ? "did you mean '" : "expected a key of 'run --json'", near ? near : "",
                    near ? "'?" : "");
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
        report_node(r, map, "%s is %s, expected {value: ..., tolerance: ...} or null", quantity,
                    node_kind_name(map));
        return false;
    }

    // which of the two keys are there
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
            report_node(r, child->key, "unknown key '%.60s' in %s, expected value and tolerance",
                        key, quantity);
        }
    }

    if (value == NULL || tolerance == NULL) {
        report_node(r, map, "%s has no %s, expected {value: ..., tolerance: ...}", quantity,
                    value == NULL ? "value" : "tolerance");
    }

    // their numbers
    if (value != NULL) {
        reader_quantity(r, value, "value", "", &e->value);
    }
    if (tolerance != NULL && reader_quantity(r, tolerance, "tolerance", "", &e->tolerance) &&
        e->tolerance < 0) {
        report_node(r, tolerance, "tolerance = %g is negative, expected 0 or more", e->tolerance);
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

    // room for as many as there are keys
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        most++;
    }
    s->expectations = calloc((size_t)most + 1, sizeof *s->expectations);
    if (!reader_have_memory(r, s->expectations)) {
        return;
    }

    // null, or a value and how far it may be off
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        const char *key = reader_key(r, map, child);
        int quantity = key != NULL ? parse_quantity(r, child->key) : -1;
        if (quantity < 0) {
            continue;
        }

        expectation e = {
            .quantity = quantity, .line = child->key->line, .column = child->key->column};
        e.is_null = node_is_null(child);
        if (e.is_null || parse_value_and_tolerance(r, child, &e)) {
            s->expectations[s->expectation_count++] = e;
        }
    }
}
