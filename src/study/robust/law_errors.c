#include "src/study/robust/law_errors.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "src/base/plain_math.h"
#include "src/base/random.h"
#include "src/scenario/fitted_arm.h"

// A case that is being drawn.
typedef struct draft {
    drawn_case *made;
    int kind; // of error that is being drawn, -1: none
    const parameters *around;
    random_generator chance;
    double rate;          // of samples [Hz]
    double jitter;        // of their instants [s]
    char *jitter_setting; // NULL: none
} draft;

// A number of [low, high), evenly spread.
static double draw_uniform(draft *d, double low, double high)
{
    return low + (high - low) * random_uniform(&d->chance);
}

// A number of [low, high) whose logarithm is evenly spread.
static double draw_logarithmic(draft *d, double low, double high)
{
    return low * plain_exp(plain_log(high / low) * random_uniform(&d->chance));
}

// A number of 0 ... count - 1.
static int draw_below(draft *d, int count)
{
    return (int)random_below(&d->chance, (uint64_t)count);
}

// Adds a setting, and returns where it stands.
static __attribute__((format(printf, 2, 3))) char *add(draft *d, const char *format, ...)
{
    drawn_case *c = d->made;
    assert(c->setting_count < DRAWN_CASE_SETTINGS);
    c->of[c->setting_count] = d->kind;
    char *setting = c->settings[c->setting_count++];
    va_list list;
    va_start(list, format);
    vsnprintf(setting, DRAWN_SETTING_LENGTH, format, list);
    va_end(list);
    return setting;
}

// --- walls -----------------------------------------------------------------------------

static void draw_giving_wall(draft *d)
{
    const char *contact = draw_below(d, 2) == 1 ? "hunt-crossley" : "kelvin-voigt";
    add(d, "wall.contact=%s", contact);
    add(d, "wall.stiffness=%.6g", draw_logarithmic(d, 200, 1e6));
}

static void draw_light_face(draft *d)
{
    add(d, "wall.contact=kelvin-voigt");
    add(d, "wall.stiffness=%.6g", draw_logarithmic(d, 200, 1e6));
    add(d, "wall.mass=%.6g", draw_logarithmic(d, 0.005, 0.1));
}

static void draw_heavy_face(draft *d)
{
    add(d, "wall.contact=kelvin-voigt");
    add(d, "wall.stiffness=%.6g", draw_logarithmic(d, 500, 1e5));
    add(d, "wall.damping=%.3g", draw_logarithmic(d, 1, 20));
    add(d, "wall.mass=%.3g", draw_logarithmic(d, 0.05, 0.3));
}

static void draw_soft_wall(draft *d)
{
    add(d, "wall.contact=kelvin-voigt");
    add(d, "wall.stiffness=%.6g", draw_logarithmic(d, 200, 5000));
    add(d, "wall.damping=%.3g", draw_logarithmic(d, 1, 20));
}

static void draw_restitution(draft *d)
{
    add(d, "wall.restitution=%.6g", draw_uniform(d, 0, 0.5));
}

static void draw_flat_wall(draft *d)
{
    add(d, "wall.kind=plane");
}

// --- arms ------------------------------------------------------------------------------

static void draw_tip_mass(draft *d)
{
    add(d, "arm.tip_mass=%.6g", draw_uniform(d, 0.02, 0.1));
}

static void draw_links(draft *d)
{
    const int links = 3 + draw_below(d, 6);
    add(d, "arm.links=%d", links);
    add(d, "arm.damping_ratio=0.01");
    if (draw_below(d, 2) == 1) {
        add(d, "belief.links=%d", links);
    }
}

static void draw_hub_spring(draft *d)
{
    add(d, "arm.hub_joint=spring");
    add(d, "arm.k1=%.4g", draw_uniform(d, 80, 150));
    add(d, "belief.hub_spring_factor=%.4g", draw_below(d, 2) == 1 ? 100.0 : 1.0);
}

static void draw_length(draft *d)
{
    add(d, "arm.length=%.4g", d->around->arm.length * draw_uniform(d, 0.75, 1.25));
}

static void draw_joint_stiffness(draft *d)
{
    add(d, "arm.k2=%.4g", d->around->arm.k2 * draw_logarithmic(d, 0.5, 2.5));
}

static void draw_stiffening(draft *d)
{
    add(d, "arm.stiffening=%.3g", draw_uniform(d, 0, 5));
}

