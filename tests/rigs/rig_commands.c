// Commands of the samples and what rows say of them and of readings.
#include <math.h>

#include "tests/rigs/random_rigs.h"

// The row of an instant's first one, or the first one after it.
static size_t row_at(const motion *m, double t)
{
    size_t low = 0, high = m->count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (m->of[TIME][middle] < t) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

void follow_commands(const rig *r, motion *m)
{
    const double most = number(r, "motor.current_limit");
    const double limit = is(r, "motor.drive", "current") && most > 0
                             ? fmin(number(r, "motor.voltage_limit"),
                                    most / number(r, "motor.transconductance"))
                             : number(r, "motor.voltage_limit");
    const double bits = is(r, "sensor.ideal", "true") ? 0 : number(r, "sensor.dac_bits");
    const double delay = number(r, "control.delay") +
                         number(r, "control.delay_periods") / number(r, "control.rate");
    for (int k = 0; k < m->sample_count; k++) {
        sample *s = &m->samples[k];
        const size_t row = row_at(m, s->time + INSTANT);
        s->command = row < m->count ? m->of[COMMAND][row] : (double)NAN;
        s->voltage = converted(fmax(-limit, fmin(limit, s->command)), bits, limit);
    }

    // after the delay, or with the sample so many later if that comes first
    const double periods = delay * number(r, "control.rate");
    const int later = (int)ceil(periods - 1e-9);
    for (int k = 0; k < m->sample_count; k++) {
        sample *s = &m->samples[k];
        s->applied = s->time + delay;
        if (later > 0 && k + later < m->sample_count) {
            s->applied = fmin(s->applied, m->samples[k + later].time);
        }
    }
}

void check_rows(rig *r, motion *m)
{
    int k = -1, applied = -1; // the last sample, the last one whose command acts
    for (size_t i = 0; i < m->count; i++) {
        const double t = m->of[TIME][i];

        // time goes on
        if (i > 0) {
            expect(r, "order of rows", t, t - m->of[TIME][i - 1], 0, (double)INFINITY);
        }
        if (m->sample_count == 0) {
            continue;
        }

        // what was read last
        while (k + 1 < m->sample_count && m->samples[k + 1].time <= t - INSTANT) {
            k++;
        }
        const bool on_sample =
            k + 1 < m->sample_count && fabs(m->samples[k + 1].time - t) < INSTANT;
        const bool last_there = i + 1 == m->count || m->of[TIME][i + 1] > t + INSTANT;
        const int held = on_sample && last_there ? k + 1 : k;
        if (held >= 0 && !(on_sample && !last_there)) {
            for (int c = 0; c < 6; c++) {
                const double wanted = m->samples[held].reading[c];
                expect_near(r,
                            on_sample ? "row on a sampling instant"
                                      : "row between two samples",
                            t, m->of[ENCODER + c][i], wanted, 1e-12 * (1 + fabs(wanted)));
            }
        }

        // what acts on the motor
        while (applied + 1 < m->sample_count &&
               m->samples[applied + 1].applied <= t - INSTANT) {
            applied++;
        }
        const double before = applied >= 0 ? m->samples[applied].voltage : 0;
        const bool on_change = applied + 1 < m->sample_count &&
                               fabs(m->samples[applied + 1].applied - t) < INSTANT;
        const double after = on_change ? m->samples[applied + 1].voltage : before;
        if (!isnan(before) && !isnan(after)) {
            const double v = m->of[VOLTAGE][i];
            const double error = fmin(fabs(v - before), fabs(v - after));
            expect_near(r, "voltage", t, v, v - error, 1e-9);
        }
    }
}

void check_instants(rig *r, const motion *m)
{
    const double period = 1 / number(r, "control.rate"),
                 width = number(r, "control.jitter");
    double first = (double)INFINITY, last = -(double)INFINITY;
    for (int k = 0; k < m->sample_count; k++) {
        const double late = m->samples[k].time - k * period;
        first = fmin(first, late);
        last = fmax(last, late);
    }
    if (m->sample_count > 0) {
        expect(r, "scatter of instants", 0, last - first, 0, width + INSTANT);
        expect(r, "lateness of instants", 0, last, -width, width + INSTANT);
    }
}
