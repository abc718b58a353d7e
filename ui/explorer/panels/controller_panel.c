// The words of the control law: its modes and the lock on one, and what it read and sent
// at its last sample.
#include "ui/explorer/panels/panel.h"

#include <math.h>
#include <string.h>

// The cells that a mode's name takes, the present one in brackets.
static int mode_width(const law_modes *m, int index, bool present)
{
    const int length = (int)strlen(m->names[index]);
    return present ? length + 2 : length;
}

// The first mode of a line: where not all have room, as many of the first ones are left
// out as let the present one be seen.
static int first_shown_mode(const law_modes *m, int present, int room)
{
    int width = -1;
    for (int i = 0; i < m->count; i++) {
        width += mode_width(m, i, i == present) + 1;
    }
    int first = 0;
    while (width > room && first < present) {
        width -= mode_width(m, first, false) + 1;
        first++;
    }
    return first;
}

// The modes in a line, the present one in brackets; those behind it as far as they have
// room. -1 or a number that is no mode's: none is present.
static void draw_modes(const law_modes *m, screen *s, area line, double mode)
{
    const bool known = mode >= 0 && mode < m->count;
    const int shown_in_any_case = known ? (int)mode : 0;
    for (int i = first_shown_mode(m, shown_in_any_case, line.width); i < m->count; i++) {
        const bool present = i == mode;
        const int width = mode_width(m, i, present);
        if (width > line.width && !present) {
            break;
        }
        if (present) {
            area_print(s, line, INK_EVENT, "[%s]", m->names[i]);
        } else {
            area_text(s, line, INK_DIM, m->names[i]);
        }
        line = area_right(line, width + 1);
    }
}

// The first of the keys that carry out a line, "" if there is none.
static void first_key_of(const key_bindings *keys, const char *line, char name[64])
{
    key_names_of(keys, line, name, 64);
    name[strcspn(name, " ")] = '\0';
}

// The lock on a mode that holds, with the key that changes it.
static void draw_lock(const explorer_model *model, const explorer_view *view, screen *s,
                      area a)
{
    const parameters p = model_parameters(model);
    const char *lock = p.control.lock;
    char key[64];
    if (!model->modes.lockable) {
        area_text(s, a, INK_DIM, "takes no lock on a mode");
        return;
    }
    if (lock[0] == '\0' || strcmp(lock, "none") == 0) {
        const int used = area_text(s, a, INK_DIM, "not locked");
        first_key_of(&view->keys, "lock next", key);
        if (key[0] != '\0') {
            area_print(s, area_right(a, used), INK_DIM, " (%s locks)", key);
        }
        return;
    }
    const int used = area_print(s, a, INK_WARNING, "locked: %s", lock);
    first_key_of(&view->keys, "lock off", key);
    if (key[0] != '\0') {
        area_print(s, area_right(a, used), INK_WARNING, " (%s frees)", key);
    }
}

// The command and the reading, and whether the amplifier gets less than that.
static void draw_sample(screen *s, area a, const parameters *p, const sample *row)
{
    const int used =
        area_print(s, a, INK_TEXT, "command %s V ", draw_number(row->command).text);
    if (fabs(row->command) >= p->motor.voltage_limit) {
        area_print(s, area_right(a, used), INK_WARNING, "saturated at %g V",
                   p->motor.voltage_limit);
    }
    area_print(s, area_row(a, 1), INK_TEXT, "reads %s of %g N",
               draw_number(row->force_reading).text, p->control.force);
}

enum { ROWS = 5 };

static int controller_rows(const explorer_model *model, const explorer_view *view,
                           screen_size body)
{
    (void)view;
    enum { LEAST = 11 };
    return model_has_law(model) && body.height >= LEAST ? ROWS : 0;
}

// Name, modes, lock, command and reading of the law.
static void draw_controller(const explorer_model *model, const explorer_view *view,
                            layout *lay, screen *s, area a)
{
    (void)lay;
    const sample *row = session_sample(&model->session);
    const parameters p = model_parameters(model);
    const area lines = {a.x + 2, a.y, a.width - 3, a.height};
    area_print(s, lines, INK_DIM, "%s, %g Hz", control_law_table[p.control.law].word,
               p.control.rate);
    draw_modes(&model->modes, s, area_row(lines, 1), row->controller_mode);
    draw_lock(model, view, s, area_row(lines, 2));
    draw_sample(s, area_below(lines, 3), &p, row);
}

const panel controller_panel = {.name = "controller",
                                .rows = controller_rows,
                                .draw = draw_controller};
