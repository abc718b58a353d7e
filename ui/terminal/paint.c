#include "ui/terminal/paint.h"

#include <assert.h>
#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <wchar.h>

#include "ui/terminal/ink_colours.h"

// Bytes on their way to the terminal.
typedef struct outlet {
    char bytes[8192];
    size_t used;
} outlet;

void terminal_send(const char *bytes, size_t count)
{
    assert(bytes != NULL);
    for (size_t sent = 0; sent < count;) {
        ssize_t taken = write(STDOUT_FILENO, bytes + sent, count - sent);
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

static void send(outlet *o)
{
    terminal_send(o->bytes, o->used);
    o->used = 0;
}

static void put(outlet *o, const char *text)
{
    size_t length = strlen(text);
    if (o->used + length > sizeof o->bytes) {
        send(o);
    }
    memcpy(o->bytes + o->used, text, length);
    o->used += length;
}

// The sequence that selects an ink.
static void put_ink(outlet *o, ink i, colour_theme theme, colour_depth depth)
{
    char text[64] = "";
    rgb c;

    // which colour, if any, and whether it is bold
    int index = depth == DEPTH_256 ? ink_256(theme, i) : depth == DEPTH_16 ? ink_16(theme, i) : -1;
    bool coloured = ink_rgb(theme, i, &c) && depth != DEPTH_MONO;
    // many terminals show bold dark colours as bright ones, which are not readable on a light
    // background
    bool faint = theme == COLOURS_LIGHT && depth == DEPTH_16 && coloured;
    bool bold = (i == INK_TITLE || i == INK_EVENT || i == INK_WARNING) && !faint;

    // the colour in the terminal's own units
    if (coloured && depth == DEPTH_TRUE) {
        snprintf(text, sizeof text, ";38;2;%d;%d;%d", c.red, c.green, c.blue);
    } else if (coloured && depth == DEPTH_256 && index >= 0) {
        snprintf(text, sizeof text, ";38;5;%d", index);
    } else if (coloured && depth == DEPTH_16 && index >= 0) {
        snprintf(text, sizeof text, ";%d", index < 8 ? 30 + index : 90 + index - 8);
    }
    put(o, "\033[0");
    put(o, bold ? ";1" : i == INK_SELECTED ? ";7" : "");
    put(o, text);
    put(o, "m");
}

void paint_cells(const screen *s, screen *shown, glyph_set glyphs, colour_theme theme,
                 colour_depth depth, bool whole)
{
    static outlet o;
    assert(s != NULL && shown != NULL && depth != DEPTH_AUTO);
    assert(s->width == shown->width && s->height == shown->height);
    int at_x = -1, at_y = -1, colour = -1;
    for (int y = 0; y < s->height; y++) {
        for (int x = 0; x < s->width; x++) {
            long i = (long)y * s->width + x;
            cell c = s->cells[i], *old = &shown->cells[i];
            bool blank = (c.glyph == ' ' && c.ink != INK_SELECTED) || c.glyph >= GLYPH_PICTURE;
            bool same = whole ? blank : c.glyph == old->glyph && c.ink == old->ink;
            *old = c;

            // the last cell may scroll the screen; it is worth nothing
            if (same || (x == s->width - 1 && y == s->height - 1)) {
                continue;
            }

            // the cursor and the ink follow where they are not there yet
            char text[32];
            if (at_x != x || at_y != y) {
                snprintf(text, sizeof text, "\033[%d;%dH", y + 1, x + 1);
                put(&o, text);
            }
            if (colour != (int)c.ink) {
                put_ink(&o, c.ink, theme, depth);
                colour = (int)c.ink;
            }

            // what takes no cell or two would break the grid
            uint32_t glyph = glyph_in_set(c.glyph, glyphs);
            glyph_encode(wcwidth((wchar_t)glyph) == 1 ? glyph : '?', text);
            put(&o, text);
            at_x = x + 1;
            at_y = y;
        }
    }
    put(&o, "\033[0m");
    send(&o);
}
