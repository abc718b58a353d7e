// What the terminal shows: cells by the sequences of its description, and, for colours
// that this does not know, by those that all terminals with such colours have; pictures.
#include "ui/terminal/terminal.h"
#include "ui/terminal/terminal_state.h"

#include <assert.h>
#include <errno.h>
#include <glib.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>
#include <wchar.h>

#include <term.h>

#include "src/base/text_stream.h"
#include "ui/terminal/ink_colours.h"
#include "ui/terminal/pictures.h"
#include "ui/terminal/pixels.h"

// --- bytes and cells -------------------------------------------------------------------

static size_t sent_in_all;

size_t terminal_sent(void)
{
    return sent_in_all;
}

void terminal_send(const char *bytes, size_t count)
{
    sent_in_all += count;
    for (size_t sent = 0; sent < count;) {
        const ssize_t taken = write(STDOUT_FILENO, bytes + sent, count - sent);
        if (taken > 0) {
            sent += (size_t)taken;
        } else if (taken < 0 && errno == EAGAIN) {
            struct pollfd room = {STDOUT_FILENO, POLLOUT, 0};
            poll(&room, 1, 1000);
        } else if (taken == 0 || errno != EINTR) {
            break; // the terminal is gone, which reading will find out
        }
    }
}

static FILE *sequences; // where put_byte writes

// Writes a byte of a sequence, as tputs asks for.
static int put_byte(int byte)
{
    return putc(byte, sequences);
}

// Writes a sequence of the terminal's description, with one number; nothing if it has
// none.
static void put_capability(FILE *stream, const char *name, int number)
{
    const char *text = tigetstr(name);
    if (text != NULL && text != (const char *)-1) {
        sequences = stream;
        tputs(tparm(text, (long)number), 1, put_byte);
    }
}

// Selects one of 16 or 256 colours, by the terminal's description if that knows so many,
// else by the usual sequence. Of the bright ones (from 8 on) a terminal of eight colours
// has the dark one, which put_coloured_ink makes bold.
static void put_indexed(FILE *stream, int index, colour_depth depth)
{
    const bool described = COLORS >= 8 && COLORS <= 256;
    if (described && (depth == DEPTH_16 || COLORS == 256)) {
        put_capability(stream, "setaf", index < COLORS ? index : index & 7);
    } else if (depth == DEPTH_256) {
        fprintf(stream, "\033[38;5;%dm", index);
    } else if (index < 8) {
        fprintf(stream, "\033[%dm", 30 + index);
    } else {
        fprintf(stream, "\033[%dm", 90 + index - 8);
    }
}

// Selects an ink without colours: bold, dim and underlined cells say what these say
// elsewhere.
static void put_plain_ink(FILE *stream, ink i)
{
    switch (i) {
    case INK_SELECTED:
        put_capability(stream, "rev", 0);
        break;
    case INK_TITLE:
    case INK_EVENT:
    case INK_FORCE:
        put_capability(stream, "bold", 0);
        break;
    case INK_WARNING:
        put_capability(stream, "bold", 0);
        put_capability(stream, "smul", 0);
        break;
    case INK_DIM:
    case INK_OTHER:
        put_capability(stream, "dim", 0);
        break;
    default:
        break;
    }
}

// Selects an ink in colours, if it has one.
static void put_coloured_ink(FILE *stream, ink i, colour_theme theme, colour_depth depth)
{
    rgb c;
    const bool coloured = ink_rgb(theme, i, &c), few = coloured && depth == DEPTH_16;
    const int index = ink_index(theme, i, depth);

    // many terminals show bold dark colours as bright ones, which are not readable on
    // light ground
    const bool bright = few && COLORS == 8 && index >= 8;
    const bool bold = i == INK_TITLE || i == INK_EVENT || i == INK_WARNING;
    const bool bold_is_readable = !(few && theme == COLOURS_LIGHT);
    if (i == INK_SELECTED) {
        put_capability(stream, "rev", 0);
    } else if (bright || (bold && bold_is_readable)) {
        put_capability(stream, "bold", 0);
    }

    // the colour in the terminal's own units
    if (coloured && depth == DEPTH_TRUE) {
        fprintf(stream, "\033[38;2;%d;%d;%dm", c.red, c.green, c.blue);
    } else if (coloured && index >= 0) {
        put_indexed(stream, index, depth);
    }
}

