#include "src/rig/external/process.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "src/base/clock.h"
#include "src/base/numbers.h"
#include "src/base/words.h"
#include "src/rig/controller_values.h"
#include "src/rig/external/process_lines.h"
#include "src/rig/external/supervisor.h"

enum {
    MOST_LINE = 65536,     // of an answer [bytes]
    LAST_ERRORS = 160,     // of what the program wrote to its standard error last [bytes]
    MOST_ERRORS = 1 << 20, // of it that are kept meanwhile [bytes]
    SHOWN_OF_LINE = 60,    // of a line that is no answer [bytes]
    STOP_CHECK = 100       // between looks at whether the run is to end [ms]
};

struct process {
    supervised_program program;
    stop_request *stop;         // where the run is to end; NULL: it does not
    control_parameters control; // what the program is told next
    controller_setup setup;     // the same
    bool tells_setup;           // the next line carries both
    char line[MOST_LINE + 1];   // what has been read of the answer
    size_t length;              // of that [bytes]
    status code;                // STATUS_OK as long as the program can be asked
    char failure[1024];         // a sentence, where it cannot
};

process *process_create(const control_parameters *control, stop_request *stop)
{
    process *p = calloc(1, sizeof *p);
    if (p != NULL) {
        p->stop = stop;
        p->control = *control;
    }
    return p;
}

void process_destroy(process *p)
{
    if (p != NULL) {
        supervised_program_end(&p->program);
        free(p);
    }
}

void process_tell(process *p, const control_parameters *control)
{
    p->control = *control;
}

status process_failure(const process *p, const char **why)
{
    *why = p->failure;
    return p->code;
}

// --- what goes wrong -------------------------------------------------------------------

// What the program wrote to its standard error last, in one line.
static void read_last_errors(const supervised_program *program,
                             char text[LAST_ERRORS + 1])
{
    struct stat about;
    ssize_t length = 0;
    if (program->supervisor != 0 && fstat(program->errors, &about) == 0) {
        const off_t from = about.st_size - LAST_ERRORS;
        length = pread(program->errors, text, LAST_ERRORS, from > 0 ? from : 0);
    }
    text[length > 0 ? length : 0] = '\0';

    for (char *c = text; *c != '\0'; c++) {
        if (is_control(*c)) {
            *c = ' ';
        }
    }
}

// Ends the program for a reason, which stays. Always false.
__attribute__((format(printf, 3, 4))) static bool end_program(process *p, status code,
                                                              const char *format, ...)
{
    char why[512];
    va_list values;
    va_start(values, format);
    decimal_vprint(why, sizeof why, format, values);
    va_end(values);

    // what the program said last is what helps
    char errors[LAST_ERRORS + 1], ended[48] = "";
    read_last_errors(&p->program, errors);
    const char *said = errors + strspn(errors, " ");
    const int exit_status = supervised_program_end(&p->program);
    if (exit_status >= 0) {
        snprintf(ended, sizeof ended, " (exit status %d)", exit_status);
    }

    snprintf(p->failure, sizeof p->failure, "the process '%.200s' %s%s%s%s",
             p->control.command, why, ended, said[0] != '\0' ? "; it said last: " : "",
             said);
    make_printable(p->failure, 0);
    p->code = code;
    return false;
}

#define FAIL(p, ...) end_program(p, STATUS_CONTROLLER_FAILED, __VA_ARGS__)

static bool fail_without_memory(process *p)
{
    return end_program(p, STATUS_NO_MEMORY, "could not be asked: %s",
                       status_text(STATUS_NO_MEMORY));
}

// --- a question and its answer ---------------------------------------------------------

// Starts the program. False, with a failure, if it cannot be.
static bool start_program(process *p)
{
    const int reason = supervised_program_start(&p->program, p->control.command);
    if (reason != 0) {
        return FAIL(p, "cannot be started: %s", strerror(reason));
    }
    return true;
}

// Writes the question. False, with a failure, if the program takes no more of them.
static bool send_question(process *p, const char *question)
{
    const ssize_t sent =
        send(p->program.input, question, strlen(question), MSG_NOSIGNAL | MSG_DONTWAIT);

    // one that has closed its input may have answered before: its answer, or its end,
    // tells
    if (sent < 0 && errno != EPIPE && errno != ECONNRESET) {
        return FAIL(p, "does not read what it is asked: %s", strerror(errno));
    }
    return true;
}

