// SVG text: ids that do not depend on what was drawn before, and pictures in fewer bytes.
#pragma once

#include <glib.h>

// cairo makes ids from counters of the whole process ("surface96"), so that the second figure of a
// program differs from the first. Returns the SVG with the number in every id="name<number>", and
// in every reference to it, replaced by its place in the order of the ids. Free the result with
// g_free.
char *svg_renumber_ids(const char *svg);

// The SVG as an element of a page with others, in fewer bytes: without the XML declaration and
// metadata; with a prefix before every id; lengths to a hundredth of a point (those of lines to a
// tenth), colours as #rrggbb, without default attributes, successive lines of one style in one
// path. Outlines of letters (symbols) that an earlier SVG of the page contains are omitted and
// referred to there: `known` has outline to id, both owned by it; new ones are added. Texts between
// tags stay as they are. The report of the whole thesis has 1.8 MB by it instead of 3.4
// (tests/test_figures.c). Free the result with g_free.
char *svg_for_page(const char *svg, const char *prefix, GHashTable *known);
