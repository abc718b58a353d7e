#include "ui/explorer/state/run_list.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/text_stream.h"
#include "src/run/resume.h"
#include "ui/explorer/state/shown_parameters.h"

// --- pinned runs -----------------------------------------------------------------------

static bool has_input(const session_input *inputs, int count, const session_input *wanted)
{
    bool found = false;
    for (int i = 0; i < count; i++) {
        found = found || session_same_input(&inputs[i], wanted);
    }
    return found;
}

int run_list_of_scenario(const run_list *list, const session *s)
{
    int count = 0;
    for (int i = 0; i < list->count; i++) {
        if (same_base(&list->runs[i].from.base, &s->base)) {
            count++;
        }
    }
    return count;
}

void input_value_text(const session_input *in, char text[SESSION_INPUT_TEXT])
{
    assert(in->parameter >= 0);
    if (parameter_table[in->parameter].type == PARAMETER_REAL) {
        snprintf(text, SESSION_INPUT_TEXT, "%.10g", in->value);
    } else {
        memcpy(text, in->text, SESSION_INPUT_TEXT);
    }
}

// A change as a line of text: what it gives what, and from when on.
static void run_list_input_text(const session_input *in, char *text, size_t size)
{
    if (in->kind == SESSION_INPUT_PUSH) {
        snprintf(text, size, "push %g at %.4g s", in->value, in->time);
        return;
    }
    const char *name = strchr(parameter_table[in->parameter].path, '.') + 1;
    char value[SESSION_INPUT_TEXT];
    input_value_text(in, value);
    snprintf(text, size, in->kind == SESSION_INPUT_TIMED ? "%s %s from %.4g s" : "%s %s",
             name, value, in->time);
}

// Appends the changes of one list that another one does not have.
static void append_others(const session_input *of, int count, const session_input *other,
                          int other_count, char *text, size_t size)
{
    bool first = true;
    for (int i = 0; i < count; i++) {
        char one[SESSION_INPUT_TEXT + 80];
        if (!has_input(other, other_count, &of[i])) {
            run_list_input_text(&of[i], one, sizeof one);
            text_add(text, size, "%s%s", first ? "" : ", ", one);
            first = false;
        }
    }
}

void run_list_differences(const pinned_run *p, const session *s, char *text, size_t size)
{
    assert(size > 0);
    char here[256] = "";
    const run_origin *o = &p->from;
    text[0] = '\0';
    if (!same_base(&o->base, &s->base)) {
        snprintf(text, size, "of %s%s", o->base.name, o->input_count > 0 ? ": " : "");
        append_others(o->inputs, o->input_count, NULL, 0, text, size);
        return;
    }
    append_others(o->inputs, o->input_count, s->inputs, s->input_count, text, size);
    append_others(s->inputs, s->input_count, o->inputs, o->input_count, here,
                  sizeof here);
    if (here[0] != '\0') {
        text_add(text, size, "%s(now: %s)", text[0] ? " " : "", here);
    } else if (text[0] == '\0') {
        snprintf(text, size, "the same");
    }
}

#define AS_OPENED "as opened"

const char *scenario_leaf(const char *name)
{
    const char *slash = strrchr(name, '/');
    if (slash != NULL) {
        return slash + 1;
    }
    return name;
}

// A name for the present run that no other of the list has.
static void propose_name(const run_list *list, const session *s, char name[RUN_NAME])
{
    char text[SESSION_INPUT_TEXT + 80];
    snprintf(text, sizeof text, "%s",
             run_list_of_scenario(list, s) < list->count ? scenario_leaf(s->base.name)
                                                         : AS_OPENED);

    // the last change describes best what is new
    if (s->input_count > 0) {
        run_list_input_text(&s->inputs[s->input_count - 1], text, sizeof text);
    }

    // a number follows where that name is taken
    bool taken = true;
    for (int n = 1; taken && n <= 100; n++) {
        snprintf(name, RUN_NAME, n > 1 ? "%s (%d)" : "%s", text, n);
        taken = false;
        for (int i = 0; i < list->count; i++) {
            taken = taken || strcmp(list->runs[i].name, name) == 0;
        }
    }
}

void run_list_name_strangers(run_list *list, const session *s)
{
    for (int i = 0; i < list->count; i++) {
        pinned_run *p = &list->runs[i];
        if (strcmp(p->name, AS_OPENED) == 0 && !same_base(&p->from.base, &s->base)) {
            snprintf(p->name, sizeof p->name, "%s", scenario_leaf(p->from.base.name));
        }
    }
}

