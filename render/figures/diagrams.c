// The thesis's diagrams of the arm, drawn from the model's own geometry and numbers.
#include <assert.h>
#include <math.h>

#include "render/figures/diagram.h"
#include "src/base/text_stream.h"
#include "src/rig/sensors.h"

#define DEGREE     (G_PI / 180)
#define HUB_RADIUS 0.11 // of the experiment's hub, section 2.3 [m]

// ---- 2.2: hub and links

// A dimension line parallel to a link, `away` points from it.
static void draw_dimension(sketch *s, point from, point to, double away, anchor part,
                           const char *markup)
{
    double length = hypot(to.x - from.x, to.y - from.y);
    double nx = (to.y - from.y) / length, ny = -(to.x - from.x) / length;
    const point start = shifted(from, away * nx, away * ny);
    const point end = shifted(to, away * nx, away * ny);
    double beyond = away < 0 ? -3 : 3;
    sketch_measure(s, start, end);
    sketch_label(s,
                 (point){(start.x + end.x) / 2 + beyond * nx,
                         (start.y + end.y) / 2 + beyond * ny},
                 part, "%s", markup);
}

static void draw_links_diagram(sketch *s, const diagram *d)
{
    const double first = 12 * DEGREE, hub = 5 * DEGREE, second = 32 * DEGREE;
    double l = d->p.arm.length / 2, radius = HUB_RADIUS;
    view v = {s->left + 56, s->bottom - 44, 265, 1};
    point o = {0, 0}, joint = view_end(o, l, first), tip = view_end(joint, l, second);
    point hub_page = view_place(&v, (point){0, 0}), joint_page = view_place(&v, joint);
    point tip_page = view_place(&v, tip);
    point c1 = view_end(o, l / 2, first), c2 = view_end(joint, l / 2, second);
    point c1_page = view_place(&v, c1), c2_page = view_place(&v, c2);

    sketch_disc(s, hub_page, v.metre * radius, SKETCH_INK, false);
    diagram_link_angle(s, hub_page, 104, first, "<i>θ</i><sub>2</sub>");
    diagram_link_angle(s, joint_page, 74, second, "<i>θ</i><sub>3</sub>");
    sketch_bar(s, hub_page, joint_page, 7);
    sketch_bar(s, joint_page, tip_page, 7);
    sketch_mass_point(s, c1_page);
    sketch_mass_point(s, c2_page);

    // the hub's own direction, which the spring k1 parts from the first link
    point rim = view_end(o, radius, hub - 40 * DEGREE), rim_page = view_place(&v, rim);
    sketch_line(s, hub_page, rim_page, 0.8, SKETCH_INK);
    sketch_arc(s,
               (arc){hub_page, v.metre * radius + 8, -75 * DEGREE, hub - 40 * DEGREE,
                     true},
               SKETCH_INK);
    sketch_label(s, shifted(rim_page, 12, 6), (anchor){0, 0.5},
                 "<i>θ</i><sub>1</sub>, <i>I</i><sub>1</sub>");
    sketch_spiral(s, hub_page, 13, SLOT_BLUE);
    sketch_spiral(s, joint_page, 11, SLOT_BLUE);
    sketch_label(s, (point){hub_page.x - v.metre * radius - 4, hub_page.y},
                 (anchor){1, 0.5}, "<i>k</i><sub>1</sub>");
    sketch_label(s, shifted(joint_page, 0, 14), (anchor){0.5, 0}, "<i>k</i><sub>2</sub>");
    draw_dimension(s, hub_page, c1_page, 35, (anchor){0.5, 1}, "<i>ε</i><sub>2</sub>");
    draw_dimension(s, joint_page, c2_page, 17, (anchor){1, 1}, "<i>ε</i><sub>3</sub>");
    draw_dimension(s, hub_page, joint_page, 54, (anchor){0.5, 1}, "<i>l</i>");
    draw_dimension(s, joint_page, tip_page, 36, (anchor){1, 1}, "<i>l</i>");
    sketch_label(s, shifted(c1_page, 30, -13), (anchor){0.5, 1},
                 "<i>m</i><sub>2</sub>, <i>I</i><sub>2</sub>");
    sketch_label(s, shifted(c2_page, 64, -22), (anchor){0, 0},
                 "<i>m</i><sub>3</sub>, <i>I</i><sub>3</sub>");
    sketch_label(s, shifted(tip_page, 7, 0), (anchor){0, 0.5}, "tip");
}

