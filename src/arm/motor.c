#include "src/arm/motor.h"

#include <assert.h>
#include <math.h>

static double limited(double volts, double limit)
{
    return fmax(-limit, fmin(volts, limit));
}

double motor_limited_voltage(const motor_parameters *p, double volts)
{
    assert(p != NULL);
    return limited(volts, p->voltage_limit);
}

double motor_torque_per_volt(const motor_parameters *p)
{
    assert(p != NULL);
    return p->amplifier_gain * p->torque_constant / p->resistance;
}

double motor_damping(const motor_parameters *p)
{
    assert(p != NULL);
    return p->viscous_friction + p->torque_constant * p->back_emf / p->resistance;
}

double motor_electrical_energy(const motor_parameters *p, double volts, double duration,
                               double turn)
{
    assert(p != NULL);
    double amplified = p->amplifier_gain * limited(volts, p->voltage_limit);
    return amplified / p->resistance * (amplified * duration - p->back_emf * turn);
}

void motor_init(motor_model *m, const motor_parameters *p)
{
    assert(m != NULL && p != NULL);
    *m = (motor_model){.voltage_limit = p->voltage_limit,
                       .torque_per_volt = motor_torque_per_volt(p),
                       .damping = motor_damping(p),
                       .stiction = p->stiction};
    motor_set_voltage(m, p->voltage);
}

void motor_set_voltage(motor_model *m, double volts)
{
    assert(m != NULL);
    m->voltage = limited(volts, m->voltage_limit);
    m->torque = m->torque_per_volt * m->voltage;
}
