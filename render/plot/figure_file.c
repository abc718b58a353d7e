#include "render/plot/figure_file.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "render/plot/curve.h"
#include "render/page/text.h"
#include "src/base/whole_file.h"
#include "src/base/csv.h"

static status paint(cairo_t *cr, const void *what, fault *f)
{
    return figure_paint(cr, what, NULL, f);
}

status figure_write(const figure *fig, const char *path, fault *f)
{
    assert(fig != NULL && path != NULL);
    picture p = {.dpi = fig->dpi,
                 .title = fig->title,
                 .software = fig->software,
                 .parameters = fig->parameters,
                 .paint = paint,
                 .what = fig};
    figure_size(fig, &p.width, &p.height);
    return picture_write(&p, path, f);
}

// A table in long form.
typedef struct long_form {
    csv_writer csv;
    bool shaded; // with a last column for the colour scale
    bool alike;  // all panels show one quantity: their headings tell them apart
} long_form;

// A name, or without one the label without markup, with its unit.
static void write_name(long_form *t, const char *name, const char *label, const char *unit)
{
    char *plain = name ? g_strdup(name) : text_plain(label ? label : "");
    csv_heading(&t->csv, plain, unit != NULL && unit[0] != '\0' ? unit : NULL);
    g_free(plain);
}

static void write_panel_name(long_form *t, const figure_panel *panel)
{
    if (t->alike && panel->heading != NULL) {
        write_name(t, NULL, panel->heading, NULL);
    } else {
        write_name(t, panel->y.name, panel->y.label, panel->y.unit);
    }
}

// The end of a row.
static void write_point(long_form *t, double x, double y)
{
    csv_number(&t->csv, x);
    csv_number(&t->csv, isfinite(y) ? y : (double)NAN);
    if (t->shaded) {
        csv_number(&t->csv, (double)NAN);
    }
    csv_end_row(&t->csv);
}

// The end of a row that has a value on a colour scale, too.
static void write_shaded_point(long_form *t, double x, double y, double shade)
{
    csv_number(&t->csv, x);
    csv_number(&t->csv, y);
    csv_number(&t->csv, isfinite(shade) ? shade : (double)NAN);
    csv_end_row(&t->csv);
}

static void write_series(long_form *t, const figure_panel *panel, const figure_series *s)
{
    for (size_t i = 0; i < s->count && !ferror(t->csv.stream); i++) {
        if (!isfinite(series_x(s, i))) {
            continue;
        }

        write_panel_name(t, panel);
        write_name(t, s->name, s->label, NULL);
        if (s->shade != NULL) {
            write_shaded_point(t, series_x(s, i), series_y(s, i), series_shade(s, i));
        } else {
            write_point(t, series_x(s, i), series_y(s, i));
        }
    }
}

static void write_map(long_form *t, const figure_panel *panel)
{
    const figure_map *map = panel->map;
    for (size_t i = 0; i < map->columns && !ferror(t->csv.stream); i++) {
        for (size_t j = 0; j < map->rows; j++) {
            write_panel_name(t, panel);
            csv_text(&t->csv, "map");
            write_shaded_point(t, map->x[i], map->y[j], map->z[i * map->rows + j]);
        }
    }
}

static void write_levels_and_impulses(long_form *t, const figure_panel *panel)
{
    for (int i = 0; i < panel->impulse_count; i++) {
        write_panel_name(t, panel);
        write_name(t, "impulse", NULL, panel->impulse_unit);
        write_point(t, panel->impulses[i].x, panel->impulses[i].size);
    }

    // levels go by their label alone
    for (int i = 0; i < panel->level_count; i++) {
        const char *label = panel->levels[i].label;
        write_panel_name(t, panel);
        write_name(t, NULL, label ? label : "level", NULL);
        // a level has no x of its own
        write_point(t, (double)NAN, panel->levels[i].y);
    }
}

// A row that has an x alone.
static void write_instant(long_form *t, const char *panel, const char *series, double x)
{
    csv_text(&t->csv, panel);
    csv_text(&t->csv, series);
    write_point(t, x, (double)NAN);
}

static void write_marks(long_form *t, const figure *fig)
{
    for (int i = 0; i < fig->mark_count; i++) {
        char *label = text_plain(fig->marks[i].label ? fig->marks[i].label : "");
        write_instant(t, "mark", label, fig->marks[i].x);
        g_free(label);
    }
    for (int i = 0; i < fig->interval_count; i++) {
        write_instant(t, "interval", "begins", fig->intervals[i].from);
        write_instant(t, "interval", "ends", fig->intervals[i].to);
    }
}

// Whether all panels show one quantity, so that their column can bear its name and unit.
static bool panels_are_alike(const figure *fig)
{
    bool alike = fig->panels[0].impulse_count == 0;
    for (int i = 1; i < fig->panel_count; i++) {
        const figure_axis *a = &fig->panels[i].y, *first = &fig->panels[0].y;
        alike = alike && fig->panels[i].impulse_count == 0 && a->name != NULL &&
                first->name != NULL && strcmp(a->name, first->name) == 0 &&
                g_strcmp0(a->unit, first->unit) == 0;
    }
    return alike;
}

static void write_axis_heading(long_form *t, const figure_axis *a, const char *otherwise)
{
    bool nameless = a->name == NULL && a->label == NULL;
    write_name(t, nameless ? otherwise : a->name, a->label, a->unit);
}

status figure_write_csv(const figure *fig, const char *path, fault *f)
{
    assert(fig != NULL && path != NULL);
    whole_file file;
    status code = whole_file_open(&file, path, f);
    if (code != STATUS_OK) {
        return code;
    }

    // the heading: panel, series, and both axes
    long_form t = {.csv = csv_begin(file.stream)};
    csv_heading(&t.csv, "panel", NULL);
    csv_heading(&t.csv, "series", NULL);
    write_axis_heading(&t, &fig->x, "x");
    t.alike = panels_are_alike(fig);
    if (t.alike) {
        write_axis_heading(&t, &fig->panels[0].y, "y");
    } else {
        csv_heading(&t.csv, "value", NULL);
    }
    for (int p = 0; p < fig->panel_count; p++) {
        const figure_colours *colours = fig->panels[p].colours;
        if (colours != NULL) {
            write_axis_heading(&t, &colours->axis, "z");
            t.shaded = true;
            break;
        }
    }
    csv_end_row(&t.csv);

    // panel by panel, then what all share
    for (int p = 0; p < fig->panel_count; p++) {
        const figure_panel *panel = &fig->panels[p];
        for (int s = 0; s < panel->series_count; s++) {
            write_series(&t, panel, &panel->series[s]);
        }
        if (panel->map != NULL) {
            write_map(&t, panel);
        }
        write_levels_and_impulses(&t, panel);
    }
    write_marks(&t, fig);
    return whole_file_commit(&file, f);
}
