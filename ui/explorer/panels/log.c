// The panel of events and of the controller's changes of mode.
#include "ui/explorer/panels/panel.h"

#include <string.h>

enum { MOST_LATER = 32 }; // changes to come that are listed

static void draw_change(const explorer_model *model, screen *s, area a, const event *v)
{
    char value[128], text[384], room[ACTION_PATH];
    const action *c = &model->session.effective.actions[v->index];
    const char *path = action_path(c, room);
    action_format_value(c, value, sizeof value);

    // the parameter's own name, without its group, where the whole has no room
    if (snprintf(text, sizeof text, "%s = %s", path, value) > a.width) {
        snprintf(text, sizeof text, "%s %s", strchr(path, '.') + 1, value);
    }
    screen_text(s, a.x, a.y, a.width, INK_EVENT, text);
}

static void draw_entry(const explorer_model *model, screen *s, area a,
                       const log_entry *entry)
{
    const trace *t = &model->session.run.trace;
    char name[MODE_NAME_SIZE];
    area detail = {a.x + 20, a.y, a.width - 20, 1};

    // a change of mode
    if (entry->event < 0) {
        law_mode_name(&model->modes, entry->mode, name, sizeof name);
        screen_print(s, a.x, a.y, a.width, INK_TEXT, "%9.5f s  mode", entry->time);
        screen_text(s, a.x + 18, a.y, a.width - 18, INK_EVENT, name);
        return;
    }

    // an event with its most informative number
    const event *v = &t->events[entry->event];
    screen_print(s, a.x, a.y, a.width, INK_TEXT, "%9.5f s  %s", v->time,
                 event_name(v->kind));
    if (v->kind == EVENT_IMPACT || v->kind == EVENT_PUSH) {
        screen_print(s, detail.x, a.y, detail.width, INK_EVENT, "%.3g N s", v->impulse);
    } else if (v->kind == EVENT_CHANGE && v->index >= 0) {
        draw_change(model, s, detail, v);
    }
}

// Changes and pushes that are still to come after the first `seen` entries; returns how
// many.
static int find_later_inputs(const explorer_model *model, size_t seen,
                             int later[MOST_LATER])
{
    const run_log *log = &model->log;
    const trace *t = &model->session.run.trace;
    int count = 0;
    for (size_t i = seen; i < log->count && count < MOST_LATER; i++) {
        const int index = log->entries[i].event;
        if (index >= 0 && (t->events[index].kind == EVENT_CHANGE ||
                           t->events[index].kind == EVENT_PUSH)) {
            later[count++] = (int)i;
        }
    }
    return count;
}

static int rows(const explorer_model *model, const explorer_view *view, screen_size body)
{
    (void)model;
    (void)view;
    if (body.width >= SIDE_WIDTH && body.height >= 26) {
        return body.height / 4;
    }
    return 0;
}

static void draw(const explorer_model *model, const explorer_view *view, layout *lay,
                 screen *s, area a)
{
    const session *e = &model->session;
    const run_log *log = &model->log;
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, "events (n, N)");

    // past entries up to the cursor, and the task
    size_t seen = 0;
    int current = 0, height = a.height - 2, later[MOST_LATER];
    while (seen < log->count && log->entries[seen].time <= e->seen) {
        if (log->entries[seen].time <= e->now) {
            current = (int)seen;
        }
        seen++;
    }
    const int count = (int)seen + find_later_inputs(model, seen, later);

    // that one in the middle, or the last ones; scrolling counts from there
    const int still = draw_first_line(current, count, height), last = count - height;
    const int wanted = still + view->drawn.scroll[PANEL_LOG],
              least = wanted > last ? last : wanted;
    const int first = least < 0 ? 0 : least;
    lay->drawn.scroll[PANEL_LOG] = first - still;
    const area lines = {a.x + 1, a.y + 1, a.width - 2, height};
    layout_add_hit(lay, (hit_area){PANEL_LOG, PART_LINES, first, lines});
    for (int i = first; i < count && i < first + height; i++) {
        const log_entry *entry = &log->entries[i < (int)seen ? i : later[i - (int)seen]];
        int y = lines.y + i - first;
        draw_entry(model, s, (area){a.x + 2, y, a.width - 4, 1}, entry);
        if (entry->time > e->seen) {
            screen_tint(s, lines.x, y, lines.width, 1, INK_DIM);
        }
        if (entry->time == e->now) {
            screen_tint(s, lines.x, y, lines.width, 1, INK_SELECTED);
        }
    }
}

// A click goes to the instant of a line, the wheel scrolls.
static bool point(explorer_model *model, explorer_view *view, explorer_input *input,
                  const panel_gesture *g)
{
    (void)input;
    const run_log *log = model_run_log(model);
    const size_t index = (size_t)(g->hit.index + g->event.y - g->hit.area.y);
    const bool pressed = g->event.kind == POINTER_PRESS;
    if (pressed && index < log->count &&
        log->entries[index].time <= model->session.seen) {
        act_scrub(model, view, log->entries[index].time);
        view->drawn.scroll[PANEL_LOG] = 0;
    }
    return pressed;
}

const panel log_panel = {
    .name = "log", .rows = rows, .draw = draw, .wheel = WHEEL_LINES, .point = point};
