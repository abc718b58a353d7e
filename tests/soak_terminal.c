// The terminal lab in a pseudo-terminal under random keys, mouse reports, commands, files
// and sizes, on terminals with sixels, with kitty's protocol, without pictures and with
// nonsense for answers. It must answer all along; every other session is killed halfway
// and begun again from its recovery file. At the end what it saves must reproduce its
// run, and the terminal must be as it was. One session after the other until the time is
// over, each with a seed of its own.
//
// soak_terminal PROGRAM SECONDS [FIRST-SEED]
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "src/base/clock.h"
#include "src/base/random.h"
#include "tests/terminal_tracker.h"

#define SESSION_TIME 20.0 // [s]
// These only catch a lab that hangs: hundreds of times what anything takes on an idle
// machine.
#define ANSWER_TIME   120.0 // longest until an answer [s]
#define COMPUTE_TIME  600.0 // longest until the last run is complete [s]
#define ESCAPE_PAUSE  0.08  // after an escape that stands alone [s]
#define LAST_DURATION "0.7"

#define SLOW_ANSWER   1.0 // from which on an answer is reported with its input [s]

enum { MOST_PROBES = 100000 };

// What a session's terminal says of pictures.
typedef enum terminal_kind { DUMB, SIXEL, KITTY, LIAR, TERMINAL_KINDS } terminal_kind;

typedef struct soak {
    const char *program;
    uint64_t seed;
    random_generator random;
    int master, slave;
    int width, height; // of the terminal
    pid_t child;
    terminal_kind kind;
    tracker seen;
    struct termios before;
    char folder[64];
    double *answers; // times that probes took [s]
    size_t answer_count, keys;
    long drawn;          // pictures
    double longest;      // of the lab's processor that an answer took [s]
    char last_keys[400]; // what was sent lately
    size_t sent;
} soak;

static int chance(soak *s, int bound)
{
    return (int)random_below(&s->random, (uint64_t)bound);
}

// --- the terminal's side ---------------------------------------------------------------

// What was sent lately, on one line.
static void tell_keys(const soak *s)
{
    for (size_t i = s->sent > sizeof s->last_keys ? s->sent - sizeof s->last_keys : 0;
         i < s->sent; i++) {
        const unsigned char c = (unsigned char)s->last_keys[i % sizeof s->last_keys];
        fprintf(stderr, c >= ' ' && c < 127 ? "%c" : "\\x%02x", c);
    }
    fputc('\n', stderr);
}

// Ends the test with what is wrong, how to get there again and what was seen last.
static void __attribute__((format(printf, 2, 3), noreturn))
fail(soak *s, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    fprintf(stderr, "\nFAILED with seed %llu: ", (unsigned long long)s->seed);
    vfprintf(stderr, format, list);
    va_end(list);
    fprintf(stderr, "\nsent last: ");
    tell_keys(s);
    fprintf(stderr, "seen last: ");
    for (size_t i = s->seen.bytes > TAIL ? s->seen.bytes - TAIL : 0; i < s->seen.bytes;
         i++) {
        char c = s->seen.tail[i % TAIL];
        fputc(c == '\033' ? '~' : c, stderr);
    }
    fprintf(stderr, "\nfiles in %s\n", s->folder);
    if (s->child > 0) {
        kill(s->child, SIGABRT);
    }
    exit(1);
}

