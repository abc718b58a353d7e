// Values of parameters: stored in and read from struct parameters, parsed and formatted.
#include <assert.h>
#include <math.h>
#include <string.h>
#include <strings.h>

#include "src/base/numbers.h"
#include "src/tables/parameters_parts.h"
#include "src/tables/settings.h"

// The smallest value but 0, so that its square and its quotients do not overflow or
// vanish.
#define LEAST 1e-100

// The row of the parameter table with an index.
static const parameter_info *info_of_parameter(int index)
{
    assert(index >= 0 && index < parameter_count);
    return &parameter_table[index];
}

// The room for the text of a parameter that is kept as one.
static size_t size_of_text(const parameter_info *info)
{
    if (info->type == PARAMETER_LIST) {
        return PARAMETER_VALUE_SIZE;
    }
    return PARAMETER_TEXT_SIZE;
}

// Stores a number as the value of a parameter, in the parameter's type. A text or list
// gets its default instead.
static void store(parameters *p, const parameter_info *info, double value)
{
    void *at = (char *)p + info->offset;
    if (info->type == PARAMETER_REAL) {
        *(double *)at = value;
    } else if (info->type == PARAMETER_BOOLEAN) {
        *(bool *)at = value != 0;
    } else if (!parameter_is_text(info)) {
        *(int *)at = (int)value;
    } else {
        const char *text = info->choices != NULL ? info->choices : "";
        if (strcmp(at, text) == 0) {
            return; // lists are long, and mostly empty
        }
        memset(at, 0, size_of_text(info));
        memcpy(at, text, strnlen(text, PARAMETER_TEXT_SIZE - 1));
    }
}

double parameter_get(const parameters *p, int index)
{
    const parameter_info *info = info_of_parameter(index);
    const void *at = (const char *)p + info->offset;
    if (info->type == PARAMETER_REAL) {
        return *(const double *)at;
    }
    if (info->type == PARAMETER_BOOLEAN) {
        return *(const bool *)at;
    }
    if (parameter_is_text(info)) {
        return 0;
    }
    return *(const int *)at;
}

void parameters_restore_defaults(parameters *p)
{
    const bool printed = p->arm.model == ARM_PRINTED;
    const int model = PARAMETER_INDEX(arm.model);
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        if (!p->set[i] && i != model) {
            store(p, info, printed ? info->default_printed : info->default_corrected);
        }
    }
}

void parameters_defaults(parameters *p, arm_model_kind model)
{
    memset(p, 0, sizeof *p);
    p->arm.model = (int)model;
    parameters_restore_defaults(p);
}

// Checks that a number may be the value of a parameter, or a number of its list: finite,
// whole if it must be, and in range.
static status check_number(const parameter_info *info, double value, fault *f)
{
    const char *unit = info->unit, *space = unit[0] ? " " : "";
    if (!isfinite(value)) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, info->path,
                            "%s is not a finite number, expected %g to %g%s%s",
                            info->path, info->minimum, info->maximum, space, unit);
    }
    if (info->type != PARAMETER_REAL && info->type != PARAMETER_LIST &&
        value != floor(value)) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, info->path,
                            "%s = %g is not a whole number", info->path, value);
    }
    if (value < info->minimum || value > info->maximum) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, info->path,
                            "%s = %g is out of range, expected %g to %g%s%s", info->path,
                            value, info->minimum, info->maximum, space, unit);
    }
    if (value != 0 && fabs(value) < LEAST) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, info->path,
            "%s = %g is too small to be computed with, expected 0 or at least %g%s%s",
            info->path, value, LEAST, space, unit);
    }
    return STATUS_OK;
}

status parameter_check_number(int index, double value, fault *f)
{
    return check_number(info_of_parameter(index), value, f);
}

status parameter_set_number(parameters *p, int index, double value, fault *f)
{
    const parameter_info *info = info_of_parameter(index);
    if (parameter_is_text(info)) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, info->path,
                            "%s is a %s and takes no number", info->path,
                            info->type == PARAMETER_LIST ? "list" : "text");
    }
    TRY(check_number(info, value, f));
    store(p, info, value);
    p->set[index] = 1;
    return STATUS_OK;
}

// The index of a word among choices such as "a|b|c"; -1 if it is none of them.
static int choice_index(const char *choices, const char *text, size_t length)
{
    int index = 0;
    for (const char *c = choices; c != NULL; index++) {
        const char *bar = strchr(c, '|');
        size_t n = bar ? (size_t)(bar - c) : strlen(c);
        if (n == length && strncmp(c, text, n) == 0) {
            return index;
        }
        if (bar) {
            c = bar + 1;
        } else {
            c = NULL;
        }
    }
    return -1;
}

