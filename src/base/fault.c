#include "src/base/fault.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>

#include "src/base/numbers.h"

const char *status_text(status code)
{
    switch (code) {
#define STATUS_CASE(name, text)                                                                    \
    case STATUS_##name:                                                                            \
        return text;
        STATUS_LIST(STATUS_CASE)
#undef STATUS_CASE
    }
    return "unknown status";
}

// Fills f (may be NULL) with all that it has to say.
static void fill(fault *f, status code, const char *path, int line, int column, const char *format,
                 va_list args)
{
    if (f != NULL) {
        f->code = code;
        f->path = path;
        f->line = line;
        f->column = column;
        decimal_vprint(f->text, sizeof f->text, format, args);
    }
}

status fault_set(fault *f, status code, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fill(f, code, "", 0, 0, format, args);
    va_end(args);
    return code;
}

status fault_no_memory(fault *f)
{
    return fault_set(f, STATUS_NO_MEMORY, "%s", status_text(STATUS_NO_MEMORY));
}

status fault_set_at(fault *f, status code, const char *path, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fill(f, code, path, 0, 0, format, args);
    va_end(args);
    return code;
}

status fault_set_place(fault *f, status code, int line, int column, const char *format, ...)
{
    assert(line > 0 && column > 0);
    va_list args;
    va_start(args, format);
    fill(f, code, "", line, column, format, args);
    va_end(args);
    return code;
}
