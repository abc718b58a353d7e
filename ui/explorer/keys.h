// The actions of keys: in the prompt, in a page, and by the table of keys.
#pragma once

#include "ui/explorer/explorer.h"

// A key was pressed.
void explorer_key(explorer *ex, int key);

// Executes the entry of the palette that was chosen with the mouse, if any.
void explorer_take_picked(explorer *ex);

// Presses the keys of a text: characters, and names in angle brackets ("<Space>", "<Right>",
// "<C-l>"). False, with the reason in f, at an unknown name.
bool explorer_keys(explorer *ex, const char *text, fault *f);
