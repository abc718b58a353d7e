// The commands of the command line, and what they share.
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "src/base/whole_file.h"
#include "src/run/run.h"

// --- options ---------------------------------------------------------------------------
// The options of the command line. One row each gives the name, the value, how the value
// is checked and where it is stored. Reading argv, --help, the man pages and the
// completions of shells all use these rows.

// What an option takes, how it is checked, and the type of its place in struct arguments.
typedef enum option_type {
    OPTION_FLAG,   // nothing; bool
    OPTION_TEXT,   // any text; const char *
    OPTION_WORD,   // as OPTION_TEXT, but its `value` lists words to offer for completion;
                   // const char
                   // *
    OPTION_CHOICE, // one of the words of `value`, "a|b|c"; const char *
    OPTION_FILE,   // a file that is read; const char *
    OPTION_RESULT, // a file that is written whole, "-": the standard output; const char *
    OPTION_PICTURE,  // a file .png, .pdf or .svg that is written whole; const char *
    OPTION_PLACE,    // a file or folder that the command itself checks and writes; const
                     // char *
    OPTION_SCENARIO, // a scenario's name or file; const char *
    OPTION_QUANTITY, // key of a summary's quantity; const char *
    OPTION_NUMBER,   // from `low` to `high`; double
    OPTION_LENGTH,   // the same with a unit, "85mm", "8.5cm", "3.35in"; double [mm]
    OPTION_WHOLE,    // a whole number from `low` to `high`; uint64_t
    OPTION_SIZE,     // WIDTHxHEIGHT, each from 1 to `high`; grid_size
    OPTION_NUMBERS,  // may be repeated; option_list, in the order of the command line
    OPTION_FILES,    // as OPTION_FILE, may be repeated; option_list
    OPTION_PARAMETERS, // PATH=..., may be repeated; option_list, in the order of the
                       // command line
} option_type;

// The values of an option that may be repeated.
typedef struct option_list {
    union {
        char **items;
        double *numbers; // of OPTION_NUMBERS
    };
    int count;
} option_list;

// Whether the place is such a list: of the last types.
static inline bool option_is_list(option_type type)
{
    return type >= OPTION_NUMBERS;
}

typedef struct grid_size {
    int width, height; // 0 if not given
} grid_size;

typedef struct option_row {
    const char *name;  // without its dashes
    const char *alias; // another accepted spelling, NULL if none
    char letter;       // short form, 0 if none
    option_type type;
    const char *value; // name of the value in help; for OPTION_CHOICE its words, "a|b|c"
    const char *help;  // one line
    size_t place;      // offset in struct arguments
    double low, high;  // range of numbers [unit]; high of OPTION_SIZE
    double initial;    // of OPTION_NUMBER, if it is not given
    const char *unit;  // of numbers and sizes, NULL if none
    bool (*replaces)(
        const char *path); // what else than an empty file a result may replace, or NULL
} option_row;

typedef struct option_table {
    const char *title; // of its section in help and man page, "Options"
    const option_row *rows;
    int count;
} option_table;

#define OPTION_TABLE(title, rows)                                                        \
    {                                                                                    \
        title, rows, (int)(sizeof rows / sizeof rows[0])                                 \
    }
// The same in place, of the rows that a command has for itself.
#define OWN_OPTIONS(rows) &(const option_table)OPTION_TABLE("Options", rows)
#define PLACE(field)      .place = offsetof(arguments, field)
// A row: type, name, name of the value (NULL: none), help, place, and what else there is
// to say.
#define OPTION(kind, option, of, text, ...)                                              \
    {                                                                                    \
        .type = OPTION_##kind, .name = (option), .value = (of), .help = (text),          \
        __VA_ARGS__                                                                      \
    }

// Where a command writes its main result to, -o.
#define OUTPUT_OPTION(kind, of, ...)                                                     \
    OPTION(kind, "output", of, __VA_ARGS__, PLACE(output), .letter = 'o')

// Tables that several commands share.
extern const option_table set_options;   // --set
extern const option_table vary_options;  // --vary
extern const option_table json_options;  // --json
extern const option_table quiet_options; // --quiet
extern const option_table lab_options;   // of what opens the lab
extern const option_table drawn_options; // --plot of a study
extern const option_table help_options;  // --help, which every command has
extern const option_table page_options;  // --width, --theme, --font ... of every picture
extern const option_table view_options;  // --gl, --camera, --size

// --- commands --------------------------------------------------------------------------

enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_BAD_ARGUMENTS = 2 };

typedef struct command command;

