#include "src/study/robust/tune.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef WITH_NLOPT
#include <nlopt.h>
#endif

#include "src/base/expression.h"
#include "src/base/words.h"

// --- judging ---------------------------------------------------------------------------

// The quantities that an expression is evaluated with: those of a law's runs, or of one
// run.
typedef struct judged {
    const robust_law *law; // NULL: a run
    const double *run;     // summary_count numbers
    double growth;         // of the loop's slowest part, by its poles [1/s]
} judged;

// The one key that no run has.
static const char growth_key[] = "growth_per_s";
enum { GROWTH = 10000 };

// The number of a key: quantities of the run or the law in their order, -1 if there is
// none.
static int find_key(void *context, const char *name, const char **near)
{
    const judged *of = context;
    nearest_word nearest = nearest_begin(name);
    nearest_try(&nearest, growth_key);
    if (strcmp(name, growth_key) == 0) {
        return GROWTH;
    }
    for (int i = 0;; i++) {
        const char *key = NULL;
        if (of->law != NULL) {
            key = robust_key(i);
        } else if (i < summary_count) {
            key = summary_table[i].key;
        }
        if (key == NULL) {
            break;
        }
        if (strcmp(key, name) == 0 && (of->law != NULL || !summary_table[i].timing)) {
            return i;
        }
        nearest_try(&nearest, key);
    }
    *near = nearest.best;
    return -1;
}

static double value_of_key(const void *context, int key)
{
    const judged *of = context;
    if (key == GROWTH) {
        return of->growth;
    }
    if (of->law != NULL) {
        return robust_value(of->law, key);
    }
    return of->run[key];
}

static status evaluate_expression(const char *text, judged *of, double *value, fault *f)
{
    expression e;
    const status code = expression_read(&e, text, find_key, of, f);
    if (code == STATUS_OK) {
        *value = expression_evaluate(&e, value_of_key, of);
    } else {
        *value = (double)NAN;
    }
    return code;
}

// Reads a condition EXPR<=X or EXPR>=X and finds by how much it is missed, as a share of
// X; 0 or less if it is met.
static status read_subject(const char *text, judged *of, double *excess, fault *f)
{
    const char *sign = strpbrk(text, "<>");
    char left[512];
    double a = 0, b = 0;
    FAULT_IF(sign == NULL || sign[1] != '=' || sign - text >= (long)sizeof left, f,
             STATUS_BAD_ARGUMENT, "'%.100s' is no condition, expected EXPR<=X or EXPR>=X",
             text);
    snprintf(left, sizeof left, "%.*s", (int)(sign - text), text);
    TRY(evaluate_expression(left, of, &a, f));
    TRY(evaluate_expression(sign + 2, of, &b, f));
    const double beyond = *sign == '<' ? a - b : b - a;
    *excess = beyond / fmax(fabs(b), 1e-300);
    return STATUS_OK;
}

// Evaluates and ranks a result; the least rank is the best. A result within the condition
// ranks by its value, one beyond it by how far, and one without a number comes last, by
// the share of its runs that settle.
static status judge_result(const tune_request *asked, judged *of, tune_result *out,
                           fault *f)
{
    fault why = {.path = ""};
    double excess = 0;
    const char *option = "minimise";
    status code = evaluate_expression(asked->minimise, of, &out->value, &why);
    if (code == STATUS_OK && asked->subject != NULL) {
        option = "subject";
        code = read_subject(asked->subject, of, &excess, &why);
    }
    FAULT_IF(code != STATUS_OK, f, code, "--%s %.900s", option, why.text);
    if (!isfinite(out->value) || isnan(excess)) {
        const double settled = of->law != NULL ? of->law->settled : 0;
        out->rank = TUNE_REFUSED * 1e100 * (2 - settled);
    } else if (excess > 0) {
        out->rank = TUNE_REFUSED * (1 + fmin(excess, 1e90));
    } else {
        out->rank = out->value;
    }
    return STATUS_OK;
}

status tune_apply(const tuning *t, const double *values, scenario *s, fault *f)
{
    return sweep_axes_scenario(t->plan.axes, t->asked.vary_count, values, t->asked.base,
                               s, f);
}

// Finds the growth of the scenario's loop, without drawn values, if an expression asks
// for it.
static status find_growth(const tune_request *asked, const scenario *s, double *growth,
                          fault *f)
{
    const bool wanted =
        strstr(asked->minimise, growth_key) != NULL ||
        (asked->subject != NULL && strstr(asked->subject, growth_key) != NULL);
    FAULT_IF(wanted && (asked->growth == NULL || s->parameters.control.law == LAW_NONE),
             f, STATUS_BAD_ARGUMENT, "'%s' needs a control law", growth_key);
    if (wanted) {
        return asked->growth(s, growth, f);
    }
    return STATUS_OK;
}

