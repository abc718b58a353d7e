// The options of the command line. One row each gives the name, the value, how the value
// is checked and where it is stored. Reading argv, --help, the man pages and the
// completions of shells all use these rows.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// What an option takes, how it is checked, and the type of its place in struct arguments.
typedef enum option_type {
    OPTION_FLAG,     // nothing; bool
    OPTION_TEXT,     // any text; const char *
    OPTION_WORD,     // the same, but `value` lists words to offer; const char *
    OPTION_CHOICE,   // one of the words of `value`, "a|b|c"; const char *
    OPTION_FILE,     // a file that is read; const char *
    OPTION_RESULT,   // a file that is written whole, "-": standard output; const char *
    OPTION_PICTURE,  // a file .png, .pdf or .svg that is written whole; const char *
    OPTION_PLACE,    // a file or folder that the command checks and writes; const char *
    OPTION_SCENARIO, // a scenario's name or file; const char *
    OPTION_QUANTITY, // key of a summary's quantity; const char *
    OPTION_NUMBER,   // from `low` to `high`; double
    OPTION_LENGTH,   // the same with a unit, "85mm", "8.5cm", "3.35in"; double [mm]
    OPTION_WHOLE,    // a whole number from `low` to `high`; uint64_t
    OPTION_SIZE,     // WIDTHxHEIGHT, each from 1 to `high`; grid_size

    // these may be repeated; option_list, in the order of the command line
    OPTION_NUMBERS,    // as OPTION_NUMBER
    OPTION_FILES,      // as OPTION_FILE
    OPTION_PARAMETERS, // PATH=...
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

    // whether a result may replace the file at `path`, which is not empty; NULL: any
    bool (*replaces)(const char *path);
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
extern const option_table set_options;    // --set
extern const option_table vary_options;   // --vary
extern const option_table json_options;   // --json
extern const option_table quiet_options;  // --quiet
extern const option_table lab_options;    // of what opens the lab
extern const option_table drawn_options;  // --plot of a study
extern const option_table help_options;   // --help, which every command has
extern const option_table page_options;   // --width, --theme, --font ... of every picture
extern const option_table signal_options; // --signals, --overlay of pictures of runs
extern const option_table view_options;   // --gl, --camera, --size

// --- values ----------------------------------------------------------------------------

typedef struct command command;           // of command.h
typedef struct command_list command_list; // of command.h

// The command line after the command's name, checked against the command's options. Texts
// point into argv; a text that was not given is NULL.
typedef struct arguments {
    const command *command;
    const command_list *commands; // all there are
    char **operands;              // arguments that are not options
    int operand_count;
    bool quiet;
    bool fitted;        // --fitted
    bool single;        // --float, of export
    const char *inputs; // of fmu, paths
    bool live;          // of report

    // what is run
    option_list sets;                 // --set
    bool allow_code;                  // --allow-code
    option_list varies;               // --vary
    option_list besides;              // --beside
    option_list data, fits, headings; // of identify: --data, --fit, --column
    const char *validate, *cases;     // of identify
    bool preview;                     // of identify: its traces only
    const char *links;                // of identify, "2,4,8"
    const char *noise;                // of identify, NULL: the scenario's
    uint64_t starts;                  // of identify, 0 if not given
    const char *sampling;             // --sample, NULL: grid
    uint64_t runs, seed;              // --runs (0 if not given), --seed
    uint64_t jobs;                    // runs at a time, 0 if not given
    const char *part;                 // --part, "K/N"
    const char *quantity;             // --quantity, a key
    const char *only, *baseline;      // of bench
    const char *against;              // of compare
    const char *columns;              // of a table, "A,B"
    double tolerance;                 // of compare [%]
    const char *laws, *over;          // of robust
    uint64_t draw;                    // --draw, cases; 0 if not given
    option_list forces;               // --force [N]
    const char *before;               // --before, rows of an exam
    const char *minimise, *subject;   // of tune
    const char *then;                 // of predict, "TIME:VOLTS,..."
    const char *place;                // of linear, --at
    bool looped, injects;             // of linear, --law and --inject

    // files for results
    const char *json, *csv, *parquet, *mat, *plot, *nyquist, *scene, *output, *db,
        *markdown, *format;

    // appearance of pictures
    bool mono, dark, bare, transparent;
    double width, height; // of a page [mm]; 0 if not given
    double font_size;     // of labels [pt]; 0 if not given
    double from, to;      // ends of the horizontal axis; NaN if not given
    const char *font, *signals, *latex, *zoom;
    char *command_line;   // without paths that are written to; owned
    double dpi;           // of a PNG; 0 if not given
    const char *overlay;  // CSV
    option_list instants; // --at [s]
    double every;         // of tables [s]; 0 if not given
    const char *gl, *camera, *exaggerate;
    uint64_t ghosts;
    bool inset;
    grid_size size;            // [pixels], of the lab [characters]
    double fps, seconds, slow; // of a film [1/s], [s], [1]; 0 if not given

    // the lab
    const char *keys, *script, *glyphs, *theme;

    // help
    const char *completion; // the shell
    bool man;
    const char *man_pages; // folder
    const char *reference; // one of REFERENCE_PAGES
} arguments;

// The place of an option's value in the arguments.
void *option_place(const arguments *a, const option_row *o);

// Whether the option names a place that results are written to; that place, NULL if it
// does not or was not given.
bool option_is_written(const option_row *o);
const char *option_written(const arguments *a, const option_row *o);
