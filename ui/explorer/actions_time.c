// Actions on time: running, stepping, seeking.
#include "ui/explorer/actions.h"

#include <math.h>
#include <string.h>

bool act_play(lab *l, const char *argument)
{
    (void)argument;
    l->playing = !l->playing;
    l->message[0] = '\0';
    if (l->playing && l->session.now >= session_end(&l->session) &&
        session_go_on(&l->session, NULL) == STATUS_OK) {
        return true; // it was stopped there
    }
    bool at_end = l->session.now >= session_end(&l->session);
    if (l->playing && at_end && l->session.computing == NULL) {
        session_seek(&l->session, 0);
    }
    return true;
}

bool act_step(lab *l, const char *argument)
{
    double rows = 1;
    if (argument[0] != '\0' && !lab_take_number(l, argument, &rows)) {
        return false;
    }
    l->playing = false;
    session_step(&l->session, (long)fmax(-1e9, fmin(1e9, rows)));
    return true;
}

static void tell_event(lab *l)
{
    const lab_log *log = lab_run_log(l);
    const event *e = session_event(&l->session);
    char name[MODE_NAME_SIZE];
    if (e != NULL && e->kind == EVENT_IMPACT) {
        lab_say(l, false, "impact at %.6f s: %.4g N s at %.4g m/s, %.4g J lost", e->time,
                e->impulse, e->speed, e->loss);
        return;
    }
    if (e != NULL) {
        lab_say(l, false, "%s at %.6f s", event_name(e->kind), e->time);
        return;
    }
    for (size_t i = 0; i < log->count; i++) {
        if (log->entries[i].event < 0 && log->entries[i].time == l->session.now) {
            lab_mode_name(l, log->entries[i].mode, name, sizeof name);
            lab_say(l, false, "the controller goes into its mode '%s' at %.6f s", name,
                    l->session.now);
        }
    }
}

bool act_step_event(lab *l, const char *argument)
{
    bool back = argument[0] == '-';
    l->playing = false;
    if (!lab_step_log(l, back ? -1 : 1)) {
        lab_say(l, true, "no %s event", back ? "earlier" : "later");
        return false;
    }
    tell_event(l);
    return true;
}

// To the last row before a touch, where a prediction can be compared with what comes.
bool act_step_touch(lab *l, const char *argument)
{
    bool back = argument[0] == '-';
    const session *s = &l->session;
    const trace *t = &s->run.trace;
    size_t row = s->row, found = row;
    l->playing = false;
    for (size_t i = 0; i < t->event_count; i++) {
        const event *e = &t->events[i];
        if (e->kind != EVENT_IMPACT && e->kind != EVENT_CONTACT) {
            continue;
        }
        size_t before = trace_row_at(t, e->time);
        while (before > 0 && (t->rows[before].time >= e->time) && t->rows[before].contact != 0) {
            before--;
        }
        if (t->rows[before].contact == 0 && (back ? before < row : before > row)) {
            found = before;
            if (!back) {
                break;
            }
        }
    }
    if (found == row) {
        lab_say(l, true, "no %s touch", back ? "earlier" : "later");
        return false;
    }
    session_step(&l->session, (long)found - (long)row);
    lab_say(l, false, "just before a touch: what would come of it is predicted beside what came");
    return true;
}

bool act_seek(lab *l, const char *argument)
{
    double time = session_end(&l->session);
    if (strcmp(argument, "end") != 0 && !lab_take_number(l, argument, &time)) {
        return false;
    }
    l->playing = false;
    session_seek(&l->session, time);
    return true;
}

bool act_set_speed(lab *l, const char *argument)
{
    static const double steps[] = {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2,
                                   0.5,   1,     2,     5,    10,   20,   50,  100};
    const int count = sizeof steps / sizeof steps[0];
    double wanted = l->speed;
    if (strcmp(argument, "up") == 0) {
        for (int i = count; i-- > 0;) {
            wanted = steps[i] > l->speed * 1.001 ? steps[i] : wanted;
        }
    } else if (strcmp(argument, "down") == 0) {
        for (int i = 0; i < count; i++) {
            wanted = steps[i] < l->speed * 0.999 ? steps[i] : wanted;
        }
    } else if (!lab_take_number(l, argument, &wanted)) {
        return false;
    }
    if (!(wanted >= 1e-3 && wanted <= 1e4)) {
        lab_say(l, true, "the speed is a number from 0.001 to 10000, 1 is real time");
        return false;
    }
    l->speed = wanted;
    return true;
}

bool act_restart(lab *l, const char *argument)
{
    (void)argument;
    session_seek(&l->session, 0);
    l->session.seen = 0;
    l->playing = true;
    l->message[0] = '\0';
    return true;
}

bool act_wait_for(lab *l, const char *argument)
{
    double seconds;
    if (!lab_take_number(l, argument, &seconds)) {
        return false;
    }
    lab_advance(l, fmax(0, fmin(3600, seconds)));
    return true;
}
