// Reads recorded traces, weighs their readings, and computes the residuals between them
// and runs under the recorded command.
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/csv_table.h"
#include "src/rig/rig.h"
#include "src/run/run.h"
#include "src/study/identify.h"

#define FAILED_RUN      1e3  // residual of a run that fails, in standard deviations
#define SAME_INSTANT    1e-6 // of a sampling period
#define ROW_MARGIN      1e-4 // of a sampling period, that its last row keeps from its end
#define NEAR_RANGE      5.0  // standard deviations from the end of a converter's range
#define LEAST_DEVIATION 1e-6 // of an ideal channel, in its unit

const int identify_signals[CHANNELS] = {
    SIGNAL_INDEX(encoder),     SIGNAL_INDEX(tachometer), SIGNAL_INDEX(force_reading),
    SIGNAL_INDEX(piezo_force), SIGNAL_INDEX(film),       SIGNAL_INDEX(accelerometer)};

// --- reading ---------------------------------------------------------------------------

// Reads a signal's column. Its heading is what `columns` says ("signal=heading"), else
// the signal's name. A column that is missing and not needed leaves NULL in *values.
static status read_column(const csv_table *t, const char *signal, const char *unit,
                          bool needed, char *const *columns, int count, double **values,
                          fault *f)
{
    const char *heading = signal;
    const size_t length = strlen(signal);
    for (int i = 0; i < count; i++) {
        if (strncmp(columns[i], signal, length) == 0 && columns[i][length] == '=') {
            heading = columns[i] + length + 1;
            needed = true;
        }
    }
    *values = NULL;
    const bool missing = csv_table_find(t, heading) < 0;
    if (!needed && missing) {
        return STATUS_OK;
    }
    if (missing && strcmp(heading, "command") == 0) {
        return fault_set_place(
            f, STATUS_BAD_ARGUMENT, 1, 1,
            "%.300s:1:1: there is no column 'command', the voltage [V] with "
            "which each trial run is driven: record it, or rename its heading",
            t->file);
    }
    if (strcmp(signal, "time") == 0) {
        return csv_table_times(t, heading, values, f);
    }
    return csv_table_numbers(t, heading, unit, false, values, f);
}

// Keeps one row for each sampling period: of several rows within a period, which repeat
// what the rig holds, the first one's time and the last one's values. Time then counts
// from the first row.
static void keep_samples(recorded_trace *t, double rate)
{
    size_t kept = 0;
    double last_period = -1;
    const double begin = t->begin = t->time[0];
    for (size_t i = 0; i < t->rows; i++) {
        const double period = floor((t->time[i] - begin) * rate + SAME_INSTANT);
        if (period > last_period) {
            t->time[kept++] = t->time[i] - begin;
            last_period = period;
        }
        t->command[kept - 1] = t->command[i];
        for (int c = 0; c < CHANNELS; c++) {
            if (t->reading[c] != NULL) {
                t->reading[c][kept - 1] = t->reading[c][i];
            }
        }
    }
    t->rows = kept;
}

// The sensor that says when the arm touches: the FSR, else the piezoelectric one.
static int force_channel(const recorded_trace *t)
{
    return t->reading[CHANNEL_FSR] != NULL ? CHANNEL_FSR : CHANNEL_PIEZO;
}

// The quantity whose differences are residuals: the FSR's volts, in which its noise does
// not depend on the force, else the reading itself.
static double compared_value(const sensor_parameters *s, int channel, double reading)
{
    if (channel == CHANNEL_FSR) {
        return fsr_volts(s, reading);
    }
    return reading;
}

