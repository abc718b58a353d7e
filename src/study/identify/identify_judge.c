// Judges a fit: how well its parameters are known.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/dense.h"
#include "src/study/identify/identify_lack.h"

// Quantile of the normal distribution: 95 % below.
#define QUANTILE_BELOW 1.644853626951473
// singular value below which the error of a combination exceeds its value
#define LEAST_KNOWN 1.0

// --- errors ----------------------------------------------------------------------------

// Sums over one channel of all traces, a and b being columns of parameters and r
// residuals: the products a b, and for each parameter the squares of every block's sum of
// a r.
typedef struct channel_sums {
    double products[IDENTIFY_PATHS * IDENTIFY_PATHS], squares[IDENTIFY_PATHS];
} channel_sums;

// Ends a block: adds the squares of its sums and sets them back to 0.
static void end_block(channel_sums *channel, double *block, int count)
{
    for (int a = 0; a < count; a++) {
        channel->squares[a] += block[a] * block[a];
        block[a] = 0;
    }
}

// Adds one channel of a trace to the sums; its first residual is number `at` of all.
static void add_readings(const identification *id, const recorded_trace *t, int channel,
                         const double *alone, size_t at, channel_sums *sums)
{
    const size_t m = id->residuals;
    const int p = id->count;
    const double *reading = t->reading[channel];
    double block[IDENTIFY_PATHS] = {0}, block_start = -HUGE_VAL;
    for (size_t i = 0; i < t->rows; i++) {
        // samples that repeat a reading are one reading: no block ends among them
        const bool repeats = i > 0 && reading[i] == reading[i - 1];
        if (t->time[i] - block_start >= IDENTIFY_BLOCK && !repeats) {
            block_start = t->time[i];
            end_block(sums, block, p);
        }
        if (!(t->deviation[channel][i] > 0)) {
            continue;
        }
        for (int a = 0; a < p; a++) {
            block[a] += alone[(size_t)a * m + at] * id->residual[at];
            for (int b = 0; b < p; b++) {
                sums->products[a * p + b] +=
                    alone[(size_t)a * m + at] * alone[(size_t)b * m + at];
            }
        }
        at++;
    }
    end_block(sums, block, p);
}

// How many residuals a channel of a trace has.
static size_t residuals_of_channel(const recorded_trace *t, int channel)
{
    size_t count = 0;
    for (size_t i = 0; t->reading[channel] != NULL && i < t->rows; i++) {
        if (t->deviation[channel][i] > 0) {
            count++;
        }
    }
    return count;
}

// The mean square of a channel's residuals in all traces; NaN where those of a trace are
// not white, or too few to say.
static double white_square(const identification *id, int channel)
{
    double squares = 0, count = 0;
    for (int k = 0; k < id->trace_count; k++) {
        const recorded_trace *t = &id->traces[k];
        const double of_trace = t->independent[channel];
        if (of_trace > 0 && !(t->whiteness[channel] < IDENTIFY_WHITE)) {
            return (double)NAN;
        }
        if (of_trace > 0) {
            squares += of_trace * t->rms[channel] * t->rms[channel];
            count += of_trace;
        }
    }
    return squares / count;
}

// Adds a channel of all traces to the information, the products of the parameters'
// columns, and to the scatter, which is that times how far the channel's residuals r
// scatter where a parameter with the column a shows: over blocks longer than residuals
// are correlated,
//
//     rho = mean over parameters of: sum over blocks of (sum in the block of a r)^2 over
//           the sum of a^2
//
// It is below 1 for the rounding of an encoder that moves, which has no slow part, and
// above it where the model lacks something. Of white residuals it is their mean square,
// which few blocks tell less well.
static void add_channel(const identification *id, int channel, const double *alone,
                        double *information, double *scatter)
{
    const int p = id->count;
    channel_sums sums = {0};
    size_t at = 0; // number of the first residual of a channel of a trace
    for (int k = 0; k < id->trace_count; k++) {
        const recorded_trace *t = &id->traces[k];
        for (int c = 0; c < CHANNELS; c++) {
            if (c == channel && t->reading[c] != NULL) {
                add_readings(id, t, c, alone, at, &sums);
            }
            at += residuals_of_channel(t, c);
        }
        at += (size_t)t->contact_count;
    }

    // the mean over the parameters that show in this channel
    double rho = 0;
    int shown = 0;
    for (int a = 0; a < p; a++) {
        if (sums.products[a * p + a] > 0) {
            rho += sums.squares[a] / sums.products[a * p + a];
            shown++;
        }
    }
    if (shown > 0) {
        rho = rho / shown;
    } else {
        rho = 1;
    }
    const double white = white_square(id, channel);
    if (white > 0) {
        rho = white;
    }
    for (int i = 0; i < p * p; i++) {
        information[i] += sums.products[i];
        scatter[i] += rho * sums.products[i];
    }
}

