// The whole screen of the explorer: title, panels, the page, status and prompt.
#include "ui/explorer/panels/panel.h"

#include <string.h>

#include "ui/terminal/pictures.h"

// --- the lines above and below the panels ----------------------------------------------

static void draw_title(const explorer_model *model, screen *s)
{
    const session *e = &model->session;
    char changes[64] = "";

    // how many changes, and those that are to come
    if (e->input_count > 0) {
        int later = 0;
        for (int i = 0; i < e->input_count; i++) {
            later +=
                e->inputs[i].kind != SESSION_INPUT_START && e->inputs[i].time > e->now;
        }
        snprintf(changes, sizeof changes, "\u25cf %d change%s", e->input_count,
                 e->input_count == 1 ? "" : "s");
        if (later > 0) {
            text_add(changes, sizeof changes, ", \u25cb %d later", later);
        }
    }

    // the name and the changes go before the title
    char title[LINE_TEXT + SCENARIO_CHANGES], given[SCENARIO_CHANGES];
    snprintf(title, sizeof title, "%s%s", e->base.title ? e->base.title : "",
             scenario_changes(&e->base, given));
    int room = s->width - 2 - (changes[0] ? text_cells(changes) + 2 : 0), x = 1;
    if (12 + text_cells(e->base.name) <= room) {
        x += screen_text(s, x, 0, room, INK_TITLE, "impactlab  ");
    }
    x += screen_text(s, x, 0, room - x + 1, INK_TITLE, e->base.name);
    if (room - x > 8 && title[0] != '\0') {
        x += 2 + screen_words(s, x + 2, 0, room - x - 1, INK_TEXT, title);
    }
    screen_text(s, x + 2, 0, s->width - x - 3, INK_EVENT, changes);
}

// --- status ----------------------------------------------------------------------------

// A part of a bar.
typedef struct bar_item {
    char text[96]; // "" for none
    int rank;      // the lower ones stay where not all fit
} bar_item;

enum { BAR_ITEMS = 16 };

static void blank_row(screen *s, int y)
{
    for (int x = 0; x < s->width; x++) {
        screen_put(s, x, y, ' ', INK_TEXT);
    }
}

// Draws a bar: the items of the lowest ranks as far as they have room, those below
// `always` in any case, in their order from left to right.
static void draw_bar(screen *s, int y, int room, int always, ink colour,
                     const bar_item *items, int count)
{
    bool shown[BAR_ITEMS] = {false};
    for (int rank = 0, used = 1; rank < BAR_ITEMS; rank++) {
        for (int i = 0; i < count; i++) {
            const int length = text_cells(items[i].text);
            if (items[i].rank == rank && length > 0 &&
                (rank < always || used + length <= room)) {
                shown[i] = true;
                used += length + 2;
            }
        }
    }
    blank_row(s, y);
    for (int i = 0, x = 1; i < count; i++) {
        if (shown[i]) {
            x += 2 + screen_text(s, x, y, s->width - x, colour, items[i].text);
        }
    }
}

