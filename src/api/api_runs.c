// Runs of libimpactlab, and what they leave behind.
#include <stdlib.h>

#include "src/api/api_handles.h"
#include "src/base/json.h"
#include "src/rig/controller.h"
#include "src/run/export.h"
#include "src/run/row_grid.h"
#include "src/run/run.h"
#include "src/run/saved_run.h"

// Checks that the rig can use a controller that a program gives.
static int check_law(const controller *law, impactlab_error *error)
{
    if (law->interface != CONTROLLER_INTERFACE) {
        return api_fail(
            error, STATUS_BAD_ARGUMENT,
            "the controller was made for version %d of the interface, expected %d",
            law->interface, CONTROLLER_INTERFACE);
    }

    // what the rig relies on without checking
    if (law->name == NULL || law->modes == NULL || law->sample == NULL ||
        law->memory_size < sizeof(void *) || law->parameter_count < 0 ||
        (law->parameter_count > 0 && law->parameters == NULL)) {
        return api_fail(
            error, STATUS_BAD_ARGUMENT,
            "the controller is not whole, expected a name, modes ended by NULL, "
            "`sample`, and memory for at least a pointer");
    }
    return IMPACTLAB_OK;
}

impactlab_run *api_new_run(const scenario *s, impactlab_error *error)
{
    impactlab_run *made = calloc(1, sizeof *made);
    if (made == NULL || scenario_copy(&made->scenario, s) != STATUS_OK) {
        free(made);
        api_fail(error, STATUS_NO_MEMORY, "no memory for a run");
        return NULL;
    }
    return made;
}

int impactlab_run_create(impactlab_run **run, const impactlab_scenario *handle, int flags,
                         impactlab_error *error)
{
    return impactlab_run_create_with(run, handle, flags, NULL, NULL, error);
}

int impactlab_run_create_with(impactlab_run **run, const impactlab_scenario *handle,
                              int flags, const struct controller *law, void *context,
                              impactlab_error *error)
{
    API_NEEDS(error, run);
    *run = NULL;
    API_NEEDS(error, handle);
    if ((flags & ~IMPACTLAB_KEEP_ROWS) != 0) {
        return api_fail(error, STATUS_BAD_ARGUMENT,
                        "a run knows no other flag than KEEP_ROWS");
    }
    if (law != NULL && check_law(law, error) != IMPACTLAB_OK) {
        return IMPACTLAB_BAD_ARGUMENT;
    }

    // the whole run; the caller gets it even if it failed
    impactlab_run *made = api_new_run(&handle->scenario, error);
    if (made == NULL) {
        return IMPACTLAB_NO_MEMORY;
    }
    const given_law given = {law, context};
    const run_options options = {.keep_trace = (flags & IMPACTLAB_KEEP_ROWS) != 0,
                                 .law = law != NULL ? &given : NULL,
                                 .ask = handle->ask,
                                 .ask_context = handle->ask_context};
    status code = run_scenario_with(&made->scenario, &options, &made->result);
    *run = made;
    fault f = {.text = "", .path = ""};
    if (code != STATUS_OK) {
        code = summary_fault(&made->result.summary, &f);
    }
    if (code != STATUS_OK) {
        return api_error(error, &f);
    }
    return api_done(error);
}

void impactlab_run_destroy(impactlab_run *run)
{
    if (run != NULL) {
        run_finish(&run->result);
        scenario_finish(&run->scenario);
        free(run);
    }
}

// --- what it came to -------------------------------------------------------------------

const char *impactlab_run_status(const impactlab_run *run)
{
    if (run != NULL) {
        return summary_status(&run->result.summary);
    }
    return "failed";
}

const char *impactlab_run_message(const impactlab_run *run)
{
    if (run != NULL) {
        return run->result.summary.message;
    }
    return "";
}

int impactlab_run_quantity(const impactlab_run *run, const char *key, double *value,
                           impactlab_error *error)
{
    API_NEEDS(error, run, key, value);
    int index = summary_find(key);
    if (index < 0) {
        return api_fail_unknown(error, "quantity", key, summary_suggest(key));
    }
    *value = summary_value(&run->result.summary, index);
    return api_done(error);
}

size_t impactlab_run_quantities(const impactlab_run *run, double *values, size_t count)
{
    for (size_t i = 0;
         run != NULL && values != NULL && i < count && i < (size_t)summary_count; i++) {
        values[i] = summary_value(&run->result.summary, (int)i);
    }
    return (size_t)summary_count;
}

int impactlab_run_signal(const impactlab_run *run, const char *name,
                         impactlab_series *series, impactlab_error *error)
{
    API_NEEDS(error, run, name, series);
    int index = api_signal(name, error);
    if (index < 0) {
        return IMPACTLAB_BAD_ARGUMENT;
    }

    // the values are not copied: they are in the rows, one row's size apart
    const trace *t = &run->result.trace;
    *series = (impactlab_series){.count = t->row_count, .stride = sizeof(sample)};
    if (t->row_count > 0) {
        const char *row = (const char *)t->rows;
        series->values = (const double *)(const void *)(row + signal_table[index].offset);
    }
    return api_done(error);
}

int impactlab_run_angles(const impactlab_run *run, impactlab_table *table,
                         impactlab_error *error)
{
    API_NEEDS(error, run, table);
    const trace *t = &run->result.trace;
    *table = (impactlab_table){t->angles, t->row_count, (size_t)t->angle_count};
    return api_done(error);
}

int impactlab_run_velocities(const impactlab_run *run, impactlab_table *table,
                             impactlab_error *error)
{
    API_NEEDS(error, run, table);
    const trace *t = &run->result.trace;
    *table = (impactlab_table){t->velocities, t->row_count, (size_t)t->angle_count};
    return api_done(error);
}

