// What a set of parameters asks for, as bits; features.h says what follows from them.
#pragma once

#include <stdbool.h>

#include "src/tables/force_list.h"

enum {
#define FORCE_FEATURE(feature, ...) FEATURE_##feature,
    FORCE_LIST(FORCE_FEATURE)
#undef FORCE_FEATURE

        FEATURE_CORRECTED, // arm.model
    FEATURE_PRINTED,
    FEATURE_TWO_LINKS,
    FEATURE_JOINT, // some joint of the beam bends
    FEATURE_BENDS, // that, or the hub's spring
    FEATURE_HUB_SPRING,
    FEATURE_TIP_MASS,
    FEATURE_UNLIKE,  // links or joints differ
    FEATURE_WALL,    // there is one, and then: it is
    FEATURE_STRUCK,  // met as a rigid body: it does not give, or has a face with a mass
    FEATURE_BOUNCES, // some impact is not plastic
    FEATURE_KELVIN_VOIGT,
    FEATURE_HUNT_CROSSLEY,
    FEATURE_MOVES, // the wall, in any way; by a formula; by a file
    FEATURE_MOVES_BY_FORMULA,
    FEATURE_MOVES_BY_FILE,
    FEATURE_VOLTAGE_DRIVE,
    FEATURE_CURRENT_DRIVE,
    FEATURE_AMPLIFIED, // motor.amplifier_gain says what a command gives
    FEATURE_DRIVEN,    // commands other than 0 V are possible
    FEATURE_BRAKED,    // by back EMF
    FEATURE_LIMITED,   // the motor's current has a limit
    FEATURE_EVENT,     // method.name
    FEATURE_NEWMARK,
    FEATURE_ALPHA,
    FEATURE_PAIR,        // the engine `pair` can take the arm
    FEATURE_STIFF,       // the engine `stiff` takes it
    FEATURE_REEVALUATED, // printed.reevaluation
    FEATURE_NO_LAW,      // control.law
    FEATURE_LAW,
    FEATURE_PLUGIN,
    FEATURE_PROCESS,
    FEATURE_PLAYBACK,
    FEATURE_LOCKABLE, // the law can be held in a mode
    FEATURE_READ,     // it reads this very parameter, to which control.settings gives no
                      // other value
    FEATURE_ALONE,
    FEATURE_FORCE_READ,  // the law reads the commanded force
    FEATURE_FORCE_STEPS, // the script changes it
    FEATURE_FORCE_WAVES, // control.force_amplitude
    FEATURE_FORCE_LIMIT, // control.force_limit
    FEATURE_PIEZO,       // sensors that need not be there
    FEATURE_FILM,
    FEATURE_ACCELEROMETER,
    FEATURE_TIP_DEFLECTION,
    FEATURE_ROOT_STRAIN,
    FEATURE_IMPERFECT, // sensor.ideal = false
    FEATURE_RIPPLE,
    FEATURE_CHANCE,    // noise or jitter
    FEATURE_TOLD_MASS, // what the law, or a prediction on its behalf, reads of belief.*
    FEATURE_TOLD_INERTIA,
    FEATURE_TOLD_FRICTION,
    FEATURE_TOLD_TORQUE,
    FEATURE_TOLD_K2,
    FEATURE_TOLD_HUB_SPRING,
    FEATURE_TOLD_DAMPING,
    FEATURE_TOLD_WALL,
    FEATURE_TOLD_DELAY,
    FEATURE_TOLD_LINKS,
    FEATURE_COUNT
};

// Two words of bits, which gcc and clang have as one number.
__extension__ typedef unsigned __int128 feature_set;
#define HAS(name) ((feature_set)1 << FEATURE_##name)
_Static_assert(FEATURE_COUNT <= 128, "a feature has a bit of a feature_set");

// The forces of force_list.h.
#define FORCE_BIT(feature, ...) | HAS(feature)
#define LISTED_FORCES           (0 FORCE_LIST(FORCE_BIT))

// What the engine `pair` does not take of two links, and what the thesis's predictors do
// not, to which a current follows at once.
#define NOT_OF_PAIR                                                                      \
    (LISTED_FORCES | HAS(LIMITED) | HAS(MOVES) | HAS(TIP_MASS) | HAS(UNLIKE))
#define NOT_OF_THESIS (NOT_OF_PAIR & ~HAS(ELECTRIC))

// Whether it takes an arm.
static inline bool features_suit_pair(feature_set features)
{
    return (features & HAS(TWO_LINKS)) != 0 && (features & NOT_OF_PAIR) == 0;
}

// What a law may read of the nominal model: friction and torque; with the arm's masses
// and k2; with the wall; with all that an estimate follows.
#define TOLD_HUB  (HAS(TOLD_FRICTION) | HAS(TOLD_TORQUE))
#define TOLD_ARM  (TOLD_HUB | HAS(TOLD_MASS) | HAS(TOLD_INERTIA) | HAS(TOLD_K2))
#define TOLD_PATH (TOLD_ARM | HAS(TOLD_WALL))
#define TOLD_MODEL                                                                       \
    (TOLD_PATH | HAS(TOLD_HUB_SPRING) | HAS(TOLD_DAMPING) | HAS(TOLD_DELAY) |            \
     HAS(TOLD_LINKS))
