// Every command of the command table with its requests for memory refused one after the
// other: if it then says that all went well, its standard output and its files are those
// of an undisturbed call; else it says a sentence, and it neither crashes nor leaves a
// temporary. The calls follow from the table: a command plainly, with each result on the
// standard output, and with all results in files; a new command joins by itself, and
// fails here until `helped` knows what it needs.
//
//   test_command_faults MOST [COMMAND [CALL [REQUEST]]]
//
// MOST requests of a call are refused, evenly, or all if there are not more; of a single
// one it is told where it was made. Each call is a process of its own (fork). The
// requests of this project count (the linker's --wrap), not those of the libraries that
// draw, which may crash without memory.
#include <assert.h>
#include <dirent.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "ui/command_table.h"

// --- who refuses -----------------------------------------------------------------------

static atomic_long *requests; // made by the process under test, shared with it
static bool tested;           // this is that process
static long refused_at;       // 0: none

static bool tells_place; // of the request that is refused: the calls that led to it

// Counts a request for memory of the process under test. True if it is the one to refuse;
// where that was asked for, the calls that led to it are printed then.
static bool refused(void)
{
    if (!tested || atomic_fetch_add(requests, 1) + 1 != refused_at) {
        return false;
    }
    if (tells_place) {
        void *calls[40];
        tested = false;
        backtrace_symbols_fd(calls, backtrace(calls, 40), STDERR_FILENO);
        tested = true;
    }
    return true;
}

// A function of the C library that gives `none` where it is refused.
#define REFUSABLE(type, name, none, parameters, arguments)                               \
    type __wrap_##name parameters;                                                       \
    type __real_##name parameters;                                                       \
    type __wrap_##name parameters                                                        \
    {                                                                                    \
        return refused() ? (errno = ENOMEM, none) : __real_##name arguments;             \
    }
REFUSABLE(void *, malloc, NULL, (size_t size), (size))
REFUSABLE(void *, calloc, NULL, (size_t count, size_t size), (count, size))
REFUSABLE(void *, realloc, NULL, (void *memory, size_t size), (memory, size))
REFUSABLE(char *, strdup, NULL, (const char *text), (text))
REFUSABLE(char *, strndup, NULL, (const char *text, size_t most), (text, most))
REFUSABLE(int, vasprintf, -1, (char **text, const char *format, va_list list),
          (text, format, list))

int __wrap_asprintf(char **text, const char *format, ...);
int __wrap_asprintf(char **text, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    const int length = __wrap_vasprintf(text, format, list);
    va_end(list);
    return length;
}

// --- the calls -------------------------------------------------------------------------

enum { MOST_WORDS = 48, MOST_CALLS = 16, WORD = 96 };

// A command line; words[0] is the program's name.
typedef struct call {
    char words[MOST_WORDS][WORD];
    int count;
} call;

