#include "src/quantities/parameters.h"

#include <assert.h>
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "src/quantities/k2_table.h"
#include "src/base/words.h"
#include "src/base/numbers.h"

// What a row of the table is written with; a range includes both its ends.
#define PATH(field)              .path = #field, .offset = offsetof(parameters, field)
#define REAL(in, from, to)       .type = PARAMETER_REAL, .unit = in, .minimum = from, .maximum = to
#define INTEGER(from, to)        .type = PARAMETER_INTEGER, .unit = "", .minimum = from, .maximum = to
#define BOOLEAN                  .type = PARAMETER_BOOLEAN, .unit = "", .maximum = 1
#define CHOICE(last, words)      .type = PARAMETER_CHOICE, .unit = "", .maximum = last, .choices = words
#define TEXT(without)            .type = PARAMETER_TEXT, .unit = "", .maximum = 1, .choices = without
#define DEFAULT(value)           .default_corrected = value, .default_printed = value
#define DEFAULTS(ours, printed_) .default_corrected = ours, .default_printed = printed_
#define TIMED                    .timed = true
#define MEANING(sentence)        .description = sentence

// The default follows from other parameters, see parameters_resolve.
#define DERIVED (double)NAN

// k1 with which the printed model reproduces the thesis's tables. The thesis prints
// 169 468 N m/rad, with which its own algorithm at h = 1 ms chatters; 90 lies in the range
// 85-100 that matches Tables 4.1-4.3 best (docs/physics.md, hidden constants).
#define K1_PRINTED_TABLES 90.0
#define K1_THESIS         169468.0882

// What the ledger of the event method may lack of the energy put in, and that of the methods whose
// steps are the object of study.
#define EVENT_RESIDUAL_BOUND 1e-6
#define STUDY_RESIDUAL_BOUND 1e-2

// kT is printed as 0.249092 kg m/A; one kilogram-force is 9.80665 N.
#define TORQUE_CONSTANT (0.249092 * 9.80665)