status tune_evaluate(tuning *t, size_t evaluation, const double *values, const char *name,
                     sweep_store *store, const sweep_options *options, tune_result *out,
                     fault *f)
{
    assert(evaluation < t->most);
    const tune_request *asked = &t->asked;
    char word[48];
    sweep_options only = *options;
    sweep_progress progress;
    double run[SUMMARY_NUMBERS];
    SCOPED(free_kept) double *column = calloc(t->each, sizeof *column);
    *out = (tune_result){.value = (double)NAN, .rank = (double)INFINITY};
    snprintf(word, sizeof word, "%zu of %zu:", evaluation + 1, t->most);
    only.context = word; // of the progress line
    only.share = (sweep_share){(int)evaluation + 1, (int)t->most};
    for (size_t i = 0; i < t->each; i++) {
        memcpy(t->plan.chosen +
                   sweep_share_run(only.share, i) * (size_t)t->plan.axis_count,
               values, (size_t)asked->vary_count * sizeof *values);
    }
    if (column == NULL) {
        return fault_no_memory(f);
    }
    TRY(sweep_run(&t->plan, store, &only, &progress, f));
    FAULT_IF(progress.done < progress.total, f, STATUS_STOPPED, "%s",
             status_text(STATUS_STOPPED));

    out->computed = progress.done_now;

    // the store may be that of another search: compare the values that it has
    for (int k = 0; k < asked->vary_count; k++) {
        TRY(sweep_quantity(store, t->plan.run_count, only.share, t->plan.axes[k].name,
                           column, NULL, f));
        FAULT_IF(!isnan(column[0]) && column[0] != values[k], f, STATUS_BAD_ARGUMENT,
                 "the database is of another search: run %zu has %s = %g, not %g",
                 evaluation + 1, t->plan.axes[k].name, column[0], values[k]);
    }

    // the quantities of the law's runs or of the single run, and the judgement
    judged of = {asked->over != NULL ? &out->law : NULL, run, (double)NAN};
    scenario derived;
    TRY(tune_apply(t, values, &derived, f));
    if (find_growth(asked, &derived, &of.growth, NULL) == STATUS_NO_MEMORY) {
        return fault_no_memory(f);
    }
    if (of.law != NULL) {
        TRY(robust_law_of(&out->law, name, &t->plan, only.share, store, f));
    }
    for (int q = 0; q < summary_count && of.law == NULL; q++) {
        TRY(sweep_quantity(store, t->plan.run_count, only.share, summary_table[q].key,
                           column, NULL, f));
        run[q] = column[0];
    }
    return judge_result(asked, &of, out, f);
}

// --- what is asked for -----------------------------------------------------------------

// Checks a request but for what it varies: the set, the law, and both expressions, which
// are tried on results of zeros.
static status check_request(const tune_request *asked, fault *f)
{
    const double run[SUMMARY_NUMBERS] = {0};
    const robust_law law = {.runs = 1};
    const robust_set *over = asked->over;
    judged of = {over != NULL ? &law : NULL, run, 0};
    tune_result unused;
#ifndef WITH_NLOPT
    return fault_set(f, STATUS_BAD_ARGUMENT,
                     "this program was built without NLopt, whose minimisers tune needs");
#endif
    FAULT_IF(over != NULL && over->case_count > 0, f, STATUS_BAD_ARGUMENT,
             "'%.200s' has cases, expected lines PATH=a:b or PATH=v1,v2 only",
             over->file);
    FAULT_IF(over != NULL && asked->base->parameters.control.law == LAW_NONE, f,
             STATUS_BAD_ARGUMENT,
             "%s has no control law, and runs over a set are judged by one",
             asked->base->name);
    TRY(judge_result(asked, &of, &unused, f));
    return find_growth(asked, asked->base, &of.growth, f);
}

