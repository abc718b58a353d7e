// The pool's work done by several processes.
#pragma once

#include "src/study/pool.h"
#include "src/study/ranks.h"

enum { RANK_IDENTITY = 65 }; // of the text that says what the work is, with the zero behind it

// Does the work on all ranks of the group, each of which calls this with the same work: pieces go
// out in small portions as they are asked for, and results are collected, in the order in which
// they arrive, on rank 0, which computes as well. Other ranks collect nothing and need no
// work->done. A result is sent as its bytes: what points into a process means nothing to another.
//
// Returns on rank 0 as pool_run does; STATUS_BAD_ARGUMENT, with a sentence, if a rank's work has
// another identity (an other version, or another scenario on its machine) or it ended before it
// began. On the others STATUS_OK when there is nothing left, STATUS_STOPPED if they were dismissed.
status pool_run_on_ranks(const pool_work *work, const unsigned char *done, const rank_group *group,
                         const char identity[RANK_IDENTITY], fault *f);
