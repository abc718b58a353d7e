#include "src/rig/sensors.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/extremes.h"
#include "src/base/instant.h"
#include "src/base/sincos.h"
#include "src/base/plain_math.h"

// 10 % to 90 % of a first-order lag takes ln 9 time constants.
#define RISE_OVER_TIME_CONSTANT 2.1972245773362196

// Looks of a slow sensor this share of its period early are on time: rounding.
#define SAME_LOOK 1e-6

// In a stride no longer than this [s] the gain of velocity would be rounding only, and
// the accelerometer is not moved.
#define SHORTEST_GAIN 1e-9

// Draws numbers of the standard normal distribution by Marsaglia's polar method: for a
// point (x, y) within the unit circle, r = x^2 + y^2, both x and y times sqrt(-2
// log(r)/r) are such numbers. Many are drawn at a time, so that logarithms and roots need
// not wait for each other. Not inlined, which keeps the readings short.
static __attribute__((noinline)) void draw_ahead(noise_source *n)
{
    enum { PAIRS = NOISE_AHEAD / 2 };
    double x[PAIRS], y[PAIRS], r[PAIRS];

    // points within the unit circle; one outside is overwritten by the next
    for (int i = 0; i < PAIRS;) {
        x[i] = 2 * random_uniform(&n->random) - 1;
        y[i] = 2 * random_uniform(&n->random) - 1;
        r[i] = x[i] * x[i] + y[i] * y[i];
        if (r[i] > 0 && r[i] < 1) {
            i++;
        }
    }

    for (int i = 0; i < PAIRS; i++) {
        const double factor = sqrt(-2 * plain_log(r[i]) / r[i]);
        n->normal[2 * i] = x[i] * factor;
        n->normal[2 * i + 1] = y[i] * factor;
    }
    n->taken = 0;
}

// Starts a sensor's own sequence of numbers: its seed is the sensor's number in the upper
// bits and the scenario's seed in the lower ones.
static void noise_start(noise_source *n, uint64_t sensor, int seed)
{
    random_seed(&n->random, sensor << 32 | (uint32_t)seed);
    n->taken = NOISE_AHEAD;
}

// A number of the standard normal distribution.
static double random_normal(noise_source *n)
{
    if (n->taken == NOISE_AHEAD) {
        draw_ahead(n);
    }
    return n->normal[n->taken++];
}

converter converter_of(int bits, double range)
{
    assert(bits >= 0 && bits < 63 && range >= 0);
    const double codes = (double)(INT64_C(1) << bits);
    if (bits == 0) {
        return (converter){.range = range};
    }
    return (converter){range, 2 * range / codes, codes, codes / (2 * range)};
}

// --- in time ---------------------------------------------------------------------------

// Removes all errors of the sensors, as sensor.ideal asks for.
static void idealise(sensor_parameters *p)
{
    p->encoder_counts = p->adc_bits = p->dac_bits = 0;
    p->tachometer_ripple = p->tachometer_noise = p->fsr_noise = 0;
    p->fsr_rise_time = 0;
    p->piezo_rise_time = p->piezo_leak_time = p->piezo_range = p->piezo_noise = 0;
    p->film_leak_time = p->film_noise = 0;
    p->accelerometer_rise_time = p->accelerometer_range = p->accelerometer_noise = 0;
    p->tip_deflection_noise = p->tip_deflection_rate = 0;
    p->root_strain_noise = p->root_strain_rate = 0;
    p->encoder_gain_error = p->tachometer_gain_error = p->fsr_gain_error =
        p->piezo_gain_error = 0;
    p->encoder_offset = p->tachometer_offset = p->fsr_offset = p->piezo_offset = 0;
    p->fsr_hysteresis = 0;
    p->fsr_saturation = HUGE_VAL;
}

// Gives a lag a time constant [s], and forgets the exponential of the one before.
static void set_lag(first_order_lag *y, double time_constant)
{
    y->time_constant = time_constant;
    y->interval = 0;
}

