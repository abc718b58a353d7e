// Parts of a sweep computed apart and merged: the rows of one sweep, and nothing else
// gets in.
#include "tests/given_parameters.h"
#include "tests/sweep_fixture.h"

static void sweep_voltages(sweep *s, const char *values)
{
    must_sweep(s, SWEEP_GRID, 0, values, NULL);
}

// Computes a share of a sweep into a file; returns all rows of the store as CSV, to be
// freed.
static char *compute(const sweep *s, const char *path, sweep_share share)
{
    KEPT_STORE(store);
    sweep_progress progress;
    const sweep_options options = {.share = share, .jobs = 2};
    DONE(sweep_store_open(&store, path, s, &f) != STATUS_OK ||
         sweep_run(s, store, &options, &progress, &f));
    assert_int_equal(progress.done, progress.total);
    return csv_of(store);
}

// Computes a sweep in this many parts and merges them: nothing is left to compute, and
// the rows are those of the whole sweep to the last byte.
static void check_merge(const sweep *s, char **parts, int count)
{
    sweep_merged merged;
    KEPT_TEXT(whole) = compute(s, "whole", (sweep_share){0, 0});
    for (int i = 0; i < count; i++) {
        free(compute(s, parts[i], (sweep_share){atoi(parts[i]), count}));
    }
    DONE(sweep_merge(parts, count, "merged", &merged, &f));
    assert_int_equal(merged.runs, s->run_count);
    assert_int_equal(merged.total, s->run_count);
    KEPT_TEXT(rows) = compute(s, "merged", (sweep_share){0, 0});
    assert_string_equal(rows, whole);

    // a sweep with a missing part continues where it ends
    DONE(sweep_merge(parts, count - 1, "some", &merged, &f));
    assert_in_range(merged.runs, 1, s->run_count - 1);
    KEPT_TEXT(rest) = compute(s, "some", (sweep_share){0, 0});
    assert_string_equal(rest, whole);
}

// Merges and expects to be refused with a sentence that says `says`; no file is made.
static void check_refused(char **files, int count, const char *says)
{
    sweep_merged merged;
    REFUSED(STATUS_BAD_ARGUMENT, says, sweep_merge(files, count, "refused", &merged, &f));
    assert_int_not_equal(access("refused", F_OK), 0);
}

// Eleven runs of 1e10, whatever the design: no run but these is looked at, and each is
// what its values give alone.
SWEEP_TEST(a_part_of_a_sweep_of_any_size_is_computed)
{
    static char volts[] = "motor.voltage=1:2:100000", stiffness[] = "arm.k2=4:5:100000";
    for (sweep_sampling how = SWEEP_GRID; how <= SWEEP_LATIN; how++) {
        char *vary[] = {volts, stiffness}, *parts[] = {"first", "last"};
        const size_t total = 10000000000;
        sweep_request request = {.vary = vary,
                                 .vary_count = 2,
                                 .sampling = how,
                                 .runs = how == SWEEP_GRID ? 0 : total};
        for (int i = 0; i < 2; i++) {
            request.share = (sweep_share){i == 0 ? 1 : 999999999, 999999999};
            KEPT_SWEEP(s);
            DONE(sweep_init(&s, &base, &request, &f));
            assert_int_equal(s.run_count, total);
            KEPT_STORE(store) = must_open(parts[i], &s);
            sweep_progress progress;
            const sweep_options options = {.share = request.share, .jobs = 1};
            DONE(sweep_run(&s, store, &options, &progress, &f));
            assert_int_equal(progress.done, i == 0 ? 11 : 10);

            // the last of them alone
            double peaks[11];
            const size_t last = progress.total - 1;
            DONE(sweep_store_quantity(store, request.share, "peak_force_N", peaks, NULL,
                                      &f));
            scenario alone;
            DONE(sweep_scenario(&s, sweep_share_run(request.share, last), &alone, &f));
            KEPT_RUN(result) = run_done(&alone, false);
            check_close(peaks[last], result.summary.peak_force_N, 0);
        }
        sweep_merged merged;
        DONE(sweep_merge(parts, 2, "merged", &merged, &f));
        assert_int_equal(merged.runs, 21);
        assert_int_equal(merged.total, total);
        unlink(parts[0]);
        unlink(parts[1]);
    }
}

// The first parameter of the table is one like any other.
SWEEP_TEST(parts_may_vary_the_model)
{
    assert_string_equal(parameter_table[0].path, "arm.model");
    base.parameters = defaults_of(ARM_CORRECTED);
    SWEPT(s, SWEEP_GRID, 0, "arm.model=corrected,printed", NULL);
    check_merge(&s, (char *[]){"1", "2"}, 2);
}

