// Computes the residuals between recorded traces and runs under the recorded command.
#include <assert.h>
#include <math.h>

#include "src/base/csv_table.h"
#include "src/rig/rig.h"
#include "src/run/run.h"
#include "src/study/identify/identify.h"

#define FAILED_RUN   1e3  // residual of a run that fails, in standard deviations
#define SAME_INSTANT 1e-6 // of a sampling period

enum { SHOWN_STEPS = 100 }; // of IDENTIFY_GUARD, in which a touch is shown

// --- a run under the recorded command --------------------------------------------------

typedef struct playback_memory {
    const recorded_trace *trace;
    double period; // of the rig [s]
} playback_memory;

static const char *start_playback(void *memory, const controller_setup *setup)
{
    playback_memory *m = memory;
    m->period = setup->period;
    return NULL;
}

// Gives the command whose row is the nearest to the sample, or the one before if none is
// near.
static void play_back(void *memory, const controller_input *in, controller_output *out)
{
    const playback_memory *m = memory;
    const recorded_trace *t = m->trace;
    const double nearest = in->time + m->period / 2;
    out->command = csv_table_at(t->time, t->command, t->rows, nearest, false);
}

static const controller playback = {.interface = CONTROLLER_INTERFACE,
                                    .name = "the recorded command",
                                    .modes = (const char *const[]){"playback", NULL},
                                    .memory_size = sizeof(playback_memory),
                                    .start = start_playback,
                                    .sample = play_back};

// Until when a trace is compared [s]: a search takes it in parts.
static double horizon_of(const identification *id, const recorded_trace *t)
{
    return id->part * t->time[t->rows - 1];
}

// Makes the scenario of a run under the recorded command, from the start in own[]. Its
// sensors keep their lags, curves and ripple; they have no noise and no steps, whose size
// the residuals are measured by.
static status playback_scenario(const identification *id, const recorded_trace *t,
                                const parameters *p, const double own[OWNS],
                                scenario *made, fault *f)
{
    const sensor_parameters *sensor = &p->sensor;
    const double rate = t->rate;
    const parameter_change changes[] = {
        {PARAMETER_INDEX(control.settings), .text = ""},
        {PARAMETER_INDEX(control.lock), .text = "none"},
        {PARAMETER_INDEX(sensor.encoder_counts), 0},
        {PARAMETER_INDEX(sensor.adc_bits), 0},
        {PARAMETER_INDEX(sensor.tachometer_noise), 0},
        {PARAMETER_INDEX(sensor.fsr_noise), 0},
        {PARAMETER_INDEX(sensor.piezo_noise), 0},
        {PARAMETER_INDEX(sensor.film_noise), 0},
        {PARAMETER_INDEX(sensor.accelerometer_noise), 0},
        {PARAMETER_INDEX(sensor.tip_deflection_noise), 0},
        {PARAMETER_INDEX(sensor.tip_deflection_rate), 0},
        {PARAMETER_INDEX(sensor.root_strain_noise), 0},
        {PARAMETER_INDEX(sensor.root_strain_rate), 0},
        {PARAMETER_INDEX(sensor.piezo),
         sensor->piezo || t->reading[CHANNEL_PIEZO] != NULL},
        {PARAMETER_INDEX(sensor.film), sensor->film || t->reading[CHANNEL_FILM] != NULL},
        {PARAMETER_INDEX(sensor.accelerometer),
         sensor->accelerometer || t->reading[CHANNEL_ACCELEROMETER] != NULL},
        {PARAMETER_INDEX(sensor.tip_deflection),
         sensor->tip_deflection || t->reading[CHANNEL_TIP_DEFLECTION] != NULL},
        {PARAMETER_INDEX(sensor.root_strain),
         sensor->root_strain || t->reading[CHANNEL_ROOT_STRAIN] != NULL},
        {PARAMETER_INDEX(control.law), LAW_OPEN_LOOP},
        {PARAMETER_INDEX(control.rate), rate},
        {PARAMETER_INDEX(control.jitter), 0},
        {PARAMETER_INDEX(control.force_amplitude), 0},
        {PARAMETER_INDEX(control.force_limit), 0},
        {PARAMETER_INDEX(initial.angle), own[OWN_ANGLE]},
        {PARAMETER_INDEX(initial.velocity), own[OWN_VELOCITY]},
        {PARAMETER_INDEX(run.duration), horizon_of(id, t) + 3 / rate},
    };
    scenario from = *id->base;
    from.parameters = *p;
    from.action_count = 0;
    return scenario_with(&from, changes, sizeof changes / sizeof *changes, made, f);
}

