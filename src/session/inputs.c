// What the user does to a session: inputs, each with its instant, and their undoing.
#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/instant.h"
#include "src/rig/rig.h"
#include "src/run/resume.h"
#include "src/session/session.h"

// time before an event at which a change takes effect that is made at the row before it
// [s]
#define BEFORE_EVENT 1e-7

// Notes the instant and row shown, to which undoing the input returns.
static void remember_cursor(const session *s, session_input *in)
{
    in->seen_at = s->now;
    in->seen_row = s->row;
}

// Puts the cursor back where it was when an input was given, if the run is as it was
// then.
static void restore_cursor(session *s, const session_input *in)
{
    const trace *t = &s->run.trace;
    session_seek(s, in->seen_at);
    if (in->seen_row < trace_rows_until(t, in->seen_at) &&
        t->rows[s->row].time == t->rows[in->seen_row].time) {
        s->row = in->seen_row;
    }
}

// The instant at which an input at the cursor takes effect [s]: the cursor's own. Where
// the row shown is the last one before an event of the motion, it is one just before the
// event.
static double effect_time(const session *s)
{
    const trace *t = &s->run.trace;
    const double now = s->now;
    if (s->row + 1 >= t->row_count || !same_instant(t->rows[s->row + 1].time, now)) {
        return now;
    }

    // two rows at one instant: an event, and the one before it is shown
    for (size_t i = 0; i < t->event_count; i++) {
        const event_kind kind = t->events[i].kind;
        const bool of_motion = kind != EVENT_CHANGE && kind != EVENT_PUSH;
        if (of_motion && same_instant(t->events[i].time, now)) {
            double before = 0;
            if (s->row > 0) {
                before = t->rows[s->row - 1].time;
            }
            return fmax(now - BEFORE_EVENT, (before + now) / 2);
        }
    }
    return now;
}

// Adds an input and computes the run; takes it out again if that fails.
static status add_input(session *s, const session_input *in, fault *f)
{
    // room for it
    int room = s->input_count + 1;
    if (s->input_count < s->input_total) {
        room = s->input_total;
    }
    session_input *inputs = realloc(s->inputs, (size_t)room * sizeof *inputs);
    if (inputs == NULL) {
        return fault_no_memory(f);
    }
    s->inputs = inputs;

    // it takes the place of the first input that could be redone, which comes back if the
    // run fails
    session_input replaced = s->inputs[s->input_count];
    s->inputs[s->input_count++] = *in;
    session_seek(s, fmin(s->now, in->time));
    status code = session_compute(s, f);
    if (code != STATUS_OK) {
        s->inputs[--s->input_count] = replaced;
        restore_cursor(s, in);
        return code;
    }
    s->input_total = s->input_count;
    return STATUS_OK;
}

// A value as a text that a person gave, or as a number (text NULL).
typedef struct given_value {
    const char *text;
    double number;
} given_value;

// Sets a parameter of a copy, which checks the value.
static status set_given(parameters *p, int parameter, given_value v, fault *f)
{
    if (v.text != NULL) {
        return parameter_set_text(p, parameter, v.text, f);
    }
    return parameter_set_number(p, parameter, v.number, f);
}

// Begins an input that gives a parameter another value at the cursor: fills in the
// instant from which it takes effect and the value before. *now receives the parameters
// there.
static status begin_input(const session *s, int parameter, session_input *in,
                          parameters *now, fault *f)
{
    assert(parameter >= 0 && parameter < parameter_count);
    *now = session_parameters_at(s, s->now);
    *in = (session_input){.kind = SESSION_INPUT_START,
                          .time = s->now,
                          .parameter = parameter,
                          .before = (double)NAN};
    remember_cursor(s, in);
    if (!parameter_is_text(&parameter_table[parameter])) {
        in->before = parameter_get(now, parameter);
    }

    // during the run, if it may change there
    if (s->now > 0 && rig_can_change(&s->effective.parameters, parameter)) {
        in->kind = SESSION_INPUT_TIMED;
        in->time = effect_time(s);
        return parameter_may_change(now, parameter, f);
    }
    return STATUS_OK;
}