// Reads "0.1" or "0.1 rad" into value; text holds no surrounding space.
static status parse_quantity(const parameter_info *info, const char *text, double *value,
                             fault *f)
{
    const char *unit, *digits = text + strspn(text, "+-.");
    if (!decimal_read(text, value, &unit)) {
        // "inf" and "nan" are numbers to C, ".inf" and ".nan" to YAML: they are reported
        // as not finite
        bool infinite =
            strncasecmp(digits, "inf", 3) == 0 || strncasecmp(digits, "nan", 3) == 0;
        const char *type =
            info->type == PARAMETER_INTEGER ? "a whole number" : "a number";
        return fault_set_at(f, STATUS_BAD_SCENARIO, info->path,
                            "%s = '%.60s' is not %s, expected %g to %g%s%s", info->path,
                            text, infinite ? "finite" : type, info->minimum,
                            info->maximum, info->unit[0] ? " " : "", info->unit);
    }

    // units are not converted: only the parameter's own is accepted
    if (*unit != '\0' && strcmp(unit, info->unit) != 0) {
        if (info->unit[0] == '\0') {
            return fault_set_at(f, STATUS_BAD_SCENARIO, info->path,
                                "%s = '%.60s' carries a unit, expected a pure number",
                                info->path, text);
        }
        return fault_set_at(f, STATUS_BAD_SCENARIO, info->path,
                            "%s = '%.60s' is in '%.20s', expected %s", info->path, text,
                            unit, info->unit);
    }
    return STATUS_OK;
}

// Stores a text of `length` bytes, which must be one line, as the value of a parameter.
static status store_text(parameters *p, int index, const char *text, size_t length,
                         fault *f)
{
    const parameter_info *info = info_of_parameter(index);
    for (size_t i = 0; i < length; i++) {
        if (is_control(text[i])) {
            return fault_set_at(f, STATUS_BAD_SCENARIO, info->path,
                                "%s holds a control character, expected one line of text",
                                info->path);
        }
    }

    // zeroes behind the text make equal parameters equal byte by byte
    char *at = (char *)p + info->offset;
    memset(at, 0, PARAMETER_TEXT_SIZE);
    memcpy(at, text, length);
    p->set[index] = 1;
    return STATUS_OK;
}

// A list that is being put together in the form in which parameters hold it: "10, 12, 9".
typedef struct list_text {
    char text[PARAMETER_VALUE_SIZE];
    size_t used; // bytes of the text
    int count;   // numbers in it
} list_text;

// Appends a number to a list, with as few digits as identify it.
static status append_number(list_text *list, const parameter_info *info, double value,
                            fault *f)
{
    TRY(check_number(info, value, f));
    char number[NUMBER_TEXT];
    number_format_short(number, value);
    list->used +=
        (size_t)snprintf(list->text + list->used, sizeof list->text - list->used, "%s%s",
                         list->count > 0 ? ", " : "", number);
    if (list->count == PARAMETER_LIST_MOST || list->used >= sizeof list->text) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, info->path,
            "%s is too long, expected at most %d numbers and %d characters", info->path,
            PARAMETER_LIST_MOST, PARAMETER_VALUE_SIZE - 1);
    }
    list->count++;
    return STATUS_OK;
}

// Stores a list as the value of a parameter.
static void store_list(parameters *p, int index, const list_text *list)
{
    memcpy((char *)p + info_of_parameter(index)->offset, list->text, sizeof list->text);
    p->set[index] = 1;
}

// Reads a list such as "[10, 12 N m/rad, 9]", with or without brackets and units, and
// stores it.
static status read_list(parameters *p, int index, const char *text, size_t length,
                        fault *f)
{
    const parameter_info *info = info_of_parameter(index);
    list_text list = {.text = ""};

    // without the brackets
    const char *end = text + length;
    if (length > 1 && text[0] == '[' && text[length - 1] == ']') {
        text++;
        end--;
    }

    while (text < end) {
        // what stands before the next comma, without blanks around it
        const char *comma = memchr(text, ',', (size_t)(end - text));
        const char *first = text, *last = comma != NULL ? comma : end;
        while (first < last && is_blank(*first)) {
            first++;
        }
        while (last > first && is_blank(last[-1])) {
            last--;
        }

        // a number in the parameter's unit and range
        char word[PARAMETER_TEXT_SIZE];
        double value;
        snprintf(word, sizeof word, "%.*s", (int)(last - first), first);
        if (first == last) {
            return fault_set_at(
                f, STATUS_BAD_SCENARIO, info->path,
                "%s: number %d is missing, expected numbers with commas between them",
                info->path, list.count + 1);
        }
        TRY(parse_quantity(info, word, &value, f));
        TRY(append_number(&list, info, value, f));

        // after a comma at the very end a number is missing: the comma is read again, as
        // an empty word
        text = end;
        if (comma != NULL && comma + 1 < end) {
            text = comma + 1;
        } else if (comma != NULL) {
            text = comma;
        }
    }
    store_list(p, index, &list);
    return STATUS_OK;
}

