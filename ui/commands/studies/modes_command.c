// impactlab modes: natural frequencies and shapes of the arm.
#include "ui/commands/command.h"

#include <math.h>
#include <stdio.h>

#include "src/arm/modes.h"
#include "src/base/json.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/results.h"

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

// The modes of an arm that is held in one way.
typedef struct mode_set {
    int count;
    double *frequencies; // [rad/s]
    double *shapes;      // [count * dof], largest angle 1
} mode_set;

typedef struct arm_modes {
    const scenario *scenario;
    arm arm;
    mode_set sets[HOLDS];
} arm_modes;

static void arm_modes_finish(arm_modes *m)
{
    for (int i = 0; i < HOLDS; i++) {
        g_free(m->sets[i].frequencies);
        g_free(m->sets[i].shapes);
    }
}

// --- numbers ---------------------------------------------------------------------------

// Frequencies and shapes for each way of holding the arm.
static json_t *modes_json(const void *found)
{
    const arm_modes *m = found;
    const int dof = m->arm.dof;
    json_t *array = json_array();

    // an entry for each way of holding the arm
    for (int i = 0; i < HOLDS; i++) {
        const mode_set *set = &m->sets[i];
        json_t *shapes = json_array(), *frequencies = json_array();
        for (int mode = 0; mode < set->count; mode++) {
            json_add(shapes, json_numbers(set->shapes + mode * dof, dof));
            json_add(frequencies, json_number(1 / TWO_PI * set->frequencies[mode]));
        }

        json_add(array, json_of("hub:t tip:t frequency_Hz:o shapes:o", holds[i].hub_name,
                                holds[i].tip_name, frequencies, shapes));
    }
    return json_of("scenario:t modes:o", m->scenario->name, array);
}

// The line of a mode: its frequency, and the first angles of its shape.
static void print_mode(const arm *a, const mode_set *set, int mode)
{
    const double frequency = set->frequencies[mode];
    printf("  %4d  %14.5g  %8.5g  ", mode + 1, frequency / TWO_PI, frequency);
    for (int k = 0; k < a->dof && k < ANGLES_SHOWN; k++) {
        double angle = set->shapes[mode * a->dof + k];
        if (fabs(angle) < 5e-5) {
            angle = 0; // no minus before a zero
        }
        printf(" %7.4f", angle);
    }
    if (a->dof > ANGLES_SHOWN) {
        printf(" ...");
    }
    printf("\n");
}

// The table of the first modes of a set.
static void print_set(const arm *a, const mode_set *set)
{
    if (set->count == 0) {
        printf("  nothing can move\n");
        return;
    }
    printf("  mode  frequency [Hz]   [rad/s]   angles, the largest is 1\n");
    for (int mode = 0; mode < set->count && mode < MODES_SHOWN; mode++) {
        print_mode(a, set, mode);
    }
    if (set->count > MODES_SHOWN) {
        printf("  ... and %d more (--json lists all)\n", set->count - MODES_SHOWN);
    }
}

// A table for each way of holding the arm.
static void print_modes(const void *found)
{
    const arm_modes *m = found;
    say_title(m->scenario);
    printf("small vibrations of the straight arm, %d link%s, without damping\n",
           m->arm.links, plural_ending((size_t)m->arm.links));
    for (int i = 0; i < HOLDS; i++) {
        printf("\nHub %s, tip %s\n", holds[i].hub_name, holds[i].tip_name);
        print_set(&m->arm, &m->sets[i]);
    }
}

// --- the picture -----------------------------------------------------------------------

enum { MODES_DRAWN = 3, LINKS_WITH_MARKERS = 40 };

// Deflection at the joints of a mode's shape, from the hub to the tip, largest 1.
static void compute_deflections(const arm *a, const double *shape, double *x, double *y)
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

// One panel of the picture, with what its curves need.
typedef struct modes_panel {
    figure_series series[MODES_DRAWN];
    char labels[MODES_DRAWN][48], heading[64];
    figure_note note;
} modes_panel;

