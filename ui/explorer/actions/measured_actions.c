// Actions on measured data: laid under the run, and an arm found that moves like it.
#include "ui/explorer/actions/actions.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

#include <glib.h>

#include "src/run/trace.h"
#include "src/study/identify/identify.h"

// --- under the run ---------------------------------------------------------------------

// A file that is read in a thread of its own, as that may take seconds.
struct data_reading {
    GThread *thread;
    int done; // set when all below is there
    char path[LINE_TEXT];
    double rate;     // by which numbers of samples are divided [1/s]
    double shift;    // by which the rows are to lie later [s], NaN: aligned
    bool plays;      // the run is to play their command
    trace rows;      // what was read
    size_t in_table; // rows of the file
    char digest[SHA256_TEXT];
    status code;
    fault fault;
};

// The thread: reads the table's columns.
static gpointer read_table(gpointer of)
{
    enum { MOST_ROWS = 200000 }; // kept
    data_reading *r = of;
    csv_table table = {0};
    trace_init(&r->rows, 1);
    r->code = csv_table_read(&table, r->path, 1, &r->fault);
    if (r->code == STATUS_OK) {
        r->code =
            measured_rows(&r->rows, &table, r->rate, NULL, -1, MOST_ROWS, &r->fault);
        r->in_table = table.rows;
    }
    csv_table_finish(&table);
    if (r->code == STATUS_OK) {
        outside_file_digest(r->path, r->digest);
    }
    g_atomic_int_set(&r->done, 1);
    return NULL;
}

void data_reading_finish(data_reading *r)
{
    if (r != NULL) {
        g_thread_join(r->thread);
        trace_finish(&r->rows);
        g_free(r);
    }
}

// Whether the recording had another command than the run, on average by more than a
// fiftieth of the largest, where both are known.
static bool commands_differ(const explorer_model *model)
{
    enum { LOOKED_AT = 200, SHARE = 50 };
    const session *s = &model->session;
    const trace *data = &model->measured, *run = &s->run.trace;
    const int command = SIGNAL_INDEX(command);
    const bool has_law = trace_has(run, command);
    double sum = 0, largest = 0;
    int count = 0;
    for (size_t r = 0; r < data->row_count; r += data->row_count / LOOKED_AT + 1) {
        const sample *row = &data->rows[r];
        if (!isfinite(row->command) || row->time < 0 || row->time > session_end(s)) {
            continue;
        }
        double own = session_parameters_at(s, row->time).motor.voltage;
        if (has_law) {
            own = run->rows[trace_row_at(run, row->time)].command;
        }
        sum += fabs(row->command - own);
        largest = fmax(largest, fmax(fabs(own), fabs(row->command)));
        count++;
    }
    return count > 0 && sum > largest * count / SHARE;
}

// Lets the run play the command of the measured data, on their clock: from the start, as
// changes of its own.
static status play_measured(explorer_model *model, fault *f)
{
    session *s = &model->session;
    parameters p = s->effective.parameters;
    const int plays[] = {PARAMETER_INDEX(control.playback_file),
                         PARAMETER_INDEX(control.playback_column),
                         PARAMETER_INDEX(control.playback_shift),
                         PARAMETER_INDEX(control.law)};
    const double shift = 0 - model->measured.rows[0].time;
    FAULT_IF(!trace_has(&model->measured, SIGNAL_INDEX(command)), f, STATUS_BAD_ARGUMENT,
             "the recording has no column 'command' that a run could play");
    const unsigned gesture = session_new_gesture(s);
    const int before = s->input_count;
    TRY(parameter_set_text(&p, plays[0], model->measured_file, f));
    TRY(parameter_set_text(&p, plays[1], "command", f));
    TRY(parameter_set_number(&p, plays[2], shift, f));
    TRY(parameter_set_number(&p, plays[3], LAW_PLAYBACK, f));
    for (size_t i = 0; i < sizeof plays / sizeof plays[0]; i++) {
        TRY(session_change_from_start(s, &p, plays[i], f));
    }

    // one undo takes them all back
    for (int i = before; i < s->input_count; i++) {
        s->inputs[i].gesture = gesture;
    }
    model_lay_data(model, shift);
    return STATUS_OK;
}

// Cuts the word off the end of a text that asks for the command to be played.
static bool cut_play(char *path)
{
    char *word = strrchr(path, ' ');
    const bool plays = word != NULL && strcmp(word, " play") == 0;
    if (plays) {
        *word = '\0';
    }
    return plays;
}

