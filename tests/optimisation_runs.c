// Runs of many kinds written as JSON and CSV to the standard output, without what depends
// on the machine's speed; tests/optimisation_levels.sh compares it over the compiler's
// optimisation levels. With names of scenarios: their runs instead
// (tests/second_architecture compares those).
#include <stdlib.h>
#include <string.h>

#include "src/run/export.h"
#include "src/predict/linearised.h"
#include "src/base/json.h"

// Each line a run: settings, separated by blanks.
static const char *const runs[] = {
    "",
    "wall.kind=plane motor.voltage=5 arm.links=3",
    "arm.links=8 wall.restitution=0.4 arm.damping_ratio=0.01",
    "arm.hub_joint=spring run.duration=0.4",
    "method.name=newmark",
    "method.name=generalized-alpha arm.links=5",
    "arm.links=64 wall.kind=plane run.duration=0.5",
    "control.law=hybrid wall.angle=0 initial.angle=-0.1",
    "control.law=touch control.force=2 wall.angle=0 initial.angle=-0.1",
    "arm.model=printed",
    "arm.model=printed motor.voltage=5 method.step=0.01",
};
enum { RUNS = sizeof runs / sizeof runs[0] };

static int fail(const char *run, const char *why)
{
    fprintf(stderr, "optimisation_runs: %s: %s\n", run, why);
    return 1;
}

static status apply(scenario *s, const char *settings, fault *f)
{
    char *rest = (char[256]){""}, *one;
    snprintf(rest, 256, "%s", settings);
    while ((one = strsep(&rest, " ")) != NULL) {
        const status code = *one != '\0' ? scenario_override(s, one, f) : STATUS_OK;
        if (code != STATUS_OK) {
            return code;
        }
    }
    return STATUS_OK;
}

// The predictors of both kinds, at the touch.
static void print_prediction(const parameters *p, const run_result *result)
{
    arm a;
    prediction out = {0};
    const sample *row = row_before_landing(result);
    if (row == NULL) {
        return;
    }
    arm_init(&a, p);
    const size_t at = (size_t)(row - result->trace.rows) * (size_t)a.dof;
    status code = predict_linearised(&a, &p->method, result->trace.angles + at,
                                     result->trace.velocities + at, &out);
    printf("predicted %d %a %a %a\n", (int)code, out.force, out.delay, out.impulse);
}

// What a run leaves, and its status.
static status print_run(const scenario *s)
{
    run_result result;
    status code = run_scenario(s, true, &result);
    result.summary.cpu_time_s = result.summary.wall_time_s = 0;
    json_t *object = export_run(s, &result);
    json_write(stdout, object);
    json_decref(object);
    export_csv(stdout, s, &result.trace);
    if (s->parameters.arm.model == ARM_CORRECTED) {
        print_prediction(&s->parameters, &result);
    }
    if (code != STATUS_OK) {
        fail(s->name, result.summary.message);
    }
    run_finish(&result);
    return code;
}

// A scenario of nothing but settings, which is to come to its end.
static int print_settings(const char *settings)
{
    static const char text[] = "title: t\n";
    scenario s;
    fault f;
    if (scenario_parse(&s, text, strlen(text), "t.yaml", "t", NULL, NULL) != STATUS_OK) {
        return fail(settings, "the empty scenario was refused");
    }
    status code = apply(&s, settings, &f);
    if (code != STATUS_OK) {
        fail(settings, f.text);
    } else {
        code = print_run(&s);
    }
    scenario_finish(&s);
    return code != STATUS_OK;
}

static void tell(void *context, const char *sentence)
{
    fail(context, sentence);
}

// A shipped one, which may end as it likes.
static int print_shipped(char *name)
{
    scenario s;
    if (scenario_open(&s, name, tell, name) != STATUS_OK) {
        return 1;
    }
    print_run(&s);
    scenario_finish(&s);
    return 0;
}

int main(int argc, char **argv)
{
    int code = 0;
    for (int i = 1; i < argc; i++) {
        code |= print_shipped(argv[i]);
    }
    for (int i = 0; i < RUNS && argc == 1; i++) {
        code |= print_settings(runs[i]);
    }
    return code;
}
