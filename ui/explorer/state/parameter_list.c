#include "ui/explorer/state/parameter_list.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "src/rig/controller.h"
#include "src/rig/rig.h"
#include "ui/explorer/state/view.h"

// Bytes of the group's name at the beginning of a path.
static size_t group_length(int parameter)
{
    return strcspn(parameter_table[parameter].path, ".");
}

static bool begins_group(int parameter)
{
    if (parameter == 0) {
        return true;
    }
    const size_t length = group_length(parameter);
    return length != group_length(parameter - 1) ||
           strncmp(parameter_table[parameter].path, parameter_table[parameter - 1].path, length);
}

int parameter_group(int parameter)
{
    assert(parameter >= 0 && parameter < parameter_count);
    int group = -1;
    for (int i = 0; i <= parameter; i++) {
        group += begins_group(i);
    }
    assert(group < PARAMETER_GROUPS);
    return group;
}

void parameter_group_name(int parameter, char *name, size_t size)
{
    assert(parameter >= 0 && parameter < parameter_count);
    snprintf(name, size, "%.*s", (int)group_length(parameter), parameter_table[parameter].path);
}

// The first parameter of a parameter's group.
static int group_begin(int parameter)
{
    while (!begins_group(parameter)) {
        parameter--;
    }
    return parameter;
}

static bool is_long_group(int parameter)
{
    char name[PARAMETER_NAME];
    parameter_group_name(parameter, name, sizeof name);
    return strcmp(name, "sensor") == 0 || strcmp(name, "belief") == 0;
}

void parameter_list_arrange(parameter_list *list, const parameters *p, int selected)
{
    assert(selected >= 0 && selected < parameter_count);

    // groups without effect are folded, and long ones in which nothing was set
    for (int first = 0, next; first < parameter_count; first = next) {
        bool used = false, given = false;
        for (next = first; next == first || (next < parameter_count && !begins_group(next));
             next++) {
            used = used || inert_reason(p, next) == NULL;
            given = given || p->set[next] != 0;
        }
        list->folded[parameter_group(first)] = !used || (is_long_group(first) && !given);
    }

    // the selected one must still be visible
    list->parameter = selected;
    list->on_heading = false;
    list->folded[parameter_group(selected)] = false;
}

int parameter_list_lines(const parameter_list *list, const char *filter,
                         parameter_line lines[PARAMETER_LINES])
{
    int count = 0, group = -1;
    bool headed = false;
    for (int i = 0; i < parameter_count && count + 2 <= PARAMETER_LINES; i++) {
        const parameter_info *info = &parameter_table[i];
        char text[512];
        if (begins_group(i)) {
            group++;
            headed = false;
        }
        snprintf(text, sizeof text, "%s %s", info->path, info->description);
        if (filter[0] != '\0' && !filter_passes(filter, text)) {
            continue;
        }

        // a group's heading before its first line that passes the filter
        if (!headed) {
            lines[count++] = (parameter_line){group_begin(i), true};
            headed = true;
        }
        if (filter[0] != '\0' || !list->folded[group]) {
            lines[count++] = (parameter_line){i, false};
        }
    }
    return count;
}

int parameter_list_selected(const parameter_list *list, const parameter_line *lines, int count)
{
    const int group = parameter_group(list->parameter);
    int heading = 0;

    // itself, else its group's heading
    for (int i = 0; i < count; i++) {
        const bool own_group = parameter_group(lines[i].parameter) == group;
        if (lines[i].heading && own_group) {
            heading = i;
            if (list->on_heading) {
                return i;
            }
        } else if (lines[i].parameter == list->parameter && !list->on_heading) {
            return i;
        }
    }
    return heading;
}

void parameter_list_select(parameter_list *list, parameter_line line)
{
    assert(line.parameter >= 0 && line.parameter < parameter_count);
    list->parameter = line.parameter;
    list->on_heading = line.heading;
    if (!line.heading) {
        list->folded[parameter_group(line.parameter)] = false;
    }
}

void parameter_list_fold(parameter_list *list, int parameter)
{
    assert(parameter >= 0 && parameter < parameter_count);
    bool *folded = &list->folded[parameter_group(parameter)];
    *folded = !*folded;
    list->parameter = group_begin(parameter);
    list->on_heading = true;
}

int parameter_of_name(const char *name)
{
    const int exact = parameter_find(name);
    const size_t length = strlen(name);
    int found[3] = {-1, -1, -1}, count[3] = {0};
    if (exact >= 0 || length == 0) {
        return exact;
    }

    // the last part, a beginning of it, a beginning of the path: in this order
    for (int i = 0; i < parameter_count; i++) {
        const char *path = parameter_table[i].path, *leaf = strchr(path, '.') + 1;
        const bool fits[3] = {strcmp(leaf, name) == 0, strncmp(leaf, name, length) == 0,
                              strncmp(path, name, length) == 0};
        for (int k = 0; k < 3; k++) {
            found[k] = fits[k] ? i : found[k];
            count[k] += fits[k];
        }
    }
    for (int k = 0; k < 3; k++) {
        if (count[k] > 0) {
            return count[k] == 1 ? found[k] : -2;
        }
    }
    return -1;
}

