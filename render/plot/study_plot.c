#include "render/plot/study_plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/plot/curve.h"
#include "render/plot/figure_file.h"
#include "render/page/palette.h"
#include "render/page/text.h"

#define MM          (72 / 25.4) // [pt]
#define PAGE_WIDTH  170.0       // [mm]
#define PAGE_HEIGHT 88.0        // [mm]
#define MARGIN      8.0         // [pt]
#define TITLE_SIZE  9.0
#define LABEL_SIZE  8.0
#define TICK_SIZE   7.0
#define TICK_LENGTH 3.0
#define LINE_WIDTH  1.2
#define GUIDE_WIDTH 0.7
#define MARKER      2.3  // its radius [pt]
#define SAMPLE      20.0 // length of a line in the legend [pt]
#define EMPTY_SHARE 0.04 // of an axis, free at both ends

// An axis in decimal logarithms.
typedef struct decades {
    double low, high;
} decades;

typedef struct canvas {
    cairo_t *cr;
    PangoContext *context;
    const palette *colours;
    const figure *figure;
    figure_rect box; // of the panel at hand, inside the axes [pt]
    decades x, y;
} canvas;

static double page_x(const canvas *c, double x)
{
    return c->box.x + c->box.width * (x - c->x.low) / (c->x.high - c->x.low);
}

static double page_y(const canvas *c, double y)
{
    return c->box.y + c->box.height * (c->y.high - y) / (c->y.high - c->y.low);
}

// Coordinates of a point; false if it has none.
static bool point_of(const figure_series *s, size_t i, double *x, double *y)
{
    *x = log10(series_x(s, i));
    *y = log10(series_y(s, i));
    return isfinite(*x) && isfinite(*y);
}

static void widen_by(decades *d, double value)
{
    d->low = fmin(d->low, value);
    d->high = fmax(d->high, value);
}

// The ranges of a panel's points; guides do not count. False if there is no point.
static bool panel_range(const figure_panel *panel, decades *x, decades *y)
{
    bool any = false;
    for (int k = 0; k < panel->series_count; k++) {
        const figure_series *s = &panel->series[k];
        double at_x, at_y;
        for (size_t i = 0; i < s->count && !s->secondary; i++) {
            if (point_of(s, i, &at_x, &at_y)) {
                any = true;
                widen_by(x, at_x);
                widen_by(y, at_y);
            }
        }
    }
    return any;
}

// Gives an axis room at its ends and at least half a decade.
static void make_room(decades *d)
{
    double missing = fmax(0, 0.5 - (d->high - d->low)) / 2;
    double room = EMPTY_SHARE * (d->high - d->low + 2 * missing) + missing;
    d->low -= room;
    d->high += room;
}

// --- text -----------------------------------------------------------------------------------

// "0.01", "20", "10<sup>−6</sup>" for mantissa times the power of ten, alike all along an axis.
static void number_label(const decades *d, int mantissa, int power, char *text, size_t size)
{
    if (d->low > -2.5 && d->high < 4.5) {
        snprintf(text, size, "%.*f", power < 0 ? -power : 0, mantissa * pow(10, power));
    } else {
        const char *minus = power < 0 ? "\u2212" : "";
        char factor[16] = "";
        if (mantissa > 1) {
            snprintf(factor, sizeof factor, "%d\u00b7", mantissa);
        }
        snprintf(text, size, "%s10<sup>%s%d</sup>", factor, minus, abs(power));
    }
}

// A label with its unit in brackets.
static void full_label(const char *label, const char *unit, char *text, size_t size)
{
    char shown[64];
    text_unit(unit ? unit : "", shown, sizeof shown);
    snprintf(text, size, shown[0] ? "%s (%s)" : "%s", label ? label : "", shown);
}

static void draw_text(const canvas *c, double x, double y, const char *markup, double size,
                      double align_x, double align_y)
{
    text_block t = {.markup = markup, .size = size};
    double width, height;
    text_measure(c->context, &t, &width, &height);
    cairo_move_to(c->cr, x - align_x * width, y - align_y * height);
    text_draw(c->cr, c->context, &t);
}

