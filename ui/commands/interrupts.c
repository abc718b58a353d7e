#include "ui/commands/interrupts.h"

#include <stdio.h>
#include <unistd.h>

#include "src/base/clock.h"

#define SAME_SIGNAL 0.3 // within it a signal is the one before once more [s]

enum {
    SIGNALS = 2,
    MOST_WAITED =
        5, // time for runs under way after a signal, where they may be finished [s]
};

volatile sig_atomic_t interrupted;
run_monitor interrupts_monitor;
atomic_bool interrupts_abandon;

static const int signals[SIGNALS] = {SIGINT, SIGTERM};
static struct sigaction before[SIGNALS]; // what they did
static bool catching;
static volatile double caught_at; // [s]

// The first signal stops the work and sets the alarm, after which runs in hand are given
// up; a later one ends the program.
static void catch_signal(int number)
{
    const double now = clock_seconds(CLOCK_MONOTONIC);
    if (number == SIGALRM) {
        interrupts_abandon = true;
    } else if (interrupted == 0) {
        interrupted = number;
        caught_at = now;
        interrupts_monitor.stop = stop_everything = true;
        alarm(MOST_WAITED);
    } else if (now > caught_at + SAME_SIGNAL) {
        // as if nobody caught it
        sigaction(number, &before[number == signals[1]], NULL);
        raise(number);
    }
}

void interrupts_catch(void)
{
    // writing goes on where it was
    struct sigaction act = {.sa_handler = catch_signal, .sa_flags = SA_RESTART};
    sigemptyset(&act.sa_mask);
    if (catching) {
        return;
    }
    catching = true;
    sigaction(SIGALRM, &act, NULL);
    for (int i = 0; i < SIGNALS; i++) {
        sigaction(signals[i], NULL, &before[i]);
        if (before[i].sa_handler != SIG_IGN) {
            sigaction(signals[i], &act, NULL);
        }
    }
}

int interrupts_end(int result)
{
    // the program ends by the signal, so that whoever called it sees it
    if (interrupted != 0) {
        fflush(stdout);
        if (result == 0) {
            fputs("impactlab: interrupted when all was computed: the results are whole\n",
                  stderr);
        }
        fflush(NULL);
        signal(interrupted, SIG_DFL);
        raise(interrupted);
    }

    // signals do what they did before
    for (int i = 0; catching && i < SIGNALS; i++) {
        sigaction(signals[i], &before[i], NULL);
    }
    catching = false;
    return result;
}
