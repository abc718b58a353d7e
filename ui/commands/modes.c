#include "ui/commands/command.h"

#include <math.h>
#include <stdlib.h>

#include "src/arm/modes.h"
#include "src/base/json.h"
#include "ui/commands/pictures.h"

#define TWO_PI (2 * 3.14159265358979323846)

enum { MODES_SHOWN = 8, ANGLES_SHOWN = 6 };

// The four ways in which the arm is held.
static const struct {
    hub_end hub;
    tip_end tip;
    const char *hub_name, *tip_name;
} holds[] = {
    {HUB_LOCKED, TIP_FREE, "locked", "free"},
    {HUB_LOCKED, TIP_PINNED, "locked", "pinned"},
    {HUB_FREE, TIP_FREE, "free", "free"},
    {HUB_FREE, TIP_PINNED, "free", "pinned"},
};
enum { HOLDS = sizeof holds / sizeof holds[0] };

typedef struct mode_set {
    int count;
    double *frequencies; // [rad/s]
    double *shapes;      // [count * dof], largest angle 1
} mode_set;

static json_t *array_of(const double *values, int count, double scale)
{
    json_t *array = json_array();
    for (int i = 0; i < count; i++) {
        json_add(array, json_number(scale * values[i]));
    }
    return array;
}

static json_t *modes_object(const scenario *s, const arm *a, const mode_set *sets)
{
    json_t *object = json_object(), *array = json_array();
    json_put(object, "scenario", json_text(s->name));

    for (int i = 0; i < HOLDS; i++) {
        json_t *entry = json_object(), *shapes = json_array();
        for (int mode = 0; mode < sets[i].count; mode++) {
            json_add(shapes, array_of(sets[i].shapes + mode * a->dof, a->dof, 1));
        }

        json_put(entry, "hub", json_string(holds[i].hub_name));
        json_put(entry, "tip", json_string(holds[i].tip_name));
        json_put(entry, "frequency_Hz", array_of(sets[i].frequencies, sets[i].count, 1 / TWO_PI));
        json_put(entry, "shapes", shapes);
        json_add(array, entry);
    }

    json_put(object, "modes", array);
    return object;
}

static void print_set(const arm *a, const mode_set *set, const char *hub, const char *tip)
{
    int shown = set->count < MODES_SHOWN ? set->count : MODES_SHOWN;
    int angles = a->dof < ANGLES_SHOWN ? a->dof : ANGLES_SHOWN;

    printf("\nHub %s, tip %s\n", hub, tip);
    printf("%s\n", shown > 0 ? "  mode  frequency [Hz]   [rad/s]   angles, the largest is 1"
                             : "  nothing can move");

    for (int mode = 0; mode < shown; mode++) {
        printf("  %4d  %14.5g  %8.5g  ", mode + 1, set->frequencies[mode] / TWO_PI,
               set->frequencies[mode]);
        for (int k = 0; k < angles; k++) {
            double angle = set->shapes[mode * a->dof + k];
            // no minus before a zero
            printf(" %7.4f", fabs(angle) < 5e-5 ? 0 : angle);
        }
        printf("%s\n", angles < a->dof ? " ..." : "");
    }

    if (shown < set->count) {
        printf("  ... and %d more (--json lists all)\n", set->count - shown);
    }
}

// ---- the picture

enum { MODES_DRAWN = 3 };

// Deflection at the joints of a mode's shape, from the hub to the tip, largest 1.
static void deflections(const arm *a, const double *shape, double *x, double *y)
{
    // the hub's own angle moves nothing
    const double *links = shape + (a->dof - a->links);
    double largest = 0;

    // from joint to joint, each link at its own angle
    x[0] = y[0] = 0;
    for (int i = 0; i < a->links; i++) {
        const double length = arm_link_length(a, i);
        x[i + 1] = x[i] + length;
        y[i + 1] = y[i] + length * links[i];
        largest = fmax(largest, fabs(y[i + 1]));
    }

    // a mode has no size of its own
    for (int i = 0; i <= a->links && largest > 0; i++) {
        y[i] /= largest;
    }
}

