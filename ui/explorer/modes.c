// The modes of the law that is on, by name, and the log: events of the run together with the
// controller's changes of mode.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/rig/rig.h"
#include "ui/explorer/lab.h"

bool lab_has_law(const lab *l)
{
    return l->session.effective.parameters.control.law != LAW_NONE;
}

const lab_modes *lab_law_modes(lab *l)
{
    lab_modes *m = &l->modes;
    if (m->version != l->session.version) {
        m->version = l->session.version;
        m->count =
            rig_mode_names(&l->session.effective.parameters, m->names, LAB_MODES, &m->lockable);
    }
    return m;
}

void lab_mode_name(lab *l, double mode, char *text, size_t size)
{
    const lab_modes *m = lab_law_modes(l);
    if (mode >= 0 && mode < m->count) {
        snprintf(text, size, "%s", m->names[(int)mode]);
    } else {
        snprintf(text, size, "mode %g", mode);
    }
}

// --- the log ----------------------------------------------------------------------------------

static bool add_entry(lab_log *log, log_entry entry)
{
    if (log->count == log->capacity) {
        size_t more = log->capacity ? 2 * log->capacity : 64;
        log_entry *grown = realloc(log->entries, more * sizeof *grown);
        if (grown == NULL) {
            return false;
        }
        log->entries = grown;
        log->capacity = more;
    }
    log->entries[log->count++] = entry;
    return true;
}

const lab_log *lab_run_log(lab *l)
{
    lab_log *log = &l->log;
    const session *e = &l->session;
    const trace *t = &e->run.trace;
    if (log->version != e->version) {
        lab_forget_log(l);
        log->version = e->version;
        log->mode = (double)NAN;
    }
    // a run that is being computed grows: go on where the last look ended
    for (; log->rows < t->row_count; log->rows++) {
        const sample *row = &t->rows[log->rows];
        // what happened at an instant stands before the mode that came of it
        for (; log->events < t->event_count && t->events[log->events].time <= row->time;
             log->events++) {
            add_entry(log, (log_entry){t->events[log->events].time, (int)log->events, 0});
        }
        if (isfinite(log->mode) && isfinite(row->controller_mode) &&
            row->controller_mode != log->mode) {
            add_entry(log, (log_entry){row->time, -1, row->controller_mode});
        }
        log->mode = isfinite(row->controller_mode) ? row->controller_mode : log->mode;
    }
    for (; e->computing == NULL && log->events < t->event_count; log->events++) {
        add_entry(log, (log_entry){t->events[log->events].time, (int)log->events, 0});
    }
    return log;
}

void lab_forget_log(lab *l)
{
    free(l->log.entries);
    l->log = (lab_log){0};
}

bool lab_step_log(lab *l, int direction)
{
    const lab_log *log = lab_run_log(l);
    double now = l->session.now, found = -1;
    for (size_t i = 0; i < log->count; i++) {
        double time = log->entries[i].time;
        if (direction > 0 && time > now) {
            found = time;
            break;
        }
        if (direction < 0 && time < now) {
            found = time;
        }
    }
    if (found >= 0) {
        session_seek(&l->session, found);
    }
    return found >= 0;
}
