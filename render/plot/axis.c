#include "render/plot/axis.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/page/text.h"
#include "src/base/numbers.h"

#define LEAST_DECADES 0.5 // of a logarithmic scale

double scale_coordinate(scale_kind kind, double value)
{
    if (kind == SCALE_LOGARITHMIC) {
        return log10(value);
    }
    return value;
}

double scale_value(scale_kind kind, double coordinate)
{
    if (kind == SCALE_LOGARITHMIC) {
        return pow(10, coordinate);
    }
    return coordinate;
}

double scale_share(const axis_scale *s, double value)
{
    return (scale_coordinate(s->kind, value) - s->low) / (s->high - s->low);
}

bool scale_holds(const axis_scale *s, double value)
{
    double at = scale_coordinate(s->kind, value);
    return at >= s->low && at <= s->high;
}

axis_scale scale_empty(scale_kind kind)
{
    return (axis_scale){kind, (double)INFINITY, -(double)INFINITY};
}

void scale_include(axis_scale *s, double value)
{
    double at = scale_coordinate(s->kind, value);
    if (isfinite(at)) {
        s->low = fmin(s->low, at);
        s->high = fmax(s->high, at);
    }
}

bool scale_is_empty(const axis_scale *s)
{
    return !(s->low <= s->high);
}

bool scale_take_ends(axis_scale *s, const figure_axis *from)
{
    *s = scale_empty(from->scale);
    if (from->low < from->high) {
        scale_include(s, from->low);
        scale_include(s, from->high);
    }
    return !scale_is_empty(s);
}

// Separates equal ends, and adds a share of the range beyond both.
void scale_widen(axis_scale *s, double share)
{
    assert(share >= 0);
    if (!isfinite(s->low) || !isfinite(s->high)) {
        s->low = 0;
        s->high = 1;
    }

    // equal ends, and on a logarithmic scale near ones, are separated
    double size = fmax(fabs(s->low), fabs(s->high)), range = s->high - s->low;
    if (s->kind == SCALE_LOGARITHMIC && range < LEAST_DECADES) {
        s->low -= (LEAST_DECADES - range) / 2;
        s->high += (LEAST_DECADES - range) / 2;
    } else if (range <= 1e-9 * size || s->high == s->low) {
        double half = size > 0 ? 0.1 * size : 1;
        s->low -= half;
        s->high += half;
    }

    range = s->high - s->low;
    s->low -= share * range;
    s->high += share * range;
}

// ==== axes

#define MINOR_SPACING 2.5 // least distance of minor ticks [pt]
#define FEW_DECADES   1.2 // axes with fewer have ticks at 2 and 5 in any case

// ---- ticks

// Writes mantissa times a power of ten as "0.01", "20" or "2·10<sup>−6</sup>"; all labels
// of an axis have the same form.
static void format_decade(const axis_scale *s, int mantissa, int power,
                          char text[AXIS_LABEL])
{
    // short numbers are written out
    if (s->low > -2.5 && s->high < 4.5) {
        int decimals = 0;
        if (power < 0) {
            decimals = -power;
        }
        decimal_print(text, AXIS_LABEL, "%.*f", decimals, mantissa * pow(10, power));
        return;
    }

    // others are powers of ten; a mantissa of 1 is left out
    char factor[16] = "";
    if (mantissa > 1) {
        snprintf(factor, sizeof factor, "%d\u00b7", mantissa);
    }
    snprintf(text, AXIS_LABEL, "%s10<sup>%s%d</sup>", factor, text_sign(power),
             abs(power));
}

// Chooses the ticks of a logarithmic axis: 1, 2 and 5 of every decade where there is
// room, else powers of ten, as far apart as the wanted number asks for.
static void choose_decades(axis *a, int wanted)
{
    static const int mantissas[] = {1, 2, 5};
    const axis_scale *s = &a->scale;
    const double decades = s->high - s->low;

    // ticks in a decade, and decades from one tick to the next
    int spacing = 1, per_decade = 1;
    if (3 * decades <= wanted || decades < FEW_DECADES) {
        per_decade = 3;
    }
    while (decades / spacing > wanted) {
        spacing++;
    }

    // a single label would not show the scale
    while (spacing > 1 && floor(s->high / spacing) - ceil(s->low / spacing) < 1) {
        spacing--;
    }

    // those that lie on the axis
    for (int power = (int)floor(s->low); power <= (int)ceil(s->high); power++) {
        if (power % spacing != 0) {
            continue;
        }
        for (int i = 0; i < per_decade && a->count < TICKS_MOST; i++) {
            double at = power + log10(mantissas[i]);
            if (at >= s->low - 1e-9 && at <= s->high + 1e-9) {
                format_decade(s, mantissas[i], power, a->own[a->count]);
                a->text[a->count] = a->own[a->count];
                a->at[a->count++] = mantissas[i] * pow(10, power);
            }
        }
    }
}

