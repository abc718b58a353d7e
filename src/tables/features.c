#include "src/tables/features.h"

#include <assert.h>
#include <stdatomic.h>
#include <stdint.h>
#include <string.h>

#include "src/tables/parameters_parts.h"

// The features `bits` if a condition holds, else none.
static feature_set when(bool condition, feature_set bits)
{
    if (condition) {
        return bits;
    }
    return 0;
}

// The features of the model, the arm's links and joints, and the method.
static feature_set arm_features(const parameters *p)
{
    const arm_parameters *a = &p->arm;
    const bool joint = a->links > 1 || a->hub_joint == HUB_BEAM;
    const feature_set method[] = {HAS(EVENT), HAS(NEWMARK), HAS(ALPHA)};
    return when(a->model == ARM_PRINTED, HAS(PRINTED)) |
           when(a->model != ARM_PRINTED, HAS(CORRECTED)) |
           when(a->links == 2, HAS(TWO_LINKS)) | when(joint, HAS(JOINT) | HAS(BENDS)) |
           when(a->hub_joint == HUB_SPRING, HAS(HUB_SPRING) | HAS(BENDS)) |
           when(a->tip_mass != 0, HAS(TIP_MASS)) |
           when(!parameters_even_links(a), HAS(UNLIKE)) |
           when(p->printed.reevaluation != REEVALUATE_NONE, HAS(REEVALUATED)) |
           method[p->method.name];
}

// The features of motor and amplifier: what drives the motor, and what limits it.
static feature_set motor_features(const parameters *p)
{
    const motor_parameters *m = &p->motor;
    const bool volts = m->drive == DRIVE_VOLTAGE;
    const bool law = p->control.law != LAW_NONE;
    return when(volts, HAS(VOLTAGE_DRIVE)) | when(!volts, HAS(CURRENT_DRIVE)) |
           when(volts || !IS_SET(p, motor.transconductance), HAS(AMPLIFIED)) |
           when(law || m->voltage != 0, HAS(DRIVEN)) |
           when(volts && m->back_emf > 0, HAS(BRAKED)) |
           when(volts && m->current_limit > 0, HAS(LIMITED));
}

// The features of the wall, of its law of contact and of its motion; none without a wall.
static feature_set wall_features(const wall_parameters *w)
{
    static const feature_set contact[] = {0, HAS(KELVIN_VOIGT), HAS(HUNT_CROSSLEY)};
    static const feature_set motion[] = {0, HAS(MOVES) | HAS(MOVES_BY_FORMULA),
                                         HAS(MOVES) | HAS(MOVES_BY_FORMULA),
                                         HAS(MOVES) | HAS(MOVES_BY_FILE)};
    const bool struck = w->contact == WALL_RIGID || w->mass > 0;
    if (w->kind == WALL_NONE) {
        return 0;
    }
    return HAS(WALL) | motion[w->motion] | contact[w->contact] |
           when(struck, HAS(STRUCK)) | when(struck && w->restitution > 0, HAS(BOUNCES));
}

// The features of the rig: the kind of law, sensors that are fitted, and chance.
static feature_set rig_features(const parameters *p)
{
    const control_parameters *c = &p->control;
    const sensor_parameters *s = &p->sensor;
    const bool noise = s->tachometer_noise > 0 || s->fsr_noise > 0 ||
                       (s->piezo && s->piezo_noise > 0) ||
                       (s->film && s->film_noise > 0) ||
                       (s->accelerometer && s->accelerometer_noise > 0) ||
                       (s->tip_deflection && s->tip_deflection_noise > 0) ||
                       (s->root_strain && s->root_strain_noise > 0);
    return when(c->law == LAW_NONE, HAS(NO_LAW)) | when(c->law != LAW_NONE, HAS(LAW)) |
           when(c->law == LAW_PLUGIN, HAS(PLUGIN)) |
           when(c->law == LAW_PROCESS, HAS(PROCESS)) |
           when(c->law == LAW_PLAYBACK, HAS(PLAYBACK)) |
           when(c->force_amplitude > 0, HAS(FORCE_WAVES)) |
           when(c->force_limit > 0, HAS(FORCE_LIMIT)) | when(s->piezo, HAS(PIEZO)) |
           when(s->film, HAS(FILM)) | when(s->accelerometer, HAS(ACCELEROMETER)) |
           when(s->tip_deflection, HAS(TIP_DEFLECTION)) |
           when(s->root_strain, HAS(ROOT_STRAIN)) | when(!s->ideal, HAS(IMPERFECT)) |
           when(s->tachometer_ripple > 0, HAS(RIPPLE)) |
           when(c->jitter > 0 || (noise && !s->ideal), HAS(CHANCE));
}

