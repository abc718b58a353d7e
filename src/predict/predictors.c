#include "src/predict/predictors.h"

#include <assert.h>
#include <math.h>

#include "src/arm/motor.h"
#include "src/base/numbers.h"
#include "src/predict/linearised.h"
#include "src/tables/features.h"

// Asks the linearised arm, which needs the state of all links.
static prediction_outcome ask_linearised(const prediction_question *question,
                                         prediction *out, fault *f)
{
    const parameters *p = question->parameters;
    assert((question->angles == NULL) == (question->velocities == NULL));
    if (question->angles == NULL) {
        return PREDICTION_LINKS_UNKNOWN;
    }

    arm a;
    arm_init(&a, p);
    voltage_profile command = question->command;
    command.current = question->current;
    const double *q = question->angles, *w = question->velocities;
    const bool constant_command = command.count == 0 && p->motor.inductance == 0;
    bool energies = false;
    status code;
    if (constant_command) {
        code = predict_linearised(&a, &p->method, q, w, out);
    } else {
        code = predict_pulse(&a, &p->method, q, w, &command, energies, out);
    }

    // e_eq needs the energies of the pulse, followed to its end
    prediction whole;
    if (code == STATUS_OK && question->whole_pulse && out->holds) {
        energies = true;
        code = predict_pulse(&a, &p->method, q, w, &command, energies, &whole);
        out->restitution = whole.restitution;
    }
    if (code != STATUS_OK) {
        fault_set(f, code, "%s", status_text(code));
        return PREDICTION_FAILED;
    }
    if (out->doubtful) {
        return PREDICTION_DOUBTFUL;
    }
    if (out->holds) {
        return PREDICTION_HOLDS;
    }
    return PREDICTION_LOST;
}

// The mean of the prescribed command v(t) from the touch until `time` [V], which stands
// for v(t) in the integral (4.20); with time 0 the command in force at the touch.
static double mean_voltage(const prediction_question *question, double time)
{
    const voltage_profile *command = &question->command;
    const motor_parameters *motor = &question->parameters->motor;
    double sum = 0, from = 0, volts = motor_limited_voltage(motor, motor->voltage);

    // from one change of the command to the next, the last until `time`
    for (int i = 0; i <= command->count; i++) {
        double to = time;
        if (i < command->count) {
            to = fmin(command->times[i], time);
        }
        sum += volts * fmax(to - from, 0);
        from = fmax(from, to);
        if (i < command->count && command->times[i] <= time) {
            volts = motor_limited_voltage(motor, command->volts[i]);
        }
    }
    if (time > 0) {
        return sum / time;
    }
    return volts;
}

// The impact dynamics for a prescribed command v(t), by fixed-point iteration: the delay
// says over which time the voltage is averaged, and the mean voltage gives the delay.
static status ask_impact_dynamics(predictor which, const prediction_question *question,
                                  prediction *out, fault *f)
{
    enum { MOST_ITERATIONS = 200 };
    parameters p = *question->parameters;
    double delay = 0, found = 0;
    for (int i = 0; i < MOST_ITERATIONS; i++) {
        if (question->command.count > 0) {
            p.motor.voltage = mean_voltage(question, delay);
        }
        status code;
        if (which == PREDICTOR_IMPACT_DYNAMICS) {
            code = predict_impact_dynamics(&p, &question->bodies, out, f);
        } else {
            code = predict_impact_quadratic(&p, &question->bodies, out, f);
        }
        found = out->delay;
        if (code != STATUS_OK || question->command.count == 0 || !out->holds ||
            fabs(found - delay) <= 1e-9 * found) {
            return code;
        }

        // half the way to the delay found: with a voltage that changes its sign the whole
        // way may overshoot
        if (i == 0) {
            delay = found;
        } else {
            delay = (delay + found) / 2;
        }
    }
    return fault_set(f, STATUS_NEWTON_FAILED,
                     "no delay goes with the mean of the prescribed voltage over it");
}

// The outcome that names the first of the arm's features that a predictor does not take.
static prediction_outcome outcome_without(feature_set refused)
{
    static const feature_set features[] = {
#define PREDICTION_OUTCOME_FEATURES(id, features, text) [id] = features,
        PREDICTION_OUTCOME_LIST(PREDICTION_OUTCOME_FEATURES)
#undef PREDICTION_OUTCOME_FEATURES
    };
    prediction_outcome outcome = PREDICTION_HOLDS;
    while (refused != 0 && (features[outcome] & refused) == 0) {
        outcome++;
        assert(outcome < PREDICTION_FAILED);
    }
    return outcome;
}

