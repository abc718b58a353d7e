// What a run reads from outside its scenario: whoever keeps results of such runs refuses
// to go on when it is another one.
//
//   test_outside PLUGIN OTHER_PLUGIN
#include <assert.h>

#include "src/scenario/outside.h"
#include "src/session/session.h"
#include "tests/sweep_fixture.h"

static char *plugin_files[2];

// A law that answers every sample with so many volts.
static void write_law(const char *path, const char *volts)
{
    put_file(path,
             formatted("while read -r line; do echo '{\"command\": %s}'; done\n", volts));
}

static void copy_file(const char *from, const char *to)
{
    assert_int_equal(system(formatted("cp '%s' '%s'", from, to)), 0);
}

static void write_program(int which)
{
    write_law("law.sh", which == 0 ? "2" : "4");
}

static void write_plugin(int which)
{
    unlink("law.so"); // a new file, as a compiler writes it
    copy_file(plugin_files[which], "law.so");
}

static void write_recording(int which)
{
    put_file("u.csv", which == 0 ? "t[s],command[V]\n0,2\n" : "t[s],command[V]\n0,4\n");
}

// A wall that comes to meet the arm.
static void write_path(int which)
{
    put_file("w.csv", which == 0 ? "time[s],place[m]\n0,0\n0.04,0.7\n"
                                 : "time[s],place[m]\n0,0\n0.04,0.8\n");
}

// Everything on the list, with two contents of it.
static const struct outside_case {
    size_t parameter; // offset
    const char *value;
    control_law law;
    wall_motion_kind motion;
    void (*write)(int which);
    const char *file;
} cases[] = {
    {offsetof(parameters, control.plugin), "./law.so", LAW_PLUGIN, MOTION_NONE,
     write_plugin, "law.so"},
    {offsetof(parameters, control.command), "sh law.sh", LAW_PROCESS, MOTION_NONE,
     write_program, "law.sh"},
    {offsetof(parameters, control.playback_file), "u.csv", LAW_PLAYBACK, MOTION_NONE,
     write_recording, "u.csv"},
    {offsetof(parameters, wall.motion_file), "w.csv", LAW_OPEN_LOOP, MOTION_FILE,
     write_path, "w.csv"},
};
enum { CASES = sizeof cases / sizeof cases[0] };

// The parameters of short runs under what a case names.
static parameters parameters_of(const struct outside_case *c)
{
    parameters p = base.parameters;
    p.control.law = c->law;
    p.set[PARAMETER_INDEX(control.law)] = 1;
    p.wall.motion = c->motion;
    p.set[PARAMETER_INDEX(wall.motion)] = 1;
    p.code_allowed = c->motion == MOTION_NONE;
    p.run.duration = 0.05;
    p.control.rate = 100;
    DONE(parameter_set_text(&p, parameter_at(c->parameter), c->value, &f) != STATUS_OK ||
         parameters_resolve(&p, &f));
    return p;
}

SWEEP_TEST(one_list_has_all_that_names_a_file)
{
    assert_int_equal(CASES, outside_count);
    for (int i = 0; i < parameter_count; i++) {
        bool known = parameter_table[i].type != PARAMETER_TEXT;
        for (EACH_TEXT(c, "control.settings", "control.lock", "control.k2_table",
                       "control.playback_column")) {
            known = known || strcmp(parameter_table[i].path, *c) == 0;
        }
        for (int k = 0; k < outside_count; k++) {
            known = known || parameter_at(outside_table[k].parameter) == i;
        }
        fail_if(!known, "%s is a text: does a run read what it names?",
                parameter_table[i].path);
    }
}

// --- the digest ------------------------------------------------------------------------

static status digest(const char *command, char text[SHA256_TEXT], fault *f)
{
    parameters p = {.control.law = LAW_PROCESS};
    snprintf(p.control.command, sizeof p.control.command, "%s", command);
    for (int i = 0; i < outside_count; i++) {
        if (outside_is_read(&outside_table[i], &p) &&
            outside_is_told(&outside_table[i], &p)) {
            return outside_digest(&outside_table[i], &p, text, f);
        }
    }
    return STATUS_BAD_ARGUMENT;
}

