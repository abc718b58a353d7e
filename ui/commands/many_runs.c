#include "ui/commands/many_runs.h"

#include <assert.h>
#include <math.h>
#include <stdatomic.h>
#include <unistd.h>

#include "src/base/clock.h"

enum {
    BAR_LENGTH = 24,
    MOST_WAITED = 5, // time for runs under way after a signal [s]
};

static volatile sig_atomic_t signal_caught;
static volatile double time_caught; // [s]
static atomic_bool abandoned;

// The first signal lets the runs under way finish, if they do soon; one that comes a second or more
// later ends the program. One that follows at once is the same again: timeout and some shells send
// it both to the program and to its group.
static void catch_signal(int number)
{
    const double now = clock_seconds(CLOCK_MONOTONIC);
    if (number == SIGALRM) {
        abandoned = true;
    } else if (signal_caught == 0) {
        signal_caught = number;
        time_caught = now;
        alarm(MOST_WAITED);
    } else if (now > time_caught + 1) {
        signal(number, SIG_DFL);
        raise(number);
    }
}

void many_runs_catch_signals(sweep_options *o)
{
    assert(o != NULL);
    struct sigaction caught = {.sa_handler = catch_signal};
    sigemptyset(&caught.sa_mask);
    sigaction(SIGINT, &caught, NULL);
    sigaction(SIGTERM, &caught, NULL);

    // the alarm is handled here, so that writing is not interrupted
    caught.sa_flags = SA_RESTART;
    sigaction(SIGALRM, &caught, NULL);

    o->stop = &signal_caught;
    o->abandon = &abandoned;
}

int many_runs_jobs(const arguments *a)
{
    assert(a != NULL);
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    int processors = count < 1 ? 1 : count > SWEEP_MOST_JOBS ? SWEEP_MOST_JOBS : (int)count;
    return a->jobs > 0 ? (int)a->jobs : processors;
}

bool many_runs_only_computes(const arguments *a)
{
    assert(a != NULL);
    return a->ranks != NULL && a->ranks->rank > 0;
}

// --- progress -------------------------------------------------------------------------------

// "0:07", "3:20:00"
static void format_duration(char *text, size_t size, double seconds)
{
    long whole = seconds < 3.6e8 ? lround(seconds) : 359999999;
    if (whole < 3600) {
        snprintf(text, size, "%ld:%02ld", whole / 60, whole % 60);
    } else {
        snprintf(text, size, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
    }
}

bool many_runs_shows_progress(const arguments *a)
{
    assert(a != NULL);
    return isatty(STDERR_FILENO) && !a->quiet;
}

void many_runs_progress(void *context, const sweep_progress *p)
{
    assert(p != NULL);
    const char *word = context;
    char bar[BAR_LENGTH + 1], left[32] = "", failed[32] = "", line[256];

    int filled = p->total > 0 ? (int)(BAR_LENGTH * p->done / p->total) : 0;
    for (int i = 0; i < BAR_LENGTH; i++) {
        bar[i] = i < filled ? '=' : ' ';
    }
    bar[BAR_LENGTH] = '\0';

    // at the rate so far
    if (p->done_now > 0) {
        char time[24];
        double rate = (double)p->done_now / p->elapsed_s;
        format_duration(time, sizeof time, (double)(p->total - p->done) / rate);
        snprintf(left, sizeof left, ", %s left", time);
    }

    // failures are reported at once
    if (p->failed > 0) {
        snprintf(failed, sizeof failed, ", %zu failed", p->failed);
    }

    snprintf(line, sizeof line, "%s%s[%s] %3zu %%  %zu of %zu runs%s%s", word != NULL ? word : "",
             word != NULL ? " " : "", bar, 100 * p->done / p->total, p->done, p->total, failed,
             left);
    fprintf(stderr, "\r%-78.78s", line);
}

void many_runs_clear_progress(void)
{
    fprintf(stderr, "\r%78s\r", "");
}

void many_runs_tell_failure(const sweep_progress *p)
{
    assert(p != NULL && p->failed > 0);
    complain("%zu of %zu runs failed; run %zu: %s", p->failed, p->done_now, p->first_failed + 1,
             p->first_failure);
}

int many_runs_stopped(const char *db, size_t done, size_t total)
{
    if (db != NULL) {
        complain("stopped: %zu of %zu runs are done and kept in '%s'; the same command goes on "
                 "from there",
                 done, total, db);
    } else {
        complain("stopped: %zu of %zu runs were done, nothing is kept; with --db FILE.sqlite they "
                 "can be continued",
                 done, total);
    }
    return 128 + signal_caught;
}
