// The map of section 3.1.3: how good the contact force is for every (beta, gamma) of Newmark's
// method, at several steps.
#include "render/figures/figures.h"

#include <glib.h>
#include <math.h>
#include <string.h>

#include "render/page/text.h"
#include "render/plot/opened_run.h"
#include "src/base/csv.h"
#include "src/base/whole_file.h"

#define MAP_SCENARIO "corrected/first-impact"
#define WINDOW       0.15 // length of the force that is compared, from first contact [s]

// Ends of the axes; cells lie evenly between them.
#define BETA_HIGH  0.5
#define BETA_LEAST 0.01 // that a run takes
#define GAMMA_LOW  0.4
#define GAMMA_HIGH 1.0

// Ends of the colour scale [%].
#define LEAST_ERROR 0.01
#define MOST_ERROR  100.0

#define WEIGHT      1.4 // of a panel's height

enum { PANELS = 3, SERIES = 4, COLUMNS = 40, ROWS = 30, CELLS = COLUMNS * ROWS, RADII = 3 };
enum { SAMPLES = 600 };

static const double steps[PANELS] = {5e-3, 1e-3, 2e-4}; // [s]
static const double radii[RADII] = {1, 0.8, 0.5};       // generalised-alpha's rho
static const char *const step_labels[PANELS] = {"<i>h</i> = 5\u2009ms", "<i>h</i> = 1\u2009ms",
                                                "<i>h</i> = 0.2\u2009ms"};

typedef struct map {
    figure figure;
    figure_panel panels[PANELS];
    figure_series series[PANELS][SERIES];
    figure_map maps[PANELS];
    figure_colours colours[PANELS];
    double beta[COLUMNS], gamma[ROWS]; // middles of the cells
    double alpha_beta[RADII], alpha_gamma[RADII];
    char *title, *caption, *parameters;
    scenario base;               // borrowed from the reference run while computing
    double from;                 // first contact [s]
    double reference[SAMPLES];   // force of the event method [N]
    double peak;                 // [N]
    double error[PANELS][CELLS]; // of Newmark [%], by column; INFINITY where the run was stopped
    double alpha[PANELS][RADII]; // of generalised-alpha [%]
    gint next;                   // job to be taken
} map;

static double beta_at(int column)
{
    return fmax(BETA_LEAST, BETA_HIGH * (column + 0.5) / COLUMNS);
}

static double gamma_at(int row)
{
    return GAMMA_LOW + (GAMMA_HIGH - GAMMA_LOW) * (row + 0.5) / ROWS;
}

// ---- the runs

// Force at evenly spaced instants of the window, straight lines between rows.
static void sample_force(const trace *t, double from, double *out)
{
    size_t row = 0;
    for (int i = 0; i < SAMPLES; i++) {
        double time = from + WINDOW * (i + 0.5) / SAMPLES;
        while (row + 1 < t->row_count && t->rows[row + 1].time <= time) {
            row++;
        }
        const sample *a = &t->rows[row];
        const sample *b = row + 1 < t->row_count ? a + 1 : a;
        double span = b->time - a->time, share = span > 0 ? (time - a->time) / span : 0;
        out[i] = a->force + share * (b->force - a->force);
    }
}

// Root of the mean square difference from the reference, in per cent of its peak.
static double force_error(const map *m, const method_parameters *method)
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

    // root of the mean square, in per cent of the peak
    for (int i = 0; i < SAMPLES; i++) {
        sum += (force[i] - m->reference[i]) * (force[i] - m->reference[i]);
    }
    return 100 * sqrt(sum / SAMPLES) / m->peak;
}

static void compute_job(map *m, int job)
{
    int panel = job / (CELLS + RADII), cell = job % (CELLS + RADII);
    method_parameters method = m->base.parameters.method;
    method.step = steps[panel];

    // a cell of Newmark's, or a ring of generalised-alpha
    if (cell < CELLS) {
        method.name = METHOD_NEWMARK;
        method.beta = beta_at(cell / ROWS);
        method.gamma = gamma_at(cell % ROWS);
        m->error[panel][cell] = force_error(m, &method);
    } else {
        method.name = METHOD_GENERALIZED_ALPHA;
        method.spectral_radius = radii[cell - CELLS];
        m->alpha[panel][cell - CELLS] = force_error(m, &method);
    }
}