// Answers what the program asked, as this session's terminal does.
static void answer(soak *s)
{
    static const char *const kitty[] = {NULL, NULL, "\033_Gi=31;OK\033\\",
                                        "\033_Gi=31;OKOK;OK"};
    static const char *const cell[] = {NULL, "\033[6;16;8t", "\033[6;20;10t",
                                       "\033[6;0;999999t"};
    static const char *const attributes[] = {
        NULL, "\033[?62;4;22c", "\033[?62c",
        "\033]11;rgb:zz\a\033[?2;0;0;0S\033[?4;4;4;4c"};
    tracker *t = &s->seen;
    const char *texts[] = {t->asks_kitty ? kitty[s->kind] : NULL,
                           t->asks_cell ? cell[s->kind] : NULL,
                           t->asks_attributes ? attributes[s->kind] : NULL};
    t->asks_kitty = t->asks_cell = t->asks_attributes = false;
    for (int i = 0; i < 3; i++) {
        // what does not fit is lost, as on a bad line
        if (texts[i] != NULL && write(s->master, texts[i], strlen(texts[i])) < 0) {
            return;
        }
    }
}

// Takes what the program shows for some time, 0: what is there.
static void watch(soak *s, double seconds)
{
    double until = clock_seconds(CLOCK_MONOTONIC) + seconds;
    do {
        struct pollfd p = {s->master, POLLIN, 0};
        double left = until - clock_seconds(CLOCK_MONOTONIC);
        char bytes[4096];
        if (poll(&p, 1, left > 0 ? (int)(1e3 * left + 0.999) : 0) <= 0) {
            continue;
        }
        ssize_t count = read(s->master, bytes, sizeof bytes);
        for (ssize_t i = 0; i < count; i++) {
            track(&s->seen, bytes[i]);
        }
        answer(s);
    } while (clock_seconds(CLOCK_MONOTONIC) < until);
}

// Takes what the program shows until something is so, or fails with a sentence after a
// time [s].
#define AWAIT(s, condition, seconds, ...)                                                \
    for (double until = clock_seconds(CLOCK_MONOTONIC) + (seconds); !(condition);) {     \
        watch(s, 0.01);                                                                  \
        if (clock_seconds(CLOCK_MONOTONIC) > until) {                                    \
            fail(s, __VA_ARGS__);                                                        \
        }                                                                                \
    }

static void send_bytes(soak *s, const char *bytes, size_t count)
{
    double until = clock_seconds(CLOCK_MONOTONIC) + ANSWER_TIME;
    for (size_t i = 0; i < count; i++) {
        s->last_keys[s->sent++ % sizeof s->last_keys] = bytes[i];
    }
    while (count > 0) {
        ssize_t done = write(s->master, bytes, count);
        if (done > 0) {
            bytes += done;
            count -= (size_t)done;
        } else if (clock_seconds(CLOCK_MONOTONIC) > until) {
            fail(s, "takes no input for %g s", ANSWER_TIME);
        }
        watch(s, done > 0 ? 0 : 0.01);
    }
    s->keys++;
}

static void send_text(soak *s, const char *text)
{
    send_bytes(s, text, strlen(text));
}

static void resize(soak *s, int width, int height)
{
    struct winsize size = {.ws_col = (unsigned short)width,
                           .ws_row = (unsigned short)height};
    ioctl(s->master, TIOCSWINSZ, &size);
    s->width = width;
    s->height = height;
}

static bool has_ended(soak *s, int *status)
{
    pid_t ended = s->child > 0 ? waitpid(s->child, status, WNOHANG) : 0;
    s->child = ended > 0 ? 0 : s->child;
    return ended > 0;
}

// Processor time of the lab's first thread, which answers [s]; 0 where the system does
// not tell.
static double processor_time(const soak *s)
{
    char path[64];
    unsigned long long nanoseconds = 0;
    snprintf(path, sizeof path, "/proc/%d/task/%d/schedstat", (int)s->child,
             (int)s->child);
    FILE *stream = fopen(path, "r");
    if (stream != NULL) {
        if (fscanf(stream, "%llu", &nanoseconds) != 1) {
            nanoseconds = 0;
        }
        fclose(stream);
    }
    return 1e-9 * (double)nanoseconds;
}

