// What the commands print for people: complaints on the standard error, and texts, cells
// and paragraphs on the standard output.
#pragma once

#include <stdbool.h>
#include <stdio.h>

#include "src/scenario/scenario.h"

enum {
    EXIT_DONE = 0,
    EXIT_FAILED = 1,
    EXIT_BAD_ARGUMENTS = 2,
    EXIT_UNEXPLAINED = 3 // a fit was found whose model the data contradict
};

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
void print_cell(int width, const char *conversion, double value)
    __attribute__((format(printf, 2, 0)));

// What stands between a number and its unit: a blank, "" where the unit is "".
const char *blank_before(const char *unit);

// "s" behind the name of things that are not one, "" of one.
const char *plural_ending(size_t count);

// Prints "NAME: TITLE" and what was changed since the scenario was read, as a line.
void say_title(const scenario *s);

// A fault_handler that prints the sentence to stderr.
void report_to_stderr(void *context, const char *sentence);

// The same as the program's complaint.
void complain_sentence(void *context, const char *sentence);

// The faults found while a scenario is opened. Each is printed as it comes, but the first
// is held back until it is known whether it belongs to a place in a file: if so, its
// sentence begins with that place.
typedef struct opening_faults {
    int count;
    char *first; // not printed yet, or NULL
} opening_faults;

// Takes one of the faults: a fault_handler whose context is the opening_faults.
void report_opening_fault(void *context, const char *sentence);

// Prints the first fault if it is still held back, for instance because the scenario
// could be opened in spite of it.
void report_first_fault(opening_faults *t);

// Prints why a scenario could not be opened, after scenario_open returned `code`. A
// scenario that does not exist has no place in a file and is reported as an error of the
// program. Returns the exit status.
int report_unopened(opening_faults *t, status code, const char *name_or_file);

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
