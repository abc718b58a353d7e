// A run that a program steps: what holds at its end, after a failure, and of states and
// inputs that are not its own.

#include "tests/arm_fixture.h"

static run_loop *begun(const char *const *settings, const given_law *law)
{
    scenario s = {.parameters = fixture_parameters(settings)};
    s.parameters.code_allowed = true;
    const loop_options options = {.law = law != NULL ? *law : (given_law){0}};
    run_loop *l = NULL;
    DONE(loop_create(&l, &s, &options, &f));
    return l;
}

#define BRIEF "initial.angle=-0.01", "wall.angle=0", "run.duration=0.1"

// The end of a loop is final for every way of continuing, with a law and without one.
TEST(the_end_stays)
{
    const char *const *const cases[] = {SETTINGS(BRIEF),
                                        SETTINGS(BRIEF, "control.law=hybrid"),
                                        given("arm.model=printed run.duration=0.1")};
    for (EACH(c, cases)) {
        KEPT_LOOP(l) = begun(*c, NULL);
        assert_int_equal(loop_summary(l).status, STATUS_STOPPED);
        DONE(loop_until(l, 1, &f));
        assert_true(loop_ended(l));
        const double end = loop_time(l);
        const sample last = loop_row(l);
        check_close(end, 0.1, 2e-3);
        DONE(loop_step(l, &f));
        DONE(loop_until(l, 2, &f));
        const sample still = loop_row(l);
        assert_true(loop_time(l) == end);
        assert_memory_equal(&still, &last, sizeof still);
        assert_int_equal(loop_summary(l).status, STATUS_OK);
    }
}

// One volt, and after a while none that is a number.
static void give_up(void *memory, const controller_input *input,
                    controller_output *output)
{
    (void)memory;
    output->command = input->time < 0.0299 ? 1 : (double)NAN;
}

static const controller gives_up = {.interface = CONTROLLER_INTERFACE,
                                    .name = "gives up",
                                    .memory_size = 16,
                                    .sample = give_up};

TEST(what_stopped_it_is_said_again)
{
    const given_law law = {&gives_up, NULL};
    KEPT_LOOP(l) = begun(SETTINGS(BRIEF), &law);
    fault f = {.text = ""}, again = {.text = ""};
    status code = STATUS_OK;
    while (code == STATUS_OK && loop_time(l) < 0.09) {
        code = loop_step(l, &f);
    }
    assert_int_equal(code, STATUS_NOT_FINITE);
    const double time = loop_time(l);
    check_close(time, 0.03, 1e-6);
    assert_int_equal(loop_step(l, &again), code);
    assert_string_equal(again.text, f.text);
    assert_int_equal(loop_until(l, 1, &again), code);
    assert_int_equal(loop_push(l, 0.01, &again), code);
    assert_int_equal(loop_set_text(l, PARAMETER_INDEX(arm.k2), "7", &again), code);
    assert_string_equal(again.text, f.text);
    assert_true(loop_time(l) == time);
    assert_int_equal(loop_summary(l).status, code);
}

TEST(no_more_commands_are_under_way_than_have_room)
{
    KEPT_LOOP(l) =
        begun(SETTINGS(BRIEF, "control.law=force-pd", "control.rate=2000"), NULL);
    DONE(loop_until(l, 0.02, &f));
    REFUSED(STATUS_BAD_SCENARIO, "together longer than 5 periods",
            loop_set_number(l, PARAMETER_INDEX(control.delay), 0.042, &f));
    DONE(loop_until(l, 0.08, &f));
}

TEST(a_refused_input_changes_nothing)
{
    KEPT_LOOP(l) = begun(SETTINGS(BRIEF, "arm.hub_joint=beam"), NULL);
    KEPT_LOOP(same) = begun(SETTINGS(BRIEF, "arm.hub_joint=beam"), NULL);
    fault f = {.text = ""};
    assert_int_equal(loop_until(l, 0.02, &f), STATUS_OK);
    assert_int_equal(loop_set_number(l, PARAMETER_INDEX(arm.k2), -1, &f),
                     STATUS_BAD_SCENARIO);
    assert_string_equal(f.path, "arm.k2");
    assert_int_equal(loop_set_number(l, PARAMETER_INDEX(arm.k1), 90, &f),
                     STATUS_BAD_SCENARIO);
    assert_non_null(strstr(f.text, "arm.k1 is for arm.hub_joint = spring"));
    assert_int_equal(loop_set_number(l, PARAMETER_INDEX(arm.links), 3, &f),
                     STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(f.text, "cannot change during this run"));
    assert_int_equal(loop_until(l, 0.08, &f), STATUS_OK);
    assert_int_equal(loop_until(same, 0.02, &f), STATUS_OK);
    assert_int_equal(loop_until(same, 0.08, &f), STATUS_OK);
    const sample here = loop_row(l), there = loop_row(same);
    assert_memory_equal(&here, &there, sizeof here);
}

