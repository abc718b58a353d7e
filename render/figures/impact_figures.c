// Figures of one impact: the force pulse, and what the thesis's predictors assume of the
// motion.
#include "render/figures/figures.h"

#include <math.h>

enum { PANELS = 2, ASSUMED_POINTS = 101 };

// A figure of a run's first pulse.
typedef struct impact_figure {
    owned_figure *plot;
    const opened_run *run;
    double contact, peak_time, peak; // first pulse [s], [s], [N]
} impact_figure;

// Runs the scenario and describes what all these figures share, of `panels` panels.
// Without a plot if it fails.
static impact_figure open_impact(const figure_order *order, int panels, fault *f)
{
    impact_figure fig = {.plot = NULL};
    owned_figure *o = run_plot_create(order, NULL, panels, &fig.run, f);
    if (o == NULL) {
        return fig;
    }

    // the pulse that the figure is about
    const summary *m = &fig.run->result.summary;
    fig.contact = m->first_contact_s;
    fig.peak_time = fig.contact + m->first_pulse_time_to_peak_s;
    fig.peak = m->first_pulse_peak_N;
    figure_take_look(&o->figure, &order->options->look);
    if (isfinite(fig.peak_time)) {
        fig.plot = o;
    } else {
        owned_figure_destroy(o);
        fault_set(f, STATUS_BAD_SCENARIO, "%s: no pulse of the contact force to draw",
                  order->which->scenario);
    }
    return fig;
}

// A recorded signal over time, in the rows' own numbers.
static figure_series *add_recorded_signal(impact_figure *fig, int panel, const char *name,
                                          const char *label)
{
    const trace_run rows = {.scenario = &fig->run->scenario,
                            .result = &fig->run->result,
                            .points = true};
    const int index = signal_index(name);
    figure_series *s =
        owned_figure_add(fig->plot, panel, trace_series(&rows, index, fig->plot));
    s->label = label;
    s->style = LINE_SOLID;
    fig->plot->panels[panel].y.name = name;
    fig->plot->panels[panel].y.unit = signal_table[index].unit;
    return s;
}

// ---- the force pulse

// An axis of time from low to high, with marks at first contact and at the peak.
static void show_pulse(impact_figure *fig, double low, double high)
{
    figure_mark *marks = owned_figure_keep(fig->plot, g_new0(figure_mark, 2));
    marks[0] = (figure_mark){fig->contact, "<i>t</i><sub>0</sub>"};
    marks[1] = (figure_mark){fig->peak_time, "<i>t</i><sub>0</sub> + <i>T</i>"};
    fig->plot->figure.marks = marks;
    fig->plot->figure.mark_count = 2;
    fig->plot->figure.x =
        (figure_axis){"time", "Time <i>t</i>", .unit = "s", .low = low, .high = high};
}

// Figure 4.3.
status figure_force_profile(const figure_order *order, artwork *out, fault *f)
{
    impact_figure fig = open_impact(order, 1, f);
    if (fig.plot == NULL) {
        return f->code;
    }
    owned_figure *o = fig.plot;
    figure_panel *panel = &o->panels[0];
    const summary *m = &fig.run->result.summary;

    // a pulse that does not end is shown to its peak
    double pulse = m->first_pulse_s;
    if (!isfinite(pulse)) {
        pulse = fig.peak_time - fig.contact;
    }

    // the force, with room for the measure of T above its peak
    add_recorded_signal(&fig, 0, "force", NULL);
    panel->y.label = "Contact force <i>f</i>";
    panel->weight = 1.7;
    panel->y.low = -0.04 * fig.peak;
    panel->y.high = 1.3 * fig.peak;

    // the impact, with its own axis
    panel->impulses = OWNED(o, figure_impulse, fig.contact, m->contact_impulse_Ns);
    panel->impulse_count = 1;
    panel->impulse_label = "Impulse <i>p</i>";
    panel->impulse_unit = "N s";

    // the peak
    panel->levels =
        OWNED(o, figure_level, fig.peak,
              owned_figure_printf(o, "<i>f</i><sub>max</sub> = %.3g\u2009N", fig.peak));
    panel->level_count = 1;

    // the contact is shaded; its labels stand above the measure of T
    o->figure.marks_above = true;
    o->figure.intervals = OWNED(o, figure_interval, fig.contact, fig.contact + pulse);
    o->figure.interval_count = 1;
    show_pulse(&fig, fig.contact - 0.25 * pulse, fig.contact + 1.25 * pulse);
    o->figure.caption =
        "First pulse of corrected/first-impact, 1\u2009V. The impact is an impulse "
        "that takes no time (arrow, its own axis); the force that follows is finite "
        "and grows to its peak while the beam bends. Shaded: contact.";

    // T stands above the peak, from contact to it
    o->figure.measure =
        OWNED(o, figure_measure, fig.contact, fig.peak_time, 1.13 * fig.peak,
              owned_figure_printf(o, "<i>T</i> = %.1f\u2009ms",
                                  1e3 * (fig.peak_time - fig.contact)));
    *out = artwork_of_owned(o);
    g_clear_pointer(&out->alternative, g_free); // its title says it
    return STATUS_OK;
}

// ---- assumptions of the predictors

