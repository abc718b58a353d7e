// The commands that read and write files: scenarios, figures, rows, screens.
#include <glib.h>
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "render/drawing.h"
#include "src/base/input_file.h"
#include "src/base/numbers.h"
#include "src/base/result_places.h"
#include "src/base/text_stream.h"
#include "src/base/whole_file.h"
#include "src/base/words.h"
#include "src/run/export.h"
#include "src/scenario/outside.h"
#include "ui/explorer/explorer.h"

// The screen as text, drawn as large as it was last, without a place for the mouse.
static void write_screen(explorer_model *model, explorer_view *view,
                         const explorer_input *input, FILE *stream)
{
    static layout unused;
    screen s = {0};
    screen_resize(&s, view->size.width, view->size.height);
    state_update(model, view);
    compose_screen(model, view, input, &unused, &s);
    screen_dump(&s, view->looks.glyphs, stream);
    screen_finish(&s);
}

// What a file holds, by its name's ending.
typedef enum file_content {
    FILE_FIGURE,
    FILE_ROWS,
    FILE_SCENARIO, // that gives this run
    FILE_SCREEN,
    FILE_UNKNOWN
} file_content;

static file_content content_of_name(const char *name)
{
    static const struct {
        const char *ending;
        file_content content;
    } kinds[] = {
        {".png", FILE_FIGURE}, {".pdf", FILE_FIGURE},    {".svg", FILE_FIGURE},
        {".csv", FILE_ROWS},   {".yaml", FILE_SCENARIO}, {".txt", FILE_SCREEN},
    };
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        if (name[text_stem(name, kinds[i].ending)] != '\0') {
            return kinds[i].content;
        }
    }
    return FILE_UNKNOWN;
}

// --- names of files --------------------------------------------------------------------

static bool exists(const char *path)
{
    return access(path, F_OK) == 0;
}

// Says that a file was written, or is there already, by its whole path, or its name as
// given if there is none.
static bool tell_file(explorer_input *input, bool done, const char *name)
{
    char path[MESSAGE_TEXT / 2];
    char *whole = realpath(name, NULL);
    g_strlcpy(path, whole != NULL ? whole : name, sizeof path);
    free(whole);
    if (done) {
        return act_tell(input, "saved %s", path);
    }
    return act_refuse(input,
                      "%s is there already: another name, or :save! %.100s replaces it",
                      path, name);
}

// What a file of the run is called, without its ending: as the scenario, with what the
// last change changed.
static void name_of_run(const session *s, char *stem, size_t size)
{
    stem[0] = '\0';
    text_add(stem, 59, "%s", scenario_leaf(s->base.name));
    if (s->input_count > 0) {
        const session_input *last = &s->inputs[s->input_count - 1];
        if (last->kind == SESSION_INPUT_PUSH) {
            text_add(stem, size, "-push");
        } else {
            const char *path = parameter_table[last->parameter].path;
            text_add(stem, 79, "-%s", strchr(path, '.') + 1);
            text_add(stem, 99, "-%s", last->text);
        }
    }

    // letters, digits and a few marks only
    for (char *c = stem; *c != '\0'; c++) {
        if (!isalnum((unsigned char)*c) && strchr(".-_", *c) == NULL) {
            *c = '-';
        }
    }
}

// Whether a file of a name is there, or a recipe beside it.
static bool has_file(const char *name)
{
    g_autofree char *recipe = picture_beside(name, ".yaml");
    return exists(name) || exists(recipe);
}

// The first name of the run that no file has.
static void free_file_name(const explorer_model *model, char name[LINE_TEXT / 2],
                           const char *ending)
{
    char stem[100];
    name_of_run(&model->session, stem, sizeof stem);
    snprintf(name, LINE_TEXT / 2, "%s%s", stem, ending);
    for (int i = 2; has_file(name) && i < 10000; i++) {
        snprintf(name, LINE_TEXT / 2, "%s-%d%s", stem, i, ending);
    }
}

// Asks for a name and proposes that one.
static void propose_file_name(const explorer_model *model, explorer_input *input,
                              const char *command, const char *ending)
{
    char name[LINE_TEXT / 2];
    free_file_name(model, name, ending);
    prompt_open(&input->prompt, name, "%s ", command);
}

// --- the commands ----------------------------------------------------------------------

// Refuses a file that the run or the measured data were read from.
static bool is_free(const explorer_model *model, explorer_input *input, const char *name)
{
    const session *s = &model->session;
    fault *f = &input->fault;
    result_places_add(name);
    bool kept = outside_keep(&s->effective.parameters, f) == STATUS_OK;
    if (kept && s->base.file != NULL) {
        kept = input_file_check_kept(s->base.file, f) == STATUS_OK;
    }
    if (kept && model->measured.row_count > 0) {
        kept = input_file_check_kept(model->measured_file, f) == STATUS_OK;
    }
    result_places_forget();
    if (!kept) {
        return act_refuse(input, "%.200s is a file that this run reads: another name",
                          name);
    }
    return true;
}

// --- figures ---------------------------------------------------------------------------

