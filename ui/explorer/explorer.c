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
    TRY(state_init(&ex->state, s, patience, f));
    act_tell_failed_run(&ex->state);
    return STATUS_OK;
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
    explorer_state *st = &ex->state;

    // a run of a sweep, or more of the present one
    const bool sweeps = !lab_sweep_is_done(&st->sweep);
    if (sweeps) {
        act_continue_sweep(st);
    }
    const bool more = session_follow(&st->session);
    if (!sweeps && more && st->session.computing == NULL) {
        act_tell_failed_run(st);
        act_tell_replay(st);
    }
    return sweeps || more;
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
