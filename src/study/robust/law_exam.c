#include "src/study/robust/law_exam.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/tables/parameters.h"
#include "src/study/batch.h"

// The bounds that a run has to keep.
#define MOST_OVERSHOOT       30.0 // of the commanded force [%]
#define MOST_SETTLING        0.3  // [s]
#define MOST_SETTLING_LOSING 0.6  // of a run that lost contact [s]
#define MOST_ERROR           5.0  // steady error, of the commanded force [%]
#define MOST_LATENESS        1.5  // time of first contact over open-loop's

// A run of the exam: a law in a case at a force, with the case's push or without; or,
// with law -1, open-loop, which gives the time of first contact to compare with.
typedef struct exam_run {
    size_t of_case;
    int law, force;
    bool pushed;
} exam_run;

typedef struct exam_work {
    law_exam *exam;
    const exam_options *options;
    action *actions; // of each run, room for those of the base and a push
    exam_run *runs;
    summary *summaries;
    bool *taken; // whether a run was done
} exam_work;

static void exam_work_finish(exam_work *w)
{
    free(w->actions);
    free(w->runs);
    free(w->summaries);
    free(w->taken);
}

static exam_verdict *verdict_at(const law_exam *e, int law, int force, size_t which)
{
    const exam_request *asked = &e->asked;
    assert(law < asked->law_count && force < asked->force_count && which < asked->cases);
    return &e->verdicts[((size_t)law * (size_t)asked->force_count + (size_t)force) *
                            asked->cases +
                        which];
}

const exam_verdict *law_exam_verdict(const law_exam *e, int law, int force, size_t which)
{
    return verdict_at(e, law, force, which);
}

void law_exam_finish(law_exam *e)
{
    free(e->cases);
    free(e->verdicts);
    *e = (law_exam){.runs = 0};
}

// --- the runs --------------------------------------------------------------------------

// Lists the runs, case by case: open-loop's, then each law's at each force, and where the
// case has a push, the same without it. With `runs` NULL it only counts them.
static size_t list_runs(const law_exam *e, exam_run *runs)
{
    size_t count = 0;
    for (size_t i = 0; i < e->asked.cases; i++) {
        const int kinds_of_run = e->cases[i].push != 0 ? 2 : 1;
        if (runs != NULL) {
            runs[count] = (exam_run){.of_case = i, .law = -1};
        }
        count++;
        for (int law = 0; law < e->asked.law_count; law++) {
            for (int k = 0; k < e->asked.force_count * kinds_of_run; k++) {
                if (runs != NULL) {
                    runs[count] = (exam_run){.of_case = i,
                                             .law = law,
                                             .force = k / kinds_of_run,
                                             .pushed = k % kinds_of_run == 0};
                }
                count++;
            }
        }
    }
    return count;
}

// Gives a scenario a law, as its file would. A law that is not the scenario's own keeps
// none of its settings.
static status give_law(scenario *s, int law, double force, fault *f)
{
    control_parameters *control = &s->parameters.control;
    if (control->law != law) {
        control->settings[0] = '\0';
    }
    control->law = law;
    s->parameters.set[PARAMETER_INDEX(control.law)] = 1;
    control->force = force;
    s->parameters.set[PARAMETER_INDEX(control.force)] = 1;
    return parameters_resolve(&s->parameters, f);
}

static status make_run(void *context, size_t i, scenario *made, fault *f)
{
    const exam_work *w = context;
    const exam_request *asked = &w->exam->asked;
    const exam_run *run = &w->runs[i];
    const size_t room = (size_t)asked->base->action_count + 1;

    // the law first, since errors are refused that a law does not read
    scenario base = *asked->base;
    if (run->law < 0) {
        TRY(give_law(&base, LAW_OPEN_LOOP, asked->forces[0], f));
    } else {
        TRY(give_law(&base, asked->laws[run->law], asked->forces[run->force], f));
    }
    return drawn_case_scenario(made, &base, &w->exam->cases[run->of_case], run->pushed,
                               w->actions + i * room, f);
}

