// Answers to questions: what the manual, the tables and the commands have of some words.
#pragma once

#include <stdio.h>

#include "ui/commands/command.h"

// Prints what answers a question best: each hit with the passage that fits, and where to
// read on; says so if the best has less than half of the question. Returns how many hits
// there are; prints nothing if there are none.
int print_answers(FILE *stream, const command_list *all, const char *question);

// Prints what has all of these words in its name: parameters, quantities, signals,
// commands, headings of the manual. Returns how many there are; prints nothing if there
// are none.
int print_meanings(FILE *stream, const command_list *all, const char *words);
