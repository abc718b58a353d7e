// Pictures for terminals: the output is decoded and compared with the drawing, and
// terminals are believed only what they answer.
#include "tests/explorer_on_screen.h"

#include <zlib.h>

#include "ui/terminal/pictures.h"
#include "ui/terminal/pixels.h"

// Pixels as a terminal has them, 0xRRGGBB.
typedef struct decoded {
    int width, height;
    uint32_t *pixels;
} decoded;

#define UNSET 0xff000000u // of a pixel that was not drawn

static decoded unset_pixels(int width, int height)
{
    const long count = (long)width * height;
    decoded d = {width, height, malloc((size_t)count * sizeof *d.pixels)};
    assert_non_null(d.pixels);
    for (long i = 0; i < count; i++) {
        d.pixels[i] = UNSET;
    }
    return d;
}

static void forget(decoded *d)
{
    free(d->pixels);
}

// --- decoders --------------------------------------------------------------------------

// The pixels that a terminal of 1988 (VT340) shows of a sixel picture. "#n" chooses a
// colour and "#n;2;r;g;b" defines one in percent; "!n" repeats the next character n
// times; "$" returns to the left margin and "-" goes to the next band of six rows. Any
// other character, less "?", has a bit for each of the six pixels below each other.
static decoded decode_sixel(const char *text)
{
    uint32_t colours[SIXEL_COLOURS] = {0}, colour = 0;
    int width, height, x = 0, top = 0, n[5], used = 0;
    assert_int_equal(strncmp(text, "\033P0;1;0q\"1;1;", 13), 0);
    assert_int_equal(sscanf(text + 13, "%d;%d%n", &width, &height, &used), 2);
    const decoded d = unset_pixels(width, height);
    for (const char *at = text + 13 + used; *at != '\033';) {
        // a colour
        int count = 1;
        if (*at == '#') {
            const int numbers =
                sscanf(at, "#%d;%d;%d;%d;%d", &n[0], &n[1], &n[2], &n[3], &n[4]);
            assert_in_range(n[0], 0, SIXEL_COLOURS - 1);
            if (numbers == 5) {
                assert_int_equal(n[1], 2);
                colours[n[0]] = (uint32_t)((n[2] * 255 + 50) / 100) << 16 |
                                (uint32_t)((n[3] * 255 + 50) / 100) << 8 |
                                (uint32_t)((n[4] * 255 + 50) / 100);
            } else {
                assert_int_equal(numbers, 1);
                colour = colours[n[0]];
            }
            at += 1 + strspn(at + 1, "0123456789;");
            continue;
        }

        // a repetition
        if (*at == '!') {
            assert_int_equal(sscanf(at, "!%d%n", &count, &used), 1);
            at += used;
        }

        // a new line, or pixels
        if (*at == '$') {
            x = 0;
        } else if (*at == '-') {
            x = 0;
            top += 6;
        } else {
            assert_in_range(*at, '?', '~');
            for (int i = 0; i < count; i++, x++) {
                for (int row = 0; row < 6; row++) {
                    if ((*at - '?') >> row & 1) {
                        assert_true(x < d.width && top + row < d.height);
                        // each pixel is drawn once
                        assert_int_equal(d.pixels[(long)(top + row) * d.width + x],
                                         UNSET);
                        d.pixels[(long)(top + row) * d.width + x] = colour;
                    }
                }
            }
        }
        at++;
    }
    return d;
}

static int digit_of(char c)
{
    static const char digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *found = strchr(digits, c);
    assert_non_null(found);
    return (int)(found - digits);
}

