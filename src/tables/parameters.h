// Every parameter of a run, and the one table that describes them: parameter_list.h.
//
// The table feeds scenario files, --set, sweeps, `show`, validation messages, the
// terminal's sliders and the manual.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "src/base/fault.h"
#include "src/tables/control_laws.h"

typedef enum arm_model_kind { ARM_CORRECTED, ARM_PRINTED } arm_model_kind;
typedef enum hub_joint_kind { HUB_RIGID, HUB_SPRING, HUB_BEAM } hub_joint_kind;
typedef enum wall_kind { WALL_POINT, WALL_PLANE, WALL_NONE } wall_kind;
typedef enum wall_law { WALL_RIGID, WALL_KELVIN_VOIGT, WALL_HUNT_CROSSLEY } wall_law;
typedef enum wall_motion_kind {
    MOTION_NONE,
    MOTION_SINE,
    MOTION_STEP,
    MOTION_FILE
} wall_motion_kind;
typedef enum motor_drive { DRIVE_VOLTAGE, DRIVE_CURRENT } motor_drive;
typedef enum method_kind {
    METHOD_EVENT,
    METHOD_NEWMARK,
    METHOD_GENERALIZED_ALPHA
} method_kind;
typedef enum engine_kind { ENGINE_AUTO, ENGINE_PAIR, ENGINE_STIFF } engine_kind;
typedef enum printed_program { PROGRAM_EQUATIONS, PROGRAM_LISTING } printed_program;
typedef enum listing_reevaluation {
    REEVALUATE_RHS,
    REEVALUATE_LISTING,
    REEVALUATE_NONE
} listing_reevaluation;

enum {
    PARAMETER_TEXT_SIZE = 128,   // room for a parameter that is a text, its end included
    PARAMETER_VALUE_SIZE = 1024, // the same for a list, and for any value as a text
    PARAMETER_LINKS_MOST = 1024, // largest arm.links
    PARAMETER_LIST_MOST = 128,   // numbers of a parameter that is a list
    PARAMETER_MODES_MOST = 16,   // of arm.modal_ratios
    PARAMETER_MODAL_LINKS = 32   // largest arm.links with them
};

typedef enum playback_hold { PLAYBACK_HOLD, PLAYBACK_LINEAR } playback_hold;

// In the order of the choices of control.impact_angle.
typedef enum impact_angle_source {
    IMPACT_ANGLE_TOLD,
    IMPACT_ANGLE_BY_FILM,
    IMPACT_ANGLE_BY_ACCELEROMETER
} impact_angle_source;

// In the order of the choices of sensor.force.
typedef enum force_sensor { FORCE_BY_FSR, FORCE_BY_PIEZO } force_sensor;

enum { CONTROL_MOST_DELAY = 5 }; // from a sample to its command [periods]

// arm_parameters, motor_parameters and so on: a field for each row of the list. A choice
// is an index of its words, a list a text of numbers. belief.*, the nominal model that a
// controller is told of the arm on the rig, has factors of the truth and differences from
// it.
#define GROUP(name)                typedef struct name {
#define REAL(group, field, ...)    double field;
#define INTEGER(group, field, ...) int field;
#define CHOICE(group, field, ...)  int field;
#define BOOLEAN(group, field, ...) bool field;
#define TEXT(group, field, ...)    char field[PARAMETER_TEXT_SIZE];
#define LIST(group, field, ...)    char field[PARAMETER_VALUE_SIZE];
#define END_GROUP(name)                                                                  \
    }                                                                                    \
    name;
#include "src/tables/parameter_list.h"
#undef GROUP
#undef REAL
#undef INTEGER
#undef CHOICE
#undef BOOLEAN
#undef TEXT
#undef LIST
#undef END_GROUP

typedef struct parameters {
    arm_parameters arm;
    motor_parameters motor;
    wall_parameters wall;
    method_parameters method;
    printed_parameters printed;
    initial_parameters initial;
    run_parameters run;
    control_parameters control;
    nominal_model_parameters belief;
    sensor_parameters sensor;
    bool code_allowed;      // the user allows the scenario to start a program or load a
                            // plug-in; no file can allow it
    unsigned char set[192]; // set[i] is 1 if parameter i was given, 0 if it is a default
} parameters;

typedef enum parameter_type {
    PARAMETER_REAL,
    PARAMETER_INTEGER,
    PARAMETER_BOOLEAN,
    PARAMETER_CHOICE,
    PARAMETER_TEXT, // of at most PARAMETER_TEXT_SIZE - 1 bytes; has no number, no range
    PARAMETER_LIST // of numbers, kept as such a text "10, 12, 9"; unit and range are each
                   // number's
} parameter_type;

typedef struct parameter_info {
    const char *path; // "arm.k2"
    size_t offset;    // in struct parameters
    parameter_type type;
    const char *unit; // "N m/rad", "" for a pure number
    double default_corrected;
    double default_printed;
    double minimum, maximum; // both included
    const char *choices; // "rigid|spring" in the order of the enumeration; of a text what
                         // it is where nothing gives it; else NULL
    bool timed;          // may be changed during a run
    const char *symbol;  // "k_2", its index behind the low line; NULL: none
    const char *description; // one sentence without a full stop
} parameter_info;

// The table and its length.
extern const parameter_info parameter_table[];
extern const int parameter_count;

