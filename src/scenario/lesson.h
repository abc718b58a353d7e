// A lesson: steps that a student goes through in the terminal lab, with answers that can be
// checked. It stands in a scenario file, under `lesson:`.
#pragma once

#include <stdbool.h>

enum { LESSON_PARAMETERS = 6, LESSON_CHOICES = 6, LESSON_COMMANDS = 8 };
enum { LESSON_PINNED_RUNS = 7 }; // that the lab pins at most

// What has to be so before a step is done.
typedef enum lesson_check {
    LESSON_READ,   // nothing: it is read
    LESSON_NUMBER, // a number was answered, as near as `within` to a quantity of the run
    LESSON_CHOICE, // the right one of several answers was given
    LESSON_CURSOR, // the cursor is near an instant of the run
    LESSON_VALUE,  // a parameter has a value at the cursor
    LESSON_PINNED, // so many runs are pinned
    LESSON_RATIO   // a quantity of the run is in a range, as a share of the baseline's
} lesson_check;

typedef struct lesson_step {
    char *say;  // what to do or to think about
    char *then; // said when it is done, "" for nothing
    char *hint; // said to who asks before, "" for none
    lesson_check check;
    int quantity;     // NUMBER, CURSOR, RATIO: index in summary_table
    double within;    // NUMBER: share of the quantity; CURSOR: [s]; VALUE: share of the value
    double offset;    // CURSOR: after the quantity's instant [s]
    double low, high; // RATIO
    int parameter;    // VALUE: index in parameter_table
    double value;     // VALUE, in the parameter's unit
    char *choices[LESSON_CHOICES];
    int choice_count, right;         // CHOICE: the right one, from 0
    int pinned;                      // PINNED
    char *commands[LESSON_COMMANDS]; // of the lab, that do the step
    int command_count;
} lesson_step;

typedef struct lesson {
    int parameters[LESSON_PARAMETERS]; // that matter, indices in parameter_table
    int parameter_count;
    lesson_step *steps;
    int step_count; // 0: there is no lesson
} lesson;

// Frees what a lesson holds; one of zeroes is allowed.
void lesson_finish(lesson *l);

// A copy of one's own. False without memory, and then nothing is to be freed.
bool lesson_copy(lesson *copy, const lesson *l);
