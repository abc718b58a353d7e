#include "src/session/inputs.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/session/session_run.h"

// Adds an input and computes the run; takes it out again if that fails.
static status add_input(session *s, const session_input *in, fault *f)
{
    if (s->input_count == s->input_capacity) {
        int capacity = s->input_capacity ? 2 * s->input_capacity : 16;
        session_input *inputs = realloc(s->inputs, (size_t)capacity * sizeof *inputs);
        if (inputs == NULL) {
            return fault_set(f, STATUS_NO_MEMORY, "%s", status_text(STATUS_NO_MEMORY));
        }
        s->inputs = inputs;
        s->input_capacity = capacity;
    }
    session_input replaced = s->inputs[s->input_count];
    s->inputs[s->input_count++] = *in;
    status code = session_compute(s, f);
    if (code != STATUS_OK) {
        s->inputs[--s->input_count] = replaced;
        return code;
    }
    s->input_total = s->input_count;
    return STATUS_OK;
}

status session_change(session *s, int parameter, const char *text, fault *f)
{
    assert(s != NULL && text != NULL && parameter >= 0 && parameter < parameter_count);
    session_input in = {.kind = SESSION_INPUT_START, .time = s->now, .parameter = parameter};
    const parameter_info *info = &parameter_table[parameter];
    if (strlen(text) >= sizeof in.text) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "the value of %s is too long", info->path);
    }
    snprintf(in.text, sizeof in.text, "%s", text);
    parameters scratch = session_parameters_at(s, s->now);
    status code = parameter_set_text(&scratch, parameter, text, f);
    if (code != STATUS_OK) {
        return code;
    }
    in.value = parameter_get(&scratch, parameter);
    if (info->timed && s->now > 0) {
        in.kind = SESSION_INPUT_TIMED;
    }
    return add_input(s, &in, f);
}

status session_push(session *s, double impulse, fault *f)
{
    session_input in = {
        .kind = SESSION_INPUT_PUSH, .time = s->now, .parameter = -1, .value = impulse};
    if (!isfinite(impulse)) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "a push is a finite impulse in N s");
    }
    if (s->effective.parameters.arm.model == ARM_PRINTED) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "the printed model knows no pushes");
    }
    return add_input(s, &in, f);
}

status session_undo(session *s, fault *f)
{
    if (s->input_count == 0) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "nothing to undo");
    }
    s->input_count--;
    status code = session_compute(s, f);
    s->input_count += code != STATUS_OK;
    return code;
}

status session_redo(session *s, fault *f)
{
    if (s->input_count == s->input_total) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "nothing to redo");
    }
    s->input_count++;
    status code = session_compute(s, f);
    s->input_count -= code != STATUS_OK;
    return code;
}
