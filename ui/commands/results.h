// The results of commands: files that are written whole or not at all, and text on the
// standard output.
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>

#include "ui/commands/options.h"

// The larger of two exit statuses, so that a failure is kept.
int worse(int a, int b);

// False if --quiet was given or a result goes to the standard output, which then contains
// nothing else.
bool summary_wanted(const arguments *a);

// Reports each path that results could not be written to, before anything is computed.
// Returns the exit status.
int check_results(const arguments *a);

// Refuses to write bytes that are no text, the result of the option --NAME, to a standard
// output that is a terminal; path may be NULL. Returns the exit status.
int refuse_bytes_on_screen(const char *name, const char *path);

// Writes the JSON value to path ("-": standard output) whole or not at all. Takes over
// value, which may be NULL (no memory). Returns the exit status.
int write_json_file(const char *path, json_t *value) __attribute__((warn_unused_result));

// Writes what a command found; errors stay in the stream.
typedef void result_writer(FILE *stream, const void *found);

// Writes a file whole or not at all ("-": standard output, NULL: none was asked for).
// Returns the exit status.
int write_file(const char *path, result_writer *write, const void *found)
    __attribute__((warn_unused_result));

// How each result of a command is made from what it found; NULL where it has no such
// result.
typedef struct command_results {
    json_t *(*json)(const void *found);
    void (*text)(const void *found); // for people, on the standard output
    int (*plot)(const arguments *a, const void *found); // returns the exit status
    result_writer *csv, *markdown, *output, *mat, *cases;
    bool draws_part; // plot draws a result that is not whole, too

    // what work_finish says after an interrupt: what became of the pieces that were done,
    // NULL: nothing of them is written; and where none were done and nothing is written,
    // NULL: the same
    const char *kept, *none;
} command_results;

// Writes every result that was asked for, and then the text: what is printed may be cut
// off. One that fails does not keep the others from being written. Of a result that is
// not `whole`, as an interrupt ended the work, neither --output and --cases nor what
// `plot` cannot draw of it; its JSON has the status "interrupted". An interrupt on the
// way waits for the end. Returns the exit status.
int write_results(const arguments *a, const command_results *r, const void *found,
                  bool whole) __attribute__((warn_unused_result));
