// A CSV as --overlay reads it: rows with a time and at least one number, or a sentence.
#include "tests/fuzz/fuzz.h"

#include <glib.h>

#include "render/plot/trace_plot.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const trace_panel panels[] = {{.signals = {"force"}},
                                         {.signals = {"hub_angle"}}};
    trace t;
    fault f = {0};
    char *name = NULL;
    const char *path = fuzz_file(data, size);

    // every column, then one by its name
    for (int i = 0; i < 2; i++) {
        const status code = overlay_read_column(&t, path, i == 0 ? NULL : "probe", 0.25,
                                                panels, 2, &name, &f);
        FUZZ_CHECK(code != STATUS_OK || t.row_count > 0);
        fuzz_done(code, &f);
        for (size_t row = 0; code == STATUS_OK && row < t.row_count; row++) {
            FUZZ_CHECK(isfinite(t.rows[row].time));
        }
        trace_finish(&t);
        g_free(name);
        name = NULL;
    }
    return 0;
}