// The row just after the impact's jump.
static const sample *row_after(const trace *t)
{
    for (size_t i = 0; i < t->row_count; i++) {
        if (t->rows[i].contact > 0.5) {
            return &t->rows[i];
        }
    }
    return &t->rows[0];
}

// What (4.19) assumes of a body from contact to peak: a velocity that falls to zero in a
// straight line, and the angle that goes with it.
typedef struct assumption {
    double angle, velocity; // just after the impact [rad], [rad/s]
    double period;          // from contact to peak [s]
    bool of_angle;          // whether the angle or the velocity is shown
} assumption;

// The assumed angle or velocity, `since` seconds after first contact.
static double assumed_at(const assumption *a, double since)
{
    if (a->of_angle) {
        return a->angle + a->velocity * (since - since * since / (2 * a->period));
    }
    return a->velocity * (1 - since / a->period);
}

// The assumed motion from contact to peak as a dashed curve.
static void add_assumption(impact_figure *fig, int panel, const assumption *a,
                           const char *label)
{
    double *x = owned_figure_numbers(fig->plot, ASSUMED_POINTS);
    double *y = owned_figure_numbers(fig->plot, ASSUMED_POINTS);

    // the assumed course, from the contact on
    for (int i = 0; i < ASSUMED_POINTS; i++) {
        double since = a->period * i / (ASSUMED_POINTS - 1);
        x[i] = fig->contact + since;
        y[i] = assumed_at(a, since);
    }

    // dashed, as it is no result of the run
    owned_figure_add(fig->plot, panel,
                     (figure_series){"assumed", label, .x = x, .y = y,
                                     .count = ASSUMED_POINTS, .colour = SLOT_VERMILLION,
                                     .style = LINE_DASHED});
}

// Largest distance of a recorded signal from the assumption between contact and peak.
static double departure(const impact_figure *fig, const char *name, const assumption *a)
{
    const trace *t = &fig->run->result.trace;
    const int index = signal_index(name);
    double most = 0;
    for (size_t i = 0; i < t->row_count; i++) {
        double since = t->rows[i].time - fig->contact;
        if (t->rows[i].contact > 0.5 && since >= 0 && since <= a->period) {
            most =
                fmax(most, fabs(signal_value(&t->rows[i], index) - assumed_at(a, since)));
        }
    }
    return most;
}

// What a figure shows of the assumed motion: velocities or angles, of the first link and
// of the last one.
typedef struct assumed_kind {
    bool of_angle;
    const char *signals[PANELS], *labels[PANELS];
    const char *approximation; // in the legend
    const char *sentence;      // of the caption
    const char *unit;
} assumed_kind;

static const assumed_kind assumed_kinds[] = {
    {
        .of_angle = false,
        .signals = {"first_velocity", "last_velocity"},
        .labels = {"Angular velocity <i>θ̇</i><sub>2</sub>",
                   "Angular velocity <i>θ̇</i><sub>3</sub>"},
        .approximation = "linear approximation",
        .sentence = "The predictors assume that velocities fall linearly to zero",
        .unit = "rad/s",
    },
    {
        .of_angle = true,
        .signals = {"first_angle", "last_angle"},
        .labels = {"Angle <i>θ</i><sub>2</sub>", "Angle <i>θ</i><sub>3</sub>"},
        .approximation = "quadratic approximation (4.19)",
        .sentence = "The angles that follow from velocities falling linearly to zero",
        .unit = "rad",
    },
};

// The computed and the assumed motion of a body in a panel. Returns their largest
// distance. The first panel's legend is that of both, so both have its colours.
static double add_motion(impact_figure *fig, int panel, const assumed_kind *kind,
                         const assumption *a)
{
    const char *computed = NULL, *approximation = NULL;
    if (panel == 0) {
        computed = "computed";
        approximation = kind->approximation;
    }
    const char *name = kind->signals[panel];
    add_recorded_signal(fig, panel, name, computed)->colour = SLOT_BLUE;
    add_assumption(fig, panel, a, approximation);
    fig->plot->panels[panel].y.label = kind->labels[panel];
    return departure(fig, name, a);
}

// Figures 4.4 and 4.5.
status assumed_motion(const figure_order *order, artwork *out, fault *f)
{
    const assumed_kind *kind = &assumed_kinds[order->which->variant];
    impact_figure fig = open_impact(order, PANELS, f);
    if (fig.plot == NULL) {
        return f->code;
    }

    // both links, from where the impact leaves them
    const sample *after = row_after(&fig.run->result.trace);
    const double period = fig.peak_time - fig.contact;
    const assumption first = {after->first_angle, after->first_velocity, period,
                              kind->of_angle};
    const assumption last = {after->last_angle, after->last_velocity, period,
                             kind->of_angle};
    const double of_first = add_motion(&fig, 0, kind, &first);
    const double of_last = add_motion(&fig, 1, kind, &last);

    // the page
    show_pulse(&fig, fig.contact - 0.4 * period, fig.contact + 1.4 * period);
    fig.plot->figure.caption = owned_figure_printf(
        fig.plot,
        "First and last link of corrected/first-impact from first contact to "
        "the peak of the force, <i>T</i> = %.1f\u2009ms. %s. Largest "
        "departure between them: %.2g and %.2g\u2009%s.",
        1e3 * period, kind->sentence, of_first, of_last, kind->unit);
    *out = artwork_of_owned(fig.plot);
    return STATUS_OK;
}
