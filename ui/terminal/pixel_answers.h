// Whether a terminal draws pictures, and how: the queries to it and its answers. Its name is not
// used; a terminal that does not answer draws none.
//
// The first query is for its version and device attributes, which every terminal accepts without a
// trace on its screen. Only a terminal that answers, and that is not a multiplexer, is asked for
// the kitty protocol: multiplexers pass such a query on or take it for a title. Each query ends
// with the device attributes, so that their answer marks the end of the answers.
#pragma once

#include "ui/terminal/escape_sequence.h"
#include "ui/terminal/ink_colours.h"

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

// Begins; returns the first query. `multiplexer`: there is one according to the environment.
const char *pixel_answers_begin(pixel_answers *a, bool multiplexer);

// Reads an answer; returns the next query, "" for none.
const char *pixel_answers_take(pixel_answers *a, const escape_sequence *answer);

// The query for the size of a cell, which may change with the font.
extern const char pixel_ask_cell[];

// The protocol to draw with.
pixel_protocol pixel_answers_protocol(const pixel_answers *a);
