// The message line: the last thing that was said to the user.
#pragma once

#include <stdbool.h>

enum { MESSAGE_TEXT = 1024 };

typedef struct message_line {
    char text[MESSAGE_TEXT]; // "" for none
    bool warning;
} message_line;

// Says something in the place of what was said before.
void message_say(message_line *m, bool warning, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// Takes the text away.
void message_clear(message_line *m);
