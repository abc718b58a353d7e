// The parts of parameters_resolve, for the files that share them.
#pragma once

#include "src/tables/parameters.h"

// Whether the parameter of a field was given.
#define IS_SET(p, field) ((p)->set[PARAMETER_INDEX(field)] != 0)

// The path of the first of some parameters, ended by -1, that was given: of those that
// contradict one another it is the one to blame. "" if all are defaults.
static inline const char *first_given(const parameters *p, const int *indices)
{
    for (; *indices >= 0; indices++) {
        if (p->set[*indices]) {
            return parameter_table[*indices].path;
        }
    }
    return "";
}

// A fault that several parameters make together, in the order in which they are to blame.
#define BLAME1(p, a) first_given(p, (const int[]){PARAMETER_INDEX(a), -1})
#define BLAME2(p, a, b)                                                                  \
    first_given(p, (const int[]){PARAMETER_INDEX(a), PARAMETER_INDEX(b), -1})
#define BLAME3(p, a, b, c)                                                               \
    first_given(p, (const int[]){PARAMETER_INDEX(a), PARAMETER_INDEX(b),                 \
                                 PARAMETER_INDEX(c), -1})

// The shape of the arm and where it starts, all else being given. STATUS_BAD_SCENARIO
// with a sentence and the path to blame.
status parameters_resolve_arm(parameters *p, fault *f);
