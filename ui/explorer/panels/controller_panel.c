// The panel of the control law: its modes and the lock on one, and what it read, wanted
// and sent at its last sample.
#include "ui/explorer/panels/panel.h"

#include <math.h>
#include <string.h>

enum { NUMBERS_AT = 16, UNITS_AT = 25 }; // columns [cells]
enum { TALL = 10, BRIEF = 7 };           // rows of the panel [cells]

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

// A line of the table: name, value and unit of a quantity.
static void draw_quantity(screen *s, area a, const char *name, double value,
                          const char *unit)
{
    area_text(s, a, INK_TEXT, name);
    area_print(s, area_right(a, NUMBERS_AT), INK_TITLE, "%8s", draw_number(value).text);
    if (isfinite(value)) {
        area_text(s, area_right(a, UNITS_AT), INK_DIM, unit);
    }
}

// The command, and whether the amplifier gets less than that.
static void draw_command(screen *s, area a, const parameters *p, double command)
{
    draw_quantity(s, a, "command", command, "V");
    if (fabs(command) >= p->motor.voltage_limit) {
        screen_text(s, a.x + 8, a.y, 9, INK_WARNING, "saturated");
        area_print(s, area_right(a, UNITS_AT + 2), INK_WARNING, ">%g",
                   p->motor.voltage_limit);
    }
}

// A number with few decimals, from 10 on with as few digits; "-" for none.
static number_text brief_number(int decimals, double value)
{
    number_text n = {"-"};
    if (isfinite(value) && fabs(value) < 10) {
        snprintf(n.text, sizeof n.text, "%.*f", decimals, value);
    } else if (isfinite(value)) {
        snprintf(n.text, sizeof n.text, "%.*g", decimals, value);
    }
    return n;
}

// Two lines for what the tall panel has a table for.
static void draw_brief(screen *s, area a, const sample *row, const parameters *p)
{
    // not every law needs an angle
    if (isfinite(row->desired_angle)) {
        area_print(s, a, INK_TEXT, "wants %s rad, %s rad/s",
                   brief_number(3, row->desired_angle).text,
                   brief_number(2, row->desired_velocity).text);
    } else {
        area_text(s, a, INK_DIM, "wants no angle");
    }
    area_print(s, area_row(a, 1), INK_TEXT, "force %s, calc. %s of %g N",
               brief_number(2, row->force_reading).text,
               brief_number(2, row->calculated_force).text, p->control.force);
}

// Setpoint and readings of the law, a line each.
static void draw_readings(screen *s, area a, const sample *row, const parameters *p)
{
    const struct {
        const char *name, *unit;
        double value;
    } quantities[] = {{"desired angle", "rad", row->desired_angle},
                      {"desired velocity", "rad/s", row->desired_velocity},
                      {"force reading", "N", row->force_reading},
                      {"calculated force", "N", row->calculated_force},
                      {"force commanded", "N", p->control.force}};
    enum { QUANTITIES = sizeof quantities / sizeof quantities[0] };
    for (int i = 0; i < QUANTITIES; i++) {
        draw_quantity(s, area_row(a, i), quantities[i].name, quantities[i].value,
                      quantities[i].unit);
    }
}

// Tall enough for its table, or brief, or not at all.
static int controller_rows(const explorer_model *model, const explorer_view *view,
                           screen_size body)
{
    if (!model_has_law(model)) {
        return 0;
    }
    (void)view;
    if (body.height >= 24) {
        return TALL;
    }
    if (body.height >= 11) {
        return BRIEF;
    }
    return 0;
}

// Modes, lock and command of the law, then its readings as there is room.
static void draw_controller(const explorer_model *model, const explorer_view *view,
                            layout *lay, screen *s, area a)
{
    (void)lay;
    const sample *row = session_sample(&model->session);
    const parameters p = model_parameters(model);
    char title[128];
    snprintf(title, sizeof title, "%s, %g Hz", control_law_table[p.control.law].word,
             p.control.rate);
    area_frame(s, a, INK_FRAME, title);

    // modes, lock and command always
    const area inside = area_inside(a), rest = area_below(inside, 3);
    draw_modes(&model->modes, s, area_row(inside, 0), row->controller_mode);
    draw_lock(model, view, s, area_row(inside, 1));
    draw_command(s, area_row(inside, 2), &p, row->command);

    // the rest in brief where rows are few
    if (a.height < TALL) {
        draw_brief(s, rest, row, &p);
    } else {
        draw_readings(s, rest, row, &p);
    }
}

const panel controller_panel = {.name = "controller",
                                .rows = controller_rows,
                                .draw = draw_controller};
