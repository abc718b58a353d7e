#include "src/engines/series/chain_series_parts.h"

// Sums of a block's lanes.
static inline double sum_of_lanes(const double sum[SERIES_LANES])
{
    return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

void chain_series_reach_point(chain_series *s, const arm *a, int n)
{
    const chain_rows *r = &s->rows;
    double x[SERIES_LANES] = {0}, y[SERIES_LANES] = {0}, along = 0;
    for (int b = 0; b < r->blocks; b++) {
        const size_t block = (size_t)b * SERIES_LANES;
        const double *cosine = r->cosine + chain_term(n, block), *length = r->length + block;
        const double *sine = r->sine + chain_term(n, block);
        for (int j = 0; j < SERIES_LANES; j++) {
            x[j] += length[j] * cosine[j];
            y[j] += length[j] * sine[j];
        }
    }
    s->tip_x.term[n] = sum_of_lanes(x);
    s->tip_y.term[n] = sum_of_lanes(y);
    const double last = r->length[s->last_place];
    s->reach_x.term[n] =
        (n == 0 ? a->wall.x : 0) - (s->tip_x.term[n] - last * last_of(s, r->cosine, n));
    s->reach_y.term[n] =
        (n == 0 ? a->wall.y : 0) - (s->tip_y.term[n] - last * last_of(s, r->sine, n));
    for (int i = 0; i <= n; i++) {
        along += last_of(s, r->cosine, i) * s->reach_x.term[n - i] +
                 last_of(s, r->sine, i) * s->reach_y.term[n - i];
    }
    s->along.term[n] = along;
}

// The n-th coefficient of the square of a polynomial of `count` terms.
static double square_term(const double *x, int count, int n)
{
    double sum = 0;
    for (int i = n < count ? 0 : n - count + 1; 2 * i < n; i++) {
        sum += x[i] * x[n - i];
    }
    return 2 * sum + (n % 2 == 0 ? x[n / 2] * x[n / 2] : 0);
}

// The same of the terms of all links, each weighted.
static double weighted_square_term(const chain_series *s, const double *terms,
                                   const double *weights, int n)
{
    double sum[SERIES_LANES] = {0};
    for (int b = 0; b < s->rows.blocks; b++) {
        const size_t block = (size_t)b * SERIES_LANES;
        const double *of = terms + chain_term(0, block);
        double square[SERIES_LANES] = {0};
        for (int i = n < s->order ? 0 : n - s->order + 1; 2 * i <= n; i++) {
            const double twice = 2 * i < n ? 2 : 1;
            for (int j = 0; j < SERIES_LANES; j++) {
                square[j] += twice * of[i * SERIES_LANES + j] * of[(n - i) * SERIES_LANES + j];
            }
        }
        for (int j = 0; j < SERIES_LANES; j++) {
            sum[j] += weights[block + (size_t)j] * square[j];
        }
    }
    return sum_of_lanes(sum);
}

// The n-th coefficient of the product of a wall's damper and the gap's rate in x.
static double damper_term(const chain_series *s, int n)
{
    double sum = 0;
    for (int i = n < s->order ? 0 : n - s->order + 1; i <= n && i < s->order; i++) {
        sum += s->damper.term[i] * (n - i + 1) * s->gap.term[n - i + 1];
    }
    return sum;
}

void chain_series_sum_losses(chain_series *s, const arm *a)
{
    const chain_rows *r = &s->rows;
    const int order = s->order;
    double rate[SERIES_TERMS];
    for (int i = 0; i < order; i++) {
        rate[i] = a->hub_spring ? s->hub_rate.term[i] : chain_series_first_rate(s, i);
    }

    // each square to its last term: where the rates' series has ended, theirs has not
    s->square_terms = 2 * order - 1;
    const double root = arm_joint_damping(a, 0), per_length = 1 / s->length;
    for (int n = 0; n < s->square_terms; n++) {
        s->hub_square.term[n] = square_term(rate, order, n);
        s->dissipation.term[n] = 0;
        if (s->damped) {
            s->dissipation.term[n] =
                per_length * weighted_square_term(s, r->bend_rate, r->damping, n) +
                root * square_term(s->root_rate.term, order, n);
        }
        for (int i = 0; i < a->damped_modes; i++) {
            s->dissipation.term[n] += square_term(s->mode_rate[i].term, order, n);
        }
        if (a->air_drag > 0) {
            const double moving = weighted_square_term(s, r->air_x, r->air, n) +
                                  weighted_square_term(s, r->air_y, r->air, n);
            const double turning = weighted_square_term(s, r->rate, r->air_turning, n);
            s->dissipation.term[n] += per_length * (moving + turning);
        }
        if (s->mode.contact && s->gives) {
            s->wall_loss.term[n] = -damper_term(s, n);
        }
    }
}
