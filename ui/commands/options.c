#include "ui/commands/options.h"

#include <assert.h>
#include <math.h>

#define SHARED_OPTIONS(...)                                                              \
    {                                                                                    \
        "Options", (const option_row[]){__VA_ARGS__},                                    \
            (int)(sizeof(option_row[]){__VA_ARGS__} / sizeof(option_row))                \
    }

const option_table set_options = SHARED_OPTIONS(
    OPTION(PARAMETERS, "set", "PATH=VALUE",
           "give a parameter another value (may be repeated)", PLACE(sets)),
    OPTION(FLAG, "allow-code", NULL,
           "let every scenario of the command start its program or load its plug-in, "
           "which may do whatever you can",
           PLACE(allow_code)));
const option_table vary_options = SHARED_OPTIONS(
    OPTION(PARAMETERS, "vary", "PATH=a:b:n",
           "vary a parameter: n values from a to b (may be repeated)", PLACE(varies)));
const option_table json_options = SHARED_OPTIONS(
    OPTION(RESULT, "json", "FILE|-",
           "write the results as JSON; - is the standard output", PLACE(json)));
const option_table drawn_options = SHARED_OPTIONS(
    OPTION(PICTURE, "plot", "FILE.{png,pdf,svg}",
           "draw the study; a CSV of what is drawn beside it", PLACE(plot)));
const option_table quiet_options = SHARED_OPTIONS(
    OPTION(FLAG, "quiet", NULL, "print no summary", PLACE(quiet), .letter = 'q'));

// its place is nowhere: the program prints the help
const option_table help_options =
    SHARED_OPTIONS(OPTION(FLAG, "help", NULL, "print this help", .letter = 'h'));

static const option_row view_rows[] = {
    OPTION(CHOICE, "gl", "osmesa|egl|cairo|auto",
           "what draws the arm (auto: the first that is installed)", PLACE(gl)),
    OPTION(WORD, "camera", "three-quarter|top|side|tip",
           "where it is seen from (three-quarter); or two angles as -60,40: "
           "degrees from the arm's heading and above the floor",
           PLACE(camera)),
    OPTION(
        WORD, "exaggerate", "X|auto",
        "draw the arm's bending X times as large, 1 to 1000, and say so (auto: so that "
        "it shows)",
        PLACE(exaggerate)),
    OPTION(FLAG, "inset", NULL, "show the contact from near by in a corner, too",
           PLACE(inset)),
    OPTION(SIZE, "size", "WIDTHxHEIGHT", "of the arm's picture in pixels (1280x720)",
           PLACE(size), .high = 100000, .unit = "pixels"),
};
const option_table view_options = OPTION_TABLE("The arm in space", view_rows);

static const option_row page_rows[] = {
    OPTION(LENGTH, "width", "85mm|180mm",
           "width of the page; everything is laid out for it", PLACE(width), .low = 60,
           .high = 400),
    OPTION(LENGTH, "height", "60mm", "height of a plot (as its panels want)",
           PLACE(height), .low = 20, .high = 600),
    OPTION(TEXT, "font", "serif|sans|NAME", "family of all letters (sans)", PLACE(font)),
    OPTION(NUMBER, "font-size", "PT",
           "size of labels (8); others go with it, none below 6", PLACE(font_size),
           .low = 6, .high = 24, .unit = "pt"),
    OPTION(CHOICE, "theme", "light|dark|mono",
           "colours on white, on near black, or greys (light)", PLACE(theme)),
    OPTION(FLAG, "bare", NULL, "without title and caption, which go to a .txt beside",
           PLACE(bare)),
    OPTION(FLAG, "transparent", NULL, "without a ground", PLACE(transparent)),
    OPTION(NUMBER, "dpi", "N", "resolution of a PNG (200)", PLACE(dpi), .low = 30,
           .high = 1200),
    OPTION(NUMBER, "from", "X", "where the horizontal axis begins", PLACE(from),
           .low = -1e9, .high = 1e9, .initial = (double)NAN),
    OPTION(NUMBER, "to", "X", "where it ends", PLACE(to), .low = -1e9, .high = 1e9,
           .initial = (double)NAN),
    OPTION(TEXT, "zoom", "A:B", "this stretch of the first panel, larger, in an inset",
           PLACE(zoom)),
    OPTION(RESULT, "latex", "FILE.tex",
           "write the figure environment with caption and label, for an SVG with a PDF",
           PLACE(latex)),
    OPTION(FLAG, "mono", NULL, "the same as --theme mono", PLACE(mono)),
    OPTION(FLAG, "dark", NULL, "the same as --theme dark", PLACE(dark)),
};
const option_table page_options = OPTION_TABLE("Pictures", page_rows);

static const option_row signal_rows[] = {
    OPTION(TEXT, "signals", "A,B+C", "recorded signals to show: panels, joined by +",
           PLACE(signals)),
    OPTION(FILE, "overlay", "FILE.csv[:COLUMN][@SHIFT]",
           "points of measured data over recorded signals", PLACE(overlay)),
};
const option_table signal_options = OPTION_TABLE("Pictures", signal_rows);

// --- values ----------------------------------------------------------------------------

void *option_place(const arguments *a, const option_row *o)
{
    return (char *)a + o->place;
}

// The text an option's place holds, NULL if it was not given. Only for types that store a
// text.
static const char *option_text(const arguments *a, const option_row *o)
{
    assert(o->type >= OPTION_TEXT && o->type <= OPTION_QUANTITY);
    return *(const char **)option_place(a, o);
}

bool option_is_written(const option_row *o)
{
    return o->type == OPTION_RESULT || o->type == OPTION_PICTURE ||
           o->type == OPTION_PLACE;
}

const char *option_written(const arguments *a, const option_row *o)
{
    if (option_is_written(o)) {
        return option_text(a, o);
    }
    return NULL;
}
