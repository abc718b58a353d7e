// Figures 3.1, 4.6 and 4.2: the arm in contact, at two successive steps and at its
// largest deformation; as it hits, and its last body cut free, with the impulses of
// (4.1)-(4.5).
#include <math.h>

#include "render/figures/diagram.h"

#define CONTACT_ACROSS 6.0  // enlargement of what lies across the reference line, 3.1
#define PEAK_ACROSS    9.0  // across the line to the contact point, 4.6
#define FORCE_LENGTH   40.0 // of the arrow of the contact force [pt]

static arm_shape shape_of(const sample *row)
{
    return (arm_shape){row->first_angle, row->last_angle, row->force, row->time};
}

// ---- what the diagrams of the arm's shape share

// Positions of hub, joint and tip on the page.
typedef struct arm_places {
    point hub, joint, end;
} arm_places;

// The positions of a shape of the arm, in a view in which the direction with the angle
// `base` points to the right.
static arm_places places_of(const view *v, const diagram *d, arm_shape a, double base)
{
    double l = d->p.arm.length / 2;
    point joint = view_end((point){0, 0}, l, a.first - base);
    return (arm_places){view_place(v, (point){0, 0}), view_place(v, joint),
                        view_place(v, view_end(joint, l, a.last - base))};
}

// Direction on the page from one place to another, counterclockwise from the right [rad].
static double page_direction(point from, point to)
{
    return atan2(from.y - to.y, to.x - from.x);
}

static void draw_dashed_arm(const sketch *s, arm_places a, int slot)
{
    sketch_dashed(s, a.hub, a.joint, slot);
    sketch_dashed(s, a.joint, a.end, slot);
    sketch_disc(s, a.joint, 2, slot, true);
}

// Draws the arm with its hub, its joint and both links as bars.
static void draw_full_arm(const sketch *s, arm_places a)
{
    sketch_bar(s, a.hub, a.joint, 5);
    sketch_bar(s, a.joint, a.end, 5);
    sketch_disc(s, a.joint, 2.4, SKETCH_INK, true);
    sketch_disc(s, a.hub, 12, SKETCH_INK, false);
    sketch_disc(s, a.hub, 2, SKETCH_INK, true);
}

// Draws the wall and the contact force at a place of a link; the force is at right angles
// to the link's direction on the page.
static void draw_contact_force(sketch *s, point at, double direction, const char *symbol,
                               double force)
{
    g_autofree char *quantity = text_quantity(force, 3, "N");

    // unit vectors on the page along the link and across it
    double ux = cos(direction), uy = -sin(direction);
    double nx = -sin(direction), ny = -cos(direction);
    point wall = {at.x + 4 * nx, at.y + 4 * ny};
    sketch_wall(s, shifted(wall, 16 * ux, 16 * uy), shifted(wall, -16 * ux, -16 * uy));

    // the arrow ends at the link, its label is at its beginning
    point start = {at.x + (FORCE_LENGTH + 4) * nx, at.y + (FORCE_LENGTH + 4) * ny};
    sketch_arrow(s, start, shifted(at, 4 * nx, 4 * ny), SLOT_VERMILLION);
    sketch_label(s, shifted(start, 4 * nx, 4 * ny), (anchor){0.5, 1}, "%s = %s", symbol,
                 quantity);
}

// ---- 3.1: two successive steps

// Draws the reference line from the hub, and the contact point's coordinates: a along the
// line to the foot of the perpendicular, b from there to the point.
static void draw_coordinates(sketch *s, point hub, point foot, point contact)
{
    const double extension = 46; // of the dashed lines past the point [pt]
    sketch_dashed(s, hub, shifted(foot, extension, 0), SKETCH_FAINT);
    sketch_dashed(s, contact, shifted(contact, extension, 0), SKETCH_FAINT);

    sketch_measure(s, (point){hub.x, foot.y + 16}, shifted(foot, 0, 16));
    sketch_label(s, (point){(hub.x + foot.x) / 2, foot.y + 18}, (anchor){0.5, 0},
                 "<i>a</i>");
    sketch_measure(s, (point){contact.x + 38, foot.y}, shifted(contact, 38, 0));
    sketch_label(s, (point){contact.x + 42, (foot.y + contact.y) / 2}, (anchor){0, 0.5},
                 "<i>b</i>");
    sketch_label(s, shifted(contact, 8, 3), (anchor){0, 0}, "(<i>a</i>, <i>b</i>)");
}

