// Settings as --set takes them, one a line: each is refused with a sentence, or leaves parameters
// within their ranges.
#include "tests/fuzz/fuzz.h"

#include <math.h>
#include <string.h>

#include "src/scenario/scenario.h"

enum { MOST_SETTINGS = 32 };

static void note(void *context, const char *sentence)
{
    (*(int *)context)++;
    FUZZ_CHECK(sentence[0] != '\0');
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = fuzz_text(data, size), *settings[MOST_SETTINGS], *rest = text, *line;
    int count = 0, reported = 0;
    while (count < MOST_SETTINGS && (line = strsep(&rest, "\n")) != NULL) {
        settings[count++] = line;
    }

    scenario s;
    static const char base[] = "title: base\nrun: {duration: 0.1 s}\n";
    FUZZ_CHECK(scenario_parse(&s, base, sizeof base - 1, "f", "base", note, &reported) ==
               STATUS_OK);
    const status code = scenario_override_all(&s, settings, count, note, &reported);
    FUZZ_CHECK((code == STATUS_OK) == (reported == 0));
    for (int i = 0; code == STATUS_OK && i < parameter_count; i++) {
        const double value = parameter_get(&s.parameters, i);
        FUZZ_CHECK(isfinite(value));
        FUZZ_CHECK(!s.parameters.set[i] ||
                   (value >= parameter_table[i].minimum && value <= parameter_table[i].maximum));
    }
    // what was set is written so that it is read; bytes of another character set no file can hold
    bool ascii = true;
    for (size_t i = 0; i < size; i++) {
        ascii = ascii && data[i] < 0x80;
    }
    if (code == STATUS_OK && ascii) {
        scenario back;
        char *written = NULL;
        size_t length = 0;
        FILE *stream = open_memstream(&written, &length);
        FUZZ_CHECK(stream != NULL);
        scenario_write(stream, &s);
        FUZZ_CHECK(fclose(stream) == 0);
        FUZZ_CHECK(scenario_parse(&back, written, length, "f", "back", note, &reported) ==
                   STATUS_OK);
        scenario_finish(&back);
        free(written);
    }
    scenario_finish(&s);
    free(text);
    return 0;
}
