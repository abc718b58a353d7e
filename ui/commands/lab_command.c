// The lab on the terminal, or its screen printed as text.
#include "ui/commands/command.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <wchar.h>

#include "src/base/clock.h"
#include "src/base/text_stream.h"
#include "src/base/words.h"
#include "ui/explorer/explorer.h"
#include "ui/terminal/pictures.h"
#include "ui/terminal/terminal.h"

#define FRAME         (1.0 / 60) // shortest time between two pictures [s]
#define LONGEST_PAUSE 0.1        // between two pictures while something moves [s]
#define PATIENCE      0.01       // a run that takes longer is computed meanwhile [s]
// a longer pause (suspended, dragged about) counts as this [s]
#define LONGEST_FRAME 0.25

enum { INPUTS_AT_ONCE = 32 }; // between two pictures, at most

static const char first_scenario[] = "corrected/first-impact";

// --- without a terminal ----------------------------------------------------------------

// Carries out a file of commands, one a line. Stops at the first that fails.
static int run_script(explorer *ex, const char *path)
{
    char line[LINE_TEXT];
    FILE *stream = stdin;
    if (strcmp(path, "-") != 0) {
        stream = fopen(path, "r");
    }
    if (stream == NULL) {
        return complain("%s cannot be read: %s", path, strerror(errno));
    }

    // line by line until one fails or quits
    int code = EXIT_DONE;
    for (int number = 1;
         code == EXIT_DONE && !ex->input.quit && fgets(line, sizeof line, stream);
         number++) {
        if (strchr(line, '\n') == NULL && !feof(stream)) {
            code = complain("%s:%d: no command, expected a text of less than %d bytes "
                            "and the end of the line",
                            path, number, LINE_TEXT);
            break;
        }
        line[strcspn(line, "\r\n")] = '\0';
        if (!explorer_carry_out(ex, line)) {
            complain("%s:%d: %s", path, number, ex->input.message.text);
            code = EXIT_FAILED;
        }
    }
    if (ferror(stream)) {
        code = complain("%s cannot be read: %s", path, strerror(errno));
    }

    if (stream != stdin) {
        fclose(stream);
    }
    return code;
}

static void print_screen(explorer *ex)
{
    screen s = {0};
    screen_resize(&s, ex->view.size.width, ex->view.size.height);
    explorer_draw(ex, &s);
    screen_dump(&s, ex->view.looks.glyphs, stdout);
    screen_finish(&s);
}

static int run_off_screen(explorer *ex, const arguments *a)
{
    fault f = {0};
    if (a->size.width > 0) {
        ex->view.size = (screen_size){a->size.width, a->size.height};
    } else {
        ex->view.size = (screen_size){120, 40};
    }
    int code = EXIT_DONE;
    if (a->script != NULL) {
        code = run_script(ex, a->script);
    }
    if (code == EXIT_DONE && a->keys != NULL && !explorer_keys(ex, a->keys, &f)) {
        code = complain_fault(&f);
    }
    if (code == EXIT_DONE && !a->quiet) {
        print_screen(ex);
    }

    // the keys went on, but what they were to do is not done
    if (code == EXIT_DONE && ex->first_failure[0] != '\0') {
        complain("--keys: %s", ex->first_failure);
        code = EXIT_FAILED;
    }
    return code;
}

// --- on a terminal ---------------------------------------------------------------------

static void take_input(explorer *ex, terminal_input in)
{
    if (in.kind == TERMINAL_KEY) {
        if (in.pasted) {
            explorer_paste(ex, in.code);
        } else {
            explorer_key(ex, in.code);
        }
    } else if (in.kind == TERMINAL_POINTER) {
        explorer_point(ex, in.pointer);
    } else if (in.kind == TERMINAL_RESIZE) {
        ex->view.looks.redraw = true;
    }
}

