// The panels on the right: parameters, values, predictors, events.
#include "ui/lab/draw.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/predict/linearised.h"
#include "src/predict/predict.h"

void draw_parameters(lab *l, screen *s, area a)
{
    parameters p = session_parameters_at(&l->session, l->session.now);
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, "parameters (Tab: values)");
    int count = 0, selected = 0, line = 0, height = a.height - 2;
    for (int i = 0; i < parameter_count; i++) {
        selected = i == l->parameter ? count : selected;
        count += lab_applies(l, i);
    }
    int first = draw_first_line(selected, count, height);
    for (int i = 0; i < parameter_count; i++) {
        if (!lab_applies(l, i)) {
            continue;
        }
        int y = a.y + 1 + line++ - first;
        if (y <= a.y || y >= a.y + a.height - 1) {
            continue;
        }
        const parameter_info *info = &parameter_table[i];
        char value[160], shown[200];
        if (info->type == PARAMETER_REAL) {
            snprintf(value, sizeof value, "%.6g", parameter_get(&p, i));
        } else {
            parameter_format(&p, i, value, sizeof value);
        }
        snprintf(shown, sizeof shown, "%.12s %s", value, info->unit);
        int room = a.width - 4, start = room - (int)strlen(shown);
        bool given = l->session.effective.parameters.set[i] != 0;
        screen_text(s, a.x + 2, y, room, given ? INK_TITLE : INK_TEXT, info->path);
        screen_text(s, a.x + 2 + (start < 18 ? 18 : start), y, start < 18 ? room - 18 : room,
                    info->timed ? INK_ARM : INK_DIM, shown);
        if (i == l->parameter) {
            screen_tint(s, a.x + 1, y, a.width - 2, 1, INK_SELECTED);
        }
    }
}

// Signals of sensors that are not fitted have none.
static bool has_value(const sample *row, int signal)
{
    return !signal_table[signal].optional || !isnan(signal_value(row, signal));
}

void draw_values(lab *l, screen *s, area a)
{
    const session *e = &l->session;
    const sample *row = session_sample(e), *beside = NULL;
    const char *against = "";
    if (l->has_mark) {
        beside = &e->run.trace.rows[trace_row_at(&e->run.trace, l->mark)];
        against = ", minus mark";
    } else if (e->has_other) {
        beside = &e->other.trace.rows[trace_row_at(&e->other.trace, e->now)];
        against = ", minus old run";
    }
    char title[64];
    snprintf(title, sizeof title, "values%s", against);
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, title);
    int height = a.height - 2, shown = 0, line = 0;
    for (int i = 0; i < signal_count; i++) {
        shown += has_value(row, i);
    }
    int last = shown > height ? shown - height : 0;
    l->value_scroll = l->value_scroll > last ? last : l->value_scroll < 0 ? 0 : l->value_scroll;
    draw_spot(l, PART_VALUES, a, 0);
    for (int i = 0; i < signal_count && line < l->value_scroll + height; i++) {
        if (!has_value(row, i) || line++ < l->value_scroll) {
            continue;
        }
        double value = signal_value(row, i), other = beside ? signal_value(beside, i) : 0;
        double difference = value - other, size = fmax(fabs(value), fabs(other));
        bool differs = beside != NULL && fabs(difference) > 1e-6 * size;
        char text[32];
        int y = a.y + line - l->value_scroll;
        screen_text(s, a.x + 2, y, 16, INK_TEXT, signal_table[i].name);
        draw_number(text, sizeof text, value);
        screen_print(s, a.x + 18, y, a.width - 20, INK_TITLE, "%9s", text);
        if (beside != NULL) {
            draw_number(text, sizeof text, difference);
            screen_print(s, a.x + 28, y, a.width - 30, differs ? INK_WARNING : INK_DIM, "%9s",
                         text);
        } else {
            screen_text(s, a.x + 28, y, a.width - 30, INK_DIM, signal_table[i].unit);
        }
    }
}

// The linearised arm's answer for the state in a row; false where it has none.
static bool ask_linearised(const parameters *p, const trace *t, size_t r, prediction *out)
{
    const sample *row = &t->rows[r];
    if (p->arm.model == ARM_PRINTED || t->angle_count > 3 || p->arm.links > 2) {
        return false;
    }
    arm a;
    arm_init(&a, p);
    motion *work = motion_create(&a, &p->method);
    if (work == NULL) {
        return false;
    }
    double w[3] = {row->hub_velocity, row->first_velocity, row->last_velocity};
    if (t->angle_count < 3) {
        w[0] = row->first_velocity;
        w[1] = row->last_velocity;
    }
    status code = predict_linearised(&a, work, t->angles + r * (size_t)t->angle_count, w, out);
    motion_destroy(work);
    return code == STATUS_OK;
}

// The row whose touch is asked about: the present one in free flight, else the last free one.
static size_t free_row(const session *s)
{
    const trace *t = &s->run.trace;
    size_t r = s->row;
    if (t->rows[r].contact != 0) {
        for (size_t i = 0; i < t->event_count && t->events[i].time <= s->now; i++) {
            bool touches = t->events[i].kind == EVENT_IMPACT || t->events[i].kind == EVENT_CONTACT;
            r = touches ? trace_row_at(t, t->events[i].time) : r;
        }
        while (r > 0 && t->rows[r].contact != 0) {
            r--;
        }
    }
    return r;
}

