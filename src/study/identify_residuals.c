// Reads recorded traces, weighs their readings, and computes the residuals between them
// and runs under the recorded command.
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/csv_table.h"
#include "src/base/words.h"
#include "src/rig/rig.h"
#include "src/run/run.h"
#include "src/study/identify.h"

#define FAILED_RUN      1e3  // residual of a run that fails, in standard deviations
#define LEAST_RATE      10.0 // of a recording that tells something of an arm [1/s]
#define SAME_INSTANT    1e-6 // of a sampling period
#define NEAR_RANGE      5.0  // standard deviations from the end of a converter's range
#define LEAST_DEVIATION 1e-6 // of an ideal channel, in its unit
#define HELD            1.5  // periods of rows that a sample lasts which they repeat

enum {
    LEAST_CHANGES = 20,
    ROWS_FOR_ONE_BAD = 20,
    SHOWN_STEPS = 100 // of IDENTIFY_GUARD, in which a touch is shown
};

const int identify_signals[CHANNELS] = {
    SIGNAL_INDEX(encoder),        SIGNAL_INDEX(tachometer), SIGNAL_INDEX(force_reading),
    SIGNAL_INDEX(piezo_force),    SIGNAL_INDEX(film),       SIGNAL_INDEX(accelerometer),
    SIGNAL_INDEX(tip_deflection), SIGNAL_INDEX(root_strain)};

const char *const identify_uses[READING_USES] = {
    [READING_MISSING] = "missing",
    [READING_NEAR_TOUCH] = "within 10 ms of a touch",
    [READING_WITHOUT_CONTACT] = "without contact",
    [READING_AT_RANGE] = "at the end of the range"};

// --- reading ---------------------------------------------------------------------------

// What `columns` say ("signal=heading") is the heading of a signal; NULL if nothing.
static const char *said_heading(const char *signal, char *const *columns, int count)
{
    const size_t length = strlen(signal);
    for (int i = 0; i < count; i++) {
        if (strncmp(columns[i], signal, length) == 0 && columns[i][length] == '=') {
            return columns[i] + length + 1;
        }
    }
    return NULL;
}

// Reads a signal's column, of a channel's or the command's [V]. Its heading is the
// signal's name unless the caller says another one. A reading that is missing, and of
// which nothing is said, leaves NULL in *values.
static status read_column(const csv_table *t, const char *signal, const char *unit,
                          const char *said, csv_gaps gaps, double **values, fault *f)
{
    const char *heading = said != NULL ? said : signal;
    const bool missing = csv_table_find(t, heading) < 0;
    *values = NULL;
    if (missing && said == NULL && gaps == GAPS_HELD) {
        return fault_set_place(
            f, STATUS_BAD_ARGUMENT, 1, 1,
            "%.300s:1:1: there is no column 'command', the voltage [V] with "
            "which each trial run is driven: record it, or rename its heading",
            t->file);
    }
    if (missing && said == NULL) {
        return STATUS_OK;
    }
    return csv_table_numbers(t, heading, unit, gaps, values, f);
}

static bool is_called(const char *name, const char *text, size_t length)
{
    return strlen(name) == length && strncmp(name, text, length) == 0;
}

// Refuses "signal=heading" of a signal that no trace has.
static status check_columns(char *const *columns, int count, fault *f)
{
    for (int i = 0; i < count; i++) {
        const char *text = columns[i];
        const size_t length = strcspn(text, "=");
        bool known =
            is_called("time", text, length) || is_called("command", text, length);
        for (int c = 0; c < CHANNELS; c++) {
            const char *name = signal_table[identify_signals[c]].name;
            known = known || is_called(name, text, length);
        }
        FAULT_IF(!known || text[length] != '=', f, STATUS_BAD_ARGUMENT,
                 "--column '%.100s' names no signal of a trace, expected "
                 "SIGNAL=HEADER[unit] with time, command or a reading such as encoder",
                 text);
    }
    return STATUS_OK;
}

