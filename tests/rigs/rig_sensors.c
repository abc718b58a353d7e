// Readings of the sensors, computed again from the motion.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/rigs/random_rigs.h"

// Without bits there are no steps, but the range limits the value too.
double converted(double value, double bits, double range)
{
    if (bits == 0) {
        return fmax(-range, fmin(range, value));
    }
    const double step = 2 * range / exp2(bits);
    return fmax(-range, fmin(range - step, round(value / step) * step));
}

// Whether a command takes effect or an event happens at the very instant of a sample, so
// that its readings may be those just before it or just after it. Commands of the last
// seven samples may still be on their way.
static bool is_on_jump(const motion *m, int k)
{
    const double t = m->samples[k].time;
    for (int j = k - 1; j >= 0 && j > k - 8; j--) {
        if (fabs(m->samples[j].applied - t) < INSTANT) {
            return true;
        }
    }
    for (size_t i = 0; i < impactlab_run_event_count(m->run); i++) {
        impactlab_event e;
        impactlab_run_event(m->run, i, &e);
        if (fabs(e.time - t) < INSTANT) {
            return true;
        }
    }
    return false;
}

// What comes between a sensor's element and its reading.
typedef struct channel {
    double gain_error, offset; // errors of the element
    double range;              // of the element; 0 stands for none
    double volts;              // at the converter per unit of the reading
    double bits, adc_range;    // of the converter
    bool ideal;                // nothing comes between
} channel;

// What a sensor reads of a value: with errors, within its range, converted to steps.
static double shown(const channel *c, double value)
{
    if (c->ideal) {
        return value;
    }
    value = (1 + c->gain_error) * value + c->offset;
    if (c->range > 0) {
        value = fmax(-c->range, fmin(c->range, value));
    }
    return converted(c->volts * value, c->bits, c->adc_range) / c->volts;
}

// The channel of a sensor at the instant t of the run; `volts` is the path of its volts
// per unit.
static channel channel_of(const rig *r, const char *sensor, const char *volts,
                          bool has_range, double t)
{
    char path[64];
    channel c = {.volts = number(r, volts),
                 .bits = number(r, "sensor.adc_bits"),
                 .adc_range = number(r, "sensor.adc_range"),
                 .ideal = is(r, "sensor.ideal", "true")};
    if (has_range) {
        snprintf(path, sizeof path, "sensor.%s_range", sensor);
        c.range = number(r, path);
    }
    if (strcmp(sensor, "piezo") == 0) {
        c.gain_error = number_at(r, "sensor.piezo_gain_error", t);
        c.offset = number_at(r, "sensor.piezo_offset", t);
    }
    return c;
}

double expected_fsr_volts(const rig *r, double x)
{
    const double R =
        number(r, "sensor.fsr_resistance") * pow(x, -number(r, "sensor.fsr_exponent"));
    const double divider = number(r, "sensor.fsr_divider");
    return number(r, "sensor.fsr_supply") * number(r, "sensor.fsr_gain") * divider /
           (divider + R);
}

// What the force sensor (FSR) reads of a force: the force makes a resistance by a power
// law, the circuit a voltage of it and the converter steps; the same formulas take these
// back to a force.
static double fsr_shown(const rig *r, double x, double t)
{
    if (is(r, "sensor.ideal", "true")) {
        return x;
    }

    // errors of the element; it gives nothing without a force and no more when saturated
    const double saturation = number(r, "sensor.fsr_saturation");
    x = (1 + number_at(r, "sensor.fsr_gain_error", t)) * x +
        number_at(r, "sensor.fsr_offset", t);
    x = fmin(x, saturation);
    if (!(x > 0)) {
        return 0;
    }

    // the converter's voltage
    const double R1 = number(r, "sensor.fsr_resistance"),
                 p = number(r, "sensor.fsr_exponent");
    const double divider = number(r, "sensor.fsr_divider");
    const double full = number(r, "sensor.fsr_supply") * number(r, "sensor.fsr_gain");
    const double volts = converted(expected_fsr_volts(r, x), number(r, "sensor.adc_bits"),
                                   number(r, "sensor.adc_range"));

    // and back
    if (volts <= 0) {
        return 0;
    }
    if (volts >= full) {
        return saturation;
    }
    return fmin(saturation, pow(divider * (full / volts - 1) / R1, -1 / p));
}

