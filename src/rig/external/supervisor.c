#include "src/rig/external/supervisor.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdbool.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

enum {
    ENDS = 3,          // of the streams, in the order of supervised_program
    KILLED = 255,      // the supervisor's exit status where the program had to be killed
    LAST_WORDS_MS = 50 // for an ended program to become one that can be waited for
};

// --- the supervisor: between fork and _exit nothing but system calls -------------------

// Becomes the program, in a process group of its own and with the signals that a program
// expects to find.
static _Noreturn void run_program(const char *command)
{
    setpgid(0, 0);
    for (int number = 1; number < NSIG; number++) {
        signal(number, SIG_DFL);
    }
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    execl("/bin/sh", "sh", "-c", command, (char *)NULL);
    _exit(127);
}

// Makes the program's ends the first descriptors, by way of higher ones so that none is
// lost, and closes all others: ends of other programs are among them.
static void keep_only_ends(const int theirs[ENDS])
{
    int moved[ENDS];
    for (int i = 0; i < ENDS; i++) {
        moved[i] = fcntl(theirs[i], F_DUPFD, ENDS);
    }
    for (int i = 0; i < ENDS; i++) {
        if (dup2(moved[i], i) < 0) {
            _exit(127);
        }
    }
    closefrom(ENDS);
}

static _Noreturn void supervise(const int theirs[ENDS], const char *command)
{
    keep_only_ends(theirs);

    // what ends the lab or its terminal must not end the supervisor before its work is
    // done; the program's orphans become its children, so that it can wait for them
    sigset_t all;
    sigfillset(&all);
    sigprocmask(SIG_SETMASK, &all, NULL);
    setsid();
    prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0);
    const pid_t program = fork();
    if (program < 0) {
        _exit(KILLED);
    }
    if (program == 0) {
        run_program(command);
    }
    setpgid(program, program); // whichever of the two comes first

    // what the program writes is not the supervisor's, or its end would never be seen; of
    // the input it waits for the lab's end
    close(STDOUT_FILENO);
    close(STDERR_FILENO);
    while (poll(&(struct pollfd){.fd = STDIN_FILENO, .events = POLLRDHUP}, 1, -1) < 0) {
    }

    // how the program ended, if it did by itself
    int how = 0;
    pid_t ended = waitpid(program, &how, WNOHANG);
    if (ended == 0) {
        poll(NULL, 0, LAST_WORDS_MS);
        ended = waitpid(program, &how, WNOHANG);
    }

    // and all of its group with it
    kill(-program, SIGKILL);
    while (waitpid(-program, NULL, 0) > 0) {
    }
    if (ended != program) {
        _exit(KILLED);
    }
    _exit(WIFSIGNALED(how) ? 128 + WTERMSIG(how) : WEXITSTATUS(how));
}

// --- the lab's side --------------------------------------------------------------------

static void close_ends(int input, int output, int errors)
{
    const int ends[ENDS] = {input, output, errors};
    for (int i = 0; i < ENDS; i++) {
        if (ends[i] >= 0) {
            close(ends[i]);
        }
    }
}

int supervised_program_start(supervised_program *program, const char *command)
{
    *program = (supervised_program){.supervisor = 0};

    // a socket is written to without a signal; errors go to a file in memory, which never
    // blocks
    int input[2] = {-1, -1}, output[2] = {-1, -1}, errors = -1;
    const bool made = socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, input) == 0 &&
                      pipe2(output, O_CLOEXEC) == 0 &&
                      (errors = memfd_create("errors", MFD_CLOEXEC)) >= 0;

    // the supervisor gets one end of each
    const pid_t supervisor = made ? fork() : -1;
    const int reason = errno;
    if (supervisor == 0) {
        supervise((const int[]){input[1], output[1], errors}, command);
    }
    close_ends(input[1], output[1], -1);
    if (supervisor < 0) {
        close_ends(input[0], output[0], errors);
        return reason;
    }

    // a reader does not wait, and what is written after the file was cut begins it again
    fcntl(output[0], F_SETFL, O_NONBLOCK);
    fcntl(errors, F_SETFL, O_APPEND);
    *program = (supervised_program){supervisor, input[0], output[0], errors};
    return 0;
}

int supervised_program_end(supervised_program *program)
{
    if (program->supervisor == 0) {
        return -1;
    }
    close_ends(program->input, program->output, program->errors);

    int status = 0;
    pid_t ended;
    do {
        ended = waitpid(program->supervisor, &status, 0);
    } while (ended < 0 && errno == EINTR);
    *program = (supervised_program){0};
    if (ended < 0 || !WIFEXITED(status) || WEXITSTATUS(status) == KILLED) {
        return -1;
    }
    return WEXITSTATUS(status);
}
