#include "render/page/text.h"

#include <assert.h>
#include <errno.h>
#include <fontconfig/fontconfig.h>
#include <math.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "render/page/page.h"
#include "src/base/numbers.h"
#include "src/base/words.h"

#define INDEX_SIZE 0.72 // of its line's letters, but never too small to read

// For text_in_fonts: how deep this thread is in fontconfig or Pango, and whether Pango has begun to
// look for fonts, which it does on threads of its own.
static _Thread_local volatile sig_atomic_t in_fonts;
static atomic_bool has_context;

bool text_in_fonts(void)
{
    return in_fonts > 0 || (atomic_load(&has_context) && gettid() != getpid());
}

static bool family_matches(const char *wanted_family)
{
    FcPattern *wanted = FcPatternCreate();
    if (wanted == NULL) {
        return false;
    }

    FcPatternAddString(wanted, FC_FAMILY, (const FcChar8 *)wanted_family);
    FcConfigSubstitute(NULL, wanted, FcMatchPattern);
    FcDefaultSubstitute(wanted);

    // fontconfig always finds some font: is it of this family?
    FcResult result;
    FcPattern *found = FcFontMatch(NULL, wanted, &result);
    FcChar8 *family = NULL;
    bool matches = found != NULL &&
                   FcPatternGetString(found, FC_FAMILY, 0, &family) == FcResultMatch &&
                   g_ascii_strcasecmp((const char *)family, wanted_family) == 0;

    if (found != NULL) {
        FcPatternDestroy(found);
    }
    FcPatternDestroy(wanted);
    return matches;
}

status text_check_font(fault *f)
{
    // asked once, by whichever thread comes first: a process does not see fonts come and go
    enum { THERE = 1, MISSING };
    static gsize known;
    if (g_once_init_enter(&known)) {
        in_fonts++;
        FcFontSet *fonts = FcInit() ? FcConfigGetFonts(NULL, FcSetSystem) : NULL;
        bool there = fonts != NULL && fonts->nfont > 0 && family_matches(TEXT_FAMILY);
        in_fonts--;
        g_once_init_leave(&known, there ? THERE : MISSING);
    }

    // only the answer is kept, each caller gets the words
    if (known == MISSING) {
        return fault_set(f, STATUS_CANNOT_READ,
                         "the font " TEXT_FAMILY " is not installed, figures need it: install "
                         "fonts-dejavu-core");
    }
    return STATUS_OK;
}

status text_check_family(const char *family, fault *f)
{
    assert(family != NULL);
    in_fonts++;
    const bool there = FcInit() && family_matches(family);
    in_fonts--;
    if (!there) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "the font '%s' is not installed", family);
    }
    return STATUS_OK;
}

PangoContext *text_context_create(void)
{
    in_fonts++;
    atomic_store(&has_context, true);
    PangoContext *context = pango_font_map_create_context(pango_cairo_font_map_get_default());
    cairo_font_options_t *options = cairo_font_options_create();
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    pango_cairo_context_set_font_options(context, options);
    cairo_font_options_destroy(options);
    pango_context_set_round_glyph_positions(context, FALSE);
    pango_cairo_context_set_resolution(context, 72);
    in_fonts--;
    return context;
}

// Whether the word at `text` is a unit and ends there.
static bool is_unit(const char *text)
{
    static const char *const units[] = {"N",  "N·s", "N·m", "V", "A",   "s",  "ms",    "µs",
                                        "Hz", "kHz", "mm",  "m", "kg",  "J",  "mJ",    "rad",
                                        "dB", "%",   "Ω",   "W", "N s", "kΩ", "rad/s", "m/s"};

    // neither the start of a longer word nor the numerator of a longer unit
    for (size_t i = 0; i < G_N_ELEMENTS(units); i++) {
        size_t length = strlen(units[i]);
        bool ends = strncmp(text, units[i], length) == 0 && !g_ascii_isalnum(text[length]) &&
                    text[length] != '/' && (unsigned char)text[length] < 0x80;
        if (ends) {
            return true;
        }
    }
    return false;
}

