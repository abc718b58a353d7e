// Names of picture files: what their endings say, and the files that stand beside them.
#pragma once

#include "src/base/fault.h"

typedef enum picture_format {
    FORMAT_NONE,
    FORMAT_PNG,
    FORMAT_PDF,
    FORMAT_SVG
} picture_format;

// The ending of a path's last part with its dot; without one its end.
const char *picture_ending(const char *path);

// The format that a path's extension (.png, .pdf, .svg) or a bare word (png) names.
picture_format picture_format_of(const char *path);

// Checks in advance whether picture_write can write to path: STATUS_BAD_ARGUMENT for an
// unknown extension, STATUS_CANNOT_WRITE for a folder that does not exist.
status picture_check_path(const char *path, fault *f);

// The path of a picture with another ending, to be freed with g_free.
char *picture_beside(const char *path, const char *ending);

// The picture that LaTeX reads for the one at a path: of an SVG, which its
// \includegraphics cannot read, the PDF beside it. Free with g_free.
char *picture_for_latex(const char *path);