// Fills the items from left to right; returns how many.
static int write_status(const explorer_model *model, const explorer_view *view,
                        bar_item items[BAR_ITEMS])
{
    const session *e = &model->session;
    const sample *row = session_sample(e);
    const parameters *p = &e->effective.parameters;
    const status ended = e->run.summary.status;
    bool failed = ended != STATUS_OK, old = e->now < e->seen;
    const char *how = "stopped";
    if (ended != STATUS_STOPPED) {
        if (ended == STATUS_NOT_ALLOWED) {
            how = "not allowed";
        } else if (ended == STATUS_CONTROLLER_FAILED) {
            how = "controller failed";
        } else {
            how = "diverged";
        }
    }
    const char *state;
    if (view->playback.playing) {
        if (old) {
            state = "replaying";
        } else {
            state = "playing";
        }
    } else if (failed && e->now >= session_end(e)) {
        state = how;
    } else {
        state = "paused";
    }
    const bool has_law = p->control.law != LAW_NONE;
    char equations[64], speed[32] = "";
    int n = 0;
    parameter_format(p, PARAMETER_INDEX(arm.model), equations, sizeof equations);
    if (view->playback.playing) {
        const bool slowed = view->playback.slowed > 1.05;
        snprintf(speed, sizeof speed, slowed ? " slow motion (%.2g)" : " (%.3g)",
                 view->playback.measured);
    }

    // each part with what it is worth where not all fit
#define ITEM(importance, ...)                                                            \
    do {                                                                                 \
        items[n].rank = importance;                                                      \
        snprintf(items[n].text, sizeof items[n].text, __VA_ARGS__);                      \
        n++;                                                                             \
    } while (0)
    ITEM(0, "%s %-9s", view->playback.playing ? "\u25b6" : "\u2016", state);
    if (e->computing != NULL) {
        ITEM(2, "computing %.1f of %g s (Esc stops)", session_end(e), p->run.duration);
    }
    if (e->run.summary.inaccurate) {
        ITEM(1, "inaccurate");
    }
    ITEM(1, "t %.5f s", e->now);
    ITEM(5, "row %zu/%zu", e->row + 1, e->run.trace.row_count);
    ITEM(3, "\u00d7%g%s", view->playback.speed, speed);
    ITEM(4, "%.40s%s%.38s", equations, has_law ? ", " : "",
         has_law ? control_law_table[p->control.law].word : "");
    ITEM(2, "%s%s", row->contact != 0 ? "in contact" : "free flight",
         row->sticking != 0 ? ", hub sticks" : "");
    if (view->mark.set) {
        ITEM(3, "from mark %.5g s", e->now - view->mark.time);
    }
#undef ITEM
    return n;
}

static void draw_status(const explorer_model *model, const explorer_view *view, screen *s,
                        int y)
{
    bar_item items[BAR_ITEMS];
    const int count = write_status(model, view, items);
    draw_bar(s, y, s->width, 2, INK_TEXT, items, count);

    // what went wrong colours the bar
    const summary *m = &model->session.run.summary;
    bool failed = m->status != STATUS_OK || m->inaccurate;
    screen_tint(s, 0, y, s->width, 1,
                failed && !view->playback.playing ? INK_WARNING : INK_SELECTED);
}

// --- the bottom ------------------------------------------------------------------------

// The message in as many rows above `below` as it takes, a few at most; returns how many.
static int draw_message(const explorer_input *input, screen *s, int below, ink shade)
{
    enum { MOST = 3 };
    text_line lines[MOST];
    const int count = text_wrap(input->message.text, s->width - 2, lines, MOST, NULL);
    for (int i = 0, y = below - count; i < count; i++, y++) {
        blank_row(s, y);
        if (i == MOST - 1 && !input->prompt.open) {
            screen_words(s, 1, y, s->width - 2, shade, lines[i].start);
        } else {
            screen_print(s, 1, y, s->width - 2, shade, "%.*s", lines[i].bytes,
                         lines[i].start);
        }
    }
    return count;
}

// The end of the prompt if it is wider than the screen, and what was said about it.
static int draw_prompt(const explorer_input *input, screen *s)
{
    const prompt *p = &input->prompt;
    const char *text = p->text, *said = input->message.text;
    int y = s->height - 1, room = s->width - 2, over = text_cells(text) - (room - 1);
    for (int i = 0; i < over; i++) {
        glyph_decode(&text);
    }
    blank_row(s, y);
    int x =
        screen_print(s, 0, y, room, INK_TITLE, "%s%s", p->searches ? "find " : ":", text);
    screen_put(s, x, y, ' ', INK_SELECTED);

    // a value that typing replaces looks selected
    if (p->replaces) {
        int value = text_cells(p->text + p->fixed);
        screen_tint(s, x - value, y, value, 1, INK_SELECTED);
    }
    if (x + 4 + text_cells(said) > s->width) {
        return 1 + draw_message(input, s, y, INK_DIM);
    }
    screen_text(s, x + 3, y, s->width - x - 3, INK_DIM, said);
    return 1;
}