// --- sliders ----------------------------------------------------------------------------------

bool slider_scale_of(int parameter, double value, slider_scale *scale)
{
    return parameter_usual_range(parameter, value, &scale->low, &scale->high, &scale->logarithmic);
}

double slider_share(const slider_scale *scale, double value)
{
    assert(scale->high > scale->low);
    double share = scale->logarithmic ? log(value / scale->low) / log(scale->high / scale->low)
                                      : (value - scale->low) / (scale->high - scale->low);
    return fmax(0, fmin(1, share));
}

double slider_value(const slider_scale *scale, int parameter, double share, int cells)
{
    assert(parameter >= 0 && parameter < parameter_count);
    const parameter_info *info = &parameter_table[parameter];
    double value, step;
    share = fmax(0, fmin(1, share));

    // the share on its scale, and the step that a cell can tell
    if (scale->logarithmic) {
        value = scale->low * pow(scale->high / scale->low, share);
        step = pow(10, floor(log10(value)) - 1);
    } else {
        double width = scale->high - scale->low;
        value = scale->low + share * width;
        step = pow(10, floor(log10(width / (cells > 1 ? cells : 1))));
    }

    // whole steps, within what the table allows
    step = info->type == PARAMETER_INTEGER ? 1 : step;
    value = step * round(value / step);
    return fmax(info->minimum, fmin(info->maximum, value));
}

// --- parameters without effect ----------------------------------------------------------------

// Whether a parameter is a field of struct parameters, or one of a group that is.
#define IS_OF(parameter, field)                                                                    \
    lies_in(parameter, offsetof(parameters, field), sizeof(((parameters *)0)->field))

static bool lies_in(int parameter, size_t from, size_t size)
{
    const size_t offset = parameter_table[parameter].offset;
    return offset >= from && offset < from + size;
}

// Why something has no effect, if that is so.
typedef struct rule {
    bool applies;
    const char *reason;
} rule;

// The reason of the first rule that applies; NULL if none does.
static const char *first_reason(const rule *rules, size_t count)
{
    const char *reason = NULL;
    for (size_t i = 0; i < count && reason == NULL; i++) {
        reason = rules[i].applies ? rules[i].reason : NULL;
    }
    return reason;
}
#define FIRST_REASON(rules) first_reason(rules, sizeof rules / sizeof rules[0])

// What the arm, its wall and the method leave aside.
static const char *reason_of_arm(const parameters *p, int parameter)
{
    const bool of_newmark = IS_OF(parameter, method.beta) || IS_OF(parameter, method.gamma);
    const bool of_joints =
        IS_OF(parameter, arm.k2) || IS_OF(parameter, arm.EI) || IS_OF(parameter, arm.stiffening);
    const bool of_springs =
        IS_OF(parameter, arm.damping_ratio) || IS_OF(parameter, arm.modal_ratios);
    const bool without = p->arm.links == 1 && ((of_joints && p->arm.hub_joint != HUB_BEAM) ||
                                               (of_springs && p->arm.hub_joint == HUB_RIGID));
    const bool of_wall = IS_OF(parameter, wall) && !IS_OF(parameter, wall.kind);

    // parts that this arm does not have, then numbers of other methods
    const rule rules[] = {
        {IS_OF(parameter, printed) && p->arm.model != ARM_PRINTED,
         "it belongs to arm.model = printed"},
        {IS_OF(parameter, arm.k1) && p->arm.hub_joint != HUB_SPRING,
         "the hub joint is rigid (arm.hub_joint)"},
        {IS_OF(parameter, arm.link_inertia) && p->arm.links != 2, "it is for two links"},
        {without, "one link has no joint"},
        {of_wall && p->wall.kind == WALL_NONE, "there is no wall (wall.kind)"},
        {IS_OF(parameter, motor.transconductance) && p->motor.drive != DRIVE_CURRENT,
         "it belongs to motor.drive = current"},
        {of_newmark && p->method.name != METHOD_NEWMARK, "it belongs to method.name = newmark"},
        {IS_OF(parameter, method.spectral_radius) && p->method.name != METHOD_GENERALIZED_ALPHA,
         "it belongs to method.name = generalized-alpha"}};
    return FIRST_REASON(rules);
}

// Whether a parameter is one of some fields, by where it lies.
static bool is_among(int parameter, const size_t *fields, size_t count)
{
    bool found = false;
    for (size_t i = 0; i < count; i++) {
        found = found || parameter_table[parameter].offset == fields[i];
    }
    return found;
}

#define FIELD(field)                offsetof(parameters, field)
#define IS_AMONG(parameter, fields) is_among(parameter, fields, sizeof fields / sizeof fields[0])