// A state goes back into the loop it is of; from another one, or cut, it is refused.
TEST(a_state_belongs_to_its_loop)
{
    const given_law law = {&gives_up, NULL};
    const given_law *const laws[] = {NULL, &law};
    for (int i = 0; i < 2; i++) {
        KEPT_LOOP(l) = begun(SETTINGS(BRIEF), laws[i]);
        KEPT_LOOP(other) = begun(SETTINGS(BRIEF, "arm.k2=7"), laws[i]);
        DONE(loop_until(l, 0.02, &f));
        const size_t size = loop_saved_size(l);
        SCOPED(free_kept) void *kept = malloc(size);
        assert_non_null(kept);
        loop_save(l, kept);
        const sample before = loop_row(l);
        REFUSED(STATUS_BAD_ARGUMENT, "", loop_restore(l, kept, size - 1, &f));
        REFUSED(STATUS_BAD_ARGUMENT, "another scenario",
                loop_restore(other, kept, size, &f));

        // continued and restored
        DONE(loop_until(l, 0.025, &f));
        DONE(loop_restore(l, kept, size, &f));
        const sample now = loop_row(l);
        assert_memory_equal(&now, &before, sizeof now);
    }
}

// What is kept of a state is the state: two loops that have come to the same one keep the
// same bytes, wherever they lie.
TEST(a_state_holds_no_addresses)
{
#define LAW(name, prefix, word, ...) {"arm.model=corrected", "control.law=" word},
    static const char *const settings[][2] = {CONTROL_LAWS(LAW){"arm.model=corrected",
                                                                "control.law=none"},
                                              {"arm.model=printed",
                                               "control.law=force-pd"}};
#undef LAW
    for (EACH(c, settings)) {
        char *kept[2];
        size_t size = 0;
        for (int k = 0; k < 2; k++) {
            run_loop *l = begun(SETTINGS((*c)[0], (*c)[1], "control.force=1"), NULL);
            DONE(loop_until(l, 0.02, &f));
            size = loop_saved_size(l);
            kept[k] = malloc(size);
            assert_non_null(kept[k]);
            loop_save(l, kept[k]);
            loop_destroy(l);
            free(calloc(3, 1 << k)); // the next one lies elsewhere
        }
        assert_memory_equal(kept[0], kept[1], size);
        free(kept[0]);
        free(kept[1]);
    }
}

// A state kept while the wall's face is on its way back has it where it is: the arm meets
// it again where it does without going back.
TEST(a_state_has_the_face_on_its_way)
{
    KEPT_LOOP(l) = begun(given("wall.contact=kelvin-voigt wall.stiffness=100 "
                               "wall.damping=500 run.duration=2"),
                         NULL);
    DONE(loop_until(l, 0.8, &f));
    DONE(loop_set_number(l, PARAMETER_INDEX(motor.voltage), -0.5, &f));
    DONE(loop_until(l, 1.2, &f));
    DONE(loop_set_number(l, PARAMETER_INDEX(motor.voltage), 2, &f));
    const sample kept_at = loop_row(l);
    assert_true(kept_at.contact == 0 && kept_at.face_depth > 1e-4);
    SCOPED(free_kept) void *kept = malloc(loop_saved_size(l));
    assert_non_null(kept);
    loop_save(l, kept);

    // to the end twice
    sample ends[2];
    for (int i = 0; i < 2; i++) {
        DONE(loop_until(l, 2, &f));
        ends[i] = loop_row(l);
        assert_true(ends[i].contact == 1 && ends[i].face_depth > 1e-4);
        DONE(loop_restore(l, kept, loop_saved_size(l), &f));
        const sample now = loop_row(l);
        assert_memory_equal(&now, &kept_at, sizeof now);
    }
    assert_memory_equal(&ends[0], &ends[1], sizeof ends[0]);
}

