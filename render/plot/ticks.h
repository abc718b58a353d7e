// Ticks of an axis and their labels.
#pragma once

#include <stddef.h>

enum {
    TICKS_MOST = 64, // of one axis
    TICK_TEXT = 32,  // room for one label
};

typedef struct ticks {
    int count;
    double value[TICKS_MOST]; // ascending, each the double nearest to its decimal number
    double step;              // from one to the next; 0 if there are fewer than two
    int decimals;             // digits after the point that every label needs
    int exponent; // labels are in units of 10^exponent, a multiple of 3, mostly 0
    int minor;    // parts into which minor ticks divide a step, 1 if there are none
} ticks;

// Extended Wilkinson ticks for an axis from low to high, about `wanted` of them, all
// within its ends: among the steps {1, 5, 2, 2.5, 4, 3} times j and a power of ten the
// one with the best mean of simplicity, coverage, density and legibility (weights 0.25,
// 0.2, 0.5, 0.05), and then every multiple of that step on the axis. Talbot, Lin,
// Hanrahan 2010. Limits in wrong order are swapped, equal ones are widened; limits that
// are not finite give no ticks.
void ticks_between(ticks *t, double low, double high, int wanted);

// The label of tick `index` with a true minus sign (U+2212) and no needless digits.
void tick_label(const ticks *t, int index, char text[TICK_TEXT]);

// The factor of all labels as Pango markup, "×10<sup>−6</sup>"; empty where exponent is
// 0.
void tick_factor(const ticks *t, char *text, size_t size);
