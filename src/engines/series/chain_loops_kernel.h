// The loops over links, built once for each width of the processor's vectors (loops_wide_1.c and
// its like), which is WIDTH.
#pragma once

#include "src/engines/series/chain_loops.h"

#include "src/engines/by_width.h"

// Blocks are handed to inline functions of this file only.
#pragma GCC diagnostic ignored "-Wpsabi"

// All lanes of a block.
typedef double block __attribute__((vector_size(8 * SERIES_LANES), may_alias));

// Block b of an array by link; coefficient n of block b.
#define AT(row, b)      (((block *)(row))[b])
#define TERM(row, n, b) (((block *)(row))[(b)*SERIES_TERMS + (n)])

#define LOOP            static inline __attribute__((always_inline))

LOOP block all(double x)
{
    return (block){x, x, x, x, x, x, x, x};
}

// Every lane's successor of the first block, and every lane's predecessor of the last one.
LOOP block next_lane(const block *first, double beyond)
{
    const block f = *first;
    return (block){f[1], f[2], f[3], f[4], f[5], f[6], f[7], beyond};
}
LOOP block lane_before(const block *last, double before)
{
    const block l = *last;
    return (block){before, l[0], l[1], l[2], l[3], l[4], l[5], l[6]};
}

static void loop_join(chain_rows *r)
{
    // from a stretch's outer end inwards
    double **m = r->matrix, **in = r->inwards, **out = r->outwards;
    block xx = all(1), xy = all(0), yx = all(0), yy = all(1);
    for (int b = r->blocks - 1; b >= 0; b--) {
        const block axx = AT(m[0], b), axy = AT(m[1], b), ayx = AT(m[2], b), ayy = AT(m[3], b);
        const block zxx = axx * xx + axy * yx, zxy = axx * xy + axy * yy;
        const block zyx = ayx * xx + ayy * yx, zyy = ayx * xy + ayy * yy;
        AT(in[0], b) = xx = zxx;
        AT(in[1], b) = xy = zxy;
        AT(in[2], b) = yx = zyx;
        AT(in[3], b) = yy = zyy;
    }

    // the transposed, the other way
    xx = yy = all(1);
    xy = yx = all(0);
    for (int b = 0; b < r->blocks; b++) {
        const block axx = AT(m[0], b), axy = AT(m[1], b), ayx = AT(m[2], b), ayy = AT(m[3], b);
        AT(out[0], b) = xx;
        AT(out[1], b) = xy;
        AT(out[2], b) = yx;
        AT(out[3], b) = yy;
        const block zxx = axx * xx + ayx * yx, zxy = axx * xy + ayx * yy;
        const block zyx = axy * xx + ayy * yx, zyy = axy * xy + ayy * yy;
        xx = zxx;
        xy = zxy;
        yx = zyx;
        yy = zyy;
    }
    AT(r->whole[0], 0) = xx;
    AT(r->whole[1], 0) = xy;
    AT(r->whole[2], 0) = yx;
    AT(r->whole[3], 0) = yy;
}

// Sums of an order that is a multiple of SERIES_TOGETHER, and of the next ones as far as what is
// known goes: factors that are at hand serve all of them.
LOOP void common_products(chain_rows *r, int n, int b)
{
    const block *sine = &TERM(r->sine, 0, b), *cosine = &TERM(r->cosine, 0, b);
    const block *rate = &TERM(r->rate, n + 1, b);
    const block *gx = &TERM(r->gx, n, b), *gy = &TERM(r->gy, n, b);
    const block none = all(0);
    block s0 = none, s1 = none, s2 = none, s3 = none, c0 = none, c1 = none, c2 = none, c3 = none;
    block m0 = none, m1 = none, m2 = none, m3 = none;

    // w, Gx and Gy of the order itself and of the three beyond, none of those not known yet
    block w1 = none, w2 = none, w3 = none, x1 = none, x2 = none, x3 = none;
    block y1 = none, y2 = none, y3 = none;
    for (int i = 1; i <= n + 1; i++) {
        const block s = sine[i], c = cosine[i], w = rate[-i];
        const block x = i <= n ? gx[-i] : none, y = i <= n ? gy[-i] : none;
        s0 += s * w;
        c0 += c * w;
        m0 += c * y - s * x;
        s1 += s * w1;
        c1 += c * w1;
        m1 += c * y1 - s * x1;
        s2 += s * w2;
        c2 += c * w2;
        m2 += c * y2 - s * x2;
        s3 += s * w3;
        c3 += c * w3;
        m3 += c * y3 - s * x3;
        w3 = w2, w2 = w1, w1 = w;
        x3 = x2, x2 = x1, x1 = x;
        y3 = y2, y2 = y1, y1 = y;
    }

    AT(r->known_s, b) = s0;
    AT(r->known_c, b) = c0;
    AT(r->moment, b) = m0;
    AT(r->next_s[0], b) = s1;
    AT(r->next_c[0], b) = c1;
    AT(r->next_moment[0], b) = m1;
    AT(r->next_s[1], b) = s2;
    AT(r->next_c[1], b) = c2;
    AT(r->next_moment[1], b) = m2;
    AT(r->next_s[2], b) = s3;
    AT(r->next_c[2], b) = c3;
    AT(r->next_moment[2], b) = m3;
}

