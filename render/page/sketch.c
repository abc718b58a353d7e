#include "render/page/sketch.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define TITLE_SIZE   9.0
#define TITLE_SPACE  7.0
#define CAPTION_SIZE 6.5
#define LINE_WIDTH   0.8
#define HEAD_LENGTH  5.0
#define LEAST_SHRINK 0.82 // of letters on a smaller page
#define MM           (72 / 25.4)

// ---- the page

static double page_scale(const sketch_frame *frame)
{
    double design = frame->design_width > 0 ? frame->design_width : SKETCH_WIDTH;
    return frame->look.width > 0 ? frame->look.width * MM / design : 1;
}

double sketch_letters(const sketch_frame *frame, double size)
{
    assert(frame != NULL);
    // a smaller page has smaller letters, though not as small as its lines; a larger one has not
    double scale = page_scale(frame), shrunk = size * fmin(1, fmax(scale, LEAST_SHRINK));
    return page_letters(frame->look.letters, shrunk) / scale;
}

static double inner_width(const sketch_frame *frame)
{
    double design = frame->design_width > 0 ? frame->design_width : SKETCH_WIDTH;
    return design - 2 * SKETCH_MARGIN;
}

static text_block title_block(const sketch_frame *frame, const char *markup)
{
    return (text_block){.markup = markup,
                        .size = sketch_letters(frame, TITLE_SIZE),
                        .family = frame->look.font,
                        .bold = true,
                        .width = inner_width(frame)};
}

static text_block caption_block(const sketch_frame *frame)
{
    return (text_block){.markup = frame->caption,
                        .size = sketch_letters(frame, CAPTION_SIZE),
                        .family = frame->look.font,
                        .width = inner_width(frame)};
}

// Heights of title and caption, with the space between them and the drawing.
static void frame_heights(PangoContext *context, const sketch_frame *frame, double *above,
                          double *below)
{
    double width, height = 0;
    *above = *below = SKETCH_MARGIN;
    if (frame->look.bare) {
        return;
    }

    char *title = text_escape(frame->title);
    text_block t = title_block(frame, title), c = caption_block(frame);
    text_measure(context, &t, &width, &height);
    *above += height + TITLE_SPACE;

    if (frame->caption != NULL) {
        text_measure(context, &c, &width, &height);
        *below += height + TITLE_SPACE;
    }
    g_free(title);
}

void sketch_size(const sketch_frame *frame, double *width, double *height)
{
    assert(frame != NULL && width != NULL && height != NULL);
    double above, below, scale = page_scale(frame);
    PangoContext *context = text_context_create();
    frame_heights(context, frame, &above, &below);
    *width = scale * (inner_width(frame) + 2 * SKETCH_MARGIN);
    *height = scale * (above + frame->body_height + below);
    g_object_unref(context);
}

static void draw_block(sketch *s, text_block t, double x, double y, double ax, double ay, colour c)
{
    double width, height;
    text_measure(s->context, &t, &width, &height);
    x -= ax * width;
    y -= ay * height;
    set_colour(s->cr, c);
    cairo_move_to(s->cr, x, y);
    text_draw(s->cr, s->context, &t);
    double k = s->scale;
    report_add_text(s->report, t.markup, k * t.size,
                    (figure_rect){k * x, k * y, k * width, k * height});
}

status sketch_begin(sketch *s, cairo_t *cr, const sketch_frame *frame, figure_report *report,
                    fault *f)
{
    assert(s != NULL && cr != NULL && frame != NULL && frame->title != NULL);
    double above, below, width, height;
    status code = text_check_font(f);
    if (code != STATUS_OK) {
        return code;
    }

    *s = (sketch){.cr = cr,
                  .context = text_context_create(),
                  .colours = palette_of(frame->look.theme),
                  .theme = frame->look.theme,
                  .frame = frame,
                  .report = report,
                  .scale = page_scale(frame)};

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
    if (frame->look.bare) {
        return STATUS_OK;
    }

    // title above, caption below
    char *title = text_escape(frame->title);
    draw_block(s, title_block(frame, title), s->left, SKETCH_MARGIN, 0, 0, s->colours->text);
    g_free(title);
    if (frame->caption != NULL) {
        draw_block(s, caption_block(frame), s->left, s->bottom + TITLE_SPACE, 0, 0,
                   s->colours->faint_text);
    }
    return STATUS_OK;
}

void sketch_end(sketch *s)
{
    assert(s != NULL);
    cairo_restore(s->cr);
    g_object_unref(s->context);
}

// ---- lines

colour sketch_colour(const sketch *s, int slot)
{
    assert(s != NULL);
    if (slot == SKETCH_FAINT) {
        return s->colours->mark;
    }
    return slot < 0 || s->theme == THEME_MONO ? s->colours->text
                                              : palette_series(s->theme, slot, 0);
}

