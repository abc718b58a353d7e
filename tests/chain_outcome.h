// Contact quantities of an arm that are compared between engines, step lengths and the
// independent simulation.
#pragma once

#include "src/base/fault.h"
#include "src/tables/parameters.h"
#include "src/contact/engine.h"
#include "tests/reference/reference_arm.h"

#define OUTCOME_FIRST_MS 10 // the sample 1 ms after first contact
#define OUTCOME_CONTACTS 10 // whose instants are kept

typedef struct chain_outcome {
    status status;           // of the last step; else as far as it came
    double first_contact;    // [s], NaN without one
    double first_impulse;    // [N s]
    double impulses;         // of all impacts [N s]
    double motor_work;       // [J]
    double residual, put_in; // the ledger's largest; energy and work that went in [J]
    double peak, peak_time;  // of the force in contact; when, of an arm that it does not
                             // hold still [N], [s]
    double lost[6]; // to friction, impacts, viscous friction, structural damping, the
                    // wall, and what a wall that moves took [J]
    int impacts, samples;                    // samples: of momentum
    int contacts;                            // that began in flight (chain_outcome_note)
    double contact_times[OUTCOME_CONTACTS];  // [s]
    double contact_speeds[OUTCOME_CONTACTS]; // of approach [m/s]
    double ended;                            // [s]
    // that the wall took until instants REFERENCE_INTERVAL apart, from first contact on
    // [N s]
    double momentum[REFERENCE_SAMPLES];
} chain_outcome;

// An arm in front of its wall.
typedef struct chain_start {
    const parameters *parameters;
    double angle, velocity; // of all links [rad], [rad/s]
    double duration;        // [s]
    double after_contact;   // behind first contact it ends, if that is earlier [s]
    const engine *by;       // that moves it; NULL: the one of its own method
    int most_contacts;      // after which it ends, 0: whatever there are
} chain_start;

// Notes a contact that begins at `time` [s], met at `speed` [m/s] after a flight since
// `parted` [s]. A flight lower than 1e-11 m is rounding and counts as none: so an arm
// that starts on its wall and goes into it has its first contact at the start.
void chain_outcome_note(chain_outcome *o, double time, double speed, double parted);

// To be called where it leaves its wall, which has taken a momentum [N s]: an arm that
// started on it and never pressed on it has not touched it.
void chain_outcome_forget(chain_outcome *o, double momentum);

// Moves it with the time step of its parameters. A step that fails, or events without
// end, end it with that status.
chain_outcome chain_outcome_of(const chain_start *start);

// Root mean square of the difference of what two sensors with a lag of 1 ms read, as a
// share of the first one's; NaN where that reads nothing.
double chain_outcome_sensor_difference(const chain_outcome *a, const chain_outcome *b);
