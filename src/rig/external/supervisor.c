#include "src/rig/external/supervisor.h"

#include <assert.h>
#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

enum {
    DEATH_PIPE = 3,    // the supervisor's end of it
    KILLED = 255,      // the supervisor's exit status where the program had to be killed
    LAST_WORDS_MS = 50 // for an ended program to become one that can be waited for
};

// --- the supervisor: between fork and _exit nothing but system calls
// -------------------------------

// Kills the children that the kernel lists; those of theirs are adopted and listed the next time.
static void kill_children(void)
{
    char text[4096];
    int list = open("/proc/thread-self/children", O_RDONLY | O_CLOEXEC);
    ssize_t length = list >= 0 ? read(list, text, sizeof text) : 0;
    pid_t child = 0;

    // each number ends with a space, the last one too
    for (ssize_t i = 0; i < length; i++) {
        if (isdigit((unsigned char)text[i])) {
            child = 10 * child + (text[i] - '0');
        } else {
            if (child > 0) {
                kill(child, SIGKILL);
            }
            child = 0;
        }
    }
    if (list >= 0) {
        close(list);
    }
}

// The exit status of a child as a shell would tell it.
static int told_status(int status)
{
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

// Kills all and waits until there is none.
static void kill_all(pid_t program)
{
    kill(-program, SIGKILL);
    for (;;) {
        kill_children();
        pid_t ended = waitpid(-1, NULL, 0);
        if (ended < 0 && errno != EINTR) {
            return;
        }
    }
}

static _Noreturn void run_program(const char *command)
{
    // as a program expects to find things
    setsid();
    for (int number = 1; number < NSIG; number++) {
        signal(number, SIG_DFL);
    }
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    execl("/bin/sh", "sh", "-c", command, (char *)NULL);
    _exit(127);
}

static _Noreturn void keep(const char *command)
{
    // what ends the lab or its terminal must not end the supervisor before its work is done
    sigset_t all;
    sigfillset(&all);
    sigprocmask(SIG_SETMASK, &all, NULL);
    setsid();
    prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0);
    pid_t program = fork();
    if (program == 0) {
        close(DEATH_PIPE);
        run_program(command);
    }

    // the program's descriptors are not the supervisor's, or their ends would never be seen
    for (int fd = 0; fd < DEATH_PIPE; fd++) {
        close(fd);
    }
    char nothing;
    while (read(DEATH_PIPE, &nothing, 1) < 0 && errno == EINTR) {
    }

    // how the program ended, if it did by itself
    int status = 0;
    pid_t ended = program > 0 ? waitpid(program, &status, WNOHANG) : -1;
    if (ended == 0) {
        poll(NULL, 0, LAST_WORDS_MS);
        ended = waitpid(program, &status, WNOHANG);
    }
    if (program > 0) {
        kill_all(program);
    }
    _exit(ended == program ? told_status(status) : KILLED);
}

// --- the lab's side ---------------------------------------------------------------------------

// Becomes the supervisor with the program's three streams and the death pipe as the first
// descriptors.
static _Noreturn void become_supervisor(const int ends[4], const char *command)
{
    // above all of 0 ... 3, so that none is lost while they are put in place
    int moved[4];
    for (int i = 0; i < 4; i++) {
        moved[i] = fcntl(ends[i], F_DUPFD, DEATH_PIPE + 1);
    }

    // no stream is in another's way any more
    for (int i = 0; i < 4; i++) {
        if (moved[i] < 0 || dup2(moved[i], i) < 0) {
            _exit(127);
        }
    }
    // other programs' death pipes above all
    closefrom(DEATH_PIPE + 1);
    keep(command);
}

// Closes what is open of the descriptors.
static void close_all(const int *fds, int count)
{
    for (int i = 0; i < count; i++) {
        if (fds[i] >= 0) {
            close(fds[i]);
        }
    }
}

int supervised_program_start(supervised_program *program, const char *command)
{
    assert(program != NULL && command != NULL);
    int input[2] = {-1, -1}, output[2] = {-1, -1}, errors[2] = {-1, -1}, death_pipe[2] = {-1, -1};
    bool open = socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, input) == 0 &&
                pipe2(output, O_CLOEXEC) == 0 && pipe2(errors, O_CLOEXEC) == 0 &&
                pipe2(death_pipe, O_CLOEXEC) == 0;
    int reason = open ? 0 : errno;

    // the supervisor gets one end of each
    pid_t supervisor = open ? fork() : -1;
    if (supervisor == 0) {
        const int ends[4] = {input[1], output[1], errors[1], death_pipe[0]};
        become_supervisor(ends, command);
    }
    if (open && supervisor < 0) {
        reason = errno;
    }
    const int theirs[4] = {input[1], output[1], errors[1], death_pipe[0]};
    const int ours[4] = {input[0], output[0], errors[0], death_pipe[1]};
    close_all(theirs, 4);
    if (supervisor < 0) {
        close_all(ours, 4);
        *program = (supervised_program){0};
        return reason;
    }

    // and nothing of ours blocks
    for (int i = 0; i < 3; i++) {
        fcntl(ours[i], F_SETFL, O_NONBLOCK);
    }
    *program = (supervised_program){.supervisor = supervisor,
                                    .input = ours[0],
                                    .output = ours[1],
                                    .errors = ours[2],
                                    .death_pipe = ours[3]};
    return 0;
}

int supervised_program_end(supervised_program *program)
{
    assert(program != NULL);
    int status = 0;
    if (program->supervisor == 0) {
        return -1;
    }
    const int ours[4] = {program->input, program->output, program->errors, program->death_pipe};
    close_all(ours, 4);

    pid_t ended;
    do {
        ended = waitpid(program->supervisor, &status, 0);
    } while (ended < 0 && errno == EINTR);
    *program = (supervised_program){0};
    const bool told = ended > 0 && WIFEXITED(status) && WEXITSTATUS(status) != KILLED;
    return told ? WEXITSTATUS(status) : -1;
}