// Another voltage each millisecond, whose strides are made for no more than the next
// change or two: the motion is the one that a program finds which stops in between, and
// the ledger closes.
TEST(changes_are_followed_wherever_steps_end)
{
    const char *const *const settings =
        given("initial.angle=0.09 initial.velocity=0.5 run.duration=0.1");
    KEPT_LOOP(l) = begun(settings, NULL), *cut = begun(settings, NULL);
    for (int i = 0; i < 100; i++) {
        const double volts = 1 + 0.5 * (i % 7 - 3), next = 1e-3 * (i + 1);
        DONE(loop_set_number(l, PARAMETER_INDEX(motor.voltage), volts, &f));
        DONE(loop_set_number(cut, PARAMETER_INDEX(motor.voltage), volts, &f));
        DONE(loop_until(l, next, &f));
        DONE(loop_until(cut, next - 1e-3 * (i % 10) / 10 - 1e-5, &f));
        DONE(loop_until(cut, next, &f));
        int freedoms;
        const double *q = loop_state(l, &freedoms), *cut_q = loop_state(cut, &freedoms);
        for (int k = 0; k < 2 * freedoms; k++) {
            check_close(q[k], cut_q[k], 1e-11);
        }
    }

    // it has met the wall, and lost no energy on the way
    const summary s = loop_summary(l);
    assert_true(s.impacts > 0);
    assert_true(s.energy_residual_J < 1e-12);
}

// Cut anywhere, a run of two links differs from the uninterrupted one by rounding alone.
TEST(a_cut_elsewhere_is_rounding)
{
    const char *const *const cases[] = {
        given("run.duration=1"), given("motor.voltage=5 run.duration=1"),
        given("wall.kind=plane run.duration=1"),
        given("wall.angle=0 initial.angle=-0.1 control.law=hybrid sensor.ideal=true")};
    for (EACH(c, cases)) {
        KEPT_LOOP(whole) = begun(*c, NULL), *cut = begun(*c, NULL);
        DONE(loop_until(whole, 10, &f));
        for (int k = 0; !loop_ended(cut); k++) {
            DONE(loop_until(cut, loop_time(cut) + 0.0014 + 0.0007 * sin(k), &f));
        }
        const summary a = loop_summary(whole), b = loop_summary(cut);
        const sample x = loop_row(whole), y = loop_row(cut);
        assert_true(isfinite(a.first_contact_s) && a.impacts == b.impacts);
        check_close(b.first_contact_s, a.first_contact_s, 1e-15);
        check_close(b.peak_force_N, a.peak_force_N, 1e-14 * a.peak_force_N);
        check_close(y.hub_angle, x.hub_angle, 1e-15);
        check_close(y.last_angle, x.last_angle, 1e-15);
        check_close(y.force, x.force, 1e-13);
    }
}

// Nor does a cut change where the arm meets the face of a wall that it has left on its
// way back.
TEST(a_cut_leaves_the_face_on_its_way)
{
    const char *const *const walls[] = {
        given("arm.links=4 arm.hub_joint=beam motor.voltage=4 wall.kind=plane "
              "wall.contact=kelvin-voigt wall.stiffness=2e3 wall.damping=100 "
              "run.duration=0.45"),
        given("arm.links=4 arm.hub_joint=beam motor.voltage=8 wall.kind=plane "
              "wall.contact=hunt-crossley wall.stiffness=1e4 wall.damping=1e5 "
              "run.duration=0.3")};
    for (int i = 0; i < 2; i++) {
        KEPT_LOOP(whole) = begun(walls[i], NULL), *cut = begun(walls[i], NULL);
        double left = 0;
        DONE(loop_until(whole, 1, &f));
        for (int k = 0; !loop_ended(cut); k++) {
            DONE(loop_until(cut, loop_time(cut) + 0.0014 + 0.0007 * sin(k), &f));
            const sample now = loop_row(cut);
            left = now.contact == 0 ? fmax(left, now.face_depth) : left;
        }
        const sample x = loop_row(whole), y = loop_row(cut);
        assert_true(left > 1e-3 && x.contact == 1);
        check_close(y.hub_angle, x.hub_angle, 1e-14);
        check_close(y.face_depth, x.face_depth, 1e-14);
        check_relative(y.wall_loss, x.wall_loss, 1e-12);
    }
}

// A loop that plays back takes the state of another one, which is gone by then, and goes
// on as that one would have.
TEST_IN_FOLDER(a_playback_goes_on_in_another_loop)
{
    put_file("played.csv", "t,u\n0,1\n0.01,2\n0.03,0.5\n0.06,1.5\n");
    const char *const *settings =
        SETTINGS(BRIEF, "control.law=playback", "control.playback_file=played.csv",
                 "control.playback_column=u");
    run_loop *first = begun(settings, NULL);
    SCOPED(loop_destroy_kept) run_loop *second = begun(settings, NULL);
    DONE(loop_until(first, 0.02, &f));
    const size_t size = loop_saved_size(first);
    SCOPED(free_kept) void *kept = malloc(size);
    loop_save(first, kept);
    DONE(loop_until(first, 0.1, &f));
    const sample expected = loop_row(first);
    loop_destroy(first);

    DONE(loop_restore(second, kept, size, &f));
    DONE(loop_until(second, 0.1, &f));
    const sample row = loop_row(second);
    assert_memory_equal(&row, &expected, sizeof row);
}