status parameter_set_list(parameters *p, int index, const double *numbers, int count,
                          fault *f)
{
    list_text list = {.text = ""};
    assert(info_of_parameter(index)->type == PARAMETER_LIST);
    for (int i = 0; i < count; i++) {
        TRY(append_number(&list, info_of_parameter(index), numbers[i], f));
    }
    store_list(p, index, &list);
    return STATUS_OK;
}

// Reads a word without blanks around it as the value of a parameter that is no text: the
// index of a choice, 0 or 1 of a boolean, or a number.
static status parse_word(const parameter_info *info, const char *word, double *value,
                         fault *f)
{
    // one of several choices
    size_t length = strlen(word);
    if (info->type == PARAMETER_CHOICE) {
        int choice = choice_index(info->choices, word, length);
        *value = choice;
        if (!(choice >= 0)) {
            return fault_set_at(f, STATUS_BAD_SCENARIO, info->path,
                                "%s = '%.60s' is not known, expected one of %s",
                                info->path, word, info->choices);
        }
        return STATUS_OK;
    }

    // a boolean: the first word of each pair is false, the second true
    if (info->type == PARAMETER_BOOLEAN) {
        int choice = choice_index("false|true|False|True|FALSE|TRUE|no|yes|off|on|0|1",
                                  word, length);
        *value = choice % 2;
        if (!(choice >= 0)) {
            return fault_set_at(f, STATUS_BAD_SCENARIO, info->path,
                                "%s = '%.60s' is neither true nor false", info->path,
                                word);
        }
        return STATUS_OK;
    }
    return parse_quantity(info, word, value, f);
}

// Sets a single number of control.settings from a text ".NAME=VALUE".
static status set_setting(parameters *p, const char *text, fault *f)
{
    char name[PARAMETER_TEXT_SIZE];
    const size_t length = strcspn(text, " =");
    if (length == 1 || length > sizeof name || text[length] != '=') {
        return fault_set_at(f, STATUS_BAD_SCENARIO, setting_info.path,
                            "control.settings%.60s is no setting, expected .NAME=NUMBER",
                            text);
    }
    snprintf(name, sizeof name, "%.*s", (int)length - 1, text + 1);
    return settings_set_text(p, name, text + length + 1, f);
}

status parameter_set_text(parameters *p, int index, const char *text, fault *f)
{
    const parameter_info *info = info_of_parameter(index);

    // blanks around the value do not count
    text += strspn(text, " \t\n\v\f\r");
    size_t length = strlen(text);
    while (length > 0 && is_blank(text[length - 1])) {
        length--;
    }

    // settings, texts and lists have forms of their own
    if (info->offset == setting_info.offset && text[0] == '.') {
        return set_setting(p, text, f);
    }
    if (info->type == PARAMETER_TEXT && length < PARAMETER_TEXT_SIZE) {
        return store_text(p, index, text, length, f);
    }
    if (info->type == PARAMETER_LIST) {
        return read_list(p, index, text, length, f);
    }

    // any other value is a word
    char word[PARAMETER_TEXT_SIZE];
    if (length == 0 || length >= sizeof word) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, info->path, "%s has %s", info->path,
                            length ? "a value of more than 127 characters" : "no value");
    }
    memcpy(word, text, length);
    word[length] = '\0';

    double value = 0;
    TRY(parse_word(info, word, &value, f));
    return parameter_set_number(p, index, value, f);
}

void parameter_format(const parameters *p, int index, char *text, size_t size)
{
    assert(size > 0);
    const parameter_info *info = info_of_parameter(index);
    const double value = parameter_get(p, index);
    const char *choice = info->choices;
    char number[NUMBER_TEXT];

    // in the form of a scenario file
    if (parameter_is_text(info)) {
        snprintf(text, size, "%s", (const char *)p + info->offset);
    } else if (info->type == PARAMETER_BOOLEAN) {
        snprintf(text, size, "%s", value != 0 ? "true" : "false");
    } else if (info->type == PARAMETER_CHOICE) {
        for (int i = 0; i < (int)value; i++) {
            choice = strchr(choice, '|') + 1;
        }
        snprintf(text, size, "%.*s", (int)strcspn(choice, "|"), choice);
    } else if (info->type == PARAMETER_INTEGER) {
        snprintf(text, size, "%d", (int)value);
    } else {
        number_format_short(number, value);
        snprintf(text, size, "%s", number);
    }
}
