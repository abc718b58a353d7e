// What all layers of a figure use: text, strokes and axes.
#include "render/plot/drawing.h"

#include <math.h>

#include "render/page/picture_file.h"

// ---- text

text_block figure_text_of(const drawing *d, const char *markup, double size)
{
    return (text_block){.markup = markup, .size = size, .family = d->style.font};
}

double width_of(const drawing *d, const char *markup, double size)
{
    text_block t = figure_text_of(d, markup, size);
    return text_measure(d->context, &t).width;
}

double height_of(const drawing *d, text_block t)
{
    return text_measure(d->context, &t).height;
}

void draw_text(drawing *d, text_block t, double x, double y, anchor at, colour c)
{
    const figure_rect place = text_put(d->cr, d->context, &t, x, y, at, c);
    report_add_text(d->report, t.markup, t.size, place);
}

void draw_markup(drawing *d, const char *markup, double size, double x, double y,
                 anchor at)
{
    draw_text(d, figure_text_of(d, markup, size), x, y, at, d->style.colours->text);
}

// Turned by a quarter to the left about the middle of its upper edge.
void draw_rotated(drawing *d, text_block t, double x, double y, colour c)
{
    const text_size size = text_measure(d->context, &t);
    cairo_save(d->cr);
    cairo_translate(d->cr, x, y + size.width / 2);
    cairo_rotate(d->cr, -G_PI / 2);
    text_put(d->cr, d->context, &t, 0, 0, (anchor){0, 0}, c);
    cairo_restore(d->cr);
    report_add_text(d->report, t.markup, t.size,
                    (figure_rect){x, y - size.width / 2, size.height, size.width});
}

// ---- strokes

void set_plain_line(cairo_t *cr, colour c, double width)
{
    set_colour(cr, c);
    set_line_style(cr, LINE_SOLID, width);
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_BUTT);
}

void clip_to(cairo_t *cr, const figure_rect *box)
{
    cairo_rectangle(cr, box->x, box->y, box->width, box->height);
    cairo_clip(cr);
}

bool rects_meet(const figure_rect *a, const figure_rect *b, double space)
{
    return a->x < b->x + b->width + space && b->x < a->x + a->width + space &&
           a->y < b->y + b->height && b->y < a->y + a->height;
}

void fill_box(cairo_t *cr, const figure_rect *box, colour c)
{
    set_colour(cr, c);
    cairo_rectangle(cr, box->x, box->y, box->width, box->height);
    cairo_fill(cr);
}

// ==== axes: grid, spines, ticks, labels and titles

double widest_tick(const drawing *d, const axis *a, double size)
{
    double widest = 0;
    for (int i = 0; i < a->count; i++) {
        widest = fmax(widest, width_of(d, a->text[i], size));
    }
    return widest;
}

char *fitting_title(const drawing *d, const axis *a, double length)
{
    char *title = axis_title(a);
    if (a->from->symbol != NULL && width_of(d, title, d->style.label) > length) {
        g_free(title);
        title = axis_label_text(a->from->symbol, a->from->unit, a->even.exponent);
    }
    return title;
}

// Of the title as it is wrapped beside the axis.
double axis_title_height(const drawing *d, const axis *a, double length)
{
    g_autofree char *title = fitting_title(d, a, length);
    text_block t = figure_text_of(d, title, d->style.label);
    t.width = length;
    if (title[0] == '\0') {
        return 0;
    }
    return height_of(d, t);
}

// Vertical lines at values of x, from one height on the page to another.
static void draw_verticals(const drawing *d, const plane *p, const double *values,
                           int count, double from, double to)
{
    for (int i = 0; i < count; i++) {
        const double x = plane_x(p, values[i]);
        picture_line(d->cr, x, from, x, to);
    }
}

// Horizontal lines at values of y.
static void draw_horizontals(const drawing *d, const plane *p, const double *values,
                             int count, double from, double to)
{
    for (int i = 0; i < count; i++) {
        const double y = plane_y(p, values[i]);
        picture_line(d->cr, from, y, to, y);
    }
}

