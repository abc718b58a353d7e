// The page that lists the scenarios, with a filter.
#include "ui/explorer/panels/panel.h"

// Rows of the preview, and of a screen that has room for it.
enum { PREVIEW = 6, TALL_SCREEN = 22 };

// Rows over the lines: frame, filter, a blank one; and all that are no lines.
enum { HEAD = 3, EDGES = 4 };

// The first line to show. It moves only as far as it must from the one that was the first
// (-1: none yet), so that a second click meets what the first one selected.
static int first_shown_scenario(int selected, int count, int first, int height)
{
    if (first < 0) {
        return draw_first_line(selected, count, height);
    }
    if (selected < first) {
        first = selected;
    } else if (selected >= first + height) {
        first = selected - height + 1;
    }

    // no empty lines at the end
    if (first > count - height) {
        first = count - height;
    }
    return first > 0 ? first : 0;
}

// A scenario's name, and as many whole words of its title as there is room for.
static void draw_scenario(const scenario_menu *menu, int index, screen *s, area a)
{
    enum { TITLE_AT = 30 }; // column, where the name is not longer
    int title_at = 2 + area_text(s, a, INK_TEXT, menu->names[index]);
    if (title_at < TITLE_AT) {
        title_at = TITLE_AT;
    }
    const area room = area_right(a, title_at);
    if (room.width > 0) {
        text_line words;
        const char *title = scenario_menu_text(menu, index).title;
        const int count = text_wrap(title, room.width, &words, 1, NULL);
        area_lines(s, room, INK_DIM, &words, count);
    }
    if (index == menu->selected) {
        area_tint(s, (area){a.x - 1, a.y, a.width + 2, 1}, INK_SELECTED);
    }
}

// What the selected scenario is about, below a line.
static void draw_preview(const scenario_menu *menu, screen *s, area a)
{
    for (int x = 0; x < a.width; x++) {
        screen_put(s, a.x + x, a.y, GLYPH_LINE, INK_FRAME);
    }

    // nothing where the filter hides it
    int selected;
    scenario_menu_lines(menu, &selected);
    if (selected < 0) {
        return;
    }

    // as much of it as there is room for
    text_line lines[PREVIEW];
    const area room = area_below(a, 1);
    const char *text = scenario_menu_text(menu, menu->selected).description;
    const int count = text_wrap(text, a.width, lines, room.height, NULL);
    area_lines(s, room, INK_TEXT, lines, count);
}

// The page: the filter, the scenarios that pass it, and what the selected one is about.
static void draw_scenarios(const explorer_model *model, const explorer_view *view,
                           layout *lay, screen *s, area body)
{
    (void)model;
    const scenario_menu *menu = &view->scenarios;
    const int preview = s->height >= TALL_SCREEN ? PREVIEW : 0;
    const area a = page_area(body, 96, menu->count + EDGES + preview);
    const area inside = area_inside(a);
    area_frame(s, a, INK_CURSOR, "scenarios (Enter opens, / filters, Esc closes)");
    const char *cursor = menu->filtering ? "_" : "";
    area_print(s, inside, INK_DIM, "/ filter: %s%s", menu->filter, cursor);

    // where the lines are; they lie over the page, so a click meets them first
    int selected;
    const int height = a.height - EDGES - preview;
    const area lines = {a.x + 1, a.y + HEAD, a.width - 2, height};
    const int count = scenario_menu_lines(menu, &selected);
    const int first =
        first_shown_scenario(selected, count, view->drawn.first_scenario, height);
    lay->drawn.first_scenario = first;
    lay->drawn.page_lines = height > 1 ? height - 1 : 1;
    layout_add_hit(lay, (hit_area){PANEL_SCENARIOS, PART_BODY, 0, a});
    layout_add_hit(lay, (hit_area){PANEL_SCENARIOS, PART_LINES, first, lines});

    // entries that pass the filter, as far as there is room
    for (int i = first; i < count && i < first + height; i++) {
        const area line = {inside.x, lines.y + i - first, inside.width, 1};
        draw_scenario(menu, menu->shown[i], s, line);
    }
    if (preview > 0) {
        draw_preview(menu, s, (area){inside.x, lines.y + height, inside.width, preview});
    }
}

// Opens the selected scenario, unless the filter hides it, and closes the page.
static bool open_selected_scenario(explorer_model *model, explorer_view *view,
                                   explorer_input *input)
{
    const scenario_menu *menu = &view->scenarios;
    int selected;
    view->page = PANEL_NONE;
    scenario_menu_lines(menu, &selected);
    if (selected < 0) {
        return true;
    }
    return act_open_scenario(model, view, input, menu->names[menu->selected]);
}

// Keys go to the filter until it is closed; Enter opens what is selected.
static bool press_filter_key(explorer_model *model, explorer_view *view,
                             explorer_input *input, int key)
{
    scenario_menu *menu = &view->scenarios;
    switch (key) {
    case KEY_CODE_ENTER:
    case KEY_CODE_ESCAPE:
        menu->filtering = false;
        break;
    case KEY_CODE_UP:
        scenario_menu_move(menu, -1);
        break;
    case KEY_CODE_DOWN:
        scenario_menu_move(menu, 1);
        break;
    default:
        text_type(menu->filter, key);
        break;
    }

    // the selection goes to what the filter lets through
    scenario_menu_move(menu, 0);
    if (key == KEY_CODE_ENTER) {
        return open_selected_scenario(model, view, input);
    }
    return true;
}

// Moves the selection, opens what is selected, begins a filter or closes the page.
static bool press_scenarios_key(explorer_model *model, explorer_view *view,
                                explorer_input *input, int key)
{
    enum { PAGE = 10 }; // lines
    scenario_menu *menu = &view->scenarios;

    // the filter takes all keys while it is typed
    if (menu->filtering) {
        return press_filter_key(model, view, input, key);
    }
    switch (key) {
    case KEY_CODE_UP:
    case 'k':
        scenario_menu_move(menu, -1);
        break;
    case KEY_CODE_DOWN:
    case 'j':
        scenario_menu_move(menu, 1);
        break;
    case KEY_CODE_PAGE_UP:
        scenario_menu_move(menu, -PAGE);
        break;
    case KEY_CODE_PAGE_DOWN:
        scenario_menu_move(menu, PAGE);
        break;
    case '/':
        menu->filtering = true;
        menu->filter[0] = '\0';
        break;
    case KEY_CODE_ENTER:
        return open_selected_scenario(model, view, input);
    case KEY_CODE_ESCAPE:
    case 'q':
    case 'o':
        view->page = PANEL_NONE;
        break;
    }
    return true;
}

// The first click selects a line, another one on it opens it.
static bool point_at_scenarios(explorer_model *model, explorer_view *view,
                               explorer_input *input, const panel_gesture *g)
{
    scenario_menu *menu = &view->scenarios;
    if (g->event.kind != POINTER_PRESS || g->hit.part != PART_LINES) {
        return false;
    }

    // in a line without a scenario nothing happens
    int selected;
    const int line = gesture_line(g), count = scenario_menu_lines(menu, &selected);
    if (line >= count) {
        return true;
    }
    if (line == selected) {
        menu->filtering = false;
        open_selected_scenario(model, view, input);
    } else {
        menu->selected = menu->shown[line];
    }
    return true;
}

const panel scenarios_panel = {.name = "scenarios",
                               .draw = draw_scenarios,
                               .point = point_at_scenarios,
                               .key = press_scenarios_key};
