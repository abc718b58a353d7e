// The thesis's diagrams of the arm, drawn from the model's own geometry and numbers.
#include <assert.h>
#include <math.h>

#include "render/figures/diagram.h"
#include "src/rig/sensors.h"

#define DEGREE         (G_PI / 180)
#define HUB_RADIUS     0.11 // of the experiment's hub, section 2.3 [m]

#define LINK_THICKNESS 7.0 // of a bar on the page [pt]

// ---- 2.2: hub and links

// A dimension line parallel to a link, `away` points from it, with its label beyond.
static void draw_dimension(sketch *s, point from, point to, double away, anchor part,
                           const char *markup)
{
    // the link's normal, to its left
    const double length = hypot(to.x - from.x, to.y - from.y);
    const double nx = (to.y - from.y) / length, ny = -(to.x - from.x) / length;
    const point start = shifted(from, away * nx, away * ny);
    const point end = shifted(to, away * nx, away * ny);
    const double beyond = 3;
    sketch_measure(s, start, end);
    sketch_label(s,
                 (point){(start.x + end.x) / 2 + beyond * nx,
                         (start.y + end.y) / 2 + beyond * ny},
                 part, "%s", markup);
}

// The hub with its own direction, which the spring k1 parts from the first link.
static void draw_hub_direction(sketch *s, const view *v, point hub)
{
    const double direction = -35 * DEGREE, radius = v->metre * HUB_RADIUS;
    const point rim = view_place(v, view_end((point){0, 0}, HUB_RADIUS, direction));
    sketch_line(s, hub, rim, 0.8, SKETCH_INK);
    sketch_arc(s, (arc){hub, radius + 8, -75 * DEGREE, direction, true}, SKETCH_INK);
    sketch_label(s, shifted(rim, 12, 6), (anchor){0, 0.5},
                 "<i>θ</i><sub>1</sub>, <i>I</i><sub>1</sub>");
}

// Hub and links with angles, springs, lengths, masses.
static void draw_links_diagram(sketch *s, const diagram *d)
{
    // the arm in the model, far more bent than in use
    const double first = 12 * DEGREE, second = 32 * DEGREE, l = d->p.arm.length / 2;
    const point origin = {0, 0};
    const point elbow = view_end(origin, l, first);

    // its joints and centres of mass on the page
    const view v = {s->left + 56, s->bottom - 44, 265, 1};
    const point hub = view_place(&v, origin), joint = view_place(&v, elbow);
    const point tip = view_place(&v, view_end(elbow, l, second));
    const point centre_2 = view_place(&v, view_end(origin, l / 2, first));
    const point centre_3 = view_place(&v, view_end(elbow, l / 2, second));
    const double hub_radius = v.metre * HUB_RADIUS;

    // bodies and angles
    sketch_disc(s, hub, hub_radius, SKETCH_INK, false);
    diagram_link_angle(s, hub, 104, first, "<i>θ</i><sub>2</sub>");
    diagram_link_angle(s, joint, 74, second, "<i>θ</i><sub>3</sub>");
    sketch_bar(s, hub, joint, LINK_THICKNESS);
    sketch_bar(s, joint, tip, LINK_THICKNESS);
    sketch_mass_point(s, centre_2);
    sketch_mass_point(s, centre_3);
    draw_hub_direction(s, &v, hub);

    // springs
    sketch_spiral(s, hub, 13, SLOT_BLUE);
    sketch_spiral(s, joint, 11, SLOT_BLUE);
    sketch_label(s, (point){hub.x - hub_radius - 4, hub.y}, (anchor){1, 0.5},
                 "<i>k</i><sub>1</sub>");
    sketch_label(s, shifted(joint, 0, 14), (anchor){0.5, 0}, "<i>k</i><sub>2</sub>");

    // lengths, masses, inertias
    draw_dimension(s, hub, centre_2, 35, (anchor){0.5, 1}, "<i>ε</i><sub>2</sub>");
    draw_dimension(s, joint, centre_3, 17, (anchor){1, 1}, "<i>ε</i><sub>3</sub>");
    draw_dimension(s, hub, joint, 54, (anchor){0.5, 1}, "<i>l</i>");
    draw_dimension(s, joint, tip, 36, (anchor){1, 1}, "<i>l</i>");
    sketch_label(s, shifted(centre_2, 30, -13), (anchor){0.5, 1},
                 "<i>m</i><sub>2</sub>, <i>I</i><sub>2</sub>");
    sketch_label(s, shifted(centre_3, 64, -22), (anchor){0, 0},
                 "<i>m</i><sub>3</sub>, <i>I</i><sub>3</sub>");
    sketch_label(s, shifted(tip, 7, 0), (anchor){0, 0.5}, "tip");
}

// Lengths, masses and springs of the arm.
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

// Figure 2.2.
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

static point middle_of(point a, point b)
{
    return (point){(a.x + b.x) / 2, (a.y + b.y) / 2};
}

// A turning arrow about a joint, between two directions [degrees].
static void draw_torque(sketch *s, point joint, double from, double to)
{
    sketch_arc(s, (arc){joint, 17, from * DEGREE, to * DEGREE, true}, SLOT_BLUE);
}