// Asks one predictor, after the features of the arm that it does not take.
static prediction_outcome ask_predictor(predictor which,
                                        const prediction_question *question,
                                        prediction *out, fault *f)
{
    const parameters *p = question->parameters;

    // the thesis's begin with an impact of two bare links
    const bool thesis = which != PREDICTOR_LINEARISED;
    feature_set refused = features_of(p) & (HAS(MOVES) | HAS(PRINTED));
    if (thesis) {
        refused = features_of(p) & NOT_OF_THESIS;
    }
    if (refused != 0) {
        return outcome_without(refused);
    }
    if (which == PREDICTOR_ENERGY && question->command.count > 0) {
        return PREDICTION_KNOWS_NO_TIME;
    }
    if (!thesis) {
        return ask_linearised(question, out, f);
    }

    status code;
    if (which == PREDICTOR_ENERGY) {
        code = predict_energy(p, &question->bodies, out, f);
    } else {
        code = ask_impact_dynamics(which, question, out, f);
    }
    if (code != STATUS_OK) {
        return PREDICTION_FAILED;
    }
    if (out->holds) {
        return PREDICTION_HOLDS;
    }
    return PREDICTION_LOST;
}

prediction_answer predict_with(predictor which, const prediction_question *question)
{
    static const struct {
        const char *name, *label, *short_label;
    } texts[] = {
#define PREDICTOR_TEXT(id, name, label, short_label, about)                              \
    [id] = {name, label, short_label},
        PREDICTOR_LIST(PREDICTOR_TEXT)
#undef PREDICTOR_TEXT
    };
    assert(which < PREDICTOR_COUNT);

    prediction_answer answer = {.name = texts[which].name,
                                .label = texts[which].label,
                                .short_label = texts[which].short_label,
                                .fault = {.code = STATUS_OK}};
    answer.outcome = ask_predictor(which, question, &answer.prediction, &answer.fault);
    if (!prediction_known(&answer)) {
        const bool doubtful = answer.prediction.doubtful;
        answer.prediction = prediction_none();
        answer.prediction.doubtful = doubtful;
    }
    return answer;
}

// Adds to every answer how much the motor's inductance changes the peak: the linearised
// arm's force with the inductance less its force without.
static void tell_inductance(const prediction_question *question,
                            prediction_answer answers[PREDICTOR_COUNT])
{
    parameters no_inductance = *question->parameters;
    prediction_question question_without = *question;
    no_inductance.motor.inductance = 0;
    question_without.parameters = &no_inductance;
    const prediction_answer without =
        predict_with(PREDICTOR_LINEARISED, &question_without);
    const double change =
        answers[PREDICTOR_LINEARISED].prediction.force - without.prediction.force;

    for (predictor which = 0; which < PREDICTOR_COUNT; which++) {
        prediction_answer *answer = &answers[which];
        if (prediction_known(answer)) {
            answer->prediction.inductance = change;
        } else {
            answer->prediction.inductance = (double)NAN;
        }
        if (which == PREDICTOR_LINEARISED || answer->outcome != PREDICTION_HOLDS) {
            continue;
        }
        if (isnan(change)) {
            decimal_print(answer->note, sizeof answer->note,
                          "without the motor's inductance");
        } else {
            decimal_print(answer->note, sizeof answer->note,
                          "without the motor's inductance, which changes the peak by "
                          "%.2g N",
                          change);
        }
    }
}

void predict_all(const prediction_question *question,
                 prediction_answer answers[PREDICTOR_COUNT])
{
    for (predictor which = 0; which < PREDICTOR_COUNT; which++) {
        answers[which] = predict_with(which, question);
    }
    if (question->parameters->motor.inductance > 0) {
        tell_inductance(question, answers);
    }
}

bool prediction_known(const prediction_answer *answer)
{
    return answer->outcome == PREDICTION_HOLDS || answer->outcome == PREDICTION_LOST;
}

const char *prediction_reason(const prediction_answer *answer)
{
    static const char *const texts[] = {
#define PREDICTION_OUTCOME_TEXT(id, features, text) [id] = text,
        PREDICTION_OUTCOME_LIST(PREDICTION_OUTCOME_TEXT)
#undef PREDICTION_OUTCOME_TEXT
    };
    if (answer->outcome == PREDICTION_FAILED) {
        return answer->fault.text;
    }
    if (answer->outcome == PREDICTION_HOLDS) {
        return answer->note;
    }
    return texts[answer->outcome];
}
