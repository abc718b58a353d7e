// The report as a web page that needs no other file and no network.
#include <cairo.h>
#include <string.h>
#include <unistd.h>

#include "render/figures/report_parts.h"
#include "render/page/palette.h"
#include "render/page/svg.h"
#include "render/page/text.h"
#include "src/base/numbers.h"
#include "src/base/whole_file.h"

static const char report_script_curves[] =
    "'use strict';\n"
    "for (const fig of document.querySelectorAll('figure[data-panels]')) {\n"
    "  const svg = fig.querySelector('svg'), panels = JSON.parse(fig.dataset.panels);\n"
    "  const whole = svg.getAttribute('viewBox').split(' ').map(Number);\n"
    "  let view = whole.slice();\n"
    // the points of a path on the page, gaps as NaN
    "  const points = p => {\n"
    "    const out = [], d = p.getAttribute('d').match(/[A-Za-z]|-?\\d*\\.?\\d+/g) || [];\n"
    "    for (let i = 0, c = '', x = 0, y = 0; i < d.length;) {\n"
    "      if (/[A-Za-z]/.test(d[i])) { c = d[i++]; continue; }\n"
    "      x = (c === 'l' ? x : 0) + +d[i]; y = (c === 'l' ? y : 0) + +d[i + 1]; i += 2;\n"
    "      if (c === 'M') { out.push([NaN, NaN]); }\n"
    "      out.push([x, y]);\n"
    "    }\n"
    "    return out;\n"
    "  };\n"
    "  const near = (a, b) => a.every((v, i) => Math.abs(v - b[i]) < 4);\n"
    "  const inkOf = p => (getComputedStyle(p).stroke.match(/[\\d.]+/g) || []).map(Number);\n"
    "  const lines = [...svg.querySelectorAll('path')].filter(\n"
    "    p => getComputedStyle(p).fill === 'none' && /M/.test(p.getAttribute('d')));\n"
    "  for (const panel of panels) {\n"
    "    const [x, y, w, h] = panel.box;\n"
    "    for (const s of panel.series) {\n"
    "      s.paths = lines.filter(p => {\n"
    "        const b = p.getBBox(), ink = inkOf(p);\n"
    "        return ink.length > 2 && near(ink.slice(0, 3), s.ink) && b.width > 0.05 * w &&\n"
    "          b.x > x - 6 && b.x + b.width < x + w + 6 && b.y > y - 6 && b.y + b.height < y + h + "
    "6 &&\n"
    "          (getComputedStyle(p).strokeDasharray === 'none') !== s.dashed;\n"
    "      });\n"
    "      s.points = s.paths.filter(p => points(p).length > 3).flatMap(points);\n"
    "    }\n"
    "  }\n"
    // a button for each curve, by its name in all panels
    "  const row = document.createElement('div');\n"
    "  row.className = 'curves';\n"
    "  const names = [...new Set(panels.flatMap(p => p.series.map(s => s.label)))];\n"
    "  for (const name of names.length > 1 ? names : []) {\n"
    "    const button = document.createElement('button');\n"
    "    button.textContent = name;\n"
    "    button.type = 'button';\n"
    "    button.setAttribute('aria-pressed', 'true');\n"
    "    button.onclick = () => {\n"
    "      const on = button.getAttribute('aria-pressed') !== 'true';\n"
    "      button.setAttribute('aria-pressed', on);\n"
    "      for (const s of panels.flatMap(p => p.series).filter(s => s.label === name)) {\n"
    "        s.off = !on;\n"
    "        s.paths.forEach(p => p.style.opacity = on ? '' : '0.06');\n"
    "      }\n"
    "    };\n"
    "    row.append(button);\n"
    "  }\n"
    "  const tip = document.createElement('output');\n"
    "  fig.append(row, tip);\n"
    "  const show = () => svg.setAttribute('viewBox', view.join(' '));\n"
    "  const at = e => {\n"
    "    const m = svg.getScreenCTM().inverse();\n"
    "    return [m.a * e.clientX + m.e, m.d * e.clientY + m.f];\n"
    "  };\n"
    "  const value = (share, range, log) => log\n"
    "    ? range[0] * Math.pow(range[1] / range[0], share)\n"
    "    : range[0] + share * (range[1] - range[0]);\n"
    "  const digits = v => String(+v.toPrecision(4));\n";

