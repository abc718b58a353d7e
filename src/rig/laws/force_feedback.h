// What the laws share that close the loop over the force reading alone (force-pd, force-integral,
// discontinuous), and the one that closes none (open-loop): modes, parameters and memory.
#pragma once

#include "src/rig/laws/laws.h"

enum { APPROACH, CONTACT }; // modes
extern const char *const force_feedback_modes[];

// Their parameters, by their names in control.*, in the order of the table.
enum { FORCE_WANTED, APPROACH_VOLTAGE, KV, THRESHOLD, FORCE_GAIN, INTEGRAL_GAIN, PARAMETERS };
extern const controller_parameter force_feedback_parameters[PARAMETERS];

typedef struct force_memory {
    controller_setup rig;
    double p[PARAMETERS]; // values of the parameters
    int mode;
    double integral; // force-integral's command [V]
} force_memory;

// Takes setup and parameters into a force_memory, at the start or later; never refuses.
const char *force_feedback_tune(void *memory, const controller_setup *setup);
const char *force_feedback_start(void *memory, const controller_setup *setup);

// Contact once the reading was above the threshold, and from then on, unless the law is held in a
// mode.
void force_feedback_choose_mode(force_memory *m, const controller_input *in);

// Static torque of the wanted force f, 2 f l, damped by the hub's velocity, and feedback of the
// force's error: ((2 f l - kv w)/K + force_gain (f - reading)) with K the torque per volt [V].
double force_feedback_command(const force_memory *m, const controller_input *in);

// A controller of this family: its word, whether it can be held in a mode, its sample function.
#define FORCE_FEEDBACK_LAW(law, obeys, samples)                                                    \
    CONTROLLER_LAW(law, force_feedback_modes, force_feedback_parameters, force_memory,             \
                   .lockable = obeys, .start = force_feedback_start, .sample = samples,            \
                   .tune = force_feedback_tune)
