// The exam of control laws: cases that nobody chose, judged by bounds.
#include "src/study/robust/law_exam.h"

#include "tests/scenario_fixture.h"

enum { SEEDS = 400 };

// The exam of the scenario's own law and force-pd, at 1 N and 3 N. Verdicts and shares
// are asked for by law 0 or 1 and force 0 or 1.
static law_exam examined(const scenario *s, size_t cases, uint64_t seed)
{
    law_exam e;
    const exam_request asked = {.base = s,
                                .laws = {s->parameters.control.law, LAW_FORCE_PD},
                                .law_count = 2,
                                .forces = {1, 3},
                                .force_count = 2,
                                .cases = cases,
                                .seed = seed};
    DONE(law_exam_run(&e, &asked, &(exam_options){.jobs = 2}, &f));
    return e;
}

// Whether two settings "path=value" set the same parameter.
static bool same_path(const char *a, const char *b)
{
    const size_t length = strcspn(a, "=");
    return length == strcspn(b, "=") && memcmp(a, b, length) == 0;
}

// Two or three errors, none of which sets what another one does, and a seed of its own.
TEST(errors_of_a_case_exclude_one_another)
{
    KEPT_SCENARIO(s) = shipped("compare/observer");
    int threes = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        const drawn_case c = drawn_case_of(&s, seed);
        assert_in_range(c.error_count, 2, 3);
        threes += c.error_count == 3;
        for (int i = 0; i < c.setting_count; i++) {
            for (int k = 0; k < i; k++) {
                fail_if(same_path(c.settings[i], c.settings[k]), "seed %d: %s and %s",
                        (int)seed, c.settings[k], c.settings[i]);
            }
        }
    }

    // three errors in half of the cases, within five standard deviations sqrt(n)/2
    check_close(threes, SEEDS / 2, 5 * sqrt(SEEDS) / 2);
}

// Every kind of error is drawn, and its value lies around the scenario's own: an arm of 2
// m within a quarter of its length, the arm before the wall at 0.3 rad.
TEST(errors_are_drawn_around_the_scenario)
{
    KEPT_SCENARIO(s) =
        shipped_with("compare/observer", "arm.length=2 wall.angle=0.3 initial.angle=0");
    bool drawn[LAW_ERRORS] = {false};
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        const drawn_case c = drawn_case_of(&s, seed);
        scenario derived;
        action room;
        DONE(drawn_case_scenario(&derived, &s, &c, true, &room, &f));
        for (int i = 0; i < c.error_count; i++) {
            drawn[c.errors[i]] = true;
        }
        const double length = derived.parameters.arm.length;
        assert_true(length >= 1.5 && length <= 2.5);
        assert_true(derived.parameters.initial.angle < 0.3);
        assert_int_equal(derived.action_count, c.push != 0 ? 1 : 0);
    }
    for (int kind = 0; kind < LAW_ERRORS; kind++) {
        fail_if(!drawn[kind], "'%s' is never drawn", law_error_name(kind));
    }
}

// A rate of the controller and a jitter of its sampling are drawn independently. In every
// case the jitter is at most the period, and in some cases it is nearly as long.
TEST(a_jitter_stays_within_the_period)
{
    KEPT_SCENARIO(s) = shipped("compare/observer");
    int both = 0;
    for (uint64_t seed = 5000; seed < 9000; seed++) {
        const drawn_case c = drawn_case_of(&s, seed);
        scenario derived;
        action room;
        DONE(drawn_case_scenario(&derived, &s, &c, true, &room, &f));
        const control_parameters *control = &derived.parameters.control;
        assert_true(control->jitter * control->rate <= 1);
        both += control->jitter * control->rate > 0.99;
    }
    assert_true(both > 0);
}

