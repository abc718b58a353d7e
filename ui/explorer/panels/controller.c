// The panel of the control law: its modes and the lock on one, and what it read, wanted
// and sent at its last sample.
#include "ui/explorer/panels/panel.h"

#include <math.h>
#include <string.h>

enum { NUMBERS_AT = 16 };      // column of the numbers [cells]
enum { TALL = 10, BRIEF = 7 }; // rows of the panel [cells]

// The modes in a line, the present one in brackets; where not all fit, those up to the
// present one.
static void draw_modes(const explorer_model *model, screen *s, area a, double present)
{
    const law_modes *m = &model->modes;
    int first = 0, width = -1,
        last = present >= 0 && present < m->count ? (int)present : 0;

    // how wide all modes are; the first ones go where that is too much
    for (int i = 0; i < m->count; i++) {
        width += (int)strlen(m->names[i]) + 1 + 2 * (i == last);
    }
    for (; width > a.width && first < last; first++) {
        width -= (int)strlen(m->names[first]) + 1;
    }

    // the present one in brackets, and no other one that has no room
    const int end = a.x + a.width;
    for (int i = first, x = a.x, length; i < m->count; i++, x += length + 1) {
        const bool now = i == present;
        length = (int)strlen(m->names[i]) + 2 * now;
        if (x + length > end && !now) {
            break;
        }
        screen_print(s, x, a.y, end - x, now ? INK_EVENT : INK_DIM, now ? "[%s]" : "%s",
                     m->names[i]);
    }
}

static void draw_lock(const explorer_model *model, const explorer_view *view, screen *s,
                      area a)
{
    char next[64], off[64];
    parameters p = model_parameters(model);

    // the first key of each, where several do the same
    key_names_of(&view->keys, "lock next", next, sizeof next);
    key_names_of(&view->keys, "lock off", off, sizeof off);
    next[strcspn(next, " ")] = off[strcspn(off, " ")] = '\0';

    // what holds now, with the key that changes it
    if (!model->modes.lockable) {
        screen_text(s, a.x, a.y, a.width, INK_DIM, "takes no lock on a mode");
    } else if (p.control.lock[0] == '\0' || strcmp(p.control.lock, "none") == 0) {
        screen_print(s, a.x, a.y, a.width, INK_DIM,
                     next[0] ? "not locked (%s locks)" : "not locked", next);
    } else {
        screen_print(s, a.x, a.y, a.width, INK_WARNING,
                     off[0] ? "locked: %s (%s frees)" : "locked: %s", p.control.lock,
                     off);
    }
}

static void draw_quantity(screen *s, area a, const char *name, double value,
                          const char *unit)
{
    screen_text(s, a.x, a.y, a.width, INK_TEXT, name);
    screen_print(s, a.x + NUMBERS_AT, a.y, a.width - NUMBERS_AT, INK_TITLE, "%8s",
                 draw_number(value).text);
    screen_text(s, a.x + NUMBERS_AT + 9, a.y, a.width - NUMBERS_AT - 9, INK_DIM,
                isfinite(value) ? unit : "");
}

// The command, and whether the amplifier gets less than that.
static void draw_command(screen *s, area a, const parameters *p, double command)
{
    draw_quantity(s, a, "command", command, "V");
    if (fabs(command) >= p->motor.voltage_limit) {
        screen_text(s, a.x + 8, a.y, 9, INK_WARNING, "saturated");
        screen_print(s, a.x + NUMBERS_AT + 11, a.y, a.width - NUMBERS_AT - 11,
                     INK_WARNING, ">%g", p->motor.voltage_limit);
    }
}

// A number in a few cells, "-" for none.
static number_text brief(int decimals, double value)
{
    number_text n = {"-"};
    if (isfinite(value)) {
        snprintf(n.text, sizeof n.text, fabs(value) < 10 ? "%.*f" : "%.*g", decimals,
                 value);
    }
    return n;
}

// Two lines for what the tall panel has a table for.
static void draw_brief(screen *s, area a, const sample *row, const parameters *p)
{
    // not every law needs an angle
    const bool angle = isfinite(row->desired_angle);
    screen_print(s, a.x, a.y, a.width, angle ? INK_TEXT : INK_DIM,
                 angle ? "wants %s rad, %s rad/s" : "wants no angle",
                 brief(3, row->desired_angle).text, brief(2, row->desired_velocity).text);
    screen_print(s, a.x, a.y + 1, a.width, INK_TEXT, "force %s, calc. %s of %g N",
                 brief(2, row->force_reading).text, brief(2, row->calculated_force).text,
                 p->control.force);
}

// Tall enough for its table, or brief, or not at all; before the predictors, which may
// fold.
static int rows(const explorer_model *model, const explorer_view *view, screen_size body)
{
    const int room = body.height - predictors_rows(model, view, body);
    if (!model_has_law(model)) {
        return 0;
    }
    if (room >= 30) {
        return TALL;
    }
    if (body.height >= 13) {
        return BRIEF;
    }
    return 0;
}

static void draw(const explorer_model *model, const explorer_view *view, layout *lay,
                 screen *s, area a)
{
    (void)lay;
    const sample *row = session_sample(&model->session);
    parameters p = model_parameters(model);
    char title[128];
    snprintf(title, sizeof title, "%s, %g Hz", control_law_table[p.control.law].word,
             p.control.rate);
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, title);

    // modes, lock and command always
    area line = {a.x + 2, a.y + 1, a.width - 4, 1};
    draw_modes(model, s, line, row->controller_mode);
    draw_lock(model, view, s, (area){line.x, line.y + 1, line.width, 1});
    draw_command(s, (area){line.x, line.y + 2, line.width, 1}, &p, row->command);
    line.y += 3;

    // the rest in brief where rows are few
    if (a.height < TALL) {
        draw_brief(s, line, row, &p);
        return;
    }

    // setpoint and readings of the law
    const struct {
        const char *name, *unit;
        double value;
    } lines[] = {{"desired angle", "rad", row->desired_angle},
                 {"desired velocity", "rad/s", row->desired_velocity},
                 {"force reading", "N", row->force_reading},
                 {"calculated force", "N", row->calculated_force},
                 {"force commanded", "N", p.control.force}};
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++, line.y++) {
        draw_quantity(s, line, lines[i].name, lines[i].value, lines[i].unit);
    }
}

const panel controller_panel = {.name = "controller", .rows = rows, .draw = draw};
