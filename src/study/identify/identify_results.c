// Writes the results of a fit: in words, as JSON, and as a set of arms drawn from it.
#include <math.h>
#include <string.h>

#include "src/base/dense.h"
#include "src/base/json.h"
#include "src/base/numbers.h"
#include "src/base/random.h"
#include "src/study/identify/identify.h"
#include "src/scenario/fitted_arm.h"

const char *identify_words(const identification *id, int k, char *text, size_t size)
{
    const double *part = id->direction + k * id->count;
    int largest = 0;
    for (int i = 1; i < id->count; i++) {
        if (fabs(part[i]) > fabs(part[largest])) {
            largest = i;
        }
    }
    const char *joint = "";
    size_t used = 0;
    text[0] = '\0';
    for (int sign = 1; sign >= -1; sign -= 2) {
        const char *verb = sign > 0 ? "raising " : "lowering ";
        for (int i = 0; i < id->count && used + 1 < size; i++) {
            const double share = part[i] / part[largest] * sign;
            if (share * share < IDENTIFY_PART) {
                continue;
            }
            if (share > 0) {
                used +=
                    (size_t)decimal_print(text + used, size - used, "%s%s%s by %.3g %%",
                                          joint, verb, id->fit[i].axis.name, 10 * share);
                joint = " and ";
                verb = "";
            }
        }
        if (used > 0) {
            joint = " while ";
        } else {
            joint = "";
        }
    }
    if (used < size) {
        snprintf(text + used, size - used, " changes no reading by more than its noise");
    }
    return text;
}

json_t *identify_traces_json(const identification *id)
{
    static const char *const own_keys[OWNS] = {"time_shift_s", "encoder_offset_rad",
                                               "initial_angle_rad",
                                               "initial_velocity_rad_s"};
    json_t *traces = json_array();
    for (int k = 0; k < id->trace_count; k++) {
        const recorded_trace *t = &id->traces[k];
        json_t *line = json_object(), *channels = json_array();
        json_put(line, "file", json_text(t->file));
        json_members(
            line,
            "columns:t not_taken:t left_out:t rows:i samples:i begin_s:n "
            "length_s:n steady:b rate_Hz:n stamp_scatter_s:n missing_samples:i gaps:i "
            "longest_gap_s:n",
            t->taken, t->not_taken, t->left_out, (int)t->table_rows, (int)t->rows,
            t->begin, t->time[t->rows - 1], t->clock.period > 0, t->rate,
            t->clock.scatter, (int)t->clock.missing, (int)t->clock.gaps,
            t->clock.longest);
        for (int own = 0; own < OWNS; own++) {
            json_put(line, own_keys[own], json_number(t->own[own]));
        }
        json_members(line, "contacts:i contact_error_s:n peak_error_percent:n",
                     t->contact_count, t->contact_error, 100 * t->peak_error);
        for (int c = 0; c < CHANNELS; c++) {
            if (t->reading[c] != NULL) {
                const size_t *uses = t->uses[c];
                json_add(channels,
                         json_of("signal:t rms:n explained:n rms_over_deviation:n "
                                 "whiteness:n compared:i missing:i near_touch:i "
                                 "without_contact:i at_range:i",
                                 signal_table[identify_signals[c]].name, t->rms_unit[c],
                                 t->explained[c], t->rms[c], t->whiteness[c],
                                 (int)uses[READING_COMPARED], (int)uses[READING_MISSING],
                                 (int)uses[READING_NEAR_TOUCH],
                                 (int)uses[READING_WITHOUT_CONTACT],
                                 (int)uses[READING_AT_RANGE]));
            }
        }
        json_put(line, "residuals", channels);
        json_add(traces, line);
    }
    return traces;
}

json_t *identify_preview_json(const identification *id)
{
    return json_of("scenario:t traces:o", id->base->name, identify_traces_json(id));
}

// What the model lacks, as far as the data show it; null where they do not.
static json_t *lack_json(const identification *id)
{
    const unexplained *lack = &id->lack;
    if (identify_explained(id) || lack->trace < 0) {
        return json_null();
    }
    json_t *spring = json_null();
    if (!id->white && !isnan(lack->hub_spring)) {
        spring = json_of("k1_N_m_rad:n damping_N_m_s_rad:n chi_square:n values:o",
                         lack->hub_spring, lack->hub_damping, lack->chi_square,
                         json_numbers(lack->with_spring, id->count));
    }
    return json_of("file:t signal:t from_s:n to_s:n rms:n rms_over_deviation:n "
                   "command_V:n stretch_s:n hub_spring:o",
                   id->traces[lack->trace].file,
                   signal_table[identify_signals[lack->channel]].name, lack->from,
                   lack->to, lack->rms_unit, lack->rms, lack->command, lack->stretch,
                   spring);
}

