// The commands of the terminal lab and the keys they are on: one table for both, and for the help.
#include "ui/lab_state.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/scene.h"
#include "render/trace_plot.h"
#include "src/lab/export.h"
#include "src/lab/whole_file.h"
#include "src/words.h"

typedef struct lab_action {
    const char *name;
    const char *argument; // as the help shows it
    const char *help;
    bool (*act)(lab *l, const char *argument);
} lab_action;

typedef struct lab_binding {
    const char *key; // a character, or a name as lab_keys takes it without brackets
    const char *line;
} lab_binding;

static bool complain_about(lab *l, status code, const fault *f)
{
    if (code != STATUS_OK) {
        lab_say(l, true, "%s", f->text[0] ? f->text : status_text(code));
    }
    return code == STATUS_OK;
}

// Reads a number; false with a message if the argument is none.
static bool take_number(lab *l, const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(*value)) {
        lab_say(l, true, "'%s' is no number", text);
        return false;
    }
    return true;
}

// --- time -------------------------------------------------------------------------------------

static bool play(lab *l, const char *argument)
{
    (void)argument;
    l->playing = !l->playing;
    l->message[0] = '\0';
    if (l->playing && l->session.now >= session_end(&l->session)) {
        session_seek(&l->session, 0);
    }
    return true;
}

static bool step(lab *l, const char *argument)
{
    double rows = 1;
    if (argument[0] != '\0' && !take_number(l, argument, &rows)) {
        return false;
    }
    l->playing = false;
    session_step(&l->session, (long)fmax(-1e9, fmin(1e9, rows)));
    return true;
}

static void tell_event(lab *l)
{
    const event *e = session_event(&l->session);
    if (e == NULL) {
        return;
    }
    if (e->kind == EVENT_IMPACT) {
        lab_say(l, false, "impact at %.6f s: %.4g N s at %.4g m/s, %.4g J lost", e->time,
                e->impulse, e->speed, e->loss);
    } else {
        lab_say(l, false, "%s at %.6f s", event_name(e->kind), e->time);
    }
}

static bool step_event(lab *l, const char *argument)
{
    bool back = argument[0] == '-';
    l->playing = false;
    if (!session_step_event(&l->session, back ? -1 : 1)) {
        lab_say(l, true, "no %s event", back ? "earlier" : "later");
        return false;
    }
    tell_event(l);
    return true;
}

static bool seek(lab *l, const char *argument)
{
    double time = session_end(&l->session);
    if (strcmp(argument, "end") != 0 && !take_number(l, argument, &time)) {
        return false;
    }
    l->playing = false;
    session_seek(&l->session, time);
    return true;
}

static bool set_speed(lab *l, const char *argument)
{
    static const double steps[] = {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2,
                                   0.5,   1,     2,     5,    10,   20,   50,  100};
    const int count = sizeof steps / sizeof steps[0];
    double wanted = l->speed;
    if (strcmp(argument, "up") == 0) {
        for (int i = count; i-- > 0;) {
            wanted = steps[i] > l->speed * 1.001 ? steps[i] : wanted;
        }
    } else if (strcmp(argument, "down") == 0) {
        for (int i = 0; i < count; i++) {
            wanted = steps[i] < l->speed * 0.999 ? steps[i] : wanted;
        }
    } else if (!take_number(l, argument, &wanted)) {
        return false;
    }
    if (!(wanted >= 1e-3 && wanted <= 1e4)) {
        lab_say(l, true, "the speed is a number from 0.001 to 10000, 1 is real time");
        return false;
    }
    l->speed = wanted;
    return true;
}

static bool restart(lab *l, const char *argument)
{
    (void)argument;
    session_seek(&l->session, 0);
    l->session.seen = 0;
    l->playing = true;
    l->message[0] = '\0';
    return true;
}

static bool wait_for(lab *l, const char *argument)
{
    double seconds;
    if (!take_number(l, argument, &seconds)) {
        return false;
    }
    lab_advance(l, fmax(0, fmin(3600, seconds)));
    return true;
}

// --- changes ----------------------------------------------------------------------------------