// Its second half: actions of the pointer.
static const char report_script_pointer[] =
    // values at the pointer, interpolated linearly
    "  svg.addEventListener('mousemove', e => {\n"
    "    const [px, py] = at(e);\n"
    "    const panel = panels.find(p => px >= p.box[0] && px <= p.box[0] + p.box[2] &&\n"
    "      py >= p.box[1] && py <= p.box[1] + p.box[3]);\n"
    "    if (!panel) { tip.textContent = ''; return; }\n"
    "    const [x, y, w, h] = panel.box;\n"
    "    const said = [panel.xname + ' ' + digits(value((px - x) / w, panel.x, panel.xlog))];\n"
    "    for (const s of panel.series.filter(s => !s.off)) {\n"
    "      for (let i = 1; i < s.points.length; i++) {\n"
    "        const [a, b] = [s.points[i - 1], s.points[i]];\n"
    "        if (a[0] <= px && px <= b[0]) {\n"
    "          const v = b[0] > a[0] ? a[1] + (px - a[0]) / (b[0] - a[0]) * (b[1] - a[1]) : b[1];\n"
    "          said.push(s.label + ' ' + digits(value((y + h - v) / h, panel.y, panel.ylog)) +\n"
    "            (panel.unit ? ' ' + panel.unit : ''));\n"
    "          break;\n"
    "        }\n"
    "      }\n"
    "    }\n"
    "    tip.textContent = said.join('   ');\n"
    "  });\n"
    "  svg.addEventListener('mouseleave', () => { tip.textContent = ''; });\n"
    // the wheel with Ctrl or Shift zooms, so that a page still scrolls; dragging moves
    "  svg.addEventListener('wheel', e => {\n"
    "    if (!e.ctrlKey && !e.shiftKey) { return; }\n"
    "    e.preventDefault();\n"
    "    const [px, py] = at(e), by = Math.exp((e.deltaY || e.deltaX) / 400);\n"
    "    const k = Math.min(whole[2] / view[2], Math.max(by, 0.02 * whole[2] / view[2]));\n"
    "    view = [px - k * (px - view[0]), py - k * (py - view[1]), k * view[2], k * view[3]];\n"
    "    show();\n"
    "  }, {passive: false});\n"
    "  svg.addEventListener('mousedown', e => {\n"
    "    const from = at(e);\n"
    "    const move = f => {\n"
    "      const to = at(f);\n"
    "      view = [view[0] + from[0] - to[0], view[1] + from[1] - to[1], view[2], view[3]];\n"
    "      show();\n"
    "    };\n"
    "    const end = () => { removeEventListener('mousemove', move); "
    "removeEventListener('mouseup', end); };\n"
    "    addEventListener('mousemove', move);\n"
    "    addEventListener('mouseup', end);\n"
    "  });\n"
    "  svg.addEventListener('dblclick', () => { view = whole.slice(); show(); });\n"
    "}\n";

// ==== the page

status report_item_done(const report *r, fault *f)
{
    run_monitor_count(r->monitor);
    return run_monitor_stops(r->monitor)
               ? fault_set(f, STATUS_STOPPED, "%s", status_text(STATUS_STOPPED))
               : STATUS_OK;
}

#define SCREEN_DPI 130.0

static const char *const page_head =
    "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width\">\n<title>%s</title>\n<style>\n"
    "body{font-family:'DejaVu Sans',sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem;"
    "line-height:1.5;color:#191919}\n"
    "h1{font-size:1.6rem}h2{font-size:1.1rem;margin-top:3rem}\n"
    "nav ol{columns:2;font-size:.85rem;padding-left:1.5rem}\n"
    "svg{max-width:100%%;height:auto}\n"
    "table{border-collapse:collapse;font-size:.85rem;margin:.5rem 0}\n"
    "th,td{padding:.15rem .6rem;text-align:left;vertical-align:top}\n"
    "thead th{border-top:2px solid;border-bottom:1px solid}\n"
    "tbody{border-bottom:2px solid}\n"
    ".number{text-align:right}.group{background:#f0f3f7}\n"
    ".note,.facts{font-size:.8rem;color:#5f5f5f}\n"
    "figure{margin:0}figure "
    "output{display:block;min-height:1.4em;font-size:.8rem;white-space:pre-wrap}\n"
    ".curves button{font:inherit;font-size:.75rem;margin-right:.4rem;border:1px solid #b5b5b5;"
    "border-radius:.2rem;background:#f0f3f7}\n"
    ".curves "
    "button[aria-pressed=false]{background:none;color:#8a8a8a;text-decoration:line-through}\n"
    "code{background:#f0f3f7;padding:.1rem .3rem}\n"
    "</style>\n</head>\n<body>\n<h1>%s</h1>\n"
    "<p>%s <q>Printed</q> is the thesis's model with its slips, <q>corrected</q> the mechanics "
    "derived anew.</p>\n"
    "<p class=\"note\">Point at a curve for its values; Ctrl or Shift and the wheel zoom, dragging "
    "moves, a double click shows all again; the buttons take curves away.</p>\n";

