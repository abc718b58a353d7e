// The contents of the terminal's screen, independent of a terminal: a grid of cells, each
// with a glyph and an ink. terminal.h shows it on the terminal; without one it is printed
// as text.
#pragma once

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

// The meaning of a cell, which the theme gives a colour. INK_SERIES_0 and the seven after
// it are for curves.
typedef enum ink {
    INK_TEXT,
    INK_DIM,
    INK_FRAME,
    INK_TITLE,
    INK_SELECTED, // reversed
    INK_ARM,
    INK_HUB,
    INK_WALL,
    INK_FORCE,
    INK_EVENT,
    INK_CURSOR,
    INK_WARNING,
    INK_OTHER, // the run kept for comparison
    INK_SERIES_0,
    INK_COUNT = INK_SERIES_0 + 8
} ink;

// The sets of characters that a terminal can show.
typedef enum glyph_set {
    GLYPHS_BRAILLE,
    GLYPHS_BLOCKS,
    GLYPHS_ASCII,
    GLYPH_SETS
} glyph_set;

// The colours of the inks on the terminal.
typedef enum colour_theme {
    COLOURS_DARK,
    COLOURS_LIGHT,
    COLOURS_MONO,
    COLOUR_THEMES
} colour_theme;

// The assumed number of colours of the terminal.
typedef enum colour_depth {
    DEPTH_UNKNOWN,
    DEPTH_TRUE, // red, green and blue
    DEPTH_256,
    DEPTH_16,
    DEPTH_MONO
} colour_depth;

typedef struct cell {
    uint32_t glyph; // Unicode; dots are a braille pattern
    ink ink;
} cell;

typedef struct screen {
    int width, height;
    cell *cells; // row after row
    struct picture_layer
        *pictures; // drawn instead of cells (pictures.h), borrowed; NULL: none
} screen;

// A cell that shows a part of picture k of the screen: GLYPH_PICTURE + k, beyond all
// characters.
#define GLYPH_PICTURE 0x110000u

// The glyphs of lines and signs on it.
enum {
    GLYPH_LINE = 0x2500,       // ─
    GLYPH_THICK_LINE = 0x2501, // ━
    GLYPH_UPRIGHT = 0x2502,    // │
    GLYPH_TICK_LEFT = 0x2524,  // ┤
    GLYPH_TICK_DOWN = 0x252c,  // ┬
    GLYPH_DASHES = 0x254c,     // ╌
    GLYPH_DOTS = 0x2508,       // ┈
    GLYPH_HALF_LINE = 0x2574,  // ╴
    GLYPH_MEASURED = 0x00b7,   // ·
    GLYPH_CURSOR = 0x2506,     // ┆
    GLYPH_LIGHT_SHADE = 0x2591,
    GLYPH_SHADE = 0x2592,
    GLYPH_DARK_SHADE = 0x2593,
    GLYPH_BLOCK = 0x2588,
    GLYPH_DISC = 0x25cf,       // ●
    GLYPH_CIRCLE = 0x25cb,     // ○
    GLYPH_TRIANGLE = 0x25b2,   // ▲
    GLYPH_ARROW_DOWN = 0x25bc, // ▼
    GLYPH_ARROW_UP = 0x2191,   // ↑
    GLYPH_DIAMOND = 0x25c6,    // ◆
    GLYPH_POINTER = 0x25b8     // ▸
};

// Gives a screen width x height empty cells, at least 1 x 1; it keeps its pictures.
void screen_resize(screen *s, int width, int height);
void screen_finish(screen *s);
void screen_clear(screen *s);

// All of these ignore what lies beyond the edges.
void screen_put(screen *s, int x, int y, uint32_t glyph, ink colour);
// Writes UTF-8 text of at most `room` cells and returns how many it took. Control
// characters and bytes that are not UTF-8 become '?'.
int screen_text(screen *s, int x, int y, int room, ink colour, const char *text);
// The same, formatted.
int screen_print(screen *s, int x, int y, int room, ink colour, const char *format, ...)
    __attribute__((format(printf, 6, 7)));
// Writes as many whole words of a text as there is room for, and "…" if any are left out.
// A first word that is wider is split. Returns the cells it took.
int screen_words(screen *s, int x, int y, int room, ink colour, const char *text);
// A frame around a rectangle with a title in its upper edge; its inside is cleared.
void screen_frame(screen *s, int x, int y, int width, int height, ink colour,
                  const char *title);
// Gives the cells of a rectangle another ink.
void screen_tint(screen *s, int x, int y, int width, int height, ink colour);

// A rectangle of cells as a canvas of dots, two a cell across and four down; dots outside
// it are dropped.
typedef struct canvas {
    screen *screen;
    int x, y, width, height; // [cells]
} canvas;

void canvas_dot(const canvas *c, long across, long down, ink colour);
// A line between two points [dots]; either may lie far outside. Points that are not
// finite draw nothing.
void canvas_line(const canvas *c, double x0, double y0, double x1, double y1, ink colour);

// A part of a text that is one line.
typedef struct text_line {
    const char *start;
    int bytes;
} text_line;

// Breaks UTF-8 text at its blanks into lines of at most `width` cells, at most `most` of
// them, and returns how many. A word that is wider is split; *split (may be NULL) says
// whether one was or whether text is left over.
int text_wrap(const char *text, int width, text_line *lines, int most, bool *split);

// The glyph, or the nearest one of the set.
uint32_t glyph_in_set(uint32_t glyph, glyph_set set);
// Reads one character of UTF-8 text and moves *text behind it; '?' for an invalid byte
// and for control characters.
uint32_t glyph_decode(const char **text);
// The number of cells of a UTF-8 text.
int text_cells(const char *text);
// Writes a glyph as UTF-8 with a zero at its end; text has 5 bytes.
void glyph_encode(uint32_t glyph, char *text);

// Prints the grid as lines of text without blanks at their ends.
void screen_dump(const screen *s, glyph_set set, FILE *stream);
