// Actions on the control law: another one, and the mode it is held in.
#include "ui/explorer/actions/actions.h"

#include <string.h>

#include "src/base/text_stream.h"
#include "src/base/words.h"

static bool is_release(const char *word)
{
    return strcmp(word, "off") == 0 || strcmp(word, "none") == 0;
}

// Whether the script and the inputs hold a mode that another law does not have.
static bool lock_prevents(const session *s, const char *name)
{
    scenario wanted = s->effective;
    parameters *p = &wanted.parameters;
    return parameter_set_text(p, PARAMETER_INDEX(control.law), name, NULL) == STATUS_OK &&
           scenario_check_locks(&wanted, controller_of(p->control.law), NULL) !=
               STATUS_OK;
}

// Says which law is near to a name that none has.
static bool refuse_law(explorer_input *input, const char *name)
{
    nearest_word near = nearest_begin(name);
    for (int i = 0; i < LAW_COUNT; i++) {
        nearest_try(&near, control_law_table[i].word);
    }
    if (near.best == NULL) {
        return act_refuse(input,
                          "there is no control law '%.60s' (:law and Tab lists them)",
                          name);
    }
    return act_refuse(input, "there is no control law '%.60s', did you mean '%s'?", name,
                      near.best);
}

// Changes the control law; if the lock on a mode prevents it, the message says what to
// do.
static bool change_law(explorer_model *model, explorer_input *input, const char *name)
{
    return act_change_parameter(model, input, PARAMETER_INDEX(control.law), name) ||
           (lock_prevents(&model->session, name) &&
            act_refuse(input, "%.200s; undo the lock first", input->message.text));
}

bool act_law(explorer_model *model, explorer_input *input, const char *argument)
{
    const bool named = argument[0] != '\0', off = is_release(argument);
    const int law = PARAMETER_INDEX(control.law);
    parameters scratch = model->session.effective.parameters;

    // the law of now is the one to come back to
    if (model_has_law(model)) {
        parameter_format(&scratch, law, model->last_law, sizeof model->last_law);
    }

    // a name of the table, however the parameter would refuse another one
    if (named && !off && parameter_set_text(&scratch, law, argument, NULL) != STATUS_OK) {
        return refuse_law(input, argument);
    }

    // without a name: off, or on again
    if (off || (!named && model_has_law(model))) {
        return change_law(model, input, "none");
    }
    if (named) {
        return change_law(model, input, argument);
    }
    if (model->last_law[0] != '\0') {
        return change_law(model, input, model->last_law);
    }
    return change_law(model, input, "hybrid");
}

// The value of control.lock that an argument asks for: a mode, "none", or the next one of
// a round through all modes and none.
static const char *wanted_lock(explorer_model *model, const char *argument)
{
    const law_modes *m = model_law_modes(model);
    const parameters p = model_parameters(model);
    int step = 1;
    if (strcmp(argument, "next") != 0) {
        if (strcmp(argument, "previous") == 0) {
            step = -1;
        } else {
            step = 0;
        }
    }
    if (step == 0) {
        if (is_release(argument)) {
            return "none";
        }
        return argument;
    }

    // the mode it is held in at the cursor is one of those from 1 on
    int held = m->count;
    while (held > 0 && strcmp(m->names[held - 1], p.control.lock) != 0) {
        held--;
    }
    const int next = (held + step + m->count + 1) % (m->count + 1);
    if (next == 0) {
        return "none";
    }
    return m->names[next - 1];
}

static bool lock(explorer_model *model, explorer_input *input, const char *wanted)
{
    session *s = &model->session;
    const int parameter = PARAMETER_INDEX(control.lock);

    // going on through the modes at one instant replaces the lock there
    bool replaces = false;
    if (s->input_count > 0) {
        const session_input *last = &s->inputs[s->input_count - 1];
        replaces = last->kind == SESSION_INPUT_TIMED && last->time == s->now &&
                   last->parameter == parameter;
    }
    if (replaces && !act_succeeded(input, session_undo(s, &input->fault))) {
        return false;
    }

    // a lock that is refused leaves the one before in effect
    const parameters p = model_parameters(model);
    const bool other = strcmp(p.control.lock, wanted) != 0;
    if (other && !act_change_parameter(model, input, parameter, wanted)) {
        loss_unless(!replaces || session_redo(s, NULL) == STATUS_OK);
        return false;
    }
    if (other && input->message.warning) {
        return true;
    }
    if (strcmp(wanted, "none") == 0) {
        return act_tell(input, "the law chooses its mode itself from %.4f s on", s->now);
    }
    return act_tell(input, "held in '%s' from %.4f s on", wanted, s->now);
}

bool act_lock(explorer_model *model, explorer_input *input, const char *argument)
{
    if (!model_has_law(model)) {
        return act_refuse(input, "no law is on that could be held in a mode (:law NAME)");
    }
    const law_modes *m = model_law_modes(model);
    char wanted[LINE_TEXT] = "";
    if (!m->lockable) {
        return act_refuse(input, "this law cannot be held in a mode");
    }
    if (argument[0] == '\0') {
        for (int i = 0; i < m->count; i++) {
            text_add(wanted, sizeof wanted, "%s%s", i > 0 ? ", " : "", m->names[i]);
        }
        return act_tell(input, "lock takes off, next or a mode of this law: %s", wanted);
    }

    // a copy: the modes are read anew when the run changes
    snprintf(wanted, sizeof wanted, "%s", wanted_lock(model, argument));
    return lock(model, input, wanted);
}
