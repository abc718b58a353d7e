// Films of recorded runs: the arm in space with synchronous traces, or several arms side by side,
// in slow motion near every impact.
#pragma once

#include "render/scene/film_frame.h"

// Writes a film of 1 to FILM_RUNS runs over the time that all of them have (see film_file_open for
// path), frame by frame in bounded memory; its bytes do not depend on the threads.
// STATUS_BAD_ARGUMENT for options out of range or a run without rows, STATUS_CANNOT_WRITE with the
// reason, STATUS_STOPPED if `stop` requested it.
status film_write(const film_run *runs, int run_count, const film_options *options,
                  const char *path, fault *f);
