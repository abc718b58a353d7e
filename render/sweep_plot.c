#include "render/sweep_plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/curve.h"
#include "render/palette.h"
#include "render/picture_file.h"
#include "render/text.h"
#include "render/ticks.h"
#include "src/lab/export.h"

#define MM           (72 / 25.4) // [pt]
#define PAGE_WIDTH   (150 * MM)
#define PAGE_HEIGHT  (100 * MM)
#define MARGIN       9.0 // [pt]
#define TITLE_SIZE   9.0
#define LABEL_SIZE   8.0
#define TICK_SIZE    7.0
#define TICK_LENGTH  3.0
#define BAR_WIDTH    11.0
#define BAR_DISTANCE 12.0

enum { MOST_MARKERS = 80, LABELLED_VALUES = 9, MARK_TEXT = 64 };

// --- axes -----------------------------------------------------------------------------------

typedef enum scale_kind { SCALE_LINEAR, SCALE_LOGARITHMIC, SCALE_WORDS } scale_kind;

typedef struct tick_mark {
    double at; // coordinate
    char text[MARK_TEXT];
} tick_mark;

// One axis of the picture. A coordinate is a value, its decimal logarithm, or the place of a word.
typedef struct scale {
    scale_kind kind;
    double low, high; // coordinates of its ends
    double *points;   // a grid's coordinates, ascending
    size_t *order;    // points[i] belongs to value order[i] of the sweep's axis
    size_t count;     // of points; 0 if the values were drawn
    tick_mark ticks[TICKS_MOST];
    int tick_count;
    char label[256]; // markup
} scale;

// A panel of the picture and what its sides stand for.
typedef struct canvas {
    cairo_t *cr;
    PangoContext *context;
    const palette *colours;
    figure_rect box; // inside the axes [pt]
    scale x, y;
} canvas;

static double coordinate(const scale *s, double value)
{
    return s->kind == SCALE_LOGARITHMIC ? log10(value) : value;
}

static void add_tick(scale *s, double at, const char *text)
{
    if (s->tick_count < TICKS_MOST) {
        s->ticks[s->tick_count].at = at;
        snprintf(s->ticks[s->tick_count++].text, MARK_TEXT, "%s", text);
    }
}

// A number with few digits as markup: a true minus sign, "2·10<sup>−5</sup>" for "2e-05".
static void number_label(double value, char text[MARK_TEXT])
{
    char digits[24];
    const char *sign = value < 0 ? "\u2212" : "";
    snprintf(digits, sizeof digits, "%.6g", fabs(value));
    char *exponent = strchr(digits, 'e');
    if (exponent == NULL) {
        snprintf(text, MARK_TEXT, "%s%s", sign, digits);
        return;
    }
    int power = atoi(exponent + 1);
    *exponent = '\0';
    bool one = strcmp(digits, "1") == 0;
    snprintf(text, MARK_TEXT, "%s%s%s10<sup>%s%d</sup>", sign, one ? "" : digits,
             one ? "" : "\u00b7", power < 0 ? "\u2212" : "", abs(power));
}

// Ticks at even steps. Returns the common factor of the labels as markup.
static void linear_ticks(scale *s, int wanted, char *factor, size_t size)
{
    ticks t;
    ticks_between(&t, s->low, s->high, wanted);
    for (int i = 0; i < t.count; i++) {
        char text[TICK_TEXT];
        tick_label(&t, i, text);
        add_tick(s, t.value[i], text);
    }
    tick_factor(&t, factor, size);
}

// Ticks at 1, 2, 5 times the powers of ten, or at the powers alone if there are many.
static void logarithmic_ticks(scale *s)
{
    static const int steps[] = {1, 2, 5};
    bool few = s->high - s->low < 3;
    for (int decade = (int)floor(s->low); decade <= (int)ceil(s->high); decade++) {
        for (int i = 0; i < (few ? 3 : 1); i++) {
            double value = steps[i] * pow(10, decade), at = log10(value);
            if (at >= s->low - 1e-9 && at <= s->high + 1e-9) {
                char text[MARK_TEXT];
                number_label(value, text);
                add_tick(s, at, text);
            }
        }
    }
}

