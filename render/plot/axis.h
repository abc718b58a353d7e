// An axis ready to be drawn: scale, ticks and labels.
#pragma once

#include "render/plot/plot.h"
#include "render/plot/ticks.h"

enum { AXIS_LABEL = 48, AXIS_MINOR = 512 };

typedef struct axis {
    const figure_axis *from;
    axis_scale scale;
    ticks even;                       // of a linear axis, otherwise empty
    int count;                        // of ticks
    double at[TICKS_MOST];            // values, ascending
    const char *text[TICKS_MOST];     // labels; "" for none
    char own[TICKS_MOST][AXIS_LABEL]; // storage of generated labels
} axis;

// Chooses about `wanted` ticks for the axis' scale.
void axis_choose_ticks(axis *a, const figure_axis *from, int wanted);

// The number of ticks of an axis of the given length, one every `spacing` [pt].
int axis_wish(double length, double spacing, int least, int most);

// Values of the minor ticks of an axis of the given length [pt]; none if they would be too close.
int axis_minor_ticks(const axis *a, double length, double at[AXIS_MINOR]);

// Label, unit and factor of the axis, as markup. To be freed with g_free.
char *axis_title(const axis *a);

// A label with its unit and a factor of 10^exponent, as markup. To be freed with g_free.
char *axis_label(const char *label, const char *unit, int exponent);
