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

// The same resolved.
static inline parameters defaults_of(arm_model_kind model)
{
    parameters p = fresh(model);
    DONE(parameters_resolve(&p, &f));
    return p;
}

// Sets one parameter that has to be accepted.
static inline void give(parameters *p, const char *path, const char *text)
{
    fault f = {0};
    fail_if(parameter_set_text(p, parameter_find(path), text, &f) != STATUS_OK,
            "%s = %s was refused: %s", path, text, f.text);
}

// Sets those of a list of "path=value" that ends with NULL, on any thread.
static inline void give_list(parameters *p, const char *const *settings)
{
    for (; settings != NULL && *settings != NULL; settings++) {
        char copy[8192], *text = copy;
        assert_in_range(snprintf(copy, sizeof copy, "%s", *settings), 0, sizeof copy - 1);
        const char *path = strsep(&text, "=");
        give(p, path, text);
    }
}

// The same between blanks.
static inline void give_all(parameters *p, const char *settings)
{
    give_list(p, words_of(settings));
}

// Those of the corrected arm, which go together.
static inline parameters resolved(const char *settings)
{
    parameters p = fresh(ARM_CORRECTED);
    give_all(&p, settings);
    DONE(parameters_resolve(&p, &f));
    return p;
}
