// A panel: a part of the screen that draws something of the state and takes the mouse, and where it
// is a page, keys. Each stands in a file of its own; panel_list.h has them all.
#pragma once

#include "ui/explorer/actions/actions.h"
#include "ui/explorer/panels/layout.h"
#include "ui/terminal/pointer.h"
#include "ui/terminal/screen.h"

enum { WHEEL_LINES = 3 }; // that a turn of the wheel scrolls

// What the mouse does with a part of a panel.
typedef struct panel_gesture {
    pointer_event event;
    hit_area hit;   // the part: that was pressed, or that the wheel turns on
    int across, up; // a drag: cells since the last event
    bool dragged;   // it has moved since it was pressed
} panel_gesture;

// Which way the wheel turns: -1 up, 1 down.
int pointer_wheel(pointer_event e);

typedef struct panel {
    const char *name;
    int least_width; // of the screen on which it is shown [cells]
    int least_body;  // rows between title and status from which on it is shown [cells]

    // Rows that it takes of a stack in `body`, 0 if it has nothing to show. Stacked panels only.
    int (*rows)(const explorer_state *st, screen_size body);

    // Draws it into an area of the screen; pages take the middle of what all panels have.
    void (*draw)(const explorer_state *st, layout *lay, screen *s, area a);

    // Takes the mouse; false if it has no use for the gesture. May be NULL.
    bool (*point)(explorer_state *st, const panel_gesture *g, action_result *result);

    // Takes a key while the page is open. Pages only.
    action_result (*key)(explorer_state *st, int key);
} panel;

#define PANEL_DECLARATION(id, place, description) extern const panel description;
PANEL_LIST(PANEL_DECLARATION)
#undef PANEL_DECLARATION

// The description of a panel; not for PANEL_NONE.
const panel *panel_of(panel_id id);

// Whether a screen whose panels have `body` has room for a panel.
bool panel_fits(const panel *p, screen_size body);