static double text_height(const canvas *c, const text_block *t)
{
    double width, height;
    text_measure(c->context, t, &width, &height);
    return height;
}

// --- axes -----------------------------------------------------------------------------------

static void line(const canvas *c, double x0, double y0, double x1, double y1)
{
    cairo_move_to(c->cr, x0, y0);
    cairo_line_to(c->cr, x1, y1);
    cairo_stroke(c->cr);
}

// How many decades from one label to the next, so that at most `most` of them stand there.
static int label_spacing(const decades *d, int most)
{
    int spacing = 1;
    while ((d->high - d->low) / spacing > most) {
        spacing++;
    }
    return spacing;
}

typedef void (*tick_sink)(const canvas *c, double at, const char *label);

// Gives every tick of an axis to the sink: powers of ten with labels, what lies between them
// without; where there are few decades 2 and 5 have labels too.
static void each_tick(const canvas *c, const decades *d, int most, tick_sink sink)
{
    bool few = d->high - d->low < 2.2;
    int spacing = label_spacing(d, most);
    for (int power = (int)floor(d->low); power <= (int)ceil(d->high); power++) {
        for (int mantissa = 1; mantissa < 10; mantissa++) {
            double at = power + log10(mantissa);
            char text[48] = "";
            if (at < d->low || at > d->high) {
                continue;
            }
            bool labelled = (mantissa == 1 && power % spacing == 0) ||
                            (few && (mantissa == 2 || mantissa == 5));
            if (labelled) {
                number_label(d, mantissa, power, text, sizeof text);
            }
            if (labelled || spacing == 1) {
                sink(c, at, text);
            }
        }
    }
}

static void tick_x(const canvas *c, double at, const char *label)
{
    double x = page_x(c, at), bottom = c->box.y + c->box.height;
    bool major = label[0] != '\0';
    if (major) {
        set_colour(c->cr, c->colours->grid);
        cairo_set_line_width(c->cr, 0.5);
        line(c, x, c->box.y, x, bottom);
        set_colour(c->cr, c->colours->text);
        draw_text(c, x, bottom + TICK_LENGTH + 1, label, TICK_SIZE, 0.5, 0);
    }
    set_colour(c->cr, c->colours->axis);
    cairo_set_line_width(c->cr, major ? 0.7 : 0.4);
    line(c, x, bottom, x, bottom + (major ? TICK_LENGTH : TICK_LENGTH / 2));
}

static void tick_y(const canvas *c, double at, const char *label)
{
    double y = page_y(c, at), left = c->box.x;
    bool major = label[0] != '\0';
    if (major) {
        set_colour(c->cr, c->colours->grid);
        cairo_set_line_width(c->cr, 0.5);
        line(c, left, y, left + c->box.width, y);
        set_colour(c->cr, c->colours->text);
        draw_text(c, left - TICK_LENGTH - 2, y, label, TICK_SIZE, 1, 0.5);
    }
    set_colour(c->cr, c->colours->axis);
    cairo_set_line_width(c->cr, major ? 0.7 : 0.4);
    line(c, left - (major ? TICK_LENGTH : TICK_LENGTH / 2), y, left, y);
}

// Number of labels that fit, and the axes with grid, ticks and names.
static void draw_axes(const canvas *c, const figure_panel *panel)
{
    char label[256];
    double bottom = c->box.y + c->box.height;
    set_line_style(c->cr, LINE_SOLID, 0.7);
    each_tick(c, &c->x, (int)(c->box.width / 24), tick_x);
    each_tick(c, &c->y, (int)(c->box.height / 14), tick_y);
    set_colour(c->cr, c->colours->axis);
    set_line_style(c->cr, LINE_SOLID, 0.7);
    cairo_rectangle(c->cr, c->box.x, c->box.y, c->box.width, c->box.height);
    cairo_stroke(c->cr);
    set_colour(c->cr, c->colours->text);
    full_label(c->figure->x_label, c->figure->x_unit, label, sizeof label);
    draw_text(c, c->box.x + c->box.width / 2, bottom + TICK_LENGTH + TICK_SIZE * 1.4 + 4, label,
              LABEL_SIZE, 0.5, 0);
    // what the panel shows stands above it, where it is read without turning the head
    full_label(panel->label, panel->unit, label, sizeof label);
    draw_text(c, c->box.x, c->box.y - 3, label, LABEL_SIZE, 0, 1);
}

