// Runs traces under sets of unknowns: their residuals, and the Jacobian of these.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/study/identify/identify.h"
#include "src/study/pool.h"

#define DIFFERENCE 1e-4 // step of the Jacobian's differences, over an unknown's scale
#define OUTSIDE    1e4  // residual of a parameter beyond its range by the range's width

// Typical sizes of the unknowns that each trace has of its own.
static const double own_scale[OWNS] = {
    [OWN_SHIFT] = 1e-3, [OWN_OFFSET] = 1e-2, [OWN_ANGLE] = 1e-2, [OWN_VELOCITY] = 1e-1};

// --- unknowns --------------------------------------------------------------------------

// A trace without an encoder tells nothing of the encoder's offset and of the angle at
// its start.
void identify_list_unknowns(identification *id)
{
    id->unknowns = id->count;
    for (int i = 0; i < id->count; i++) {
        id->unknown[i] = (unknown){-1, i, id->fit[i].scale, &id->fit[i].value};
    }
    for (int k = 0; k < id->trace_count; k++) {
        recorded_trace *t = &id->traces[k];
        const bool has_encoder = t->reading[CHANNEL_ENCODER] != NULL;
        const bool fitted[OWNS] = {[OWN_SHIFT] = true,
                                   [OWN_OFFSET] = has_encoder,
                                   [OWN_ANGLE] = has_encoder,
                                   [OWN_VELOCITY] = t->fits_velocity};
        for (int own = 0; own < OWNS; own++) {
            if (fitted[own]) {
                id->unknown[id->unknowns++] =
                    (unknown){k, own, own_scale[own], &t->own[own]};
            }
        }
    }
}

double identify_unknown_value(const identification *id, int n, double x)
{
    const unknown *u = &id->unknown[n];
    if (u->trace < 0) {
        return identify_within_range(&id->fit[u->index], x * u->scale);
    }
    return x * u->scale;
}

void identify_result(const identification *id, double *x)
{
    for (int n = 0; n < id->unknowns; n++) {
        x[n] = *id->unknown[n].value / id->unknown[n].scale;
    }
}

// --- batches of runs -------------------------------------------------------------------

// A piece of work: one trace's run under one set of unknowns.
typedef struct piece {
    int trace;
    const double *x; // the unknowns, in their scales
    double *out;     // receives the residuals
    bool judge;      // also fills in the trace's errors of contact and peak
    fault why;       // why the run failed, STATUS_OK if it did not
} piece;

typedef struct batch_of_runs {
    identification *id;
    piece *pieces;
    size_t count;
} batch_of_runs;

// The pool's work: runs piece i and leaves its residuals. A run that fails does not end
// the batch; its status is the result.
static void compute_piece(void *context, size_t i, void *scratch, void *result)
{
    const batch_of_runs *b = context;
    const identification *id = b->id;
    piece *work = &b->pieces[i];
    recorded_trace *t = &b->id->traces[work->trace];
    parameters p = id->base->parameters;
    double own[OWNS];
    fault ignored;
    (void)scratch;

    // the scenario's parameters and the trace's own numbers, with the unknowns put in
    memcpy(own, t->own, sizeof own);
    for (int n = 0; n < id->unknowns; n++) {
        const unknown *u = &id->unknown[n];
        const double value = identify_unknown_value(id, n, work->x[n]);
        if (u->trace < 0) {
            (void)sweep_axis_apply(&id->fit[u->index].axis, value, &p, &ignored);
        } else if (u->trace == work->trace) {
            own[u->index] = value;
        }
    }

    work->why = (fault){.code = STATUS_OK, .path = ""};
    identify_residuals(id, t, &p, own, work->judge, work->out, &work->why);
    *(status *)result = work->why.code;
}

static status collect_piece(void *context, size_t i, const void *result, fault *f)
{
    const batch_of_runs *b = context;
    (void)i;
    if (*(const status *)result == STATUS_NO_MEMORY) {
        return fault_no_memory(f);
    }
    FAULT_IF(run_monitor_stops(b->id->monitor), f, STATUS_STOPPED, "%s",
             status_text(STATUS_STOPPED));
    run_monitor_count(b->id->monitor);
    b->id->runs++;
    return STATUS_OK;
}

