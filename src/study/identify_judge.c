// How well parameters are known, whether the model is one, and the result as JSON and as a set.
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/dense.h"
#include "src/base/json.h"
#include "src/base/numbers.h"
#include "src/base/plain_math.h"
#include "src/base/random.h"
#include "src/study/identify.h"

#define QUANTILE    1.959963984540054 // of 95 %
#define BLOCK       0.05              // in which residuals may be correlated [s]
#define LEAST_KNOWN 1.0   // singular value below which a combination is off by all its value
#define HAS_A_PART  1e-6  // of a direction: smaller ones do not make a parameter undetermined
#define NO_SAY      1e-12 // share of the largest eigenvalue below which there is none
#define WHITE       3.5   // standard normal deviate that white residuals exceed once in 4000
#define NOISE_KNOWN 2.0   // factor within which a bench knows its noise
#define CHANCE      5.0   // standard deviations that chi square is not above its mean by chance

// --- whiteness --------------------------------------------------------------------------------

// Ljung and Box's statistic of a series in which 0 deviations are gaps, as a number that is
// standard normal for white noise (Wilson and Hilferty's transformation of chi square).
static double whiteness_of(const double *series, const double *deviation, size_t rows, double *rms)
{
    double squares = 0, q = 0;
    size_t count = 0;
    for (size_t i = 0; i < rows; i++) {
        squares += series[i] * series[i];
        count += deviation[i] > 0;
    }
    *rms = count > 0 ? sqrt(squares / (double)count) : (double)NAN;
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

// Of every channel; that of an encoder, whose steps are no noise, counts where it is alone.
static status judge_whiteness(identification *id, fault *f)
{
    const double *residual = id->residual;
    id->white = true;
    for (int k = 0; k < id->trace_count; k++) {
        recorded_trace *t = &id->traces[k];
        double *series = calloc(t->rows, sizeof *series);
        TRY_MEMORY(series != NULL, f);
        const bool alone = t->reading[CHANNEL_TACHOMETER] == NULL;
        for (int c = 0; c < CHANNELS; c++) {
            t->rms[c] = t->whiteness[c] = (double)NAN;
            for (size_t i = 0; t->reading[c] != NULL && i < t->rows; i++) {
                series[i] = t->deviation[c][i] > 0 ? *residual++ : 0;
            }
            if (t->reading[c] != NULL) {
                t->whiteness[c] = whiteness_of(series, t->deviation[c], t->rows, &t->rms[c]);
                const bool counts = c != CHANNEL_ENCODER || alone;
                id->white = id->white && !(counts && t->whiteness[c] > WHITE);
            }
        }
        residual += t->contact_count;
        free(series);
    }
    return STATUS_OK;
}

// --- sums ---------------------------------------------------------------------------------------

static double dot(const double *a, const double *b, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

static void add(double *to, double factor, const double *a, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        to[i] += factor * a[i];
    }
}

// --- errors -----------------------------------------------------------------------------------

// What the parameters' columns of the Jacobian say that the traces' own cannot: what is left of
// them when their projections on the latter, as far as these say anything, are taken off. alone[p *
// residuals].
static bool project(const identification *id, const double *jacobian, double *alone)
{
    const size_t m = id->residuals;
    const int p = id->count, q = id->unknowns - p;
    double size[IDENTIFY_UNKNOWNS], own[IDENTIFY_UNKNOWNS * IDENTIFY_UNKNOWNS],
        values[IDENTIFY_UNKNOWNS], scratch[2 * IDENTIFY_UNKNOWNS];
    memcpy(alone, jacobian, (size_t)p * m * sizeof *alone);
    for (int i = 0; i < q; i++) {
        const double square =
            dot(jacobian + (size_t)(p + i) * m, jacobian + (size_t)(p + i) * m, m);
        size[i] = square > 0 ? sqrt(square) : 1;
        for (int j = 0; j <= i; j++) {
            own[i * q + j] = own[j * q + i] =
                dot(jacobian + (size_t)(p + i) * m, jacobian + (size_t)(p + j) * m, m) /
                (size[i] * size[j]);
        }
    }
    if (q > 0 && !symmetric_eigen(q, own, values, scratch)) {
        return false;
    }
    double *along = calloc(m, sizeof *along);
    for (int k = 0; along != NULL && k < q; k++) {
        if (values[k] < NO_SAY * values[q - 1]) {
            continue;
        }
        memset(along, 0, m * sizeof *along);
        for (int j = 0; j < q; j++) {
            add(along, own[k * q + j] / size[j], jacobian + (size_t)(p + j) * m, m);
        }
        for (int i = 0; i < p; i++) {
            add(alone + (size_t)i * m, -dot(alone + (size_t)i * m, along, m) / values[k], along, m);
        }
    }
    const bool done = along != NULL;
    free(along);
    return done;
}

// How far the residuals of a channel of all traces scatter where the parameters look: over blocks
// that are longer than what correlates them,
//
//     rho = sum over parameters and blocks of (sum in the block of a r)^2 / sum of a^2
//
// with a the parameter's column, of size 1. It is 1 for white residuals of deviation 1, below for
// the rounding of an encoder that moves, which has no slow part, above for what the model lacks.
// Its weight goes to information[], that of the channel to scatter[].
static void add_channel(const identification *id, int channel, const double *alone,
                        double *information, double *scatter)
{
    const size_t m = id->residuals;
    const int p = id->count;
    double part[IDENTIFY_PATHS * IDENTIFY_PATHS] = {0}, squares[IDENTIFY_PATHS] = {0};
    size_t at = 0;
    for (int k = 0; k < id->trace_count; k++) {
        const recorded_trace *t = &id->traces[k];
        for (int c = 0; c < CHANNELS; c++) {
            const double *read = t->reading[c], *deviation = t->deviation[c];
            double sums[IDENTIFY_PATHS] = {0}, begun = -HUGE_VAL;
            for (size_t i = 0; read != NULL && i < t->rows; i++) {
                // a reading that stays is one reading: no block ends in it
                const bool stays = i > 0 && read[i] == read[i - 1];
                if (t->time[i] - begun >= BLOCK && !stays) {
                    begun = t->time[i];
                    for (int a = 0; a < p; a++) {
                        squares[a] += sums[a] * sums[a];
                        sums[a] = 0;
                    }
                }
                if (!(deviation[i] > 0)) {
                    continue;
                }
                for (int a = 0; a < p && c == channel; a++) {
                    sums[a] += alone[(size_t)a * m + at] * id->residual[at];
                    for (int b = 0; b < p; b++) {
                        part[a * p + b] += alone[(size_t)a * m + at] * alone[(size_t)b * m + at];
                    }
                }
                at++;
            }
            for (int a = 0; a < p; a++) {
                squares[a] += sums[a] * sums[a];
            }
        }
        at += (size_t)t->contact_count;
    }

    double rho = 0;
    int looking = 0;
    for (int a = 0; a < p; a++) {
        if (part[a * p + a] > 0) {
            rho += squares[a] / part[a * p + a];
            looking++;
        }
    }
    rho = looking > 0 ? rho / looking : 1;
    for (int i = 0; i < p * p; i++) {
        information[i] += part[i];
        scatter[i] += rho * part[i];
    }
}

// The instants of touches, each with the deviation that it has.
static void add_contacts(const identification *id, const double *alone, double *information,
                         double *scatter)
{
    const size_t m = id->residuals;
    const int p = id->count;
    size_t at = 0;
    for (int k = 0; k < id->trace_count; k++) {
        const recorded_trace *t = &id->traces[k];
        const size_t end = at + t->residuals;
        for (size_t r = end - (size_t)t->contact_count; r < end; r++) {
            for (int a = 0; a < p * p; a++) {
                const double both = alone[(size_t)(a / p) * m + r] * alone[(size_t)(a % p) * m + r];
                information[a] += both;
                scatter[a] += both * fmax(1, id->residual[r] * id->residual[r]);
            }
        }
        at = end;
    }
}

// The covariance of what is determined: with the information's eigenvectors v and values l,
//
//     sum over k and j of v_k (v_k' S v_j) / (l_k l_j) v_j',   S the scatter (White's estimator).
static void find_covariance(identification *id, const double *values, const double *scatter)
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
                id->covariance[a] += v[a / p] * between / (values[k] * values[j]) * w[a % p];
            }
        }
    }
}

