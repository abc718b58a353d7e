// Parameters of the arm that follow from others, and which of them contradict one
// another: lists, stiffnesses, damping, and where the arm starts.
#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/tables/parameters_parts.h"
#include "src/base/numbers.h"
#include "src/tables/parameters.h"

#define ROUNDING 1e-9 // of inertias that are written with few digits

#define ROOT_SPRING                                                                      \
    "arm.k1 is for arm.hub_joint = spring, but with beam the root has the spring k2 N "  \
    "= %g N "                                                                            \
    "m/rad"

int parameter_list_numbers(const char *list, double numbers[PARAMETER_LIST_MOST])
{
    int count = 0;

    // the text is canonical: numbers with commas between them
    while (*list != '\0') {
        char *end;
        assert(count < PARAMETER_LIST_MOST);
        numbers[count++] = decimal_parse(list, &end);
        assert(end > list);
        list = end + (*end == ',');
    }
    return count;
}

int parameter_get_list(const parameters *p, int index,
                       double numbers[PARAMETER_LIST_MOST])
{
    assert(parameter_table[index].type == PARAMETER_LIST);
    const char *list = (const char *)p + parameter_table[index].offset;
    return parameter_list_numbers(list, numbers);
}

void parameters_link_lengths(const arm_parameters *a, double *lengths)
{
    assert(a->links > 0);
    double listed[PARAMETER_LIST_MOST];
    const int count = parameter_list_numbers(a->link_lengths, listed);
    for (int k = 0; k < a->links; k++) {
        if (count == a->links) {
            lengths[k] = listed[k];
        } else {
            lengths[k] = a->length / a->links;
        }
    }
}

void parameters_joint_stiffness(const arm_parameters *a, double *stiffness)
{
    assert(a->links > 0);
    double listed[PARAMETER_LIST_MOST], length[PARAMETER_LIST_MOST];
    const bool beam = a->hub_joint == HUB_BEAM;
    const int count = parameter_list_numbers(a->joint_stiffness, listed);

    // the root at the hub: none, the first of the list, or k1
    if (a->hub_joint == HUB_RIGID) {
        stiffness[0] = 0;
    } else if (beam && count > 0) {
        stiffness[0] = listed[0];
    } else {
        stiffness[0] = a->k1;
    }

    // the joints: from the list, else a piece of beam from the middle of one link to the
    // middle of the next, EI over its length; for equal links that is k2 N / 2
    if (a->link_lengths[0] != '\0') {
        parameters_link_lengths(a, length);
    }
    for (int k = 1; k < a->links; k++) {
        if (count > 0) {
            stiffness[k] = listed[beam ? k : k - 1];
        } else if (a->link_lengths[0] != '\0') {
            stiffness[k] = a->EI / ((length[k - 1] + length[k]) / 2);
        } else {
            stiffness[k] = a->k2 * a->links / 2;
        }
    }
}

void parameters_link_masses(const arm_parameters *a, double *masses)
{
    assert(a->links > 0);
    double listed[PARAMETER_LIST_MOST], length[PARAMETER_LIST_MOST];
    const int count = parameter_list_numbers(a->link_masses, listed);
    if (a->link_lengths[0] != '\0') {
        parameters_link_lengths(a, length);
    }
    for (int k = 0; k < a->links; k++) {
        if (count == a->links) {
            masses[k] = listed[k];
        } else if (a->link_lengths[0] != '\0') {
            masses[k] = a->mass / a->length * length[k];
        } else {
            masses[k] = a->mass / a->links;
        }
    }
}

void parameters_link_inertias(const arm_parameters *a, double *inertias)
{
    assert(a->links <= PARAMETER_LIST_MOST);
    double listed[PARAMETER_LIST_MOST], length[PARAMETER_LIST_MOST],
        mass[PARAMETER_LIST_MOST];
    const int count = parameter_list_numbers(a->link_inertias, listed);
    const bool pair = a->links == 2 && !isnan(a->link_inertia);
    parameters_link_lengths(a, length);
    parameters_link_masses(a, mass);
    for (int k = 0; k < a->links; k++) {
        if (count == a->links) {
            inertias[k] = listed[k];
        } else if (pair && a->link_lengths[0] == '\0' && a->link_masses[0] == '\0') {
            inertias[k] = a->link_inertia;
        } else {
            inertias[k] = mass[k] * length[k] * length[k] / 12;
        }
    }
}

