// Options that several commands share.
#include "ui/commands/command.h"

#include <math.h>

static const option_row set_rows[] = {
    {.name = "set",
     .type = OPTION_PARAMETERS,
     .value = "PATH=VALUE",
     .help = "give a parameter another value (may be repeated)",
     PLACE(sets)},
    {.name = "allow-code",
     .type = OPTION_FLAG,
     .help = "let the scenario start the program or load the plug-in that it names",
     PLACE(allow_code)},
};
const option_table set_options = OPTION_TABLE("Options", set_rows);

static const option_row vary_rows[] = {
    {.name = "vary",
     .type = OPTION_PARAMETERS,
     .value = "PATH=a:b:n",
     .help = "vary a parameter: n values from a to b (may be repeated)",
     PLACE(varies)},
};
const option_table vary_options = OPTION_TABLE("Options", vary_rows);

static const option_row json_rows[] = {
    {.name = "json",
     .type = OPTION_RESULT,
     .value = "FILE|-",
     .help = "write the results as JSON; - is the standard output",
     PLACE(json)},
};
const option_table json_options = OPTION_TABLE("Options", json_rows);

static const option_row drawn_rows[] = {
    {.name = "plot",
     .type = OPTION_PICTURE,
     .value = "FILE.{png,pdf,svg}",
     .help = "draw the study; a CSV of what is drawn beside it",
     PLACE(plot)},
};
const option_table drawn_options = OPTION_TABLE("Options", drawn_rows);

static const option_row quiet_rows[] = {
    {.name = "quiet", .letter = 'q', .type = OPTION_FLAG, .help = "print no summary", PLACE(quiet)},
};
const option_table quiet_options = OPTION_TABLE("Options", quiet_rows);

// arguments_read prints the help itself
static const option_row help_rows[] = {
    {.name = "help", .letter = 'h', .type = OPTION_FLAG, .help = "print this help"},
};
const option_table help_options = OPTION_TABLE("Options", help_rows);

static const option_row view_rows[] = {
    {.name = "gl",
     .type = OPTION_CHOICE,
     .value = "osmesa|egl|cairo|auto",
     .help = "what draws the arm (auto: the first that is installed)",
     PLACE(gl)},
    {.name = "camera",
     .type = OPTION_WORD,
     .value = "three-quarter|top|side|tip",
     .help = "where it is seen from (three-quarter); or two angles as -60,40: degrees from "
             "the arm's heading and above the floor",
     PLACE(camera)},
    {.name = "exaggerate",
     .type = OPTION_NUMBER,
     .value = "X",
     .help = "draw the arm's bending X times as large, and say so",
     PLACE(exaggerate),
     .low = 1,
     .high = 1000},
    {.name = "inset",
     .type = OPTION_FLAG,
     .help = "show the contact from near by in a corner, too",
     PLACE(inset)},
    {.name = "size",
     .type = OPTION_SIZE,
     .value = "WIDTHxHEIGHT",
     .help = "of the picture in pixels (1280x720)",
     PLACE(size),
     .high = 100000,
     .unit = "pixels"},
};
const option_table view_options = OPTION_TABLE("The arm in space", view_rows);

static const option_row page_rows[] = {
    {.name = "width",
     .type = OPTION_LENGTH,
     .value = "85mm|180mm",
     .help = "width of the page; everything is laid out anew",
     PLACE(width),
     .low = 60,
     .high = 400},
    {.name = "height",
     .type = OPTION_LENGTH,
     .value = "60mm",
     .help = "height of a plot (as its panels want)",
     PLACE(height),
     .low = 20,
     .high = 600},
    {.name = "font",
     .type = OPTION_TEXT,
     .value = "serif|sans|NAME",
     .help = "family of all letters (sans)",
     PLACE(font)},
    {.name = "font-size",
     .type = OPTION_NUMBER,
     .value = "PT",
     .help = "size of labels (8); others go with it, none below 6",
     PLACE(font_size),
     .low = 6,
     .high = 24,
     .unit = "pt"},
    {.name = "theme",
     .type = OPTION_CHOICE,
     .value = "light|dark|mono",
     .help = "colours on white, on near black, or greys (light)",
     PLACE(theme)},
    {.name = "bare",
     .type = OPTION_FLAG,
     .help = "without title and caption, which go to a .txt beside",
     PLACE(bare)},
    {.name = "transparent", .type = OPTION_FLAG, .help = "without a ground", PLACE(transparent)},
    {.name = "dpi",
     .type = OPTION_NUMBER,
     .value = "N",
     .help = "resolution of a PNG (200)",
     PLACE(dpi),
     .low = 30,
     .high = 1200},
    {.name = "overlay",
     .type = OPTION_TEXT,
     .value = "FILE.csv[:COLUMN][@SHIFT]",
     .help = "points of measured data over recorded signals",
     PLACE(overlay)},
    {.name = "signals",
     .type = OPTION_TEXT,
     .value = "A,B+C",
     .help = "recorded signals to show: panels, joined by +",
     PLACE(signals)},
    {.name = "from",
     .type = OPTION_NUMBER,
     .value = "X",
     .help = "where the horizontal axis begins",
     PLACE(from),
     .low = -1e9,
     .high = 1e9,
     .initial = (double)NAN},
    {.name = "to",
     .type = OPTION_NUMBER,
     .value = "X",
     .help = "where it ends",
     PLACE(to),
     .low = -1e9,
     .high = 1e9,
     .initial = (double)NAN},
    {.name = "latex",
     .type = OPTION_RESULT,
     .value = "FILE.tex",
     .help = "write the figure environment with caption and label",
     PLACE(latex)},
    {.name = "mono", .type = OPTION_FLAG, .help = "the same as --theme mono", PLACE(mono)},
    {.name = "dark", .type = OPTION_FLAG, .help = "the same as --theme dark", PLACE(dark)},
};
const option_table page_options = OPTION_TABLE("Pictures", page_rows);
