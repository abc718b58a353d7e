#include "ui/explorer/actions/actions.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <glib.h>

#include "src/base/units.h"

bool act_clear_message(explorer_input *input)
{
    input->message.text[0] = '\0';
    return true;
}

bool act_say(explorer_input *input, bool warning, bool done, const char *format, ...)
{
    // it may contain what stood there
    char text[MESSAGE_TEXT];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    memcpy(input->message.text, text, sizeof text);
    input->message.warning = warning;
    return done;
}

bool act_succeeded(explorer_input *input, status code)
{
    const fault f = input->fault;
    input->fault = (fault){0};
    if (code == STATUS_OK) {
        return true;
    }
    if (f.text[0] != '\0') {
        return act_refuse(input, "%s", f.text);
    }
    return act_refuse(input, "%s", status_text(code));
}

bool act_read_number(explorer_input *input, const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(*value)) {
        return act_refuse(input, "'%s' is no number", text);
    }
    return true;
}

bool act_read_quantity(explorer_input *input, const char *text, const char *unit,
                       double *value)
{
    const char *rest;
    double factor;
    if (!decimal_read(text, value, &rest)) {
        return act_refuse(input, "'%.60s' is no number", text);
    }
    if (*rest != '\0' && !unit_factor(rest, unit, &factor)) {
        return act_refuse(input, "'%.60s' is in '%.20s', expected %s", text, rest, unit);
    }
    if (*rest != '\0') {
        *value *= factor;
    }
    return true;
}

const char *act_convert(int parameter, const char *value, char text[NUMBER_TEXT])
{
    const parameter_info *info = &parameter_table[parameter];
    const char *rest;
    double number, factor;
    if (info->type != PARAMETER_REAL || !decimal_read(value, &number, &rest) ||
        *rest == '\0' || strcmp(rest, info->unit) == 0 ||
        !unit_factor(rest, info->unit, &factor)) {
        return value;
    }
    number_format(text, number * factor);
    return text;
}

bool act_read_number_or(explorer_input *input, const char *text, const char *word,
                        double *value)
{
    return strcmp(text, word) == 0 || act_read_number(input, text, value);
}

int act_read_index(explorer_input *input, const char **text, int count, const char *what,
                   const char *lister)
{
    assert(count > 0);
    char *end;
    const long number = strtol(*text, &end, 10);

    // a number of the list, alone or before a blank
    if (end == *text || (*end != '\0' && *end != ' ') || number < 1 || number > count) {
        act_refuse(input, "%s are numbered from 1 to %d (%s lists them)", what, count,
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

bool act_read_pane(const explorer_view *view, explorer_input *input, const char *word,
                   int *index)
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
        return act_refuse(input, "'%s' is no pane: 1 to %d, or all", word, PANES);
    }
    *index = (int)number - 1;

    // an empty pane has no axis
    if (view->panes.pane[*index].count == 0) {
        return act_refuse(input, "pane %s is empty, :trace SIGNAL... fills it", word);
    }
    return true;
}

// --- the run ---------------------------------------------------------------------------

#define LONGEST_WAIT 9 // for runs that are computed while the lab waits [s]

bool act_wait_for(int *done, double patience)
{
    enum { STEP = 1000 }; // [us]
    for (double waited = 0; !g_atomic_int_get(done) && waited < patience;
         waited += 1e-6 * STEP) {
        g_usleep(STEP);
    }
    return g_atomic_int_get(done);
}

bool act_tell_failed_run(const explorer_model *model, explorer_input *input)
{
    const summary *m = &model->session.run.summary;
    const control_parameters *c = &model->session.effective.parameters.control;
    if (m->status == STATUS_NOT_ALLOWED) {
        const char *does = "load", *what = c->plugin;
        if (c->law == LAW_PROCESS) {
            does = "start";
            what = c->command;
        }
        return act_warn(input,
                        "y lets it %s '%.200s', which can do whatever you can; all else "
                        "works without (:allow later)",
                        does, what);
    }
    if (m->status != STATUS_OK) {
        return act_warn(input, "the run stops: %s", m->message);
    }
    if (m->inaccurate) {
        return act_warn(input, "the run is inaccurate: %s", m->message);
    }
    return false;
}

bool act_need_whole_run(const explorer_model *model, explorer_input *input)
{
    const session *s = &model->session;
    return s->computing == NULL ||
           act_refuse(input,
                      "the run is at %.3g of %g s: wait for its end, or stop it with Esc",
                      session_end(s), s->effective.parameters.run.duration);
}

bool act_need_short_runs(const explorer_model *model, explorer_input *input,
                         const char *command, int runs)
{
    // how busy the machine is has no say, but a program that is asked takes its own time
    const summary *s = &model->session.run.summary;
    const bool waits = model->session.effective.parameters.control.law == LAW_PROCESS;
    const double takes = waits ? s->wall_time_s : s->cpu_time_s;
    if (isfinite(model->session.patience) && takes * runs > LONGEST_WAIT) {
        return act_refuse(input,
                          "a run takes %.2g s here: 'impactlab %s' computes them beside",
                          takes, command);
    }
    return true;
}

bool act_tell_change(const explorer_model *model, explorer_input *input)
{
    const session *s = &model->session;
    const session_input *in = &s->inputs[s->input_count - 1];
    const parameter_info *info = &parameter_table[in->parameter];
    char when[48] = "from the start", value[SESSION_INPUT_TEXT];
    input_value_text(in, value);
    if (act_tell_failed_run(model, input)) {
        return true;
    }
    if (in->kind == SESSION_INPUT_TIMED) {
        snprintf(when, sizeof when, "from %.4f s on", in->time);
    }

    // a change without effect must not look like one with it
    const parameters p = session_parameters_at(s, in->time);
    const char *inert = model_inert_reason(model, in->parameter);
    const char *blank = info->unit[0] ? " " : "";
    if (inert != NULL) {
        return act_warn(input, "%s = %s%s%s %s, without effect: %s", info->path, value,
                        blank, info->unit, when, inert);
    }
    if (in->parameter == PARAMETER_INDEX(motor.voltage) &&
        fabs(p.motor.voltage) > p.motor.voltage_limit) {
        return act_warn(
            input,
            "%s = %s V %s, more than motor.voltage_limit: the command saturates at %g V",
            info->path, value, when, p.motor.voltage_limit);
    }
    return act_tell(input, "%s = %s%s%s %s", info->path, value, blank, info->unit, when);
}

bool act_change_parameter(explorer_model *model, explorer_input *input, int parameter,
                          const char *text)
{
    assert(parameter >= 0 && parameter < parameter_count);
    session *s = &model->session;
    char converted[NUMBER_TEXT];
    const char *value = act_convert(parameter, text, converted);
    return act_succeeded(input, session_change(s, parameter, value, &input->fault)) &&
           act_tell_change(model, input);
}

bool act_change_number(explorer_model *model, explorer_input *input, int parameter,
                       double value)
{
    assert(parameter >= 0 && parameter < parameter_count);
    session *s = &model->session;
    return act_succeeded(input,
                         session_change_number(s, parameter, value, &input->fault)) &&
           act_tell_change(model, input);
}
