// A panel: a part of the screen that draws a part of the state and handles the mouse, and keys if
// it is a page. Each has a file of its own; panel_list.h lists them all.
#pragma once

#include "ui/explorer/actions/actions.h"
#include "ui/explorer/panels/layout.h"
#include "ui/terminal/keys.h"
#include "ui/terminal/screen.h"

enum { WHEEL_LINES = 3 }; // scrolled by one step of the wheel

// A gesture of the mouse on a part of a panel.
typedef struct panel_gesture {
    pointer_event event;
    hit_area hit;   // the part that was pressed, or under the wheel
    int across, up; // a drag: cells since the last event
    bool dragged;   // it has moved since it was pressed
} panel_gesture;

// Which way the wheel turns: -1 up, 1 down.
int pointer_wheel(pointer_event e);

typedef struct panel {
    const char *name;
    int least_width; // of the screen on which it is shown [cells]
    int least_body;  // rows between title and status that it needs to be shown [cells]

    // The number of rows in a stack in `body`, 0 if it has nothing to show. Stacked panels only.
    int (*rows)(const explorer_state *st, screen_size body);

    // Draws it into an area of the screen; pages are centred in the area of all panels.
    void (*draw)(const explorer_state *st, layout *lay, screen *s, area a);

    // Handles the mouse; false if the gesture does nothing. May be NULL.
    bool (*point)(explorer_state *st, const panel_gesture *g, action_result *result);

    // Handles a key while the page is open. Pages only.
    action_result (*key)(explorer_state *st, int key);
} panel;

#define PANEL_DECLARATION(id, place, description) extern const panel description;
PANEL_LIST(PANEL_DECLARATION)
#undef PANEL_DECLARATION

// The description of a panel; not for PANEL_NONE.
const panel *panel_of(panel_id id);

// Whether a panel has room on a screen whose panels have the area `body`.
bool panel_fits(const panel *p, screen_size body);
