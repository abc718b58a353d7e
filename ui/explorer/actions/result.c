#include "ui/explorer/actions/result.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>

action_result result_done(void)
{
    return (action_result){.code = STATUS_OK};
}

action_result result_quiet(void)
{
    return (action_result){.code = STATUS_OK, .speaks = true};
}

static action_result speak(status code, bool warning, const char *format, va_list list)
{
    action_result r = {.code = code, .speaks = true, .warning = warning};
    vsnprintf(r.text, sizeof r.text, format, list);
    return r;
}

action_result result_news(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    action_result r = speak(STATUS_OK, false, format, list);
    va_end(list);
    return r;
}

action_result result_warning(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    action_result r = speak(STATUS_OK, true, format, list);
    va_end(list);
    return r;
}

action_result result_refused(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    action_result r = speak(STATUS_BAD_ARGUMENT, true, format, list);
    va_end(list);
    return r;
}

action_result result_of(status code, const fault *f)
{
    assert(f != NULL);
    if (code == STATUS_OK) {
        return result_done();
    }
    action_result r = result_warning("%s", f->text[0] ? f->text : status_text(code));
    r.code = code;
    return r;
}

bool result_ok(const action_result *r)
{
    assert(r != NULL);
    return r->code == STATUS_OK;
}

void result_show(const action_result *r, message_line *m)
{
    assert(r != NULL && m != NULL);
    if (r->speaks) {
        message_say(m, r->warning, "%s", r->text);
    }
}
