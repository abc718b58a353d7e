#include "render/figures/newmark_map.h"

#include <assert.h>
#include <glib.h>
#include <math.h>

// Ends of the axes; cells lie evenly between them.
#define BETA_HIGH  0.5
#define BETA_LEAST 0.01 // that a run takes
#define GAMMA_LOW  0.4
#define GAMMA_HIGH 1.0

#define WEIGHT     1.4 // of a panel's height

// ---- what lies over the cells

// The same layer in every panel.
static void add_layer(newmark_map *m, figure_series layer)
{
    assert(m->layer_count < MAP_LAYERS);
    for (int panel = 0; panel < MAP_PANELS; panel++) {
        m->layers[panel][m->layer_count] = layer;
        if (layer.shade != NULL) {
            m->layers[panel][m->layer_count].shade = m->ring_value[panel];
        }
    }
    m->layer_count++;
}

void newmark_map_add_rings(newmark_map *m, const char *name, const char *label)
{
    assert(m != NULL && name != NULL && label != NULL);
    add_layer(m, (figure_series){.name = name,
                                 .label = label,
                                 .x = m->ring_beta,
                                 .y = m->ring_gamma,
                                 .shade = m->ring_value[0],
                                 .count = MAP_RINGS,
                                 .marker = MARKER_CIRCLE,
                                 .radius = 3.6,
                                 .no_line = true,
                                 .rim = true});
}

// Table 3.1: gamma = 1/2 and 2 beta = gamma; beta = 1/4, where contact sets its own bound; and the
// pair of the thesis.
static void add_bounds(newmark_map *m)
{
    static const double bound_x[] = {0, 0.5, (double)NAN, 0.25, 0.5};
    static const double bound_y[] = {0.5, 0.5, (double)NAN, 0.5, 1};
    static const double quarter_x[] = {0.25, 0.25}, quarter_y[] = {GAMMA_LOW, GAMMA_HIGH};
    static const double thesis_x[] = {0.4}, thesis_y[] = {0.5};

    add_layer(m, (figure_series){.name = "bounds",
                                 .label = "Table 3.1",
                                 .x = bound_x,
                                 .y = bound_y,
                                 .count = 5,
                                 .colour = 6,
                                 .rim = true});
    add_layer(m, (figure_series){.name = "contact",
                                 .label = "<i>β</i> = ¼",
                                 .x = quarter_x,
                                 .y = quarter_y,
                                 .count = 2,
                                 .colour = 6,
                                 .style = LINE_DASHED,
                                 .rim = true});
    add_layer(m, (figure_series){.name = "thesis",
                                 .label = "the thesis: 0.4, 0.5",
                                 .x = thesis_x,
                                 .y = thesis_y,
                                 .count = 1,
                                 .marker = MARKER_CROSS,
                                 .radius = 3,
                                 .no_line = true,
                                 .rim = true});
}

// ---- the runs

static gpointer compute_cells(gpointer data)
{
    newmark_map *m = data;
    const int cells = m->columns * m->rows, count = MAP_PANELS * cells;

    // the longest runs, of the last panel, first: so both threads end together
    for (int taken = g_atomic_int_add(&m->next, 1); taken < count;
         taken = g_atomic_int_add(&m->next, 1)) {
        int job = count - 1 - taken, panel = job / cells, cell = job % cells;
        m->values[panel][cell] =
            m->value(m->context, panel, m->beta[cell / m->rows], m->gamma[cell % m->rows]);
    }
    return NULL;
}

void newmark_map_compute(newmark_map *m)
{
    assert(m != NULL && m->value != NULL);
    assert(m->columns > 1 && m->columns <= MAP_COLUMNS && m->rows > 1 && m->rows <= MAP_ROWS);
    for (int i = 0; i < m->columns; i++) {
        m->beta[i] = fmax(BETA_LEAST, BETA_HIGH * (i + 0.5) / m->columns);
    }
    for (int i = 0; i < m->rows; i++) {
        m->gamma[i] = GAMMA_LOW + (GAMMA_HIGH - GAMMA_LOW) * (i + 0.5) / m->rows;
    }

    add_bounds(m);
    GThread *helper = g_thread_new("map", compute_cells, m);
    compute_cells(m);
    g_thread_join(helper);
}

// ---- the picture

static void describe_panel(newmark_map *m, int panel)
{
    m->maps[panel] = (figure_map){.x = m->beta,
                                  .y = m->gamma,
                                  .columns = (size_t)m->columns,
                                  .rows = (size_t)m->rows,
                                  .z = m->values[panel]};
    m->colours[panel] =
        (figure_colours){.axis = m->scale, .reversed = m->reversed, .bar = panel == MAP_PANELS - 1};
    m->panels[panel] = (figure_panel){
        .heading = m->headings[panel],
        .y = {.name = "gamma", .label = "<i>γ</i>", .low = GAMMA_LOW, .high = GAMMA_HIGH},
        .weight = WEIGHT,
        .map = &m->maps[panel],
        .colours = &m->colours[panel],
        .series = m->layers[panel],
        .series_count = m->layer_count};
}

// Frees a map and its context.
static void newmark_map_destroy(void *what)
{
    newmark_map *m = what;
    if (m->release != NULL) {
        m->release(m->context);
    }
    g_free(m->title);
    g_free(m->caption);
    g_free(m->parameters);
    g_free(m);
}

artwork newmark_map_open(newmark_map *m, const figure_options *o)
{
    assert(m != NULL && o != NULL && m->title != NULL);
    for (int panel = 0; panel < MAP_PANELS; panel++) {
        describe_panel(m, panel);
    }

    m->figure = (figure){.title = m->title,
                         .caption = m->caption,
                         .x = {.name = "beta", .label = "<i>β</i>", .low = 0, .high = BETA_HIGH},
                         .panels = m->panels,
                         .panel_count = MAP_PANELS,
                         .columns = MAP_PANELS,
                         .common_legend = true,
                         .shared_y = true,
                         .parameters = m->parameters};
    figure_take_look(&m->figure, &o->look);

    artwork drawn = artwork_of_figure(&m->figure, m, newmark_map_destroy);
    drawn.cells = true;
    return drawn;
}