// Whether an ink is a colour and nothing else, so that another one can take its place.
static bool is_only_colour(ink i, colour_theme theme, colour_depth depth)
{
    rgb c;
    const bool more =
        i == INK_SELECTED || i == INK_TITLE || i == INK_EVENT || i == INK_WARNING;
    return theme != COLOURS_MONO && (depth == DEPTH_TRUE || depth == DEPTH_256) &&
           !more && ink_rgb(theme, i, &c);
}

// Selects an ink in a theme's colours, or in the ways of a terminal without colours,
// after another one (-1: none).
static void put_ink(FILE *stream, int before, ink i, colour_theme theme,
                    colour_depth depth)
{
    if (before < 0 || !is_only_colour((ink)before, theme, depth) ||
        !is_only_colour(i, theme, depth)) {
        put_capability(stream, "sgr0", 0);
    }
    if (theme == COLOURS_MONO || depth == DEPTH_MONO) {
        put_plain_ink(stream, i);
    } else {
        put_coloured_ink(stream, i, theme, depth);
    }
}

// Whether a cell of an empty terminal is that already; pictures come later.
static bool is_blank_cell(cell c)
{
    return (c.glyph == ' ' && c.ink != INK_SELECTED) || c.glyph >= GLYPH_PICTURE;
}

// Whether a blank looks the same in both inks (-1: none): it shows only what is reversed
// or underlined.
static bool blank_looks_alike(int ink_set, ink wanted)
{
    return wanted != INK_SELECTED && wanted != INK_WARNING && ink_set != INK_SELECTED &&
           ink_set != INK_WARNING;
}

// What takes no cell or two would break the grid.
static void put_glyph(FILE *stream, uint32_t glyph)
{
    char text[5];
    if (wcwidth((wchar_t)glyph) != 1) {
        glyph = '?';
    }
    glyph_encode(glyph, text);
    fputs(text, stream);
}

// Writes the cells that have changed (all of them if `whole`; the terminal is empty
// then).
static void paint_cells(FILE *stream, const screen *s, glyph_set glyphs, bool whole)
{
    const char *place = tigetstr("cup");
    int at_x = -1, at_y = -1, ink_set = -1;
    for (int y = 0; y < s->height; y++) {
        for (int x = 0; x < s->width; x++) {
            const long i = (long)y * s->width + x;
            const cell c = s->cells[i], before = tty.shown.cells[i];
            tty.shown.cells[i] = c;

            // what is there already; the last cell may scroll the screen and is worth
            // nothing
            bool there = c.glyph == before.glyph && c.ink == before.ink;
            if (whole) {
                there = is_blank_cell(c);
            }
            if (there || (x == s->width - 1 && y == s->height - 1)) {
                continue;
            }

            // the cursor and the ink follow where they are not there yet
            if (at_x != x || at_y != y) {
                sequences = stream;
                tputs(tparm(place, (long)y, (long)x), 1, put_byte);
            }
            const bool alike = c.glyph == ' ' && blank_looks_alike(ink_set, c.ink);
            if (ink_set != (int)c.ink && !alike) {
                put_ink(stream, ink_set, c.ink, tty.theme, tty.depth);
                ink_set = (int)c.ink;
            }
            put_glyph(stream, glyph_in_set(c.glyph, glyphs));
            at_x = x + 1;
            at_y = y;
        }
    }
    put_capability(stream, "sgr0", 0);
}

// --- pictures --------------------------------------------------------------------------

enum { UNLIMITED = 1 << 16 }; // cells of a region

