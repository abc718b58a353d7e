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

#define DIFFERENCE 1e-4 // by which an unknown is changed either way, of its scale
#define OUTSIDE    1e4  // residual of a parameter that leaves its range by all its width
#define TOLERANCE  1e-9 // of the sum of squares, and of the unknowns

enum { MOST_STEPS = 60, REFINED = 2 };

// The unknowns of what a trace has of its own, in which one is about 1.
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

// Lists them: the parameters, then what each trace has of its own and is fitted.
static void list_unknowns(identification *id)
{
    id->unknowns = id->count;
    for (int i = 0; i < id->count; i++) {
        id->unknown[i] = (unknown){-1, i, id->fit[i].scale, &id->fit[i].value};
    }
    for (int k = 0; k < id->trace_count; k++) {
        recorded_trace *t = &id->traces[k];
        const bool turns = t->reading[CHANNEL_ENCODER] != NULL;
        const bool fitted[OWNS] = {true, turns, turns, t->fits_velocity};
        for (int own = 0; own < OWNS; own++) {
            if (fitted[own]) {
                id->unknown[id->unknowns++] =
                    (unknown){k, own, own_scale[own], &t->own[own]};
            }
        }
    }
}

// The value that a number gives an unknown in its scale; a parameter stays within its
// range.
static double unknown_value(const identification *id, int n, double x)
{
    const unknown *u = &id->unknown[n];
    if (u->trace < 0) {
        return identify_within_range(&id->fit[u->index], x * u->scale);
    }
    return x * u->scale;
}

// --- batches of runs -------------------------------------------------------------------

// A piece: a trace under a set of unknowns, to `out`.
typedef struct piece {
    int trace;
    const double *x;
    double *out;
    bool judge;
    fault why; // the run failed
} piece;

typedef struct batch_of_runs {
    identification *id;
    piece *pieces;
    size_t count;
} batch_of_runs;

static void compute_piece(void *context, size_t i, void *scratch, void *result)
{
    const batch_of_runs *b = context;
    const identification *id = b->id;
    piece *here = &b->pieces[i];
    recorded_trace *t = &b->id->traces[here->trace];
    parameters p = id->base->parameters;
    double own[OWNS];
    fault ignored;
    (void)scratch;
    memcpy(own, t->own, sizeof own);
    for (int n = 0; n < id->unknowns; n++) {
        const unknown *u = &id->unknown[n];
        const double value = unknown_value(id, n, here->x[n]);
        if (u->trace < 0) {
            (void)sweep_axis_apply(&id->fit[u->index].axis, value, &p, &ignored);
        } else if (u->trace == here->trace) {
            own[u->index] = value;
        }
    }
    here->why = (fault){.code = STATUS_OK, .path = ""};
    identify_residuals(id, t, &p, own, here->judge, here->out, &here->why);
    *(status *)result = here->why.code;
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

// What draws a parameter back that leaves its range; *slope: by its unknown.
static double draw_back(const fitted_parameter *fit, double x, double *slope)
{
    const double value = x * fit->scale, width = fit->high_most - fit->low_most;
    const double beyond =
        fmax(value - fit->high_most, 0) + fmin(value - fit->low_most, 0);
    if (beyond != 0) {
        *slope = OUTSIDE * fit->scale / fmin(width, fit->scale);
    } else {
        *slope = 0;
    }
    return beyond / fmin(width, fit->scale) * OUTSIDE;
}

// Residuals of `sets` sets of unknowns, one behind the other: of each trace, or for set s
// of trace only[s] alone (-1: of each; NULL: each of all), then what draws parameters
// back. `why` (may be NULL) receives what stopped the first run that failed.
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
            *out++ = draw_back(&id->fit[j], x[j], &slope);
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

// The Jacobian, column by column, by central differences: two runs of each trace that an
// unknown has a say in, all in one batch.
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
    TRY(residuals_of(id, moved, (int)(2 * n), only, false, out, NULL, f));
    for (size_t i = 0; i < m * n; i++) {
        const double *lower = out + (i / m * 2 * m) + i % m;
        jacobian[i] = (lower[m] - lower[0]) / (2 * DIFFERENCE);
    }
    for (int j = 0; j < id->count; j++) {
        draw_back(&id->fit[j], x[j],
                  &jacobian[(size_t)(j + 1) * m - (size_t)(id->count - j)]);
    }
    return STATUS_OK;
}

// --- least squares ---------------------------------------------------------------------

// The unknowns that left the least of all that were evaluated.
typedef struct best_yet {
    double x[IDENTIFY_UNKNOWNS], least; // NaN before the first
} best_yet;

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