static void add(call *c, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void add(call *c, const char *format, ...)
{
    assert(c->count < MOST_WORDS);
    va_list list;
    va_start(list, format);
    vsnprintf(c->words[c->count++], WORD, format, list);
    va_end(list);
}

// Adds words that are separated by blanks.
static void add_all(call *c, const char *words)
{
    char copy[512], *rest = copy;
    snprintf(copy, sizeof copy, "%s", words);
    for (char *word; (word = strsep(&rest, " ")) != NULL;) {
        if (*word != '\0') {
            add(c, "%s", word);
        }
    }
}

typedef enum call_kind {
    USUAL,
    TIMED, // the numbers that it prints are times of the machine, and it draws none
    ALONE, // it takes no further results
} call_kind;

// What commands need beyond what their tables tell, and further calls of theirs.
static const struct {
    const char *command;
    const char *words; // operands and options
    call_kind kind;
} helped[] = {
    {"lab", "touch.yaml --size 80x24 --keys :theme<Space>dark<Enter>:remember<Enter>",
     USUAL},
    {"lab", "touch.yaml --script steps", USUAL},
    {"lab", "touch.yaml --size 120x40 --keys :open<Enter>", USUAL},
    {"lab", "touch.yaml --script much", USUAL},
    {"lesson", "", USUAL},
    {"lesson", "two-predictors --size 80x24", ALONE},
    {"show", "acted.yaml", USUAL},
    {"predict", "touch.yaml", USUAL},
    {"sweep",
     "touch.yaml --vary motor.voltage=1:2:2 --vary method.name=event,newmark --jobs 1",
     USUAL},
    {"sweep",
     "touch.yaml --vary motor.voltage=1:2 --sample latin --runs 3 --db results/s.sqlite",
     USUAL},
    {"merge", "part1.sqlite part2.sqlite -o results/all.sqlite", USUAL},
    {"compare", "hit.yaml touch.yaml --against hit.yaml", USUAL},
    {"compare", "touch.yaml --vary motor.voltage=1,2 --columns peak_force_N --csv -",
     ALONE},
    {"solve", "touch.yaml motor.voltage=1:2 peak_force_N<1 --runs 3 --jobs 1", USUAL},
    {"study", "links touch.yaml", USUAL},
    {"study", "methods hit.yaml", TIMED},
    {"calibrate", "touch.yaml --vary control.approach_voltage=1:2:2", USUAL},
    {"robust", "law.yaml --over over.set --runs 2 --jobs 1", USUAL},
    {"tune", "law.yaml --vary control.force_gain=1:2 --minimise steps --runs 4 --jobs 1",
     USUAL},
    {"robust",
     "law.yaml --over cases.set --runs 2 --jobs 1 --laws force-pd,hybrid --markdown -",
     ALONE},
    {"identify",
     "touch.yaml --data recorded.csv --fit motor.resistance --starts 1 --jobs 1", USUAL},
    {"linear", "law.yaml --law", USUAL},
    {"export", "law.yaml -o results/board", USUAL},
    {"fmu", "law.yaml -o results/arm.fmu", USUAL},
    {"linear", "touch.yaml --at free", ALONE},
    {"animate",
     "hit.yaml --size 320x240 --fps 4 --seconds 0.5 --slow 1 --gl cairo -o "
     "results/frames",
     USUAL},
    {"plot", "recipe.yaml -o results/drawn.svg", USUAL},
    {"figures", "T3.1 --format svg -o results/figures", USUAL},
    {"report", "hit.yaml -o results/report", USUAL},
    {"bench", "--only tables_s", TIMED},
    {"help", "", USUAL},
    {"help", "run --man", USUAL},
    {"help", "settling time", USUAL},
    {"help", "--completion zsh", USUAL},
    {"help", "--man-pages results/man", USUAL},
};
enum { HELPED = (int)(sizeof helped / sizeof helped[0]) };

// The n-th call of a command, from 0 on, that asks for no results: those of the table
// above or, if it has none, one that is as short as the command allows. False if there
// are not so many.
static bool plain_call(const command *c, int n, call *made, call_kind *kind)
{
    int known = 0;
    *made = (call){.count = 0};
    add(made, "impactlab");
    add(made, "%s", c->name);
    for (int i = 0; i < HELPED; i++) {
        if (strcmp(helped[i].command, c->name) == 0 && known++ == n) {
            add_all(made, helped[i].words);
            *kind = helped[i].kind;
            return true;
        }
    }
    for (int i = 0; i < c->least; i++) {
        add(made, c->takes_scenarios ? "touch.yaml" : "expected");
    }
    *kind = USUAL;
    return known == 0 && n == 0;
}

// Whether an option asks for results that a call does not ask for yet. Those of pictures'
// own options need a picture.
static bool is_result(const call *plain, call_kind kind, const option_row *o)
{
    const bool drawn = o->type == OPTION_PICTURE && kind != TIMED;
    bool taken = kind == ALONE || (o->type != OPTION_RESULT && !drawn);
    for (int i = 0; i < page_options.count; i++) {
        taken = taken || o == &page_options.rows[i];
    }
    for (int i = 0; i < plain->count; i++) {
        const char *word = plain->words[i];
        taken = taken || (word[0] == '-' && o->letter != 0 && word[1] == o->letter);
    }
    return !taken;
}

// All calls to be tried that follow from a plain one, and how many they are: the plain
// call itself, one for each result on the standard output, one for each picture, and one
// with all results in files.
static int calls_of(const command *c, const call *plain, call_kind kind, call *calls)
{
    call files = *plain;
    const option_row *o;
    int count = 0;
    calls[count++] = *plain;
    for (int i = 0; (o = command_option(c, i)) != NULL; i++) {
        assert(count < MOST_CALLS - 1);
        if (is_result(plain, kind, o)) {
            call *one = &calls[count++];
            *one = *plain;
            add(one, "--%s", o->name);
            add(one, o->type == OPTION_RESULT ? "-" : "results/%s.svg", o->name);
        }
        if (is_result(plain, kind, o) && o->type == OPTION_RESULT) {
            add(&files, "--%s", o->name);
            add(&files, "results/%s", o->name);
        }
    }
    if (files.count > plain->count) {
        calls[count++] = files;
    }
    return count;
}

// --- what came of one ------------------------------------------------------------------

static int failures;
static long refusals;

// Prints that a call did not behave when one request was refused: what is wrong, and the
// beginning of the text that shows it.
static void fail(const call *c, long request, const char *what, const char *evidence)
{
    printf("FAILED: request %ld of:", request);
    for (int i = 0; i < c->count; i++) {
        printf(" %s", c->words[i]);
    }
    printf(": %s%.300s\n", what, evidence);
    failures++;
}

// A file's content as a text on the heap, its length in *length.
static char *content_of(const char *path, size_t *length)
{
    struct stat about;
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0 || fstat(file, &about) != 0) {
        perror(path);
        exit(EXIT_FAILURE);
    }
    char *text = calloc(1, (size_t)about.st_size + 1);
    if (text == NULL) {
        perror(path);
        exit(EXIT_FAILURE);
    }

    // read() may return less than what it is asked for
    *length = 0;
    ssize_t got = 0;
    do {
        *length += (size_t)got;
        got = read(file, text + *length, (size_t)about.st_size - *length);
    } while (got > 0);
    close(file);
    return text;
}

