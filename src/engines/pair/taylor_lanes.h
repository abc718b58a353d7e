// Steps of several two-link arms side by side (SIMD): the series and the states at the
// ends of steps, which are most of a run's work, are computed for as many arms at once as
// the processor's vectors hold. Every arm gets the same bits as when it is computed
// alone.
//
//     taylor_prepare each motion
//     taylor_compute those of one form
//     motion_examine_step each motion        (contact_machine.h)
//     taylor_finish them, each to where its step ends
//     motion_step each
#pragma once

#include "src/contact/motion.h"
#include "src/engines/pair/taylor_series.h"

// Series of several arms, and what they come to at the ends of their steps.
typedef struct taylor_group {
    _Alignas(64) double block[TAYLOR_PLACES * TAYLOR_WIDEST];
    taylor_instants ends;
    taylor_pieces pieces; // of those in contact, to each's count
    taylor_form form;
    int width;
} taylor_group;

// A motion's part in it: its step. Good until the group computes other series.
typedef struct taylor_lane {
    taylor_form form;
    const taylor_group *group; // NULL: the series are its own, in `block`
    int number;                // of its lane in the group
    double end;                // where its step ends, once that is evaluated; else -1 [s]
    int pieces;                // so many pieces of the step have their force in the group
    unsigned fetched;          // which arrays are in `block`, too
    double block[TAYLOR_PLACES];
} taylor_lane;

// Prepares the step that motion_step(a, m, until, ...) is going to begin, with
// `remaining` to go [s]. NULL if that step asks for no series: another engine, or an arm
// that is held still.
taylor_lane *taylor_prepare(const arm *a, motion *m, double remaining);

// The kind of a step, a number below TAYLOR_KINDS: steps can be computed side by side if
// and only if their kinds are equal.
enum { TAYLOR_KINDS = 16 };
static inline int taylor_kind(taylor_form form)
{
    return form.contact | form.point << 1 | form.hub_spring << 2 | form.damped << 3;
}

// Computes up to taylor_width() prepared steps of one form; the motions take the series
// from there.
void taylor_compute(taylor_group *group, taylor_lane *const *lanes, int count);

// Where a step ends, since its start [s], and in how many pieces its force will be asked
// for.
typedef struct taylor_end {
    double time;
    int pieces;
} taylor_end;

// Evaluates these steps at their ends.
void taylor_finish(taylor_group *group, taylor_lane *const *lanes, const taylor_end *ends,
                   int count);

// Computes the series of one arm in the widest vectors that help it; the same bits in all
// of them.
void taylor_compute_one(taylor_lane *lane);

// Where the number of a place of the lane's series stands; those of the places behind it
// follow taylor_spacing() further each.
static inline const double *taylor_term(const taylor_lane *lane, int place)
{
    const taylor_group *group = lane->group;
    return group != NULL ? group->block + place * group->width + lane->number
                         : lane->block + place;
}
static inline int taylor_spacing(const taylor_lane *lane)
{
    return lane->group != NULL ? lane->group->width : 1;
}

// The first `count` terms of the array of the lane's series that begins at a place.
const double *taylor_terms(taylor_lane *lane, int place, int count);

// Copies all that a step may ask of the lane's series into its own block: they then
// outlive the group's.
void taylor_fetch(taylor_lane *lane);

// Evaluates the series of one arm at `count` instants of the step, up to taylor_width().
void taylor_evaluate(taylor_lane *lane, int count, taylor_instants *at);

// Values and slopes of a series of one arm, of `count` terms, at taylor_width() times.
void taylor_values(const double *terms, int count, const double *times, double *values,
                   double *slopes);

// engine.retorque of the series' engine.
void taylor_retorque(const arm *a, motion *m, double change);

// How many arms the widest vectors of this processor hold, 1 to TAYLOR_WIDEST.
int taylor_width(void);

// Takes narrower vectors than the processor has, for tests and measurements: 1, 2, 4 or
// 8; 0 takes the widest again. Returns what is taken.
int taylor_limit_width(int width);