// Gives a parameter a new value and says what came of it.
static bool change(lab *l, int parameter, const char *text)
{
    fault f = {0};
    session *s = &l->session;
    const parameter_info *info = &parameter_table[parameter];
    if (!complain_about(l, session_change(s, parameter, text, &f), &f)) {
        return false;
    }
    const session_input *in = &s->inputs[s->input_count - 1];
    if (s->run.summary.status != STATUS_OK) {
        lab_say(l, true, "the run stops: %s", s->run.summary.message);
    } else if (in->kind == INPUT_TIMED) {
        lab_say(l, false, "%s = %s %s from %.4f s on", info->path, text, info->unit, in->time);
    } else {
        lab_say(l, false, "%s = %s %s from the start", info->path, text, info->unit);
    }
    return true;
}

static bool set(lab *l, const char *argument)
{
    char path[LAB_TEXT];
    size_t length = strcspn(argument, " =");
    snprintf(path, sizeof path, "%.*s", (int)length, argument);
    const char *value = argument + length + strspn(argument + length, " =");
    int parameter = parameter_find(path);
    if (parameter < 0) {
        const char *near = parameter_suggest(path);
        lab_say(l, true, "there is no parameter '%s'%s%s%s", path, near ? ", did you mean " : "",
                near ? near : "", near ? "?" : "");
        return false;
    }
    if (value[0] == '\0') {
        const parameter_info *info = &parameter_table[parameter];
        l->parameter = parameter;
        lab_say(l, false, "%s: %s", info->path, info->description);
        return true;
    }
    l->parameter = parameter;
    return change(l, parameter, value);
}

// The next or the previous value of the selected parameter: a tenth more or less, another choice.
static bool nudge(lab *l, const char *argument)
{
    int direction = argument[0] == '-' ? -1 : 1, index = l->parameter;
    const parameter_info *info = &parameter_table[index];
    parameters p = session_parameters_at(&l->session, l->session.now);
    double value = parameter_get(&p, index);
    char text[LAB_TEXT];
    fault f = {0};
    if (info->type == PARAMETER_TEXT) {
        lab_say(l, true, "%s is a text: Enter edits it", info->path);
        return false;
    }
    if (info->type == PARAMETER_REAL) {
        double size = value != 0 ? fabs(value) : 0.1;
        value += direction * pow(10, floor(log10(size) + 1e-9)) / 10;
        snprintf(text, sizeof text, "%.6g", value);
        value = strtod(text, NULL);
    } else {
        value += direction;
    }
    value = fmax(info->minimum, fmin(info->maximum, value));
    if (!complain_about(l, parameter_set_number(&p, index, value, &f), &f)) {
        return false;
    }
    parameter_format(&p, index, text, sizeof text);
    return change(l, index, text);
}

static bool edit(lab *l, const char *argument)
{
    (void)argument;
    char value[LAB_TEXT];
    parameters p = session_parameters_at(&l->session, l->session.now);
    parameter_format(&p, l->parameter, value, sizeof value);
    const parameter_info *info = &parameter_table[l->parameter];
    l->prompting = true;
    snprintf(l->prompt, sizeof l->prompt, "set %s %.160s", info->path, value);
    if (info->choices != NULL) {
        lab_say(l, false, "%s: %s", info->description, info->choices);
    } else if (info->type == PARAMETER_REAL || info->type == PARAMETER_INTEGER) {
        lab_say(l, false, "%s: %g to %g %s", info->description, info->minimum, info->maximum,
                info->unit);
    } else {
        lab_say(l, false, "%s", info->description);
    }
    return true;
}

static bool push(lab *l, const char *argument)
{
    double impulse = 0.01;
    fault f = {0};
    if (argument[0] != '\0' && !take_number(l, argument, &impulse)) {
        return false;
    }
    if (!complain_about(l, session_push(&l->session, impulse, &f), &f)) {
        return false;
    }
    lab_say(l, false, "pushed with %g N s at %.4f s", impulse, l->session.now);
    return true;
}

static bool undo(lab *l, const char *argument)
{
    (void)argument;
    fault f = {0};
    bool done = complain_about(l, session_undo(&l->session, &f), &f);
    if (done) {
        lab_say(l, false, "undone, U puts it in again");
    }
    return done;
}

static bool redo(lab *l, const char *argument)
{
    (void)argument;
    fault f = {0};
    bool done = complain_about(l, session_redo(&l->session, &f), &f);
    if (done) {
        lab_say(l, false, "put in again");
    }
    return done;
}

