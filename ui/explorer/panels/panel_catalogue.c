// The catalogue of panels: the one file that knows them all, for those who draw them and
// pass keys and the mouse on to them.
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

void panel_draw(panel_id id, const explorer_model *model, const explorer_view *view,
                layout *lay, screen *s, area a)
{
    const panel *p = panel_of(id);
    if (p->list != NULL) {
        list_draw(p->list, model, view, lay, s, a);
    } else {
        p->draw(model, view, lay, s, a);
    }
}

bool panel_key(explorer_model *model, explorer_view *view, explorer_input *input, int key)
{
    const panel *p = panel_of(view->page);
    if (p->list != NULL) {
        return list_press_key(p->list, model, view, input, key);
    }
    return p->key(model, view, input, key);
}

// A step of the wheel on a page presses its keys for up and down.
static void turn_page(explorer_model *model, explorer_view *view, explorer_input *input,
                      int wheel)
{
    int key = KEY_CODE_DOWN;
    if (wheel < 0) {
        key = KEY_CODE_UP;
    }
    for (int i = 0; i < WHEEL_LINES && view->page != PANEL_NONE; i++) {
        panel_key(model, view, input, key);
    }
}

bool panel_point(explorer_model *model, explorer_view *view, explorer_input *input,
                 const panel_gesture *g)
{
    const panel_id id = g->hit.panel;
    if (id == PANEL_NONE) {
        return false;
    }

    // the wheel, unless the panel takes it itself
    const panel *p = panel_of(id);
    const int wheel = pointer_wheel(g->event);
    if (wheel != 0 && p->wheel != 0) {
        view->drawn.scroll[id] += p->wheel * wheel;
        return true;
    }
    if (wheel != 0 && panel_place_of(id) == PLACE_PAGE) {
        turn_page(model, view, input, wheel);
        return true;
    }

    // all else is the panel's
    if (p->list != NULL) {
        return list_point(p->list, model, view, g);
    }
    return p->point != NULL && p->point(model, view, input, g);
}