// Ticks at the points themselves, for words and where a few values are spaced unevenly.
static void ticks_at_points(scale *s, const sweep_axis *axis)
{
    for (size_t i = 0; i < s->count; i++) {
        char text[MARK_TEXT] = "";
        if (s->kind == SCALE_WORDS) {
            parameters p = {0};
            parameter_set_number(&p, axis->parameter, axis->values[s->order[i]], NULL);
            parameter_format(&p, axis->parameter, text, sizeof text);
        } else {
            number_label(axis->values[s->order[i]], text);
        }
        add_tick(s, s->points[i], text);
    }
}

// Sorts the points of an axis; a sweep's axis is short or in order already.
static void sort_points(scale *s)
{
    for (size_t i = 1; i < s->count; i++) {
        double point = s->points[i];
        size_t order = s->order[i], j = i;
        for (; j > 0 && s->points[j - 1] > point; j--) {
            s->points[j] = s->points[j - 1];
            s->order[j] = s->order[j - 1];
        }
        s->points[j] = point;
        s->order[j] = order;
    }
}

// Sets points and their order. A falling range is turned round first: sorting it would be slow.
static bool take_points(scale *s, const sweep_axis *axis)
{
    s->points = malloc(axis->count * sizeof *s->points);
    s->order = malloc(axis->count * sizeof *s->order);
    if (s->points == NULL || s->order == NULL) {
        return false;
    }
    s->count = axis->count;
    bool falling = axis->is_range && axis->high < axis->low;
    for (size_t i = 0; i < s->count; i++) {
        s->order[i] = falling ? s->count - 1 - i : i;
        s->points[i] =
            s->kind == SCALE_WORDS ? (double)i : coordinate(s, axis->values[s->order[i]]);
    }
    sort_points(s);
    return true;
}

// The label of an axis: name, unit and the factor of its tick labels.
static void make_label(char *label, size_t size, const char *name, const char *unit,
                       const char *factor)
{
    char shown[64], *escaped = text_escape(name), *escaped_unit;
    text_unit(unit, shown, sizeof shown);
    escaped_unit = text_escape(shown);
    const char *space = factor[0] != '\0' && unit[0] != '\0' ? " " : "";
    if (factor[0] == '\0' && unit[0] == '\0') {
        snprintf(label, size, "%s", escaped);
    } else {
        snprintf(label, size, "%s (%s%s%s)", escaped, factor, space, escaped_unit);
    }
    g_free(escaped_unit);
    g_free(escaped);
}

// True for a few values that are spaced unevenly and have no long digits.
static bool points_are_good_ticks(const scale *s, const sweep_axis *axis)
{
    bool good =
        (axis->logarithmic || !axis->is_range) && s->count > 0 && s->count <= LABELLED_VALUES;
    for (size_t i = 0; i < s->count && good; i++) {
        char digits[32];
        snprintf(digits, sizeof digits, "%.3g", axis->values[i]);
        good = fabs(strtod(digits, NULL) - axis->values[i]) <= 1e-9 * fabs(axis->values[i]);
    }
    return good;
}

static bool scale_of_axis(scale *s, const sweep_axis *axis, int wanted)
{
    const parameter_info *info = &parameter_table[axis->parameter];
    bool words = info->type == PARAMETER_CHOICE || info->type == PARAMETER_BOOLEAN;
    char factor[64] = "";
    memset(s, 0, sizeof *s);
    s->kind = words ? SCALE_WORDS : axis->logarithmic ? SCALE_LOGARITHMIC : SCALE_LINEAR;
    if (axis->values != NULL && !take_points(s, axis)) {
        return false;
    }
    if (s->count > 0) {
        s->low = s->points[0];
        s->high = s->points[s->count - 1];
    } else {
        s->low = coordinate(s, fmin(axis->low, axis->high));
        s->high = coordinate(s, fmax(axis->low, axis->high));
    }
    if (s->low == s->high) {
        s->low -= 0.5;
        s->high += 0.5;
    }
    if (words || points_are_good_ticks(s, axis)) {
        ticks_at_points(s, axis);
    } else if (axis->logarithmic) {
        logarithmic_ticks(s);
    } else {
        linear_ticks(s, wanted, factor, sizeof factor);
    }
    make_label(s->label, sizeof s->label, info->path, info->unit, factor);
    return true;
}

