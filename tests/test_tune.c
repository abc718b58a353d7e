// Tuning: expressions, and that the search finds what is known otherwise.
#include "src/study/linear/linear.h"
#include "src/study/robust/tune.h"

#include "src/base/expression.h"
#include "src/study/linear/linear.h"
#include "src/study/store/sweep_store.h"
#include "tests/rig_fixture.h"

// --- expressions -----------------------------------------------------------------------

static int find(void *context, const char *name, const char **near)
{
    (void)context;
    *near = "seven";
    return strcmp(name, "seven") == 0 ? 7 : -1;
}

static double value_of(const void *context, int name)
{
    (void)context;
    return name;
}

static double evaluate(const char *text)
{
    expression e;
    DONE(expression_read(&e, text, find, NULL, &f));
    return expression_evaluate(&e, value_of, NULL);
}

TEST(expressions_are_arithmetic)
{
    static const struct {
        const char *text;
        double value;
    } right[] = {
        {"1", 1},
        {" 2 + 3 * 4 ", 14},
        {"(2+3)*4", 20},
        {"8/4/2", 1},
        {"10-4-3", 3},
        {"-2*-3", 6},
        {"seven/2", 3.5},
        {"max(1, seven)", 7},
        {"max(3,max(1,2),-5)-1e-1", 2.9},
        {"2*(max(1,2)+seven)", 18},
    };
    for (EACH(c, right)) {
        assert_true(fabs(evaluate(c->text) - c->value) <= 1e-14);
    }

    // what cannot be judged stays so
    assert_true(isnan(evaluate("max(1,(1-1)/(1-1))")));
}

TEST(faults_of_expressions_name_the_column)
{
    static const struct {
        const char *text;
        int column;
        const char *says;
    } wrong[] = {
        {"", 1, "expected a name"},      {"1 +", 4, "expected a name"},
        {"(1 + 2", 7, "expected ')'"},   {"1 + sevn", 5, "did you mean 'seven'?"},
        {"1 2", 3, "an operator"},       {"max(1)", 6, "expected ','"},
        {"max(1,2", 8, "expected ')'"},  {"seven seven", 7, "an operator"},
        {"nan", 1, "no quantity 'nan'"}, {"max 1", 1, "no quantity 'max'"},
    };
    for (EACH(c, wrong)) {
        expression e;
        fault f = {0};
        assert_int_equal(expression_read(&e, c->text, find, NULL, &f),
                         STATUS_BAD_ARGUMENT);
        fail_if(f.column != c->column || strstr(f.text, c->says) == NULL,
                "'%s': column %d, %s", c->text, f.column, f.text);
    }

    // as many brackets or numbers as anybody wants, and no stack without end
    static const char *const endless[] = {"(", "1+"};
    for (size_t i = 0; i < 2; i++) {
        expression e;
        char deep[100001];
        for (size_t k = 0; k < sizeof deep; k++) {
            deep[k] = k + 1 < sizeof deep ? endless[i][k % strlen(endless[i])] : '\0';
        }
        assert_int_equal(expression_read(&e, deep, find, NULL, NULL),
                         STATUS_BAD_ARGUMENT);
    }
}

// --- the search ------------------------------------------------------------------------

// Searches, and returns what was found; t is to be finished.
static void search(tuning *t, const tune_request *asked, int jobs)
{
    KEPT_STORE(store);
    DONE(tune_init(t, asked, &f));
    DONE(sweep_store_open(&store, NULL, &t->plan, &f));
    const sweep_options options = {.jobs = jobs};
    DONE(tune_run(t, store, &options, &f));
}

// The force of a stiff arm that strikes is proportional to the voltage's effect on its
// speed: a peak is asked for, and that voltage is sought which the search by halves
// finds, too.
TEST(one_parameter_is_that_of_bisection)
{
    char *vary[] = {"motor.voltage=0.5:3"};
    scenario base = {.name = "touch", .parameters = rig_parameters(NULL)};
    base.parameters.run.duration = 0.3;
    const tune_request asked = {.base = &base,
                                .vary = vary,
                                .vary_count = 1,
                                .minimise = "max(peak_force_N - 2, 2 - peak_force_N)",
                                .runs = 80,
                                .seed = 3};
    SCOPED(tune_finish) tuning t;
    search(&t, &asked, 2);
    assert_true(t.done > 20 && t.done <= 80);

    double low = 0.5, high = 3;
    for (int i = 0; i < 40; i++) {
        const double middle = (low + high) / 2;
        scenario s = base;
        s.parameters.motor.voltage = middle;
        KEPT_RUN(r) = run_done(&s, false);
        *(r.summary.peak_force_N < 2 ? &low : &high) = middle;
    }
    assert_true(fabs(t.found[0] - high) <= 1e-3 * high);
}

static int told;           // of best values
static size_t most_looked; // runs that a quantity was asked of, at most

static status count_told(void *context, const tuning *t, fault *f)
{
    (void)context;
    (void)t;
    (void)f;
    told++;
    return STATUS_OK;
}

