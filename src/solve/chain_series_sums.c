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

void chain_series_sum_losses(chain_series *s, const arm *a)
{
    const chain_rows *r = &s->rows;
    for (int n = 0; n < s->order; n++) {
        double hub = 0, root = 0, inner = 0;
        for (int i = 0; i <= n; i++) {
            const double w =
                a->hub_spring ? s->hub_rate.term[i] : r->rate[chain_term(i, s->first_place)];
            const double v = a->hub_spring ? s->hub_rate.term[n - i]
                                           : r->rate[chain_term(n - i, s->first_place)];
            hub += w * v;
            root += s->root_rate.term[i] * s->root_rate.term[n - i];
        }
        if (s->damped) {
            double sum[SERIES_LANES] = {0};
            for (int b = 0; b < r->blocks; b++) {
                const double *of = r->bend_rate + chain_term(0, (size_t)b * SERIES_LANES);
                for (int i = 0; i <= n; i++) {
                    for (int j = 0; j < SERIES_LANES; j++) {
                        sum[j] += of[i * SERIES_LANES + j] * of[(n - i) * SERIES_LANES + j];
                    }
                }
            }
            inner =
                ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
        }
        s->hub_square.term[n] = hub;
        s->dissipation.term[n] = a->joint_damping * inner + a->hub_joint_damping * root;
    }
}
