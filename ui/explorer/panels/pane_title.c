#include "ui/explorer/panels/pane_title.h"

#include <math.h>
#include <string.h>

#include "src/rig/controller.h"
#include "ui/terminal/ink_colours.h"

// Whether a slot's colour is that of one of the first curves of a pane, as the terminal shows them.
static bool colour_is_taken(const explorer_state *st, const pane_look *look, int curves, int slot)
{
    const ink wanted = (ink)(INK_SERIES_0 + slot);
    for (int k = 0; k < curves; k++) {
        if (inks_look_alike(st->looks.theme, st->looks.shown_depth, look->colour[k], wanted)) {
            return true;
        }
    }
    return false;
}

pane_look pane_look_of(const explorer_state *st, const pane *p)
{
    enum { COLOURS = 8, STYLES = 4 };
    static const line_style plain_first[] = {LINE_SOLID, LINE_DASHED, LINE_DOTTED, LINE_DASH_DOT};
    bool style_taken[STYLES] = {false};
    pane_look look;

    // the table's colour and line unless an earlier signal of the pane has them
    for (int k = 0; k < p->count; k++) {
        const signal_info *info = &signal_table[p->signals[k]];
        int slot = info->colour, style = (int)info->style;
        for (int i = 0; i < COLOURS && colour_is_taken(st, &look, k, slot); i++) {
            slot = (info->colour + 1 + i) % COLOURS;
        }
        for (int i = 0; i < STYLES && style_taken[style]; i++) {
            style = (int)plain_first[i];
        }
        style_taken[style] = true;
        look.colour[k] = (ink)(INK_SERIES_0 + slot);
        look.style[k] = (line_style)style;
    }
    return look;
}

// How a legend says what its curves are, most words first.
typedef enum legend { LEGEND_NAMES, LEGEND_SYMBOLS, LEGEND_TIGHT, LEGEND_BARE } legend;

// A curve's line in one character.
static uint32_t line_glyph(line_style style)
{
    static const uint32_t glyphs[] = {0x2500, 0x254c, 0x2508, 0x2574};
    return glyphs[style];
}

// What a legend says of a signal's value: a mode by its name where the law is one of ours, else a
// number; short ones have up to three digits.
static void format_value(const explorer_state *st, int signal, bool briefly, char *text,
                         size_t size)
{
    const trace *t = state_run(st, 0).trace;
    double value = signal_value(&t->rows[trace_row_at(t, st->session.now)], signal);
    const controller *law = controller_of(st->session.effective.parameters.control.law);
    bool is_mode = strcmp(signal_table[signal].name, "controller_mode") == 0;

    // fewer digits where room is short
    draw_number(text, size, value);
    if (briefly && fabs(value) > 1e-12) {
        for (int digits = 3, length = 9; digits > 1 && length > 6; digits--) {
            length = snprintf(text, size, "%.*g", digits, value);
        }
    }

    // a mode by its name
    for (int i = 0; is_mode && law != NULL && law->modes != NULL && law->modes[i] != NULL; i++) {
        if (value == i) {
            snprintf(text, size, "%s", law->modes[i]);
        }
    }
}

// The unit of all signals of a pane, "" if they have several.
static const char *unit_of(const pane *p)
{
    const char *unit = signal_table[p->signals[0]].unit;
    for (int k = 1; k < p->count; k++) {
        unit = strcmp(signal_table[p->signals[k]].unit, unit) == 0 ? unit : "";
    }
    return unit;
}

// Writes a legend and returns the cells it takes; values are padded so that it stands still.
static int draw_legend(const explorer_state *st, screen *s, const pane *p, legend how, int x, int y,
                       int room)
{
    int start = x, end = x + room;
    const pane_look look = pane_look_of(st, p);

    // each signal: its line, its name, its value at the cursor
    for (int k = 0; k < p->count; k++) {
        const signal_info *info = &signal_table[p->signals[k]];
        char value[48], text[128];
        format_value(st, p->signals[k], how == LEGEND_TIGHT, value, sizeof value);
        if (unit_of(p)[0] == '\0' && info->unit[0] != '\0' && how < LEGEND_TIGHT) {
            size_t used = strlen(value);
            snprintf(value + used, sizeof value - used, " %s", info->unit);
        }
        int width = how == LEGEND_TIGHT ? 6 : how == LEGEND_BARE ? 0 : 8;
        int length =
            snprintf(text, sizeof text, "%s %-*s", how == LEGEND_NAMES ? info->name : info->ascii,
                     width, how == LEGEND_BARE ? "" : value);
        if (room > 0) {
            screen_put(s, x, y, x < end ? line_glyph(look.style[k]) : ' ', look.colour[k]);
            screen_text(s, x + 2, y, end - x - 2, look.colour[k], text);
        }
        x += 2 + length + 1;
    }
    return x - start - 1;
}

void draw_pane_title(const explorer_state *st, screen *s, int index, area a)
{
    const pane *p = &st->panes.pane[index];
    static const char *const axes[] = {"", "grows", "fixed"};
    const bool difference = state_run(st, 0).kind == SHOWN_DIFFERENCE && pane_has_amounts(p);
    bool focused = index == panes_focused(&st->panes);
    int x = a.x + LABEL_WIDTH + 1, room = a.width - LABEL_WIDTH - 1;

    // number, unit, and what the axis does
    screen_print(s, a.x, a.y, 2, focused ? INK_TITLE : INK_DIM, "%s%d", focused ? "\u25b8" : " ",
                 (index + 1) % 10);
    screen_print(s, a.x + 2, a.y, LABEL_WIDTH - 2, INK_DIM, "%*s", LABEL_WIDTH - 2, unit_of(p));
    if (p->scaling != AXIS_AUTO && room > 30) {
        room -= 6;
        screen_text(s, x + room + 1, a.y, 5, INK_DIM, axes[p->scaling]);
    }
    if (difference && room > 40) {
        room -= 15;
        screen_text(s, x + room + 1, a.y, 14, INK_EVENT, "minus baseline");
    }

    // what is not over time has no values at the cursor
    if (p->view == VIEW_PHASE) {
        screen_print(s, x, a.y, room, INK_SERIES_0, "%s over %s", signal_table[p->signals[0]].name,
                     signal_table[p->signals[1]].name);
        return;
    }
    if (p->view == VIEW_SPECTRUM) {
        screen_print(s, x, a.y, room, INK_SERIES_0, "amplitudes of %s",
                     signal_table[p->signals[0]].name);
        return;
    }

    // as many words as fit
    legend how = LEGEND_NAMES;
    while (how < LEGEND_BARE && draw_legend(st, s, p, how, x, a.y, 0) > room) {
        how++;
    }
    draw_legend(st, s, p, how, x, a.y, room);
}