// Draws the key at the page's upper left corner: which instant each shape is of.
static void draw_shape_key(sketch *s, const arm_shapes *of)
{
    const point full = {s->left + 4, s->top + 14}, dashed = shifted(full, 0, 14);
    const double length = 22, text = 28;
    sketch_bar(s, full, shifted(full, length, 0), 5);
    sketch_small(s, shifted(full, text, 0), (anchor){0, 0.5}, "<i>t</i> = %.2f\u2009s",
                 of->one.time);
    sketch_dashed(s, dashed, shifted(dashed, length, 0), SLOT_BLUE);
    sketch_small(s, shifted(dashed, text, 0), (anchor){0, 0.5},
                 "the next step, <i>t</i> = %.2f\u2009s", of->other.time);
}

// Writes the name of a link's length, `left` and `up` from the link's middle.
static void label_length(sketch *s, point from, point to, double left, double up)
{
    const point middle = {(from.x + to.x) / 2, (from.y + to.y) / 2};
    sketch_label(s, shifted(middle, -left, -up), (anchor){1, 1}, "<i>l</i>");
}

// Draws the arm at two successive steps over the reference line.
static void draw_contact_diagram(sketch *s, const diagram *d)
{
    const arm_shapes *of = &d->shapes;
    const view v = {s->left + 34, s->bottom - 30, 255, CONTACT_ACROSS};
    const double a = d->p.arm.length * cos(d->p.wall.angle);
    const double b = d->p.arm.length * sin(d->p.wall.angle);
    const point contact = view_place(&v, (point){a, b});
    const arm_places one = places_of(&v, d, of->one, 0);
    const arm_places other = places_of(&v, d, of->other, 0);
    draw_coordinates(s, one.hub, view_place(&v, (point){a, 0}), contact);

    // both configurations, and the angles of the first
    draw_full_arm(s, one);
    draw_dashed_arm(s, other, SLOT_BLUE);
    diagram_link_angle(s, one.hub, 84, page_direction(one.hub, one.joint),
                       "<i>θ</i><sub>2</sub>");
    diagram_link_angle(s, one.joint, 62, page_direction(one.joint, one.end),
                       "<i>θ</i><sub>3</sub>");
    label_length(s, one.hub, one.joint, 10, 6);
    label_length(s, one.joint, one.end, 8, 8);
    draw_contact_force(s, contact, page_direction(one.joint, contact), "<i>f</i>",
                       of->one.force);
    draw_shape_key(s, of);
}

// The pair of successive rows in contact between which the first link turns most.
static size_t liveliest_pair(const trace *t)
{
    size_t best = 0;
    double most = -1;
    for (size_t i = 0; i + 1 < t->row_count; i++) {
        const sample *a = &t->rows[i], *b = a + 1;
        double turn = fabs(b->first_angle - a->first_angle);
        if (a->contact > 0.5 && b->contact > 0.5 && b->time > a->time && turn > most) {
            most = turn;
            best = i;
        }
    }
    return best;
}

static void add_shape_values(diagram *d, const arm_shape *a)
{
    diagram_add_value(d, "time", a->time, "s");
    diagram_add_value(d, "theta2", a->first, "rad");
    diagram_add_value(d, "theta3", a->last, "rad");
    diagram_add_value(d, "force f", a->force, "N");
}

