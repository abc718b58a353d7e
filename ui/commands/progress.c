#include "ui/commands/progress.h"

#include <assert.h>
#include <math.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "src/base/clock.h"

// --- runs and pieces -------------------------------------------------------------------

#define FIRST_NOTE 1.0 // after this work is worth a word [s]
#define NEXT_NOTE  0.2 // [s]

// The thread that shows the progress.
static struct ticker {
    const char *pieces; // of the work; NULL: it is one run
    int total;          // of them
    double duration;    // of the run [s]
    bool ticks;         // the thread is there
    pthread_t thread;
    sem_t over;
} ticker;

// Tells now and then how far the work is, and takes its words away at the end.
static void *tick(void *argument)
{
    struct ticker *t = argument;
    bool told = false;
    struct timespec next = clock_after(FIRST_NOTE);

    // a note now and then until the work is over
    while (sem_clockwait(&t->over, CLOCK_MONOTONIC, &next) != 0) {
        if (t->pieces != NULL) {
            fprintf(stderr, "\rimpactlab: %d of %d %s (^C stops) ",
                    atomic_load_explicit(&interrupts_monitor.pieces,
                                         memory_order_relaxed),
                    t->total, t->pieces);
        } else {
            fprintf(stderr, "\rimpactlab: %.*f of %g s (^C stops) ",
                    t->duration < 10 ? 3 : 1,
                    atomic_load_explicit(&interrupts_monitor.time, memory_order_relaxed),
                    t->duration);
        }
        fflush(stderr);
        told = true;
        next = clock_after(NEXT_NOTE);
    }

    if (told) {
        fprintf(stderr, "\r%60s\r", "");
        fflush(stderr);
    }
    return NULL;
}

static void begin(const arguments *a)
{
    interrupts_monitor = (run_monitor){.stop = false};
    ticker.ticks = false;
    sem_init(&ticker.over, 0, 0);
    interrupts_catch();
    if (interrupted != 0) {
        interrupts_monitor.stop = true;
    }
    if (!isatty(STDERR_FILENO) || a->quiet) {
        return;
    }

    // the thread of the notes is not to take it
    sigset_t interrupt, mask;
    sigemptyset(&interrupt);
    sigaddset(&interrupt, SIGINT);
    pthread_sigmask(SIG_BLOCK, &interrupt, &mask);
    ticker.ticks = pthread_create(&ticker.thread, NULL, tick, &ticker) == 0;
    pthread_sigmask(SIG_SETMASK, &mask, NULL);
}

run_monitor *work_begin(const arguments *a, const char *pieces, int total)
{
    assert(total > 0);
    ticker.pieces = pieces;
    ticker.total = total;
    begin(a);
    return &interrupts_monitor;
}

void work_end(void)
{
    // the notes end before anything else is printed
    sem_post(&ticker.over);
    if (ticker.ticks) {
        pthread_join(ticker.thread, NULL);
    }

    sem_destroy(&ticker.over);
}

int work_finish(const arguments *a, status code, const fault *f, const command_results *r,
                const scenario *s, const void *found)
{
    work_end();
    if (code == STATUS_OK) {
        return write_results(a, r, s, found, true);
    }
    if (code != STATUS_STOPPED) {
        return complain_fault(f);
    }

    // what there is
    const bool nothing =
        r->kept == NULL || (interrupts_monitor.pieces == 0 && r->none != NULL);
    const int result = nothing ? EXIT_DONE : write_results(a, r, s, found, false);
    const char *none = r->none != NULL ? r->none : "nothing is written";
    complain("stopped: %d of %d %s were done, %s", interrupts_monitor.pieces,
             ticker.total, ticker.pieces, nothing ? none : r->kept);
    return worse(result, EXIT_FAILED);
}

status run_with_progress(const arguments *a, const scenario *s, bool keep_trace,
                         run_result *result)
{
    const run_options options = {.keep_trace = keep_trace,
                                 .monitor = &interrupts_monitor};
    ticker.pieces = NULL;
    ticker.duration = s->parameters.run.duration;
    begin(a);
    const status code = run_scenario_with(s, &options, result);
    work_end();
    return code;
}

int run_stopped(const scenario *s, const char *what_became)
{
    complain("stopped: %.6g of %g s were computed, %s", interrupts_monitor.time,
             s->parameters.run.duration, what_became);
    return EXIT_FAILED;
}

// --- sweeps ----------------------------------------------------------------------------

enum { BAR_LENGTH = 24 };

static const char full_bar[BAR_LENGTH + 1] = "========================";

int many_runs_jobs(const arguments *a)
{
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    int processors = 1;
    if (!(count < 1)) {
        if (count > SWEEP_MOST_JOBS) {
            processors = SWEEP_MOST_JOBS;
        } else {
            processors = (int)count;
        }
    }
    if (a->jobs > 0) {
        return (int)a->jobs;
    }
    return processors;
}

// --- progress --------------------------------------------------------------------------

// The progress bar, a line that is overwritten.
static void show_progress(void *context, const sweep_progress *p)
{
    const char *word = context;
    char left[32] = "", failed[32] = "", line[256];
    const int filled = p->total > 0 ? (int)(BAR_LENGTH * p->done / p->total) : 0;

    // at the rate so far: "0:07", "3:20:00"
    if (p->done_now > 0) {
        const double rate = (double)p->done_now / p->elapsed_s;
        const long s = lround(fmin((double)(p->total - p->done) / rate, 359999999));
        if (s < 3600) {
            snprintf(left, sizeof left, ", %ld:%02ld left", s / 60, s % 60);
        } else {
            snprintf(left, sizeof left, ", %ld:%02ld:%02ld left", s / 3600, s / 60 % 60,
                     s % 60);
        }
    }

    // failures are reported at once
    if (p->failed > 0) {
        snprintf(failed, sizeof failed, ", %zu failed", p->failed);
    }

    // the word, the bar, and numbers behind it
    int length = 0;
    if (word != NULL) {
        length = snprintf(line, sizeof line, "%.100s ", word);
    }
    snprintf(line + length, sizeof line - (size_t)length,
             "[%.*s%*s] %3zu %%  %zu of %zu runs%s%s", filled, full_bar,
             BAR_LENGTH - filled, "", 100 * p->done / p->total, p->done, p->total, failed,
             left);
    fprintf(stderr, "\r%-78.78s", line);
}

sweep_options many_runs_begin(const arguments *a, const char *word)
{
    interrupts_catch();
    sweep_options o = {.jobs = many_runs_jobs(a),
                       .stop = &interrupted,
                       .abandon = &interrupts_abandon,
                       .context = (void *)word};
    if (isatty(STDERR_FILENO) && !a->quiet) {
        o.report = show_progress;
    }
    return o;
}

void many_runs_end(const sweep_options *o)
{
    if (o->report != NULL) {
        fprintf(stderr, "\r%78s\r", "");
    }
}

void many_runs_report_failure(const sweep_progress *p)
{
    assert(p->failed > 0);
    complain("%zu of %zu runs failed; run %zu: %s", p->failed, p->done_now,
             p->first_failed + 1, p->first_failure);
}

int many_runs_stopped(const char *db, size_t done, size_t total, const char *what_became)
{
    if (db == NULL) {
        complain("stopped: %zu of %zu runs were done, %s", done, total, what_became);
    } else {
        complain("stopped: %zu of %zu runs were done, %s; they are kept in '%s', from "
                 "where the same command goes on",
                 done, total, what_became, db);
    }
    return EXIT_FAILED;
}