// What another order lacks still, `later` orders behind those sums: its first and last products.
LOOP void own_products(chain_rows *r, int n, int later, int b)
{
    const block *sine = &TERM(r->sine, 0, b), *cosine = &TERM(r->cosine, 0, b);
    const block *rate = &TERM(r->rate, 0, b);
    const block *gx = &TERM(r->gx, 0, b), *gy = &TERM(r->gy, 0, b);
    block of_s = AT(r->next_s[later - 1], b), of_c = AT(r->next_c[later - 1], b);
    block moment = AT(r->next_moment[later - 1], b);
    for (int i = 1; i <= later; i++) {
        const int high = n + 2 - i;
        of_s += sine[i] * rate[n + 1 - i] + sine[high] * rate[i - 1];
        of_c += cosine[i] * rate[n + 1 - i] + cosine[high] * rate[i - 1];
        moment += cosine[i] * gy[n - i] - sine[i] * gx[n - i];
    }
    for (int i = 2; i <= later; i++) {
        const int high = n + 2 - i;
        moment += cosine[high] * gy[i - 2] - sine[high] * gx[i - 2];
    }
    AT(r->known_s, b) = of_s;
    AT(r->known_c, b) = of_c;
    AT(r->moment, b) = moment;
}

// All products of one of the first orders.
LOOP void first_products(chain_rows *r, int n, int b)
{
    const block *sine = &TERM(r->sine, 0, b), *cosine = &TERM(r->cosine, 0, b);
    const block *rate = &TERM(r->rate, 0, b);
    const block *gx = &TERM(r->gx, 0, b), *gy = &TERM(r->gy, 0, b);
    block of_s = sine[n + 1] * rate[0], of_c = cosine[n + 1] * rate[0], moment = all(0);
    for (int i = 1; i <= n; i++) {
        of_s += sine[i] * rate[n + 1 - i];
        of_c += cosine[i] * rate[n + 1 - i];
        moment += cosine[i] * gy[n - i] - sine[i] * gx[n - i];
    }
    AT(r->known_s, b) = of_s;
    AT(r->known_c, b) = of_c;
    AT(r->moment, b) = moment;
}

static void loop_products(chain_rows *r, const chain_order *o)
{
    const int later = o->n % SERIES_TOGETHER;
    for (int b = 0; b < r->blocks; b++) {
        if (o->n < SERIES_TOGETHER) {
            first_products(r, o->n, b);
        } else if (later == 0) {
            common_products(r, o->n, b);
        } else {
            own_products(r, o->n, later, b);
        }
    }
}

static void loop_bends(chain_rows *r, const chain_order *o)
{
    const int last = r->blocks - 1;
    for (int b = 0; b <= last; b++) {
        const block angle = TERM(r->angle, o->n, b), rate = TERM(r->rate, o->n, b);
        const block angle_beyond =
            b < last ? TERM(r->angle, o->n, b + 1) : next_lane(&TERM(r->angle, o->n, 0), 0);
        const block rate_beyond =
            b < last ? TERM(r->rate, o->n, b + 1) : next_lane(&TERM(r->rate, o->n, 0), 0);
        const block turn = rate_beyond - rate;
        TERM(r->bend_rate, o->n, b) = turn;
        AT(r->torque, b) = AT(r->stiffness, b) * (angle_beyond - angle) + AT(r->damping, b) * turn;
    }
}

static void loop_prepare(chain_rows *r, const chain_order *o)
{
    const block turns = all(o->n + 1);
    block inner = lane_before(&AT(r->torque, r->blocks - 1), -o->root);
    for (int b = 0; b < r->blocks; b++) {
        const block x = -turns * AT(r->known_s, b), y = turns * AT(r->known_c, b);
        const block outer = AT(r->torque, b), known = (outer - inner) - AT(r->moment, b);
        const block moment = known - AT(r->back_x, b) * x - AT(r->back_y, b) * y;
        inner = outer;
        const block turn = moment * AT(r->inv_d, b);
        AT(r->rho_x, b) = x;
        AT(r->rho_y, b) = y;
        AT(r->moment, b) = moment;
        AT(r->add_x, b) = AT(r->rho_xx, b) * x + AT(r->rho_xy, b) * y + AT(r->ux, b) * turn;
        AT(r->add_y, b) = AT(r->rho_xy, b) * x + AT(r->rho_yy, b) * y + AT(r->uy, b) * turn;
    }
}

