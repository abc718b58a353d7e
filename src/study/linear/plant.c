// The arm at rest, and its equations of motion linearised there.
//
// Rates are the derivatives of chain_accelerations by differences of sixth order, which are good to
// some 1e-12 of a row. A rigid wall leaves angles with J q = 0: the last link's follows from the
// others.
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/arm/chain.h"
#include "src/base/dense.h"
#include "src/study/linear/linear.h"

const linear_output_info linear_output_table[LINEAR_OUTPUTS] = {
    [LINEAR_HUB_ANGLE] = {"hub_angle", "rad"},
    [LINEAR_HUB_VELOCITY] = {"hub_velocity", "rad/s"},
    [LINEAR_HUB_ACCELERATION] = {"hub_acceleration", "rad/s2"},
    [LINEAR_BENDING] = {"bending", "rad"},
    [LINEAR_TIP] = {"tip", "m"},
    [LINEAR_FORCE] = {"force", "N"},
};

enum { MOST_BODIES = LINEAR_MOST_LINKS + 1, NEWTON_STEPS = 60 };

// Steps of the differences: of angles, over the number of links, by which they bend; and of all
// else, in which motions are straight lines or parabolas.
#define ANGLE_STEP 6e-3 // [rad]
#define OTHER_STEP 0.01 // [rad/s], [A], [V]

status linear_system_init(linear_system *s, int states, int outputs, fault *f)
{
    const size_t n = (size_t)states, m = (size_t)outputs;
    s->a = calloc(n * n + n + m * n + m + 1, sizeof *s->a);
    if (s->a == NULL) {
        return fault_no_memory(f);
    }
    s->states = states;
    s->outputs = outputs;
    s->b = s->a + n * n;
    s->c = s->b + n;
    s->d = s->c + m * n;
    return STATUS_OK;
}

void linear_system_finish(linear_system *s)
{
    free(s->a);
    *s = (linear_system){0};
}

// An instant of the arm: angles, rates, the motor's current, its command, and what they give.
typedef struct instant {
    double z[2 * MOST_BODIES + 2];
    double alpha[MOST_BODIES], force, tip;
} instant;

typedef struct workshop {
    arm arm;
    contact_state mode;
    chain_link links[MOST_BODIES];
    int n;              // dof
    bool rigid;         // contact with a wall that does not give
    double across[2];   // direction across the line from hub to tip
    double step;        // of the differences
    double wanted;      // force [N], NaN: the command is given
    double wanted_volt; // [V]
    instant rest;
} workshop;

static void evaluate(workshop *w, instant *at)
{
    const int n = w->n;
    double x, y;
    arm_set_voltage(&w->arm, at->z[2 * n + 1]);
    w->mode.current = at->z[2 * n];
    chain_reaction r;
    chain_accelerations(&w->arm, w->links, at->z, at->z + n, w->mode, at->alpha, &r);
    chain_node(&w->arm, at->z, w->arm.links, &x, &y);
    at->force = r.force;
    at->tip = x * w->across[0] + y * w->across[1];
}

// --- rest -------------------------------------------------------------------------------------

static void jacobian(const workshop *w, const double *q, double *j)
{
    double unit[MOST_BODIES] = {0};
    for (int k = 0; k < w->n; k++) {
        unit[k] = 1;
        j[k] = chain_penetration_rate(&w->arm, q, unit);
        unit[k] = 0;
    }
}

// What is to vanish at angles and command t[n + 1]: accelerations, on a rigid wall with the
// penetration along J, which accelerations do not have; and what the force or the command lack.
static void missing(workshop *w, const double *t, double *residual)
{
    const int n = w->n;
    instant at = {.z = {0}};
    memcpy(at.z, t, (size_t)n * sizeof *t);
    at.z[2 * n + 1] = t[n];
    at.z[2 * n] = w->arm.motor.gain * t[n] / fmax(w->arm.motor.resistance, 1e-300);
    evaluate(w, &at);
    memcpy(residual, at.alpha, (size_t)n * sizeof *residual);
    if (w->rigid) {
        double j[MOST_BODIES], g, square = 0;
        jacobian(w, t, j);
        chain_penetration(&w->arm, t, at.z + n, &g, NULL);
        for (int k = 0; k < n; k++) {
            square += j[k] * j[k];
        }
        for (int k = 0; k < n; k++) {
            residual[k] += 1e4 * g * j[k] / square;
        }
    }
    residual[n] = isnan(w->wanted) ? t[n] - w->wanted_volt : at.force - w->wanted;
    w->rest = at;
}

