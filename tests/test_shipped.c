// Every shipped scenario runs, meets its own expectations and keeps its ledger.
#include "src/scenario/effect.h"
#include "tests/shipped_scenario.h"

static void print_fault(void *context, const char *sentence)
{
    print_error("%s: %s\n", (const char *)context, sentence);
}

static void check_scenario(const char *name)
{
    KEPT_SCENARIO(s) = shipped(name);
    KEPT_RUN(r);
    idle_value idle;
    int place = 0;
    fail_if(effect_next_idle(&s, &place, &idle), "%s: %s has no effect: %s", name,
            idle.path, idle.why);
    fail_if(run_scenario(&s, false, &r) != STATUS_OK, "%s: %s", name, r.summary.message);
    assert_int_equal(run_check_expectations(&s, &r, print_fault, (void *)name), 0);
    if (s.parameters.arm.model == ARM_CORRECTED &&
        s.parameters.method.name == METHOD_EVENT) {
        // what the motor did, or where it did nothing, what the arm began with
        double m = s.parameters.arm.mass, l = s.parameters.arm.length,
               v = s.parameters.initial.velocity;
        double turned_over = fabs(r.summary.motor_work_J) + 0.5 * m * l * l / 3 * v * v;
        double pushed = 0;
        for (int i = 0; i < s.action_count; i++) {
            pushed += s.actions[i].kind == ACTION_PUSH
                          ? s.actions[i].value * s.actions[i].value / m
                          : 0;
        }
        fail_if(!(r.summary.energy_residual_J < 1e-6 * (turned_over + pushed)),
                "%s: energy residual %g J of %g J", name, r.summary.energy_residual_J,
                turned_over);
    }
}

TEST(every_scenario_is_its_own_test)
{
    char **names;
    int count;
    DONE(scenario_list(&names, &count, &f));
    assert_true(count > 30);
    for (int i = 0; i < count; i++) {
        check_scenario(names[i]);
    }
    free_names(names, count);
}