// The largest force of the contact that begins after a row, as far as it has been seen.
static prediction what_came(const session *s, size_t r)
{
    const trace *t = &s->run.trace;
    prediction came = {.holds = true, .force = 0, .delay = 0};
    double start = t->rows[r].time;
    for (r++; r < t->row_count && t->rows[r].contact != 0 && t->rows[r].time <= s->seen; r++) {
        if (t->rows[r].force > came.force) {
            came.force = t->rows[r].force;
            came.delay = t->rows[r].time - start;
        }
    }
    return came;
}

static void predictor_line(screen *s, area a, int line, const char *label, const prediction *p,
                           bool known)
{
    int y = a.y + 1 + line;
    if (y >= a.y + a.height - 1) {
        return;
    }
    screen_text(s, a.x + 2, y, a.width - 4, INK_TEXT, label);
    if (!known) {
        screen_text(s, a.x + 18, y, a.width - 20, INK_DIM, "-");
    } else if (!p->holds) {
        screen_text(s, a.x + 18, y, a.width - 20, INK_DIM, "would not hold");
    } else if (isfinite(p->delay) && a.width < 36) {
        screen_print(s, a.x + 18, y, a.width - 20, INK_FORCE, "%.2f N, %.0f ms", p->force,
                     1e3 * p->delay);
    } else if (isfinite(p->delay)) {
        screen_print(s, a.x + 18, y, a.width - 20, INK_FORCE, "%.3f N in %.0f ms", p->force,
                     1e3 * p->delay);
    } else {
        screen_print(s, a.x + 18, y, a.width - 20, INK_FORCE, "%.3f N", p->force);
    }
}

void draw_predictors(lab *l, screen *s, area a)
{
    const session *e = &l->session;
    size_t r = free_row(e);
    const sample *row = &e->run.trace.rows[r];
    bool touches = session_sample(e)->contact != 0;
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME,
                 touches ? "when it touched: peak" : "if it touched now: peak");
    parameters p = session_parameters_at(e, row->time);
    three_body_state state = {{row->hub_angle, row->first_angle, row->last_angle},
                              {row->hub_velocity, row->first_velocity, row->last_velocity}};
    prediction out = {0};
    fault ignored;
    bool known = predict_energy(&p, &state, &out, &ignored) == STATUS_OK;
    predictor_line(s, a, 0, "energy", &out, known);
    known = predict_impact_dynamics(&p, &state, &out, &ignored) == STATUS_OK;
    predictor_line(s, a, 1, "impact dynamics", &out, known);
    known = ask_linearised(&p, &e->run.trace, r, &out);
    predictor_line(s, a, 2, "linearised", &out, known);
    if (touches) {
        out = what_came(e, r);
        predictor_line(s, a, 3, "what came", &out, true);
    } else {
        const summary *m = &e->run.summary;
        out = (prediction){
            .holds = true, .force = m->first_pulse_peak_N, .delay = m->first_pulse_time_to_peak_s};
        bool seen = e->seen >= m->first_contact_s + m->first_pulse_time_to_peak_s;
        predictor_line(s, a, 3, "first pulse", &out, seen);
    }
}

void draw_log(lab *l, screen *s, area a)
{
    const session *e = &l->session;
    const trace *t = &e->run.trace;
    size_t seen = 0;
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, "events (n, N)");
    while (seen < t->event_count && t->events[seen].time <= e->seen) {
        seen++;
    }
    // the present event in the middle, or the last ones
    int current = 0, height = a.height - 2;
    for (size_t i = 0; i < seen; i++) {
        current = t->events[i].time <= e->now ? (int)i : current;
    }
    int still = draw_first_line(current, (int)seen, height), last = (int)seen - height;
    int first = still + l->log_scroll;
    first = first > last ? last : first;
    first = first < 0 ? 0 : first;
    l->log_scroll = first - still;
    draw_spot(l, PART_LOG, (area){a.x + 1, a.y + 1, a.width - 2, height}, first);
    for (int i = first; i < (int)seen && i < first + height; i++) {
        const event *v = &t->events[i];
        int y = a.y + 1 + i - first;
        screen_print(s, a.x + 2, y, a.width - 4, INK_TEXT, "%9.5f s  %s", v->time,
                     event_name(v->kind));
        if (v->kind == EVENT_IMPACT || v->kind == EVENT_PUSH) {
            screen_print(s, a.x + 22, y, a.width - 24, INK_EVENT, "%.3g N s", v->impulse);
        } else if (v->kind == EVENT_CHANGE && v->index >= 0) {
            const action *c = &e->effective.actions[v->index];
            screen_print(s, a.x + 22, y, a.width - 24, INK_EVENT, "%s",
                         parameter_table[c->parameter].path);
        }
        if (v->time == e->now) {
            screen_tint(s, a.x + 1, y, a.width - 2, 1, INK_SELECTED);
        }
    }
}
