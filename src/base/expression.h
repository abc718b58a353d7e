// Expressions of named quantities: names, numbers, + - * / ( ) and max(a, b).
#pragma once

#include "src/base/fault.h"

enum { EXPRESSION_STEPS = 64 };

// An expression that was read: operations on a stack, in the order in which they are
// done.
typedef struct expression_step {
    enum {
        EXPRESSION_NUMBER,
        EXPRESSION_NAME,
        EXPRESSION_MINUS, // of one value
        EXPRESSION_ADD,
        EXPRESSION_SUBTRACT,
        EXPRESSION_MULTIPLY,
        EXPRESSION_DIVIDE,
        EXPRESSION_MAX
    } what;
    double number;
    int name; // as the reader's finder numbers it
} expression_step;

typedef struct expression {
    expression_step step[EXPRESSION_STEPS];
    int count;
} expression;

// The number of a name, -1 if there is none: then *near is one that may have been meant,
// or NULL.
typedef int expression_find(void *context, const char *name, const char **near);
// The value of a name by its number.
typedef double expression_value(const void *context, int name);

// Reads an expression of names that `find` knows. STATUS_BAD_ARGUMENT with the column
// (from 1) in the sentence and in f->column if it cannot be read.
status expression_read(expression *e, const char *text, expression_find *find,
                       void *context, fault *f);

// Its value, which may not be finite.
double expression_evaluate(const expression *e, expression_value *value,
                           const void *context);
