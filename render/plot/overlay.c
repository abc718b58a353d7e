#include "render/plot/overlay.h"
#include "src/base/numbers.h"

#include <assert.h>
#include <errno.h>
#include <glib.h>
#include <math.h>
#include <string.h>

enum { MOST_COLUMNS = 256 };

// Index of the signal that a column's heading names, -1 for another column.
static int signal_of(const char *heading)
{
    char name[64];
    g_strlcpy(name, heading, sizeof name);
    g_strstrip(name);
    name[strcspn(name, "[")] = '\0';
    return signal_find(g_strstrip(name));
}

static void set_signal(sample *row, int signal, double value)
{
    memcpy((char *)row + signal_table[signal].offset, &value, sizeof value);
}

// A row whose every signal is missing.
static sample missing_row(void)
{
    sample row = {0};
    for (int i = 0; i < signal_count; i++) {
        set_signal(&row, i, (double)NAN);
    }
    return row;
}

// Which signal each column holds; returns how many columns there are.
static int read_headings(const char *line, int *signals, const char *path, fault *f)
{
    int count = 0, known = 0;
    bool has_time = false;
    char **headings = g_strsplit(line, ",", MOST_COLUMNS);
    for (; headings[count] != NULL; count++) {
        signals[count] = signal_of(headings[count]);
        has_time = has_time || signals[count] == 0;
        known += signals[count] > 0;
    }
    g_strfreev(headings);
    if (!has_time || known == 0) {
        fault_set(f, STATUS_BAD_ARGUMENT,
                  "%s:1: expected a heading with time[s] and at least one recorded signal, such as "
                  "force[N]",
                  path);
        return 0;
    }
    return count;
}

static status read_line(trace *t, const char *line, const int *signals, int columns,
                        const char *where, fault *f)
{
    status code = STATUS_OK;
    sample row = missing_row();
    char **cells = g_strsplit(line, ",", columns);
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
        }
    }
    g_strfreev(cells);
    if (code == STATUS_OK && isfinite(row.time)) {
        const double nothing = 0;
        code = trace_add_row(t, &row, &nothing, &nothing);
    }
    return code;
}

status overlay_read(trace *t, const char *path, fault *f)
{
    assert(t != NULL && path != NULL);
    gchar *text;
    GError *error = NULL;
    trace_init(t, 0);
    if (!g_file_get_contents(path, &text, NULL, &error)) {
        fault_set(f, STATUS_CANNOT_READ, "%s cannot be read: %s", path, error->message);
        g_error_free(error);
        return STATUS_CANNOT_READ;
    }
    int signals[MOST_COLUMNS];
    char **lines = g_strsplit(text, "\n", -1);
    int columns = lines[0] != NULL ? read_headings(lines[0], signals, path, f) : 0;
    status code = columns > 0 ? STATUS_OK : STATUS_BAD_ARGUMENT;
    for (int i = 1; code == STATUS_OK && lines[i] != NULL; i++) {
        char *where = g_strdup_printf("%s:%d", path, i + 1);
        if (g_strstrip(lines[i])[0] != '\0') {
            code = read_line(t, lines[i], signals, columns, where, f);
        }
        g_free(where);
    }
    g_strfreev(lines);
    g_free(text);
    return code;
}
