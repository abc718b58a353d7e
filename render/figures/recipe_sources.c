// Sources of a recipe's curves: runs, measured data, tables.
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "render/figures/recipe_parts.h"
#include "src/base/words.h"

bool recipe_knows_parameter(recipe_context *c, const tree_node *node, const char *path)
{
    if (parameter_find(path) >= 0) {
        return true;
    }
    nearest_word near = nearest_begin(path);
    for (int i = 0; i < parameter_count; i++) {
        nearest_try(&near, parameter_table[i].path);
    }
    report_node(&c->reader, node, "there is no parameter '%.60s', did you mean '%s'?",
                path, text_or(near.best, "motor.voltage"));
    return false;
}

bool recipe_is_text(const recipe_source *s)
{
    return s->scenario != NULL && strchr(s->scenario, '\n') != NULL;
}

// What is changed of a run's scenario.
static void read_changes(recipe_context *c, const tree_node *node, void *into)
{
    recipe_source *s = into;
    if (!reader_expect_map(&c->reader, node, "set", "arm.k2: 3")) {
        return;
    }

    for (const tree_node *child = node->first; child != NULL; child = child->next) {
        const char *path = reader_key(&c->reader, node, child);
        if (path == NULL) {
            continue;
        }

        // a known path with a value, as on the command line
        if (!recipe_knows_parameter(c, child->key, path)) {
            continue;
        }
        if (s->change_count == RECIPE_CHANGES) {
            report_node(&c->reader, child->key, "a run has more than %d changes",
                        RECIPE_CHANGES);
        } else if (!node_is_scalar(child)) {
            report_node(&c->reader, child, "%s is %s, expected a value", path,
                        node_kind_name(child));
        } else {
            s->change[s->change_count++] =
                recipe_keep(c, text_printf("%s=%s", path, child->text));
        }
    }
}

// A number of a table, or nothing where there is none.
static double read_cell(recipe_context *c, const tree_node *node)
{
    double value = (double)NAN;
    if (node_is_scalar(node) && strcmp(node->text, "null") == 0) {
        return value;
    }
    reader_quantity(&c->reader, node, "a number of a row", "", &value);
    return value;
}

// Rows of a table that stand in the recipe itself.
static void read_rows(recipe_context *c, const tree_node *node, void *into)
{
    recipe_source *s = into;
    const size_t columns = s->z != NULL ? 3 : 2;
    size_t count = 0;
    const tree_node *row = recipe_first(c, node, "rows");
    for (const tree_node *n = row; n != NULL; n = n->next) {
        count++;
    }
    for (size_t k = 0; k < columns; k++) {
        s->columns[k] = owned_figure_numbers(c->recipe->plot, count);
    }
    for (; row != NULL; row = row->next) {
        size_t k = 0;
        const tree_node *cell = recipe_first(c, row, "a row");
        for (; cell != NULL && k < columns; cell = cell->next) {
            s->columns[k++][s->count] = read_cell(c, cell);
        }
        if (k < columns || cell != NULL) {
            report_node(&c->reader, row, "a row has another number of columns than %zu",
                        columns);
            return;
        }
        s->count++;
    }
}

// What every source has, and what each kind needs: what is missing shows only at its end.
static void complete_source(recipe_context *c, const tree_node *node, void *into)
{
    recipe_source *s = into;
    s->at = (place){node->line, node->column};
    s->rank = s->look > 0 ? (int)s->look : (int)(s - c->recipe->sources) + 1;
    const char *needed = s->file, *key = "file";
    if (s->kind == SOURCE_RUN) {
        needed = s->scenario;
        key = "scenario";
    }
    if (needed == NULL && s->columns[0] == NULL) {
        report_node(&c->reader, node, "there is no '%s' here", key);
    }
    if (s->file != NULL && s->columns[0] != NULL) {
        report_node(&c->reader, node, "a table has a 'file' or 'rows', not both");
    }
    if (recipe_is_text(s) && s->name == NULL) {
        report_node(&c->reader, node, "a run with its scenario's text needs 'name'");
    }
    if (s->kind == SOURCE_TABLE && (s->x == NULL || s->y == NULL)) {
        report_node(&c->reader, node,
                    "a table needs 'x' and 'y', the names of its columns");
    }

    // a run is more than its scenario's name
    if (s->label == NULL && s->name == NULL && s->change_count > 0 && needed != NULL) {
        GString *label = g_string_new(needed);
        const char *before = ", with ";
        for (int i = 0; i < s->change_count; i++) {
            text_append(label, "%s%s", before, s->change[i]);
            before = ", ";
        }
        s->label = recipe_keep(c, g_string_free(label, FALSE));
    }

    // a name that only it has
    if (s->name == NULL) {
        s->name = text_or(needed, "");
    }
    for (const recipe_source *other = c->recipe->sources; other != s; other++) {
        if (strcmp(other->name, s->name) == 0) {
            report_node(&c->reader, node,
                        "the name '%s' is there twice (first at line %d)", s->name,
                        other->at.line);
        }
    }
}

