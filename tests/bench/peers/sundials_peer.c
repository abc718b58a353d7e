// SUNDIALS: the two-link arm as a system of ordinary differential equations for each combination of
// contact and hub friction; events by root finding, then jump, change of the equations and a new
// start of the integrator. CVODE (Adams, BDF) and ARKODE's explicit Runge-Kutta methods.
//
// The equations are the textbook's for two uniform rods at absolute angles q1, q2,
//
//     M11 a1 + M12 a2 - B s w2^2 = T - c w1 - T_f + k d - J1 f,     M12 = B cos d, B = m l^2/2,
//     M12 a1 + M22 a2 + B s w1^2 = -k d - J2 f,                     d = q2 - q1, s = sin d,
//
// and in contact J a + dJ/dt w = 0 with J = l (cos(q1 - wall), cos(q2 - wall)).
#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <sundials/sundials_config.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "tests/bench/peers/peer.h"

typedef enum sundials_variant { CVODE_ADAMS, CVODE_BDF, ARKODE_EIGHTH } sundials_variant;

enum { ANGLE_1, ANGLE_2, SPEED_1, SPEED_2, STATES };
enum { STUCK = 0, FORWARD = 1, BACKWARD = -1 };
enum { WALL_ROOT, HUB_ROOT, ROOTS };

// What holds: the wall touched or not, the hub stuck or sliding which way.
typedef struct contact_mode {
    bool contact;
    int friction;
} contact_mode;

typedef struct reactions {
    double force;   // of the wall [N]
    double holding; // torque of the hub's friction [N m]
} reactions;

// The force at an end of a step.
typedef struct force_end {
    double time, force, rate; // [s], [N], [N/s]
} force_end;

typedef struct simulation {
    sundials_variant variant;
    SUNContext context;
    N_Vector state, between; // STATES numbers each
    SUNMatrix matrix;
    SUNLinearSolver linear;
    SUNNonlinearSolver nonlinear;
    void *memory; // of CVODE or ARKODE
    contact_mode mode;
} simulation;

static const double link_length = EXPERIMENT_BEAM_LENGTH / 2, link_mass = EXPERIMENT_BEAM_MASS / 2;

// Matrix, force-free right-hand side and the wall's direction at a state.
typedef struct balance {
    double m11, m12, m22, r1, r2;
    double j1, j2, j_rate; // J and (dJ/dt) w
} balance;

static balance balance_at(const double *y)
{
    const double l = link_length, m = link_mass, inertia = m * l * l / 12;
    double d = y[ANGLE_2] - y[ANGLE_1], b = m * l * l / 2 * sin(d);
    double w1 = y[SPEED_1], w2 = y[SPEED_2];
    double to_wall_1 = y[ANGLE_1] - EXPERIMENT_WALL, to_wall_2 = y[ANGLE_2] - EXPERIMENT_WALL;
    double drive = EXPERIMENT_TORQUE * EXPERIMENT_VOLTAGE - EXPERIMENT_HUB_DAMPING * w1;
    return (balance){
        .m11 = EXPERIMENT_HUB_INERTIA + inertia + 1.25 * m * l * l,
        .m12 = m * l * l / 2 * cos(d),
        .m22 = inertia + 0.25 * m * l * l,
        .r1 = drive + EXPERIMENT_SPRING * d + b * w2 * w2,
        .r2 = -EXPERIMENT_SPRING * d - b * w1 * w1,
        .j1 = l * cos(to_wall_1),
        .j2 = l * cos(to_wall_2),
        .j_rate = -l * (sin(to_wall_1) * w1 * w1 + sin(to_wall_2) * w2 * w2),
    };
}

static reactions accelerate(const double *y, contact_mode mode, double *a)
{
    balance b = balance_at(y);
    reactions out = {0, mode.friction * EXPERIMENT_STICTION};
    if (mode.friction == STUCK) {
        a[0] = 0;
        a[1] = mode.contact ? -b.j_rate / b.j2 : b.r2 / b.m22;
        out.force = mode.contact ? (b.r2 - b.m22 * a[1]) / b.j2 : 0;
        out.holding = b.r1 - b.m12 * a[1] - b.j1 * out.force;
        return out;
    }
    double inverse = 1 / (b.m11 * b.m22 - b.m12 * b.m12), r1 = b.r1 - out.holding;
    a[0] = (b.m22 * r1 - b.m12 * b.r2) * inverse;
    a[1] = (b.m11 * b.r2 - b.m12 * r1) * inverse;
    if (mode.contact) {
        double x1 = (b.m22 * b.j1 - b.m12 * b.j2) * inverse;
        double x2 = (b.m11 * b.j2 - b.m12 * b.j1) * inverse;
        out.force = (b.j1 * a[0] + b.j2 * a[1] + b.j_rate) / (b.j1 * x1 + b.j2 * x2);
        a[0] -= out.force * x1;
        a[1] -= out.force * x2;
    }
    return out;
}