// The sweep of all evaluations: the varied parameters, whose values are free, and in each
// evaluation the same draws.
static status make_plan(tuning *t, uint64_t seed, fault *f)
{
    const tune_request *asked = &t->asked;
    const int varied = asked->vary_count,
              drawn = asked->over != NULL ? asked->over->count : 0;
    char *lines[2 * SWEEP_MOST_AXES];
    SCOPED(sweep_finish) sweep draws = {0};
    sweep_request request = {.vary = lines,
                             .vary_count = varied + drawn,
                             .sampling = SWEEP_LATIN,
                             .runs = t->each * t->most,
                             .seed = seed};
    FAULT_IF(varied > SWEEP_MOST_AXES || drawn > SWEEP_MOST_AXES, f, STATUS_BAD_ARGUMENT,
             "at most %d parameters can be varied", SWEEP_MOST_AXES);
    memcpy(lines, asked->vary, (size_t)varied * sizeof *lines);
    if (drawn > 0) {
        const sweep_request set = {asked->over->lines,
                                   drawn,
                                   SWEEP_LATIN,
                                   t->each,
                                   seed,
                                   asked->over->file,
                                   asked->over->line_numbers};
        memcpy(lines + varied, asked->over->lines, (size_t)drawn * sizeof *lines);
        TRY(sweep_init(&draws, asked->base, &set, f));
    }

    TRY(sweep_plan(&t->plan, &request, f));
    for (int i = 0; i < varied; i++) {
        FAULT_IF(!t->plan.axes[i].is_range, f, STATUS_BAD_ARGUMENT,
                 "--vary %.200s: expected a range, %s=a:b", asked->vary[i],
                 t->plan.axes[i].name);
    }
    const size_t count = request.runs * (size_t)(varied + drawn);
    t->plan.chosen = malloc(count * sizeof *t->plan.chosen);
    if (t->plan.chosen == NULL) {
        return fault_no_memory(f);
    }
    for (size_t i = 0; i < count; i++) {
        const size_t run = i / (size_t)(varied + drawn);
        const int axis = (int)(i % (size_t)(varied + drawn));
        if (axis < varied) {
            t->plan.chosen[i] = (double)NAN;
        } else {
            t->plan.chosen[i] = sweep_value(&draws, run / t->most, axis - varied);
        }
    }
    t->plan.base = asked->base;
    t->plan.chosen_by = t->chosen_by;
    for (int i = 0; i < varied; i++) {
        TRY(sweep_check_effect(&t->plan, i, f));
    }
    return STATUS_OK;
}

status tune_init(tuning *t, const tune_request *asked, fault *f)
{
    assert(asked->runs >= 1 && asked->runs <= TUNE_MOST_RUNS);
    int version[3] = {0};
    *t = (tuning){.asked = *asked, .best.rank = (double)INFINITY};
    TRY(check_request(asked, f));
#ifdef WITH_NLOPT
    nlopt_version(&version[0], &version[1], &version[2]);
#endif

    // as many evaluations as runs of each
    if (asked->over != NULL) {
        t->each = (size_t)sqrt((double)asked->runs);
    } else {
        t->each = 1;
    }
    t->most = asked->runs / t->each;
    t->ranks = calloc(t->most, sizeof *t->ranks);
    if (asprintf(&t->chosen_by,
                 "tune --minimise '%s' --subject '%s', %zu runs each, NLopt %d.%d.%d",
                 asked->minimise, asked->subject != NULL ? asked->subject : "", t->each,
                 version[0], version[1], version[2]) < 0) {
        t->chosen_by = NULL;
    }
    status code;
    if (t->ranks != NULL && t->chosen_by != NULL) {
        code = make_plan(t, asked->seed, f);
    } else {
        code = fault_no_memory(f);
    }
    if (code != STATUS_OK) {
        tune_finish(t);
    }
    return code;
}

status tune_unseen(tuning *unseen, const tuning *t, size_t evaluations, fault *f)
{
    assert(evaluations > 0);
    *unseen = (tuning){.asked = t->asked, .most = evaluations, .each = 1};
    if (t->asked.over != NULL) {
        unseen->each = TUNE_UNSEEN;
    } else {
        unseen->other = *t->asked.base;
        unseen->other.parameters.control.seed ^= 1;
        unseen->asked.base = &unseen->other;
    }
    return make_plan(unseen, ~t->asked.seed, f);
}

void tune_finish(tuning *t)
{
    if (t != NULL) {
        sweep_finish(&t->plan);
        robust_law_finish(&t->best.law);
        free(t->chosen_by);
        free(t->ranks);
        *t = (tuning){.done = 0};
    }
}

// --- the search ------------------------------------------------------------------------

#ifdef WITH_NLOPT
typedef struct search {
    tuning *t;
    sweep_store *store;
    const sweep_options *options;
    nlopt_opt minimiser;          // the one at work
    double best[SWEEP_MOST_AXES]; // shares of the ranges
    bool untold;                  // of the best values, which changed in a replay
    status code;
    fault *fault;
} search;

