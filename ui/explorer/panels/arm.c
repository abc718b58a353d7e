// The arm, its wall and the contact force, drawn live.
#include "ui/explorer/panels/plot.h"

#include <math.h>
#include <stdlib.h>

#include "render/scene/plan.h"
#include "ui/terminal/pictures.h"

enum {
    CLOSE_UP_FROM = 60, // width of the panel from which on there is a close-up [cells]
    LEAST_FRAME =
        3, // width and height from which on something is drawn in a frame [cells]
};

// Where a plan of the arm is drawn: cells of the screen, as dots or as pixels.
typedef struct stage {
    canvas canvas;
    cairo_t *picture; // NULL: dots
    plan_view view;   // in either
} stage;

// What the arm sweeps over in the whole run, remembered in *known.
static void find_extent(const explorer_model *model, arm_extent *known)
{
    const session *s = &model->session;
    const trace *t = &s->run.trace;
    const arm_parameters *beam = &s->effective.parameters.arm;
    const unsigned long run = model_run_id(model);
    const bool grows = s->computing != NULL;

    // what was known of another scenario is not valid
    if (known->opened != model->opened) {
        *known = (arm_extent){.opened = model->opened};
    }
    if (known->run == run && known->rows == t->row_count && known->whole == !grows) {
        return;
    }

    // while a run grows, what was known is widened; when it is complete, all of it is
    // looked at
    const bool anew = !grows || known->rows == 0;
    const bool goes_on = known->run == run && known->rows < t->row_count;
    const size_t first = grows && goes_on ? known->rows : 0, samples = grows ? 100 : 2000;
    double low = anew ? 0 : known->lowest, high = anew ? 0 : known->highest;
    double most = anew ? 0 : known->most_angle;
    double lengths[PARAMETER_LINKS_MOST];
    parameters_link_lengths(beam, lengths);
    size_t stride = (t->row_count - first) / samples + 1;
    for (size_t r = first; r < t->row_count; r += stride) {
        const double *angles = t->angles + (r + 1) * (size_t)t->angle_count - beam->links;
        double y = 0;
        for (int i = 0; i < beam->links; i++) {
            const double angle = angles[i];
            y += lengths[i] * sin(angle);
            most = fmax(most, fabs(angle));
            low = fmin(low, y);
            high = fmax(high, y);
        }
    }
    *known = (arm_extent){model->opened, run, t->row_count, !grows, low, high, most};
}

// What shows all that the arm sweeps over on a stage of this size [dots or pixels].
static plan_view whole_view(const explorer_model *model, const arm_extent *extent,
                            double width, double height)
{
    const parameters *p = &model->session.effective.parameters;
    double length = p->arm.length;
    plan_view v = {.magnified = 1, .width = width, .height = height};

    // far out: the whole circle, undistorted
    if (extent->most_angle > 0.8) {
        v.scale = fmin(width, height) / (2.3 * length);
        v.left = -0.5 * width / v.scale;
        v.bottom = -0.5 * height / v.scale;
        return v;
    }

    // the width is the arm's; heights are magnified as far as there is room
    double low = extent->lowest, high = extent->highest;
    if (p->wall.kind != WALL_NONE) {
        low = fmin(low, length * sin(p->wall.angle));
        high = fmax(high, length * sin(p->wall.angle));
    }
    v.scale = width / (1.25 * length);
    v.left = -0.1 * length;
    double room = height * 0.62 / fmax(v.scale * (high - low), 1e-9);
    static const double factors[] = {1.5, 2, 3, 4, 5, 10, 20};
    for (size_t i = 0; i < sizeof factors / sizeof factors[0]; i++) {
        if (factors[i] <= room) {
            v.magnified = factors[i];
        }
    }
    // the force's arrow comes from above, so leave more room there
    double spare = height / (v.scale * v.magnified) - (high - low);
    v.bottom = low - 0.3 * spare;
    return v;
}

int arm_rows(const explorer_model *model, layout *lay, screen_size room)
{
    enum { LEAST = 14 };
    find_extent(model, &lay->extent);

    // what is drawn in true proportion takes its height, and the force an arrow
    const plan_view v =
        whole_view(model, &lay->extent, 2.0 * room.width, 4.0 * room.height);
    const double spread = (lay->extent.highest - lay->extent.lowest) * v.scale / 4;
    const int wanted = lay->extent.most_angle > 0.8 ? room.height : 6 + (int)spread;
    if (wanted < LEAST) {
        return LEAST;
    }
    return wanted;
}

