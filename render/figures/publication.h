// Pictures for other people's pages: the file itself, its caption beside it where the picture has
// none, and the LaTeX that sets both.
#pragma once

#include "render/figures/artwork.h"

// Writes a plotted figure as the options ask: the picture at path, with `with_csv` its numbers
// beside it, with a bare look its caption as a .txt beside it, and the figure environment at
// o->latex. Returns what figure_write does; STATUS_BAD_ARGUMENT also where the options ask for
// recorded signals, which the figure has none of.
status figure_publish(const figure *fig, const figure_options *o, const char *path, bool with_csv,
                      fault *f);

// The same for any artwork, which was opened with o.
status artwork_publish(const artwork *a, const figure_options *o, const char *path, bool with_csv,
                       fault *f);

// Takes --from and --to as the ends of a figure's horizontal axis.
void figure_take_range(figure *fig, const figure_options *o);

// Writes title and caption as plain text into the .txt beside a picture.
status caption_write(const artwork *a, const char *file, fault *f);

// Prints a figure environment: the picture as seen from the folder of the .tex file, with its
// width, alternative text, caption and the label fig:NAME of the picture's own name.
void latex_print(FILE *stream, const artwork *a, const char *tex, const char *file);
