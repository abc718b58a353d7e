// A film is written frame by frame: painted, then given to its file.
#include "render/scene/film.h"

#include <assert.h>
#include <math.h>

#include "render/plot/trace_plot.h"

// What an option of the command cannot refuse by its range.
static status check_film(const film_options *o, const film_run *runs, int run_count,
                         fault *f)
{
    FAULT_IF(
        o->width < 320 || o->width > 4096 || o->height < 240 || o->height > 4096 ||
            o->width % 2 != 0 || o->height % 2 != 0,
        f, STATUS_BAD_ARGUMENT,
        "a film of %d x %d pixels, expected even numbers from 320 x 240 to 4096 x 4096",
        o->width, o->height);

    for (int i = 0; i < run_count; i++) {
        FAULT_IF(runs[i].result->trace.row_count == 0, f, STATUS_BAD_ARGUMENT,
                 "the run has no rows to draw");
    }
    return STATUS_OK;
}

// Paints the frames in turn and adds each to the file.
static status add_frames(film_painter *p, film_file *file, fault *f)
{
    const film_options *o = &p->options;
    const int total = (int)fmax(2, round(o->seconds * o->frames_per_second));
    g_autoptr(cairo_surface_t) frame =
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, o->width, o->height);

    // a frame with every colour of the film, for formats that have a palette
    if (film_file_wants_palette(file)) {
        TRY(film_painter_palette(p, frame, f));
        TRY(film_file_add(file, frame, f));
    }

    for (int i = 0; i < total; i++) {
        FAULT_IF(o->stop != NULL && *o->stop != 0, f, STATUS_STOPPED,
                 "stopped: %d of %d frames were painted, no film is left", i, total);
        TRY(film_painter_frame(p, o->seconds * i / (total - 1), frame, f));
        TRY(film_file_add(file, frame, f));
        if (o->progress != NULL) {
            o->progress(o->context, i + 1, total);
        }
    }
    return STATUS_OK;
}

// Writes the film into its file, which is whole or goes.
static status write_frames(film_painter *p, const char *path, fault *f)
{
    // the same notes as a picture's, of the first run
    g_autofree char *values = parameters_line(p->runs[0].scenario);
    g_autofree char *title = scenario_title(p->runs[0].scenario);
    const png_note notes[] = {{"Title", title},
                              {"Software", picture_software()},
                              {"Parameters", values},
                              {"Renderer", scene_renderer_name(p->scenes[0])}};

    // the frames; if one fails the file is abandoned
    g_autoptr(film_file) file = NULL;
    TRY(film_file_open(&file, path, &p->options, notes, 4, f));
    TRY(add_frames(p, file, f));
    return film_file_commit(g_steal_pointer(&file), f);
}

// A film from first to last; options that are 0 get their usual values.
status film_write(const film_run *runs, int run_count, const film_options *options,
                  const char *path, fault *f)
{
    assert(run_count >= 1 && run_count <= FILM_RUNS);

    // what the options leave to us
    film_options o = *options;
    if (o.width == 0 && o.height == 0) {
        o.width = 1280;
        o.height = 720;
    }

    if (o.frames_per_second == 0) {
        o.frames_per_second = 30;
    }
    if (o.seconds == 0) {
        o.seconds = 10;
    }
    if (o.slow == 0) {
        o.slow = 8;
    }

    // only a film that can be painted
    assert(o.frames_per_second > 0 && o.seconds > 0 && o.slow >= 1);
    assert(o.ghosts >= 0 && o.ghosts < SCENE_INSTANTS);
    TRY(check_film(&o, runs, run_count, f));

    g_autoptr(film_painter) painter = NULL;
    TRY(film_painter_create(&painter, runs, run_count, &o, f));
    return write_frames(painter, path, f);
}