static void draw_hub_inertia(draft *d)
{
    add(d, "arm.hub_inertia=%.4g",
        d->around->arm.hub_inertia * draw_logarithmic(d, 0.7, 4));
}

// --- what is believed of them ----------------------------------------------------------

static void draw_believed_mass(draft *d)
{
    add(d, "belief.mass_factor=%.4g", draw_uniform(d, 0.85, 1.15));
}

static void draw_believed_inertia(draft *d)
{
    add(d, "belief.inertia_factor=%.4g", draw_uniform(d, 0.8, 1.2));
}

static void draw_believed_friction(draft *d)
{
    add(d, "belief.friction_factor=%.4g", draw_uniform(d, 0.7, 1.3));
}

static void draw_believed_torque(draft *d)
{
    add(d, "belief.torque_factor=%.4g", draw_uniform(d, 0.85, 1.15));
}

static void draw_believed_stiffness(draft *d)
{
    add(d, "belief.k2_factor=%.4g", draw_uniform(d, 0.75, 1.25));
}

static void draw_believed_wall(draft *d)
{
    add(d, "belief.wall_error=%.4g", draw_uniform(d, -0.03, 0.03));
}

// --- motor, start and what comes from outside ------------------------------------------

static void draw_stiction(draft *d)
{
    add(d, "motor.stiction=%.4g", draw_uniform(d, 0.01, 0.09));
    add(d, "belief.friction_factor=%.4g", draw_logarithmic(d, 0.5, 1.6));
}

static void draw_inductance(draft *d)
{
    add(d, "motor.inductance=%.3g", draw_uniform(d, 0.02, 0.15));
}

static void draw_start(draft *d)
{
    add(d, "initial.angle=%.4g", d->around->wall.angle - draw_logarithmic(d, 0.07, 0.5));
}

static void draw_push(draft *d)
{
    d->made->push = draw_uniform(d, -0.06, 0.06);
    d->made->push_time = draw_uniform(d, 0.9, 1.1);
}

// --- sensors and computer --------------------------------------------------------------

static void draw_rate(draft *d)
{
    d->rate = draw_logarithmic(d, 100, 1000);
    add(d, "control.rate=%.6g", d->rate);
}

// A delay of up to two periods that the law knows, or of up to one that it does not.
static void draw_delay(draft *d)
{
    const bool known = draw_below(d, 2) == 1;
    add(d, "control.delay_periods=%.6g", draw_uniform(d, 0, known ? 2 : 1));
    if (!known) {
        add(d, "belief.delay_error=-2");
    }
}

static void draw_scattered_samples(draft *d)
{
    d->jitter = draw_uniform(d, 0, 1) * 1e-3;
    d->jitter_setting = add(d, "control.jitter=%.6g", d->jitter);
    add(d, "sensor.accelerometer=%s", draw_below(d, 2) == 1 ? "true" : "false");
}

static void draw_jitter(draft *d)
{
    d->jitter = draw_uniform(d, 0, 2.5e-3);
    d->jitter_setting = add(d, "control.jitter=%.3g", d->jitter);
}

// A jitter beyond the period of the samples becomes that period.
static void keep_jitter_within_period(draft *d)
{
    const double period = 0.999 / d->rate;
    if (d->jitter_setting != NULL && d->jitter > period) {
        snprintf(d->jitter_setting, DRAWN_SETTING_LENGTH, "control.jitter=%.6g", period);
    }
}

static void draw_tip_sensor(draft *d)
{
    add(d, "sensor.fsr_gain_error=%.6g", draw_uniform(d, -0.03, 0.03));
    add(d, "sensor.fsr_offset=%.6g", draw_uniform(d, -0.01, 0.01));
    add(d, "sensor.fsr_hysteresis=%.6g", draw_uniform(d, 0, 0.03));
}

static void draw_converters(draft *d)
{
    add(d, "sensor.adc_bits=%d", 10 + 2 * draw_below(d, 2));
    add(d, "sensor.dac_bits=%d", 8 + 2 * draw_below(d, 3));
    add(d, "sensor.fsr_noise=%.3g", draw_uniform(d, 0.02, 0.06));
}

static void draw_rise_time(draft *d)
{
    add(d, "sensor.fsr_rise_time=%.3g", draw_logarithmic(d, 0.0005, 0.01));
}

