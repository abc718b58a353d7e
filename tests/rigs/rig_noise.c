// The noise of the sensors, by its mean and variance.
#include <math.h>

#include "tests/rigs/random_rigs.h"

void check_noise(rig *r)
{
    static const char *const common[] = {"control.law=open-loop",
                                         "control.rate=1000",
                                         "control.approach_voltage=2",
                                         "wall.contact=kelvin-voigt",
                                         "wall.angle=0.02",
                                         "sensor.adc_bits=0",
                                         "sensor.adc_range=100",
                                         "sensor.piezo=true",
                                         "sensor.film=true",
                                         "sensor.accelerometer=true",
                                         "sensor.piezo_range=0",
                                         "sensor.accelerometer_range=0",
                                         "sensor.fsr_saturation=1000",
                                         "run.duration=3"};
    static const struct {
        const char *path, *volts;
        double deviation;
    } noises[] = {{"sensor.tachometer_noise", "sensor.tachometer_gain", 0.02},
                  {"sensor.fsr_noise", NULL, 0.005},
                  {"sensor.piezo_noise", "sensor.piezo_gain", 0.03},
                  {"sensor.film_noise", "sensor.film_gain", 0.04},
                  {"sensor.accelerometer_noise", "sensor.accelerometer_gain", 0.05}};
    enum { NOISES = 5, COMMON = sizeof common / sizeof common[0] };
    static motion with[2];
    impactlab_error error;

    // both runs
    for (int noisy = 0; noisy < 2; noisy++) {
        *r = (rig){.number = UINT64_MAX};
        const char *all[MOST_SETTINGS];
        for (int k = 0; k < COMMON; k++) {
            set(r, "%s", common[k]);
        }
        for (int k = 0; k < NOISES; k++) {
            set(r, "%s=%g", noises[k].path, noisy ? noises[k].deviation : 0);
        }
        for (int k = 0; k < r->count; k++) {
            all[k] = r->settings[k];
        }
        if (impactlab_scenario_create(&r->scenario, &error) != IMPACTLAB_OK ||
            impactlab_scenario_set_all(r->scenario, all, (size_t)r->count, &error) !=
                IMPACTLAB_OK) {
            fail("noise", &error);
        }
        with[noisy] = (motion){0};
        read_samples(r, &with[noisy]);
        if (!noisy) {
            impactlab_scenario_destroy(r->scenario);
        }
    }

    // five standard deviations of a mean and of a variance
    for (int k = 0; k < NOISES; k++) {
        double sum = 0, squares = 0, count = 0;
        for (int i = 0; i < with[0].sample_count; i++) {
            const double clean = with[0].samples[i].reading[k + 1];
            const double noisy = with[1].samples[i].reading[k + 1];
            double volts = 0;
            if (noises[k].volts != NULL) {
                volts = (noisy - clean) * number(r, noises[k].volts);
            } else if (clean > 0.2 && clean < 100) {
                volts = expected_fsr_volts(r, noisy) - expected_fsr_volts(r, clean);
            } else {
                continue;
            }
            sum += volts;
            squares += volts * volts;
            count++;
        }
        const double sigma = noises[k].deviation;
        expect(r, "samples with noise", 0, count, 1000, (double)INFINITY);
        expect_near(r, noises[k].path, 0, sum / count, 0, 5 * sigma / sqrt(count));
        expect_near(r, noises[k].path, 0, squares / count, sigma * sigma,
                    5 * sigma * sigma * sqrt(2 / count));
    }
    impactlab_scenario_destroy(r->scenario);
}
