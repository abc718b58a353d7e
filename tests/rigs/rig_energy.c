// The ledger of energy, computed again from powers.
#include <math.h>
#include <stdlib.h>

#include "tests/rigs/random_rigs.h"

// The ledger row by row; returns the largest sum of energies.
static double check_ledger(rig *r, const motion *m)
{
    double *const *c = m->of;
    double first = 0, scale = 0;
    for (size_t i = 0; i < m->count; i++) {
        const double stored = c[KINETIC][i] + c[STRAIN][i] + or_zero(c[WALL_ENERGY][i]) +
                              or_zero(c[WEIGHT_ENERGY][i]);
        const double lost = c[VISCOUS_LOSS][i] + c[FRICTION_LOSS][i] +
                            c[DAMPING_LOSS][i] + c[IMPACT_LOSS][i] +
                            or_zero(c[WALL_LOSS][i]);
        const double given_in =
            c[MOTOR_WORK][i] + c[EXTERNAL_WORK][i] + or_zero(c[WALL_WORK][i]);
        first = i == 0 ? stored - given_in + lost : first;
        scale = fmax(scale, fabs(stored) + fabs(lost) + fabs(given_in));
        expect_near(r, "energy_residual", c[TIME][i], c[RESIDUAL][i],
                    stored + lost - given_in - first, 1e-12 * scale + 1e-15);
    }
    const double open =
        fmax(largest_of(m, c[RESIDUAL], 1), largest_of(m, c[RESIDUAL], -1));
    expect(r, "energy_residual_J", 0, quantity(m, "energy_residual_J"),
           open - ROUNDING * scale, (double)INFINITY);
    expect_near(r, "motor_work_J", 0, quantity(m, "motor_work_J"),
                c[MOTOR_WORK][m->count - 1], 1e-12 * scale);
    return scale;
}

// A power of each row [W].
typedef double (*power_of)(const rig *r, const motion *m, size_t row);

// The current without that of the back EMF, which flows where no inductance delays it
// [A].
static double current_at(const rig *r, const motion *m, size_t i)
{
    const double stalled = m->of[MOTOR_TORQUE][i] / number(r, "motor.torque_constant");
    const bool at_once =
        is(r, "motor.drive", "voltage") && number(r, "motor.inductance") == 0;
    const double EMF = number(r, "motor.back_emf") * m->of[HUB_VELOCITY][i];
    return at_once ? stalled - EMF / number(r, "motor.resistance") : stalled;
}

static double fed_power(const rig *r, const motion *m, size_t i)
{
    const double current = current_at(r, m, i);
    if (is(r, "motor.drive", "voltage")) {
        return number(r, "motor.amplifier_gain") * m->of[VOLTAGE][i] * current;
    }
    const double EMF = number(r, "motor.back_emf") * m->of[HUB_VELOCITY][i];
    return number(r, "motor.resistance") * current * current + EMF * current;
}

static double motor_power(const rig *r, const motion *m, size_t i)
{
    (void)r;
    return m->of[MOTOR_TORQUE][i] * m->of[HUB_VELOCITY][i];
}

static double friction_power(const rig *r, const motion *m, size_t i)
{
    return number(r, "motor.stiction") * fabs(m->of[HUB_VELOCITY][i]);
}

// Back EMF counts with the friction where the current follows at once.
static double viscous_power(const rig *r, const motion *m, size_t i)
{
    const bool at_once =
        is(r, "motor.drive", "voltage") && number(r, "motor.inductance") == 0;
    double kv = number(r, "motor.viscous_friction");
    if (at_once) {
        kv += number(r, "motor.torque_constant") * number(r, "motor.back_emf") /
              number(r, "motor.resistance");
    }
    return kv * m->of[HUB_VELOCITY][i] * m->of[HUB_VELOCITY][i];
}

// An energy that is to be the integral of a power.
static void expect_energy(rig *r, const motion *m, const char *what, double got,
                          power_of power, double scale)
{
    double *values = malloc(m->count * sizeof(double)), error;
    for (size_t i = 0; i < m->count; i++) {
        values[i] = power(r, m, i);
    }
    pieces p = pieces_of(m, values);
    const double energy = integral(&p, 0, m->ends, &error);
    expect_near(r, what, m->ends, got, energy, error + 1e-8 * scale);
    free(p.of);
    free(values);
}

void check_energy(rig *r, const motion *m)
{
    const double scale = check_ledger(r, m), fed = quantity(m, "electrical_energy_J");
    const size_t last = m->count - 1;
    expect_energy(r, m, "motor_work", m->of[MOTOR_WORK][last], motor_power, scale);
    expect_energy(r, m, "friction_loss", m->of[FRICTION_LOSS][last], friction_power,
                  scale);
    if (number(r, "motor.current_limit") == 0) {
        expect_energy(r, m, "viscous_loss", m->of[VISCOUS_LOSS][last], viscous_power,
                      scale);
    }
    if (!isnan(fed) && number(r, "motor.current_limit") == 0) {
        expect_energy(r, m, "electrical_energy_J", fed, fed_power, scale);
    }
}