status identify_judge(identification *id, const double *jacobian, fault *f)
{
    assert(id != NULL && jacobian != NULL);
    const int p = id->count;
    double scratch[2 * IDENTIFY_PATHS], values[IDENTIFY_PATHS];
    double scatter[IDENTIFY_PATHS * IDENTIFY_PATHS] = {0};
    id->chi_square = dot(id->residual, id->residual, id->residuals);
    id->aic = id->chi_square + 2 * id->unknowns;
    status code = judge_whiteness(id, f);
    if (code != STATUS_OK || p == 0) {
        return code;
    }

    // what each channel says of the parameters, and how far it scatters
    double *alone = calloc((size_t)p * id->residuals, sizeof *alone);
    TRY_MEMORY(alone != NULL, f);
    bool done = project(id, jacobian, alone);
    memset(id->direction, 0, sizeof id->direction);
    for (int c = 0; c < CHANNELS && done; c++) {
        add_channel(id, c, alone, id->direction, scatter);
    }
    if (done) {
        add_contacts(id, alone, id->direction, scatter);
    }
    free(alone);
    if (!done || !symmetric_eigen(p, id->direction, values, scratch)) {
        return fault_set(f, STATUS_SINGULAR, "the parameters' errors cannot be computed");
    }

    // what the model does not explain makes errors larger, by as much
    double most;
    const double misfit = fmax(1, identify_misfit(id, &most));
    id->undetermined = 0;
    for (int k = 0; k < p; k++) {
        id->singular[k] = sqrt(fmax(values[k] / misfit, 0));
        id->undetermined += id->singular[k] < LEAST_KNOWN;
    }
    find_covariance(id, values, scatter);
    for (int i = 0; i < p; i++) {
        fitted_parameter *fit = &id->fit[i];
        double part = 0;
        for (int k = 0; k < id->undetermined; k++) {
            part += id->direction[k * p + i] * id->direction[k * p + i];
        }
        fit->determined = part < HAS_A_PART;
        fit->standard_error =
            fit->determined ? id->fit[i].scale * sqrt(id->covariance[i * p + i]) : (double)NAN;
        fit->low = fit->value - QUANTILE * fit->standard_error;
        fit->high = fit->value + QUANTILE * fit->standard_error;
    }
    return STATUS_OK;
}

