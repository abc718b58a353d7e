#include "ui/commands/command.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "ui/explorer/lab.h"
#include "ui/terminal/terminal.h"

#define FRAME         (1.0 / 60) // shortest time between two pictures [s]
#define PATIENCE      0.01       // a run that takes longer is computed meanwhile [s]
#define LONGEST_FRAME 0.25       // a longer pause (suspended, dragged about) counts as this [s]

static const char first_scenario[] = "corrected/first-impact";

static double seconds_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// --- without a terminal -----------------------------------------------------------------------

// Carries out a file of commands, one a line. Stops at the first that fails.
static int run_script(lab *l, const char *path)
{
    char line[LAB_TEXT];
    bool is_stdin = strcmp(path, "-") == 0;
    FILE *stream = is_stdin ? stdin : fopen(path, "r");
    if (stream == NULL) {
        return complain("%s cannot be read: %s", path, strerror(errno));
    }
    int code = EXIT_DONE;
    for (int number = 1; code == EXIT_DONE && !l->quit && fgets(line, sizeof line, stream);
         number++) {
        line[strcspn(line, "\r\n")] = '\0';
        if (!lab_carry_out(l, line)) {
            complain("%s:%d: %s", path, number, l->message);
            code = EXIT_FAILED;
        }
    }
    if (!is_stdin) {
        fclose(stream);
    }
    return code;
}

static int print_screen(lab *l, int width, int height)
{
    screen s = {0};
    if (!screen_resize(&s, width, height)) {
        complain("%s", status_text(STATUS_NO_MEMORY));
        return EXIT_FAILED;
    }
    lab_draw(l, &s);
    screen_dump(&s, l->glyphs, stdout);
    screen_finish(&s);
    return EXIT_DONE;
}

static int run_off_screen(lab *l, const arguments *a)
{
    int width = 120, height = 40;
    fault f = {0};
    int code = EXIT_DONE;
    if (a->size.width > 0) {
        width = a->size.width;
        height = a->size.height;
    }
    l->width = width;
    l->height = height;
    if (code == EXIT_DONE && a->script != NULL) {
        code = run_script(l, a->script);
    }
    if (code == EXIT_DONE && a->keys != NULL && !lab_keys(l, a->keys, &f)) {
        code = complain_fault(&f);
    }
    if (code == EXIT_DONE && !a->quiet) {
        code = print_screen(l, width, height);
    }
    return code;
}

// --- on a terminal ----------------------------------------------------------------------------

static void take_input(lab *l, terminal_input in)
{
    if (in.kind == TERMINAL_KEY) {
        lab_key(l, in.code);
    } else if (in.kind == TERMINAL_POINTER) {
        lab_point(l, in.pointer);
    } else if (in.kind == TERMINAL_RESIZE) {
        l->redraw = true;
    }
}

// Fits the grid to the terminal and shows it.
static void show(lab *l, screen *s)
{
    int width, height;
    terminal_size(&width, &height);
    if ((width != s->width || height != s->height) && !screen_resize(s, width, height)) {
        return;
    }
    terminal_mouse(l->mouse);
    lab_draw(l, s);
    terminal_show(s, l->glyphs, l->theme, l->depth, l->redraw);
    l->redraw = false;
}

static void run_on_terminal(lab *l)
{
    screen s = {0};
    bool dirty = true, leave = false;
    double drawn = 0, last = seconds_now();
    while (!l->quit && !leave) {
        double now = seconds_now();
        if (dirty && now - drawn >= FRAME) {
            show(l, &s);
            drawn = now;
            dirty = false;
        }
        bool waits = dirty || l->playing || l->session.computing != NULL;
        // a picture that took longer than a frame leaves nothing to wait for
        double left = fmax(0, dirty ? FRAME - (seconds_now() - drawn) : FRAME);
        terminal_input in = terminal_wait(waits ? left : -1);
        now = seconds_now();
        dirty |= lab_follow(l);
        if (l->playing) {
            lab_advance(l, now - last < LONGEST_FRAME ? now - last : LONGEST_FRAME);
            dirty = true;
        }
        last = now;
        dirty |= in.kind != TERMINAL_NONE;
        leave = in.kind == TERMINAL_LEAVE;
        take_input(l, in);
    }
    screen_finish(&s);
}

