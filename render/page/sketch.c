#include "render/page/sketch.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "render/page/picture_file.h"

#define TITLE_SIZE   9.0
#define TITLE_SPACE  7.0
#define CAPTION_SIZE 6.5
#define LINE_WIDTH   0.8
#define STRONG_WIDTH 1.1 // of arrows, coils and walls
#define HEAD_LENGTH  5.0
#define ARC_HEAD     4.2
#define SMALL_HEAD   3.6  // of measures
#define LEAST_SHRINK 0.82 // of letters on a smaller page
#define MM           (72 / 25.4)

point shifted(point from, double right, double down)
{
    return (point){from.x + right, from.y + down};
}

// ---- the page

static double design_width(const sketch_frame *frame)
{
    if (frame->design_width > 0) {
        return frame->design_width;
    }
    return SKETCH_WIDTH;
}

static double page_scale(const sketch_frame *frame)
{
    if (frame->look.width > 0) {
        return frame->look.width * MM / design_width(frame);
    }
    return 1;
}

double sketch_letters(const sketch_frame *frame, double size)
{
    // a smaller page has smaller letters, though not as small as its lines; a larger one
    // has not
    double scale = page_scale(frame), shrunk = size * fmin(1, fmax(scale, LEAST_SHRINK));
    return page_letters(frame->look.letters, shrunk) / scale;
}

static double inner_width(const sketch_frame *frame)
{
    return design_width(frame) - 2 * SKETCH_MARGIN;
}

// Size of the letters round a drawing, in designed points: that of a plot's on any page.
static double frame_letters(const sketch_frame *frame, double size)
{
    return page_letters(frame->look.letters, size) / page_scale(frame);
}

// The title as a text that is to be set.
static text_block title_block(const sketch_frame *frame, const char *markup)
{
    return (text_block){.markup = markup,
                        .size = frame_letters(frame, TITLE_SIZE),
                        .family = frame->look.font,
                        .bold = true,
                        .balanced = true,
                        .width = inner_width(frame)};
}

static text_block caption_block(const sketch_frame *frame)
{
    return (text_block){frame->caption, frame_letters(frame, CAPTION_SIZE),
                        .family = frame->look.font, .width = inner_width(frame)};
}

// Heights of title and caption, with the space between them and the drawing.
static void frame_heights(PangoContext *context, const sketch_frame *frame, double *above,
                          double *below)
{
    *above = *below = SKETCH_MARGIN;
    if (frame->look.bare) {
        return;
    }

    g_autofree char *title = text_escape(frame->title);
    text_block t = title_block(frame, title), c = caption_block(frame);
    *above += text_measure(context, &t).height + TITLE_SPACE;
    if (frame->caption != NULL) {
        *below += text_measure(context, &c).height + TITLE_SPACE;
    }
}

void sketch_size(const sketch_frame *frame, double *width, double *height)
{
    double above, below, scale = page_scale(frame);
    g_autoptr(PangoContext) context = text_context_create();
    frame_heights(context, frame, &above, &below);
    *width = scale * (inner_width(frame) + 2 * SKETCH_MARGIN);
    *height = scale * (above + frame->body_height + below);
}

static void draw_block(sketch *s, const text_block *t, point at, anchor part, colour c)
{
    const double k = s->scale;
    const figure_rect r = text_put(s->cr, s->context, t, at.x, at.y, part, c);
    report_add_text(s->report, t->markup, k * t->size,
                    (figure_rect){k * r.x, k * r.y, k * r.width, k * r.height});
}

// The title above the drawing and the caption below it.
static void draw_frame_texts(sketch *s)
{
    const sketch_frame *frame = s->frame;
    g_autofree char *title = text_escape(frame->title);
    const text_block heading = title_block(frame, title);
    draw_block(s, &heading, (point){s->left, SKETCH_MARGIN}, (anchor){0, 0},
               s->colours->text);
    if (frame->caption != NULL) {
        const text_block caption = caption_block(frame);
        draw_block(s, &caption, (point){s->left, s->bottom + TITLE_SPACE}, (anchor){0, 0},
                   s->colours->faint_text);
    }
}