void parameters_joint_damping(const arm_parameters *a, double *damping)
{
    assert(a->links > 0);
    double listed[PARAMETER_LIST_MOST];
    const int count = parameter_list_numbers(a->joint_damping, listed);
    const int without = a->hub_joint == HUB_RIGID ? 1 : 0;
    for (int k = 0; k < a->links; k++) {
        if (count == 0 || k < without) {
            damping[k] = 0;
        } else if (count == 1) {
            damping[k] = listed[0];
        } else {
            damping[k] = listed[k - without];
        }
    }
}

// Whether a parameter lists what belongs to each link or joint.
static bool has_lists(const arm_parameters *a)
{
    return a->joint_stiffness[0] != '\0' || a->link_lengths[0] != '\0' ||
           a->link_masses[0] != '\0' || a->link_inertias[0] != '\0' ||
           strchr(a->joint_damping, ',') != NULL;
}

bool parameters_even_links(const arm_parameters *a)
{
    assert(a->links > 0);
    double length[PARAMETER_LIST_MOST], stiffness[PARAMETER_LIST_MOST],
        mass[PARAMETER_LIST_MOST], inertia[PARAMETER_LIST_MOST],
        damping[PARAMETER_LIST_MOST];
    if (!has_lists(a)) {
        return true;
    }

    // all lengths and joints equal; the root of a beam is half a piece of it, and so
    // twice as stiff
    parameters_link_lengths(a, length);
    parameters_joint_stiffness(a, stiffness);
    parameters_link_masses(a, mass);
    parameters_link_inertias(a, inertia);
    parameters_joint_damping(a, damping);
    const int last = a->links - 1;
    bool even =
        a->links == 1 || a->hub_joint != HUB_BEAM || stiffness[0] / 2 == stiffness[last];
    for (int k = 1; k < a->links; k++) {
        even = even && length[k] == length[0] && stiffness[k] == stiffness[last] &&
               mass[k] == mass[0] && inertia[k] == inertia[0] &&
               damping[k] == damping[last];
    }
    const double rod = mass[0] * length[0] * length[0] / 12;
    return even && (a->links == 2 || a->link_inertias[0] == '\0' || inertia[0] == rod);
}

// The stiffness of the root: that of the beam between the hub and the middle of the first
// link, EI over half the link's length. For N equal links that is k2 N.
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

// The k2 of the uniform beam whose tip deflects as far as this arm's under the same load
// at the tip, with the hub held. Laws and predictors that know two equal links take the
// arm for that beam. Under a load F at the tip, joint i at distance x_i from it turns by
// F x_i / k_i and moves the tip by F x_i^2 / k_i; so the joint stiffness of the equal
// arm, whose joints are at distances y_i, is sum(y_i^2) / sum(x_i^2 / k_i).
static double equivalent_k2(const arm_parameters *a)
{
    double length[PARAMETER_LIST_MOST], stiffness[PARAMETER_LIST_MOST];
    double reach = a->length, compliance = 0, lever_squares = 0;
    parameters_link_lengths(a, length);
    parameters_joint_stiffness(a, stiffness);

    // both sums over the joints; the root of a beam is half a joint
    for (int k = 0; k < a->links; k++) {
        const double lever = a->length * (a->links - k) / a->links;
        if (k > 0 || a->hub_joint == HUB_BEAM) {
            compliance += reach * reach / stiffness[k];
            lever_squares += lever * lever * (k > 0 ? 1 : 0.5);
        }
        reach -= length[k];
    }

    // equal joints are that beam already, without rounding
    double joint = lever_squares / compliance;
    if (parameters_even_links(a) && a->links > 1) {
        joint = stiffness[a->links - 1];
    }
    return 2 * joint / a->links;
}