// Reading number c of a sample lies within these bounds, but for rounding.
static void expect_reading(rig *r, const char *what, const sample *s, int c, double low,
                           double high)
{
    const double slack = ROUNDING * fmax(fabs(low), fabs(high)) + 1e-12;
    expect(r, what, s->time, s->reading[c], low - slack, high + slack);
}

void check_angles(rig *r, const motion *m)
{
    pieces angle = pieces_of(m, m->of[HUB_ANGLE]),
           rate = pieces_of(m, m->of[HUB_VELOCITY]);
    const bool ideal = is(r, "sensor.ideal", "true");
    const double counts = number(r, "sensor.encoder_counts");
    const double ripples = number(r, "sensor.tachometer_ripple_count");
    const channel c = channel_of(r, "tachometer", "sensor.tachometer_gain", false, 0);
    size_t i = 0;
    for (int k = 0; k < m->sample_count; k++) {
        const sample *s = &m->samples[k];
        while (i + 1 < angle.count && angle.of[i].to < s->time - 1e-13) {
            i++;
        }

        // angle and velocity of the hub, and by how much they may be wrong
        const double q = value_within(&angle.of[i], s->time);
        const double w = value_within(&rate.of[i], s->time);
        const double q_error = angle.of[i].error + 1e-13;
        double w_error = rate.of[i].error + 1e-13;
        double w_low = w - w_error, w_high = w + w_error;
        if (is_on_jump(m, k) && i + 1 < rate.count) {
            w_low = fmin(w_low, rate.of[i + 1].begin);
            w_high = fmax(w_high, rate.of[i + 1].begin);
        }

        // the encoder shows whole counts
        const double gain = 1 + number_at(r, "sensor.encoder_gain_error", s->time);
        const double offset = number_at(r, "sensor.encoder_offset", s->time);
        double low = q - q_error, high = q + q_error;
        if (!ideal) {
            low = gain * low + offset;
            high = gain * high + offset;
            if (counts > 0) {
                const double count = 2 * M_PI / counts;
                low = round(low / count - 1e-9) * count;
                high = round(high / count + 1e-9) * count;
            }
        }
        expect_reading(r, "encoder", s, 0, low, high);

        // the tachometer has a ripple over the angle, whose slope makes an error of the
        // angle one of the velocity
        const double tacho_gain =
            1 + number_at(r, "sensor.tachometer_gain_error", s->time);
        const double tacho_offset = number_at(r, "sensor.tachometer_offset", s->time);
        const double ripple = number_at(r, "sensor.tachometer_ripple", s->time);
        low = w_low;
        high = w_high;
        if (!ideal) {
            const double wave = 1 + ripple * sin(ripples * q);
            const double slack = fabs(w) * ripple * ripples * q_error + 1e-11;
            low = shown(&c, tacho_gain * low * wave + tacho_offset - slack);
            high = shown(&c, tacho_gain * high * wave + tacho_offset + slack);
        }
        expect_reading(r, "tachometer", s, 1, low, high);
    }
    free(angle.of);
    free(rate.of);
}

// Bounds of what a sensor with a lag gives to its converter at a sample.
static void bounds_at(const motion *m, int k, follower *f, double *low, double *high)
{
    follower_reach(f, m->samples[k].time);
    const double value = f->state.y - f->state.w;
    const double error = f->state.y_error + f->state.w_error + f->rounding + 1e-13;
    *low = value - error;
    *high = value + error;

    // where something happens at this instant: just after it, too
    if (is_on_jump(m, k)) {
        lag after = f->state;
        if (f->blow < f->blows->count &&
            fabs(f->blows->of[f->blow].time - m->samples[k].time) < INSTANT) {
            lag_take_blow(&after, f->blows->of[f->blow].size);
        }
        if (after.T == 0 && f->piece < f->of->count) {
            after.y = f->of->of[f->piece].begin;
        }
        *low = fmin(*low, after.y - after.w - error);
        *high = fmax(*high, after.y - after.w + error);
    }
}

// The kind under which a reading of the force is counted.
static const char *force_kind(bool ideal, double hysteresis, double delay)
{
    if (ideal) {
        return "force_reading, ideal";
    }
    if (hysteresis > 0 && delay == 0) {
        return "force_reading with hysteresis alone";
    }
    return hysteresis > 0 ? "force_reading with hysteresis" : "force_reading";
}

