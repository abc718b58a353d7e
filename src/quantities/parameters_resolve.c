// What follows from other parameters, and which of them contradict one another.
#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/quantities/k2_table.h"
#include "src/quantities/parameters.h"

// What the ledger may lack under the methods whose steps are the object of study.
#define STUDY_RESIDUAL_BOUND 1e-2

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
        if (!p->set[i] && i != PARAMETER_INDEX(arm.model)) {
            parameter_set_default(p, i);
        }
    }
    if (!IS_SET(p, method.residual_bound) && p->method.name != METHOD_EVENT) {
        p->method.residual_bound = STUDY_RESIDUAL_BOUND;
    }
}

// Half a cell of beam, length/(2 N) of equal links, lies between the hub and the middle of the
// first link.
static double root_stiffness(const arm_parameters *a)
{
    double numbers[PARAMETER_LIST_MOST];
    if (parameter_list_numbers(a->joint_stiffness, numbers) > 0) {
        return numbers[0];
    }
    if (parameter_list_numbers(a->link_lengths, numbers) > 0) {
        return a->EI / (numbers[0] / 2);
    }
    return a->k2 * a->links;
}

// k2 of the uniform beam that bends as far at the tip under a load there, hub held: what the laws
// and predictors that know two equal links take the arm for. Equal joints are that beam.
static double equivalent_k2(const arm_parameters *a)
{
    double length[PARAMETER_LIST_MOST], stiffness[PARAMETER_LIST_MOST];
    double reach = a->length, bend = 0, even = 0;
    parameters_link_lengths(a, length);
    parameters_joint_stiffness(a, stiffness);

    // each joint turns by its lever over its stiffness; the root is half a joint
    for (int k = 0; k < a->links; k++) {
        const double lever = a->length * (a->links - k) / a->links;
        if (k > 0 || a->hub_joint == HUB_BEAM) {
            bend += reach * reach / stiffness[k];
            even += lever * lever * (k > 0 ? 1 : 0.5);
        }
        reach -= length[k];
    }
    const double joint =
        parameters_even_links(a) && a->links > 1 ? stiffness[a->links - 1] : even / bend;
    return 2 * joint / a->links;
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

status parameter_may_change(const parameters *p, int index, fault *f)
{
    assert(p != NULL && index >= 0 && index < parameter_count);
    const char *path = parameter_table[index].path;
    const bool bending = index == PARAMETER_INDEX(arm.k2) || index == PARAMETER_INDEX(arm.EI);
    if (p->arm.model == ARM_PRINTED) {
        return STATUS_OK;
    }
    if (index == PARAMETER_INDEX(arm.k1) && p->arm.hub_joint == HUB_BEAM) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, path,
                            "arm.k1 is for arm.hub_joint = spring, but with beam the root has the "
                            "spring k2 N = %g N m/rad",
                            p->arm.k1);
    }
    if (bending && p->arm.joint_stiffness[0] != '\0') {
        return fault_set_at(f, STATUS_BAD_SCENARIO, path,
                            "%s follows from arm.joint_stiffness, which is given and does not "
                            "change during a run",
                            path);
    }
    return STATUS_OK;
}

// The two lists: as long as the arm has joints and links, and given once.
static status check_lists(const parameters *p, fault *f)
{
    const arm_parameters *a = &p->arm;
    double numbers[PARAMETER_LIST_MOST];
    const int stiffnesses = parameter_list_numbers(a->joint_stiffness, numbers);
    const int lengths = parameter_list_numbers(a->link_lengths, numbers);
    const int joints = a->links - (a->hub_joint != HUB_BEAM);
    if (stiffnesses > 0 && stiffnesses != joints) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, arm.joint_stiffness, arm.links),
                            "arm.joint_stiffness has %d number%s, expected %d: arm.links = %d "
                            "have %s",
                            stiffnesses, stiffnesses == 1 ? "" : "s", joints, a->links,
                            a->hub_joint == HUB_BEAM ? "a joint before each (arm.hub_joint = beam)"
                                                     : "a joint between each two");
    }
    if (lengths > 0 && lengths != a->links) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, arm.link_lengths, arm.links),
                            "arm.link_lengths has %d number%s, but arm.links = %d", lengths,
                            lengths == 1 ? "" : "s", a->links);
    }

    // what a list takes the place of
    if (stiffnesses > 0 && (IS_SET(p, arm.k2) || IS_SET(p, arm.EI))) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME3(p, arm.joint_stiffness, arm.k2, arm.EI),
                            "arm.joint_stiffness and %s are both given, expected one of them",
                            IS_SET(p, arm.k2) ? "arm.k2" : "arm.EI");
    }
    if (lengths > 0 && IS_SET(p, arm.length)) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, arm.link_lengths),
                            "arm.link_lengths and arm.length are both given, expected one of them");
    }
    if (lengths > 0 && IS_SET(p, arm.link_inertia)) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, arm.link_inertia, arm.link_lengths),
                            "arm.link_inertia is for two equal links; those of arm.link_lengths "
                            "take the inertia of a uniform rod");
    }
    return STATUS_OK;
}

