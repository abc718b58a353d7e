#include "src/tables/signals.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "src/base/expression.h"
#include "src/base/numbers.h"
#include "src/base/words.h"

#define AT(field) offsetof(sample, field)
#define OPTIONAL  true

static signal_info table[SIGNALS_AT_MOST + DERIVED_SIGNALS] = {
    // name, symbol, ASCII twin, unit, description, body, quantity, colour, line, offset, whether it
    // is optional
    {"time", "t", "t", "s", "simulated time", BODY_NONE, "Time", 0, LINE_SOLID, AT(time)},
    {"hub_angle", "θ<sub>1</sub>", "th1", "rad", "angle of the hub", BODY_HUB, "Angle", 0,
     LINE_SOLID, AT(hub_angle)},
    {"first_angle", "θ<sub>2</sub>", "th2", "rad", "angle of the first link", BODY_FIRST_LINK,
     "Angle", 1, LINE_DASHED, AT(first_angle)},
    {"last_angle", "θ<sub>3</sub>", "th3", "rad", "angle of the last link", BODY_LAST_LINK, "Angle",
     2, LINE_SOLID, AT(last_angle)},
    {"hub_velocity", "θ̇<sub>1</sub>", "w1", "rad/s", "angular velocity of the hub", BODY_HUB,
     "Angular velocity", 0, LINE_SOLID, AT(hub_velocity)},
    {"first_velocity", "θ̇<sub>2</sub>", "w2", "rad/s", "angular velocity of the first link",
     BODY_FIRST_LINK, "Angular velocity", 1, LINE_DASHED, AT(first_velocity)},
    {"last_velocity", "θ̇<sub>3</sub>", "w3", "rad/s", "angular velocity of the last link",
     BODY_LAST_LINK, "Angular velocity", 2, LINE_SOLID, AT(last_velocity)},
    {"hub_acceleration", "θ̈<sub>1</sub>", "a1", "rad/s2", "angular acceleration of the hub",
     BODY_HUB, "Angular acceleration", 0, LINE_SOLID, AT(hub_acceleration)},
    {"first_acceleration", "θ̈<sub>2</sub>", "a2", "rad/s2",
     "angular acceleration of the first link", BODY_FIRST_LINK, "Angular acceleration", 1,
     LINE_DASHED, AT(first_acceleration)},
    {"last_acceleration", "θ̈<sub>3</sub>", "a3", "rad/s2", "angular acceleration of the last link",
     BODY_LAST_LINK, "Angular acceleration", 2, LINE_SOLID, AT(last_acceleration)},
    {"gap", "g", "gap", "m", "distance of the arm from the contact point", BODY_NONE, "Gap", 3,
     LINE_SOLID, AT(gap)},
    {"gap_velocity", "ġ", "vgap", "m/s", "rate of the gap", BODY_NONE, "Rate of the gap", 3,
     LINE_DASHED, AT(gap_velocity)},
    {"force", "f", "f", "N", "contact force, impulses excluded", BODY_NONE, "Contact force", 5,
     LINE_SOLID, AT(force)},
    {"impulse", "p", "p", "N s", "impulse of an impact at this very instant", BODY_NONE, "Impulse",
     4, LINE_SOLID, AT(impulse)},
    {"contact", "contact", "contact", "", "1 while in contact", BODY_NONE, "In contact", 3,
     LINE_SOLID, AT(contact)},
    {"sticking", "stick", "stick", "", "1 while the hub sticks", BODY_NONE, "Sticking", 6,
     LINE_DOTTED, AT(sticking)},
    {"voltage", "v", "v", "V", "command to the amplifier", BODY_NONE, "Voltage", 6, LINE_SOLID,
     AT(voltage)},
    {"motor_torque", "τ<sub>m</sub>", "tau", "N m", "motor torque before back EMF", BODY_NONE,
     "Motor torque", 6, LINE_DASHED, AT(motor_torque)},
    {"friction_torque", "τ<sub>c</sub>", "tauc", "N m", "Coulomb friction torque at the hub",
     BODY_NONE, "Friction torque", 4, LINE_DASHED, AT(friction_torque)},
    {"kinetic_energy", "T", "T", "J", "kinetic energy", BODY_NONE, "Kinetic energy", 0, LINE_SOLID,
     AT(kinetic_energy)},
    {"strain_energy", "V", "V", "J", "strain energy of the springs", BODY_NONE, "Strain energy", 1,
     LINE_DASHED, AT(strain_energy)},
    {"motor_work", "W<sub>m</sub>", "Wm", "J", "work done by the motor torque", BODY_NONE, "Work",
     2, LINE_SOLID, AT(motor_work)},
    {"external_work", "W<sub>e</sub>", "We", "J", "work done by pushes", BODY_NONE, "Work", 2,
     LINE_DOTTED, AT(external_work)},
    {"viscous_loss", "D<sub>v</sub>", "Dv", "J", "lost to back EMF and viscous friction", BODY_NONE,
     "Energy lost", 3, LINE_DASHED, AT(viscous_loss)},
    {"friction_loss", "D<sub>c</sub>", "Dc", "J", "lost to Coulomb friction", BODY_NONE,
     "Energy lost", 4, LINE_DOTTED, AT(friction_loss)},
    {"damping_loss", "D<sub>s</sub>", "Ds", "J", "lost to structural damping", BODY_NONE,
     "Energy lost", 6, LINE_DASH_DOT, AT(damping_loss)},
    {"impact_loss", "D<sub>i</sub>", "Di", "J", "lost in impacts", BODY_NONE, "Energy lost", 5,
     LINE_DASHED, AT(impact_loss)},
    {"energy_residual", "r", "res", "J", "energy the ledger does not account for", BODY_NONE,
     "Energy unaccounted for", 7, LINE_SOLID, AT(energy_residual)},
    {"encoder", "θ<sub>enc</sub>", "enc", "rad", "hub angle as the encoder reads it", BODY_NONE,
     "Hub angle", 0, LINE_SOLID, AT(encoder)},
    {"tachometer", "θ̇<sub>tach</sub>", "tach", "rad/s", "hub velocity as the tachometer reads it",
     BODY_NONE, "Hub velocity", 0, LINE_SOLID, AT(tachometer)},
    {"force_reading", "f<sub>FSR</sub>", "fsr", "N", "contact force as the FSR reads it", BODY_NONE,
     "Contact force", 5, LINE_SOLID, AT(force_reading)},
    {"piezo_force", "f<sub>piezo</sub>", "fpz", "N",
     "contact force as the piezoelectric sensor reads it", BODY_NONE, "Contact force", 2,
     LINE_SOLID, AT(piezo_force), OPTIONAL},
    {"film", "δ<sub>film</sub>", "film", "rad",
     "bending of the beam, last link's angle minus the first's, as the piezo film reads it",
     BODY_NONE, "Bending", 4, LINE_SOLID, AT(film), OPTIONAL},
    {"accelerometer", "θ̈<sub>acc</sub>", "acc", "rad/s2",
     "hub acceleration as the accelerometer reads it", BODY_NONE, "Hub acceleration", 0, LINE_SOLID,
     AT(accelerometer), OPTIONAL},
    {"command", "u", "u", "V", "command of the controller", BODY_NONE, "Command", 6, LINE_SOLID,
     AT(command)},
    {"controller_mode", "mode", "mode", "", "mode of the controller, counted from 0", BODY_NONE,
     "Mode", 3, LINE_SOLID, AT(controller_mode)},
    {"desired_angle", "θ<sub>d</sub>", "thd", "rad", "hub angle that the controller wants",
     BODY_NONE, "Hub angle", 1, LINE_DASHED, AT(desired_angle)},
    {"desired_velocity", "θ̇<sub>d</sub>", "wd", "rad/s", "hub velocity that the controller wants",
     BODY_NONE, "Hub velocity", 1, LINE_DASHED, AT(desired_velocity)},
    {"calculated_force", "f<sub>calc</sub>", "fcalc", "N",
     "contact force that the controller calculates", BODY_NONE, "Contact force", 2, LINE_DASHED,
     AT(calculated_force)},
    {"wall_energy", "V<sub>w</sub>", "Vw", "J", "energy that a wall that gives holds", BODY_NONE,
     "Strain energy", 5, LINE_DASHED, AT(wall_energy), OPTIONAL},
    {"wall_loss", "D<sub>w</sub>", "Dw", "J", "lost in a wall that gives", BODY_NONE, "Energy lost",
     5, LINE_DASH_DOT, AT(wall_loss), OPTIONAL},
    {"wall_place", "u<sub>w</sub>", "uw", "m",
     "where a wall that moves is, along its normal towards the arm", BODY_NONE, "Place of the wall",
     3, LINE_SOLID, AT(wall_place), OPTIONAL},
    {"wall_work", "W<sub>w</sub>", "Ww", "J", "work done by a wall that moves", BODY_NONE, "Work",
     5, LINE_DOTTED, AT(wall_work), OPTIONAL},
    {"weight_energy", "V<sub>g</sub>", "Vg", "J",
     "potential energy of the weight in a tilted plane, from the hub's axis on", BODY_NONE,
     "Strain energy", 6, LINE_DASHED, AT(weight_energy), OPTIONAL},
    {"face_depth", "x<sub>w</sub>", "xw", "m", "how far the face of a wall that gives is pushed in",
     BODY_NONE, "Depth of the wall's face", 2, LINE_DASHED, AT(face_depth), OPTIONAL},
    {"predicted_force", "f<sub>pred</sub>", "fpred", "N",
     "largest contact force if the tip struck now, as the rig predicts it", BODY_NONE,
     "Contact force", 4, LINE_DOTTED, AT(predicted_force), OPTIONAL},
};

