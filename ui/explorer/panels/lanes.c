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
static void survey_run(const explorer_model *model, lane_survey *known)
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
        if (row->sticking != 0) {
            known->sticks = true;
        }
        if (fabs(row->command) > limit) {
            known->saturates = true;
        }
    }
}

// Whether a law is locked in a mode, from the start or by a change.
static bool has_lock(const explorer_model *model)
{
    const scenario *s = &model->session.effective;
    if (!model_has_law(model)) {
        return false;
    }
    if (strcmp(s->parameters.control.lock, "none") != 0) {
        return true;
    }
    for (int i = 0; i < s->action_count; i++) {
        const action *c = &s->actions[i];
        if (c->kind == ACTION_SET && c->parameter == PARAMETER_INDEX(control.lock)) {
            return true;
        }
    }
    return false;
}

// Whether a lane of this run has anything to show.
static bool has_lane(const explorer_model *model, const lane_survey *known, bool others,
                     lane_kind kind)
{
    switch (kind) {
    case LANE_CONTACT:
        return others; // the time axis shows it: a lane only beside those of others
    case LANE_MODE:
        return model_has_law(model);
    case LANE_CHANGES:
        return model->session.effective.action_count > 0;
    case LANE_SATURATION:
        return known->saturates;
    case LANE_LOCK:
        return has_lock(model);
    case LANE_STICKING:
        return known->sticks;
    case LANE_KINDS:
        break;
    }
    return false;
}

