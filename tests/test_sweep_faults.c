// A sweep's database on a disk that fails: every call that SQLite makes of the file
// system is refused in turn. What was not done is said, what was committed stands, and
// going on gives the same rows; what cannot be read whole is not taken for less.
#include <sqlite3.h>

#include "src/base/text_stream.h"
#include "src/study/store/sweep_store.h"
#include "tests/shipped_scenario.h"

enum { RUNS = 60, COMMIT_EVERY = 25 };

static char folder[] = "/tmp/sweep-faults-XXXXXX";
static char file[] = "sweep.sqlite";
static scenario base;
static sweep swept;

// --- a file system that refuses one call -----------------------------------------------

// A file of it: behind this stands the real one.
typedef struct refusing_file {
    sqlite3_file base;
} refusing_file;

static sqlite3_vfs *real_system, refusing_system;
static long calls, refused; // refused: the number of the call from 1, 0 for none

static bool refuses(void)
{
    return ++calls == refused;
}

static sqlite3_file *real_file(sqlite3_file *f)
{
    return (sqlite3_file *)((refusing_file *)f + 1);
}

// A method of a file: the real one's, but where the call is refused with a code; 0: it
// never is.
#define FILE_METHOD(name, method, code, parameters, arguments)                           \
    static int name parameters                                                           \
    {                                                                                    \
        return (code) != 0 && refuses() ? (code)                                         \
                                        : real_file(f)->pMethods->method arguments;      \
    }
FILE_METHOD(file_close, xClose, 0, (sqlite3_file * f), (real_file(f)))
FILE_METHOD(file_read, xRead, SQLITE_IOERR_READ,
            (sqlite3_file * f, void *to, int size, sqlite3_int64 at),
            (real_file(f), to, size, at))
FILE_METHOD(file_write, xWrite, SQLITE_FULL,
            (sqlite3_file * f, const void *from, int size, sqlite3_int64 at),
            (real_file(f), from, size, at))
FILE_METHOD(file_truncate, xTruncate, SQLITE_IOERR_TRUNCATE,
            (sqlite3_file * f, sqlite3_int64 size), (real_file(f), size))
FILE_METHOD(file_size, xFileSize, SQLITE_IOERR_FSTAT,
            (sqlite3_file * f, sqlite3_int64 *size), (real_file(f), size))
FILE_METHOD(file_lock, xLock, SQLITE_IOERR_LOCK, (sqlite3_file * f, int level),
            (real_file(f), level))
FILE_METHOD(file_unlock, xUnlock, 0, (sqlite3_file * f, int level), (real_file(f), level))
FILE_METHOD(file_is_reserved, xCheckReservedLock, SQLITE_IOERR_CHECKRESERVEDLOCK,
            (sqlite3_file * f, int *result), (real_file(f), result))
FILE_METHOD(file_control, xFileControl, 0, (sqlite3_file * f, int what, void *argument),
            (real_file(f), what, argument))
FILE_METHOD(file_sector, xSectorSize, 0, (sqlite3_file * f), (real_file(f)))
FILE_METHOD(file_device, xDeviceCharacteristics, 0, (sqlite3_file * f), (real_file(f)))

// What power that fails would lose is not tested: nothing has to come to the disk.
static int file_sync(sqlite3_file *f, int flags)
{
    (void)f, (void)flags;
    return refuses() ? SQLITE_IOERR_FSYNC : SQLITE_OK;
}

static int system_open(sqlite3_vfs *v, const char *name, sqlite3_file *f, int flags,
                       int *given)
{
    static const sqlite3_io_methods methods = {
        1,          file_close, file_read,   file_write,       file_truncate, file_sync,
        file_size,  file_lock,  file_unlock, file_is_reserved, file_control,  file_sector,
        file_device};
    (void)v;
    f->pMethods = NULL;
    if (refuses()) {
        return SQLITE_CANTOPEN;
    }
    int code = real_system->xOpen(real_system, name, real_file(f), flags, given);
    f->pMethods = real_file(f)->pMethods != NULL ? &methods : NULL;
    return code;
}

static int system_delete(sqlite3_vfs *v, const char *name, int sync)
{
    (void)v, (void)sync;
    return refuses() ? SQLITE_IOERR_DELETE : real_system->xDelete(real_system, name, 0);
}

static int system_access(sqlite3_vfs *v, const char *name, int flags, int *result)
{
    (void)v;
    return refuses() ? SQLITE_IOERR_ACCESS
                     : real_system->xAccess(real_system, name, flags, result);
}

static void report_fault(void *context, const char *sentence)
{
    (void)context;
    fprintf(stderr, "%s\n", sentence);
}

static int prepare(void **state)
{
    (void)state;
    char *vary = "motor.voltage=0.5:2:60";
    sweep_request request = {.vary = &vary, .vary_count = 1};
    fault f = {0};
    sqlite3_initialize();
    real_system = sqlite3_vfs_find(NULL);
    refusing_system = *real_system;
    refusing_system.zName = "refusing";
    refusing_system.szOsFile += (int)sizeof(refusing_file);
    refusing_system.xOpen = system_open;
    refusing_system.xDelete = system_delete;
    refusing_system.xAccess = system_access;
    return sqlite3_vfs_register(&refusing_system, 1) != SQLITE_OK ||
           mkdtemp(folder) == NULL || chdir(folder) != 0 ||
           scenario_open(&base, "corrected/first-impact", report_fault, NULL) !=
               STATUS_OK ||
           sweep_init(&swept, &base, &request, &f) != STATUS_OK;
}

static int clean_up(void **state)
{
    (void)state;
    sweep_finish(&swept);
    scenario_finish(&base);
    return chdir("/") != 0 || rmdir(folder) != 0;
}

