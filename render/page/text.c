// Setting of texts with Pango: fonts, layouts, drawing.
#include "render/page/text.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "render/page/page.h"
#include "src/base/words.h"

// Whether a font of the family is installed.
static bool family_is_there(const char *family)
{
    PangoFontFamily **families = NULL;
    int count = 0;
    bool there = false;
    pango_font_map_list_families(pango_cairo_font_map_get_default(), &families, &count);
    for (int i = 0; i < count && !there; i++) {
        there = g_ascii_strcasecmp(pango_font_family_get_name(families[i]), family) == 0;
    }
    g_free(families);
    return there;
}

status text_check_font(fault *f)
{
    // asked once, by whichever thread comes first: a process does not see fonts come and
    // go
    enum { THERE = 1, MISSING };
    static gsize known;
    if (g_once_init_enter(&known)) {
        const bool there = family_is_there(TEXT_FAMILY);
        g_once_init_leave(&known, there ? THERE : MISSING);
    }

    // only the answer is kept, each caller gets the words
    FAULT_IF(known == MISSING, f, STATUS_CANNOT_READ,
             "the font " TEXT_FAMILY " is not installed, figures need it: install "
             "fonts-dejavu-core");
    return STATUS_OK;
}

status text_check_family(const char *family, fault *f)
{
    const bool there = family_is_there(family);
    FAULT_IF(!there, f, STATUS_BAD_ARGUMENT, "the font '%s' is not installed", family);
    return STATUS_OK;
}

// A context in which letters do not depend on what they are drawn on.
PangoContext *text_context_create(void)
{
    PangoContext *context =
        pango_font_map_create_context(pango_cairo_font_map_get_default());
    cairo_font_options_t *options = cairo_font_options_create();
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    pango_cairo_context_set_font_options(context, options);

    cairo_font_options_destroy(options);
    pango_context_set_round_glyph_positions(context, FALSE);
    pango_cairo_context_set_resolution(context, 72);
    return context;
}

// Narrows a layout of several lines as far as their number allows.
static void balance(PangoLayout *layout, double width)
{
    const int lines = pango_layout_get_line_count(layout);
    double narrow = width / 2, wide = width;
    while (lines > 1 && wide - narrow > 1) {
        double middle = (narrow + wide) / 2;
        pango_layout_set_width(layout, (int)(middle * PANGO_SCALE));
        if (pango_layout_get_line_count(layout) > lines) {
            narrow = middle;
        } else {
            wide = middle;
        }
    }
    pango_layout_set_width(layout, (int)(wide * PANGO_SCALE));
}

char *text_plain(const char *markup)
{
    g_autofree char *valid = text_printable(markup);
    char *plain = NULL;
    if (!pango_parse_markup(valid, -1, 0, NULL, &plain, NULL, NULL)) {
        return g_steal_pointer(&valid);
    }

    // an entity may have become what the markup did not hold
    make_printable(plain, '\n');
    return plain;
}

// Sets the font, then the words, then how lines are broken.
PangoLayout *text_layout_create(PangoContext *context, const text_block *t)
{
    static const PangoAlignment alignments[] = {PANGO_ALIGN_LEFT, PANGO_ALIGN_CENTER,
                                                PANGO_ALIGN_RIGHT};

    PangoLayout *layout = pango_layout_new(context);
    PangoFontDescription *font = pango_font_description_new();
    pango_font_description_set_family(font, text_or(t->family, TEXT_FAMILY));
    pango_font_description_set_size(font, (int)(t->size * PANGO_SCALE));
    if (t->bold) {
        pango_font_description_set_weight(font, PANGO_WEIGHT_BOLD);
    }
    pango_layout_set_font_description(layout, font);
    pango_font_description_free(font);

    // text that is no markup is shown as it is
    g_autofree char *valid = text_printable(t->markup);
    g_autofree char *markup = text_translate(valid, t->size);
    if (pango_parse_markup(markup, -1, 0, NULL, NULL, NULL, NULL)) {
        pango_layout_set_markup(layout, markup, -1);
    } else {
        pango_layout_set_text(layout, valid, -1);
    }

    pango_layout_set_alignment(layout, alignments[t->align]);
    // lines stand alike, with raised letters in them or not
    pango_layout_set_line_spacing(layout, t->leading > 0 ? (float)t->leading : 1);
    if (t->width > 0) {
        pango_layout_set_width(layout, (int)(t->width * PANGO_SCALE));
        pango_layout_set_wrap(layout, PANGO_WRAP_WORD_CHAR);
        if (t->balanced) {
            balance(layout, t->width);
        }
    }
    return layout;
}

text_size text_measure(PangoContext *context, const text_block *t)
{
    PangoRectangle logical;
    PangoLayout *layout = text_layout_create(context, t);
    pango_layout_get_extents(layout, NULL, &logical);
    g_object_unref(layout);
    return (text_size){(double)logical.width / PANGO_SCALE,
                       (double)logical.height / PANGO_SCALE};
}

// Measures the text, moves it so that its anchor is at (x, y), and draws it.
figure_rect text_put(cairo_t *cr, PangoContext *context, const text_block *t, double x,
                     double y, anchor part, colour c)
{
    assert(isfinite(x) && isfinite(y));
    PangoRectangle logical;
    const text_size size = text_measure(context, t);
    x -= part.x * size.width;
    y -= part.y * size.height;

    set_colour(cr, c);
    cairo_move_to(cr, x, y);
    // the context has to know whether cr is rotated
    pango_cairo_update_context(cr, context);
    PangoLayout *layout = text_layout_create(context, t);
    pango_layout_get_extents(layout, NULL, &logical);
    // lines that are not set left begin somewhere inside the layout
    cairo_rel_move_to(cr, -(double)logical.x / PANGO_SCALE, 0);
    pango_cairo_show_layout(cr, layout);
    g_object_unref(layout);
    return (figure_rect){x, y, size.width, size.height};
}

double page_letters(double letters, double size)
{
    double scaled = size * (letters > 0 ? letters / LETTERS_NORMAL : 1);
    if (scaled > LETTERS_LEAST) {
        return scaled;
    }
    return LETTERS_LEAST;
}

// Keeps the beginning of a text with its place and the size of its letters.
void report_add_text(figure_report *report, const char *markup, double size,
                     figure_rect place)
{
    if (report == NULL || report->text_count == FIGURE_TEXTS) {
        return;
    }

    figure_text *t = &report->texts[report->text_count++];
    g_autofree char *plain = text_plain(markup);
    const char *end;

    // as it is on the page
    t->place = place;
    t->size = size;
    g_strlcpy(t->text, plain, sizeof t->text);

    // a character that was cut in two is removed
    if (!g_utf8_validate(t->text, -1, &end)) {
        t->text[end - t->text] = '\0';
    }
}
