// The commands of the command line, and what they share.
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>

#include "src/base/whole_file.h"
#include "src/run/run.h"
#include "ui/commands/options.h"

enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_BAD_ARGUMENTS = 2 };

struct rank_group;
typedef struct command command;

// What stood on the command line after the command's name, checked by the rows of its options.
// Texts are borrowed from argv; those that were not given are NULL.
typedef struct arguments {
    const command *command;
    char **operands; // what is no option
    int operand_count;
    bool quiet;
    bool fitted; // --fitted

    // what is run
    text_list sets;                 // --set
    bool allow_code;                // --allow-code
    text_list varies;               // --vary
    text_list besides;              // --beside
    const char *sampling;           // --sample, NULL: grid
    uint64_t runs, seed;            // --runs (0 if not given), --seed
    uint64_t jobs;                  // runs at a time, 0 if not given
    const struct rank_group *ranks; // that share the runs, NULL if this is the only process
    const char *part;               // --part, "K/N"
    const char *quantity;           // --quantity, a key
    const char *only, *baseline;    // of bench
    const char *against, *columns;  // of compare
    double tolerance;               // of compare [%]
    const char *laws, *over;        // of robust
    const char *then;               // of predict, "TIME:VOLTS,..."

    // where results go
    const char *json, *csv, *plot, *scene, *output, *db, *markdown, *format;

    // what pictures look like
    bool mono, dark, bare, transparent;
    double width, height; // of a page [mm]; 0 if not given
    double font_size;     // of labels [pt]; 0 if not given
    double from, to;      // ends of the horizontal axis; NaN if not given
    const char *font, *signals, *latex;
    char *command_line;   // without places that are written to; owned
    double dpi;           // of a PNG; 0 if not given
    const char *overlay;  // CSV
    number_list instants; // --at [s]
    const char *gl, *camera;
    double exaggerate;
    uint64_t ghosts;
    bool inset;
    grid_size size;            // [pixels], of the lab [characters]
    double fps, seconds, slow; // of a film [1/s], [s], [1]; 0 if not given

    // the lab
    const char *keys, *script, *glyphs, *theme, *colours;

    // help
    const char *completion; // the shell
    bool man;
    const char *man_pages; // folder
} arguments;

// The parts of `impactlab --help`, in its order.
#define COMMAND_GROUPS(X)                                                                          \
    X(GROUP_ONE_RUN, "One run")                                                                    \
    X(GROUP_MANY_RUNS, "Many runs")                                                                \
    X(GROUP_CONTROL, "Control")                                                                    \
    X(GROUP_PICTURES, "Pictures")                                                                  \
    X(GROUP_THESIS, "The thesis")                                                                  \
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
    // other words an operand may be: the i-th, NULL behind the last; NULL if there are none
    const char *(*operand_word)(int i);
    const option_table *options[COMMAND_TABLES]; // ends with NULL; --help is every command's
    bool on_ranks;                               // every rank runs it (a.ranks), not only rank 0
    bool draws;                                  // always, not only where --plot or --scene asks
    int (*run)(const arguments *a);              // returns the exit status
};

// All commands, by group.
extern const command *const command_table[];
extern const int command_count;
extern const command lab_command; // what impactlab is without a command

const command *command_find(const char *name); // NULL if there is none

// Complains that there is no such command and names the nearest. Returns EXIT_BAD_ARGUMENTS.
int complain_command(const char *name);

// The i-th table of a command's options, --help among those of its title; NULL behind the last.
const option_table *command_options(const command *c, int i);

// The i-th option of a command over all its tables; NULL behind the last.
const option_row *command_option(const command *c, int i);

// Prints "impactlab: " and the sentence to stderr. Returns EXIT_BAD_ARGUMENTS.
int complain(const char *format, ...) __attribute__((format(printf, 1, 2)));

// The same for a fault. Returns the exit status that belongs to its code.
int complain_fault(const fault *f);