// Chi square has as many degrees of freedom n as there are readings more than unknowns; noise alone
// gives it the mean n and the standard deviation sqrt(2 n).
double identify_misfit(const identification *id, double *most)
{
    assert(id != NULL && most != NULL);
    const double freedoms = (double)(id->residuals - (size_t)(id->unknowns + id->count));
    *most = NOISE_KNOWN * NOISE_KNOWN * (1 + CHANCE * sqrt(2 / freedoms));
    return id->chi_square / freedoms;
}

// --- words and files --------------------------------------------------------------------------

const char *identify_words(const identification *id, int k, char *text, size_t size)
{
    const double *part = id->direction + k * id->count;
    int largest = 0;
    for (int i = 1; i < id->count; i++) {
        largest = fabs(part[i]) > fabs(part[largest]) ? i : largest;
    }
    const char *joint = "";
    size_t used = 0;
    text[0] = '\0';
    for (int sign = 1; sign >= -1; sign -= 2) {
        bool first = true;
        for (int i = 0; i < id->count && used + 1 < size; i++) {
            const double share = part[i] / part[largest] * sign;
            if (share * share < HAS_A_PART) {
                continue;
            }
            if (share > 0) {
                used += (size_t)decimal_print(text + used, size - used, "%s%s%s by %.3g %%", joint,
                                              first ? sign > 0 ? "raising " : "lowering " : "",
                                              id->fit[i].axis.name, 10 * share);
                joint = " and ";
                first = false;
            }
        }
        joint = used > 0 ? " while " : "";
    }
    if (used < size) {
        snprintf(text + used, size - used, " changes no reading by more than its noise");
    }
    return text;
}