const parameter_info parameter_table[] = {
    {PATH(arm.model), CHOICE(1, "corrected|printed"), DEFAULTS(ARM_CORRECTED, ARM_PRINTED),
     MEANING("equations of motion: derived anew, or as the thesis prints them")},
    {PATH(arm.links), INTEGER(1, 1024), DEFAULT(2),
     MEANING("number of rigid links the beam is cut into (N)")},
    {PATH(arm.hub_joint), CHOICE(2, "rigid|spring|beam"), DEFAULTS(HUB_RIGID, HUB_SPRING),
     MEANING("joint between hub and first link: one body, the spring k1, or the beam's own root, a "
             "spring k2 N")},
    {PATH(arm.length), REAL("m", 0.01, 100), DEFAULT(1.0),
     MEANING("length of the beam, all links together")},
    {PATH(arm.mass), REAL("kg", 1e-4, 1e4), DEFAULT(0.40108),
     MEANING("mass of the beam, all links together")},
    {PATH(arm.hub_inertia), REAL("kg m2", 0, 1e4), DEFAULT(5.2e-3),
     MEANING("moment of inertia of hub and motor shaft (I1)")},
    {PATH(arm.link_inertia), REAL("kg m2", 0, 1e4), DEFAULTS(DERIVED, 1.67e-5),
     MEANING("moment of inertia of a link about its centre of mass (I2 = I3, N = 2 only)")},
    {PATH(arm.k1), REAL("N m/rad", 1e-6, 1e9), DEFAULTS(K1_THESIS, K1_PRINTED_TABLES), TIMED,
     MEANING("stiffness of the hub joint (arm.hub_joint = spring; with beam it is k2 N)")},
    {PATH(arm.k2), REAL("N m/rad", 1e-6, 1e9), DEFAULT(4.92), TIMED,
     MEANING(
         "stiffness of the middle joint of the two-link beam; each joint of N links has k2 N/2")},
    {PATH(arm.EI), REAL("N m2", 1e-9, 1e12), DEFAULT(DERIVED), TIMED,
     MEANING("bending stiffness of the beam, in place of arm.k2 = 2 EI/length")},
    {PATH(arm.damping_ratio), REAL("", 0, 1), DEFAULT(0),
     MEANING("structural damping ratio of the first clamped-free mode")},

    {PATH(motor.voltage), REAL("V", -1000, 1000), DEFAULT(1), TIMED,
     MEANING("command to the amplifier, held constant")},
    {PATH(motor.voltage_limit), REAL("V", 0, 1000), DEFAULT(10), TIMED,
     MEANING("largest command either way; beyond it the command saturates")},
    {PATH(motor.amplifier_gain), REAL("", 0, 1000), DEFAULT(6.02),
     MEANING("volts at the motor per volt of command")},
    {PATH(motor.torque_constant), REAL("N m/A", 0, 1000), DEFAULT(TORQUE_CONSTANT),
     MEANING("torque per ampere (kT)")},
    {PATH(motor.back_emf), REAL("V s/rad", 0, 1000), DEFAULT(2.443),
     MEANING("back electromotive force (kB)")},
    {PATH(motor.resistance), REAL("ohm", 1e-3, 1e6), DEFAULT(33.6),
     MEANING("armature resistance (Ra)")},
    {PATH(motor.viscous_friction), REAL("N m s/rad", 0, 1000), DEFAULT(5.4192e-3), TIMED,
     MEANING("viscous friction at the hub (kfr)")},
    {PATH(motor.stiction), REAL("N m", 0, 1000), DEFAULT(0.045), TIMED,
     MEANING("Coulomb friction torque at the hub, sliding and sticking (kst)")},

    {PATH(wall.kind), CHOICE(2, "point|plane|none"), DEFAULT(WALL_POINT),
     MEANING("a fixed point the last link's line may not pass, a flat wall the tip may not pass, "
             "or none")},
    {PATH(wall.angle), REAL("rad", -3, 3), DEFAULT(0.1),
     MEANING("direction of contact point or flat wall as seen from the hub axis")},
    {PATH(wall.restitution), REAL("", 0, 1), DEFAULT(0), TIMED,
     MEANING("coefficient of restitution e of an impact (0: plastic)")},

    {PATH(method.name), CHOICE(2, "event|newmark|generalized-alpha"),
     DEFAULTS(METHOD_EVENT, METHOD_NEWMARK), MEANING("time integration")},
    {PATH(method.step), REAL("s", 1e-7, 1), DEFAULT(1e-3),
     MEANING("time step h, and the spacing of the recorded rows")},
    {PATH(method.beta), REAL("", 0.01, 2), DEFAULT(0.4), MEANING("Newmark's beta")},
    {PATH(method.gamma), REAL("", 0, 2), DEFAULT(0.5), MEANING("Newmark's gamma")},
    {PATH(method.spectral_radius), REAL("", 0, 1), DEFAULT(0.8),
     MEANING("what generalised-alpha leaves of the highest modes in one step (rho at infinity)")},
    {PATH(method.rest_speed), REAL("m/s", 0, 1), DEFAULT(1e-4),
     MEANING("rest rule: an impact slower than this is plastic whatever e is")},
    {PATH(method.residual_bound), REAL("", 0, 1), DEFAULT(EVENT_RESIDUAL_BOUND),
     MEANING("share of the energy put in that the ledger may lack before a run counts as "
             "inaccurate (event 1e-6, newmark and generalized-alpha 1e-2)")},

    {PATH(printed.spring_counted_twice), BOOLEAN, DEFAULT(true),
     MEANING("printed model: (2.16) carries the spring k2 that belongs in (2.17) alone")},
    {PATH(printed.force_at_link_end), BOOLEAN, DEFAULT(true),
     MEANING(
         "printed model: the contact force acts at the link's end instead of the contact point")},
    {PATH(printed.sign_dead_band), BOOLEAN, DEFAULT(true),
     MEANING(
         "printed model: sign() takes -0.01 for the lower edge of its dead band instead of -1e-5")},
    {PATH(printed.energy_cross_term), BOOLEAN, DEFAULT(true),
     MEANING("printed model: kinetic energy of the predictor has eps w2 w3 for 2 l eps w2 w3")},
    {PATH(printed.reevaluation), CHOICE(1, "rhs|listing"), DEFAULT(REEVALUATE_RHS),
     MEANING("printed model: where the re-evaluation puts 2 l sin(d) w2 w3, as (3.13) has it or as "
             "the listing has it")},
    {PATH(printed.force_after_release), BOOLEAN, DEFAULT(true),
     MEANING(
         "printed model: the force is evaluated from the constrained system after release too")},
    {PATH(printed.feed_newmark_acceleration), BOOLEAN, DEFAULT(false),
     MEANING("printed model: the next step starts from Newmark's own acceleration, not the "
             "re-evaluated one")},
    {PATH(printed.newton_iterations), INTEGER(1, 100), DEFAULT(2),
     MEANING("printed model: Newton solves per time step")},

    {PATH(initial.angle), REAL("rad", -3, 3), DEFAULT(0),
     MEANING("angle of hub and all links at the start")},
    {PATH(initial.velocity), REAL("rad/s", -1000, 1000), DEFAULT(0),
     MEANING("angular velocity of hub and all links at the start")},

    {PATH(run.duration), REAL("s", 1e-6, 1e5), DEFAULT(1), MEANING("simulated time")},

    {PATH(control.law), CHOICE(LAW_PLUGIN, CONTROL_LAW_CHOICES), DEFAULT(LAW_NONE),
     MEANING("control law on the rig, or none: the bare arm under motor.voltage")},
    {PATH(control.plugin), TEXT(NULL),
     MEANING("shared object with a controller of one's own (control.law = plugin)")},
    {PATH(control.settings), TEXT(NULL),
     MEANING("a plug-in's own parameters, written name=value and separated by spaces")},
    {PATH(control.lock), TEXT("none"), TIMED,
     MEANING("mode that the law is held in, by its name, or none: the law chooses")},
    {PATH(control.rate), REAL("Hz", 1, 1e5), DEFAULT(200), MEANING("samples a second")},
    {PATH(control.delay), REAL("s", 0, 1), DEFAULT(0),
     MEANING("from a sample to the instant its command takes effect, at most one period")},
    {PATH(control.delay_periods), REAL("", 0, 1), DEFAULT(0),
     MEANING(
         "the same in sampling periods, on top of it; 1: a command goes out with the next sample")},
    {PATH(control.jitter), REAL("s", 0, 1), DEFAULT(0),
     MEANING("width over which the sampling instants scatter, at most half a period")},
    {PATH(control.seed), INTEGER(0, 2147483647), DEFAULT(1),
     MEANING("seed of all noise of the rig")},
    {PATH(control.force), REAL("N", 0, 1000), DEFAULT(1), MEANING("commanded contact force")},
    {PATH(control.approach_voltage), REAL("V", -1000, 1000), DEFAULT(1),
     MEANING("constant command of the approach")},
    {PATH(control.kp), REAL("", -1e6, 1e6), DEFAULT(10.15),
     MEANING("position gain, per rad, of a torque in N m or of volts (control.gains)")},
    {PATH(control.kv), REAL("", -1e6, 1e6), DEFAULT(0.75),
     MEANING("velocity gain, per rad/s, of a torque in N m or of volts (control.gains)")},
    {PATH(control.gains), CHOICE(2, "torque|volts|printed"), DEFAULT(0),
     MEANING("hybrid: what kp and kv give; printed: torque in the impact mode and volts in the "
             "force mode")},
    {PATH(control.coefficients), CHOICE(1, "corrected|printed"), DEFAULT(0),
     MEANING("hybrid: factors of its model, 4 k2 and 2 f l, or 6 k2 and 3 f l as printed")},
    {PATH(control.transition_time), REAL("s", 1e-3, 100), DEFAULT(0.35),
     MEANING(
         "hybrid: length of the impact mode (t_f); inverse-dynamics: how long the force rises")},
    {PATH(control.contact_threshold), REAL("N", 0, 1000), DEFAULT(0.05),
     MEANING("force reading that a controller takes for contact")},
    {PATH(control.k2_table), TEXT(NULL),
     MEANING("k2 by commanded force as calibrate measures it, written FORCE:K2 and separated by "
             "spaces")},
    {PATH(control.force_gain), REAL("V/N", -1000, 1000), DEFAULT(1),
     MEANING("gain of the force error")},
    {PATH(control.integral_gain), REAL("V/(N s)", -1e4, 1e4), DEFAULT(5),
     MEANING("gain of the integrated force error")},
    {PATH(control.speed_limit), REAL("rad/s", 0, 1000), DEFAULT(0.3),
     MEANING("speed-limit: hub velocity of the approach")},
    {PATH(control.reverse_time), REAL("s", 0, 10), DEFAULT(0.02),
     MEANING("reverse-torque: how long the motor pulls back after contact")},
    {PATH(control.switch_share), REAL("", 0, 1), DEFAULT(0.5),
     MEANING("bang-bang: share of the way to the wall at which the command is reversed")},
    {PATH(control.force_limit), REAL("N", 0, 1000), DEFAULT(2),
     MEANING("predictive: force that an impact may not exceed wherever it happens")},
    {PATH(control.travel_time), REAL("s", 1e-3, 100), DEFAULT(0.35),
     MEANING("inverse-dynamics: how long the tip moves to the wall")},
    {PATH(control.arrival_speed), REAL("m/s", 0, 1000), DEFAULT(0),
     MEANING("inverse-dynamics: speed with which the tip is to meet the wall")},

    {PATH(belief.links), INTEGER(1, 64), DEFAULT(2),
     MEANING("number of links of the beam in the controller's model, where it can have several")},
    {PATH(belief.mass_factor), REAL("", 0.01, 100), DEFAULT(1),
     MEANING("beam's mass, with its moments of inertia, that the controller believes in, divided "
             "by the true one")},
    {PATH(belief.inertia_factor), REAL("", 0.01, 100), DEFAULT(1),
     MEANING("hub's moment of inertia that the controller believes in, divided by the true one")},
    {PATH(belief.friction_factor), REAL("", 0, 100), DEFAULT(1),
     MEANING("Coulomb and viscous friction that the controller believes in, divided by the true "
             "one")},
    {PATH(belief.torque_factor), REAL("", 0.01, 100), DEFAULT(1),
     MEANING("torque constant kT that the controller believes in, divided by the true one")},
    {PATH(belief.k2_factor), REAL("", 0.01, 100), DEFAULT(1),
     MEANING(
         "k2 that the controller believes in, divided by the arm's (by that of control.k2_table)")},
    {PATH(belief.hub_spring_factor), REAL("", 0.01, 100), DEFAULT(1),
     MEANING("stiffness of the hub's spring that the controller believes in, divided by the true "
             "one (arm.hub_joint = spring)")},
    {PATH(belief.wall_error), REAL("rad", -3, 3), DEFAULT(0),
     MEANING("wall angle that the controller believes in, minus the wall's")},
    {PATH(belief.delay_error), REAL("s", -2, 2), DEFAULT(0),
     MEANING("delay of its commands that the controller believes in, at least 0, minus the true "
             "one")},

    {PATH(sensor.ideal), BOOLEAN, DEFAULT(false),
     MEANING("switches off every imperfection of sensors and converters")},
    {PATH(sensor.force), CHOICE(1, "fsr|piezo"), DEFAULT(FORCE_BY_FSR),
     MEANING("force sensor whose reading the controller gets as the force")},
    {PATH(sensor.encoder_counts), INTEGER(0, 1000000000), DEFAULT(8000),
     MEANING("counts of the encoder per revolution, 0 for a continuous reading")},
    {PATH(sensor.tachometer_gain), REAL("V s/rad", 1e-6, 1000), DEFAULT(2),
     MEANING("volts of the tachometer per hub velocity")},
    {PATH(sensor.tachometer_ripple), REAL("", 0, 1), DEFAULT(0.01),
     MEANING("amplitude of the tachometer's ripple as a share of its reading")},
    {PATH(sensor.tachometer_ripple_count), INTEGER(0, 100000), DEFAULT(79),
     MEANING("ripples a revolution")},
    {PATH(sensor.tachometer_noise), REAL("V", 0, 10), DEFAULT(0.01),
     MEANING("standard deviation of the tachometer's noise")},
    {PATH(sensor.fsr_rise_time), REAL("s", 0, 1), DEFAULT(1.5e-3),
     MEANING("rise time of the force sensor from 10 % to 90 %, 0 for an instant one")},
    {PATH(sensor.fsr_resistance), REAL("ohm", 1, 1e9), DEFAULT(30e3),
     MEANING("resistance of the force sensor at 1 N")},
    {PATH(sensor.fsr_exponent), REAL("", 0.1, 3), DEFAULT(0.75),
     MEANING("exponent of its power law, resistance = fsr_resistance (force/1 N)^-fsr_exponent")},
    {PATH(sensor.fsr_divider), REAL("ohm", 1, 1e9), DEFAULT(40e3),
     MEANING("measuring resistor of the voltage divider (R_M)")},
    {PATH(sensor.fsr_supply), REAL("V", 1e-3, 1000), DEFAULT(5),
     MEANING("voltage across the divider")},
    {PATH(sensor.fsr_gain), REAL("", 1e-3, 1000), DEFAULT(2),
     MEANING("gain of the stage behind the divider, 1 + R5/R6")},
    {PATH(sensor.fsr_saturation), REAL("N", 1e-3, 1e6), DEFAULT(10),
     MEANING("force beyond which the sensor's resistance falls no further")},
    {PATH(sensor.fsr_noise), REAL("V", 0, 10), DEFAULT(0.02),
     MEANING("standard deviation of the force channel's noise")},
    {PATH(sensor.piezo), BOOLEAN, DEFAULT(false),
     MEANING("fits a piezoelectric force sensor at the tip (sensor.force = piezo fits it too)")},
    {PATH(sensor.piezo_gain), REAL("V/N", 1e-6, 1e6), DEFAULT(1),
     MEANING("volts of its charge amplifier per force")},
    {PATH(sensor.piezo_rise_time), REAL("s", 0, 1), DEFAULT(5e-5),
     MEANING(
         "rise time of the piezoelectric force sensor from 10 % to 90 %, 0 for an instant one")},
    {PATH(sensor.piezo_leak_time), REAL("s", 0, 1e6), DEFAULT(5),
     MEANING("time constant with which its charge leaks away, 0 for a charge that stays")},
    {PATH(sensor.piezo_range), REAL("N", 0, 1e6), DEFAULT(10),
     MEANING("force beyond which it is off scale either way, 0 for no such limit")},
    {PATH(sensor.piezo_noise), REAL("V", 0, 10), DEFAULT(5e-3),
     MEANING("standard deviation of the piezoelectric force sensor's noise")},
    {PATH(sensor.film), BOOLEAN, DEFAULT(false),
     MEANING("fits a piezo film along the beam that shows its bending, last link's angle minus the "
             "first's")},
    {PATH(sensor.film_gain), REAL("V/rad", 1e-6, 1e6), DEFAULT(10),
     MEANING("volts of the film's amplifier per bending")},
    {PATH(sensor.film_leak_time), REAL("s", 0, 1e6), DEFAULT(1),
     MEANING("time constant with which the film's charge leaks away, 0 for a charge that stays")},
    {PATH(sensor.film_noise), REAL("V", 0, 10), DEFAULT(0.01),
     MEANING("standard deviation of the film's noise")},
    {PATH(sensor.accelerometer), BOOLEAN, DEFAULT(false),
     MEANING("fits a tangential accelerometer to the hub that shows its angular acceleration")},
    {PATH(sensor.accelerometer_gain), REAL("V s2/rad", 1e-9, 1e6), DEFAULT(0.02),
     MEANING("volts of the accelerometer per angular acceleration of the hub")},
    {PATH(sensor.accelerometer_rise_time), REAL("s", 0, 1), DEFAULT(3.5e-4),
     MEANING("rise time of the accelerometer from 10 % to 90 % (0.35 over its bandwidth), 0 for an "
             "instant one")},
    {PATH(sensor.accelerometer_range), REAL("rad/s2", 0, 1e9), DEFAULT(500),
     MEANING("angular acceleration beyond which it is off scale either way, 0 for no such limit")},
    {PATH(sensor.accelerometer_noise), REAL("V", 0, 10), DEFAULT(5e-3),
     MEANING("standard deviation of the accelerometer's noise")},
    {PATH(sensor.adc_bits), INTEGER(0, 32), DEFAULT(12),
     MEANING("bits of the A/D converter, 0 for a continuous one")},
    {PATH(sensor.dac_bits), INTEGER(0, 32), DEFAULT(12),
     MEANING("bits of the D/A converter, 0 for a continuous one")},
    {PATH(sensor.adc_range), REAL("V", 1e-3, 1000), DEFAULT(10),
     MEANING("range of the A/D converter either way")},
};

