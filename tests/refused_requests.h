// Every request for memory, descriptors and threads refused in turn: what the library
// computes is then whole and right, or it says that there is no memory. The linker puts
// the functions below in the place of the C library's (-Wl,--wrap=malloc and so on, see
// meson.build), so that requests of this project are counted and refused, of jansson and
// SQLite too, and of nobody else's. Included by one file of a test.
#pragma once

#include <errno.h>
#include <execinfo.h>
#include <pthread.h>
#include <sqlite3.h>
#include <stdatomic.h>
#include <sys/mman.h>

#include "src/base/json.h"
#include "src/base/text_stream.h"
#include "tests/shipped_scenario.h"

// --- who refuses -----------------------------------------------------------------------

static atomic_long requests;
static long refused_at;      // the request that is refused; 0: none
static bool refused_later;   // and all after it
static bool memory_is_given; // requests for memory are not counted

// Where each request was made, by its number: a hash of the calls that led to it.
enum { MOST_REQUESTS = 1 << 18, CALLS_OF_A_PLACE = 10 };
static uint64_t places[MOST_REQUESTS];
static bool notes_places;

static void note_place(long number)
{
    void *calls[CALLS_OF_A_PLACE];
    uint64_t hash = 0xcbf29ce484222325u;
    const int count = backtrace(calls, CALLS_OF_A_PLACE);
    for (int i = 0; i < count; i++) {
        hash = (hash ^ (uint64_t)(uintptr_t)calls[i]) * 0x100000001b3u;
    }
    places[number] = hash;
}

// Whether the next request is to be refused.
static bool refuses(void)
{
    const long number = atomic_fetch_add(&requests, 1) + 1;
    if (notes_places && number < MOST_REQUESTS) {
        note_place(number);
    }
    return refused_at > 0 &&
           (number == refused_at || (refused_later && number > refused_at));
}

static bool refuses_memory(void)
{
    return !memory_is_given && refuses();
}

// A function of the C library that gives `none` with a reason where it is refused.
#define REFUSABLE(refused, type, name, none, reason, parameters, arguments)              \
    type __real_##name parameters;                                                       \
    type __wrap_##name parameters;                                                       \
    type __wrap_##name parameters                                                        \
    {                                                                                    \
        if (refused) {                                                                   \
            errno = reason;                                                              \
            return none;                                                                 \
        }                                                                                \
        return __real_##name arguments;                                                  \
    }
REFUSABLE(refuses_memory(), void *, malloc, NULL, ENOMEM, (size_t size), (size))
REFUSABLE(refuses_memory(), void *, calloc, NULL, ENOMEM, (size_t count, size_t size),
          (count, size))
REFUSABLE(refuses_memory(), void *, realloc, NULL, ENOMEM, (void *old, size_t size),
          (old, size))
REFUSABLE(refuses_memory(), void *, aligned_alloc, NULL, ENOMEM,
          (size_t alignment, size_t size), (alignment, size))
REFUSABLE(refuses_memory(), char *, strdup, NULL, ENOMEM, (const char *text), (text))
REFUSABLE(refuses_memory(), char *, strndup, NULL, ENOMEM,
          (const char *text, size_t most), (text, most))
REFUSABLE(refuses_memory(), int, vasprintf, -1, ENOMEM,
          (char **text, const char *format, va_list list), (text, format, list))

int __wrap_asprintf(char **text, const char *format, ...);
int __wrap_asprintf(char **text, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    const int length = __wrap_vasprintf(text, format, list);
    va_end(list);
    return length;
}

REFUSABLE(refuses_memory(), int, memfd_create, -1, EMFILE,
          (const char *name, unsigned flags), (name, flags))
REFUSABLE(refuses_memory(), int, ftruncate64, -1, ENOSPC, (int fd, off_t size),
          (fd, size))
REFUSABLE(refuses_memory(), int, fallocate64, -1, ENOSPC,
          (int fd, int mode, off_t from, off_t length), (fd, mode, from, length))
REFUSABLE(refuses_memory(), void *, mmap64, MAP_FAILED, ENOMEM,
          (void *at, size_t length, int protection, int flags, int fd, off_t offset),
          (at, length, protection, flags, fd, offset))
REFUSABLE(refuses_memory(), FILE *, fopencookie, NULL, ENOMEM,
          (void *cookie, const char *mode, cookie_io_functions_t functions),
          (cookie, mode, functions))
REFUSABLE(refuses_memory(), int, pthread_create, EAGAIN, EAGAIN,
          (pthread_t * thread, const pthread_attr_t *attributes,
           void *(*function)(void *), void *argument),
          (thread, attributes, function, argument))

static sqlite3_mem_methods sqlite_memory;

static void *sqlite_take(int size)
{
    return refuses_memory() ? NULL : sqlite_memory.xMalloc(size);
}

static void *sqlite_take_again(void *old, int size)
{
    return refuses_memory() ? NULL : sqlite_memory.xRealloc(old, size);
}

static int use_refusing_allocators(void **state)
{
    (void)state;
    json_set_alloc_funcs(__wrap_malloc, free);
    sqlite3_config(SQLITE_CONFIG_GETMALLOC, &sqlite_memory);
    sqlite3_mem_methods refusing = sqlite_memory;
    refusing.xMalloc = sqlite_take;
    refusing.xRealloc = sqlite_take_again;
    return sqlite3_config(SQLITE_CONFIG_MALLOC, &refusing) != SQLITE_OK;
}

