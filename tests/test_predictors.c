// One question to all predictors: which answer, and why the others do not.
#include "src/run/first_contact.h"
#include "src/run/run.h"

#include <math.h>
#include <string.h>

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
    const double back[2] = {-1, -1}, at[] = {0.01}, volts[] = {1};
    prediction_answer answers[PREDICTOR_COUNT];
    predict_all(&(prediction_question){&p, away, links, back}, answers);
    for (int i = 0; i < PREDICTOR_COUNT; i++) {
        assert_int_equal(answers[i].outcome, PREDICTION_LOST);
        assert_true(prediction_known(&answers[i]) && !answers[i].prediction.holds);
    }

    // for any later command
    const prediction_question told = {&p, away, links, back, {1, at, volts}, false};
    assert_int_equal(predict_with(PREDICTOR_IMPACT_QUADRATIC, &told).outcome, PREDICTION_LOST);
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

    // so does one that an iteration over commands would begin with
    const double at[] = {0}, volts[] = {1};
    answer = predict_with(PREDICTOR_IMPACT_DYNAMICS,
                          &(prediction_question){&p, bad, links, rates, {1, at, volts}, false});
    assert_int_equal(answer.outcome, PREDICTION_FAILED);
    assert_int_equal(answer.fault.code, STATUS_NOT_FINITE);
}

// The force that a predictor says for commands from the touch on.
static prediction predicted(predictor which, int count, const double *times, const double *volts)
{
    parameters p = fixture_parameters(NULL);
    prediction_question question = {&p, closing, links, rates, {count, times, volts}, false};
    prediction_answer answer = predict_with(which, &question);
    if (answer.outcome != PREDICTION_HOLDS) {
        fail_msg("%s: %s", answer.name, prediction_reason(&answer));
    }
    return answer.prediction;
}

static void commands_after_the_touch_count_while_it_lasts(void **state)
{
    (void)state;
    const parameters p = fixture_parameters(NULL);
    const double v = p.motor.voltage;
    for (int which = PREDICTOR_IMPACT_DYNAMICS; which <= PREDICTOR_LINEARISED; which++) {
        const prediction plain = predicted(which, 0, NULL, NULL);

        // the voltage there is, told once more, and another one when the peak is over
        const double late[] = {0, 2 * plain.delay}, same[] = {v, 10};
        const double told = predicted(which, 1, late, same).force;
        check_relative(told, plain.force, 2e-3); // the linearised arm then follows friction, too
        if (which != PREDICTOR_LINEARISED) {     // which looks on until the arm leaves the wall
            check_relative(predicted(which, 2, late, same).force, told, 1e-6);
        }

        // more voltage presses more, and the earlier it comes
        const double now[] = {0}, half[] = {plain.delay / 2}, more[] = {1.2 * v};
        const double all = predicted(which, 1, now, more).force;
        const double some = predicted(which, 1, half, more).force;
        check_below(told, some);
        check_below(some, all);
    }
}

// A command acts from its own instant on, not from that of the next sample, a tenth of a radian
// later: the later more voltage comes, by half a millisecond each time, the less the arm presses.
static void a_command_counts_from_its_own_instant(void **state)
{
    (void)state;
    enum { STEPS = 24 };
    const parameters p = fixture_parameters(NULL);
    const double more[] = {3 * p.motor.voltage};
    double force[STEPS + 1];
    for (int i = 0; i <= STEPS; i++) {
        const double when[] = {0.02 + 5e-4 * i};
        force[i] = predicted(PREDICTOR_LINEARISED, 1, when, more).force;
    }
    const double usual = (force[0] - force[STEPS]) / STEPS;
    for (int i = 0; i < STEPS; i++) {
        check_below(force[i + 1], force[i] - 0.2 * usual);
    }
}