status identify_scenario(const identification *id, int index, scenario *made, fault *f)
{
    const recorded_trace *t = &id->traces[index];
    parameters p;
    scenario fitted;
    TRY(identify_parameters(id, true, &p, f));
    TRY(playback_scenario(id, t, &p, t->own, &fitted, f));

    // The sensors get their noise and steps back. The recording is played back from its
    // file, from its first sample on.
    fitted.parameters.sensor = p.sensor;
    const parameter_change changes[] = {
        {PARAMETER_INDEX(sensor.encoder_offset),
         p.sensor.encoder_offset + t->own[OWN_OFFSET]},
        {PARAMETER_INDEX(control.law), LAW_PLAYBACK},
        {PARAMETER_INDEX(control.playback_file), .text = t->file},
        {PARAMETER_INDEX(control.playback_column), .text = "command"},
        {PARAMETER_INDEX(control.playback_hold), PLAYBACK_HOLD},
        {PARAMETER_INDEX(control.playback_shift), -t->begin},
    };
    return scenario_with(&fitted, changes, sizeof changes / sizeof *changes, made, f);
}

// A quantity between two rows of a run: the cubic through its values and rates at both
// (Hermite's interpolation).
static double interpolate_cubic(const sample *a, const sample *b, double time,
                                double from, double to, double from_rate, double to_rate)
{
    const double h = b->time - a->time;
    const double u = h > 0 ? (time - a->time) / h : 1;
    const double v = 1 - u;
    return v * v * (1 + 2 * u) * from + u * u * (3 - 2 * u) * to +
           h * u * v * (v * from_rate - u * to_rate);
}

// What a channel of a run reads at an instant. Encoder and tachometer read the hub's
// motion, interpolated by cubics; sensors that lag are interpolated linearly between two
// samples.
static double reading_at(const trace *run, sensors *eyes, int channel, double time,
                         double period)
{
    const size_t last = run->row_count - 1, at = trace_row_at(run, time);
    if (channel == CHANNEL_ENCODER || channel == CHANNEL_TACHOMETER) {
        const size_t next = at < last ? at + 1 : last;
        const sample *a = &run->rows[at], *b = &run->rows[next];
        const double when = fmax(time, a->time);
        const sensed_motion now = {
            .angle = interpolate_cubic(a, b, when, a->hub_angle, b->hub_angle,
                                       a->hub_velocity, b->hub_velocity),
            .velocity = interpolate_cubic(a, b, when, a->hub_velocity, b->hub_velocity,
                                          a->hub_acceleration, b->hub_acceleration)};
        const sensor_reading r = sensors_read(eyes, &now);
        if (channel == CHANNEL_ENCODER) {
            return r.encoder;
        }
        return r.tachometer;
    }

    // The samples before and after the instant. A sample's reading stands in the first
    // row at the instant of the next sample, before that one acts.
    const double sample_before = floor(time / period + SAME_INSTANT);
    const double share = time / period - sample_before;
    double value[2];
    for (int i = 0; i < 2; i++) {
        size_t row = trace_row_at(run, (sample_before + i + 1 - SAME_INSTANT) * period);
        if (row < last) {
            row++;
        }
        value[i] = signal_value(&run->rows[row], identify_signals[channel]);
    }
    if (share > SAME_INSTANT) {
        return (1 - share) * value[0] + share * value[1];
    }
    return value[0];
}

// The touch of the run that is nearest to an instant [s]; NULL if there is none.
static const event *nearest_touch(const trace *run, double time)
{
    double released = -HUGE_VAL;
    const event *best = NULL;
    for (size_t i = 0; i < run->event_count; i++) {
        const event *e = &run->events[i];
        const bool touches = e->kind == EVENT_IMPACT || e->kind == EVENT_CONTACT;
        if (touches && e->time - released > IDENTIFY_GUARD) {
            if (best == NULL || fabs(e->time - time) < fabs(best->time - time)) {
                best = e;
            }
        }

        // after an impact the arm is off the wall at once, in contact until a release
        if (touches || e->kind == EVENT_RELEASE) {
            if (e->kind == EVENT_CONTACT) {
                released = HUGE_VAL;
            } else {
                released = e->time;
            }
        }
    }
    return best;
}

// When the force sensor shows a touch of the run: as its reading, which was 0 in the
// flight before, exceeds the threshold [s]. Of a touch that is too light to be shown it
// is the touch itself.
static double touch_shown(const trace *run, const event *touch, const parameters *p,
                          int channel)
{
    const double h = IDENTIFY_GUARD / SHOWN_STEPS;
    const double threshold = p->control.contact_threshold;
    double shown = 0;
    sensors eyes;
    sensors_init(&eyes, &p->sensor, 0);
    sensors_strike(&eyes, touch->impulse);
    sensed_motion before = {.force = trace_sample_at(run, touch->time, 0).force};
    for (int k = 0; k < SHOWN_STEPS; k++) {
        // the reading at the end of a short step, in which the force changes straight
        sensed_motion now = {
            .force = trace_sample_at(run, touch->time + (k + 1) * h, 0).force};
        sensors_follow(&eyes, h, &before, &now, (before.force + now.force) / 2);
        const sensor_reading r = sensors_read(&eyes, &now);
        double reading = r.force_reading;
        if (channel == CHANNEL_PIEZO) {
            reading = r.piezo_force;
        }

        if (reading > threshold) {
            const double share = (threshold - shown) / (reading - shown);
            return touch->time + (k + fmax(share, 0)) * h;
        }
        shown = reading;
        before = now;
    }
    return touch->time;
}

