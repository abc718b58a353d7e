// Lists of joint stiffnesses and link lengths: their notation, what contradicts them, and
// what they make of the arm.

#include "src/arm/modes.h"
#include "src/predict/predictors.h"
#include "tests/arm_fixture.h"

static const char *set_list(parameters *p, const char *path, const char *text, fault *f)
{
    static char list[PARAMETER_VALUE_SIZE];
    parameters_defaults(p, ARM_CORRECTED);
    *f = (fault){0};
    parameter_set_text(p, parameter_index(path), text, f);
    parameter_format(p, parameter_index(path), list, sizeof list);
    return list;
}

TEST(lists_are_written_in_one_way)
{
    parameters p;
    fault f;
    for (EACH_TEXT(c, "10,12.5,9", "10, 12.5, 9", "[10, 12.5, 9]", " [ 10 ,12.5 , 9 ] ",
                   "1e1,12.50,9.", "10 N m/rad, 12.5, 9")) {
        assert_string_equal(set_list(&p, "arm.joint_stiffness", *c, &f), "10, 12.5, 9");
    }

    // every bit comes back, and the empty list is none
    double numbers[PARAMETER_LIST_MOST];
    set_list(&p, "arm.link_lengths", "0.1,0.30000000000000004,0.7000000000000001", &f);
    assert_int_equal(parameter_list_numbers(p.arm.link_lengths, numbers), 3);
    check_close(numbers[1], 0.30000000000000004, 0);
    check_close(numbers[2], 0.7000000000000001, 0);
    assert_string_equal(set_list(&p, "arm.joint_stiffness", "[]", &f), "");
    assert_int_equal(parameter_list_numbers(p.arm.joint_stiffness, numbers), 0);
}

static void check_refused(const char *path, const char *text, const char *expected)
{
    parameters p;
    fault f;
    assert_string_equal(set_list(&p, path, text, &f), "");
    fail_if(f.code == STATUS_OK || strstr(f.text, expected) == NULL,
            "%s = %s gave '%s', expected '%s'", path, text, f.text, expected);
    assert_string_equal(f.path, path);
}

TEST(what_is_no_list_of_its_numbers_is_refused)
{
    check_refused("arm.joint_stiffness", "10,-1,9", "-1 is out of range");
    check_refused("arm.joint_stiffness", "10,stiff,9", "'stiff' is not a number");
    check_refused("arm.joint_stiffness", "10,,9", "number 2 is missing");
    check_refused("arm.joint_stiffness", "10,9,", "number 3 is missing");
    check_refused("arm.joint_stiffness", "10 m,9", "expected N m/rad");
    check_refused("arm.joint_stiffness", "10,nan", "not finite");
    check_refused("arm.joint_stiffness", "10 12", "expected N m/rad");
    check_refused("arm.link_lengths", "0.5,0", "0 is out of range");
    check_refused("arm.link_lengths", "[0.5", "'[0.5' is not a number");
    static char many[2 * PARAMETER_LIST_MOST + 2] = "1";
    for (int k = 0; k < PARAMETER_LIST_MOST; k++) {
        strcat(many, ",1");
    }
    check_refused("arm.link_lengths", many, "at most 128 numbers and 1023 characters");
    check_refused("arm.modal_ratios", "0.1,-0.1", "-0.1 is out of range");
}

// Of a beam in one link only the root bends, and k2 is that spring.
TEST(one_link_bends_at_its_root_alone)
{
    parameters one =
        parameters_with("arm.links=1 arm.hub_joint=beam arm.joint_stiffness=5");
    assert_true(parameters_even_links(&one.arm));
    check_close(one.arm.k2, 5, 1e-12);
    check_close(one.arm.k1, 5, 1e-12);
}

// What follows from others does not change by itself during a run.
TEST(what_follows_from_others_may_not_change)
{
    fault f;
    parameters beam = parameters_with("arm.hub_joint=beam");
    parameters spring = parameters_with("arm.hub_joint=spring");
    parameters list = parameters_with("arm.joint_stiffness=10");
    assert_int_equal(parameter_may_change(&beam, PARAMETER_INDEX(arm.k1), &f),
                     STATUS_BAD_SCENARIO);
    assert_string_equal(f.path, "arm.k1");
    assert_int_equal(parameter_may_change(&spring, PARAMETER_INDEX(arm.k1), &f),
                     STATUS_OK);
    assert_int_equal(parameter_may_change(&beam, PARAMETER_INDEX(arm.k2), &f), STATUS_OK);
    assert_int_equal(parameter_may_change(&list, PARAMETER_INDEX(arm.k2), &f),
                     STATUS_BAD_SCENARIO);
    assert_int_equal(parameter_may_change(&list, PARAMETER_INDEX(arm.EI), &f),
                     STATUS_BAD_SCENARIO);
}