static bool branch(lab *l, const char *argument)
{
    (void)argument;
    fault f = {0};
    bool done = complain_about(l, session_branch(&l->session, &f), &f);
    if (done) {
        lab_say(l, false,
                "branched at %.4f s: change something, the old run stays beside it "
                "(c compares, B forgets it)",
                l->session.now);
    }
    return done;
}

static bool forget(lab *l, const char *argument)
{
    (void)argument;
    session_forget_other(&l->session);
    return true;
}

static bool exchange_model(lab *l, const char *argument)
{
    (void)argument;
    bool printed = l->session.effective.parameters.arm.model == ARM_PRINTED;
    return change(l, parameter_find("arm.model"), printed ? "corrected" : "printed");
}

static bool extend(lab *l, const char *argument)
{
    char text[NUMBER_TEXT];
    double duration = l->session.effective.parameters.run.duration, more = duration;
    if (argument[0] != '\0' && !take_number(l, argument, &more)) {
        return false;
    }
    double seen = l->session.seen;
    number_format(text, duration + more);
    if (!change(l, parameter_find("run.duration"), text)) {
        return false;
    }
    l->session.seen = seen;
    return true;
}

// --- looking ----------------------------------------------------------------------------------

static bool select_parameter(lab *l, const char *argument)
{
    int direction = argument[0] == '-' ? -1 : 1;
    for (int i = l->parameter + direction; i >= 0 && i < parameter_count; i += direction) {
        if (lab_applies(l, i)) {
            l->parameter = i;
            break;
        }
    }
    return true;
}

static bool set_mark(lab *l, const char *argument)
{
    (void)argument;
    l->has_mark = !l->has_mark;
    l->mark = l->session.now;
    lab_say(l, false, l->has_mark ? "mark set: values now show the difference to it" : "no mark");
    return true;
}

static bool other_side(lab *l, const char *argument)
{
    (void)argument;
    l->side = (l->side + 1) % SIDES;
    return true;
}

static bool zoom(lab *l, const char *argument)
{
    double from, to, end = l->session.effective.parameters.run.duration;
    lab_window(l, &from, &to);
    if (strcmp(argument, "all") == 0) {
        l->from = l->to = 0;
        return true;
    }
    double width = (to - from) * (strcmp(argument, "out") == 0 ? 2 : 0.5);
    if (width >= end) {
        l->from = l->to = 0;
        return true;
    }
    width = fmax(width, 1e-6);
    l->from = fmax(0, fmin(end - width, l->session.now - width / 2));
    l->to = l->from + width;
    return true;
}

// Shows or hides a pane by number, or makes one of signals by name.
static bool trace_pane(lab *l, const char *argument)
{
    if (isdigit((unsigned char)argument[0]) && argument[1] == '\0') {
        int index = (argument[0] - '0' + 9) % 10;
        lab_pane *pane = &l->panes[index];
        if (pane->count == 0) {
            lab_say(l, true, "pane %s is empty, :trace SIGNAL... fills it", argument);
            return false;
        }
        pane->shown = !pane->shown;
        return true;
    }
    lab_pane own = {.shown = true};
    char words[LAB_TEXT], *rest = words;
    snprintf(words, sizeof words, "%s", argument);
    for (char *word; (word = strtok_r(rest, " ,", &rest)) != NULL && own.count < PANE_SIGNALS;) {
        int signal = signal_find(word);
        if (signal < 0) {
            lab_say(l, true, "there is no signal '%s' (Tab completes)", word);
            return false;
        }
        own.signals[own.count++] = signal;
    }
    if (own.count == 0) {
        lab_say(l, true, "trace takes a number from 1 to 9 or names of signals");
        return false;
    }
    l->panes[LAB_PANES - 1] = own;
    return true;
}

// Shows the panes of these numbers and no others.
static bool show_panes(lab *l, const char *argument)
{
    if (argument[strspn(argument, "123456789")] != '\0') {
        lab_say(l, true, "panes takes numbers from 1 to 9, such as 134");
        return false;
    }
    for (int i = 0; i < LAB_PANES - 1; i++) {
        l->panes[i].shown = l->panes[i].count > 0 && strchr(argument, '1' + i) != NULL;
    }
    return true;
}

static bool remember(lab *l, const char *argument)
{
    (void)argument;
    return lab_settings_save(l);
}

