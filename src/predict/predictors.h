// All predictors in one table, and one question to all of them: if the arm touched the
// wall in this state, what would the first pulse be?
#pragma once

#include "src/base/fault.h"
#include "src/predict/predict.h"

// Every predictor with the key under which results name it, a label, a label for narrow
// places, and what it is.
#define PREDICTOR_LIST(X)                                                                \
    X(PREDICTOR_ENERGY, "energy", "energy principle", "energy",                          \
      "all energy before the contact becomes strain; without the impact's loss, so too " \
      "high for "                                                                        \
      "stiff beams")                                                                     \
    X(PREDICTOR_IMPACT_DYNAMICS, "impact_dynamics", "impact dynamics",                   \
      "impact dynamics",                                                                 \
      "after the impact every velocity falls linearly to zero while the force rises "    \
      "linearly")                                                                        \
    X(PREDICTOR_IMPACT_QUADRATIC, "impact_quadratic", "impact dynamics, closed form",    \
      "closed form", "the same by a quadratic equation")                                 \
    X(PREDICTOR_LINEARISED, "linearised", "linearised constrained arm", "linearised",    \
      "this arm, with its motor, held to the wall: two links in closed form, others "    \
      "followed")

typedef enum predictor {
#define PREDICTOR_ENUM(id, name, label, short_label, about) id,
    PREDICTOR_LIST(PREDICTOR_ENUM)
#undef PREDICTOR_ENUM
        PREDICTOR_COUNT
} predictor;

// The outcome of asking a predictor about a state, and which of its features are then not
// taken.
#define PREDICTION_OUTCOME_LIST(X)                                                       \
    X(PREDICTION_HOLDS, 0, "the touch would hold")                                       \
    X(PREDICTION_LOST, 0, "the touch would not hold")                                    \
    X(PREDICTION_DOUBTFUL, 0, "the pulse lasts longer than it can be followed")          \
    X(PREDICTION_CORRECTED_ONLY, HAS(PRINTED), "for the corrected model only")           \
    X(PREDICTION_UNLIMITED_ONLY, HAS(LIMITED),                                           \
      "for a motor whose current has no limit only")                                     \
    X(PREDICTION_RIGID_WALL_ONLY, HAS(GIVES), "for a rigid wall only")                   \
    X(PREDICTION_STILL_WALL_ONLY, HAS(MOVES), "for a wall at rest only")                 \
    X(PREDICTION_LEVEL_ONLY, HAS(TILTED), "for an arm in a level plane only")            \
    X(PREDICTION_BARE_TIP_ONLY, HAS(TIP_MASS), "for a tip that carries nothing only")    \
    X(PREDICTION_EQUAL_LINKS_ONLY, HAS(UNLIKE) | HAS(STIFFENS) | HAS(AIR) | HAS(MODAL),  \
      "for equal links with equal linear joints only")                                   \
    X(PREDICTION_KNOWN_FORCES_ONLY, LISTED_FORCES, "for the forces that it knows only")  \
    X(PREDICTION_KNOWS_NO_TIME, 0, "knows no time over which a voltage could act")       \
    X(PREDICTION_LINKS_UNKNOWN, 0, "the state of all links is not known")                \
    X(PREDICTION_FAILED, 0, "there is no prediction")

typedef enum prediction_outcome {
#define PREDICTION_OUTCOME_ENUM(id, features, text) id,
    PREDICTION_OUTCOME_LIST(PREDICTION_OUTCOME_ENUM)
#undef PREDICTION_OUTCOME_ENUM
} prediction_outcome;

// The state that is asked about.
typedef struct prediction_question {
    const parameters *parameters; // resolved, as they are at that instant; motor.voltage
                                  // is the command in force, under a law that of the law
    three_body_state bodies;      // hub, first and last link
    const double
        *angles; // of all degrees of freedom [rad], as the corrected model counts
    const double *velocities; // them [rad/s]; NULL where they are not known
    voltage_profile
        command;      // what the motor is to be given from the touch on; count 0: as is
    bool whole_pulse; // also e_eq, at the cost of following the pulse to its end
    double current;   // of a motor with inductance, at that instant [A]
} prediction_question;

typedef struct prediction_answer {
    const char *name;        // key in results
    const char *label;       // for people
    const char *short_label; // the same in 16 columns
    prediction_outcome
        outcome;           // PREDICTION_HOLDS, PREDICTION_LOST: `prediction` is filled in
    prediction prediction; // else NaN, and not held
    fault fault;           // why there is none after PREDICTION_FAILED; else STATUS_OK
    char note[96];         // what a known answer leaves out, else ""
} prediction_answer;

// Whether the predictor has an answer: a touch that holds or one that does not.
bool prediction_known(const prediction_answer *answer);

// Why there is no pulse to speak of, or what is left out of one: for people; "" if
// nothing is.
const char *prediction_reason(const prediction_answer *answer);

// Asks one predictor. Of a motor with inductance the linearised arm follows the current,
// and the thesis's predictors take it as following at once. The linearised arm of many
// links takes milliseconds and allocates, the others microseconds.
prediction_answer predict_with(predictor which, const prediction_question *question);

// Asks all of them, in the order of the list, and how much an inductance changes the
// peak: what the linearised arm says with it less what it says without.
void predict_all(const prediction_question *question,
                 prediction_answer answers[PREDICTOR_COUNT]);
