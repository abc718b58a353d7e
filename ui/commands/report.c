#include "ui/commands/command.h"

#include "render/figures/report.h"

#define DEFAULT_FOLDER "report"

static int report(const arguments *a)
{
    fault f = {0};
    const char *folder = a->output ? a->output : DEFAULT_FOLDER;
    if (report_write(folder, a->operands, a->operand_count, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    if (!a->quiet) {
        say("%s/report.html\n%s/report.pdf\n", folder, folder);
    }
    return EXIT_DONE;
}

static const option_row rows[] = {
    {.name = "output",
     .letter = 'o',
     .type = OPTION_PLACE,
     .value = "FOLDER",
     .help = "folder to write to (report)",
     PLACE(output)},
};
static const option_table options = OPTION_TABLE("Options", rows);

const command report_command = {
    .name = "report",
    .group = GROUP_THESIS,
    .operands = "[SCENARIO|RECIPE.yaml]...",
    .summary = "Figures and tables as one web page and one PDF",
    .help = "Of the scenarios and recipes named, or without any of the whole thesis. Into the "
            "folder 'report' unless -o says otherwise. The page needs no other file and "
            "no network. Under\neach item stand its scenario, its model and the command that "
            "makes it again.\n",
    .most = 64,
    .takes_scenarios = true,
    .options = {&options, &quiet_options},
    .run = report,
};