// After a change of size the lab clears the screen in any state: measures how long that
// takes.
static void probe(soak *s)
{
    int status;
    double start = clock_seconds(CLOCK_MONOTONIC), spent = processor_time(s);
    long cleared = s->seen.cleared;
    // the same size again would be no news
    resize(s, 60 + chance(s, 100), s->height == 20 ? 21 : 20);
    while (s->seen.cleared == cleared) {
        watch(s, 0.002);
        if (has_ended(s, &status)) {
            fail(s, "ended by itself with status %d", status);
        }
        if (clock_seconds(CLOCK_MONOTONIC) - start > ANSWER_TIME) {
            fail(s, "no answer within %g s", ANSWER_TIME);
        }
    }
    const double took = clock_seconds(CLOCK_MONOTONIC) - start;
    spent = processor_time(s) - spent;
    s->longest = spent > s->longest ? spent : s->longest;
    if (s->answer_count < MOST_PROBES) {
        s->answers[s->answer_count++] = took;
    }
    if (took > SLOW_ANSWER) {
        fprintf(stderr, "%.2f s, %.3f of its processor, with seed %llu after ", took,
                spent, (unsigned long long)s->seed);
        tell_keys(s);
    }
}

// --- the user's side -------------------------------------------------------------------

// Sends a key at random.
static void press_something(soak *s)
{
    // all keys but those that end or suspend the lab, or hold the terminal's output
    static const char *const keys[] = {" ",
                                       " ",
                                       "h",
                                       "l",
                                       "n",
                                       "N",
                                       "g",
                                       "G",
                                       "+",
                                       "-",
                                       "\177",
                                       "r",
                                       "j",
                                       "k",
                                       "\r",
                                       ">",
                                       "<",
                                       "p",
                                       "P",
                                       "t",
                                       "x",
                                       "b",
                                       "B",
                                       "c",
                                       "u",
                                       "U",
                                       "\022",
                                       "m",
                                       "\t",
                                       "z",
                                       "Z",
                                       "0",
                                       "1",
                                       "5",
                                       "9",
                                       "o",
                                       "]",
                                       "[",
                                       "s",
                                       "\014",
                                       "?",
                                       "/",
                                       ":",
                                       "\033[A",
                                       "\033[B",
                                       "\033[C",
                                       "\033[D",
                                       "\033[H",
                                       "\033[F",
                                       "\033OA",
                                       "\033OP",
                                       "\033[5~",
                                       "\033[6~",
                                       "\033[3~",
                                       "\025",
                                       "\b",
                                       "\033[1~",
                                       "\033[Z",
                                       "=",
                                       "2",
                                       "3",
                                       "8",
                                       "\033[M !!",
                                       "R",
                                       "D",
                                       "T",
                                       "X",
                                       "A",
                                       "y",
                                       "\020",
                                       "L",
                                       "F",
                                       "C",
                                       "H",
                                       "e",
                                       "w",
                                       "\033[200~qy\rqq\033[201~"};
    send_text(s, keys[chance(s, sizeof keys / sizeof keys[0])]);
}

