// The report: as a PDF with outline, links and page numbers, and as a web page that needs
// no other file and no network.
#include "render/figures/report_data.h"

#include <assert.h>
#include <cairo-pdf.h>
#include <math.h>
#include <stdlib.h>

#include "src/base/shipped.h"
#include "src/base/text_stream.h"
#include "src/base/whole_file.h"

// One thing the report shows.
typedef struct report_item {
    const char *scenario, *model; // scenario may be NULL
    char *command;                // NULL: no command
    char *live; // what the lab's page opens for it, as its address has it; NULL: nothing
    artwork drawn;
    int page; // of the PDF, counted from 1
} report_item;

typedef struct report_content {
    GArray *items;       // of report_item
    const char *preface; // description of the report, a sentence or two
    char *heading;
    char *page;           // the lab's page, in base64; NULL: none
    run_monitor *monitor; // NULL: nobody looks on
} report_content;

static report_item *report_item_at(const report_content *r, guint index)
{
    return &g_array_index(r->items, report_item, index);
}

// Appends what an item is made of, and the command for it in an element of its own.
static void add_origin(GString *out, const report_item *item, const char *gap,
                       const char *tag)
{
    text_append(out, "Model: %s.", item->model);
    if (item->scenario != NULL) {
        text_append(out, "%sScenario: %s.", gap, item->scenario);
    }
    if (item->command != NULL) {
        text_append(out, "%sCommand: <%s>%s</%s>", gap, tag, item->command, tag);
    }
}

// Counts a finished item; STATUS_STOPPED if the report is to end here.
static status item_done(const report_content *r, fault *f)
{
    run_monitor_count(r->monitor);
    if (run_monitor_stops(r->monitor)) {
        return fault_set(f, STATUS_STOPPED, "%s", status_text(STATUS_STOPPED));
    }
    return STATUS_OK;
}

// ==== the PDF

// A4 [pt].
#define PAGE_WIDTH  595.0
#define PAGE_HEIGHT 842.0
#define PAGE_MARGIN 50.0
#define FACTS_SPACE 14.0 // for the line under an item
#define ITEM_SPACE  16.0

// Of the title page [pt].
#define HEADING_TOP  120.0
#define PREFACE_TOP  160.0
#define CONTENTS_TOP 212.0
#define NUMBER_WIDTH 14.0 // room for the number of a page

// Items from first to last, one below the other.
typedef struct report_page {
    const report_content *report;
    guint first, last; // last is not included
    int number;        // 0: the title page
} report_page;

static double item_scale(const report_item *item)
{
    double across = (PAGE_WIDTH - 2 * PAGE_MARGIN) / item->drawn.width;
    double down = (PAGE_HEIGHT - 2 * PAGE_MARGIN - FACTS_SPACE) / item->drawn.height;
    // a drawing is made smaller to fit, never larger than it was designed
    return fmin(1, fmin(across, down));
}

static double item_height(const report_item *item)
{
    return item->drawn.height * item_scale(item) + FACTS_SPACE;
}

// Puts a text at (x, y), wrapped at the page's right margin.
static void put_text(cairo_t *cr, PangoContext *context, const char *markup, double size,
                     bool bold, double x, double y)
{
    text_block t = {markup, size, .bold = bold, .width = PAGE_WIDTH - PAGE_MARGIN - x};
    text_put(cr, context, &t, x, y, (anchor){0, 0}, palette_of(THEME_COLOUR)->text);
}

// Heading, preface and a table of contents.
static void put_title_page(cairo_t *cr, PangoContext *context, const report_content *r)
{
    put_text(cr, context, r->heading, 18, true, PAGE_MARGIN, HEADING_TOP);
    put_text(cr, context, r->preface, 9, false, PAGE_MARGIN, PREFACE_TOP);

    // the items by title and page, each a link; many of them stand closer
    const double room = PAGE_HEIGHT - PAGE_MARGIN - CONTENTS_TOP;
    const double step = fmin(12, room / r->items->len), letters = fmin(8, 0.7 * step);
    double y = CONTENTS_TOP;
    for (guint i = 0; i < r->items->len; i++, y += step) {
        const report_item *item = report_item_at(r, i);
        g_autofree char *title = text_escape(item->drawn.title);
        g_autofree char *page = text_printf("%d", item->page);
        g_autofree char *target = text_printf("dest='item-%u'", i);
        cairo_tag_begin(cr, CAIRO_TAG_LINK, target);
        put_text(cr, context, title, letters, false, PAGE_MARGIN, y);
        put_text(cr, context, page, letters, false,
                 PAGE_WIDTH - PAGE_MARGIN - NUMBER_WIDTH, y);
        cairo_tag_end(cr, CAIRO_TAG_LINK);
    }
}

