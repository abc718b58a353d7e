#include "src/exchange/run_tables.h"

#include <assert.h>
#include <stdlib.h>

#include "src/base/shipped.h"
#include "src/base/text_stream.h"
#include "src/base/whole_file.h"
#include "src/exchange/mat_file.h"
#include "src/exchange/mat_rows.h"
#include "src/exchange/scenario_notes.h"
#include "src/run/export.h"
#include "src/run/row_grid.h"

// What a table is written as.
typedef enum table_format {
    TABLE_CSV,
    TABLE_PARQUET,
    TABLE_MAT,
    TABLE_FORMATS
} table_format;

// One of the files; its stream is NULL where it is not asked for.
typedef struct run_table {
    whole_file file;
    union {
        csv_writer csv;
        parquet_file *parquet;
        mat_rows *mat;
    } as;
} run_table;

struct run_tables {
    const scenario *scenario;
    run_columns columns;
    parquet_column *parquet_columns;
    run_table tables[TABLE_FORMATS];
    double every; // [s]; 0: every row
    row_grid grid;
};

// --- rows ------------------------------------------------------------------------------

static void add_to_parquet(const run_tables *t, parquet_file *p, const sample *row,
                           const double *angles)
{
    for (int i = 0; i < t->columns.count; i++) {
        parquet_number(p, i, run_column_value(&t->columns.all[i], row, angles));
    }
    parquet_end_row(p);
}

static void add_to_mat(const run_tables *t, mat_rows *m, const sample *row,
                       const double *angles)
{
    for (int i = 0; i < t->columns.count; i++) {
        mat_rows_number(m, i, run_column_value(&t->columns.all[i], row, angles));
    }
    mat_rows_end_row(m);
}

// A row_taker: adds a row to every table. One whose file cannot be written goes without.
static status add_row(void *context, const sample *row, const double *angles)
{
    run_tables *t = context;
    for (int k = 0; k < TABLE_FORMATS; k++) {
        run_table *to = &t->tables[k];
        if (to->file.stream == NULL || ferror(to->file.stream)) {
            continue;
        }

        switch ((table_format)k) {
        case TABLE_CSV:
            export_csv_row(&to->as.csv, &t->columns, row, angles);
            break;
        case TABLE_PARQUET:
            add_to_parquet(t, to->as.parquet, row, angles);
            break;
        default:
            add_to_mat(t, to->as.mat, row, angles);
        }
    }
    return STATUS_OK;
}

void run_tables_observe(run_tables *t, run_options *options)
{
    if (t == NULL) {
        return;
    }
    options->rows_every = t->every;
    if (t->every > 0) {
        options->take_row = row_grid_taker;
        options->row_context = &t->grid;
    } else {
        options->take_row = add_row;
        options->row_context = t;
    }
}

// --- the beginning ---------------------------------------------------------------------

// Begins the Parquet file, whose columns are all numbers.
static parquet_file *begin_parquet(run_tables *t, FILE *stream)
{
    const int count = t->columns.count;
    t->parquet_columns = calloc((size_t)count, sizeof *t->parquet_columns);
    if (t->parquet_columns == NULL) {
        return NULL;
    }
    for (int i = 0; i < count; i++) {
        const run_column *c = &t->columns.all[i];
        t->parquet_columns[i] = (parquet_column){c->name, c->unit, PARQUET_NUMBER};
    }
    return parquet_begin(stream, t->parquet_columns, count);
}

// Opens one file and begins its table.
static status begin_table(run_tables *t, table_format format, const char *path, fault *f)
{
    run_table *to = &t->tables[format];
    if (path == NULL) {
        return STATUS_OK;
    }
    const status code = whole_file_open(&to->file, path, f);
    if (code != STATUS_OK) {
        to->file.stream = NULL;
        return code;
    }

    bool begun = true;
    switch (format) {
    case TABLE_CSV:
        to->as.csv = export_csv_begin(to->file.stream, &t->columns);
        break;
    case TABLE_PARQUET:
        to->as.parquet = begin_parquet(t, to->file.stream);
        begun = to->as.parquet != NULL;
        break;
    default:
        to->as.mat = mat_rows_begin(&to->file, t->columns.count, f);
        if (to->as.mat == NULL) {
            return f->code;
        }
    }
    if (!begun) {
        return fault_no_memory(f);
    }
    return STATUS_OK;
}

