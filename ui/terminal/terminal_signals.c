#include "ui/terminal/terminal_state.h"

#include <errno.h>
#include <stdlib.h>
#include <unistd.h>

volatile sig_atomic_t terminal_leaving;    // the signal that asks to leave
volatile sig_atomic_t terminal_suspending; // ^Z was pressed

static const int polite_signals[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGWINCH, SIGCONT, SIGTSTP};
static const int fatal_signals[] = {SIGSEGV, SIGABRT, SIGFPE,  SIGBUS,   SIGILL,  SIGTRAP,
                                    SIGXCPU, SIGSYS,  SIGUSR1, SIGUSR2,  SIGALRM, SIGVTALRM,
                                    SIGPROF, SIGIO,   SIGPWR,  SIGSTKFLT};
enum {
    POLITE = sizeof polite_signals / sizeof polite_signals[0],
    FATAL = sizeof fatal_signals / sizeof fatal_signals[0],
    SIGNAL_STACK = 64 * 1024
};
static struct sigaction polite_before[POLITE], fatal_before[FATAL];
static char signal_stack[SIGNAL_STACK];

static void on_polite(int number)
{
    int kept = errno;
    char byte = 0;
    if (number == SIGTSTP) {
        terminal_suspending = 1;
    } else if (number != SIGWINCH && number != SIGCONT) {
        terminal_leaving = number;
    }
    ssize_t ignored = write(tty.wake[1], &byte, 1);
    (void)ignored;
    errno = kept;
}

// Last resort: gives the terminal back by prepared bytes, then lets the signal do what it did.
static void on_fatal(int number)
{
    ssize_t ignored = write(STDOUT_FILENO, tty.restore, tty.restore_length);
    (void)ignored;
    tcsetattr(STDIN_FILENO, TCSANOW, &tty.saved);
    for (int i = 0; i < FATAL; i++) {
        if (fatal_signals[i] == number) {
            sigaction(number, &fatal_before[i], NULL);
        }
    }
    raise(number);
}

void terminal_take_signals(void)
{
    stack_t stack = {.ss_sp = signal_stack, .ss_size = sizeof signal_stack};
    sigaltstack(&stack, NULL);

    for (int i = 0; i < POLITE; i++) {
        struct sigaction act = {.sa_handler = on_polite};
        sigaction(polite_signals[i], &act, &polite_before[i]);
        // a shell without jobs asks for ^Z to be ignored
        if (polite_signals[i] == SIGTSTP && polite_before[i].sa_handler == SIG_IGN) {
            sigaction(SIGTSTP, &polite_before[i], NULL);
        }
    }

    for (int i = 0; i < FATAL; i++) {
        // one that is ignored ends nothing and stays ignored
        struct sigaction act = {.sa_handler = on_fatal, .sa_flags = SA_ONSTACK};
        sigaction(fatal_signals[i], NULL, &fatal_before[i]);
        if (fatal_before[i].sa_handler != SIG_IGN) {
            sigaction(fatal_signals[i], &act, NULL);
        }
    }
}

void terminal_give_signals_back(void)
{
    for (int i = 0; i < POLITE; i++) {
        sigaction(polite_signals[i], &polite_before[i], NULL);
    }
    for (int i = 0; i < FATAL; i++) {
        sigaction(fatal_signals[i], &fatal_before[i], NULL);
    }
    stack_t none = {.ss_flags = SS_DISABLE};
    sigaltstack(&none, NULL);
}
