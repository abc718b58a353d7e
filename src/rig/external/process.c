#include "src/rig/external/process.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <poll.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "src/base/clock.h"
#include "src/base/numbers.h"
#include "src/base/words.h"
#include "src/rig/external/supervisor.h"
#include "src/rig/external/process_lines.h"

enum {
    MOST_LINE = 65536,  // of an answer [bytes]
    LAST_ERRORS = 160,  // of what the program wrote to its standard error last [bytes]
    SHOWN_OF_LINE = 60, // of a line that is no answer [bytes]
    READ_AT_ONCE = 4096,
    LOOK_UP = 100 // from waiting for an answer, whether the run is to end [ms]
};

struct process {
    supervised_program program;
    process_transcript *transcript; // of the questions, NULL for none; somebody else's
    process_ends ends;              // of the run
    int at;                         // the place on it that the running program has come to
    long asked;                     // questions it has been asked
    int started;                    // how many times it was started
    control_parameters begun;       // with, as the run does
    double answer_time;             // [s]
    char line[MOST_LINE + 1];
    size_t length; // of what has been read of the answer
    char errors[LAST_ERRORS + 1];
    status code;        // STATUS_OK as long as it can be asked
    char failure[1024]; // a sentence, where it cannot
};

// The controller's memory: what a run remembers of its process. Another run, or this one taken back
// to an earlier state, may have asked the program something else since.
typedef struct process_memory {
    process *process; // as the rig left it there
    int at;           // this run's place on the transcript
    long asked;       // questions so far
    int started;      // the start of the program that was asked last
    bool tells_setup; // the next line carries it
    controller_setup setup;
    control_parameters control;
} process_memory;

process *process_create(const control_parameters *control, process_transcript *transcript,
                        process_ends ends)
{
    assert(control != NULL);
    process *p = calloc(1, sizeof *p);
    if (p != NULL) {
        p->transcript = transcript;
        p->ends = ends;
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
    assert(memory != NULL && control != NULL);
    ((process_memory *)memory)->control = *control;
}

status process_failure(const process *p, const char **why)
{
    assert(p != NULL && why != NULL);
    *why = p->failure;
    return p->code;
}

// --- what goes wrong --------------------------------------------------------------------------

// Keeps the end of what came on the standard error.
static void keep_errors(process *p, const char *text, size_t count)
{
    size_t kept = strlen(p->errors);

    // of more than fits only the end matters
    if (count >= LAST_ERRORS) {
        text += count - LAST_ERRORS;
        count = LAST_ERRORS;
    }

    // the oldest make room
    size_t dropped = kept + count > LAST_ERRORS ? kept + count - LAST_ERRORS : 0;
    memmove(p->errors, p->errors + dropped, kept - dropped);
    memcpy(p->errors + kept - dropped, text, count);
    p->errors[kept - dropped + count] = '\0';

    // they may be shown on a terminal
    for (char *c = p->errors; *c != '\0'; c++) {
        *c = is_control(*c) ? ' ' : *c;
    }
}

// Takes in what is waiting on the standard error. True unless its end was seen.
static bool drain_errors(process *p)
{
    char text[READ_AT_ONCE];
    ssize_t count = read(p->program.errors, text, sizeof text);
    if (count > 0) {
        keep_errors(p, text, (size_t)count);
    }
    return count > 0 || (count < 0 && (errno == EAGAIN || errno == EINTR));
}

// Ends the program and says why. Always false.
static bool fail(process *p, const char *format, ...) __attribute__((format(printf, 2, 3)));
static bool fail(process *p, const char *format, ...)
{
    char why[512];
    va_list values;
    va_start(values, format);
    decimal_vprint(why, sizeof why, format, values);
    va_end(values);

    // what the program said last is what helps
    if (p->program.supervisor != 0) {
        drain_errors(p);
    }
    int exit_status = supervised_program_end(&p->program);
    char ended[48] = "";
    if (exit_status >= 0) {
        snprintf(ended, sizeof ended, " (exit status %d)", exit_status);
    }
    const char *errors = p->errors + strspn(p->errors, " ");
    snprintf(p->failure, sizeof p->failure, "the process '%.200s' %s%s%s%s", p->begun.command, why,
             ended, errors[0] != '\0' ? "; it said last: " : "", errors);
    make_printable(p->failure);
    p->code = STATUS_CONTROLLER_FAILED;
    return false;
}

// The same where it is not the program's doing.
static bool fail_without_memory(process *p)
{
    fail(p, "could not be asked: %s", status_text(STATUS_NO_MEMORY));
    p->code = STATUS_NO_MEMORY;
    return false;
}

// Ends the program where the run does. Always false.
static bool stop_waiting(process *p)
{
    supervised_program_end(&p->program);
    p->failure[0] = '\0';
    p->code = STATUS_STOPPED;
    return false;
}

static bool run_is_to_end(const process *p)
{
    const process_ends *e = &p->ends;
    return (e->stop != NULL && atomic_load_explicit(e->stop, memory_order_relaxed)) ||
           (e->abandon != NULL && atomic_load_explicit(e->abandon, memory_order_relaxed));
}

// --- an answer --------------------------------------------------------------------------------

static double now(void)
{
    return clock_seconds(CLOCK_MONOTONIC);
}

// What is left until a deadline, or until the run is to be looked at, for poll [ms].
static int left_until(double deadline)
{
    double left = deadline - now();
    return left > 0 ? (int)ceil(fmin(left * 1e3, LOOK_UP)) : 0;
}

// Reads what has come of the answer. False, with a failure, if there will be none.
static bool take_in(process *p)
{
    ssize_t count = read(p->program.output, p->line + p->length, MOST_LINE - p->length);
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) {
        return true;
    }
    if (count < 0) {
        return fail(p, "gave an answer that cannot be read: %s", strerror(errno));
    }

    // at its end it can say no more
    if (count == 0) {
        return fail(p, "ended without an answer");
    }

    // a full buffer without a whole line will never hold one
    p->length += (size_t)count;
    p->line[p->length] = '\0';
    if (p->length == MOST_LINE && memchr(p->line, '\n', p->length) == NULL) {
        return fail(p, "answered %d bytes without the end of a line", (int)MOST_LINE);
    }
    return true;
}

