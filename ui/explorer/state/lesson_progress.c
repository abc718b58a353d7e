#include "ui/explorer/state/lesson_progress.h"

#include <assert.h>
#include <math.h>

// A quantity of the present run, which must have come to its end; NaN if it did not occur.
static double quantity_of(const session *s, int quantity)
{
    return s->computing == NULL ? summary_value(&s->run.summary, quantity) : (double)NAN;
}

// Whether the quantity of the present run is in a range, as a share of the baseline's.
static bool ratio_is_in_range(const lesson_step *step, const session *s)
{
    if (!s->has_other) {
        return false;
    }
    const double ratio =
        quantity_of(s, step->quantity) / summary_value(&s->other.summary, step->quantity);
    return ratio >= step->low && ratio <= step->high;
}

bool lesson_step_is_done(const lesson_step *step, const lesson_progress *p, const session *s,
                         const run_list *pinned)
{
    assert(step != NULL && p != NULL && s != NULL && pinned != NULL);

    // to be read or answered
    switch (step->check) {
    case LESSON_READ:
        return true;
    case LESSON_NUMBER: {
        const double truth = quantity_of(s, step->quantity);
        return p->answered && fabs(p->answer - truth) <= step->within * fabs(truth);
    }
    case LESSON_CHOICE:
        return p->answered && p->answer == step->right + 1;

    // to be done: with the cursor, a parameter or the runs
    case LESSON_CURSOR: {
        const double instant = quantity_of(s, step->quantity) + step->offset;
        return fabs(s->now - instant) <= step->within;
    }
    case LESSON_VALUE: {
        const parameters now = session_parameters_at(s, s->now);
        const double value = parameter_get(&now, step->parameter);
        return fabs(value - step->value) <= step->within * fabs(step->value);
    }
    case LESSON_PINNED:
        return pinned->count >= step->pinned;
    case LESSON_RATIO:
        return ratio_is_in_range(step, s);
    }
    return false;
}
