#include "ui/commands/command.h"
#include "ui/commands/explore.h"

static const option_row rows[] = {
    {.name = "keys",
     .type = OPTION_TEXT,
     .value = "KEYS",
     .help = "press these keys: characters, and <Right>, <Enter>, <C-l>...",
     PLACE(keys)},
    {.name = "script",
     .type = OPTION_FILE,
     .value = "FILE|-",
     .help = "carry out commands, one a line, as : takes them",
     PLACE(script)},
    {.name = "size",
     .type = OPTION_SIZE,
     .value = "WIDTHxHEIGHT",
     .help = "print a screen of this size in characters (120x40)",
     PLACE(size),
     .high = 1000,
     .unit = "characters"},
    {.name = "glyphs",
     .type = OPTION_CHOICE,
     .value = "braille|blocks|ascii",
     .help = "characters to draw with",
     PLACE(glyphs)},
    {.name = "theme",
     .type = OPTION_CHOICE,
     .value = "dark|light|mono",
     .help = "colours for that ground",
     PLACE(theme)},
    {.name = "colours",
     .alias = "colors",
     .type = OPTION_CHOICE,
     .value = "auto|true|256|16|mono",
     .help = "how many of them the terminal has",
     PLACE(colours)},
};
const option_table lab_options = OPTION_TABLE("Options", rows);

const command lab_command = {
    .name = "lab",
    .group = GROUP_ONE_RUN,
    .operands = "[SCENARIO]",
    .summary = "Explore a run on the terminal",
    .help = "Opens corrected/first-impact if no scenario is named; ? lists the keys. With --keys, "
            "--script or\n--size nothing is shown live: the keys are pressed, then the script's "
            "screen is printed as text.\n",
    .most = 1,
    .takes_scenarios = true,
    .options = {&set_options, &lab_options, &quiet_options},
    .draws = true,
    .run = explore,
};