static status count_looked(sweep_store *store, sweep_share share, const char *key,
                           sweep_value_taker *take, void *context, size_t *failed,
                           fault *f)
{
    const size_t runs = sweep_share_count(share, 40);
    most_looked = runs > most_looked ? runs : most_looked;
    return sweep_store_values(store, share, key, take, context, failed, f);
}

// A search that goes on in its store tells no value before it computes one, as the best
// of those is told already, and looks at the runs of each evaluation only.
TEST(a_replay_tells_nothing_and_reads_each_run_once)
{
    char *vary[] = {"motor.voltage=0.5:3"};
    scenario base = {.name = "touch", .parameters = rig_parameters(NULL)};
    base.parameters.run.duration = 0.3;
    const tune_request asked = {.base = &base,
                                .vary = vary,
                                .vary_count = 1,
                                .minimise = "max(peak_force_N - 2, 2 - peak_force_N)",
                                .runs = 40};
    const sweep_options options = {.jobs = 1};
    tuning t[2];
    int before = 0;
    DONE(tune_init(&t[0], &asked, &f));
    DONE(tune_init(&t[1], &asked, &f));
    sweep_store *store;
    DONE(sweep_store_open(&store, NULL, &t[0].plan, &f));
    store->values = count_looked;
    for (int i = 0; i < 2; i++) {
        before = told;
        t[i].improved = count_told;
        DONE(tune_run(&t[i], store, &options, &f));
    }
    assert_true(before > 0 && told == before);
    assert_true(t[0].done == t[1].done && t[0].found[0] == t[1].found[0]);
    sweep_store_close(store);
    tune_finish(&t[0]);
    tune_finish(&t[1]);
    assert_int_equal(most_looked, 1);
}

// What is not allowed ranks behind all that is.
TEST(a_condition_binds)
{
    char *vary[] = {"motor.voltage=0.5:3"};
    scenario base = {.name = "touch", .parameters = rig_parameters(NULL)};
    base.parameters.run.duration = 0.3;
    tune_request asked = {.base = &base,
                          .vary = vary,
                          .vary_count = 1,
                          .minimise = "first_contact_s",
                          .subject = "peak_force_N <= 2",
                          .runs = 80};
    SCOPED(tune_finish) tuning t;
    search(&t, &asked, 1);
    scenario s = base;
    s.parameters.motor.voltage = t.found[0];
    run_result r = run_done(&s, false);
    assert_true(r.summary.peak_force_N <= 2 && r.summary.peak_force_N > 1.98);
    run_finish(&r);
    tune_finish(&t);

    // one that nothing meets: the nearest, refused
    asked.subject = "peak_force_N <= 0-1";
    search(&t, &asked, 1);
    assert_true(t.best.rank >= TUNE_REFUSED);
    assert_true(t.found[0] < 1);
}

// The hub's velocity gain whose sampled pole in contact decays fastest, kp = 20 at 200
// Hz: 2.162 by the matrix exponential of M x'' + D x' + 4 k2 x = K u, on a grid of
// 0.0005.
TEST(the_most_damped_pole_is_that_of_eigenvalues)
{
    char *vary[] = {"control.kv=0.5:3.5"};
    scenario base = {.name = "hold",
                     .parameters = rig_parameters(
                         SETTINGS("control.law=hybrid", "control.lock=force",
                                  "control.kp=20", "control.rate=200",
                                  "control.force=0.001", "motor.stiction=0",
                                  "sensor.ideal=true", "run.duration=0.02"))};
    const tune_request asked = {.base = &base,
                                .vary = vary,
                                .vary_count = 1,
                                .minimise = "growth_per_s",
                                .runs = 60,
                                .growth = linear_growth};
    SCOPED(tune_finish) tuning t;
    search(&t, &asked, 1);
    assert_true(fabs(t.found[0] - 2.162) <= 0.01 * 2.162);
}

TEST(what_cannot_be_asked_is_refused)
{
    static const struct {
        const char *vary, *minimise, *subject, *says;
    } wrong[] = {
        {"motor.voltage=1,2", "steps", NULL, "expected a range, motor.voltage=a:b"},
        {"motor.volt=1:2", "steps", NULL, "motor.volt"},
        {"motor.voltage=1:2", "stepss", NULL, "--minimise 'stepss', column 1: "},
        {"motor.voltage=1:2", "cpu_time_s", NULL, "--minimise 'cpu_time_s', column 1: "},
        {"motor.voltage=1:2", "steps", "steps<3", "--subject 'steps<3' is no condition"},
        {"motor.voltage=1:2", "steps", "steps<=", "--subject '', column 1: "},
        {"motor.voltage=1:2", "settled_percent", NULL,
         "there is no quantity 'settled_percent'"},
    };
    scenario base = {.name = "touch", .parameters = rig_parameters(NULL)};
    for (EACH(c, wrong)) {
        char *vary = (char *)c->vary;
        const tune_request asked = {.base = &base,
                                    .vary = &vary,
                                    .vary_count = 1,
                                    .minimise = c->minimise,
                                    .subject = c->subject,
                                    .runs = 10};
        tuning t;
        REFUSED(STATUS_BAD_ARGUMENT, c->says, tune_init(&t, &asked, &f));
    }
}
