// Expressions of named quantities: keys, numbers, + - * / ( ) and max(a, b).
#pragma once

#include <stdbool.h>

#include "src/base/fault.h"

// The value of a key. False if there is none of that name: then *near is one that may have been
// meant, or NULL.
typedef bool (*expression_key)(void *context, const char *name, double *value, const char **near);

// The value of an expression, which may not be finite. STATUS_BAD_ARGUMENT with the column (from 1)
// in the sentence and in f->column if it cannot be read.
status expression_evaluate(const char *text, expression_key find, void *context, double *value,
                           fault *f);