// Prints words that come from outside (titles, names of files and scenarios) among others to the
// standard output, printable ones only (src/base/words.h).
void say(const char *format, ...) __attribute__((format(printf, 1, 2)));

// A fault_handler that prints the sentence to stderr.
void report_to_stderr(void *context, const char *sentence);

// The same as the program's complaint.
void complain_sentence(void *context, const char *sentence);

// Faults of a scenario that is opened, told as they come, so that none goes unsaid. The first one
// waits until it is known whether it is about a place in a file, which begins the sentence then.
typedef struct told_faults {
    int count;
    char *first; // not told yet, or NULL
} told_faults;

// Takes one of them: a fault_handler whose context is the told_faults.
void tell_fault(void *context, const char *sentence);

// Tells the first one if it waits still, as where the scenario was opened all the same.
void tell_first_fault(told_faults *t);

// Tells why a scenario could not be opened, for which scenario_open returned `code`; what is not
// there at all has no place and is told as the program's own complaint. Returns the exit status.
int tell_unopened(told_faults *t, status code, const char *name_or_file);

// Reads argv (argv[0] is the command's name) by the command's rows of options, which may stand
// before or after the operands, and checks each value by its row. True with `a` filled, to be freed
// by arguments_finish; false if the command is over (help was asked for, or an argument is wrong
// and was complained about), with the exit status in *exit_status.
bool arguments_read(arguments *a, const command *self, int argc, char **argv, int *exit_status);
void arguments_finish(arguments *a);

// The text an option's place holds, NULL if it was not given. Only for types that store a text.
const char *option_text(const arguments *a, const option_row *o);

// Whether the option names a place that results are written to.
bool option_is_written(const option_row *o);

// Complains about each place that results could not be written to, before anything is computed.
// Returns the exit status.
int check_results(const arguments *a);

// Prints the commands by group, and how to call one of them.
void print_commands(FILE *stream);
void print_help(FILE *stream, const command *self);

// Writes the man page of a command, of impactlab itself if c is NULL.
void write_man_page(FILE *stream, const command *c);

// Writes what the shell (bash, zsh or fish) needs to complete impactlab's command line.
void write_bash_completion(FILE *stream);
void write_zsh_completion(FILE *stream);
void write_fish_completion(FILE *stream);

// Opens the scenario (a name or a file) and applies every --set. Every fault goes to stderr.
// Returns EXIT_DONE, or the exit status to end with and then nothing is to be freed.
int open_scenario(scenario *s, const char *name_or_file, const arguments *a);

// Opens the scenario, calls `use` with it and closes it. Returns the exit status.
int with_scenario(const char *name_or_file, const arguments *a,
                  int (*use)(const arguments *a, scenario *s));

// Writes the JSON value to path ("-": standard output) whole or not at all. Takes over value, which
// may be NULL (no memory). Returns the exit status.
int write_json(const char *path, json_t *value);

// Writes a file whole or not at all ("-": standard output): calls `write` with the stream and
// `what`; errors stay in the stream. Returns the exit status.
int write_file(const char *path, void (*write)(FILE *stream, const void *what), const void *what);

// The larger of two exit statuses: what went wrong once stays wrong.
int worse(int a, int b);

// True unless --quiet was given or a result goes to the standard output, where it stays alone.
bool summary_wanted(const arguments *a);

// A paragraph of a longer text.
typedef struct paragraph {
    const char *start;
    int bytes;
    bool literal; // one line that keeps its blanks: its first character is one
} paragraph;

// Takes the next paragraph off *text; false behind the last. Empty lines end paragraphs, and so do
// lines that begin with a blank; other line ends count as blanks.
bool next_paragraph(const char **text, paragraph *p);

// Prints words in lines of at most `width` characters.
void print_wrapped(FILE *stream, const char *text, int bytes, int width);

// True if the terminal's character set is UTF-8.
bool terminal_has_utf8(void);
