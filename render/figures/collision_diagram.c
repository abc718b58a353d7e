// Figure 4.2: the arm as it hits, and its last body cut free, with the impulses of (4.1)-(4.5).
#include <assert.h>
#include <math.h>

#include "render/figures/diagram.h"

#define ACROSS         8.0   // enlargement across the line to the contact point
#define SPEED_LENGTH   70.0  // page points to 1 m/s
#define IMPULSE_LENGTH 900.0 // page points to 1 N s
#define BODY_LENGTH    220.0 // of the cut body on the page [pt]
#define BODY_HEIGHT    116.0 // of the space that it has [pt]

// The last body at the impact: what (4.3)-(4.5) say of it. Vectors are given by their part across
// the body, to the left of the way from its hinge to its end.
typedef struct cut_body {
    double mass, inertia; // m [kg], J about its centre of mass [kg m2]
    double half, rho;     // from the centre to the hinge, and to the point of collision [m]
    double wall_impulse;  // F [N s]
    double hinge_impulse; // X [N s]
    double hinge_torque;  // Y, about the centre of mass [N m s]
    double centre_jump;   // of the centre's velocity [m/s]
    double angular_jump;  // [rad/s]
    double point_jump;    // of the point of collision's velocity [m/s]
} cut_body;

// Cuts the last link free: X from (4.3), Y from (4.4), the point of collision from (4.5).
static cut_body cut_last_body(const diagram *d)
{
    double l = d->p.arm.length / 2, length = d->p.arm.length, wall = d->p.wall.angle;
    double last = d->before.angle[2], bend = last - d->before.angle[1];
    double from_hinge = length * cos(last - wall) - l * cos(bend);
    double first_jump = d->after[1] - d->before.velocity[1];
    cut_body b = {.mass = d->p.arm.mass / 2,
                  .inertia = d->p.arm.link_inertia,
                  .half = l / 2,
                  .rho = from_hinge - l / 2,
                  .wall_impulse = -d->impulse,
                  .angular_jump = d->after[2] - d->before.velocity[2]};

    b.centre_jump = l * cos(bend) * first_jump + b.half * b.angular_jump;
    b.hinge_impulse = b.mass * b.centre_jump - b.wall_impulse;
    b.hinge_torque = b.inertia * b.angular_jump - b.rho * b.wall_impulse;
    b.point_jump = b.centre_jump + b.rho * b.angular_jump;
    return b;
}

// "X = −0.0123 N·s" with three digits.
static void write_value(sketch *s, point at, double ax, const char *symbol, double value,
                        const char *unit)
{
    g_autofree char *number = text_number(value, 3), *shown = text_unit(unit);
    sketch_small(s, at, (anchor){ax, 0.5}, "%s = %s\u2009%s", symbol, number, shown);
}

