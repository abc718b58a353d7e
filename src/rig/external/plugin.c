#include "src/rig/external/plugin.h"

#include <assert.h>
#include <dlfcn.h>
#include <string.h>

// The controller that a loaded object exports, NULL if it has none.
static const controller *exported_controller(void *library)
{
    // a function behind a pointer to data: as POSIX has it
    controller_entry entry = NULL;
    void *symbol = dlsym(library, CONTROLLER_ENTRY);
    memcpy(&entry, &symbol, sizeof entry);
    return entry != NULL ? entry() : NULL;
}

// Whether the rig can run what the object exports.
static status check_controller(const controller *law, const char *file, fault *f)
{
    if (law == NULL) {
        return fault_set(f, STATUS_BAD_SCENARIO,
                         "control.plugin = %s has no function %s that returns a controller", file,
                         CONTROLLER_ENTRY);
    }

    // nothing behind `interface` can be read before the version is known
    if (law->interface != CONTROLLER_INTERFACE) {
        return fault_set(
            f, STATUS_BAD_SCENARIO,
            "control.plugin = %s was made for version %d of the interface, expected %d; "
            "compile it again",
            file, law->interface, CONTROLLER_INTERFACE);
    }

    if (law->sample == NULL) {
        return fault_set(f, STATUS_BAD_SCENARIO, "control.plugin = %s has no function `sample`",
                         file);
    }
    return STATUS_OK;
}

status plugin_open(plugin *p, const char *file, fault *f)
{
    assert(p != NULL && file != NULL);
    *p = (plugin){.library = dlopen(file, RTLD_NOW | RTLD_LOCAL)};
    if (p->library == NULL) {
        return fault_set(f, STATUS_CANNOT_READ, "control.plugin = %s cannot be loaded: %.600s",
                         file, dlerror());
    }

    // an object that cannot be run is closed again
    p->law = exported_controller(p->library);
    status s = check_controller(p->law, file, f);
    if (s != STATUS_OK) {
        plugin_close(p);
    }
    return s;
}

void plugin_close(plugin *p)
{
    assert(p != NULL);
    if (p->library != NULL) {
        dlclose(p->library);
    }
    *p = (plugin){0};
}
