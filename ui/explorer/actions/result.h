// What came of an action: the one way in which actions tell news and faults.
#pragma once

#include <stdbool.h>

#include "src/base/fault.h"
#include "ui/explorer/state/message.h"

typedef struct action_result {
    status code;             // STATUS_OK, or why the action failed
    bool speaks;             // the text takes the place of what the message line says
    bool warning;            // the text is one, also where the action succeeded
    int at;                  // failed: characters of the argument before what is wrong
    char text[MESSAGE_TEXT]; // "" to clear the message line
} action_result;

// It is done, and there is nothing to say.
action_result result_done(void);
// It is done, and the message line is to be cleared.
action_result result_quiet(void);
// It is done, with news.
action_result result_news(const char *format, ...) __attribute__((format(printf, 1, 2)));
// It is done, but the user must know something.
action_result result_warning(const char *format, ...) __attribute__((format(printf, 1, 2)));
// The argument is not what the action expects.
action_result result_refused(const char *format, ...) __attribute__((format(printf, 1, 2)));
// What a call returned: done where that is STATUS_OK, else failed with the fault's sentence.
action_result result_of(status code, const fault *f);

// Whether the action succeeded.
bool result_ok(const action_result *r);

// Says on a message line what a result has to say.
void result_show(const action_result *r, message_line *m);
