// The parts of the terminal lab's screen, each drawn into an area of a grid of cells.
#pragma once

#include "ui/explorer/lab.h"

typedef struct area {
    int x, y, width, height; // [cells]
} area;

enum { LABEL_WIDTH = 9 };                     // of an axis of values
enum { LEAST_WIDTH = 40, LEAST_HEIGHT = 12 }; // of a screen that shows the lab

// Remembers where a part of the screen is, for the mouse.
void draw_spot(lab *l, lab_part part, area a, int index);

// An axis of values in its column, its line at the right; the area's rows are the axis.
void draw_value_axis(screen *s, area a, double low, double high);
// The time axis below the curves: contact as a bar, impacts and changes as marks, seconds.
void draw_time_axis(lab *l, screen *s, area a);

// The lines above and below the panels. draw_bottom draws the prompt, the message or hints in the
// last rows and returns how many it took.
void draw_title(lab *l, screen *s);
void draw_status(lab *l, screen *s, int y);
int draw_bottom(lab *l, screen *s);
// What a screen shows that is too small for the lab.
void draw_too_small(screen *s);

void draw_arm(lab *l, screen *s, area a);
void draw_curves(lab *l, screen *s, area a);
void draw_parameters(lab *l, screen *s, area a);
void draw_values(lab *l, screen *s, area a);
void draw_predictors(lab *l, screen *s, area a);
// The controller's panel and how many rows it takes of `room` [cells], 0 without a law.
int draw_controller_height(const lab *l, int room);
void draw_controller(lab *l, screen *s, area a);
void draw_log(lab *l, screen *s, area a);
void draw_help(lab *l, screen *s);
void draw_list(lab *l, screen *s);
void draw_comparison(lab *l, screen *s);

// A number in at most nine cells; values that are rounding show as 0.
void draw_number(char *text, size_t size, double value);

// The first line to show so that the selected one is in the window.
int draw_first_line(int selected, int count, int height);
