// The drive's constants from its nameplate, the limit of its command, and its energy.
#include "tests/arm_fixture.h"

static motor_parameters drive(void)
{
    return (motor_parameters){.voltage = 2,
                              .voltage_limit = 10,
                              .amplifier_gain = 6,
                              .torque_constant = 2.5,
                              .back_emf = 2,
                              .resistance = 30,
                              .viscous_friction = 0.01,
                              .stiction = 0.05};
}

// Torque per volt, damping and torque at the command of 2 V, computed by hand from the
// numbers of drive().
TEST(constants_follow_from_the_circuit)
{
    motor_parameters p = drive();
    motor_model m;
    motor_init(&m, &p);
    // torque = kT i, i = (gain u - kB w) / Ra
    check_close(m.torque_per_volt, 6 * 2.5 / 30, 1e-15);
    check_close(m.damping, 0.01 + 2.5 * 2 / 30, 1e-15);
    check_close(m.stiction, 0.05, 0);
    check_close(m.voltage, 2, 0);
    check_close(m.torque, 1, 1e-15);
}

TEST(commands_saturate_both_ways)
{
    motor_parameters p = drive();
    motor_model m;
    motor_init(&m, &p);
    const double commands[] = {3, 10, 11, 1e6, -4, -10.5},
                 reached[] = {3, 10, 10, 10, -4, -10};
    for (int i = 0; i < 6; i++) {
        motor_set_voltage(&m, commands[i]);
        check_close(m.voltage, reached[i], 0);
        check_close(m.torque, reached[i] * m.torque_per_volt, 0);
        check_close(motor_limited_voltage(&p, commands[i]), reached[i], 0);
    }
}

TEST(the_command_in_force_leaves_the_parameter_alone)
{
    motor_parameters p = drive();
    motor_model m;
    motor_init(&m, &p);
    motor_set_voltage(&m, 7);
    check_close(p.voltage, 2, 0);
}

// What goes in becomes heat in the armature and mechanical work, back EMF included.
TEST(energy_in_is_heat_and_work)
{
    motor_parameters p = drive();
    const double volts = 4, duration = 0.3, speed = 1.7, turn = speed * duration;
    double current = (p.amplifier_gain * volts - p.back_emf * speed) / p.resistance;
    double heat = current * current * p.resistance * duration;
    double work = p.back_emf * current * turn;
    check_relative(motor_electrical_energy(&p, volts, duration, turn), heat + work,
                   1e-14);
    // a motor that is turned against its command gives energy back where back EMF
    // outweighs it
    check_below(motor_electrical_energy(&p, 1, 1, 10), 0);
    // and a command beyond the limit feeds in no more than one at it
    check_close(motor_electrical_energy(&p, 99, 1, 0),
                motor_electrical_energy(&p, 10, 1, 0), 0);
}

// An amplifier that controls the current: a torque independent of the speed, and a limit
// in amperes.
TEST(a_current_drive_knows_no_back_emf)
{
    motor_parameters p = drive();
    motor_model m;
    p.drive = DRIVE_CURRENT;
    p.transconductance = 0.2; // A per volt of command
    motor_init(&m, &p);
    check_close(m.torque_per_volt, 0.2 * 2.5, 1e-15);
    check_close(m.damping, 0.01, 0);
    check_close(motor_command_limit(&p), 10, 0);

    // 0.5 A are 2.5 V of command
    p.current_limit = 0.5;
    motor_init(&m, &p);
    motor_set_voltage(&m, 7);
    check_close(m.voltage, 2.5, 0);
    check_relative(m.torque, 0.5 * 2.5, 1e-15);

    // an amplifier that gives no current reaches no limit
    motor_parameters idle = p;
    idle.transconductance = 0;
    check_close(motor_command_limit(&idle), 10, 0);

    // where the current takes its time, what goes in is not known from the command alone
    motor_parameters coil = drive();
    coil.inductance = 1e-3;
    assert_true(isnan(motor_electrical_energy(&coil, 2, 0.3, 0.51)));

    // what a command of 2 V puts in: heat, and work against back EMF
    const double duration = 0.3, turn = 0.51, current = 0.2 * 2;
    const double heat = current * current * p.resistance * duration;
    check_relative(motor_electrical_energy(&p, 2, duration, turn),
                   heat + p.back_emf * current * turn, 1e-14);
}

// A single link without friction in free motion: constant acceleration under a current,
// an exponential approach to the idle speed under a voltage.
TEST(free_motion_is_that_of_the_drive)
{
    for (int current = 0; current <= 1; current++) {
        parameters p =
            parameters_with("arm.links=1 wall.kind=none motor.stiction=0 "
                            "motor.viscous_friction=0 motor.voltage=2 %s",
                            current ? "motor.drive=current" : "motor.drive=voltage");
        arm a = arm_of(&p);
        KEPT_MOTION(m) = motion_create(&a, &p.method);
        motion_report report;
        const double inertia =
            p.arm.hub_inertia + p.arm.mass * p.arm.length * p.arm.length / 3;
        const double torque = 2 * 6.02 * p.motor.torque_constant / p.motor.resistance,
                     t = 0.4;
        motion_start(&a, m, 0, 0);
        assert_int_equal(motion_advance(&a, m, t, 1e-3, &report), STATUS_OK);
        double rate = motor_damping(&p.motor) / inertia;
        double speed = current ? torque / inertia * t
                               : torque / motor_damping(&p.motor) * (1 - exp(-rate * t));
        check_relative(state_velocities(m, m->state)[0], speed, 1e-9);
        check_close(motion_energy_residual(&a, m, m->state), 0, 1e-10);
    }
}