// The features of the forces in force_list.h that act: those whose amount is not zero.
static feature_set force_features(const parameters *p)
{
    feature_set features = 0;
#define ADD_FEATURE(feature, law, path, amount, methods)                                 \
    features |= when((amount) != 0, HAS(feature));
    FORCE_LIST(ADD_FEATURE)
#undef ADD_FEATURE
    return features;
}

feature_set features_of(const parameters *p)
{
    return arm_features(p) | force_features(p) | motor_features(p) |
           wall_features(&p->wall) | rig_features(p);
}

// --- which parameters act --------------------------------------------------------------

// A parameter acts if each rule whose patterns fit its path is met. A rule is met by
// features that have at least one of the bits in `any`. The first rule that is not met
// says why the parameter does not act.
typedef struct rule {
    const char *paths; // patterns of paths, with blanks between them
    feature_set any;
    const char *why; // half a sentence
    bool refused;    // if not met, any value but the default is refused
} rule;

#define ONE_LINK "one link has no joint"
#define NOT_READ "the control law does not use it"

// Parameters of the forces in force_list.h that one method alone has: PATH_OF_FORCE of
// each.
#define PATH_OF_EVENT_ONLY(path) path " "
#define PATH_OF_ANY_METHOD(path)
#define PATH_OF_FORCE(feature, law, path, amount, methods) PATH_OF_##methods(path)

#define OF_LAWS                                                                          \
    "control.approach_voltage control.k[pv] control.gains control.coefficients "         \
    "control.transition_time control.contact_threshold control.force_gain "              \
    "control.integral_gain "                                                             \
    "control.speed_limit control.reverse_time control.switch_share control.travel_time " \
    "control.arrival_speed"