static bool open_scenario_by(lab *l, const char *argument)
{
    int at = -1;
    for (int i = 0; i < l->name_count; i++) {
        at = strcmp(l->names[i], l->session.base.name) == 0 ? i : at;
    }
    l->filter[0] = '\0';
    if (argument[0] == '\0') {
        l->overlay = OVERLAY_OPEN;
        l->scroll = at < 0 ? 0 : at;
        return true;
    }
    bool next = strcmp(argument, "+1") == 0;
    if ((next || strcmp(argument, "-1") == 0) && l->name_count > 0) {
        at = (at + (next ? 1 : l->name_count - 1) + l->name_count) % l->name_count;
        return lab_open(l, l->names[at]);
    }
    return lab_open(l, argument);
}

static bool show_help(lab *l, const char *argument)
{
    (void)argument;
    l->overlay = l->overlay == OVERLAY_HELP ? OVERLAY_NONE : OVERLAY_HELP;
    l->scroll = 0;
    return true;
}

static bool compare(lab *l, const char *argument)
{
    (void)argument;
    l->overlay = l->overlay == OVERLAY_COMPARE ? OVERLAY_NONE : OVERLAY_COMPARE;
    return true;
}

// Takes one of the words into *value.
static bool take_choice(lab *l, const char *argument, const char *const *words, int count,
                        int *value)
{
    for (int i = 0; i < count; i++) {
        if (strcmp(argument, words[i]) == 0) {
            *value = i;
            l->redraw = true;
            return true;
        }
    }
    lab_say(l, true, "'%s' is none of %s, %s%s%s", argument, words[0], words[1],
            count > 2 ? ", " : "", count > 2 ? words[2] : "");
    return false;
}

static bool set_glyphs(lab *l, const char *argument)
{
    static const char *const words[] = {"braille", "blocks", "ascii"};
    int value = (int)l->glyphs;
    bool done = take_choice(l, argument, words, GLYPH_SETS, &value);
    l->glyphs = (glyph_set)value;
    return done;
}

static bool set_theme(lab *l, const char *argument)
{
    static const char *const words[] = {"dark", "light", "mono"};
    int value = (int)l->theme;
    bool done = take_choice(l, argument, words, COLOUR_THEMES, &value);
    l->theme = (lab_theme)value;
    return done;
}

static bool set_mouse(lab *l, const char *argument)
{
    static const char *const words[] = {"off", "on"};
    int value = l->mouse;
    bool done = take_choice(l, argument, words, 2, &value);
    l->mouse = value;
    if (done) {
        lab_say(l, false,
                value ? "clicks move the cursor" : "the mouse is off: the terminal selects");
    }
    return done;
}

static bool redraw(lab *l, const char *argument)
{
    (void)argument;
    l->redraw = true;
    return true;
}

static bool quit(lab *l, const char *argument)
{
    (void)argument;
    l->quit = true;
    return true;
}

// --- saving -----------------------------------------------------------------------------------

static bool ends_with(const char *text, const char *end)
{
    size_t length = strlen(text), tail = strlen(end);
    return length > tail && strcmp(text + length - tail, end) == 0;
}

static void write_screen(lab *l, FILE *stream)
{
    screen s = {0};
    if (screen_resize(&s, l->width, l->height)) {
        lab_draw(l, &s);
        screen_dump(&s, l->glyphs, stream);
    }
    screen_finish(&s);
}

// Saves what the file's ending asks for: a picture, the rows, a scenario or the screen.
static bool save(lab *l, const char *argument)
{
    const session *s = &l->session;
    fault f = {0};
    status code;
    if (argument[0] == '\0') {
        const char *slash = strrchr(s->base.name, '/');
        l->prompting = true;
        snprintf(l->prompt, sizeof l->prompt, "save %.200s.png", slash ? slash + 1 : s->base.name);
        lab_say(l, false,
                ".png .pdf .svg: the figure; .csv: the rows; .yaml: a scenario that "
                "gives this run; .txt: the screen");
        return true;
    }
    if (ends_with(argument, ".png") || ends_with(argument, ".pdf") || ends_with(argument, ".svg")) {
        code = plot_run(&s->effective, &s->run, argument, &f);
    } else if (!ends_with(argument, ".csv") && !ends_with(argument, ".yaml") &&
               !ends_with(argument, ".txt")) {
        code = fault_set(&f, STATUS_BAD_ARGUMENT,
                         "the file's name must end in .png, .pdf, .svg, .csv, .yaml or .txt");
    } else {
        whole_file file;
        code = whole_file_open(&file, argument, &f);
        if (code == STATUS_OK) {
            if (ends_with(argument, ".csv")) {
                export_csv(file.stream, &s->run.trace, s->effective.parameters.arm.links);
            } else if (ends_with(argument, ".yaml")) {
                session_write_scenario(s, file.stream);
            } else {
                write_screen(l, file.stream);
            }
            code = whole_file_commit(&file, &f);
        }
    }
    if (complain_about(l, code, &f)) {
        lab_say(l, false, "saved %s", argument);
    }
    return code == STATUS_OK;
}

