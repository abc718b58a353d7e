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

const char *scenario_changes_within(const scenario *s, char *text, size_t room)
{
    assert(room > 0);
    size_t used = 0;
    int more = 0;
    text[0] = '\0';

    // the parameters, then what the script does besides; what has no room is counted
    for (int i = 0; i < parameter_count + s->action_count; i++) {
        char words[4 * PARAMETER_TEXT_SIZE];
        const action *a = i < parameter_count ? NULL : &s->actions[i - parameter_count];
        if (a == NULL ? !is_changed(s, i, words, sizeof words)
                      : !a->added || (a->kind == ACTION_SET &&
                                      effect_none_from(s, a->parameter,
                                                       i - parameter_count) != NULL)) {
            continue;
        }
        if (a != NULL) {
            format_action(words, sizeof words, a);
        }

        const size_t length = strlen(words) + strlen(", with ");
        if (more > 0 || used + length + MORE > room) {
            more++;
            continue;
        }
        used += (size_t)snprintf(text + used, room - used, "%s%s",
                                 used == 0 ? ", with " : ", ", words);
    }
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
