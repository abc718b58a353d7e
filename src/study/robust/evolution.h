// A search for the least of a function of many numbers that is noisy and has no
// derivative: the evolution strategy with covariance matrix adaptation (Hansen, The CMA
// Evolution Strategy: A Tutorial, arXiv 1604.00772, 2016; its constants are used as
// printed there).
//
// Points are drawn from a normal distribution; the better half of them moves its mean,
// widens it along the ways that led there, and shrinks it where steps cancel out. Numbers
// are shares of a range, 0 to 1: a point outside is drawn back to the border.
#pragma once

#include <stdbool.h>

#include "src/base/fault.h"
#include "src/base/random.h"

enum { EVOLUTION_MOST = 64 }; // numbers, and points of a generation

typedef struct evolution {
    int n;                          // numbers
    int points, parents;            // of a generation, and those that move the mean
    double weights[EVOLUTION_MOST]; // of the parents, the best first, their sum 1
    double mass;                    // mu_eff = 1/sum of weights^2
    double mean[EVOLUTION_MOST];
    double step;                      // sigma
    double step_path[EVOLUTION_MOST]; // p_sigma
    double path[EVOLUTION_MOST];      // p_c
    double *covariance;               // C, owned, [n][n]
    double *axes;                     // unit eigenvectors of C, a row each, owned
    double lengths[EVOLUTION_MOST];   // square roots of its eigenvalues
    long generation;
    random_generator random;
} evolution;

// Begins at a point with a standard deviation `step` in every direction.
// STATUS_NO_MEMORY; evolution_finish in any case.
status evolution_init(evolution *e, int n, const double *start, double step,
                      uint64_t seed, fault *f);
void evolution_finish(evolution *e);

// Draws a generation, drawn[points][n], within 0 to 1.
void evolution_draw(evolution *e, double *drawn);

// Takes what the points came to; the least is the best, all finite. False where C cannot
// be decomposed, which ends the search.
bool evolution_take(evolution *e, const double *drawn, const double *losses);
