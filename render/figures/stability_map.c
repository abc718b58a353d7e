#include "render/figures/stability_map.h"

#include <glib.h>
#include <math.h>
#include <string.h>

#include "render/plot/opened_run.h"
#include "render/page/sketch.h"
#include "render/plot/sweep_plot.h"
#include "src/base/whole_file.h"
#include "src/base/csv.h"

#define MAP_SCENARIO "corrected/first-impact"
#define WINDOW       0.15 // length of the force that is compared, from first contact [s]

// Ends of the axes; cells lie evenly between them.
#define BETA_HIGH  0.5
#define BETA_LEAST 0.01 // that a run takes
#define GAMMA_LOW  0.4
#define GAMMA_HIGH 1.0

// Ends of the colour scale [decades of per cent].
#define LEAST_DECADE (-2.0)
#define MOST_DECADE  2.0

enum { PANELS = 3, COLUMNS = 40, ROWS = 30, CELLS = COLUMNS * ROWS, RADII = 3, SAMPLES = 600 };

static const double steps[PANELS] = {5e-3, 1e-3, 2e-4}; // [s]
static const double radii[RADII] = {1, 0.8, 0.5};       // generalised-alpha's rho
static const char *const step_labels[PANELS] = {"5\u2009ms", "1\u2009ms", "0.2\u2009ms"};

typedef struct map {
    sketch_frame frame;
    char *title, *caption, *parameters;
    scenario base;               // borrowed from the reference run while computing
    double from;                 // first contact [s]
    double reference[SAMPLES];   // force of the event method [N]
    double peak;                 // [N]
    double error[PANELS][CELLS]; // of Newmark [%], INFINITY where the run was stopped
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
// ------------------------------------------------------------------------------------

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
    if (cell < CELLS) {
        method.name = METHOD_NEWMARK;
        method.beta = beta_at(cell % COLUMNS);
        method.gamma = gamma_at(cell / COLUMNS);
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
        GThread *helper = g_thread_new("map", compute_jobs, m);
        compute_jobs(m);
        g_thread_join(helper);
    }
    run_end(&run);
    return code;
}

// ---- the picture
// ---------------------------------------------------------------------------------

typedef struct panel_box {
    double x, y, width, height;
} panel_box;

static double beta_x(const panel_box *b, double beta)
{
    return b->x + b->width * beta / BETA_HIGH;
}

static double gamma_y(const panel_box *b, double gamma)
{
    return b->y + b->height * (GAMMA_HIGH - gamma) / (GAMMA_HIGH - GAMMA_LOW);
}

static void use_error_colour(const sketch *s, double error)
{
    double rgb[3], decade = log10(fmax(error, 1e-9));
    double share = (decade - LEAST_DECADE) / (MOST_DECADE - LEAST_DECADE);
    sweep_plot_colour(1 - fmin(1, fmax(0, share)), rgb);
    cairo_set_source_rgb(s->cr, rgb[0], rgb[1], rgb[2]);
}

static void draw_cells(const sketch *s, const map *m, int panel, const panel_box *b)
{
    double width = b->width / COLUMNS, height = b->height / ROWS;
    cairo_save(s->cr);
    // neighbours meet without a seam
    cairo_set_antialias(s->cr, CAIRO_ANTIALIAS_NONE);
    for (int cell = 0; cell < CELLS; cell++) {
        double x = b->x + width * (cell % COLUMNS);
        double y = b->y + b->height - height * (cell / COLUMNS + 1);
        if (isfinite(m->error[panel][cell])) {
            use_error_colour(s, m->error[panel][cell]);
        } else {
            set_colour(s->cr, s->colours->grid);
        }
        cairo_rectangle(s->cr, x, y, width, height);
        cairo_fill(s->cr);
    }
    cairo_restore(s->cr);
}

// Table 3.1: gamma = 1/2 and 2 beta = gamma, dark on a light rim so that they show on every colour.
static void draw_bounds(const sketch *s, const panel_box *b)
{
    const double widths[] = {2.4, 1.0};
    for (int pass = 0; pass < 2; pass++) {
        colour c = pass == 0 ? palette_of(THEME_COLOUR)->page : palette_of(THEME_COLOUR)->text;
        set_colour(s->cr, c);
        set_line_style(s->cr, LINE_SOLID, widths[pass]);
        cairo_move_to(s->cr, beta_x(b, 0.0), gamma_y(b, 0.5));
        cairo_line_to(s->cr, beta_x(b, 0.5), gamma_y(b, 0.5));
        cairo_move_to(s->cr, beta_x(b, 0.25), gamma_y(b, 0.5));
        cairo_line_to(s->cr, beta_x(b, 0.5), gamma_y(b, 1.0));
        cairo_stroke(s->cr);
    }
    // beta = 1/4, where contact sets its own bound
    set_line_style(s->cr, LINE_DASHED, 0.8);
    cairo_move_to(s->cr, beta_x(b, 0.25), gamma_y(b, GAMMA_LOW));
    cairo_line_to(s->cr, beta_x(b, 0.25), gamma_y(b, GAMMA_HIGH));
    cairo_stroke(s->cr);
}

