// The varied values of a sweep: grids, lists, random values; invalid requests.
#include "tests/sweep_fixture.h"

TEST(the_last_parameter_of_a_grid_changes_fastest)
{
    SWEPT(s, SWEEP_GRID, 0, "motor.voltage=1:2:3", "method.name=event,newmark");
    static const double voltage[] = {1, 1, 1.5, 1.5, 2, 2};
    assert_int_equal(s.run_count, 6);
    for (size_t run = 0; run < 6; run++) {
        scenario derived;
        DONE(sweep_scenario(&s, run, &derived, &f));
        check_close(derived.parameters.motor.voltage, voltage[run], 0);
        assert_int_equal(derived.parameters.method.name,
                         run % 2 ? METHOD_NEWMARK : METHOD_EVENT);
        check_close(derived.parameters.run.duration, 0.6, 0);
    }
}

TEST(ranges_meet_their_ends_and_are_spaced_as_asked)
{
    SWEPT(s, SWEEP_GRID, 0, "arm.k2=0.1:0.7:7", NULL);
    check_close(sweep_value(&s, 0, 0), 0.1, 0);
    check_close(sweep_value(&s, 6, 0), 0.7, 0);
    check_close(sweep_value(&s, 2, 0), 0.3, 1e-16);
    sweep_finish(&s);
    must_sweep(&s, SWEEP_GRID, 0, "arm.k2=1000:0.1:5:log", NULL);
    for (size_t i = 0; i < 5; i++) {
        check_relative(sweep_value(&s, i, 0), pow(10, 3.0 - (double)i), 1e-14);
    }
    check_close(sweep_value(&s, 4, 0), 0.1, 0);
    sweep_finish(&s);
    must_sweep(&s, SWEEP_GRID, 0, "arm.links=2:64:6:log", NULL);
    for (size_t i = 0; i < 6; i++) {
        check_close(sweep_value(&s, i, 0), (double)(2 << i), 0);
    }
    sweep_finish(&s);
    must_sweep(&s, SWEEP_GRID, 0, "motor.voltage=0.5 V:1 V:2", NULL);
    check_close(sweep_value(&s, 0, 0), 0.5, 0);
}

// One number of a list, named with its place from 1 on; the others stay as the scenario
// has them.
TEST(a_number_of_a_list_is_varied_by_its_place)
{
    static const char text[] =
        "title: Springs\narm: {links: 4, joint_stiffness: [12, 10, 8]}\n";
    KEPT_SCENARIO(springs);
    sweep s;
    assert_int_equal(scenario_parse(&springs, text, strlen(text), "springs.yaml",
                                    "springs", print_sentence, NULL),
                     STATUS_OK);
    char *vary[] = {(char[]){"arm.joint_stiffness[2]=0.1:0.3:3"},
                    (char[]){"arm.joint_stiffness[3]=7 N m/rad,8.5"}};
    const sweep_request request = {.vary = vary, .vary_count = 2};
    DONE(sweep_init(&s, &springs, &request, &f));
    assert_string_equal(s.axes[0].name, "arm.joint_stiffness[2]");
    assert_string_equal(s.axes[1].text, "7,8.5");

    // every run has its own list, to the last bit
    assert_int_equal(s.run_count, 6);
    for (size_t run = 0; run < s.run_count; run++) {
        scenario derived;
        double numbers[PARAMETER_LIST_MOST];
        DONE(sweep_scenario(&s, run, &derived, &f));
        assert_int_equal(parameter_list_numbers(derived.parameters.arm.joint_stiffness,
                                                numbers),
                         3);
        check_close(numbers[0], 12, 0);
        check_close(numbers[1], sweep_value(&s, run, 0), 0);
        check_close(numbers[2], run % 2 ? 8.5 : 7, 0);
    }
    sweep_finish(&s);

    // a place that the list does not have
    vary[0] = (char[]){"arm.joint_stiffness[4]=5,6"};
    REFUSED(STATUS_BAD_ARGUMENT, "has 3 numbers", sweep_init(&s, &springs, &request, &f));
}

