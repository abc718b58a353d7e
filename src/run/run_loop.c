#include "src/run/run_loop.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/random.h"
#include "src/base/shipped.h"
#include "src/rig/controller_values.h"
#include "src/run/run_driver.h"

// A multiple of method.step that is nearer than this share of it is the present instant.
#define GRID_TOLERANCE 1e-9

struct run_loop {
    scenario scenario; // a copy
    run_options options;
    given_law law;
    run_result result;
    run_driver driver;
    double volts;         // the command of a commanded loop [V]
    bool ended;           // it has come to the end of the run
    status failed;        // what stopped it before its end, if anything
    fault fault;          // and the sentence for that
    uint64_t fingerprint; // saved states of loops with the same one can be restored
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

// Continues a 64-bit FNV-1a hash with a text and a byte that ends it.
static uint64_t hash_text(uint64_t hash, const char *text)
{
    for (; *text != '\0'; text++) {
        hash = (hash ^ (unsigned char)*text) * 0x100000001b3u;
    }
    return (hash ^ 0xff) * 0x100000001b3u;
}

// A hash of what two loops must have in common to exchange states: the version, every
// parameter, the script and the controller's name. A controller of somebody else may keep
// addresses in its memory, so that its states are for the same loop only.
static uint64_t fingerprint_of(const run_loop *l)
{
    // version and parameters
    const scenario *s = &l->scenario;
    char text[PARAMETER_TEXT_SIZE];
    uint64_t hash = hash_text(0xcbf29ce484222325u, lab_version());
    for (int i = 0; i < parameter_count; i++) {
        parameter_format(&s->parameters, i, text, sizeof text);
        hash = hash_text(hash, text);
    }

    // the script
    for (int i = 0; i < s->action_count; i++) {
        const action *a = &s->actions[i];
        snprintf(text, sizeof text, "%a %d %d %a", a->time, (int)a->kind, a->parameter,
                 a->value);
        hash = hash_text(hash_text(hash, text), a->text);
    }

    // the controller
    const rig *r = l->driver.recording.rig;
    const bool foreign =
        r != NULL && r->law != &commanded_law &&
        (l->law.law != NULL || controller_of(s->parameters.control.law) == NULL);
    if (foreign) {
        snprintf(text, sizeof text, "%p", (const void *)l);
        hash = hash_text(hash, text);
    }
    return hash_text(hash, r == NULL ? "bare" : r->law->name);
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
    l->fingerprint = fingerprint_of(l);
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

// The first part of a saved state, without padding; the bytes of the driver follow.
typedef struct saved_head {
    char magic[8];    // SAVED_MAGIC
    uint64_t version; // SAVED_VERSION, of how the bytes are laid out
    uint64_t size;    // of the whole block [bytes]
    uint64_t fingerprint;
    uint64_t check; // check_of what follows it
    uint64_t ended;
    double volts;
} saved_head;

#define SAVED_MAGIC   "armstate"
#define SAVED_VERSION 1

static_assert(sizeof(saved_head) == 7 * sizeof(uint64_t), "the head has no padding");

size_t loop_saved_size(const run_loop *l)
{
    return sizeof(saved_head) + driver_saved_size(&l->driver);
}

// A 64-bit checksum of the bytes of a block after the head's `check`. Eight bytes at a
// time go into the state of splitmix64, whose mixing makes other bytes have the same sum
// by chance only, once in 2^64.
static uint64_t check_of(const char *bytes, size_t size)
{
    uint64_t check = size;
    size_t at = offsetof(saved_head, check) + sizeof check;
    for (; at < size; at += sizeof check) {
        uint64_t word = 0;
        memcpy(&word, bytes + at, size - at < sizeof word ? size - at : sizeof word);
        word ^= check;
        check = splitmix64_next(&word);
    }
    return check;
}

void loop_save(const run_loop *l, void *bytes)
{
    const size_t size = loop_saved_size(l);
    saved_head head = {.version = SAVED_VERSION,
                       .size = size,
                       .fingerprint = l->fingerprint,
                       .ended = l->ended,
                       .volts = l->volts};
    memcpy(head.magic, SAVED_MAGIC, sizeof head.magic);
    memcpy(bytes, &head, sizeof head);
    driver_save(&l->driver, (char *)bytes + sizeof head);
    head.check = check_of(bytes, size);
    memcpy(bytes, &head, sizeof head);
}

// Says in f why bytes are no whole state of this loop.
static status check_saved(const run_loop *l, const void *bytes, size_t size, fault *f)
{
    const size_t expected = loop_saved_size(l);
    saved_head head;
    FAULT_IF(size < sizeof head || memcmp(bytes, SAVED_MAGIC, sizeof head.magic) != 0, f,
             STATUS_BAD_ARGUMENT, "the bytes are no saved state of a loop");
    memcpy(&head, bytes, sizeof head);
    FAULT_IF(head.version != SAVED_VERSION, f, STATUS_BAD_ARGUMENT,
             "the state is laid out as in version %llu, expected %d",
             (unsigned long long)head.version, SAVED_VERSION);

    // then its sum, before anything that it says is relied on
    FAULT_IF(head.size != size, f, STATUS_BAD_ARGUMENT,
             "a state of this loop has %zu bytes, but %zu were given", expected, size);
    FAULT_IF(head.check != check_of(bytes, size), f, STATUS_BAD_ARGUMENT,
             "the state is damaged, expected the bytes as they were saved");
    FAULT_IF(head.fingerprint != l->fingerprint || size != expected, f,
             STATUS_BAD_ARGUMENT,
             "the state is of another scenario, another controller or another version");
    return STATUS_OK;
}

status loop_restore(run_loop *l, const void *bytes, size_t size, fault *f)
{
    const rig *on = l->driver.recording.rig;
    FAULT_IF(on != NULL && on->process != NULL, f, STATUS_BAD_ARGUMENT,
             "a program as the controller cannot go back to a saved state");

    TRY(check_saved(l, bytes, size, f));

    // go back to it
    saved_head head;
    memcpy(&head, bytes, sizeof head);
    l->volts = head.volts;
    l->ended = head.ended != 0;
    l->failed = STATUS_OK;
    l->fault = (fault){.text = "", .path = ""};
    driver_restore(&l->driver, (const char *)bytes + sizeof head);
    return STATUS_OK;
}