static void draw_hub_sensors(draft *d)
{
    add(d, "sensor.encoder_gain_error=%.6g", draw_uniform(d, -0.05, 0.05));
    add(d, "sensor.encoder_offset=%.6g", draw_uniform(d, -0.02, 0.02));
    add(d, "sensor.tachometer_gain_error=%.6g", draw_uniform(d, -0.05, 0.05));
    add(d, "sensor.tachometer_offset=%.6g", draw_uniform(d, -0.02, 0.02));
    add(d, "sensor.encoder_counts=1000");
    add(d, "sensor.tachometer_noise=0.05");
}

// --- the table -------------------------------------------------------------------------

// Errors of one subject exclude one another, since they set the same parameters.
typedef enum error_subject {
    OF_WALL,
    OF_TIP_MASS,
    OF_PUSH,
    OF_RATE,
    OF_DELAY,
    OF_TIP_SENSOR,
    OF_HUB_SENSORS,
    OF_SAMPLES,
    OF_JOINTS,
    OF_BELIEVED_MASS,
    OF_BELIEVED_INERTIA,
    OF_FRICTION,
    OF_BELIEVED_TORQUE,
    OF_BELIEVED_STIFFNESS,
    OF_BELIEVED_WALL,
    OF_START,
    OF_WALL_KIND,
    OF_LENGTH,
    OF_HUB_INERTIA,
    OF_INDUCTANCE,
} error_subject;

// The kinds, and how many of the tickets in the draw each has.
static const struct error_kind {
    const char *name;
    void (*draw)(draft *d);
    error_subject of;
    int tickets;
    bool of_arm; // recordings tell of it
} kinds[LAW_ERRORS] = {
    {"giving wall", draw_giving_wall, OF_WALL, 2, false},
    {"light face", draw_light_face, OF_WALL, 1, false},
    {"heavy face", draw_heavy_face, OF_WALL, 1, false},
    {"soft wall", draw_soft_wall, OF_WALL, 1, false},
    {"restitution", draw_restitution, OF_WALL, 2, false},
    {"tip mass", draw_tip_mass, OF_TIP_MASS, 2, true},
    {"push", draw_push, OF_PUSH, 2, false},
    {"rate", draw_rate, OF_RATE, 2, false},
    {"delay", draw_delay, OF_DELAY, 2, false},
    {"tip sensor", draw_tip_sensor, OF_TIP_SENSOR, 1, false},
    {"hub sensors", draw_hub_sensors, OF_HUB_SENSORS, 1, false},
    {"scattered samples", draw_scattered_samples, OF_SAMPLES, 1, false},
    {"links", draw_links, OF_JOINTS, 5, true},
    {"believed mass", draw_believed_mass, OF_BELIEVED_MASS, 1, true},
    {"believed inertia", draw_believed_inertia, OF_BELIEVED_INERTIA, 1, true},
    {"believed friction", draw_believed_friction, OF_FRICTION, 1, true},
    {"believed torque", draw_believed_torque, OF_BELIEVED_TORQUE, 2, true},
    {"believed stiffness", draw_believed_stiffness, OF_BELIEVED_STIFFNESS, 1, true},
    {"believed wall", draw_believed_wall, OF_BELIEVED_WALL, 2, false},
    {"hub spring", draw_hub_spring, OF_JOINTS, 1, true},
    {"start", draw_start, OF_START, 1, false},
    {"flat wall", draw_flat_wall, OF_WALL_KIND, 1, false},
    {"length", draw_length, OF_LENGTH, 1, true},
    {"joint stiffness", draw_joint_stiffness, OF_JOINTS, 1, true},
    {"hub inertia", draw_hub_inertia, OF_HUB_INERTIA, 1, true},
    {"stiction", draw_stiction, OF_FRICTION, 1, true},
    {"converters", draw_converters, OF_TIP_SENSOR, 1, false},
    {"rise time", draw_rise_time, OF_TIP_SENSOR, 1, false},
    {"inductance", draw_inductance, OF_INDUCTANCE, 1, true},
    {"jitter", draw_jitter, OF_SAMPLES, 1, false},
    {"stiffening", draw_stiffening, OF_JOINTS, 1, true},
};

enum { MOST_TICKETS = 64 };