static const rule rules[] = {
    // models and methods
    {"printed.*", HAS(PRINTED), "it belongs to arm.model = printed"},
    {"wall.[!ka]* method.rest_speed printed.force_* printed.program "
     "printed.reevaluation printed.clamp_force printed.feed_newmark_acceleration",
     HAS(WALL), "there is no wall (wall.kind)"},
    {"arm.damping_ratio arm.modal_ratios arm.joint_* arm.link_lengths "
     "arm.link_masses arm.link_inertias arm.air_drag arm.stiffening arm.tip_mass "
     "arm.tilt "
     "wall.restitution method.rest_speed method.residual_bound",
     HAS(CORRECTED), "the printed model has none", true},
    {FORCE_LIST(PATH_OF_FORCE) "arm.joint_* arm.link_lengths arm.link_masses "
                               "arm.link_inertias wall.motion method.engine",
     HAS(EVENT), "it runs with method.name = event only", true},
    {"motor.current_limit", HAS(EVENT) | HAS(CURRENT_DRIVE),
     "under a voltage it runs with method.name = event only", true},
    {"printed.sign_dead_band", 0, "the last test of sign() overrules it"},
    {"printed.energy_cross_term", 0, "it is the energy predictor's, which no run takes"},
    {"printed.feed_newmark_acceleration", HAS(REEVALUATED),
     "nothing is re-evaluated (printed.reevaluation)"},
    {"method.beta method.gamma", HAS(NEWMARK), "it belongs to method.name = newmark"},
    {"method.spectral_radius", HAS(ALPHA),
     "it belongs to method.name = generalized-alpha"},
    {"method.engine", HAS(PAIR), "the stiff engine alone takes this arm"},
    {"method.tolerance", HAS(STIFF), "the stiff engine does not integrate this run"},

    // arm
    {"arm.k1", HAS(HUB_SPRING), "there is no hub spring (arm.hub_joint)"},
    {"arm.link_inertia", HAS(TWO_LINKS), "it is for two links only", true},
    {"arm.k2 arm.EI arm.joint_stiffness", HAS(JOINT) | HAS(TOLD_K2), ONE_LINK},
    {"arm.stiffening", HAS(JOINT), ONE_LINK},
    {"arm.damping_ratio", HAS(BENDS) | HAS(TOLD_DAMPING), ONE_LINK},
    {"arm.modal_ratios arm.joint_damping", HAS(BENDS), ONE_LINK},

    // motor
    {"motor.voltage", HAS(NO_LAW), "the control law commands the voltage"},
    {"motor.inductance", HAS(VOLTAGE_DRIVE), "it is for motor.drive = voltage", true},
    {"motor.transconductance", HAS(CURRENT_DRIVE), "it is for motor.drive = current",
     true},
    {"motor.amplifier_gain", HAS(AMPLIFIED),
     "motor.transconductance says what a command gives"},
    {"motor.back_emf", HAS(VOLTAGE_DRIVE) | HAS(LAW),
     "the amplifier holds a current (motor.drive)"},
    {"motor.resistance", HAS(AMPLIFIED) | HAS(LAW),
     "the amplifier holds a current of motor.transconductance"},
    {"motor.amplifier_gain motor.transconductance", HAS(DRIVEN), "the command is 0 V"},
    {"motor.torque_constant motor.resistance motor.drive", HAS(DRIVEN) | HAS(BRAKED),
     "the command is 0 V and there is no back EMF"},

    // wall
    {"wall.restitution method.rest_speed", HAS(STRUCK),
     "it is for wall.contact = rigid or a face with a mass", true},
    {"method.rest_speed", HAS(BOUNCES), "every impact is plastic (wall.restitution)"},
    {"wall.stiffness wall.damping", HAS(GIVES), "the wall does not give (wall.contact)"},
    {"wall.exponent", HAS(HUNT_CROSSLEY), "it is for wall.contact = hunt-crossley"},
    {"wall.mass", HAS(KELVIN_VOIGT),
     "it is for wall.contact = kelvin-voigt, on whose spring and damper the face stands",
     true},
    {"wall.motion_time", HAS(MOVES), "the wall rests (wall.motion)"},
    {"wall.motion_amplitude wall.motion_frequency", HAS(MOVES_BY_FORMULA),
     "it is for wall.motion = sine or step"},
    {"wall.motion_file", HAS(MOVES_BY_FILE), "it is for wall.motion = file"},

    // rig
    {"control.[!l]* control.lock sensor.* belief.*", HAS(LAW),
     "no control law is on (control.law)"},
    {"control.plugin", HAS(PLUGIN), "it belongs to control.law = plugin"},
    {"control.command control.answer_time", HAS(PROCESS),
     "it belongs to control.law = process"},
    {"control.playback_*", HAS(PLAYBACK), "it belongs to control.law = playback"},
    {"control.lock", HAS(LOCKABLE), "this law cannot be held in a mode"},
    {OF_LAWS, HAS(READ), NOT_READ},
    {OF_LAWS, HAS(ALONE), "control.settings gives it another value"},
    {"control.seed", HAS(CHANCE), "there is neither noise nor jitter"},
    {"control.force_rate control.force_amplitude control.force_frequency",
     HAS(FORCE_READ), "the control law does not use the force"},
    {"control.force_rate", HAS(FORCE_STEPS), "control.force does not change"},
    {"control.force_frequency", HAS(FORCE_WAVES),
     "the sine has no control.force_amplitude"},
    {"control.k2_table belief.k2_factor", HAS(TOLD_K2), NOT_READ},
    {"belief.mass_factor", HAS(TOLD_MASS), NOT_READ},
    {"belief.inertia_factor", HAS(TOLD_INERTIA), NOT_READ},
    {"belief.friction_factor", HAS(TOLD_FRICTION), NOT_READ},
    {"belief.torque_factor", HAS(TOLD_TORQUE), NOT_READ},
    {"belief.hub_spring_factor", HAS(HUB_SPRING),
     "there is no hub spring (arm.hub_joint)"},
    {"belief.hub_spring_factor", HAS(TOLD_HUB_SPRING), NOT_READ},
    {"belief.wall_error", HAS(TOLD_WALL), NOT_READ},
    {"belief.delay_error", HAS(TOLD_DELAY), NOT_READ},
    {"belief.links", HAS(TOLD_LINKS), NOT_READ},

    // sensors
    {"sensor.piezo_*", HAS(PIEZO), "no piezo sensor is fitted (sensor.piezo)"},
    {"sensor.film_*", HAS(FILM), "no piezo film is fitted (sensor.film)"},
    {"sensor.accelerometer_*", HAS(ACCELEROMETER),
     "none is fitted (sensor.accelerometer)"},
    {"sensor.tip_deflection_*", HAS(TIP_DEFLECTION),
     "none is fitted (sensor.tip_deflection)"},
    {"sensor.root_strain_*", HAS(ROOT_STRAIN), "no gauge is fitted (sensor.root_strain)"},
    {"sensor.*_noise sensor.*_error sensor.*_offset sensor.*_bits sensor.*_range "
     "sensor.*_rise_time sensor.*_leak_time sensor.encoder_counts "
     "sensor.tachometer_ripple* sensor.fsr_hysteresis",
     HAS(IMPERFECT), "the sensors are ideal (sensor.ideal)"},
    {"sensor.tachometer_ripple_count", HAS(RIPPLE),
     "there is no sensor.tachometer_ripple"},
};

enum { RULES = sizeof rules / sizeof rules[0], PATTERN_SIZE = 64 };
_Static_assert(RULES < 64, "a word has a bit for each rule, and the last bit");

// The last bit of a parameter's rules says that they have been looked up.
#define LOOKED_UP (UINT64_C(1) << 63)

