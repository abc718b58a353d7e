// Random rigs: what sensors read and what a summary says, recomputed from the motion.
//
//     random_rigs [COUNT [FIRST [SPACING [PATH=VALUE]...]]]
//
// Each rig is an arm, a motor, a wall, a law and sensors, drawn at random. It is run
// through the library with rows SPACING apart, 10 us. Readings at every sampling instant,
// the rows between them, the commands that reach the motor and the numbers of the summary
// are computed again from angles, velocities, accelerations, force and events, by filters
// written from the manual. Nothing of the lab's own rig is used.
//
// How near they have to be follows from the rows: a function whose second derivative is
// at most D differs from the straight line between two rows h apart by at most D h^2/8,
// and by D h^2 from one that is drawn on for h; what a first-order lag makes of it
// differs by no more. D is taken from the divided differences of neighbouring rows,
// twice. A converter's reading may be that of any value within this error.
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <impactlab/impactlab.h>

#include "src/base/random.h"

#define INSTANT 1e-9 // two instants nearer than this are one [s]
// of a number or of a row within a step, as a share of the largest
#define ROUNDING      1e-9
#define FOLLOWED      1e-6 // how near the rig follows a lag, as a share of the largest
#define FOLLOWED_PEAK 1e-4 // the same of the slow lag of sensor_1ms_peak_N
// 90 % over 10 %, whose logarithm is a lag's rise time over its constant
#define NINE 9.0

static double spacing = 1e-5; // of rows [s]
static char **given;          // settings that replace those drawn
static int given_count;

enum { MOST_SETTINGS = 96, LONGEST_SETTING = 96, MOST_SAMPLES = 8192, MOST_CHANGES = 3 };

// --- a rig that is drawn ---------------------------------------------------------------

typedef struct rig {
    uint64_t number;
    random_generator chance;
    impactlab_scenario *scenario;
    char settings[MOST_SETTINGS][LONGEST_SETTING];
    int count;
    long wrong;
    struct change {
        double at, value; // [s]
        char path[48];    // "" of a push
    } changes[MOST_CHANGES];
    int change_count;
} rig;

static __attribute__((format(printf, 2, 3))) void set(rig *r, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    vsnprintf(r->settings[r->count], LONGEST_SETTING, format, values);
    va_end(values);
    r->count++;
}

// A number whose logarithm is spread evenly.
static double between(rig *r, double from, double to)
{
    return from * exp(random_uniform(&r->chance) * log(to / from));
}

static double evenly(rig *r, double from, double to)
{
    return from + (to - from) * random_uniform(&r->chance);
}

static bool happens(rig *r, double share)
{
    return random_uniform(&r->chance) < share;
}

static const char *one_of(rig *r, const char *const *words, uint64_t count)
{
    return words[random_below(&r->chance, count)];
}

#define ONE_OF(r, words) one_of(r, words, sizeof(words) / sizeof(words)[0])

// Sets a number in a share of the rigs.
static void may_set(rig *r, double share, const char *path, double from, double to)
{
    const double value = between(r, from, to);
    if (happens(r, share)) {
        set(r, "%s=%.6g", path, value);
    }
}

static void may_set_evenly(rig *r, double share, const char *path, double from, double to)
{
    const double value = evenly(r, from, to);
    if (happens(r, share)) {
        set(r, "%s=%.6g", path, value);
    }
}

static void draw_arm(rig *r)
{
    static const char *const hubs[] = {"rigid", "rigid", "spring", "beam"};
    const char *hub = ONE_OF(r, hubs);
    set(r, "arm.links=%d", 1 + (int)random_below(&r->chance, 4));
    set(r, "arm.hub_joint=%s", hub);
    if (strcmp(hub, "spring") == 0) {
        set(r, "arm.k1=%.6g", between(r, 20, 2e4));
    }
    may_set(r, 0.5, "arm.k2", 1, 50);
    may_set(r, 0.5, "arm.damping_ratio", 1e-3, 0.05);
    may_set(r, 0.3, "arm.mass", 0.1, 1);
    may_set(r, 0.3, "arm.length", 0.4, 1.5);
    may_set(r, 0.2, "arm.tip_mass", 0.005, 0.1);
    may_set(r, 0.2, "arm.air_drag", 0.01, 1);
    may_set_evenly(r, 0.15, "arm.tilt", -0.2, 0.2);
    may_set(r, 0.15, "arm.stiffening", 0.1, 30);
    if (happens(r, 0.15)) {
        set(r, "method.engine=stiff");
    }
}

static void draw_motor(rig *r)
{
    if (happens(r, 0.15)) {
        set(r, "motor.drive=current");
    } else {
        may_set(r, 0.4, "motor.inductance", 1e-3, 0.1);
    }
    may_set(r, 0.35, "motor.current_limit", 0.05, 1);
    may_set(r, 0.5, "motor.stiction", 1e-3, 0.3);
    may_set(r, 0.2, "motor.viscous_friction", 1e-3, 0.1);
    may_set(r, 0.3, "motor.voltage_limit", 0.5, 20);
    set(r, "motor.voltage=%.6g", between(r, 0.3, 5));
}

static void draw_wall(rig *r)
{
    static const char *const kinds[] = {"point", "plane"};
    static const char *const contacts[] = {"rigid", "rigid", "kelvin-voigt",
                                           "hunt-crossley"};
    const char *contact = ONE_OF(r, contacts);
    const double angle = evenly(r, -0.5, 0.5), way = between(r, 0.005, 0.1);
    set(r, "wall.kind=%s", ONE_OF(r, kinds));
    set(r, "wall.contact=%s", contact);
    set(r, "wall.angle=%.6g", angle);
    set(r, "initial.angle=%.6g", angle - way);
    may_set(r, 0.4, "initial.velocity", 0.05, 2);
    if (strcmp(contact, "rigid") == 0) {
        may_set_evenly(r, 0.4, "wall.restitution", 0, 0.9);
    } else if (strcmp(contact, "kelvin-voigt") == 0) {
        may_set(r, 0.7, "wall.stiffness", 1e3, 3e5);
        may_set(r, 0.7, "wall.damping", 1, 50);
        may_set(r, 0.3, "wall.mass", 0.01, 1);
    } else {
        may_set(r, 0.7, "wall.stiffness", 1e4, 3e6);
    }
    if (happens(r, 0.1)) {
        set(r, "wall.motion=%s", happens(r, 0.5) ? "sine" : "step");
        set(r, "wall.motion_amplitude=%.6g", between(r, 1e-5, 5e-4));
        set(r, "wall.motion_frequency=%.6g", between(r, 1, 20));
    }
}

static void draw_law(rig *r)
{
    static const char *const laws[] = {"none",        "open-loop",      "hybrid",
                                       "force-pd",    "force-integral", "reverse-torque",
                                       "speed-limit", "bang-bang",      "impedance",
                                       "admittance",  "recovering",     "discontinuous",
                                       "open-loop",   "observer"};
    static const char *const rates[] = {"100",  "200",  "200", "500",
                                        "1000", "2000", "3000"};
    const char *law = ONE_OF(r, laws), *rate = ONE_OF(r, rates);
    const double period = 1 / atof(rate);
    set(r, "control.law=%s", law);
    set(r, "control.rate=%s", rate);
    set(r, "control.force=%.6g", between(r, 0.2, 4));
    set(r, "control.approach_voltage=%.6g", between(r, 0.3, 5));
    set(r, "control.seed=%d", (int)random_below(&r->chance, 1000));
    may_set(r, 0.3, "control.delay", 1e-4, 2 * period);
    if (happens(r, 0.3)) {
        set(r, "control.delay_periods=%.2g", evenly(r, 0, 2));
    }
    may_set(r, 0.1, "control.force_rate", 0.1, 100);
    if (happens(r, 0.1)) {
        set(r, "control.force_amplitude=%.6g", between(r, 0.01, 0.3));
        set(r, "control.force_frequency=%.6g", between(r, 0.1, 50));
    }
    may_set(r, 0.3, "control.jitter", 1e-2 * period, 0.9 * period);
}

static void draw_sensors(rig *r)
{
    static const char *const bits[] = {"0", "0", "6", "8", "12", "16"};
    static const char *const counts[] = {"0", "500", "8000", "100000"};
    static const char *const fits[] = {"sensor.piezo", "sensor.film",
                                       "sensor.accelerometer"};
    static const char *const noises[] = {"sensor.fsr_noise", "sensor.tachometer_noise",
                                         "sensor.piezo_noise", "sensor.film_noise",
                                         "sensor.accelerometer_noise"};
    for (int k = 0; k < 5; k++) {
        set(r, "%s=0", noises[k]);
    }
    if (happens(r, 0.15)) {
        set(r, "sensor.ideal=true");
    }
    for (int k = 0; k < 3; k++) {
        if (happens(r, 0.5)) {
            set(r, "%s=true", fits[k]);
        }
    }
    if (happens(r, 0.2)) {
        set(r, "sensor.force=piezo");
    }
    set(r, "sensor.adc_bits=%s", ONE_OF(r, bits));
    set(r, "sensor.dac_bits=%s", ONE_OF(r, bits));
    set(r, "sensor.encoder_counts=%s", ONE_OF(r, counts));
    may_set(r, 0.3, "sensor.adc_range", 1, 20);
    may_set_evenly(r, 0.3, "sensor.encoder_gain_error", -0.2, 0.2);
    may_set_evenly(r, 0.3, "sensor.encoder_offset", -0.1, 0.1);
    may_set(r, 0.3, "sensor.tachometer_gain", 0.5, 5);
    may_set(r, 0.3, "sensor.tachometer_ripple", 1e-3, 0.2);
    may_set_evenly(r, 0.3, "sensor.tachometer_gain_error", -0.2, 0.2);
    may_set_evenly(r, 0.3, "sensor.tachometer_offset", -0.1, 0.1);
    if (happens(r, 0.15)) {
        set(r, "sensor.fsr_rise_time=0");
    } else {
        may_set(r, 0.5, "sensor.fsr_rise_time", 1e-4, 1e-2);
    }
    may_set(r, 0.3, "sensor.fsr_resistance", 3e3, 3e5);
    may_set(r, 0.3, "sensor.fsr_exponent", 0.5, 1.5);
    may_set(r, 0.3, "sensor.fsr_gain", 0.5, 4);
    may_set(r, 0.3, "sensor.fsr_saturation", 1, 100);
    may_set_evenly(r, 0.3, "sensor.fsr_gain_error", -0.3, 0.3);
    may_set_evenly(r, 0.3, "sensor.fsr_offset", -0.2, 0.2);
    may_set_evenly(r, 0.4, "sensor.fsr_hysteresis", 0, 0.5);
    may_set(r, 0.3, "sensor.piezo_rise_time", 2e-5, 1e-3);
    may_set(r, 0.3, "sensor.piezo_leak_time", 0.02, 5);
    may_set(r, 0.3, "sensor.piezo_range", 1, 1000);
    may_set_evenly(r, 0.3, "sensor.piezo_gain_error", -0.3, 0.3);
    may_set_evenly(r, 0.3, "sensor.piezo_offset", -0.2, 0.2);
    may_set(r, 0.5, "sensor.film_leak_time", 0.02, 5);
    may_set(r, 0.5, "sensor.accelerometer_rise_time", 1e-4, 2e-3);
    may_set(r, 0.3, "sensor.accelerometer_range", 10, 1e5);
}

