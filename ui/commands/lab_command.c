// impactlab lab: the lab on the terminal, or its screen printed as text.
#include "ui/commands/command.h"

#include <errno.h>
#include <glib.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <wchar.h>

#include "render/drawing.h"
#include "src/base/clock.h"
#include "src/base/text_stream.h"
#include "src/base/words.h"
#include "ui/commands/results.h"
#include "ui/explorer/actions/actions.h"
#include "ui/explorer/explorer.h"
#include "ui/terminal/pictures.h"
#include "ui/terminal/terminal.h"

#define FRAME         (1.0 / 60) // shortest time between two pictures [s]
#define LONGEST_PAUSE 0.1        // between two pictures while something moves [s]
#define PATIENCE      0.01       // a run that takes longer is computed meanwhile [s]
#define LONGEST_FRAME 0.25 // a longer one (suspended, dragged about) counts as this [s]

enum { INPUTS_AT_ONCE = 32 }; // between two pictures, at most

static const char first_scenario[] = "corrected/first-impact";

// --- without a terminal ----------------------------------------------------------------

// Carries out one line of a script. Returns the exit status.
static int run_script_line(explorer *ex, const char *path, int number, char *line)
{
    line[strcspn(line, "\r\n")] = '\0';
    if (!explorer_carry_out(ex, line)) {
        complain("%s:%d: %s", path, number, ex->input.message.text);
        return EXIT_FAILED;
    }
    return EXIT_DONE;
}

// Carries out a file of commands, one a line, until one fails or quits. Returns the exit
// status.
static int run_script(explorer *ex, const char *path)
{
    FILE *stream = stdin;
    if (strcmp(path, "-") != 0) {
        stream = fopen(path, "r");
    }
    if (stream == NULL) {
        return complain("%s cannot be read: %s", path, strerror(errno));
    }

    // line by line
    char line[LINE_TEXT];
    int result = EXIT_DONE;
    for (int number = 1; result == EXIT_DONE && !ex->input.quit; number++) {
        if (fgets(line, sizeof line, stream) == NULL) {
            break;
        }
        const bool is_cut_off = strchr(line, '\n') == NULL && !feof(stream);
        if (is_cut_off) {
            result = complain("%s:%d: no command, expected a text of less than %d bytes "
                              "and the end of the line",
                              path, number, LINE_TEXT);
        } else {
            result = run_script_line(ex, path, number, line);
        }
    }
    if (ferror(stream)) {
        result = complain("%s cannot be read: %s", path, strerror(errno));
    }

    if (stream != stdin) {
        fclose(stream);
    }
    return result;
}

static void print_screen(explorer *ex)
{
    screen s = {0};
    screen_resize(&s, ex->view.size.width, ex->view.size.height);
    explorer_draw(ex, &s);
    screen_dump(&s, ex->view.looks.glyphs, stdout);
    screen_finish(&s);
}

// Carries out the script, presses the keys and prints the screen. Returns the exit
// status.
static int run_off_screen(explorer *ex, const arguments *a)
{
    fault f = {0};
    ex->view.size = (screen_size){120, 40};
    if (a->size.width > 0) {
        ex->view.size = (screen_size){a->size.width, a->size.height};
    }

    int result = EXIT_DONE;
    if (a->script != NULL) {
        result = run_script(ex, a->script);
    }
    if (result == EXIT_DONE && a->keys != NULL && !explorer_keys(ex, a->keys, &f)) {
        result = complain_fault(&f);
    }
    if (result == EXIT_DONE && !a->quiet) {
        print_screen(ex);
    }

    // the keys went on, but what they were to do is not done
    if (result == EXIT_DONE && ex->first_failure[0] != '\0') {
        complain("--keys: %s", ex->first_failure);
        result = EXIT_FAILED;
    }
    return result;
}

// --- on a terminal ---------------------------------------------------------------------