// Lines across the panel at the ticks of the vertical axis.
void draw_grid(const drawing *d, const plane *p, const axis *x, const axis *y)
{
    const figure_rect *box = &p->box;
    set_plain_line(d->cr, d->style.colours->grid, GRID_WIDTH);
    draw_horizontals(d, p, y->at, y->count, box->x, box->x + box->width);

    // where steps are not even the eye needs help across, too
    if (x->even.count == 0) {
        draw_verticals(d, p, x->at, x->count, box->y, box->y + box->height);
    }
}

// A label that would touch the one before it is left out, unless ticks are even.
static void draw_tick_labels(drawing *d, const plane *p, const axis *x, const axis *y,
                             const axes_look *look)
{
    double bottom = p->box.y + p->box.height, taken = -(double)INFINITY;

    // below
    for (int i = 0; look->x_labels && i < x->count; i++) {
        double at = plane_x(p, x->at[i]), half = width_of(d, x->text[i], look->size) / 2;
        if (x->even.count > 0 || at - half > taken + LABEL_GAP) {
            draw_markup(d, x->text[i], look->size, at,
                        bottom + TICK_LENGTH + TICK_SPACE - 1, (anchor){0.5, 0});
            taken = at + half;
        }
    }

    // at the left
    taken = (double)INFINITY;
    for (int i = 0; look->y_labels && i < y->count; i++) {
        double at = plane_y(p, y->at[i]);
        if (y->even.count > 0 || at < taken - look->size) {
            draw_markup(d, y->text[i], look->size, p->box.x - TICK_LENGTH - TICK_SPACE,
                        at, (anchor){1, 0.5});
            taken = at;
        }
    }
}

// Ticks, the lines of the axes, and labels of ticks.
void draw_axes(drawing *d, const plane *p, const axis *x, const axis *y, axes_look look)
{
    set_plain_line(d->cr, d->style.colours->axis, AXIS_WIDTH);
    double minor_x[AXIS_MINOR], minor_y[AXIS_MINOR];
    int x_count = axis_minor_ticks(x, p->box.width, minor_x);
    int y_count = axis_minor_ticks(y, p->box.height, minor_y);
    double bottom = p->box.y + p->box.height, right = p->box.x + p->box.width;

    // ticks point outwards
    draw_verticals(d, p, minor_x, x_count, bottom, bottom + MINOR_LENGTH);
    draw_horizontals(d, p, minor_y, y_count, p->box.x, p->box.x - MINOR_LENGTH);
    draw_verticals(d, p, x->at, x->count, bottom, bottom + TICK_LENGTH);
    draw_horizontals(d, p, y->at, y->count, p->box.x, p->box.x - TICK_LENGTH);

    // the axes themselves, or a frame
    cairo_set_line_cap(d->cr, CAIRO_LINE_CAP_SQUARE);
    picture_line(d->cr, p->box.x, p->box.y, p->box.x, bottom);
    picture_line(d->cr, p->box.x, bottom, right, bottom);
    if (look.framed) {
        picture_line(d->cr, p->box.x, p->box.y, right, p->box.y);
        picture_line(d->cr, right, p->box.y, right, bottom);
    }
    draw_tick_labels(d, p, x, y, &look);
}

bool has_y_labels(const drawing *d, const panel_layout *l)
{
    return !d->fig->shared_y || l->column == 0;
}

double y_title_room(const panel_layout *l)
{
    enum { APART = 4 }; // titles of neighbours [pt]
    return l->plane.box.height + PANEL_SPACE - APART;
}

// The title of the vertical axis, upwards at the left of everything.
void draw_y_title(drawing *d, const panel_layout *l)
{
    const figure_rect *box = &l->plane.box;
    g_autofree char *title = fitting_title(d, &l->y, y_title_room(l));
    text_block t = figure_text_of(d, title, d->style.label);
    t.align = TEXT_CENTRE;
    t.width = y_title_room(l);
    if (title[0] != '\0' && has_y_labels(d, l)) {
        draw_rotated(d, t, d->column[l->column].edge, box->y + box->height / 2,
                     d->style.colours->text);
    }
}
