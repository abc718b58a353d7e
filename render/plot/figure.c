// A figure: its look and size, its layers painted from the lowest to the uppermost, and
// its files.
#include <assert.h>
#include <math.h>
#include <string.h>

#include "render/page/picture_file.h"
#include "render/plot/drawing.h"

#define PANEL_HEIGHT 34.0 // of a panel of weight 1 on a page without a height [mm]
#define SIDES        52.0 // approximate width of the labels next to the panels [pt]
#define X_AXIS_SPACE 24.0 // below the panels, for the labels of the horizontal axis [pt]

// What a figure owns, with the function that ends it.
typedef struct kept_thing {
    void *thing;
    GDestroyNotify end;
} kept_thing;

static void end_thing(gpointer kept)
{
    const kept_thing *k = kept;
    k->end(k->thing);
}

// Panels point to series of the same block, texts go to what it keeps.
owned_figure *owned_figure_create(int panels, const char *format, ...)
{
    owned_figure *o = g_new0(owned_figure, 1);
    o->kept = g_array_new(FALSE, FALSE, sizeof(kept_thing));
    g_array_set_clear_func(o->kept, end_thing);

    va_list list;
    va_start(list, format);
    char *title = owned_figure_keep(o, text_vprintf(format, list));
    va_end(list);
    o->figure = (figure){.title = title, .panels = o->panels, .panel_count = panels};
    for (int i = 0; i < FIGURE_PANELS; i++) {
        o->panels[i].series = o->series[i];
    }
    return o;
}

void owned_figure_destroy(void *owned)
{
    owned_figure *o = owned;
    if (o != NULL) {
        g_array_free(o->kept, TRUE);
        g_free(o);
    }
}

figure_series *owned_figure_add(owned_figure *o, int panel, figure_series s)
{
    assert(o->panels[panel].series_count < PANEL_SERIES);
    figure_series *added = &o->series[panel][o->panels[panel].series_count++];
    *added = s;
    return added;
}

void *owned_figure_own(owned_figure *o, void *thing, GDestroyNotify end)
{
    const kept_thing kept = {thing, end};
    g_array_append_val(o->kept, kept);
    return thing;
}

void *owned_figure_keep(owned_figure *o, void *block)
{
    return owned_figure_own(o, block, g_free);
}

double *owned_figure_numbers(owned_figure *o, size_t count)
{
    return owned_figure_keep(o, g_new(double, count + 1));
}

const char *owned_figure_printf(owned_figure *o, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    char *text = text_vprintf(format, list);
    va_end(list);
    return owned_figure_keep(o, text);
}

// What the look leaves open stays as the figure has it.
void figure_take_look(figure *fig, const page_look *look)
{
    // the size; another width has the height that the panels need
    if (look->width > 0) {
        fig->width = look->width;
        fig->height = 0;
    }
    if (look->height > 0) {
        fig->height = look->height;
    }

    // colours and letters
    fig->theme = look->theme;
    if (look->dpi > 0) {
        fig->dpi = look->dpi;
    }
    if (look->font != NULL) {
        fig->font = look->font;
    }
    if (look->letters > 0) {
        fig->letters = look->letters;
    }
    fig->bare = fig->bare || look->bare;
    fig->transparent = fig->transparent || look->transparent;
}

// Height of a wrapped text above or below the panels, with its distance from them [pt].
static double wrapped_height(const figure *fig, const char *markup, double size,
                             bool bold)
{
    const double page = figure_width(fig) * POINTS_PER_MM;
    double width = page - SIDES;
    if (page < NARROW_PAGE) {
        width = page - 2 * PAGE_MARGIN;
    }

    g_autoptr(PangoContext) context = text_context_create();
    text_block t = {.markup = markup,
                    .size = page_letters(fig->letters, size),
                    .family = fig->font,
                    .bold = bold,
                    .balanced = bold,
                    .width = width};
    return text_measure(context, &t).height + 4;
}

