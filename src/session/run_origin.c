#include "src/session/run_origin.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

status run_origin_take(run_origin *o, const session *s, fault *f)
{
    *o = (run_origin){.input_count = s->input_count, .now = s->now, .seen = s->seen};

    o->inputs = calloc((size_t)s->input_count + 1, sizeof *o->inputs);
    if (o->inputs == NULL || scenario_copy(&o->base, &s->base) != STATUS_OK) {
        free(o->inputs);
        return fault_no_memory(f);
    }

    memcpy(o->outside, s->digest, sizeof o->outside);
    if (s->input_count > 0) {
        memcpy(o->inputs, s->inputs, (size_t)s->input_count * sizeof *o->inputs);
    }
    return STATUS_OK;
}

void run_origin_finish(run_origin *o)
{
    free(o->inputs);
    scenario_finish(&o->base);
    *o = (run_origin){0};
}

// By all that a scenario says but its expectations.
bool same_base(const scenario *a, const scenario *b)
{
    bool same = strcmp(a->name, b->name) == 0 && a->action_count == b->action_count;

    // every parameter, as it is written
    for (int i = 0; same && i < parameter_count; i++) {
        char one[PARAMETER_VALUE_SIZE], other[PARAMETER_VALUE_SIZE];
        parameter_format(&a->parameters, i, one, sizeof one);
        parameter_format(&b->parameters, i, other, sizeof other);
        same = strcmp(one, other) == 0;
    }

    // and every action of the script
    for (int i = 0; same && i < a->action_count; i++) {
        const action *one = &a->actions[i], *other = &b->actions[i];
        same = one->time == other->time && one->kind == other->kind &&
               one->parameter == other->parameter && one->value == other->value &&
               strcmp(one->text, other->text) == 0;
    }
    return same;
}

bool run_origin_is_of(const run_origin *o, const session *s)
{
    bool same = o->input_count == s->input_count;
    for (int i = 0; same && i < o->input_count; i++) {
        same = session_same_input(&o->inputs[i], &s->inputs[i]);
    }
    return same && same_base(&o->base, &s->base);
}

// A session as it was: the scenario, its changes, and the cursor.
status session_reopen(session *s, const run_origin *o, double patience, fault *f)
{
    scenario base;
    if (scenario_copy(&base, &o->base) != STATUS_OK) {
        return fault_no_memory(f);
    }

    // the scenario's own run, then that of the changes
    status code = session_open(s, &base, patience, f);
    if (code == STATUS_OK && o->input_count > 0) {
        code = session_take_inputs(s, o->inputs, o->input_count, f);
        if (code != STATUS_OK) {
            session_finish(s);
        }
    }
    if (code == STATUS_OK) {
        session_seek(s, o->now);
        s->seen = fmax(s->seen, fmin(o->seen, s->effective.parameters.run.duration));
    }
    return code;
}
