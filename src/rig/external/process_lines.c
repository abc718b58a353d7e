#include "src/rig/external/process_lines.h"

#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/json.h"
#include "src/base/text_stream.h"
#include "src/tables/settings.h"

enum { PROTOCOL = 1 }; // of the lines, told in the first one

// --- a question -------------------------------------------------------------------------------

static void set_number(json_t *object, const char *name, double value)
{
    json_put(object, name, json_number(value));
}

// A number of a struct under its own name.
typedef struct named_number {
    const char *name;
    size_t offset;
} named_number;
#define NUMBER(type, field)                                                                        \
    {                                                                                              \
#field, offsetof(type, field)                                                              \
    }

// Puts numbers of a struct into an object.
static void set_numbers(json_t *object, const void *from, const named_number *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const double *value = (const double *)((const char *)from + numbers[i].offset);
        set_number(object, numbers[i].name, *value);
    }
}

// What the program is told about the rig.
static json_t *setup_object(const controller_setup *s)
{
#define TOLD(field) NUMBER(controller_setup, field)
    static const named_number numbers[] = {
        TOLD(period),          TOLD(delay),        TOLD(voltage_limit),
        TOLD(torque_per_volt), TOLD(hub_damping),  TOLD(stiction),
        TOLD(hub_inertia),     TOLD(link_mass),    TOLD(link_length),
        TOLD(link_inertia),    TOLD(k2),           TOLD(wall_angle),
        TOLD(hub_spring),      TOLD(damping_ratio)};
#undef TOLD
    json_t *object = json_object();
    set_numbers(object, s, numbers, sizeof numbers / sizeof numbers[0]);
    set_number(object, "links", s->links);
    return object;
}

// All numbers of control.*, by their names.
static json_t *control_object(const control_parameters *control, const controller_setup *setup)
{
    static const char group[] = "control.";
    parameters all = {.control = *control};
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
    set_number(object, "force", setup->parameters != NULL ? setup->parameters[0] : 0);
    return object;
}

// control.settings, NAME=VALUE: numbers where they are, else texts.
static json_t *settings_object(const control_parameters *control)
{
    json_t *object = json_object();
    const char *rest = control->settings;
    setting s;
    while (settings_next(&rest, &s)) {
        double value;
        const bool number = setting_number(&s, &value);
        json_put(object, s.name, number ? json_number(value) : json_text(s.value));
    }
    return object;
}

char *process_question(const controller_setup *setup, const control_parameters *control,
                       const controller_input *in)
{
    const bool lost_before = loss_noted(); // of other output on this thread
    json_t *object = json_object();
    if (setup != NULL) {
        json_put(object, "protocol", json_integer(PROTOCOL));
        json_put(object, "setup", setup_object(setup));
        json_put(object, "control", control_object(control, setup));
        json_put(object, "settings", settings_object(control));
    }

    // what a controller within the program would see
#define SEEN(field) NUMBER(controller_input, field)
    static const named_number seen[] = {SEEN(time),  SEEN(encoder),       SEEN(tachometer),
                                        SEEN(force), SEEN(voltage),       SEEN(piezo_force),
                                        SEEN(film),  SEEN(accelerometer), SEEN(predicted_force)};
#undef SEEN
    set_numbers(object, in, seen, sizeof seen / sizeof seen[0]);

    // enough digits for every bit
    char *line = NULL, *text = json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(17));
    json_decref(object);
    const bool whole = !loss_noted() && text != NULL;
    loss_unless(!lost_before);
    if (!whole || asprintf(&line, "%s\n", text) < 0) {
        line = NULL;
    }
    free(text);
    return line;
}

// --- an answer --------------------------------------------------------------------------------

// The numbers of an answer.
#define ANSWERED(field) NUMBER(controller_output, field)
static const named_number answers[] = {ANSWERED(command), ANSWERED(desired_angle),
                                       ANSWERED(desired_velocity), ANSWERED(calculated_force)};
#undef ANSWERED
enum { ANSWERS = sizeof answers / sizeof answers[0] };

status process_read_answer(const char *line, size_t length, controller_output *out)
{
    json_error_t ignored;
    errno = 0;
    json_t *object = json_loadb(line, length, 0, &ignored);

    // jansson says of a line that it had no memory for what it says of a wrong one
    if (object == NULL && errno == ENOMEM) {
        return STATUS_NO_MEMORY;
    }

    // what is there must be a number
    bool whole = json_is_object(object);
    for (int i = 0; i < ANSWERS && whole; i++) {
        const json_t *member = json_object_get(object, answers[i].name);
        double *value = (double *)((char *)out + answers[i].offset);
        *value = json_is_number(member) ? json_number_value(member) : (double)NAN;
        whole = member == NULL || json_is_null(member) || json_is_number(member);
    }
    json_decref(object);
    return whole && !isnan(out->command) ? STATUS_OK : STATUS_CONTROLLER_FAILED;
}

bool process_same_answer(const controller_output *a, const controller_output *b)
{
    bool same = true;
    for (int i = 0; i < ANSWERS; i++) {
        const size_t at = answers[i].offset;
        same = same && memcmp((const char *)a + at, (const char *)b + at, sizeof(double)) == 0;
    }
    return same;
}

// --- transcripts -----------------------------------------------------------------------------

static const size_t most_text = (size_t)64 << 20; // of all questions [bytes]

transcript_node *process_transcript_find(const transcript_node *before, const char *question)
{
    transcript_node *after = before != NULL ? before->first_after : NULL;
    while (after != NULL && strcmp(after->question, question) != 0) {
        after = after->next_beside;
    }
    return after;
}

// A new node of the tree; NULL without memory, or where the transcript is full.
static transcript_node *new_node(process_transcript *t, const char *question)
{
    const size_t length = strlen(question);
    transcript_node *node =
        t->size + length <= most_text ? calloc(1, sizeof *node + length + 1) : NULL;
    if (node != NULL) {
        memcpy(node->question, question, length);
        node->made_before = t->last;
        t->last = node;
        t->size += length;
    }
    return node;
}

process_transcript *process_transcript_create(void)
{
    process_transcript *t = calloc(1, sizeof *t);
    if (t != NULL && (t->begin = new_node(t, "")) == NULL) {
        free(t);
        return NULL;
    }
    return t;
}

void process_transcript_destroy(process_transcript *t)
{
    while (t != NULL && t->last != NULL) {
        transcript_node *node = t->last;
        t->last = node->made_before;
        free(node);
    }
    free(t);
}

transcript_node *process_transcript_add(process_transcript *t, transcript_node *before,
                                        const char *question, const controller_output *answer)
{
    transcript_node *node = before != NULL ? new_node(t, question) : NULL;
    if (node != NULL) {
        node->before = before;
        node->answer = *answer;

        // the newest is looked at first
        node->next_beside = before->first_after;
        before->first_after = node;
    }
    return node;
}
