// Where the explorer keeps what it remembers between visits.
#pragma once

#include <stdbool.h>
#include <stddef.h>

// The folder's path ($XDG_CONFIG_HOME/impactlab or ~/.config/impactlab), made if `make`. False if
// there is none, or no room for it.
bool settings_folder(char *path, size_t size, bool make);
