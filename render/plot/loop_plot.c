// Pictures of linear loops: Bode plots with crossovers and margins, and Nyquist plots.
#include "render/plot/study_plot.h"

#include <assert.h>
#include <math.h>

#include "render/page/text.h"
#include "src/base/plain_math.h"

#define PI           3.14159265358979323846
#define RANGE_ROOM   0.02 // of the frequencies, free at both ends
#define NOTES_APART  0.1  // of the plane's width: least distance of two frequencies
#define CIRCLE_STEP  (2 * PI / 120)
#define PHASE_TICK   45.0 // degrees, or a multiple of it
#define LEAST_TICKED 0.01 // frequencies that the plane names lie between these [Hz]
#define MOST_TICKED  1e5

// The plane shows a loop gain whole up to a size of WHOLE, and of a larger one what is
// nearer than NEAR.
#define WHOLE 6.0
#define NEAR  3.0 // as the caption says

enum {
    GAIN_PANEL,
    PHASE_PANEL,
    BODE_PANELS,
    MOST_PHASE_TICKS = 9,
    CROSSOVERS = 3, // marks of both crossovers, and of half the rate
    MOST_FREQUENCIES = 24
};

// ---- numbers of a response

// Frequencies of a response [Hz].
static double *frequencies_of(owned_figure *o, const linear_response *r)
{
    double *frequency = owned_figure_numbers(o, (size_t)r->count);
    for (int i = 0; i < r->count; i++) {
        frequency[i] = r->frequency[i] / (2 * PI);
    }
    return frequency;
}

// Gains of a response [dB].
static double *decibels_of(owned_figure *o, const linear_response *r)
{
    double *gain = owned_figure_numbers(o, (size_t)r->count);
    for (int i = 0; i < r->count; i++) {
        gain[i] = 20 * plain_log(cabs(r->gain[i])) / plain_log(10);
    }
    return gain;
}

// Phases of a response [degrees], unwrapped: a step of more than half a revolution
// between neighbours is a full revolution that carg leaves out. NaN where the gain is 0.
static double *phases_of(owned_figure *o, const linear_response *r)
{
    double *phase = owned_figure_numbers(o, (size_t)r->count);
    double turns = 0, before = 0;
    for (int i = 0; i < r->count; i++) {
        const double angle = carg(r->gain[i]);
        if (i > 0 && angle - before > PI) {
            turns -= 1;
        } else if (i > 0 && angle - before < -PI) {
            turns += 1;
        }
        before = angle;

        phase[i] = angle * 180 / PI + 360 * turns;
        if (r->gain[i] == 0) {
            phase[i] = (double)NAN;
        }
    }
    return phase;
}

// The place of a frequency [rad/s] among those of a response: *index and the share of the
// way to the next. False where the response does not reach it.
static bool find_frequency(const linear_response *r, double w, int *index, double *share)
{
    for (int i = 0; i + 1 < r->count; i++) {
        const double from = r->frequency[i], to = r->frequency[i + 1];
        if (w >= from && w <= to) {
            *index = i;
            *share = (w - from) / (to - from);
            return true;
        }
    }
    return false;
}

// The gain of a response at a frequency [rad/s]; NaN beyond its ends.
static double complex gain_at(const linear_response *r, double w)
{
    int i;
    double share;
    if (!find_frequency(r, w, &i, &share)) {
        return complex_of((double)NAN, (double)NAN);
    }
    return r->gain[i] + share * (r->gain[i + 1] - r->gain[i]);
}

// A frequency as text [Hz].
static char *frequency_text(double frequency)
{
    g_autofree char *number = text_number(frequency, 3);
    return text_printf("%s\u2009Hz", number);
}

// ---- Bode