// The residual that draws a parameter back into its range: 0 within, in proportion to the
// distance outside. *slope is its derivative by the unknown x.
static double range_penalty(const fitted_parameter *fit, double x, double *slope)
{
    const double value = x * fit->scale, width = fit->high_most - fit->low_most;
    const double outside =
        fmax(value - fit->high_most, 0) + fmin(value - fit->low_most, 0);
    if (outside != 0) {
        *slope = OUTSIDE * fit->scale / fmin(width, fit->scale);
    } else {
        *slope = 0;
    }
    return outside / fmin(width, fit->scale) * OUTSIDE;
}

// Computes the residuals of `sets` sets of unknowns x, one set after the other: those of
// all traces, then the penalties of the parameters. Of set s only trace only[s] is run;
// with only[s] = -1, or without `only` (NULL), every trace is. `why` (may be NULL)
// receives the fault of the first run that failed.
status identify_evaluate(identification *id, const double *x, int sets, const int *only,
                         bool judge, double *out, fault *why, fault *f)
{
    SCOPED(free_kept)
    piece *pieces = calloc((size_t)(sets * id->trace_count), sizeof *pieces);
    batch_of_runs b = {.id = id, .pieces = pieces};
    double slope;
    if (pieces == NULL) {
        return fault_no_memory(f);
    }
    for (int s = 0; s < sets; s++, x += id->unknowns) {
        for (int k = 0; k < id->trace_count; k++) {
            if (only == NULL || only[s] < 0 || only[s] == k) {
                b.pieces[b.count++] =
                    (piece){.trace = k, .x = x, .out = out, .judge = judge};
            }
            out += id->traces[k].residuals;
        }
        for (int j = 0; j < id->count; j++) {
            *out++ = range_penalty(&id->fit[j], x[j], &slope);
        }
    }
    const pool_work work = {.context = &b,
                            .count = b.count,
                            .result_size = sizeof(status),
                            .compute = compute_piece,
                            .collect = collect_piece};
    const status code = pool_run(&work, id->jobs < 1 ? 1 : id->jobs, f);
    for (size_t i = b.count; why != NULL && i-- > 0;) {
        if (b.pieces[i].why.code != STATUS_OK) {
            *why = b.pieces[i].why;
        }
    }
    return code;
}

// A side of a difference by unknown n: below or above x, in the range of a parameter.
static double moved_unknown(const identification *id, int n, double x, bool up)
{
    const double scale = id->unknown[n].scale;
    const double within = identify_unknown_value(id, n, x) / scale;
    return identify_unknown_value(id, n, within + (up ? DIFFERENCE : -DIFFERENCE)) /
           scale;
}

// The Jacobian of the residuals by the unknowns, column by column, by central
// differences, at the ends of a parameter's range by differences to within it. Sets 2 n
// and 2 n + 1 have unknown n lowered and raised; a trace's own unknown needs runs of that
// trace alone. All runs are one batch.
status identify_jacobian(identification *id, const double *x, double *jacobian, fault *f)
{
    const size_t n = (size_t)id->unknowns, m = id->residuals;
    SCOPED(free_kept) double *moved = calloc(2 * n * (n + m), sizeof *moved);
    int only[2 * IDENTIFY_UNKNOWNS];
    if (moved == NULL) {
        return fault_no_memory(f);
    }
    double *out = moved + 2 * n * n;
    for (size_t s = 0; s < 2 * n; s++) {
        const size_t k = s / 2;
        memcpy(moved + s * n, x, n * sizeof *x);
        moved[s * n + k] = moved_unknown(id, (int)k, x[k], s % 2 != 0);
        only[s] = id->unknown[k].trace;
    }
    const bool judge = false;
    TRY(identify_evaluate(id, moved, (int)(2 * n), only, judge, out, NULL, f));
    for (size_t column = 0; column < n; column++) {
        const double *lowered = out + 2 * column * m, *raised = lowered + m;
        const double *low_set = moved + 2 * column * n, *high_set = low_set + n;
        const double span = high_set[column] - low_set[column];
        for (size_t row = 0; row < m; row++) {
            jacobian[column * m + row] = (raised[row] - lowered[row]) / span;
        }
    }

    // the penalties, the last rows of a column, have their slopes in closed form
    const size_t first_penalty = m - (size_t)id->count;
    for (size_t j = 0; j < (size_t)id->count; j++) {
        range_penalty(&id->fit[j], x[j], &jacobian[j * m + first_penalty + j]);
    }
    return STATUS_OK;
}
