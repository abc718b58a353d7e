// Any file in the place of a sweep's database: opened, continued, read, merged or refused
// with a sentence; never taken for another sweep.
#include "tests/fuzz/fuzz.h"

#include <unistd.h>

#include "src/study/store/sweep_store.h"

// Reads all that a store has.
static void read_store(sweep_store *store, const sweep *s)
{
    double values[64];
    size_t failed;
    fault f = {0};
    FUZZ_CHECK(s->run_count <= 64);
    FUZZ_CHECK(store->count <= s->run_count);
    fuzz_done(sweep_store_quantity(store, (sweep_share){0}, "peak_force_N", values,
                                   &failed, &f),
              &f);
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    FUZZ_CHECK(stream != NULL);
    f = (fault){0};
    fuzz_done(sweep_store_write(store, stream, false, &f), &f);
    fclose(stream);
    free(text);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static char vary[] = "motor.voltage=1:2:3", *lines[] = {vary};
    scenario base;
    sweep s;
    fault f = {0};
    fuzz_scenario(&base, "title: base\nrun: {duration: 0.1 s}\n");
    const sweep_request request = {.vary = lines, .vary_count = 1};
    FUZZ_CHECK(sweep_init(&s, &base, &request, &f) == STATUS_OK);
    char *path = strdup(fuzz_file(data, size));
    FUZZ_CHECK(path != NULL);

    // a part, then a table, then the sweep itself: only that may write to it
    sweep_merged merged;
    char *parts[] = {path};
    fuzz_done(sweep_merge(parts, 1, "/dev/null", &merged, &f), &f);
    f = (fault){0};
    const char *const keys[] = {"motor.voltage", "peak_force_N"};
    double *columns[SWEEP_TABLE_COLUMNS] = {NULL};
    size_t rows;
    if (sweep_table_read(path, keys, 2, columns, &rows, &f) == STATUS_OK) {
        free(columns[0]);
        free(columns[1]);
    }
    sweep_store *store;
    if (fuzz_done(sweep_store_open(&store, path, &s, &f), &f)) {
        read_store(store, &s);
        sweep_store_close(store);
    }

    unlink(path);
    free(path);
    sweep_finish(&s);
    scenario_finish(&base);
    return 0;
}
