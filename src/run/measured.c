#include "src/run/measured.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

status measured_rows(trace *t, const csv_table *table, const char *column, int signal, fault *f)
{
    assert(signal < signal_count);
    static const double none[1] = {0};
    double *columns[SIGNALS_AT_MOST] = {NULL};
    size_t numbers = 0;
    status code = csv_table_times(table, "time", &columns[0], f);
    for (int i = 1; i < signal_count && code == STATUS_OK; i++) {
        const char *heading = column == NULL ? signal_table[i].name : i == signal ? column : NULL;
        if (heading != NULL && csv_table_find(table, heading) >= 0) {
            code = csv_table_numbers(table, heading, signal_table[i].unit, true, &columns[i], f);
        }
    }

    // what was not measured has no value
    for (size_t r = 0; r < table->rows && code == STATUS_OK; r++) {
        double row[SIGNALS_AT_MOST];
        sample measured;
        for (int i = 0; i < SIGNALS_AT_MOST; i++) {
            row[i] = columns[i] != NULL ? columns[i][r] : (double)NAN;
            numbers += i > 0 && isfinite(row[i]);
        }
        memcpy(&measured, row, sizeof measured);
        code = trace_add_row(t, &measured, none, none);
    }
    for (int i = 0; i < SIGNALS_AT_MOST; i++) {
        free(columns[i]);
    }
    FAIL_IF(code == STATUS_OK && numbers == 0,
            fault_set(f, STATUS_BAD_ARGUMENT,
                      "%.200s:1: expected a heading with time[s] and at least one recorded "
                      "signal, such as force[N], and a number in a row below it",
                      table->file));
    return code == STATUS_NO_MEMORY ? fault_no_memory(f) : code;
}