const int parameter_count = (int)(sizeof parameter_table / sizeof parameter_table[0]);

_Static_assert(sizeof parameter_table / sizeof parameter_table[0] <= sizeof(((parameters *)0)->set),
               "parameters.set has room for every parameter");

int parameter_at(size_t offset)
{
    int index = 0;
    while (index < parameter_count && parameter_table[index].offset != offset) {
        index++;
    }
    assert(index < parameter_count);
    return index;
}

int parameter_find(const char *path)
{
    assert(path != NULL);
    for (int i = 0; i < parameter_count; i++) {
        if (strcmp(parameter_table[i].path, path) == 0) {
            return i;
        }
    }
    return -1;
}

int parameter_index(const char *path)
{
    int index = parameter_find(path);
    assert(index >= 0);
    return index;
}

// Parameters that have another name now.
static const struct {
    const char *old, *now;
} renamed[] = {
    {"control.k2_factor", "belief.k2_factor"},
    {"control.wall_error", "belief.wall_error"},
};

const char *parameter_renamed(const char *path)
{
    assert(path != NULL);
    for (size_t i = 0; i < sizeof renamed / sizeof renamed[0]; i++) {
        if (strcmp(renamed[i].old, path) == 0) {
            return renamed[i].now;
        }
    }
    return NULL;
}

