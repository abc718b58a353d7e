// Parameters for tests of their table and of their combinations.
#pragma once

#include "src/tables/parameters.h"
#include "tests/check.h"

// The defaults of a model, not resolved.
static inline parameters fresh(arm_model_kind model)
{
    parameters p;
    parameters_defaults(&p, model);
    return p;
}

// Sets one parameter that has to be accepted.
static inline void give(parameters *p, const char *path, const char *text)
{
    fault f = {0};
    fail_if(parameter_set_text(p, parameter_find(path), text, &f) != STATUS_OK,
            "%s = %s was refused: %s", path, text, f.text);
}
