// What the thesis prints in Tables 4.1 to 4.3 as points, the printed model as lines, and
// below them how far each point is from its line.
#include "render/figures/figures.h"

#include "render/plot/drawing.h"

enum { TABLES = 3, QUANTITIES = 3, PANELS = 2 * TABLES };

#define VALUES_WEIGHT    1.5 // of a panel of values
#define RESIDUALS_WEIGHT 0.8
#define POINT_RADIUS     1.9 // [pt]

// A quantity that all three tables have.
typedef struct printed_quantity {
    const char *key, *label; // its name, for the CSV too
    marker_kind marker;
    int colour;
} printed_quantity;

// What a figure shows of them.
typedef struct printed_kind {
    const char *name, *axis, *unit; // of the values
    double scale;                   // from N or s to that unit
    const printed_quantity *quantities;
    int count; // of quantities
} printed_kind;

static const printed_quantity forces[] = {
    {"max_force_energy", "energy principle", MARKER_CIRCLE, SLOT_BLUE},
    {"max_force_dynamics", "impact dynamics", MARKER_SQUARE, SLOT_VERMILLION},
    {"max_force_simulation", "simulation", MARKER_TRIANGLE, SLOT_GREEN}};
static const printed_quantity delays[] = {{"delay_dynamics", "impact dynamics",
                                           MARKER_SQUARE, SLOT_VERMILLION},
                                          {"delay_simulation", "simulation",
                                           MARKER_TRIANGLE, SLOT_GREEN}};
static const printed_kind kinds[] = {{"force", "Peak force", "N", 1, forces, 3},
                                     {"delay", "Delay", "ms", 1e3, delays, 2}};

// A quantity of a table: its points and its line in one panel, and how far the points are
// from it in another.
static void add_quantity(owned_figure *plot, const printed_kind *kind, int index,
                         const double *voltage, const table_row *row, int values_panel,
                         int residuals_panel)
{
    const printed_quantity *of = &kind->quantities[index];
    double *printed = owned_figure_numbers(plot, TABLE_VOLTAGES);
    double *computed = owned_figure_numbers(plot, TABLE_VOLTAGES);
    double *residual = owned_figure_numbers(plot, TABLE_VOLTAGES); // [% of the thesis's]
    for (int i = 0; i < TABLE_VOLTAGES; i++) {
        printed[i] = kind->scale * row->printed[i];
        computed[i] = kind->scale * row->computed[i];
        residual[i] = 100 * (computed[i] / printed[i] - 1);
    }

    // all lines first, so that points lie on them
    const figure_series line = {of->key,          NULL,           voltage,
                                computed,         TABLE_VOLTAGES, .colour = of->colour,
                                .secondary = true};
    const char *name = owned_figure_printf(plot, "%s printed", of->key);
    const figure_series points = {name,
                                  of->label,
                                  voltage,
                                  printed,
                                  TABLE_VOLTAGES,
                                  .colour = of->colour,
                                  .no_line = true,
                                  .marker = of->marker,
                                  .radius = POINT_RADIUS};
    plot->series[values_panel][index] = line;
    plot->series[values_panel][kind->count + index] = points;
    plot->series[residuals_panel][index] = points;
    plot->series[residuals_panel][index].y = residual;
}

// The two panels of a table: values and residuals.
static void add_table_panels(owned_figure *plot, const printed_kind *kind,
                             const double *voltage, const table_row *const *rows,
                             int values_panel, int residuals_panel)
{
    static const figure_level zero = {0};
    for (int i = 0; i < kind->count; i++) {
        add_quantity(plot, kind, i, voltage, rows[i], values_panel, residuals_panel);
    }

    // the names are those of the CSV
    const double factor = rows[0]->k2_factor;
    const char *heading = owned_figure_printf(plot, "Table %s: <i>k</i><sub>2</sub> × %g",
                                              rows[0]->table, factor);
    const char *name = owned_figure_printf(plot, "%s k2 x %g", kind->name, factor);
    const char *residual = owned_figure_printf(plot, "residual k2 x %g", factor);

    plot->panels[values_panel] = (figure_panel){
        heading,
        .weight = VALUES_WEIGHT,
        .keyless = true,
        .y = {.name = name, .label = kind->axis, .unit = kind->unit, .with_zero = true},
        .series = plot->series[values_panel],
        .series_count = 2 * kind->count};
    plot->panels[residuals_panel] =
        (figure_panel){.weight = RESIDUALS_WEIGHT,
                       .keyless = true,
                       .levels = &zero,
                       .level_count = 1,
                       .y = {.name = residual,
                             .label = "Residual",
                             .unit = "%",
                             .with_zero = true,
                             .room = 0.12},
                       .series = plot->series[residuals_panel],
                       .series_count = kind->count};
}

// Forces or delays of three tables, side by side.
status printed_values_figure(const figure_order *order, artwork *out, fault *f)
{
    static const char *const tables[TABLES] = {"4.1", "4.2", "4.3"};
    static const figure_tick voltages[] = {{1, "1"}, {2, "2"}, {5, "5"}, {10, "10"}};
    const printed_kind *kind = &kinds[order->which->variant];
    const thesis_tables *all = computed_tables(f);
    if (all == NULL) {
        return f->code;
    }

    // the page; 1, 2, 5, 10 V are nearly even on a logarithmic axis
    owned_figure *plot = owned_figure_create(PANELS, "%s", order->title);
    figure *fig = &plot->figure;
    fig->caption = owned_figure_printf(
        plot,
        "Points: printed in Tables 4.1 to 4.3. Dashed: the printed model, "
        "whose constants were inferred from these tables "
        "(docs/explanation/model.md). Residual: the model's value less "
        "the printed one, in per cent of that. %s.",
        picture_software());
    fig->columns = TABLES;
    fig->common_legend = true;
    fig->x = (figure_axis){.name = "voltage",
                           .label = "Voltage",
                           .unit = "V",
                           .scale = SCALE_LOGARITHMIC,
                           .room = 0.06,
                           .ticks = voltages,
                           .tick_count = (int)G_N_ELEMENTS(voltages)};
    figure_take_look(fig, &order->options->look);

    // panels side by side have their residuals in a row below, panels in a column next to
    // them
    int panels_a_table = 2, to_residuals = 1;
    if (figure_columns(fig) == TABLES) {
        panels_a_table = 1;
        to_residuals = TABLES;
    }
    for (int t = 0; t < TABLES; t++) {
        const table_row *rows[QUANTITIES];
        for (int q = 0; q < kind->count; q++) {
            rows[q] = computed_row(all, tables[t], "printed", kind->quantities[q].key);
        }
        const int panel = panels_a_table * t;
        add_table_panels(plot, kind, all->voltage, rows, panel, panel + to_residuals);
    }

    *out = artwork_of_owned(plot);
    return STATUS_OK;
}
