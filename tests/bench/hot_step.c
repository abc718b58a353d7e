// The hot step alone, for counting its instructions: goes through a stretch of a motion
// again and again and prints how many time steps that were. tests/bench/instructions.sh
// runs it.
//
//   hot_step METHOD LINKS free|contact PASSES
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/contact/contact_machine.h"
#include "src/engines/motion_create.h"

#define STEP 1e-3 // [s]

static status go(const arm *a, motion *m, double until)
{
    status code = STATUS_OK;
    while (code == STATUS_OK && m->state[SLOT_TIME] < until) {
        motion_report report;
        code = motion_step(a, m, until, STEP, &report);
        if (code == STATUS_OK && report.event != MOTION_REACHED) {
            motion_apply(a, m, &report);
        }
    }
    return code;
}

static bool set(parameters *p, const char *path, const char *value)
{
    fault f;
    bool taken = parameter_set_text(p, parameter_find(path), value, &f) == STATUS_OK;
    if (!taken) {
        fprintf(stderr, "hot_step: %s\n", f.text);
    }
    return taken;
}

int main(int argc, char **argv)
{
    parameters p;
    arm a;
    fault f;
    if (argc != 5) {
        fprintf(stderr, "usage: hot_step METHOD LINKS free|contact PASSES\n");
        return 2;
    }
    parameters_defaults(&p, ARM_CORRECTED);
    if (!set(&p, "method.name", argv[1]) || !set(&p, "arm.links", argv[2]) ||
        !set(&p, "wall.kind", "plane") || parameters_resolve(&p, &f) != STATUS_OK) {
        return 2;
    }
    // the stretches of src/study/bench.c: two links before the hub sticks, many when they
    // rest
    bool contact = strcmp(argv[3], "contact") == 0, two = p.arm.links == 2;
    double from = !contact ? 0.05
                  : two    ? 0.30
                           : 0.7,
           to = !contact ? 0.25
                : two    ? 0.36
                         : 0.9;
    arm_init(&a, &p);
    motion *m = motion_create(&a, &p.method);
    double *start = m != NULL ? malloc((size_t)m->size * sizeof *start) : NULL;
    status code = STATUS_NO_MEMORY;
    if (start != NULL) {
        motion_start(&a, m, 0, 0);
        code = go(&a, m, from);
        memcpy(start, m->state, (size_t)m->size * sizeof *start);
    }
    for (int i = 0; i < atoi(argv[4]) && code == STATUS_OK; i++) {
        memcpy(m->state, start, (size_t)m->size * sizeof *start);
        code = go(&a, m, to);
    }
    if (code == STATUS_OK) {
        printf("%d\n", (int)((to - from) / STEP * atoi(argv[4]) + 0.5));
    } else {
        fprintf(stderr, "hot_step: %s\n", status_text(code));
    }
    free(start);
    motion_destroy(m);
    return code != STATUS_OK;
}