// Enters a command at random, with a random number in it: mostly by Enter, sometimes only
// completed by Tab.
static void give_command(soak *s)
{
    static const char *const commands[] = {
        "set motor.voltage %d.5", "set run.duration %d", "set arm.links %d",
        "open corrected/twenty-links", "open compare/hybrid", "open thesis/fig-3-4",
        "open corrected/first-impact", "open compare/touch", "seek 0.%d", "seek end",
        "speed %d", "push 0.0%d", "push -0.%d", "set method.step 0.000%d",
        "set arm.k2 %d", "set wall.angle 0.0%d", "zoom in", "zoom out", "trace force gap",
        "panes 1%d", "glyphs ascii", "glyphs braille", "glyphs blocks", "theme mono",
        "theme light", "mouse off", "mouse on", "save a.csv", "save a.yaml", "save a.txt",
        "stop", "undo", "redo", "branch", "forget", "compare", "remember", "wait 0.%d",
        "set method.name newmark", "extend %d", "restart", "model", "pin run %d",
        "take %d", "hide %d", "baseline %d", "unpin %d", "rename %d other",
        "difference 0.0%d", "difference off", "sweep motor.voltage=1:%d:4",
        "sweep arm.k2=4,5,6", "sweep off", "metric", "phase force gap", "spectrum force",
        "statistics", "lesson hybrid-law", "lesson step-size", "answer %d", "continue",
        "lesson off", "palette volt", "pixels off", "pixels auto", "bending %d",
        "slow %d", "slow off", "trace force - force_reading, gap*2", "axis fixed %d",
        "axis auto %d", "note %d says", "note @0.%d here", "notes", "save! a.csv",
        "data a.csv", "data a.csv@0.%d", "data a.csv play", "reload", "data off",
        "help axis", "residual force gap", "identify k2",
        "sweep arm.k2=4:8:%d motor.voltage=1:3:4", "solve voltage peak_force_N<2",
        "copy run", "copy screen", "why", "poles", "rate %d", "rate off", "explain",
        "session save a.session", "session open a.session", "session save b%d.session",
        "session open b%d.session", "limit force %d", "signal all", "data odd.csv",
        "data odd.csv@-0.%d", "data odd.csv play", "data odd.yaml", "open odd.yaml",
        "session open odd.session", "set control.playback_file odd.csv",
        // none of these can be done
        "frobnicate %d", "set arm.k2 NaN", "set arm.links -%d", "open nothing/such",
        "set", "set motor.voltage", "seek", "save", "save a.doc", "save /proc/none/a.csv",
        "speed 0", "zoom sideways", "take 99", "sweep motor.voltage=1:2", "phase force",
        "answer x", "session open broken.session", "session open a.yaml",
        "trace force - ", "data a.yaml", "mark 1e9", "mark nan", "trace 4294967297",
        "note @1e300 far", "seek -1e300", "zoom -1e300 1e300", "pan 1e300", "step 1e300",
        "band gap 1e300", "change 9999999999 1", "identify none", "copy none", "note",
        "band gap 0", "rate 0.1", "set run.duration 1e9", "set method.step 1e-9",
        "trace nonsense", "glyphs %d", "push 1e999",
        "\xc3\xa4\xe2\x82\xac\xf0\x9f\x98\x80", "\xff\xfe broken"};
    char line[200];
    const char *form = commands[chance(s, sizeof commands / sizeof commands[0])];
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
    snprintf(line, sizeof line, form, 1 + chance(s, chance(s, 4) ? 6 : 25));
#pragma GCC diagnostic pop
    send_text(s, ":");
    send_text(s, line);
    send_text(s, chance(s, 10) ? "\r" : "\t");
}

static void use_mouse(soak *s)
{
    static const int buttons[] = {0, 0, 16, 32, 32, 64, 65, 1, 2, 48, 67, 128};
    char report[64];
    int x = chance(s, 8) ? 1 + chance(s, 120) : chance(s, 100000);
    int y = chance(s, 8) ? 1 + chance(s, 40) : chance(s, 100000);
    snprintf(report, sizeof report, "\033[<%d;%d;%d%c", buttons[chance(s, 12)], x, y,
             chance(s, 3) ? 'M' : 'm');
    send_text(s, report);
}

// Sequences in pieces, halves of characters, unknown keys.
static void send_oddities(soak *s)
{
    static const char *const oddities[] = {"\033[1;5C",
                                           "\033[200~pasted\033[201~",
                                           "\xc3\xa4",
                                           "\xe2\x82\xac",
                                           "\xf0\x9f\x98\x80",
                                           "\033[<0;12",
                                           "\033O",
                                           "\033[",
                                           "\033[?1;2c",
                                           "\033]0;t\007",
                                           "\033[99;99;99~",
                                           "\xc3",
                                           "\x80\x81"};
    const char *odd = oddities[chance(s, sizeof oddities / sizeof oddities[0])];
    for (const char *c = odd; *c; c++) {
        send_bytes(s, c, 1);
        watch(s, chance(s, 4) ? 0 : 0.001 * chance(s, 40));
    }
}

