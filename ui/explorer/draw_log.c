// The panel of events and of the controller's changes of mode.
#include "ui/explorer/draw.h"

#include <string.h>

static void draw_change(lab *l, screen *s, area a, const event *v)
{
    char value[128], text[256];
    const action *c = &l->session.effective.actions[v->index];
    const char *path = parameter_table[c->parameter].path;
    action_format_value(c, value, sizeof value);
    int length = snprintf(text, sizeof text, "%s = %s", path, value);
    if (length > a.width) {
        // the parameter's own name, without its group
        snprintf(text, sizeof text, "%s %s", strchr(path, '.') + 1, value);
    }
    screen_text(s, a.x, a.y, a.width, INK_EVENT, text);
}

static void draw_entry(lab *l, screen *s, area a, const log_entry *entry)
{
    const trace *t = &l->session.run.trace;
    char name[MODE_NAME_SIZE];
    area detail = {a.x + 20, a.y, a.width - 20, 1};
    if (entry->event < 0) {
        lab_mode_name(l, entry->mode, name, sizeof name);
        screen_print(s, a.x, a.y, a.width, INK_TEXT, "%9.5f s  mode", entry->time);
        screen_text(s, a.x + 18, a.y, a.width - 18, INK_EVENT, name);
        return;
    }
    const event *v = &t->events[entry->event];
    screen_print(s, a.x, a.y, a.width, INK_TEXT, "%9.5f s  %s", v->time, event_name(v->kind));
    if (v->kind == EVENT_IMPACT || v->kind == EVENT_PUSH) {
        screen_print(s, detail.x, a.y, detail.width, INK_EVENT, "%.3g N s", v->impulse);
    } else if (v->kind == EVENT_CHANGE && v->index >= 0) {
        draw_change(l, s, detail, v);
    }
}

void draw_log(lab *l, screen *s, area a)
{
    const session *e = &l->session;
    const lab_log *log = lab_run_log(l);
    size_t seen = 0;
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, "events (n, N)");
    while (seen < log->count && log->entries[seen].time <= e->seen) {
        seen++;
    }
    // the present event in the middle, or the last ones
    int current = 0, height = a.height - 2;
    for (size_t i = 0; i < seen; i++) {
        current = log->entries[i].time <= e->now ? (int)i : current;
    }
    int still = draw_first_line(current, (int)seen, height), last = (int)seen - height;
    int first = still + l->log_scroll;
    first = first > last ? last : first;
    first = first < 0 ? 0 : first;
    l->log_scroll = first - still;
    draw_spot(l, PART_LOG, (area){a.x + 1, a.y + 1, a.width - 2, height}, first);
    for (int i = first; i < (int)seen && i < first + height; i++) {
        int y = a.y + 1 + i - first;
        draw_entry(l, s, (area){a.x + 2, y, a.width - 4, 1}, &log->entries[i]);
        if (log->entries[i].time == e->now) {
            screen_tint(s, a.x + 1, y, a.width - 2, 1, INK_SELECTED);
        }
    }
}
