// What of the arm follows from other parameters: lists, stiffnesses, damping, and where
// it starts.
#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/tables/parameters_parts.h"
#include "src/base/numbers.h"
#include "src/tables/parameters.h"

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

    // the root of its own, and what the list says; else the beam between the middles of
    // two links
    if (a->hub_joint == HUB_RIGID) {
        stiffness[0] = 0;
    } else if (beam && count > 0) {
        stiffness[0] = listed[0];
    } else {
        stiffness[0] = a->k1;
    }
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

bool parameters_even_links(const arm_parameters *a)
{
    assert(a->links > 0);
    double length[PARAMETER_LIST_MOST], stiffness[PARAMETER_LIST_MOST];
    if (a->joint_stiffness[0] == '\0' && a->link_lengths[0] == '\0') {
        return true;
    }

    // the root is half a joint
    parameters_link_lengths(a, length);
    parameters_joint_stiffness(a, stiffness);
    const double joint = stiffness[a->links - 1];
    bool even = a->links == 1 || a->hub_joint != HUB_BEAM || stiffness[0] / 2 == joint;
    for (int k = 1; k < a->links; k++) {
        even = even && length[k] == length[0] && stiffness[k] == joint;
    }
    return even;
}

// Half a cell of beam, length/(2 N) of equal links, lies between the hub and the middle
// of the first link.
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

// k2 of the uniform beam that bends as far at the tip under a load there, hub held: what
// the laws and predictors that know two equal links take the arm for. Equal joints are
// that beam.
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

// The ending of a noun of which there are so many.
static const char *plural(int count)
{
    if (count == 1) {
        return "";
    }
    return "s";
}

// The two lists: as long as the arm has joints and links, and given once.
static status check_lists(const parameters *p, fault *f)
{
    const arm_parameters *a = &p->arm;
    double numbers[PARAMETER_LIST_MOST];
    const int stiffnesses = parameter_list_numbers(a->joint_stiffness, numbers);
    const int lengths = parameter_list_numbers(a->link_lengths, numbers);
    const bool beam = a->hub_joint == HUB_BEAM;
    const int joints = a->links - !beam;
    if (stiffnesses > 0 && stiffnesses != joints) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, arm.joint_stiffness, arm.links),
            "arm.joint_stiffness has %d number%s, expected %d: arm.links = %d have %s",
            stiffnesses, plural(stiffnesses), joints, a->links,
            beam ? "a joint before each (arm.hub_joint = beam)"
                 : "a joint between each two");
    }
    if (lengths > 0 && lengths != a->links) {
        return fault_set_at(f, STATUS_BAD_SCENARIO,
                            BLAME2(p, arm.link_lengths, arm.links),
                            "arm.link_lengths has %d number%s, but arm.links = %d",
                            lengths, plural(lengths), a->links);
    }

    // what a list takes the place of
    if (stiffnesses > 0 && (IS_SET(p, arm.k2) || IS_SET(p, arm.EI))) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME3(p, arm.joint_stiffness, arm.k2, arm.EI),
            "arm.joint_stiffness and %s are both given, expected one of them",
            IS_SET(p, arm.k2) ? "arm.k2" : "arm.EI");
    }
    if (lengths > 0 && IS_SET(p, arm.length)) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME1(p, arm.link_lengths),
            "arm.link_lengths and arm.length are both given, expected one of them");
    }
    if (lengths > 0 && IS_SET(p, arm.link_inertia)) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, arm.link_inertia, arm.link_lengths),
            "arm.link_inertia is for two equal links; those of arm.link_lengths "
            "take the inertia of a uniform rod");
    }
    return STATUS_OK;
}

// Damping by mode takes the place of damping by stiffness, and has a mode for each
// number.
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
    if (ratios > 0 && a->links > PARAMETER_LIST_MOST) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, arm.modal_ratios, arm.links),
            "arm.modal_ratios is for at most %d links, but arm.links = %d",
            PARAMETER_LIST_MOST, a->links);
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

// Each spring of a list is known as it is.
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

// Length, stiffness of the beam and its root, as the lists have them.
static status resolve_lists(parameters *p, fault *f)
{
    double numbers[PARAMETER_LIST_MOST], length = 0;
    TRY(check_lists(p, f));
    const int lengths = parameter_list_numbers(p->arm.link_lengths, numbers);
    for (int k = 0; k < lengths; k++) {
        length += numbers[k];
    }
    if (lengths > 0) {
        p->arm.length = length;
    }
    return STATUS_OK;
}

// The beam's stiffness is given once, and with it that of its root.
static status resolve_stiffness(parameters *p, fault *f)
{
    if (IS_SET(p, arm.EI) && IS_SET(p, arm.k2)) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME1(p, arm.EI),
            "arm.EI and arm.k2 = 2 EI/length are both given, expected one of them");
    }

    // what was given says the rest
    if (p->arm.joint_stiffness[0] != '\0') {
        p->arm.k2 = equivalent_k2(&p->arm);
    }
    parameters_follow(p, IS_SET(p, arm.EI) ? PARAMETER_INDEX(arm.EI)
                                           : PARAMETER_INDEX(arm.k2));

    // a beam has its root's too
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

    // a uniform rod's moment of inertia about its centre, m l^2 / 12 (errata B3)
    if (isnan(a->link_inertia)) {
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

    // the straight arm starts in front of the wall, whose gap is length sin(ahead) for
    // any kind
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
