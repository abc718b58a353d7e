#include "src/predict/predictors.h"

#include <assert.h>
#include <math.h>

#include "src/predict/linearised.h"

// The linearised arm asks for the state of all links.
static prediction_outcome ask_linearised(const prediction_question *question, prediction *out,
                                         fault *f)
{
    const parameters *p = question->parameters;
    if (p->arm.model == ARM_PRINTED) {
        return PREDICTION_CORRECTED_ONLY;
    }
    if (question->angles == NULL || question->velocities == NULL) {
        return PREDICTION_LINKS_UNKNOWN;
    }

    arm a;
    arm_init(&a, p);
    motion *work = motion_create(&a, &p->method);
    status code = work == NULL
                      ? STATUS_NO_MEMORY
                      : predict_linearised(&a, work, question->angles, question->velocities, out);
    motion_destroy(work);

    if (code != STATUS_OK) {
        fault_set(f, code, "%s", status_text(code));
        return PREDICTION_FAILED;
    }
    return out->holds ? PREDICTION_HOLDS : PREDICTION_LOST;
}

static prediction_outcome ask(predictor which, const prediction_question *question, prediction *out,
                              fault *f)
{
    const parameters *p = question->parameters;
    const three_body_state *s = &question->bodies;
    status code = STATUS_OK;

    // what none of them knows
    if (p->wall.contact != WALL_RIGID) {
        return PREDICTION_RIGID_WALL_ONLY; // all of them begin with an impact
    }
    if (p->arm.tip_mass > 0) {
        return PREDICTION_BARE_TIP_ONLY;
    }

    switch (which) {
    case PREDICTOR_ENERGY:
        code = predict_energy(p, s, out, f);
        break;
    case PREDICTOR_IMPACT_DYNAMICS:
        code = predict_impact_dynamics(p, s, out, f);
        break;
    case PREDICTOR_IMPACT_QUADRATIC:
        code = predict_impact_quadratic(p, s, out, f);
        break;
    case PREDICTOR_LINEARISED:
        return ask_linearised(question, out, f);
    case PREDICTOR_COUNT:
        break;
    }

    return code != STATUS_OK ? PREDICTION_FAILED : out->holds ? PREDICTION_HOLDS : PREDICTION_LOST;
}

prediction_answer predict_with(predictor which, const prediction_question *question)
{
    static const struct {
        const char *name, *label, *short_label;
    } texts[] = {
#define PREDICTOR_TEXT(id, name, label, short_label) [id] = {name, label, short_label},
        PREDICTOR_LIST(PREDICTOR_TEXT)
#undef PREDICTOR_TEXT
    };
    const double none = (double)NAN;
    assert(which < PREDICTOR_COUNT && question != NULL && question->parameters != NULL);

    prediction_answer answer = {.name = texts[which].name,
                                .label = texts[which].label,
                                .short_label = texts[which].short_label,
                                .fault = {.code = STATUS_OK}};
    answer.outcome = ask(which, question, &answer.prediction, &answer.fault);
    if (!prediction_known(&answer)) {
        answer.prediction = (prediction){.force = none, .delay = none, .impulse = none};
    }
    return answer;
}

void predict_all(const prediction_question *question, prediction_answer answers[PREDICTOR_COUNT])
{
    assert(question != NULL && answers != NULL);
    for (predictor which = 0; which < PREDICTOR_COUNT; which++) {
        answers[which] = predict_with(which, question);
    }
}

bool prediction_known(const prediction_answer *answer)
{
    assert(answer != NULL);
    return answer->outcome == PREDICTION_HOLDS || answer->outcome == PREDICTION_LOST;
}

const char *prediction_reason(const prediction_answer *answer)
{
    static const char *const texts[] = {
#define PREDICTION_OUTCOME_TEXT(id, text) [id] = text,
        PREDICTION_OUTCOME_LIST(PREDICTION_OUTCOME_TEXT)
#undef PREDICTION_OUTCOME_TEXT
    };
    assert(answer != NULL);
    if (answer->outcome == PREDICTION_FAILED) {
        return answer->fault.text;
    }
    return answer->outcome == PREDICTION_HOLDS ? "" : texts[answer->outcome];
}
