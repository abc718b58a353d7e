// A recorded command in the place of a control law: read from a CSV file, and given at
// each sample by its time.
#include "src/rig/external/played_command.h"

#include <stdlib.h>

#include "src/base/csv_table.h"
#include "src/base/instant.h"
#include "src/rig/controller_values.h"

status played_command_open(played_command *p, const control_parameters *control, fault *f)
{
    csv_table table;
    *p = (played_command){.shift = control->playback_shift,
                          .linear = control->playback_hold == PLAYBACK_LINEAR};

    // a row is a constant command, which may be meant
    status code = csv_table_read(&table, control->playback_file, 1, f);
    if (code == STATUS_OK) {
        const char *clock = csv_table_find(&table, "t") >= 0 ? "t" : "time";
        p->rows = table.rows;
        code = csv_table_times(&table, clock, &p->times, f);
    }
    if (code == STATUS_OK) {
        code = csv_table_numbers(&table, control->playback_column, "V", false,
                                 &p->command, f);
    }
    csv_table_finish(&table);

    // a file with faults is a scenario with faults
    if (code != STATUS_OK) {
        played_command_close(p);
    }
    if (f != NULL && code != STATUS_OK && code != STATUS_NO_MEMORY) {
        f->code = code = STATUS_BAD_SCENARIO;
        f->path = "control.playback_file";
    }
    return code;
}

void played_command_close(played_command *p)
{
    free(p->times);
    free(p->command);
    *p = (played_command){.times = NULL};
}

// Its memory is the command that it was given with.
static void playback_sample(void *memory, const controller_input *in,
                            controller_output *out)
{
    const played_command *p = *(played_command *const *)memory;
    const double then = in->time - p->shift;
    out->command = csv_table_at(p->times, p->command, p->rows,
                                then + instant_tolerance(then), p->linear);
}

const controller playback_law =
    ONE_MODE_CONTROLLER("playback", "playback", sizeof(played_command *), playback_sample,
                        .tune = controller_takes_anything);
