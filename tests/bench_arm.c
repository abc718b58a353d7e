// The bench by Runge and Kutta's formula of order 4 with dense equations.
#include "tests/bench_arm.h"

#include <math.h>
#include <string.h>

#define STEP             5e-5 // [s]
#define COUPLING_DAMPING 0.02 // [N m s/rad]
#define CREEP            2e-3 // velocity below which friction is viscous [rad/s]

// Volts, force in the sensor, rotor's angle and velocity, rods' angles and velocities.
enum { VOLTS, FELT, ROTOR, ROTOR_VELOCITY, RODS, STATES = RODS + 2 * BENCH_LINKS };

// Solves the symmetric positive definite system a x = b in place, by Gauss.
static void solve(int n, double a[][BENCH_LINKS], double *b)
{
    for (int k = 0; k < n; k++) {
        for (int i = k + 1; i < n; i++) {
            const double factor = a[i][k] / a[k][k];
            for (int j = k; j < n; j++) {
                a[i][j] -= factor * a[k][j];
            }
            b[i] -= factor * b[k];
        }
    }
    for (int k = n - 1; k >= 0; k--) {
        for (int j = k + 1; j < n; j++) {
            b[k] -= a[k][j] * b[j];
        }
        b[k] /= a[k][k];
    }
}

// The torque of the rotor on the first rod, which are `apart` [rad] and `moving` apart
// [rad/s].
static double coupling(const bench_arm *a, double apart, double moving)
{
    const double out = fmax(fabs(apart) - a->play / 2, 0);
    if (out == 0) {
        return 0;
    }
    return copysign(a->coupling * out, apart) + COUPLING_DAMPING * moving;
}

// The force of the wall at angle 0 on the tip of rods q with velocities w.
static double wall_force(const bench_arm *a, const double *q, const double *w)
{
    const double l = a->length / a->links;
    double depth = 0, speed = 0;
    for (int i = 0; i < a->links; i++) {
        depth += l * sin(q[i]);
        speed += l * cos(q[i]) * w[i];
    }
    if (depth <= 0) {
        return 0;
    }
    return fmax(a->wall_stiffness * depth + a->wall_damping * speed, 0);
}

static void rates(const bench_arm *a, double command, const double *y, double *rate)
{
    const int n = a->links;
    const double l = a->length / n, m = a->mass / n;
    const double *q = y + RODS, *w = q + n;
    const double force = wall_force(a, q, w);
    const double torque = coupling(a, y[ROTOR] - q[0], y[ROTOR_VELOCITY] - w[0]);
    double matrix[BENCH_LINKS][BENCH_LINKS], right[BENCH_LINKS];

    // the rods
    for (int i = 0; i < n; i++) {
        right[i] = -force * l * cos(q[i]);
        for (int j = 0; j < n; j++) {
            const int outer = i > j ? i : j;
            const double share = i == j ? 2.0 / 3 : 0.5;
            const double both = l * l * (m * (n - outer - share) + a->tip_mass);
            matrix[i][j] = both * cos(q[i] - q[j]);
            right[i] -= both * sin(q[i] - q[j]) * w[j] * w[j];
        }
        if (i > 0) {
            right[i] -= a->joint_stiffness * (q[i] - q[i - 1]);
        }
        if (i + 1 < n) {
            right[i] += a->joint_stiffness * (q[i + 1] - q[i]);
        }
    }
    right[0] += torque;
    solve(n, matrix, right);

    // the motor and the sensor
    rate[VOLTS] = (command - y[VOLTS]) / a->amplifier_lag;
    rate[FELT] = (force - y[FELT]) / a->force_lag;
    rate[ROTOR] = y[ROTOR_VELOCITY];
    rate[ROTOR_VELOCITY] =
        (a->torque_per_volt * y[VOLTS] - a->damping * y[ROTOR_VELOCITY] -
         a->stiction * tanh(y[ROTOR_VELOCITY] / CREEP) - torque) /
        a->rotor_inertia;
    memcpy(rate + RODS, w, (size_t)n * sizeof *w);
    memcpy(rate + RODS + n, right, (size_t)n * sizeof *right);
}

static void step(const bench_arm *a, double command, double *y)
{
    static const double along[4] = {0, 0.5, 0.5, 1}, weight[4] = {1, 2, 2, 1};
    const int states = RODS + 2 * a->links;
    double sum[STATES] = {0}, rate[STATES] = {0}, at[STATES];
    for (int stage = 0; stage < 4; stage++) {
        for (int i = 0; i < states; i++) {
            at[i] = y[i] + along[stage] * STEP * rate[i];
        }
        rates(a, command, at, rate);
        for (int i = 0; i < states; i++) {
            sum[i] += weight[stage] * rate[i];
        }
    }
    for (int i = 0; i < states; i++) {
        y[i] += STEP / 6 * sum[i];
    }
}

void bench_arm_run(const bench_arm *a, const double *command, int samples, double rate,
                   bench_sample *to)
{
    double y[STATES] = {[ROTOR] = a->start};
    const int steps = (int)lround(1 / (rate * STEP));
    for (int i = 0; i < a->links; i++) {
        y[RODS + i] = a->start;
    }
    for (int k = 0; k < samples; k++) {
        to[k] = (bench_sample){y[ROTOR], y[ROTOR_VELOCITY], y[FELT]};
        for (int i = 0; i < steps; i++) {
            step(a, command[k], y);
        }
    }
}
