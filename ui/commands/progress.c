#include "ui/commands/progress.h"

#include <assert.h>
#include <math.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdio.h>
#include <unistd.h>

#include "src/base/clock.h"

// --- runs and pieces -------------------------------------------------------------------

#define FIRST_NOTE 1.0 // work that takes longer shows how far it is [s]
#define NEXT_NOTE  0.2 // between two notes [s]

// The work in hand, and the thread that shows its progress.
static struct {
    const char *pieces; // of the work; NULL: it is one run
    int total;          // of them
    double duration;    // of the run [s]
    bool has_thread;
    pthread_t thread;
    sem_t over;
} work;

// How far the work is, on the line of the one before.
static void print_note(void)
{
    if (work.pieces != NULL) {
        const int done =
            atomic_load_explicit(&interrupts_monitor.pieces, memory_order_relaxed);
        fprintf(stderr, "\rimpactlab: %d of %d %s (^C stops) ", done, work.total,
                work.pieces);
    } else {
        const double time =
            atomic_load_explicit(&interrupts_monitor.time, memory_order_relaxed);
        const int decimals = work.duration < 10 ? 3 : 1;
        fprintf(stderr, "\rimpactlab: %.*f of %g s (^C stops) ", decimals, time,
                work.duration);
    }
    fflush(stderr);
}

// The thread: prints a note now and then until the work is over, and clears the line.
static void *show_notes(void *unused)
{
    (void)unused;
    bool any_printed = false;
    struct timespec next = clock_after(FIRST_NOTE);
    while (sem_clockwait(&work.over, CLOCK_MONOTONIC, &next) != 0) {
        print_note();
        any_printed = true;
        next = clock_after(NEXT_NOTE);
    }

    if (any_printed) {
        fprintf(stderr, "\r%60s\r", "");
        fflush(stderr);
    }
    return NULL;
}

// Starts the thread that shows the progress; without it the work goes on unseen.
static void start_notes(void)
{
    // an interrupt is for the main thread
    sigset_t interrupt, mask;
    sigemptyset(&interrupt);
    sigaddset(&interrupt, SIGINT);
    pthread_sigmask(SIG_BLOCK, &interrupt, &mask);
    work.has_thread = pthread_create(&work.thread, NULL, show_notes, NULL) == 0;
    pthread_sigmask(SIG_SETMASK, &mask, NULL);
}

// Begins the work that is described in `work`.
static void begin_work(const arguments *a)
{
    interrupts_monitor = (run_monitor){.stop = false};
    work.has_thread = false;
    sem_init(&work.over, 0, 0);
    interrupts_catch();
    if (interrupted != 0) {
        interrupts_monitor.stop = true;
    }
    if (isatty(STDERR_FILENO) && !a->quiet) {
        start_notes();
    }
}

run_monitor *work_begin(const arguments *a, const char *pieces, int total)
{
    assert(total > 0);
    work.pieces = pieces;
    work.total = total;
    begin_work(a);
    return &interrupts_monitor;
}

void work_end(void)
{
    // the notes end before anything else is printed
    sem_post(&work.over);
    if (work.has_thread) {
        pthread_join(work.thread, NULL);
    }
    sem_destroy(&work.over);
}

// Writes the results of work that was stopped, if there are any to write, and says what
// became of it. Returns the exit status.
static int write_stopped_results(const arguments *a, const command_results *r,
                                 const void *found)
{
    const bool any = interrupts_monitor.pieces > 0 || r->none == NULL;
    const char *what_became = "nothing is written";
    int result = EXIT_DONE;
    if (any && r->kept != NULL) {
        result = write_results(a, r, found, false);
        what_became = r->kept;
    } else if (r->none != NULL) {
        what_became = r->none;
    }
    complain("stopped: %d of %d %s were done, %s", interrupts_monitor.pieces, work.total,
             work.pieces, what_became);
    return worse(result, EXIT_FAILED);
}

int work_finish(const arguments *a, status code, const fault *f, const command_results *r,
                const void *found)
{
    work_end();
    switch (code) {
    case STATUS_OK:
        return write_results(a, r, found, true);
    case STATUS_STOPPED:
        return write_stopped_results(a, r, found);
    default:
        return complain_fault(f);
    }
}

status run_with_progress(const arguments *a, const scenario *s, run_options options,
                         run_result *result)
{
    options.monitor = &interrupts_monitor;
    work.pieces = NULL;
    work.duration = s->parameters.run.duration;
    begin_work(a);
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

// --- many runs -------------------------------------------------------------------------

enum { BAR_LENGTH = 24 };

static const char full_bar[BAR_LENGTH + 1] = "========================";

int many_runs_jobs(const arguments *a)
{
    if (a->jobs > 0) {
        return (int)a->jobs;
    }
    const long processors = sysconf(_SC_NPROCESSORS_ONLN);
    if (processors < 1) {
        return 1;
    }
    if (processors > SWEEP_MOST_JOBS) {
        return SWEEP_MOST_JOBS;
    }
    return (int)processors;
}

// The time left at the rate so far, ", 0:07 left" or ", 3:20:00 left"; "" if there is no
// rate yet.
static void format_time_left(const sweep_progress *p, char *text, size_t size)
{
    static const double longest = 99999 * 3600.0 + 3599; // [s]
    text[0] = '\0';
    if (p->done_now == 0) {
        return;
    }

    // minutes and seconds, with hours where there are any
    const double rate = (double)p->done_now / p->elapsed_s;
    const long left = lround(fmin((double)(p->total - p->done) / rate, longest));
    if (left < 3600) {
        snprintf(text, size, ", %ld:%02ld left", left / 60, left % 60);
    } else {
        snprintf(text, size, ", %ld:%02ld:%02ld left", left / 3600, left / 60 % 60,
                 left % 60);
    }
}

// The progress bar, a line that is overwritten.
static void show_run_progress(void *context, const sweep_progress *p)
{
    char left[32], failed[32] = "", line[256];
    format_time_left(p, left, sizeof left);
    if (p->failed > 0) {
        snprintf(failed, sizeof failed, ", %zu failed", p->failed);
    }

    // the word, the bar, and numbers behind it
    const char *word = context;
    int length = 0;
    if (word != NULL) {
        length = snprintf(line, sizeof line, "%.100s ", word);
    }
    int filled = 0;
    if (p->total > 0) {
        filled = (int)(BAR_LENGTH * p->done / p->total);
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
        o.report = show_run_progress;
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
