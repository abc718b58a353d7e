// How a scenario differs from its file, in words.
#include <assert.h>
#include <string.h>

#include "src/scenario/effect.h"

enum { ROOM_FOR_COUNT = 20 }; // bytes for " and 160 more" or ", with 160 changes"

// Writes a parameter as "path = value unit".
static void format_value(char *text, size_t size, const char *path, int parameter,
                         const char *value)
{
    const char *unit = parameter_table[parameter].unit;
    snprintf(text, size, "%s = %s%s%s", path, value, unit[0] != '\0' ? " " : "", unit);
}

// Whether a parameter was given another value than in the file, with an effect; if so,
// text gets the change in words.
static bool is_changed(const scenario *s, int index, char *text, size_t size)
{
    static const parameters none;
    const parameters *from = s->written != NULL ? &s->written->values : &none;
    char value[PARAMETER_VALUE_SIZE], written[PARAMETER_VALUE_SIZE];
    parameter_format(&s->parameters, index, value, sizeof value);
    parameter_format(from, index, written, sizeof written);
    if (!s->parameters.set[index] || strcmp(value, written) == 0 ||
        effect_none_from(s, index, -1) != NULL) {
        return false;
    }
    format_value(text, size, parameter_table[index].path, index, value);
    return true;
}

// Writes an action in words, such as "motor.voltage = 2 V at 0.4 s".
static void format_action(char *text, size_t size, const action *a)
{
    char value[PARAMETER_VALUE_SIZE], set[3 * PARAMETER_VALUE_SIZE], path[ACTION_PATH];
    if (a->kind == ACTION_PUSH) {
        snprintf(text, size, "a push of %g N s at %g s", a->value, a->time);
        return;
    }
    action_format_value(a, value, sizeof value);
    format_value(set, sizeof set, action_path(a, path), a->parameter, value);
    snprintf(text, size, "%s at %g s", set, a->time);
}

// Whether an action was added to the script of the file, and has an effect; if so, text
// gets the action in words.
static bool is_added(const scenario *s, int index, char *text, size_t size)
{
    const action *a = &s->actions[index];
    if (!a->added ||
        (a->kind == ACTION_SET && effect_none_from(s, a->parameter, index) != NULL)) {
        return false;
    }
    format_action(text, size, a);
    return true;
}

// Writes change number i in words, counting the parameters and after them the actions of
// the script. False if that one is as in the file.
static bool change_in_words(const scenario *s, int i, char *words, size_t size)
{
    if (i < parameter_count) {
        return is_changed(s, i, words, size);
    }
    return is_added(s, i - parameter_count, words, size);
}

const char *scenario_changes_within(const scenario *s, char *text, size_t room)
{
    assert(room > 0);
    size_t used = 0;
    int left_out = 0;
    text[0] = '\0';

    // as many changes as there is room for, beside the count of the others
    for (int i = 0; i < parameter_count + s->action_count; i++) {
        char words[4 * PARAMETER_VALUE_SIZE];
        if (!change_in_words(s, i, words, sizeof words)) {
            continue;
        }

        const size_t length = strlen(words) + strlen(", with ");
        if (left_out > 0 || used + length + ROOM_FOR_COUNT > room) {
            left_out++;
            continue;
        }
        const char *before = ", ";
        if (used == 0) {
            before = ", with ";
        }
        used += (size_t)snprintf(text + used, room - used, "%s%s", before, words);
    }

    // how many were left out
    if (left_out > 0 && used > 0) {
        snprintf(text + used, room - used, " and %d more", left_out);
    } else if (left_out > 0 && room >= ROOM_FOR_COUNT) {
        snprintf(text, room, ", with %d change%s", left_out, left_out == 1 ? "" : "s");
    }
    return text;
}

const char *scenario_titled(const scenario *s, char text[SCENARIO_TITLED])
{
    char changes[SCENARIO_CHANGES];
    snprintf(text, SCENARIO_TITLED, "%s%s", s->title, scenario_changes(s, changes));
    return text;
}
