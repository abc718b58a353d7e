#include "ui/terminal/pixels.h"

#include <assert.h>
#include <glib.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

// --- sixel -----------------------------------------------------------------------------
// Sixel: a picture in bands of six rows. Each band is drawn once for every colour in it,
// a character for each column with a bit for each row; repeated characters are counted.

enum { BIN_BITS = 5, BINS = 1 << (3 * BIN_BITS), BAND = 6 };

// Pixels that are alike in the upper bits of red, green and blue.
typedef struct colour_bin {
    uint64_t red, green, blue; // summed, then their means
    uint32_t count;
    int bin;
} colour_bin;

typedef struct sixel_picture {
    const pixel_block *block;
    colour_bin *bins;         // BINS of them; the first are the colours
    int colours;              // used
    unsigned char *colour_of; // a bin's
    unsigned char *bits;      // of a band: for each colour in it, a row of columns
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
    if (x->count < y->count) {
        return 1;
    }
    if (x->count > y->count) {
        return -1;
    }
    return x->bin - y->bin;
}

// The nearest of the picture's colours.
static int nearest_colour(const sixel_picture *p, const colour_bin *wanted)
{
    int best = 0;
    long least = 4L * 256 * 256;
    for (int i = 0; i < p->colours; i++) {
        const colour_bin *c = &p->bins[i];
        const long r = (long)c->red - (long)wanted->red,
                   g = (long)c->green - (long)wanted->green;
        const long b = (long)c->blue - (long)wanted->blue,
                   distance = r * r + g * g + b * b;
        if (distance < least) {
            least = distance;
            best = i;
        }
    }
    return best;
}