// The axis of the quantity itself, from `low` to `high`.
static void scale_of_quantity(scale *s, const char *key, double low, double high, int wanted)
{
    char name[64], factor[64];
    const char *unit;
    memset(s, 0, sizeof *s);
    s->low = low;
    s->high = high;
    linear_ticks(s, wanted, factor, sizeof factor);
    quantity_name(key, name, sizeof name, &unit);
    for (char *c = name; *c != '\0'; c++) {
        *c = *c == '_' ? ' ' : *c;
    }
    make_label(s->label, sizeof s->label, name, unit, factor);
}

static void scale_finish(scale *s)
{
    free(s->points);
    free(s->order);
}

// Makes room at both ends of an axis, as a share of its length.
static void widen(scale *s, double share)
{
    double more = share * (s->high - s->low);
    s->low -= more;
    s->high += more;
}

static double page_x(const canvas *c, double at)
{
    return c->box.x + c->box.width * (at - c->x.low) / (c->x.high - c->x.low);
}

static double page_y(const canvas *c, double at)
{
    return c->box.y + c->box.height * (c->y.high - at) / (c->y.high - c->y.low);
}

// --- frame and text -------------------------------------------------------------------------

static void draw_text(canvas *c, double x, double y, const char *markup, double size,
                      double align_x, double align_y)
{
    text_block t = {.markup = markup, .size = size};
    double width, height;
    text_measure(c->context, &t, &width, &height);
    cairo_move_to(c->cr, x - align_x * width, y - align_y * height);
    text_draw(c->cr, c->context, &t);
}

// The same, turned to be read from the right, with the middle of its base at (x, y).
static void draw_upright(canvas *c, double x, double y, const char *markup, double size)
{
    cairo_save(c->cr);
    cairo_translate(c->cr, x, y);
    cairo_rotate(c->cr, -G_PI / 2);
    draw_text(c, 0, 0, markup, size, 0.5, 0);
    cairo_restore(c->cr);
}

// Width of the widest tick label.
static double widest_tick(canvas *c, const scale *s)
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

static void line(canvas *c, double x0, double y0, double x1, double y1)
{
    cairo_move_to(c->cr, x0, y0);
    cairo_line_to(c->cr, x1, y1);
    cairo_stroke(c->cr);
}

static void draw_grid(canvas *c)
{
    set_colour(c->cr, c->colours->grid);
    cairo_set_line_width(c->cr, 0.5);
    for (int i = 0; i < c->x.tick_count; i++) {
        double x = page_x(c, c->x.ticks[i].at);
        line(c, x, c->box.y, x, c->box.y + c->box.height);
    }
    for (int i = 0; i < c->y.tick_count; i++) {
        double y = page_y(c, c->y.ticks[i].at);
        line(c, c->box.x, y, c->box.x + c->box.width, y);
    }
}

// The box with its ticks outside, and what is written at them. A label that would touch the one
// before it is left out.
static void draw_axes(canvas *c)
{
    double bottom = c->box.y + c->box.height, taken = -(double)INFINITY, taken_y = (double)INFINITY;
    set_colour(c->cr, c->colours->axis);
    cairo_set_line_width(c->cr, 0.7);
    cairo_rectangle(c->cr, c->box.x, c->box.y, c->box.width, c->box.height);
    cairo_stroke(c->cr);
    for (int i = 0; i < c->x.tick_count; i++) {
        double x = page_x(c, c->x.ticks[i].at), width, height;
        text_block t = {.markup = c->x.ticks[i].text, .size = TICK_SIZE};
        set_colour(c->cr, c->colours->axis);
        line(c, x, bottom, x, bottom + TICK_LENGTH);
        text_measure(c->context, &t, &width, &height);
        if (x - width / 2 > taken + 3) {
            set_colour(c->cr, c->colours->text);
            draw_text(c, x, bottom + TICK_LENGTH + 1, t.markup, TICK_SIZE, 0.5, 0);
            taken = x + width / 2;
        }
    }
    for (int i = 0; i < c->y.tick_count; i++) {
        double y = page_y(c, c->y.ticks[i].at);
        set_colour(c->cr, c->colours->axis);
        line(c, c->box.x - TICK_LENGTH, y, c->box.x, y);
        if (y < taken_y - TICK_SIZE) {
            set_colour(c->cr, c->colours->text);
            draw_text(c, c->box.x - TICK_LENGTH - 2, y, c->y.ticks[i].text, TICK_SIZE, 1, 0.5);
            taken_y = y;
        }
    }
    set_colour(c->cr, c->colours->text);
    draw_text(c, c->box.x + c->box.width / 2, bottom + TICK_LENGTH + TICK_SIZE * 1.2 + 5,
              c->x.label, LABEL_SIZE, 0.5, 0);
    draw_upright(c, MARGIN, c->box.y + c->box.height / 2, c->y.label, LABEL_SIZE);
}

