#include "src/rig/external/process_lines.h"

#include <assert.h>
#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/json.h"
#include "src/base/loss.h"
#include "src/base/numbers.h"
#include "src/rig/controller_values.h"

enum { PROTOCOL = 1 }; // of the lines, told in the first one

// --- a question -------------------------------------------------------------------------------

static void set_number(json_t *object, const char *name, double value)
{
    json_put(object, name, json_number(value));
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
    controller_setting s;
    while (controller_next_setting(&rest, &s)) {
        double value;
        const char *end;
        bool number = decimal_read(s.value, &value, &end) && *end == '\0';
        json_put(object, s.name, number ? json_number(value) : json_text(s.value));
    }
    return object;
}

char *process_question(const controller_setup *setup, const control_parameters *control,
                       const controller_input *in)
{
    assert(control != NULL && in != NULL);
    const bool lost_before = loss_noted(); // of other output on this thread
    json_t *object = json_object();
    if (setup != NULL) {
        json_put(object, "protocol", json_integer(PROTOCOL));
        json_put(object, "setup", setup_object(setup));
        json_put(object, "control", control_object(control, setup));
        json_put(object, "settings", settings_object(control));
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
    set_number(object, "predicted_force", in->predicted_force);

    // enough digits for every bit
    char *text = json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(17));
    json_decref(object);
    const bool whole = !loss_noted() && text != NULL;
    loss_unless(!lost_before);
    const size_t length = whole ? strlen(text) : 0;
    char *line = whole ? realloc(text, length + 2) : NULL;
    if (line == NULL) {
        free(text);
        return NULL;
    }
    memcpy(line + length, "\n", 2);
    return line;
}

// --- an answer --------------------------------------------------------------------------------

// A number of the answer: `missing` where there is none. False if it is no number.
static bool answered(const json_t *object, const char *name, double missing, double *value)
{
    const json_t *member = json_object_get(object, name);
    *value = json_is_number(member) ? json_number_value(member) : missing;
    return member == NULL || json_is_null(member) || json_is_number(member);
}

process_answer process_read_answer(const char *line, size_t length, controller_output *out)
{
    assert(line != NULL && out != NULL);
    json_error_t ignored;
    errno = 0;
    json_t *object = json_loadb(line, length, 0, &ignored);

    // jansson says of a line that it had no memory for what it says of a wrong one
    if (object == NULL && errno == ENOMEM) {
        return PROCESS_NO_MEMORY;
    }
    bool whole = json_is_object(object) && answered(object, "command", (double)NAN, &out->command);
    whole = whole && answered(object, "desired_angle", (double)NAN, &out->desired_angle) &&
            answered(object, "desired_velocity", (double)NAN, &out->desired_velocity) &&
            answered(object, "calculated_force", (double)NAN, &out->calculated_force) &&
            !isnan(out->command);
    json_decref(object);
    return whole ? PROCESS_ANSWERED : PROCESS_BABBLED;
}