// Writes what a session saved once more as odd.csv, odd.yaml or odd.session, cut off or
// with bytes changed; before anything is saved the file is empty or random.
static void leave_odd_file(soak *s)
{
    static const char *const kinds[][2] = {{"a.csv", "odd.csv"},
                                           {"a.yaml", "odd.yaml"},
                                           {"a.session", "odd.session"}};
    static char bytes[1 << 20];
    char path[128];
    const int kind = chance(s, 3);

    // what is there
    snprintf(path, sizeof path, "%s/%s", s->folder, kinds[kind][0]);
    FILE *stream = fopen(path, "rb");
    size_t length = (size_t)chance(s, 2) * 4000;
    if (stream != NULL) {
        length = fread(bytes, 1, sizeof bytes, stream);
        fclose(stream);
    }

    // with some of its bytes changed, and often no end
    const int changes = stream == NULL ? (int)length : chance(s, 6);
    for (int i = 0; i < changes && length > 0; i++) {
        bytes[chance(s, (int)length)] = (char)chance(s, 256);
    }
    if (length > 0 && chance(s, 2) == 0) {
        length = (size_t)chance(s, (int)length);
    }
    snprintf(path, sizeof path, "%s/%s", s->folder, kinds[kind][1]);
    stream = fopen(path, "wb");
    if (stream != NULL) {
        fwrite(bytes, 1, length, stream);
        fclose(stream);
    }
}

static void do_something(soak *s)
{
    int what = chance(s, 100);
    if (what < 54) {
        press_something(s);
    } else if (what < 55) {
        leave_odd_file(s);
    } else if (what < 72) {
        give_command(s);
    } else if (what < 84) {
        use_mouse(s);
    } else if (what < 90) {
        send_oddities(s);
    } else if (what < 94) {
        resize(s, 1 + chance(s, chance(s, 3) ? 160 : 300),
               1 + chance(s, chance(s, 3) ? 50 : 100));
    } else if (what < 97) {
        send_text(s, "\033");
        watch(s, ESCAPE_PAUSE);
    } else {
        watch(s, 0.001 * chance(s, 200));
    }
    watch(s, chance(s, 5) ? 0 : 0.001 * chance(s, 20));
    if (chance(s, 12) == 0) {
        probe(s);
    }
}

// --- a session -------------------------------------------------------------------------

// Opens a pseudo-terminal and an empty folder. Without one the test is skipped (status
// 77).
static void prepare(soak *s)
{
    // the terminal
    s->master = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (s->master < 0 || grantpt(s->master) != 0 || unlockpt(s->master) != 0) {
        perror("no pseudo-terminal");
        exit(77);
    }
    s->slave = open(ptsname(s->master), O_RDWR | O_NOCTTY | O_CLOEXEC);
    tcgetattr(s->slave, &s->before);
    resize(s, 120, 40);

    // the folder
    snprintf(s->folder, sizeof s->folder, "/tmp/soak-XXXXXX");
    if (s->slave < 0 || mkdtemp(s->folder) == NULL) {
        perror("no terminal or no folder");
        exit(77);
    }

    // a session that cannot be opened
    char path[128];
    snprintf(path, sizeof path, "%s/broken.session", s->folder);
    FILE *broken = fopen(path, "w");
    if (broken != NULL) {
        fputs("impactlab session 1\nscenario: x\n| motor: {voltage: 1 V}\nstart: 0 "
              "nothing\n",
              broken);
        fclose(broken);
    }

    // what it shows is read without waiting
    fcntl(s->master, F_SETFL, fcntl(s->master, F_GETFL) | O_NONBLOCK);
}

