// The arm at rest, its equations of motion linearised there, and those from sample to
// sample.
//
// Rates are the derivatives of chain_accelerations by differences of sixth order, which
// are good to some 1e-12 of a row. A rigid wall leaves angles with J q = 0: the last
// link's follows from the others.
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/arm/chain.h"
#include "src/base/dense.h"
#include "src/rig/sensors.h"
#include "src/study/linear/linear.h"

const char *const linear_output_names[LINEAR_OUTPUTS] = {
    "hub_angle", "hub_velocity", "hub_acceleration", "bending", "tip", "force"};

enum {
    MOST_BODIES = LINEAR_MOST_LINKS + 1,
    NEWTON_STEPS = 60,
    EDGE = 2 * MOST_BODIES + 2
};

// Steps of the differences: of angles, over the number of links, by which they bend; and
// of all else, in which motions are straight lines or parabolas.
#define ANGLE_STEP 6e-3 // [rad]
#define OTHER_STEP 0.01 // [rad/s], [A], [V]

#define NO_FORCE   1e-12 // rounding of one [N]

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

// An instant z: angles, their rates, the motor's current, its command. What it gives: the
// angles' accelerations, then the force and the tip's place across the line from the hub.
typedef struct workshop {
    arm arm;
    contact_state mode;
    chain_link links[MOST_BODIES];
    int n;            // dof
    bool rigid;       // contact with a wall that does not give
    double across[2]; // that direction
    double step;      // of the differences of angles
    double wanted;    // force [N], NaN: the command is given
    double command;   // [V]
    double rest[EDGE];
} workshop;

static void evaluate_balance(workshop *w, const double *z, double *out)
{
    double x, y;
    chain_reaction r;
    arm_set_voltage(&w->arm, z[2 * w->n + 1]);
    w->mode.current = z[2 * w->n];
    chain_accelerations(&w->arm, w->links, z, z + w->n, w->mode, out, &r);
    chain_node(&w->arm, z, w->arm.links, &x, &y);
    out[w->n] = r.force;
    out[w->n + 1] = x * w->across[0] + y * w->across[1];
}

// --- rest ------------------------------------------------------------------------------

static void jacobian(const workshop *w, double *j)
{
    double unit[MOST_BODIES] = {0};
    for (int k = 0; k < w->n; k++) {
        unit[k] = 1;
        j[k] = chain_penetration_rate(&w->arm, w->rest, unit);
        unit[k] = 0;
    }
}

// What is to vanish at w->rest: accelerations, on a rigid wall with the penetration along
// J, which accelerations do not have; and what the force or the command lack.
static void missing(workshop *w, double *residual)
{
    const int n = w->n;
    const double volts = w->rest[2 * n + 1];
    double out[MOST_BODIES + 2], j[MOST_BODIES], square = 0;
    w->rest[2 * n] = w->arm.motor.gain * volts / fmax(w->arm.motor.resistance, 1e-300);
    evaluate_balance(w, w->rest, out);
    memcpy(residual, out, (size_t)n * sizeof *residual);
    if (isnan(w->wanted)) {
        residual[n] = volts - w->command;
    } else {
        residual[n] = out[n] - w->wanted;
    }
    if (w->rigid) {
        jacobian(w, j);
        const double g = chain_penetration(&w->arm, w->rest, w->rest + n).depth;
        for (int k = 0; k < n; k++) {
            square += j[k] * j[k];
        }
        for (int k = 0; k < n; k++) {
            residual[k] += 1e4 * g * j[k] / square;
        }
    }
}

