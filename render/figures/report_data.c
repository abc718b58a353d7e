// What a page draws a figure from: its curves, marks and impulses as JSON, and the
// colours of its SVG on a dark page.
#include "render/figures/report_data.h"

#include <jansson.h>
#include <math.h>

#include "render/plot/axis.h"
#include "render/plot/run_style.h"
#include "src/base/json.h"

// A member of plain text.
static json_t *plain_json(const char *markup)
{
    g_autofree char *plain = text_plain(text_or(markup, ""));
    return json_text(plain);
}

// A member of a name with blanks in the place of underscores.
static json_t *words_json(const char *name)
{
    g_autofree char *words = g_strdelimit(g_strdup(text_or(name, "")), "_", ' ');
    return plain_json(words);
}

// Values as base64 of little-endian numbers of 32 bits; what an axis cannot show is NaN.
static json_t *packed_json(const figure_series *s,
                           double (*value)(const figure_series *, size_t))
{
    g_autofree float *values = g_new(float, s->count + 1);
    for (size_t i = 0; i < s->count; i++) {
        values[i] = (float)value(s, i);
    }
    g_autofree char *text =
        g_base64_encode((const guchar *)values, s->count * sizeof values[0]);
    return json_text(text);
}

// A colour as three bytes.
static json_t *bytes_json(colour c)
{
    const double bytes[] = {round(255 * c.red), round(255 * c.green),
                            round(255 * c.blue)};
    return json_numbers(bytes, 3);
}

// The colour of a series, as three bytes.
static json_t *ink_json(const figure_series *s, figure_theme theme, int place)
{
    colour c = palette_series(theme, s->colour, place);
    if (s->run == RUN_BEHIND) {
        c = palette_of(theme)->mark;
    } else if (s->run > 0) {
        c = run_colour(theme, s->run);
    }
    return bytes_json(c);
}

// The line style of a series as the figure has it.
static line_style style_of_series(const figure_panel *panel, int index)
{
    const int run = panel->series[index].run;
    if (run == RUN_BEHIND) {
        return LINE_SOLID;
    }
    if (run > 0) {
        return run_style_of(run).dash;
    }
    return untaken_style(panel->series, index);
}

// True if both have the same numbers on the horizontal axis.
static bool same_times(const figure_series *a, const figure_series *b)
{
    bool same = a->count == b->count;
    for (size_t i = 0; same && i < a->count; i++) {
        same = series_x(a, i) == series_x(b, i);
    }
    return same;
}

// Name, look and values of the series of a panel. Without `x` a series has that of the
// one before it.
static json_t *series_json(const figure_panel *panel)
{
    json_t *all = json_array();
    for (int i = 0; i < panel->series_count; i++) {
        const figure_series *s = &panel->series[i];
        json_t *one =
            json_of("label:o light:o dark:o style:i line:b points:b y:o",
                    words_json(text_or(s->label, s->name)), ink_json(s, THEME_COLOUR, i),
                    ink_json(s, THEME_DARK, i), (int)style_of_series(panel, i),
                    !s->no_line, s->marker != MARKER_NONE, packed_json(s, series_y));
        if (i == 0 || !same_times(s, s - 1)) {
            json_members(one, "x:o", packed_json(s, series_x));
        }
        json_add(all, one);
    }
    return all;
}

// Impulses of a panel, in the colours of their runs.
static json_t *impulses_json(const figure_panel *panel)
{
    json_t *all = json_array();
    for (int i = 0; i < panel->impulse_count; i++) {
        const figure_impulse *one = &panel->impulses[i];
        json_add(all, json_of("x:n size:n light:o dark:o", one->x, one->size,
                              bytes_json(impulse_colour(THEME_COLOUR, one->run)),
                              bytes_json(impulse_colour(THEME_DARK, one->run))));
    }
    return all;
}

// Horizontal lines of a panel.
static json_t *levels_json(const figure_panel *panel)
{
    json_t *all = json_array();
    for (int i = 0; i < panel->level_count; i++) {
        json_add(all, json_of("y:n label:o", panel->levels[i].y,
                              plain_json(panel->levels[i].label)));
    }
    return all;
}

