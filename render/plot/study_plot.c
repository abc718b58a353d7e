// Pictures of studies, but for sweeps.
#include "render/plot/study_plot.h"

#include <assert.h>
#include <math.h>

#include "render/page/text.h"
#include "src/base/shipped.h"

#define PANEL_WEIGHT    2.4 // of its height
#define RESIDUAL_RADIUS 1.0 // of a point [pt]

// ==== robust: the distribution of the overshoot

// Makes the figure of a study of robustness: for each law the share of the runs that have
// at most an overshoot, over that overshoot.
owned_figure *robust_figure_create(const robust_table *t, const char *changes)
{
    assert(t->count >= 1 && t->count <= ROBUST_MOST_CURVES);
    owned_figure *o =
        owned_figure_create(1,
                            "%s: overshoot of control laws under uncertain parameters%s",
                            t->scenario, changes);

    // a curve for each law: the runs are in the order of their overshoots, so that the
    // share at run k of n is (k + 1)/n
    for (int i = 0; i < t->count; i++) {
        const robust_law *law = &t->laws[i];
        double *share = owned_figure_numbers(o, law->runs);
        for (size_t k = 0; k < law->runs; k++) {
            share[k] = 100 * (double)(k + 1) / (double)law->runs;
        }
        const char *label = owned_figure_keep(o, text_escape(law->law));
        owned_figure_add(o, 0,
                         (figure_series){law->law, label, law->overshoots, share,
                                         law->runs, .colour = palette_slot(i)});
    }

    // from none of the runs to all of them
    o->panels[0].weight = PANEL_WEIGHT;
    o->panels[0].y = (figure_axis){"share", "Runs with at most this overshoot",
                                   .unit = "%", .low = 0, .high = 100};

    // the page
    const char *mean = t->laws[0].by_smoothed > 0 ? " (mean over 5 ms)" : "";
    o->figure.caption =
        owned_figure_printf(o,
                            "%zu runs a law. Overshoot of the force: %s%s. impactlab %s.",
                            t->laws[0].runs, t->laws[0].overshoot_of, mean,
                            lab_version());
    o->figure.x = (figure_axis){"overshoot", "Overshoot over the commanded force",
                                .unit = "%", .room = 0.02};
    return o;
}

// ==== tune: how the search went

// Makes the figure of a tuning: the value of every evaluation, and the least so far.
owned_figure *tune_figure_create(const tuning *t, const char *changes)
{
    owned_figure *o =
        owned_figure_create(1, "%s: tuned%s", t->asked.base->title, changes);
    double *number = owned_figure_numbers(o, t->done);
    double *value = owned_figure_numbers(o, t->done);
    double *least = owned_figure_numbers(o, t->done);

    // each evaluation's value, and the least up to it; one that was refused has none
    double least_so_far = (double)NAN;
    for (size_t i = 0; i < t->done; i++) {
        number[i] = (double)i + 1;
        value[i] = (double)NAN;
        if (t->ranks[i] < TUNE_REFUSED) {
            value[i] = t->ranks[i];
        }
        least_so_far = fmin(least_so_far, value[i]);
        least[i] = least_so_far;
    }
    owned_figure_add(o, 0,
                     (figure_series){"value", "evaluation", number, value, t->done,
                                     .no_line = true, .marker = MARKER_CIRCLE,
                                     .radius = marker_radius(t->done),
                                     .colour = palette_slot(0)});
    owned_figure_add(o, 0,
                     (figure_series){"least", "least so far", number, least, t->done,
                                     .colour = palette_slot(1)});

    // the page
    char *minimised = owned_figure_keep(o, text_escape(t->asked.minimise));
    o->panels[0].weight = PANEL_WEIGHT;
    o->panels[0].y = (figure_axis){.name = "value", .label = minimised, .room = 0.05};
    o->figure.x =
        (figure_axis){.name = "evaluation", .label = "Evaluation", .room = 0.02};
    o->figure.caption =
        owned_figure_printf(o,
                            "%zu evaluations of %zu runs. Evaluations that "
                            "failed or broke a constraint have no point. "
                            "impactlab %s.",
                            t->done, t->each, lab_version());
    return o;
}

// ==== identify: residuals of the fit

// Adds the residuals of a channel to the panel of its trace, a dot for each reading that
// counts. Returns where the residuals of the next channel begin.
static const double *add_channel(owned_figure *o, int panel, const recorded_trace *t,
                                 int channel, const double *residual)
{
    const signal_info *signal = &signal_table[identify_signals[channel]];
    double *x = owned_figure_numbers(o, t->rows);
    double *y = owned_figure_numbers(o, t->rows);
    size_t count = 0;
    for (size_t i = 0; i < t->rows; i++) {
        if (t->deviation[channel][i] > 0) {
            x[count] = t->time[i];
            y[count++] = *residual++;
        }
    }

    owned_figure_add(o, panel,
                     (figure_series){signal->name, signal->symbol, x, y, count,
                                     .colour = palette_slot(channel),
                                     .marker = MARKER_CIRCLE + channel % 4,

                                     .radius = RESIDUAL_RADIUS, .no_line = true});
    return residual;
}

// Makes the figure of an identification: residuals over time, in a panel for each trace.
owned_figure *identify_figure_create(const identification *id)
{
    assert(id->trace_count > 0 && id->trace_count <= FIGURE_PANELS);
    char changes[SCENARIO_CHANGES];
    owned_figure *o =
        owned_figure_create(id->trace_count, "%s: residuals of the fit%s",
                            id->base->title, scenario_changes(id->base, changes));

    // a panel for each trace; residuals stand trace by trace, channel by channel
    const double *residual = id->residual;
    for (int k = 0; k < id->trace_count; k++) {
        const recorded_trace *t = &id->traces[k];
        figure_panel *panel = &o->panels[k];
        for (int c = 0; c < CHANNELS; c++) {
            if (t->reading[c] != NULL) {
                residual = add_channel(o, k, t, c, residual);
            }
        }

        // behind a trace's channels stand those of its contacts, which are not drawn
        residual += t->contact_count;
        g_autofree char *name = g_path_get_basename(t->file);
        panel->heading = owned_figure_keep(o, text_escape(name));
        panel->y = (figure_axis){"residual", "Residual <i>r</i>/<i>σ</i>",
                                 .symbol = "<i>r</i>/<i>σ</i>", .room = 0.05};
    }

    // one legend where all have the first one's channels
    o->figure.common_legend = true;
    for (int k = 1; k < id->trace_count; k++) {
        for (int c = 0; c < CHANNELS; c++) {
            const bool there = id->traces[k].reading[c] != NULL;
            if (there != (id->traces[0].reading[c] != NULL)) {
                o->figure.common_legend = false;
            }
        }
    }
    o->figure.caption = owned_figure_printf(
        o,
        "<i>r</i>: reading less what the fitted arm gives. <i>σ</i>: standard deviation "
        "of the reading, by the noise and the steps of its sensor. impactlab %s.",
        lab_version());
    o->figure.x =
        (figure_axis){.name = "time", .label = "Time", .symbol = "t", .unit = "s"};
    return o;
}