SWEEP_TEST(parts_in_any_order_give_the_rows_of_one_sweep)
{
    KEPT_SWEEP(s);
    sweep_voltages(&s, "motor.voltage=0.5:2:11");
    check_merge(&s, (char *[]){"3", "1", "2"}, 3);
    check_refused((char *[]){"1", "2", "1"}, 3, "run 1 of '1' is in another part too");
}

// Every parameter that is varied has its column.
SWEEP_TEST(parts_may_vary_several_parameters)
{
    KEPT_SWEEP(s);
    char *vary[] = {"motor.voltage=0.5,2", "arm.k2=4,6", "wall.kind=point,plane"};
    sweep_request request = {.vary = vary, .vary_count = 3};
    DONE(sweep_init(&s, &base, &request, &f));
    check_merge(&s, (char *[]){"1", "2"}, 2);
}

// What a database says of its values gives the plan again to the last bit: every kind of
// axis, drawn and in a grid.
SWEEP_TEST(the_plan_of_a_merge_is_that_of_the_sweep)
{
    static char *const drawn[] = {"motor.voltage=1:2.7:log",
                                  "wall.angle=-0.0001:0.3333333333333333",
                                  "control.seed=1:1000",
                                  "wall.kind=point,plane",
                                  "printed.clamp_force=true,false",
                                  "arm.joint_stiffness[2]=8:16:log",
                                  "arm.joint_stiffness[1]=9.000000000000002,1e1"};
    static char *const grid[] = {"motor.voltage=1:2.7:3:log", "wall.kind=point,plane",
                                 "initial.angle=-0.001,-0.1,-1.0000000000000002e-2",
                                 "control.seed=1:1000:2:log"};
    char *const links[] = {"arm.links=3", "arm.joint_stiffness=10,12",
                           "run.duration=0.02"};
    assert_int_equal(scenario_override_all(&base, links, 3, print_sentence, NULL),
                     STATUS_OK);
    for (int i = SWEEP_GRID; i <= SWEEP_LATIN; i++) {
        const bool draws = i != SWEEP_GRID;
        sweep_request request = {.vary = draws ? drawn : grid,
                                 .vary_count = draws ? 7 : 4,
                                 .sampling = (sweep_sampling)i,
                                 .runs = draws ? 40 : 0,
                                 .seed = UINT64_MAX};
        KEPT_SWEEP(s);
        DONE(sweep_init(&s, &base, &request, &f));
        check_merge(&s, (char *[]){"1", "2"}, 2);
        assert_true(unlink("whole") == 0 && unlink("merged") == 0 && unlink("some") == 0);
        assert_true(unlink("1") == 0 && unlink("2") == 0);
    }
}

SWEEP_TEST(foreign_parts_are_refused)
{
    KEPT_SWEEP(s), other;
    sweep_voltages(&s, "motor.voltage=1:2:3");
    sweep_voltages(&other, "motor.voltage=1:2:4");
    free(compute(&s, "own", (sweep_share){1, 3}));
    free(compute(&other, "other", (sweep_share){2, 4}));
    char *pair[] = {"own", "other"};
    check_refused(pair, 2, "'other' holds another sweep");

    // what is no sweep, and what was changed by others
    free(compute(&s, "changed", (sweep_share){2, 3}));
    pair[1] = "changed";
    tamper("changed", "UPDATE run SET run = 12");
    check_refused(pair, 2, "holds run 12 of a sweep of 3");
    tamper("changed", "ALTER TABLE run RENAME COLUMN peak_force_N TO peak");
    check_refused(pair, 2,
                  "another build: its runs lack peak_force_N and have peak, which");
    tamper("changed", "PRAGMA application_id = 1");
    check_refused(pair, 2, "holds no sweep of this program");

    // a database of somebody else's with what this program never writes
    tamper("own", "DROP TABLE sweep; CREATE TABLE sweep (key, value);"
                  "INSERT INTO sweep VALUES (NULL, 'x'), ('runs', NULL)");
    check_refused(pair, 1, "without text");
    sweep_store *store;
    REFUSED(STATUS_BAD_ARGUMENT, "", sweep_store_open(&store, "own", &s, &f));
}

// The table without what it lets into its columns.
#define UNBOUND                                                                          \
    "CREATE TABLE bare AS SELECT * FROM run; DROP TABLE run; ALTER TABLE bare RENAME "   \
    "TO run; "