void parameters_follow(parameters *p, int index)
{
    arm_parameters *a = &p->arm;
    if (index == PARAMETER_INDEX(arm.k2)) {
        a->EI = a->k2 * a->length / 2;
    } else if (index == PARAMETER_INDEX(arm.EI)) {
        a->k2 = 2 * a->EI / a->length;
    }
    if (a->hub_joint == HUB_BEAM) {
        a->k1 = root_stiffness(a);
    }
}

status parameter_may_change(const parameters *p, int index, fault *f)
{
    assert(index >= 0 && index < parameter_count);
    const char *path = parameter_table[index].path;
    const bool bending =
        index == PARAMETER_INDEX(arm.k2) || index == PARAMETER_INDEX(arm.EI);
    const bool printed = p->arm.model == ARM_PRINTED;
    if (printed && index == PARAMETER_INDEX(wall.angle)) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, path,
                            "the wall of the printed model does not move during a run");
    }
    if (!printed && index == PARAMETER_INDEX(arm.k1) && p->arm.hub_joint == HUB_BEAM) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, path, ROOT_SPRING, p->arm.k1);
    }
    if (!printed && bending && p->arm.joint_stiffness[0] != '\0') {
        return fault_set_at(f, STATUS_BAD_SCENARIO, path,
                            "%s follows from arm.joint_stiffness, which is given and "
                            "does not change during a run",
                            path);
    }
    return STATUS_OK;
}

// The ending of a noun after a number: "s" but for 1.
static const char *plural(int count)
{
    if (count == 1) {
        return "";
    }
    return "s";
}

// Checks that a list has as many numbers as the arm has links or joints, `expected`; none
// is no list.
static status check_count(const parameters *p, int list, int expected, const char *of,
                          fault *f)
{
    double numbers[PARAMETER_LIST_MOST];
    const int count = parameter_get_list(p, list, numbers);
    const int links = PARAMETER_INDEX(arm.links);
    if (count > 0 && count != expected) {
        return fault_set_at(f, STATUS_BAD_SCENARIO,
                            first_given(p, (const int[]){list, links, -1}),
                            "%s has %d number%s, expected %d: arm.links = %d have %s",
                            parameter_table[list].path, count, plural(count), expected,
                            p->arm.links, of);
    }
    return STATUS_OK;
}

// Refuses a list beside a parameter that it replaces, if both were given.
static status check_replaced(const parameters *p, int list, int replaced, fault *f)
{
    if (p->set[replaced] != 0 &&
        ((const char *)p)[parameter_table[list].offset] != '\0') {
        return fault_set_at(f, STATUS_BAD_SCENARIO,
                            first_given(p, (const int[]){list, replaced, -1}),
                            "%s and %s are both given, expected one of them",
                            parameter_table[list].path, parameter_table[replaced].path);
    }
    return STATUS_OK;
}

// Checks the lists of links and joints: one number for each of them, and no parameter
// given beside a list that replaces it.
static status check_lists(const parameters *p, fault *f)
{
    const arm_parameters *a = &p->arm;
    const int stiffness = PARAMETER_INDEX(arm.joint_stiffness);
    const int lengths = PARAMETER_INDEX(arm.link_lengths);
    const int masses = PARAMETER_INDEX(arm.link_masses);
    const int inertias = PARAMETER_INDEX(arm.link_inertias);
    const int damping = PARAMETER_INDEX(arm.joint_damping);
    const char *joints = "a joint between each two";
    if (a->hub_joint == HUB_BEAM) {
        joints = "a joint before each (arm.hub_joint = beam)";
    }

    // their lengths
    TRY(check_count(p, stiffness, a->links - (a->hub_joint != HUB_BEAM), joints, f));
    TRY(check_count(p, lengths, a->links, "one each", f));
    TRY(check_count(p, masses, a->links, "one each", f));
    TRY(check_count(p, inertias, a->links, "one each", f));
    if (a->hub_joint == HUB_SPRING) {
        joints = "a joint before each (arm.hub_joint = spring)";
    }
    if (strchr(a->joint_damping, ',') != NULL) {
        TRY(check_count(p, damping, a->links - (a->hub_joint == HUB_RIGID), joints, f));
    }

    // parameters that a list replaces
    TRY(check_replaced(p, stiffness, PARAMETER_INDEX(arm.k2), f));
    TRY(check_replaced(p, stiffness, PARAMETER_INDEX(arm.EI), f));
    TRY(check_replaced(p, lengths, PARAMETER_INDEX(arm.length), f));
    TRY(check_replaced(p, masses, PARAMETER_INDEX(arm.mass), f));
    TRY(check_replaced(p, inertias, PARAMETER_INDEX(arm.link_inertia), f));
    if ((a->link_lengths[0] != '\0' || a->link_masses[0] != '\0') &&
        IS_SET(p, arm.link_inertia)) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO,
            BLAME3(p, arm.link_inertia, arm.link_lengths, arm.link_masses),
            "arm.link_inertia is for two equal links, expected arm.link_inertias or that "
            "of uniform rods beside lists of lengths or masses");
    }
    return STATUS_OK;
}

