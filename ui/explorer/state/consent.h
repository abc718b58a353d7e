// The user's consent to a scenario's program or plug-in, remembered for the content of both.
//
// The settings folder's file `allowed` has a line for each: a digest (SHA-256) of the scenario's
// text and of the program, and the names they had. Where either changes, the digest is another one,
// and the user is asked again. What cannot be told by its content is allowed for one visit only: a
// command that a shell would take for more than words, a plug-in without a path.
#pragma once

#include "src/base/fault.h"
#include "src/scenario/scenario.h"

// Whether the scenario as it was opened would run a program or plug-in that is not allowed.
bool consent_needed(const scenario *s);

// Whether the user has allowed just this scenario with just this program or plug-in before.
bool consent_remembered(const scenario *s);

// Remembers that. *kept: it is remembered; false where it cannot be told by its content or there is
// no folder for settings. On failure f says why.
status consent_remember(const scenario *s, bool *kept, fault *f);