static void add_contents(const report *r, GString *html)
{
    g_string_append(html, "<nav><ol>\n");
    for (guint i = 0; i < r->items->len; i++) {
        g_autofree char *title = text_escape(report_item_at(r, i)->drawn.title);
        text_append(html, "<li><a href=\"#item-%u\">%s</a></li>\n", i, title);
    }
    g_string_append(html, "</ol></nav>\n");
}

// A picture with many cells, which would be many thousand paths: as a PNG in the page.
static status add_png(GString *html, const picture *p, const char *alternative, fault *f)
{
    g_autofree char *name = NULL, *bytes = NULL;
    gsize length = 0;
    GError *error = NULL;
    int file = g_file_open_tmp("impactlab-XXXXXX.png", &name, &error);
    if (file < 0) {
        fault_set(f, STATUS_CANNOT_WRITE, "%s", error->message);
        g_error_free(error);
        return STATUS_CANNOT_WRITE;
    }
    close(file);

    status code = picture_write(p, name, f);
    if (code == STATUS_OK && g_file_get_contents(name, &bytes, &length, NULL)) {
        g_autofree char *text = g_base64_encode((const guchar *)bytes, length);
        text_append(html, "<img alt=\"%s\" src=\"data:image/png;base64,%s\">\n", alternative, text);
    }
    unlink(name);
    return code;
}

// The SVG as an element of the page: without the XML declaration, its ids made its own.
static status add_svg(GString *html, const picture *p, guint index, GHashTable *letters, fault *f)
{
    // its own identifiers, as all figures stand in one page
    g_autofree char *svg = picture_svg(p, f);
    if (svg == NULL) {
        return f->code;
    }

    // then smaller: fewer bytes, and letters shared with the other figures
    g_autofree char *prefix = text_printf("i%u-", index);
    char *root = strstr(svg, "<svg"), *own = svg_prefix_ids(root ? root : svg, prefix);
    g_autofree char *small = svg_compact(own), *shared = svg_share_symbols(small, letters);
    g_string_append(html, shared);
    g_free(own);
    return STATUS_OK;
}

// A text as a JSON string that may stand in an attribute.
static void add_json_text(GString *out, const char *markup)
{
    g_autofree char *plain = text_plain(markup != NULL ? markup : "");
    g_string_append(out, "&quot;");

    // escaped twice: for JSON, and for the attribute around it
    for (const char *c = plain; *c != '\0'; c++) {
        switch (*c) {
        case '"':
            g_string_append(out, "\\&quot;");
            break;
        case '\\':
            g_string_append(out, "\\\\");
            break;
        case '&':
            g_string_append(out, "&amp;");
            break;
        case '<':
            g_string_append(out, "&lt;");
            break;
        default:
            g_string_append_c(out, (guchar)*c < ' ' ? ' ' : *c);
        }
    }
    g_string_append(out, "&quot;");
}

static void add_json_axis(GString *out, const char *name, double low, double high)
{
    char text[96];
    decimal_print(text, sizeof text, "&quot;%s&quot;:[%.9g,%.9g],", name, low, high);
    g_string_append(out, text);
}

