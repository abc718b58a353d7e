#include "src/rig/rig.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/arm/motor.h"
#include "src/rig/controller_values.h"
#include "src/rig/laws/laws.h"
#include "src/rig/estimation/reduced_arm.h"
#include "src/base/extremes.h"
#include "src/base/instant.h"

// --- starting --------------------------------------------------------------------------

// Allocates a controller's memory and the values of its parameters, and starts it. The
// rig knows already which controller it is.
static status start_controller(rig *r, const parameters *p, fault *f)
{
    // at least one byte and one value each, as calloc of none may return NULL
    size_t count = (size_t)(r->law->parameter_count > 0 ? r->law->parameter_count : 1);
    r->memory = calloc(r->law->memory_size > 0 ? r->law->memory_size : 1, 1);
    r->values = calloc(count, sizeof *r->values);
    FAULT_IF(r->memory == NULL || r->values == NULL, f, STATUS_NO_MEMORY,
             "no memory for the controller '%s'", r->law->name);

    // a withheld controller is not asked, so its settings are not read
    if (!r->withheld) {
        TRY(controller_values(r->law, p, r->values, f));
    }
    if (r->given.law != NULL) {
        assert(r->law->memory_size >= sizeof r->given.context);
        memcpy(r->memory, &r->given.context, sizeof r->given.context);
    }

    controller_setup setup = rig_nominal_setup(r, p);
    if (p->control.force_limit > 0) {
        touch_forecast_tell(&r->forecast, p, &setup);
    }
    const char *refusal = r->law->start != NULL ? r->law->start(r->memory, &setup) : NULL;
    if (refusal != NULL) {
        // for lack of memory the run may succeed another time; otherwise the scenario is
        // bad
        status code = STATUS_NO_MEMORY;
        if (refusal != reduced_arm_no_memory) {
            code = STATUS_BAD_SCENARIO;
        }
        return fault_set(f, code, "the controller '%s' cannot run: %.600s", r->law->name,
                         refusal);
    }
    return STATUS_OK;
}

// The output of a controller that fills in nothing.
static controller_output no_answer(void)
{
    return (controller_output){.command = (double)NAN,
                               .desired_angle = (double)NAN,
                               .desired_velocity = (double)NAN,
                               .calculated_force = (double)NAN};
}

// --- what the user has not allowed -----------------------------------------------------

// Takes the place of a controller from outside that the user has not allowed; it is never
// asked for a command.
static const controller withheld_law =
    ONE_MODE_CONTROLLER("withheld", "withheld", 0, NULL,
                        .tune = controller_takes_anything);

// The fault of a withheld controller: what the scenario wants to run, and how to allow
// it.
static status explain_withheld(const rig *r, fault *f)
{
    const control_parameters *c = &r->known.control;
    const char *path = "control.plugin", *what = "load the plug-in", *code = c->plugin;
    if (c->law == LAW_PROCESS) {
        path = "control.command";
        what = "start the program";
        code = c->command;
    }
    return fault_set_at(
        f, STATUS_NOT_ALLOWED, path,
        "the scenario wants to %s '%.200s', which can do whatever you can, with any "
        "file: if you trust it and all that it loads, allow that with --allow-code",
        what, code);
}

// --- beginning and end -----------------------------------------------------------------

// Finds the controller that control.law names: a built-in law, playback, a plug-in or a
// process. Code from outside is withheld unless the user allows it.
static status open_named_law(rig *r, const parameters *p, const rig_options *o, fault *f)
{
    const control_parameters *c = &p->control;
    r->law = controller_of(c->law);
    if (c->law == LAW_PLAYBACK) {
        r->given = (given_law){r->law, &r->played};
        return played_command_open(&r->played, p, f);
    }
    if (r->law != NULL) {
        return STATUS_OK;
    }
    if (!p->code_allowed) {
        r->withheld = true;
        r->law = &withheld_law;
        return STATUS_OK;
    }

    if (c->law == LAW_PLUGIN) {
        status s = plugin_open(&r->plugin, c->plugin, f);
        r->law = r->plugin.law;
        return s;
    }
    r->process = process_create(c, o->stop);
    r->law = &process_law;
    r->given = (given_law){r->law, r->process};
    if (r->process == NULL) {
        return fault_no_memory(f);
    }
    return STATUS_OK;
}

