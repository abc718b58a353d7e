#include "src/lab/session.h"

#include <stdlib.h>
#include <string.h>

#include "src/lab/export.h"

#define MEMORY_BUDGET (512.0 * 1024 * 1024) // rows of one run [bytes]
#define ROW_SPARE     1.5                   // rows of events beside those of the grid

size_t trace_row_at(const trace *t, double time)
{
    size_t low = 0, high = t->row_count; // the first row after `time` lies in [low, high]
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (t->rows[middle].time <= time) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low > 0 ? low - 1 : 0;
}

// --- the run ----------------------------------------------------------------------------------

static int count_actions(const session *s)
{
    int count = s->base.action_count;
    for (int i = 0; i < s->input_count; i++) {
        count += s->inputs[i].kind != INPUT_START;
    }
    return count;
}

// Inserts an action behind those that are not later.
static void insert_action(scenario *to, action a)
{
    int at = to->action_count++;
    for (; at > 0 && to->actions[at - 1].time > a.time; at--) {
        to->actions[at] = to->actions[at - 1];
    }
    to->actions[at] = a;
}

// The scenario with the inputs in effect. Its actions are the only thing it owns.
static status build_effective(const session *s, scenario *to, fault *f)
{
    *to = s->base;
    to->expectation_count = 0;
    to->action_count = 0;
    to->actions = calloc((size_t)count_actions(s) + 1, sizeof *to->actions);
    if (to->actions == NULL) {
        return fault_set(f, STATUS_NO_MEMORY, "%s", status_text(STATUS_NO_MEMORY));
    }
    status code = STATUS_OK;
    for (int i = 0; i < s->base.action_count; i++) {
        insert_action(to, s->base.actions[i]);
    }
    for (int i = 0; i < s->input_count && code == STATUS_OK; i++) {
        const session_input *in = &s->inputs[i];
        if (in->kind == INPUT_START) {
            code = parameter_set_text(&to->parameters, in->parameter, in->text, f);
        } else {
            insert_action(to, (action){.time = in->time,
                                       .kind = in->kind == INPUT_PUSH ? ACTION_PUSH : ACTION_SET,
                                       .parameter = in->parameter,
                                       .value = in->value});
        }
    }
    return code == STATUS_OK ? parameters_resolve(&to->parameters, f) : code;
}

static status check_memory(const parameters *p, fault *f)
{
    double rows = p->run.duration / p->method.step * ROW_SPARE;
    double bytes = rows * (double)(sizeof(sample) + sizeof(double) * (size_t)(p->arm.links + 1));
    if (bytes > MEMORY_BUDGET) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "%g s in steps of %g s would keep %.0f MiB of rows, the lab keeps at most "
                         "%.0f: shorten run.duration or lengthen method.step",
                         p->run.duration, p->method.step, bytes / (1024 * 1024),
                         MEMORY_BUDGET / (1024 * 1024));
    }
    return STATUS_OK;
}

// Computes the run with the inputs in effect. On failure the present run stays.
static status compute(session *s, fault *f)
{
    scenario effective;
    run_result run;
    status code = build_effective(s, &effective, f);
    if (code == STATUS_OK) {
        code = check_memory(&effective.parameters, f);
    }
    if (code != STATUS_OK) {
        free(effective.actions);
        return code;
    }
    // a run that diverges is worth looking at; one without a single row is not
    run_scenario(&effective, true, &run);
    if (run.trace.row_count == 0) {
        fault_set(f, run.summary.status, "%s", run.summary.message);
        run_finish(&run);
        free(effective.actions);
        return run.summary.status == STATUS_OK ? STATUS_NO_MEMORY : run.summary.status;
    }
    run_finish(&s->run);
    free(s->effective.actions);
    s->run = run;
    s->effective = effective;
    s->version++;
    session_seek(s, s->now);
    s->seen = s->now;
    return STATUS_OK;
}

status session_init(session *s, scenario *base, fault *f)
{
    memset(s, 0, sizeof *s);
    s->base = *base;
    status code = compute(s, f);
    if (code != STATUS_OK) {
        session_finish(s);
    }
    return code;
}

void session_finish(session *s)
{
    session_forget_other(s);
    run_finish(&s->run);
    free(s->effective.actions);
    free(s->inputs);
    scenario_finish(&s->base);
    memset(s, 0, sizeof *s);
}

// --- the cursor -------------------------------------------------------------------------------

const sample *session_sample(const session *s)
{
    return &s->run.trace.rows[s->row];
}

double session_end(const session *s)
{
    return s->run.trace.rows[s->run.trace.row_count - 1].time;
}

void session_seek(session *s, double time)
{
    double end = session_end(s);
    s->now = time > end ? end : time > 0 ? time : 0;
    s->row = trace_row_at(&s->run.trace, s->now);
    s->seen = s->now > s->seen ? s->now : s->seen;
}

bool session_step(session *s, long rows)
{
    long last = (long)s->run.trace.row_count - 1, to = (long)s->row + rows;
    to = to < 0 ? 0 : to > last ? last : to;
    bool moved = to != (long)s->row;
    s->row = (size_t)to;
    s->now = session_sample(s)->time;
    s->seen = s->now > s->seen ? s->now : s->seen;
    return moved;
}