// Starts the lab and waits until it has the terminal: keys that come before would be
// echoed.
static void start(soak *s)
{
    // the lab, whose standard streams and controlling terminal are the slave
    s->child = fork();
    if (s->child == 0) {
        setsid();
        ioctl(s->slave, TIOCSCTTY, 0);
        for (int i = 0; i < 3; i++) {
            dup2(s->slave, i);
        }
        setenv("TERM", "xterm-256color", 1);
        setenv("LC_ALL", "C.UTF-8", 1);
        setenv("XDG_CONFIG_HOME", s->folder, 1);
        setenv("XDG_STATE_HOME", s->folder, 1);
        unsetenv("LINES");
        unsetenv("COLUMNS");
        if (chdir(s->folder) == 0) {
            execl(s->program, s->program, "lab", (char *)NULL);
        }
        _exit(127);
    }
    AWAIT(s, s->seen.mode[1049], ANSWER_TIME, "does not start within %g s", ANSWER_TIME);
}

// Kills the lab as a crash would and starts it again on the same terminal, where its
// recovery file is offered; `y` and what comes next answer that.
static void kill_and_start(soak *s)
{
    int status;
    kill(s->child, SIGKILL);
    AWAIT(s, has_ended(s, &status), ANSWER_TIME, "cannot be killed");
    if (!WIFSIGNALED(status) || WTERMSIG(status) != SIGKILL) {
        fail(s, "ended by itself with status %d", status);
    }
    watch(s, 0);
    tcsetattr(s->slave, TCSANOW, &s->before);
    s->seen = (tracker){0};
    start(s);
    send_text(s, chance(s, 4) ? "y" : "n");
}

static void act_for(soak *s, double seconds)
{
    for (double until = clock_seconds(CLOCK_MONOTONIC) + seconds;
         clock_seconds(CLOCK_MONOTONIC) < until;) {
        do_something(s);
    }
}

// Back to the panels from wherever the keys led, with a short run.
static void come_back(soak *s)
{
    resize(s, 120, 40);
    send_text(s, "\030"); // ends a sequence that stopped halfway
    for (int i = 0; i < 5; i++) {
        watch(s, ESCAPE_PAUSE);
        send_text(s, "\033");
    }
    watch(s, ESCAPE_PAUSE);
    send_text(s, ":set run.duration " LAST_DURATION "\r");
}

static bool file_exists(const soak *s, const char *name)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", s->folder, name);
    return access(path, F_OK) == 0;
}

static void save(soak *s, const char *name)
{
    char line[128];
    int tries = 0;
    double until = clock_seconds(CLOCK_MONOTONIC) + COMPUTE_TIME;
    snprintf(line, sizeof line, ":save %s\r", name);
    while (!file_exists(s, name)) {
        int status;
        // a busy machine may take an escape and the key after it for one sequence
        if (++tries % 20 == 0) {
            come_back(s);
        }
        send_text(s, line);
        watch(s, 0.2);
        if (has_ended(s, &status)) {
            fail(s, "ended by itself with status %d", status);
        }
        if (clock_seconds(CLOCK_MONOTONIC) > until) {
            fail(s, "%s is not saved", name);
        }
    }
}

// The saved scenario gives the rows that were saved.
static void check_record(soak *s)
{
    char line[600];
    snprintf(line, sizeof line,
             "cd %s && { '%s' run last.yaml --csv again.csv --quiet >run.out "
             "2>&1; cmp last.csv again.csv; }",
             s->folder, s->program);
    if (system(line) != 0) {
        fail(s, "the saved scenario gives other rows");
    }
}

