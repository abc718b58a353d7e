// Commands that the command line names already and that come with later versions.
#include "ui/command.h"

static int animate(const arguments *a)
{
    (void)a;
    return complain("animate is not there yet: videos come with a later version (impactlab run "
                    "--plot draws curves)");
}

const command animate_command = {
    .name = "animate",
    .operands = "[SCENARIO]",
    .options = "so",
    .summary = "A video of a run (not there yet)",
    .help = "",
    .most = 1,
    .run = animate,
};
