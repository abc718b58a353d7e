// The commands of the terminal lab: one table for `:`, scripts, keys and the help.
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/words.h"
#include "ui/lab/actions.h"

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
    {"seek", "TIME|end", "to an instant [s]", act_seek},
    {"speed", "up|down|X", "simulated seconds a second, 1 is real time", act_set_speed},
    {"restart", "", "play from the start", act_restart},
    {"set", "PATH VALUE", "another value, from now on or from the start", act_set},
    {"edit", "", "type a new value of the selected parameter", act_edit},
    {"nudge", "[-1]", "selected parameter a little up or down", act_nudge},
    {"select", "[-1]", "next or previous parameter", act_select_parameter},
    {"push", "[N s]", "an impulse at the tip, 0.01 N s", act_push},
    {"model", "", "corrected or printed equations", act_exchange_model},
    {"extend", "[S]", "a longer run", act_extend},
    {"branch", "", "keep this run and make another beside it", act_branch},
    {"forget", "", "drop the run kept for comparison", act_forget},
    {"compare", "", "both runs in numbers", act_compare},
    {"undo", "", "take the last change back", act_undo},
    {"redo", "", "put it in again", act_redo},
    {"mark", "", "second cursor: differences to it", act_set_mark},
    {"side", "", "parameters or values on the right", act_other_side},
    {"zoom", "in|out|all", "time axis round the cursor", act_zoom},
    {"trace", "1-9|SIGNAL...", "show or hide a pane of curves", act_trace_pane},
    {"open", "[NAME|+1|-1]", "another scenario, from a list", act_open_scenario_by},
    {"save", "FILE", ".png .pdf .svg .csv .yaml .txt", act_save},
    {"scene", "FILE.png", "picture of the arm at this instant", act_save_scene},
    {"glyphs", "braille|blocks|ascii", "characters to draw with", act_set_glyphs},
    {"theme", "dark|light|mono", "colours", act_set_theme},
    {"mouse", "on|off", "off lets the terminal select text", act_set_mouse},
    {"panes", "134", "these panes of curves and no others", act_show_panes},
    {"remember", "", "keep theme, glyphs, mouse, speed, panes", act_remember},
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

const char *lab_command_name(int index)
{
    return index >= 0 && index < ACTIONS ? actions[index].name : NULL;
}

const char *lab_help_line(int index)
{
    static char line[LAB_TEXT];
    if (index < 0 || index >= ACTIONS) {
        return NULL;
    }
    const lab_action *a = &actions[index];
    char keys[64], call[64];
    lab_keys_of(a->name, keys, sizeof keys);
    snprintf(call, sizeof call, ":%s %s", a->name, a->argument);
    snprintf(line, sizeof line, "%-27.27s %-30s %s", keys, call, a->help);
    return line;
}
