// What impactlab robust draws from, and the cases it looks at one by one: a file of lines.
//
//     PATH=a:b  PATH=v1,v2             drawn for every run, as a sweep takes them
//     case TITLE: PATH=VALUE; ...      what differs in a case; push=IMPULSE@TIME [N s]@[s] too
//
// Empty lines and those that begin with # are ignored. Without cases the runs are drawn over the
// scenario as it is, with cases over the scenario of each of them.
#pragma once

#include "src/scenario/scenario.h"

enum { ROBUST_CASE_PUSHES = 4 }; // at most

typedef struct robust_case {
    const char *file;                        // borrowed from the set
    int line;                                // in the file, from 1
    char *title;                             // borrowed from the set's text
    char **settings;                         // "PATH=VALUE"; borrowed from the set's list
    int setting_count;                       //
    double push_impulse[ROBUST_CASE_PUSHES]; // at the tip, positive towards growing angle [N s]
    double push_time[ROBUST_CASE_PUSHES];    // [s]
    int push_count;
} robust_case;

typedef struct robust_set {
    char *file;         // its path; owned
    char *text;         // owned; the lines point into it
    char **lines;       // what is drawn; owned
    int *line_numbers;  // of each in the file, from 1; owned
    int count;          // of lines
    robust_case *cases; // owned
    int case_count;
    char **settings; // of all cases, one behind the other; owned
} robust_set;

// Reads a set file. STATUS_CANNOT_READ, STATUS_BAD_ARGUMENT (nothing is drawn, too long, a case
// that cannot be read) or STATUS_NO_MEMORY, with a sentence in f that names file and line; then the
// set is empty, and nothing is to be freed.
status robust_set_read(robust_set *set, const char *path, fault *f);
void robust_set_finish(robust_set *set);

// The scenario of a case, c NULL: the base's own. It borrows all but its parameters and its actions
// from the base; robust_case_finish. STATUS_BAD_ARGUMENT if a setting or a push does not go, with
// robust_case_fault's sentence, STATUS_NO_MEMORY.
status robust_case_scenario(scenario *derived, const scenario *base, const robust_case *c,
                            fault *f);
void robust_case_finish(scenario *derived);

// What is wrong with a case, with file, line and title before the sentence. Returns the code of
// why.
status robust_case_fault(const robust_case *c, const fault *why, fault *f);