// Adds a margin to a panel: a line from one point to another.
static void add_margin_line(owned_figure *o, int panel, const double from[2],
                            const double to[2], const char *name, const char *label)
{
    double *x = owned_figure_numbers(o, 2), *y = owned_figure_numbers(o, 2);
    x[0] = from[0];
    y[0] = from[1];
    x[1] = to[0];
    y[1] = to[1];
    owned_figure_add(o, panel,
                     (figure_series){name, label, x, y, 2, .colour = SLOT_VERMILLION,
                                     .style = LINE_DOTTED, .own_style = true});
}

static const char *gain_margin_label(owned_figure *o, const linear_margins *m)
{
    return owned_figure_printf(o, "gain margin %.3g\u2009dB", m->gain_db);
}

static const char *phase_margin_label(owned_figure *o, const linear_margins *m)
{
    return owned_figure_printf(o, "phase margin %.3g°", m->phase_deg);
}

// Adds both margins to the Bode plot of a loop: from its gain up to 0 dB, and from its
// phase to the nearest one that is half a revolution behind, which has a level, too.
static void add_bode_margins(owned_figure *o, const linear_response *loop,
                             const double *phase, const linear_margins *m)
{
    int i;
    double share;
    if (isfinite(m->gain_db)) {
        const double at = m->gain_at / (2 * PI);
        add_margin_line(o, GAIN_PANEL, (double[]){at, -m->gain_db}, (double[]){at, 0},
                        "gain_margin", gain_margin_label(o, m));
    }
    if (isfinite(m->phase_deg) && find_frequency(loop, m->phase_at, &i, &share)) {
        const double there = phase[i] + share * (phase[i + 1] - phase[i]);
        const double behind = 360 * round((there - 180) / 360) + 180;
        const double at = m->phase_at / (2 * PI);
        add_margin_line(o, PHASE_PANEL, (double[]){at, there}, (double[]){at, behind},
                        "phase_margin", phase_margin_label(o, m));
        o->panels[PHASE_PANEL].levels = OWNED(o, figure_level, behind);
        o->panels[PHASE_PANEL].level_count = 1;
    }
}

// Marks both crossovers, and half the rate of the loop, where its answers end.
static void mark_crossovers(owned_figure *o, const linear_response *loop,
                            const linear_margins *m)
{
    const struct {
        const char *what;
        double w; // [rad/s]; 0: there is none
    } places[CROSSOVERS] = {{"gain crossover", m->phase_at},
                            {"phase crossover", m->gain_at},
                            {"half the rate", loop->frequency[loop->count - 1]}};
    figure_mark *marks = owned_figure_keep(o, g_new0(figure_mark, CROSSOVERS));
    o->figure.marks = marks;
    for (int i = 0; i < CROSSOVERS; i++) {
        if (places[i].w > 0) {
            g_autofree char *at = frequency_text(places[i].w / (2 * PI));
            marks[o->figure.mark_count++] =
                (figure_mark){places[i].w / (2 * PI),
                              owned_figure_printf(o, "%s %s", places[i].what, at)};
        }
    }
}

// Gives an axis of phases ticks at multiples of 45 degrees, or of 90, 180 ... where the
// phases of its panel reach far.
static void tick_phases(owned_figure *o, figure_panel *panel)
{
    double low = HUGE_VAL, high = -HUGE_VAL, step = PHASE_TICK;
    for (int k = 0; k < panel->series_count; k++) {
        for (size_t i = 0; i < panel->series[k].count; i++) {
            low = fmin(low, panel->series[k].y[i]);
            high = fmax(high, panel->series[k].y[i]);
        }
    }
    if (!(low <= high)) {
        return;
    }

    // the axis ends at ticks; a phase that is on one up to rounding needs none beyond
    while (ceil(high / step) - floor(low / step) >= MOST_PHASE_TICKS) {
        step *= 2;
    }
    panel->y.low = step * floor(low / step + 1e-6);
    panel->y.high = fmax(step * ceil(high / step - 1e-6), panel->y.low + step);

    figure_tick *ticks = owned_figure_keep(o, g_new0(figure_tick, MOST_PHASE_TICKS + 1));
    panel->y.ticks = ticks;
    for (double at = panel->y.low; at <= panel->y.high; at += step) {
        ticks[panel->y.tick_count++] =
            (figure_tick){at, owned_figure_printf(o, "%s%g", text_sign(at), fabs(at))};
    }
}

