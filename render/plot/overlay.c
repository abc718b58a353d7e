#include "render/plot/trace_plot.h"
#include "render/page/text.h"
#include "src/base/numbers.h"
#include "src/run/trace.h"

#include <math.h>
#include <string.h>

// The signal that the spec's column stands for: the one of its name, or of its unit; -1 for none.
static int signal_of(const csv_table *table, const char *column, const trace_panel *panels,
                     int count)
{
    const int named = signal_find(column), at = csv_table_find(table, column);
    if (named >= 0 || at < 0) {
        return named;
    }
    char unit[32];
    const char *bracket = strrchr(table->headings[at], '[');
    snprintf(unit, sizeof unit, "%s", bracket != NULL ? bracket + 1 : "");
    unit[strcspn(unit, "]")] = '\0';
    for (int i = 0; i < count; i++) {
        int index = signal_find(panels[i].signals[0]);
        if (index > 0 && strcmp(signal_table[index].unit, unit) == 0) {
            return index;
        }
    }
    return -1;
}

status overlay_read_column(trace *t, const char *path, const char *column, double shift,
                           const trace_panel *panels, int panel_count, char **name, fault *f)
{
    csv_table table;
    trace_init(t, 0);
    *name = NULL;
    TRY(csv_table_read(&table, path, 1, f));

    // named by its file
    g_autofree char *file = g_path_get_basename(path);
    *name = column != NULL ? text_printf("%s: %s", file, column) : g_strdup(file);

    const int signal = column != NULL ? signal_of(&table, column, panels, panel_count) : 0;
    const status code =
        column == NULL || (signal > 0 && csv_table_find(&table, column) >= 0)
            ? measured_rows(t, &table, column, signal, f)
            : fault_set(f, STATUS_BAD_ARGUMENT,
                        "%s:1: there is no column '%s' with the unit of a signal that is shown",
                        path, column);
    csv_table_finish(&table);

    // as the clocks were apart
    for (size_t i = 0; i < t->row_count; i++) {
        t->rows[i].time += shift;
    }
    return code;
}

status overlay_read(trace *t, const char *text, const trace_panel *panels, int panel_count,
                    char **name, fault *f)
{
    g_autofree char *path = g_strdup(text);
    const char *column = NULL, *rest;
    double shift = 0;

    // a file of that very name, or a shift and a column are cut off its end
    if (!g_file_test(text, G_FILE_TEST_EXISTS)) {
        char *at = strrchr(path, '@');
        if (at != NULL) {
            *at = '\0';
        }
        if (at != NULL && (!decimal_read(at + 1, &shift, &rest) || *rest != '\0')) {
            trace_init(t, 0);
            *name = NULL;
            return fault_set(f, STATUS_BAD_ARGUMENT,
                             "'%s': '%s' is no shift in seconds, expected FILE.csv:COLUMN@SHIFT",
                             text, at + 1);
        }
        char *colon = strrchr(path, ':');
        if (colon != NULL) {
            *colon = '\0';
            column = colon + 1;
        }
    }
    return overlay_read_column(t, path, column, shift, panels, panel_count, name, f);
}
