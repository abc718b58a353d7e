#include "src/run/loop.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/instant.h"
#include "src/base/version.h"
#include "src/run/corrected.h"
#include "src/run/corrected_events.h"
#include "src/run/recording_frame.h"

#define GRID_TOLERANCE 1e-9 // of a step: a row of the grid so near is the present one

// What the controller of a commanded loop remembers: where its command stands.
typedef struct commanded_memory {
    const double *volts;
} commanded_memory;

struct run_loop {
    scenario scenario; // a copy of one's own
    run_options options;
    given_law law;
    process_tape *tape; // NULL unless control.law is a process
    run_result result;
    recording recording;
    corrected_run run;
    double volts; // commanded [V]
    bool ended;
    status failed; // what stopped it
    fault fault;
    uint64_t fingerprint; // of what a saved state must agree with
};

// --- the controller of a commanded loop -------------------------------------------------------

static void put_out(void *memory, const controller_input *input, controller_output *output)
{
    const commanded_memory *m = memory;
    (void)input;
    output->command = *m->volts;
}

static const controller commanded_law = {.interface = CONTROLLER_INTERFACE,
                                         .name = "the program",
                                         .modes = (const char *const[]){"command", NULL},
                                         .memory_size = sizeof(commanded_memory),
                                         .sample = put_out};

// --- beginning and end ------------------------------------------------------------------------

// FNV-1a, a text after the other.
static uint64_t hash_text(uint64_t hash, const char *text)
{
    for (; *text != '\0'; text++) {
        hash = (hash ^ (unsigned char)*text) * 0x100000001b3u;
    }
    return (hash ^ 0xff) * 0x100000001b3u;
}

// What two loops must have in common to exchange states: the version, every parameter and the
// script; of a controller of somebody else's, the loop itself.
static uint64_t fingerprint_of(const run_loop *l)
{
    const scenario *s = &l->scenario;
    char text[PARAMETER_TEXT_SIZE];
    uint64_t hash = hash_text(0xcbf29ce484222325u, lab_version());
    for (int i = 0; i < parameter_count; i++) {
        parameter_format(&s->parameters, i, text, sizeof text);
        hash = hash_text(hash, text);
    }
    for (int i = 0; i < s->action_count; i++) {
        const action *a = &s->actions[i];
        snprintf(text, sizeof text, "%a %d %d %a", a->time, (int)a->kind, a->parameter, a->value);
        hash = hash_text(hash_text(hash, text), a->text);
    }

    const rig *r = l->recording.rig;
    const bool foreign = r != NULL && r->law != &commanded_law &&
                         (l->law.law != NULL || controller_of(s->parameters.control.law) == NULL);
    if (foreign) {
        snprintf(text, sizeof text, "%p", (const void *)l);
        hash = hash_text(hash, text);
    }
    return hash_text(hash, r == NULL ? "bare" : r->law->name);
}

status loop_create(run_loop **created, const scenario *s, const loop_options *options, fault *f)
{
    assert(created != NULL && s != NULL && options != NULL);
    *created = NULL;
    if (s->parameters.arm.model == ARM_PRINTED) {
        return fault_set_at(f, STATUS_BAD_ARGUMENT, "arm.model",
                            "the printed model does not stop between its steps, expected "
                            "arm.model = corrected");
    }
    run_loop *l = calloc(1, sizeof *l);
    if (l == NULL || scenario_copy(&l->scenario, s) != STATUS_OK) {
        free(l);
        return fault_no_memory(f);
    }

    // whose command the rig puts out
    l->volts = s->parameters.control.law == LAW_NONE ? s->parameters.motor.voltage : 0;
    l->law = options->commanded ? (given_law){&commanded_law, &l->volts} : options->law;
    const bool asks = l->law.law == NULL && s->parameters.control.law == LAW_PROCESS;
    l->tape = asks ? process_tape_create() : NULL;
    l->options = (run_options){.keep_trace = options->keep_trace,
                               .law = l->law.law != NULL ? &l->law : NULL,
                               .tape = l->tape};

    // the run at its start
    fault why;
    status code = recording_begin(&l->recording, &l->scenario, &l->options, &l->result, &why);
    if (code == STATUS_OK) {
        code = corrected_open(&l->run, &l->recording, &why);
    }
    if (code != STATUS_OK) {
        if (f != NULL) {
            *f = why;
        }
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
        if (l->run.motion != NULL) {
            corrected_close(&l->run, STATUS_STOPPED);
        }
        recording_end(&l->recording, STATUS_STOPPED, &l->fault, (time_used){0});
        process_tape_destroy(l->tape);
        run_finish(&l->result);
        scenario_finish(&l->scenario);
        free(l);
    }
}

