#include "render/scene/scene_parts.h"

#include <assert.h>
#include <math.h>

#include "render/page/picture_file.h"
#include "render/page/text.h"
#include "src/base/numbers.h"

#define TITLE_LETTERS 18.0 // [pixels of a picture 720 high]
#define FACT_LETTERS  LABELS_LEAST
#define MARGIN        22.0

static void draw_text(const labels *l, double x, double y, const char *markup, double size,
                      bool bold, colour ink)
{
    const text_block t = {.markup = markup, .size = size * l->scale, .bold = bold};
    text_put(l->cr, l->context, &t, x, y, (anchor){0, 0}, ink);
}

double labels_pixels(const camera *c, vector place, double length)
{
    return length * c->focal_y * c->height / 2 / camera_project(c, place).z;
}

void labels_flash(const labels *l, vector place, double radius, double strength)
{
    assert(radius > 0);
    enum { RAYS = 12 };
    vector at = camera_project(l->camera, place);
    double r = labels_pixels(l->camera, place, radius) * (0.55 + 0.45 * strength);

    // a glow that fades outward
    cairo_pattern_t *glow = cairo_pattern_create_radial(at.x, at.y, 0, at.x, at.y, r);
    cairo_pattern_add_color_stop_rgba(glow, 0, 1, 0.93, 0.65, 0.95 * strength);
    cairo_pattern_add_color_stop_rgba(glow, 0.3, 1, 0.75, 0.2, 0.6 * strength);
    cairo_pattern_add_color_stop_rgba(glow, 1, 1, 0.6, 0.1, 0);
    cairo_set_source(l->cr, glow);
    cairo_arc(l->cr, at.x, at.y, r, 0, 2 * M_PI);
    cairo_fill(l->cr);
    cairo_pattern_destroy(glow);

    // rays, long and short in turn
    cairo_set_line_width(l->cr, 1.6 * l->scale);
    cairo_set_line_cap(l->cr, CAIRO_LINE_CAP_ROUND);
    cairo_set_source_rgba(l->cr, 0.88, 0.5, 0.02, strength);
    for (int i = 0; i < RAYS; i++) {
        double angle = 2 * M_PI * (i + 0.5) / RAYS, far = i % 2 ? 0.8 : 1.1;
        cairo_move_to(l->cr, at.x + 0.5 * r * cos(angle), at.y + 0.5 * r * sin(angle));
        cairo_line_to(l->cr, at.x + far * r * cos(angle), at.y + far * r * sin(angle));
    }
    picture_stroke(l->cr);
}

void labels_force(const labels *l, vector from, vector end, double force, colour ink)
{
    char text[48];

    // text and its size
    decimal_print(text, sizeof text, "%.*f\u2009N", force < 10 ? 2 : force < 100 ? 1 : 0, force);
    const text_block t = {.markup = text, .size = TITLE_LETTERS * l->scale, .bold = true};
    const text_size size = text_measure(l->context, &t);
    vector start = camera_project(l->camera, from), tip = camera_project(l->camera, end);
    double dx = tip.x - start.x, dy = tip.y - start.y, length = fmax(1e-9, hypot(dx, dy));

    // beyond the arrow's point, the box touching a circle round it
    double x = tip.x + dx / length * (size.width / 2 + 8 * l->scale) - size.width / 2;
    double y = tip.y + dy / length * (size.height / 2 + 6 * l->scale) - size.height / 2;

    // inside the picture
    x = fmin(fmax(x, 4), l->camera->width - size.width - 4);
    y = fmin(fmax(y, 4), l->camera->height - size.height - 4);
    draw_text(l, x, y, text, TITLE_LETTERS, true, ink);
}

void labels_caption(const labels *l, const char *title, const char *facts, double width)
{
    assert(width > 0);
    double bottom = l->camera->height - MARGIN * l->scale, left = MARGIN * l->scale;
    double top = bottom - (TITLE_LETTERS + FACT_LETTERS) * 1.45 * l->scale;
    g_autofree char *escaped = text_escape(title);

    // a title of several lines grows upwards
    text_block t = {.markup = escaped, .size = TITLE_LETTERS * l->scale, .bold = true};
    const double line = text_measure(l->context, &t).height;
    t.width = width;
    text_put(l->cr, l->context, &t, left, top - (text_measure(l->context, &t).height - line),
             (anchor){0, 0}, l->strong);
    draw_text(l, left, bottom - FACT_LETTERS * 1.25 * l->scale, facts, FACT_LETTERS, false,
              l->faint);
}

void labels_inset(const labels *l, double left, double bottom, double larger)
{
    assert(larger > 0);
    char text[64];
    decimal_print(text, sizeof text, "contact, %.1f times", larger);
    draw_text(l, left, bottom + 4 * l->scale, text, FACT_LETTERS, false, l->faint);
}

// "12.3 ms" in the letters of facts. Returns its size.
static text_size print_instant(const labels *l, double time, char *text, size_t size)
{
    decimal_print(text, size, "%.1f\u2009ms", 1e3 * time);
    const text_block t = {.markup = text, .size = FACT_LETTERS * l->scale};
    return text_measure(l->context, &t);
}

void labels_instants(const labels *l, const double *times, const colour *inks, int count)
{
    assert(count > 0);
    double swatch = 26 * l->scale, step = FACT_LETTERS * 1.55 * l->scale;
    double bottom = l->camera->height - MARGIN * l->scale, width = 0;
    double right = l->camera->width - MARGIN * l->scale;
    char text[48];

    // all swatches stand left of the widest text
    for (int i = 0; i < count; i++) {
        width = fmax(width, print_instant(l, times[i], text, sizeof text).width);
    }

    for (int i = 0; i < count; i++) {
        double y = bottom - (count - i) * step;
        const text_size own = print_instant(l, times[i], text, sizeof text);
        draw_text(l, right - own.width, y, text, FACT_LETTERS, false, l->faint);
        set_colour(l->cr, inks[i]);
        cairo_rectangle(l->cr, right - width - 10 * l->scale - swatch,
                        y + own.height / 2 - 2.5 * l->scale, swatch, 5 * l->scale);
        cairo_fill(l->cr);
    }
}
