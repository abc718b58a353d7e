#include "ui/terminal/screen.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>

#include <glib.h>

#include "src/base/words.h"

// The 256 characters of braille, from the one without dots on.
enum { BRAILLE = 0x2800, BRAILLE_END = BRAILLE + 256 };

// The dots of a cell.
enum { DOTS_ACROSS = 2, DOTS_DOWN = 4 };

// Whether a glyph is made of dots.
static bool is_braille(uint32_t glyph)
{
    return glyph >= BRAILLE && glyph < BRAILLE_END;
}

void screen_resize(screen *s, int width, int height)
{
    s->width = width > 1 ? width : 1;
    s->height = height > 1 ? height : 1;
    s->cells = g_renew(cell, s->cells, (size_t)s->width * (size_t)s->height);
    screen_clear(s);
}

void screen_finish(screen *s)
{
    g_free(s->cells);
    *s = (screen){0};
}

void screen_clear(screen *s)
{
    for (long i = 0; i < (long)s->width * s->height; i++) {
        s->cells[i] = (cell){' ', INK_TEXT};
    }
}

// The cell in a place, NULL beyond the edges.
static cell *screen_cell(screen *s, int x, int y)
{
    const bool inside = x >= 0 && y >= 0 && x < s->width && y < s->height;
    if (inside) {
        return &s->cells[(long)y * s->width + x];
    }
    return NULL;
}

void screen_put(screen *s, int x, int y, uint32_t glyph, ink colour)
{
    assert(colour < INK_COUNT);
    cell *c = screen_cell(s, x, y);
    if (c != NULL) {
        *c = (cell){glyph, colour};
    }
}

// How many bytes follow the first one of a character.
static int continuation_bytes(unsigned char first)
{
    if (first >= 0xf0) {
        return 3;
    }
    if (first >= 0xe0) {
        return 2;
    }
    if (first >= 0xc0) {
        return 1;
    }
    return 0;
}

uint32_t glyph_decode(const char **text)
{
    const unsigned char *bytes = (const unsigned char *)*text;
    const int following = continuation_bytes(bytes[0]);

    // the first byte has the upper bits below those that say the length
    uint32_t glyph = bytes[0];
    if (following > 0) {
        glyph &= 0x3fu >> following;
    }

    // each that follows has six more
    for (int i = 1; i <= following; i++) {
        if ((bytes[i] & 0xc0) != 0x80) {
            *text += 1;
            return '?';
        }
        glyph = glyph << 6 | (bytes[i] & 0x3fu);
    }
    *text += following + 1;

    // what the terminal must not get
    const bool stray = following == 0 && bytes[0] >= 0x80;
    if (stray || is_unprintable(glyph)) {
        return '?';
    }
    return glyph;
}

int text_cells(const char *text)
{
    int count = 0;
    while (*text != '\0') {
        glyph_decode(&text);
        count++;
    }
    return count;
}

int screen_text(screen *s, int x, int y, int room, ink colour, const char *text)
{
    int taken = 0;
    while (*text != '\0' && taken < room) {
        screen_put(s, x + taken, y, glyph_decode(&text), colour);
        taken++;
    }
    return taken;
}

int screen_print(screen *s, int x, int y, int room, ink colour, const char *format, ...)
{
    char text[1024];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    return screen_text(s, x, y, room, colour, text);
}

int text_wrap(const char *text, int width, text_line *lines, int most, bool *split)
{
    assert(most >= 0);
    int count = 0;
    bool broken_word = false;
    text += strspn(text, " ");

    while (*text != '\0' && count < most) {
        // up to the last word that is not beyond the width
        const char *at = text, *end = text;
        for (int cells = 0; *at != '\0' && cells < width; cells++) {
            const bool blank = glyph_decode(&at) == ' ';
            if (!blank && (*at == ' ' || *at == '\0')) {
                end = at;
            }
        }

        // a word that is wider than the line is cut
        if (end == text) {
            end = at;
            broken_word = true;
        }
        lines[count++] = (text_line){text, (int)(end - text)};
        text = end + strspn(end, " ");
    }

    if (split != NULL) {
        *split = broken_word || *text != '\0';
    }
    return count;
}