// Whether a row has another value than the row above it, in any column.
static bool row_changes(const recorded_trace *t, size_t i)
{
    bool changes = i == 0 || t->command[i] != t->command[i - 1];
    for (int c = 0; c < CHANNELS && !changes; c++) {
        const double *reading = t->reading[c];
        changes = reading != NULL && !isnan(reading[i]) && reading[i] != reading[i - 1];
    }
    return changes;
}

// Finds the clock of the samples, where the rows are not samples but repeat what the rig
// holds between them: then all that changes does so at the samples of a slower clock.
// *held is how many rows have changes, of which there need to be some for that.
static status find_held_clock(const recorded_trace *t, sample_clock *held, fault *f)
{
    SCOPED(free_kept) double *changed = calloc(t->rows, sizeof *changed);
    size_t count = 0;
    *held = (sample_clock){.period = 0};
    if (changed == NULL) {
        return fault_no_memory(f);
    }
    for (size_t i = 0; i < t->rows; i++) {
        if (row_changes(t, i)) {
            changed[count++] = t->time[i];
        }
    }
    if (count >= LEAST_CHANGES && !sample_clock_fit(held, changed, count)) {
        return fault_no_memory(f);
    }
    return STATUS_OK;
}

// Puts row i in the place of a sample; if it is not the first there, the readings that it
// has.
static void put_row(recorded_trace *t, size_t i, size_t place, bool first)
{
    t->command[place] = t->command[i];
    for (int c = 0; c < CHANNELS; c++) {
        double *reading = t->reading[c];
        if (reading != NULL && (first || !isnan(reading[i]))) {
            reading[place] = reading[i];
        }
    }
}

// Refuses a trace of which many rows have the same times as others.
static status check_stamps(const recorded_trace *t, size_t alike, size_t rows, fault *f)
{
    FAULT_IF(alike > rows / ROWS_FOR_ONE_BAD, f, STATUS_BAD_ARGUMENT,
             "%.300s:2: by their times %zu of %zu rows belong to the sample of the row "
             "above and yet differ from it, expected times that tell samples apart",
             t->file, alike, rows);
    return STATUS_OK;
}

