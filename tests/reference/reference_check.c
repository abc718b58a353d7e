#include <math.h>
#include <stdio.h>
#include <string.h>

#include "tests/reference/reference_bodies.h"

// ---------------------------------------------------------------------------------------------
// check of the equations

// Kinetic minus strain energy from the links' positions, without the mass matrix.
static double lagrangian(const body_chain *arm, const double *q, const double *w)
{
    double vx = 0.0, vy = 0.0, sum = 0.0;
    for (int i = 0; i < arm->bodies; i++) {
        sum += 0.5 * arm->own_inertia[i] * w[i] * w[i];
        if (i >= arm->first_link) {
            double half = 0.5 * arm->length;
            double cx = vx - half * w[i] * sin(q[i]), cy = vy + half * w[i] * cos(q[i]);
            sum += 0.5 * arm->mass * (cx * cx + cy * cy);
            vx -= 2.0 * half * w[i] * sin(q[i]);
            vy += 2.0 * half * w[i] * cos(q[i]);
        }
        if (i + 1 < arm->bodies) {
            sum -= 0.5 * arm->stiffness[i] * (q[i + 1] - q[i]) * (q[i + 1] - q[i]);
        }
    }
    return sum;
}

// Penetration from the positions of joint and tip.
static double penetration_by_position(const body_chain *arm, const double *q)
{
    double x = 0.0, y = 0.0, before_x = 0.0, before_y = 0.0;
    for (int i = arm->first_link; i < arm->bodies; i++) {
        before_x = x;
        before_y = y;
        x += arm->length * cos(q[i]);
        y += arm->length * sin(q[i]);
    }
    double a = cos(arm->direction), b = sin(arm->direction);
    if (arm->plane) {
        return a * y - b * x;
    }
    // cross product of the last link's direction with joint minus point
    double ex = (x - before_x) / arm->length, ey = (y - before_y) / arm->length;
    return ey * (a - before_x) - ex * (b - before_y);
}

// Angles and velocities tau later at constant acceleration.
static void along_path(int n, const double *y, const double *acceleration, double tau, double *q,
                       double *w)
{
    for (int i = 0; i < n; i++) {
        q[i] = y[i] + tau * y[n + i] + 0.5 * tau * tau * acceleration[i];
        w[i] = y[n + i] + tau * acceleration[i];
    }
}

// Momentum of body i (dL/dw_i) there; exact, since L is quadratic in w.
static double momentum_along(const body_chain *arm, const double *y, const double *acceleration,
                             double tau, int i)
{
    double q[BODIES_MAX], up[BODIES_MAX], down[BODIES_MAX];
    along_path(arm->bodies, y, acceleration, tau, q, up);
    memcpy(down, up, sizeof down);
    up[i] += 1.0;
    down[i] -= 1.0;
    return 0.5 * (lagrangian(arm, q, up) - lagrangian(arm, q, down));
}

static double penetration_along(const body_chain *arm, const double *y, const double *acceleration,
                                double tau)
{
    double q[BODIES_MAX], w[BODIES_MAX];
    along_path(arm->bodies, y, acceleration, tau, q, w);
    return penetration_by_position(arm, q);
}

// A number between -1 and 1 from a linear congruential generator (Knuth, MMIX).
static double random_number(unsigned long long *seed)
{
    *seed = *seed * 6364136223846793005ULL + 1442695040888963407ULL;
    return (double)(*seed >> 11) / 4503599627370496.0 - 1.0;
}

