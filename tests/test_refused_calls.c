// Calls of the system refused in turn, and requests for memory with them: whole files are
// those of before or the whole new ones, rows that are shared stay what they are,
// programs that are controllers answer or the run says why not, and what measures says
// that it cannot.
#include "src/base/shared_array.h"
#include "src/base/whole_file.h"
#include "src/rig/external/supervisor.h"
#include "src/session/session.h"
#include "src/study/bench.h"
#include "tests/shared_memory.h"
#include "tests/refused_calls.h"

// --- whole files -----------------------------------------------------------------------

static void assert_has(const char *path, const char *expected)
{
    char now[8] = "";
    FILE *file = __real_fopen64(path, "r");
    assert_non_null(file);
    assert_non_null(fgets(now, sizeof now, file));
    fclose(file);
    assert_string_equal(now, expected);
}

static status write_whole_file(const char *path, FILE *out)
{
    whole_file w;
    fault f = {0};
    FILE *old = __real_fopen64(path, "w");
    fputs("old", old);
    fclose(old);
    status code = whole_file_check(path, &f);
    code = code == STATUS_OK ? whole_file_open(&w, path, &f) : code;
    if (code == STATUS_OK) {
        fputs("new", w.stream);
        code = whole_file_commit(&w, &f);
    }

    // the former file, or the complete new one; every refusal is reported
    assert_has(path, code == STATUS_OK ? "new" : "old");
    assert_true(code == STATUS_OK || strstr(f.text, "cannot be written: ") != NULL);
    fputs(code == STATUS_OK ? "new" : "old", out);
    return code;
}

// What is written in place: nothing of it is put back.
static status write_in_place(const char *path, FILE *out)
{
    whole_file w;
    fault f = {0};
    status code = whole_file_open(&w, path, &f);
    if (code == STATUS_OK) {
        code = whole_file_close(&w, STATUS_OK, &f);
    }
    assert_true(code == STATUS_OK || strstr(f.text, "cannot be written: ") != NULL);
    fputs("written", out);
    return code;
}

// --- shared rows -----------------------------------------------------------------------

enum { PER_CHUNK = ARRAY_CHUNK / sizeof(uint64_t), ROWS = 5 * PER_CHUNK / 2 };

// An array with room for all rows, filled; it is to be finished even on failure.
static bool fill(shared_array *a)
{
    const bool room = shared_array_reserve(a, sizeof(uint64_t), ROWS, ROWS);
    if (!room || !shared_array_grow(a, ROWS)) {
        return false;
    }
    for (size_t i = 0; i < ROWS; i++) {
        ((uint64_t *)a->base)[i] = i;
    }
    return true;
}

// One array, and another that shares its rows.
static status share_rows(const char *ignored, FILE *out)
{
    (void)ignored;
    shared_array one, shares;
    const bool filled = fill(&one);
    bool whole = shared_array_reserve(&shares, sizeof(uint64_t), ROWS, ROWS) && filled &&
                 shared_array_share(&shares, &one, ROWS);

    // each is whole without the others
    shared_array_finish(&one);
    for (size_t i = 0; i < ROWS && whole; i++) {
        whole = ((uint64_t *)shares.base)[i] == i;
        assert_true(whole);
    }
    shared_array_finish(&shares);
    assert_true(shared_array_memory() == 0);
    fputs("shared", out);
    return whole ? STATUS_OK : STATUS_NO_MEMORY;
}

// --- programs --------------------------------------------------------------------------

// A program that reads a line, answers it and ends with a given status.
static status ask_once(const char *command, FILE *out)
{
    supervised_program p;
    char answer[16] = "";
    const int reason = supervised_program_start(&p, command);
    if (reason != 0) {
        return STATUS_NO_MEMORY;
    }
    const bool asked = __real_send(p.input, "5\n", 2, MSG_NOSIGNAL) == 2;
    struct pollfd watched = {.fd = p.output, .events = POLLIN};
    assert_int_equal(__real_poll(&watched, 1, 60000), 1);
    const ssize_t length = __real_read(p.output, answer, sizeof answer - 1);
    const int ended = supervised_program_end(&p);
    fprintf(out, "%s%d\n", answer, ended);

    // one that never came to its work shows that in its answer or in how it ended
    return asked && length > 0 && ended == 7 ? STATUS_OK : STATUS_NO_MEMORY;
}

// Has a scenario led by a program in the shell.
static status lead_by_program(scenario *s)
{
    char command[] =
        "control.command=while read -r line; do echo '{\"command\": 1}'; done";
    char law[] = "control.law=process";
    char *const settings[] = {command, law};
    s->parameters.code_allowed = true;
    return scenario_override_all(s, settings, 2, keep_nothing, NULL);
}

// That program is asked, and another one after a change.
static status ask_a_program(scenario *s, FILE *out)
{
    scenario own;
    session t;
    fault f = {0};
    status code = scenario_copy(&own, s);
    if (code != STATUS_OK) {
        return code;
    }
    code = lead_by_program(&own);
    if (code != STATUS_OK) {
        scenario_finish(&own);
        return refused_at > 0 ? STATUS_NO_MEMORY : code;
    }
    code = session_open(&t, &own, HUGE_VAL, &f);
    if (code != STATUS_OK) {
        return code == STATUS_CONTROLLER_FAILED && refused_at > 0 ? STATUS_NO_MEMORY
                                                                  : code;
    }

    // the change's run asks from the beginning
    code = t.run.summary.status;
    session_seek(&t, 0.05);
    code = code == STATUS_OK ? session_change(&t, PARAMETER_INDEX(control.force), "2", &f)
                             : code;
    code = code == STATUS_OK ? t.run.summary.status : code;
    for (size_t i = 0; i < t.run.trace.row_count && code == STATUS_OK; i++) {
        fprintf(out, "%a %a\n", t.run.trace.rows[i].force, t.run.trace.rows[i].hub_angle);
    }
    session_finish(&t);
    return code == STATUS_CONTROLLER_FAILED && refused_at > 0 ? STATUS_NO_MEMORY : code;
}

