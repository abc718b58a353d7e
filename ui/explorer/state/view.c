#include "ui/explorer/state/view.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

// --- panels ----------------------------------------------------------------------------

static const panel_place places[PANEL_IDS] = {
#define PANEL_PLACE(id, place, description) [id] = place,
    PANEL_LIST(PANEL_PLACE)
#undef PANEL_PLACE
};

panel_place panel_place_of(panel_id id)
{
    assert(id > PANEL_NONE && id < PANEL_IDS);
    return places[id];
}

// --- filters ---------------------------------------------------------------------------

bool filter_passes(const char *filter, const char *text)
{
    while (*filter != '\0') {
        char word[LINE_TEXT];
        filter = text_cut(filter, " ", word, sizeof word);
        if (strcasestr(text, word) == NULL) {
            return false;
        }
    }
    return true;
}

// --- looks -----------------------------------------------------------------------------

#define LOOK(command, field) command, offsetof(looks, field)
const look_choice look_choices[] = {
    {LOOK("theme", theme), {"dark", "light", "mono"}, {NULL}},
    {LOOK("glyphs", glyphs), {"braille", "blocks", "ascii"}, {NULL}},
    {LOOK("pixels", pixels),
     {"off", "auto"},
     {"characters only", "pictures where the terminal says that it draws them"}},
    {LOOK("mouse", mouse),
     {"off", "on"},
     {"the mouse is off: the terminal selects", "clicks move the cursor"}},
    {NULL},
};

const look_choice *look_choice_of(const char *command)
{
    const look_choice *c = look_choices;
    while (strcmp(c->command, command) != 0) {
        c++;
    }
    return c;
}

int *look_value(looks *l, const look_choice *c)
{
    return (int *)((char *)l + c->place);
}

const char *look_word(const looks *l, const look_choice *c)
{
    looks copy = *l;
    return c->words[*look_value(&copy, c)];
}
