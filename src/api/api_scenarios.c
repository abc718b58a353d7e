// Scenarios of libimpactlab: opened or made, changed and asked.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/api/api_handles.h"
#include "src/base/numbers.h"
#include "src/rig/rig.h"

// --- opening ---------------------------------------------------------------------------

int impactlab_scenario_names(char ***names, size_t *count, impactlab_error *error)
{
    API_NEEDS(error, names, count);
    int found = 0;
    *count = 0;
    fault f = {.text = "", .path = ""};
    if (scenario_list(names, &found, &f) != STATUS_OK) {
        return api_error(error, &f);
    }
    *count = (size_t)found;
    return api_done(error);
}

void impactlab_names_free(char **names, size_t count)
{
    for (size_t i = 0; names != NULL && i < count; i++) {
        free(names[i]);
    }
    free(names);
}

// Allocates a handle, into which a scenario will be read. NULL, with an error, without
// memory.
static impactlab_scenario *new_handle(impactlab_scenario **handle, impactlab_error *error)
{
    *handle = calloc(1, sizeof **handle);
    if (*handle == NULL) {
        api_fail(error, STATUS_NO_MEMORY, "no memory for a scenario");
    }
    return *handle;
}

// Writes the title of a scenario with its changes into the handle. Returns IMPACTLAB_OK.
static int update_title(impactlab_scenario *handle, impactlab_error *error)
{
    scenario_titled(&handle->scenario, handle->title);
    return api_done(error);
}

// Ends the reading of a scenario, whose outcome is `code`: completes the handle, or frees
// it and reports the first fault.
static int finish_reading(impactlab_scenario **handle, status code, fault *first,
                          impactlab_error *error)
{
    if (code == STATUS_OK) {
        return update_title(*handle, error);
    }
    const fault_place at = (*handle)->scenario.refused;
    free(*handle);
    *handle = NULL;
    return api_refused(error, first, &at, code);
}

int impactlab_scenario_open(impactlab_scenario **handle, const char *name_or_file,
                            impactlab_error *error)
{
    API_NEEDS(error, handle);
    *handle = NULL;
    API_NEEDS(error, name_or_file);
    if (new_handle(handle, error) == NULL) {
        return IMPACTLAB_NO_MEMORY;
    }
    fault first = {.code = STATUS_OK};
    status code =
        scenario_open(&(*handle)->scenario, name_or_file, keep_first_fault, &first);
    return finish_reading(handle, code, &first, error);
}

int impactlab_scenario_parse(impactlab_scenario **handle, const char *text, size_t length,
                             impactlab_error *error)
{
    return impactlab_scenario_parse_named(handle, text, length, "text", error);
}

int impactlab_scenario_parse_named(impactlab_scenario **handle, const char *text,
                                   size_t length, const char *name,
                                   impactlab_error *error)
{
    API_NEEDS(error, handle);
    *handle = NULL;
    API_NEEDS(error, text, name);
    if (new_handle(handle, error) == NULL) {
        return IMPACTLAB_NO_MEMORY;
    }
    fault first = {.code = STATUS_OK};
    status code = scenario_parse(&(*handle)->scenario, text, length, "text", name,
                                 keep_first_fault, &first);
    return finish_reading(handle, code, &first, error);
}

int impactlab_scenario_create(impactlab_scenario **handle, impactlab_error *error)
{
    static const char empty[] = "title: made by a program\n";
    return impactlab_scenario_parse(handle, empty, sizeof empty - 1, error);
}

int impactlab_scenario_copy(impactlab_scenario **handle, const impactlab_scenario *from,
                            impactlab_error *error)
{
    API_NEEDS(error, handle);
    *handle = NULL;
    API_NEEDS(error, from);

    // after a fault the caller has nothing to destroy
    if (new_handle(handle, error) == NULL) {
        return IMPACTLAB_NO_MEMORY;
    }
    if (scenario_copy(&(*handle)->scenario, &from->scenario) != STATUS_OK) {
        free(*handle);
        *handle = NULL;
        return api_fail(error, STATUS_NO_MEMORY, "no memory for a scenario");
    }
    return update_title(*handle, error);
}

void impactlab_scenario_destroy(impactlab_scenario *handle)
{
    if (handle != NULL) {
        scenario_finish(&handle->scenario);
        free(handle);
    }
}