// Damping by mode takes the place of damping by stiffness, and has a mode for each number.
static status check_damping(const parameters *p, fault *f)
{
    const arm_parameters *a = &p->arm;
    double numbers[PARAMETER_LIST_MOST];
    const int ratios = parameter_list_numbers(a->modal_ratios, numbers);
    const int modes = a->links - (a->hub_joint == HUB_RIGID);
    if (ratios > 0 && a->damping_ratio > 0) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, arm.modal_ratios, arm.damping_ratio),
                            "arm.modal_ratios and arm.damping_ratio are both given, expected one "
                            "of them");
    }
    if (ratios > 0 && a->links > PARAMETER_LIST_MOST) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, arm.modal_ratios, arm.links),
                            "arm.modal_ratios is for at most %d links, but arm.links = %d",
                            PARAMETER_LIST_MOST, a->links);
    }
    if (ratios > modes || ratios > PARAMETER_MODES_MOST) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, arm.modal_ratios, arm.links),
                            "arm.modal_ratios has %d number%s, expected at most %d: arm.links = %d "
                            "have %d mode%s with the hub held",
                            ratios, ratios == 1 ? "" : "s",
                            modes < PARAMETER_MODES_MOST ? modes : PARAMETER_MODES_MOST, a->links,
                            modes, modes == 1 ? "" : "s");
    }
    return STATUS_OK;
}

// What only the explicit steps of the event method take.
static status check_beam_method(const parameters *p, fault *f)
{
    const int special[] = {PARAMETER_INDEX(arm.joint_stiffness), PARAMETER_INDEX(arm.link_lengths),
                           PARAMETER_INDEX(arm.modal_ratios), PARAMETER_INDEX(arm.air_drag),
                           PARAMETER_INDEX(arm.stiffening)};
    for (size_t i = 0; p->method.name != METHOD_EVENT && i < sizeof special / sizeof *special;
         i++) {
        char value[PARAMETER_TEXT_SIZE];
        parameter_format(p, special[i], value, sizeof value);
        if (p->set[special[i]] && value[0] != '\0' && strcmp(value, "0") != 0) {
            const char *path = parameter_table[special[i]].path;
            return fault_set_at(
                f, STATUS_BAD_SCENARIO, path, "%s runs with method.name = event only%s", path,
                p->arm.model == ARM_PRINTED ? ", which the printed model has not" : "");
        }
    }

    // each spring of a list is known as it is
    if (p->arm.stiffening > 0 && (p->arm.joint_stiffness[0] || p->arm.link_lengths[0])) {
        return fault_set_at(f, STATUS_BAD_SCENARIO,
                            BLAME3(p, arm.stiffening, arm.joint_stiffness, arm.link_lengths),
                            "arm.stiffening is for equal links and joints, but %s is given",
                            p->arm.joint_stiffness[0] ? "arm.joint_stiffness" : "arm.link_lengths");
    }
    return STATUS_OK;
}

// Length, stiffness of the beam and its root, as the lists have them.
static status resolve_lists(parameters *p, fault *f)
{
    arm_parameters *a = &p->arm;
    if (check_lists(p, f) != STATUS_OK) {
        return STATUS_BAD_SCENARIO;
    }
    double numbers[PARAMETER_LIST_MOST];
    const int lengths = parameter_list_numbers(a->link_lengths, numbers);
    if (lengths > 0) {
        a->length = 0;
        for (int k = 0; k < lengths; k++) {
            a->length += numbers[k];
        }
    }
    return STATUS_OK;
}