// Checks that no link has more inertia than its mass can have within its length: m l^2/4,
// with half of it at either end. Lengths and masses are resolved.
static status check_inertias(const parameters *p, fault *f)
{
    double length[PARAMETER_LIST_MOST], mass[PARAMETER_LIST_MOST],
        inertia[PARAMETER_LIST_MOST];
    if (p->arm.link_inertias[0] == '\0') {
        return STATUS_OK;
    }
    parameters_link_lengths(&p->arm, length);
    parameters_link_masses(&p->arm, mass);
    parameters_link_inertias(&p->arm, inertia);
    for (int k = 0; k < p->arm.links; k++) {
        const double most = mass[k] * length[k] * length[k] / 4;
        if (inertia[k] > most * (1 + ROUNDING)) {
            return fault_set_at(
                f, STATUS_BAD_SCENARIO, BLAME1(p, arm.link_inertias),
                "arm.link_inertias gives link %d %g kg m2, expected at most m l^2/4 = %g "
                "kg m2: its mass of %g kg with a half at either end of its %g m",
                k + 1, inertia[k], most, mass[k], length[k]);
        }
    }
    return STATUS_OK;
}

// Checks the damping ratios of modes: they replace damping_ratio, and the arm must have a
// mode for each.
static status check_damping(const parameters *p, fault *f)
{
    const arm_parameters *a = &p->arm;
    double numbers[PARAMETER_LIST_MOST];
    const int ratios = parameter_list_numbers(a->modal_ratios, numbers);
    const int modes = a->links - (a->hub_joint == HUB_RIGID);
    const int most = modes < PARAMETER_MODES_MOST ? modes : PARAMETER_MODES_MOST;
    if (ratios > 0 && a->damping_ratio > 0) {
        return fault_set_at(f, STATUS_BAD_SCENARIO,
                            BLAME2(p, arm.modal_ratios, arm.damping_ratio),
                            "arm.modal_ratios and arm.damping_ratio are both given, "
                            "expected one of them");
    }
    if (a->joint_damping[0] != '\0' && (ratios > 0 || a->damping_ratio > 0)) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO,
            BLAME3(p, arm.joint_damping, arm.damping_ratio, arm.modal_ratios),
            "arm.joint_damping and %s are both given, expected one of them",
            ratios > 0 ? "arm.modal_ratios" : "arm.damping_ratio");
    }
    if (ratios > 0 && a->links > PARAMETER_MODAL_LINKS) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, arm.modal_ratios, arm.links),
            "arm.modal_ratios is for at most %d links, but arm.links = %d",
            PARAMETER_MODAL_LINKS, a->links);
    }
    if (ratios > most) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, arm.modal_ratios, arm.links),
            "arm.modal_ratios has %d number%s, expected at most %d: arm.links = "
            "%d have %d mode%s with the hub held",
            ratios, plural(ratios), most, a->links, modes, plural(modes));
    }
    return STATUS_OK;
}