static status take_run(void *context, size_t i, const summary *s, fault *f)
{
    exam_work *w = context;
    (void)f;
    w->summaries[i] = *s;
    w->taken[i] = true;
    w->exam->done++;
    return STATUS_OK;
}

static status report_runs(void *context, bool over, fault *f)
{
    const exam_work *w = context;
    (void)over, (void)f;
    if (w->options->report != NULL) {
        w->options->report(w->exam);
    }
    return STATUS_OK;
}

// --- judgement -------------------------------------------------------------------------

// Judges a run by the bounds. `calm` is the same run without its push, by whose overshoot
// it is judged; `open_loop` the time at which open-loop touches the wall [s].
static exam_verdict judge_law_run(const drawn_case *c, double force, double open_loop,
                                  const summary *s, const summary *calm)
{
    // settling counts from the touch, or from a push after it
    double from = s->first_contact_s;
    if (c->push != 0) {
        from = fmax(from, c->push_time);
    }
    const double settled = s->first_contact_s + s->settling_time_s;

    exam_verdict v = {
        .overshoot = 100 * calm->smoothed_over_command_N / force,
        .settling = isnan(settled) ? settled : fmax(0, settled - from),
        .error = 100 * s->steady_error_N / force,
        .separations = s->separations,
        .late = s->first_contact_s / open_loop,
    };
    const double most_settling = v.separations > 0 ? MOST_SETTLING_LOSING : MOST_SETTLING;

    // what is not a number misses its bound, too
    const double ratios[EXAM_BOUNDS] = {
        [EXAM_OVERSHOOT] = v.overshoot / MOST_OVERSHOOT,
        [EXAM_SETTLING] = v.settling / most_settling,
        [EXAM_ERROR] = fabs(v.error) / MOST_ERROR,
        [EXAM_LATENESS] = v.late / MOST_LATENESS,
        [EXAM_RUN] = s->status != STATUS_OK || s->inaccurate ? HUGE_VAL : 0,
    };
    v.within = true;
    v.within_later = v.late <= EXAM_LATER;
    for (int bound = 0; bound < EXAM_BOUNDS; bound++) {
        v.missed[bound] = !(ratios[bound] <= 1);
        v.within = v.within && !v.missed[bound];
        v.within_later = v.within_later && (bound == EXAM_LATENESS || !v.missed[bound]);
        v.worst = isnan(ratios[bound]) ? HUGE_VAL : fmax(v.worst, ratios[bound]);
    }
    return v;
}

// How many cases from the first on have all of their runs.
static size_t count_whole_cases(const exam_work *w)
{
    for (size_t i = 0; i < w->exam->runs; i++) {
        if (!w->taken[i]) {
            return w->runs[i].of_case;
        }
    }
    return w->exam->asked.cases;
}

// Judges all runs of the exam's cases, in the order in which they are listed.
static void judge_law_runs(exam_work *w)
{
    law_exam *e = w->exam;
    double open_loop = (double)NAN;
    for (size_t i = 0; i < e->runs && w->runs[i].of_case < e->asked.cases; i++) {
        const exam_run *run = &w->runs[i];
        const drawn_case *c = &e->cases[run->of_case];
        if (run->law < 0) {
            open_loop = w->summaries[i].first_contact_s;
        } else if (run->pushed) {
            const summary *calm = &w->summaries[c->push != 0 ? i + 1 : i];
            *verdict_at(e, run->law, run->force, run->of_case) =
                judge_law_run(c, e->asked.forces[run->force], open_loop, &w->summaries[i],
                              calm);
        }
    }
}

// --- all of it -------------------------------------------------------------------------

// Tries every error around the scenario, so that one which does not go with it is told
// before the first run.
static status check_cases(const exam_work *w, size_t runs, fault *f)
{
    scenario made;
    for (size_t i = 0; i < runs; i++) {
        if (w->runs[i].law >= 0 && w->runs[i].force == 0) {
            TRY(make_run((void *)w, i, &made, f));
        }
    }
    return STATUS_OK;
}

