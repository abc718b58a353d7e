// The constants of an arm that follow from its parameters; its fastest motion.
#include "src/arm/arm.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "src/arm/chain.h"
#include "src/arm/chain_pair.h"
#include "src/arm/modes.h"
#include "src/base/sincos.h"

// Weight of a decay's rate against a frequency, where steps are chosen: a decay is over
// within a step or two and need not be followed, so that steps may be several times
// longer.
#define DECAY_WEIGHT 0.125

void arm_set_voltage(arm *a, double volts)
{
    assert(isfinite(volts));
    motor_set_voltage(&a->motor, volts);
}

// First frequency of the straight chain clamped at the hub [rad/s], by inverse iteration
// on M x = (1/w^2) K x: the bending moments of the inertia forces of a shape x, divided
// by the joints' stiffnesses and summed up, are the next shape. The links are uniform
// rods (chain.h). The clamp holds the first link; but in a beam whose root bends, or an
// arm of one link, it holds the root.
static double first_clamped_frequency(const arm *a)
{
    // The first shape has the angles of a quadratic deflection. The error of Rayleigh's
    // quotient is the square of that of the shape, so that few sweeps are enough.
    enum { LONGEST = 1024, SWEEPS = 6 };
    const bool root = a->root_bends || a->links == 1;
    double shape[LONGEST], next[LONGEST], frequency = 0;
    for (int k = 0; k < a->links; k++) {
        if (root) {
            shape[k] = k + 0.5;
        } else {
            shape[k] = k;
        }
    }

    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        // deflections of the links' ends
        double y = 0, moment_beyond = 0;
        double tip_y[LONGEST];
        for (int k = 0; k < a->links; k++) {
            y += arm_link_of(a, k).length * shape[k];
            tip_y[k] = y;
        }

        // M x as the moment on each joint, from the tip inwards
        double force = a->tip_mass * y;
        const int first = root ? 0 : 1;
        for (int k = a->links - 1; k >= first; k--) {
            const double l = arm_link_of(a, k).length;
            double base = tip_y[k] - l * shape[k];
            double own_force = arm_link_of(a, k).mass * (base + l * shape[k] / 2);
            double moment = moment_beyond + force * l + own_force * l / 2 +
                            arm_link_of(a, k).inertia * shape[k];
            moment_beyond = moment;
            force += own_force;
            next[k] = moment / arm_link_of(a, k).stiffness; // bend of joint k
        }

        // the next shape, and Rayleigh's quotient on the way
        double sum = 0, numerator = 0, denominator = 0;
        if (!root) {
            next[0] = 0;
        }
        for (int k = 0; k < a->links; k++) {
            sum += next[k];
            next[k] = sum;
            numerator += shape[k] * sum;
            denominator += sum * sum;
        }
        assert(denominator > 0); // some joint bends
        frequency = sqrt(numerator / denominator);
        const double scale = 1 / sqrt(denominator);
        for (int k = 0; k < a->links; k++) {
            shape[k] = next[k] * scale;
        }
    }
    return frequency;
}

// Largest eigenvalue of the straight, free chain, by power iteration: of M^-1 K, the
// square of a frequency, or if `of_velocities` of M^-1 C, a decay. The product with such
// a matrix is minus the accelerations that chain_accelerations gives for small angles, or
// for small velocities, without other forces.
static double largest_eigenvalue(const arm *source, bool of_velocities)
{
    enum { LONGEST = PARAMETER_LINKS_MOST + 1, SWEEPS = 60 };
    static const contact_state free_mode = {false, HUB_FORWARD};

    // nothing but masses and springs, or dampers
    arm a = *source;
    a.motor.electric = false;
    a.motor.torque = a.motor.damping = a.motor.stiction = 0;
    a.amount = (force_amounts){0};
    if (!of_velocities) {
        a.damped_modes = 0;
        a.joint_damping = a.hub_joint_damping = 0;
        for (int k = 0; k < (int)PARAMETER_LIST_MOST; k++) {
            a.each[k].damping = 0;
        }
    }
    a.wall.kind = WALL_NONE;
    chain_link work[LONGEST];
    double x[LONGEST], still[LONGEST], alpha[LONGEST], value = 0;
    const double small = 1e-6; // small angles: the linear range

    // from angles of alternating sign, as in the fastest mode, until the value settles
    memset(still, 0, sizeof still);
    for (int k = 0; k < a.dof; k++) {
        const double sign = k % 2 == 0 ? 1 : -1;
        x[k] = sign * small * (1 + 0.1 * k / a.dof);
    }
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        chain_reaction reaction;
        double size = 0;
        const double *q = x, *w = still;
        if (of_velocities) {
            q = still;
            w = x;
        }
        chain_accelerations(&a, work, q, w, free_mode, alpha, &reaction);

        // by how much the matrix lengthens the vector
        double before = 0;
        for (int k = 0; k < a.dof; k++) {
            size += alpha[k] * alpha[k];
            before += x[k] * x[k];
        }
        if (size == 0) {
            return 0;
        }

        double last = value;
        value = sqrt(size / before);
        if (sweep >= 4 && fabs(value - last) < 1e-6 * value) {
            break;
        }

        for (int k = 0; k < a.dof; k++) {
            x[k] = -alpha[k] * small / sqrt(size);
        }
    }
    return value;
}

