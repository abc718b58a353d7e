// How far a number of links is from a beam: quantities of a scenario over arm.links,
// their limit by Richardson's extrapolation, and the Euler-Bernoulli beam where a closed
// form exists.
#pragma once

#include "src/run/run_result.h"
#include "src/scenario/scenario.h"

enum { LINKS_LENGTHS = 6, LINKS_QUANTITIES = 11 };
extern const int links_numbers[LINKS_LENGTHS]; // 2, 4, 8 ... 64

// of the beam's value, or the limit's, that a number of links may be off
#define LINKS_ENOUGH 0.05
#define LINKS_GROWS  1.5 // times with each doubling: a value that grows without a limit

// A quantity over the number of links. What is not there, or cannot be told, is NaN.
typedef struct links_row {
    const char *key;             // "momentum_2ms_Ns", in JSON
    const char *label, *unit;    // for people
    double value[LINKS_LENGTHS]; // with links_numbers[i] links [unit]
    double order;                // p observed, the error falling as N^-p
    double limit,
        error;   // Richardson's from the last three, and what it may be off [unit]
    double beam; // of the Euler-Bernoulli beam [unit]
    double aim;  // the beam's, else the limit, else that of the most links [unit]
    int enough;  // fewest links from which on all are within LINKS_ENOUGH of it;
                 // 0: none, or the last two alone of their own
    double off;  // what those differ from it at most, as a share
} links_row;

typedef struct links_study {
    int count; // numbers of links that were computed, the first ones
    links_row rows[LINKS_QUANTITIES];
    double links[LINKS_LENGTHS]; // as curves need them
} links_study;

// Fills in `aim`, `enough` and `off` from the rest.
void links_judge(links_row *row);

// The Euler-Bernoulli beam whose tip is stopped from the speed v [m/s] presses, as long
// as nothing has come back from its other end, without damping and on a rigid wall, with
// K / sqrt(t),
//
//     K = v (EI)^(1/4) (rho A)^(3/4) / sqrt(2 pi),     EI = k2 L / 2,  rho A = mass / L.
//
// Its momentum in t is 2 K sqrt(t) [N s]; a sensor, a first-order lag of the time
// constant tau, reads 2 K / sqrt(tau) D(sqrt(t / tau)) with Dawson's integral D, at most
// at t = 0.854 tau [N].
double links_beam_momentum(const parameters *p, double speed, double time);
double links_beam_sensed(const parameters *p, double speed, double time_constant);

// Runs the scenario with each number of links: impulse of the first impact, largest force
// (impulses excluded) of the first 20 ms, momentum of the first 2 ms, what sensors of
// 0.5, 1 and 2 ms read at most in 20 ms; contact time and steady force (of the run's
// summary), the first frequency with the tip free and pinned, hub held, and the tip's
// compliance. STATUS_BAD_SCENARIO for the printed model or if there is no contact; else
// fails as the run does. *study then has the numbers of links before. STATUS_STOPPED if
// `monitor` (NULL: nobody looks on) asked for it.
//
// The beam besides: (beta L)^2 sqrt(EI / (m L^3)) with beta L = 1.8751 and 3.9266; L^3 /
// (3 EI). It has no closed form with a mass at the tip or uneven links.
status links_study_compute(const scenario *s, run_monitor *monitor, links_study *study,
                           fault *f);
