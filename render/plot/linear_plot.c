// Pictures of linear systems: Bode and Nyquist.
#include "render/plot/study_plot.h"

#include <assert.h>
#include <math.h>

#include "render/page/palette.h"
#include "render/page/text.h"
#include "src/base/plain_math.h"

#define PI  3.14159265358979323846
#define FAR 3.0 // what is farther from the origin is not drawn in the plane

enum { CIRCLE = 121 };

owned_figure *bode_figure_create(const scenario *s, const linear_curve *curves, int count)
{
    assert(count >= 1 && count <= FIGURE_PANELS);
    char changes[SCENARIO_CHANGES];
    owned_figure *o =
        owned_figure_create(2, "%s: frequency response%s", s->name, scenario_changes(s, changes));
    for (int k = 0; k < count; k++) {
        const linear_response *r = &curves[k].response;
        const size_t n = (size_t)r->count;
        double *x = owned_figure_numbers(o, n);
        double *y[2] = {owned_figure_numbers(o, n), owned_figure_numbers(o, n)}; // gain, phase

        // the phase goes on where it turns beyond half a revolution
        double turns = 0, before = 0;
        for (size_t i = 0; i < n; i++) {
            const double at = carg(r->gain[i]);
            turns += i > 0 && at - before > PI ? -1 : i > 0 && at - before < -PI ? 1 : 0;
            before = at;
            x[i] = r->frequency[i] / (2 * PI);
            y[0][i] = 20 * plain_log(cabs(r->gain[i])) / plain_log(10);
            y[1][i] = r->gain[i] != 0 ? at * 180 / PI + 360 * turns : (double)NAN;
        }
        for (int panel = 0; panel < 2; panel++) {
            o->series[panel][k] = (figure_series){
                curves[k].name, curves[k].name, x, y[panel], n, .colour = palette_slot(k)};
            o->panels[panel].series_count = count;
            o->panels[panel].weight = 1.2;
        }
    }
    o->panels[0].y = (figure_axis){.name = "gain", .label = "Gain", .unit = "dB"};
    o->panels[1].y = (figure_axis){.name = "phase", .label = "Phase", .unit = "°"};
    o->panels[1].keyless = true;
    o->figure.x = (figure_axis){"frequency", "Frequency", .unit = "Hz", .scale = SCALE_LOGARITHMIC};
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
    double *circle_x = owned_figure_numbers(o, CIRCLE), *circle_y = owned_figure_numbers(o, CIRCLE);
    for (size_t i = 0; i < n; i++) {
        const bool near = cabs(loop->gain[i]) < FAR;
        x[i] = near ? creal(loop->gain[i]) : (double)NAN;
        y[i] = near ? cimag(loop->gain[i]) : (double)NAN;
    }
    for (int i = 0; i < CIRCLE; i++) {
        circle_x[i] = cos(2 * PI * i / (CIRCLE - 1));
        circle_y[i] = sin(2 * PI * i / (CIRCLE - 1));
    }

    // the loop gain, where its size is one, and the point that it keeps away from
    const figure_series series[] = {
        {.name = "loop", .label = "loop gain", .x = x, .y = y, .count = n},
        {.name = "circle",
         .label = "size 1",
         .x = circle_x,
         .y = circle_y,
         .count = CIRCLE,
         .colour = 6,
         .style = LINE_DASHED},
        {.name = "critical",
         .label = "−1",
         .x = critical,
         .y = critical + 1,
         .count = 1,
         .colour = 5,
         .marker = MARKER_CROSS,
         .radius = 3,
         .no_line = true},
    };
    memcpy(o->series[0], series, sizeof series);
    o->panels[0].series_count = G_N_ELEMENTS(series);
    o->panels[0].weight = 3.2;
    o->panels[0].y = (figure_axis){.name = "imaginary", .label = "Imaginary part", .room = 0.05};
    o->figure.x = (figure_axis){.name = "real", .label = "Real part", .room = 0.05};
    o->figure.width = 120;
    return o;
}