// --- going on ---------------------------------------------------------------------------------

double loop_time(const run_loop *l)
{
    assert(l != NULL);
    return l->run.motion->state[SLOT_TIME];
}

bool loop_ended(const run_loop *l)
{
    assert(l != NULL);
    return l->ended;
}

// Keeps what stopped the run and says it.
static status stay_failed(run_loop *l, fault *f)
{
    if (l->failed != STATUS_OK && l->fault.code == STATUS_OK) {
        fault_set(&l->fault, l->failed, "at t = %.9g s: %s", loop_time(l), status_text(l->failed));
    }
    if (l->failed != STATUS_OK && f != NULL) {
        *f = l->fault;
    }
    return l->failed;
}

// Strides up to an instant that lies ahead, what is due now first.
static void stride_to(run_loop *l, double time)
{
    corrected_run *c = &l->run;
    while (l->failed == STATUS_OK && !l->ended && loop_time(l) < time) {
        l->failed = corrected_approach_stride(c, &l->ended, &l->fault);
        if (l->failed == STATUS_OK && !l->ended) {
            c->motion->cut = fmin(c->motion->cut, time);
            l->failed = corrected_stride(c, &l->fault);
        }
    }

    // the end is known as soon as it is reached
    if (l->failed == STATUS_OK && !l->ended &&
        !(loop_time(l) < l->scenario.parameters.run.duration)) {
        l->failed = corrected_approach_stride(c, &l->ended, &l->fault);
    }
}

status loop_until(run_loop *l, double time, fault *f)
{
    assert(l != NULL && isfinite(time));
    if (instant_after(time, loop_time(l))) {
        stride_to(l, time);
    }
    return stay_failed(l, f);
}

status loop_step(run_loop *l, fault *f)
{
    assert(l != NULL);
    const rig *on = l->recording.rig;
    const double interval = l->recording.now.method.step;

    // the next multiple of the step, or what the rig does now and then its next sample
    double next = (floor(loop_time(l) / interval + GRID_TOLERANCE) + 1) * interval;
    if (on != NULL && l->failed == STATUS_OK && !l->ended) {
        l->failed = corrected_approach_stride(&l->run, &l->ended, &l->fault);
        next = on->sample_time;
    }
    stride_to(l, next);
    return stay_failed(l, f);
}

// --- inputs -----------------------------------------------------------------------------------

void loop_command(run_loop *l, double volts)
{
    assert(l != NULL);
    l->volts = volts;
}

// Carries out an input; one that is refused changes nothing.
static status act(run_loop *l, const action *todo, fault *f)
{
    fault why = {.code = STATUS_OK, .text = "", .path = ""};
    if (l->failed != STATUS_OK) {
        return stay_failed(l, f);
    }
    if (todo->kind == ACTION_SET && !rig_can_change(&l->recording.now, todo->parameter)) {
        const char *path = parameter_table[todo->parameter].path;
        return fault_set_at(f, STATUS_BAD_ARGUMENT, path,
                            "%s holds from the start and cannot change during this run", path);
    }

    parameters tried = l->recording.now;
    status code =
        todo->kind == ACTION_SET ? parameter_may_change(&tried, todo->parameter, &why) : STATUS_OK;
    code = code == STATUS_OK ? action_apply(todo, &tried, &why) : code;
    if (code == STATUS_OK) {
        code = l->failed = corrected_act(&l->run, todo, -1, &l->fault);
        return stay_failed(l, f);
    }
    if (f != NULL) {
        *f = why;
    }
    return code;
}

status loop_set_number(run_loop *l, int parameter, double value, fault *f)
{
    assert(l != NULL && parameter >= 0 && parameter < parameter_count);
    const action todo = {
        .time = loop_time(l), .kind = ACTION_SET, .parameter = parameter, .value = value};
    return act(l, &todo, f);
}

