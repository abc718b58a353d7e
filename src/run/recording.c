#include "src/run/recording.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/arm/motor.h"
#include "src/base/chunks.h"
#include "src/base/clock.h"
#include "src/base/instant.h"

// Sets up the rig if the scenario has a control law, and checks that the script suits
// that law. Until the first command the rig puts out no voltage.
static status start_rig(recording *r, fault *f)
{
    assert(r->rig == NULL);
    const parameters *p = &r->scenario->parameters;
    if (p->control.law == LAW_NONE && r->options->law == NULL) {
        return STATUS_OK;
    }

    // what the summary of a rig adds up starts at zero; the printed model has no rate of
    // the gap, and so no speeds
    r->command = (recorded_command){.hub_angle = p->initial.angle};
    r->result->summary.electrical_energy_J = 0;
    if (p->arm.model != ARM_PRINTED) {
        r->result->summary.approach_speed_m_s = r->result->summary.return_speed_m_s = 0;
    }

    // the rig, with a law that a program gives or that of the scenario
    const rig_options given = {.law = r->options->law, .stop = &r->stop};
    TRY(rig_create(&r->rig, p, &given, f));

    // the script
    TRY(scenario_check_timing(r->scenario, f));
    if (r->rig->withheld) {
        return STATUS_OK;
    }
    return scenario_check_locks(r->scenario, r->rig->law, f);
}

