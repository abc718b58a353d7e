// The arm near rest as a linear system, alone, sampled, and in the loop of a control law.
//
//     x' = A x + B u,    y = C x + D u       u: the command [V]
//
// about the arm at rest: free, pressing on the wall, or pressing with the hub held by
// friction. Coulomb friction itself has no linear part. Back EMF, viscous friction,
// damping, the wall's law and the bend under the force are in A. LAPACK is loaded by the
// first call that needs it.
#pragma once

#include <complex.h>
#include <math.h>

#include "src/run/run_result.h"
#include "src/study/sweep.h"

// C11's CMPLX, which not every compiler's library has.
static inline double complex complex_of(double real, double imaginary)
{
    return real + imaginary * (double complex)I;
}

typedef enum linear_place { LINEAR_FREE, LINEAR_CONTACT, LINEAR_STUCK } linear_place;

// A system of one input, matrices row by row.
typedef struct linear_system {
    int states, outputs;
    double *a, *b, *c, *d; // [states * states], [states], [outputs * states], [outputs]
} linear_system;

// Makes room for a system of zeros, to be freed with linear_system_finish.
// STATUS_NO_MEMORY.
status linear_system_init(linear_system *s, int states, int outputs, fault *f);
void linear_system_finish(linear_system *s); // one of zeros is accepted

// Outputs of the arm, in this order.
enum {
    LINEAR_HUB_ANGLE,
    LINEAR_HUB_VELOCITY,
    LINEAR_HUB_ACCELERATION,
    LINEAR_BENDING, // last link's angle minus the first's
    LINEAR_TIP,     // its displacement across the line from the hub
    LINEAR_FORCE,
    LINEAR_OUTPUTS
};
extern const char *const linear_output_names[LINEAR_OUTPUTS];

enum { LINEAR_MOST_LINKS = 64 };

// The arm about its place of rest. States: angles that the wall and a held hub leave, in
// the order of the bodies from the hub outwards, their rates, and the current of a motor
// with inductance.
typedef struct linear_arm {
    linear_system system;
    double voltage;   // command that holds the arm there, friction aside [V]
    double force;     // with which it presses [N]
    double hub_angle; // [rad]
    double bending;   // [rad]
} linear_arm;

// Linearises the corrected arm of a scenario. It presses with control.force where a law
// is to hold it, else under motor.voltage. STATUS_BAD_ARGUMENT, with a sentence in f, for
// an arm that has no such place of rest.
status linear_arm_init(linear_arm *arm, const parameters *p, linear_place place,
                       fault *f);
static inline void linear_arm_finish(linear_arm *a)
{
    linear_system_finish(&a->system);
}

// --- poles, zeros, answers -------------------------------------------------------------

// Poles of a system, values[states], in rising order of their size; of a pair the upper
// one comes first. STATUS_SINGULAR, with a sentence in f, without LAPACK or where its
// iteration does not end.
status linear_poles(const linear_system *s, double complex *values, fault *f);

// Zeros from the input to an output, likewise; there are *count, at most states. A system
// whose output does not see the input has none.
status linear_zeros(const linear_system *s, int output, int *count,
                    double complex *values, fault *f);

// Damping ratio of a pole or zero; 1 of a decaying real one, NaN at the origin.
double linear_damping(double complex s);

// C (point - A)^-1 B + D of an output; NaN at a pole and without LAPACK.
double complex linear_answer(const linear_system *s, int output, double complex point,
                             double complex *scratch); // [states * (states + 2) + 1]

// Answers over rising frequencies w [rad/s]; of a loop its gain L with negative feedback.
typedef struct linear_response {
    int count;
    double *frequency;    // one block with gain, to be freed
    double complex *gain; // NaN: not known
} linear_response;

// The loop gain -y/u of a loop that is sampled with a period [s], up to half its rate;
// with period 0 the answer y/u of an arm, from a hundredth of its slowest part to ten
// times its fastest.
status linear_respond(const linear_system *s, int output, double period,
                      linear_response *r, fault *f);