// Names, ranges and series of a panel.
static json_t *panel_json(const figure *fig, const figure_panel *panel,
                          const figure_range *range)
{
    const double x[] = {range->x_low, range->x_high};
    const double y[] = {range->y_low, range->y_high};
    return json_of(
        "x:o y:o xlog:b ylog:b xname:o xunit:o name:o unit:o series:o heading:o "
        "impulses:o impulse_unit:o levels:o",
        json_numbers(x, 2), json_numbers(y, 2), range->x_logarithmic,
        range->y_logarithmic, plain_json(text_or(fig->x.label, fig->x.name)),
        plain_json(fig->x.unit), plain_json(text_or(panel->y.label, panel->y.name)),
        plain_json(panel->y.unit), series_json(panel), plain_json(panel->heading),
        impulses_json(panel), plain_json(panel->impulse_unit), levels_json(panel));
}

// True if a series is a function of the horizontal axis, in ascending order.
static bool ascends(const figure_series *s)
{
    for (size_t i = 1; i < s->count; i++) {
        if (!(series_x(s, i) >= series_x(s, i - 1))) {
            return false;
        }
    }
    return true;
}

bool report_is_of_curves(const figure *fig)
{
    bool curves = !fig->equal_axes;
    for (int i = 0; i < fig->panel_count; i++) {
        const figure_panel *panel = &fig->panels[i];
        curves = curves && panel->map == NULL && panel->series_count > 0;
        for (int k = 0; curves && k < panel->series_count; k++) {
            curves = panel->series[k].shade == NULL && ascends(&panel->series[k]);
        }
    }
    return curves;
}

// Lines and stretches across all panels.
static json_t *marks_json(const figure *fig)
{
    json_t *lines = json_array(), *stretches = json_array();
    for (int i = 0; i < fig->mark_count; i++) {
        json_add(lines, json_of("x:n label:o", fig->marks[i].x,
                                plain_json(fig->marks[i].label)));
    }
    for (int i = 0; i < fig->interval_count; i++) {
        const double ends[] = {fig->intervals[i].from, fig->intervals[i].to};
        json_add(stretches, json_numbers(ends, 2));
    }
    return json_of("lines:o stretches:o", lines, stretches);
}

// Adds JSON as an attribute of an element, and ends it.
static void add_attribute(GString *html, const char *name, json_t *value)
{
    char *json = json_dumps(value, JSON_COMPACT | JSON_REAL_PRECISION(9));
    if (json == NULL) {
        g_error("out of memory");
    }
    g_autofree char *escaped = g_markup_escape_text(json, -1);
    text_append(html, " data-%s=\"%s\"", name, escaped);
    free(json);
    json_decref(value);
}

// "#0072b2".
static char *hex_of(colour c)
{
    return text_printf("#%02x%02x%02x", (unsigned)round(255 * c.red),
                       (unsigned)round(255 * c.green), (unsigned)round(255 * c.blue));
}

// What a drawing has in one colour gets another.
static void add_dark_colour(GString *css, colour light, colour dark)
{
    g_autofree char *from = hex_of(light), *to = hex_of(dark);
    for (int i = 0; i < 2; i++) {
        const char *what = i == 0 ? "fill" : "stroke";
        text_append(css, ".drawing [style*=\"%s:%s\"]{%s:%s!important}", what, from, what,
                    to);
    }
}

void report_add_data(GString *html, const figure *fig, const figure_report *seen)
{
    json_t *panels = json_array();
    for (int i = 0; i < seen->panel_count; i++) {
        json_add(panels, panel_json(fig, &fig->panels[i], &seen->ranges[i]));
    }
    add_attribute(html, "panels", panels);
    add_attribute(html, "marks", marks_json(fig));
}

void report_add_dark_colours(GString *css)
{
    g_string_append(css, "@media screen and (prefers-color-scheme:dark){");
    const colour *light = &palette_of(THEME_COLOUR)->page;
    const colour *dark = &palette_of(THEME_DARK)->page;
    for (size_t i = 0; i < sizeof(palette) / sizeof(colour); i++) {
        add_dark_colour(css, light[i], dark[i]);
    }
    for (int slot = 0; slot < PALETTE_SLOTS; slot++) {
        add_dark_colour(css, palette_series(THEME_COLOUR, slot, 0),
                        palette_series(THEME_DARK, slot, 0));
    }
    g_string_append(css, "}\n");
}