static int rates(double t, N_Vector state, N_Vector rate, void *user)
{
    (void)t;
    const double *y = N_VGetArrayPointer(state);
    double *dy = N_VGetArrayPointer(rate);
    dy[ANGLE_1] = y[SPEED_1];
    dy[ANGLE_2] = y[SPEED_2];
    accelerate(y, ((simulation *)user)->mode, dy + SPEED_1);
    return 0;
}

// All roots are left downwards: gap or force, and the hub's speed or what friction has in reserve.
static int roots(double t, N_Vector state, double *root, void *user)
{
    (void)t;
    const simulation *s = user;
    const double *y = N_VGetArrayPointer(state);
    double a[2];
    reactions r = {0, 0};
    if (s->mode.contact || s->mode.friction == STUCK) {
        r = accelerate(y, s->mode, a);
    }
    double gap =
        -link_length * (sin(y[ANGLE_1] - EXPERIMENT_WALL) + sin(y[ANGLE_2] - EXPERIMENT_WALL));
    root[WALL_ROOT] = s->mode.contact ? r.force : gap;
    root[HUB_ROOT] = s->mode.friction == STUCK ? EXPERIMENT_STICTION - fabs(r.holding)
                                               : s->mode.friction * y[SPEED_1];
    return 0;
}

// Plastic impact: M dw = -J' p with J (w + dw) = 0; friction is no match for an impulse.
static double impact(double *y)
{
    balance b = balance_at(y);
    double inverse = 1 / (b.m11 * b.m22 - b.m12 * b.m12);
    double x1 = (b.m22 * b.j1 - b.m12 * b.j2) * inverse;
    double x2 = (b.m11 * b.j2 - b.m12 * b.j1) * inverse;
    double impulse = (b.j1 * y[SPEED_1] + b.j2 * y[SPEED_2]) / (b.j1 * x1 + b.j2 * x2);
    y[SPEED_1] -= impulse * x1;
    y[SPEED_2] -= impulse * x2;
    return impulse;
}

// The friction that goes with the hub's speed, and whether a touched wall pushes at all.
static void settle_mode(simulation *s, const double *y)
{
    double a[2];
    s->mode.friction = y[SPEED_1] > 0 ? FORWARD : y[SPEED_1] < 0 ? BACKWARD : STUCK;
    reactions r = accelerate(y, s->mode, a);
    if (s->mode.friction == STUCK && fabs(r.holding) > EXPERIMENT_STICTION) {
        s->mode.friction = r.holding > 0 ? FORWARD : BACKWARD;
        r = accelerate(y, s->mode, a);
    }
    s->mode.contact = s->mode.contact && r.force > 0;
}

// --- the two integrators under one name -----------------------------------------------------

