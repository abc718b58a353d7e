// What the program says of its commands: the texts of --help, and the man pages.
#pragma once

#include <stdio.h>

#include "ui/commands/command.h"

// Prints the commands by group, and how to call one of them.
void print_commands(FILE *stream, const command_list *all);

// Prints what a command does, and its options.
void print_help(FILE *stream, const command *c);

// Writes the man page of a command, of impactlab itself and all its commands if c is
// NULL.
void write_man_page(FILE *stream, const command_list *all, const command *c);

// A text in which troff finds no request and no escape of its own; to be freed with
// g_free.
char *troff_text(const char *text);