// What a file has after others changed it, and why it is refused: as a part, and to go on
// from.
SWEEP_TEST(what_others_changed_is_refused)
{
    static const struct {
        const char *sql;
        const char *says;
    } changes[] = {
        {"DROP TABLE run", "not laid out"},
        {"DROP TABLE sweep", "not laid out"},
        {"ALTER TABLE run RENAME TO old; CREATE VIEW run AS SELECT * FROM old",
         "not laid out"},
        {"ALTER TABLE run ADD COLUMN more",
         "another build: its runs have more, which this one does not know"},
        {"ALTER TABLE run DROP COLUMN peak_force_N",
         "another build: its runs lack peak_force_N"},
        {"ALTER TABLE run RENAME COLUMN impacts TO hits",
         "lack impacts and have hits, which"},
        {"UPDATE run SET peak_force_N = 'much'", "another kind in run 1"},
        {"UPDATE run SET impacts = x'01' WHERE run = 3", "kind in run 3"},
        {"UPDATE run SET \"motor.voltage\" = 'two' WHERE run = 2", "run 2"},
        {"UPDATE run SET status = 'splendid'", "another kind"},
        {"UPDATE run SET status = CAST(x'6f6b0078' AS TEXT)", "under status"},
        {"UPDATE run SET message = x'41'", "under message"},
        {"UPDATE run SET peak_force_N = 9e999 WHERE run = 2",
         "run 2 than this program writes, under peak_force_N"},
        {"UPDATE run SET steps = -9e999", "under steps"},
        {"UPDATE run SET steps = NULL", "under steps"},
        {"UPDATE run SET impacts = NULL WHERE run = 3",
         "run 3 than this program writes, under imp"},
        {"UPDATE run SET status = 'failed', cpu_time_s = NULL", "under cpu_time_s"},
        {"UPDATE run SET \"motor.voltage\" = 7 WHERE run = 2",
         "7.0 in run 2, expected 1.5"},
        {"UPDATE run SET \"motor.voltage\" = 9e999 WHERE run = 1",
         "Inf in run 1, expected 1"},
        {"UPDATE run SET run = -run; UPDATE run SET run = 4 + run", "motor.voltage = "},
        {UNBOUND "UPDATE run SET \"motor.voltage\" = NULL WHERE run = 3",
         "nothing in run 3"},
        {UNBOUND "UPDATE run SET status = NULL", "under status"},
        {UNBOUND "UPDATE run SET run = NULL WHERE run = 1", "run 0 of"},
        {UNBOUND "UPDATE run SET run = 1.5 WHERE run = 1", "run 1 of"},
        {UNBOUND "INSERT INTO run SELECT * FROM run WHERE run = 2", "run 2 twice"},
        {"UPDATE sweep SET value = 'motor.voltage=1:2:4' WHERE key = 'vary 1'", "4"},
        {"UPDATE sweep SET value = 'motor.voltage=1:3:3' WHERE key = 'vary 1'",
         "motor.voltage"},
        {"UPDATE sweep SET value = 'motor.voltage' WHERE key = 'vary 1'", "vary"},
        {"UPDATE sweep SET value = 'spun' WHERE key = 'sample'", "combined"},
        {"UPDATE sweep SET value = '3x' WHERE key = 'runs'", "runs"},
        {"UPDATE sweep SET value = '99999999999999999999999' WHERE key = 'runs'", "runs"},
        {"UPDATE sweep SET key = printf('%100s', 'x') WHERE key = 'runs'",
         "without text"},
        {"UPDATE sweep SET value = CAST(x'330030' AS TEXT) WHERE key = 'runs'",
         "without text"},
        {UNBOUND "DROP TABLE run; CREATE TABLE run AS SELECT 1 AS run; "
                 "ALTER TABLE run ADD COLUMN x AS (zeroblob(100000000))",
         "its runs lack motor.voltage and have x"},
        {"DROP TABLE sweep; CREATE TABLE sweep (key, more AS (zeroblob(100000000)), "
         "value AS (hex(more))); INSERT INTO sweep VALUES ('runs')",
         "too big"},
        {"DROP TABLE sweep; CREATE TABLE sweep (key, value); "
         "INSERT INTO sweep VALUES ('runs', '3'), ('runs', '3')",
         "more lines"},
        {"WITH RECURSIVE n(i) AS (SELECT 1 UNION SELECT i + 1 FROM n WHERE i "
         "< 300) INSERT INTO sweep SELECT 'line ' || i, i FROM n",
         "more lines"},
        {"UPDATE sweep SET value = 'arm.nothing=1:2:3' WHERE key = 'vary 1'",
         "arm.nothing"},
        {"DELETE FROM sweep WHERE key = 'runs'", "runs"},
        {"DELETE FROM run; DELETE FROM sweep; DROP TABLE run; DROP TABLE sweep",
         "is empty"},
    };
    KEPT_SWEEP(s);
    sweep_voltages(&s, "motor.voltage=1:2:3");
    for (EACH(c, changes)) {
        char *part[] = {"part"};
        free(compute(&s, "part", (sweep_share){0, 0}));
        tamper("part", c->sql);
        check_refused(part, 1, c->says);

        // an empty one is one to begin with
        sweep_store *store;
        if (strcmp(c->says, "is empty") == 0) {
            DONE(sweep_store_open(&store, "part", &s, &f));
            sweep_store_close(store);
        } else {
            REFUSED(STATUS_BAD_ARGUMENT, "", sweep_store_open(&store, "part", &s, &f));
            assert_null(store);
        }
        unlink("part");
    }
}

