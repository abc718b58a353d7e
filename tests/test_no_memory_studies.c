// As test_no_memory, for what stands around a run: scenarios by name, sets of cases,
// studies, parts of a sweep, and the printed model.

#include "src/run/export.h"
#include "src/study/batch.h"
#include "src/study/calibrate.h"
#include "src/study/convergence.h"
#include "src/study/robust/robust.h"
#include "src/study/sweep_run.h"
#include "src/study/thesis_tables.h"
#include "tests/refused_requests.h"

// --- scenarios by name -----------------------------------------------------------------

static void write_sentence(void *out, const char *sentence)
{
    fprintf(out, "%s\n", sentence);
}

// A name that is unknown is refused with the same sentence, however little memory there
// is.
static status look_up(const char *name, FILE *out)
{
    scenario s;
    status code = scenario_open(&s, name, write_sentence, out);
    if (code == STATUS_OK) {
        fprintf(out, "%s: %s\n", s.name, s.title);
        scenario_finish(&s);
    }
    return code == STATUS_BAD_ARGUMENT || code == STATUS_CANNOT_READ ? STATUS_OK : code;
}

static status list_all(const char *ignored, FILE *out)
{
    (void)ignored;
    char **names;
    int count;
    fault f = {0};
    status code = scenario_list(&names, &count, &f);
    for (int i = 0; i < count; i++) {
        fprintf(out, "%s\n", names[i]);
    }
    free_names(names, count);
    return code;
}

static status place_of(const char *name, FILE *out)
{
    KEPT_TEXT(path) = scenario_folder_file(name);
    fprintf(out, "%s\n", path != NULL ? path : "");
    return path != NULL ? STATUS_OK : STATUS_NO_MEMORY;
}

// --- studies ---------------------------------------------------------------------------

static const char short_run[] = "title: t\nwall: {angle: 0}\nmotor: {voltage: 4 V}\n"
                                "run: {duration: 0.12 s}\ninitial: {angle: -0.01 rad}\n";

static status draw_cases(scenario *s, FILE *out)
{
    SCOPED(robust_set_finish) robust_set set;
    fault f = {0};
    scenario derived;
    status code = robust_set_read(&set, "set", &f);
    for (int i = 0; code == STATUS_OK && i < set.case_count; i++) {
        code = robust_case_scenario(&derived, s, &set.cases[i], &f);
        if (code == STATUS_OK) {
            fprintf(out, "%s %g %d\n", set.cases[i].title, derived.parameters.arm.k2,
                    derived.action_count);
            robust_case_finish(&derived);
        } else if (f.code == STATUS_BAD_ARGUMENT && refused_at > 0) {
            code = STATUS_NO_MEMORY; // the case's sentence says so
        }
    }
    return code;
}

static status thesis(const char *ignored, FILE *out)
{
    (void)ignored;
    thesis_tables t;
    fault f = {0};
    const status code = tables_compute(&t, &f);
    for (int i = 0; i < t.row_count && code == STATUS_OK; i++) {
        fprintf(out, "%a %a\n", t.rows[i].computed[0], t.rows[i].computed[3]);
    }
    return code;
}

static status converge(scenario *s, FILE *out)
{
    convergence_panel panel;
    fault f = {0};
    const status code = convergence_compute(s, NULL, NULL, &panel, &f);
    for (int i = 0; i < panel.row_count && code == STATUS_OK; i++) {
        fprintf(out, "%s %a\n", panel.rows[i].key, panel.rows[i].value[0]);
    }
    return code;
}

static status measure_stiffness(scenario *s, FILE *out)
{
    calibration c;
    const double commands[] = {1};
    fault f = {0};
    status code = calibrate(s, commands, 1, NULL, &c, &f);
    if (code == STATUS_OK) {
        json_t *object = calibration_json(&c, s->name, "");
        code = loss_noted() || object == NULL ? STATUS_NO_MEMORY : STATUS_OK;
        fprintf(out, "%a\n", c.points[0].k2);
        json_decref(object);
    }
    return code;
}

// --- parts of a sweep ------------------------------------------------------------------

