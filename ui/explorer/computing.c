// Runs that are computed while the lab goes on: what is told of them, and how they are stopped.
#include <string.h>

#include "ui/explorer/actions.h"

bool lab_follow(lab *l)
{
    session *s = &l->session;
    if (!session_follow(s)) {
        return false;
    }
    const summary *m = &s->run.summary;
    if (s->computing == NULL && m->status != STATUS_OK) {
        lab_say(l, true, "the run stops: %s", m->message);
    }
    return true;
}

void lab_progress(const lab *l, char *text, size_t size)
{
    const session *s = &l->session;
    text[0] = '\0';
    if (s->computing != NULL) {
        snprintf(text, size, "  computing %.1f of %g s (Esc stops)", session_end(s),
                 s->effective.parameters.run.duration);
    }
}

bool lab_has_whole_run(lab *l)
{
    const session *s = &l->session;
    if (s->computing != NULL) {
        lab_say(l, true, "the run is at %.3g of %g s: wait for its end, or stop it with Esc",
                session_end(s), s->effective.parameters.run.duration);
        return false;
    }
    return true;
}

bool act_stop(lab *l, const char *argument)
{
    (void)argument;
    session *s = &l->session;
    if (s->computing == NULL) {
        lab_say(l, true, "nothing is being computed");
        return false;
    }
    if (session_stop(s)) {
        lab_say(l, false,
                "stopped at %.4g s: Space at its end goes on, u takes the last change back",
                session_end(s));
    }
    return true;
}
