// Errors of parameters where the model lacks something: residuals that stay correlated
// are no noise, so they say themselves how far they could lead.
//
// With a column a of the Jacobian for each parameter, freed of what the traces' own
// unknowns explain, and the information J = sum of a a', residuals r move the parameters
// by J^-1 sum of a r, to which a stretch b of time gives e_b = J^-1 sum in b of a r. The
// wild bootstrap of blocks (Shao, The dependent wild bootstrap, J. Am. Stat. Assoc. 105,
// 2010) draws a sign w_b of each stretch, of all channels at once:
//
//     sum over b of w_b e_b
//
// is an error that could have been. Stretches have to be longer than residuals are
// correlated: their length is doubled as long as there are enough of them, and the one
// that gives the widest errors counts.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/base/random.h"
#include "src/study/identify/identify.h"

#define TAIL 0.025 // share of the draws below a 95 % interval

enum {
    DRAWS = 2000,
    LEAST_BLOCKS = 10,     // that say something,
    BLOCKS_A_PARAMETER = 3 // and of each parameter
};

// The errors that one length of blocks gives.
typedef struct drawn_errors {
    double covariance[IDENTIFY_PATHS * IDENTIFY_PATHS]; // in the parameters' scales
    double low[IDENTIFY_PATHS], high[IDENTIFY_PATHS];   // ends of 95 % of them
} drawn_errors;

// Adds a residual to the sums of the block at its time.
static void add_residual(const identification *id, const double *alone, size_t at,
                         double *block)
{
    for (int a = 0; a < id->count; a++) {
        block[a] += alone[(size_t)a * id->residuals + at] * id->residual[at];
    }
}

// Sums a r over the blocks of a trace, sums[blocks * count]; its residuals begin at `at`.
static void sum_trace(const identification *id, const recorded_trace *t,
                      const double *alone, double length, size_t at, double *sums)
{
    const size_t p = (size_t)id->count;
    for (int c = 0; c < CHANNELS; c++) {
        for (size_t i = 0; t->reading[c] != NULL && i < t->rows; i++) {
            if (t->deviation[c][i] > 0) {
                add_residual(id, alone, at++, sums + (size_t)(t->time[i] / length) * p);
            }
        }
    }
    for (int i = 0; i < t->contact_count; i++) {
        add_residual(id, alone, at++, sums + (size_t)(t->contacts[i] / length) * p);
    }
}

// How many blocks of a length a trace has.
static size_t blocks_of(const recorded_trace *t, double length)
{
    return (size_t)(t->time[t->rows - 1] / length) + 1;
}

// Turns the sums of each block into what it gives to the parameters: J^-1 times them, J
// with its eigenvalues, without directions that are not determined. Returns how many
// blocks have a residual.
static size_t find_shares(const identification *id, const double *values, double *sums,
                          size_t blocks)
{
    const int p = id->count;
    size_t filled = 0;
    for (size_t b = 0; b < blocks; b++, sums += p) {
        double share[IDENTIFY_PATHS] = {0};
        bool any = false;
        for (int a = 0; a < p; a++) {
            any = any || sums[a] != 0;
        }
        for (int k = id->undetermined; k < p; k++) {
            const double *v = id->direction + k * p;
            double along = 0;
            for (int a = 0; a < p; a++) {
                along += v[a] * sums[a] / values[k];
            }
            for (int a = 0; a < p; a++) {
                share[a] += along * v[a];
            }
        }
        memcpy(sums, share, (size_t)p * sizeof *sums);
        if (any) {
            filled++;
        }
    }
    return filled;
}