const char *parameter_suggest(const char *path)
{
    const char *now = parameter_renamed(path);
    if (now != NULL) {
        return now;
    }
    nearest_word nearest = nearest_begin(path);
    for (int i = 0; i < parameter_count; i++) {
        nearest_try(&nearest, parameter_table[i].path);
    }
    return nearest.best;
}

static void store(parameters *p, const parameter_info *info, double value)
{
    char *at = (char *)p + info->offset;
    switch (info->type) {
    case PARAMETER_REAL:
        memcpy(at, &value, sizeof value);
        break;
    case PARAMETER_BOOLEAN: {
        bool truth = value != 0;
        memcpy(at, &truth, sizeof truth);
        break;
    }
    case PARAMETER_INTEGER:
    case PARAMETER_CHOICE: {
        int whole = (int)value;
        memcpy(at, &whole, sizeof whole);
        break;
    }
    case PARAMETER_TEXT:
        memset(at, 0, PARAMETER_TEXT_SIZE);
        snprintf(at, PARAMETER_TEXT_SIZE, "%s", info->choices ? info->choices : "");
        break;
    }
}

// The row of an index that a look-up gave.
static const parameter_info *row_of(int index)
{
    assert(index >= 0 && index < parameter_count);
    return &parameter_table[index];
}