// The lanes of the runs that are shown, the ones that tell most first; returns how many.
static int find_lanes(const explorer_model *model, const lane_survey *known,
                      lane lanes[MOST_LANES])
{
    // contact of the other runs, to compare
    lane others[MOST_LANES];
    int other_count = 0, count = 0;
    for (int run = 1; run < model_run_count(model); run++) {
        if (model_run_name(model, run)[0] != '\0' &&
            other_count < MOST_LANES - LANE_KINDS) {
            others[other_count++] = (lane){LANE_CONTACT, run};
        }
    }

    // they go before the least informative of this run
    for (lane_kind kind = 0; kind < LANE_KINDS; kind++) {
        if (kind == LANE_STICKING) {
            memcpy(lanes + count, others, (size_t)other_count * sizeof *others);
            count += other_count;
        }
        if (has_lane(model, known, other_count > 0, kind)) {
            lanes[count++] = (lane){kind, 0};
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
    survey_run(model, known);
    int wanted = find_lanes(model, known, lanes);
    if (has_map(view)) {
        wanted++;
    }

    // what the curves leave to them
    int spare = 0;
    if (view->looks.lanes == LANES_ALL) {
        spare = height - LEAST_CURVES;
    } else if (view->looks.lanes == LANES_AUTO) {
        spare = (height - FEWEST_CURVES) / 2;
    }
    if (spare < 0) {
        return 0;
    }
    return spare < wanted ? spare : wanted;
}

// --- what is in them -------------------------------------------------------------------

// Whether the size of a signal is above a bound in any of the rows from an instant to
// another one; a few of many are sampled.
static bool any_row_above(const trace *t, double from, double to, int signal,
                          double bound)
{
    const size_t first = trace_row_at(t, from), last = trace_row_at(t, to);
    const size_t stride = (last - first) / SAMPLES + 1;
    for (size_t r = first; r <= last; r += stride) {
        if (fabs(signal_value(&t->rows[r], signal)) > bound) {
            return true;
        }
    }
    return false;
}

// The mode of the law at an instant [s], none without a law.
static lane_band mode_band(const explorer_model *model, const trace *t, double time)
{
    enum { COLOURS = 6 }; // of modes
    lane_band band = {.value = -1};
    const double mode = t->rows[trace_row_at(t, time)].controller_mode;
    if (mode >= 0) {
        band.value = (int)mode;
        band.colour = (ink)(INK_SERIES_0 + (int)mode % COLOURS);
        law_mode_name(&model->modes, mode, band.name, sizeof band.name);
    }
    return band;
}

// The mode in which the law is locked, none if that is no mode of it.
static lane_band lock_band(const explorer_model *model, double time)
{
    lane_band band = {.value = -1, .colour = INK_EVENT};
    const parameters p = session_parameters_at(&model->session, time);
    for (int i = 0; i < model->modes.count; i++) {
        if (strcmp(model->modes.names[i], p.control.lock) == 0) {
            band.value = i;
        }
    }
    snprintf(band.name, sizeof band.name, "%.*s", (int)sizeof band.name - 1,
             p.control.lock);
    return band;
}

// What a lane of a run's rows holds between two instants [s]: what is on or off is on if
// it is anywhere in between.
static lane_band band_between(const explorer_model *model, lane_kind kind, const trace *t,
                              double from, double to)
{
    int signal = SIGNAL_INDEX(contact);
    double bound = 0;
    lane_band band = {.value = -1, .colour = INK_FORCE};
    switch (kind) {
    case LANE_MODE:
        return mode_band(model, t, to);
    case LANE_LOCK:
        return lock_band(model, to);
    case LANE_STICKING:
        band.colour = INK_HUB;
        signal = SIGNAL_INDEX(sticking);
        break;
    case LANE_SATURATION:
        band.colour = INK_WARNING;
        signal = SIGNAL_INDEX(command);
        bound = session_parameters_at(&model->session, to).motor.voltage_limit;
        break;
    default:
        break;
    }
    if (any_row_above(t, from, to, signal, bound)) {
        band.value = 1;
    }
    return band;
}

// --- drawing ---------------------------------------------------------------------------

// A name in a band, as far as that is long enough to tell it.
static void name_band(screen *s, int start, int end, int y, const lane_band *band)
{
    enum { LEAST = 3 }; // cells of a name that tell it
    const int length = (int)strlen(band->name), room = end - start - 1;
    if (length > 0 && (room >= length || room >= LEAST)) {
        screen_text(s, start + 1, y, room, band->colour, band->name);
    }
}

// A cell of a band: a named one begins with a stroke, one without a name is shaded.
static void draw_band_cell(screen *s, int x, int y, const lane_band *band, bool begins)
{
    if (band->value < 0) {
        return;
    }
    uint32_t glyph = GLYPH_LINE;
    if (band->name[0] == '\0') {
        glyph = GLYPH_SHADE;
    } else if (begins) {
        glyph = GLYPH_UPRIGHT;
    }
    screen_put(s, x, y, glyph, band->colour);
}

// A lane of bands, as far as the run has been seen; of other runs, and while a value is
// adjusted, all of it.
static void draw_bands(const explorer_model *model, const explorer_view *view, screen *s,
                       area line, lane l)
{
    // what the run did, also where panes show a difference
    const trace *t = &model->session.run.trace;
    if (l.run > 0) {
        t = model_run(model, l.run).trace;
    }
    double left, right, seen = model->session.seen;
    view_window(model, view, &left, &right);
    if (model->session.has_ghost || l.run > 0) {
        seen = (double)INFINITY;
    }

    lane_band before = {.value = -1};
    int start = 0;
    for (int i = 0; i <= line.width; i++) {
        const double from = left + (right - left) * i / line.width;
        const double to = left + (right - left) * (i + 1) / line.width;
        lane_band band = {.value = -1};
        if (i < line.width && from <= seen) {
            band = band_between(model, l.kind, t, from, fmin(to, seen));
        }

        // a band ends where the next one begins
        if (band.value != before.value) {
            name_band(s, line.x + start, line.x + i, line.y, &before);
            start = i;
        }
        draw_band_cell(s, line.x + i, line.y, &band, start == i);
        before = band;
    }
}

// A change or a push in few words: a parameter goes without its group.
static void write_action(const action *c, char *text, size_t size)
{
    char value[PARAMETER_TEXT_SIZE], path[ACTION_PATH];
    if (c->kind == ACTION_PUSH) {
        snprintf(text, size, "push %g", c->value);
        return;
    }
    action_format_value(c, value, sizeof value);
    snprintf(text, size, "%s %s", strchr(action_path(c, path), '.') + 1, value);
}

// What was changed, at its instant, with as much of its text as there is room for.
static void draw_change_lane(const explorer_model *model, const explorer_view *view,
                             screen *s, area line)
{
    const scenario *scripted = &model->session.effective;
    for (int i = 0; i < scripted->action_count; i++) {
        const action *c = &scripted->actions[i];
        const int x = time_column(model, view, line, c->time);
        if (x < 0) {
            continue;
        }

        // what is still to come is hollow and dim
        uint32_t sign = GLYPH_DISC;
        ink shade = INK_EVENT;
        if (c->time > model->session.now) {
            sign = GLYPH_CIRCLE;
            shade = INK_DIM;
        }
        char text[LINE_TEXT];
        write_action(c, text, sizeof text);
        screen_put(s, x, line.y, sign, shade);
        area_text(s, area_right(line, x + 1 - line.x), shade, text);
    }
}

// The column of a line over the whole run at which an instant is.
static int map_column(const session *e, area line, double time)
{
    return (int)(time / e->effective.parameters.run.duration * line.width);
}

// The whole run in a row: the visible part, impacts, the cursor.
static void draw_run_map(const explorer_model *model, const explorer_view *view,
                         screen *s, area line)
{
    const session *e = &model->session;
    const trace *t = &e->run.trace;
    double from, to;
    view_window(model, view, &from, &to);
    const int left = map_column(e, line, from), right = map_column(e, line, to);
    for (int i = 0; i < line.width; i++) {
        if (i >= left && i <= right) {
            screen_put(s, line.x + i, line.y, GLYPH_SHADE, INK_CURSOR);
        } else {
            screen_put(s, line.x + i, line.y, GLYPH_LINE, INK_FRAME);
        }
    }

    // impacts and changes that have been seen
    for (size_t i = 0; i < t->event_count && t->events[i].time <= e->seen; i++) {
        const event *v = &t->events[i];
        const int at = map_column(e, line, v->time);
        if (v->kind == EVENT_IMPACT && at < line.width) {
            screen_put(s, line.x + at, line.y, GLYPH_TRIANGLE, INK_EVENT);
        } else if (event_is_input(v->kind) && at < line.width) {
            screen_put(s, line.x + at, line.y, GLYPH_DISC, INK_EVENT);
        }
    }

    // the cursor over them
    int now = map_column(e, line, e->now);
    if (now >= line.width) {
        now = line.width - 1;
    }
    screen_put(s, line.x + now, line.y, GLYPH_CURSOR, INK_TITLE);
}

// What a lane shows: of other runs contact, with the name of the run.
static void draw_lane_label(const explorer_model *model, screen *s, area a, lane l)
{
    if (l.run > 0) {
        const shown_run run = model_run(model, l.run);
        screen_print(s, a.x, a.y, LABEL_WIDTH, run_ink(shown_run_rank(&run)), "\u2592 %s",
                     model_run_name(model, l.run));
    } else {
        screen_text(s, a.x, a.y, LABEL_WIDTH, INK_DIM, labels[l.kind]);
    }
}

void draw_lanes(const explorer_model *model, const explorer_view *view, layout *lay,
                screen *s, area a)
{
    lane lanes[MOST_LANES];
    const int count = find_lanes(model, &lay->lanes, lanes);

    // the map first
    if (a.height > 0 && has_map(view)) {
        const area line = area_right(area_row(a, 0), LABEL_WIDTH + 1);
        screen_text(s, a.x, a.y, LABEL_WIDTH, INK_DIM, "whole run");
        draw_run_map(model, view, s, line);
        layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_MAP, 0, line});
        a = area_below(a, 1);
    }

    // then as many lanes as have a row
    const area all = area_right(a, LABEL_WIDTH + 1);
    layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_LANES, 0, all});
    for (int i = 0; i < count && i < a.height; i++) {
        draw_lane_label(model, s, area_row(a, i), lanes[i]);
        if (lanes[i].kind == LANE_CHANGES) {
            draw_change_lane(model, view, s, area_row(all, i));
        } else {
            draw_bands(model, view, s, area_row(all, i), lanes[i]);
        }
    }
}
