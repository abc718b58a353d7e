// Internal to scenes: floor, labels, triangles and their samples, and the scene itself.
#pragma once

#include <cairo.h>
#include <pango/pangocairo.h>
#include <stdint.h>

#include "render/page/text.h"
#include "render/scene/geometry.h"
#include "render/scene/scene.h"
#include "src/base/fault.h"

// --- the floor: a pale plane with a grid that fades into the page, and soft shadows on
// it

typedef struct scene_floor {
    vector middle;       // point about which the floor fades out
    double reach;        // distance from there at which it has faded completely [m]
    unsigned *ground;    // the floor without shadows, 0xFFRRGGBB
    float *x, *y;        // position of every pixel on the floor [m]
    unsigned char *mask; // shadow on a map of the floor, and room for smoothing
    unsigned char *spare;
    double map_left, map_low, map_cell; // corner of the map and size of its cells [m]
} scene_floor;

// Prepares the floor of a scene that has its camera and light.
void scene_floor_init(scene *sc, vector middle, double reach);
void scene_floor_finish(scene_floor *floor);

// Paints the floor with the shadow of the scene's mesh over the whole image surface
// (RGB24, of the picture's size). STATUS_NO_MEMORY if cairo has none.
status scene_floor_paint(scene *sc, cairo_surface_t *onto, fault *f);

// --- labels, in letters of a scene: labels.c

// The scale of a scene's letters and lines: 1 for a picture 720 pixels high.
double labels_scale(const scene *sc);

// Whether letters are so large in the picture that texts and arm need places apart, as on
// a page of one column.
bool labels_are_large(const scene *sc);

// A flash at a point, with a radius [m] and a strength of 0 to 1.
void labels_flash(const scene *sc, cairo_t *cr, vector place, double radius,
                  double strength);

// "1.34 N" near the head of an arrow that starts at `from`, clear of what the picture has
// taken.
void labels_force(scene *sc, cairo_t *cr, vector from, vector end, double force);

// Title and facts, in lines of at most `width` [pixels], at the lower left corner;
// `facts` is markup, `title` plain.
void labels_caption(scene *sc, cairo_t *cr, const char *title, const char *facts,
                    double width);

// The length in pixels of a length [m] at a point.
double labels_pixels(const camera *c, vector place, double length);

// "contact, 2.5 times" in the lower left corner of an inset [pixels].
void labels_inset(scene *sc, cairo_t *cr, double left, double bottom, double larger);

// A legend of instants [s] with their colours at the lower right corner.
void labels_instants(scene *sc, cairo_t *cr, const double *times, const colour *inks,
                     int count);

// --- what a picture has taken, as cells that no label may cover: taken.c

typedef struct taken_cells {
    int across, down;      // cells
    unsigned char *filled; // one a cell
} taken_cells;

// None taken; before the first use of `t`, which is zero, or after any.
void taken_begin(taken_cells *t, const camera *c);
void taken_finish(taken_cells *t);

// Takes the cells of a mesh as it is seen, and those of a box [pixels].
void taken_add_mesh(taken_cells *t, const mesh *m, const camera *c);
void taken_add_box(taken_cells *t, figure_rect at);

// The place of a box of this size beyond the point of an arrow, or round it where cells
// are taken there: inside the picture, with the fewest taken. `along` is the arrow's
// direction on the picture, a unit vector.
figure_rect taken_clear_box(const taken_cells *t, vector point, vector along,
                            text_size size, const camera *c);

// --- lit triangles, painted by OpenGL without a screen, or with a depth buffer of our
// own

typedef struct scene_painter scene_painter;

// A painter of pictures of width by height pixels, each made of samples x samples.
// RENDER_AUTO takes the first of OSMesa, EGL and cairo that is available.
// STATUS_CANNOT_WRITE if a named one is not.
status scene_painter_create(scene_painter **out, scene_renderer which, int width,
                            int height, int samples, fault *f);
void scene_painter_destroy(scene_painter *p);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(scene_painter, scene_painter_destroy)

// The mesh to be painted, with camera and light.
typedef struct painting {
    const mesh *mesh;
    const camera *camera;
    vector light;   // unit vector towards the lamp
    double opacity; // of the whole mesh, 0 to 1
} painting;

// Paints the mesh over the contents of the image surface (RGB24 or ARGB32, of the
// painter's size). STATUS_CANNOT_WRITE if OpenGL fails.
status scene_painter_paint(scene_painter *p, const painting *what, cairo_surface_t *onto,
                           fault *f);

// --- triangles as samples of a picture, filled by OpenGL or without it

typedef struct gl_offscreen gl_offscreen;

// A vertex of a triangle for OpenGL.
typedef struct gl_vertex {
    float place[4];  // clip coordinates, y down
    float colour[4]; // red, green, blue, opacity
} gl_vertex;

enum { RENDERER_NAME = 300 };

// A renderer of pictures of width by height pixels, up to `rows` rows at once,
// RENDER_OSMESA or RENDER_EGL, and its name: "OSMesa, llvmpipe (LLVM 15.0.6, 256 bits),
// ...". STATUS_CANNOT_WRITE if the library is missing or has no OpenGL 3, with what to
// install in f.
status gl_offscreen_create(gl_offscreen **out, scene_renderer library, int width,
                           int height, int rows, char name[RENDERER_NAME], fault *f);
