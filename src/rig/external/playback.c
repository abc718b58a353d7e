#include "src/rig/external/process.h"

#include <stdlib.h>

#include "src/base/csv_table.h"
#include "src/base/instant.h"
#include "src/rig/controller_values.h"

struct recorded_command {
    double *times;   // of the rows [s]
    double *command; // [V]
    size_t rows;
    double shift; // by which it comes later than recorded [s]
    bool linear;
};

status playback_create(recorded_command **created, const control_parameters *control, fault *f)
{
    csv_table table = {0};
    recorded_command *p = calloc(1, sizeof *p);
    *created = NULL;
    TRY_MEMORY(p != NULL, f);
    p->shift = control->playback_shift;
    p->linear = control->playback_hold == PLAYBACK_LINEAR;

    // a row is a constant command, which may be meant
    status code = csv_table_read(&table, control->playback_file, 1, f);
    if (code == STATUS_OK) {
        p->rows = table.rows;
        code =
            csv_table_times(&table, csv_table_find(&table, "t") >= 0 ? "t" : "time", &p->times, f);
    }
    if (code == STATUS_OK) {
        code = csv_table_numbers(&table, control->playback_column, "V", false, &p->command, f);
    }
    csv_table_finish(&table);
    if (code == STATUS_OK) {
        *created = p;
        return STATUS_OK;
    }

    // a file with faults is a scenario with faults
    playback_destroy(p);
    if (f != NULL && code != STATUS_NO_MEMORY) {
        f->code = code = STATUS_BAD_SCENARIO;
        f->path = "control.playback_file";
    }
    return code;
}

void playback_destroy(recorded_command *p)
{
    if (p != NULL) {
        free(p->times);
        free(p->command);
        free(p);
    }
}

// Its memory is the playback that it was given with.
static void sample(void *memory, const controller_input *in, controller_output *out)
{
    const recorded_command *p = *(recorded_command *const *)memory;
    const double then = in->time - p->shift;
    out->command =
        csv_table_at(p->times, p->command, p->rows, then + instant_tolerance(then), p->linear);
}

const controller playback_law = {.interface = CONTROLLER_INTERFACE,
                                 .name = "playback",
                                 .modes = (const char *const[]){"playback", NULL},
                                 .memory_size = sizeof(recorded_command *),
                                 .sample = sample,
                                 .tune = controller_takes_anything};