static bool prepare_integrator(simulation *s, double tolerance)
{
    static int down[ROOTS] = {-1, -1};
    s->state = N_VNew_Serial(STATES, s->context);
    s->between = N_VNew_Serial(STATES, s->context);
    if (s->state == NULL || s->between == NULL) {
        return false;
    }
    N_VConst(0, s->state);
    if (s->variant == ARKODE_EIGHTH) {
        s->memory = ERKStepCreate(rates, 0, s->state, s->context);
        return s->memory != NULL && ERKStepSetUserData(s->memory, s) == 0 &&
               ERKStepSetTableNum(s->memory, ARKODE_FEHLBERG_13_7_8) == 0 &&
               ERKStepSStolerances(s->memory, tolerance, tolerance) == 0 &&
               ERKStepRootInit(s->memory, ROOTS, roots) == 0 &&
               ERKStepSetNoInactiveRootWarn(s->memory) == 0 &&
               ERKStepSetRootDirection(s->memory, down) == 0;
    }
    s->memory = CVodeCreate(s->variant == CVODE_BDF ? CV_BDF : CV_ADAMS, s->context);
    if (s->memory == NULL || CVodeInit(s->memory, rates, 0, s->state) != 0 ||
        CVodeSetUserData(s->memory, s) != 0 ||
        CVodeSStolerances(s->memory, tolerance, tolerance) != 0 ||
        CVodeRootInit(s->memory, ROOTS, roots) != 0 || CVodeSetNoInactiveRootWarn(s->memory) != 0 ||
        CVodeSetRootDirection(s->memory, down) != 0) {
        return false;
    }
    if (s->variant == CVODE_ADAMS) {
        s->nonlinear = SUNNonlinSol_FixedPoint(s->state, 0, s->context);
        return s->nonlinear != NULL && CVodeSetNonlinearSolver(s->memory, s->nonlinear) == 0;
    }
    s->matrix = SUNDenseMatrix(STATES, STATES, s->context);
    s->linear = s->matrix != NULL ? SUNLinSol_Dense(s->state, s->matrix, s->context) : NULL;
    return s->linear != NULL && CVodeSetLinearSolver(s->memory, s->linear, s->matrix) == 0;
}

static bool restart(simulation *s, double t)
{
    return s->variant == ARKODE_EIGHTH ? ERKStepReInit(s->memory, rates, t, s->state) == 0 &&
                                             ERKStepSetStopTime(s->memory, EXPERIMENT_DURATION) == 0
                                       : CVodeReInit(s->memory, t, s->state) == 0 &&
                                             CVodeSetStopTime(s->memory, EXPERIMENT_DURATION) == 0;
}

// One step of its own, cut short at a root or the end. Negative on failure.
static int step_once(simulation *s, double *t)
{
    return s->variant == ARKODE_EIGHTH
               ? ERKStepEvolve(s->memory, EXPERIMENT_DURATION, s->state, t, ARK_ONE_STEP)
               : CVode(s->memory, EXPERIMENT_DURATION, s->state, t, CV_ONE_STEP);
}

static void found_roots(simulation *s, int *found)
{
    s->variant == ARKODE_EIGHTH ? ERKStepGetRootInfo(s->memory, found)
                                : CVodeGetRootInfo(s->memory, found);
}

static long steps_taken(simulation *s)
{
    long steps = 0;
    s->variant == ARKODE_EIGHTH ? ERKStepGetNumSteps(s->memory, &steps)
                                : CVodeGetNumSteps(s->memory, &steps);
    return steps;
}

// The force within the step just made, from the integrator's own interpolation.
static double force_between(simulation *s, double t)
{
    double a[2];
    s->variant == ARKODE_EIGHTH ? ERKStepGetDky(s->memory, t, 0, s->between)
                                : CVodeGetDky(s->memory, t, 0, s->between);
    return accelerate(N_VGetArrayPointer(s->between), s->mode, a).force;
}

// --- a run ----------------------------------------------------------------------------------

// Rate of the force along the motion, from a difference.
static double force_rate(const simulation *s, const double *y, double force)
{
    const double little = 1e-6; // [s]
    double a[2], ahead[STATES];
    accelerate(y, s->mode, a);
    ahead[ANGLE_1] = y[ANGLE_1] + little * y[SPEED_1];
    ahead[ANGLE_2] = y[ANGLE_2] + little * y[SPEED_2];
    ahead[SPEED_1] = y[SPEED_1] + little * a[0];
    ahead[SPEED_2] = y[SPEED_2] + little * a[1];
    return (accelerate(ahead, s->mode, a).force - force) / little;
}

// Keeps the largest force of the first pulse; a maximum inside the step is searched for.
static void watch_peak(simulation *s, force_end *last, double t, peer_answer *answer)
{
    const double golden = 0.6180339887498949;
    double a[2];
    const double *y = N_VGetArrayPointer(s->state);
    double force = accelerate(y, s->mode, a).force;
    force_end now = {t, force, force_rate(s, y, force)};
    peer_note_peak(t, force, answer);
    if (last->rate > 0 && now.rate < 0 && t > last->time) {
        double low = last->time, high = t;
        while (high - low > 1e-8) {
            double left = high - golden * (high - low), right = low + golden * (high - low);
            if (force_between(s, left) > force_between(s, right)) {
                high = right;
            } else {
                low = left;
            }
        }
        peer_note_peak((low + high) / 2, force_between(s, (low + high) / 2), answer);
    }
    *last = now;
}

