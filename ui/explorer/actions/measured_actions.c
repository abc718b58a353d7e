// Actions on measured data, which are laid under the run.
#include "ui/explorer/actions/actions.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

#include <glib.h>

#include "src/run/trace.h"

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
    data_reading *r = model->reading;
    if (r == NULL || !act_wait_for(&r->done, patience)) {
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