int screen_words(screen *s, int x, int y, int room, ink colour, const char *text)
{
    if (text_cells(text) <= room) {
        return screen_text(s, x, y, room, colour, text);
    }

    // the words that leave a cell for the sign that some are left out
    text_line words;
    if (room > 1 && text_wrap(text, room - 1, &words, 1, NULL) > 0) {
        return screen_print(s, x, y, room, colour, "%.*s\u2026", words.bytes,
                            words.start);
    }
    return 0;
}

// A row of a frame or of its inside: two ends, and the same between them.
static void put_frame_row(screen *s, int x, int y, int width, const uint32_t glyphs[3],
                          ink inside, ink colour)
{
    for (int column = x + 1; column < x + width - 1; column++) {
        screen_put(s, column, y, glyphs[1], inside);
    }
    screen_put(s, x, y, glyphs[0], colour);
    screen_put(s, x + width - 1, y, glyphs[2], colour);
}

void screen_frame(screen *s, int x, int y, int width, int height, ink colour,
                  const char *title)
{
    static const uint32_t upper[] = {0x250c, GLYPH_LINE, 0x2510};        // ┌─┐
    static const uint32_t sides[] = {GLYPH_UPRIGHT, ' ', GLYPH_UPRIGHT}; // │ │
    static const uint32_t lower[] = {0x2514, GLYPH_LINE, 0x2518};        // └─┘

    // of one row it is the lower edge
    put_frame_row(s, x, y, width, upper, colour, colour);
    for (int row = y + 1; row < y + height - 1; row++) {
        put_frame_row(s, x, row, width, sides, INK_TEXT, colour);
    }
    put_frame_row(s, x, y + height - 1, width, lower, colour, colour);

    // the title with a blank on each side of it
    if (title[0] != '\0' && width > 6) {
        const int taken = screen_text(s, x + 3, y, width - 6, INK_TITLE, title);
        screen_put(s, x + 2, y, ' ', colour);
        screen_put(s, x + 3 + taken, y, ' ', colour);
    }
}

void screen_tint(screen *s, int x, int y, int width, int height, ink colour)
{
    for (int row = y; row < y + height; row++) {
        for (int column = x; column < x + width; column++) {
            cell *c = screen_cell(s, column, row);
            if (c != NULL) {
                c->ink = colour;
            }
        }
    }
}

// --- dots ------------------------------------------------------------------------------

void canvas_dot(const canvas *c, long across, long down, ink colour)
{
    static const unsigned char bits[DOTS_DOWN][DOTS_ACROSS] = {{0x01, 0x08},
                                                               {0x02, 0x10},
                                                               {0x04, 0x20},
                                                               {0x40, 0x80}};
    if (across < 0 || down < 0 || across >= (long)DOTS_ACROSS * c->width ||
        down >= (long)DOTS_DOWN * c->height) {
        return;
    }

    // joins the dots that are in the cell already, and replaces anything else
    cell *at = screen_cell(c->screen, c->x + (int)(across / DOTS_ACROSS),
                           c->y + (int)(down / DOTS_DOWN));
    if (at != NULL) {
        if (!is_braille(at->glyph)) {
            at->glyph = BRAILLE;
        }
        at->glyph |= bits[down % DOTS_DOWN][across % DOTS_ACROSS];
        at->ink = colour;
    }
}

// Cuts a line from a (share 0) to b (share 1) to what lies between low and high along one
// coordinate; false if nothing is left of the shares from *from to *to.
static bool clip(double low, double high, double a, double b, double *from, double *to)
{
    if (a == b) {
        return a >= low && a <= high;
    }
    const double at_low = (low - a) / (b - a), at_high = (high - a) / (b - a);
    *from = fmax(*from, fmin(at_low, at_high));
    *to = fmin(*to, fmax(at_low, at_high));
    return *from <= *to;
}

void canvas_line(const canvas *c, double x0, double y0, double x1, double y1, ink colour)
{
    double from = 0, to = 1;
    if (!isfinite(x0 + y0 + x1 + y1) ||
        !clip(-1, DOTS_ACROSS * c->width, x0, x1, &from, &to) ||
        !clip(-1, DOTS_DOWN * c->height, y0, y1, &from, &to)) {
        return;
    }

    // one dot for each row or column that the line crosses within the canvas
    const double dx = x1 - x0, dy = y1 - y0;
    const long dots = (long)ceil(fmax(fabs(dx), fabs(dy)) * (to - from));
    for (long i = 0; i <= dots; i++) {
        double share = from;
        if (dots > 0) {
            share += (to - from) * (double)i / (double)dots;
        }
        canvas_dot(c, lround(x0 + share * dx), lround(y0 + share * dy), colour);
    }
}