// The pixels that the terminal kitty shows of one picture. Its bytes, red, green and
// blue, are compressed by zlib, coded in base 64 and sent in chunks of at most 4096
// characters; m=1 in a chunk's head says that more chunks follow.
static decoded decode_kitty(const char *text, int *columns, int *rows)
{
    SCOPED(free_kept) unsigned char *packed = malloc(strlen(text));
    size_t size = 0;
    int number, width, height, more = 1, used;
    assert_int_equal(
        sscanf(text, "\033_Ga=T,i=%d,p=1,f=24,s=%d,v=%d,c=%d,r=%d,o=z,C=1,q=2,m=%d;%n",
               &number, &width, &height, columns, rows, &more, &used),
        6);
    const char *at = text + used;
    for (;;) {
        // four characters of base 64 are three bytes; each "=" at the end is one byte
        // less
        const char *end = strchr(at, '\033');
        assert_int_equal((end - at) % 4, 0);
        assert_true(end - at <= 4096);
        for (; at < end; at += 4) {
            unsigned bits = 0;
            for (int i = 0; i < 4; i++) {
                bits = bits << 6 | (unsigned)(at[i] == '=' ? 0 : digit_of(at[i]));
            }
            packed[size++] = (unsigned char)(bits >> 16);
            packed[size++] = (unsigned char)(bits >> 8);
            packed[size++] = (unsigned char)bits;
            for (int i = 2; i < 4; i++) {
                if (at[i] == '=') {
                    size--;
                }
            }
        }

        // the end of the chunk, and the head of the next one
        assert_int_equal(strncmp(end, "\033\\", 2), 0);
        at = end + 2;
        if (more == 0) {
            break;
        }
        assert_int_equal(sscanf(at, "\033_Gm=%d;%n", &more, &used), 1);
        at += used;
    }
    assert_int_equal(*at, '\0');

    // uncompressed it is exactly the picture's size
    const decoded d = unset_pixels(width, height);
    uLongf plain_size = 3 * (uLongf)d.width * (uLongf)d.height, wanted = plain_size;
    SCOPED(free_kept) unsigned char *plain = malloc(plain_size);
    assert_int_equal(uncompress(plain, &plain_size, packed, size), Z_OK);
    assert_int_equal(plain_size, wanted);
    for (long i = 0; i < (long)d.width * d.height; i++) {
        d.pixels[i] = (uint32_t)plain[3 * i] << 16 | (uint32_t)plain[3 * i + 1] << 8 |
                      plain[3 * i + 2];
    }
    return d;
}

// --- what is drawn ---------------------------------------------------------------------

// A screen with pictures of the explorer, cells of 8 x 16 pixels.
static void draw_pictures(explorer *ex, screen *s, picture_layer *layer)
{
    *layer = (picture_layer){.cell_width = 8, .cell_height = 16};
    s->pictures = layer;
    screen_resize(s, 120, 40);
    explorer_draw(ex, s);
    assert_true(layer->count >= 3);
}

// A surface as a PNG and back again.
static decoded through_png(cairo_surface_t *surface)
{
    assert_int_equal(cairo_surface_write_to_png(surface, "pixels.png"),
                     CAIRO_STATUS_SUCCESS);
    cairo_surface_t *read = cairo_image_surface_create_from_png("pixels.png");
    const decoded d = unset_pixels(cairo_image_surface_get_width(read),
                                   cairo_image_surface_get_height(read));
    for (int y = 0; y < d.height; y++) {
        const unsigned char *row = cairo_image_surface_get_data(read) +
                                   (long)y * cairo_image_surface_get_stride(read);
        memcpy(d.pixels + (long)y * d.width, row, (size_t)d.width * 4);
    }
    cairo_surface_destroy(read);
    return d;
}

// The largest difference of a channel, and how many different colours there are in b.
static int difference(const decoded *a, const decoded *b)
{
    int most = 0;
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    for (long i = 0; i < (long)a->width * a->height; i++) {
        assert_int_not_equal(a->pixels[i], UNSET);
        for (int shift = 0; shift < 24; shift += 8) {
            const int x = (int)(a->pixels[i] >> shift & 0xff),
                      y = (int)(b->pixels[i] >> shift & 0xff);
            most = abs(x - y) > most ? abs(x - y) : most;
        }
    }
    return most;
}

static pixel_block block_of(cairo_surface_t *surface)
{
    const void *data = cairo_image_surface_get_data(surface);
    return (pixel_block){data, cairo_image_surface_get_width(surface),
                         cairo_image_surface_get_height(surface),
                         cairo_image_surface_get_stride(surface) / 4};
}

