// Actions on what is seen: panes, zoom, marks, overlays, looks.
#include "ui/explorer/actions.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

bool act_select_parameter(lab *l, const char *argument)
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

bool act_set_mark(lab *l, const char *argument)
{
    (void)argument;
    l->has_mark = !l->has_mark;
    l->mark = l->session.now;
    lab_say(l, false, l->has_mark ? "mark set: values now show the difference to it" : "no mark");
    return true;
}

bool act_other_side(lab *l, const char *argument)
{
    (void)argument;
    bool narrow = l->width > 0 && l->width < SIDE_WIDTH;
    if (narrow && (!l->side_in_front || l->side + 1 == SIDES)) {
        // curves, each side, curves again
        l->side_in_front = !l->side_in_front;
        l->side = 0;
    } else {
        l->side = (l->side + 1) % SIDES;
    }
    return true;
}

// Shows or hides a pane by number, or makes one of signals by name.
bool act_trace_pane(lab *l, const char *argument)
{
    if (isdigit((unsigned char)argument[0]) && argument[1] == '\0') {
        int index = (argument[0] - '0' + 9) % 10;
        lab_pane *pane = &l->panes[index];
        if (pane->count == 0) {
            lab_say(l, true, "pane %s is empty, :trace SIGNAL... fills it", argument);
            return false;
        }
        pane->shown = !pane->shown;
        l->panes_chosen = true;
        l->focus = pane->shown ? index : l->focus;
        return true;
    }
    lab_pane own = {.shown = true, .grown_low = (double)INFINITY, .grown_high = (double)-INFINITY};
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
    l->focus = LAB_PANES - 1;
    return true;
}

// Shows the panes of these numbers and no others.
bool act_show_panes(lab *l, const char *argument)
{
    if (argument[strspn(argument, "123456789")] != '\0') {
        lab_say(l, true, "panes takes numbers from 1 to 9, such as 134");
        return false;
    }
    for (int i = 0; i < LAB_PANES - 1; i++) {
        l->panes[i].shown = l->panes[i].count > 0 && strchr(argument, '1' + i) != NULL;
    }
    l->panes_chosen = true;
    return true;
}

bool act_show_help(lab *l, const char *argument)
{
    (void)argument;
    l->overlay = l->overlay == OVERLAY_HELP ? OVERLAY_NONE : OVERLAY_HELP;
    l->scroll = 0;
    return true;
}

bool act_compare(lab *l, const char *argument)
{
    (void)argument;
    l->overlay = l->overlay == OVERLAY_COMPARE ? OVERLAY_NONE : OVERLAY_COMPARE;
    l->scroll = 0;
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
    char all[128] = "";
    for (int i = 0; i < count; i++) {
        size_t used = strlen(all);
        snprintf(all + used, sizeof all - used, "%s%s", i > 0 ? ", " : "", words[i]);
    }
    lab_say(l, true, "'%s' is none of %s", argument, all);
    return false;
}

bool act_set_glyphs(lab *l, const char *argument)
{
    static const char *const words[] = {"braille", "blocks", "ascii"};
    int value = (int)l->glyphs;
    bool done = take_choice(l, argument, words, GLYPH_SETS, &value);
    l->glyphs = (glyph_set)value;
    return done;
}

bool act_set_theme(lab *l, const char *argument)
{
    static const char *const words[] = {"dark", "light", "mono"};
    int value = (int)l->theme;
    bool done = take_choice(l, argument, words, COLOUR_THEMES, &value);
    l->theme = (colour_theme)value;
    return done;
}

bool act_set_colours(lab *l, const char *argument)
{
    static const char *const words[] = {"auto", "true", "256", "16", "mono"};
    int value = (int)l->depth;
    bool done = take_choice(l, argument, words, COLOUR_DEPTHS, &value);
    l->depth = (colour_depth)value;
    return done;
}

bool act_set_mouse(lab *l, const char *argument)
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

bool act_redraw(lab *l, const char *argument)
{
    (void)argument;
    l->redraw = true;
    return true;
}

bool act_quit(lab *l, const char *argument)
{
    (void)argument;
    l->quit = true;
    return true;
}