// --- curves ---------------------------------------------------------------------------------

static void draw_marker(const canvas *c, marker_kind kind, double x, double y)
{
    switch (kind) {
    case MARKER_NONE:
        return;
    case MARKER_CIRCLE:
        cairo_new_sub_path(c->cr);
        cairo_arc(c->cr, x, y, MARKER, 0, 2 * G_PI);
        break;
    case MARKER_SQUARE:
        cairo_rectangle(c->cr, x - 0.9 * MARKER, y - 0.9 * MARKER, 1.8 * MARKER, 1.8 * MARKER);
        break;
    case MARKER_TRIANGLE:
        cairo_move_to(c->cr, x, y - 1.25 * MARKER);
        cairo_line_to(c->cr, x + 1.1 * MARKER, y + 0.75 * MARKER);
        cairo_line_to(c->cr, x - 1.1 * MARKER, y + 0.75 * MARKER);
        cairo_close_path(c->cr);
        break;
    }
    cairo_fill(c->cr);
}

static void use_pen(const canvas *c, const figure_panel *panel, int index)
{
    const figure_series *s = &panel->series[index];
    set_colour(c->cr, palette_series(c->figure->theme, s->colour, index));
    set_line_style(c->cr, palette_style(panel->series, index),
                   s->secondary ? GUIDE_WIDTH : LINE_WIDTH);
}

static void draw_series(const canvas *c, const figure_panel *panel, int index)
{
    const figure_series *s = &panel->series[index];
    bool pen_down = false;
    use_pen(c, panel, index);
    for (size_t i = 0; i < s->count && !s->no_line; i++) {
        double x, y;
        bool there = point_of(s, i, &x, &y);
        if (there && pen_down) {
            cairo_line_to(c->cr, page_x(c, x), page_y(c, y));
        } else if (there) {
            cairo_move_to(c->cr, page_x(c, x), page_y(c, y));
        }
        pen_down = there;
    }
    cairo_stroke(c->cr);
    for (size_t i = 0; i < s->count && !s->secondary; i++) {
        double x, y;
        if (point_of(s, i, &x, &y)) {
            draw_marker(c, s->marker, page_x(c, x), page_y(c, y));
        }
    }
}

static void draw_panel(const canvas *c, const figure_panel *panel)
{
    draw_axes(c, panel);
    cairo_save(c->cr);
    cairo_rectangle(c->cr, c->box.x, c->box.y, c->box.width, c->box.height);
    cairo_clip(c->cr);
    for (int k = 0; k < panel->series_count; k++) {
        if (panel->series[k].secondary) {
            draw_series(c, panel, k);
        }
    }
    for (int k = 0; k < panel->series_count; k++) {
        if (!panel->series[k].secondary) {
            draw_series(c, panel, k);
        }
    }
    cairo_restore(c->cr);
}

// Lines and labels of the first panel's series, in a row that is wrapped where it is too long.
// Returns the height it takes.
static double draw_legend(const canvas *c, double top, double left, double right)
{
    const figure_panel *panel = &c->figure->panels[0];
    double x = left, y = top, height = LABEL_SIZE * 1.5;
    for (int k = 0; k < panel->series_count; k++) {
        const figure_series *s = &panel->series[k];
        text_block t = {.markup = s->label, .size = LABEL_SIZE};
        double width, text_high;
        if (s->label == NULL) {
            continue;
        }
        text_measure(c->context, &t, &width, &text_high);
        if (x > left && x + SAMPLE + 5 + width > right) {
            x = left;
            y += height;
        }
        double middle = y + height / 2;
        use_pen(c, panel, k);
        if (!s->no_line) {
            line(c, x, middle, x + SAMPLE, middle);
        }
        if (!s->secondary) {
            draw_marker(c, s->marker, x + SAMPLE / 2, middle);
        }
        set_colour(c->cr, c->colours->text);
        draw_text(c, x + SAMPLE + 5, middle, s->label, LABEL_SIZE, 0, 0.5);
        x += SAMPLE + 5 + width + 14;
    }
    return y + height - top;
}

