#include "src/rig/controller_values.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

#include "src/base/words.h"
#include "src/tables/settings.h"

// Index of control.NAME in the parameter table, -1 if the scenario has no such parameter.
static int scenario_parameter(const char *name)
{
    const size_t group = offsetof(parameters, control), behind = sizeof "control." - 1;
    int i = PARAMETER_INDEX(control.law); // the first of them
    for (; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        if (!(info->offset - group < sizeof(control_parameters))) {
            break;
        }
        if (info->path[behind] == name[0] && strcmp(info->path + behind, name) == 0) {
            return i;
        }
    }
    return -1;
}

// Where a controller gives only the name of a parameter, the rest comes from the table.
static bool has_only_a_name(const controller_parameter *c)
{
    return c->unit == NULL && c->description == NULL;
}

controller_parameter controller_parameter_at(const controller *law, int index)
{
    assert(index >= 0 && index < law->parameter_count);
    const controller_parameter *own = &law->parameters[index];
    if (!has_only_a_name(own)) {
        return *own;
    }

    // its name alone: the rest stands in the table of parameters
    int i = scenario_parameter(own->name);
    assert(i >= 0);
    const parameter_info *info = &parameter_table[i];
    return (controller_parameter){.name = own->name,
                                  .unit = info->unit,
                                  .initial = info->default_corrected,
                                  .minimum = info->minimum,
                                  .maximum = info->maximum,
                                  .description = info->description};
}

// --- control.settings ------------------------------------------------------------------

int controller_find_parameter(const controller *law, const char *name)
{
    return name_find(law->parameters, sizeof *law->parameters, law->parameter_count,
                     name);
}

const char *controller_takes_anything(void *memory, const controller_setup *setup)
{
    (void)memory, (void)setup;
    return NULL;
}

static status read_setting(const controller *law, const setting *s, double *values,
                           fault *f)
{
    int index = controller_find_parameter(law, s->name);
    if (index < 0) {
        const char *near = name_nearest(law->parameters, sizeof *law->parameters,
                                        law->parameter_count, s->name);
        char hint[HINT_TEXT];
        return fault_set(f, STATUS_BAD_SCENARIO,
                         "control.settings: the controller '%s' has no parameter '%s'%s",
                         law->name, s->name, did_you_mean(hint, near, ""));
    }

    // a number within the range, which is said with its unit
    const controller_parameter wanted = controller_parameter_at(law, index);
    const char *unit = wanted.unit != NULL ? wanted.unit : "";
    const char *space = unit[0] != '\0' ? " " : "";
    double value = 0;
    FAULT_IF(!setting_number(s, &value) ||
                 !(value >= wanted.minimum && value <= wanted.maximum),
             f, STATUS_BAD_SCENARIO,
             "control.settings: '%.*s' is wrong, expected %s=NUMBER from %g to %g%s%s",
             (int)s->length, s->word, wanted.name, wanted.minimum, wanted.maximum, space,
             unit);
    values[index] = value;
    return STATUS_OK;
}

status controller_values(const controller *law, const parameters *p, double *values,
                         fault *f)
{
    assert(values != NULL || law->parameter_count == 0);

    // the scenario's values, or the law's own
    for (int i = 0; i < law->parameter_count; i++) {
        const char *name = law->parameters[i].name;
        const int index = scenario_parameter(name);
        FAULT_IF(has_only_a_name(&law->parameters[i]) && index < 0, f,
                 STATUS_BAD_SCENARIO,
                 "the controller '%s' says of its parameter '%.60s' nothing but the "
                 "name, and there is no control.%.60s",
                 law->name, name, name);
        if (index >= 0 && (p->set[index] || has_only_a_name(&law->parameters[i]))) {
            values[i] = parameter_get(p, index);
        } else {
            values[i] = law->parameters[i].initial;
        }
    }

    // those that control.settings replaces; a process reads its settings itself
    status code = STATUS_OK;
    const char *rest = p->control.law == LAW_PROCESS ? "" : p->control.settings;
    setting s;
    while (code == STATUS_OK && settings_next(&rest, &s)) {
        code = read_setting(law, &s, values, f);
    }
    return code;
}