// The motion of an arm from its initial velocity until t [s]; the ledger closes on the
// way.
static motion *motion_until(const arm *a, const parameters *p, double t)
{
    motion *m = motion_create(a, &p->method);
    motion_report report = {.event = MOTION_REACHED};
    assert_non_null(m);
    motion_start(a, m, 0, p->initial.velocity);
    while (m->state[SLOT_TIME] < t) {
        assert_int_equal(motion_advance(a, m, t, 1e-3, &report), STATUS_OK);
        if (report.event != MOTION_REACHED) {
            motion_apply(a, m, &report);
        }
    }
    check_close(motion_energy_residual(a, m, m->state), 0, 1e-11);
    return m;
}

// Amplifier gain and armature resistance [ohm] of the shipped arm, from which the tests
// below expect their numbers: a command of u volts drives the current towards
// GAIN u / RESISTANCE while the hub stands still.
static const double GAIN = 6.02, RESISTANCE = 33.6;

// The current [A] of a motor whose armature has an inductance or a limit.
static double current_of(const motion *m)
{
    return state_quadratures(m, m->state)[QUADRATURE_CURRENT];
}

// With the hub held by friction a step of voltage is answered by V/R (1 - e^(-R t/L)).
TEST(current_of_a_held_motor_rises_as_in_a_coil)
{
    for (int links = 1; links <= 2; links++) {
        parameters p = parameters_with(
            "arm.links=%d wall.kind=none motor.stiction=1000 motor.inductance=0.1",
            links);
        arm a = arm_of(&p);
        for (int i = 1; i <= 4; i++) {
            const double t = 0.002 * i, inductance = 0.1;
            const double full = GAIN * 1 / RESISTANCE; // the command is 1 V
            KEPT_MOTION(m) = motion_until(&a, &p, t);
            check_relative(current_of(m), full * (1 - exp(-RESISTANCE / inductance * t)),
                           1e-9);
            check_close(state_velocities(m, m->state)[0], 0, 0);
        }
    }
}

// A single link without friction, whose hub turns at the speed w. The equations of motion
// and coil, J w' = kT i and L i' = V - R i - kB w, together are
// J L w" + J R w' + kT kB w = kT V. From rest without current, w approaches the idle
// speed V/kB by two exponentials, whose rates are the roots of J L s^2 + J R s + kT kB =
// 0; the current is J w'/kT.
TEST(a_free_link_and_its_coil_are_two_exponentials)
{
    const double inductance = 0.5, t = 0.15;
    parameters p =
        parameters_with("arm.links=1 wall.kind=none motor.stiction=0 "
                        "motor.viscous_friction=0 motor.inductance=0.5 motor.voltage=2");
    arm a = arm_of(&p);
    const double inertia =
        p.arm.hub_inertia + p.arm.mass * p.arm.length * p.arm.length / 3;
    const double kt = p.motor.torque_constant, kb = p.motor.back_emf,
                 r = p.motor.resistance;

    // the two rates [1/s], and the speed at which back EMF balances the voltage
    const double half = r / inductance / 2,
                 root = sqrt(half * half - kt * kb / inertia / inductance);
    const double fast = -half - root, slow = -half + root, idle = 2 * GAIN / kb;

    // speed and current are those of the formula
    KEPT_MOTION(m) = motion_until(&a, &p, t);
    check_relative(state_velocities(m, m->state)[0],
                   idle * (1 +
                           (fast * exp(slow * t) - slow * exp(fast * t)) / (slow - fast)),
                   1e-9);
    check_relative(current_of(m),
                   inertia / kt * idle * fast * slow / (slow - fast) *
                       (exp(slow * t) - exp(fast * t)),
                   1e-9);
}