double parameter_get(const parameters *p, int index)
{
    const parameter_info *info = row_of(index);
    const char *at = (const char *)p + info->offset;
    double real;
    bool truth;
    int whole;
    switch (info->type) {
    case PARAMETER_REAL:
        memcpy(&real, at, sizeof real);
        return real;
    case PARAMETER_BOOLEAN:
        memcpy(&truth, at, sizeof truth);
        return truth;
    case PARAMETER_INTEGER:
    case PARAMETER_CHOICE:
        memcpy(&whole, at, sizeof whole);
        return whole;
    case PARAMETER_TEXT:
        return 0;
    }
    return (double)NAN;
}

static double default_value(const parameter_info *info, int model)
{
    return model == ARM_PRINTED ? info->default_printed : info->default_corrected;
}

void parameters_defaults(parameters *p, arm_model_kind model)
{
    memset(p, 0, sizeof *p);
    for (int i = 0; i < parameter_count; i++) {
        store(p, &parameter_table[i], default_value(&parameter_table[i], model));
    }
}

status parameter_set_number(parameters *p, int index, double value, fault *f)
{
    const parameter_info *info = row_of(index);
    const char *unit = info->unit, *space = unit[0] ? " " : "";
    if (info->type == PARAMETER_TEXT) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, info->path, "%s is a text and takes no number",
                            info->path);
    }
    if (!isfinite(value)) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, info->path,
                            "%s is not a finite number, expected %g to %g%s%s", info->path,
                            info->minimum, info->maximum, space, unit);
    }
    if (info->type != PARAMETER_REAL && value != floor(value)) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, info->path, "%s = %g is not a whole number",
                            info->path, value);
    }
    if (value < info->minimum || value > info->maximum) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, info->path,
                            "%s = %g is out of range, expected %g to %g%s%s", info->path, value,
                            info->minimum, info->maximum, space, unit);
    }
    store(p, info, value);
    p->set[index] = 1;
    return STATUS_OK;
}