// What the most wanted keys do, as many as there is room for; the last two always.
static void draw_hints(const explorer_view *view, screen *s)
{
    static const struct {
        const char *command, *does;
        int rank;
    } hints[] = {{"play", "run/pause", 0},    {"step", "step", 3},
                 {"event", "event", 4},       {"speed", "speed", 7},
                 {"edit", "change value", 5}, {"branch", "branch", 6},
                 {"compare", "compare", 8},   {"open", "open", 9},
                 {"save", "save", 10},        {"help", "help", 1},
                 {"quit", "quit", 2}};
    enum { HINTS = sizeof hints / sizeof hints[0] };
    bar_item items[HINTS];

    // the first key of each, and what it does
    for (int i = 0; i < HINTS; i++) {
        char keys[64];
        key_names_of(&view->keys, hints[i].command, keys, sizeof keys);
        // as long as the key is the explorer's own there is a shorter way to say it
        const char *brief = "\u25c0 \u25b6";
        if (strncmp(keys, "Right l Left", 12) != 0) {
            if (strcmp(keys, "n N") == 0) {
                brief = "n/N";
            } else if (strncmp(keys, "+ = -", 5) == 0) {
                brief = "+/-";
            } else {
                brief = NULL;
            }
        }
        keys[strcspn(keys, " ")] = '\0';
        items[i] = (bar_item){.rank = hints[i].rank};
        if (keys[0] != '\0') {
            snprintf(items[i].text, sizeof items[i].text, "%.20s %s",
                     brief ? brief : keys, hints[i].does);
        }
    }
    draw_bar(s, s->height - 1, s->width - 1, 0, INK_DIM, items, HINTS);
}

// Draws the prompt, the message or hints in the last rows and returns how many it took.
static int draw_bottom(const explorer_view *view, const explorer_input *input, screen *s)
{
    const int y = s->height - 1;
    int rows = 1;
    if (input->prompt.open) {
        rows = draw_prompt(input, s);
    } else if (view->filters.typing != PANEL_NONE) {
        blank_row(s, y);
        int x = screen_print(s, 0, y, s->width - 2, INK_TITLE, "/%s",
                             view->filters.text[view->filters.typing]);
        screen_put(s, x, y, ' ', INK_SELECTED);
        screen_text(s, x + 3, y, s->width - x - 3, INK_DIM,
                    "filters by words and their parts; Enter takes, Esc shows all");
    } else if (input->message.text[0] == '\0') {
        draw_hints(view, s);
    } else {
        // a long message covers some of the panels until the next key
        rows = draw_message(input, s, s->height,
                            input->message.warning ? INK_WARNING : INK_TEXT);
    }
    if (rows < 1) {
        return 1;
    }
    return rows;
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
    enum { FORMS = sizeof forms / sizeof forms[0] };
    char text[96];
    text_line lines[24];
    const int w = s->width, h = s->height;
    int count = 0;
    bool split = true;

    // the first whose words all fit
    for (int i = 0; i < FORMS && split; i++) {
        snprintf(text, sizeof text, forms[i], LEAST_WIDTH, LEAST_HEIGHT, w, h);
        count = text_wrap(text, w, lines, h < 24 ? h : 24, &split);
    }
    for (int k = 0; k < count; k++) {
        screen_print(s, 0, k, w, INK_WARNING, "%.*s", lines[k].bytes, lines[k].start);
    }
}

// --- the whole screen ------------------------------------------------------------------

// The width of the stack on the right; from 120 on there is room for sliders next to the
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

// Folds panels of the stack until the chosen one has enough of the rows, of which it has
// `left`: first those without anything to show. Returns the rows that it has then.
static int fold_stack(const explorer_model *model, layout *lay, int rows[PANEL_IDS],
                      int left)
{
    enum {
        SHORT = 14,
        ENOUGH = 8,
        LITTLE = 3
    }; // rows of all; six lines in a frame, or one
    int rows_of_all = left;
    for (int id = 0; id < PANEL_IDS; id++) {
        rows_of_all += rows[id];
    }
    const int enough = rows_of_all < SHORT ? LITTLE : ENOUGH;
    const bool log_is_empty = model->log.count == 0 || model->session.seen <= 0;
    const panel_id order[] = {log_is_empty ? PANEL_LOG : PANEL_NONE, PANEL_PREDICTORS,
                              PANEL_CONTROLLER, PANEL_LOG, PANEL_RUNS};
    for (size_t i = 0; i < sizeof order / sizeof order[0] && left < enough; i++) {
        lay->drawn.folded[order[i]] |= rows[order[i]] > 0;
        left += rows[order[i]];
        rows[order[i]] = 0;
    }
    return left;
}

