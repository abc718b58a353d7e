// The loops over all links that the series of a chain (chain_series.h) are made with, in the widest
// vectors of the processor; the same bits in all of them.
//
// A chain is cut into SERIES_LANES stretches of as many links, which are taken side by side: link k
// stands in lane k / blocks of block k % blocks, so that the link beyond stands in the same lane of
// the next block. Recurrences from link to link run along all stretches at once as if each started
// from zero; the effect of the true starting values is added afterwards, by the products of the
// matrices along the stretch. The chain is padded behind the last link with links of no length,
// mass or motion.
#pragma once

#include <stddef.h>

enum {
    SERIES_LANES = 8,
    SERIES_MOST = 32,               // highest order of the velocities' series
    SERIES_TERMS = SERIES_MOST + 2, // terms of a polynomial
    SERIES_TOGETHER = 4             // orders whose products are summed together
};

// Arrays by link: [chain_place], and by coefficient and link: [chain_term].
typedef struct chain_rows {
    int blocks;
    double *angle, *rate;       // [rad], [rad]; coefficients to order + 1 and order
    double *cosine, *sine;      // of the angle; to order + 1
    double *gx, *gy;            // G, to order - 1 [kg m2]
    double *bend_rate;          // of the joint beyond each link [rad]; to order - 1
    double *bend, *bend_square; // of that joint, where joints stiffen; to order - 1
    double *air_x, *air_y;      // velocity of the link's middle, where air drags [m]; to order - 1
    double *start_c, *start_s;  // c and s at the start
    double *length, *half;      // of the link, and half of it [m]
    double *stiffness;          // of the joint beyond it, times L^2; none beyond the last [kg m2]
    double *damping;            // of that joint, times L [kg m2]
    double *torque;             // of that joint, times L^2
    double *air, *air_turning;  // drag per velocity, times L, and per rate [kg], [kg m2]

    // the stride's matrices
    double *ux, *uy, *inv_d;          // of chain.h
    double *vx, *vy;                  // l t [m]
    double *pxx, *pxy, *pyy;          // P at the link's base [kg]
    double *back_x, *back_y;          // what rho costs the moment
    double *rho_xx, *rho_xy, *rho_yy; // what rho adds to Q
    double *matrix[4];   // xx, xy, yx, yy: Q_k = A Q_(k+1) + ..., A_(k+1) = A' A_k + ...
    double *inwards[4];  // products of them from the stretch's outer end to here
    double *outwards[4]; // of the transposed from its inner end to the link before
    double *whole[4];    // along a whole stretch, [lane]
    double *unit, *unit_fx, *unit_fy; // acceleration and F of a unit contact force; 0 without

    // of the order in hand, and of the next ones as far as they are known
    double *known_c, *known_s, *moment, *rho_x, *rho_y, *add_x, *add_y;
    double *next_c[SERIES_TOGETHER - 1], *next_s[SERIES_TOGETHER - 1];
    double *next_moment[SERIES_TOGETHER - 1];
    double *free, *acceleration, *qx, *qy, *base_x, *base_y;
} chain_rows;

// Places of link k, and of its coefficient n.
static inline size_t chain_place(const chain_rows *r, int k)
{
    return (size_t)(k % r->blocks) * SERIES_LANES + (size_t)(k / r->blocks);
}
static inline size_t chain_term(int n, size_t place)
{
    return (place / SERIES_LANES * SERIES_TERMS + (size_t)n) * SERIES_LANES + place % SERIES_LANES;
}

// What an order's loops are given.
typedef struct chain_order {
    int n;
    double root;         // torque of the hub on the first link, times L^2
    double force;        // contact force, times L^2
    double tip_x, tip_y; // F at the tip of the last link
} chain_order;

typedef struct chain_loops {
    void (*join)(chain_rows *r); // products of the matrices along the stretches

    // order by order: sums over i = 1..n+1 of s_i w_(n+1-i) and c_i w_(n+1-i) into known_s and
    // known_c, over i = 1..n of c_i Gy_(n-i) - s_i Gx_(n-i) into moment
    void (*products)(chain_rows *r, const chain_order *o);
    void (*bends)(chain_rows *r, const chain_order *o); // rates of joints and their torques
    // rho; moment: torques of joints and hub less those sums and what rho costs; what goes into Q
    void (*prepare)(chain_rows *r, const chain_order *o);
    // Q of all links, accelerations of links whose base rests, those of the bases
    void (*sweep)(chain_rows *r);
    // accelerations, forces at the bases in place of Q, and the next coefficients
    void (*finish)(chain_rows *r, const chain_order *o);
    void (*hand)(chain_rows *r, const chain_order *o); // G, from the forces at the bases
} chain_loops;

// Those built for each width (by_width.h).
extern const chain_loops chain_loops_1, chain_loops_2, chain_loops_4, chain_loops_8;
