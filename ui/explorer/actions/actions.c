#include "ui/explorer/actions/actions.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

// Puts a sentence on the message line; it may contain what stood there.
static void put_message(explorer_state *st, bool warning, const char *format, va_list list)
{
    char text[MESSAGE_TEXT];
    vsnprintf(text, sizeof text, format, list);
    memcpy(st->message.text, text, sizeof text);
    st->message.warning = warning;
}

bool act_hush(explorer_state *st)
{
    assert(st != NULL);
    st->message.text[0] = '\0';
    return true;
}

bool act_tell(explorer_state *st, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    put_message(st, false, format, list);
    va_end(list);
    return true;
}

bool act_warn(explorer_state *st, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    put_message(st, true, format, list);
    va_end(list);
    return true;
}

bool act_refuse(explorer_state *st, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    put_message(st, true, format, list);
    va_end(list);
    return false;
}

bool act_worked(explorer_state *st, status code, const fault *f)
{
    assert(f != NULL);
    return code == STATUS_OK || act_refuse(st, "%s", f->text[0] ? f->text : status_text(code));
}

bool act_read_number(explorer_state *st, const char *text, double *value)
{
    assert(text != NULL && value != NULL);
    char *end;
    *value = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(*value)) {
        return act_refuse(st, "'%s' is no number", text);
    }
    return true;
}

bool act_read_optional(explorer_state *st, const char *text, double *value)
{
    assert(text != NULL && value != NULL);
    return text[0] == '\0' || act_read_number(st, text, value);
}

int act_read_index(explorer_state *st, const char **text, int count, const char *what,
                   const char *lister)
{
    assert(text != NULL && count > 0);
    char *end;
    const long number = strtol(*text, &end, 10);

    // a number of the list, alone or before a blank
    if (end == *text || (*end != '\0' && *end != ' ') || number < 1 || number > count) {
        act_refuse(st, "%s are numbered from 1 to %d (%s lists them)", what, count, lister);
        return -1;
    }
    *text = end + strspn(end, " ");
    return (int)number - 1;
}
