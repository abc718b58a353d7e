// The message line: the last message to the user.
#pragma once

#include <stdbool.h>

enum { MESSAGE_TEXT = 1024 };

typedef struct message_line {
    char text[MESSAGE_TEXT]; // "" for none
    bool warning;
} message_line;

// Replaces the message.
void message_say(message_line *m, bool warning, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// Removes the message.
void message_clear(message_line *m);