json_t *identify_traces_json(const identification *id)
{
    json_t *traces = json_array();
    for (int k = 0; k < id->trace_count; k++) {
        const recorded_trace *t = &id->traces[k];
        json_t *line = json_object(), *channels = json_array();
        json_put(line, "file", json_text(t->file));
        json_put(line, "time_shift_s", json_number(t->own[OWN_SHIFT]));
        json_put(line, "encoder_offset_rad", json_number(t->own[OWN_OFFSET]));
        json_put(line, "initial_angle_rad", json_number(t->own[OWN_ANGLE]));
        json_put(line, "initial_velocity_rad_s", json_number(t->own[OWN_VELOCITY]));
        json_put(line, "contacts", json_integer(t->contact_count));
        json_put(line, "contact_error_s", json_number(t->contact_error));
        json_put(line, "peak_error_percent", json_number(100 * t->peak_error));
        for (int c = 0; c < CHANNELS; c++) {
            if (t->reading[c] != NULL) {
                json_t *channel = json_object();
                json_put(channel, "signal", json_text(signal_table[identify_signals[c]].name));
                json_put(channel, "rms_over_deviation", json_number(t->rms[c]));
                json_put(channel, "whiteness", json_number(t->whiteness[c]));
                json_add(channels, channel);
            }
        }
        json_put(line, "residuals", channels);
        json_add(traces, line);
    }
    return traces;
}

bool identify_at_end(const fitted_parameter *fit)
{
    return fit->value == fit->low_most || fit->value == fit->high_most;
}

json_t *identify_json(const identification *id)
{
    json_t *object = json_object(), *fit = json_array(), *rows = json_array(),
           *words = json_array();
    const int p = id->count;
    json_put(object, "scenario", json_text(id->base->name));
    for (int i = 0; i < p; i++) {
        const fitted_parameter *of = &id->fit[i];
        json_t *line = json_object();
        double row[IDENTIFY_PATHS];
        json_put(line, "path", json_text(of->axis.name));
        json_put(line, "value", json_number(of->value));
        json_put(line, "standard_error", json_number(of->standard_error));
        json_put(line, "low", json_number(of->low));
        json_put(line, "high", json_number(of->high));
        json_put(line, "determined", json_boolean(of->determined));
        json_put(line, "at_end_of_range", json_boolean(identify_at_end(of)));
        json_add(fit, line);
        for (int j = 0; j < p; j++) {
            const double size = sqrt(id->covariance[i * p + i]) * sqrt(id->covariance[j * p + j]);
            row[j] = of->determined && id->fit[j].determined ? id->covariance[i * p + j] / size
                                                             : (double)NAN;
        }
        json_add(rows, json_numbers(row, p));
    }
    for (int k = 0; k < id->undetermined; k++) {
        char text[1024];
        json_add(words, json_text(identify_words(id, k, text, sizeof text)));
    }
    json_put(object, "fit", fit);
    json_put(object, "correlation", rows);
    json_put(object, "singular_values", json_numbers(id->singular, p));
    json_put(object, "undetermined", words);
    json_put(object, "chi_square", json_number(id->chi_square));
    json_put(object, "residuals", json_integer((json_int_t)id->residuals - p));
    json_put(object, "aic", json_number(id->aic));
    json_put(object, "white", json_boolean(id->white));
    json_put(object, "traces", identify_traces_json(id));
    return object;
}