// Distances of a stable loop from instability, over all crossings; infinite where nothing
// crosses, or no gain below a million times (120 dB) does it. The delay takes answers to
// be smooth between samples: linear_delay_margin does without.
typedef struct linear_margins {
    double gain_db,
        gain_down_db; // the gain may grow by the one and fall by the other [dB]
    double phase_deg; // either way [degrees]
    double delay_s;   // further delay that it takes [s]
    double disk;      // 2 min |1 + L|/|1 - L|: gain and phase together
    // where L crosses the negative real axis at gain_db, and |L| = 1 at phase_deg
    double gain_at, phase_at; // [rad/s]
} linear_margins;
linear_margins linear_margins_of(const linear_response *r);

// --- loops -----------------------------------------------------------------------------

// What a law reads, in this order. READ_FORCE: of the sensor that sensor.force names.
enum {
    READ_ENCODER,
    READ_TACHOMETER,
    READ_FORCE,
    READ_VOLTAGE, // command in effect
    READ_PIEZO,
    READ_FILM,
    READ_ACCELEROMETER,
    LINEAR_READINGS
};

// The arm with its sensors' lags from sample to sample, x_k+1 = A x_k + B u_k, y_k = C
// x_k, with the delay of commands, whole periods and what is left, in it: exact for a
// command that is held. A sensor that is not fitted reads nothing. To be freed with
// linear_system_finish.
status linear_sample(linear_system *sampled, const linear_arm *arm, const parameters *p,
                     fault *f);

// The loop cut at the command: from the command u_k to what the law answers to the
// readings that follow from it. The law's answers to a pulse in each reading at the place
// of rest are its linear form if they scale and obey one recurrence, else STATUS_UNSTABLE
// with a sentence in f: the loop of such a law is measured (linear_inject). The closed
// loop is that with u_k = y_k.
status linear_loop(linear_system *loop, const linear_arm *arm, const parameters *p,
                   fault *f);
void linear_close(linear_system *loop);

// The least further delay [s] with which a pole of the closed loop reaches the unit
// circle, the law being told nothing of it; part of a period is exact. *delay holds that
// of linear_margins_of, which is right at whole periods, and stays as it is beyond 32
// periods or where no delay does it.
status linear_delay_margin(const linear_arm *arm, const parameters *p, double *delay,
                           fault *f);

// The loop gain of any law in a run of its scenario: once the run has come to its end the
// arm is left as it is, a small sine is added to the command, and
//
//     L = -(law's part)/(whole command)
//
// at that frequency, at frequencies that are dense where |L| or its phase cross what
// margins ask for. Friction, noise and counts have their part in it. STATUS_UNSTABLE,
// with a sentence in f, if the arm does not press or loses the wall on the way.
status linear_inject(const scenario *s, linear_response *r, fault *f);

// The least impulse at the tip [N s], across the last link and against the wall or away
// from it, after which the arm of the scenario's run, pressing at its end, loses contact
// (a gap above 1 um) within half a second; NaN if none of up to 10 N s does, the arm does
// not press, or its controller is a process, which cannot be taken back to before a push.
status linear_contact_margin(const scenario *s, double *impulse, fault *f);

// Whether a loop is stable. With by_runs it is if a run of the scenario, with friction
// and all else, settles: *number is its settling time [s], or NaN. Else it is if its
// linear form decays: *number is how fast the slowest part grows [1/s], below zero of a
// stable loop.
status linear_stability(const scenario *s, linear_place place, bool by_runs,
                        double *number, fault *f);
static inline bool linear_is_stable(bool by_runs, double number)
{
    return by_runs ? isfinite(number) : number < 0;
}

// How fast the slowest part of the linear form grows in contact [1/s]; NaN on failure.
status linear_growth(const scenario *s, double *growth, fault *f);

// The same over all combinations of varied values.
enum { LINEAR_MOST_LIMITS = 32 };
typedef struct linear_survey {
    sweep sweep;
    double *numbers[2]; // of each combination: growth [1/s], and by runs the settling
                        // time [s]; NaN of one that is not done
    size_t done;        // combinations
    struct {
        double value; // of the axis
        bool by_runs;
    } limits[LINEAR_MOST_LIMITS]; // of a single axis, where stability changes
    int limit_count;
} linear_survey;
status linear_survey_begin(linear_survey *y, const scenario *s,
                           const sweep_request *request, fault *f);
// Once it has begun, to be finished in any case. STATUS_STOPPED if `monitor` (NULL:
// nobody looks on), which counts combinations, or `stop_everything` asked for it.
status linear_survey_make(linear_survey *y, linear_place place, run_monitor *monitor,
                          fault *f);
void linear_survey_finish(linear_survey *y);