// Keeps the unknowns of a set that leaves less than those before, if there were any.
static void keep_least(best_yet *best, const identification *id, const double *x,
                       double left)
{
    if (!(left >= best->least)) {
        best->least = left;
        memcpy(best->x, x, (size_t)id->unknowns * sizeof *x);
    }
}

#ifdef IMPACTLAB_MINPACK
static int evaluate_for_minpack(void *context, int m, int n, const double *x,
                                double *residual, double *jacobian, int rows, int asked)
{
    least_squares *l = context;
    (void)m, (void)n, (void)rows;
    if (asked == 1) {
        l->code = residuals_of(l->id, x, 1, NULL, false, residual, NULL, l->f);
    } else {
        l->code = jacobian_of(l->id, x, jacobian, l->f);
    }
    if (l->code == STATUS_OK && asked == 1) {
        keep_least(l->best, l->id, x, sum_of_squares(residual, l->id->residuals));
    }
    if (l->code == STATUS_OK) {
        return 0;
    }
    return -1;
}

// Levenberg and Marquardt's method from x on.
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

// The scenario's values; where a trace starts is what its encoder says, or, with an
// encoder that counts from anywhere, what the scenario says.
static void begin_with(const identification *id, bool counted, double *x)
{
    const double angle = id->base->parameters.initial.angle;
    for (int n = 0; n < id->unknowns; n++) {
        const unknown *u = &id->unknown[n];
        double value = *u->value;
        if (counted && u->trace >= 0) {
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

// The sets of unknowns to begin with, x[starts * unknowns], and what each leaves,
// rest[starts]: the scenario's, and those drawn from the ranges or from half to twice the
// scenario's.
static status draw_beginnings(identification *id, double *x, double *rest, best_yet *best,
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
        double *here = x + s * id->unknowns;
        begin_with(id, s % 2 != 0, here);
        for (int i = 0; i < id->count && s > 1; i++) {
            const fitted_parameter *fit = &id->fit[i];
            const double u = random_uniform(&random);
            if (fit->axis.is_range) {
                here[i] = sweep_axis_value_at(&fit->axis, u) / fit->scale;
            } else {
                const double factor = u < 0.5 ? 0.5 + u : 2 * u;
                here[i] = here[i] * factor;
            }
        }
    }
    TRY(residuals_of(id, x, id->starts, NULL, false, out, NULL, f));
    for (int s = 0; s < id->starts; s++) {
        rest[s] = sum_of_squares(out + (size_t)s * m, m);
        keep_least(best, id, x + s * id->unknowns, rest[s]);
    }
    return STATUS_OK;
}

// Searches with room for the beginnings and what they leave, a set of residuals and the
// Jacobian.
static status search_from_starts(identification *id, double *x, best_yet *best, fault *f)
{
    double *rest = x + id->starts * id->unknowns, *residual = rest + id->starts,
           *jacobian = residual + id->residuals;
    TRY(draw_beginnings(id, x, rest, best, f));

    // those that leave the least to the end
    for (int tried = 0; tried < REFINED; tried++) {
        int s = 0;
        for (int i = 1; i < id->starts; i++) {
            if (rest[i] < rest[s]) {
                s = i;
            }
        }
        rest[s] = HUGE_VAL;
        TRY(minimise(id, x + s * id->unknowns, residual, jacobian, best, f));
    }
    return STATUS_OK;
}

// What a search that was stopped leaves: values that nobody has judged.
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

// Fits with the same room, and judges what came of it.
static status fit_with(identification *id, double *x, fault *f)
{
    double *jacobian = x + id->starts * (id->unknowns + 1) + id->residuals;
    best_yet best = {.least = (double)NAN};
    fault why = {.code = STATUS_OK};
    status code = search_from_starts(id, x, &best, f);
    if (code == STATUS_OK) {
        code = residuals_of(id, best.x, 1, NULL, true, id->residual, &why, f);
    }
    if (code == STATUS_OK && why.code != STATUS_OK) {
        *f = why;
        return why.code;
    }
    if (code == STATUS_OK) {
        code = jacobian_of(id, best.x, jacobian, f);
    }

    // the best there is, if there is any
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

    // what the runs with the recorded command do not take has no best value
    scenario made;
    const bool runs = identify_scenario(id, 0, &made, NULL) == STATUS_OK;
    for (int i = 0; runs && i < id->count; i++) {
        const sweep_axis *axis = &id->fit[i].axis;
        const char *why = effect_none_from(&made, axis->parameter, -1);
        if (why != NULL) {
            return fault_set_at(f, STATUS_BAD_ARGUMENT, sweep_axis_parameter(axis)->path,
                                "%s has no effect in any run: %s", axis->name, why);
        }
    }

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