// Says what was read, and what is to be known of it.
static bool tell_data(const explorer_model *model, explorer_input *input, size_t in_table,
                      bool laid)
{
    const size_t rows = model->measured.row_count;
    char kept[80] = "";
    if (rows < in_table) {
        snprintf(kept, sizeof kept, ", of which %zu with all peaks are kept", rows);
    }
    if (!laid) {
        return act_warn(input,
                        "%zu rows%s, as they are: no force in both that shows a touch",
                        in_table, kept);
    }
    const char *advice = ":data off takes them away";
    if (commands_differ(model)) {
        advice = "their command was another than the run's: 'play' behind the file lets "
                 "it play theirs";
    }
    return act_tell(input, "%zu rows%s, shifted by %.6g s; %s", in_table, kept,
                    model->measured_shift, advice);
}

// Lays what was read under the run, in the place of the data there were.
static bool take_data(explorer_model *model, explorer_input *input, data_reading *r)
{
    if (r->code != STATUS_OK) {
        input->fault = r->fault;
        return act_succeeded(input, r->code);
    }
    trace_finish(&model->measured);
    model->measured = r->rows;
    r->rows = (trace){0};
    model->measured_shift = 0;
    model->measured_id++;
    snprintf(model->measured_file, sizeof model->measured_file, "%s", r->path);
    memcpy(model->measured_digest, r->digest, sizeof r->digest);
    if (r->plays) {
        return act_succeeded(input, play_measured(model, &input->fault)) &&
               act_tell(input, "%zu rows, whose command the run plays on their clock",
                        r->in_table);
    }
    const bool laid = model_lay_data(model, r->shift);
    return tell_data(model, input, r->in_table, laid);
}

bool act_take_data(explorer_model *model, explorer_input *input, double patience)
{
    enum { STEP = 1000 }; // [us]
    data_reading *r = model->reading;
    for (double waited = 0; r != NULL && waited < patience; waited += 1e-6 * STEP) {
        if (g_atomic_int_get(&r->done)) {
            break;
        }
        g_usleep(STEP);
    }
    if (r == NULL || !g_atomic_int_get(&r->done)) {
        return true;
    }
    model->reading = NULL;
    const bool done = take_data(model, input, r);
    data_reading_finish(r);
    return done;
}

// Begins to read a file, and takes it if that is done soon.
static bool read_data(explorer_model *model, explorer_input *input, const char *path,
                      double shift, bool plays)
{
    data_reading *r = g_new0(data_reading, 1);
    *r = (data_reading){.shift = shift,
                        .plays = plays,
                        .rate = model->session.effective.parameters.control.rate};
    g_strlcpy(r->path, path, sizeof r->path);
    r->thread = g_thread_new("data", read_table, r);
    model->reading = r;
    act_tell(input, "reading %.200s; the lab goes on meanwhile", path);
    return act_take_data(model, input, model->session.patience);
}

bool act_reload(explorer_model *model, explorer_input *input)
{
    if (model->measured.row_count == 0) {
        return act_refuse(input, "there are no measured data: :data FILE.csv");
    }
    char path[LINE_TEXT];
    snprintf(path, sizeof path, "%s", model->measured_file);
    const double shift = model->measured_aligned ? (double)NAN : model->measured_shift;
    act_take_data(model, input, HUGE_VAL);
    return read_data(model, input, path, shift, false);
}

// Measured columns under the run, shifted as FILE@SHIFT says, else to the run's first
// touch.
bool act_data(explorer_model *model, explorer_input *input, const char *argument)
{
    if (argument[0] == '\0') {
        return act_refuse(
            input, "data takes a table with a column time, such as bench.csv, or off");
    }

    // one after the other
    act_take_data(model, input, HUGE_VAL);
    if (strcmp(argument, "off") == 0) {
        trace_finish(&model->measured);
        model->measured = (trace){0};
        return act_tell(input, "no measured data");
    }
    if (!act_need_whole_run(model, input)) {
        return false;
    }

    // the file, and by how much it is shifted
    char path[LINE_TEXT];
    double shift = (double)NAN;
    snprintf(path, sizeof path, "%s", argument);
    const bool plays = cut_play(path);
    char *at = strrchr(path, '@');
    if (at != NULL && access(path, F_OK) != 0) {
        if (!act_read_number(input, at + 1, &shift)) {
            return false;
        }
        *at = '\0';
    }
    return read_data(model, input, path, shift, plays);
}