// Draws page, title and caption, and scales cr for what follows.
status sketch_begin(sketch *s, cairo_t *cr, const sketch_frame *frame,
                    figure_report *report, fault *f)
{
    double above, below, width, height;
    TRY(text_check_font(f));

    *s = (sketch){.cr = cr,
                  .context = text_context_create(),
                  .colours = palette_of(frame->look.theme),
                  .theme = frame->look.theme,
                  .frame = frame,
                  .report = report,
                  .scale = page_scale(frame),
                  .f = f};

    // sizes, which the report keeps
    frame_heights(s->context, frame, &above, &below);
    sketch_size(frame, &width, &height);
    if (report != NULL) {
        memset(report, 0, sizeof *report);
        report->page = (figure_rect){0, 0, width, height};
    }

    // the page
    cairo_save(cr);
    if (!frame->look.transparent) {
        set_colour(cr, s->colours->page);
        cairo_rectangle(cr, 0, 0, width, height);
        cairo_fill(cr);
    }

    // where the body stands, in its own points
    cairo_scale(cr, s->scale, s->scale);
    s->left = SKETCH_MARGIN;
    s->right = s->left + inner_width(frame);
    s->top = above;
    s->bottom = above + frame->body_height;
    if (!frame->look.bare) {
        draw_frame_texts(s);
    }
    return STATUS_OK;
}

status sketch_end(sketch *s)
{
    cairo_restore(s->cr);
    g_object_unref(s->context);
    return s->code;
}

// ---- lines

// The colour of a palette slot, SKETCH_INK or SKETCH_FAINT.
static colour sketch_colour(const sketch *s, int slot)
{
    if (slot == SKETCH_FAINT) {
        return s->colours->mark;
    }
    if (slot < 0 || s->theme == THEME_MONO) {
        return s->colours->text;
    }
    return palette_series(s->theme, slot, 0);
}

static void set_pen(const sketch *s, double width, int slot)
{
    set_colour(s->cr, sketch_colour(s, slot));
    set_line_style(s->cr, LINE_SOLID, width / s->scale);
    cairo_new_path(s->cr);
}

void sketch_line(const sketch *s, point from, point to, double width, int slot)
{
    assert(width > 0);
    set_pen(s, width, slot);
    picture_line(s->cr, from.x, from.y, to.x, to.y);
}

static void set_dashes(const sketch *s)
{
    static const double pattern[] = {3, 2};
    cairo_set_line_cap(s->cr, CAIRO_LINE_CAP_BUTT);
    cairo_set_dash(s->cr, pattern, 2, 0);
}

void sketch_dashed(const sketch *s, point from, point to, int slot)
{
    set_pen(s, 0.6, slot);
    set_dashes(s);
    picture_line(s->cr, from.x, from.y, to.x, to.y);
}

// An arrowhead with its tip at a point, along `direction` on the page.
static void draw_head(const sketch *s, point tip, double direction, double length)
{
    cairo_save(s->cr);
    cairo_translate(s->cr, tip.x, tip.y);
    cairo_rotate(s->cr, direction);
    cairo_move_to(s->cr, 0, 0);
    cairo_line_to(s->cr, -length, 0.36 * length);
    cairo_line_to(s->cr, -length, -0.36 * length);
    cairo_close_path(s->cr);
    cairo_restore(s->cr);
    cairo_fill(s->cr);
}

// Length of the way from one point to another, and its direction on the page.
static double distance_between(point from, point to)
{
    return hypot(to.x - from.x, to.y - from.y);
}

static double direction_of(point from, point to)
{
    return atan2(to.y - from.y, to.x - from.x);
}

// The shaft ends within the head.
static void draw_shaft_and_head(const sketch *s, point from, point to)
{
    double length = distance_between(from, to), head = fmin(HEAD_LENGTH, length);
    double share = 0;
    if (length > 0) {
        share = 1 - 0.8 * head / length;
    }
    picture_line(s->cr, from.x, from.y, from.x + share * (to.x - from.x),
                 from.y + share * (to.y - from.y));
    draw_head(s, to, direction_of(from, to), head);
}

