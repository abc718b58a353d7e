#include "src/arm/wall_motion.h"

#include <assert.h>
#include <math.h>

#include "src/base/sincos.h"

#define SAME_INSTANT 1e-13 // [s]

wall_motion wall_motion_of(const wall_parameters *p)
{
    return (wall_motion){.kind = p->kind == WALL_NONE ? MOTION_NONE : (wall_motion_kind)p->motion,
                         .amplitude = p->motion_amplitude,
                         .frequency = p->motion_frequency,
                         .time = p->motion_time};
}

wall_shift wall_motion_at(const wall_motion *m, double time)
{
    assert(m != NULL);
    const double since = time - m->time;
    switch (m->kind) {
    case MOTION_SINE: {
        double s, c;
        const double rate = 2 * M_PI * m->frequency;
        inline_sincos(rate * since, &s, &c);
        return (wall_shift){m->amplitude * s, m->amplitude * rate * c,
                            -m->amplitude * rate * rate * s};
    }
    case MOTION_STEP: {
        const double rate = 2 * m->frequency, x = fmax(0, fmin(rate * since, 1)), y = 1 - x;
        return (wall_shift){m->amplitude * x * x * x * (10 - 15 * x + 6 * x * x),
                            m->amplitude * rate * 30 * x * x * y * y,
                            m->amplitude * rate * rate * 60 * x * y * (y - x)};
    }
    case MOTION_NONE:
        break;
    }
    return (wall_shift){0};
}

double wall_motion_rate(const wall_motion *m, double time)
{
    assert(m != NULL);
    const double rate = 2 * M_PI * m->frequency, passed = 2 * m->frequency * (time - m->time);
    const bool rises = m->kind == MOTION_STEP && passed > -SAME_INSTANT && passed < 1;
    return m->kind == MOTION_SINE || rises ? rate : 0;
}

double wall_motion_lasts(const wall_motion *m, double time)
{
    assert(m != NULL);
    const double since = time - m->time;
    if (m->kind != MOTION_STEP) {
        return HUGE_VAL;
    }
    const double rises = 1 / (2 * m->frequency);
    return since < -SAME_INSTANT ? -since : since < rises - SAME_INSTANT ? rises - since : HUGE_VAL;
}