// What the picture shows, above it; below it what needs saying.
static void draw_title(canvas *c, const sweep_picture *p, const char *note)
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
        draw_text(c, PAGE_WIDTH - MARGIN, PAGE_HEIGHT - MARGIN, note, TICK_SIZE, 1, 0.7);
    }
}

// Sets the box between the margins; `right` is what stands at its right side, `note` tells if there
// is one below.
static void place_box(canvas *c, double right, bool note)
{
    double left = MARGIN + LABEL_SIZE * 1.5 + widest_tick(c, &c->y) + TICK_LENGTH + 3;
    double top = MARGIN + TITLE_SIZE * 1.3 + 6;
    double bottom = MARGIN + LABEL_SIZE * 1.3 + 5 + TICK_SIZE * 1.2 + TICK_LENGTH +
                    (note ? TICK_SIZE * 1.5 : 0);
    c->box =
        (figure_rect){left, top, PAGE_WIDTH - left - right - MARGIN, PAGE_HEIGHT - top - bottom};
}

// --- one parameter --------------------------------------------------------------------------

// Smallest and largest finite value; false if there is none.
static bool value_range(const double *values, size_t count, double *low, double *high)
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

// Number of values that are not there, said in a few words.
static void missing_note(const sweep_picture *p, char *note, size_t size, const char *how)
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

static void dot(canvas *c, double x, double y, double radius)
{
    cairo_new_sub_path(c->cr);
    cairo_arc(c->cr, x, y, radius, 0, 2 * G_PI);
}

// The curve through `count` points (x, y), in coordinates.
static void draw_curve(canvas *c, const double *x, const double *y, size_t count, bool with_line,
                       figure_theme theme)
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
            dot(c, page_x(c, x[i]), page_y(c, y[i]), radius);
        }
    }
    cairo_fill(c->cr);
}

// Coordinates of the runs along an axis, and the quantity, in the order of the axis.
static void gather(const sweep_picture *p, const scale *s, double *x, double *y)
{
    for (size_t i = 0; i < p->sweep->run_count; i++) {
        size_t run = s->count > 0 && p->sweep->drawn == NULL ? s->order[i] : i;
        y[i] = p->values[run];
        x[i] = s->count > 0 && p->sweep->drawn == NULL
                   ? s->points[i]
                   : coordinate(s, sweep_value(p->sweep, run, 0));
    }
}

static void no_value_text(canvas *c)
{
    set_colour(c->cr, c->colours->faint_text);
    draw_text(c, c->box.x + c->box.width / 2, c->box.y + c->box.height / 2,
              "the quantity did not occur in any run", LABEL_SIZE, 0.5, 0.5);
}

static status paint_line(canvas *c, const sweep_picture *p, fault *f)
{
    const sweep *s = p->sweep;
    double low, high, *x = malloc(2 * s->run_count * sizeof *x);
    char note[128];
    if (x == NULL || !scale_of_axis(&c->x, &s->axes[0], 8)) {
        free(x);
        return fault_set(f, STATUS_NO_MEMORY, "%s", status_text(STATUS_NO_MEMORY));
    }
    bool any = value_range(p->values, s->run_count, &low, &high);
    low = any ? low : 0;
    high = any ? high : 1;
    double room = high > low ? 0.05 * (high - low) : fmax(0.1 * fabs(high), 1e-12);
    scale_of_quantity(&c->y, p->key, low - room, high + room, 6);
    if (c->x.kind == SCALE_WORDS) {
        c->x.low = -0.5;
        c->x.high = (double)c->x.count - 0.5;
    } else {
        widen(&c->x, 0.02);
    }
    missing_note(p, note, sizeof note, "");
    place_box(c, 0, note[0] != '\0');
    draw_grid(c);
    gather(p, &c->x, x, x + s->run_count);
    cairo_save(c->cr);
    cairo_rectangle(c->cr, c->box.x, c->box.y, c->box.width, c->box.height);
    cairo_clip(c->cr);
    bool with_line = s->sampling == SWEEP_GRID && c->x.kind != SCALE_WORDS;
    draw_curve(c, x, x + s->run_count, s->run_count, with_line, p->theme);
    cairo_restore(c->cr);
    draw_axes(c);
    draw_title(c, p, note);
    if (!any) {
        no_value_text(c);
    }
    free(x);
    return STATUS_OK;
}