// The lab while it is shown live.
typedef struct live_lab {
    explorer *ex;
    screen screen;
    picture_layer pictures;
    bool outdated;      // the terminal does not show what there is
    bool left;          // the terminal went away
    bool any_input;     // came since the last wait
    double shown_at;    // when the terminal got its last picture [s]
    double pause;       // until the next one, at least [s]
    double advanced_to; // the instant until which playback went on [s]
} live_lab;

static double now_in_seconds(void)
{
    return clock_seconds(CLOCK_MONOTONIC);
}

// Fits pictures between the characters to what the terminal says of itself; without the
// module that draws there are none, and the lab says so once.
static void fit_pictures(live_lab *lab)
{
    const terminal_pixels known = terminal_pixels_known();
    explorer_input *input = &lab->ex->input;
    looks *l = &lab->ex->view.looks;
    picture_layer *layer = &lab->pictures;
    lab->screen.pictures = NULL;
    if (l->pixels && known.there) {
        l->pixels = act_succeeded(input, drawing_open(&input->fault));
    }
    if (l->pixels && known.there) {
        lab->screen.pictures = layer;
    }
    layer->cell_width = known.cell_width;
    layer->cell_height = known.cell_height;
    layer->ground = theme_grounds(l->theme)[0];
    if (known.has_ground) {
        layer->ground = known.ground;
    }
}

// Draws the lab and sends what changed to the terminal.
static void show_lab(live_lab *lab)
{
    looks *l = &lab->ex->view.looks;
    screen *s = &lab->screen;
    fit_pictures(lab);

    // fit the grid to the terminal
    int width, height;
    terminal_size(&width, &height);
    if (width != s->width || height != s->height) {
        screen_resize(s, width, height);
    }

    // what looks ask of the terminal
    terminal_mouse(l->mouse);
    l->depth = terminal_depth();

    // the picture
    explorer_draw(lab->ex, s);
    terminal_show(s, l->glyphs, l->theme, l->redraw);
    l->redraw = false;
    loss_forget(); // the next picture shows what this one lacks
}

// Shows the lab and chooses how long that picture stays at least. Half of the processor
// is left to others, but ten pictures a second are shown, as far as the rate that was
// asked for lets them.
static void show_and_pace(live_lab *lab, double now)
{
    const double cpu_before = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
    const size_t sent_before = terminal_sent();
    show_lab(lab);
    lab->shown_at = now;
    lab->outdated = false;

    const double cpu_time = clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu_before;
    lab->pause = fmin(fmax(FRAME, 2 * cpu_time), LONGEST_PAUSE);
    const double rate = 1e3 * lab->ex->view.looks.rate; // [B/s]
    if (rate > 0) {
        lab->pause = fmax(lab->pause, (double)(terminal_sent() - sent_before) / rate);
    }
}

// Waits for input, no longer than until there is something to show or to keep.
static terminal_input wait_for_input(live_lab *lab, double now)
{
    double longest = recovery_keep(lab->ex, lab->any_input, now);
    if (lab->outdated) {
        // a picture that took longer than its pause leaves nothing to wait for
        const double shown_for = now_in_seconds() - lab->shown_at;
        longest = fmin(longest, fmax(0, lab->pause - shown_for));
    } else if (explorer_is_busy(lab->ex)) {
        longest = fmin(longest, lab->pause);
    }

    if (!isfinite(longest)) {
        longest = -1; // without end
    }
    return terminal_wait(longest);
}

// Shows what was computed meanwhile, and plays on.
static void follow_time(live_lab *lab, double now)
{
    explorer *ex = lab->ex;
    if (explorer_follow(ex)) {
        lab->outdated = true;
    }
    if (ex->view.playback.playing) {
        act_advance(&ex->model, &ex->view, &ex->input,
                    fmin(now - lab->advanced_to, LONGEST_FRAME));
        lab->outdated = true;
    }
    lab->advanced_to = now;
}