// The regions on the terminal.
typedef struct shown_pictures {
    picture_region regions[PICTURE_REGIONS];
    uint64_t hashes[PICTURE_REGIONS]; // of their pixels
    int count;
} shown_pictures;

static shown_pictures shown;

terminal_pixels terminal_pixels_known(void)
{
    const pixel_answers *a = &tty.pixels;
    struct winsize size;
    terminal_pixels known = {.cell_width = a->cell_width,
                             .cell_height = a->cell_height,
                             .has_ground = a->has_ground,
                             .ground = a->ground};

    // a terminal may say its size in pixels with that in cells only
    if (known.cell_width == 0 && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 &&
        size.ws_col > 0 && size.ws_row > 0) {
        known.cell_width = size.ws_xpixel / size.ws_col;
        known.cell_height = size.ws_ypixel / size.ws_row;
    }
    known.there = pixel_answers_protocol(a) != PIXELS_NONE && known.cell_width > 1 &&
                  known.cell_height > 1;
    return known;
}

// Fowler, Noll and Vo's hash, of pixels instead of bytes.
static uint64_t hash_of(const pixel_block *b)
{
    uint64_t hash = 14695981039346656037u;
    for (int y = 0; y < b->height; y++) {
        const uint32_t *row = b->pixels + (long)y * b->stride;
        for (int x = 0; x < b->width; x++) {
            hash ^= row[x] & 0xffffff;
            hash *= 1099511628211u;
        }
    }
    return hash;
}

// The colours of sixel pictures: as many as the terminal has registers for, if it said
// so.
static int sixel_colours(void)
{
    const int registers = tty.pixels.registers;
    if (registers > 0 && registers < SIXEL_COLOURS) {
        return registers;
    }
    return SIXEL_COLOURS;
}

// Whether region i is on the terminal as it is.
static bool region_is_shown(int i, const picture_region *r, uint64_t hash)
{
    return i < shown.count && memcmp(&shown.regions[i], r, sizeof *r) == 0 &&
           shown.hashes[i] == hash;
}

// Shows the regions that are not on the terminal yet (all of them if `whole`), and
// remembers them.
static void write_regions(FILE *stream, const screen *s, const picture_region *regions,
                          int count, bool whole)
{
    const bool kitty = tty.pixels.kitty;
    for (int i = 0; i < count; i++) {
        const picture_region *r = &regions[i];
        const pixel_block block = picture_block(s, r);
        const uint64_t hash = hash_of(&block);
        if (!whole && region_is_shown(i, r, hash)) {
            continue;
        }

        // the cursor is kept for other programs that write to the terminal
        fprintf(stream, "\0337\033[%d;%dH", r->y + 1, r->x + 1);
        if (kitty) {
            kitty_write(stream, &block, i + 1, r->width, r->height);
        } else {
            sixel_write(stream, &block, sixel_colours());
        }
        fputs("\0338", stream);
        shown.regions[i] = *r;
        shown.hashes[i] = hash;
    }

    // those that are gone: blanks have cleared sixels, others have to be removed
    for (int i = count; kitty && i < shown.count; i++) {
        fprintf(stream, "\033_Ga=d,d=I,i=%d,q=2\033\\", i + 1);
    }
    shown.count = count;
}

// Writes the pictures of a screen whose cells are shown: those that have changed, or all.
static void paint_pictures(FILE *stream, const screen *s, bool whole)
{
    const pixel_answers *a = &tty.pixels;
    const picture_layer *layer = s->pictures;
    picture_region regions[PICTURE_REGIONS];
    int count = 0;
    if (pixel_answers_protocol(a) == PIXELS_NONE || (layer == NULL && shown.count == 0)) {
        return;
    }

    // in parts that the terminal takes
    if (layer != NULL) {
        int width = UNLIMITED, height = UNLIMITED;
        if (!a->kitty && a->most_width > 0 && a->most_height > 0) {
            width = a->most_width / layer->cell_width;
            height = a->most_height / layer->cell_height;
        }
        if (width > 0 && height > 0) {
            count = pictures_regions(s, width, height, regions);
        }
    }
    write_regions(stream, s, regions, count, whole);
}

