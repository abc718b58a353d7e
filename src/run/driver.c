#include "src/run/driver.h"

#include <string.h>

#include "src/base/instant.h"
#include "src/engines/motion_create.h"

status driver_open(run_driver *d, recording *r, fault *f)
{
    d->is_printed = r->scenario->parameters.arm.model == ARM_PRINTED;
    d->duration = r->scenario->parameters.run.duration;
    return d->is_printed ? printed_open(&d->printed, r, f)
                         : corrected_open(&d->corrected, r, NULL, f);
}

void driver_close(run_driver *d, status failed)
{
    if (!d->is_printed) {
        motion_destroy(corrected_finish(&d->corrected, failed));
    } else if (d->printed.begun) {
        printed_sum_up(&d->printed, failed);
    }
}

void driver_sum_up(run_driver *d, status failed)
{
    if (d->is_printed) {
        printed_sum_up(&d->printed, failed);
    } else {
        corrected_sum_up(&d->corrected, failed);
    }
}

// --- continuing ---------------------------------------------------------------------------------

// Whether an instant is still to be gone to; the end is, until it is known to be one.
static bool lies_ahead(const run_driver *d, double time)
{
    const bool at_end = d->is_printed ? printed_motion_ended(&d->printed.motion)
                                      : !(corrected_now(&d->corrected) < d->duration);
    return instant_after(time, driver_time(d)) || time >= d->duration || at_end;
}

status driver_approach(run_driver *d, bool *ended, fault *f)
{
    return d->is_printed ? printed_approach_step(&d->printed, ended, f)
                         : corrected_approach_step(&d->corrected, ended, f);
}

status driver_advance(run_driver *d, double until, bool *ended, fault *f)
{
    while (!*ended && lies_ahead(d, until)) {
        TRY(driver_approach(d, ended, f));
        if (!*ended) {
            TRY(d->is_printed ? printed_step(&d->printed, f)
                              : corrected_step(&d->corrected, until, f));
        }
    }
    return STATUS_OK;
}

status driver_act(run_driver *d, const action *todo, fault *f)
{
    return d->is_printed ? printed_act(&d->printed, todo, -1, f)
                         : corrected_act_now(&d->corrected, todo, f);
}

// --- at present -------------------------------------------------------------------------------

double driver_time(const run_driver *d)
{
    return d->is_printed ? d->printed.motion.row.time : corrected_now(&d->corrected);
}

sensed_motion driver_sensed(run_driver *d)
{
    return d->is_printed ? d->printed.sensed : corrected_sensed_now(&d->corrected);
}

sample driver_row(const run_driver *d)
{
    const corrected_run *c = &d->corrected;
    return d->is_printed ? printed_sample(&d->printed) : corrected_row(c, corrected_present(c));
}

const double *driver_state(const run_driver *d, int *angle_count)
{
    if (d->is_printed) {
        *angle_count = 3;
        return d->printed.state;
    }
    const motion *m = d->corrected.motion;
    *angle_count = m->dof;
    return state_angles(m, corrected_present(&d->corrected));
}

size_t driver_saved_size(const run_driver *d)
{
    return d->is_printed ? sizeof d->printed : corrected_saved_size(&d->corrected);
}

void driver_save(const run_driver *d, void *bytes)
{
    if (!d->is_printed) {
        corrected_save(&d->corrected, bytes);
        return;
    }
    printed_run saved = d->printed;
    saved.recording = NULL;
    memcpy(bytes, &saved, sizeof saved);
}

void driver_restore(run_driver *d, const void *bytes)
{
    if (!d->is_printed) {
        corrected_restore(&d->corrected, bytes);
        return;
    }
    recording *own = d->printed.recording;
    memcpy(&d->printed, bytes, sizeof d->printed);
    d->printed.recording = own;
}
