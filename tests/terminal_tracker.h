// Follows the bytes that a program writes to a terminal: modes that are set, queries and
// pictures.
#pragma once

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { PRIVATE_MODES = 3000, TAIL = 4000 };

// State of the output.
typedef struct tracker {
    enum { PLAIN, ESCAPED, SEQUENCE, STRING, STRING_ENDS } state;
    bool asks_attributes, asks_cell, asks_kitty; // a query came
    long pictures; // strings of sixels or kitty's that were drawn
    char sequence[64];
    size_t length;
    bool mode[PRIVATE_MODES]; // set by CSI ? NUMBER h
    long cleared;             // number of times the whole screen was cleared
    char tail[TAIL];          // the last bytes, a ring
    size_t bytes;
} tracker;

static inline void end_sequence(tracker *t, char last)
{
    t->sequence[t->length] = '\0';
    if (t->sequence[0] == '?' && (last == 'h' || last == 'l')) {
        for (char *word = strtok(t->sequence + 1, ";"); word != NULL;
             word = strtok(NULL, ";")) {
            long mode = strtol(word, NULL, 10);
            if (mode >= 0 && mode < PRIVATE_MODES) {
                t->mode[mode] = last == 'h';
            }
        }
    } else if (last == 'c') {
        t->asks_attributes = true;
    } else if (last == 't' && strcmp(t->sequence, "16") == 0) {
        t->asks_cell = true;
    } else if (last == 'J' && (t->length == 0 || strcmp(t->sequence, "2") == 0)) {
        t->cleared++;
    }
}

// The end of a string: a query of kitty's protocol, or a picture.
static inline void end_string(tracker *t)
{
    t->sequence[t->length] = '\0';
    t->asks_kitty = t->asks_kitty || strstr(t->sequence, "a=q") != NULL;
    t->pictures += strstr(t->sequence, "a=T") != NULL || t->sequence[0] == '0';
}

// Takes the next byte of the output.
static inline void track(tracker *t, char c)
{
    const bool in_string = t->state == STRING || t->state == STRING_ENDS;
    t->tail[t->bytes++ % TAIL] = c;
    if (in_string) {
        // its beginning is kept; it ends with ESC \ or a bell
        const bool ends = t->state == STRING_ENDS ? c == '\\' : c == '\a';
        if (ends) {
            end_string(t);
        } else if (t->length + 1 < sizeof t->sequence) {
            t->sequence[t->length++] = c;
        }
        t->state = ends ? PLAIN : c == '\033' ? STRING_ENDS : STRING;
    } else if (c == '\033') {
        t->state = ESCAPED;
    } else if (t->state == ESCAPED) {
        t->state = c == '['                           ? SEQUENCE
                   : c == 'P' || c == '_' || c == ']' ? STRING
                                                      : PLAIN;
        t->length = 0;
    } else if (t->state == SEQUENCE && c >= 0x40 && c <= 0x7e) {
        end_sequence(t, c);
        t->state = PLAIN;
    } else if (t->state == SEQUENCE && t->length + 1 < sizeof t->sequence) {
        t->sequence[t->length++] = c;
    }
}
