#include "ui/commands/option_values.h"

#include <assert.h>
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"

void *option_place(const arguments *a, const option_row *o)
{
    return (char *)a + o->place;
}

static int read_number(const option_row *o, const char *text, double *value)
{
    const char *rest;
    const char *space = o->unit != NULL ? " " : "", *unit = o->unit != NULL ? o->unit : "";
    double number;

    if (decimal_read(text, &number, &rest) && *rest == '\0' && number >= o->low &&
        number <= o->high) {
        *value = number;
        return EXIT_DONE;
    }

    if (isinf(o->high)) {
        return complain("--%s %s: expected a number from %g%s%s", o->name, text, o->low, space,
                        unit);
    }
    return complain("--%s %s: expected a number from %g to %g%s%s", o->name, text, o->low, o->high,
                    space, unit);
}

// A length in millimetres; without a unit it is one already.
static int read_length(const option_row *o, const char *text, double *value)
{
    static const struct {
        const char *unit;
        double mm;
    } units[] = {{"", 1}, {"mm", 1}, {"cm", 10}, {"in", 25.4}, {"pt", 25.4 / 72}};
    const char *rest;
    double number;

    if (decimal_read(text, &number, &rest)) {
        for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
            double mm = number * units[i].mm;
            if (strcmp(rest, units[i].unit) == 0 && mm >= o->low && mm <= o->high) {
                *value = mm;
                return EXIT_DONE;
            }
        }
    }

    return complain("--%s %s: expected a length from %gmm to %gmm, such as 85mm, 8.5cm or 3.35in",
                    o->name, text, o->low, o->high);
}

static int read_whole(const option_row *o, const char *text, uint64_t *value)
{
    // 2^64 and what lies beyond stand for the largest number there is
    uint64_t low = (uint64_t)o->low, high = o->high < 0x1p64 ? (uint64_t)o->high : UINT64_MAX;

    // signs and spaces, which strtoull would take, are refused by the first character
    char *end;
    errno = 0;
    unsigned long long number = strtoull(text, &end, 10);
    if (!isdigit((unsigned char)text[0]) || *end != '\0' || errno != 0 || number < low ||
        number > high) {
        return complain("--%s %s: expected a whole number from %llu to %llu", o->name, text,
                        (unsigned long long)low, (unsigned long long)high);
    }
    *value = number;
    return EXIT_DONE;
}

static int read_size(const option_row *o, const char *text, grid_size *size)
{
    char *rest = NULL;
    long width = strtol(text, &rest, 10), height = 0;
    if (*rest == 'x') {
        height = strtol(rest + 1, &rest, 10);
    }
    if (*rest != '\0' || width < 1 || width > o->high || height < 1 || height > o->high) {
        return complain("--%s %s: expected width x height in %s, like 120x40, at most %g", o->name,
                        text, o->unit, o->high);
    }
    *size = (grid_size){(int)width, (int)height};
    return EXIT_DONE;
}

// "a|b|c" as people write it: "a, b or c".
static int complain_choice(const option_row *o, const char *text)
{
    char words[256] = "";
    size_t length = 0;
    for (const char *c = o->value; *c != '\0' && length + 5 < sizeof words; c++) {
        const char *joint = strchr(c + 1, '|') != NULL ? ", " : " or ";
        char single[2] = {*c, '\0'};
        length += (size_t)snprintf(words + length, sizeof words - length, "%s",
                                   *c == '|' ? joint : single);
    }
    return complain("--%s %s: expected %s", o->name, text, words);
}

static int check_choice(const option_row *o, const char *text)
{
    size_t length = strlen(text);
    for (const char *word = o->value; word != NULL; word = strchr(word, '|')) {
        word += *word == '|';
        if (length > 0 && length == strcspn(word, "|") && strncmp(word, text, length) == 0) {
            return EXIT_DONE;
        }
    }
    return complain_choice(o, text);
}

static int check_quantity(const option_row *o, const char *key)
{
    const char *near = summary_suggest(key);
    if (summary_find(key) >= 0) {
        return EXIT_DONE;
    }
    if (near != NULL) {
        return complain("--%s %s: there is no such quantity, did you mean %s?", o->name, key, near);
    }
    return complain("--%s %s: there is no such quantity (impactlab run --json lists them)", o->name,
                    key);
}

int option_store(arguments *a, const option_row *o, char *text)
{
    void *place = option_place(a, o);
    switch (o->type) {
    case OPTION_FLAG:
        *(bool *)place = true;
        return EXIT_DONE;
    case OPTION_NUMBER:
        return read_number(o, text, place);
    case OPTION_LENGTH:
        return read_length(o, text, place);
    case OPTION_WHOLE:
        return read_whole(o, text, place);
    case OPTION_SIZE:
        return read_size(o, text, place);

    // what may be given several times
    case OPTION_NUMBERS: {
        number_list *list = place;
        return read_number(o, text, &list->items[list->count++]);
    }
    case OPTION_PARAMETERS: {
        text_list *list = place;
        list->items[list->count++] = text;
        return EXIT_DONE;
    }

    // texts are kept as they are, and checked where only some are known
    case OPTION_TEXT:
    case OPTION_WORD:
    case OPTION_CHOICE:
    case OPTION_FILE:
    case OPTION_RESULT:
    case OPTION_PICTURE:
    case OPTION_PLACE:
    case OPTION_SCENARIO:
    case OPTION_QUANTITY:
        *(const char **)place = text;
        return o->type == OPTION_CHOICE     ? check_choice(o, text)
               : o->type == OPTION_QUANTITY ? check_quantity(o, text)
                                            : EXIT_DONE;
    }
    return EXIT_DONE;
}
