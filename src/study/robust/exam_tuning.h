// Tuning a law over an exam: the values of some of its parameters with which the fewest
// runs of the exam miss its bounds.
//
// A search needs more than a share, which does not tell near from far. The loss of a run
// grows from 0 to 1 about the bounds: of its largest ratio w of a quantity to its bound
// it is w^16/(1 + w^16), a half at the bound; a run that failed or never settles has 1.
#pragma once

#include "src/study/robust/evolution.h"
#include "src/study/robust/law_exam.h"
#include "src/study/sweep_axis.h"

typedef struct exam_tuning {
    exam_request asked; // with one law, that of the scenario
    sweep_axis axes[EVOLUTION_MOST];
    int axis_count;
    size_t evaluations;            // at most, and at least a generation's
    size_t done;                   // evaluations so far
    double given[EVOLUTION_MOST];  // values of the scenario
    double found[EVOLUTION_MOST];  // the best so far
    double given_loss, found_loss; // mean over the runs
    // told after each generation, and whether it found better values; its failure ends
    // the search. NULL: nobody
    status (*told)(void *context, const struct exam_tuning *t, bool better, fault *f);
    void *context;
} exam_tuning;

// Reads "PATH=a:b" or "PATH=a:b:log" for each parameter. STATUS_BAD_ARGUMENT, or
// STATUS_BAD_SCENARIO where the law does not take the ends of a range, with a sentence;
// exam_tuning_finish in any case.
status exam_tuning_init(exam_tuning *t, const exam_request *asked, char *const *vary,
                        int vary_count, size_t evaluations, fault *f);
void exam_tuning_finish(exam_tuning *t);

// The scenario with values of the varied parameters; it borrows all but its parameters.
status exam_tuning_apply(const exam_tuning *t, const double *values, scenario *s,
                         fault *f);

// The exam with values of the varied parameters; law_exam_finish in any case.
status exam_tuning_exam(const exam_tuning *t, const double *values, size_t cases,
                        uint64_t seed, const exam_options *options, law_exam *e,
                        fault *f);

// The mean loss of all runs of an exam of one law.
double exam_loss(const law_exam *e);

// Searches from the scenario's values until the evaluations are spent. STATUS_STOPPED
// keeps the best so far.
status exam_tuning_run(exam_tuning *t, const exam_options *options, fault *f);
