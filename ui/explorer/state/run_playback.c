#include "ui/explorer/state/run_playback.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "render/scene/film.h"
#include "src/base/text_stream.h"

// --- playing ---------------------------------------------------------------------------

#define APART 0.05 // of the run, between impacts that are slowed down each for itself

double playback_slowness(const playback *p, const trace *t, double duration, double time)
{
    assert(duration > 0);
    double most = 1, last = -duration;
    for (size_t i = 0; i < t->event_count && p->slow > 1; i++) {
        const event *e = &t->events[i];
        if (e->kind != EVENT_IMPACT) {
            continue;
        }
        const film_clock c = film_clock_round(0, duration, e->time, p->slow);
        const double here =
            e->time - last > APART * duration ? film_clock_slowness(&c, time) : 1;
        if (here > most) {
            most = here;
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
    double wanted = p->speed;

    // from the far end, so that the nearest one beyond the present speed stays
    for (int i = 0; i < count; i++) {
        const double next = speeds[direction > 0 ? count - 1 - i : i];
        const bool beyond =
            direction > 0 ? next > p->speed * 1.001 : next < p->speed * 0.999;
        if (beyond) {
            wanted = next;
        }
    }
    return wanted;
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
        const size_t more = log->capacity ? 2 * log->capacity : 64;
        log_entry *grown = realloc(log->entries, more * sizeof *grown);
        loss_unless(grown != NULL);
        if (grown != NULL) {
            log->entries = grown;
        }
        if (grown != NULL) {
            log->capacity = more;
        }
    }
    if (log->count < log->capacity) {
        log->entries[log->count++] = entry;
    }
}

// The events up to a time.
static void add_events(run_log *log, const trace *t, double until)
{
    for (; log->events < t->event_count && t->events[log->events].time <= until;
         log->events++) {
        add_entry(log, (log_entry){t->events[log->events].time, (int)log->events, 0});
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
        const double mode =
            isfinite(row->controller_mode) ? row->controller_mode : log->mode;
        add_events(log, t, row->time);
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
    // from the far end, so that the nearest one beyond the instant stays
    double found = -1;
    for (size_t i = 0; i < log->count; i++) {
        const double at = log->entries[direction > 0 ? log->count - 1 - i : i].time;
        if (direction > 0) {
            if (at > time) {
                found = at;
            }
        } else if (at < time) {
            found = at;
        }
    }
    return found;
}

void run_log_forget(run_log *log)
{
    free(log->entries);
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