static void draw_ring(const sketch *s, double x, double y, double error)
{
    cairo_new_path(s->cr);
    cairo_arc(s->cr, x, y, 4, 0, 2 * G_PI);
    if (isfinite(error)) {
        use_error_colour(s, error);
    } else {
        set_colour(s->cr, s->colours->grid);
    }
    cairo_fill_preserve(s->cr);
    set_colour(s->cr, palette_of(THEME_COLOUR)->page);
    set_line_style(s->cr, LINE_SOLID, 2);
    cairo_stroke_preserve(s->cr);
    set_colour(s->cr, palette_of(THEME_COLOUR)->text);
    set_line_style(s->cr, LINE_SOLID, 0.8);
    cairo_stroke(s->cr);
}

static void draw_cross(const sketch *s, double x, double y)
{
    const double widths[] = {2.6, 1.1};
    for (int pass = 0; pass < 2; pass++) {
        set_colour(s->cr,
                   pass == 0 ? palette_of(THEME_COLOUR)->page : palette_of(THEME_COLOUR)->text);
        set_line_style(s->cr, LINE_SOLID, widths[pass]);
        cairo_move_to(s->cr, x - 3, y - 3);
        cairo_line_to(s->cr, x + 3, y + 3);
        cairo_move_to(s->cr, x - 3, y + 3);
        cairo_line_to(s->cr, x + 3, y - 3);
        cairo_stroke(s->cr);
    }
}

// The pair (beta, gamma) of generalised-alpha with spectral radius rho.
static void alpha_pair(double rho, double *beta, double *gamma)
{
    double am = (2 * rho - 1) / (rho + 1), af = rho / (rho + 1);
    *gamma = 0.5 - am + af;
    *beta = 0.25 * (1 - am + af) * (1 - am + af);
}

static void draw_axes(sketch *s, const panel_box *b, int panel)
{
    char text[64];
    set_colour(s->cr, s->colours->axis);
    set_line_style(s->cr, LINE_SOLID, 0.6);
    cairo_rectangle(s->cr, b->x, b->y, b->width, b->height);
    cairo_stroke(s->cr);
    for (int i = 0; i <= 5; i++) {
        double x = beta_x(b, 0.1 * i), bottom = b->y + b->height;
        sketch_line(s, x, bottom, x, bottom + 3, 0.6, SKETCH_INK);
        if (i % 2 == 0) {
            snprintf(text, sizeof text, "%.1f", 0.1 * i);
            sketch_text(s, x, bottom + 4, 0.5, 0, text, SKETCH_SMALL);
        }
    }
    for (int i = 0; i <= 6; i++) {
        double y = gamma_y(b, 0.4 + 0.1 * i);
        sketch_line(s, b->x, y, b->x - 3, y, 0.6, SKETCH_INK);
        if (panel == 0) {
            snprintf(text, sizeof text, "%.1f", 0.4 + 0.1 * i);
            sketch_text(s, b->x - 5, y, 1, 0.5, text, SKETCH_SMALL);
        }
    }
    sketch_text(s, b->x + b->width / 2, b->y + b->height + 14, 0.5, 0, "<i>β</i>", SKETCH_LABEL);
    snprintf(text, sizeof text, "<i>h</i> = %s", step_labels[panel]);
    sketch_text(s, b->x + b->width / 2, b->y - 3, 0.5, 1, text, SKETCH_LABEL);
    if (panel == 0) {
        sketch_text(s, b->x - 22, b->y + b->height / 2, 1, 0.5, "<i>γ</i>", SKETCH_LABEL);
    }
}

