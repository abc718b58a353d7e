#include "render/figures/diagram.h"

#include <math.h>

void diagram_add_value(diagram *d, const char *name, double value, const char *unit)
{
    const diagram_value added = {name, unit, value};
    g_array_append_val(d->values, added);
}

static status paint_diagram(cairo_t *cr, const void *what, figure_report *report,
                            fault *f)
{
    sketch s;
    const diagram *d = what;
    TRY(sketch_begin(&s, cr, &d->frame, report, f));
    d->draw(&s, d);
    return sketch_end(&s);
}

// The diagram's numbers as rows of quantity, value and unit.
static void write_diagram(const void *what, csv_writer *csv)
{
    const diagram *d = what;
    csv_heading(csv, "quantity", NULL);
    csv_heading(csv, "value", NULL);
    csv_heading(csv, "unit", NULL);
    csv_end_row(csv);
    for (guint i = 0; i < d->values->len; i++) {
        const diagram_value *v = &g_array_index(d->values, diagram_value, i);
        csv_text(csv, v->name);
        csv_number(csv, v->value);
        csv_text(csv, v->unit);
        csv_end_row(csv);
    }
}

void diagram_release(void *what)
{
    diagram *d = what;
    g_free(d->title);
    g_free(d->caption);
    g_free(d->parameters);
    g_array_free(d->values, TRUE);
    run_close(d->run);
    g_free(d);
}

// The run is made here; its parameters are those of the diagram.
diagram *diagram_create(const figure_order *order, const char *change, double body,
                        void (*draw)(sketch *s, const diagram *d), fault *f)
{
    g_autoptr(diagram) d = g_new0(diagram, 1);
    d->draw = draw;
    d->values = g_array_new(FALSE, FALSE, sizeof(diagram_value));
    d->title = g_strdup(order->title);
    d->frame = (sketch_frame){.title = d->title,
                              .body_height = body,
                              .look = order->options->look};
    parameters_defaults(&d->p, ARM_CORRECTED);
    parameters_resolve(&d->p, NULL);
    if (order->which->scenario != NULL) {
        d->run = run_open(order->which->scenario, change, f);
        if (d->run == NULL) {
            return NULL;
        }
        d->p = d->run->scenario.parameters;
        d->parameters = parameters_line(&d->run->scenario);
    }
    return g_steal_pointer(&d);
}

status diagram_lacks(const diagram *d, const char *what, fault *f)
{
    return fault_set(f, STATUS_BAD_SCENARIO, "%s: no %s to draw", d->run->scenario.name,
                     what);
}

// Looks for the first impact among the run's events.
status diagram_take_impact(diagram *d, double *speed, fault *f)
{
    const trace *t = &d->run->result.trace;
    for (size_t i = 0; i < t->event_count; i++) {
        if (t->events[i].kind == EVENT_IMPACT) {
            *speed = t->events[i].speed;
            d->impulse = t->events[i].impulse;
            d->before = d->run->result.landing.before;
            return STATUS_OK;
        }
    }
    return diagram_lacks(d, "impact", f);
}

point view_place(const view *v, point at)
{
    return (point){v->x + v->metre * at.x, v->y - v->metre * v->across * at.y};
}

point view_end(point from, double length, double angle)
{
    return shifted(from, length * cos(angle), length * sin(angle));
}

void diagram_angle(sketch *s, point at, angle_arc a)
{
    double middle = (a.from + a.to) / 2, away = a.radius + 3;
    sketch_arc(s, (arc){at, a.radius, a.from, a.to, true}, SKETCH_INK);
    sketch_label(s, shifted(at, away * cos(middle), -away * sin(middle)),
                 (anchor){0, 0.5}, "%s", a.markup);
}

void diagram_link_angle(sketch *s, point at, double radius, double to, const char *markup)
{
    sketch_dashed(s, at, shifted(at, radius + 14, 0), SKETCH_FAINT);
    diagram_angle(s, at, (angle_arc){radius, 0, to, markup});
}

// From here on the artwork owns the diagram.
status diagram_open(diagram **held, artwork *out, const char *caption, ...)
{
    diagram *d = g_steal_pointer(held);
    va_list list;
    va_start(list, caption);
    d->frame.caption = d->caption = text_vprintf(caption, list);
    va_end(list);
    *out = (artwork){.title = d->title,
                     .caption = d->caption,
                     .parameters = d->parameters,
                     .owner = d,
                     .paint = paint_diagram,
                     .write_csv = write_diagram,
                     .release = diagram_release};
    sketch_size(&d->frame, &out->width, &out->height);
    return STATUS_OK;
}
