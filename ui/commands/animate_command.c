// impactlab animate: films of one or more runs.
#include "ui/commands/command.h"

#include <unistd.h>

#include "render/scene/film.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/progress.h"

enum { BAR_LENGTH = 40 };

// The progress bar: a line on the terminal that is written over.
static void show_progress(void *context, int done, int total)
{
    static const char full[BAR_LENGTH + 1] = "========================================";
    const int filled = BAR_LENGTH * done / total;
    fprintf(stderr, "\r[%.*s%*s] %3d %%  %d of %d frames", filled, full,
            BAR_LENGTH - filled, "", 100 * done / total, done, total);
}

// The runs of a film with their scenarios.
typedef struct filmed {
    scenario scenarios[FILM_RUNS];
    run_result results[FILM_RUNS];
    const char *names[FILM_RUNS];
    int opened, run;
} filmed;

static void finish_filmed(filmed *m)
{
    for (int i = 0; i < m->run; i++) {
        run_finish(&m->results[i]);
    }
    for (int i = 0; i < m->opened; i++) {
        scenario_finish(&m->scenarios[i]);
    }
}

// Opens the scenarios, then the first one again with each --beside. Returns the exit
// status.
static int open_all(filmed *m, const arguments *a)
{
    if (a->operand_count + a->besides.count > FILM_RUNS) {
        return complain("%d runs in one film, expected at most %d",
                        a->operand_count + a->besides.count, FILM_RUNS);
    }

    for (int i = 0; i < a->operand_count + a->besides.count; i++) {
        bool beside = i >= a->operand_count;
        scenario *s = &m->scenarios[i];
        int ended = open_scenario(s, a->operands[beside ? 0 : i], a);
        if (ended != EXIT_DONE) {
            return ended;
        }
        m->opened++;
        m->names[i] = s->name;
        if (beside) {
            m->names[i] = a->besides.items[i - a->operand_count];
            if (scenario_override_all(s, &a->besides.items[i - a->operand_count], 1,
                                      complain_sentence, NULL) != STATUS_OK) {
                return EXIT_BAD_ARGUMENTS;
            }
        }
    }
    return EXIT_DONE;
}

// Runs all of them. Returns the exit status.
static int run_all(const arguments *a, filmed *m)
{
    for (; m->run < m->opened; m->run++) {
        run_result *result = &m->results[m->run];
        const scenario *s = &m->scenarios[m->run];
        status code = run_with_progress(a, s, true, result);
        if (code != STATUS_OK) {
            // the run's own words say more than its status
            const char *name = m->names[m->run++], *why = result->summary.message;
            if (code == STATUS_STOPPED) {
                return run_stopped(s, "no film is made");
            }
            return worse(EXIT_FAILED, complain("%s failed: %s", name,
                                               why[0] ? why : status_text(code)));
        }
    }
    return EXIT_DONE;
}

// Films the runs. An interrupt ends it in order: no half film stays behind.
static int film_runs(const arguments *a, const filmed *m)
{
    fault f = {0};
    film_run runs[FILM_RUNS];
    const scene_options view = read_view(a);
    film_options o = {.view = view,
                      .ghosts = (int)a->ghosts,
                      .width = view.width,
                      .height = view.height,
                      .frames_per_second = (int)a->fps,
                      .seconds = a->seconds,
                      .slow = a->slow,
                      .stop = &interrupted};
    bool bar = isatty(STDERR_FILENO) && !a->quiet;
    if (bar) {
        o.progress = show_progress;
    } else {
        o.progress = NULL;
    }
    for (int i = 0; i < m->run; i++) {
        runs[i] = (film_run){&m->scenarios[i], &m->results[i], m->names[i]};
    }

    status code = film_write(runs, m->run, &o, a->output, &f);
    if (bar) {
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

static int animate(const arguments *a)
{
    if (a->output == NULL) {
        return complain("animate needs a place for the film: -o FILE.mp4, FILE.webm, "
                        "FILE.gif, FILE.webp, or a folder for PNG frames");
    }

    // errors of the request are reported before anything is simulated
    int ended = check_view(a);
    if (ended != EXIT_DONE) {
        return ended;
    }
    fault f = {0};
    if (film_file_check(a->output, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    SCOPED(finish_filmed) filmed m = {0};
    ended = open_all(&m, a);
    if (ended != EXIT_DONE) {
        return ended;
    }
    ended = run_all(a, &m);
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
    CALLED("animate", PICTURES, "Make a film of a run: the arm in space and its traces"),
    SCENARIOS("SCENARIO...", 1, FILM_RUNS),
    .help = "-o FILE.mp4, FILE.webm, FILE.gif or FILE.webp needs the program "
            "ffmpeg; any other name is that of a folder, to\nbe made, for PNG "
            "frames. Every impact is slowed down against the rest. Several "
            "scenarios, or\n--beside, share the screen and one clock.\n",
    .options = {&set_options, OWN_OPTIONS(rows), &quiet_options, &view_options},
    .run = animate,
};
