// Routines that are built from one source for vectors of every width (src/engines/meson.build),
// with that width at the end of their names.
#pragma once

// What is built for a width of 1, 2, 4 or 8, of those names that begin with `name`.
#if defined __x86_64__
#define BY_WIDTH(name, width)                                                                      \
    ((width) == 8 ? name##8 : (width) == 4 ? name##4 : (width) == 2 ? name##2 : name##1)
#else
#define BY_WIDTH(name, width) ((void)(width), name##1)
#endif

// The name with the width at its end for which this file is built.
#define GLUE_(a, b) a##b
#define GLUE(a, b)  GLUE_(a, b)
