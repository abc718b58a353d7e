// The commands that read and write files: scenarios, figures, rows, screens, scenes.
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "render/plot/trace_plot.h"
#include "render/scene/scene.h"
#include "src/base/input_file.h"
#include "src/base/result_places.h"
#include "src/base/whole_file.h"
#include "src/base/words.h"
#include "src/run/export.h"
#include "src/scenario/outside.h"
#include "ui/explorer/panels/panel.h"

static status write_figure(const explorer_state *st, const char *path, fault *f)
{
    const session *s = &st->session;
    figure_mark notes[NOTES];
    for (int i = 0; i < st->note_count; i++) {
        notes[i] = (figure_mark){.x = st->notes[i].time, .label = st->notes[i].text};
    }
    return plot_run(&s->effective, &s->run, s->has_other ? &s->other : NULL, notes,
                    st->note_count, path, f);
}

// The rows of the run.
static void write_rows(explorer_state *st, FILE *stream)
{
    const session *s = &st->session;
    export_csv(stream, &s->run.trace, s->effective.parameters.arm.links);
}

// A scenario that gives this run.
static void write_scenario(explorer_state *st, FILE *stream)
{
    scenario_write(stream, &st->session.effective);
}

// The screen as text, drawn as large as it was last, without a place for the mouse.
static void write_screen(explorer_state *st, FILE *stream)
{
    static layout unused;
    screen s = {0};
    screen_resize(&s, st->size.width, st->size.height);
    state_update(st);
    compose_screen(st, &unused, &s);
    screen_dump(&s, st->looks.glyphs, stream);
    screen_finish(&s);
}

// What a file holds, by its name's ending.
static const struct {
    const char *ending;
    bool needs_whole_run;
    void (*write)(explorer_state *st, FILE *stream); // NULL: a figure
} kinds[] = {
    {".png", true, NULL},
    {".pdf", true, NULL},
    {".svg", true, NULL},
    {".csv", true, write_rows},
    {".yaml", false, write_scenario},
    {".txt", false, write_screen},
};
enum { KINDS = sizeof kinds / sizeof kinds[0] };

// --- names of files --------------------------------------------------------------------

static bool exists(const char *path)
{
    return access(path, F_OK) == 0;
}

// Says that a file was written, or is there already, by its whole path, or its name as
// given if there is none.
static bool tell_file(explorer_state *st, bool done, const char *name)
{
    char *found = realpath(name, NULL), path[MESSAGE_TEXT / 2];
    snprintf(path, sizeof path, "%s", found != NULL ? found : name);
    free(found);
    if (done) {
        return act_tell(st, "saved %s", path);
    }
    return act_refuse(st,
                      "%s is there already: another name, or :save! %.100s replaces it",
                      path, name);
}

// Asks for a name and proposes one that no file has: the scenario's, what the last change
// changed, and a number if need be.
static void propose_name(explorer_state *st, const char *command, const char *ending)
{
    const session *s = &st->session;
    char stem[LINE_TEXT / 2] = "", name[LINE_TEXT / 2];
    text_add(stem, 59, "%s", scenario_leaf(s->base.name));

    // what the last change changed
    const session_input *last =
        s->input_count > 0 ? &s->inputs[s->input_count - 1] : NULL;
    if (last != NULL && last->kind == SESSION_INPUT_PUSH) {
        text_add(stem, sizeof stem, "-push");
    } else if (last != NULL) {
        text_add(stem, 79, "-%s", strchr(parameter_table[last->parameter].path, '.') + 1);
        text_add(stem, 99, "-%s", last->text);
    }

    // letters, digits and a few marks only; the first that is free
    for (char *c = stem; *c != '\0'; c++) {
        if (!(isalnum((unsigned char)*c) || strchr(".-_", *c) != NULL)) {
            *c = '-';
        }
    }
    snprintf(name, sizeof name, "%s%s", stem, ending);
    for (int i = 2; exists(name) && i < 10000; i++) {
        snprintf(name, sizeof name, "%s-%d%s", stem, i, ending);
    }
    prompt_open(&st->prompt, name, "%s ", command);
}

// --- the commands ----------------------------------------------------------------------

// Whether the file is none that the run or the measured data were read from.
static bool is_free(explorer_state *st, const char *name)
{
    const session *s = &st->session;
    const char *const read[] = {s->base.file,
                                st->measured.row_count > 0 ? st->measured_file : NULL};
    result_places_add(name);
    bool kept = outside_keep(&s->effective.parameters, &st->fault) == STATUS_OK;
    for (size_t i = 0; i < sizeof read / sizeof read[0]; i++) {
        kept = kept && (read[i] == NULL ||
                        input_file_check_kept(read[i], &st->fault) == STATUS_OK);
    }
    result_places_forget();
    return kept ||
           act_refuse(st, "%.200s is a file that this run reads: another name", name);
}

