// The user's files: the folder of the explorer's settings, and which programs may be run.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/base/fault.h"
#include "src/scenario/scenario.h"

// The user's folders, which are impactlab in $XDG_CONFIG_HOME or ~/.config, and in
// $XDG_STATE_HOME or ~/.local/state.
typedef enum user_folder { USER_SETTINGS, USER_STATE } user_folder;

// The path of a file (a short name) in one of them, which is created for its user alone
// if `make`. False if there is none or the path is too long.
bool user_file(user_folder folder, const char *name, char *path, size_t size, bool make);

// --- consent ---------------------------------------------------------------------------
// The user's consent to a scenario's program or plug-in, remembered for the content of
// both.
//
// The settings folder's file `allowed` has a line for each: a digest (SHA-256) of the
// scenario's text and of the program, and the names they had. If either changes, the
// digest differs and the user is asked again. What cannot be identified by its content is
// allowed for one session only: a command with characters that are special to a shell, a
// plug-in without a path.

// Whether the scenario as it was opened would run a program or plug-in that is not
// allowed.
bool consent_needed(const scenario *s);

// Whether the user has allowed exactly this scenario with this program or plug-in before.
bool consent_remembered(const scenario *s);

// Stores the consent. *kept: false if it cannot be identified by its content or there is
// no folder for settings. On failure the reason is in f.
status consent_remember(const scenario *s, bool *kept, fault *f);
