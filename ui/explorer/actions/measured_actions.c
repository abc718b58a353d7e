// Actions on measured data: laid under the run, and an arm found that moves like it.
#include "ui/explorer/actions/actions.h"

#include <math.h>
#include <string.h>

#include "src/run/trace.h"
#include "src/study/identify.h"

// --- under the run ---------------------------------------------------------------------

// Measured columns under the run, shifted as the file's name says, else to the run's
// first touch.
bool act_data(explorer_model *model, explorer_input *input, const char *argument)
{
    trace fresh = {0};
    csv_table table = {0};
    char path[LINE_TEXT];
    const char *at = strrchr(argument, '@');
    double shift = (double)NAN;
    if (argument[0] == '\0') {
        return act_refuse(
            input, "data takes a table with a column time, such as bench.csv, or off");
    }
    if (strcmp(argument, "off") == 0) {
        trace_finish(&model->measured);
        model->measured = (trace){0};
        return act_tell(input, "no measured data");
    }
    if (!act_need_whole_run(model, input)) {
        return false;
    }
    if (at != NULL && !act_read_number(input, at + 1, &shift)) {
        return false;
    }
    snprintf(path, sizeof path, "%.*s",
             at != NULL ? (int)(at - argument) : (int)strlen(argument), argument);
    trace_init(&fresh, 1);
    status code = csv_table_read(&table, path, 1, &input->fault);
    if (code == STATUS_OK) {
        code = measured_rows(&fresh, &table, NULL, -1, &input->fault);
    }
    csv_table_finish(&table);
    if (code != STATUS_OK) {
        trace_finish(&fresh);
        return act_succeeded(input, code);
    }

    trace_finish(&model->measured);
    model->measured = fresh;
    model->measured_shift = 0;
    model->measured_id++;
    snprintf(model->measured_file, sizeof model->measured_file, "%s", path);
    if (model_lay_data(model, shift)) {
        return act_tell(input, "%zu rows, shifted by %.6g s; :data off takes them away",
                        fresh.row_count, model->measured_shift);
    }
    return act_warn(input, "%zu rows, as they are: no force in both that shows a touch",
                    fresh.row_count);
}

// --- identification --------------------------------------------------------------------

enum { FIT_STARTS = 4, FIT_THREADS = 4, FIT_RUNS = 400 };

// Says each value with its error, and what is not determined.
static bool tell_fit(explorer_input *input, const identification *id)
{
    char text[MESSAGE_TEXT / 2] = "";
    double most;
    const bool misfits = identify_misfit(id, &most) > most;
    for (int i = 0; i < id->count; i++) {
        const fitted_parameter *fit = &id->fit[i];
        const char *unit = sweep_axis_parameter(&fit->axis)->unit;
        if (i > 0) {
            text_add(text, sizeof text, "; ");
        }
        text_add(text, sizeof text, "%s", strchr(fit->axis.name, '.') + 1);
        if (!fit->determined) {
            text_add(text, sizeof text, " is not determined");
        } else if (identify_at_end(fit)) {
            text_add(text, sizeof text, " %.5g, at the end of its range", fit->value);
        } else {
            text_add(text, sizeof text, " %.5g +- %.2g%s%s", fit->value,
                     fit->standard_error, unit[0] ? " " : "", unit);
        }
    }

    // what to think of the fit as a whole
    if (id->undetermined > 0) {
        return act_tell(input, "%s: fit fewer, or record more", text);
    }
    if (misfits) {
        return act_tell(input, "%s; pinned, but far off the data", text);
    }
    if (id->white) {
        return act_tell(input, "%s; that run is pinned", text);
    }
    return act_tell(input, "%s; pinned, but the data show more than the model has", text);
}

// Pins the run that was compared with the data in the end, and lays these under it.
static status pin_fitted(explorer_model *model, const identification *id, fault *f)
{
    scenario fitted, copy;
    session other;
    const recorded_trace *t = &id->traces[0];
    TRY(identify_scenario(id, 0, &fitted, f));
    TRY(scenario_copy(&copy, &fitted));
    TRY(session_open(&other, &copy, HUGE_VAL, f));
    const status code = run_list_pin(&model->pinned, &other, "identified", f);
    session_finish(&other);
    if (code == STATUS_OK) {
        model_lay_data(model, -(t->begin + t->own[OWN_SHIFT]));
    }
    return code;
}

// Fits parameters to the measured data and pins the run that they give.
bool act_identify(explorer_model *model, explorer_input *input, const char *argument)
{
    char words[LINE_TEXT], *rest = words;
    identification id = {.base = &model->session.effective,
                         .starts = FIT_STARTS,
                         .jobs = FIT_THREADS};
    if (argument[0] == '\0') {
        return act_refuse(input, "identify takes parameters, such as k2 stiction");
    }
    if (model->measured.row_count == 0) {
        return act_refuse(input, "there are no measured data: :data FILE.csv");
    }
    if (!(act_need_whole_run(model, input) &&
          act_need_short_runs(model, input, "identify", FIT_RUNS))) {
        return false;
    }

    // a parameter may be given by the last part of its path
    fault *f = &input->fault;
    status code = identify_available(f);
    snprintf(words, sizeof words, "%s", argument);
    for (char *word; code == STATUS_OK && (word = strtok_r(rest, " ", &rest)) != NULL;) {
        char path[2 * LINE_TEXT];
        code = identify_add_path(&id, act_full_path(word, path, sizeof path), f);
    }
    if (code == STATUS_OK) {
        code = identify_add_trace(&id, model->measured_file, NULL, 0, f);
    }
    if (code == STATUS_OK) {
        code = identify_fit(&id, f);
    }
    bool determined = false;
    for (int i = 0; i < id.count; i++) {
        determined = determined || id.fit[i].determined;
    }
    if (code == STATUS_OK && determined) {
        code = pin_fitted(model, &id, f);
    }
    const bool done = act_succeeded(input, code) && tell_fit(input, &id),
               all = id.undetermined == 0;
    identify_finish(&id);
    return done && act_apply_baseline(model, input) && all;
}
