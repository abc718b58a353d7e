// Weighs the readings of a trace: the standard deviation of each, and which are left out.
#include <math.h>
#include <stdlib.h>

#include "src/rig/rig.h"
#include "src/study/identify/identify.h"

#define LEAST_DEVIATION 1e-6 // of an ideal channel, in its unit

const char *const identify_uses[READING_USES] = {
    [READING_MISSING] = "missing",
    [READING_NEAR_TOUCH] = "within 10 ms of a touch",
    [READING_WITHOUT_CONTACT] = "without contact",
    [READING_AT_RANGE] = "at the end of the range"};

int identify_force_channel(const recorded_trace *t)
{
    return t->reading[CHANNEL_FSR] != NULL ? CHANNEL_FSR : CHANNEL_PIEZO;
}

double identify_compared_value(const sensor_parameters *s, int channel, double reading)
{
    if (channel == CHANNEL_FSR) {
        return fsr_volts(s, reading);
    }
    return reading;
}

double identify_deviation(const sensor_parameters *s, int channel, double *range,
                          bool *dithered)
{
    // sensors of volts behind an A/D converter, and an encoder, which counts radians
    const converter adc = converter_of(s->adc_bits, s->adc_range);
    const double encoder_step = s->encoder_counts > 0 ? 2 * M_PI / s->encoder_counts : 0;
    const struct {
        double noise, step, range; // in the sensor's own unit, [V] or [rad]
        double gain;               // of that unit per unit of the reading
    } channels[CHANNELS] = {
        [CHANNEL_ENCODER] = {0, encoder_step, HUGE_VAL, 1},
        [CHANNEL_TACHOMETER] = {s->tachometer_noise, adc.step, s->adc_range,
                                s->tachometer_gain},
        [CHANNEL_FSR] = {s->fsr_noise, adc.step, s->adc_range, 1},
        [CHANNEL_PIEZO] = {s->piezo_noise, adc.step, s->adc_range, s->piezo_gain},
        [CHANNEL_FILM] = {s->film_noise, adc.step, s->adc_range, s->film_gain},
        [CHANNEL_ACCELEROMETER] = {s->accelerometer_noise, adc.step, s->adc_range,
                                   s->accelerometer_gain},
        [CHANNEL_TIP_DEFLECTION] = {s->tip_deflection_noise, adc.step, s->adc_range,
                                    s->tip_deflection_gain},
        [CHANNEL_ROOT_STRAIN] = {s->root_strain_noise, adc.step, s->adc_range,
                                 s->root_strain_gain},
    };
    const double gain = channels[channel].gain;
    double noise = channels[channel].noise, step = channels[channel].step;
    *range = channels[channel].range / gain;

    // an ideal sensor has neither noise nor steps; an FSR saturates
    if (s->ideal) {
        step = noise = 0;
        *range = HUGE_VAL;
    }
    if (channel == CHANNEL_FSR) {
        *range = fmin(*range, fsr_volts(s, s->fsr_saturation));
    }
    *dithered = noise >= step / 2;
    return fmax(sqrt(noise * noise + step * step / 12) / gain, LEAST_DEVIATION);
}