void sensors_retune(sensors *s, const sensor_parameters *p)
{
    s->p = *p;
    if (p->ideal) {
        idealise(&s->p);
    }

    // what follows from them
    s->adc = converter_of(s->p.adc_bits, s->p.ideal ? HUGE_VAL : s->p.adc_range);
    if (s->p.encoder_counts > 0) {
        s->encoder_step = 2 * M_PI / s->p.encoder_counts;
    } else {
        s->encoder_step = 0;
    }

    // the remembered points belong to the curve before
    s->felt = (fsr_point){(double)NAN, 0};
    memset(s->read, 0, sizeof s->read);
    s->seen_angle = (double)NAN;
    set_lag(&s->fsr, s->p.fsr_rise_time / RISE_OVER_TIME_CONSTANT);
    set_lag(&s->piezo_rise, s->p.piezo_rise_time / RISE_OVER_TIME_CONSTANT);
    set_lag(&s->piezo_leak, s->p.piezo_leak_time);
    set_lag(&s->film_leak, s->p.film_leak_time);
    set_lag(&s->acceleration, s->p.accelerometer_rise_time / RISE_OVER_TIME_CONSTANT);
}

void sensors_init(sensors *s, const sensor_parameters *p, int seed)
{
    // lags and leaks, all at rest
    *s = (sensors){.seen_velocity = (double)NAN};
    sensors_retune(s, p);

    noise_start(&s->noise, 0, seed);
    noise_start(&s->piezo_noise, 1, seed);
    noise_start(&s->film_noise, 2, seed);
    noise_start(&s->acceleration_noise, 3, seed);
    noise_start(&s->tip_deflection.noise, 4, seed);
    noise_start(&s->root_strain.noise, 5, seed);
}

// Moves the force that the FSR shows, with hysteresis: it follows the force with a play
// of the hysteresis times the force to either side. Returns it [N].
static double fsr_shows(sensors *s, double force)
{
    const double play = s->p.fsr_hysteresis * fabs(force);
    s->fsr_shown = larger(force - play, smaller(s->fsr_shown, force + play));
    return s->fsr_shown;
}

// Lets the FSR follow the force over an interval. The play has to be moved to every force
// at which the lag's output turns.
static void follow_with_fsr(sensors *s, const lag_input *force)
{
    if (s->p.fsr_hysteresis > 0) {
        double turns[LAG_MOST_TURNS];
        const int count = lag_turns(&s->fsr, force, turns);
        fsr_shows(s, lag_output(&s->fsr, force->first));
        for (int i = 0; i < count; i++) {
            fsr_shows(s, turns[i]);
        }
    }
    lag_follow(&s->fsr, force);
    fsr_shows(s, lag_output(&s->fsr, force->last));
}

// Turns a jump of the hub's velocity since the last look into a pulse of its
// acceleration.
static void feel_jump(sensors *s, double velocity)
{
    if (!isnan(s->seen_velocity)) {
        lag_strike(&s->acceleration, velocity - s->seen_velocity);
    }
    s->seen_velocity = velocity;
}

void sensors_follow(sensors *s, double h, const sensed_motion *first,
                    const sensed_motion *last, double mean_force)
{
    const lag_input force = {h, first->force, last->force, mean_force};
    follow_with_fsr(s, &force);
    if (s->p.piezo) {
        lag_follow(&s->piezo_rise, &force);
        lag_follow(&s->piezo_leak, &force);
    }

    // the bending's mean is that of the cubic through both ends' values and rates
    if (s->p.film) {
        double mean = (first->bending + last->bending) / 2 +
                      h * (first->bending_rate - last->bending_rate) / 12;
        lag_follow(&s->film_leak, &(lag_input){h, first->bending, last->bending, mean});
    }

    // A jump of the velocity between strides is a pulse; within a stride the mean
    // acceleration is the gain of velocity over its length
    if (s->p.accelerometer) {
        feel_jump(s, first->velocity);
        if (h > SHORTEST_GAIN) {
            const double mean = (last->velocity - first->velocity) / h;
            lag_follow(&s->acceleration,
                       &(lag_input){h, first->acceleration, last->acceleration, mean});
            s->seen_velocity = last->velocity;
        }
    }
}