// Puts the sampled loop to its state before the first sample, at t = 0.
static void prepare_loop(rig *r, const parameters *p)
{
    r->known = *p;
    r->ramp = r->wanted_force = p->control.force;
    r->period = 1 / p->control.rate;
    rig_take_delay(r, p);
    r->jitter = p->control.jitter;
    random_seed(&r->clock, ~(uint64_t)p->control.seed);

    // nothing has been read or answered
    r->lock = -1;
    r->read_time = -1;
    r->predicted_force = (double)NAN;
    r->output = no_answer();

    // sensors and converter
    sensors_init(&r->sensors, &p->sensor, p->control.seed);
    r->voltage_limit = motor_command_limit(&p->motor);
    r->dac = converter_of(r->sensors.p.dac_bits, r->voltage_limit);
}

// Finds the controller, locks its mode and starts it. Fails if the controller refuses its
// lock, its settings or the arm.
static status install_law(rig *r, const parameters *p, const rig_options *o, fault *f)
{
    if (o->law != NULL) {
        r->given = *o->law;
        r->law = r->given.law;
    } else {
        TRY(open_named_law(r, p, o, f));
    }
    if (!r->withheld) {
        TRY(rig_lock(r, p->control.lock, f));
    }
    TRY(start_controller(r, p, f));
    FAULT_IF(p->control.force_amplitude > 0 && r->law->tune == NULL, f,
             STATUS_BAD_SCENARIO,
             "control.force_amplitude: the controller '%s' takes its force at the start "
             "only",
             r->law->name);
    return STATUS_OK;
}

status rig_create(rig **created, const parameters *p, const rig_options *o, fault *f)
{
    static const rig_options none = {.law = NULL};
    if (o == NULL) {
        o = &none;
    }
    assert(p->control.rate > 0);
    assert(o->law != NULL || p->control.law != LAW_NONE);
    *created = NULL;
    rig *r = calloc(1, sizeof *r);
    FAULT_IF(r == NULL, f, STATUS_NO_MEMORY, "no memory for the rig");

    prepare_loop(r, p);
    const status s = install_law(r, p, o, f);
    if (s != STATUS_OK) {
        rig_destroy(r);
        return s;
    }
    *created = r;
    return STATUS_OK;
}

void rig_destroy(rig *r)
{
    if (r != NULL) {
        free(r->memory);
        free(r->values);
        plugin_close(&r->plugin);
        process_destroy(r->process);
        played_command_close(&r->played);
        free(r);
    }
}

// --- the sampled loop ------------------------------------------------------------------

double rig_next_time(const rig *r)
{
    if (r->pending_count > 0) {
        return smaller(r->sample_time, r->effect_time[0]);
    }
    return r->sample_time;
}

// Puts the pending commands into effect that are due at an instant, in their order, and
// then the oldest others until no more than `most` are pending. Sets *changed if the
// voltage changes.
static void apply_commands(rig *r, double time, int most, bool *changed)
{
    while (r->pending_count > 0 &&
           (!instant_after(r->effect_time[0], time) || r->pending_count > most)) {
        *changed = *changed || r->pending[0] != r->voltage;
        r->voltage = r->pending[0];
        r->largest_command = larger(fabs(r->voltage), r->largest_command);
        r->pending_count--;
        memmove(r->pending, r->pending + 1,
                (size_t)r->pending_count * sizeof r->pending[0]);
        memmove(r->effect_time, r->effect_time + 1,
                (size_t)r->pending_count * sizeof r->effect_time[0]);
    }
}