static void set_pen(const sketch *s, double width, int slot)
{
    set_colour(s->cr, sketch_colour(s, slot));
    set_line_style(s->cr, LINE_SOLID, width / s->scale);
    cairo_new_path(s->cr);
}

void sketch_line(const sketch *s, double x0, double y0, double x1, double y1, double width,
                 int slot)
{
    assert(s != NULL && width > 0);
    set_pen(s, width, slot);
    cairo_move_to(s->cr, x0, y0);
    cairo_line_to(s->cr, x1, y1);
    cairo_stroke(s->cr);
}

static void set_dashes(const sketch *s)
{
    static const double pattern[] = {3, 2};
    cairo_set_line_cap(s->cr, CAIRO_LINE_CAP_BUTT);
    cairo_set_dash(s->cr, pattern, 2, 0);
}

void sketch_dashed(const sketch *s, double x0, double y0, double x1, double y1, int slot)
{
    assert(s != NULL);
    set_pen(s, 0.6, slot);
    set_dashes(s);
    cairo_move_to(s->cr, x0, y0);
    cairo_line_to(s->cr, x1, y1);
    cairo_stroke(s->cr);
}

// A head whose tip is at (x, y) and that points along `direction` on the page.
static void draw_head(const sketch *s, double x, double y, double direction, double length)
{
    cairo_save(s->cr);
    cairo_translate(s->cr, x, y);
    cairo_rotate(s->cr, direction);
    cairo_move_to(s->cr, 0, 0);
    cairo_line_to(s->cr, -length, 0.36 * length);
    cairo_line_to(s->cr, -length, -0.36 * length);
    cairo_close_path(s->cr);
    cairo_restore(s->cr);
    cairo_fill(s->cr);
}

static void draw_arrow(const sketch *s, double x0, double y0, double x1, double y1, int slot,
                       bool dashed)
{
    double length = hypot(x1 - x0, y1 - y0), head = fmin(HEAD_LENGTH, length);
    double direction = atan2(y1 - y0, x1 - x0), share = length > 0 ? 1 - 0.8 * head / length : 0;
    set_pen(s, 1.1, slot);
    if (dashed) {
        set_dashes(s);
    }
    cairo_move_to(s->cr, x0, y0);
    cairo_line_to(s->cr, x0 + share * (x1 - x0), y0 + share * (y1 - y0));
    cairo_stroke(s->cr);
    draw_head(s, x1, y1, direction, head);
}

void sketch_arrow(const sketch *s, double x0, double y0, double x1, double y1, int slot)
{
    draw_arrow(s, x0, y0, x1, y1, slot, false);
}

void sketch_dashed_arrow(const sketch *s, double x0, double y0, double x1, double y1, int slot)
{
    draw_arrow(s, x0, y0, x1, y1, slot, true);
}

void sketch_measure(const sketch *s, double x0, double y0, double x1, double y1)
{
    assert(s != NULL && isfinite(x0) && isfinite(y0) && isfinite(x1) && isfinite(y1));
    double direction = atan2(y1 - y0, x1 - x0);
    sketch_line(s, x0, y0, x1, y1, 0.5, SKETCH_INK);
    draw_head(s, x1, y1, direction, 3.6);
    draw_head(s, x0, y0, direction + G_PI, 3.6);
}

void sketch_arc(const sketch *s, double x, double y, double radius, double from, double to,
                int slot, bool head)
{
    assert(s != NULL && radius > 0);
    double turn = to > from ? 1 : -1;
    // the head takes the arc's last bit
    double bit = head ? turn * fmin(0.8 * 4.2 / radius, fabs(to - from)) : 0;

    // cairo's y points down, so that its angles run the other way
    set_pen(s, LINE_WIDTH, slot);
    if (turn > 0) {
        cairo_arc_negative(s->cr, x, y, radius, -from, -(to - bit));
    } else {
        cairo_arc(s->cr, x, y, radius, -from, -(to - bit));
    }
    cairo_stroke(s->cr);

    if (head) {
        double direction = -(to - bit / 2) - turn * G_PI / 2;
        draw_head(s, x + radius * cos(to), y - radius * sin(to), direction, 4.2);
    }
}