bool sensors_at_rest(const sensors *s)
{
    const bool none = !s->p.film && !s->p.accelerometer;
    return none && s->fsr.value == 0 && s->fsr_shown == 0 && s->piezo_rise.value == 0 &&
           s->piezo_leak.value == 0;
}

void sensors_strike(sensors *s, double impulse)
{
    lag_strike(&s->fsr, impulse);
    lag_strike(&s->piezo_rise, impulse);
    lag_strike(&s->piezo_leak, impulse);

    // an impulse takes up the play; without a lag it is an infinite force for an instant
    if (s->p.fsr_hysteresis > 0 && impulse > 0) {
        if (s->fsr.time_constant > 0) {
            s->fsr_shown = fsr_shows(s, s->fsr.value);
        } else {
            s->fsr_shown = HUGE_VAL;
        }
    }
}

// --- readings --------------------------------------------------------------------------

double fsr_volts(const sensor_parameters *p, double force)
{
    if (!(force > 0)) {
        return 0;
    }
    double resistance = p->fsr_resistance *
                        plain_pow(smaller(force, p->fsr_saturation), -p->fsr_exponent);
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
    double force = plain_pow(resistance / p->fsr_resistance, -1 / p->fsr_exponent);
    return smaller(force, p->fsr_saturation);
}

// What a sensor with errors of calibration shows of a value.
static double miscalibrated(double value, double gain_error, double offset)
{
    return (1 + gain_error) * value + offset;
}

// The FSR's voltage for a force, before noise [V]; that of the last force is remembered.
static double felt_volts(sensors *s, double force)
{
    if (force != s->felt.force) {
        const double shown = miscalibrated(force, s->p.fsr_gain_error, s->p.fsr_offset);
        s->felt = (fsr_point){force, fsr_volts(&s->p, shown)};
    }
    return s->felt.volts;
}

// The force that a voltage at the A/D converter is read as [N]. Converted voltages are
// few, so the last ones are remembered.
static double read_force(sensors *s, double volts)
{
    // the place where the force of this converter's code would be remembered
    const uint64_t code = (uint64_t)(int64_t)(volts * s->adc.a_unit + 0.5);
    fsr_point *known = &s->read[code % FSR_POINTS_READ];
    if (volts != known->volts) {
        *known = (fsr_point){fsr_force(&s->p, volts), volts};
    }
    return known->force;
}

// Computes the encoder's count and the tachometer's ripple at an angle of the hub, if
// that has changed. The ripple is a function of the shaft's angle.
static void see_angle(sensors *s, double angle)
{
    const double count = s->encoder_step;
    if (angle == s->seen_angle) {
        return;
    }
    s->seen_angle = angle;
    const double shown =
        miscalibrated(angle, s->p.encoder_gain_error, s->p.encoder_offset);
    if (count == 0) {
        s->counted = shown;
    } else {
        s->counted = count * floor(shown / count + 0.5);
    }
    s->ripple =
        1 + s->p.tachometer_ripple * inline_sin(s->p.tachometer_ripple_count * angle);
}

// A voltage as the A/D converter gives it, with noise of a standard deviation added
// before [V].
static double convert(const sensors *s, noise_source *source, double volts, double noise)
{
    double disturbed = noise > 0 ? volts + noise * random_normal(source) : volts;
    return converter_value(&s->adc, disturbed);
}

// A value limited to a sensor's range of either sign; 0 stands for no limit.
static double on_scale(double value, double range)
{
    if (range > 0) {
        return larger(smaller(value, range), -range);
    }
    return value;
}

