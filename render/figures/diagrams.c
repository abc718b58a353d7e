// The thesis's diagrams of the arm, drawn from the model's own geometry and numbers.
#include <assert.h>
#include <glib.h>
#include <math.h>

#include "render/figures/diagram.h"
#include "render/figures/figures.h"
#include "render/page/picture_file.h"
#include "render/page/text.h"
#include "src/base/numbers.h"

#define DEGREE     (G_PI / 180)
#define HUB_RADIUS 0.11 // of the experiment's hub, section 2.3 [m]

// ---- 2.2: hub and links

// An angle from the dashed reference line at a joint to a link.
static void draw_angle(sketch *s, point at, double radius, double angle, const char *markup)
{
    sketch_dashed(s, at, (point){at.x + radius + 14, at.y}, SKETCH_FAINT);
    sketch_arc(s, (arc){at, radius, 0, angle, true}, SKETCH_INK);
    sketch_text(s,
                (point){at.x + (radius + 3) * cos(angle / 2), at.y - (radius + 3) * sin(angle / 2)},
                (anchor){0, 0.5}, markup, SKETCH_LABEL);
}

// A dimension line parallel to a link, `away` points from it.
static void draw_length(sketch *s, point from, point to, double away, anchor part,
                        const char *markup)
{
    double length = hypot(to.x - from.x, to.y - from.y);
    double nx = (to.y - from.y) / length, ny = -(to.x - from.x) / length;
    const point start = shifted(from, away * nx, away * ny);
    const point end = shifted(to, away * nx, away * ny);
    double beyond = away < 0 ? -3 : 3;
    sketch_measure(s, start, end);
    sketch_text(s,
                (point){(start.x + end.x) / 2 + beyond * nx, (start.y + end.y) / 2 + beyond * ny},
                part, markup, SKETCH_LABEL);
}

static void draw_links(sketch *s, const diagram *d)
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
    draw_angle(s, hub_page, 104, first, "<i>θ</i><sub>2</sub>");
    draw_angle(s, joint_page, 74, second, "<i>θ</i><sub>3</sub>");
    sketch_bar(s, hub_page, joint_page, 7);
    sketch_bar(s, joint_page, tip_page, 7);
    sketch_mass_point(s, c1_page);
    sketch_mass_point(s, c2_page);

    // the hub's own direction, which the spring k1 parts from the first link
    point rim = view_end(o, radius, hub - 40 * DEGREE), rim_page = view_place(&v, rim);
    sketch_line(s, hub_page, rim_page, 0.8, SKETCH_INK);
    sketch_arc(s, (arc){hub_page, v.metre * radius + 8, -75 * DEGREE, hub - 40 * DEGREE, true},
               SKETCH_INK);
    sketch_text(s, shifted(rim_page, 12, 6), (anchor){0, 0.5},
                "<i>θ</i><sub>1</sub>, <i>I</i><sub>1</sub>", SKETCH_LABEL);
    sketch_spiral(s, hub_page, 13, 0);
    sketch_spiral(s, joint_page, 11, 0);
    sketch_text(s, (point){hub_page.x - v.metre * radius - 4, hub_page.y}, (anchor){1, 0.5},
                "<i>k</i><sub>1</sub>", SKETCH_LABEL);
    sketch_text(s, shifted(joint_page, 0, 14), (anchor){0.5, 0}, "<i>k</i><sub>2</sub>",
                SKETCH_LABEL);
    draw_length(s, hub_page, c1_page, 35, (anchor){0.5, 1}, "<i>ε</i><sub>2</sub>");
    draw_length(s, joint_page, c2_page, 17, (anchor){1, 1}, "<i>ε</i><sub>3</sub>");
    draw_length(s, hub_page, joint_page, 54, (anchor){0.5, 1}, "<i>l</i>");
    draw_length(s, joint_page, tip_page, 36, (anchor){1, 1}, "<i>l</i>");
    sketch_text(s, shifted(c1_page, 30, -13), (anchor){0.5, 1},
                "<i>m</i><sub>2</sub>, <i>I</i><sub>2</sub>", SKETCH_LABEL);
    sketch_text(s, shifted(c2_page, 64, -22), (anchor){0, 0},
                "<i>m</i><sub>3</sub>, <i>I</i><sub>3</sub>", SKETCH_LABEL);
    sketch_text(s, shifted(tip_page, 7, 0), (anchor){0, 0.5}, "tip", SKETCH_LABEL);
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