static void check_same_bytes(const char *const *settings, const char *const *listed)
{
    KEPT_RUN(one) = run_arm(fixture_parameters(settings), true),
    other = run_arm(fixture_parameters(listed), true);
    assert_int_equal(one.trace.row_count, other.trace.row_count);
    assert_memory_equal(one.trace.rows, other.trace.rows,
                        one.trace.row_count * sizeof *one.trace.rows);
    assert_true(one.summary.contact_impulse_Ns > 0);
}

TEST(equal_numbers_are_the_uniform_arm_to_the_last_bit)
{
    check_same_bytes(given("arm.k2=7"), given("arm.joint_stiffness=7"));
    check_same_bytes(given("arm.links=4 arm.k2=5 wall.kind=plane"),
                     given("arm.links=4 arm.joint_stiffness=10,10,10 wall.kind=plane "
                           "arm.link_lengths=0.25,0.25,0.25,0.25"));
    check_same_bytes(
        given("arm.links=4 arm.k2=5 arm.hub_joint=beam"),
        given("arm.links=4 arm.joint_stiffness=20,10,10,10 arm.hub_joint=beam"));
}

// Lists that differ from the uniform arm by nothing that counts.
TEST(the_general_way_meets_the_uniform_one)
{
    KEPT_RUN(one) =
        run_arm(fixture_parameters(given("arm.links=4 arm.k2=5 run.duration=0.33")),
                true);
    KEPT_RUN(other) = run_arm(
        fixture_parameters(given(
            "arm.links=4 arm.joint_stiffness=10,10.000000000001,10 run.duration=0.33")),
        true);
    check_relative(other.summary.first_contact_s, one.summary.first_contact_s, 1e-12);
    check_relative(other.summary.contact_impulse_Ns, one.summary.contact_impulse_Ns,
                   1e-10);
    check_relative(other.summary.first_pulse_peak_N, one.summary.first_pulse_peak_N,
                   1e-9);
    check_below(fabs(other.summary.energy_residual_J), 1e-11);
}

// A tip load on the held arm: the sum of lever^2/stiffness over the joints.
static double tip_compliance(const char *const *settings)
{
    parameters p = fixture_parameters(settings);
    double length[PARAMETER_LIST_MOST], stiffness[PARAMETER_LIST_MOST], lever = 0,
                                                                        sum = 0;
    parameters_link_lengths(&p.arm, length);
    parameters_joint_stiffness(&p.arm, stiffness);
    for (int k = p.arm.links - 1; k >= (p.arm.hub_joint == HUB_BEAM ? 0 : 1); k--) {
        lever += length[k];
        sum += lever * lever / stiffness[k];
    }
    return sum;
}

TEST(k2_of_a_list_bends_the_same_under_a_tip_load)
{
    static const char *const hubs[] = {"arm.hub_joint=rigid", "arm.hub_joint=beam"};
    for (int hub = 0; hub < 2; hub++) {
        const char *const list =
            hub ? "arm.joint_stiffness=30,12,9,14" : "arm.joint_stiffness=12,9,14";
        const char *const *listed =
            given("arm.links=4 %s %s arm.link_lengths=0.2,0.3,0.25,0.25", hubs[hub],
                  list);
        check_relative(tip_compliance(given("arm.links=4 %s arm.k2=%.17g", hubs[hub],
                                            fixture_parameters(listed).arm.k2)),
                       tip_compliance(listed), 1e-13);
    }

    // a beam cut into unequal links has its joints from the middles of two links
    parameters p = parameters_with(
        "arm.links=3 arm.EI=2 arm.hub_joint=beam arm.link_lengths=0.2,0.3,0.5");
    double stiffness[PARAMETER_LIST_MOST];
    parameters_joint_stiffness(&p.arm, stiffness);
    check_relative(stiffness[0], 2 / 0.1, 1e-15);
    check_relative(stiffness[1], 2 / 0.25, 1e-15);
    check_relative(stiffness[2], 2 / 0.4, 1e-15);
    check_relative(p.arm.k1, 2 / 0.1, 1e-15);
    check_relative(p.arm.length, 1.0, 1e-15);
}

