// Commands that the command line names already and that come with later versions.
#include "ui/command.h"

static int animate(const arguments *a)
{
    (void)a;
    return complain("animate is not there yet: videos come with a later version (impactlab run "
                    "--plot draws curves)");
}

static int sweep(const arguments *a)
{
    (void)a;
    return complain("sweep is not there yet: it comes with a later version (impactlab run --set "
                    "runs one point)");
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

const command sweep_command = {
    .name = "sweep",
    .operands = "[SCENARIO]",
    .options = "svj",
    .summary = "A run for each of many parameter values (not there yet)",
    .help = "",
    .most = 1,
    .run = sweep,
};
