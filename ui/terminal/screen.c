#include "ui/terminal/screen.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/words.h"

enum { BRAILLE = 0x2800 };

bool screen_resize(screen *s, int width, int height)
{
    if (width < 1) {
        width = 1;
    }
    if (height < 1) {
        height = 1;
    }
    cell *cells = calloc((size_t)width * (size_t)height, sizeof *cells);
    if (cells == NULL) {
        return false;
    }
    free(s->cells);
    *s = (screen){width, height, cells, s->pictures};
    screen_clear(s);
    return true;
}

void screen_finish(screen *s)
{
    free(s->cells);
    *s = (screen){0};
}

void screen_clear(screen *s)
{
    for (long i = 0; i < (long)s->width * s->height; i++) {
        s->cells[i] = (cell){' ', INK_TEXT};
    }
}

static cell *cell_at(screen *s, int x, int y)
{
    bool inside = x >= 0 && y >= 0 && x < s->width && y < s->height;
    if (inside) {
        return &s->cells[(long)y * s->width + x];
    }
    return NULL;
}

void screen_put(screen *s, int x, int y, uint32_t glyph, ink colour)
{
    assert(colour < INK_COUNT);
    cell *c = cell_at(s, x, y);
    if (c != NULL) {
        *c = (cell){glyph, colour};
    }
}

uint32_t glyph_decode(const char **text)
{
    const unsigned char *t = (const unsigned char *)*text;

    // the first byte says how many follow, each with six bits
    int more = 3;
    if (!(t[0] >= 0xf0)) {
        if (t[0] >= 0xe0) {
            more = 2;
        } else if (t[0] >= 0xc0) {
            more = 1;
        } else {
            more = 0;
        }
    }
    uint32_t glyph = more == 0 ? t[0] : t[0] & (0x3fu >> more);
    for (int i = 1; i <= more; i++) {
        if ((t[i] & 0xc0) != 0x80) {
            *text += 1;
            return '?';
        }
        glyph = glyph << 6 | (t[i] & 0x3fu);
    }
    *text += more + 1;

    // what the terminal must not get
    bool stray = more == 0 && t[0] >= 0x80;
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
    bool broken = false;
    text += strspn(text, " ");
    while (*text != '\0' && count < most) {
        const char *at = text, *end = text;

        // up to the last word that is not beyond the width
        for (int cells = 0; *at != '\0' && cells < width; cells++) {
            bool blank = glyph_decode(&at) == ' ';
            if (!blank && (*at == ' ' || *at == '\0')) {
                end = at;
            }
        }
        if (end == text) {
            // a word that is wider than the line
            end = at;
            broken = true;
        }
        lines[count++] = (text_line){text, (int)(end - text)};
        text = end + strspn(end, " ");
    }
    if (split != NULL) {
        *split = broken || *text != '\0';
    }
    return count;
}

int screen_words(screen *s, int x, int y, int room, ink colour, const char *text)
{
    text_line words = {text, 0};
    if (text_cells(text) <= room) {
        return screen_text(s, x, y, room, colour, text);
    }
    if (room > 1 && text_wrap(text, room - 1, &words, 1, NULL) > 0) {
        return screen_print(s, x, y, room, colour, "%.*s\u2026", words.bytes,
                            words.start);
    }
    return 0;
}

void screen_frame(screen *s, int x, int y, int width, int height, ink colour,
                  const char *title)
{
    int right = x + width - 1, bottom = y + height - 1;

    // sides, and an empty inside
    for (int row = y; row <= bottom; row++) {
        for (int column = x; column <= right; column++) {
            bool side = column == x || column == right, level = row == y || row == bottom;
            uint32_t line = ' ';
            if (level) {
                line = 0x2500;
            } else if (side) {
                line = 0x2502;
            }
            screen_put(s, column, row, line, level || side ? colour : INK_TEXT);
        }
    }

    // corners, and the title with a blank on each side of it
    screen_put(s, x, y, 0x250c, colour);
    screen_put(s, right, y, 0x2510, colour);
    screen_put(s, x, bottom, 0x2514, colour);
    screen_put(s, right, bottom, 0x2518, colour);
    if (title[0] != '\0' && width > 6) {
        int taken = screen_text(s, x + 3, y, width - 6, INK_TITLE, title);
        screen_put(s, x + 2, y, ' ', colour);
        screen_put(s, x + 3 + taken, y, ' ', colour);
    }
}

void screen_tint(screen *s, int x, int y, int width, int height, ink colour)
{
    for (int row = y; row < y + height; row++) {
        for (int column = x; column < x + width; column++) {
            cell *c = cell_at(s, column, row);
            if (c != NULL) {
                c->ink = colour;
            }
        }
    }
}

// --- dots ------------------------------------------------------------------------------

