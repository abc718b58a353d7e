// The lanes below the curves, on their time axis, and the map of the run above them.
#include "ui/explorer/panels/panel.h"

#include <math.h>
#include <string.h>

enum {
    MOST_LANES = 16,
    FEWEST_CURVES = 14, // rows of curves from which on lanes show by themselves
    LEAST_CURVES = 6,   // that lanes leave where they are asked for
    SAMPLES = 32        // rows of a run that a column samples
};

// In the order in which they tell most, with the labels of this run's.
typedef enum lane_kind {
    LANE_CONTACT,
    LANE_MODE,
    LANE_CHANGES,
    LANE_SATURATION,
    LANE_LOCK,
    LANE_STICKING,
    LANE_KINDS
} lane_kind;
static const char *const labels[LANE_KINDS] = {"contact",   "mode",   "changes",
                                               "saturated", "locked", "sticks"};

typedef struct lane {
    lane_kind kind;
    int run; // of those shown
} lane;

// What a lane holds at an instant: nothing, or one of a few things.
typedef struct lane_band {
    int value; // negative: nothing; the same value is one band
    ink colour;
    char name[MODE_NAME_SIZE]; // "" for a band that its lane's label names
} lane_band;

// --- which lanes there are -------------------------------------------------------------

// Examines the rows that a run has gained.
static void survey(const explorer_model *model, lane_survey *known)
{
    const trace *t = &model->session.run.trace;
    const unsigned long run = model_run_id(model);

    // a run that grew is looked at from where it ended
    if (known->run != run || known->rows > t->row_count) {
        *known = (lane_survey){.run = run};
    }
    const double limit = model->session.effective.parameters.motor.voltage_limit;
    for (; known->rows < t->row_count; known->rows++) {
        const sample *row = &t->rows[known->rows];
        known->sticks = known->sticks || row->sticking != 0;
        known->saturates = known->saturates || fabs(row->command) > limit;
    }
}

static bool has_lock(const explorer_model *model)
{
    const scenario *s = &model->session.effective;
    bool found = strcmp(s->parameters.control.lock, "none") != 0;
    for (int i = 0; i < s->action_count; i++) {
        found = found || (s->actions[i].kind == ACTION_SET &&
                          s->actions[i].parameter == PARAMETER_INDEX(control.lock));
    }
    return found && model_has_law(model);
}

// The lanes of the runs that are shown, the ones that tell most first; returns how many.
static int find_lanes(const explorer_model *model, const lane_survey *known,
                      lane lanes[MOST_LANES])
{
    int count = 0;
    bool others = false;
    const int runs = model_run_count(model);
    for (int run = 1; run < runs; run++) {
        others = others || model_run_name(model, run)[0] != '\0';
    }

    // the time axis shows this run's contact: a lane only beside those of others
    const bool there[LANE_KINDS] = {
        others,           model_has_law(model), model->session.effective.action_count > 0,
        known->saturates, has_lock(model),      known->sticks};
    for (int kind = 0; kind < LANE_KINDS; kind++) {
        // contact of the other runs, to compare, before the least informative: its place
        // is left
        for (int run = 1; kind == LANE_STICKING && run < runs; run++) {
            if (model_run_name(model, run)[0] != '\0' && count < MOST_LANES - 1) {
                lanes[count++] = (lane){LANE_CONTACT, run};
            }
        }
        if (there[kind]) {
            lanes[count++] = (lane){(lane_kind)kind, 0};
        }
    }
    return count;
}

// Whether only a part of the run is visible.
static bool has_map(const explorer_view *view)
{
    return view->window.to > view->window.from;
}

int lanes_rows(const explorer_model *model, const explorer_view *view, lane_survey *known,
               int height)
{
    lane lanes[MOST_LANES];
    survey(model, known);
    const int wanted = find_lanes(model, known, lanes) + has_map(view);
    int spare;
    if (view->looks.lanes == LANES_ALL) {
        spare = height - LEAST_CURVES;
    } else if (height > FEWEST_CURVES) {
        spare = (height - FEWEST_CURVES) / 2;
    } else {
        spare = 0;
    }
    int rows = 0;
    if (view->looks.lanes != LANES_OFF) {
        if (spare < wanted) {
            rows = spare;
        } else {
            rows = wanted;
        }
    }
    if (rows < 0) {
        return 0;
    }
    return rows;
}

