#include "src/rig/process.h"

#include <assert.h>
#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <poll.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "src/base/clock.h"
#include "src/base/json.h"
#include "src/base/numbers.h"
#include "src/base/words.h"
#include "src/rig/keeper.h"

enum {
    PROTOCOL = 1,       // of the lines, told in the first one
    MOST_LINE = 65536,  // of an answer [bytes]
    LAST_ERRORS = 160,  // of what the program wrote to its standard error last [bytes]
    SHOWN_OF_LINE = 60, // of an answer that is none [bytes]
    READ_AT_ONCE = 4096
};

struct process {
    kept_program program;
    control_parameters control;
    double answer_time; // [s]
    controller_setup setup;
    bool tells_setup; // the next line carries it
    char line[MOST_LINE + 1];
    size_t length; // of what has been read of the answer
    char errors[LAST_ERRORS + 1];
    char failure[1024]; // a sentence, "" as long as there is none
};

process *process_create(const control_parameters *control)
{
    assert(control != NULL);
    process *p = calloc(1, sizeof *p);
    if (p != NULL) {
        p->control = *control;
        p->answer_time = control->answer_time;
    }
    return p;
}

void process_destroy(process *p)
{
    if (p != NULL) {
        kept_program_end(&p->program);
        free(p);
    }
}

void process_tell(process *p, const control_parameters *control)
{
    assert(p != NULL && control != NULL);
    p->control = *control;
    p->answer_time = control->answer_time;
}

const char *process_failure(const process *p)
{
    assert(p != NULL);
    return p->failure[0] != '\0' ? p->failure : NULL;
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
    if (p->program.keeper != 0) {
        drain_errors(p);
    }
    int exit_status = kept_program_end(&p->program);
    char ended[48] = "";
    if (exit_status >= 0) {
        snprintf(ended, sizeof ended, " (exit status %d)", exit_status);
    }
    const char *errors = p->errors + strspn(p->errors, " ");
    snprintf(p->failure, sizeof p->failure, "the process '%.200s' %s%s%s%s", p->control.command,
             why, ended, errors[0] != '\0' ? "; it said last: " : "", errors);
    make_printable(p->failure);
    return false;
}

// --- a question -------------------------------------------------------------------------------

static void set_number(json_t *object, const char *name, double value)
{
    json_object_set_new(object, name, json_number(value));
}

// What the program is told about the rig, under the names of controller_setup.
static json_t *setup_object(const controller_setup *s)
{
    json_t *object = json_object();

    // the sampling and the drive
    set_number(object, "period", s->period);
    set_number(object, "delay", s->delay);
    set_number(object, "voltage_limit", s->voltage_limit);
    set_number(object, "torque_per_volt", s->torque_per_volt);
    set_number(object, "hub_damping", s->hub_damping);
    set_number(object, "stiction", s->stiction);

    // the arm and the wall
    set_number(object, "hub_inertia", s->hub_inertia);
    set_number(object, "link_mass", s->link_mass);
    set_number(object, "link_length", s->link_length);
    set_number(object, "link_inertia", s->link_inertia);
    set_number(object, "k2", s->k2);
    set_number(object, "wall_angle", s->wall_angle);
    set_number(object, "links", s->links);
    set_number(object, "hub_spring", s->hub_spring);
    set_number(object, "damping_ratio", s->damping_ratio);
    return object;
}

// All numbers of control.*, by their names.
static json_t *control_object(const process *p)
{
    static const char group[] = "control.";
    parameters all = {.control = p->control};
    json_t *object = json_object();

    // from the table, so that a new parameter needs no line here
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        const bool number = info->type == PARAMETER_REAL || info->type == PARAMETER_INTEGER;
        if (number && strncmp(info->path, group, sizeof group - 1) == 0) {
            set_number(object, info->path + sizeof group - 1, parameter_get(&all, i));
        }
    }

    // as ramp and wave have it now, where the controller gets it from its setup
    set_number(object, "force", p->setup.parameters != NULL ? p->setup.parameters[0] : 0);
    return object;
}

// control.settings, NAME=VALUE: numbers where they are, else texts.
static json_t *settings_object(const process *p)
{
    json_t *object = json_object();
    const char *word = p->control.settings;
    while (*(word += strspn(word, " ")) != '\0') {
        char name[PARAMETER_TEXT_SIZE] = "", text[PARAMETER_TEXT_SIZE] = "";
        size_t length = strcspn(word, " "), name_length = strcspn(word, " =");
        memcpy(name, word, name_length);
        if (name_length < length) {
            memcpy(text, word + name_length + 1, length - name_length - 1);
        }

        double value;
        const char *rest;
        bool number = decimal_read(text, &value, &rest) && *rest == '\0';
        json_object_set_new(object, name, number ? json_number(value) : json_text(text));
        word += length;
    }
    return object;
}

