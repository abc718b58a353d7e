// Actions on notes: what the user has to say at an instant.
#include "ui/explorer/actions/actions.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/instant.h"

void act_drop_note(explorer_state *st, int index)
{
    assert(index >= 0 && index < st->note_count);
    st->note_count--;
    memmove(&st->notes[index], &st->notes[index + 1],
            (size_t)(st->note_count - index) * sizeof st->notes[0]);
    st->note -= st->note > 0 && st->note >= st->note_count;
}

bool act_note(explorer_state *st, const char *argument)
{
    double time = st->session.now;
    const char *text = argument;

    // at the cursor, or at an instant of its own
    if (*text == '@') {
        char *end;
        time = strtod(text + 1, &end);
        FAIL_IF(end == text + 1 || (*end != ' ' && *end != '\0') || !isfinite(time),
                act_refuse(st, "'%.40s' is no instant, such as @0.35", text));
        text = end + strspn(end, " ");
    }

    // in the order of instants; another text at one instant takes the place of the first
    int at = 0;
    while (at < st->note_count && st->notes[at].time < time &&
           !same_instant(st->notes[at].time, time)) {
        at++;
    }
    const bool there = at < st->note_count && same_instant(st->notes[at].time, time);
    if (*text == '\0') {
        if (there) {
            act_drop_note(st, at);
        }
        return there ? act_tell(st, "no note at %.5f s", time)
                     : act_refuse(st, "note takes a text; there is none at %.5f s", time);
    }
    FAIL_IF(!there && st->note_count == NOTES,
            act_refuse(st, "%d notes are the most there can be (:notes drops some)", NOTES));
    if (!there) {
        memmove(&st->notes[at + 1], &st->notes[at],
                (size_t)(st->note_count++ - at) * sizeof st->notes[0]);
    }
    st->notes[at].time = time;
    snprintf(st->notes[at].text, sizeof st->notes[at].text, "%s", text);
    return act_tell(st, "noted at %.5f s; :notes lists them, figures show them", time);
}
