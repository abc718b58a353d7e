#include "ui/explorer/state/law_modes.h"

#include <assert.h>
#include <stdio.h>

void law_modes_update(law_modes *m, unsigned long run, const parameters *p)
{
    assert(m != NULL && p != NULL && run != 0);
    if (m->run != run) {
        m->run = run;
        m->count = rig_mode_names(p, m->names, LAW_MODES, &m->lockable);
    }
}

void law_mode_name(const law_modes *m, double mode, char *text, size_t size)
{
    assert(m != NULL && text != NULL);
    if (mode >= 0 && mode < m->count) {
        snprintf(text, size, "%s", m->names[(int)mode]);
    } else {
        snprintf(text, size, "mode %g", mode);
    }
}
