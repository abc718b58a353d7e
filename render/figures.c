#include "render/figures.h"

#include <errno.h>
#include <glib.h>
#include <string.h>
#include <sys/stat.h>

#include "render/figure_file.h"

#define FORCE                                                                                      \
    {                                                                                              \
        .signals = {"force"}, .with_zero = true, .inset = true, .weight = 1.6                      \
    }
#define VELOCITY(body)                                                                             \
    {                                                                                              \
        .signals = { body "_velocity" }                                                            \
    }
#define ANGLE(body)                                                                                \
    {                                                                                              \
        .signals = {body "_angle"}, .wall = true                                                   \
    }
#define ACCELERATION(body)                                                                         \
    {                                                                                              \
        .signals = { body "_acceleration" }                                                        \
    }

const thesis_figure thesis_figures[] = {
    {"3.2",
     "fig-3-2",
     "Motion of the hub at 1 V, step 1 ms",
     "thesis/fig-3-2",
     {VELOCITY("hub"), ANGLE("hub")},
     2},
    {"3.3",
     "fig-3-3",
     "Motion of the last link at 1 V, step 1 ms",
     "thesis/fig-3-3",
     {VELOCITY("last"), ANGLE("last")},
     2},
    {"3.4", "fig-3-4", "Contact force at 1 V, step 1 ms", "thesis/fig-3-4", {FORCE}, 1},
    {"3.5",
     "fig-3-5",
     "Acceleration of the last link at 1 V, step 1 ms",
     "thesis/fig-3-5",
     {{.signals = {"last_acceleration"}, .weight = 1.6}},
     1},
    {"3.6",
     "fig-3-6",
     "Motion of the hub at 1 V, step 10 ms",
     "thesis/fig-3-6",
     {VELOCITY("hub"), ANGLE("hub")},
     2},
    {"3.7", "fig-3-7", "Contact force at 1 V, step 10 ms", "thesis/fig-3-7", {FORCE}, 1},
    {"3.8",
     "fig-3-8",
     "Motion of the last link at 1 V, step 10 ms",
     "thesis/fig-3-8",
     {ACCELERATION("last"), VELOCITY("last"), ANGLE("last")},
     3},
    {"3.9",
     "fig-3-9",
     "Motion of the hub at 5 V, step 1 ms",
     "thesis/fig-3-9",
     {VELOCITY("hub"), ANGLE("hub")},
     2},
    {"3.10", "fig-3-10", "Contact force at 5 V, step 1 ms", "thesis/fig-3-10", {FORCE}, 1},
    {"3.11",
     "fig-3-11",
     "Motion of the last link at 5 V, step 1 ms",
     "thesis/fig-3-11",
     {ACCELERATION("last"), VELOCITY("last"), ANGLE("last")},
     3},
};
const int thesis_figure_count = (int)G_N_ELEMENTS(thesis_figures);

const thesis_figure *thesis_figure_find(const char *id)
{
    for (int i = 0; i < thesis_figure_count; i++) {
        if (strcmp(thesis_figures[i].id, id) == 0 || strcmp(thesis_figures[i].file, id) == 0) {
            return &thesis_figures[i];
        }
    }
    return NULL;
}

// Keeps the first of a scenario's faults.
static void keep_first(void *context, const char *sentence)
{
    fault *f = context;
    if (f != NULL && f->code == STATUS_OK) {
        fault_set(f, STATUS_BAD_SCENARIO, "%s", sentence);
    }
}

// A run with its scenario, finished by run_end.
typedef struct opened_run {
    scenario scenario;
    run_result result;
} opened_run;

static void run_end(opened_run *r)
{
    run_finish(&r->result);
    scenario_finish(&r->scenario);
}

// Opens and runs a scenario, with the model changed if `model` is not NULL.
static status run_begin(opened_run *r, const char *name, const char *model, fault *f)
{
    fault first = {STATUS_OK, ""};
    status code = scenario_open(&r->scenario, name, keep_first, &first);
    if (code != STATUS_OK) {
        return fault_set(f, code, "%s", first.text);
    }
    if (model != NULL) {
        code = scenario_override(&r->scenario, model, f);
    }
    if (code == STATUS_OK) {
        code = run_scenario(&r->scenario, true, &r->result);
        if (code == STATUS_OK) {
            return code;
        }
        fault_set(f, code, "%s: %s", name, r->result.summary.message);
        run_finish(&r->result);
    }
    scenario_finish(&r->scenario);
    return code;
}

static status check_formats(char *const *formats, fault *f)
{
    for (int i = 0; formats[i] != NULL; i++) {
        if (picture_format_of(formats[i]) == FORMAT_NONE) {
            return fault_set(f, STATUS_BAD_ARGUMENT,
                             "there is no figure format '%s', expected png, pdf or svg",
                             formats[i]);
        }
    }
    return STATUS_OK;
}

static status write_files(const figure *fig, const thesis_figure *which, const char *folder,
                          char *const *formats, fault *f)
{
    status code = STATUS_OK;
    if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
        return fault_set(f, STATUS_CANNOT_WRITE, "the folder '%s' cannot be made: %s", folder,
                         strerror(errno));
    }
    for (int i = 0; formats[i] != NULL && code == STATUS_OK; i++) {
        char *path = g_strdup_printf("%s/%s.%s", folder, which->file, formats[i]);
        code = figure_write(fig, path, f);
        g_free(path);
    }
    if (code == STATUS_OK) {
        char *path = g_strdup_printf("%s/%s.csv", folder, which->file);
        code = figure_write_csv(fig, path, f);
        g_free(path);
    }
    return code;
}

static status draw_runs(const thesis_figure *which, const opened_run *printed,
                        const opened_run *corrected, const char *folder, char *const *formats,
                        fault *f)
{
    const trace_run runs[] = {{&printed->scenario, &printed->result, "printed"},
                              {&corrected->scenario, &corrected->result, "corrected"}};
    trace_figure t;
    char *title = g_strdup_printf("Fig. %s  %s", which->id, which->caption);
    status code = trace_figure_init(&t, title, which->panels, which->panel_count, runs, 2, f);
    if (code == STATUS_OK) {
        code = write_files(&t.figure, which, folder, formats, f);
        trace_figure_finish(&t);
    }
    g_free(title);
    return code;
}

status figure_draw(const char *id, const char *folder, const char *formats, fault *f)
{
    const thesis_figure *which = thesis_figure_find(id);
    if (which == NULL) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "there is no figure '%s', expected %s to %s", id,
                         thesis_figures[0].id, thesis_figures[thesis_figure_count - 1].id);
    }
    char **list = g_strsplit(formats, ",", -1);
    opened_run printed, corrected;
    status code = check_formats(list, f);
    if (code == STATUS_OK) {
        code = run_begin(&printed, which->scenario, NULL, f);
        if (code == STATUS_OK) {
            code = run_begin(&corrected, which->scenario, "arm.model=corrected", f);
            if (code == STATUS_OK) {
                code = draw_runs(which, &printed, &corrected, folder, list, f);
                run_end(&corrected);
            }
            run_end(&printed);
        }
    }
    g_strfreev(list);
    return code;
}
