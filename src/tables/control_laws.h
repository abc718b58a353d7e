// The built-in control laws, in one list: a law is added here and as a file in
// src/rig/laws, and nowhere else. It makes the choices of control.law, the declarations
// of src/rig/laws/laws.h, the rig's table of controllers and the manual.
#pragma once

#include "src/tables/feature_bits.h"

// Each law: name in the enumeration below, prefix of the controller (hybrid: hybrid_law),
// word in scenarios; what it reads of belief.* (src/tables/feature_bits.h), and what
// besides where the wanted force moves; which of its parameters it ignores, with blanks
// around them; and for people, without a full stop, one line that says what it does, what
// it has to know, the sensors that it reads and how it fails.
#define CONTROL_LAWS(LAW)                                                                \
    LAW(OPEN_LOOP, open_loop, "open-loop", 0, 0,                                         \
        " force kv contact_threshold force_gain integral_gain ",                         \
        "the constant command of the approach, nothing else", "nothing", "none",         \
        "no control")                                                                    \
    LAW(HYBRID, hybrid, "hybrid", TOLD_PATH, 0, "",                                      \
        "approach, impact and force mode of the thesis, 5.2 to 5.4",                     \
        "$k_2$, wall's angle", "hub, force", "wrong beliefs: 174 % over")                \
    LAW(FORCE_PD, force_pd, "force-pd", HAS(TOLD_TORQUE), TOLD_ARM, " integral_gain ",   \
        "static torque 2 f l, force error and damping by the tachometer",                \
        "torque constant", "tachometer, force", "friction: 14 % error")                  \
    LAW(FORCE_INTEGRAL, force_integral, "force-integral", 0, 0, " kv force_gain ",       \
        "from contact on the integral of the force error", "nothing", "force",           \
        "slow, loses contact")                                                           \
    LAW(REVERSE_TORQUE, reverse_torque, "reverse-torque", TOLD_PATH, 0, "",              \
        "full command backwards for a while after contact, then the force mode of "      \
        "hybrid",                                                                        \
        "$k_2$, wall's angle", "hub, force", "loses contact")                            \
    LAW(SPEED_LIMIT, speed_limit, "speed-limit", TOLD_PATH, 0, "",                       \
        "hybrid with the hub's speed limited on the way", "$k_2$, wall's angle",         \
        "hub, force", "slow")                                                            \
    LAW(BANG_BANG, bang_bang, "bang-bang", TOLD_PATH, 0, "",                             \
        "full command forwards and back on the way, then hybrid", "$k_2$, wall's angle", \
        "hub, force", "large impacts")                                                   \
    LAW(DISCONTINUOUS, discontinuous, "discontinuous", HAS(TOLD_TORQUE), TOLD_ARM,       \
        " integral_gain ",                                                               \
        "force-pd while the sensor feels the wall, the approach while it does not",      \
        "torque constant", "tachometer, force", "friction: 14 % error")                  \
    LAW(RECOVERING, recovering, "recovering", TOLD_PATH, 0, "",                          \
        "hybrid that goes back to position control where contact is lost",               \
        "$k_2$, wall's angle", "hub, force", "settles in 83 % of wrong beliefs")         \
    LAW(INVERSE_DYNAMICS, inverse_dynamics, "inverse-dynamics",                          \
        TOLD_PATH | HAS(TOLD_DELAY), 0, "",                                              \
        "computed torque through the inverse of the flexible arm, played back "          \
        "open-loop",                                                                     \
        "whole model, wall", "hub, force", "any error: nothing is fed back")             \
    LAW(OBSERVER, observer, "observer", TOLD_MODEL, 0, "",                               \
        "observer of arm, wall and unknown torque, feedback by synthesis, contact "      \
        "found again",                                                                   \
        "model, rough", "hub, force", "bounces on stiff walls that lose nothing")        \
    LAW(IMPEDANCE, impedance, "impedance", TOLD_PATH, 0, "",                             \
        "a spring and a damper tie the hub to a point that moves into the wall",         \
        "$k_2$, wall's angle", "hub", "wrong wall: wrong force")                         \
    LAW(ADMITTANCE, admittance, "admittance", TOLD_HUB, TOLD_ARM | HAS(TOLD_DELAY), "",  \
        "the force's error moves a mass that the hub follows under position control",    \
        "damping", "hub, force", "slow")                                                 \
    LAW(TOUCH, touch, "touch", TOLD_PATH | HAS(TOLD_DELAY) | HAS(TOLD_LINKS), 0, "",     \
        "no faster to the wall than the force allows, then a passive hub whose rest "    \
        "moves: for a small board",                                                      \
        "model, rough", "hub, force", "heavy tips that walls throw back")

// Values of control.law.
typedef enum control_law {
    LAW_NONE, // no rig: the bare arm under motor.voltage
#define LAW(name, ...) LAW_##name,
    CONTROL_LAWS(LAW)
#undef LAW
        LAW_PLUGIN, // a controller of one's own, from control.plugin
    LAW_PROCESS,    // a program of one's own, control.command
    LAW_PLAYBACK,   // a recorded command, from control.playback_file
    LAW_COUNT
} control_law;

// The choices of control.law in the order of the enumeration,
// "none|open-loop|...|playback".
#define CONTROL_LAW_WORD(name, prefix, word, ...) "|" word
#define CONTROL_LAW_CHOICES                                                              \
    "none" CONTROL_LAWS(CONTROL_LAW_WORD) "|plugin|process|playback"

typedef struct control_law_info {
    const char *word;                         // in scenarios
    const char *description;                  // one line without a full stop
    const char *needs, *sensors, *fails;      // of a built-in law, likewise
    feature_set told, told_where_force_moves; // features of belief.* that it reads
    const char *ignored; // of its parameters, " NAME NAME "; "": none
} control_law_info;

// Indexed by control_law.
extern const control_law_info control_law_table[LAW_COUNT];
