#include "render/page/palette.h"

#include <string.h>

#define RGB(r, g, b)                                                                               \
    {                                                                                              \
        (r) / 255.0, (g) / 255.0, (b) / 255.0                                                      \
    }

enum { SLOTS = 8, STYLES = 4 };

// Okabe and Ito 2008; their yellow is too faint for lines on white and gives way to a grey.
static const colour on_white[SLOTS] = {
    RGB(0, 114, 178),   // blue
    RGB(230, 159, 0),   // orange
    RGB(0, 158, 115),   // bluish green
    RGB(86, 180, 233),  // sky blue
    RGB(204, 121, 167), // reddish purple
    RGB(213, 94, 0),    // vermillion
    RGB(30, 30, 30),    // black
    RGB(110, 110, 110), // grey
};
static const colour on_black[SLOTS] = {
    RGB(60, 160, 225),  RGB(230, 159, 0),  RGB(0, 178, 130),   RGB(86, 200, 250),
    RGB(220, 140, 185), RGB(235, 115, 20), RGB(225, 225, 225), RGB(240, 228, 66),
};
static const colour greys[] = {RGB(0, 0, 0), RGB(90, 90, 90), RGB(140, 140, 140)};

static const palette themes[] = {
    [THEME_COLOUR] = {.page = RGB(255, 255, 255),
                      .text = RGB(25, 25, 25),
                      .faint_text = RGB(95, 95, 95),
                      .axis = RGB(60, 60, 60),
                      .grid = RGB(228, 228, 228),
                      .shade = RGB(240, 243, 247),
                      .mark = RGB(130, 130, 130)},
    [THEME_MONO] = {.page = RGB(255, 255, 255),
                    .text = RGB(0, 0, 0),
                    .faint_text = RGB(80, 80, 80),
                    .axis = RGB(40, 40, 40),
                    .grid = RGB(226, 226, 226),
                    .shade = RGB(241, 241, 241),
                    .mark = RGB(120, 120, 120)},
    [THEME_DARK] = {.page = RGB(20, 22, 26),
                    .text = RGB(230, 230, 230),
                    .faint_text = RGB(165, 165, 165),
                    .axis = RGB(170, 170, 170),
                    .grid = RGB(52, 55, 60),
                    .shade = RGB(34, 39, 48),
                    .mark = RGB(135, 135, 135)},
};

const palette *palette_of(figure_theme theme)
{
    return &themes[theme];
}

colour palette_series(figure_theme theme, int slot, int place)
{
    if (theme == THEME_MONO) {
        return greys[place / 2 % 3];
    }
    slot = (slot % SLOTS + SLOTS) % SLOTS;
    return theme == THEME_DARK ? on_black[slot] : on_white[slot];
}

line_style palette_style(const figure_series *series, int index)
{
    bool taken[STYLES] = {false};
    line_style style = LINE_SOLID;
    for (int i = 0; i <= index; i++) {
        style = series[i].style;
        if (series[i].secondary) {
            continue;
        }
        // the orders in which styles give way keep the lines as plain as possible
        static const line_style others[] = {LINE_SOLID, LINE_DASHED, LINE_DASH_DOT, LINE_DOTTED};
        for (int k = 0; k < STYLES && taken[style]; k++) {
            style = taken[others[k]] ? style : others[k];
        }
        taken[style] = true;
    }
    return series[index].secondary ? LINE_DASHED : style;
}

void set_colour(cairo_t *cr, colour c)
{
    cairo_set_source_rgb(cr, c.red, c.green, c.blue);
}

void set_line_style(cairo_t *cr, line_style style, double width)
{
    static const double dashed[] = {5, 2.2}, dotted[] = {1.2, 1.8}, dash_dot[] = {7, 2, 1.4, 2};
    double scaled[4];
    const double *pattern = style == LINE_DASHED   ? dashed
                            : style == LINE_DOTTED ? dotted
                                                   : dash_dot;
    int count = style == LINE_SOLID ? 0 : style == LINE_DASH_DOT ? 4 : 2;
    for (int i = 0; i < count; i++) {
        scaled[i] = pattern[i] * width;
    }
    cairo_set_dash(cr, scaled, count, 0);
    cairo_set_line_width(cr, width);
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(cr, style == LINE_SOLID ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
}
