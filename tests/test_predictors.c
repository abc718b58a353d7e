// One question to all predictors: which answer, and why the others do not.
#include "src/predict/predictors.h"

#include <math.h>

#include "tests/arm_fixture.h"

// The arm just before it touches a wall at 0.1 rad, bent back and turning towards it.
static const three_body_state closing = {{0.1136, 0.1136, 0.0864}, {0.585, 0.585, 0.9}};
static const double links[2] = {0.1136, 0.0864}, rates[2] = {0.585, 0.9};

static void every_predictor_answers_for_the_corrected_arm(void **state)
{
    (void)state;
    parameters p = fixture_parameters(NULL);
    prediction_answer answers[PREDICTOR_COUNT];
    prediction alone;
    predict_all(&(prediction_question){&p, closing, links, rates}, answers);
    for (int i = 0; i < PREDICTOR_COUNT; i++) {
        assert_int_equal(answers[i].outcome, PREDICTION_HOLDS);
        assert_true(answers[i].prediction.holds && answers[i].prediction.force > 0);
        assert_string_equal(prediction_reason(&answers[i]), "");
    }
    assert_int_equal(predict_energy(&p, &closing, &alone, NULL), STATUS_OK);
    check_close(answers[PREDICTOR_ENERGY].prediction.force, alone.force, 0);
    assert_string_equal(answers[PREDICTOR_IMPACT_QUADRATIC].name, "impact_quadratic");
}

static void an_arm_that_moves_away_does_not_hold(void **state)
{
    (void)state;
    parameters p = fixture_parameters(NULL);
    const three_body_state away = {{0.1136, 0.1136, 0.0864}, {-1, -1, -1}};
    const double back[2] = {-1, -1};
    prediction_answer answers[PREDICTOR_COUNT];
    predict_all(&(prediction_question){&p, away, links, back}, answers);
    for (int i = 0; i < PREDICTOR_COUNT; i++) {
        assert_int_equal(answers[i].outcome, PREDICTION_LOST);
        assert_true(prediction_known(&answers[i]) && !answers[i].prediction.holds);
    }
}

static void the_linearised_arm_says_what_it_lacks(void **state)
{
    (void)state;
    parameters p = fixture_parameters(NULL), printed;
    parameters_defaults(&printed, ARM_PRINTED);
    assert_int_equal(parameters_resolve(&printed, NULL), STATUS_OK);

    prediction_answer answer =
        predict_with(PREDICTOR_LINEARISED, &(prediction_question){&p, closing, NULL, NULL});
    assert_int_equal(answer.outcome, PREDICTION_LINKS_UNKNOWN);
    answer =
        predict_with(PREDICTOR_LINEARISED, &(prediction_question){&printed, closing, links, rates});
    assert_int_equal(answer.outcome, PREDICTION_CORRECTED_ONLY);
    assert_false(prediction_known(&answer));
    assert_true(isnan(answer.prediction.force));
}

static void a_state_that_is_not_finite_fails_with_a_sentence(void **state)
{
    (void)state;
    parameters p = fixture_parameters(NULL);
    three_body_state bad = closing;
    bad.velocity[2] = (double)NAN;
    prediction_answer answer =
        predict_with(PREDICTOR_ENERGY, &(prediction_question){&p, bad, links, rates});
    assert_int_equal(answer.outcome, PREDICTION_FAILED);
    assert_int_equal(answer.fault.code, STATUS_NOT_FINITE);
    assert_ptr_equal(prediction_reason(&answer), answer.fault.text);
    assert_true(isnan(answer.prediction.force) && isnan(answer.prediction.delay));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_predictor_answers_for_the_corrected_arm),
        cmocka_unit_test(an_arm_that_moves_away_does_not_hold),
        cmocka_unit_test(the_linearised_arm_says_what_it_lacks),
        cmocka_unit_test(a_state_that_is_not_finite_fails_with_a_sentence),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