// Makes figure 3.1: the arm in contact at two successive steps.
status diagram_contact(const figure_order *order, artwork *out, fault *f)
{
    g_autoptr(diagram) d =
        diagram_create(order, "method.step=0.01", 232, draw_contact_diagram, f);
    if (d == NULL) {
        return f->code;
    }

    // two steps during contact
    const trace *t = &d->run->result.trace;
    const size_t first = liveliest_pair(t), second = MIN(first + 1, t->row_count - 1);
    arm_shapes *of = &d->shapes;
    of->one = shape_of(&t->rows[first]);
    of->other = shape_of(&t->rows[second]);

    // the numbers, and what is left of the constraint (3.9)
    const double a = d->p.arm.length * cos(d->p.wall.angle);
    const double b = d->p.arm.length * sin(d->p.wall.angle);
    diagram_add_value(d, "a", a, "m");
    diagram_add_value(d, "b", b, "m");
    add_shape_values(d, &of->one);
    add_shape_values(d, &of->other);
    diagram_add_value(d, "constraint (3.9)",
                      a * sin(of->one.last) - b * cos(of->one.last) -
                          d->p.arm.length / 2 * sin(of->one.last - of->one.first),
                      "m");

    return diagram_open(
        &d, out,
        "The printed model in contact, 1\u2009V, at two successive steps of "
        "10\u2009ms: <i>θ</i><sub>2</sub> = %.4f and %.4f, "
        "<i>θ</i><sub>3</sub> = %.4f and %.4f\u2009rad. The line of the last "
        "link always passes through the contact point (<i>a</i>, <i>b</i>) = "
        "(%.4f, %.4f)\u2009m, (3.9). <i>k</i><sub>1</sub> = %g\u2009N·m/rad. "
        "Enlarged %g times across the reference line, angles with it.",
        of->one.first, of->other.first, of->one.last, of->other.last, a, b, d->p.arm.k1,
        CONTACT_ACROSS);
}

// ---- 4.6: the largest deformation

// Draws the arm at its peak force, at first contact, and as the energy principle predicts
// it.
static void draw_deformation(sketch *s, const diagram *d)
{
    const arm_shapes *of = &d->shapes;
    double wall = d->p.wall.angle;
    view v = {s->left + 34, s->bottom - 42, 265, PEAK_ACROSS};
    point contact = view_place(&v, (point){d->p.arm.length, 0});
    arm_places peak = places_of(&v, d, of->one, wall),
               touch = places_of(&v, d, of->other, wall);
    arm_places assumed = places_of(&v, d, of->assumed, wall);

    // the line to the contact point, and the three shapes
    sketch_dashed(s, peak.hub, contact, SKETCH_FAINT);
    draw_dashed_arm(s, touch, SKETCH_FAINT);
    draw_dashed_arm(s, assumed, SLOT_ORANGE);
    draw_full_arm(s, peak);
    sketch_label(s, shifted(contact, 8, 3), (anchor){0, 0}, "(<i>a</i>, <i>b</i>)");
    sketch_label(s, shifted(peak.hub, 0, 15), (anchor){0.5, 0}, "<i>O</i>");

    // angles from that line
    diagram_angle(s, peak.hub,
                  (angle_arc){92, 0, page_direction(peak.hub, peak.joint),
                              "<i>θ</i><sub>2</sub> − <i>θ</i><sub>0</sub>"});
    diagram_link_angle(s, peak.joint, 66, page_direction(peak.joint, peak.end),
                       "<i>θ</i><sub>3</sub> − <i>θ</i><sub>0</sub>");

    draw_contact_force(s, contact, page_direction(peak.joint, contact),
                       "<i>f</i><sub>max</sub>", of->one.force);

    // a name at each joint
    sketch_small(s, shifted(assumed.joint, 0, -5), (anchor){0.5, 1}, "energy principle");
    sketch_small(s, shifted(peak.joint, 0, 14), (anchor){0.5, 0}, "at the peak");
    sketch_small(s, (point){touch.joint.x, peak.hub.y + 4}, (anchor){0.5, 0},
                 "at first contact");
}

// The row whose time is nearest to an instant [s].
static const sample *row_at(const trace *t, double time)
{
    const sample *best = &t->rows[0];
    for (size_t i = 1; i < t->row_count; i++) {
        if (fabs(t->rows[i].time - time) < fabs(best->time - time)) {
            best = &t->rows[i];
        }
    }
    return best;
}

// The last row before the impact at the time `contact` makes the velocities jump.
static const sample *row_before(const trace *t, double contact)
{
    const sample *before = &t->rows[0];
    for (size_t i = 0; i < t->row_count && t->rows[i].contact < 0.5; i++) {
        if (t->rows[i].time <= contact) {
            before = &t->rows[i];
        }
    }
    return before;
}