status loop_set_text(run_loop *l, int parameter, const char *text, fault *f)
{
    assert(l != NULL && parameter >= 0 && parameter < parameter_count && text != NULL);

    // read into a copy, so that a bad text changes nothing
    parameters read = l->recording.now;
    status code = parameter_set_text(&read, parameter, text, f);
    if (code != STATUS_OK) {
        return code;
    }

    // then it is an action like any other
    action todo = {.time = loop_time(l),
                   .kind = ACTION_SET,
                   .parameter = parameter,
                   .value = parameter_get(&read, parameter)};
    if (parameter_is_text(&parameter_table[parameter])) {
        parameter_format(&read, parameter, todo.text, sizeof todo.text);
    }
    return act(l, &todo, f);
}

status loop_push(run_loop *l, double impulse, fault *f)
{
    assert(l != NULL && isfinite(impulse));
    const action todo = {.time = loop_time(l), .kind = ACTION_PUSH, .value = impulse};
    return act(l, &todo, f);
}

// --- what is known ----------------------------------------------------------------------------

bool loop_sense(run_loop *l, sensor_reading *reading)
{
    assert(l != NULL && reading != NULL);
    rig *on = l->recording.rig;
    if (on == NULL) {
        return false;
    }
    if (!l->ended) {
        const sensed_motion now = corrected_sensed_motion(&l->run, l->run.motion->state);
        rig_read(on, loop_time(l), &now);
    }
    *reading = on->reading;
    return true;
}

sample loop_row(run_loop *l)
{
    assert(l != NULL);
    return corrected_row(&l->run, l->run.motion->state, 0);
}

const double *loop_state(const run_loop *l, int *angle_count)
{
    assert(l != NULL && angle_count != NULL);
    *angle_count = l->run.motion->dof;
    return state_angles(l->run.motion, l->run.motion->state);
}

summary loop_summary(run_loop *l)
{
    assert(l != NULL);
    status code = l->failed;
    if (code == STATUS_OK && !l->ended) {
        code = STATUS_STOPPED;
    }

    // summed up as if it ended here, and gone on with as it was
    const summary kept = l->result.summary;
    const recording_state state = l->recording.state;
    const recorded_command command = l->recording.command;
    corrected_sum_up(&l->run, code);
    recording_tell_fault(&l->result.summary, code, &l->fault);
    const summary all = l->result.summary;
    l->result.summary = kept;
    l->recording.state = state;
    l->recording.command = command;
    return all;
}

const run_result *loop_result(const run_loop *l)
{
    assert(l != NULL);
    return &l->result;
}

const scenario *loop_scenario(const run_loop *l)
{
    assert(l != NULL);
    return &l->scenario;
}

// --- states as bytes --------------------------------------------------------------------------

// The head of a saved state; the motion's state, the rig's memory and its values follow.
typedef struct saved_head {
    uint64_t fingerprint;
    size_t size;
    bool ended;
    double volts;
    size_t rows, events, force_steps;
    recording_state recording;
    recorded_command command;
    summary summary;
    parameters now;
    double stop, last_event;
    int at_once;
    long steps;
    double start_energy, cut, pulse_peak, pulse_peak_time, largest_penetration;
    rig rig;
} saved_head;

static size_t memory_size(const rig *r)
{
    return r != NULL ? r->law->memory_size : 0;
}

static size_t values_size(const rig *r)
{
    return r != NULL ? (size_t)r->law->parameter_count * sizeof *r->values : 0;
}

size_t loop_saved_size(const run_loop *l)
{
    assert(l != NULL);
    const rig *r = l->recording.rig;
    return sizeof(saved_head) + (size_t)l->run.motion->size * sizeof(double) + memory_size(r) +
           values_size(r);
}