// The arm in space at the cursor's instant.
static bool save_scene(lab *l, const char *argument)
{
    const session *s = &l->session;
    const scene_options options = {0};
    fault f = {0};
    if (argument[0] == '\0') {
        l->prompting = true;
        snprintf(l->prompt, sizeof l->prompt, "scene arm.png");
        return true;
    }
    status code = scene_write(&s->effective, &s->run, &options, &s->now, 1, argument, &f);
    if (complain_about(l, code, &f)) {
        lab_say(l, false, "saved %s", argument);
    }
    return code == STATUS_OK;
}

// --- the table --------------------------------------------------------------------------------

static const lab_action actions[] = {
    {"play", "", "run or pause", play},
    {"step", "[N]", "one row of the run on, or N (back if negative)", step},
    {"event", "[-1]", "to the next event, or the one before", step_event},
    {"seek", "TIME|end", "to an instant [s]", seek},
    {"speed", "up|down|X", "simulated seconds a second, 1 is real time", set_speed},
    {"restart", "", "play from the start", restart},
    {"set", "PATH VALUE", "another value, from now on or from the start", set},
    {"edit", "", "type a new value of the selected parameter", edit},
    {"nudge", "[-1]", "selected parameter a little up or down", nudge},
    {"select", "[-1]", "next or previous parameter", select_parameter},
    {"push", "[N s]", "an impulse at the tip, 0.01 N s", push},
    {"model", "", "corrected or printed equations", exchange_model},
    {"extend", "[S]", "a longer run", extend},
    {"branch", "", "keep this run and make another beside it", branch},
    {"forget", "", "drop the run kept for comparison", forget},
    {"compare", "", "both runs in numbers", compare},
    {"undo", "", "take the last change back", undo},
    {"redo", "", "put it in again", redo},
    {"mark", "", "second cursor: differences to it", set_mark},
    {"side", "", "parameters or values on the right", other_side},
    {"zoom", "in|out|all", "time axis round the cursor", zoom},
    {"trace", "1-9|SIGNAL...", "show or hide a pane of curves", trace_pane},
    {"open", "[NAME|+1|-1]", "another scenario, from a list", open_scenario_by},
    {"save", "FILE", ".png .pdf .svg .csv .yaml .txt", save},
    {"scene", "FILE.png", "picture of the arm at this instant", save_scene},
    {"glyphs", "braille|blocks|ascii", "characters to draw with", set_glyphs},
    {"theme", "dark|light|mono", "colours", set_theme},
    {"mouse", "on|off", "off lets the terminal select text", set_mouse},
    {"panes", "134", "these panes of curves and no others", show_panes},
    {"remember", "", "keep theme, glyphs, mouse, speed, panes", remember},
    {"redraw", "", "draw the whole screen anew", redraw},
    {"wait", "SECONDS", "in a script: let time pass", wait_for},
    {"help", "", "this page", show_help},
    {"quit", "", "leave the lab", quit},
};
enum { ACTIONS = sizeof actions / sizeof actions[0] };

