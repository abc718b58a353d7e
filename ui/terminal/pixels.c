#include "ui/terminal/pixels.h"

#include <assert.h>
#include <glib.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

// --- sixel -----------------------------------------------------------------------------
// Sixel: a picture in bands of six rows. Each band is drawn once for every colour in it,
// a character for each column with a bit for each row; repeated characters are counted.

enum { BIN_BITS = 5, BINS = 1 << (3 * BIN_BITS), BAND_ROWS = 6 };

// Pixels that are alike in the upper bits of red, green and blue.
typedef struct colour_bin {
    uint64_t red, green, blue; // summed, then their means
    uint32_t count;
    int bin;
} colour_bin;

typedef struct sixel_picture {
    const pixel_block *block;
    colour_bin *bins;         // BINS of them; the first are the picture's colours
    int colours;              // how many
    unsigned char *colour_of; // the colour of each bin
    unsigned char *bits;      // of a band: for each colour in it, a row of columns
} sixel_picture;

// The bin of a pixel 0xRRGGBB.
static int bin_of(uint32_t pixel)
{
    const int shift = 8 - BIN_BITS;
    return (int)((pixel >> (16 + shift) & 31) << 10 | (pixel >> (8 + shift) & 31) << 5 |
                 (pixel >> shift & 31));
}

// Orders bins from the commonest to the rarest, for qsort.
static int compare_by_count(const void *a, const void *b)
{
    const colour_bin *left = a, *right = b;
    if (left->count < right->count) {
        return 1;
    }
    if (left->count > right->count) {
        return -1;
    }
    return left->bin - right->bin;
}

// The nearest of the picture's colours.
static int nearest_colour(const sixel_picture *p, const colour_bin *wanted)
{
    int best = 0;
    long least = 4L * 256 * 256;
    for (int i = 0; i < p->colours; i++) {
        const colour_bin *c = &p->bins[i];
        const long red = (long)c->red - (long)wanted->red;
        const long green = (long)c->green - (long)wanted->green;
        const long blue = (long)c->blue - (long)wanted->blue;
        const long distance = red * red + green * green + blue * blue;
        if (distance < least) {
            least = distance;
            best = i;
        }
    }
    return best;
}

// Sums the pixels of each bin.
static void fill_bins(sixel_picture *p)
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
}

// Chooses the colours: the means of the commonest bins; other bins take the nearest of
// them.
static void choose_colours(sixel_picture *p, int most)
{
    fill_bins(p);

    // only those that occur are sorted
    int used = 0;
    for (int i = 0; i < BINS; i++) {
        if (p->bins[i].count > 0) {
            p->bins[used++] = p->bins[i];
        }
    }
    qsort(p->bins, (size_t)used, sizeof *p->bins, compare_by_count);

    // sums become means; the commonest are colours as they are
    p->colours = used < most ? used : most;
    for (int i = 0; i < used; i++) {
        colour_bin *bin = &p->bins[i];
        bin->red /= bin->count;
        bin->green /= bin->count;
        bin->blue /= bin->count;

        int colour = i;
        if (i >= most) {
            colour = nearest_colour(p, bin);
        }
        p->colour_of[bin->bin] = (unsigned char)colour;
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
        } else {
            for (int i = 0; i < count; i++) {
                putc_unlocked(character, stream);
            }
        }
        x += count;
    }
}

// The band of rows from `top` on, colour by colour.
static void write_band(FILE *stream, sixel_picture *p, int top)
{
    const pixel_block *b = p->block;
    int slot_of[SIXEL_COLOURS], colour_in[SIXEL_COLOURS], slots = 0;
    memset(slot_of, -1, sizeof slot_of);

    // each colour that occurs has a slot of bits
    for (int y = top; y < top + BAND_ROWS && y < b->height; y++) {
        const uint32_t *row = b->pixels + (long)y * b->stride;
        for (int x = 0; x < b->width; x++) {
            const int colour = p->colour_of[bin_of(row[x])];
            if (slot_of[colour] < 0) {
                memset(p->bits + (long)slots * b->width, 0, (size_t)b->width);
                slot_of[colour] = slots;
                colour_in[slots++] = colour;
            }
            p->bits[(long)slot_of[colour] * b->width + x] |=
                (unsigned char)(1 << (y - top));
        }
    }

    // back to the left between colours, down at the end
    for (int i = 0; i < slots; i++) {
        if (i > 0) {
            putc_unlocked('$', stream);
        }
        fprintf(stream, "#%d", colour_in[i]);
        write_row(stream, p->bits + (long)i * b->width, b->width);
    }
    putc_unlocked('-', stream);
}

// A share of 255 in hundredths, rounded.
static int percent_of(uint64_t share)
{
    return (int)(share * 100 + 127) / 255;
}

void sixel_write(FILE *stream, const pixel_block *block, int colours)
{
    assert(block->width > 0 && block->height > 0);
    assert(colours >= 2 && colours <= SIXEL_COLOURS);
    g_autofree colour_bin *bins = g_new(colour_bin, BINS);
    g_autofree unsigned char *colour_of = g_new0(unsigned char, BINS);
    g_autofree unsigned char *bits =
        g_new(unsigned char, (size_t)SIXEL_COLOURS *(size_t)block->width);
    sixel_picture p = {.block = block,
                       .bins = bins,
                       .colour_of = colour_of,
                       .bits = bits};
    choose_colours(&p, colours);

    // size and colours; no pixel is omitted, so that the background does not matter
    fprintf(stream, "\033P0;1;0q\"1;1;%d;%d", block->width, block->height);
    for (int i = 0; i < p.colours; i++) {
        const colour_bin *c = &p.bins[i];
        fprintf(stream, "#%d;2;%d;%d;%d", i, percent_of(c->red), percent_of(c->green),
                percent_of(c->blue));
    }

    // the picture
    for (int top = 0; top < block->height; top += BAND_ROWS) {
        write_band(stream, &p, top);
    }
    fputs("\033\\", stream);
}

