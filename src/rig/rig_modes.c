// The modes of a controller by name, and holding it in one of them.
#include "src/rig/rig.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

// "approach, impact or force"
static void list_modes(const controller *law, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; law->modes != NULL && law->modes[i] != NULL && used < size; i++) {
        const char *before = i == 0 ? "" : law->modes[i + 1] == NULL ? " or " : ", ";
        used += (size_t)snprintf(text + used, size - used, "%s%.40s", before, law->modes[i]);
    }
}

status rig_find_mode(const controller *law, const char *lock, int *mode, fault *f)
{
    assert(law != NULL && lock != NULL && mode != NULL);
    *mode = -1;
    if (lock[0] == '\0' || strcmp(lock, "none") == 0) {
        return STATUS_OK;
    }
    if (!law->lockable || law->modes == NULL) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, "control.lock",
                            "control.lock = '%.60s', but the law '%s' cannot be held in a mode, "
                            "expected none",
                            lock, law->name);
    }

    // the mode of that name
    for (int i = 0; law->modes[i] != NULL; i++) {
        if (strcmp(law->modes[i], lock) == 0) {
            *mode = i;
            return STATUS_OK;
        }
    }

    // none: say which there are
    char modes[256];
    list_modes(law, modes, sizeof modes);
    return fault_set_at(f, STATUS_BAD_SCENARIO, "control.lock",
                        "control.lock = '%.60s' is no mode of the law '%s', expected none, %s",
                        lock, law->name, modes);
}

status rig_lock(rig *r, const char *lock, fault *f)
{
    assert(r != NULL);
    int mode;
    status s = rig_find_mode(r->law, lock, &mode, f);
    r->lock = s == STATUS_OK ? mode : r->lock;
    return s;
}

int rig_mode_names(const parameters *p, char names[][MODE_NAME_SIZE], int most, bool *lockable)
{
    assert(p != NULL && names != NULL && lockable != NULL);
    fault ignored;
    plugin opened = {0};
    const controller *law = controller_of(p->control.law);
    if (p->control.law == LAW_PLUGIN && p->code_allowed &&
        plugin_open(&opened, p->control.plugin, &ignored) == STATUS_OK) {
        law = opened.law;
    }

    // copies, as a plug-in's own names go with it
    int count = 0;
    *lockable = law != NULL && law->lockable;
    const char *const *modes = law != NULL ? law->modes : NULL;
    for (; modes != NULL && modes[count] != NULL && count < most; count++) {
        snprintf(names[count], MODE_NAME_SIZE, "%s", modes[count]);
    }
    plugin_close(&opened);
    return count;
}