const recipe_form recipe_runs = {
    .what = "a run",
    .example = "scenario: thesis/fig-3-4",
    .keys = {FIELD_KEY("scenario", VALUE_TEXT, recipe_source, scenario),
             FIELD_KEY("name", VALUE_TEXT, recipe_source, name),
             FIELD_KEY("label", VALUE_TEXT, recipe_source, label),
             {"look", VALUE_NUMBER, offsetof(recipe_source, look), .low = 1, .high = 48,
              .whole = true, .expected = "a whole number from 1 to 48"},
             {"set", .read = read_changes}},
    .holder = "a recipe",
    .things = "runs, data and tables",
    .size = sizeof(recipe_source),
    .most = RECIPE_SOURCES,
    .complete = complete_source,
    .blank = &(const recipe_source){SOURCE_RUN},
};

const recipe_form recipe_data = {
    .what = "data",
    .example = "file: bench.csv",
    .keys = {FIELD_KEY("file", VALUE_TEXT, recipe_source, file),
             FIELD_KEY("name", VALUE_TEXT, recipe_source, name),
             FIELD_KEY("label", VALUE_TEXT, recipe_source, label),
             FIELD_KEY("column", VALUE_TEXT, recipe_source, column),
             {"shift", VALUE_NUMBER, offsetof(recipe_source, shift), .unit = "s"}},
    .holder = "a recipe",
    .things = "runs, data and tables",
    .size = sizeof(recipe_source),
    .most = RECIPE_SOURCES,
    .complete = complete_source,
    .blank = &(const recipe_source){SOURCE_DATA},
};

const recipe_form recipe_tables = {
    .what = "a table",
    .example = "file: sweep.sqlite",
    .keys = {FIELD_KEY("file", VALUE_TEXT, recipe_source, file),
             FIELD_KEY("name", VALUE_TEXT, recipe_source, name),
             FIELD_KEY("label", VALUE_TEXT, recipe_source, label),
             FIELD_KEY("x", VALUE_TEXT, recipe_source, x),
             FIELD_KEY("y", VALUE_TEXT, recipe_source, y),
             FIELD_KEY("z", VALUE_TEXT, recipe_source, z),
             {"rows", .read = read_rows}},
    .holder = "a recipe",
    .things = "runs, data and tables",
    .size = sizeof(recipe_source),
    .most = RECIPE_SOURCES,
    .complete = complete_source,
    .blank = &(const recipe_source){SOURCE_TABLE},
};

int recipe_find_source(recipe_context *c, const tree_node *node)
{
    if (!node_is_scalar(node)) {
        report_node(&c->reader, node, "no run, data or table is named ''");
        return -1;
    }
    nearest_word near = nearest_begin(node->text);
    for (int i = 0; i < c->recipe->source_count; i++) {
        nearest_try(&near, c->recipe->sources[i].name);
        if (strcmp(c->recipe->sources[i].name, node->text) == 0) {
            return i;
        }
    }

    // with the most similar one, where there is one
    if (near.best == NULL) {
        report_node(&c->reader, node, "no run, data or table is named '%.60s'",
                    node->text);
    } else {
        report_node(&c->reader, node,
                    "no run, data or table is named '%.60s', did you mean '%s'?",
                    node->text, near.best);
    }
    return -1;
}
