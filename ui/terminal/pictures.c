#include "ui/terminal/pictures.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

#include "render/drawing.h"

void pictures_finish(picture_layer *layer)
{
    for (int i = 0; i < PICTURES; i++) {
        if (layer->items[i].surface != NULL) {
            drawing()->cairo_surface_destroy(layer->items[i].surface);
        }
    }
    *layer = (picture_layer){0};
}

void pictures_clear(screen *s)
{
    if (s->pictures != NULL) {
        s->pictures->count = 0;
    }
}

cairo_t *picture_begin(screen *s, int x, int y, int width, int height)
{
    picture_layer *layer = s->pictures;

    // only what is within the screen
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
    if (!drawing()->pixel_image_fit(&p->surface, width * layer->cell_width,
                                    height * layer->cell_height)) {
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

    // its background
    const colour ground = {layer->ground.red / 255.0, layer->ground.green / 255.0,
                           layer->ground.blue / 255.0};
    return drawing()->pixel_image_begin(p->surface, ground);
}

// Words in the middle of where a picture was to be, and blanks around them.
static void put_words(screen *s, int index, const char *words)
{
    const screen_picture *p = &s->pictures->items[index];
    const uint32_t glyph = GLYPH_PICTURE + (uint32_t)index;
    for (int row = p->y; row < p->y + p->height; row++) {
        for (int column = p->x; column < p->x + p->width; column++) {
            if (s->cells[(long)row * s->width + column].glyph == glyph) {
                screen_put(s, column, row, ' ', INK_TEXT);
            }
        }
    }

    int margin = (p->width - (int)strlen(words)) / 2;
    if (margin < 0) {
        margin = 0;
    }
    screen_text(s, p->x + margin, p->y + p->height / 2, p->width, INK_TEXT, words);
}

void picture_end(screen *s, cairo_t *cr)
{
    picture_layer *layer = s->pictures;
    const bool drawn = drawing()->pixel_image_end(cr);
    assert(layer->count > 0);
    if (!drawn) {
        put_words(s, layer->count - 1, "no memory to draw this");
    }
}

// How many cells of a row show a picture, one after the other from x on, up to `most`.
static int run_length(const screen *s, int x, int y, uint32_t glyph, int most)
{
    const cell *row = s->cells + (long)y * s->width;
    int length = 0;
    while (x + length < s->width && length < most && row[x + length].glyph == glyph) {
        length++;
    }
    return length;
}

// The region among the given ones that a run of cells continues downwards, NULL if there
// is none.
static picture_region *region_above(picture_region *regions, int count, int x, int y,
                                    int length, int most_height)
{
    for (int i = 0; i < count; i++) {
        picture_region *r = &regions[i];
        if (r->x == x && r->width == length && r->y + r->height == y &&
            r->height < most_height) {
            return r;
        }
    }
    return NULL;
}

// Adds the regions of one picture behind the `count` that there are; returns how many
// there are then.
static int add_regions(const screen *s, int index, int most_width, int most_height,
                       picture_region *regions, int count)
{
    const screen_picture *p = &s->pictures->items[index];
    const uint32_t glyph = GLYPH_PICTURE + (uint32_t)index;
    const int first = count;
    for (int y = p->y; y < p->y + p->height; y++) {
        int x = p->x;
        while (x < p->x + p->width) {
            const int length = run_length(s, x, y, glyph, most_width);
            if (length == 0) {
                x++;
                continue;
            }

            // continues the region above, or begins another
            picture_region *above =
                region_above(regions + first, count - first, x, y, length, most_height);
            if (above != NULL) {
                above->height++;
            } else if (count < PICTURE_REGIONS) {
                regions[count++] = (picture_region){index, x, y, length, 1};
            }
            x += length;
        }
    }
    return count;
}

int pictures_regions(const screen *s, int most_width, int most_height,
                     picture_region regions[PICTURE_REGIONS])
{
    assert(most_width > 0 && most_height > 0);
    if (s->pictures == NULL) {
        return 0;
    }
    int count = 0;
    for (int i = 0; i < s->pictures->count; i++) {
        count = add_regions(s, i, most_width, most_height, regions, count);
    }
    return count;
}

pixel_block picture_block(const screen *s, const picture_region *r)
{
    const screen_picture *p = &s->pictures->items[r->picture];
    const int cell_width = s->pictures->cell_width;
    const int cell_height = s->pictures->cell_height;
    int stride;
    const uint32_t *pixels = drawing()->pixel_image_rows(p->surface, &stride);

    // from the region's upper left corner on
    const long left = (long)(r->x - p->x) * cell_width;
    const long top = (long)(r->y - p->y) * cell_height;
    return (pixel_block){.pixels = pixels + top * stride + left,
                         .width = r->width * cell_width,
                         .height = r->height * cell_height,
                         .stride = stride};
}

rgb picture_ink(const screen *s, colour_theme theme, ink i)
{
    rgb known;
    if (ink_rgb(theme, i, &known)) {
        return known;
    }

    // the default colour of text: what stands out more
    const rgb black = {0, 0, 0}, white = {255, 255, 255};
    const rgb ground = s->pictures->ground;
    if (rgb_contrast(white, ground) > rgb_contrast(black, ground)) {
        return white;
    }
    return black;
}
