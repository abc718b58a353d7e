#include "src/run/rig_recording.h"

#include <assert.h>
#include <math.h>

#include "src/arm/motor.h"
#include "src/base/extremes.h"
#include "src/run/largest_mean.h"

// The smoothed force: means over SMOOTHING_WINDOW [s], from SMOOTHED_AFTER first contact on [s].
#define SMOOTHING_WINDOW 5e-3
#define SMOOTHED_AFTER   0.02

status recording_start_rig(recording *r, fault *f)
{
    assert(r != NULL && r->rig == NULL);
    const parameters *p = &r->scenario->parameters;
    if (p->control.law == LAW_NONE && r->options->law == NULL) {
        return STATUS_OK;
    }

    r->command = (recorded_command){.hub_angle = p->initial.angle};
    r->result->summary.electrical_energy_J = 0;
    if (p->arm.model != ARM_PRINTED) { // whose listing has no rate of the gap
        r->result->summary.approach_speed_m_s = r->result->summary.return_speed_m_s = 0;
    }
    const run_options *o = r->options;
    const rig_options given = {
        .law = o->law,
        .transcript = o->transcript,
        .ends = {o->monitor != NULL ? &o->monitor->stop : NULL, o->abandon},
    };
    status s = rig_create(&r->rig, p, &given, f);
    return s == STATUS_OK && !r->rig->withheld ? scenario_check_locks(r->scenario, r->rig->law, f)
                                               : s;
}

void recording_add_rig_signals(const recording *r, sample *row)
{
    const rig *on = r->rig;
    bool sampled = on != NULL && on->samples > 0;

    // what the sensors read; before their first sample nothing
    row->encoder = sampled ? on->reading.encoder : (double)NAN;
    row->tachometer = sampled ? on->reading.tachometer : (double)NAN;
    row->force_reading = sampled ? on->reading.force_reading : (double)NAN;
    row->piezo_force = sampled ? on->reading.piezo_force : (double)NAN;
    row->film = sampled ? on->reading.film : (double)NAN;
    row->accelerometer = sampled ? on->reading.accelerometer : (double)NAN;

    // what the controller made of it
    row->command = sampled ? on->output.command : (double)NAN;
    row->controller_mode = sampled ? on->output.mode : (double)NAN;
    row->desired_angle = sampled ? on->output.desired_angle : (double)NAN;
    row->desired_velocity = sampled ? on->output.desired_velocity : (double)NAN;
    row->calculated_force = sampled ? on->output.calculated_force : (double)NAN;
    row->predicted_force = sampled ? on->predicted_force : (double)NAN;
}

void recording_change_command(recording *r, double time, double hub_angle)
{
    assert(r != NULL && r->rig != NULL);
    const recorded_command *c = &r->command;
    r->result->summary.electrical_energy_J +=
        motor_electrical_energy(&r->now.motor, c->volts, time - c->time, hub_angle - c->hub_angle);
    r->command = (recorded_command){r->rig->voltage, time, hub_angle};
}

void recording_before_change(recording *r, const action *todo, double time, double hub_angle)
{
    assert(r != NULL && todo != NULL);
    if (r->rig != NULL && todo->parameter == PARAMETER_INDEX(motor.voltage_limit)) {
        recording_change_command(r, time, hub_angle);
    }
}

void recording_follow_flight(recording *r, double closing_speed)
{
    assert(r != NULL && r->rig != NULL);
    summary *s = &r->result->summary;
    double *largest = isnan(s->first_contact_s) ? &s->approach_speed_m_s : &s->return_speed_m_s;
    *largest = larger(closing_speed, *largest);
}

void recording_finish_rig_summary(recording *r, double hub_angle)
{
    assert(r != NULL);
    summary *s = &r->result->summary;
    const parameters *p = &r->scenario->parameters;
    const double command = r->now.control.force; // the script may have changed it
    if (r->rig == NULL) {
        return;
    }

    // energy up to the end, and what the controller made of its task
    recording_change_command(r, p->run.duration, hub_angle);
    s->largest_command_V = r->rig->largest_command;
    s->force_command_N = command;
    s->force_over_command_N = s->peak_force_N - command;
    if (!isnan(s->first_contact_s)) {
        s->smoothed_over_command_N =
            force_largest_mean(r->result, s->first_contact_s + SMOOTHED_AFTER, SMOOTHING_WINDOW) -
            command;
    }
    s->steady_error_N = s->steady_force_N - command;
}