// A push comes among the actions of the scenario, in the order of time.
TEST(pushes_keep_the_actions_of_the_scenario)
{
    KEPT_SCENARIO(s) = shipped("corrected/push-in-contact");
    assert_true(s.action_count > 0);
    const drawn_case c = {.push = 0.02, .push_time = 1e-3};
    action *actions = calloc((size_t)s.action_count + 1, sizeof *actions);
    scenario derived;
    DONE(drawn_case_scenario(&derived, &s, &c, true, actions, &f));
    assert_int_equal(derived.action_count, s.action_count + 1);
    for (int i = 1; i < derived.action_count; i++) {
        assert_true(actions[i - 1].time <= actions[i].time);
    }
    DONE(drawn_case_scenario(&derived, &s, &c, false, actions, &f));
    assert_int_equal(derived.action_count, s.action_count);
    free(actions);
}

// A scenario that does not say how long it lasts gives its pushes the time that they
// take.
TEST(cases_last_until_their_push_is_over)
{
    scenario s = {.name = "default"};
    parameters_defaults(&s.parameters, ARM_CORRECTED);
    s.parameters.control.law = LAW_OBSERVER;
    check_below(s.parameters.run.duration, DRAWN_CASE_DURATION);
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        const drawn_case c = drawn_case_of(&s, seed);
        action room;
        scenario derived;
        DONE(drawn_case_scenario(&derived, &s, &c, true, &room, &f));
        check_close(derived.parameters.run.duration, DRAWN_CASE_DURATION, 0);
    }
}

// The exam's verdict on a case is that of a single run of the case. Forces are in percent
// of the first force, 1 N. Where the case has a push, settling counts from the push (or
// from the contact, if that is later), otherwise from the contact.
TEST(verdicts_are_those_of_single_runs)
{
    KEPT_SCENARIO(s) = shipped("compare/observer");
    SCOPED(law_exam_finish) law_exam e = examined(&s, 12, 20000);
    for (size_t i = 0; i < e.asked.cases; i++) {
        const drawn_case *c = &e.cases[i];
        scenario derived;
        action room;
        DONE(drawn_case_scenario(&derived, &s, c, true, &room, &f));
        KEPT_RUN(run) = run_done(&derived, false);
        const summary *r = &run.summary;
        const exam_verdict *v = law_exam_verdict(&e, 0, 0, i);
        check_close(v->error, 100 * r->steady_error_N, 1e-12);
        check_close(v->separations, r->separations, 0);
        const double end = r->first_contact_s + r->settling_time_s;
        if (!isnan(v->settling) && c->push != 0) {
            const double from = fmax(c->push_time, r->first_contact_s);
            check_close(v->settling, fmax(0, end - from), 1e-12);
        } else if (!isnan(v->settling)) {
            check_close(v->settling, r->settling_time_s, 1e-12);
        } else {
            assert_true(isnan(r->settling_time_s));
        }
        if (c->push == 0) {
            check_close(v->overshoot, 100 * r->smoothed_over_command_N, 1e-12);
        }
    }
}

// The share of the cases within the bounds is a count, over all cases (kind -1) or those
// with one kind of error. Its 95 % interval is Wilson's, with the normal quantile z
// = 1.96; for no case of n it ends at z^2/(n + z^2).
TEST(shares_count_cases)
{
    KEPT_SCENARIO(s) = shipped("compare/observer");
    SCOPED(law_exam_finish) law_exam e = examined(&s, 20, 20000);
    size_t of_kinds = 0, of_errors = 0;
    for (int kind = 0; kind < LAW_ERRORS; kind++) {
        of_kinds += law_exam_share(&e, 0, 0, kind).cases;
    }
    for (size_t i = 0; i < e.asked.cases; i++) {
        of_errors += (size_t)e.cases[i].error_count;
        for (int law = 0; law < 2; law++) {
            e.verdicts[((size_t)law * 2) * e.asked.cases + i].within = false;
        }
    }
    assert_int_equal(of_kinds, of_errors);

    // no case of 20
    const exam_share none = law_exam_share(&e, 0, 0, -1);
    assert_int_equal(none.within, 0);
    check_close(none.low, 0, 1e-15);
    const double z2 = 1.959963984540054 * 1.959963984540054;
    check_close(none.high, z2 / (20 + z2), 1e-14);
}

