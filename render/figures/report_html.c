// The report as a web page that needs no other file and no network.
#include <cairo.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/figures/report.h"
#include "src/base/json.h"
#include "src/base/text_stream.h"
#include "src/base/whole_file.h"

// Style and script, line by line; the build makes these of report.css and report.js.
static const char *const style[] = {
#include "render/figures/report.css.inc"
};
static const char *const script[] = {
#include "render/figures/report.js.inc"
};

void report_add_facts(GString *out, const report_item *item, const char *gap, const char *tag)
{
    text_append(out, "Model: %s.", item->model);
    if (item->scenario != NULL) {
        text_append(out, "%sScenario: %s.", gap, item->scenario);
    }
    if (item->command != NULL) {
        text_append(out, "%sAgain: <%s>%s</%s>", gap, tag, item->command, tag);
    }
}

status report_item_done(const report_content *r, fault *f)
{
    run_monitor_count(r->monitor);
    return run_monitor_stops(r->monitor)
               ? fault_set(f, STATUS_STOPPED, "%s", status_text(STATUS_STOPPED))
               : STATUS_OK;
}

#define SCREEN_DPI 130.0

static void add_lines(GString *html, const char *const *lines, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        g_string_append(html, lines[i]);
    }
}

static void add_head(const report_content *r, GString *html)
{
    text_append(html,
                "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                "<meta name=\"viewport\" content=\"width=device-width\">\n<title>%s</title>\n"
                "<style>\n",
                r->heading);
    add_lines(html, style, G_N_ELEMENTS(style));
    text_append(
        html,
        "</style>\n</head>\n<body>\n<h1>%s</h1>\n<p>%s <q>Printed</q> is the thesis's model "
        "with its slips, <q>corrected</q> the mechanics derived anew.</p>\n"
        "<p class=\"note\">Point at a curve for its values; Ctrl or Shift and the wheel zoom, "
        "dragging moves, a double click shows all again; the buttons take curves away.</p>\n",
        r->heading, r->preface);
}

// A picture with many cells, which would be many thousand paths: as a PNG in the page.
static status add_png(GString *html, const picture *p, const char *alternative, fault *f)
{
    text_stream stream;
    size_t length = 0;
    TRY_MEMORY(text_stream_open(&stream), f);
    status code = picture_write_png(p, stream.stream, f);
    char *bytes = text_stream_close(&stream, &length);
    code = code == STATUS_OK && bytes == NULL ? fault_no_memory(f) : code;
    if (code == STATUS_OK) {
        g_autofree char *text = g_base64_encode((const guchar *)bytes, length);
        text_append(html, "<img alt=\"%s\" src=\"data:image/png;base64,%s\">\n", alternative, text);
    }
    free(bytes);
    return code;
}

static status add_svg(GString *html, const picture *p, guint index, GHashTable *letters, fault *f)
{
    g_autofree char *svg = picture_svg(p, f);
    FAIL_IF(svg == NULL, f->code);
    g_autofree char *prefix = text_printf("i%u-", index);
    g_autofree char *small = svg_for_page(svg, prefix, letters);
    g_string_append(html, small);
    return STATUS_OK;
}

// A member of plain text.
static json_t *plain_json(const char *markup)
{
    g_autofree char *plain = text_plain(markup != NULL ? markup : "");
    return json_text(plain);
}

// Colour, pattern and name of the curves of a panel; points alone are no curve.
static json_t *series_json(const figure_panel *panel)
{
    json_t *all = json_array();
    for (int i = 0; i < panel->series_count; i++) {
        const figure_series *s = &panel->series[i];
        if (!s->no_line) {
            // in bytes, for the script that compares it with the strokes of the drawing
            const colour c = palette_series(THEME_COLOUR, s->colour, i);
            const double ink[] = {round(255 * c.red), round(255 * c.green), round(255 * c.blue)};
            json_add(all, json_of("ink:o dashed:b label:o", json_numbers(ink, 3),
                                  s->secondary || s->style != LINE_SOLID,
                                  plain_json(s->label != NULL ? s->label : s->name)));
        }
    }
    return all;
}

