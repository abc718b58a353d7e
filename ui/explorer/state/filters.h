// What the lists of the explorer are filtered by: a line of words for each panel.
#pragma once

#include <stdbool.h>

#include "ui/explorer/state/panel_list.h"

enum { FILTER_TEXT = 256 }; // as LINE_TEXT, which text_type fills

typedef struct filters {
    panel_id typing; // keys go to this panel's filter; PANEL_NONE for none
    char text[PANEL_IDS][FILTER_TEXT];
} filters;

// Whether a filter lets a text through: every word of it is part of the text, in any case of
// letters. An empty filter lets everything through.
bool filter_passes(const char *filter, const char *text);