// Writes what two runs of one call have in common: the text without the lines that say
// how long the machine took and, if `timed`, without all digits, signs and blanks. Bytes
// that are no text stay as they are.
static void write_essence(FILE *out, char *text, size_t length, bool timed)
{
    if (memchr(text, '\0', length) != NULL) {
        fwrite(text, 1, length, out);
        return;
    }
    for (char *line, *rest = text; (line = strsep(&rest, "\n")) != NULL;) {
        if (strstr(line, "wall_time_s") != NULL || strstr(line, "cpu_time_s") != NULL ||
            strstr(line, "  wall time  ") != NULL ||
            strstr(line, "  cpu time  ") != NULL) {
            continue;
        }
        for (char *c = line; *c != '\0'; c++) {
            if (!timed || strchr("0123456789.e+- ", *c) == NULL) {
                fputc(*c, out);
            }
        }
        fputc('\n', out);
    }
}

// Whether an entry of a folder is neither the folder itself nor the one above it.
static int is_entry_below(const struct dirent *entry)
{
    return strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
}

// Writes the names and contents of all files in and below a folder, and removes the
// files.
static void take_files(FILE *out, const char *folder, bool timed)
{
    struct dirent **entries;
    const int count = scandir(folder, &entries, is_entry_below, alphasort);
    for (int i = 0; i < count; i++) {
        char path[1024];
        struct stat about;
        snprintf(path, sizeof path, "%s/%s", folder, entries[i]->d_name);
        fprintf(out, "%s\n", path);
        if (lstat(path, &about) == 0 && S_ISDIR(about.st_mode)) {
            take_files(out, path, timed);
            rmdir(path);
        } else {
            // a database has other bytes each time: its name is enough
            size_t length;
            char *text = content_of(path, &length);
            if (strstr(path, ".sqlite") == NULL) {
                write_essence(out, text, length, timed);
            }
            free(text);
            unlink(path);
        }
        free(entries[i]);
    }
    if (count >= 0) {
        free(entries);
    }
}