static void pass_event(simulation *s, double t, peer_answer *answer)
{
    int found[ROOTS] = {0, 0};
    double *y = N_VGetArrayPointer(s->state);
    found_roots(s, found);
    if (found[HUB_ROOT] && s->mode.friction != STUCK) {
        y[SPEED_1] = 0;
    }
    if (found[WALL_ROOT] && !s->mode.contact) {
        double impulse = impact(y);
        s->mode.contact = true;
        peer_note_contact(t, impulse, answer);
    } else if (found[WALL_ROOT]) {
        s->mode.contact = false;
    }
    if (s->mode.contact && y[SPEED_1] == 0) {
        y[SPEED_2] = 0; // the wall and a resting hub hold the second link
    }
    settle_mode(s, y);
    if (!s->mode.contact && !isnan(answer->first_contact) && isnan(answer->release)) {
        answer->release = t;
    }
}

static bool run(void *instance, peer_answer *answer)
{
    simulation *s = instance;
    double *y = N_VGetArrayPointer(s->state), t = 0, a[2];
    long steps = 0;
    N_VConst(0, s->state);
    s->mode = (contact_mode){false, STUCK};
    settle_mode(s, y);
    force_end last = {0, 0, 0};
    bool good = restart(s, 0), at_rest = false;
    while (good && !at_rest && t < EXPERIMENT_DURATION) {
        int code = step_once(s, &t);
        good = code >= 0;
        if (good && s->mode.contact && isnan(answer->release)) {
            watch_peak(s, &last, t, answer);
        }
        if (good && code == CV_ROOT_RETURN) {
            steps += steps_taken(s);
            pass_event(s, t, answer);
            last = (force_end){t, 0, 0};
            if (s->mode.contact && isnan(answer->release)) {
                watch_peak(s, &last, t, answer);
            }
            // held by wall and friction, nothing moves any more
            at_rest = s->mode.contact && s->mode.friction == STUCK;
            good = at_rest || restart(s, t);
        }
    }
    answer->steps = (double)(at_rest ? steps : steps + steps_taken(s));
    answer->final_force = accelerate(y, s->mode, a).force;
    answer->hub_angle = y[ANGLE_1];
    return good;
}

static void destroy(void *instance)
{
    simulation *s = instance;
    if (s->variant == ARKODE_EIGHTH) {
        ERKStepFree(&s->memory);
    } else {
        CVodeFree(&s->memory);
    }
    if (s->nonlinear != NULL) {
        SUNNonlinSolFree(s->nonlinear);
    }
    if (s->linear != NULL) {
        SUNLinSolFree(s->linear);
    }
    if (s->matrix != NULL) {
        SUNMatDestroy(s->matrix);
    }
    if (s->state != NULL) {
        N_VDestroy(s->state);
    }
    if (s->between != NULL) {
        N_VDestroy(s->between);
    }
    SUNContext_Free(&s->context);
    free(s);
}

static void *create(const peer *self)
{
    // chosen so that the second contact is good to about 1e-8 s, see README.md
    static const double tolerances[] = {1e-9, 1e-10, 1e-9};
    simulation *s = calloc(1, sizeof *s);
    if (s == NULL) {
        return NULL;
    }
    s->variant = (sundials_variant)self->variant;
    if (SUNContext_Create(NULL, &s->context) != 0) {
        free(s);
        return NULL;
    }
    if (!prepare_integrator(s, tolerances[s->variant])) {
        fprintf(stderr, "peers: SUNDIALS: the integrator could not be prepared\n");
        destroy(s);
        return NULL;
    }
    return s;
}

#define SUNDIALS(text, variant)                                                                    \
    {                                                                                              \
        "SUNDIALS", SUNDIALS_VERSION, text, 2, variant, create, destroy, run, peer_own_steps,      \
            peer_duration                                                                          \
    }

static const peer list_of_peers[] = {
    SUNDIALS("CVODE, Adams", CVODE_ADAMS),
    SUNDIALS("CVODE, BDF", CVODE_BDF),
    SUNDIALS("ARKODE, Fehlberg 7(8)", ARKODE_EIGHTH),
};

int peers_sundials(const peer **list)
{
    *list = list_of_peers;
    return (int)(sizeof list_of_peers / sizeof list_of_peers[0]);
}
