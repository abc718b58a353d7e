// Intervals where the sum of squares is no paraboloid: a touch that comes with another
// value makes its valley bend, and the slopes at the bottom tell little of its width.
//
// With the covariance C of all unknowns the valley of parameter i begins along C e_i. If
// the sum of squares rises there as the slopes say, by 4 at two standard deviations, the
// interval stays. Else the parameter is held at either end and all others are minimised:
// the rise R of that profile gives the end the deviation s/sqrt(R/4) in place of s
// (Bates and Watts, Nonlinear Regression Analysis and Its Applications, 1988, 6.1). No
// end comes nearer by it.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/dense.h"
#include "src/study/identify/identify.h"

#define APART  2.0   // standard deviations from the result to where is looked
#define OFF    0.25  // share by which a rise may differ from that of a paraboloid
#define WIDEST 4.0   // by which a profile widens an end at most
#define NO_SAY 1e-12 // eigenvalue, over the largest one, that counts as zero

// The covariance of all unknowns, covariance[unknowns * unknowns], from the Jacobian.
static bool find_covariance(const identification *id, const double *jacobian,
                            double *covariance)
{
    const size_t m = id->residuals, n = (size_t)id->unknowns;
    double products[IDENTIFY_UNKNOWNS * IDENTIFY_UNKNOWNS], values[IDENTIFY_UNKNOWNS];
    double scratch[2 * IDENTIFY_UNKNOWNS];
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            products[i * n + j] = identify_dot(jacobian + i * m, jacobian + j * m, m);
        }
    }
    if (!symmetric_eigen((int)n, products, values, scratch)) {
        return false;
    }
    memset(covariance, 0, n * n * sizeof *covariance);
    for (size_t k = 0; k < n; k++) {
        const double *v = products + k * n;
        for (size_t a = 0; a < n * n && values[k] > NO_SAY * values[n - 1]; a++) {
            covariance[a] += v[a / n] * v[a % n] / values[k];
        }
    }
    return true;
}

// Looks at both ends of parameter i, `step` [unknowns] from the result x: *factor[0] and
// [1] receive by how much the profile widens the lower and the upper one, 1 where the sum
// of squares rises there by `expected`.
static status look_at_ends(identification *id, int i, const double *x, const double *step,
                           double expected, double factor[2], fault *f)
{
    const size_t m = id->residuals, n = (size_t)id->unknowns;
    double ends[2 * IDENTIFY_UNKNOWNS];
    SCOPED(free_kept) double *out = calloc(2 * m, sizeof *out);
    if (out == NULL) {
        return fault_no_memory(f);
    }
    for (size_t a = 0; a < n; a++) {
        ends[a] = x[a] - step[a];
        ends[n + a] = x[a] + step[a];
    }
    TRY(identify_evaluate(id, ends, 2, NULL, false, out, NULL, f));
    factor[0] = factor[1] = 1;
    for (size_t end = 0; end < 2; end++) {
        const double *there = out + end * m;
        double rise = identify_dot(there, there, m) - id->chi_square;
        if (fabs(rise - expected) > OFF * expected) {
            double squares;
            TRY(identify_minimise_held(id, i, ends + end * n, &squares, f));
            rise = squares - id->chi_square;
            factor[end] = sqrt(expected / fmax(rise, expected / (WIDEST * WIDEST)));
            factor[end] = fmax(factor[end], 1);
        }
    }
    return STATUS_OK;
}

// Widens the interval of parameter i, and its errors with it.
static void widen(identification *id, int i, const double factor[2])
{
    fitted_parameter *fit = &id->fit[i];
    const double least = sweep_axis_parameter(&fit->axis)->minimum;
    const double error = fit->standard_error, mean = (factor[0] + factor[1]) / 2;
    fit->low = fit->value - IDENTIFY_QUANTILE * error * factor[0];
    fit->high = fit->value + IDENTIFY_QUANTILE * error * factor[1];
    if (least == 0) {
        fit->low = fmax(fit->low, 0);
    }
    fit->standard_error = error * mean;
    for (int j = 0; j < id->count; j++) {
        id->covariance[i * id->count + j] *= mean;
        id->covariance[j * id->count + i] *= mean;
    }
}

status identify_profile(identification *id, const double *x, const double *jacobian,
                        fault *f)
{
    const size_t n = (size_t)id->unknowns;
    double covariance[IDENTIFY_UNKNOWNS * IDENTIFY_UNKNOWNS], step[IDENTIFY_UNKNOWNS];
    if (!id->white || id->undetermined > 0 ||
        !find_covariance(id, jacobian, covariance)) {
        return STATUS_OK;
    }
    for (int i = 0; i < id->count; i++) {
        const fitted_parameter *fit = &id->fit[i];
        const double *along = covariance + (size_t)i * n;
        const double apart = APART * fit->standard_error / fit->scale;
        if (fit->one_sided || !(apart > 0) || !(along[i] > 0)) {
            continue;
        }
        for (size_t a = 0; a < n; a++) {
            step[a] = apart * along[a] / along[i];
        }
        double factor[2];
        TRY(look_at_ends(id, i, x, step, apart * apart / along[i], factor, f));
        if (factor[0] > 1 || factor[1] > 1) {
            widen(id, i, factor);
        }
    }
    return STATUS_OK;
}
