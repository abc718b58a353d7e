// Pulling the tip with the mouse.
#include "ui/explorer/actions/actions.h"

#include <assert.h>

// Brings the spring's force up to date with the tip at the cursor.
static void follow_tip(explorer_state *st)
{
    const session *s = &st->session;
    plane_vector tip, across;
    recorded_tip(&s->run.trace, &s->effective.parameters.arm, s->row, &tip, &across);
    st->pull.force = pull_force(&st->pull, tip, across);
}

action_result act_hold_tip(explorer_state *st, plane_vector place)
{
    assert(st != NULL);
    const session *s = &st->session;
    tip_pull *p = &st->pull;
    if (s->effective.parameters.arm.model == ARM_PRINTED) {
        return result_refused("the printed model knows no pushes: nothing pulls its tip");
    }
    if (s->computing != NULL) {
        return result_refused("the run is still being computed");
    }

    // the run plays as long as the tip is held
    session_forget_ghost(&st->session);
    *p = (tip_pull){.held = true,
                    .x = place.x,
                    .y = place.y,
                    .next = s->now,
                    .was_playing = st->playback.playing,
                    .gesture = session_new_gesture(s)};
    st->playback.playing = true;
    follow_tip(st);
    return result_news("a spring of %g N/m from the tip to the pointer: the run plays while it is "
                       "held",
                       PULL_STIFFNESS);
}

void act_move_pull(explorer_state *st, plane_vector place)
{
    assert(st != NULL);
    st->pull.x = place.x;
    st->pull.y = place.y;
    follow_tip(st);
}

action_result act_pull_until(explorer_state *st, double time)
{
    assert(st != NULL);
    session *s = &st->session;
    tip_pull *p = &st->pull;
    const double end = s->effective.parameters.run.duration;

    // a push for each step of the run, as large as the spring's force over it
    while (p->held && p->next <= time && p->next < end && s->computing == NULL) {
        fault f = {0};
        session_seek(s, p->next);
        follow_tip(st);
        const status code = session_pull(s, p->force * PULL_STEP, p->gesture, &f);
        if (code != STATUS_OK) {
            p->held = false;
            return result_of(code, &f);
        }
        p->next += PULL_STEP;
    }
    follow_tip(st);
    return result_done();
}

action_result act_drop_pull(explorer_state *st)
{
    assert(st != NULL);
    tip_pull *p = &st->pull;
    if (!p->held) {
        return result_done();
    }
    p->held = false;
    st->playback.playing = p->was_playing;
    return result_news("pulled until %.4f s, u takes it back", st->session.now);
}