// Draws errors from the shares of the blocks. As residuals are smaller than errors by the
// parameters that were fitted to them, they grow by sqrt(blocks/(blocks - parameters)).
static status draw_errors(const identification *id, const double *shares, size_t blocks,
                          size_t filled, drawn_errors *to, fault *f)
{
    const int p = id->count;
    const double growth = sqrt((double)filled / (double)(filled - (size_t)p));
    random_generator random;
    SCOPED(free_kept) double *drawn = calloc((size_t)p * DRAWS, sizeof *drawn);
    if (drawn == NULL) {
        return fault_no_memory(f);
    }
    memset(to, 0, sizeof *to);
    random_seed(&random, id->seed);
    for (size_t n = 0; n < DRAWS; n++) {
        double error[IDENTIFY_PATHS] = {0};
        for (size_t b = 0; b < blocks; b++) {
            const double sign = random_uniform(&random) < 0.5 ? -growth : growth;
            for (int a = 0; a < p; a++) {
                error[a] += sign * shares[b * (size_t)p + (size_t)a];
            }
        }
        for (int a = 0; a < p; a++) {
            drawn[(size_t)a * DRAWS + n] = error[a];
            for (int b = 0; b < p; b++) {
                to->covariance[a * p + b] += error[a] * error[b] / DRAWS;
            }
        }
    }
    for (int a = 0; a < p; a++) {
        double *sorted = drawn + (size_t)a * DRAWS;
        qsort(sorted, DRAWS, sizeof *sorted, compare_numbers);
        to->low[a] = sorted[(size_t)(TAIL * DRAWS)];
        to->high[a] = sorted[(size_t)((1 - TAIL) * DRAWS) - 1];
    }
    return STATUS_OK;
}

// The errors that blocks of a length give; *enough: whether there are enough of them.
static status errors_of_length(const identification *id, const double *alone,
                               const double *values, double length, bool *enough,
                               drawn_errors *to, fault *f)
{
    const size_t p = (size_t)id->count;
    size_t blocks = 0, first = 0, at = 0;
    for (int k = 0; k < id->trace_count; k++) {
        blocks += blocks_of(&id->traces[k], length);
    }
    SCOPED(free_kept) double *sums = calloc(blocks * p, sizeof *sums);
    if (sums == NULL) {
        return fault_no_memory(f);
    }
    for (int k = 0; k < id->trace_count; k++) {
        const recorded_trace *t = &id->traces[k];
        sum_trace(id, t, alone, length, at, sums + first * p);
        first += blocks_of(t, length);
        at += t->residuals;
    }
    const size_t filled = find_shares(id, values, sums, blocks);
    *enough = filled >= LEAST_BLOCKS && filled >= BLOCKS_A_PARAMETER * p;
    if (!*enough) {
        return STATUS_OK;
    }
    return draw_errors(id, sums, blocks, filled, to, f);
}

// How wide errors are beside those of the fit's covariance: the mean of the ratios of
// their variances.
static double width_of(const identification *id, const drawn_errors *errors)
{
    const int p = id->count;
    double width = 0;
    for (int a = 0; a < p; a++) {
        if (id->covariance[a * p + a] > 0) {
            width += errors->covariance[a * p + a] / id->covariance[a * p + a];
        }
    }
    return width;
}

status identify_bootstrap(identification *id, const double *alone, const double *values,
                          fault *f)
{
    drawn_errors errors, widest;
    double width = 0;
    bool enough = true;
    id->block = (double)NAN;
    for (double length = IDENTIFY_BLOCK; enough; length *= 2) {
        TRY(errors_of_length(id, alone, values, length, &enough, &errors, f));
        if (enough && width_of(id, &errors) > width) {
            width = width_of(id, &errors);
            widest = errors;
            id->block = length;
        }
    }
    if (isnan(id->block)) {
        return STATUS_OK;
    }

    memcpy(id->covariance, widest.covariance, sizeof id->covariance);
    for (int i = 0; i < id->count; i++) {
        fitted_parameter *fit = &id->fit[i];
        fit->low = fit->value + fit->scale * widest.low[i];
        fit->high = fit->value + fit->scale * widest.high[i];
    }
    return STATUS_OK;
}
