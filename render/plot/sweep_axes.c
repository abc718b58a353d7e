// The axes of a sweep's picture: which values they show, in what order, and where their ticks are.
#include "render/plot/sweep_canvas.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LABELLED_VALUES = 9 };

double sweep_coordinate(const sweep_scale *s, double value)
{
    return s->kind == SCALE_LOGARITHMIC ? log10(value) : value;
}

static void add_tick(sweep_scale *s, double at, const char *text)
{
    if (s->tick_count < TICKS_MOST) {
        s->ticks[s->tick_count].at = at;
        snprintf(s->ticks[s->tick_count++].text, MARK_TEXT, "%s", text);
    }
}

// A number with few digits as markup: a true minus sign, "2·10<sup>−5</sup>" for "2e-05".
static void number_label(double value, char text[MARK_TEXT])
{
    char digits[24];
    const char *sign = value < 0 ? "\u2212" : "";
    snprintf(digits, sizeof digits, "%.6g", fabs(value));
    char *exponent = strchr(digits, 'e');
    if (exponent == NULL) {
        snprintf(text, MARK_TEXT, "%s%s", sign, digits);
        return;
    }
    int power = atoi(exponent + 1);
    *exponent = '\0';
    bool one = strcmp(digits, "1") == 0;
    snprintf(text, MARK_TEXT, "%s%s%s10<sup>%s%d</sup>", sign, one ? "" : digits,
             one ? "" : "\u00b7", power < 0 ? "\u2212" : "", abs(power));
}

// Ticks at even steps. Returns the common factor of the labels as markup.
static void linear_ticks(sweep_scale *s, int wanted, char *factor, size_t size)
{
    ticks t;
    ticks_between(&t, s->low, s->high, wanted);
    for (int i = 0; i < t.count; i++) {
        char text[TICK_TEXT];
        tick_label(&t, i, text);
        add_tick(s, t.value[i], text);
    }
    tick_factor(&t, factor, size);
}

// Ticks at 1, 2, 5 times the powers of ten, or at the powers alone if there are many.
static void logarithmic_ticks(sweep_scale *s)
{
    static const int steps[] = {1, 2, 5};
    bool few = s->high - s->low < 3;
    for (int decade = (int)floor(s->low); decade <= (int)ceil(s->high); decade++) {
        for (int i = 0; i < (few ? 3 : 1); i++) {
            double value = steps[i] * pow(10, decade), at = log10(value);
            if (at >= s->low - 1e-9 && at <= s->high + 1e-9) {
                char text[MARK_TEXT];
                number_label(value, text);
                add_tick(s, at, text);
            }
        }
    }
}

// Ticks at the points themselves, for words and where a few values are spaced unevenly.
static void ticks_at_points(sweep_scale *s, const sweep_axis *axis)
{
    for (size_t i = 0; i < s->count; i++) {
        char text[MARK_TEXT] = "";
        if (s->kind == SCALE_WORDS) {
            parameters p = {0};
            parameter_set_number(&p, axis->parameter, axis->values[s->order[i]], NULL);
            parameter_format(&p, axis->parameter, text, sizeof text);
        } else {
            number_label(axis->values[s->order[i]], text);
        }
        add_tick(s, s->points[i], text);
    }
}

// Sorts the points of an axis; a sweep's axis is short or in order already.
static void sort_points(sweep_scale *s)
{
    for (size_t i = 1; i < s->count; i++) {
        double point = s->points[i];
        size_t order = s->order[i], j = i;
        for (; j > 0 && s->points[j - 1] > point; j--) {
            s->points[j] = s->points[j - 1];
            s->order[j] = s->order[j - 1];
        }
        s->points[j] = point;
        s->order[j] = order;
    }
}