json_t *identify_json(const identification *id)
{
    json_t *fit = json_array(), *rows = json_array(), *words = json_array();
    const int p = id->count;
    for (int i = 0; i < p; i++) {
        const fitted_parameter *parameter = &id->fit[i];
        json_add(fit, json_of("path:t value:n standard_error:n low:n high:n determined:b "
                              "at_end_of_range:b one_sided:b",
                              parameter->axis.name, parameter->value,
                              parameter->standard_error, parameter->low, parameter->high,
                              parameter->determined, identify_at_end(parameter),
                              parameter->one_sided));

        // its correlations with all parameters: covariance over both deviations
        double row[IDENTIFY_PATHS];
        for (int j = 0; j < p; j++) {
            const double deviations =
                sqrt(id->covariance[i * p + i]) * sqrt(id->covariance[j * p + j]);
            if (parameter->determined && id->fit[j].determined) {
                row[j] = id->covariance[i * p + j] / deviations;
            } else {
                row[j] = (double)NAN;
            }
        }
        json_add(rows, json_numbers(row, p));
    }
    for (int k = 0; k < id->undetermined; k++) {
        char text[1024];
        json_add(words, json_text(identify_words(id, k, text, sizeof text)));
    }
    return json_of("scenario:t fit:o correlation:o singular_values:o undetermined:o "
                   "chi_square:n residuals:i aic:n white:b lack:o "
                   "search:o traces:o",
                   id->base->name, fit, rows, json_numbers(id->singular, p), words,
                   id->chi_square, (int)id->residuals - p, id->aic, id->white,
                   lack_json(id),
                   json_of("starts:i reached:i runs:i", id->searches, id->reached,
                           id->runs),
                   identify_traces_json(id));
}

// Draws the parameters of one arm from the fit's covariance, given by its eigenvectors
// and eigenvalues: along each eigenvector a normal number.
static void draw_parameters(const identification *id, const double *directions,
                            const double *values, random_generator *random, double *drawn)
{
    const int p = id->count;
    for (int i = 0; i < p; i++) {
        drawn[i] = id->fit[i].value;
    }
    for (int k = 0; k < p; k++) {
        const double normal = random_about_normal(random);
        const double deviation = sqrt(fmax(values[k], 0));
        for (int i = 0; i < p; i++) {
            drawn[i] += normal * deviation * directions[k * p + i] * id->fit[i].scale;
        }
    }
    for (int i = 0; i < p; i++) {
        drawn[i] = fmin(fmax(drawn[i], id->fit[i].low_most), id->fit[i].high_most);
    }
}

// Writes one line of a set, "path=number,number,...", with a number for each arm: the
// value of parameter i, or with `belief` the factor of that value that a law believes. It
// is scaled so that the law believes the fitted value of each arm.
static void write_line(FILE *stream, const char *path, const fitted_parameter *fit,
                       double (*drawn)[IDENTIFY_PATHS], int i, const double *belief)
{
    fprintf(stream, "%s=", path);
    for (int n = 0; n < IDENTIFY_CASES; n++) {
        char text[NUMBER_TEXT];
        const double true_value = drawn[n][i];
        double value = true_value;
        if (belief != NULL) {
            const double factor = true_value != 0 ? fit->value / true_value : 1;
            value = fmin(fmax(*belief * factor, 0.01), 100);
        }
        number_format(text, value);
        if (n > 0) {
            fputc(',', stream);
        }
        fputs(text, stream);
    }
    fputc('\n', stream);
}

void identify_write_set(FILE *stream, const identification *id)
{
    double drawn[IDENTIFY_CASES][IDENTIFY_PATHS];
    random_generator random;
    double directions[IDENTIFY_PATHS * IDENTIFY_PATHS], values[IDENTIFY_PATHS] = {0};
    double scratch[2 * IDENTIFY_PATHS];
    memcpy(directions, id->covariance, sizeof directions);
    if (!symmetric_eigen(id->count, directions, values, scratch)) {
        memset(values, 0, sizeof values); // every arm is the fitted one
    }
    random_seed(&random, id->seed);
    for (int n = 0; n < IDENTIFY_CASES; n++) {
        draw_parameters(id, directions, values, &random, drawn[n]);
    }

    fprintf(
        stream,
        "# %d arms drawn from the covariance of a fit; the law is told the fitted one\n"
        "control.seed=1:1000000\n",
        IDENTIFY_CASES);
    const char *with = "";
    for (int i = 0; i < id->count; i++) {
        const fitted_parameter *fit = &id->fit[i];
        if (!fit->determined) {
            continue;
        }
        fputs(with, stream);
        with = "with ";
        write_line(stream, fit->axis.name, fit, drawn, i, NULL);
        const int told = fitted_arm_belief(fit->axis.parameter);
        if (told >= 0) {
            const double belief = parameter_get(&id->base->parameters, told);
            fputs(with, stream);
            write_line(stream, parameter_table[told].path, fit, drawn, i, &belief);
        }
    }
}
