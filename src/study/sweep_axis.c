#include "src/study/sweep_axis.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/base/plain_math.h"
#include "src/tables/settings.h"

const parameter_info *sweep_axis_parameter(const sweep_axis *axis)
{
    assert(axis->parameter >= 0 && axis->parameter < parameter_count);
    if (settings_name(axis->name)) {
        return &setting_info;
    }
    return &parameter_table[axis->parameter];
}

bool sweep_axis_has_words(const sweep_axis *axis)
{
    const parameter_type type = sweep_axis_parameter(axis)->type;
    return type == PARAMETER_CHOICE || type == PARAMETER_BOOLEAN;
}

status sweep_axis_find(sweep_axis *axis, const char *text, fault *f)
{
    char name[SWEEP_VALUE_TEXT], path[SWEEP_NAME];
    const char *own;
    snprintf(name, sizeof name, "%.*s", (int)strcspn(text, "="), text);
    if (settings_name(name) != NULL) {
        axis->parameter = settings_look_up(name, &own, f);
        snprintf(axis->name, sizeof axis->name, "%.*s", SWEEP_NAME - 1, name);
        if (axis->parameter >= 0) {
            return STATUS_OK;
        }
        return STATUS_BAD_ARGUMENT;
    }
    const size_t length = strcspn(name, "[");
    snprintf(path, sizeof path, "%.*s", (int)length, name);
    axis->parameter = parameter_look_up(path, f);
    if (axis->parameter < 0) {
        return STATUS_BAD_ARGUMENT;
    }

    // a list by one of its numbers, nothing else by any
    const parameter_type type = sweep_axis_parameter(axis)->type;
    const bool list = type == PARAMETER_LIST;
    FAULT_IF(type == PARAMETER_TEXT, f, STATUS_BAD_ARGUMENT,
             "%s is a text, only numbers and words are varied", path);
    FAULT_IF(list && name[length] == '\0', f, STATUS_BAD_ARGUMENT,
             "%s is a list, only numbers and words are varied; its first number is %s[1]",
             path, path);
    if (name[length] != '\0') {
        const char *rest;
        double k = 0;
        const bool read =
            decimal_read(name + length + 1, &k, &rest) && strcmp(rest, "]") == 0;
        FAULT_IF(!list, f, STATUS_BAD_ARGUMENT, "'%.60s': %s is no list", name, path);
        FAULT_IF(!read || k != floor(k) || k < 1 || k > PARAMETER_LIST_MOST, f,
                 STATUS_BAD_ARGUMENT,
                 "'%.60s' is no number of a list, expected %s[1] to %s[%d]", name, path,
                 path, PARAMETER_LIST_MOST);
        axis->element = (int)k;
        snprintf(axis->name, sizeof axis->name, "%.40s[%d]", path, axis->element);
    } else {
        snprintf(axis->name, sizeof axis->name, "%s", path);
    }
    return STATUS_OK;
}

status sweep_axis_apply(const sweep_axis *axis, double value, parameters *p, fault *f)
{
    const char *own = settings_name(axis->name);
    if (own != NULL) {
        return settings_set(p, own, value, f);
    }
    if (axis->element == 0) {
        return parameter_set_number(p, axis->parameter, value, f);
    }

    // the list with one number exchanged
    double numbers[PARAMETER_LIST_MOST];
    const int count = parameter_get_list(p, axis->parameter, numbers);
    if (axis->element > count) {
        return fault_set_at(f, STATUS_BAD_ARGUMENT, sweep_axis_parameter(axis)->path,
                            "%s: the scenario's list has %d numbers", axis->name, count);
    }
    numbers[axis->element - 1] = value;
    return parameter_set_list(p, axis->parameter, numbers, count, f);
}

status sweep_axes_scenario(const sweep_axis *axes, int count, const double *values,
                           const scenario *base, scenario *derived, fault *f)
{
    *derived = *base;
    for (int i = 0; i < count; i++) {
        TRY(sweep_axis_apply(&axes[i], values[i], &derived->parameters, f));
    }
    return scenario_resolve(derived, f);
}

double sweep_axis_get(const sweep_axis *axis, const parameters *p)
{
    const char *own = settings_name(axis->name);
    double value = (double)NAN, numbers[PARAMETER_LIST_MOST];
    if (own != NULL) {
        if (settings_get(p, own, &value)) {
            return value;
        }
        return (double)NAN;
    }
    if (axis->element == 0) {
        return parameter_get(p, axis->parameter);
    }

    // a number of the list, if it is as long
    if (axis->element <= parameter_get_list(p, axis->parameter, numbers)) {
        return numbers[axis->element - 1];
    }
    return value;
}