// Largest eigenvalue of M^-1 K of two links on a rigid hub. Their one spring has
// K = k b b^T with b = (-1, 1), so that it is k b^T M^-1 b.
static double one_spring_eigenvalue(const arm *a)
{
    const pair_mass m = pair_mass_of(a);
    return a->joint_stiffness * (m.m11 + 2 * m.m12 + m.m22) /
           (m.m11 * m.m22 - m.m12 * m.m12);
}

// Upper estimate of the highest frequency of the straight, free chain.
static double highest_frequency(const arm *a)
{
    if (a->links == 2 && !a->hub_spring && arm_is_plain(a)) {
        return 1.05 * sqrt(one_spring_eigenvalue(a));
    }
    return 1.05 * sqrt(largest_eigenvalue(a, false));
}

// The fastest decay of the linear motion [1/s], for choosing steps: the largest of those
// of an overdamped mode, of air drag, of damped modes, of the current and of the hub that
// the motor brakes. The damping ratio z of a mode of frequency w grows with w, as damping
// is proportional to stiffness; if z > 1, the mode decays at w (z + sqrt(z^2 - 1)).
// Joints that are damped `singly`, and modes, decay no faster than by the largest
// eigenvalue of M^-1 C.
static double fastest_decay(const arm *a, bool singly)
{
    double w = a->highest_frequency,
           stiffest = fmax(a->joint_stiffness, a->hub_stiffness);
    double damping = fmax(a->joint_damping, a->hub_joint_damping);
    const double ratio = 0.5 * w * damping / stiffest;

    // overdamped modes, and the least inertia that the hub can show
    double decay = 0, reach = 0;
    if (ratio > 1 && !singly) {
        decay = w * (ratio + sqrt(ratio * ratio - 1));
    }
    if (!a->hub_spring) {
        reach = arm_link_of(a, 0).length;
    }
    double hub = a->hub_inertia + arm_link_of(a, 0).mass * reach * reach / 12;
    assert(stiffest > 0 && hub > 0);

    // drag and damped modes
    decay = fmax(decay, a->amount.air_drag * a->link_length / a->link_mass);
    if (a->damped_modes > 0 || singly) {
        decay = fmax(decay, 1.05 * largest_eigenvalue(a, true));
    }

    // the motor brakes by back EMF as fast as its current follows
    const motor_model *motor = &a->motor;
    double braking = motor->damping;
    if (motor->electric) {
        braking += motor->torque_constant * motor->back_emf / motor->resistance;
        if (motor->inductance > 0) {
            decay = fmax(decay, motor->resistance / motor->inductance);
        }
    }
    return fmax(decay, braking / hub);
}

