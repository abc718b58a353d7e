// A recorded command in the place of a control law: read from a CSV file, and given at
// each sample by its time.
#include "src/rig/external/played_command.h"

#include <stdlib.h>

#include "src/base/extremes.h"
#include "src/base/instant.h"
#include "src/rig/controller_values.h"

status played_command_open(played_command *p, const parameters *known, fault *f)
{
    const control_parameters *control = &known->control;
    csv_table table;
    sample_clock clock;
    *p = (played_command){.shift = control->playback_shift,
                          .linear = control->playback_hold == PLAYBACK_LINEAR};

    // a row is a constant command, which may be meant
    status code = csv_table_read(&table, control->playback_file, 1, f);
    if (code == STATUS_OK) {
        code = csv_table_play(&table, control->rate, p->shift, known->run.duration,
                              &clock, &p->times, p->told, f);
    }
    if (code == STATUS_OK) {
        p->rows = table.rows;
        code = csv_table_numbers(&table, control->playback_column, "V", GAPS_HELD,
                                 &p->command, f);
    }
    csv_table_finish(&table);

    // a file with faults is a scenario with faults
    if (code == STATUS_OK) {
        const double correction = sample_clock_correction(&clock, control->rate);
        for (size_t i = 1; i < p->rows; i++) {
            p->times[i] = p->times[0] + correction * (p->times[i] - p->times[0]);
        }
        p->ahead = (1 / control->rate - control->jitter) / 2;
        if (clock.period > 0) {
            p->ahead = smaller(p->ahead, clock.period / 2);
        }
    } else {
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
    double until = then + instant_tolerance(then);
    if (!p->linear) {
        until += p->ahead;
    }
    out->command = csv_table_at(p->times, p->command, p->rows, until, p->linear);
}

const controller playback_law =
    ONE_MODE_CONTROLLER("playback", "playback", sizeof(played_command *), playback_sample,
                        .tune = controller_takes_anything);