const char *law_error_name(int kind)
{
    assert(kind >= 0 && kind < LAW_ERRORS);
    return kinds[kind].name;
}

// The kind of each ticket, without those of an arm that was fitted. Returns how many
// there are.
static size_t list_tickets(int *kind_of, bool fitted)
{
    size_t count = 0;
    for (int kind = 0; kind < LAW_ERRORS; kind++) {
        const int tickets = fitted && kinds[kind].of_arm ? 0 : kinds[kind].tickets;
        for (int i = 0; i < tickets; i++) {
            assert(count < MOST_TICKETS);
            kind_of[count++] = kind;
        }
    }
    return count;
}

// Adds an arm that the recordings leave possible, of which the law is told the fitted
// one.
static void draw_fitted_arm(draft *d, const scenario *around)
{
    double values[SCENARIO_FIT];
    fitted_arm_draw(around, &d->chance, values);
    for (int i = 0; i < around->fit->count; i++) {
        const int parameter = around->fit->parameters[i];
        add(d, "%s=%.9g", parameter_table[parameter].path, values[i]);
        const int belief = fitted_arm_belief(parameter);
        if (belief >= 0) {
            add(d, "%s=%.9g", parameter_table[belief].path,
                fitted_arm_believed(around, parameter, values[i]));
        }
    }
}

drawn_case drawn_case_of(const scenario *around, uint64_t seed)
{
    drawn_case c = {.setting_count = 0};
    draft d = {.made = &c,
               .kind = -1,
               .around = &around->parameters,
               .rate = around->parameters.control.rate};
    random_seed(&d.chance, seed);
    if (around->fit != NULL) {
        draw_fitted_arm(&d, around);
    }

    // two or three kinds: draw tickets in random order, and skip those whose subject
    // another error has changed
    int kind_of[MOST_TICKETS];
    size_t order[MOST_TICKETS];
    const size_t tickets = list_tickets(kind_of, around->fit != NULL);
    random_permutation(&d.chance, order, tickets);
    const int wanted = 2 + draw_below(&d, LAW_ERRORS_A_CASE - 1);
    unsigned changed = 0;
    for (size_t i = 0; i < tickets && c.error_count < wanted; i++) {
        const int kind = kind_of[order[i]];
        const unsigned subject = 1U << kinds[kind].of;
        if ((changed & subject) != 0) {
            continue;
        }
        changed |= subject;
        d.kind = kind;
        kinds[kind].draw(&d);
        c.errors[c.error_count++] = kind;
    }
    d.kind = -1;

    keep_jitter_within_period(&d);

    // every case has its own noise
    add(&d, "control.seed=%llu", (unsigned long long)seed);
    return c;
}

// Lists the base's actions in the order of time, and with `pushed` the case's push among
// them. Returns how many there are.
static int list_actions(const scenario *base, const drawn_case *c, bool pushed,
                        action *actions)
{
    const action push = {.time = c->push_time,
                         .kind = ACTION_PUSH,
                         .parameter = -1,
                         .value = c->push,
                         .added = true};
    bool waits = pushed && c->push != 0;
    int count = 0;
    for (int i = 0; i < base->action_count; i++) {
        if (waits && base->actions[i].time > push.time) {
            actions[count++] = push;
            waits = false;
        }
        actions[count++] = base->actions[i];
    }
    if (waits) {
        actions[count++] = push;
    }
    return count;
}

status drawn_case_scenario(scenario *derived, const scenario *base, const drawn_case *c,
                           bool pushed, action *actions, fault *f)
{
    *derived = *base;
    derived->actions = actions;
    derived->action_count = list_actions(base, c, pushed, actions);

    // some settings are refused until another one stands: only the second round counts
    fault why = {.path = ""};
    for (int i = 0; i < c->setting_count; i++) {
        scenario_override(derived, c->settings[i], &why);
    }
    for (int i = 0; i < c->setting_count; i++) {
        if (scenario_override(derived, c->settings[i], &why) != STATUS_OK) {
            return fault_set(f, STATUS_BAD_ARGUMENT,
                             "the error '%s' cannot be drawn around %s: %s",
                             c->settings[i], base->name, why.text);
        }
    }

    // behind the settings, which give all that the scenario does not set its default
    double *duration = &derived->parameters.run.duration;
    *duration = fmax(*duration, DRAWN_CASE_DURATION);
    return STATUS_OK;
}
