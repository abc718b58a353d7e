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

// --- a question ------------------------------------------------------------------------

// What the program is told about the rig.
static json_t *setup_object(const controller_setup *s)
{
    return json_members(
        json_object(),
        "period:n delay:n voltage_limit:n torque_per_volt:n hub_damping:n "
        "stiction:n hub_inertia:n link_mass:n link_length:n link_inertia:n "
        "k2:n wall_angle:n hub_spring:n damping_ratio:n links:n",
        s->period, s->delay, s->voltage_limit, s->torque_per_volt, s->hub_damping,
        s->stiction, s->hub_inertia, s->link_mass, s->link_length, s->link_inertia, s->k2,
        s->wall_angle, s->hub_spring, s->damping_ratio, (double)s->links);
}

// All numbers of control.*, by their names.
static json_t *control_object(const control_parameters *control,
                              const controller_setup *setup)
{
    static const char group[] = "control.";
    parameters all = {.control = *control};
    json_t *object = json_object();

    // from the table, so that a new parameter needs no line here
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        const bool number =
            info->type == PARAMETER_REAL || info->type == PARAMETER_INTEGER;
        if (number && strncmp(info->path, group, sizeof group - 1) == 0) {
            json_put(object, info->path + sizeof group - 1,
                     json_number(parameter_get(&all, i)));
        }
    }

    // as ramp and wave have it now, where the controller gets it from its setup
    json_put(object, "force",
             json_number(setup->parameters != NULL ? setup->parameters[0] : 0));
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
    json_members(object,
                 "time:n encoder:n tachometer:n force:n voltage:n piezo_force:n "
                 "film:n accelerometer:n predicted_force:n",
                 in->time, in->encoder, in->tachometer, in->force, in->voltage,
                 in->piezo_force, in->film, in->accelerometer, in->predicted_force);

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

// --- an answer -------------------------------------------------------------------------

// A number of an answer; NaN where it has none. False if something else stands there.
static bool read_number(const json_t *answer, const char *name, double *value)
{
    const json_t *member = json_object_get(answer, name);
    *value = (double)NAN;
    if (member == NULL || json_is_null(member)) {
        return true;
    }
    if (json_is_number(member)) {
        *value = json_number_value(member);
    }
    return json_is_number(member);
}

status process_read_answer(const char *line, size_t length, controller_output *out)
{
    json_error_t ignored;
    errno = 0;
    json_t *answer = json_loadb(line, length, 0, &ignored);

    // jansson says of a line that it had no memory for what it says of a wrong one
    if (answer == NULL && errno == ENOMEM) {
        return STATUS_NO_MEMORY;
    }

    const bool whole = json_is_object(answer) &&
                       read_number(answer, "command", &out->command) &&
                       read_number(answer, "desired_angle", &out->desired_angle) &&
                       read_number(answer, "desired_velocity", &out->desired_velocity) &&
                       read_number(answer, "calculated_force", &out->calculated_force);
    json_decref(answer);
    if (!whole || isnan(out->command)) {
        return STATUS_CONTROLLER_FAILED;
    }
    return STATUS_OK;
}
