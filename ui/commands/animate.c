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

static film_options options_of(const arguments *a)
{
    scene_options view = read_view(a);
    return (film_options){.view = view,
                          .ghosts = (int)a->ghosts,
                          .width = view.width,
                          .height = view.height,
                          .frames_per_second = (int)a->fps,
                          .seconds = a->seconds,
                          .slow = a->slow,
                          .stop = &signal_caught};
}

// Films the run. An interrupt ends it in order: no half film stays behind.
static int film_run(const arguments *a, const scenario *s, const run_result *result,
                    film_options *o)
{
    fault f = {0};
    struct sigaction caught = {.sa_handler = catch_signal}, old[2];
    bool bar = isatty(STDERR_FILENO) && !a->quiet;
    o->progress = bar ? show_progress : NULL;

    // a signal ends the film, not the program: no half file stays
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
            say("%s: %s\n", s->name, a->output);
        }
        return EXIT_DONE;
    }

    int exit_status = complain_fault(&f);
    return signal_caught != 0 ? 128 + signal_caught : exit_status;
}

static int simulate_and_film(const arguments *a, scenario *s)
{
    run_result result;
    film_options o = options_of(a);
    int exit_status = EXIT_FAILED;
    status code = run_scenario(s, true, &result);

    // the run's own words say more than its status
    if (code != STATUS_OK) {
        complain("%s failed: %s", s->name,
                 result.summary.message[0] ? result.summary.message : status_text(code));
    } else {
        exit_status = film_run(a, s, &result, &o);
    }
    run_finish(&result);
    return exit_status;
}

static int animate(const arguments *a)
{
    fault f = {0};
    if (a->output == NULL) {
        return complain("animate needs a place for the film: -o FILE.mp4, FILE.webm, FILE.gif, "
                        "FILE.webp, or a folder for PNG frames");
    }

    // what is wrong with the request is told before anything is simulated
    int code = check_view(a);
    if (code != EXIT_DONE) {
        return code;
    }
    if (film_file_check(a->output, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    return with_scenario(a->operands[0], a, simulate_and_film);
}

static const option_row rows[] = {
    {.name = "output",
     .letter = 'o',
     .type = OPTION_PLACE,
     .value = "PATH",
     .help = "film or folder to write to",
     PLACE(output)},
    {.name = "fps",
     .type = OPTION_NUMBER,
     .value = "N",
     .help = "frames per second of the film (30)",
     PLACE(fps),
     .low = 1,
     .high = 120},
    {.name = "seconds",
     .type = OPTION_NUMBER,
     .value = "S",
     .help = "length of the film (10)",
     PLACE(seconds),
     .low = 0.1,
     .high = 3600,
     .unit = "s"},
    {.name = "theme",
     .type = OPTION_CHOICE,
     .value = "light|dark",
     .help = "on a light or a dark ground (light)",
     PLACE(theme)},
    {.name = "ghosts",
     .type = OPTION_WHOLE,
     .value = "N",
     .help = "earlier arms behind the present one, 20 ms apart (0)",
     PLACE(ghosts),
     .low = 0,
     .high = 31},
    {.name = "slow",
     .type = OPTION_NUMBER,
     .value = "N",
     .help = "how much the first impact is slowed down (8)",
     PLACE(slow),
     .low = 1,
     .high = 1000},
};
static const option_table options = OPTION_TABLE("Options", rows);

const command animate_command = {
    .name = "animate",
    .group = GROUP_PICTURES,
    .operands = "SCENARIO",
    .summary = "Make a film of a run: the arm in space and its traces",
    .help = "-o FILE.mp4, FILE.webm, FILE.gif or FILE.webp needs the program ffmpeg; any other "
            "name is that "
            "of a folder, to\nbe made, for PNG frames. The first impact is slowed down against "
            "the rest.\n",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .options = {&set_options, &options, &quiet_options, &view_options},
    .run = animate,
};
