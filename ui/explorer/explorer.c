#include "ui/explorer/explorer.h"

#include <string.h>

#include "ui/explorer/panels/panel.h"
#include "ui/explorer/state/user_files.h"

status explorer_init(explorer *ex, scenario *s, double patience, fault *f)
{
    memset(ex, 0, sizeof *ex);
    if (consent_needed(s)) {
        s->parameters.code_allowed = consent_remembered(s);
    }
    status code = state_init(&ex->state, s, patience, f);
    if (code == STATUS_OK) {
        act_tell_failed_run(&ex->state);
    }
    return code;
}

void explorer_finish(explorer *ex)
{
    if (ex != NULL) {
        state_finish(&ex->state);
        memset(ex, 0, sizeof *ex);
    }
}

bool explorer_follow(explorer *ex)
{
    session *s = &ex->state.session;

    // a run of a sweep, or more of the present one
    if (!lab_sweep_is_done(&ex->state.sweep)) {
        act_continue_sweep(&ex->state);
        session_follow(s);
        return true;
    }
    if (!session_follow(s)) {
        return false;
    }
    if (s->computing == NULL) {
        act_tell_failed_run(&ex->state);
        act_tell_replay(&ex->state);
    }
    return true;
}

bool explorer_is_busy(const explorer *ex)
{
    return ex->state.playback.playing || ex->state.session.computing != NULL ||
           !lab_sweep_is_done(&ex->state.sweep);
}

void explorer_draw(explorer *ex, screen *s)
{
    explorer_state *st = &ex->state;
    const screen_size size = {s->width, s->height};
    st->size = size;

    // the state first, so that drawing only reads it; what the picture decided comes back
    if (compose_fits(size)) {
        act_follow_slider(st);
        act_follow_lesson(st);
        state_update(st);
    }
    compose_screen(st, &ex->layout, s);
    st->drawn = ex->layout.drawn;
}