// --- two parameters -------------------------------------------------------------------------

void sweep_plot_colour(double share, double rgb[3])
{
    static const unsigned char points[][3] = {
        {0x44, 0x01, 0x54}, {0x47, 0x2d, 0x7b}, {0x3b, 0x52, 0x8b},
        {0x2c, 0x72, 0x8e}, {0x21, 0x91, 0x8c}, {0x28, 0xae, 0x80},
        {0x5e, 0xc9, 0x62}, {0xad, 0xdc, 0x30}, {0xfd, 0xe7, 0x25},
    };
    enum { LAST = sizeof points / sizeof points[0] - 1 };
    double at = fmin(fmax(share, 0), 1) * LAST;
    int i = at >= LAST ? LAST - 1 : (int)at;
    for (int k = 0; k < 3; k++) {
        rgb[k] = (points[i][k] + (at - i) * (points[i + 1][k] - points[i][k])) / 255;
    }
}

int contour_square(const double z[4], double level, contour_piece pieces[2])
{
    // corners in the order of going round, and the crossing of the side that begins at each
    static const int corner[4] = {0, 1, 3, 2};
    static const double corner_x[4] = {0, 1, 1, 0}, corner_y[4] = {0, 0, 1, 1};
    double cross_x[4] = {0}, cross_y[4] = {0};
    int side[4], count = 0;
    for (int i = 0; i < 4; i++) {
        if (!isfinite(z[i])) {
            return 0;
        }
    }
    for (int i = 0; i < 4; i++) {
        int j = (i + 1) % 4;
        double a = z[corner[i]], b = z[corner[j]];
        if ((a >= level) != (b >= level)) {
            double share = (level - a) / (b - a);
            cross_x[i] = corner_x[i] + share * (corner_x[j] - corner_x[i]);
            cross_y[i] = corner_y[i] + share * (corner_y[j] - corner_y[i]);
            side[count++] = i;
        }
    }
    // four crossings: the pieces cut off the corners that differ from the middle
    bool middle = (z[0] + z[1] + z[2] + z[3]) / 4 >= level;
    int first = count == 4 && (z[0] >= level) != middle ? 3 : 0;
    for (int i = 0; i < count / 2; i++) {
        int from = side[(first + 2 * i) % count], to = side[(first + 2 * i + 1) % count];
        pieces[i] = (contour_piece){cross_x[from], cross_y[from], cross_x[to], cross_y[to]};
    }
    return count / 2;
}

// The picture's share of the colour scale for a value.
static void use_value_colour(canvas *c, const scale *bar, double value)
{
    double rgb[3];
    sweep_plot_colour((value - bar->low) / (bar->high - bar->low), rgb);
    cairo_set_source_rgb(c->cr, rgb[0], rgb[1], rgb[2]);
}

// The border between points i - 1 and i of an axis; i = 0 and i = count are its outer ends.
static double cell_edge(const scale *s, size_t i)
{
    if (s->count == 1) {
        return i == 0 ? s->points[0] - 0.5 : s->points[0] + 0.5;
    }
    if (i == 0) {
        return s->points[0] - 0.5 * (s->points[1] - s->points[0]);
    }
    if (i == s->count) {
        return s->points[i - 1] + 0.5 * (s->points[i - 1] - s->points[i - 2]);
    }
    return 0.5 * (s->points[i - 1] + s->points[i]);
}

// The quantity at point (i, j) of the picture.
static double value_at(const canvas *c, const sweep_picture *p, size_t i, size_t j)
{
    return p->values[c->x.order[i] * p->sweep->axes[1].count + c->y.order[j]];
}

// Grey with hatching: a run without a value.
static void fill_missing(canvas *c, const figure_rect *r)
{
    cairo_save(c->cr);
    cairo_rectangle(c->cr, r->x, r->y, r->width, r->height);
    cairo_clip_preserve(c->cr);
    set_colour(c->cr, c->colours->grid);
    cairo_fill(c->cr);
    cairo_set_antialias(c->cr, CAIRO_ANTIALIAS_DEFAULT);
    set_colour(c->cr, c->colours->mark);
    cairo_set_line_width(c->cr, 0.4);
    // lines at fixed places of the page, so that they run on from cell to cell
    double from = floor((r->x + r->y) / 4) * 4, to = r->x + r->width + r->y + r->height;
    for (double sum = from; sum <= to; sum += 4) {
        line(c, sum - r->y, r->y, sum - r->y - r->height, r->y + r->height);
    }
    cairo_restore(c->cr);
}

