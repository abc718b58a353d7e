// Figures of the catalogue: how they are opened, described and written.
#include "render/figures/figures.h"

#include <assert.h>
#include <math.h>
#include <string.h>

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
                                     .colour = SLOT_BLUE, .no_line = true,
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

// Appends to the caption of recorded signals what the catalogue says of them.
static void add_caption(owned_figure *drawn, const summary *m, const thesis_figure *which,
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
}

// The ends of the time axis: those of the command line, or else the catalogue's.
static void choose_time_axis(owned_figure *drawn, const thesis_figure *which,
                             const figure_options *o)
{
    figure *fig = &drawn->figure;
    if (which->from < which->to && !(o->from < o->to)) {
        fig->x.low = which->from;
        fig->x.high = which->to;
    }
}

// The panels of a row of the catalogue with its first run and its second one (NULL:
// none).
static owned_figure *draw_signals(const figure_order *order, const opened_run *first,
                                  const opened_run *second, fault *f)
{
    const thesis_figure *which = order->which;
    trace_run runs[2] = {{&first->scenario, &first->result, .steps = which->steps}};
    int count = 1;
    if (second != NULL) {
        runs[0].name = which->second->names[0];
        runs[count++] = (trace_run){&second->scenario, &second->result,
                                    which->second->names[1], .brief = true};
    }

    // without panels of its own those that any run has
    if (which->panels == NULL) {
        return run_figure_create(order->title, NULL, 0, runs, count, order->options, f);
    }
    assert(which->panel_count <= THESIS_PANELS);
    trace_panel panels[THESIS_PANELS];
    memcpy(panels, which->panels, (size_t)which->panel_count * sizeof *panels);
    panels[0].modes = which->modes;
    return run_figure_create(order->title, panels, which->panel_count, runs, count,
                             order->options, f);
}

// Opens it; *of (may be NULL) is the scenario, which the artwork owns.
static status open_signals(const figure_order *order, artwork *out, const scenario **of,
                           fault *f)
{
    const thesis_figure *which = order->which;

    // the scenario, and again with the change of the second run
    opened_run *first = run_open_changed(which->scenario, NULL, 0, order->monitor, f);
    opened_run *second = NULL;
    if (first != NULL && which->second != NULL) {
        second = run_open(which->scenario, which->second->change, f);
    }
    owned_figure *drawn = NULL;
    if (first != NULL && (second != NULL || which->second == NULL)) {
        drawn = draw_signals(order, first, second, f);
    }
    if (drawn == NULL) {
        run_close(first);
        run_close(second);
        return f->code;
    }

    // the figure owns its runs
    owned_figure_own(drawn, first, run_close);
    owned_figure_own(drawn, second, run_close);
    add_caption(drawn, &first->result.summary, which, order->options);
    choose_time_axis(drawn, which, order->options);
    *out = artwork_of_owned(drawn);
    if (of != NULL) {
        *of = &first->scenario;
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

// By its own function, or as recorded signals.
status figure_open(const thesis_figure *which, const figure_options *o, artwork *out,
                   fault *f)
{
    FAULT_IF(which->open != NULL && (o->overlay != NULL || o->signals != NULL), f,
             STATUS_BAD_ARGUMENT,
             "%s shows no recorded signals that %s could choose or lie over", which->id,
             text_or(o->overlay, o->signals));
    FAULT_IF(which->open != NULL && o->zoom.from < o->zoom.to, f, STATUS_BAD_ARGUMENT,
             "%s shows no recorded signals that --zoom could enlarge", which->id);
    g_autofree char *title = numbered_title(which);
    const figure_order order = {which, title, o, NULL};
    if (which->open != NULL) {
        return which->open(&order, out, f);
    }
    return open_signals(&order, out, NULL, f);
}

// Opens the figure once and writes it in every format.
status figure_draw(const char *id, const figure_options *o, const char *folder,
                   const char *formats, FILE *tex, fault *f)
{
    const thesis_figure *which = thesis_figure_find(id);
    FAULT_IF(which == NULL, f, STATUS_BAD_ARGUMENT,
             "there is no figure '%s', expected %s to %s", id, thesis_figure_at(0)->id,
             thesis_figure_at(thesis_figure_count() - 1)->id);

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

    // the caption goes with the first picture, what LaTeX needs with the first one that
    // it reads, numbers with them all
    figure_options beside = *o;
    beside.latex = NULL;
    int of_latex = 0;
    while (list[of_latex] != NULL && picture_format_of(list[of_latex]) == FORMAT_SVG) {
        of_latex++;
    }
    if (list[of_latex] == NULL) {
        of_latex = 0;
    }
    TRY(make_folder(folder, f));
    for (int i = 0; list[i] != NULL; i++) {
        g_autofree char *path = text_printf("%s/%s.%s", folder, which->file, list[i]);
        beside.look.bare = o->look.bare && i == 0;
        TRY(artwork_publish(&drawn, &beside, path, false, f));
        if (i == of_latex && tex != NULL && o->latex != NULL) {
            g_autofree char *text = NULL;
            TRY(artwork_publish_latex(&drawn, o, path, &text, f));
            fputs(text, tex);
        }
    }
    g_autofree char *numbers = text_printf("%s/%s.csv", folder, which->file);
    return artwork_publish_csv(&drawn, numbers, f);
}