// Writes what the name's ending asks for; a file that is there is replaced.
static bool save_over(explorer_state *st, const char *name)
{
    int kind = 0;
    while (kind < KINDS && name[text_stem(name, kinds[kind].ending)] == '\0') {
        kind++;
    }
    if (!((kind < KINDS && !kinds[kind].needs_whole_run) || act_need_whole_run(st))) {
        return false;
    }
    if (kind == KINDS) {
        return act_refuse(
            st, "the file's name must end in .png, .pdf, .svg, .csv, .yaml or .txt");
    }
    if (!is_free(st, name)) {
        return false;
    }

    status code;
    whole_file file;
    if (kinds[kind].write == NULL) {
        code = write_figure(st, name, &st->fault);
    } else if ((code = whole_file_open(&file, name, &st->fault)) == STATUS_OK) {
        kinds[kind].write(st, file.stream);
        code = whole_file_commit(&file, &st->fault);
    }
    if (!act_worked(st, code)) {
        return false;
    }
    if (kinds[kind].write == write_scenario) {
        st->saved_version = state_run_id(st);
    }
    return tell_file(st, true, name);
}

bool act_save(explorer_state *st, const char *argument)
{
    // without a name the prompt proposes one
    if (argument[0] == '\0') {
        propose_name(st, "save", ".png");
        return act_tell(
            st, ".png .pdf .svg: the figure; .csv: the rows; .yaml: a scenario that "
                "gives this run; .txt: the screen");
    }
    if (exists(argument)) {
        return tell_file(st, false, argument);
    }
    return save_over(st, argument);
}

bool act_save_now(explorer_state *st, const char *argument)
{
    if (argument[0] == '\0') {
        return act_refuse(st, "save! takes the file that it is to replace");
    }
    return save_over(st, argument);
}

// The arm in space at the cursor's instant.
bool act_scene(explorer_state *st, const char *argument)
{
    const session *s = &st->session;
    const scene_options options = {0};

    // without a name the prompt proposes one
    if (argument[0] == '\0') {
        propose_name(st, "scene", "-arm.png");
        return true;
    }

    // nothing is replaced, and nothing incomplete is drawn
    if (exists(argument)) {
        return act_refuse(st, "%.200s is there already: give the scene another name",
                          argument);
    }
    if (!act_need_whole_run(st)) {
        return false;
    }

    // the cursor's instant
    const scene_picture picture = {.scenario = &s->effective,
                                   .result = &s->run,
                                   .options = options,
                                   .times = &s->now,
                                   .count = 1};
    return act_worked(st, scene_write(&picture, argument, &st->fault)) &&
           tell_file(st, true, argument);
}

// --- the clipboard ---------------------------------------------------------------------

// The command that gives this run; where changes have instants or the scenario was
// changed as it was opened no command does, and the scenario itself is written.
static void write_command(explorer_state *st, FILE *stream)
{
    const session *s = &st->session;
    char given[SCENARIO_CHANGES];
    bool plain = scenario_changes(&s->base, given)[0] == '\0';
    for (int i = 0; i < s->input_count; i++) {
        plain = plain && s->inputs[i].kind == SESSION_INPUT_START;
    }
    if (!plain) {
        write_scenario(st, stream);
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
static void write_value(explorer_state *st, FILE *stream)
{
    char value[PARAMETER_TEXT_SIZE];
    const int index = st->parameters.parameter;
    const parameters now = state_parameters(st);
    parameter_format(&now, index, value, sizeof value);
    fprintf(stream, "%s=%s", parameter_table[index].path, value);
}

bool act_copy(explorer_state *st, const char *argument)
{
    static const struct {
        const char *word;
        void (*write)(explorer_state *st, FILE *stream);
    } what[] = {{"value", write_value}, {"run", write_command}, {"screen", write_screen}};
    size_t i = 0, size = 0;
    while (i < 3 && strcmp(argument[0] != '\0' ? argument : "value", what[i].word) != 0) {
        i++;
    }
    if (i == 3) {
        return act_refuse(st, "copy takes value, run or screen");
    }
    free(st->copied);
    st->copied = NULL;
    FILE *stream = open_memstream(&st->copied, &size);
    if (stream != NULL) {
        what[i].write(st, stream);
    }
    if (stream == NULL || fclose(stream) != 0) {
        return act_worked(st, STATUS_NO_MEMORY);
    }
    return act_tell(st, "%s is on the clipboard of a terminal that knows OSC 52",
                    what[i].word);
}