static void draw_cells(canvas *c, const sweep_picture *p, const scale *bar)
{
    // neighbours would show a hairline between them if edges were smoothed, or if a viewer smooths
    // them: every cell reaches a little under its later neighbours
    const double overlap = 0.4;
    cairo_set_antialias(c->cr, CAIRO_ANTIALIAS_NONE);
    for (size_t i = 0; i < c->x.count; i++) {
        double left = page_x(c, cell_edge(&c->x, i)), right = page_x(c, cell_edge(&c->x, i + 1));
        for (size_t j = 0; j < c->y.count; j++) {
            double top = page_y(c, cell_edge(&c->y, j + 1)) - overlap;
            double bottom = page_y(c, cell_edge(&c->y, j));
            figure_rect r = {left, top, right - left + overlap, bottom - top};
            double value = value_at(c, p, i, j);
            if (isfinite(value)) {
                use_value_colour(c, bar, value);
                cairo_rectangle(c->cr, r.x, r.y, r.width, r.height);
                cairo_fill(c->cr);
            } else {
                fill_missing(c, &r);
            }
        }
    }
    cairo_set_antialias(c->cr, CAIRO_ANTIALIAS_DEFAULT);
}

// White on the dark half of the colour scale, black on the bright one.
static void use_contour_colour(canvas *c, const scale *bar, double level)
{
    bool dark = level < bar->low + 0.55 * (bar->high - bar->low);
    cairo_set_source_rgba(c->cr, dark, dark, dark, 0.85);
    set_line_style(c->cr, LINE_SOLID, 0.7);
}

static void draw_contour(canvas *c, const sweep_picture *p, double level)
{
    for (size_t i = 0; i + 1 < c->x.count; i++) {
        for (size_t j = 0; j + 1 < c->y.count; j++) {
            contour_piece pieces[2];
            const double z[4] = {value_at(c, p, i, j), value_at(c, p, i + 1, j),
                                 value_at(c, p, i, j + 1), value_at(c, p, i + 1, j + 1)};
            double x0 = page_x(c, c->x.points[i]), x1 = page_x(c, c->x.points[i + 1]);
            double y0 = page_y(c, c->y.points[j]), y1 = page_y(c, c->y.points[j + 1]);
            int count = contour_square(z, level, pieces);
            for (int k = 0; k < count; k++) {
                const contour_piece *q = &pieces[k];
                cairo_move_to(c->cr, x0 + q->x0 * (x1 - x0), y0 + q->y0 * (y1 - y0));
                cairo_line_to(c->cr, x0 + q->x1 * (x1 - x0), y0 + q->y1 * (y1 - y0));
            }
        }
    }
    cairo_stroke(c->cr);
}

// Coloured dots for values that were drawn at random.
static void draw_dots(canvas *c, const sweep_picture *p, const scale *bar)
{
    double radius = p->sweep->run_count > 1000 ? 1.5 : p->sweep->run_count > 200 ? 2.2 : 3.2;
    for (size_t run = 0; run < p->sweep->run_count; run++) {
        double x = coordinate(&c->x, sweep_value(p->sweep, run, 0));
        double y = coordinate(&c->y, sweep_value(p->sweep, run, 1));
        dot(c, page_x(c, x), page_y(c, y), radius);
        if (isfinite(p->values[run])) {
            use_value_colour(c, bar, p->values[run]);
            cairo_fill_preserve(c->cr);
        }
        set_colour(c->cr, c->colours->axis);
        cairo_set_line_width(c->cr, 0.3);
        cairo_stroke(c->cr);
    }
}