status run_list_pin(run_list *list, const session *s, const char *name, fault *f)
{
    pinned_run p = {.id = list->pinned + 1};

    // one of the same changes only becomes the baseline
    for (int i = 0; i < list->count; i++) {
        if (run_origin_is_of(&list->runs[i].from, s)) {
            list->baseline = list->selected = i;
            list->runs[i].hidden = false;
            return STATUS_OK;
        }
    }
    FAULT_IF(list->count == PINNED_RUNS, f, STATUS_BAD_ARGUMENT,
             "%d runs are pinned already: R lists them, d there drops one", PINNED_RUNS);

    // the rows are shared, the changes are copied
    snprintf(p.name, sizeof p.name, "%s", name);
    if (name[0] == '\0') {
        propose_name(list, s, p.name);
    }
    TRY(run_origin_take(&p.from, s, f));
    if (run_share(&s->run, &p.run) != STATUS_OK) {
        run_origin_finish(&p.from);
        return fault_no_memory(f);
    }
    list->pinned++;
    list->baseline = list->selected = list->count;
    list->runs[list->count++] = p;
    return STATUS_OK;
}

void run_list_drop(run_list *list, int index)
{
    assert(index >= 0 && index < list->count);
    run_finish(&list->runs[index].run);
    run_origin_finish(&list->runs[index].from);
    memmove(&list->runs[index], &list->runs[index + 1],
            (size_t)(list->count - index - 1) * sizeof list->runs[0]);
    list->count--;

    // without the baseline the last one takes its place
    if (list->baseline == index) {
        list->baseline = list->count - 1;
    } else {
        list->baseline = list->baseline - (list->baseline > index);
    }
    list->selected -= list->selected > 0 && list->selected >= list->count;
}

// --- a sweep ---------------------------------------------------------------------------

bool lab_sweep_is_on(const lab_sweep *sweep)
{
    return sweep->axis.text != NULL;
}

bool lab_sweep_is_map(const lab_sweep *sweep)
{
    return sweep->second.text != NULL;
}

int lab_sweep_total(const lab_sweep *sweep)
{
    return (int)sweep->axis.count *
           (lab_sweep_is_map(sweep) ? (int)sweep->second.count : 1);
}

bool lab_sweep_is_done(const lab_sweep *sweep)
{
    return !lab_sweep_is_on(sweep) || sweep->count == lab_sweep_total(sweep);
}

int lab_sweep_curves(const lab_sweep *sweep)
{
    if (lab_sweep_is_map(sweep)) {
        return 0;
    }
    return sweep->count;
}

double lab_sweep_metric(const lab_sweep *sweep, int index, int metric)
{
    assert(index >= 0 && index < sweep->count);
    return summary_value(&sweep->summaries[index], metric);
}

void lab_sweep_values(const lab_sweep *sweep, int index, double values[2])
{
    const int across = (int)sweep->axis.count;
    assert(index >= 0 && index < lab_sweep_total(sweep));
    values[0] = sweep->axis.values[index % across];
    if (lab_sweep_is_map(sweep)) {
        values[1] = sweep->second.values[index / across];
    } else {
        values[1] = (double)NAN;
    }
}

void lab_sweep_end(lab_sweep *sweep)
{
    for (int i = 0; i < lab_sweep_curves(sweep); i++) {
        run_finish(&sweep->runs[i].run);
    }
    sweep_axis_finish(&sweep->axis);
    sweep_axis_finish(&sweep->second);
    free(sweep->summaries);
    sweep->axis = sweep->second = (sweep_axis){0};
    sweep->summaries = NULL;
    sweep->count = sweep->selected = 0;
}

// Reads PATH=VALUES, the values as --vary has them.
static status read_axis(sweep_axis *axis, const char *definition, fault *f)
{
    char text[256];
    snprintf(text, sizeof text, "%s", definition);
    char *values = strchr(text, '=');
    FAULT_IF(values == NULL, f, STATUS_BAD_ARGUMENT,
             "sweep takes PATH=FROM:TO:N or PATH=V1,V2,..., such as "
             "control.rate=50:400:8, and for a map two of them");
    *values++ = '\0';
    axis->parameter = parameter_of_name(text);
    FAULT_IF(axis->parameter == -2, f, STATUS_BAD_ARGUMENT,
             "several parameters begin with '%s'", text);
    if (axis->parameter < 0) {
        parameter_look_up(text, f);
        return STATUS_BAD_ARGUMENT;
    }
    return sweep_axis_parse(axis, values, false, f);
}

