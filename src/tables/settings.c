#include "src/tables/settings.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/tables/parameters_parts.h"

static const char group[] = "control.settings.";

enum { NAME_MOST = 40 }; // bytes of a NAME that is a path

const parameter_info setting_info = {
    .path = "control.settings",
    .offset = offsetof(parameters, control.settings),
    .type = PARAMETER_REAL,
    .unit = "",
    .minimum = -HUGE_VAL,
    .maximum = HUGE_VAL,
    .timed = true,
    .description = "parameter that only this law, plug-in or process has",
};

// --- paths -----------------------------------------------------------------------------

const char *settings_name(const char *path)
{
    const size_t length = sizeof group - 1;
    if (strncmp(path, group, length) == 0) {
        return path + length;
    }
    return NULL;
}

int settings_look_up(const char *path, const char **name, fault *f)
{
    *name = settings_name(path);
    if (*name == NULL) {
        return parameter_look_up(path, f);
    }

    // a name without blanks, control characters and equals signs, which the text can hold
    const size_t length = strlen(*name);
    bool good = length > 0 && length <= NAME_MOST;
    for (size_t i = 0; i < length && good; i++) {
        good = !is_blank((*name)[i]) && !is_control((*name)[i]) && (*name)[i] != '=';
    }
    if (!good) {
        fault_set(f, STATUS_BAD_ARGUMENT,
                  "'%.80s' names no setting, expected control.settings.NAME with a "
                  "NAME of 1 to %d characters without blanks",
                  path, NAME_MOST);
        return -1;
    }
    return PARAMETER_INDEX(control.settings);
}

int settings_look_up_value(const char *path, const char **value,
                           char room[PARAMETER_TEXT_SIZE], fault *f)
{
    const char *name;
    const int index = settings_look_up(path, &name, f);
    if (index < 0 || name == NULL) {
        return index;
    }
    const int length = snprintf(room, PARAMETER_TEXT_SIZE, ".%s=%s", name, *value);
    if (length >= PARAMETER_TEXT_SIZE) {
        fault_set_at(f, STATUS_BAD_SCENARIO, setting_info.path,
                     "%s has a value of more than 127 characters", path);
        return -1;
    }
    *value = room;
    return index;
}

// --- the text --------------------------------------------------------------------------

bool settings_next(const char **rest, setting *s)
{
    const char *word = *rest + strspn(*rest, " ");
    const size_t length = strcspn(word, " "), name_length = strcspn(word, " =");
    assert(length < PARAMETER_TEXT_SIZE);

    // "NAME=VALUE", or a word without an equals sign, which has no value
    *rest = word + length;
    *s = (setting){.word = word, .length = length};

    memcpy(s->name, word, name_length);
    if (name_length < length) {
        memcpy(s->value, word + name_length + 1, length - name_length - 1);
    }
    return length > 0;
}

bool setting_number(const setting *s, double *value)
{
    const char *end;
    return decimal_read(s->value, value, &end) && *end == '\0' && isfinite(*value);
}

bool settings_get(const parameters *p, const char *name, double *value)
{
    const char *rest = p->control.settings;
    bool found = false;
    setting s;

    // the last one of that name counts
    while (settings_next(&rest, &s)) {
        if (strcmp(s.name, name) == 0) {
            found = setting_number(&s, value);
        }
    }
    return found;
}

status settings_set(parameters *p, const char *name, double value, fault *f)
{
    char number[NUMBER_TEXT], text[2 * PARAMETER_TEXT_SIZE] = "";
    if (!isfinite(value)) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, setting_info.path,
                            "%s%s is not a finite number", group, name);
    }
    number_format_short(number, value);

    // the other settings stay as they are; the new value replaces the first one of its
    // name and removes further ones, or comes last
    const char *rest = p->control.settings;
    bool written = false, more = true;
    setting s;
    while (more) {
        more = settings_next(&rest, &s);
        const bool same = more ? strcmp(s.name, name) == 0 : true;
        if (same && written) {
            continue;
        }
        const size_t used = strlen(text);
        const char *between = used > 0 ? " " : "";
        if (same) {
            snprintf(text + used, sizeof text - used, "%s%s=%s", between, name, number);
            written = true;
        } else {
            snprintf(text + used, sizeof text - used, "%s%.*s", between, (int)s.length,
                     s.word);
        }
    }

    // the new text, if it is short enough
    if (strlen(text) >= PARAMETER_TEXT_SIZE) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, setting_info.path,
            "%s%s = %s has no room beside the other settings, which are at most "
            "%d characters together",
            group, name, number, PARAMETER_TEXT_SIZE - 1);
    }
    memset(p->control.settings, 0, sizeof p->control.settings);
    memcpy(p->control.settings, text, strlen(text));
    p->set[PARAMETER_INDEX(control.settings)] = 1;
    return STATUS_OK;
}

status settings_set_text(parameters *p, const char *name, const char *text, fault *f)
{
    const char *end;
    double value;
    text += strspn(text, " \t\n\v\f\r");
    if (!decimal_read(text, &value, &end) || *end != '\0') {
        return fault_set_at(f, STATUS_BAD_SCENARIO, setting_info.path,
                            "%s%s = '%.60s' is not a number", group, name, text);
    }
    return settings_set(p, name, value, f);
}