// Finds the touches in the force that was recorded, and marks the samples within
// IDENTIFY_GUARD of a touch or a release, near[rows]. A touch ends a flight, in which the
// sensor shows nothing but noise; a force that only falls below the threshold and rises
// again is none.
static void find_touches(recorded_trace *t, const parameters *p, unsigned char *near)
{
    const int channel = identify_force_channel(t);
    const double *force = t->reading[channel], threshold = p->control.contact_threshold;
    double left = -HUGE_VAL, range; // since when it is off the wall, or on it
    bool dithered, flew = true;
    const double noise = identify_deviation(&p->sensor, channel, &range, &dithered);
    size_t before = t->rows; // the last reading; none yet
    for (size_t i = 0; force != NULL && i < t->rows; i++) {
        if (isnan(force[i])) {
            continue;
        }
        const size_t last = before < t->rows ? before : i;
        const bool touched = force[last] > threshold, touches = force[i] > threshold;
        before = i;
        if (identify_compared_value(&p->sensor, channel, force[last]) <
            IDENTIFY_NEAR * noise) {
            flew = true;
        }
        if (touched == touches) {
            continue;
        }

        // A touch soon after a release is no touch of its own: the readings between have
        // to show a flight so long that it is one in the run, too.
        const double change = (t->time[last] + t->time[i]) / 2;
        if (touches && flew && t->time[last] - left > IDENTIFY_GUARD) {
            t->contact_width[t->contact_count] = t->time[i] - t->time[last];
            t->contacts[t->contact_count++] = change;
        }
        left = t->time[i];
        flew = false;

        // the samples before the change, and those after it
        for (size_t k = i; k-- > 0 && change - t->time[k] <= IDENTIFY_GUARD;) {
            near[k] = 1;
        }
        for (size_t k = i; k < t->rows && t->time[k] - change <= IDENTIFY_GUARD; k++) {
            near[k] = 1;
        }
    }
}

// Sets the deviation of each reading of a channel and counts the readings that are
// compared. A deviation of 0 marks those that are not: near a touch, of the FSR without
// contact, or near the end of the range. Equal readings in a row are one reading, whose
// deviation each of n samples has times sqrt(n), unless noise covers the steps; of a
// sensor that looks less often than the rig only the first one is compared.
static status weigh_channel(recorded_trace *t, int c, const parameters *p,
                            const unsigned char *near, fault *f)
{
    double range;
    bool dithered;
    const double deviation = identify_deviation(&p->sensor, c, &range, &dithered);
    const double *reading = t->reading[c];
    const bool slow =
        (c == CHANNEL_TIP_DEFLECTION && p->sensor.tip_deflection_rate > 0) ||
        (c == CHANNEL_ROOT_STRAIN && p->sensor.root_strain_rate > 0);
    t->deviation[c] = calloc(t->rows, sizeof *t->deviation[c]);
    if (t->deviation[c] == NULL) {
        return fault_no_memory(f);
    }
    for (size_t i = 0, end; i < t->rows; i = end) {
        // the samples from i to before `end` are one reading
        end = i + 1;
        while ((slow || !dithered) && end < t->rows && reading[end] == reading[i]) {
            end++;
        }

        for (size_t k = i; k < end; k++) {
            const double size = fabs(identify_compared_value(&p->sensor, c, reading[k]));
            const bool touches =
                c != CHANNEL_FSR || reading[k] > p->control.contact_threshold;
            reading_use use = READING_COMPARED;
            if (isnan(reading[k])) {
                use = READING_MISSING;
            } else if (slow && k > i) {
                use = READING_REPEATED;
            } else if (near[k]) {
                use = READING_NEAR_TOUCH;
            } else if (!touches) {
                use = READING_WITHOUT_CONTACT;
            } else if (!(size < range - IDENTIFY_NEAR * deviation)) {
                use = READING_AT_RANGE;
            } else {
                const size_t shared = slow ? 1 : end - i;
                t->deviation[c][k] = deviation * sqrt((double)shared);
                t->independent[c] += 1 / (double)shared;
                t->residuals++;
            }
            t->uses[c][use]++;
        }
    }
    return STATUS_OK;
}

status identify_weigh(recorded_trace *t, const parameters *p, fault *f)
{
    SCOPED(free_kept) unsigned char *near = calloc(t->rows, 1);
    t->contacts = calloc(t->rows, sizeof *t->contacts);
    t->contact_width = calloc(t->rows, sizeof *t->contact_width);
    if (near == NULL || t->contacts == NULL || t->contact_width == NULL) {
        return fault_no_memory(f);
    }
    find_touches(t, p, near);
    t->residuals = (size_t)t->contact_count;
    for (int c = 0; c < CHANNELS; c++) {
        if (t->reading[c] != NULL) {
            TRY(weigh_channel(t, c, p, near, f));
        }
    }
    return STATUS_OK;
}
