// What keys do: in the prompt, in a page, and by the table of keys.
#pragma once

#include "ui/explorer/explorer.h"

// A key was pressed.
void explorer_key(explorer *ex, int key);

// Carries out the entry of the palette that the mouse has chosen, if it has.
void explorer_take_picked(explorer *ex);

// Presses the keys of a text: characters, and names in angle brackets ("<Space>", "<Right>",
// "<C-l>"). False, with what is wrong in f, at a name that is none.
bool explorer_keys(explorer *ex, const char *text, fault *f);
