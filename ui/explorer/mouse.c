#include "ui/explorer/mouse.h"

#include <assert.h>

#include "ui/explorer/keys.h"
#include "ui/terminal/keys.h"

// Passes a gesture to the panel of its hit area; false if it has no effect.
static bool give(explorer *ex, const panel_gesture *g)
{
    action_result result = result_done();
    if (g->hit.panel == PANEL_NONE || panel_of(g->hit.panel)->point == NULL) {
        return false;
    }
    bool taken = panel_of(g->hit.panel)->point(&ex->state, g, &result);
    result_show(&result, &ex->state.message);
    explorer_take_picked(ex);
    return taken;
}

// Whether a page is open and a part is not of it.
static bool is_behind_page(const explorer_state *st, panel_id id)
{
    return st->page.panel != PANEL_NONE && (id == PANEL_NONE || panel_place_of(id) < PLACE_PAGE);
}

static void press(explorer *ex, pointer_event e)
{
    explorer_state *st = &ex->state;
    hit_area hit = layout_hit(&ex->layout, e.x, e.y);
    ex->grip = (pointer_grip){.holding = true, .hit = hit, .x = e.x, .y = e.y};

    // outside a page: it closes, and the drag does not apply to the panel behind it
    if (is_behind_page(st, hit.panel)) {
        ex->grip.hit = (hit_area){.panel = st->page.panel};
        st->page.panel = PANEL_NONE;
        st->scenarios.filtering = false;
        return;
    }
    e.kind = POINTER_PRESS;
    give(ex, &(panel_gesture){.event = e, .hit = hit});
}

static void drag(explorer *ex, pointer_event e)
{
    // a terminal may leave the press out
    if (!ex->grip.holding) {
        press(ex, e);
    }
    pointer_grip *grip = &ex->grip;
    panel_gesture g = {.event = e, .hit = grip->hit, .across = e.x - grip->x, .up = grip->y - e.y};
    grip->dragged |= g.across != 0 || g.up != 0;
    g.dragged = grip->dragged;
    grip->x = e.x;
    grip->y = e.y;

    // what began on nothing counts for the plot as soon as it is over the curves
    bool over_curves = area_holds(ex->layout.plot, e.x, e.y);
    if (grip->hit.panel == PANEL_NONE && ex->state.page.panel == PANEL_NONE && over_curves) {
        g.hit = (hit_area){PANEL_CURVES, PART_BODY, 0, ex->layout.plot};
    }
    give(ex, &g);
}

static void release(explorer *ex, pointer_event e)
{
    // a quick click may come without its press
    if (!ex->grip.holding) {
        press(ex, e);
    }
    give(ex, &(panel_gesture){.event = e, .hit = ex->grip.hit, .dragged = ex->grip.dragged});
    ex->grip = (pointer_grip){0};
}

static void turn_wheel(explorer *ex, pointer_event e)
{
    const explorer_state *st = &ex->state;
    hit_area hit = layout_hit(&ex->layout, e.x, e.y);
    const bool typing = st->prompt.open && hit.panel != PANEL_PALETTE;
    if (typing || is_behind_page(st, hit.panel)) {
        return;
    }

    // where no panel takes it, it presses the keys for up and down
    if (!give(ex, &(panel_gesture){.event = e, .hit = hit})) {
        explorer_key(ex, pointer_wheel(e) < 0 ? KEY_CODE_UP : KEY_CODE_DOWN);
    }
}

void explorer_point(explorer *ex, pointer_event e)
{
    assert(ex != NULL);

    // a gesture is a press, its drags and its release; what is left is the wheel
    switch (e.kind) {
    case POINTER_PRESS:
        press(ex, e);
        break;
    case POINTER_DRAG:
        drag(ex, e);
        break;
    case POINTER_RELEASE:
        release(ex, e);
        break;
    default:
        turn_wheel(ex, e);
    }
}
