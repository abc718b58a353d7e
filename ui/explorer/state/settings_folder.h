// The folder of the explorer's settings and history.
#pragma once

#include <stdbool.h>
#include <stddef.h>

// The folder's path ($XDG_CONFIG_HOME/impactlab or ~/.config/impactlab), created if `make`. False
// if there is none or the path is too long.
bool settings_folder(char *path, size_t size, bool make);
