#include "src/base/text_stream.h"

#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

#include "src/base/fault.h"

// Makes room for some bytes more and the 0 behind them.
static bool reserve_bytes(text_stream *t, size_t count)
{
    enum { LEAST = 512 };
    if (t->length + count < t->capacity) {
        return true;
    }

    const size_t wanted = 2 * (t->length + count) + LEAST;
    char *grown = realloc(t->text, wanted);
    if (grown != NULL) {
        t->text = grown;
        t->capacity = wanted;
    }
    return grown != NULL;
}

// Takes what the stream hands over; 0 marks the stream as failed.
static ssize_t take(void *cookie, const char *bytes, size_t count)
{
    text_stream *t = cookie;
    if (!reserve_bytes(t, count)) {
        return 0;
    }
    memcpy(t->text + t->length, bytes, count);
    t->length += count;
    return (ssize_t)count;
}

bool text_stream_open(text_stream *t)
{
    *t = (text_stream){.text = NULL};
    t->stream = fopencookie(t, "w", (cookie_io_functions_t){.write = take});
    return t->stream != NULL;
}

char *text_stream_close(text_stream *t, size_t *length)
{
    bool whole = ferror(t->stream) == 0;
    whole = fclose(t->stream) == 0 && whole;
    whole = !loss_noted() && whole && reserve_bytes(t, 0);

    if (!whole) {
        free(t->text);
        return NULL;
    }

    t->text[t->length] = '\0';
    if (length != NULL) {
        *length = t->length;
    }
    return t->text;
}

// --- what was lost for want of memory --------------------------------------------------

// of every thread, found without the loader's help, which a library would have to be
// linked with
static _Thread_local bool lost __attribute__((tls_model("initial-exec")));

void loss_unless(bool kept)
{
    lost = lost || !kept;
}

bool loss_noted(void)
{
    const bool since = lost;
    lost = false;
    return since;
}

void loss_forget(void)
{
    lost = false;
}