// Sets links and joints one by one, if the parameters list what they are. A list of equal
// numbers gives an even chain.
static void set_links(arm *a, const arm_parameters *p)
{
    double lengths[PARAMETER_LIST_MOST], stiffness[PARAMETER_LIST_MOST],
        masses[PARAMETER_LIST_MOST], inertias[PARAMETER_LIST_MOST];
    a->uneven = !parameters_even_links(p);
    if (p->joint_stiffness[0] == '\0' && p->link_lengths[0] == '\0' && !a->uneven) {
        return;
    }
    parameters_link_lengths(p, lengths);
    parameters_joint_stiffness(p, stiffness);
    parameters_link_masses(p, masses);
    parameters_link_inertias(p, inertias);
    for (int k = 0; k < p->links; k++) {
        a->each[k] = (arm_link){lengths[k], masses[k], inertias[k], stiffness[k], 0};
    }

    // the stiffness of equal joints as the list has it; of different ones the largest,
    // which limits how long steps may be
    if (a->links > 1) {
        a->joint_stiffness = stiffness[a->links - 1];
    }
    for (int k = 1; k < a->links; k++) {
        a->joint_stiffness = fmax(a->joint_stiffness, stiffness[k]);
    }
}

// Sets the damping that arm.joint_damping gives the joints, of the chain's joints the
// largest.
static void set_joint_damping(arm *a, const arm_parameters *p)
{
    double listed[PARAMETER_LIST_MOST], damping[PARAMETER_LIST_MOST];
    const int count = parameter_list_numbers(p->joint_damping, listed);
    if (count == 0 || (a->links == 1 && !a->hub_spring)) {
        return;
    }
    a->joint_damping = listed[count - 1];
    if (a->hub_spring) {
        a->hub_joint_damping = listed[0];
    }
    if (!a->uneven) {
        return;
    }
    parameters_joint_damping(p, damping);
    for (int k = 0; k < a->links; k++) {
        a->each[k].damping = damping[k];
        if (k > 0) {
            a->joint_damping = fmax(a->joint_damping, damping[k]);
        }
    }
}

// The amount of each force of force_list.h.
static force_amounts amounts_of(const parameters *p)
{
    return (force_amounts){
#define AMOUNT_OF(feature, law, path, amount, methods) .law = amount,
        FORCE_LIST(AMOUNT_OF)
#undef AMOUNT_OF
    };
}

void arm_init(arm *a, const parameters *p)
{
    memset(a, 0, offsetof(arm, each)); // the tables behind it have lengths of their own

    // degrees of freedom
    a->features = features_of(p);
    a->links = p->arm.links;
    a->hub_spring = p->arm.hub_joint != HUB_RIGID;
    a->root_bends = p->arm.hub_joint == HUB_BEAM;
    if (a->hub_spring) {
        a->first = 1;
    } else {
        a->first = 0;
    }
    a->dof = a->links + a->first;

    // links, hub, springs
    a->link_length = p->arm.length / a->links;
    a->link_mass = p->arm.mass / a->links;
    a->link_inertia = p->arm.link_inertia;
    a->hub_inertia = p->arm.hub_inertia;
    a->tip_mass = p->arm.tip_mass;
    a->held_angle = p->initial.angle;
    if (a->hub_spring) {
        a->hub_stiffness = p->arm.k1;
    } else {
        a->hub_stiffness = 0;
    }
    a->joint_stiffness = p->arm.k2 * a->links / 2;
    set_links(a, &p->arm);
    a->amount = amounts_of(p);
    motor_init(&a->motor, &p->motor);
    wall_init(&a->wall, p);

    // structural damping
    if (p->arm.damping_ratio > 0 && (a->links > 1 || a->hub_spring)) {
        // torque c dot(bend) in each spring, c = 2 zeta k / w1, damps the first mode by
        // zeta
        double per_stiffness = 2 * p->arm.damping_ratio / first_clamped_frequency(a);
        a->joint_damping = per_stiffness * a->joint_stiffness;
        a->hub_joint_damping = per_stiffness * a->hub_stiffness;
        for (int k = 0; a->uneven && k < a->links; k++) {
            a->each[k].damping = per_stiffness * a->each[k].stiffness;
        }
    }

    set_joint_damping(a, &p->arm);
    a->damped_modes = modal_damping_rows(a, p->arm.modal_ratios, a->modal_damping);

    // how fast it can be
    a->highest_frequency = highest_frequency(a);
    a->fastest_decay = fastest_decay(a, p->arm.joint_damping[0] != '\0');
    a->fastest_rate = fmax(a->highest_frequency, DECAY_WEIGHT * a->fastest_decay);
    if (a->motor.inductance > 0) { // the current is no decay to be passed over
        a->fastest_rate =
            fmax(a->fastest_rate, a->motor.resistance / a->motor.inductance);
    }
}
