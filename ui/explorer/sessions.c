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

// Adds a line on how the runs are looked at, as far as there is room.
static void add_line(session_file *file, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static void add_line(session_file *file, const char *format, ...)
{
    if (file->line_count == SESSION_FILE_LINES) {
        return;
    }
    va_list list;
    va_start(list, format);
    char *line = decimal_vtext(format, list);
    va_end(list);
    loss_unless(line != NULL);
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

    // the command that makes one of the user's
    const bool own = index >= PANES_OF_TABLE;
    if (own && p->shown) {
        char signals[PANE_SIGNALS * (LINE_TEXT + 1)] = "";
        for (int k = 0; k < p->count; k++) {
            const char *separator = k > 0 ? "," : " ";
            text_add(signals, sizeof signals, "%s%s", separator,
                     signal_table[p->signals[k]].name);
        }
        add_line(file, "%s%s", views[p->view], signals);
    }

    // axes of what can be shown again
    if (p->count == 0 || (own && !p->shown)) {
        return;
    }
    if (p->scaling == AXIS_FIXED) {
        add_line(file, "axis %.17g %.17g %d", p->fixed.low, p->fixed.high, number);
    } else if (p->scaling != AXIS_AUTO) {
        add_line(file, "axis %s %d", axis_scaling_words[p->scaling], number);
    }

    // hidden signals; a lesson hides signals of its own
    if (p->hidden != 0 || model->lesson.on) {
        add_line(file, "signal all %d", number);
    }
    for (int k = 0; k < p->count; k++) {
        if (p->hidden >> k & 1) {
            add_line(file, "signal %s %d", signal_table[p->signals[k]].name, number);
        }
    }
}

// The panes of the table that are shown, as their numbers.
static void shown_panes(const explorer_view *view, char text[PANES + 1])
{
    text[0] = '\0';
    for (int i = 0; i < PANES_OF_TABLE; i++) {
        if (view->panes.pane[i].shown) {
            text_add(text, PANES + 1, "%d", i + 1);
        }
    }
}

// How the runs are looked at, as the lines that give it again.
static void add_looks(const explorer_model *model, const explorer_view *view,
                      session_file *file)
{
    add_line(file, "lanes %s", look_word(&view->looks, look_choice_of("lanes")));
    if (view->panes.chosen) {
        char shown[PANES + 1];
        shown_panes(view, shown);
        add_line(file, "panes %s", shown);
    }

    // hidden panes of the user's own are left out, so that the others move up
    int number = 1;
    for (int i = 0; i < PANES; i++) {
        add_pane(model, view, file, i, number);
        if (i < PANES_OF_TABLE || view->panes.pane[i].shown) {
            number++;
        }
    }

    // the visible part, and notes
    const time_window *w = &view->window;
    if (w->to > w->from) {
        add_line(file, "zoom %.17g %.17g", w->from, w->to);
    }
    for (int i = 0; i < model->note_count; i++) {
        const note *n = &model->notes[i];
        add_line(file, "note @%.17g %.200s", n->time, n->text);
    }

    // colours, bounds, the mark
    const solved_limit *band = &model->band, *limit = &model->limit;
    if (band->signal >= 0) {
        add_line(file, "band %s %.17g", signal_table[band->signal].name, band->bound);
    }
    if (limit->signal >= 0) {
        add_line(file, "limit %s %.17g", signal_table[limit->signal].name, limit->bound);
    }
    if (view->mark.set) {
        add_line(file, "mark %.17g", view->mark.time);
    }
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

// What the session's file holds is saved.
static void remember_saved(explorer_model *model, const char *path)
{
    snprintf(model->session_path, sizeof model->session_path, "%s", path);
    model->saved_version = model_run_id(model);
    model->kept_pins = model->pinned.pinned;
}

bool explorer_save_session(explorer_model *model, const explorer_view *view,
                           explorer_input *input, const char *path)
{
    // a file is replaced only if it is the one this visit goes on with
    if (access(path, F_OK) == 0 && strcmp(path, model->session_path) != 0) {
        return act_refuse(input, "%.200s is there already: give the session another name",
                          path);
    }
    if (!act_need_whole_run(model, input) ||
        !act_succeeded(input, write_session(model, view, path, &input->fault))) {
        return false;
    }
    remember_saved(model, path);
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

// Computes and pins the other runs of a file.
static status pin_all(explorer_model *model, const session_file *file, fault *f)
{
    for (int i = 1; i < file->run_count; i++) {
        TRY(pin_kept(model, &file->runs[i], f));
    }
    return STATUS_OK;
}

// Takes what a file says, all of it or nothing.
static bool take_session(explorer_model *model, explorer_view *view,
                         explorer_input *input, const session_file *file)
{
    run_list *pins = &model->pinned;
    const int before = pins->count, baseline = pins->baseline;
    if (before + file->run_count - 1 > PINNED_RUNS) {
        return act_refuse(
            input, "its %d pinned runs have no room beside the %d here: R drops some",
            file->run_count - 1, before);
    }
    session fresh;
    fault *f = &input->fault;
    if (!act_succeeded(input, session_reopen(&fresh, &file->runs[0].from,
                                             model->session.patience, f))) {
        return false;
    }
    status code = pin_all(model, file, f);

    // the baseline is the file's, else the one that was
    int kept = baseline;
    if (file->baseline >= 0) {
        kept = before + file->baseline;
    }
    if (kept < pins->count) {
        pins->baseline = kept;
    } else {
        pins->baseline = pins->count - 1;
    }
    if (code == STATUS_OK) {
        code = state_take_session(model, view, &fresh, f);
    }
    if (code == STATUS_OK) {
        return true;
    }

    // nothing of it stays
    while (pins->count > before) {
        run_list_drop(pins, pins->count - 1);
    }
    pins->baseline = baseline;
    session_finish(&fresh);
    return act_succeeded(input, code);
}

// Carries out the lines on how the runs are looked at; the first that fails is in
// `failure`, which is empty if none does.
static void look_as_kept(explorer_model *model, explorer_view *view,
                         explorer_input *input, const session_file *file,
                         line_function *look, message_line *failure)
{
    for (int i = 0; i < file->line_count; i++) {
        if (!look(model, view, input, file->lines[i]) && failure->text[0] == '\0') {
            *failure = input->message;
        }
    }
}

// Says what a session brought: what was wrong with it, else a run that fails, else how
// much there is.
static bool tell_session(const explorer_model *model, explorer_input *input,
                         const char *path, const message_line *failure)
{
    act_clear_message(input);
    if (failure->text[0] != '\0') {
        return act_warn(input, "%.200s: %.400s", path, failure->text);
    }
    if (act_tell_failed_run(model, input)) {
        return true;
    }
    const int changes = model->session.input_count, pins = model->pinned.count;
    const char *plural = changes == 1 ? "" : "s", *pin_plural = pins == 1 ? "" : "s";
    return act_tell(input, "%.200s: %d change%s, %d pinned run%s", path, changes, plural,
                    pins, pin_plural);
}

bool explorer_resume_session(explorer_model *model, explorer_view *view,
                             explorer_input *input, const char *path, line_function *look)
{
    static session_file file;
    if (!act_succeeded(input, session_file_read(&file, path, &input->fault))) {
        return false;
    }
    bool done = take_session(model, view, input, &file);
    if (done) {
        message_line failure = {.text = ""};
        look_as_kept(model, view, input, &file, look, &failure);
        if (failure.text[0] == '\0' && session_file_is_outdated(&file)) {
            failure = (message_line){
                .text = "a file that a run reads has changed since it was kept"};
        }
        remember_saved(model, path);
        done = tell_session(model, input, path, &failure);
    }
    session_file_finish(&file);
    return done;
}
