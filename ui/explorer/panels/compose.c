#include "ui/explorer/panels/compose.h"

#include <assert.h>

#include "ui/explorer/panels/bars.h"
#include "ui/explorer/panels/panel.h"
#include "ui/terminal/pictures.h"

// The width of the stack on the right; from 120 on there is room for sliders next to the values.
static int side_width(int screen_width)
{
    static const struct {
        int screen, side;
    } widths[] = {{200, 60}, {120, 46}, {100, 40}, {SIDE_WIDTH, 34}};
    for (size_t i = 0; i < sizeof widths / sizeof widths[0]; i++) {
        if (screen_width >= widths[i].screen) {
            return widths[i].side;
        }
    }
    return 0;
}

// Whether a panel of the stack leaves its rows to the chosen one, which has more to show than they
// have: that of a sweep or of statistics.
static bool gives_way(const explorer_state *st, panel_id id)
{
    const bool wants_room = st->side.panel == PANEL_SWEEP || st->side.panel == PANEL_STATISTICS;
    return wants_room && (id == PANEL_CONTROLLER || id == PANEL_PREDICTORS);
}

// The right side: the selected panel, and below it all that have room.
static void draw_stack(const explorer_state *st, layout *lay, screen *s, area a)
{
    const screen_size body = {s->width, a.height};
    int rows[PANEL_IDS] = {0}, taken = 0;

    // the rows of those below; the chosen one gets what they leave
    for (int id = PANEL_NONE + 1; id < PANEL_IDS; id++) {
        const panel *p = panel_of((panel_id)id);
        if (panel_place_of((panel_id)id) == PLACE_STACK && panel_fits(p, body) &&
            !gives_way(st, (panel_id)id)) {
            rows[id] = p->rows(st, body);
            taken += rows[id];
        }
    }

    area at = {a.x, a.y, a.width, a.height - taken};
    panel_of(st->side.panel)->draw(st, lay, s, at);
    for (int id = PANEL_NONE + 1; id < PANEL_IDS; id++) {
        at.y += at.height;
        at.height = rows[id];
        if (rows[id] > 0) {
            panel_of((panel_id)id)->draw(st, lay, s, at);
        }
    }
}

// The places with a single panel.
static void draw_place(const explorer_state *st, layout *lay, screen *s, panel_place place, area a)
{
    for (int id = PANEL_NONE + 1; id < PANEL_IDS; id++) {
        if (panel_place_of((panel_id)id) == place) {
            panel_of((panel_id)id)->draw(st, lay, s, a);
        }
    }
}

static void draw_panels(const explorer_state *st, layout *lay, screen *s, area body)
{
    // the lesson takes its rows from all others
    const panel *strip = panel_of(PANEL_LESSON);
    const int taken = strip->rows(st, (screen_size){s->width, body.height});
    if (taken > 0) {
        strip->draw(st, lay, s, (area){0, body.y, s->width, taken});
        body.y += taken;
        body.height -= taken;
    }
    int right = side_width(s->width), left = s->width - right;
    int top = body.height >= 20 ? body.height * 2 / 5 : body.height / 2;
    draw_place(st, lay, s, PLACE_TOP, (area){body.x, body.y, left, top});

    // on a narrow screen the side takes the place of the curves
    area below = {body.x, body.y + top, left, body.height - top};
    if (right == 0 && st->side.in_front) {
        draw_stack(st, lay, s, below);
    } else {
        draw_place(st, lay, s, PLACE_MAIN, below);
    }
    if (right > 0) {
        draw_stack(st, lay, s, (area){left, body.y, right, body.height});
    }
}

bool compose_fits(screen_size size)
{
    return size.width >= LEAST_WIDTH && size.height >= LEAST_HEIGHT;
}

void compose_screen(const explorer_state *st, layout *lay, screen *s)
{
    assert(st != NULL && lay != NULL && s != NULL);
    screen_clear(s);
    pictures_clear(s);
    layout_begin(lay, st);
    if (!compose_fits((screen_size){s->width, s->height})) {
        draw_too_small(s);
        return;
    }

    // title, panels, what has opened over them, prompt, status
    const area body = {0, 1, s->width, s->height - 3};
    draw_title(st, s);
    draw_panels(st, lay, s, body);
    if (st->page.panel != PANEL_NONE) {
        panel_of(st->page.panel)->draw(st, lay, s, body);
    }
    int rows = draw_bottom(st, s);
    draw_status(st, s, s->height - 1 - rows);
    if (palette_shows(&st->prompt)) {
        const area above = {0, 1, s->width, s->height - 2 - rows};
        panel_of(PANEL_PALETTE)->draw(st, lay, s, above);
    }
}
