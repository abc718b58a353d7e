#include "src/tables/parameters.h"

#include <assert.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/plain_math.h"
#include "src/base/words.h"
#include "src/tables/control_laws.h"
#include "src/tables/feature_bits.h"

// The row of the parameter table for an entry of the list: its path and offset, type,
// unit, range and description, then what only some entries have.
#define ROW(group, field, meaning, kind, in, from, to, ...)                              \
    {.path = #group "." #field,                                                          \
     .offset = offsetof(parameters, group.field),                                        \
     .type = PARAMETER_##kind,                                                           \
     .unit = in,                                                                         \
     .minimum = from,                                                                    \
     .maximum = to,                                                                      \
     .description = meaning,                                                             \
     __VA_ARGS__},
#define REAL(group, field, meaning, in, from, to, ...)                                   \
    ROW(group, field, meaning, REAL, in, from, to, __VA_ARGS__)
#define INTEGER(group, field, meaning, from, to, ...)                                    \
    ROW(group, field, meaning, INTEGER, "", from, to, __VA_ARGS__)
#define BOOLEAN(group, field, meaning, ...)                                              \
    ROW(group, field, meaning, BOOLEAN, "", 0, 1, __VA_ARGS__)
#define CHOICE(group, field, meaning, last, words, ...)                                  \
    ROW(group, field, meaning, CHOICE, "", 0, last, .choices = words, __VA_ARGS__)
#define TEXT(group, field, meaning, ...)                                                 \
    ROW(group, field, meaning, TEXT, "", 0, 1, .choices = __VA_ARGS__)
#define LIST(group, field, meaning, in, from, to)                                        \
    ROW(group, field, meaning, LIST, in, from, to, .choices = NULL)
#define GROUP(name)
#define END_GROUP(name)
#define DEFAULT(value)           .default_corrected = value, .default_printed = value
#define DEFAULTS(ours, printed_) .default_corrected = ours, .default_printed = printed_
#define TIMED                    .timed = true
#define SYMBOL(letters)          .symbol = letters

// The default follows from other parameters, see parameters_resolve.
#define DERIVED (double)NAN

// k1 with which the printed model reproduces the thesis's tables. The thesis prints 169
// 468 N m/rad, with which its own algorithm at h = 1 ms chatters; 90 lies in the range
// 85-100 that matches Tables 4.1-4.3 best (docs/explanation/model.md).
#define K1_PRINTED_TABLES 90.0
#define K1_THESIS         169468.0882

// The share of the energy put in that the ledger of the event method may be off by.
#define EVENT_RESIDUAL_BOUND 1e-6

// kT is printed as 0.249092 kg m/A; one kilogram-force is 9.80665 N.
#define TORQUE_CONSTANT (0.249092 * 9.80665)

const parameter_info parameter_table[] = {
#include "src/tables/parameter_list.h"
};

const int parameter_count = (int)(sizeof parameter_table / sizeof parameter_table[0]);

_Static_assert(sizeof parameter_table / sizeof parameter_table[0] <=
                   sizeof(((parameters *)0)->set),
               "parameters.set has room for every parameter");
_Static_assert(sizeof parameter_table / sizeof parameter_table[0] <= UCHAR_MAX + 1,
               "a byte has room for every index");

// The index of the parameter that begins at each offset. It is filled in before main, as
// resolving one set of parameters looks up about a hundred indices.
static unsigned char index_at[sizeof(parameters)];

static __attribute__((constructor)) void fill_indices(void)
{
    for (int i = 0; i < parameter_count; i++) {
        index_at[parameter_table[i].offset] = (unsigned char)i;
    }
}

int parameter_at(size_t offset)
{
    assert(offset < sizeof index_at);
    const int index = index_at[offset];
    assert(parameter_table[index].offset == offset);
    return index;
}

int parameter_find(const char *path)
{
    return name_find(parameter_table, sizeof *parameter_table, parameter_count, path);
}

int parameter_index(const char *path)
{
    int index = parameter_find(path);
    assert(index >= 0);
    return index;
}

int parameter_look_up(const char *path, fault *f)
{
    int index = parameter_find(path);
    if (index < 0) {
        char hint[HINT_TEXT];
        fault_set(f, STATUS_BAD_ARGUMENT, "unknown parameter '%.60s'%s", path,
                  did_you_mean(hint, parameter_suggest(path),
                               ", expected one that 'show' lists"));
    }
    return index;
}

const char *parameter_suggest(const char *path)
{
    // the same name in another group, if the path has a wrong group or none
    const char *dot = strrchr(path, '.'), *name = dot != NULL ? dot + 1 : path;
    for (int i = 0; i < parameter_count; i++) {
        if (strcmp(strchr(parameter_table[i].path, '.') + 1, name) == 0) {
            return parameter_table[i].path;
        }
    }
    return name_nearest(parameter_table, sizeof *parameter_table, parameter_count, path);
}

const control_law_info control_law_table[LAW_COUNT] = {
    [LAW_NONE] = {.word = "none",
                  .description = "no rig: the bare arm under motor.voltage",
                  .ignored = ""},
    [LAW_PLUGIN] = {.word = "plugin",
                    .description = "a controller of one's own",
                    .told = TOLD_MODEL,
                    .ignored = ""},
    [LAW_PROCESS] = {.word = "process",
                     .description = "a program of one's own, in any language",
                     .told = TOLD_MODEL,
                     .ignored = ""},
    [LAW_PLAYBACK] = {.word = "playback",
                      .description = "a recorded command, from a CSV file",
                      .ignored = ""},
#define LAW(name, prefix, word, told, moving, ignored, description, needs, sensors,      \
            fails)                                                                       \
    [LAW_##name] = {word, description, needs, sensors, fails, told, moving, ignored},
    CONTROL_LAWS(LAW)
#undef LAW
};