// The command line after the command's name, checked against the command's options. Texts
// point into argv; a text that was not given is NULL.
typedef struct arguments {
    const command *command;
    char **operands; // arguments that are not options
    int operand_count;
    bool quiet;
    bool fitted; // --fitted

    // what is run
    option_list sets;                 // --set
    bool allow_code;                  // --allow-code
    option_list varies;               // --vary
    option_list besides;              // --beside
    option_list data, fits, headings; // of identify: --data, --fit, --column
    const char *validate, *cases;     // of identify
    const char *links;                // of identify, "2,4,8"
    uint64_t starts;                  // of identify, 0 if not given
    const char *sampling;             // --sample, NULL: grid
    uint64_t runs, seed;              // --runs (0 if not given), --seed
    uint64_t jobs;                    // runs at a time, 0 if not given
    const char *part;                 // --part, "K/N"
    const char *quantity;             // --quantity, a key
    const char *only, *baseline;      // of bench
    const char *against, *columns;    // of compare
    double tolerance;                 // of compare [%]
    const char *laws, *over;          // of robust
    const char *minimise, *subject;   // of tune
    const char *then;                 // of predict, "TIME:VOLTS,..."
    const char *place;                // of linear, --at
    bool looped, injects;             // of linear, --law and --inject

    // files for results
    const char *json, *csv, *mat, *plot, *nyquist, *scene, *output, *db, *markdown,
        *format;

    // appearance of pictures
    bool mono, dark, bare, transparent;
    double width, height; // of a page [mm]; 0 if not given
    double font_size;     // of labels [pt]; 0 if not given
    double from, to;      // ends of the horizontal axis; NaN if not given
    const char *font, *signals, *latex;
    char *command_line;   // without paths that are written to; owned
    double dpi;           // of a PNG; 0 if not given
    const char *overlay;  // CSV
    option_list instants; // --at [s]
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
    const char *reference; // one of REFERENCE_PAGES
} arguments;

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
    const char *(*operand_word)(int i);
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

// All commands, by group.
extern const command *const command_table[];
extern const int command_count;
extern const command lab_command; // the command of impactlab if none is named

const command *command_find(const char *name); // NULL if there is none

// Reports that there is no such command and names the most similar one. Returns
// EXIT_BAD_ARGUMENTS.
int complain_command(const char *name);

// The i-th table of a command's options, --help is among those with its title; NULL after
// the last.
const option_table *command_options(const command *c, int i);

// The i-th option of a command over all its tables; NULL after the last.
const option_row *command_option(const command *c, int i);

// Prints "impactlab: " and the sentence to stderr. Returns EXIT_BAD_ARGUMENTS.
int complain(const char *format, ...) __attribute__((format(printf, 1, 2)));

// The same for a fault. Returns the exit status that belongs to its code.
int complain_fault(const fault *f);

// Prints a text that contains words from outside (titles, names of files and scenarios)
// to the standard output, without unprintable characters and with what is lost noted
// (src/base/words.h).
void say(const char *format, ...) __attribute__((format(printf, 1, 2)));

// Prints a blank and a number (a printf conversion of a double) at the right of a column
// of that width, "-" for NaN.
void print_cell(int width, const char *conversion, double value);

// Prints "NAME: TITLE" and what was changed since the scenario was read, as a line.
void say_title(const scenario *s);

// A fault_handler that prints the sentence to stderr.
void report_to_stderr(void *context, const char *sentence);

// The same as the program's complaint.
void complain_sentence(void *context, const char *sentence);

// The faults found while a scenario is opened. Each is printed as it comes, but the first
// is held back until it is known whether it belongs to a place in a file: if so, its
// sentence begins with that place.
typedef struct told_faults {
    int count;
    char *first; // not printed yet, or NULL
} told_faults;

// Takes one of them: a fault_handler whose context is the told_faults.
void tell_fault(void *context, const char *sentence);

// Prints the first one if it is still held back, for instance because the scenario could
// be opened in spite of it.
void tell_first_fault(told_faults *t);

// Prints why a scenario could not be opened, after scenario_open returned `code`. A
// scenario that does not exist has no place in a file and is reported as an error of the
// program. Returns the exit status.
int tell_unopened(told_faults *t, status code, const char *name_or_file);

// Reads argv (argv[0] is the command's name) by the command's rows of options, which may
// stand before or after the operands, and checks each value by its row. True with `a`
// filled, to be freed by arguments_finish; false if the command ends here, with the exit
// status in *exit_status: EXIT_DONE if help was asked for, else that of what was wrong,
// which has been reported.
bool arguments_read(arguments *a, const command *self, int argc, char **argv,
                    int *exit_status);
void arguments_finish(arguments *a);

// The place of an option's value in the arguments.
void *option_place(const arguments *a, const option_row *o);

// Whether the option names a place that results are written to; that place, NULL if it
// does not or was not given.
bool option_is_written(const option_row *o);
const char *option_written(const arguments *a, const option_row *o);

// Reports each path that results could not be written to, before anything is computed.
// Returns the exit status.
int check_results(const arguments *a);

// Prints the commands by group, and how to call one of them.
void print_commands(FILE *stream);
void print_help(FILE *stream, const command *self);

// Prints what has all of these words in its name: parameters, quantities, signals,
// headings of the manual. Returns how many there are; prints nothing if there are none.
int print_meanings(FILE *stream, const char *words);

// Writes the man page of a command, of impactlab itself if c is NULL.
void write_man_page(FILE *stream, const command *c);

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
void write_completion(FILE *stream, const char *shell);

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

// A paragraph of a longer text.
typedef struct paragraph {
    const char *start;
    int bytes;
    bool literal; // a single line that begins with a blank and is printed as it is
} paragraph;

// Takes the next paragraph off *text; false after the last. A paragraph ends at an empty
// line or before a line that begins with a blank; other line ends count as blanks.
bool next_paragraph(const char **text, paragraph *p);

// Prints words in lines of at most `width` characters, each line behind `indent` blanks.
void print_indented(FILE *stream, const char *text, int bytes, int width, int indent);

// True if the terminal's character set is UTF-8, by the locale or, where it is not there,
// its name.
bool terminal_has_utf8(void);

// The program as its tests call it, too.

// Executes the command in argv. Returns the exit status. Sets up signals and the locale
// of the whole process.
int program_run(int argc, char **argv);
