#include "src/tables/summary.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/words.h"

#define ROW(number, ...) {#number, __VA_ARGS__},

const summary_info summary_table[] = {SUMMARY_NUMBERS_OF_A_RUN(ROW)};
const int summary_count = (int)(sizeof summary_table / sizeof summary_table[0]);

int summary_find(const char *key)
{
    return name_find(summary_table, sizeof *summary_table, summary_count, key);
}

int summary_find_begun(const char *text)
{
    const int named = summary_find(text);
    const size_t length = strlen(text);
    for (int i = 0; named < 0 && length > 0 && i < summary_count; i++) {
        const char *key = summary_table[i].key;
        if (strncmp(key, text, length) == 0 && key[length] == '_') {
            return i;
        }
    }
    return named;
}

int summary_index(const char *key)
{
    int index = summary_find(key);
    assert(index >= 0);
    return index;
}

const char *summary_suggest(const char *key)
{
    return name_nearest(summary_table, sizeof *summary_table, summary_count, key);
}

// The offset of a quantity in a summary, whose numbers lie in the order of the table.
static size_t offset_of(int index)
{
    assert(index >= 0 && index < summary_count);
    return offsetof(summary, first_contact_s) + (size_t)index * sizeof(double);
}

double summary_value(const summary *s, int index)
{
    double value;
    memcpy(&value, (const char *)s + offset_of(index), sizeof value);
    return value;
}

const char *summary_status(const summary *s)
{
    if (s->status != STATUS_OK) {
        return "failed";
    }
    if (s->inaccurate) {
        return "inaccurate";
    }
    return "ok";
}

status summary_fault(const summary *s, fault *f)
{
    assert(s->status != STATUS_OK);
    return fault_set_at(f, s->status, s->path, "%s", s->message);
}

void summary_init(summary *s)
{
    const double none = (double)NAN;
    memset(s, 0, sizeof *s);
    s->path = "";
    for (int i = 0; i < summary_count; i++) {
        memcpy((char *)s + offset_of(i), &none, sizeof none);
    }
}