// A controller's input at a sample [s], of the last reading.
static controller_input input_of(const rig *r, double time)
{
    const sensor_reading *read = &r->reading;
    bool piezo = r->sensors.p.force == FORCE_BY_PIEZO;
    return (controller_input){.time = time,
                              .encoder = read->encoder,
                              .tachometer = read->tachometer,
                              .force = piezo ? read->piezo_force : read->force_reading,
                              .voltage = r->voltage,
                              .piezo_force = read->piezo_force,
                              .film = read->film,
                              .accelerometer = read->accelerometer,
                              .wanted_mode = r->lock};
}

void rig_read(rig *r, double time, const sensed_motion *now)
{
    if (!instant_after(r->sample_time, time) && r->read_time != time) {
        r->reading = sensors_read(&r->sensors, now);
        r->read_time = time;
    }
}

// Asks the controller for its output at a sample [s]. STATUS_STOPPED, without a sentence,
// if the run was asked to end while a program was to answer.
static status ask_controller(rig *r, double time, const controller_input *input, fault *f)
{
    controller_output *out = &r->output;
    *out = no_answer();
    if (r->withheld) {
        return explain_withheld(r, f);
    }
    r->law->sample(r->memory, input, out);

    // a program that did not answer
    if (r->process != NULL) {
        const char *why;
        const status code = process_failure(r->process, &why);
        if (code == STATUS_STOPPED) {
            return code;
        }
        if (code != STATUS_OK) {
            return fault_set_at(f, code, "control.command", "at t = %.9g s %s", time,
                                why);
        }
    }

    // a command that no motor can be given
    const char *what = "gave an infinite command";
    if (isnan(out->command)) {
        what = "did not answer with a command";
    }
    FAULT_IF(!isfinite(out->command), f, STATUS_NOT_FINITE,
             "at t = %.9g s the controller '%s' %s, expected a finite number of "
             "volts; its sensors read %.6g rad, %.6g rad/s and %.6g N",
             time, r->law->name, what, input->encoder, input->tachometer, input->force);
    return STATUS_OK;
}

// Takes one sample: set-point, sensors, controller, D/A converter. The command is then
// pending for the delay.
static status take_sample(rig *r, double time, const sensed_motion *now, fault *f)
{
    TRY(rig_follow_setpoint(r, time, f));
    rig_read(r, time, now);
    controller_input input = input_of(r, time);
    r->predicted_force = (double)NAN;
    if (r->known.control.force_limit > 0) {
        r->predicted_force = touch_forecast_sample(&r->forecast, &input);
    }
    input.predicted_force = r->predicted_force;
    TRY(ask_controller(r, time, &input, f));

    // what the D/A makes of the command goes out after the delay
    r->pending[r->pending_count] = converter_value(&r->dac, r->output.command);
    r->effect_time[r->pending_count++] = time + r->delay;

    // the next sample, scattered evenly over the jitter's width
    r->samples++;
    r->sample_time = r->clock_start + (double)(r->samples - r->clock_samples) * r->period;
    if (r->jitter != 0) {
        r->sample_time += r->jitter * (random_uniform(&r->clock) - 0.5);
    }
    return STATUS_OK;
}

status rig_act(rig *r, double time, const sensed_motion *now, bool *changed, fault *f)
{
    const int mode = r->output.mode;
    *changed = false;
    const bool samples = !instant_after(r->sample_time, time);

    // Commands that are due take effect. With jitter a sample may come before a command
    // that it should come after; that command takes effect with it.
    int most = CONTROL_MOST_DELAY + 1;
    if (samples) {
        most = r->pending_most;
    }
    apply_commands(r, time, most, changed);

    status s = STATUS_OK;
    if (samples) {
        s = take_sample(r, time, now, f);
    }

    // without a delay the new command takes effect at once
    if (s == STATUS_OK) {
        apply_commands(r, time, CONTROL_MOST_DELAY + 1, changed);
    }
    *changed = *changed || r->output.mode != mode;
    return s;
}
