#include "src/base/status.h"

#include <stdarg.h>
#include <stdio.h>

const char *status_text(status code)
{
    switch (code) {
#define STATUS_CASE(name, text)                                                                    \
    case name:                                                                                     \
        return text;
        STATUS_LIST(STATUS_CASE)
#undef STATUS_CASE
    }
    return "unknown status";
}

status fault_set(fault *f, status code, const char *format, ...)
{
    if (f != NULL) {
        va_list args;
        f->code = code;
        va_start(args, format);
        vsnprintf(f->text, sizeof f->text, format, args);
        va_end(args);
    }
    return code;
}