// Checks that stiffening is given for equal links and joints only, not beside lists.
static status check_stiffening(const parameters *p, fault *f)
{
    const bool stiffnesses = p->arm.joint_stiffness[0] != '\0';
    if (p->arm.stiffening > 0 && (stiffnesses || p->arm.link_lengths[0])) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO,
            BLAME3(p, arm.stiffening, arm.joint_stiffness, arm.link_lengths),
            "arm.stiffening is for equal links and joints, but %s is given",
            stiffnesses ? "arm.joint_stiffness" : "arm.link_lengths");
    }
    return STATUS_OK;
}

// Checks the lists and makes the arm's length and mass the sums of those of its links, if
// these are given.
static status resolve_lists(parameters *p, fault *f)
{
    double numbers[PARAMETER_LIST_MOST], length = 0, mass = 0;
    TRY(check_lists(p, f));
    const int lengths = parameter_list_numbers(p->arm.link_lengths, numbers);
    for (int k = 0; k < lengths; k++) {
        length += numbers[k];
    }
    if (lengths > 0) {
        p->arm.length = length;
    }
    const int masses = parameter_list_numbers(p->arm.link_masses, numbers);
    for (int k = 0; k < masses; k++) {
        mass += numbers[k];
    }
    if (masses > 0) {
        p->arm.mass = mass;
    }
    return check_inertias(p, f);
}

// Makes k2, EI and the stiffness of the root agree with what was given, which may be one
// of them only.
static status resolve_stiffness(parameters *p, fault *f)
{
    if (IS_SET(p, arm.EI) && IS_SET(p, arm.k2)) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME1(p, arm.EI),
            "arm.EI and arm.k2 = 2 EI/length are both given, expected one of them");
    }

    // k2 from the joints, then EI from k2 or k2 from EI, and the root
    if (p->arm.joint_stiffness[0] != '\0') {
        p->arm.k2 = equivalent_k2(&p->arm);
    }
    parameters_follow(p, IS_SET(p, arm.EI) ? PARAMETER_INDEX(arm.EI)
                                           : PARAMETER_INDEX(arm.k2));

    // the root of a beam has no stiffness of its own
    if (p->arm.hub_joint == HUB_BEAM && IS_SET(p, arm.k1)) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, arm.k1), ROOT_SPRING,
                            p->arm.k1);
    }
    return STATUS_OK;
}

status parameters_resolve_arm(parameters *p, fault *f)
{
    arm_parameters *a = &p->arm;
    TRY(resolve_lists(p, f));
    TRY(check_damping(p, f));
    TRY(check_stiffening(p, f));

    // the mean of the links' inertias; that of a uniform rod about its centre is
    // m l^2 / 12 (errata B3)
    double inertias[PARAMETER_LIST_MOST], sum = 0;
    const int count = parameter_list_numbers(a->link_inertias, inertias);
    for (int k = 0; k < count; k++) {
        sum += inertias[k];
    }
    if (count > 0) {
        a->link_inertia = sum / count;
    } else if (isnan(a->link_inertia)) {
        const double m = a->mass / a->links, l = a->length / a->links;
        a->link_inertia = m * l * l / 12;
    }
    TRY(resolve_stiffness(p, f));

    // behind a spring the hub is a body of its own
    if (a->hub_joint != HUB_RIGID && a->hub_inertia == 0) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, arm.hub_inertia, arm.hub_joint),
            "arm.hub_inertia = 0 kg m2 leaves a hub on a spring nothing to move, "
            "expected above 0 or arm.hub_joint = rigid");
    }

    // the straight arm starts in front of the wall: its gap, length sin(ahead) for walls
    // of every kind, is not negative
    const double ahead = p->wall.angle - p->initial.angle;
    if (p->wall.kind != WALL_NONE &&
        !(ahead >= -START_ROUNDING && ahead <= M_PI + START_ROUNDING)) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, initial.angle, wall.angle),
            "initial.angle = %.10g rad lies behind the wall, expected from "
            "wall.angle - pi = %.10g to wall.angle = %.10g rad",
            p->initial.angle, p->wall.angle - M_PI, p->wall.angle);
    }
    return STATUS_OK;
}
