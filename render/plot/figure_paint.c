// Paints a figure: its layers from the lowest to the uppermost, once all are placed.

#include <assert.h>
#include <math.h>
#include <string.h>

#include "render/plot/drawing.h"

#define DEFAULT_WIDTH 170.0 // [mm]
#define PANEL_HEIGHT  34.0  // of a panel of weight 1 on a page without a height [mm]
#define COLUMN_WIDTH  42.0  // least width of a column of panels [mm]
#define SIDES         52.0  // approximate width of the labels next to the panels [pt]

int figure_columns(const figure *fig)
{
    double width = fig->width > 0 ? fig->width : DEFAULT_WIDTH;
    int columns = fig->columns > 0 ? fig->columns : 1, most = (int)(width / COLUMN_WIDTH);
    return columns <= most || most < 1 ? columns : most == 2 && columns == 3 ? 1 : most;
}

void figure_take_look(figure *fig, const page_look *look)
{
    assert(fig != NULL && look != NULL);
    fig->theme = look->theme;
    fig->width = look->width > 0 ? look->width : fig->width;
    fig->height = look->height > 0 ? look->height : look->width > 0 ? 0 : fig->height;
    fig->dpi = look->dpi > 0 ? look->dpi : fig->dpi;
    fig->font = look->font != NULL ? look->font : fig->font;
    fig->letters = look->letters > 0 ? look->letters : fig->letters;
    fig->bare = fig->bare || look->bare;
    fig->transparent = fig->transparent || look->transparent;
}

static double sides_of(const figure *fig)
{
    return fig->width > 0 && fig->width * POINTS_PER_MM < NARROW_PAGE ? 2 * PAGE_MARGIN : SIDES;
}

// Height of a wrapped text above or below the panels, with its distance from them [pt].
static double wrapped_height(const figure *fig, const char *markup, double size, bool bold)
{
    double width, height;

    PangoContext *context = text_context_create();
    text_block t = {.markup = markup,
                    .size = page_letters(fig->letters, size),
                    .family = fig->font,
                    .bold = bold,
                    .balanced = bold,
                    .width = (fig->width > 0 ? fig->width : DEFAULT_WIDTH) * POINTS_PER_MM -
                             sides_of(fig)};

    text_measure(context, &t, &width, &height);
    g_object_unref(context);
    return height + 4;
}

// A page that is half as wide has panels that are a fifth lower.
static double panel_height(const figure *fig)
{
    double width = fig->width > 0 ? fig->width : DEFAULT_WIDTH;
    return PANEL_HEIGHT * pow(fmin(1, width / DEFAULT_WIDTH), 0.32) * POINTS_PER_MM;
}

void figure_size(const figure *fig, double *width, double *height)
{
    assert(fig != NULL && width != NULL && height != NULL);
    double points = 0;
    int columns = figure_columns(fig);

    // rows of panels
    for (int i = 0; i < fig->panel_count; i += columns) {
        const figure_panel *p = &fig->panels[i];
        points += (p->weight > 0 ? p->weight : 1) * panel_height(fig) + PANEL_SPACE;
        points += p->impulse_count > 0 ? STRIP_HEIGHT + STRIP_SPACE : 0;
        points += p->heading != NULL ? HEADING_ROW : 0;
    }

    // the axis below, title and caption
    points += 2 * PAGE_MARGIN + 24;
    if (fig->title != NULL && !fig->bare) {
        char *title = text_escape(fig->title);
        points += wrapped_height(fig, title, TITLE_LETTERS, true);
        g_free(title);
    }
    if (fig->caption != NULL && !fig->bare) {
        points += wrapped_height(fig, fig->caption, SMALL_LETTERS, false);
    }

    *width = (fig->width > 0 ? fig->width : DEFAULT_WIDTH) * POINTS_PER_MM;
    *height = fig->height > 0 ? fig->height * POINTS_PER_MM : points;
}

static plot_style style_of(const figure *fig)
{
    return (plot_style){.theme = fig->theme,
                        .colours = palette_of(fig->theme),
                        .font = fig->font != NULL ? fig->font : TEXT_FAMILY,
                        .title = page_letters(fig->letters, TITLE_LETTERS),
                        .label = page_letters(fig->letters, LETTERS_NORMAL),
                        .tick = page_letters(fig->letters, TICK_LETTERS),
                        .small = page_letters(fig->letters, SMALL_LETTERS)};
}

// ---- the whole

static void draw_panel_texts(drawing *d, const panel_layout *l)
{
    const figure_rect *box = &l->plane.box;
    if (l->panel->heading != NULL) {
        draw_text(d, figure_text_of(d, l->panel->heading, d->style.label), box->x + box->width / 2,
                  box->y - 2, (anchor){0.5, 1}, d->style.colours->text);
    }
    if (l->panel->remark != NULL) {
        draw_text(d, figure_text_of(d, l->panel->remark, d->style.label), box->x + box->width / 2,
                  box->y + box->height / 2, (anchor){0.5, 0.5}, d->style.colours->faint_text);
    }
}

