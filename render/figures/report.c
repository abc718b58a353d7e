#include "render/figures/report.h"

#include <assert.h>
#include <glib.h>
#include <math.h>
#include <string.h>

#include "render/figures/figures.h"
#include "render/page/svg_ids.h"
#include "src/base/whole_file.h"
#include "src/base/version.h"

// One thing the report shows.
typedef struct report_item {
    const char *file, *scenario, *model; // scenario may be NULL
    char *command;                       // NULL: nothing to run
    artwork drawn;
} report_item;

typedef struct report {
    GArray *items; // of report_item
    char *heading;
} report;

static report_item *item_at(const report *r, guint index)
{
    return &g_array_index(r->items, report_item, index);
}

// ---- what it shows

static status add_figures(report *r, fault *f)
{
    const figure_options options = {0};

    for (int i = 0; i < thesis_figure_count; i++) {
        const thesis_figure *which = &thesis_figures[i];
        report_item item = {
            .file = which->file, .scenario = which->scenario, .model = which->model};
        status code = figure_open(which, &options, &item.drawn, f);
        if (code != STATUS_OK) {
            return code;
        }

        item.command = g_strdup_printf("impactlab figures %s", which->id);
        g_array_append_val(r->items, item);
    }
    return STATUS_OK;
}

static status paint_table(cairo_t *cr, const void *what, figure_report *seen, fault *f)
{
    return table_paint(cr, what, seen, f);
}

static void release_table(void *what)
{
    table_finish(what);
    g_free(what);
}

static void add_parameter_row(table_page *t, const parameter_info *info, int index,
                              const parameters *corrected, const parameters *printed)
{
    char values[2][128], unit[64];
    parameter_format(corrected, index, values[0], sizeof values[0]);
    parameter_format(printed, index, values[1], sizeof values[1]);
    text_unit(info->unit, unit, sizeof unit);
    char *cells[] = {text_escape(info->path), text_escape(values[0]), text_escape(values[1]),
                     text_escape(unit), text_escape(info->description)};
    table_add_row(t, (const char *const *)cells);
    for (size_t i = 0; i < G_N_ELEMENTS(cells); i++) {
        g_free(cells[i]);
    }
}

static table_page *new_parameter_table(const char *group, size_t length)
{
    table_page *t = g_new0(table_page, 1);
    char *title = g_strdup_printf("Parameters: %.*s", (int)length, group);
    table_begin(t, title);
    table_add_column(t, "Parameter", 3.7, TEXT_LEFT);
    table_add_column(t, "Corrected", 1.1, TEXT_LEFT);
    table_add_column(t, "Printed", 1.1, TEXT_LEFT);
    table_add_column(t, "Unit", 0.9, TEXT_LEFT);
    table_add_column(t, "Meaning", 3.2, TEXT_LEFT);
    g_free(title);
    return t;
}

// The defaults of both models, a table for each group "arm", "motor" ...
static void add_parameters(report *r)
{
    parameters corrected, printed;
    parameters_defaults(&corrected, ARM_CORRECTED);
    parameters_defaults(&printed, ARM_PRINTED);
    parameters_resolve(&corrected, NULL);
    parameters_resolve(&printed, NULL);

    // a table for each group
    for (int i = 0; i < parameter_count;) {
        const char *group = parameter_table[i].path;
        size_t length = strcspn(group, ".");
        table_page *t = new_parameter_table(group, length);
        for (; i < parameter_count && strncmp(parameter_table[i].path, group, length + 1) == 0;
             i++) {
            add_parameter_row(t, &parameter_table[i], i, &corrected, &printed);
        }

        report_item item = {.file = "parameters",
                            .model = "defaults of both models",
                            .drawn = {.title = t->title,
                                      .table = t,
                                      .what = t,
                                      .paint = paint_table,
                                      .release = release_table}};

        table_size(t, &item.drawn.width, &item.drawn.height);
        g_array_append_val(r->items, item);
    }
}

static void clear_item(gpointer data)
{
    report_item *item = data;
    artwork_finish(&item->drawn);
    g_free(item->command);
}