// The reading of the piezo sensor [N]. Its rise (time constant r) and leak (q) lie one
// behind the other, 1/(1 + s r) times s q/(1 + s q). That equals the difference of two
// lags side by side, (1/(1 + s r) - 1/(1 + s q)) q/(q - r), each of which follows the
// force exactly.
static double read_piezo(sensors *s, double force)
{
    const sensor_parameters *p = &s->p;
    double rise = s->piezo_rise.time_constant, leak = s->piezo_leak.time_constant;
    double felt = lag_output(&s->piezo_rise, force);
    if (leak > 0) {
        felt = (felt - s->piezo_leak.value) * leak / (leak - rise);
    }
    felt = miscalibrated(felt, p->piezo_gain_error, p->piezo_offset);
    double volts = p->piezo_gain * on_scale(felt, p->piezo_range);
    return convert(s, &s->piezo_noise, volts, p->piezo_noise) / p->piezo_gain;
}

static double read_film(sensors *s, double bending)
{
    const sensor_parameters *p = &s->p;
    double volts = p->film_gain * (bending - s->film_leak.value);
    return convert(s, &s->film_noise, volts, p->film_noise) / p->film_gain;
}

static double read_accelerometer(sensors *s, const sensed_motion *now)
{
    const sensor_parameters *p = &s->p;
    feel_jump(s, now->velocity);
    double felt = lag_output(&s->acceleration, now->acceleration);
    double volts = p->accelerometer_gain * on_scale(felt, p->accelerometer_range);
    return convert(s, &s->acceleration_noise, volts, p->accelerometer_noise) /
           p->accelerometer_gain;
}

// The reading of a sensor of `value` that looks at a rate [Hz], or with 0 always.
static double read_slowly(sensors *s, slow_sensor *of, const sensed_motion *now,
                          double value, double gain, double noise, double rate)
{
    if (instant_after(of->due, now->time)) {
        return of->held;
    }
    of->held = convert(s, &of->noise, gain * value, noise) / gain;
    if (rate > 0) {
        of->due = (floor(now->time * rate + SAME_LOOK) + 1) / rate;
    }
    return of->held;
}

sensor_reading sensors_read(sensors *s, const sensed_motion *now)
{
    const sensor_parameters *p = &s->p;

    // what the sensors that are always fitted show; the slowest computation first
    const double felt = felt_volts(s, fsr_shows(s, lag_output(&s->fsr, now->force)));
    see_angle(s, now->angle);
    const double turning = miscalibrated(now->velocity * s->ripple,
                                         p->tachometer_gain_error, p->tachometer_offset);
    double tachometer =
        convert(s, &s->noise, p->tachometer_gain * turning, p->tachometer_noise);
    double fsr = convert(s, &s->noise, felt, p->fsr_noise);

    sensor_reading reading = {.encoder = s->counted,
                              .tachometer = tachometer / p->tachometer_gain,
                              .force_reading = read_force(s, fsr),
                              .piezo_force = (double)NAN,
                              .film = (double)NAN,
                              .accelerometer = (double)NAN,
                              .tip_deflection = (double)NAN,
                              .root_strain = (double)NAN};

    // sensors that need not be fitted have noise of their own
    if (p->piezo) {
        reading.piezo_force = read_piezo(s, now->force);
    }
    if (p->film) {
        reading.film = read_film(s, now->bending);
    }
    if (p->accelerometer) {
        reading.accelerometer = read_accelerometer(s, now);
    }
    if (p->tip_deflection) {
        reading.tip_deflection =
            read_slowly(s, &s->tip_deflection, now, now->tip_deflection,
                        p->tip_deflection_gain, p->tip_deflection_noise,
                        p->tip_deflection_rate);
    }
    if (p->root_strain) {
        reading.root_strain =
            read_slowly(s, &s->root_strain, now,
                        p->root_strain_distance * now->root_curvature,
                        p->root_strain_gain, p->root_strain_noise, p->root_strain_rate);
    }
    return reading;
}
