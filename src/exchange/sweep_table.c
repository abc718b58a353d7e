#include "src/exchange/sweep_table.h"

#include "src/exchange/scenario_notes.h"

static parquet_type type_of(result_kind kind)
{
    static const parquet_type types[] = {[RESULT_NUMBER] = PARQUET_NUMBER,
                                         [RESULT_COUNT] = PARQUET_WHOLE_NUMBER,
                                         [RESULT_TEXT] = PARQUET_TEXT};
    return types[kind];
}

status sweep_table_begin(sweep_table *t, FILE *stream, const result_column *columns,
                         int count)
{
    // under the keys that JSON has
    *t = (sweep_table){.stream = stream, .count = count};
    for (int i = 0; i < count; i++) {
        const result_column *c = &columns[i];
        t->columns[i] = (parquet_column){c->key, c->unit, type_of(c->kind)};
    }
    t->file = parquet_begin(stream, t->columns, count);
    if (t->file == NULL) {
        return STATUS_NO_MEMORY;
    }
    return STATUS_OK;
}

bool sweep_table_row(void *table, size_t run, const result_cell *cells)
{
    const sweep_table *t = table;
    (void)run; // it is in its cell
    for (int i = 0; i < t->count; i++) {
        if (t->columns[i].type == PARQUET_TEXT) {
            parquet_text(t->file, i, cells[i].text);
        } else {
            parquet_number(t->file, i, cells[i].number);
        }
    }
    parquet_end_row(t->file);
    return !ferror(t->stream);
}

void sweep_table_end(sweep_table *t, const scenario *s)
{
    parquet_end_with_scenario(t->file, s);
}
