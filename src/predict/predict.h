// Predictors of the peak force, usable in free flight: "if it touched now, how hard would it hit?"
#pragma once

#include "src/parameters.h"
#include "src/status.h"

// The state a prediction starts from: three bodies for the thesis's predictors.
typedef struct three_body_state {
    double angle[3];    // hub, first link, second link [rad]
    double velocity[3]; // [rad/s]
} three_body_state;

typedef struct prediction {
    bool holds;      // false: the touch would not hold, contact is lost at once
    double force;    // peak of the first pulse [N]
    double delay;    // from contact to the peak [s]; NaN where the method gives none
    double impulse;  // of the impact [N s]; NaN where the method gives none
} prediction;

// Energy principle, (4.23)-(4.34), with the quasi-principle (4.24). p->arm.model chooses the
// printed form with the listing's habits, or the corrected one.
status predict_energy(const parameters *p, const three_body_state *s, prediction *out, fault *f);

// Impact dynamics, (4.20)-(4.22), solved by Newton's method for delay, peak force and the hub's
// velocity. Printed or corrected form by p->arm.model.
status predict_impact_dynamics(const parameters *p, const three_body_state *s, prediction *out,
                               fault *f);

// The quadratic closed form of the impact dynamics: hub and first link jump together.
status predict_impact_quadratic(const parameters *p, const three_body_state *s, prediction *out,
                                fault *f);
