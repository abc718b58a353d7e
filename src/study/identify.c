#include "src/study/identify.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/build_config.h"
#include "src/base/random.h"
#include "src/study/pool.h"
#include "src/study/solve.h"

#ifdef IMPACTLAB_MINPACK
#include <cminpack.h>
#endif

#define DIFFERENCE 1e-4 // by which an unknown is changed either way, of its scale
#define OUTSIDE    1e4  // residual of a parameter that leaves its range by all its width
#define TOLERANCE  1e-9 // of the sum of squares, and of the unknowns

enum { MOST_STEPS = 60, REFINED = 2, UNKNOWNS = IDENTIFY_PATHS + IDENTIFY_TRACES * OWNS };

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
                     "identify needs MINPACK, which this program was built without: install "
                     "libcminpack-dev and build again");
#endif
}

// --- what is fitted ---------------------------------------------------------------------------

status identify_add_path(identification *id, const char *text, fault *f)
{
    assert(id != NULL && text != NULL);
    if (id->count == IDENTIFY_PATHS) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "more than %d parameters to fit", IDENTIFY_PATHS);
    }
    fitted_parameter *p = &id->fit[id->count++];
    *p = (fitted_parameter){.value = (double)NAN};
    sweep_axis *axis = &p->axis;
    const char *range = strchr(text, '=');
    char name[SWEEP_VALUE_TEXT];
    snprintf(name, sizeof name, "%.*s", range != NULL ? (int)(range - text) : (int)strlen(text),
             text);
    status code = sweep_axis_find(axis, name, f);
    if (code != STATUS_OK) {
        return code;
    }
    const parameter_info *info = sweep_axis_parameter(axis);
    if (info->type != PARAMETER_REAL && axis->element == 0) {
        return fault_set_at(f, STATUS_BAD_ARGUMENT, info->path,
                            "%s has no real value that could be fitted", name);
    }
    for (int i = 0; i + 1 < id->count; i++) {
        if (strcmp(id->fit[i].axis.name, axis->name) == 0) {
            return fault_set_at(f, STATUS_BAD_ARGUMENT, info->path, "%s is fitted twice", name);
        }
    }

    // the scenario's value and the range to search
    double numbers[PARAMETER_LIST_MOST];
    p->start = parameter_get(&id->base->parameters, axis->parameter);
    if (axis->element > 0) {
        char list[PARAMETER_TEXT_SIZE];
        parameter_format(&id->base->parameters, axis->parameter, list, sizeof list);
        if (axis->element > parameter_list_numbers(list, numbers)) {
            return fault_set_at(f, STATUS_BAD_ARGUMENT, info->path,
                                "%s: the scenario's list is shorter", name);
        }
        p->start = numbers[axis->element - 1];
    }
    p->low_most = info->minimum;
    p->high_most = info->maximum;
    if (range != NULL) {
        char *values = strdup(range + 1);
        code = values != NULL ? sweep_axis_parse(axis, values, true, f) : fault_no_memory(f);
        free(values);
        if (code == STATUS_OK && (!axis->is_range || axis->low == axis->high)) {
            code = fault_set(f, STATUS_BAD_ARGUMENT, "expected a range, %s=a:b", name);
        }
        p->low_most = fmin(axis->low, axis->high);
        p->high_most = fmax(axis->low, axis->high);
    }
    if (code == STATUS_OK && range == NULL && !(fabs(p->start) > 0)) {
        code =
            fault_set_at(f, STATUS_BAD_ARGUMENT, info->path,
                         "%s is 0 in the scenario, expected a range to search: %s=a:b", name, name);
    }
    p->value = fmin(fmax(p->start, p->low_most), p->high_most);
    id->scale[id->count - 1] =
        fabs(p->value) > 0 ? fabs(p->value) : fabs(p->high_most - p->low_most);
    return code;
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

status identify_parameters(const identification *id, bool determined, parameters *p, fault *f)
{
    status code = STATUS_OK;
    *p = id->base->parameters;
    for (int i = 0; i < id->count && code == STATUS_OK; i++) {
        const fitted_parameter *fit = &id->fit[i];
        if (!determined || fit->determined) {
            code = sweep_axis_apply(&fit->axis, fit->value, p, f);
        }
    }
    return code;
}

// --- unknowns ---------------------------------------------------------------------------------

// Which of a trace's own are fitted.
static bool is_fitted(const recorded_trace *t, int own)
{
    return own == OWN_VELOCITY ? t->fits_velocity
                               : own == OWN_SHIFT || t->reading[CHANNEL_ENCODER] != NULL;
}