// Whether a digest is another one with `text` in the file.
static bool depends_on(const char *command, const char *path)
{
    char before[SHA256_TEXT], after[SHA256_TEXT];
    put_file(path, "one");
    assert_int_equal(chmod(path, 0755), 0);
    DONE(digest(command, before, &f));
    put_file(path, "two");
    DONE(digest(command, after, &f));
    return strcmp(before, after) != 0;
}

SWEEP_TEST(files_that_a_command_names_are_its_content)
{
    assert_int_equal(mkdir("bin", 0755), 0);
    char *kept = strdup(getenv("PATH"));
    setenv("PATH", formatted("%s/bin:/bin:/usr/bin", test_folder), 1);
    assert_true(depends_on("sh law.sh", "law.sh"));
    assert_true(depends_on("./law.sh", "law.sh"));
    assert_true(depends_on("sh law.sh --table=table.csv", "table.csv"));
    assert_true(depends_on("control --gain 3", "bin/control"));
    assert_true(depends_on("nice control", "bin/control"));
    assert_false(depends_on("sh law.sh", "bin/control"));
    assert_false(depends_on("sh law.sh -control", "bin/control"));
    setenv("PATH", kept, 1);
    free(kept);

    // bytes do not pass from one file to the next
    char one[SHA256_TEXT], other[SHA256_TEXT];
    put_file("a", "xy");
    put_file("b", "z");
    DONE(digest("./a ./b", one, &f));
    put_file("a", "x");
    put_file("b", "yz");
    DONE(digest("./a ./b", other, &f));
    assert_string_not_equal(one, other);

    // what a shell would take for more than words
    REFUSED(STATUS_BAD_ARGUMENT, "", digest("cat law.sh | sh", one, &f));
}

// Writes a file of so many bytes, all the same.
static void write_bytes(const char *path, size_t count, int byte)
{
    static char bytes[1000001];
    memset(bytes, byte, count);
    put_bytes(path, bytes, count);
}

// A stamp is another one after a change; of a small file only then.
SWEEP_TEST(a_stamp_sees_changes)
{
    parameters p = {.control.law = LAW_PROCESS, .control.command = "./law.sh"};
    char first[SHA256_TEXT], second[SHA256_TEXT];
    for (size_t count = 1000; count <= 1000000; count *= 1000) {
        write_bytes("law.sh", count, 'a');
        outside_stamp(~0u, &p, first);
        outside_stamp(~0u, &p, second);
        assert_string_equal(first, second);
        write_bytes("law.sh", count, 'a');
        outside_stamp(~0u, &p, second);
        assert_true(count > 1000 || strcmp(first, second) == 0);

        write_bytes("law.sh", count + 1, 'a');
        outside_stamp(~0u, &p, second);
        assert_string_not_equal(first, second);
        outside_stamp(0, &p, first);
        write_bytes("law.sh", count, 'b');
        outside_stamp(0, &p, second);
        assert_string_equal(first, second);
    }
    write_bytes("law.sh", 1000, 'c');
    outside_stamp(~0u, &p, first);
    write_bytes("law.sh", 1000, 'd');
    outside_stamp(~0u, &p, second);
    assert_string_not_equal(first, second);
}

SWEEP_TEST(a_plugin_is_its_file)
{
    char text[SHA256_TEXT];
    parameters p = {.control.law = LAW_PLUGIN, .control.plugin = "law.so"};
    assert_false(outside_is_told(&outside_table[0], &p));
    strcpy(p.control.plugin, "./law.so");
    REFUSED(STATUS_CANNOT_READ,
            "control.plugin = './law.so' cannot be read: No such file",
            outside_digest(&outside_table[0], &p, text, &f));

    // a folder, and what nobody may read
    assert_int_equal(mkdir("law.so", 0755), 0);
    REFUSED(STATUS_CANNOT_READ, "", outside_digest(&outside_table[0], &p, text, &f));
    rmdir("law.so");
    put_file("law.so", "x");
    DONE(outside_digest(&outside_table[0], &p, text, &f));
    chmod("law.so", 0);
    if (geteuid() != 0) {
        REFUSED(STATUS_CANNOT_READ, "", outside_digest(&outside_table[0], &p, text, &f));
    }
}

// --- sweeps ----------------------------------------------------------------------------