// Carries out a call in a process of its own in which request number `refused_request`
// for memory is refused (none if 0). Its output goes to the files "out" and "err".
// Returns its status as waitpid() has it, -1 without a process.
static int carry_out(const call *c, long refused_request)
{
    // the words as main() gets them
    char *words[MOST_WORDS + 1];
    for (int i = 0; i < c->count; i++) {
        words[i] = (char *)c->words[i];
    }
    words[c->count] = NULL;

    // what is buffered would be written by the child once more
    mkdir("results", 0777);
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        // standard streams are files
        const int out = open("out", O_WRONLY | O_CREAT | O_TRUNC, 0666);
        const int err = open("err", O_WRONLY | O_CREAT | O_TRUNC, 0666);
        const int in = open("/dev/null", O_RDONLY);
        dup2(in, STDIN_FILENO);
        dup2(out, STDOUT_FILENO);
        dup2(err, STDERR_FILENO);
        close(in);
        close(out);
        close(err);

        // from here on requests are counted
        refused_at = refused_request;
        atomic_store(requests, 0);
        tested = true;
        exit(program_run(c->count, words));
    }
    if (child < 0) {
        return -1;
    }

    // a signal may interrupt the waiting
    int ended = 0;
    while (waitpid(child, &ended, 0) < 0 && errno == EINTR) {
    }
    return ended;
}

// What a call printed and wrote, as a text on the heap.
static char *essence(bool timed, size_t *length)
{
    char *text;
    size_t printed;
    FILE *all = open_memstream(&text, length);
    char *out = content_of("out", &printed);
    write_essence(all, out, printed, timed);
    free(out);
    take_files(all, "results", timed);
    fclose(all);
    return text;
}

// Carries out a call with one request refused. If it then ends with status 0, what it
// printed and wrote is as expected; else it says a sentence, which does not blame the
// call.
static void attempt(const call *c, bool timed, long k, const char *expected,
                    size_t expected_length)
{
    size_t length, err_length;
    const int ended = carry_out(c, k);
    char *got = essence(timed, &length), *err = content_of("err", &err_length);
    refusals++;

    if (!WIFEXITED(ended) || WEXITSTATUS(ended) > EXIT_BAD_ARGUMENTS) {
        fail(c, k, "it crashed: ", err);
    } else if (WEXITSTATUS(ended) != EXIT_DONE) {
        if (err_length == 0) {
            fail(c, k, "it failed without a sentence", "");
        }
        if (strstr(err, "did you mean") != NULL || strstr(err, "neither") != NULL) {
            fail(c, k, "it blames the call: ", err);
        }
    } else if (length != expected_length || memcmp(got, expected, length) != 0) {
        // from a few characters before the first difference on
        size_t same = 0;
        while (same < length && same < expected_length && got[same] == expected[same]) {
            same++;
        }
        fail(c, k, "another result, and status 0: ", got + (same > 40 ? same - 40 : 0));
    }

    // a file that is being written has the ending .part
    if (strstr(got, ".part") != NULL) {
        fail(c, k, "a temporary stays", "");
    }
    if (tells_place) {
        printf("%s\n", err);
    }
    free(got);
    free(err);
}

// Carries out a call undisturbed and then with about `most` of its requests refused, one
// each time; only with request number `only` if that is not 0.
static void attempt_all(const call *c, bool timed, long most, long only)
{
    // undisturbed it does what it is asked for, and twice the same
    size_t lengths[2], err_length;
    char *expected[2];
    for (int i = 0; i < 2; i++) {
        const int ended = carry_out(c, 0);
        expected[i] = essence(timed, &lengths[i]);
        char *err = content_of("err", &err_length);
        if (!WIFEXITED(ended) || WEXITSTATUS(ended) != EXIT_DONE) {
            fail(c, 0, "undisturbed it does not succeed: ", err);
        }
        free(err);
    }
    if (lengths[0] != lengths[1] || memcmp(expected[0], expected[1], lengths[0]) != 0) {
        fail(c, 0, "it is not the same twice", "");
    }

    // of few requests each is refused, of many every step-th one
    const long all = atomic_load(requests), step = (all + most - 1) / most;
    for (int i = 1; i < c->count; i++) {
        printf("%s ", c->words[i]);
    }
    printf(": %ld requests, each %ld. is refused\n", all, step);
    tells_place = only > 0;
    for (long k = only > 0 ? only : 1; k <= all && (only == 0 || k == only); k += step) {
        attempt(c, timed, k, expected[1], lengths[1]);
    }
    free(expected[0]);
    free(expected[1]);
}