// Whether the space at `space` joins what must stay in one line: a number and its unit, both sides
// of an equals sign, a name and the number after it.
static bool space_joins(const char *start, const char *space)
{
    bool equals = space[1] == '=' && space[2] == ' ';
    bool after_equals = space - start >= 2 && space[-1] == '=' && space[-2] == ' ';
    bool number = space > start && g_ascii_isdigit(space[-1]) && is_unit(space + 1);
    bool version = space > start && g_ascii_isalpha(space[-1]) && g_ascii_isdigit(space[1]) &&
                   strchr(space + 1, '.') != NULL &&
                   strspn(space + 1, "0123456789") == strcspn(space + 1, ".");
    bool figure = space - start >= 4 && strncmp(space - 4, "Fig.", 4) == 0;
    return equals || after_equals || number || version || figure;
}

// Whether the slash at `slash` stands before the last part of a unit: "N·m/rad", "m/s²".
static bool slash_joins(const char *start, const char *slash)
{
    static const char *const lower[] = {"rad", "s", "m", "V", "A", "N"};

    // a path has longer words
    bool after_letter = slash > start && g_ascii_isalpha(slash[-1]);
    for (size_t i = 0; i < G_N_ELEMENTS(lower); i++) {
        size_t length = strlen(lower[i]);
        if (after_letter && strncmp(slash + 1, lower[i], length) == 0 &&
            !g_ascii_isalpha(slash[1 + length])) {
            return true;
        }
    }
    return false;
}

// Length of a typewriter's apostrophe within a word ("Newmark's", or as g_markup_escape_text writes
// it) that begins at `mark`; 0 if none does.
static size_t apostrophe_length(const char *start, const char *mark)
{
    size_t length = *mark == '\'' ? 1 : strncmp(mark, "&apos;", 6) == 0 ? 6 : 0;
    length = strncmp(mark, "&#39;", 5) == 0 ? 5 : length;
    bool within = mark > start && g_ascii_isalpha(mark[-1]) && g_ascii_isalpha(mark[length]);
    return within ? length : 0;
}

// Size of an index in a line of letters of the given size [pt].
static double index_letters(double size)
{
    return fmax(INDEX_SIZE * size, fmin(size, LETTERS_LEAST));
}

char *text_translate(const char *markup, double size, double scale)
{
    assert(markup != NULL && size > 0 && scale > 0);
    GString *out = g_string_new(NULL);

    bool in_tag = false;
    for (const char *c = markup; *c != '\0';) {
        in_tag = *c == '<' || (in_tag && *c != '>');
        bool lowered = strncmp(c, "<sub>", 5) == 0, raised = strncmp(c, "<sup>", 5) == 0;
        if (lowered || raised) {
            // in 1/1024 of a point, which every version of Pango understands
            double small = index_letters(size * scale) / scale;
            g_string_append_printf(out, "<span size=\"%d\" rise=\"%d\">", (int)(small * 1024),
                                   (int)((raised ? 0.35 : -0.2) * size * 1024));
            in_tag = false;
            c += 5;
        } else if (strncmp(c, "</sub>", 6) == 0 || strncmp(c, "</sup>", 6) == 0) {
            g_string_append(out, "</span>");
            in_tag = false;
            c += 6;
        } else if (strncmp(c, "\u2009", 3) == 0) {
            // a thin space stands between a number and its unit: its twin that does not break
            g_string_append(out, "\u202f");
            c += 3;
        } else if (*c == ' ' && !in_tag && space_joins(markup, c)) {
            g_string_append(out, "\u00a0");
            c++;
        } else if (!in_tag && apostrophe_length(markup, c) > 0) {
            g_string_append(out, "\u2019");
            c += apostrophe_length(markup, c);
        } else if (*c == '/' && !in_tag && slash_joins(markup, c)) {
            // a word joiner: no line ends after the slash
            g_string_append(out, "/\u2060");
            c++;
        } else {
            g_string_append_c(out, *c++);
        }
    }
    return g_string_free(out, FALSE);
}

// Any bytes as valid UTF-8 of printable characters and line feeds.
static char *printable_copy(const char *bytes)
{
    char *valid = g_utf8_make_valid(bytes, -1);
    make_lines_printable(valid);
    return valid;
}