// Sets points and their order. A falling range is turned round first: sorting it would be slow.
static bool take_points(sweep_scale *s, const sweep_axis *axis)
{
    s->points = malloc(axis->count * sizeof *s->points);
    s->order = malloc(axis->count * sizeof *s->order);
    if (s->points == NULL || s->order == NULL) {
        return false;
    }
    s->count = axis->count;
    bool falling = axis->is_range && axis->high < axis->low;
    for (size_t i = 0; i < s->count; i++) {
        s->order[i] = falling ? s->count - 1 - i : i;
        s->points[i] =
            s->kind == SCALE_WORDS ? (double)i : sweep_coordinate(s, axis->values[s->order[i]]);
    }
    sort_points(s);
    return true;
}

// The label of an axis: name, unit and the factor of its tick labels.
static void make_label(char *label, size_t size, const char *name, const char *unit,
                       const char *factor)
{
    char shown[64], *escaped = text_escape(name), *escaped_unit;
    text_unit(unit, shown, sizeof shown);
    escaped_unit = text_escape(shown);
    const char *space = factor[0] != '\0' && unit[0] != '\0' ? " " : "";
    if (factor[0] == '\0' && unit[0] == '\0') {
        snprintf(label, size, "%s", escaped);
    } else {
        snprintf(label, size, "%s (%s%s%s)", escaped, factor, space, escaped_unit);
    }
    g_free(escaped_unit);
    g_free(escaped);
}

// True for a few values that are spaced unevenly and have no long digits.
static bool points_are_good_ticks(const sweep_scale *s, const sweep_axis *axis)
{
    bool good =
        (axis->logarithmic || !axis->is_range) && s->count > 0 && s->count <= LABELLED_VALUES;
    for (size_t i = 0; i < s->count && good; i++) {
        char digits[32];
        snprintf(digits, sizeof digits, "%.3g", axis->values[i]);
        good = fabs(strtod(digits, NULL) - axis->values[i]) <= 1e-9 * fabs(axis->values[i]);
    }
    return good;
}

bool sweep_scale_of_axis(sweep_scale *s, const sweep_axis *axis, int wanted)
{
    const parameter_info *info = &parameter_table[axis->parameter];
    bool words = info->type == PARAMETER_CHOICE || info->type == PARAMETER_BOOLEAN;
    char factor[64] = "";
    memset(s, 0, sizeof *s);
    s->kind = words ? SCALE_WORDS : axis->logarithmic ? SCALE_LOGARITHMIC : SCALE_LINEAR;
    if (axis->values != NULL && !take_points(s, axis)) {
        return false;
    }
    if (s->count > 0) {
        s->low = s->points[0];
        s->high = s->points[s->count - 1];
    } else {
        s->low = sweep_coordinate(s, fmin(axis->low, axis->high));
        s->high = sweep_coordinate(s, fmax(axis->low, axis->high));
    }
    if (s->low == s->high) {
        s->low -= 0.5;
        s->high += 0.5;
    }
    if (words || points_are_good_ticks(s, axis)) {
        ticks_at_points(s, axis);
    } else if (axis->logarithmic) {
        logarithmic_ticks(s);
    } else {
        linear_ticks(s, wanted, factor, sizeof factor);
    }
    make_label(s->label, sizeof s->label, info->path, info->unit, factor);
    return true;
}

void sweep_scale_of_quantity(sweep_scale *s, const char *key, double low, double high, int wanted)
{
    char name[64], factor[64];
    const char *unit;
    memset(s, 0, sizeof *s);
    s->low = low;
    s->high = high;
    linear_ticks(s, wanted, factor, sizeof factor);
    quantity_name(key, name, sizeof name, &unit);
    for (char *c = name; *c != '\0'; c++) {
        *c = *c == '_' ? ' ' : *c;
    }
    make_label(s->label, sizeof s->label, name, unit, factor);
}

void sweep_scale_finish(sweep_scale *s)
{
    free(s->points);
    free(s->order);
}

void sweep_scale_widen(sweep_scale *s, double share)
{
    double more = share * (s->high - s->low);
    s->low -= more;
    s->high += more;
}