// What is left on the terminal when the lab is gone.
static void say_goodbye(const lab *l)
{
    const session *e = &l->session;
    printf("%s, %d change%s, peak force %.4g N\n", e->base.name, e->input_count,
           e->input_count == 1 ? "" : "s", e->run.summary.peak_force_N);
}

static int open_lab(lab *l, const arguments *a)
{
    scenario s;
    fault f = {0};
    int code = open_scenario(&s, a->operand_count > 0 ? a->operands[0] : first_scenario, a);
    if (code != EXIT_DONE) {
        return code;
    }
    bool live = a->keys == NULL && a->script == NULL && a->size.width == 0;
    if (lab_open_patiently(l, &s, live ? PATIENCE : HUGE_VAL, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    char line[LAB_TEXT];
    l->glyphs = terminal_has_utf8() ? GLYPHS_BRAILLE : GLYPHS_ASCII;
    if (live) {
        l->theme = terminal_is_light() ? COLOURS_LIGHT : COLOURS_DARK;
        lab_settings_load(l);
        l->glyphs = terminal_has_utf8() ? l->glyphs : GLYPHS_ASCII;
    }
    const char *const settings[3][2] = {
        {"glyphs", a->glyphs}, {"theme", a->theme}, {"colours", a->colours}};
    for (int i = 0; i < 3; i++) {
        snprintf(line, sizeof line, "%s %s", settings[i][0], settings[i][1] ? settings[i][1] : "");
        if (settings[i][1] != NULL && !lab_carry_out(l, line)) {
            code = complain("--%s: %s", settings[i][0], l->message);
        }
    }
    if (code != EXIT_DONE) {
        lab_finish(l);
    }
    return code;
}

static int run(const arguments *a)
{
    lab l;
    fault f = {0};
    bool off_screen = a->keys != NULL || a->script != NULL || a->size.width > 0;
    if (!off_screen && !terminal_usable(&f)) {
        return complain_fault(&f);
    }
    int code = open_lab(&l, a);
    if (code != EXIT_DONE) {
        return code;
    }
    if (off_screen) {
        code = run_off_screen(&l, a);
    } else if (terminal_open(&f) != STATUS_OK) {
        code = complain_fault(&f);
    } else {
        l.playing = true;
        run_on_terminal(&l);
        terminal_close();
        say_goodbye(&l);
    }
    lab_finish(&l);
    return code;
}

static const option_row rows[] = {
    {.name = "keys",
     .type = OPTION_TEXT,
     .value = "KEYS",
     .help = "press these keys: characters, and <Right>, <Enter>, <C-l>...",
     PLACE(keys)},
    {.name = "script",
     .type = OPTION_FILE,
     .value = "FILE|-",
     .help = "carry out commands, one a line, as : takes them",
     PLACE(script)},
    {.name = "size",
     .type = OPTION_SIZE,
     .value = "WIDTHxHEIGHT",
     .help = "print a screen of this size in characters (120x40)",
     PLACE(size),
     .high = 1000,
     .unit = "characters"},
    {.name = "glyphs",
     .type = OPTION_CHOICE,
     .value = "braille|blocks|ascii",
     .help = "characters to draw with",
     PLACE(glyphs)},
    {.name = "theme",
     .type = OPTION_CHOICE,
     .value = "dark|light|mono",
     .help = "colours for that ground",
     PLACE(theme)},
    {.name = "colours",
     .alias = "colors",
     .type = OPTION_CHOICE,
     .value = "auto|true|256|16|mono",
     .help = "how many of them the terminal has",
     PLACE(colours)},
};
static const option_table options = OPTION_TABLE("Options", rows);

const command lab_command = {
    .name = "lab",
    .group = GROUP_ONE_RUN,
    .operands = "[SCENARIO]",
    .summary = "Explore a run on the terminal",
    .help = "Opens corrected/first-impact if no scenario is named; ? lists the keys. With --keys, "
            "--script or\n--size nothing is shown live: the keys are pressed, then the script's "
            "screen is printed as text.\n",
    .most = 1,
    .takes_scenarios = true,
    .options = {&set_options, &options, &quiet_options},
    .run = run,
};
