// The options of the command line. One row each gives the name, the value, how the value is checked
// and where it is stored. Reading argv, --help, the man pages and the completions of shells all use
// these rows. Tables that several commands share are in option_tables.c.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// What an option takes, how it is checked, and the type of its place in struct arguments.
typedef enum option_type {
    OPTION_FLAG, // nothing; bool
    OPTION_TEXT, // any text; const char *
    OPTION_WORD, // as OPTION_TEXT, but its `value` lists words to offer for completion; const char
                 // *
    OPTION_CHOICE,     // one of the words of `value`, "a|b|c"; const char *
    OPTION_FILE,       // a file that is read; const char *
    OPTION_RESULT,     // a file that is written whole, "-": the standard output; const char *
    OPTION_PICTURE,    // a file .png, .pdf or .svg that is written whole; const char *
    OPTION_PLACE,      // a file or folder that the command itself checks and writes; const char *
    OPTION_SCENARIO,   // a scenario's name or file; const char *
    OPTION_QUANTITY,   // key of a summary's quantity; const char *
    OPTION_NUMBER,     // from `low` to `high`; double
    OPTION_LENGTH,     // the same with a unit, "85mm", "8.5cm", "3.35in"; double [mm]
    OPTION_WHOLE,      // a whole number from `low` to `high`; uint64_t
    OPTION_SIZE,       // WIDTHxHEIGHT, each from 1 to `high`; grid_size
    OPTION_NUMBERS,    // may be repeated; number_list, in the order of the command line
    OPTION_PARAMETERS, // PATH=..., may be repeated; text_list, in the order of the command line
} option_type;

typedef struct text_list {
    char **items;
    int count;
} text_list;

typedef struct number_list {
    double *items;
    int count;
} number_list;

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
} option_row;

typedef struct option_table {
    const char *title; // of its section in help and man page, "Options"
    const option_row *rows;
    int count;
} option_table;

#define OPTION_TABLE(title, rows)                                                                  \
    {                                                                                              \
        title, rows, (int)(sizeof rows / sizeof rows[0])                                           \
    }
#define PLACE(field) .place = offsetof(arguments, field)

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
