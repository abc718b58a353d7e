// The commands of the command line, and what they share.
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "src/base/whole_file.h"
#include "src/run/run.h"
#include "ui/commands/messages.h"
#include "ui/commands/options.h"

// --- commands --------------------------------------------------------------------------

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
    // other values that an operand may have: the i-th, NULL after the last; NULL if there
    // are none
    const char *(*operand_word)(const command_list *all, int i);
    const option_table
        *options[COMMAND_TABLES];   // ends with NULL; --help is every command's
    int (*run)(const arguments *a); // returns the exit status
    // instead of it: what is done with the scenario of the first operand; returns the
    // exit status
    int (*use)(const arguments *a, scenario *s);
};

// What a command says of itself, and of its operands: how usage shows them, how many at
// least and at most, whether they are scenarios.
#define CALLED(command, of, what)                                                        \
    .name = (command), .group = GROUP_##of, .summary = (what)
#define OPERANDS(names, few, many)  .operands = (names), .least = (few), .most = (many)
#define SCENARIOS(names, few, many) OPERANDS(names, few, many), .takes_scenarios = true
#define ONE_SCENARIO                SCENARIOS("SCENARIO", 1, 1)
#define NO_OPERANDS                 OPERANDS("", 0, 0)

// All commands, by group (table.h).
struct command_list {
    const command *const *items;
    int count;
};

// The command of that name, NULL if there is none.
const command *command_find(const command_list *all, const char *name);

// Reports that there is no such command and names the most similar one. Returns
// EXIT_BAD_ARGUMENTS.
int complain_command(const command_list *all, const char *name);

// The i-th table of a command's options, --help is among those with its title; NULL after
// the last.
const option_table *command_options(const command *c, int i);

// The i-th option of a command over all its tables; NULL after the last.
const option_row *command_option(const command *c, int i);

// Reads argv (argv[0] is the command's name) by the rows of options of a->command, which
// may stand before or after the operands, and checks each value by its row; a->commands
// are all there are, the rest of `a` is zero. True with `a` filled, to be freed by
// arguments_finish; false if the command ends here, with the exit status in *exit_status:
// EXIT_DONE if help was asked for, else that of what was wrong, which has been reported.
bool arguments_read(arguments *a, int argc, char **argv, int *exit_status);
void arguments_finish(arguments *a);

// Reports each path that results could not be written to, before anything is computed.
// Returns the exit status.
int check_results(const arguments *a);

// Prints the commands by group, and how to call one of them.
void print_commands(FILE *stream, const command_list *all);
void print_help(FILE *stream, const command *self);

// Prints what has all of these words in its name: parameters, quantities, signals,
// commands, headings of the manual. Returns how many there are; prints nothing if there
// are none.
int print_meanings(FILE *stream, const command_list *all, const char *words);

// Writes the man page of a command, of impactlab itself and all its commands if c is
// NULL.
void write_man_page(FILE *stream, const command_list *all, const command *c);

// Writes a chapter of the manual from the tables of parameters, signals, quantities, laws
// or events, in Markdown, or the man page of scenario files.
#define REFERENCE_PAGES "parameters|signals|quantities|laws|events|scenario.5"
void write_reference(FILE *stream, const char *page);

// What a parameter may be: "0.1 to 100", "list of 1 to 2", "text", or its words with
// `separator` between them. Returns text.
enum { RANGE_TEXT = 256 };
const char *format_range(const parameter_info *info, const char *separator,
                         char text[RANGE_TEXT]);

// Writes what the shell, "bash", "zsh" or "fish", needs to complete impactlab's command
// line.
void write_completion(FILE *stream, const command_list *all, const char *shell);

// Opens the scenario (a name or a file) and applies every --set. Every fault goes to
// stderr. Returns EXIT_DONE, or the exit status to end with; in that case nothing has to
// be freed.
int open_scenario(scenario *s, const char *name_or_file, const arguments *a);

// Opens the scenario, calls `use` with it and closes it. Returns the exit status.
int with_scenario(const char *name_or_file, const arguments *a,
                  int (*use)(const arguments *a, scenario *s));

// Carries out the command of the arguments. Returns the exit status.
int command_run(const arguments *a);

// Writes the JSON value to path ("-": standard output) whole or not at all. Takes over
// value, which may be NULL (no memory). Returns the exit status.
int write_json(const char *path, json_t *value) __attribute__((warn_unused_result));

// How a command writes one of its results: what it found of a scenario. Writers get that
// and a context also where they make no use of it.
#pragma GCC diagnostic ignored "-Wunused-parameter"
typedef void result_writer(FILE *stream, const scenario *s, const void *found);

// One that is written by a call, with `stream` and what was `found`, of a type.
#define RESULT_WRITER(name, type, call)                                                  \
    static void name(FILE *stream, const scenario *s, const void *of)                    \
    {                                                                                    \
        const type *found = of;                                                          \
        call;                                                                            \
    }

// The same of a result that is no file: its JSON, or its text on the standard output.
#define RESULT_GIVEN(kind, name, type, call)                                             \
    static kind name(const scenario *s, const void *of)                                  \
    {                                                                                    \
        const type *found = of;                                                          \
        call;                                                                            \
    }

// Writes a file whole or not at all ("-": standard output, NULL: none was asked for):
// calls `write` with the stream, `s` and `found`; errors stay in the stream. Returns the
// exit status.
int write_file(const char *path, result_writer *write, const scenario *s,
               const void *found) __attribute__((warn_unused_result));

// The results of a command, each with its option; NULL where it has no such option.
typedef struct command_results {
    json_t *(*json)(const scenario *s, const void *found);
    void (*text)(const scenario *s,
                 const void *found); // for people, on the standard output
    int (*plot)(const arguments *a, const scenario *s,
                const void *found); // gives the exit status
    result_writer *csv, *markdown, *output, *mat, *cases;
    bool draws_part; // plot draws a result that is not whole, too
    // said after an interrupt: what became of the pieces that were done, NULL: nothing of
    // them is written; the same where none were and nothing is written, NULL: as of some
    const char *kept, *none;
} command_results;

// Writes every result that was asked for, and then the text: what is printed may be cut
// off. One that fails does not keep the others from being written. Of a result that is
// not `whole`, as an interrupt ended the work, neither --output and --cases nor what
// `plot` cannot draw of it; its JSON has the status "interrupted". An interrupt on the
// way waits for the end. Returns the exit status.
int write_results(const arguments *a, const command_results *r, const scenario *s,
                  const void *found, bool whole) __attribute__((warn_unused_result));

// The larger of two exit statuses, so that a failure is kept.
int worse(int a, int b);

// False if --quiet was given or a result goes to the standard output, which then contains
// nothing else.
bool summary_wanted(const arguments *a);

// The program as its tests call it, too.

// Executes the command in argv. Returns the exit status. Sets up signals and the locale
// of the whole process.
int program_run(int argc, char **argv);