// Begins the grid of rows, if there is one, and every table.
static status begin(run_tables *t, const run_tables_order *order, fault *f)
{
    const char *const paths[] = {order->csv, order->parquet, order->mat};
    TRY(run_columns_init(&t->columns, t->scenario, order->columns, f));
    if (t->every > 0) {
        const int angles = run_angle_count(t->scenario);
        if (row_grid_begin(&t->grid, t->every, angles, add_row, t) != STATUS_OK) {
            return fault_no_memory(f);
        }
    }

    for (int k = 0; k < TABLE_FORMATS; k++) {
        TRY(begin_table(t, (table_format)k, paths[k], f));
    }
    return STATUS_OK;
}

// Frees the tables; their files are closed.
static void destroy(run_tables *t)
{
    row_grid_finish(&t->grid);
    mat_rows_destroy(t->tables[TABLE_MAT].as.mat);
    run_columns_finish(&t->columns);
    free(t->parquet_columns);
    free(t);
}

status run_tables_open(run_tables **opened, const scenario *s,
                       const run_tables_order *order, fault *f)
{
    *opened = NULL;
    if (order->csv == NULL && order->parquet == NULL && order->mat == NULL) {
        return STATUS_OK;
    }
    run_tables *t = calloc(1, sizeof *t);
    if (t == NULL) {
        return fault_no_memory(f);
    }
    t->scenario = s;
    t->every = order->every;

    // all of them or none
    const status code = begin(t, order, f);
    if (code != STATUS_OK) {
        parquet_end(t->tables[TABLE_PARQUET].as.parquet, NULL, 0);
        for (int k = 0; k < TABLE_FORMATS; k++) {
            whole_file_abandon(&t->tables[k].file);
        }
        destroy(t);
        return code;
    }
    *opened = t;
    return STATUS_OK;
}

// --- the end ---------------------------------------------------------------------------

// The columns, their units, and what they are of.
static status end_mat(run_tables *t, fault *f)
{
    const int count = t->columns.count;
    SCOPED(free_kept) char *yaml = scenario_as_text(t->scenario);
    run_table *to = &t->tables[TABLE_MAT];
    SCOPED(free_kept) const char **names = calloc((size_t)count, sizeof *names);
    SCOPED(free_kept) const char **units = calloc((size_t)count, sizeof *units);
    if (names == NULL || units == NULL || yaml == NULL) {
        return fault_no_memory(f);
    }
    for (int i = 0; i < count; i++) {
        names[i] = t->columns.all[i].name;
        units[i] = t->columns.all[i].unit;
    }

    TRY(mat_rows_end(to->as.mat, names, f));
    FILE *stream = to->file.stream;
    mat_file_texts(stream, "units", names, units, count);
    mat_file_text(stream, "scenario", yaml);
    mat_file_text(stream, "version", lab_version());
    return STATUS_OK;
}

// Ends a table and puts its file in its place.
static status end_table(run_tables *t, table_format format, fault *f)
{
    run_table *of = &t->tables[format];
    status written = STATUS_OK;
    if (of->file.stream == NULL) {
        return STATUS_OK;
    }

    if (format == TABLE_PARQUET) {
        parquet_end_with_scenario(of->as.parquet, t->scenario);
    } else if (format == TABLE_MAT) {
        written = end_mat(t, f);
    }
    return whole_file_close(&of->file, written, f);
}

status run_tables_close(run_tables *t, fault_handler report, void *context)
{
    status failed = STATUS_OK;
    if (t == NULL) {
        return STATUS_OK;
    }

    // the last row of a grid waits for the end
    if (t->every > 0) {
        loss_unless(row_grid_end(&t->grid) == STATUS_OK);
    }
    for (int k = 0; k < TABLE_FORMATS; k++) {
        fault f = {0};
        const status code = end_table(t, (table_format)k, &f);
        if (code != STATUS_OK) {
            report(context, f.text);
            failed = code;
        }
    }
    destroy(t);
    return failed;
}
