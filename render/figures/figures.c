// The catalogue of figures: this file alone knows all of them, and how each is opened.
#include "render/figures/figures.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// Panels that several figures have.
#define FORCE              .signals = {"force"}, .with_zero = true, .inset = true, .weight = 1.6
#define VELOCITY(body)     .signals = {body "_velocity"}
#define ANGLE(body)        .signals = {body "_angle"}, .wall = true
#define ACCELERATION(body) .signals = {body "_acceleration"}
#define ENCODER(other)                                                                   \
    .label = "Hub angle", .signals = {"encoder", other}, .wall = true, .weight = 1.2
#define TACHOMETER(other)                                                                \
    .label = "Hub velocity", .signals = {"tachometer", other}, .weight = 1.2
#define CONTACT(reading)                                                                 \
    .label = "Contact force", .signals = {reading, "force"}, .with_zero = true,          \
    .weight = 1.4
#define COMMAND                                                                          \
    .label = "Command <i>u</i>", .signals = {"command"}, .with_zero = true, .weight = 1.2

// A figure of chapter 3, and one of the virtual rig; each has a scenario of its own name.
#define RUN(number, name)                                                                \
    .id = number, .file = name, .scenario = "thesis/" name,                              \
    .model = "printed; corrected dashed", .beside = "arm.model=corrected",               \
    .names = {"printed", "corrected"}
#define RIG(number, name)                                                                \
    .id = number, .file = name, .scenario = "thesis/" name,                              \
    .model = "corrected, on the rig"

// The time axis of chapter 2 is that of the simulations in figures 3.2 to 3.11.
#define BENCH(number, name) RIG(number, name), .from = 0, .to = 1
// Chapter 5 shades one thing.
#define CONTROL(number, name) RIG(number, name), .modes = true
#define MANY_LINKS            .beside = "arm.links=8", .names = {"2 links", "8 links"}

#define TRACED(...)           {__VA_ARGS__},
#define DRAWN(function, ...)  {.open = function, __VA_ARGS__},
static const thesis_figure thesis_figures[] = {
#include "render/figures/catalogue.inc"
};
#undef TRACED
#undef DRAWN
enum { FIGURES = G_N_ELEMENTS(thesis_figures) };

int thesis_figure_count(void)
{
    return FIGURES;
}

const thesis_figure *thesis_figure_at(int i)
{
    assert(i >= 0);
    if (i < FIGURES) {
        return &thesis_figures[i];
    }
    return NULL;
}

const thesis_figure *thesis_figure_find(const char *id)
{
    for (int i = 0; i < FIGURES; i++) {
        if (g_ascii_strcasecmp(thesis_figures[i].id, id) == 0 ||
            strcmp(thesis_figures[i].file, id) == 0) {
            return &thesis_figures[i];
        }
    }
    return NULL;
}

// ---- recorded signals of the catalogue

// The peak that the thesis prints for the run, as a point; its residual goes into the
// caption.
static void add_printed_peak(owned_figure *o, const summary *m,
                             const thesis_figure *which, GString *caption)
{
    double forces[TABLE_VOLTAGES], delays[TABLE_VOLTAGES];
    int column = which->printed_voltage - 1;
    bool known = tables_printed("4.3", "max_force_simulation", forces) &&
                 tables_printed("4.3", "delay_simulation", delays);
    assert(known && column < TABLE_VOLTAGES);
    (void)known;

    // where the thesis has it: as long after the run's own first contact
    double *peak = owned_figure_numbers(o, 2);
    peak[0] = m->first_contact_s + delays[column];
    peak[1] = forces[column];
    owned_figure_add(o, 0,
                     (figure_series){"Table 4.3", "Table 4.3", peak, peak + 1, 1,
                                     .colour = 5, .no_line = true,
                                     .marker = MARKER_DIAMOND, .radius = 2.6});

    // how far the run is from it
    double more = m->first_pulse_peak_N - forces[column];
    double late = m->first_pulse_time_to_peak_s - delays[column];
    const char *height = more < 0 ? "lower" : "higher";
    const char *delay = late < 0 ? "earlier" : "later";
    text_append(caption,
                " Diamond: the peak of Table 4.3, %.2f\u2009N after %.0f\u2009ms; "
                "that of the printed run's first pulse is %.2f\u2009N %s and comes "
                "%.0f\u2009ms %s.",
                forces[column], 1e3 * delays[column], fabs(more), height,
                1e3 * fabs(late), delay);
}

// What the catalogue adds to a figure of recorded signals.
static void add_facts(owned_figure *drawn, const summary *m, const thesis_figure *which,
                      const figure_options *o)
{
    figure *fig = &drawn->figure;
    GString *caption = g_string_new(fig->caption);
    if (which->note != NULL) {
        text_append(caption, " %s", which->note);
    }
    if (which->steps) {
        g_string_append(caption, " Dots: the steps of the method.");
    }
    if (which->printed_voltage > 0 && o->signals == NULL) {
        add_printed_peak(drawn, m, which, caption);
    }
    fig->caption = owned_figure_keep(drawn, g_string_free(caption, FALSE));

    // a stretch that was asked for on the command line comes first
    if (which->from < which->to && !(o->from < o->to)) {
        fig->x.low = which->from;
        fig->x.high = which->to;
    }
}

