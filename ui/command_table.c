// The table of all commands: the one file that knows them all. Their list stands in
// meson.build, from which command_names.h is written.
#include "ui/command_table.h"

#include "ui/commands/command_names.h"

#define COMMAND_DECLARED(name) extern const command name##_command;
COMMANDS(COMMAND_DECLARED)

static const command *const commands[] = {
#define COMMAND_ADDRESS(name) &name##_command,
    COMMANDS(COMMAND_ADDRESS)};

const command_list command_table = {commands, sizeof commands / sizeof commands[0]};