void sketch_disc(const sketch *s, double x, double y, double radius, int slot, bool filled)
{
    assert(s != NULL && radius >= 0);
    set_pen(s, LINE_WIDTH, slot);
    cairo_arc(s->cr, x, y, radius, 0, 2 * G_PI);
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

void sketch_bar(const sketch *s, double x0, double y0, double x1, double y1, double thickness)
{
    assert(s != NULL && thickness > 0);
    cairo_set_dash(s->cr, NULL, 0, 0);
    cairo_set_line_cap(s->cr, CAIRO_LINE_CAP_ROUND);
    cairo_move_to(s->cr, x0, y0);
    cairo_line_to(s->cr, x1, y1);
    set_colour(s->cr, s->colours->axis);
    cairo_set_line_width(s->cr, thickness);
    cairo_stroke_preserve(s->cr);
    set_colour(s->cr, s->colours->shade);
    cairo_set_line_width(s->cr, thickness - 1.4);
    cairo_stroke(s->cr);
}

void sketch_mass_point(const sketch *s, double x, double y)
{
    assert(s != NULL);
    const double r = 3;
    sketch_disc(s, x, y, r, SKETCH_INK, false);
    for (int quarter = 0; quarter < 4; quarter += 2) {
        cairo_move_to(s->cr, x, y);
        cairo_arc(s->cr, x, y, r, quarter * G_PI / 2, (quarter + 1) * G_PI / 2);
        cairo_close_path(s->cr);
        cairo_fill(s->cr);
    }
}

void sketch_spiral(const sketch *s, double x, double y, double radius, int slot)
{
    enum { POINTS = 90 };
    assert(s != NULL && radius > 0);
    set_pen(s, 1, slot);
    for (int i = 0; i <= POINTS; i++) {
        double share = (double)i / POINTS, angle = 2 * G_PI * 2.5 * share;
        double r = radius * (0.2 + 0.8 * share);
        cairo_line_to(s->cr, x + r * cos(angle), y + r * sin(angle));
    }
    cairo_stroke(s->cr);
}

// A zigzag with straight leads at both ends.
static void draw_zigzag(const sketch *s, double x0, double y0, double x1, double y1, int turns,
                        double height, double lead)
{
    double length = hypot(x1 - x0, y1 - y0), ux = (x1 - x0) / length, uy = (y1 - y0) / length;
    double step = (length - 2 * lead) / (2 * turns);
    cairo_move_to(s->cr, x0, y0);
    cairo_line_to(s->cr, x0 + lead * ux, y0 + lead * uy);
    for (int i = 0; i < 2 * turns; i++) {
        double along = lead + (i + 0.5) * step, across = i % 2 ? -height : height;
        cairo_line_to(s->cr, x0 + along * ux - across * uy, y0 + along * uy + across * ux);
    }
    cairo_line_to(s->cr, x1 - lead * ux, y1 - lead * uy);
    cairo_line_to(s->cr, x1, y1);
    cairo_stroke(s->cr);
}

void sketch_coil(const sketch *s, double x0, double y0, double x1, double y1, int turns, int slot)
{
    assert(s != NULL && turns > 0);
    set_pen(s, 1.1, slot);
    draw_zigzag(s, x0, y0, x1, y1, turns, 8, 8);
}

void sketch_resistor(const sketch *s, double x0, double y0, double x1, double y1)
{
    assert(s != NULL);
    double length = hypot(x1 - x0, y1 - y0);
    set_pen(s, LINE_WIDTH, SKETCH_INK);
    draw_zigzag(s, x0, y0, x1, y1, 3, 4, (length - 22) / 2);
}

void sketch_wall(const sketch *s, double x0, double y0, double x1, double y1)
{
    assert(s != NULL);
    const double spacing = 5, depth = 6;
    double length = hypot(x1 - x0, y1 - y0), ux = (x1 - x0) / length, uy = (y1 - y0) / length;
    sketch_line(s, x0, y0, x1, y1, 1.1, SKETCH_INK);
    set_pen(s, 0.5, SKETCH_INK);
    for (double at = spacing; at <= length; at += spacing) {
        double x = x0 + at * ux, y = y0 + at * uy;
        cairo_move_to(s->cr, x, y);
        cairo_line_to(s->cr, x - depth * (0.7 * ux + 0.7 * uy), y - depth * (0.7 * uy - 0.7 * ux));
    }
    cairo_stroke(s->cr);
}

// ---- text

static text_block block_of(const sketch *s, const char *markup, double size)
{
    // a drawing over a plotted figure has no frame of its own
    return (text_block){.markup = markup,
                        .size = s->frame != NULL ? sketch_letters(s->frame, size) : size,
                        .family = s->frame != NULL ? s->frame->look.font : NULL};
}

void sketch_text(sketch *s, double x, double y, double ax, double ay, const char *markup,
                 double size)
{
    assert(s != NULL && markup != NULL);
    draw_block(s, block_of(s, markup, size), x, y, ax, ay, s->colours->text);
}

void sketch_wrapped(sketch *s, double x, double y, double width, text_align align,
                    const char *markup, double size, bool bold)
{
    assert(s != NULL && markup != NULL);
    text_block t = block_of(s, markup, size);
    t.bold = bold;
    t.align = align;
    t.width = width;

    double ax = 0;
    if (align != TEXT_LEFT) {
        // short lines are placed by their own width
        double natural, height;
        text_block line = t;
        line.width = 0;
        text_measure(s->context, &line, &natural, &height);
        if (natural <= width) {
            t.width = 0;
            ax = align == TEXT_RIGHT ? 1 : 0.5;
            x += ax * width;
        }
    }

    draw_block(s, t, x, y, ax, 0, s->colours->text);
}
