// One question to all predictors: which answer, and why the others do not.

#include "tests/arm_fixture.h"

// The arm just before it touches a wall at 0.1 rad, bent back and turning towards it.
static const three_body_state closing = {{0.1136, 0.1136, 0.0864}, {0.585, 0.585, 0.9}};
static const double links[2] = {0.1136, 0.0864}, rates[2] = {0.585, 0.9};

TEST(every_predictor_answers_for_the_corrected_arm)
{
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

// A wall that throws back takes 1 + e times the plastic impulse, as the run does, and no
// touch holds; the printed equations know no restitution, nor does an impact below the
// rest rule's speed.
TEST(a_rebound_is_no_touch_that_holds)
{
    const char *const bounces[] = {"wall.restitution=0.5", "wall.angle=0.1", NULL};
    parameters p = fixture_parameters(bounces);
    prediction_answer answers[PREDICTOR_COUNT];
    predict_all(&(prediction_question){&p, closing, links, rates}, answers);
    parameters dead = p;
    dead.wall.restitution = 0;
    prediction plastic;
    assert_int_equal(predict_impact_dynamics(&dead, &closing, &plastic, NULL), STATUS_OK);
    for (int i = 0; i < PREDICTOR_COUNT; i++) {
        assert_int_equal(answers[i].outcome, PREDICTION_LOST);
        assert_true(!answers[i].prediction.holds);
        if (i != PREDICTOR_ENERGY) {
            check_relative(answers[i].prediction.impulse, 1.5 * plastic.impulse, 1e-7);
        }
    }

    // the run's own, at the state before it
    KEPT_RUN(r) = run_arm(p, true);
    const sample *row = row_before_landing(&r);
    const three_body_state before = row_bodies(row);
    DONE(predict_impact_dynamics(&p, &before, &plastic, &f));
    check_relative(plastic.impulse, r.summary.contact_impulse_Ns, 1e-6);

    p.method.rest_speed = 1;
    assert_int_equal(predict_with(PREDICTOR_IMPACT_DYNAMICS,
                                  &(prediction_question){&p, closing, links, rates})
                         .outcome,
                     PREDICTION_HOLDS);
}

TEST(an_arm_that_moves_away_does_not_hold)
{
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
    assert_int_equal(predict_with(PREDICTOR_IMPACT_QUADRATIC, &told).outcome,
                     PREDICTION_LOST);
}

TEST(the_linearised_arm_says_what_it_lacks)
{
    const parameters p = fixture_parameters(NULL),
                     printed = parameters_with("arm.model=printed");

    prediction_answer answer =
        predict_with(PREDICTOR_LINEARISED,
                     &(prediction_question){&p, closing, NULL, NULL});
    assert_int_equal(answer.outcome, PREDICTION_LINKS_UNKNOWN);
    answer = predict_with(PREDICTOR_LINEARISED,
                          &(prediction_question){&printed, closing, links, rates});
    assert_int_equal(answer.outcome, PREDICTION_CORRECTED_ONLY);
    assert_false(prediction_known(&answer));
    assert_true(isnan(answer.prediction.force));
}

TEST(a_state_that_is_not_finite_fails_with_a_sentence)
{
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
    answer = predict_with(
        PREDICTOR_IMPACT_DYNAMICS,
        &(prediction_question){&p, bad, links, rates, {1, at, volts}, false});
    assert_int_equal(answer.outcome, PREDICTION_FAILED);
    assert_int_equal(answer.fault.code, STATUS_NOT_FINITE);
}

// The force that a predictor says for commands from the touch on.
static prediction predicted(predictor which, int count, const double *times,
                            const double *volts)
{
    parameters p = fixture_parameters(NULL);
    prediction_question question = {&p,   closing, links, rates, {count, times, volts},
                                    false};
    prediction_answer answer = predict_with(which, &question);
    fail_if(answer.outcome != PREDICTION_HOLDS, "%s: %s", answer.name,
            prediction_reason(&answer));
    return answer.prediction;
}

TEST(commands_after_the_touch_count_while_it_lasts)
{
    const parameters p = fixture_parameters(NULL);
    const double v = p.motor.voltage;
    for (int which = PREDICTOR_IMPACT_DYNAMICS; which <= PREDICTOR_LINEARISED; which++) {
        const prediction plain = predicted(which, 0, NULL, NULL);

        // the voltage there is, told once more, and another one when the peak is over
        const double late[] = {0, 2 * plain.delay}, same[] = {v, 10};
        const double told = predicted(which, 1, late, same).force;
        check_relative(told, plain.force,
                       2e-3); // the linearised arm then follows friction, too
        if (which !=
            PREDICTOR_LINEARISED) { // which looks on until the arm leaves the wall
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

// A command acts from its own instant on, not from that of the next sample, a tenth of a
// radian later: the later more voltage comes, by half a millisecond each time, the less
// the arm presses.
TEST(a_command_counts_from_its_own_instant)
{
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

TEST(who_cannot_answer_says_why)
{
    const struct {
        const char *const *settings;
        predictor which;
        prediction_outcome outcome;
    } cases[] = {
        {given("wall.contact=kelvin-voigt"), PREDICTOR_ENERGY,
         PREDICTION_RIGID_WALL_ONLY},
        {given("arm.tip_mass=0.1"), PREDICTOR_IMPACT_DYNAMICS, PREDICTION_BARE_TIP_ONLY},
        {given("arm.links=3 arm.joint_stiffness=5,9"), PREDICTOR_IMPACT_QUADRATIC,
         PREDICTION_EQUAL_LINKS_ONLY},
        {given("arm.stiffening=10"), PREDICTOR_ENERGY, PREDICTION_EQUAL_LINKS_ONLY},
        {given("arm.links=3 arm.modal_ratios=0.1,0.2"), PREDICTOR_ENERGY,
         PREDICTION_EQUAL_LINKS_ONLY},
        {given("arm.air_drag=0.1"), PREDICTOR_ENERGY, PREDICTION_EQUAL_LINKS_ONLY},
        {given("motor.current_limit=1"), PREDICTOR_ENERGY, PREDICTION_UNLIMITED_ONLY},
        {given("motor.current_limit=1 motor.inductance=1e-3"), PREDICTOR_IMPACT_DYNAMICS,
         PREDICTION_UNLIMITED_ONLY},
    };
    for (EACH(c, cases)) {
        parameters p = fixture_parameters(c->settings);
        prediction_question question = {.parameters = &p, .bodies = closing};
        prediction_answer answer = predict_with(c->which, &question);
        assert_int_equal(answer.outcome, c->outcome);
        assert_true(strlen(prediction_reason(&answer)) > 10);
        assert_true(isnan(answer.prediction.force));
    }

    // an amplifier that controls its current needs no limit
    parameters drive =
        parameters_with("motor.drive=current motor.current_limit=5 motor.voltage=1");
    prediction_question limited = {.parameters = &drive, .bodies = closing};
    assert_int_equal(predict_with(PREDICTOR_ENERGY, &limited).outcome, PREDICTION_HOLDS);

    // energy has no time over which a command could act
    const double at[] = {0}, volts[] = {1};
    parameters p = fixture_parameters(NULL);
    prediction_question question = {&p, closing, links, rates, {1, at, volts}, false};
    assert_int_equal(predict_with(PREDICTOR_ENERGY, &question).outcome,
                     PREDICTION_KNOWS_NO_TIME);
}

// The row of a run that is asked about: none where it begins in contact, and of the
// printed model what three bodies tell.
TEST(the_row_before_landing_is_asked_about)
{
    const double none[1] = {0};
    const sample on_the_wall = {.contact = 1}, struck = {.impulse = 0.1};
    for (int i = 0; i < 4; i++) {
        KEPT_RUN(given) = {.landing = {.time = i / 2}};
        trace_init(&given.trace, 1);
        assert_null(row_before_landing(&given));
        assert_int_equal(trace_add_row(&given.trace, i % 2 == 0 ? &on_the_wall : &struck,
                                       none, none),
                         STATUS_OK);
        assert_null(row_before_landing(&given));
    }

    const scenario s = {.name = (char *)"printed",
                        .parameters = parameters_with("arm.model=printed")};
    prediction_answer answers[PREDICTOR_COUNT];
    KEPT_RUN(r) = run_done(&s, true);
    assert_true(isnan(r.landing.before.angle[0]));
    assert_non_null(predict_first_contact(&s, &r, NULL, answers));
    assert_int_equal(answers[PREDICTOR_LINEARISED].outcome, PREDICTION_CORRECTED_ONLY);
    assert_true(answers[PREDICTOR_ENERGY].prediction.force > 0);
}

// A run up to its first contact and on, and what the predictors say of that.
static run_result predicted_run(scenario *s, prediction_answer answers[PREDICTOR_COUNT])
{
    s->name = (char *)"run";
    run_result r = run_done(s, true);
    assert_non_null(predict_first_contact(s, &r, NULL, answers));
    return r;
}

// The current of a motor with inductance is followed through the pulse, at its limit,
// too; what leaves it out says how much that is.
TEST(a_current_that_lags_is_followed)
{
    static const char *const lags[] = {"motor.inductance=5e-3", "motor.inductance=0.5",
                                       "motor.inductance=2", "motor.inductance=20"};
    static const char *const limits[] = {"motor.current_limit=0",
                                         "motor.current_limit=0.15"};
    static const char *const arms[] = {"arm.links=2", "arm.links=1", "arm.links=3",
                                       "arm.hub_joint=beam"};
    static const char *const walls[] = {"wall.kind=point", "wall.kind=plane",
                                        "wall.contact=kelvin-voigt"};
    int held = 0;
    for (int i = 0; i < 4 * 2 * 4 * 3; i++) {
        scenario s = {.parameters = parameters_with("%s %s %s %s run.duration=3",
                                                    lags[i % 4], limits[i / 4 % 2],
                                                    arms[i / 8 % 4], walls[i / 32])};
        prediction_answer answers[PREDICTOR_COUNT];
        KEPT_RUN(r) = predicted_run(&s, answers);
        const prediction_answer *own = &answers[PREDICTOR_LINEARISED];
        if (own->outcome == PREDICTION_HOLDS) {
            check_relative(own->prediction.force, r.landing.peak, 0.01);
            held++;
        } else {
            assert_true(own->outcome == PREDICTION_DOUBTFUL || isnan(r.landing.peak));
            assert_int_equal(isnan(r.landing.peak), isnan(r.landing.time_to_peak));
        }

        // what follows at once is the other side of the change
        scenario direct = s;
        direct.parameters.motor.inductance = 0;
        prediction_answer at_once[PREDICTOR_COUNT];
        assert_non_null(predict_first_contact(&direct, &r, NULL, at_once));
        const double change =
            own->prediction.force - at_once[PREDICTOR_LINEARISED].prediction.force;
        for (predictor which = 0; which < PREDICTOR_COUNT; which++) {
            const prediction_answer *answer = &answers[which];
            assert_true(isnan(at_once[which].prediction.inductance));
            assert_string_equal(at_once[which].note, "");
            if (which == PREDICTOR_LINEARISED || answer->outcome != PREDICTION_HOLDS) {
                assert_string_equal(answer->note, "");
                continue;
            }
            assert_true(answer->prediction.inductance == change ||
                        (isnan(change) && isnan(answer->prediction.inductance)));
            assert_non_null(
                strstr(prediction_reason(answer), "without the motor's inductance"));
            check_close(answer->prediction.force, at_once[which].prediction.force, 0);
        }
    }
    assert_true(held >= 70);
}

// An arm that starts on the wall and swings off is asked about where it comes back.
TEST(an_arm_that_starts_on_the_wall_is_asked_about_when_it_returns)
{
    static const char *const starts[][3] = {
        {"wall.contact=rigid", "motor.voltage=1", "initial.velocity=0"},
        {"wall.contact=kelvin-voigt", "motor.voltage=1", "initial.velocity=0"},
        {"wall.contact=kelvin-voigt", "motor.voltage=2", "initial.velocity=0.5"},
        {"wall.contact=hunt-crossley", "motor.voltage=2", "initial.velocity=0.5"}};
    int held = 0;
    for (int i = 0; i < 4 * 2; i++) {
        const char *const *start = starts[i / 2];
        scenario s = {.parameters =
                          parameters_with("%s %s %s wall.angle=0 run.duration=3 %s",
                                          start[0], start[1], start[2],
                                          i % 2 ? "arm.links=3" : "arm.links=2")};
        prediction_answer answers[PREDICTOR_COUNT];
        KEPT_RUN(r) = predicted_run(&s, answers);
        const sample *row = row_before_landing(&r);
        assert_true(row->contact == 0 && row->gap < 1e-9 && row->time > 0);
        check_close(row->time, r.landing.time, 1e-12);
        const prediction *own = &answers[PREDICTOR_LINEARISED].prediction;
        if (answers[PREDICTOR_LINEARISED].outcome == PREDICTION_HOLDS) {
            check_relative(own->force, r.landing.peak, 0.01);
            check_close(own->impulse, r.landing.impulse, 1e-9);
            held++;
        }

        // the run's own peaks are the larger ones, and stay those of all of it
        const bool from_start = r.summary.first_contact_s == 0;
        assert_true(from_start || r.summary.first_contact_s == r.landing.time);
        assert_true(isnan(r.landing.peak) || r.summary.peak_force_N >= r.landing.peak);
        assert_true(!(r.summary.first_pulse_peak_N > r.summary.peak_force_N));
        double largest = 0;
        for (EACH_ROW(one, &r.trace)) {
            largest = fmax(largest, one->force);
        }
        check_below(largest, r.summary.peak_force_N * (1 + 1e-12));
    }
    assert_true(held >= 5);
}