static void add_arm_values(diagram *d)
{
    const arm_parameters *a = &d->p.arm;
    diagram_add_value(d, "length of a link l", a->length / 2, "m");
    diagram_add_value(d, "distance of its centre from the joint", a->length / 4, "m");
    diagram_add_value(d, "mass of a link", a->mass / 2, "kg");
    diagram_add_value(d, "inertia of a link about its centre", a->link_inertia, "kg m2");
    diagram_add_value(d, "inertia of the hub", a->hub_inertia, "kg m2");
    diagram_add_value(d, "spring of the hub joint k1", a->k1, "N m/rad");
    diagram_add_value(d, "spring of the beam k2", a->k2, "N m/rad");
}

status diagram_links(const figure_order *order, artwork *out, fault *f)
{
    g_autoptr(diagram) d = diagram_create(order, NULL, 190, draw_links_diagram, f);
    add_arm_values(d);

    return diagram_open(
        &d, out,
        "Hub (body 1) and two rigid links (bodies 2 and 3) in the proportions of the "
        "model, bent far more than in use. <i>l</i> = %g\u2009m, <i>ε</i> = %g\u2009m, "
        "<i>m</i> = %.4g\u2009kg, <i>I</i> = %.3g\u2009kg·m², <i>I</i><sub>1</sub> = "
        "%.3g\u2009kg·m², <i>k</i><sub>1</sub> = %.6g\u2009N·m/rad, "
        "<i>k</i><sub>2</sub> = %g\u2009N·m/rad: the corrected model's own; the "
        "printed runs of chapter 3 have <i>k</i><sub>1</sub> = 90\u2009N·m/rad and "
        "<i>I</i> = 1.67·10<sup>−5</sup>\u2009kg·m². Angles are absolute.",
        d->p.arm.length / 2, d->p.arm.length / 4, d->p.arm.mass / 2,
        d->p.arm.link_inertia, d->p.arm.hub_inertia, d->p.arm.k1, d->p.arm.k2);
}

// ---- 2.3: free bodies

// A turning arrow about a joint, between two directions [degrees].
static void draw_torque(sketch *s, point joint, double from, double to)
{
    sketch_arc(s, (arc){joint, 17, from * DEGREE, to * DEGREE, true}, SLOT_BLUE);
}

static void draw_free_bodies(sketch *s, const diagram *d)
{
    double l = d->p.arm.length / 2, metre = 184;
    const double first = 9 * DEGREE, second = 20 * DEGREE;
    double base = s->bottom - 52;
    view hub = {s->left + 44, base, metre, 1}, one = {s->left + 122, base, metre, 1};
    point h = view_place(&hub, (point){0, 0}), a = view_place(&one, (point){0, 0});
    point e = view_end((point){0, 0}, l, first), b = view_place(&one, e);
    view two = {b.x + 46, b.y - 14, metre, 1};
    point c = view_place(&two, (point){0, 0}), g = view_end((point){0, 0}, l, second);
    point t = view_place(&two, g);

    sketch_disc(s, h, 0.9 * metre * HUB_RADIUS, SKETCH_INK, false);
    sketch_disc(s, h, 2, SKETCH_INK, true);
    sketch_arc(s, (arc){h, 11, 200 * DEGREE, 40 * DEGREE, true}, SLOT_BLUE);
    sketch_label(s, shifted(h, 19, -14), (anchor){0, 1}, "\u2212<i>τ</i><sub>1</sub>");
    sketch_arc(s, (arc){h, 30, -150 * DEGREE, -40 * DEGREE, true}, SLOT_GREEN);
    sketch_small(s, shifted(h, 0, 36), (anchor){0.5, 0},
                 "motor <i>τ</i><sub>m</sub>, friction");
    sketch_small(s, shifted(h, 0, -40), (anchor){0.5, 1}, "body 1");

    sketch_bar(s, a, b, 7);
    sketch_mass_point(s, (point){(a.x + b.x) / 2, (a.y + b.y) / 2});
    draw_torque(s, a, 120, 250);
    sketch_label(s, shifted(a, -10, -21), (anchor){0.5, 1}, "<i>τ</i><sub>1</sub>");
    draw_torque(s, b, -110, 60);
    sketch_label(s, shifted(b, 2, -16), (anchor){1, 1}, "<i>τ</i><sub>2</sub>");
    sketch_arrow(s, a, shifted(a, 8, 36), SLOT_VERMILLION);
    sketch_label(s, shifted(a, 12, 37), (anchor){0, 0.5}, "<i>f</i><sub>1</sub>");
    sketch_arrow(s, b, shifted(b, -8, 36), SLOT_VERMILLION);
    sketch_label(s, shifted(b, -12, 37), (anchor){1, 0.5}, "<i>f</i><sub>2</sub>");
    sketch_small(s, (point){(a.x + b.x) / 2, (a.y + b.y) / 2 + 9}, (anchor){0.5, 0},
                 "body 2");

    sketch_bar(s, c, t, 7);
    sketch_mass_point(s, (point){(c.x + t.x) / 2, (c.y + t.y) / 2});
    draw_torque(s, c, 230, 110);
    sketch_label(s, shifted(c, 8, 18), (anchor){0.5, 0}, "\u2212<i>τ</i><sub>2</sub>");
    sketch_arrow(s, c, shifted(c, 8, -36), SLOT_VERMILLION);
    sketch_label(s, shifted(c, 12, -37), (anchor){0, 0.5}, "\u2212<i>f</i><sub>2</sub>");
    // the wall pushes back, across the last link
    double away = 40;
    sketch_arrow(s, shifted(t, -away * sin(second), -away * cos(second)),
                 shifted(t, 0, -4), SLOT_VERMILLION);
    sketch_label(s, (point){t.x - away * sin(second) - 5, t.y - away * cos(second)},
                 (anchor){1, 0.5}, "<i>f</i>");
    sketch_small(s, (point){(c.x + t.x) / 2 + 8, (c.y + t.y) / 2 + 10}, (anchor){0, 0},
                 "body 3");
}

