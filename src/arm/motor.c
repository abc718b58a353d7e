#include "src/arm/motor.h"

#include <math.h>

#include "src/base/extremes.h"

double motor_command_limit(const motor_parameters *p)
{
    if (p->drive != DRIVE_CURRENT || p->current_limit == 0 || p->transconductance == 0) {
        return p->voltage_limit;
    }
    return fmin(p->voltage_limit, p->current_limit / p->transconductance);
}

static double clamp_voltage(double volts, double limit)
{
    return larger(smaller(volts, limit), -limit);
}

double motor_limited_voltage(const motor_parameters *p, double volts)
{
    return clamp_voltage(volts, motor_command_limit(p));
}

double motor_torque_per_volt(const motor_parameters *p)
{
    if (p->drive == DRIVE_CURRENT) {
        return p->transconductance * p->torque_constant;
    }
    return p->amplifier_gain * p->torque_constant / p->resistance;
}

double motor_damping(const motor_parameters *p)
{
    if (p->drive == DRIVE_CURRENT) {
        return p->viscous_friction; // the amplifier overcomes back EMF
    }
    return p->viscous_friction + p->torque_constant * p->back_emf / p->resistance;
}

static bool is_electric(const motor_parameters *p)
{
    return p->drive == DRIVE_VOLTAGE && (p->inductance > 0 || p->current_limit > 0);
}

double motor_electrical_energy(const motor_parameters *p, double volts, double duration,
                               double turn)
{
    double command = motor_limited_voltage(p, volts);
    if (is_electric(p)) {
        return (double)NAN;
    }
    if (p->drive == DRIVE_CURRENT) {
        // heat of the current, and its work against back EMF
        double current = p->transconductance * command;
        return current * (current * p->resistance * duration + p->back_emf * turn);
    }
    double amplified = p->amplifier_gain * command;
    return amplified / p->resistance * (amplified * duration - p->back_emf * turn);
}

void motor_init(motor_model *m, const motor_parameters *p)
{
    *m = (motor_model){.voltage_limit = motor_command_limit(p),
                       .torque_per_volt = motor_torque_per_volt(p),
                       .damping = motor_damping(p),
                       .stiction = p->stiction};
    if (is_electric(p)) {
        m->electric = true;
        m->torque_per_volt = 0;
        m->damping = p->viscous_friction;
        m->gain = p->amplifier_gain;
        m->torque_constant = p->torque_constant;
        m->back_emf = p->back_emf;
        m->resistance = p->resistance;
        m->inductance = p->inductance;
        if (p->current_limit > 0) {
            m->current_limit = p->current_limit;
        } else {
            m->current_limit = HUGE_VAL;
        }
    }
    motor_set_voltage(m, p->voltage);
}

void motor_set_voltage(motor_model *m, double volts)
{
    m->voltage = clamp_voltage(volts, m->voltage_limit);
    m->torque = m->torque_per_volt * m->voltage;
}
