// Actions on the control law: another one, and the mode it is held in.
#include "ui/explorer/actions/actions.h"

#include <string.h>

#include "src/base/text_stream.h"
#include "src/base/words.h"

// Whether a word means no law, or no mode to be held in.
static bool is_off(const char *word)
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

// Refuses a name that no law has, with the one that is nearest.
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
    if (act_change_parameter(model, input, PARAMETER_INDEX(control.law), name)) {
        return true;
    }
    if (lock_prevents(&model->session, name)) {
        return act_refuse(input, "%.200s; undo the lock first", input->message.text);
    }
    return false;
}

bool act_law(explorer_model *model, explorer_input *input, const char *argument)
{
    const int law = PARAMETER_INDEX(control.law);
    parameters scratch = model->session.effective.parameters;

    // the present law is the one to come back to
    const bool is_on = model_has_law(model);
    if (is_on) {
        parameter_format(&scratch, law, model->last_law, sizeof model->last_law);
    }

    // without a name: off, or on again
    if (is_off(argument) || (argument[0] == '\0' && is_on)) {
        return change_law(model, input, "none");
    }
    if (argument[0] == '\0' && model->last_law[0] != '\0') {
        return change_law(model, input, model->last_law);
    }
    if (argument[0] == '\0') {
        return change_law(model, input, "hybrid");
    }

    // a name of the table, however the parameter would refuse another one
    if (parameter_set_text(&scratch, law, argument, NULL) != STATUS_OK) {
        return refuse_law(input, argument);
    }
    return change_law(model, input, argument);
}

// The next mode (step 1) or the one before (-1) of a round through all modes and "none",
// from the one that the law is held in at the cursor.
static const char *next_lock(const explorer_model *model, const law_modes *m, int step)
{
    const parameters p = model_parameters(model);

    // modes are counted from 1, 0 is "none"
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

// The value of control.lock that an argument asks for.
static const char *wanted_lock(explorer_model *model, const char *argument)
{
    const law_modes *m = model_law_modes(model);
    if (strcmp(argument, "next") == 0) {
        return next_lock(model, m, 1);
    }
    if (strcmp(argument, "previous") == 0) {
        return next_lock(model, m, -1);
    }
    if (is_off(argument)) {
        return "none";
    }
    return argument;
}

// Whether the last change is a lock at the cursor's instant.
static bool last_is_lock_here(const session *s)
{
    if (s->input_count == 0) {
        return false;
    }
    const session_input *last = &s->inputs[s->input_count - 1];
    return last->kind == SESSION_INPUT_TIMED && last->time == s->now &&
           last->parameter == PARAMETER_INDEX(control.lock);
}

// Holds the law in a mode from the cursor on, or lets it choose ("none").
static bool lock(explorer_model *model, explorer_input *input, const char *wanted)
{
    session *s = &model->session;

    // going on through the modes at one instant replaces the lock there
    const bool replaces = last_is_lock_here(s);
    if (replaces && !act_succeeded(input, session_undo(s, &input->fault))) {
        return false;
    }

    // a lock that is refused leaves the one before in effect
    const parameters p = model_parameters(model);
    if (strcmp(p.control.lock, wanted) != 0) {
        if (!act_change_parameter(model, input, PARAMETER_INDEX(control.lock), wanted)) {
            loss_unless(!replaces || session_redo(s, NULL) == STATUS_OK);
            return false;
        }

        // a warning of the change says more than what follows
        if (input->message.warning) {
            return true;
        }
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
    if (!m->lockable) {
        return act_refuse(input, "this law cannot be held in a mode");
    }

    // without an argument the modes are listed
    if (argument[0] == '\0') {
        char names[LINE_TEXT] = "";
        for (int i = 0; i < m->count; i++) {
            const char *separator = i > 0 ? ", " : "";
            text_add(names, sizeof names, "%s%s", separator, m->names[i]);
        }
        return act_tell(input, "lock takes off, next or a mode of this law: %s", names);
    }

    // a copy: the names are read again when the run changes
    char wanted[LINE_TEXT];
    snprintf(wanted, sizeof wanted, "%s", wanted_lock(model, argument));
    return lock(model, input, wanted);
}