// Newton's iteration from the straight arm at the wall; slopes by differences, no further
// than a wall that gives is deep.
static status find_rest(workshop *w, fault *f)
{
    const int size = w->n + 1;
    const double e = fmin(1e-5, w->step);
    double residual[MOST_BODIES + 1], shifted[2][MOST_BODIES + 1], change = 1;
    double matrix[(MOST_BODIES + 1) * (MOST_BODIES + 1)];
    w->rest[2 * w->n + 1] = w->command;

    // the unknowns: the angles, then the command
    double *unknown[MOST_BODIES + 1];
    for (int j = 0; j < size; j++) {
        unknown[j] = j < w->n ? &w->rest[j] : &w->rest[2 * w->n + 1];
    }
    for (int step = 0; step < NEWTON_STEPS && change > 1e-14; step++) {
        missing(w, residual);
        for (int j = 0; j < size; j++) {
            const double kept = *unknown[j];
            *unknown[j] = kept + e;
            missing(w, shifted[0]);
            *unknown[j] = kept - e;
            missing(w, shifted[1]);
            *unknown[j] = kept;
            for (int i = 0; i < size; i++) {
                matrix[i * size + j] = (shifted[0][i] - shifted[1][i]) / (2 * e);
            }
        }
        if (!dense_solve(size, matrix, residual)) {
            break;
        }
        change = 0;
        for (int j = 0; j < size; j++) {
            *unknown[j] -= residual[j];
            change = fmax(change, fabs(residual[j]));
        }
    }
    missing(w, residual);
    if (!(change < 1e-9)) {
        return fault_set(
            f, STATUS_BAD_ARGUMENT,
            "the arm has no place of rest on the wall under this force or command");
    }
    return STATUS_OK;
}

// --- linearised ------------------------------------------------------------------------

// Derivatives of what an instant gives along a direction of z, by sixth-order
// differences.
static void differentiate(workshop *w, const double *direction, double step,
                          double *slopes)
{
    static const double weight[3] = {0.75, -0.15, 1.0 / 60};
    double ends[2][MOST_BODIES + 2], z[EDGE];
    memset(slopes, 0, (size_t)(w->n + 2) * sizeof *slopes);
    for (int k = 0; k < 3; k++) {
        for (int side = 0; side < 2; side++) {
            const int steps = side == 0 ? k + 1 : -k - 1;
            for (int i = 0; i < 2 * w->n + 2; i++) {
                z[i] = w->rest[i] + steps * step * direction[i];
            }
            evaluate_balance(w, z, ends[side]);
        }
        for (int i = 0; i < w->n + 2; i++) {
            slopes[i] += weight[k] / step * (ends[0][i] - ends[1][i]);
        }
    }
}

static status linearise(workshop *w, linear_system *s, fault *f)
{
    // the angles left: from `first` to the one before `end`, which follows them on a
    // rigid wall
    const int n = w->n, end = n - w->rigid;
    const int first = w->mode.friction == HUB_STICK ? 1 : 0;
    const motor_model *m = &w->arm.motor;
    const bool flows = m->electric && m->inductance > 0;
    const int angles = end > first ? end - first : 0;
    const int states = 2 * angles + flows;
    TRY(linear_system_init(s, states, LINEAR_OUTPUTS, f));

    // one column of (A, B; C, D) after the other, the command's last: a vector of its own
    double slopes[MOST_BODIES + 2], j[MOST_BODIES];
    jacobian(w, j);
    for (int column = 0; column <= states; column++) {
        double z[EDGE] = {0};
        const bool is_command = column == states;
        const int group = column < 2 * angles ? column / angles : 2;
        double *moved = z + group * n;
        if (is_command) {
            moved[1] = 1;
        } else if (group == 2) {
            moved[0] = 1;
        } else {
            moved[first + column % angles] = 1;
            if (end < n) {
                moved[end] = -j[first + column % angles] / j[end];
            }
        }
        const double step = group == 0 ? w->step : OTHER_STEP;
        differentiate(w, z, step, slopes);

        double *a = s->a + column, *c = s->c + column;
        int row = states;
        if (is_command) {
            a = s->b;
            c = s->d;
            row = 1;
        }
        for (int i = 0; i < angles; i++) {
            a[(angles + i) * row] = slopes[first + i];
        }
        if (group == 1) {
            a[(column - angles) * row] = 1;
        }
        c[LINEAR_HUB_ANGLE * row] = z[0];
        c[LINEAR_HUB_VELOCITY * row] = z[n];
        if (first == 0) {
            c[LINEAR_HUB_ACCELERATION * row] = slopes[0];
        } else {
            c[LINEAR_HUB_ACCELERATION * row] = 0;
        }
        c[LINEAR_BENDING * row] = z[n - 1] - z[w->arm.first];
        c[LINEAR_TIP * row] = slopes[n + 1];
        c[LINEAR_FORCE * row] = slopes[n];
    }

    // the current
    if (flows) {
        const int i = states - 1;
        s->a[i * states + i] = -m->resistance / m->inductance;
        s->b[i] = m->gain / m->inductance;
        if (first == 0 && angles > 0) {
            s->a[i * states + angles] = -m->back_emf / m->inductance;
        }
    }
    return STATUS_OK;
}