void sketch_arrow(const sketch *s, point from, point to, int slot)
{
    set_pen(s, STRONG_WIDTH, slot);
    draw_shaft_and_head(s, from, to);
}

void sketch_dashed_arrow(const sketch *s, point from, point to, int slot)
{
    set_pen(s, STRONG_WIDTH, slot);
    set_dashes(s);
    draw_shaft_and_head(s, from, to);
}

void sketch_measure(const sketch *s, point from, point to)
{
    assert(isfinite(distance_between(from, to)));
    sketch_line(s, from, to, 0.5, SKETCH_INK);
    draw_head(s, to, direction_of(from, to), SMALL_HEAD);
    draw_head(s, from, direction_of(from, to) + G_PI, SMALL_HEAD);
}

// An arc that ends within its head, if it has one.
void sketch_arc(const sketch *s, arc a, int slot)
{
    assert(a.radius > 0);
    const point c = a.centre;
    const double turn = a.to > a.from ? 1 : -1;

    // the head takes the arc's last bit
    double bit = 0;
    if (a.head) {
        bit = turn * fmin(0.8 * ARC_HEAD / a.radius, fabs(a.to - a.from));
    }

    // cairo's y points down, so that its angles run the other way
    set_pen(s, LINE_WIDTH, slot);
    if (turn > 0) {
        cairo_arc_negative(s->cr, c.x, c.y, a.radius, -a.from, -(a.to - bit));
    } else {
        cairo_arc(s->cr, c.x, c.y, a.radius, -a.from, -(a.to - bit));
    }
    cairo_stroke(s->cr);

    if (a.head) {
        double direction = -(a.to - bit / 2) - turn * G_PI / 2;
        draw_head(s, shifted(c, a.radius * cos(a.to), -a.radius * sin(a.to)), direction,
                  ARC_HEAD);
    }
}

// A full circle, or one that is filled with the page's colour.
void sketch_disc(const sketch *s, point centre, double radius, int slot, bool filled)
{
    assert(radius >= 0);
    set_pen(s, LINE_WIDTH, slot);
    cairo_arc(s->cr, centre.x, centre.y, radius, 0, 2 * G_PI);
    if (!filled) {
        set_colour(s->cr, s->colours->page);
        cairo_fill_preserve(s->cr);
        set_colour(s->cr, sketch_colour(s, slot));
        cairo_stroke(s->cr);
    } else {
        cairo_fill(s->cr);
    }
}

// ---- parts

// A wide line with a narrower, lighter one over it.
void sketch_bar(const sketch *s, point from, point to, double thickness)
{
    assert(thickness > 0);
    cairo_set_dash(s->cr, NULL, 0, 0);
    cairo_set_line_cap(s->cr, CAIRO_LINE_CAP_ROUND);
    cairo_move_to(s->cr, from.x, from.y);
    cairo_line_to(s->cr, to.x, to.y);
    set_colour(s->cr, s->colours->axis);
    cairo_set_line_width(s->cr, thickness);
    cairo_stroke_preserve(s->cr);
    set_colour(s->cr, s->colours->shade);
    cairo_set_line_width(s->cr, thickness - 1.4);
    cairo_stroke(s->cr);
}

// A circle of which two opposite quarters are filled.
void sketch_mass_point(const sketch *s, point at)
{
    const double r = 3;
    sketch_disc(s, at, r, SKETCH_INK, false);
    for (int quarter = 0; quarter < 4; quarter += 2) {
        cairo_move_to(s->cr, at.x, at.y);
        cairo_arc(s->cr, at.x, at.y, r, quarter * G_PI / 2, (quarter + 1) * G_PI / 2);
        cairo_close_path(s->cr);
        cairo_fill(s->cr);
    }
}

