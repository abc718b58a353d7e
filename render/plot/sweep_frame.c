// The frame of a sweep's picture: box, grid, ticks, title, and notes on runs without a value.
#include "render/plot/sweep_canvas.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

double sweep_page_x(const sweep_canvas *c, double at)
{
    return c->box.x + c->box.width * (at - c->x.low) / (c->x.high - c->x.low);
}

double sweep_page_y(const sweep_canvas *c, double at)
{
    return c->box.y + c->box.height * (c->y.high - at) / (c->y.high - c->y.low);
}

void sweep_text(sweep_canvas *c, double x, double y, const char *markup, double size,
                double align_x, double align_y)
{
    text_block t = {.markup = markup, .size = size};
    double width, height;
    text_measure(c->context, &t, &width, &height);
    cairo_move_to(c->cr, x - align_x * width, y - align_y * height);
    text_draw(c->cr, c->context, &t);
}

void sweep_upright_text(sweep_canvas *c, double x, double y, const char *markup, double size)
{
    cairo_save(c->cr);
    cairo_translate(c->cr, x, y);
    cairo_rotate(c->cr, -G_PI / 2);
    sweep_text(c, 0, 0, markup, size, 0.5, 0);
    cairo_restore(c->cr);
}

double sweep_widest_tick(sweep_canvas *c, const sweep_scale *s)
{
    double widest = 0;
    for (int i = 0; i < s->tick_count; i++) {
        text_block t = {.markup = s->ticks[i].text, .size = TICK_SIZE};
        double width, height;
        text_measure(c->context, &t, &width, &height);
        widest = fmax(widest, width);
    }
    return widest;
}

void sweep_draw_line(sweep_canvas *c, double x0, double y0, double x1, double y1)
{
    cairo_move_to(c->cr, x0, y0);
    cairo_line_to(c->cr, x1, y1);
    cairo_stroke(c->cr);
}

void sweep_draw_grid(sweep_canvas *c)
{
    set_colour(c->cr, c->colours->grid);
    cairo_set_line_width(c->cr, 0.5);
    for (int i = 0; i < c->x.tick_count; i++) {
        double x = sweep_page_x(c, c->x.ticks[i].at);
        sweep_draw_line(c, x, c->box.y, x, c->box.y + c->box.height);
    }
    for (int i = 0; i < c->y.tick_count; i++) {
        double y = sweep_page_y(c, c->y.ticks[i].at);
        sweep_draw_line(c, c->box.x, y, c->box.x + c->box.width, y);
    }
}

void sweep_draw_axes(sweep_canvas *c)
{
    double bottom = c->box.y + c->box.height, taken = -(double)INFINITY, taken_y = (double)INFINITY;
    set_colour(c->cr, c->colours->axis);
    cairo_set_line_width(c->cr, 0.7);
    cairo_rectangle(c->cr, c->box.x, c->box.y, c->box.width, c->box.height);
    cairo_stroke(c->cr);
    for (int i = 0; i < c->x.tick_count; i++) {
        double x = sweep_page_x(c, c->x.ticks[i].at), width, height;
        text_block t = {.markup = c->x.ticks[i].text, .size = TICK_SIZE};
        set_colour(c->cr, c->colours->axis);
        sweep_draw_line(c, x, bottom, x, bottom + TICK_LENGTH);
        text_measure(c->context, &t, &width, &height);
        if (x - width / 2 > taken + 3) {
            set_colour(c->cr, c->colours->text);
            sweep_text(c, x, bottom + TICK_LENGTH + 1, t.markup, TICK_SIZE, 0.5, 0);
            taken = x + width / 2;
        }
    }
    for (int i = 0; i < c->y.tick_count; i++) {
        double y = sweep_page_y(c, c->y.ticks[i].at);
        set_colour(c->cr, c->colours->axis);
        sweep_draw_line(c, c->box.x - TICK_LENGTH, y, c->box.x, y);
        if (y < taken_y - TICK_SIZE) {
            set_colour(c->cr, c->colours->text);
            sweep_text(c, c->box.x - TICK_LENGTH - 2, y, c->y.ticks[i].text, TICK_SIZE, 1, 0.5);
            taken_y = y;
        }
    }
    set_colour(c->cr, c->colours->text);
    sweep_text(c, c->box.x + c->box.width / 2, bottom + TICK_LENGTH + TICK_SIZE * 1.2 + 5,
               c->x.label, LABEL_SIZE, 0.5, 0);
    sweep_upright_text(c, MARGIN, c->box.y + c->box.height / 2, c->y.label, LABEL_SIZE);
}

