#include "src/tables/signals.h"

#include <assert.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#include "src/base/expression.h"
#include "src/base/numbers.h"
#include "src/base/words.h"

#define ROW(field, ...) {.offset = offsetof(sample, field), .name = #field, __VA_ARGS__},

static signal_info table[SIGNALS_AT_MOST + DERIVED_SIGNALS] = {SIGNALS(ROW)};

const signal_info *const signal_table = table;
const int signal_count = SIGNALS_AT_MOST;

int signal_find(const char *name)
{
    return name_find(table, sizeof *table, signal_count, name);
}

int signal_find_any(const char *name)
{
    int i = signal_find(name);
    for (int d = SIGNALS_AT_MOST; i < 0 && d < SIGNALS_AT_MOST + DERIVED_SIGNALS; d++) {
        if (table[d].name != NULL && strcmp(table[d].name, name) == 0) {
            i = d;
        }
    }
    return i;
}

const char *signal_body_name(signal_body body)
{
    static const char *const names[] = {[BODY_NONE] = "",
                                        [BODY_HUB] = "hub",
                                        [BODY_FIRST_LINK] = "first link",
                                        [BODY_LAST_LINK] = "last link"};
    assert((unsigned)body < sizeof names / sizeof names[0]);
    return names[body];
}

int signal_index(const char *name)
{
    int index = signal_find(name);
    assert(index >= 0);
    return index;
}

bool signal_is_state(int index)
{
    assert(index >= 0 && index < SIGNALS_AT_MOST + DERIVED_SIGNALS);
    return index == SIGNAL_INDEX(contact) || index == SIGNAL_INDEX(sticking) ||
           index == SIGNAL_INDEX(controller_mode);
}

// --- derived signals -------------------------------------------------------------------

enum { DERIVED_NAME = 256 };

static struct {
    expression expression;
    char name[DERIVED_NAME];
} derived[DERIVED_SIGNALS];

// For expressions: the index of a recorded signal by its name, -1 if there is none; *near
// is the nearest name.
static int find_recorded(void *context, const char *name, const char **near)
{
    (void)context;
    *near = name_nearest(table, sizeof *table, signal_count, name);
    return signal_find(name);
}

// The unit of an expression, found by evaluating its steps with units in the place of
// numbers. A sum of terms in one unit has that unit; a product or quotient with a pure
// number keeps the unit of the other; any other combination has none, "".
static const char *unit_of(const expression *e)
{
    const char *stack[EXPRESSION_STEPS]; // NULL: a number
    int top = -1;
    for (int i = 0; i < e->count; i++) {
        const expression_step *s = &e->step[i];
        if (s->what == EXPRESSION_NUMBER || s->what == EXPRESSION_NAME) {
            stack[++top] = s->what == EXPRESSION_NAME ? table[s->name].unit : NULL;
        } else if (s->what != EXPRESSION_MINUS) {
            // an operation on the upper two, of which NULL is a pure number
            const char *a = stack[--top], *b = stack[top + 1];
            const bool same = a != NULL && b != NULL && strcmp(a, b) == 0;
            const bool sum =
                s->what != EXPRESSION_MULTIPLY && s->what != EXPRESSION_DIVIDE;
            const bool scaled = b == NULL || (a == NULL && s->what != EXPRESSION_DIVIDE);
            if (scaled) {
                if (a != NULL) {
                    stack[top] = a;
                } else {
                    stack[top] = b;
                }
            } else if (sum && same) {
                stack[top] = a;
            } else {
                stack[top] = "";
            }
        }
    }
    if (stack[0] != NULL) {
        return stack[0];
    }
    return "";
}

// The name of an expression: its text without blanks.
static void name_expression(const char *text, char name[DERIVED_NAME])
{
    size_t length = 0;
    for (const char *c = text; *c != '\0' && length + 1 < DERIVED_NAME; c++) {
        if (!is_blank(*c)) {
            name[length++] = *c;
        }
    }
    name[length] = '\0';
}

int signal_derive(int place, const char *text, fault *f)
{
    assert(place >= 0 && place < DERIVED_SIGNALS);
    expression e;
    char name[DERIVED_NAME];
    name_expression(text, name);
    if (expression_read(&e, text, find_recorded, NULL, f) != STATUS_OK) {
        return -1;
    }

    // a row of the table like those of recorded signals
    derived[place].expression = e;
    snprintf(derived[place].name, DERIVED_NAME, "%s", name);
    table[SIGNALS_AT_MOST + place] =
        (signal_info){.name = derived[place].name,
                      .symbol = derived[place].name,
                      .ascii = derived[place].name,
                      .unit = unit_of(&e),
                      .description = "an expression of yours",
                      .quantity = derived[place].name,
                      .colour = place % 8};
    return SIGNALS_AT_MOST + place;
}

bool signal_is_derived(int index)
{
    return index >= SIGNALS_AT_MOST;
}

int signal_of_text(const char *text, fault *f)
{
    // one thread at a time takes a place, and others wait for the short while; a flag, as
    // compilers for other systems have it without a library
    static atomic_flag taken = ATOMIC_FLAG_INIT;
    char name[DERIVED_NAME];
    name_expression(text, name);
    while (atomic_flag_test_and_set(&taken)) {
    }
    int index = signal_find_any(name), place = 0;

    // the first place that no expression has had
    while (place < DERIVED_SIGNALS && derived[place].name[0] != '\0') {
        place++;
    }
    if (index < 0 && place == DERIVED_SIGNALS) {
        fault_set(f, STATUS_BAD_ARGUMENT, "'%.60s': there are %d other expressions", text,
                  DERIVED_SIGNALS);
    } else if (index < 0) {
        index = signal_derive(place, text, f);
    }
    atomic_flag_clear(&taken);
    return index;
}

// --- values ----------------------------------------------------------------------------

// The value of a recorded signal in a row, which is a sample.
static double recorded_value(const void *row, int index)
{
    double value;
    memcpy(&value, (const char *)row + table[index].offset, sizeof value);
    return value;
}

double signal_value(const sample *row, int index)
{
    assert(index >= 0 && index < SIGNALS_AT_MOST + DERIVED_SIGNALS);
    if (signal_is_derived(index)) {
        return expression_evaluate(&derived[index - SIGNALS_AT_MOST].expression,
                                   recorded_value, row);
    }
    return recorded_value(row, index);
}
