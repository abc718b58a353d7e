// Filters of the sensors, written from the manual: lag, leak, play.
#include <math.h>

#include "tests/rigs/random_rigs.h"

void lag_take_blow(lag *l, double size)
{
    if (l->T > 0) {
        l->y += size / l->T;
    } else if (l->S > 0) {
        l->w += size / l->S; // y is unchanged after the instant, its charge leaks
    }
}

// Goes on by the time h while the function is the straight line from `begin` to `end`, to
// within `error`. The solution of both equations of a lag is exact.
static void lag_follow(lag *l, double begin, double end, double h, double error)
{
    if (h <= 0) {
        if (l->T == 0) {
            l->y = end;
        }
        return;
    }
    const double s = (end - begin) / h;

    // y = begin - s T + s t + a exp(-t/T)
    double a = 0, base = begin, decay = 0;
    if (l->T > 0) {
        base = begin - s * l->T;
        a = l->y - base;
        decay = exp(-h / l->T);
    }

    // w = base - s S + s t + b exp(-t/T) + c exp(-t/S), where S b' + b takes a
    if (l->S > 0) {
        const double b = l->T > 0 ? a / (1 - l->S / l->T) : 0;
        const double c = l->w - (base - s * l->S) - b, fade = exp(-h / l->S);
        l->w = base - s * l->S + s * h + b * decay + c * fade;
        l->w_error = error + (l->w_error - error) * fade;
        l->w_error = fmax(l->w_error, fmax(error, l->y_error) * (1 - fade));
    }
    l->y = base + s * h + a * decay;
    l->y_error = error + (l->y_error - error) * decay;
}

// A hysteresis holds its value p while (1 - share) x <= p <= (1 + share) x and is taken
// along at these ends. Both bounds of p follow the value x of the lag, from which
// `ripple` is how far it may have been since the last call.
static void play_follow(follower *f, double ripple)
{
    const double error = f->state.y_error + f->rounding + ripple;
    const double lowest = f->state.y - error, highest = f->state.y + error;
    f->play_low =
        fmax((1 - f->share) * lowest, fmin(f->play_low, (1 + f->share) * lowest));
    f->play_high =
        fmax((1 - f->share) * highest, fmin(f->play_high, (1 + f->share) * highest));
}

// Takes a blow. Without a lag the value is infinite for an instant, after which the
// hysteresis comes down with it from above.
static void follower_strike(follower *f, double size)
{
    lag_take_blow(&f->state, size);
    if (f->state.T > 0) {
        play_follow(f, 0);
    } else {
        f->play_low = f->play_high = (double)INFINITY;
    }
}

double turning(const lag *l, const piece *p, double h)
{
    if (l->T == 0) {
        return p->error;
    }
    const double rate = fabs(p->end - l->y) / l->T;
    return h * h / 8 * (fabs(slope(p)) + rate) / l->T;
}

void follower_reach(follower *f, double t)
{
    while (f->piece < f->of->count) {
        const piece *p = &f->of->of[f->piece];

        // blows at the beginning of the piece
        while (f->blow < f->blows->count &&
               f->blows->of[f->blow].time <= f->now + 1e-13 &&
               f->blows->of[f->blow].time < t - INSTANT) {
            follower_strike(f, f->blows->of[f->blow].size);
            f->blow++;
        }
        if (f->now >= t) {
            return;
        }

        // the straight line to the end of the piece or to t
        const double to = fmin(p->to, t), h = to - f->now;
        const double begin = value_within(p, f->now), end = value_within(p, to);
        const double bent = p->to > p->from ? turning(&f->state, p, h) : 0;
        lag_follow(&f->state, begin, end, h, p->error);
        play_follow(f, bent);
        f->now = to;
        if (p->to > t) {
            return;
        }
        f->piece++;
    }
}

follower follower_of(const pieces *of, const blow_list *blows, double rise, double leak)
{
    const double begin = rise == 0 && of->count > 0 ? of->of[0].begin : 0;
    double largest = 0;
    for (size_t i = 0; i < of->count; i++) {
        largest = fmax(largest, fmax(fabs(of->of[i].begin), fabs(of->of[i].end)));
    }
    return (follower){.of = of,
                      .blows = blows,
                      .state = {.T = rise / log(RISE_RATIO), .S = leak, .y = begin},
                      .rounding = FOLLOWED * largest};
}
