#include "ui/explorer/panels/page.h"

#include <assert.h>
#include <limits.h>

#include "ui/terminal/keys.h"

action_result page_key(explorer_state *st, int key)
{
    assert(st != NULL && st->page.panel != PANEL_NONE);
    int *scroll = &st->scroll[st->page.panel];
    const int lines = st->page.lines;

    // drawing keeps it within the page
    if (key == KEY_CODE_DOWN || key == 'j') {
        *scroll += 1;
    } else if (key == KEY_CODE_UP || key == 'k') {
        *scroll -= *scroll > 0;
    } else if (key == KEY_CODE_PAGE_DOWN || key == ' ') {
        *scroll += lines;
    } else if (key == KEY_CODE_PAGE_UP) {
        *scroll = *scroll > lines ? *scroll - lines : 0;
    } else if (key == KEY_CODE_END || key == 'G') {
        *scroll = INT_MAX / 2;
    } else if (key == KEY_CODE_HOME || key == 'g') {
        *scroll = 0;
    } else if (key == '/' && st->page.panel == PANEL_HELP) {
        return act_filter(st, "");
    } else if (key == KEY_CODE_ESCAPE && st->filters.text[st->page.panel][0] != '\0') {
        st->filters.text[st->page.panel][0] = '\0';
    } else {
        st->page.panel = PANEL_NONE;
    }
    return result_done();
}

bool page_point(explorer_state *st, const panel_gesture *g, action_result *result)
{
    assert(st != NULL && g != NULL && result != NULL);
    *result = result_done();
    if (g->event.kind != POINTER_WHEEL_UP && g->event.kind != POINTER_WHEEL_DOWN) {
        return false;
    }
    for (int i = 0; i < WHEEL_LINES && st->page.panel != PANEL_NONE; i++) {
        int key = pointer_wheel(g->event) < 0 ? KEY_CODE_UP : KEY_CODE_DOWN;
        *result = panel_of(st->page.panel)->key(st, key);
    }
    return true;
}