// The height is estimated where none is given: panels by weight, and the texts round
// them.
void figure_size(const figure *fig, double *width, double *height)
{
    // a page that is half as wide has panels that are a fifth lower: 0.5^0.32 = 0.8
    const double share = fmin(1, figure_width(fig) / DEFAULT_WIDTH);
    const double panel = PANEL_HEIGHT * pow(share, 0.32) * POINTS_PER_MM;
    const int columns = figure_columns(fig);
    double points = 0;

    // rows of panels
    for (int i = 0; i < fig->panel_count; i += columns) {
        const figure_panel *p = &fig->panels[i];
        double high = panel_weight(p) * panel;
        if (fig->equal_axes) {
            high = fmin(high, figure_width(fig) * POINTS_PER_MM - SIDES);
        }
        points += high + PANEL_SPACE;
        if (p->impulse_count > 0) {
            points += STRIP_HEIGHT + STRIP_SPACE;
        }
        if (p->heading != NULL) {
            points += HEADING_ROW;
        }
        if (p->key_above) {
            points += LEGEND_ROW;
        }
    }

    // the axis below, title and caption
    points += 2 * PAGE_MARGIN + X_AXIS_SPACE;
    if (fig->title != NULL && !fig->bare) {
        g_autofree char *title = text_escape(fig->title);
        points += wrapped_height(fig, title, TITLE_LETTERS, true);
    }
    if (fig->caption != NULL && !fig->bare) {
        points += wrapped_height(fig, fig->caption, SMALL_LETTERS, false);
    }

    if (fig->scene != NULL) {
        points += fig->scene->height;
    }

    *width = figure_width(fig) * POINTS_PER_MM;
    if (fig->height > 0) {
        *height = fig->height * POINTS_PER_MM;
    } else {
        *height = points;
    }
}

// ---- the whole

// What is painted across the page above the panels.
static void draw_scene(const drawing *d)
{
    const figure_scene *s = d->fig->scene;
    if (s == NULL) {
        return;
    }
    const double width = d->page.width - 2 * PAGE_MARGIN;
    cairo_save(d->cr);
    cairo_translate(d->cr, PAGE_MARGIN, d->scene_y);
    cairo_rectangle(d->cr, 0, 0, width, s->height);
    cairo_clip(d->cr);
    s->paint(d->cr, s->of, width, s->height, d->fig->theme);
    cairo_restore(d->cr);
}

