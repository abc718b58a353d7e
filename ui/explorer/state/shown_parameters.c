#include "ui/explorer/state/shown_parameters.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "ui/explorer/state/view.h"

// Whether a parameter begins another group than the one before it.
static bool begins_group(int parameter)
{
    const char *path = parameter_table[parameter].path;
    return parameter == 0 || strncmp(path, parameter_table[parameter - 1].path,
                                     strcspn(path, ".") + 1) != 0;
}

int parameter_group(int parameter)
{
    assert(parameter >= 0 && parameter < parameter_count);
    while (!begins_group(parameter)) {
        parameter--;
    }
    return parameter;
}

void parameter_group_name(int parameter, char *name, size_t size)
{
    assert(parameter >= 0 && parameter < parameter_count);
    text_cut(parameter_table[parameter].path, ".", name, size);
}

bool parameter_list_is_brief(const parameter_list *list, const char *filter)
{
    return !list->all && filter[0] == '\0';
}

// The knobs, and the selected parameter if it is none of them.
static int knob_lines(const parameter_list *list, parameter_line lines[PARAMETER_LINES],
                      int *selected)
{
    int count = 0;
    *selected = -1;
    for (int i = 0; i < list->knob_count; i++) {
        if (list->knobs[i] == list->parameter) {
            *selected = i;
        }
        lines[count++] = (parameter_line){list->knobs[i], false};
    }
    if (*selected < 0) {
        *selected = count;
        lines[count++] = (parameter_line){list->parameter, false};
    }
    return count;
}

int parameter_list_lines(const parameter_list *list, const char *filter,
                         parameter_line lines[PARAMETER_LINES], int *selected)
{
    if (parameter_list_is_brief(list, filter)) {
        return knob_lines(list, lines, selected);
    }
    const int own = parameter_group(list->parameter);
    int count = 0, group = -1;
    *selected = 0;
    for (int i = 0; i < parameter_count && count + 2 <= PARAMETER_LINES; i++) {
        const parameter_info *info = &parameter_table[i];
        char text[512];
        snprintf(text, sizeof text, "%s %s", info->path, info->description);
        if (filter[0] != '\0' && !filter_passes(filter, text)) {
            continue;
        }

        // a group's heading before its first line that passes the filter
        if (parameter_group(i) != group) {
            group = parameter_group(i);
            if (group == own) {
                *selected = count;
            }
            lines[count++] = (parameter_line){group, true};
        }
        if (i == list->parameter) {
            *selected = count;
        }
        lines[count++] = (parameter_line){i, false};
    }
    return count;
}

int parameter_of_name(const char *name)
{
    const int exact = parameter_find(name);
    const size_t length = strlen(name);
    if (exact >= 0 || length == 0) {
        return exact;
    }

    // how many have this last part, a beginning of it, a beginning of the path
    enum { IS_LEAF, BEGINS_LEAF, BEGINS_PATH, WAYS };
    int found[WAYS] = {-1, -1, -1}, count[WAYS] = {0};
    for (int i = 0; i < parameter_count; i++) {
        const char *path = parameter_table[i].path, *leaf = strchr(path, '.') + 1;
        const bool fits[WAYS] = {strcmp(leaf, name) == 0,
                                 strncmp(leaf, name, length) == 0,
                                 strncmp(path, name, length) == 0};
        for (int way = 0; way < WAYS; way++) {
            if (fits[way]) {
                found[way] = i;
                count[way]++;
            }
        }
    }

    // the first way in which any fits
    for (int way = 0; way < WAYS; way++) {
        if (count[way] > 1) {
            return -2;
        }
        if (count[way] == 1) {
            return found[way];
        }
    }
    return -1;
}

// --- sliders ---------------------------------------------------------------------------

bool slider_scale_of(int parameter, double value, slider_scale *scale)
{
    return parameter_usual_range(parameter, value, &scale->low, &scale->high,
                                 &scale->logarithmic);
}

double slider_share(const slider_scale *scale, double value)
{
    assert(scale->high > scale->low);
    double share = (value - scale->low) / (scale->high - scale->low);
    if (scale->logarithmic) {
        share = log(value / scale->low) / log(scale->high / scale->low);
    }
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
        step = pow(10, floor(log10(width / fmax(cells, 1))));
    }

    // whole steps, within what the table allows
    if (info->type == PARAMETER_INTEGER) {
        step = 1;
    }
    value = step * round(value / step);
    return fmax(info->minimum, fmin(info->maximum, value));
}
