// JSON from outside: the line that a program answers a sample with, and a file of earlier
// times for bench. Each is taken whole, with the numbers that it says, or refused.
#include "tests/fuzz/fuzz.h"

#include "src/rig/external/process_lines.h"
#include "src/study/bench.h"

static void try_answer(const uint8_t *data, size_t size)
{
    char *line = fuzz_text(data, size);
    controller_output out = {.command = -7};
    switch (process_read_answer(line, size, &out)) {
    case STATUS_OK:
        // JSON has no other numbers
        FUZZ_CHECK(isfinite(out.command) && !isinf(out.desired_angle));
        FUZZ_CHECK(!isinf(out.desired_velocity) && !isinf(out.calculated_force));
        FUZZ_CHECK(memchr(line, '{', size) != NULL && strstr(line, "\"") != NULL);
        break;
    case STATUS_CONTROLLER_FAILED:
        break;
    default:
        FUZZ_CHECK(!"there was memory");
    }
    free(line);
}

static void try_times(const uint8_t *data, size_t size)
{
    double medians[BENCHMARKS];
    fault f = {.text = ""};
    const status code = bench_read(fuzz_file(data, size), medians, &f);
    FUZZ_CHECK((code == STATUS_OK) == (f.text[0] == '\0'));
    for (int i = 0; code == STATUS_OK && i < BENCHMARKS; i++) {
        FUZZ_CHECK(medians[i] >= 0 && isfinite(medians[i]));
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    try_answer(data, size);
    try_times(data, size);
    return 0;
}