// Places, ranges and curves of all panels as JSON in an attribute, for the script: to turn a place
// into values.
static void add_panels(GString *html, const figure *fig, const figure_report *seen)
{
    json_t *all = json_array();
    for (int i = 0; i < seen->panel_count; i++) {
        const figure_rect *box = &seen->panels[i];
        const figure_range *range = &seen->ranges[i];
        const double place[] = {box->x, box->y, box->width, box->height};
        const double x[] = {range->x_low, range->x_high}, y[] = {range->y_low, range->y_high};
        json_add(all, json_of("box:o x:o y:o xlog:b ylog:b xname:o unit:o series:o",
                              json_numbers(place, 4), json_numbers(x, 2), json_numbers(y, 2),
                              range->x_logarithmic, range->y_logarithmic, plain_json(fig->x.name),
                              plain_json(fig->panels[i].y.unit), series_json(&fig->panels[i])));
    }
    char *json = json_dumps(all, JSON_COMPACT | JSON_REAL_PRECISION(9));
    loss_unless(json != NULL);
    g_autofree char *escaped = g_markup_escape_text(json != NULL ? json : "", -1);
    text_append(html, " data-panels=\"%s\"", escaped);
    free(json);
    json_decref(all);
}

// The figure with what it shows in words, and for the script what its axes mean.
static status add_figure(GString *html, const report_item *item, guint index, GHashTable *letters,
                         fault *f)
{
    const figure_options options = {0};
    const artwork *drawn = &item->drawn;
    picture p = artwork_picture(drawn, &options);
    p.dpi = SCREEN_DPI; // of what has too many cells for paths
    g_autofree char *alternative =
        text_escape(p.alternative != NULL ? p.alternative : drawn->title);
    bool map = drawn->plotted != NULL && drawn->plotted->panels[0].map != NULL;
    text_append(html, "<figure role=\"img\" aria-label=\"%s\"", alternative);

    // where its panels are is known once it has been painted
    status code = STATUS_OK;
    if (drawn->plotted != NULL && !map) {
        g_autofree figure_report *seen = g_new0(figure_report, 1);
        cairo_surface_t *nowhere = cairo_recording_surface_create(CAIRO_CONTENT_COLOR, NULL);
        cairo_t *cr = cairo_create(nowhere);
        code = artwork_paint(drawn, cr, seen, f);
        code = picture_end_drawing(cr, code, f);
        if (code == STATUS_OK) {
            add_panels(html, drawn->plotted, seen);
        }
        cairo_surface_destroy(nowhere);
    }

    g_string_append(html, ">\n");
    if (code == STATUS_OK) {
        code = map ? add_png(html, &p, alternative, f) : add_svg(html, &p, index, letters, f);
    }
    g_string_append(html, "</figure>\n");
    return code;
}

static status add_section(const report_content *r, guint index, GString *html, GHashTable *letters,
                          fault *f)
{
    status code = STATUS_OK;
    const report_item *item = report_item_at(r, index);
    g_autofree char *title = text_escape(item->drawn.title);
    text_append(html, "<section id=\"item-%u\">\n<h2>%s</h2>\n", index, title);

    // the item itself
    if (item->drawn.table != NULL) {
        table_add_html(item->drawn.table, html);
    } else {
        code = add_figure(html, item, index, letters, f);
    }

    // what it is made of, and how
    g_string_append(html, "<p class=\"facts\">");
    report_add_facts(html, item, " ", "code");
    g_string_append(html, "</p>\n</section>\n");
    return code;
}

status report_write_html(const report_content *r, const char *path, fault *f)
{
    whole_file file;
    status code = STATUS_OK;
    g_autoptr(GString) html = g_string_new(NULL);
    g_autoptr(GHashTable) letters = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);

    // the whole page first: nothing is written of one that fails
    add_head(r, html);
    g_string_append(html, "<nav><ol>\n");
    for (guint i = 0; i < r->items->len; i++) {
        g_autofree char *title = text_escape(report_item_at(r, i)->drawn.title);
        text_append(html, "<li><a href=\"#item-%u\">%s</a></li>\n", i, title);
    }
    g_string_append(html, "</ol></nav>\n");
    for (guint i = 0; i < r->items->len && code == STATUS_OK; i++) {
        code = add_section(r, i, html, letters, f);
        if (code == STATUS_OK && report_item_at(r, i)->command != NULL) {
            code = report_item_done(r, f);
        }
    }
    g_string_append(html, "<script>\n");
    add_lines(html, script, G_N_ELEMENTS(script));
    g_string_append(html, "</script>\n</body>\n</html>\n");

    code = code == STATUS_OK ? whole_file_open(&file, path, f) : code;

    if (code == STATUS_OK) {
        fwrite(html->str, 1, html->len, file.stream);
        code = whole_file_commit(&file, f);
    }
    return code;
}