static void loop_sweep(chain_rows *r)
{
    double **m = r->matrix, **in = r->inwards, **out = r->outwards;
    const int last = r->blocks - 1;
    block x = all(0), y = all(0), begin_x = all(0), begin_y = all(0);

    // Q along the stretches, then what comes from the stretch beyond
    for (int b = last; b >= 0; b--) {
        const block zx = AT(m[0], b) * x + AT(m[1], b) * y;
        const block zy = AT(m[2], b) * x + AT(m[3], b) * y;
        AT(r->qx, b) = x = zx + AT(r->add_x, b);
        AT(r->qy, b) = y = zy + AT(r->add_y, b);
    }
    for (int j = SERIES_LANES - 2; j >= 0; j--) {
        const double bx = begin_x[j + 1], by = begin_y[j + 1];
        begin_x[j] = x[j + 1] + (in[0][j + 1] * bx + in[1][j + 1] * by);
        begin_y[j] = y[j + 1] + (in[2][j + 1] * bx + in[3][j + 1] * by);
    }

    // accelerations over a resting base, and what they add to the next base's
    block beyond_x = begin_x, beyond_y = begin_y;
    for (int b = last; b >= 0; b--) {
        const block vx = AT(r->vx, b), vy = AT(r->vy, b);
        const block turn = (AT(r->moment, b) - (vx * beyond_x + vy * beyond_y)) * AT(r->inv_d, b);
        AT(r->free, b) = turn;
        AT(r->add_x, b) = vx * turn + AT(r->length, b) * AT(r->rho_x, b);
        AT(r->add_y, b) = vy * turn + AT(r->length, b) * AT(r->rho_y, b);
        AT(r->qx, b) = beyond_x = AT(r->qx, b) + (AT(in[0], b) * begin_x + AT(in[1], b) * begin_y);
        AT(r->qy, b) = beyond_y = AT(r->qy, b) + (AT(in[2], b) * begin_x + AT(in[3], b) * begin_y);
    }

    // the bases' along the stretches, then what comes from the stretch before
    x = y = all(0);
    for (int b = 0; b <= last; b++) {
        AT(r->base_x, b) = x;
        AT(r->base_y, b) = y;
        const block zx = AT(m[0], b) * x + AT(m[2], b) * y;
        const block zy = AT(m[1], b) * x + AT(m[3], b) * y;
        x = zx + AT(r->add_x, b);
        y = zy + AT(r->add_y, b);
    }
    begin_x = begin_y = all(0);
    for (int j = 0; j + 1 < SERIES_LANES; j++) {
        const double bx = begin_x[j], by = begin_y[j];
        begin_x[j + 1] = x[j] + (r->whole[0][j] * bx + r->whole[1][j] * by);
        begin_y[j + 1] = y[j] + (r->whole[2][j] * bx + r->whole[3][j] * by);
    }
    for (int b = 0; b <= last; b++) {
        AT(r->base_x, b) += AT(out[0], b) * begin_x + AT(out[1], b) * begin_y;
        AT(r->base_y, b) += AT(out[2], b) * begin_x + AT(out[3], b) * begin_y;
    }
}

static void loop_finish(chain_rows *r, const chain_order *o)
{
    const int n = o->n;
    const block per_rate = all(1.0 / (n + 1)), per_angle = all(1.0 / (n + 2)), push = all(o->force);
    for (int b = 0; b < r->blocks; b++) {
        const block ax = AT(r->base_x, b), ay = AT(r->base_y, b);
        const block pull = (AT(r->ux, b) * ax + AT(r->uy, b) * ay) * AT(r->inv_d, b);
        const block acceleration = AT(r->free, b) - pull + push * AT(r->unit, b);
        const block rate = acceleration * per_rate;
        AT(r->acceleration, b) = acceleration;
        AT(r->qx, b) += AT(r->pxx, b) * ax + AT(r->pxy, b) * ay + push * AT(r->unit_fx, b);
        AT(r->qy, b) += AT(r->pxy, b) * ax + AT(r->pyy, b) * ay + push * AT(r->unit_fy, b);

        // the next coefficients
        TERM(r->rate, n + 1, b) = rate;
        TERM(r->angle, n + 2, b) = rate * per_angle;
        TERM(r->cosine, n + 2, b) = -(AT(r->known_s, b) + AT(r->start_s, b) * rate) * per_angle;
        TERM(r->sine, n + 2, b) = (AT(r->known_c, b) + AT(r->start_c, b) * rate) * per_angle;
    }
}

static void loop_hand(chain_rows *r, const chain_order *o)
{
    const int last = r->blocks - 1;
    for (int b = 0; b <= last; b++) {
        const block half = AT(r->half, b);
        const block x = b < last ? AT(r->qx, b + 1) : next_lane(&AT(r->qx, 0), o->tip_x);
        const block y = b < last ? AT(r->qy, b + 1) : next_lane(&AT(r->qy, 0), o->tip_y);
        TERM(r->gx, o->n, b) = half * (AT(r->qx, b) + x);
        TERM(r->gy, o->n, b) = half * (AT(r->qy, b) + y);
    }
}

const chain_loops GLUE(chain_loops_, WIDTH) = {loop_join,  loop_products, loop_bends, loop_prepare,
                                               loop_sweep, loop_finish,   loop_hand};
