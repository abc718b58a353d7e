#include "src/base/fault.h"

#include <assert.h>
#include <stdarg.h>
#include <stddef.h>

#include "src/base/numbers.h"

#define STATUS_TEXT(name, text) text,
static const char *const texts[] = {STATUS_LIST(STATUS_TEXT)};

const char *status_text(status code)
{
    if ((size_t)code < sizeof texts / sizeof texts[0]) {
        return texts[code];
    }
    return "unknown status";
}

status fault_fill(fault *f, status code, const char *path, int line, int column,
                  const char *format, ...)
{
    assert(line >= 0 && (line > 0) == (column > 0));
    if (f != NULL) {
        va_list args;
        va_start(args, format);
        f->code = code;
        f->path = path;
        f->line = line;
        f->column = column;
        decimal_vprint(f->text, sizeof f->text, format, args);
        va_end(args);
    }
    return code;
}

status fault_no_memory(fault *f)
{
    return fault_set(f, STATUS_NO_MEMORY, "%s", status_text(STATUS_NO_MEMORY));
}
