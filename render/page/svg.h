// SVG text: ids that do not depend on what was drawn before, and pictures in fewer bytes.
#pragma once

#include <glib.h>
#include <stdbool.h>

// cairo makes ids from counters of the whole process ("surface96"), so that the second figure of a
// program differs from the first. Returns the SVG with the number in every id="name<number>", and
// in every reference to it, replaced by its place in the order of the ids. Free the result with
// g_free.
char *svg_renumber_ids(const char *svg);

// Puts a prefix before every id and every reference to one, so that several SVGs can stand in one
// page. Free the result with g_free.
char *svg_prefix_ids(const char *svg, const char *prefix);

// Omits the outlines of letters (symbols) that an earlier SVG of the same page contains, and refers
// to those. `known` has outline to id, both owned by it; new ones are added. Free the result with
// g_free.
char *svg_share_symbols(const char *svg, GHashTable *known);

// The same picture in fewer bytes: lengths to a hundredth of a point (those of lines to a tenth),
// colours as #rrggbb, without metadata and default attributes, and with successive lines of one
// style in one path. Texts between tags stay as they are. The report of the whole thesis has 1.8 MB
// by it instead of 3.4 (tests/test_figures.c). Free the result with g_free.
char *svg_compact(const char *svg);

// Whether this thread is executing in regular expressions, which crash without memory. For a signal
// handler.
bool svg_in_patterns(void);
