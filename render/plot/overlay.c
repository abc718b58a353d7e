#include "render/plot/trace_plot.h"
#include "render/page/text.h"
#include "src/base/numbers.h"
#include "src/run/measured.h"

#include <assert.h>
#include <glib.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// What FILE.csv[:COLUMN][@SHIFT] says.
typedef struct overlay_spec {
    char *path;
    char *column; // NULL: all that are signals
    double shift; // [s]
} overlay_spec;

static status read_spec(const char *text, overlay_spec *spec, fault *f)
{
    *spec = (overlay_spec){.path = g_strdup(text)};

    // a file of that very name
    if (g_file_test(text, G_FILE_TEST_EXISTS)) {
        return STATUS_OK;
    }

    // else a shift and a column are cut off its end
    char *at = strrchr(spec->path, '@');
    const char *rest;
    if (at != NULL) {
        *at = '\0';
        if (!decimal_read(at + 1, &spec->shift, &rest) || *rest != '\0') {
            return fault_set(f, STATUS_BAD_ARGUMENT,
                             "'%s': '%s' is no shift in seconds, expected FILE.csv:COLUMN@SHIFT",
                             text, at + 1);
        }
    }

    char *colon = strrchr(spec->path, ':');
    if (colon != NULL) {
        *colon = '\0';
        spec->column = g_strdup(colon + 1);
    }
    return STATUS_OK;
}

static void spec_finish(overlay_spec *spec)
{
    g_free(spec->path);
    g_free(spec->column);
}

// The first signal of the panels that has a unit, -1 if none has.
static int signal_of_unit(const char *unit, const trace_panel *panels, int count)
{
    for (int i = 0; i < count; i++) {
        int index = signal_find(panels[i].signals[0]);
        if (index > 0 && strcmp(signal_table[index].unit, unit) == 0) {
            return index;
        }
    }
    return -1;
}

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
    return signal_of_unit(unit, panels, count);
}

static status read_file(trace *t, const overlay_spec *spec, const trace_panel *panels,
                        int panel_count, char **name, fault *f)
{
    csv_table table;
    status code = csv_table_read(&table, spec->path, 1, f);
    if (code != STATUS_OK) {
        return code;
    }

    // named by its file
    g_autofree char *file = g_path_get_basename(spec->path);
    *name = spec->column != NULL ? text_printf("%s: %s", file, spec->column) : g_strdup(file);

    const int signal =
        spec->column != NULL ? signal_of(&table, spec->column, panels, panel_count) : 0;
    code = spec->column == NULL || (signal > 0 && csv_table_find(&table, spec->column) >= 0)
               ? measured_rows(t, &table, spec->column, signal, f)
               : fault_set(f, STATUS_BAD_ARGUMENT,
                           "%s:1: there is no column '%s' with the unit of a signal that is shown",
                           spec->path, spec->column);
    csv_table_finish(&table);

    // as the clocks were apart
    for (size_t i = 0; i < t->row_count; i++) {
        t->rows[i].time += spec->shift;
    }
    return code;
}

status overlay_read_column(trace *t, const char *path, const char *column, double shift,
                           const trace_panel *panels, int panel_count, char **name, fault *f)
{
    assert(t != NULL && path != NULL && name != NULL);
    overlay_spec spec = {g_strdup(path), g_strdup(column), shift};
    trace_init(t, 0);
    *name = NULL;

    status code = read_file(t, &spec, panels, panel_count, name, f);
    spec_finish(&spec);
    return code;
}

status overlay_read(trace *t, const char *text, const trace_panel *panels, int panel_count,
                    char **name, fault *f)
{
    assert(t != NULL && text != NULL && name != NULL);
    overlay_spec spec;
    trace_init(t, 0);
    *name = NULL;
    status code = read_spec(text, &spec, f);
    code = code == STATUS_OK ? read_file(t, &spec, panels, panel_count, name, f) : code;
    spec_finish(&spec);
    return code;
}