// Checks and reads one value of the axis.
static status read_axis_value(const sweep_axis *axis, const char *text, double *value,
                              fault *f)
{
    parameters scratch = {0};
    const char *own = settings_name(axis->name);
    double numbers[PARAMETER_LIST_MOST];
    if (own != NULL) {
        TRY(settings_set_text(&scratch, own, text, f));
    } else {
        TRY(parameter_set_text(&scratch, axis->parameter, text, f));
    }
    if (axis->element == 0) {
        *value = sweep_axis_get(axis, &scratch);
        return STATUS_OK;
    }
    FAULT_IF(parameter_get_list(&scratch, axis->parameter, numbers) != 1, f,
             STATUS_BAD_ARGUMENT, "'%.60s' is no number", text);
    *value = numbers[0];
    return STATUS_OK;
}

// Checks a number as a value of the axis.
static status check_axis_value(const sweep_axis *axis, double value, fault *f)
{
    const char *own = settings_name(axis->name);
    if (own == NULL) {
        return parameter_check_number(axis->parameter, value, f);
    }
    parameters scratch = {0};
    return settings_set(&scratch, own, value, f);
}

void sweep_axis_format(const sweep_axis *axis, double value, char *text, size_t size)
{
    assert(size > 0);
    parameters scratch = {0};
    if (axis->element > 0 || settings_name(axis->name) != NULL) {
        char digits[NUMBER_TEXT];
        number_format_short(digits, value);
        snprintf(text, size, "%s", digits);
        return;
    }
    parameter_set_number(&scratch, axis->parameter, value, NULL);
    parameter_format(&scratch, axis->parameter, text, size);
}

double sweep_axis_point(const sweep_axis *axis, size_t i, size_t n)
{
    assert(n >= 2 && i < n);
    const double low = axis->low, high = axis->high, x = (double)i,
                 last = (double)(n - 1);
    if (i == 0) {
        return low;
    }
    if (i == n - 1) {
        return high;
    }
    if (axis->logarithmic) {
        return low * plain_pow(high / low, x / last);
    }
    return (low * (last - x) + high * x) / last;
}

static bool is_whole(const sweep_axis *axis)
{
    return sweep_axis_parameter(axis)->type == PARAMETER_INTEGER;
}

double sweep_axis_value(const sweep_axis *axis, size_t i)
{
    assert(i < axis->count);
    if (axis->values != NULL) {
        return axis->values[i];
    }
    const double value = sweep_axis_point(axis, i, axis->count);
    if (is_whole(axis) && i > 0 && i + 1 < axis->count) {
        return round(value);
    }
    return value;
}

// STATUS_BAD_ARGUMENT if value number i of a range is that before it.
static status check_distinct(const sweep_axis *axis, size_t i, fault *f)
{
    const double value = sweep_axis_value(axis, i);
    if (value != sweep_axis_value(axis, i - 1)) {
        return STATUS_OK;
    }
    char text[SWEEP_VALUE_TEXT];
    sweep_axis_format(axis, value, text, sizeof text);
    return fault_set(f, STATUS_BAD_ARGUMENT, "%zu values give %s twice", axis->count,
                     text);
}

// Checks the n values of a range without looking at all of them: none may come twice, and
// all are allowed if both ends are and an even spacing meets whole numbers only.
static status check_range(sweep_axis *axis, size_t n, fault *f)
{
    axis->count = n;
    TRY(check_axis_value(axis, axis->low, f));
    TRY(check_axis_value(axis, axis->high, f));
    const bool rounded = axis->logarithmic && is_whole(axis);
    if (!rounded) {
        TRY(check_axis_value(axis, sweep_axis_point(axis, 1, n), f));
        TRY(check_distinct(axis, 1, f));
        return check_distinct(axis, n - 1, f);
    }

    // rounded numbers that lie less than one apart, from the smaller end on
    double apart = 0;
    for (size_t k = 1; k < n && apart < 1; k++) {
        const size_t i = axis->low < axis->high ? k : n - k;
        TRY(check_distinct(axis, i, f));
        apart = fabs(sweep_axis_point(axis, i, n) - sweep_axis_point(axis, i - 1, n));
    }
    return STATUS_OK;
}

// Reads the number of values in a range.
static status read_value_count(const char *text, size_t *count, fault *f)
{
    const char *rest;
    double value;
    FAULT_IF(!decimal_read(text, &value, &rest) || *rest != '\0' ||
                 value != floor(value) || value < 2 || value > (double)SWEEP_MOST_RUNS,
             f, STATUS_BAD_ARGUMENT,
             "'%.40s' is no number of values, expected a whole number from 2 to %zu",
             text, SWEEP_MOST_RUNS);
    *count = (size_t)value;
    return STATUS_OK;
}