// Goes on to each change of the force sensor's rise time until the instant t, and makes
// it.
static void follow_rise_time(const rig *r, follower *f, double t)
{
    const struct change *end = r->changes + r->change_count;
    for (const struct change *c = r->changes; c < end; c++) {
        const bool due = c->at > f->now && c->at <= t;
        if (due && strcmp(c->path, "sensor.fsr_rise_time") == 0) {
            follower_reach(f, c->at);
            f->state.T = c->value / log(RISE_RATIO);
        }
    }
}

// The force sensor: a lag, a hysteresis of the width `share` behind it, and the circuit.
void check_fsr(rig *r, const motion *m, const pieces *force, const blow_list *impulses)
{
    const bool ideal = is(r, "sensor.ideal", "true");
    const double share = ideal ? 0 : number(r, "sensor.fsr_hysteresis");
    follower f =
        follower_of(force, impulses, ideal ? 0 : number(r, "sensor.fsr_rise_time"), 0);
    f.share = share;
    for (int k = 0; k < m->sample_count; k++) {
        double low, high;
        if (!ideal) {
            follow_rise_time(r, &f, m->samples[k].time);
        }
        bounds_at(m, k, &f, &low, &high);

        // what the hysteresis holds, which this value may take along
        if (share > 0) {
            const double up =
                fmax((1 - share) * high, fmin(f.play_high, (1 + share) * high));
            const double down =
                fmax((1 - share) * low, fmin(f.play_low, (1 + share) * low));
            low = fmin(down, up);
            high = fmax(down, up);
        }
        expect_reading(r, force_kind(ideal, share, f.state.T), &m->samples[k], 2,
                       fsr_shown(r, low, m->samples[k].time),
                       fsr_shown(r, high, m->samples[k].time));
    }
}

// The sensors that a rig need not have: of the force (piezo), of the arm's bending (film)
// and of the hub's acceleration.
void check_optional(rig *r, const motion *m, const pieces *force,
                    const blow_list *impulses)
{
    const bool ideal = is(r, "sensor.ideal", "true"), law = m->sample_count > 0;
    const bool piezo = is(r, "sensor.piezo", "true") || is(r, "sensor.force", "piezo");

    // the three quantities that they sense
    double *bending = malloc(m->count * sizeof(double));
    for (size_t i = 0; i < m->count; i++) {
        bending[i] = m->of[LAST_ANGLE][i] - m->of[FIRST_ANGLE][i];
    }
    pieces bend = pieces_of(m, bending);
    pieces acceleration = pieces_of(m, m->of[HUB_ACCELERATION]);
    blow_list none = {0}, jerks = jumps_of(m, m->of[HUB_VELOCITY]);
    const channel film_channel = channel_of(r, "film", "sensor.film_gain", false, 0);
    const channel hub_channel =
        channel_of(r, "accelerometer", "sensor.accelerometer_gain", true, 0);

    // their filters
    follower p =
        follower_of(force, impulses, ideal ? 0 : number(r, "sensor.piezo_rise_time"),
                    ideal ? 0 : number(r, "sensor.piezo_leak_time"));
    follower b =
        follower_of(&bend, &none, 0, ideal ? 0 : number(r, "sensor.film_leak_time"));
    follower a = follower_of(&acceleration, &jerks,
                             ideal ? 0 : number(r, "sensor.accelerometer_rise_time"), 0);
    for (int k = 0; law && k < m->sample_count; k++) {
        double low, high;
        const sample *s = &m->samples[k];
        if (piezo) {
            const channel piezo_channel =
                channel_of(r, "piezo", "sensor.piezo_gain", true, s->time);
            bounds_at(m, k, &p, &low, &high);
            expect_reading(r, "piezo_force", s, 3, shown(&piezo_channel, low),
                           shown(&piezo_channel, high));
        }
        if (is(r, "sensor.film", "true")) {
            bounds_at(m, k, &b, &low, &high);
            expect_reading(r, "film", s, 4, shown(&film_channel, low),
                           shown(&film_channel, high));
        }

        // the command of the first sample may act at once, before the first row
        if (is(r, "sensor.accelerometer", "true") && (k > 0 || a.state.T > 0)) {
            bounds_at(m, k, &a, &low, &high);
            expect_reading(r, "accelerometer", s, 5, shown(&hub_channel, low),
                           shown(&hub_channel, high));
        }
    }
    free(bending);
    free(bend.of);
    free(acceleration.of);
    free(jerks.of);
}
