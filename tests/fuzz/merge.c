// Parts of a sweep that somebody changed on the way: each line of the input is carried
// out as SQL on one of two parts, as the SQL of somebody else's program would be. They
// are refused with a sentence, or merge to runs of the sweep: planned values, each run
// once, and numbers that are finite; and the sweep goes on in what was merged, or says
// why not.
#include "tests/fuzz/fuzz.h"

#include <sqlite3.h>
#include <unistd.h>

#include "src/study/store/sweep_store.h"
#include "src/study/sweep_run.h"

enum { RUNS = 6, MOST_STEPS = 20000 };

// Part 1 or 2 of the sweep, as it was computed once.
static void write_part(const sweep *s, int part, const char *path)
{
    static unsigned char *bytes[2];
    static size_t sizes[2];
    fault f = {0};
    unlink(path);
    if (bytes[part] != NULL) {
        FILE *file = fopen(path, "wb");
        FUZZ_CHECK(file != NULL &&
                   fwrite(bytes[part], 1, sizes[part], file) == sizes[part]);
        fclose(file);
        return;
    }

    // the first time
    sweep_store *store;
    sweep_progress progress;
    const sweep_options options = {.jobs = 1, .share = {part + 1, 2}};
    FUZZ_CHECK(sweep_store_open(&store, path, s, &f) == STATUS_OK);
    FUZZ_CHECK(sweep_run(s, store, &options, &progress, &f) == STATUS_OK);
    sweep_store_close(store);
    FILE *file = fopen(path, "rb");
    FUZZ_CHECK(file != NULL && fseek(file, 0, SEEK_END) == 0);
    sizes[part] = (size_t)ftell(file);
    rewind(file);
    bytes[part] = malloc(sizes[part]);
    FUZZ_CHECK(bytes[part] != NULL &&
               fread(bytes[part], 1, sizes[part], file) == sizes[part]);
    fclose(file);
}

// Ends statements that go on too long.
static int count_steps(void *context)
{
    return ++*(int *)context > MOST_STEPS;
}

static void tamper(const char *path, const char *sql)
{
    sqlite3 *database;
    int steps = 0;
    FUZZ_CHECK(sqlite3_open(path, &database) == SQLITE_OK);
    sqlite3_limit(database, SQLITE_LIMIT_LENGTH, 100000);
    sqlite3_limit(database, SQLITE_LIMIT_ATTACHED, 0); // no other files
    sqlite3_progress_handler(database, 100, count_steps, &steps);
    sqlite3_exec(database, sql, NULL, NULL, NULL);
    sqlite3_close(database);
}

// What was merged: opened by the sweep, it has nothing that the sweep does not.
static void check_merged(const sweep *s, const char *path, const sweep_merged *merged)
{
    sweep_store *store;
    fault f = {0};
    FUZZ_CHECK(merged->total >= merged->runs);
    if (sweep_store_open(&store, path, s, &f) != STATUS_OK) {
        FUZZ_CHECK(strstr(f.text, path) != NULL); // both parts were changed alike
        return;
    }
    double values[RUNS];
    size_t count;
    FUZZ_CHECK(merged->total == RUNS);
    FUZZ_CHECK(store->count == merged->runs);
    FUZZ_CHECK(sweep_store_quantity(store, (sweep_share){0}, "peak_force_N", values, NULL,
                                    &f) == STATUS_OK);
    for (int i = 0; i < RUNS; i++) {
        FUZZ_CHECK(!isinf(values[i]));
    }
    sweep_store_close(store);

    // the varied values are the planned ones
    const char *const keys[] = {"run", "motor.voltage"};
    double *columns[SWEEP_TABLE_COLUMNS];
    FUZZ_CHECK(sweep_table_read(path, keys, 2, columns, &count, &f) == STATUS_OK);
    FUZZ_CHECK(count == merged->runs);
    for (size_t i = 0; i < count; i++) {
        FUZZ_CHECK(columns[1][i] == sweep_value(s, (size_t)columns[0][i] - 1, 0));
    }
    free(columns[0]);
    free(columns[1]);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static char vary[] = "motor.voltage=1:2:3", kind[] = "wall.kind=plane,point";
    char *lines[] = {vary, kind}, paths[3][96], *parts[] = {paths[0], paths[1]};
    scenario base;
    sweep s;
    fault f = {0};
    fuzz_scenario(&base, "title: base\nrun: {duration: 0.02 s}\n");
    const sweep_request request = {.vary = lines, .vary_count = 2};
    FUZZ_CHECK(sweep_init(&s, &base, &request, &f) == STATUS_OK);
    // in memory where there is such a folder: every change waits for the disk
    const char *folder = access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp";
    for (int i = 0; i < 3; i++) {
        snprintf(paths[i], sizeof paths[i], "%s/impactlab-fuzz-%ld-%d.sqlite", folder,
                 (long)getpid(), i);
        unlink(paths[i]);
    }
    write_part(&s, 0, paths[0]);
    write_part(&s, 1, paths[1]);

    // a line that begins with a blank changes the second part
    char *text = fuzz_text(data, size), *rest = text, *line;
    while ((line = strsep(&rest, "\n")) != NULL) {
        tamper(paths[line[0] == ' '], line);
    }
    free(text);

    // as parts, in either order
    sweep_merged merged;
    for (int order = 0; order < 2; order++) {
        char *files[] = {parts[order], parts[1 - order]};
        f = (fault){0};
        unlink(paths[2]);
        if (fuzz_done(sweep_merge(files, 2, paths[2], &merged, &f), &f)) {
            check_merged(&s, paths[2], &merged);
        } else {
            FUZZ_CHECK(access(paths[2], F_OK) != 0);
        }
    }
    for (int i = 0; i < 3; i++) {
        unlink(paths[i]);
    }
    sweep_finish(&s);
    scenario_finish(&base);
    return 0;
}
