#include "ui/explorer/state/panel_list.h"

#include <assert.h>

static const panel_place places[PANEL_IDS] = {
#define PANEL_PLACE(id, place, description) [id] = place,
    PANEL_LIST(PANEL_PLACE)
#undef PANEL_PLACE
};

panel_place panel_place_of(panel_id id)
{
    assert(id > PANEL_NONE && id < PANEL_IDS);
    return places[id];
}

panel_id panel_next_on_side(panel_id id)
{
    for (int next = id + 1; next < PANEL_IDS; next++) {
        if (places[next] == PLACE_SIDE) {
            return (panel_id)next;
        }
    }
    return PANEL_NONE;
}

panel_id panel_first_on_side(void)
{
    return panel_next_on_side(PANEL_NONE);
}
