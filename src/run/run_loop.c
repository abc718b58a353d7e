#include "src/run/run_loop.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/rig/controller_values.h"
#include "src/run/run_driver.h"
#include "src/run/saved_block.h"

// A multiple of method.step that is nearer than this share of it is the present instant.
#define GRID_TOLERANCE 1e-9

struct run_loop {
    scenario scenario; // a copy
    run_options options;
    given_law law;
    run_result result;
    run_driver driver;
    double volts;    // the command of a commanded loop [V]
    bool ended;      // it has come to the end of the run
    status failed;   // what stopped it before its end, if anything
    fault fault;     // and the sentence for that
    uint64_t origin; // saved states of loops with the same one can be restored
};

// --- the controller of a commanded loop ------------------------------------------------

// The controller's sample function: its memory is the address of the loop's command.
static void put_out(void *memory, const controller_input *input,
                    controller_output *output)
{
    const double *const *volts = memory;
    (void)input;
    output->command = **volts;
}

static const controller commanded_law =
    ONE_MODE_CONTROLLER("the program", "command", sizeof(const double *), put_out,
                        .tune = NULL);

// --- beginning and end -----------------------------------------------------------------

// A hash of what two loops must have in common to exchange states: scenario, version and
// the controller's name. A controller of somebody else may keep addresses in its memory,
// so that its states are for the same loop only.
static uint64_t origin_of(const run_loop *l)
{
    const scenario *s = &l->scenario;
    const rig *r = l->driver.recording.rig;
    uint64_t origin = block_origin(s);
    const bool foreign =
        r != NULL && r->law != &commanded_law &&
        (l->law.law != NULL || controller_of(s->parameters.control.law) == NULL);
    if (foreign) {
        char address[32];
        snprintf(address, sizeof address, "%p", (const void *)l);
        origin = block_origin_with(origin, address);
    }
    return block_origin_with(origin, r == NULL ? "bare" : r->law->name);
}

status loop_create(run_loop **created, const scenario *s, const loop_options *options,
                   fault *f)
{
    *created = NULL;
    run_loop *l = calloc(1, sizeof *l);
    if (l == NULL || scenario_copy(&l->scenario, s) != STATUS_OK) {
        free(l);
        return fault_no_memory(f);
    }

    // the controller: the program's command, a law that it gives, or control.law
    if (s->parameters.control.law == LAW_NONE) {
        l->volts = s->parameters.motor.voltage;
    } else {
        l->volts = 0;
    }
    if (options->commanded) {
        l->law = (given_law){&commanded_law, &l->volts};
    } else {
        l->law = options->law;
    }
    l->options = (run_options){.keep_trace = options->keep_trace,
                               .law = l->law.law != NULL ? &l->law : NULL,
                               .ask = options->ask,
                               .ask_context = options->ask_context,
                               .stepped = true};

    // the run at its start
    const status code = driver_open(&l->driver, &l->scenario, &l->options, &l->result, f);
    if (code != STATUS_OK) {
        loop_destroy(l);
        return code;
    }
    l->origin = origin_of(l);
    *created = l;
    return STATUS_OK;
}

void loop_destroy(run_loop *l)
{
    if (l != NULL) {
        driver_close(&l->driver, STATUS_STOPPED, &l->fault);
        run_finish(&l->result);
        scenario_finish(&l->scenario);
        free(l);
    }
}

// --- continuing ------------------------------------------------------------------------

double loop_time(const run_loop *l)
{
    return driver_time(&l->driver);
}

bool loop_ended(const run_loop *l)
{
    return l->ended;
}

// Says in f what ended the run, in every call after that. A stop on request is reported
// once and then forgotten, so that the run can continue.
static status report_failure(run_loop *l, fault *f)
{
    const status code = l->failed;
    if (code != STATUS_OK && l->fault.code == STATUS_OK) {
        fault_set(&l->fault, code, "at t = %.9g s: %s", loop_time(l), status_text(code));
    }
    if (code != STATUS_OK) {
        *f = l->fault;
    }

    // a stop on request
    if (code == STATUS_STOPPED) {
        l->failed = STATUS_OK;
        l->fault = (fault){.text = "", .path = ""};
    }
    return code;
}

status loop_until(run_loop *l, double time, fault *f)
{
    assert(isfinite(time));
    if (l->failed == STATUS_OK) {
        l->failed = driver_advance(&l->driver, time, &l->ended, &l->fault);
    }
    return report_failure(l, f);
}

status loop_step(run_loop *l, fault *f)
{
    const rig *on = l->driver.recording.rig;
    const double interval = l->driver.recording.now.method.step;

    // the next multiple of the step or, with a rig, its next sample after that which it
    // takes now; a model that stops at rows goes on to a row at least
    double next = (floor(loop_time(l) / interval + GRID_TOLERANCE) + 1) * interval;
    if (on != NULL && l->failed == STATUS_OK && !l->ended) {
        l->failed = driver_prepare_step(&l->driver, &l->ended, &l->fault);
        if (!l->driver.model->stops_at_rows) {
            next = on->sample_time;
        }
        next = fmax(next, on->sample_time);
    }
    return loop_until(l, next, f);
}

// --- inputs ----------------------------------------------------------------------------

void loop_command(run_loop *l, double volts)
{
    l->volts = volts;
}