static const lab_binding bindings[] = {
    {"Space", "play"},
    {"Right", "step 1"},
    {"l", "step 1"},
    {"Left", "step -1"},
    {"h", "step -1"},
    {"PgDn", "step 20"},
    {"PgUp", "step -20"},
    {"n", "event"},
    {"N", "event -1"},
    {"Home", "seek 0"},
    {"g", "seek 0"},
    {"End", "seek end"},
    {"G", "seek end"},
    {"+", "speed up"},
    {"=", "speed up"},
    {"-", "speed down"},
    {"Backspace", "restart"},
    {"r", "restart"},
    {"Down", "select"},
    {"j", "select"},
    {"Up", "select -1"},
    {"k", "select -1"},
    {"Enter", "edit"},
    {">", "nudge"},
    {"<", "nudge -1"},
    {"p", "push 0.01"},
    {"P", "push -0.01"},
    {"t", "model"},
    {"x", "extend"},
    {"b", "branch"},
    {"B", "forget"},
    {"c", "compare"},
    {"u", "undo"},
    {"U", "redo"},
    {"C-r", "redo"},
    {"m", "mark"},
    {"Tab", "side"},
    {"z", "zoom in"},
    {"Z", "zoom out"},
    {"0", "zoom all"},
    {"1", "trace 1"},
    {"2", "trace 2"},
    {"3", "trace 3"},
    {"4", "trace 4"},
    {"5", "trace 5"},
    {"6", "trace 6"},
    {"7", "trace 7"},
    {"8", "trace 8"},
    {"9", "trace 9"},
    {"o", "open"},
    {"]", "open +1"},
    {"[", "open -1"},
    {"s", "save"},
    {"S", "scene"},
    {"C-l", "redraw"},
    {"?", "help"},
    {"F1", "help"},
    {"q", "quit"},
    {"C-c", "quit"},
};
enum { BINDINGS = sizeof bindings / sizeof bindings[0] };

static const lab_action *find_action(const char *name)
{
    const lab_action *found = NULL;
    int matches = 0;
    for (int i = 0; i < ACTIONS; i++) {
        if (strcmp(actions[i].name, name) == 0) {
            return &actions[i];
        }
        if (strncmp(actions[i].name, name, strlen(name)) == 0) {
            found = &actions[i];
            matches++;
        }
    }
    // an unambiguous beginning will do
    return matches == 1 ? found : NULL;
}

bool lab_carry_out(lab *l, const char *line)
{
    char name[32], text[LAB_TEXT];
    line += strspn(line, " \t");
    if (*line == '\0' || *line == '#') {
        return true;
    }
    snprintf(text, sizeof text, "%s", line);
    for (size_t n = strlen(text); n > 0 && isspace((unsigned char)text[n - 1]); n--) {
        text[n - 1] = '\0';
    }
    size_t length = strcspn(text, " \t");
    snprintf(name, sizeof name, "%.*s", (int)length, text);
    const lab_action *found = find_action(name);
    if (found == NULL) {
        nearest_word near = nearest_begin(name);
        for (int i = 0; i < ACTIONS; i++) {
            nearest_try(&near, actions[i].name);
        }
        lab_say(l, true, "there is no command '%s'%s%s%s", name, near.best ? ", did you mean " : "",
                near.best ? near.best : "", near.best ? "?" : " (? lists them)");
        return false;
    }
    return found->act(l, text + length + strspn(text + length, " \t"));
}

const char *lab_help_line(int index)
{
    static char line[LAB_TEXT];
    if (index < 0 || index >= ACTIONS) {
        return NULL;
    }
    const lab_action *a = &actions[index];
    char keys[64] = "", call[64];
    size_t used = 0, length = strlen(a->name);
    for (int i = 0; i < BINDINGS && used < 24; i++) {
        const lab_binding *b = &bindings[i];
        bool ours = strncmp(b->line, a->name, length) == 0 && strchr(" ", b->line[length]) != NULL;
        if (ours) {
            used +=
                (size_t)snprintf(keys + used, sizeof keys - used, "%s%s", used ? " " : "", b->key);
        }
    }
    snprintf(call, sizeof call, ":%s %s", a->name, a->argument);
    snprintf(line, sizeof line, "%-27.27s %-30s %s", keys, call, a->help);
    return line;
}

// --- keys -------------------------------------------------------------------------------------

static const struct {
    const char *name;
    int key;
} key_names[] = {
    {"Space", ' '},
    {"Enter", KEY_CODE_ENTER},
    {"Esc", KEY_CODE_ESCAPE},
    {"Tab", KEY_CODE_TAB},
    {"Left", KEY_CODE_LEFT},
    {"Right", KEY_CODE_RIGHT},
    {"Up", KEY_CODE_UP},
    {"Down", KEY_CODE_DOWN},
    {"Home", KEY_CODE_HOME},
    {"End", KEY_CODE_END},
    {"PgUp", KEY_CODE_PAGE_UP},
    {"PgDn", KEY_CODE_PAGE_DOWN},
    {"Backspace", KEY_CODE_BACKSPACE},
    {"Delete", KEY_CODE_DELETE},
    {"F1", KEY_CODE_F1},
    {"lt", '<'},
};

