// The parts of the terminal lab's screen, each drawn into an area of a grid of cells.
#pragma once

#include "ui/lab/lab.h"

typedef struct area {
    int x, y, width, height; // [cells]
} area;

void draw_arm(lab *l, screen *s, area a);
void draw_curves(lab *l, screen *s, area a);
void draw_parameters(lab *l, screen *s, area a);
void draw_values(lab *l, screen *s, area a);
void draw_predictors(lab *l, screen *s, area a);
void draw_log(lab *l, screen *s, area a);
void draw_help(lab *l, screen *s);
void draw_list(lab *l, screen *s);
void draw_comparison(lab *l, screen *s);

// A number in at most nine cells; values that are rounding show as 0.
void draw_number(char *text, size_t size, double value);

// The first line to show so that the selected one is in the window.
int draw_first_line(int selected, int count, int height);