// Writes the question and waits for a whole line. False, with a failure, if none came in time or
// the run is to end.
static bool exchange(process *p, const char *text)
{
    const double deadline = now() + p->answer_time;
    const size_t length = strlen(text);
    size_t sent = 0;
    bool errors_open = true;

    // all ends at once, as the program may wait at any of them
    while (memchr(p->line, '\n', p->length) == NULL || sent < length) {
        struct pollfd ends[] = {
            {.fd = p->program.output, .events = POLLIN},
            {.fd = errors_open ? p->program.errors : -1, .events = POLLIN},
            {.fd = sent < length ? p->program.input : -1, .events = POLLOUT},
        };

        // a stream may be ready, but after the deadline
        int ready = poll(ends, 3, left_until(deadline));
        if (now() >= deadline) {
            return fail(p, "gave no answer within control.answer_time = %g s", p->answer_time);
        }
        if (run_is_to_end(p)) {
            return stop_waiting(p);
        }
        if (ready <= 0) {
            continue;
        }

        // errors are taken before the answer, so that a failure can tell them
        if (ends[2].revents != 0) {
            ssize_t count =
                send(p->program.input, text + sent, length - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
            // one that listens no more may have answered before; its answer, or its end, tells
            const bool deaf = count < 0 && errno != EAGAIN && errno != EINTR;
            sent = deaf ? length : sent + (count > 0 ? (size_t)count : 0);
        }
        if (ends[1].revents != 0) {
            errors_open = drain_errors(p);
        }
        if (ends[0].revents != 0 && !take_in(p)) {
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
    switch (process_read_answer(p->line, length, out)) {
    case PROCESS_ANSWERED:
        return more ? fail(p, "answered more than one line to one sample") : true;
    case PROCESS_NO_MEMORY:
        return fail_without_memory(p);
    default:
        return fail(p, "answered '%.*s', expected one line such as {\"command\": 1.5}",
                    SHOWN_OF_LINE, p->line);
    }
}

// Asks the running program one thing. False, with a failure, if that gives no answer.
static bool ask(process *p, const char *question, controller_output *answer)
{
    p->asked++;
    return exchange(p, question) && understand(p, answer);
}

// --- going on from the past -------------------------------------------------------------------

// Starts the program. False, with a failure, if it cannot be.
static bool start_program(process *p)
{
    supervised_program_end(&p->program);
    p->at = p->transcript != NULL ? TRANSCRIPT_BEGIN : TRANSCRIPT_NONE;
    p->asked = 0;
    p->started++;
    p->length = 0;
    p->errors[0] = '\0';
    int reason = supervised_program_start(&p->program, p->begun.command);
    if (reason != 0) {
        p->code = STATUS_CONTROLLER_FAILED;
        snprintf(p->failure, sizeof p->failure, "'%.200s' cannot be started: %s", p->begun.command,
                 strerror(reason));
    }
    return reason == 0;
}

// Whether two answers are the same to the last bit; NaN is what was not answered.
static bool same_answer(const controller_output *a, const controller_output *b)
{
    const double x[] = {a->command, a->desired_angle, a->desired_velocity, a->calculated_force};
    const double y[] = {b->command, b->desired_angle, b->desired_velocity, b->calculated_force};
    return memcmp(x, y, sizeof x) == 0;
}

// Brings the program to the run's place on the transcript: it is started if it does not run or is
// at another place, and all questions that lead there are repeated. False, with a failure, if it
// answers otherwise than then, or the way there is not known.
static bool catch_up(process *p, const process_memory *m, double time)
{
    const bool runs = p->program.supervisor != 0;
    const bool off_transcript = m->at == TRANSCRIPT_NONE && m->asked > 0;
    if (runs && p->at == m->at && p->asked == m->asked &&
        !(off_transcript && p->started != m->started)) {
        return true;
    }
    if (off_transcript) {
        return fail(p, "would have to go on from the past, which is not recorded any more");
    }

    // the way back to the beginning, or to where the program is
    int *way = calloc((size_t)m->asked + 1, sizeof *way);
    int length = 0;
    int place = m->at;
    for (; way != NULL && place > TRANSCRIPT_BEGIN && !(runs && place == p->at); length++) {
        way[length] = place;
        place = process_transcript_before(p->transcript, place);
    }
    if (way == NULL) {
        return fail_without_memory(p);
    }

    // and forth again
    const bool anew = !runs || place != p->at;
    bool same = !anew || start_program(p);
    for (int i = length - 1; same && i >= 0; i--) {
        controller_output answer = {.mode = 0};
        const controller_output then = process_transcript_answer(p->transcript, way[i]);
        same = ask(p, process_transcript_question(p->transcript, way[i]), &answer);
        if (same && !same_answer(&answer, &then)) {
            same = fail(p,
                        "would have to go on from the past: asked once more, it answered "
                        "sample %d of %d with %.9g V, not %.9g V as before",
                        length - i, length, answer.command, then.command);
        }
        p->at = way[i];
    }
    if (same && anew && length > 0) {
        process_transcript_note(p->transcript, length, time);
    }
    free(way);
    return same;
}

// --- the controller ---------------------------------------------------------------------------

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
    m->at = m->process->transcript != NULL ? TRANSCRIPT_BEGIN : TRANSCRIPT_NONE;
    m->control = m->process->begun;
    return take_setup(memory, setup);
}

static void sample(void *memory, const controller_input *in, controller_output *out)
{
    process_memory *m = memory;
    process *p = m->process;
    out->command = (double)NAN;
    p->code = STATUS_OK; // a run that failed does not come here, one taken back to before may
    char *question = process_question(m->tells_setup ? &m->setup : NULL, &m->control, in);
    if (question == NULL) {
        fail_without_memory(p);
        return;
    }
    m->tells_setup = false;
    p->answer_time = m->control.answer_time;

    // what was asked before has its answer
    const int known = process_transcript_find(p->transcript, m->at, question);
    if (known != TRANSCRIPT_NONE) {
        *out = process_transcript_answer(p->transcript, known);
        m->at = known;
        m->asked++;
    } else if (catch_up(p, m, in->time) && ask(p, question, out)) {
        m->at = p->at = process_transcript_add(p->transcript, m->at, question, out);
        m->started = p->started;
        m->asked++;
    }
    free(question);
}

static const controller_parameter told[] = {{.name = "force"}};

const controller process_law = {
    .interface = CONTROLLER_INTERFACE,
    .name = "process",
    .modes = (const char *const[]){"process", NULL},
    .parameters = told,
    .parameter_count = sizeof told / sizeof told[0],
    .memory_size = sizeof(process_memory),
    .start = start,
    .sample = sample,
    .tune = take_setup,
};
