#include "src/rig/estimation/hub_sensors.h"

#include <math.h>

// Standard deviations, and the times over which they are learned.
#define COUNT_SHARE 0.29  // of the encoder: a count over the square root of 12
#define RATE_NOISE  0.014 // of the tachometer, at least [rad/s]
#define NOISE_MEAN  0.2   // over which its noise is averaged [s],
#define MOST_NOISE  9.0   // and the most that a reading counts, in that noise squared
#define RATE_RIPPLE 0.01  // of the tachometer, as a share of the reading
#define OFFSET_TIME 0.1   // for which the tachometer counts as one without an offset [s]
#define MOVES       0.05  // a slower hub does not show which arm it is on [rad/s]

void hub_sensors_start(hub_sensors *s, const controller_input *in)
{
    const double rate = in->tachometer;
    *s = (hub_sensors){.count = HUGE_VAL,
                       .angle = in->encoder,
                       .turned = in->encoder,
                       .rates = {rate, rate, rate},
                       .noise = RATE_NOISE * RATE_NOISE};
}

// Averages the variance of the tachometer's noise. A third difference of readings, r0 - 3
// r1 + 3 r2 - r3, hardly shows the motion; independent noise gives it 1 + 9 + 9 + 1 = 20
// times the variance of one reading. The ripple is no part of the noise.
static void follow_noise(hub_sensors *s, double rate, double period)
{
    const double *before = s->rates, ripple = RATE_RIPPLE * rate;
    const double third_difference = rate - 3 * (before[0] - before[1]) - before[2];
    const double share = fmin(1, period / NOISE_MEAN);
    const double variance =
        fmin(fmax(0, third_difference * third_difference / 20 - ripple * ripple),
             MOST_NOISE * s->noise);
    s->noise = fmax(s->noise + share * (variance - s->noise), RATE_NOISE * RATE_NOISE);
}

controller_input hub_sensors_read(hub_sensors *s, const controller_input *in,
                                  double period)
{
    controller_input read = *in;
    s->moves = fabs(in->tachometer) > MOVES;

    // the angle by the tachometer (trapezoidal rule), and the noise of its readings
    s->turned += (s->rates[0] + in->tachometer) / 2 * period;
    s->observed += period;
    follow_noise(s, in->tachometer, period);
    s->rates[2] = s->rates[1];
    s->rates[1] = s->rates[0];
    s->rates[0] = in->tachometer;

    // the tachometer's offset: by how much its angle has run ahead of the encoder's, over
    // the time
    read.tachometer -= (s->turned - in->encoder) / (s->observed + OFFSET_TIME);
    const double ripple = RATE_RIPPLE * read.tachometer;
    s->rate_variance = s->noise + ripple * ripple;

    // the encoder's count is the smallest step seen; its error is uniform within a count
    const double step = fabs(in->encoder - s->angle);
    if (step > 0) {
        s->count = fmin(step, s->count);
    }
    s->angle = in->encoder;
    if (isfinite(s->count)) {
        s->angle_deviation = fmax(HUB_ANGLE_NOISE, COUNT_SHARE * s->count);
    } else {
        s->angle_deviation = HUB_ANGLE_NOISE;
    }
    return read;
}
