// Errors of parameters where the model lacks something: residuals that stay correlated
// are no noise, so they say themselves how far they could lead.
//
// What an arm does at an instant changes all that it does later. So what is lacking is
// taken for a command u that nobody recorded, constant over stretches of time and
// independent from one to the next, beside the noise of the readings. With D, how the
// residuals r change with u in each stretch, their covariance is
//
//     V = s^2 (1 + g^2 D D'),
//
// and s and g are those under which r is most likely, as far as the unknowns' columns
// leave it open (restricted maximum likelihood; Patterson and Thompson, Biometrika 58,
// 1971). Residuals move the parameters by J^-1 A' r, A being the parameters' columns
// freed of what the traces' own unknowns explain and J = A'A, so the errors' covariance
// is
//
//     J^-1 A' V A J^-1 = s^2 J^-1 + s^2 g^2 (J^-1 A' D)(J^-1 A' D)'.
//
// A command s g beyond what the amplifier takes explains nothing: then there are no
// errors. What a hub that gives could do is added (identify_hub.c).
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/dense.h"
#include "src/base/numbers.h"
#include "src/base/plain_math.h"
#include "src/scenario/scenario.h"
#include "src/study/identify/identify_lack.h"

#define PUSH         0.02 // of the largest command
#define MOST_NUMBERS 3e7  // in the stretches' columns

enum {
    MOST_STRETCHES = 400, // of all traces; those of long ones are longer
    STRENGTHS = 300,      // of commands that are tried
    A_DECADE = 20         // of their squares
};

static int stretches_of(const recorded_trace *t, double length)
{
    return (int)(t->time[t->rows - 1] / length) + 1;
}

// Sets how long the stretches are, longer than LACK_STRETCH where there would be too many
// of them, and how many all traces have.
static void lay_out_stretches(const identification *id, lack_model *model)
{
    double time = 0; // of all traces
    for (int k = 0; k < id->trace_count; k++) {
        const recorded_trace *t = &id->traces[k];
        time += t->time[t->rows - 1];
    }
    const double most = fmin(MOST_STRETCHES, MOST_NUMBERS / (double)id->residuals);
    model->length = fmax(LACK_STRETCH, time / most);
    for (int k = 0; k < id->trace_count; k++) {
        model->count += stretches_of(&id->traces[k], model->length);
    }
}

// Finds how the residuals of a trace change with the command in each of its stretches, by
// runs that are pushed there; the columns begin at `column`.
static status push_stretches(identification *id, int number, double length,
                             const double *x, double *column, fault *f)
{
    recorded_trace *t = &id->traces[number];
    const size_t m = id->residuals;
    double *const recorded = t->command;
    SCOPED(free_kept) double *pushed = calloc(t->rows, sizeof *pushed);
    if (pushed == NULL) {
        return fault_no_memory(f);
    }
    double largest = 0;
    for (size_t i = 0; i < t->rows; i++) {
        largest = fmax(largest, fabs(recorded[i]));
    }
    if (largest == 0) {
        largest = id->base->parameters.motor.voltage_limit;
    }
    const double volts = PUSH * largest;
    const int count = stretches_of(t, length);
    for (int stretch = 0; stretch < count && volts > 0; stretch++, column += m) {
        for (size_t i = 0; i < t->rows; i++) {
            pushed[i] = recorded[i];
            if ((int)(t->time[i] / length) == stretch) {
                pushed[i] += volts;
            }
        }
        memcpy(column, id->residual, m * sizeof *column);
        t->command = pushed;
        const status code = identify_evaluate(id, x, 1, &number, false, column, NULL, f);
        t->command = recorded;
        if (code != STATUS_OK) {
            return code;
        }
        identify_add_scaled(column, -1, id->residual, m);
        for (size_t i = 0; i < m; i++) {
            column[i] /= volts;
        }
    }
    return STATUS_OK;
}

// Turns what moves the parameters, A' r in sums[count], into how far it does: J^-1 times
// it, J with its eigenvalues, without directions that are not determined.
static void solve_information(const identification *id, const double *values,
                              double *sums)
{
    const int p = id->count;
    double share[IDENTIFY_PATHS] = {0};
    for (int k = id->undetermined; k < p; k++) {
        const double *v = id->direction + k * p;
        const double along = identify_dot(v, sums, (size_t)p) / values[k];
        identify_add_scaled(share, along, v, (size_t)p);
    }
    memcpy(sums, share, (size_t)p * sizeof *sums);
}

// Splits columns of changes of the residuals into what they do to the parameters, their
// shares, and what no unknown explains, which stays in them.
static bool split_columns(const identification *id, const lack_model *model,
                          double *columns, double *shares, int count)
{
    const size_t m = id->residuals, p = (size_t)id->count;
    for (int b = 0; b < count; b++) {
        double *share = shares + (size_t)b * p;
        for (size_t a = 0; a < p; a++) {
            share[a] = identify_dot(model->alone + a * m, columns + (size_t)b * m, m);
        }
        solve_information(id, model->values, share);
    }
    if (!identify_leave_own(id, model->jacobian, columns, count)) {
        return false;
    }
    for (int b = 0; b < count; b++) {
        for (size_t a = 0; a < p; a++) {
            identify_add_scaled(columns + (size_t)b * m, -shares[(size_t)b * p + a],
                                model->alone + a * m, m);
        }
    }
    return true;
}

