// The studies of the command study, a file each.
#pragma once

#include "ui/commands/command.h"

typedef struct study_topic {
    const char *name;
    const char *scenario; // that it is made of if none is named
    // makes the study and writes what is asked for; returns the exit status
    int (*make)(const arguments *a, scenario *s);
} study_topic;

// Error against cost of the methods of time integration.
extern const study_topic methods_topic;

// How far a number of links is from a beam.
extern const study_topic links_topic;

// Force error and phase of control laws over frequency.
extern const study_topic follow_topic;