static void fail(const char *what, const impactlab_error *error)
{
    fprintf(stderr, "%s: %s\n", what, error->sentence);
    exit(2);
}

static double number(const rig *r, const char *path)
{
    double value;
    impactlab_error error;
    if (impactlab_scenario_number(r->scenario, path, &value, &error) != IMPACTLAB_OK) {
        fail(path, &error);
    }
    return value;
}

static bool is(const rig *r, const char *path, const char *word)
{
    char text[64];
    impactlab_error error;
    if (impactlab_scenario_text(r->scenario, path, text, sizeof text, &error) !=
        IMPACTLAB_OK) {
        fail(path, &error);
    }
    return strcmp(text, word) == 0;
}

// What changes during the run: errors of sensors, and pushes.
static void draw_changes(rig *r)
{
    static const char *const paths[] = {"sensor.encoder_gain_error",
                                        "sensor.encoder_offset",
                                        "sensor.tachometer_gain_error",
                                        "sensor.tachometer_offset",
                                        "sensor.fsr_gain_error",
                                        "sensor.fsr_offset",
                                        "sensor.piezo_gain_error",
                                        "sensor.piezo_offset",
                                        "",
                                        "sensor.tachometer_ripple",
                                        "control.force",
                                        "sensor.fsr_rise_time"};
    impactlab_error error;
    const double duration = number(r, "run.duration");
    double at = 0;
    while (r->change_count < MOST_CHANGES && happens(r, 0.4)) {
        struct change *c = &r->changes[r->change_count++];
        at += evenly(r, 0, duration / MOST_CHANGES);
        c->at = at;
        snprintf(c->path, sizeof c->path, "%s", ONE_OF(r, paths));
        c->value = evenly(r, 0, 0.2);
        if (*c->path == '\0') {
            c->value = evenly(r, -0.01, 0.01);
        } else if (strcmp(c->path, "sensor.fsr_rise_time") == 0) {
            c->value = between(r, 1e-4, 1e-2);
        }
        char text[32];
        snprintf(text, sizeof text, "%.17g", c->value);
        const int status =
            *c->path != '\0'
                ? impactlab_scenario_add_change(r->scenario, at, c->path, text, &error)
                : impactlab_scenario_add_push(r->scenario, at, c->value, &error);
        if (status != IMPACTLAB_OK) {
            fail("change", &error);
        }
    }
}

// A parameter at an instant of the run.
static double number_at(const rig *r, const char *path, double t)
{
    double value = number(r, path);
    for (int k = 0; k < r->change_count; k++) {
        if (r->changes[k].at <= t + INSTANT && strcmp(r->changes[k].path, path) == 0) {
            value = r->changes[k].value;
        }
    }
    return value;
}

// Draws a rig; false if its parts do not go together.
static bool draw(rig *r, uint64_t which)
{
    const char *all[MOST_SETTINGS];
    impactlab_error error;

    // the settings
    *r = (rig){.number = which};
    random_seed(&r->chance, which);
    set(r, "method.step=%g", spacing);
    draw_arm(r);
    draw_motor(r);
    draw_wall(r);
    draw_law(r);
    draw_sensors(r);
    set(r, "run.duration=%.6g", between(r, 0.15, 0.6));

    // the scenario
    for (int k = 0; k < given_count; k++) {
        set(r, "%s", given[k]);
    }
    for (int k = 0; k < r->count; k++) {
        all[k] = r->settings[k];
    }
    if (impactlab_scenario_create(&r->scenario, &error) != IMPACTLAB_OK) {
        fail("create", &error);
    }
    const int status =
        impactlab_scenario_set_all(r->scenario, all, (size_t)r->count, &error);
    if (status != IMPACTLAB_OK) {
        printf("%" PRIu64 ": refused: %s\n", which, error.sentence);
    }
    if (status == IMPACTLAB_OK) {
        draw_changes(r);
    }
    return status == IMPACTLAB_OK;
}

// --- what is said of it ----------------------------------------------------------------

enum { MOST_KINDS = 64, MOST_SAID = 8 };

// Where the lab does not agree yet, by how much at most, and why. These count apart; a
// line goes with what it is about.
static const struct known {
    const char *what;
    double most;
    const char *why;
} known[] = {
    {"force_reading with hysteresis alone", (double)INFINITY,
     "extremes of parabolas, to 1e-3"},
    {"max_penetration_m", 1e-4, "a depth beyond the end of a step"},
    {"smoothed_over_command_N", 1e-5, "the largest window is found nearly"},
};

// Whether a disagreement of this size is known.
static bool is_known(const char *what, double off)
{
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        if (strcmp(known[k].what, what) == 0) {
            return off <= known[k].most;
        }
    }
    return false;
}

// Complaints by kind, over all rigs.
static struct kind {
    const char *what;
    long rigs, values;
    uint64_t last, worst_rig;
    double worst; // the largest distance from what is expected
} kinds[MOST_KINDS];
static int kind_count;
static long checked;

static struct kind *kind_of(const char *what)
{
    int k = 0;
    while (k < kind_count && strcmp(kinds[k].what, what) != 0) {
        k++;
    }
    if (k == kind_count) {
        kinds[kind_count++] = (struct kind){.what = what, .last = UINT64_MAX};
    }
    return &kinds[k];
}

// A value that is to lie between two others; `at` [s] says where it belongs.
static void expect(rig *r, const char *what, double at, double got, double low,
                   double high)
{
    checked++;
    if (got >= low && got <= high) {
        return;
    }
    const double off = got < low ? low - got : got - high;
    const bool counts = !is_known(what, off);
    struct kind *k = kind_of(what);
    if (k->last != r->number) {
        k->last = r->number;
        k->rigs++;
    }
    if (counts && r->wrong < MOST_SAID) {
        printf("%" PRIu64 ": %s at %.9g s is %.10g, expected %.10g to %.10g\n", r->number,
               what, at, got, low, high);
    }
    if (!(off <= k->worst)) {
        k->worst = off;
        k->worst_rig = r->number;
    }
    k->values++;
    r->wrong += counts;
}

static void expect_near(rig *r, const char *what, double at, double got, double wanted,
                        double error)
{
    if (isnan(wanted) && isnan(got)) {
        return;
    }
    expect(r, what, at, got, wanted - error, wanted + error);
}

// --- the motion ------------------------------------------------------------------------

enum column {
    TIME,
    HUB_ANGLE,
    FIRST_ANGLE,
    LAST_ANGLE,
    HUB_VELOCITY,
    FIRST_VELOCITY,
    LAST_VELOCITY,
    HUB_ACCELERATION,
    GAP,
    GAP_VELOCITY,
    FORCE,
    IMPULSE,
    CONTACT,
    STICKING,
    VOLTAGE,
    MOTOR_TORQUE,
    KINETIC,
    STRAIN,
    MOTOR_WORK,
    EXTERNAL_WORK,
    VISCOUS_LOSS,
    FRICTION_LOSS,
    DAMPING_LOSS,
    IMPACT_LOSS,
    RESIDUAL,
    WALL_ENERGY,
    WALL_LOSS,
    WALL_WORK,
    WEIGHT_ENERGY,
    FACE_DEPTH,
    COMMAND,
    ENCODER,
    TACHOMETER,
    FORCE_READING,
    PIEZO_FORCE,
    FILM,
    ACCELEROMETER,
    COLUMNS
};

static const char *const column_names[COLUMNS] = {"time",
                                                  "hub_angle",
                                                  "first_angle",
                                                  "last_angle",
                                                  "hub_velocity",
                                                  "first_velocity",
                                                  "last_velocity",
                                                  "hub_acceleration",
                                                  "gap",
                                                  "gap_velocity",
                                                  "force",
                                                  "impulse",
                                                  "contact",
                                                  "sticking",
                                                  "voltage",
                                                  "motor_torque",
                                                  "kinetic_energy",
                                                  "strain_energy",
                                                  "motor_work",
                                                  "external_work",
                                                  "viscous_loss",
                                                  "friction_loss",
                                                  "damping_loss",
                                                  "impact_loss",
                                                  "energy_residual",
                                                  "wall_energy",
                                                  "wall_loss",
                                                  "wall_work",
                                                  "weight_energy",
                                                  "face_depth",
                                                  "command",
                                                  "encoder",
                                                  "tachometer",
                                                  "force_reading",
                                                  "piezo_force",
                                                  "film",
                                                  "accelerometer"};