// Adds the instants of touches, the last residuals of each trace, to information and
// scatter. Each scatters by its own residual, or by 1 if that is less.
static void add_contacts(const identification *id, const double *alone,
                         double *information, double *scatter)
{
    const size_t m = id->residuals;
    const int p = id->count;
    size_t at = 0;
    for (int k = 0; k < id->trace_count; k++) {
        const recorded_trace *t = &id->traces[k];
        const size_t end = at + t->residuals;
        for (size_t r = end - (size_t)t->contact_count; r < end; r++) {
            for (int a = 0; a < p * p; a++) {
                const double both =
                    alone[(size_t)(a / p) * m + r] * alone[(size_t)(a % p) * m + r];
                information[a] += both;
                scatter[a] += both * fmax(1, id->residual[r] * id->residual[r]);
            }
        }
        at = end;
    }
}

// The covariance of the parameters by White's estimator, J^-1 S J^-1, J being the
// information and S the scatter. With the eigenvectors v and eigenvalues l of J, of which
// only those count that are determined, it is
//
//     sum over k and j of v_k (v_k' S v_j)/(l_k l_j) v_j'
static void find_covariance(identification *id, const double *values,
                            const double *scatter)
{
    const int p = id->count;
    memset(id->covariance, 0, sizeof id->covariance);
    for (int k = 0; k < p; k++) {
        for (int j = 0; j < p; j++) {
            if (id->singular[k] < LEAST_KNOWN || id->singular[j] < LEAST_KNOWN) {
                continue;
            }
            const double *v = id->direction + k * p, *w = id->direction + j * p;
            double between = 0;
            for (int a = 0; a < p * p; a++) {
                between += v[a / p] * scatter[a] * w[a % p];
            }
            for (int a = 0; a < p * p; a++) {
                id->covariance[a] +=
                    v[a / p] * between / (values[k] * values[j]) * w[a % p];
            }
        }
    }
}

// The errors and the interval of parameter i, from the covariance; `part` is the share of
// it that lies in combinations which are not determined.
static void find_interval(identification *id, int i, double part)
{
    fitted_parameter *fit = &id->fit[i];
    const double least = sweep_axis_parameter(&fit->axis)->minimum;
    fit->determined = part < IDENTIFY_PART;
    fit->one_sided = least == 0 && fit->value == 0;
    fit->standard_error = fit->scale * sqrt(id->covariance[i * id->count + i]);
    if (!fit->determined || (!id->white && isnan(id->lack.command))) {
        fit->standard_error = (double)NAN;
    }
    fit->low = fit->value - IDENTIFY_QUANTILE * fit->standard_error;
    fit->high = fit->value + IDENTIFY_QUANTILE * fit->standard_error;

    // what cannot be less than nothing is not below it, and at it it has an upper limit
    if (!fit->determined) {
        fit->low = fit->high = (double)NAN;
    } else if (fit->one_sided) {
        fit->low = 0;
        fit->high = QUANTILE_BELOW * fit->standard_error;
    } else if (least == 0 && fit->low < 0) {
        fit->low = 0;
    }
}

status identify_judge(identification *id, const double *jacobian, fault *f)
{
    const int p = id->count;
    double scratch[2 * IDENTIFY_PATHS], values[IDENTIFY_PATHS];
    double scatter[IDENTIFY_PATHS * IDENTIFY_PATHS] = {0};
    id->chi_square = identify_dot(id->residual, id->residual, id->residuals);
    id->aic = id->chi_square + 2 * id->unknowns;
    TRY(identify_explain(id, f));
    if (p == 0) {
        return STATUS_OK;
    }

    // the information on the parameters of all channels and touches, and its scatter
    SCOPED(free_kept) double *alone = calloc((size_t)p * id->residuals, sizeof *alone);
    if (alone == NULL) {
        return fault_no_memory(f);
    }
    memcpy(alone, jacobian, (size_t)p * id->residuals * sizeof *alone);
    bool done = identify_leave_own(id, jacobian, alone, p);
    memset(id->direction, 0, sizeof id->direction);
    for (int c = 0; c < CHANNELS && done; c++) {
        add_channel(id, c, alone, id->direction, scatter);
    }
    if (done) {
        add_contacts(id, alone, id->direction, scatter);
    }
    FAULT_IF(!done || !symmetric_eigen(p, id->direction, values, scratch), f,
             STATUS_SINGULAR, "the parameters' errors cannot be computed");

    // the sizes of the information; what the model does not explain lowers them
    double most;
    const double misfit = fmax(1, identify_misfit(id, &most));
    id->undetermined = 0;
    for (int k = 0; k < p; k++) {
        id->singular[k] = sqrt(fmax(values[k] / misfit, 0));
        if (id->singular[k] < LEAST_KNOWN) {
            id->undetermined++;
        }
    }
    find_covariance(id, values, scatter);
    if (!id->white) {
        SCOPED(lack_finish)
        lack_model model = {.jacobian = jacobian, .alone = alone, .values = values};
        TRY(lack_find_command(id, &model, f));
        if (!isnan(id->lack.command)) {
            TRY(lack_allow_for_hub(id, &model, f));
        }
    }

    // a parameter with a part in combinations that are not determined is not known
    for (int i = 0; i < p; i++) {
        double part = 0;
        for (int k = 0; k < id->undetermined; k++) {
            part += id->direction[k * p + i] * id->direction[k * p + i];
        }
        find_interval(id, i, part);
    }
    return STATUS_OK;
}
