#include "ui/terminal/pictures.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

void pictures_finish(picture_layer *layer)
{
    for (int i = 0; i < PICTURES; i++) {
        cairo_surface_destroy(layer->items[i].surface);
    }
    *layer = (picture_layer){0};
}

void pictures_clear(screen *s)
{
    if (s->pictures != NULL) {
        s->pictures->count = 0;
    }
}

// Makes sure that a picture has a surface of its size without an error; false without
// memory.
static bool fit_surface(screen_picture *p, int width, int height)
{
    const bool fits = p->surface != NULL &&
                      cairo_surface_status(p->surface) == CAIRO_STATUS_SUCCESS &&
                      cairo_image_surface_get_width(p->surface) == width &&
                      cairo_image_surface_get_height(p->surface) == height;
    if (!fits) {
        cairo_surface_destroy(p->surface);
        p->surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
    }
    return cairo_surface_status(p->surface) == CAIRO_STATUS_SUCCESS;
}

cairo_t *picture_begin(screen *s, int x, int y, int width, int height)
{
    picture_layer *layer = s->pictures;

    // kept within the screen
    if (x + width > s->width) {
        width = s->width - x;
    }
    if (y + height > s->height) {
        height = s->height - y;
    }
    if (layer == NULL || layer->count == PICTURES || x < 0 || y < 0 || width < 1 ||
        height < 1) {
        return NULL;
    }
    screen_picture *p = &layer->items[layer->count];
    if (!fit_surface(p, width * layer->cell_width, height * layer->cell_height)) {
        return NULL;
    }

    // its cells
    p->x = x;
    p->y = y;
    p->width = width;
    p->height = height;
    for (int row = y; row < y + height; row++) {
        for (int column = x; column < x + width; column++) {
            screen_put(s, column, row, GLYPH_PICTURE + (uint32_t)layer->count, INK_TEXT);
        }
    }
    layer->count++;

    // its ground
    cairo_t *cr = cairo_create(p->surface);
    cairo_set_source_rgb(cr, layer->ground.red / 255.0, layer->ground.green / 255.0,
                         layer->ground.blue / 255.0);
    cairo_paint(cr);
    return cr;
}

// Blanks in the place of a picture, with words in the middle.
static void put_words(screen *s, int picture, const char *words)
{
    const screen_picture *p = &s->pictures->items[picture];
    const uint32_t glyph = GLYPH_PICTURE + (uint32_t)picture;
    const int length = (int)strlen(words);
    const int x = length < p->width ? p->x + (p->width - length) / 2 : p->x;
    for (int row = p->y; row < p->y + p->height; row++) {
        for (int column = p->x; column < p->x + p->width; column++) {
            if (s->cells[(long)row * s->width + column].glyph == glyph) {
                screen_put(s, column, row, ' ', INK_TEXT);
            }
        }
    }
    screen_text(s, x, p->y + p->height / 2, p->width, INK_TEXT, words);
}

void picture_end(screen *s, cairo_t *cr)
{
    picture_layer *layer = s->pictures;
    const bool drawn = cairo_status(cr) == CAIRO_STATUS_SUCCESS;
    cairo_destroy(cr);
    assert(layer->count > 0);
    if (!drawn) {
        put_words(s, layer->count - 1, "no memory to draw this");
    }
}

// The regions of one picture, behind the `count` there are: rows with the same run hang
// together.
static int add_regions(const screen *s, int picture, int most_width, int most_height,
                       picture_region *regions, int count)
{
    const screen_picture *p = &s->pictures->items[picture];
    const uint32_t glyph = GLYPH_PICTURE + (uint32_t)picture;
    const int first = count;
    for (int y = p->y; y < p->y + p->height; y++) {
        const cell *row = s->cells + (long)y * s->width;
        for (int x = p->x, length; x<p->x + p->width; x += length> 0 ? length : 1) {
            for (length = 0; x + length < s->width && length < most_width &&
                             row[x + length].glyph == glyph;) {
                length++;
            }

            // continues the one above, or begins another
            bool goes_on = length == 0;
            for (int k = first; k < count && !goes_on; k++) {
                picture_region *above = &regions[k];
                goes_on = above->x == x && above->width == length &&
                          above->y + above->height == y && above->height < most_height;
                above->height += goes_on;
            }
            if (!goes_on && count < PICTURE_REGIONS) {
                regions[count++] = (picture_region){picture, x, y, length, 1};
            }
        }
    }
    return count;
}

int pictures_regions(const screen *s, int most_width, int most_height,
                     picture_region regions[PICTURE_REGIONS])
{
    assert(most_width > 0 && most_height > 0);
    int count = 0;
    for (int i = 0; s->pictures != NULL && i < s->pictures->count; i++) {
        cairo_surface_flush(s->pictures->items[i].surface);
        count = add_regions(s, i, most_width, most_height, regions, count);
    }
    return count;
}

rgb picture_ink(const screen *s, colour_theme theme, ink i)
{
    const rgb black = {0, 0, 0}, white = {255, 255, 255};
    const rgb ground = s->pictures->ground;
    rgb colour;
    if (ink_rgb(theme, i, &colour)) {
        return colour;
    }
    if (rgb_contrast(white, ground) > rgb_contrast(black, ground)) {
        return white;
    }
    return black;
}