// Two and a half turns from near the centre outwards.
void sketch_spiral(const sketch *s, point centre, double radius, int slot)
{
    enum { POINTS = 90 };
    assert(radius > 0);
    set_pen(s, 1, slot);
    for (int i = 0; i <= POINTS; i++) {
        double share = (double)i / POINTS, angle = 2 * G_PI * 2.5 * share;
        double r = radius * (0.2 + 0.8 * share);
        cairo_line_to(s->cr, centre.x + r * cos(angle), centre.y + r * sin(angle));
    }
    cairo_stroke(s->cr);
}

// A line from one point to another, in lengths along it and across it to the right on the
// page.
typedef struct guide {
    point from;
    double length, ux, uy; // [pt], and its unit vector
} guide;

static guide guide_of(point from, point to)
{
    double length = distance_between(from, to);
    return (guide){from, length, (to.x - from.x) / length, (to.y - from.y) / length};
}

static point guide_at(const guide *g, double along, double across)
{
    return shifted(g->from, along * g->ux - across * g->uy,
                   along * g->uy + across * g->ux);
}

static void line_to_point(const sketch *s, point p)
{
    cairo_line_to(s->cr, p.x, p.y);
}

// A zigzag with straight leads at both ends.
static void draw_zigzag(const sketch *s, const guide *g, int turns, double height,
                        double lead)
{
    double step = (g->length - 2 * lead) / (2 * turns);
    line_to_point(s, g->from);
    line_to_point(s, guide_at(g, lead, 0));
    for (int i = 0; i < 2 * turns; i++) {
        const double side = i % 2 == 0 ? height : -height;
        line_to_point(s, guide_at(g, lead + (i + 0.5) * step, side));
    }
    line_to_point(s, guide_at(g, g->length - lead, 0));
    line_to_point(s, guide_at(g, g->length, 0));
    cairo_stroke(s->cr);
}

void sketch_coil(const sketch *s, point from, point to, int turns, int slot)
{
    assert(turns > 0);
    const guide g = guide_of(from, to);
    set_pen(s, STRONG_WIDTH, slot);
    draw_zigzag(s, &g, turns, 8, 8);
}

void sketch_resistor(const sketch *s, point from, point to)
{
    const guide g = guide_of(from, to);
    set_pen(s, LINE_WIDTH, SKETCH_INK);
    draw_zigzag(s, &g, 3, 4, (g.length - 22) / 2);
}

// A line with short slanted ones on one side.
void sketch_wall(const sketch *s, point from, point to)
{
    const double spacing = 5, depth = 6;
    const guide g = guide_of(from, to);
    sketch_line(s, from, to, STRONG_WIDTH, SKETCH_INK);
    set_pen(s, 0.5, SKETCH_INK);
    for (double at = spacing; at <= g.length; at += spacing) {
        const point start = guide_at(&g, at, 0);
        cairo_move_to(s->cr, start.x, start.y);
        line_to_point(s, guide_at(&g, at - 0.7 * depth, 0.7 * depth));
    }
    cairo_stroke(s->cr);
}

// ---- text

// A drawing over a plotted figure has no frame of its own.
static text_block framed(const sketch *s, text_block t)
{
    if (s->frame != NULL) {
        t.size = sketch_letters(s->frame, t.size);
        t.family = s->frame->look.font;
    }
    return t;
}

void sketch_text(sketch *s, double size, point at, anchor part, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    g_autofree char *markup = text_vprintf(format, list);
    va_end(list);
    const text_block t = framed(s, (text_block){.markup = markup, .size = size});
    draw_block(s, &t, at, part, s->colours->text);
}

// Wraps a text at its width; a line that is shorter is aligned within it.
void sketch_wrapped(sketch *s, point at, const text_block *text)
{
    assert(text->width > 0);
    text_block t = framed(s, *text);
    anchor part = {0, 0};

    if (t.align != TEXT_LEFT) {
        // short lines are placed by their own width
        text_block line = t;
        line.width = 0;
        if (text_measure(s->context, &line).width <= t.width) {
            part.x = 0.5;
            if (t.align == TEXT_RIGHT) {
                part.x = 1;
            }
            at.x += part.x * t.width;
            t.width = 0;
        }
    }

    draw_block(s, &t, at, part, s->colours->text);
}