void impactlab_scenario_allow_code(impactlab_scenario *handle, int allowed)
{
    if (handle != NULL) {
        handle->scenario.parameters.code_allowed = allowed != 0;
    }
}

void impactlab_scenario_stop_when(impactlab_scenario *handle,
                                  impactlab_stop_question question, void *context)
{
    if (handle != NULL) {
        handle->ask = question;
        handle->ask_context = context;
    }
}

// --- asking ----------------------------------------------------------------------------

const char *impactlab_scenario_name(const impactlab_scenario *handle)
{
    if (handle != NULL) {
        return handle->scenario.name;
    }
    return "";
}

const char *impactlab_scenario_title(const impactlab_scenario *handle)
{
    if (handle != NULL) {
        return handle->title;
    }
    return "";
}

const char *impactlab_scenario_description(const impactlab_scenario *handle)
{
    if (handle != NULL) {
        return handle->scenario.description;
    }
    return "";
}

int impactlab_scenario_number(const impactlab_scenario *handle, const char *path,
                              double *value, impactlab_error *error)
{
    API_NEEDS(error, handle, path, value);
    sweep_axis axis;
    TRY((status)api_axis(path, &axis, error));
    *value = sweep_axis_get(&axis, &handle->scenario.parameters);
    return api_done(error);
}

int impactlab_scenario_text(const impactlab_scenario *handle, const char *path,
                            char *text, size_t size, impactlab_error *error)
{
    API_NEEDS(error, handle, path, text);
    sweep_axis axis;
    TRY((status)api_axis(path, &axis, error));

    // the whole value, or none if there is no room for it
    const parameters *p = &handle->scenario.parameters;
    char whole[PARAMETER_VALUE_SIZE] = "";
    double value;
    if (settings_name(path) == NULL) {
        parameter_format(p, axis.parameter, whole, sizeof whole);
    } else if (settings_get(p, settings_name(path), &value)) {
        number_format_short(whole, value);
    }
    size_t length = strlen(whole) + 1;
    if (length > size) {
        return api_fail(error, STATUS_BAD_ARGUMENT,
                        "the value of %s takes %zu bytes, but there is room for %zu",
                        path, length, size);
    }
    memcpy(text, whole, length);
    return api_done(error);
}

int impactlab_scenario_is_set(const impactlab_scenario *handle, const char *path)
{
    const char *name;
    double value;
    int index = handle != NULL && path != NULL ? settings_look_up(path, &name, NULL) : -1;
    return index >= 0 && handle->scenario.parameters.set[index] != 0 &&
           (name == NULL || settings_get(&handle->scenario.parameters, name, &value));
}

// api_text's writer: the scenario as YAML.
static void write_yaml(FILE *stream, const void *what)
{
    scenario_write(stream, what);
}

int impactlab_scenario_yaml(const impactlab_scenario *handle, char **yaml,
                            impactlab_error *error)
{
    API_NEEDS(error, handle, yaml);
    return api_text(yaml, write_yaml, &handle->scenario, error);
}

// --- changing --------------------------------------------------------------------------

int impactlab_scenario_set_all(impactlab_scenario *handle, const char *const *assignments,
                               size_t count, impactlab_error *error)
{
    API_NEEDS(error, handle);
    if (count == 0) {
        return api_done(error);
    }

    // every assignment must be there
    API_NEEDS(error, assignments);
    SCOPED(free_kept) char **given = calloc(count, sizeof *given);
    if (given == NULL) {
        return api_fail(error, STATUS_NO_MEMORY, "no memory for %zu assignments", count);
    }
    bool whole = true;
    for (size_t i = 0; i < count; i++) {
        given[i] = (char *)assignments[i];
        whole = whole && given[i] != NULL;
    }

    // if one of them is wrong, the parameters are restored
    const parameters before = handle->scenario.parameters;
    fault first = {.code = STATUS_OK};
    status code = STATUS_BAD_ARGUMENT;
    if (whole) {
        code = scenario_override_all(&handle->scenario, given, (int)count,
                                     keep_first_fault, &first);
    }
    if (code == STATUS_OK) {
        return update_title(handle, error);
    }
    handle->scenario.parameters = before;
    if (!whole) {
        return api_missing(error, "assignments[i]", 0);
    }
    return api_refused(error, &first, &handle->scenario.refused, code);
}

