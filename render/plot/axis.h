// An axis ready to be drawn: its scale, its ticks and what is written at them.
#pragma once

#include "render/plot/plot.h"
#include "render/plot/ticks.h"

enum { AXIS_LABEL = 48, AXIS_MINOR = 512 };

typedef struct axis {
    const figure_axis *from;
    axis_scale scale;
    ticks even;                       // of a linear axis, else without ticks
    int count;                        // of ticks
    double at[TICKS_MOST];            // values, ascending
    const char *text[TICKS_MOST];     // labels; "" where none is written
    char own[TICKS_MOST][AXIS_LABEL]; // labels that were made here
} axis;

// Chooses about `wanted` ticks for the axis' scale.
void axis_choose_ticks(axis *a, const figure_axis *from, int wanted);

// How many ticks fit an axis of the given length, one every `spacing` [pt].
int axis_wish(double length, double spacing, int least, int most);

// Values of the minor ticks of an axis of the given length [pt]; none where they would crowd.
int axis_minor_ticks(const axis *a, double length, double at[AXIS_MINOR]);

// Label, unit and factor of the axis, as markup. Give it to g_free.
char *axis_title(const axis *a);

// A label with its unit and a factor of 10^exponent, as markup. Give it to g_free.
char *axis_label(const char *label, const char *unit, int exponent);
