// How well parameters are known, and whether the model is one.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/dense.h"
#include "src/base/plain_math.h"
#include "src/study/identify.h"

#define QUANTILE 1.959963984540054 // of 95 %
#define BLOCK    0.05              // in which residuals may be correlated [s]
// singular value below which a combination is off by all its value
#define LEAST_KNOWN 1.0
#define NO_SAY      1e-12 // share of the largest eigenvalue below which there is none
// standard normal deviate that white residuals exceed once in 4000
#define WHITE       3.5
#define NOISE_KNOWN 2.0 // factor within which a bench knows its noise
// standard deviations that chi square is not above its mean by chance
#define CHANCE 5.0

// --- whiteness -------------------------------------------------------------------------

// Ljung and Box's statistic of a series in which 0 deviations are gaps, as a number that
// is standard normal for white noise (Wilson and Hilferty's transformation of chi
// square).
static double whiteness_of(const double *series, const double *deviation, size_t rows,
                           double *rms)
{
    double squares = 0, q = 0;
    size_t count = 0;
    for (size_t i = 0; i < rows; i++) {
        squares += series[i] * series[i];
        if (deviation[i] > 0) {
            count++;
        }
    }
    if (count > 0) {
        *rms = sqrt(squares / (double)count);
    } else {
        *rms = (double)NAN;
    }
    if (count < 5 * IDENTIFY_LAGS || squares == 0) {
        return (double)NAN;
    }
    for (size_t lag = 1; lag <= IDENTIFY_LAGS; lag++) {
        double product = 0;
        for (size_t i = lag; i < rows; i++) {
            product += series[i] * series[i - lag];
        }
        q += product / squares * (product / squares) / (double)(count - lag);
    }
    q *= (double)count * (double)(count + 2);
    const double k = IDENTIFY_LAGS, spread = 2 / (9 * k);
    return (plain_pow(q / k, 1.0 / 3) - (1 - spread)) / sqrt(spread);
}

// Of every channel; that of an encoder, whose steps are no noise, counts where it is
// alone.
static status judge_whiteness(identification *id, fault *f)
{
    const double *residual = id->residual;
    id->white = true;
    for (int k = 0; k < id->trace_count; k++) {
        recorded_trace *t = &id->traces[k];
        SCOPED(free_kept) double *series = calloc(t->rows, sizeof *series);
        if (series == NULL) {
            return fault_no_memory(f);
        }
        const bool alone = t->reading[CHANNEL_TACHOMETER] == NULL;
        for (int c = 0; c < CHANNELS; c++) {
            t->rms[c] = t->whiteness[c] = (double)NAN;
            if (t->reading[c] == NULL) {
                continue;
            }
            for (size_t i = 0; i < t->rows; i++) {
                if (t->deviation[c][i] > 0) {
                    series[i] = *residual++;
                } else {
                    series[i] = 0;
                }
            }
            t->whiteness[c] = whiteness_of(series, t->deviation[c], t->rows, &t->rms[c]);
            const bool counts = c != CHANNEL_ENCODER || alone;
            id->white = id->white && !(counts && t->whiteness[c] > WHITE);
        }
        residual += t->contact_count;
    }
    return STATUS_OK;
}

// --- sums ------------------------------------------------------------------------------

static double dot(const double *a, const double *b, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

static void add_scaled(double *to, double factor, const double *a, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        to[i] += factor * a[i];
    }
}

// --- errors ----------------------------------------------------------------------------

// What the parameters' columns of the Jacobian say that the traces' own cannot: what is
// left of them when their projections on the latter, as far as these say anything, are
// taken off. alone[p * residuals].
static bool orthogonalise(const identification *id, const double *jacobian, double *alone)
{
    const size_t m = id->residuals;
    const int p = id->count, q = id->unknowns - p;
    double size[IDENTIFY_UNKNOWNS], own[IDENTIFY_UNKNOWNS * IDENTIFY_UNKNOWNS],
        values[IDENTIFY_UNKNOWNS], scratch[2 * IDENTIFY_UNKNOWNS];
    memcpy(alone, jacobian, (size_t)p * m * sizeof *alone);
    for (int i = 0; i < q; i++) {
        const double square =
            dot(jacobian + (size_t)(p + i) * m, jacobian + (size_t)(p + i) * m, m);
        if (square > 0) {
            size[i] = sqrt(square);
        } else {
            size[i] = 1;
        }
        for (int j = 0; j <= i; j++) {
            own[i * q + j] = own[j * q + i] =
                dot(jacobian + (size_t)(p + i) * m, jacobian + (size_t)(p + j) * m, m) /
                (size[i] * size[j]);
        }
    }
    SCOPED(free_kept) double *along = calloc(m, sizeof *along);
    if (along == NULL || (q > 0 && !symmetric_eigen(q, own, values, scratch))) {
        return false;
    }
    for (int k = 0; k < q; k++) {
        if (values[k] < NO_SAY * values[q - 1]) {
            continue;
        }
        memset(along, 0, m * sizeof *along);
        for (int j = 0; j < q; j++) {
            add_scaled(along, own[k * q + j] / size[j], jacobian + (size_t)(p + j) * m,
                       m);
        }
        for (int i = 0; i < p; i++) {
            add_scaled(alone + (size_t)i * m,
                       -dot(alone + (size_t)i * m, along, m) / values[k], along, m);
        }
    }
    return true;
}

// Of one channel of all traces, for each parameter: the products of the columns, and the
// sum over blocks of the square of (sum in the block of a r).
typedef struct channel_sums {
    double products[IDENTIFY_PATHS * IDENTIFY_PATHS], squares[IDENTIFY_PATHS];
} channel_sums;