// --- what is in them -------------------------------------------------------------------

// Whether any of the rows from an instant to another one is in contact, sticks, and so
// on; a few of many are sampled.
static bool any_row(const trace *t, double from, double to, int signal, double above)
{
    const size_t first = trace_row_at(t, from), last = trace_row_at(t, to);
    const size_t stride = (last - first) / SAMPLES + 1;
    bool found = false;
    for (size_t r = first; r <= last && !found; r += stride) {
        found = fabs(signal_value(&t->rows[r], signal)) > above;
    }
    return found;
}

// What a lane of some rows holds between two instants [s].
static lane_band band_between(const explorer_model *model, lane l, const trace *t,
                              double from, double to)
{
    enum { COLOURS = 6 }; // of modes
    static const ink colours[LANE_KINDS] = {[LANE_CONTACT] = INK_FORCE,
                                            [LANE_SATURATION] = INK_WARNING,
                                            [LANE_LOCK] = INK_EVENT,
                                            [LANE_STICKING] = INK_HUB};
    lane_band band = {-1, colours[l.kind], ""};

    // one value for each name
    if (l.kind == LANE_MODE) {
        const double mode = t->rows[trace_row_at(t, to)].controller_mode;
        if (mode >= 0) {
            band.value = (int)mode;
            band.colour = (ink)(INK_SERIES_0 + (int)mode % COLOURS);
            law_mode_name(&model->modes, mode, band.name, sizeof band.name);
        }
    } else if (l.kind == LANE_LOCK) {
        const parameters p = session_parameters_at(&model->session, to);
        for (int i = 0; i < model->modes.count; i++) {
            if (strcmp(model->modes.names[i], p.control.lock) == 0) {
                band.value = i;
            }
        }
        snprintf(band.name, sizeof band.name, "%.*s", (int)sizeof band.name - 1,
                 p.control.lock);
    } else {
        // on or off, if anything in between is on
        int signal;
        if (l.kind == LANE_CONTACT) {
            signal = SIGNAL_INDEX(contact);
        } else if (l.kind == LANE_STICKING) {
            signal = SIGNAL_INDEX(sticking);
        } else {
            signal = SIGNAL_INDEX(command);
        }
        const double above =
            l.kind == LANE_SATURATION
                ? session_parameters_at(&model->session, to).motor.voltage_limit
                : 0;
        if (any_row(t, from, to, signal, above)) {
            band.value = 1;
        } else {
            band.value = -1;
        }
    }
    return band;
}

// --- drawing ---------------------------------------------------------------------------

// A name in a band, as far as that is long enough to tell it.
static void name_band(screen *s, int start, int end, int y, const lane_band *band)
{
    const int length = (int)strlen(band->name), room = end - start - 1;
    if (length > 0 && room >= (length < 3 ? length : 3)) {
        screen_text(s, start + 1, y, room, band->colour, band->name);
    }
}

// A lane of bands, as far as the run has been seen.
static void draw_bands(const explorer_model *model, const explorer_view *view, screen *s,
                       area line, lane l)
{
    // what the run did, also where panes show a difference
    const trace *t =
        l.run == 0 ? &model->session.run.trace : model_run(model, l.run).trace;
    const bool future = model->session.has_ghost || l.run > 0;
    lane_band before = {.value = -1};
    double left, right;
    int start = 0;
    view_window(model, view, &left, &right);
    for (int i = 0; i <= line.width; i++) {
        const double from = left + (right - left) * i / line.width;
        const double to = left + (right - left) * (i + 1) / line.width;
        const bool known = i < line.width && (future || from <= model->session.seen);
        lane_band band;
        if (known) {
            band = band_between(model, l, t, from,
                                future ? to : fmin(to, model->session.seen));
        } else {
            band = (lane_band){.value = -1};
        }

        // a band ends where the next one begins
        if (band.value != before.value) {
            name_band(s, line.x + start, line.x + i, line.y, &before);
            start = i;
        }
        const bool begins = band.name[0] != '\0' && start == i;
        if (band.value >= 0) {
            const uint32_t fill = band.name[0] == '\0' ? 0x2592 : 0x2500;
            screen_put(s, line.x + i, line.y, begins ? 0x2502 : fill, band.colour);
        }
        before = band;
    }
}

