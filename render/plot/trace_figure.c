// Figures of recorded runs: panels with the curves of all runs and what is drawn with
// them.
#include "render/plot/trace_plot.h"

#include <assert.h>
#include <math.h>

#include "render/page/text.h"

#define SHORT_PULSE 0.1  // share of the run below which the first pulse is shown enlarged
#define STEP_RADIUS 1.1  // of a point at every step [pt]
#define INSET_SPACE 0.15 // of the pulse, shown before and after it

// ---- curves

// Two readings of one quantity have one colour: the second becomes grey.
static void separate_colours(const figure_panel *panel, figure_series *last)
{
    for (const figure_series *s = panel->series; s != last; s++) {
        if (s->colour == last->colour) {
            last->colour = SLOT_GREY;
        }
    }
}

// A further run stands back: thin and dashed, without a colour that is another's.
static void put_behind(owned_figure *o, figure_series *s, const trace_run *run,
                       bool only_signal)
{
    s->secondary = true;
    s->name = owned_figure_keep(o, g_strconcat(s->name, " ", run->name, NULL));
    if (only_signal) {
        s->colour = SLOT_BLACK;
    } else if (run->brief) {
        s->colour = SLOT_GREY;
    }
}

static void show_as_points(figure_series *s)
{
    s->no_line = true;
    s->secondary = false;
    s->marker = MARKER_CIRCLE;
    s->colour = SLOT_BLACK;
}

// The label of a run's series in a panel, NULL where the legend needs none; `first`: it
// is the run's first there.
static const char *label_of(const trace_figure *t, int panel, int run, int index,
                            bool first)
{
    const trace_run *of = &t->runs[run];
    const bool only_signal = t->panels[panel].signals[1] == NULL;

    // measured data have one name for all their points
    g_autofree char *run_name = text_escape(text_or(of->name, ""));
    if (run > 0 && of->points && !first) {
        return NULL;
    }
    if (run > 0 && of->points) {
        return owned_figure_keep(t->drawn, g_steal_pointer(&run_name));
    }

    // runs are told apart in the first panel, whose legend holds for all
    if (only_signal && t->run_count > 1 && panel == 0) {
        return owned_figure_keep(t->drawn, g_steal_pointer(&run_name));
    }

    // signals are told apart in the first run; one of them speaks for a further run
    if (!only_signal && run == 0) {
        return owned_figure_keep(t->drawn, trace_series_label(of->scenario, index, true));
    }
    if (!only_signal && first) {
        g_autofree char *symbol = trace_series_symbol(of->scenario, index);
        return owned_figure_printf(t->drawn, "%s  %s", symbol, run_name);
    }
    return NULL;
}

// The rank of a run where it is told from another one by its look, as in recipes; 0 where
// the look is the signal's: of a run alone, or beside a panel of several signals.
static int rank_of(const trace_figure *t, int run)
{
    bool told_apart = t->run_count > 1 && !t->runs[1].points;
    for (int i = 0; i < t->drawn->figure.panel_count; i++) {
        told_apart = told_apart && t->panels[i].signals[1] == NULL;
    }
    if (told_apart) {
        return run + 1;
    }
    return 0;
}

// The series of one run in a panel.
static void add_run_curves(const trace_figure *t, int panel, int run)
{
    const trace_run *of = &t->runs[run];
    const trace_panel *from = &t->panels[panel];
    const bool only_signal = from->signals[1] == NULL;
    bool first = true;

    for (int i = 0; i < TRACE_SIGNALS && from->signals[i] != NULL; i++) {
        const int index = signal_index(from->signals[i]);
        const bool left_out = run > 0 && of->brief && i > 0;
        if (left_out || !trace_shows(of, from, index)) {
            continue;
        }

        // as the signal table has it
        figure_series *s =
            owned_figure_add(t->drawn, panel, trace_series(of, index, t->drawn));
        if (of->steps) {
            s->marker = MARKER_CIRCLE;
            s->radius = STEP_RADIUS;
        }

        // as one of several runs
        if (run == 0) {
            separate_colours(&t->drawn->panels[panel], s);
        } else {
            put_behind(t->drawn, s, of, only_signal);
        }

        // with its entry in the legend
        if (run > 0 && of->points) {
            show_as_points(s);
        } else {
            s->run = rank_of(t, run);
        }
        s->label = label_of(t, panel, run, index, first);
        if (run == 0 && !only_signal) {
            s->symbol =
                owned_figure_keep(t->drawn, trace_series_symbol(of->scenario, index));
        }
        first = false;
    }
}

// ---- panels

// Shows a short first pulse once more in an inset.
static void enlarge_pulse(figure_panel *panel, const trace_run *run)
{
    const summary *m = &run->result->summary;
    const double pulse = m->first_pulse_s, contact = m->first_contact_s;
    const double duration = run->scenario->parameters.run.duration;
    if (pulse > 0 && pulse < SHORT_PULSE * duration) {
        panel->zoom_from = fmax(0, contact - INSET_SPACE * pulse);
        panel->zoom_to = fmin(duration, contact + (1 + INSET_SPACE) * pulse);
    }
}