void sweep_draw_title(sweep_canvas *c, const sweep_picture *p, const char *note)
{
    const sweep *s = p->sweep;
    char name[64], title[512];
    const char *unit;
    quantity_name(p->key, name, sizeof name, &unit);
    for (char *letter = name; *letter != '\0'; letter++) {
        *letter = *letter == '_' ? ' ' : *letter;
    }
    snprintf(title, sizeof title, "%s: %s of %zu runs%s", s->base->name, name, s->run_count,
             s->sampling == SWEEP_GRID     ? ""
             : s->sampling == SWEEP_RANDOM ? " at random"
                                           : " of a Latin hypercube");
    char *escaped = text_escape(title);
    set_colour(c->cr, c->colours->text);
    text_block t = {.markup = escaped, .size = TITLE_SIZE, .bold = true};
    double width, height, room = PAGE_WIDTH - MARGIN - c->box.x;
    text_measure(c->context, &t, &width, &height);
    t.size *= fmin(1, room / width);
    cairo_move_to(c->cr, c->box.x, MARGIN);
    text_draw(c->cr, c->context, &t);
    g_free(escaped);
    if (note[0] != '\0') {
        set_colour(c->cr, c->colours->faint_text);
        sweep_text(c, PAGE_WIDTH - MARGIN, PAGE_HEIGHT - MARGIN, note, TICK_SIZE, 1, 0.7);
    }
}

void sweep_place_box(sweep_canvas *c, double right, bool note)
{
    double left = MARGIN + LABEL_SIZE * 1.5 + sweep_widest_tick(c, &c->y) + TICK_LENGTH + 3;
    double top = MARGIN + TITLE_SIZE * 1.3 + 6;
    double bottom = MARGIN + LABEL_SIZE * 1.3 + 5 + TICK_SIZE * 1.2 + TICK_LENGTH +
                    (note ? TICK_SIZE * 1.5 : 0);
    c->box =
        (figure_rect){left, top, PAGE_WIDTH - left - right - MARGIN, PAGE_HEIGHT - top - bottom};
}

void sweep_no_value_text(sweep_canvas *c)
{
    set_colour(c->cr, c->colours->faint_text);
    sweep_text(c, c->box.x + c->box.width / 2, c->box.y + c->box.height / 2,
               "the quantity did not occur in any run", LABEL_SIZE, 0.5, 0.5);
}

void sweep_dot(sweep_canvas *c, double x, double y, double radius)
{
    cairo_new_sub_path(c->cr);
    cairo_arc(c->cr, x, y, radius, 0, 2 * G_PI);
}

void sweep_missing_note(const sweep_picture *p, char *note, size_t size, const char *how)
{
    size_t missing = 0;
    for (size_t i = 0; i < p->sweep->run_count; i++) {
        missing += !isfinite(p->values[i]);
    }
    note[0] = '\0';
    if (missing > 0) {
        snprintf(note, size, "%zu %s without a value%s", missing, missing == 1 ? "run" : "runs",
                 how);
    }
}

bool sweep_value_range(const double *values, size_t count, double *low, double *high)
{
    *low = (double)INFINITY;
    *high = -(double)INFINITY;
    for (size_t i = 0; i < count; i++) {
        if (isfinite(values[i])) {
            *low = fmin(*low, values[i]);
            *high = fmax(*high, values[i]);
        }
    }
    return *low <= *high;
}

void sweep_gather(const sweep_picture *p, const sweep_scale *s, double *x, double *y)
{
    for (size_t i = 0; i < p->sweep->run_count; i++) {
        size_t run = s->count > 0 && p->sweep->drawn == NULL ? s->order[i] : i;
        y[i] = p->values[run];
        x[i] = s->count > 0 && p->sweep->drawn == NULL
                   ? s->points[i]
                   : sweep_coordinate(s, sweep_value(p->sweep, run, 0));
    }
}
