#include "ui/explorer/explorer.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "ui/explorer/panels/panel.h"
#include "ui/explorer/state/user_files.h"

status explorer_init(explorer *ex, scenario *s, double patience, fault *f)
{
    memset(ex, 0, sizeof *ex);
    if (consent_needed(s)) {
        s->parameters.code_allowed = consent_remembered(s);
    }
    TRY(state_init(&ex->model, &ex->view, s, patience, f));
    act_tell_failed_run(&ex->model, &ex->input);
    explorer_remember_looks(&ex->model, &ex->view);
    return STATUS_OK;
}

void explorer_keep_lines(explorer *ex)
{
    char path[1024];
    if (user_file(USER_STATE, "history", path, sizeof path, true)) {
        prompt_use_history(&ex->input.prompt, path);
    }
}

void explorer_finish(explorer *ex)
{
    if (ex != NULL) {
        data_reading_finish(ex->model.reading);
        run_search_finish(ex->model.search);
        state_finish(&ex->model, &ex->view);
        free(ex->input.copied);
        memset(ex, 0, sizeof *ex);
    }
}

bool explorer_carry_out(explorer *ex, const char *line)
{
    const bool done = explorer_execute(&ex->model, &ex->view, &ex->input, line);
    act_apply_baseline(&ex->model, &ex->input);
    act_follow_lesson(&ex->model);
    return done;
}

void explorer_welcome(explorer *ex)
{
    char path[1024];
    if (!user_file(USER_SETTINGS, "visited", path, sizeof path, true) ||
        access(path, F_OK) == 0) {
        return;
    }
    FILE *stream = fopen(path, "w");
    if (stream != NULL && fclose(stream) == 0) {
        act_tell(&ex->input, "Space pauses, Enter changes the voltage, o opens others, "
                             "? lists all keys");
    }
}

bool explorer_follow(explorer *ex)
{
    // a run of a sweep, or more of the present one
    const bool sweeps = !lab_sweep_is_done(&ex->model.sweep);
    if (sweeps) {
        act_continue_sweep(&ex->model, &ex->input);
    }
    const bool reads = ex->model.reading != NULL;
    act_take_data(&ex->model, &ex->input, 0);
    const bool has_data = reads && ex->model.reading == NULL;
    const bool found = act_follow_search(&ex->model, &ex->input);
    const bool more = session_follow(&ex->model.session);
    if (!sweeps && more && ex->model.session.computing == NULL) {
        act_tell_failed_run(&ex->model, &ex->input);
    }
    return sweeps || more || has_data || found;
}

bool explorer_is_busy(const explorer *ex)
{
    return ex->view.playback.playing || ex->model.session.computing != NULL ||
           !lab_sweep_is_done(&ex->model.sweep) || ex->model.reading != NULL ||
           ex->model.search != NULL;
}

void explorer_draw(explorer *ex, screen *s)
{
    const screen_size size = {s->width, s->height};
    ex->view.size = size;

    // the state first, so that drawing only reads it; what the picture decided comes back
    if (compose_fits(size)) {
        act_apply_slider(&ex->model, &ex->view, &ex->input);
        act_follow_lesson(&ex->model);
        state_update(&ex->model, &ex->view);
    }
    compose_screen(&ex->model, &ex->view, &ex->input, &ex->layout, s);
    ex->view.drawn = ex->layout.drawn;
}
