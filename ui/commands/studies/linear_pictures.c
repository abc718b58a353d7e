#include "ui/commands/studies/linear_pictures.h"

#include <math.h>
#include <stdlib.h>

#include "render/page/text.h"
#include "src/base/plain_math.h"
#include "ui/commands/pictures.h"

#define PI 3.14159265358979323846

enum { MOST_CURVES = 3, CIRCLE = 121 };

#define FAR 3.0 // what is farther from the origin is not drawn

static char *title_of(const scenario *s, const char *what)
{
    char changes[SCENARIO_CHANGES];
    return text_printf("%s: %s%s", s->name, what, scenario_changes(s, changes));
}

// --- Bode -------------------------------------------------------------------------------------

int plot_bode(const arguments *a, const scenario *s, const linear_curve *curves, int count)
{
    owned_figure o;
    owned_figure_init(&o, NULL, 2);
    for (int k = 0; k < count && k < MOST_CURVES; k++) {
        const linear_response *r = curves[k].response;
        const size_t n = (size_t)r->count;
        double *x = owned_figure_keep(&o, g_new(double, 3 * n + 1)), *gain = x + n,
               *phase = gain + n;

        // the phase goes on where it turns beyond half a revolution
        double turns = 0, before = 0;
        for (size_t i = 0; i < n; i++) {
            const double at = carg(r->gain[i]);
            turns += i > 0 && at - before > PI ? -1 : i > 0 && at - before < -PI ? 1 : 0;
            before = at;
            x[i] = r->frequency[i] / (2 * PI);
            gain[i] = 20 * plain_log(cabs(r->gain[i])) / plain_log(10);
            phase[i] = r->gain[i] != 0 ? at * 180 / PI + 360 * turns : (double)NAN;
        }
        for (int panel = 0; panel < 2; panel++) {
            o.series[panel][k] = (figure_series){.name = curves[k].name,
                                                 .label = curves[k].name,
                                                 .x = x,
                                                 .y = panel == 0 ? gain : phase,
                                                 .count = n,
                                                 .colour = palette_slot(k)};
        }
    }
    for (int panel = 0; panel < 2; panel++) {
        o.panels[panel].series_count = count;
        o.panels[panel].weight = 1.2;
    }
    o.panels[0].y = (figure_axis){.name = "gain", .label = "Gain", .unit = "dB", .with_zero = true};
    o.panels[1].y = (figure_axis){.name = "phase", .label = "Phase", .unit = "°"};
    o.panels[1].legend = LEGEND_NONE;
    o.figure.title = owned_figure_keep(&o, title_of(s, "frequency response"));
    o.figure.x = (figure_axis){
        .name = "frequency", .label = "Frequency", .unit = "Hz", .scale = SCALE_LOGARITHMIC};
    const int code = publish_figure(a, &o.figure);
    owned_figure_finish(&o);
    return code;
}

// --- Nyquist ----------------------------------------------------------------------------------

int plot_nyquist(const arguments *a, const scenario *s, const linear_response *loop)
{
    const size_t n = (size_t)loop->count;
    owned_figure o;
    owned_figure_init(&o, NULL, 1);
    double *x = owned_figure_keep(&o, g_new(double, 2 * n + 2 * CIRCLE + 2));
    double *y = x + n, *circle_x = y + n, *circle_y = circle_x + CIRCLE;
    for (size_t i = 0; i < n; i++) {
        const bool near = cabs(loop->gain[i]) < FAR;
        x[i] = near ? creal(loop->gain[i]) : (double)NAN;
        y[i] = near ? cimag(loop->gain[i]) : (double)NAN;
    }
    for (int i = 0; i < CIRCLE; i++) {
        const double at = 2 * PI * i / (CIRCLE - 1);
        circle_x[i] = cos(at);
        circle_y[i] = sin(at);
    }

    // the loop gain, where its size is one, and the point that it keeps away from
    static const double critical_x[] = {-1}, critical_y[] = {0};
    o.series[0][0] = (figure_series){
        .name = "loop", .label = "loop gain", .x = x, .y = y, .count = n, .colour = 0};
    o.series[0][1] = (figure_series){.name = "circle",
                                     .label = "size 1",
                                     .x = circle_x,
                                     .y = circle_y,
                                     .count = CIRCLE,
                                     .colour = 6,
                                     .style = LINE_DASHED};
    o.series[0][2] = (figure_series){.name = "critical",
                                     .label = "−1",
                                     .x = critical_x,
                                     .y = critical_y,
                                     .count = 1,
                                     .colour = 5,
                                     .marker = MARKER_CROSS,
                                     .radius = 3,
                                     .no_line = true};
    o.panels[0].series_count = 3;
    o.panels[0].weight = 3.2;
    o.panels[0].y = (figure_axis){.name = "imaginary", .label = "Imaginary part", .room = 0.05};
    o.figure.x = (figure_axis){.name = "real", .label = "Real part", .room = 0.05};
    o.figure.title = owned_figure_keep(&o, title_of(s, "loop gain in the plane"));
    o.figure.width = 120;
    arguments there = *a;
    there.plot = a->nyquist;
    const int code = publish_figure(&there, &o.figure);
    owned_figure_finish(&o);
    return code;
}

// --- the map ----------------------------------------------------------------------------------

static figure_axis axis_of(const sweep_axis *axis)
{
    return (figure_axis){.name = axis->name,
                         .label = axis->name,
                         .unit = sweep_axis_parameter(axis)->unit,
                         .scale = axis->logarithmic ? SCALE_LOGARITHMIC : SCALE_LINEAR};
}

int plot_stability(const arguments *a, const sweep *s, const double *growth, const double *settling)
{
    static const char *const headings[] = {"linear, without friction", "runs, with friction"};
    const sweep_axis *x = &s->axes[0], *y = &s->axes[s->axis_count - 1];
    owned_figure o;
    owned_figure_init(&o, NULL, 2);
    figure_map maps[2];
    figure_colours colours[2];
    for (int panel = 0; panel < 2; panel++) {
        const double *z = panel == 0 ? growth : settling;
        const figure_axis axis =
            panel == 0
                ? (figure_axis){.name = "growth",
                                .label = "Growth of the slowest part",
                                .unit = "1/s"}
                : (figure_axis){.name = "settling_time", .label = "Settling time", .unit = "s"};
        o.panels[panel].heading = headings[panel];
        o.panels[panel].weight = 1.6;
        if (s->axis_count == 1) {
            o.series[panel][0] = (figure_series){.name = axis.name,
                                                 .x = x->values,
                                                 .y = z,
                                                 .count = s->run_count,
                                                 .colour = palette_slot(0)};
            o.panels[panel].series_count = 1;
            o.panels[panel].y = axis;
            o.panels[panel].y.with_zero = true;
            continue;
        }
        maps[panel] = (figure_map){.x = x->values,
                                   .y = y->values,
                                   .columns = x->count,
                                   .rows = y->count,
                                   .z = z,
                                   .contours = panel == 0};
        colours[panel] = (figure_colours){.axis = axis, .reversed = true, .bar = true};
        o.panels[panel].y = axis_of(y);
        o.panels[panel].map = &maps[panel];
        o.panels[panel].colours = &colours[panel];
    }
    o.figure.x = axis_of(x);
    o.figure.title = owned_figure_keep(&o, title_of(s->base, "stability of the loop"));
    o.figure.caption = "Unstable where the growth is above zero. Hatched, or a gap: the "
                       "run does not settle.";
    const int code = publish_figure(a, &o.figure);
    owned_figure_finish(&o);
    return code;
}
