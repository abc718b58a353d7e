#include "ui/explorer/panels/panel.h"

#include <assert.h>

static const panel *const panels[PANEL_IDS] = {
#define PANEL_POINTER(id, place, description) [id] = &description,
    PANEL_LIST(PANEL_POINTER)
#undef PANEL_POINTER
};

const panel *panel_of(panel_id id)
{
    assert(id > PANEL_NONE && id < PANEL_IDS);
    return panels[id];
}

bool panel_fits(const panel *p, screen_size body)
{
    assert(p != NULL);
    return body.width >= p->least_width && body.height >= p->least_body;
}

int pointer_wheel(pointer_event e)
{
    return e.kind == POINTER_WHEEL_UP ? -1 : 1;
}