// Carries out an action from outside at the present instant; one that is refused changes
// nothing.
static status act(run_loop *l, const action *todo, fault *f)
{
    if (l->failed != STATUS_OK) {
        return report_failure(l, f);
    }

    // what cannot be done in this run
    FAULT_IF(todo->kind == ACTION_PUSH && !l->driver.model->takes_pushes, f,
             STATUS_BAD_ARGUMENT, "the printed model takes no pushes");
    if (todo->kind == ACTION_SET &&
        !rig_can_change(&l->driver.recording.now, todo->parameter)) {
        const char *path = parameter_table[todo->parameter].path;
        return fault_set_at(f, STATUS_BAD_ARGUMENT, path,
                            "%s holds from the start and cannot change during this run",
                            path);
    }

    // it is tried on a copy of the parameters, and the rig checks that
    parameters tried = l->driver.recording.now;
    if (todo->kind == ACTION_SET) {
        TRY(parameter_may_change(&tried, todo->parameter, f));
    }
    TRY(action_apply(todo, &tried, f));
    const rig *on = l->driver.recording.rig;
    if (on != NULL) {
        int mode;
        TRY(rig_find_mode(on->law, tried.control.lock, &mode, f));
        TRY(rig_takes(on, &tried, f));
        TRY(parameters_check_timing(&tried, f));
    }

    // then it is done; a wall that would be behind the arm is refused here
    const status code = driver_act(&l->driver, todo, &l->fault);
    if (code == STATUS_BAD_SCENARIO) {
        *f = l->fault;
        l->fault = (fault){0};
        return code;
    }
    l->failed = code;
    return report_failure(l, f);
}

status loop_set_number(run_loop *l, int parameter, double value, fault *f)
{
    assert(parameter >= 0 && parameter < parameter_count);
    const action todo = {.time = loop_time(l),
                         .kind = ACTION_SET,
                         .parameter = parameter,
                         .value = value};
    return act(l, &todo, f);
}

status loop_set_text(run_loop *l, int parameter, const char *text, fault *f)
{
    assert(parameter >= 0 && parameter < parameter_count);

    // read into a copy, so that a bad text changes nothing
    parameters read = l->driver.recording.now;
    TRY(parameter_set_text(&read, parameter, text, f));

    // then it is an action like any other
    const action todo = action_of(loop_time(l), &read, parameter, text);
    return act(l, &todo, f);
}

status loop_set_setting(run_loop *l, const char *name, double value, fault *f)
{
    action todo = {.time = loop_time(l),
                   .kind = ACTION_SET,
                   .parameter = PARAMETER_INDEX(control.settings),
                   .value = value};
    snprintf(todo.text, sizeof todo.text, ".%s", name);
    return act(l, &todo, f);
}

status loop_push(run_loop *l, double impulse, fault *f)
{
    assert(isfinite(impulse));
    const action todo = {.time = loop_time(l), .kind = ACTION_PUSH, .value = impulse};
    return act(l, &todo, f);
}

// --- what is known ---------------------------------------------------------------------

bool loop_sense(run_loop *l, sensor_reading *reading)
{
    rig *on = l->driver.recording.rig;
    if (on == NULL) {
        return false;
    }
    if (!l->ended) {
        const sensed_motion now = driver_sensed(&l->driver);
        rig_read(on, loop_time(l), &now);
    }
    *reading = on->reading;
    return true;
}

sample loop_row(run_loop *l)
{
    return driver_row(&l->driver);
}

const double *loop_state(const run_loop *l, int *angle_count)
{
    return driver_state(&l->driver, angle_count);
}

summary loop_summary(run_loop *l)
{
    status code = STATUS_STOPPED;
    if (!(l->failed == STATUS_OK && !l->ended)) {
        code = l->failed;
    }
    return driver_summary(&l->driver, code, &l->fault);
}

const run_result *loop_result(const run_loop *l)
{
    return &l->result;
}

const scenario *loop_scenario(const run_loop *l)
{
    return &l->scenario;
}

// --- the state as bytes ----------------------------------------------------------------

// What stands between the head of a saved state and the bytes of the driver.
typedef struct saved_loop {
    uint64_t ended;
    double volts;
} saved_loop;

static const block_kind loop_block = {"armstate", 1, "state of a loop"};

size_t loop_saved_size(const run_loop *l)
{
    return sizeof(block_head) + sizeof(saved_loop) + driver_saved_size(&l->driver);
}

void loop_save(const run_loop *l, void *bytes)
{
    const saved_loop own = {.ended = l->ended, .volts = l->volts};
    char *at = (char *)bytes + sizeof(block_head);
    memcpy(at, &own, sizeof own);
    driver_save(&l->driver, at + sizeof own);
    block_seal(bytes, loop_saved_size(l), &loop_block, l->origin);
}

status loop_restore(run_loop *l, const void *bytes, size_t size, fault *f)
{
    const rig *on = l->driver.recording.rig;
    FAULT_IF(on != NULL && on->process != NULL, f, STATUS_BAD_ARGUMENT,
             "a program as the controller cannot go back to a saved state");

    // the bytes must be a whole state of this loop
    TRY(block_check(bytes, size, &loop_block, l->origin, f));
    assert(size == loop_saved_size(l));

    // go back to it
    const char *at = (const char *)bytes + sizeof(block_head);
    saved_loop own;
    memcpy(&own, at, sizeof own);
    l->volts = own.volts;
    l->ended = own.ended != 0;
    l->failed = STATUS_OK;
    l->fault = (fault){.text = "", .path = ""};
    driver_restore(&l->driver, at + sizeof own);
    return STATUS_OK;
}