// The key of a name, 0 if there is none.
static int key_of(const char *name, size_t length)
{
    for (size_t i = 0; i < sizeof key_names / sizeof key_names[0]; i++) {
        if (strlen(key_names[i].name) == length && strncmp(key_names[i].name, name, length) == 0) {
            return key_names[i].key;
        }
    }
    if (length == 3 && name[0] == 'C' && name[1] == '-') {
        return name[2] & 0x1f;
    }
    return length == 1 ? (unsigned char)name[0] : 0;
}

bool lab_keys(lab *l, const char *text, fault *f)
{
    while (*text != '\0' && !l->quit) {
        const char *close = *text == '<' ? strchr(text, '>') : NULL;
        if (close == NULL) {
            lab_key(l, (unsigned char)*text++);
            continue;
        }
        int key = key_of(text + 1, (size_t)(close - text - 1));
        if (key == 0) {
            fault_set(f, STATUS_BAD_ARGUMENT, "there is no key '%.*s'", (int)(close - text + 1),
                      text);
            return false;
        }
        lab_key(l, key);
        text = close + 1;
    }
    return true;
}

// Puts a character at a text's end or takes the last one off. False if the key does neither.
static bool type(char *text, int key)
{
    size_t length = strlen(text);
    if (key == KEY_CODE_BACKSPACE || key == 127 || key == 8) {
        while (length > 0 && (text[length - 1] & 0xc0) == 0x80) {
            length--;
        }
        text[length > 0 ? length - 1 : 0] = '\0';
        return true;
    }
    if (key == ('u' & 0x1f)) {
        text[0] = '\0';
        return true;
    }
    if (key < ' ' || key >= KEY_CODE_FIRST || length + 5 >= LAB_TEXT) {
        return false;
    }
    glyph_encode((uint32_t)key, text + length);
    return true;
}

// Candidates for the word that is being typed: the i-th, or NULL.
static const char *candidate(const lab *l, const char *command, int i)
{
    if (command == NULL) {
        return i < ACTIONS ? actions[i].name : NULL;
    }
    if (strcmp(command, "set") == 0) {
        return i < parameter_count ? parameter_table[i].path : NULL;
    }
    if (strcmp(command, "trace") == 0) {
        return i < signal_count ? signal_table[i].name : NULL;
    }
    if (strcmp(command, "open") == 0) {
        return i < l->name_count ? l->names[i] : NULL;
    }
    return NULL;
}

// Completes the prompt's last word as far as its candidates agree, and lists them.
static void complete(lab *l)
{
    char *space = strrchr(l->prompt, ' '), *word = space ? space + 1 : l->prompt;
    char command[32] = "", common[LAB_TEXT] = "", listed[512] = "";
    snprintf(command, sizeof command, "%.*s", (int)strcspn(l->prompt, " "), l->prompt);
    const char *name;
    size_t used = 0;
    int count = 0;
    for (int i = 0; (name = candidate(l, space ? command : NULL, i)) != NULL; i++) {
        if (strncmp(name, word, strlen(word)) != 0) {
            continue;
        }
        if (count++ == 0) {
            snprintf(common, sizeof common, "%s", name);
        }
        size_t same = 0;
        while (common[same] != '\0' && common[same] == name[same]) {
            same++;
        }
        common[same] = '\0';
        if (used < sizeof listed) {
            used += (size_t)snprintf(listed + used, sizeof listed - used, "%s ", name);
        }
    }
    if (count == 0) {
        return;
    }
    size_t room = sizeof l->prompt - (size_t)(word - l->prompt);
    snprintf(word, room, "%s%s", common, count == 1 ? " " : "");
    lab_say(l, false, "%s", count > 1 ? listed : "");
}