const signal_info *const signal_table = table;
const int signal_count = SIGNALS_AT_MOST;

int signal_find(const char *name)
{
    assert(name != NULL);
    const int found = signal_find_any(name);
    return found < signal_count ? found : -1;
}

int signal_find_any(const char *name)
{
    assert(name != NULL);
    for (int i = 0; i < SIGNALS_AT_MOST + DERIVED_SIGNALS; i++) {
        if (table[i].name != NULL && strcmp(table[i].name, name) == 0) {
            return i;
        }
    }
    return -1;
}

const char *signal_body_name(signal_body body)
{
    static const char *const names[] = {[BODY_NONE] = "",
                                        [BODY_HUB] = "hub",
                                        [BODY_FIRST_LINK] = "first link",
                                        [BODY_LAST_LINK] = "last link"};
    assert((unsigned)body < sizeof names / sizeof names[0]);
    return names[body];
}

int signal_index(const char *name)
{
    int index = signal_find(name);
    assert(index >= 0);
    return index;
}

bool signal_is_state(int index)
{
    assert(index >= 0 && index < SIGNALS_AT_MOST + DERIVED_SIGNALS);
    return index == SIGNAL_INDEX(contact) || index == SIGNAL_INDEX(sticking) ||
           index == SIGNAL_INDEX(controller_mode);
}

