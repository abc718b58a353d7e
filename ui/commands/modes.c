#include "ui/commands/command.h"

#include <math.h>
#include <stdlib.h>

#include "src/arm/modes.h"
#include "src/base/json.h"

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
        json_array_append_new(array, json_number(scale * values[i]));
    }
    return array;
}

static json_t *modes_object(const scenario *s, const arm *a, const mode_set *sets)
{
    json_t *object = json_object(), *array = json_array();
    json_object_set_new(object, "scenario", json_text(s->name));
    for (int i = 0; i < HOLDS; i++) {
        json_t *entry = json_object(), *shapes = json_array();
        for (int mode = 0; mode < sets[i].count; mode++) {
            json_array_append_new(shapes, array_of(sets[i].shapes + mode * a->dof, a->dof, 1));
        }
        json_object_set_new(entry, "hub", json_string(holds[i].hub_name));
        json_object_set_new(entry, "tip", json_string(holds[i].tip_name));
        json_object_set_new(entry, "frequency_Hz",
                            array_of(sets[i].frequencies, sets[i].count, 1 / TWO_PI));
        json_object_set_new(entry, "shapes", shapes);
        json_array_append_new(array, entry);
    }
    json_object_set_new(object, "modes", array);
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

static int report(const arguments *args, const scenario *s, const arm *a, const mode_set *sets)
{
    int result = EXIT_DONE;
    if (args->json != NULL) {
        result = write_json(args->json, modes_object(s, a, sets));
    }
    if (summary_wanted(args)) {
        printf("%s: %s\nsmall vibrations of the straight arm, %d link%s, without damping\n",
               s->name, s->title, a->links, a->links == 1 ? "" : "s");
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

static int modes(const arguments *a)
{
    return with_scenario(a->operands[0], a, check_and_compute);
}

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
    .options = {&set_options, &json_options, &quiet_options},
    .run = modes,
};