// Position of text in "a|b|c", or -1.
static int choice_index(const char *choices, const char *text, size_t length)
{
    int index = 0;
    for (const char *c = choices; c != NULL; index++) {
        const char *bar = strchr(c, '|');
        size_t n = bar ? (size_t)(bar - c) : strlen(c);
        if (n == length && strncmp(c, text, n) == 0) {
            return index;
        }
        c = bar ? bar + 1 : NULL;
    }
    return -1;
}

// Reads "0.1" or "0.1 rad" into value; text holds no surrounding space.
static status parse_quantity(const parameter_info *info, const char *text, double *value, fault *f)
{
    const char *unit, *digits = text + strspn(text, "+-.");
    if (!decimal_read(text, value, &unit)) {
        // strtod's own words for what is not finite, with or without YAML's dot
        bool infinite = strncasecmp(digits, "inf", 3) == 0 || strncasecmp(digits, "nan", 3) == 0;
        const char *type = info->type == PARAMETER_INTEGER ? "a whole number" : "a number";
        return fault_set_at(f, STATUS_BAD_SCENARIO, info->path,
                            "%s = '%.60s' is not %s, expected %g to %g%s%s", info->path, text,
                            infinite ? "finite" : type, info->minimum, info->maximum,
                            info->unit[0] ? " " : "", info->unit);
    }
    if (*unit != '\0' && strcmp(unit, info->unit) != 0) {
        if (info->unit[0] == '\0') {
            return fault_set_at(f, STATUS_BAD_SCENARIO, info->path,
                                "%s = '%.60s' carries a unit, expected a pure number", info->path,
                                text);
        }
        return fault_set_at(f, STATUS_BAD_SCENARIO, info->path,
                            "%s = '%.60s' is in '%.20s', expected %s", info->path, text, unit,
                            info->unit);
    }
    return STATUS_OK;
}

// A text of one line is stored as it is.
static status store_text(parameters *p, int index, const char *text, size_t length, fault *f)
{
    const parameter_info *info = row_of(index);
    for (size_t i = 0; i < length; i++) {
        if (iscntrl((unsigned char)text[i])) {
            return fault_set_at(f, STATUS_BAD_SCENARIO, info->path,
                                "%s holds a control character, expected one line of text",
                                info->path);
        }
    }
    char *at = (char *)p + info->offset;
    memset(at, 0, PARAMETER_TEXT_SIZE);
    memcpy(at, text, length);
    p->set[index] = 1;
    return STATUS_OK;
}

