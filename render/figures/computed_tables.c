#include "render/figures/computed_tables.h"

#include <assert.h>
#include <glib.h>
#include <stdbool.h>
#include <string.h>

G_LOCK_DEFINE_STATIC(tables);

// Computing the tables takes a while, and six pages want them, perhaps on several threads.
const thesis_tables *computed_tables(fault *f)
{
    static thesis_tables tables;
    static bool done;
    G_LOCK(tables);
    done = done || tables_compute(&tables, f) == STATUS_OK;
    const thesis_tables *computed = done ? &tables : NULL;
    G_UNLOCK(tables);
    return computed;
}

const table_row *computed_row(const thesis_tables *t, const char *table, const char *model,
                              const char *quantity)
{
    assert(t != NULL && table != NULL && model != NULL && quantity != NULL);
    for (int i = 0; i < t->row_count; i++) {
        const table_row *row = &t->rows[i];
        if (strcmp(row->table, table) == 0 && strcmp(row->model, model) == 0 &&
            strcmp(row->quantity, quantity) == 0) {
            return row;
        }
    }
    assert(false && "no such row");
    return NULL;
}
