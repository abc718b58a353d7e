// Where a run comes from: the scenario as it was opened and the changes. From it a
// session is opened again, whatever has been opened since.
#pragma once

#include "src/session/session.h"

typedef struct run_origin {
    scenario base;
    session_input *inputs;
    int input_count;
    double now, seen;          // the cursor, and the latest instant it has been at [s]
    char outside[SHA256_TEXT]; // outside_digest_all of what it read, or empty
} run_origin;

// Copies a session's; STATUS_NO_MEMORY, and then nothing is to be freed.
status run_origin_take(run_origin *o, const session *s, fault *f);
void run_origin_finish(run_origin *o);

// Whether two scenarios are the same one: by name, parameters and script.
bool same_base(const scenario *a, const scenario *b);
// Whether the session's present run has this origin.
bool run_origin_is_of(const run_origin *o, const session *s);

// Opens a session with the scenario and the changes of an origin, which stays as it is.
// On failure there is no session and f says why.
status session_reopen(session *s, const run_origin *o, double patience, fault *f);
