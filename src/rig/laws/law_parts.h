// What control laws share: the setup that they keep, friction, a set-point that moves,
// and the arm in contact. A law includes nothing else of the rig, and nothing of the lab:
// no file, no allocation, no table of parameters; what a sample computes with stands in
// its memory and in the values of its setup. So it runs on a board as it stands here
// (src/exchange/law_export.h).
#pragma once

#include <math.h>
#include <stddef.h>

#include "src/base/plain_math.h"
#include "src/rig/controller.h"

// A controller: its word, names of modes, table of parameters, type of memory, and its
// functions and whatever else it has as .start = ..., .sample = ....
#define CONTROLLER_LAW(law, names, table, memory, ...)                                   \
    {                                                                                    \
        .interface = CONTROLLER_INTERFACE, .name = law, .modes = names,                  \
        .parameters = table, .parameter_count = (int)(sizeof table / sizeof table[0]),   \
        .memory_size = sizeof(memory), __VA_ARGS__                                       \
    }

// What a law keeps of its setup: all but where the rig's values lie, because its memory
// may be put into another loop's.
static inline controller_setup setup_kept(const controller_setup *setup)
{
    controller_setup kept = *setup;
    kept.parameters = NULL;
    return kept;
}

// Coulomb friction of a hub that moves at a rate [rad/s] [N m].
static inline double coulomb_friction(const controller_setup *setup, double rate)
{
    if (rate > 0) {
        return setup->stiction;
    }
    if (rate < 0) {
        return -setup->stiction;
    }
    return 0;
}

// A wanted force that changes during the run (the aim), and a smooth force that follows
// it: a step without overshoot, and a ramp without a lag once its rate is known. Because
// of the tip's inertia the contact force answers to the hub's angle with 1 - (p/s)^2, s
// of the arm; so the response of the smooth force has to fall off as p^-2, or fast waves
// of the aim would grow.
typedef struct set_point {
    double aim;                       // [N]
    double rise;                      // of the aim since the sample before [N]
    double seen_rate;                 // of the aim by two samples, 0 for a step [N/s]
    double aim_rate;                  // the same smoothed [N/s]
    bool changed;                     // the aim has changed since the last sample
    double pace, decay;               // w of following [1/s], e^(-w T) of the period T
    double force, rate, acceleration; // the smooth force [N], [N/s], [N/s2]
} set_point;

#define SET_POINT_PACE 40.0 // of most laws, w [1/s]

// Gives the set-point a wanted force [N], at the start or later, and the pace w [1/s]
// with which the smooth force follows.
static inline void set_point_tell(set_point *s, double pace, double force, double period,
                                  bool at_start)
{
    s->pace = pace;
    s->decay = plain_exp(-pace * period);
    if (at_start) {
        s->aim = s->force = force;
        s->rise = s->seen_rate = 0;
        s->changed = false;
        return;
    }
    const double rise_before = s->rise;
    s->rise = force - s->aim;
    s->aim = force;
    s->changed = true;

    // two changes in a row of one sign are a ramp, whose rate the smaller of them gives;
    // a single change is a step
    s->seen_rate = 0;
    if (rise_before * s->rise > 0) {
        const double change = fmin(fabs(rise_before), fabs(s->rise));
        s->seen_rate = copysign(change, s->rise) / period;
    }
}

// Moves the smooth force on by a period, in which its error e = force - aim decays as
//
//     e'' + 2 w e' + w^2 e = 0,    e(t) = (e0 + (e0' + w e0) t) exp(-w t)
static inline void set_point_follow(set_point *s, double period)
{
    const double w = s->pace, decay = s->decay;

    // the rate of the aim, smoothed; an aim that has not changed has the rate 0
    if (!s->changed) {
        s->rise = s->seen_rate = 0;
    }
    s->changed = false;
    s->aim_rate = s->seen_rate + decay * (s->aim_rate - s->seen_rate);

    // the error and its rate a period ago
    const double error_before = s->force - (s->aim - s->aim_rate * period);
    const double rate_before = s->rate - s->aim_rate;
    if (error_before == 0 && rate_before == 0) {
        return;
    }

    // the error and its rate now, and the force that follows from them
    const double slope = rate_before + w * error_before;
    const double error = (error_before + slope * period) * decay;
    const double rate = (rate_before - w * slope * period) * decay;
    s->force = s->aim + error;
    s->rate = s->aim_rate + rate;
    s->acceleration = -w * (2 * rate + w * error);
}

// Inertia of the arm in contact, M = I1 + 2 I + m l^2/2 [kg m2].
static inline double pressed_inertia(const controller_setup *r)
{
    return r->hub_inertia + 2 * r->link_inertia +
           r->link_mass * r->link_length * r->link_length / 2;
}

// Rate of the hub for a set-point that moves [rad/s], and the torque that this takes [N
// m]: damping, friction, which goes over to 0 where the hub almost rests, and inertia.
static inline double set_point_turn(const set_point *s, const controller_setup *r)
{
    return r->link_length / (2 * r->k2) * s->rate;
}
static inline double set_point_torque(const set_point *s, const controller_setup *r)
{
    const double rest = 0.005, turn = set_point_turn(s, r); // [rad/s]
    return r->hub_damping * turn + r->stiction * fmax(-1, fmin(turn / rest, 1)) +
           pressed_inertia(r) * r->link_length / (2 * r->k2) * s->acceleration;
}
