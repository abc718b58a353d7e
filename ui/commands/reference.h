// The chapters of the manual that are made from the program's tables.
#pragma once

#include <stdio.h>

#include "src/tables/parameters.h"

// Writes a chapter from the tables of parameters, signals, quantities, laws or events, or
// of the scenarios, in Markdown, or the man page of scenario files.
#define REFERENCE_PAGES "parameters|signals|quantities|laws|events|scenarios|scenario.5"
void write_reference(FILE *stream, const char *page);

// What a parameter may be: "0.1 to 100", "list of 1 to 2", "text", or its words with
// `separator` between them. Returns text.
enum { RANGE_TEXT = 256 };
const char *format_range(const parameter_info *info, const char *separator,
                         char text[RANGE_TEXT]);