// Marks the place of an item, to which the table of contents and the outline lead.
static void mark_item(cairo_t *cr, const report_item *item, guint index)
{
    cairo_surface_t *surface = cairo_get_target(cr);
    g_autofree char *place = text_printf("name='item-%u'", index);
    g_autofree char *target = text_printf("dest='item-%u'", index);
    cairo_tag_begin(cr, CAIRO_TAG_DEST, place);
    cairo_tag_end(cr, CAIRO_TAG_DEST);
    if (cairo_surface_get_type(surface) == CAIRO_SURFACE_TYPE_PDF) {
        cairo_pdf_surface_add_outline(surface, CAIRO_PDF_OUTLINE_ROOT, item->drawn.title,
                                      target, 0);
    }
}

// Draws an item with its upper edge at y, and under it what it is made of.
static status paint_item(cairo_t *cr, PangoContext *context, const report_item *item,
                         double y, fault *f)
{
    const double scale = item_scale(item);
    cairo_save(cr);
    cairo_translate(cr, PAGE_MARGIN, y);
    cairo_scale(cr, scale, scale);
    TRY(artwork_paint(&item->drawn, cr, NULL, f));
    cairo_restore(cr);

    g_autoptr(GString) facts = g_string_new(NULL);
    add_origin(facts, item, "  ", "b");
    put_text(cr, context, facts->str, 7, false, PAGE_MARGIN + SKETCH_MARGIN,
             y + item->drawn.height * scale + 2);
    return STATUS_OK;
}

// The title page, or items one below the other with the page's number.
static status paint_page(cairo_t *cr, const void *what, fault *f)
{
    const report_page *page = what;
    TRY(text_check_font(f));
    g_autoptr(PangoContext) context = text_context_create();
    if (page->number == 0) {
        put_title_page(cr, context, page->report);
    }

    // its items, one below the other
    double y = PAGE_MARGIN;
    for (guint i = page->first; i < page->last; i++) {
        const report_item *item = report_item_at(page->report, i);
        mark_item(cr, item, i);
        TRY(paint_item(cr, context, item, y, f));
        y += item_height(item) + ITEM_SPACE;
    }

    if (page->number > 0) {
        g_autofree char *number = text_printf("%d", page->number + 1);
        put_text(cr, context, number, 8, false, PAGE_WIDTH / 2, PAGE_HEIGHT - 30);
    }
    return STATUS_OK;
}

// Puts as many items on each page as there is room for.
static GArray *make_pages(const report_content *r)
{
    // the title page, then as many items as fit
    GArray *pages = g_array_new(FALSE, TRUE, sizeof(report_page));
    report_page page = {.report = r};
    g_array_append_val(pages, page);
    for (guint i = 0; i < r->items->len;) {
        double room = PAGE_HEIGHT - 2 * PAGE_MARGIN;
        page.first = i;
        page.number++;
        do {
            room -= item_height(report_item_at(r, i)) + ITEM_SPACE;
            report_item_at(r, i)->page = page.number + 1;
            i++;
        } while (i < r->items->len && room >= item_height(report_item_at(r, i)));

        page.last = i;
        g_array_append_val(pages, page);
    }
    return pages;
}

// Every page as a picture of one file.
static status write_pdf(const report_content *r, const char *path, fault *f)
{
    g_autoptr(GArray) pages = make_pages(r);
    g_autofree picture *pictures = g_new0(picture, pages->len);

    for (guint i = 0; i < pages->len; i++) {
        pictures[i] =
            (picture){r->heading,          PAGE_WIDTH,
                      PAGE_HEIGHT,         .software = r->heading,
                      .paint = paint_page, .what = &g_array_index(pages, report_page, i)};
    }

    return picture_write_pages(pictures, (int)pages->len, path, f);
}

// ==== the web page

// Style and script, report_css and report_js, and those of uPlot, which draws what is
// zoomed, with its licence: made of the files of these names by embed.py.
#include "render/figures/report.css.inc"
#include "render/figures/report.js.inc"
#include "render/figures/uPlot.LICENSE.inc"
#include "render/figures/uPlot.iife.min.js.inc"
#include "render/figures/uPlot.min.css.inc"