// Colour, pattern and name of the curves of a panel.
static void add_json_series(GString *out, const figure_panel *panel)
{
    g_string_append(out, "&quot;series&quot;:[");
    const char *before = "";

    // points alone are no curve
    for (int i = 0; i < panel->series_count; i++) {
        const figure_series *s = &panel->series[i];
        if (s->no_line) {
            continue;
        }

        // in bytes, for the script that compares it with the strokes of the drawing
        const colour c = palette_series(THEME_COLOUR, s->colour, i);
        bool dashed = s->secondary || s->style != LINE_SOLID;
        text_append(out,
                    "%s{&quot;ink&quot;:[%d,%d,%d],&quot;dashed&quot;:%s,"
                    "&quot;label&quot;:",
                    before, (int)(255 * c.red + 0.5), (int)(255 * c.green + 0.5),
                    (int)(255 * c.blue + 0.5), dashed ? "true" : "false");
        add_json_text(out, s->label != NULL ? s->label : s->name);
        g_string_append_c(out, '}');
        before = ",";
    }
    g_string_append(out, "]}");
}

// Places, ranges and curves of all panels, for the script.
static void add_panels(GString *out, const figure *fig, const figure_report *seen)
{
    char text[160];
    g_string_append(out, " data-panels=\"[");
    for (int i = 0; i < seen->panel_count; i++) {
        const figure_rect *box = &seen->panels[i];
        const figure_range *range = &seen->ranges[i];

        // where the panel stands and what its edges mean, to turn a place into values
        decimal_print(text, sizeof text, "%s{&quot;box&quot;:[%.2f,%.2f,%.2f,%.2f],",
                      i > 0 ? "," : "", box->x, box->y, box->width, box->height);
        g_string_append(out, text);
        add_json_axis(out, "x", range->x_low, range->x_high);
        add_json_axis(out, "y", range->y_low, range->y_high);
        text_append(out, "&quot;xlog&quot;:%s,&quot;ylog&quot;:%s,&quot;xname&quot;:",
                    range->x_logarithmic ? "true" : "false",
                    range->y_logarithmic ? "true" : "false");

        // what stands beside the values
        add_json_text(out, fig->x.name);
        g_string_append(out, ",&quot;unit&quot;:");
        add_json_text(out, fig->panels[i].y.unit);
        g_string_append_c(out, ',');
        add_json_series(out, &fig->panels[i]);
    }
    g_string_append(out, "]\"");
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
        code = drawn->paint(cr, drawn->what, seen, f);
        code = picture_end_drawing(cr, code, f);
        if (code == STATUS_OK) {
            add_panels(html, drawn->plotted, seen);
        }
        cairo_surface_destroy(nowhere);
    }

    g_string_append(html, ">\n");
    bool heavy = map || drawn->cells;
    if (code == STATUS_OK) {
        code = heavy ? add_png(html, &p, alternative, f) : add_svg(html, &p, index, letters, f);
    }
    g_string_append(html, "</figure>\n");
    return code;
}

static status add_section(const report *r, guint index, GString *html, GHashTable *letters,
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
    text_append(html, "<p class=\"facts\">Model: %s.", item->model);
    if (item->scenario != NULL) {
        text_append(html, " Scenario: %s.", item->scenario);
    }
    if (item->command != NULL) {
        text_append(html, " Again: <code>%s</code>", item->command);
    }

    g_string_append(html, "</p>\n</section>\n");
    return code;
}

status report_write_html(const report *r, const char *path, fault *f)
{
    whole_file file;
    status code = STATUS_OK;
    GString *html = g_string_new(NULL);
    GHashTable *letters = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);

    // the whole page first: nothing is written of one that fails
    text_append(html, page_head, r->heading, r->heading, r->preface);
    add_contents(r, html);
    for (guint i = 0; i < r->items->len && code == STATUS_OK; i++) {
        code = add_section(r, i, html, letters, f);
        if (code == STATUS_OK && report_item_at(r, i)->command != NULL) {
            code = report_item_done(r, f);
        }
    }
    text_append(html, "<script>\n%s%s</script>\n</body>\n</html>\n", report_script_curves,
                report_script_pointer);

    if (code == STATUS_OK) {
        code = whole_file_open(&file, path, f);
    }

    if (code == STATUS_OK) {
        fwrite(html->str, 1, html->len, file.stream);
        code = whole_file_commit(&file, f);
    }
    g_hash_table_destroy(letters);
    g_string_free(html, TRUE);
    return code;
}