// Hands one input to the lab.
static void take_input(live_lab *lab, terminal_input in)
{
    switch (in.kind) {
    case TERMINAL_KEY:
        if (in.pasted) {
            explorer_paste(lab->ex, in.code);
        } else {
            explorer_key(lab->ex, in.code);
        }
        break;

    case TERMINAL_POINTER:
        explorer_point(lab->ex, in.pointer);
        break;
    case TERMINAL_RESIZE:
        lab->ex->view.looks.redraw = true;
        break;
    case TERMINAL_LEAVE:
        lab->left = true;
        break;
    default:
        break;
    }
}

// Takes all input that has arrived, so that keys never wait for pictures that are out of
// date.
static void take_all_input(live_lab *lab, terminal_input first)
{
    terminal_input in = first;
    lab->any_input = in.kind != TERMINAL_NONE;
    for (int taken = 0; in.kind != TERMINAL_NONE; taken++) {
        take_input(lab, in);
        lab->outdated = true;
        if (lab->left || lab->ex->input.quit || taken == INPUTS_AT_ONCE) {
            break;
        }
        in = terminal_wait(0);
    }
}

// Gives the terminal what was copied.
static void hand_out_copy(explorer_input *input)
{
    if (input->copied != NULL) {
        terminal_copy(input->copied);
        free(input->copied);
        input->copied = NULL;
    }
}

// Lets the user edit a file, if the lab asks for that, and opens what became of it.
static void run_editor(live_lab *lab)
{
    explorer *ex = lab->ex;
    char *path = ex->input.edits;
    if (path[0] == '\0') {
        return;
    }
    const char *editor = getenv("VISUAL");
    if (editor == NULL || editor[0] == '\0') {
        editor = getenv("EDITOR");
    }
    if (editor == NULL || editor[0] == '\0') {
        editor = "vi";
    }
    g_autofree char *quoted = g_shell_quote(path);
    g_autofree char *line = g_strconcat(editor, " ", quoted, NULL);
    if (terminal_run(line) != 0) {
        act_warn(&ex->input, "'%.100s' did not end well: the scenario stays", editor);
    } else {
        g_autofree char *open = g_strconcat("open ", path, NULL);
        explorer_carry_out(ex, open);
    }
    path[0] = '\0';
    lab->outdated = ex->view.looks.redraw = true;
    lab->advanced_to = now_in_seconds();
}