// Cases with first contact up to 2.5 times as late as open-loop's count apart: those
// which keep all other bounds, told here by the quantities themselves. Of these cases one
// comes later than 1.5 times.
TEST(later_touches_count_apart)
{
    KEPT_SCENARIO(s) = shipped("compare/observer");
    SCOPED(law_exam_finish) law_exam e = examined(&s, 4, 4150);
    size_t later = 0;
    for (size_t i = 0; i < e.asked.cases; i++) {
        const exam_verdict *v = law_exam_verdict(&e, 0, 0, i);
        const double most_settling = v->separations > 0 ? 0.6 : 0.3;
        later += v->overshoot <= 30 && v->settling <= most_settling &&
                 fabs(v->error) <= 5 && v->late <= 2.5;
    }
    assert_int_equal(law_exam_share_later(&e, 0, 0).within, later);
    assert_true(law_exam_share(&e, 0, 0, -1).within < later);
    assert_int_equal(law_exam_share_later(&e, 0, 0).cases, 4);
}

static json_t *member_of_result(json_t *whole, size_t row, const char *key)
{
    json_t *results = json_object_get(whole, "results");
    return json_object_get(json_array_get(results, row), key);
}

// Compared with earlier rows of the same law and cases no case is gained or lost.
// Compared with another law the gained and lost cases are those where the marks of the
// two differ. Rows of an exam of other cases are refused, as are files that hold no exam.
TEST_IN_FOLDER(exams_are_compared_case_by_case)
{
    KEPT_SCENARIO(s) = shipped("compare/observer");
    SCOPED(law_exam_finish) law_exam e = examined(&s, 10, 7);
    json_t *first = law_exam_json(&e, NULL);
    assert_int_equal(json_dump_file(first, "before.json", 0), 0);
    exam_rows rows;
    DONE(exam_rows_read(&rows, "before.json", &e, &f));
    json_t *whole = law_exam_json(&e, &rows);
    const json_t *own = json_array_get(member_of_result(whole, 0, "paired"), 0);
    assert_int_equal(json_integer_value(json_object_get(own, "gained")), 0);
    assert_int_equal(json_integer_value(json_object_get(own, "lost")), 0);
    check_close(json_number_value(json_object_get(own, "low")), 0, 0);

    // row 2 is the second law at the first force
    const char *marks = json_string_value(member_of_result(whole, 0, "within_of_cases"));
    const char *others = json_string_value(member_of_result(whole, 2, "within_of_cases"));
    const json_t *pair = json_array_get(member_of_result(whole, 2, "paired"), 1);
    int gained = 0, lost = 0;
    for (size_t i = 0; i < e.asked.cases; i++) {
        gained += others[i] > marks[i];
        lost += others[i] < marks[i];
    }
    assert_int_equal(json_integer_value(json_object_get(pair, "gained")), gained);
    assert_int_equal(json_integer_value(json_object_get(pair, "lost")), lost);
    check_close(json_number_value(json_object_get(pair, "points")), 10 * (gained - lost),
                1e-12);
    json_decref(whole);
    json_decref(first);
    exam_rows_finish(&rows);

    SCOPED(law_exam_finish) law_exam other = examined(&s, 10, 8);
    REFUSED(STATUS_BAD_ARGUMENT, "10 cases from seed 7, expected 10 from 8",
            exam_rows_read(&rows, "before.json", &other, &f));
    put_file("none.json", "[1, 2");
    REFUSED(STATUS_BAD_ARGUMENT,
            "none.json:1:", exam_rows_read(&rows, "none.json", &other, &f));
    put_file("none.json", "{\"cases\": 10}");
    REFUSED(STATUS_BAD_ARGUMENT, "is no exam of control laws",
            exam_rows_read(&rows, "none.json", &other, &f));
}