status law_exam_run(law_exam *e, const exam_request *asked, const exam_options *options,
                    fault *f)
{
    assert(asked->cases >= 1 && asked->cases <= EXAM_MOST_CASES);
    assert(asked->law_count >= 1 && asked->law_count <= EXAM_MOST_LAWS);
    assert(asked->force_count >= 1 && asked->force_count <= EXAM_MOST_FORCES);
    const size_t judged =
        (size_t)asked->law_count * (size_t)asked->force_count * asked->cases;
    *e = (law_exam){.asked = *asked,
                    .cases = calloc(asked->cases, sizeof *e->cases),
                    .verdicts = calloc(judged, sizeof *e->verdicts)};
    if (e->cases == NULL || e->verdicts == NULL) {
        return fault_no_memory(f);
    }
    for (size_t i = 0; i < asked->cases; i++) {
        e->cases[i] = drawn_case_of(asked->base, asked->seed + i);
    }

    // the list of runs, with room for each one's actions and summary
    const size_t runs = list_runs(e, NULL);
    const size_t room = (size_t)asked->base->action_count + 1;
    SCOPED(exam_work_finish)
    exam_work w = {.exam = e,
                   .options = options,
                   .actions = calloc(runs * room, sizeof *w.actions),
                   .runs = calloc(runs, sizeof *w.runs),
                   .summaries = calloc(runs, sizeof *w.summaries),
                   .taken = calloc(runs, sizeof *w.taken)};
    if (w.actions == NULL || w.runs == NULL || w.summaries == NULL || w.taken == NULL) {
        return fault_no_memory(f);
    }
    e->runs = list_runs(e, w.runs);
    TRY(check_cases(&w, runs, f));

    const batch b = {.context = &w,
                     .count = runs,
                     .make = make_run,
                     .take = take_run,
                     .tick = report_runs,
                     .stop = options->stop,
                     .abandon = options->abandon};
    TRY(batch_run(&b, options->jobs, f));

    // an interrupt leaves the first cases
    e->asked.cases = count_whole_cases(&w);
    judge_law_runs(&w);
    FAULT_IF(e->done < runs, f, STATUS_STOPPED,
             "stopped: %zu of %zu cases were done, none is judged", e->asked.cases,
             asked->cases);
    return STATUS_OK;
}

// --- shares ----------------------------------------------------------------------------

// Whether a case has a kind of error; every case has the kind -1.
static bool has_error(const drawn_case *c, int kind)
{
    bool has = kind < 0;
    for (int i = 0; i < c->error_count; i++) {
        has = has || c->errors[i] == kind;
    }
    return has;
}

// Wilson's interval, which holds for shares near 0 and 1, too.
static exam_share share_of(size_t cases, size_t within)
{
    exam_share s = {cases, within, (double)NAN, (double)NAN, (double)NAN};
    if (s.cases == 0) {
        return s;
    }
    const double z = 1.959963984540054, n = (double)s.cases;
    s.share = (double)s.within / n;
    const double middle = (s.share + z * z / (2 * n)) / (1 + z * z / n);
    const double half =
        z / (1 + z * z / n) * sqrt(s.share * (1 - s.share) / n + z * z / (4 * n * n));
    s.low = fmax(middle - half, 0);
    s.high = middle + half;
    return s;
}

exam_share law_exam_share(const law_exam *e, int law, int force, int kind)
{
    size_t cases = 0, within = 0;
    for (size_t i = 0; i < e->asked.cases; i++) {
        if (has_error(&e->cases[i], kind)) {
            cases++;
            within += law_exam_verdict(e, law, force, i)->within;
        }
    }
    return share_of(cases, within);
}

exam_share law_exam_share_later(const law_exam *e, int law, int force)
{
    size_t within = 0;
    for (size_t i = 0; i < e->asked.cases; i++) {
        within += law_exam_verdict(e, law, force, i)->within_later;
    }
    return share_of(e->asked.cases, within);
}
