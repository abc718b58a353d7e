#include "src/quantities/parameters.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "src/quantities/k2_table.h"
#include "src/base/words.h"
#include "src/base/numbers.h"

#define AT(field) offsetof(parameters, field)
#define REAL      PARAMETER_REAL
#define INTEGER   PARAMETER_INTEGER
#define BOOLEAN   PARAMETER_BOOLEAN
#define CHOICE    PARAMETER_CHOICE
#define TEXT      PARAMETER_TEXT
#define DERIVED   (double)NAN // the default follows from other parameters, see parameters_resolve
#define TIMED     true
#define NOT_TIMED false

// k1 with which the printed model reproduces the thesis's tables. The thesis prints
// 169 468 N m/rad, with which its own algorithm at h = 1 ms chatters; 90 lies in the range
// 85-100 that matches Tables 4.1-4.3 best (docs/physics.md, hidden constants).
#define K1_PRINTED_TABLES 90.0
#define K1_THESIS         169468.0882

// kT is printed as 0.249092 kg m/A; one kilogram-force is 9.80665 N.
#define TORQUE_CONSTANT (0.249092 * 9.80665)

const parameter_info parameter_table[] = {
    // path, unit, type, offset, default (corrected), default (printed), min, max, choices, timed,
    // description
    {"arm.model", "", CHOICE, AT(arm.model), ARM_CORRECTED, ARM_PRINTED, 0, 1, "corrected|printed",
     NOT_TIMED, "equations of motion: derived anew, or as the thesis prints them"},
    {"arm.links", "", INTEGER, AT(arm.links), 2, 2, 1, 1024, NULL, NOT_TIMED,
     "number of rigid links the beam is cut into (N)"},
    {"arm.hub_joint", "", CHOICE, AT(arm.hub_joint), HUB_RIGID, HUB_SPRING, 0, 1, "rigid|spring",
     NOT_TIMED, "joint between hub and first link: one body, or the spring k1"},
    {"arm.length", "m", REAL, AT(arm.length), 1.0, 1.0, 0.01, 100, NULL, NOT_TIMED,
     "length of the beam, all links together"},
    {"arm.mass", "kg", REAL, AT(arm.mass), 0.40108, 0.40108, 1e-4, 1e4, NULL, NOT_TIMED,
     "mass of the beam, all links together"},
    {"arm.hub_inertia", "kg m2", REAL, AT(arm.hub_inertia), 5.2e-3, 5.2e-3, 0, 1e4, NULL, NOT_TIMED,
     "moment of inertia of hub and motor shaft (I1)"},
    {"arm.link_inertia", "kg m2", REAL, AT(arm.link_inertia), DERIVED, 1.67e-5, 0, 1e4, NULL,
     NOT_TIMED, "moment of inertia of a link about its centre of mass (I2 = I3, N = 2 only)"},
    {"arm.k1", "N m/rad", REAL, AT(arm.k1), K1_THESIS, K1_PRINTED_TABLES, 1e-6, 1e9, NULL, TIMED,
     "stiffness of the hub joint (arm.hub_joint = spring)"},
    {"arm.k2", "N m/rad", REAL, AT(arm.k2), 4.92, 4.92, 1e-6, 1e9, NULL, TIMED,
     "stiffness of the middle joint of the two-link beam; each joint of N links has k2 N/2"},
    {"arm.damping_ratio", "", REAL, AT(arm.damping_ratio), 0, 0, 0, 1, NULL, NOT_TIMED,
     "structural damping ratio of the first clamped-free mode"},
    {"motor.voltage", "V", REAL, AT(motor.voltage), 1, 1, -1000, 1000, NULL, TIMED,
     "command to the amplifier, held constant"},
    {"motor.voltage_limit", "V", REAL, AT(motor.voltage_limit), 10, 10, 0, 1000, NULL, TIMED,
     "largest command either way; beyond it the command saturates"},
    {"motor.amplifier_gain", "", REAL, AT(motor.amplifier_gain), 6.02, 6.02, 0, 1000, NULL,
     NOT_TIMED, "volts at the motor per volt of command"},
    {"motor.torque_constant", "N m/A", REAL, AT(motor.torque_constant), TORQUE_CONSTANT,
     TORQUE_CONSTANT, 0, 1000, NULL, NOT_TIMED, "torque per ampere (kT)"},
    {"motor.back_emf", "V s/rad", REAL, AT(motor.back_emf), 2.443, 2.443, 0, 1000, NULL, NOT_TIMED,
     "back electromotive force (kB)"},
    {"motor.resistance", "ohm", REAL, AT(motor.resistance), 33.6, 33.6, 1e-3, 1e6, NULL, NOT_TIMED,
     "armature resistance (Ra)"},
    {"motor.viscous_friction", "N m s/rad", REAL, AT(motor.viscous_friction), 5.4192e-3, 5.4192e-3,
     0, 1000, NULL, TIMED, "viscous friction at the hub (kfr)"},
    {"motor.stiction", "N m", REAL, AT(motor.stiction), 0.045, 0.045, 0, 1000, NULL, TIMED,
     "Coulomb friction torque at the hub, sliding and sticking (kst)"},
    {"wall.kind", "", CHOICE, AT(wall.kind), WALL_POINT, WALL_POINT, 0, 2, "point|plane|none",
     NOT_TIMED,
     "a fixed point the last link's line may not pass, a flat wall the tip may not pass, or none"},
    {"wall.angle", "rad", REAL, AT(wall.angle), 0.1, 0.1, -3, 3, NULL, NOT_TIMED,
     "direction of contact point or flat wall as seen from the hub axis"},
    {"wall.restitution", "", REAL, AT(wall.restitution), 0, 0, 0, 1, NULL, TIMED,
     "coefficient of restitution e of an impact (0: plastic)"},
    {"method.name", "", CHOICE, AT(method.name), METHOD_EVENT, METHOD_NEWMARK, 0, 2,
     "event|newmark|generalized-alpha", NOT_TIMED, "time integration"},
    {"method.step", "s", REAL, AT(method.step), 1e-3, 1e-3, 1e-7, 1, NULL, NOT_TIMED,
     "time step h, and the spacing of the recorded rows"},
    {"method.beta", "", REAL, AT(method.beta), 0.4, 0.4, 0.01, 2, NULL, NOT_TIMED,
     "Newmark's beta"},
    {"method.gamma", "", REAL, AT(method.gamma), 0.5, 0.5, 0, 2, NULL, NOT_TIMED,
     "Newmark's gamma"},
    {"method.spectral_radius", "", REAL, AT(method.spectral_radius), 0.8, 0.8, 0, 1, NULL,
     NOT_TIMED, "what generalised-alpha leaves of the highest modes in one step (rho at infinity)"},
    {"method.rest_speed", "m/s", REAL, AT(method.rest_speed), 1e-4, 1e-4, 0, 1, NULL, NOT_TIMED,
     "rest rule: an impact slower than this is plastic whatever e is"},
    {"printed.spring_counted_twice", "", BOOLEAN, AT(printed.spring_counted_twice), 1, 1, 0, 1,
     NULL, NOT_TIMED, "printed model: (2.16) carries the spring k2 that belongs in (2.17) alone"},
    {"printed.force_at_link_end", "", BOOLEAN, AT(printed.force_at_link_end), 1, 1, 0, 1, NULL,
     NOT_TIMED,
     "printed model: the contact force acts at the link's end instead of the contact point"},
    {"printed.sign_dead_band", "", BOOLEAN, AT(printed.sign_dead_band), 1, 1, 0, 1, NULL, NOT_TIMED,
     "printed model: sign() takes -0.01 for the lower edge of its dead band instead of -1e-5"},
    {"printed.energy_cross_term", "", BOOLEAN, AT(printed.energy_cross_term), 1, 1, 0, 1, NULL,
     NOT_TIMED, "printed model: kinetic energy of the predictor has eps w2 w3 for 2 l eps w2 w3"},
    {"printed.reevaluation", "", CHOICE, AT(printed.reevaluation), REEVALUATE_RHS, REEVALUATE_RHS,
     0, 1, "rhs|listing", NOT_TIMED,
     "printed model: where the re-evaluation puts 2 l sin(d) w2 w3, as (3.13) has it or as the "
     "listing has it"},
    {"printed.force_after_release", "", BOOLEAN, AT(printed.force_after_release), 1, 1, 0, 1, NULL,
     NOT_TIMED,
     "printed model: the force is evaluated from the constrained system after release too"},
    {"printed.feed_newmark_acceleration", "", BOOLEAN, AT(printed.feed_newmark_acceleration), 0, 0,
     0, 1, NULL, NOT_TIMED,
     "printed model: the next step starts from Newmark's own acceleration, not the re-evaluated "
     "one"},
    {"printed.newton_iterations", "", INTEGER, AT(printed.newton_iterations), 2, 2, 1, 100, NULL,
     NOT_TIMED, "printed model: Newton solves per time step"},
    {"initial.angle", "rad", REAL, AT(initial.angle), 0, 0, -3, 3, NULL, NOT_TIMED,
     "angle of hub and all links at the start"},
    {"initial.velocity", "rad/s", REAL, AT(initial.velocity), 0, 0, -1000, 1000, NULL, NOT_TIMED,
     "angular velocity of hub and all links at the start"},
    {"run.duration", "s", REAL, AT(run.duration), 1, 1, 1e-6, 1e5, NULL, NOT_TIMED,
     "simulated time"},
    {"control.law", "", CHOICE, AT(control.law), LAW_NONE, LAW_NONE, 0, LAW_PLUGIN,
     CONTROL_LAW_CHOICES, NOT_TIMED,
     "control law on the rig, or none: the bare arm under motor.voltage"},
    {"control.plugin", "", TEXT, AT(control.plugin), 0, 0, 0, 1, NULL, NOT_TIMED,
     "shared object with a controller of one's own (control.law = plugin)"},
    {"control.settings", "", TEXT, AT(control.settings), 0, 0, 0, 1, NULL, NOT_TIMED,
     "a plug-in's own parameters, written name=value and separated by spaces"},
    {"control.lock", "", TEXT, AT(control.lock), 0, 0, 0, 1, "none", TIMED,
     "mode that the law is held in, by its name, or none: the law chooses"},
    {"control.rate", "Hz", REAL, AT(control.rate), 200, 200, 1, 1e5, NULL, NOT_TIMED,
     "samples a second"},
    {"control.delay", "s", REAL, AT(control.delay), 0, 0, 0, 1, NULL, NOT_TIMED,
     "from a sample to the instant its command takes effect, at most one period"},
    {"control.delay_periods", "", REAL, AT(control.delay_periods), 0, 0, 0, 1, NULL, NOT_TIMED,
     "the same in sampling periods, on top of it; 1: a command goes out with the next sample"},
    {"control.jitter", "s", REAL, AT(control.jitter), 0, 0, 0, 1, NULL, NOT_TIMED,
     "width over which the sampling instants scatter, at most half a period"},
    {"control.seed", "", INTEGER, AT(control.seed), 1, 1, 0, 2147483647, NULL, NOT_TIMED,
     "seed of all noise of the rig"},
    {"control.force", "N", REAL, AT(control.force), 1, 1, 0, 1000, NULL, NOT_TIMED,
     "commanded contact force"},
    {"control.approach_voltage", "V", REAL, AT(control.approach_voltage), 1, 1, -1000, 1000, NULL,
     NOT_TIMED, "constant command of the approach"},
    {"control.kp", "", REAL, AT(control.kp), 10.15, 10.15, -1e6, 1e6, NULL, NOT_TIMED,
     "position gain, per rad, of a torque in N m or of volts (control.gains)"},
    {"control.kv", "", REAL, AT(control.kv), 0.75, 0.75, -1e6, 1e6, NULL, NOT_TIMED,
     "velocity gain, per rad/s, of a torque in N m or of volts (control.gains)"},
    {"control.gains", "", CHOICE, AT(control.gains), 0, 0, 0, 2, "torque|volts|printed", NOT_TIMED,
     "hybrid: what kp and kv give; printed: torque in the impact mode and volts in the force mode"},
    {"control.coefficients", "", CHOICE, AT(control.coefficients), 0, 0, 0, 1, "corrected|printed",
     NOT_TIMED, "hybrid: factors of its model, 4 k2 and 2 f l, or 6 k2 and 3 f l as printed"},
    {"control.transition_time", "s", REAL, AT(control.transition_time), 0.35, 0.35, 1e-3, 100, NULL,
     NOT_TIMED,
     "hybrid: length of the impact mode (t_f); inverse-dynamics: how long the force rises"},
    {"control.contact_threshold", "N", REAL, AT(control.contact_threshold), 0.05, 0.05, 0, 1000,
     NULL, NOT_TIMED, "force reading that a controller takes for contact"},
    {"control.k2_factor", "", REAL, AT(control.k2_factor), 1, 1, 0.01, 100, NULL, NOT_TIMED,
     "k2 that the controller believes in, divided by the arm's (by that of control.k2_table)"},
    {"control.k2_table", "", TEXT, AT(control.k2_table), 0, 0, 0, 1, NULL, NOT_TIMED,
     "k2 by commanded force as calibrate measures it, written FORCE:K2 and separated by spaces"},
    {"control.wall_error", "rad", REAL, AT(control.wall_error), 0, 0, -3, 3, NULL, NOT_TIMED,
     "wall angle that the controller believes in, minus the wall's"},
    {"control.force_gain", "V/N", REAL, AT(control.force_gain), 1, 1, -1000, 1000, NULL, NOT_TIMED,
     "gain of the force error"},
    {"control.integral_gain", "V/(N s)", REAL, AT(control.integral_gain), 5, 5, -1e4, 1e4, NULL,
     NOT_TIMED, "gain of the integrated force error"},
    {"control.speed_limit", "rad/s", REAL, AT(control.speed_limit), 0.3, 0.3, 0, 1000, NULL,
     NOT_TIMED, "speed-limit: hub velocity of the approach"},
    {"control.reverse_time", "s", REAL, AT(control.reverse_time), 0.02, 0.02, 0, 10, NULL,
     NOT_TIMED, "reverse-torque: how long the motor pulls back after contact"},
    {"control.switch_share", "", REAL, AT(control.switch_share), 0.5, 0.5, 0, 1, NULL, NOT_TIMED,
     "bang-bang: share of the way to the wall at which the command is reversed"},
    {"control.force_limit", "N", REAL, AT(control.force_limit), 2, 2, 0, 1000, NULL, NOT_TIMED,
     "predictive: force that an impact may not exceed wherever it happens"},
    {"control.travel_time", "s", REAL, AT(control.travel_time), 0.35, 0.35, 1e-3, 100, NULL,
     NOT_TIMED, "inverse-dynamics: how long the tip moves to the wall"},
    {"control.arrival_speed", "m/s", REAL, AT(control.arrival_speed), 0, 0, 0, 1000, NULL,
     NOT_TIMED, "inverse-dynamics: speed with which the tip is to meet the wall"},
    {"sensor.ideal", "", BOOLEAN, AT(sensor.ideal), 0, 0, 0, 1, NULL, NOT_TIMED,
     "switches off every imperfection of sensors and converters"},
    {"sensor.force", "", CHOICE, AT(sensor.force), FORCE_BY_FSR, FORCE_BY_FSR, 0, 1, "fsr|piezo",
     NOT_TIMED, "force sensor whose reading the controller gets as the force"},
    {"sensor.encoder_counts", "", INTEGER, AT(sensor.encoder_counts), 8000, 8000, 0, 1000000000,
     NULL, NOT_TIMED, "counts of the encoder per revolution, 0 for a continuous reading"},
    {"sensor.tachometer_gain", "V s/rad", REAL, AT(sensor.tachometer_gain), 2, 2, 1e-6, 1000, NULL,
     NOT_TIMED, "volts of the tachometer per hub velocity"},
    {"sensor.tachometer_ripple", "", REAL, AT(sensor.tachometer_ripple), 0.01, 0.01, 0, 1, NULL,
     NOT_TIMED, "amplitude of the tachometer's ripple as a share of its reading"},
    {"sensor.tachometer_ripple_count", "", INTEGER, AT(sensor.tachometer_ripple_count), 79, 79, 0,
     100000, NULL, NOT_TIMED, "ripples a revolution"},
    {"sensor.tachometer_noise", "V", REAL, AT(sensor.tachometer_noise), 0.01, 0.01, 0, 10, NULL,
     NOT_TIMED, "standard deviation of the tachometer's noise"},
    {"sensor.fsr_rise_time", "s", REAL, AT(sensor.fsr_rise_time), 1.5e-3, 1.5e-3, 0, 1, NULL,
     NOT_TIMED, "rise time of the force sensor from 10 % to 90 %, 0 for an instant one"},
    {"sensor.fsr_resistance", "ohm", REAL, AT(sensor.fsr_resistance), 30e3, 30e3, 1, 1e9, NULL,
     NOT_TIMED, "resistance of the force sensor at 1 N"},
    {"sensor.fsr_exponent", "", REAL, AT(sensor.fsr_exponent), 0.75, 0.75, 0.1, 3, NULL, NOT_TIMED,
     "exponent of its power law, resistance = fsr_resistance (force/1 N)^-fsr_exponent"},
    {"sensor.fsr_divider", "ohm", REAL, AT(sensor.fsr_divider), 40e3, 40e3, 1, 1e9, NULL, NOT_TIMED,
     "measuring resistor of the voltage divider (R_M)"},
    {"sensor.fsr_supply", "V", REAL, AT(sensor.fsr_supply), 5, 5, 1e-3, 1000, NULL, NOT_TIMED,
     "voltage across the divider"},
    {"sensor.fsr_gain", "", REAL, AT(sensor.fsr_gain), 2, 2, 1e-3, 1000, NULL, NOT_TIMED,
     "gain of the stage behind the divider, 1 + R5/R6"},
    {"sensor.fsr_saturation", "N", REAL, AT(sensor.fsr_saturation), 10, 10, 1e-3, 1e6, NULL,
     NOT_TIMED, "force beyond which the sensor's resistance falls no further"},
    {"sensor.fsr_noise", "V", REAL, AT(sensor.fsr_noise), 0.02, 0.02, 0, 10, NULL, NOT_TIMED,
     "standard deviation of the force channel's noise"},
    {"sensor.piezo", "", BOOLEAN, AT(sensor.piezo), 0, 0, 0, 1, NULL, NOT_TIMED,
     "fits a piezoelectric force sensor at the tip (sensor.force = piezo fits it too)"},
    {"sensor.piezo_gain", "V/N", REAL, AT(sensor.piezo_gain), 1, 1, 1e-6, 1e6, NULL, NOT_TIMED,
     "volts of its charge amplifier per force"},
    {"sensor.piezo_rise_time", "s", REAL, AT(sensor.piezo_rise_time), 5e-5, 5e-5, 0, 1, NULL,
     NOT_TIMED,
     "rise time of the piezoelectric force sensor from 10 % to 90 %, 0 for an instant one"},
    {"sensor.piezo_leak_time", "s", REAL, AT(sensor.piezo_leak_time), 5, 5, 0, 1e6, NULL, NOT_TIMED,
     "time constant with which its charge leaks away, 0 for a charge that stays"},
    {"sensor.piezo_range", "N", REAL, AT(sensor.piezo_range), 10, 10, 0, 1e6, NULL, NOT_TIMED,
     "force beyond which it is off scale either way, 0 for no such limit"},
    {"sensor.piezo_noise", "V", REAL, AT(sensor.piezo_noise), 5e-3, 5e-3, 0, 10, NULL, NOT_TIMED,
     "standard deviation of the piezoelectric force sensor's noise"},
    {"sensor.film", "", BOOLEAN, AT(sensor.film), 0, 0, 0, 1, NULL, NOT_TIMED,
     "fits a piezo film along the beam that shows its bending, last link's angle minus the "
     "first's"},
    {"sensor.film_gain", "V/rad", REAL, AT(sensor.film_gain), 10, 10, 1e-6, 1e6, NULL, NOT_TIMED,
     "volts of the film's amplifier per bending"},
    {"sensor.film_leak_time", "s", REAL, AT(sensor.film_leak_time), 1, 1, 0, 1e6, NULL, NOT_TIMED,
     "time constant with which the film's charge leaks away, 0 for a charge that stays"},
    {"sensor.film_noise", "V", REAL, AT(sensor.film_noise), 0.01, 0.01, 0, 10, NULL, NOT_TIMED,
     "standard deviation of the film's noise"},
    {"sensor.accelerometer", "", BOOLEAN, AT(sensor.accelerometer), 0, 0, 0, 1, NULL, NOT_TIMED,
     "fits a tangential accelerometer to the hub that shows its angular acceleration"},
    {"sensor.accelerometer_gain", "V s2/rad", REAL, AT(sensor.accelerometer_gain), 0.02, 0.02, 1e-9,
     1e6, NULL, NOT_TIMED, "volts of the accelerometer per angular acceleration of the hub"},
    {"sensor.accelerometer_rise_time", "s", REAL, AT(sensor.accelerometer_rise_time), 3.5e-4,
     3.5e-4, 0, 1, NULL, NOT_TIMED,
     "rise time of the accelerometer from 10 % to 90 % (0.35 over its bandwidth), 0 for an instant "
     "one"},
    {"sensor.accelerometer_range", "rad/s2", REAL, AT(sensor.accelerometer_range), 500, 500, 0, 1e9,
     NULL, NOT_TIMED,
     "angular acceleration beyond which it is off scale either way, 0 for no such limit"},
    {"sensor.accelerometer_noise", "V", REAL, AT(sensor.accelerometer_noise), 5e-3, 5e-3, 0, 10,
     NULL, NOT_TIMED, "standard deviation of the accelerometer's noise"},
    {"sensor.adc_bits", "", INTEGER, AT(sensor.adc_bits), 12, 12, 0, 32, NULL, NOT_TIMED,
     "bits of the A/D converter, 0 for a continuous one"},
    {"sensor.dac_bits", "", INTEGER, AT(sensor.dac_bits), 12, 12, 0, 32, NULL, NOT_TIMED,
     "bits of the D/A converter, 0 for a continuous one"},
    {"sensor.adc_range", "V", REAL, AT(sensor.adc_range), 10, 10, 1e-3, 1000, NULL, NOT_TIMED,
     "range of the A/D converter either way"},
};