// An instant at which the rig samples, and what it reads there.
typedef struct sample {
    double time, applied;    // the command takes effect [s]
    double reading[6];       // in the order of the columns from ENCODER on
    double command, voltage; // [V], and what becomes of it
} sample;

typedef struct motion {
    size_t count;
    double *of[COLUMNS];
    impactlab_run *run;
    sample samples[MOST_SAMPLES];
    int sample_count;
    double ends; // [s]
} motion;

static double or_zero(double x)
{
    return isnan(x) ? 0 : x;
}

static double quantity(const motion *m, const char *key)
{
    double value;
    impactlab_error error;
    if (impactlab_run_quantity(m->run, key, &value, &error) != IMPACTLAB_OK) {
        return (double)NAN;
    }
    return value;
}

static bool has_quantity(const motion *m, const char *key)
{
    double value;
    return impactlab_run_quantity(m->run, key, &value, NULL) == IMPACTLAB_OK;
}

static void read_rows(motion *m)
{
    impactlab_error error;
    for (int c = 0; c < COLUMNS; c++) {
        impactlab_series s;
        if (impactlab_run_signal(m->run, column_names[c], &s, &error) != IMPACTLAB_OK) {
            fail(column_names[c], &error);
        }
        m->count = s.count;
        m->of[c] = malloc(s.count * sizeof(double));
        for (size_t i = 0; i < s.count; i++) {
            memcpy(&m->of[c][i], (const char *)s.values + i * s.stride, sizeof(double));
        }
    }
    m->ends = m->of[TIME][m->count - 1];
}

// The sampling instants, and the readings there, of the same rig stepped by hand.
static void read_samples(const rig *r, motion *m)
{
    impactlab_loop *loop;
    impactlab_error error;
    if (is(r, "control.law", "none")) {
        return;
    }
    if (impactlab_loop_create(&loop, r->scenario, 0, &error) != IMPACTLAB_OK) {
        fail("loop", &error);
    }
    while (!impactlab_loop_ended(loop) && m->sample_count < MOST_SAMPLES) {
        impactlab_reading reading;
        if (impactlab_loop_read_sensors(loop, &reading, &error) != IMPACTLAB_OK) {
            fail("sensors", &error);
        }
        m->samples[m->sample_count++] =
            (sample){.time = impactlab_loop_time(loop),
                     .reading = {reading.encoder, reading.tachometer, reading.force,
                                 reading.piezo_force, reading.film,
                                 reading.accelerometer}};
        if (impactlab_loop_step(loop, &error) != IMPACTLAB_OK) {
            break;
        }
    }
    impactlab_loop_destroy(loop);
}

static void forget(motion *m)
{
    for (int c = 0; c < COLUMNS; c++) {
        free(m->of[c]);
    }
    impactlab_run_destroy(m->run);
}

// --- converters ------------------------------------------------------------------------

// A value as a converter of so many bits has it: whole steps, the largest one below its
// range.
static double converted(double value, double bits, double range)
{
    if (bits == 0) {
        return fmax(-range, fmin(range, value));
    }
    const double step = 2 * range / exp2(bits);
    return fmax(-range, fmin(range - step, round(value / step) * step));
}

// --- commands --------------------------------------------------------------------------

