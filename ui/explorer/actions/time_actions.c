// Actions on time: running, stepping, seeking, and the tip that is pulled meanwhile.
#include "ui/explorer/actions/actions.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/instant.h"

// --- pulling the tip -------------------------------------------------------------------

// Brings the spring's force up to date with the tip at the cursor.
static void follow_tip(const explorer_model *model, explorer_view *view)
{
    const session *s = &model->session;
    plane_vector tip, across;
    recorded_tip(&s->run.trace, &s->effective.parameters.arm, s->row, &tip, &across);
    view->pull.force = pull_force(&view->pull, tip, across);
}

bool act_pull_tip(explorer_model *model, explorer_view *view, explorer_input *input,
                  plane_vector place)
{
    const session *s = &model->session;
    tip_pull *p = &view->pull;
    if (s->effective.parameters.arm.model == ARM_PRINTED) {
        return act_refuse(input,
                          "the printed model knows no pushes: nothing pulls its tip");
    }
    if (s->computing != NULL) {
        return act_refuse(input, "the run is still being computed");
    }

    // the run plays as long as the tip is held
    *p = (tip_pull){.held = true,
                    .x = place.x,
                    .y = place.y,
                    .next = s->now,
                    .was_playing = view->playback.playing,
                    .gesture = session_new_gesture(s)};
    view->playback.playing = true;
    follow_tip(model, view);
    return act_tell(input,
                    "a spring of %g N/m from the tip to the pointer: the run plays while "
                    "it is held",
                    PULL_STIFFNESS);
}

void act_move_pull(const explorer_model *model, explorer_view *view, plane_vector place)
{
    view->pull.x = place.x;
    view->pull.y = place.y;
    follow_tip(model, view);
}

// Gives the run the pushes that are due until an instant [s], if the tip is held.
static bool pull_until(explorer_model *model, explorer_view *view, explorer_input *input,
                       double time)
{
    session *s = &model->session;
    tip_pull *p = &view->pull;
    const double end = s->effective.parameters.run.duration;

    // a push for each step of the run, as large as the spring's force over it
    while (p->held && p->next <= time && p->next < end && s->computing == NULL) {
        session_seek(s, p->next);
        follow_tip(model, view);
        const status code =
            session_pull(s, p->force * PULL_STEP, p->gesture, &input->fault);
        if (code != STATUS_OK) {
            p->held = false;
            return act_succeeded(input, code);
        }
        p->next += PULL_STEP;
    }
    follow_tip(model, view);
    return true;
}

bool act_release_tip(const explorer_model *model, explorer_view *view,
                     explorer_input *input)
{
    tip_pull *p = &view->pull;
    if (!p->held) {
        return true;
    }
    p->held = false;
    view->playback.playing = p->was_playing;
    return act_tell(input, "pulled until %.4f s, u takes it back", model->session.now);
}

// --- time ------------------------------------------------------------------------------

enum { MOST_SLOW = 100 }; // how much slower impacts can be shown
#define NEW_SHARE 0.1     // of the last measurement in the mean speed

void act_scrub(explorer_model *model, explorer_view *view, double time)
{
    assert(isfinite(time));
    view->playback.playing = false;
    session_seek(&model->session, time);
}

bool act_advance(explorer_model *model, explorer_view *view, explorer_input *input,
                 double seconds)
{
    session *s = &model->session;
    playback *play = &view->playback;
    if (!play->playing || !(seconds > 0)) {
        play->measured = 0;
        return true;
    }

    // slower near impacts; a held tip is pulled meanwhile
    const double before = s->now, duration = s->effective.parameters.run.duration;
    play->slowed = playback_slowness(play, &s->run.trace, duration, before);
    const double next = before + seconds * play->speed / play->slowed;
    if (!pull_until(model, view, input, next)) {
        return false;
    }

    // the cursor waits at the end of what has been computed
    session_seek(s, next);

    // the mean speed of the last pictures
    const double factor = (s->now - before) / seconds;
    if (play->measured > 0) {
        play->measured = (1 - NEW_SHARE) * play->measured + NEW_SHARE * factor;
    } else {
        play->measured = factor;
    }

    // at the end of the run playing ends
    if (s->now < session_end(s) || s->computing != NULL) {
        return true;
    }
    act_release_tip(model, view, input);
    play->playing = false;
    return act_tell_failed_run(model, input) ||
           act_tell(input, "end of the run: Space plays it again, x makes it longer, "
                           "n and N visit its events");
}

bool act_play(explorer_model *model, explorer_view *view, explorer_input *input)
{
    session *s = &model->session;
    view->playback.playing = !view->playback.playing;
    const bool at_end = view->playback.playing && s->now >= session_end(s);

    // a run that was stopped there is computed on, a complete one begins again
    if (at_end && session_go_on(s, NULL) != STATUS_OK && s->computing == NULL) {
        session_seek(s, 0);
    }
    return act_clear_message(input);
}

bool act_step(explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument)
{
    double rows = 1;
    if (!act_read_number_or(input, argument, "", &rows)) {
        return false;
    }
    view->playback.playing = false;
    session_step(&model->session, (long)fmax(-1e9, fmin(1e9, rows)));
    return true;
}

