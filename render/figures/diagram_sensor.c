// Figure 2.1: the force sensor's circuit and its curve.
#include <glib.h>

#include "render/figures/diagram.h"
#include "render/figures/figures.h"
#include "render/page/text.h"
#include "src/base/numbers.h"
#include "src/rig/sensors.h"

// The circuit's resistors are the thesis's. Supply and sensor, which it does not print, are the
// rig's.
#define R_GAIN     10e3 // both of the gain stage [ohm]
#define MOST_FORCE 12.0 // [N]

static void draw_ground(const sketch *s, double x, double y)
{
    sketch_line(s, (point){x, y}, (point){x, y + 5}, 0.8, SKETCH_INK);
    for (int i = 0; i < 3; i++) {
        sketch_line(s, (point){x - 6 + 2 * i, y + 5 + 2.4 * i},
                    (point){x + 6 - 2 * i, y + 5 + 2.4 * i}, 0.8, SKETCH_INK);
    }
}

static void wire(const sketch *s, double x0, double y0, double x1, double y1)
{
    sketch_line(s, (point){x0, y0}, (point){x1, y1}, 0.8, SKETCH_INK);
}

// An amplifier with inputs at (x, y - 10) and (x, y + 10) and its output at (x + 40, y).
static void draw_amplifier(sketch *s, double x, double y)
{
    wire(s, x, y - 22, x, y + 22);
    wire(s, x, y - 22, x + 40, y);
    wire(s, x, y + 22, x + 40, y);
    sketch_text(s, (point){x + 7, y - 10}, (anchor){0.5, 0.5}, "+", SKETCH_LABEL);
    sketch_text(s, (point){x + 7, y + 10}, (anchor){0.5, 0.5}, "\u2212", SKETCH_LABEL);
}

static void draw_divider(sketch *s, const sensor_parameters *p, double x, double y)
{
    char text[96];

    // supply
    decimal_print(text, sizeof text, "<i>V</i><sub>+</sub> = %g\u2009V", p->fsr_supply);
    sketch_text(s, (point){x, y}, (anchor){0.5, 0}, text, SKETCH_SMALL);
    sketch_disc(s, (point){x, y + 14}, 1.8, SKETCH_INK, false);
    wire(s, x, y + 16, x, y + 20);

    // sensor, which the force presses
    sketch_resistor(s, (point){x, y + 18}, (point){x, y + 62});
    sketch_text(s, (point){x + 9, y + 40}, (anchor){0, 0.5}, "FSR", SKETCH_SMALL);
    sketch_arrow(s, (point){x - 34, y + 40}, (point){x - 8, y + 40}, 5);
    sketch_text(s, (point){x - 38, y + 40}, (anchor){1, 0.5}, "<i>f</i>", SKETCH_LABEL);

    // measuring resistor to ground; the divider's output between them
    sketch_resistor(s, (point){x, y + 62}, (point){x, y + 116});
    decimal_print(text, sizeof text, "<i>R</i><sub>M</sub>\n%g\u2009kΩ", p->fsr_divider / 1e3);
    sketch_text(s, (point){x - 9, y + 92}, (anchor){1, 0.5}, text, SKETCH_SMALL);
    draw_ground(s, x, y + 112);
    sketch_disc(s, (point){x, y + 62}, 1.7, SKETCH_INK, true);
}

// From the divider's node at (x, y) through buffer and gain stage to the output.
static void draw_stages(sketch *s, double x, double y)
{
    double first = x + 56, second = first + 92, node = second - 14;

    // the buffer, fed back on itself
    wire(s, x, y, first, y);
    draw_amplifier(s, first, y + 10);
    wire(s, first + 40, y + 10, second, y + 10);
    sketch_disc(s, (point){first + 52, y + 10}, 1.7, SKETCH_INK, true);
    wire(s, first + 52, y + 10, first + 52, y + 44);
    wire(s, first + 52, y + 44, first - 10, y + 44);
    wire(s, first - 10, y + 44, first - 10, y + 20);
    wire(s, first - 10, y + 20, first, y + 20);
    sketch_text(s, (point){first + 10, y - 20}, (anchor){0.5, 1}, "buffer", SKETCH_SMALL);

    // the amplifier
    draw_amplifier(s, second, y + 20);
    sketch_text(s, (point){second + 14, y - 10}, (anchor){0.5, 1},
                "gain 1 + <i>R</i><sub>6</sub>/<i>R</i><sub>5</sub> = 2", SKETCH_SMALL);

    // its feedback
    wire(s, second, y + 30, node, y + 30);
    wire(s, node, y + 30, node, y + 62);
    sketch_disc(s, (point){node, y + 62}, 1.7, SKETCH_INK, true);
    sketch_resistor(s, (point){node, y + 62}, (point){second + 54, y + 62});
    sketch_text(s, (point){(node + second + 54) / 2, y + 69}, (anchor){0.5, 0},
                "<i>R</i><sub>6</sub> = 10\u2009kΩ", SKETCH_SMALL);
    wire(s, second + 54, y + 62, second + 54, y + 20);
    sketch_disc(s, (point){second + 54, y + 20}, 1.7, SKETCH_INK, true);

    // and the divider that sets its gain
    sketch_resistor(s, (point){node, y + 62}, (point){node, y + 106});
    sketch_text(s, (point){node - 9, y + 86}, (anchor){1, 0.5}, "<i>R</i><sub>5</sub>\n10\u2009kΩ",
                SKETCH_SMALL);
    draw_ground(s, node, y + 102);

    // output
    wire(s, second + 40, y + 20, second + 86, y + 20);
    sketch_disc(s, (point){second + 88, y + 20}, 1.8, SKETCH_INK, false);
    sketch_text(s, (point){second + 92, y + 12}, (anchor){1, 1}, "<i>V</i><sub>out</sub>",
                SKETCH_LABEL);
}

