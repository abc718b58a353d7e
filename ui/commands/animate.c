#include "ui/commands/command.h"

#include <unistd.h>

#include "render/scene/film.h"
#include "render/scene/film_file.h"
#include "ui/commands/scene_request.h"

enum { BAR_LENGTH = 40 };

static volatile sig_atomic_t signal_caught;

static void catch_signal(int number)
{
    signal_caught = number;
}

// The progress bar: a line on the terminal that is written over.
static void show_progress(void *context, int done, int total)
{
    char bar[BAR_LENGTH + 1];
    (void)context;
    for (int i = 0; i < BAR_LENGTH; i++) {
        bar[i] = i < BAR_LENGTH * done / total ? '=' : ' ';
    }
    bar[BAR_LENGTH] = '\0';
    fprintf(stderr, "\r[%s] %3d %%  %d of %d frames", bar, 100 * done / total, done, total);
}

static int read_options(const arguments *a, film_options *o)
{
    scene_request r;
    double rate = 0;
    int code = read_scene_request(a, &r);
    if (code != EXIT_DONE) {
        return code;
    }
    *o = (film_options){.camera = r.options.camera,
                        .renderer = r.options.renderer,
                        .width = r.options.width,
                        .height = r.options.height,
                        .stop = &signal_caught};
    code = read_number_between("fps", a->fps, 1, 120, &rate);
    o->frames_per_second = (int)rate;
    if (code == EXIT_DONE) {
        code = read_number_between("seconds", a->seconds, 0.1, 3600, &o->seconds);
    }
    if (code == EXIT_DONE) {
        code = read_number_between("slow", a->slow, 1, 1000, &o->slow);
    }
    return code;
}

// Films the run. An interrupt ends it in order: no half film stays behind.
static int film_run(const arguments *a, const scenario *s, const run_result *result,
                    film_options *o)
{
    fault f = {0};
    struct sigaction caught = {.sa_handler = catch_signal}, old[2];
    bool bar = isatty(STDERR_FILENO) && !a->quiet;
    o->progress = bar ? show_progress : NULL;
    sigemptyset(&caught.sa_mask);
    sigaction(SIGINT, &caught, &old[0]);
    sigaction(SIGTERM, &caught, &old[1]);
    status code = film_write(s, result, o, a->output, &f);
    sigaction(SIGINT, &old[0], NULL);
    sigaction(SIGTERM, &old[1], NULL);
    if (bar) {
        fprintf(stderr, "\r%78s\r", "");
    }
    if (code == STATUS_OK) {
        if (!a->quiet) {
            printf("%s: %s\n", s->name, a->output);
        }
        return EXIT_DONE;
    }
    int exit_status = complain_fault(&f);
    return signal_caught != 0 ? 128 + signal_caught : exit_status;
}

static int simulate_and_film(const arguments *a, const scenario *s, film_options *o)
{
    run_result result;
    int exit_status = EXIT_FAILED;
    status code = run_scenario(s, true, &result);
    if (code != STATUS_OK) {
        complain("%s failed: %s", s->name,
                 result.summary.message[0] ? result.summary.message : status_text(code));
    } else {
        exit_status = film_run(a, s, &result, o);
    }
    run_finish(&result);
    return exit_status;
}

static int animate(const arguments *a)
{
    scenario s;
    film_options o;
    fault f = {0};
    if (a->output == NULL) {
        return complain("animate needs a place for the film: -o FILE.mp4, FILE.webm, FILE.gif, or "
                        "a folder for PNG frames");
    }
    int result = read_options(a, &o);
    if (result == EXIT_DONE && film_file_check(a->output, &f) != STATUS_OK) {
        result = complain_fault(&f);
    }
    if (result == EXIT_DONE) {
        result = open_scenario(&s, a->operands[0], a);
    }
    if (result != EXIT_DONE) {
        return result;
    }
    result = simulate_and_film(a, &s, &o);
    scenario_finish(&s);
    return result;
}

const command animate_command = {
    .name = "animate",
    .operands = "SCENARIO",
    .options = "soGKZFUVq",
    .summary = "Make a film of a run: the arm in space and its traces",
    .help = "-o FILE.mp4, FILE.webm or FILE.gif needs the program ffmpeg; any other name is that "
            "of a folder, to\nbe made, for PNG frames. The first impact is slowed down against "
            "the rest.\n",
    .least = 1,
    .most = 1,
    .run = animate,
};
