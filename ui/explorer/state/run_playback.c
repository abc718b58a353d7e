#include "ui/explorer/state/run_playback.h"

#include <assert.h>
#include <glib.h>
#include <math.h>
#include <stdio.h>

#include "render/scene/film.h"

// --- playing ---------------------------------------------------------------------------

#define APART 0.05 // of the run, between impacts that are slowed down each for itself

double playback_slowness(const playback *p, const trace *t, double duration, double time)
{
    assert(duration > 0);
    if (p->slow <= 1) {
        return 1;
    }

    // the most that any impact asks for which follows an interval without one
    double most = 1, last = -duration;
    for (size_t i = 0; i < t->event_count; i++) {
        const event *e = &t->events[i];
        if (e->kind != EVENT_IMPACT) {
            continue;
        }
        if (e->time - last > APART * duration) {
            const film_clock c = film_clock_round(0, duration, e->time, p->slow);
            most = fmax(most, film_clock_slowness(&c, time));
        }
        last = e->time;
    }
    return most;
}

double playback_next_speed(const playback *p, int direction)
{
    static const double speeds[] = {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2,
                                    0.5,   1,     2,     5,    10,   20,   50,  100};
    const int count = sizeof speeds / sizeof speeds[0];
    if (direction > 0) {
        for (int i = 0; i < count; i++) {
            if (speeds[i] > p->speed * 1.001) {
                return speeds[i];
            }
        }
    } else {
        for (int i = count - 1; i >= 0; i--) {
            if (speeds[i] < p->speed * 0.999) {
                return speeds[i];
            }
        }
    }
    return p->speed;
}

// --- the tip that is pulled ------------------------------------------------------------

plane_vector stage_place(const arm_stage *g, int x, int y)
{
    assert(g->width > 0 && g->across > 0 && g->up > 0);
    return (plane_vector){g->left + (x - g->x + 0.5) / g->across,
                          g->bottom + (g->y + g->height - y - 0.5) / g->up};
}

void stage_cell(const arm_stage *g, plane_vector place, int *x, int *y)
{
    assert(g->width > 0);
    *x = g->x + (int)floor((place.x - g->left) * g->across);
    *y = g->y + g->height - 1 - (int)floor((place.y - g->bottom) * g->up);
}

void recorded_tip(const trace *t, const arm_parameters *beam, size_t row,
                  plane_vector *tip, plane_vector *across)
{
    double lengths[PARAMETER_LINKS_MOST];
    parameters_link_lengths(beam, lengths);
    assert(row < t->row_count);
    const size_t links = (size_t)beam->links;
    const double *angles = t->angles + (row + 1) * (size_t)t->angle_count - links;
    *tip = (plane_vector){0};
    for (size_t i = 0; i < links; i++) {
        tip->x += lengths[i] * cos(angles[i]);
        tip->y += lengths[i] * sin(angles[i]);
    }
    *across = (plane_vector){-sin(angles[links - 1]), cos(angles[links - 1])};
}

double pull_force(const tip_pull *p, plane_vector tip, plane_vector across)
{
    return PULL_STIFFNESS * ((p->x - tip.x) * across.x + (p->y - tip.y) * across.y);
}

// --- the log ---------------------------------------------------------------------------

static void add_entry(run_log *log, log_entry entry)
{
    if (log->count == log->capacity) {
        log->capacity = log->capacity > 0 ? 2 * log->capacity : 64;
        log->entries = g_renew(log_entry, log->entries, log->capacity);
    }
    log->entries[log->count++] = entry;
}

// The events up to a time.
static void add_events(run_log *log, const trace *t, double until)
{
    while (log->events < t->event_count && t->events[log->events].time <= until) {
        const double time = t->events[log->events].time;
        add_entry(log, (log_entry){.time = time, .event = (int)log->events});
        log->events++;
    }
}

void run_log_update(run_log *log, unsigned long run, const trace *t, bool complete)
{
    assert(run != 0);
    if (log->run != run) {
        run_log_forget(log);
        log->run = run;
        log->mode = (double)NAN;
    }

    // a run that is being computed grows: continue from the rows that were read before
    for (; log->rows < t->row_count; log->rows++) {
        const sample *row = &t->rows[log->rows];

        // an event at an instant comes before the resulting mode
        add_events(log, t, row->time);
        const double mode = row->controller_mode;
        if (!isfinite(mode)) {
            continue;
        }
        if (isfinite(log->mode) && mode != log->mode) {
            add_entry(log, (log_entry){row->time, -1, mode});
        }
        log->mode = mode;
    }
    if (complete) {
        add_events(log, t, (double)INFINITY);
    }
}

double run_log_next(const run_log *log, double time, int direction)
{
    if (direction > 0) {
        for (size_t i = 0; i < log->count; i++) {
            if (log->entries[i].time > time) {
                return log->entries[i].time;
            }
        }
    } else {
        for (size_t i = log->count; i-- > 0;) {
            if (log->entries[i].time < time) {
                return log->entries[i].time;
            }
        }
    }
    return -1;
}

void run_log_forget(run_log *log)
{
    g_free(log->entries);
    *log = (run_log){0};
}

// --- modes of the control law ----------------------------------------------------------

void law_mode_name(const law_modes *m, double mode, char *text, size_t size)
{
    if (mode >= 0 && mode < m->count) {
        snprintf(text, size, "%s", m->names[(int)mode]);
    } else {
        snprintf(text, size, "mode %g", mode);
    }
}
