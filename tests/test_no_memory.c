// The library's own work with every request for memory, descriptors and threads refused
// in turn: reading, runs of every engine and of the rig, predictions, sessions, loops,
// batches and sweeps.
#include "src/base/words.h"
#include "src/predict/predictors.h"
#include "src/rig/rig.h"
#include "src/run/export.h"
#include "src/session/session.h"
#include "src/study/batch.h"
#include "src/study/compare.h"
#include "src/study/robust/robust.h"
#include "src/study/sweep_run.h"
#include "tests/refused_requests.h"

// Of all that a scenario may hold.
static const char whole_scenario[] =
    "title: Stoß\n"
    "description: some\n"
    "run: {duration: 0.12 s}\n"
    "initial: {angle: -0.01 rad}\n"
    "script:\n"
    "  - {at: 0.05, set: {motor.voltage: 2 V}}\n"
    "  - {at: 0.06, push: -0.01 N s}\n"
    "expect: {impacts: {value: 1, tolerance: 9}}\n"
    "panes: [force, gap]\n"
    "lesson:\n"
    "  parameters: [arm.k2]\n"
    "  steps:\n"
    "  - {say: one, value: {arm.k2: 5}, hint: h, then: right, do: [seek 0]}\n";

static status read_and_write(scenario *s, FILE *out)
{
    scenario copy;
    status code = scenario_copy(&copy, s);
    if (code == STATUS_OK) {
        scenario_write(out, &copy);
        scenario_finish(&copy);
    }
    return code;
}

// JSON and rows of a result.
static status show(const scenario *s, run_result *result, FILE *out)
{
    result->summary.cpu_time_s = result->summary.wall_time_s = 0;
    json_t *object = export_run(s, result);
    json_write(out, object);
    json_decref(object);
    export_csv(out, s, &result->trace);
    return STATUS_OK;
}

static status run(scenario *s, FILE *out)
{
    // with rows that can be shared, as a session keeps them
    KEPT_RUN(result);
    run_options options = {.keep_trace = true, .rows_expected = 1000};
    status code = run_scenario_with(s, &options, &result);
    code = code == STATUS_OK ? show(s, &result, out) : code;
    return code;
}

// A short text needs no memory, a long one is whole or known to be cut.
static status print_text(const char *text, FILE *out)
{
    print_printable(out, "%s: \x1b %5000d\n", text, 7);
    return STATUS_OK;
}

static status start_rig(scenario *s, FILE *out)
{
    rig *made = NULL;
    fault f = {0};
    const status code = rig_create(&made, &s->parameters, NULL, &f);
    rig_destroy(made);
    fprintf(out, "%d", code);
    return code;
}

static status predict(scenario *s, FILE *out)
{
    // a straight arm that turns into the wall
    status code = STATUS_OK;
    double q[40] = {0}, w[40];
    for (size_t i = 0; i < sizeof w / sizeof w[0]; i++) {
        w[i] = 0.5;
    }
    prediction_answer answers[PREDICTOR_COUNT];
    prediction_question question = {.parameters = &s->parameters,
                                    .bodies = {.velocity = {0.5, 0.5, 0.5}},
                                    .angles = q,
                                    .velocities = w,
                                    .whole_pulse = true};
    predict_all(&question, answers);
    for (int i = 0; i < PREDICTOR_COUNT; i++) {
        fprintf(out, "%d %a\n", answers[i].outcome, answers[i].prediction.force);
        code = answers[i].outcome == PREDICTION_FAILED ? answers[i].fault.code : code;
    }
    return code;
}

// What came of something done to a session, and of its run.
static status and_run(const session *s, status done)
{
    return done == STATUS_OK ? s->run.summary.status : done;
}

static status change_on_the_way(scenario *s, FILE *out)
{
    scenario own;
    session made_session;
    fault f = {0};
    status code = scenario_copy(&own, s);
    code = code == STATUS_OK ? session_open(&made_session, &own, HUGE_VAL, &f) : code;
    if (code != STATUS_OK) {
        return code;
    }

    // changed, pushed, taken back, and beside what it was; a run that ends early is kept
    // and says so
    session *t = &made_session;
    code = t->run.summary.status;
    session_seek(t, 0.03);
    const int voltage = PARAMETER_INDEX(motor.voltage), k2 = PARAMETER_INDEX(arm.k2);
    code = code == STATUS_OK ? and_run(t, session_change(t, voltage, "1.5", &f)) : code;
    code = code == STATUS_OK ? session_keep_beside(t, &t->run, &f) : code;
    session_seek(t, 0.07);
    code = code == STATUS_OK ? and_run(t, session_push(t, 0.01, &f)) : code;
    code = code == STATUS_OK ? and_run(t, session_undo(t, &f)) : code;
    code = code == STATUS_OK ? and_run(t, session_redo(t, &f)) : code;

    // in small steps, without the first input, and with all of before
    session_input before[2];
    if (code == STATUS_OK) {
        memcpy(before, t->inputs, sizeof before);
    }
    code = code == STATUS_OK ? and_run(t, session_adjust(t, k2, "7", &f)) : code;
    code = code == STATUS_OK ? and_run(t, session_adjust(t, k2, "8", &f)) : code;
    code = code == STATUS_OK ? session_keep_beside(t, &t->run, &f) : code;
    code = code == STATUS_OK ? and_run(t, session_drop_input(t, 0, &f)) : code;
    code = code == STATUS_OK ? and_run(t, session_take_inputs(t, before, 2, &f)) : code;
    code = code == STATUS_OK ? show(&t->effective, &t->run, out) : code;
    session_finish(t);
    return code;
}

