// Actions that read and write files: scenarios, figures, rows, scenes, settings.
#include "ui/explorer/actions.h"

#include <string.h>

#include "render/scene/scene.h"
#include "render/plot/trace_plot.h"
#include "src/run/export.h"
#include "src/base/whole_file.h"

bool act_remember(lab *l, const char *argument)
{
    (void)argument;
    return lab_settings_save(l);
}

bool act_open_scenario_by(lab *l, const char *argument)
{
    int at = -1;
    for (int i = 0; i < l->name_count; i++) {
        at = strcmp(l->names[i], l->session.base.name) == 0 ? i : at;
    }
    l->filter[0] = '\0';
    if (argument[0] == '\0') {
        l->overlay = OVERLAY_OPEN;
        l->scroll = at < 0 ? 0 : at;
        l->list_first = -1;
        lab_load_titles(l);
        return true;
    }
    bool next = strcmp(argument, "+1") == 0;
    if ((next || strcmp(argument, "-1") == 0) && l->name_count > 0) {
        at = (at + (next ? 1 : l->name_count - 1) + l->name_count) % l->name_count;
        return lab_open(l, l->names[at]);
    }
    return lab_open(l, argument);
}

// The list with its filter open.
bool act_find_scenario(lab *l, const char *argument)
{
    act_open_scenario_by(l, "");
    snprintf(l->filter, sizeof l->filter, "%s", argument);
    l->filtering = true;
    return true;
}

static bool ends_with(const char *text, const char *end)
{
    size_t length = strlen(text), tail = strlen(end);
    return length > tail && strcmp(text + length - tail, end) == 0;
}

static void write_screen(lab *l, FILE *stream)
{
    screen s = {0};
    if (screen_resize(&s, l->width, l->height)) {
        lab_draw(l, &s);
        screen_dump(&s, l->glyphs, stream);
    }
    screen_finish(&s);
}

// Saves what the file's ending asks for: a picture, the rows, a scenario or the screen.
bool act_save(lab *l, const char *argument)
{
    const session *s = &l->session;
    fault f = {0};
    status code;
    if (argument[0] == '\0') {
        const char *slash = strrchr(s->base.name, '/');
        l->prompting = true;
        snprintf(l->prompt, sizeof l->prompt, "save %.200s.png", slash ? slash + 1 : s->base.name);
        lab_say(l, false,
                ".png .pdf .svg: the figure; .csv: the rows; .yaml: a scenario that "
                "gives this run; .txt: the screen");
        return true;
    }
    bool needs_all = !ends_with(argument, ".yaml") && !ends_with(argument, ".txt");
    if (needs_all && !lab_has_whole_run(l)) {
        return false;
    }
    if (ends_with(argument, ".png") || ends_with(argument, ".pdf") || ends_with(argument, ".svg")) {
        code =
            plot_run_beside(&s->effective, &s->run, s->has_other ? &s->other : NULL, argument, &f);
    } else if (!ends_with(argument, ".csv") && !ends_with(argument, ".yaml") &&
               !ends_with(argument, ".txt")) {
        code = fault_set(&f, STATUS_BAD_ARGUMENT,
                         "the file's name must end in .png, .pdf, .svg, .csv, .yaml or .txt");
    } else {
        whole_file file;
        code = whole_file_open(&file, argument, &f);
        if (code == STATUS_OK) {
            if (ends_with(argument, ".csv")) {
                export_csv(file.stream, &s->run.trace, s->effective.parameters.arm.links);
            } else if (ends_with(argument, ".yaml")) {
                scenario_write(file.stream, &s->effective);
            } else {
                write_screen(l, file.stream);
            }
            code = whole_file_commit(&file, &f);
        }
    }
    if (lab_complain(l, code, &f)) {
        lab_say(l, false, "saved %s", argument);
    }
    return code == STATUS_OK;
}

// The arm in space at the cursor's instant.
bool act_save_scene(lab *l, const char *argument)
{
    const session *s = &l->session;
    const scene_options options = {0};
    fault f = {0};
    if (argument[0] == '\0') {
        l->prompting = true;
        snprintf(l->prompt, sizeof l->prompt, "scene arm.png");
        return true;
    }
    if (!lab_has_whole_run(l)) {
        return false;
    }
    status code = scene_write(&s->effective, &s->run, &options, &s->now, 1, argument, &f);
    if (lab_complain(l, code, &f)) {
        lab_say(l, false, "saved %s", argument);
    }
    return code == STATUS_OK;
}
