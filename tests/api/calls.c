#include "calls.h"

#include <stdlib.h>
#include <string.h>

#include <impactlab/impactlab.h>

// All that is to be freed, whatever fails.
typedef struct made {
    FILE *out;
    impactlab_error error;
    impactlab_scenario *scenario, *copy;
    impactlab_run *run, *stepped;
    impactlab_loop *loop;
    char **names;
    size_t name_count;
    char *json, *csv, *yaml;
    void *state;
} made;

// Whether a call was refused, as a call should be; `left` is what it should not have
// made.
static int refused(const made *m, int status, const void *left)
{
    if (status != IMPACTLAB_OK) {
        const int well =
            m->error.status == status && m->error.sentence[0] != '\0' && left == NULL;
        fprintf(m->out, "%s\n", m->error.sentence);
        if (!well) {
            fprintf(stderr, "status %d, %d, something left: %d\n", status,
                    m->error.status, left != NULL);
            exit(2);
        }
    }
    return status != IMPACTLAB_OK;
}

static int open_all(made *m)
{
    static const char *const sets[] = {"motor.voltage=2 V", "run.duration=0.3"};
    impactlab_error *e = &m->error;
    return refused(m, impactlab_scenario_names(&m->names, &m->name_count, e), NULL) ||
           refused(m, impactlab_scenario_open(&m->scenario, "corrected/first-impact", e),
                   m->scenario) ||
           refused(m, impactlab_scenario_set_all(m->scenario, sets, 2, e), NULL) ||
           refused(m,
                   impactlab_scenario_add_change(m->scenario, 0.1, "motor.voltage", "1",
                                                 e),
                   NULL) ||
           refused(m, impactlab_scenario_copy(&m->copy, m->scenario, e), m->copy) ||
           refused(m, impactlab_scenario_yaml(m->copy, &m->yaml, e), m->yaml);
}

static int run_once(made *m)
{
    impactlab_error *e = &m->error;
    impactlab_prediction said[4];
    double frequencies[2];
    size_t count;
    return refused(m, impactlab_run_create(&m->run, m->copy, IMPACTLAB_KEEP_ROWS, e),
                   NULL) ||
           refused(m, impactlab_run_json(m->run, &m->json, e), m->json) ||
           refused(m, impactlab_run_csv(m->run, &m->csv, e), m->csv) ||
           refused(m, impactlab_run_predictions(m->run, said, 4, &count, e), NULL) ||
           refused(m, impactlab_modes(m->copy, 0, 0, frequencies, NULL, 2, &count, e),
                   NULL);
}

static int step_through(made *m)
{
    impactlab_error *e = &m->error;
    if (refused(m, impactlab_loop_create(&m->loop, m->copy, IMPACTLAB_KEEP_ROWS, e),
                m->loop) ||
        refused(m, impactlab_loop_step_until(m->loop, 0.25, e), NULL)) {
        return 1;
    }
    const size_t size = impactlab_loop_state_size(m->loop);
    m->state = malloc(size);
    return m->state == NULL ||
           refused(m, impactlab_loop_save_state(m->loop, m->state, size, e), NULL) ||
           refused(m, impactlab_loop_step_until(m->loop, 0.3, e), NULL) ||
           refused(m, impactlab_loop_restore_state(m->loop, m->state, size, e), NULL) ||
           refused(m, impactlab_loop_step_until(m->loop, 0.3, e), NULL) ||
           refused(m, impactlab_loop_run(m->loop, &m->stepped, e), m->stepped);
}

// A run of the batch without memory says so, and ends it.
static int add_up(void *context, const impactlab_outcome *outcome)
{
    if (outcome->status != IMPACTLAB_OK) {
        if (outcome->message[0] == '\0') {
            exit(2);
        }
        return 1;
    }
    *(double *)context += outcome->quantities[1];
    return 0;
}

int call_everything(FILE *out)
{
    static const char *const paths[] = {"motor.voltage"};
    static const double volts[] = {1.5, 2, 2.5};
    made m = {.out = out};
    double peak = 0, stepped = 0, sum = 0;
    impactlab_error *e = &m.error;
    const int ended =
        open_all(&m) || run_once(&m) || step_through(&m) ||
        refused(&m, impactlab_run_quantity(m.run, "peak_force_N", &peak, e), NULL) ||
        refused(&m, impactlab_run_quantity(m.stepped, "peak_force_N", &stepped, e),
                NULL) ||
        refused(&m, impactlab_batch(m.copy, paths, 1, volts, 3, 2, add_up, &sum, e),
                NULL);
    if (!ended) {
        // times have other digits every time, but no key may be lost
        size_t lines = 0;
        for (const char *at = m.json; *at != '\0'; at++) {
            lines += *at == '\n';
        }
        fprintf(out, "whole %.17g %.17g %.17g %zu %zu %zu\n", peak, stepped, sum, lines,
                strlen(m.csv), strlen(m.yaml));
    }

    impactlab_names_free(m.names, m.name_count);
    impactlab_text_free(m.json);
    impactlab_text_free(m.csv);
    impactlab_text_free(m.yaml);
    impactlab_run_destroy(m.run);
    impactlab_run_destroy(m.stepped);
    impactlab_loop_destroy(m.loop);
    impactlab_scenario_destroy(m.copy);
    impactlab_scenario_destroy(m.scenario);
    free(m.state);
    return ended;
}