// The beam's stiffness is given once, and with it that of its root.
static status resolve_stiffness(parameters *p, fault *f)
{
    if (IS_SET(p, arm.EI) && IS_SET(p, arm.k2)) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, arm.EI),
                            "arm.EI and arm.k2 = 2 EI/length are both given, expected one of them");
    }

    // what was given says the rest
    if (p->arm.joint_stiffness[0] != '\0') {
        p->arm.k2 = equivalent_k2(&p->arm);
    }
    parameters_follow(p, IS_SET(p, arm.EI) ? PARAMETER_INDEX(arm.EI) : PARAMETER_INDEX(arm.k2));

    // a beam has its root's too
    if (p->arm.hub_joint == HUB_BEAM && IS_SET(p, arm.k1)) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, arm.k1),
                            "arm.k1 is for arm.hub_joint = spring, but with beam the root has the "
                            "spring k2 N = %g N m/rad",
                            p->arm.k1);
    }
    return STATUS_OK;
}

// A current drive has a gain and a limit of its own, a voltage drive has neither.
static status resolve_motor(parameters *p, fault *f)
{
    motor_parameters *m = &p->motor;
    if (isnan(m->transconductance)) {
        m->transconductance = m->amplifier_gain / m->resistance;
    }
    const bool electric = m->inductance > 0 || (m->current_limit > 0 && m->drive == DRIVE_VOLTAGE);
    if (electric && p->method.name != METHOD_EVENT) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME3(p, motor.inductance, motor.current_limit, method.name),
            "%s runs with method.name = event only",
            m->inductance > 0 ? "motor.inductance" : "motor.current_limit under a voltage");
    }
    if (m->drive == DRIVE_CURRENT && m->inductance > 0) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, motor.inductance, motor.drive),
                            "motor.inductance is for motor.drive = voltage; an amplifier that "
                            "holds a current overcomes it");
    }
    if (m->drive == DRIVE_CURRENT) {
        return STATUS_OK;
    }
    if (IS_SET(p, motor.transconductance)) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, motor.transconductance, motor.drive),
                            "motor.transconductance is for motor.drive = current; with voltage "
                            "motor.amplifier_gain says what a command gives");
    }
    return STATUS_OK;
}

#define LEAST_FACE 1e-9 // mass of a wall's face that is not none [kg]

// Walls nobody has measured: docs/physics.md says where these come from.
#define SOFT_STIFFNESS  75e3 // Kelvin-Voigt [N/m]
#define SOFT_DAMPING    20.0 // [N s/m]
#define HERTZ_STIFFNESS 1e6  // Hunt-Crossley [N/m^1.5]
#define RESTITUTION_LOSS                                                                           \
    0.2 // by which restitution falls per approach speed, Hunt-Crossley's alpha [s/m]

static status resolve_wall(parameters *p, fault *f)
{
    wall_parameters *w = &p->wall;
    const bool hertz = w->contact == WALL_HUNT_CROSSLEY;

    // defaults that depend on the law
    if (isnan(w->stiffness)) {
        w->stiffness = hertz ? HERTZ_STIFFNESS : SOFT_STIFFNESS;
    }
    if (isnan(w->damping)) {
        w->damping = hertz ? 1.5 * RESTITUTION_LOSS * w->stiffness : SOFT_DAMPING;
    }

    // a mass stands on a linear spring, which also holds it back
    if (w->mass > 0 && w->contact != WALL_KELVIN_VOIGT) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, wall.mass, wall.contact),
                            "wall.mass is for wall.contact = kelvin-voigt, on whose spring and "
                            "damper the face stands, not %s",
                            hertz ? "hunt-crossley" : "rigid");
    }
    if (w->mass > 0 && w->mass < LEAST_FACE) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, wall.mass),
                            "wall.mass = %g kg, expected 0 (none) or at least %g kg", w->mass,
                            LEAST_FACE);
    }

    // what a wall that gives cannot be combined with
    if (w->contact == WALL_RIGID) {
        return STATUS_OK;
    }
    if (IS_SET(p, wall.restitution) && w->mass == 0) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, wall.restitution),
                            "wall.restitution is for wall.contact = rigid or a face with a mass; a "
                            "wall that gives takes its share by wall.damping");
    }
    if (p->method.name != METHOD_EVENT) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, wall.contact, method.name),
                            "wall.contact = %s runs with method.name = event only",
                            hertz ? "hunt-crossley" : "kelvin-voigt");
    }
    return STATUS_OK;
}

