// Opening, closing and advancing the terminal lab.
#include "ui/explorer/lab.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

void lab_say(lab *l, bool warning, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(l->message, sizeof l->message, format, list);
    va_end(list);
    l->warning = warning;
}

// What a fresh session looks like.
static void look_afresh(lab *l)
{
    l->has_mark = false;
    l->from = l->to = 0;
    l->adrift = false;
    memset(&l->extent, 0, sizeof l->extent);
    lab_define_panes(l);
    lab_draw_finish(l);
    const summary *m = &l->session.run.summary;
    if (m->status != STATUS_OK) {
        lab_say(l, true, "the run stops: %s", m->message);
    }
}

status lab_init(lab *l, scenario *s, fault *f)
{
    return lab_open_patiently(l, s, HUGE_VAL, f);
}

status lab_open_patiently(lab *l, scenario *s, double patience, fault *f)
{
    memset(l, 0, sizeof *l);
    status code = session_open(&l->session, s, patience, f);
    if (code != STATUS_OK) {
        return code;
    }
    l->speed = 0.2;
    l->mouse = true;
    l->parameter = PARAMETER_INDEX(motor.voltage);
    look_afresh(l);
    fault ignored;
    if (scenario_list(&l->names, &l->name_count, &ignored) != STATUS_OK) {
        l->name_count = 0;
    }
    return STATUS_OK;
}

void lab_finish(lab *l)
{
    lab_draw_finish(l);
    lab_forget_titles(l);
    session_finish(&l->session);
    for (int i = 0; i < l->name_count; i++) {
        free(l->names[i]);
    }
    free(l->names);
    memset(l, 0, sizeof *l);
}

// Keeps the first fault of a scenario that does not open.
static void keep_first_fault(void *context, const char *sentence)
{
    fault *f = context;
    if (f->code == STATUS_OK) {
        fault_set(f, STATUS_BAD_SCENARIO, "%s", sentence);
    }
}

bool lab_open(lab *l, const char *name)
{
    scenario s;
    session fresh;
    fault f = {0};
    status code = scenario_open(&s, name, keep_first_fault, &f);
    if (code == STATUS_OK) {
        code = session_open(&fresh, &s, l->session.patience, &f);
    }
    if (code != STATUS_OK) {
        lab_say(l, true, "%s", f.text[0] ? f.text : status_text(code));
        return false;
    }
    session_finish(&l->session);
    l->session = fresh;
    l->playing = true;
    lab_say(l, false, "%s", l->session.base.title ? l->session.base.title : "");
    look_afresh(l);
    return true;
}

void lab_advance(lab *l, double seconds)
{
    session *s = &l->session;
    if (!l->playing || !(seconds > 0)) {
        l->measured = 0;
        return;
    }
    double before = s->now;
    session_seek(s, before + seconds * l->speed);
    double factor = (s->now - before) / seconds;
    l->measured = l->measured > 0 ? 0.9 * l->measured + 0.1 * factor : factor;
    if (s->now >= session_end(s) && s->computing == NULL) {
        l->playing = false;
        if (s->run.summary.status != STATUS_OK) {
            lab_say(l, true, "the run stops: %s", s->run.summary.message);
        } else {
            lab_say(l, false,
                    "end of the run: Space plays it again, x makes it longer, "
                    "n and N visit its events");
        }
    }
}

void lab_click(lab *l, int x, int y)
{
    double from, to;
    bool inside = x >= l->plot_x && x < l->plot_x + l->plot_width && y >= l->plot_y &&
                  y < l->plot_y + l->plot_height;
    if (inside && l->overlay == OVERLAY_NONE) {
        lab_window(l, &from, &to);
        l->playing = false;
        session_seek(&l->session, from + (to - from) * (x - l->plot_x + 0.5) / l->plot_width);
    }
}

void lab_wheel(lab *l, int direction)
{
    lab_key(l, direction < 0 ? KEY_CODE_UP : KEY_CODE_DOWN);
}

bool lab_applies(const lab *l, int parameter)
{
    const parameters *p = &l->session.effective.parameters;
    const char *path = parameter_table[parameter].path;
    bool printed = p->arm.model == ARM_PRINTED, bare = p->control.law == LAW_NONE;
    if (strncmp(path, "printed.", 8) == 0) {
        return printed;
    }
    if (strncmp(path, "sensor.", 7) == 0 || strncmp(path, "control.", 8) == 0) {
        return !bare || strcmp(path, "control.law") == 0;
    }
    return true;
}