// Opens it; *of (may be NULL) is the scenario, which the artwork owns.
static status open_signals(const figure_order *order, artwork *out, const scenario **of,
                           fault *f)
{
    const thesis_figure *which = order->which;
    trace_run runs[2];
    trace_panel panels[THESIS_PANELS];
    opened_run *opened[2] = {
        run_open_changed(which->scenario, NULL, 0, order->monitor, f)};
    owned_figure *drawn = NULL;

    // the scenario, and again with the change of the second run
    const int count = which->beside != NULL ? 2 : 1;
    if (count == 2 && opened[0] != NULL) {
        opened[1] = run_open(which->scenario, which->beside, f);
    }

    // the same panels for each
    if (opened[count - 1] != NULL) {
        for (int i = 0; i < count; i++) {
            runs[i] =
                (trace_run){&opened[i]->scenario, &opened[i]->result, which->names[i],
                            .steps = which->steps && i == 0, .brief = i == 1};
        }
        memcpy(panels, which->panels, sizeof panels);
        panels[0].modes = which->modes;
        const trace_panel *shown = which->panel_count > 0 ? panels : NULL;
        drawn = run_figure_create(order->title, shown, which->panel_count, runs, count,
                                  order->options, f);
    }
    if (drawn == NULL) {
        run_close(opened[0]);
        run_close(opened[1]);
        return f->code;
    }
    owned_figure_own(drawn, opened[0], run_close);
    owned_figure_own(drawn, opened[1], run_close);
    add_facts(drawn, &opened[0]->result.summary, which, order->options);
    *out = artwork_of_owned(drawn);
    if (of != NULL) {
        *of = &opened[0]->scenario;
    }
    return STATUS_OK;
}

status scenario_figure_open(const char *name, run_monitor *monitor, artwork *out,
                            const scenario **s, fault *f)
{
    const thesis_figure run = {.scenario = name};
    const figure_options options = {0};
    return open_signals(&(figure_order){&run, NULL, &options, monitor}, out, s, f);
}

// ---- any figure

// "Fig. 3.4  ...", "Table 4.1  ...", or the caption alone.
static char *numbered_title(const thesis_figure *which)
{
    if (which->id[0] == 'T') {
        return text_printf("Table %s  %s", which->id + 1, which->caption);
    }
    if (g_ascii_isdigit(which->id[0])) {
        return text_printf("Fig. %s  %s", which->id, which->caption);
    }
    return g_strdup(which->caption);
}

status figure_open(const thesis_figure *which, const figure_options *o, artwork *out,
                   fault *f)
{
    FAULT_IF(which->open != NULL && (o->overlay != NULL || o->signals != NULL), f,
             STATUS_BAD_ARGUMENT,
             "%s shows no recorded signals that %s could choose or lie over", which->id,
             text_or(o->overlay, o->signals));
    g_autofree char *title = numbered_title(which);
    const figure_order order = {which, title, o, NULL};
    if (which->open != NULL) {
        return which->open(&order, out, f);
    }
    return open_signals(&order, out, NULL, f);
}

status figure_draw(const char *id, const figure_options *o, const char *folder,
                   const char *formats, FILE *tex, fault *f)
{
    const thesis_figure *which = thesis_figure_find(id);
    FAULT_IF(which == NULL, f, STATUS_BAD_ARGUMENT,
             "there is no figure '%s', expected %s to %s", id, thesis_figures[0].id,
             thesis_figures[FIGURES - 1].id);

    // every format is known before anything is computed
    g_auto(GStrv) list = g_strsplit(formats, ",", -1);
    for (int i = 0; i == 0 || list[i] != NULL; i++) {
        const char *format = text_or(list[i], "");
        FAULT_IF(picture_format_of(format) == FORMAT_NONE, f, STATUS_BAD_ARGUMENT,
                 "there is no figure format '%s', expected png, pdf or svg", format);
    }
    g_auto(artwork) drawn = {0};
    TRY(figure_open(which, o, &drawn, f));
    FAULT_IF(stop_everything, f, STATUS_STOPPED, "%s", status_text(STATUS_STOPPED));

    // caption and what LaTeX needs go with the first picture, numbers with them all
    figure_options beside = *o;
    beside.latex = NULL;
    TRY(make_folder(folder, f));
    for (int i = 0; list[i] != NULL; i++) {
        g_autofree char *path = text_printf("%s/%s.%s", folder, which->file, list[i]);
        beside.look.bare = o->look.bare && i == 0;
        TRY(artwork_publish(&drawn, &beside, path, false, f));
        if (i == 0 && tex != NULL && o->latex != NULL) {
            g_autofree char *text = latex_environment(&drawn, o->latex, path);
            fputs(text, tex);
        }
    }
    g_autofree char *numbers = text_printf("%s/%s.csv", folder, which->file);
    return artwork_publish_csv(&drawn, numbers, f);
}
