// Shared by tests of sweeps: a folder of their own, and sweeps of one scenario.
#pragma once

#include "src/study/sweep_run.h"
#include "tests/shipped_scenario.h"

// The scenario that is swept: two links at 1 V for 0.6 s.
extern scenario base;

// A fault_handler that shows what should not be.
void print_sentence(void *context, const char *sentence);

// Set-up and tear-down of a test or of all: reads `base` and works in a folder of its
// own.
int sweep_fixture_open(void **state);
int sweep_fixture_close(void **state);

// A case between these two.
#define SWEEP_TEST(name) TEST_BETWEEN(name, sweep_fixture_open, sweep_fixture_close)

// The sweep of up to two --vary; those not given are NULL.
status sweep_of(sweep *s, sweep_sampling sampling, size_t runs, uint64_t seed, fault *f,
                const char *a, const char *b);

// The same, which has to be one.
void must_sweep(sweep *s, sweep_sampling sampling, size_t runs, const char *a,
                const char *b);

// The same until its block is left.
#define SWEPT(s, ...)                                                                    \
    KEPT_SWEEP(s);                                                                       \
    must_sweep(&s, __VA_ARGS__)

// The store of a sweep in a file, or in memory without a path, that has to open.
sweep_store *must_open(const char *path, const sweep *s);

// Computes what is missing, which has to succeed.
sweep_progress must_run(const sweep *s, sweep_store *store, int jobs);

// Carries out SQL on a database, as somebody else's program might.
void tamper(const char *path, const char *sql);

// All rows as CSV; free it.
char *csv_of(sweep_store *store);

// The CSV of the whole sweep, never interrupted; free it.
char *uninterrupted(const sweep *s, int jobs);
