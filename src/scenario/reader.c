// Faults of a scenario file with their places, and what its nodes hold.
#include "src/scenario/reader.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/base/words.h"

void reader_report_at(reader *r, int line, int column, const char *format, ...)
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
        return;
    }
    make_printable(found.sentence);
    r->found[r->faults++] = found;
}

// By the place in the file; equal places in the order found.
static int compare_places(const void *a, const void *b)
{
    const found_fault *x = a, *y = b;
    int order = (x->at.line > y->at.line) - (x->at.line < y->at.line);
    order = order ? order : (x->at.column > y->at.column) - (x->at.column < y->at.column);
    return order ? order : (x->number > y->number) - (x->number < y->number);
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

    // what could not be recorded is not lost without a word
    if (r->no_memory) {
        report(context, status_text(STATUS_NO_MEMORY));
    }
}

bool reader_have_memory(reader *r, const void *memory)
{
    if (memory == NULL) {
        r->no_memory = true;
    }
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

bool node_is_null(const tree_node *node)
{
    return node_is_scalar(node) && node->plain &&
           (strcmp(node->text, "null") == 0 || strcmp(node->text, "~") == 0);
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
    return blank ? "empty" : names[node->kind];
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
            report_node(r, key, "'%.60s' is there twice, expected it once (first at line %d)",
                        key->text, other->key->line);
            return NULL;
        }
    }
    return key->text;
}

bool reader_expect_map(reader *r, const tree_node *node, const char *what, const char *example)
{
    if (node->kind != TREE_MAP) {
        report_node(r, node, "%s is %s, expected keys such as '%s'", what, node_kind_name(node),
                    example);
    }
    return node->kind == TREE_MAP;
}

bool reader_quantity(reader *r, const tree_node *node, const char *what, const char *unit,
                     double *value)
{
    const char *rest, *space = unit[0] != '\0' ? " in " : "";

    // a number
    if (!node_is_scalar(node) || node_is_empty(node)) {
        report_node(r, node, "%s is %s, expected a number%s%s", what, node_kind_name(node), space,
                    unit);
        return false;
    }
    if (!decimal_read(node->text, value, &rest)) {
        report_node(r, node, "%s = '%.60s' is not a finite number, expected a number%s%s", what,
                    node->text, space, unit);
        return false;
    }

    // with its unit or without, and finite
    if (*rest != '\0' && strcmp(rest, unit) != 0) {
        report_node(r, node, "%s = '%.60s' carries '%.20s', expected %s", what, node->text, rest,
                    unit[0] != '\0' ? unit : "a number without a unit");
        return false;
    }
    if (!isfinite(*value)) {
        report_node(r, node, "%s = '%.60s' is too large, expected a finite number", what,
                    node->text);
        return false;
    }
    return true;
}
