#include "src/run/trace.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/instant.h"

#define EVENT_TEXTS(name, word, description) {word, description},
static const struct {
    const char *word, *description;
} event_texts[] = {EVENT_KINDS(EVENT_TEXTS)};
#undef EVENT_TEXTS

const char *event_name(event_kind kind)
{
    return event_texts[kind].word;
}

const char *event_description(int kind)
{
    const int count = (int)(sizeof event_texts / sizeof event_texts[0]);
    if (kind >= 0 && kind < count) {
        return event_texts[kind].description;
    }
    return NULL;
}

// Updates the addresses of the trace's four arrays, which may move as they grow.
static void update_addresses(trace *t)
{
    t->rows = t->arrays[TRACE_ROWS].base;
    t->velocities = t->arrays[TRACE_VELOCITIES].base;
    t->angles = t->arrays[TRACE_ANGLES].base;
    t->events = t->arrays[TRACE_EVENTS].base;
}

void trace_init(trace *t, int angle_count)
{
    assert(angle_count >= 0);
    const size_t angles = (angle_count > 0 ? (size_t)angle_count : 1) * sizeof(double);
    const size_t sizes[TRACE_ARRAYS] = {sizeof(sample), angles, angles, sizeof(event)};
    *t = (trace){.angle_count = angle_count};
    for (int i = 0; i < TRACE_ARRAYS; i++) {
        shared_array_init(&t->arrays[i], sizes[i]);
    }
}

status trace_reserve(trace *t, int angle_count, size_t least, size_t most)
{
    // address space for each array
    bool room = true;
    trace_init(t, angle_count);
    for (int i = 0; i < TRACE_ARRAYS && room; i++) {
        room = shared_array_reserve(&t->arrays[i], t->arrays[i].size, least, most);
    }
    if (!room) {
        trace_finish(t);
        return STATUS_NO_MEMORY;
    }
    update_addresses(t);
    return STATUS_OK;
}

void trace_finish(trace *t)
{
    for (int i = 0; i < TRACE_ARRAYS; i++) {
        shared_array_finish(&t->arrays[i]);
    }
    memset(t, 0, sizeof *t);
}

status trace_share(trace *t, const trace *from, size_t rows, size_t events)
{
    assert(t->row_count == 0);
    assert(rows <= from->row_count && events <= from->event_count);
    for (int i = 0; i < TRACE_ARRAYS; i++) {
        const size_t count = i == TRACE_EVENTS ? events : rows;
        if (!shared_array_share(&t->arrays[i], &from->arrays[i], count)) {
            return STATUS_NO_MEMORY;
        }
    }
    update_addresses(t);
    t->row_count = rows;
    t->event_count = events;
    return STATUS_OK;
}

bool trace_expect(trace *t, size_t rows)
{
    bool grown = true; // the angles come last: if they have room, so have the velocities
    for (int i = 0; i < TRACE_EVENTS && grown; i++) {
        grown = shared_array_grow(&t->arrays[i], rows);
    }
    if (t->arrays[TRACE_ROWS].reserved == 0) {
        update_addresses(t);
    }
    return grown;
}

sample *trace_next_row(trace *t)
{
    const bool full = t->row_count >= t->arrays[TRACE_ROWS].capacity ||
                      t->row_count >= t->arrays[TRACE_ANGLES].capacity;
    if (full && !trace_expect(t, t->row_count + 1)) {
        return NULL;
    }
    return &t->rows[t->row_count];
}

status trace_add_row(trace *t, const sample *row, const double *angles,
                     const double *velocities)
{
    const size_t n = (size_t)t->angle_count;
    sample *place = trace_next_row(t);
    if (place == NULL) {
        return STATUS_NO_MEMORY;
    }

    // the row, and the angles and velocities of all links
    if (row != place) {
        *place = *row;
    }
    double *to_angles = t->angles + t->row_count * n,
           *to_rates = t->velocities + t->row_count * n;
    for (size_t i = 0; i < n; i++) {
        to_angles[i] = angles[i];
        to_rates[i] = velocities[i];
    }
    t->row_count++;
    return STATUS_OK;
}

void trace_keep_last_row(trace *t)
{
    if (t->row_count <= 1) {
        return;
    }

    const size_t n = (size_t)t->angle_count, last = t->row_count - 1;
    t->rows[0] = t->rows[last];
    memcpy(t->angles, t->angles + last * n, n * sizeof *t->angles);
    memcpy(t->velocities, t->velocities + last * n, n * sizeof *t->velocities);
    t->row_count = 1;
}

status trace_add_event(trace *t, event e)
{
    shared_array *events = &t->arrays[TRACE_EVENTS];
    if (!shared_array_grow(events, t->event_count + 1)) {
        return STATUS_NO_MEMORY;
    }
    t->events = events->base;
    t->events[t->event_count++] = e;
    return STATUS_OK;
}