static char *translated(const text_block *t, const char *markup)
{
    return text_translate(markup, t->size, t->scale > 0 ? t->scale : 1);
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

PangoLayout *text_layout_create(PangoContext *context, const text_block *t)
{
    assert(context != NULL && t != NULL && t->markup != NULL);
    static const PangoAlignment alignments[] = {PANGO_ALIGN_LEFT, PANGO_ALIGN_CENTER,
                                                PANGO_ALIGN_RIGHT};

    in_fonts++;
    PangoLayout *layout = pango_layout_new(context);
    PangoFontDescription *font = pango_font_description_new();
    pango_font_description_set_family(font, t->family != NULL ? t->family : TEXT_FAMILY);
    pango_font_description_set_size(font, (int)(t->size * PANGO_SCALE));
    pango_font_description_set_weight(font, t->bold ? PANGO_WEIGHT_BOLD : PANGO_WEIGHT_NORMAL);
    pango_layout_set_font_description(layout, font);
    pango_font_description_free(font);

    // text that is no markup is shown as it is
    char *valid = printable_copy(t->markup), *markup = translated(t, valid);
    if (pango_parse_markup(markup, -1, 0, NULL, NULL, NULL, NULL)) {
        pango_layout_set_markup(layout, markup, -1);
    } else {
        pango_layout_set_text(layout, valid, -1);
    }
    g_free(markup);
    g_free(valid);

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
    in_fonts--;
    return layout;
}

// HarfBuzz sets letters elsewhere where it finds no memory, and tells nobody: what an allocation
// leaves in errno does. Shaping stands between the two; without memory the program ends as by GLib.
static void begin_shaping(void)
{
    in_fonts++;
    errno = 0;
}

static void end_shaping(void)
{
    in_fonts--;
    if (errno == ENOMEM) {
        g_error("out of memory");
    }
}

void text_measure(PangoContext *context, const text_block *t, double *width, double *height)
{
    assert(context != NULL && t != NULL && t->markup != NULL);
    PangoRectangle logical;
    begin_shaping();
    PangoLayout *layout = text_layout_create(context, t);
    pango_layout_get_extents(layout, NULL, &logical);
    end_shaping();
    *width = (double)logical.width / PANGO_SCALE;
    *height = (double)logical.height / PANGO_SCALE;
    g_object_unref(layout);
}

double text_draw(cairo_t *cr, PangoContext *context, const text_block *t)
{
    assert(cr != NULL && context != NULL && t != NULL && t->markup != NULL);
    PangoRectangle logical;
    begin_shaping();
    // the context has to know whether cr is rotated
    pango_cairo_update_context(cr, context);
    PangoLayout *layout = text_layout_create(context, t);
    pango_layout_get_extents(layout, NULL, &logical);
    // lines that are not set left begin somewhere inside the layout
    cairo_rel_move_to(cr, -(double)logical.x / PANGO_SCALE, 0);
    pango_cairo_show_layout(cr, layout);
    g_object_unref(layout);
    end_shaping();
    return (double)logical.width / PANGO_SCALE;
}

void text_unit(const char *unit, char *out, size_t size)
{
    assert(unit != NULL && out != NULL && size > 0);
    static const char *const powers[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                         "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};

    GString *shown = g_string_new(NULL);
    for (const char *c = unit; *c != '\0'; c++) {
        bool after_letter = c > unit && (g_ascii_isalpha(c[-1]) || g_ascii_isdigit(c[-1]));
        if (*c == ' ') {
            g_string_append(shown, "\u00b7");
        } else if (g_ascii_isdigit(*c)) {
            g_string_append(shown, powers[*c - '0']);
        } else if (*c == '-' && after_letter && g_ascii_isdigit(c[1])) {
            g_string_append(shown, "\u207b");
        } else {
            g_string_append_c(shown, *c);
        }
    }

    g_strlcpy(out, shown->str, size);
    g_string_free(shown, TRUE);
}

char *text_quantity(double value, int digits, const char *unit)
{
    assert(unit != NULL && digits > 0);
    char number[48], shown[64];
    decimal_print(number, sizeof number, "%#.*g", digits, fabs(value));
    size_t length = strlen(number);
    if (length > 0 && number[length - 1] == '.') {
        number[length - 1] = '\0';
    }
    text_unit(unit, shown, sizeof shown);
    return g_strdup_printf("%s%s\u2009%s", value < 0 ? "\u2212" : "", number, shown);
}

char *text_number(double value, int digits)
{
    assert(digits > 0);
    char number[48];
    const char *sign = value < 0 ? "\u2212" : "";
    decimal_print(number, sizeof number, "%.*g", digits, fabs(value));
    char *exponent = strchr(number, 'e');
    if (exponent == NULL) {
        return g_strdup_printf("%s%s", sign, number);
    }

    // mantissa and power of ten; a mantissa of 1 goes without saying
    int power = atoi(exponent + 1);
    *exponent = '\0';
    bool one = strcmp(number, "1") == 0;
    return g_strdup_printf("%s%s%s10<sup>%s%d</sup>", sign, one ? "" : number, one ? "" : "\u00b7",
                           power < 0 ? "\u2212" : "", abs(power));
}

char *text_label(const char *description)
{
    assert(description != NULL);
    char *valid = g_utf8_make_valid(description, -1);
    char *label = g_strndup(valid, strcspn(valid, ",:;("));
    g_strchomp(label);
    gunichar first = g_utf8_get_char(label);
    char letter[8] = "";
    letter[g_unichar_to_utf8(g_unichar_toupper(first), letter)] = '\0';
    char *whole = g_strconcat(letter, label[0] != '\0' ? g_utf8_next_char(label) : "", NULL);
    g_free(label);
    g_free(valid);
    return whole;
}

char *text_plain(const char *markup)
{
    assert(markup != NULL);
    char *valid = printable_copy(markup), *plain = NULL;
    if (pango_parse_markup(valid, -1, 0, NULL, &plain, NULL, NULL)) {
        // an entity may have become what the markup did not hold
        make_lines_printable(plain);
        g_free(valid);
        return plain;
    }
    return valid;
}

char *text_escape(const char *bytes)
{
    assert(bytes != NULL);
    char *valid = printable_copy(bytes), *escaped = g_markup_escape_text(valid, -1);
    g_free(valid);
    return escaped;
}

double page_letters(double letters, double size)
{
    double scaled = size * (letters > 0 ? letters / LETTERS_NORMAL : 1);
    return scaled > LETTERS_LEAST ? scaled : LETTERS_LEAST;
}

void report_add_text(figure_report *report, const char *markup, double size, figure_rect place)
{
    if (report == NULL || report->text_count == FIGURE_TEXTS) {
        return;
    }

    figure_text *t = &report->texts[report->text_count++];
    char *plain = text_plain(markup);
    const char *end;
    bool indexed = strstr(markup, "<sub>") != NULL || strstr(markup, "<sup>") != NULL;

    // as it is on the page
    t->place = place;
    t->size = indexed ? index_letters(size) : size;
    g_strlcpy(t->text, plain, sizeof t->text);
    // a character that was cut in two goes altogether

    if (!g_utf8_validate(t->text, -1, &end)) {
        t->text[end - t->text] = '\0';
    }
    g_free(plain);
}

// Without memory GLib ends the program, and so does this.
__attribute__((format(printf, 2, 0))) static void append_list(GString *text, const char *format,
                                                              va_list list)
{
    char *printed = decimal_vtext(format, list);
    if (printed == NULL) {
        g_error("out of memory");
    }
    g_string_append(text, printed);
    free(printed);
}

char *text_printf(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    GString *text = g_string_new(NULL);
    append_list(text, format, list);
    va_end(list);
    return g_string_free(text, FALSE);
}

void text_append(GString *text, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    append_list(text, format, list);
    va_end(list);
}

static void (*end_of_program)(const char *reason);

static void on_log(const char *domain, GLogLevelFlags level, const char *reason, void *context)
{
    if ((level & G_LOG_LEVEL_ERROR) != 0) {
        end_of_program(reason);
    }
    g_log_default_handler(domain, level, reason, context);
}

// Pango warns where it draws text as well as it can, without the font or letters elsewhere: such a
// picture is none.
static GLogWriterOutput on_warning(GLogLevelFlags level, const GLogField *fields, gsize count,
                                   void *context)
{
    const char *domain = "", *reason = "";
    for (gsize i = 0; i < count; i++) {
        domain = strcmp(fields[i].key, "GLIB_DOMAIN") == 0 ? fields[i].value : domain;
        reason = strcmp(fields[i].key, "MESSAGE") == 0 ? fields[i].value : reason;
    }
    if ((level & (G_LOG_LEVEL_CRITICAL | G_LOG_LEVEL_WARNING)) != 0 &&
        strcmp(domain, "Pango") == 0) {
        end_of_program(reason);
    }
    return g_log_writer_default(level, fields, count, context);
}

void text_when_giving_up(void (*end)(const char *reason))
{
    assert(end != NULL);
    end_of_program = end;
    g_log_set_default_handler(on_log, NULL);
    g_log_set_writer_func(on_warning, NULL, NULL);
}

void text_release(void)
{
    pango_cairo_font_map_set_default(NULL);
}
