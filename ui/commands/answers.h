// What the manual, the tables and the commands say about words.
#pragma once

#include <stdio.h>

// Prints what answers a question best: each hit with the passage that fits, and where to read on.
// Returns how many hits there are.
int print_answers(FILE *stream, const char *question);

// Prints what has all of these words in its name: parameters, quantities, signals, headings of the
// manual. Returns how many there are; prints nothing if there are none.
int print_meanings(FILE *stream, const char *words);
