// Paints a mesh: lights its vertices, projects them, and has their triangles filled by
// OpenGL or by hand.
#include "render/scene/scene_parts.h"

#include <assert.h>
#include <math.h>
#include <string.h>

bool scene_renderer_find(const char *name, scene_renderer *which)
{
    static const char *const names[] = {"auto", "osmesa", "egl", "cairo"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (strcmp(names[i], name) == 0) {
            *which = (scene_renderer)i;
            return true;
        }
    }
    return false;
}

// OpenGL where it is asked for or there, else samples filled by hand.
status scene_painter_create(scene_painter **out, scene_renderer which, int width,
                            int height, int samples, fault *f)
{
    assert(width > 0 && height > 0 && samples > 0);
    g_autoptr(scene_painter) p = g_new0(scene_painter, 1);
    status code = STATUS_OK;
    *out = NULL;
    snprintf(p->name, sizeof p->name, "cairo %s, own depth buffer",
             cairo_version_string());

    // the renderer asked for, or the first that is there; OSMesa needs no driver
    for (scene_renderer r = RENDER_OSMESA; r <= RENDER_EGL && p->gl == NULL; r++) {
        if (which == r || which == RENDER_AUTO) {
            code = gl_offscreen_create(&p->gl, r, samples * width, samples * height,
                                       samples * MIN(height, SAMPLE_BAND), p->name, f);
        }
    }

    // without OpenGL, drawing by hand is always possible; a renderer asked for must be
    // there
    if (which != RENDER_AUTO) {
        TRY(code);
    }
    samples_init(&p->samples, width, height, samples, p->gl == NULL);
    *out = g_steal_pointer(&p);
    return STATUS_OK;
}

void scene_painter_destroy(scene_painter *p)
{
    if (p != NULL) {
        gl_offscreen_destroy(p->gl);
        samples_finish(&p->samples);
        g_free(p->vertices);
        g_free(p);
    }
}

// ---- light

#define AMBIENT_SKY    0.50 // light from above, everywhere
#define AMBIENT_GROUND 0.26 // light that the floor throws back
#define LAMP           0.62
#define FILL           0.14 // light from the side opposite to the lamp
#define HIGHLIGHT      0.55
#define HIGHLIGHT_EDGE 36.0 // how narrow highlights are

static double to_linear(double shade)
{
    return pow(shade, 2.2);
}

static float to_screen(double light)
{
    return (float)pow(fmin(1, fmax(0, light)), 1 / 2.2);
}

// The colour in which the camera sees a vertex: light from the sky, a lamp and a weaker
// one across, and the lamp's highlight (Blinn 1977).
static void light_vertex(const mesh_vertex *v, const camera *c, vector light,
                         float rgba[4])
{
    vector view = vector_unit(vector_sum(c->eye, -1, v->place));

    // lamp, weaker lamp and sky, each by the angle at which it falls in
    double lamp = fmax(0, vector_dot(v->normal, light));
    vector across = vector_unit((vector){-light.x, -light.y, 0.4});
    double fill = fmax(0, vector_dot(v->normal, across));
    double sky = 0.5 + 0.5 * v->normal.z;
    double sum =
        AMBIENT_GROUND + (AMBIENT_SKY - AMBIENT_GROUND) * sky + LAMP * lamp + FILL * fill;

    // brightest where the normal halves the angle between lamp and eye
    double highlight =
        fmax(0, vector_dot(v->normal, vector_unit(vector_add(light, view))));
    double shine = HIGHLIGHT * v->material.shine * pow(highlight, HIGHLIGHT_EDGE);

    // lights add up in linear colours only
    rgba[0] = to_screen(to_linear(v->material.colour.red) * sum + shine);
    rgba[1] = to_screen(to_linear(v->material.colour.green) * sum + shine);
    rgba[2] = to_screen(to_linear(v->material.colour.blue) * sum + shine);
    rgba[3] = 1;
}

// ---- pictures

// Lights the vertices and finds their places: clip coordinates whose w is the depth.
// Returns the pixels that they cover.
static pixel_box light_and_project(scene_painter *p, const mesh *m, const camera *c,
                                   vector light)
{
    double left = p->samples.width, right = 0, top = p->samples.height, bottom = 0;
    double span = c->farthest - c->nearest;

    // vertices in OpenGL's clip coordinates, lit
    for (size_t i = 0; i < m->vertex_count; i++) {
        vector at = camera_project(c, m->vertices[i].place);
        gl_vertex *v = &p->vertices[i];
        // y stays down: the rows that are read back are then the picture's, from its top
        v->place[0] = (float)((2 * at.x / c->width - 1) * at.z);
        v->place[1] = (float)((2 * at.y / c->height - 1) * at.z);
        v->place[2] =
            (float)(((c->farthest + c->nearest) * at.z - 2 * c->farthest * c->nearest) /
                    span);
        v->place[3] = (float)at.z;
        light_vertex(&m->vertices[i], c, light, v->colour);

        // the box round all of them
        left = fmin(left, at.x);
        right = fmax(right, at.x);
        top = fmin(top, at.y);
        bottom = fmax(bottom, at.y);
    }

    // whole pixels within the picture
    int x = (int)fmax(0, floor(left)), y = (int)fmax(0, floor(top));
    int x_end = (int)fmin(p->samples.width, ceil(right));
    int y_end = (int)fmin(p->samples.height, ceil(bottom));
    return (pixel_box){x, y, x_end - x, y_end - y};
}

status scene_painter_paint(scene_painter *p, const painting *what, cairo_surface_t *onto,
                           fault *f)
{
    assert(what->opacity >= 0 && what->opacity <= 1);
    const mesh *m = what->mesh;
    if (m->vertex_count > p->vertex_capacity) {
        p->vertices = g_renew(gl_vertex, p->vertices, m->vertex_count);
        p->vertex_capacity = m->vertex_count;
    }

    // only the part of the picture that holds something
    pixel_box r = light_and_project(p, m, what->camera, what->light);
    if (r.width <= 0 || r.height <= 0) {
        return STATUS_OK;
    }

    // samples filled by hand
    const gl_triangles all = {p->vertices, m->vertex_count, m->corners, m->corner_count};
    samples_take(&p->samples, &all);
    if (p->gl == NULL) {
        const pixel_box whole = {0, 0, p->samples.width, p->samples.height};
        samples_lay_over(&p->samples, whole, what->opacity, onto);
        return STATUS_OK;
    }

    // or by OpenGL, in bands of the picture
    const int n = p->samples.samples;
    for (int top = r.y; top < r.y + r.height; top += SAMPLE_BAND) {
        const pixel_box band = {r.x, top, r.width,
                                MIN(SAMPLE_BAND, r.y + r.height - top)};
        const pixel_box sampled = {n * band.x, n * band.y, n * band.width,
                                   n * band.height};
        TRY(gl_offscreen_draw(p->gl, &all, sampled, p->samples.pixels, f));
        samples_lay_over(&p->samples, band, what->opacity, onto);
    }
    return STATUS_OK;
}
