#include "ui/explorer/actions/actions.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

bool act_hush(explorer_state *st)
{
    st->message.text[0] = '\0';
    return true;
}

bool act_say(explorer_state *st, bool warning, bool done, const char *format, ...)
{
    // it may contain what stood there
    char text[MESSAGE_TEXT];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    memcpy(st->message.text, text, sizeof text);
    st->message.warning = warning;
    return done;
}

bool act_worked(explorer_state *st, status code)
{
    const fault f = st->fault;
    st->fault = (fault){0};
    if (code == STATUS_OK) {
        return true;
    }
    if (f.text[0] != '\0') {
        return act_refuse(st, "%s", f.text);
    }
    return act_refuse(st, "%s", status_text(code));
}

bool act_read_number(explorer_state *st, const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(*value)) {
        return act_refuse(st, "'%s' is no number", text);
    }
    return true;
}

bool act_read_number_or(explorer_state *st, const char *text, const char *word,
                        double *value)
{
    return strcmp(text, word) == 0 || act_read_number(st, text, value);
}

int act_read_index(explorer_state *st, const char **text, int count, const char *what,
                   const char *lister)
{
    assert(count > 0);
    char *end;
    const long number = strtol(*text, &end, 10);

    // a number of the list, alone or before a blank
    if (end == *text || (*end != '\0' && *end != ' ') || number < 1 || number > count) {
        act_refuse(st, "%s are numbered from 1 to %d (%s lists them)", what, count,
                   lister);
        return -1;
    }
    *text = end + strspn(end, " ");
    return (int)number - 1;
}

int act_split(const char *argument, char text[LINE_TEXT], char *words[4])
{
    int count = 0;
    snprintf(text, LINE_TEXT, "%s", argument);
    for (char *word, *rest = text; (word = strtok_r(rest, " \t", &rest)) != NULL;
         count++) {
        if (count < 4) {
            words[count] = word;
        }
    }
    return count;
}

bool act_read_pane(explorer_state *st, const char *word, int *index)
{
    char *end;
    long number = strtol(word, &end, 10);
    *index = -1;

    // all panes need no number
    if (strcmp(word, "all") == 0) {
        return true;
    }

    // numbered as the keys are, and on
    if (*end != '\0' || end == word || number < 1 || number > PANES) {
        return act_refuse(st, "'%s' is no pane: 1 to %d, or all", word, PANES);
    }
    *index = (int)number - 1;

    // an empty pane has no axis
    if (st->panes.pane[*index].count == 0) {
        return act_refuse(st, "pane %s is empty, :trace SIGNAL... fills it", word);
    }
    return true;
}

// --- the run ---------------------------------------------------------------------------

#define LONGEST_WAIT 9 // for runs that are computed while the lab waits [s]

bool act_tell_failed_run(explorer_state *st)
{
    const summary *m = &st->session.run.summary;
    const control_parameters *c = &st->session.effective.parameters.control;
    if (m->status == STATUS_NOT_ALLOWED) {
        const char *does = "load", *what = c->plugin;
        if (c->law == LAW_PROCESS) {
            does = "start";
            what = c->command;
        }
        return act_warn(st,
                        "y lets it %s '%.200s', which can do whatever you can; all else "
                        "works without (:allow later)",
                        does, what);
    }
    if (m->status != STATUS_OK) {
        return act_warn(st, "the run stops: %s", m->message);
    }
    if (m->inaccurate) {
        return act_warn(st, "the run is inaccurate: %s", m->message);
    }
    return false;
}

bool act_need_whole_run(explorer_state *st)
{
    const session *s = &st->session;
    return s->computing == NULL ||
           act_refuse(st,
                      "the run is at %.3g of %g s: wait for its end, or stop it with Esc",
                      session_end(s), s->effective.parameters.run.duration);
}

bool act_need_short_runs(explorer_state *st, const char *command, int runs)
{
    // how busy the machine is has no say, but a program that is asked takes its own time
    const summary *s = &st->session.run.summary;
    const bool waits = st->session.effective.parameters.control.law == LAW_PROCESS;
    const double takes = waits ? s->wall_time_s : s->cpu_time_s;
    if (isfinite(st->session.patience) && takes * runs > LONGEST_WAIT) {
        return act_refuse(st,
                          "a run takes %.2g s here: 'impactlab %s' computes them beside",
                          takes, command);
    }
    return true;
}

bool act_tell_change(explorer_state *st)
{
    const session *s = &st->session;
    const session_input *in = &s->inputs[s->input_count - 1];
    const parameter_info *info = &parameter_table[in->parameter];
    char when[48] = "from the start", value[SESSION_INPUT_TEXT];
    input_value_text(in, value);
    if (act_tell_failed_run(st)) {
        return true;
    }
    if (in->kind == SESSION_INPUT_TIMED) {
        snprintf(when, sizeof when, "from %.4f s on", in->time);
    }

    // a change without effect must not look like one with it
    const parameters p = session_parameters_at(s, in->time);
    const char *inert = state_inert_reason(st, in->parameter);
    const char *blank = info->unit[0] ? " " : "";
    if (inert != NULL) {
        return act_warn(st, "%s = %s%s%s %s, without effect: %s", info->path, value,
                        blank, info->unit, when, inert);
    }
    if (in->parameter == PARAMETER_INDEX(motor.voltage) &&
        fabs(p.motor.voltage) > p.motor.voltage_limit) {
        return act_warn(
            st,
            "%s = %s V %s, more than motor.voltage_limit: the command saturates at %g V",
            info->path, value, when, p.motor.voltage_limit);
    }
    return act_tell(st, "%s = %s%s%s %s", info->path, value, blank, info->unit, when);
}

bool act_give(explorer_state *st, int parameter, const char *text)
{
    assert(parameter >= 0 && parameter < parameter_count);
    session_forget_ghost(&st->session);
    return act_worked(st, session_change(&st->session, parameter, text, &st->fault)) &&
           act_tell_change(st);
}
