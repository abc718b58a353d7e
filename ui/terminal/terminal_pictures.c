// Pictures on the terminal: what it says of them, and what is shown.
#include "ui/terminal/terminal.h"
#include "ui/terminal/terminal_state.h"

#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "src/base/text_stream.h"
#include "ui/terminal/paint.h"
#include "ui/terminal/pictures.h"
#include "ui/terminal/pixel_code.h"

enum { USUAL_REGISTERS = SIXEL_COLOURS, LARGEST = 1 << 16 };

// A region on the terminal.
typedef struct shown_region {
    picture_region place;
    uint64_t hash; // of its pixels
} shown_region;

typedef struct shown_pictures {
    shown_region regions[PICTURE_REGIONS];
    int count;
} shown_pictures;

static shown_pictures shown;

// --- answers ----------------------------------------------------------------------------------

bool terminal_take_answer(void)
{
    const terminal_pixels before = terminal_pixels_known();
    const bool asking = tty.pixels.stage != PIXELS_ANSWERED;
    const char *next = pixel_answers_take(&tty.pixels, &tty.sequence);
    terminal_send(next, strlen(next));
    tty.sequence.awaits = tty.pixels.stage != PIXELS_ANSWERED;

    // when all is said: what the questions may have left on the screen goes
    const terminal_pixels now = terminal_pixels_known();
    if (asking && tty.pixels.stage == PIXELS_ANSWERED) {
        if (tty.pixels.kitty) {
            terminal_prepare_crash("\033_Ga=d,d=A,q=2\033\\");
        }
        return true;
    }
    return before.cell_width != now.cell_width || before.cell_height != now.cell_height;
}

void terminal_ask_cell(void)
{
    if (tty.pixels.stage == PIXELS_ANSWERED && tty.pixels.cell_width > 0) {
        tty.sequence.awaits = true;
        terminal_send(pixel_ask_cell, strlen(pixel_ask_cell));
    }
}

terminal_pixels terminal_pixels_known(void)
{
    const pixel_answers *a = &tty.pixels;
    struct winsize size;
    terminal_pixels known = {.cell_width = a->cell_width,
                             .cell_height = a->cell_height,
                             .has_ground = a->has_ground,
                             .ground = a->ground};

    // a terminal may say its size in pixels with that in cells only
    if (known.cell_width == 0 && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 &&
        size.ws_row > 0) {
        known.cell_width = size.ws_xpixel / size.ws_col;
        known.cell_height = size.ws_ypixel / size.ws_row;
    }
    known.there =
        pixel_answers_protocol(a) != PIXELS_NONE && known.cell_width > 1 && known.cell_height > 1;
    return known;
}

// --- showing ----------------------------------------------------------------------------------

// The part of a picture that a region shows.
static pixel_block block_of(const screen *s, const picture_region *r)
{
    const screen_picture *p = &s->pictures->items[r->picture];
    const int cell_width = s->pictures->cell_width, cell_height = s->pictures->cell_height;
    const int stride = cairo_image_surface_get_stride(p->surface) / 4;
    const long offset =
        (long)(r->y - p->y) * cell_height * stride + (long)(r->x - p->x) * cell_width;
    const void *pixels = cairo_image_surface_get_data(p->surface);
    return (pixel_block){(const uint32_t *)pixels + offset, r->width * cell_width,
                         r->height * cell_height, stride};
}

// Fowler, Noll and Vo's hash, of pixels instead of bytes.
static uint64_t hash_of(const pixel_block *b)
{
    uint64_t hash = 14695981039346656037u;
    for (int y = 0; y < b->height; y++) {
        for (int x = 0; x < b->width; x++) {
            hash = (hash ^ (b->pixels[(long)y * b->stride + x] & 0xffffff)) * 1099511628211u;
        }
    }
    return hash;
}

static bool same_place(const picture_region *a, const picture_region *b)
{
    return a->picture == b->picture && a->x == b->x && a->y == b->y && a->width == b->width &&
           a->height == b->height;
}

// Shows the regions that are not on the terminal yet, and remembers them.
static void write_regions(FILE *stream, const screen *s, const picture_region *regions, int count,
                          bool whole)
{
    const bool kitty = tty.pixels.kitty;
    int colours = tty.pixels.registers > 0 ? tty.pixels.registers : USUAL_REGISTERS;
    colours = colours > SIXEL_COLOURS ? SIXEL_COLOURS : colours;
    for (int i = 0; i < count; i++) {
        const picture_region *r = &regions[i];
        const pixel_block block = block_of(s, r);
        const uint64_t hash = hash_of(&block);
        if (!whole && i < shown.count && same_place(&shown.regions[i].place, r) &&
            shown.regions[i].hash == hash) {
            continue;
        }

        // the cursor is kept for other programs that write to the terminal
        fprintf(stream, "\0337\033[%d;%dH", r->y + 1, r->x + 1);
        if (kitty) {
            kitty_write(stream, &block, i + 1, r->width, r->height);
        } else {
            sixel_write(stream, &block, colours);
        }
        fputs("\0338", stream);
        shown.regions[i] = (shown_region){*r, hash};
    }

    // those that are no longer there: blanks have cleared sixels, others are told to go
    for (int i = count; kitty && i < shown.count; i++) {
        kitty_delete(stream, i + 1);
    }
    shown.count = count;
}

void terminal_show_pictures(const screen *s, bool whole)
{
    const pixel_answers *a = &tty.pixels;
    picture_region regions[PICTURE_REGIONS];
    if (pixel_answers_protocol(a) == PIXELS_NONE || (s->pictures == NULL && shown.count == 0)) {
        return;
    }

    // in parts that the terminal takes
    int width = LARGEST, height = LARGEST;
    if (s->pictures != NULL && !a->kitty && a->most_width > 0 && a->most_height > 0) {
        width = a->most_width / s->pictures->cell_width;
        height = a->most_height / s->pictures->cell_height;
    }
    const bool fit = width > 0 && height > 0 && s->pictures != NULL;
    const int count = fit ? pictures_regions(s, width, height, regions) : 0;

    // all of them at once
    const shown_pictures before = shown;
    text_stream all;
    if (text_stream_open(&all)) {
        write_regions(all.stream, s, regions, count, whole);
        size_t size;
        char *bytes = text_stream_close(&all, &size);
        if (bytes != NULL) {
            terminal_send(bytes, size);
        } else {
            shown = before; // no memory: nothing was sent
        }
        free(bytes);
    }
}

void terminal_remove_pictures(void)
{
    static const char all[] = "\033_Ga=d,d=A,q=2\033\\";
    if (tty.pixels.kitty && shown.count > 0) {
        terminal_send(all, sizeof all - 1);
    }
    shown.count = 0;
}
