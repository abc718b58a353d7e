#include "render/plot/figure_file.h"

#include <math.h>
#include <string.h>

#include "render/plot/curve.h"
#include "render/page/text.h"
#include "src/run/export.h"
#include "src/base/whole_file.h"

static status paint(cairo_t *cr, const void *what, fault *f)
{
    return figure_paint(cr, what, NULL, f);
}

status figure_write(const figure *fig, const char *path, fault *f)
{
    picture p = {.dpi = fig->dpi,
                 .title = fig->title,
                 .software = fig->software,
                 .parameters = fig->parameters,
                 .paint = paint,
                 .what = fig};
    figure_size(fig, &p.width, &p.height);
    return picture_write(&p, path, f);
}

void csv_field(FILE *stream, const char *field)
{
    if (strpbrk(field, ",\"\r\n") == NULL) {
        fputs(field, stream);
        return;
    }
    fputc('"', stream);
    for (const char *c = field; *c != '\0'; c++) {
        fputs(*c == '"' ? "\"\"" : (char[]){*c, '\0'}, stream);
    }
    fputc('"', stream);
}

// A name, or the label without markup where there is none, with the unit in brackets.
static void write_name(FILE *stream, const char *name, const char *label, const char *unit)
{
    char *plain = name ? g_strdup(name) : text_plain(label ? label : "");
    bool has_unit = unit != NULL && unit[0] != '\0';
    char *field = has_unit ? g_strdup_printf("%s[%s]", plain, unit) : g_strdup(plain);
    csv_field(stream, field);
    g_free(field);
    g_free(plain);
}

static void write_panel_name(FILE *stream, const figure_panel *panel)
{
    write_name(stream, panel->name, panel->label, panel->unit);
    fputc(',', stream);
}

// One row; a y that is not finite stays empty.
static void write_row(FILE *stream, double x, double y)
{
    char number[NUMBER_TEXT];
    number_format(number, x);
    fprintf(stream, ",%s,", number);
    if (isfinite(y)) {
        number_format(number, y);
        fputs(number, stream);
    }
    fputc('\n', stream);
}

static void write_series(FILE *stream, const figure_panel *panel, const figure_series *s)
{
    for (size_t i = 0; i < s->count && !ferror(stream); i++) {
        if (isfinite(series_x(s, i))) {
            write_panel_name(stream, panel);
            write_name(stream, s->name, s->label, NULL);
            write_row(stream, series_x(s, i), series_y(s, i));
        }
    }
}

static void write_levels_and_impulses(FILE *stream, const figure_panel *panel)
{
    for (int i = 0; i < panel->impulse_count; i++) {
        write_panel_name(stream, panel);
        write_name(stream, "impulse", NULL, panel->impulse_unit);
        write_row(stream, panel->impulses[i].x, panel->impulses[i].size);
    }
    for (int i = 0; i < panel->level_count; i++) {
        const char *label = panel->levels[i].label;
        write_panel_name(stream, panel);
        write_name(stream, NULL, label ? label : "level", NULL);
        // a level has no x of its own
        char number[NUMBER_TEXT];
        number_format(number, panel->levels[i].y);
        fprintf(stream, ",,%s\n", number);
    }
}

static void write_marks(FILE *stream, const figure *fig)
{
    for (int i = 0; i < fig->mark_count; i++) {
        fputs("mark,", stream);
        write_name(stream, NULL, fig->marks[i].label, NULL);
        write_row(stream, fig->marks[i].x, (double)NAN);
    }
    for (int i = 0; i < fig->interval_count; i++) {
        fputs("interval,begins", stream);
        write_row(stream, fig->intervals[i].from, (double)NAN);
        fputs("interval,ends", stream);
        write_row(stream, fig->intervals[i].to, (double)NAN);
    }
}

status figure_write_csv(const figure *fig, const char *path, fault *f)
{
    whole_file file;
    status code = whole_file_open(&file, path, f);
    if (code != STATUS_OK) {
        return code;
    }
    fputs("panel,series,x,y\n", file.stream);
    for (int p = 0; p < fig->panel_count; p++) {
        const figure_panel *panel = &fig->panels[p];
        for (int s = 0; s < panel->series_count; s++) {
            write_series(file.stream, panel, &panel->series[s]);
        }
        write_levels_and_impulses(file.stream, panel);
    }
    write_marks(file.stream, fig);
    return whole_file_commit(&file, f);
}