// One read of the program's answers or complaints fails for good: the run is the same
// without it or ends and says why, and never because of a program that ended.
TEST(answers_that_cannot_be_read)
{
    int failed = 0;
    bool reached = true;
    for (long k = 1; reached; k++) {
        KEPT_SCENARIO(s);
        KEPT_RUN(result);
        assert_int_equal(make_scenario(&s, "control.rate=100"), STATUS_OK);
        assert_int_equal(lead_by_program(&s), STATUS_OK);

        reads = 0;
        unreadable_at = k;
        const status code = run_scenario(&s, false, &result);
        reached = reads >= k;
        unreadable_at = 0;
        if (code != STATUS_OK) {
            assert_int_equal(code, STATUS_CONTROLLER_FAILED);
            assert_non_null(
                strstr(result.summary.message, "cannot be read: Input/output error"));
            failed++;
        }
    }
    assert_true(failed > 8);
}

// --- scenarios -------------------------------------------------------------------------

static status list_scenarios(const char *ignored, FILE *out)
{
    (void)ignored;
    char **names;
    int count;
    fault f = {0};
    const status code = scenario_list(&names, &count, &f);
    assert_true(code == STATUS_OK || f.text[0] != '\0');
    for (int i = 0; i < count; i++) {
        fprintf(out, "%s\n", names[i]);
    }
    free_names(names, count);

    // a folder that cannot be opened, for want of descriptors, is not an empty one
    return code == STATUS_CANNOT_READ && refused_at > 0 ? STATUS_NO_MEMORY : code;
}

static status open_by_name(const char *name, FILE *out)
{
    scenario s;
    const status code = scenario_open(&s, name, keep_nothing, NULL);
    if (code == STATUS_OK) {
        fputs(s.title, out);
        scenario_finish(&s);
    }
    return code == STATUS_CANNOT_READ && refused_at > 0 ? STATUS_NO_MEMORY : code;
}

TEST(scenarios_are_listed_whole)
{
    try_all(list_scenarios, "");
}

// One that is there is never said to be missing, and to find it no folder is read: a list
// of all reads each folder once.
TEST(scenarios_are_found_by_name)
{
    folders_opened = 0;
    try_all(open_by_name, "corrected/first-impact");
    assert_int_equal(folders_opened, 0);
}

// --- measurements ----------------------------------------------------------------------

// A number, or a sentence that says why there is none.
static status measure(const char *name, FILE *out)
{
    double value = -1;
    fault f = {0};
    status code = STATUS_BAD_ARGUMENT;
    for (int i = 0; i < BENCHMARKS; i++) {
        if (strcmp(bench_table[i].name, name) == 0) {
            code = bench_table[i].measure(&bench_table[i], &value, &f);
        }
    }
    assert_true(code == STATUS_OK ? value > 0 && isfinite(value) : f.text[0] != '\0');
    fputs("measured", out);
    return code;
}

// --- the tests -------------------------------------------------------------------------

// The first rows of a program need a file and tables that later ones find; each refusal
// leaves some of it, from which the next attempt goes on.
TEST(the_first_rows_of_all)
{
    long attempts = 0;
    bool grown = false;
    refused_later = true;
    while (!grown) {
        shared_array a;
        atomic_store(&requests, 0);
        refused_at = 1 + attempts++ / 2;
        grown =
            shared_array_reserve(&a, sizeof(uint64_t), 1, 1) && shared_array_grow(&a, 1);
        refused_at = 0;
        shared_array_finish(&a);
        assert_true(shared_array_memory() == 0);
    }
    assert_true(attempts > 4); // its place, a chunk, its memory
}

TEST(rows_are_shared_or_refused)
{
    try_all(share_rows, "");
}

TEST(whole_files)
{
    assert_int_equal(symlink("file", "link"), 0);
    try_all(write_whole_file, "file");
    try_all(write_whole_file, "link");
    try_all(write_in_place, "/dev/null");
}

TEST(programs_as_controllers)
{
    memory_is_given = true;
    try_all(ask_once, "read x; echo \"$x\"; exit 7");
    try_with_scenario(ask_a_program, "control.rate=100");
    memory_is_given = false;
    try_with_scenario(ask_a_program, "control.rate=100");
}

TEST(measurements)
{
    static const char *const names[] = {"arm_n2_us_per_ms", "struck_n8_us_per_ms",
                                        "batch_n2_steps_per_s",
                                        "batch_width_4_us_per_run"};
    bench_window = 1e-9;
    for (EACH(c, names)) {
        try_all(measure, *c);
    }
}

REFUSING_MAIN(
    "title: t\nwall: {angle: 0}\nmotor: {voltage: 4 V}\nrun: {duration: 0.12 s}\n"
    "initial: {angle: -0.01 rad}\n",
    refuse_in_folder, leave_folder)