// Keeps one row for each sample: of several, which repeat what the rig holds, the last
// one's values. Time then counts from the first sample, by the rig's clock where the
// recorder's differs from that by its error only.
static status keep_samples(recorded_trace *t, double usual_rate, fault *f)
{
    sample_clock held;
    TRY(find_held_clock(t, &held, f));
    const double row_period = t->clock.period;
    t->is_held = held.period > HELD * row_period;

    // by how much of a period a row may come before its sample
    double margin = 0.5;
    if (t->is_held) {
        t->clock = held;
        margin = fmax(row_period / 2, 4 * held.scatter) / held.period + SAME_INSTANT;
    }

    // samples have numbers at a steady rate, else times that differ
    const double period = t->clock.period;
    t->begin = period > 0 ? t->clock.origin : t->time[0];
    size_t kept = 0, alike = 0;
    double last = -HUGE_VAL;
    bool sample_changed = false;
    for (size_t i = 0; i < t->rows; i++) {
        double number = t->time[i];
        if (period > 0) {
            number = floor((t->time[i] - t->begin) / period + margin);
        }
        const bool changes = row_changes(t, i), first = number > last;
        if (first) {
            t->time[kept++] = t->is_held ? number * period : t->time[i] - t->begin;
            sample_changed = false;
        }
        if (changes && sample_changed) {
            alike++;
        }
        sample_changed = sample_changed || changes;
        last = number;
        put_row(t, i, kept - 1, first);
    }
    TRY(check_stamps(t, alike, t->rows, f));
    t->rows = kept;

    // a sample that changes nothing is not missing
    if (t->is_held) {
        t->clock.missing = (size_t)(last + 1) - kept;
        t->clock.gaps = 0;
        t->clock.longest = 0;
    }

    // the rig's clock, or that of the recording
    const double correction = sample_clock_correction(&t->clock, usual_rate);
    for (size_t i = 0; i < kept; i++) {
        t->time[i] *= correction;
    }
    t->rate = usual_rate;
    if (period > 0) {
        t->rate = 1 / (period * correction);
    }
    return STATUS_OK;
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
        [CHANNEL_TIP_DEFLECTION] = {s->tip_deflection_noise, adc.step, s->adc_range,
                                    s->tip_deflection_gain},
        [CHANNEL_ROOT_STRAIN] = {s->root_strain_noise, adc.step, s->adc_range,
                                 s->root_strain_gain},
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
// IDENTIFY_GUARD of a touch or a release, near[rows]. A touch ends a flight, in which the
// sensor shows nothing but noise; a force that only falls below the threshold and rises
// again is none.
static void find_touches(recorded_trace *t, const parameters *p, unsigned char *near)
{
    const int channel = force_channel(t);
    const double *force = t->reading[channel], threshold = p->control.contact_threshold;
    double released = -HUGE_VAL, range;
    bool dithered, flew = true;
    const double noise = deviation_of(&p->sensor, channel, &range, &dithered);
    size_t before = t->rows; // the last reading; none yet
    for (size_t i = 0; force != NULL && i < t->rows; i++) {
        if (isnan(force[i])) {
            continue;
        }
        const size_t last = before < t->rows ? before : i;
        const bool touched = force[last] > threshold, touches = force[i] > threshold;
        before = i;
        if (compared_value(&p->sensor, channel, force[last]) < NEAR_RANGE * noise) {
            flew = true;
        }
        if (touched == touches) {
            continue;
        }

        // a touch soon after a release is no touch of its own
        const double change = (t->time[last] + t->time[i]) / 2;
        if (touches && flew && change - released > IDENTIFY_GUARD) {
            t->contact_width[t->contact_count] = t->time[i] - t->time[last];
            t->contacts[t->contact_count++] = change;
        }
        released = change;
        flew = false;

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
// deviation each of n samples has times sqrt(n), unless noise covers the steps; of a
// sensor that looks less often than the rig only the first one is compared.
static status weigh_channel(recorded_trace *t, int c, const parameters *p,
                            const unsigned char *near, fault *f)
{
    double range;
    bool dithered;
    const double deviation = deviation_of(&p->sensor, c, &range, &dithered);
    const double *reading = t->reading[c];
    const bool slow =
        (c == CHANNEL_TIP_DEFLECTION && p->sensor.tip_deflection_rate > 0) ||
        (c == CHANNEL_ROOT_STRAIN && p->sensor.root_strain_rate > 0);
    t->deviation[c] = calloc(t->rows, sizeof *t->deviation[c]);
    if (t->deviation[c] == NULL) {
        return fault_no_memory(f);
    }
    for (size_t i = 0, end; i < t->rows; i = end) {
        // the samples from i to before `end` are one reading
        end = i + 1;
        while ((slow || !dithered) && end < t->rows && reading[end] == reading[i]) {
            end++;
        }

        for (size_t k = i; k < end; k++) {
            const double size = fabs(compared_value(&p->sensor, c, reading[k]));
            const bool touches =
                c != CHANNEL_FSR || reading[k] > p->control.contact_threshold;
            reading_use use = READING_COMPARED;
            if (isnan(reading[k])) {
                use = READING_MISSING;
            } else if (slow && k > i) {
                use = READING_REPEATED;
            } else if (near[k]) {
                use = READING_NEAR_TOUCH;
            } else if (!touches) {
                use = READING_WITHOUT_CONTACT;
            } else if (!(size < range - NEAR_RANGE * deviation)) {
                use = READING_AT_RANGE;
            } else {
                const size_t shared = slow ? 1 : end - i;
                t->deviation[c][k] = deviation * sqrt((double)shared);
                t->residuals++;
            }
            t->uses[c][use]++;
        }
    }
    return STATUS_OK;
}

// Finds the touches in the recorded force and weighs the readings of all channels.
static status weigh(recorded_trace *t, const parameters *p, fault *f)
{
    SCOPED(free_kept) unsigned char *near = calloc(t->rows, 1);
    t->contacts = calloc(t->rows, sizeof *t->contacts);
    t->contact_width = calloc(t->rows, sizeof *t->contact_width);
    if (near == NULL || t->contacts == NULL || t->contact_width == NULL) {
        return fault_no_memory(f);
    }
    find_touches(t, p, near);
    t->residuals = (size_t)t->contact_count;
    for (int c = 0; c < CHANNELS; c++) {
        if (t->reading[c] != NULL) {
            TRY(weigh_channel(t, c, p, near, f));
        }
    }
    return STATUS_OK;
}

// The first reading of a channel, NaN if there is none.
static double first_reading(const recorded_trace *t, int channel)
{
    size_t first = 0;
    while (t->reading[channel] != NULL && first < t->rows) {
        if (!isnan(t->reading[channel][first])) {
            return t->reading[channel][first];
        }
        first++;
    }
    return (double)NAN;
}

// Guesses the state that the trace starts with: the angle that the encoder reads first,
// and the tachometer's first velocity if that differs from the scenario's by more than
// noise.
static void guess_start(recorded_trace *t, const parameters *p)
{
    const double encoder = first_reading(t, CHANNEL_ENCODER),
                 speed = first_reading(t, CHANNEL_TACHOMETER);
    double range;
    bool dithered;
    t->own[OWN_ANGLE] = p->initial.angle;
    t->own[OWN_VELOCITY] = p->initial.velocity;
    if (!isnan(encoder)) {
        t->own[OWN_ANGLE] =
            (encoder - p->sensor.encoder_offset) / (1 + p->sensor.encoder_gain_error);
    }
    const double noise = deviation_of(&p->sensor, CHANNEL_TACHOMETER, &range, &dithered);
    t->fits_velocity = p->initial.velocity != 0;
    if (fabs(speed - p->initial.velocity) > NEAR_RANGE * noise) {
        t->own[OWN_VELOCITY] = speed;
        t->fits_velocity = true;
    }
}

// Reads the columns of a trace; readings that are all missing are none.
static status read_columns(recorded_trace *t, const csv_table *table,
                           char *const *columns, int count, fault *f)
{
    int readings = 0;
    TRY(read_column(table, "command", "V", said_heading("command", columns, count),
                    GAPS_HELD, &t->command, f));
    for (int c = 0; c < CHANNELS; c++) {
        const signal_info *signal = &signal_table[identify_signals[c]];
        TRY(read_column(table, signal->name, signal->unit,
                        said_heading(signal->name, columns, count), GAPS_MISSING,
                        &t->reading[c], f));
        if (isnan(first_reading(t, c))) {
            free(t->reading[c]);
            t->reading[c] = NULL;
        } else {
            readings++;
        }
    }
    if (readings == 0) {
        return fault_set_place(
            f, STATUS_BAD_ARGUMENT, 1, 1,
            "%.300s:1: no reading to compare with, expected a column such as "
            "encoder[rad], tachometer[rad/s] or force_reading[N]",
            t->file);
    }
    return STATUS_OK;
}

// Writes the headings of the columns that are taken, and of those that are not.
static void name_columns(recorded_trace *t, const csv_table *table, char *const *columns,
                         int count)
{
    // where time, command and readings stand
    int place[CHANNELS + 2] = {0};
    for (int c = 0; c < CHANNELS + 2; c++) {
        const char *name = "command";
        if (c < CHANNELS) {
            name = signal_table[identify_signals[c]].name;
        } else if (c > CHANNELS) {
            name = "time";
        }
        const char *said = said_heading(name, columns, count);
        if (said == NULL && c > CHANNELS) {
            said = csv_table_clock(table);
        }
        place[c] = csv_table_find(table, said != NULL ? said : name);
    }

    // each heading in its list
    for (int i = 0; i < table->columns; i++) {
        char *list = t->not_taken;
        for (int c = 0; c < CHANNELS + 2; c++) {
            const bool is_read = c >= CHANNELS || t->reading[c] != NULL;
            if (place[c] == i && is_read) {
                list = t->taken;
            }
        }
        const char *comma = list[0] != '\0' ? ", " : "";
        text_add(list, IDENTIFY_COLUMNS, "%s%s", comma, table->headings[i]);
    }
    make_printable(t->taken, 0);
    make_printable(t->not_taken, 0);
}

// Checks that the samples came at a rate that a rig can have.
static status check_rate(const recorded_trace *t, fault *f)
{
    const parameter_info *rate = &parameter_table[PARAMETER_INDEX(control.rate)];
    if (!(t->time[t->rows - 1] > t->time[0])) {
        return fault_set_place(f, STATUS_BAD_ARGUMENT, 2, 1,
                               "%.300s:2: no time passes from the first row to the last",
                               t->file);
    }
    const double mean = (double)(t->rows - 1) / (t->time[t->rows - 1] - t->time[0]);
    if (mean >= LEAST_RATE && mean <= rate->maximum) {
        return STATUS_OK;
    }
    return fault_set_place(f, STATUS_BAD_ARGUMENT, 2, 1,
                           "%.300s:2: by their times %zu rows take %.4g s, expected %g "
                           "to %g rows a second, with times in s or their unit in the "
                           "heading, such as time[ms]",
                           t->file, t->rows, t->time[t->rows - 1] - t->time[0],
                           LEAST_RATE, rate->maximum);
}

status identify_add_trace(identification *id, const char *file, char *const *columns,
                          int count, fault *f)
{
    assert(id->trace_count <= IDENTIFY_TRACES);
    FAULT_IF(id->trace_count == IDENTIFY_TRACES, f, STATUS_BAD_ARGUMENT,
             "more than %d traces", IDENTIFY_TRACES);
    TRY(check_columns(columns, count, f));
    const parameters *p = &id->base->parameters;
    recorded_trace *t = &id->traces[id->trace_count++];
    SCOPED(csv_table_finish) csv_table table = {0};
    *t = (recorded_trace){.file = strdup(file)};
    if (t->file == NULL) {
        return fault_no_memory(f);
    }
    for (int c = 0; c < CHANNELS; c++) {
        t->rms[c] = t->whiteness[c] = (double)NAN;
        t->rms_unit[c] = t->explained[c] = (double)NAN;
    }
    t->contact_error = t->peak_error = (double)NAN;
    TRY(csv_table_read(&table, file, 2, f));
    TRY(csv_table_times(&table, said_heading("time", columns, count), p->control.rate,
                        &t->clock, &t->time, f));
    t->rows = t->table_rows = table.rows;
    TRY(read_columns(t, &table, columns, count, f));
    csv_table_left_out(&table, t->left_out, sizeof t->left_out);
    name_columns(t, &table, columns, count);
    TRY(check_rate(t, f));
    TRY(keep_samples(t, p->control.rate, f));
    guess_start(t, p);
    return weigh(t, p, f);
}

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
    return touch_shown(run, touch, p, force_channel(t));
}

// Compares the run's largest force and its touches with the recorded ones: fills in the
// trace's relative error of the peak and its largest error of an instant of touch [s].
static void judge_run(recorded_trace *t, const trace *run, const parameters *p,
                      const double *own)
{
    const double period = 1 / p->control.rate;
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
                *residual++ = (compared_value(&p->sensor, c, t->reading[c][i]) -
                               compared_value(&p->sensor, c, computed)) /
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
