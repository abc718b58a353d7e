// The motion of a rig: rows of the run, and readings at the sampling instants.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/rigs/random_rigs.h"

static const char *const column_names[COLUMNS] = {"time",
                                                  "hub_angle",
                                                  "first_angle",
                                                  "last_angle",
                                                  "hub_velocity",
                                                  "first_velocity",
                                                  "last_velocity",
                                                  "hub_acceleration",
                                                  "gap",
                                                  "gap_velocity",
                                                  "force",
                                                  "impulse",
                                                  "contact",
                                                  "sticking",
                                                  "voltage",
                                                  "motor_torque",
                                                  "kinetic_energy",
                                                  "strain_energy",
                                                  "motor_work",
                                                  "external_work",
                                                  "viscous_loss",
                                                  "friction_loss",
                                                  "damping_loss",
                                                  "impact_loss",
                                                  "energy_residual",
                                                  "wall_energy",
                                                  "wall_loss",
                                                  "wall_work",
                                                  "weight_energy",
                                                  "face_depth",
                                                  "command",
                                                  "encoder",
                                                  "tachometer",
                                                  "force_reading",
                                                  "piezo_force",
                                                  "film",
                                                  "accelerometer"};

double or_zero(double x)
{
    return isnan(x) ? 0 : x;
}

double quantity(const motion *m, const char *key)
{
    double value;
    impactlab_error error;
    if (impactlab_run_quantity(m->run, key, &value, &error) != IMPACTLAB_OK) {
        return (double)NAN;
    }
    return value;
}

bool has_quantity(const motion *m, const char *key)
{
    double value;
    return impactlab_run_quantity(m->run, key, &value, NULL) == IMPACTLAB_OK;
}

void read_rows(motion *m)
{
    impactlab_error error;
    for (int c = 0; c < COLUMNS; c++) {
        impactlab_series s;
        if (impactlab_run_signal(m->run, column_names[c], &s, &error) != IMPACTLAB_OK) {
            fail(column_names[c], &error);
        }
        m->count = s.count;
        m->of[c] = malloc(s.count * sizeof(double));
        for (size_t i = 0; i < s.count; i++) {
            memcpy(&m->of[c][i], (const char *)s.values + i * s.stride, sizeof(double));
        }
    }
    m->ends = m->of[TIME][m->count - 1];
}

void read_samples(const rig *r, motion *m)
{
    impactlab_loop *loop;
    impactlab_error error;
    if (is(r, "control.law", "none")) {
        return;
    }
    if (impactlab_loop_create(&loop, r->scenario, 0, &error) != IMPACTLAB_OK) {
        fail("loop", &error);
    }
    while (!impactlab_loop_ended(loop) && m->sample_count < MOST_SAMPLES) {
        impactlab_reading reading;
        if (impactlab_loop_read_sensors(loop, &reading, &error) != IMPACTLAB_OK) {
            fail("sensors", &error);
        }
        m->samples[m->sample_count++] =
            (sample){.time = impactlab_loop_time(loop),
                     .reading = {reading.encoder, reading.tachometer, reading.force,
                                 reading.piezo_force, reading.film,
                                 reading.accelerometer}};
        if (impactlab_loop_step(loop, &error) != IMPACTLAB_OK) {
            break;
        }
    }
    impactlab_loop_destroy(loop);
}

void forget(motion *m)
{
    for (int c = 0; c < COLUMNS; c++) {
        free(m->of[c]);
    }
    impactlab_run_destroy(m->run);
}