#define SCREEN_DPI 130.0

// Head of the page, heading and preface.
static void add_head(const report_content *r, GString *html)
{
    text_append(
        html,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width\">\n<title>%s</title>\n"
        "<!-- uPlot, which draws what is zoomed:\n%s-->\n<style>\n",
        r->heading, uPlot_LICENSE);
    g_string_append(html, uPlot_min_css);
    g_string_append(html, report_css);
    report_add_dark_colours(html);
    text_append(
        html,
        "</style>\n</head>\n<body>\n<h1>%s</h1>\n<p>%s <q>Printed</q> is the "
        "thesis's model with its errors, <q>corrected</q> the model derived again "
        "from mechanics.</p>\n"
        "<p class=\"note\" id=\"hint\" hidden><q>Zoom and read values</q> under a figure "
        "draws its curves from their data: drag across a stretch of the axis to see it "
        "alone, point or tap for values; every step has a button, too.</p>\n",
        r->heading, r->preface);
}

// Appends the picture as a PNG in base64, as an address that holds it.
static status add_png(GString *html, const picture *p, fault *f)
{
    text_stream stream;
    size_t length = 0;
    if (!text_stream_open(&stream)) {
        g_error("out of memory");
    }
    const status code = picture_write_png(p, stream.stream, f);
    char *bytes = text_stream_close(&stream, &length);
    if (bytes == NULL) {
        g_error("out of memory");
    }

    if (code == STATUS_OK) {
        g_autofree char *text = g_base64_encode((const guchar *)bytes, length);
        text_append(html, "\"data:image/png;base64,%s\"", text);
    }
    free(bytes);
    return code;
}

// A drawing with many cells, which would be many thousand paths: as pixels, for a light
// and for a dark screen.
static status add_map(GString *html, const artwork *drawn, const char *alternative,
                      fault *f)
{
    static const figure_theme themes[] = {THEME_DARK, THEME_COLOUR};
    g_string_append(html, "<div class=\"drawing\"><picture>");
    for (size_t i = 0; i < G_N_ELEMENTS(themes); i++) {
        figure themed = *drawn->plotted;
        artwork shown = *drawn;
        themed.theme = themes[i];
        shown.plotted = &themed;
        picture p = artwork_picture(&shown, &(figure_options){.look.dpi = SCREEN_DPI});
        if (themes[i] == THEME_DARK) {
            g_string_append(html, "<source media=\"screen and (prefers-color-scheme:dark)"
                                  "\" srcset=");
            TRY(add_png(html, &p, f));
        } else {
            text_append(html, "><img alt=\"%s\" src=", alternative);
            TRY(add_png(html, &p, f));
        }
    }
    g_string_append(html, "></picture></div>\n");
    return STATUS_OK;
}

// The figure with what it shows in words, and for the script what its axes mean.
static status add_figure(GString *html, const report_item *item, guint index,
                         GHashTable *letters, fault *f)
{
    const figure_options options = {0};
    artwork drawn = item->drawn;
    g_autofree figure_report *seen = g_new0(figure_report, 1);
    drawn.seen = seen;

    // the section's heading is its title
    figure untitled = {0};
    if (drawn.plotted != NULL) {
        untitled = *drawn.plotted;
        untitled.title = NULL;
        drawn.plotted = &untitled;
        figure_size(&untitled, &drawn.width, &drawn.height);
    }

    const picture p = artwork_picture(&drawn, &options);
    g_autofree char *alternative = text_escape(p.alternative);
    const char *kind = drawn.paint != NULL ? " class=\"diagram\"" : "";
    text_append(html, "<figure%s role=\"img\" aria-label=\"%s\"", kind, alternative);
    if (item->live != NULL) {
        text_append(html, " data-live=\"%s\"", item->live);
    }

    // a map as pixels, anything else as paths
    if (drawn.plotted != NULL && drawn.plotted->panels[0].map != NULL) {
        g_string_append(html, ">\n");
        TRY(add_map(html, &drawn, alternative, f));
    } else {
        // where its panels are is known once it has been painted
        g_autofree char *svg = picture_svg(&p, f), *prefix = text_printf("i%u-", index);
        if (svg == NULL) {
            return f->code;
        }
        if (drawn.plotted != NULL && report_is_of_curves(drawn.plotted)) {
            report_add_data(html, drawn.plotted, seen);
        }
        g_autofree char *small = svg_for_page(svg, prefix, letters);
        text_append(html, ">\n<div class=\"drawing\">\n%s</div>\n", small);
    }
    g_string_append(html, "</figure>\n");
    return STATUS_OK;
}