// The name of one of several pictures: FIGURE.png, FIGURE-2.png and so on.
static char *picture_name(const char *name, int index)
{
    const int stem = (int)(picture_ending(name) - name);
    if (index == 0) {
        return g_strdup(name);
    }
    return text_printf("%.*s-%d%s", stem, name, index + 1, name + stem);
}

// Cuts the width off "FIGURE.png 85" [mm]; 0: there is none.
static double cut_width(char *name)
{
    char *blank = strrchr(name, ' ');
    const char *rest;
    double width = 0;
    if (blank == NULL || !decimal_read(blank + 1, &width, &rest) ||
        (*rest != '\0' && strcmp(rest, "mm") != 0)) {
        return 0;
    }
    *blank = '\0';
    if (content_of_name(name) != FILE_FIGURE) {
        *blank = ' ';
        return 0;
    }
    return width;
}

// Where the recipe of a picture goes: FIGURE.yaml, or where that is another file's name,
// FIGURE.png.yaml.
static char *recipe_name(const char *name, bool over)
{
    g_autofree char *usual = picture_beside(name, ".yaml");
    if (!exists(usual) || (over && drawing()->recipe_is(usual))) {
        return g_steal_pointer(&usual);
    }
    return g_strconcat(name, ".yaml", NULL);
}

// Draws one of the pictures from its recipe, and writes that beside it.
static status write_figure(const explorer_model *model, const explorer_view *view,
                           int index, const char *name, const char *path, double width,
                           fault *f)
{
    g_autofree char *folder = g_path_get_dirname(name),
                    *command = drawing()->recipe_command(path);
    text_stream recipe;
    size_t length;
    if (!text_stream_open(&recipe)) {
        return fault_no_memory(f);
    }
    status code = shown_figure_write(model, view, index, folder, width, recipe.stream, f);
    char *text = text_stream_close(&recipe, &length);
    if (code != STATUS_OK || text == NULL) {
        free(text);
        return code != STATUS_OK ? code : fault_no_memory(f);
    }

    // the picture comes from the text that plot will read
    artwork drawn = {0};
    const figure_options options = {.command = command};
    code = drawing()->recipe_open_text(text, length, path, &options, keep_first_fault, f,
                                       &drawn, f);
    if (code == STATUS_OK) {
        code = drawing()->artwork_publish(&drawn, &options, name, false, f);
        artwork_finish(&drawn);
    }
    whole_file file;
    if (code == STATUS_OK) {
        code = whole_file_open(&file, path, f);
    }
    if (code == STATUS_OK) {
        fputs(text, file.stream);
        code = whole_file_commit(&file, f);
    }
    free(text);
    return code;
}

// Whether the places of a picture and its recipe may be written to.
static bool figure_is_free(const explorer_model *model, explorer_input *input,
                           const char *name, bool over)
{
    g_autofree char *recipe = recipe_name(name, over);
    if (!over && exists(name)) {
        return tell_file(input, false, name);
    }
    if (exists(recipe) && !(over && drawing()->recipe_is(recipe))) {
        return tell_file(input, false, recipe);
    }
    return is_free(model, input, name) && is_free(model, input, recipe);
}

// Saves what is shown: each of its pictures with its recipe.
static bool save_figures(const explorer_model *model, const explorer_view *view,
                         explorer_input *input, const char *name, double width, bool over)
{
    const int count = shown_figure_count(model, view);
    g_autofree char *recipe = NULL;
    if (count == 0) {
        return act_refuse(input, "no pane of curves is shown, 1 to 9 show them");
    }
    if (!act_succeeded(input, drawing_open(&input->fault))) {
        return false;
    }
    for (int i = 0; i < count; i++) {
        g_autofree char *one = picture_name(name, i);
        if (!figure_is_free(model, input, one, over)) {
            return false;
        }
    }
    for (int i = 0; i < count; i++) {
        g_autofree char *one = picture_name(name, i), *path = recipe_name(one, over);
        if (!act_succeeded(input, write_figure(model, view, i, one, path, width,
                                               &input->fault))) {
            return false;
        }
        if (i == 0) {
            recipe = g_steal_pointer(&path);
        }
    }

    // where it is, and how it is made again
    g_autofree char *path = g_canonicalize_filename(name, NULL);
    if (count == 1) {
        return act_tell(input, "saved %.400s; impactlab plot %.200s draws it again", path,
                        recipe);
    }
    return act_tell(input,
                    "saved %d pictures from %.400s on, each with its recipe (.yaml)",
                    count, path);
}

// --- saving ----------------------------------------------------------------------------

