#include "render/plot/trace_plot.h"
#include "render/page/text.h"
#include "src/base/numbers.h"

#include <assert.h>
#include <glib.h>
#include <math.h>
#include <string.h>

enum { MOST_COLUMNS = 256 };

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

// A heading's name and unit, "force [N]".
static void split_heading(const char *heading, char name[64], char unit[32])
{
    g_strlcpy(name, heading, 64);
    size_t length = strcspn(name, "[");
    g_strlcpy(unit, name[length] == '[' ? name + length + 1 : "", 32);

    unit[strcspn(unit, "]")] = '\0';
    name[length] = '\0';
    g_strstrip(name);
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

// Index of a column's signal, -1 for a column that is not drawn.
static int signal_of(const char *heading, const overlay_spec *spec, const trace_panel *panels,
                     int count)
{
    char name[64], unit[32];
    split_heading(heading, name, unit);

    int index = signal_find(name);
    if (index == 0 || spec->column == NULL) {
        return index;
    }

    if (strcmp(name, spec->column) != 0) {
        return -1;
    }
    return index > 0 ? index : signal_of_unit(unit, panels, count);
}

static void set_signal(sample *row, int signal, double value)
{
    memcpy((char *)row + signal_table[signal].offset, &value, sizeof value);
}

// A row without any signal.
static sample missing_row(void)
{
    sample row = {0};
    for (int i = 0; i < signal_count; i++) {
        set_signal(&row, i, (double)NAN);
    }
    return row;
}

// Which signal each column holds; returns how many columns there are.
static int read_headings(const char *line, int *signals, const overlay_spec *spec,
                         const trace_panel *panels, int panel_count, fault *f)
{
    int count = 0, known = 0;
    bool has_time = false;

    char **headings = g_strsplit(line, ",", MOST_COLUMNS);
    for (; headings[count] != NULL; count++) {
        signals[count] = signal_of(headings[count], spec, panels, panel_count);
        has_time = has_time || signals[count] == 0;
        known += signals[count] > 0;
    }

    g_strfreev(headings);

    // what is missing
    if (has_time && known == 0 && spec->column != NULL) {
        fault_set(f, STATUS_BAD_ARGUMENT,
                  "%s:1: there is no column '%s' with the unit of a signal that is shown",
                  spec->path, spec->column);
        return 0;
    }
    if (!has_time || known == 0) {
        fault_set(f, STATUS_BAD_ARGUMENT,
                  "%s:1: expected a heading with time[s] and at least one recorded signal, such as "
                  "force[N]",
                  spec->path);
        return 0;
    }

    return count;
}

// Reads a row; counts its numbers without the time.
static status read_line(trace *t, const char *line, const int *signals, int columns,
                        const char *where, size_t *numbers, fault *f)
{
    status code = STATUS_OK;
    sample row = missing_row();
    char **cells = g_strsplit(line, ",", columns);

    // cells of known columns that hold a number
    for (int i = 0; cells[i] != NULL && code == STATUS_OK; i++) {
        double value;
        const char *rest, *cell = g_strstrip(cells[i]);
        if (signals[i] < 0 || cell[0] == '\0' || g_ascii_strcasecmp(cell, "nan") == 0) {
            continue;
        }
        if (!decimal_read(cell, &value, &rest) || *rest != '\0') {
            code = fault_set(f, STATUS_BAD_ARGUMENT, "%s: '%s' is no number", where, cell);
        } else {
            set_signal(&row, signals[i], value);
            *numbers += signals[i] > 0 && isfinite(value);
        }
    }

    // a row needs a time
    g_strfreev(cells);
    if (code == STATUS_OK && isfinite(row.time)) {
        const double nothing = 0;
        code = trace_add_row(t, &row, &nothing, &nothing);
    }
    return code;
}

// The rows of a file that has been read.
static status read_rows(trace *t, const char *text, const overlay_spec *spec,
                        const trace_panel *panels, int panel_count, fault *f)
{
    int signals[MOST_COLUMNS];
    size_t numbers = 0;
    char **lines = g_strsplit(text, "\n", -1);
    const char *headings = lines[0] != NULL ? lines[0] : ""; // none in an empty file
    int columns = read_headings(headings, signals, spec, panels, panel_count, f);

    // line by line
    status code = columns > 0 ? STATUS_OK : STATUS_BAD_ARGUMENT;
    for (int i = 1; code == STATUS_OK && lines[i] != NULL; i++) {
        char *where = text_printf("%s:%d", spec->path, i + 1);
        if (g_strstrip(lines[i])[0] != '\0') {
            code = read_line(t, lines[i], signals, columns, where, &numbers, f);
        }
        g_free(where);
    }

    // nothing to lay over anything is a mistake somewhere
    g_strfreev(lines);
    if (code == STATUS_OK && (t->row_count == 0 || numbers == 0)) {
        code = fault_set(f, STATUS_BAD_ARGUMENT,
                         "%s: no row below its heading has a time and a number, expected at least "
                         "one",
                         spec->path);
    }

    // as the clocks were apart
    for (size_t i = 0; i < t->row_count; i++) {
        t->rows[i].time += spec->shift;
    }
    return code;
}

static status read_file(trace *t, const overlay_spec *spec, const trace_panel *panels,
                        int panel_count, char **name, fault *f)
{
    gchar *content = NULL;
    GError *error = NULL;
    if (!g_file_get_contents(spec->path, &content, NULL, &error)) {
        fault_set(f, STATUS_CANNOT_READ, "%s cannot be read: %s", spec->path, error->message);
        g_error_free(error);
        return STATUS_CANNOT_READ;
    }

    // named by its file
    char *file = g_path_get_basename(spec->path);
    *name = spec->column != NULL ? text_printf("%s: %s", file, spec->column) : g_strdup(file);

    status code = read_rows(t, content, spec, panels, panel_count, f);
    g_free(file);
    g_free(content);
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
    if (code == STATUS_OK) {
        code = read_file(t, &spec, panels, panel_count, name, f);
    }
    spec_finish(&spec);
    return code;
}