TEST_IN_FOLDER(test_what_is_written_is_the_picture)
{
    SCOPED(screen_finish) screen s = {0};
    SCOPED(pictures_finish) picture_layer layer;
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":seek 0.35<Enter>");
    draw_pictures(&ex, &s, &layer);
    for (int i = 0; i < layer.count; i++) {
        const screen_picture *p = &layer.items[i];
        const pixel_block block = block_of(p->surface);
        int columns, rows;
        SCOPED(forget) decoded png = through_png(p->surface);
        assert_int_equal(png.width, 8 * p->width);
        assert_int_equal(png.height, 16 * p->height);

        // five bits of each colour, and hundredths of it
        SCOPED(free_kept)
        WRITTEN(lines, sixel_write(stream, &block, SIXEL_COLOURS));
        SCOPED(forget) decoded sixel = decode_sixel(lines);
        assert_in_range(difference(&sixel, &png), 0, 10);

        // to the bit
        SCOPED(free_kept)
        WRITTEN(text, kitty_write(stream, &block, i + 1, p->width, p->height));
        SCOPED(forget) decoded kitty = decode_kitty(text, &columns, &rows);
        assert_int_equal(columns, p->width);
        assert_int_equal(rows, p->height);
        assert_int_equal(difference(&kitty, &png), 0);
    }
}

TEST(test_few_registers_are_enough)
{
    uint32_t pixels[64 * 20];
    // a ground, a line and all that lies between them
    for (int i = 0; i < 64 * 20; i++) {
        pixels[i] = i % 64 < 30   ? 0x000010
                    : i % 64 < 50 ? 0xf08020
                                  : (uint32_t)(i % 64 * 0x030201);
    }
    const pixel_block block = {pixels, 64, 20, 64};
    SCOPED(free_kept) WRITTEN(text, sixel_write(stream, &block, 4));
    assert_null(strstr(text, "#4"));
    SCOPED(forget) decoded d = decode_sixel(text);
    // the commonest are as they were
    const decoded first = {30, 1, d.pixels}, wanted = {30, 1, pixels};
    assert_in_range(difference(&first, &wanted), 0, 2);
}

// The colour that most pixels of a surface near to it have, other than the ground.
static long pixels_like(cairo_surface_t *surface, rgb c)
{
    const pixel_block b = block_of(surface);
    long count = 0;
    for (int y = 0; y < b.height; y++) {
        for (int x = 0; x < b.width; x++) {
            const uint32_t p = b.pixels[(long)y * b.stride + x];
            count += abs((int)(p >> 16 & 0xff) - c.red) < 12 &&
                     abs((int)(p >> 8 & 0xff) - c.green) < 12 &&
                     abs((int)(p & 0xff) - c.blue) < 12;
        }
    }
    return count;
}

TEST(test_arm_and_force_are_in_the_picture)
{
    SCOPED(screen_finish) screen s = {0};
    SCOPED(pictures_finish) picture_layer layer;
    rgb arm, force;
    ink_rgb(COLOURS_DARK, INK_ARM, &arm);
    ink_rgb(COLOURS_DARK, INK_FORCE, &force);
    OPEN_EXPLORER(ex, "corrected/first-impact");

    // in flight no force, in contact an arrow; the close-up comes first
    draw_pictures(&ex, &s, &layer);
    assert_true(pixels_like(layer.items[1].surface, arm) > 300);
    assert_int_equal(pixels_like(layer.items[1].surface, force), 0);
    pictures_finish(&layer);
    press(&ex, ":seek 0.35<Enter>");
    draw_pictures(&ex, &s, &layer);
    assert_true(pixels_like(layer.items[1].surface, force) > 50);
    assert_true(pixels_like(layer.items[0].surface, force) > 100);
}

