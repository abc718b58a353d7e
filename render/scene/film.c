// A film is written frame by frame: painted, then given to its file.
#include "render/scene/film.h"

#include <assert.h>
#include <math.h>

#include "render/plot/trace_plot.h"

static status check_film_options(const film_options *o, fault *f)
{
    FAULT_IF(
        o->width < 320 || o->width > 4096 || o->height < 240 || o->height > 4096 ||
            o->width % 2 != 0 || o->height % 2 != 0,
        f, STATUS_BAD_ARGUMENT,
        "a film of %d x %d pixels, expected even numbers from 320 x 240 to 4096 x 4096",
        o->width, o->height);

    FAULT_IF(o->frames_per_second < 1 || o->frames_per_second > 120, f,
             STATUS_BAD_ARGUMENT, "%d frames per second, expected 1 to 120",
             o->frames_per_second);

    FAULT_IF(!(o->seconds >= 0.1 && o->seconds <= 3600), f, STATUS_BAD_ARGUMENT,
             "a film of %g s, expected 0.1 to 3600", o->seconds);

    FAULT_IF(o->ghosts < 0 || o->ghosts >= SCENE_INSTANTS, f, STATUS_BAD_ARGUMENT,
             "%d ghosts, expected 0 to %d", o->ghosts, SCENE_INSTANTS - 1);

    FAULT_IF(!(o->slow >= 1 && o->slow <= 1000), f, STATUS_BAD_ARGUMENT,
             "impacts slowed down %g times, expected 1 to 1000", o->slow);
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

static status write_frames(film_painter *p, const char *path, fault *f)
{
    // the same notes as a picture's, of the first run
    g_autofree char *values = parameters_line(p->runs[0].scenario);
    g_autofree char *title = scenario_title(p->runs[0].scenario);
    const png_note notes[] = {{"Title", title},
                              {"Software", picture_software()},
                              {"Parameters", values},
                              {"Renderer", scene_renderer_name(p->scenes[0])}};

    g_autoptr(film_file) file = NULL;
    TRY(film_file_open(&file, path, &p->options, notes, 4, f));
    TRY(add_frames(p, file, f));
    return film_file_commit(g_steal_pointer(&file), f);
}

status film_write(const film_run *runs, int run_count, const film_options *options,
                  const char *path, fault *f)
{
    assert(run_count >= 1 && run_count <= FILM_RUNS);
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
    TRY(check_film_options(&o, f));
    for (int i = 0; i < run_count; i++) {
        FAULT_IF(runs[i].result->trace.row_count == 0, f, STATUS_BAD_ARGUMENT,
                 "the run has no rows to draw");
    }

    g_autoptr(film_painter) painter = NULL;
    TRY(film_painter_create(&painter, runs, run_count, &o, f));
    return write_frames(painter, path, f);
}
