// Maps over Newmark's two parameters: one number of a run for every pair, at three
// settings side by side.
#include <assert.h>
#include <math.h>

#include "render/figures/figures.h"

enum {
    MAP_PANELS = 3,
    MAP_COLUMNS = 40, // most of a map
    MAP_ROWS = 30,
    MAP_RINGS = 3,
    SAMPLES = 600 // of a force
};

typedef struct newmark_map newmark_map;

// What a map shows.
typedef struct newmark_kind {
    const char *change; // of the figure's scenario, for the run of reference
    double extra_time;  // by which the cells' runs outlast the window [s]
    int columns, rows;  // of cells
    const char *headings[MAP_PANELS]; // markup
    figure_axis scale;                // of the numbers; low values are bright
    // the number of a pair in a panel, from a run of its own on any thread; not finite if
    // the run failed
    double (*value)(const newmark_map *m, int panel, double beta, double gamma);
} newmark_kind;

// A map with everything its figure borrows.
struct newmark_map {
    const newmark_kind *kind;
    scenario base;         // of the run of reference, which the plot owns
    double from, peak;     // of its first pulse: first contact [s] and force [N]
    double force[SAMPLES]; // in the window [N]

    owned_figure *plot;                        // owns this
    double beta[MAP_COLUMNS], gamma[MAP_ROWS]; // middles of the cells
    double values[MAP_PANELS][MAP_COLUMNS * MAP_ROWS];
    double ring_beta[MAP_RINGS], ring_gamma[MAP_RINGS];
    double ring_value[MAP_PANELS][MAP_RINGS];
    int next; // next cell to be computed
};

// Ends of the axes; cells lie evenly between them.
#define BETA_HIGH  0.5
#define BETA_LEAST 0.01 // that a run takes
#define GAMMA_LOW  0.4
#define GAMMA_HIGH 1.0

#define WEIGHT     1.4  // of a panel's height
#define WINDOW     0.15 // length of the force that is looked at, from first contact [s]

// ---- what lies over the cells

// Adds a series to every panel; if it has shades, each panel's are its own rings' values.
static void add_layer(newmark_map *m, figure_series layer)
{
    for (int panel = 0; panel < MAP_PANELS; panel++) {
        if (layer.shade != NULL) {
            layer.shade = m->ring_value[panel];
        } else {
            layer.shade = NULL;
        }
        owned_figure_add(m->plot, panel, layer);
    }
}

// ---- the runs

// Computes cells of a map until none is left (a thread's function). Several threads share
// a map: each takes the next cell from the counter.
static gpointer compute_cells(gpointer data)
{
    newmark_map *m = data;
    const int rows = m->kind->rows, cells = m->kind->columns * rows,
              count = MAP_PANELS * cells;

    // from the last panel back, whose runs take longest, so that threads end together
    for (int taken = g_atomic_int_add(&m->next, 1); taken < count;
         taken = g_atomic_int_add(&m->next, 1)) {
        int job = count - 1 - taken, panel = job / cells, cell = job % cells;
        m->values[panel][cell] =
            m->kind->value(m, panel, m->beta[cell / rows], m->gamma[cell % rows]);
    }
    return NULL;
}

// Sets the middles of the cells, adds the lines over them, and computes the cells on two
// threads.
static void compute_map(newmark_map *m)
{
    const int columns = m->kind->columns, rows = m->kind->rows;
    assert(columns > 1 && columns <= MAP_COLUMNS && rows > 1 && rows <= MAP_ROWS);
    for (int i = 0; i < columns; i++) {
        m->beta[i] = fmax(BETA_LEAST, BETA_HIGH * (i + 0.5) / columns);
    }
    for (int i = 0; i < rows; i++) {
        m->gamma[i] = GAMMA_LOW + (GAMMA_HIGH - GAMMA_LOW) * (i + 0.5) / rows;
    }

    // Table 3.1: gamma = 1/2 and 2 beta = gamma; beta = 1/4, where contact sets its own
    // bound; and the pair of the thesis
    static const double bound_x[] = {0, 0.5, (double)NAN, 0.25, 0.5};
    static const double bound_y[] = {0.5, 0.5, (double)NAN, 0.5, 1};
    static const double quarter_x[] = {0.25, 0.25}, quarter_y[] = {GAMMA_LOW, GAMMA_HIGH};
    static const double thesis_x[] = {0.4}, thesis_y[] = {0.5};

    add_layer(m, (figure_series){"bounds", "Table 3.1", .x = bound_x, .y = bound_y,
                                 .count = 5, .colour = SLOT_BLACK, .rim = true});
    add_layer(m, (figure_series){"contact", "<i>β</i> = ¼", .x = quarter_x,
                                 .y = quarter_y, .count = 2, .colour = SLOT_BLACK,
                                 .style = LINE_DASHED, .rim = true});
    add_layer(m, (figure_series){"thesis", "the thesis: 0.4, 0.5", .x = thesis_x,
                                 .y = thesis_y, .count = 1, .marker = MARKER_CROSS,
                                 .radius = 3, .no_line = true, .rim = true});
    GThread *helper = g_thread_new("map", compute_cells, m);
    compute_cells(m);
    g_thread_join(helper);
}