const int parameter_count = (int)(sizeof parameter_table / sizeof parameter_table[0]);

_Static_assert(sizeof parameter_table / sizeof parameter_table[0] <= sizeof(((parameters *)0)->set),
               "parameters.set has room for every parameter");

int parameter_find(const char *path)
{
    for (int i = 0; i < parameter_count; i++) {
        if (strcmp(parameter_table[i].path, path) == 0) {
            return i;
        }
    }
    return -1;
}

const char *parameter_suggest(const char *path)
{
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

double parameter_get(const parameters *p, int index)
{
    const parameter_info *info = &parameter_table[index];
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
    const parameter_info *info = &parameter_table[index];
    const char *unit = info->unit, *space = unit[0] ? " " : "";
    if (info->type == PARAMETER_TEXT) {
        return fault_set(f, STATUS_BAD_SCENARIO, "%s is a text and takes no number", info->path);
    }
    if (!isfinite(value)) {
        return fault_set(f, STATUS_BAD_SCENARIO, "%s is not a finite number, expected %g to %g%s%s",
                         info->path, info->minimum, info->maximum, space, unit);
    }
    if (info->type != PARAMETER_REAL && value != floor(value)) {
        return fault_set(f, STATUS_BAD_SCENARIO, "%s = %g is not a whole number", info->path,
                         value);
    }
    if (value < info->minimum || value > info->maximum) {
        return fault_set(f, STATUS_BAD_SCENARIO, "%s = %g is out of range, expected %g to %g%s%s",
                         info->path, value, info->minimum, info->maximum, space, unit);
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
        return fault_set(f, STATUS_BAD_SCENARIO, "%s = '%.60s' is not %s, expected %g to %g%s%s",
                         info->path, text, infinite ? "finite" : type, info->minimum, info->maximum,
                         info->unit[0] ? " " : "", info->unit);
    }
    if (*unit != '\0' && strcmp(unit, info->unit) != 0) {
        if (info->unit[0] == '\0') {
            return fault_set(f, STATUS_BAD_SCENARIO,
                             "%s = '%.60s' carries a unit, expected a pure number", info->path,
                             text);
        }
        return fault_set(f, STATUS_BAD_SCENARIO, "%s = '%.60s' is in '%.20s', expected %s",
                         info->path, text, unit, info->unit);
    }
    return STATUS_OK;
}

status parameter_set_text(parameters *p, int index, const char *text, fault *f)
{
    const parameter_info *info = &parameter_table[index];
    while (isspace((unsigned char)*text)) {
        text++;
    }
    size_t length = strlen(text);
    while (length > 0 && isspace((unsigned char)text[length - 1])) {
        length--;
    }
    char word[PARAMETER_TEXT_SIZE];
    if (info->type == PARAMETER_TEXT && length < sizeof word) {
        for (size_t i = 0; i < length; i++) {
            if (iscntrl((unsigned char)text[i])) {
                return fault_set(f, STATUS_BAD_SCENARIO,
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
    if (length == 0 || length >= sizeof word) {
        return fault_set(f, STATUS_BAD_SCENARIO, "%s has %s", info->path,
                         length ? "a value of more than 127 characters" : "no value");
    }
    memcpy(word, text, length);
    word[length] = '\0';
    double value = 0;
    if (info->type == PARAMETER_CHOICE) {
        int choice = choice_index(info->choices, word, length);
        if (choice < 0) {
            return fault_set(f, STATUS_BAD_SCENARIO,
                             "%s = '%.60s' is not known, expected one of %s", info->path, word,
                             info->choices);
        }
        value = choice;
    } else if (info->type == PARAMETER_BOOLEAN) {
        int choice = choice_index("false|true|no|yes|off|on|0|1", word, length);
        if (choice < 0) {
            return fault_set(f, STATUS_BAD_SCENARIO, "%s = '%.60s' is neither true nor false",
                             info->path, word);
        }
        value = choice % 2;
    } else {
        status s = parse_quantity(info, word, &value, f);
        if (s != STATUS_OK) {
            return s;
        }
    }
    return parameter_set_number(p, index, value, f);
}

void parameter_format(const parameters *p, int index, char *text, size_t size)
{
    const parameter_info *info = &parameter_table[index];
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

static bool is_set(const parameters *p, const char *path)
{
    return p->set[parameter_find(path)] != 0;
}

// A controller that is to get the piezoelectric sensor's force needs one that shows something.
static status resolve_piezo(parameters *p, fault *f)
{
    if (p->sensor.force == FORCE_BY_PIEZO && !is_set(p, "sensor.piezo")) {
        p->sensor.piezo = true;
    }
    if (p->sensor.force == FORCE_BY_PIEZO && !p->sensor.piezo) {
        return fault_set(
            f, STATUS_BAD_SCENARIO,
            "sensor.force = piezo needs the sensor that sensor.piezo = false leaves out");
    }
    double leak = p->sensor.piezo_leak_time;
    if (leak > 0 && leak < p->sensor.piezo_rise_time) {
        return fault_set(
            f, STATUS_BAD_SCENARIO,
            "sensor.piezo_leak_time = %g s is shorter than sensor.piezo_rise_time = %g "
            "s, expected a longer one or 0",
            leak, p->sensor.piezo_rise_time);
    }
    return STATUS_OK;
}

status parameters_resolve(parameters *p, fault *f)
{
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        if (!p->set[i] && strcmp(info->path, "arm.model") != 0) {
            store(p, info, default_value(info, p->arm.model));
        }
    }
    if (is_set(p, "arm.link_inertia") && p->arm.links != 2) {
        return fault_set(f, STATUS_BAD_SCENARIO,
                         "arm.link_inertia is for two links only, but arm.links = %d (other N take "
                         "the inertia of a uniform rod)",
                         p->arm.links);
    }
    if (isnan(p->arm.link_inertia)) {
        double m = p->arm.mass / p->arm.links, l = p->arm.length / p->arm.links;
        p->arm.link_inertia = m * l * l / 12; // uniform rod (errata B3)
    }
    if (p->wall.kind != WALL_NONE && p->initial.angle > p->wall.angle) {
        return fault_set(
            f, STATUS_BAD_SCENARIO,
            "initial.angle = %g rad lies behind the wall, expected at most wall.angle = "
            "%g rad",
            p->initial.angle, p->wall.angle);
    }
    if (p->control.law == LAW_PLUGIN && p->control.plugin[0] == '\0') {
        return fault_set(
            f, STATUS_BAD_SCENARIO,
            "control.law = plugin needs the file of a shared object in control.plugin");
    }
    if (p->control.delay * p->control.rate > 1) {
        return fault_set(f, STATUS_BAD_SCENARIO,
                         "control.delay = %g s is longer than the period of %g s (control.rate)",
                         p->control.delay, 1 / p->control.rate);
    }
    if (p->control.delay * p->control.rate + p->control.delay_periods > 1) {
        return fault_set(f, STATUS_BAD_SCENARIO,
                         "control.delay_periods = %g and control.delay = %g s are together longer "
                         "than the period of %g s (control.rate)",
                         p->control.delay_periods, p->control.delay, 1 / p->control.rate);
    }
    k2_table table;
    if (k2_table_read(&table, p->control.k2_table, f) != STATUS_OK) {
        return STATUS_BAD_SCENARIO;
    }
    if (p->control.jitter * p->control.rate > 0.5) {
        return fault_set(
            f, STATUS_BAD_SCENARIO,
            "control.jitter = %g s is more than half the period of %g s (control.rate)",
            p->control.jitter, 1 / p->control.rate);
    }
    status sensible = resolve_piezo(p, f);
    if (sensible != STATUS_OK) {
        return sensible;
    }
    if (p->arm.model == ARM_PRINTED) {
        if (p->arm.links != 2) {
            return fault_set(f, STATUS_BAD_SCENARIO,
                             "the printed model has two links, but arm.links = %d", p->arm.links);
        }
        if (p->arm.hub_joint != HUB_SPRING) {
            return fault_set(f, STATUS_BAD_SCENARIO,
                             "the printed model has a hub spring, but arm.hub_joint = rigid");
        }
        if (p->method.name != METHOD_NEWMARK) {
            return fault_set(f, STATUS_BAD_SCENARIO,
                             "the printed model runs with method.name = newmark only");
        }
        if (p->wall.kind == WALL_PLANE) {
            return fault_set(f, STATUS_BAD_SCENARIO,
                             "the printed model knows wall.kind = point or none, not plane");
        }
    }
    return STATUS_OK;
}