// Ends a block: its sums are squared and begin anew.
static void end_block(channel_sums *of, double *sums, int count)
{
    for (int a = 0; a < count; a++) {
        of->squares[a] += sums[a] * sums[a];
        sums[a] = 0;
    }
}

// Adds a channel of a trace, whose first residual is number `at`.
static void add_readings(const identification *id, const recorded_trace *t, int channel,
                         const double *alone, size_t at, channel_sums *of)
{
    const size_t m = id->residuals;
    const int p = id->count;
    const double *read = t->reading[channel];
    double sums[IDENTIFY_PATHS] = {0}, begun = -HUGE_VAL;
    for (size_t i = 0; i < t->rows; i++) {
        // a reading that stays is one reading: no block ends in it
        const bool stays = i > 0 && read[i] == read[i - 1];
        if (t->time[i] - begun >= BLOCK && !stays) {
            begun = t->time[i];
            end_block(of, sums, p);
        }
        if (!(t->deviation[channel][i] > 0)) {
            continue;
        }
        for (int a = 0; a < p; a++) {
            sums[a] += alone[(size_t)a * m + at] * id->residual[at];
            for (int b = 0; b < p; b++) {
                of->products[a * p + b] +=
                    alone[(size_t)a * m + at] * alone[(size_t)b * m + at];
            }
        }
        at++;
    }
    end_block(of, sums, p);
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

// How far the residuals of a channel of all traces scatter where the parameters look:
// over blocks that are longer than what correlates them,
//
//     rho = sum over parameters and blocks of (sum in the block of a r)^2 / sum of a^2
//
// with a the parameter's column, of size 1. It is 1 for white residuals of deviation 1,
// below for the rounding of an encoder that moves, which has no slow part, above for what
// the model lacks. Its weight goes to information[], that of the channel to scatter[].
static void add_channel(const identification *id, int channel, const double *alone,
                        double *information, double *scatter)
{
    const int p = id->count;
    channel_sums of = {0};
    size_t at = 0;
    for (int k = 0; k < id->trace_count; k++) {
        const recorded_trace *t = &id->traces[k];
        for (int c = 0; c < CHANNELS; c++) {
            if (c == channel && t->reading[c] != NULL) {
                add_readings(id, t, c, alone, at, &of);
            }
            at += residuals_of_channel(t, c);
        }
        at += (size_t)t->contact_count;
    }

    // the mean over the parameters that look at this channel
    double rho = 0;
    int looking = 0;
    for (int a = 0; a < p; a++) {
        if (of.products[a * p + a] > 0) {
            rho += of.squares[a] / of.products[a * p + a];
            looking++;
        }
    }
    if (looking > 0) {
        rho = rho / looking;
    } else {
        rho = 1;
    }
    for (int i = 0; i < p * p; i++) {
        information[i] += of.products[i];
        scatter[i] += rho * of.products[i];
    }
}

// The instants of touches, each with the deviation that it has.
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

// The covariance of what is determined: with the information's eigenvectors v and values
// l,
//
//     sum over k and j of v_k (v_k' S v_j) / (l_k l_j) v_j',   S the scatter (White's
//     estimator).
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

status identify_judge(identification *id, const double *jacobian, fault *f)
{
    const int p = id->count;
    double scratch[2 * IDENTIFY_PATHS], values[IDENTIFY_PATHS];
    double scatter[IDENTIFY_PATHS * IDENTIFY_PATHS] = {0};
    id->chi_square = dot(id->residual, id->residual, id->residuals);
    id->aic = id->chi_square + 2 * id->unknowns;
    TRY(judge_whiteness(id, f));
    if (p == 0) {
        return STATUS_OK;
    }

    // what each channel says of the parameters, and how far it scatters
    SCOPED(free_kept) double *alone = calloc((size_t)p * id->residuals, sizeof *alone);
    if (alone == NULL) {
        return fault_no_memory(f);
    }
    bool done = orthogonalise(id, jacobian, alone);
    memset(id->direction, 0, sizeof id->direction);
    for (int c = 0; c < CHANNELS && done; c++) {
        add_channel(id, c, alone, id->direction, scatter);
    }
    if (done) {
        add_contacts(id, alone, id->direction, scatter);
    }
    FAULT_IF(!done || !symmetric_eigen(p, id->direction, values, scratch), f,
             STATUS_SINGULAR, "the parameters' errors cannot be computed");

    // what the model does not explain makes errors larger, by as much
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
    for (int i = 0; i < p; i++) {
        fitted_parameter *fit = &id->fit[i];
        double part = 0;
        for (int k = 0; k < id->undetermined; k++) {
            part += id->direction[k * p + i] * id->direction[k * p + i];
        }
        fit->determined = part < IDENTIFY_PART;
        if (fit->determined) {
            fit->standard_error = id->fit[i].scale * sqrt(id->covariance[i * p + i]);
        } else {
            fit->standard_error = (double)NAN;
        }
        fit->low = fit->value - QUANTILE * fit->standard_error;
        fit->high = fit->value + QUANTILE * fit->standard_error;
    }
    return STATUS_OK;
}

// Chi square has as many degrees of freedom n as there are readings more than unknowns;
// noise alone gives it the mean n and the standard deviation sqrt(2 n).
double identify_misfit(const identification *id, double *most)
{
    const double freedoms = (double)(id->residuals - (size_t)(id->unknowns + id->count));
    *most = NOISE_KNOWN * NOISE_KNOWN * (1 + CHANCE * sqrt(2 / freedoms));
    return id->chi_square / freedoms;
}
