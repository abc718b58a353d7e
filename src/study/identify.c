#include "src/study/identify.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/build_config.h"
#include "src/base/random.h"
#include "src/scenario/effect.h"
#include "src/study/pool.h"

#ifdef IMPACTLAB_MINPACK
#include <cminpack.h>
#endif

#define DIFFERENCE 1e-4 // step of the Jacobian's differences, over an unknown's scale
#define OUTSIDE    1e4  // residual of a parameter beyond its range by the range's width
#define TOLERANCE  1e-9 // relative, of the sum of squares and of the unknowns

enum {
    MOST_STEPS = 60, // of the least squares
    REFINED = 2      // starts from which the least squares are solved
};

// Typical sizes of the unknowns that each trace has of its own.
static const double own_scale[OWNS] = {
    [OWN_SHIFT] = 1e-3, [OWN_OFFSET] = 1e-2, [OWN_ANGLE] = 1e-2, [OWN_VELOCITY] = 1e-1};

status identify_available(fault *f)
{
#ifdef IMPACTLAB_MINPACK
    (void)f;
    return STATUS_OK;
#else
    return fault_set(f, STATUS_NOT_ALLOWED,
                     "identify needs MINPACK, which this program was built without: "
                     "install libcminpack-dev and build again");
#endif
}

void identify_finish(identification *id)
{
    for (int i = 0; i < id->count; i++) {
        sweep_axis_finish(&id->fit[i].axis);
    }
    for (int i = 0; i < id->trace_count; i++) {
        recorded_trace *t = &id->traces[i];
        for (int c = 0; c < CHANNELS; c++) {
            free(t->reading[c]);
            free(t->deviation[c]);
        }
        free(t->file);
        free(t->time);
        free(t->command);
        free(t->contacts);
    }
    free(id->residual);
    *id = (identification){0};
}

// --- unknowns --------------------------------------------------------------------------

// Lists the unknowns of the fit: the parameters, then those of each trace. A trace
// without an encoder tells nothing of the encoder's offset and of the angle at its start.
static void list_unknowns(identification *id)
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

