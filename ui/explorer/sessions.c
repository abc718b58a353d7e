// Sessions: what one did, kept in a file and gone on with.
#include <glib.h>
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
    if (p->is_fixed) {
        add_line(file, "axis %.17g %.17g %d", p->fixed.low, p->fixed.high, number);
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

void explorer_shown_panes(const explorer_view *view, char text[PANES + 1])
{
    text[0] = '\0';
    for (int i = 0; i < PANES_OF_TABLE; i++) {
        if (view->panes.pane[i].shown) {
            text_add(text, PANES + 1, "%d", i + 1);
        }
    }
}

// Measured data, before the panes that show them: their file with its digest, and by how
// much they are shifted.
static void add_data(const explorer_model *model, session_file *file)
{
    if (model->measured.row_count == 0) {
        return;
    }
    g_autofree char *path = g_canonicalize_filename(model->measured_file, NULL);
    add_line(file, "# data %s", model->measured_digest);
    if (model->measured_aligned) {
        add_line(file, "data %s", path);
    } else {
        add_line(file, "data %s@%.17g", path, model->measured_shift);
    }
}

// A sweep by its definition, and its quantity.
static void add_sweep(const explorer_model *model, session_file *file)
{
    const lab_sweep *sweep = &model->sweep;
    if (!lab_sweep_is_on(sweep)) {
        return;
    }
    const char *path = sweep_axis_parameter(&sweep->axis)->path;
    if (lab_sweep_is_map(sweep)) {
        add_line(file, "sweep %s=%s %s=%s", path, sweep->axis.text,
                 sweep_axis_parameter(&sweep->second)->path, sweep->second.text);
    } else {
        add_line(file, "sweep %s=%s", path, sweep->axis.text);
    }
    add_line(file, "metric %s", summary_table[sweep->metric].key);
}

// How the runs are looked at, as the lines that give it again.
static void add_looks(const explorer_model *model, const explorer_view *view,
                      session_file *file)
{
    add_data(model, file);
    if (view->panes.chosen) {
        char shown[PANES + 1];
        explorer_shown_panes(view, shown);
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
        add_line(file, "note @%.17g %s", n->time, n->text);
    }

    // a bound, the mark
    const solved_limit *limit = &model->limit;
    if (limit->signal >= 0) {
        add_line(file, "limit %s %.17g", signal_table[limit->signal].name, limit->bound);
    }
    if (view->mark.set) {
        add_line(file, "mark %.17g", view->mark.time);
    }
    add_sweep(model, file);
}

// What would be lost of how the runs are looked at, as text: of its lines those that
// somebody made on purpose.
static char *looks_worth_keeping(const explorer_model *model, const explorer_view *view)
{
    static session_file file;
    GString *text = g_string_new(NULL);
    file = (session_file){.line_count = 0};
    add_looks(model, view, &file);
    for (int i = 0; i < file.line_count; i++) {
        const char *line = file.lines[i];
        const bool remembered = g_str_has_prefix(line, "panes ") &&
                                strcmp(line + strlen("panes "), view->kept_panes) == 0;
        if (!remembered && !g_str_has_prefix(line, "zoom ") &&
            !g_str_has_prefix(line, "signal ") && !g_str_has_prefix(line, "axis ")) {
            g_string_append(text, line);
            g_string_append_c(text, '\n');
        }
    }
    session_file_finish(&file);
    return g_string_free(text, FALSE);
}

void explorer_remember_looks(explorer_model *model, const explorer_view *view)
{
    g_free(model->saved_looks);
    model->saved_looks = looks_worth_keeping(model, view);
}

// Whether no file has how the runs are looked at.
static bool looks_are_unsaved(const explorer_model *model, const explorer_view *view)
{
    g_autofree char *now = looks_worth_keeping(model, view);
    return g_strcmp0(now, model->saved_looks) != 0;
}

bool explorer_has_work(const explorer_model *model, const explorer_view *view)
{
    return model->session.input_count + model->pinned.count > 0 ||
           looks_are_unsaved(model, view);
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
static void remember_saved(explorer_model *model, const explorer_view *view,
                           const char *path)
{
    explorer_remember_looks(model, view);
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
    remember_saved(model, view, path);
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

// Whether a file has lines that are carried out only beside a complete run.
static bool needs_whole_run(const session_file *file)
{
    bool needs = false;
    for (int i = 0; i < file->line_count; i++) {
        needs = needs || g_str_has_prefix(file->lines[i], "data ") ||
                g_str_has_prefix(file->lines[i], "sweep ");
    }
    return needs;
}

// Whether measured data are others than they were when a file was written.
static bool data_have_changed(const explorer_model *model, const session_file *file)
{
    bool changed = false;
    for (int i = 0; i < file->line_count; i++) {
        const char *line = file->lines[i];
        changed = changed || (g_str_has_prefix(line, "# data ") &&
                              !g_str_has_suffix(line, model->measured_digest));
    }
    return changed;
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
    const double patience = model->session.patience;
    if (!act_succeeded(input,
                       session_reopen(&fresh, &file->runs[0].from,
                                      needs_whole_run(file) ? HUGE_VAL : patience, f))) {
        return false;
    }
    fresh.patience = patience;
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
        const bool done = look(model, view, input, file->lines[i]) &&
                          act_take_data(model, input, HUGE_VAL);
        if (!done && failure->text[0] == '\0') {
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
        if (failure.text[0] == '\0' && data_have_changed(model, &file)) {
            failure = (message_line){
                .text = "the measured data have changed since they were kept"};
        }
        remember_saved(model, view, path);
        done = tell_session(model, input, path, &failure);
    }
    session_file_finish(&file);
    return done;
}

// --- leaving ---------------------------------------------------------------------------

// The number of changes that no file has, of all scenarios visited.
static int unsaved_changes(const explorer_model *model)
{
    int changes = 0;
    if (model->saved_version != model_run_id(model)) {
        changes = model->session.input_count;
    }
    for (int i = 0; i < model->visit_count; i++) {
        changes += model->visits[i].from.input_count;
    }
    return changes;
}

// The number of pinned runs that no file has.
static int unsaved_pins(const explorer_model *model)
{
    if (model->kept_pins == model->pinned.pinned) {
        return 0;
    }
    return model->pinned.count;
}

bool act_quit(const explorer_model *model, const explorer_view *view,
              explorer_input *input)
{
    // work is lost only if quitting is requested twice
    const int changes = unsaved_changes(model), pins = unsaved_pins(model);
    const bool looked = looks_are_unsaved(model, view);
    if ((changes + pins == 0 && !looked) || input->asked_to_quit) {
        return act_quit_now(input);
    }
    input->asked_to_quit = true;

    // what would be lost
    char lost[LINE_TEXT] = "";
    if (changes > 0) {
        text_add(lost, sizeof lost, "%d change%s", changes, changes == 1 ? "" : "s");
    }
    if (pins > 0) {
        text_add(lost, sizeof lost, "%s%d pinned run%s", changes > 0 ? " and " : "", pins,
                 pins == 1 ? "" : "s");
    }
    if (looked) {
        text_add(lost, sizeof lost, "%snotes, marks, panes, data or a sweep",
                 changes + pins > 0 ? ", and " : "");
    }
    return act_warn(input,
                    "%s would be lost: q leaves all the same, s keeps all, Esc stays",
                    lost);
}

bool act_interrupt(explorer_model *model, const explorer_view *view,
                   explorer_input *input)
{
    if (model->session.computing != NULL || model->search != NULL) {
        return act_stop(model, input);
    }
    return act_quit(model, view, input);
}