// A plot as a part of the page, laid out in the page's own points.
static void paint_part(sketch *s, const figure *fig, double x, double y)
{
    figure_report *part = g_new0(figure_report, 1);
    cairo_save(s->cr);
    cairo_translate(s->cr, x, y);
    cairo_scale(s->cr, 1 / s->scale, 1 / s->scale);
    figure_paint(s->cr, fig, part, NULL);
    cairo_restore(s->cr);

    // its texts into the report of the whole
    for (int i = 0; i < part->text_count; i++) {
        figure_rect r = part->texts[i].place;
        char *text = text_escape(part->texts[i].text);
        r.x += s->scale * x;
        r.y += s->scale * y;
        report_add_text(s->report, text, part->texts[i].size, r);
        g_free(text);
    }

    g_free(part);
}

static void draw_sensor(sketch *s, const diagram *d)
{
    draw_divider(s, &d->p.sensor, s->left + 74, s->top);
    draw_stages(s, s->left + 74, s->top + 62);

    const figure_series curve = {
        .name = "output", .x = d->curve_x, .y = d->curve_y, .count = CURVE_POINTS, .colour = 5};
    const figure_panel panel = {.y = {.name = "output",
                                      .label = "Output <i>V</i><sub>out</sub>",
                                      .unit = "V",
                                      .with_zero = true},
                                .series = &curve,
                                .series_count = 1};

    const figure plot = {
        .x = {.name = "force", .label = "Force on the sensor <i>f</i>", .unit = "N"},
        .panels = &panel,
        .panel_count = 1,
        .width = s->scale * (s->right - s->left) * 25.4 / 72,
        .height = 52 * s->scale,
        .letters = s->frame->look.letters,
        .transparent = s->frame->look.transparent,
        .font = s->frame->look.font,
        .theme = s->theme};

    paint_part(s, &plot, s->left, s->top + 186);
}

status diagram_sensor(const char *title, const figure_options *o, artwork *out, fault *f)
{
    (void)f;

    diagram *d = diagram_create(title, NULL, 186 + 52 / 25.4 * 72, o);
    const sensor_parameters *p = &d->p.sensor;
    d->caption = text_printf(
        "The sheet sensor (FSR) and the measuring resistor divide the supply; a buffer keeps the "
        "divider unloaded, a second amplifier doubles its output. Resistors as in the thesis; "
        "supply and sensor are not printed there and are the rig's: %g\u2009V, %g\u2009kΩ at "
        "1\u2009N, resistance falling with the power %g of the force up to %g\u2009N.",
        p->fsr_supply, p->fsr_resistance / 1e3, p->fsr_exponent, p->fsr_saturation);

    d->frame.caption = d->caption;
    d->draw = draw_sensor;
    diagram_add_value(d, "measuring resistor", p->fsr_divider, "ohm");
    diagram_add_value(d, "gain resistor R5", R_GAIN, "ohm");
    diagram_add_value(d, "gain resistor R6", R_GAIN, "ohm");
    diagram_add_value(d, "supply", p->fsr_supply, "V");
    diagram_add_value(d, "sensor resistance at 1 N", p->fsr_resistance, "ohm");
    diagram_add_value(d, "exponent of the sensor's power law", p->fsr_exponent, "");
    diagram_add_value(d, "force beyond which it saturates", p->fsr_saturation, "N");

    // force and output of the divider
    d->curve_x = g_new(double, CURVE_POINTS);
    d->curve_y = g_new(double, CURVE_POINTS);
    for (int i = 0; i < CURVE_POINTS; i++) {
        // close together where the curve bends
        double share = (double)i / (CURVE_POINTS - 1);
        d->curve_x[i] = MOST_FORCE * share * share;
        d->curve_y[i] = fsr_volts(p, d->curve_x[i]);
    }

    *out = artwork_of_diagram(d);
    return STATUS_OK;
}
