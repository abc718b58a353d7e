// The rendering libraries: loading Pango and Cairo takes three times as long as starting a program
// that only computes. Two programs are therefore built from the same objects. impactlab-draw
// contains the libraries (rendering_here.c); impactlab does not (rendering_elsewhere.c) and
// replaces itself by the other one, with the same arguments, if something has to be drawn.
#pragma once

#include <stdbool.h>

// To be called first: the arguments of the program, and the function that ends it if a picture
// cannot be drawn because memory or a font is missing. That function gets a reason and must not
// return.
void rendering_begin(char **argv, void (*end)(const char *reason));

// Replaces this program by the one that draws, unless it is that one. To be called before anything
// is computed or printed; if that program is missing, the process ends with a sentence.
void rendering_needed(void);

// Whether this thread is executing in a library that crashes without memory: those of fonts
// (render/page/text.h), and cairo while it strokes (render/page/picture_file.h). For a signal
// handler.
bool rendering_in_libraries(void);
