// Filters of the explorer's lists: a line of words for each panel.
#pragma once

#include <stdbool.h>

#include "ui/explorer/state/panel_list.h"

enum { FILTER_TEXT = 256 }; // as LINE_TEXT, which text_type needs

typedef struct filters {
    panel_id typing; // keys go to this panel's filter; PANEL_NONE for none
    char text[PANEL_IDS][FILTER_TEXT];
} filters;

// Whether a text passes a filter: every word of the filter is part of the text, whatever the case
// of letters. Every text passes an empty filter.
bool filter_passes(const char *filter, const char *text);