shared_array trace_take_events(trace *t)
{
    const shared_array taken = t->arrays[TRACE_EVENTS];
    shared_array_init(&t->arrays[TRACE_EVENTS], sizeof(event));
    t->events = NULL;
    t->event_count = 0;
    return taken;
}

void trace_give_events(trace *t, shared_array *storage)
{
    if (t->event_count > 0) {
        return;
    }
    shared_array_finish(&t->arrays[TRACE_EVENTS]);
    t->arrays[TRACE_EVENTS] = *storage;
    t->events = storage->base;
    shared_array_init(storage, sizeof(event));
}

size_t trace_rows_until(const trace *t, double time)
{
    assert(!isnan(time));
    size_t low = 0, high = t->row_count; // the first row after `time` lies in [low, high]
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (t->rows[middle].time <= time) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

size_t trace_row_at(const trace *t, double time)
{
    size_t until = trace_rows_until(t, time);
    if (until > 0) {
        return until - 1;
    }
    return 0;
}

size_t trace_side(const trace *t, size_t row)
{
    const double time = t->rows[row].time;
    size_t last = row;
    while (last + 1 < t->row_count && same_instant(t->rows[last + 1].time, time)) {
        last++;
    }
    const bool first = row == 0 || !same_instant(t->rows[row - 1].time, time);
    if (first && last > row) {
        return SIZE_MAX;
    }
    return last - row;
}

size_t trace_row_on_side(const trace *t, double time, size_t side)
{
    // the last row of the instant, then back among its rows
    size_t r = trace_row_at(t, time);
    while (r + 1 < t->row_count && same_instant(t->rows[r + 1].time, time)) {
        r++;
    }
    for (; side > 0 && r > 0 && same_instant(t->rows[r - 1].time, time); side--) {
        r--;
    }
    return r;
}

sample trace_between(const sample *a, const sample *b, double time)
{
    assert(a->time < b->time);
    sample value = *a;

    // a sample is a row of numbers
    const double share = (time - a->time) / (b->time - a->time);
    const double *from = (const double *)a, *to = (const double *)b;
    for (int i = 0; i < SIGNALS_AT_MOST; i++) {
        if (!signal_is_state(i)) {
            ((double *)&value)[i] = from[i] + share * (to[i] - from[i]);
        }
    }
    value.time = time;
    value.impulse = 0;
    return value;
}

sample trace_sample_at(const trace *t, double time, size_t side)
{
    const size_t r = trace_row_on_side(t, time, side);
    const sample *a = &t->rows[r];
    if (same_instant(a->time, time) || time < a->time || r + 1 >= t->row_count) {
        return *a;
    }
    return trace_between(a, &t->rows[r + 1], time);
}

bool trace_has(const trace *t, int signal)
{
    for (size_t i = 0; i < t->row_count; i++) {
        if (isfinite(signal_value(&t->rows[i], signal))) {
            return true;
        }
    }
    return false;
}

// --- statistics ------------------------------------------------------------------------

// Adds a piece of a signal, of this width [s] and straight from a to b, to the
// statistics: its integral is (a + b) / 2 and that of its square (a^2 + a b + b^2) / 3,
// times the width. A piece without a value is left out.
static void add_piece(signal_statistics *s, double *squares, double width, double a,
                      double b)
{
    if (!isfinite(a) || !isfinite(b)) {
        return;
    }
    s->minimum = fmin(s->minimum, fmin(a, b));
    s->maximum = fmax(s->maximum, fmax(a, b));
    s->duration += width;
    s->integral += width * (a + b) / 2;
    *squares += width * (a * a + a * b + b * b) / 3;
}

signal_statistics trace_statistics(const trace *t, int signal, double from, double to)
{
    assert(t->row_count > 0 && signal >= 0 && from <= to);
    signal_statistics s = {.minimum = HUGE_VAL, .maximum = -HUGE_VAL};
    double squares = 0;
    const double end = t->rows[t->row_count - 1].time;
    from = fmax(t->rows[0].time, fmin(from, end));
    to = fmax(from, fmin(to, end));

    // the pieces between rows, of which the first and the last are cut
    size_t r = trace_row_at(t, from);
    for (; r + 1 < t->row_count && t->rows[r].time <= to; r++) {
        const double t0 = t->rows[r].time, t1 = t->rows[r + 1].time;
        if (t0 == t1) {
            continue; // both sides of an event
        }
        const double v0 = signal_value(&t->rows[r], signal);
        const double v1 = signal_value(&t->rows[r + 1], signal);
        const double begin = fmax(t0, from), stop = fmin(t1, to);
        const double slope = (v1 - v0) / (t1 - t0);
        const double a = v0 + slope * (begin - t0);
        const double b = stop < t1 ? v0 + slope * (stop - t0) : v1;
        add_piece(&s, &squares, stop - begin, a, b);
    }

    // without a piece that has a value, that of the row itself, if it has one
    if (isinf(s.minimum)) {
        const double value = signal_value(&t->rows[trace_row_at(t, from)], signal);
        add_piece(&s, &squares, 0, value, value);
    }
    if (isinf(s.minimum)) {
        const double none = (double)NAN;
        return (signal_statistics){none, none, none, none, none, 0};
    }

    // means over the duration; of an instant, the value itself
    if (s.duration > 0) {
        s.mean = s.integral / s.duration;
    } else {
        s.mean = s.minimum;
    }
    if (s.duration > 0) {
        s.rms = sqrt(squares / s.duration);
    } else {
        s.rms = fabs(s.minimum);
    }
    return s;
}

// --- recorded tables ---

// Marks the first of some rows, and of each column those with the least and the largest
// value.
static void mark_extremes(double *const columns[SIGNALS_AT_MOST], size_t first,
                          size_t rows, bool *kept)
{
    memset(kept, 0, rows * sizeof *kept);
    kept[0] = true;
    for (int i = 1; i < SIGNALS_AT_MOST; i++) {
        size_t least = 0, largest = 0;
        for (size_t k = 1; k < rows && columns[i] != NULL; k++) {
            const double value = columns[i][first + k];
            if (!(columns[i][first + least] <= value)) {
                least = k;
            }
            if (!(columns[i][first + largest] >= value)) {
                largest = k;
            }
        }
        kept[least] = kept[largest] = true;
    }
}

// Appends the rows of a table's columns, or about `most` of them (0: all).
static status add_measured(trace *t, double *const columns[SIGNALS_AT_MOST], size_t rows,
                           size_t most)
{
    enum { MOST_GROUP = 4096 };
    static const double none[1] = {0};
    bool kept[MOST_GROUP];
    size_t marks = 1, group = 1;
    for (int i = 1; i < SIGNALS_AT_MOST; i++) {
        marks += columns[i] != NULL ? 2 : 0;
    }
    if (most > 0 && rows > most) {
        group = marks * rows / most + 1;
    }
    if (group > MOST_GROUP) {
        group = MOST_GROUP;
    }

    for (size_t r = 0; r < rows; r++) {
        if (r % group == 0) {
            const size_t left = rows - r;
            mark_extremes(columns, r, left < group ? left : group, kept);
        }
        if (!kept[r % group]) {
            continue;
        }

        // a signal without a column has no value
        double row[SIGNALS_AT_MOST];
        sample measured;
        for (int i = 0; i < SIGNALS_AT_MOST; i++) {
            if (columns[i] != NULL) {
                row[i] = columns[i][r];
            } else {
                row[i] = (double)NAN;
            }
        }
        memcpy(&measured, row, sizeof measured);
        TRY(trace_add_row(t, &measured, none, none));
    }
    return STATUS_OK;
}

// How many numbers some columns have besides the times.
static size_t count_numbers(double *const columns[SIGNALS_AT_MOST], size_t rows)
{
    size_t numbers = 0;
    for (int i = 1; i < SIGNALS_AT_MOST; i++) {
        for (size_t r = 0; r < rows && columns[i] != NULL; r++) {
            if (isfinite(columns[i][r])) {
                numbers++;
            }
        }
    }
    return numbers;
}

status measured_rows(trace *t, csv_table *table, double rate, const char *column,
                     int signal, size_t most, fault *f)
{
    assert(signal < signal_count);

    // the table's columns of time and of the signals it has
    double *columns[SIGNALS_AT_MOST] = {NULL};
    sample_clock clock;
    status code = csv_table_times(table, NULL, rate, &clock, &columns[0], f);
    for (int i = 1; i < signal_count && code == STATUS_OK; i++) {
        const char *heading;
        if (column == NULL) {
            heading = signal_table[i].name;
        } else if (i == signal) {
            heading = column;
        } else {
            heading = NULL;
        }
        if (heading != NULL && csv_table_find(table, heading) >= 0) {
            code = csv_table_numbers(table, heading, signal_table[i].unit, GAPS_MISSING,
                                     &columns[i], f);
        }
    }

    size_t numbers = 0;
    if (code == STATUS_OK) {
        numbers = count_numbers(columns, table->rows);
        code = add_measured(t, columns, table->rows, most);
    }
    for (int i = 0; i < SIGNALS_AT_MOST; i++) {
        free(columns[i]);
    }
    FAULT_IF(code == STATUS_OK && numbers == 0, f, STATUS_BAD_ARGUMENT,
             "%.200s:%d: expected a heading with time[s] and at least one recorded "
             "signal, such as force[N], and a number in a row below it",
             table->file, table->headings_line);
    if (code == STATUS_NO_MEMORY) {
        return fault_no_memory(f);
    }
    return code;
}
