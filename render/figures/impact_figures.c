// Figures of one impact: the force pulse, and what the thesis's predictors assume of the motion.
#include "render/figures/figures.h"

#include <math.h>

#include "render/figures/run_figure.h"

enum { PANELS = 2, ASSUMED_POINTS = 101, MARKS = 2 };

// A figure of a run's first pulse, owned by its plot.
typedef struct impact_figure {
    owned_figure *plot;
    figure_level peak_level;
    figure_mark marks[MARKS];
    figure_interval interval;
    figure_impulse impulse;
    figure_measure measure;
    const opened_run *run;
    double contact, peak_time, peak; // first pulse [s], [s], [N]
} impact_figure;

// Runs the scenario and describes what all these figures share. NULL if it fails.
static impact_figure *new_impact(const figure_order *order, fault *f)
{
    const char *of = order->which->scenario;
    opened_run *run = run_open(of, NULL, f);
    FAIL_IF(run == NULL, NULL);

    // the pulse that the figure is about
    const summary *m = &run->result.summary;
    const double at = m->first_contact_s + m->first_pulse_time_to_peak_s;
    if (!isfinite(at)) {
        fault_set(f, STATUS_BAD_SCENARIO, "%s: no pulse of the contact force to draw", of);
        run_close(run);
        return NULL;
    }

    owned_figure *o = owned_figure_create(PANELS, "%s", order->title);
    owned_figure_own(o, run, run_close);
    o->figure.parameters = owned_figure_keep(o, parameters_line(&run->scenario));
    figure_take_look(&o->figure, &order->options->look);
    impact_figure *fig = owned_figure_keep(o, g_new(impact_figure, 1));
    *fig = (impact_figure){.plot = o,
                           .run = run,
                           .contact = m->first_contact_s,
                           .peak_time = at,
                           .peak = m->first_pulse_peak_N};
    return fig;
}

static void add_series(impact_figure *fig, int panel, figure_series s)
{
    fig->plot->series[panel][fig->plot->panels[panel].series_count++] = s;
}

// A recorded signal over time, in the rows' own numbers.
static void add_signal(impact_figure *fig, int panel, const char *name, const char *label)
{
    const trace_run rows = {
        .scenario = &fig->run->scenario, .result = &fig->run->result, .points = true};
    figure_series s = trace_series(&rows, signal_index(name), fig->plot);
    s.label = label;
    s.style = LINE_SOLID;
    add_series(fig, panel, s);
    fig->plot->panels[panel].y.name = name;
    fig->plot->panels[panel].y.unit = signal_table[signal_index(name)].unit;
}

// ---- the force pulse

// An axis of time from low to high, with marks at first contact and at the peak.
static void show_pulse(impact_figure *fig, double low, double high)
{
    fig->marks[0] = (figure_mark){fig->contact, "<i>t</i><sub>0</sub>"};
    fig->marks[1] = (figure_mark){fig->peak_time, "<i>t</i><sub>0</sub> + <i>T</i>"};
    fig->plot->figure.marks = fig->marks;
    fig->plot->figure.mark_count = 2;

    fig->plot->figure.x =
        (figure_axis){"time", "Time <i>t</i>", .unit = "s", .low = low, .high = high};
}