// Gives a parameter a value from the cursor on, or from the start; see session_change.
static status change(session *s, int parameter, given_value v, fault *f)
{
    session_input in;
    parameters now;
    FAULT_IF(v.text != NULL && strlen(v.text) >= sizeof in.text, f, STATUS_BAD_ARGUMENT,
             "the value of %s is too long", parameter_table[parameter].path);
    TRY(begin_input(s, parameter, &in, &now, f));

    // the value, and how it is written
    TRY(set_given(&now, parameter, v, f));
    if (v.text != NULL) {
        snprintf(in.text, sizeof in.text, "%s", v.text);
    } else {
        parameter_format(&now, parameter, in.text, sizeof in.text);
    }
    session_input_take(&in, &now);
    return add_input(s, &in, f);
}

status session_change(session *s, int parameter, const char *text, fault *f)
{
    return change(s, parameter, (given_value){.text = text}, f);
}

status session_change_number(session *s, int parameter, double value, fault *f)
{
    return change(s, parameter, (given_value){.number = value}, f);
}

status session_change_from_start(session *s, const parameters *p, int parameter, fault *f)
{
    const double now = s->now, seen = s->seen;
    session_input in;
    parameters before;
    session_seek(s, 0);
    status code = begin_input(s, parameter, &in, &before, f);
    if (code == STATUS_OK) {
        parameter_format(p, parameter, in.text, sizeof in.text);
        session_input_take(&in, p);
        code = add_input(s, &in, f);
    }
    session_seek(s, now);
    s->seen = fmax(seen, s->now);
    return code;
}

// Whether the last input gave this parameter a value at the cursor's instant. A value
// ".NAME=VALUE" of control.settings continues one of the same name only.
static bool continues_last(const session *s, int parameter, given_value v)
{
    if (s->input_count == 0) {
        return false;
    }
    const session_input *last = &s->inputs[s->input_count - 1];
    size_t name_length = 0; // with "." and "="
    if (v.text != NULL && v.text[0] == '.') {
        name_length = strcspn(v.text, "=") + 1;
    }
    const bool same_name =
        name_length == 0 || strncmp(last->text, v.text, name_length) == 0;
    return last->kind != SESSION_INPUT_PUSH && last->parameter == parameter &&
           same_name && last->time == s->now;
}

// Gives a parameter a value at the cursor in the place of the last input, if that gave it
// one there too; see session_adjust.
static status adjust(session *s, int parameter, given_value v, fault *f)
{
    assert(parameter >= 0 && parameter < parameter_count);
    if (!continues_last(s, parameter, v)) {
        return change(s, parameter, v, f);
    }

    // a value that leads back to the one before the last input undoes that input
    const session_input replaced = s->inputs[s->input_count - 1];
    parameters scratch = session_parameters_at(s, s->now);
    if (set_given(&scratch, parameter, v, NULL) == STATUS_OK &&
        parameter_get(&scratch, parameter) == replaced.before) {
        return session_undo(s, f);
    }

    // replace the last input; undoing returns to the cursor before the first of the
    // changes
    const int total = s->input_total;
    s->input_count--;
    status code = change(s, parameter, v, f);
    if (code != STATUS_OK) {
        s->inputs[s->input_count++] = replaced;
        s->input_total = total;
        return code;
    }

    session_input *now = &s->inputs[s->input_count - 1];
    now->seen_at = replaced.seen_at;
    now->seen_row = replaced.seen_row;
    now->before = replaced.before;
    return STATUS_OK;
}

status session_adjust(session *s, int parameter, const char *text, fault *f)
{
    return adjust(s, parameter, (given_value){.text = text}, f);
}

status session_adjust_number(session *s, int parameter, double value, fault *f)
{
    return adjust(s, parameter, (given_value){.number = value}, f);
}

unsigned session_new_gesture(const session *s)
{
    unsigned highest = 0;
    for (int i = 0; i < s->input_total; i++) {
        if (s->inputs[i].gesture > highest) {
            highest = s->inputs[i].gesture;
        }
    }
    return highest + 1;
}

status session_push(session *s, double impulse, fault *f)
{
    return session_pull(s, impulse, 0, f);
}

// An impulse at the tip, as an input of a gesture (0: alone).
status session_pull(session *s, double impulse, unsigned gesture, fault *f)
{
    session_input in = {.kind = SESSION_INPUT_PUSH,
                        .time = effect_time(s),
                        .parameter = -1,
                        .value = impulse,
                        .gesture = gesture,
                        .before = (double)NAN};
    remember_cursor(s, &in);

    FAULT_IF(!isfinite(impulse), f, STATUS_BAD_ARGUMENT,
             "a push is a finite impulse in N s");
    FAULT_IF(s->effective.parameters.arm.model == ARM_PRINTED, f, STATUS_BAD_ARGUMENT,
             "the printed model knows no pushes");
    return add_input(s, &in, f);
}