// The shape of the arm, and where it starts.
static status resolve_arm(parameters *p, fault *f)
{
    if (resolve_lists(p, f) != STATUS_OK || check_damping(p, f) != STATUS_OK ||
        check_beam_method(p, f) != STATUS_OK) {
        return STATUS_BAD_SCENARIO;
    }
    if (IS_SET(p, arm.link_inertia) && p->arm.links != 2) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, arm.link_inertia, arm.links),
                            "arm.link_inertia is for two links only, but arm.links = %d (other N "
                            "take the inertia of a uniform rod)",
                            p->arm.links);
    }

    // a uniform rod's moment of inertia about its centre, m l^2 / 12 (errata B3)
    if (isnan(p->arm.link_inertia)) {
        double m = p->arm.mass / p->arm.links, l = p->arm.length / p->arm.links;
        p->arm.link_inertia = m * l * l / 12;
    }

    if (resolve_stiffness(p, f) != STATUS_OK) {
        return STATUS_BAD_SCENARIO;
    }

    // behind a spring the hub is a body of its own
    if (p->arm.hub_joint != HUB_RIGID && p->arm.hub_inertia == 0) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, arm.hub_inertia, arm.hub_joint),
                            "arm.hub_inertia = 0 kg m2 leaves a hub on a spring nothing to move, "
                            "expected above 0 or arm.hub_joint = rigid");
    }

    // the arm starts in front of the wall
    if (p->wall.kind != WALL_NONE && p->initial.angle > p->wall.angle) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, initial.angle, wall.angle),
            "initial.angle = %g rad lies behind the wall, expected at most wall.angle = "
            "%g rad",
            p->initial.angle, p->wall.angle);
    }
    return STATUS_OK;
}

// The controller's texts, and its timing: a command goes out before the next one does.
static status check_control(const parameters *p, fault *f)
{
    const control_parameters *c = &p->control;
    const double period = 1 / c->rate;

    // plug-in and table of k2
    if (c->law == LAW_PLUGIN && c->plugin[0] == '\0') {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, control.law, control.plugin),
            "control.law = plugin needs the file of a shared object in control.plugin");
    }
    if (c->law == LAW_PROCESS && c->command[0] == '\0') {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, control.law, control.command),
                            "control.law = process needs the program to start in control.command");
    }
    k2_table table;
    if (k2_table_read(&table, c->k2_table, f) != STATUS_OK) {
        return STATUS_BAD_SCENARIO;
    }

    // delays of more than a period would let commands overtake one another, and jitter of more than
    // half a period samples
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
    if (c->jitter * c->rate > 0.5) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, control.jitter, control.rate),
            "control.jitter = %g s is more than half the period of %g s (control.rate)", c->jitter,
            period);
    }
    return STATUS_OK;
}

// A controller that takes the impact angle from a sensor needs it.
static status resolve_impact_angle(parameters *p, fault *f)
{
    const int source = p->control.impact_angle;
    if (source == IMPACT_ANGLE_BY_FILM && !IS_SET(p, sensor.film)) {
        p->sensor.film = true;
    }
    if (source == IMPACT_ANGLE_BY_ACCELEROMETER && !IS_SET(p, sensor.accelerometer)) {
        p->sensor.accelerometer = true;
    }

    // which somebody may have left out
    if (source == IMPACT_ANGLE_BY_FILM && !p->sensor.film) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, control.impact_angle, sensor.film),
            "control.impact_angle = film needs the sensor that sensor.film = false leaves out");
    }
    if (source == IMPACT_ANGLE_BY_ACCELEROMETER && !p->sensor.accelerometer) {
        return fault_set_at(f, STATUS_BAD_SCENARIO,
                            BLAME2(p, control.impact_angle, sensor.accelerometer),
                            "control.impact_angle = accelerometer needs the sensor that "
                            "sensor.accelerometer = false leaves out");
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

    // rise and leak are a band-pass: its lower edge lies below its upper one
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
    if (p->arm.tip_mass != 0) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, arm.tip_mass),
                            "the printed model carries nothing, but arm.tip_mass = %g kg",
                            p->arm.tip_mass);
    }
    return STATUS_OK;
}

status parameters_resolve(parameters *p, fault *f)
{
    assert(p != NULL);
    resolve_defaults(p);
    status code = resolve_arm(p, f);
    code = code == STATUS_OK ? resolve_motor(p, f) : code;
    code = code == STATUS_OK ? resolve_wall(p, f) : code;
    code = code == STATUS_OK ? check_control(p, f) : code;
    code = code == STATUS_OK ? resolve_impact_angle(p, f) : code;
    code = code == STATUS_OK ? resolve_piezo(p, f) : code;
    return code == STATUS_OK && p->arm.model == ARM_PRINTED ? check_printed(p, f) : code;
}
