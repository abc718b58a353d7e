// Tables as pages: a heading, rows of cells, and heading rows of groups.
#pragma once

#include "render/page/sketch.h"
#include "src/base/csv.h"

enum { TABLE_COLUMNS = 10 };

typedef struct table_column {
    const char *label; // markup
    double share;      // of the width
    text_align align;
} table_column;

// Texts are markup and owned by the table.
typedef struct table_page {
    char *title;      // plain
    char *caption;    // NULL for none
    char *parameters; // plain, for the file's metadata; NULL for none
    const table_column *columns;
    int column_count; // at most TABLE_COLUMNS
    GPtrArray *rows; // of char **: column_count cells, or one cell and NULL for a group's
                     // heading
    page_look look;
} table_page;

// An empty table of borrowed columns; the title is copied.
table_page *table_create(const char *title, const table_column *columns, size_t count);
void table_destroy(void *table);

// A row of column_count cells, copied; and a group's heading.
void table_add_row(table_page *t, const char *const *cells);
void table_add_group(table_page *t, const char *heading);

void table_size(const table_page *t, double *width, double *height);
status table_paint(cairo_t *cr, const table_page *t, figure_report *report, fault *f);

// Writes the texts of the cells without markup; a group's heading is the first column of
// its rows.
void table_write_csv(const table_page *t, csv_writer *csv);

// Appends the table as HTML.
void table_add_html(const table_page *t, GString *html);