// ---- the web page

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
    "code{background:#f0f3f7;padding:.1rem .3rem}\n"
    "</style>\n</head>\n<body>\n<h1>%s</h1>\n"
    "<p>Every figure and table of the thesis on impact and force control of a flexible arm, drawn "
    "by the lab from its own runs. Under each stand the scenario, the model and the one command "
    "that makes it again. <q>Printed</q> is the thesis's model with its slips, "
    "<q>corrected</q> the mechanics derived anew.</p>\n";

static void add_contents(const report *r, GString *html)
{
    g_string_append(html, "<nav><ol>\n");
    for (guint i = 0; i < r->items->len; i++) {
        char *title = text_escape(item_at(r, i)->drawn.title);
        g_string_append_printf(html, "<li><a href=\"#item-%u\">%s</a></li>\n", i, title);
        g_free(title);
    }
    g_string_append(html, "</ol></nav>\n");
}

// The SVG as an element of the page: without the XML declaration, its ids made its own.
static status add_svg(GString *html, const report_item *item, guint index, fault *f)
{
    const figure_options options = {0};
    picture p = artwork_picture(&item->drawn, &options);

    // its own identifiers, as all figures stand in one page
    char *svg = picture_svg(&p, f);
    if (svg == NULL) {
        return f->code;
    }
    char *prefix = g_strdup_printf("i%u-", index);
    char *root = strstr(svg, "<svg"), *own = svg_prefix_ids(root ? root : svg, prefix);
    g_string_append(html, own);
    g_free(own);
    g_free(prefix);
    g_free(svg);
    return STATUS_OK;
}

static status add_section(const report *r, guint index, GString *html, fault *f)
{
    status code = STATUS_OK;
    const report_item *item = item_at(r, index);
    char *title = text_escape(item->drawn.title);
    g_string_append_printf(html, "<section id=\"item-%u\">\n<h2>%s</h2>\n", index, title);

    // the item itself
    if (item->drawn.table != NULL) {
        table_add_html(item->drawn.table, html);
    } else {
        code = add_svg(html, item, index, f);
    }

    // what it is made of, and how
    g_string_append_printf(html, "<p class=\"facts\">Model: %s.", item->model);
    if (item->scenario != NULL) {
        g_string_append_printf(html, " Scenario: %s.", item->scenario);
    }
    if (item->command != NULL) {
        g_string_append_printf(html, " Again: <code>%s</code>", item->command);
    }

    g_string_append(html, "</p>\n</section>\n");
    g_free(title);
    return code;
}

static status write_html(const report *r, const char *path, fault *f)
{
    whole_file file;
    status code = STATUS_OK;
    GString *html = g_string_new(NULL);

    // the whole page first: nothing is written of one that fails
    g_string_append_printf(html, page_head, r->heading, r->heading);
    add_contents(r, html);
    for (guint i = 0; i < r->items->len && code == STATUS_OK; i++) {
        code = add_section(r, i, html, f);
    }
    g_string_append(html, "</body>\n</html>\n");

    if (code == STATUS_OK) {
        code = whole_file_open(&file, path, f);
    }

    if (code == STATUS_OK) {
        fwrite(html->str, 1, html->len, file.stream);
        code = whole_file_commit(&file, f);
    }
    g_string_free(html, TRUE);
    return code;
}

// ---- the PDF

// A4 [pt].
#define PAGE_WIDTH  595.0
#define PAGE_HEIGHT 842.0
#define PAGE_MARGIN 50.0
#define FACTS_SPACE 14.0 // for the line under an item
#define ITEM_SPACE  16.0

