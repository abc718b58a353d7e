// The colours of pictures: of themes, of series and of a continuous scale.
#include "render/page/page.h"

#include <assert.h>
#include <math.h>

#define RGB(r, g, b)                                                                     \
    {                                                                                    \
        (r) / 255.0, (g) / 255.0, (b) / 255.0                                            \
    }

// Okabe and Ito 2008; their yellow is too faint for lines on white and gives way to a
// grey.
static const colour on_white[PALETTE_SLOTS] = {
    RGB(0, 114, 178),   // blue
    RGB(230, 159, 0),   // orange
    RGB(0, 158, 115),   // bluish green
    RGB(86, 180, 233),  // sky blue
    RGB(204, 121, 167), // reddish purple
    RGB(213, 94, 0),    // vermillion
    RGB(30, 30, 30),    // black
    RGB(110, 110, 110), // grey
};
static const colour on_black[PALETTE_SLOTS] = {
    RGB(60, 160, 225),  RGB(240, 170, 10), RGB(0, 178, 130),   RGB(110, 210, 250),
    RGB(220, 140, 185), RGB(225, 95, 20),  RGB(225, 225, 225), RGB(145, 145, 145),
};
static const colour greys[] = {RGB(0, 0, 0), RGB(90, 90, 90), RGB(140, 140, 140)};

static const palette themes[] = {
    // page, text, faint text, axis, grid, shade, mark
    [THEME_COLOUR] = {RGB(255, 255, 255), RGB(25, 25, 25), RGB(95, 95, 95),
                      RGB(60, 60, 60), RGB(228, 228, 228), RGB(240, 243, 247),
                      RGB(130, 130, 130)},
    [THEME_MONO] = {RGB(255, 255, 255), RGB(0, 0, 0), RGB(80, 80, 80), RGB(40, 40, 40),
                    RGB(226, 226, 226), RGB(241, 241, 241), RGB(120, 120, 120)},
    [THEME_DARK] = {RGB(20, 22, 26), RGB(230, 230, 230), RGB(165, 165, 165),
                    RGB(170, 170, 170), RGB(52, 55, 60), RGB(34, 39, 48),
                    RGB(135, 135, 135)},
};

const palette *palette_of(figure_theme theme)
{
    assert((unsigned)theme < sizeof themes / sizeof themes[0]);
    return &themes[theme];
}

// Without colours series go through three greys by their places in a panel, two of
// each.
colour palette_series(figure_theme theme, int slot, int place)
{
    if (theme == THEME_MONO) {
        return greys[place / 2 % 3];
    }
    slot = (slot % PALETTE_SLOTS + PALETTE_SLOTS) % PALETTE_SLOTS;
    if (theme == THEME_DARK) {
        return on_black[slot];
    }
    return on_white[slot];
}

int palette_slot(int index)
{
    static const int slots[PALETTE_SLOTS] = {SLOT_BLUE,   SLOT_VERMILLION, SLOT_GREEN,
                                             SLOT_PURPLE, SLOT_ORANGE,     SLOT_SKY_BLUE,
                                             SLOT_BLACK,  SLOT_GREY};
    assert(index >= 0);
    return slots[index % PALETTE_SLOTS];
}

// A share of viridis, between the two nearest of nine points, or a grey.
colour palette_shade(figure_theme theme, double share)
{
    if (theme == THEME_MONO) {
        // even steps of lightness, short of the page's white and of the lines' black
        double grey = 0.15 + 0.82 * fmin(fmax(share, 0), 1);
        return (colour){grey, grey, grey};
    }

    static const colour points[] = {
        RGB(0x44, 0x01, 0x54), RGB(0x47, 0x2d, 0x7b), RGB(0x3b, 0x52, 0x8b),
        RGB(0x2c, 0x72, 0x8e), RGB(0x21, 0x91, 0x8c), RGB(0x28, 0xae, 0x80),
        RGB(0x5e, 0xc9, 0x62), RGB(0xad, 0xdc, 0x30), RGB(0xfd, 0xe7, 0x25),
    };
    enum { LAST = sizeof points / sizeof points[0] - 1 };

    // between the two nearest points
    double at = fmin(fmax(share, 0), 1) * LAST;
    int i = at >= LAST ? LAST - 1 : (int)at;
    return colour_between(points[i], points[i + 1], at - i);
}

colour colour_between(colour a, colour b, double share)
{
    return (colour){a.red + share * (b.red - a.red),
                    a.green + share * (b.green - a.green),
                    a.blue + share * (b.blue - a.blue)};
}

void set_colour(cairo_t *cr, colour c)
{
    cairo_set_source_rgb(cr, c.red, c.green, c.blue);
}

// Dashes are multiples of the line's width, so that patterns look alike at any width.
void set_line_style(cairo_t *cr, line_style style, double width)
{
    assert(width > 0);
    static const double dashed[] = {5, 2.2}, dotted[] = {1.2, 1.8},
                        dash_dot[] = {7, 2, 1.4, 2};
    double scaled[4] = {0};

    // lengths are multiples of the line's width
    const double *pattern = NULL;
    int count = 0;
    if (style == LINE_DASHED) {
        pattern = dashed;
        count = 2;
    } else if (style == LINE_DOTTED) {
        pattern = dotted;
        count = 2;
    } else if (style == LINE_DASH_DOT) {
        pattern = dash_dot;
        count = 4;
    }
    for (int i = 0; i < count; i++) {
        scaled[i] = pattern[i] * width;
    }

    cairo_set_dash(cr, scaled, count, 0);
    cairo_set_line_width(cr, width);
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_BUTT);
    if (style == LINE_SOLID) {
        cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
    }
}