// A force at a joint.
static void draw_force_arrow(sketch *s, point at, double right, double down)
{
    sketch_arrow(s, at, shifted(at, right, down), SLOT_VERMILLION);
}

// Body 1, the hub at a place: the spring's torque against it, and the motor's.
static void draw_free_hub(sketch *s, point hub, double radius)
{
    sketch_disc(s, hub, radius, SKETCH_INK, false);
    sketch_disc(s, hub, 2, SKETCH_INK, true);
    sketch_arc(s, (arc){hub, 11, 200 * DEGREE, 40 * DEGREE, true}, SLOT_BLUE);
    sketch_label(s, shifted(hub, 19, -14), (anchor){0, 1}, "\u2212<i>τ</i><sub>1</sub>");
    sketch_arc(s, (arc){hub, 30, -150 * DEGREE, -40 * DEGREE, true}, SLOT_GREEN);
    sketch_small(s, shifted(hub, 0, 36), (anchor){0.5, 0},
                 "motor <i>τ</i><sub>m</sub>, friction");
    sketch_small(s, shifted(hub, 0, -40), (anchor){0.5, 1}, "body 1");
}

// Body 2 between two joints: torques of both springs, forces of both hinges.
static void draw_first_link(sketch *s, point from, point to)
{
    const point centre = middle_of(from, to);
    sketch_bar(s, from, to, LINK_THICKNESS);
    sketch_mass_point(s, centre);
    draw_torque(s, from, 120, 250);
    sketch_label(s, shifted(from, -10, -21), (anchor){0.5, 1}, "<i>τ</i><sub>1</sub>");
    draw_torque(s, to, -110, 60);
    sketch_label(s, shifted(to, 2, -16), (anchor){1, 1}, "<i>τ</i><sub>2</sub>");
    draw_force_arrow(s, from, 8, 36);
    sketch_label(s, shifted(from, 12, 37), (anchor){0, 0.5}, "<i>f</i><sub>1</sub>");
    draw_force_arrow(s, to, -8, 36);
    sketch_label(s, shifted(to, -12, 37), (anchor){1, 0.5}, "<i>f</i><sub>2</sub>");
    sketch_small(s, shifted(centre, 0, 9), (anchor){0.5, 0}, "body 2");
}

// Body 3 from its joint to the tip, at an angle: torque and force of the joint, equal and
// opposite to those of body 2, and the wall's force across it.
static void draw_last_link(sketch *s, point from, point tip, double angle)
{
    const point centre = middle_of(from, tip);
    sketch_bar(s, from, tip, LINK_THICKNESS);
    sketch_mass_point(s, centre);
    draw_torque(s, from, 230, 110);
    sketch_label(s, shifted(from, 8, 18), (anchor){0.5, 0}, "\u2212<i>τ</i><sub>2</sub>");
    draw_force_arrow(s, from, 8, -36);
    sketch_label(s, shifted(from, 12, -37), (anchor){0, 0.5},
                 "\u2212<i>f</i><sub>2</sub>");

    // the wall pushes back, across the last link
    const double away = 40;
    const point start = shifted(tip, -away * sin(angle), -away * cos(angle));
    sketch_arrow(s, start, shifted(tip, 0, -4), SLOT_VERMILLION);
    sketch_label(s, shifted(start, -5, 0), (anchor){1, 0.5}, "<i>f</i>");
    sketch_small(s, shifted(centre, 8, 10), (anchor){0, 0}, "body 3");
}

// Hub and links apart, each with what its neighbours do to it.
static void draw_free_bodies(sketch *s, const diagram *d)
{
    const double l = d->p.arm.length / 2, metre = 184, base = s->bottom - 52;
    const double first_angle = 9 * DEGREE, second_angle = 20 * DEGREE;
    const point origin = {0, 0};

    // each body in a view of its own, apart from its neighbours
    const point hub = {s->left + 44, base};
    const view first = {s->left + 122, base, metre, 1};
    const point from = view_place(&first, origin);
    const point to = view_place(&first, view_end(origin, l, first_angle));
    const view last = {to.x + 46, to.y - 14, metre, 1};
    const point joint = view_place(&last, origin);
    const point tip = view_place(&last, view_end(origin, l, second_angle));

    draw_free_hub(s, hub, 0.9 * metre * HUB_RADIUS);
    draw_first_link(s, from, to);
    draw_last_link(s, joint, tip, second_angle);
}

// Figure 2.3.
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

// A mass on the floor, a block of half a width and half a height round a point, that
// moves to the right.
static void draw_moving_mass(sketch *s, point at, double half_width, double half_height)
{
    set_colour(s->cr, s->colours->shade);
    cairo_rectangle(s->cr, at.x - half_width, at.y - half_height, 2 * half_width,
                    2 * half_height);
    cairo_fill_preserve(s->cr);
    set_colour(s->cr, s->colours->axis);
    cairo_set_line_width(s->cr, 0.8);
    cairo_stroke(s->cr);
    sketch_label(s, at, (anchor){0.5, 0.5}, "<i>m</i><sub>c</sub>");

    // its velocity, above
    sketch_arrow(s, shifted(at, -14, -30), shifted(at, 34, -30), SLOT_GREEN);
    sketch_label(s, shifted(at, 38, -30), (anchor){0, 0.5}, "<i>v</i><sub>0</sub>");
}

