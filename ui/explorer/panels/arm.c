// The arm, its wall and the contact force, drawn live.
#include "ui/explorer/panels/panel.h"

#include <math.h>

typedef struct point {
    double x, y; // [m]
} point;

// From metres to the dots of a canvas, the height magnified.
typedef struct view {
    canvas canvas;
    double left, bottom; // [m]
    double scale;        // [dots/m] across
    double magnified;    // times that, up
} view;

static double dot_x(const view *v, double x)
{
    return (x - v->left) * v->scale;
}

static double dot_y(const view *v, double y)
{
    return 4.0 * v->canvas.height - 1 - (y - v->bottom) * v->scale * v->magnified;
}

// The angle of a link in a recorded row.
static double link_angle(const trace *t, int links, size_t row, int link)
{
    return t->angles[row * (size_t)t->angle_count + (size_t)(t->angle_count - links + link)];
}

// What the arm sweeps over in the whole run, remembered in *known.
static void find_extent(const explorer_state *st, arm_extent *known)
{
    const session *s = &st->session;
    const trace *t = &s->run.trace;
    const arm_parameters *beam = &s->effective.parameters.arm;
    const unsigned long run = state_run_id(st);
    const bool grows = s->computing != NULL;

    // of another scenario nothing holds
    if (known->opened != st->opened) {
        *known = (arm_extent){.opened = st->opened};
    }
    if (known->run == run && known->rows == t->row_count && known->whole == !grows) {
        return;
    }

    // while a run grows, what was known is widened; when it is complete, all of it is looked at
    const bool anew = !grows || known->rows == 0;
    const bool goes_on = known->run == run && known->rows < t->row_count;
    const size_t first = grows && goes_on ? known->rows : 0, samples = grows ? 100 : 2000;
    double low = anew ? 0 : known->lowest, high = anew ? 0 : known->highest;
    double most = anew ? 0 : known->most_angle;
    size_t stride = (t->row_count - first) / samples + 1;
    for (size_t r = first; r < t->row_count; r += stride) {
        double y = 0;
        for (int i = 0; i < beam->links; i++) {
            double angle = link_angle(t, beam->links, r, i);
            y += beam->length / beam->links * sin(angle);
            most = fmax(most, fabs(angle));
            low = fmin(low, y);
            high = fmax(high, y);
        }
    }
    *known = (arm_extent){st->opened, run, t->row_count, !grows, low, high, most};
}

static view make_view(const explorer_state *st, const arm_extent *extent, canvas c)
{
    const parameters *p = &st->session.effective.parameters;
    double length = p->arm.length;
    view v = {.canvas = c, .magnified = 1};

    // far out: the whole circle, undistorted
    if (extent->most_angle > 0.8) {
        v.scale = fmin(2.0 * c.width, 4.0 * c.height) / (2.3 * length);
        v.left = -c.width / v.scale;
        v.bottom = -2.0 * c.height / v.scale;
        return v;
    }

    // the width is the arm's; heights are magnified as far as there is room
    double low = extent->lowest, high = extent->highest;
    if (p->wall.kind != WALL_NONE) {
        low = fmin(low, length * sin(p->wall.angle));
        high = fmax(high, length * sin(p->wall.angle));
    }
    v.scale = 2.0 * c.width / (1.25 * length);
    v.left = -0.1 * length;
    double room = 4.0 * c.height * 0.62 / fmax(v.scale * (high - low), 1e-9);
    static const double factors[] = {20, 10, 5, 4, 3, 2, 1.5};
    for (size_t i = 0; i < sizeof factors / sizeof factors[0]; i++) {
        if (factors[i] <= room) {
            v.magnified = factors[i];
            break;
        }
    }
    // the force's arrow comes from above, so leave more room there
    double spare = 4.0 * c.height / (v.scale * v.magnified) - (high - low);
    v.bottom = low - 0.3 * spare;
    return v;
}

static point draw_links(const view *v, const trace *t, const arm_parameters *beam, size_t row,
                        ink colour, bool dotted)
{
    point at = {0, 0};
    double part = beam->length / beam->links;

    // one link after the other, dots or a line two dots thick
    for (int i = 0; i < beam->links; i++) {
        double angle = link_angle(t, beam->links, row, i);
        point to = {at.x + part * cos(angle), at.y + part * sin(angle)};
        for (int k = 0; dotted && k < 40; k++) {
            double share = k / 40.0;
            canvas_dot(&v->canvas, lround(dot_x(v, at.x + share * (to.x - at.x))),
                       lround(dot_y(v, at.y + share * (to.y - at.y))), colour);
        }
        for (int thick = 0; !dotted && thick < 2; thick++) {
            canvas_line(&v->canvas, dot_x(v, at.x), dot_y(v, at.y) + thick, dot_x(v, to.x),
                        dot_y(v, to.y) + thick, colour);
        }
        at = to;
    }
    return at;
}