// Two parts into files, together into a third, and read as columns.
static status sweep_in_parts(scenario *s, FILE *out)
{
    char *files[] = {(char[]){"0.sqlite"}, (char[]){"1.sqlite"}, (char[]){"2.sqlite"}};
    char *vary[] = {(char[]){"motor.voltage=1:3"}};
    sweep_request request = {
        .vary = vary, .vary_count = 1, .sampling = SWEEP_LATIN, .runs = 4, .seed = 1};
    sweep w;
    fault f = {0};
    for (int i = 0; i < 3; i++) {
        unlink(files[i]);
    }

    // the parts
    status code = sweep_init(&w, s, &request, &f);
    const bool begun = code == STATUS_OK;
    for (int i = 0; i < 2 && code == STATUS_OK; i++) {
        KEPT_STORE(store) = NULL;
        sweep_progress progress;
        const sweep_options options = {.share = {i + 1, 2}, .jobs = 1};
        code = sweep_store_open(&store, files[i], &w, &f);
        code = code == STATUS_OK ? sweep_run(&w, store, &options, &progress, &f) : code;
    }

    // and what they are together
    sweep_merged merged;
    const char *const keys[] = {"motor.voltage", "peak_force_N"};
    double *columns[2] = {NULL, NULL};
    size_t count = 0;
    code = code == STATUS_OK ? sweep_merge(files, 2, files[2], &merged, &f) : code;
    code = code == STATUS_OK ? sweep_table_read(files[2], keys, 2, columns, &count, &f)
                             : code;
    for (size_t i = 0; i < count && code == STATUS_OK; i++) {
        fprintf(out, "%a %a\n", columns[0][i], columns[1][i]);
    }
    free(columns[0]);
    free(columns[1]);
    for (int i = 0; i < 3; i++) {
        unlink(files[i]);
    }
    if (begun) {
        sweep_finish(&w);
    }

    // a database that could not be read in full may seem to be none
    return code == STATUS_CANNOT_READ && refused_at > 0 ? STATUS_NO_MEMORY : code;
}

// --- runs ------------------------------------------------------------------------------

// The force and the hub of every row.
static status show_rows(const run_result *result, FILE *out)
{
    for (EACH_ROW(row, &result->trace)) {
        fprintf(out, "%a %a\n", row->force, row->hub_angle);
    }
    return result->summary.status;
}

static status run(scenario *s, FILE *out)
{
    KEPT_RUN(result);
    const status code = run_scenario(s, true, &result);
    show_rows(&result, out);
    return code;
}

// --- what a run of a batch asks for ----------------------------------------------------

// The batch's scenario with a voltage of the run's own.
static status with_voltage(void *base, size_t i, scenario *made, fault *f)
{
    (void)f;
    *made = *(const scenario *)base;
    made->parameters.motor.voltage = 4 + 1e-3 * (double)i;
    return STATUS_OK;
}

// How often a batch of so many runs on one thread asks for memory, a descriptor or a
// thread.
static long requests_of_batch(scenario *base, size_t runs)
{
    summary *summaries = calloc(runs, sizeof *summaries);
    const batch all = {.context = base,
                       .count = runs,
                       .make = with_voltage,
                       .summaries = summaries};
    fault f = {0};
    const long before = requests;
    assert_int_equal(batch_run(&all, 1, &f), STATUS_OK);
    const long asked = requests - before;
    assert_int_equal(summaries[runs - 1].status, STATUS_OK);
    free(summaries);
    return asked;
}

// --- the tests -------------------------------------------------------------------------

TEST(a_name_means_the_same_scenario)
{
    put_file("own.yaml", "title: Own\n");
    KEPT_TEXT(before) =
        strdup(getenv("IMPACTLAB_SCENARIOS") ? getenv("IMPACTLAB_SCENARIOS") : "");
    setenv("IMPACTLAB_SCENARIOS", test_folder, 1);
    try_all(look_up, "own");
    try_all(look_up, formatted("%s/own", test_folder));
    try_all(look_up, "owm");
    try_all(look_up, test_folder);
    try_all(list_all, "");
    try_all(place_of, "own.yaml");
    setenv("IMPACTLAB_SCENARIOS", before, 1);
}

TEST(sets_and_studies)
{
    put_file("set",
             "arm.k2=4:6\ncase soft: arm.k2=3\ncase pushed: push=0.1@0.05; arm.k2=4\n");
    try_with_scenario(draw_cases, "");
    try_all(thesis, "");
    try_with_scenario(converge, "");
    try_with_scenario(measure_stiffness, "");
}

TEST(parts_of_a_sweep)
{
    try_with_scenario(sweep_in_parts, "");
}

TEST(runs_of_the_printed_model)
{
    try_with_scenario(run, "arm.model=printed");
    try_with_scenario(run, "arm.model=printed control.law=hybrid");
}

// Where a run of two links ends in a batch, the next one takes over what it had.
TEST(a_run_more_of_a_batch_asks_for_nothing)
{
    static const char *const arms[] = {"",
                                       "arm.damping_ratio=0.01",
                                       "wall.restitution=0.5",
                                       "arm.hub_joint=spring",
                                       "arm.links=3",
                                       "arm.links=1 wall.contact=hunt-crossley",
                                       "arm.links=4 arm.modal_ratios=0.01,0.02"};
    for (size_t i = 0; i < sizeof arms / sizeof *arms; i++) {
        scenario s;
        assert_int_equal(make_scenario(&s, arms[i]), STATUS_OK);
        const long few = requests_of_batch(&s, 2 * RUN_TOGETHER);
        const long many = requests_of_batch(&s, 6 * RUN_TOGETHER);
        fail_if(many != few, "%s: %ld runs more asked %ld times more", arms[i],
                4L * RUN_TOGETHER, many - few);
        scenario_finish(&s);
    }
}

REFUSING_MAIN(short_run, refuse_in_folder, leave_folder)