// The value of unknown n at x, x being in units of its scale; a parameter's value is
// limited to its range.
static double unknown_value(const identification *id, int n, double x)
{
    const unknown *u = &id->unknown[n];
    if (u->trace < 0) {
        return identify_within_range(&id->fit[u->index], x * u->scale);
    }
    return x * u->scale;
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
        const double value = unknown_value(id, n, work->x[n]);
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
static status residuals_of(identification *id, const double *x, int sets, const int *only,
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

// The Jacobian of the residuals by the unknowns, column by column, by central
// differences. Sets 2 n and 2 n + 1 have unknown n lowered and raised; a trace's own
// unknown needs runs of that trace alone. All runs are one batch.
static status jacobian_of(identification *id, const double *x, double *jacobian, fault *f)
{
    const size_t n = (size_t)id->unknowns, m = id->residuals;
    SCOPED(free_kept) double *moved = calloc(2 * n * (n + m), sizeof *moved);
    int only[2 * IDENTIFY_UNKNOWNS];
    if (moved == NULL) {
        return fault_no_memory(f);
    }
    double *out = moved + 2 * n * n;
    for (size_t s = 0; s < 2 * n; s++) {
        memcpy(moved + s * n, x, n * sizeof *x);
        if (s % 2 == 0) {
            moved[s * n + s / 2] += -DIFFERENCE;
        } else {
            moved[s * n + s / 2] += DIFFERENCE;
        }
        only[s] = id->unknown[s / 2].trace;
    }
    const bool judge = false;
    TRY(residuals_of(id, moved, (int)(2 * n), only, judge, out, NULL, f));
    for (size_t column = 0; column < n; column++) {
        const double *lowered = out + 2 * column * m, *raised = lowered + m;
        for (size_t row = 0; row < m; row++) {
            jacobian[column * m + row] = (raised[row] - lowered[row]) / (2 * DIFFERENCE);
        }
    }

    // the penalties, the last rows of a column, have their slopes in closed form
    const size_t first_penalty = m - (size_t)id->count;
    for (size_t j = 0; j < (size_t)id->count; j++) {
        range_penalty(&id->fit[j], x[j], &jacobian[j * m + first_penalty + j]);
    }
    return STATUS_OK;
}

// --- least squares ---------------------------------------------------------------------

// The unknowns with the least sum of squares of all that were evaluated.
typedef struct best_yet {
    double x[IDENTIFY_UNKNOWNS];
    double least; // the sum of squares; NaN before the first
} best_yet;

// What MINPACK hands to the function that it minimises.
typedef struct least_squares {
    identification *id;
    best_yet *best;
    status code;
    fault *f;
} least_squares;

static double sum_of_squares(const double *residual, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        sum += residual[i] * residual[i];
    }
    return sum;
}

// Keeps a set of unknowns as the best one if its sum of squares is below the least one so
// far, or the first one.
static void keep_least(best_yet *best, const identification *id, const double *x,
                       double squares)
{
    if (!(squares >= best->least)) {
        best->least = squares;
        memcpy(best->x, x, (size_t)id->unknowns * sizeof *x);
    }
}

#ifdef IMPACTLAB_MINPACK
// MINPACK's function: with the flag 1 it asks for the residuals at x, else for the
// Jacobian. A negative result ends the search.
static int evaluate_for_minpack(void *context, int m, int n, const double *x,
                                double *residual, double *jacobian, int rows, int flag)
{
    least_squares *l = context;
    const bool wants_residuals = flag == 1, judge = false;
    (void)m, (void)n, (void)rows;
    if (wants_residuals) {
        l->code = residuals_of(l->id, x, 1, NULL, judge, residual, NULL, l->f);
    } else {
        l->code = jacobian_of(l->id, x, jacobian, l->f);
    }
    if (l->code == STATUS_OK && wants_residuals) {
        keep_least(l->best, l->id, x, sum_of_squares(residual, l->id->residuals));
    }
    if (l->code == STATUS_OK) {
        return 0;
    }
    return -1;
}

// Minimises the sum of squares by Levenberg and Marquardt's method, from x on.
static status minimise(identification *id, double *x, double *residual, double *jacobian,
                       best_yet *best, fault *f)
{
    const int m = (int)id->residuals, n = id->unknowns;
    least_squares l = {.id = id, .best = best, .f = f};
    double diagonal[IDENTIFY_UNKNOWNS], work[4][IDENTIFY_UNKNOWNS];
    SCOPED(free_kept) double *more = calloc((size_t)m, sizeof *more);
    int pivots[IDENTIFY_UNKNOWNS], evaluations, jacobians;
    if (more == NULL) {
        return fault_no_memory(f);
    }
    lmder(evaluate_for_minpack, &l, m, n, x, residual, jacobian, m, TOLERANCE, TOLERANCE,
          0, MOST_STEPS, diagonal, 1, 1, 0, &evaluations, &jacobians, pivots, work[0],
          work[1], work[2], work[3], more);
    return l.code;
}
#else
static status minimise(identification *id, double *x, double *residual, double *jacobian,
                       best_yet *best, fault *f)
{
    (void)id, (void)x, (void)residual, (void)jacobian, (void)best;
    return identify_available(f);
}
#endif

// Sets the unknowns x to start from: the scenario's parameters, and for each trace its
// own first guess. That takes the angle at the start from the encoder. With
// `offset_unknown` the encoder may count from any angle: the scenario tells the angle,
// and the difference goes to the encoder's offset.
static void begin_with(const identification *id, bool offset_unknown, double *x)
{
    const double angle = id->base->parameters.initial.angle;
    for (int n = 0; n < id->unknowns; n++) {
        const unknown *u = &id->unknown[n];
        double value = *u->value;
        if (offset_unknown && u->trace >= 0) {
            const double *own = id->traces[u->trace].own;
            if (u->index == OWN_ANGLE) {
                value = angle;
            } else if (u->index == OWN_OFFSET) {
                value = own[OWN_OFFSET] + (own[OWN_ANGLE] - angle);
            }
        }
        x[n] = value / u->scale;
    }
}

// Chooses the sets of unknowns to start from, x[starts * unknowns], and computes the sum
// of squares of each, squares[starts]. The first two have the scenario's parameters;
// those of the others are drawn from their ranges, or from half to twice the scenario's
// value.
static status draw_starts(identification *id, double *x, double *squares, best_yet *best,
                          fault *f)
{
    const size_t m = id->residuals;
    random_generator random;
    SCOPED(free_kept) double *out = calloc((size_t)id->starts * m, sizeof *out);
    if (out == NULL) {
        return fault_no_memory(f);
    }

    random_seed(&random, id->seed);
    for (int s = 0; s < id->starts; s++) {
        double *start = x + s * id->unknowns;
        const bool offset_unknown = s % 2 != 0;
        begin_with(id, offset_unknown, start);
        for (int i = 0; i < id->count && s > 1; i++) {
            const fitted_parameter *fit = &id->fit[i];
            const double u = random_uniform(&random);
            if (fit->axis.is_range) {
                start[i] = sweep_axis_value_at(&fit->axis, u) / fit->scale;
            } else {
                const double factor = u < 0.5 ? 0.5 + u : 2 * u;
                start[i] = start[i] * factor;
            }
        }
    }

    const bool judge = false;
    TRY(residuals_of(id, x, id->starts, NULL, judge, out, NULL, f));
    for (int s = 0; s < id->starts; s++) {
        squares[s] = sum_of_squares(out + (size_t)s * m, m);
        keep_least(best, id, x + s * id->unknowns, squares[s]);
    }
    return STATUS_OK;
}

// Searches the least sum of squares. x has room for the starts and, behind them, for
// their sums of squares, one set of residuals and the Jacobian.
static status search_from_starts(identification *id, double *x, best_yet *best, fault *f)
{
    double *squares = x + id->starts * id->unknowns;
    double *residual = squares + id->starts;
    double *jacobian = residual + id->residuals;
    TRY(draw_starts(id, x, squares, best, f));

    // minimise from the starts with the least sums of squares
    for (int tried = 0; tried < REFINED; tried++) {
        int least = 0;
        for (int i = 1; i < id->starts; i++) {
            if (squares[i] < squares[least]) {
                least = i;
            }
        }
        squares[least] = HUGE_VAL; // not to be chosen again
        TRY(minimise(id, x + least * id->unknowns, residual, jacobian, best, f));
    }
    return STATUS_OK;
}

// Fills in the results of a search that was stopped: the sum of squares is known, and no
// number that judges the fit is.
static void leave_unjudged(identification *id, double least)
{
    id->chi_square = least;
    id->aic = (double)NAN;
    for (int i = 0; i < id->count; i++) {
        id->singular[i] = (double)NAN;
        id->fit[i].standard_error = id->fit[i].low = id->fit[i].high = (double)NAN;
    }
    for (int k = 0; k < id->trace_count; k++) {
        recorded_trace *t = &id->traces[k];
        t->contact_error = t->peak_error = (double)NAN;
        for (int c = 0; c < CHANNELS; c++) {
            t->rms[c] = t->whiteness[c] = (double)NAN;
        }
    }
}

// Fits the unknowns with the room of search_from_starts, runs the best ones once more,
// and judges the fit by their residuals and Jacobian.
static status fit_with(identification *id, double *x, fault *f)
{
    double *jacobian = x + id->starts * (id->unknowns + 1) + id->residuals;
    best_yet best = {.least = (double)NAN};
    fault why = {.code = STATUS_OK};
    status code = search_from_starts(id, x, &best, f);
    if (code == STATUS_OK) {
        const bool judge = true;
        code = residuals_of(id, best.x, 1, NULL, judge, id->residual, &why, f);
    }
    if (code == STATUS_OK && why.code != STATUS_OK) {
        *f = why;
        return why.code;
    }
    if (code == STATUS_OK) {
        code = jacobian_of(id, best.x, jacobian, f);
    }

    // keep the best values found, also of a search that was stopped
    if (isnan(best.least) || (code != STATUS_OK && code != STATUS_STOPPED)) {
        return code;
    }
    for (int n = 0; n < id->unknowns; n++) {
        *id->unknown[n].value = unknown_value(id, n, best.x[n]);
    }
    if (code == STATUS_STOPPED) {
        leave_unjudged(id, best.least);
        return code;
    }
    return identify_judge(id, jacobian, f);
}

status identify_fit(identification *id, fault *f)
{
    assert(id->trace_count > 0);
    list_unknowns(id);

    // a parameter without effect in runs under the recorded command cannot be fitted
    scenario made;
    const bool can_run = identify_scenario(id, 0, &made, NULL) == STATUS_OK;
    for (int i = 0; can_run && i < id->count; i++) {
        const sweep_axis *axis = &id->fit[i].axis;
        const char *why = effect_none_from(&made, axis->parameter, -1);
        if (why != NULL) {
            return fault_set_at(f, STATUS_BAD_ARGUMENT, sweep_axis_parameter(axis)->path,
                                "%s has no effect in any run: %s", axis->name, why);
        }
    }

    // the residuals, of which there have to be more than unknowns
    id->residuals = (size_t)id->count;
    for (int k = 0; k < id->trace_count; k++) {
        id->residuals += id->traces[k].residuals;
    }
    if (id->count == 0 || id->starts < 2) {
        id->starts = 2;
    }
    const size_t m = id->residuals, n = (size_t)id->unknowns, starts = (size_t)id->starts;
    FAULT_IF(m <= n + (size_t)id->count || m > 10000000, f, STATUS_BAD_ARGUMENT,
             "%zu readings can be compared for %zu unknowns, expected more", m, n);

    free(id->residual);
    id->residual = calloc(m, sizeof *id->residual);
    SCOPED(free_kept) double *room = calloc(starts * (n + 1) + m + m * n, sizeof *room);
    if (!(id->residual != NULL && room != NULL)) {
        return fault_no_memory(f);
    }
    return fit_with(id, room, f);
}
