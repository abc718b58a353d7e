#include "ui/explorer/state/message.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>

void message_say(message_line *m, bool warning, const char *format, ...)
{
    assert(m != NULL && format != NULL);
    va_list list;
    va_start(list, format);
    vsnprintf(m->text, sizeof m->text, format, list);
    va_end(list);
    m->warning = warning;
}

void message_clear(message_line *m)
{
    assert(m != NULL);
    m->text[0] = '\0';
}