// Undoes the last input (step -1) or redoes the next one (1), with all inputs of its
// gesture, and computes the run. If that fails the inputs stay as they were.
static status move_inputs(session *s, int step, fault *f)
{
    const session_input *in = s->inputs;
    const int before = s->input_count;

    // go on while the inputs before and after the new end belong to one gesture
    int count = before;
    do {
        count += step;
    } while (count > 0 && count < s->input_total && in[count].gesture != 0 &&
             in[count].gesture == in[count - 1].gesture);
    s->input_count = count;
    const status code = session_compute(s, f);
    if (code != STATUS_OK) {
        s->input_count = before;
    }
    return code;
}

status session_undo(session *s, fault *f)
{
    FAULT_IF(s->input_count == 0, f, STATUS_BAD_ARGUMENT, "nothing to undo");
    TRY(move_inputs(s, -1, f));
    restore_cursor(s, &s->inputs[s->input_count]);
    return STATUS_OK;
}

// Puts the next input in again, and goes to where it takes effect.
status session_redo(session *s, fault *f)
{
    FAULT_IF(s->input_count == s->input_total, f, STATUS_BAD_ARGUMENT, "nothing to redo");
    TRY(move_inputs(s, 1, f));

    // to where it takes effect
    const session_input *in = &s->inputs[s->input_count - 1];
    if (in->kind != SESSION_INPUT_START) {
        session_seek(s, in->time);
    }
    return STATUS_OK;
}

// The new value is an input of its own, behind the old one and of the same instant.
status session_change_input(session *s, int index, const char *text, fault *f)
{
    assert(index >= 0 && index < s->input_count);
    const session_input *old = &s->inputs[index];
    FAULT_IF(old->kind == SESSION_INPUT_PUSH, f, STATUS_BAD_ARGUMENT,
             "a push has no other value: drop it and push again");

    // a copy with the new text, which a scratch copy of the parameters checks
    session_input in = *old;
    FAULT_IF(strlen(text) >= sizeof in.text, f, STATUS_BAD_ARGUMENT,
             "the value is too long");
    remember_cursor(s, &in);
    snprintf(in.text, sizeof in.text, "%s", text);
    parameters scratch = session_parameters_at(s, in.time);
    TRY(parameter_set_text(&scratch, in.parameter, text, f));
    session_input_take(&in, &scratch);

    // of two values given for the same instant the later one counts; the cursor stays
    status code = add_input(s, &in, f);
    session_seek(s, in.seen_at);
    return code;
}

// Takes an input out and puts it first among those that can be redone.
status session_drop_input(session *s, int index, fault *f)
{
    assert(index >= 0 && index < s->input_count);
    const session_input dropped = s->inputs[index];
    const int last = s->input_count - 1;
    memmove(&s->inputs[index], &s->inputs[index + 1],
            (size_t)(last - index) * sizeof *s->inputs);
    s->inputs[last] = dropped;

    // it is then the first that can be redone
    s->input_count--;
    status code = session_compute(s, f);
    if (code != STATUS_OK) {
        s->input_count++;
        memmove(&s->inputs[index + 1], &s->inputs[index],
                (size_t)(last - index) * sizeof *s->inputs);
        s->inputs[index] = dropped;
    }
    return code;
}

// Replaces all inputs at once.
status session_take_inputs(session *s, const session_input *inputs, int count, fault *f)
{
    assert(count >= 0);
    session_input *taken = calloc((size_t)count + 1, sizeof *taken);
    if (taken == NULL) {
        return fault_no_memory(f);
    }

    if (count > 0) {
        memcpy(taken, inputs, (size_t)count * sizeof *taken);
    }

    // the old ones come back if their run cannot be computed
    session_input *const old = s->inputs;
    const int old_count = s->input_count, old_total = s->input_total;
    s->inputs = taken;
    s->input_count = s->input_total = count;

    const status code = session_compute(s, f);
    if (code != STATUS_OK) {
        s->inputs = old;
        s->input_count = old_count;
        s->input_total = old_total;
        free(taken);
        return code;
    }
    free(old);
    return STATUS_OK;
}

bool session_same_input(const session_input *a, const session_input *b)
{
    return a->kind == b->kind && a->parameter == b->parameter && a->value == b->value &&
           (a->kind == SESSION_INPUT_START || a->time == b->time) &&
           strcmp(a->text, b->text) == 0;
}
