// The whole screen of the explorer: title, panels, the page, status and prompt.
#include "ui/explorer/panels/panel.h"

#include <assert.h>
#include <stdarg.h>
#include <string.h>

#include "ui/terminal/pictures.h"

// --- the lines above and below the panels ----------------------------------------------

// How many changes there are, and how many of them are to come; "" without any.
static void write_change_count(const session *e, char text[64])
{
    int later = 0;
    text[0] = '\0';
    if (e->input_count == 0) {
        return;
    }
    for (int i = 0; i < e->input_count; i++) {
        const session_input *in = &e->inputs[i];
        if (in->kind != SESSION_INPUT_START && in->time > e->now) {
            later++;
        }
    }
    const char *noun = e->input_count == 1 ? "change" : "changes";
    snprintf(text, 64, "\u25cf %d %s", e->input_count, noun);
    if (later > 0) {
        text_add(text, 64, ", \u25cb %d later", later);
    }
}

// The scenario's title, and what was changed in it before it was opened.
static void write_title(const scenario *base, char *text, size_t size)
{
    char given[SCENARIO_CHANGES];
    text[0] = '\0';
    if (base->title != NULL) {
        text_add(text, size, "%s", base->title);
    }
    text_add(text, size, "%s", scenario_changes(base, given));
}

// The first row: the scenario's name and title, and how many changes there are.
static void draw_title(const explorer_model *model, screen *s)
{
    enum { NAME_OF_LAB = 12, LEAST_TITLE = 8 }; // cells
    const session *e = &model->session;
    char changes[64], title[LINE_TEXT + SCENARIO_CHANGES];
    write_change_count(e, changes);
    write_title(&e->base, title, sizeof title);

    // the scenario's name and the changes go before its title
    int room = s->width - 2;
    if (changes[0] != '\0') {
        room -= text_cells(changes) + 2;
    }
    int x = 1;
    if (NAME_OF_LAB + text_cells(e->base.name) <= room) {
        x += screen_text(s, x, 0, room, INK_TITLE, "impactlab  ");
    }
    x += screen_text(s, x, 0, room - x + 1, INK_TITLE, e->base.name);
    if (room - x > LEAST_TITLE && title[0] != '\0') {
        x += 2 + screen_words(s, x + 2, 0, room - x - 1, INK_TEXT, title);
    }
    screen_text(s, x + 2, 0, s->width - x - 3, INK_EVENT, changes);
}

// --- status ----------------------------------------------------------------------------

// A part of a bar.
typedef struct bar_item {
    char text[96]; // "" for none
    int x, width;  // where it was drawn, no width if nowhere [cells]
    int rank;      // 0 first: where not all items fit, those of the highest ranks go
} bar_item;

enum { BAR_ITEMS = 16 };

// A line of items at the edge of the screen.
typedef struct bar {
    bar_item items[BAR_ITEMS]; // from left to right
    int count;
} bar;