status recording_begin(recording *r, const scenario *s, const run_options *options,
                       run_result *result, fault *f)
{
    assert(options->monitor == NULL || options->abandon == NULL);
    memset(r, 0, offsetof(recording, now)); // the parameters behind it are copied
    r->scenario = s;
    r->result = result;
    r->options = options;
    r->now = s->parameters;
    if (!options->untimed) {
        r->begun_cpu = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
        r->begun_at = clock_seconds(CLOCK_MONOTONIC);
    }

    // who may stop it: the whole program, its monitor, or a flag of the caller
    r->stop = (stop_request){.flag = &stop_everything,
                             .ask = options->ask,
                             .context = options->ask_context};
    if (options->monitor != NULL) {
        r->stop.flag = &options->monitor->stop;
    } else if (options->abandon != NULL) {
        r->stop.flag = options->abandon;
    }

    // an empty result, unless an earlier run is continued
    *f = (fault){.text = "", .path = ""};
    if (!options->resume) {
        memset(result, 0, sizeof *result);
        summary *all = &result->summary;
        summary_init(all);
        all->impacts = all->separations = all->steps = all->max_penetration_m = 0;
        all->motor_work_J = all->energy_residual_J = 0;
    }

    // a run that is to stop is not even set up, which takes seconds for a thousand links
    const bool abandoned = options->monitor == NULL && stop_is_set(&r->stop);
    if (abandoned) {
        return STATUS_STOPPED;
    }
    return start_rig(r, f);
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

void recording_end(recording *r, status code, const fault *f)
{
    run_result *result = r->result;
    rig_destroy(r->rig);
    if (!r->options->keep_trace) {
        result->trace.row_count = 0;
    }
    recording_tell_fault(&result->summary, code, f);
    if (!r->options->untimed) {
        summary *s = &result->summary;
        s->cpu_time_s = clock_seconds(CLOCK_THREAD_CPUTIME_ID) - r->begun_cpu;
        s->wall_time_s = clock_seconds(CLOCK_MONOTONIC) - r->begun_at;
    }
    if (result->history.forces.reserved == 0 && !r->options->keep_forces) {
        shared_array_finish(&result->history.forces); // needed until here only
    }
}

// --- rows and events -------------------------------------------------------------------

// Room for rows is made in advance if they are fewer than MOST_ROWS_AHEAD. Of that room
// ROWS_OF_EVENTS are for rows at events.
enum { MOST_ROWS_AHEAD = 100000, ROWS_OF_EVENTS = 64 };

size_t recording_most_rows(size_t expected)
{
    return 16 * expected + 1000000;
}

// Refuses rows that take more than the machine's memory.
static status check_room(const recording *r, double rows, int angle_count, fault *f)
{
    const parameters *p = &r->scenario->parameters;
    const double bytes = rows * (double)trace_row_bytes(angle_count), gigabyte = 1e9;
    const double memory = machine_memory();
    if (bytes <= memory) {
        return STATUS_OK;
    }

    const char *two = "";
    if (r->rig != NULL) {
        two = " and two at every sample of control.rate";
    }
    return fault_set_at(f, STATUS_BAD_SCENARIO, "method.step",
                        "rows every method.step = %g s%s over run.duration = %g s take "
                        "%.3g GB of memory, and this machine has %.3g GB",
                        p->method.step, two, p->run.duration, bytes / gigabyte,
                        memory / gigabyte);
}

status recording_open_trace(recording *r, int angle_count, fault *f)
{
    assert(angle_count > 0);
    size_t expected = r->options->rows_expected;
    const parameters *p = &r->scenario->parameters;

    // a row for each step, and two for an event or a sample
    const double samples = r->rig != NULL ? p->run.duration * p->control.rate : 0;
    const double rows = ROWS_OF_EVENTS + p->run.duration / p->method.step + 2 * samples;
    if (expected > 0 || r->options->keep_trace) {
        TRY(check_room(r, rows, angle_count, f));
    }

    // a trace that may move as it grows; if there is no memory, adding rows will say so
    if (expected == 0) {
        trace_init(&r->result->trace, angle_count);
        if (r->options->keep_trace && rows < MOST_ROWS_AHEAD) {
            trace_expect(&r->result->trace, (size_t)rows);
        }
        return STATUS_OK;
    }

    // a trace that never moves
    size_t most = recording_most_rows(expected);
    status s = trace_reserve(&r->result->trace, angle_count, expected, most);
    if (s == STATUS_OK) {
        return s;
    }
    return fault_set(f, s, "no address space for %zu rows", expected);
}

void recording_publish(const recording *r, double time)
{
    run_monitor *m = r->options->monitor;
    if (m != NULL) {
        // rows last: whoever sees them sees the events before them
        const trace *t = &r->result->trace;
        atomic_store_explicit(&m->time, time, memory_order_relaxed);
        atomic_store_explicit(&m->events, t->event_count, memory_order_release);
        atomic_store_explicit(&m->rows, t->row_count, memory_order_release);
    }
}

status recording_set(recording *r, const action *todo, double time, fault *f)
{
    assert(todo->kind == ACTION_SET);
    TRY(action_apply(todo, &r->now, f));
    if (r->rig == NULL) {
        return STATUS_OK;
    }

    // the rig has its own view of the parameters
    TRY(rig_lock(r->rig, r->now.control.lock, f));
    return rig_retune(r->rig, &r->now, time, f);
}

bool recording_has_row_at(const recording *r, double time)
{
    const trace *t = &r->result->trace;
    return t->row_count > 0 && same_instant(t->rows[t->row_count - 1].time, time);
}

status recording_add_row(recording *r, const sample *row, const double *angles,
                         const double *velocities)
{
    trace *t = &r->result->trace;
    const bool same_time = r->rig != NULL && recording_has_row_at(r, row->time);
    status s = trace_add_row(t, row, angles, velocities);
    if (s == STATUS_OK && same_time) {
        t->rows[t->row_count - 1].time = t->rows[t->row_count - 2].time;
    }
    recording_publish(r, row->time);

    // of rows that nobody keeps the last one stays, which the next is compared with
    if (s == STATUS_OK && r->options->take_row != NULL) {
        const size_t last = t->row_count - 1;
        s = r->options->take_row(r->options->row_context, &t->rows[last],
                                 t->angles + last * (size_t)t->angle_count);
    }
    if (!r->options->keep_trace) {
        trace_keep_last_row(t);
    }
    return s;
}

void recording_finish_summary(recording *r, double force_integral)
{
    summary *s = &r->result->summary;
    double duration = r->scenario->parameters.run.duration;
    if (isnan(s->first_contact_s)) {
        s->steady_force_N = (double)NAN;
        return;
    }

    // the mean over the window; overshoot and settling time are relative to it
    s->steady_force_N = force_integral / fmin(STEADY_WINDOW, duration);
    if (s->steady_force_N > 0) {
        s->force_overshoot_percent = 100 * (s->peak_force_N / s->steady_force_N - 1);
        double settled =
            force_settled_since(&r->result->history.forces, s->steady_force_N);
        if (isnan(settled)) {
            s->settling_time_s = (double)NAN;
        } else {
            s->settling_time_s = fmax(0, settled - s->first_contact_s);
        }
    }
}

// --- the rig ---------------------------------------------------------------------------

// The smoothed force is the mean over a window of SMOOTHING_WINDOW [s]; its maximum
// counts from SMOOTHED_AFTER [s] after the first contact on.
#define SMOOTHING_WINDOW 5e-3
#define SMOOTHED_AFTER   0.02

void recording_add_rig_signals(const recording *r, sample *row)
{
    // before the first sample there are no values
    const double none = (double)NAN;
    sensor_reading reading = {.encoder = none,
                              .tachometer = none,
                              .force_reading = none,
                              .piezo_force = none,
                              .film = none,
                              .accelerometer = none,
                              .tip_deflection = none,
                              .root_strain = none};
    row->command = row->controller_mode = none;
    row->desired_angle = row->desired_velocity = none;
    row->calculated_force = row->predicted_force = none;

    // the last sample that is shown, and the controller's output for it
    const shown_sample *s = &r->shown;
    if (s->sampled) {
        reading = s->reading;
        row->command = s->output.command;
        row->controller_mode = s->output.mode;
        row->desired_angle = s->output.desired_angle;
        row->desired_velocity = s->output.desired_velocity;
        row->calculated_force = s->output.calculated_force;
        row->predicted_force = s->predicted_force;
    }

    // the sensors' readings
    row->encoder = reading.encoder;
    row->tachometer = reading.tachometer;
    row->force_reading = reading.force_reading;
    row->piezo_force = reading.piezo_force;
    row->film = reading.film;
    row->accelerometer = reading.accelerometer;
    row->tip_deflection = reading.tip_deflection;
    row->root_strain = reading.root_strain;
}

bool recording_has_new_sample(const recording *r)
{
    return r->rig != NULL && r->rig->samples != r->shown.samples;
}

void recording_show_sample(recording *r)
{
    const rig *on = r->rig;
    r->shown = (shown_sample){.sampled = true,
                              .samples = on->samples,
                              .reading = on->reading,
                              .output = on->output,
                              .predicted_force = on->predicted_force};
}

void recording_change_command(recording *r, double time, double hub_angle)
{
    const recorded_command *c = &r->command;
    r->result->summary.electrical_energy_J +=
        motor_electrical_energy(&r->now.motor, c->volts, time - c->time,
                                hub_angle - c->hub_angle);
    r->command = (recorded_command){r->rig->voltage, time, hub_angle};
}

void recording_before_change(recording *r, const action *todo, double time,
                             double hub_angle)
{
    if (r->rig != NULL && todo->parameter == PARAMETER_INDEX(motor.voltage_limit)) {
        recording_change_command(r, time, hub_angle);
    }
}

void recording_finish_rig_summary(recording *r, double hub_angle)
{
    summary *s = &r->result->summary;
    const parameters *p = &r->scenario->parameters;
    const double command = r->now.control.force; // the script may have changed it
    if (r->rig == NULL) {
        return;
    }

    // electrical energy up to the end, and force and command against the commanded force
    recording_change_command(r, p->run.duration, hub_angle);
    s->largest_command_V = r->rig->largest_command;
    s->force_command_N = command;
    s->force_over_command_N = s->peak_force_N - command;
    if (!isnan(s->first_contact_s)) {
        s->smoothed_over_command_N =
            force_largest_mean(r->result, s->first_contact_s + SMOOTHED_AFTER,
                               SMOOTHING_WINDOW) -
            command;
    }
    s->steady_error_N = s->steady_force_N - command;
}
