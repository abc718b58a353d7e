// The commands that read and write files: scenarios, figures, rows, screens, scenes.
#include <string.h>

#include "render/plot/trace_plot.h"
#include "render/scene/scene.h"
#include "src/base/whole_file.h"
#include "src/run/export.h"
#include "ui/explorer/panels/compose.h"
#include "ui/explorer/panels/panel.h"

static bool ends_with(const char *text, const char *end)
{
    size_t length = strlen(text), tail = strlen(end);
    return length > tail && strcmp(text + length - tail, end) == 0;
}

static status write_figure(const explorer_state *st, const char *path, fault *f)
{
    const session *s = &st->session;
    return plot_run_beside(&s->effective, &s->run, s->has_other ? &s->other : NULL, path, f);
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
    if (screen_resize(&s, st->size.width, st->size.height)) {
        state_update(st);
        compose_screen(st, &unused, &s);
        screen_dump(&s, st->looks.glyphs, stream);
    }
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

action_result act_save(explorer_state *st, const char *argument)
{
    // without a name the prompt proposes one
    if (argument[0] == '\0') {
        const char *name = st->session.base.name, *slash = strrchr(name, '/');
        prompt_open(&st->prompt, "save %.200s.png", slash ? slash + 1 : name);
        return result_news(".png .pdf .svg: the figure; .csv: the rows; .yaml: a scenario that "
                           "gives this run; .txt: the screen");
    }

    int kind = 0;
    while (kind < KINDS && !ends_with(argument, kinds[kind].ending)) {
        kind++;
    }
    if (kind == KINDS || kinds[kind].needs_whole_run) {
        action_result whole = act_need_whole_run(st);
        if (!result_ok(&whole)) {
            return whole;
        }
    }
    if (kind == KINDS) {
        return result_refused("the file's name must end in .png, .pdf, .svg, .csv, .yaml or .txt");
    }

    fault f = {0};
    status code;
    whole_file file;
    if (kinds[kind].write == NULL) {
        code = write_figure(st, argument, &f);
    } else if ((code = whole_file_open(&file, argument, &f)) == STATUS_OK) {
        kinds[kind].write(st, file.stream);
        code = whole_file_commit(&file, &f);
    }
    return code == STATUS_OK ? result_news("saved %s", argument) : result_of(code, &f);
}

// The arm in space at the cursor's instant.
action_result act_save_scene(explorer_state *st, const char *argument)
{
    const session *s = &st->session;
    const scene_options options = {0};
    fault f = {0};
    if (argument[0] == '\0') {
        prompt_open(&st->prompt, "scene arm.png");
        return result_done();
    }
    action_result whole = act_need_whole_run(st);
    if (!result_ok(&whole)) {
        return whole;
    }
    status code = scene_write(&s->effective, &s->run, &options, &s->now, 1, argument, &f);
    return code == STATUS_OK ? result_news("saved %s", argument) : result_of(code, &f);
}