// Returns whether the user ended it.
static bool run_on_terminal(explorer *ex)
{
    live_lab lab = {.ex = ex,
                    .outdated = true,
                    .pause = FRAME,
                    .advanced_to = now_in_seconds()};

    // show what changed, wait for input, take it
    while (!ex->input.quit && !lab.left) {
        double now = now_in_seconds();
        if (lab.outdated && now - lab.shown_at >= lab.pause) {
            show_and_pace(&lab, now);
        }

        const terminal_input in = wait_for_input(&lab, now);
        now = now_in_seconds();
        follow_time(&lab, now);
        take_all_input(&lab, in);
        hand_out_copy(&ex->input);
        run_editor(&lab);
    }

    screen_finish(&lab.screen);
    pictures_finish(&lab.pictures);
    return !lab.left;
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

// Whether the lab is shown live, not printed as text.
static bool is_live(const arguments *a)
{
    return a->keys == NULL && a->script == NULL && a->size.width == 0;
}

// Gives the lab the terminal's own looks, then those that were kept.
static void prepare_looks(explorer *ex, const arguments *a)
{
    looks *l = &ex->view.looks;
    l->glyphs = usual_glyphs();
    if (!is_live(a)) {
        return;
    }

    l->theme = COLOURS_DARK;
    if (terminal_is_light()) {
        l->theme = COLOURS_LIGHT;
    }
    explorer_load_settings(&ex->model, &ex->view, &ex->input);
    explorer_remember_looks(&ex->model, &ex->view);
    if (a->operand_count == 0) {
        explorer_welcome(ex);
    }

    // without a locale that knows braille no character beyond ASCII has a width
    if (wcwidth(L'\u28ff') != 1) {
        l->glyphs = GLYPHS_ASCII;
    }
}

// Carries out what the command line says of looks, as a command of the lab. Returns the
// exit status.
static int set_look_option(explorer *ex, const char *name, const char *value)
{
    if (value == NULL) {
        return EXIT_DONE;
    }
    char line[LINE_TEXT];
    snprintf(line, sizeof line, "%s %s", name, value);
    if (!explorer_carry_out(ex, line)) {
        return complain("--%s: %s", name, ex->input.message.text);
    }
    return EXIT_DONE;
}

// Sets the looks that the command line asks for. Returns the exit status.
static int set_look_options(explorer *ex, const arguments *a)
{
    const int result = set_look_option(ex, "glyphs", a->glyphs);
    return worse(result, set_look_option(ex, "theme", a->theme));
}

// Opens the lab on the scenario or session that is named. Returns the exit status; unless
// it is EXIT_DONE, nothing has to be closed.
static int open_explorer(explorer *ex, const arguments *a)
{
    const char *named = first_scenario;
    if (a->operand_count > 0) {
        named = a->operands[0];
    }

    // a session brings its own scenarios: the lab opens, and then it
    const bool is_session = named[text_stem(named, ".session")] != '\0';
    scenario s;
    const char *first = is_session ? first_scenario : named;
    int result = command_scenario_open(&s, first, a);
    if (result != EXIT_DONE) {
        return result;
    }

    // off screen a run is waited for, however long it takes
    const double patience = is_live(a) ? PATIENCE : HUGE_VAL;
    fault f = {0};
    if (explorer_init(ex, &s, patience, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    prepare_looks(ex, a);
    result = set_look_options(ex, a);
    if (result == EXIT_DONE && is_session &&
        !explorer_open_session(&ex->model, &ex->view, &ex->input, named)) {
        result = complain("%s", ex->input.message.text);
    }
    if (result != EXIT_DONE) {
        explorer_finish(ex);
    }
    return result;
}

// Shows the lab until the user leaves. Returns the exit status.
static int run_live(explorer *ex)
{
    fault f = {0};
    if (terminal_open(&f) != STATUS_OK) {
        return complain_fault(&f);
    }

    // while a recovered session is offered nothing is played
    explorer_keep_lines(ex);
    ex->input.has_terminal = true;
    ex->view.playback.playing = !recovery_begin(ex);
    recovery_end(ex, run_on_terminal(ex));
    terminal_close();

    // what is left on the terminal
    const session *e = &ex->model.session;
    say("%s, %d change%s, peak force %.4g N\n", e->base.name, e->input_count,
        plural_ending((size_t)e->input_count), e->run.summary.peak_force_N);
    return EXIT_DONE;
}

// Opens the lab with the named scenario and runs it until the user leaves; with --keys,
// --script or --size it prints the screen instead. Returns the exit status.
static int explore(const arguments *a)
{
    explorer ex;
    fault f = {0};
    if (is_live(a) && !terminal_usable(&f)) {
        return complain_fault(&f);
    }

    // opened, used and closed
    int result = open_explorer(&ex, a);
    if (result != EXIT_DONE) {
        return result;
    }
    if (is_live(a)) {
        result = run_live(&ex);
    } else {
        result = run_off_screen(&ex, a);
    }
    explorer_finish(&ex);
    return result;
}

// --- the command -----------------------------------------------------------------------

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
};
const option_table lab_options = OPTION_TABLE("Options", rows);

const command lab_command = {
    .name = "lab",
    .group = GROUP_ONE_RUN,
    .summary = "Explore a run on the terminal",
    .operands = "[SCENARIO|FILE.session]",
    .least = 0,
    .most = 1,
    .takes_scenarios = true,
    .help =
        "Opens corrected/first-impact if no scenario is named; ? lists the keys. With "
        "--keys, --script or\n"
        "--size nothing is shown live: the keys are pressed, then the script's screen is "
        "printed as text.\n",
    .options = {&set_options, &lab_options, &quiet_options},
    .run = explore,
};
