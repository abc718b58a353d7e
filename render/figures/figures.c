#include "render/figures/figures.h"

#include <glib.h>
#include <string.h>

#include "render/figures/diagrams.h"
#include "render/figures/impact_figures.h"
#include "render/plot/opened_run.h"
#include "render/plot/overlay.h"
#include "render/figures/stability_map.h"
#include "render/figures/thesis_tables.h"

// Panels that several figures have.
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
#define ENCODER(other)                                                                             \
    {                                                                                              \
        .label = "Hub angle", .signals = {"encoder", other}, .weight = 1.2                         \
    }
#define TACHOMETER(other)                                                                          \
    {                                                                                              \
        .label = "Hub velocity", .signals = {"tachometer", other}, .weight = 1.2                   \
    }
#define FORCE_READING                                                                              \
    {                                                                                              \
        .label = "Contact force", .signals = {"force_reading", "force"}, .with_zero = true,        \
        .weight = 1.4                                                                              \
    }
#define CALCULATED_FORCE                                                                           \
    {                                                                                              \
        .label = "Contact force", .signals = {"calculated_force", "force"}, .with_zero = true,     \
        .weight = 1.4                                                                              \
    }
#define COMMAND                                                                                    \
    {                                                                                              \
        .label = "Command <i>u</i>", .signals = {"command"}, .with_zero = true, .modes = true,     \
        .weight = 1.2                                                                              \
    }

// A figure of chapter 3, and one of the virtual rig; each has a scenario of its own name.
#define RUN(number, name)                                                                          \
    .id = number, .file = name, .scenario = "thesis/" name, .model = "printed; corrected dashed"
#define RIG(number, name)                                                                          \
    .id = number, .file = name, .scenario = "thesis/" name, .model = "corrected, on the rig",      \
    .alone = true