double reference_lagrangian_defect(const reference_case *c, unsigned seed)
{
    body_chain arm;
    body_chain_build(&arm, c);
    const int n = arm.bodies;
    double y[STATE_MAX] = {0}, worst = 0.0;
    unsigned long long state = seed;
    for (int i = 0; i < n; i++) {
        y[i] = 0.5 * random_number(&state);
        y[n + i] = 2.0 * random_number(&state);
        // the stiff hub spring would drown everything else
        y[i] = i == 1 && arm.first_link == 1 ? y[0] + 1e-5 * y[i] : y[i];
    }
    balance b;
    contact_mode mode = {true, y[n] > 0.0 ? 1 : -1};
    if (!balance_find(&arm, y, mode, &b)) {
        return NEVER;
    }
    double fastest = 1.0, largest = 1.0, gradient[BODIES_MAX], bias;
    for (int i = 0; i < n; i++) {
        fastest = fmax(fastest, fabs(b.acceleration[i]));
    }
    const double h = 1e-3 / sqrt(fastest);
    double g = body_penetration(&arm, y, y + n, gradient, &bias);
    for (int i = 0; i < n; i++) {
        // d/dt dL/dw_i - dL/dq_i - Q_i, differences of fourth order
        double rate = (8.0 * (momentum_along(&arm, y, b.acceleration, h, i) -
                              momentum_along(&arm, y, b.acceleration, -h, i)) -
                       momentum_along(&arm, y, b.acceleration, 2.0 * h, i) +
                       momentum_along(&arm, y, b.acceleration, -2.0 * h, i)) /
                      (12.0 * h);
        double slope[2], step_sizes[2] = {h, 2.0 * h}, across[2];
        for (int k = 0; k < 2; k++) {
            double up[BODIES_MAX], down[BODIES_MAX];
            memcpy(up, y, (size_t)n * sizeof(double));
            memcpy(down, y, (size_t)n * sizeof(double));
            up[i] += step_sizes[k];
            down[i] -= step_sizes[k];
            slope[k] = (lagrangian(&arm, up, y + n) - lagrangian(&arm, down, y + n)) /
                       (2.0 * step_sizes[k]);
            across[k] = (penetration_by_position(&arm, up) - penetration_by_position(&arm, down)) /
                        (2.0 * step_sizes[k]);
        }
        double applied = -(4.0 * across[0] - across[1]) / 3.0 * b.force;
        if (i == 0) {
            applied += arm.motor_torque - arm.motor_drag * y[n] - mode.sliding * arm.coulomb;
        }
        double defect = rate - (4.0 * slope[0] - slope[1]) / 3.0 - applied;
        worst = fmax(worst, fabs(defect));
        largest = fmax(largest, fabs(rate));
    }
    worst /= largest;
    // the gap itself, and that it does not accelerate in contact
    worst = fmax(worst, fabs(g - penetration_by_position(&arm, y)));
    double bend = 0.0;
    const double weights[5] = {-1.0, 16.0, -30.0, 16.0, -1.0};
    for (int k = 0; k < 5; k++) {
        bend += weights[k] * penetration_along(&arm, y, b.acceleration, (k - 2) * h);
    }
    return fmax(worst, fabs(bend) / (12.0 * h * h) / fastest);
}

void reference_print(const reference_case *c, const reference_answer *a)
{
    printf("%s\n", c->name);
    const struct {
        const char *label;
        double value;
    } lines[] = {
        {"first_contact_s", a->first_contact},
        {"first_approach_m_s", a->first_approach},
        {"contact_impulse_Ns", a->first_impulse},
        {"first_pulse_peak_N", a->first_pulse_peak},
        {"first_pulse_time_to_peak_s", a->first_pulse_delay},
        {"first_pulse_s", a->first_pulse},
        {"peak_force_N", a->peak},
        {"time_to_peak_s", a->peak_delay},
        {"steady_force_N", a->steady_force},
        {"impacts", a->impacts},
        {"touches", a->touches},
        {"separations", a->separations},
        {"smallest_separation_m", a->smallest_separation},
        {"largest_touch_m", a->largest_touch},
        {"slowest_approach_m_s", a->slowest_approach},
        {"last_impact_s", a->last_impact},
        {"weakest_hold_N", a->weakest_hold},
        {"final_hub_angle_rad", a->final_hub_angle},
        {"motor_work_J", a->motor_work},
        {"viscous_loss_J", a->viscous_loss},
        {"friction_loss_J", a->friction_loss},
        {"impact_loss_J", a->impact_loss},
        {"energy_residual_J", a->energy_residual},
        {"largest_gap_error_m", a->largest_gap_error},
    };
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        printf("    %-28s %.15g\n", lines[i].label, lines[i].value);
    }
}