// Where one trace takes its unknowns from: x[], first the parameters.
static void take_unknowns(const identification *id, const double *x, int which, parameters *p,
                          double own[OWNS])
{
    fault ignored;
    *p = id->base->parameters;
    for (int i = 0; i < id->count; i++) {
        const fitted_parameter *fit = &id->fit[i];
        const double value = fmin(fmax(x[i] * id->scale[i], fit->low_most), fit->high_most);
        (void)sweep_axis_apply(&fit->axis, value, p, &ignored);
    }
    for (int k = 0, n = id->count; k <= which; k++) {
        for (int o = 0; o < OWNS; o++) {
            const bool fits = is_fitted(&id->traces[k], o);
            if (k == which) {
                own[o] = fits ? x[n] * own_scale[o] : id->traces[k].own[o];
            }
            n += fits;
        }
    }
}

// The trace that unknown number n belongs to, -1 for a parameter.
static int trace_of(const identification *id, int n)
{
    int at = id->count;
    for (int k = 0; k < id->trace_count && n >= id->count; k++) {
        for (int o = 0; o < OWNS; o++) {
            at += is_fitted(&id->traces[k], o);
        }
        if (n < at) {
            return k;
        }
    }
    return -1;
}

// The present values as unknowns; returns how many.
static int to_unknowns(const identification *id, double *x)
{
    int n = 0;
    for (; n < id->count; n++) {
        x[n] = id->fit[n].value / id->scale[n];
    }
    for (int k = 0; k < id->trace_count; k++) {
        for (int o = 0; o < OWNS; o++) {
            if (is_fitted(&id->traces[k], o)) {
                x[n++] = id->traces[k].own[o] / own_scale[o];
            }
        }
    }
    return n;
}

static void from_unknowns(identification *id, const double *x)
{
    double own[IDENTIFY_TRACES][OWNS];
    parameters p;
    for (int k = 0; k < id->trace_count; k++) {
        take_unknowns(id, x, k, &p, own[k]);
    }
    for (int k = 0; k < id->trace_count; k++) {
        memcpy(id->traces[k].own, own[k], sizeof own[k]);
    }
    for (int i = 0; i < id->count; i++) {
        fitted_parameter *fit = &id->fit[i];
        fit->value = fmin(fmax(x[i] * id->scale[i], fit->low_most), fit->high_most);
    }
}

// --- batches of runs --------------------------------------------------------------------------

// A piece: trace `trace` under unknowns x, to `out`.
typedef struct piece {
    int trace;
    double x[UNKNOWNS];
    double *out;
    bool judge;
} piece;

typedef struct batch_of_runs {
    identification *id;
    piece *pieces;
    fault first; // of the runs that failed
} batch_of_runs;

typedef struct piece_result {
    fault fault;
} piece_result;

static void compute_piece(void *context, size_t i, void *scratch, void *result)
{
    const batch_of_runs *b = context;
    const piece *here = &b->pieces[i];
    piece_result *r = result;
    parameters p;
    double own[OWNS];
    (void)scratch;
    r->fault = (fault){.code = STATUS_OK, .path = ""};
    take_unknowns(b->id, here->x, here->trace, &p, own);
    identify_residuals(b->id, &b->id->traces[here->trace], &p, own, here->judge, here->out,
                       &r->fault);
}

static status collect_piece(void *context, size_t i, const void *result, fault *f)
{
    batch_of_runs *b = context;
    const piece_result *r = result;
    (void)i;
    if (r->fault.code == STATUS_NO_MEMORY) {
        return fault_no_memory(f);
    }
    if (run_monitor_stops(b->id->monitor)) {
        return fault_set(f, STATUS_STOPPED, "%s", status_text(STATUS_STOPPED));
    }
    if (r->fault.code != STATUS_OK && b->first.code == STATUS_OK) {
        b->first = r->fault;
    }
    run_monitor_count(b->id->monitor);
    return STATUS_OK;
}

static status run_pieces(batch_of_runs *b, size_t count, fault *f)
{
    const pool_work work = {.context = b,
                            .count = count,
                            .result_size = sizeof(piece_result),
                            .compute = compute_piece,
                            .collect = collect_piece};
    return pool_run(&work, b->id->jobs < 1 ? 1 : b->id->jobs, f);
}

