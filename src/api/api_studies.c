// Many runs and linear analysis through libimpactlab.
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "src/api/api_handles.h"
#include "src/arm/modes.h"
#include "src/study/batch.h"
#include "src/study/pool.h"

// A batch is computed in turns. This is the number of runs of each thread in a turn,
// after which their outcomes are handed to the caller.
enum { RUNS_A_TURN = 16 * RUN_TOGETHER };

// How often the calling thread asks whether to stop while others compute [s].
#define ASKING_INTERVAL 0.01

// A batch that is being computed.
typedef struct varied {
    const scenario *base;
    const sweep_axis *axes; // the parameters that vary
    const double *values;   // their values, a row for each run
    size_t axis_count;
    size_t first;        // run of this turn
    stop_request stop;   // how the caller is asked whether to stop
    atomic_bool stopped; // the runs of this turn are to end
} varied;

// Makes the scenario of run i of this turn; f says what is wrong with it.
static status vary(void *context, size_t i, scenario *made, fault *f)
{
    const varied *v = context;
    const double *values = v->values + (v->first + i) * v->axis_count;
    return sweep_axes_scenario(v->axes, (int)v->axis_count, values, v->base, made, f);
}

// Asks the caller whether to stop. The pool calls it on the calling thread while others
// compute.
static status ask_to_stop(void *context, bool over, fault *f)
{
    varied *v = context;
    (void)over, (void)f;
    if (stop_requested(&v->stop)) {
        atomic_store(&v->stopped, true);
    }
    return STATUS_OK;
}

// Hands the outcome of a run to the caller. False if the caller wants no more.
static bool hand_over(const summary *s, size_t index, impactlab_outcome_taker take,
                      void *context)
{
    double quantities[SUMMARY_NUMBERS];
    for (int i = 0; i < summary_count; i++) {
        quantities[i] = summary_value(s, i);
    }
    const impactlab_outcome outcome = {.index = index,
                                       .status = (int)s->status,
                                       .word = summary_status(s),
                                       .message = s->message,
                                       .quantities = quantities,
                                       .quantity_count = (size_t)summary_count};
    return take(context, &outcome) == 0;
}

// Computes all runs in turns, and hands the outcomes of each turn to the caller before
// the next one begins. Of a turn that is stopped, the outcomes of the completed runs are
// handed over.
static int run_varied(varied *v, size_t count, int jobs, impactlab_outcome_taker take,
                      void *context, impactlab_error *error)
{
    const size_t turn = (size_t)jobs * RUNS_A_TURN;
    SCOPED(free_kept)
    summary *summaries = calloc(count < turn ? count : turn, sizeof *summaries);
    if (summaries == NULL) {
        return api_fail(error, STATUS_NO_MEMORY, "no memory for the outcomes");
    }

    // a turn: compute, then hand over
    status code = STATUS_OK;
    for (v->first = 0; code == STATUS_OK && v->first < count; v->first += turn) {
        const size_t runs_left = count - v->first;
        const size_t run_count = runs_left < turn ? runs_left : turn;
        const batch runs = {.context = v,
                            .count = run_count,
                            .make = vary,
                            .summaries = summaries,
                            .tick = v->stop.ask != NULL ? ask_to_stop : NULL,
                            .tick_interval = ASKING_INTERVAL,
                            .abandon = &v->stopped};
        code = batch_run(&runs, jobs, NULL);
        for (size_t i = 0; code == STATUS_OK && i < run_count; i++) {
            const bool done = summaries[i].status != STATUS_STOPPED;
            if (done && !hand_over(&summaries[i], v->first + i, take, context)) {
                code = STATUS_STOPPED;
            }
        }
        if (code == STATUS_OK && atomic_load(&v->stopped)) {
            code = STATUS_STOPPED;
        }
    }
    if (code == STATUS_OK) {
        return api_done(error);
    }
    return api_fail(error, code, "%s", status_text(code));
}

