#include "render/plot/drawing.h"

#include <assert.h>
#include <math.h>

#include "render/page/picture_file.h"

// ---- text

text_block figure_text_of(const drawing *d, const char *markup, double size)
{
    return (text_block){.markup = markup, .size = size, .family = d->style.font};
}

double width_of(const drawing *d, const char *markup, double size)
{
    double width, height;
    text_block t = figure_text_of(d, markup, size);
    text_measure(d->context, &t, &width, &height);
    return width;
}

double height_of(const drawing *d, text_block t)
{
    double width, height;
    text_measure(d->context, &t, &width, &height);
    return height;
}

void draw_text(drawing *d, text_block t, double x, double y, anchor at, colour c)
{
    double width, height;
    assert(isfinite(x) && isfinite(y));
    text_measure(d->context, &t, &width, &height);
    set_colour(d->cr, c);
    x -= at.x * width;
    y -= at.y * height;
    cairo_move_to(d->cr, x, y);
    text_draw(d->cr, d->context, &t);
    report_add_text(d->report, t.markup, t.size, (figure_rect){x, y, width, height});
}

void draw_rotated(drawing *d, text_block t, double x, double y, colour c)
{
    double width, height;
    assert(isfinite(x) && isfinite(y));
    text_measure(d->context, &t, &width, &height);
    cairo_save(d->cr);
    set_colour(d->cr, c);
    cairo_translate(d->cr, x, y + width / 2);
    cairo_rotate(d->cr, -G_PI / 2);
    cairo_move_to(d->cr, 0, 0);
    text_draw(d->cr, d->context, &t);
    cairo_restore(d->cr);
    report_add_text(d->report, t.markup, t.size, (figure_rect){x, y - width / 2, height, width});
}

// ---- strokes

void draw_line(cairo_t *cr, double x0, double y0, double x1, double y1)
{
    cairo_move_to(cr, x0, y0);
    cairo_line_to(cr, x1, y1);
    picture_stroke(cr);
}

void set_plain_line(cairo_t *cr, colour c, double width)
{
    set_colour(cr, c);
    set_line_style(cr, LINE_SOLID, width);
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_BUTT);
}

void clip_to(cairo_t *cr, const figure_rect *box, double space)
{
    cairo_rectangle(cr, box->x - space, box->y - space, box->width + 2 * space,
                    box->height + 2 * space);
    cairo_clip(cr);
}

void fill_box(cairo_t *cr, const figure_rect *box, colour c)
{
    set_colour(cr, c);
    cairo_rectangle(cr, box->x, box->y, box->width, box->height);
    cairo_fill(cr);
}