void canvas_dot(const canvas *c, long across, long down, ink colour)
{
    static const unsigned char bits[4][2] = {{0x01, 0x08},
                                             {0x02, 0x10},
                                             {0x04, 0x20},
                                             {0x40, 0x80}};
    if (across < 0 || down < 0 || across >= 2L * c->width || down >= 4L * c->height) {
        return;
    }
    cell *at = cell_at(c->screen, c->x + (int)(across / 2), c->y + (int)(down / 4));
    if (at != NULL) {
        bool dots = at->glyph >= BRAILLE && at->glyph < BRAILLE + 256;
        at->glyph = (dots ? at->glyph : (uint32_t)BRAILLE) | bits[down % 4][across % 2];
        at->ink = colour;
    }
}

// Cuts the line to the part between low and high along one coordinate; false if nothing
// is left.
static bool clip(double low, double high, double a, double b, double *from, double *to)
{
    if (a == b) {
        return a >= low && a <= high;
    }
    double enter = (low - a) / (b - a), leave = (high - a) / (b - a);
    *from = fmax(*from, fmin(enter, leave));
    *to = fmin(*to, fmax(enter, leave));
    return *from <= *to;
}

void canvas_line(const canvas *c, double x0, double y0, double x1, double y1, ink colour)
{
    double from = 0, to = 1;
    if (!isfinite(x0 + y0 + x1 + y1) || !clip(-1, 2 * c->width, x0, x1, &from, &to) ||
        !clip(-1, 4 * c->height, y0, y1, &from, &to)) {
        return;
    }

    // one dot for each row or column that the line crosses within the canvas
    double dx = x1 - x0, dy = y1 - y0;
    long dots = (long)ceil(fmax(fabs(dx), fabs(dy)) * (to - from));
    for (long i = 0; i <= dots; i++) {
        double at = dots > 0 ? from + (to - from) * (double)i / (double)dots : from;
        canvas_dot(c, lround(x0 + at * dx), lround(y0 + at * dy), colour);
    }
}

// --- glyphs ----------------------------------------------------------------------------

// The dots as a quarter-block character.
static uint32_t quadrants(uint32_t dots)
{
    static const uint32_t blocks[16] = {' ',    0x2598, 0x259d, 0x2580, 0x2596, 0x258c,
                                        0x259e, 0x259b, 0x2597, 0x259a, 0x2590, 0x259c,
                                        0x2584, 0x2599, 0x259f, 0x2588};
    int upper_left = (dots & 0x03) != 0, upper_right = (dots & 0x18) != 0;
    int lower_left = (dots & 0x44) != 0, lower_right = (dots & 0xa0) != 0;
    return blocks[upper_left | upper_right << 1 | lower_left << 2 | lower_right << 3];
}

// The dots as the ASCII character that is most like them.
static uint32_t ascii_dots(uint32_t dots)
{
    // by the rows that have dots, the uppermost in the lowest bit: on one side, and on
    // both
    static const char one[] = "-'-\"-:=|.::|.|||", both[] = "-~-\"-:=|_::|.||#";
    const int upper = ((dots & 0x09) != 0) | ((dots & 0x12) != 0) << 1;
    const int rows = upper | ((dots & 0x24) != 0) << 2 | ((dots & 0xc0) != 0) << 3;
    return (uint32_t)((dots & 0x47) != 0 && (dots & 0xb8) != 0 ? both : one)[rows];
}

static uint32_t ascii_glyph(uint32_t glyph)
{
    // each behind the ASCII character that stands for it
    static const wchar_t twins[] =
        L"-─|│+┌+┐+└+┘>▶<◀^▲v▼o●*◆%▒.░#▓@█dΔ=‖x×~‥~…>▸:┆+┤+┬=╌.┈~╴v▾.○^↑S∫v↓";
    int i = 1;
    while (twins[i - 1] != 0 && (uint32_t)twins[i] != glyph) {
        i += 2;
    }
    if (twins[i - 1] != 0) {
        return (uint32_t)twins[i - 1];
    }
    return '?';
}

uint32_t glyph_in_set(uint32_t glyph, glyph_set set)
{
    const bool dots = glyph >= BRAILLE && glyph < BRAILLE + 256;
    if (glyph >= GLYPH_PICTURE) {
        return ' ';
    }
    if (set == GLYPHS_ASCII && dots) {
        return ascii_dots(glyph - BRAILLE);
    }
    if (set == GLYPHS_ASCII && glyph >= 0x80) {
        return ascii_glyph(glyph);
    }
    if (set == GLYPHS_BLOCKS && dots) {
        return quadrants(glyph - BRAILLE);
    }
    return glyph;
}

void glyph_encode(uint32_t glyph, char *text)
{
    // one byte, or a first one with the length and six bits in each that follows
    static const unsigned char first[] = {0, 0xc0, 0xe0, 0xf0};
    int more = 0;
    if (!(glyph < 0x80)) {
        if (glyph < 0x800) {
            more = 1;
        } else if (glyph < 0x10000) {
            more = 2;
        } else {
            more = 3;
        }
    }
    *text++ = (char)(first[more] | glyph >> 6 * more);
    for (int i = more; i-- > 0;) {
        *text++ = (char)(0x80 | (glyph >> 6 * i & 0x3f));
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