// An item with its title and what it is made of.
static status add_section(const report_content *r, guint index, GString *html,
                          GHashTable *letters, fault *f)
{
    const report_item *item = report_item_at(r, index);
    g_autofree char *title = text_escape(item->drawn.title);

    // a diagram has its title within it; the heading is for readers of the outline
    const bool diagram = item->drawn.paint != NULL;
    const char *look = diagram ? " class=\"unseen\"" : "";
    text_append(html, "<section id=\"item-%u\">\n<h2%s>%s</h2>\n", index, look, title);

    // the item itself
    if (item->drawn.table != NULL) {
        g_string_append(html, "<div class=\"scrolls\" tabindex=\"0\">\n");
        table_add_html(item->drawn.table, html);
        g_string_append(html, "</div>\n");
    } else {
        TRY(add_figure(html, item, index, letters, f));
    }

    // what it is made of, and how
    g_string_append(html, "<p class=\"facts\">");
    add_origin(html, item, " ", "code");
    g_string_append(html, "</p>\n</section>\n");
    return STATUS_OK;
}

// The items by title, each a link.
static void add_contents(const report_content *r, GString *html)
{
    g_string_append(html, "<nav><ol>\n");
    for (guint i = 0; i < r->items->len; i++) {
        g_autofree char *title = text_escape(report_item_at(r, i)->drawn.title);
        text_append(html, "<li><a href=\"#item-%u\">%s</a></li>\n", i, title);
    }
    g_string_append(html, "</ol></nav>\n");
}

// The page with style, items and script in one file.
static status write_html(const report_content *r, const char *path, fault *f)
{
    whole_file file;
    g_autoptr(GString) html = g_string_new(NULL);
    g_autoptr(GHashTable) letters =
        g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);

    // the whole page first: nothing is written of one that fails
    add_head(r, html);
    add_contents(r, html);
    for (guint i = 0; i < r->items->len; i++) {
        TRY(add_section(r, i, html, letters, f));
        if (report_item_at(r, i)->command != NULL) {
            TRY(item_done(r, f));
        }
    }
    if (r->page != NULL) {
        g_string_append(html, "<script type=\"text/plain\" id=\"lab\">");
        g_string_append(html, r->page);
        g_string_append(html, "</script>\n");
    }
    g_string_append(html, "<script>\n");
    g_string_append(html, uPlot_iife_min_js);
    g_string_append(html, report_js);
    g_string_append(html, "</script>\n</body>\n</html>\n");

    // and the file
    TRY(whole_file_open(&file, path, f));
    fwrite(html->str, 1, html->len, file.stream);
    return whole_file_commit(&file, f);
}

// ==== what it shows

// Every figure and table of the catalogue.
static status add_catalogue(report_content *r, fault *f)
{
    const figure_options options = {0};

    for (int i = 0; i < thesis_figure_count(); i++) {
        const thesis_figure *which = thesis_figure_at(i);
        report_item item = {.scenario = which->scenario, .model = which->model};
        TRY(figure_open(which, &options, &item.drawn, f));
        item.command = text_printf("impactlab figures %s", which->id);
        if (r->page != NULL && which->scenario != NULL && item.drawn.plotted != NULL) {
            item.live = text_printf("scenario=%s", which->scenario);
        }
        g_array_append_val(r->items, item);
        TRY(item_done(r, f));
    }
    return STATUS_OK;
}

// The defaults of both models, a table for each group.
static void add_parameters(report_content *r)
{
    for (int i = 0; i < parameter_count;) {
        const report_item item = {.model = "defaults of both models",
                                  .drawn = artwork_of_table(defaults_table(&i))};
        g_array_append_val(r->items, item);
    }
}

static void clear_item(gpointer data)
{
    report_item *item = data;
    artwork_finish(&item->drawn);
    g_free(item->command);
    g_free(item->live);
}

// ---- scenarios and recipes of one's own

// What the page opens for a scenario: its file, as it knows shipped ones only. NULL if
// that cannot be read.
static char *live_scenario(const scenario *s)
{
    g_autofree char *text = NULL;
    gsize length = 0;
    if (!g_file_get_contents(s->file, &text, &length, NULL)) {
        return NULL;
    }
    g_autofree char *code = g_base64_encode((const guchar *)text, length);
    g_autofree char *escaped = g_uri_escape_string(code, NULL, false);
    g_autofree char *name = g_uri_escape_string(s->name, "/", false);
    return text_printf("scenario=%s&amp;text=%s", name, escaped);
}