// The instant at which the run's force sensor shows the touch that is nearest to `time`
// [s]; the run's end if there is none.
static double nearest_shown(const recorded_trace *t, const trace *run,
                            const parameters *p, double time)
{
    const event *touch = nearest_touch(run, time);
    if (touch == NULL) {
        return run->rows[run->row_count - 1].time;
    }
    return touch_shown(run, touch, p, identify_force_channel(t));
}

// Compares the run's largest force and its touches with the recorded ones: fills in the
// trace's relative error of the peak and its largest error of an instant of touch [s].
static void judge_run(recorded_trace *t, const trace *run, const parameters *p,
                      const double *own)
{
    const double period = 1 / p->control.rate;
    const int channel = identify_force_channel(t);
    double recorded = 0, computed = 0;
    for (size_t i = 0; t->reading[channel] != NULL && i < t->rows; i++) {
        const double time = fmax(t->time[i] - own[OWN_SHIFT], 0);
        recorded = fmax(recorded, t->reading[channel][i]);
        computed = fmax(computed, reading_at(run, NULL, channel, time, period));
    }
    if (t->contact_count > 0 && recorded > 0) {
        t->peak_error = computed / recorded - 1;
    } else {
        t->peak_error = (double)NAN;
    }
    if (t->contact_count > 0) {
        t->contact_error = 0;
    } else {
        t->contact_error = (double)NAN;
    }
    for (int i = 0; i < t->contact_count; i++) {
        const double at = t->contacts[i] - own[OWN_SHIFT];
        t->contact_error =
            fmax(t->contact_error, fabs(nearest_shown(t, run, p, at) - at));
    }
}

// Writes the residuals of a run, recorded less computed over the deviation: of every
// reading that is compared, then of the instants of touches, which lie between two
// readings. Those after the horizon [s] are 0.
static void compare_run(const recorded_trace *t, const trace *run, const parameters *p,
                        double horizon, const double own[OWNS], double *residual)
{
    sensors eyes;
    const double period = 1 / p->control.rate;
    sensors_init(&eyes, &p->sensor, 0);
    for (int c = 0; c < CHANNELS; c++) {
        for (size_t i = 0; t->reading[c] != NULL && i < t->rows; i++) {
            if (t->deviation[c][i] > 0 && t->time[i] > horizon) {
                *residual++ = 0;
            } else if (t->deviation[c][i] > 0) {
                const double time = fmax(t->time[i] - own[OWN_SHIFT], 0);
                const double offset = c == CHANNEL_ENCODER ? own[OWN_OFFSET] : 0;
                const double computed = reading_at(run, &eyes, c, time, period) + offset;
                *residual++ = (identify_compared_value(&p->sensor, c, t->reading[c][i]) -
                               identify_compared_value(&p->sensor, c, computed)) /
                              t->deviation[c][i];
            }
        }
    }
    for (int i = 0; i < t->contact_count; i++) {
        const double at = t->contacts[i] - own[OWN_SHIFT];
        if (t->contacts[i] > horizon) {
            *residual++ = 0;
        } else {
            const double width = t->contact_width[i];
            *residual++ = (at - nearest_shown(t, run, p, at)) / (width / sqrt(12));
        }
    }
}

status identify_residuals(const identification *id, recorded_trace *t,
                          const parameters *p, const double own[OWNS], bool judge,
                          double *residual, fault *f)
{
    scenario made;
    SCOPED(run_finish) run_result result = {0};
    const given_law law = {&playback, (void *)t};
    const run_options options = {.keep_trace = true, .law = &law, .monitor = NULL};
    status code = playback_scenario(id, t, p, own, &made, f);
    if (code == STATUS_OK) {
        code = run_scenario_with(&made, &options, &result);
        if (code != STATUS_OK) {
            fault_set(f, code, "the run of '%.200s' failed: %.700s", t->file,
                      result.summary.message);
        }
    }

    // a run that fails, or a reading that it does not have, gets a large residual
    if (code == STATUS_OK) {
        compare_run(t, &result.trace, &made.parameters, horizon_of(id, t), own, residual);
    }
    for (size_t i = 0; i < t->residuals; i++) {
        if (!(code == STATUS_OK && isfinite(residual[i]))) {
            residual[i] = FAILED_RUN;
        }
    }
    if (code == STATUS_OK && judge) {
        judge_run(t, &result.trace, &made.parameters, own);
    }
    return code;
}
