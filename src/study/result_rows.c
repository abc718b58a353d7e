#include "src/study/result_rows.h"

#include <assert.h>

#include "src/base/json.h"
#include "src/base/words.h"

void result_headings(csv_writer *w, const result_column *columns, int count)
{
    for (int k = 0; k < count; k++) {
        csv_heading(w, columns[k].name, columns[k].unit);
    }
    csv_end_row(w);
}

void result_row(csv_writer *w, const result_cell *cells, int count)
{
    for (int k = 0; k < count; k++) {
        if (cells[k].text != NULL) {
            csv_text(w, cells[k].text);
        } else {
            csv_number(w, cells[k].number);
        }
    }
    csv_end_row(w);
}

void result_put(json_t *object, const result_column *columns, const result_cell *cells, int count)
{
    for (int k = 0; k < count; k++) {
        json_put(object, columns[k].key,
                 cells[k].text != NULL ? json_text(cells[k].text) : json_number(cells[k].number));
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
    for (int k = 0; k < columns; k++) {
        fputs(k == 0 ? "|---|" : "---|", stream);
    }
    fputc('\n', stream);
}