// Reads a word without surrounding space as the number of a parameter that is no text.
static status parse_word(const parameter_info *info, const char *word, double *value, fault *f)
{
    size_t length = strlen(word);
    if (info->type == PARAMETER_CHOICE) {
        int choice = choice_index(info->choices, word, length);
        *value = choice;
        return choice >= 0 ? STATUS_OK
                           : fault_set_at(f, STATUS_BAD_SCENARIO, info->path,
                                          "%s = '%.60s' is not known, expected one of %s",
                                          info->path, word, info->choices);
    }
    if (info->type == PARAMETER_BOOLEAN) {
        int choice = choice_index("false|true|no|yes|off|on|0|1", word, length);
        *value = choice % 2;
        return choice >= 0
                   ? STATUS_OK
                   : fault_set_at(f, STATUS_BAD_SCENARIO, info->path,
                                  "%s = '%.60s' is neither true nor false", info->path, word);
    }
    return parse_quantity(info, word, value, f);
}

status parameter_set_text(parameters *p, int index, const char *text, fault *f)
{
    assert(p != NULL && text != NULL);
    const parameter_info *info = row_of(index);

    // what counts is what stands between the blanks
    text += strspn(text, " \t\n\v\f\r");
    size_t length = strlen(text);
    while (length > 0 && isspace((unsigned char)text[length - 1])) {
        length--;
    }
    if (info->type == PARAMETER_TEXT && length < PARAMETER_TEXT_SIZE) {
        return store_text(p, index, text, length, f);
    }

    char word[PARAMETER_TEXT_SIZE];
    if (length == 0 || length >= sizeof word) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, info->path, "%s has %s", info->path,
                            length ? "a value of more than 127 characters" : "no value");
    }
    memcpy(word, text, length);
    word[length] = '\0';

    double value = 0;
    status code = parse_word(info, word, &value, f);
    return code == STATUS_OK ? parameter_set_number(p, index, value, f) : code;
}

void parameter_format(const parameters *p, int index, char *text, size_t size)
{
    const parameter_info *info = row_of(index);
    double value = parameter_get(p, index);
    if (info->type == PARAMETER_TEXT) {
        snprintf(text, size, "%s", (const char *)p + info->offset);
    } else if (info->type == PARAMETER_BOOLEAN) {
        snprintf(text, size, "%s", value != 0 ? "true" : "false");
    } else if (info->type == PARAMETER_CHOICE) {
        const char *c = info->choices;
        for (int i = 0; i < (int)value; i++) {
            c = strchr(c, '|') + 1;
        }
        snprintf(text, size, "%.*s", (int)strcspn(c, "|"), c);
    } else if (info->type == PARAMETER_INTEGER) {
        snprintf(text, size, "%d", (int)value);
    } else {
        char number[NUMBER_TEXT];
        number_format_short(number, value);
        snprintf(text, size, "%s", number);
    }
}

// Whether the parameter of a field was given.
#define IS_SET(p, field) ((p)->set[PARAMETER_INDEX(field)] != 0)

// The path of the first of some parameters, ended by -1, that was given: of those that contradict
// one another it is the one to blame. "" if all are defaults.
static const char *first_given(const parameters *p, const int *indices)
{
    for (; *indices >= 0; indices++) {
        if (p->set[*indices]) {
            return parameter_table[*indices].path;
        }
    }
    return "";
}

// A fault that several parameters make together, in the order in which they are to blame.
#define BLAME1(p, a)    first_given(p, (const int[]){PARAMETER_INDEX(a), -1})
#define BLAME2(p, a, b) first_given(p, (const int[]){PARAMETER_INDEX(a), PARAMETER_INDEX(b), -1})
#define BLAME3(p, a, b, c)                                                                         \
    first_given(p, (const int[]){PARAMETER_INDEX(a), PARAMETER_INDEX(b), PARAMETER_INDEX(c), -1})

// What was not given follows the model, and the inertia of a link its shape.
static void resolve_defaults(parameters *p)
{
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        if (!p->set[i] && i != PARAMETER_INDEX(arm.model)) {
            store(p, info, default_value(info, p->arm.model));
        }
    }
    if (!IS_SET(p, method.residual_bound) && p->method.name != METHOD_EVENT) {
        p->method.residual_bound = STUDY_RESIDUAL_BOUND;
    }
}

// Half a cell of beam, length/(2 N), lies between the hub and the middle of the first link.
static double root_stiffness(const arm_parameters *a)
{
    return a->k2 * a->links;
}

void parameters_follow(parameters *p, int index)
{
    assert(p != NULL);
    arm_parameters *a = &p->arm;
    if (index == PARAMETER_INDEX(arm.k2)) {
        a->EI = a->k2 * a->length / 2;
    } else if (index == PARAMETER_INDEX(arm.EI)) {
        a->k2 = 2 * a->EI / a->length;
    }
    a->k1 = a->hub_joint == HUB_BEAM ? root_stiffness(a) : a->k1;
}