// Adds an item at the right end of a bar. An item of a low rank is kept where those of
// higher ranks have no room.
static void bar_add(bar *b, int rank, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static void bar_add(bar *b, int rank, const char *format, ...)
{
    assert(b->count < BAR_ITEMS && rank < BAR_ITEMS);
    bar_item *item = &b->items[b->count++];
    item->rank = rank;
    item->x = item->width = 0;
    va_list list;
    va_start(list, format);
    vsnprintf(item->text, sizeof item->text, format, list);
    va_end(list);
}

// Clears a row of the screen.
static void blank_row(screen *s, int y)
{
    for (int x = 0; x < s->width; x++) {
        screen_put(s, x, y, ' ', INK_TEXT);
    }
}

// Draws a bar into a row and notes where its items are: the items of the lowest ranks as
// far as `room` cells have room for them, those of ranks below `always` in any case.
static void draw_bar(screen *s, int y, int room, int always, ink colour, bar *b)
{
    // which ones, by their ranks
    bool shown[BAR_ITEMS] = {false};
    int used = 1;
    for (int rank = 0; rank < BAR_ITEMS; rank++) {
        for (int i = 0; i < b->count; i++) {
            const int length = text_cells(b->items[i].text);
            const bool wanted = b->items[i].rank == rank && length > 0;
            if (wanted && (rank < always || used + length <= room)) {
                shown[i] = true;
                used += length + 2;
            }
        }
    }

    // from left to right
    blank_row(s, y);
    int x = 1;
    for (int i = 0; i < b->count; i++) {
        if (shown[i]) {
            b->items[i].x = x;
            b->items[i].width =
                screen_text(s, x, y, s->width - x, colour, b->items[i].text);
            x += 2 + b->items[i].width;
        }
    }
}

// What the run does, or how it ended where the cursor is at its end.
static const char *state_of_run(const session *e, bool playing)
{
    const status ended = e->run.summary.status;
    if (playing) {
        return e->now < e->seen ? "replaying" : "playing";
    }
    if (ended == STATUS_OK || e->now < session_end(e)) {
        return "paused";
    }
    switch (ended) {
    case STATUS_STOPPED:
        return "stopped";
    case STATUS_NOT_ALLOWED:
        return "not allowed";
    case STATUS_CONTROLLER_FAILED:
        return "controller failed";
    default:
        return "diverged";
    }
}

// How fast it plays: as wanted, and as measured.
static void add_speed(bar *b, const playback *p)
{
    if (!p->playing) {
        bar_add(b, 4, "\u00d7%g", p->speed);
    } else if (p->slowed > 1.05) {
        bar_add(b, 4, "\u00d7%g slow motion (%.2g)", p->speed, p->measured);
    } else {
        bar_add(b, 4, "\u00d7%g (%.3g)", p->speed, p->measured);
    }
}

// By which law the arm is driven, its mode, and whether it is held in that.
static void add_law(bar *b, const explorer_model *model)
{
    const control_parameters c = model_parameters(model).control;
    const double mode = session_sample(&model->session)->controller_mode;
    const char *law = control_law_table[c.law].word;
    char name[MODE_NAME_SIZE];
    if (c.law == LAW_NONE) {
        return;
    }
    if (model->modes.count == 0) {
        bar_add(b, 2, "%.40s", law);
        return;
    }
    law_mode_name(&model->modes, mode, name, sizeof name);
    const bool held = c.lock[0] != '\0' && strcmp(c.lock, "none") != 0;
    bar_add(b, 2, "%.40s: %.40s%s", law, name, held ? ", locked" : "");
}

// The parts of the status, each with what it is worth where not all fit.
static bar status_bar(const explorer_model *model, const explorer_view *view)
{
    const session *e = &model->session;
    const sample *row = session_sample(e);
    const parameters *p = &e->effective.parameters;
    const bool playing = view->playback.playing;
    bar b = {.count = 0};

    // the run
    const char *sign = playing ? "\u25b6" : "\u2016";
    bar_add(&b, 0, "%s %-9s", sign, state_of_run(e, playing));
    if (e->computing != NULL) {
        bar_add(&b, 2, "computing %.1f of %g s (Esc stops)", session_end(e),
                p->run.duration);
    }
    if (model->reading != NULL) {
        bar_add(&b, 2, "reading data");
    }
    if (model->search != NULL) {
        char progress[PROGRESS_TEXT];
        act_write_progress(model->search, progress);
        bar_add(&b, 2, "%s", progress);
    }
    if (e->run.summary.inaccurate) {
        bar_add(&b, 1, "inaccurate");
    }

    // where the cursor is, and how it moves
    bar_add(&b, 1, "t %.5f s", e->now);
    bar_add(&b, 5, "row %zu/%zu", e->row + 1, e->run.trace.row_count);
    add_speed(&b, &view->playback);

    // the law and the arm there, and which equations are solved
    char equations[64];
    add_law(&b, model);
    parameter_format(p, PARAMETER_INDEX(arm.model), equations, sizeof equations);
    bar_add(&b, 6, "%s", equations);
    const char *contact = row->contact != 0 ? "in contact" : "free flight";
    const char *hub = row->sticking != 0 ? ", hub sticks" : "";
    bar_add(&b, 3, "%s%s", contact, hub);
    if (view->mark.set) {
        bar_add(&b, 3, "from mark %.5g s", e->now - view->mark.time);
    }
    return b;
}

// The row that says what the run does and where the cursor is.
static void draw_status(const explorer_model *model, const explorer_view *view, screen *s,
                        int y)
{
    enum { ALWAYS = 2 }; // ranks
    bar b = status_bar(model, view);
    draw_bar(s, y, s->width, ALWAYS, INK_TEXT, &b);

    // what went wrong colours the bar
    const summary *m = &model->session.run.summary;
    const bool failed = m->status != STATUS_OK || m->inaccurate;
    ink colour = INK_SELECTED;
    if (failed && !view->playback.playing) {
        colour = INK_WARNING;
    }
    screen_tint(s, 0, y, s->width, 1, colour);
}

// --- the bottom ------------------------------------------------------------------------

// The message in as many rows above `below` as it takes, a few at most; returns how many.
static int draw_message(const explorer_input *input, screen *s, int below, ink shade)
{
    enum { MOST = 3 };
    text_line lines[MOST];
    const int width = s->width - 2;
    const int count = text_wrap(input->message.text, width, lines, MOST, NULL);
    for (int i = 0; i < count; i++) {
        const int y = below - count + i;
        const bool cut = i == MOST - 1 && !input->prompt.open;
        blank_row(s, y);
        if (cut) {
            // the last row says if something is left out
            screen_words(s, 1, y, width, shade, lines[i].start);
        } else {
            screen_print(s, 1, y, width, shade, "%.*s", lines[i].bytes, lines[i].start);
        }
    }
    return count;
}

// The end of a text that has more cells than there is room for.
static const char *end_of_text(const char *text, int room)
{
    for (int over = text_cells(text) - room; over > 0; over--) {
        glyph_decode(&text);
    }
    return text;
}

// The prompt, and what was said about it; returns the rows it took.
static int draw_prompt(const explorer_input *input, screen *s)
{
    const prompt *p = &input->prompt;
    const char *said = input->message.text;
    const int y = s->height - 2, room = s->width - 2;
    blank_row(s, y);

    // where all has no room its part before the cursor is shown, which is always seen
    char text[LINE_TEXT];
    const bool whole = text_cells(p->text) < room - 5;
    snprintf(text, sizeof text, "%.*s", whole ? LINE_TEXT : p->cursor, p->text);
    const int x = screen_print(s, 0, y, room, INK_TITLE, "%s%s",
                               p->searches ? "find " : ":", end_of_text(text, room - 1));
    const int behind = whole ? text_cells(p->text + p->cursor) : 0;
    screen_put(s, x, y, ' ', behind == 0 ? INK_SELECTED : INK_TEXT);
    if (behind > 0) {
        screen_tint(s, x - behind, y, 1, 1, INK_SELECTED);
    }

    // a value that typing replaces looks selected
    if (p->replaces) {
        const int value = text_cells(p->text + p->fixed);
        screen_tint(s, x - value, y, value, 1, INK_SELECTED);
    }

    // beside it, or above where that has no room
    if (x + 4 + text_cells(said) > s->width) {
        return 1 + draw_message(input, s, y, INK_DIM);
    }
    screen_text(s, x + 3, y, s->width - x - 3, INK_DIM, said);
    return 1;
}

// The filter that is being typed.
static void draw_filter(const filters *f, screen *s)
{
    const int y = s->height - 2;
    blank_row(s, y);
    const int x =
        screen_print(s, 0, y, s->width - 2, INK_TITLE, "/%s", f->text[f->typing]);
    screen_put(s, x, y, ' ', INK_SELECTED);
    screen_text(s, x + 3, y, s->width - x - 3, INK_DIM,
                "filters by words and their parts; Enter takes, Esc shows all");
}

// The keys of a command in a few characters: the first one, or both ways of a pair as
// long as they are the lab's own; "" if it has none.
static void write_brief_keys(const key_bindings *bindings, const char *command,
                             char text[64])
{
    key_names_of(bindings, command, text, 64);
    if (strncmp(text, "Right l Left", strlen("Right l Left")) == 0) {
        snprintf(text, 64, "\u25c0 \u25b6");
    } else if (strcmp(text, "n N") == 0) {
        snprintf(text, 64, "n/N");
    } else if (strncmp(text, "+ = -", strlen("+ = -")) == 0) {
        snprintf(text, 64, "+/-");
    } else {
        text[strcspn(text, " ")] = '\0';
    }
}

// What the most wanted keys do, as many as there is room for; a click does it, too.
static void draw_hints(const explorer_view *view, layout *lay, screen *s)
{
    static const struct {
        const char *command, *does;
        int rank;
    } hints[] = {{"play", "run/pause", 0},    {"step", "step", 3},
                 {"event", "event", 4},       {"speed", "speed", 7},
                 {"edit", "change value", 5}, {"branch", "keep run", 6},
                 {"compare", "compare", 8},   {"open", "open", 9},
                 {"save", "save", 10},        {"help", "help", 1},
                 {"quit", "quit", 2}};
    enum { HINTS = sizeof hints / sizeof hints[0] };
    bar b = {.count = 0};
    int of_item[HINTS];
    for (int i = 0; i < HINTS; i++) {
        char keys[64];
        write_brief_keys(&view->keys, hints[i].command, keys);
        if (keys[0] != '\0') {
            of_item[b.count] = explorer_command_find(hints[i].command);
            bar_add(&b, hints[i].rank, "%.20s %s", keys, hints[i].does);
        }
    }
    const int y = s->height - 2;
    draw_bar(s, y, s->width - 1, 0, INK_DIM, &b);
    for (int i = 0; i < b.count; i++) {
        const area place = {b.items[i].x, y, b.items[i].width, 1};
        layout_add_hit(lay, (hit_area){PANEL_NONE, PART_HINT, of_item[i], place});
    }
}

// Draws the prompt, the message or hints in the rows above the status, which stays where
// it is, and returns how many it took.
static int draw_bottom(const explorer_view *view, const explorer_input *input,
                       layout *lay, screen *s)
{
    if (input->prompt.open) {
        return draw_prompt(input, s);
    }
    if (view->filters.typing != PANEL_NONE) {
        draw_filter(&view->filters, s);
        return 1;
    }
    if (input->message.text[0] == '\0') {
        draw_hints(view, lay, s);
        return 1;
    }

    // a long message covers some of the panels until the next key, one of blanks nothing
    const ink shade = input->message.warning ? INK_WARNING : INK_TEXT;
    const int rows = draw_message(input, s, s->height - 1, shade);
    return rows > 0 ? rows : 1;
}

// --- too small -------------------------------------------------------------------------

// That the screen is too small, in the longest text that fits.
static void draw_too_small(screen *s)
{
    // from a sentence down to a sign, of the width and height that are needed and that
    // there are
    static const char *const forms[] = {
        "The lab needs %1$d x %2$d characters, here are %3$d x %4$d. q quits.",
        "%3$d x %4$d: the lab needs %1$d x %2$d (q quits)",
        "%3$dx%4$d < %1$dx%2$d",
        "< %1$dx%2$d",
        "small",
        "<"};
    enum { FORMS = sizeof forms / sizeof forms[0], MOST_ROWS = 24 };
    char text[96];
    text_line lines[MOST_ROWS];
    const area whole = {0, 0, s->width, s->height};
    const int most = s->height < MOST_ROWS ? s->height : MOST_ROWS;
    int count = 0;
    bool split = true;

    // the first whose words all fit
    for (int i = 0; i < FORMS && split; i++) {
        snprintf(text, sizeof text, forms[i], LEAST_WIDTH, LEAST_HEIGHT, s->width,
                 s->height);
        count = text_wrap(text, s->width, lines, most, &split);
    }
    area_lines(s, whole, INK_WARNING, lines, count);
}

// --- the whole screen ------------------------------------------------------------------

// The width of the side on the right; from 120 on there is room for sliders next to the
// values.
static int side_width(int screen_width)
{
    if (screen_width >= 200) {
        return 60;
    }
    if (screen_width >= 120) {
        return 46;
    }
    if (screen_width >= 100) {
        return 40;
    }
    if (screen_width >= SIDE_WIDTH) {
        return 34;
    }
    return 0;
}

// The right side: the chosen panel, and what a touch would bring below it where there is
// room; of a sweep and of statistics there is more to show.
static void draw_side(const explorer_model *model, const explorer_view *view, layout *lay,
                      screen *s, area a)
{
    const panel_id chosen = view->side.panel;
    const bool has_much = chosen == PANEL_SWEEP || chosen == PANEL_STATISTICS;
    int rows = 0;
    if (!has_much) {
        rows = predictors_panel.rows(model, view, (screen_size){a.width, a.height});
    }
    area above = a;
    above.height -= rows;
    panel_draw(chosen, model, view, lay, s, above);
    if (rows > 0) {
        panel_draw(PANEL_PREDICTORS, model, view, lay, s, area_below(a, above.height));
    }
}

// Draws what goes across the screen into the first rows of an area, results and a lesson
// if there is one; returns what they leave.
static area draw_strips(const explorer_model *model, const explorer_view *view,
                        layout *lay, screen *s, area a)
{
    const screen_size room = {s->width, a.height};
    for (panel_id id = PANEL_NONE + 1; id < PANEL_IDS; id++) {
        if (panel_place_of(id) != PLACE_STRIP) {
            continue;
        }
        const int rows = panel_of(id)->rows(model, view, room);
        if (rows > 0) {
            panel_draw(id, model, view, lay, s, (area){0, a.y, s->width, rows});
        }
        a = area_below(a, rows);
    }
    return a;
}

// The rows of the arm where there are so many for it and the curves: a third of them, but
// neither so few that it is no arm nor so many that curves could use them; two panes and
// their axis go first.
static int rows_of_arm(int height)
{
    enum { FEW = 4, USUAL = 6, MANY = 12, CURVES = 8 };
    int rows = height / 3;
    if (rows < USUAL) {
        rows = USUAL;
    }
    if (rows > MANY) {
        rows = MANY;
    }
    if (rows > height - CURVES) {
        rows = height - CURVES;
    }
    if (rows < FEW) {
        return height < 2 * FEW ? height / 2 : FEW;
    }
    return rows;
}

// The rows that the side wants where it is beside the arm alone: the knobs, and what a
// touch would bring; 0 of panels that take all that there are.
static int rows_beside_arm(const explorer_model *model, const explorer_view *view,
                           area side)
{
    const screen_size room = {side.width, side.height};
    if (side.width == 0 || view->side.panel != PANEL_PARAMETERS) {
        return 0;
    }
    return parameters_panel.rows(model, view, room) +
           predictors_panel.rows(model, view, room);
}

// The arm with the curves below it on the left, the side panel on the right. On a tall
// screen the side ends with the arm, and the curves have the whole width.
static void draw_panels(const explorer_model *model, const explorer_view *view,
                        layout *lay, screen *s, area body)
{
    body = draw_strips(model, view, lay, s, body);
    const int side = side_width(s->width), width = s->width - side;

    int arm_height = rows_of_arm(body.height);
    const int useful = arm_rows(model, lay, (screen_size){width, arm_height});
    if (arm_height > useful) {
        arm_height = useful;
    }
    area at_side = {width, body.y, side, body.height};
    const int beside = rows_beside_arm(model, view, at_side);
    const bool wide = beside > 0 && beside <= body.height / 3;
    if (wide) {
        arm_height = at_side.height = beside;
    }
    panel_draw(PANEL_ARM, model, view, lay, s, (area){body.x, body.y, width, arm_height});

    // on a narrow screen the side takes the place of the curves
    area below = {body.x, body.y + arm_height, width, body.height - arm_height};
    if (wide) {
        below.width = s->width;
    }
    if (side == 0 && view->side.in_front) {
        draw_side(model, view, lay, s, below);
        return;
    }
    panel_draw(PANEL_CURVES, model, view, lay, s, below);
    if (side > 0) {
        draw_side(model, view, lay, s, at_side);
    }
}

bool compose_fits(screen_size size)
{
    return size.width >= LEAST_WIDTH && size.height >= LEAST_HEIGHT;
}

void compose_screen(const explorer_model *model, const explorer_view *view,
                    const explorer_input *input, layout *lay, screen *s)
{
    screen_clear(s);
    pictures_clear(s);

    // no part has a place yet
    lay->hit_count = 0;
    lay->plot = (area){0};
    lay->drawn = view->drawn;
    lay->drawn.stage = (arm_stage){0};
    if (!compose_fits((screen_size){s->width, s->height})) {
        draw_too_small(s);
        return;
    }

    // title, panels, what has opened over them, prompt, status
    const area body = {0, 1, s->width, s->height - 3};
    draw_title(model, s);
    draw_panels(model, view, lay, s, body);
    if (view->page != PANEL_NONE) {
        panel_draw(view->page, model, view, lay, s, body);
    }
    const int rows = draw_bottom(view, input, lay, s);
    draw_status(model, view, s, s->height - 1);
    if (palette_shows(&input->prompt)) {
        const area above = {0, 1, s->width, s->height - 2 - rows};
        draw_palette(model, view, &input->prompt, lay, s, above);
    }
}