// The run that the arm is drawn beside, NULL if there is none of as many bodies.
static const trace *other_run(const session *e)
{
    if (e->has_other && e->other.trace.angle_count == e->run.trace.angle_count) {
        return &e->other.trace;
    }
    return NULL;
}

// Where the tip is at the cursor, as it was recorded [m].
static plane_vector tip_of(const explorer_model *model)
{
    const session *e = &model->session;
    plane_vector tip, across;
    recorded_tip(&e->run.trace, &e->effective.parameters.arm, e->row, &tip, &across);
    return tip;
}

// --- as dots ---------------------------------------------------------------------------

// The links of a recorded row as a line of dots, or a line two dots thick.
static void draw_links(const explorer_model *model, const explorer_view *view,
                       const stage *g, const trace *t, double time, ink in, bool dotted)
{
    const parameters *p = &model->session.effective.parameters;
    vector joints[PARAMETER_LINKS_MOST + 1];
    scene_joints(t, p, time, joints);
    scene_exaggerate(joints, p->arm.links, view->looks.bending);

    // one link after the other
    for (int i = 0; i < p->arm.links; i++) {
        const double x0 = plan_x(&g->view, joints[i].x),
                     y0 = plan_y(&g->view, joints[i].y);
        const double x1 = plan_x(&g->view, joints[i + 1].x),
                     y1 = plan_y(&g->view, joints[i + 1].y);
        for (int k = 0; dotted && k < 40; k++) {
            const double share = k / 40.0;
            canvas_dot(&g->canvas, lround(x0 + share * (x1 - x0)),
                       lround(y0 + share * (y1 - y0)), in);
        }
        for (int thick = 0; !dotted && thick < 2; thick++) {
            canvas_line(&g->canvas, x0, y0 + thick, x1, y1 + thick, in);
        }
    }
}

static void draw_hub(const stage *v, double angle)
{
    const double radius = 5;
    double x = plan_x(&v->view, 0), y = plan_y(&v->view, 0);
    for (int i = 0; i < 48; i++) {
        double turn = i * 6.283185307 / 48;
        canvas_dot(&v->canvas, lround(x + radius * cos(turn)),
                   lround(y + radius * sin(turn)), INK_HUB);
    }
    canvas_line(&v->canvas, x, y, x + radius * cos(angle), y - radius * sin(angle),
                INK_HUB);
}

// A line from place to place [m].
static void draw_line(const stage *g, double x0, double y0, double x1, double y1, ink in)
{
    const plan_view *v = &g->view;
    canvas_line(&g->canvas, plan_x(v, x0), plan_y(v, y0), plan_x(v, x1), plan_y(v, y1),
                in);
}

static void draw_wall(const stage *g, const parameters *p, const sample *at)
{
    const canvas *c = &g->canvas;
    const vector shift = scene_wall_shift(p, at);
    const double x = p->arm.length * cos(p->wall.angle),
                 y = p->arm.length * sin(p->wall.angle);

    // a plane: a stretch of the line that the arm lies along
    if (p->wall.kind == WALL_PLANE) {
        draw_line(g, 0.8 * x + shift.x, 0.8 * y + shift.y, 1.1 * x + shift.x,
                  1.1 * y + shift.y, INK_WALL);
    }

    // where the tip meets a wall of any kind, and the cell beyond, which the arm cannot
    // reach
    const int column = c->x + (int)(plan_x(&g->view, x + shift.x) / 2);
    const int row = c->y + (int)(plan_y(&g->view, y + shift.y) / 4);
    if (p->wall.kind != WALL_NONE && row > c->y && row < c->y + c->height) {
        for (int i = 0; i < 3; i++) {
            screen_put(c->screen, column + i, row - 1, 0x2592, INK_WALL);
        }
        screen_put(c->screen, column + 1, row, 0x25c6, INK_WALL);
    }
}