static void draw_hub(const view *v, double angle)
{
    const double radius = 5;
    double x = dot_x(v, 0), y = dot_y(v, 0);
    for (int i = 0; i < 48; i++) {
        double turn = i * 6.283185307 / 48;
        canvas_dot(&v->canvas, lround(x + radius * cos(turn)), lround(y + radius * sin(turn)),
                   INK_HUB);
    }
    canvas_line(&v->canvas, x, y, x + radius * cos(angle), y - radius * sin(angle), INK_HUB);
}

static void draw_wall(const view *v, const parameters *p)
{
    double x = p->arm.length * cos(p->wall.angle), y = p->arm.length * sin(p->wall.angle);
    int column = v->canvas.x + (int)(dot_x(v, x) / 2), row = v->canvas.y + (int)(dot_y(v, y) / 4);
    bool inside = row > v->canvas.y && row < v->canvas.y + v->canvas.height;

    // a plane: a stretch of the line that the arm lies along
    if (p->wall.kind == WALL_PLANE) {
        canvas_line(&v->canvas, dot_x(v, 0.8 * x), dot_y(v, 0.8 * y), dot_x(v, 1.1 * x),
                    dot_y(v, 1.1 * y), INK_WALL);
    }

    // where the tip meets a wall of any kind
    if (p->wall.kind != WALL_NONE && inside) {
        // the cell beyond the wall, on the side that the arm cannot reach
        for (int i = 0; i < 3; i++) {
            screen_put(v->canvas.screen, column + i, row - 1, 0x2592, INK_WALL);
        }
        screen_put(v->canvas.screen, column + 1, row, 0x25c6, INK_WALL);
    }
}

// An arrow that pushes on the arm at its tip, as long as the force is a share of the run's peak.
static void draw_force(const view *v, point tip, double force, double peak)
{
    if (!(force > 0) || !(peak > 0)) {
        return;
    }
    double x = dot_x(v, tip.x), y = dot_y(v, tip.y), length = 1.2 * v->canvas.height * force / peak;

    // shaft and head in one column of cells
    const int across = (int)lround(x - 2) / 2, head = (int)(y / 4) - 1;
    const int column = v->canvas.x + across, row = v->canvas.y + head;
    canvas_line(&v->canvas, 2.0 * across, y - 8 - length, 2.0 * across, 4.0 * head - 1, INK_FORCE);
    if (row > v->canvas.y) {
        screen_put(v->canvas.screen, column, row, 0x25bc, INK_FORCE);
        screen_print(v->canvas.screen, column - 10, row - 1, 9, INK_FORCE, "%7.3f N", force);
    }
}

static void draw(const explorer_state *st, layout *lay, screen *s, area a)
{
    const session *e = &st->session;
    const parameters *p = &e->effective.parameters;
    const sample *row = session_sample(e);
    char title[LINE_TEXT];
    find_extent(st, &lay->extent);
    const canvas inside = {s, a.x + 1, a.y + 1, a.width - 2, a.height - 2};
    view v = make_view(st, &lay->extent, inside);
    if (v.magnified != 1) {
        snprintf(title, sizeof title, "arm, drawn %g times as high", v.magnified);
    } else {
        snprintf(title, sizeof title, "arm");
    }
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, title);

    // from the back to the front: wall, kept run, arm, force
    draw_wall(&v, p);
    if (e->has_other && e->other.trace.angle_count == e->run.trace.angle_count) {
        draw_links(&v, &e->other.trace, &p->arm, trace_row_at(&e->other.trace, e->now), INK_OTHER,
                   true);
    }
    draw_hub(&v, row->hub_angle);
    point tip = draw_links(&v, &e->run.trace, &p->arm, e->row, INK_ARM, false);
    draw_force(&v, tip, row->contact != 0 ? row->force : 0, e->run.summary.peak_force_N);
    if (p->wall.kind != WALL_NONE && a.height >= 9 && a.width >= 40) {
        screen_text(s, a.x + a.width - 18, a.y + a.height - 2, 17, INK_WALL,
                    "\u25c6 contact point");
    }
    if (row->sticking != 0) {
        screen_text(s, a.x + 2, a.y + a.height - 2, 12, INK_DIM, "hub sticks");
    }
}

const panel arm_panel = {.name = "arm", .draw = draw};