static int plot_modes(const arguments *args, const scenario *s, const arm *a, const mode_set *sets)
{
    static const int colours[MODES_DRAWN] = {0, 5, 2};
    figure_series series[HOLDS][MODES_DRAWN] = {{{0}}};
    figure_panel panels[HOLDS] = {{0}};
    char headings[HOLDS][64], labels[HOLDS][MODES_DRAWN][48], title[256 + SCENARIO_CHANGES],
        changes[SCENARIO_CHANGES];
    size_t points = (size_t)a->links + 1;
    double *numbers = calloc((size_t)HOLDS * MODES_DRAWN * 2 * points, sizeof *numbers);
    if (numbers == NULL) {
        return worse(EXIT_FAILED, complain("out of memory"));
    }

    // a panel for each way of holding the arm, a curve for each of its first modes
    for (int i = 0; i < HOLDS; i++) {
        int shown = sets[i].count < MODES_DRAWN ? sets[i].count : MODES_DRAWN;
        for (int m = 0; m < shown; m++) {
            double *x = numbers + (size_t)(i * MODES_DRAWN + m) * 2 * points, *y = x + points;
            deflections(a, sets[i].shapes + m * a->dof, x, y);
            snprintf(labels[i][m], sizeof labels[i][m], "%.3g\u2009Hz",
                     sets[i].frequencies[m] / TWO_PI);
            series[i][m] = (figure_series){.name = labels[i][m],
                                           .label = labels[i][m],
                                           .x = x,
                                           .y = y,
                                           .count = points,
                                           .colour = colours[m],
                                           .marker = a->links <= 40 ? MARKER_CIRCLE : MARKER_NONE};
        }
        snprintf(headings[i], sizeof headings[i], "hub %s, tip %s", holds[i].hub_name,
                 holds[i].tip_name);
        panels[i] = (figure_panel){.heading = headings[i],
                                   .remark = shown == 0 ? "nothing can move" : NULL,
                                   .y = {.name = "deflection",
                                         .label = "Deflection, largest 1",
                                         .symbol = "Deflection",
                                         .low = -1.15,
                                         .high = 1.15},
                                   .series = series[i],
                                   .series_count = shown};
    }
    snprintf(title, sizeof title, "%s: first modes of the arm%s", s->name,
             scenario_changes(s, changes));
    const figure fig = {
        .title = title,
        .x = {.name = "position", .label = "Position along the arm", .unit = "m", .room = 0.02},
        .panels = panels,
        .panel_count = HOLDS,
        .columns = 2,
        .shared_y = true};
    int code = publish_figure(args, &fig);
    free(numbers);
    return code;
}

static int report(const arguments *args, const scenario *s, const arm *a, const mode_set *sets)
{
    int result = EXIT_DONE;

    // a fault in one result does not keep back the others
    if (args->json != NULL) {
        result = write_json(args->json, modes_object(s, a, sets));
    }
    if (args->plot != NULL) {
        result = worse(result, plot_modes(args, s, a, sets));
    }

    // what is meant to be read at once
    if (summary_wanted(args)) {
        say_title(s);
        printf("small vibrations of the straight arm, %d link%s, without damping\n", a->links,
               a->links == 1 ? "" : "s");
        for (int i = 0; i < HOLDS; i++) {
            print_set(a, &sets[i], holds[i].hub_name, holds[i].tip_name);
        }
    }
    return result;
}

static status compute_set(const arm *a, mode_set *set, int hold)
{
    size_t n = (size_t)a->dof;
    set->frequencies = calloc(n, sizeof *set->frequencies);
    set->shapes = calloc(n * n, sizeof *set->shapes);
    if (set->frequencies == NULL || set->shapes == NULL) {
        return STATUS_NO_MEMORY;
    }
    return modes_compute(a, holds[hold].hub, holds[hold].tip, &set->count, set->frequencies,
                         set->shapes);
}

static int compute_and_report(const arguments *args, const scenario *s)
{
    arm a;
    mode_set sets[HOLDS] = {{0}};
    fault f = {.code = STATUS_OK};

    arm_init(&a, &s->parameters);
    for (int i = 0; i < HOLDS && f.code == STATUS_OK; i++) {
        f.code = compute_set(&a, &sets[i], i);
    }

    int result = f.code == STATUS_OK ? report(args, s, &a, sets) : complain_fault(&f);
    for (int i = 0; i < HOLDS; i++) {
        free(sets[i].frequencies);
        free(sets[i].shapes);
    }
    return result;
}

static int check_and_compute(const arguments *args, scenario *s)
{
    if (s->parameters.arm.model == ARM_PRINTED) {
        // errata B1: no natural frequencies without a symmetric stiffness
        return complain("the printed equations have no symmetric stiffness and so no natural "
                        "frequencies, try --set arm.model=corrected");
    }
    return compute_and_report(args, s);
}

static const option_row rows[] = {PLOT_OPTION("draw the first modes' shapes")};
static const option_table options = OPTION_TABLE("Options", rows);

const command modes_command = {
    .name = "modes",
    .group = GROUP_ONE_RUN,
    .operands = "SCENARIO",
    .summary = "Natural frequencies and shapes of the arm",
    .help = "Small vibrations about the straight arm without damping and friction, for a hub that "
            "is locked (held by\nthe controller) or free, and a tip that is free or pinned to the "
            "wall.\n",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .options = {&set_options, &json_options, &options, &quiet_options, &page_options},
    .use = check_and_compute,
};