// A mass that runs against the wall through two springs.
static void draw_springs(sketch *s, const diagram *d)
{
    const double half_width = 26, half_height = 20; // of the mass
    const double k1 = d->p.arm.k1, k2 = d->p.arm.k2;

    // from left to right: the mass, where the springs meet, and the wall
    const point mass = {s->left + 74, s->top + 46}, wall = {s->right - 40, mass.y};
    const point edge = shifted(mass, half_width, 0);
    const point middle = {(edge.x + wall.x) / 2, mass.y};

    // the floor and the mass on it
    sketch_line(s, (point){s->left + 20, mass.y + half_height},
                shifted(wall, 0, half_height), 0.5, SKETCH_FAINT);
    draw_moving_mass(s, mass, half_width, half_height);

    // both springs in series, to the wall
    sketch_coil(s, edge, middle, 5, SLOT_BLUE);
    sketch_coil(s, middle, wall, 9, SLOT_BLUE);
    sketch_disc(s, middle, 2, SKETCH_INK, true);
    sketch_wall(s, shifted(wall, 0, 34), shifted(wall, 0, -34));

    // their stiffnesses, and that of both
    const double below = mass.y + 26;
    sketch_small(s, (point){(edge.x + middle.x) / 2, below}, (anchor){0.5, 0},
                 "<i>k</i><sub>1</sub> = %.6g\u2009N·m/rad", k1);
    sketch_small(s, (point){(middle.x + wall.x) / 2, below}, (anchor){0.5, 0},
                 "<i>k</i><sub>2</sub> = %g\u2009N·m/rad", k2);
    sketch_label(s, (point){(s->left + s->right) / 2, mass.y + 50}, (anchor){0.5, 0},
                 "1/<i>k</i><sub>eq</sub> = 1/<i>k</i><sub>1</sub> + "
                 "1/<i>k</i><sub>2</sub>,   <i>k</i><sub>eq</sub> = %.5g\u2009N·m/rad",
                 k1 * k2 / (k1 + k2));
}

// Figure 4.1.
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

// ---- 2.1: the force sensor

// The circuit's resistors are the thesis's. Supply and sensor, which it does not print,
// are the rig's.
#define R_GAIN         10e3 // both of the gain stage [ohm]
#define MOST_FORCE     12.0 // [N]

#define CIRCUIT_HEIGHT 186.0 // [pt]
#define CURVE_HEIGHT   52.0  // of the plot below it [mm]

enum { SENSOR_VALUES = 7, CURVE_POINTS = 400 };

// Earth: a line down to three short ones.
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

// The divider at x, downwards from y: supply, sensor, output, measuring resistor, earth.
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
    // inputs of both amplifiers, the node of the feedback, and the second one's output
    const double first = x + 56, second = first + 92, node = second - 14;
    const double output = second + 54;

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
    sketch_resistor(s, (point){node, y + 62}, (point){output, y + 62});
    sketch_small(s, (point){(node + output) / 2, y + 69}, (anchor){0.5, 0},
                 "<i>R</i><sub>6</sub> = 10\u2009kΩ");
    wire(s, output, y + 62, output, y + 20);
    sketch_disc(s, (point){output, y + 20}, 1.7, SKETCH_INK, true);

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
    s->code = figure_paint(s->cr, fig, part, s->f);
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

// The circuit above, the curve of its output over the force below.
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
                         .height = CURVE_HEIGHT * s->scale,
                         .letters = s->frame->look.letters,
                         .transparent = s->frame->look.transparent,
                         .font = s->frame->look.font,
                         .theme = s->theme};

    paint_part(s, &plot, s->left, s->top + CIRCUIT_HEIGHT);
}

// Figure 2.1.
status diagram_sensor(const figure_order *order, artwork *out, fault *f)
{
    const double height = CIRCUIT_HEIGHT + CURVE_HEIGHT / 25.4 * 72;
    g_autoptr(diagram) d = diagram_create(order, NULL, height, draw_sensor, f);
    const sensor_parameters *p = &d->p.sensor;
    diagram_add_value(d, "measuring resistor", p->fsr_divider, "ohm");
    diagram_add_value(d, "gain resistor R5", R_GAIN, "ohm");
    diagram_add_value(d, "gain resistor R6", R_GAIN, "ohm");
    diagram_add_value(d, "supply", p->fsr_supply, "V");
    diagram_add_value(d, "sensor resistance at 1 N", p->fsr_resistance, "ohm");
    diagram_add_value(d, "exponent of the sensor's power law", p->fsr_exponent, "");
    diagram_add_value(d, "force beyond which it saturates", p->fsr_saturation, "N");

    // force and output of the divider, close together where the curve bends
    assert(d->values->len == SENSOR_VALUES);
    for (int i = 0; i < CURVE_POINTS; i++) {
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