// What cannot be linearised, in words; NULL if it can.
static const char *refusal(const parameters *p, linear_place place, double force)
{
    if (p->arm.model == ARM_PRINTED) {
        return "the printed equations have no linear form that conserves energy, "
               "try --set arm.model=corrected";
    }
    if (p->arm.links > LINEAR_MOST_LINKS) {
        return "the linear arm has at most 64 links";
    }
    if (place == LINEAR_FREE) {
        return NULL;
    }
    if (p->wall.kind == WALL_NONE) {
        return "there is no wall to press on";
    }
    if (p->wall.motion != MOTION_NONE) {
        return "nothing rests on a wall that moves, try --set wall.motion=none";
    }
    if (force < 0) {
        return "the arm does not press on the wall under this command";
    }
    if (force == 0 && p->wall.contact == WALL_HUNT_CROSSLEY) {
        return "a Hunt-Crossley wall has no stiffness without a force";
    }
    return NULL;
}

// The arm at a wall of this kind of contact, without Coulomb friction and limits, which
// are no part of small motions.
static void put_arm(workshop *w, const parameters *p, int contact)
{
    parameters smooth = *p;
    smooth.motor.stiction = 0;
    smooth.motor.voltage_limit = HUGE_VAL;
    smooth.motor.current_limit = 0;
    smooth.wall.contact = contact;
    arm_init(&w->arm, &smooth);
    w->n = w->arm.dof;
    w->rigid = w->mode.contact && contact == WALL_RIGID;
    w->step = ANGLE_STEP / p->arm.links;
}

// Takes an arm from its rest on a rigid wall into the one that stiffens with its depth,
// as deep as it presses: from farther off Newton's iteration ends where no arm rests.
// Such a spring is followed for a small part of its depth.
static void press_in(workshop *w, const parameters *p, double force)
{
    double turn[MOST_BODIES];
    for (int k = 0; k < w->n; k++) {
        turn[k] = 1;
    }
    put_arm(w, p, p->wall.contact);
    const double depth = plain_pow(force / p->wall.stiffness, 1 / p->wall.exponent);
    const double angle = depth / chain_penetration_rate(&w->arm, w->rest, turn);
    for (int k = 0; k < w->n; k++) {
        w->rest[k] += angle;
    }
    w->step = fmin(w->step, 0.02 * depth / p->arm.length);
}

// The force at rest [N], or why that has no linear form.
static status force_at_rest(workshop *w, const parameters *p, linear_place place,
                            double *force, fault *f)
{
    double there[MOST_BODIES + 2];
    status code = STATUS_OK;
    if (place != LINEAR_FREE) {
        code = find_rest(w, f);
    }
    evaluate_balance(w, w->rest, there);
    if (place != LINEAR_FREE) {
        *force = there[w->n];
    } else {
        *force = 0;
    }
    const double pressing = fabs(*force) > NO_FORCE ? *force : 0;
    const char *why = refusal(p, place, pressing);
    if (code == STATUS_OK && why != NULL) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "%s", why);
    }
    return code;
}