// An arrow that pushes on the arm at its tip, as long as the force is a share of the
// run's peak.
static void draw_force(const stage *v, plane_vector tip, double force, double peak)
{
    if (!(force > 0) || !(peak > 0)) {
        return;
    }
    double x = plan_x(&v->view, tip.x), y = plan_y(&v->view, tip.y),
           length = 1.2 * v->canvas.height * force / peak;

    // shaft and head in one column of cells
    const int across = (int)lround(x - 2) / 2, head = (int)(y / 4) - 1;
    const int column = v->canvas.x + across, row = v->canvas.y + head;
    canvas_line(&v->canvas, 2.0 * across, y - 8 - length, 2.0 * across, 4.0 * head - 1,
                INK_FORCE);
    if (row > v->canvas.y) {
        screen_put(v->canvas.screen, column, row, 0x25bc, INK_FORCE);
    }
}

// From the back to the front: wall, kept run, arm, force.
static void draw_dots(const explorer_model *model, const explorer_view *view,
                      const stage *g)
{
    const session *e = &model->session;
    const sample *row = session_sample(e);
    draw_wall(g, &e->effective.parameters, row);
    if (other_run(e) != NULL) {
        draw_links(model, view, g, other_run(e), e->now, INK_OTHER, true);
    }
    draw_hub(g, row->hub_angle);
    draw_links(model, view, g, &e->run.trace, e->now, INK_ARM, false);
    const plane_vector tip = tip_of(model);
    if (view->pull.held) {
        draw_line(g, tip.x, tip.y, view->pull.x, view->pull.y, INK_FORCE);
    }
    draw_force(g, tip, row->contact != 0 ? row->force : 0, e->run.summary.peak_force_N);
}

// --- as pixels -------------------------------------------------------------------------

static void draw_pixels(const explorer_model *model, const explorer_view *view,
                        const stage *g)
{
    const session *e = &model->session;
    const screen *s = g->canvas.screen;
    const rgb ground = s->pictures->ground;
    const colour_theme theme = view->looks.theme;
    const plan p = {.rows = &e->run.trace,
                    .parameters = &e->effective.parameters,
                    .time = e->now,
                    .other = other_run(e),
                    .exaggerate = view->looks.bending,
                    .peak = e->run.summary.peak_force_N,
                    .pulled = view->pull.held,
                    .pull_x = view->pull.x,
                    .pull_y = view->pull.y,
                    .colours = {.ground = {ground.red / 255.0, ground.green / 255.0,
                                           ground.blue / 255.0},
                                .arm = picture_colour(s, theme, INK_ARM),
                                .hub = picture_colour(s, theme, INK_HUB),
                                .wall = picture_colour(s, theme, INK_WALL),
                                .force = picture_colour(s, theme, INK_FORCE),
                                .other = picture_colour(s, theme, INK_OTHER),
                                .frame = picture_colour(s, theme, INK_FRAME)}};
    plan_paint(g->picture, &p, &g->view);
}

// --- the panel -------------------------------------------------------------------------

// A stage inside a frame that is to come: its size is known, nothing is drawn yet.
static stage plan_stage(screen *s, area a)
{
    stage g = {.canvas = {s, a.x + 1, a.y + 1, a.width - 2, a.height - 2}};
    const picture_layer *pixels = s->pictures;
    g.view.width = g.canvas.width * (pixels != NULL ? pixels->cell_width : 2.0);
    g.view.height = g.canvas.height * (pixels != NULL ? pixels->cell_height : 4.0);
    return g;
}

// Draws on it, in pixels where the screen has any.
static void draw_stage(const explorer_model *model, const explorer_view *view, stage *g)
{
    const canvas *c = &g->canvas;
    g->picture = picture_begin(c->screen, c->x, c->y, c->width, c->height);
    if (g->picture != NULL) {
        draw_pixels(model, view, g);
        picture_end(c->screen, g->picture);
    } else if (c->screen->pictures == NULL) {
        draw_dots(model, view, g);
    }
}

// The contact from near by, in a frame of its own.
static void draw_close_up(const explorer_model *model, const explorer_view *view,
                          screen *s, area a)
{
    char title[LINE_TEXT];
    stage g = plan_stage(s, a);
    g.view =
        plan_close_up(&model->session.effective.parameters, g.view.width, g.view.height);
    snprintf(title, sizeof title, "tip, %.3g mm", 1e3 * g.view.width / g.view.scale);
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, title);
    draw_stage(model, view, &g);
}

