#include "src/run/trace.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define EVENT_WORD(name, word, description) word,
static const char *const event_words[] = {EVENT_KINDS(EVENT_WORD)};
#undef EVENT_WORD

#define EVENT_DESCRIPTION(name, word, description) description,
static const char *const event_descriptions[] = {EVENT_KINDS(EVENT_DESCRIPTION)};
#undef EVENT_DESCRIPTION

const char *event_name(event_kind kind)
{
    return event_words[kind];
}

const char *event_description(int kind)
{
    const int count = (int)(sizeof event_descriptions / sizeof event_descriptions[0]);
    return kind >= 0 && kind < count ? event_descriptions[kind] : NULL;
}

static size_t angles_size(int angle_count)
{
    return (angle_count > 0 ? (size_t)angle_count : 1) * sizeof(double);
}

// Plain arrays move as they grow: where the four lie now.
static void find_places(trace *t)
{
    t->rows = t->row_array.base;
    t->angles = t->angle_array.base;
    t->velocities = t->velocity_array.base;
    t->events = t->event_array.base;
}

void trace_init(trace *t, int angle_count)
{
    assert(angle_count >= 0);
    memset(t, 0, sizeof *t);
    t->angle_count = angle_count;
    shared_array_init(&t->row_array, sizeof(sample));
    shared_array_init(&t->angle_array, angles_size(angle_count));
    shared_array_init(&t->velocity_array, angles_size(angle_count));
    shared_array_init(&t->event_array, sizeof(event));
}

status trace_reserve(trace *t, int angle_count, size_t least, size_t most)
{
    assert(angle_count >= 0);
    memset(t, 0, sizeof *t);
    t->angle_count = angle_count;
    bool reserved =
        shared_array_reserve(&t->row_array, sizeof(sample), least, most) &&
        shared_array_reserve(&t->angle_array, angles_size(angle_count), least, most) &&
        shared_array_reserve(&t->velocity_array, angles_size(angle_count), least, most) &&
        shared_array_reserve(&t->event_array, sizeof(event), least, most);
    if (!reserved) {
        trace_finish(t);
        return STATUS_NO_MEMORY;
    }

    find_places(t);
    return STATUS_OK;
}

void trace_finish(trace *t)
{
    shared_array_finish(&t->row_array);
    shared_array_finish(&t->angle_array);
    shared_array_finish(&t->velocity_array);
    shared_array_finish(&t->event_array);
    memset(t, 0, sizeof *t);
}

status trace_share(trace *t, const trace *from, size_t rows, size_t events)
{
    assert(t->row_count == 0);
    assert(rows <= from->row_count && events <= from->event_count);
    if (!shared_array_share(&t->row_array, &from->row_array, rows) ||
        !shared_array_share(&t->angle_array, &from->angle_array, rows) ||
        !shared_array_share(&t->velocity_array, &from->velocity_array, rows) ||
        !shared_array_share(&t->event_array, &from->event_array, events)) {
        return STATUS_NO_MEMORY;
    }
    t->row_count = rows;
    t->event_count = events;
    return STATUS_OK;
}

status trace_copy(trace *t, const trace *from)
{
    const size_t angles = from->row_count * (size_t)from->angle_count * sizeof *from->angles;
    trace_init(t, from->angle_count);
    if (!shared_array_grow(&t->row_array, from->row_count + 1) ||
        !shared_array_grow(&t->angle_array, from->row_count + 1) ||
        !shared_array_grow(&t->velocity_array, from->row_count + 1) ||
        !shared_array_grow(&t->event_array, from->event_count + 1)) {
        trace_finish(t);
        return STATUS_NO_MEMORY;
    }

    find_places(t);
    if (from->row_count > 0) {
        memcpy(t->rows, from->rows, from->row_count * sizeof *from->rows);
        memcpy(t->angles, from->angles, angles);
        memcpy(t->velocities, from->velocities, angles);
    }
    if (from->event_count > 0) {
        memcpy(t->events, from->events, from->event_count * sizeof *from->events);
    }
    t->row_count = from->row_count;
    t->event_count = from->event_count;
    return STATUS_OK;
}

// Room for so many rows; the places of plain arrays may change.
static bool make_room(trace *t, size_t rows)
{
    bool grown = shared_array_grow(&t->row_array, rows) &&
                 shared_array_grow(&t->velocity_array, rows) &&
                 shared_array_grow(&t->angle_array, rows); // last: the velocities have their room
    if (t->row_array.reserved == 0) {
        find_places(t);
    }
    return grown;
}

bool trace_expect(trace *t, size_t rows)
{
    return make_room(t, rows);
}

status trace_add_row(trace *t, const sample *row, const double *angles, const double *velocities)
{
    size_t n = (size_t)t->angle_count;
    bool full = t->row_count >= t->row_array.capacity || t->row_count >= t->angle_array.capacity;
    if (full && !make_room(t, t->row_count + 1)) {
        return STATUS_NO_MEMORY;
    }

    t->rows[t->row_count] = *row;
    double *to_angles = t->angles + t->row_count * n, *to_rates = t->velocities + t->row_count * n;
    for (size_t i = 0; i < n; i++) {
        to_angles[i] = angles[i];
        to_rates[i] = velocities[i];
    }
    t->row_count++;
    return STATUS_OK;
}

status trace_add_event(trace *t, event e)
{
    if (t->event_count >= t->event_array.capacity) {
        if (!shared_array_grow(&t->event_array, t->event_count + 1)) {
            return STATUS_NO_MEMORY;
        }
        if (t->event_array.reserved == 0) {
            find_places(t);
        }
    }
    t->events[t->event_count++] = e;
    return STATUS_OK;
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
    return until > 0 ? until - 1 : 0;
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

// --- statistics -------------------------------------------------------------------------------

// Takes a straight piece from one value to another into the sums.
static void add_piece(signal_statistics *s, double *squares, double width, double a, double b)
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

    // from row to row, the first and the last piece cut
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

    // at the end, or where pieces have no value, the row itself
    if (isinf(s.minimum)) {
        const double value = signal_value(&t->rows[trace_row_at(t, from)], signal);
        add_piece(&s, &squares, 0, value, value);
    }
    if (isinf(s.minimum)) {
        const double none = (double)NAN;
        return (signal_statistics){none, none, none, none, none, 0};
    }

    // of an instant the value itself
    s.mean = s.duration > 0 ? s.integral / s.duration : s.minimum;
    s.rms = s.duration > 0 ? sqrt(squares / s.duration) : fabs(s.minimum);
    return s;
}
