// A program in the place of a control law: odd ways to answer, and none to go back.

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

// The program cannot be taken back to an earlier sample, and so neither can its loop,
// which goes on where it is.
TEST(a_program_cannot_go_back)
{
    const scenario s = under(ANSWERS);
    const loop_options options = {.keep_trace = false};
    KEPT_LOOP(l);
    DONE(loop_create(&l, &s, &options, &f));
    DONE(loop_until(l, 0.055, &f));
    SCOPED(free_kept) void *bytes = malloc(loop_saved_size(l));
    assert_non_null(bytes);
    loop_save(l, bytes);
    REFUSED(STATUS_BAD_ARGUMENT, "cannot go back",
            loop_restore(l, bytes, loop_saved_size(l), &f));
    DONE(loop_until(l, 0.105, &f));
    check_close(loop_time(l), 0.105, 0);
}

ALL_IN_TWO_MINUTES