int impactlab_batch(const impactlab_scenario *handle, const char *const *paths,
                    size_t path_count, const double *values, size_t count, int jobs,
                    impactlab_outcome_taker take, void *context, impactlab_error *error)
{
    // what is needed of the arguments
    API_NEEDS(error, handle);
    if (take == NULL) {
        return api_missing(error, "take", 0);
    }
    if (path_count > 0) {
        API_NEEDS(error, paths);
    }
    if (path_count > 0 && count > 0) {
        API_NEEDS(error, values);
    }

    // as many threads as asked for, by default one for each processor
    const long wanted = jobs < 1 ? sysconf(_SC_NPROCESSORS_ONLN) : jobs;
    if (wanted < 1) {
        jobs = 1;
    } else if (wanted > POOL_MOST_THREADS) {
        jobs = POOL_MOST_THREADS;
    } else {
        jobs = (int)wanted;
    }

    // the parameters that vary
    int code = IMPACTLAB_OK;
    SCOPED(free_kept) sweep_axis *axes = calloc(path_count + 1, sizeof *axes);
    if (axes == NULL) {
        return api_fail(error, STATUS_NO_MEMORY, "no memory for a batch");
    }
    for (size_t k = 0; k < path_count && code == IMPACTLAB_OK; k++) {
        if (paths[k] != NULL) {
            code = api_axis(paths[k], &axes[k], error);
        } else {
            code = api_missing(error, "paths[i]", 0);
        }
    }

    // every row of values is checked before anything is run
    varied v = {.base = &handle->scenario,
                .axes = axes,
                .values = values,
                .axis_count = path_count,
                .stop = {.ask = handle->ask, .context = handle->ask_context}};
    fault f = {.text = "", .path = ""};
    scenario tried;
    for (size_t i = 0; i < count && code == IMPACTLAB_OK; i++) {
        if (vary(&v, i, &tried, &f) == STATUS_OK) {
            code = IMPACTLAB_OK;
        } else {
            code = api_fail(error, f.code, "run %zu: %.900s", i, f.text);
        }
        if (code == IMPACTLAB_OK && stop_requested(&v.stop)) {
            code = api_fail(error, STATUS_STOPPED, "%s", status_text(STATUS_STOPPED));
        }
    }
    if (code == IMPACTLAB_OK) {
        return run_varied(&v, count, jobs, take, context, error);
    }
    return code;
}

// --- modes -----------------------------------------------------------------------------

size_t impactlab_freedoms(const impactlab_scenario *handle)
{
    arm a;
    if (handle == NULL || handle->scenario.parameters.arm.model == ARM_PRINTED) {
        return 0;
    }
    arm_init(&a, &handle->scenario.parameters);
    return (size_t)a.dof;
}

int impactlab_modes(const impactlab_scenario *handle, int hub_locked, int tip_pinned,
                    double *frequencies, double *shapes, size_t most, size_t *count,
                    impactlab_error *error)
{
    API_NEEDS(error, handle, frequencies, count);
    const size_t n = impactlab_freedoms(handle);
    *count = 0;
    if (n == 0) {
        return api_fail(
            error, STATUS_BAD_SCENARIO,
            "the printed equations have no symmetric stiffness and so no natural "
            "frequencies, expected arm.model = corrected");
    }

    // frequencies, and behind them n shapes of n angles
    arm a;
    arm_init(&a, &handle->scenario.parameters);
    SCOPED(free_kept) double *all = calloc(n + n * n, sizeof *all);
    int found = 0;
    if (all == NULL) {
        return api_fail(error, STATUS_NO_MEMORY, "no memory for the modes of %zu angles",
                        n);
    }
    const status code =
        modes_compute(&a, hub_locked ? HUB_LOCKED : HUB_FREE,
                      tip_pinned ? TIP_PINNED : TIP_FREE, &found, all, all + n);
    if (code != STATUS_OK) {
        return api_fail(error, code, "%s", status_text(code));
    }

    // as many as there is room for
    const size_t copied = (size_t)found < most ? (size_t)found : most;
    memcpy(frequencies, all, copied * sizeof *all);
    if (shapes != NULL) {
        memcpy(shapes, all + n, copied * n * sizeof *all);
    }
    *count = (size_t)found;
    return api_done(error);
}
