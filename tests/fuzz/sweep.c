// What --vary takes, one a line; the first byte chooses the sampling: refused with a
// sentence, or a sweep in which every run has valid values.
#include "tests/fuzz/fuzz.h"

#include "src/study/sweep.h"

enum { MOST_LINES = 12, LOOKED_AT = 200, MOST_BYTES = 400 };

static void check_runs(const sweep *s)
{
    FUZZ_CHECK(s->run_count >= 1 && s->run_count <= SWEEP_MOST_RUNS);
    for (size_t i = 0; i < s->run_count && i < LOOKED_AT; i++) {
        const size_t run = i % 2 == 0 ? i : s->run_count - 1 - i / 2;
        for (int axis = 0; axis < s->axis_count; axis++) {
            const parameter_info *info = &parameter_table[s->axes[axis].parameter];
            const double value = sweep_value(s, run % s->run_count, axis);
            FUZZ_CHECK(isfinite(value) && value >= info->minimum &&
                       value <= info->maximum);
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    // long lists of values say nothing new
    if (size < 1 || size > MOST_BYTES) {
        return 0;
    }
    char *text = fuzz_text(data + 1, size - 1), *lines[MOST_LINES];
    const int count = fuzz_lines(text, lines, MOST_LINES);
    scenario base;
    sweep s;
    fault f = {0};
    fuzz_scenario(&base, "title: base\nrun: {duration: 0.1 s}\n");
    const sweep_request request = {.vary = lines,
                                   .vary_count = count,
                                   .sampling = (sweep_sampling)(data[0] % 3),
                                   .runs =
                                       data[0] % 3 == SWEEP_GRID ? 0 : 1 + data[0] / 3,
                                   .seed = data[0]};
    if (fuzz_done(sweep_init(&s, &base, &request, &f), &f)) {
        check_runs(&s);
        sweep_finish(&s);
    }
    scenario_finish(&base);
    free(text);
    return 0;
}
