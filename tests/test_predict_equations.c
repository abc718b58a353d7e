// The thesis's predictors against their equations, derived anew: the corrected arm of two
// links with any hub, lengths and masses, and the printed forms.
#include "tests/three_body_states.h"

// Masses of both links' angles and levers of a force on the tip's side at a bend, hub
// included where it is one body with the first link.
typedef struct links {
    double m22, m23, m33; // [kg m2]
    double j2, j3;        // the way that the contact point makes by each angle [m]
    double i1;            // the hub's own [kg m2]
} links;

static links links_of(const parameters *p, double bend)
{
    const double l = p->arm.length / 2, m = p->arm.mass / 2, e = l / 2,
                 in = p->arm.link_inertia;
    const bool rigid = p->arm.hub_joint == HUB_RIGID;
    links a = {.m22 = m * (e * e + l * l) + in + (rigid ? p->arm.hub_inertia : 0),
               .m23 = m * l * e * cos(bend),
               .m33 = m * e * e + in,
               .i1 = rigid ? 0 : p->arm.hub_inertia};
    if (p->wall.kind == WALL_PLANE) {
        a.j2 = a.j3 = l * cos(bend / 2);
    } else {
        // the point of the second link that is a beam's length away from the hub
        a.j2 = l * cos(bend);
        a.j3 = -l * cos(bend) + sqrt(l * l * cos(bend) * cos(bend) + 3 * l * l);
    }
    return a;
}

// The drive that the motor leaves when the hub turns at w.
static double drive_of(const parameters *p, double w, double *damping)
{
    const motor_parameters *m = &p->motor;
    const double per_volt = m->amplifier_gain * m->torque_constant / m->resistance;
    *damping = m->viscous_friction + m->torque_constant * m->back_emf / m->resistance;
    return per_volt * m->voltage - m->stiction * ((w > 0) - (w < 0));
}

// An arm of other lengths, masses and motors, moving any way.
static parameters any_arm(int trial, unsigned *seed, three_body_state *s)
{
    parameters p = corrected_with(trial % 2 ? HUB_SPRING : HUB_RIGID);
    p.wall.kind = trial % 4 < 2 ? WALL_POINT : WALL_PLANE;
    p.arm.length *= 1 + 0.4 * noise(seed);
    p.arm.mass *= 1 + 0.4 * noise(seed);
    p.arm.link_inertia *= 2 + noise(seed);
    p.arm.hub_inertia *= 1 + 0.5 * noise(seed);
    p.arm.k1 *= 1 + 0.5 * noise(seed);
    p.arm.k2 *= pow(10, 0.5 + 0.5 * noise(seed));
    p.motor.voltage = 1.5 * noise(seed);
    p.motor.stiction = 0.05 * (1 + noise(seed));
    for (int i = 0; i < 3; i++) {
        s->angle[i] = 0.1 + 0.08 * noise(seed);
        s->velocity[i] = trial % 8 == 7 ? 0 : 2 * noise(seed);
    }
    return p;
}

// Energy of all bodies, shared by the springs in series; then both links rest, bent back,
// and the wall's force is what the drive and the spring press with.
static double energy_force(const parameters *p, const three_body_state *s)
{
    const bool rigid = p->arm.hub_joint == HUB_RIGID;
    const double w[3] = {s->velocity[rigid ? 1 : 0], s->velocity[1], s->velocity[2]};
    const double bend = s->angle[2] - s->angle[1], hub_bend = s->angle[1] - s->angle[0];
    double energy = kinetic_energy(p, s->angle, w) + 0.5 * p->arm.k2 * bend * bend +
                    (rigid ? 0 : 0.5 * p->arm.k1 * hub_bend * hub_bend);

    // what an oscillator with the damping of the beam keeps until it is bent most
    if (p->arm.damping_ratio > 0) {
        const links a = links_of(p, bend);
        const double turn = -a.j2 / a.j3,
                     mass = a.m22 + 2 * a.m23 * turn + a.m33 * turn * turn;
        const double square = p->arm.k2 * (turn - 1) * (turn - 1) / mass;
        const double d = square * p->arm.damping_ratio / sqrt(p->arm.k2 / a.m33);
        const double rate = w[2] - w[1], frequency = sqrt(square - d * d);
        const double angle = atan(fabs(rate / (frequency * bend)));
        energy *= exp(-2 * d / frequency * (rate * bend > 0 ? angle : M_PI - angle));
    }

    // the softer spring takes more of it
    const double share = rigid ? 1 : p->arm.k1 / (p->arm.k1 + p->arm.k2);
    const double most = sqrt(2 * energy * share / p->arm.k2);
    const double hub_most = sqrt(2 * energy * (1 - share) / p->arm.k1);
    const links a = links_of(p, -most);
    double damping, drive = drive_of(p, w[0], &damping);
    drive = rigid ? drive : p->arm.k1 * hub_most;

    // along the wall nothing but the drive and the spring acts
    const double k = p->arm.k2 * most, turn = -a.j2 / a.j3;
    const double mass = a.m22 + 2 * a.m23 * turn + a.m33 * turn * turn;
    const double acceleration = (drive - k + turn * k) / mass;
    return (k - (a.m23 + a.m33 * turn) * acceleration) / a.j3;
}

