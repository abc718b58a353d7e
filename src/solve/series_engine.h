// A chain of links by power series (chain_series.h): a dense engine, exact to rounding. The
// two-link arm has its own (taylor_kernel.h), which is the same mathematics written out.
#pragma once

#include "src/solve/chain_series.h"
#include "src/solve/motion.h"

// A function over a stride as a polynomial in x = t/L, the share of the stride's length.
typedef struct series_function {
    double term[SERIES_TERMS];
    int count;
    bool divided; // by a power of x
} series_function;

// The series' last terms where nothing but rounding is to be left.
#define SERIES_EXACT 1e-13

typedef struct series_stride {
    series_function watched[WATCHES]; // those of the contact state; stiction, current: nearer limit
    series_function far_limit, far_current; // the other ones
    series_function force;                  // never divided
    bool force_apart;                       // what is watched of the force is not the force itself
    double force_most, force_until; // the force's bound, for times up to the second [N], [s]
    chain_series *series;
} series_stride;

// Bytes needed by a stride, its parts behind it included; places the parts there.
size_t series_stride_size(const arm *a);
void series_stride_place(series_stride *s, const arm *a);

// The functions of engine.h for the stride in s; last_terms as in chain_series.h.
double series_stride_begin(series_stride *s, const arm *a, motion *m, double remaining,
                           double last_terms);
status series_stride_state(const series_stride *s, const arm *a, motion *m, double h);
glance series_stride_look(const series_stride *s, watch w, double h);
double series_stride_bend(const series_stride *s, watch w, double to);
bool series_stride_clear(series_stride *s, watch w, double h);
bool series_stride_bounded(const series_stride *s, double h, double most);
glance series_stride_force(const series_stride *s, double h);
