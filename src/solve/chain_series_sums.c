#include "src/solve/chain_series_parts.h"

void chain_series_reach_point(chain_series *s, const arm *a, int n)
{
    const chain_rows *r = &s->rows;
    double x = 0, y = 0, along = 0;
    for (int b = 0; b < r->blocks; b++) {
        const double *cosine = r->cosine + chain_term(n, (size_t)b * SERIES_LANES);
        const double *sine = r->sine + chain_term(n, (size_t)b * SERIES_LANES);
        x += ((cosine[0] + cosine[1]) + (cosine[2] + cosine[3])) +
             ((cosine[4] + cosine[5]) + (cosine[6] + cosine[7]));
        y += ((sine[0] + sine[1]) + (sine[2] + sine[3])) +
             ((sine[4] + sine[5]) + (sine[6] + sine[7]));
    }
    s->tip_x.term[n] = x;
    s->tip_y.term[n] = y;
    x -= last_of(s, r->cosine, n);
    y -= last_of(s, r->sine, n);
    s->reach_x.term[n] = (n == 0 ? a->wall.x : 0) - a->link_length * x;
    s->reach_y.term[n] = (n == 0 ? a->wall.y : 0) - a->link_length * y;
    for (int i = 0; i <= n; i++) {
        along += last_of(s, r->cosine, i) * s->reach_x.term[n - i] +
                 last_of(s, r->sine, i) * s->reach_y.term[n - i];
    }
    s->along.term[n] = along;
}

void chain_series_sum_gap(chain_series *s, const arm *a)
{
    const chain_rows *r = &s->rows;
    for (int n = 0; n <= s->order + 1; n++) {
        chain_series_reach_point(s, a, n);
        double gap =
            a->link_length * (a->wall.sine * s->tip_x.term[n] - a->wall.cosine * s->tip_y.term[n]);
        if (a->wall.kind == WALL_POINT) {
            gap = 0;
            for (int i = 0; i <= n; i++) {
                gap += last_of(s, r->cosine, i) * s->reach_y.term[n - i] -
                       last_of(s, r->sine, i) * s->reach_x.term[n - i];
            }
        }
        s->gap.term[n] = gap;
    }
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

// The same of the bends' rates, summed over all inner joints.
static double bend_square_term(const chain_series *s, int n)
{
    const chain_rows *r = &s->rows;
    double sum[SERIES_LANES] = {0};
    for (int b = 0; b < r->blocks; b++) {
        const double *of = r->bend_rate + chain_term(0, (size_t)b * SERIES_LANES);
        for (int i = n < s->order ? 0 : n - s->order + 1; 2 * i <= n; i++) {
            const double twice = 2 * i < n ? 2 : 1;
            for (int j = 0; j < SERIES_LANES; j++) {
                sum[j] += twice * of[i * SERIES_LANES + j] * of[(n - i) * SERIES_LANES + j];
            }
        }
    }
    return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

void chain_series_sum_losses(chain_series *s, const arm *a)
{
    const int order = s->order;
    double rate[SERIES_TERMS];
    for (int i = 0; i < order; i++) {
        rate[i] = a->hub_spring ? s->hub_rate.term[i] : chain_series_first_rate(s, i);
    }

    // each square to its last term: where the rates' series has ended, theirs has not
    s->square_terms = 2 * order - 1;
    for (int n = 0; n < s->square_terms; n++) {
        const double inner = s->damped ? bend_square_term(s, n) : 0;
        const double root = s->damped ? square_term(s->root_rate.term, order, n) : 0;
        s->hub_square.term[n] = square_term(rate, order, n);
        s->dissipation.term[n] = a->joint_damping * inner + a->hub_joint_damping * root;
    }
}