static gpointer compute_jobs(gpointer data)
{
    map *m = data;
    // the longest runs first, so that both threads end together
    const int jobs = PANELS * (CELLS + RADII);
    for (int taken = g_atomic_int_add(&m->next, 1); taken < jobs;
         taken = g_atomic_int_add(&m->next, 1)) {
        compute_job(m, jobs - 1 - taken);
    }
    return NULL;
}

static status compute_map(map *m, fault *f)
{
    opened_run run;
    status code = run_begin(&run, MAP_SCENARIO, "method.name=event", f);
    if (code != STATUS_OK) {
        return code;
    }

    // the pulse that errors are measured on
    m->from = run.result.summary.first_contact_s;
    m->peak = run.result.summary.first_pulse_peak_N;
    m->parameters = parameters_line(&run.scenario);

    if (!isfinite(m->from) || !(m->peak > 0)) {
        code = fault_set(f, STATUS_BAD_SCENARIO, "%s: no pulse of the contact force to compare",
                         MAP_SCENARIO);
    } else {
        sample_force(&run.result.trace, m->from, m->reference);
        m->base = run.scenario;
        m->base.parameters.run.duration = m->from + WINDOW + 0.01;

        // two threads share the jobs
        GThread *helper = g_thread_new("map", compute_jobs, m);
        compute_jobs(m);
        g_thread_join(helper);
    }

    run_end(&run);
    return code;
}

// ---- the picture

// The pair (beta, gamma) of generalised-alpha with spectral radius rho.
static void alpha_pair(double rho, double *beta, double *gamma)
{
    double am = (2 * rho - 1) / (rho + 1), af = rho / (rho + 1);
    *gamma = 0.5 - am + af;
    *beta = 0.25 * (1 - am + af) * (1 - am + af);
}

// Lines and points over the map, the same in every panel but for the shade of the rings.
static void add_layers(map *m, int panel)
{
    // Table 3.1: gamma = 1/2 and 2 beta = gamma; beta = 1/4, where contact sets its own bound
    static const double bound_x[] = {0, 0.5, (double)NAN, 0.25, 0.5};
    static const double bound_y[] = {0.5, 0.5, (double)NAN, 0.5, 1};
    static const double quarter_x[] = {0.25, 0.25}, quarter_y[] = {GAMMA_LOW, GAMMA_HIGH};
    static const double thesis_x[] = {0.4}, thesis_y[] = {0.5};

    const figure_series layers[SERIES] = {
        {.name = "bounds",
         .label = "Table 3.1",
         .x = bound_x,
         .y = bound_y,
         .count = 5,
         .colour = 6,
         .rim = true},
        {.name = "contact",
         .label = "<i>β</i> = ¼",
         .x = quarter_x,
         .y = quarter_y,
         .count = 2,
         .colour = 6,
         .style = LINE_DASHED,
         .rim = true},
        {.name = "thesis",
         .label = "the thesis: 0.4, 0.5",
         .x = thesis_x,
         .y = thesis_y,
         .count = 1,
         .marker = MARKER_CROSS,
         .radius = 3,
         .no_line = true,
         .rim = true},
        {.name = "generalized-alpha",
         .label = "generalised-alpha, <i>ρ</i> = 1, 0.8, 0.5 from below",
         .x = m->alpha_beta,
         .y = m->alpha_gamma,
         .shade = m->alpha[panel],
         .count = RADII,
         .marker = MARKER_CIRCLE,
         .radius = 3.6,
         .no_line = true,
         .rim = true},
    };

    memcpy(m->series[panel], layers, sizeof layers);
}

static void describe_panel(map *m, int panel)
{
    m->maps[panel] = (figure_map){
        .x = m->beta, .y = m->gamma, .columns = COLUMNS, .rows = ROWS, .z = m->error[panel]};
    m->colours[panel] = (figure_colours){.axis = {.name = "force_error",
                                                  .label = "error of the force",
                                                  .unit = "%",
                                                  .scale = SCALE_LOGARITHMIC,
                                                  .low = LEAST_ERROR,
                                                  .high = MOST_ERROR},
                                         .reversed = true,
                                         .bar = panel == PANELS - 1};

    add_layers(m, panel);

    m->panels[panel] = (figure_panel){
        .heading = step_labels[panel],
        .y = {.name = "gamma", .label = "<i>γ</i>", .low = GAMMA_LOW, .high = GAMMA_HIGH},
        .weight = WEIGHT,
        .map = &m->maps[panel],
        .colours = &m->colours[panel],
        .series = m->series[panel],
        .series_count = SERIES};
}

