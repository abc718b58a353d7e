// Finds where the arm rests, linearises its equations of motion there, and turns them
// into equations from sample to sample.
//
// The slopes of chain_accelerations are differences of sixth order, whose errors are some
// 1e-12 of a matrix's row. A rigid wall allows only motions q of the angles with J q = 0,
// J being the slope of the penetration: the last link's angle follows from the others.
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

// Steps of the differences: of an angle, to be divided by the number of links; and of all
// other quantities, of which the accelerations are polynomials of first or second degree.
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

// What the search for rest and the linearisation work on. An instant z lists n angles,
// their n rates, the motor's current and its command.
typedef struct workshop {
    arm arm;
    contact_state mode;
    chain_link links[MOST_BODIES];
    int n;             // degrees of freedom
    bool rigid;        // contact with a wall that does not give
    double across[2];  // unit vector across the line from the hub to the tip at rest
    double angle_step; // of the differences of angles [rad]
    double wanted;     // force [N], NaN: the command is given
    double command;    // [V]
    double rest[EDGE]; // the instant at rest
} workshop;

// Evaluates the arm at an instant z: out[n + 2] receives the angles' accelerations, then
// the wall's force and the tip's place across the line from the hub.
static void evaluate_instant(workshop *w, const double *z, double *out)
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

// The slopes J of the penetration by each angle, at rest, j[n].
static void penetration_slopes(const workshop *w, double *j)
{
    double unit[MOST_BODIES] = {0};
    for (int k = 0; k < w->n; k++) {
        unit[k] = 1;
        j[k] = chain_penetration_rate(&w->arm, w->rest, unit);
        unit[k] = 0;
    }
}

// The n + 1 numbers that vanish where w->rest is a rest: the accelerations, and how far
// the force or the command is from what is wanted. On a rigid wall the accelerations say
// nothing along J, and the penetration g is put there: g J/|J|^2, with a factor.
static void rest_residual(workshop *w, double *residual)
{
    const int n = w->n;
    const double volts = w->rest[2 * n + 1];
    double out[MOST_BODIES + 2], j[MOST_BODIES], square = 0;

    // the current that the command drives at rest, and the accelerations
    w->rest[2 * n] = w->arm.motor.gain * volts / fmax(w->arm.motor.resistance, 1e-300);
    evaluate_instant(w, w->rest, out);
    memcpy(residual, out, (size_t)n * sizeof *residual);
    if (isnan(w->wanted)) {
        residual[n] = volts - w->command;
    } else {
        residual[n] = out[n] - w->wanted;
    }

    if (w->rigid) {
        penetration_slopes(w, j);
        const double g = chain_penetration(&w->arm, w->rest, w->rest + n).depth;
        for (int k = 0; k < n; k++) {
            square += j[k] * j[k];
        }
        for (int k = 0; k < n; k++) {
            residual[k] += 1e4 * g * j[k] / square;
        }
    }
}

// Finds w->rest by Newton's iteration from where it stands, the slopes of the residual
// being central differences. Their step is not longer than a soft wall is deep.
static status find_rest(workshop *w, fault *f)
{
    const int size = w->n + 1;
    const double step = fmin(1e-5, w->angle_step);
    double residual[MOST_BODIES + 1], above[MOST_BODIES + 1], below[MOST_BODIES + 1];
    double change = 1;
    double matrix[(MOST_BODIES + 1) * (MOST_BODIES + 1)];
    w->rest[2 * w->n + 1] = w->command;

    // the unknowns: the angles, then the command
    double *unknown[MOST_BODIES + 1];
    for (int j = 0; j < size; j++) {
        unknown[j] = j < w->n ? &w->rest[j] : &w->rest[2 * w->n + 1];
    }
    for (int k = 0; k < NEWTON_STEPS && change > 1e-14; k++) {
        rest_residual(w, residual);
        for (int j = 0; j < size; j++) {
            const double value = *unknown[j];
            *unknown[j] = value + step;
            rest_residual(w, above);
            *unknown[j] = value - step;
            rest_residual(w, below);
            *unknown[j] = value;
            for (int i = 0; i < size; i++) {
                matrix[i * size + j] = (above[i] - below[i]) / (2 * step);
            }
        }

        // the solution of matrix change = residual replaces the residual
        if (!dense_solve(size, matrix, residual)) {
            break;
        }
        change = 0;
        for (int j = 0; j < size; j++) {
            *unknown[j] -= residual[j];
            change = fmax(change, fabs(residual[j]));
        }
    }
    rest_residual(w, residual); // leaves the current of the last command in w->rest
    if (!(change < 1e-9)) {
        return fault_set(
            f, STATUS_BAD_ARGUMENT,
            "the arm has no place of rest on the wall under this force or command");
    }
    return STATUS_OK;
}