// The heading above a panel, and the remark in its middle.
static void draw_panel_texts(drawing *d, const panel_layout *l)
{
    const figure_rect *box = &l->plane.box;
    if (l->panel->heading != NULL) {
        draw_markup(d, l->panel->heading, d->style.label, box->x + box->width / 2,
                    box->y - 2, (anchor){0.5, 1});
    }
    if (l->panel->remark != NULL) {
        draw_text(d, figure_text_of(d, l->panel->remark, d->style.label),
                  box->x + box->width / 2, box->y + box->height / 2, (anchor){0.5, 0.5},
                  d->style.colours->faint_text);
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
    draw_panel_map(d, l);
    draw_panel_levels(d, l);
    draw_series(d, l, &l->plane);

    // axes and texts
    draw_axes(d, &l->plane, &d->x, &l->y, look);
    draw_y_title(d, l);
    draw_panel_texts(d, l);
    draw_colour_bar(d, l);

    // what stands in the panel
    draw_notes(d, l);
    draw_inset(d, l);
    draw_panel_legend(d, l);

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

// Background, marks, texts of the page, then each panel.
static void draw_all(drawing *d)
{
    const figure *fig = d->fig;
    if (!fig->transparent) {
        fill_box(d->cr, &d->page, d->style.colours->page);
    }

    // behind the data
    for (int i = 0; i < fig->panel_count; i++) {
        draw_intervals(d, &d->panels[i].plane);
        draw_grid(d, &d->panels[i].plane, &d->x, &d->panels[i].y);
    }

    draw_marks(d);

    // texts of the whole, then the panels
    double left;
    const text_block title = frame_title(d, &left), caption = frame_caption(d, &left);
    if (title.markup != NULL) {
        draw_text(d, title, left, d->title_y, (anchor){0, 0}, d->style.colours->text);
    }
    if (caption.markup != NULL) {
        draw_text(d, caption, left, d->caption_y, (anchor){0, 0},
                  d->style.colours->faint_text);
    }
    g_free((char *)title.markup);

    draw_scene(d);

    // the horizontal axis once, below all columns
    const double middle = (d->column[0].left + d->column[d->columns - 1].right) / 2;
    const double half = fmin(middle, d->page.width - middle) - PAGE_MARGIN;
    g_autofree char *x_title = fitting_title(d, &d->x, 2 * half);
    if (fig->x.label != NULL) {
        draw_markup(d, x_title, d->style.label, middle, d->x_label_y, (anchor){0.5, 0});
    }
    common_legend(d, true);
    for (int i = 0; i < fig->panel_count; i++) {
        draw_panel(d, i);
    }
    draw_points(d);
    draw_measure(d);
}

// Numbers of panels and series that there is room for.
static status check_description(const figure *fig, fault *f)
{
    FAULT_IF(fig->panel_count < 1 || fig->panel_count > FIGURE_PANELS, f,
             STATUS_BAD_ARGUMENT, "a figure has %d panels, expected 1 to %d",
             fig->panel_count, FIGURE_PANELS);

    for (int i = 0; i < fig->panel_count; i++) {
        FAULT_IF(fig->panels[i].series_count < 0 ||
                     fig->panels[i].series_count > PANEL_SERIES,
                 f, STATUS_BAD_ARGUMENT,
                 "panel %d of a figure has %d series, expected at most %d", i + 1,
                 fig->panels[i].series_count, PANEL_SERIES);
    }
    return STATUS_OK;
}

// Lays out, then draws.
status figure_paint(cairo_t *cr, const figure *fig, figure_report *report, fault *f)
{
    TRY(check_description(fig, f));
    TRY(text_check_font(f));

    // too large for a thread's stack
    drawing *d = g_new0(drawing, 1);
    d->cr = cr;
    d->fig = fig;
    d->style = (plot_style){.theme = fig->theme,
                            .colours = palette_of(fig->theme),
                            .font = text_or(fig->font, TEXT_FAMILY),
                            .title = page_letters(fig->letters, TITLE_LETTERS),
                            .label = page_letters(fig->letters, LETTERS_NORMAL),
                            .tick = page_letters(fig->letters, TICK_LETTERS),
                            .small = page_letters(fig->letters, SMALL_LETTERS)};
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
    const status code = layout_figure(d, f);
    if (code == STATUS_OK) {
        draw_all(d);
    }
    g_object_unref(d->context);
    g_free(d);
    cairo_restore(cr);
    return code;
}

// ==== files

static status paint_figure(cairo_t *cr, const void *what, fault *f)
{
    return figure_paint(cr, what, NULL, f);
}

status figure_write(const figure *fig, const char *path, fault *f)
{
    picture p = {fig->title,
                 .dpi = fig->dpi,
                 .software = picture_software(),
                 .parameters = fig->parameters,
                 .paint = paint_figure,
                 .what = fig};
    figure_size(fig, &p.width, &p.height);
    return picture_write(&p, path, f);
}

// A table in long form.
typedef struct long_form {
    csv_writer *csv;
    bool shaded; // with a last column for the colour scale
    bool alike;  // all panels show one quantity: their headings tell them apart
} long_form;

// A name, or without one the label without markup, with its unit.
static void write_name(long_form *t, const char *name, const char *label,
                       const char *unit)
{
    g_autofree char *plain = NULL;
    if (name != NULL) {
        plain = g_strdup(name);
    } else {
        plain = text_plain(text_or(label, ""));
    }
    if (unit != NULL && unit[0] == '\0') {
        unit = NULL;
    }
    csv_heading(t->csv, plain, unit);
}

static void write_panel_name(long_form *t, const figure_panel *panel)
{
    if (t->alike && panel->heading != NULL) {
        write_name(t, NULL, panel->heading, NULL);
    } else {
        write_name(t, panel->y.name, panel->y.label, panel->y.unit);
    }
}

// A number; what is not finite leaves the field empty.
static void write_finite(long_form *t, double value)
{
    if (isinf(value)) {
        value = (double)NAN;
    }
    csv_number(t->csv, value);
}

// The end of a row; `shade` is the value on the colour scale, where the figure has one.
static void write_point(long_form *t, double x, double y, double shade)
{
    csv_number(t->csv, x);
    write_finite(t, y);
    if (t->shaded) {
        write_finite(t, shade);
    }
    csv_end_row(t->csv);
}

// All that a panel shows of its own.
static void write_panel(long_form *t, const figure_panel *panel)
{
    // curves; a point without an x has no place
    for (int k = 0; k < panel->series_count; k++) {
        const figure_series *s = &panel->series[k];
        for (size_t i = 0; i < s->count && !ferror(t->csv->stream); i++) {
            if (!isfinite(series_x(s, i))) {
                continue;
            }
            write_panel_name(t, panel);
            write_name(t, s->name, s->label, NULL);
            write_point(t, series_x(s, i), series_y(s, i), series_shade(s, i));
        }
    }

    // cells of a map, and impulses
    const figure_map *map = panel->map;
    for (size_t i = 0; map != NULL && i < map->columns && !ferror(t->csv->stream); i++) {
        for (size_t j = 0; j < map->rows; j++) {
            write_panel_name(t, panel);
            csv_text(t->csv, "map");
            write_point(t, map->x[i], map->y[j], map->z[i * map->rows + j]);
        }
    }
    for (int i = 0; i < panel->impulse_count; i++) {
        write_panel_name(t, panel);
        const char *of = panel->impulses[i].of;
        g_autofree char *name = g_strconcat("impulse", of == NULL ? "" : " ", of, NULL);
        write_name(t, name, NULL, panel->impulse_unit);
        write_point(t, panel->impulses[i].x, panel->impulses[i].size, (double)NAN);
    }

    // levels go by their label alone, and have no x of their own
    for (int i = 0; i < panel->level_count; i++) {
        write_panel_name(t, panel);
        write_name(t, NULL, text_or(panel->levels[i].label, "level"), NULL);
        write_point(t, (double)NAN, panel->levels[i].y, (double)NAN);
    }
}

// A row that has an x alone.
static void write_instant(long_form *t, const char *panel, const char *series, double x)
{
    csv_text(t->csv, panel);
    csv_text(t->csv, series);
    write_point(t, x, (double)NAN, (double)NAN);
}

// Marks and shaded intervals as rows of their own.
static void write_marks(long_form *t, const figure *fig)
{
    for (int i = 0; i < fig->mark_count; i++) {
        g_autofree char *label = text_plain(text_or(fig->marks[i].label, ""));
        write_instant(t, "mark", label, fig->marks[i].x);
    }
    for (int i = 0; i < fig->interval_count; i++) {
        write_instant(t, "interval", "begins", fig->intervals[i].from);
        write_instant(t, "interval", "ends", fig->intervals[i].to);
    }
}

// Whether all panels show one quantity, so that their column can bear its name and unit.
static bool panels_are_alike(const figure *fig)
{
    bool alike = fig->panels[0].impulse_count == 0;
    for (int i = 1; i < fig->panel_count; i++) {
        const figure_axis *a = &fig->panels[i].y, *first = &fig->panels[0].y;
        alike = alike && fig->panels[i].impulse_count == 0 && a->name != NULL &&
                first->name != NULL && strcmp(a->name, first->name) == 0 &&
                g_strcmp0(a->unit, first->unit) == 0;
    }
    return alike;
}

static void write_axis_heading(long_form *t, const figure_axis *a, const char *otherwise)
{
    const char *name = a->name;
    if (name == NULL && a->label == NULL) {
        name = otherwise;
    }
    write_name(t, name, a->label, a->unit);
}

// The heading, then all panels below each other.
void figure_write_csv(const figure *fig, csv_writer *csv)
{
    // the heading: panel, series, and both axes
    long_form t = {csv};
    csv_heading(csv, "panel", NULL);
    csv_heading(csv, "series", NULL);
    write_axis_heading(&t, &fig->x, "x");
    t.alike = panels_are_alike(fig);
    if (t.alike) {
        write_axis_heading(&t, &fig->panels[0].y, "y");
    } else {
        csv_heading(csv, "value", NULL);
    }
    for (int p = 0; p < fig->panel_count; p++) {
        const figure_colours *colours = fig->panels[p].colours;
        if (colours != NULL) {
            write_axis_heading(&t, &colours->axis, "z");
            t.shaded = true;
            break;
        }
    }
    csv_end_row(csv);

    // panel by panel, then what all share
    for (int p = 0; p < fig->panel_count; p++) {
        write_panel(&t, &fig->panels[p]);
    }
    write_marks(&t, fig);
}
