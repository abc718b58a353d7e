// The report as a PDF with outline, links and page numbers.
#include "render/figures/report.h"

#include <assert.h>
#include <cairo-pdf.h>
#include <math.h>
#include <string.h>

#include "render/figures/figures.h"
#include "src/base/shipped.h"

// A4 [pt].
#define PAGE_WIDTH  595.0
#define PAGE_HEIGHT 842.0
#define PAGE_MARGIN 50.0
#define FACTS_SPACE 14.0 // for the line under an item
#define ITEM_SPACE  16.0

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

static void put_text(cairo_t *cr, PangoContext *context, const char *markup, double size, bool bold,
                     double x, double y)
{
    text_block t = {markup, size, .bold = bold, .width = PAGE_WIDTH - PAGE_MARGIN - x};
    text_put(cr, context, &t, x, y, (anchor){0, 0}, palette_of(THEME_COLOUR)->text);
}

static void put_title_page(cairo_t *cr, PangoContext *context, const report_content *r)
{
    double y = 120;
    put_text(cr, context, r->heading, 18, true, PAGE_MARGIN, y);
    put_text(cr, context, r->preface, 9, false, PAGE_MARGIN, y + 40);

    // the items by title and page, each a link
    y += 92;
    double step = fmin(12, (PAGE_HEIGHT - PAGE_MARGIN - y) / r->items->len);
    for (guint i = 0; i < r->items->len; i++, y += step) {
        const report_item *item = report_item_at(r, i);
        g_autofree char *title = text_escape(item->drawn.title);
        g_autofree char *page = text_printf("%d", item->page);
        g_autofree char *target = text_printf("dest='item-%u'", i);
        cairo_tag_begin(cr, CAIRO_TAG_LINK, target);
        put_text(cr, context, title, fmin(8, 0.7 * step), false, PAGE_MARGIN, y);
        put_text(cr, context, page, fmin(8, 0.7 * step), false, PAGE_WIDTH - PAGE_MARGIN - 14, y);
        cairo_tag_end(cr, CAIRO_TAG_LINK);
    }
}

