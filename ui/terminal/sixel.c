// Sixel: a picture in bands of six rows. Each band is drawn once for every colour in it, a
// character for each column with a bit for each row; repeated characters are counted.
#include "ui/terminal/pixel_code.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { BIN_BITS = 5, BINS = 1 << (3 * BIN_BITS), BAND = 6 };

// Pixels that are alike in the upper bits of red, green and blue.
typedef struct colour_bin {
    uint64_t red, green, blue; // summed
    uint32_t count;
    int bin;
} colour_bin;

typedef struct sixel_picture {
    const pixel_block *block;
    colour_bin *bins;                                                  // BINS of them
    int colours;                                                       // used
    int red[SIXEL_COLOURS], green[SIXEL_COLOURS], blue[SIXEL_COLOURS]; // of each, 0 to 255
    unsigned char *colour_of;                                          // a bin's
    unsigned char *bits; // of a band: for each colour in it, a row of columns
} sixel_picture;

static int bin_of(uint32_t pixel)
{
    const int shift = 8 - BIN_BITS;
    return (int)((pixel >> (16 + shift) & 31) << 10 | (pixel >> (8 + shift) & 31) << 5 |
                 (pixel >> shift & 31));
}

static int by_count(const void *a, const void *b)
{
    const colour_bin *x = a, *y = b;
    if (x->count != y->count) {
        return x->count < y->count ? 1 : -1;
    }
    return x->bin - y->bin;
}

// The nearest of the picture's colours.
static int nearest_colour(const sixel_picture *p, int red, int green, int blue)
{
    int best = 0;
    long least = 4L * 256 * 256;
    for (int i = 0; i < p->colours; i++) {
        const long r = p->red[i] - red, g = p->green[i] - green, b = p->blue[i] - blue;
        const long distance = r * r + g * g + b * b;
        if (distance < least) {
            least = distance;
            best = i;
        }
    }
    return best;
}

// Chooses the colours: the means of the commonest bins; other bins take the nearest of them.
static void choose_colours(sixel_picture *p, int most)
{
    const pixel_block *b = p->block;
    for (int i = 0; i < BINS; i++) {
        p->bins[i] = (colour_bin){.bin = i};
    }
    for (int y = 0; y < b->height; y++) {
        const uint32_t *row = b->pixels + (long)y * b->stride;
        for (int x = 0; x < b->width; x++) {
            colour_bin *bin = &p->bins[bin_of(row[x])];
            bin->red += row[x] >> 16 & 0xff;
            bin->green += row[x] >> 8 & 0xff;
            bin->blue += row[x] & 0xff;
            bin->count++;
        }
    }

    // only those that occur are sorted
    int used = 0;
    for (int i = 0; i < BINS; i++) {
        if (p->bins[i].count > 0) {
            p->bins[used++] = p->bins[i];
        }
    }
    qsort(p->bins, (size_t)used, sizeof *p->bins, by_count);
    for (int i = 0; i < used; i++) {
        const colour_bin *bin = &p->bins[i];
        const int red = (int)(bin->red / bin->count), green = (int)(bin->green / bin->count);
        const int blue = (int)(bin->blue / bin->count);
        if (i < most) {
            p->red[i] = red;
            p->green[i] = green;
            p->blue[i] = blue;
            p->colours = i + 1;
        }
        p->colour_of[bin->bin] =
            (unsigned char)(i < most ? i : nearest_colour(p, red, green, blue));
    }
}

// One colour of a band: counted characters, without the empty ones at its end.
static void write_row(FILE *stream, const unsigned char *bits, int width)
{
    while (width > 0 && bits[width - 1] == 0) {
        width--;
    }
    for (int x = 0; x < width;) {
        int count = 1;
        while (x + count < width && bits[x + count] == bits[x]) {
            count++;
        }

        // "!" and a count are worth it from four on
        const int character = '?' + bits[x];
        if (count > 3) {
            fprintf(stream, "!%d%c", count, character);
        }
        for (int i = 0; count <= 3 && i < count; i++) {
            putc_unlocked(character, stream);
        }
        x += count;
    }
}

static void write_band(FILE *stream, sixel_picture *p, int top)
{
    const pixel_block *b = p->block;
    int slot[SIXEL_COLOURS], order[SIXEL_COLOURS], slots = 0;
    memset(slot, -1, sizeof slot);

    // the bits of each colour that occurs
    for (int y = top; y < top + BAND && y < b->height; y++) {
        const uint32_t *row = b->pixels + (long)y * b->stride;
        for (int x = 0; x < b->width; x++) {
            const int colour = p->colour_of[bin_of(row[x])];
            if (slot[colour] < 0) {
                slot[colour] = slots;
                memset(p->bits + (long)slots * b->width, 0, (size_t)b->width);
                order[slots++] = colour;
            }
            p->bits[(long)slot[colour] * b->width + x] |= (unsigned char)(1 << (y - top));
        }
    }

    // back to the left between colours, down at the end
    for (int i = 0; i < slots; i++) {
        fprintf(stream, "%s#%d", i > 0 ? "$" : "", order[i]);
        write_row(stream, p->bits + (long)i * b->width, b->width);
    }
    putc_unlocked('-', stream);
}

bool sixel_write(FILE *stream, const pixel_block *block, int colours)
{
    assert(stream != NULL && block != NULL && block->width > 0 && block->height > 0);
    assert(colours >= 2 && colours <= SIXEL_COLOURS);
    sixel_picture p = {.block = block};
    p.bins = malloc(BINS * sizeof *p.bins);
    p.colour_of = calloc(BINS, 1);
    p.bits = malloc((size_t)SIXEL_COLOURS * (size_t)block->width);
    const bool done = p.bins != NULL && p.colour_of != NULL && p.bits != NULL;

    if (done) {
        // no pixel is omitted, so that the background does not matter
        choose_colours(&p, colours);
        fprintf(stream, "\033P0;1;0q\"1;1;%d;%d", block->width, block->height);
        for (int i = 0; i < p.colours; i++) {
            fprintf(stream, "#%d;2;%d;%d;%d", i, (p.red[i] * 100 + 127) / 255,
                    (p.green[i] * 100 + 127) / 255, (p.blue[i] * 100 + 127) / 255);
        }
        for (int top = 0; top < block->height; top += BAND) {
            write_band(stream, &p, top);
        }
        fputs("\033\\", stream);
    }

    free(p.bins);
    free(p.colour_of);
    free(p.bits);
    return done;
}
