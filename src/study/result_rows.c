#include "src/study/result_rows.h"

#include <assert.h>

#include "src/base/json.h"
#include "src/base/words.h"

result_cell result_cell_of(const result_table *t, int row, const result_column *column)
{
    const void *at = (const char *)t->rows + (size_t)row * t->row_size + column->place;
    if (column->kind == RESULT_TEXT) {
        return (result_cell){*(const char *const *)at, 0};
    }
    if (column->kind == RESULT_COUNT) {
        return (result_cell){NULL, (double)*(const size_t *)at};
    }
    return (result_cell){NULL, column->times * *(const double *)at};
}

json_t *result_json(const result_table *t)
{
    json_t *array = json_array();
    for (int i = 0; i < t->row_count; i++) {
        json_t *object = json_object();
        for (const result_column *c = t->columns; c < t->columns + t->column_count; c++) {
            result_put(object, c->key, result_cell_of(t, i, c));
        }
        json_add(array, object);
    }
    return array;
}

void result_csv(FILE *stream, const result_table *t)
{
    csv_writer csv = csv_begin(stream);
    result_headings(&csv, t->columns, t->column_count);
    for (int i = 0; i < t->row_count; i++) {
        for (const result_column *c = t->columns; c < t->columns + t->column_count; c++) {
            result_field(&csv, result_cell_of(t, i, c));
        }
        csv_end_row(&csv);
    }
}

void result_headings(csv_writer *w, const result_column *columns, int count)
{
    for (int k = 0; k < count; k++) {
        csv_heading(w, columns[k].name, columns[k].unit);
    }
    csv_end_row(w);
}

void result_field(csv_writer *w, result_cell cell)
{
    if (cell.text != NULL) {
        csv_text(w, cell.text);
    } else {
        csv_number(w, cell.number);
    }
}

void result_put(json_t *object, const char *key, result_cell cell)
{
    if (cell.text != NULL) {
        json_put(object, key, json_text(cell.text));
    } else {
        json_put(object, key, json_number(cell.number));
    }
}

void result_print(FILE *stream, bool page, int column, int width, const char *text)
{
    if (page) {
        print_printable(stream, "%s %s |", column == 0 ? "|" : "", text);
    } else {
        print_printable(stream, "%s%*s", column == 0 ? "" : "  ", width, text);
    }
}

void result_page_rule(FILE *stream, int columns)
{
    assert(columns > 0);
    fputc('|', stream);
    for (int k = 0; k < columns; k++) {
        fputs("---|", stream);
    }
    fputc('\n', stream);
}