static status step_as_a_loop(scenario *s, FILE *out)
{
    KEPT_LOOP(loop) = NULL;
    fault f = {0};
    const loop_options options = {.keep_trace = true};
    status code = loop_create(&loop, s, &options, &f);
    for (int i = 1; i <= 4 && code == STATUS_OK; i++) {
        code = loop_until(loop, 0.03 * i, &f);
        code = code == STATUS_OK && i == 2
                   ? loop_set_text(loop, PARAMETER_INDEX(motor.voltage), "1", &f)
                   : code;
        code = code == STATUS_OK && i == 3 ? loop_push(loop, 0.001, &f) : code;
    }
    if (code == STATUS_OK) {
        fprintf(out, "%a\n", loop_row(loop).force);
    }
    return code;
}

static status make_one(void *context, size_t i, scenario *made, fault *f)
{
    (void)f;
    *made = *(const scenario *)context;
    made->parameters.motor.voltage = 1 + (double)i;
    return STATUS_OK;
}

static status run_many(scenario *s, FILE *out)
{
    enum { RUNS = 6 };
    summary all[RUNS];
    const batch runs = {.context = s, .count = RUNS, .make = make_one, .summaries = all};
    status code = batch_run(&runs, 2, NULL);
    for (int i = 0; i < RUNS && code == STATUS_OK; i++) {
        fprintf(out, "%a\n", all[i].peak_force_N);
        code = all[i].status;
    }
    return code;
}

static status sweep_over(scenario *s, FILE *out)
{
    char *vary[] = {(char[]){"motor.voltage=1:3:3"}, (char[]){"arm.k2=5,10"}};
    sweep_request request = {.vary = vary, .vary_count = 2};
    sweep made_sweep;
    sweep_store *store = NULL;
    sweep_progress progress;
    robust_law law = {0};
    fault f = {0};

    // into a database in memory, and out again
    status code = sweep_init(&made_sweep, s, &request, &f);
    if (code == STATUS_OK) {
        const sweep_options options = {.jobs = 1};
        code = sweep_store_open(&store, NULL, &made_sweep, &f);
        code = code == STATUS_OK ? sweep_run(&made_sweep, store, &options, &progress, &f)
                                 : code;
        code = code == STATUS_OK ? sweep_store_write(store, out, false, &f) : code;
        code = code == STATUS_OK ? sweep_store_write(store, out, true, &f) : code;
        code = code == STATUS_OK
                   ? robust_law_of(&law, "none", &made_sweep, (sweep_share){0}, store, &f)
                   : code;
        robust_law_finish(&law);
        sweep_store_close(store);
        sweep_finish(&made_sweep);
    }
    return code;
}

static status put_side_by_side(scenario *s, FILE *out)
{
    KEPT_RUN(result);
    status code = run_scenario(s, false, &result);
    if (code == STATUS_OK) {
        compare_row row = compare_row_of(s, &result);
        compare_table table = {.rows = &row, .count = 1, .group = 1};
        json_t *object = compare_json(&table);
        json_write(out, object);
        json_decref(object);
    }
    return code;
}

// --- the tests -------------------------------------------------------------------------

TEST(scenarios_are_read_copied_and_written)
{
    try_with_scenario(read_and_write, "arm.links=4 arm.joint_stiffness=4,5,6");
}

TEST(printed_texts)
{
    try_all(print_text, "a long text");
}

TEST(runs_of_every_engine)
{
    static const char *const settings[] = {"",
                                           "arm.links=5 arm.damping_ratio=0.01",
                                           "arm.links=24",
                                           "method.name=generalized-alpha",
                                           "wall.contact=kelvin-voigt wall.stiffness=1e4",
                                           "arm.hub_joint=spring arm.k1=100"};
    for (size_t i = 0; i < sizeof settings / sizeof settings[0]; i++) {
        try_with_scenario(run, settings[i]);
    }
}

TEST(runs_of_the_rig)
{
    static const char *const settings[] = {"control.law=hybrid", "control.law=touch",
                                           "control.law=observer",
                                           "control.law=inverse-dynamics"};
    for (size_t i = 0; i < sizeof settings / sizeof settings[0]; i++) {
        try_with_scenario(run, settings[i]);
        try_with_scenario(start_rig, settings[i]);
    }
}

TEST(predictions)
{
    try_with_scenario(predict, "");
    try_with_scenario(predict, "arm.links=6 arm.damping_ratio=0.01");
    try_with_scenario(predict, "wall.contact=kelvin-voigt wall.stiffness=1e4");
}

TEST(sessions_and_loops)
{
    try_with_scenario(change_on_the_way, "");
    try_with_scenario(change_on_the_way, "control.law=hybrid");
    try_with_scenario(step_as_a_loop, "");
    try_with_scenario(step_as_a_loop, "control.law=hybrid");
}

TEST(many_runs)
{
    try_with_scenario(run_many, "");
    try_with_scenario(run_many, "arm.links=3");
    try_with_scenario(sweep_over, "control.law=hybrid");
    try_with_scenario(put_side_by_side, "");
}

REFUSING_MAIN(whole_scenario, use_refusing_allocators, NULL)