// Makes figure 4.6: the arm at its largest deformation.
status diagram_deformation(const figure_order *order, artwork *out, fault *f)
{
    g_autoptr(diagram) d = diagram_create(order, NULL, 148, draw_deformation, f);
    if (d == NULL) {
        return f->code;
    }
    const summary *m = &d->run->result.summary;
    if (!isfinite(m->first_pulse_time_to_peak_s)) {
        return diagram_lacks(d, "pulse", f);
    }

    // first contact and the peak
    const trace *t = &d->run->result.trace;
    const sample *before = row_before(t, m->first_contact_s);
    const double delay = m->first_pulse_time_to_peak_s;
    const double energy = before->kinetic_energy + before->strain_energy;
    arm_shapes *of = &d->shapes;
    of->one = shape_of(row_at(t, m->first_contact_s + delay));
    of->one.force = m->first_pulse_peak_N;
    of->other = shape_of(before);

    // half the bend on either side of the line, as the energy principle has it
    double wall = d->p.wall.angle, bend = sqrt(2 * energy / d->p.arm.k2);
    of->assumed = (arm_shape){.first = wall + bend / 2, .last = wall - bend / 2};
    diagram_add_value(d, "theta0", wall, "rad");
    add_shape_values(d, &of->one);
    add_shape_values(d, &of->other);
    diagram_add_value(d, "bend by the energy principle", -bend, "rad");

    return diagram_open(
        &d, out,
        "The arm of corrected/first-impact %.1f\u2009ms after first contact, at its "
        "peak force of %.3g\u2009N: <i>θ</i><sub>2</sub> = %.4f, <i>θ</i><sub>3</sub> "
        "= %.4f\u2009rad, bend \u2212%.4f\u2009rad; <i>θ</i><sub>0</sub> = %g\u2009rad "
        "is the line to the contact point. The energy principle puts the %.3g\u2009mJ "
        "before contact into the spring, half the bend on either side of the line, "
        "\u2212%.4f\u2009rad, because it leaves out what the impact itself takes. "
        "Enlarged %g times across the line, angles with it.",
        1e3 * delay, of->one.force, of->one.first, of->one.last,
        fabs(of->one.last - of->one.first), wall, 1e3 * energy, bend, PEAK_ACROSS);
}

// ---- 4.2: the collision

#define ACROSS         8.0   // enlargement across the line to the contact point
#define SPEED_LENGTH   70.0  // page points to 1 m/s
#define IMPULSE_LENGTH 900.0 // page points to 1 N s
#define BODY_LENGTH    220.0 // of the cut body on the page [pt]
#define BODY_HEIGHT    116.0 // of the space that it has [pt]

// The last body at the impact, by (4.3)-(4.5). Vectors are given by their component
// across the body, positive to the left as seen from the hinge towards the end.
typedef struct cut_body {
    double mass, inertia; // m [kg], J about its centre of mass [kg m2]
    double half, rho; // from the centre to the hinge, and to the point of collision [m]
    double wall_impulse;  // F [N s]
    double hinge_impulse; // X [N s]
    double hinge_torque;  // Y, about the centre of mass [N m s]
    double centre_jump;   // of the centre's velocity [m/s]
    double angular_jump;  // [rad/s]
    double point_jump;    // of the point of collision's velocity [m/s]
} cut_body;

// Computes the impulses on the last link cut free:
//
//     X = m dv - F           (4.3)
//     Y = J domega - rho F   (4.4)
//
// with the jumps of its centre's velocity and of its angular velocity. The point of
// collision's velocity jumps by dv + rho domega, (4.5).
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

// Writes "X = −0.0123 N·s" with three digits; ax anchors it left (0), middle or right
// (1).
static void put_value(sketch *s, point at, double ax, const char *symbol, double value,
                      const char *unit)
{
    g_autofree char *number = text_number(value, 3), *shown = text_unit(unit);
    sketch_small(s, at, (anchor){ax, 0.5}, "%s = %s\u2009%s", symbol, number, shown);
}