// What is folded, in the lower edge of the chosen panel.
static void draw_tabs(const layout *lay, screen *s, area a)
{
    char text[96] = " Tab: ";
    const size_t none = strlen(text);
    for (int id = PANEL_NONE + 1; id < PANEL_IDS; id++) {
        if (lay->drawn.folded[id]) {
            text_add(text, sizeof text, "%s%s", strlen(text) > none ? ", " : "",
                     panel_of((panel_id)id)->name);
        }
    }
    if (strlen(text) > none && a.height > 1) {
        text_add(text, sizeof text, " ");
        screen_text(s, a.x + 1, a.y + a.height - 1, a.width - 2, INK_DIM, text);
    }
}

// The right side: the selected panel, and below it all that have room.
static void draw_stack(const explorer_model *model, const explorer_view *view,
                       layout *lay, screen *s, area a)
{
    const screen_size body = {s->width, a.height};
    int rows[PANEL_IDS] = {0}, left = a.height;

    // the rows of those below; the chosen one gets what they leave, and of some all where
    // it has more to show than they have
    const bool much =
        view->side.panel == PANEL_SWEEP || view->side.panel == PANEL_STATISTICS;
    for (int id = PANEL_NONE + 1; id < PANEL_IDS; id++) {
        const panel *p = panel_of((panel_id)id);
        if (panel_place_of((panel_id)id) == PLACE_STACK && id != (int)view->side.panel) {
            rows[id] = p->rows(model, view, body);
            lay->drawn.folded[id] = rows[id] > 0 && much &&
                                    (id == PANEL_CONTROLLER || id == PANEL_PREDICTORS);
            if (lay->drawn.folded[id]) {
                rows[id] = 0;
            }
            left -= rows[id];
        }
    }
    area at = {a.x, a.y, a.width, fold_stack(model, lay, rows, left)};
    panel_draw(view->side.panel, model, view, lay, s, at);
    draw_tabs(lay, s, at);
    for (int id = PANEL_NONE + 1; id < PANEL_IDS; id++) {
        at.y += at.height;
        at.height = rows[id];
        if (rows[id] > 0) {
            panel_draw((panel_id)id, model, view, lay, s, at);
        }
    }
}

static void draw_panels(const explorer_model *model, const explorer_view *view,
                        layout *lay, screen *s, area body)
{
    // the lesson takes its rows from all others
    const panel *strip = panel_of(PANEL_LESSON);
    const int taken = strip->rows(model, view, (screen_size){s->width, body.height});
    if (taken > 0) {
        panel_draw(PANEL_LESSON, model, view, lay, s, (area){0, body.y, s->width, taken});
        body.y += taken;
        body.height -= taken;
    }
    int right = side_width(s->width), left = s->width - right;
    int top = body.height >= 20 ? body.height * 2 / 5 : body.height / 2;
    const int arm = arm_rows(model, lay, (screen_size){left, top});
    if (top > arm) {
        top = arm;
    }
    panel_draw(PANEL_ARM, model, view, lay, s, (area){body.x, body.y, left, top});

    // on a narrow screen the side takes the place of the curves
    area below = {body.x, body.y + top, left, body.height - top};
    if (right == 0 && view->side.in_front) {
        draw_stack(model, view, lay, s, below);
    } else {
        panel_draw(PANEL_CURVES, model, view, lay, s, below);
    }
    if (right > 0) {
        draw_stack(model, view, lay, s, (area){left, body.y, right, body.height});
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
    lay->hit_count = 0;
    lay->plot = (area){0};
    lay->drawn = view->drawn;
    lay->drawn.stage = (arm_stage){0};
    memset(lay->drawn.folded, 0, sizeof lay->drawn.folded);
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
    int rows = draw_bottom(view, input, s);
    draw_status(model, view, s, s->height - 1 - rows);
    if (palette_shows(&input->prompt)) {
        const area above = {0, 1, s->width, s->height - 2 - rows};
        draw_palette(view, &input->prompt, lay, s, above);
    }
}