// Rest, its numbers, and the slopes there, with the workshop prepared.
static status linearise_at(workshop *w, linear_arm *out, const parameters *p,
                           linear_place place, fault *f)
{
    double x, y;
    TRY(force_at_rest(w, p, place, &out->force, f));
    chain_node(&w->arm, w->rest, w->arm.links, &x, &y);
    const double distance = sqrt(x * x + y * y);
    w->across[0] = -y / distance;
    w->across[1] = x / distance;
    out->voltage = w->rest[2 * w->n + 1];
    out->hub_angle = w->rest[0];
    out->bending = w->rest[w->n - 1] - w->rest[w->arm.first];
    if (place == LINEAR_STUCK) {
        w->mode.friction = HUB_STICK;
    } else {
        w->mode.friction = HUB_FORWARD;
    }
    return linearise(w, &out->system, f);
}

status linear_arm_init(linear_arm *out, const parameters *p, linear_place place, fault *f)
{
    *out = (linear_arm){.force = 0};
    const bool touches = place != LINEAR_FREE,
               held = touches && p->control.law != LAW_NONE;
    const bool weighs =
        !held && p->arm.tilt != 0;     // which may press or lift, and is seen at rest
    double presses = p->motor.voltage; // above zero: the arm may press
    if (held) {
        presses = p->control.force;
    } else if (weighs) {
        presses = 1;
    }
    const char *why = refusal(p, place, presses);
    FAULT_IF(why != NULL, f, STATUS_BAD_ARGUMENT, "%s", why);
    SCOPED(free_kept) workshop *w = calloc(1, sizeof *w);
    if (w == NULL) {
        return fault_no_memory(f);
    }

    // straight; what is pressed into a wall that stiffens is found from a rigid one
    const bool stiffens = touches && p->wall.contact == WALL_HUNT_CROSSLEY;
    w->mode = (contact_state){.contact = touches, .friction = HUB_FORWARD};
    if (held) {
        w->wanted = p->control.force;
    } else {
        w->wanted = (double)NAN;
    }
    if (held || !touches) {
        w->command = 0;
    } else {
        w->command = p->motor.voltage;
    }
    put_arm(w, p, stiffens ? WALL_RIGID : p->wall.contact);
    for (int k = 0; k < w->n; k++) {
        w->rest[k] = p->wall.angle;
    }
    if (stiffens) {
        TRY(force_at_rest(w, p, place, &out->force, f));
        press_in(w, p, out->force);
    }
    return linearise_at(w, out, p, place, f);
}

// --- between samples -------------------------------------------------------------------

enum { MOST_LAGS = 6 };

// The arm, and behind its states the lags of sensors, value' = (input - value)/time.
typedef struct lagged_arm {
    const linear_system *arm;
    int states;           // in use
    linear_system system; // of all readings
} lagged_arm;

// Adds `share` times an output of the arm, behind a lag [s] if there is one, to a
// reading.
static void see(lagged_arm *l, int reading, int output, double share, double time)
{
    const int n = l->arm->states, edge = l->system.states;
    const double *c = l->arm->c + output * n, d = l->arm->d[output];
    double *row = l->system.c + reading * edge, *direct = &l->system.d[reading],
           scale = share;
    if (time > 0) {
        row[l->states] += share;
        row = l->system.a + l->states * edge;
        row[l->states] = -1 / time;
        direct = &l->system.b[l->states++];
        scale = 1 / time;
    }
    for (int j = 0; j < n; j++) {
        row[j] += scale * c[j];
    }
    *direct += scale * d;
}

// Rise and leak of the piezoelectric sensor, as the difference of two lags (sensors.c).
static void see_piezo(lagged_arm *l, int reading, const sensors *s)
{
    const double rise = s->piezo_rise.time_constant, leak = s->piezo_leak.time_constant;
    const double share = leak > 0 ? leak / (leak - rise) : 1;
    see(l, reading, LINEAR_FORCE, share, rise);
    if (leak > 0) {
        see(l, reading, LINEAR_FORCE, -share, leak);
    }
}

