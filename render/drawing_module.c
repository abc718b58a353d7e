// Loads the half that draws, in the program itself.
#include "render/drawing.h"

#include <assert.h>
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/shipped.h"

static const drawing_functions *loaded;

// The module stays loaded until the program ends.
status drawing_open(fault *f)
{
    if (loaded != NULL) {
        return STATUS_OK;
    }
    SCOPED(free_kept) char *path = shipped_path(SHIPPED_DRAWING);
    if (path == NULL) {
        return fault_no_memory(f);
    }

    void *module = dlopen(path, RTLD_LAZY | RTLD_LOCAL);
    FAULT_IF(module == NULL, f, STATUS_CANNOT_WRITE,
             "pictures need the program's module drawing.so, which cannot be loaded: %s",
             dlerror());
    const drawing_functions *table = dlsym(module, "drawing_table");
    FAULT_IF(table == NULL || strcmp(table->version, lab_version()) != 0, f,
             STATUS_CANNOT_WRITE, "pictures need version %s of the program's module '%s'",
             lab_version(), path);
    loaded = table;
    return STATUS_OK;
}

const drawing_functions *drawing(void)
{
    assert(loaded != NULL);
    return loaded;
}