size_t impactlab_run_event_count(const impactlab_run *run)
{
    if (run != NULL) {
        return run->result.trace.event_count;
    }
    return 0;
}

int impactlab_run_event(const impactlab_run *run, size_t index, impactlab_event *told)
{
    if (told == NULL || index >= impactlab_run_event_count(run)) {
        return 0;
    }
    const event *e = &run->result.trace.events[index];
    *told =
        (impactlab_event){e->time, event_name(e->kind), e->impulse, e->speed, e->loss};
    return 1;
}

// Rows beyond this are taken for a mistyped interval.
#define MOST_GRID_ROWS 1e9

// Where the rows of a grid go: signals in the order of their table.
typedef struct grid_rows {
    double *values;
    size_t most, count;
} grid_rows;

static status take_grid_row(void *context, const sample *row, const double *angles)
{
    (void)angles;
    grid_rows *rows = context;
    for (int i = 0; i < signal_count && rows->count < rows->most; i++) {
        rows->values[rows->count * (size_t)signal_count + (size_t)i] =
            signal_value(row, i);
    }
    rows->count++;
    return STATUS_OK;
}

int impactlab_run_grid(const impactlab_run *run, double every, double *values,
                       size_t most, size_t *count, impactlab_error *error)
{
    API_NEEDS(error, run, count);
    const trace *t = &run->result.trace;
    if (!(every > 0) ||
        (t->row_count > 0 && t->rows[t->row_count - 1].time / every > MOST_GRID_ROWS)) {
        return api_fail(error, STATUS_BAD_ARGUMENT,
                        "rows every %g s, expected more than 0 and at most %g rows",
                        every, MOST_GRID_ROWS);
    }
    grid_rows rows = {.values = values, .most = values != NULL ? most : 0};
    if (row_grid_of_trace(t, every, take_grid_row, &rows) != STATUS_OK) {
        return api_fail(error, STATUS_NO_MEMORY, "no memory for a row");
    }
    *count = rows.count;
    return api_done(error);
}

// --- as bytes --------------------------------------------------------------------------

size_t impactlab_run_saved_size(const impactlab_run *run)
{
    if (run != NULL) {
        return run_saved_size(&run->result);
    }
    return 0;
}

int impactlab_run_save(const impactlab_run *run, void *bytes, size_t size,
                       impactlab_error *error)
{
    API_NEEDS(error, run, bytes);
    const size_t needed = run_saved_size(&run->result);
    if (size < needed) {
        return api_fail(error, STATUS_BAD_ARGUMENT,
                        "this run has %zu bytes, but there is room for %zu", needed,
                        size);
    }
    run_save(&run->result, &run->scenario, bytes);
    return api_done(error);
}

int impactlab_run_restore(impactlab_run **run, const impactlab_scenario *handle,
                          const void *bytes, size_t size, impactlab_error *error)
{
    API_NEEDS(error, run);
    *run = NULL;
    API_NEEDS(error, handle, bytes);
    impactlab_run *made = api_new_run(&handle->scenario, error);
    if (made == NULL) {
        return IMPACTLAB_NO_MEMORY;
    }
    fault f = {.text = "", .path = ""};
    if (run_restore(&made->result, &made->scenario, bytes, size, &f) != STATUS_OK) {
        impactlab_run_destroy(made);
        return api_error(error, &f);
    }
    *run = made;
    return api_done(error);
}

// --- as texts --------------------------------------------------------------------------

static void write_json(FILE *stream, const void *what)
{
    const impactlab_run *run = what;
    json_t *object = export_run(&run->scenario, &run->result);
    json_write(stream, object);
    json_decref(object);
}

static void write_csv(FILE *stream, const void *what)
{
    const impactlab_run *run = what;
    export_csv(stream, &run->scenario, &run->result.trace);
}

int impactlab_run_json(const impactlab_run *run, char **json, impactlab_error *error)
{
    API_NEEDS(error, run, json);
    return api_text(json, write_json, run, error);
}

int impactlab_run_csv(const impactlab_run *run, char **csv, impactlab_error *error)
{
    API_NEEDS(error, run, csv);
    return api_text(csv, write_csv, run, error);
}

// --- what was predicted ----------------------------------------------------------------

int impactlab_run_predictions(const impactlab_run *run, impactlab_prediction *predictions,
                              size_t count, size_t *written, impactlab_error *error)
{
    API_NEEDS(error, run, predictions, written);
    prediction_answer answers[PREDICTOR_COUNT];
    *written = 0;
    if (run->result.trace.row_count == 0) {
        return api_fail(error, STATUS_BAD_ARGUMENT,
                        "the run kept no rows, expected KEEP_ROWS");
    }
    if (predict_first_contact(&run->scenario, &run->result, NULL, answers) == NULL) {
        return api_fail(error, STATUS_BAD_ARGUMENT,
                        "the arm did not touch the wall after a free flight in this run");
    }

    // the answers, as many as there is room for
    for (size_t i = 0; i < count && i < PREDICTOR_COUNT; i++) {
        const prediction_answer *a = &answers[i];
        if (a->fault.code == STATUS_NO_MEMORY) {
            return api_error(error, &a->fault);
        }
        predictions[i] = (impactlab_prediction){.method = a->name,
                                                .known = prediction_known(a),
                                                .holds = a->outcome == PREDICTION_HOLDS,
                                                .peak = a->prediction.force,
                                                .time_to_peak = a->prediction.delay,
                                                .impulse = a->prediction.impulse};
        snprintf(predictions[i].message, sizeof predictions[i].message, "%s",
                 prediction_reason(a));
        *written = i + 1;
    }
    return api_done(error);
}
