// Makes an SVG small enough to stand in a page with many others.
#pragma once

// The same picture in fewer bytes: lengths to a hundredth of a point (those of lines to a tenth),
// colours as #rrggbb, without metadata and without what is the default anyway, lines of one style
// that follow each other in one path. Texts between tags stay as they are. Free the result with
// g_free.
char *svg_compact(const char *svg);
