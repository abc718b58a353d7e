// What was refused may be finished: after each initialisation that fails, for want of
// memory or by its arguments, the caller's next call, its finish, frees nothing twice and
// leaves nothing. The sanitizers see what it does.

#include "src/base/csv_table.h"
#include "src/session/session.h"
#include "src/session/session_file.h"
#include "src/study/identify/identify.h"
#include "src/study/linear/linear.h"
#include "src/study/robust/robust.h"
#include "src/study/sweep_definition.h"
#include "src/study/robust/tune.h"
#include "tests/refused_requests.h"

static const char *put(const char *name, const char *text)
{
    put_file(name, text);
    return name;
}

// Each takes what it is about, makes one, and finishes it whatever came of it.
#define FINISHED(name, about) static status name(about, FILE *out __attribute__((unused)))

FINISHED(table, const char *text)
{
    csv_table t = {0};
    fault f = {0};
    SCOPED(free_kept) double *times = NULL;
    status code = csv_table_read(&t, put("t.csv", text), 1, &f);
    if (code == STATUS_OK) {
        sample_clock clock;
        code = csv_table_times(&t, "time", 0, &clock, &times, &f);
    }
    csv_table_finish(&t);
    csv_table_finish(&t);
    return code;
}

FINISHED(set, const char *text)
{
    SCOPED(robust_set_finish) robust_set s = {0};
    fault f = {0};
    return robust_set_read(&s, put("a.set", text), &f);
}

FINISHED(session_of_lines, const char *text)
{
    SCOPED(session_file_finish) session_file s = {0};
    fault f = {0};
    return session_file_read(&s, put("a.session", text), &f);
}

static void ignore(void *context, const char *sentence)
{
    (void)context;
    (void)sentence;
}

FINISHED(parsed, const char *text)
{
    KEPT_SCENARIO(s) = {0};
    return scenario_parse(&s, text, strlen(text), "p.yaml", NULL, ignore, NULL);
}

// Axes of a sweep, blanks between them.
static status plan_of(const char *text, sweep_sampling how, bool tuned)
{
    char *rest = formatted("%s", text), *vary[SWEEP_MOST_AXES], *one;
    int count = 0;
    KEPT_SCENARIO(s) = {0};
    fault f = {0};
    status code = make_scenario(&s, "control.law=force-pd");
    if (code != STATUS_OK) {
        return code;
    }
    while ((one = strsep(&rest, ";")) != NULL) {
        vary[count++] = one;
    }
    if (tuned) {
        SCOPED(tune_finish) tuning t = {0};
        const tune_request asked = {.base = &s,
                                    .vary = vary,
                                    .vary_count = count,
                                    .minimise = "peak_force_N",
                                    .runs = 4};
        code = tune_init(&t, &asked, &f);
    } else {
        KEPT_SWEEP(w) = {0};
        KEPT_SWEEP(again) = {0};
        SCOPED(definition_finish) definition d = {0};
        KEPT_STORE(store) = NULL;
        const sweep_request request = {.vary = vary,
                                       .vary_count = count,
                                       .sampling = how,
                                       .runs = how == SWEEP_GRID ? 0 : 3};
        code = sweep_init(&w, &s, &request, &f);
        code = code == STATUS_OK ? definition_init(&d, &w, &f) : code;
        code = code == STATUS_OK ? definition_plan(&d, "here", &again, &f) : code;
        code = code == STATUS_OK ? sweep_store_open(&store, NULL, &w, &f) : code;
    }
    return code;
}

FINISHED(grid, const char *text)
{
    return plan_of(text, SWEEP_GRID, false);
}

FINISHED(drawn, const char *text)
{
    return plan_of(text, SWEEP_LATIN, false);
}

FINISHED(tuned, const char *text)
{
    return plan_of(text, SWEEP_LATIN, true);
}

FINISHED(fitted, const char *text)
{
    KEPT_SCENARIO(s) = {0};
    fault f = {0};
    status code = make_scenario(&s, "control.law=open-loop control.rate=1000");
    if (code != STATUS_OK) {
        return code;
    }
    SCOPED(identify_finish) identification id = {.base = &s};
    code = identify_add_path(&id, text, &f);
    if (code == STATUS_OK) {
        code = identify_add_trace(&id,
                                  put("r.csv", "time[s],command[V],encoder[rad]\n0,1,0\n"
                                               "0.001,1,0\n0.002,1,0.001\n"),
                                  NULL, 0, &f);
    }
    return code;
}

FINISHED(looped, scenario *s)
{
    fault f = {0};
    KEPT_LOOP(l) = NULL;
    return loop_create(&l, s, &(loop_options){.keep_trace = true}, &f);
}

FINISHED(linearised, scenario *s)
{
    fault f = {0};
    linear_arm arm = {0};
    linear_system loop = {0};
    status code = linear_arm_init(&arm, &s->parameters, LINEAR_CONTACT, &f);
    if (code == STATUS_OK) {
        code = linear_loop(&loop, &arm, &s->parameters, &f);
    }
    linear_system_finish(&loop);
    linear_system_finish(&arm.system);
    return code;
}

// --- for want of memory, and by the arguments

TEST(what_is_refused_for_want_of_memory_is_finished)
{
    try_all(table, "time[s],a[V]\n0,1\n1,2\n");
    try_all(set, "belief.k2_factor=0.9:1.1\ncase softer: arm.k2=5; push=-0.01@0.2\n");
    try_all(parsed, "title: A\nmotor: {voltage: 2 V}\n");
    try_all(grid, "motor.voltage=1,2;arm.k2=4:5:2");
    try_all(drawn, "arm.k2=1,2,3;with arm.mass=0.1,0.2,0.3");
    try_all(tuned, "control.force_gain=1:2");
    try_all(fitted, "arm.k2=4:6");
    try_with_scenario(looped, "control.law=hybrid");
    try_with_scenario(linearised, "control.law=force-pd control.force=1");
}

TEST(what_is_refused_by_its_arguments_is_finished)
{
    static const struct {
        work *does;
        const char *about[8];
    } refused[] = {
        {table,
         {"", "time[s]\n", "time[s],a[V]\n1,2\n0,1\n", "time[s]\nx\n", "time[m]\n1\n"}},
        {set, {"", "case x\n", "case : a=b\n", "case a: push=1\n"}},
        {session_of_lines, {"", "x\n", "session 999\n"}},
        {parsed,
         {"", "- a", "motor: {voltage: x}", "script: [{at: -1}]", "title: A\nlesson: 3"}},
        {grid,
         {"arm.k2", "arm.k2=1:2", "arm.k2=1,1", "arm.k2=1,2;arm.k2=3,4",
          "with arm.k2=1,2"}},
        {drawn,
         {"arm.k2=1,2;with arm.mass=0.1", "x=1:2", "arm.k2=1:2;with arm.mass=1:2"}},
        {tuned,
         {"control.force_gain=1", "control.force_gain=1,2", "x=1:2",
          "control.law=none,hybrid"}},
        {fitted, {"arm.k2=", "arm.links", "x", "arm.k2=5:5", "control.law"}},
    };
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        for (int k = 0; k < 8 && refused[i].about[k] != NULL; k++) {
            const status code = refused[i].does(refused[i].about[k], NULL);
            fail_if(code == STATUS_OK || code == STATUS_NO_MEMORY, "%zu '%s': %s", i,
                    refused[i].about[k], status_text(code));
        }
    }
}

REFUSING_MAIN("title: A\nrun: {duration: 0.02 s}\n", refuse_in_folder, leave_folder)