int impactlab_scenario_set(impactlab_scenario *handle, const char *path, const char *text,
                           impactlab_error *error)
{
    API_NEEDS(error, text, handle, path);
    char room[PARAMETER_TEXT_SIZE];
    const int index = api_parameter(path, &text, room, error);
    if (index < 0) {
        return IMPACTLAB_BAD_ARGUMENT;
    }

    // on a copy, so that a refused value changes nothing
    parameters p = handle->scenario.parameters;
    fault f = {.text = "", .path = ""};
    if (parameter_set_text(&p, index, text, &f) != STATUS_OK) {
        return api_error(error, &f);
    }
    if (scenario_take_parameters(&handle->scenario, &p, &f) != STATUS_OK) {
        return api_error(error, &f);
    }
    return update_title(handle, error);
}

int impactlab_scenario_set_number(impactlab_scenario *handle, const char *path,
                                  double value, impactlab_error *error)
{
    API_NEEDS(error, handle, path);
    sweep_axis axis;
    TRY((status)api_axis(path, &axis, error));
    parameters p = handle->scenario.parameters;
    fault f = {.text = "", .path = ""};
    if (sweep_axis_apply(&axis, value, &p, &f) != STATUS_OK) {
        return api_error(error, &f);
    }
    if (scenario_take_parameters(&handle->scenario, &p, &f) != STATUS_OK) {
        return api_error(error, &f);
    }
    return update_title(handle, error);
}

// Makes room for one more action of the script. False without memory.
static bool make_room_for_action(scenario *s)
{
    action *grown = realloc(s->actions, (size_t)(s->action_count + 1) * sizeof *grown);
    if (grown != NULL) {
        s->actions = grown;
    }
    return grown != NULL;
}

// Checks that an instant [s] is within the run.
static int check_instant(const scenario *s, double time, impactlab_error *error)
{
    if (!(time >= 0 && time <= s->parameters.run.duration)) {
        return api_fail(error, STATUS_BAD_ARGUMENT,
                        "the instant %g s is not within the run, expected 0 to %g s",
                        time, s->parameters.run.duration);
    }
    return IMPACTLAB_OK;
}

int impactlab_scenario_add_change(impactlab_scenario *handle, double time,
                                  const char *path, const char *text,
                                  impactlab_error *error)
{
    API_NEEDS(error, handle, path, text);
    scenario *s = &handle->scenario;
    char room[PARAMETER_TEXT_SIZE];
    const int index = api_parameter(path, &text, room, error);
    if (index < 0 || check_instant(s, time, error) != IMPACTLAB_OK) {
        return IMPACTLAB_BAD_ARGUMENT;
    }
    if (!rig_can_change(&s->parameters, index)) {
        return api_fail(error, STATUS_BAD_ARGUMENT,
                        "%s holds from the start and cannot change during a run", path);
    }

    // the value, checked and converted by the parameters in force at that time
    parameters p = scenario_parameters_at(s, time);
    fault f = {.text = "", .path = ""};
    if (parameter_may_change(&p, index, &f) != STATUS_OK) {
        return api_error(error, &f);
    }
    if (parameter_set_text(&p, index, text, &f) != STATUS_OK) {
        return api_error(error, &f);
    }
    action a = action_of(time, &p, index, text);
    a.added = true;

    if (!make_room_for_action(s)) {
        return api_fail(error, STATUS_NO_MEMORY, "no memory for the script");
    }
    scenario_insert_action(s, a);
    return update_title(handle, error);
}

int impactlab_scenario_add_push(impactlab_scenario *handle, double time, double impulse,
                                impactlab_error *error)
{
    API_NEEDS(error, handle);
    scenario *s = &handle->scenario;
    if (check_instant(s, time, error) != IMPACTLAB_OK) {
        return IMPACTLAB_BAD_ARGUMENT;
    }

    // an impulse that the model can take
    if (!isfinite(impulse)) {
        return api_fail(error, STATUS_BAD_ARGUMENT,
                        "the impulse is not finite, expected N s");
    }
    if (s->parameters.arm.model == ARM_PRINTED) {
        return api_fail(error, STATUS_BAD_SCENARIO, "the printed model takes no pushes");
    }

    // then into the script
    if (!make_room_for_action(s)) {
        return api_fail(error, STATUS_NO_MEMORY, "no memory for the script");
    }
    scenario_insert_action(s, (action){.time = time,
                                       .kind = ACTION_PUSH,
                                       .parameter = -1,
                                       .value = impulse,
                                       .added = true});
    return update_title(handle, error);
}
