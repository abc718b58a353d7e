// A program in the place of a control law: odd ways to answer, and states of a run that
// it is led back to and on from.

#include "tests/rig_fixture.h"

// The arm under a program in the shell, asked a hundred times a second.
static scenario under(const char *program)
{
    return (scenario){
        .name = (char *)"program",
        .parameters = rig_parameters(
            SETTINGS("control.law=process", formatted("control.command=%s", program),
                     "control.rate=100", "run.duration=0.2", "initial.angle=-0.01"))};
}

#define ANSWERS "while read -r l; do echo '{\"command\": 1}'; done"

TEST(odd_programs_are_understood)
{
    static const char *const programs[] = {
        ANSWERS,
        "exec 2>&-; " ANSWERS,        // has nothing to complain to
        "echo started >&2; " ANSWERS, // complains of nothing
    };
    double peak[3];
    for (int i = 0; i < 3; i++) {
        scenario s = under(programs[i]);
        KEPT_RUN(r);
        fail_if(run_scenario(&s, false, &r) != STATUS_OK, "%s: %s", programs[i],
                r.summary.message);
        peak[i] = r.summary.peak_force_N;
        assert_true(i == 0 || peak[i] == peak[0]);
    }
}

TEST(programs_without_an_answer_are_said)
{
    static const struct {
        const char *program, *sentence;
    } cases[] = {
        {"exec 0<&-; sleep 0.2; exit 3", "without an answer"},
        {"read -r l; exit 0", "without an answer"},
        {"read -r l; echo no", "no"},
        {"read -r l; echo 'out of order' >&2; exit 1", "out of order"},
    };
    for (EACH(c, cases)) {
        scenario s = under(c->program);
        KEPT_RUN(r);
        assert_int_equal(run_scenario(&s, false, &r), STATUS_CONTROLLER_FAILED);
        fail_if(strstr(r.summary.message, c->sentence) == NULL, "'%s' does not say '%s'",
                r.summary.message, c->sentence);
    }
}

// A state of the loop, to be freed.
static void *kept(const run_loop *l)
{
    void *bytes = malloc(loop_saved_size(l));
    assert_non_null(bytes);
    loop_save(l, bytes);
    return bytes;
}

static sample gone_to(run_loop *l, double time)
{
    DONE(loop_until(l, time, &f));
    return loop_row(l);
}

// Led back the program is started anew, and led on from where it is on the way; the rows
// are the same.
TEST(a_program_is_led_back_and_on)
{
    const scenario s = under(ANSWERS);
    const loop_options options = {.keep_trace = false};
    KEPT_LOOP(l);
    DONE(loop_create(&l, &s, &options, &f));
    const size_t size = loop_saved_size(l);
    (void)gone_to(l, 0.055);
    SCOPED(free_kept) void *early = kept(l);
    const sample middle = gone_to(l, 0.105);
    SCOPED(free_kept) void *late = kept(l);
    const sample end = gone_to(l, 0.155);

    for (int i = 0; i < 2; i++) {
        DONE(loop_restore(l, early, size, &f));
        const sample again = gone_to(l, i == 0 ? 0.105 : 0.065);
        assert_true(i == 1 || memcmp(&again, &middle, sizeof again) == 0);
        DONE(loop_restore(l, late, size, &f));
        const sample there = gone_to(l, 0.155);
        assert_memory_equal(&there, &end, sizeof there);
    }
}

// A program that answers otherwise when it is asked again cannot be led back. Its
// answers, from its process number, are 1 to 2 V: enough to move the arm, whose stiffness
// then shows in the readings.
TEST(a_program_that_answers_otherwise_is_said)
{
    const scenario s =
        under("n=$$; while read -r l; do echo \"{\\\"command\\\": 1.$n}\"; done");
    const loop_options options = {.keep_trace = false};
    KEPT_LOOP(l);
    DONE(loop_create(&l, &s, &options, &f));
    (void)gone_to(l, 0.055);
    SCOPED(free_kept) void *early = kept(l);
    (void)gone_to(l, 0.105);
    DONE(loop_restore(l, early, loop_saved_size(l), &f));

    // another command leads to other questions, for which the program is asked all again
    DONE(loop_set_number(l, PARAMETER_INDEX(arm.k2), 7, &f));
    REFUSED(STATUS_CONTROLLER_FAILED, "not", loop_until(l, 0.105, &f));
}

ALL_IN_TWO_MINUTES