static void see_all(lagged_arm *l, const parameters *p)
{
    const int n = l->arm->states;
    sensors s;
    sensors_init(&s, &p->sensor, p->control.seed);
    for (int i = 0; i < n; i++) {
        memcpy(l->system.a + i * l->system.states, l->arm->a + i * n,
               (size_t)n * sizeof(double));
        l->system.b[i] = l->arm->b[i];
    }
    see(l, READ_ENCODER, LINEAR_HUB_ANGLE, 1, 0);
    see(l, READ_TACHOMETER, LINEAR_HUB_VELOCITY, 1, 0);
    l->system.d[READ_VOLTAGE] = 1;
    if (p->sensor.force == FORCE_BY_PIEZO) {
        see_piezo(l, READ_FORCE, &s);
    } else {
        see(l, READ_FORCE, LINEAR_FORCE, 1, s.fsr.time_constant);
    }
    if (p->sensor.piezo) {
        see_piezo(l, READ_PIEZO, &s);
    }
    if (p->sensor.film) {
        see(l, READ_FILM, LINEAR_BENDING, 1, 0);
        if (s.film_leak.time_constant > 0) {
            see(l, READ_FILM, LINEAR_BENDING, -1, s.film_leak.time_constant);
        }
    }
    if (p->sensor.accelerometer) {
        see(l, READ_ACCELEROMETER, LINEAR_HUB_ACCELERATION, 1,
            s.acceleration.time_constant);
    }
}

// Fills in the sampled system of n states and `held` commands on their way, u_k-held
// first. From exp((A, B; 0, 0) h) = (exp(A h), integral of exp(A t) B; 0, 1): over `late`
// the older command, then the newer one.
static status fill_sampled(linear_system *out, const linear_system *s, int n, int held,
                           double period, double late, fault *f)
{
    const int size = n + 1, states = out->states;
    const size_t square = (size_t)size * (size_t)size;
    SCOPED(free_kept) double *both = calloc(5 * square, sizeof *both);
    if (both == NULL) {
        return fault_no_memory(f);
    }
    double *before = both + square, *after = before + square, *power = after + square,
           *product = power + square;
    for (int i = 0; i < n; i++) {
        memcpy(both + i * size, s->a + i * s->states, (size_t)n * sizeof *both);
        both[i * size + n] = s->b[i];
    }
    matrix_exponential(both, size, late, before, power, product);
    matrix_exponential(both, size, period - late, after, power, product);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j <= n; j++) {
            for (int k = 0; k < n; k++) {
                out->a[i * states + j] += after[i * size + k] * before[k * size + j];
            }
        }
        if (held > 1) {
            out->a[i * states + n + 1] = after[i * size + n];
        } else {
            out->b[i] = after[i * size + n];
        }
    }

    // commands move up; what is read sees the oldest
    for (int i = 0; i + 1 < held; i++) {
        out->a[(n + i) * states + n + i + 1] = 1;
    }
    out->b[states - 1] = 1;
    for (int i = 0; i < LINEAR_READINGS; i++) {
        memcpy(out->c + i * states, s->c + i * s->states, (size_t)n * sizeof *out->c);
        out->c[i * states + n] = s->d[i];
    }
    return STATUS_OK;
}

status linear_sample(linear_system *sampled, const linear_arm *rest, const parameters *p,
                     fault *f)
{
    assert(p->control.rate > 0);
    lagged_arm l = {.arm = &rest->system, .states = rest->system.states};
    *sampled = (linear_system){0};
    TRY(linear_system_init(&l.system, l.states + MOST_LAGS, LINEAR_READINGS, f));
    see_all(&l, p);

    // the delay: whole periods, and the rest, in which the command before is still in
    // effect; a reading at a sample sees the command before the one that comes with it
    const double period = 1 / p->control.rate,
                 delay = p->control.delay / period + p->control.delay_periods;
    const double whole = floor(delay + 1e-12), part = fmax(0, delay - whole);
    const int held = (int)whole + 1;
    status code = linear_system_init(sampled, l.states + held, LINEAR_READINGS, f);
    if (code == STATUS_OK) {
        code = fill_sampled(sampled, &l.system, l.states, held, period, part * period, f);
    }
    linear_system_finish(&l.system);
    if (code != STATUS_OK) {
        linear_system_finish(sampled);
    }
    return code;
}