const thesis_figure thesis_figures[] = {
    {.id = "2.1",
     .file = "fig-2-1",
     .caption = "Force sensor: interface circuit and its curve",
     .scenario = NULL,
     .model = "the rig's sensor",
     .open = diagram_sensor},
    {.id = "2.2",
     .file = "fig-2-2",
     .caption = "The arm as a hub and two links",
     .scenario = NULL,
     .model = "corrected",
     .open = diagram_links},
    {.id = "2.3",
     .file = "fig-2-3",
     .caption = "Torques and forces on each body",
     .scenario = NULL,
     .model = "corrected",
     .open = diagram_free_bodies},
    {RIG("2.4", "fig-2-4"), .caption = "Optical encoder under a constant 1 V",
     .panels = {ENCODER("hub_angle")}, .panel_count = 1},
    {RIG("2.5", "fig-2-5"), .caption = "Tachometer under a constant 1 V",
     .panels = {TACHOMETER("hub_velocity")}, .panel_count = 1},
    {RIG("2.6", "fig-2-6"), .caption = "Force sensor under a constant 1 V",
     .panels = {FORCE_READING}, .panel_count = 1},
    {.id = "T2.1",
     .file = "table-2-1",
     .caption = "Constants of the motor",
     .scenario = NULL,
     .model = "both",
     .open = table_motor},
    {.id = "3.1",
     .file = "fig-3-1",
     .caption = "The arm in contact at two successive steps",
     .scenario = "thesis/fig-3-1",
     .model = "printed",
     .open = figure_contact},
    {RUN("3.2", "fig-3-2"), .caption = "Motion of the hub at 1 V, step 1 ms",
     .panels = {VELOCITY("hub"), ANGLE("hub")}, .panel_count = 2},
    {RUN("3.3", "fig-3-3"), .caption = "Motion of the last link at 1 V, step 1 ms",
     .panels = {VELOCITY("last"), ANGLE("last")}, .panel_count = 2},
    {RUN("3.4", "fig-3-4"), .caption = "Contact force at 1 V, step 1 ms", .panels = {FORCE},
     .panel_count = 1},
    {RUN("3.5", "fig-3-5"), .caption = "Acceleration of the last link at 1 V, step 1 ms",
     .panels = {{.signals = {"last_acceleration"}, .weight = 1.6}}, .panel_count = 1},
    {RUN("3.6", "fig-3-6"), .caption = "Motion of the hub at 1 V, step 10 ms",
     .panels = {VELOCITY("hub"), ANGLE("hub")}, .panel_count = 2},
    {RUN("3.7", "fig-3-7"), .caption = "Contact force at 1 V, step 10 ms", .panels = {FORCE},
     .panel_count = 1},
    {RUN("3.8", "fig-3-8"), .caption = "Motion of the last link at 1 V, step 10 ms",
     .panels = {ACCELERATION("last"), VELOCITY("last"), ANGLE("last")}, .panel_count = 3},
    {RUN("3.9", "fig-3-9"), .caption = "Motion of the hub at 5 V, step 1 ms",
     .panels = {VELOCITY("hub"), ANGLE("hub")}, .panel_count = 2},
    {RUN("3.10", "fig-3-10"), .caption = "Contact force at 5 V, step 1 ms", .panels = {FORCE},
     .panel_count = 1},
    {RUN("3.11", "fig-3-11"), .caption = "Motion of the last link at 5 V, step 1 ms",
     .panels = {ACCELERATION("last"), VELOCITY("last"), ANGLE("last")}, .panel_count = 3},
    {.id = "T3.1",
     .file = "table-3-1",
     .caption = "Stability of Newmark's method",
     .scenario = NULL,
     .model = "both",
     .open = table_stability},
    {.id = "T3.2",
     .file = "table-3-2",
     .caption = "The algorithm of the constrained motion",
     .scenario = NULL,
     .model = "printed",
     .open = table_algorithm},
    {.id = "beta-gamma",
     .file = "beta-gamma",
     .caption = "Force error over Newmark's parameters",
     .scenario = "corrected/first-impact",
     .model = "corrected",
     .open = stability_map},
    {.id = "4.1",
     .file = "fig-4-1",
     .caption = "Springs in series against the wall",
     .scenario = "corrected/first-impact",
     .model = "corrected",
     .open = diagram_springs},
    {.id = "4.2",
     .file = "fig-4-2",
     .caption = "The arm at the instant of the collision",
     .scenario = "corrected/first-impact",
     .model = "corrected",
     .open = diagram_collision},
    {.id = "4.3",
     .file = "fig-4-3",
     .caption = "Contact force of an impact: impulse, then pulse",
     .scenario = "corrected/first-impact",
     .model = "corrected",
     .open = figure_force_profile},
    {.id = "4.4",
     .file = "fig-4-4",
     .caption = "Angular velocity during the pulse, assumed and computed",
     .scenario = "corrected/first-impact",
     .model = "corrected",
     .open = figure_linear_velocity},
    {.id = "4.5",
     .file = "fig-4-5",
     .caption = "Angle during the pulse, assumed and computed",
     .scenario = "corrected/first-impact",
     .model = "corrected",
     .open = figure_quadratic_angle},
    {.id = "4.6",
     .file = "fig-4-6",
     .caption = "The arm at its largest deformation",
     .scenario = "corrected/first-impact",
     .model = "corrected",
     .open = figure_peak_shape},
    {.id = "T4.1",
     .file = "table-4-1",
     .caption = "Peak force and delay, 100 times the nominal stiffness",
     .scenario = "thesis/table-4-1",
     .model = "printed and corrected",
     .open = table_hundredfold},
    {.id = "T4.2",
     .file = "table-4-2",
     .caption = "Peak force and delay, 10 times the nominal stiffness",
     .scenario = "thesis/table-4-2",
     .model = "printed and corrected",
     .open = table_tenfold},
    {.id = "T4.3",
     .file = "table-4-3",
     .caption = "Peak force and delay, the nominal stiffness",
     .scenario = "thesis/table-4-3",
     .model = "printed and corrected",
     .open = table_nominal},
    {.id = "errors",
     .file = "table-4-errors",
     .caption = "How near Tables 4.1 to 4.3 come out",
     .scenario = NULL,
     .model = "printed and corrected",
     .open = table_errors},
    {RIG("5.1", "fig-5-1"), .caption = "Hybrid control at 1 N: encoder and desired angle",
     .panels = {ENCODER("desired_angle")}, .panel_count = 1},
    {RIG("5.2", "fig-5-2"), .caption = "Hybrid control at 1 N: tachometer and desired velocity",
     .panels = {TACHOMETER("desired_velocity")}, .panel_count = 1},
    {RIG("5.3", "fig-5-3"), .caption = "Hybrid control at 1 N: force sensor",
     .panels = {FORCE_READING}, .panel_count = 1},
    {RIG("5.4", "fig-5-4"), .caption = "Hybrid control at 1 N: calculated tip force",
     .panels = {CALCULATED_FORCE}, .panel_count = 1},
    {RIG("5.5", "fig-5-5"), .caption = "Hybrid control at 1 N: command to the motor",
     .panels = {COMMAND}, .panel_count = 1},
    {RIG("5.6", "fig-5-6"), .caption = "Hybrid control at 2 N: angle and velocity of the hub",
     .panels = {ENCODER("desired_angle"), TACHOMETER("desired_velocity")}, .panel_count = 2},
    {RIG("5.7", "fig-5-7"), .caption = "Hybrid control at 2 N: force and command",
     .panels = {FORCE_READING, COMMAND}, .panel_count = 2},
};
const int thesis_figure_count = (int)G_N_ELEMENTS(thesis_figures);

const thesis_figure *thesis_figure_find(const char *id)
{
    for (int i = 0; i < thesis_figure_count; i++) {
        if (g_ascii_strcasecmp(thesis_figures[i].id, id) == 0 ||
            strcmp(thesis_figures[i].file, id) == 0) {
            return &thesis_figures[i];
        }
    }
    return NULL;
}

