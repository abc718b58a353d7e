#include "render/page/pixel_image.h"

bool pixel_image_fit(cairo_surface_t **image, int width, int height)
{
    const bool fits = *image != NULL &&
                      cairo_surface_status(*image) == CAIRO_STATUS_SUCCESS &&
                      cairo_image_surface_get_width(*image) == width &&
                      cairo_image_surface_get_height(*image) == height;
    if (!fits) {
        cairo_surface_destroy(*image);
        *image = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
    }
    return cairo_surface_status(*image) == CAIRO_STATUS_SUCCESS;
}

cairo_t *pixel_image_begin(cairo_surface_t *image, colour ground)
{
    cairo_t *cr = cairo_create(image);
    set_colour(cr, ground);
    cairo_paint(cr);
    return cr;
}

bool pixel_image_end(cairo_t *cr)
{
    const bool drawn = cairo_status(cr) == CAIRO_STATUS_SUCCESS;
    cairo_destroy(cr);
    return drawn;
}

const uint32_t *pixel_image_rows(cairo_surface_t *image, int *stride)
{
    cairo_surface_flush(image);
    *stride = cairo_image_surface_get_stride(image) / 4;
    const void *pixels = cairo_image_surface_get_data(image);
    return pixels;
}
