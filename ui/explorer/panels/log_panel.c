// The panel of events and of the controller's changes of mode.
#include "ui/explorer/panels/panel.h"

#include <string.h>

enum { MOST_LATER = 32 }; // changes to come that are listed

// What a change of the script sets, as a path and a value.
static void draw_changed_value(const explorer_model *model, screen *s, area a,
                               const event *v)
{
    char value[128], text[384], room[ACTION_PATH];
    const action *c = &model->session.effective.actions[v->index];
    const char *path = action_path(c, room);
    action_format_value(c, value, sizeof value);

    // the parameter's own name, without its group, where the whole has no room
    const int length = snprintf(text, sizeof text, "%s = %s", path, value);
    if (length > a.width) {
        snprintf(text, sizeof text, "%s %s", strchr(path, '.') + 1, value);
    }
    area_text(s, a, INK_EVENT, text);
}

// An entry of the log in a line.
static void draw_log_entry(const explorer_model *model, screen *s, area a,
                           const log_entry *entry)
{
    enum { MODE_AT = 18, DETAIL_AT = 20 }; // columns

    // a change of mode
    if (entry->event < 0) {
        char name[MODE_NAME_SIZE];
        law_mode_name(&model->modes, entry->mode, name, sizeof name);
        area_print(s, a, INK_TEXT, "%9.5f s  mode", entry->time);
        area_text(s, area_right(a, MODE_AT), INK_EVENT, name);
        return;
    }

    // an event with its most informative number
    const event *v = &model->session.run.trace.events[entry->event];
    const area detail = area_right(a, DETAIL_AT);
    area_print(s, a, INK_TEXT, "%9.5f s  %s", v->time, event_name(v->kind));
    if (v->kind == EVENT_IMPACT || v->kind == EVENT_PUSH) {
        area_print(s, detail, INK_EVENT, "%.3g N s", v->impulse);
    } else if (v->kind == EVENT_CHANGE && v->index >= 0) {
        draw_changed_value(model, s, detail, v);
    }
}

// What the panel lists: all that has been seen, then changes and pushes that are still to
// come.
typedef struct listed_entries {
    size_t seen;
    int later[MOST_LATER];
    int count;   // of all
    int current; // the last one up to the cursor
} listed_entries;

// Whether an entry is a change or a push.
static bool is_input(const explorer_model *model, const log_entry *entry)
{
    return entry->event >= 0 &&
           event_is_input(model->session.run.trace.events[entry->event].kind);
}

// Finds what is listed where the cursor is.
static listed_entries list_entries(const explorer_model *model)
{
    const session *e = &model->session;
    const run_log *log = &model->log;
    listed_entries listed = {.seen = 0};
    while (listed.seen < log->count && log->entries[listed.seen].time <= e->seen) {
        if (log->entries[listed.seen].time <= e->now) {
            listed.current = (int)listed.seen;
        }
        listed.seen++;
    }

    int later_count = 0;
    for (size_t i = listed.seen; i < log->count && later_count < MOST_LATER; i++) {
        if (is_input(model, &log->entries[i])) {
            listed.later[later_count++] = (int)i;
        }
    }
    listed.count = (int)listed.seen + later_count;
    return listed;
}

// The entry of the log that is listed in a line.
static const log_entry *listed_entry(const run_log *log, const listed_entries *listed,
                                     int index)
{
    if (index < (int)listed->seen) {
        return &log->entries[index];
    }
    return &log->entries[listed->later[index - (int)listed->seen]];
}

// A quarter of a tall screen, nothing of others.
static int log_rows(const explorer_model *model, const explorer_view *view,
                    screen_size body)
{
    (void)model;
    (void)view;
    if (body.width >= SIDE_WIDTH && body.height >= 26) {
        return body.height / 4;
    }
    return 0;
}

// The lines round the cursor, or those to which the panel is scrolled.
static void draw_log(const explorer_model *model, const explorer_view *view, layout *lay,
                     screen *s, area a)
{
    const session *e = &model->session;
    const listed_entries listed = list_entries(model);
    const area lines = {a.x + 1, a.y + 1, a.width - 2, a.height - 2};
    area_frame(s, a, INK_FRAME, "events (n, N)");

    // the current one in the middle, or the last ones; scrolling counts from there
    const int unscrolled = draw_first_line(listed.current, listed.count, lines.height);
    int first = unscrolled + view->drawn.scroll[PANEL_LOG];
    if (first > listed.count - lines.height) {
        first = listed.count - lines.height;
    }
    if (first < 0) {
        first = 0;
    }
    lay->drawn.scroll[PANEL_LOG] = first - unscrolled;
    layout_add_hit(lay, (hit_area){PANEL_LOG, PART_LINES, first, lines});

    // what is to come dim, what is at the cursor selected
    for (int i = first; i < listed.count && i < first + lines.height; i++) {
        const log_entry *entry = listed_entry(&model->log, &listed, i);
        const area line = area_row(lines, i - first);
        draw_log_entry(model, s, (area){line.x + 1, line.y, line.width - 2, 1}, entry);
        if (entry->time > e->seen) {
            area_tint(s, line, INK_DIM);
        }
        if (entry->time == e->now) {
            area_tint(s, line, INK_SELECTED);
        }
    }
}

// A click goes to the instant of a line, the wheel scrolls.
static bool point_at_log(explorer_model *model, explorer_view *view,
                         explorer_input *input, const panel_gesture *g)
{
    (void)input;
    if (g->event.kind != POINTER_PRESS) {
        return false;
    }
    const run_log *log = model_run_log(model);
    const size_t index = (size_t)gesture_line(g);
    if (index < log->count && log->entries[index].time <= model->session.seen) {
        act_scrub(model, view, log->entries[index].time);
        view->drawn.scroll[PANEL_LOG] = 0;
    }
    return true;
}

const panel log_panel = {.name = "log",
                         .rows = log_rows,
                         .draw = draw_log,
                         .wheel = WHEEL_LINES,
                         .point = point_at_log};