// An arm of the covariance, whose eigenvectors and -values these are: along each a normal number.
static void draw_arm(const identification *id, const double *directions, const double *values,
                     random_generator *random, double *drawn)
{
    const int p = id->count;
    for (int i = 0; i < p; i++) {
        drawn[i] = id->fit[i].value;
    }
    for (int k = 0; k < p; k++) {
        double sum = -6;
        for (int i = 0; i < 12; i++) {
            sum += random_uniform(random);
        }
        for (int i = 0; i < p; i++) {
            drawn[i] += sum * sqrt(fmax(values[k], 0)) * directions[k * p + i] * id->fit[i].scale;
        }
    }
    for (int i = 0; i < p; i++) {
        drawn[i] = fmin(fmax(drawn[i], id->fit[i].low_most), id->fit[i].high_most);
    }
}

// One line of a set: numbers of all arms.
static void write_line(FILE *stream, const char *path, bool first, const double *numbers)
{
    fprintf(stream, "%s%s=", first ? "" : "with ", path);
    for (int n = 0; n < IDENTIFY_CASES; n++) {
        char text[NUMBER_TEXT];
        number_format(text, numbers[n]);
        fprintf(stream, "%s%s", n > 0 ? "," : "", text);
    }
    fputc('\n', stream);
}

void identify_write_set(FILE *stream, const identification *id)
{
    // what a law is told of a parameter, as a factor of the true value
    const struct {
        int parameter, belief;
    } told[] = {{PARAMETER_INDEX(arm.k2), PARAMETER_INDEX(belief.k2_factor)},
                {PARAMETER_INDEX(arm.mass), PARAMETER_INDEX(belief.mass_factor)},
                {PARAMETER_INDEX(arm.hub_inertia), PARAMETER_INDEX(belief.inertia_factor)},
                {PARAMETER_INDEX(motor.torque_constant), PARAMETER_INDEX(belief.torque_factor)},
                {PARAMETER_INDEX(motor.stiction), PARAMETER_INDEX(belief.friction_factor)}};
    double drawn[IDENTIFY_CASES][IDENTIFY_PATHS], numbers[IDENTIFY_CASES];
    random_generator random;
    double directions[IDENTIFY_PATHS * IDENTIFY_PATHS], values[IDENTIFY_PATHS] = {0};
    double scratch[2 * IDENTIFY_PATHS];
    memcpy(directions, id->covariance, sizeof directions);
    if (!symmetric_eigen(id->count, directions, values, scratch)) {
        memset(values, 0, sizeof values); // every arm is the fitted one
    }
    random_seed(&random, id->seed);
    for (int n = 0; n < IDENTIFY_CASES; n++) {
        draw_arm(id, directions, values, &random, drawn[n]);
    }

    fprintf(stream,
            "# %d arms drawn from the covariance of a fit; the law is told the fitted one\n"
            "control.seed=1:1000000\n",
            IDENTIFY_CASES);
    bool first = true;
    for (int i = 0; i < id->count; i++) {
        const fitted_parameter *fit = &id->fit[i];
        if (!fit->determined) {
            continue;
        }
        for (int n = 0; n < IDENTIFY_CASES; n++) {
            numbers[n] = drawn[n][i];
        }
        write_line(stream, fit->axis.name, first, numbers);
        first = false;
        for (size_t k = 0; k < sizeof told / sizeof *told; k++) {
            if (strcmp(parameter_table[told[k].parameter].path, fit->axis.name) == 0) {
                const double before = parameter_get(&id->base->parameters, told[k].belief);
                for (int n = 0; n < IDENTIFY_CASES; n++) {
                    const double factor = drawn[n][i] != 0 ? fit->value / drawn[n][i] : 1;
                    numbers[n] = fmin(fmax(before * factor, 0.01), 100);
                }
                write_line(stream, parameter_table[told[k].belief].path, false, numbers);
            }
        }
    }
}