// Newton's iteration from the straight arm at the wall.
static status find_rest(workshop *w, const parameters *p, fault *f)
{
    enum { EDGE = MOST_BODIES + 1 };
    const int size = w->n + 1;
    double t[EDGE], residual[EDGE], shifted[2][EDGE], matrix[EDGE * EDGE], change = 1;
    for (int k = 0; k < w->n; k++) {
        t[k] = p->wall.angle;
    }
    t[w->n] = w->wanted_volt;

    for (int step = 0; step < NEWTON_STEPS && change > 1e-14; step++) {
        // slopes by differences, no further than a wall that gives is deep
        missing(w, t, residual);
        for (int j = 0; j < size; j++) {
            const double kept = t[j], e = fmin(1e-5, w->step);
            for (int side = 0; side < 2; side++) {
                t[j] = kept + (side == 0 ? e : -e);
                missing(w, t, shifted[side]);
            }
            t[j] = kept;
            for (int i = 0; i < size; i++) {
                matrix[i * size + j] = (shifted[0][i] - shifted[1][i]) / (2 * e);
            }
        }
        if (!dense_solve(size, matrix, residual)) {
            break;
        }
        change = 0;
        for (int j = 0; j < size; j++) {
            t[j] -= residual[j];
            change = fmax(change, fabs(residual[j]));
        }
    }
    missing(w, t, residual);
    if (!(change < 1e-9)) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "the arm has no place of rest on the wall under this force or command");
    }
    return STATUS_OK;
}

// --- linearised -------------------------------------------------------------------------------

// Derivatives of accelerations, force and tip by element j of z, by sixth-order differences.
static void differentiate(workshop *w, int j, double *slopes)
{
    static const double weight[3] = {0.75, -0.15, 1.0 / 60};
    const int n = w->n;
    const double step = j < n ? w->step : OTHER_STEP;
    memset(slopes, 0, (size_t)(n + 2) * sizeof *slopes);
    for (int k = -3; k <= 3; k++) {
        instant at = w->rest;
        at.z[j] += k * step;
        if (k == 0) {
            continue;
        }
        evaluate(w, &at);
        const double share = (k > 0 ? weight[k - 1] : -weight[-k - 1]) / step;
        for (int i = 0; i < n; i++) {
            slopes[i] += share * at.alpha[i];
        }
        slopes[n] += share * at.force;
        slopes[n + 1] += share * at.tip;
    }
}

// The angles left: those from `first` to the one before `end`, the one at `end` following them on
// a rigid wall.
typedef struct freedom {
    int first, end;
    double follows[MOST_BODIES]; // angle at `end` for one of each other
} freedom;

static freedom freedom_of(const workshop *w)
{
    double j[MOST_BODIES];
    freedom left = {.first = w->mode.friction == HUB_STICK ? 1 : 0, .end = w->n};
    if (w->rigid) {
        jacobian(w, w->rest.z, j);
        left.end--;
        for (int k = 0; k < left.end; k++) {
            left.follows[k] = -j[k] / j[left.end];
        }
    }
    return left;
}

static status linearise(workshop *w, linear_system *s, fault *f)
{
    const int n = w->n;
    const freedom left = freedom_of(w);
    const motor_model *m = &w->arm.motor;
    const bool flows = m->electric && m->inductance > 0;
    const int angles = left.end > left.first ? left.end - left.first : 0;
    const int states = 2 * angles + flows;
    const status code = linear_system_init(s, states, LINEAR_OUTPUTS, f);
    if (code != STATUS_OK) {
        return code;
    }

    // one column of (A, B; C, D) after the other, the command's last
    double slopes[MOST_BODIES + 2], more[MOST_BODIES + 2];
    for (int column = 0; column <= states; column++) {
        const int group = column < 2 * angles ? column / angles : 2;
        const int k = left.first + (group < 2 ? column % angles : 0);
        const int j = group < 2 ? group * n + k : column < states ? 2 * n : 2 * n + 1;
        differentiate(w, j, slopes);
        if (group < 2 && left.end < n) {
            differentiate(w, group * n + left.end, more);
            for (int i = 0; i < n + 2; i++) {
                slopes[i] += left.follows[k] * more[i];
            }
        }

        // where the column lies: input columns are vectors of their own
        double *a = column < states ? s->a + column : s->b,
               *c = column < states ? s->c + column : s->d;
        const int row = column < states ? states : 1;
        for (int i = 0; i < angles; i++) {
            a[(angles + i) * row] = slopes[left.first + i];
        }
        if (group == 1) {
            a[(column - angles) * row] = 1;
        }
        const double hub = left.first == 0 && k == 0 ? 1 : 0;
        const double first = k == w->arm.first, last = k == n - 1 ? 1 : left.follows[k];
        const bool bends = group == 0 && w->arm.links > 1;
        c[LINEAR_HUB_ANGLE * row] = group == 0 ? hub : 0;
        c[LINEAR_HUB_VELOCITY * row] = group == 1 ? hub : 0;
        c[LINEAR_HUB_ACCELERATION * row] = left.first == 0 ? slopes[0] : 0;
        c[LINEAR_BENDING * row] = bends ? last - first : 0;
        c[LINEAR_TIP * row] = group == 0 ? slopes[n + 1] : 0;
        c[LINEAR_FORCE * row] = slopes[n];
    }

    // the current
    if (flows) {
        const int i = states - 1;
        s->a[i * states + i] = -m->resistance / m->inductance;
        s->b[i] = m->gain / m->inductance;
        if (left.first == 0) {
            s->a[i * states + angles] = -m->back_emf / m->inductance;
        }
    }
    return STATUS_OK;
}