// The standard deviation of a reading by noise and by the converter's steps,
//
//     sqrt(noise^2 + step^2/12),
//
// in the unit of compared_value. *range receives the largest magnitude that can be read,
// in that unit, and *dithered whether the noise covers the steps.
static double deviation_of(const sensor_parameters *s, int channel, double *range,
                           bool *dithered)
{
    // sensors of volts behind an A/D converter, and an encoder, which counts radians
    const converter adc = converter_of(s->adc_bits, s->adc_range);
    const double encoder_step = s->encoder_counts > 0 ? 2 * M_PI / s->encoder_counts : 0;
    const struct {
        double noise, step, range; // in the sensor's own unit, [V] or [rad]
        double gain;               // of that unit per unit of the reading
    } channels[CHANNELS] = {
        [CHANNEL_ENCODER] = {0, encoder_step, HUGE_VAL, 1},
        [CHANNEL_TACHOMETER] = {s->tachometer_noise, adc.step, s->adc_range,
                                s->tachometer_gain},
        [CHANNEL_FSR] = {s->fsr_noise, adc.step, s->adc_range, 1},
        [CHANNEL_PIEZO] = {s->piezo_noise, adc.step, s->adc_range, s->piezo_gain},
        [CHANNEL_FILM] = {s->film_noise, adc.step, s->adc_range, s->film_gain},
        [CHANNEL_ACCELEROMETER] = {s->accelerometer_noise, adc.step, s->adc_range,
                                   s->accelerometer_gain},
    };
    const double gain = channels[channel].gain;
    double noise = channels[channel].noise, step = channels[channel].step;
    *range = channels[channel].range / gain;

    // an ideal sensor has neither noise nor steps; an FSR saturates
    if (s->ideal) {
        step = noise = 0;
        *range = HUGE_VAL;
    }
    if (channel == CHANNEL_FSR) {
        *range = fmin(*range, fsr_volts(s, s->fsr_saturation));
    }
    *dithered = noise >= step / 2;
    return fmax(sqrt(noise * noise + step * step / 12) / gain, LEAST_DEVIATION);
}

// Finds the touches in the force that was recorded, and marks the samples within
// IDENTIFY_GUARD of a touch or a release, near[rows].
static void find_touches(recorded_trace *t, double threshold, unsigned char *near)
{
    const double *force = t->reading[force_channel(t)];
    double released = -HUGE_VAL;
    for (size_t i = 1; force != NULL && i < t->rows; i++) {
        const bool touched = force[i - 1] > threshold, touches = force[i] > threshold;
        if (touched == touches) {
            continue;
        }

        // a touch soon after a release is no touch of its own
        const double change = (t->time[i - 1] + t->time[i]) / 2;
        if (touches && change - released > IDENTIFY_GUARD) {
            t->contacts[t->contact_count++] = change;
        }
        released = change;

        // the samples before the change, and those after it
        for (size_t k = i; k-- > 0 && change - t->time[k] <= IDENTIFY_GUARD;) {
            near[k] = 1;
        }
        for (size_t k = i; k < t->rows && t->time[k] - change <= IDENTIFY_GUARD; k++) {
            near[k] = 1;
        }
    }
}

// Sets the deviation of each reading of a channel and counts the readings that are
// compared. A deviation of 0 marks those that are not: near a touch, of the FSR without
// contact, or near the end of the range. Equal readings in a row are one reading, whose
// deviation each of n samples has times sqrt(n), unless noise covers the steps.
static status weigh_channel(recorded_trace *t, int c, const parameters *p,
                            const unsigned char *near, fault *f)
{
    double range;
    bool dithered;
    const double deviation = deviation_of(&p->sensor, c, &range, &dithered);
    const double *reading = t->reading[c];
    t->deviation[c] = calloc(t->rows, sizeof *t->deviation[c]);
    if (t->deviation[c] == NULL) {
        return fault_no_memory(f);
    }
    for (size_t i = 0, end; i < t->rows; i = end) {
        // the samples from i to before `end` are one reading
        end = i + 1;
        while (!dithered && end < t->rows && reading[end] == reading[i]) {
            end++;
        }

        for (size_t k = i; k < end; k++) {
            const double size = fabs(compared_value(&p->sensor, c, reading[k]));
            const bool touches =
                c != CHANNEL_FSR || reading[k] > p->control.contact_threshold;
            if (!near[k] && touches && size < range - NEAR_RANGE * deviation) {
                t->deviation[c][k] = deviation * sqrt((double)(end - i));
                t->residuals++;
            }
        }
    }
    return STATUS_OK;
}

// Finds the touches in the recorded force and weighs the readings of all channels.
static status weigh(recorded_trace *t, const parameters *p, fault *f)
{
    SCOPED(free_kept) unsigned char *near = calloc(t->rows, 1);
    t->contacts = calloc(t->rows, sizeof *t->contacts);
    if (near == NULL || t->contacts == NULL) {
        return fault_no_memory(f);
    }
    find_touches(t, p->control.contact_threshold, near);
    t->residuals = (size_t)t->contact_count;
    for (int c = 0; c < CHANNELS; c++) {
        if (t->reading[c] != NULL) {
            TRY(weigh_channel(t, c, p, near, f));
        }
    }
    return STATUS_OK;
}