void gl_offscreen_destroy(gl_offscreen *g);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(gl_offscreen, gl_offscreen_destroy)

// Triangles, three corners each, as numbers of vertices.
typedef struct gl_triangles {
    const gl_vertex *vertices;
    size_t vertex_count;
    const unsigned *corners;
    size_t corner_count;
} gl_triangles;

// Draws triangles on a transparent background with a depth test and stores the region, no
// higher than the rows drawn at once, as rows of 0xAARRGGBB with premultiplied opacity.
status gl_offscreen_draw(gl_offscreen *g, const gl_triangles *t, pixel_box region,
                         uint32_t *pixels, fault *f);

enum {
    SAMPLE_TILE = 16,             // edge of a tile [pixels]
    SAMPLE_BAND = 4 * SAMPLE_TILE // height of the bands that OpenGL draws one by one
};

// The samples of a picture of width by height pixels. Tiles that nothing touched are
// skipped.
typedef struct sample_buffer {
    int width, height; // of the picture [pixels]
    int samples;       // of a pixel along each edge
    // 0xAARRGGBB; of a band, or if triangles are filled without OpenGL of all, 0 and
    // empty depths between pictures
    uint32_t *pixels;
    float *depths; // NULL: OpenGL fills the pixels
    unsigned char *touched;
    int tiles_across, tiles_down;
} sample_buffer;

// Empty samples, with depths if triangles are filled without OpenGL.
void samples_init(sample_buffer *b, int width, int height, int samples, bool depths);
void samples_finish(sample_buffer *b);

// Adds a new set of triangles, of closed solids: records the tiles that they touch and,
// if there are depths, fills them. Back faces are omitted.
void samples_take(sample_buffer *b, const gl_triangles *t);

// Paints the means of the samples over the image surface (RGB24 or ARGB32, of the
// picture's size) with the given opacity (0 to 1). `region` is the part of the picture in
// `pixels`, with contiguous rows. Samples filled without OpenGL are empty afterwards.
void samples_lay_over(sample_buffer *b, pixel_box region, double opacity,
                      cairo_surface_t *onto);

// What paints them.
struct scene_painter {
    gl_offscreen *gl; // NULL: samples are filled by hand
    sample_buffer samples;
    char name[RENDERER_NAME]; // of the renderer, for the picture's metadata
    gl_vertex *vertices;
    size_t vertex_capacity;
};

// --- the scene

enum { TRAIL_POINTS = 240 };

// Sizes in beam lengths, used by the solids and the view.
#define BEAM_HEIGHT    0.050
#define BEAM_THICKNESS 0.011
#define MOTOR_RADIUS   0.082
#define FLOOR_LEVEL    (-0.150)
#define PIN_TOP        0.062
#define SLAB_FROM      0.965 // of the flat wall, along the arm
#define SLAB_TO        1.10
#define SLAB_THICKNESS 0.030
#define ARROW_LENGTH   0.26 // of the largest force
#define ARROW_NEAR_BY  0.06 // of it in a view of the tip

// Colours of the arm's surroundings.
typedef struct surroundings {
    colour page, ground, line; // of the page, the floor and the grid
    colour far;                // colour of the distant past
    colour strong, faint;      // of letters
} surroundings;

struct scene {
    const scenario *scenario;
    const run_result *result;
    scene_options options;
    int links;
    double length; // of the beam [m]
    double grid;   // [m]
    camera camera;
    vector light;
    scene_floor floor;
    scene_painter *painter;
    PangoContext *context;
    taken_cells taken;
    const surroundings *around;
    struct scene *tip; // the inset's own scene, or NULL
    mesh mesh, ghost;
    vector *joints, *curve;
    vector trail[TRAIL_POINTS];
    material trail_of[TRAIL_POINTS];
};

// A material blended with the colour of the distant past, by a share of 0 to 1.
material scene_paler(const scene *sc, material m, double share);

// The steel of the scene's beam.
material scene_steel(const scene *sc);

// Sets sc->joints to the joints at an instant [s], with the bending as drawn. Returns the
// row of that instant.
sample scene_shape(scene *sc, double time);

// The point of action of the force in the row of sc->joints: the contact point, on the
// near side of the beam.
vector scene_contact(const scene *sc, const sample *row);

// The wall's force on the beam, as an arrow from the contact point away from the wall,
// for sc->joints of that row. False if it is not visible.
bool scene_force_arrow(const scene *sc, const sample *row, vector *start, vector *end);

// The point at distance x along a direction [rad] in the plane, y across it, and z above.
vector scene_at_angle(double angle, double x, double y, double z);

// The length of the largest force's arrow [m].
double scene_longest_arrow(const scene *sc);

// Adds to sc->mesh the motor with the hub at an angle [rad], the wall where a row has it,
// and the tip's path from one instant [s] to another, paler for earlier times.
void scene_build_hub(scene *sc, double angle);
void scene_build_wall(scene *sc, const sample *row);
void scene_build_trail(scene *sc, double from, double time);

// Adds the arm at an instant [s] and the wall's force on it to a mesh of the scene.
void scene_build_arm(scene *sc, mesh *into, double time);

// Places camera, light and floor so that the whole run is visible.
void scene_set_view(scene *sc);
