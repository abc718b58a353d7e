#include "render/scene/film.h"

#include <assert.h>
#include <math.h>

#include "render/plot/trace_plot.h"
#include "src/run/background_run.h"

enum { MOST_THREADS = 2, BUFFERS = 2 };

// ---- the frames of a film

// A frame that was painted, and what came of it.
typedef struct frame_job {
    cairo_surface_t *onto;
    status code;
    fault fault;
} frame_job;

// What writes the film. A second thread paints every other frame ahead: while one of its two
// surfaces is being written it paints onto the other.
typedef struct film_making {
    const film_plan *plan;
    int total; // frames
    film_painter *painter;
    film_file *file;
    cairo_surface_t *frame;
    GThread *second;                 // NULL: all frames are painted here
    GAsyncQueue *to_paint, *painted; // frame_job
    frame_job jobs[BUFFERS];
} film_making;

static double film_time_of(const film_making *m, int frame)
{
    return m->plan->options.seconds * frame / (m->total - 1);
}

// On the second thread: every other frame, until a job without a surface ends it.
static gpointer paint_others(gpointer making)
{
    film_making *m = making;
    g_autoptr(film_painter) painter = NULL;

    // signals are for the thread that writes: they end its waiting
    worker_signals_block(NULL);
    for (int frame = 1; frame < m->total; frame += 2) {
        frame_job *job = g_async_queue_pop(m->to_paint);
        if (job->onto == NULL) {
            break;
        }
        job->code =
            painter != NULL ? STATUS_OK : film_painter_create(&painter, m->plan, &job->fault);
        if (job->code == STATUS_OK) {
            const double time = film_time_of(m, frame);
            job->code = film_painter_frame(painter, time, job->onto, &job->fault);
        }
        g_async_queue_push(m->painted, job);
    }
    return NULL;
}

// Without a thread to be had all frames are painted here.
static void begin_second(film_making *m)
{
    const film_options *o = &m->plan->options;
    m->to_paint = g_async_queue_new();
    m->painted = g_async_queue_new();
    for (int i = 0; i < BUFFERS; i++) {
        m->jobs[i].onto = cairo_image_surface_create(CAIRO_FORMAT_RGB24, o->width, o->height);
        g_async_queue_push(m->to_paint, &m->jobs[i]);
    }
    m->second = g_thread_try_new("frames", paint_others, m, NULL);
}

static void end_second(film_making *m)
{
    frame_job last = {0};
    if (m->second != NULL) {
        g_async_queue_push_front(m->to_paint, &last);
        g_thread_join(m->second);
    }
    g_clear_pointer(&m->to_paint, g_async_queue_unref);
    g_clear_pointer(&m->painted, g_async_queue_unref);
    for (int i = 0; i < BUFFERS; i++) {
        cairo_surface_destroy(m->jobs[i].onto);
    }
}

// The next frame in the order of the film, painted here or by the second thread.
static status next_frame(film_making *m, int frame, fault *f)
{
    if (m->second == NULL || frame % 2 == 0) {
        TRY(film_painter_frame(m->painter, film_time_of(m, frame), m->frame, f));
        return film_file_add(m->file, m->frame, f);
    }
    frame_job *done = g_async_queue_pop(m->painted);
    FAULT_IF(done->code != STATUS_OK, f, done->code, "%s", done->fault.text);
    TRY(film_file_add(m->file, done->onto, f));
    g_async_queue_push(m->to_paint, done);
    return STATUS_OK;
}

static status add_frames(film_making *m, fault *f)
{
    const film_options *o = &m->plan->options;
    const int total = m->total = (int)fmax(2, round(o->seconds * o->frames_per_second));
    status code = STATUS_OK;

    // a frame with every colour of the film, for formats that have a palette
    if (film_file_wants_palette(m->file)) {
        TRY(film_painter_palette(m->painter, m->frame, f));
        TRY(film_file_add(m->file, m->frame, f));
    }

    if (o->threads > 1) {
        begin_second(m);
    }
    for (int i = 0; i < total && code == STATUS_OK; i++) {
        if (o->stop != NULL && *o->stop != 0) {
            code = fault_set(f, STATUS_STOPPED, "interrupted after %d of %d frames", i, total);
            break;
        }
        code = next_frame(m, i, f);
        if (code == STATUS_OK && o->progress != NULL) {
            o->progress(o->context, i + 1, total);
        }
    }
    end_second(m);
    return code;
}

// ---- the film

static status check_options(const film_options *o, fault *f)
{
    FAULT_IF(o->width < 320 || o->width > 4096 || o->height < 240 || o->height > 4096 ||
                 o->width % 2 != 0 || o->height % 2 != 0,
             f, STATUS_BAD_ARGUMENT,
             "a film of %d x %d pixels, expected even numbers from 320 x 240 to 4096 x 4096",
             o->width, o->height);

    FAULT_IF(o->frames_per_second < 1 || o->frames_per_second > 120, f, STATUS_BAD_ARGUMENT,
             "%d frames per second, expected 1 to 120", o->frames_per_second);

    FAULT_IF(!(o->seconds >= 0.1 && o->seconds <= 3600), f, STATUS_BAD_ARGUMENT,
             "a film of %g s, expected 0.1 to 3600", o->seconds);

    FAULT_IF(o->ghosts < 0 || o->ghosts >= SCENE_INSTANTS, f, STATUS_BAD_ARGUMENT,
             "%d ghosts, expected 0 to %d", o->ghosts, SCENE_INSTANTS - 1);

    FAULT_IF(!(o->slow >= 1 && o->slow <= 1000), f, STATUS_BAD_ARGUMENT,
             "impacts slowed down %g times, expected 1 to 1000", o->slow);
    return STATUS_OK;
}

static status record(film_making *m, const char *path, fault *f)
{
    // the same notes as a picture's, of the first run
    const film_plan *plan = m->plan;
    g_autofree char *values = parameters_line(plan->runs[0].scenario);
    g_autofree char *title = scenario_title(plan->runs[0].scenario);
    const png_note notes[] = {{"Title", title},
                              {"Software", picture_software()},
                              {"Parameters", values},
                              {"Renderer", scene_renderer_name(m->painter->scenes[0])}};
    g_autoptr(film_file) file = NULL;
    TRY(film_file_open(&file, path, &plan->options, notes, 4, f));
    m->file = file;
    TRY(add_frames(m, f));
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
    o.frames_per_second = o.frames_per_second ? o.frames_per_second : 30;
    o.seconds = o.seconds != 0 ? o.seconds : 10;
    o.slow = o.slow != 0 ? o.slow : 8;
    o.threads = o.threads > 0 ? o.threads : (int)g_get_num_processors();
    o.threads = o.threads < MOST_THREADS ? o.threads : MOST_THREADS;

    // only a film that can be painted
    TRY(check_options(&o, f));
    for (int i = 0; i < run_count; i++) {
        FAULT_IF(runs[i].result->trace.row_count == 0, f, STATUS_BAD_ARGUMENT,
                 "the run has no rows to draw");
    }

    // planned, then painted
    g_auto(film_plan) plan = {0};
    g_autoptr(film_painter) painter = NULL;
    TRY(film_plan_init(&plan, runs, run_count, &o, f));
    TRY(film_painter_create(&painter, &plan, f));
    g_autoptr(cairo_surface_t) frame =
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, o.width, o.height);
    return record(&(film_making){.plan = &plan, .painter = painter, .frame = frame}, path, f);
}
