// Actions on whole runs: opening one, and runs that are computed in the background.
#include "ui/explorer/actions/actions.h"

#include <assert.h>
#include <string.h>

#include "src/rig/external/transcript.h"
#include "ui/explorer/state/consent.h"

// Keeps the first fault of a scenario that does not open.
static void keep_first_fault(void *context, const char *sentence)
{
    fault *f = context;
    if (f->code == STATUS_OK) {
        fault_set(f, STATUS_BAD_SCENARIO, "%s", sentence);
    }
}

action_result act_open_scenario(explorer_state *st, const char *name)
{
    assert(st != NULL && name != NULL);
    scenario s;
    session fresh;
    fault f = {0};
    status code = scenario_open(&s, name, keep_first_fault, &f);
    if (code == STATUS_OK) {
        s.parameters.code_allowed = consent_needed(&s) && consent_remembered(&s);
        code = session_open(&fresh, &s, st->session.patience, &f);
    }
    if (code != STATUS_OK) {
        return result_of(code, &f);
    }

    // from here on nothing fails: the new session takes the old one's place
    state_take_session(st, &fresh);
    st->playback.playing = true;
    if (st->session.run.summary.status != STATUS_OK || st->session.run.summary.inaccurate) {
        return act_tell_failed_run(st);
    }
    return result_news("%s", st->session.base.title ? st->session.base.title : "");
}

// The list of scenarios with the present one selected.
static void open_list(explorer_state *st)
{
    scenario_menu *menu = &st->scenarios;
    int at = scenario_menu_find(menu, st->session.base.name);
    st->page.panel = PANEL_SCENARIOS;
    menu->selected = at < 0 ? 0 : at;
    menu->first = -1;
    menu->filter[0] = '\0';
    scenario_menu_read_titles(menu);
}

action_result act_open_scenario_by(explorer_state *st, const char *argument)
{
    const scenario_menu *menu = &st->scenarios;
    if (argument[0] == '\0') {
        open_list(st);
        return result_done();
    }

    // the neighbour in the list, or one by name
    bool next = strcmp(argument, "+1") == 0;
    if ((next || strcmp(argument, "-1") == 0) && menu->count > 0) {
        int at = scenario_menu_find(menu, st->session.base.name);
        at = (at + (next ? 1 : menu->count - 1) + menu->count) % menu->count;
        return act_open_scenario(st, menu->names[at]);
    }
    return act_open_scenario(st, argument);
}

action_result act_find_scenario(explorer_state *st, const char *argument)
{
    open_list(st);
    snprintf(st->scenarios.filter, sizeof st->scenarios.filter, "%s", argument);
    st->scenarios.filtering = true;
    return result_done();
}

action_result act_tell_failed_run(const explorer_state *st)
{
    assert(st != NULL);
    const summary *m = &st->session.run.summary;
    const control_parameters *c = &st->session.effective.parameters.control;
    if (m->status == STATUS_NOT_ALLOWED) {
        const bool program = c->law == LAW_PROCESS;
        return result_warning("y lets it %s '%.200s', which can do whatever you can; all else "
                              "works without (:allow later)",
                              program ? "start" : "load", program ? c->command : c->plugin);
    }
    return m->status != STATUS_OK ? result_warning("the run stops: %s", m->message)
           : m->inaccurate        ? result_warning("the run is inaccurate: %s", m->message)
                                  : result_done();
}

action_result act_need_whole_run(const explorer_state *st)
{
    assert(st != NULL);
    const session *s = &st->session;
    if (s->computing == NULL) {
        return result_done();
    }
    return result_refused("the run is at %.3g of %g s: wait for its end, or stop it with Esc",
                          session_end(s), s->effective.parameters.run.duration);
}

action_result act_stop(explorer_state *st, const char *argument)
{
    (void)argument;
    session *s = &st->session;
    if (s->computing == NULL) {
        return result_refused("nothing is being computed");
    }
    if (!session_stop(s)) {
        return result_done();
    }
    return result_news("stopped at %.4g s: Space at its end goes on, u takes the last change back",
                       session_end(s));
}

action_result act_allow(explorer_state *st, const char *argument)
{
    (void)argument;
    session *s = &st->session;
    fault f = {0};
    bool kept;
    if (s->run.summary.status != STATUS_NOT_ALLOWED) {
        return result_refused("the run asks for no permission");
    }

    // a visit's changes are the user's own: what is remembered is the scenario as it was opened
    status code = session_allow_code(s, &f);
    if (code != STATUS_OK) {
        return result_of(code, &f);
    }
    code = consent_remember(&s->base, &kept, &f);
    st->playback.playing = true;
    const action_result told = act_tell_failed_run(st);
    if (told.speaks) {
        return told;
    }
    return code != STATUS_OK ? result_of(code, &f)
           : kept ? result_news("allowed, and remembered for just this scenario and program")
                  : result_news("allowed for this visit");
}

action_result act_tell_replay(explorer_state *st)
{
    assert(st != NULL);
    const process_replay again = session_take_replay(&st->session);
    if (!again.restarted) {
        return result_done();
    }
    return result_news("the program was started anew and went through its %d samples up to %.4g s "
                       "once more",
                       again.samples, again.time);
}