// Whether its value is kept as a text and has no number.
static inline bool parameter_is_text(const parameter_info *info)
{
    return info->type == PARAMETER_TEXT || info->type == PARAMETER_LIST;
}

// The numbers of a list as it is kept; returns how many there are, 0 for the empty list,
// which is the default. The same of parameter `index`.
int parameter_list_numbers(const char *list, double numbers[PARAMETER_LIST_MOST]);
int parameter_get_list(const parameters *p, int index,
                       double numbers[PARAMETER_LIST_MOST]);

// Length of each link [m], lengths[links], of resolved parameters.
void parameters_link_lengths(const arm_parameters *a, double *lengths);

// Stiffness of the joint before each link [N m/rad], stiffness[links], of resolved
// parameters: that of the hub's spring or the beam's root (0 with a rigid hub), then of
// the inner joints.
void parameters_joint_stiffness(const arm_parameters *a, double *stiffness);

// The same of each link's mass [kg] and moment of inertia about its centre [kg m2], and
// of the damping in the joint before it as arm.joint_damping has it [N m s/rad], else 0.
void parameters_link_masses(const arm_parameters *a, double *masses);
void parameters_link_inertias(const arm_parameters *a, double *inertias);
void parameters_joint_damping(const arm_parameters *a, double *damping);

// Whether all links have one length, mass and inertia, the latter of uniform rods if
// there are not two, and all joints the stiffness of one beam and one damping, as they do
// without lists; a hub spring of its own and the damping at the hub do not count.
bool parameters_even_links(const arm_parameters *a);

// How far behind the wall an arm may start, by rounding, as a share of its length.
#define START_ROUNDING 1e-15

// The range in which a value of a parameter is usually tried [its unit], that of a
// slider: all that it may be, or where that is much wider than its default what lies
// about the default and the value; logarithmic where it spans decades. False if the
// parameter is not a number.
bool parameter_usual_range(int parameter, double value, double *low, double *high,
                           bool *logarithmic);

// Index of a path in the table, or -1.
int parameter_find(const char *path);

// Index of the parameter of a field, PARAMETER_INDEX(arm.k2); a misspelt one does not
// compile.
#define PARAMETER_INDEX(field) parameter_at(offsetof(parameters, field))

// Index of the parameter that starts at an offset of struct parameters.
int parameter_at(size_t offset);

// Index of a path that the program itself names: an unknown one fails an assertion.
int parameter_index(const char *path);

// Index of a path as people write it; -1, with a sentence in f that names the nearest, if
// there is no such parameter.
int parameter_look_up(const char *path, fault *f);

// The path of that name in another group, or the nearest to a misspelt one (for "did you
// mean"); NULL if there is none.
const char *parameter_suggest(const char *path);

// All defaults of the given model (arm_model_kind), nothing marked as set.
void parameters_defaults(parameters *p, arm_model_kind model);

// Gives all parameters that are not marked as set, except arm.model itself, their
// defaults for p->arm.model.
void parameters_restore_defaults(parameters *p);

// Parses text as a value of parameter `index` and stores it, marked as set. A trailing
// unit equal to the parameter's own is accepted ("0.1 rad"); the numbers of a list stand
// between commas, in brackets or not ("[10, 12 N m/rad]"). ".NAME=VALUE" gives one number
// of control.settings a value (src/tables/settings.h). On a wrong type, a value that is
// not finite or one out of range nothing is stored and f says what was wrong and what was
// expected.
status parameter_set_text(parameters *p, int index, const char *text, fault *f);

// Stores a number (an enumeration's index for a choice, 0 or 1 for a boolean), checked as
// above. A text takes no number.
status parameter_set_number(parameters *p, int index, double value, fault *f);

// Stores the numbers of a list, each checked as above.
status parameter_set_list(parameters *p, int index, const double *numbers, int count,
                          fault *f);

// Whether a number may be the value of a parameter, or one of its list's.
status parameter_check_number(int index, double value, fault *f);

// The value as a number; NaN where an optional parameter has none, 0 for a text.
double parameter_get(const parameters *p, int index);

// The value as text, as a scenario file would give it, without its unit.
void parameter_format(const parameters *p, int index, char *text, size_t size);

// Fills what depends on other parameters: defaults that follow arm.model for everything
// not set, arm.link_inertia of a uniform link, arm.EI or arm.k2 from the one that was
// given, and arm.k1 of a beam's root. Checks combinations (arm.link_inertia with N != 2,
// arm.EI beside arm.k2, the printed model with N != 2 ...). Call after the last parameter
// was set.
status parameters_resolve(parameters *p, fault *f);

// Whether the controller's clock can be kept: CONTROL_MOST_DELAY commands under way at
// most, and samples in order. A sentence in f if not; parameters_resolve asks it, too.
status parameters_check_timing(const parameters *p, fault *f);

// Whether a parameter of resolved parameters may be given another value. False, with the
// reason in f, for one that follows from others there: arm.k1 of a beam's root, arm.k2
// and arm.EI beside arm.joint_stiffness.
status parameter_may_change(const parameters *p, int index, fault *f);

// Lets what depends on parameter `index` follow it in resolved parameters, as a change
// during a run asks for it: arm.k2, arm.EI and the root of a beam.
void parameters_follow(parameters *p, int index);
