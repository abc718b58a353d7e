// Whole runs of two links, for counting their instructions and for timing two commits in
// turns: 1 s against the wall, again and again. tests/bench/instructions.sh and
// in_turns.sh run it.
//
//   whole_runs single|rows|rig PASSES      one run a pass: bare, with its rows, under a
//   control law whole_runs batch PASSES [WIDTH]        256 a pass, 0.5 to 1.5 V, on one
//   thread, WIDTH arms at
//                                          most side by side
//
// Prints the number of runs and the microseconds of computing each took. Compiled with
// -DBEFORE it knows batches only and fits commit 57dad42, whose folders had other names.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#ifdef BEFORE
#include "src/lab/batch.h"
#include "src/lab/run.h"
#else
#include "src/run/run.h"
#include "src/engines/pair/taylor_lanes.h"
#include "src/study/batch.h"
#endif

enum { BATCH = 256 };

static void vary(scenario *made, const scenario *base, size_t i)
{
    *made = *base;
    made->parameters.motor.voltage = 0.5 + (double)i / BATCH;
}

static summary summaries[BATCH];

#ifdef BEFORE
static void make_run(void *context, size_t i, scenario *made)
{
    vary(made, context, i);
}

static status run_batch(scenario *s)
{
    batch_run(make_run, s, BATCH, 1, summaries);
    return summaries[0].status;
}
#else
static status make_run(void *context, size_t i, scenario *made, fault *f)
{
    (void)f;
    vary(made, context, i);
    return STATUS_OK;
}

static status run_batch(scenario *s)
{
    const batch runs = {.context = s,
                        .count = BATCH,
                        .make = make_run,
                        .summaries = summaries};
    return batch_run(&runs, 1, NULL);
}
#endif

#ifdef BEFORE
static status run_one(scenario *s, const char *what)
{
    (void)s;
    fprintf(stderr, "whole_runs: no %s here\n", what);
    return STATUS_BAD_ARGUMENT;
}
#else
static status run_one(scenario *s, const char *what)
{
    run_result result;
    const status code = run_scenario(s, strcmp(what, "rows") == 0, &result);
    run_finish(&result);
    return code;
}
#endif

static double computing_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int main(int argc, char **argv)
{
    if (argc < 3) {
        fprintf(stderr, "usage: whole_runs single|rows|rig|batch PASSES [WIDTH]\n");
        return 2;
    }
    const char *what = argv[1];
    const int passes = atoi(argv[2]);
    const bool many = strcmp(what, "batch") == 0;

    // the corrected arm, under the hybrid law if on the rig
    static char name[] = "whole runs", none[] = "";
    scenario s = {.name = name, .file = none, .title = none, .description = none};
    fault f;
    parameters_defaults(&s.parameters, ARM_CORRECTED);
#ifndef BEFORE
    taylor_limit_width(argc > 3 ? atoi(argv[3]) : 0);
    if (strcmp(what, "rig") == 0) {
        parameter_set_text(&s.parameters, parameter_find("control.law"), "hybrid", &f);
    }
#endif
    status code = parameters_resolve(&s.parameters, &f);

    const double start = computing_time();
    for (int i = 0; i < passes && code == STATUS_OK; i++) {
        code = many ? run_batch(&s) : run_one(&s, what);
    }
    const int runs = many ? passes * BATCH : passes;
    printf("%d %.2f\n", runs, 1e6 * (computing_time() - start) / runs);
    return code != STATUS_OK;
}
