#include "src/run/driver.h"

#include <string.h>

#include "src/base/instant.h"
#include "src/engines/motion_create.h"

status driver_open(run_driver *d, const scenario *s, const run_options *options,
                   run_result *result, fault *f)
{
    recording *r = &d->recording;
    const status code = recording_begin(r, s, options, result, f);
    d->is_printed = s->parameters.arm.model == ARM_PRINTED;
    d->duration = s->parameters.run.duration;
    d->opened = code == STATUS_OK;
    if (code != STATUS_OK) {
        return code;
    }
    if (d->is_printed) {
        return printed_open(&d->printed, r, f);
    }
    return corrected_open(&d->corrected, r, NULL, f);
}

void driver_close(run_driver *d, status failed, const fault *f)
{
    if (d->opened && !d->is_printed) {
        motion_destroy(corrected_finish(&d->corrected, failed));
    } else if (d->opened && d->printed.begun) {
        printed_sum_up(&d->printed, failed);
    }
    recording_end(&d->recording, failed, f);
}

summary driver_summary(run_driver *d, status failed, const fault *f)
{
    // summed up as if it ended here, and gone on with as it was
    recording *r = &d->recording;
    summary *now = &r->result->summary;
    const summary kept = *now;
    const recording_state state = r->state;
    const recorded_command command = r->command;
    if (d->is_printed) {
        printed_sum_up(&d->printed, failed);
    } else {
        corrected_sum_up(&d->corrected, failed);
    }
    recording_tell_fault(now, failed, f);
    const summary all = *now;
    *now = kept;
    r->state = state;
    r->command = command;
    return all;
}

// --- continuing ------------------------------------------------------------------------

// Whether an instant is still to be gone to; the end is, until it is known to be one.
static bool lies_ahead(const run_driver *d, double time)
{
    const bool at_end = d->is_printed ? printed_motion_ended(&d->printed.motion)
                                      : !(corrected_now(&d->corrected) < d->duration);
    return instant_after(time, driver_time(d)) || time >= d->duration || at_end;
}

status driver_approach(run_driver *d, bool *ended, fault *f)
{
    if (d->is_printed) {
        return printed_approach_step(&d->printed, ended, f);
    }
    return corrected_approach_step(&d->corrected, ended, f);
}

status driver_advance(run_driver *d, double until, bool *ended, fault *f)
{
    recording *r = &d->recording;
    while (!*ended && lies_ahead(d, until)) {
        if (r->options->stepped && stop_requested(&r->stop)) {
            return STATUS_STOPPED;
        }
        TRY(driver_approach(d, ended, f));
        if (!*ended) {
            if (d->is_printed) {
                TRY(printed_step(&d->printed, f));
            } else {
                TRY(corrected_step(&d->corrected, until, f));
            }
        }
    }
    return STATUS_OK;
}

status driver_act(run_driver *d, const action *todo, fault *f)
{
    if (d->is_printed) {
        return printed_act(&d->printed, todo, -1, f);
    }
    return corrected_act_now(&d->corrected, todo, f);
}

// --- at present ------------------------------------------------------------------------

double driver_time(const run_driver *d)
{
    if (d->is_printed) {
        return d->printed.motion.row.time;
    }
    return corrected_now(&d->corrected);
}

sensed_motion driver_sensed(run_driver *d)
{
    if (d->is_printed) {
        return d->printed.sensed;
    }
    return corrected_sensed_now(&d->corrected);
}

sample driver_row(const run_driver *d)
{
    const corrected_run *c = &d->corrected;
    if (d->is_printed) {
        return printed_sample(&d->printed);
    }
    return corrected_row(c, corrected_present(c));
}

const double *driver_state(const run_driver *d, int *angle_count)
{
    if (d->is_printed) {
        *angle_count = 3;
        return d->printed.motion.row.angle; // velocities stand behind them
    }
    const motion *m = d->corrected.motion;
    *angle_count = m->dof;
    return state_angles(m, corrected_present(&d->corrected));
}

// --- the state as bytes ----------------------------------------------------------------

// What has been recorded; the model, the rig's memory and its values follow.
typedef struct saved_run {
    size_t rows, events, force_steps;
    recording_state recording;
    recorded_command command;
    shown_sample shown;
    summary summary;
    parameters now;
    rig rig;
} saved_run;

static size_t model_size(const run_driver *d)
{
    if (d->is_printed) {
        return sizeof d->printed;
    }
    return corrected_saved_size(&d->corrected);
}

static size_t values_size(const rig *r)
{
    return (size_t)r->law->parameter_count * sizeof *r->values;
}

size_t driver_saved_size(const run_driver *d)
{
    const rig *r = d->recording.rig;
    return sizeof(saved_run) + model_size(d) +
           (r != NULL ? r->law->memory_size + values_size(r) : 0);
}

// Gives a rig the addresses of another.
static void keep_places(rig *r, const rig *own)
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

    // where things lie is their run's own, and no part of a state
    char *at = (char *)bytes + sizeof head;
    if (r->rig != NULL) {
        head.rig = *r->rig;
        keep_places(&head.rig, &(rig){.law = NULL});
    }
    memcpy(bytes, &head, sizeof head);
    if (d->is_printed) {
        printed_run saved = d->printed;
        saved.recording = NULL;
        memcpy(at, &saved, sizeof saved);
    } else {
        corrected_save(&d->corrected, at);
    }
    at += model_size(d);
    if (r->rig != NULL) {
        memcpy(at, r->rig->memory, r->rig->law->memory_size);
        if (r->rig->given.law != NULL) {
            memset(at, 0, sizeof r->rig->given.context);
        }
        memcpy(at + r->rig->law->memory_size, r->rig->values, values_size(r->rig));
    }
}

// Puts a rig back; where its law, memory, values and context lie stays.
static void restore_rig(rig *r, const rig *saved, const char *at)
{
    const rig own = *r;
    *r = *saved;
    keep_places(r, &own);
    memcpy(r->memory, at, r->law->memory_size);
    memcpy(r->values, at + r->law->memory_size, values_size(r));
    if (r->given.law != NULL) {
        memcpy(r->memory, &r->given.context, sizeof r->given.context);
    }
}

static void keep_at_most(size_t *count, size_t most)
{
    if (!(*count < most)) {
        *count = most;
    }
}

void driver_restore(run_driver *d, const void *bytes)
{
    // what was recorded, as far as this run has it
    recording *r = &d->recording;
    run_result *result = r->result;
    saved_run head;
    memcpy(&head, bytes, sizeof head);
    keep_at_most(&result->trace.row_count, head.rows);
    keep_at_most(&result->trace.event_count, head.events);
    keep_at_most(&result->history.forces.count, head.force_steps);
    r->state = head.recording;
    r->command = head.command;
    r->shown = head.shown;
    result->summary = head.summary;
    result->summary.path = "";
    r->now = head.now;

    // the rig first: the run's arm has its voltage
    const char *at = (const char *)bytes + sizeof head;
    if (r->rig != NULL) {
        restore_rig(r->rig, &head.rig, at + model_size(d));
    }
    if (d->is_printed) {
        memcpy(&d->printed, at, sizeof d->printed);
        d->printed.recording = r;
    } else {
        corrected_restore(&d->corrected, at);
    }
}
