// A machine that starts no programs.
#include "src/rig/external/supervisor.h"

#include <errno.h>

int supervised_program_start(supervised_program *program, const char *command)
{
    (void)command;
    *program = (supervised_program){.supervisor = 0};
    return ENOSYS;
}

int supervised_program_end(supervised_program *program)
{
    *program = (supervised_program){.supervisor = 0};
    return -1;
}