// The beam's stiffness is given once, and with it that of its root.
static status resolve_stiffness(parameters *p, fault *f)
{
    if (IS_SET(p, arm.EI) && IS_SET(p, arm.k2)) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, arm.EI),
                            "arm.EI and arm.k2 = 2 EI/length are both given, expected one of them");
    }
    if (p->arm.hub_joint == HUB_BEAM && IS_SET(p, arm.k1)) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, arm.k1),
                            "arm.k1 is for arm.hub_joint = spring, but with beam the root has the "
                            "spring k2 N = %g N m/rad",
                            root_stiffness(&p->arm));
    }
    parameters_follow(p, IS_SET(p, arm.EI) ? PARAMETER_INDEX(arm.EI) : PARAMETER_INDEX(arm.k2));
    return STATUS_OK;
}

static status resolve_arm(parameters *p, fault *f)
{
    if (IS_SET(p, arm.link_inertia) && p->arm.links != 2) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, arm.link_inertia, arm.links),
                            "arm.link_inertia is for two links only, but arm.links = %d (other N "
                            "take the inertia of a uniform rod)",
                            p->arm.links);
    }
    if (isnan(p->arm.link_inertia)) {
        double m = p->arm.mass / p->arm.links, l = p->arm.length / p->arm.links;
        p->arm.link_inertia = m * l * l / 12; // uniform rod (errata B3)
    }
    if (resolve_stiffness(p, f) != STATUS_OK) {
        return STATUS_BAD_SCENARIO;
    }
    if (p->wall.kind != WALL_NONE && p->initial.angle > p->wall.angle) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, initial.angle, wall.angle),
            "initial.angle = %g rad lies behind the wall, expected at most wall.angle = "
            "%g rad",
            p->initial.angle, p->wall.angle);
    }
    return STATUS_OK;
}

static status check_control(const parameters *p, fault *f)
{
    const control_parameters *c = &p->control;
    double period = 1 / c->rate;
    if (c->law == LAW_PLUGIN && c->plugin[0] == '\0') {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, control.law, control.plugin),
            "control.law = plugin needs the file of a shared object in control.plugin");
    }
    if (c->delay * c->rate > 1) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, control.delay, control.rate),
                            "control.delay = %g s is longer than the period of %g s (control.rate)",
                            c->delay, period);
    }
    if (c->delay * c->rate + c->delay_periods > 1) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME3(p, control.delay_periods, control.delay, control.rate),
            "control.delay_periods = %g and control.delay = %g s are together longer than the "
            "period of %g s (control.rate)",
            c->delay_periods, c->delay, period);
    }
    k2_table table;
    if (k2_table_read(&table, c->k2_table, f) != STATUS_OK) {
        return STATUS_BAD_SCENARIO;
    }
    if (c->jitter * c->rate > 0.5) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, control.jitter, control.rate),
            "control.jitter = %g s is more than half the period of %g s (control.rate)", c->jitter,
            period);
    }
    return STATUS_OK;
}

// A controller that is to get the piezoelectric sensor's force needs one that shows something.
static status resolve_piezo(parameters *p, fault *f)
{
    if (p->sensor.force == FORCE_BY_PIEZO && !IS_SET(p, sensor.piezo)) {
        p->sensor.piezo = true;
    }
    if (p->sensor.force == FORCE_BY_PIEZO && !p->sensor.piezo) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, sensor.force, sensor.piezo),
            "sensor.force = piezo needs the sensor that sensor.piezo = false leaves out");
    }
    double leak = p->sensor.piezo_leak_time;
    if (leak > 0 && leak < p->sensor.piezo_rise_time) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, sensor.piezo_leak_time, sensor.piezo_rise_time),
            "sensor.piezo_leak_time = %g s is shorter than sensor.piezo_rise_time = %g "
            "s, expected a longer one or 0",
            leak, p->sensor.piezo_rise_time);
    }
    return STATUS_OK;
}

// The printed equations hold for one arm and one method.
static status check_printed(const parameters *p, fault *f)
{
    if (p->arm.links != 2) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, arm.links),
                            "the printed model has two links, but arm.links = %d", p->arm.links);
    }
    if (p->arm.hub_joint != HUB_SPRING) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, arm.hub_joint),
                            "the printed model has a hub spring, but arm.hub_joint = %s",
                            p->arm.hub_joint == HUB_BEAM ? "beam" : "rigid");
    }
    if (p->method.name != METHOD_NEWMARK) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, method.name),
                            "the printed model runs with method.name = newmark only");
    }
    if (p->wall.kind == WALL_PLANE) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, wall.kind),
                            "the printed model knows wall.kind = point or none, not plane");
    }
    return STATUS_OK;
}

status parameters_resolve(parameters *p, fault *f)
{
    assert(p != NULL);
    resolve_defaults(p);
    status code = resolve_arm(p, f);
    code = code == STATUS_OK ? check_control(p, f) : code;
    code = code == STATUS_OK ? resolve_piezo(p, f) : code;
    return code == STATUS_OK && p->arm.model == ARM_PRINTED ? check_printed(p, f) : code;
}