// What was changed, at its instant, with as much of its text as there is room for.
static void draw_changes(const explorer_model *model, const explorer_view *view,
                         screen *s, area line)
{
    const scenario *scripted = &model->session.effective;
    for (int i = 0; i < scripted->action_count; i++) {
        const action *c = &scripted->actions[i];
        const int at = time_column(model, view, line, c->time);
        char text[LINE_TEXT], value[PARAMETER_TEXT_SIZE];
        if (at < 0) {
            continue;
        }

        // as short as it may be: a parameter goes without its group
        const bool seen = c->time <= model->session.now;
        if (c->kind == ACTION_PUSH) {
            snprintf(text, sizeof text, "push %g", c->value);
        } else {
            action_format_value(c, value, sizeof value);
            char path[ACTION_PATH];
            snprintf(text, sizeof text, "%s %s", strchr(action_path(c, path), '.') + 1,
                     value);
        }

        // what is still to come is hollow and dim
        const ink colour = seen ? INK_EVENT : INK_DIM;
        screen_put(s, at, line.y, seen ? 0x25cf : 0x25cb, colour);
        screen_text(s, at + 1, line.y, line.x + line.width - at - 1, colour, text);
    }
}

// The whole run in a row: the visible part, impacts, the cursor.
static void draw_map(const explorer_model *model, const explorer_view *view, layout *lay,
                     screen *s, area a, area line)
{
    const session *e = &model->session;
    const trace *t = &e->run.trace;
    const double whole = e->effective.parameters.run.duration;
    double from, to;
    view_window(model, view, &from, &to);
    const int left = (int)(from / whole * line.width),
              right = (int)(to / whole * line.width);
    screen_text(s, a.x, a.y, LABEL_WIDTH, INK_DIM, "whole run");
    for (int i = 0; i < line.width; i++) {
        const bool visible = i >= left && i <= right;
        screen_put(s, line.x + i, line.y, visible ? 0x2592 : 0x2500,
                   visible ? INK_CURSOR : INK_FRAME);
    }

    // impacts and changes that have been seen, the cursor over them
    for (size_t i = 0; i < t->event_count && t->events[i].time <= e->seen; i++) {
        const event *v = &t->events[i];
        const int at = (int)(v->time / whole * line.width);
        const bool impact = v->kind == EVENT_IMPACT;
        const bool change = v->kind == EVENT_CHANGE || v->kind == EVENT_PUSH;
        if ((impact || change) && at < line.width) {
            screen_put(s, line.x + at, line.y, impact ? 0x25b2 : 0x25cf, INK_EVENT);
        }
    }
    const int now = (int)(e->now / whole * line.width);
    screen_put(s, line.x + (now < line.width ? now : line.width - 1), line.y, 0x2506,
               INK_TITLE);
    layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_MAP, 0, line});
}

void draw_lanes(const explorer_model *model, const explorer_view *view, layout *lay,
                screen *s, area a)
{
    lane lanes[MOST_LANES];
    const int count = find_lanes(model, &lay->lanes, lanes);
    area line = {a.x + LABEL_WIDTH + 1, a.y, a.width - LABEL_WIDTH - 1, 1};
    int left = a.height;

    // the map first, then as many lanes as have a row
    if (left > 0 && has_map(view)) {
        draw_map(model, view, lay, s, a, line);
        left--;
        a.y++;
        line.y++;
    }
    const area all = {line.x, line.y, line.width, left};
    layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_LANES, 0, all});
    for (int i = 0; i < count && left > 0; i++, left--, a.y++, line.y++) {
        const bool other = lanes[i].run > 0;
        screen_print(s, a.x, a.y, LABEL_WIDTH, INK_DIM, other ? "\u2592 %s" : "%s",
                     other ? model_run_name(model, lanes[i].run) : labels[lanes[i].kind]);
        if (lanes[i].kind == LANE_CHANGES) {
            draw_changes(model, view, s, line);
        } else {
            draw_bands(model, view, s, line, lanes[i]);
        }
    }
}