// Expects to be refused, by name of what changed.
static void check_refused(const char *path, const sweep *s, const char *name)
{
    sweep_store *store;
    fault f = {.text = ""};
    assert_int_equal(sweep_store_open(&store, path, s, &f), STATUS_BAD_ARGUMENT);
    fail_if(strstr(f.text, "the content of ") == NULL || strstr(f.text, name) == NULL,
            "'%s' does not name %s", f.text, name);
}

static void must_compute(const sweep *s, const char *path, sweep_share share)
{
    KEPT_STORE(store) = must_open(path, s);
    sweep_progress progress;
    const sweep_options options = {.jobs = 2, .share = share};
    DONE(sweep_run(s, store, &options, &progress, &f));
    assert_int_equal(progress.failed, 0);
}

static void check_rows(const char *path, const sweep *s, const char *expected)
{
    KEPT_STORE(store) = must_open(path, s);
    KEPT_TEXT(rows) = csv_of(store);
    assert_string_equal(rows, expected);
}

// A program, plug-in or file that is another one when a sweep goes on, in a part or in a
// merge.
SWEEP_TEST(rows_of_what_is_gone_are_refused)
{
    for (int i = 0; i < CASES; i++) {
        base.parameters = parameters_of(&cases[i]);
        const char *name = parameter_table[parameter_at(cases[i].parameter)].path;
        SWEPT(s, SWEEP_GRID, 0, "initial.angle=-0.1,-0.2,-0.3,-0.4", NULL);
        cases[i].write(0);
        KEPT_TEXT(rows) = uninterrupted(&s, 1);
        must_compute(&s, "first", (sweep_share){1, 2});
        must_compute(&s, "whole", (sweep_share){0, 0});

        // written again with the same content: it goes on, with the rows of one go
        cases[i].write(0);
        must_compute(&s, "whole", (sweep_share){0, 0});
        check_rows("whole", &s, rows);

        // another one
        cases[i].write(1);
        KEPT_TEXT(fresh) = uninterrupted(&s, 1);
        assert_string_not_equal(fresh, rows);
        check_refused("whole", &s, name);
        check_refused("first", &s, name);
        must_compute(&s, "second", (sweep_share){2, 2});
        char *parts[] = {"first", "second"};
        sweep_merged merged;
        REFUSED(STATUS_BAD_ARGUMENT, name, sweep_merge(parts, 2, "merged", &merged, &f));
        assert_int_not_equal(access("merged", F_OK), 0);

        // and the first one again
        cases[i].write(0);
        must_compute(&s, "first", (sweep_share){0, 0});
        check_rows("first", &s, rows);

        unlink(cases[i].file);
        unlink("first");
        unlink("second");
        unlink("whole");
    }
}

// What is varied may decide whether a file is read.
SWEEP_TEST(a_varied_law_decides_what_is_read)
{
    base.parameters = parameters_of(&cases[1]);
    base.parameters.control.law = LAW_OPEN_LOOP;
    write_program(0);
    KEPT_SWEEP(some), none;
    must_sweep(&some, SWEEP_GRID, 0, "control.law=open-loop,process", NULL);
    must_sweep(&none, SWEEP_GRID, 0, "control.law=open-loop,hybrid", NULL);
    must_compute(&some, "some", (sweep_share){0, 0});
    must_compute(&none, "none", (sweep_share){0, 0});
    write_program(1);
    check_refused("some", &some, "control.command");
    sweep_store_close(must_open("none", &none));
}

// A command that only a shell can read may be of any program: its rows are kept, and not
// mixed with others.
SWEEP_TEST(rows_of_what_cannot_be_told_stay_alone)
{
    const struct outside_case shell = {.parameter = cases[1].parameter,
                                       .value = "exec sh law.sh; exit",
                                       .law = LAW_PROCESS};
    base.parameters = parameters_of(&shell);
    write_program(0);
    SWEPT(s, SWEEP_GRID, 0, "initial.angle=-0.1,-0.2", NULL);
    must_compute(&s, "first", (sweep_share){1, 2});
    must_compute(&s, "second", (sweep_share){2, 2});
    check_refused("first", &s, "control.command may be another one, it cannot be told");
    char *parts[] = {"first", "second"};
    sweep_merged merged;
    REFUSED(STATUS_BAD_ARGUMENT, "cannot be told",
            sweep_merge(parts, 2, "merged", &merged, &f));
    DONE(sweep_merge(parts, 1, "merged", &merged, &f));
}