bool act_tell_event(explorer_model *model, explorer_input *input)
{
    const run_log *log = model_run_log(model);
    const event *e = session_event(&model->session);

    // an event with its numbers
    if (e != NULL) {
        const char *name = event_name(e->kind);
        if (e->kind == EVENT_IMPACT) {
            return act_tell(input, "%s at %.6f s: %.4g N s at %.4g m/s, %.4g J lost",
                            name, e->time, e->impulse, e->speed, e->loss);
        }
        return act_tell(input, "%s at %.6f s", name, e->time);
    }

    // else it may be the instant of another mode
    for (size_t i = log->count; i-- > 0;) {
        const log_entry *entry = &log->entries[i];
        if (entry->event < 0 && entry->time == model->session.now) {
            char name[MODE_NAME_SIZE];
            law_mode_name(model_law_modes(model), entry->mode, name, sizeof name);
            return act_tell(input, "the controller goes into its mode '%s' at %.6f s",
                            name, entry->time);
        }
    }
    return true;
}

bool act_event(explorer_model *model, explorer_view *view, explorer_input *input,
               const char *argument)
{
    const bool back = argument[0] == '-';
    view->playback.playing = false;
    const double time =
        run_log_next(model_run_log(model), model->session.now, back ? -1 : 1);
    if (time < 0) {
        return act_refuse(input, "no %s event", back ? "earlier" : "later");
    }
    session_seek(&model->session, time);
    return act_tell_event(model, input);
}

// The last row before an event at which nothing touches, as far as there is one.
static size_t free_row_before(const trace *t, double time)
{
    size_t row = trace_row_at(t, time);
    while (row > 0) {
        const bool at_event = same_instant(t->rows[row - 1].time, time);
        const bool touches = t->rows[row].contact != 0 && t->rows[row].time >= time;
        if (!at_event && !touches) {
            break;
        }
        row--;
    }
    return row;
}

// The free row before a touch that is nearest to a row, before or after it; the row
// itself if there is none.
static size_t nearest_touch(const trace *t, size_t row, bool back)
{
    size_t found = row;
    for (size_t i = 0; i < t->event_count; i++) {
        const event *e = &t->events[i];
        if (e->kind != EVENT_IMPACT && e->kind != EVENT_CONTACT) {
            continue;
        }
        const size_t before = free_row_before(t, e->time);
        if (t->rows[before].contact != 0) {
            continue;
        }
        if (!back && before > row) {
            return before;
        }
        if (back && before < row) {
            found = before;
        }
    }
    return found;
}

// To the last row before a touch, where a prediction can be compared with what comes.
bool act_touch(explorer_model *model, explorer_view *view, explorer_input *input,
               const char *argument)
{
    const bool back = argument[0] == '-';
    const session *s = &model->session;
    view->playback.playing = false;
    const size_t found = nearest_touch(&s->run.trace, s->row, back);
    if (found == s->row) {
        return act_refuse(input, "no %s touch", back ? "earlier" : "later");
    }
    session_step(&model->session, (long)found - (long)s->row);
    return act_tell(
        input,
        "just before a touch: what would come of it is predicted beside what came");
}

bool act_seek(explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument)
{
    double time = session_end(&model->session);
    if (strcmp(argument, "end") != 0 && !act_read_quantity(input, argument, "s", &time)) {
        return false;
    }
    act_scrub(model, view, time);
    if (fabs(model->session.now - time) >= 1e-9) {
        return act_warn(input, "the run goes from 0 to %g s: :extend makes it longer",
                        session_end(&model->session));
    }
    return true;
}

bool act_speed(explorer_view *view, explorer_input *input, const char *argument)
{
    double wanted = view->playback.speed;

    // a step up or down, or the speed itself
    if (strcmp(argument, "up") == 0) {
        wanted = playback_next_speed(&view->playback, 1);
    } else if (strcmp(argument, "down") == 0) {
        wanted = playback_next_speed(&view->playback, -1);
    } else if (!act_read_number(input, argument, &wanted)) {
        return false;
    }

    // written so that NAN is refused too
    if (!(wanted >= 1e-3 && wanted <= 1e4)) {
        return act_refuse(input,
                          "the speed is a number from 0.001 to 10000, 1 is real time");
    }
    view->playback.speed = wanted;
    return true;
}

bool act_slow(explorer_view *view, explorer_input *input, const char *argument)
{
    double factor = 1;
    if (!act_read_number_or(input, argument, "off", &factor)) {
        return false;
    }
    if (!(factor >= 1 && factor <= MOST_SLOW)) {
        return act_refuse(input, "impacts are shown 1 to %d times slower", MOST_SLOW);
    }
    view->playback.slow = factor;
    if (factor > 1) {
        return act_tell(input, "impacts are shown %g times slower", factor);
    }
    return act_tell(input, "impacts are shown at the speed of the rest");
}

bool act_restart(explorer_model *model, explorer_view *view, explorer_input *input)
{
    session_seek(&model->session, 0);
    model->session.seen = 0;
    view->playback.playing = true;
    return act_clear_message(input);
}

bool act_wait(explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument)
{
    double seconds;
    return act_read_number(input, argument, &seconds) &&
           act_advance(model, view, input, fmax(0, fmin(3600, seconds)));
}
