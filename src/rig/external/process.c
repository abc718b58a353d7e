#include "src/rig/external/process.h"

#include <errno.h>
#include <fcntl.h>
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
#include "src/rig/external/supervisor.h"

enum {
    MOST_LINE = 65536,     // of an answer [bytes]
    LAST_ERRORS = 160,     // of what the program wrote to its standard error last [bytes]
    MOST_ERRORS = 1 << 20, // of it that are kept meanwhile [bytes]
    SHOWN_OF_LINE = 60,    // of a line that is no answer [bytes]
    LOOK_UP = 100          // from waiting for an answer, whether the run is to end [ms]
};

struct process {
    supervised_program program;
    process_transcript *transcript; // of the questions, NULL for none; somebody else's
    stop_request *stop;             // where the run is to end; NULL: it does not
    const transcript_node *at;      // the place that the running program has come to
    long asked;                     // questions it has been asked
    int started;                    // how many times it was started
    control_parameters begun;       // with, as the run does
    double answer_time;             // [s]
    char line[MOST_LINE + 1];
    size_t length;      // of what has been read of the answer
    status code;        // STATUS_OK as long as it can be asked
    char failure[1024]; // a sentence, where it cannot
};

// The controller's memory: what a run remembers of its process. Another run, or this one
// taken back to an earlier state, may have asked the program something else since.
typedef struct process_memory {
    process *process;    // as the rig left it there
    transcript_node *at; // this run's place on the transcript, NULL where it has none
    long asked;          // questions so far
    int started;         // the start of the program that was asked last
    bool tells_setup;    // the next line carries it
    controller_setup setup;
    control_parameters control;
} process_memory;

