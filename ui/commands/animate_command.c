// impactlab animate: films of one or more runs.
#include "ui/commands/command.h"

#include <stdio.h>
#include <unistd.h>

#include "ui/commands/command_pictures.h"
#include "ui/commands/progress.h"

enum { BAR_LENGTH = 40 };

// The progress bar: a line on the terminal that is written over.
static void show_frame_progress(void *context, int done, int total)
{
    (void)context;
    static const char full[BAR_LENGTH + 1] = "========================================";
    const int filled = BAR_LENGTH * done / total;
    fprintf(stderr, "\r[%.*s%*s] %3d %%  %d of %d frames", filled, full,
            BAR_LENGTH - filled, "", 100 * done / total, done, total);
}

// The runs of a film with their scenarios.
typedef struct filmed_runs {
    scenario scenarios[FILM_RUNS];
    run_result results[FILM_RUNS];
    const char *names[FILM_RUNS];
    int opened; // scenarios
    int run;    // of them
} filmed_runs;

static void filmed_runs_finish(filmed_runs *m)
{
    for (int i = 0; i < m->run; i++) {
        run_finish(&m->results[i]);
    }
    for (int i = 0; i < m->opened; i++) {
        scenario_finish(&m->scenarios[i]);
    }
}

// Opens one more scenario. Returns the exit status.
static int open_filmed(filmed_runs *m, const arguments *a, const char *scenario_name)
{
    const int i = m->opened;
    const int ended = command_scenario_open(&m->scenarios[i], scenario_name, a);
    if (ended == EXIT_DONE) {
        m->names[i] = m->scenarios[i].name;
        m->opened++;
    }
    return ended;
}

// Opens the first scenario once more with the change of a --beside. Returns the exit
// status.
static int open_beside(filmed_runs *m, const arguments *a, char *change)
{
    const int i = m->opened;
    const int ended = open_filmed(m, a, a->operands[0]);
    if (ended != EXIT_DONE) {
        return ended;
    }
    m->names[i] = change;
    if (scenario_override_all(&m->scenarios[i], &change, 1, complain_sentence, NULL) !=
        STATUS_OK) {
        return EXIT_BAD_ARGUMENTS;
    }
    return EXIT_DONE;
}

// Opens the scenarios of the film. Returns the exit status.
static int open_all_filmed(filmed_runs *m, const arguments *a)
{
    const int count = a->operand_count + a->besides.count;
    if (count > FILM_RUNS) {
        return complain("%d runs in one film, expected at most %d", count, FILM_RUNS);
    }

    // the scenarios
    for (int i = 0; i < a->operand_count; i++) {
        const int ended = open_filmed(m, a, a->operands[i]);
        if (ended != EXIT_DONE) {
            return ended;
        }
    }

    // the first one with each change
    for (int i = 0; i < a->besides.count; i++) {
        const int ended = open_beside(m, a, a->besides.items[i]);
        if (ended != EXIT_DONE) {
            return ended;
        }
    }
    return EXIT_DONE;
}

// Runs the i-th scenario. Returns the exit status.
static int run_filmed(const arguments *a, filmed_runs *m, int i)
{
    run_result *result = &m->results[i];
    const status code =
        run_with_progress(a, &m->scenarios[i], (run_options){.keep_trace = true}, result);
    m->run++;
    if (code == STATUS_OK) {
        return EXIT_DONE;
    }
    if (code == STATUS_STOPPED) {
        return run_stopped(&m->scenarios[i], "no film is made");
    }

    // the run's own words say more than its status
    const char *why = result->summary.message;
    if (why[0] == '\0') {
        why = status_text(code);
    }
    complain("%s failed: %s", m->names[i], why);
    return EXIT_FAILED;
}