void loop_save(const run_loop *l, void *bytes)
{
    assert(l != NULL && bytes != NULL);
    const recording *r = &l->recording;
    const motion *m = l->run.motion;
    saved_head head;
    memset(&head, 0, sizeof head);
    head.fingerprint = l->fingerprint;
    head.size = loop_saved_size(l);
    head.ended = l->ended;
    head.volts = l->volts;

    // what was recorded
    head.rows = l->result.trace.row_count;
    head.events = l->result.trace.event_count;
    head.force_steps = l->result.history.forces.count;
    head.recording = r->state;
    head.command = r->command;
    head.summary = l->result.summary;
    head.now = r->now;

    // the motion
    head.stop = l->run.stop;
    head.last_event = l->run.last_event;
    head.at_once = l->run.at_once;
    head.steps = m->steps;
    head.start_energy = m->start_energy;
    head.cut = m->cut;
    head.pulse_peak = m->pulse_peak;
    head.pulse_peak_time = m->pulse_peak_time;
    head.largest_penetration = m->largest_penetration;

    // and the rig, whose addresses are its loop's own
    char *at = bytes;
    if (r->rig != NULL) {
        head.rig = *r->rig;
    }
    memcpy(at, &head, sizeof head);
    at += sizeof head;
    memcpy(at, m->state, (size_t)m->size * sizeof(double));
    at += (size_t)m->size * sizeof(double);
    if (r->rig != NULL) {
        memcpy(at, r->rig->memory, memory_size(r->rig));
        memcpy(at + memory_size(r->rig), r->rig->values, values_size(r->rig));
    }
}

// Puts the rig back; where its law, memory and values lie stays. The memory of a law that a program
// gave begins with that program's address.
static void restore_rig(run_loop *l, const rig *saved, const char *at)
{
    rig *r = l->recording.rig;
    const rig own = *r;

    // all but where things lie
    *r = *saved;
    r->law = own.law;
    r->plugin = own.plugin;
    r->process = own.process;
    r->memory = own.memory;
    r->values = own.values;

    // the contents, which were saved one after the other
    memcpy(r->memory, at, memory_size(r));
    memcpy(r->values, at + memory_size(r), values_size(r));

    // the program's address is the present one
    if (l->law.law != NULL) {
        memcpy(r->memory, &l->law.context, sizeof l->law.context);
    }
}

status loop_restore(run_loop *l, const void *bytes, size_t size, fault *f)
{
    assert(l != NULL && bytes != NULL);
    saved_head head;
    if (size != loop_saved_size(l)) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "a state of this loop has %zu bytes, but %zu were given",
                         loop_saved_size(l), size);
    }
    memcpy(&head, bytes, sizeof head);
    if (head.fingerprint != l->fingerprint || head.size != size) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "the state is of another scenario, another controller or another version");
    }

    // what was recorded, as far as this loop has it
    recording *r = &l->recording;
    run_result *result = &l->result;
    result->trace.row_count =
        head.rows < result->trace.row_count ? head.rows : result->trace.row_count;
    result->trace.event_count =
        head.events < result->trace.event_count ? head.events : result->trace.event_count;
    result->history.forces.count = head.force_steps < result->history.forces.count
                                       ? head.force_steps
                                       : result->history.forces.count;
    r->state = head.recording;
    r->command = head.command;
    result->summary = head.summary;
    result->summary.path = "";
    if (isnan(head.summary.first_contact_s)) {
        free(result->before_impact); // of a contact that is yet to come
        result->before_impact = NULL;
        result->before_impact_size = 0;
    }
    r->now = head.now;
    l->volts = head.volts;
    l->ended = head.ended;
    l->failed = STATUS_OK;
    l->fault = (fault){.text = "", .path = ""};

    // the rig, before the arm is bound to its voltage, and the motion
    motion *m = l->run.motion;
    const char *at = (const char *)bytes + sizeof head;
    if (r->rig != NULL) {
        restore_rig(l, &head.rig, at + (size_t)m->size * sizeof(double));
    }
    corrected_bind_arm(&l->run);
    memcpy(m->state, at, (size_t)m->size * sizeof(double));
    l->run.stop = head.stop;
    l->run.last_event = head.last_event;
    l->run.at_once = head.at_once;
    m->steps = head.steps;
    m->start_energy = head.start_energy;
    m->cut = head.cut;
    m->pulse_peak = head.pulse_peak;
    m->pulse_peak_time = head.pulse_peak_time;
    m->largest_penetration = head.largest_penetration;
    return STATUS_OK;
}