// A panel with its axis, the curves of all runs, and what is drawn with them.
static void describe_trace_panel(const trace_figure *t, int index)
{
    owned_figure *o = t->drawn;
    figure_panel *panel = &o->panels[index];
    const trace_panel *from = &t->panels[index];
    const wall_parameters *wall = &t->runs[0].scenario->parameters.wall;

    // curves of all runs
    panel->y = trace_signal_axis(t, from);
    panel->weight = from->weight;
    for (int run = 0; run < t->run_count; run++) {
        add_run_curves(t, index, run);
    }

    // what is drawn with them
    if (from->impulses) {
        panel->impulses =
            trace_impulses(&t->runs[0].result->trace, &panel->impulse_count, o);
        panel->impulse_label = "Impulse";
        panel->impulse_unit = signal_table[SIGNAL_INDEX(impulse)].unit;
    }
    if (from->wall && wall->kind != WALL_NONE) {
        panel->levels = OWNED(o, figure_level, wall->angle, "wall");
        panel->level_count = 1;
    }
    if (from->inset) {
        enlarge_pulse(panel, &t->runs[0]);
    }
}

// What is shaded: contact, or the controller's second mode by its name.
static char *shading_text(const scenario *s, bool modes)
{
    const char *mode = trace_mode_name(s, 1);
    if (!modes) {
        return g_strdup("contact");
    }
    if (mode == NULL) {
        return g_strdup("second mode");
    }
    return text_printf("%s mode", mode);
}

// Title, caption and panels; marks and shading are those of the first run.
owned_figure *trace_figure_create(const char *title, const trace_panel *panels,
                                  int panel_count, const trace_run *runs, int run_count)
{
    assert(panel_count >= 1 && panel_count <= FIGURE_PANELS);
    assert(run_count >= 1 && run_count <= TRACE_RUNS);
    if (runs[0].rank > 0) {
        return trace_compare_create(title, panels, panel_count, runs, run_count);
    }

    // what is shaded
    bool modes = false;
    for (int i = 0; i < panel_count; i++) {
        modes = modes || panels[i].modes;
    }
    g_autofree char *shading = shading_text(runs[0].scenario, modes);

    // the page
    g_autofree char *own_title = scenario_title(runs[0].scenario);
    owned_figure *o = owned_figure_create(panel_count, "%s", text_or(title, own_title));
    o->figure.caption = owned_figure_keep(o, trace_caption(runs, run_count, shading));
    o->figure.x = (figure_axis){"time", "Time <i>t</i>", .unit = "s"};
    o->figure.parameters = owned_figure_keep(o, parameters_line(runs[0].scenario));

    // panels with the curves of all runs
    const trace_figure t = {o, panels, runs, run_count};
    for (int i = 0; i < panel_count; i++) {
        describe_trace_panel(&t, i);
    }
    trace_add_residuals(&t);

    // marks and shading
    trace_mark_events(o, &runs[0]);
    trace_shade(o, &runs[0].result->trace, modes);
    return o;
}

const trace_panel usual_panels[USUAL_PANELS] = {
    {.signals = {"force"},
     .with_zero = true,
     .impulses = true,
     .inset = true,
     .weight = 1.2},
    {.label = "Angle",
     .signals = {"hub_angle", "first_angle", "last_angle"},
     .wall = true},
    {.label = "Angular velocity",
     .signals = {"hub_velocity", "first_velocity", "last_velocity"}},
    {.label = "Voltage <i>v</i>",
     .signals = {"voltage"},
     .with_zero = true,
     .weight = 0.5},
};

const trace_panel together_panels[USUAL_PANELS] = {
    {.signals = {"force"}, .with_zero = true, .impulses = true},
    {.signals = {"voltage"}, .with_zero = true},
    {.signals = {"hub_angle", "first_angle", "last_angle"}, .wall = true},
    {.signals = {"hub_velocity", "first_velocity", "last_velocity"}},
};

// What drives the arm stands before what comes of it, as run by run the name stands at
// the left.
const trace_panel multiple_panels[MULTIPLE_PANELS] = {
    {.signals = {"voltage"}, .with_zero = true},
    {.signals = {"force"}, .with_zero = true, .impulses = true},
};

// The usual panels, with notes as further marks.
status plot_run(const scenario *s, const run_result *result, const run_result *old,
                const figure_mark *notes, int note_count, const char *path, fault *f)
{
    const trace_run runs[] = {{s, result, "this run"}, {s, old, "old run"}};
    const int run_count = old != NULL ? 2 : 1;
    owned_figure *o =
        trace_figure_create(NULL, usual_panels, USUAL_PANELS, runs, run_count);

    // notes behind the figure's marks
    const int count = o->figure.mark_count;
    figure_mark *all =
        owned_figure_keep(o, g_new0(figure_mark, (gsize)(count + note_count) + 1));
    for (int i = 0; i < count; i++) {
        all[i] = o->figure.marks[i];
    }
    for (int i = 0; i < note_count; i++) {
        char *label = owned_figure_keep(o, g_markup_escape_text(notes[i].label, -1));
        all[count + i] = (figure_mark){.x = notes[i].x, .label = label};
    }
    o->figure.marks = all;
    o->figure.mark_count += note_count;

    status code = figure_write(&o->figure, path, f);
    owned_figure_destroy(o);
    return code;
}
