// Judges whether the model explains the recorded readings: how large its residuals are,
// whether they are noise, and where they are least so.
#include <math.h>
#include <stdlib.h>

#include "src/base/plain_math.h"
#include "src/rig/sensors.h"
#include "src/study/identify/identify.h"

#define NOISE_KNOWN 2.0 // factor within which a bench knows its noise
// standard deviations that chi square is not above its mean by chance
#define CHANCE 5.0

enum { LEAST_OF_STRETCH = 3 }; // readings

// --- whiteness -------------------------------------------------------------------------

// Whether a series of residuals is white noise: a number that is standard normal if it
// is. Ljung and Box's statistic, with r_lag the autocorrelation and n the count,
//
//     Q = n (n + 2) sum over lags of r_lag^2/(n - lag),
//
// is chi square with k = lags degrees of freedom, which Wilson and Hilferty's
// transformation makes normal: ((Q/k)^(1/3) - 1 + 2/(9 k))/sqrt(2/(9 k)). `count` of the
// rows are residuals; the others are gaps, of value 0. NaN of few.
static double whiteness_of(const double *series, size_t rows, size_t count)
{
    double squares = 0, statistic = 0;
    for (size_t i = 0; i < rows; i++) {
        squares += series[i] * series[i];
    }
    if (count < 5 * IDENTIFY_LAGS || squares == 0) {
        return (double)NAN;
    }
    for (size_t lag = 1; lag <= IDENTIFY_LAGS; lag++) {
        double product = 0;
        for (size_t i = lag; i < rows; i++) {
            product += series[i] * series[i - lag];
        }
        const double correlation = product / squares;
        statistic += correlation * correlation / (double)(count - lag);
    }
    statistic *= (double)count * (double)(count + 2);

    const double k = IDENTIFY_LAGS, variance = 2 / (9 * k);
    return (plain_pow(statistic / k, 1.0 / 3) - (1 - variance)) / sqrt(variance);
}

// --- a channel of a trace --------------------------------------------------------------

// The residuals of a channel of a trace.
typedef struct channel_residuals {
    recorded_trace *trace;
    int trace_number, channel;
    double *series; // of each row, in standard deviations; 0 in gaps
    size_t count;   // of rows that are no gaps
} channel_residuals;

// What a residual amounts to in the reading's unit. That of the FSR is in volts.
static double residual_in_unit(const channel_residuals *c, const sensor_parameters *s,
                               size_t row)
{
    const recorded_trace *t = c->trace;
    const double difference = c->series[row] * t->deviation[c->channel][row];
    const double reading = t->reading[c->channel][row];
    if (c->channel == CHANNEL_FSR) {
        return reading - fsr_force(s, fsr_volts(s, reading) - difference);
    }
    return difference;
}

// Finds how large the residuals of a channel are: over their noise, in the reading's
// unit, and as a share of how far the readings themselves scatter about their mean.
static void find_size(const channel_residuals *c, const sensor_parameters *sensor)
{
    recorded_trace *t = c->trace;
    double squares = 0, unit_squares = 0, mean = 0, scatter = 0;
    for (size_t i = 0; i < t->rows; i++) {
        if (t->deviation[c->channel][i] > 0) {
            const double in_unit = residual_in_unit(c, sensor, i);
            squares += c->series[i] * c->series[i];
            unit_squares += in_unit * in_unit;
            mean += t->reading[c->channel][i] / (double)c->count;
        }
    }
    for (size_t i = 0; i < t->rows; i++) {
        if (t->deviation[c->channel][i] > 0) {
            const double apart = t->reading[c->channel][i] - mean;
            scatter += apart * apart;
        }
    }
    t->rms[c->channel] = sqrt(squares / t->independent[c->channel]);
    t->rms_unit[c->channel] = sqrt(unit_squares / (double)c->count);
    t->explained[c->channel] = 1 - unit_squares / scatter;
}

