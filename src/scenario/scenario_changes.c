// What of a scenario is another than in its file, in words.
#include <assert.h>
#include <string.h>

#include "src/scenario/effect.h"

enum { MORE = 20 }; // room for " and 160 more" or ", with 160 changes"

// A parameter with its unit, as a person reads it.
static void format_value(char *text, size_t size, const char *path, int parameter,
                         const char *value)
{
    const char *unit = parameter_table[parameter].unit;
    snprintf(text, size, "%s = %s%s%s", path, value, unit[0] != '\0' ? " " : "", unit);
}

// Whether a parameter was given another value than the file's, and that has an effect;
// text has room for it in words.
static bool is_changed(const scenario *s, int index, char *text, size_t size)
{
    char value[PARAMETER_TEXT_SIZE], written[PARAMETER_TEXT_SIZE];
    parameter_format(&s->parameters, index, value, sizeof value);
    parameter_format(&s->written, index, written, sizeof written);
    if (!s->parameters.set[index] || strcmp(value, written) == 0 ||
        effect_none_from(s, index, -1) != NULL) {
        return false;
    }
    format_value(text, size, parameter_table[index].path, index, value);
    return true;
}

// An action in words.
static void format_action(char *text, size_t size, const action *a)
{
    char value[PARAMETER_TEXT_SIZE], set[3 * PARAMETER_TEXT_SIZE], path[ACTION_PATH];
    if (a->kind == ACTION_PUSH) {
        snprintf(text, size, "a push of %g N s at %g s", a->value, a->time);
        return;
    }
    action_format_value(a, value, sizeof value);
    format_value(set, sizeof set, action_path(a, path), a->parameter, value);
    snprintf(text, size, "%s at %g s", set, a->time);
}

// Whether an action was added to the file's script, and has an effect; text has room for
// it in words.
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

// A change in words, of number i among the parameters and then the actions; false if that
// is as in the file.
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
    int more = 0;
    text[0] = '\0';

    // the parameters, then what the script does besides; what has no room is counted
    for (int i = 0; i < parameter_count + s->action_count; i++) {
        char words[4 * PARAMETER_TEXT_SIZE];
        if (!change_in_words(s, i, words, sizeof words)) {
            continue;
        }

        const size_t length = strlen(words) + strlen(", with ");
        if (more > 0 || used + length + MORE > room) {
            more++;
            continue;
        }
        const char *before = ", ";
        if (used == 0) {
            before = ", with ";
        }
        used += (size_t)snprintf(text + used, room - used, "%s%s", before, words);
    }

    // how many had none
    if (more > 0 && used > 0) {
        snprintf(text + used, room - used, " and %d more", more);
    } else if (more > 0 && room >= MORE) {
        snprintf(text, room, ", with %d change%s", more, more == 1 ? "" : "s");
    }
    return text;
}

const char *scenario_titled(const scenario *s, char text[SCENARIO_TITLED])
{
    char changes[SCENARIO_CHANGES];
    snprintf(text, SCENARIO_TITLED, "%s%s", s->title, scenario_changes(s, changes));
    return text;
}
