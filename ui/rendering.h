// Where the rendering libraries are: Pango and Cairo cost three times the start of a program that
// only computes. So there are two programs of the same objects. impactlab-draw has the libraries
// (rendering_here.c); impactlab has none (rendering_elsewhere.c) and becomes the other one, with
// the same words, where something is to be drawn.
#pragma once

#include <stdbool.h>

// To be called first: the words that the program was called with, and what ends it where a picture
// cannot be drawn for want of memory or of a font, which is given a reason and must not return.
void rendering_begin(char **argv, void (*end)(const char *reason));

// Begins anew as the program that draws unless this one does. To be called before anything is
// computed or said; a program without it ends the process with a sentence.
void rendering_needed(void);

// Whether this thread is at work in libraries that crash where they get no memory: those of fonts
// (render/page/text.h), and cairo where it strokes (render/page/picture_file.h). For a handler of
// signals.
bool rendering_in_libraries(void);
