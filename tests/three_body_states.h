// States of the thesis's arm at the wall, for tests of its predictors.
#pragma once

#include "src/predict/predict.h"
#include "tests/given_parameters.h"

// A number from -1 to 1.
static inline double noise(unsigned *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / (double)(1u << 23) - 1;
}

// The corrected arm with a hub of this kind.
static inline parameters corrected_with(hub_joint_kind joint)
{
    parameters p = fresh(ARM_CORRECTED);
    DONE(parameter_set_number(&p, PARAMETER_INDEX(arm.hub_joint), joint, &f));
    DONE(parameters_resolve(&p, &f));
    return p;
}

// A state close to the wall at 0.1 rad: little bend, hub and links about equally fast.
static inline three_body_state state_at_wall(const parameters *p, unsigned *seed)
{
    three_body_state s;
    double speed = 1 + 0.7 * noise(seed), bend = 0.03 * noise(seed);
    s.angle[1] = p->wall.angle - bend / 2;
    s.angle[2] = p->wall.angle + bend / 2;
    s.angle[0] = s.angle[1] + 0.005 * noise(seed);
    for (int i = 0; i < 3; i++) {
        s.velocity[i] = speed * (1 + 0.1 * noise(seed));
    }
    if (p->arm.model == ARM_CORRECTED && p->arm.hub_joint == HUB_RIGID) {
        s.angle[0] = s.angle[1];
        s.velocity[0] = s.velocity[1];
    }
    return s;
}

// Of the hub and both links [J].
static inline double kinetic_energy(const parameters *p, const double q[3],
                                    const double w[3])
{
    double l = p->arm.length / 2, e = l / 2, m = p->arm.mass / 2,
           in = p->arm.link_inertia;
    double x = -l * sin(q[1]) * w[1] - e * sin(q[2]) * w[2];
    double y = l * cos(q[1]) * w[1] + e * cos(q[2]) * w[2];
    return 0.5 * (p->arm.hub_inertia * w[0] * w[0] + (in + m * e * e) * w[1] * w[1] +
                  in * w[2] * w[2] + m * (x * x + y * y));
}
