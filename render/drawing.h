// The half of the program that draws: cairo, Pango and all that is built on them. It is a
// module of the program, loaded where a picture is asked for, since its libraries take
// longer to load than most runs. Nothing else of render that needs it is called from
// outside; programs that are linked with it (tests) have it from the start.
#pragma once

#include "render/figures/artwork.h"
#include "render/figures/figures.h"
#include "render/page/pixel_image.h"
#include "render/page/text.h"
#include "render/plot/pane_curve.h"
#include "render/plot/study_plot.h"
#include "render/plot/trace_plot.h"
#include "render/scene/film.h"
#include "render/scene/plan.h"

// What others call of it, by the headers of each.
#define DRAWING_FUNCTIONS(ROW)                                                           \
    ROW(artwork_of_owned)                                                                \
    ROW(artwork_publish)                                                                 \
    ROW(bode_figure_create)                                                              \
    ROW(cairo_surface_destroy)                                                           \
    ROW(figure_draw)                                                                     \
    ROW(figure_publish)                                                                  \
    ROW(film_file_check)                                                                 \
    ROW(film_write)                                                                      \
    ROW(identify_figure_create)                                                          \
    ROW(nyquist_figure_create)                                                           \
    ROW(owned_figure_destroy)                                                            \
    ROW(pane_curve_paint)                                                                \
    ROW(pane_instant_paint)                                                              \
    ROW(pane_level_paint)                                                                \
    ROW(pixel_image_begin)                                                               \
    ROW(pixel_image_end)                                                                 \
    ROW(pixel_image_fit)                                                                 \
    ROW(pixel_image_rows)                                                                \
    ROW(plan_paint)                                                                      \
    ROW(recipe_command)                                                                  \
    ROW(recipe_is)                                                                       \
    ROW(recipe_open)                                                                     \
    ROW(recipe_open_text)                                                                \
    ROW(report_write)                                                                    \
    ROW(robust_figure_create)                                                            \
    ROW(run_figure_create)                                                               \
    ROW(scene_check_path)                                                                \
    ROW(scene_renderer_find)                                                             \
    ROW(scene_write)                                                                     \
    ROW(sweep_figure_create)                                                             \
    ROW(sweep_plot_check)                                                                \
    ROW(text_check_family)                                                               \
    ROW(thesis_figure_at)                                                                \
    ROW(thesis_figure_count)                                                             \
    ROW(thesis_figure_find)                                                              \
    ROW(trace_caption)                                                                   \
    ROW(trace_shared)                                                                    \
    ROW(tune_figure_create)

typedef struct drawing_functions {
    const char *version; // of the program that it belongs to
#define DRAWING_FIELD(name) __typeof__(name) *name;
    DRAWING_FUNCTIONS(DRAWING_FIELD)
#undef DRAWING_FIELD
} drawing_functions;

// The table, the one symbol that the module is asked for.
extern const drawing_functions drawing_table;

// Loads the module unless it is there; on the main thread, before drawing() is called.
// STATUS_CANNOT_WRITE, with what is missing, if it cannot be loaded.
status drawing_open(fault *f);

// Its functions.
const drawing_functions *drawing(void);