TEST(energy_of_any_state_is_shared_by_the_springs)
{
    unsigned seed = 21;
    for (int trial = 0; trial < 400; trial++) {
        three_body_state s;
        parameters p = any_arm(trial, &seed, &s);
        p.arm.damping_ratio =
            trial % 3 == 0 && trial % 8 != 7 ? 0.05 * (1.1 + noise(&seed)) : 0;
        prediction out;
        assert_int_equal(predict_energy(&p, &s, &out, NULL), STATUS_OK);
        check_relative(out.force, energy_force(&p, &s), 1e-9);
        assert_true(isnan(out.delay) && isnan(out.impulse) && isnan(out.restitution));
    }
}

// Without any oscillation to speak of, more than critically damped, no energy is left.
TEST(what_only_creeps_keeps_no_energy)
{
    unsigned seed = 23;
    three_body_state s;
    parameters p = any_arm(0, &seed, &s);
    p.arm.damping_ratio = 5;
    prediction out;
    assert_int_equal(predict_energy(&p, &s, &out, NULL), STATUS_OK);

    // the drive alone, with a straight arm
    const links a = links_of(&p, 0);
    double damping;
    const double drive = drive_of(&p, s.velocity[1], &damping), turn = -a.j2 / a.j3;
    const double mass = a.m22 + 2 * a.m23 * turn + a.m33 * turn * turn;
    check_relative(out.force, -(a.m23 + a.m33 * turn) * drive / mass / a.j3, 1e-9);
}

// The energy predictor of the listing: its masses and its levers, (4.28), (4.29), (4.34).
TEST(listed_energy_of_any_state)
{
    unsigned seed = 22;
    for (int trial = 0; trial < 200; trial++) {
        three_body_state s;
        const parameters other = any_arm(trial, &seed, &s);
        parameters p = defaults_of(ARM_PRINTED);
        p.arm.length = other.arm.length, p.arm.mass = other.arm.mass;
        p.arm.link_inertia = other.arm.link_inertia,
        p.arm.hub_inertia = other.arm.hub_inertia;
        p.arm.k2 = other.arm.k2, p.motor.voltage = other.motor.voltage;
        p.printed.energy_cross_term = trial % 2;

        // I2 and I3 left out, and one length too many or not
        const double l = p.arm.length / 2, e = l / 2, m = p.arm.mass / 2, *w = s.velocity;
        const double b = s.angle[2] - s.angle[1], cross = trial % 2 ? e : 2 * l * e;
        const double twice =
            p.arm.hub_inertia * w[0] * w[0] + m * e * e * (w[1] * w[1] + w[2] * w[2]) +
            m * l * l * w[1] * w[1] + m * cross * w[1] * w[2] * cos(b) + p.arm.k2 * b * b;

        // (m22 + m23) a + l (1 + c) f = S - k d, (m32 - c m33) ... with l (c a2 + a3) = 0
        double damping;
        p.motor.stiction = 0;
        const double d = sqrt(twice / p.arm.k2), c = cos(d),
                     drive = drive_of(&p, 1, &damping);
        const double m33 = m * e * e + p.arm.link_inertia, m23 = m * l * e * c;
        const double m22 = m33 + m * l * l;
        const double both = m22 + m23 - c * (m33 + m23), last = m23 - c * m33,
                     k = p.arm.k2 * d;
        const double force =
            (both * k - last * (drive - k)) / (both * l - last * l * (1 + c));
        prediction out;
        assert_int_equal(predict_energy(&p, &s, &out, NULL), STATUS_OK);
        check_relative(out.force, force, 1e-9);
    }
}

// What (4.20)-(4.22) leave of the corrected arm at a delay, force and hub velocity from
// the others.
typedef struct motion_left {
    double left;  // balance of both links [N m s]
    double force; // [N]
    double hub;   // [rad/s]
} motion_left;

static motion_left left_at(const parameters *p, const three_body_state *s,
                           const double after[3], double T)
{
    const bool rigid = p->arm.hub_joint == HUB_RIGID;
    const double d1 = s->angle[1] - s->angle[0], d2 = s->angle[2] - s->angle[1];
    const links a = links_of(p, d2);
    double damping;
    const double drive = drive_of(p, s->velocity[rigid ? 1 : 0], &damping);
    const double w2 = after[1], w3 = after[2];
    const double both = (a.m22 + a.m23) * w2 + (a.m23 + a.m33) * w3;
    const double last = a.m23 * w2 + a.m33 * w3;
    const double spring = p->arm.k2 * (T * d2 + T * T * (w3 - w2) / 4);
    motion_left out = {.force = 2 * (last - spring) / (T * a.j3), .hub = w2};
    double hub_spring = -drive * T + damping * T * w2 / 2;
    if (!rigid) {
        const double k1 = p->arm.k1;
        out.hub = (T * (k1 * d1 + drive) + T * T * k1 * w2 / 4) /
                  (k1 * T * T / 4 + damping * T / 2 - a.i1);
        hub_spring = k1 * T * d1 + k1 * T * T * (w2 - out.hub) / 4;
    }
    out.left = hub_spring - both + (a.j2 + a.j3) * T * out.force / 2;
    return out;
}

