// The errors of the C library: what went wrong in a call, in words and numbers for its
// caller.
#include "src/api/api_handles.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/text_stream.h"
#include "src/base/numbers.h"
#include "src/base/words.h"

// The public numbers are those of the program.
#define SAME_CODE(code, text)                                                            \
    _Static_assert((int)IMPACTLAB_##code == (int)STATUS_##code, text);
STATUS_LIST(SAME_CODE)

const char *impactlab_status_text(int code)
{
    if (code >= STATUS_OK && code <= STATUS_IMPOSSIBLE_MEAN) {
        return status_text((status)code);
    }
    return "not a status of impactlab";
}

// Copies a text, cut to fit.
static void copy_text(char *to, size_t size, const char *from)
{
    size_t length = strnlen(from, size - 1);
    memcpy(to, from, length);
    to[length] = '\0';
}

int api_error(impactlab_error *error, const fault *f)
{
    if (error != NULL) {
        *error = (impactlab_error){.status = (int)f->code,
                                   .line = f->line,
                                   .column = f->column};
        copy_text(error->parameter, sizeof error->parameter, f->path);
        const char *sentence = f->text[0] != '\0' ? f->text : status_text(f->code);
        copy_text(error->sentence, sizeof error->sentence, sentence);
    }
    return (int)f->code;
}

int api_fail(impactlab_error *error, status code, const char *format, ...)
{
    fault f = {.code = code, .text = "", .path = ""};
    va_list values;
    va_start(values, format);
    decimal_vprint(f.text, sizeof f.text, format, values);
    va_end(values);
    return api_error(error, &f);
}

int api_done(impactlab_error *error)
{
    // only the beginnings of the texts are cleared, as loops call this at every step
    if (error != NULL) {
        error->status = IMPACTLAB_OK;
        error->line = error->column = 0;
        error->sentence[0] = error->parameter[0] = '\0';
    }
    return IMPACTLAB_OK;
}

int api_missing(impactlab_error *error, const char *names, size_t i)
{
    // name i of a list with commas; a handle is a scenario to the caller
    for (; i > 0; i--) {
        names = strchr(names, ',') + 2;
    }
    int length = (int)strcspn(names, ",");
    if (strncmp(names, "handle", (size_t)length) == 0) {
        names = "scenario";
        length = (int)strlen(names);
    }
    return api_fail(error, STATUS_BAD_ARGUMENT,
                    "the argument %.*s is NULL, expected what it points to", length,
                    names);
}

int api_refused(impactlab_error *error, fault *first, const fault_place *at, status code)
{
    first->code = code;
    first->line = at->line;
    first->column = at->column;
    if (at->path != NULL) {
        first->path = at->path;
    } else {
        first->path = "";
    }
    return api_error(error, first);
}

int api_parameter(const char *path, const char **text, char room[PARAMETER_TEXT_SIZE],
                  impactlab_error *error)
{
    fault f = {.text = "", .path = ""};
    const int index = settings_look_up_value(path, text, room, &f);
    if (index < 0) {
        f.code = STATUS_BAD_ARGUMENT;
        api_error(error, &f);
    }
    return index;
}

int api_axis(const char *path, sweep_axis *axis, impactlab_error *error)
{
    fault f = {.text = "", .path = ""};
    const char *name;
    *axis = (sweep_axis){.parameter = settings_look_up(path, &name, &f)};
    if (axis->parameter < 0) {
        f.code = STATUS_BAD_ARGUMENT;
        return api_error(error, &f);
    }
    snprintf(axis->name, sizeof axis->name, "%.*s", SWEEP_NAME - 1, path);
    return IMPACTLAB_OK;
}

int api_signal(const char *name, impactlab_error *error)
{
    int index = signal_find(name);
    if (index >= 0) {
        return index;
    }

    // most unknown names are misspelt: the nearest one
    nearest_word near = nearest_begin(name);
    for (int i = 0; i < signal_count; i++) {
        nearest_try(&near, signal_table[i].name);
    }
    api_fail_unknown(error, "signal", name, near.best);
    return -1;
}

int api_fail_unknown(impactlab_error *error, const char *kind, const char *name,
                     const char *near)
{
    if (near == NULL) {
        return api_fail(error, STATUS_BAD_ARGUMENT, "there is no %s '%.200s'", kind,
                        name);
    }
    return api_fail(error, STATUS_BAD_ARGUMENT,
                    "there is no %s '%.200s', did you mean '%s'?", kind, name, near);
}

int api_text(char **text, void (*write)(FILE *stream, const void *what), const void *what,
             impactlab_error *error)
{
    // losses that this thread has noted before do not count for this text
    text_stream stream;
    loss_forget();
    *text = NULL;
    if (text_stream_open(&stream)) {
        write(stream.stream, what);
        *text = text_stream_close(&stream, NULL);
    }
    if (*text != NULL) {
        return api_done(error);
    }
    return api_fail(error, STATUS_NO_MEMORY, "no memory for a text");
}

void impactlab_text_free(char *text)
{
    free(text);
}
