// impactlab fmu: a scenario as an FMU for other simulation tools.
#include "ui/commands/command.h"

#include <stdlib.h>

#include "src/base/whole_file.h"
#include "src/exchange/fmu/fmu_export.h"
#include "ui/commands/results.h"

static status write_fmu(fmu_export *e, const char *path, fault *f)
{
    whole_file file;
    TRY(whole_file_open(&file, path, f));
    return whole_file_close(&file, fmu_export_write(e, file.stream, f), f);
}

static int export_fmu(const arguments *a, scenario *s)
{
    if (a->output == NULL) {
        return complain("fmu needs a file to write to: -o FILE.fmu");
    }

    fmu_export *e;
    fault f = {0};
    status code = fmu_export_create(&e, s, a->inputs, &f);
    if (code == STATUS_OK) {
        code = write_fmu(e, a->output, &f);
    }
    if (code == STATUS_OK && summary_wanted(a)) {
        say_title(s);
        say("%s: an FMU 2.0 for co-simulation, %s\n", a->output,
            e->has_binary ? "sources and a binary for linux64" : "sources only");
    }
    free(e);
    return code == STATUS_OK ? EXIT_DONE : complain_fault(&f);
}

static const option_row rows[] = {
    OUTPUT_OPTION(RESULT, "FILE.fmu", "file to write to, \"-\" for the standard output"),
    OPTION(TEXT, "inputs", "A,B",
           "parameters that are inputs, not all that may change during a run",
           PLACE(inputs)),
};

const command fmu_command = {
    .name = "fmu",
    .group = GROUP_CONTROL,
    .summary = "Write a scenario as an FMU for Simulink, OpenModelica, Dymola",
    .operands = "SCENARIO",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .help = "An FMU (FMI 2.0, co-simulation) steps the scenario in another simulation "
            "tool with the lab's\nown numbers. Parameters that may change during a run "
            "are inputs, as are push and motor_command,\nwhich commands the motor where "
            "the parameter commanded is true; every signal is an output.\nA binary for "
            "Linux on x86-64 and the sources for all else are inside.\n",
    .options = {&set_options, OWN_OPTIONS(rows), &quiet_options},
    .use = export_fmu,
};