// --- linearised ------------------------------------------------------------------------

// The slopes of evaluate_instant's results at rest along a direction of z, by central
// differences of sixth order: sum over k of weight_k (f(k step) - f(-k step))/step.
static void differentiate(workshop *w, const double *direction, double step,
                          double *slopes)
{
    static const double weight[3] = {0.75, -0.15, 1.0 / 60};
    double ahead[MOST_BODIES + 2], behind[MOST_BODIES + 2], z[EDGE];
    memset(slopes, 0, (size_t)(w->n + 2) * sizeof *slopes);
    for (int k = 1; k <= 3; k++) {
        for (int i = 0; i < 2 * w->n + 2; i++) {
            z[i] = w->rest[i] + k * step * direction[i];
        }
        evaluate_instant(w, z, ahead);
        for (int i = 0; i < 2 * w->n + 2; i++) {
            z[i] = w->rest[i] + -k * step * direction[i];
        }
        evaluate_instant(w, z, behind);
        for (int i = 0; i < w->n + 2; i++) {
            slopes[i] += weight[k - 1] / step * (ahead[i] - behind[i]);
        }
    }
}

// Fills in A, B, C and D at rest. The states are the angles that are free, their rates,
// and the current of a motor with inductance.
static status linearise(workshop *w, linear_system *s, fault *f)
{
    // The free angles run from `first_free`, which leaves out a hub that sticks, to the
    // one before `end_free`, which leaves out the last link's angle on a rigid wall.
    const int n = w->n;
    const int first_free = w->mode.friction == HUB_STICK ? 1 : 0;
    const int end_free = w->rigid ? n - 1 : n;
    const int angles = end_free > first_free ? end_free - first_free : 0;
    const motor_model *m = &w->arm.motor;
    const bool has_current = m->electric && m->inductance > 0;
    const int states = has_current ? 2 * angles + 1 : 2 * angles;
    TRY(linear_system_init(s, states, LINEAR_OUTPUTS, f));

    // Each column of (A, B; C, D) is the slopes along a direction of z: one for each
    // state, the last one for the command.
    enum { ANGLES, RATES, MOTOR };
    double slopes[MOST_BODIES + 2], j[MOST_BODIES];
    penetration_slopes(w, j);
    for (int column = 0; column <= states; column++) {
        const bool is_command = column == states;
        const int group = column < 2 * angles ? column / angles : MOTOR;

        // the direction, in which an angle or rate takes the last link's along, so that
        // J q = 0
        double direction[EDGE] = {0};
        double *moved = direction + group * n;
        if (is_command) {
            moved[1] = 1;
        } else if (group == MOTOR) {
            moved[0] = 1;
        } else {
            moved[first_free + column % angles] = 1;
            if (w->rigid) {
                moved[end_free] = -j[first_free + column % angles] / j[end_free];
            }
        }
        differentiate(w, direction, group == ANGLES ? w->angle_step : OTHER_STEP, slopes);

        // the column in A and C, or the vectors B and D; `stride` leads to the next row
        double *a = s->a + column, *c = s->c + column;
        int stride = states;
        if (is_command) {
            a = s->b;
            c = s->d;
            stride = 1;
        }
        for (int i = 0; i < angles; i++) {
            a[(angles + i) * stride] = slopes[first_free + i];
        }
        if (group == RATES) {
            a[(column - angles) * stride] = 1;
        }
        c[LINEAR_HUB_ANGLE * stride] = direction[0];
        c[LINEAR_HUB_VELOCITY * stride] = direction[n];
        if (first_free == 0) {
            c[LINEAR_HUB_ACCELERATION * stride] = slopes[0];
        } else {
            c[LINEAR_HUB_ACCELERATION * stride] = 0;
        }
        c[LINEAR_BENDING * stride] = direction[n - 1] - direction[w->arm.first];
        c[LINEAR_TIP * stride] = slopes[n + 1];
        c[LINEAR_FORCE * stride] = slopes[n];
    }

    // the current i obeys L i' = gain u - R i - k_e (hub velocity)
    if (has_current) {
        const int i = states - 1;
        s->a[i * states + i] = -m->resistance / m->inductance;
        s->b[i] = m->gain / m->inductance;
        if (first_free == 0 && angles > 0) {
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

// Makes the workshop's arm, at a wall of this kind of contact. It has no Coulomb friction
// and no limits of voltage or current, which have no part in small motions.
static void make_smooth_arm(workshop *w, const parameters *p, int contact)
{
    parameters smooth = *p;
    smooth.motor.stiction = 0;
    smooth.motor.voltage_limit = HUGE_VAL;
    smooth.motor.current_limit = 0;
    smooth.wall.contact = contact;
    arm_init(&w->arm, &smooth);
    w->n = w->arm.dof;
    w->rigid = w->mode.contact && contact == WALL_RIGID;
    w->angle_step = ANGLE_STEP / p->arm.links;
}

// Turns the whole arm from its rest on a rigid wall into a Hunt-Crossley wall, as deep as
// that wall has to be for the force: force = stiffness depth^exponent. From farther off
// Newton's iteration ends where no arm rests. The differences take steps that are short
// against the depth, over which the wall's stiffness hardly changes.
static void press_in(workshop *w, const parameters *p, double force)
{
    double whole_arm[MOST_BODIES];
    for (int k = 0; k < w->n; k++) {
        whole_arm[k] = 1;
    }
    make_smooth_arm(w, p, p->wall.contact);
    const double depth = plain_pow(force / p->wall.stiffness, 1 / p->wall.exponent);
    const double angle = depth / chain_penetration_rate(&w->arm, w->rest, whole_arm);
    for (int k = 0; k < w->n; k++) {
        w->rest[k] += angle;
    }
    w->angle_step = fmin(w->angle_step, 0.02 * depth / p->arm.length);
}

// Finds the rest and the force there [N], 0 of a free arm. It is a fault if the arm
// cannot be linearised there.
static status force_at_rest(workshop *w, const parameters *p, linear_place place,
                            double *force, fault *f)
{
    double at_rest[MOST_BODIES + 2];
    status code = STATUS_OK;
    if (place != LINEAR_FREE) {
        code = find_rest(w, f);
    }
    evaluate_instant(w, w->rest, at_rest);
    if (place != LINEAR_FREE) {
        *force = at_rest[w->n];
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

// Finds the rest in a workshop that was prepared, and linearises the arm there.
static status linearise_at_rest(workshop *w, linear_arm *out, const parameters *p,
                                linear_place place, fault *f)
{
    TRY(force_at_rest(w, p, place, &out->force, f));

    // the unit vector across the line from the hub to the tip at (x, y)
    double x, y;
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
    const bool touches = place != LINEAR_FREE;
    const bool held_by_law = touches && p->control.law != LAW_NONE;

    // A number of the sign of the force to come, to refuse an arm that cannot press. The
    // weight of a tilted arm may press or lift it, which only the rest will tell.
    double likely_force = p->motor.voltage;
    if (held_by_law) {
        likely_force = p->control.force;
    } else if (p->arm.tilt != 0) {
        likely_force = 1;
    }
    const char *why = refusal(p, place, likely_force);
    FAULT_IF(why != NULL, f, STATUS_BAD_ARGUMENT, "%s", why);
    SCOPED(free_kept) workshop *w = calloc(1, sizeof *w);
    if (w == NULL) {
        return fault_no_memory(f);
    }

    // either the force or the command is given
    w->mode = (contact_state){.contact = touches, .friction = HUB_FORWARD};
    if (held_by_law) {
        w->wanted = p->control.force;
    } else {
        w->wanted = (double)NAN;
    }
    if (held_by_law || !touches) {
        w->command = 0;
    } else {
        w->command = p->motor.voltage;
    }

    // start from the straight arm at the wall; the rest in a wall that stiffens with its
    // depth is searched from the rest on a rigid one
    const bool stiffens = touches && p->wall.contact == WALL_HUNT_CROSSLEY;
    make_smooth_arm(w, p, stiffens ? WALL_RIGID : p->wall.contact);
    for (int k = 0; k < w->n; k++) {
        w->rest[k] = p->wall.angle;
    }
    if (stiffens) {
        TRY(force_at_rest(w, p, place, &out->force, f));
        press_in(w, p, out->force);
    }
    return linearise_at_rest(w, out, p, place, f);
}

// --- between samples -------------------------------------------------------------------

enum { MOST_LAGS = 6 };

// The arm with its sensors, whose outputs are the readings. The states of the sensors'
// lags follow those of the arm: value' = (input - value)/time.
typedef struct lagged_arm {
    const linear_system *arm;
    int states;           // in use
    linear_system system; // with room for MOST_LAGS more states than the arm's
} lagged_arm;

// Adds `share` times an output of the arm to a reading, through a lag if its time [s] is
// above 0.
static void see(lagged_arm *l, int reading, int output, double share, double time)
{
    const int n = l->arm->states, width = l->system.states;
    const double *c = l->arm->c + output * n, d = l->arm->d[output];

    // the row of C and D to which the output goes, or with a lag a new row of A and B
    double *row = l->system.c + reading * width, *direct = &l->system.d[reading];
    double scale = share;
    if (time > 0) {
        row[l->states] += share;
        row = l->system.a + l->states * width;
        row[l->states] = -1 / time;
        direct = &l->system.b[l->states++];
        scale = 1 / time;
    }
    for (int j = 0; j < n; j++) {
        row[j] += scale * c[j];
    }
    *direct += scale * d;
}

// Adds the reading of the piezoelectric sensor: its rise and leak are the difference of
// two lags (sensors.c).
static void see_piezo(lagged_arm *l, int reading, const sensors *s)
{
    const double rise = s->piezo_rise.time_constant, leak = s->piezo_leak.time_constant;
    const double share = leak > 0 ? leak / (leak - rise) : 1;
    see(l, reading, LINEAR_FORCE, share, rise);
    if (leak > 0) {
        see(l, reading, LINEAR_FORCE, -share, leak);
    }
}

// Copies the arm's equations and adds the readings of all sensors that are fitted.
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
// first. Within a period the older command acts for a time `late`, then the newer one.
// Over a time h of either
//
//     exp((A, B; 0, 0) h) = (exp(A h), integral of exp(A t) B; 0, 1)
static status fill_sampled(linear_system *out, const linear_system *s, int n, int held,
                           double period, double late, fault *f)
{
    const int size = n + 1, states = out->states;
    const size_t square = (size_t)size * (size_t)size;
    SCOPED(free_kept) double *generator = calloc(5 * square, sizeof *generator);
    if (generator == NULL) {
        return fault_no_memory(f);
    }
    double *before = generator + square, *after = before + square;
    double *power = after + square, *product = power + square;

    // the matrix (A, B; 0, 0), and its exponentials before and after the change of
    // command
    for (int i = 0; i < n; i++) {
        memcpy(generator + i * size, s->a + i * s->states, (size_t)n * sizeof *generator);
        generator[i * size + n] = s->b[i];
    }
    matrix_exponential(generator, size, late, before, power, product);
    matrix_exponential(generator, size, period - late, after, power, product);

    // their product leads from sample to sample; column n belongs to the older command
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

    // each sample moves the commands up by one; the readings see the oldest
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

// Samples the arm at rest, with its sensors' lags and the delay of commands, at
// control.rate.
status linear_sample(linear_system *sampled, const linear_arm *rest, const parameters *p,
                     fault *f)
{
    assert(p->control.rate > 0);
    lagged_arm l = {.arm = &rest->system, .states = rest->system.states};
    *sampled = (linear_system){0};
    TRY(linear_system_init(&l.system, l.states + MOST_LAGS, LINEAR_READINGS, f));
    see_all(&l, p);

    // The delay is whole periods and a part of one, in which the command before is still
    // in effect. One more command is held: a sample's readings see the command before
    // that sample's own.
    const double period = 1 / p->control.rate;
    const double delay = p->control.delay / period + p->control.delay_periods;
    const double whole = floor(delay + 1e-12), late = fmax(0, delay - whole) * period;
    const int held = (int)whole + 1;
    status code = linear_system_init(sampled, l.states + held, LINEAR_READINGS, f);
    if (code == STATUS_OK) {
        code = fill_sampled(sampled, &l.system, l.states, held, period, late, f);
    }
    linear_system_finish(&l.system);
    if (code != STATUS_OK) {
        linear_system_finish(sampled);
    }
    return code;
}
