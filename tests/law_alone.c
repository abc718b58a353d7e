// Control laws without the lab: this program is made of the laws' files, what they
// compute with (src/base/plain_math.c, dense.c, src/rig/estimation/estimator.c,
// riccati.c) and the mathematical library, as a board would have them. It is linked so
// that a call of the allocator or of a file by any of them does not link.
//
// Every law goes through an approach, a touch and a press, twice: its commands are
// finite, in modes that it has, and the same both times, as its memory is all that it
// knows.
#include <math.h>
#include <stdalign.h>
#include <stdio.h>
#include <string.h>

#include "src/rig/laws/laws.h"

enum { SAMPLES = 400, MOST_PARAMETERS = 32, MOST_MEMORY = 1 << 16 };

// Values that a scenario would give; a parameter of another name has the law's own
// initial value.
static const struct {
    const char *name;
    double value;
} given[] = {{"force", 1},
             {"approach_voltage", 1},
             {"kp", 10},
             {"kv", 1},
             {"transition_time", 0.15},
             {"contact_threshold", 0.1},
             {"force_gain", 1},
             {"integral_gain", 20},
             {"speed_limit", 0.3},
             {"reverse_time", 0.02},
             {"force_limit", 2},
             {"switch_share", 0.5},
             {"travel_time", 0.4},
             {"arrival_speed", 0.2}};

static double value_of(const controller_parameter *p)
{
    for (size_t i = 0; i < sizeof given / sizeof given[0]; i++) {
        if (strcmp(given[i].name, p->name) == 0) {
            return given[i].value;
        }
    }
    return p->initial;
}

// What the sensors read of an arm that turns towards the wall, touches after half of the
// samples and is pressed on.
static controller_input reading(int sample, double period, double command)
{
    const int touch = SAMPLES / 2;
    const double time = sample * period, wall = 0.1, speed = wall / (touch * period);
    const bool pressed = sample >= touch;
    return (controller_input){.time = time,
                              .encoder = pressed ? wall + 1e-3 * (sample - touch) / touch
                                                 : speed * time,
                              .tachometer = pressed ? 1e-3 / (touch * period) : speed,
                              .force = pressed ? 0.5 + 0.5 * (sample - touch) / touch : 0,
                              .voltage = command,
                              .piezo_force = (double)NAN,
                              .film = (double)NAN,
                              .accelerometer = (double)NAN,
                              .wanted_mode = -1,
                              .predicted_force = pressed ? (double)NAN : 0.5};
}

// Commands of a law from its start; NULL, or what is wrong.
static const char *go_through(const controller *law, double commands[SAMPLES])
{
    static alignas(64) unsigned char memory[MOST_MEMORY];
    double values[MOST_PARAMETERS];
    int modes = 0;
    if (law->memory_size > sizeof memory || law->parameter_count > MOST_PARAMETERS) {
        return "it needs more memory than this program has";
    }
    memset(memory, 0, sizeof memory);
    for (int i = 0; i < law->parameter_count; i++) {
        values[i] = value_of(&law->parameters[i]);
    }
    while (law->modes[modes] != NULL) {
        modes++;
    }

    // the arm of the defaults
    const controller_setup setup = {.period = 5e-3,
                                    .delay = 1e-3,
                                    .voltage_limit = 10,
                                    .torque_per_volt = 0.12,
                                    .hub_damping = 0.02,
                                    .stiction = 0.02,
                                    .hub_inertia = 0.0052,
                                    .link_mass = 0.2,
                                    .link_length = 0.5,
                                    .link_inertia = 0.0042,
                                    .k2 = 4.92,
                                    .wall_angle = 0.1,
                                    .links = 2,
                                    .hub_spring = HUGE_VAL,
                                    .parameters = values};
    const char *refusal = law->start != NULL ? law->start(memory, &setup) : NULL;
    if (refusal != NULL) {
        return refusal;
    }
    double command = 0;
    for (int i = 0; i < SAMPLES; i++) {
        const controller_input in = reading(i, setup.period, command);
        controller_output out = {.command = (double)NAN};
        law->sample(memory, &in, &out);
        if (!isfinite(out.command)) {
            return "a command is not finite";
        }
        if (out.mode < 0 || out.mode >= modes) {
            return "it is in a mode that it does not have";
        }
        command = fmax(-setup.voltage_limit, fmin(out.command, setup.voltage_limit));
        commands[i] = out.command;
    }
    return NULL;
}

// A law whose file is not among those of this program has no address here.
#define LAW(name, prefix, ...) extern __attribute__((weak)) const controller prefix##_law;
CONTROL_LAWS(LAW)
#undef LAW

// What is wrong with a law; NULL: nothing.
static const char *fault_of(const controller *law)
{
    static double once[SAMPLES], again[SAMPLES];
    const char *why = go_through(law, once);
    if (why == NULL) {
        why = go_through(law, again);
    }
    if (why == NULL && memcmp(once, again, sizeof once) != 0) {
        why = "it remembers";
    }
    return why;
}

int main(void)
{
#define LAW(name, prefix, ...) &prefix##_law,
    static const controller *const laws[] = {CONTROL_LAWS(LAW)};
#undef LAW
    int there = 0, wrong = 0;
    for (size_t i = 0; i < sizeof laws / sizeof laws[0]; i++) {
        if (laws[i] == NULL) {
            continue;
        }
        there++;
        const char *why = fault_of(laws[i]);
        if (why != NULL) {
            printf("%s: %s\n", laws[i]->name, why);
            wrong++;
        }
    }
    printf("%d laws\n", there);
    return there == 0 || wrong != 0;
}