// NLopt's function: the rank of the values at these shares of the ranges. Values that
// were evaluated before are looked up; without evaluations left the search ends.
static double rank_of_shares(unsigned n, const double *shares, double *gradient,
                             void *context)
{
    search *s = context;
    tuning *t = s->t;
    double values[SWEEP_MOST_AXES];
    tune_result found;
    (void)gradient;
    if (t->done == t->most || s->code != STATUS_OK) {
        nlopt_force_stop(s->minimiser);
        return (double)INFINITY;
    }
    for (unsigned i = 0; i < n; i++) {
        const double share = fmin(fmax(shares[i], 0), nextafter(1, 0));
        values[i] = sweep_axis_value_at(&t->plan.axes[i], share);
    }
    for (size_t e = 0; e < t->done; e++) {
        if (memcmp(t->plan.chosen + e * (size_t)t->plan.axis_count, values,
                   n * sizeof *values) == 0) {
            return t->ranks[e];
        }
    }

    s->code = tune_evaluate(t, t->done, values, "tuned", s->store, s->options, &found,
                            s->fault);
    const bool better = s->code == STATUS_OK && found.rank < t->best.rank;
    const bool computed = found.computed > 0;
    s->untold |= better;
    if (better) {
        const tune_result before = t->best;
        t->best = found;
        found = before;
        memcpy(t->found, values, n * sizeof *values);
        memcpy(s->best, shares, n * sizeof *shares);
    }
    robust_law_finish(&found.law);
    if (s->code == STATUS_OK) {
        t->ranks[t->done++] = better ? t->best.rank : found.rank;
    }
    if (s->untold && computed && s->code == STATUS_OK && t->improved != NULL) {
        s->untold = false;
        s->code = t->improved(t->context, t, s->fault);
    }
    return t->ranks[t->done > 0 ? t->done - 1 : 0];
}

// Searches with a method of NLopt from the best values so far, with first steps of a
// share of the ranges, for at most `most` evaluations.
static void search_with(search *s, nlopt_algorithm method, double step, size_t most)
{
    double start[SWEEP_MOST_AXES], least;
    memcpy(start, s->best, sizeof start);
    s->minimiser = nlopt_create(method, (unsigned)s->t->asked.vary_count);
    if (s->minimiser == NULL ||
        nlopt_set_min_objective(s->minimiser, rank_of_shares, s) < 0 ||
        nlopt_set_lower_bounds1(s->minimiser, 0) < 0 ||
        nlopt_set_upper_bounds1(s->minimiser, 1) < 0 ||
        nlopt_set_initial_step1(s->minimiser, step) < 0 ||
        nlopt_set_maxeval(s->minimiser, (int)most) < 0 ||
        nlopt_optimize(s->minimiser, start, &least) == NLOPT_OUT_OF_MEMORY) {
        s->code = fault_no_memory(s->fault);
    }
    nlopt_destroy(s->minimiser);
}

status tune_run(tuning *t, sweep_store *store, const sweep_options *options, fault *f)
{
    assert(t->done == 0);
    search s = {.t = t, .store = store, .options = options, .fault = f};

    // begin at the scenario's values: bisection finds their shares of the ranges
    for (int i = 0; i < t->asked.vary_count; i++) {
        const sweep_axis *axis = &t->plan.axes[i];
        const double given = sweep_axis_get(axis, &t->asked.base->parameters);
        double low = 0, high = 1;
        for (int k = 0; k < 50; k++) {
            const double middle = (low + high) / 2;
            if (sweep_axis_value_at(axis, middle) < given) {
                low = middle;
            } else {
                high = middle;
            }
        }
        s.best[i] = high;
    }

    rank_of_shares((unsigned)t->asked.vary_count, s.best, NULL, &s);

    // search the whole ranges, then descend from the best values in ever smaller steps
    if (s.code == STATUS_OK) {
        search_with(&s, NLOPT_GN_DIRECT_L, 0.25, t->most / 2);
    }
    double step = 0.1;
    for (int i = 0; i < 50 && s.code == STATUS_OK && t->done < t->most; i++) {
        search_with(&s, NLOPT_LN_NELDERMEAD, step, t->most - t->done);
        step /= 2;
    }
    return s.code;
}
#else
status tune_run(tuning *t, sweep_store *store, const sweep_options *options, fault *f)
{
    (void)t, (void)store, (void)options;
    return fault_set(f, STATUS_BAD_ARGUMENT, "this program was built without NLopt");
}
#endif
