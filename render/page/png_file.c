#include "render/page/png_file.h"

#include <assert.h>
#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdlib.h>
#include <stdbool.h>
#include <string.h>

enum { NOTES_MOST = 8, COMPRESSION = 3 };

static void fail(png_structp png, png_const_charp message)
{
    fault *f = png_get_error_ptr(png);
    fault_set(f, STATUS_CANNOT_WRITE, "a PNG could not be made: %s", message);
    longjmp(png_jmpbuf(png), 1);
}

static void warn(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

// The stream keeps its errors, which are found when it is closed.
static void write_bytes(png_structp png, png_bytep bytes, png_size_t length)
{
    fwrite(bytes, 1, length, png_get_io_ptr(png));
}

static void flush_nothing(png_structp png)
{
    (void)png;
}

static void set_notes(png_structp png, png_infop info, const png_note *notes, int count)
{
    png_text texts[NOTES_MOST];
    int used = 0;
    memset(texts, 0, sizeof texts);

    for (int i = 0; i < count && used < NOTES_MOST; i++) {
        if (notes[i].text != NULL) {
            texts[used].compression = PNG_ITXT_COMPRESSION_NONE;
            texts[used].key = (char *)notes[i].keyword;
            texts[used].text = (char *)notes[i].text;
            texts[used].itxt_length = strlen(notes[i].text);
            texts[used].lang = (char *)"";
            texts[used].lang_key = (char *)notes[i].keyword;
            used++;
        }
    }
    png_set_text(png, info, texts, used);
}

// cairo's native-endian 0xAARRGGBB as bytes R, G, B and A where there is one; cairo's colours are
// multiplied by A, those of a PNG are not.
static void convert_row(const unsigned char *from, unsigned char *to, int width, bool alpha)
{
    for (int i = 0; i < width; i++) {
        uint32_t pixel;
        memcpy(&pixel, from + 4 * i, sizeof pixel);
        uint32_t a = alpha ? pixel >> 24 : 255;

        // rounded; where nothing shows there is nothing to divide by
        for (int k = 0; k < 3; k++) {
            uint32_t part = pixel >> (16 - 8 * k) & 255;
            *to++ = (unsigned char)(a == 0 || a == 255 ? part : (part * 255 + a / 2) / a);
        }
        if (alpha) {
            *to++ = (unsigned char)a;
        }
    }
}

static bool has_alpha(cairo_surface_t *surface)
{
    return cairo_image_surface_get_format(surface) == CAIRO_FORMAT_ARGB32;
}

static void write_rows(png_structp png, cairo_surface_t *surface, unsigned char *row)
{
    const unsigned char *data = cairo_image_surface_get_data(surface);
    int width = cairo_image_surface_get_width(surface);
    int height = cairo_image_surface_get_height(surface);
    int stride = cairo_image_surface_get_stride(surface);
    bool alpha = has_alpha(surface);
    for (int y = 0; y < height; y++) {
        convert_row(data + (ptrdiff_t)y * stride, row, width, alpha);
        png_write_row(png, row);
    }
}

status png_file_write(FILE *stream, cairo_surface_t *surface, double dpi, const png_note *notes,
                      int note_count, fault *f)
{
    assert(stream != NULL && surface != NULL && dpi > 0);
    fault own = {STATUS_OK, ""};

    // libpng reports through `own` and a long jump
    cairo_surface_flush(surface);
    size_t width = (size_t)cairo_image_surface_get_width(surface);
    unsigned char *row = malloc(4 * width + 1);
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &own, fail, warn);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    if (row == NULL || info == NULL) {
        free(row);
        png_destroy_write_struct(&png, &info);
        return fault_set(f, STATUS_NO_MEMORY, "no memory for a PNG");
    }

    // one row at a time
    if (setjmp(png_jmpbuf(png)) == 0) {
        png_uint_32 per_metre = (png_uint_32)lround(dpi / 0.0254);
        png_set_write_fn(png, stream, write_bytes, flush_nothing);
        png_set_IHDR(png, info, (png_uint_32)width,
                     (png_uint_32)cairo_image_surface_get_height(surface), 8,
                     has_alpha(surface) ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB,
                     PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        png_set_pHYs(png, info, per_metre, per_metre, PNG_RESOLUTION_METER);
        // flat colours and thin lines: filters would cost twice the time and make larger files
        png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
        png_set_compression_level(png, COMPRESSION);
        set_notes(png, info, notes, note_count);
        png_write_info(png, info);
        write_rows(png, surface, row);
        png_write_end(png, info);
    }

    png_destroy_write_struct(&png, &info);
    free(row);
    return own.code == STATUS_OK ? STATUS_OK : fault_set(f, own.code, "%s", own.text);
}