static void who_cannot_answer_says_why(void **state)
{
    (void)state;
    const struct {
        const char *const *settings;
        predictor which;
        prediction_outcome outcome;
    } cases[] = {
        {SETTINGS("wall.contact=kelvin-voigt"), PREDICTOR_ENERGY, PREDICTION_RIGID_WALL_ONLY},
        {SETTINGS("arm.tip_mass=0.1"), PREDICTOR_IMPACT_DYNAMICS, PREDICTION_BARE_TIP_ONLY},
        {SETTINGS("arm.links=3", "arm.joint_stiffness=5,9"), PREDICTOR_IMPACT_QUADRATIC,
         PREDICTION_EQUAL_LINKS_ONLY},
        {SETTINGS("arm.stiffening=10"), PREDICTOR_ENERGY, PREDICTION_EQUAL_LINKS_ONLY},
        {SETTINGS("arm.links=3", "arm.modal_ratios=0.1,0.2"), PREDICTOR_ENERGY,
         PREDICTION_EQUAL_LINKS_ONLY},
        {SETTINGS("arm.air_drag=0.1"), PREDICTOR_ENERGY, PREDICTION_EQUAL_LINKS_ONLY},
        {SETTINGS("motor.inductance=1e-3"), PREDICTOR_LINEARISED, PREDICTION_CURRENT_AT_ONCE_ONLY},
        {SETTINGS("motor.current_limit=1"), PREDICTOR_ENERGY, PREDICTION_CURRENT_AT_ONCE_ONLY},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        parameters p = fixture_parameters(cases[i].settings);
        prediction_question question = {.parameters = &p, .bodies = closing};
        prediction_answer answer = predict_with(cases[i].which, &question);
        assert_int_equal(answer.outcome, cases[i].outcome);
        assert_true(strlen(prediction_reason(&answer)) > 10);
        assert_true(isnan(answer.prediction.force));
    }

    // an amplifier that controls its current needs no limit
    parameters drive = fixture_parameters(
        SETTINGS("motor.drive=current", "motor.current_limit=5", "motor.voltage=1"));
    prediction_question limited = {.parameters = &drive, .bodies = closing};
    assert_int_equal(predict_with(PREDICTOR_ENERGY, &limited).outcome, PREDICTION_HOLDS);

    // energy has no time over which a command could act
    const double at[] = {0}, volts[] = {1};
    parameters p = fixture_parameters(NULL);
    prediction_question question = {&p, closing, links, rates, {1, at, volts}, false};
    assert_int_equal(predict_with(PREDICTOR_ENERGY, &question).outcome, PREDICTION_KNOWS_NO_TIME);
}

// The row of a run that is asked about: none where it begins in contact, and of the printed model
// what three bodies tell.
static void the_row_before_contact_is_asked_about(void **state)
{
    (void)state;
    const double none[1] = {0};
    const sample on_the_wall = {.contact = 1}, struck = {.impulse = 0.1};
    for (int i = 0; i < 2; i++) {
        trace t;
        trace_init(&t, 1);
        assert_null(row_before_contact(&t));
        assert_int_equal(trace_add_row(&t, i == 0 ? &on_the_wall : &struck, none, none), STATUS_OK);
        assert_null(row_before_contact(&t));
        trace_finish(&t);
    }

    scenario s = {.name = (char *)"printed"};
    parameters_defaults(&s.parameters, ARM_PRINTED);
    assert_int_equal(parameters_resolve(&s.parameters, NULL), STATUS_OK);
    run_result r;
    prediction_answer answers[PREDICTOR_COUNT];
    assert_int_equal(run_scenario(&s, true, &r), STATUS_OK);
    assert_null(r.before_impact);
    assert_non_null(predict_first_contact(&s, &r, NULL, answers));
    assert_int_equal(answers[PREDICTOR_LINEARISED].outcome, PREDICTION_CORRECTED_ONLY);
    assert_true(answers[PREDICTOR_ENERGY].prediction.force > 0);
    run_finish(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_predictor_answers_for_the_corrected_arm),
        cmocka_unit_test(an_arm_that_moves_away_does_not_hold),
        cmocka_unit_test(the_linearised_arm_says_what_it_lacks),
        cmocka_unit_test(commands_after_the_touch_count_while_it_lasts),
        cmocka_unit_test(the_row_before_contact_is_asked_about),
        cmocka_unit_test(a_command_counts_from_its_own_instant),
        cmocka_unit_test(who_cannot_answer_says_why),
        cmocka_unit_test(a_state_that_is_not_finite_fails_with_a_sentence),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
