// Reads recorded traces: their columns, the samples of their clock, and what they start
// from.
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/csv_table.h"
#include "src/base/words.h"
#include "src/study/identify/identify.h"

#define LEAST_RATE   10.0 // of a recording that tells something of an arm [1/s]
#define SAME_INSTANT 1e-6 // of a sampling period
#define HELD         1.5  // periods of rows that a sample lasts which they repeat

enum { LEAST_CHANGES = 20, ROWS_FOR_ONE_BAD = 20 };

const int identify_signals[CHANNELS] = {
    SIGNAL_INDEX(encoder),        SIGNAL_INDEX(tachometer), SIGNAL_INDEX(force_reading),
    SIGNAL_INDEX(piezo_force),    SIGNAL_INDEX(film),       SIGNAL_INDEX(accelerometer),
    SIGNAL_INDEX(tip_deflection), SIGNAL_INDEX(root_strain)};

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
            f, STATUS_BAD_ARGUMENT, t->headings_line, 1,
            "%.300s:%d:1: there is no column 'command', the voltage [V] with "
            "which each trial run is driven: record it, or rename its heading",
            t->file, t->headings_line);
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

// Refuses a trace of which many rows, the first of them in a line, have the same times as
// others.
static status check_stamps(const recorded_trace *t, size_t alike, int line, fault *f)
{
    FAULT_IF(alike > t->rows / ROWS_FOR_ONE_BAD, f, STATUS_BAD_ARGUMENT,
             "%.300s:%d: by their times %zu of %zu rows belong to the sample of the row "
             "above and yet differ from it, expected times that tell samples apart",
             t->file, line, alike, t->rows);
    return STATUS_OK;
}

// Keeps one row for each sample: of several, which repeat what the rig holds, the last
// one's values. Time then counts from the first sample, by the rig's clock where the
// recorder's differs from that by its error only. lines[rows] of the rows in the file.
static status keep_samples(recorded_trace *t, const int *lines, double usual_rate,
                           fault *f)
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
    int line = 0;
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
        if (changes && sample_changed && alike++ == 0) {
            line = lines[i];
        }
        sample_changed = sample_changed || changes;
        last = number;
        put_row(t, i, kept - 1, first);
    }
    TRY(check_stamps(t, alike, line, f));
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
    const double noise =
        identify_deviation(&p->sensor, CHANNEL_TACHOMETER, &range, &dithered);
    t->fits_velocity = p->initial.velocity != 0;
    if (fabs(speed - p->initial.velocity) > IDENTIFY_NEAR * noise) {
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
            f, STATUS_BAD_ARGUMENT, table->headings_line, 1,
            "%.300s:%d: no reading to compare with, expected a column such as "
            "encoder[rad], tachometer[rad/s] or force_reading[N]",
            t->file, table->headings_line);
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

// Checks that the samples, the first of them in a line, came at a rate that a rig can
// have.
static status check_rate(const recorded_trace *t, int line, fault *f)
{
    const parameter_info *rate = &parameter_table[PARAMETER_INDEX(control.rate)];
    if (!(t->time[t->rows - 1] > t->time[0])) {
        return fault_set_place(f, STATUS_BAD_ARGUMENT, line, 1,
                               "%.300s:%d: no time passes from the first row to the last",
                               t->file, line);
    }
    const double mean = (double)(t->rows - 1) / (t->time[t->rows - 1] - t->time[0]);
    if (mean >= LEAST_RATE && mean <= rate->maximum) {
        return STATUS_OK;
    }
    return fault_set_place(f, STATUS_BAD_ARGUMENT, line, 1,
                           "%.300s:%d: by their times %zu rows take %.4g s, expected %g "
                           "to %g rows a second, with times in s or their unit in the "
                           "heading, such as time[ms]",
                           t->file, line, t->rows, t->time[t->rows - 1] - t->time[0],
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
    TRY(check_rate(t, table.lines[0], f));
    TRY(keep_samples(t, table.lines, p->control.rate, f));
    guess_start(t, p);
    return identify_weigh(t, p, f);
}