// Writes what the name's ending asks for; `over`: in the place of what is there.
static bool save_over(explorer_model *model, explorer_view *view, explorer_input *input,
                      const char *argument, bool over)
{
    char name[LINE_TEXT];
    snprintf(name, sizeof name, "%s", argument);
    const double width = cut_width(name);

    // a scenario and a screen may be of a part of a run
    const file_content content = content_of_name(name);
    if (content != FILE_SCENARIO && content != FILE_SCREEN &&
        !act_need_whole_run(model, input)) {
        return false;
    }
    if (content == FILE_UNKNOWN) {
        return act_refuse(
            input, "the file's name must end in .png, .pdf, .svg, .csv, .yaml or .txt");
    }
    if (content == FILE_FIGURE) {
        model_law_modes(model); // which a picture names
        return save_figures(model, view, input, name, width, over);
    }
    if (!over && exists(name)) {
        return tell_file(input, false, name);
    }
    if (!is_free(model, input, name)) {
        return false;
    }
    whole_file file;
    if (!act_succeeded(input, whole_file_open(&file, name, &input->fault))) {
        return false;
    }
    const session *s = &model->session;
    if (content == FILE_ROWS) {
        export_csv(file.stream, &s->effective, &s->run.trace);
    } else if (content == FILE_SCENARIO) {
        scenario_write(file.stream, &s->effective);
    } else {
        write_screen(model, view, input, file.stream);
    }
    if (!act_succeeded(input, whole_file_commit(&file, &input->fault))) {
        return false;
    }
    if (content == FILE_SCENARIO) {
        model->saved_version = model_run_id(model);
    }
    return tell_file(input, true, name);
}

bool act_save(explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument)
{
    // without a name the prompt proposes one
    if (argument[0] == '\0') {
        propose_file_name(model, input, "save", ".png");
        return act_tell(
            input, ".png .pdf .svg: what is shown, 'x.png 85' in mm; .csv: the rows; "
                   ".yaml: a scenario that gives this run; .txt: the screen");
    }
    return save_over(model, view, input, argument, false);
}

bool act_save_now(explorer_model *model, explorer_view *view, explorer_input *input,
                  const char *argument)
{
    if (argument[0] == '\0') {
        return act_refuse(input, "save! takes the file that it is to replace");
    }
    return save_over(model, view, input, argument, true);
}

// --- the editor ------------------------------------------------------------------------

bool act_editor(const explorer_model *model, explorer_input *input)
{
    const session *s = &model->session;
    const scenario *base = &s->base;
    if (!input->has_terminal) {
        return act_refuse(input, "an editor needs a terminal");
    }

    // a file of the user's itself, else this run as a scenario in the present folder
    const bool own = base->file != NULL && strcmp(base->name, base->file) == 0 &&
                     access(base->file, W_OK) == 0;
    if (own) {
        snprintf(input->edits, sizeof input->edits, "%s", base->file);
        return true;
    }
    char name[LINE_TEXT / 2];
    whole_file file;
    free_file_name(model, name, ".yaml");
    if (!act_succeeded(input, whole_file_open(&file, name, &input->fault))) {
        return false;
    }
    scenario_write(file.stream, &s->effective);
    if (!act_succeeded(input, whole_file_commit(&file, &input->fault))) {
        return false;
    }
    snprintf(input->edits, sizeof input->edits, "%s", name);
    return true;
}

// --- the clipboard ---------------------------------------------------------------------

// The command that gives this run; where changes have instants or the scenario was
// changed as it was opened no command does, and the scenario itself is written.
static void write_command(const explorer_model *model, FILE *stream)
{
    const session *s = &model->session;
    char given[SCENARIO_CHANGES];
    bool plain = scenario_changes(&s->base, given)[0] == '\0';
    for (int i = 0; i < s->input_count; i++) {
        plain = plain && s->inputs[i].kind == SESSION_INPUT_START;
    }
    if (!plain) {
        scenario_write(stream, &s->effective);
        return;
    }
    fprintf(stream, "impactlab run '%s'", s->base.name);
    for (int i = 0; i < s->input_count; i++) {
        fprintf(stream, " --set '%s=%s'", parameter_table[s->inputs[i].parameter].path,
                s->inputs[i].text);
    }
    fputc('\n', stream);
}

// The selected parameter and its value at the cursor.
static void write_value(const explorer_model *model, const explorer_view *view,
                        FILE *stream)
{
    char value[PARAMETER_VALUE_SIZE];
    const int index = view->parameters.parameter;
    const parameters now = model_parameters(model);
    parameter_format(&now, index, value, sizeof value);
    fprintf(stream, "%s=%s", parameter_table[index].path, value);
}

bool act_copy(explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument)
{
    const char *what = argument;
    if (argument[0] == '\0') {
        what = "value";
    }
    const bool is_screen = strcmp(what, "screen") == 0;
    const bool is_run = strcmp(what, "run") == 0;
    if (!is_screen && !is_run && strcmp(what, "value") != 0) {
        return act_refuse(input, "copy takes value, run or screen");
    }

    // the text takes the place of what was copied before
    free(input->copied);
    input->copied = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&input->copied, &size);
    if (stream == NULL) {
        return act_succeeded(input, STATUS_NO_MEMORY);
    }
    if (is_screen) {
        write_screen(model, view, input, stream);
    } else if (is_run) {
        write_command(model, stream);
    } else {
        write_value(model, view, stream);
    }
    if (fclose(stream) != 0) {
        return act_succeeded(input, STATUS_NO_MEMORY);
    }
    return act_tell(input, "%s is on the clipboard of a terminal that knows OSC 52",
                    what);
}
