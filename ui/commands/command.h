// The commands of the command line, and what they share.
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>

#include "src/run/run.h"
#include "src/base/whole_file.h"

enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_BAD_ARGUMENTS = 2 };

// What stood on the command line after the command's name. Texts are borrowed from argv.
typedef struct arguments {
    char **operands; // what is no option
    int operand_count;
    char **sets; // values of --set in their order
    int set_count;
    char **varies; // values of --vary in their order
    int vary_count;
    char **ats; // values of --at in their order
    int at_count;
    const char *json, *csv, *plot, *scene, *output, *format; // NULL if not given
    const char *sample, *runs, *seed, *jobs, *db, *quantity; // of sweep; NULL if not given
    const char *only, *baseline;                             // of bench; NULL if not given
    const char *width, *dpi, *overlay;                       // of figures; NULL if not given
    bool mono, dark;                                         // of figures
    const char *against, *tolerance;                         // of compare; NULL if not given
    const char *markdown, *columns;                          // of compare; NULL if not given
    const char *gl, *camera, *size;                          // of scenes; NULL if not given
    const char *fps, *seconds, *slow;                        // of films; NULL if not given
    const char *keys, *script, *glyphs, *theme, *colours; // of the terminal lab; NULL if not given
    bool quiet;
} arguments;

typedef struct command {
    const char *name;
    const char *operands;           // as usage shows them, "SCENARIO"
    const char *options;            // letters of option_table, "sjq"
    const char *summary;            // one line
    const char *help;               // further lines of --help, "" if none
    int least, most;                // number of operands
    int (*run)(const arguments *a); // returns the exit status
} command;

extern const command list_command, show_command, check_command, run_command, tables_command,
    figures_command, animate_command, predict_command, modes_command, sweep_command, bench_command,
    compare_command, lab_command, calibrate_command, converge_command, study_command,
    report_command;

// Prints "impactlab: " and the sentence to stderr. Returns EXIT_BAD_ARGUMENTS.
int complain(const char *format, ...) __attribute__((format(printf, 1, 2)));

// The same for a fault. Returns the exit status that belongs to its code.
int complain_fault(const fault *f);

// A fault_handler that prints the sentence to stderr.
void report_to_stderr(void *context, const char *sentence);

// Reads argv (argv[0] is the command's name) by the command's own list of options, which may stand
// before or after the operands. True with `a` filled, to be freed by arguments_finish; false if the
// command is over (help was asked for, or an argument is wrong and was complained about), with the
// exit status in *exit_status.
bool arguments_read(arguments *a, const command *self, int argc, char **argv, int *exit_status);
void arguments_finish(arguments *a);

// Prints how to call the command.
void print_help(const command *self);

// Opens the scenario (a name or a file) and applies every --set. Every fault goes to stderr.
// Returns EXIT_DONE, or the exit status to end with and then nothing is to be freed.
int open_scenario(scenario *s, const char *name_or_file, const arguments *a);

// Writes the JSON value to path ("-": standard output) whole or not at all. Takes over value, which
// may be NULL (no memory). Returns the exit status.
int write_json(const char *path, json_t *value);

// Complains and returns the exit status if path (may be NULL) could not be written; EXIT_DONE else.
int check_output(const char *path);

// True unless --quiet was given or a result goes to the standard output, where it stays alone.
bool summary_wanted(const arguments *a);

// Label and unit of a summary's key: "first_contact_s" gives "first contact" and "s".
void key_label(const char *key, char *label, size_t size, const char **unit);

// Width of a UTF-8 text in characters.
int text_width(const char *text);

// True if the terminal's character set is UTF-8.
bool terminal_has_utf8(void);
