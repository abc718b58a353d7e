// Reduces an SVG so that a page can contain many.
#pragma once

// The same picture in fewer bytes: lengths to a hundredth of a point (those of lines to a tenth),
// colours as #rrggbb, without metadata and default attributes, and with successive lines of one
// style in one path. Texts between tags stay as they are. Free the result with g_free.
char *svg_compact(const char *svg);
