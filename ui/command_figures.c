#include "ui/command.h"

static int figures(const arguments *a)
{
    (void)a;
    return complain("figures is not there yet");
}

const command figures_command = {
    .name = "figures",
    .operands = "[ID]...",
    .options = "of",
    .summary = "The figures of the thesis",
    .help = "",
    .most = 1 << 20,
    .run = figures,
};