// Takes the ticks that the figure's axis lists.
static void take_given_ticks(axis *a)
{
    for (int i = 0; i < a->from->tick_count && i < TICKS_MOST; i++) {
        a->at[a->count] = a->from->ticks[i].value;
        a->text[a->count++] = a->from->ticks[i].label;
    }
}

// Chooses the ticks of a linear axis: round values at even distances, with their labels.
static void choose_even_ticks(axis *a, int wanted)
{
    ticks_between(&a->even, a->scale.low, a->scale.high, wanted);
    a->count = a->even.count;
    for (int i = 0; i < a->count; i++) {
        a->at[i] = a->even.value[i];
        tick_label(&a->even, i, a->own[i]);
        a->text[i] = a->own[i];
    }
}

// Chooses the ticks of an axis: those that it lists, or as its scale asks for.
void axis_choose_ticks(axis *a, const figure_axis *from, int wanted)
{
    a->from = from;
    a->count = 0;
    a->even = (ticks){.minor = 1};
    if (from->ticks != NULL) {
        take_given_ticks(a);
    } else if (a->scale.kind == SCALE_LOGARITHMIC) {
        choose_decades(a, wanted);
    } else {
        choose_even_ticks(a, wanted);
    }
}

// The number of ticks that a length has room for at a spacing, between two bounds.
int axis_tick_count(double length, double spacing, int least, int most)
{
    double count = length / spacing;
    if (count < least) {
        return least;
    }
    if (count > most) {
        return most;
    }
    return (int)count;
}

// ---- minor ticks

// Computes the minor ticks of a linear axis, which divide its step into equal parts; none
// if they would be too near each other. Returns their number.
static int minor_even(const axis *a, double length, double *at)
{
    const ticks *t = &a->even;
    int count = 0;
    if (t->count < 2 || t->minor < 2) {
        return 0;
    }

    // multiples of a part of the step that are on the axis and not at a major tick
    double part = t->step / t->minor,
           spacing = part / (a->scale.high - a->scale.low) * length;
    for (int k = -t->minor; k <= t->minor * t->count && spacing > MINOR_SPACING; k++) {
        double value = t->value[0] + k * part;
        if (k % t->minor != 0 && scale_holds(&a->scale, value) && count < AXIS_MINOR) {
            at[count++] = value;
        }
    }
    return count;
}

// Computes the minor ticks of an axis of a length: 2 to 9 of every decade, or on a linear
// axis parts of a step. Returns their number.
int axis_minor_ticks(const axis *a, double length, double at[AXIS_MINOR])
{
    const axis_scale *s = &a->scale;
    if (s->kind == SCALE_LINEAR) {
        return minor_even(a, length, at);
    }

    // 2 ... 9 of every decade, unless the ninth would touch the next power
    int count = 0;
    bool room = (1 - log10(9)) / (s->high - s->low) * length > 1;
    for (int power = (int)floor(s->low); power <= (int)ceil(s->high) && room; power++) {
        for (int mantissa = 2; mantissa < 10 && count < AXIS_MINOR; mantissa++) {
            double value = mantissa * pow(10, power);
            if (scale_holds(s, value)) {
                at[count++] = value;
            }
        }
    }
    return count;
}

// ---- labels

static bool has_text(const char *text)
{
    return text != NULL && text[0] != '\0';
}

// A unit in brackets with its power of ten, as markup that is not broken into lines.
static char *unit_markup(const char *unit, int exponent)
{
    char factor[64] = "";
    const ticks scaled = {.exponent = exponent};
    tick_factor(&scaled, factor, sizeof factor);
    if (!has_text(unit)) {
        return text_printf("(%s)", factor);
    }

    // Pango would break the line after a slash
    g_autofree char *shown = text_unit(unit);
    g_auto(GStrv) parts = g_strsplit(shown, "/", -1);
    g_autofree char *unbroken = g_strjoinv("\u2060/\u2060", parts);

    // before a unit the factor goes without its multiplication sign
    if (factor[0] == '\0') {
        return text_printf("(%s)", unbroken);
    }
    return text_printf("(%s\u2009%s)", factor + strlen("\u00d7"), unbroken);
}

// "Contact force (N)", or with a factor "Contact force (10^3 N)".
char *axis_label_text(const char *label, const char *unit, int exponent)
{
    if (!has_text(unit) && exponent == 0) {
        return g_strdup(text_or(label, ""));
    }
    g_autofree char *whole = unit_markup(unit, exponent);
    if (!has_text(label)) {
        return g_steal_pointer(&whole);
    }
    return text_printf("%s %s", label, whole);
}

char *axis_title(const axis *a)
{
    return axis_label_text(a->from->label, a->from->unit, a->even.exponent);
}