void terminal_remove_pictures(void)
{
    static const char all[] = "\033_Ga=d,d=A,q=2\033\\";
    if (tty.pixels.kitty && shown.count > 0) {
        terminal_send(all, sizeof all - 1);
    }
    shown.count = 0;
}

// --- the screen ------------------------------------------------------------------------

// Whether the terminal's description says that it has all colours.
static bool all_colours_described(void)
{
    const char *direct = tigetstr("RGB");
    return tigetflag("RGB") == 1 || tigetnum("RGB") > 0 || tigetflag("Tc") == 1 ||
           (direct != NULL && direct != (const char *)-1) || COLORS > 256;
}

// Whether the terminal says of itself that it has. GNU screen and the console hand the
// claim of the terminal that they were started from on.
static bool all_colours_claimed(void)
{
    const char *claim = getenv("COLORTERM"), *name = getenv("TERM");
    if (claim == NULL ||
        (strcmp(claim, "truecolor") != 0 && strcmp(claim, "24bit") != 0)) {
        return false;
    }
    if (name == NULL) {
        return true;
    }
    const bool console = strcmp(name, "linux") == 0;
    const bool gnu_screen = strncmp(name, "screen", 6) == 0 && getenv("TMUX") == NULL;
    return !console && !gnu_screen;
}

colour_depth terminal_depth(void)
{
    const char *no_colour = getenv("NO_COLOR");
    if (!tty.colours || (no_colour != NULL && no_colour[0] != '\0')) {
        return DEPTH_MONO;
    }
    if (all_colours_described() || all_colours_claimed()) {
        return DEPTH_TRUE;
    }
    if (COLORS >= 256) {
        return DEPTH_256;
    }
    return DEPTH_16;
}

bool terminal_is_light(void)
{
    // "foreground;background", with the background's number among the 16 colours at the
    // end
    const char *claim = getenv("COLORFGBG");
    if (claim == NULL) {
        return false;
    }
    const char *last = strrchr(claim, ';');
    return last != NULL && (strcmp(last, ";7") == 0 || strcmp(last, ";15") == 0);
}

void terminal_show(const screen *s, glyph_set glyphs, colour_theme theme, bool whole)
{
    assert(s->width > 0 && s->height > 0);
    const colour_depth depth = terminal_depth();

    // with another size, theme or depth everything is drawn again
    const bool same_size = tty.shown.width == s->width && tty.shown.height == s->height;
    if (!same_size) {
        screen_resize(&tty.shown, s->width, s->height);
    }
    whole = whole || !same_size || tty.theme != theme || tty.depth != depth;
    tty.theme = theme;
    tty.depth = depth;
    if (whole) {
        clearok(stdscr, TRUE);
        erase();
        refresh();
    }

    // all at once; a terminal that knows synchronised output shows it at once, others
    // ignore it
    text_stream all;
    if (!text_stream_open(&all)) {
        g_error("out of memory");
    }
    fputs("\033[?2026h", all.stream);
    paint_cells(all.stream, s, glyphs, whole);
    paint_pictures(all.stream, s, whole);
    fputs("\033[?2026l", all.stream);

    size_t size;
    char *bytes = text_stream_close(&all, &size);
    if (bytes == NULL) {
        g_error("out of memory");
    }
    terminal_send(bytes, size);
    free(bytes);
}

// --- the clipboard ---------------------------------------------------------------------

void terminal_copy(const char *text)
{
    static const char begin[] = "\033]52;c;", end[] = "\a";
    g_autofree gchar *coded = g_base64_encode((const guchar *)text, strlen(text));
    terminal_send(begin, strlen(begin));
    terminal_send(coded, strlen(coded));
    terminal_send(end, strlen(end));
}
