// What every page has in common: its theme, rectangles on it, and a report of what was drawn where.
#pragma once

#include <stdbool.h>
#include <stddef.h>

enum {
    FIGURE_PANELS = 16, // most panels of a figure
    FIGURE_TEXTS = 512, // texts a report remembers
};

typedef enum figure_theme {
    THEME_COLOUR, // Okabe and Ito's colours on white
    THEME_MONO,   // black and greys on white
    THEME_DARK    // Okabe and Ito's colours on near black
} figure_theme;

// A rectangle on the page [pt], y downwards.
typedef struct figure_rect {
    double x, y, width, height;
} figure_rect;

typedef struct figure_text {
    figure_rect place; // upright, also round a rotated text
    char text[64];     // its beginning, without markup
} figure_text;

// What was drawn where.
typedef struct figure_report {
    figure_rect page;
    figure_rect panels[FIGURE_PANELS];  // inside the axes
    figure_rect legends[FIGURE_PANELS]; // width 0: none
    figure_rect insets[FIGURE_PANELS];  // with their labels; width 0: none
    int panel_count;
    figure_text texts[FIGURE_TEXTS];
    int text_count;
} figure_report;

// Adds a text and its place on the page to a report (may be NULL).
void report_add_text(figure_report *report, const char *markup, figure_rect place);