// The printed model of the arm excludes some errors: the exam is refused before the first
// run.
TEST(what_cannot_be_drawn_is_told)
{
    KEPT_SCENARIO(s) = shipped("compare/hybrid-printed-arm");
    law_exam e;
    const exam_request asked = {.base = &s,
                                .laws = {s.parameters.control.law},
                                .law_count = 1,
                                .forces = {1},
                                .force_count = 1,
                                .cases = 60,
                                .seed = 1};
    REFUSED(STATUS_BAD_ARGUMENT, "cannot be drawn around compare/hybrid-printed-arm",
            law_exam_run(&e, &asked, &(exam_options){.jobs = 1}, &f));
    law_exam_finish(&e);
}

// The value that a case gives a parameter; the test fails without one.
static double drawn_value(const drawn_case *c, const char *path)
{
    const size_t length = strlen(path);
    for (int i = 0; i < c->setting_count; i++) {
        const char *setting = c->settings[i];
        if (strncmp(setting, path, length) == 0 && setting[length] == '=') {
            return strtod(setting + length + 1, NULL);
        }
    }
    fail_if(true, "no case has %s", path);
    return (double)NAN;
}

// Around a fit the arms of the cases have its errors and correlations: of n draws the
// mean is within five standard errors s/sqrt(n), the deviation within 5 s/sqrt(2 n), the
// correlation r within 5 (1 - r^2)/sqrt(n). The law is told the fitted value of each. No
// case has an error of the arm from the general list.
TEST(arms_around_a_fit_have_its_errors_and_correlations)
{
    static const char text[] = "arm: {k2: 5, hub_inertia: 6e-3}\n"
                               "control: {law: touch, force: 1}\n"
                               "fit:\n"
                               "  arm.k2: [0.04]\n"
                               "  arm.hub_inertia: [3e-5, -0.8]\n";
    KEPT_SCENARIO(s) = good(text);
    enum { DRAWS = 4000 };
    double sum[2] = {0}, square[2] = {0}, product = 0;
    for (uint64_t seed = 0; seed < DRAWS; seed++) {
        const drawn_case c = drawn_case_of(&s, seed);
        const double k2 = drawn_value(&c, "arm.k2");
        const double inertia = drawn_value(&c, "arm.hub_inertia");
        const double off[2] = {(k2 - 5) / 0.04, (inertia - 6e-3) / 3e-5};
        for (int i = 0; i < 2; i++) {
            sum[i] += off[i];
            square[i] += off[i] * off[i];
        }
        product += off[0] * off[1];
        check_close(k2 * drawn_value(&c, "belief.k2_factor"), 5, 1e-7);
        check_close(inertia * drawn_value(&c, "belief.inertia_factor"), 6e-3, 1e-10);
        for (int i = 0; i < c.error_count; i++) {
            const char *kind = law_error_name(c.errors[i]);
            fail_if(strstr(kind, "links") != NULL || strstr(kind, "stiffness") != NULL,
                    "'%s' is drawn around a fit", kind);
        }
    }
    for (int i = 0; i < 2; i++) {
        check_close(sum[i] / DRAWS, 0, 5 / sqrt(DRAWS));
        check_close(sqrt(square[i] / DRAWS), 1, 5 / sqrt(2.0 * DRAWS));
    }
    check_close(product / DRAWS, -0.8, 5 * (1 - 0.64) / sqrt(DRAWS));
}

// Rows of an exam around a fit are not compared with those of another arm.
TEST_IN_FOLDER(exams_around_different_fits_are_not_compared)
{
    KEPT_SCENARIO(s) = good("control: {law: touch, force: 1}\nfit: {arm.k2: [0.04]}\n");
    KEPT_SCENARIO(other) = good("control: {law: touch, force: 1}\n");
    SCOPED(law_exam_finish) law_exam e = examined(&s, 2, 7);
    SCOPED(law_exam_finish) law_exam general = examined(&other, 2, 7);
    json_t *first = law_exam_json(&e, NULL);
    assert_int_equal(json_dump_file(first, "before.json", 0), 0);
    json_decref(first);
    exam_rows rows;
    DONE(exam_rows_read(&rows, "before.json", &e, &f));
    exam_rows_finish(&rows);
    REFUSED(STATUS_BAD_ARGUMENT, "around another fit",
            exam_rows_read(&rows, "before.json", &general, &f));
}
