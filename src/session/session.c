#include "src/session/session.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/rig/external/transcript.h"

status session_open(session *s, scenario *base, double patience, fault *f)
{
    assert(s != NULL && base != NULL && patience >= 0);
    memset(s, 0, sizeof *s);
    s->base = *base;
    s->patience = patience;
    status code = session_compute(s, f);
    if (code != STATUS_OK) {
        session_finish(s);
    }
    return code;
}

void session_finish(session *s)
{
    assert(s != NULL);
    session_stop(s);
    session_forget_other(s);
    session_forget_ghost(s);
    run_finish(&s->run);
    process_transcript_destroy(s->transcript);
    free(s->effective.actions);
    free(s->inputs);
    scenario_finish(&s->base);
    memset(s, 0, sizeof *s);
}
