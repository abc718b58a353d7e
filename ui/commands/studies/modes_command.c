// impactlab modes: natural frequencies and shapes of the arm.
#include "ui/commands/command.h"

#include <math.h>
#include <stdlib.h>

#include "src/arm/modes.h"
#include "src/base/json.h"
#include "ui/commands/command_pictures.h"

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

typedef struct arm_modes {
    arm arm;
    mode_set sets[HOLDS];
} arm_modes;

static json_t *modes_object(const scenario *s, const void *found)
{
    const arm *a = &((const arm_modes *)found)->arm;
    const mode_set *sets = ((const arm_modes *)found)->sets;
    json_t *array = json_array();
    for (int i = 0; i < HOLDS; i++) {
        json_t *shapes = json_array(), *frequencies = json_array();
        for (int mode = 0; mode < sets[i].count; mode++) {
            json_add(shapes, json_numbers(sets[i].shapes + mode * a->dof, a->dof));
            json_add(frequencies, json_number(1 / TWO_PI * sets[i].frequencies[mode]));
        }
        json_add(array, json_of("hub:t tip:t frequency_Hz:o shapes:o", holds[i].hub_name,
                                holds[i].tip_name, frequencies, shapes));
    }
    return json_of("scenario:t modes:o", s->name, array);
}

static void print_set(const arm *a, const mode_set *set, const char *hub, const char *tip)
{
    int shown = set->count < MODES_SHOWN ? set->count : MODES_SHOWN;
    int angles = a->dof < ANGLES_SHOWN ? a->dof : ANGLES_SHOWN;

    printf("\nHub %s, tip %s\n", hub, tip);
    printf("%s\n", shown > 0
                       ? "  mode  frequency [Hz]   [rad/s]   angles, the largest is 1"
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
        const double length = arm_link_of(a, i).length;
        x[i + 1] = x[i] + length;
        y[i + 1] = y[i] + length * links[i];
        largest = fmax(largest, fabs(y[i + 1]));
    }

    // a mode has no size of its own
    for (int i = 0; i <= a->links && largest > 0; i++) {
        y[i] /= largest;
    }
}

static int plot_modes(const arguments *args, const scenario *s, const void *found)
{
    const arm *a = &((const arm_modes *)found)->arm;
    const mode_set *sets = ((const arm_modes *)found)->sets;
    static const int colours[MODES_DRAWN] = {0, 5, 2};
    figure_series series[HOLDS][MODES_DRAWN] = {{{0}}};
    figure_panel panels[HOLDS] = {{0}};
    char headings[HOLDS][64], labels[HOLDS][MODES_DRAWN][48];
    size_t points = (size_t)a->links + 1;
    SCOPED(free_kept)
    double *numbers = calloc((size_t)HOLDS * MODES_DRAWN * 2 * points, sizeof *numbers);
    if (numbers == NULL) {
        return worse(EXIT_FAILED, complain("out of memory"));
    }

    // a panel for each way of holding the arm, a curve for each of its first modes
    for (int i = 0; i < HOLDS; i++) {
        int shown = sets[i].count < MODES_DRAWN ? sets[i].count : MODES_DRAWN;
        for (int m = 0; m < shown; m++) {
            double *x = numbers + (size_t)(i * MODES_DRAWN + m) * 2 * points,
                   *y = x + points;
            deflections(a, sets[i].shapes + m * a->dof, x, y);
            snprintf(labels[i][m], sizeof labels[i][m], "%.3g\u2009Hz",
                     sets[i].frequencies[m] / TWO_PI);
            series[i][m] = curve_of(labels[i][m], labels[i][m], x, y, points, colours[m]);
            if (a->links <= 40) {
                series[i][m].marker = MARKER_CIRCLE;
            } else {
                series[i][m].marker = MARKER_NONE;
            }
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
    const figure fig = {.x = {.name = "position",
                              .label = "Position along the arm",
                              .unit = "m",
                              .room = 0.02},
                        .panels = panels,
                        .panel_count = HOLDS,
                        .columns = 2,
                        .shared_y = true};
    return publish_titled(args, s, "first modes of the arm", &fig);
}

static void print_modes(const scenario *s, const void *found)
{
    const arm_modes *m = found;
    say_title(s);
    printf("small vibrations of the straight arm, %d link%s, without damping\n",
           m->arm.links, m->arm.links == 1 ? "" : "s");
    for (int i = 0; i < HOLDS; i++) {
        print_set(&m->arm, &m->sets[i], holds[i].hub_name, holds[i].tip_name);
    }
}

static int modes(const arguments *args, scenario *s)
{
    static const command_results r = {modes_object, print_modes, plot_modes};
    arm_modes m = {0};
    fault f = {.code = STATUS_OK};
    // errata B1: no natural frequencies without a symmetric stiffness
    if (s->parameters.arm.model == ARM_PRINTED) {
        return complain(
            "the printed equations have no symmetric stiffness and so no natural "
            "frequencies, try --set arm.model=corrected");
    }

    arm_init(&m.arm, &s->parameters);
    const size_t n = (size_t)m.arm.dof;
    for (int i = 0; i < HOLDS && f.code == STATUS_OK; i++) {
        mode_set *set = &m.sets[i];
        set->frequencies = calloc(n, sizeof *set->frequencies);
        set->shapes = calloc(n * n, sizeof *set->shapes);
        if (set->frequencies != NULL && set->shapes != NULL) {
            f.code = modes_compute(&m.arm, holds[i].hub, holds[i].tip, &set->count,
                                   set->frequencies, set->shapes);
        } else {
            f.code = STATUS_NO_MEMORY;
        }
    }

    int result =
        f.code == STATUS_OK ? write_results(args, &r, s, &m, true) : complain_fault(&f);
    for (int i = 0; i < HOLDS; i++) {
        free(m.sets[i].frequencies);
        free(m.sets[i].shapes);
    }
    return result;
}

static const option_row rows[] = {PLOT_OPTION("draw the first modes' shapes")};

const command modes_command = {
    CALLED("modes", ONE_RUN, "Natural frequencies and shapes of the arm"),
    ONE_SCENARIO,
    .help = "Small vibrations about the straight arm without damping and "
            "friction, for a hub that is locked (held by\nthe controller) or "
            "free, and a tip that is free or pinned to the wall.\n",
    .options = {&set_options, &json_options, OWN_OPTIONS(rows), &quiet_options,
                &page_options},
    .use = modes,
};
