// The arm, its wall and the contact force, drawn live.
#include "ui/explorer/panels/plot.h"

#include <math.h>
#include <stdlib.h>

#include "render/drawing.h"
#include "ui/terminal/pictures.h"

enum {
    CLOSE_UP_FROM = 70, // width of the panel from which on there is a close-up [cells]
    LEAST_FRAME = 3,    // width and height of a frame that has anything in it [cells]
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
    enum { SAMPLES = 2000, SAMPLES_OF_GROWTH = 100 }; // rows, of all
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

    // while a run grows, what was known is widened by what came; when it is complete, all
    // of it is looked at
    size_t first = 0, samples = SAMPLES;
    if (grows) {
        samples = SAMPLES_OF_GROWTH;
        if (known->run == run && known->rows < t->row_count) {
            first = known->rows;
        }
    } else {
        known->over = (plan_extent){0};
    }
    plan_extent_add(&known->over, t, beam, first, samples);
    known->run = run;
    known->rows = t->row_count;
    known->whole = !grows;
}

int arm_rows(const explorer_model *model, layout *lay, screen_size room)
{
    enum { LEAST = 14, AROUND = 6 }; // rows of all, and around what the arm sweeps over
    const plan_extent *extent = &lay->extent.over;
    find_extent(model, &lay->extent);
    if (plan_is_circle(extent)) {
        return room.height > LEAST ? room.height : LEAST;
    }

    // what is drawn in true proportion takes its height, and the force an arrow
    const plan_view v = plan_whole(extent, &model->session.effective.parameters,
                                   2.0 * room.width, 4.0 * room.height);
    const int spread = (int)((extent->highest - extent->lowest) * v.scale / 4);
    return AROUND + spread > LEAST ? AROUND + spread : LEAST;
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

// A line from dot to dot, dotted or two dots thick.
static void draw_link(const canvas *c, plane_vector from, plane_vector to, ink shade,
                      bool dotted)
{
    enum { DOTS = 40 };
    if (!dotted) {
        canvas_line(c, from.x, from.y, to.x, to.y, shade);
        canvas_line(c, from.x, from.y + 1, to.x, to.y + 1, shade);
        return;
    }
    for (int i = 0; i < DOTS; i++) {
        const double share = (double)i / DOTS;
        canvas_dot(c, lround(from.x + share * (to.x - from.x)),
                   lround(from.y + share * (to.y - from.y)), shade);
    }
}

// The links of a run at an instant.
static void draw_arm_links(const explorer_model *model, const explorer_view *view,
                           const stage *g, const trace *t, ink shade, bool dotted)
{
    const parameters *p = &model->session.effective.parameters;
    vector joints[PARAMETER_LINKS_MOST + 1];
    scene_joints(t, p, model->session.now, joints);
    scene_exaggerate(joints, p->arm.links, view->looks.bending);
    for (int i = 0; i < p->arm.links; i++) {
        const plane_vector from = {plan_x(&g->view, joints[i].x),
                                   plan_y(&g->view, joints[i].y)};
        const plane_vector to = {plan_x(&g->view, joints[i + 1].x),
                                 plan_y(&g->view, joints[i + 1].y)};
        draw_link(&g->canvas, from, to, shade, dotted);
    }
}

// A circle with a hand at the hub's angle.
static void draw_hub_circle(const stage *g, double angle)
{
    enum { DOTS = 48 };
    const double radius = 5, whole_turn = 6.283185307; // [dots], [rad]
    const double x = plan_x(&g->view, 0), y = plan_y(&g->view, 0);
    for (int i = 0; i < DOTS; i++) {
        const double turn = i * whole_turn / DOTS;
        canvas_dot(&g->canvas, lround(x + radius * cos(turn)),
                   lround(y + radius * sin(turn)), INK_HUB);
    }
    canvas_line(&g->canvas, x, y, x + radius * cos(angle), y - radius * sin(angle),
                INK_HUB);
}

// A line from place to place [m].
static void draw_line_between(const stage *g, plane_vector from, plane_vector to,
                              ink shade)
{
    const plan_view *v = &g->view;
    canvas_line(&g->canvas, plan_x(v, from.x), plan_y(v, from.y), plan_x(v, to.x),
                plan_y(v, to.y), shade);
}

// The wall where it is at that row: a plane as a line, and the place of contact.
static void draw_wall(const stage *g, const parameters *p, const sample *at)
{
    const canvas *c = &g->canvas;
    const vector shift = scene_wall_shift(p, at);
    const double x = p->arm.length * cos(p->wall.angle);
    const double y = p->arm.length * sin(p->wall.angle);
    if (p->wall.kind == WALL_NONE) {
        return;
    }

    // a plane: a part of the line that the arm lies along
    if (p->wall.kind == WALL_PLANE) {
        const plane_vector from = {0.8 * x + shift.x, 0.8 * y + shift.y};
        const plane_vector to = {1.1 * x + shift.x, 1.1 * y + shift.y};
        draw_line_between(g, from, to, INK_WALL);
    }

    // where the tip meets a wall of any kind, and the cells beyond, which the arm cannot
    // reach
    const int column = c->x + (int)(plan_x(&g->view, x + shift.x) / 2);
    const int row = c->y + (int)(plan_y(&g->view, y + shift.y) / 4);
    if (row >= c->y && row < c->y + c->height) {
        for (int i = 0; i < 3 && row > c->y; i++) {
            screen_put(c->screen, column + i, row - 1, GLYPH_SHADE, INK_WALL);
        }
        screen_put(c->screen, column + 1, row, GLYPH_DIAMOND, INK_WALL);
    }
}

// An arrow that pushes on the arm at its tip, as long as the force is a share of the
// run's peak.
static void draw_force_arrow(const stage *g, plane_vector tip, double force, double peak)
{
    const canvas *c = &g->canvas;
    if (!(force > 0) || !(peak > 0)) {
        return;
    }
    const double x = plan_x(&g->view, tip.x), y = plan_y(&g->view, tip.y);
    const double length = 1.2 * c->height * force / peak;

    // shaft and head in one column of cells
    const int column = (int)lround(x - 2) / 2, head_row = (int)(y / 4) - 1;
    canvas_line(c, 2.0 * column, y - 8 - length, 2.0 * column, 4.0 * head_row - 1,
                INK_FORCE);
    if (head_row > 0) {
        screen_put(c->screen, c->x + column, c->y + head_row, GLYPH_ARROW_DOWN,
                   INK_FORCE);
    }
}

// From the back to the front: wall, kept run, arm, force.
static void draw_dots(const explorer_model *model, const explorer_view *view,
                      const stage *g)
{
    const session *e = &model->session;
    const sample *row = session_sample(e);
    const plane_vector tip = tip_of(model);
    draw_wall(g, &e->effective.parameters, row);
    if (other_run(e) != NULL) {
        draw_arm_links(model, view, g, other_run(e), run_ink(model_reference_rank(model)),
                       true);
    }
    draw_hub_circle(g, row->hub_angle);
    draw_arm_links(model, view, g, &e->run.trace, INK_ARM, false);
    if (view->pull.held) {
        const plane_vector hand = {view->pull.x, view->pull.y};
        draw_line_between(g, tip, hand, INK_FORCE);
    }
    if (row->contact != 0) {
        draw_force_arrow(g, tip, row->force, e->run.summary.peak_force_N);
    }
}

// --- as pixels -------------------------------------------------------------------------

// The arm with all that is around it as a picture, which render/scene paints.
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
                                .other =
                                    picture_colour(s, theme,
                                                   run_ink(model_reference_rank(model))),
                                .frame = picture_colour(s, theme, INK_FRAME)}};
    drawing()->plan_paint(g->picture, &p, &g->view);
}

