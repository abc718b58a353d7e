#include "render/page/picture_file.h"

#include <assert.h>
#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "render/page/page.h"
#include "render/page/text.h"
#include "src/base/shipped.h"
#include "src/base/whole_file.h"

enum { COMPRESSION = 3 };

// Ends the writing of a PNG with libpng's message as its fault.
static void fail(png_structp png, png_const_charp message)
{
    fault *f = png_get_error_ptr(png);
    fault_set(f, STATUS_CANNOT_WRITE, "a PNG could not be made: %s", message);
    longjmp(png_jmpbuf(png), 1);
}

// Warnings of libpng are about files that are read.
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

// Adds the notes as texts of a PNG.
static void set_notes(png_structp png, png_infop info, const png_note *notes, int count)
{
    for (int i = 0; i < count; i++) {
        png_text text = {.compression = PNG_ITXT_COMPRESSION_NONE,
                         .key = (char *)notes[i].keyword,
                         .text = (char *)notes[i].text,
                         .lang = (char *)"",
                         .lang_key = (char *)notes[i].keyword};
        if (text.text != NULL) {
            text.itxt_length = strlen(text.text);
            png_set_text(png, info, &text, 1);
        }
    }
}

// cairo's native-endian 0xAARRGGBB as bytes R, G, B and A where there is one; cairo's
// colours are multiplied by A, those of a PNG are not.
static void convert_row(const unsigned char *from, unsigned char *to, int width,
                        bool alpha)
{
    for (int i = 0; i < width; i++) {
        uint32_t pixel;
        memcpy(&pixel, from + 4 * i, sizeof pixel);
        uint32_t a = 255;
        if (alpha) {
            a = pixel >> 24;
        }

        // rounded; where nothing shows there is nothing to divide by
        for (int k = 0; k < 3; k++) {
            uint32_t part = pixel >> (16 - 8 * k) & 255;
            if (a != 0 && a != 255) {
                part = (part * 255 + a / 2) / a;
            }
            *to++ = (unsigned char)part;
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

// Writes the pixels of an image surface row by row.
static void write_pixel_rows(png_structp png, cairo_surface_t *surface,
                             unsigned char *row)
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

// libpng reports errors by a long jump to the place of setjmp, after `fail` has kept
// them.
status png_file_write(FILE *stream, cairo_surface_t *surface, double dpi,
                      const png_note *notes, int note_count, fault *f)
{
    assert(dpi > 0);
    fault own = {STATUS_OK, ""};

    // libpng reports through `own` and a long jump
    cairo_surface_flush(surface);
    const size_t width = (size_t)cairo_image_surface_get_width(surface);
    const png_uint_32 height = (png_uint_32)cairo_image_surface_get_height(surface);
    const int kind = has_alpha(surface) ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB;
    g_autofree unsigned char *row = g_malloc(4 * width + 1);
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &own, fail, warn);
    png_infop info = NULL;
    if (png != NULL) {
        info = png_create_info_struct(png);
    }
    if (info == NULL) {
        g_error("out of memory");
    }

    // what it is, then one row at a time
    if (setjmp(png_jmpbuf(png)) == 0) {
        png_uint_32 per_metre = (png_uint_32)lround(dpi / 0.0254);
        png_set_write_fn(png, stream, write_bytes, NULL);
        png_set_IHDR(png, info, (png_uint_32)width, height, 8, kind, PNG_INTERLACE_NONE,
                     PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        png_set_pHYs(png, info, per_metre, per_metre, PNG_RESOLUTION_METER);

        // flat colours and thin lines: filters would cost twice the time and make larger
        // files
        png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
        png_set_compression_level(png, COMPRESSION);
        set_notes(png, info, notes, note_count);
        png_write_info(png, info);
        write_pixel_rows(png, surface, row);
        png_write_end(png, info);
    }

    png_destroy_write_struct(&png, &info);
    if (own.code != STATUS_OK) {
        return fault_set(f, own.code, "%s", own.text);
    }
    return STATUS_OK;
}

// ==== pictures

#define DEFAULT_DPI 200.0
#define LEAST_DPI   10.0
#define MOST_DPI    2400.0
#define MOST_PIXELS 20000.0 // along one edge

const char *picture_software(void)
{
    // made by whichever thread comes first
    static gsize software;
    if (g_once_init_enter(&software)) {
        g_autofree char *named = text_printf("impactlab %s", lab_version());
        g_once_init_leave(&software, (gsize)g_intern_string(named));
    }
    return (const char *)software;
}

static cairo_status_t to_stream(void *stream, const unsigned char *bytes, unsigned length)
{
    if (fwrite(bytes, 1, length, stream) == length) {
        return CAIRO_STATUS_SUCCESS;
    }
    return CAIRO_STATUS_WRITE_ERROR;
}

void picture_line(cairo_t *cr, double x0, double y0, double x1, double y1)
{
    cairo_move_to(cr, x0, y0);
    cairo_line_to(cr, x1, y1);
    cairo_stroke(cr);
}

// The status of a drawing, `code`, or that of an error which cairo met on the way.
static status check_drawing(status code, cairo_status_t state, fault *f)
{
    const bool failed = state != CAIRO_STATUS_SUCCESS &&
                        state != CAIRO_STATUS_WRITE_ERROR &&
                        state != CAIRO_STATUS_SURFACE_FINISHED;
    FAULT_IF(code == STATUS_OK && failed, f, STATUS_NO_MEMORY,
             "a picture could not be drawn: %s", cairo_status_to_string(state));
    return code;
}

status picture_end_drawing(cairo_t *cr, status code, fault *f)
{
    code = check_drawing(code, cairo_status(cr), f);
    cairo_destroy(cr);
    return code;
}

// Draws on a surface and finishes it.
static status paint_surface(cairo_surface_t *surface, const picture *p, bool finish,
                            fault *f)
{
    cairo_t *cr = cairo_create(surface);
    const status painted = p->paint(cr, p->what, f);
    const status ended = picture_end_drawing(cr, painted, f);
    if (finish) {
        cairo_surface_finish(surface);
    }
    return check_drawing(ended, cairo_surface_status(surface), f);
}

// Draws on an image of as many pixels as the resolution asks for, and writes that.
status picture_write_png(const picture *p, FILE *stream, fault *f)
{
    double dpi = DEFAULT_DPI;
    if (p->dpi != 0) {
        dpi = p->dpi;
    }
    FAULT_IF(!(dpi >= LEAST_DPI && dpi <= MOST_DPI), f, STATUS_BAD_ARGUMENT,
             "a PNG of %g dpi, expected %g to %g", dpi, LEAST_DPI, MOST_DPI);
    double pixels_across = round(p->width * dpi / 72),
           pixels_down = round(p->height * dpi / 72);
    FAULT_IF(!(pixels_across >= 1 && pixels_across <= MOST_PIXELS && pixels_down >= 1 &&
               pixels_down <= MOST_PIXELS),
             f, STATUS_BAD_ARGUMENT,
             "a PNG of %.0f x %.0f pixels, expected 1 to %g along each edge",
             pixels_across, pixels_down, MOST_PIXELS);

    const cairo_format_t format =
        p->transparent ? CAIRO_FORMAT_ARGB32 : CAIRO_FORMAT_RGB24;
    g_autoptr(cairo_surface_t) surface =
        cairo_image_surface_create(format, (int)pixels_across, (int)pixels_down);
    // the page ends exactly where the pixels do
    cairo_surface_set_device_scale(surface, pixels_across / p->width,
                                   pixels_down / p->height);
    TRY(paint_surface(surface, p, false, f));
    const png_note notes[] = {{"Title", p->title},
                              {"Software", p->software},
                              {"Parameters", p->parameters},
                              {"Command", p->command},
                              {"Description", p->alternative}};
    return png_file_write(stream, surface, dpi, notes, 5, f);
}

static void set_metadata(cairo_surface_t *surface, cairo_pdf_metadata_t what,
                         const char *value)
{
    if (value != NULL) {
        g_autofree char *valid = g_utf8_make_valid(value, -1);
        cairo_pdf_surface_set_metadata(surface, what, valid);
    }
}

// Pictures as the pages of a PDF in a stream, with the metadata of the first.
static status write_pdf_pages(FILE *stream, const picture *p, int count, fault *f)
{
    cairo_surface_t *surface =
        cairo_pdf_surface_create_for_stream(to_stream, stream, p->width, p->height);
    // without a date of ours cairo writes the present one, and no two files are alike
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE,
                                   "2000-01-01T00:00:00Z");

    set_metadata(surface, CAIRO_PDF_METADATA_TITLE, p->title);
    set_metadata(surface, CAIRO_PDF_METADATA_CREATOR, p->software);
    set_metadata(surface, CAIRO_PDF_METADATA_KEYWORDS, p->parameters);
    set_metadata(surface, CAIRO_PDF_METADATA_SUBJECT, p->command);

    status code = STATUS_OK;
    for (int i = 0; i < count && code == STATUS_OK; i++) {
        cairo_pdf_surface_set_size(surface, p[i].width, p[i].height);
        code = paint_surface(surface, &p[i], i == count - 1, f);
        if (i < count - 1) {
            cairo_surface_show_page(surface);
        }
    }
    cairo_surface_destroy(surface);
    return code;
}

static cairo_status_t to_string(void *string, const unsigned char *bytes, unsigned length)
{
    g_string_append_len(string, (const char *)bytes, (gssize)length);
    return CAIRO_STATUS_SUCCESS;
}

static void add_element(GString *out, const char *indent, const char *name,
                        const char *content)
{
    if (content != NULL) {
        g_autofree char *escaped = text_escape(content);
        text_append(out, "%s<%s>%s</%s>\n", indent, name, escaped, name);
    }
}

// Title and metadata as the children of an SVG's root.
static GString *svg_metadata(const picture *p)
{
    GString *out = g_string_new("\n");

    add_element(out, "", "title", p->title);
    add_element(out, "", "desc", p->alternative);
    g_string_append(out,
                    "<metadata>\n"
                    "<rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\" "
                    "xmlns:dc=\"http://purl.org/dc/elements/1.1/\">\n"
                    "<rdf:Description>\n");

    // Dublin Core, which viewers read
    add_element(out, "  ", "dc:title", p->title);
    add_element(out, "  ", "dc:creator", p->software);
    add_element(out, "  ", "dc:description", p->parameters);
    add_element(out, "  ", "dc:source", p->command);
    g_string_append(out, "</rdf:Description>\n</rdf:RDF>\n</metadata>");
    return out;
}

// Lets cairo write an SVG into memory and adds the metadata to its root.
char *picture_svg(const picture *p, fault *f)
{
    char *whole = NULL;
    GString *svg = g_string_new(NULL);
    cairo_surface_t *surface =
        cairo_svg_surface_create_for_stream(to_string, svg, p->width, p->height);

    status code = paint_surface(surface, p, true, f);
    cairo_surface_destroy(surface);

    // metadata come right after the root's opening
    if (code == STATUS_OK) {
        const char *root = strstr(svg->str, "<svg");
        const char *end = strchr(text_or(root, ""), '>');
        if (end != NULL) {
            GString *metadata = svg_metadata(p);
            g_string_insert(svg, end + 1 - svg->str, metadata->str);
            g_string_free(metadata, TRUE);
        }
        whole = svg_own_ids(svg->str);
    }
    g_string_free(svg, TRUE);
    return whole;
}

status picture_write_pages(const picture *pages, int count, const char *path, fault *f)
{
    assert(count > 0);
    whole_file file;
    TRY(whole_file_open(&file, path, f));
    return whole_file_close(&file, write_pdf_pages(file.stream, pages, count, f), f);
}

static status write_svg(const picture *p, FILE *stream, fault *f)
{
    fault why = {0};
    g_autofree char *svg = picture_svg(p, &why);
    FAULT_IF(svg == NULL, f, why.code, "%s", why.text);
    fputs(svg, stream);
    return STATUS_OK;
}

// The extension decides how it is drawn.
status picture_write(const picture *p, const char *path, fault *f)
{
    // only a name that tells its format
    whole_file file;
    TRY(picture_check_path(path, f));
    TRY(whole_file_open(&file, path, f));
    const picture_format format = picture_format_of(path);
    status code;
    if (format == FORMAT_PNG) {
        code = picture_write_png(p, file.stream, f);
    } else if (format == FORMAT_SVG) {
        code = write_svg(p, file.stream, f);
    } else {
        code = write_pdf_pages(file.stream, p, 1, f);
    }
    return whole_file_close(&file, code, f);
}
