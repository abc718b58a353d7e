// The page that lists the scenarios, with a filter.
#include "ui/explorer/panels/panel.h"

enum {
    PREVIEW = 6,
    TALL_SCREEN = 22
}; // rows of the preview, and of a screen that has room for it

// The first line to show. It moves only as far as it must, so that a second click meets
// what the first one selected.
static int first_line(int selected, int count, int first, int height)
{
    if (first < 0) {
        return draw_first_line(selected, count, height);
    }
    if (selected < first) {
        first = selected;
    } else if (selected >= first + height) {
        first = selected - height + 1;
    }
    if (first > count - height) {
        first = count - height;
    }
    if (first < 0) {
        return 0;
    }
    return first;
}

// A scenario's name, and as many whole words of its title as there is room for.
static void draw_scenario(const scenario_menu *menu, int index, screen *s, area a)
{
    int used = screen_text(s, a.x, a.y, a.width, INK_TEXT, menu->names[index]);
    int column = used + 2 > 30 ? used + 2 : 30, room = a.width - column;
    text_line title;
    if (room > 0 &&
        text_wrap(scenario_menu_text(menu, index).title, room, &title, 1, NULL) > 0) {
        screen_print(s, a.x + column, a.y, room, INK_DIM, "%.*s", title.bytes,
                     title.start);
    }
    if (index == menu->selected) {
        screen_tint(s, a.x - 1, a.y, a.width + 2, 1, INK_SELECTED);
    }
}

// What the selected scenario is about, below a line.
static void draw_preview(const scenario_menu *menu, screen *s, area a)
{
    text_line lines[PREVIEW];
    for (int x = 0; x < a.width; x++) {
        screen_put(s, a.x + x, a.y, 0x2500, INK_FRAME);
    }

    // as much of it as there is room for, unless the filter hides it
    int at;
    scenario_menu_lines(menu, &at);
    if (at < 0) {
        return;
    }
    const char *text = scenario_menu_text(menu, menu->selected).description;
    const int count = text_wrap(text, a.width, lines, a.height - 1, NULL);
    for (int i = 0; i < count; i++) {
        screen_print(s, a.x, a.y + 1 + i, a.width, INK_TEXT, "%.*s", lines[i].bytes,
                     lines[i].start);
    }
}

static void draw(const explorer_model *model, const explorer_view *view, layout *lay,
                 screen *s, area body)
{
    (void)model;
    const scenario_menu *menu = &view->scenarios;
    const int preview = s->height >= TALL_SCREEN ? PREVIEW : 0;
    area a = page_area(body, 96, menu->count + 4 + preview);
    int height = a.height - 4 - preview, selected;
    const int count = scenario_menu_lines(menu, &selected);
    const int first = first_line(selected, count, view->drawn.first_scenario, height);
    screen_frame(s, a.x, a.y, a.width, a.height, INK_CURSOR,
                 "scenarios (Enter opens, / filters, Esc closes)");
    screen_print(s, a.x + 2, a.y + 1, a.width - 4, INK_DIM, "/ filter: %s%s",
                 menu->filter, menu->filtering ? "_" : "");

    // the lines lie over the page, so a click meets them first
    const area lines = {a.x + 1, a.y + 3, a.width - 2, height};
    lay->drawn.first_scenario = first;
    if (height > 1) {
        lay->drawn.page_lines = height - 1;
    } else {
        lay->drawn.page_lines = 1;
    }
    layout_add_hit(lay, (hit_area){PANEL_SCENARIOS, PART_BODY, 0, a});
    layout_add_hit(lay, (hit_area){PANEL_SCENARIOS, PART_LINES, first, lines});

    // entries that pass the filter, as far as there is room
    for (int i = first; i < count && i < first + height; i++) {
        draw_scenario(menu, menu->shown[i], s,
                      (area){a.x + 2, lines.y + i - first, a.width - 4, 1});
    }
    if (preview > 0) {
        draw_preview(menu, s, (area){a.x + 2, lines.y + height, a.width - 4, preview});
    }
}

static bool open_selected(explorer_model *model, explorer_view *view,
                          explorer_input *input)
{
    const scenario_menu *menu = &view->scenarios;
    int at;
    view->page = PANEL_NONE;
    scenario_menu_lines(menu, &at);
    return at < 0 || act_open_scenario(model, view, input, menu->names[menu->selected]);
}

// Keys go to the filter until it is closed; Enter opens what is selected.
static bool filter_key(explorer_model *model, explorer_view *view, explorer_input *input,
                       int key)
{
    scenario_menu *menu = &view->scenarios;
    const bool opens = key == KEY_CODE_ENTER;
    if (opens || key == KEY_CODE_ESCAPE) {
        menu->filtering = false;
    } else if (key == KEY_CODE_UP || key == KEY_CODE_DOWN) {
        scenario_menu_move(menu, key == KEY_CODE_UP ? -1 : 1);
    } else {
        text_type(menu->filter, key);
    }
    scenario_menu_move(menu, 0);
    return !opens || open_selected(model, view, input);
}

static bool menu_key(explorer_model *model, explorer_view *view, explorer_input *input,
                     int key)
{
    scenario_menu *menu = &view->scenarios;

    // the filter takes all keys while it is typed
    if (menu->filtering) {
        return filter_key(model, view, input, key);
    }
    const bool up = key == KEY_CODE_UP || key == 'k' || key == KEY_CODE_PAGE_UP;
    const bool down = key == KEY_CODE_DOWN || key == 'j' || key == KEY_CODE_PAGE_DOWN;
    const bool page = key == KEY_CODE_PAGE_UP || key == KEY_CODE_PAGE_DOWN;
    if (up || down) {
        scenario_menu_move(menu, (page ? 10 : 1) * (up ? -1 : 1));
    } else if (key == '/') {
        menu->filtering = true;
        menu->filter[0] = '\0';
    } else if (key == KEY_CODE_ENTER) {
        return open_selected(model, view, input);
    } else if (key == KEY_CODE_ESCAPE || key == 'q' || key == 'o') {
        view->page = PANEL_NONE;
    }
    return true;
}

// The first click selects a line, another one on it opens it.
static bool point(explorer_model *model, explorer_view *view, explorer_input *input,
                  const panel_gesture *g)
{
    scenario_menu *menu = &view->scenarios;

    if (g->event.kind != POINTER_PRESS || g->hit.part != PART_LINES) {
        return false;
    }

    // in a line without a scenario nothing happens
    int selected, line = g->hit.index + g->event.y - g->hit.area.y;
    if (line < scenario_menu_lines(menu, &selected) && line == selected) {
        menu->filtering = false;
        open_selected(model, view, input);
    } else if (line < scenario_menu_lines(menu, &selected)) {
        menu->selected = menu->shown[line];
    }
    return true;
}

const panel scenarios_panel = {.name = "scenarios",
                               .draw = draw,
                               .point = point,
                               .key = menu_key};