// --- kitty -----------------------------------------------------------------------------
// The terminal graphics protocol of kitty: pixels, compressed by zlib, in base 64, in
// chunks.

enum { CHUNK = 4096, CHUNK_BYTES = CHUNK / 4 * 3 }; // coded, and what it codes

// Red, green and blue of all pixels, row after row.
static unsigned char *plain_pixels(const pixel_block *block, size_t size)
{
    unsigned char *plain = g_new(unsigned char, size), *at = plain;
    for (int y = 0; y < block->height; y++) {
        const uint32_t *row = block->pixels + (long)y * block->stride;
        for (int x = 0; x < block->width; x++) {
            *at++ = (unsigned char)(row[x] >> 16);
            *at++ = (unsigned char)(row[x] >> 8);
            *at++ = (unsigned char)row[x];
        }
    }
    return plain;
}

void kitty_write(FILE *stream, const pixel_block *block, int number, int columns,
                 int rows)
{
    assert(block->width > 0 && block->height > 0);
    assert(number > 0 && columns > 0 && rows > 0);
    const size_t size = 3 * (size_t)block->width * (size_t)block->height;
    uLongf packed_size = compressBound(size);
    g_autofree unsigned char *plain = plain_pixels(block, size);
    g_autofree unsigned char *packed = g_new(unsigned char, packed_size);
    if (compress2(packed, &packed_size, plain, size, Z_BEST_SPEED) != Z_OK) {
        g_error("out of memory");
    }

    // the first chunk says what it is, all but the last that more come; no answer is
    // wanted
    for (size_t sent = 0; sent < packed_size; sent += CHUNK_BYTES) {
        const size_t left = packed_size - sent;
        const bool last = left <= CHUNK_BYTES;
        fputs("\033_G", stream);
        if (sent == 0) {
            fprintf(stream, "a=T,i=%d,p=1,f=24,s=%d,v=%d,c=%d,r=%d,o=z,C=1,q=2,", number,
                    block->width, block->height, columns, rows);
        }
        g_autofree gchar *coded =
            g_base64_encode(packed + sent, last ? left : CHUNK_BYTES);
        fprintf(stream, "m=%d;%s\033\\", !last, coded);
    }
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

// What answers begin with, as they are given back with what was asked.
enum { CELL_SIZE = 6, SIXEL_REGISTERS = 1, SIXEL_SIZE = 2 };

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
    while (count < most) {
        char *end;
        const long value = strtol(text, &end, 10);
        if (end == text || value < 0 || value > MOST_SAID) {
            break;
        }
        numbers[count++] = (int)value;
        if (*end != ';') {
            break;
        }
        text = end + 1;
    }
    return count;
}

// The device attributes, which end the answers to a query; returns the next query.
static const char *take_attributes(pixel_answers *a, const char *text)
{
    int numbers[32];
    const int count = read_numbers(text, numbers, 32);

    // each number but the first is something that the terminal can do
    for (int i = 1; i < count; i++) {
        if (numbers[i] == SIXEL_ATTRIBUTE) {
            a->sixel = true;
        }
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

// Whether a cell of that size [pixels] is to be believed.
static bool is_usual_cell(int height, int width)
{
    return height >= LEAST_CELL && height <= MOST_CELL && width >= LEAST_CELL &&
           width <= MOST_CELL;
}

// "6;HEIGHT;WIDTH" of a cell, "1;0;COLOURS" or "2;0;WIDTH;HEIGHT" of sixel pictures.
static void take_sizes(pixel_answers *a, const char *text, char final)
{
    int n[4];
    const int count = read_numbers(text, n, 4);
    const bool of_sixels = final == 'S' && count >= 3 && n[1] == 0;

    if (final == 't' && count == 3 && n[0] == CELL_SIZE) {
        const bool usual = is_usual_cell(n[1], n[2]);
        a->cell_height = usual ? n[1] : 0;
        a->cell_width = usual ? n[2] : 0;
    } else if (of_sixels && n[0] == SIXEL_REGISTERS) {
        a->registers = n[2] >= LEAST_REGISTERS ? n[2] : 0;
    } else if (of_sixels && count == 4 && n[0] == SIXEL_SIZE) {
        a->most_width = n[2];
        a->most_height = n[3];
    }
}

// Whether a text is kitty's answer that it could read the picture: "Gi=31;OK".
static bool is_kitty_consent(const char *text)
{
    int number = 0;
    return sscanf(text, "Gi=%d;", &number) == 1 && number == KITTY_QUESTION &&
           strstr(text, ";OK") != NULL;
}

const char *pixel_answers_take(pixel_answers *a, const escape_sequence *answer)
{
    const char *text = answer->text, kind = answer->introducer;
    const bool asked = a->stage == PIXELS_ASKED, private = text[0] == '?';
    if (a->stage == PIXELS_UNASKED) {
        return "";
    }

    // by what begins and ends it
    if (kind == '[' && answer->final == 'c' && private && a->stage != PIXELS_ANSWERED) {
        return take_attributes(a, text + 1);
    }
    if (kind == '[') {
        take_sizes(a, private ? text + 1 : text, answer->final);
    } else if (kind == 'P' && strncmp(text, ">|tmux", 6) == 0) {
        a->multiplexer = true;
    } else if (kind == ']' && asked && strncmp(text, "11;", 3) == 0) {
        take_ground(a, text + 3);
    } else if (kind == '_' && asked && is_kitty_consent(text)) {
        a->kitty = true;
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
