// What a scenario file expects of its run.
#include "src/scenario/reader.h"

#include <stdlib.h>
#include <string.h>

#include "src/base/words.h"

#include "src/run/run.h"

static const summary_info *find_quantity(const char *key)
{
    for (int i = 0; i < summary_count; i++) {
        if (strcmp(summary_table[i].key, key) == 0) {
            return &summary_table[i];
        }
    }
    return NULL;
}

// True if a run's summary has the quantity and two machines agree about it.
static bool check_quantity(reader *r, const tree_node *key)
{
    const summary_info *info = find_quantity(key->text);
    if (info != NULL && info->timing) {
        report_node(r, key, "%s depends on the computer, expected a quantity of the arm",
                    key->text);
        return false;
    }
    if (info == NULL) {
        nearest_word near = nearest_begin(key->text);
        for (int i = 0; i < summary_count; i++) {
            nearest_try(&near, summary_table[i].key);
        }
        report_node(r, key, "unknown quantity '%.60s', %s%s%s", key->text,
                    near.best ? "did you mean '" : "expected a key of 'run --json'",
                    near.best ? near.best : "", near.best ? "'?" : "");
    }
    return info != NULL;
}

// Reads {value: ..., tolerance: ...}; false after a fault.
static bool read_value_and_tolerance(reader *r, const tree_node *map, expectation *e)
{
    const tree_node *value = NULL, *tolerance = NULL;
    int faults = r->faults;
    if (map->kind != TREE_MAP) {
        report_node(r, map, "%s is %s, expected {value: ..., tolerance: ...} or null", e->quantity,
                    node_kind_name(map));
        return false;
    }
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
                        key, e->quantity);
        }
    }
    if (value == NULL || tolerance == NULL) {
        report_node(r, map, "%s has no %s, expected {value: ..., tolerance: ...}", e->quantity,
                    value == NULL ? "value" : "tolerance");
    }
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
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        most++;
    }
    s->expectations = calloc((size_t)most + 1, sizeof *s->expectations);
    if (!reader_have_memory(r, s->expectations)) {
        return;
    }
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        const char *key = reader_key(r, map, child);
        if (key == NULL || !check_quantity(r, child->key)) {
            continue;
        }
        expectation e = {.line = child->key->line, .column = child->key->column};
        snprintf(e.quantity, sizeof e.quantity, "%s", key);
        e.is_null = node_is_null(child);
        if (e.is_null || read_value_and_tolerance(r, child, &e)) {
            s->expectations[s->expectation_count++] = e;
        }
    }
}