// Texts about the arm: the force next to the tip, and the state of the hub.
static void draw_words(const explorer_model *model, const explorer_view *view,
                       const stage *g, area a)
{
    const sample *row = session_sample(&model->session);
    const plane_vector tip = tip_of(model);
    screen *s = g->canvas.screen;
    const double across = g->view.width / g->canvas.width,
                 down = g->view.height / g->canvas.height;
    const int x = g->canvas.x + (int)(plan_x(&g->view, tip.x) / across);
    const int y = g->canvas.y + (int)(plan_y(&g->view, tip.y) / down) - 2;
    if (row->contact != 0 && row->force > 0 && y > a.y) {
        screen_print(s, x - 11, y, 9, INK_FORCE, "%7.3f N", row->force);
    }
    if (model->session.effective.parameters.wall.kind != WALL_NONE &&
        s->pictures == NULL && a.height >= 9 && a.width >= 40) {
        screen_text(s, a.x + a.width - 18, a.y + a.height - 2, 17, INK_WALL,
                    "\u25c6 contact point");
    }
    if (view->pull.held) {
        screen_print(s, a.x + 14, a.y + a.height - 2, a.width - 34, INK_FORCE,
                     "pulled with %.3g N", view->pull.force);
    }
    if (row->sticking != 0) {
        screen_text(s, a.x + 2, a.y + a.height - 2, 12, INK_DIM, "hub sticks");
    }
}

static void draw(const explorer_model *model, const explorer_view *view, layout *lay,
                 screen *s, area a)
{
    const parameters *p = &model->session.effective.parameters;
    char title[LINE_TEXT] = "arm";
    find_extent(model, &lay->extent);

    // a frame without room for anything in it
    if (a.width < LEAST_FRAME || a.height < LEAST_FRAME) {
        return;
    }

    // the contact from near by takes a third
    const bool wanted = view->looks.close_up == CLOSE_UP_ON ||
                        (view->looks.close_up == CLOSE_UP_AUTO && s->pictures != NULL);
    if (wanted && a.width >= CLOSE_UP_FROM && p->wall.kind != WALL_NONE) {
        const int width = a.width / 3;
        a.width -= width;
        draw_close_up(model, view, s, (area){a.x + a.width, a.y, width, a.height});
    }

    // the title says how it is drawn
    stage g = plan_stage(s, a);
    g.view = whole_view(model, &lay->extent, g.view.width, g.view.height);
    if (g.view.magnified != 1) {
        text_add(title, sizeof title, ", drawn %g times as high", g.view.magnified);
    }
    if (view->looks.bending != 1) {
        text_add(title, sizeof title, ", bent %g times", view->looks.bending);
    }
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, title);
    draw_stage(model, view, &g);
    draw_words(model, view, &g, a);

    // for the mouse
    const canvas *c = &g.canvas;
    lay->drawn.stage =
        (arm_stage){.x = c->x,
                    .y = c->y,
                    .width = c->width,
                    .height = c->height,
                    .left = g.view.left,
                    .bottom = g.view.bottom,
                    .across = g.view.scale * c->width / g.view.width,
                    .up = g.view.scale * g.view.magnified * c->height / g.view.height};
    layout_add_hit(
        lay, (hit_area){PANEL_ARM, PART_BODY, 0, {c->x, c->y, c->width, c->height}});
}

// --- the mouse -------------------------------------------------------------------------

// A press near the tip takes hold of it.
static bool point(explorer_model *model, explorer_view *view, explorer_input *input,
                  const panel_gesture *g)
{
    enum { NEAR_ACROSS = 4, NEAR_DOWN = 2 }; // [cells]
    int x, y;
    const arm_stage *drawn = &view->drawn.stage;
    const pointer_event e = g->event;
    if (drawn->width < 1 || drawn->height < 1 || pointer_wheel(e) != 0) {
        return false;
    }
    const plane_vector place = stage_place(drawn, e.x, e.y);
    stage_cell(drawn, tip_of(model), &x, &y);
    const bool near = abs(x - e.x) <= NEAR_ACROSS && abs(y - e.y) <= NEAR_DOWN;
    if (e.kind == POINTER_PRESS && near) {
        act_pull_tip(model, view, input, place);
    } else if (e.kind == POINTER_DRAG && view->pull.held) {
        act_move_pull(model, view, place);
    } else if (e.kind == POINTER_RELEASE) {
        act_release_tip(model, view, input);
    }
    return true;
}

const panel arm_panel = {.name = "arm", .draw = draw, .point = point};
