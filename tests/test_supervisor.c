// Programs under a supervisor: their exit is reported, and nothing of them is left.
#include "src/rig/external/supervisor.h"

#include <dirent.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>

#include "tests/check.h"

// How many descriptors this process has open.
static int open_descriptors(void)
{
    int count = -3; // the folder itself, "." and ".."
    DIR *folder = opendir("/proc/self/fd");
    while (readdir(folder) != NULL) {
        count++;
    }
    closedir(folder);
    return count;
}

// What the program writes until the end of its output, or of the first line.
static void read_line(const supervised_program *p, char *text, size_t size)
{
    size_t length = 0;
    struct pollfd watched = {.fd = p->output, .events = POLLIN};
    while (length + 1 < size && poll(&watched, 1, 20000) == 1 &&
           read(p->output, text + length, 1) == 1 && text[length] != '\n') {
        length++;
    }
    text[length] = '\0';
}

// Starts a command, waits for the end of its output and returns what
// supervised_program_end says.
static int ended(const char *command)
{
    supervised_program p;
    char line[64];
    assert_int_equal(supervised_program_start(&p, command), 0);
    read_line(&p, line, sizeof line);
    return supervised_program_end(&p);
}

TEST(the_status_of_a_program_that_ended_is_told)
{
    const int before = open_descriptors();
    assert_int_equal(ended("exit 0"), 0);
    assert_int_equal(ended("exit 7"), 7);
    assert_int_equal(ended("no-such-program-here"), 127);
    assert_int_equal(ended("kill -TERM $$"), 128 + SIGTERM);
    assert_int_equal(ended("sleep 0.4; exit 5"), 5); // it may take its time
    assert_int_equal(open_descriptors(), before);
}

TEST(a_program_hears_and_answers)
{
    supervised_program p;
    char line[64];
    assert_int_equal(supervised_program_start(&p, "read x; echo \"heard $x\"; exit 3"),
                     0);
    assert_int_equal(write(p.input, "this\n", 5), 5);
    read_line(&p, line, sizeof line);
    assert_string_equal(line, "heard this");
    read_line(&p, line, sizeof line);
    assert_int_equal(supervised_program_end(&p), 3);
}

// Signals that the lab ignores or holds back are a program's as usual.
TEST(a_program_takes_every_signal)
{
    sigset_t held, before;
    sigfillset(&held);
    sigprocmask(SIG_SETMASK, &held, &before);
    for (EACH_OF(int, c, SIGHUP, SIGPIPE, SIGUSR1, SIGTERM, 64)) {
        void (*was)(int) = signal(*c, SIG_IGN);
        const int status = ended(formatted("kill -%d $$; exit 1", *c));
        signal(*c, was);
        assert_int_equal(status, 128 + *c);
    }
    sigprocmask(SIG_SETMASK, &before, NULL);
}

// Its streams may have any numbers, those of the lab's own streams too.
TEST(streams_may_be_closed_in_the_lab)
{
    supervised_program p;
    char line[64];
    const int before = open_descriptors(), kept = dup(STDIN_FILENO);
    close(STDIN_FILENO);
    assert_int_equal(supervised_program_start(&p, "read x; echo \"heard $x\"; exit 4"),
                     0);
    const int input = p.input;
    const ssize_t written = write(p.input, "this\n", 5);
    read_line(&p, line, sizeof line);
    const int status = supervised_program_end(&p), left = open_descriptors();
    dup2(kept, STDIN_FILENO);
    close(kept);
    assert_int_equal(input, STDIN_FILENO);
    assert_int_equal(written, 5);
    assert_string_equal(line, "heard this");
    assert_int_equal(status, 4);
    assert_int_equal(left, before);
    assert_int_equal(open_descriptors(), before);
}

// Once ended there is nothing to end.
TEST(an_end_is_told_once)
{
    supervised_program p;
    assert_int_equal(supervised_program_start(&p, "exit 0"), 0);
    supervised_program_end(&p);
    assert_int_equal(p.supervisor, 0);
    assert_int_equal(supervised_program_end(&p), -1);
}

// A program that continues, and the processes it has left, are gone when the supervisor
// has ended.
TEST(nothing_is_left_of_what_goes_on)
{
    supervised_program p;
    char line[64];
    assert_int_equal(supervised_program_start(
                         &p, "(sleep 1000 & echo $!) ; trap '' TERM HUP; sleep 1000"),
                     0);
    read_line(&p, line, sizeof line);
    const pid_t orphan = atoi(line);
    assert_true(orphan > 1);
    assert_int_equal(kill(orphan, 0), 0);
    assert_int_equal(supervised_program_end(&p), -1);
    assert_int_equal(kill(orphan, 0), -1);
    assert_int_equal(errno, ESRCH);
}

TEST(where_none_can_be_started_nothing_stays_open)
{
    const int before = open_descriptors();
    struct rlimit was, few;
    getrlimit(RLIMIT_NOFILE, &was);
    few = was;
    for (int spare = 0; spare < 5; spare++) {
        // two are wanted for input and output each, one for the errors
        supervised_program p;
        few.rlim_cur = (rlim_t)(before + spare);
        setrlimit(RLIMIT_NOFILE, &few);
        const int reason = supervised_program_start(&p, "exit 0");
        setrlimit(RLIMIT_NOFILE, &was);
        assert_int_equal(reason, EMFILE);
        assert_int_equal(p.supervisor, 0);
        assert_int_equal(supervised_program_end(&p), -1);
        assert_int_equal(open_descriptors(), before);
    }
}

int main(void)
{
    alarm(120); // where somebody waits for what never comes, this fails

    // descriptors are counted: only those of the streams are open, without gaps
    signal(SIGPIPE, SIG_IGN);
    for (int fd = 3; fd < 1024; fd++) {
        close(fd);
    }
    return run_cases(NULL, NULL);
}
