// The report as a PDF with outline, links and page numbers.
#include "render/figures/report_parts.h"

#include <cairo-pdf.h>
#include <math.h>

#include "render/page/palette.h"
#include "render/page/sketch.h"
#include "render/page/text.h"

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
    put_text(cr, context, r->preface, 9, false, PAGE_MARGIN, y + 40);

    // the items by title and page, each a link
    y += 92;
    double step = fmin(12, (PAGE_HEIGHT - PAGE_MARGIN - y) / r->items->len);
    for (guint i = 0; i < r->items->len; i++, y += step) {
        const report_item *item = report_item_at(r, i);
        char *title = text_escape(item->drawn.title), page[16];
        char *target = g_strdup_printf("dest='item-%u'", i);
        g_snprintf(page, sizeof page, "%d", item->page);
        cairo_tag_begin(cr, CAIRO_TAG_LINK, target);
        put_text(cr, context, title, fmin(8, 0.7 * step), false, PAGE_MARGIN, y);
        put_text(cr, context, page, fmin(8, 0.7 * step), false, PAGE_WIDTH - PAGE_MARGIN - 14, y);
        cairo_tag_end(cr, CAIRO_TAG_LINK);
        g_free(target);
        g_free(title);
    }
}

// The place that the table of contents and the outline lead to.
static void mark_item(cairo_t *cr, const report_item *item, guint index)
{
    cairo_surface_t *surface = cairo_get_target(cr);
    char *place = g_strdup_printf("name='item-%u'", index);
    char *target = g_strdup_printf("dest='item-%u'", index);
    cairo_tag_begin(cr, CAIRO_TAG_DEST, place);
    cairo_tag_end(cr, CAIRO_TAG_DEST);
    if (cairo_surface_get_type(surface) == CAIRO_SURFACE_TYPE_PDF) {
        cairo_pdf_surface_add_outline(surface, CAIRO_PDF_OUTLINE_ROOT, item->drawn.title, target,
                                      0);
    }
    g_free(target);
    g_free(place);
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
        const report_item *item = report_item_at(page->report, i);
        double scale = item_scale(item);
        mark_item(cr, item, i);
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
            room -= item_height(report_item_at(r, i)) + ITEM_SPACE;
            report_item_at(r, i)->page = page.number + 1;
            i++;
        } while (i < r->items->len && room >= item_height(report_item_at(r, i)));

        page.last = i;
        g_array_append_val(pages, page);
    }
    return pages;
}

status report_write_pdf(const report *r, const char *path, fault *f)
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