// A scenario of one's own, with its usual panels.
static status open_scenario_item(report_item *item, const char *name,
                                 const report_content *r, fault *f)
{
    const scenario *s;
    TRY(scenario_figure_open(name, r->monitor, &item->drawn, &s, f));
    item->scenario = s->name;
    if (s->parameters.arm.model == ARM_PRINTED) {
        item->model = "printed";
    } else {
        item->model = "corrected";
    }
    item->command = text_printf("impactlab run %s --plot FILE.pdf", name);
    if (r->page != NULL) {
        item->live = live_scenario(s);
    }
    return STATUS_OK;
}

// A figure that a recipe describes.
static status open_recipe_item(report_item *item, const char *path, fault *f)
{
    const figure_options options = {0};
    fault first = {0};
    status code = recipe_open(path, &options, keep_first_fault, &first, &item->drawn, f);
    if (code != STATUS_OK) {
        if (first.code != STATUS_OK) {
            return fault_set(f, code, "%s", first.text);
        }
        return code;
    }
    item->model = "as in the recipe";
    item->command = text_printf("impactlab plot %s -o FILE.pdf", path);
    return STATUS_OK;
}

// Scenarios and recipes by their names.
static status add_named(report_content *r, char *const *names, int count, fault *f)
{
    for (int i = 0; i < count; i++) {
        report_item item = {0};
        if (recipe_is(names[i])) {
            TRY(open_recipe_item(&item, names[i], f));
        } else {
            TRY(open_scenario_item(&item, names[i], r, f));
        }
        g_array_append_val(r->items, item);
        TRY(item_done(r, f));
    }
    return STATUS_OK;
}

// ---- the whole

// Takes the lab's page into the report.
static status read_page(report_content *r, const char *path, fault *f)
{
    g_autofree char *page = NULL;
    gsize length = 0;
    if (!g_file_get_contents(path, &page, &length, NULL)) {
        return fault_set(
            f, STATUS_CANNOT_READ,
            "the lab's page %s cannot be read, 'ninja -C build web' makes it", path);
    }
    r->page = g_base64_encode((const guchar *)page, length);
    return STATUS_OK;
}

// Fills the report with the items that are named, or with the catalogue where none is,
// and writes it into a folder, as HTML and as PDF.
static status write_both(report_content *r, const char *folder,
                         const report_request *what, fault *f)
{
    if (what->page != NULL) {
        TRY(read_page(r, what->page, f));
    }

    // what was asked for, or all there is
    if (what->count > 0) {
        TRY(add_named(r, what->names, what->count, f));
    } else {
        TRY(add_catalogue(r, f));
        add_parameters(r);
    }

    // both files
    g_autofree char *html = g_strconcat(folder, "/report.html", NULL);
    g_autofree char *pdf = g_strconcat(folder, "/report.pdf", NULL);
    TRY(make_folder(folder, f));
    TRY(write_html(r, html, f));
    return write_pdf(r, pdf, f);
}

static const char preface_of_thesis[] =
    "Every figure and table of the thesis on impact and force control of a flexible "
    "arm, drawn by the lab from its own runs. Below each are its scenario, its model and "
    "the command that reproduces it.";
static const char preface_of_names[] =
    "Runs and recipes, drawn by the lab. Below each are its scenario, its model and the "
    "command that reproduces it.";

status report_write(const char *folder, const report_request *what, run_monitor *monitor,
                    fault *f)
{
    assert(what->names != NULL || what->count == 0);
    fault why = {0};
    g_autoptr(GArray) items = g_array_new(FALSE, TRUE, sizeof(report_item));
    g_array_set_clear_func(items, clear_item);
    g_autofree char *heading = g_strconcat("impactlab ", lab_version(), ": report", NULL);

    report_content r = {.monitor = monitor,
                        .items = items,
                        .heading = heading,
                        .preface = preface_of_thesis};
    if (what->count > 0) {
        r.preface = preface_of_names;
    }
    const status code = write_both(&r, folder, what, &why);
    g_free(r.page);
    if (code == STATUS_OK) {
        return code;
    }

    // The fault keeps its sentence, but not its place in a file: that may be a scenario
    // of the catalogue, which the caller has not named.
    return fault_set(f, code, "%s", why.text);
}