// Makes the Bode plot of responses: gain and phase over the frequency; of a loop also its
// margins, crossovers and half its rate.
owned_figure *bode_figure_create(const scenario *s, const linear_curve *curves, int count,
                                 const linear_margins *margins)
{
    assert(count >= 1 && count <= FIGURE_PANELS);
    static const figure_level one = {0};
    char changes[SCENARIO_CHANGES];
    owned_figure *o = owned_figure_create(BODE_PANELS, "%s: frequency response%s",
                                          s->title, scenario_changes(s, changes));

    // gain and phase of each response
    for (int k = 0; k < count; k++) {
        const linear_response *r = &curves[k].response;
        const char *label =
            owned_figure_keep(o, g_strdelimit(g_strdup(curves[k].name), "_", ' '));
        const double *frequency = frequencies_of(o, r);
        const double *y[BODE_PANELS] = {
            [GAIN_PANEL] = decibels_of(o, r), [PHASE_PANEL] = phases_of(o, r)};
        for (int panel = 0; panel < BODE_PANELS; panel++) {
            owned_figure_add(o, panel,
                             (figure_series){curves[k].name, label, frequency, y[panel],
                                             (size_t)r->count,
                                             .colour = palette_slot(k)});
            o->panels[panel].weight = 1.2;
        }
    }

    // what tells how far a loop is from instability
    o->panels[PHASE_PANEL].keyless = margins == NULL;
    if (margins != NULL) {
        const linear_response *loop = &curves[0].response;
        o->panels[GAIN_PANEL].levels = &one;
        o->panels[GAIN_PANEL].level_count = 1;
        add_bode_margins(o, loop, o->series[PHASE_PANEL][0].y, margins);
        mark_crossovers(o, loop, margins);
    }

    // the axes; both panels have the same curves
    o->panels[GAIN_PANEL].y =
        (figure_axis){.name = "gain", .label = "Gain", .unit = "dB"};
    o->panels[PHASE_PANEL].y =
        (figure_axis){.name = "phase", .label = "Phase", .unit = "°"};
    tick_phases(o, &o->panels[PHASE_PANEL]);
    o->figure.x = (figure_axis){"frequency", "Frequency", .unit = "Hz",
                                .scale = SCALE_LOGARITHMIC, .room = RANGE_ROOM};
    return o;
}

// ---- Nyquist

// The size from which loop gains are not drawn in the plane.
static double far_size(const linear_response *loop)
{
    double largest = 0;
    for (int i = 0; i < loop->count; i++) {
        largest = fmax(largest, cabs(loop->gain[i]));
    }
    if (largest < WHOLE) {
        return WHOLE;
    }
    return NEAR;
}

// Adds the loop gain in the complex plane, without what is `far` from the origin.
static void add_loop_gain(owned_figure *o, const linear_response *loop, double far)
{
    const size_t count = (size_t)loop->count;
    double *x = owned_figure_numbers(o, count), *y = owned_figure_numbers(o, count);
    for (size_t i = 0; i < count; i++) {
        x[i] = y[i] = (double)NAN;
        if (cabs(loop->gain[i]) < far) {
            x[i] = creal(loop->gain[i]);
            y[i] = cimag(loop->gain[i]);
        }
    }
    owned_figure_add(o, 0, (figure_series){"loop", "loop gain", x, y, count});
}

