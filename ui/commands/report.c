#include "ui/commands/command.h"

#include "render/figures/report.h"
#include "ui/commands/run_progress.h"

#define PIECES         "steps"

#define DEFAULT_FOLDER "report"

static int report(const arguments *a)
{
    fault f = {0};
    const char *folder = a->output ? a->output : DEFAULT_FOLDER;
    const int steps = 2 * report_length(a->operand_count); // computed, then drawn
    run_monitor *monitor = work_begin(a, PIECES, steps);
    status code = report_write(folder, a->operands, a->operand_count, monitor, &f);
    work_end();

    if (code == STATUS_STOPPED) {
        work_leave(monitor->pieces, steps, PIECES, "the report is as it was before");
    }
    if (code != STATUS_OK) {
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
            "makes it again.\n^C ends it and leaves the report of before (exit status 130).\n",
    .most = 64,
    .takes_scenarios = true,
    .options = {&options, &quiet_options},
    .run = report,
};