// --- glyphs ----------------------------------------------------------------------------

// The dots as a quarter-block character.
static uint32_t quarter_block(uint32_t dots)
{
    static const uint32_t blocks[16] = {' ',    0x2598, 0x259d, 0x2580, 0x2596, 0x258c,
                                        0x259e, 0x259b, 0x2597, 0x259a, 0x2590, 0x259c,
                                        0x2584, 0x2599, 0x259f, 0x2588};
    const int upper_left = (dots & 0x03) != 0, upper_right = (dots & 0x18) != 0;
    const int lower_left = (dots & 0x44) != 0, lower_right = (dots & 0xa0) != 0;
    return blocks[upper_left | upper_right << 1 | lower_left << 2 | lower_right << 3];
}

// The dots as the ASCII character that is most like them.
static uint32_t ascii_dots(uint32_t dots)
{
    // by the rows that have dots, the uppermost in the lowest bit: on one side, and on
    // both
    static const char on_one[] = "-'-\"-:=|.::|.|||", on_both[] = "-~-\"-:=|_::|.||#";
    const int upper_rows = ((dots & 0x09) != 0) | ((dots & 0x12) != 0) << 1;
    const int lower_rows = ((dots & 0x24) != 0) << 2 | ((dots & 0xc0) != 0) << 3;
    const bool left = (dots & 0x47) != 0, right = (dots & 0xb8) != 0;
    const char *characters = left && right ? on_both : on_one;
    return (uint32_t)characters[upper_rows | lower_rows];
}

// The ASCII character that stands for a glyph, ? for one that has none.
static uint32_t ascii_glyph(uint32_t glyph)
{
    // each behind the ASCII character that stands for it
    static const wchar_t twins[] =
        L"-─=━.·|│+┌+┐+└+┘>▶<◀^▲v▼o●*◆%▒.░#▓@█dΔ=‖x×~‥~…>▸:┆+┤+┬=╌.┈~╴v▾.○^↑S∫v↓";
    for (int i = 0; twins[i] != 0; i += 2) {
        if ((uint32_t)twins[i + 1] == glyph) {
            return (uint32_t)twins[i];
        }
    }
    return '?';
}

uint32_t glyph_in_set(uint32_t glyph, glyph_set set)
{
    if (glyph >= GLYPH_PICTURE) {
        return ' ';
    }
    if (set == GLYPHS_ASCII && is_braille(glyph)) {
        return ascii_dots(glyph - BRAILLE);
    }
    if (set == GLYPHS_ASCII && glyph >= 0x80) {
        return ascii_glyph(glyph);
    }
    if (set == GLYPHS_BLOCKS && is_braille(glyph)) {
        return quarter_block(glyph - BRAILLE);
    }
    return glyph;
}

void glyph_encode(uint32_t glyph, char *text)
{
    // the first byte says how many follow, and has the uppermost bits
    static const unsigned char length_bits[] = {0, 0xc0, 0xe0, 0xf0};
    int following = 0;
    if (glyph >= 0x10000) {
        following = 3;
    } else if (glyph >= 0x800) {
        following = 2;
    } else if (glyph >= 0x80) {
        following = 1;
    }
    *text++ = (char)(length_bits[following] | glyph >> 6 * following);

    // each that follows has the next six
    for (int left = following - 1; left >= 0; left--) {
        *text++ = (char)(0x80 | (glyph >> 6 * left & 0x3f));
    }
    *text = '\0';
}

void screen_dump(const screen *s, glyph_set set, FILE *stream)
{
    for (int y = 0; y < s->height; y++) {
        const cell *row = s->cells + (long)y * s->width;

        // blanks at the end of a line are left out
        int length = s->width;
        while (length > 0 && row[length - 1].glyph == ' ') {
            length--;
        }
        for (int x = 0; x < length; x++) {
            char text[5];
            glyph_encode(glyph_in_set(row[x].glyph, set), text);
            fputs(text, stream);
        }
        fputc('\n', stream);
    }
}
