#include "src/rig/sensors.h"

#include <math.h>

#include "src/arm/sincos.h"

// 10 % to 90 % of a first-order lag takes ln 9 time constants.
#define RISE_OVER_TIME_CONSTANT 2.1972245773362196

static const double turn = 2 * 3.14159265358979323846; // [rad]

// A number of the standard normal distribution, by Marsaglia's polar method, which makes two.
static double random_normal(sensors *s)
{
    double spare = s->spare;
    s->spare = (double)NAN;
    while (isnan(spare)) {
        double x = 2 * random_uniform(&s->random) - 1, y = 2 * random_uniform(&s->random) - 1;
        double r = x * x + y * y;
        if (r > 0 && r < 1) {
            double factor = sqrt(-2 * log(r) / r);
            s->spare = y * factor;
            return x * factor;
        }
    }
    return spare;
}

double converter_value(double value, int bits, double range)
{
    double within = value < -range ? -range : value < range ? value : range;
    if (bits == 0) {
        return within;
    }
    // whole steps from the lower end of the range: a conversion that rounds positive numbers
    int64_t codes = INT64_C(1) << bits;
    double step = 2 * range / (double)codes;
    int64_t code = (int64_t)((within + range) / step + 0.5);
    return step * (double)((code < codes ? code : codes - 1) - codes / 2);
}

void sensors_init(sensors *s, const sensor_parameters *p, int seed)
{
    s->p = *p;
    if (p->ideal) {
        s->p.encoder_counts = s->p.adc_bits = s->p.dac_bits = 0;
        s->p.tachometer_ripple = s->p.tachometer_noise = s->p.fsr_noise = 0;
        s->p.fsr_rise_time = 0;
    }
    s->felt_force = 0;
    s->spare = (double)NAN;
    s->fsr_time_constant = s->p.fsr_rise_time / RISE_OVER_TIME_CONSTANT;
    random_seed(&s->random, (uint64_t)seed);
}

void sensors_follow(sensors *s, double h, double first, double last, double mean)
{
    double lag = s->fsr_time_constant;
    if (lag == 0 || h <= 0) {
        return;
    }
    // y' = (f - y)/lag with f = first + slope u + curve u^2, u = t/h: the particular solution
    // f - lag f' + lag^2 f'' and a transient that dies
    if (h < 1e-6 * lag) {
        s->felt_force += h / lag * (mean - s->felt_force); // the transient's difference is rounding
        return;
    }
    double curve = 3 * (first + last) - 6 * mean, slope = last - first - curve, r = lag / h;
    double at_start = first - r * slope + 2 * r * r * curve;
    double at_end = last - r * (slope + 2 * curve) + 2 * r * r * curve;
    s->felt_force = at_end + (s->felt_force - at_start) * exp(-h / lag);
}

void sensors_strike(sensors *s, double impulse)
{
    if (s->fsr_time_constant > 0) {
        s->felt_force += impulse / s->fsr_time_constant;
    }
}

double fsr_volts(const sensor_parameters *p, double force)
{
    if (!(force > 0)) {
        return 0;
    }
    double resistance = p->fsr_resistance * pow(fmin(force, p->fsr_saturation), -p->fsr_exponent);
    return p->fsr_gain * p->fsr_supply * p->fsr_divider / (p->fsr_divider + resistance);
}

double fsr_force(const sensor_parameters *p, double volts)
{
    double share = volts / (p->fsr_gain * p->fsr_supply);
    if (!(share > 0)) {
        return 0;
    }
    if (share >= 1) {
        return p->fsr_saturation;
    }
    double resistance = p->fsr_divider * (1 - share) / share;
    double force = pow(resistance / p->fsr_resistance, -1 / p->fsr_exponent);
    return fmin(force, p->fsr_saturation);
}

static double read_encoder(const sensors *s, double angle)
{
    if (s->p.encoder_counts == 0) {
        return angle;
    }
    double count = turn / s->p.encoder_counts;
    return count * floor(angle / count + 0.5);
}

// Through the A/D converter, noise added before it.
static double convert(sensors *s, double volts, double noise)
{
    double disturbed = noise > 0 ? volts + noise * random_normal(s) : volts;
    return s->p.ideal ? disturbed : converter_value(disturbed, s->p.adc_bits, s->p.adc_range);
}

sensor_reading sensors_read(sensors *s, double angle, double velocity, double force)
{
    const sensor_parameters *p = &s->p;
    double felt = s->fsr_time_constant > 0 ? s->felt_force : force;
    double wave, unused;
    inline_sincos(p->tachometer_ripple_count * angle, &wave, &unused);
    double ripple = 1 + p->tachometer_ripple * wave;
    double tachometer = convert(s, p->tachometer_gain * velocity * ripple, p->tachometer_noise);
    double fsr = convert(s, fsr_volts(p, felt), p->fsr_noise);
    return (sensor_reading){.angle = read_encoder(s, angle),
                            .velocity = tachometer / p->tachometer_gain,
                            .force = fsr_force(p, fsr)};
}
