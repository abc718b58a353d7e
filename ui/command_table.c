// The one file that knows all commands. Their list stands in ui/commands/meson.build,
// from which command_names.h is written.
#include "ui/command_table.h"

#include "ui/commands/command_names.h"

#define COMMAND_DECLARED(name) extern const command name##_command;
COMMANDS(COMMAND_DECLARED)
#undef COMMAND_DECLARED

static const command *const commands[] = {
#define COMMAND_ADDRESS(name) &name##_command,
    COMMANDS(COMMAND_ADDRESS)
#undef COMMAND_ADDRESS
};

const command_list command_table = {commands, sizeof commands / sizeof commands[0]};