static status paint_page(cairo_t *cr, const void *what, fault *f)
{
    const report_page *page = what;
    TRY(text_check_font(f));
    double y = PAGE_MARGIN;
    g_autoptr(PangoContext) context = text_context_create();
    if (page->number == 0) {
        put_title_page(cr, context, page->report);
    }

    for (guint i = page->first; i < page->last; i++) {
        const report_item *item = report_item_at(page->report, i);
        double scale = item_scale(item);

        // the place that the table of contents and the outline lead to
        cairo_surface_t *surface = cairo_get_target(cr);
        g_autofree char *place = text_printf("name='item-%u'", i);
        g_autofree char *target = text_printf("dest='item-%u'", i);
        cairo_tag_begin(cr, CAIRO_TAG_DEST, place);
        cairo_tag_end(cr, CAIRO_TAG_DEST);
        if (cairo_surface_get_type(surface) == CAIRO_SURFACE_TYPE_PDF) {
            cairo_pdf_surface_add_outline(surface, CAIRO_PDF_OUTLINE_ROOT, item->drawn.title,
                                          target, 0);
        }
        cairo_save(cr);
        cairo_translate(cr, PAGE_MARGIN, y);
        cairo_scale(cr, scale, scale);
        TRY(artwork_paint(&item->drawn, cr, NULL, f));
        cairo_restore(cr);
        g_autoptr(GString) facts = g_string_new(NULL);
        report_add_facts(facts, item, "  ", "b");
        put_text(cr, context, facts->str, 7, false, PAGE_MARGIN + SKETCH_MARGIN,
                 y + item->drawn.height * scale + 2);
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

static status write_pdf(const report_content *r, const char *path, fault *f)
{
    g_autoptr(GArray) pages = make_pages(r);
    g_autofree picture *pictures = g_new0(picture, pages->len);

    for (guint i = 0; i < pages->len; i++) {
        pictures[i] = (picture){r->heading,          PAGE_WIDTH,
                                PAGE_HEIGHT,         .software = r->heading,
                                .paint = paint_page, .what = &g_array_index(pages, report_page, i)};
    }

    return picture_write_pages(pictures, (int)pages->len, path, f);
}

// ---- what it shows

static status add_figures(report_content *r, fault *f)
{
    const figure_options options = {0};

    for (int i = 0; i < thesis_figure_count(); i++) {
        const thesis_figure *which = thesis_figure_at(i);
        report_item item = {.scenario = which->scenario, .model = which->model};
        TRY(figure_open(which, &options, &item.drawn, f));
        item.command = text_printf("impactlab figures %s", which->id);
        g_array_append_val(r->items, item);
        TRY(report_item_done(r, f));
    }
    return STATUS_OK;
}

// The defaults of both models, a table for each group "arm", "motor" ...
static void add_parameters(report_content *r)
{
    parameters corrected, printed;
    parameters_defaults(&corrected, ARM_CORRECTED);
    parameters_defaults(&printed, ARM_PRINTED);
    parameters_resolve(&corrected, NULL);
    parameters_resolve(&printed, NULL);

    // a table for each group
    static const table_column columns[] = {
        {"Parameter", 3.7}, {"Corrected", 1.1}, {"Printed", 1.1}, {"Unit", 0.9}, {"Meaning", 3.2}};
    for (int i = 0; i < parameter_count;) {
        const char *group = parameter_table[i].path;
        size_t length = strcspn(group, ".");
        g_autofree char *title = text_printf("Parameters: %.*s", (int)length, group);
        table_page *t = table_create(title, columns, G_N_ELEMENTS(columns));

        for (; i < parameter_count && strncmp(parameter_table[i].path, group, length + 1) == 0;
             i++) {
            const parameter_info *info = &parameter_table[i];
            char own[128], theirs[128];
            parameter_format(&corrected, i, own, sizeof own);
            parameter_format(&printed, i, theirs, sizeof theirs);
            g_autofree char *unit = text_unit(info->unit);
            g_auto(GStrv) cells = g_new0(char *, 6);
            const char *const texts[] = {info->path, own, theirs, unit, info->description};
            for (size_t k = 0; k < G_N_ELEMENTS(texts); k++) {
                cells[k] = text_escape(texts[k]);
            }
            table_add_row(t, (const char *const *)cells);
        }

        report_item item = {.model = "defaults of both models", .drawn = artwork_of_table(t)};
        g_array_append_val(r->items, item);
    }
}

static void clear_item(gpointer data)
{
    report_item *item = data;
    artwork_finish(&item->drawn);
    g_free(item->command);
}

// ---- scenarios and recipes of one's own

static status open_scenario(report_item *item, const char *name, run_monitor *monitor, fault *f)
{
    const scenario *s;
    TRY(scenario_figure_open(name, monitor, &item->drawn, &s, f));
    item->scenario = s->name;
    item->model = s->parameters.arm.model == ARM_PRINTED ? "printed" : "corrected";
    item->command = text_printf("impactlab run %s --plot FILE.pdf", name);
    return STATUS_OK;
}

static status open_recipe(report_item *item, const char *path, fault *f)
{
    const figure_options options = {0};
    fault first = {0};
    status code = recipe_open(path, &options, keep_first_fault, &first, &item->drawn, f);
    if (code != STATUS_OK) {
        return first.code != STATUS_OK ? fault_set(f, code, "%s", first.text) : code;
    }
    item->model = "as the recipe says";
    item->command = text_printf("impactlab plot %s -o FILE.pdf", path);
    return STATUS_OK;
}

static status add_own(report_content *r, char *const *names, int count, fault *f)
{
    for (int i = 0; i < count; i++) {
        report_item item = {0};
        TRY(recipe_is(names[i]) ? open_recipe(&item, names[i], f)
                                : open_scenario(&item, names[i], r->monitor, f));
        g_array_append_val(r->items, item);
        TRY(report_item_done(r, f));
    }
    return STATUS_OK;
}

// ---- the whole

// Fills the report and writes both files.
static status write_both(report_content *r, const char *folder, char *const *names, int count,
                         fault *f)
{
    // what was asked for, or all there is
    TRY(count > 0 ? add_own(r, names, count, f) : add_figures(r, f));
    if (count == 0) {
        add_parameters(r);
    }
    g_autofree char *html = g_strconcat(folder, "/report.html", NULL);
    g_autofree char *pdf = g_strconcat(folder, "/report.pdf", NULL);
    TRY(make_folder(folder, f));
    TRY(report_write_html(r, html, f));
    return write_pdf(r, pdf, f);
}

status report_write(const char *folder, char *const *names, int count, run_monitor *monitor,
                    fault *f)
{
    assert(names != NULL || count == 0);
    fault why = {0};
    g_autoptr(GArray) items = g_array_new(FALSE, TRUE, sizeof(report_item));
    g_autofree char *heading = g_strconcat("impactlab ", lab_version(), ": report", NULL);
    report_content r = {.monitor = monitor, .items = items, .heading = heading};
    r.preface = count > 0
                    ? "Runs and recipes, drawn by the lab. Under each stand the scenario, the "
                      "model and the one command that makes it again."
                    : "Every figure and table of the thesis on impact and force control of a "
                      "flexible arm, drawn by the lab from its own runs. Under each stand the "
                      "scenario, the model and the one command that makes it again.";
    g_array_set_clear_func(items, clear_item);
    const status code = write_both(&r, folder, names, count, &why);
    return code == STATUS_OK ? code : fault_set(f, code, "%s", why.text);
}
