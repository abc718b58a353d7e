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

static void *create(const peer *self)
{
    // everything the experiment states is set, so that a changed default cannot change it
    const struct {
        const char *path, *word; // a word, or a number
        double number;
    } settings[] = {{"arm.model", "corrected"},
                    {"arm.hub_joint", "rigid"},
                    {"arm.links", NULL, self->links},
                    {"arm.length", NULL, EXPERIMENT_BEAM_LENGTH},
                    {"arm.mass", NULL, EXPERIMENT_BEAM_MASS},
                    {"arm.hub_inertia", NULL, EXPERIMENT_HUB_INERTIA},
                    {"arm.k2", NULL, EXPERIMENT_SPRING},
                    {"arm.damping_ratio", NULL, 0},
                    {"motor.voltage", NULL, EXPERIMENT_VOLTAGE},
                    {"motor.torque_constant", NULL, EXPERIMENT_TORQUE_CONSTANT},
                    {"motor.stiction", NULL, EXPERIMENT_STICTION},
                    {"wall.kind", self->links == 2 ? "plane" : "none"},
                    {"wall.angle", NULL, EXPERIMENT_WALL},
                    {"wall.restitution", NULL, 0},
                    {"method.name", method_names[self->variant]},
                    {"method.step", NULL, EXPERIMENT_STEP},
                    {"run.duration", NULL, EXPERIMENT_DURATION}};
    simulation *s = calloc(1, sizeof *s);
    status code = s != NULL ? STATUS_OK : STATUS_NO_MEMORY;
    fault f = {.text = "out of memory"};
    if (s != NULL) {
        s->keep_rows = self->variant == BY_EVENT_WITH_ROWS;
        parameters_defaults(&s->scenario.parameters, ARM_CORRECTED);
    }
    for (size_t i = 0; i < sizeof settings / sizeof settings[0] && code == STATUS_OK; i++) {
        const int at = parameter_find(settings[i].path);
        code = settings[i].word != NULL
                   ? parameter_set_text(&s->scenario.parameters, at, settings[i].word, &f)
                   : parameter_set_number(&s->scenario.parameters, at, settings[i].number, &f);
    }
    code = code == STATUS_OK ? parameters_resolve(&s->scenario.parameters, &f) : code;
    if (code != STATUS_OK) {
        fprintf(stderr, "peers: impactlab: %s\n", f.text);
        free(s);
        s = NULL;
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
