// What the lab's files ask of a machine, as an FMU has it: no files but those of its
// scenario, no programs, no plug-ins, plain memory. Each function stands for the lab's
// own of the same name, whose header says what it does.
#include <stdlib.h>
#include <string.h>

#include "src/base/clock.h"
#include "src/base/input_file.h"
#include "src/base/shipped.h"
#include "src/base/text_stream.h"
#include "src/exchange/fmu/fmu_scenario.h"
#include "src/rig/external/plugin.h"
#include "src/rig/external/process.h"

// --- version, clock, losses ------------------------------------------------------------

// The guid has version and scenario in it.
const char *lab_version(void)
{
    return fmu_given.guid;
}

// No result depends on it.
double clock_seconds(clockid_t clock)
{
    (void)clock;
    return 0;
}

// An FMU writes no output that could lack something.
void loss_unless(bool kept)
{
    (void)kept;
}

// --- files -----------------------------------------------------------------------------

static const fmu_file *find_file(const char *path)
{
    for (int i = 0; i < FMU_FILES; i++) {
        const fmu_file *file = &fmu_given.files[i];
        if (file->length > 0 && strcmp(file->path, path) == 0) {
            return file;
        }
    }
    return NULL;
}

char *input_file_read(const char *path, size_t most, size_t *length, fault *why)
{
    const fmu_file *file = find_file(path);
    if (file == NULL) {
        fault_set(why, STATUS_CANNOT_READ, "is not among the FMU's files");
        return NULL;
    }
    *length = file->length < most ? file->length : most;
    char *bytes = malloc(*length + 1);
    if (bytes == NULL) {
        fault_no_memory(why);
        return NULL;
    }
    memcpy(bytes, file->bytes, *length);
    bytes[*length] = '\0';
    return bytes;
}

status input_file_fault(const char *path, const fault *why, fault *f)
{
    return fault_set(f, why->code, "'%.300s' %.600s", path, why->text);
}

// --- code of others --------------------------------------------------------------------

// None is allowed (parameters.code_allowed), so that the rig asks for none of these.
const controller process_law = {.name = "process"};

status plugin_open(plugin *p, const char *file, fault *f)
{
    (void)p;
    (void)file;
    return fault_set(f, STATUS_NOT_ALLOWED, "an FMU loads no plug-in");
}

void plugin_close(plugin *p)
{
    (void)p;
}

process *process_create(const control_parameters *control, stop_request *stop)
{
    (void)control;
    (void)stop;
    return NULL;
}

void process_destroy(process *p)
{
    (void)p;
}

void process_tell(process *p, const control_parameters *control)
{
    (void)p;
    (void)control;
}

status process_failure(const process *p, const char **why)
{
    (void)p;
    (void)why;
    return STATUS_OK;
}