// Ends a stretch of a channel, whose last row is before `end`: keeps it as the one that
// is explained worst if its squares are the most above those of noise, in standard
// deviations of a sum of squares.
static void end_stretch(identification *id, const channel_residuals *c, size_t begin,
                        size_t end, double *worst)
{
    const sensor_parameters *sensor = &id->base->parameters.sensor;
    const recorded_trace *t = c->trace;
    double squares = 0, unit_squares = 0;
    int count = 0;
    for (size_t i = begin; i < end; i++) {
        if (t->deviation[c->channel][i] > 0) {
            const double in_unit = residual_in_unit(c, sensor, i);
            squares += c->series[i] * c->series[i];
            unit_squares += in_unit * in_unit;
            count++;
        }
    }
    const double excess = (squares - count) / sqrt(2.0 * count);
    if (count >= LEAST_OF_STRETCH && excess > *worst) {
        *worst = excess;
        id->lack = (unexplained){.trace = c->trace_number,
                                 .channel = c->channel,
                                 .from = t->begin + t->time[begin],
                                 .to = t->begin + t->time[end - 1],
                                 .rms = sqrt(squares / count),
                                 .rms_unit = sqrt(unit_squares / count),
                                 .command = (double)NAN,
                                 .stretch = (double)NAN,
                                 .hub_spring = (double)NAN};
    }
}

// Looks for the stretch of IDENTIFY_BLOCK of a channel that is explained worst.
static void find_worst_stretch(identification *id, const channel_residuals *c,
                               double *worst)
{
    const recorded_trace *t = c->trace;
    size_t begin = 0;
    for (size_t i = 1; i <= t->rows; i++) {
        if (i == t->rows || t->time[i] - t->time[begin] >= IDENTIFY_BLOCK) {
            end_stretch(id, c, begin, i, worst);
            begin = i;
        }
    }
}

// Spreads the residuals of a channel, which begin at `residual`, over the rows.
static void spread_residuals(channel_residuals *c, const double *residual)
{
    const recorded_trace *t = c->trace;
    c->count = 0;
    for (size_t i = 0; i < t->rows; i++) {
        c->series[i] = 0;
        if (t->deviation[c->channel][i] > 0) {
            c->series[i] = residual[c->count++];
        }
    }
}

// Judges the channels of one trace, whose residuals begin at `residual`. The steps of an
// encoder are no noise: beside a tachometer it has no say in whether residuals are white.
static status judge_trace(identification *id, int number, const double *residual,
                          double *worst, fault *f)
{
    recorded_trace *t = &id->traces[number];
    SCOPED(free_kept) double *series = calloc(t->rows, sizeof *series);
    if (series == NULL) {
        return fault_no_memory(f);
    }
    const bool has_tachometer = t->reading[CHANNEL_TACHOMETER] != NULL;
    for (int channel = 0; channel < CHANNELS; channel++) {
        t->rms[channel] = t->rms_unit[channel] = t->explained[channel] =
            t->whiteness[channel] = (double)NAN;
        if (t->reading[channel] == NULL) {
            continue;
        }
        channel_residuals c = {.trace = t,
                               .trace_number = number,
                               .channel = channel,
                               .series = series};
        spread_residuals(&c, residual);
        residual += c.count;
        if (c.count == 0) {
            continue;
        }
        find_size(&c, &id->base->parameters.sensor);
        t->whiteness[channel] = whiteness_of(series, t->rows, c.count);
        const bool has_say = channel != CHANNEL_ENCODER || !has_tachometer;
        id->white = id->white && !(has_say && t->whiteness[channel] > IDENTIFY_WHITE);
        if (has_say) {
            find_worst_stretch(id, &c, worst);
        }
    }
    return STATUS_OK;
}

status identify_explain(identification *id, fault *f)
{
    const double *residual = id->residual;
    double worst = -HUGE_VAL;
    id->white = true;
    id->lack = (unexplained){.trace = -1,
                             .command = (double)NAN,
                             .stretch = (double)NAN,
                             .hub_spring = (double)NAN};
    for (int k = 0; k < id->trace_count; k++) {
        TRY(judge_trace(id, k, residual, &worst, f));
        residual += id->traces[k].residuals;
    }
    return STATUS_OK;
}

// --- chi square ------------------------------------------------------------------------

// Chi square has as many degrees of freedom n as there are independent readings more than
// unknowns; noise alone gives it the mean n and the standard deviation sqrt(2 n).
double identify_misfit(const identification *id, double *most)
{
    double freedom = -id->unknowns;
    for (int k = 0; k < id->trace_count; k++) {
        const recorded_trace *t = &id->traces[k];
        freedom += t->contact_count;
        for (int c = 0; c < CHANNELS; c++) {
            freedom += t->independent[c];
        }
    }
    freedom = fmax(freedom, 1);
    *most = NOISE_KNOWN * NOISE_KNOWN * (1 + CHANCE * sqrt(2 / freedom));
    return id->chi_square / freedom;
}

bool identify_explained(const identification *id)
{
    double most;
    return id->white && identify_misfit(id, &most) <= most;
}
