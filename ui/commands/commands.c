// The commands there are.
#include "ui/commands/command.h"

#include <assert.h>
#include <string.h>

#include "src/base/words.h"

// One line a command: its name as a C word, in the order in which they are listed.
#define COMMANDS(X)                                                                                \
    X(lab)                                                                                         \
    X(lesson)                                                                                      \
    X(list)                                                                                        \
    X(show)                                                                                        \
    X(check)                                                                                       \
    X(run)                                                                                         \
    X(predict)                                                                                     \
    X(modes)                                                                                       \
    X(sweep)                                                                                       \
    X(merge)                                                                                       \
    X(compare)                                                                                     \
    X(converge)                                                                                    \
    X(solve)                                                                                       \
    X(study)                                                                                       \
    X(calibrate)                                                                                   \
    X(robust)                                                                                      \
    X(animate)                                                                                     \
    X(plot)                                                                                        \
    X(tables)                                                                                      \
    X(figures)                                                                                     \
    X(report)                                                                                      \
    X(bench)                                                                                       \
    X(help)

#define COMMAND_DECLARED(name) extern const command name##_command;
COMMANDS(COMMAND_DECLARED)
#undef COMMAND_DECLARED

const command *const command_table[] = {
#define COMMAND_ADDRESS(name) &name##_command,
    COMMANDS(COMMAND_ADDRESS)
#undef COMMAND_ADDRESS
};
const int command_count = (int)(sizeof command_table / sizeof command_table[0]);

const command *command_find(const char *name)
{
    assert(name != NULL);
    for (int i = 0; i < command_count; i++) {
        if (strcmp(command_table[i]->name, name) == 0) {
            return command_table[i];
        }
    }
    return NULL;
}

int complain_command(const char *name)
{
    assert(name != NULL);
    nearest_word near = nearest_begin(name);
    for (int i = 0; i < command_count; i++) {
        nearest_try(&near, command_table[i]->name);
    }
    if (near.best != NULL) {
        return complain("there is no command '%s', did you mean '%s'?", name, near.best);
    }

    // nothing is near: all there are
    char known[256] = "";
    size_t length = 0;
    for (int i = 0; i < command_count && length < sizeof known; i++) {
        length += (size_t)snprintf(known + length, sizeof known - length, "%s%s", i ? ", " : "",
                                   command_table[i]->name);
    }
    return complain("there is no command '%s', only %s", name, known);
}
