// What a set of parameters asks for, as bits, and the one table of what follows from
// them: which parameters act, and which of them are refused where they do not.
#pragma once

#include "src/tables/feature_bits.h"
#include "src/tables/parameters.h"

// The features of resolved parameters, but for those that the law, the script and the
// choice of an engine have.
feature_set features_of(const parameters *p);

// Why a parameter has no effect in a run with these features: half a sentence; NULL if it
// has one.
const char *features_inert(feature_set features, int parameter);

// STATUS_BAD_SCENARIO with a sentence and the path where parameters were given, other
// than by their default, that those features refuse.
status features_check(const parameters *p, fault *f);
