#include "src/run/run_driver.h"

#include <assert.h>
#include <string.h>

#include "src/base/instant.h"

status driver_open(run_driver *d, const scenario *s, const run_options *options,
                   run_result *result, fault *f)
{
    d->model = NULL;
    TRY(recording_begin(&d->recording, s, options, result, f));
    if (s->parameters.arm.model == ARM_PRINTED) {
        d->model = &printed_model;
    } else {
        d->model = &corrected_model;
    }
    return d->model->open(&d->run, &d->recording, f);
}

void driver_close(run_driver *d, status failed, const fault *f)
{
    if (d->model != NULL) {
        d->model->finish(&d->run, failed);
    }
    recording_end(&d->recording, failed, f);
}

summary driver_summary(run_driver *d, status failed, const fault *f)
{
    recording *r = &d->recording;
    summary *now = &r->result->summary;

    // the run is summed up as if it ended here
    const summary summary_before = *now;
    const recording_state state_before = r->state;
    const recorded_command command_before = r->command;
    d->model->sum_up(&d->run, failed);
    recording_tell_fault(now, failed, f);
    const summary all = *now;

    // and continues as if it had not been
    *now = summary_before;
    r->state = state_before;
    r->command = command_before;
    return all;
}

// --- continuing ------------------------------------------------------------------------

// Whether the run still has to be advanced to reach an instant [s]. For the end of the
// run that is so until the model has found that it ended, in which it records the last
// row.
static bool lies_ahead(const run_driver *d, double time)
{
    const double duration = d->recording.scenario->parameters.run.duration;
    return instant_after(time, driver_time(d)) || time >= duration ||
           d->model->has_ended(&d->run);
}

status driver_prepare_step(run_driver *d, bool *ended, fault *f)
{
    return d->model->prepare_step(&d->run, ended, f);
}

status driver_advance(run_driver *d, double until, bool *ended, fault *f)
{
    recording *r = &d->recording;
    while (!*ended && lies_ahead(d, until)) {
        if (r->options->stepped && stop_requested(&r->stop)) {
            return STATUS_STOPPED;
        }
        TRY(driver_prepare_step(d, ended, f));
        if (!*ended) {
            TRY(d->model->step(&d->run, until, f));
        }
    }
    return STATUS_OK;
}

status driver_act(run_driver *d, const action *todo, fault *f)
{
    assert(todo->kind == ACTION_SET || d->model->takes_pushes);
    return d->model->act(&d->run, todo, f);
}

// --- at present ------------------------------------------------------------------------

double driver_time(const run_driver *d)
{
    return d->model->time(&d->run);
}

sensed_motion driver_sensed(run_driver *d)
{
    return d->model->sensed(&d->run);
}

sample driver_row(const run_driver *d)
{
    return d->model->row(&d->run);
}

const double *driver_state(const run_driver *d, int *angle_count)
{
    return d->model->state(&d->run, angle_count);
}

// --- the state as bytes ----------------------------------------------------------------

// The first part of a saved state: what has been recorded, and the rig. The bytes of the
// model, of the controller's memory and of its parameter values follow.
typedef struct saved_run {
    size_t rows, events, force_steps;
    recording_state recording;
    recorded_command command;
    shown_sample shown;
    summary summary;
    parameters now;
    rig rig;
} saved_run;

// The bytes of the values of the controller's parameters.
static size_t values_size(const rig *r)
{
    return (size_t)r->law->parameter_count * sizeof *r->values;
}

size_t driver_saved_size(const run_driver *d)
{
    const rig *r = d->recording.rig;
    const size_t size = sizeof(saved_run) + d->model->saved_size(&d->run);
    if (r == NULL) {
        return size;
    }
    return size + r->law->memory_size + values_size(r);
}

// Gives a rig the addresses that another one has; all else stays.
static void copy_addresses(rig *r, const rig *own)
{
    r->law = own->law;
    r->given = own->given;
    r->plugin = own->plugin;
    r->process = own->process;
    r->played = own->played;
    r->memory = own->memory;
    r->values = own->values;
}

void driver_save(const run_driver *d, void *bytes)
{
    // what has been recorded
    const recording *r = &d->recording;
    saved_run head;
    memset(&head, 0, sizeof head);
    head.rows = r->result->trace.row_count;
    head.events = r->result->trace.event_count;
    head.force_steps = r->result->history.forces.count;
    head.recording = r->state;
    head.command = r->command;
    head.shown = r->shown;
    head.summary = r->result->summary;
    head.summary.path = NULL;
    head.now = r->now;

    // the rig without its addresses, which are no part of a state
    if (r->rig != NULL) {
        head.rig = *r->rig;
        copy_addresses(&head.rig, &(rig){.law = NULL});
    }
    memcpy(bytes, &head, sizeof head);

    // the model, then the law's memory and values
    char *at = (char *)bytes + sizeof head;
    d->model->save(&d->run, at);
    at += d->model->saved_size(&d->run);
    if (r->rig != NULL) {
        memcpy(at, r->rig->memory, r->rig->law->memory_size);
        if (r->rig->given.law != NULL) {
            memset(at, 0, sizeof r->rig->given.context);
        }
        memcpy(at + r->rig->law->memory_size, r->rig->values, values_size(r->rig));
    }
}

// Gives a rig its saved state, of which the bytes of memory and parameter values begin at
// `at`. Its addresses stay; the memory of a law that a program gives begins with its
// context, which stays as well.
static void restore_rig(rig *r, const rig *saved, const char *at)
{
    const rig own = *r;
    *r = *saved;
    copy_addresses(r, &own);
    memcpy(r->memory, at, r->law->memory_size);
    memcpy(r->values, at + r->law->memory_size, values_size(r));
    if (r->given.law != NULL) {
        memcpy(r->memory, &r->given.context, sizeof r->given.context);
    }
}

static void limit_count(size_t *count, size_t most)
{
    if (*count > most) {
        *count = most;
    }
}

void driver_restore(run_driver *d, const void *bytes)
{
    // what was recorded; rows, events and forces that came later are dropped
    recording *r = &d->recording;
    run_result *result = r->result;
    saved_run head;
    memcpy(&head, bytes, sizeof head);
    limit_count(&result->trace.row_count, head.rows);
    limit_count(&result->trace.event_count, head.events);
    limit_count(&result->history.forces.count, head.force_steps);
    r->state = head.recording;
    r->command = head.command;
    r->shown = head.shown;
    result->summary = head.summary;
    result->summary.path = "";
    r->now = head.now;

    // the rig first, as the arm of the model takes its voltage from there
    const char *at = (const char *)bytes + sizeof head;
    if (r->rig != NULL) {
        restore_rig(r->rig, &head.rig, at + d->model->saved_size(&d->run));
    }
    d->model->restore(&d->run, at);
}