// Reads what has come of the answer. False, with a failure, if there will be none.
static bool read_part_of_answer(process *p)
{
    const ssize_t count =
        read(p->program.output, p->line + p->length, MOST_LINE - p->length);
    if (count < 0) {
        return errno == EAGAIN || errno == EINTR ||
               FAIL(p, "gave an answer that cannot be read: %s", strerror(errno));
    }
    if (count == 0) {
        return FAIL(p, "ended without an answer");
    }

    // a full buffer without a whole line will never hold one
    p->length += (size_t)count;
    p->line[p->length] = '\0';
    if (p->length == MOST_LINE && memchr(p->line, '\n', p->length) == NULL) {
        return FAIL(p, "answered %d bytes without the end of a line", (int)MOST_LINE);
    }
    return true;
}

// Forgets what the program wrote to its standard error where that has become much.
static void limit_errors(const process *p)
{
    struct stat about;
    if (fstat(p->program.errors, &about) == 0 && about.st_size > MOST_ERRORS) {
        (void)!ftruncate(p->program.errors, 0);
    }
}

// Whether the run is to end, asked at once although the request is looked at seldom.
static bool run_is_to_end(stop_request *stop)
{
    if (stop == NULL) {
        return false;
    }
    stop->due = 0;
    return stop_requested(stop);
}

// Waits for a whole line. False, with a failure, if none came in time or the run is to
// end.
static bool wait_for_answer(process *p)
{
    const double deadline = clock_seconds(CLOCK_MONOTONIC) + p->control.answer_time;
    while (memchr(p->line, '\n', p->length) == NULL) {
        const double left_ms = 1e3 * (deadline - clock_seconds(CLOCK_MONOTONIC));
        if (left_ms <= 0) {
            return FAIL(p, "gave no answer within control.answer_time = %g s",
                        p->control.answer_time);
        }
        if (run_is_to_end(p->stop)) {
            return end_program(p, STATUS_STOPPED, "was ended with its run");
        }
        limit_errors(p);

        struct pollfd output = {.fd = p->program.output, .events = POLLIN};
        const int ready = poll(&output, 1, (int)ceil(fmin(left_ms, STOP_CHECK)));
        if (ready > 0 && !read_part_of_answer(p)) {
            return false;
        }
    }
    return true;
}

// What the line says; a failure if that is no answer.
static void read_answer(process *p, controller_output *out)
{
    char *end = memchr(p->line, '\n', p->length);
    const size_t length = (size_t)(end - p->line);
    const bool more = length + 1 < p->length;
    *end = '\0';
    p->length = 0;

    const status read = process_read_answer(p->line, length, out);
    if (read == STATUS_NO_MEMORY) {
        fail_without_memory(p);
    } else if (read != STATUS_OK) {
        FAIL(p, "answered '%.*s', expected one line such as {\"command\": 1.5}",
             SHOWN_OF_LINE, p->line);
    } else if (more) {
        FAIL(p, "answered more than one line to one sample");
    }
}

// --- the controller --------------------------------------------------------------------

// Its memory is the process that it was given with. The program itself is started by the
// first sample.
static const char *process_take_setup(void *memory, const controller_setup *setup)
{
    process *p = *(process **)memory;
    p->setup = *setup;
    p->tells_setup = true;
    return NULL;
}

static void process_sample(void *memory, const controller_input *in,
                           controller_output *out)
{
    process *p = *(process **)memory;

    // a program that was ended cannot go on, be it only because its run was stopped
    if (p->code != STATUS_OK) {
        p->code = STATUS_CONTROLLER_FAILED;
        return;
    }
    if (p->program.supervisor == 0 && !start_program(p)) {
        return;
    }

    char *question = process_question(p->tells_setup ? &p->setup : NULL, &p->control, in);
    p->tells_setup = false;
    if (question == NULL) {
        fail_without_memory(p);
    } else if (send_question(p, question) && wait_for_answer(p)) {
        read_answer(p, out);
    }
    free(question);
}

static const controller_parameter process_parameters[] = {{.name = "force"}};

const controller process_law =
    ONE_MODE_CONTROLLER("process", "process", sizeof(process *), process_sample,
                        .parameters = process_parameters, .parameter_count = 1,
                        .start = process_take_setup, .tune = process_take_setup);