// While an amplifier holds the current at its limit I the arm accelerates evenly, by
// kT I / J. That ends at the speed w with V - R I = kB w, from which on back EMF keeps
// the current below the limit; the rest of the way to the idle speed V/kB is an
// exponential of the rate kT kB / (R J).
TEST(a_limited_current_accelerates_evenly_at_first)
{
    parameters p = parameters_with(
        "arm.links=1 wall.kind=none motor.stiction=0 "
        "motor.viscous_friction=0 motor.current_limit=0.2 motor.voltage=2");
    arm a = arm_of(&p);
    const double inertia =
        p.arm.hub_inertia + p.arm.mass * p.arm.length * p.arm.length / 3;
    const double kt = p.motor.torque_constant, kb = p.motor.back_emf,
                 r = p.motor.resistance;

    // where the limited part ends: the speed `knee` at the time `until`
    const double volts = 2 * GAIN, limit = 0.2;
    const double knee = (volts - r * limit) / kb, until = knee * inertia / (kt * limit);
    const double idle = volts / kb, rate = kt * kb / r / inertia;

    // an instant at 0.7 of the limited part, and an instant 1.5 of it after its end
    const double times[2] = {0.7 * until, 2.5 * until};
    const double speeds[2] = {0.7 * knee,
                              idle + (knee - idle) * exp(-rate * 1.5 * until)};
    for (int i = 0; i < 2; i++) {
        KEPT_MOTION(m) = motion_until(&a, &p, times[i]);
        check_relative(state_velocities(m, m->state)[0], speeds[i], 1e-9);
    }
}

// With the hub held by friction the current of a coil rises as V/R (1 - e^(-R t/L))
// until it reaches the limit, and stays there.
TEST(a_held_coil_stays_at_the_limit_it_reaches)
{
    const double inductance = 0.1, limit = 0.1, rate = RESISTANCE / inductance;
    parameters p = parameters_with("wall.kind=none motor.stiction=1000 "
                                   "motor.inductance=0.1 motor.current_limit=0.1");
    arm a = arm_of(&p);

    // the formula, solved for the instant at which the current is at the limit
    const double reached = -1 / rate * log(1 - limit * RESISTANCE / GAIN);

    // before that instant it rises freely, behind it stays
    KEPT_MOTION(before) = motion_until(&a, &p, 0.9 * reached),
    *after = motion_until(&a, &p, 1.2 * reached);
    check_relative(current_of(before),
                   GAIN / RESISTANCE * (1 - exp(-rate * 0.9 * reached)), 1e-9);
    check_close(current_of(after), limit, 0);
}

// A link whose back EMF outweighs the voltage slows at one limit of the current, goes
// towards the speed at which friction and motor balance, and slows on at the other limit:
// however short the stretch between the limits is, angle and speed are those of the three
// pieces.
TEST(a_limited_current_changes_sides_however_fast)
{
    const double command = 7.298, volts = command * GAIN; // at the motor
    const double start = 18.5, whole = 0.4;
    for (EACH_OF(double, limit, 1e-3, 1e-4, 1e-5, 3e-3)) {
        for (EACH_OF(double, side, 1, -1)) {
            parameters p = parameters_with(
                "arm.links=1 arm.mass=0.0837 wall.kind=none motor.voltage=%.17g "
                "motor.viscous_friction=0 motor.current_limit=%.17g",
                command * *side, *limit);
            p.initial.velocity = start * *side;
            const double inertia = p.arm.hub_inertia + p.arm.mass / 3,
                         kst = p.motor.stiction;
            const double kt = p.motor.torque_constant, kb = p.motor.back_emf;
            const double resistance = p.motor.resistance,
                         rate = kt * kb / resistance / inertia;

            // Speeds of the three pieces: it falls evenly to `middle + drop`, where the
            // current leaves one limit; then exponentially, towards `balance`, to
            // `middle - drop`, where it comes to the other; then evenly again.
            const double drop = resistance * *limit / kb, middle = volts / kb;
            const double slows = (kst + kt * *limit) / inertia;
            const double slower = (kst - kt * *limit) / inertia;
            const double balance = middle - kst * resistance / (kt * kb);
            const double above = middle + drop - balance, below = middle - drop - balance;

            // how long each piece lasts, and the angle turned in all of them
            const double first = (start - middle - drop) / slows;
            const double second = log(above / below) / rate,
                         third = whole - first - second;
            const double turned = (start + middle + drop) / 2 * first + balance * second +
                                  2 * drop / rate + (middle - drop) * third -
                                  slower * third * third / 2;

            arm a = arm_of(&p);
            KEPT_MOTION(m) = motion_until(&a, &p, whole);
            check_close(*side * state_angles(m, m->state)[0], turned, 1e-10);
            check_close(*side * state_velocities(m, m->state)[0],
                        middle - drop - slower * third, 1e-10);
        }
    }
}

// The smaller the inductance L, the nearer is the momentum of an impact to that of a
// motor without inductance; the difference shrinks in proportion to L, so that it doubles
// from L = 1 mH to 2 mH and log2 of the ratio is 1.
TEST(a_small_inductance_is_none_in_the_limit)
{
    double momentum[3];
    const char *const coils[] = {"motor.inductance=0", "motor.inductance=2e-3",
                                 "motor.inductance=1e-3"};
    for (int i = 0; i < 3; i++) {
        parameters p = parameters_with("%s", coils[i]);
        arm a = arm_of(&p);
        KEPT_MOTION(m) = motion_until(&a, &p, 0.5); // through impact and pulse
        momentum[i] = state_quadratures(m, m->state)[QUADRATURE_FORCE];
    }
    check_close(log2((momentum[1] - momentum[0]) / (momentum[2] - momentum[0])), 1, 0.1);
}