// The whole arm, its hinge to the last body cut.
static void draw_arm(sketch *s, const diagram *d)
{
    double l = d->p.arm.length / 2, wall = d->p.wall.angle;
    view v = {s->left + 40, s->top + 62, 270, ACROSS};
    point joint = view_end((point){0, 0}, l, d->before.angle[1] - wall);
    point hub_page = view_place(&v, (point){0, 0}), joint_page = view_place(&v, joint);
    point contact = view_place(&v, (point){d->p.arm.length, 0});
    double joint_before = l * d->before.velocity[1], joint_after = l * d->after[1];
    double tip_before = joint_before + l * d->before.velocity[2];

    // the wall and the arm
    sketch_wall(s, shifted(contact, 34, -5), shifted(contact, -6, -5));
    sketch_dashed(s, hub_page, contact, SKETCH_FAINT);
    sketch_bar(s, hub_page, joint_page, 7);
    sketch_bar(s, joint_page, contact, 7);
    sketch_disc(s, hub_page, 14, SKETCH_INK, false);
    sketch_disc(s, hub_page, 2, SKETCH_INK, true);
    sketch_disc(s, joint_page, 2.6, SKETCH_INK, true);
    sketch_small(s, shifted(hub_page, 0, 18), (anchor){0.5, 0}, "hub");
    sketch_small(s, shifted(contact, 8, 4), (anchor){0, 0}, "(<i>a</i>, <i>b</i>)");

    // velocities of the joint: before to the left of it, after to the right
    double y = joint_page.y - 6;
    sketch_arrow(s, (point){joint_page.x - 6, y},
                 (point){joint_page.x - 6, y - SPEED_LENGTH * joint_before}, 2);
    sketch_dashed_arrow(s, (point){joint_page.x + 6, y},
                        (point){joint_page.x + 6, y - SPEED_LENGTH * joint_after}, 1);
    sketch_small(s, (point){joint_page.x - 12, y - 4}, (anchor){1, 1}, "before\n%.3f\u2009m/s",
                 joint_before);
    sketch_small(s, (point){joint_page.x + 12, y - 4}, (anchor){0, 1}, "after\n%.3f\u2009m/s",
                 joint_after);

    // the tip arrives, and is stopped by the wall's impulse
    sketch_arrow(s, shifted(contact, -8, 6 + SPEED_LENGTH * tip_before), shifted(contact, -8, 6),
                 2);
    sketch_small(s, shifted(contact, -14, 14), (anchor){1, 0},
                 "before\n%.3f\u2009m/s\nafter: at rest", tip_before);
    sketch_arrow(s, shifted(contact, 0, -50), shifted(contact, 0, -6), 5);
    sketch_small(s, shifted(contact, 0, -53), (anchor){0.5, 1}, "impulse %.4f\u2009N·s",
                 d->impulse);

    // where the last body is cut free
    sketch_dashed(s, shifted(joint_page, 0, -12), shifted(joint_page, 0, 34), SKETCH_FAINT);
    sketch_small(s, shifted(joint_page, -4, 34), (anchor){1, 1}, "cut");
}

// The last body on its own, along the page.
static void draw_cut_body(sketch *s, const diagram *d)
{
    const cut_body b = cut_last_body(d);
    double y = s->bottom - 66, metre = BODY_LENGTH / (2 * b.half);
    point centre = {s->left + 74 + BODY_LENGTH / 2, y};
    point hinge = {centre.x - metre * b.half, y}, hit = {centre.x + metre * b.rho, y};

    sketch_bar(s, hinge, (point){centre.x + metre * b.half, y}, 9);
    sketch_mass_point(s, centre);
    sketch_disc(s, hinge, 2.6, SKETCH_INK, true);
    sketch_label(s, (point){centre.x - 5, y - 7}, (anchor){1, 1}, "<i>C</i>");
    sketch_label(s, (point){hit.x + 8, y + 3}, (anchor){0, 0}, "<i>P</i>");

    // impulses of wall and hinge: an arrow that points down ends at the body
    double wall = IMPULSE_LENGTH * fabs(b.wall_impulse);
    double pin = IMPULSE_LENGTH * b.hinge_impulse;
    sketch_arrow(s, (point){hit.x, y - 6 - wall}, (point){hit.x, y - 6}, 5);
    write_value(s, (point){hit.x, y - 14 - wall}, 0.5, "<i>F̂</i><sup>c</sup>", b.wall_impulse,
                "N s");
    sketch_arrow(s, (point){hinge.x, pin > 0 ? y - 6 : y - 6 + pin},
                 (point){hinge.x, pin > 0 ? y - 6 - pin : y - 6}, 5);
    write_value(s, (point){hinge.x, y - 14 - fabs(pin)}, 0.5, "<i>X̂</i><sup>c</sup>",
                b.hinge_impulse, "N s");

    // the hinge's torque about C, and how the body's motion jumps
    sketch_arc(
        s, (arc){hinge, 18, b.hinge_torque < 0 ? 3.7 : 2.6, b.hinge_torque < 0 ? 2.6 : 3.7, true},
        0);
    write_value(s, (point){hinge.x - 4, y + 44}, 0.5, "<i>Ŷ</i><sup>c</sup>", b.hinge_torque,
                "N m s");
    double jump = SPEED_LENGTH * b.centre_jump, from = b.centre_jump < 0 ? y + 7 : y - 7;
    sketch_dashed_arrow(s, (point){centre.x, from}, (point){centre.x, from - jump}, 1);
    write_value(s, (point){centre.x - 8, from - 0.7 * jump}, 1, "Δ<i>v</i><sub>C</sub>",
                b.centre_jump, "m/s");
    sketch_arc(s,
               (arc){(point){centre.x, y}, 30, b.angular_jump < 0 ? -0.5 : -1.6,
                     b.angular_jump < 0 ? -1.6 : -0.5, true},
               1);
    write_value(s, (point){centre.x + 30, y + 22}, 0, "Δ<i>ω</i>", b.angular_jump, "rad/s");

    // the lever of the wall's impulse
    sketch_measure(s, (point){centre.x, y + 42}, (point){hit.x, y + 42});
    write_value(s, (point){(centre.x + hit.x) / 2, y + 50}, 0.5, "<i>ρ</i>", b.rho, "m");
}