// Chooses the colours: the means of the commonest bins; other bins take the nearest of
// them.
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
    if (used < most) {
        p->colours = used;
    } else {
        p->colours = most;
    }
    for (int i = 0; i < used; i++) {
        colour_bin *bin = &p->bins[i];
        bin->red /= bin->count;
        bin->green /= bin->count;
        bin->blue /= bin->count;
        p->colour_of[bin->bin] = (unsigned char)(i < most ? i : nearest_colour(p, bin));
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
    assert(block->width > 0 && block->height > 0);
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
            const colour_bin *c = &p.bins[i];
            fprintf(stream, "#%d;2;%d;%d;%d", i, (int)(c->red * 100 + 127) / 255,
                    (int)(c->green * 100 + 127) / 255, (int)(c->blue * 100 + 127) / 255);
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

// --- kitty -----------------------------------------------------------------------------
// The terminal graphics protocol of kitty: pixels, compressed by zlib, in base 64, in
// chunks.

enum { CHUNK = 4096, CHUNK_BYTES = CHUNK / 4 * 3 };

bool kitty_write(FILE *stream, const pixel_block *block, int number, int columns,
                 int rows)
{
    assert(block->width > 0 && block->height > 0);
    assert(number > 0 && columns > 0 && rows > 0);
    const size_t size = 3 * (size_t)block->width * (size_t)block->height;
    uLongf packed_size = compressBound(size);
    unsigned char *plain = malloc(size), *packed = malloc(packed_size), *at = plain;

    // red, green and blue, row after row
    for (int y = 0; plain != NULL && y < block->height; y++) {
        const uint32_t *row = block->pixels + (long)y * block->stride;
        for (int x = 0; x < block->width; x++) {
            *at++ = (unsigned char)(row[x] >> 16);
            *at++ = (unsigned char)(row[x] >> 8);
            *at++ = (unsigned char)row[x];
        }
    }
    const bool done = plain != NULL && packed != NULL &&
                      compress2(packed, &packed_size, plain, size, Z_BEST_SPEED) == Z_OK;

    // the first chunk says what it is, all but the last that more come; no answer is
    // wanted
    for (size_t sent = 0; done && sent < packed_size; sent += CHUNK_BYTES) {
        const size_t left = packed_size - sent,
                     count = left < CHUNK_BYTES ? left : CHUNK_BYTES;
        fputs("\033_G", stream);
        if (sent == 0) {
            fprintf(stream, "a=T,i=%d,p=1,f=24,s=%d,v=%d,c=%d,r=%d,o=z,C=1,q=2,", number,
                    block->width, block->height, columns, rows);
        }
        fprintf(stream, "m=%d;", left > CHUNK_BYTES);
        gchar *coded = g_base64_encode(packed + sent, count);
        fputs(coded, stream);
        g_free(coded);
        fputs("\033\\", stream);
    }

    free(plain);
    free(packed);
    return done;
}

// --- what a terminal says --------------------------------------------------------------

enum {
    KITTY_QUESTION = 31, // number of the picture in the question
    SIXEL_ATTRIBUTE = 4, // among the device attributes
    LEAST_CELL = 2,      // [pixels]
    MOST_CELL = 200,     // [pixels]
    LEAST_REGISTERS = 2, // a terminal that says less is taken to have said nothing
    MOST_SAID = 1 << 20, // no number beyond this is believed
};

// version, device attributes
static const char ask_name[] = "\033[>q\033[c";

// a picture of one pixel, not to be shown; colours and size of sixel pictures; the
// ground's colour, the size of a cell, device attributes
#define ASK_KITTY "\033_Gi=31,s=1,v=1,a=q,t=d,f=24;AAAA\033\\"
#define ASK_SIXEL "\033[?1;1;0S\033[?2;1;0S"
#define ASK_REST  "\033]11;?\033\\\033[16t\033[c"

// by whether kitty's protocol and whether sixels are asked for
static const char *const ask_pixels[2][2] = {{ASK_REST, ASK_SIXEL ASK_REST},
                                             {ASK_KITTY ASK_REST,
                                              ASK_KITTY ASK_SIXEL ASK_REST}};

const char pixel_ask_cell[] = "\033[16t";

const char *pixel_answers_begin(pixel_answers *a, bool multiplexer)
{
    *a = (pixel_answers){.stage = PIXELS_ASKED_NAME, .multiplexer = multiplexer};
    return ask_name;
}

// Reads up to `most` numbers between semicolons from text; returns how many there are.
static int read_numbers(const char *text, int *numbers, int most)
{
    int count = 0;
    for (bool more = true; more && count < most;) {
        char *end;
        const long value = strtol(text, &end, 10);
        const bool taken = end != text && value >= 0 && value <= MOST_SAID;
        numbers[count] = (int)value;
        count += taken;
        more = taken && *end == ';';
        text = end + 1;
    }
    return count;
}

static const char *take_attributes(pixel_answers *a, const char *text)
{
    int numbers[32];
    const int count = read_numbers(text, numbers, 32);

    // each number but the first is something that the terminal can do
    for (int i = 1; i < count; i++) {
        a->sixel = a->sixel || numbers[i] == SIXEL_ATTRIBUTE;
    }
    if (a->stage == PIXELS_ASKED_NAME) {
        a->stage = PIXELS_ASKED;
        return ask_pixels[!a->multiplexer][a->sixel];
    }
    a->stage = PIXELS_ANSWERED;
    return "";
}

// "rgb:ffff/ffff/ffff", in two or four digits each.
static void take_ground(pixel_answers *a, const char *text)
{
    unsigned red, green, blue;
    int digits = 0;
    if (sscanf(text, "rgb:%4x/%n%4x/%4x", &red, &digits, &green, &blue) != 3) {
        return;
    }
    const unsigned shift = digits == 9 ? 8 : 0;
    a->ground = (rgb){(unsigned char)(red >> shift), (unsigned char)(green >> shift),
                      (unsigned char)(blue >> shift)};
    a->has_ground = true;
}

// "6;HEIGHT;WIDTH" of a cell, "1;0;COLOURS" or "2;0;WIDTH;HEIGHT" of sixel pictures.
static void take_sizes(pixel_answers *a, const char *text, char final)
{
    int n[4];
    const int count = read_numbers(text, n, 4);
    if (final == 't' && count == 3 && n[0] == 6) {
        const bool usual = n[1] >= LEAST_CELL && n[1] <= MOST_CELL &&
                           n[2] >= LEAST_CELL && n[2] <= MOST_CELL;
        if (usual) {
            a->cell_height = n[1];
        } else {
            a->cell_height = 0;
        }
        if (usual) {
            a->cell_width = n[2];
        } else {
            a->cell_width = 0;
        }
    } else if (final == 'S' && count >= 3 && n[0] == 1 && n[1] == 0) {
        if (n[2] >= LEAST_REGISTERS) {
            a->registers = n[2];
        } else {
            a->registers = 0;
        }
    } else if (final == 'S' && count == 4 && n[0] == 2 && n[1] == 0) {
        a->most_width = n[2];
        a->most_height = n[3];
    }
}

const char *pixel_answers_take(pixel_answers *a, const escape_sequence *answer)
{
    const char *text = answer->text, kind = answer->introducer;
    const bool asked = a->stage == PIXELS_ASKED, private = text[0] == '?';
    int number = 0;
    if (a->stage == PIXELS_UNASKED) {
        return "";
    }

    // by what begins and ends it; "Gi=31;OK": the picture could be read
    if (kind == '[' && answer->final == 'c' && private && a->stage != PIXELS_ANSWERED) {
        return take_attributes(a, text + 1);
    } else if (kind == '[') {
        take_sizes(a, text + private, answer->final);
    } else if (kind == 'P') {
        a->multiplexer = a->multiplexer || strncmp(text, ">|tmux", 6) == 0;
    } else if (kind == ']' && asked && strncmp(text, "11;", 3) == 0) {
        take_ground(a, text + 3);
    } else if (kind != ']' && asked && sscanf(text, "Gi=%d;", &number) == 1) {
        a->kitty = a->kitty || (number == KITTY_QUESTION && strstr(text, ";OK") != NULL);
    }
    return "";
}

pixel_protocol pixel_answers_protocol(const pixel_answers *a)
{
    if (a->stage != PIXELS_ANSWERED) {
        return PIXELS_NONE;
    }
    if (a->kitty) {
        return PIXELS_KITTY;
    }
    if (a->sixel) {
        return PIXELS_SIXEL;
    }
    return PIXELS_NONE;
}