// Items from first to last, one below the other.
typedef struct report_page {
    const report *report;
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

static void put_text(cairo_t *cr, PangoContext *context, const char *markup, double size, bool bold,
                     double x, double y)
{
    text_block t = {
        .markup = markup, .size = size, .bold = bold, .width = PAGE_WIDTH - PAGE_MARGIN - x};
    set_colour(cr, palette_of(THEME_COLOUR)->text);
    cairo_move_to(cr, x, y);
    text_draw(cr, context, &t);
}

static void put_facts(cairo_t *cr, PangoContext *context, const report_item *item, double y)
{
    GString *facts = g_string_new(NULL);
    g_string_printf(facts, "Model: %s.", item->model);
    if (item->scenario != NULL) {
        g_string_append_printf(facts, "  Scenario: %s.", item->scenario);
    }
    if (item->command != NULL) {
        g_string_append_printf(facts, "  Again: <b>%s</b>", item->command);
    }
    put_text(cr, context, facts->str, 7, false, PAGE_MARGIN + SKETCH_MARGIN, y);
    g_string_free(facts, TRUE);
}

static void put_title_page(cairo_t *cr, PangoContext *context, const report *r)
{
    double y = 120;
    put_text(cr, context, r->heading, 18, true, PAGE_MARGIN, y);
    put_text(cr, context,
             "Every figure and table of the thesis on impact and force control of a flexible arm, "
             "drawn by the lab from its own runs. Under each stand the scenario, the model and "
             "the one command that makes it again.",
             9, false, PAGE_MARGIN, y + 40);

    // the items by title
    y += 92;
    for (guint i = 0; i < r->items->len; i++, y += 12) {
        char *title = text_escape(item_at(r, i)->drawn.title);
        put_text(cr, context, title, 8, false, PAGE_MARGIN, y);
        g_free(title);
    }
}

static status paint_page(cairo_t *cr, const void *what, fault *f)
{
    const report_page *page = what;
    status code = text_check_font(f);
    if (code != STATUS_OK) {
        return code;
    }

    double y = PAGE_MARGIN;
    PangoContext *context = text_context_create();
    if (page->number == 0) {
        put_title_page(cr, context, page->report);
    }

    for (guint i = page->first; i < page->last && code == STATUS_OK; i++) {
        const report_item *item = item_at(page->report, i);
        double scale = item_scale(item);
        cairo_save(cr);
        cairo_translate(cr, PAGE_MARGIN, y);
        cairo_scale(cr, scale, scale);
        code = item->drawn.paint(cr, item->drawn.what, NULL, f);
        cairo_restore(cr);
        put_facts(cr, context, item, y + item->drawn.height * scale + 2);
        y += item_height(item) + ITEM_SPACE;
    }

    if (page->number > 0) {
        char number[16];
        g_snprintf(number, sizeof number, "%d", page->number + 1);
        put_text(cr, context, number, 8, false, PAGE_WIDTH / 2, PAGE_HEIGHT - 30);
    }
    g_object_unref(context);
    return code;
}

// Puts as many items on each page as there is room for.
static GArray *make_pages(const report *r)
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
            room -= item_height(item_at(r, i)) + ITEM_SPACE;
            i++;
        } while (i < r->items->len && room >= item_height(item_at(r, i)));

        page.last = i;
        g_array_append_val(pages, page);
    }
    return pages;
}

static status write_pdf(const report *r, const char *path, fault *f)
{
    GArray *pages = make_pages(r);
    picture *pictures = g_new0(picture, pages->len);

    for (guint i = 0; i < pages->len; i++) {
        pictures[i] = (picture){.width = PAGE_WIDTH,
                                .height = PAGE_HEIGHT,
                                .title = r->heading,
                                .software = r->heading,
                                .paint = paint_page,
                                .what = &g_array_index(pages, report_page, i)};
    }

    status code = picture_write_pages(pictures, (int)pages->len, path, f);
    g_free(pictures);
    g_array_free(pages, TRUE);
    return code;
}

// ---- the whole

static status write_both(const report *r, const char *folder, fault *f)
{
    char *html = g_strconcat(folder, "/report.html", NULL);
    char *pdf = g_strconcat(folder, "/report.pdf", NULL);
    status code = make_folder(folder, f);
    if (code == STATUS_OK) {
        code = write_html(r, html, f);
    }
    if (code == STATUS_OK) {
        code = write_pdf(r, pdf, f);
    }
    g_free(html);
    g_free(pdf);
    return code;
}

status report_write(const char *folder, fault *f)
{
    assert(folder != NULL);
    fault why = {0};
    report r = {.items = g_array_new(FALSE, TRUE, sizeof(report_item)),
                .heading = g_strconcat("impactlab ", lab_version(), ": report", NULL)};
    g_array_set_clear_func(r.items, clear_item);

    status code = add_figures(&r, &why);
    if (code == STATUS_OK) {
        add_parameters(&r);
        code = write_both(&r, folder, &why);
    }

    g_array_free(r.items, TRUE);
    g_free(r.heading);
    return code == STATUS_OK ? code : fault_set(f, code, "%s", why.text);
}