static void describe_map(map *m, const figure_options *o)
{
    // where the cells and the rings stand
    for (int i = 0; i < COLUMNS; i++) {
        m->beta[i] = BETA_HIGH * (i + 0.5) / COLUMNS;
    }
    for (int i = 0; i < ROWS; i++) {
        m->gamma[i] = gamma_at(i);
    }
    for (int i = 0; i < RADII; i++) {
        alpha_pair(radii[i], &m->alpha_beta[i], &m->alpha_gamma[i]);
    }

    for (int panel = 0; panel < PANELS; panel++) {
        describe_panel(m, panel);
    }

    m->figure = (figure){.title = m->title,
                         .caption = m->caption,
                         .x = {.name = "beta", .label = "<i>β</i>", .low = 0, .high = BETA_HIGH},
                         .panels = m->panels,
                         .panel_count = PANELS,
                         .columns = PANELS,
                         .common_legend = true,
                         .shared_y = true,
                         .parameters = m->parameters};
    figure_take_look(&m->figure, &o->look);
}

static status paint_map(cairo_t *cr, const void *what, figure_report *report, fault *f)
{
    const map *m = what;
    return figure_paint(cr, &m->figure, report, f);
}

static void write_line(csv_writer *csv, const char *method, double h, double beta, double gamma,
                       double error)
{
    csv_text(csv, method);
    csv_number(csv, h);
    csv_number(csv, beta);
    csv_number(csv, gamma);
    csv_number(csv, isfinite(error) ? error : (double)NAN);
    csv_end_row(csv);
}

static status write_map(const void *what, const char *path, fault *f)
{
    whole_file file;
    const map *m = what;
    status code = whole_file_open(&file, path, f);
    if (code != STATUS_OK) {
        return code;
    }

    csv_writer csv = csv_begin(file.stream);
    csv_heading(&csv, "method", "");
    csv_heading(&csv, "step", "s");
    csv_heading(&csv, "beta", "");
    csv_heading(&csv, "gamma", "");
    csv_heading(&csv, "force_error", "%");
    csv_end_row(&csv);

    // cells, then rings
    for (int panel = 0; panel < PANELS; panel++) {
        for (int cell = 0; cell < CELLS; cell++) {
            int column = cell % COLUMNS, row = cell / COLUMNS;
            write_line(&csv, "newmark", steps[panel], beta_at(column), gamma_at(row),
                       m->error[panel][column * ROWS + row]);
        }
        for (int i = 0; i < RADII; i++) {
            double beta, gamma;
            alpha_pair(radii[i], &beta, &gamma);
            write_line(&csv, "generalized-alpha", steps[panel], beta, gamma, m->alpha[panel][i]);
        }
    }

    return whole_file_commit(&file, f);
}

static void release_map(void *what)
{
    map *m = what;
    g_free(m->title);
    g_free(m->caption);
    g_free(m->parameters);
    g_free(m);
}

status stability_map(const char *title, const figure_options *o, artwork *out, fault *f)
{
    map *m = g_new0(map, 1);
    status code = compute_map(m, f);
    if (code != STATUS_OK) {
        release_map(m);
        return code;
    }

    m->title = g_strdup(title);
    m->caption = text_printf(
        "Newmark's method on the corrected arm (corrected/first-impact, 1\u2009V). Error: root of "
        "the mean square difference of the contact force from the event method's over the "
        "%g\u2009ms after first contact, in per cent of its peak. Lines: <i>γ</i> = ½ and "
        "2<i>β</i> = <i>γ</i>, between which Table 3.1 promises stability at any step; dashed: "
        "<i>β</i> = ¼, below which the constraint of the contact makes accelerations grow from "
        "step to step, whatever <i>γ</i>. Hatched: the run was stopped because its "
        "energy no longer balanced. Rings have the colour of their own method's error.",
        1e3 * WINDOW);

    describe_map(m, o);
    *out = (artwork){.title = m->title,
                     .caption = m->caption,
                     .parameters = m->parameters,
                     .cells = true,
                     .what = m,
                     .paint = paint_map,
                     .write_csv = write_map,
                     .release = release_map};

    figure_size(&m->figure, &out->width, &out->height);
    return STATUS_OK;
}