TEST(bad_requests_are_refused_with_a_sentence)
{
    static const struct {
        const char *a, *b;
        sweep_sampling sampling;
        size_t runs;
        const char *says;
    } bad[] = {
        {NULL, NULL, SWEEP_GRID, 0, "--vary"},
        {"motor.voltage", NULL, SWEEP_GRID, 0, "PATH=a:b:n"},
        {"motor.voltage=", NULL, SWEEP_GRID, 0, "no value"},
        {"motor.voltge=1:2:3", NULL, SWEEP_GRID, 0, "did you mean 'motor.voltage'"},
        {"motor.voltage=1:2", NULL, SWEEP_GRID, 0, "a:b:n"},
        {"motor.voltage=1:2:3:4", NULL, SWEEP_GRID, 0, "a:b:n"},
        {"motor.voltage=1:2:3:4:log", NULL, SWEEP_GRID, 0, "a:b:n"},
        {"motor.voltage=1:2:1", NULL, SWEEP_GRID, 0, "'1' is no number of values"},
        {"motor.voltage=1:2:2.5", NULL, SWEEP_GRID, 0, "'2.5'"},
        {"motor.voltage=1:x:3", NULL, SWEEP_GRID, 0, "'x' is not a number"},
        {"motor.voltage=1:2000:3", NULL, SWEEP_GRID, 0, "out of range"},
        {"motor.voltage=1:1:3", NULL, SWEEP_GRID, 0, "two different ends"},
        {"motor.voltage=0:1:3:log", NULL, SWEEP_GRID, 0, "above zero"},
        {"motor.voltage=1,nan", NULL, SWEEP_GRID, 0, "finite"},
        {"motor.voltage=1,2,1", NULL, SWEEP_GRID, 0, "twice"},
        {"motor.voltage=1 m:2:3", NULL, SWEEP_GRID, 0, "expected V"},
        {"motor.voltage=1:2:3", "motor.voltage=4", SWEEP_GRID, 0, "varied twice"},
        {"arm.joint_stiffness=1,2", NULL, SWEEP_GRID, 0, "arm.joint_stiffness[1]"},
        {"arm.joint_stiffness[0]=1,2", NULL, SWEEP_GRID, 0, "no number of a list"},
        {"arm.joint_stiffness[1=1,2", NULL, SWEEP_GRID, 0, "no number of a list"},
        {"arm.joint_stiffness[1]=1,-2", NULL, SWEEP_GRID, 0, "out of range"},
        {"arm.joint_stiffness[1]=1:-2:3", NULL, SWEEP_GRID, 0, "out of range"},
        {"arm.k2[1]=1,2", NULL, SWEEP_GRID, 0, "no list"},
        {"arm.links=1:4:3", NULL, SWEEP_GRID, 0, "not a whole number"},
        {"arm.links=1:4:9:log", NULL, SWEEP_GRID, 0, "twice"},
        {"method.name=event:newmark:2", NULL, SWEEP_GRID, 0,
         "event,newmark,generalized-alpha"},
        {"method.name=event,newmrk", NULL, SWEEP_GRID, 0, "newmrk"},
        {"arm.model=corrected,printed", "arm.links=2,3", SWEEP_GRID, 0,
         "run 4 (arm.model = printed, arm.links = 3): the printed model has two links"},
        {"arm.k1=1:2:1e9", "arm.k2=1:2:1e9", SWEEP_GRID, 0, "more than"},
        {"arm.k2=1:2:4", NULL, SWEEP_GRID, 7, "--runs"},
        {"arm.k2=1:2", NULL, SWEEP_RANDOM, 0, "--runs"},
    };
    for (EACH(c, bad)) {
        sweep s;
        fault f = {0};
        assert_int_equal(sweep_of(&s, c->sampling, c->runs, 0, &f, c->a, c->b),
                         STATUS_BAD_ARGUMENT);
        fail_if(strstr(f.text, c->says) == NULL, "'%s' does not say '%s'", f.text,
                c->says);
    }
}