static void key_in_prompt(lab *l, int key)
{
    char line[LAB_TEXT];
    switch (key) {
    case KEY_CODE_ESCAPE:
    case 'c' & 0x1f:
        l->prompting = false;
        l->message[0] = '\0';
        break;
    case KEY_CODE_ENTER:
    case '\n':
        l->prompting = false;
        l->message[0] = '\0';
        snprintf(line, sizeof line, "%s", l->prompt);
        snprintf(l->history, sizeof l->history, "%s", line);
        lab_carry_out(l, line);
        break;
    case KEY_CODE_TAB:
        complete(l);
        break;
    case KEY_CODE_UP:
        snprintf(l->prompt, sizeof l->prompt, "%s", l->history);
        break;
    default:
        type(l->prompt, key);
    }
}

// The list's selected line moved on to one that the filter lets through.
static void move_in_list(lab *l, int direction)
{
    for (int i = l->scroll + direction; i >= 0 && i < l->name_count; i += direction) {
        if (lab_listed(l, l->names[i])) {
            l->scroll = i;
            return;
        }
    }
}

static void key_in_filter(lab *l, int key)
{
    if (key == KEY_CODE_ENTER || key == '\n' || key == KEY_CODE_ESCAPE) {
        l->filtering = false;
    } else {
        type(l->filter, key);
    }
    if (l->scroll < l->name_count && !lab_listed(l, l->names[l->scroll])) {
        l->scroll = -1;
        move_in_list(l, 1);
        l->scroll = l->scroll < 0 ? 0 : l->scroll;
    }
}

static void key_in_list(lab *l, int key)
{
    if (l->filtering) {
        key_in_filter(l, key);
    } else if (key == '/') {
        l->filtering = true;
        l->filter[0] = '\0';
    } else if (key == KEY_CODE_UP || key == 'k') {
        move_in_list(l, -1);
    } else if (key == KEY_CODE_DOWN || key == 'j') {
        move_in_list(l, 1);
    } else if (key == KEY_CODE_PAGE_UP || key == KEY_CODE_PAGE_DOWN) {
        for (int i = 0; i < 10; i++) {
            move_in_list(l, key == KEY_CODE_PAGE_UP ? -1 : 1);
        }
    } else if (key == KEY_CODE_ENTER || key == '\n') {
        l->overlay = OVERLAY_NONE;
        if (l->scroll < l->name_count && lab_listed(l, l->names[l->scroll])) {
            lab_open(l, l->names[l->scroll]);
        }
    } else if (key == KEY_CODE_ESCAPE || key == 'q' || key == 'o') {
        l->overlay = OVERLAY_NONE;
    }
}

// In help and comparison: scrolling and leaving.
static void key_in_page(lab *l, int key)
{
    if (key == KEY_CODE_DOWN || key == 'j' || key == KEY_CODE_PAGE_DOWN) {
        l->scroll += l->scroll + 1 < ACTIONS;
    } else if (key == KEY_CODE_UP || key == 'k' || key == KEY_CODE_PAGE_UP) {
        l->scroll -= l->scroll > 0;
    } else if (key == KEY_CODE_END || key == 'G') {
        l->scroll = ACTIONS;
    } else if (key == KEY_CODE_HOME || key == 'g') {
        l->scroll = 0;
    } else {
        l->overlay = OVERLAY_NONE;
    }
}

static void key_by_table(lab *l, int key)
{
    key = key == '\n' ? KEY_CODE_ENTER : key == 127 || key == 8 ? KEY_CODE_BACKSPACE : key;
    for (int i = 0; i < BINDINGS; i++) {
        if (key_of(bindings[i].key, strlen(bindings[i].key)) == key) {
            l->message[0] = '\0';
            lab_carry_out(l, bindings[i].line);
            return;
        }
    }
    if (key == KEY_CODE_ESCAPE) {
        l->message[0] = '\0';
        l->has_mark = false;
    } else if (key > ' ' && key < 127) {
        lab_say(l, true, "'%c' does nothing here, ? lists the keys", key);
    }
}

void lab_key(lab *l, int key)
{
    if (l->prompting) {
        key_in_prompt(l, key);
    } else if (key == ':') {
        l->prompting = true;
        l->prompt[0] = '\0';
        l->message[0] = '\0';
    } else if (l->overlay == OVERLAY_OPEN) {
        key_in_list(l, key);
    } else if (l->overlay != OVERLAY_NONE && key != ('c' & 0x1f)) {
        key_in_page(l, key);
    } else if (key == '/') {
        lab_carry_out(l, "open");
        l->filtering = true;
    } else {
        key_by_table(l, key);
    }
}
