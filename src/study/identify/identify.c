#include "src/study/identify/identify.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/scenario/effect.h"

enum { NOISE_ROUNDS = 2 }; // in which noise and fit agree within a percent

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
        free(t->contact_width);
    }
    free(id->residual);
    *id = (identification){0};
}

// --- the fit ---------------------------------------------------------------------------

// Fills in the results of a search that was stopped: the sum of squares is known, and no
// number that judges the fit is.
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
            t->rms[c] = t->rms_unit[c] = (double)NAN;
            t->explained[c] = t->whiteness[c] = (double)NAN;
        }
    }
}

// Searches the unknowns, runs the best ones once more, and judges the fit by their
// residuals and Jacobian.
static status search_and_judge(identification *id, double *jacobian, fault *f)
{
    double x[IDENTIFY_UNKNOWNS], least;
    fault why = {.code = STATUS_OK};
    status code = identify_search(id, x, &least, f);
    if (code == STATUS_OK) {
        const bool judge = true;
        code = identify_evaluate(id, x, 1, NULL, judge, id->residual, &why, f);
    }
    if (code == STATUS_OK && why.code != STATUS_OK) {
        *f = why;
        return why.code;
    }
    if (code == STATUS_OK) {
        code = identify_jacobian(id, x, jacobian, f);
    }

    // keep the best values found, also of a search that was stopped
    if (isnan(least) || (code != STATUS_OK && code != STATUS_STOPPED)) {
        return code;
    }
    for (int n = 0; n < id->unknowns; n++) {
        *id->unknown[n].value = identify_unknown_value(id, n, x[n]);
    }
    if (code == STATUS_STOPPED) {
        leave_unjudged(id, least);
        return code;
    }
    code = identify_judge(id, jacobian, f);
    if (code == STATUS_OK && id->count > 0) {
        code = identify_profile(id, x, jacobian, f);
    }
    if (code == STATUS_STOPPED) {
        leave_unjudged(id, least);
    }
    return code;
}

// Gives every channel the noise that the fit leaves of it in all traces.
static void take_noise_from_residuals(identification *id)
{
    for (int c = 0; c < CHANNELS; c++) {
        double squares = 0, count = 0;
        for (int k = 0; k < id->trace_count; k++) {
            const recorded_trace *t = &id->traces[k];
            if (!isnan(t->rms[c])) {
                squares += t->independent[c] * t->rms[c] * t->rms[c];
                count += t->independent[c];
            }
        }

        // of residuals that are 0 the noise stays what it was
        for (int k = 0; squares > 0 && k < id->trace_count; k++) {
            const recorded_trace *t = &id->traces[k];
            for (size_t i = 0; !isnan(t->rms[c]) && i < t->rows; i++) {
                t->deviation[c][i] *= sqrt(squares / count);
            }
        }
    }
}

status identify_fit(identification *id, fault *f)
{
    assert(id->trace_count > 0);
    id->part = 1;
    identify_list_unknowns(id);

    // a parameter without effect in runs under the recorded command cannot be fitted
    scenario made;
    const bool can_run = identify_scenario(id, 0, &made, NULL) == STATUS_OK;
    for (int i = 0; can_run && i < id->count; i++) {
        const sweep_axis *axis = &id->fit[i].axis;
        const char *why = effect_none_from(&made, axis->parameter, -1);
        if (why != NULL) {
            return fault_set_at(f, STATUS_BAD_ARGUMENT, sweep_axis_parameter(axis)->path,
                                "%s has no effect in any run: %s", axis->name, why);
        }
    }

    // the residuals, of which there have to be more than unknowns
    id->residuals = (size_t)id->count;
    for (int k = 0; k < id->trace_count; k++) {
        id->residuals += id->traces[k].residuals;
    }
    if (id->count == 0 || id->starts < 2) {
        id->starts = 2;
    }
    const size_t m = id->residuals, n = (size_t)id->unknowns;
    FAULT_IF(m <= n + (size_t)id->count || m > 10000000, f, STATUS_BAD_ARGUMENT,
             "%zu readings can be compared for %zu unknowns, expected more", m, n);

    free(id->residual);
    id->residual = calloc(m, sizeof *id->residual);
    SCOPED(free_kept) double *jacobian = calloc(m * n, sizeof *jacobian);
    if (!(id->residual != NULL && jacobian != NULL)) {
        return fault_no_memory(f);
    }
    TRY(search_and_judge(id, jacobian, f));

    // with other noise the channels have other weights: fitted again, from there on
    for (int i = 0; id->noise_from_residuals && i < NOISE_ROUNDS; i++) {
        const int starts = id->starts, searches = id->searches, reached = id->reached;
        take_noise_from_residuals(id);
        id->starts = 1;
        TRY(search_and_judge(id, jacobian, f));
        id->starts = starts;
        id->searches = searches;
        id->reached = reached;
    }
    return STATUS_OK;
}