TEST(corrected_dynamics_solves_its_equations)
{
    unsigned seed = 24;
    int found = 0, none = 0;
    for (int trial = 0; trial < 400; trial++) {
        three_body_state s;
        parameters p = any_arm(trial, &seed, &s);
        prediction out, quadratic;
        double after[3], impulse;
        assert_int_equal(predict_velocity_jump(&p, &s, after, &impulse, NULL), STATUS_OK);
        assert_int_equal(predict_impact_dynamics(&p, &s, &out, NULL), STATUS_OK);
        check_close(out.impulse, impulse, 0);

        // every delay at which the balance changes its sign, but for where the hub's has
        // a pole
        double best = HUGE_VAL, delay = (double)NAN, before = 1e-9;
        const bool rigid = p.arm.hub_joint == HUB_RIGID;
        for (double T = 1.01e-9; T < 100; before = T, T *= 1.006) {
            double low = before, high = T;
            const double sign = left_at(&p, &s, after, low).left;
            if (sign * left_at(&p, &s, after, high).left > 0) {
                continue;
            }
            for (int i = 0; i < 80; i++) {
                const double middle = (low + high) / 2;
                *(left_at(&p, &s, after, middle).left * sign > 0 ? &low : &high) = middle;
            }
            const motion_left at = left_at(&p, &s, after, low);
            const double away = rigid ? low : fabs(at.hub - s.velocity[0]);
            if (fabs(at.left) < 1e-6 && (rigid || at.force > 0) && away < best) {
                best = away;
                delay = low;
            }
        }
        if (isnan(delay)) {
            none++;
            assert_false(out.holds);
        } else if (fabs(delay - out.delay) > 1e-6 * delay) {
            fail_msg("trial %d: delay %.9g, expected %.9g", trial, out.delay, delay);
        } else {
            found++;
            check_close(out.force, left_at(&p, &s, after, delay).force,
                        1e-4 * (1 + fabs(out.force)));
            assert_true(!out.holds || (impulse >= 0 && out.force > 0));
        }

        // the quadratic form is that of a rigid hub, for any hub
        assert_int_equal(predict_impact_quadratic(&p, &s, &quadratic, NULL), STATUS_OK);
        p.arm.hub_joint = HUB_RIGID;
        assert_int_equal(predict_impact_dynamics(&p, &s, &out, NULL), STATUS_OK);
        assert_true(quadratic.force == out.force ||
                    (isnan(quadratic.force) && isnan(out.force)));
        assert_int_equal(quadratic.holds, out.holds);
    }
    assert_true(found > 200 && none > 0);
}

// The printed quadratic form: the hub jumps with the first link, (4.21) and (4.22)
// remain.
TEST(the_printed_quadratic_form_solves_two_of_the_equations)
{
    unsigned seed = 25;
    int found = 0;
    for (int trial = 0; trial < 200; trial++) {
        parameters p = defaults_of(ARM_PRINTED);
        p.arm.k2 *= pow(10, 1 + noise(&seed));
        p.printed.spring_counted_twice = trial % 2;
        const three_body_state s = state_at_wall(&p, &seed);
        prediction out;
        double after[3], impulse;
        assert_int_equal(predict_velocity_jump(&p, &s, after, &impulse, NULL), STATUS_OK);
        assert_int_equal(predict_impact_quadratic(&p, &s, &out, NULL), STATUS_OK);
        if (!out.holds) {
            continue;
        }

        // with all that jumps, the hub's angle is its bend away
        const double l = 0.5, u = p.arm.mass / 2 * 0.0625, w2 = after[1], w3 = after[2];
        const double w1 = s.velocity[0] + w2 - s.velocity[1], T = out.delay,
                     f = out.force;
        const double d1 = s.angle[1] - s.angle[0], d2 = s.angle[2] - s.angle[1];
        const double spring1 = p.arm.k1 * T * (d1 + T / 4 * (w2 - w1));
        const double spring2 = p.arm.k2 * T * (d2 + T / 4 * (w3 - w2));
        check_close(spring1 - (trial % 2) * spring2 - 7 * u * w2 - 3 * u * w3 +
                        T / 2 * l * (1 + cos(d2)) * f,
                    0, 1e-9);
        check_close(spring2 + T / 2 * l * f - 2 * u * cos(d2) * w2 -
                        (u + p.arm.link_inertia) * w3,
                    0, 1e-9);
        found++;
    }
    assert_true(found > 100);
}