// --- a sweep on it ---------------------------------------------------------------------

// All rows of a store in both formats, to be freed, NULL with a fault if they cannot be
// read.
static char *rows_of(sweep_store *store, status *code, fault *f)
{
    WRITTEN(text, *code = sweep_store_write(store, stream, false, f);
            *code =
                *code == STATUS_OK ? sweep_store_write(store, stream, true, f) : *code);
    return text;
}

// Opens the sweep's database, adds what is missing in commits of a few rows, and gives
// all rows.
// *kept: how many of the rows were committed, as far as it was told.
static status complete(char **rows, size_t *kept, fault *f)
{
    KEPT_STORE(store);
    size_t added = 0;
    *rows = NULL;
    status code = sweep_store_open(&store, file, &swept, f);
    *kept = code == STATUS_OK ? store->count : 0;
    double numbers[RUNS];
    if (code == STATUS_OK) {
        code = sweep_store_quantity(store, (sweep_share){0}, "run", numbers, NULL, f);
    }
    for (size_t run = 0; run < RUNS && code == STATUS_OK; run++) {
        summary result = {.peak_force_N = 1.0 + (double)run};
        if (isnan(numbers[run])) {
            code = sweep_store_put(store, run, &result, f);
            added++;
        }
        if (code == STATUS_OK && (added == COMMIT_EVERY || run == RUNS - 1)) {
            code = sweep_store_commit(store, f);
            *kept += code == STATUS_OK ? added : 0;
            added = 0;
        }
    }
    if (code == STATUS_OK) {
        *rows = rows_of(store, &code, f);
    }
    return code;
}

// A failure has a sentence that names the file.
static void check_said(const fault *f)
{
    fail_if(strstr(f->text, file) == NULL, "call %ld: '%s' does not name '%s'", refused,
            f->text, file);
}

static void remove_files(void)
{
    unlink(file);
    unlink("sweep.sqlite-journal");
}

TEST(what_was_committed_stands_and_the_rest_is_said)
{
    char *rows, *later;
    KEPT_TEXT(whole);
    size_t kept, then;
    fault f = {0};
    refused = 0;
    assert_int_equal(complete(&whole, &kept, &f), STATUS_OK);
    assert_int_equal(kept, RUNS);
    remove_files();

    int failures = 0;
    for (long k = 1;; k++) {
        calls = 0;
        refused = k;
        f = (fault){0};
        const status code = complete(&rows, &kept, &f);
        const bool over = calls < k;
        refused = 0;

        // status ok means all rows
        if (code == STATUS_OK) {
            assert_string_equal(rows, whole);
        } else {
            failures++;
            check_said(&f);
        }
        free(rows);

        // on a disk that works again the sweep is completed from what it has, by a
        // program that knows nothing of what was lost
        loss_forget();
        sweep_store *store;
        assert_int_equal(sweep_store_open(&store, file, &swept, &f), STATUS_OK);
        assert_true(store->count >= kept);
        sweep_store_close(store);
        assert_int_equal(complete(&later, &then, &f), STATUS_OK);
        assert_string_equal(later, whole);
        free(later);
        remove_files();
        if (over) {
            break;
        }
    }
    assert_true(failures > 20);
}

// Reads the sweep in every way there is; the first failure, else STATUS_OK.
static status read_all(const char *whole, fault *f)
{
    // as its columns, none of which is shorter than the sweep
    double *columns[2];
    size_t count;
    status code =
        sweep_table_read(file, (const char *[]){"motor.voltage", "peak_force_N"}, 2,
                         columns, &count, f);
    if (code == STATUS_OK) {
        assert_int_equal(count, RUNS);
        check_close(columns[1][RUNS - 1], RUNS, 0);
        free(columns[0]);
        free(columns[1]);
    } else {
        assert_null(columns[0]);
        assert_null(columns[1]);
        return code;
    }

    // as a part of one
    sweep_merged merged;
    char *parts[] = {file};
    code = sweep_merge(parts, 1, "merged", &merged, f);
    assert_int_equal(access("merged", F_OK) == 0, code == STATUS_OK);
    unlink("merged");
    if (code != STATUS_OK) {
        return code;
    }
    assert_int_equal(merged.runs, RUNS);

    // and to go on from
    KEPT_STORE(store);
    double values[RUNS];
    code = sweep_store_open(&store, file, &swept, f);
    code = code == STATUS_OK ? sweep_store_quantity(store, (sweep_share){0},
                                                    "peak_force_N", values, NULL, f)
                             : code;
    KEPT_TEXT(rows) = code == STATUS_OK ? rows_of(store, &code, f) : NULL;
    if (code == STATUS_OK) {
        check_close(values[RUNS - 1], RUNS, 0);
        assert_string_equal(rows, whole);
    }
    return code;
}

TEST(what_cannot_be_read_whole_is_not_taken_for_less)
{
    char *whole;
    size_t kept;
    fault f = {0};
    int failures = 0;
    refused = 0;
    assert_int_equal(complete(&whole, &kept, &f), STATUS_OK);
    for (long k = 1;; k++) {
        calls = 0;
        refused = k;
        f = (fault){0};
        const status code = read_all(whole, &f);
        if (code != STATUS_OK) {
            failures++;

            // what a merge writes may be at fault, too
            const bool writes = code == STATUS_CANNOT_WRITE;
            if (!writes || strstr(f.text, "'merged'") == NULL) {
                check_said(&f);
            }
        }
        if (calls < k) {
            assert_int_equal(code, STATUS_OK);
            break;
        }
    }
    assert_true(failures > 20);
    free(whole);
    refused = 0;
    remove_files();
}

ALL_BETWEEN(prepare, clean_up)