// Residuals of `sets` sets of unknowns, x[set * n], one behind the other.
static status residuals_of(identification *id, const double *x, int n, int sets, bool judge,
                           double *out, fault *why, fault *f)
{
    batch_of_runs b = {.id = id};
    const size_t count = (size_t)sets * (size_t)id->trace_count;
    b.pieces = calloc(count, sizeof *b.pieces);
    if (b.pieces == NULL) {
        return fault_no_memory(f);
    }
    for (size_t i = 0; i < count; i++) {
        const int k = (int)(i % (size_t)id->trace_count);
        piece *p = &b.pieces[i];
        memcpy(p->x, x + i / (size_t)id->trace_count * (size_t)n, (size_t)n * sizeof *x);
        p->trace = k;
        p->judge = judge;
        p->out = out;
        out += id->traces[k].residuals;
        if (k == id->trace_count - 1) {
            // a parameter that leaves its range is drawn back
            for (int j = 0; j < id->count; j++) {
                const fitted_parameter *fit = &id->fit[j];
                const double value = p->x[j] * id->scale[j], width = fit->high_most - fit->low_most;
                const double beyond =
                    fmax(value - fit->high_most, 0) + fmin(value - fit->low_most, 0);
                *out++ = beyond / fmin(width, id->scale[j]) * OUTSIDE;
            }
        }
    }
    status code = run_pieces(&b, count, f);
    if (why != NULL) {
        *why = b.first;
    }
    free(b.pieces);
    return code;
}

// The Jacobian, column by column, by central differences: two runs of each trace that an unknown
// has a say in, all in one batch.
static status jacobian_of(identification *id, const double *x, int n, double *jacobian, fault *f)
{
    const size_t m = id->residuals;
    const size_t most = 2 * (size_t)n * (size_t)id->trace_count;
    batch_of_runs b = {.id = id, .pieces = calloc(most, sizeof *b.pieces)};
    double *other = calloc(m * (size_t)n, sizeof *other);
    size_t count = 0;
    status code = b.pieces != NULL && other != NULL ? STATUS_OK : fault_no_memory(f);
    memset(jacobian, 0, m * (size_t)n * sizeof *jacobian);
    for (int j = 0; j < n && code == STATUS_OK; j++) {
        const int only = trace_of(id, j);
        size_t from = 0;
        for (int k = 0; k < id->trace_count; k++) {
            for (int side = -1; side <= 1 && (only < 0 || only == k); side += 2) {
                piece *p = &b.pieces[count++];
                memcpy(p->x, x, (size_t)n * sizeof *x);
                p->x[j] += side * DIFFERENCE;
                p->trace = k;
                p->out = (side < 0 ? other : jacobian) + (size_t)j * m + from;
            }
            from += id->traces[k].residuals;
        }
    }
    code = code == STATUS_OK ? run_pieces(&b, count, f) : code;
    for (size_t i = 0; i < m * (size_t)n && code == STATUS_OK; i++) {
        jacobian[i] = (jacobian[i] - other[i]) / (2 * DIFFERENCE);
    }
    for (int j = 0; j < id->count && code == STATUS_OK; j++) {
        const fitted_parameter *fit = &id->fit[j];
        const double value = x[j] * id->scale[j], width = fit->high_most - fit->low_most;
        const bool outside = value > fit->high_most || value < fit->low_most;
        jacobian[(size_t)j * m + m - (size_t)id->count + (size_t)j] =
            outside ? OUTSIDE * id->scale[j] / fmin(width, id->scale[j]) : 0;
    }
    free(b.pieces);
    free(other);
    return code;
}

// --- least squares ----------------------------------------------------------------------------

typedef struct least_squares {
    identification *id;
    status code;
    fault *f;
} least_squares;

#ifdef IMPACTLAB_MINPACK
static int evaluate(void *context, int m, int n, const double *x, double *residual,
                    double *jacobian, int rows, int asked)
{
    least_squares *l = context;
    (void)m;
    (void)rows;
    l->code = asked == 1 ? residuals_of(l->id, x, n, 1, false, residual, NULL, l->f)
                         : jacobian_of(l->id, x, n, jacobian, l->f);
    return l->code == STATUS_OK ? 0 : -1;
}

// Levenberg and Marquardt's method from x on.
static status minimise(identification *id, double *x, int n, double *residual, double *jacobian,
                       fault *f)
{
    const int m = (int)id->residuals;
    least_squares l = {.id = id, .f = f};
    double diagonal[UNKNOWNS], work[4][UNKNOWNS], *more = calloc((size_t)m, sizeof *more);
    int pivots[UNKNOWNS], evaluations, jacobians;
    if (more == NULL) {
        return fault_no_memory(f);
    }
    lmder(evaluate, &l, m, n, x, residual, jacobian, m, TOLERANCE, TOLERANCE, 0, MOST_STEPS,
          diagonal, 1, 1, 0, &evaluations, &jacobians, pivots, work[0], work[1], work[2], work[3],
          more);
    free(more);
    return l.code;
}
#else
static status minimise(identification *id, double *x, int n, double *residual, double *jacobian,
                       fault *f)
{
    (void)id, (void)x, (void)n, (void)residual, (void)jacobian;
    return identify_available(f);
}
#endif