// ---- recorded signals
// ----------------------------------------------------------------------------

// A figure of recorded signals with the runs it borrows from.
typedef struct signal_figure {
    opened_run runs[2];
    int run_count;
    run_result overlay; // its trace alone
    trace_figure figure;
    char *title;
} signal_figure;

static void release_signals(void *owner)
{
    signal_figure *s = owner;
    trace_figure_finish(&s->figure);
    for (int i = 0; i < s->run_count; i++) {
        run_end(&s->runs[i]);
    }
    trace_finish(&s->overlay.trace);
    g_free(s->title);
    g_free(s);
}

// Runs the scenario, and once more with the corrected model unless it stands alone.
static status run_scenarios(signal_figure *s, const thesis_figure *which, fault *f)
{
    static const char *const changes[] = {NULL, "arm.model=corrected"};
    status code = STATUS_OK;
    for (int i = 0; i < (which->alone ? 1 : 2) && code == STATUS_OK; i++) {
        code = run_begin(&s->runs[i], which->scenario, changes[i], f);
        s->run_count += code == STATUS_OK;
    }
    return code;
}

// The runs as the figure shows them, and the overlay as one more; returns their number.
static int list_runs(const signal_figure *s, const figure_options *o, trace_run *runs)
{
    static const char *const names[] = {"printed", "corrected"};
    int count = 0;
    for (; count < s->run_count; count++) {
        runs[count] = (trace_run){.scenario = &s->runs[count].scenario,
                                  .result = &s->runs[count].result,
                                  .name = names[count]};
    }
    if (o->overlay != NULL) {
        const char *slash = strrchr(o->overlay, '/');
        runs[count++] = (trace_run){.scenario = &s->runs[0].scenario,
                                    .result = &s->overlay,
                                    .name = slash != NULL ? slash + 1 : o->overlay,
                                    .points = true};
    }
    return count;
}

static status open_signals(const thesis_figure *which, const char *title, const figure_options *o,
                           artwork *out, fault *f)
{
    signal_figure *s = g_new0(signal_figure, 1);
    status code = run_scenarios(s, which, f);
    if (code == STATUS_OK && o->overlay != NULL) {
        code = overlay_read(&s->overlay.trace, o->overlay, f);
    }
    if (code == STATUS_OK) {
        trace_run runs[TRACE_RUNS];
        int run_count = list_runs(s, o, runs);
        s->title = g_strdup(title);
        code = trace_figure_init(&s->figure, s->title, which->panels, which->panel_count, runs,
                                 run_count, f);
    }
    if (code != STATUS_OK) {
        release_signals(s);
        return code;
    }
    s->figure.figure.theme = o->theme;
    s->figure.figure.width = o->width_mm;
    s->figure.figure.dpi = o->dpi;
    *out = artwork_of_figure(&s->figure.figure, s, release_signals);
    return STATUS_OK;
}

// ---- any figure
// ----------------------------------------------------------------------------------

// "Fig. 3.4  ...", "Table 4.1  ...", or the caption alone.
static char *title_of(const thesis_figure *which)
{
    if (g_ascii_isdigit(which->id[0])) {
        return g_strdup_printf("Fig. %s  %s", which->id, which->caption);
    }
    if (which->id[0] == 'T') {
        return g_strdup_printf("Table %s  %s", which->id + 1, which->caption);
    }
    return g_strdup(which->caption);
}

status figure_open(const thesis_figure *which, const figure_options *o, artwork *out, fault *f)
{
    if (which->open != NULL && o->overlay != NULL) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "%s shows no recorded signals that %s could lie over", which->id,
                         o->overlay);
    }
    char *title = title_of(which);
    status code =
        which->open != NULL ? which->open(title, o, out, f) : open_signals(which, title, o, out, f);
    g_free(title);
    return code;
}

status figure_draw_as(const char *id, const figure_options *o, const char *folder,
                      const char *formats, fault *f)
{
    const thesis_figure *which = thesis_figure_find(id);
    if (which == NULL) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "there is no figure '%s', expected %s to %s", id,
                         thesis_figures[0].id, thesis_figures[thesis_figure_count - 1].id);
    }
    artwork drawn;
    char **list = g_strsplit(formats, ",", -1);
    status code = artwork_check_formats(list, f);
    if (code == STATUS_OK) {
        code = figure_open(which, o, &drawn, f);
    }
    if (code == STATUS_OK) {
        code = artwork_write(&drawn, o, folder, which->file, list, f);
        artwork_finish(&drawn);
    }
    g_strfreev(list);
    return code;
}

status figure_draw(const char *id, const char *folder, const char *formats, fault *f)
{
    const figure_options as_it_comes = {0};
    return figure_draw_as(id, &as_it_comes, folder, formats, f);
}