// Draws the joint's velocities [m/s]: left of it that before the impact, right of it that
// after it.
static void draw_joint_velocities(sketch *s, point joint, double before, double after)
{
    const double beside = 6, above = joint.y - 6;
    const point left = {joint.x - beside, above}, right = {joint.x + beside, above};
    sketch_arrow(s, left, shifted(left, 0, -SPEED_LENGTH * before), SLOT_GREEN);
    sketch_dashed_arrow(s, right, shifted(right, 0, -SPEED_LENGTH * after), SLOT_ORANGE);
    sketch_small(s, shifted(left, -6, -4), (anchor){1, 1}, "before\n%.3f\u2009m/s",
                 before);
    sketch_small(s, shifted(right, 6, -4), (anchor){0, 1}, "after\n%.3f\u2009m/s", after);
}

// Draws how the tip arrives at a speed [m/s] and is stopped by the wall's impulse [N s].
static void draw_tip_stop(sketch *s, point contact, double speed, double impulse)
{
    const point below = shifted(contact, -8, 6), above = shifted(contact, 0, -50);
    sketch_arrow(s, shifted(below, 0, SPEED_LENGTH * speed), below, SLOT_GREEN);
    sketch_small(s, shifted(contact, -14, 14), (anchor){1, 0},
                 "before\n%.3f\u2009m/s\nafter: at rest", speed);
    sketch_arrow(s, above, shifted(contact, 0, -6), SLOT_VERMILLION);
    sketch_small(s, shifted(above, 0, -3), (anchor){0.5, 1}, "impulse %.4f\u2009N·s",
                 impulse);
}

// Draws the whole arm at the impact, and where its last body is cut free.
static void draw_hitting_arm(sketch *s, const diagram *d)
{
    const double l = d->p.arm.length / 2, wall = d->p.wall.angle;
    const view v = {s->left + 40, s->top + 62, 270, ACROSS};
    const point origin = {0, 0};
    const point elbow = view_end(origin, l, d->before.angle[1] - wall);
    const point hub = view_place(&v, origin), joint = view_place(&v, elbow);
    const point contact = view_place(&v, (point){d->p.arm.length, 0});

    // the wall and the arm
    sketch_wall(s, shifted(contact, 34, -5), shifted(contact, -6, -5));
    sketch_dashed(s, hub, contact, SKETCH_FAINT);
    sketch_bar(s, hub, joint, 7);
    sketch_bar(s, joint, contact, 7);
    sketch_disc(s, hub, 14, SKETCH_INK, false);
    sketch_disc(s, hub, 2, SKETCH_INK, true);
    sketch_disc(s, joint, 2.6, SKETCH_INK, true);
    sketch_small(s, shifted(hub, 0, 18), (anchor){0.5, 0}, "hub");
    sketch_small(s, shifted(contact, 8, 4), (anchor){0, 0}, "(<i>a</i>, <i>b</i>)");

    // how joint and tip move
    const double joint_before = l * d->before.velocity[1];
    draw_joint_velocities(s, joint, joint_before, l * d->after[1]);
    draw_tip_stop(s, contact, joint_before + l * d->before.velocity[2], d->impulse);

    // where the last body is cut free
    sketch_dashed(s, shifted(joint, 0, -12), shifted(joint, 0, 34), SKETCH_FAINT);
    sketch_small(s, shifted(joint, -4, 34), (anchor){1, 1}, "cut");
}

// An arc between two angles with a head that points as `sense` turns.
static arc turning_arc(point centre, double radius, double low, double high, double sense)
{
    if (sense < 0) {
        return (arc){centre, radius, high, low, true};
    }
    return (arc){centre, radius, low, high, true};
}