// --- what is tried ---------------------------------------------------------------------

// Some work of the library, on something of which `about` tells, or on a scenario that is
// made for it: writes what came of it to `out`. The status is the library's.
typedef status work(const char *about, FILE *out);
typedef status scenario_work(scenario *s, FILE *out);

// Whether a status is one that a refused request may lead to.
static bool tells_of_refusal(status code)
{
    return code == STATUS_OK || code == STATUS_NO_MEMORY || code == STATUS_CANNOT_WRITE;
}

// Requests that are refused of a piece of work: of so few each is, of more so many,
// evenly, and if `everywhere` the first one that each place makes, too.
enum { FEW_REQUESTS = 80, TRIES = 12 };
static bool everywhere;

// Whether the k-th of all requests is to be refused.
static bool is_tried(long k, long all)
{
    const long step = all <= FEW_REQUESTS ? 1 : (all + TRIES - 1) / TRIES;
    bool known = !everywhere || k >= MOST_REQUESTS;
    for (long before = 1; before < k && !known; before++) {
        known = places[before] == places[k];
    }
    return !known || (k - 1) % step == 0;
}

// A refusal comes with a sentence; without one there is none.
static void keep_nothing(void *context, const char *sentence)
{
    (void)context;
    assert_true(sentence[0] != 0);
    fail_if(refused_at == 0, "%s", sentence);
}

static const char *scenario_text = "{}"; // of which the scenarios of a test are made

// The test's scenario with settings, separated by blanks.
static status make_scenario(scenario *s, const char *settings)
{
    status code = scenario_parse(s, scenario_text, strlen(scenario_text), "t.yaml", NULL,
                                 keep_nothing, NULL);
    for (const char *const *one = words_of(settings); code == STATUS_OK && *one != NULL;
         one++) {
        fault f = {0};
        code = scenario_override(s, *one, &f);
        if (code != STATUS_OK) {
            keep_nothing(NULL, f.text);
            scenario_finish(s);
        }
    }
    return code;
}

// What is done again and again: one of both kinds of work.
typedef struct attempt {
    work *plain;
    scenario_work *on_scenario; // NULL: the plain one
    const char *about;          // settings of the scenario
} attempt;

static status carry_out(const attempt *a, FILE *out)
{
    scenario s;
    if (a->on_scenario == NULL) {
        return a->plain(a->about, out);
    }
    status code = make_scenario(&s, a->about);
    if (code == STATUS_OK) {
        code = a->on_scenario(&s, out);
        scenario_finish(&s);
    }
    return code;
}

// What came of the work with the k-th request refused, and all after it if `later`; 0:
// none. The text is to be freed.
static status carry_out_refused(const attempt *a, long k, bool later, char **text)
{
    size_t size;
    FILE *out = open_memstream(text, &size);
    assert_non_null(out);
    atomic_store(&requests, 0);
    refused_later = later;
    refused_at = k;
    loss_forget();
    const status code = carry_out(a, out);
    const bool lost = loss_noted();
    refused_at = 0;
    fclose(out);
    return code == STATUS_OK && lost ? STATUS_NO_MEMORY : code;
}

// The work with no request refused is the measure; then one after the other is, alone and
// with all that follow.
static void try_each(const attempt *a)
{
    char *expected = NULL, *found = NULL;
    for (int i = 0; i < 2;
         i++) { // what is asked for once in a program's life is there then
        free(expected);
        notes_places = everywhere && i > 0;
        assert_int_equal(carry_out_refused(a, 0, false, &expected), STATUS_OK);
        notes_places = false;
    }
    const long all = atomic_load(&requests);
    assert_true(all > 0);

    for (int later = 0; later < 2; later++) {
        for (long k = 1; k <= all; k++) {
            if (!is_tried(k, all)) {
                continue;
            }
            const status code = carry_out_refused(a, k, later, &found);
            const char *also = later ? ", and all after it" : "";
            if (code == STATUS_OK && strcmp(found, expected) != 0) {
                fail_msg(
                    "%s: request %ld of %ld refused%s: another result, and no failure",
                    a->about, k, all, also);
            } else if (!tells_of_refusal(code)) {
                fail_msg("%s: request %ld of %ld refused%s: '%s'", a->about, k, all, also,
                         status_text(code));
            }
            free(found);
        }
    }
    free(expected);
}

static inline void try_all(work *does, const char *about)
{
    try_each(&(attempt){.plain = does, .about = about});
}

static inline void try_with_scenario(scenario_work *does, const char *settings)
{
    try_each(&(attempt){.on_scenario = does, .about = settings});
}

// The main of a test: its cases on scenarios of this text. With an argument the first
// request of each place is refused, not only some of all.
#define REFUSING_MAIN(text, set_up, tear_down)                                           \
    int main(int count, char **arguments)                                                \
    {                                                                                    \
        (void)arguments;                                                                 \
        everywhere = count > 1;                                                          \
        scenario_text = text;                                                            \
        return run_cases(set_up, tear_down);                                             \
    }

static inline int refuse_in_folder(void **state)
{
    return use_refusing_allocators(state) != 0 || enter_folder(state) != 0;
}
