#include "ui/explorer/panels/plot_axes.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "render/plot/ticks.h"

// A tick's value with no more digits than the axis needs, its power of ten behind.
static void axis_label(const ticks *t, int index, char *text, size_t size)
{
    int used = snprintf(text, size, "%.*f", t->decimals, t->value[index] / pow(10, t->exponent));
    if (t->exponent != 0 && t->value[index] != 0 && used > 0 && (size_t)used < size) {
        snprintf(text + used, size - (size_t)used, "e%d", t->exponent);
    }
}

// Whether a tick is rather labelled than another one in the same row: zero, else the outer one.
static bool outranks(double value, double other, bool upper_half)
{
    return other != 0 && (value == 0 || (upper_half ? value > other : value < other));
}

// The row of an axis at which a value lies.
static long row_of(value_range axis, int height, double value)
{
    return lround((axis.high - value) / (axis.high - axis.low) * (4.0 * height - 1)) / 4;
}

// Whether each tick has a row of its own.
static bool have_rows(const ticks *t, value_range axis, int height)
{
    for (int i = 1; i < t->count; i++) {
        if (row_of(axis, height, t->value[i]) == row_of(axis, height, t->value[i - 1])) {
            return false;
        }
    }
    return true;
}

void draw_value_axis(screen *s, area a, value_range axis)
{
    assert(s != NULL && axis.high > axis.low);
    const double low = axis.low, high = axis.high;
    ticks t;

    // as many as have a row each: one that is left out would make the others look uneven
    for (int wanted = a.height >= 12 ? 5 : a.height >= 6 ? 4 : 3; wanted > 1; wanted--) {
        ticks_between(&t, low, high, wanted);
        if (have_rows(&t, axis, a.height)) {
            break;
        }
    }
    for (int y = 0; y < a.height; y++) {
        int best = -1;
        for (int i = 0; i < t.count; i++) {
            bool better = best < 0 || outranks(t.value[i], t.value[best], 2 * y < a.height);
            best = row_of(axis, a.height, t.value[i]) == y && better ? i : best;
        }
        screen_put(s, a.x + a.width - 1, a.y + y, best < 0 ? 0x2502 : 0x2524, INK_FRAME);
        if (best >= 0) {
            char text[TICK_TEXT + 8];
            axis_label(&t, best, text, sizeof text);
            screen_print(s, a.x, a.y + y, a.width - 1, INK_DIM, "%*s", a.width - 1, text);
        }
    }
}

// Seconds below round instants, the unit behind the last one.
static void draw_instants(screen *s, area a, double from, double to)
{
    ticks t;
    int free = a.x;
    ticks_between(&t, from, to, a.width / 14 < 2 ? 2 : a.width / 14);

    // each tick with its label below, unless that would touch the one before
    for (int i = 0; i < t.count; i++) {
        char text[TICK_TEXT + 16];
        double share = (t.value[i] - from) / (to - from);
        int x = a.x + (int)(share * (2.0 * a.width - 1) / 2);
        axis_label(&t, i, text, sizeof text);
        if (i == t.count - 1) {
            strcat(text, " s");
        }

        // kept within the axis
        int length = (int)strlen(text), start = x - length / 2;
        start = start + length > a.x + a.width ? a.x + a.width - length : start;
        start = start < a.x ? a.x : start;

        // a tick on the line, where no bar is
        if (s->width > x && x < a.x + a.width) {
            cell *at = &s->cells[(long)a.y * s->width + x];
            at->glyph = at->glyph == 0x2500 ? 0x252c : at->glyph;
        }
        if (start >= free) {
            screen_text(s, start, a.y + 1, a.x + a.width - start, INK_DIM, text);
            free = start + length + 1;
        }
    }
}

area draw_time_axis(const explorer_state *st, screen *s, area a)
{
    assert(st != NULL && s != NULL);
    const session *e = &st->session;
    const trace *t = &e->run.trace;
    double from, to;
    state_window(st, &from, &to);
    area line = {a.x + LABEL_WIDTH + 1, a.y, a.width - LABEL_WIDTH - 1, 1};

    // contact as a bar
    for (int i = 0; i < line.width; i++) {
        double time = from + (to - from) * (i + 0.5) / line.width;
        bool touches = time <= e->seen && t->rows[trace_row_at(t, time)].contact != 0;
        screen_put(s, line.x + i, a.y, touches ? 0x2592 : 0x2500, touches ? INK_FORCE : INK_FRAME);
    }

    // a touch that is shorter than a column
    for (size_t i = 0; i < t->event_count && t->events[i].time <= e->seen; i++) {
        const double at = (t->events[i].time - from) / (to - from) * line.width;
        if (t->events[i].kind == EVENT_CONTACT && at >= 0 && at < line.width) {
            screen_put(s, line.x + (int)at, a.y, 0x2592, INK_FORCE);
        }
    }
    draw_instants(s, line, from, to);

    // impacts and inputs that have been seen
    for (size_t i = 0; i < t->event_count; i++) {
        const event *v = &t->events[i];
        double at = (v->time - from) / (to - from) * line.width;
        bool impact = v->kind == EVENT_IMPACT;
        bool input = v->kind == EVENT_CHANGE || v->kind == EVENT_PUSH;
        bool seen = v->time <= e->seen;

        // the coming motion is not known yet, but coming changes are
        if (at >= 0 && at < line.width && ((impact && seen) || input)) {
            screen_put(s, line.x + (int)at, a.y,
                       impact ? 0x25b2
                       : seen ? 0x25cf
                              : 0x25cb,
                       seen ? INK_EVENT : INK_DIM);
        }
    }

    // the meaning of the marks, next to them
    screen_text(s, a.x, a.y, LABEL_WIDTH, INK_FORCE, "\u2592 contact");
    screen_text(s, a.x, a.y + 1, LABEL_WIDTH, INK_EVENT, "\u25b2 impact");
    return (area){line.x, a.y, line.width, 2};
}
