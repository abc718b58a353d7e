// A controller of one's own, from a shared object: control.law = plugin.
#pragma once

#include "src/rig/controller.h"
#include "src/base/fault.h"

typedef struct plugin {
    void *library; // from dlopen; NULL if nothing is open
    const controller *law;
} plugin;

// Opens control.plugin = `file` and asks it for its controller. On failure f says why,
// nothing stays open and *p is empty: STATUS_CANNOT_READ where the file cannot be loaded,
// STATUS_BAD_SCENARIO where it exports no controller, or one of another interface.
status plugin_open(plugin *p, const char *file, fault *f);

// Closes it; its controller is gone. Nothing happens to an empty one.
void plugin_close(plugin *p);
