// The peak force of a scenario in C, and as it stands in C++.
//
//     cc -o peak peak.c $(pkg-config --cflags --libs impactlab)
//     ./peak corrected/first-impact
//
// Of a prefix of your own, docs/howto/library.md tells the rest.
#include <impactlab/impactlab.h>
#include <stdio.h>

int main(int argc, char **argv)
{
    impactlab_error error;
    impactlab_scenario *scenario;
    impactlab_run *run = NULL;
    double peak;
    int status = impactlab_scenario_open(&scenario, argc > 1 ? argv[1] : "", &error);
    if (status == IMPACTLAB_OK) {
        status = impactlab_run_create(&run, scenario, 0, &error);
    }
    if (status == IMPACTLAB_OK) {
        impactlab_run_quantity(run, "peak_force_N", &peak, &error);
        printf("%.17g\n", peak);
    } else {
        fprintf(stderr, "%s\n", error.sentence);
    }
    impactlab_run_destroy(run);
    impactlab_scenario_destroy(scenario);
    return status;
}
