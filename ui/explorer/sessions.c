// Sessions: what one did, kept in a file and gone on with.
#include <math.h>
#include <stdarg.h>
#include <string.h>
#include <unistd.h>

#include "src/base/numbers.h"
#include "src/base/text_stream.h"
#include "src/base/whole_file.h"
#include "src/base/words.h"
#include "src/session/session_file.h"
#include "ui/explorer/explorer.h"

// --- saving ----------------------------------------------------------------------------

// Adds a line on how the runs are looked at, if it is needed.
static void add_line(session_file *file, bool needed, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static void add_line(session_file *file, bool needed, const char *format, ...)
{
    const bool adds = needed && file->line_count < SESSION_FILE_LINES;
    va_list list;
    va_start(list, format);
    char *line = adds ? decimal_vtext(format, list) : NULL;
    va_end(list);
    loss_unless(line != NULL || !adds);
    if (line != NULL) {
        file->lines[file->line_count++] = line;
    }
}

// A pane's own lines; `number` is the one it has where only panes that are shown are
// defined.
static void add_pane(const explorer_model *model, const explorer_view *view,
                     session_file *file, int index, int number)
{
    static const char *const views[] = {"trace", "phase", "residual", "spectrum"};
    const pane *p = &view->panes.pane[index];
    char signals[PANE_SIGNALS * (LINE_TEXT + 1)] = "";
    for (int k = 0; k < p->count; k++) {
        text_add(signals, sizeof signals, "%s%s", k > 0 ? "," : " ",
                 signal_table[p->signals[k]].name);
    }
    add_line(file, index >= PANES_OF_TABLE && p->shown, "%s%s", views[p->view], signals);

    // axes and hidden signals of what can be shown again; a lesson hides signals of its
    // own
    const bool again = p->count > 0 && (index < PANES_OF_TABLE || p->shown);
    const bool fixed = p->scaling == AXIS_FIXED;
    add_line(file, again && fixed, "axis %.17g %.17g %d", p->fixed.low, p->fixed.high,
             number);
    add_line(file, again && !fixed && p->scaling != AXIS_AUTO, "axis %s %d",
             axis_scaling_words[p->scaling], number);
    add_line(file, again && (p->hidden != 0 || model->lesson.on), "signal all %d",
             number);
    for (int k = 0; k < p->count; k++) {
        add_line(file, again && (p->hidden >> k & 1), "signal %s %d",
                 signal_table[p->signals[k]].name, number);
    }
}

// How the runs are looked at, as the lines that give it again.
static void add_looks(const explorer_model *model, const explorer_view *view,
                      session_file *file)
{
    char shown[PANES + 1] = "";
    for (int i = 0; i < PANES_OF_TABLE; i++) {
        if (view->panes.pane[i].shown) {
            text_add(shown, sizeof shown, "%d", i + 1);
        }
    }
    add_line(file, true, "lanes %s", look_word(&view->looks, look_choice_of("lanes")));
    add_line(file, view->panes.chosen, "panes %s", shown);
    for (int i = 0, number = 1; i < PANES; i++) {
        add_pane(model, view, file, i, number);
        if (i < PANES_OF_TABLE || view->panes.pane[i].shown) {
            number++;
        }
    }
    const time_window *w = &view->window;
    const int band = model->band.signal, limit = model->limit.signal;
    add_line(file, w->to > w->from, "zoom %.17g %.17g", w->from, w->to);
    for (int i = 0; i < model->note_count; i++) {
        add_line(file, true, "note @%.17g %.200s", model->notes[i].time,
                 model->notes[i].text);
    }
    add_line(file, view->looks.by_run, "colourby run");
    if (band >= 0) {
        add_line(file, true, "band %s %.17g", signal_table[band].name, model->band.bound);
    }
    if (limit >= 0) {
        add_line(file, true, "limit %s %.17g", signal_table[limit].name,
                 model->limit.bound);
    }
    add_line(file, view->mark.set, "mark %.17g", view->mark.time);
}

// A line that could not be typed could not be carried out again.
static status check_lines(const session_file *file, fault *f)
{
    for (int i = 0; i < file->line_count; i++) {
        const size_t length = strlen(file->lines[i]);
        FAULT_IF(length >= LINE_TEXT, f, STATUS_CANNOT_WRITE,
                 "'%.40s...' takes %zu bytes in a session, expected at most %d: show "
                 "fewer signals in a pane",
                 file->lines[i], length, LINE_TEXT - 1);
    }
    return STATUS_OK;
}

status explorer_write_session(const explorer_model *model, const explorer_view *view,
                              FILE *stream, fault *f)
{
    static session_file file;
    const run_list *pins = &model->pinned;
    file = (session_file){.run_count = 1 + pins->count, .baseline = pins->baseline};
    TRY(run_origin_take(&file.runs[0].from, &model->session, f));

    // the pinned runs stay the list's: nothing of them is freed here
    for (int i = 0; i < pins->count; i++) {
        kept_run *k = &file.runs[i + 1];
        *k = (kept_run){.hidden = pins->runs[i].hidden, .from = pins->runs[i].from};
        snprintf(k->name, sizeof k->name, "%s", pins->runs[i].name);
    }
    add_looks(model, view, &file);
    const status code = check_lines(&file, f);
    if (code == STATUS_OK) {
        session_file_write(stream, &file);
    }
    file.run_count = 1;
    session_file_finish(&file);
    return code;
}

static status write_session(const explorer_model *model, const explorer_view *view,
                            const char *path, fault *f)
{
    whole_file file;
    TRY(whole_file_open(&file, path, f));
    return whole_file_close(&file, explorer_write_session(model, view, file.stream, f),
                            f);
}

bool explorer_save_session(explorer_model *model, const explorer_view *view,
                           explorer_input *input, const char *path)
{
    // a file is replaced only if it is the one this visit goes on with
    if (access(path, F_OK) == 0 && strcmp(path, model->session_path) != 0) {
        return act_refuse(input, "%.200s is there already: give the session another name",
                          path);
    }
    if (!(act_need_whole_run(model, input) &&
          act_succeeded(input, write_session(model, view, path, &input->fault)))) {
        return false;
    }
    snprintf(model->session_path, sizeof model->session_path, "%s", path);
    model->saved_version = model_run_id(model);
    model->kept_pins = model->pinned.pinned;
    if (strchr(path, '\'') != NULL) {
        return act_tell(input, "kept in %.200s", path);
    }
    return act_tell(input, "kept: impactlab lab '%.200s' goes on with it", path);
}

// --- opening ---------------------------------------------------------------------------

// Computes a pinned run of a file and pins it.
static status pin_kept(explorer_model *model, const kept_run *k, fault *f)
{
    session s;
    TRY(session_reopen(&s, &k->from, HUGE_VAL, f));
    const int before = model->pinned.count;
    const status code = run_list_pin(&model->pinned, &s, k->name, f);
    if (code == STATUS_OK && model->pinned.count > before) {
        model->pinned.runs[before].hidden = k->hidden;
    }
    session_finish(&s);
    return code;
}

// Takes what a file says, all of it or nothing.
static bool take_session(explorer_model *model, explorer_view *view,
                         explorer_input *input, const session_file *file)
{
    session fresh;
    const int before = model->pinned.count, baseline = model->pinned.baseline;
    if (before + file->run_count - 1 > PINNED_RUNS) {
        return act_refuse(
            input, "its %d pinned runs have no room beside the %d here: R drops some",
            file->run_count - 1, before);
    }
    fault *f = &input->fault;
    if (!act_succeeded(input, session_reopen(&fresh, &file->runs[0].from,
                                             model->session.patience, f))) {
        return false;
    }
    status code = STATUS_OK;
    for (int i = 1; i < file->run_count && code == STATUS_OK; i++) {
        code = pin_kept(model, &file->runs[i], f);
    }

    // the baseline is the file's, else the one that was
    const int kept = file->baseline >= 0 ? before + file->baseline : baseline;
    if (kept < model->pinned.count) {
        model->pinned.baseline = kept;
    } else {
        model->pinned.baseline = model->pinned.count - 1;
    }
    if (code == STATUS_OK) {
        code = state_take_session(model, view, &fresh, f);
    }
    if (code != STATUS_OK) {
        while (model->pinned.count > before) {
            run_list_drop(&model->pinned, model->pinned.count - 1);
        }
        model->pinned.baseline = baseline;
        session_finish(&fresh);
        return act_succeeded(input, code);
    }
    return true;
}

bool explorer_resume_session(explorer_model *model, explorer_view *view,
                             explorer_input *input, const char *path, line_function *look)
{
    static session_file file;
    if (!act_succeeded(input, session_file_read(&file, path, &input->fault))) {
        return false;
    }

    // then how they are looked at; a line that says nothing of that is told
    bool done = take_session(model, view, input, &file);
    message_line said = {.text = ""};
    for (int i = 0; i < file.line_count && done; i++) {
        if (!look(model, view, input, file.lines[i]) && said.text[0] == '\0') {
            said = input->message;
        }
    }
    if (done && said.text[0] == '\0' && session_file_is_outdated(&file)) {
        said = (message_line){
            .text = "a file that a run reads has changed since it was kept"};
    }
    if (done) {
        snprintf(model->session_path, sizeof model->session_path, "%s", path);
        model->saved_version = model_run_id(model);
        model->kept_pins = model->pinned.pinned;
        act_clear_message(input);
        if (said.text[0] != '\0') {
            done = act_warn(input, "%.200s: %.400s", path, said.text);
        } else {
            const int changes = model->session.input_count, pins = model->pinned.count;
            done = act_tell_failed_run(model, input) ||
                   act_tell(input, "%.200s: %d change%s, %d pinned run%s", path, changes,
                            changes == 1 ? "" : "s", pins, pins == 1 ? "" : "s");
        }
    }
    session_file_finish(&file);
    return done;
}