// The layers of a panel, from the lowest to the uppermost.
static void draw_panel(drawing *d, int index)
{
    const panel_layout *l = &d->panels[index];
    axes_look look = {.x_labels = index + d->columns >= d->fig->panel_count,
                      .y_labels = has_y_labels(d, l),
                      .framed = l->panel->map != NULL,
                      .size = d->style.tick};

    // data
    draw_impulses(d, l);
    draw_map(d, l);
    draw_levels(d, l);
    draw_series(d, l, &l->plane);

    // axes and texts
    draw_axes(d, &l->plane, &d->x, &l->y, look);
    draw_y_title(d, l);
    draw_panel_texts(d, l);
    draw_colour_bar(d, l);

    // what stands in the panel
    draw_notes(d, l);
    draw_inset(d, l);
    draw_legend(d, l);
    if (has_end_labels(l->panel)) {
        draw_end_labels(d, l);
    }

    // where they went
    if (d->report != NULL) {
        const axis_scale *x = &l->plane.x, *y = &l->plane.y;
        d->report->ranges[index] =
            (figure_range){scale_value(x->kind, x->low), scale_value(x->kind, x->high),
                           scale_value(y->kind, y->low), scale_value(y->kind, y->high),
                           x->kind == SCALE_LOGARITHMIC, y->kind == SCALE_LOGARITHMIC};
        d->report->panels[index] = l->plane.box;
        d->report->legends[index] = l->legend;
        d->report->insets[index] = l->inset;
    }
}

static void draw_frame_texts(drawing *d)
{
    const figure *fig = d->fig;
    double left, width = frame_text_width(d, &left);

    // the title above
    if (fig->title != NULL && !fig->bare) {
        char *title = text_escape(fig->title);
        text_block t = figure_text_of(d, title, d->style.title);
        t.bold = t.balanced = true;
        t.width = width;
        draw_text(d, t, left, d->title_y, (anchor){0, 0}, d->style.colours->text);
        g_free(title);
    }

    // the caption below
    if (fig->caption != NULL && !fig->bare) {
        text_block t = figure_text_of(d, fig->caption, d->style.small);
        t.width = width;
        draw_text(d, t, left, d->caption_y, (anchor){0, 0}, d->style.colours->faint_text);
    }

    draw_x_titles(d);
}

static void draw_all(drawing *d)
{
    if (!d->fig->transparent) {
        fill_box(d->cr, &d->page, d->style.colours->page);
    }

    // behind the data
    for (int i = 0; i < d->fig->panel_count; i++) {
        draw_intervals(d, &d->panels[i].plane);
        draw_grid(d, &d->panels[i].plane, &d->x, &d->panels[i].y);
    }

    draw_marks(d);

    // texts of the whole, then the panels
    draw_frame_texts(d);
    draw_common_legend(d);
    for (int i = 0; i < d->fig->panel_count; i++) {
        draw_panel(d, i);
    }
    draw_points(d);
}

static status check_description(const figure *fig, fault *f)
{
    if (fig->panel_count < 1 || fig->panel_count > FIGURE_PANELS) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "a figure has %d panels, expected 1 to %d",
                         fig->panel_count, FIGURE_PANELS);
    }

    for (int i = 0; i < fig->panel_count; i++) {
        if (fig->panels[i].series_count < 0 || fig->panels[i].series_count > PANEL_SERIES) {
            return fault_set(f, STATUS_BAD_ARGUMENT,
                             "panel %d of a figure has %d series, expected at most %d", i + 1,
                             fig->panels[i].series_count, PANEL_SERIES);
        }
    }
    return STATUS_OK;
}

status figure_paint(cairo_t *cr, const figure *fig, figure_report *report, fault *f)
{
    assert(cr != NULL && fig != NULL);
    status code = check_description(fig, f);
    if (code == STATUS_OK) {
        code = text_check_font(f);
    }
    if (code != STATUS_OK) {
        return code;
    }

    // too large for a thread's stack
    drawing *d = g_new0(drawing, 1);
    d->cr = cr;
    d->fig = fig;
    d->style = style_of(fig);
    d->report = report;
    figure_size(fig, &d->page.width, &d->page.height);
    if (report != NULL) {
        memset(report, 0, sizeof *report);
        report->page = d->page;
        report->panel_count = fig->panel_count;
    }

    // placed first, then drawn
    cairo_save(cr);
    d->context = text_context_create();
    code = layout_figure(d, f);
    if (code == STATUS_OK) {
        draw_all(d);
    }
    g_object_unref(d->context);
    g_free(d);
    cairo_restore(cr);

    // a stream that cannot be written is reported when it is closed
    cairo_status_t state = cairo_status(cr);
    if (code == STATUS_OK && state != CAIRO_STATUS_SUCCESS && state != CAIRO_STATUS_WRITE_ERROR) {
        code = fault_set(f, STATUS_NO_MEMORY, "a figure could not be drawn: %s",
                         cairo_status_to_string(state));
    }
    return code;
}