// ---- the picture

// Describes the figure: panels side by side with one vertical axis and one colour bar.
static void describe_map_figure(newmark_map *m, const figure_options *o)
{
    const newmark_kind *kind = m->kind;
    for (int panel = 0; panel < MAP_PANELS; panel++) {
        figure_panel *p = &m->plot->panels[panel];
        p->heading = kind->headings[panel];
        p->y = (figure_axis){"gamma", "<i>γ</i>", .low = GAMMA_LOW, .high = GAMMA_HIGH};
        p->weight = WEIGHT;
        p->map = OWNED(m->plot, figure_map, m->beta, m->gamma,
                       .columns = (size_t)kind->columns, .rows = (size_t)kind->rows,
                       .z = m->values[panel]);
        p->colours = OWNED(m->plot, figure_colours, .axis = kind->scale, .reversed = true,
                           .bar = panel == MAP_PANELS - 1);
    }

    figure *fig = &m->plot->figure;
    fig->x =
        (figure_axis){.name = "beta", .label = "<i>β</i>", .low = 0, .high = BETA_HIGH};
    fig->columns = MAP_PANELS;
    fig->common_legend = fig->shared_y = true;
    figure_take_look(fig, &o->look);
}

// Makes a map whose cells are not yet computed, and the run of reference. NULL, with the
// run's status or, if the run has no pulse of force, with STATUS_BAD_SCENARIO.
static newmark_map *newmark_map_create(const newmark_kind *kind,
                                       const figure_order *order, const opened_run **run,
                                       fault *f)
{
    owned_figure *o = run_plot_create(order, kind->change, MAP_PANELS, run, f);
    if (o == NULL) {
        return NULL;
    }
    newmark_map *m = owned_figure_keep(o, g_new0(newmark_map, 1));
    m->plot = o;
    m->kind = kind;
    m->base = (*run)->scenario;
    m->from = (*run)->result.summary.first_contact_s;
    m->peak = (*run)->result.summary.first_pulse_peak_N;
    m->base.parameters.run.duration = m->from + WINDOW + kind->extra_time;
    if (!isfinite(m->from) || !(m->peak > 0)) {
        fault_set(f, STATUS_BAD_SCENARIO, "%s: no pulse of the contact force to compare",
                  order->which->scenario);
        owned_figure_destroy(o);
        return NULL;
    }
    describe_map_figure(m, order->options);
    return m;
}

// ==== the figures

// ---- the corrected arm: error of the force

static const double steps[MAP_PANELS] = {5e-3, 1e-3, 2e-4}; // [s]
static const double radii[MAP_RINGS] = {1, 0.8, 0.5};       // generalised-alpha's rho

// Force at evenly spaced instants of the window.
static void sample_force(const trace *t, double from, double *out)
{
    for (int i = 0; i < SAMPLES; i++) {
        out[i] =
            trace_value(t, SIGNAL_INDEX(force), from + WINDOW * (i + 0.5) / SAMPLES, 0);
    }
}

// Runs a method and returns the root of the mean square difference of its force from the
// reference, in per cent of the reference's peak; infinite if the run fails.
static double force_error(const newmark_map *m, const method_parameters *method)
{
    run_result result;
    double force[SAMPLES], sum = 0;

    scenario s = m->base;
    s.parameters.method = *method;
    if (run_scenario(&s, true, &result) != STATUS_OK) {
        run_finish(&result);
        return (double)INFINITY;
    }

    sample_force(&result.trace, m->from, force);
    run_finish(&result);

    for (int i = 0; i < SAMPLES; i++) {
        sum += (force[i] - m->force[i]) * (force[i] - m->force[i]);
    }
    return 100 * sqrt(sum / SAMPLES) / m->peak;
}

// The error of Newmark's method with a pair (beta, gamma), at the step of a panel.
static double newmark_error(const newmark_map *m, int panel, double beta, double gamma)
{
    method_parameters method = m->base.parameters.method;
    method.name = METHOD_NEWMARK;
    method.step = steps[panel];
    method.beta = beta;
    method.gamma = gamma;
    return force_error(m, &method);
}

// Adds rings with the errors of the generalised-alpha method. With the spectral radius
// rho it has
//
//     am = (2 rho - 1)/(rho + 1),    af = rho/(rho + 1),
//     gamma = 1/2 - am + af,         beta = (1 - am + af)^2/4
static void add_rings(newmark_map *m)
{
    method_parameters method = m->base.parameters.method;
    method.name = METHOD_GENERALIZED_ALPHA;
    for (int i = 0; i < MAP_RINGS; i++) {
        double rho = radii[i], am = (2 * rho - 1) / (rho + 1), af = rho / (rho + 1);
        m->ring_gamma[i] = 0.5 - am + af;
        m->ring_beta[i] = 0.25 * (1 - am + af) * (1 - am + af);
        method.spectral_radius = rho;
        for (int panel = 0; panel < MAP_PANELS; panel++) {
            method.step = steps[panel];
            m->ring_value[panel][i] = force_error(m, &method);
        }
    }

    add_layer(m, (figure_series){"generalized-alpha",
                                 "generalised-alpha, <i>ρ</i> = 1, 0.8, 0.5 from below",
                                 m->ring_beta, m->ring_gamma, MAP_RINGS,
                                 .shade = m->ring_value[0], .marker = MARKER_CIRCLE,
                                 .radius = 3.6, .no_line = true, .rim = true});
}

