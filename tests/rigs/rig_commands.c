// Commands of the samples and what rows say of them and of readings.
#include <math.h>

#include "tests/rigs/random_rigs.h"

// The first row at the instant t or after it, by bisection; the number of rows if there
// is none.
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
    // the limit of the command; that of the current is one too if the drive gives a
    // current
    double limit = number(r, "motor.voltage_limit");
    const double current_limit = number(r, "motor.current_limit");
    if (is(r, "motor.drive", "current") && current_limit > 0) {
        limit = fmin(limit, current_limit / number(r, "motor.transconductance"));
    }

    // each command is in the rows after its sample
    const double bits = is(r, "sensor.ideal", "true") ? 0 : number(r, "sensor.dac_bits");
    const double delay = number(r, "control.delay") +
                         number(r, "control.delay_periods") / number(r, "control.rate");
    for (int k = 0; k < m->sample_count; k++) {
        sample *s = &m->samples[k];
        const size_t row = row_at(m, s->time + INSTANT);
        s->command = row < m->count ? m->of[COMMAND][row] : (double)NAN;
        s->voltage = converted(fmax(-limit, fmin(limit, s->command)), bits, limit);
    }

    // a command takes effect after the delay. A delay of so many periods, rounded up,
    // ends at the latest with the sample that comes so many samples later, which jitter
    // may make early
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

        // the readings of the last sample stay in the rows until the next one. Of several
        // rows at the instant of a sample the last has its readings; the others are not
        // compared
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

        // the voltage of the command that acts; where one takes effect at the row's
        // instant both are right
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
                 jitter = number(r, "control.jitter");
    double least_late = (double)INFINITY, most_late = -(double)INFINITY;
    for (int k = 0; k < m->sample_count; k++) {
        const double late = m->samples[k].time - k * period;
        least_late = fmin(least_late, late);
        most_late = fmax(most_late, late);
    }
    if (m->sample_count > 0) {
        expect(r, "scatter of instants", 0, most_late - least_late, 0, jitter + INSTANT);
        expect(r, "lateness of instants", 0, most_late, -jitter, jitter + INSTANT);
    }
}
