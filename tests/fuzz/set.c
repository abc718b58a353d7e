// A set as impactlab robust reads it: refused with a sentence that names the file, or
// lines and cases with their numbers; each case is a scenario or refused with its line.
// Callers clean up after every refusal.
#include "tests/fuzz/fuzz.h"

#include "src/study/robust/robust.h"
#include "src/study/sweep.h"

enum { LOOKED_AT = 64 };

// What is drawn: a plan, or a sentence with the number of a line.
static void check_lines(const robust_set *set)
{
    sweep plan;
    fault f = {0};
    const sweep_request request = {.vary = set->lines,
                                   .vary_count = set->count,
                                   .sampling = SWEEP_LATIN,
                                   .runs = 3,
                                   .file = set->file,
                                   .lines = set->line_numbers};
    if (fuzz_done(sweep_plan(&plan, &request, &f), &f)) {
        FUZZ_CHECK(plan.run_count == 3 && plan.axis_count == set->count);
    }
    sweep_finish(&plan);
}

static void check_case(const scenario *base, const robust_case *c)
{
    scenario derived;
    fault f = {0};
    FUZZ_CHECK(c->title[0] != '\0' && c->line > 0 && c->push_count <= ROBUST_CASE_PUSHES);
    if (robust_case_scenario(&derived, base, c, &f) == STATUS_OK) {
        FUZZ_CHECK(derived.action_count == base->action_count + c->push_count);
        double before = 0;
        for (int i = 0; i < derived.action_count; i++) {
            const action *a = &derived.actions[i];
            FUZZ_CHECK(a->time >= before && a->time <= derived.parameters.run.duration);
            FUZZ_CHECK(isfinite(a->value));
            before = a->time;
        }
    } else {
        FUZZ_CHECK(f.line == c->line && strstr(f.text, c->file) != NULL);
    }
    robust_case_finish(&derived);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char yaml[] = "title: base\nrun: {duration: 1 s}\n"
                               "script: [{at: 0 s, push: 0.01 N s}]\n";
    scenario base;
    robust_set set;
    fault f = {0};
    fuzz_scenario(&base, yaml);
    const char *path = fuzz_file(data, size);
    if (robust_set_read(&set, path, &f) == STATUS_OK) {
        FUZZ_CHECK(set.count > 0);
        check_lines(&set);
        for (int i = 0; i < set.case_count && i < LOOKED_AT; i++) {
            check_case(&base, &set.cases[i]);
        }
    } else {
        FUZZ_CHECK(strstr(f.text, path) != NULL);
    }
    robust_set_finish(&set);
    scenario_finish(&base);
    return 0;
}
