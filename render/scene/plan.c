// The arm from above: wall, beam, hub, force, and a spring that pulls, as cairo draws
// them.
#include "render/scene/plan.h"

#include <assert.h>
#include <glib.h>
#include <math.h>

#include "render/page/picture_file.h"

// Sizes in beam lengths; the least of them in pixels where the arm is small.
#define BEAM_WIDTH 0.012
#define PIN_RADIUS 0.008
#define SLAB_FROM  0.93 // of a flat wall, along the arm
#define SLAB_TO    1.07
#define COIL_TURNS 10

// A plan in the making.
typedef struct plan_painter {
    cairo_t *cr;
    const plan *plan;
    const plan_view *view;
    vector *joints, *curve;
} plan_painter;

// A length in beam lengths as pixels, not less than `least`.
static double size_of(const plan_painter *g, double lengths, double least)
{
    return fmax(least, lengths * g->plan->parameters->arm.length * g->view->scale);
}

static void pen(const plan_painter *g, colour c, double width)
{
    set_colour(g->cr, c);
    cairo_set_dash(g->cr, NULL, 0, 0);
    cairo_set_line_width(g->cr, width);
    cairo_set_line_cap(g->cr, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(g->cr, CAIRO_LINE_JOIN_ROUND);
}

// A colour on its way to the ground.
static colour paler(const plan_painter *g, colour c, double share)
{
    return colour_between(c, g->plan->colours.ground, share);
}

// A disc with a rim of the present colour, paler inside.
static void disc(const plan_painter *g, double x, double y, double radius, colour c,
                 double share)
{
    cairo_new_path(g->cr);
    cairo_arc(g->cr, x, y, radius, 0, 2 * M_PI);
    set_colour(g->cr, paler(g, c, share));
    cairo_fill_preserve(g->cr);
    set_colour(g->cr, c);
    cairo_stroke(g->cr);
}

// --- what stands still -----------------------------------------------------------------

// Short strokes behind a line, from (x, y) on along (dx, dy) [pixels].
static void hatch(const plan_painter *g, double x, double y, double dx, double dy)
{
    const double length = hypot(dx, dy), step = 7, depth = 9;
    const double ux = dx / length, uy = dy / length;
    for (double at = 0; at <= length; at += step) {
        cairo_move_to(g->cr, x + at * ux, y + at * uy);
        cairo_line_to(g->cr, x + at * ux + depth * (0.5 * ux + uy),
                      y + at * uy + depth * (0.5 * uy - ux));
    }
    cairo_stroke(g->cr);
}

// A flat wall lies along the arm, on the far side of it; any wall has the place where the
// tip meets it.
static void paint_wall(const plan_painter *g)
{
    const parameters *p = g->plan->parameters;
    const sample row = scene_joints(g->plan->rows, p, g->plan->time, g->joints);
    const vector shift = scene_wall_shift(p, &row);
    const colour wall = g->plan->colours.wall;
    const double off = 0.5 * size_of(g, BEAM_WIDTH, 3), l = p->arm.length;
    if (p->wall.kind == WALL_NONE) {
        return;
    }

    // across the arm, half the beam away: up on the page
    const double hub_x = plan_x(g->view, shift.x), hub_y = plan_y(g->view, shift.y);
    const double tip_x = plan_x(g->view, l * cos(p->wall.angle) + shift.x);
    const double tip_y = plan_y(g->view, l * sin(p->wall.angle) + shift.y);
    const double along_x = tip_x - hub_x, along_y = tip_y - hub_y,
                 length = hypot(along_x, along_y);
    const double nx = along_y / length, ny = -along_x / length;

    // a flat wall: its face, hatched behind
    if (p->wall.kind == WALL_PLANE) {
        const double from_x = hub_x + SLAB_FROM * along_x + off * nx;
        const double from_y = hub_y + SLAB_FROM * along_y + off * ny;
        const double dx = (SLAB_TO - SLAB_FROM) * along_x,
                     dy = (SLAB_TO - SLAB_FROM) * along_y;
        pen(g, wall, 1);
        hatch(g, from_x, from_y, dx, dy);
        pen(g, wall, 2);
        picture_line(g->cr, from_x, from_y, from_x + dx, from_y + dy);
        return;
    }

    // a point: a pin that the beam's edge meets
    const double radius = size_of(g, PIN_RADIUS, 4);
    pen(g, wall, 1.5);
    disc(g, tip_x + (off + radius) * nx, tip_y + (off + radius) * ny, radius, wall, 0.5);
}

// --- the arm ---------------------------------------------------------------------------

// The beam's curve at an instant of a run as cairo's path; returns the row there.
static sample beam_path(const plan_painter *g, const trace *rows)
{
    const int links = g->plan->parameters->arm.links;
    const sample row = scene_joints(rows, g->plan->parameters, g->plan->time, g->joints);
    scene_exaggerate(g->joints, links, g->plan->exaggerate);
    const int count = scene_curve(g->joints, links, g->curve);
    cairo_new_path(g->cr);
    for (int i = 0; i < count; i++) {
        cairo_line_to(g->cr, plan_x(g->view, g->curve[i].x),
                      plan_y(g->view, g->curve[i].y));
    }
    return row;
}

// The wall's force on the tip: an arrow that points at it, as long as its share of the
// peak.
static void paint_force(const plan_painter *g, double x, double y, const sample *row)
{
    double share = 0;
    if (row->contact > 0 && g->plan->peak > 0) {
        share = row->force / g->plan->peak;
    }
    const double length = 0.42 * g->view->height * fmin(share, 1),
                 head = fmin(10, length);
    const double off = 0.5 * size_of(g, BEAM_WIDTH, 3) + 1;
    if (!(length > 1)) {
        return;
    }

    // the shaft, and a head at the beam's edge
    pen(g, g->plan->colours.force, 3);
    cairo_set_line_cap(g->cr, CAIRO_LINE_CAP_BUTT);
    picture_line(g->cr, x, y - off - length, x, y - off - 0.8 * head);
    cairo_move_to(g->cr, x, y - off);
    cairo_line_to(g->cr, x - 0.45 * head, y - off - head);
    cairo_line_to(g->cr, x + 0.45 * head, y - off - head);
    cairo_close_path(g->cr);
    cairo_fill(g->cr);
}

// The spring that pulls at the tip: a zigzag between straight ends.
static void paint_pull(const plan_painter *g, double x, double y)
{
    const double to_x = plan_x(g->view, g->plan->pull_x),
                 to_y = plan_y(g->view, g->plan->pull_y);
    const double length = hypot(to_x - x, to_y - y);
    if (!g->plan->pulled || !(length > 1)) {
        return;
    }
    const double ux = (to_x - x) / length, uy = (to_y - y) / length,
                 wide = fmin(6, 0.2 * length);

    // from the tip to the point that pulls
    pen(g, g->plan->colours.force, 1.5);
    cairo_move_to(g->cr, x, y);
    for (int i = 0; i <= COIL_TURNS; i++) {
        const double along = length * (0.1 + 0.8 * i / COIL_TURNS);
        double across = i % 2 == 1 ? wide : -wide;
        if (i == 0 || i == COIL_TURNS) {
            across = 0;
        }
        cairo_line_to(g->cr, x + along * ux - across * uy, y + along * uy + across * ux);
    }
    cairo_line_to(g->cr, to_x, to_y);
    cairo_stroke(g->cr);
    cairo_arc(g->cr, to_x, to_y, 3, 0, 2 * M_PI);
    cairo_fill(g->cr);
}

// Paints the plan on its ground, which is there already.
static void paint_plan_parts(const plan_painter *g)
{
    const plan *p = g->plan;
    const int links = p->parameters->arm.links;
    const double beam = size_of(g, BEAM_WIDTH, 3);

    // from the back to the front: the wall, the other run, the hub, the beam and its
    // forces
    paint_wall(g);
    if (p->other != NULL) {
        beam_path(g, p->other);
        pen(g, paler(g, p->colours.other, 0.35), fmax(1.5, 0.5 * beam));
        cairo_stroke(g->cr);
    }
    const sample row = beam_path(g, p->rows);
    cairo_path_t *path = cairo_copy_path(g->cr);

    // the hub with a spoke that tells its angle
    const double hub_x = plan_x(g->view, 0), hub_y = plan_y(g->view, 0);
    const double radius = plan_hub_radius(g->view, p->parameters->arm.length);
    pen(g, p->colours.hub, 2);
    disc(g, hub_x, hub_y, radius, p->colours.hub, 0.75);
    picture_line(g->cr, hub_x, hub_y, hub_x + radius * cos(row.hub_angle),
                 hub_y - radius * sin(row.hub_angle));

    // a rim, and the beam's own colour inside it
    cairo_new_path(g->cr);
    cairo_append_path(g->cr, path);
    cairo_path_destroy(path);
    pen(g, p->colours.arm, beam);
    cairo_stroke_preserve(g->cr);
    pen(g, paler(g, p->colours.arm, 0.45), fmax(1, beam - 3));
    cairo_stroke(g->cr);

    const double x = plan_x(g->view, g->joints[links].x),
                 y = plan_y(g->view, g->joints[links].y);
    paint_force(g, x, y, &row);
    paint_pull(g, x, y);
}

void plan_paint(cairo_t *cr, const plan *p, const plan_view *v)
{
    assert(p->rows->row_count > 0);
    assert(v->scale > 0 && v->magnified > 0 && isfinite(p->time));
    const int links = p->parameters->arm.links;
    g_autofree vector *joints = g_new(vector, links + 1);
    g_autofree vector *curve = g_new(vector, scene_curve_length(links));

    // nothing leaves the picture
    cairo_save(cr);
    cairo_rectangle(cr, 0, 0, v->width, v->height);
    cairo_clip(cr);
    set_colour(cr, p->colours.ground);
    cairo_paint(cr);
    paint_plan_parts(&(plan_painter){cr, p, v, joints, curve});
    cairo_restore(cr);
}