// --- the page -------------------------------------------------------------------------------

static double page_width(const figure *fig)
{
    return (fig->width > 0 ? fig->width : PAGE_WIDTH) * MM;
}

static double page_height(const figure *fig)
{
    return (fig->height > 0 ? fig->height : PAGE_HEIGHT) * MM;
}

// Room for the labels at the left of a panel.
static double left_room(const canvas *c)
{
    double widest = 0;
    for (int power = (int)floor(c->y.low); power <= (int)ceil(c->y.high); power++) {
        char text[48];
        number_label(&c->y, 1, power, text, sizeof text);
        text_block t = {.markup = text, .size = TICK_SIZE};
        double width, height;
        text_measure(c->context, &t, &width, &height);
        widest = fmax(widest, width);
    }
    return widest + TICK_LENGTH + 4;
}

static status paint_panels(canvas *c, double top, double bottom, fault *f)
{
    const figure *fig = c->figure;
    double each = (page_width(fig) - 2 * MARGIN) / fig->panel_count;
    for (int i = 0; i < fig->panel_count; i++) {
        const figure_panel *panel = &fig->panels[i];
        c->x = c->y = (decades){(double)INFINITY, -(double)INFINITY};
        if (!panel_range(panel, &c->x, &c->y)) {
            return fault_set(f, STATUS_BAD_ARGUMENT,
                             "the panel '%s' has no point above zero to show", panel->name);
        }
        make_room(&c->x);
        make_room(&c->y);
        double left = MARGIN + i * each + left_room(c);
        c->box = (figure_rect){left, top, MARGIN + (i + 1) * each - left - 8, bottom - top};
        draw_panel(c, panel);
    }
    return STATUS_OK;
}

status study_plot_paint(cairo_t *cr, const figure *fig, fault *f)
{
    status code = text_check_font(f);
    if (code != STATUS_OK) {
        return code;
    }
    canvas c = {.cr = cr,
                .context = text_context_create(),
                .colours = palette_of(fig->theme),
                .figure = fig};
    double left = MARGIN, right = page_width(fig) - MARGIN, top = MARGIN;
    double bottom = page_height(fig) - MARGIN;
    set_colour(cr, c.colours->page);
    cairo_paint(cr);
    if (fig->title != NULL) {
        char *escaped = text_escape(fig->title);
        text_block t = {.markup = escaped, .size = TITLE_SIZE, .bold = true, .width = right - left};
        set_colour(cr, c.colours->text);
        cairo_move_to(cr, left, top);
        text_draw(cr, c.context, &t);
        top += text_height(&c, &t) + 3;
        g_free(escaped);
    }
    if (fig->caption != NULL) {
        text_block t = {.markup = fig->caption, .size = TICK_SIZE, .width = right - left};
        bottom -= text_height(&c, &t);
        set_colour(cr, c.colours->faint_text);
        cairo_move_to(cr, left, bottom);
        text_draw(cr, c.context, &t);
        bottom -= 5;
    }
    top += draw_legend(&c, top, left, right) + LABEL_SIZE * 1.4 + 4;
    bottom -= LABEL_SIZE * 1.4 + TICK_LENGTH + TICK_SIZE * 1.4 + 4;
    code = paint_panels(&c, top, bottom, f);
    g_object_unref(c.context);
    return code;
}

static status paint(cairo_t *cr, const void *what, fault *f)
{
    return study_plot_paint(cr, what, f);
}

status study_plot_write(const figure *fig, const char *path, fault *f)
{
    picture page = {.width = page_width(fig),
                    .height = page_height(fig),
                    .dpi = fig->dpi,
                    .title = fig->title,
                    .software = fig->software,
                    .parameters = fig->parameters,
                    .paint = paint,
                    .what = fig};
    char csv[4096];
    const char *ending = strrchr(path, '.');
    status code = picture_write(&page, path, f);
    if (code != STATUS_OK || ending == NULL) {
        return code;
    }
    snprintf(csv, sizeof csv, "%.*s.csv", (int)(ending - path), path);
    return figure_write_csv(fig, csv, f);
}