// Fits the grid to the terminal and shows it.
static void show(explorer *ex, screen *s, picture_layer *layer)
{
    int width, height;
    looks *l = &ex->view.looks;
    terminal_size(&width, &height);

    // with pictures if the terminal draws them and they are wanted
    const terminal_pixels t = terminal_pixels_known();
    if (l->pixels && t.there) {
        s->pictures = layer;
    } else {
        s->pictures = NULL;
    }
    layer->cell_width = t.cell_width;
    layer->cell_height = t.cell_height;
    if (t.has_ground) {
        layer->ground = t.ground;
    } else {
        layer->ground = theme_grounds(l->theme)[0];
    }
    if (width != s->width || height != s->height) {
        screen_resize(s, width, height);
    }
    terminal_mouse(l->mouse);
    l->shown_depth = l->depth;
    if (l->depth == DEPTH_AUTO) {
        l->shown_depth = terminal_depth();
    }
    explorer_draw(ex, s);
    terminal_show(s, l->glyphs, l->theme, l->depth, l->redraw);
    l->redraw = false;
    loss_forget(); // the next picture shows what this one lacks
}

// Returns whether the user ended it.
static bool run_on_terminal(explorer *ex)
{
    screen s = {0};
    picture_layer layer = {0};
    bool dirty = true, leave = false, taken_any = false;
    double drawn = 0, pause = FRAME, last = clock_seconds(CLOCK_MONOTONIC);

    while (!ex->input.quit && !leave) {
        // draw, though not more often than frames
        double now = clock_seconds(CLOCK_MONOTONIC);
        if (dirty && now - drawn >= pause) {
            const double spent = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
            const size_t sent = terminal_sent();
            show(ex, &s, &layer);
            drawn = now;
            dirty = false;

            // half of the processor is left to others, but ten pictures a second are
            // shown, as far as the rate that was asked for [kB/s] lets them
            const double took = clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - spent;
            const double bytes = (double)(terminal_sent() - sent),
                         rate = ex->view.looks.rate;
            pause = fmin(fmax(FRAME, 2 * took), LONGEST_PAUSE);
            if (rate > 0) {
                pause = fmax(pause, bytes / (1e3 * rate));
            }
        }

        bool waits = dirty || explorer_is_busy(ex);
        // a picture that took longer than a frame leaves nothing to wait for
        double left =
            fmax(0, dirty ? pause - (clock_seconds(CLOCK_MONOTONIC) - drawn) : pause);
        left = fmin(waits ? left : HUGE_VAL, recovery_keep(ex, taken_any, now));
        terminal_input in = terminal_wait(isfinite(left) ? left : -1);
        now = clock_seconds(CLOCK_MONOTONIC);

        // what was computed, and time going on
        dirty |= explorer_follow(ex);
        if (ex->view.playback.playing) {
            act_advance(&ex->model, &ex->view, &ex->input,
                        now - last < LONGEST_FRAME ? now - last : LONGEST_FRAME);
            dirty = true;
        }

        // all input that has arrived, so that keys never wait for pictures that are out
        // of date
        last = now;
        taken_any = in.kind != TERMINAL_NONE;
        for (int taken = 0; in.kind != TERMINAL_NONE && !ex->input.quit && !leave;
             taken++) {
            dirty = true;
            leave = in.kind == TERMINAL_LEAVE;
            take_input(ex, in);
            in.kind = TERMINAL_NONE;
            if (taken < INPUTS_AT_ONCE && !leave) {
                in = terminal_wait(0);
            }
        }
        if (ex->input.copied != NULL) {
            terminal_copy(ex->input.copied);
            free(ex->input.copied);
            ex->input.copied = NULL;
        }
    }

    screen_finish(&s);
    pictures_finish(&layer);
    return !leave;
}

// What the terminal can be expected to show: the console of Linux has no braille in its
// fonts.
static glyph_set usual_glyphs(void)
{
    const char *name = getenv("TERM");
    if (!terminal_has_utf8()) {
        return GLYPHS_ASCII;
    }
    if (name != NULL && strcmp(name, "linux") == 0) {
        return GLYPHS_BLOCKS;
    }
    return GLYPHS_BRAILLE;
}