TEST(what_no_run_takes_is_refused_by_its_axis)
{
    const struct {
        const char *a, *b;
        bool acts; // a, in some run
    } cases[] = {
        {"wall.stiffness=1000,2000", NULL, false},
        {"wall.stiffness=1000,2000", "wall.contact=rigid,kelvin-voigt", true},
        {"wall.stiffness=1000,2000", "wall.contact=rigid,hunt-crossley", true},
        {"wall.exponent=1.5,2", "wall.contact=rigid,kelvin-voigt", false},
        {"arm.k1=10,20", NULL, false},
        {"arm.k1=10,20", "arm.hub_joint=rigid,spring", true},
        {"wall.stiffness=1000:2000:3000", "arm.k2=1:2:3000", false},
        {"wall.stiffness=1000:2000:100000", "wall.contact=rigid,kelvin-voigt", true},
        {"control.kp=10,20", "control.law=none,open-loop", false},
        {"control.kp=10,20", "control.law=open-loop,hybrid", true},
    };
    for (EACH(c, cases)) {
        SWEPT(s, SWEEP_GRID, 0, c->a, c->b);
        fault f = {0};
        const status code = sweep_check_effect(&s, 0, &f);
        fail_if((code == STATUS_OK) != c->acts, "%s %s: %s", c->a, c->b, f.text);
        assert_true(c->acts || strstr(f.text, "has no effect in any run: ") != NULL);
    }

    // a row in which it idles says so, the next one does not
    SWEPT(s, SWEEP_GRID, 0, "wall.stiffness=1000,2000",
          "wall.contact=rigid,kelvin-voigt");
    const char *why[SWEEP_MOST_AXES];
    assert_true(sweep_idle(&s, 0, why));
    assert_non_null(why[0]);
    assert_null(why[1]);
    assert_false(sweep_idle(&s, 1, why));
    assert_null(why[0]);
}

TEST(a_latin_hypercube_meets_every_part_of_every_range_once)
{
    enum { RUNS = 1000 };
    SWEPT(s, SWEEP_LATIN, RUNS, "motor.voltage=2:1", "arm.k2=0.1:1000:log");
    unsigned char seen[2][RUNS] = {{0}};
    double together = 0;
    for (size_t run = 0; run < RUNS; run++) {
        double share[] = {sweep_value(&s, run, 0) - 1,
                          (log10(sweep_value(&s, run, 1)) + 1) / 4};
        for (int i = 0; i < 2; i++) {
            int part = (int)(share[i] * RUNS);
            assert_in_range(part, 0, RUNS - 1);
            assert_false(seen[i][part]);
            seen[i][part] = 1;
        }
        together += (share[0] - 0.5) * (share[1] - 0.5) * 12;
    }
    // the two are independent of each other: five standard deviations of their
    // correlation
    check_close(together / RUNS, 0, 5 / sqrt(RUNS));
}

TEST(whole_numbers_and_words_are_drawn_evenly)
{
    SWEPT(s, SWEEP_LATIN, 120, "arm.links=2:5", "method.name=event,newmark");
    int links[8] = {0}, methods[4] = {0};
    for (size_t run = 0; run < 120; run++) {
        double n = sweep_value(&s, run, 0);
        check_close(n, round(n), 0);
        links[(int)n]++;
        methods[(int)sweep_value(&s, run, 1)]++;
    }
    for (int n = 2; n <= 5; n++) {
        assert_int_equal(links[n], 30);
    }
    assert_int_equal(methods[METHOD_EVENT], 60);
    assert_int_equal(methods[METHOD_NEWMARK], 60);
}

TEST(the_seed_decides_what_is_drawn)
{
    sweep a, c;
    KEPT_SWEEP(b);
    DONE(sweep_of(&a, SWEEP_RANDOM, 50, 5, &f, "arm.k2=1:3", NULL));
    DONE(sweep_of(&b, SWEEP_RANDOM, 50, 5, &f, "arm.k2=1:3:10", NULL));
    DONE(sweep_of(&c, SWEEP_RANDOM, 50, 6, &f, "arm.k2=1:3", NULL));
    int same = 0;
    for (size_t run = 0; run < 50; run++) {
        double value = sweep_value(&a, run, 0);
        assert_true(value >= 1 && value < 3);
        check_close(value, sweep_value(&b, run, 0), 0);
        same += value == sweep_value(&c, run, 0);
    }
    assert_int_equal(same, 0);
    sweep_finish(&a);
    sweep_finish(&c);
}

ALL_BETWEEN(sweep_fixture_open, sweep_fixture_close)