// Guesses the state that the trace starts with: the angle that the encoder reads first,
// and the tachometer's first velocity if that differs from the scenario's by more than
// noise.
static void guess_start(recorded_trace *t, const parameters *p)
{
    const double *encoder = t->reading[CHANNEL_ENCODER],
                 *speed = t->reading[CHANNEL_TACHOMETER];
    double range;
    bool dithered;
    t->own[OWN_ANGLE] = p->initial.angle;
    t->own[OWN_VELOCITY] = p->initial.velocity;
    if (encoder != NULL) {
        t->own[OWN_ANGLE] =
            (encoder[0] - p->sensor.encoder_offset) / (1 + p->sensor.encoder_gain_error);
    }
    const double noise = deviation_of(&p->sensor, CHANNEL_TACHOMETER, &range, &dithered);
    t->fits_velocity = p->initial.velocity != 0;
    if (speed != NULL && fabs(speed[0] - p->initial.velocity) > NEAR_RANGE * noise) {
        t->own[OWN_VELOCITY] = speed[0];
        t->fits_velocity = true;
    }
}

status identify_add_trace(identification *id, const char *file, char *const *columns,
                          int count, fault *f)
{
    assert(id->trace_count <= IDENTIFY_TRACES);
    FAULT_IF(id->trace_count == IDENTIFY_TRACES, f, STATUS_BAD_ARGUMENT,
             "more than %d traces", IDENTIFY_TRACES);
    const parameters *p = &id->base->parameters;
    recorded_trace *t = &id->traces[id->trace_count++];
    SCOPED(csv_table_finish) csv_table table = {0};
    *t = (recorded_trace){.file = strdup(file)};
    if (t->file != NULL) {
        TRY(csv_table_read(&table, file, 2, f));
    } else {
        return fault_no_memory(f);
    }

    t->rows = table.rows;
    TRY(read_column(&table, "time", "s", true, columns, count, &t->time, f));
    TRY(read_column(&table, "command", "V", true, columns, count, &t->command, f));
    int readings = 0;
    for (int c = 0; c < CHANNELS; c++) {
        const signal_info *signal = &signal_table[identify_signals[c]];
        TRY(read_column(&table, signal->name, signal->unit, false, columns, count,
                        &t->reading[c], f));
        if (t->reading[c] != NULL) {
            readings++;
        }
    }
    if (readings == 0) {
        return fault_set_place(
            f, STATUS_BAD_ARGUMENT, 1, 1,
            "%.300s:1: no reading to compare with, expected a column such as "
            "encoder[rad], tachometer[rad/s] or force_reading[N]",
            file);
    }
    if (!(t->time[t->rows - 1] > t->time[0])) {
        return fault_set_place(f, STATUS_BAD_ARGUMENT, 2, 1,
                               "%.300s:2: no time passes from the first row to the last",
                               file);
    }
    keep_samples(t, p->control.rate);
    guess_start(t, p);
    return weigh(t, p, f);
}

// --- a run under the recorded command --------------------------------------------------

typedef struct playback_memory {
    const recorded_trace *trace;
} playback_memory;

static void play_back(void *memory, const controller_input *in, controller_output *out)
{
    const recorded_trace *t = ((const playback_memory *)memory)->trace;
    out->command = csv_table_at(t->time, t->command, t->rows, in->time + 1e-9, false);
}

static const controller playback = {.interface = CONTROLLER_INTERFACE,
                                    .name = "the recorded command",
                                    .modes = (const char *const[]){"playback", NULL},
                                    .memory_size = sizeof(playback_memory),
                                    .sample = play_back};