// Names round frequencies, 1, 2 and 5 of every decade, at their points of the curve: the
// highest first, and each well apart from the one before.
static void note_frequencies(owned_figure *o, const linear_response *loop, double far)
{
    static const double mantissas[] = {5, 2, 1};
    figure_note *notes = owned_figure_keep(o, g_new0(figure_note, MOST_FREQUENCIES));
    double complex before = complex_of(HUGE_VAL, 0);
    int count = 0;
    for (double power = MOST_TICKED; power >= LEAST_TICKED; power /= 10) {
        for (int k = 0; k < 3 && count < MOST_FREQUENCIES; k++) {
            const double frequency = mantissas[k] * power;
            const double complex there = gain_at(loop, 2 * PI * frequency);
            if (cabs(there) < far && cabs(there - before) > NOTES_APART * far) {
                before = there;
                notes[count++] =
                    (figure_note){creal(there), cimag(there),
                                  owned_figure_keep(o, frequency_text(frequency)),
                                  .optional = true};
            }
        }
    }
    o->panels[0].notes = notes;
    o->panels[0].note_count = count;
}

// Adds an arc of the circle of size 1, from one angle to another [rad].
static void add_arc(owned_figure *o, figure_series look, double from, double to)
{
    look.count = 2 + (size_t)(fabs(to - from) / CIRCLE_STEP);
    double *x = owned_figure_numbers(o, look.count);
    double *y = owned_figure_numbers(o, look.count);
    for (size_t i = 0; i < look.count; i++) {
        const double angle = from + (to - from) * (double)i / (double)(look.count - 1);
        x[i] = cos(angle);
        y[i] = sin(angle);
    }
    look.x = x;
    look.y = y;
    owned_figure_add(o, 0, look);
}

// Adds both margins: along the real axis from -1 to where the loop gain crosses it, and
// along the circle from -1 to where it crosses that.
static void add_plane_margins(owned_figure *o, const linear_response *loop,
                              const linear_margins *m)
{
    if (isfinite(m->gain_db)) {
        const double crossing = creal(gain_at(loop, m->gain_at));
        add_margin_line(o, 0, (double[]){-1, 0}, (double[]){crossing, 0}, "gain_margin",
                        gain_margin_label(o, m));
    }
    if (isfinite(m->phase_deg)) {
        const double angle = carg(gain_at(loop, m->phase_at));
        add_arc(o,
                (figure_series){"phase_margin", phase_margin_label(o, m),
                                .colour = SLOT_GREEN, .own_style = true},
                copysign(PI, angle), angle);
    }
}

// Makes the Nyquist plot: the loop gain in the complex plane with equal axes, the circle
// of size 1, the critical point -1, and the margins to it.
owned_figure *nyquist_figure_create(const scenario *s, const linear_response *loop,
                                    const linear_margins *margins)
{
    static const double critical[] = {-1, 0};
    char changes[SCENARIO_CHANGES];
    owned_figure *o = owned_figure_create(1, "%s: loop gain in the complex plane%s",
                                          s->title, scenario_changes(s, changes));

    // the loop gain with its frequencies, and the point that it keeps away from
    const double far = far_size(loop);
    add_loop_gain(o, loop, far);
    note_frequencies(o, loop, far);
    add_arc(o,
            (figure_series){"circle", "size 1", .colour = SLOT_BLACK,
                            .style = LINE_DASHED},
            -PI, PI);
    add_plane_margins(o, loop, margins);
    owned_figure_add(o, 0,
                     (figure_series){"critical", "−1", critical, critical + 1, 1,
                                     .colour = SLOT_BLACK, .marker = MARKER_CROSS,
                                     .radius = 3, .no_line = true});

    // a page on which the circle is round
    o->panels[0].weight = 3.2;
    o->panels[0].y =
        (figure_axis){.name = "imaginary", .label = "Imaginary part", .room = 0.05};
    o->figure.x = (figure_axis){.name = "real", .label = "Real part", .room = 0.05};
    o->figure.equal_axes = true;
    o->figure.width = 120;

    // where the curve ends
    g_autofree char *end = frequency_text(loop->frequency[loop->count - 1] / (2 * PI));
    const char *left_out = "";
    if (far == NEAR) {
        left_out = ", without loop gains of size 3 or more";
    }
    o->figure.caption =
        owned_figure_printf(o, "Up to half the rate, %s%s.", end, left_out);
    return o;
}
