// The result of an action, which also carries its message or fault.
#pragma once

#include <stdbool.h>

#include "src/base/fault.h"
#include "ui/explorer/state/message.h"

typedef struct action_result {
    status code;             // STATUS_OK, or why the action failed
    bool speaks;             // the text replaces the message line
    bool warning;            // the text is a warning, even if the action succeeded
    int at;                  // failed: number of characters of the argument before the error
    char text[MESSAGE_TEXT]; // "" to clear the message line
} action_result;

// Done, without a message.
action_result result_done(void);
// Done; the message line is cleared.
action_result result_quiet(void);
// Done, with a message.
action_result result_news(const char *format, ...) __attribute__((format(printf, 1, 2)));
// Done, with a warning.
action_result result_warning(const char *format, ...) __attribute__((format(printf, 1, 2)));
// The argument is not what the action expects.
action_result result_refused(const char *format, ...) __attribute__((format(printf, 1, 2)));
// The result of a call that returned `code`: done if STATUS_OK, otherwise failed with the fault's
// sentence.
action_result result_of(status code, const fault *f);

// Whether the action succeeded.
bool result_ok(const action_result *r);

// Shows the result's message on a message line.
void result_show(const action_result *r, message_line *m);
