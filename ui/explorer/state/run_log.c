#include "ui/explorer/state/run_log.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "src/base/text_stream.h"

static void add_entry(run_log *log, log_entry entry)
{
    if (log->count == log->capacity) {
        size_t more = log->capacity ? 2 * log->capacity : 64;
        log_entry *grown = realloc(log->entries, more * sizeof *grown);
        loss_unless(grown != NULL);
        if (grown == NULL) {
            return;
        }
        log->entries = grown;
        log->capacity = more;
    }
    log->entries[log->count++] = entry;
}

// The events up to a time.
static void add_events(run_log *log, const trace *t, double until)
{
    for (; log->events < t->event_count && t->events[log->events].time <= until; log->events++) {
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
        add_events(log, t, row->time);
        if (isfinite(log->mode) && isfinite(row->controller_mode) &&
            row->controller_mode != log->mode) {
            add_entry(log, (log_entry){row->time, -1, row->controller_mode});
        }
        log->mode = isfinite(row->controller_mode) ? row->controller_mode : log->mode;
    }
    if (complete) {
        add_events(log, t, (double)INFINITY);
    }
}

double run_log_next(const run_log *log, double time, int direction)
{
    double found = -1;
    for (size_t i = 0; i < log->count; i++) {
        double at = log->entries[i].time;
        if (direction > 0 && at > time) {
            return at;
        }
        if (direction < 0 && at < time) {
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

// --- modes of the control law -----------------------------------------------------------------

void law_mode_name(const law_modes *m, double mode, char *text, size_t size)
{
    if (mode >= 0 && mode < m->count) {
        snprintf(text, size, "%s", m->names[(int)mode]);
    } else {
        snprintf(text, size, "mode %g", mode);
    }
}
