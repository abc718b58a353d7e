// The table of what draws, by which the program finds it in the module.
#include "render/drawing.h"

#include "src/base/build_config.h"

const drawing_functions drawing_table = {.version = IMPACTLAB_VERSION,
#define DRAWING_ENTRY(name) .name = name,
                                         DRAWING_FUNCTIONS(DRAWING_ENTRY)
#undef DRAWING_ENTRY
};
