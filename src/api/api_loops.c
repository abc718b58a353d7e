// Loops of libimpactlab: a run that a program steps.
#include <math.h>
#include <stdlib.h>

#include "src/api/api_handles.h"

int impactlab_loop_create(impactlab_loop **loop, const impactlab_scenario *handle,
                          int flags, impactlab_error *error)
{
    API_NEEDS(error, loop);
    *loop = NULL;
    API_NEEDS(error, handle);
    if ((flags & ~(IMPACTLAB_KEEP_ROWS | IMPACTLAB_COMMAND)) != 0) {
        return api_fail(error, STATUS_BAD_ARGUMENT,
                        "a loop knows no other flags than KEEP_ROWS and COMMAND");
    }
    impactlab_loop *made = calloc(1, sizeof *made);
    if (made == NULL) {
        return api_fail(error, STATUS_NO_MEMORY, "no memory for a loop");
    }

    fault f = {.text = "", .path = ""};
    const loop_options options = {.keep_trace = (flags & IMPACTLAB_KEEP_ROWS) != 0,
                                  .commanded = (flags & IMPACTLAB_COMMAND) != 0,
                                  .ask = handle->ask,
                                  .ask_context = handle->ask_context};
    if (loop_create(&made->loop, &handle->scenario, &options, &f) != STATUS_OK) {
        free(made);
        return api_error(error, &f);
    }
    made->commanded = options.commanded;
    *loop = made;
    return api_done(error);
}

void impactlab_loop_destroy(impactlab_loop *loop)
{
    if (loop != NULL) {
        loop_destroy(loop->loop);
        free(loop);
    }
}

// --- going on --------------------------------------------------------------------------

int impactlab_loop_step(impactlab_loop *loop, impactlab_error *error)
{
    API_NEEDS(error, loop);
    fault f = {.text = "", .path = ""};
    if (loop_step(loop->loop, &f) != STATUS_OK) {
        return api_error(error, &f);
    }
    return api_done(error);
}

int impactlab_loop_step_until(impactlab_loop *loop, double time, impactlab_error *error)
{
    API_NEEDS(error, loop);
    if (!isfinite(time)) {
        return api_fail(error, STATUS_BAD_ARGUMENT,
                        "the instant is not finite, expected seconds");
    }
    fault f = {.text = "", .path = ""};
    if (loop_until(loop->loop, time, &f) != STATUS_OK) {
        return api_error(error, &f);
    }
    return api_done(error);
}

double impactlab_loop_time(const impactlab_loop *loop)
{
    if (loop != NULL) {
        return loop_time(loop->loop);
    }
    return (double)NAN;
}

int impactlab_loop_ended(const impactlab_loop *loop)
{
    return loop == NULL || loop_ended(loop->loop);
}

// --- inputs ----------------------------------------------------------------------------

int impactlab_loop_command(impactlab_loop *loop, double volts, impactlab_error *error)
{
    API_NEEDS(error, loop);
    if (!loop->commanded) {
        return api_fail(
            error, STATUS_BAD_ARGUMENT,
            "the loop was created without COMMAND: control.law commands the rig, "
            "or motor.voltage the bare arm");
    }
    if (!isfinite(volts)) {
        return api_fail(error, STATUS_BAD_ARGUMENT,
                        "the command is not finite, expected volts");
    }
    loop_command(loop->loop, volts);
    return api_done(error);
}

int impactlab_loop_set_input(impactlab_loop *loop, const char *path, double value,
                             impactlab_error *error)
{
    API_NEEDS(error, loop, path);
    sweep_axis axis;
    TRY((status)api_axis(path, &axis, error));

    // one number of control.settings by its name
    fault f = {.text = "", .path = ""};
    const char *name = settings_name(path);
    status code;
    if (name != NULL) {
        code = loop_set_setting(loop->loop, name, value, &f);
    } else {
        code = loop_set_number(loop->loop, axis.parameter, value, &f);
    }
    if (code != STATUS_OK) {
        return api_error(error, &f);
    }
    return api_done(error);
}

int impactlab_loop_set_text(impactlab_loop *loop, const char *path, const char *text,
                            impactlab_error *error)
{
    API_NEEDS(error, loop, path, text);
    char room[PARAMETER_TEXT_SIZE];
    const int index = api_parameter(path, &text, room, error);
    if (index < 0) {
        return IMPACTLAB_BAD_ARGUMENT;
    }
    fault f = {.text = "", .path = ""};
    if (loop_set_text(loop->loop, index, text, &f) != STATUS_OK) {
        return api_error(error, &f);
    }
    return api_done(error);
}