static void check_terminal(soak *s)
{
    static const int off[] = {1, 1000, 1002, 1003, 1006, 1015, 1047, 1049, 2004, 2026};
    struct termios after;
    tcgetattr(s->slave, &after);
    bool same =
        after.c_iflag == s->before.c_iflag && after.c_oflag == s->before.c_oflag &&
        after.c_cflag == s->before.c_cflag && after.c_lflag == s->before.c_lflag &&
        memcmp(after.c_cc, s->before.c_cc, sizeof after.c_cc) == 0;
    if (!same) {
        fail(s, "the terminal's settings are not those from before");
    }
    for (size_t i = 0; i < sizeof off / sizeof off[0]; i++) {
        if (s->seen.mode[off[i]]) {
            fail(s, "the terminal is left with private mode %d", off[i]);
        }
    }
    if (s->seen.state == STRING || s->seen.state == STRING_ENDS) {
        fail(s, "a string is left open");
    }
    if (s->seen.pictures > 0 && s->kind == DUMB) {
        fail(s, "pictures for a terminal that has not asked for any");
    }
    if (!s->seen.mode[25]) {
        fail(s, "the cursor is left hidden");
    }
}

// Takes all that the program has written, up to a mark of ours behind it.
static void drain(soak *s)
{
    static const char mark[] = "\033[?2999h";
    if (write(s->slave, mark, sizeof mark - 1) < 0) {
        fail(s, "the terminal takes nothing any more");
    }
    AWAIT(s, s->seen.mode[2999], ANSWER_TIME, "the terminal keeps back what was written");
}

static void leave(soak *s)
{
    int status = 0;
    send_text(s, ":quit!\r");
    AWAIT(s, has_ended(s, &status), ANSWER_TIME, "does not end within %g s", ANSWER_TIME);
    drain(s);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        fail(s, "ends with status %d", status);
    }
}

static void finish(soak *s)
{
    char line[128];
    close(s->master);
    close(s->slave);
    snprintf(line, sizeof line, "rm -rf '%s'", s->folder);
    if (system(line) != 0) {
        fprintf(stderr, "%s is left over\n", s->folder);
    }
}

static void run_session(soak *s, uint64_t seed, double seconds)
{
    s->seed = seed;
    s->kind = (terminal_kind)(seed % TERMINAL_KINDS);
    s->seen = (tracker){0};
    s->sent = 0;
    random_seed(&s->random, seed);
    prepare(s);
    start(s);
    act_for(s, 0.5 * seconds);
    if (chance(s, 2) == 0) {
        kill_and_start(s);
    }
    act_for(s, 0.5 * seconds);
    come_back(s);
    probe(s);
    save(s, "last.csv");
    save(s, "last.yaml");
    leave(s);
    s->drawn += s->seen.pictures;
    check_terminal(s);
    check_record(s);
    finish(s);
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int main(int count, char **arguments)
{
    static double answers[MOST_PROBES];
    static soak s;
    if (count < 3) {
        fprintf(stderr, "soak_terminal PROGRAM SECONDS [FIRST-SEED]\n");
        return 2;
    }
    double seconds = strtod(arguments[2], NULL),
           until = clock_seconds(CLOCK_MONOTONIC) + seconds;
    uint64_t seed = count > 3 ? strtoull(arguments[3], NULL, 10) : 1, first = seed;
    s.program = realpath(arguments[1], NULL);
    s.answers = answers;
    do {
        double left = until - clock_seconds(CLOCK_MONOTONIC);
        run_session(&s, seed++, left < SESSION_TIME ? left : SESSION_TIME);
    } while (clock_seconds(CLOCK_MONOTONIC) < until - 1);
    qsort(answers, s.answer_count, sizeof answers[0], by_size);
    printf("%ld pictures, at most %.3f s of the processor for an answer, ", s.drawn,
           s.longest);
    printf("seeds %llu to %llu, %zu keys, %zu answers: median %.1f ms, 99 %% "
           "within %.1f ms, all within %.1f ms\n",
           (unsigned long long)first, (unsigned long long)seed - 1, s.keys,
           s.answer_count, 1e3 * answers[s.answer_count / 2],
           1e3 * answers[s.answer_count * 99 / 100], 1e3 * answers[s.answer_count - 1]);
    return 0;
}