status diagram_links(const char *title, const figure_options *o, artwork *out, fault *f)
{
    (void)f;
    diagram *d = diagram_create(title, NULL, 190, o);
    d->draw = draw_links;
    add_arm_values(d);

    d->caption = text_printf(
        "Hub (body 1) and two rigid links (bodies 2 and 3) in the proportions of the model, bent "
        "far more than in use. <i>l</i> = %g\u2009m, <i>ε</i> = %g\u2009m, <i>m</i> = "
        "%.4g\u2009kg, "
        "<i>I</i> = %.3g\u2009kg·m², <i>I</i><sub>1</sub> = %.3g\u2009kg·m², <i>k</i><sub>1</sub> "
        "= "
        "%.6g\u2009N·m/rad, <i>k</i><sub>2</sub> = %g\u2009N·m/rad: the corrected model's own; the "
        "printed runs of chapter 3 have <i>k</i><sub>1</sub> = 90\u2009N·m/rad and <i>I</i> = "
        "1.67·10<sup>−5</sup>\u2009kg·m². Angles are absolute.",
        d->p.arm.length / 2, d->p.arm.length / 4, d->p.arm.mass / 2, d->p.arm.link_inertia,
        d->p.arm.hub_inertia, d->p.arm.k1, d->p.arm.k2);
    d->frame.caption = d->caption;

    *out = artwork_of_diagram(d);
    return STATUS_OK;
}

// ---- 2.3: free bodies

// A turning arrow about a joint, between two directions [degrees].
static void draw_torque(sketch *s, point joint, double from, double to)
{
    sketch_arc(s, (arc){joint, 17, from * DEGREE, to * DEGREE, true}, 0);
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
    sketch_arc(s, (arc){h, 11, 200 * DEGREE, 40 * DEGREE, true}, 0);
    sketch_text(s, shifted(h, 19, -14), (anchor){0, 1}, "\u2212<i>τ</i><sub>1</sub>", SKETCH_LABEL);
    sketch_arc(s, (arc){h, 30, -150 * DEGREE, -40 * DEGREE, true}, 2);
    sketch_text(s, shifted(h, 0, 36), (anchor){0.5, 0}, "motor <i>τ</i><sub>m</sub>, friction",
                SKETCH_SMALL);
    sketch_text(s, shifted(h, 0, -40), (anchor){0.5, 1}, "body 1", SKETCH_SMALL);

    sketch_bar(s, a, b, 7);
    sketch_mass_point(s, (point){(a.x + b.x) / 2, (a.y + b.y) / 2});
    draw_torque(s, a, 120, 250);
    sketch_text(s, shifted(a, -10, -21), (anchor){0.5, 1}, "<i>τ</i><sub>1</sub>", SKETCH_LABEL);
    draw_torque(s, b, -110, 60);
    sketch_text(s, shifted(b, 2, -16), (anchor){1, 1}, "<i>τ</i><sub>2</sub>", SKETCH_LABEL);
    sketch_arrow(s, a, shifted(a, 8, 36), 5);
    sketch_text(s, shifted(a, 12, 37), (anchor){0, 0.5}, "<i>f</i><sub>1</sub>", SKETCH_LABEL);
    sketch_arrow(s, b, shifted(b, -8, 36), 5);
    sketch_text(s, shifted(b, -12, 37), (anchor){1, 0.5}, "<i>f</i><sub>2</sub>", SKETCH_LABEL);
    sketch_text(s, (point){(a.x + b.x) / 2, (a.y + b.y) / 2 + 9}, (anchor){0.5, 0}, "body 2",
                SKETCH_SMALL);

    sketch_bar(s, c, t, 7);
    sketch_mass_point(s, (point){(c.x + t.x) / 2, (c.y + t.y) / 2});
    draw_torque(s, c, 230, 110);
    sketch_text(s, shifted(c, 8, 18), (anchor){0.5, 0}, "\u2212<i>τ</i><sub>2</sub>", SKETCH_LABEL);
    sketch_arrow(s, c, shifted(c, 8, -36), 5);
    sketch_text(s, shifted(c, 12, -37), (anchor){0, 0.5}, "\u2212<i>f</i><sub>2</sub>",
                SKETCH_LABEL);
    // the wall pushes back, across the last link
    double away = 40;
    sketch_arrow(s, (point){t.x - away * sin(second), t.y - away * cos(second)}, shifted(t, 0, -4),
                 5);
    sketch_text(s, (point){t.x - away * sin(second) - 5, t.y - away * cos(second)},
                (anchor){1, 0.5}, "<i>f</i>", SKETCH_LABEL);
    sketch_text(s, (point){(c.x + t.x) / 2 + 8, (c.y + t.y) / 2 + 10}, (anchor){0, 0}, "body 3",
                SKETCH_SMALL);
}

status diagram_free_bodies(const char *title, const figure_options *o, artwork *out, fault *f)
{
    (void)f;
    diagram *d = diagram_create(
        title,
        "Each body on its own with what its neighbours do to it: torques <i>τ</i> of the springs "
        "<i>k</i><sub>1</sub>, <i>k</i><sub>2</sub> and forces <i>f</i><sub>1</sub>, "
        "<i>f</i><sub>2</sub> of the hinges, equal and opposite on both sides of a joint. Added "
        "up over bodies 2 and 3, <i>τ</i><sub>2</sub> and <i>f</i><sub>2</sub> cancel; the printed "
        "(2.16) keeps <i>k</i><sub>2</sub> all the same. The contact force <i>f</i> acts across "
        "the last link.",
        158, o);

    d->draw = draw_free_bodies;
    add_arm_values(d);
    *out = artwork_of_diagram(d);
    return STATUS_OK;
}

