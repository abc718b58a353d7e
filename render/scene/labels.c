// What is written on a picture of a scene: forces, flashes, title, facts, keys.
#include "render/scene/scene_parts.h"

#include <assert.h>
#include <math.h>

#include "render/page/picture_file.h"
#include "render/page/text.h"

#define TITLE_LETTERS 18.0 // [pixels of a picture 720 high]
#define FACT_LETTERS  SCENE_LETTERS
#define MARGIN        22.0

double labels_scale(const scene *sc)
{
    const double own = sc->options.letters;
    if (own > 0) {
        return own;
    }
    return fmin(sc->options.height / 720.0, sc->options.width / 800.0);
}

bool labels_are_large(const scene *sc)
{
    return labels_scale(sc) * 800 > 1.3 * sc->options.width;
}

// A line of facts.
static text_block fact(const scene *sc, const char *markup)
{
    return (text_block){.markup = markup, .size = FACT_LETTERS * labels_scale(sc)};
}

// Writes a text with its upper left corner at (x, y), and takes its place.
static void put_text_line(scene *sc, cairo_t *cr, text_block t, double x, double y,
                          colour ink)
{
    taken_add_box(&sc->taken, text_put(cr, sc->context, &t, x, y, (anchor){0, 0}, ink));
}

double labels_pixels(const camera *c, vector place, double length)
{
    return length * c->focal_y * c->height / 2 / camera_project(c, place).z;
}

void labels_flash(const scene *sc, cairo_t *cr, vector place, double radius,
                  double strength)
{
    assert(radius > 0);
    enum { RAYS = 12 };
    vector at = camera_project(&sc->camera, place);
    double r = labels_pixels(&sc->camera, place, radius) * (0.55 + 0.45 * strength);

    // a glow that fades outward
    cairo_pattern_t *glow = cairo_pattern_create_radial(at.x, at.y, 0, at.x, at.y, r);
    cairo_pattern_add_color_stop_rgba(glow, 0, 1, 0.93, 0.65, 0.95 * strength);
    cairo_pattern_add_color_stop_rgba(glow, 0.3, 1, 0.75, 0.2, 0.6 * strength);
    cairo_pattern_add_color_stop_rgba(glow, 1, 1, 0.6, 0.1, 0);
    cairo_set_source(cr, glow);
    cairo_arc(cr, at.x, at.y, r, 0, 2 * M_PI);
    cairo_fill(cr);
    cairo_pattern_destroy(glow);

    // rays, long and short in turn
    cairo_set_line_width(cr, 1.6 * labels_scale(sc));
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
    cairo_set_source_rgba(cr, 0.88, 0.5, 0.02, strength);
    for (int i = 0; i < RAYS; i++) {
        const double angle = 2 * M_PI * (i + 0.5) / RAYS;
        const double far = i % 2 == 0 ? 1.1 : 0.8;
        cairo_move_to(cr, at.x + 0.5 * r * cos(angle), at.y + 0.5 * r * sin(angle));
        cairo_line_to(cr, at.x + far * r * cos(angle), at.y + far * r * sin(angle));
    }
    cairo_stroke(cr);
}

// Decimals that show three digits of a force of 1 N to 1000 N.
static int force_decimals(double force)
{
    if (force < 10) {
        return 2;
    }
    if (force < 100) {
        return 1;
    }
    return 0;
}

void labels_force(scene *sc, cairo_t *cr, vector from, vector end, double force)
{
    // text and its size
    g_autofree char *text = text_printf("%.*f\u2009N", force_decimals(force), force);
    const double scale = labels_scale(sc);
    const text_block t = {.markup = text, .size = TITLE_LETTERS * scale, .bold = true};
    const text_size size = text_measure(sc->context, &t);
    vector start = camera_project(&sc->camera, from),
           tip = camera_project(&sc->camera, end);
    vector along = vector_unit((vector){tip.x - start.x, tip.y - start.y, 0});

    // beyond the arrow's point, or where it is clear
    const figure_rect clear = taken_clear_box(&sc->taken, tip, along, size, &sc->camera);
    colour ink = {0.70, 0.28, 0};
    if (sc->options.rank > 0) {
        ink = sc->around->strong;
    } else if (sc->options.theme == THEME_DARK) {
        ink = (colour){1, 0.62, 0.30};
    }
    put_text_line(sc, cr, t, clear.x, clear.y, ink);
}

void labels_caption(scene *sc, cairo_t *cr, const char *title, const char *facts,
                    double width)
{
    assert(width > 0);
    const double scale = labels_scale(sc), left = MARGIN * scale;
    const double bottom = sc->camera.height - MARGIN * scale;
    g_autofree char *escaped = text_escape(title);

    // lines grow upwards, the facts' first
    text_block below = fact(sc, facts);
    below.width = width;
    double top = bottom - text_measure(sc->context, &below).height;
    put_text_line(sc, cr, below, left, top, sc->around->faint);

    const text_block above = {.markup = escaped,
                              .size = TITLE_LETTERS * scale,
                              .bold = true,
                              .width = width};
    top -= 0.3 * FACT_LETTERS * scale + text_measure(sc->context, &above).height;
    put_text_line(sc, cr, above, left, top, sc->around->strong);
}

void labels_inset(scene *sc, cairo_t *cr, double left, double bottom, double larger)
{
    assert(larger > 0);
    const bool touches = sc->scenario->parameters.wall.kind != WALL_NONE;
    g_autofree char *text =
        text_printf("%s, %.1f times", touches ? "contact" : "tip", larger);
    const text_block t = fact(sc, text);
    const text_size size = text_measure(sc->context, &t);
    const double room = 5 * labels_scale(sc);

    // on a ground of its own
    set_colour(cr, sc->around->page);
    cairo_rectangle(cr, left, bottom - size.height - 2 * room, size.width + 2 * room,
                    size.height + 2 * room);
    cairo_fill(cr);
    put_text_line(sc, cr, t, left + room, bottom - size.height - room, sc->around->faint);
}

void labels_instants(scene *sc, cairo_t *cr, const double *times, const colour *inks,
                     int count)
{
    assert(count > 0);
    const double scale = labels_scale(sc), swatch = 26 * scale,
                 step = FACT_LETTERS * 1.55 * scale;
    double bottom = sc->camera.height - MARGIN * scale, width = 0;
    double right = sc->camera.width - MARGIN * scale;

    // all swatches stand left of the widest text
    for (int i = 0; i < count; i++) {
        g_autofree char *text = text_printf("%.1f\u2009ms", 1e3 * times[i]);
        const text_block t = fact(sc, text);
        width = fmax(width, text_measure(sc->context, &t).width);
    }

    for (int i = 0; i < count; i++) {
        double y = bottom - (count - i) * step;
        g_autofree char *text = text_printf("%.1f\u2009ms", 1e3 * times[i]);
        const text_block t = fact(sc, text);
        const text_size own = text_measure(sc->context, &t);
        put_text_line(sc, cr, t, right - own.width, y, sc->around->faint);
        set_colour(cr, inks[i]);
        const figure_rect bar = {right - width - 10 * scale - swatch,
                                 y + own.height / 2 - 2.5 * scale, swatch, 5 * scale};
        cairo_rectangle(cr, bar.x, bar.y, bar.width, bar.height);
        cairo_fill(cr);
        taken_add_box(&sc->taken, bar);
    }
}