// The same beam cut otherwise: the first clamped frequency goes to Euler and Bernoulli's.
TEST(a_beam_cut_into_unequal_links_converges)
{
    double off[2];
    for (int i = 0; i < 2; i++) {
        const int n = 10 << i;
        char lengths[PARAMETER_VALUE_SIZE] = "arm.link_lengths=";
        for (int k = 0; k < n; k++) { // coarse at the hub, fine at the tip
            const size_t used = strlen(lengths);
            snprintf(lengths + used, sizeof lengths - used, "%s%g", k > 0 ? "," : "",
                     k < n / 2 ? 1.2 / n : 0.8 / n);
        }
        parameters p = parameters_with("arm.links=%d %s arm.hub_joint=beam", n, lengths);
        arm a = arm_of(&p);
        assert_true(a.uneven);
        const double x = 1.875104068711961, w = modes_of(&a, HUB_LOCKED, TIP_FREE).w[0];
        off[i] = w / (x * x * sqrt(p.arm.EI / p.arm.mass)) - 1;
    }
    print_message("first mode off by %.2e and %.2e, order %.3f\n", off[0], off[1],
                  log2(off[0] / off[1]));
    check_close(log2(off[0] / off[1]), 2, 0.1);
}

// What the thesis's two links do not know is refused by its own sentence, one of them at
// a time.
TEST(the_thesiss_predictors_say_what_they_do_not_know)
{
    const struct {
        const char *given;
        prediction_outcome thesis;
        bool linearised; // takes it
    } cases[] = {
        {"arm.tilt=0.1", PREDICTION_LEVEL_ONLY, true},
        {"arm.tip_mass=0.1", PREDICTION_BARE_TIP_ONLY, true},
        {"arm.air_drag=0.1", PREDICTION_EQUAL_LINKS_ONLY, true},
        {"arm.stiffening=2", PREDICTION_EQUAL_LINKS_ONLY, true},
        {"motor.current_limit=2", PREDICTION_UNLIMITED_ONLY, true},
        {"wall.contact=hunt-crossley", PREDICTION_RIGID_WALL_ONLY, true},
        {"wall.motion=sine wall.kind=plane", PREDICTION_STILL_WALL_ONLY, false},
    };
    for (EACH(c, cases)) {
        parameters p = fixture_parameters(given("%s", c->given));
        const double q[2] = {0.1, 0.1}, w[2] = {0.6, 0.6};
        const prediction_question question = {.parameters = &p,
                                              .bodies = {{0.1, 0.1, 0.1},
                                                         {0.6, 0.6, 0.6}},
                                              .angles = q,
                                              .velocities = w};
        for (predictor which = 0; which < PREDICTOR_COUNT; which++) {
            const prediction_answer answer = predict_with(which, &question);
            const bool known = which == PREDICTOR_LINEARISED && c->linearised;
            fail_if(known ? !prediction_known(&answer) : answer.outcome != c->thesis,
                    "%s, %s: %s", c->given, answer.name, prediction_reason(&answer));
        }
    }
}

// The linearised arm takes any links and joints, the thesis's two links say that they do
// not.
TEST(predictors_take_lists_or_say_so)
{
    parameters p = parameters_with(
        "arm.links=3 arm.joint_stiffness=8,5 arm.link_lengths=0.4,0.35,0.25");
    const double q[3] = {0.1, 0.1, 0.1}, w[3] = {0.6, 0.6, 0.6};
    const prediction_question question = {.parameters = &p,
                                          .bodies = {{0.1, 0.1, 0.1}, {0.6, 0.6, 0.6}},
                                          .angles = q,
                                          .velocities = w};
    for (predictor which = 0; which < PREDICTOR_COUNT; which++) {
        const prediction_answer answer = predict_with(which, &question);
        if (which != PREDICTOR_LINEARISED) {
            assert_int_equal(answer.outcome, PREDICTION_EQUAL_LINKS_ONLY);
            continue;
        }
        assert_int_equal(answer.outcome, PREDICTION_HOLDS);

        // against the run from there
        KEPT_RUN(r) = run_arm(
            fixture_parameters(given(
                "arm.links=3 arm.joint_stiffness=8,5 arm.link_lengths=0.4,0.35,0.25 "
                "initial.angle=0.1 initial.velocity=0.6 run.duration=0.3")),
            true);
        check_relative(answer.prediction.force, r.summary.first_pulse_peak_N, 0.01);
        check_relative(answer.prediction.impulse, r.summary.contact_impulse_Ns, 1e-6);
    }
}