// --- identification --------------------------------------------------------------------

enum { FIT_STARTS = 12, FIT_THREADS = 4, FIT_RUNS = 600 };

// Writes a fitted value with its error, or that it is not determined.
static void write_fit(const fitted_parameter *fit, char *text, size_t size)
{
    text_add(text, size, "%s", strchr(fit->axis.name, '.') + 1);
    if (!fit->determined) {
        text_add(text, size, " is not determined");
    } else if (identify_at_end(fit)) {
        text_add(text, size, " %.5g, at the end of its range", fit->value);
    } else {
        const char *unit = sweep_axis_parameter(&fit->axis)->unit;
        const char *blank = unit[0] ? " " : "";
        text_add(text, size, " %.5g +- %.2g%s%s", fit->value, fit->standard_error, blank,
                 unit);
    }
}

// Says what was found, and what to think of it.
static bool tell_fit(explorer_input *input, const identification *id)
{
    char text[MESSAGE_TEXT / 2] = "";
    for (int i = 0; i < id->count; i++) {
        if (i > 0) {
            text_add(text, sizeof text, "; ");
        }
        write_fit(&id->fit[i], text, sizeof text);
    }

    // the fit as a whole
    if (id->undetermined > 0) {
        return act_tell(input, "%s: fit fewer, or record more", text);
    }
    double most;
    if (identify_misfit(id, &most) > most) {
        return act_tell(input, "%s; pinned, but far off the data", text);
    }
    if (!identify_settled(id)) {
        return act_tell(input, "%s; pinned, but other starts may end better", text);
    }
    if (id->white) {
        return act_tell(input, "%s; that run is pinned", text);
    }
    return act_tell(input, "%s; pinned, but the data show more than the model has", text);
}

// Pins the run that was compared with the data in the end, and lays these under it.
static status pin_fitted(explorer_model *model, const identification *id, fault *f)
{
    scenario fitted, copy;
    session other;
    const recorded_trace *t = &id->traces[0];
    TRY(identify_scenario(id, 0, &fitted, f));
    TRY(scenario_copy(&copy, &fitted));
    TRY(session_open(&other, &copy, HUGE_VAL, f));
    const status code = run_list_pin(&model->pinned, &other, "identified", f);
    session_finish(&other);
    if (code == STATUS_OK) {
        model_lay_data(model, -(t->begin + t->own[OWN_SHIFT]));
    }
    return code;
}

// Fits the parameters of a line to the measured data and pins the run that they give, if
// any is determined.
static status fit_and_pin(explorer_model *model, identification *id, const char *names,
                          fault *f)
{
    TRY(identify_available(f));

    // a parameter may be given by the last part of its path
    char words[LINE_TEXT], *rest = words, *word;
    snprintf(words, sizeof words, "%s", names);
    while ((word = strtok_r(rest, " ", &rest)) != NULL) {
        char path[2 * LINE_TEXT];
        TRY(identify_add_path(id, act_full_path(word, path, sizeof path), f));
    }
    TRY(identify_add_trace(id, model->measured_file, NULL, 0, f));
    TRY(identify_fit(id, f));
    for (int i = 0; i < id->count; i++) {
        if (id->fit[i].determined) {
            return pin_fitted(model, id, f);
        }
    }
    return STATUS_OK;
}

bool act_identify(explorer_model *model, explorer_input *input, const char *argument)
{
    if (argument[0] == '\0') {
        return act_refuse(input, "identify takes parameters, such as k2 stiction");
    }
    if (model->measured.row_count == 0) {
        return act_refuse(input, "there are no measured data: :data FILE.csv");
    }
    if (!act_need_whole_run(model, input) ||
        !act_need_short_runs(model, input, "identify", FIT_RUNS)) {
        return false;
    }
    identification id = {.base = &model->session.effective,
                         .starts = FIT_STARTS,
                         .jobs = FIT_THREADS};
    const status code = fit_and_pin(model, &id, argument, &input->fault);
    const bool done = act_succeeded(input, code) && tell_fit(input, &id);
    const bool all_determined = id.undetermined == 0;
    identify_finish(&id);
    return done && act_apply_baseline(model, input) && all_determined;
}