// Reads "a:b", "a:b:n" or either with ":log".
static status read_range(sweep_axis *axis, char *text, bool drawn, fault *f)
{
    char *pieces[5], low[SWEEP_VALUE_TEXT], high[SWEEP_VALUE_TEXT], number[32] = "";
    size_t count = 0, n = 0;
    axis->is_range = true;
    while (count < 5 && (pieces[count] = strsep(&text, ":")) != NULL) {
        count++;
    }

    // only numbers have a range
    const char *choices = sweep_axis_parameter(axis)->choices;
    if (sweep_axis_has_words(axis)) {
        char words[128];
        snprintf(words, sizeof words, "%s", choices != NULL ? choices : "true|false");
        for (char *c = words; *c != '\0'; c++) {
            if (*c == '|') {
                *c = ',';
            }
        }
        return fault_set(
            f, STATUS_BAD_ARGUMENT,
            "%s takes words, which have no range; expected a list such as %s", axis->name,
            words);
    }

    // how many pieces there may be
    axis->logarithmic = count > 2 && count <= 4 && strcmp(pieces[count - 1], "log") == 0;
    if (axis->logarithmic) {
        count--;
    }
    FAULT_IF(count > 3 || (count < 3 && !drawn), f, STATUS_BAD_ARGUMENT,
             "expected %s (first, last, number of values), with :log for an even "
             "spacing of the logarithm",
             drawn ? "a:b or a:b:n" : "a:b:n");

    // the ends, and the number of values
    TRY(read_axis_value(axis, pieces[0], &axis->low, f));
    TRY(read_axis_value(axis, pieces[1], &axis->high, f));
    if (count == 3) {
        TRY(read_value_count(pieces[2], &n, f));
    }

    FAULT_IF(axis->low == axis->high, f, STATUS_BAD_ARGUMENT,
             "a range needs two different ends");
    FAULT_IF(axis->logarithmic && !(axis->low > 0 && axis->high > 0), f,
             STATUS_BAD_ARGUMENT, "a logarithmic range needs ends above zero");

    // its text in one way of writing, for comparing sweeps
    sweep_axis_format(axis, axis->low, low, sizeof low);
    sweep_axis_format(axis, axis->high, high, sizeof high);
    if (!drawn) {
        snprintf(number, sizeof number, ":%zu", n);
    }
    if (asprintf(&axis->text, "%s:%s%s%s", low, high, number,
                 axis->logarithmic ? ":log" : "") < 0) {
        axis->text = NULL;
        return fault_no_memory(f);
    }
    if (drawn) {
        return STATUS_OK;
    }
    return check_range(axis, n, f);
}

// Reads "v1,v2,v3".
static status read_list(sweep_axis *axis, char *text, bool drawn, fault *f)
{
    enum { MOST_VALUES = 20000 }; // each is compared with those before it
    size_t most = 1;
    for (const char *c = text; *c != '\0'; c++) {
        if (*c == ',') {
            most++;
        }
    }
    FAULT_IF(most > MOST_VALUES, f, STATUS_BAD_ARGUMENT,
             "a list has at most %d values, here are %zu", MOST_VALUES, most);

    // room for as many as there are commas, and the text as it would be written
    axis->values = malloc(most * sizeof *axis->values);
    axis->text = calloc(most, SWEEP_VALUE_TEXT);
    if (!(axis->values != NULL && axis->text != NULL)) {
        return fault_no_memory(f);
    }
    char *end = axis->text;
    for (char *piece; (piece = strsep(&text, ",")) != NULL; axis->count++) {
        char value[SWEEP_VALUE_TEXT - 1];
        double *number = &axis->values[axis->count];
        TRY(read_axis_value(axis, piece, number, f));

        // a grid has each value once
        for (const double *other = axis->values; !drawn && other < number; other++) {
            FAULT_IF(*other == *number, f, STATUS_BAD_ARGUMENT,
                     "'%.60s' stands there twice", piece);
        }
        sweep_axis_format(axis, *number, value, sizeof value);
        end += sprintf(end, "%s%s", axis->count > 0 ? "," : "", value);
    }
    return STATUS_OK;
}

status sweep_axis_parse(sweep_axis *axis, const char *values, bool drawn, fault *f)
{
    SCOPED(free_kept) char *text = strdup(values);
    if (text == NULL) {
        return fault_no_memory(f);
    }

    // a list cannot hold ranges: with a comma it is read as a list, and a value with a
    // colon is refused
    if (strchr(text, ':') != NULL && strchr(text, ',') == NULL) {
        return read_range(axis, text, drawn, f);
    }
    return read_list(axis, text, drawn, f);
}

status sweep_axis_parse_range(sweep_axis *axis, const char *text, fault *f)
{
    TRY(sweep_axis_parse(axis, text, true, f));
    if (!axis->is_range) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "expected a range, %s=a:b", axis->name);
    }
    return STATUS_OK;
}

void sweep_axis_finish(sweep_axis *axis)
{
    free(axis->values);
    free(axis->text);
}

double sweep_axis_value_at(const sweep_axis *axis, double share)
{
    assert(share >= 0 && share < 1);
    double low = fmin(axis->low, axis->high), high = fmax(axis->low, axis->high);

    if (!axis->is_range) {
        return axis->values[(size_t)(share * (double)axis->count)];
    }

    // each whole number owns the unit interval round it
    const bool whole = is_whole(axis);
    double from = low, to = high, value;
    if (whole) {
        from = low - 0.5;
        to = high + 0.5;
    }
    if (axis->logarithmic) {
        value = from * plain_exp(share * plain_log(to / from));
    } else {
        value = from + share * (to - from);
    }
    if (whole) {
        value = floor(value + 0.5);
    }
    return fmin(fmax(value, low), high);
}