// What cannot be linearised, in words; NULL if it can.
static const char *refusal(const parameters *p, linear_place place, double force)
{
    return p->arm.model == ARM_PRINTED
               ? "the printed equations have no linear form that conserves energy, try --set "
                 "arm.model=corrected"
           : p->arm.links > LINEAR_MOST_LINKS ? "the linear arm has at most 64 links"
           : place != LINEAR_FREE && p->wall.kind == WALL_NONE ? "there is no wall to press on"
           : force < 0 ? "the arm does not press on the wall under this command"
           : force == 0 && p->wall.contact == WALL_HUNT_CROSSLEY && place != LINEAR_FREE
               ? "a Hunt-Crossley wall has no stiffness without a force"
               : NULL;
}

// Linearises with the workshop prepared.
static status linearise_at(workshop *w, linear_arm *out, const parameters *p, linear_place place,
                           fault *f)
{
    status code = STATUS_OK;
    for (int k = 0; k < w->n; k++) {
        w->rest.z[k] = p->wall.angle;
    }
    if (place != LINEAR_FREE) {
        code = find_rest(w, p, f);
    }
    const double force = place != LINEAR_FREE && code == STATUS_OK ? w->rest.force : 0;
    const char *why = code == STATUS_OK ? refusal(p, place, force < -1e-12 ? -1 : 1) : NULL;
    if (why != NULL) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "%s", why);
    }
    if (code != STATUS_OK) {
        return code;
    }

    // its numbers there, then its slopes
    double x, y;
    chain_node(&w->arm, w->rest.z, w->arm.links, &x, &y);
    const double distance = sqrt(x * x + y * y);
    w->across[0] = -y / distance;
    w->across[1] = x / distance;
    out->voltage = w->rest.z[2 * w->n + 1];
    out->force = force;
    out->hub_angle = w->rest.z[0];
    out->bending = w->rest.z[w->n - 1] - w->rest.z[w->arm.first];
    w->mode.friction = place == LINEAR_STUCK ? HUB_STICK : HUB_FORWARD;
    return linearise(w, &out->system, f);
}

status linear_arm_init(linear_arm *out, const parameters *p, linear_place place, fault *f)
{
    assert(out != NULL && p != NULL);
    *out = (linear_arm){.force = 0};
    const bool held = p->control.law != LAW_NONE;
    const char *why = refusal(p, place, held ? p->control.force : p->motor.voltage);
    if (why != NULL) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "%s", why);
    }
    workshop *w = calloc(1, sizeof *w);
    if (w == NULL) {
        return fault_no_memory(f);
    }

    // without Coulomb friction and limits, which are no part of small motions
    parameters smooth = *p;
    smooth.motor.stiction = 0;
    smooth.motor.voltage_limit = HUGE_VAL;
    smooth.motor.current_limit = 0;
    arm_init(&w->arm, &smooth);
    w->n = w->arm.dof;
    w->mode = (contact_state){.contact = place != LINEAR_FREE, .friction = HUB_FORWARD};
    w->rigid = place != LINEAR_FREE && p->wall.contact == WALL_RIGID;
    w->wanted = held && place != LINEAR_FREE ? p->control.force : (double)NAN;
    w->wanted_volt = held || place == LINEAR_FREE ? 0 : p->motor.voltage;

    // a spring that stiffens with its depth is followed for a small part of it
    w->step = ANGLE_STEP / p->arm.links;
    if (p->wall.contact == WALL_HUNT_CROSSLEY && place != LINEAR_FREE) {
        const double torque = motor_torque_per_volt(&p->motor) * p->motor.voltage;
        const double force = held ? p->control.force : torque / p->arm.length;
        const double depth = plain_pow(force / p->wall.stiffness, 1 / p->wall.exponent);
        w->step = fmin(w->step, 0.02 * depth / p->arm.length);
    }
    const status code = linearise_at(w, out, p, place, f);
    free(w);
    return code;
}