// --- the panel -------------------------------------------------------------------------

// A stage inside a frame that is to come: its size is known, nothing is drawn yet.
static stage plan_stage(screen *s, area a)
{
    stage g = {.canvas = {s, a.x + 1, a.y + 1, a.width - 2, a.height - 2}};
    double cell_width = 2, cell_height = 4; // [dots]
    if (s->pictures != NULL) {
        cell_width = s->pictures->cell_width;
        cell_height = s->pictures->cell_height;
    }
    g.view.width = g.canvas.width * cell_width;
    g.view.height = g.canvas.height * cell_height;
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
    area_frame(s, a, INK_FRAME, title);
    draw_stage(model, view, &g);
}

// Draws the close-up into the last third of an area, if there is a wall and room; returns
// what it leaves.
static area draw_close_up_beside(const explorer_model *model, const explorer_view *view,
                                 screen *s, area a)
{
    if (a.width < CLOSE_UP_FROM ||
        model->session.effective.parameters.wall.kind == WALL_NONE) {
        return a;
    }
    const int width = a.width / 3;
    a.width -= width;
    draw_close_up(model, view, s, (area){a.x + a.width, a.y, width, a.height});
    return a;
}

// The force to the left of the tip, where it touches.
static void draw_force_in_words(const explorer_model *model, const stage *g)
{
    const sample *row = session_sample(&model->session);
    const plane_vector tip = tip_of(model);
    const canvas *c = &g->canvas;
    const double cell_width = g->view.width / c->width;
    const double cell_height = g->view.height / c->height;
    const int column = (int)(plan_x(&g->view, tip.x) / cell_width) - 11;
    const int line = (int)(plan_y(&g->view, tip.y) / cell_height) - 2;
    if (row->contact != 0 && row->force > 0 && line >= 0) {
        screen_print(c->screen, c->x + column, c->y + line, 9, INK_FORCE, "%7.3f N",
                     row->force);
    }
}