status figure_force_profile(const figure_order *order, artwork *out, fault *f)
{
    impact_figure *fig = new_impact(order, f);
    if (fig == NULL) {
        return f->code;
    }

    const summary *m = &fig->run->result.summary;
    figure_panel *panel = &fig->plot->panels[0];
    double pulse = isfinite(m->first_pulse_s) ? m->first_pulse_s : fig->peak_time - fig->contact;
    add_signal(fig, 0, "force", NULL);
    panel->y.label = "Contact force <i>f</i>";
    panel->weight = 1.7;
    panel->y.low = -0.04 * fig->peak;
    panel->y.high = 1.3 * fig->peak;

    // the impact, with its own axis
    fig->impulse = (figure_impulse){fig->contact, m->contact_impulse_Ns};
    panel->impulses = &fig->impulse;
    panel->impulse_count = 1;
    panel->impulse_label = "Impulse <i>p</i>";
    panel->impulse_unit = "N s";

    fig->peak_level = (figure_level){
        fig->peak,
        owned_figure_printf(fig->plot, "<i>f</i><sub>max</sub> = %.3g\u2009N", fig->peak)};
    panel->levels = &fig->peak_level;
    panel->level_count = 1;

    // the contact is shaded; its labels stand above the measure of T
    fig->interval = (figure_interval){fig->contact, fig->contact + pulse};
    fig->plot->figure.marks_above = true;
    fig->plot->figure.intervals = &fig->interval;
    fig->plot->figure.interval_count = 1;

    show_pulse(fig, fig->contact - 0.25 * pulse, fig->contact + 1.25 * pulse);
    fig->plot->figure.panel_count = 1;
    fig->plot->figure.caption =
        "First pulse of corrected/first-impact, 1\u2009V. The impact is an impulse that takes no "
        "time (arrow, its own axis); the force that follows is finite and grows to its peak while "
        "the beam bends. Shaded: contact.";

    // T stands above the peak, from contact to it
    fig->measure = (figure_measure){fig->contact, fig->peak_time, 1.13 * fig->peak,
                                    owned_figure_printf(fig->plot, "<i>T</i> = %.1f\u2009ms",
                                                        1e3 * (fig->peak_time - fig->contact))};
    fig->plot->figure.measure = &fig->measure;
    *out = artwork_of_owned(fig->plot);
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

// What (4.19) assumes of a body from contact to peak: a velocity that falls to zero in a straight
// line, and the angle that goes with it.
typedef struct assumption {
    double angle, velocity; // just after the impact [rad], [rad/s]
    double period;          // from contact to peak [s]
    bool of_angle;          // whether the angle or the velocity is shown
} assumption;

// The assumed angle or velocity, `since` seconds after first contact.
static double assumed_at(const assumption *a, double since)
{
    return a->of_angle ? a->angle + a->velocity * (since - since * since / (2 * a->period))
                       : a->velocity * (1 - since / a->period);
}

static void add_assumption(impact_figure *fig, int panel, const assumption *a, const char *label)
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
    add_series(fig, panel,
               (figure_series){"assumed", label, .x = x, .y = y, .count = ASSUMED_POINTS,
                               .colour = 5, .style = LINE_DASHED});
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
            most = fmax(most, fabs(signal_value(&t->rows[i], index) - assumed_at(a, since)));
        }
    }
    return most;
}

status assumed_motion(const figure_order *order, artwork *out, fault *f)
{
    static const char *const signals[2][PANELS] = {{"first_velocity", "last_velocity"},
                                                   {"first_angle", "last_angle"}};
    static const char *const labels[2][PANELS] = {
        {"Angular velocity <i>θ̇</i><sub>2</sub>", "Angular velocity <i>θ̇</i><sub>3</sub>"},
        {"Angle <i>θ</i><sub>2</sub>", "Angle <i>θ</i><sub>3</sub>"}};
    const bool of_angle = order->which->variant == 1;
    impact_figure *fig = new_impact(order, f);
    if (fig == NULL) {
        return f->code;
    }

    // where the assumed motion starts
    const sample *after = row_after(&fig->run->result.trace);
    const double angles[] = {after->first_angle, after->last_angle};
    const double velocities[] = {after->first_velocity, after->last_velocity};

    double most[PANELS], period = fig->peak_time - fig->contact;
    for (int i = 0; i < PANELS; i++) {
        const char *name = signals[of_angle][i];
        add_signal(fig, i, name, i == 0 ? "computed" : NULL);
        // one legend speaks for both panels, so both have its colours
        fig->plot->series[i][0].colour = 0;

        const assumption a = {angles[i], velocities[i], period, of_angle};
        add_assumption(fig, i, &a,
                       i > 0      ? NULL
                       : of_angle ? "quadratic approximation (4.19)"
                                  : "linear approximation");
        most[i] = departure(fig, name, &a);
        fig->plot->panels[i].y.label = labels[of_angle][i];
    }

    show_pulse(fig, fig->contact - 0.4 * period, fig->contact + 1.4 * period);
    fig->plot->figure.panel_count = PANELS;

    fig->plot->figure.caption =
        owned_figure_printf(fig->plot,
                            "First and last link of corrected/first-impact from first contact to "
                            "the peak of the force, <i>T</i> = %.1f\u2009ms. %s. Largest "
                            "departure between them: %.2g and %.2g\u2009%s.",
                            1e3 * period,
                            of_angle ? "The angles that belong to velocities falling to zero in a "
                                       "straight line"
                                     : "The predictors assume that velocities fall to zero in a "
                                       "straight line",
                            most[0], most[1], of_angle ? "rad" : "rad/s");

    *out = artwork_of_owned(fig->plot);
    return STATUS_OK;
}
