#include "src/run/recording_frame.h"

#include <assert.h>
#include <string.h>

#include "src/base/clock.h"
#include "src/run/rig_recording.h"

// What a run counts and adds up begins with nothing.
static void summary_start(summary *s)
{
    summary_init(s);
    s->impacts = s->separations = s->steps = s->max_penetration_m = 0;
    s->motor_work_J = s->energy_residual_J = 0;
}

time_used time_now(void)
{
    return (time_used){clock_seconds(CLOCK_THREAD_CPUTIME_ID), clock_seconds(CLOCK_MONOTONIC)};
}

time_used time_since(time_used start)
{
    time_used now = time_now();
    return (time_used){now.cpu - start.cpu, now.wall - start.wall};
}

status recording_begin(recording *r, const scenario *s, const run_options *options,
                       run_result *result, fault *f)
{
    assert(r != NULL && s != NULL && options != NULL && result != NULL && f != NULL);
    *r = (recording){.scenario = s, .result = result, .options = options, .now = s->parameters};
    *f = (fault){.text = "", .path = ""};
    if (!options->resume) {
        memset(result, 0, sizeof *result);
        summary_start(&result->summary);
    }

    // not even set up: an arm of a thousand links takes seconds for that
    return recording_is_abandoned(r) ? STATUS_STOPPED : recording_start_rig(r, f);
}

void recording_tell_fault(summary *s, status code, const fault *f)
{
    s->status = code;
    if (code != STATUS_OK) {
        const char *why = f->code != STATUS_OK ? f->text : status_text(code);
        snprintf(s->message, sizeof s->message, "%s", why);
        s->path = f->path;
    }
}

void recording_end(recording *r, status code, const fault *f, time_used used)
{
    assert(r != NULL && f != NULL);
    run_result *result = r->result;
    rig_destroy(r->rig);
    recording_tell_fault(&result->summary, code, f);
    result->summary.cpu_time_s = used.cpu;
    result->summary.wall_time_s = used.wall;
    if (result->history.forces.array.reserved == 0) {
        force_history_finish(&result->history.forces); // needed until here only
    }
}
