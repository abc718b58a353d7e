// Settings as --set takes them, one a line: each is refused with a sentence, or leaves
// parameters within their ranges.
#include "tests/fuzz/fuzz.h"

enum { MOST_SETTINGS = 32 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = fuzz_text(data, size), *settings[MOST_SETTINGS];
    const int count = fuzz_lines(text, settings, MOST_SETTINGS);
    int reported = 0;
    scenario s;
    fuzz_scenario(&s, "title: base\nrun: {duration: 0.1 s}\n");
    const status code = scenario_override_all(&s, settings, count, fuzz_count, &reported);
    FUZZ_CHECK((code == STATUS_OK) == (reported == 0));
    for (int i = 0; code == STATUS_OK && i < parameter_count; i++) {
        const double value = parameter_get(&s.parameters, i);
        FUZZ_CHECK(isfinite(value));
        FUZZ_CHECK(!s.parameters.set[i] || (value >= parameter_table[i].minimum &&
                                            value <= parameter_table[i].maximum));
    }
    // what was set is written so that it is read; bytes of another character set no file
    // can hold
    bool ascii = true;
    for (size_t i = 0; i < size; i++) {
        ascii = ascii && data[i] < 0x80;
    }
    if (code == STATUS_OK && ascii) {
        scenario back;
        char *written = fuzz_written(&s);
        fuzz_scenario(&back, written);
        scenario_finish(&back);
        free(written);
    }
    scenario_finish(&s);
    free(text);
    return 0;
}
