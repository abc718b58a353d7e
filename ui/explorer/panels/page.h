// Keys and mouse in pages that are scrolled line by line.
#pragma once

#include "ui/explorer/panels/panel.h"

// Scrolls the page that is open; any other key closes it.
action_result page_key(explorer_state *st, int key);

// The wheel presses a page's keys for up and down.
bool page_point(explorer_state *st, const panel_gesture *g, action_result *result);
