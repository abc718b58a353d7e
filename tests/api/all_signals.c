// A loop in steps of 1 ms, for tests/api/test_signals_cost.sh, which counts instructions.
//
//     all_signals SCENARIO STEPS [signals]
#include <impactlab/impactlab.h>
#include <stdio.h>
#include <stdlib.h>

int main(int argc, char **argv)
{
    enum { MOST = 128 };
    impactlab_error error;
    impactlab_scenario *scenario = NULL;
    impactlab_loop *loop = NULL;
    double values[MOST] = {0}, sum = 0;
    if (argc < 3 || impactlab_scenario_open(&scenario, argv[1], &error) != 0 ||
        impactlab_loop_create(&loop, scenario, 0, &error) != 0) {
        return 1;
    }

    const long steps = strtol(argv[2], NULL, 10);
    for (long i = 1; i <= steps; i++) {
        if (impactlab_loop_step_until(loop, (double)i * 1e-3, &error) != 0) {
            return 1;
        }
        if (argc > 3) {
            impactlab_loop_signals(loop, values, MOST);
            sum += values[1];
        }
    }
    printf("%.17g\n", sum);
    impactlab_loop_destroy(loop);
    impactlab_scenario_destroy(scenario);
    return 0;
}