// Makes the map of the error of Newmark's force against the event method's, for the
// corrected arm.
status stability_map(const figure_order *order, artwork *out, fault *f)
{
    static const newmark_kind kind = {.change = "method.name=event",
                                      .extra_time = 0.01,
                                      .columns = MAP_COLUMNS,
                                      .rows = MAP_ROWS,
                                      .headings = {"<i>h</i> = 5\u2009ms",
                                                   "<i>h</i> = 1\u2009ms",
                                                   "<i>h</i> = 0.2\u2009ms"},
                                      .scale = {.name = "force_error",
                                                .label = "Error of the force",
                                                .unit = "%",
                                                .scale = SCALE_LOGARITHMIC,
                                                .low = 0.01,
                                                .high = 100},
                                      .value = newmark_error};
    const opened_run *run;
    newmark_map *m = newmark_map_create(&kind, order, &run, f);
    if (m == NULL) {
        return f->code;
    }
    m->plot->figure.caption = owned_figure_printf(
        m->plot,
        "Newmark's method on the corrected arm (corrected/first-impact, 1\u2009V). "
        "Error: root of the mean square difference of the contact force from the event "
        "method's over the %g\u2009ms after first contact, in per cent of its peak. "
        "Lines: <i>γ</i> = ½ and 2<i>β</i> = <i>γ</i>, between which Table 3.1 "
        "promises stability at any step; dashed: <i>β</i> = ¼, below which the "
        "constraint of the contact makes accelerations grow from step to step, "
        "whatever <i>γ</i>. Hatched: the run was stopped because its energy no longer "
        "balanced. Rings have the colour of their own method's error.",
        1e3 * WINDOW);

    sample_force(&run->result.trace, m->from, m->force);
    compute_map(m);
    add_rings(m);
    *out = artwork_of_owned(m->plot);
    return STATUS_OK;
}

// ---- the printed arm: its largest force

// Runs of the algorithm in a step of contact, and its length [s], from left to right.
static const struct {
    listing_reevaluation reevaluation;
    double step;
} printed_settings[MAP_PANELS] = {{REEVALUATE_RHS, 1e-3},
                                  {REEVALUATE_NONE, 1e-3},
                                  {REEVALUATE_NONE, 2e-4}};

// The largest force of a run with a pair (beta, gamma), over that of Fig. 3.4.
static double printed_peak(const newmark_map *m, int panel, double beta, double gamma)
{
    run_result result;
    scenario s = m->base;
    s.parameters.printed.reevaluation = printed_settings[panel].reevaluation;
    s.parameters.method.step = printed_settings[panel].step;
    s.parameters.method.beta = beta;
    s.parameters.method.gamma = gamma;
    status code = run_scenario(&s, false, &result);
    double force = (double)INFINITY;
    if (code == STATUS_OK) {
        force = result.summary.peak_force_N / m->peak;
    }
    run_finish(&result);
    return force;
}

// Makes the map of the largest force of the printed arm.
status printed_stability_map(const figure_order *order, artwork *out, fault *f)
{
    static const newmark_kind kind = {.columns = 20,
                                      .rows = 15,
                                      .headings = {"two runs, <i>h</i> = 1\u2009ms",
                                                   "one run, 1\u2009ms",
                                                   "one run, 0.2\u2009ms"},
                                      .scale = {.name = "largest_force",
                                                .label = "Peak over that of Fig. 3.4",
                                                .scale = SCALE_LOGARITHMIC,
                                                .low = 0.5,
                                                .high = 500},
                                      .value = printed_peak};
    const opened_run *run;
    newmark_map *m = newmark_map_create(&kind, order, &run, f);
    if (m == NULL) {
        return f->code;
    }
    m->plot->figure.caption = owned_figure_printf(
        m->plot,
        "The printed model (thesis/fig-3-4, 1\u2009V), largest contact force of the "
        "%g\u2009ms after first contact, in times the %.3g\u2009N of Fig. 3.4. Two "
        "runs: accelerations and force are computed once more from the constraint's "
        "second derivative (3.13), the thesis's remedy. One run: without it no pair "
        "gives a usable force, and a shorter step makes it worse, because the impulse "
        "of the impact is delivered within one step. Lines as in the map of the "
        "corrected arm. Hatched: the equations of a step became singular.",
        1e3 * WINDOW, m->peak);

    compute_map(m);
    *out = artwork_of_owned(m->plot);
    return STATUS_OK;
}
