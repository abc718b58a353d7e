#include "ui/explorer/state/run_list.h"

#include <assert.h>
#include <glib.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "src/base/text_stream.h"
#include "src/run/resume.h"
#include "ui/explorer/state/shown_parameters.h"

// --- pinned runs -----------------------------------------------------------------------

static bool has_input(const session_input *inputs, int count, const session_input *wanted)
{
    for (int i = 0; i < count; i++) {
        if (session_same_input(&inputs[i], wanted)) {
            return true;
        }
    }
    return false;
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
static void write_input(const session_input *in, char *text, size_t size)
{
    if (in->kind == SESSION_INPUT_PUSH) {
        snprintf(text, size, "push %g at %.4g s", in->value, in->time);
        return;
    }
    const char *name = strchr(parameter_table[in->parameter].path, '.') + 1;
    char value[SESSION_INPUT_TEXT];
    input_value_text(in, value);
    if (in->kind == SESSION_INPUT_TIMED) {
        snprintf(text, size, "%s %s from %.4g s", name, value, in->time);
    } else {
        snprintf(text, size, "%s %s", name, value);
    }
}

// Appends the changes of one list that another one does not have.
static void append_others(const session_input *of, int count, const session_input *other,
                          int other_count, char *text, size_t size)
{
    const char *separator = "";
    for (int i = 0; i < count; i++) {
        if (has_input(other, other_count, &of[i])) {
            continue;
        }
        char one[SESSION_INPUT_TEXT + 80];
        write_input(&of[i], one, sizeof one);
        text_add(text, size, "%s%s", separator, one);
        separator = ", ";
    }
}

void run_list_differences(const pinned_run *p, const session *s, char *text, size_t size)
{
    assert(size > 0);
    const run_origin *o = &p->from;
    text[0] = '\0';

    // of another scenario its name and changes
    if (!same_base(&o->base, &s->base)) {
        text_add(text, size, "of %s", o->base.name);
        if (o->input_count > 0) {
            text_add(text, size, ": ");
        }
        append_others(o->inputs, o->input_count, NULL, 0, text, size);
        return;
    }

    // the changes that it has, then those that the present run has
    char here[256] = "";
    append_others(o->inputs, o->input_count, s->inputs, s->input_count, text, size);
    append_others(s->inputs, s->input_count, o->inputs, o->input_count, here,
                  sizeof here);
    if (here[0] != '\0') {
        const char *blank = text[0] != '\0' ? " " : "";
        text_add(text, size, "%s(now: %s)", blank, here);
    } else if (text[0] == '\0') {
        text_add(text, size, "the same");
    }
}

const char *scenario_leaf(const char *name)
{
    const char *slash = strrchr(name, '/');
    if (slash != NULL) {
        return slash + 1;
    }
    return name;
}

static bool has_name(const run_list *list, const char *name)
{
    for (int i = 0; i < list->count; i++) {
        if (strcmp(list->runs[i].name, name) == 0) {
            return true;
        }
    }
    return false;
}

void run_list_describe(const session *s, char *text, size_t size)
{
    // the last change describes best what is new
    if (s->input_count > 0) {
        write_input(&s->inputs[s->input_count - 1], text, size);
    } else {
        snprintf(text, size, "%s", AS_OPENED);
    }
}

// A name for the present run that no other of the list has.
static void propose_run_name(const run_list *list, const session *s, char name[RUN_NAME])
{
    char text[RUN_NAME - 16];
    run_list_describe(s, text, sizeof text);
    if (s->input_count == 0 && run_list_of_scenario(list, s) < list->count) {
        snprintf(text, sizeof text, "%s", scenario_leaf(s->base.name));
    }

    // a number follows where that name is taken
    snprintf(name, RUN_NAME, "%s", text);
    for (int n = 2; has_name(list, name) && n <= 100; n++) {
        snprintf(name, RUN_NAME, "%s (%d)", text, n);
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
            if (name[0] != '\0') {
                snprintf(list->runs[i].name, RUN_NAME, "%s", name);
            }
            return STATUS_OK;
        }
    }
    FAULT_IF(list->count == PINNED_RUNS, f, STATUS_BAD_ARGUMENT,
             "%d runs are pinned already: R lists them, d there drops one", PINNED_RUNS);

    // the rows are shared, the changes are copied
    snprintf(p.name, sizeof p.name, "%s", name);
    if (name[0] == '\0') {
        propose_run_name(list, s, p.name);
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
    } else if (list->baseline > index) {
        list->baseline--;
    }

    // the selection stays within the list
    if (list->selected > 0 && list->selected >= list->count) {
        list->selected--;
    }
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
    const int across = (int)sweep->axis.count;
    if (lab_sweep_is_map(sweep)) {
        return across * (int)sweep->second.count;
    }
    return across;
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
    values[0] = sweep_axis_value(&sweep->axis, (size_t)(index % across));
    if (lab_sweep_is_map(sweep)) {
        values[1] = sweep_axis_value(&sweep->second, (size_t)(index / across));
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
    g_free(sweep->summaries);
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
    const char *second = text_cut(definition, " ", first, sizeof first);
    TRY(read_axis(&fresh->axis, first, f));
    size_t most = SWEPT_RUNS;
    if (*second != '\0') {
        most = MAP_CELLS;
        TRY(read_axis(&fresh->second, second, f));
    }

    // in floating point, since two long ranges have more runs than an integer holds
    double runs = (double)fresh->axis.count;
    if (lab_sweep_is_map(fresh)) {
        runs *= (double)fresh->second.count;
    }
    FAULT_IF(
        runs > (double)most, f, STATUS_BAD_ARGUMENT,
        "%.9g runs are too many here, at most %zu: 'impactlab sweep' takes any number",
        runs, most);
    FAULT_IF(lab_sweep_is_map(fresh) && fresh->axis.parameter == fresh->second.parameter,
             f, STATUS_BAD_ARGUMENT, "a map takes two different parameters");
    fresh->summaries = g_new0(summary, (size_t)runs);
    return STATUS_OK;
}

status lab_sweep_begin(lab_sweep *sweep, const char *definition, fault *f)
{
    lab_sweep fresh = {.metric = sweep->metric, .computed = sweep->computed};
    const status code = read_sweep(&fresh, definition, f);
    if (code != STATUS_OK) {
        lab_sweep_end(&fresh);
        return code;
    }
    lab_sweep_end(sweep);
    *sweep = fresh;
    return STATUS_OK;
}

// The scenario of a sweep's next run: all but the swept parameters is the present run's.
static status next_scenario(const lab_sweep *sweep, const scenario *base, scenario *next,
                            fault *f)
{
    parameters *p = &next->parameters;
    double values[2];
    lab_sweep_values(sweep, sweep->count, values);
    *next = *base;
    TRY(parameter_set_number(p, sweep->axis.parameter, values[0], f));
    if (lab_sweep_is_map(sweep)) {
        TRY(parameter_set_number(p, sweep->second.parameter, values[1], f));
    }
    return parameters_resolve(p, f);
}

status lab_sweep_compute_next(lab_sweep *sweep, const scenario *base, fault *f)
{
    assert(!lab_sweep_is_done(sweep));
    const bool map = lab_sweep_is_map(sweep);
    scenario s;
    run_result run = {0};
    status code = next_scenario(sweep, base, &s, f);
    if (code == STATUS_OK) {
        run_scenario(&s, !map, &run);
        loss_unless(run.summary.status != STATUS_NO_MEMORY);
        if (!map && run.trace.row_count == 0) {
            code = summary_fault(&run.summary, f);
        }
    }
    if (code != STATUS_OK) {
        lab_sweep_end(sweep);
        run_finish(&run);
        return code;
    }

    // of a map the summary alone is kept
    sweep->summaries[sweep->count] = run.summary;
    if (map) {
        run_finish(&run);
    } else {
        const double value = sweep_axis_value(&sweep->axis, (size_t)sweep->count);
        sweep->runs[sweep->count] = (swept_run){value, run, ++sweep->computed};
    }
    sweep->count++;
    return STATUS_OK;
}

// --- the difference --------------------------------------------------------------------

void difference_finish(run_difference *d)
{
    trace_finish(&d->trace);
    *d = (run_difference){.built = d->built};
}

// Appends the difference of one row.
static status add_difference(run_difference *d, const trace *run, const trace *other,
                             size_t row)
{
    const sample *now = &run->rows[row];
    const sample beside = trace_sample_at(other, now->time, trace_side(run, row));

    // signal by signal; states stay this run's own, and the time is no difference
    sample difference = *now;
    for (int i = 0; i < SIGNALS_AT_MOST; i++) {
        if (!signal_is_state(i)) {
            ((double *)&difference)[i] -= ((const double *)&beside)[i];
        }
    }
    difference.time = now->time;
    const double none[1] = {0};
    return trace_add_row(&d->trace, &difference, none, none);
}

void difference_update(run_difference *d, unsigned long run, const trace *t,
                       const trace *other)
{
    if (!d->on || other->row_count == 0) {
        return;
    }

    // another run begins again, of one that grew the rest is added
    if (d->run != run || d->rows > t->row_count ||
        d->trace.arrays[TRACE_ROWS].size == 0) {
        trace_finish(&d->trace);
        trace_init(&d->trace, 1);
        d->built++;
        d->run = run;
        d->rows = 0;
    }

    // outside of the other one there is nothing to compare
    const double begin = other->rows[0].time;
    const double end = other->rows[other->row_count - 1].time;
    for (; d->rows < t->row_count; d->rows++) {
        const double time = t->rows[d->rows].time;
        if (time > end) {
            break;
        }
        if (time >= begin && add_difference(d, t, other, d->rows) != STATUS_OK) {
            break;
        }
    }
}

double difference_first_beyond(const run_difference *d, int signal, double tolerance)
{
    assert(signal >= 0 && signal < signal_count);
    const trace *t = &d->trace;
    for (size_t r = 0; r < t->row_count; r++) {
        if (fabs(signal_value(&t->rows[r], signal)) > tolerance) {
            return t->rows[r].time;
        }
    }
    return -1;
}