// The row of an instant's first one, or the first one after it.
static size_t row_at(const motion *m, double t)
{
    size_t low = 0, high = m->count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (m->of[TIME][middle] < t) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

// Commands of the samples, from the rows after them, and what the motor gets for them.
static void follow_commands(const rig *r, motion *m)
{
    const double most = number(r, "motor.current_limit");
    const double limit = is(r, "motor.drive", "current") && most > 0
                             ? fmin(number(r, "motor.voltage_limit"),
                                    most / number(r, "motor.transconductance"))
                             : number(r, "motor.voltage_limit");
    const double bits = is(r, "sensor.ideal", "true") ? 0 : number(r, "sensor.dac_bits");
    const double delay = number(r, "control.delay") +
                         number(r, "control.delay_periods") / number(r, "control.rate");
    for (int k = 0; k < m->sample_count; k++) {
        sample *s = &m->samples[k];
        const size_t row = row_at(m, s->time + INSTANT);
        s->command = row < m->count ? m->of[COMMAND][row] : (double)NAN;
        s->voltage = converted(fmax(-limit, fmin(limit, s->command)), bits, limit);
    }

    // after the delay, or with the sample so many later if that comes first
    const double periods = delay * number(r, "control.rate");
    const int later = (int)ceil(periods - 1e-9);
    for (int k = 0; k < m->sample_count; k++) {
        sample *s = &m->samples[k];
        s->applied = s->time + delay;
        if (later > 0 && k + later < m->sample_count) {
            s->applied = fmin(s->applied, m->samples[k + later].time);
        }
    }
}

// What the rows say of commands, and of readings between samples.
static void check_rows(rig *r, motion *m)
{
    int k = -1, applied = -1; // the last sample, the last one whose command acts
    for (size_t i = 0; i < m->count; i++) {
        const double t = m->of[TIME][i];

        // time goes on
        if (i > 0) {
            expect(r, "order of rows", t, t - m->of[TIME][i - 1], 0, (double)INFINITY);
        }
        if (m->sample_count == 0) {
            continue;
        }

        // what was read last
        while (k + 1 < m->sample_count && m->samples[k + 1].time <= t - INSTANT) {
            k++;
        }
        const bool on_sample =
            k + 1 < m->sample_count && fabs(m->samples[k + 1].time - t) < INSTANT;
        const bool last_there = i + 1 == m->count || m->of[TIME][i + 1] > t + INSTANT;
        const int held = on_sample && last_there ? k + 1 : k;
        if (held >= 0 && !(on_sample && !last_there)) {
            for (int c = 0; c < 6; c++) {
                const double wanted = m->samples[held].reading[c];
                expect_near(r,
                            on_sample ? "row on a sampling instant"
                                      : "row between two samples",
                            t, m->of[ENCODER + c][i], wanted, 1e-12 * (1 + fabs(wanted)));
            }
        }

        // what acts on the motor
        while (applied + 1 < m->sample_count &&
               m->samples[applied + 1].applied <= t - INSTANT) {
            applied++;
        }
        const double before = applied >= 0 ? m->samples[applied].voltage : 0;
        const bool on_change = applied + 1 < m->sample_count &&
                               fabs(m->samples[applied + 1].applied - t) < INSTANT;
        const double after = on_change ? m->samples[applied + 1].voltage : before;
        if (!isnan(before) && !isnan(after)) {
            const double v = m->of[VOLTAGE][i];
            const double error = fmin(fabs(v - before), fabs(v - after));
            expect_near(r, "voltage", t, v, v - error, 1e-9);
        }
    }
}

static void check_instants(rig *r, const motion *m)
{
    const double period = 1 / number(r, "control.rate"),
                 width = number(r, "control.jitter");
    double first = (double)INFINITY, last = -(double)INFINITY;
    for (int k = 0; k < m->sample_count; k++) {
        const double late = m->samples[k].time - k * period;
        first = fmin(first, late);
        last = fmax(last, late);
    }
    if (m->sample_count > 0) {
        expect(r, "scatter of instants", 0, last - first, 0, width + INSTANT);
        expect(r, "lateness of instants", 0, last, -width, width + INSTANT);
    }
}

// --- a function between the rows -------------------------------------------------------

// A straight line between two instants, and by how much the function may differ from it.
typedef struct piece {
    double from, to, begin, end, error;
    bool drawn; // on from its neighbours
} piece;

typedef struct pieces {
    piece *of;
    size_t count;
} pieces;

// The instant of a change of the voltage in or at the ends of (from, to); (double)NAN if
// there is none.
static double change_within(const motion *m, int *next, double from, double to)
{
    while (*next < m->sample_count && m->samples[*next].applied < from - INSTANT) {
        ++*next;
    }
    for (int k = *next; k < m->sample_count && m->samples[k].applied < to + INSTANT;
         k++) {
        const double before = k > 0 ? m->samples[k - 1].voltage : 0;
        if (m->samples[k].voltage != before) {
            return fmax(from, fmin(to, m->samples[k].applied));
        }
    }
    return (double)NAN;
}

static double slope(const piece *p)
{
    return (p->end - p->begin) / (p->to - p->from);
}

// The second derivative, from two pieces that are not separated by a jump.
static double bend(const piece *p, const piece *q)
{
    const bool joined = p->to == q->from && p->end == q->begin;
    const bool wide = p->to - p->from > INSTANT && q->to - q->from > INSTANT;
    return joined && wide ? 2 * fabs(slope(q) - slope(p)) / (q->to - p->from) : 0;
}

// The pieces of a column. Where the voltage changes between two rows, which makes it
// jump, the lines beyond both are drawn on to that instant.
static pieces pieces_of(const motion *m, const double *column)
{
    const double *t = m->of[TIME];
    pieces made = {.of = malloc((2 * m->count + 2) * sizeof(piece))};
    int next = 0;
    for (size_t i = 0; i + 1 < m->count; i++) {
        if (t[i + 1] <= t[i]) {
            continue;
        }
        const double at = m->of[VOLTAGE][i] != m->of[VOLTAGE][i + 1]
                              ? change_within(m, &next, t[i], t[i + 1])
                              : (double)NAN;
        if (isnan(at)) {
            made.of[made.count++] =
                (piece){t[i], t[i + 1], column[i], column[i + 1], 0, false};
            continue;
        }

        // from the row before, from the one behind
        double before = column[i], after = column[i + 1];
        if (i > 0 && t[i] - t[i - 1] > INSTANT) {
            before += (column[i] - column[i - 1]) / (t[i] - t[i - 1]) * (at - t[i]);
        }
        if (i + 2 < m->count && t[i + 2] - t[i + 1] > INSTANT) {
            after +=
                (column[i + 2] - column[i + 1]) / (t[i + 2] - t[i + 1]) * (at - t[i + 1]);
        }
        made.of[made.count++] = (piece){t[i], at, column[i], before, 0, true};
        made.of[made.count++] = (piece){at, t[i + 1], after, column[i + 1], 0, true};
    }

    // how far the function may be from its line
    for (size_t i = 0; i < made.count; i++) {
        double most = 0;
        for (size_t j = i >= 3 ? i - 3 : 0; j + 1 < made.count && j <= i + 2; j++) {
            most = fmax(most, bend(&made.of[j], &made.of[j + 1]));
        }
        piece *p = &made.of[i];
        const double h = p->drawn ? spacing : p->to - p->from;
        p->error = 2 * most * h * h / (p->drawn ? 1 : 8) +
                   1e-12 * (fabs(p->begin) + fabs(p->end));
    }
    return made;
}

static double value_within(const piece *p, double t)
{
    const double share = p->to > p->from ? (t - p->from) / (p->to - p->from) : 0;
    return p->begin + share * (p->end - p->begin);
}

// The integral over an interval, and how far it may be from the function's.
static double integral(const pieces *f, double from, double to, double *error)
{
    double sum = 0;
    *error = 0;
    for (size_t i = 0; i < f->count; i++) {
        const piece *p = &f->of[i];
        const double a = fmax(p->from, from), b = fmin(p->to, to);
        if (b > a) {
            sum += (b - a) * (value_within(p, a) + value_within(p, b)) / 2;
            *error += (b - a) * p->error;
        }
    }
    *error += ROUNDING * fabs(sum);
    return sum;
}

// --- jumps -----------------------------------------------------------------------------

// What acts in an instant: the impulse of an impact, or a change of the hub's velocity.
typedef struct blow {
    double time, size;
} blow;

typedef struct blows {
    blow *of;
    size_t count;
} blow_list;

static blow_list impulses_of(const motion *m)
{
    const size_t most = impactlab_run_event_count(m->run);
    blow_list made = {.of = malloc((most + 1) * sizeof(blow))};
    for (size_t i = 0; i < most; i++) {
        impactlab_event e;
        impactlab_run_event(m->run, i, &e);
        if (strcmp(e.kind, "impact") == 0) {
            made.of[made.count++] = (blow){e.time, e.impulse};
        }
    }
    return made;
}

static blow_list jumps_of(const motion *m, const double *column)
{
    blow_list made = {.of = malloc(m->count * sizeof(blow))};
    for (size_t i = 0; i + 1 < m->count; i++) {
        const double by = column[i + 1] - column[i];
        if (m->of[TIME][i + 1] <= m->of[TIME][i] && by != 0) {
            made.of[made.count++] = (blow){m->of[TIME][i], by};
        }
    }
    return made;
}

// --- filters ---------------------------------------------------------------------------

// A first-order lag, T y' + y = f, and behind it what a leak takes off, S w' + w = y.
typedef struct lag {
    double T, S; // [s]; T = 0: y = f, S = 0: w = 0
    double y, w;
    double y_error, w_error;
} lag;

static void lag_strike(lag *l, double size)
{
    if (l->T > 0) {
        l->y += size / l->T;
    } else if (l->S > 0) {
        l->w += size / l->S; // the charge of an instant leaks as any other
    }
}

// Follows a straight line, to the last digit.
static void lag_follow(lag *l, double begin, double end, double h, double error)
{
    if (h <= 0) {
        if (l->T == 0) {
            l->y = end;
        }
        return;
    }
    const double s = (end - begin) / h;

    // y = begin - s T + s t + a exp(-t/T)
    double a = 0, base = begin, decay = 0;
    if (l->T > 0) {
        base = begin - s * l->T;
        a = l->y - base;
        decay = exp(-h / l->T);
    }

    // w = base - s S + s t + b exp(-t/T) + c exp(-t/S), where S b' + b takes a
    if (l->S > 0) {
        const double b = l->T > 0 ? a / (1 - l->S / l->T) : 0;
        const double c = l->w - (base - s * l->S) - b, fade = exp(-h / l->S);
        l->w = base - s * l->S + s * h + b * decay + c * fade;
        l->w_error = error + (l->w_error - error) * fade;
        l->w_error = fmax(l->w_error, fmax(error, l->y_error) * (1 - fade));
    }
    l->y = base + s * h + a * decay;
    l->y_error = error + (l->y_error - error) * decay;
}

// A filter that goes through the pieces of a function and the blows.
typedef struct follower {
    lag state;
    const pieces *of;
    const blow_list *blows;
    size_t piece, blow;
    double now;
    double rounding;                   // of the function
    double play_low, play_high, share; // of a hysteresis, its bounds
} follower;

static void play_follow(follower *f, double ripple)
{
    const double x = f->state.y, h = f->share;
    const double e = f->state.y_error + f->rounding + ripple;
    f->play_low = fmax((1 - h) * (x - e), fmin(f->play_low, (1 + h) * (x - e)));
    f->play_high = fmax((1 - h) * (x + e), fmin(f->play_high, (1 + h) * (x + e)));
}

// A blow. Without a lag it is larger than any play, which follows from above.
static void follower_strike(follower *f, double size)
{
    lag_strike(&f->state, size);
    if (f->state.T > 0) {
        play_follow(f, 0);
    } else {
        f->play_low = f->play_high = (double)INFINITY;
    }
}

// How far a lag's output is from a straight line within a stretch, if it turns there.
static double turning(const lag *l, const piece *p, double h)
{
    if (l->T == 0) {
        return p->error;
    }
    const double rate = fabs(p->end - l->y) / l->T;
    return h * h / 8 * (fabs(slope(p)) + rate) / l->T;
}

// Goes on to an instant: the state just before it, blows at the very instant left out.
static void follower_reach(follower *f, double t)
{
    while (f->piece < f->of->count) {
        const piece *p = &f->of->of[f->piece];

        // blows at the beginning of the piece
        while (f->blow < f->blows->count &&
               f->blows->of[f->blow].time <= f->now + 1e-13 &&
               f->blows->of[f->blow].time < t - INSTANT) {
            follower_strike(f, f->blows->of[f->blow].size);
            f->blow++;
        }
        if (f->now >= t) {
            return;
        }
        const double to = fmin(p->to, t), h = to - f->now;
        const double begin = value_within(p, f->now), end = value_within(p, to);
        const double bent = p->to > p->from ? turning(&f->state, p, h) : 0;
        lag_follow(&f->state, begin, end, h, p->error);
        play_follow(f, bent);
        f->now = to;
        if (p->to > t) {
            return;
        }
        f->piece++;
    }
}

static follower follower_of(const pieces *of, const blow_list *blows, double rise,
                            double leak)
{
    const double begin = rise == 0 && of->count > 0 ? of->of[0].begin : 0;
    double largest = 0;
    for (size_t i = 0; i < of->count; i++) {
        largest = fmax(largest, fmax(fabs(of->of[i].begin), fabs(of->of[i].end)));
    }
    return (follower){.of = of,
                      .blows = blows,
                      .state = {.T = rise / log(NINE), .S = leak, .y = begin},
                      .rounding = FOLLOWED * largest};
}

// Whether something happens in this very instant, so that both sides of it count.
static bool is_unclear(const motion *m, int k)
{
    const double t = m->samples[k].time;
    for (int j = k; j >= 0 && j > k - 8; j--) {
        if (j < k && fabs(m->samples[j].applied - t) < INSTANT) {
            return true;
        }
    }
    for (size_t i = 0; i < impactlab_run_event_count(m->run); i++) {
        impactlab_event e;
        impactlab_run_event(m->run, i, &e);
        if (fabs(e.time - t) < INSTANT) {
            return true;
        }
    }
    return false;
}

// --- sensors ---------------------------------------------------------------------------

typedef struct channel {
    double gain_error, offset; // of what is shown
    double range;              // 0: none
    double volts;              // per unit
    double bits, adc_range;
    bool ideal;
} channel;

// A reading through gain, range and converter.
static double shown(const channel *c, double value)
{
    if (c->ideal) {
        return value;
    }
    value = (1 + c->gain_error) * value + c->offset;
    if (c->range > 0) {
        value = fmax(-c->range, fmin(c->range, value));
    }
    return converted(c->volts * value, c->bits, c->adc_range) / c->volts;
}

static channel channel_of(const rig *r, const char *sensor, const char *volts,
                          bool has_range, double t)
{
    char path[64];
    channel c = {.volts = number(r, volts),
                 .bits = number(r, "sensor.adc_bits"),
                 .adc_range = number(r, "sensor.adc_range"),
                 .ideal = is(r, "sensor.ideal", "true")};
    if (has_range) {
        snprintf(path, sizeof path, "sensor.%s_range", sensor);
        c.range = number(r, path);
    }
    if (strcmp(sensor, "piezo") == 0) {
        c.gain_error = number_at(r, "sensor.piezo_gain_error", t);
        c.offset = number_at(r, "sensor.piezo_offset", t);
    }
    return c;
}

// What the FSR's gain stage gives for a force above zero [V].
static double fsr_volts(const rig *r, double x)
{
    const double R =
        number(r, "sensor.fsr_resistance") * pow(x, -number(r, "sensor.fsr_exponent"));
    const double divider = number(r, "sensor.fsr_divider");
    return number(r, "sensor.fsr_supply") * number(r, "sensor.fsr_gain") * divider /
           (divider + R);
}

// The FSR's circuit: resistance by a power law, divider, gain stage, converter, and back.
static double fsr_shown(const rig *r, double x, double t)
{
    if (is(r, "sensor.ideal", "true")) {
        return x;
    }
    const double saturation = number(r, "sensor.fsr_saturation");
    x = (1 + number_at(r, "sensor.fsr_gain_error", t)) * x +
        number_at(r, "sensor.fsr_offset", t);
    x = fmin(x, saturation);
    if (!(x > 0)) {
        return 0;
    }
    const double R1 = number(r, "sensor.fsr_resistance"),
                 p = number(r, "sensor.fsr_exponent");
    const double divider = number(r, "sensor.fsr_divider");
    const double full = number(r, "sensor.fsr_supply") * number(r, "sensor.fsr_gain");
    const double volts = converted(fsr_volts(r, x), number(r, "sensor.adc_bits"),
                                   number(r, "sensor.adc_range"));
    if (volts <= 0) {
        return 0;
    }
    if (volts >= full) {
        return saturation;
    }
    return fmin(saturation, pow(divider * (full / volts - 1) / R1, -1 / p));
}

static void expect_reading(rig *r, const char *what, const sample *s, int c, double low,
                           double high)
{
    const double slack = ROUNDING * fmax(fabs(low), fabs(high)) + 1e-12;
    expect(r, what, s->time, s->reading[c], low - slack, high + slack);
}

static void check_angles(rig *r, const motion *m)
{
    pieces angle = pieces_of(m, m->of[HUB_ANGLE]),
           rate = pieces_of(m, m->of[HUB_VELOCITY]);
    const bool ideal = is(r, "sensor.ideal", "true");
    const double counts = number(r, "sensor.encoder_counts");
    const double ripples = number(r, "sensor.tachometer_ripple_count");
    const channel c = channel_of(r, "tachometer", "sensor.tachometer_gain", false, 0);
    size_t i = 0;
    for (int k = 0; k < m->sample_count; k++) {
        const sample *s = &m->samples[k];
        while (i + 1 < angle.count && angle.of[i].to < s->time - 1e-13) {
            i++;
        }
        const double q = value_within(&angle.of[i], s->time);
        const double w = value_within(&rate.of[i], s->time);
        const double q_error = angle.of[i].error + 1e-13;
        double w_error = rate.of[i].error + 1e-13;
        double w_low = w - w_error, w_high = w + w_error;
        if (is_unclear(m, k) && i + 1 < rate.count) {
            w_low = fmin(w_low, rate.of[i + 1].begin);
            w_high = fmax(w_high, rate.of[i + 1].begin);
        }

        // encoder
        const double gain = 1 + number_at(r, "sensor.encoder_gain_error", s->time);
        const double offset = number_at(r, "sensor.encoder_offset", s->time);
        double low = q - q_error, high = q + q_error;
        if (!ideal) {
            low = gain * low + offset;
            high = gain * high + offset;
            if (counts > 0) {
                const double one = 2 * M_PI / counts;
                low = round(low / one - 1e-9) * one;
                high = round(high / one + 1e-9) * one;
            }
        }
        expect_reading(r, "encoder", s, 0, low, high);

        // tachometer
        const double tacho_gain =
            1 + number_at(r, "sensor.tachometer_gain_error", s->time);
        const double tacho_offset = number_at(r, "sensor.tachometer_offset", s->time);
        const double ripple = number_at(r, "sensor.tachometer_ripple", s->time);
        low = w_low;
        high = w_high;
        if (!ideal) {
            const double wave = 1 + ripple * sin(ripples * q);
            const double slack = fabs(w) * ripple * ripples * q_error + 1e-11;
            low = shown(&c, tacho_gain * low * wave + tacho_offset - slack);
            high = shown(&c, tacho_gain * high * wave + tacho_offset + slack);
        }
        expect_reading(r, "tachometer", s, 1, low, high);
    }
    free(angle.of);
    free(rate.of);
}

// The bounds of what goes into the converter at a sample, of a sensor that a lag stands
// for.
static void bounds_at(const motion *m, int k, follower *f, double *low, double *high)
{
    follower_reach(f, m->samples[k].time);
    const double value = f->state.y - f->state.w;
    const double error = f->state.y_error + f->state.w_error + f->rounding + 1e-13;
    *low = value - error;
    *high = value + error;

    // both sides of an instant in which something happens
    if (is_unclear(m, k)) {
        lag other = f->state;
        if (f->blow < f->blows->count &&
            fabs(f->blows->of[f->blow].time - m->samples[k].time) < INSTANT) {
            lag_strike(&other, f->blows->of[f->blow].size);
        }
        if (other.T == 0 && f->piece < f->of->count) {
            other.y = f->of->of[f->piece].begin;
        }
        *low = fmin(*low, other.y - other.w - error);
        *high = fmax(*high, other.y - other.w + error);
    }
}

static const char *force_kind(bool ideal, double hysteresis, double delay)
{
    if (ideal) {
        return "force_reading, ideal";
    }
    if (hysteresis > 0 && delay == 0) {
        return "force_reading with hysteresis alone";
    }
    return hysteresis > 0 ? "force_reading with hysteresis" : "force_reading";
}

// Goes on to changes of the rise time up to an instant.
static void follow_rise_time(const rig *r, follower *f, double t)
{
    const struct change *end = r->changes + r->change_count;
    for (const struct change *c = r->changes; c < end; c++) {
        const bool due = c->at > f->now && c->at <= t;
        if (due && strcmp(c->path, "sensor.fsr_rise_time") == 0) {
            follower_reach(f, c->at);
            f->state.T = c->value / log(NINE);
        }
    }
}

static void check_fsr(rig *r, const motion *m, const pieces *force,
                      const blow_list *impulses)
{
    const bool ideal = is(r, "sensor.ideal", "true");
    const double share = ideal ? 0 : number(r, "sensor.fsr_hysteresis");
    follower f =
        follower_of(force, impulses, ideal ? 0 : number(r, "sensor.fsr_rise_time"), 0);
    f.share = share;
    for (int k = 0; k < m->sample_count; k++) {
        double low, high;
        if (!ideal) {
            follow_rise_time(r, &f, m->samples[k].time);
        }
        bounds_at(m, k, &f, &low, &high);
        if (share > 0) {
            const double up =
                fmax((1 - share) * high, fmin(f.play_high, (1 + share) * high));
            const double down =
                fmax((1 - share) * low, fmin(f.play_low, (1 + share) * low));
            low = fmin(down, up);
            high = fmax(down, up);
        }
        expect_reading(r, force_kind(ideal, share, f.state.T), &m->samples[k], 2,
                       fsr_shown(r, low, m->samples[k].time),
                       fsr_shown(r, high, m->samples[k].time));
    }
}

static void check_optional(rig *r, const motion *m, const pieces *force,
                           const blow_list *impulses)
{
    const bool ideal = is(r, "sensor.ideal", "true"), law = m->sample_count > 0;
    const bool piezo = is(r, "sensor.piezo", "true") || is(r, "sensor.force", "piezo");
    double *bending = malloc(m->count * sizeof(double));
    for (size_t i = 0; i < m->count; i++) {
        bending[i] = m->of[LAST_ANGLE][i] - m->of[FIRST_ANGLE][i];
    }
    pieces bend = pieces_of(m, bending);
    pieces acceleration = pieces_of(m, m->of[HUB_ACCELERATION]);
    blow_list none = {0}, jerks = jumps_of(m, m->of[HUB_VELOCITY]);
    const channel film_channel = channel_of(r, "film", "sensor.film_gain", false, 0);
    const channel hub_channel =
        channel_of(r, "accelerometer", "sensor.accelerometer_gain", true, 0);

    follower p =
        follower_of(force, impulses, ideal ? 0 : number(r, "sensor.piezo_rise_time"),
                    ideal ? 0 : number(r, "sensor.piezo_leak_time"));
    follower b =
        follower_of(&bend, &none, 0, ideal ? 0 : number(r, "sensor.film_leak_time"));
    follower a = follower_of(&acceleration, &jerks,
                             ideal ? 0 : number(r, "sensor.accelerometer_rise_time"), 0);
    for (int k = 0; law && k < m->sample_count; k++) {
        double low, high;
        const sample *s = &m->samples[k];
        if (piezo) {
            const channel piezo_channel =
                channel_of(r, "piezo", "sensor.piezo_gain", true, s->time);
            bounds_at(m, k, &p, &low, &high);
            expect_reading(r, "piezo_force", s, 3, shown(&piezo_channel, low),
                           shown(&piezo_channel, high));
        }
        if (is(r, "sensor.film", "true")) {
            bounds_at(m, k, &b, &low, &high);
            expect_reading(r, "film", s, 4, shown(&film_channel, low),
                           shown(&film_channel, high));
        }
        // the command of the first sample may act at once, before the first row
        if (is(r, "sensor.accelerometer", "true") && (k > 0 || a.state.T > 0)) {
            bounds_at(m, k, &a, &low, &high);
            expect_reading(r, "accelerometer", s, 5, shown(&hub_channel, low),
                           shown(&hub_channel, high));
        }
    }
    free(bending);
    free(bend.of);
    free(acceleration.of);
    free(jerks.of);
}

// --- the summary -----------------------------------------------------------------------

typedef struct touches {
    double first,
        release; // first contact, first release [s], (double)NAN if there is none
    int impacts;
    double impulse;  // of the first impact [N s]
    double impulses; // of all
} touches;

static touches touches_of(const motion *m)
{
    touches t = {.first = (double)NAN, .release = (double)NAN};
    for (size_t i = 0; i < impactlab_run_event_count(m->run); i++) {
        impactlab_event e;
        impactlab_run_event(m->run, i, &e);
        const bool impact = strcmp(e.kind, "impact") == 0;
        if (isnan(t.first) && (impact || strcmp(e.kind, "contact") == 0)) {
            t.first = e.time;
            t.release = impact ? e.time : (double)NAN;
        }
        if (strcmp(e.kind, "contact") == 0 && e.time == t.first) {
            t.release = (double)NAN; // contact goes on after the impact
        }
        if (isnan(t.release) && strcmp(e.kind, "release") == 0) {
            t.release = e.time;
        }
        if (impact) {
            t.impulse = t.impacts == 0 ? e.impulse : t.impulse;
            t.impacts++;
            t.impulses += e.impulse;
        }
    }
    return t;
}

// The largest value within an interval: of the lines, and of what may lie above them.
typedef struct largest {
    double low, high;
} largest;

static largest largest_within(const pieces *f, double from, double to)
{
    largest l = {-(double)INFINITY, -(double)INFINITY};
    for (size_t i = 0; i < f->count; i++) {
        const piece *p = &f->of[i];
        if (p->to >= from - INSTANT && p->from <= to + INSTANT) {
            if (p->from >= from - INSTANT && p->to <= to + INSTANT) {
                l.low = fmax(l.low, fmax(p->begin, p->end) - (p->drawn ? p->error : 0));
            }
            l.high = fmax(l.high, fmax(p->begin, p->end) + p->error);
        }
    }
    return l;
}

// The largest force of the run; 0 where only impacts gave one.
static double peak_of(const motion *m)
{
    const double peak = quantity(m, "peak_force_N");
    return isnan(peak) ? 0 : peak;
}

static void check_peak(rig *r, const motion *m, const pieces *force, const char *what,
                       const char *when, double first, double to)
{
    const double said = quantity(m, what), at = quantity(m, when);
    const double peak = isnan(said) ? 0 : said;
    const largest l = largest_within(force, first, to);
    const double slack = 1e-9 * fabs(l.high) + 1e-9;
    expect(r, what, first, peak, l.low - slack, l.high + slack);
    if (l.high > 1e-6 && !isnan(at)) {
        const largest there =
            largest_within(force, first + at - spacing, first + at + spacing);
        expect(r, when, first + at, peak, -(double)INFINITY, there.high + slack);
    }
}

// The gap to a wall's face, which may swing or come back on its own.
static double gap_to_face(const motion *m, size_t i)
{
    return m->of[GAP][i] + or_zero(m->of[FACE_DEPTH][i]);
}

// Leaves of the wall by more than 1 um after first contact: surely, and perhaps.
static void check_separations(rig *r, const motion *m, double first)
{
    const double far = 1e-6, unsure = 1e-9;
    int surely = 0, perhaps = 0;
    bool away_surely = false, away_perhaps = false;
    for (size_t i = 0; i < m->count; i++) {
        const double gap = m->of[CONTACT][i] != 0 ? 0 : gap_to_face(m, i);
        if (m->of[TIME][i] <= first) {
            continue;
        }
        if (gap > far + unsure && !away_surely) {
            surely++;
            away_surely = true;
        }
        if (gap > far - unsure && !away_perhaps) {
            perhaps++;
            away_perhaps = true;
        }
        if (gap <= unsure) {
            away_surely = away_perhaps = false;
        }
    }
    expect(r, "separations", first, quantity(m, "separations"), surely, perhaps);
}

// The mean over the last 0.1 s, and what is made of it.
static void check_steady(rig *r, const motion *m, const pieces *force, const touches *t)
{
    double error;
    const double span = fmin(0.1, m->ends);
    const double steady = integral(force, m->ends - span, m->ends, &error) / span;
    const double said = quantity(m, "steady_force_N"), peak = peak_of(m);
    error = error / span + 1e-9 * (1 + fabs(steady));
    expect_near(r, "steady_force_N", m->ends, said, steady, error);
    expect(r, "steady within peak", m->ends, said, -1e-9, peak * (1 + 1e-9) + 1e-9);

    // overshoot
    if (steady > 1e-3) {
        const double over = 100 * (peak - steady) / steady;
        expect_near(r, "force_overshoot_percent", m->ends,
                    quantity(m, "force_overshoot_percent"), over,
                    100 * peak / steady * (error / steady + 1e-9));
    }

    // settled once the force stays within 5 % of its final value: with a wider and a
    // narrower band
    if (steady > 1e-3) {
        double earliest = t->first, latest = t->first;
        for (size_t i = 0; i < force->count; i++) {
            const piece *p = &force->of[i];
            const double off = fmax(fabs(p->begin - steady), fabs(p->end - steady));
            if (p->from < t->first - INSTANT) {
                continue;
            }
            if (off - p->error > 0.05 * steady + error) {
                earliest = fabs(p->end - steady) > 0.05 * steady + error + p->error
                               ? p->to
                               : p->from;
            }
            if (off + p->error > 0.05 * steady - error) {
                latest = p->to;
            }
        }
        const double settled = quantity(m, "settling_time_s");
        if (isnan(settled)) {
            expect(r, "settling_time_s is null, settled", m->ends, latest,
                   m->ends - 2 * spacing, (double)INFINITY);
        } else {
            expect(r, "settling_time_s", m->ends, settled, earliest - t->first - INSTANT,
                   latest - t->first + INSTANT);
        }
    }
}

// Whether the commanded force is the same all the time.
static bool commands_one_force(const rig *r)
{
    bool one = number(r, "control.force_amplitude") == 0;
    for (int k = 0; k < r->change_count; k++) {
        one = one && strcmp(r->changes[k].path, "control.force") != 0;
    }
    return one;
}

// The largest mean of the force over 5 ms, impulses included, with windows from 20 ms
// after first contact on: bounds of it.
static void check_smoothed(rig *r, const motion *m, const pieces *force,
                           const blow_list *impulses, const touches *t)
{
    const double window = 0.005, from = t->first + 0.02;
    const double said = quantity(m, "smoothed_over_command_N");
    const double wanted = quantity(m, "force_command_N");
    if (isnan(said) || m->ends < from + window || !commands_one_force(r)) {
        return;
    }

    // running integral at the ends of pieces
    double *sum = malloc((force->count + 1) * sizeof(double)), low = -(double)INFINITY,
           high = -(double)INFINITY;
    double error = 0;
    sum[0] = 0;
    for (size_t i = 0; i < force->count; i++) {
        const piece *p = &force->of[i];
        sum[i + 1] = sum[i] + (p->to - p->from) * (p->begin + p->end) / 2;
        error = fmax(error, p->error);
    }

    // windows that end with a piece or begin with one, and with each impulse at an end
    size_t tail = 0;
    for (size_t i = 0; i < force->count; i++) {
        const double end = force->of[i].to, begin = end - window;
        if (begin < from - spacing) {
            continue;
        }
        while (force->of[tail].to < begin) {
            tail++;
        }
        const piece *p = &force->of[tail];
        const double part = (p->to - begin) * (value_within(p, begin) + p->end) / 2 +
                            sum[i + 1] - sum[tail + 1];
        double struck = 0, perhaps = 0;
        for (size_t k = 0; k < impulses->count; k++) {
            const double at = impulses->of[k].time;
            struck += at > begin + 1e-12 && at < end + 1e-12 ? impulses->of[k].size : 0;
            perhaps +=
                at > begin - spacing && at < end + spacing ? impulses->of[k].size : 0;
        }
        if (begin >= from) {
            low = fmax(low, (part + struck) / window);
        }
        const double rest = 2 * spacing * (fabs(force->of[i].end) + fabs(p->begin));
        high = fmax(high, (part + perhaps + rest) / window);
    }
    free(sum);
    const double slack = error + 1e-9 * fabs(high) + 1e-9;
    expect(r, "smoothed_over_command_N", from, said + wanted, low - slack, high + slack);
    expect(r, "smoothed within peak and impulses", from, said + wanted, -(double)INFINITY,
           peak_of(m) + t->impulses / window + 1e-9);
}

// The largest reading of a sensor of 1 ms, of all that the force does.
static void check_sensor_peak(rig *r, const motion *m, const pieces *force,
                              const blow_list *impulses)
{
    const char *key = "sensor_1ms_peak_N";
    if (!has_quantity(m, key)) {
        return;
    }
    double low = -(double)INFINITY, high = -(double)INFINITY;
    follower f = {.of = force, .blows = impulses, .state = {.T = 1e-3}};
    for (size_t i = 0; i < force->count; i++) {
        const double end = force->of[i].to;
        follower_reach(&f, end);
        lag after = f.state;
        for (size_t k = f.blow;
             k < impulses->count && impulses->of[k].time <= end + 1e-13; k++) {
            lag_strike(&after, impulses->of[k].size);
        }
        const double above =
            turning(&f.state, &force->of[i], force->of[i].to - force->of[i].from);
        low = fmax(low, after.y - after.y_error);
        high = fmax(high, fmax(after.y, f.state.y + above) + after.y_error);
    }
    if (impulses->count == 0 && high < 1e-9) {
        return;
    }
    const double slack = FOLLOWED_PEAK * fabs(high) + 1e-9;
    expect(r, key, 0, quantity(m, key), low - slack, high + slack);
}

static double largest_of(const motion *m, const double *column, double sign)
{
    double most = -(double)INFINITY;
    for (size_t i = 0; i < m->count; i++) {
        most = fmax(most, sign * column[i]);
    }
    return most;
}

// The largest speed towards the wall up to an instant, or beyond it without contact.
static largest speed_towards(const motion *m, bool before, double t)
{
    largest l = {-(double)INFINITY, -(double)INFINITY};
    pieces gap_rate = pieces_of(m, m->of[GAP_VELOCITY]);
    for (size_t i = 0; i < m->count; i++) {
        const double at = m->of[TIME][i];
        if (before ? at <= t && m->of[CONTACT][i] == 0
                   : at > t && m->of[CONTACT][i] == 0) {
            l.low = fmax(l.low, -m->of[GAP_VELOCITY][i]);
        }
    }
    double error = 0;
    for (size_t i = 0; i < gap_rate.count; i++) {
        error = fmax(error, gap_rate.of[i].error);
    }
    free(gap_rate.of);
    l.high = l.low + error;
    return l;
}

// The largest speed towards a face in flights after an instant: a mean between two rows
// is below it, by no more than means of neighbours differ.
static largest speed_towards_face(const motion *m, double t)
{
    double before = (double)NAN, apart = 0, most = 0;
    for (size_t i = 0; i + 1 < m->count; i++) {
        const double h = m->of[TIME][i + 1] - m->of[TIME][i];
        const bool flight = m->of[CONTACT][i] == 0 && m->of[CONTACT][i + 1] == 0;
        if (m->of[TIME][i] <= t || !flight || h < spacing / 4) {
            before = flight ? before : (double)NAN;
            continue;
        }
        const double speed = (gap_to_face(m, i) - gap_to_face(m, i + 1)) / h;
        most = fmax(most, speed);
        apart = fmax(apart, or_zero(fabs(speed - before)));
        before = speed;
    }
    return (largest){most, most + 2 * apart};
}

// Numbers of the command and of the speeds.
static void check_law(rig *r, const motion *m, const touches *t)
{
    // what was commanded; with a law only
    if (m->sample_count == 0) {
        return;
    }
    const double wanted = number_at(r, "control.force", m->ends),
                 peak = quantity(m, "peak_force_N");
    expect_near(r, "force_command_N", m->ends, quantity(m, "force_command_N"), wanted,
                1e-9);
    if (!isnan(peak) && commands_one_force(r)) {
        expect_near(r, "force_over_command_N", 0, quantity(m, "force_over_command_N"),
                    peak - wanted, 1e-9);
    }
    if (!isnan(t->first) && commands_one_force(r)) {
        expect_near(r, "steady_error_N", 0, quantity(m, "steady_error_N"),
                    quantity(m, "steady_force_N") - wanted, 1e-9);
    }
    const double command =
        fmax(largest_of(m, m->of[VOLTAGE], 1), largest_of(m, m->of[VOLTAGE], -1));
    expect_near(r, "largest_command_V", 0, quantity(m, "largest_command_V"), command,
                1e-9);

    // speeds
    largest l = speed_towards(m, true, isnan(t->first) ? m->ends : t->first);
    expect(r, "approach_speed_m_s", 0, quantity(m, "approach_speed_m_s"), l.low - 1e-9,
           l.high + 1e-9);
    if (!isnan(t->first)) {
        const bool gives = !isnan(m->of[FACE_DEPTH][m->count - 1]);
        l = gives ? speed_towards_face(m, t->first) : speed_towards(m, false, t->first);
        const double said = or_zero(quantity(m, "return_speed_m_s"));
        expect(r, "return_speed_m_s", 0, said, fmax(0, l.low) - 1e-9,
               fmax(0, l.high) + 1e-9);
    }
}

static void check_depth(rig *r, const motion *m)
{
    const bool rigid = is(r, "wall.contact", "rigid");
    const double deepest = fmax(0, largest_of(m, m->of[GAP], -1));
    pieces gap = pieces_of(m, m->of[GAP]);
    double error = 1e-12;
    for (size_t i = 0; i < gap.count; i++) {
        error = fmax(error, gap.of[i].begin < 0 ? gap.of[i].error : 0);
    }
    free(gap.of);
    expect(r, "max_penetration_m", 0, quantity(m, "max_penetration_m"), deepest - 1e-12,
           rigid ? 1e-9 : deepest + error);
    const double loss = quantity(m, "wall_loss_J");
    if (!isnan(loss)) {
        expect_near(r, "wall_loss_J", m->ends, loss, m->of[WALL_LOSS][m->count - 1],
                    1e-15);
    }
}

// Impulses and losses of impacts on a wall at rest: those of events, of rows, and by the
// formula.
static void check_impacts(rig *r, const motion *m)
{
    double impulses = 0, losses = 0, of_rows = 0, heaviest = 0;
    const bool at_rest = is(r, "wall.motion", "none") && number(r, "wall.mass") == 0;
    const double rest_speed = number(r, "method.rest_speed");
    bool chatter = false;
    for (size_t i = 0; i < impactlab_run_event_count(m->run); i++) {
        impactlab_event e;
        impactlab_run_event(m->run, i, &e);
        chatter = chatter || strcmp(e.kind, "chatter") == 0;
    }
    for (size_t i = 0; i < impactlab_run_event_count(m->run); i++) {
        impactlab_event e;
        impactlab_run_event(m->run, i, &e);
        if (strcmp(e.kind, "impact") != 0) {
            continue;
        }
        impulses += e.impulse;
        losses += e.loss;
        heaviest = fmax(heaviest, e.impulse);
        if (at_rest && !chatter) {
            const double restitution =
                e.speed < rest_speed ? 0 : number(r, "wall.restitution");
            const double loss = e.impulse * (1 - restitution) * e.speed / 2;
            expect_near(r, "loss of an impact", e.time, e.loss, loss,
                        1e-9 * loss + 1e-15);
        }
    }
    for (size_t i = 0; i < m->count; i++) {
        of_rows += or_zero(m->of[IMPULSE][i]);
    }
    expect_near(r, "impulses of the rows", m->ends, of_rows, impulses,
                1e-12 * (1 + impulses));
    expect_near(r, "impact_loss", m->ends, m->of[IMPACT_LOSS][m->count - 1], losses,
                1e-12 * (1 + losses));
}

// The force of a wall that gives, from its depth and rate; without a mass.
static void check_contact_law(rig *r, const motion *m)
{
    const bool linear = is(r, "wall.contact", "kelvin-voigt");
    if (is(r, "wall.contact", "rigid") || number(r, "wall.mass") > 0) {
        return;
    }
    const double k = number(r, "wall.stiffness"), c = number(r, "wall.damping");
    const double n = number(r, "wall.exponent");
    for (size_t i = 0; i < m->count; i++) {
        const double x = -m->of[GAP][i], v = -m->of[GAP_VELOCITY][i];
        if (m->of[CONTACT][i] != 0 && x > 0) {
            const double power = linear ? 1 : pow(x, n);
            const double force = linear ? k * x + c * v : power * (k + c * v);
            const double parts = (linear ? k * x : k * power) + c * power * fabs(v);
            expect_near(r, "force of the wall", m->of[TIME][i], m->of[FORCE][i], force,
                        1e-9 * parts + 1e-9);
        }
    }
}

static void check_summary(rig *r, const motion *m, const pieces *force,
                          const blow_list *impulses)
{
    const touches t = touches_of(m);
    expect_near(r, "first_contact_s", 0, quantity(m, "first_contact_s"), t.first, 1e-12);
    expect_near(r, "impacts", 0, quantity(m, "impacts"), t.impacts, 0);
    expect_near(r, "contact_impulse_Ns", 0, quantity(m, "contact_impulse_Ns"),
                isnan(t.first) ? (double)NAN : t.impulse, 1e-12);
    check_depth(r, m);
    check_impacts(r, m);
    check_law(r, m, &t);
    if (isnan(t.first)) {
        return;
    }
    const double until = isnan(t.release) ? m->ends : t.release;
    check_peak(r, m, force, "peak_force_N", "time_to_peak_s", t.first, m->ends);
    if (quantity(m, "first_pulse_peak_N") > 0) {
        check_peak(r, m, force, "first_pulse_peak_N", "first_pulse_time_to_peak_s",
                   t.first, until);
    }
    expect_near(r, "first_pulse_s", 0, quantity(m, "first_pulse_s"), t.release - t.first,
                1e-12);
    check_separations(r, m, t.first);
    check_steady(r, m, force, &t);
    check_smoothed(r, m, force, impulses, &t);
    check_sensor_peak(r, m, force, impulses);
}

// --- energy ----------------------------------------------------------------------------

// The ledger row by row; returns the largest sum of energies.
static double check_ledger(rig *r, const motion *m)
{
    double *const *c = m->of;
    double first = 0, scale = 0;
    for (size_t i = 0; i < m->count; i++) {
        const double stored = c[KINETIC][i] + c[STRAIN][i] + or_zero(c[WALL_ENERGY][i]) +
                              or_zero(c[WEIGHT_ENERGY][i]);
        const double lost = c[VISCOUS_LOSS][i] + c[FRICTION_LOSS][i] +
                            c[DAMPING_LOSS][i] + c[IMPACT_LOSS][i] +
                            or_zero(c[WALL_LOSS][i]);
        const double given_in =
            c[MOTOR_WORK][i] + c[EXTERNAL_WORK][i] + or_zero(c[WALL_WORK][i]);
        first = i == 0 ? stored - given_in + lost : first;
        scale = fmax(scale, fabs(stored) + fabs(lost) + fabs(given_in));
        expect_near(r, "energy_residual", c[TIME][i], c[RESIDUAL][i],
                    stored + lost - given_in - first, 1e-12 * scale + 1e-15);
    }
    const double open =
        fmax(largest_of(m, c[RESIDUAL], 1), largest_of(m, c[RESIDUAL], -1));
    expect(r, "energy_residual_J", 0, quantity(m, "energy_residual_J"),
           open - ROUNDING * scale, (double)INFINITY);
    expect_near(r, "motor_work_J", 0, quantity(m, "motor_work_J"),
                c[MOTOR_WORK][m->count - 1], 1e-12 * scale);
    return scale;
}

// A power of each row [W].
typedef double (*power_of)(const rig *r, const motion *m, size_t row);

// The current without that of the back EMF, which flows where no inductance delays it
// [A].
static double current_at(const rig *r, const motion *m, size_t i)
{
    const double stalled = m->of[MOTOR_TORQUE][i] / number(r, "motor.torque_constant");
    const bool at_once =
        is(r, "motor.drive", "voltage") && number(r, "motor.inductance") == 0;
    const double EMF = number(r, "motor.back_emf") * m->of[HUB_VELOCITY][i];
    return at_once ? stalled - EMF / number(r, "motor.resistance") : stalled;
}

static double fed_power(const rig *r, const motion *m, size_t i)
{
    const double current = current_at(r, m, i);
    if (is(r, "motor.drive", "voltage")) {
        return number(r, "motor.amplifier_gain") * m->of[VOLTAGE][i] * current;
    }
    const double EMF = number(r, "motor.back_emf") * m->of[HUB_VELOCITY][i];
    return number(r, "motor.resistance") * current * current + EMF * current;
}

static double motor_power(const rig *r, const motion *m, size_t i)
{
    (void)r;
    return m->of[MOTOR_TORQUE][i] * m->of[HUB_VELOCITY][i];
}

static double friction_power(const rig *r, const motion *m, size_t i)
{
    return number(r, "motor.stiction") * fabs(m->of[HUB_VELOCITY][i]);
}

// Back EMF counts with the friction where the current follows at once.
static double viscous_power(const rig *r, const motion *m, size_t i)
{
    const bool at_once =
        is(r, "motor.drive", "voltage") && number(r, "motor.inductance") == 0;
    double kv = number(r, "motor.viscous_friction");
    if (at_once) {
        kv += number(r, "motor.torque_constant") * number(r, "motor.back_emf") /
              number(r, "motor.resistance");
    }
    return kv * m->of[HUB_VELOCITY][i] * m->of[HUB_VELOCITY][i];
}

// An energy that is to be the integral of a power.
static void expect_energy(rig *r, const motion *m, const char *what, double got,
                          power_of power, double scale)
{
    double *values = malloc(m->count * sizeof(double)), error;
    for (size_t i = 0; i < m->count; i++) {
        values[i] = power(r, m, i);
    }
    pieces p = pieces_of(m, values);
    const double energy = integral(&p, 0, m->ends, &error);
    expect_near(r, what, m->ends, got, energy, error + 1e-8 * scale);
    free(p.of);
    free(values);
}

static void check_energy(rig *r, const motion *m)
{
    const double scale = check_ledger(r, m), fed = quantity(m, "electrical_energy_J");
    const size_t last = m->count - 1;
    expect_energy(r, m, "motor_work", m->of[MOTOR_WORK][last], motor_power, scale);
    expect_energy(r, m, "friction_loss", m->of[FRICTION_LOSS][last], friction_power,
                  scale);
    if (number(r, "motor.current_limit") == 0) {
        expect_energy(r, m, "viscous_loss", m->of[VISCOUS_LOSS][last], viscous_power,
                      scale);
    }
    if (!isnan(fed) && number(r, "motor.current_limit") == 0) {
        expect_energy(r, m, "electrical_energy_J", fed, fed_power, scale);
    }
}

// --- noise -----------------------------------------------------------------------------

// Each sensor's noise [V] at its converter: what readings with it differ by from those
// without, on a motion that no reading changes.
static void check_noise(rig *r)
{
    static const char *const common[] = {"control.law=open-loop",
                                         "control.rate=1000",
                                         "control.approach_voltage=2",
                                         "wall.contact=kelvin-voigt",
                                         "wall.angle=0.02",
                                         "sensor.adc_bits=0",
                                         "sensor.adc_range=100",
                                         "sensor.piezo=true",
                                         "sensor.film=true",
                                         "sensor.accelerometer=true",
                                         "sensor.piezo_range=0",
                                         "sensor.accelerometer_range=0",
                                         "sensor.fsr_saturation=1000",
                                         "run.duration=3"};
    static const struct {
        const char *path, *volts;
        double deviation;
    } noises[] = {{"sensor.tachometer_noise", "sensor.tachometer_gain", 0.02},
                  {"sensor.fsr_noise", NULL, 0.005},
                  {"sensor.piezo_noise", "sensor.piezo_gain", 0.03},
                  {"sensor.film_noise", "sensor.film_gain", 0.04},
                  {"sensor.accelerometer_noise", "sensor.accelerometer_gain", 0.05}};
    enum { NOISES = 5, COMMON = sizeof common / sizeof common[0] };
    static motion with[2];
    impactlab_error error;

    // both runs
    for (int noisy = 0; noisy < 2; noisy++) {
        *r = (rig){.number = UINT64_MAX};
        const char *all[MOST_SETTINGS];
        for (int k = 0; k < COMMON; k++) {
            set(r, "%s", common[k]);
        }
        for (int k = 0; k < NOISES; k++) {
            set(r, "%s=%g", noises[k].path, noisy ? noises[k].deviation : 0);
        }
        for (int k = 0; k < r->count; k++) {
            all[k] = r->settings[k];
        }
        if (impactlab_scenario_create(&r->scenario, &error) != IMPACTLAB_OK ||
            impactlab_scenario_set_all(r->scenario, all, (size_t)r->count, &error) !=
                IMPACTLAB_OK) {
            fail("noise", &error);
        }
        with[noisy] = (motion){0};
        read_samples(r, &with[noisy]);
        if (!noisy) {
            impactlab_scenario_destroy(r->scenario);
        }
    }

    // five standard deviations of a mean and of a variance
    for (int k = 0; k < NOISES; k++) {
        double sum = 0, squares = 0, count = 0;
        for (int i = 0; i < with[0].sample_count; i++) {
            const double clean = with[0].samples[i].reading[k + 1];
            const double noisy = with[1].samples[i].reading[k + 1];
            double volts = 0;
            if (noises[k].volts != NULL) {
                volts = (noisy - clean) * number(r, noises[k].volts);
            } else if (clean > 0.2 && clean < 100) {
                volts = fsr_volts(r, noisy) - fsr_volts(r, clean);
            } else {
                continue;
            }
            sum += volts;
            squares += volts * volts;
            count++;
        }
        const double sigma = noises[k].deviation;
        expect(r, "samples with noise", 0, count, 1000, (double)INFINITY);
        expect_near(r, noises[k].path, 0, sum / count, 0, 5 * sigma / sqrt(count));
        expect_near(r, noises[k].path, 0, squares / count, sigma * sigma,
                    5 * sigma * sigma * sqrt(2 / count));
    }
    impactlab_scenario_destroy(r->scenario);
}

// --- all of it -------------------------------------------------------------------------

typedef struct tally {
    long runs, wrong, refused, failed, inaccurate, samples, contacts;
} tally;

static void check_one(uint64_t which, tally *t)
{
    static motion m;
    impactlab_error error;
    rig r;

    // the run
    if (!draw(&r, which)) {
        t->refused++;
        impactlab_scenario_destroy(r.scenario);
        return;
    }
    m = (motion){0};
    const int status =
        impactlab_run_create(&m.run, r.scenario, IMPACTLAB_KEEP_ROWS, &error);
    if (m.run == NULL || status != IMPACTLAB_OK) {
        t->failed++;
        printf("%" PRIu64 ": failed: %s\n", which, error.sentence);
        impactlab_run_destroy(m.run);
        impactlab_scenario_destroy(r.scenario);
        return;
    }
    t->runs++;
    t->inaccurate += strcmp(impactlab_run_status(m.run), "ok") != 0;

    // what it says
    read_rows(&m);
    read_samples(&r, &m);
    follow_commands(&r, &m);
    t->samples += m.sample_count;
    t->contacts += !isnan(quantity(&m, "first_contact_s"));
    check_rows(&r, &m);
    check_instants(&r, &m);
    pieces force = pieces_of(&m, m.of[FORCE]);
    blow_list impulses = impulses_of(&m);
    check_angles(&r, &m);
    check_fsr(&r, &m, &force, &impulses);
    check_optional(&r, &m, &force, &impulses);
    check_summary(&r, &m, &force, &impulses);
    check_contact_law(&r, &m);
    check_energy(&r, &m);
    if (r.wrong > 0) {
        t->wrong++;
        printf("    impactlab run corrected/first-impact");
        for (int k = 0; k < r.count; k++) {
            printf(" --set %s", r.settings[k]);
        }
        for (int k = 0; k < r.change_count; k++) {
            printf(" # at %.9g s %s=%.9g", r.changes[k].at, r.changes[k].path,
                   r.changes[k].value);
        }
        printf("\n");
    }

    free(force.of);
    free(impulses.of);
    forget(&m);
    impactlab_scenario_destroy(r.scenario);
}

// Rigs that were found wrong: a play that forgot impacts, a current beyond its limit,
// means of a force that were not its own.
static const uint64_t once_wrong[] = {166, 276, 1238, 1325};

int main(int argc, char **argv)
{
    const uint64_t count = argc > 1 ? strtoull(argv[1], NULL, 10) : 25;
    const uint64_t first = argc > 2 ? strtoull(argv[2], NULL, 10) : 0;
    spacing = argc > 3 ? atof(argv[3]) : spacing;
    given = argv + 4;
    given_count = argc > 4 ? argc - 4 : 0;
    tally t = {0};
    for (size_t k = 0; count > 1 && k < sizeof once_wrong / sizeof once_wrong[0]; k++) {
        check_one(once_wrong[k], &t);
    }
    for (uint64_t i = first; i < first + count; i++) {
        check_one(i, &t);
        fflush(stdout);
    }
    rig noisy;
    check_noise(&noisy);
    t.wrong += noisy.wrong > 0;
    for (int k = 0; k < kind_count; k++) {
        printf("    %s: %ld rigs, %ld values, off by up to %.3g (rig %" PRIu64 ")\n",
               kinds[k].what, kinds[k].rigs, kinds[k].values, kinds[k].worst,
               kinds[k].worst_rig);
    }
    printf("%ld rigs, %ld wrong; %ld refused, %ld failed, %ld inaccurate, %ld "
           "touched a wall; %ld samples, %ld values compared\n",
           t.runs, t.wrong, t.refused, t.failed, t.inaccurate, t.contacts, t.samples,
           checked);
    return t.wrong > 0 || t.runs == 0;
}
