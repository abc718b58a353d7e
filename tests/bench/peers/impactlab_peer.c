// The laboratory itself, through its library.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/run/run.h"
#include "tests/bench/peers/peer.h"

typedef enum impactlab_variant {
    BY_EVENT,
    BY_EVENT_WITH_ROWS,
    BY_GENERALIZED_ALPHA,
    BY_NEWMARK
} impactlab_variant;

typedef struct simulation {
    scenario scenario;
    bool keep_rows;
} simulation;

static const char *const method_names[] = {"event", "event", "generalized-alpha", "newmark"};

static bool set(parameters *p, const char *path, const char *value)
{
    fault f;
    if (parameter_set_text(p, parameter_find(path), value, &f) == STATUS_OK) {
        return true;
    }
    fprintf(stderr, "peers: impactlab: %s\n", f.text);
    return false;
}

static bool set_number(parameters *p, const char *path, double value)
{
    char text[32];
    snprintf(text, sizeof text, "%.17g", value);
    return set(p, path, text);
}

static void *create(const peer *self)
{
    simulation *s = calloc(1, sizeof *s);
    if (s == NULL) {
        return NULL;
    }
    fault f;
    parameters *p = &s->scenario.parameters;
    s->keep_rows = self->variant == BY_EVENT_WITH_ROWS;
    parameters_defaults(p, ARM_CORRECTED);
    // everything the experiment states is set, so that a changed default cannot change it
    bool good =
        set(p, "arm.model", "corrected") && set(p, "arm.hub_joint", "rigid") &&
        set_number(p, "arm.links", self->links) &&
        set_number(p, "arm.length", EXPERIMENT_BEAM_LENGTH) &&
        set_number(p, "arm.mass", EXPERIMENT_BEAM_MASS) &&
        set_number(p, "arm.hub_inertia", EXPERIMENT_HUB_INERTIA) &&
        set_number(p, "arm.k2", EXPERIMENT_SPRING) && set_number(p, "arm.damping_ratio", 0) &&
        set_number(p, "motor.voltage", EXPERIMENT_VOLTAGE) &&
        set_number(p, "motor.torque_constant", EXPERIMENT_TORQUE_CONSTANT) &&
        set_number(p, "motor.stiction", EXPERIMENT_STICTION) &&
        set(p, "wall.kind", self->links == 2 ? "plane" : "none") &&
        set_number(p, "wall.angle", EXPERIMENT_WALL) && set_number(p, "wall.restitution", 0) &&
        set(p, "method.name", method_names[self->variant]) &&
        set_number(p, "method.step", EXPERIMENT_STEP) &&
        set_number(p, "run.duration", EXPERIMENT_DURATION);
    if (good && parameters_resolve(p, &f) != STATUS_OK) {
        fprintf(stderr, "peers: impactlab: %s\n", f.text);
        good = false;
    }
    if (!good) {
        free(s);
        return NULL;
    }
    return s;
}

static bool run(void *instance, peer_answer *answer)
{
    const simulation *simulated = instance;
    run_result result;
    status code = run_scenario(&simulated->scenario, simulated->keep_rows, &result);
    const summary *s = &result.summary;
    answer->first_contact = s->first_contact_s;
    answer->impulse = s->contact_impulse_Ns;
    answer->peak = s->first_pulse_peak_N;
    answer->peak_delay = s->first_pulse_time_to_peak_s;
    answer->release = s->first_contact_s + s->first_pulse_s;
    answer->final_force = isnan(s->first_contact_s) ? (double)NAN : s->steady_force_N;
    answer->steps = s->steps;
    answer->computing_time = s->cpu_time_s;
    int impacts = 0;
    for (size_t i = 0; i < result.trace.event_count; i++) {
        const event *e = &result.trace.events[i];
        if (e->kind == EVENT_IMPACT && ++impacts == 2) {
            answer->second_contact = e->time;
        }
    }
    if (code != STATUS_OK) {
        fprintf(stderr, "peers: impactlab: %s\n", s->message);
    }
    run_finish(&result);
    return code == STATUS_OK;
}

static double fixed_step(const void *instance)
{
    const parameters *p = &((const simulation *)instance)->scenario.parameters;
    return p->method.name == METHOD_EVENT ? 0 : p->method.step;
}

static double duration(const void *instance)
{
    return ((const simulation *)instance)->scenario.parameters.run.duration;
}

#define IMPACTLAB(text, links, variant)                                                            \
    {                                                                                              \
        "impactlab", IMPACTLAB_VERSION, text, links, variant, create, free, run, fixed_step,       \
            duration                                                                               \
    }

static const peer list_of_peers[] = {
    IMPACTLAB("event (its default)", 2, BY_EVENT),
    IMPACTLAB("event, a row every 1 ms", 2, BY_EVENT_WITH_ROWS),
    IMPACTLAB("generalized-alpha", 2, BY_GENERALIZED_ALPHA),
    IMPACTLAB("Newmark", 2, BY_NEWMARK),
    IMPACTLAB("generalized-alpha", 8, BY_GENERALIZED_ALPHA),
    IMPACTLAB("generalized-alpha", 32, BY_GENERALIZED_ALPHA),
    IMPACTLAB("generalized-alpha", 128, BY_GENERALIZED_ALPHA),
    IMPACTLAB("event", 8, BY_EVENT),
    IMPACTLAB("event", 32, BY_EVENT),
};

int peers_impactlab(const peer **list)
{
    *list = list_of_peers;
    return (int)(sizeof list_of_peers / sizeof list_of_peers[0]);
}
