// Options that several commands share.
#include "ui/commands/command.h"

static const option_row set_rows[] = {
    {.name = "set",
     .type = OPTION_PARAMETERS,
     .value = "PATH=VALUE",
     .help = "give a parameter another value (may be repeated)",
     PLACE(sets)},
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
     .type = OPTION_CHOICE,
     .value = "three-quarter|top|side",
     .help = "where it is seen from (three-quarter)",
     PLACE(camera)},
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
    {.name = "overlay",
     .type = OPTION_FILE,
     .value = "FILE.csv",
     .help = "points of reference data over recorded signals",
     PLACE(overlay)},
    {.name = "mono", .type = OPTION_FLAG, .help = "black and greys on white", PLACE(mono)},
    {.name = "dark", .type = OPTION_FLAG, .help = "on near black", PLACE(dark)},
    {.name = "width",
     .type = OPTION_NUMBER,
     .value = "MM",
     .help = "width of the page in millimetres",
     PLACE(width),
     .low = 60,
     .high = 400,
     .unit = "mm"},
    {.name = "dpi",
     .type = OPTION_NUMBER,
     .value = "N",
     .help = "resolution of a PNG (200)",
     PLACE(dpi),
     .low = 30,
     .high = 1200},
};
const option_table page_options = OPTION_TABLE("Pages", page_rows);
