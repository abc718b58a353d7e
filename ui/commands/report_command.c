// impactlab report: figures and tables as one web page and one PDF.
#include "ui/commands/command.h"

#include <stdlib.h>

#include "render/drawing.h"
#include "src/base/shipped.h"
#include "ui/commands/progress.h"

// The command: writes the report of what is named, else of the whole thesis.
static int write_report(const arguments *a)
{
    const char *folder = "report";
    if (a->output != NULL) {
        folder = a->output;
    }
    int items = a->operand_count;
    if (items == 0) {
        items = drawing()->thesis_figure_count();
    }

    // each item is computed, then drawn
    const int steps = 2 * items;
    fault f = {0};
    run_monitor *monitor = work_begin(a, "steps", steps);
    char *page = NULL;
    if (a->live) {
        page = shipped_path(SHIPPED_PAGE);
    }
    const report_request what = {a->operands, a->operand_count, page};
    const status code = drawing()->report_write(folder, &what, monitor, &f);
    free(page);
    work_end();

    if (code == STATUS_STOPPED) {
        complain("stopped: %d of %d steps were done, the report is as it was before",
                 monitor->pieces, steps);
        return EXIT_FAILED;
    }
    if (code != STATUS_OK) {
        return complain_fault(&f);
    }
    if (!a->quiet) {
        say("%s/report.html\n%s/report.pdf\n", folder, folder);
    }
    return EXIT_DONE;
}

static const option_row report_rows[] = {
    OUTPUT_OPTION(PLACE, "FOLDER", "folder to write to (report)"),
    OPTION(FLAG, "live", NULL,
           "under each figure of a scenario the lab's page, whose knobs move it",
           PLACE(live)),
};

const command report_command = {
    .name = "report",
    .group = GROUP_THESIS,
    .summary = "Figures and tables as one web page and one PDF",
    .operands = "[SCENARIO|RECIPE.yaml]...",
    .least = 0,
    .most = 64,
    .takes_scenarios = true,
    .draws = true,
    .help =
        "Of the scenarios and recipes named, or without any of the whole thesis. Into "
        "the folder 'report' unless -o says otherwise. The page needs no other file and "
        "no network. Under\n"
        "each item stand its scenario, its model and the command that makes it again.\n"
        "^C ends it and leaves the report of before (exit status 130).\n",
    .options = {OWN_OPTIONS(report_rows), &quiet_options},
    .run = write_report,
};