// Finds the eigenvectors and eigenvalues of the columns' products D'D.
static status decompose_columns(const identification *id, lack_model *model, fault *f)
{
    const size_t m = id->residuals, n = (size_t)model->count;
    SCOPED(free_kept) double *scratch = calloc(2 * n, sizeof *scratch);
    if (scratch == NULL) {
        return fault_no_memory(f);
    }
    double *products = model->vectors;
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j <= i; j++) {
            products[i * n + j] = products[j * n + i] =
                identify_dot(model->columns + i * m, model->columns + j * m, m);
        }
    }
    FAULT_IF(!symmetric_eigen((int)n, products, model->sizes, scratch), f,
             STATUS_SINGULAR, "the parameters' errors cannot be computed");
    return STATUS_OK;
}

// Sets c[count] to D'r of residuals r, along the eigenvectors.
static void turn_residuals(const lack_model *model, const double *residual, size_t m,
                           double *c)
{
    const size_t n = (size_t)model->count;
    memset(c, 0, n * sizeof *c);
    for (size_t i = 0; i < n; i++) {
        const double product = identify_dot(model->columns + i * m, residual, m);
        for (size_t k = 0; k < n; k++) {
            c[k] += model->vectors[k * n + i] * product;
        }
    }
}

// Finds the scales under which residuals of n degrees of freedom are most likely,
// `squares` being their sum r'r and c[count] as turn_residuals leaves them: where twice
// the negative logarithm of the likelihood is least, with l the eigenvalues of D'D
//
//     sum of log(1 + g^2 l) + n log s^2 + Q/s^2,
//     Q = r'r - g^2 sum of c^2/(1 + g^2 l),  s^2 = Q/n, but no less than 1
static lack_scales find_scales(const lack_model *model, double freedom, double squares,
                               const double *c)
{
    lack_scales best = {(double)NAN, 1, HUGE_VAL};
    double size = 0;
    for (int k = 0; k < model->count; k++) {
        size += model->sizes[k];
    }

    // from a command that does next to nothing to one that does all
    for (int i = 0; i < STRENGTHS && size > 0; i++) {
        const double strength = plain_pow(10, (double)i / A_DECADE - 2) / size;
        double taken = 0, unlikelihood = 0;
        for (int k = 0; k < model->count; k++) {
            const double spread = 1 + strength * fmax(model->sizes[k], 0);
            taken += strength * c[k] * c[k] / spread;
            unlikelihood += plain_log(spread);
        }
        const double scale = fmax((squares - taken) / freedom, 1);
        unlikelihood += freedom * plain_log(scale) + (squares - taken) / scale;
        if (unlikelihood < best.unlikelihood) {
            best = (lack_scales){strength, scale, unlikelihood};
        }
    }
    return best;
}

// Sets the covariance to what noise and the command give.
static void set_covariance(identification *id, const lack_model *model)
{
    const lack_scales *scales = &model->scales;
    const size_t p = (size_t)id->count;
    memset(id->covariance, 0, sizeof id->covariance);
    for (size_t a = 0; a < p; a++) {
        double *row = id->covariance + a * p;
        row[a] = scales->scale;
        solve_information(id, model->values, row);
        for (size_t b = 0; b < p * (size_t)model->count; b += p) {
            const double moved = scales->scale * scales->strength * model->shares[b + a];
            identify_add_scaled(row, moved, model->shares + b, p);
        }
    }
}

// Finds what each stretch of the command does, at the fit's result.
static status find_columns(identification *id, lack_model *model, fault *f)
{
    double x[IDENTIFY_UNKNOWNS];
    identify_result(id, x);
    double *column = model->columns;
    for (int k = 0; k < id->trace_count; k++) {
        TRY(push_stretches(id, k, model->length, x, column, f));
        column += (size_t)stretches_of(&id->traces[k], model->length) * id->residuals;
    }
    FAULT_IF(!split_columns(id, model, model->columns, model->shares, model->count), f,
             STATUS_SINGULAR, "the parameters' errors cannot be computed");
    return STATUS_OK;
}

bool lack_find_scales(const identification *id, const lack_model *model, double *residual,
                      lack_scales *found)
{
    const size_t m = id->residuals;
    double explained[IDENTIFY_PATHS], most;
    if (!split_columns(id, model, residual, explained, 1)) {
        return false;
    }
    const double freedom = id->chi_square / identify_misfit(id, &most);
    const double squares = identify_dot(residual, residual, m);
    turn_residuals(model, residual, m, model->room);
    *found = find_scales(model, freedom, squares, model->room);
    return true;
}

void lack_finish(lack_model *model)
{
    free(model->columns);
}

status lack_find_command(identification *id, lack_model *model, fault *f)
{
    lay_out_stretches(id, model);
    const size_t m = id->residuals, n = (size_t)model->count, p = (size_t)id->count;
    SCOPED(free_kept) double *residual = calloc(m, sizeof *residual);
    model->columns = calloc(n * (m + p + n + 2), sizeof *model->columns);
    if (residual == NULL || model->columns == NULL) {
        return fault_no_memory(f);
    }
    model->shares = model->columns + n * m;
    model->vectors = model->shares + n * p;
    model->sizes = model->vectors + n * n;
    model->room = model->sizes + n;
    TRY(find_columns(id, model, f));
    TRY(decompose_columns(id, model, f));
    memcpy(residual, id->residual, m * sizeof *residual);
    if (!lack_find_scales(id, model, residual, &model->scales)) {
        return fault_no_memory(f);
    }
    const double command = sqrt(model->scales.strength * model->scales.scale);
    if (command < id->base->parameters.motor.voltage_limit) {
        set_covariance(id, model);
        id->lack.command = command;
        id->lack.stretch = model->length;
    }
    return STATUS_OK;
}
