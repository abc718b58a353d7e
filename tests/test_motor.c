// The drive's constants from its nameplate, the limit of its command, and its energy.
#include "tests/arm_fixture.h"

#include "src/arm/motor.h"

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

static void constants_follow_from_the_circuit(void **state)
{
    (void)state;
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

static void commands_saturate_both_ways(void **state)
{
    (void)state;
    motor_parameters p = drive();
    motor_model m;
    motor_init(&m, &p);
    const double commands[] = {3, 10, 11, 1e6, -4, -10.5}, reached[] = {3, 10, 10, 10, -4, -10};
    for (int i = 0; i < 6; i++) {
        motor_set_voltage(&m, commands[i]);
        check_close(m.voltage, reached[i], 0);
        check_close(m.torque, reached[i] * m.torque_per_volt, 0);
        check_close(motor_limited_voltage(&p, commands[i]), reached[i], 0);
    }
}

static void the_command_in_force_leaves_the_parameter_alone(void **state)
{
    (void)state;
    motor_parameters p = drive();
    motor_model m;
    motor_init(&m, &p);
    motor_set_voltage(&m, 7);
    check_close(p.voltage, 2, 0);
}

// What goes in becomes heat in the armature and mechanical work, back EMF included.
static void energy_in_is_heat_and_work(void **state)
{
    (void)state;
    motor_parameters p = drive();
    const double volts = 4, duration = 0.3, speed = 1.7, turn = speed * duration;
    double current = (p.amplifier_gain * volts - p.back_emf * speed) / p.resistance;
    double heat = current * current * p.resistance * duration;
    double work = p.back_emf * current * turn;
    check_relative(motor_electrical_energy(&p, volts, duration, turn), heat + work, 1e-14);
    // a motor that is turned against its command gives energy back where back EMF outweighs it
    check_below(motor_electrical_energy(&p, 1, 1, 10), 0);
    // and a command beyond the limit feeds in no more than one at it
    check_close(motor_electrical_energy(&p, 99, 1, 0), motor_electrical_energy(&p, 10, 1, 0), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constants_follow_from_the_circuit),
        cmocka_unit_test(commands_saturate_both_ways),
        cmocka_unit_test(the_command_in_force_leaves_the_parameter_alone),
        cmocka_unit_test(energy_in_is_heat_and_work),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