TEST(test_what_lies_over_a_picture_is_seen)
{
    SCOPED(screen_finish) screen s = {0};
    SCOPED(pictures_finish) picture_layer layer;
    picture_region regions[PICTURE_REGIONS];
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":s");
    draw_pictures(&ex, &s, &layer);

    // no region has a cell that shows a letter, and every cell that shows a picture is in
    // one
    const int count = pictures_regions(&s, 1000, 1000, regions);
    long cells = 0, shown = 0;
    assert_int_not_equal(count, layer.count);
    for (int i = 0; i < count; i++) {
        const picture_region *r = &regions[i];
        shown += (long)r->width * r->height;
        for (int y = r->y; y < r->y + r->height; y++) {
            for (int x = r->x; x < r->x + r->width; x++) {
                assert_int_equal(s.cells[(long)y * s.width + x].glyph,
                                 GLYPH_PICTURE + (uint32_t)r->picture);
            }
        }
    }
    for (long i = 0; i < (long)s.width * s.height; i++) {
        cells += s.cells[i].glyph >= GLYPH_PICTURE;
    }
    assert_int_equal(shown, cells);

    // no larger than a terminal takes
    const int small = pictures_regions(&s, 7, 3, regions);
    for (int i = 0; i < small; i++) {
        assert_true(regions[i].width <= 7 && regions[i].height <= 3);
    }
}

// What cairo could not draw is not shown: words stand there, and the next drawing begins
// anew.
TEST(test_a_picture_that_failed_is_words)
{
    SCOPED(screen_finish) screen s = {0};
    SCOPED(pictures_finish) picture_layer layer = {.cell_width = 8, .cell_height = 16};
    picture_region regions[PICTURE_REGIONS];
    s.pictures = &layer;
    screen_resize(&s, 60, 20);

    picture_end(&s, picture_begin(&s, 0, 0, 50, 5));
    cairo_t *broken = picture_begin(&s, 10, 6, 40, 7);
    cairo_restore(
        broken); // nothing was saved: an error that stays, as that of memory does
    picture_end(&s, broken);
    assert_int_equal(pictures_regions(&s, 1000, 1000, regions), 1);
    assert_int_equal(regions[0].picture, 0);
    assert_int_equal(s.cells[9 * s.width + 19].glyph, 'n');
    assert_int_equal(s.cells[9 * s.width + 40].glyph, 's');

    // a surface with an error is not taken again
    cairo_surface_finish(layer.items[0].surface);
    cairo_surface_flush(layer.items[0].surface);
    pictures_clear(&s);
    picture_end(&s, picture_begin(&s, 0, 0, 50, 5));
}

TEST(test_a_screen_without_pictures_has_dots)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_shows(&ex, ":seek 0.35<Enter>", "1.294 N", "tip, 100 mm");
    assert_shows_at(&ex, 80, 24, "!tip, 100 mm");
    press_shows(&ex, ":bending 5<Enter>", "bent 5 times");
}

// --- answers ---------------------------------------------------------------------------

// Has a terminal's answers, each behind its escape, taken as they come from the input.
static pixel_protocol answered(const char *const *answers, int count, bool careful,
                               pixel_answers *a)
{
    pixel_answers_begin(a, careful);
    for (int i = 0; i < count; i++) {
        escape_sequence e = {.state = SEQUENCE_ESCAPED, .awaits_answers = true};
        pointer_event ignored;
        sequence_result result = SEQUENCE_CONTINUES;
        for (const char *c = answers[i]; *c != '\0' && result == SEQUENCE_CONTINUES;
             c++) {
            result = escape_sequence_take(&e, (unsigned char)*c, &ignored);
        }
        if (result == SEQUENCE_ANSWER) {
            const char *next = pixel_answers_take(a, &e);
            assert_true(!careful || strstr(next, "\033_G") == NULL);
        }
    }
    return pixel_answers_protocol(a);
}

#define ANSWERED(a, careful, ...)                                                        \
    answered((const char *const[]){__VA_ARGS__},                                         \
             (int)(sizeof(const char *const[]){__VA_ARGS__} / sizeof(char *)), careful,  \
             &(a))