// The colour bar at the right of the box, with the levels of the contour lines.
static void draw_bar(canvas *c, const scale *bar, bool contours)
{
    enum { STRIPES = 256 };
    double x = c->box.x + c->box.width + BAR_DISTANCE, height = c->box.height;
    cairo_set_antialias(c->cr, CAIRO_ANTIALIAS_NONE);
    for (int i = 0; i < STRIPES; i++) {
        // each stripe reaches to the top, so that no gap is left between them
        double share = (i + 0.5) / STRIPES, bottom = c->box.y + height * (1 - (double)i / STRIPES);
        use_value_colour(c, bar, bar->low + share * (bar->high - bar->low));
        cairo_rectangle(c->cr, x, c->box.y, BAR_WIDTH, bottom - c->box.y);
        cairo_fill(c->cr);
    }
    cairo_set_antialias(c->cr, CAIRO_ANTIALIAS_DEFAULT);
    for (int i = 0; i < bar->tick_count; i++) {
        double level = bar->ticks[i].at;
        double y = c->box.y + height * (bar->high - level) / (bar->high - bar->low);
        if (contours) {
            use_contour_colour(c, bar, level);
            line(c, x, y, x + BAR_WIDTH, y);
        }
        set_colour(c->cr, c->colours->axis);
        cairo_set_line_width(c->cr, 0.7);
        line(c, x + BAR_WIDTH, y, x + BAR_WIDTH + TICK_LENGTH, y);
        set_colour(c->cr, c->colours->text);
        draw_text(c, x + BAR_WIDTH + TICK_LENGTH + 2, y, bar->ticks[i].text, TICK_SIZE, 0, 0.5);
    }
    set_colour(c->cr, c->colours->axis);
    cairo_rectangle(c->cr, x, c->box.y, BAR_WIDTH, height);
    cairo_stroke(c->cr);
    set_colour(c->cr, c->colours->text);
    draw_upright(c, PAGE_WIDTH - MARGIN - LABEL_SIZE * 1.3, c->box.y + height / 2, bar->label,
                 LABEL_SIZE);
}

static void draw_map(canvas *c, const sweep_picture *p, const scale *bar, bool grid, bool contours)
{
    cairo_save(c->cr);
    cairo_rectangle(c->cr, c->box.x, c->box.y, c->box.width, c->box.height);
    cairo_clip(c->cr);
    if (grid) {
        draw_cells(c, p, bar);
    } else {
        draw_grid(c);
        draw_dots(c, p, bar);
    }
    for (int i = 0; contours && i < bar->tick_count; i++) {
        use_contour_colour(c, bar, bar->ticks[i].at);
        draw_contour(c, p, bar->ticks[i].at);
    }
    cairo_restore(c->cr);
}

static status paint_map(canvas *c, const sweep_picture *p, fault *f)
{
    const sweep *s = p->sweep;
    double low, high;
    char note[128];
    scale bar;
    if (!scale_of_axis(&c->x, &s->axes[0], 8) || !scale_of_axis(&c->y, &s->axes[1], 7)) {
        return fault_set(f, STATUS_NO_MEMORY, "%s", status_text(STATUS_NO_MEMORY));
    }
    bool any = value_range(p->values, s->run_count, &low, &high);
    low = any ? low : 0;
    high = any ? high : 1;
    if (!(high > low)) {
        double room = fmax(0.1 * fabs(high), 1e-12);
        low -= room;
        high += room;
    }
    scale_of_quantity(&bar, p->key, low, high, 7);
    bool grid = s->sampling == SWEEP_GRID;
    bool contours = grid && any && c->x.kind != SCALE_WORDS && c->y.kind != SCALE_WORDS;
    if (grid) {
        c->x.low = cell_edge(&c->x, 0);
        c->x.high = cell_edge(&c->x, c->x.count);
        c->y.low = cell_edge(&c->y, 0);
        c->y.high = cell_edge(&c->y, c->y.count);
    } else {
        widen(&c->x, 0.03);
        widen(&c->y, 0.03);
    }
    missing_note(p, note, sizeof note, grid ? " (hatched)" : " (empty)");
    place_box(c,
              BAR_DISTANCE + BAR_WIDTH + TICK_LENGTH + 4 + widest_tick(c, &bar) + LABEL_SIZE * 1.5,
              note[0] != '\0');
    draw_map(c, p, &bar, grid, contours);
    draw_axes(c);
    draw_bar(c, &bar, contours);
    draw_title(c, p, note);
    if (!any) {
        no_value_text(c);
    }
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
    canvas c = {.cr = cr, .context = text_context_create(), .colours = palette_of(p->theme)};
    set_colour(cr, c.colours->page);
    cairo_paint(cr);
    code = p->sweep->axis_count == 1 ? paint_line(&c, p, f) : paint_map(&c, p, f);
    scale_finish(&c.x);
    scale_finish(&c.y);
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
