// The table of all commands: the one file that knows them all.
#include "ui/commands/table.h"

// One line a command: its name as a C word, in the order in which they are listed.
#define COMMANDS(X)                                                                      \
    X(lab)                                                                               \
    X(lesson)                                                                            \
    X(list)                                                                              \
    X(show)                                                                              \
    X(check)                                                                             \
    X(run)                                                                               \
    X(predict)                                                                           \
    X(modes)                                                                             \
    X(sweep)                                                                             \
    X(merge)                                                                             \
    X(compare)                                                                           \
    X(converge)                                                                          \
    X(solve)                                                                             \
    X(study)                                                                             \
    X(identify)                                                                          \
    X(calibrate)                                                                         \
    X(robust)                                                                            \
    X(linear)                                                                            \
    X(tune)                                                                              \
    X(animate)                                                                           \
    X(plot)                                                                              \
    X(tables)                                                                            \
    X(figures)                                                                           \
    X(report)                                                                            \
    X(bench)                                                                             \
    X(help)

#define COMMAND_DECLARED(name) extern const command name##_command;
COMMANDS(COMMAND_DECLARED)
#undef COMMAND_DECLARED

static const command *const commands[] = {
#define COMMAND_ADDRESS(name) &name##_command,
    COMMANDS(COMMAND_ADDRESS)
#undef COMMAND_ADDRESS
};

const command_list command_table = {commands, sizeof commands / sizeof commands[0]};