static double sum_of_squares(const double *residual, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        sum += residual[i] * residual[i];
    }
    return sum;
}

// The values to begin with: the scenario's, and those drawn from the ranges or from half to twice
// the scenario's, sorted by what they leave.
typedef struct beginning {
    double x[UNKNOWNS];
    double rest;
} beginning;

static int compare_beginnings(const void *a, const void *b)
{
    const double x = ((const beginning *)a)->rest, y = ((const beginning *)b)->rest;
    return (x > y) - (x < y);
}

// The scenario's values; where a trace starts is what its encoder says, or, with an encoder that
// counts from anywhere, what the scenario says.
static void begin_with(const identification *id, bool counted, double *x)
{
    identification other = *id;
    for (int k = 0; k < id->trace_count && counted; k++) {
        recorded_trace *t = &other.traces[k];
        const double angle = id->base->parameters.initial.angle;
        t->own[OWN_OFFSET] += t->own[OWN_ANGLE] - angle;
        t->own[OWN_ANGLE] = angle;
    }
    to_unknowns(&other, x);
}

static status draw_beginnings(identification *id, beginning *all, int n, fault *f)
{
    const size_t m = id->residuals;
    random_generator random;
    double *x = calloc((size_t)id->starts * (size_t)n + 1, sizeof *x);
    double *out = calloc((size_t)id->starts * m, sizeof *out);
    status code = x != NULL && out != NULL ? STATUS_OK : fault_no_memory(f);
    random_seed(&random, id->seed);
    for (int s = 0; s < id->starts && code == STATUS_OK; s++) {
        double *here = x + (size_t)s * (size_t)n;
        begin_with(id, s % 2 != 0, here);
        for (int i = 0; i < id->count && s > 1; i++) {
            const fitted_parameter *fit = &id->fit[i];
            const double u = random_uniform(&random);
            here[i] = fit->axis.is_range ? sweep_axis_value_at(&fit->axis, u) / id->scale[i]
                                         : here[i] * (u < 0.5 ? 0.5 + u : 2 * u);
        }
    }
    code = code == STATUS_OK ? residuals_of(id, x, n, id->starts, false, out, NULL, f) : code;
    for (int s = 0; s < id->starts && code == STATUS_OK; s++) {
        memcpy(all[s].x, x + (size_t)s * (size_t)n, (size_t)n * sizeof *x);
        all[s].rest = sum_of_squares(out + (size_t)s * m, m);
    }
    if (code == STATUS_OK) {
        qsort(all, (size_t)id->starts, sizeof *all, compare_beginnings);
    }
    free(x);
    free(out);
    return code;
}

status identify_fit(identification *id, fault *f)
{
    assert(id != NULL && id->trace_count > 0);
    double x[UNKNOWNS];
    const int n = to_unknowns(id, x);
    id->unknowns = n;
    id->residuals = (size_t)id->count;
    for (int k = 0; k < id->trace_count; k++) {
        id->residuals += id->traces[k].residuals;
    }
    id->starts = id->count == 0 || id->starts < 2 ? 2 : id->starts;
    const size_t m = id->residuals;
    if (m <= (size_t)(n + id->count) || m > 10000000) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "%zu readings can be compared for %d unknowns, expected more", m, n);
    }

    free(id->residual);
    id->residual = calloc(m, sizeof *id->residual);
    double *residual = calloc(m, sizeof *residual);
    double *jacobian = calloc(m * (size_t)n, sizeof *jacobian);
    beginning *all = calloc((size_t)id->starts, sizeof *all);
    status code = id->residual != NULL && residual != NULL && jacobian != NULL && all != NULL
                      ? draw_beginnings(id, all, n, f)
                      : fault_no_memory(f);

    // the best of them to the end
    double least = HUGE_VAL;
    for (int s = 0; s < id->starts && s < REFINED && code == STATUS_OK; s++) {
        code = minimise(id, all[s].x, n, residual, jacobian, f);
        const double rest = sum_of_squares(residual, m);
        if (code == STATUS_OK && rest < least) {
            least = rest;
            memcpy(x, all[s].x, sizeof x);
        }
    }
    fault why = {0};
    code = code == STATUS_OK ? residuals_of(id, x, n, 1, true, id->residual, &why, f) : code;
    if (code == STATUS_OK && why.code != STATUS_OK) {
        *f = why;
        code = why.code;
    }
    code = code == STATUS_OK ? jacobian_of(id, x, n, jacobian, f) : code;
    if (code == STATUS_OK) {
        from_unknowns(id, x);
        code = identify_judge(id, jacobian, f);
    }
    free(residual);
    free(jacobian);
    free(all);
    return code;
}