status diagram_free_bodies(const figure_order *order, artwork *out, fault *f)
{
    g_autoptr(diagram) d = diagram_create(order, NULL, 158, draw_free_bodies, f);
    add_arm_values(d);
    return diagram_open(
        &d, out,
        "Each body on its own with what its neighbours do to it: torques "
        "<i>τ</i> of the springs <i>k</i><sub>1</sub>, <i>k</i><sub>2</sub> "
        "and forces <i>f</i><sub>1</sub>, <i>f</i><sub>2</sub> of the "
        "hinges, equal and opposite on both sides of a joint. Added up over "
        "bodies 2 and 3, <i>τ</i><sub>2</sub> and <i>f</i><sub>2</sub> "
        "cancel; the printed (2.16) keeps <i>k</i><sub>2</sub> all the same. "
        "The contact force <i>f</i> acts across the last link.");
}

// ---- 4.1: springs in series

static void draw_springs(sketch *s, const diagram *d)
{
    double y = s->top + 46, wall = s->right - 40, mass = s->left + 74;

    // the floor and the mass on it
    sketch_line(s, (point){s->left + 20, y + 20}, (point){wall, y + 20}, 0.5,
                SKETCH_FAINT);
    set_colour(s->cr, s->colours->shade);
    cairo_rectangle(s->cr, mass - 26, y - 20, 52, 40);
    cairo_fill_preserve(s->cr);
    set_colour(s->cr, s->colours->axis);
    cairo_set_line_width(s->cr, 0.8);
    cairo_stroke(s->cr);

    sketch_label(s, (point){mass, y}, (anchor){0.5, 0.5}, "<i>m</i><sub>c</sub>");
    sketch_arrow(s, (point){mass - 14, y - 30}, (point){mass + 34, y - 30}, SLOT_GREEN);
    sketch_label(s, (point){mass + 38, y - 30}, (anchor){0, 0.5}, "<i>v</i><sub>0</sub>");

    // both springs in series, to the wall
    double middle = (mass + 26 + wall) / 2;
    sketch_coil(s, (point){mass + 26, y}, (point){middle, y}, 5, SLOT_BLUE);
    sketch_coil(s, (point){middle, y}, (point){wall, y}, 9, SLOT_BLUE);
    sketch_disc(s, (point){middle, y}, 2, SKETCH_INK, true);
    sketch_wall(s, (point){wall, y + 34}, (point){wall, y - 34});

    // their stiffnesses
    sketch_small(s, (point){(mass + 26 + middle) / 2, y + 26}, (anchor){0.5, 0},
                 "<i>k</i><sub>1</sub> = %.6g\u2009N·m/rad", d->p.arm.k1);
    sketch_small(s, (point){(middle + wall) / 2, y + 26}, (anchor){0.5, 0},
                 "<i>k</i><sub>2</sub> = %g\u2009N·m/rad", d->p.arm.k2);

    double k1 = d->p.arm.k1, k2 = d->p.arm.k2;
    sketch_label(s, (point){(s->left + s->right) / 2, y + 50}, (anchor){0.5, 0},
                 "1/<i>k</i><sub>eq</sub> = 1/<i>k</i><sub>1</sub> + "
                 "1/<i>k</i><sub>2</sub>,   <i>k</i><sub>eq</sub> = %.5g\u2009N·m/rad",
                 k1 * k2 / (k1 + k2));
}

