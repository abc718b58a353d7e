#include "src/rig/first_order_lag.h"

#include <math.h>
#include <stdbool.h>

#include "src/base/plain_math.h"

// For a stride shorter than this share of the time constant the closed form would lose
// too many digits.
#define SHORT_STEP 1e-3

// For lengths that differ by less than this share of the time constant, exp is continued
// to first order: the square of the share is below rounding.
#define SAME_LENGTH 1e-9

// Bisections until a turning point is known to the last digit. Since the value is flat
// there, its instant is needed to half the digits only.
enum { TURN_BISECTIONS = 32 };

// exp(-h/time_constant) for a stride h [s], remembered for strides of the same length.
static double left_after(first_order_lag *y, double h)
{
    const double longer = h - y->interval;
    if (!(fabs(longer) < SAME_LENGTH * y->time_constant)) {
        y->interval = h;
        y->left = plain_exp(-h / y->time_constant);
        return y->left;
    }
    return y->left - y->left * (longer / y->time_constant);
}

// An input over an interval as f = first + slope u + curve u^2, u = t/length.
typedef struct parabola {
    double first, slope, curve;
} parabola;

// The parabola with an input's first and last value and its mean.
static parabola parabola_of(const lag_input *f)
{
    const double curve = 3 * (f->first + f->last) - 6 * f->mean;
    return (parabola){f->first, f->last - f->first - curve, curve};
}

void lag_follow(first_order_lag *y, const lag_input *input)
{
    const double lag = y->time_constant, h = input->length;
    const double first = input->first, last = input->last;
    const bool at_rest = y->value == 0 && first == 0 && last == 0 && input->mean == 0;
    if (lag == 0 || h <= 0 || at_rest) {
        return;
    }

    const parabola f = parabola_of(input);
    const double curve = f.curve, slope = f.slope;
    if (h < SHORT_STEP * lag) {
        // the integrals of u^n exp(-(1 - u) x) over the stride as series in x
        double x = h / lag;
        double of_one = 1 - x / 2 * (1 - x / 3 * (1 - x / 4));
        double of_u = 1.0 / 2 - x / 6 * (1 - x / 4 * (1 - x / 5));
        double of_square = 1.0 / 3 - x / 12 * (1 - x / 5 * (1 - x / 6));
        y->value += x * ((first - y->value) * of_one + slope * of_u + curve * of_square);
        return;
    }

    // the particular solution f - lag f' + lag^2 f'', and a transient that decays
    double r = lag / h;
    double at_start = first - r * slope + 2 * r * r * curve;
    double at_end = last - r * (slope + 2 * curve) + 2 * r * r * curve;
    y->value = at_end + (y->value - at_start) * left_after(y, h);
}

void lag_strike(first_order_lag *y, double pulse)
{
    if (y->time_constant > 0) {
        y->value += pulse / y->time_constant;
    }
}

// --- where it turns --------------------------------------------------------------------

// An interval that input and lag pass through; the functions below take a share u of it.
typedef struct passage {
    const first_order_lag *start;
    const lag_input *input;
    parabola f;
} passage;

static double input_at(const passage *p, double u)
{
    return p->f.first + u * (p->f.slope + u * p->f.curve);
}

// The lag's output at a share u of the interval: it follows the parabola up to there,
// whose mean until then is first + slope u/2 + curve u^2/3.
static double output_at(const passage *p, double u)
{
    first_order_lag y = *p->start;
    const double mean = p->f.first + u * (p->f.slope / 2 + u * p->f.curve / 3);
    lag_follow(&y, &(lag_input){u * p->input->length, p->f.first, input_at(p, u), mean});
    return lag_output(&y, input_at(p, u));
}

// The input less the output. The output rises while this lead is positive and turns where
// it is zero.
static double lead_at(const passage *p, double u)
{
    return input_at(p, u) - output_at(p, u);
}

// Derivative of the lead by u: f' less the lag's rate, lead/time_constant.
static double lead_rate_at(const passage *p, double u)
{
    const double rate = lead_at(p, u) * p->input->length / p->start->time_constant;
    return p->f.slope + 2 * p->f.curve * u - rate;
}

// Where a function changes its sign between two shares, by bisection; at the first of
// them it has the sign of `sign`.
static double zero_between(const passage *p, double (*function)(const passage *, double),
                           double from, double to, double sign)
{
    for (int i = 0; i < TURN_BISECTIONS; i++) {
        const double middle = (from + to) / 2;
        if (function(p, middle) * sign > 0) {
            from = middle;
        } else {
            to = middle;
        }
    }
    return (from + to) / 2;
}

// The lead is a straight line plus an exponential exp(-u length/time_constant), as the
// parabola's particular solution shows. So it has one extreme at most and is zero twice
// at most.
int lag_turns(const first_order_lag *y, const lag_input *input,
              double turns[LAG_MOST_TURNS])
{
    const passage p = {y, input, parabola_of(input)};
    if (!(input->length > 0)) {
        return 0;
    }

    // without a lag the parabola itself turns
    if (y->time_constant == 0) {
        const double top = -p.f.slope / (2 * p.f.curve);
        turns[0] = input_at(&p, top);
        return top > 0 && top < 1 ? 1 : 0;
    }

    // the signs at both ends; where the lead is zero at an end its rate says which sign
    // it has next to it
    const double rate = lead_rate_at(&p, 0), last_rate = lead_rate_at(&p, 1);
    const double lead = lead_at(&p, 0), last_lead = lead_at(&p, 1);
    const double first = lead != 0 ? lead : rate;
    const double last = last_lead != 0 ? last_lead : -last_rate;
    if (first * last < 0) {
        turns[0] = output_at(&p, zero_between(&p, lead_at, 0, 1, first));
        return 1;
    }

    // With one sign at both ends, the lead is zero twice or never: it has to shrink
    // first, grow at last, and have the other sign at its extreme
    if (!(first * rate < 0 && first * last_rate > 0)) {
        return 0;
    }
    const double middle = zero_between(&p, lead_rate_at, 0, 1, rate);
    if (!(first * lead_at(&p, middle) < 0)) {
        return 0;
    }
    turns[0] = output_at(&p, zero_between(&p, lead_at, 0, middle, first));
    turns[1] = output_at(&p, zero_between(&p, lead_at, middle, 1, -first));
    return 2;
}
