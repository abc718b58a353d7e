// What the terminal shows.
#include "ui/terminal/terminal.h"
#include "ui/terminal/terminal_state.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <wchar.h>

#include <term.h>

#include "ui/terminal/ink_colours.h"
#include "ui/terminal/paint.h"

colour_depth terminal_depth(void)
{
    const char *none = getenv("NO_COLOR"), *claim = getenv("COLORTERM"), *name = getenv("TERM");
    const char *direct = tigetstr("RGB");
    if (!tty.colours || (none != NULL && none[0] != '\0')) {
        return DEPTH_MONO;
    }

    // what the terminal's description says, and what the terminal says of itself
    bool described = tigetflag("RGB") == 1 || tigetnum("RGB") > 0 || tigetflag("Tc") == 1 ||
                     (direct != NULL && direct != (const char *)-1) || COLORS > 256;
    bool claimed =
        claim != NULL && (strcmp(claim, "truecolor") == 0 || strcmp(claim, "24bit") == 0);
    // GNU screen and the console hand the claim of the terminal they were started from on
    bool hearsay = name != NULL && (strcmp(name, "linux") == 0 ||
                                    (strncmp(name, "screen", 6) == 0 && getenv("TMUX") == NULL));
    if (described || (claimed && !hearsay)) {
        return DEPTH_TRUE;
    }
    return COLORS >= 256 ? DEPTH_256 : DEPTH_16;
}

bool terminal_is_light(void)
{
    // "foreground;background", with the background's number among the 16 colours at the end
    const char *claim = getenv("COLORFGBG"), *last = claim ? strrchr(claim, ';') : NULL;
    return last != NULL && (strcmp(last, ";7") == 0 || strcmp(last, ";15") == 0);
}

static void set_colours(colour_theme theme, colour_depth depth)
{
    for (int i = 0; i < INK_COUNT && tty.colours; i++) {
        int index = depth == DEPTH_256 ? ink_256(theme, (ink)i) : ink_16(theme, (ink)i);
        // eight colours are bright where they are bold
        tty.bright[i] = index >= COLORS;
        init_pair((short)(i + 1), (short)(tty.bright[i] ? index & 7 : index), -1);
    }
    tty.theme = theme;
    tty.depth = depth;
    tty.themed = true;
}

static attr_t attributes_of(ink colour, bool coloured)
{
    // bold and dim distinguish what colours do elsewhere
    switch (colour) {
    case INK_SELECTED:
        return A_REVERSE;
    case INK_TITLE:
    case INK_EVENT:
        return A_BOLD;

    // the meaning of a colour needs another sign without colours
    case INK_DIM:
    case INK_OTHER:
        return coloured ? A_NORMAL : A_DIM;
    case INK_WARNING:
        return coloured ? A_BOLD : A_BOLD | A_UNDERLINE;
    case INK_FORCE:
        return coloured ? A_NORMAL : A_BOLD;
    default:
        return A_NORMAL;
    }
}

static void show_cell(int x, int y, cell c, glyph_set glyphs, bool coloured)
{
    cchar_t out;
    wchar_t text[2] = {(wchar_t)glyph_in_set(c.glyph, glyphs), 0};
    // what takes no cell or two would break the grid
    if (wcwidth(text[0]) != 1) {
        text[0] = '?';
    }

    // bold means bright with eight colours
    attr_t attributes = attributes_of(c.ink, coloured);
    rgb ignored;
    if (coloured && tty.bright[c.ink]) {
        attributes |= A_BOLD;
    } else if (coloured && tty.theme == COLOURS_LIGHT && tty.depth == DEPTH_16 &&
               ink_rgb(tty.theme, c.ink, &ignored)) {
        // many terminals show bold dark colours as bright ones: unreadable on light ground
        attributes &= ~(attr_t)A_BOLD;
    }

    setcchar(&out, text, attributes, coloured ? (short)(c.ink + 1) : 0, NULL);
    mvadd_wch(y, x, &out);
}

// Shows the cells through ncurses.
static void show_by_curses(const screen *s, glyph_set glyphs, bool coloured, bool whole)
{
    // what has changed since the last picture
    for (int y = 0; y < s->height; y++) {
        for (int x = 0; x < s->width; x++) {
            long i = (long)y * s->width + x;
            cell c = s->cells[i], old = tty.shown.cells[i];
            if (whole || c.glyph != old.glyph || c.ink != old.ink) {
                show_cell(x, y, c, glyphs, coloured);
                tty.shown.cells[i] = c;
            }
        }
    }
    refresh();
}

void terminal_show(const screen *s, glyph_set glyphs, colour_theme theme, colour_depth depth,
                   bool whole)
{
    assert(s != NULL && s->width > 0 && s->height > 0 && tty.curses != NULL);

    // another size, theme or depth: everything anew
    bool same_size = tty.shown.width == s->width && tty.shown.height == s->height;
    depth = depth == DEPTH_AUTO ? terminal_depth() : depth;
    if (!tty.themed || tty.theme != theme || tty.depth != depth) {
        set_colours(theme, depth);
        whole = true;
    }
    if (!same_size && !screen_resize(&tty.shown, s->width, s->height)) {
        return;
    }
    whole = whole || !same_size;

    // ncurses has numbers for the colours that the terminal's description has, no others
    bool coloured = theme != COLOURS_MONO && depth != DEPTH_MONO;
    bool numbered =
        tty.colours && COLORS <= 256 && depth != DEPTH_TRUE && (depth == DEPTH_16 || COLORS == 256);
    tty.painted = coloured && !numbered;

    // a terminal that knows synchronised output shows the frame at once, others ignore it
    terminal_send("\033[?2026h", 8);

    // ncurses keeps count of what is on the screen even where it does not paint
    if (whole) {
        clearok(stdscr, TRUE);
        erase();
    }
    if (tty.painted) {
        // so that it finds nothing to do by itself later
        refresh();
        paint_cells(s, &tty.shown, glyphs, theme, depth, whole);
    } else {
        show_by_curses(s, glyphs, coloured, whole);
    }

    // ncurses takes a picture's cells for blanks, and may have cleared them
    terminal_show_pictures(s, whole || !tty.painted);
    terminal_send("\033[?2026l", 8);
}
