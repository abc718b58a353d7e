// Predictors of the peak force, usable in free flight: "if it touched now, how hard would
// it hit?"
#pragma once

#include <math.h>

#include "src/tables/parameters.h"
#include "src/base/fault.h"

// The state a prediction starts from: three bodies for the thesis's predictors.
typedef struct three_body_state {
    double angle[3];    // hub, first link, second link [rad]
    double velocity[3]; // [rad/s]
} three_body_state;

typedef struct prediction {
    bool holds;         // false: the touch would not hold, contact is lost at once
    double force;       // peak of the first pulse [N]
    double delay;       // from contact to the peak [s]; NaN where the method gives none
    double impulse;     // of the impact [N s]; NaN where the method gives none
    double restitution; // e_eq of 4.1.1 [-]; NaN where the method gives none
    double inductance;  // what the motor's inductance changes of the peak [N], NaN where
                        // that is not asked or not known
    bool doubtful; // the pulse lasts longer than it can be followed: force and delay are
                   // NaN, and it does not hold
} prediction;

// An empty prediction: it does not hold, and every number is NaN.
static inline prediction prediction_none(void)
{
    const double none = (double)NAN;
    return (prediction){.force = none,
                        .delay = none,
                        .impulse = none,
                        .restitution = none,
                        .inductance = none};
}

// Commands of the motor after the touch, each in force from its time on: v(t) of the
// remark in 4.2.
typedef struct voltage_profile {
    int count;           // 0: the present command stays
    const double *times; // since the touch, rising [s]
    const double *volts; // [V]
    double current;      // at the touch, of a motor with inductance [A]
} voltage_profile;

// A touch holds if the contact point approaches (or rests) and force and delay come out
// positive; in the corrected forms also only if the wall's force just after the impact is
// not negative, and its restitution e does not throw the arm back: the impulse is then 1
// + e times the plastic one. Where the touch does not hold, `force` and `delay` may be
// NaN. All predictors fail with STATUS_NOT_FINITE on a state that is not finite and with
// STATUS_SINGULAR where the equations have no single solution; f then says which. They
// work on the two-link arm: with another number of links, on the two-link arm of the same
// length, mass and k2.
//
// The wall. The printed forms take the contact point (a, b) where it is. The corrected
// forms take it where the arm is, as if the wall stood there, so that they mean something
// far from it; at the wall itself the two agree.

// Energy quasi-principle (4.24): of the energy [J] that n springs in series hold at
// largest deformation, spring i holds the part (1/k_i) / sum_j (1/k_j). Writes the
// deflection of each spring, sqrt(2 PE_i / k_i) [rad], for stiffnesses k[n] [N m/rad].
void quasi_principle_deflections(int n, const double *k, double energy,
                                 double *deflection);

// Energy principle, (4.23)-(4.34), with the quasi-principle (4.24). p->arm.model chooses
// the printed form with the listing's habits, or the corrected one, which also takes off
// what structural damping (arm.damping_ratio) loses until the largest bend, as 4.3
// proposes. The method gives no delay and no impulse: both are NaN.
status predict_energy(const parameters *p, const three_body_state *s, prediction *out,
                      fault *f);

// Velocity increments of a plastic impact, (4.10)-(4.17): after[3] is the velocities just
// after [rad/s], *impulse that of the wall [N s] (negative if the contact point was
// moving away).
status predict_velocity_jump(const parameters *p, const three_body_state *s,
                             double after[3], double *impulse, fault *f);

// Impact dynamics, (4.20)-(4.22), solved by Newton's method for delay, peak force and the
// hub's velocity. Printed or corrected form by p->arm.model.
status predict_impact_dynamics(const parameters *p, const three_body_state *s,
                               prediction *out, fault *f);

// The quadratic closed form of the impact dynamics: hub and first link jump together.
status predict_impact_quadratic(const parameters *p, const three_body_state *s,
                                prediction *out, fault *f);
