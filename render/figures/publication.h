// Pictures for publications: the file, a file with its caption if the picture has none, and the
// LaTeX code for both.
#pragma once

#include "render/figures/artwork.h"

// Writes a plotted figure according to the options: the picture at path, with `with_csv` a CSV of
// its numbers, with a bare look a .txt with its caption, and the figure environment at o->latex.
// Returns the status of figure_write; STATUS_BAD_ARGUMENT also if the options name recorded
// signals, because the figure has none.
status figure_publish(const figure *fig, const figure_options *o, const char *path, bool with_csv,
                      fault *f);

// The same for any artwork that was opened with o.
status artwork_publish(const artwork *a, const figure_options *o, const char *path, bool with_csv,
                       fault *f);

// Sets the ends of a figure's horizontal axis to --from and --to.
void figure_take_range(figure *fig, const figure_options *o);

// Writes title and caption as plain text into the .txt of a picture.
status caption_write(const artwork *a, const char *file, fault *f);

// Prints a figure environment: the path of the picture relative to the folder of the .tex file, its
// width, alternative text, caption and the label fig:NAME with the name of the picture.
void latex_print(FILE *stream, const artwork *a, const char *tex, const char *file);