// Films the runs. An interrupt leaves no part of a film. Returns the exit status.
static int film_runs(const arguments *a, const filmed_runs *m)
{
    const scene_options view = read_view(a);
    film_options o = {.view = view,
                      .ghosts = (int)a->ghosts,
                      .width = view.width,
                      .height = view.height,
                      .frames_per_second = (int)a->fps,
                      .seconds = a->seconds,
                      .slow = a->slow,
                      .stop = &interrupted};

    // frames take long: on a terminal a bar shows how far they are
    const bool shows_progress = isatty(STDERR_FILENO) && !a->quiet;
    if (shows_progress) {
        o.progress = show_frame_progress;
    }

    // the runs with their names in the film
    film_run runs[FILM_RUNS];
    for (int i = 0; i < m->run; i++) {
        runs[i] = (film_run){&m->scenarios[i], &m->results[i], m->names[i]};
    }

    // the film itself
    fault f = {0};
    const status code = drawing()->film_write(runs, m->run, &o, a->output, &f);
    if (shows_progress) {
        fprintf(stderr, "\r%78s\r", "");
    }
    if (code != STATUS_OK) {
        return complain_fault(&f);
    }
    if (!a->quiet) {
        say("%s: %s\n", m->names[0], a->output);
    }
    return EXIT_DONE;
}

// Checks what is asked for, before anything is simulated. Returns the exit status.
static int check_film_request(const arguments *a)
{
    if (a->output == NULL) {
        return complain("animate needs a place for the film: -o FILE.mp4, FILE.webm, "
                        "FILE.gif, FILE.webp, or a folder for PNG frames");
    }

    const int ended = check_view(a);
    if (ended != EXIT_DONE) {
        return ended;
    }
    fault f = {0};
    if (drawing()->film_file_check(a->output, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    return EXIT_DONE;
}

// The command: opens and runs all scenarios of the film, and films them.
static int animate(const arguments *a)
{
    int ended = check_film_request(a);
    if (ended != EXIT_DONE) {
        return ended;
    }

    // all runs, then the film of them
    SCOPED(filmed_runs_finish) filmed_runs m = {0};
    ended = open_all_filmed(&m, a);
    for (int i = 0; i < m.opened && ended == EXIT_DONE; i++) {
        ended = run_filmed(a, &m, i);
    }
    if (ended != EXIT_DONE) {
        return ended;
    }
    return film_runs(a, &m);
}

static const option_row rows[] = {
    OPTION(PARAMETERS, "beside", "PATH=VALUE",
           "the first scenario once more with this change, in a view of its own; up to 3 "
           "of them",
           PLACE(besides)),
    OUTPUT_OPTION(PLACE, "PATH", "film or folder to write to"),
    OPTION(NUMBER, "fps", "N", "frames per second of the film (30)", PLACE(fps), .low = 1,
           .high = 120),
    OPTION(NUMBER, "seconds", "S", "length of the film (10)", PLACE(seconds), .low = 0.1,
           .high = 3600, .unit = "s"),
    OPTION(CHOICE, "theme", "light|dark", "on a light or a dark ground (light)",
           PLACE(theme)),
    OPTION(WHOLE, "ghosts", "N", "earlier arms behind the present one, 20 ms apart (0)",
           PLACE(ghosts), .low = 0, .high = 31),
    OPTION(NUMBER, "slow", "N", "how much impacts are slowed down (8)", PLACE(slow),
           .low = 1, .high = 1000),
};

const command animate_command = {
    .name = "animate",
    .group = GROUP_PICTURES,
    .summary = "Make a film of a run: the arm in space and its traces",
    .operands = "SCENARIO...",
    .least = 1,
    .most = FILM_RUNS,
    .takes_scenarios = true,
    .draws = true,
    .help =
        "-o FILE.mp4, FILE.webm, FILE.gif or FILE.webp needs the program ffmpeg; any "
        "other name is that of a folder, to\n"
        "be made, for PNG frames. Every impact is slowed down against the rest. Several "
        "scenarios, or\n"
        "--beside, share the screen and one clock.\n",
    .options = {&set_options, OWN_OPTIONS(rows), &quiet_options, &view_options},
    .run = animate,
};