process *process_create(const control_parameters *control, process_transcript *transcript,
                        stop_request *stop)
{
    process *p = calloc(1, sizeof *p);
    if (p != NULL) {
        p->transcript = transcript;
        p->stop = stop;
        p->begun = *control;
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

void process_tell(void *memory, const control_parameters *control)
{
    ((process_memory *)memory)->control = *control;
}

status process_failure(const process *p, const char **why)
{
    *why = p->failure;
    return p->code;
}

// --- what goes wrong -------------------------------------------------------------------

// What the program wrote to its standard error last, as it may be shown on a terminal.
static void read_last_errors(const process *p, char text[LAST_ERRORS + 1])
{
    struct stat about;
    const bool known =
        p->program.supervisor != 0 && fstat(p->program.errors, &about) == 0;
    const off_t from =
        known && about.st_size > LAST_ERRORS ? about.st_size - LAST_ERRORS : 0;
    const ssize_t length = known ? pread(p->program.errors, text, LAST_ERRORS, from) : 0;
    text[length > 0 ? length : 0] = '\0';
    for (char *c = text; *c != '\0'; c++) {
        if (is_control(*c)) {
            *c = ' ';
        }
    }
}

// Gives the memory of all but the last of it back where that has become much.
static void forget_old_errors(const process *p)
{
    struct stat about;
    if (fstat(p->program.errors, &about) == 0 && about.st_blocks > MOST_ERRORS / 512) {
        fallocate(p->program.errors, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, 0,
                  about.st_size - LAST_ERRORS);
    }
}

// Ends the program and says why. Always false.
__attribute__((format(printf, 3, 4))) static bool fail(process *p, status code,
                                                       const char *format, ...)
{
    char why[512];
    va_list values;
    va_start(values, format);
    decimal_vprint(why, sizeof why, format, values);
    va_end(values);

    // what the program said last is what helps
    char said[LAST_ERRORS + 1], ended[48] = "";
    read_last_errors(p, said);
    const int exit_status = supervised_program_end(&p->program);
    if (exit_status >= 0) {
        snprintf(ended, sizeof ended, " (exit status %d)", exit_status);
    }
    const char *errors = said + strspn(said, " ");
    snprintf(p->failure, sizeof p->failure, "the process '%.200s' %s%s%s%s",
             p->begun.command, why, ended, errors[0] != '\0' ? "; it said last: " : "",
             errors);
    make_printable(p->failure, 0);
    p->code = code;
    return false;
}

// The same for what the program does, and for what is not its doing.
#define FAIL(p, ...) fail(p, STATUS_CONTROLLER_FAILED, __VA_ARGS__)

static bool fail_without_memory(process *p)
{
    return fail(p, STATUS_NO_MEMORY, "could not be asked: %s",
                status_text(STATUS_NO_MEMORY));
}

// Whether the run is to end: the program, too, is ended then.
static bool run_ends(process *p)
{
    if (p->stop != NULL) {
        p->stop->due = 0; // who waits looks seldom
    }
    const bool ends = p->stop != NULL && stop_requested(p->stop);
    if (ends) {
        supervised_program_end(&p->program);
        p->failure[0] = '\0';
        p->code = STATUS_STOPPED;
    }
    return ends;
}

// --- an answer -------------------------------------------------------------------------

// Reads what has come of the answer. False, with a failure, if there will be none.
static bool take_in(process *p)
{
    ssize_t count = read(p->program.output, p->line + p->length, MOST_LINE - p->length);
    if (count < 0) {
        return errno == EAGAIN || errno == EINTR ||
               FAIL(p, "gave an answer that cannot be read: %s", strerror(errno));
    }

    // at its end it can say no more
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

// Writes the question and waits for a whole line. False, with a failure, if none came in
// time or the run is to end.
static bool exchange(process *p, const char *text)
{
    const double deadline = clock_seconds(CLOCK_MONOTONIC) + p->answer_time;
    const size_t length = strlen(text);
    size_t sent = 0;

    // both ways at once, as the program may wait at any of them
    while (memchr(p->line, '\n', p->length) == NULL || sent < length) {
        struct pollfd ends[] = {
            {.fd = p->program.output, .events = POLLIN},
            {.fd = sent < length ? p->program.input : -1, .events = POLLOUT},
        };

        // an end may be ready, but after the deadline
        const double left = 1e3 * (deadline - clock_seconds(CLOCK_MONOTONIC));
        const int ready = poll(ends, 2, (int)ceil(fmin(fmax(left, 0), LOOK_UP)));
        if (clock_seconds(CLOCK_MONOTONIC) >= deadline) {
            return FAIL(p, "gave no answer within control.answer_time = %g s",
                        p->answer_time);
        }
        if (run_ends(p)) {
            return false;
        }
        forget_old_errors(p);
        if (ready > 0 && ends[1].revents != 0) {
            ssize_t count = send(p->program.input, text + sent, length - sent,
                                 MSG_NOSIGNAL | MSG_DONTWAIT);
            // one that listens no more may have answered before; its answer, or its end,
            // tells
            const bool deaf = count < 0 && errno != EAGAIN && errno != EINTR;
            if (deaf) {
                sent = length;
            } else {
                sent = sent + (count > 0 ? (size_t)count : 0);
            }
        }
        if (ready > 0 && ends[0].revents != 0 && !take_in(p)) {
            return false;
        }
    }
    return true;
}

// What the line says. False, with a failure, if that is no answer.
static bool understand(process *p, controller_output *out)
{
    char *end = memchr(p->line, '\n', p->length);
    const size_t length = (size_t)(end - p->line);
    *end = '\0';

    // lock step: one line for one line
    const bool more = length + 1 < p->length;
    p->length = 0;
    const status read = process_read_answer(p->line, length, out);
    if (read == STATUS_NO_MEMORY) {
        return fail_without_memory(p);
    }
    if (read != STATUS_OK) {
        return FAIL(p, "answered '%.*s', expected one line such as {\"command\": 1.5}",
                    SHOWN_OF_LINE, p->line);
    }
    if (more) {
        return FAIL(p, "answered more than one line to one sample");
    }
    return true;
}

// Asks the running program one thing. False, with a failure, if that gives no answer.
static bool ask(process *p, const char *question, controller_output *answer)
{
    p->asked++;
    return exchange(p, question) && understand(p, answer);
}

// --- going on from the past ------------------------------------------------------------

// Starts the program. False, with a failure, if it cannot be.
static bool start_program(process *p)
{
    supervised_program_end(&p->program);
    if (p->transcript != NULL) {
        p->at = p->transcript->begin;
    } else {
        p->at = NULL;
    }
    p->asked = 0;
    p->started++;
    p->length = 0;
    int reason = supervised_program_start(&p->program, p->begun.command);
    if (reason != 0) {
        p->code = STATUS_CONTROLLER_FAILED;
        snprintf(p->failure, sizeof p->failure, "'%.200s' cannot be started: %s",
                 p->begun.command, strerror(reason));
    }
    return reason == 0;
}

// Brings the program to the run's place on the transcript: it is started if it does not
// run or is at another place, and all questions that lead there are repeated. False, with
// a failure, if it answers otherwise than then, or the way there is not known.
static bool catch_up(process *p, const process_memory *m, double time)
{
    const bool runs = p->program.supervisor != 0,
               unrecorded = m->at == NULL && m->asked > 0;
    if (runs && p->at == m->at && p->asked == m->asked &&
        !(unrecorded && p->started != m->started)) {
        return true;
    }
    if (unrecorded) {
        return FAIL(p,
                    "would have to go on from the past, which is not recorded any more");
    }

    // the way back to where the program is, or to the beginning
    transcript_node *node = m->at;
    int length = 0;
    for (; node != NULL && node->before != NULL && !(runs && node == p->at); length++) {
        node->before->towards = node;
        node = node->before;
    }

    // and forth again
    const bool anew = !runs || node != p->at;
    bool same = !anew || start_program(p);
    for (int i = 1; same && i <= length; i++) {
        controller_output answer = {.mode = 0};
        node = node->towards;
        same = ask(p, node->question, &answer);
        if (same && !process_same_answer(&answer, &node->answer)) {
            same = FAIL(p,
                        "would have to go on from the past: asked once more, it answered "
                        "sample %d of %d with %.9g V, not %.9g V as before",
                        i, length, answer.command, node->answer.command);
        }
        p->at = node;
    }
    if (same && anew && length > 0) {
        p->transcript->replay =
            (process_replay){.restarted = true, .samples = length, .time = time};
    }
    return same;
}

// --- the controller --------------------------------------------------------------------

static const char *take_setup(void *memory, const controller_setup *setup)
{
    process_memory *m = memory;
    m->setup = *setup;
    m->tells_setup = true;
    return NULL;
}

static const char *start(void *memory, const controller_setup *setup)
{
    // the program is started by the first question that the transcript does not know
    process_memory *m = memory;
    if (m->process->transcript != NULL) {
        m->at = m->process->transcript->begin;
    } else {
        m->at = NULL;
    }
    m->control = m->process->begun;
    return take_setup(memory, setup);
}

static void sample(void *memory, const controller_input *in, controller_output *out)
{
    process_memory *m = memory;
    process *p = m->process;
    out->command = (double)NAN;
    p->code =
        STATUS_OK; // a run that failed does not come here, one taken back to before may
    char *question = process_question(m->tells_setup ? &m->setup : NULL, &m->control, in);
    if (question == NULL) {
        fail_without_memory(p);
        return;
    }
    m->tells_setup = false;
    p->answer_time = m->control.answer_time;

    // what was asked before has its answer
    transcript_node *known = process_transcript_find(m->at, question);
    const bool answered =
        known != NULL || (catch_up(p, m, in->time) && ask(p, question, out));
    if (known != NULL) {
        *out = known->answer;
        m->at = known;
    } else if (answered) {
        m->at = process_transcript_add(p->transcript, m->at, question, out);
        p->at = m->at;
        m->started = p->started;
    }
    m->asked += answered;
    free(question);
}

static const controller_parameter told[] = {{.name = "force"}};

const controller process_law =
    ONE_MODE_CONTROLLER("process", "process", sizeof(process_memory), sample,
                        .parameters = told, .parameter_count = 1, .start = start,
                        .tune = take_setup);