status diagram_springs(const figure_order *order, artwork *out, fault *f)
{
    g_autoptr(diagram) d = diagram_create(order, NULL, 108, draw_springs, f);
    double speed = 0;
    if (d == NULL) {
        return f->code;
    }
    TRY(diagram_take_impact(d, &speed, f));

    // drawn with the defaults, not with the run's wall
    parameters_defaults(&d->p, ARM_CORRECTED);
    parameters_resolve(&d->p, NULL);
    add_arm_values(d);

    diagram_add_value(d, "stiffness in series",
                      d->p.arm.k1 * d->p.arm.k2 / (d->p.arm.k1 + d->p.arm.k2), "N m/rad");
    diagram_add_value(d, "approach speed", speed, "m/s");
    diagram_add_value(d, "impulse", d->impulse, "N s");
    diagram_add_value(d, "mass at the contact point", d->impulse / speed, "kg");

    return diagram_open(
        &d, out,
        "What the wall feels: a mass on the arm's springs in series. The stiff hub "
        "joint hardly counts, the beam's spring takes almost all the energy. At "
        "1\u2009V the contact point arrives with <i>v</i><sub>0</sub> = %.3g\u2009m/s "
        "and the impact of %.3g\u2009N·s shows a mass <i>m</i><sub>c</sub> = "
        "%.3g\u2009kg there, of the beam's %.3g\u2009kg. <i>k</i><sub>1</sub> as the "
        "thesis prints it; its tables need 90\u2009N·m/rad.",
        speed, d->impulse, d->impulse / speed, d->p.arm.mass);
}

// The circuit's resistors are the thesis's. Supply and sensor, which it does not print,
// are the rig's.
#define R_GAIN     10e3 // both of the gain stage [ohm]
#define MOST_FORCE 12.0 // [N]

enum { SENSOR_VALUES = 7, CURVE_POINTS = 400 };

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
    sketch_label(s, (point){x + 7, y - 10}, (anchor){0.5, 0.5}, "+");
    sketch_label(s, (point){x + 7, y + 10}, (anchor){0.5, 0.5}, "\u2212");
}

static void draw_divider(sketch *s, const sensor_parameters *p, double x, double y)
{

    // supply
    sketch_small(s, (point){x, y}, (anchor){0.5, 0}, "<i>V</i><sub>+</sub> = %g\u2009V",
                 p->fsr_supply);
    sketch_disc(s, (point){x, y + 14}, 1.8, SKETCH_INK, false);
    wire(s, x, y + 16, x, y + 20);

    // sensor, which the force presses
    sketch_resistor(s, (point){x, y + 18}, (point){x, y + 62});
    sketch_small(s, (point){x + 9, y + 40}, (anchor){0, 0.5}, "FSR");
    sketch_arrow(s, (point){x - 34, y + 40}, (point){x - 8, y + 40}, SLOT_VERMILLION);
    sketch_label(s, (point){x - 38, y + 40}, (anchor){1, 0.5}, "<i>f</i>");

    // measuring resistor to ground; the divider's output between them
    sketch_resistor(s, (point){x, y + 62}, (point){x, y + 116});
    sketch_small(s, (point){x - 9, y + 92}, (anchor){1, 0.5},
                 "<i>R</i><sub>M</sub>\n%g\u2009kΩ", p->fsr_divider / 1e3);
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
    sketch_small(s, (point){first + 10, y - 20}, (anchor){0.5, 1}, "buffer");

    // the amplifier
    draw_amplifier(s, second, y + 20);
    sketch_small(s, (point){second + 14, y - 10}, (anchor){0.5, 1},
                 "gain 1 + <i>R</i><sub>6</sub>/<i>R</i><sub>5</sub> = 2");

    // its feedback
    wire(s, second, y + 30, node, y + 30);
    wire(s, node, y + 30, node, y + 62);
    sketch_disc(s, (point){node, y + 62}, 1.7, SKETCH_INK, true);
    sketch_resistor(s, (point){node, y + 62}, (point){second + 54, y + 62});
    sketch_small(s, (point){(node + second + 54) / 2, y + 69}, (anchor){0.5, 0},
                 "<i>R</i><sub>6</sub> = 10\u2009kΩ");
    wire(s, second + 54, y + 62, second + 54, y + 20);
    sketch_disc(s, (point){second + 54, y + 20}, 1.7, SKETCH_INK, true);

    // and the divider that sets its gain
    sketch_resistor(s, (point){node, y + 62}, (point){node, y + 106});
    sketch_small(s, (point){node - 9, y + 86}, (anchor){1, 0.5},
                 "<i>R</i><sub>5</sub>\n10\u2009kΩ");
    draw_ground(s, node, y + 102);

    // output
    wire(s, second + 40, y + 20, second + 86, y + 20);
    sketch_disc(s, (point){second + 88, y + 20}, 1.8, SKETCH_INK, false);
    sketch_label(s, (point){second + 92, y + 12}, (anchor){1, 1},
                 "<i>V</i><sub>out</sub>");
}