bool session_step_event(session *s, int direction)
{
    const trace *t = &s->run.trace;
    double found = -1;
    for (size_t i = 0; i < t->event_count; i++) {
        double time = t->events[i].time;
        if (direction > 0 && time > s->now) {
            found = time;
            break;
        }
        if (direction < 0 && time < s->now) {
            found = time;
        }
    }
    if (found >= 0) {
        session_seek(s, found);
    }
    return found >= 0;
}

const event *session_event(const session *s)
{
    for (size_t i = 0; i < s->run.trace.event_count; i++) {
        if (s->run.trace.events[i].time == s->now) {
            return &s->run.trace.events[i];
        }
    }
    return NULL;
}

parameters session_parameters_at(const session *s, double time)
{
    parameters p = s->effective.parameters;
    for (int i = 0; i < s->effective.action_count && s->effective.actions[i].time <= time; i++) {
        const action *a = &s->effective.actions[i];
        if (a->kind == ACTION_SET) {
            parameter_set_number(&p, a->parameter, a->value, NULL);
        }
    }
    return p;
}

// --- inputs -----------------------------------------------------------------------------------

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
    status code = compute(s, f);
    if (code != STATUS_OK) {
        s->inputs[--s->input_count] = replaced;
        return code;
    }
    s->input_total = s->input_count;
    return STATUS_OK;
}

status session_change(session *s, int parameter, const char *text, fault *f)
{
    session_input in = {.kind = INPUT_START, .time = s->now, .parameter = parameter};
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
        in.kind = INPUT_TIMED;
    }
    return add_input(s, &in, f);
}

status session_push(session *s, double impulse, fault *f)
{
    session_input in = {.kind = INPUT_PUSH, .time = s->now, .parameter = -1, .value = impulse};
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
    status code = compute(s, f);
    s->input_count += code != STATUS_OK;
    return code;
}

status session_redo(session *s, fault *f)
{
    if (s->input_count == s->input_total) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "nothing to redo");
    }
    s->input_count++;
    status code = compute(s, f);
    s->input_count -= code != STATUS_OK;
    return code;
}

status session_branch(session *s, fault *f)
{
    run_result kept = s->run;
    memset(&s->run, 0, sizeof s->run);
    double seen = s->seen;
    status code = compute(s, f);
    if (code != STATUS_OK) {
        s->run = kept;
        return code;
    }
    session_forget_other(s);
    s->other = kept;
    s->has_other = true;
    s->seen = seen;
    return STATUS_OK;
}

void session_forget_other(session *s)
{
    if (s->has_other) {
        run_finish(&s->other);
        s->has_other = false;
    }
}

// --- saving -----------------------------------------------------------------------------------

// A text between double quotes, as YAML reads it back.
static void write_quoted(FILE *stream, const char *text)
{
    fputc('"', stream);
    for (; *text; text++) {
        unsigned char c = (unsigned char)*text;
        if (c == '"' || c == '\\') {
            fprintf(stream, "\\%c", c);
        } else if (c == '\n') {
            fputs("\\n", stream);
        } else if (c < ' ') {
            fputc(' ', stream);
        } else {
            fputc(c, stream);
        }
    }
    fputc('"', stream);
}

static void write_value(FILE *stream, const parameters *p, int index)
{
    char text[256];
    parameter_format(p, index, text, sizeof text);
    if (parameter_table[index].type == PARAMETER_TEXT) {
        write_quoted(stream, text);
    } else {
        fputs(text, stream);
    }
}

// The parameters that were given, group by group.
static void write_parameters(const parameters *p, FILE *stream)
{
    const char *group = "";
    for (int i = 0; i < parameter_count; i++) {
        const char *path = parameter_table[i].path;
        size_t length = strcspn(path, ".");
        if (!p->set[i]) {
            continue;
        }
        if (strncmp(group, path, length + 1) != 0) {
            fprintf(stream, "%.*s:\n", (int)length, path);
            group = path;
        }
        fprintf(stream, "  %s: ", path + length + 1);
        write_value(stream, p, i);
        fputc('\n', stream);
    }
}

void session_write_scenario(const session *s, FILE *stream)
{
    const scenario *e = &s->effective;
    char number[NUMBER_TEXT];
    fputs("title: ", stream);
    write_quoted(stream, e->title ? e->title : "");
    if (e->description != NULL && e->description[0] != '\0') {
        fputs("\ndescription: ", stream);
        write_quoted(stream, e->description);
    }
    fputc('\n', stream);
    write_parameters(&e->parameters, stream);
    if (e->action_count > 0) {
        fputs("script:\n", stream);
    }
    for (int i = 0; i < e->action_count; i++) {
        const action *a = &e->actions[i];
        number_format(number, a->time);
        fprintf(stream, "  - at: %s\n", number);
        if (a->kind == ACTION_PUSH) {
            number_format(number, a->value);
            fprintf(stream, "    push: %s\n", number);
            continue;
        }
        parameters p = e->parameters;
        parameter_set_number(&p, a->parameter, a->value, NULL);
        fprintf(stream, "    set: {%s: ", parameter_table[a->parameter].path);
        write_value(stream, &p, a->parameter);
        fputs("}\n", stream);
    }
}
