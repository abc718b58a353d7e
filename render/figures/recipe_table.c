// Tables of a recipe: curves and maps from the columns of a sweep's database.
#include "render/figures/recipe_figure.h"

#include <math.h>
#include <stdlib.h>

#include "render/page/text.h"
#include "src/tables/summary.h"

const char *recipe_label(recipe_figure *fig, const recipe_source *s)
{
    return recipe_own(fig, text_escape(s->label != NULL ? s->label : s->name));
}

int recipe_colour(int index)
{
    static const int colours[] = {0, 5, 2, 4, 1, 3, 7};
    return colours[index % (int)G_N_ELEMENTS(colours)];
}

figure_axis recipe_column_axis(recipe_figure *fig, const char *key)
{
    int parameter = parameter_find(key), quantity = summary_find(key);
    const char *words = parameter >= 0  ? parameter_table[parameter].description
                        : quantity >= 0 ? summary_table[quantity].label
                                        : NULL;

    // what neither table describes goes by its own name, without a unit
    char *label = words != NULL ? text_label(words) : g_strdup(key);
    figure_axis axis = {.name = key,
                        .label = recipe_own(fig, text_escape(label)),
                        .unit = parameter >= 0  ? parameter_table[parameter].unit
                                : quantity >= 0 ? summary_table[quantity].unit
                                                : ""};
    g_free(label);
    return axis;
}

static void add_curve(recipe_figure *fig, int panel, int source)
{
    static const marker_kind markers[] = {MARKER_CIRCLE, MARKER_SQUARE, MARKER_TRIANGLE,
                                          MARKER_DIAMOND};
    figure_panel *p = &fig->panels[panel];
    const opened_source *s = &fig->sources[source];

    // more curves than a panel has room for are left out
    if (p->series_count == PANEL_SERIES) {
        return;
    }

    // points are marked while they are few enough to be told apart
    fig->series[panel][p->series_count] =
        (figure_series){.name = fig->recipe.sources[source].name,
                        .label = recipe_label(fig, &fig->recipe.sources[source]),
                        .x = s->columns[0],
                        .y = s->columns[1],
                        .count = s->count,
                        .colour = recipe_colour(p->series_count),
                        .marker = s->count > 80 ? MARKER_NONE : markers[p->series_count % 4]};
    p->series_count++;
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// The different values of a column, ascending. Returns their number.
static size_t different_values(const double *column, size_t count, double *out)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        out[i] = column[i];
    }
    qsort(out, count, sizeof *out, ascending);
    for (size_t i = 0; i < count; i++) {
        if (kept == 0 || out[i] != out[kept - 1]) {
            out[kept++] = out[i];
        }
    }
    return kept;
}

static size_t place_among(const double *values, size_t count, double value)
{
    const double *found = bsearch(&value, values, count, sizeof *values, ascending);
    return (size_t)(found - values);
}

// Cells over the grid that the first two columns make; a point without a run is hatched.
static void describe_cells(recipe_figure *fig, int panel, const opened_source *s)
{
    figure_map *map = &fig->maps[panel];
    size_t cells = map->columns * map->rows;
    double *z = recipe_own(fig, g_new(double, cells));

    // the map goes column by column; cells that no run fills keep no number
    for (size_t i = 0; i < cells; i++) {
        z[i] = (double)NAN;
    }
    for (size_t i = 0; i < s->count; i++) {
        size_t column = place_among(map->x, map->columns, s->columns[0][i]);
        size_t row = place_among(map->y, map->rows, s->columns[1][i]);
        z[column * map->rows + row] = s->columns[2][i];
    }
    map->z = z;
    map->contours = true;
    fig->panels[panel].map = map;
}

static void add_map(recipe_figure *fig, int panel, int source)
{
    const opened_source *s = &fig->sources[source];
    const recipe_source *from = &fig->recipe.sources[source];
    figure_panel *p = &fig->panels[panel];
    double *x = recipe_own(fig, g_new(double, s->count + 1));
    double *y = recipe_own(fig, g_new(double, s->count + 1));
    size_t columns = different_values(s->columns[0], s->count, x);
    size_t rows = different_values(s->columns[1], s->count, y);

    fig->colours[panel] = (figure_colours){.axis = recipe_column_axis(fig, from->z), .bar = true};
    p->colours = &fig->colours[panel];
    fig->maps[panel] = (figure_map){.x = x, .y = y, .columns = columns, .rows = rows};

    // values that were drawn at random make no grid: dots with their shade
    if (columns * rows <= 2 * s->count && columns > 1 && rows > 1) {
        describe_cells(fig, panel, s);
        return;
    }
    fig->series[panel][p->series_count++] = (figure_series){.name = from->name,
                                                            .x = s->columns[0],
                                                            .y = s->columns[1],
                                                            .shade = s->columns[2],
                                                            .count = s->count,
                                                            .no_line = true,
                                                            .marker = MARKER_CIRCLE,
                                                            .radius = 2.4};
}

void recipe_add_table(recipe_figure *fig, int panel, int source)
{
    bool empty = fig->panels[panel].map == NULL && fig->panels[panel].series_count == 0;
    if (fig->recipe.sources[source].z == NULL) {
        add_curve(fig, panel, source);
    } else if (empty && fig->sources[source].count > 0) {
        add_map(fig, panel, source);
    }
}
