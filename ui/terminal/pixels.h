// Pixels on terminals: the two codes that draw them, sixel and the protocol of kitty, and
// whether a terminal knows one.
#pragma once

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "ui/terminal/escape_sequence.h"
#include "ui/terminal/ink_colours.h"

// --- codes -----------------------------------------------------------------------------

// A rectangle of pixels 0xRRGGBB (higher bits are ignored), row by row.
typedef struct pixel_block {
    const uint32_t *pixels;
    int width, height; // [pixels], at least 1
    int stride;        // from one row to the next [pixels]
} pixel_block;

enum { SIXEL_COLOURS = 256 }; // most of one picture

// Writes the block as a sixel picture of at most `colours` (2 to SIXEL_COLOURS) colours,
// drawn from the cursor's cell on. Nearly equal colours are replaced by their mean; if
// there are more than allowed, the rare ones are replaced by the nearest of the others.
// Errors of the stream stay in it.
void sixel_write(FILE *stream, const pixel_block *block, int colours);

// Writes the block as picture `number` (above 0) of kitty's protocol, filling columns x
// rows cells from the cursor on, and replaces the previous one of that number. The cursor
// does not move.
void kitty_write(FILE *stream, const pixel_block *block, int number, int columns,
                 int rows);

// --- what a terminal says --------------------------------------------------------------
// Whether a terminal draws pictures, and how: the queries to it and its answers. Its name
// is not used; a terminal that does not answer draws none.
//
// The first query is for its version and device attributes, which every terminal accepts
// without a trace on its screen. Only a terminal that answers, and that is not a
// multiplexer, is asked for the kitty protocol: multiplexers pass such a query on or take
// it for a title. Each query ends with the device attributes, so that their answer marks
// the end of the answers.

typedef enum pixel_protocol { PIXELS_NONE, PIXELS_SIXEL, PIXELS_KITTY } pixel_protocol;

typedef struct pixel_answers {
    enum { PIXELS_UNASKED, PIXELS_ASKED_NAME, PIXELS_ASKED, PIXELS_ANSWERED } stage;
    bool multiplexer;
    bool sixel, kitty;
    int cell_width, cell_height; // [pixels]; 0: not known
    int registers;               // colours of a sixel picture; 0: not known
    int most_width, most_height; // of a sixel picture [pixels]; 0: not known
    bool has_ground;
    rgb ground; // of the terminal, if known
} pixel_answers;

// Begins; returns the first query. `multiplexer`: there is one according to the
// environment.
const char *pixel_answers_begin(pixel_answers *a, bool multiplexer);

// Reads an answer; returns the next query, "" for none.
const char *pixel_answers_take(pixel_answers *a, const escape_sequence *answer);

// The query for the size of a cell, which may change with the font.
extern const char pixel_ask_cell[];

// The protocol to draw with.
pixel_protocol pixel_answers_protocol(const pixel_answers *a);