// Draws the last body on its own, with the impulses on it and the jumps that they make.
static void draw_cut_body(sketch *s, const diagram *d)
{
    const cut_body b = cut_last_body(d);
    const double y = s->bottom - 66, metre = BODY_LENGTH / (2 * b.half);
    const point centre = {s->left + 74 + BODY_LENGTH / 2, y};
    const point hinge = {centre.x - metre * b.half, y};
    const point end = {centre.x + metre * b.half, y};
    const point hit = {centre.x + metre * b.rho, y};

    // the body, its centre of mass and the point of collision
    sketch_bar(s, hinge, end, 9);
    sketch_mass_point(s, centre);
    sketch_disc(s, hinge, 2.6, SKETCH_INK, true);
    sketch_label(s, (point){centre.x - 5, y - 7}, (anchor){1, 1}, "<i>C</i>");
    sketch_label(s, (point){hit.x + 8, y + 3}, (anchor){0, 0}, "<i>P</i>");

    // impulses of wall and hinge: an arrow that points down ends at the body
    double wall = IMPULSE_LENGTH * fabs(b.wall_impulse);
    double pin = IMPULSE_LENGTH * b.hinge_impulse;
    sketch_arrow(s, (point){hit.x, y - 6 - wall}, (point){hit.x, y - 6}, SLOT_VERMILLION);
    put_value(s, (point){hit.x, y - 14 - wall}, 0.5, "<i>F̂</i><sup>c</sup>",
              b.wall_impulse, "N s");
    sketch_arrow(s, (point){hinge.x, y - 6 + fmin(0, pin)},
                 (point){hinge.x, y - 6 - fmax(0, pin)}, SLOT_VERMILLION);
    put_value(s, (point){hinge.x, y - 14 - fabs(pin)}, 0.5, "<i>X̂</i><sup>c</sup>",
              b.hinge_impulse, "N s");

    // the hinge's torque about C
    sketch_arc(s, turning_arc(hinge, 18, 2.6, 3.7, b.hinge_torque), SLOT_BLUE);
    put_value(s, (point){hinge.x - 4, y + 44}, 0.5, "<i>Ŷ</i><sup>c</sup>",
              b.hinge_torque, "N m s");

    // how the centre's velocity and the angular velocity jump
    const double jump = SPEED_LENGTH * b.centre_jump;
    double from = y - 7;
    if (b.centre_jump < 0) {
        from = y + 7;
    }
    sketch_dashed_arrow(s, (point){centre.x, from}, (point){centre.x, from - jump},
                        SLOT_ORANGE);
    put_value(s, (point){centre.x - 8, from - 0.7 * jump}, 1, "Δ<i>v</i><sub>C</sub>",
              b.centre_jump, "m/s");
    sketch_arc(s, turning_arc((point){centre.x, y}, 30, -1.6, -0.5, b.angular_jump),
               SLOT_ORANGE);
    put_value(s, (point){centre.x + 30, y + 22}, 0, "Δ<i>ω</i>", b.angular_jump, "rad/s");

    // the lever of the wall's impulse
    sketch_measure(s, (point){centre.x, y + 42}, (point){hit.x, y + 42});
    put_value(s, (point){(centre.x + hit.x) / 2, y + 50}, 0.5, "<i>ρ</i>", b.rho, "m");
}

static void draw_collision(sketch *s, const diagram *d)
{
    draw_hitting_arm(s, d);
    draw_cut_body(s, d);
}

// Makes figure 4.2: the collision.
status diagram_collision(const figure_order *order, artwork *out, fault *f)
{
    g_autoptr(diagram) d =
        diagram_create(order, NULL, 140 + BODY_HEIGHT, draw_collision, f);
    if (d == NULL) {
        return f->code;
    }

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
    diagram_add_value(d, "jump of the point of collision's velocity", b.point_jump,
                      "m/s");

    return diagram_open(
        &d, out,
        "Above: the arm of corrected/first-impact at the instant of its first contact, "
        "seen along the line to the contact point and enlarged %g times across it; the "
        "links' angular velocities jump from %.3f and %.3f\u2009rad/s to %.3f and "
        "\u2212%.3f\u2009rad/s. Below: its last body cut free, with the impulse "
        "<i>F̂</i><sup>c</sup> of the wall, impulse <i>X̂</i><sup>c</sup> and torque "
        "<i>Ŷ</i><sup>c</sup> about <i>C</i> of the hinge, and the jumps that they "
        "make, (4.3) to (4.5). Parts across the body, up and counterclockwise "
        "positive; solid arrows act, dashed ones follow.",
        ACROSS, d->before.velocity[1], d->before.velocity[2], d->after[1],
        fabs(d->after[2]));
}