int impactlab_loop_push(impactlab_loop *loop, double impulse, impactlab_error *error)
{
    API_NEEDS(error, loop);
    if (!isfinite(impulse)) {
        return api_fail(error, STATUS_BAD_ARGUMENT,
                        "the impulse is not finite, expected N s");
    }
    fault f = {.text = "", .path = ""};
    if (loop_push(loop->loop, impulse, &f) != STATUS_OK) {
        return api_error(error, &f);
    }
    return api_done(error);
}

// --- what is known ---------------------------------------------------------------------

int impactlab_loop_read_sensors(impactlab_loop *loop, impactlab_reading *reading,
                                impactlab_error *error)
{
    API_NEEDS(error, loop, reading);

    // the bare arm has no rig around it
    sensor_reading read;
    if (!loop_sense(loop->loop, &read)) {
        return api_fail(error, STATUS_BAD_ARGUMENT,
                        "the bare arm has no sensors, expected a control.law or COMMAND");
    }

    // field by field: the library's layout is fixed, that of the program may change
    *reading = (impactlab_reading){.time = loop_time(loop->loop),
                                   .encoder = read.encoder,
                                   .tachometer = read.tachometer,
                                   .force = read.force_reading,
                                   .piezo_force = read.piezo_force,
                                   .film = read.film,
                                   .accelerometer = read.accelerometer};
    return api_done(error);
}

int impactlab_loop_signal(impactlab_loop *loop, const char *name, double *value,
                          impactlab_error *error)
{
    API_NEEDS(error, loop, name, value);
    int index = api_signal(name, error);
    if (index < 0) {
        return IMPACTLAB_BAD_ARGUMENT;
    }
    const sample row = loop_row(loop->loop);
    *value = signal_value(&row, index);
    return api_done(error);
}

size_t impactlab_loop_signals(impactlab_loop *loop, double *values, size_t count)
{
    if (loop != NULL && values != NULL) {
        const sample row = loop_row(loop->loop);
        for (size_t i = 0; i < count && i < (size_t)signal_count; i++) {
            values[i] = signal_value(&row, (int)i);
        }
    }
    return (size_t)signal_count;
}

int impactlab_loop_state(const impactlab_loop *loop, impactlab_table *table,
                         impactlab_error *error)
{
    API_NEEDS(error, loop, table);
    int freedoms;
    const double *angles = loop_state(loop->loop, &freedoms);
    *table = (impactlab_table){angles, 2, (size_t)freedoms};
    return api_done(error);
}

int impactlab_loop_run(impactlab_loop *loop, impactlab_run **run, impactlab_error *error)
{
    API_NEEDS(error, run);
    *run = NULL;
    API_NEEDS(error, loop);

    // the run is a copy, so that the loop can continue or end
    impactlab_run *made = api_new_run(loop_scenario(loop->loop), error);
    if (made == NULL) {
        return IMPACTLAB_NO_MEMORY;
    }
    const trace *rows = &loop_result(loop->loop)->trace;
    trace_init(&made->result.trace, rows->angle_count);
    if (trace_share(&made->result.trace, rows, rows->row_count, rows->event_count) !=
        STATUS_OK) {
        impactlab_run_destroy(made);
        return api_fail(error, STATUS_NO_MEMORY, "no memory for the rows of a run");
    }

    // the caller gets only a complete one
    made->result.summary = loop_summary(loop->loop);
    *run = made;
    return api_done(error);
}

// --- states ----------------------------------------------------------------------------

size_t impactlab_loop_state_size(const impactlab_loop *loop)
{
    if (loop != NULL) {
        return loop_saved_size(loop->loop);
    }
    return 0;
}

int impactlab_loop_save_state(const impactlab_loop *loop, void *bytes, size_t size,
                              impactlab_error *error)
{
    API_NEEDS(error, loop, bytes);
    if (size < loop_saved_size(loop->loop)) {
        return api_fail(error, STATUS_BAD_ARGUMENT,
                        "a state of this loop has %zu bytes, but there is room for %zu",
                        loop_saved_size(loop->loop), size);
    }
    loop_save(loop->loop, bytes);
    return api_done(error);
}

int impactlab_loop_restore_state(impactlab_loop *loop, const void *bytes, size_t size,
                                 impactlab_error *error)
{
    API_NEEDS(error, loop, bytes);
    fault f = {.text = "", .path = ""};
    if (loop_restore(loop->loop, bytes, size, &f) != STATUS_OK) {
        return api_error(error, &f);
    }
    return api_done(error);
}
