// What a command is, how its options are found, and how it gets its scenario.
#pragma once

#include <stdbool.h>

#include "src/scenario/scenario.h"
#include "ui/commands/messages.h"
#include "ui/commands/options.h"

// The parts of `impactlab --help`, in its order.
#define COMMAND_GROUPS(X)                                                                \
    X(GROUP_ONE_RUN, "One run")                                                          \
    X(GROUP_MANY_RUNS, "Many runs")                                                      \
    X(GROUP_CONTROL, "Control")                                                          \
    X(GROUP_PICTURES, "Pictures")                                                        \
    X(GROUP_THESIS, "The thesis")                                                        \
    X(GROUP_PROGRAM, "The program")

typedef enum command_group {
#define GROUP_ENUM(group, title) group,
    COMMAND_GROUPS(GROUP_ENUM)
#undef GROUP_ENUM
        COMMAND_GROUP_COUNT
} command_group;

enum { COMMAND_TABLES = 8, COMMAND_OPTIONS = 64 };

struct command {
    const char *name;
    command_group group;
    const char *summary;  // one line, without a full stop
    const char *help;     // further paragraphs of help, "" if none; see next_paragraph
    const char *operands; // as usage shows them, "SCENARIO"
    int least, most;      // number of operands
    bool takes_scenarios; // operands are scenarios or files
    bool draws;           // pictures, whatever its options say

    // other values that an operand may have: the i-th, NULL after the last; NULL if there
    // are none
    const char *(*operand_word)(const command_list *all, int i);

    // ends with NULL; --help is every command's
    const option_table *options[COMMAND_TABLES];

    // carries it out and returns the exit status: `run`, or `use` with the scenario of
    // the first operand
    int (*run)(const arguments *a);
    int (*use)(const arguments *a, scenario *s);
};

// All commands, by group (ui/command_table.h).
struct command_list {
    const command *const *items;
    int count;
};

// The command of that name, NULL if there is none.
const command *command_find(const command_list *all, const char *name);

// The command whose name is most similar to a misspelt one, NULL if none is similar.
const char *command_nearest(const command_list *all, const char *name);

// Reports that there is no such command and names the most similar one. Returns
// EXIT_BAD_ARGUMENTS.
int complain_command(const command_list *all, const char *name);

// Carries out the command of the arguments. Returns the exit status.
int command_run(const arguments *a);

// The i-th table of a command's options, --help is among those with its title; NULL after
// the last.
const option_table *command_options(const command *c, int i);

// The i-th option of a command over all its tables; NULL after the last.
const option_row *command_option(const command *c, int i);

// Opens the scenario (a name or a file) and applies every --set. Every fault goes to
// stderr. Returns EXIT_DONE, or the exit status to end with; in that case nothing has to
// be freed.
int command_scenario_open(scenario *s, const char *name_or_file, const arguments *a);

// Opens the scenario, calls `use` with it and closes it. Returns the exit status.
int with_scenario(const char *name_or_file, const arguments *a,
                  int (*use)(const arguments *a, scenario *s));

// The program as its tests call it, too: executes the command in argv. Returns the exit
// status. Sets up signals and the locale of the whole process.
int program_run(int argc, char **argv);
