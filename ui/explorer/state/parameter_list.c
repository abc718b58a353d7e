#include "ui/explorer/state/parameter_list.h"

#include <assert.h>
#include <string.h>

#include "ui/explorer/state/filters.h"
#include "ui/explorer/state/inert.h"

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
    assert(parameter >= 0 && parameter < parameter_count && name != NULL);
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
    assert(list != NULL && p != NULL && selected >= 0 && selected < parameter_count);

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
    assert(list != NULL && filter != NULL && lines != NULL);
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
    assert(list != NULL && lines != NULL);
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
    assert(list != NULL && line.parameter >= 0 && line.parameter < parameter_count);
    list->parameter = line.parameter;
    list->on_heading = line.heading;
    if (!line.heading) {
        list->folded[parameter_group(line.parameter)] = false;
    }
}

void parameter_list_fold(parameter_list *list, int parameter)
{
    assert(list != NULL && parameter >= 0 && parameter < parameter_count);
    bool *folded = &list->folded[parameter_group(parameter)];
    *folded = !*folded;
    list->parameter = group_begin(parameter);
    list->on_heading = true;
}

int parameter_of_name(const char *name)
{
    assert(name != NULL);
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