static int open_explorer(explorer *ex, const arguments *a)
{
    scenario s;
    int code = EXIT_DONE;

    // a session brings its own scenarios: the lab opens, and then it
    const char *named = a->operand_count > 0 ? a->operands[0] : first_scenario;
    const bool is_session = named[text_stem(named, ".session")] != '\0';
    int ended = open_scenario(&s, is_session ? first_scenario : named, a);
    if (ended != EXIT_DONE) {
        return ended;
    }

    bool live = a->keys == NULL && a->script == NULL && a->size.width == 0;
    fault f = {0};
    if (explorer_init(ex, &s, live ? PATIENCE : HUGE_VAL, &f) != STATUS_OK) {
        return complain_fault(&f);
    }

    // the terminal's own looks, then those that were kept
    char line[LINE_TEXT];
    ex->view.looks.glyphs = usual_glyphs();
    if (live) {
        if (terminal_is_light()) {
            ex->view.looks.theme = COLOURS_LIGHT;
        } else {
            ex->view.looks.theme = COLOURS_DARK;
        }
        explorer_load_settings(&ex->model, &ex->view, &ex->input);
        if (a->operand_count == 0) {
            explorer_welcome(ex);
        }
        const bool wide =
            wcwidth(L'\u28ff') == 1; // the locale is there and knows braille
        if (!wide) {
            ex->view.looks.glyphs = GLYPHS_ASCII;
        }
    }

    // what the command line says comes last
    const char *const settings[3][2] = {{"glyphs", a->glyphs},
                                        {"theme", a->theme},
                                        {"colours", a->colours}};
    for (int i = 0; i < 3; i++) {
        snprintf(line, sizeof line, "%s %s", settings[i][0],
                 settings[i][1] ? settings[i][1] : "");
        if (settings[i][1] != NULL && !explorer_carry_out(ex, line)) {
            code = complain("--%s: %s", settings[i][0], ex->input.message.text);
        }
    }

    if (code == EXIT_DONE && is_session &&
        !explorer_open_session(&ex->model, &ex->view, &ex->input, named)) {
        code = complain("%s", ex->input.message.text);
    }
    if (code != EXIT_DONE) {
        explorer_finish(ex);
    }
    return code;
}

// Opens the lab with the named scenario and runs it until the user leaves; with --keys,
// --script or
// --size it prints the screen instead. Returns the exit status.
static int explore(const arguments *a)
{
    explorer ex;
    fault f = {0};

    bool off_screen = a->keys != NULL || a->script != NULL || a->size.width > 0;
    if (!off_screen && !terminal_usable(&f)) {
        return complain_fault(&f);
    }

    int ended = open_explorer(&ex, a);
    if (ended != EXIT_DONE) {
        return ended;
    }
    int code = EXIT_DONE;
    if (off_screen) {
        code = run_off_screen(&ex, a);
    } else if (terminal_open(&f) != STATUS_OK) {
        code = complain_fault(&f);
    } else {
        // what is offered is not played over
        ex.view.playback.playing = !recovery_begin(&ex);
        recovery_end(&ex, run_on_terminal(&ex));
        terminal_close();

        // what is left on the terminal
        const session *e = &ex.model.session;
        say("%s, %d change%s, peak force %.4g N\n", e->base.name, e->input_count,
            e->input_count == 1 ? "" : "s", e->run.summary.peak_force_N);
    }

    explorer_finish(&ex);
    return code;
}

// --- the command

static const option_row rows[] = {
    OPTION(TEXT, "keys", "KEYS",
           "press these keys: characters, and <Right>, <Enter>, <C-l>...", PLACE(keys)),
    OPTION(FILE, "script", "FILE|-", "carry out commands, one a line, as : takes them",
           PLACE(script)),
    OPTION(SIZE, "size", "WIDTHxHEIGHT",
           "print a screen of this size in characters (120x40)", PLACE(size),
           .high = 1000, .unit = "characters"),
    OPTION(CHOICE, "glyphs", "braille|blocks|ascii", "characters to draw with",
           PLACE(glyphs)),
    OPTION(CHOICE, "theme", "dark|light|mono", "colours for that ground", PLACE(theme)),
    OPTION(CHOICE, "colours", "auto|true|256|16|mono",
           "how many of them the terminal has", PLACE(colours), .alias = "colors"),
};
const option_table lab_options = OPTION_TABLE("Options", rows);

const command lab_command = {
    CALLED("lab", ONE_RUN, "Explore a run on the terminal"),
    SCENARIOS("[SCENARIO|FILE.session]", 0, 1),
    .help = "Opens corrected/first-impact if no scenario is named; ? lists the "
            "keys. With --keys, --script or\n--size nothing is shown live: the "
            "keys are pressed, then the script's screen is printed as text.\n",
    .options = {&set_options, &lab_options, &quiet_options},
    .run = explore,
};
