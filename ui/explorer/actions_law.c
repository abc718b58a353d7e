// Actions on the control law: which one is on, and the mode it is held in.
#include <string.h>

#include "ui/explorer/actions.h"

static bool is_release(const char *word)
{
    return strcmp(word, "off") == 0 || strcmp(word, "none") == 0;
}

// A complaint about a lock that another law cannot keep says what helps.
static bool change_law(lab *l, const char *name)
{
    if (lab_change(l, PARAMETER_INDEX(control.law), name)) {
        return true;
    }
    if (strncmp(l->message, "control.lock", strlen("control.lock")) == 0) {
        char why[LAB_TEXT];
        snprintf(why, sizeof why, "%.200s", l->message);
        lab_say(l, true, "%s; undo the lock first", why);
    }
    return false;
}

bool act_law(lab *l, const char *argument)
{
    char present[LAB_TEXT];
    const parameters *p = &l->session.effective.parameters;
    const int law = PARAMETER_INDEX(control.law);
    parameter_format(p, law, present, sizeof present);
    if (lab_has_law(l)) {
        snprintf(l->last_law, sizeof l->last_law, "%s", present);
    }
    if (argument[0] == '\0') {
        const char *again = l->last_law[0] ? l->last_law : "hybrid";
        return change_law(l, lab_has_law(l) ? "none" : again);
    }
    return change_law(l, is_release(argument) ? "none" : argument);
}

// --- the lock ---------------------------------------------------------------------------------

// Index of the mode the law is held in at the cursor, -1 if in none.
static int locked_mode(lab *l)
{
    const lab_modes *m = lab_law_modes(l);
    parameters p = session_parameters_at(&l->session, l->session.now);
    for (int i = 0; i < m->count; i++) {
        if (strcmp(m->names[i], p.control.lock) == 0) {
            return i;
        }
    }
    return -1;
}

// The value of control.lock that an argument asks for: a mode, "none", or the next one of a round
// through all modes and none.
static const char *wanted_lock(lab *l, const char *argument)
{
    const lab_modes *m = lab_law_modes(l);
    int step = strcmp(argument, "next") == 0 ? 1 : strcmp(argument, "previous") == 0 ? -1 : 0;
    if (step == 0) {
        return is_release(argument) ? "none" : argument;
    }
    int round = m->count + 1, next = (locked_mode(l) + 1 + step + round) % round;
    return next == 0 ? "none" : m->names[next - 1];
}

// Whether the last change is a lock at this very instant: going on through the modes replaces it.
static bool locked_just_now(const session *s)
{
    if (s->input_count == 0) {
        return false;
    }
    const session_input *last = &s->inputs[s->input_count - 1];
    return last->kind == SESSION_INPUT_TIMED && last->time == s->now &&
           last->parameter == PARAMETER_INDEX(control.lock);
}

static void tell_modes(lab *l)
{
    const lab_modes *m = lab_law_modes(l);
    char text[LAB_TEXT] = "";
    for (int i = 0; i < m->count; i++) {
        size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "%s%s", i > 0 ? ", " : "", m->names[i]);
    }
    lab_say(l, false, "lock takes off, next or a mode of this law: %s", text);
}

static bool lock(lab *l, const char *wanted)
{
    session *s = &l->session;
    fault ignored = {0};
    const bool replaces = locked_just_now(s);
    if (replaces && !lab_complain(l, session_undo(s, &ignored), &ignored)) {
        return false;
    }
    parameters p = session_parameters_at(s, s->now);
    bool same = strcmp(p.control.lock, wanted) == 0;
    bool done = same || lab_change(l, PARAMETER_INDEX(control.lock), wanted);
    if (!done && replaces) {
        session_redo(s, &ignored);
    }
    if (!done || l->warning) {
        return done;
    }
    if (strcmp(wanted, "none") == 0) {
        lab_say(l, false, "the law chooses its mode itself from %.4f s on", s->now);
    } else {
        lab_say(l, false, "held in '%s' from %.4f s on", wanted, s->now);
    }
    return true;
}

bool act_lock(lab *l, const char *argument)
{
    if (!lab_has_law(l)) {
        lab_say(l, true, "no law is on that could be held in a mode (:law NAME)");
        return false;
    }
    if (!lab_law_modes(l)->lockable) {
        lab_say(l, true, "this law cannot be held in a mode");
        return false;
    }
    if (argument[0] == '\0') {
        tell_modes(l);
        return true;
    }
    char wanted[LAB_TEXT];
    l->warning = false;
    snprintf(wanted, sizeof wanted, "%s", wanted_lock(l, argument));
    return lock(l, wanted);
}