static void draw_panel(sketch *s, const map *m, int panel, const panel_box *b)
{
    cairo_save(s->cr);
    cairo_rectangle(s->cr, b->x, b->y, b->width, b->height);
    cairo_clip(s->cr);
    set_colour(s->cr, s->colours->page);
    cairo_paint(s->cr);
    draw_cells(s, m, panel, b);
    draw_bounds(s, b);
    cairo_restore(s->cr);
    draw_cross(s, beta_x(b, 0.4), gamma_y(b, 0.5));
    for (int i = 0; i < RADII; i++) {
        double beta, gamma;
        alpha_pair(radii[i], &beta, &gamma);
        draw_ring(s, beta_x(b, beta), gamma_y(b, gamma), m->alpha[panel][i]);
    }
    draw_axes(s, b, panel);
}

static void draw_bar(sketch *s, double x, double y, double width)
{
    enum { PIECES = 120 };
    cairo_save(s->cr);
    cairo_set_antialias(s->cr, CAIRO_ANTIALIAS_NONE);
    for (int i = 0; i < PIECES; i++) {
        double share = (i + 0.5) / PIECES;
        use_error_colour(s, pow(10, LEAST_DECADE + share * (MOST_DECADE - LEAST_DECADE)));
        cairo_rectangle(s->cr, x + width * i / PIECES, y, width / PIECES + 0.2, 9);
        cairo_fill(s->cr);
    }
    cairo_restore(s->cr);
    static const char *const labels[] = {"0.01", "0.1", "1", "10", "100"};
    for (int i = 0; i < 5; i++) {
        double at = x + width * i / 4;
        sketch_line(s, at, y + 9, at, y + 12, 0.6, SKETCH_INK);
        sketch_text(s, at, y + 13, 0.5, 0, labels[i], SKETCH_SMALL);
    }
    sketch_text(s, x + width + 12, y + 4.5, 0, 0.5, "error of the force (%)", SKETCH_SMALL);
    set_colour(s->cr, s->colours->grid);
    cairo_rectangle(s->cr, x - 90, y, 14, 9);
    cairo_fill(s->cr);
    sketch_text(s, x - 72, y + 4.5, 0, 0.5, "run stopped", SKETCH_SMALL);
}

static void draw_key(sketch *s, double x, double y)
{
    draw_cross(s, x + 4, y);
    sketch_text(s, x + 12, y, 0, 0.5, "the thesis: 0.4, 0.5", SKETCH_SMALL);
    draw_ring(s, x + 110, y, (double)INFINITY);
    sketch_text(s, x + 118, y, 0, 0.5, "generalised-alpha, <i>ρ</i> = 1, 0.8, 0.5 from below",
                SKETCH_SMALL);
}

static status paint_map(cairo_t *cr, const void *what, figure_report *report, fault *f)
{
    sketch s;
    const map *m = what;
    status code = sketch_begin(&s, cr, &m->frame, report, f);
    if (code != STATUS_OK) {
        return code;
    }
    double gap = 12, left = s.left + 34, width = (s.right - left - 2 * gap) / PANELS;
    for (int i = 0; i < PANELS; i++) {
        panel_box b = {left + i * (width + gap), s.top + 14, width, 120};
        draw_panel(&s, m, i, &b);
    }
    draw_key(&s, left - 4, s.top + 172);
    draw_bar(&s, left + 92, s.top + 188, 130);
    sketch_end(&s);
    return STATUS_OK;
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
    for (int panel = 0; panel < PANELS; panel++) {
        for (int cell = 0; cell < CELLS; cell++) {
            write_line(&csv, "newmark", steps[panel], beta_at(cell % COLUMNS),
                       gamma_at(cell / COLUMNS), m->error[panel][cell]);
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
    m->caption = g_strdup_printf(
        "Newmark's method on the corrected arm (corrected/first-impact, 1\u2009V). Error: root of "
        "the mean square difference of the contact force from the event method's over the "
        "%g\u2009ms after first contact, in per cent of its peak. Lines: <i>γ</i> = ½ and "
        "2<i>β</i> = <i>γ</i>, between which Table 3.1 promises stability at any step; dashed: "
        "<i>β</i> = ¼, below which the constraint of the contact makes accelerations grow from "
        "step to step, whatever <i>γ</i>. A run is stopped when its energy no longer balances. "
        "Rings have the colour of their own method's error.",
        1e3 * WINDOW);
    m->frame = (sketch_frame){m->title, m->caption, 212, o->width_mm, o->theme};
    *out = (artwork){.title = m->title,
                     .parameters = m->parameters,
                     .what = m,
                     .paint = paint_map,
                     .write_csv = write_map,
                     .release = release_map};
    sketch_size(&m->frame, &out->width, &out->height);
    return STATUS_OK;
}