// Whether a pattern fits a path: "*" is any text, "[ab]" one of these characters, "[!ab]"
// any other one.
static bool pattern_fits(const char *pattern, const char *path)
{
    if (*pattern == '*') {
        const bool rest_fits = pattern_fits(pattern + 1, path);
        return rest_fits || (*path != '\0' && pattern_fits(pattern, path + 1));
    }
    if (*pattern == '\0' || *path == '\0') {
        return *pattern == *path;
    }
    if (*pattern != '[') {
        return *pattern == *path && pattern_fits(pattern + 1, path + 1);
    }

    // one character of a set
    const bool others = pattern[1] == '!';
    const char *set = pattern + 1 + others, *end = strchr(set, ']');
    assert(end != NULL);
    const bool among = memchr(set, *path, (size_t)(end - set)) != NULL;
    return among != others && pattern_fits(end + 1, path + 1);
}

// Whether one of several patterns, which have blanks between them, fits a path.
static bool any_pattern_fits(const char *patterns, const char *path)
{
    for (const char *rest = patterns; *rest != '\0';) {
        const size_t length = strcspn(rest, " ");
        char pattern[PATTERN_SIZE] = "";

        // most patterns are of another group and differ in the first letter
        if (rest[0] == path[0]) {
            assert(length < sizeof pattern);
            memcpy(pattern, rest, length);
            if (pattern_fits(pattern, path)) {
                return true;
            }
        }
        rest += length + strspn(rest + length, " ");
    }
    return false;
}

// The rules whose patterns fit a parameter's path, bit i for rule i. They are looked up
// once and then remembered; threads that look them up at the same time find the same.
static uint64_t rules_of(int parameter)
{
    static _Atomic uint64_t known[sizeof(((parameters *)0)->set)];
    uint64_t found = atomic_load_explicit(&known[parameter], memory_order_relaxed);
    if (found != 0) {
        return found;
    }

    // the first time
    for (int i = 0; i < RULES; i++) {
        if (any_pattern_fits(rules[i].paths, parameter_table[parameter].path)) {
            found |= UINT64_C(1) << i;
        }
    }
    atomic_store_explicit(&known[parameter], found | LOOKED_UP, memory_order_relaxed);
    return found | LOOKED_UP;
}

// The first rule of a parameter that the features do not meet; NULL if they meet all.
static const rule *rule_not_met(feature_set features, int parameter)
{
    const uint64_t own = rules_of(parameter);
    for (int i = 0; i < RULES; i++) {
        if ((own >> i & 1) != 0 && (rules[i].any & features) == 0) {
            return &rules[i];
        }
    }
    return NULL;
}

const char *features_inert(feature_set features, int parameter)
{
    assert(parameter >= 0 && parameter < parameter_count);
    const rule *broken = rule_not_met(features, parameter);
    if (broken != NULL) {
        return broken->why;
    }
    return NULL;
}

// Whether a parameter belongs to a force of force_list.h that does not act with these
// features.
static bool brings_no_force(feature_set features, const char *path)
{
    static const struct {
        const char *path;
        feature_set force;
    } forces[] = {
#define FORCE_OF_PATH(feature, law, path, ...) {path, HAS(feature)},
        FORCE_LIST(FORCE_OF_PATH)
#undef FORCE_OF_PATH
    };
    for (size_t i = 0; i < sizeof forces / sizeof forces[0]; i++) {
        if (strcmp(forces[i].path, path) == 0) {
            return (features & forces[i].force) == 0;
        }
    }
    return false;
}

// Why a parameter may not have another value than its default with these features: half
// a sentence; NULL if it may.
static const char *why_refused(feature_set features, int parameter)
{
    const rule *broken = rule_not_met(features, parameter);
    if (broken != NULL && broken->refused) {
        return broken->why;
    }
    if (broken == NULL && brings_no_force(features, parameter_table[parameter].path)) {
        return "it brings this arm no force";
    }
    return NULL;
}

status features_check(const parameters *p, fault *f)
{
    // without the features of the law, of the script and of the engine's choice: what
    // those do not allow is refused elsewhere
    const feature_set features = features_of(p);
    for (int i = 0; i < parameter_count; i++) {
        const char *why = p->set[i] ? why_refused(features, i) : NULL;
        if (why == NULL) {
            continue;
        }

        // any other value than the default is refused
        parameters defaults;
        parameters_defaults(&defaults, ARM_CORRECTED);
        char value[PARAMETER_VALUE_SIZE], default_value[PARAMETER_VALUE_SIZE];
        parameter_format(p, i, value, sizeof value);
        parameter_format(&defaults, i, default_value, sizeof default_value);
        if (strcmp(value, default_value) != 0) {
            const char *path = parameter_table[i].path;
            return fault_set_at(f, STATUS_BAD_SCENARIO, path, "%s = %s, but %s", path,
                                value, why);
        }
    }
    return STATUS_OK;
}