// Makes the scenario of a run under the recorded command, from the start in own[]. Its
// sensors keep their lags, curves and ripple; they have no noise and no steps, whose size
// the residuals are measured by.
static status playback_scenario(const identification *id, const recorded_trace *t,
                                const parameters *p, const double own[OWNS],
                                scenario *made, fault *f)
{
    const sensor_parameters *sensor = &p->sensor;
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
        {PARAMETER_INDEX(sensor.piezo),
         sensor->piezo || t->reading[CHANNEL_PIEZO] != NULL},
        {PARAMETER_INDEX(sensor.film), sensor->film || t->reading[CHANNEL_FILM] != NULL},
        {PARAMETER_INDEX(sensor.accelerometer),
         sensor->accelerometer || t->reading[CHANNEL_ACCELEROMETER] != NULL},
        {PARAMETER_INDEX(control.law), LAW_OPEN_LOOP},
        {PARAMETER_INDEX(control.jitter), 0},
        {PARAMETER_INDEX(control.force_amplitude), 0},
        {PARAMETER_INDEX(control.force_limit), 0},
        {PARAMETER_INDEX(initial.angle), own[OWN_ANGLE]},
        {PARAMETER_INDEX(initial.velocity), own[OWN_VELOCITY]},
        {PARAMETER_INDEX(run.duration), t->time[t->rows - 1] + 3 / p->control.rate},
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
    // file, shifted so that a sample takes the last row of its period, as keep_samples
    // does.
    fitted.parameters.sensor = p.sensor;
    const double period = (1 - ROW_MARGIN) / p.control.rate;
    const parameter_change changes[] = {
        {PARAMETER_INDEX(sensor.encoder_offset),
         p.sensor.encoder_offset + t->own[OWN_OFFSET]},
        {PARAMETER_INDEX(control.law), LAW_PLAYBACK},
        {PARAMETER_INDEX(control.playback_file), .text = t->file},
        {PARAMETER_INDEX(control.playback_column), .text = "command"},
        {PARAMETER_INDEX(control.playback_hold), PLAYBACK_HOLD},
        {PARAMETER_INDEX(control.playback_shift), -(t->begin + period)},
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

// The touch of the run that is nearest to an instant [s]; the run's end if there is none.
static double nearest_touch(const trace *run, double time)
{
    double released = -HUGE_VAL, best = run->rows[run->row_count - 1].time;
    bool any = false;
    for (size_t i = 0; i < run->event_count; i++) {
        const event *e = &run->events[i];
        const bool touches = e->kind == EVENT_IMPACT || e->kind == EVENT_CONTACT;
        if (touches && e->time - released > IDENTIFY_GUARD) {
            if (!any || fabs(e->time - time) < fabs(best - time)) {
                best = e->time;
            }
            any = true;
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

// Compares the run's largest force and its touches with the recorded ones: fills in the
// trace's relative error of the peak and its largest error of an instant of touch [s].
static void judge_run(recorded_trace *t, const trace *run, double period,
                      const double *own)
{
    const int channel = force_channel(t);
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
        t->contact_error = fmax(t->contact_error, fabs(nearest_touch(run, at) - at));
    }
}

// Writes the residuals of a run, recorded less computed over the deviation: of every
// reading that is compared, then of the instants of touches, which are known to a
// sampling period.
// Writes the residuals of a run, recorded less computed over the deviation: of every
// reading that is compared, then of the instants of touches, which are known to a
// sampling period.
static void compare_run(const recorded_trace *t, const trace *run, const parameters *p,
                        const double own[OWNS], double *residual)
{
    sensors eyes;
    const double period = 1 / p->control.rate;
    sensors_init(&eyes, &p->sensor, 0);
    for (int c = 0; c < CHANNELS; c++) {
        for (size_t i = 0; t->reading[c] != NULL && i < t->rows; i++) {
            if (t->deviation[c][i] > 0) {
                const double time = fmax(t->time[i] - own[OWN_SHIFT], 0);
                const double offset = c == CHANNEL_ENCODER ? own[OWN_OFFSET] : 0;
                const double computed = reading_at(run, &eyes, c, time, period) + offset;
                *residual++ = (compared_value(&p->sensor, c, t->reading[c][i]) -
                               compared_value(&p->sensor, c, computed)) /
                              t->deviation[c][i];
            }
        }
    }
    for (int i = 0; i < t->contact_count; i++) {
        const double at = t->contacts[i] - own[OWN_SHIFT];
        *residual++ = (at - nearest_touch(run, at)) / (period / sqrt(12));
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
        compare_run(t, &result.trace, &made.parameters, own, residual);
    }
    for (size_t i = 0; i < t->residuals; i++) {
        if (!(code == STATUS_OK && isfinite(residual[i]))) {
            residual[i] = FAILED_RUN;
        }
    }
    if (code == STATUS_OK && judge) {
        judge_run(t, &result.trace, 1 / made.parameters.control.rate, own);
    }
    return code;
}
