// The look of runs side by side, one table for figures and screens: run k of a picture
// has the colour and the dash k wherever it shows, in a curve, an impulse or a key.
#pragma once

#include "render/page/page.h"

// Runs with a look of their own; runs that one panel shows, each with another dash; the
// rank of a run that others are held against and that stands back: a thin grey line.
enum { RUN_STYLES = 8, RUNS_TOGETHER = 4, RUN_BEHIND = -1 };

typedef struct run_style {
    int slot; // of the palette: palette_series(theme, slot, 0), where there are colours
    line_style dash;
    int grey; // place of its grey without colours: palette_series(THEME_MONO, slot, grey)
} run_style;

// The look of run `rank`, counted from 1; beyond RUN_STYLES the looks come again. Any
// RUNS_TOGETHER runs in a row differ by their dash alone, so that a print in black tells
// them apart.
static inline run_style run_style_of(int rank)
{
    static const run_style styles[RUN_STYLES] = {
        {SLOT_BLUE, LINE_SOLID, 0},     {SLOT_VERMILLION, LINE_DASHED, 2},
        {SLOT_GREEN, LINE_DASH_DOT, 0}, {SLOT_PURPLE, LINE_DOTTED, 0},
        {SLOT_ORANGE, LINE_SOLID, 2},   {SLOT_SKY_BLUE, LINE_DASHED, 0},
        {SLOT_BLACK, LINE_DASH_DOT, 2}, {SLOT_GREY, LINE_DOTTED, 2},
    };
    return styles[(rank - 1) % RUN_STYLES];
}

// Its colour in a theme; in the mono one its grey.
static inline colour run_colour(figure_theme theme, int rank)
{
    const run_style look = run_style_of(rank);
    return palette_series(theme, look.slot, theme == THEME_MONO ? look.grey : 0);
}

// The colour of a lone run's impulses (rank 0), or of run `rank`'s.
static inline colour impulse_colour(figure_theme theme, int rank)
{
    return rank > 0 ? run_colour(theme, rank) : palette_series(theme, SLOT_PURPLE, 0);
}
