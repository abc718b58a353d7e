// What every test program takes: cmocka, and the standard library and files of POSIX with
// it; random numbers, cases that list themselves, and comparisons of doubles that print
// both values.
#pragma once

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "../src/base/random.h"
#include "../src/base/scoped.h"

// Fails unless |a - b| <= tolerance; NaN never passes.
#define check_close(a, b, tolerance)                                                     \
    do {                                                                                 \
        double check_a = (a), check_b = (b), check_t = (tolerance);                      \
        if (!(fabs(check_a - check_b) <= check_t)) {                                     \
            fail_msg("%s = %.17g, expected %s = %.17g within %g (off by %g)", #a,        \
                     check_a, #b, check_b, check_t, check_a - check_b);                  \
        }                                                                                \
    } while (0)

// Fails unless |a - b| <= relative * |b|.
#define check_relative(a, b, relative) check_close(a, b, (relative)*fabs(b))

// Fails unless a < b; prints both.
#define check_below(a, b)                                                                \
    do {                                                                                 \
        double check_a = (a), check_b = (b);                                             \
        if (!(check_a < check_b)) {                                                      \
            fail_msg("%s = %.17g is not below %s = %.17g", #a, check_a, #b, check_b);    \
        }                                                                                \
    } while (0)

// A case of the program, whose body follows; `state` is what the set-up left. A program
// that has no main of its own runs its cases in the order in which they are written.
#define TEST(name) TEST_BETWEEN(name, NULL, NULL)

// The same between its own set-up and tear-down.
#define TEST_BETWEEN(name, set_up, tear_down)                                            \
    static void name(void **state);                                                      \
    __attribute__((constructor)) static void add_##name(void)                            \
    {                                                                                    \
        add_case((struct CMUnitTest){#name, name, set_up, tear_down, NULL}, __LINE__);   \
    }                                                                                    \
    static void name(__attribute__((unused)) void **state)

void add_case(struct CMUnitTest added, int line);

// Runs all cases between the group's set-up and tear-down; 1 if one failed, 0 if none.
int run_cases(CMFixtureFunction set_up, CMFixtureFunction tear_down);

// The main of a program whose cases share a set-up and a tear-down; and of one whose
// cases fail where somebody waits for what never comes.
#define ALL_BETWEEN(set_up, tear_down) MAIN_AFTER((void)0, set_up, tear_down)
#define ALL_IN_TWO_MINUTES             MAIN_AFTER(alarm(120), NULL, NULL)
#define MAIN_AFTER(first, set_up, tear_down)                                             \
    int main(void)                                                                       \
    {                                                                                    \
        first;                                                                           \
        return run_cases(set_up, tear_down);                                             \
    }

// Fails with a sentence if the condition holds.
#define fail_if(condition, ...)                                                          \
    do {                                                                                 \
        if (condition) {                                                                 \
            fail_msg(__VA_ARGS__);                                                       \
        }                                                                                \
    } while (0)

// The call is done; else the test fails with the sentence that it writes to `f`.
#define DONE(...)                                                                        \
    do {                                                                                 \
        fault f = {0};                                                                   \
        fail_if((__VA_ARGS__) != STATUS_OK, "%s: %s", #__VA_ARGS__, f.text);             \
    } while (0)

// The call is refused with this status and a sentence to `f` that says so.
#define REFUSED(code, says, ...)                                                         \
    do {                                                                                 \
        fault f = {0};                                                                   \
        assert_int_equal((__VA_ARGS__), (code));                                         \
        fail_if(strstr(f.text, (says)) == NULL, "'%s' does not say '%s'", f.text,        \
                (says));                                                                 \
    } while (0)

// The usual ones: KEPT_RUN(r) = run_done(&s, true);
#define KEPT_TEXT(name)     SCOPED(free_kept) char *name
#define KEPT_RUN(name)      SCOPED(run_finish) run_result name
#define KEPT_SCENARIO(name) SCOPED(scenario_finish) scenario name
#define KEPT_SESSION(name)  SCOPED(session_finish) session name
#define KEPT_SWEEP(name)    SCOPED(sweep_finish) sweep name
#define KEPT_STORE(name)    SCOPED(sweep_store_close_kept) sweep_store *name
#define KEPT_MOTION(name)   SCOPED(motion_destroy_kept) motion *name
#define KEPT_LOOP(name)     SCOPED(loop_destroy_kept) run_loop *name

// A table's entries in turn: for (EACH(c, cases)) { ... c->name ... }
#define EACH(entry, table)                                                               \
    const __typeof__((table)[0]) *entry = (table);                                       \
    entry < (table) + sizeof(table) / sizeof((table)[0]);                                \
    entry++

// Rows and events of a trace in turn: for (EACH_ROW(row, &r.trace)) { ... row->force ...
// }
#define EACH_ROW(row, t)                                                                 \
    const sample *row = (t)->rows;                                                       \
    row < (t)->rows + (t)->row_count;                                                    \
    row++
#define EACH_EVENT(e, t)                                                                 \
    const event *e = (t)->events;                                                        \
    e < (t)->events + (t)->event_count;                                                  \
    e++
#define LAST_ROW(t) (&(t)->rows[(t)->row_count - 1])

// Texts in turn: for (EACH_TEXT(c, "one", "two")) { ... *c ... }
#define EACH_TEXT(entry, ...)                                                            \
    const char *const *entry = (const char *const[]){__VA_ARGS__, NULL};                 \
    *entry != NULL;                                                                      \
    entry++

// Values in turn: for (EACH_OF(double, x, 1, 2)) { ... *x ... }
#define EACH_OF(type, entry, ...)                                                        \
    const type *entry = (const type[]){__VA_ARGS__},                                     \
               *entry##_end =                                                            \
                   entry + sizeof((const type[]){__VA_ARGS__}) / sizeof(type);           \
    entry < entry##_end;                                                                 \
    entry++

// A new text, to be freed: what a call writes to `stream`. WRITTEN(text,
// json_write(stream, j));
#define WRITTEN(text, ...)                                                               \
    char *text = NULL;                                                                   \
    do {                                                                                 \
        size_t written_size;                                                             \
        FILE *stream = open_memstream(&text, &written_size);                             \
        assert_non_null(stream);                                                         \
        __VA_ARGS__;                                                                     \
        assert_int_equal(fclose(stream), 0);                                             \
    } while (0)

static inline int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// A text with numbers in it, which the next 63 leave as it is.
char *formatted(const char *format, ...) __attribute__((format(printf, 1, 2)));

// What stands between the blanks of a text, kept as long; the list ends with NULL.
const char *const *words_of(const char *text);

// A text of so many characters, all the same, kept as long.
static inline char *repeated(char c, int length)
{
    char *text = formatted("%*s", length, "");
    return memset(text, c, (size_t)length);
}

// A case that works in an empty folder of its own, `test_folder`, which goes afterwards
// with all that is in it. Where all cases share one: ALL_BETWEEN(enter_folder,
// leave_folder).
#define TEST_IN_FOLDER(name) TEST_BETWEEN(name, enter_folder, leave_folder)

extern char test_folder[];
int enter_folder(void **state);
int leave_folder(void **state);

// Writes a file whose content is this text; the text of a file, to be freed, its bytes
// with a zero behind them, and whether a part is among them.
void put_file(const char *path, const char *text);
void put_bytes(const char *path, const void *bytes, size_t length);
char *file_text(const char *path);

static inline void assert_holds(const char *path, const char *expected)
{
    KEPT_TEXT(text) = file_text(path);
    assert_string_equal(text, expected);
}
char *file_bytes(const char *path, size_t *length);
bool file_has(const char *path, const char *part);

// Names that a list of them gave.
void free_names(char **names, int how_many);

static inline random_generator seeded(uint64_t seed)
{
    random_generator g;
    random_seed(&g, seed);
    return g;
}

static inline double evenly(random_generator *g, double low, double high)
{
    return low + (high - low) * random_uniform(g);
}