// Fills a panel with the first modes of a set; `numbers` has room for the points of each.
static figure_panel modes_panel_of(modes_panel *p, const arm *a, const mode_set *set,
                                   double *numbers)
{
    static const int colours[MODES_DRAWN] = {0, 5, 2};

    // a curve for each of the first modes, labelled by its frequency
    const size_t points = (size_t)a->links + 1;
    int drawn = 0;
    for (; drawn < set->count && drawn < MODES_DRAWN; drawn++) {
        double *x = numbers + 2 * points * (size_t)drawn, *y = x + points;
        compute_deflections(a, set->shapes + drawn * a->dof, x, y);

        char *label = p->labels[drawn];
        snprintf(label, sizeof p->labels[drawn], "%.3g\u2009Hz",
                 set->frequencies[drawn] / TWO_PI);
        figure_series *curve = &p->series[drawn];
        *curve = curve_of(label, label, x, y, points, colours[drawn]);
        curve->marker = MARKER_NONE;
        if (a->links <= LINKS_WITH_MARKERS) {
            curve->marker = MARKER_CIRCLE;
        }
    }

    // the panel, with a remark where there is no curve
    figure_panel panel = {.heading = p->heading,
                          .y = {.name = "deflection",
                                .label = "Deflection, largest 1",
                                .symbol = "Deflection",
                                .low = -1.15,
                                .high = 1.15},
                          .series = p->series,
                          .series_count = drawn};
    if (drawn == 0) {
        panel.remark = "nothing can move";
    } else if (drawn == 1) {
        // without a legend the curve's farthest point tells the frequency
        size_t farthest = 0;
        for (size_t i = 1; i < points; i++) {
            if (fabs(p->series[0].y[i]) > fabs(p->series[0].y[farthest])) {
                farthest = i;
            }
        }
        p->note = (figure_note){p->series[0].x[farthest], p->series[0].y[farthest],
                                p->labels[0]};
        panel.notes = &p->note;
        panel.note_count = 1;
    }
    return panel;
}

// The shapes of the first modes, a panel for each way of holding the arm.
static int plot_modes(const arguments *args, const void *found)
{
    const arm_modes *m = found;
    const size_t numbers_of_panel = (size_t)MODES_DRAWN * 2 * ((size_t)m->arm.links + 1);
    g_autofree double *numbers = g_new0(double, HOLDS *numbers_of_panel);

    // a panel for each way of holding the arm, a curve for each of its first modes
    modes_panel contents[HOLDS];
    figure_panel panels[HOLDS];
    for (int i = 0; i < HOLDS; i++) {
        snprintf(contents[i].heading, sizeof contents[i].heading, "hub %s, tip %s",
                 holds[i].hub_name, holds[i].tip_name);
        panels[i] = modes_panel_of(&contents[i], &m->arm, &m->sets[i],
                                   numbers + (size_t)i * numbers_of_panel);
    }

    const figure fig = {.x = {.name = "position",
                              .label = "Position along the arm",
                              .unit = "m",
                              .room = 0.02},
                        .panels = panels,
                        .panel_count = HOLDS,
                        .columns = 2,
                        .shared_y = true};
    return publish_titled(args, m->scenario, "first modes of the arm", &fig);
}

// --- the command -----------------------------------------------------------------------

// Computes the modes for each way of holding the arm.
static status compute_modes(arm_modes *m)
{
    arm_init(&m->arm, &m->scenario->parameters);
    const size_t n = (size_t)m->arm.dof;
    for (int i = 0; i < HOLDS; i++) {
        mode_set *set = &m->sets[i];
        set->frequencies = g_new0(double, n);
        set->shapes = g_new0(double, n *n);
        TRY(modes_compute(&m->arm, holds[i].hub, holds[i].tip, &set->count,
                          set->frequencies, set->shapes));
    }
    return STATUS_OK;
}

// The command: computes the modes and writes them.
static int compute_and_report_modes(const arguments *args, scenario *s)
{
    // errata B1: no natural frequencies without a symmetric stiffness
    if (s->parameters.arm.model == ARM_PRINTED) {
        return complain(
            "the printed equations have no symmetric stiffness and so no natural "
            "frequencies, try --set arm.model=corrected");
    }

    static const command_results results = {.json = modes_json,
                                            .text = print_modes,
                                            .plot = plot_modes};
    SCOPED(arm_modes_finish) arm_modes m = {.scenario = s};
    const status code = compute_modes(&m);
    if (code != STATUS_OK) {
        return complain_fault(&(fault){.code = code});
    }
    return write_results(args, &results, &m, true);
}

static const option_row rows[] = {PLOT_OPTION("draw the first modes' shapes")};

const command modes_command = {
    .name = "modes",
    .group = GROUP_ONE_RUN,
    .summary = "Natural frequencies and shapes of the arm",
    .operands = "SCENARIO",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .help =
        "Small vibrations about the straight arm without damping and friction, for a hub "
        "that is locked (held by\n"
        "the controller) or free, and a tip that is free or pinned to the wall.\n",
    .options = {&set_options, &json_options, OWN_OPTIONS(rows), &quiet_options,
                &page_options},
    .use = compute_and_report_modes,
};