// Texts about the arm: the force next to the tip; in the last row the hand that pulls,
// and what a sign means.
static void draw_words(const explorer_model *model, const explorer_view *view,
                       const stage *g, area a)
{
    screen *s = g->canvas.screen;
    const bool has_wall = model->session.effective.parameters.wall.kind != WALL_NONE;
    const bool has_room = a.height >= 9 && a.width >= 40;
    const int last_row = a.y + a.height - 2;
    draw_force_in_words(model, g);
    if (has_wall && has_room && s->pictures == NULL) {
        screen_text(s, a.x + a.width - 18, last_row, 17, INK_WALL,
                    "\u25c6 contact point");
    }
    if (view->pull.held) {
        screen_print(s, a.x + 14, last_row, a.width - 34, INK_FORCE, "pulled with %.3g N",
                     view->pull.force);
    }
}

// Where the arm was drawn, for the mouse.
static void add_stage(layout *lay, const stage *g)
{
    const canvas *c = &g->canvas;
    const plan_view *v = &g->view;
    const area place = {c->x, c->y, c->width, c->height};
    lay->drawn.stage = (arm_stage){.x = c->x,
                                   .y = c->y,
                                   .width = c->width,
                                   .height = c->height,
                                   .left = v->left,
                                   .bottom = v->bottom,
                                   .across = v->scale * c->width / v->width,
                                   .up = v->scale * v->magnified * c->height / v->height};
    layout_add_hit(lay, (hit_area){PANEL_ARM, PART_BODY, 0, place});
}

// The arm, where there is room with its contact from near by, and what is to be said of
// it.
static void draw_arm(const explorer_model *model, const explorer_view *view, layout *lay,
                     screen *s, area a)
{
    find_extent(model, &lay->extent);
    if (a.width < LEAST_FRAME || a.height < LEAST_FRAME) {
        return;
    }
    a = draw_close_up_beside(model, view, s, a);

    // the title says how it is drawn
    char title[LINE_TEXT] = "arm";
    stage g = plan_stage(s, a);
    g.view = plan_whole(&lay->extent.over, &model->session.effective.parameters,
                        g.view.width, g.view.height);
    if (g.view.magnified != 1) {
        text_add(title, sizeof title, ", drawn %g times as high", g.view.magnified);
    }
    if (view->looks.bending != 1) {
        text_add(title, sizeof title, ", bent %g times", view->looks.bending);
    }
    area_frame(s, a, INK_FRAME, title);
    draw_stage(model, view, &g);
    draw_words(model, view, &g, a);
    add_stage(lay, &g);
}

// --- the mouse -------------------------------------------------------------------------

// A press near the tip takes hold of it.
static bool point_at_arm(explorer_model *model, explorer_view *view,
                         explorer_input *input, const panel_gesture *g)
{
    enum { NEAR_ACROSS = 4, NEAR_DOWN = 2 }; // [cells]
    const arm_stage *drawn = &view->drawn.stage;
    const pointer_event e = g->event;
    if (drawn->width < 1 || drawn->height < 1 || pointer_wheel(e) != 0) {
        return false;
    }

    // where the mouse is, and where the tip
    int x, y;
    const plane_vector place = stage_place(drawn, e.x, e.y);
    stage_cell(drawn, tip_of(model), &x, &y);
    const bool near_tip = abs(x - e.x) <= NEAR_ACROSS && abs(y - e.y) <= NEAR_DOWN;
    if (e.kind == POINTER_PRESS && near_tip) {
        act_pull_tip(model, view, input, place);
    } else if (e.kind == POINTER_DRAG && view->pull.held) {
        act_move_pull(model, view, place);
    } else if (e.kind == POINTER_RELEASE) {
        act_release_tip(model, view, input);
    }
    return true;
}

const panel arm_panel = {.name = "arm", .draw = draw_arm, .point = point_at_arm};
