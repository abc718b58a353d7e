// Pictures encoded for terminals: sixel, and the protocol of kitty.
#pragma once

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

// A rectangle of pixels 0xRRGGBB (higher bits are ignored), row by row.
typedef struct pixel_block {
    const uint32_t *pixels;
    int width, height; // [pixels], at least 1
    int stride;        // from one row to the next [pixels]
} pixel_block;

enum { SIXEL_COLOURS = 256 }; // most of one picture

// Writes the block as a sixel picture of at most `colours` (2 to SIXEL_COLOURS) colours, drawn from
// the cursor's cell on. Nearly equal colours are replaced by their mean; if there are more than
// allowed, the rare ones are replaced by the nearest of the others. False without memory, with
// nothing written; errors of the stream stay in it.
bool sixel_write(FILE *stream, const pixel_block *block, int colours);

// Writes the block as picture `number` (above 0) of kitty's protocol, filling columns x rows cells
// from the cursor on, and replaces the previous one of that number. The cursor does not move. False
// without memory, with nothing written.
bool kitty_write(FILE *stream, const pixel_block *block, int number, int columns, int rows);
// Removes picture `number`, or all of them if it is 0.
void kitty_delete(FILE *stream, int number);