// A plot as a part of the page, laid out in the page's own points.
static void paint_part(sketch *s, const figure *fig, double x, double y)
{
    g_autofree figure_report *part = g_new0(figure_report, 1);
    cairo_save(s->cr);
    cairo_translate(s->cr, x, y);
    cairo_scale(s->cr, 1 / s->scale, 1 / s->scale);
    loss_unless(figure_paint(s->cr, fig, part, NULL) == STATUS_OK);
    cairo_restore(s->cr);

    // its texts into the report of the whole
    for (int i = 0; i < part->text_count; i++) {
        figure_rect r = part->texts[i].place;
        g_autofree char *text = text_escape(part->texts[i].text);
        r.x += s->scale * x;
        r.y += s->scale * y;
        report_add_text(s->report, text, part->texts[i].size, r);
    }
}

static void draw_sensor(sketch *s, const diagram *d)
{
    draw_divider(s, &d->p.sensor, s->left + 74, s->top);
    draw_stages(s, s->left + 74, s->top + 62);

    // force and output by turns, after the single values
    const diagram_value *points = &g_array_index(d->values, diagram_value, SENSOR_VALUES);
    const figure_series curve = {"output",
                                 .x = &points[0].value,
                                 .y = &points[1].value,
                                 .count = CURVE_POINTS,
                                 .stride = 2 * sizeof *points,
                                 .colour = SLOT_VERMILLION};
    const figure_panel panel = {.y = {.name = "output",
                                      .label = "Output <i>V</i><sub>out</sub>",
                                      .unit = "V",
                                      .with_zero = true},
                                .series = &curve,
                                .series_count = 1};

    const figure plot = {.x = {.name = "force",
                               .label = "Force on the sensor <i>f</i>",
                               .unit = "N"},
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

status diagram_sensor(const figure_order *order, artwork *out, fault *f)
{
    g_autoptr(diagram) d =
        diagram_create(order, NULL, 186 + 52 / 25.4 * 72, draw_sensor, f);
    const sensor_parameters *p = &d->p.sensor;
    diagram_add_value(d, "measuring resistor", p->fsr_divider, "ohm");
    diagram_add_value(d, "gain resistor R5", R_GAIN, "ohm");
    diagram_add_value(d, "gain resistor R6", R_GAIN, "ohm");
    diagram_add_value(d, "supply", p->fsr_supply, "V");
    diagram_add_value(d, "sensor resistance at 1 N", p->fsr_resistance, "ohm");
    diagram_add_value(d, "exponent of the sensor's power law", p->fsr_exponent, "");
    diagram_add_value(d, "force beyond which it saturates", p->fsr_saturation, "N");

    // force and output of the divider
    assert(d->values->len == SENSOR_VALUES);
    for (int i = 0; i < CURVE_POINTS; i++) {
        // close together where the curve bends
        double share = (double)i / (CURVE_POINTS - 1), force = MOST_FORCE * share * share;
        diagram_add_value(d, "force", force, "N");
        diagram_add_value(d, "output", fsr_volts(p, force), "V");
    }

    return diagram_open(
        &d, out,
        "The sheet sensor (FSR) and the measuring resistor divide the supply; a buffer "
        "keeps the divider unloaded, a second amplifier doubles its output. Resistors "
        "as in the thesis; supply and sensor are not printed there and are the rig's: "
        "%g\u2009V, %g\u2009kΩ at 1\u2009N, resistance falling with the power %g of "
        "the force up to %g\u2009N.",
        p->fsr_supply, p->fsr_resistance / 1e3, p->fsr_exponent, p->fsr_saturation);
}