// --- derived signals --------------------------------------------------------------------------

enum { DERIVED_NAME = 256 };

static struct {
    expression expression;
    char name[DERIVED_NAME];
} derived[DERIVED_SIGNALS];

static int find_recorded(void *context, const char *name, const char **near)
{
    (void)context;
    const int found = signal_find(name);
    nearest_word nearest = nearest_begin(name);
    for (int i = 0; i < signal_count; i++) {
        nearest_try(&nearest, table[i].name);
    }
    *near = nearest.best;
    return found;
}

// The unit of an expression: terms have the same, a factor without a unit keeps it; else "".
static const char *unit_of(const expression *e)
{
    const char *stack[EXPRESSION_STEPS]; // NULL: a number
    int top = -1;
    for (int i = 0; i < e->count; i++) {
        const expression_step *s = &e->step[i];
        if (s->what == EXPRESSION_NUMBER || s->what == EXPRESSION_NAME) {
            stack[++top] = s->what == EXPRESSION_NAME ? table[s->name].unit : NULL;
        } else if (s->what != EXPRESSION_MINUS) {
            const char *a = stack[--top], *b = stack[top + 1];
            const bool same = a != NULL && b != NULL && strcmp(a, b) == 0;
            const bool sum = s->what != EXPRESSION_MULTIPLY && s->what != EXPRESSION_DIVIDE;
            const bool scaled = b == NULL || (a == NULL && s->what != EXPRESSION_DIVIDE);
            stack[top] = scaled ? (a != NULL ? a : b) : sum && same ? a : "";
        }
    }
    return stack[0] != NULL ? stack[0] : "";
}

int signal_derive(int place, const char *text, fault *f)
{
    assert(place >= 0 && place < DERIVED_SIGNALS && text != NULL);
    expression e;
    char name[DERIVED_NAME];
    size_t length = 0;
    for (const char *c = text; *c != '\0' && length + 1 < sizeof name; c++) {
        if (!is_blank(*c)) {
            name[length++] = *c;
        }
    }
    name[length] = '\0';
    if (expression_read(&e, text, find_recorded, NULL, f) != STATUS_OK) {
        return -1;
    }

    derived[place].expression = e;
    snprintf(derived[place].name, DERIVED_NAME, "%s", name);
    table[SIGNALS_AT_MOST + place] = (signal_info){.name = derived[place].name,
                                                   .symbol = derived[place].name,
                                                   .ascii = derived[place].name,
                                                   .unit = unit_of(&e),
                                                   .description = "an expression of yours",
                                                   .quantity = derived[place].name,
                                                   .colour = place % 8,
                                                   .optional = true};
    return SIGNALS_AT_MOST + place;
}

bool signal_is_derived(int index)
{
    return index >= SIGNALS_AT_MOST;
}

// --- values -----------------------------------------------------------------------------------

static double recorded_value(const void *row, int index)
{
    double value;
    memcpy(&value, (const char *)row + table[index].offset, sizeof value);
    return value;
}

double signal_value(const sample *row, int index)
{
    assert(row != NULL && index >= 0 && index < SIGNALS_AT_MOST + DERIVED_SIGNALS);
    return signal_is_derived(index)
               ? expression_evaluate(&derived[index - SIGNALS_AT_MOST].expression, recorded_value,
                                     row)
               : recorded_value(row, index);
}