// ---- 4.1: springs in series

static void draw_springs(sketch *s, const diagram *d)
{
    char text[128];
    double y = s->top + 46, wall = s->right - 40, mass = s->left + 74;

    // the floor and the mass on it
    sketch_line(s, (point){s->left + 20, y + 20}, (point){wall, y + 20}, 0.5, SKETCH_FAINT);
    set_colour(s->cr, s->colours->shade);
    cairo_rectangle(s->cr, mass - 26, y - 20, 52, 40);
    cairo_fill_preserve(s->cr);
    set_colour(s->cr, s->colours->axis);
    cairo_set_line_width(s->cr, 0.8);
    picture_stroke(s->cr);

    sketch_text(s, (point){mass, y}, (anchor){0.5, 0.5}, "<i>m</i><sub>c</sub>", SKETCH_LABEL);
    sketch_arrow(s, (point){mass - 14, y - 30}, (point){mass + 34, y - 30}, 2);
    sketch_text(s, (point){mass + 38, y - 30}, (anchor){0, 0.5}, "<i>v</i><sub>0</sub>",
                SKETCH_LABEL);

    // both springs in series, to the wall
    double middle = (mass + 26 + wall) / 2;
    sketch_coil(s, (point){mass + 26, y}, (point){middle, y}, 5, 0);
    sketch_coil(s, (point){middle, y}, (point){wall, y}, 9, 0);
    sketch_disc(s, (point){middle, y}, 2, SKETCH_INK, true);
    sketch_wall(s, (point){wall, y + 34}, (point){wall, y - 34});

    // their stiffnesses
    decimal_print(text, sizeof text, "<i>k</i><sub>1</sub> = %.6g\u2009N·m/rad", d->p.arm.k1);
    sketch_text(s, (point){(mass + 26 + middle) / 2, y + 26}, (anchor){0.5, 0}, text, SKETCH_SMALL);
    decimal_print(text, sizeof text, "<i>k</i><sub>2</sub> = %g\u2009N·m/rad", d->p.arm.k2);
    sketch_text(s, (point){(middle + wall) / 2, y + 26}, (anchor){0.5, 0}, text, SKETCH_SMALL);

    double k1 = d->p.arm.k1, k2 = d->p.arm.k2;
    decimal_print(text, sizeof text,
                  "1/<i>k</i><sub>eq</sub> = 1/<i>k</i><sub>1</sub> + 1/<i>k</i><sub>2</sub>,   "
                  "<i>k</i><sub>eq</sub> = %.5g\u2009N·m/rad",
                  k1 * k2 / (k1 + k2));
    sketch_text(s, (point){(s->left + s->right) / 2, y + 50}, (anchor){0.5, 0}, text, SKETCH_LABEL);
}

status diagram_springs(const char *title, const figure_options *o, artwork *out, fault *f)
{
    assert(title != NULL && o != NULL && out != NULL);
    diagram *d = diagram_create(title, NULL, 108, o);
    double speed = 0;
    parameters defaults = d->p;
    status code = diagram_take_impact(d, "corrected/first-impact", &speed, f);
    if (code != STATUS_OK) {
        diagram_release(d);
        return code;
    }

    // drawn with the defaults, not with the run's wall
    d->p = defaults;
    d->draw = draw_springs;
    add_arm_values(d);

    diagram_add_value(d, "stiffness in series",
                      d->p.arm.k1 * d->p.arm.k2 / (d->p.arm.k1 + d->p.arm.k2), "N m/rad");
    diagram_add_value(d, "approach speed", speed, "m/s");
    diagram_add_value(d, "impulse", d->impulse, "N s");
    diagram_add_value(d, "mass at the contact point", d->impulse / speed, "kg");

    d->caption = text_printf(
        "What the wall feels: a mass on the arm's springs in series. The stiff hub joint hardly "
        "counts, the beam's spring takes almost all the energy. At 1\u2009V the contact point "
        "arrives with <i>v</i><sub>0</sub> = %.3g\u2009m/s and the impact of %.3g\u2009N·s shows a "
        "mass <i>m</i><sub>c</sub> = %.3g\u2009kg there, of the beam's %.3g\u2009kg. "
        "<i>k</i><sub>1</sub> as the thesis prints it; its tables need 90\u2009N·m/rad.",
        speed, d->impulse, d->impulse / speed, d->p.arm.mass);
    d->frame.caption = d->caption;

    *out = artwork_of_diagram(d);
    return STATUS_OK;
}
