#include "src/tables/k2_table.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/tables/parameters_parts.h"

// Reads an entry "FORCE:K2" at the start of text, a force from 0 on and a positive k2.
// *rest is what follows the entry and blanks. False if there is no such entry.
static bool read_entry(const char *text, double *force, double *k2, const char **rest)
{
    return decimal_read(text, force, rest) && **rest == ':' &&
           decimal_read(*rest + 1, k2, rest) && *force >= 0 && *k2 > 0 &&
           isfinite(*force) && isfinite(*k2);
}

status k2_table_read(k2_table *t, const char *text, fault *f)
{
    const char *rest = text + strspn(text, " ");
    *t = (k2_table){0};
    while (*rest != '\0') {
        const char *entry = rest;
        int i = t->count, length = (int)strcspn(entry, " ");

        // a pair of numbers, as long as there is room
        if (i == K2_TABLE_MOST) {
            return fault_set_at(f, STATUS_BAD_SCENARIO, "control.k2_table",
                                "control.k2_table has more than %d entries of FORCE:K2",
                                K2_TABLE_MOST);
        }
        if (!read_entry(entry, &t->force[i], &t->k2[i], &rest)) {
            return fault_set_at(
                f, STATUS_BAD_SCENARIO, "control.k2_table",
                "control.k2_table: '%.*s' is wrong, expected FORCE:K2 such as "
                "1.5:4.92, a force from 0 N and a stiffness above 0 N m/rad",
                length, entry);
        }

        // forces grow, so that interpolation between neighbours gives one k2
        if (i > 0 && !(t->force[i] > t->force[i - 1])) {
            return fault_set_at(
                f, STATUS_BAD_SCENARIO, "control.k2_table",
                "control.k2_table: the force of '%.*s' is not above the one before "
                "it, expected growing forces",
                length, entry);
        }
        t->count++;
    }
    return STATUS_OK;
}

bool k2_table_write(const k2_table *t, char *text, size_t size)
{
    assert(size > 0);
    size_t length = 0;
    text[0] = '\0';
    for (int i = 0; i < t->count && length < size; i++) {
        length += (size_t)decimal_print(text + length, size - length, "%s%.4g:%.4g",
                                        i > 0 ? " " : "", t->force[i], t->k2[i]);
    }
    return length < size;
}

double k2_table_at(const k2_table *t, double force)
{
    assert(t->count > 0);
    // the first entry with a larger force; outside the table the nearest k2 holds
    int above = 0;
    while (above < t->count && t->force[above] <= force) {
        above++;
    }
    if (above == 0 || above == t->count) {
        return t->k2[above == 0 ? 0 : t->count - 1];
    }

    // linear between two entries
    double share =
        (force - t->force[above - 1]) / (t->force[above] - t->force[above - 1]);
    return t->k2[above - 1] + share * (t->k2[above] - t->k2[above - 1]);
}
