// A quantity over one parameter, and what pictures of either kind are asked for.
#include "render/plot/sweep_canvas.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/plot/curve.h"
#include "render/page/picture_file.h"
#include "src/base/version.h"

enum { MOST_MARKERS = 80 };

// --- one parameter --------------------------------------------------------------------------

static void stroke_to(void *context, stroke_kind kind, double x, double y)
{
    cairo_t *cr = context;
    switch (kind) {
    case STROKE_MOVE:
        cairo_move_to(cr, x, y);
        break;
    case STROKE_LINE:
        cairo_line_to(cr, x, y);
        break;
    case STROKE_DOT:
        // a line without length shows its round ends
        cairo_move_to(cr, x, y);
        cairo_line_to(cr, x, y);
        break;
    }
}

// The curve through `count` points (x, y), in coordinates.
static void draw_curve(sweep_canvas *c, const double *x, const double *y, size_t count,
                       bool with_line, figure_theme theme)
{
    figure_series series = {.x = x, .y = y, .count = count};
    plane place = {c->box, c->x.low, c->x.high, c->y.low, c->y.high};
    set_colour(c->cr, palette_series(theme, 0, 0));
    if (with_line) {
        set_line_style(c->cr, LINE_SOLID, 1.2);
        curve_trace(&place, &series, stroke_to, c->cr);
        cairo_stroke(c->cr);
    }
    if (with_line && count > MOST_MARKERS) {
        return;
    }
    double radius = count > 500 ? 1.1 : count > 12 ? 1.9 : 2.4;
    for (size_t i = 0; i < count; i++) {
        if (isfinite(y[i])) {
            sweep_dot(c, sweep_page_x(c, x[i]), sweep_page_y(c, y[i]), radius);
        }
    }
    cairo_fill(c->cr);
}

static status paint_line(sweep_canvas *c, const sweep_picture *p, fault *f)
{
    const sweep *s = p->sweep;
    double low, high, *x = malloc(2 * s->run_count * sizeof *x);
    char note[128];
    if (x == NULL || !sweep_scale_of_axis(&c->x, &s->axes[0], 8)) {
        free(x);
        return fault_set(f, STATUS_NO_MEMORY, "%s", status_text(STATUS_NO_MEMORY));
    }
    bool any = sweep_value_range(p->values, s->run_count, &low, &high);
    low = any ? low : 0;
    high = any ? high : 1;
    double room = high > low ? 0.05 * (high - low) : fmax(0.1 * fabs(high), 1e-12);
    sweep_scale_of_quantity(&c->y, p->key, low - room, high + room, 6);
    if (c->x.kind == SCALE_WORDS) {
        c->x.low = -0.5;
        c->x.high = (double)c->x.count - 0.5;
    } else {
        sweep_scale_widen(&c->x, 0.02);
    }
    sweep_missing_note(p, note, sizeof note, "");
    sweep_place_box(c, 0, note[0] != '\0');
    sweep_draw_grid(c);
    sweep_gather(p, &c->x, x, x + s->run_count);
    cairo_save(c->cr);
    cairo_rectangle(c->cr, c->box.x, c->box.y, c->box.width, c->box.height);
    cairo_clip(c->cr);
    bool with_line = s->sampling == SWEEP_GRID && c->x.kind != SCALE_WORDS;
    draw_curve(c, x, x + s->run_count, s->run_count, with_line, p->theme);
    cairo_restore(c->cr);
    sweep_draw_axes(c);
    sweep_draw_title(c, p, note);
    if (!any) {
        sweep_no_value_text(c);
    }
    free(x);
    return STATUS_OK;
}

// --- files ----------------------------------------------------------------------------------

status sweep_plot_check(const sweep *s, const char *path, fault *f)
{
    if (s->axis_count > 2) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "--plot shows one or two varied parameters, but %d are varied",
                         s->axis_count);
    }
    status code = picture_check_path(path, f);
    return code == STATUS_OK ? text_check_font(f) : code;
}

status sweep_plot_paint(cairo_t *cr, const sweep_picture *p, fault *f)
{
    status code = text_check_font(f);
    if (code != STATUS_OK) {
        return code;
    }
    sweep_canvas c = {.cr = cr, .context = text_context_create(), .colours = palette_of(p->theme)};
    set_colour(cr, c.colours->page);
    cairo_paint(cr);
    code = p->sweep->axis_count == 1 ? paint_line(&c, p, f) : sweep_paint_map(&c, p, f);
    sweep_scale_finish(&c.x);
    sweep_scale_finish(&c.y);
    g_object_unref(c.context);
    return code;
}

static status paint(cairo_t *cr, const void *what, fault *f)
{
    return sweep_plot_paint(cr, what, f);
}

status sweep_plot_write(const sweep_picture *p, const char *path, fault *f)
{
    const sweep *s = p->sweep;
    char vary[512] = "", software[64];
    size_t length = 0;
    for (int i = 0; i < s->axis_count && length < sizeof vary; i++) {
        length += (size_t)snprintf(vary + length, sizeof vary - length, "%s--vary %s=%s",
                                   i > 0 ? " " : "", parameter_table[s->axes[i].parameter].path,
                                   s->axes[i].text);
    }
    snprintf(software, sizeof software, "impactlab %s", lab_version());
    picture page = {.width = PAGE_WIDTH,
                    .height = PAGE_HEIGHT,
                    .title = s->base->name,
                    .software = software,
                    .parameters = vary,
                    .paint = paint,
                    .what = p};
    return picture_write(&page, path, f);
}