// Rows that were computed while it changed are not kept.
SWEEP_TEST(what_changes_during_a_sweep_ends_it)
{
    base.parameters = parameters_of(&cases[1]);
    write_program(0);
    SWEPT(s, SWEEP_GRID, 0, "initial.angle=-0.1,-0.2,-0.3,-0.4", NULL);
    must_compute(&s, "rows", (sweep_share){1, 4});

    sweep_store *store = must_open("rows", &s);
    write_program(1);
    sweep_progress progress;
    const sweep_options options = {.jobs = 1};
    REFUSED(STATUS_BAD_ARGUMENT, "the content of control.command is another one",
            sweep_run(&s, store, &options, &progress, &f));
    sweep_store_close(store);

    // the row of before is there, and no other
    write_program(0);
    store = must_open("rows", &s);
    assert_int_equal(store->count, 1);
    double numbers[4];
    DONE(sweep_store_quantity(store, (sweep_share){0}, "run", numbers, NULL, &f));
    check_close(numbers[0], 1, 0);

    // one that is gone
    unlink("law.sh");
    REFUSED(STATUS_BAD_ARGUMENT, "", sweep_run(&s, store, &options, &progress, &f));
    sweep_store_close(store);
}

// A run that was not let, or whose plug-in cannot be loaded, is no row: the next time it
// may be.
SWEEP_TEST(what_could_not_begin_is_no_row)
{
    sweep_progress progress;
    const sweep_options options = {.jobs = 1};
    for (int i = 0; i < CASES; i++) {
        // what is only read is no code
        if (cases[i].law == LAW_PLAYBACK || cases[i].motion == MOTION_FILE) {
            continue;
        }
        base.parameters = parameters_of(&cases[i]);
        base.parameters.code_allowed = false;
        cases[i].write(0);
        SWEPT(s, SWEEP_GRID, 0, "initial.angle=-0.1,-0.2", NULL);
        sweep_store *store = must_open("rows", &s);
        REFUSED(STATUS_NOT_ALLOWED, "--allow-code",
                sweep_run(&s, store, &options, &progress, &f));
        sweep_store_close(store);
        base.parameters.code_allowed = true;
        must_compute(&s, "rows", (sweep_share){0, 0});
        unlink("rows");
        unlink(cases[i].file);
    }

    base.parameters = parameters_of(&cases[0]);
    put_file("law.so", "no library");
    SWEPT(s, SWEEP_GRID, 0, "initial.angle=-0.1,-0.2", NULL);
    sweep_store *store = must_open("rows", &s);
    REFUSED(STATUS_CANNOT_READ, "run 1: control.plugin = ./law.so cannot be loaded",
            sweep_run(&s, store, &options, &progress, &f));
    sweep_store_close(store);
}

// --- sessions --------------------------------------------------------------------------

static void open_session(session *s)
{
    scenario own;
    assert_int_equal(scenario_copy(&own, &base), STATUS_OK);
    DONE(session_open(s, &own, (double)INFINITY, &f));
}

// Where the arm and its wall are at the end of the run.
static double last_gap(const session *s)
{
    return LAST_ROW(&s->run.trace)->gap;
}

// A run that is computed again has the program of now, not answers of the one before.
SWEEP_TEST(a_session_asks_the_program_of_now)
{
    for (int i = 0; i < CASES; i++) {
        base.parameters = parameters_of(&cases[i]);
        cases[i].write(0);
        session s;
        KEPT_SESSION(fresh);
        open_session(&s);
        const double before = last_gap(&s);
        cases[i].write(1);
        DONE(session_compute(&s, &f));
        open_session(&fresh);
        check_close(last_gap(&s), last_gap(&fresh), 0);
        assert_true(last_gap(&s) != before);
        session_finish(&s);
        unlink(cases[i].file);
    }
}

int main(int argc, char **argv)
{
    assert(argc == 3);
    for (int i = 0; i < 2; i++) {
        plugin_files[i] = realpath(argv[i + 1], NULL); // the tests work in another folder
        assert(plugin_files[i] != NULL);
    }
    const int failed = run_cases(NULL, NULL);
    free(plugin_files[0]);
    free(plugin_files[1]);
    return failed != 0;
}
