// Controllers in shared objects: one is loaded, checked, and asked as those of the lab
// are.
#include "src/rig/external/plugin.h"

#include <dlfcn.h>
#include <string.h>

#include "src/base/input_file.h"

// The controller that a loaded object exports, NULL if it has none.
static const controller *exported_controller(void *library)
{
    // a function behind a pointer to data: as POSIX has it
    controller_entry entry = NULL;
    void *symbol = dlsym(library, CONTROLLER_ENTRY);
    memcpy(&entry, &symbol, sizeof entry);
    if (entry != NULL) {
        return entry();
    }
    return NULL;
}

status plugin_open(plugin *p, const char *file, fault *f)
{
    // a name without a slash is looked for by the system
    fault why = {0};
    *p = (plugin){0};
    if (strchr(file, '/') != NULL && input_file_check_plain(file, &why) != STATUS_OK) {
        return fault_set(f, STATUS_CANNOT_READ, "control.plugin = %s %s", file, why.text);
    }
    *p = (plugin){.library = dlopen(file, RTLD_NOW | RTLD_LOCAL)};
    FAULT_IF(p->library == NULL, f, STATUS_CANNOT_READ,
             "control.plugin = %s cannot be loaded: %.600s", file, dlerror());

    // nothing behind `interface` can be read before the version is known
    status s = STATUS_OK;
    const controller *law = exported_controller(p->library);
    if (law == NULL) {
        s = fault_set(f, STATUS_BAD_SCENARIO,
                      "control.plugin = %s has no function %s that returns a controller",
                      file, CONTROLLER_ENTRY);
    } else if (law->interface != CONTROLLER_INTERFACE) {
        s = fault_set(f, STATUS_BAD_SCENARIO,
                      "control.plugin = %s was made for version %d of the interface, "
                      "expected %d; compile it again",
                      file, law->interface, CONTROLLER_INTERFACE);
    } else if (law->sample == NULL) {
        s = fault_set(f, STATUS_BAD_SCENARIO,
                      "control.plugin = %s has no function `sample`", file);
    }

    // an object that cannot be run is closed again
    p->law = law;
    if (s != STATUS_OK) {
        plugin_close(p);
    }
    return s;
}

void plugin_close(plugin *p)
{
    if (p->library != NULL) {
        dlclose(p->library);
    }
    *p = (plugin){0};
}