// A missing part, and one with overwritten pages.
SWEEP_TEST(what_cannot_be_read_is_said)
{
    KEPT_SWEEP(s);
    sweep_merged merged;
    char *part[] = {"part"};
    REFUSED(STATUS_CANNOT_READ, "No such file", sweep_merge(part, 1, "out", &merged, &f));

    // all pages but the first, which says what kind of file it is
    sweep_voltages(&s, "motor.voltage=1:2:3");
    free(compute(&s, "part", (sweep_share){0, 0}));
    size_t size;
    KEPT_TEXT(bytes) = file_bytes("part", &size);
    memset(bytes + 4096, 'x', size - 4096);
    put_bytes("part", bytes, size);
    REFUSED(STATUS_CANNOT_READ, "is damaged", sweep_merge(part, 1, "out", &merged, &f));
    sweep_store *store;
    REFUSED(STATUS_CANNOT_READ, "", sweep_store_open(&store, "part", &s, &f));
    assert_int_not_equal(access("out", F_OK), 0);
}

// The end of a journal that names a file: SQLite's form of a transaction over several
// databases.
static void write_journal(const char *database, const char *named)
{
    static const unsigned char mark[] = {0xd9, 0xd5, 0x05, 0xf9, 0x20, 0xa1, 0x63, 0xd7};
    unsigned char head[512] = {0};
    size_t all;
    KEPT_TEXT(content) = file_bytes(database, &all);
    const unsigned page = (unsigned char)content[16] * 256u + (unsigned char)content[17];
    const unsigned length = (unsigned)strlen(named), pages = (unsigned)all / page;

    // as SQLite writes it: no pages, then the page of the locks, the name, its length and
    // its sum
    unsigned sum = 0;
    for (unsigned i = 0; i < length; i++) {
        sum += (unsigned char)named[i];
    }
    const unsigned words[] = {0,      0,  pages, 512, page, 0x40000000u / page + 1,
                              length, sum};
    unsigned char bytes[8][4];
    for (int i = 0; i < 8; i++) {
        for (int k = 0; k < 4; k++) {
            bytes[i][k] = (unsigned char)(words[i] >> (24 - 8 * k));
        }
    }
    memcpy(head, mark, sizeof mark);
    memcpy(head + sizeof mark, bytes, 5 * sizeof bytes[0]);
    FILE *file = fopen(formatted("%s-journal", database), "wb");
    assert_non_null(file);
    fwrite(head, sizeof head, 1, file);
    fwrite(bytes[5], 4, 1, file);
    fwrite(named, length, 1, file);
    fwrite(bytes[6], 4, 2, file);
    fwrite(mark, sizeof mark, 1, file);
    assert_int_equal(fclose(file), 0);
}

// A journal beside a database that came from elsewhere deletes nothing.
SWEEP_TEST(a_journal_names_no_file_to_delete)
{
    char notes[300];
    KEPT_SWEEP(s);
    sweep_voltages(&s, "motor.voltage=1:2:3");
    free(compute(&s, "part", (sweep_share){0, 0}));
    assert_non_null(getcwd(notes, 200));
    strcat(notes, "/notes");
    put_file(notes, "my notes");

    // also where the database is reached by a link
    assert_int_equal(symlink("part", "link"), 0);
    for (EACH_TEXT(c, "part", "link")) {
        write_journal("part", notes);
        sweep_store *store;
        REFUSED(STATUS_BAD_ARGUMENT, "part-journal' is no journal of this program",
                sweep_store_open(&store, *c, &s, &f));
        check_refused((char *[]){(char *)*c}, 1, "no journal");
        assert_int_equal(access(notes, F_OK), 0);
    }

    // without it all is well
    unlink("part-journal");
    free(compute(&s, "part", (sweep_share){0, 0}));
}