// What means the same under every law.
static const size_t every_law[] = {
    FIELD(control.law),        FIELD(control.settings),        FIELD(control.rate),
    FIELD(control.delay),      FIELD(control.delay_periods),   FIELD(control.jitter),
    FIELD(control.seed),       FIELD(control.force),           FIELD(control.k2_table),
    FIELD(control.force_rate), FIELD(control.force_amplitude), FIELD(control.force_frequency)};

// What the control law does not read.
static const char *reason_of_control(const parameters *p, int parameter)
{
    const controller *law = controller_of(p->control.law);
    const char *name = strchr(parameter_table[parameter].path, '.') + 1;
    if (IS_OF(parameter, control.plugin)) {
        return p->control.law == LAW_PLUGIN ? NULL : "it belongs to control.law = plugin";
    }
    if (IS_OF(parameter, control.command) || IS_OF(parameter, control.answer_time)) {
        return p->control.law == LAW_PROCESS ? NULL : "it belongs to control.law = process";
    }
    if (strncmp(name, "playback_", 9) == 0) {
        return p->control.law == LAW_PLAYBACK ? NULL : "it belongs to control.law = playback";
    }
    if (law == NULL || IS_AMONG(parameter, every_law)) {
        return NULL;
    }
    if (IS_OF(parameter, control.lock)) {
        return law->lockable ? NULL : "this law cannot be held in a mode";
    }

    // what this one says it reads
    for (int i = 0; i < law->parameter_count; i++) {
        if (strcmp(law->parameters[i].name, name) == 0) {
            return NULL;
        }
    }
    return "the control law does not use it";
}

// The parameters of sensors that need not be fitted, the gain first, and the faults of the others.
#define SENSOR(field) FIELD(sensor.field)
static const size_t piezo[] = {
    SENSOR(piezo_gain),  SENSOR(piezo_rise_time),  SENSOR(piezo_leak_time), SENSOR(piezo_range),
    SENSOR(piezo_noise), SENSOR(piezo_gain_error), SENSOR(piezo_offset)};
static const size_t film[] = {SENSOR(film_gain), SENSOR(film_leak_time), SENSOR(film_noise)};
static const size_t accelerometer[] = {SENSOR(accelerometer_gain), SENSOR(accelerometer_rise_time),
                                       SENSOR(accelerometer_range), SENSOR(accelerometer_noise)};
static const size_t others[] = {SENSOR(encoder_counts),
                                SENSOR(tachometer_ripple),
                                SENSOR(tachometer_ripple_count),
                                SENSOR(tachometer_noise),
                                SENSOR(fsr_noise),
                                SENSOR(fsr_rise_time),
                                SENSOR(adc_bits),
                                SENSOR(dac_bits),
                                SENSOR(encoder_gain_error),
                                SENSOR(encoder_offset),
                                SENSOR(tachometer_gain_error),
                                SENSOR(tachometer_offset),
                                SENSOR(fsr_gain_error),
                                SENSOR(fsr_offset),
                                SENSOR(fsr_hysteresis)};

// Whether a parameter is a fault of a sensor or converter, which ideal ones do not have.
static bool is_imperfection(int parameter)
{
    const bool gain = parameter_table[parameter].offset == piezo[0] ||
                      parameter_table[parameter].offset == film[0] ||
                      parameter_table[parameter].offset == accelerometer[0];
    return !gain && (IS_AMONG(parameter, piezo) || IS_AMONG(parameter, film) ||
                     IS_AMONG(parameter, accelerometer) || IS_AMONG(parameter, others));
}

// What sensors that are not fitted, or are ideal, make no use of.
static const char *reason_of_sensor(const parameters *p, int parameter)
{
    const rule rules[] = {
        {IS_AMONG(parameter, piezo) && !p->sensor.piezo,
         "no piezo sensor is fitted (sensor.piezo)"},
        {IS_AMONG(parameter, film) && !p->sensor.film, "no piezo film is fitted (sensor.film)"},
        {IS_AMONG(parameter, accelerometer) && !p->sensor.accelerometer,
         "none is fitted (sensor.accelerometer)"},
        {p->sensor.ideal && is_imperfection(parameter), "the sensors are ideal (sensor.ideal)"}};
    return FIRST_REASON(rules);
}

const char *inert_reason(const parameters *p, int parameter)
{
    assert(parameter >= 0 && parameter < parameter_count);
    const bool law = p->control.law != LAW_NONE;
    const bool control = IS_OF(parameter, control), sensor = IS_OF(parameter, sensor);
    const bool of_rig = sensor || control || IS_OF(parameter, belief);

    // without a law nothing of the rig matters, with one it has the voltage
    if (of_rig && !law) {
        return IS_OF(parameter, control.law) ? NULL : "no control law is on (control.law)";
    }
    if (law && parameter == PARAMETER_INDEX(motor.voltage)) {
        return "the control law commands the voltage";
    }
    return control  ? reason_of_control(p, parameter)
           : sensor ? reason_of_sensor(p, parameter)
                    : reason_of_arm(p, parameter);
}