// The line that asks for a command, to be freed; NULL without memory.
static char *question(const process *p, const controller_input *in)
{
    json_t *object = json_object();
    if (p->tells_setup) {
        json_object_set_new(object, "protocol", json_integer(PROTOCOL));
        json_object_set_new(object, "setup", setup_object(&p->setup));
        json_object_set_new(object, "control", control_object(p));
        json_object_set_new(object, "settings", settings_object(p));
    }

    // what a controller within the program would see
    set_number(object, "time", in->time);
    set_number(object, "encoder", in->encoder);
    set_number(object, "tachometer", in->tachometer);
    set_number(object, "force", in->force);
    set_number(object, "voltage", in->voltage);
    set_number(object, "piezo_force", in->piezo_force);
    set_number(object, "film", in->film);
    set_number(object, "accelerometer", in->accelerometer);

    // enough digits for every bit
    char *text = json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(17));
    json_decref(object);
    return text;
}

// --- an answer --------------------------------------------------------------------------------

static double now(void)
{
    return clock_seconds(CLOCK_MONOTONIC);
}

// What is left until a deadline, for poll [ms].
static int left_until(double deadline)
{
    double left = deadline - now();
    return left > 0 ? (int)ceil(fmin(left, 1e6) * 1e3) : 0;
}

// Reads what has come of the answer. False, with a failure, if there will be none.
static bool take_in(process *p)
{
    ssize_t count = read(p->program.output, p->line + p->length, MOST_LINE - p->length);
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) {
        return true;
    }

    // at its end it can say no more
    if (count <= 0) {
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

// Writes the question and waits for a whole line. False, with a failure, if none came in time.
static bool exchange(process *p, const char *text, size_t length)
{
    const double deadline = now() + p->answer_time;
    size_t sent = 0;
    bool errors_open = true;

    // all ends at once, as the program may wait at any of them
    while (memchr(p->line, '\n', p->length) == NULL || sent < length) {
        struct pollfd ends[] = {
            {.fd = p->program.output, .events = POLLIN},
            {.fd = errors_open ? p->program.errors : -1, .events = POLLIN},
            {.fd = sent < length ? p->program.input : -1, .events = POLLOUT},
        };

        // an end may be ready, and yet too late
        int ready = poll(ends, 3, left_until(deadline));
        if (now() >= deadline) {
            return fail(p, "gave no answer within control.answer_time = %g s", p->answer_time);
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

// A number of the answer: `missing` where there is none. False if it is no number.
static bool answered(const json_t *object, const char *name, double missing, double *value)
{
    const json_t *member = json_object_get(object, name);
    *value = json_is_number(member) ? json_number_value(member) : missing;
    return member == NULL || json_is_null(member) || json_is_number(member);
}

// What the line says. False, with a failure, if that is no answer.
static bool understand(process *p, controller_output *out)
{
    char *end = memchr(p->line, '\n', p->length);
    const size_t length = (size_t)(end - p->line);
    *end = '\0';
    json_error_t ignored;
    json_t *object = json_loadb(p->line, length, 0, &ignored);
    bool whole = json_is_object(object) && answered(object, "command", (double)NAN, &out->command);
    whole = whole && answered(object, "desired_angle", (double)NAN, &out->desired_angle) &&
            answered(object, "desired_velocity", (double)NAN, &out->desired_velocity) &&
            answered(object, "calculated_force", (double)NAN, &out->calculated_force) &&
            !isnan(out->command);
    json_decref(object);

    // lock step: one line for one line
    const bool more = length + 1 < p->length;
    p->length = 0;
    if (!whole) {
        return fail(p, "answered '%.*s', expected one line such as {\"command\": 1.5}",
                    SHOWN_OF_LINE, p->line);
    }
    return more ? fail(p, "answered more than one line to one sample") : true;
}

// --- the controller ---------------------------------------------------------------------------

// Its memory: the process, as the rig left it there.
typedef struct process_memory {
    process *process;
} process_memory;

static const char *take_setup(void *memory, const controller_setup *setup)
{
    process *p = ((process_memory *)memory)->process;
    p->setup = *setup;
    p->tells_setup = true;
    return NULL;
}

static const char *start(void *memory, const controller_setup *setup)
{
    process *p = ((process_memory *)memory)->process;
    int reason = kept_program_start(&p->program, p->control.command);
    if (reason != 0) {
        snprintf(p->failure, sizeof p->failure, "'%.200s' cannot be started: %s",
                 p->control.command, strerror(reason));
        return p->failure;
    }
    return take_setup(memory, setup);
}

static void sample(void *memory, const controller_input *in, controller_output *out)
{
    process *p = ((process_memory *)memory)->process;
    out->command = (double)NAN;
    char *text = p->failure[0] == '\0' ? question(p, in) : NULL;
    if (text == NULL) {
        return;
    }

    // its end becomes the line's
    size_t length = strlen(text);
    text[length] = '\n';
    p->tells_setup = false;
    if (exchange(p, text, length + 1)) {
        understand(p, out);
    }
    free(text);
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
