// Actions on time: running, stepping, seeking.
#include "ui/explorer/actions/actions.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/instant.h"

enum { MOST_SLOW = 100 }; // how much slower impacts can be shown

action_result act_read_number(const char *text, double *value)
{
    assert(text != NULL && value != NULL);
    char *end;
    *value = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(*value)) {
        return result_refused("'%s' is no number", text);
    }
    return result_done();
}

action_result act_read_optional(const char *text, double *value)
{
    assert(text != NULL && value != NULL);
    return text[0] == '\0' ? result_done() : act_read_number(text, value);
}

void act_scrub(explorer_state *st, double time)
{
    assert(st != NULL && isfinite(time));
    st->playback.playing = false;
    session_forget_ghost(&st->session);
    session_seek(&st->session, time);
}

action_result act_advance(explorer_state *st, double seconds)
{
    assert(st != NULL);
    session *s = &st->session;
    playback *play = &st->playback;
    if (!play->playing || !(seconds > 0)) {
        play->measured = 0;
        return result_done();
    }

    // slower near impacts; a held tip is pulled meanwhile
    const double before = s->now, duration = s->effective.parameters.run.duration;
    play->slowed = playback_slowness(play, &s->run.trace, duration, before);
    const double next = before + seconds * play->speed / play->slowed;
    const action_result pulled = act_pull_until(st, next);
    if (!result_ok(&pulled)) {
        return pulled;
    }

    // the cursor waits at the end of what has been computed
    session_seek(s, next);
    playback_measure(play, s->now - before, seconds);
    if (s->now < session_end(s) || s->computing != NULL) {
        return result_done();
    }
    act_drop_pull(st);
    play->playing = false;
    if (s->run.summary.status != STATUS_OK || s->run.summary.inaccurate) {
        return act_tell_failed_run(st);
    }
    return result_news("end of the run: Space plays it again, x makes it longer, "
                       "n and N visit its events");
}

action_result act_play(explorer_state *st, const char *argument)
{
    (void)argument;
    session *s = &st->session;
    session_forget_ghost(s);
    st->playback.playing = !st->playback.playing;
    if (!st->playback.playing || s->now < session_end(s)) {
        return result_quiet();
    }

    // a run that was stopped there is computed on, a complete one begins again
    if (session_go_on(s, NULL) != STATUS_OK && s->computing == NULL) {
        session_seek(s, 0);
    }
    return result_quiet();
}

action_result act_step(explorer_state *st, const char *argument)
{
    double rows = 1;
    action_result read = act_read_optional(argument, &rows);
    if (!result_ok(&read)) {
        return read;
    }
    st->playback.playing = false;
    session_step(&st->session, (long)fmax(-1e9, fmin(1e9, rows)));
    return result_done();
}

// What happens at the cursor: an event of the run, else the controller's change of mode.
static action_result tell_event(explorer_state *st)
{
    const run_log *log = state_run_log(st);
    const event *e = session_event(&st->session);

    // an event with its numbers
    if (e != NULL && e->kind == EVENT_IMPACT) {
        return result_news("impact at %.6f s: %.4g N s at %.4g m/s, %.4g J lost", e->time,
                           e->impulse, e->speed, e->loss);
    }
    if (e != NULL) {
        return result_news("%s at %.6f s", event_name(e->kind), e->time);
    }

    // else it may be the instant of another mode
    for (size_t i = log->count; i-- > 0;) {
        const log_entry *entry = &log->entries[i];
        if (entry->event < 0 && entry->time == st->session.now) {
            char name[MODE_NAME_SIZE];
            law_mode_name(state_law_modes(st), entry->mode, name, sizeof name);
            return result_news("the controller goes into its mode '%s' at %.6f s", name,
                               entry->time);
        }
    }
    return result_done();
}

action_result act_step_event(explorer_state *st, const char *argument)
{
    bool back = argument[0] == '-';
    double time = run_log_next(state_run_log(st), st->session.now, back ? -1 : 1);
    st->playback.playing = false;
    if (time < 0) {
        return result_refused("no %s event", back ? "earlier" : "later");
    }
    session_seek(&st->session, time);
    return tell_event(st);
}

// To the last row before a touch, where a prediction can be compared with what comes.
action_result act_step_touch(explorer_state *st, const char *argument)
{
    bool back = argument[0] == '-';
    const session *s = &st->session;
    const trace *t = &s->run.trace;
    size_t row = s->row, found = row;
    st->playback.playing = false;

    // the free row before each contact, the nearest one in the direction wanted
    for (size_t i = 0; i < t->event_count; i++) {
        const event *e = &t->events[i];
        if (e->kind != EVENT_IMPACT && e->kind != EVENT_CONTACT) {
            continue;
        }
        size_t before = trace_row_at(t, e->time);
        while (before > 0 && (same_instant(t->rows[before - 1].time, e->time) ||
                              (t->rows[before].contact != 0 && t->rows[before].time >= e->time))) {
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
        return result_refused("no %s touch", back ? "earlier" : "later");
    }
    session_step(&st->session, (long)found - (long)row);
    return result_news("just before a touch: what would come of it is predicted beside what came");
}

action_result act_seek(explorer_state *st, const char *argument)
{
    double time = session_end(&st->session);
    if (strcmp(argument, "end") != 0) {
        action_result read = act_read_number(argument, &time);
        if (!result_ok(&read)) {
            return read;
        }
    }
    act_scrub(st, time);
    return result_done();
}

action_result act_set_speed(explorer_state *st, const char *argument)
{
    double wanted = st->playback.speed;

    // a step up or down, or the speed itself
    if (strcmp(argument, "up") == 0 || strcmp(argument, "down") == 0) {
        wanted = playback_next_speed(&st->playback, argument[0] == 'u' ? 1 : -1);
    } else {
        action_result read = act_read_number(argument, &wanted);
        if (!result_ok(&read)) {
            return read;
        }
    }

    // written so that NAN is refused too
    if (!(wanted >= 1e-3 && wanted <= 1e4)) {
        return result_refused("the speed is a number from 0.001 to 10000, 1 is real time");
    }
    st->playback.speed = wanted;
    return result_done();
}

action_result act_set_slow(explorer_state *st, const char *argument)
{
    double factor = 1;
    if (strcmp(argument, "off") != 0) {
        action_result read = act_read_number(argument, &factor);
        if (!result_ok(&read)) {
            return read;
        }
    }
    if (!(factor >= 1 && factor <= MOST_SLOW)) {
        return result_refused("impacts are shown 1 to %d times slower", MOST_SLOW);
    }
    st->playback.slow = factor;
    return factor > 1 ? result_news("impacts are shown %g times slower", factor)
                      : result_news("impacts are shown at the speed of the rest");
}

action_result act_restart(explorer_state *st, const char *argument)
{
    (void)argument;
    session_seek(&st->session, 0);
    st->session.seen = 0;
    st->playback.playing = true;
    return result_quiet();
}

action_result act_wait_for(explorer_state *st, const char *argument)
{
    double seconds;
    action_result read = act_read_number(argument, &seconds);
    return result_ok(&read) ? act_advance(st, fmax(0, fmin(3600, seconds))) : read;
}