// Reads the axes of a sweep, and makes room for what its runs come to.
static status read_sweep(lab_sweep *fresh, const char *definition, fault *f)
{
    char first[256];
    const char *rest = text_cut(definition, " ", first, sizeof first);
    const bool map = *rest != '\0';
    TRY(read_axis(&fresh->axis, first, f));
    if (map) {
        TRY(read_axis(&fresh->second, rest, f));
    }
    const size_t runs = fresh->axis.count * (map ? fresh->second.count : 1);
    const size_t most = map ? MAP_CELLS : SWEPT_RUNS;
    FAULT_IF(
        runs > most, f, STATUS_BAD_ARGUMENT,
        "%zu runs are too many here, at most %zu: 'impactlab sweep' takes any number",
        runs, most);
    FAULT_IF(map && fresh->axis.parameter == fresh->second.parameter, f,
             STATUS_BAD_ARGUMENT, "a map takes two different parameters");
    fresh->summaries = calloc(runs, sizeof *fresh->summaries);
    if (fresh->summaries == NULL) {
        return fault_no_memory(f);
    }
    return STATUS_OK;
}

status lab_sweep_begin(lab_sweep *sweep, const char *definition, fault *f)
{
    lab_sweep fresh = {.metric = sweep->metric, .computed = sweep->computed};
    const status code = read_sweep(&fresh, definition, f);
    lab_sweep_end(code == STATUS_OK ? sweep : &fresh);
    if (code == STATUS_OK) {
        *sweep = fresh;
    }
    return code;
}

status lab_sweep_compute_next(lab_sweep *sweep, const scenario *base, fault *f)
{
    assert(!lab_sweep_is_done(sweep));
    const bool map = lab_sweep_is_map(sweep);
    const sweep_axis *axes[] = {&sweep->axis, &sweep->second};
    double values[2];
    run_result run = {0};
    lab_sweep_values(sweep, sweep->count, values);

    // everything but the parameters is the present run's
    scenario s = *base;
    status code = STATUS_OK;
    for (int i = 0; i <= map && code == STATUS_OK; i++) {
        code = parameter_set_number(&s.parameters, axes[i]->parameter, values[i], f);
    }
    if (code == STATUS_OK) {
        code = parameters_resolve(&s.parameters, f);
    }
    if (code == STATUS_OK) {
        run_scenario(&s, !map, &run);
        loss_unless(run.summary.status != STATUS_NO_MEMORY);
        if (map || run.trace.row_count > 0) {
            code = STATUS_OK;
        } else {
            code = summary_fault(&run.summary, f);
        }
    }

    // of a map the summary alone is kept
    const bool kept = code == STATUS_OK && !map;
    if (kept) {
        sweep->runs[sweep->count] = (swept_run){values[0], run, ++sweep->computed};
    }
    if (code == STATUS_OK) {
        sweep->summaries[sweep->count++] = run.summary;
    } else {
        lab_sweep_end(sweep);
    }
    if (!kept) {
        run_finish(&run);
    }
    return code;
}

// --- the difference --------------------------------------------------------------------

void difference_finish(run_difference *d)
{
    trace_finish(&d->trace);
    *d = (run_difference){.built = d->built};
}

// Appends the difference of one row.
static status add_row(run_difference *d, const trace *run, const trace *other, size_t row)
{
    const double none[1] = {0};

    const sample *now = &run->rows[row];
    const sample beside = trace_sample_at(other, now->time, trace_side(run, row));

    // signal by signal; states stay this run's own
    sample difference = *now;
    for (int i = 0; i < SIGNALS_AT_MOST; i++) {
        if (!signal_is_state(i)) {
            ((double *)&difference)[i] -= ((const double *)&beside)[i];
        }
    }

    // the time is no difference
    difference.time = now->time;
    return trace_add_row(&d->trace, &difference, none, none);
}

void difference_update(run_difference *d, unsigned long run, const trace *t,
                       const trace *other)
{
    if (!d->on || other->row_count == 0) {
        return;
    }

    // of another run everything is computed anew, of one that grew the rest
    if (d->run != run || d->rows > t->row_count ||
        d->trace.arrays[TRACE_ROWS].size == 0) {
        trace_finish(&d->trace);
        trace_init(&d->trace, 1);
        d->built++;
        d->run = run;
        d->rows = 0;
    }
    const double begin = other->rows[0].time,
                 end = other->rows[other->row_count - 1].time;
    for (; d->rows < t->row_count; d->rows++) {
        // outside of the other one there is nothing to compare
        const double time = t->rows[d->rows].time;
        if (time > end || (time >= begin && add_row(d, t, other, d->rows) != STATUS_OK)) {
            break;
        }
    }
}

double difference_first_beyond(const run_difference *d, int signal, double tolerance)
{
    const trace *t = &d->trace;
    size_t r = 0;
    assert(signal >= 0 && signal < signal_count);
    while (r < t->row_count && !(fabs(signal_value(&t->rows[r], signal)) > tolerance)) {
        r++;
    }
    if (r < t->row_count) {
        return t->rows[r].time;
    }
    return -1;
}
