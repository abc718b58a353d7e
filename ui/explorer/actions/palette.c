// Actions on the palette.
#include "ui/explorer/actions/actions.h"

#include <assert.h>

action_result act_open_palette(explorer_state *st, const char *argument)
{
    scenario_menu_read_titles(&st->scenarios);
    prompt_open(&st->prompt, "%s", argument);
    st->prompt.searches = true;
    st->palette = (palette_view){0};
    return result_quiet();
}

void act_move_in_palette(explorer_state *st, int direction)
{
    assert(st != NULL && (direction == 1 || direction == -1));
    static palette_entry entries[PALETTE_ENTRIES];
    const int count = palette_find(&st->scenarios, &st->keys, st->prompt.text, entries);
    const int least = st->prompt.searches ? 0 : -1;
    int at = st->palette.selected + direction;
    at = at >= count ? count - 1 : at;
    st->palette.selected = at < least ? least : at;
}

bool act_line_of_palette(const explorer_state *st, char line[LINE_TEXT], bool *goes_on)
{
    assert(st != NULL && line != NULL && goes_on != NULL);
    static palette_entry entries[PALETTE_ENTRIES];
    const int count = palette_find(&st->scenarios, &st->keys, st->prompt.text, entries);
    const int at = st->palette.selected;
    if (at < 0 || at >= count) {
        return false;
    }
    palette_line(&st->scenarios, entries[at], line, LINE_TEXT, goes_on);
    return true;
}
