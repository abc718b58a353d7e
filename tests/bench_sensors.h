// What the sensors of a bench read, each 0.2 % too much: an encoder of 8000 counts, a
// tachometer of 2 V s/rad with its ripple, and a resistor 30 kohm (f/1 N)^-0.75 with 40
// kohm at 10 V, the last two by an A/D converter of 12 bits over 10 V either way.
#pragma once

#include <math.h>

#include "src/base/random.h"
#include "tests/bench_arm.h"

typedef struct bench_reading {
    double angle, velocity, force; // [rad], [rad/s], [N]
} bench_reading;

// Volts as the converter gives them, with noise.
static inline double bench_converted(random_generator *random, double volts, double noise)
{
    const double step = 20.0 / 4096;
    return step * round((volts + noise * random_about_normal(random)) / step);
}

static inline bench_reading bench_read(const bench_sample *s, random_generator *random)
{
    const double gain = 1.002, count = 2 * 3.14159265358979323846 / 8000;
    const double ripple = 1 + 0.01 * sin(79 * s->angle);
    bench_reading read = {.angle = count * round(s->angle / count)};
    read.velocity = bench_converted(random, 2 * gain * ripple * s->velocity, 0.01) / 2;

    // the resistor's divider, and back
    const double felt = gain * s->force;
    const double volts = felt > 0 ? 10 * 40 / (40 + 30 * pow(felt, -0.75)) : 0;
    const double shown = bench_converted(random, volts, 0.02);
    if (shown > 0) {
        read.force = pow(30 * shown / (40 * (10 - shown)), 4.0 / 3);
    }
    return read;
}
