// The commands of the terminal lab: one table for `:`, scripts, keys and the help.
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/words.h"
#include "ui/explorer/actions.h"

typedef struct lab_action {
    const char *name;
    const char *argument; // as the help shows it
    const char *help;
    bool (*act)(lab *l, const char *argument);
} lab_action;

bool lab_complain(lab *l, status code, const fault *f)
{
    if (code != STATUS_OK) {
        lab_say(l, true, "%s", f->text[0] ? f->text : status_text(code));
    }
    return code == STATUS_OK;
}

bool lab_take_number(lab *l, const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(*value)) {
        lab_say(l, true, "'%s' is no number", text);
        return false;
    }
    return true;
}

static const lab_action actions[] = {
    {"play", "", "run or pause", act_play},
    {"step", "[N]", "one row of the run on, or N (back if negative)", act_step},
    {"event", "[-1]", "to the next event, or the one before", act_step_event},
    {"touch", "[-1]", "just before the arm touches next, or did last", act_step_touch},
    {"seek", "TIME|end", "to an instant [s]", act_seek},
    {"speed", "up|down|X", "simulated seconds a second, 1 is real time", act_set_speed},
    {"restart", "", "play from the start", act_restart},
    {"set", "PATH VALUE", "another value, from now on or from the start", act_set},
    {"edit", "", "type a new value of the selected parameter", act_edit},
    {"nudge", "[-1]", "selected parameter a little up or down", act_nudge},
    {"select", "[-1]", "next or previous parameter", act_select_parameter},
    {"push", "[N s]", "an impulse at the tip, 0.01 N s", act_push},
    {"law", "[NAME|off]", "another control law; alone: off or on again", act_law},
    {"lock", "MODE|next|off", "hold the law in a mode, or let it choose", act_lock},
    {"model", "", "corrected or printed equations", act_exchange_model},
    {"extend", "[S]", "a longer run", act_extend},
    {"branch", "", "keep this run and make another beside it", act_branch},
    {"forget", "", "drop the run kept for comparison", act_forget},
    {"stop", "", "compute no further; Space at its end goes on", act_stop},
    {"compare", "", "both runs in numbers", act_compare},
    {"undo", "", "take the last change back", act_undo},
    {"redo", "", "put it in again", act_redo},
    {"mark", "", "second cursor: differences to it", act_set_mark},
    {"side", "", "parameters or values on the right", act_other_side},
    {"zoom", "in|out|all|FROM TO", "time axis round the cursor", act_zoom},
    {"pan", "left|right|SECONDS", "time axis along the run", act_pan},
    {"follow", "", "curves follow the cursor (panning ends it)", act_follow},
    {"focus", "", "next pane, for the keys of axes", act_focus},
    {"alone", "", "that pane as large as all, or all again", act_alone},
    {"axis", "auto|grow|LOW HIGH [PANE]", "range: what is visible, was seen, or yours", act_axis},
    {"trace", "1-9|SIGNAL...", "show or hide a pane of curves", act_trace_pane},
    {"open", "[NAME|+1|-1]", "another scenario, from a list", act_open_scenario_by},
    {"find", "[TEXT]", "the list, filtered by what is typed", act_find_scenario},
    {"save", "FILE", ".png .pdf .svg .csv .yaml .txt", act_save},
    {"scene", "FILE.png", "picture of the arm at this instant", act_save_scene},
    {"glyphs", "braille|blocks|ascii", "characters to draw with", act_set_glyphs},
    {"theme", "dark|light|mono", "colours for that ground", act_set_theme},
    {"colours", "auto|true|256|16|mono", "how many the terminal has", act_set_colours},
    {"mouse", "on|off", "off lets the terminal select text", act_set_mouse},
    {"panes", "134", "these panes of curves and no others", act_show_panes},
    {"key", "KEY COMMAND", "a key of your own, such as :key x step 5", act_bind_key},
    {"unkey", "KEY", "take it back; one of the lab's does nothing then", act_unbind_key},
    {"remember", "", "keep looks, speed, panes, axes and keys", act_remember},
    {"redraw", "", "draw the whole screen anew", act_redraw},
    {"wait", "SECONDS", "in a script: let time pass", act_wait_for},
    {"help", "", "this page", act_show_help},
    {"quit", "", "leave the lab", act_quit},
};
enum { ACTIONS = sizeof actions / sizeof actions[0] };

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

// The command of a line's first word, NULL with a complaint if there is none.
static const lab_action *take_action(lab *l, const char *line, size_t length)
{
    char name[32];
    snprintf(name, sizeof name, "%.*s", (int)length, line);
    const lab_action *found = find_action(name);
    if (found == NULL) {
        nearest_word near = nearest_begin(name);
        for (int i = 0; i < ACTIONS; i++) {
            nearest_try(&near, actions[i].name);
        }
        lab_say(l, true, "there is no command '%s'%s%s%s", name, near.best ? ", did you mean " : "",
                near.best ? near.best : "", near.best ? "?" : " (? lists them)");
    }
    return found;
}

bool lab_is_command(lab *l, const char *line)
{
    return take_action(l, line, strcspn(line, " \t")) != NULL;
}

bool lab_carry_out(lab *l, const char *line)
{
    char text[LAB_TEXT];
    l->fault_at = (int)strspn(line, " \t");
    line += l->fault_at;
    if (*line == '\0' || *line == '#') {
        return true;
    }
    snprintf(text, sizeof text, "%s", line);
    for (size_t n = strlen(text); n > 0 && isspace((unsigned char)text[n - 1]); n--) {
        text[n - 1] = '\0';
    }
    size_t length = strcspn(text, " \t");
    const lab_action *found = take_action(l, text, length);
    if (found == NULL) {
        return false;
    }
    length += strspn(text + length, " \t");
    l->fault_at += (int)length;
    return found->act(l, text + length);
}

const char *lab_command_name(int index)
{
    return index >= 0 && index < ACTIONS ? actions[index].name : NULL;
}

const char *lab_command_help(int index, const char **argument, const char **help)
{
    if (index < 0 || index >= ACTIONS) {
        return NULL;
    }
    *argument = actions[index].argument;
    *help = actions[index].help;
    return actions[index].name;
}