TEST(test_pictures_are_drawn_only_where_a_terminal_says_so)
{
    pixel_answers a;

    // none answers, plain ones, half an answer
    pixel_answers_begin(&a, false);
    assert_int_equal(pixel_answers_protocol(&a), PIXELS_NONE);
    assert_int_equal(ANSWERED(a, false, "[?1;2c", "[?1;2c"), PIXELS_NONE);
    assert_int_equal(ANSWERED(a, false, "[?62;4c"), PIXELS_NONE);
    assert_int_equal(ANSWERED(a, false, "[?64;14;22c", "[?64;14;22c"), PIXELS_NONE);
    assert_int_equal(ANSWERED(a, false, "[?4c", "[?4c"), PIXELS_NONE);
    assert_int_equal(ANSWERED(a, false, "[?62c", "_Gi=31;ENOTSUPPORTED\033\\", "[?62c"),
                     PIXELS_NONE);
    assert_int_equal(ANSWERED(a, false, "[?62c", "_Gi=30;OK\033\\", "[?62c"),
                     PIXELS_NONE);

    // those that can
    assert_int_equal(ANSWERED(a, false, "P>|XTerm(379)\033\\", "[?63;1;2;4;22c",
                              "[6;15;8t", "[?1;0;16S", "[?2;0;1000;800S",
                              "]11;rgb:ffff/fafa/0000\a", "[?63;1;2;4;22c"),
                     PIXELS_SIXEL);
    assert_int_equal(a.cell_width, 8);
    assert_int_equal(a.cell_height, 15);
    assert_int_equal(a.registers, 16);
    assert_int_equal(a.most_width, 1000);
    assert_int_equal(a.most_height, 800);
    assert_true(a.has_ground && a.ground.red == 255 && a.ground.green == 0xfa &&
                a.ground.blue == 0);
    assert_int_equal(ANSWERED(a, false, "[?62c", "_Gi=31;OK\033\\",
                              "]11;rgb:10/20/30\033\\", "[?62c"),
                     PIXELS_KITTY);
    assert_true(a.has_ground && a.ground.red == 0x10 && a.ground.blue == 0x30);

    // within tmux no query is sent that it takes for a title
    assert_int_equal(ANSWERED(a, true, "[?62;4c", "[?62;4c"), PIXELS_SIXEL);
    ANSWERED(a, false, "P>|tmux 3.3a\033\\", "[?1;2c");
    assert_true(a.multiplexer);

    // nonsense is no size
    ANSWERED(a, false, "[?62;4c", "[6;0;99999t", "[?1;0;1S", "[?2;3;0;0S", "[?62;4c");
    assert_int_equal(a.cell_width, 0);
    assert_int_equal(a.registers, 0);
}

TEST(test_answers_are_no_keys)
{
    pointer_event ignored;
    escape_sequence e = {.state = SEQUENCE_ESCAPED};

    // where none is awaited ESC P is two keys
    assert_int_equal(escape_sequence_take(&e, 'P', &ignored), SEQUENCE_OTHER_KEY);
    e = (escape_sequence){.state = SEQUENCE_ESCAPED, .awaits_answers = true};
    const char text[] =
        "P>|a name that is a good deal longer than all that there is room "
        "for in a sequence, and yet no key\033\\";
    for (size_t i = 0; i + 2 < sizeof text; i++) {
        assert_int_equal(escape_sequence_take(&e, text[i], &ignored), SEQUENCE_CONTINUES);
    }
    assert_int_equal(escape_sequence_take(&e, '\\', &ignored), SEQUENCE_ANSWER);
    assert_int_equal(e.introducer, 'P');

    // one that is broken off loses no key
    e = (escape_sequence){.state = SEQUENCE_ESCAPED, .awaits_answers = true};
    assert_int_equal(escape_sequence_take(&e, '_', &ignored), SEQUENCE_CONTINUES);
    assert_int_equal(escape_sequence_take(&e, 27, &ignored), SEQUENCE_CONTINUES);
    assert_int_equal(escape_sequence_take(&e, 'q', &ignored), SEQUENCE_OTHER_KEY);
}
