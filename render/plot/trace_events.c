// What happened in a recorded run: marks, stretches and impulses of its figure.
#include "render/plot/trace_parts.h"

#include <glib.h>
#include <math.h>
#include <string.h>

#include "render/page/text.h"

static void add_mark(trace_figure *t, double time, const char *label)
{
    t->marks[t->figure.mark_count++] = (figure_mark){.x = time, .label = label};
}

// What the script did at an event, "voltage 2 V"; NULL if the event is no action.
static char *action_label(const scenario *s, const event *e)
{
    if (e->kind == EVENT_PUSH) {
        return text_printf("push %.3g\u2009N·s", e->impulse);
    }

    // anything else that is no change of a parameter
    if (e->kind != EVENT_CHANGE || e->index < 0 || e->index >= s->action_count) {
        return NULL;
    }

    const action *a = &s->actions[e->index];
    const parameter_info *info = &parameter_table[a->parameter];
    char value[128], unit[64];
    action_format_value(a, value, sizeof value);
    text_unit(info->unit, unit, sizeof unit);

    // the parameter's last name and its value with its unit
    const char *dot = strchr(info->path, '.'), *name = dot ? dot + 1 : info->path;
    return g_strdup_printf("%s %s\u2009%s", name, value, unit);
}

static char *mode_label(const char *name, double mode)
{
    char *escaped = name != NULL ? text_escape(name) : text_printf("%g", mode);
    char *label = g_strdup_printf(name != NULL ? "%s mode" : "mode %s", escaped);
    g_free(escaped);
    return label;
}

// Where the controller went into another mode, with the mode's name. False if it never did.
static bool mark_modes(trace_figure *t, const trace_run *run, GPtrArray *texts)
{
    const trace *rows = &run->result->trace;
    bool marked = false;
    double mode = (double)NAN;

    // wherever the mode is another than in the last row that had one
    for (size_t i = 0; i < rows->row_count; i++) {
        double now = rows->rows[i].controller_mode;
        if (isfinite(now) && isfinite(mode) && now != mode && t->figure.mark_count < TRACE_MARKS) {
            const char *name = trace_mode_name(run->scenario, (int)now);
            add_mark(t, rows->rows[i].time, trace_keep(texts, mode_label(name, now)));
            t->marks[t->figure.mark_count - 1].onwards = true;
            marked = true;
        }
        mode = isfinite(now) ? now : mode;
    }
    return marked;
}

static char *peak_label(double force)
{
    char *quantity = text_quantity(force, 3, "N"), *label = g_strconcat("peak ", quantity, NULL);
    g_free(quantity);
    return label;
}

void trace_mark_events(trace_figure *t, const trace_run *run, GPtrArray *texts)
{
    const summary *m = &run->result->summary;

    // modes of a controller say more than contacts
    if (trace_on_the_rig(run->scenario) && mark_modes(t, run, texts)) {
        return;
    }

    // the first pulse
    const trace *rows = &run->result->trace;
    if (isfinite(m->first_contact_s)) {
        add_mark(t, m->first_contact_s, "contact");
    }
    if (isfinite(m->first_pulse_time_to_peak_s)) {
        add_mark(t, m->first_contact_s + m->first_pulse_time_to_peak_s,
                 trace_keep(texts, peak_label(m->first_pulse_peak_N)));
        // at its point where the first panel shows forces
        figure_mark *peak = &t->marks[t->figure.mark_count - 1];
        peak->pointed = strcmp(t->panels[0].y.name, "force") == 0;
        peak->y = m->first_pulse_peak_N;
    }
    if (isfinite(m->first_pulse_s)) {
        add_mark(t, m->first_contact_s + m->first_pulse_s, "release");
    }

    // what the script did
    for (size_t i = 0; i < rows->event_count && t->figure.mark_count < TRACE_MARKS; i++) {
        char *label = action_label(run->scenario, &rows->events[i]);
        if (label != NULL) {
            add_mark(t, rows->events[i].time, trace_keep(texts, label));
        }
    }
}

bool trace_in_contact(const sample *row)
{
    return row->contact > 0.5;
}

bool trace_in_second_mode(const sample *row)
{
    return row->controller_mode == 1;
}

int trace_intervals(const trace *rows, bool (*is_so)(const sample *row), figure_interval *out)
{
    int count = 0;
    bool touching = false;

    // opened by a row that is so, closed by the first that is not
    for (size_t i = 0; i < rows->row_count; i++) {
        bool now = is_so(&rows->rows[i]);
        if (now && !touching) {
            if (out != NULL) {
                out[count] = (figure_interval){rows->rows[i].time, rows->rows[i].time};
            }
            count++;
        }
        if ((now || touching) && out != NULL) {
            out[count - 1].to = rows->rows[i].time;
        }
        touching = now;
    }
    return count;
}

int trace_impulses(const trace *rows, figure_impulse *out)
{
    int count = 0;
    for (size_t i = 0; i < rows->event_count; i++) {
        if (rows->events[i].kind == EVENT_IMPACT) {
            if (out != NULL) {
                out[count] = (figure_impulse){rows->events[i].time, rows->events[i].impulse};
            }
            count++;
        }
    }
    return count;
}
