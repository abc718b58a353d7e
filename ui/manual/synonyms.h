// What people ask for in words that the manual does not have.
#pragma once

// Words that are asked, separated by blanks, and the words or phrases that the manual has
// instead, with | between them.
typedef struct synonym_row {
    const char *asked, *meant;
} synonym_row;

extern const synonym_row synonym_table[];
extern const int synonym_count;
