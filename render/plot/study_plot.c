// Pictures of studies, but for sweeps.
#include "render/plot/study_plot.h"

#include <assert.h>
#include <math.h>

#include "render/page/text.h"
#include "src/base/plain_math.h"
#include "src/base/shipped.h"

#define PANEL_WEIGHT 2.4 // of its height

// ==== robust: the distribution of the overshoot

owned_figure *robust_figure_create(const robust_table *t, const char *changes)
{
    assert(t->count >= 1 && t->count <= ROBUST_MOST_CURVES);
    owned_figure *o =
        owned_figure_create(1, "%s: what the laws make of what they were not told%s",
                            t->scenario, changes);

    // a curve for each law: of the same runs, run i of n, in the order of their
    // overshoots, is at (i + 1)/n
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
    o->panels[0].weight = 2.4;
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

owned_figure *tune_figure_create(const tuning *t, const char *changes)
{
    owned_figure *o = owned_figure_create(1, "%s: tuned%s", t->asked.base->name, changes);
    double *number = owned_figure_numbers(o, t->done),
           *value = owned_figure_numbers(o, t->done);
    double *least = owned_figure_numbers(o, t->done);
    for (size_t i = 0; i < t->done; i++) {
        number[i] = (double)i + 1;
        if (t->ranks[i] < TUNE_REFUSED) {
            value[i] = t->ranks[i];
        } else {
            value[i] = (double)NAN;
        }
        if (i > 0) {
            least[i] = fmin(least[i - 1], value[i]);
        } else {
            least[i] = value[i];
        }
    }

    owned_figure_add(o, 0,
                     (figure_series){"value", "an evaluation", number, value, t->done,
                                     .no_line = true, .marker = MARKER_CIRCLE,
                                     .radius = marker_radius(t->done),
                                     .colour = palette_slot(0)});
    owned_figure_add(o, 0,
                     (figure_series){"least", "the least so far", number, least, t->done,
                                     .colour = palette_slot(1)});
    o->panels[0].weight = PANEL_WEIGHT;
    o->panels[0].y =
        (figure_axis){.name = "value",
                      .label = owned_figure_keep(o, text_escape(t->asked.minimise)),
                      .room = 0.05};
    o->figure.x =
        (figure_axis){.name = "evaluation", .label = "Evaluation", .room = 0.02};
    o->figure.caption = owned_figure_printf(o,
                                            "%zu evaluations of %zu runs. What fails, or "
                                            "is not allowed, has no point. impactlab %s.",
                                            t->done, t->each, lab_version());
    return o;
}

// ==== identify: what the fit leaves of the readings

owned_figure *identify_figure_create(const identification *id)
{
    assert(id->trace_count > 0 && id->trace_count <= FIGURE_PANELS);
    char changes[SCENARIO_CHANGES];
    owned_figure *o =
        owned_figure_create(id->trace_count, "%s: what the fit leaves of the readings%s",
                            id->base->name, scenario_changes(id->base, changes));
    const double *residual = id->residual;
    for (int k = 0; k < id->trace_count; k++) {
        const recorded_trace *t = &id->traces[k];
        figure_panel *panel = &o->panels[k];

        // a dot for each reading that counts
        for (int c = 0; c < CHANNELS; c++) {
            const signal_info *signal = &signal_table[identify_signals[c]];
            if (t->reading[c] == NULL) {
                continue;
            }
            double *x = owned_figure_numbers(o, t->rows),
                   *y = owned_figure_numbers(o, t->rows);
            size_t count = 0;
            for (size_t i = 0; i < t->rows; i++) {
                if (t->deviation[c][i] > 0) {
                    x[count] = t->time[i];
                    y[count++] = *residual++;
                }
            }
            owned_figure_add(o, k,
                             (figure_series){signal->name, signal->symbol, x, y, count,
                                             .colour = palette_slot(c),
                                             .marker = MARKER_CIRCLE, .radius = 0.5,
                                             .no_line = true});
        }
        residual += t->contact_count;
        panel->heading = owned_figure_keep(o, g_markup_escape_text(t->file, -1));
        panel->y = (figure_axis){"residual", "Residual over its deviation",
                                 .symbol = "r/σ", .room = 0.05};
    }

    o->figure.x =
        (figure_axis){.name = "time", .label = "Time", .symbol = "t", .unit = "s"};
    return o;
}

// ==== linear: Bode and Nyquist

#define PI  3.14159265358979323846
#define FAR 3.0 // what is farther from the origin is not drawn in the plane

enum { CIRCLE = 121 };

owned_figure *bode_figure_create(const scenario *s, const linear_curve *curves, int count)
{
    assert(count >= 1 && count <= FIGURE_PANELS);
    char changes[SCENARIO_CHANGES];
    owned_figure *o = owned_figure_create(2, "%s: frequency response%s", s->name,
                                          scenario_changes(s, changes));
    for (int k = 0; k < count; k++) {
        const linear_response *r = &curves[k].response;
        const size_t n = (size_t)r->count;
        double *x = owned_figure_numbers(o, n);
        double *y[2] = {owned_figure_numbers(o, n),
                        owned_figure_numbers(o, n)}; // gain, phase

        // the phase goes on where it turns beyond half a revolution
        double turns = 0, before = 0;
        for (size_t i = 0; i < n; i++) {
            const double at = carg(r->gain[i]);
            if (i > 0 && at - before > PI) {
                turns += -1;
            } else if (i > 0 && at - before < -PI) {
                turns += 1;
            }
            before = at;
            x[i] = r->frequency[i] / (2 * PI);
            y[0][i] = 20 * plain_log(cabs(r->gain[i])) / plain_log(10);
            if (r->gain[i] != 0) {
                y[1][i] = at * 180 / PI + 360 * turns;
            } else {
                y[1][i] = (double)NAN;
            }
        }
        for (int panel = 0; panel < 2; panel++) {
            owned_figure_add(o, panel,
                             (figure_series){curves[k].name, curves[k].name, x, y[panel],
                                             n, .colour = palette_slot(k)});
            o->panels[panel].weight = 1.2;
        }
    }
    o->panels[0].y = (figure_axis){.name = "gain", .label = "Gain", .unit = "dB"};
    o->panels[1].y = (figure_axis){.name = "phase", .label = "Phase", .unit = "°"};
    o->panels[1].keyless = true;
    o->figure.x =
        (figure_axis){"frequency", "Frequency", .unit = "Hz", .scale = SCALE_LOGARITHMIC};
    return o;
}

owned_figure *nyquist_figure_create(const scenario *s, const linear_response *loop)
{
    static const double critical[] = {-1, 0};
    const size_t n = (size_t)loop->count;
    char changes[SCENARIO_CHANGES];
    owned_figure *o = owned_figure_create(1, "%s: loop gain in the plane%s", s->name,
                                          scenario_changes(s, changes));
    double *x = owned_figure_numbers(o, n), *y = owned_figure_numbers(o, n);
    double *circle_x = owned_figure_numbers(o, CIRCLE),
           *circle_y = owned_figure_numbers(o, CIRCLE);
    for (size_t i = 0; i < n; i++) {
        const bool near = cabs(loop->gain[i]) < FAR;
        if (near) {
            x[i] = creal(loop->gain[i]);
        } else {
            x[i] = (double)NAN;
        }
        if (near) {
            y[i] = cimag(loop->gain[i]);
        } else {
            y[i] = (double)NAN;
        }
    }
    for (int i = 0; i < CIRCLE; i++) {
        circle_x[i] = cos(2 * PI * i / (CIRCLE - 1));
        circle_y[i] = sin(2 * PI * i / (CIRCLE - 1));
    }

    // the loop gain, where its size is one, and the point that it keeps away from
    owned_figure_add(o, 0, (figure_series){"loop", "loop gain", x, y, n});
    owned_figure_add(o, 0,
                     (figure_series){"circle", "size 1", circle_x, circle_y, CIRCLE,
                                     .colour = SLOT_BLACK, .style = LINE_DASHED});
    owned_figure_add(o, 0,
                     (figure_series){"critical", "−1", critical, critical + 1, 1,
                                     .colour = SLOT_VERMILLION, .marker = MARKER_CROSS,
                                     .radius = 3, .no_line = true});
    o->panels[0].weight = 3.2;
    o->panels[0].y =
        (figure_axis){.name = "imaginary", .label = "Imaginary part", .room = 0.05};
    o->figure.x = (figure_axis){.name = "real", .label = "Real part", .room = 0.05};
    o->figure.width = 120;
    return o;
}