// --- what the calls are about ----------------------------------------------------------

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    if (file == NULL || fputs(text, file) == EOF || fclose(file) != 0) {
        perror(path);
        exit(EXIT_FAILURE);
    }
}

static void prepare(void)
{
    write_text("hit.yaml",
               "title: An impact\nmotor: {voltage: 2 V}\nrun: {duration: 0.05 s}\n");
    write_text("recorded.csv",
               "time[s],command[V],encoder[rad]\n0,1,0\n0.005,1,0\n0.01,1,0\n"
               "0.015,1,0\n0.02,1,0.001\n0.025,1,0.002\n");
    write_text("touch.yaml",
               "title: A touch\nmotor: {voltage: 2 V}\nwall: {angle: 0.01}\n"
               "run: {duration: 0.12 s}\n");
    write_text("acted.yaml",
               "title: Much happens\ndescription: Of all that may be shown.\n"
               "motor: {voltage: 2 V}\nwall: {angle: 0.01}\n"
               "run: {duration: 0.12 s}\nscript:\n"
               "  - {at: 0.05, set: {motor.voltage: 1 V}}\n"
               "  - {at: 0.06, push: -0.01 N s}\n"
               "expect: {impacts: {value: 3, tolerance: 9}}\n");
    write_text("steps", "set motor.voltage 3\nseek 0.05\n");
    write_text(
        "much",
        "seek 0.05\npin one\nset motor.voltage 3\nundo\nset arm.k2 6\nphase gap force\n"
        "spectrum force\nsweep motor.voltage=2:3:2\ndifference\nsave results/s.csv\n"
        "save results/s.yaml\nsave results/s.txt\n");
    write_text("law.yaml", "title: A law\ncontrol: {law: force-pd, force: 1}\n"
                           "run: {duration: 0.1 s}\n");
    write_text("over.set", "belief.k2_factor=0.9:1.1\n");
    write_text("cases.set", "belief.k2_factor=0.9:1.1\ncase softer: arm.k2=5\n");
    write_text("recipe.yaml", "title: A recipe\nruns:\n  - scenario: hit.yaml\n"
                              "panels:\n  - signals: [hub_angle]\n");
    for (int part = 1; part <= 2; part++) {
        call c = {.count = 0};
        add_all(&c,
                "impactlab sweep hit.yaml --vary motor.voltage=1:2:4 --jobs 1 --quiet");
        add(&c, "--part");
        add(&c, "%d/2", part);
        add(&c, "--db");
        add(&c, "part%d.sqlite", part);
        if (carry_out(&c, 0) != 0) {
            fail(&c, 0, "a part of a sweep", "");
        }
    }
}

int main(int count, char **words)
{
    const long most = count > 1 ? atol(words[1]) : 40;
    const char *only = count > 2 ? words[2] : NULL;
    const int only_call = count > 3 ? atoi(words[3]) : -1;
    char folder[] = "/tmp/command_faults_XXXXXX";
    requests = mmap(NULL, sizeof *requests, PROT_READ | PROT_WRITE,
                    MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (requests == MAP_FAILED || mkdtemp(folder) == NULL || chdir(folder) != 0) {
        perror("test_command_faults");
        return EXIT_FAILURE;
    }
    setvbuf(stdout, NULL, _IOLBF, 0);
    setenv("XDG_CONFIG_HOME", folder, 1);
    prepare();

    for (int i = 0; i < command_table.count; i++) {
        const command *c = command_table.items[i];
        call plain, calls[MOST_CALLS];
        call_kind kind;
        int number = 0;
        for (int n = 0; plain_call(c, n, &plain, &kind); n++) {
            const int made = calls_of(c, &plain, kind, calls);
            for (int k = 0; k < made; k++, number++) {
                if ((only == NULL || strcmp(only, c->name) == 0) &&
                    (only_call < 0 || number == only_call)) {
                    attempt_all(&calls[k], kind == TIMED, most,
                                count > 4 ? atol(words[4]) : 0);
                }
            }
        }
    }
    printf("%ld requests refused, %d broken promises\n", refusals, failures);
    FILE *nowhere = fopen("/dev/null", "w");
    if (nowhere != NULL) {
        take_files(nowhere, folder, false);
        fclose(nowhere);
        rmdir(folder);
    }
    return failures > 0;
}
