#include "ui/explorer/panels/run_lines.h"

#include <assert.h>

enum { PERIOD = 16 }; // dots of a pattern

unsigned style_pattern(line_style style)
{
    static const unsigned patterns[] = {[LINE_SOLID] = 0xffff,
                                        [LINE_DASHED] = 0x1f1f,
                                        [LINE_DOTTED] = 0x3333,
                                        [LINE_DASH_DOT] = 0xefef};
    return patterns[style];
}

unsigned run_pattern(int index)
{
    static const unsigned patterns[] = {0x1f1f, 0x3333, 0x0fff, 0x1111, 0x33ff, 0x0333, 0x0101};
    enum { PATTERNS = sizeof patterns / sizeof patterns[0] };
    assert(index >= 0);
    return patterns[index % PATTERNS];
}

bool line_has_dot(unsigned pattern, long across)
{
    return (pattern >> (unsigned)((across % PERIOD + PERIOD) % PERIOD) & 1u) != 0;
}

void draw_line_sample(screen *s, int x, int y, int cells, unsigned pattern, ink colour)
{
    assert(s != NULL);
    const canvas line = {s, x, y, cells, 1};
    for (int i = 0; i < 2 * cells; i++) {
        if (line_has_dot(pattern, i)) {
            canvas_dot(&line, i, 2, colour);
        }
    }
}