static void draw_collision(sketch *s, const diagram *d)
{
    draw_arm(s, d);
    draw_cut_body(s, d);
}

status diagram_collision(const figure_order *order, artwork *out, fault *f)
{
    g_autoptr(diagram) d = diagram_create(order, NULL, 140 + BODY_HEIGHT, draw_collision, f);
    FAIL_IF(d == NULL, f->code);

    // the impact, and what the links do after it
    double speed = 0, impulse = 0;
    TRY(diagram_take_impact(d, &speed, f));
    TRY(predict_velocity_jump(&d->p, &d->before, d->after, &impulse, f));

    // angles and velocities of both links
    static const char *const bodies[] = {"hub", "first link", "last link"};
    for (int i = 1; i < 3; i++) {
        diagram_add_value(d, bodies[i], d->before.angle[i], "rad");
        diagram_add_value(d, bodies[i], d->before.velocity[i], "rad/s before");
        diagram_add_value(d, bodies[i], d->after[i], "rad/s after");
    }
    diagram_add_value(d, "approach speed", speed, "m/s");

    // and of the cut body
    const cut_body b = cut_last_body(d);
    diagram_add_value(d, "mass m", b.mass, "kg");
    diagram_add_value(d, "inertia J", b.inertia, "kg m2");
    diagram_add_value(d, "lever rho", b.rho, "m");
    diagram_add_value(d, "wall impulse F", b.wall_impulse, "N s");
    diagram_add_value(d, "hinge impulse X", b.hinge_impulse, "N s");
    diagram_add_value(d, "hinge torque impulse Y", b.hinge_torque, "N m s");
    diagram_add_value(d, "jump of the centre's velocity", b.centre_jump, "m/s");
    diagram_add_value(d, "jump of the point of collision's velocity", b.point_jump, "m/s");

    return diagram_open(
        &d, out,
        "Above: the arm of corrected/first-impact at the instant of its first contact, seen along "
        "the line to the contact point and enlarged %g times across it; the links' angular "
        "velocities jump from %.3f and %.3f\u2009rad/s to %.3f and \u2212%.3f\u2009rad/s. Below: "
        "its last body cut free, with the impulse <i>F̂</i><sup>c</sup> of the wall, impulse "
        "<i>X̂</i><sup>c</sup> and torque <i>Ŷ</i><sup>c</sup> about <i>C</i> of the hinge, and the "
        "jumps that they make, (4.3) to (4.5). Parts across the body, up and counterclockwise "
        "positive; solid arrows act, dashed ones follow.",
        ACROSS, d->before.velocity[1], d->before.velocity[2], d->after[1], fabs(d->after[2]));
}
