#include "src/rig/estimation/arm_observer.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/fault.h"
#include "src/base/plain_math.h"

enum { N = ESTIMATOR_STATES };
_Static_assert(2 * REDUCED_MODES + 2 <= ESTIMATOR_STATES,
               "the states of all modes have room");
_Static_assert((int)REDUCED_MODES <= (int)MODAL_MOST, "a model has room for all modes");

// Standard deviations of the readings and of what the models leave out.
#define FORCE_NOISE  0.02 // of the force sensor [N]
#define FORCE_SHARE  0.02 // of the force sensor, as a share of the reading
#define ACCELERATION 1.0  // of the accelerometer [rad/s2]
#define TORQUE_DRIFT 0.1  // of the unknown torque, in a second, in flight [N m],
#define TORQUE_STAYS 0.05 // and in contact, where a wall that yields looks like one [N m]
#define WALL_DRIFT   1e-3 // of the wall, in a second [rad]
#define STIFFNESS    0.25 // share by which the stiffness may be wrong
// degrees of freedom of Student's distribution of the prediction errors
#define TAILS        4.0
#define STIFF_MEMORY 0.5  // over which readings count for the stiffness [s],
#define STIFF_GUESS  0.15 // time of pressing with 1 N that the nominal one counts as [s]
#define LEAST_STIFF  0.2  // least stiffness that is taken for true, over the nominal one
#define OUTLIER      4.0  // standard deviations from which on a reading counts for less
#define TIP_IMPULSE  0.03 // of the wall on the tip that no sensor sees [N s]
#define YOUNG        0.1  // a contact after less time may still throw the tip back [s]
#define REST         0.01 // a slower hub counts as at rest [rad/s]

// The modes of the present state: in contact or in flight.
static const mode_set *modes_of(const arm_observer *o)
{
    if (o->touches) {
        return &o->arm.contact;
    }
    return &o->arm.free;
}

static int count_of(const arm_observer *o)
{
    return modes_of(o)->count;
}

int arm_observer_torque_index(const arm_observer *o)
{
    // behind coordinates and rates, and in contact the wall's angle
    if (o->touches) {
        return 2 * o->arm.contact.count + 1;
    }
    return 2 * o->arm.free.count;
}

static int wall_index(const arm_observer *o)
{
    return 2 * o->arm.contact.count;
}

static int state_count(const arm_observer *o)
{
    return arm_observer_torque_index(o) + 1;
}

double arm_observer_square(const arm_observer *o, int i)
{
    if (o->touches && i == 0) {
        return modes_of(o)->square[i] * o->stiffness;
    }
    return modes_of(o)->square[i];
}

// start + a'b for vectors of n entries.
static double add_products(double start, int n, const double *a, const double *b)
{
    for (int i = 0; i < n; i++) {
        start += a[i] * b[i];
    }
    return start;
}

// --- the model -------------------------------------------------------------------------

// Samples the equations of the modes over a time h [s]:
//
//     a_i'' = -w_i^2 a_i - c_i a_i' + h_i (drive + unknown torque - damping hub rate)
static void sample_model(const arm_observer *o, const mode_set *set, double h,
                         modal_model *model)
{
    const modal_motion of = {set->count, set->square, set->damping, set->hub,
                             o->hub_damping};
    modal_model_init(model, &of, h);
}

const char *arm_observer_init(arm_observer *o, const controller_setup *setup,
                              double force, double tip_mass, double wall_stiffness)
{
    memset(o, 0, sizeof *o);
    const char *refusal = reduced_arm_init(&o->arm, setup, tip_mass, wall_stiffness);
    if (refusal != NULL) {
        return refusal;
    }

    // A command takes effect a delay after its sample: one model for the part of a period
    // before that, one for the part after it
    o->torque_per_volt = setup->torque_per_volt;
    o->hub_damping = setup->hub_damping;
    o->stiction = setup->stiction;
    o->period = setup->period;
    o->delay = fmin(setup->delay, setup->period);
    o->stiff_nominal = STIFF_GUESS / fmax(1, force) * force * force;
    for (int k = 0; k < 2; k++) {
        double h = k == 0 ? o->delay : o->period - o->delay;
        sample_model(o, &o->arm.free, h, &o->free_model[k]);
        sample_model(o, &o->arm.contact, h, &o->contact_model[k]);
    }
    return NULL;
}

void arm_observer_start(arm_observer *o, const controller_input *in)
{
    // rotation of all bodies: a_i = p_i angle
    const mode_set *set = &o->arm.free;
    memset(&o->e, 0, sizeof o->e);
    for (int i = 0; i < set->count; i++) {
        o->e.z[i] = set->momentum[i] * in->encoder;
        o->e.p[i][i] = HUB_ANGLE_NOISE * HUB_ANGLE_NOISE * o->arm.inertia;
        o->e.p[set->count + i][set->count + i] = 1e-6;
    }

    // the unknown torque may be as large as friction; of the wall nothing is known
    int torque = 2 * set->count;
    o->e.p[torque][torque] = o->stiction * o->stiction;
    o->touches = false;
    o->since = in->time;
    o->wall_variance = HUGE_VAL;
    o->missed = 0;
    o->stiffness = 1;
    o->stiff_force = o->stiff_bend = 0;
    o->last_voltage = in->voltage;
    o->tip_before = o->tip_now = in->encoder;
}

void arm_observer_know_wall(arm_observer *o, double angle)
{
    assert(!o->touches && isfinite(angle));
    o->wall = angle;
    o->wall_variance = 0;
}

// --- what an estimate says -------------------------------------------------------------

// An angle of an estimate, the sum of the modes' coordinates times their shapes [rad]. In
// contact the modes give the angle from the wall's angle on.
static double angle_of(const arm_observer *o, const estimator *e, const double *shape)
{
    return add_products(o->touches ? e->z[wall_index(o)] : 0, count_of(o), shape, e->z);
}

double arm_observer_tip(const arm_observer *o, const estimator *e)
{
    return angle_of(o, e, modes_of(o)->tip);
}

double arm_observer_rate(const arm_observer *o, const estimator *e)
{
    const mode_set *set = modes_of(o);
    return add_products(0, set->count, set->hub, e->z + set->count);
}

// Acceleration of the hub for a torque on it, sum h_i^2 [1/(kg m2)].
static double hub_mobility(const mode_set *set)
{
    return add_products(0, set->count, set->hub, set->hub);
}

// Torque on the hub under which it keeps its velocity, so that sum h_i a_i'' = 0 [N m]:
//
//     sum h_i (w_i^2 a_i + c_i a_i') / sum h_i^2
static double balancing_torque(const arm_observer *o, const estimator *e)
{
    const mode_set *set = modes_of(o);
    double sum = 0;
    for (int i = 0; i < set->count; i++) {
        sum += set->hub[i] * (arm_observer_square(o, i) * e->z[i] +
                              set->damping[i] * e->z[set->count + i]);
    }
    return sum / hub_mobility(set);
}

double arm_observer_holding_torque(const arm_observer *o, const estimator *e)
{
    return balancing_torque(o, e) - e->z[arm_observer_torque_index(o)];
}

// Friction on the hub under a motor torque [N m]. It opposes a hub that moves; on a hub
// at rest it is, within its limit, the torque that stops the hub within a period.
static double friction_under(const arm_observer *o, const estimator *e, double drive)
{
    double rate = arm_observer_rate(o, e), limit = o->stiction;
    if (fabs(rate) > REST) {
        return copysign(limit, rate);
    }

    // what balances the other torques, and what takes the rest of the rate away
    double net = drive + e->z[arm_observer_torque_index(o)] - o->hub_damping * rate -
                 balancing_torque(o, e);
    double stop = rate / (hub_mobility(modes_of(o)) * o->period);
    return fmax(-limit, fmin(net + stop, limit));
}

double arm_observer_force_per_torque(const arm_observer *o)
{
    const mode_set *set = &o->arm.contact;
    double share = 1;
    for (int i = 0; i < set->count; i++) {
        share -= set->momentum[i] * set->hub[i];
    }
    return share / o->arm.length;
}

// The row by which the contact force depends on the state, by L f = T - sum p_i a_i''
// (reduced_arm.h) with the modes' equations for a_i''. Drive and friction add their part
// at once, arm_observer_force_per_torque each.
static void force_row(const arm_observer *o, double *row)
{
    const mode_set *set = &o->arm.contact;
    const int n = set->count;
    double at_once = arm_observer_force_per_torque(o), length = o->arm.length;
    memset(row, 0, N * sizeof *row);
    for (int i = 0; i < n; i++) {
        row[i] = set->momentum[i] * arm_observer_square(o, i) / length;
        row[n + i] = set->momentum[i] * set->damping[i] / length -
                     at_once * o->hub_damping * set->hub[i];
    }
    row[arm_observer_torque_index(o)] = at_once;
}

double arm_observer_force(const arm_observer *o, const estimator *e, double drive)
{
    double row[N];
    force_row(o, row);
    double force =
        arm_observer_force_per_torque(o) * (drive - friction_under(o, e, drive));
    return add_products(force, state_count(o), row, e->z);
}

// --- one sample ------------------------------------------------------------------------

// Variances that the states gain over a time h [s] by what the model leaves out: torques
// on the hub that change from sample to sample, and the drift of the unknown torque and
// of the wall.
static void process_noise(const arm_observer *o, const estimator *e, double h,
                          double noise[N])
{
    const mode_set *set = modes_of(o);
    const int n = set->count;
    const double share = h / o->period;

    // torques that change from sample to sample change the rates
    for (int i = 0; i < n; i++) {
        const double rate_change = set->hub[i] * ARM_OBSERVER_TORQUE_NOISE * o->period;
        noise[n + i] = share * rate_change * rate_change;
    }

    // the unknown torque drifts
    const double drift = o->touches ? TORQUE_STAYS : TORQUE_DRIFT;
    noise[arm_observer_torque_index(o)] = drift * drift * h;

    // a wrong nominal stiffness shows as a wall that moves with the hub
    if (o->touches) {
        const double bend = angle_of(o, e, set->hub) - e->z[wall_index(o)];
        const double wandering =
            2 * STIFFNESS * STIFFNESS * fabs(bend * arm_observer_rate(o, e));
        noise[wall_index(o)] = (WALL_DRIFT * WALL_DRIFT + wandering) * h;
    }
}

// Moves an estimate on by a time h [s] under a command that is in effect [V].
static void predict_state(const arm_observer *o, estimator *e, const modal_model *model,
                          double h, double voltage)
{
    const double drive = o->torque_per_volt * voltage;
    double noise[N] = {0};
    process_noise(o, e, h, noise);

    const double net = drive - friction_under(o, e, drive);
    const int n = state_count(o);
    if (!o->touches) {
        estimator_predict(e, n, model, net, noise);
        return;
    }

    // The first mode's stiffness differs from the nominal one by (stiffness - 1) w^2. Its
    // force on the coordinate at the beginning, held over h, changes the rate by that
    // times h and the coordinate by that times h^2/2.
    modal_model corrected = *model;
    const double rate_change = (o->stiffness - 1) * o->arm.contact.square[0] * h;
    corrected.keep[0][1][0] -= rate_change;
    corrected.keep[0][0][0] -= rate_change * h / 2;
    estimator_predict(e, n, &corrected, net, noise);
}

// Takes a reading of row z + offset with a standard deviation into the estimate, and adds
// its prediction error to the misfit. A reading far from its expectation counts for less,
// since an impact is no noise. Returns its weight, at most 1.
static double take_reading(arm_observer *o, const double *row, double offset,
                           double reading, double deviation)
{
    const int n = state_count(o);

    // the prediction error in standard deviations of estimate and reading together
    const estimator_view view = estimator_look(&o->e, n, row, offset);
    const double miss = reading - view.expected;
    const double distance = fabs(miss) / sqrt(deviation * deviation + view.variance);

    // -2 log likelihood by Student's distribution; the estimate's own variance is left
    // out, as a model is no better for claiming less of it
    if (o->moves) {
        const double error = miss / deviation;
        o->missed += (TAILS + 1) * plain_log(1 + error * error / TAILS);
    }

    // beyond the limit the weight falls with the distance
    const double doubt = distance > OUTLIER ? distance / OUTLIER : 1;
    estimator_correct(&o->e, n, &view, reading, deviation * deviation * doubt * doubt);
    return 1 / doubt;
}

// Takes in the reading of the accelerometer. It shows the hub's acceleration,
//
//     sum h_i a_i'',    a_i'' = -w_i^2 a_i - c_i a_i' + h_i T,
//
// a row times the state and, of drive and friction in T, an offset.
static void take_acceleration(arm_observer *o, const controller_input *in)
{
    const mode_set *set = modes_of(o);
    const int n = set->count;
    const double mobility = hub_mobility(set), drive = o->torque_per_volt * in->voltage;

    double row[N] = {0};
    for (int i = 0; i < n; i++) {
        row[i] = -set->hub[i] * arm_observer_square(o, i);
        row[n + i] =
            -set->hub[i] * set->damping[i] - mobility * o->hub_damping * set->hub[i];
    }
    row[arm_observer_torque_index(o)] = mobility;
    const double offset = mobility * (drive - friction_under(o, &o->e, drive));
    take_reading(o, row, offset, in->accelerometer, ACCELERATION);
}

// Takes in the readings of the motion: of encoder and tachometer, and of an accelerometer
// where one is fitted.
static void take_motion(arm_observer *o, const hub_sensors *s, const controller_input *in)
{
    const mode_set *set = modes_of(o);
    const int n = set->count;
    double angle[N] = {0}, rate[N] = {0};
    for (int i = 0; i < n; i++) {
        angle[i] = rate[n + i] = set->hub[i];
    }

    // in contact the modes are seen from the wall
    if (o->touches) {
        angle[wall_index(o)] = 1;
    }
    take_reading(o, angle, 0, in->encoder, s->angle_deviation);
    take_reading(o, rate, 0, in->tachometer, sqrt(s->rate_variance));
    if (!isnan(in->accelerometer)) {
        take_acceleration(o, in);
    }
}

double arm_observer_force_noise(double force)
{
    return FORCE_NOISE + FORCE_SHARE * fabs(force);
}

// Takes in the reading of the force sensor; returns the weight of take_reading. Its row
// is that of the force, its offset what the estimated force has beyond row times state.
static double take_force(arm_observer *o, const controller_input *in)
{
    double row[N], drive = o->torque_per_volt * in->voltage;
    force_row(o, row);
    const double linear = add_products(0, state_count(o), row, o->e.z);
    double offset = arm_observer_force(o, &o->e, drive) - linear;
    return take_reading(o, row, offset, in->force, arm_observer_force_noise(in->force));
}

// Learns how stiff the arm is in contact, over its nominal stiffness, from a reading of
// the force with a weight. It is the least squares solution of read = stiffness nominal,
//
//     stiffness = (sum nominal read + guess)/(sum nominal^2 + guess),
//
// where `nominal` is the first mode's force at the nominal stiffness, by the encoder, and
// `read` the reading less the forces of the other modes and of the motion. The guess
// draws the quotient towards 1 like pressing with the wanted force for a time
// STIFF_GUESS, which is long enough for vibrations that the model does not show to
// cancel; above 1 N, where noise and friction weigh less, for as much less as the force
// is more.
static void learn_stiffness(arm_observer *o, const controller_input *in,
                            double reading_weight)
{
    const mode_set *set = &o->arm.contact;
    const double per_mode = set->momentum[0] * set->square[0] / o->arm.length;

    // the nominal force, by the hub's angle since the touch without the other modes'
    double bend = in->encoder - o->met;
    for (int i = 1; i < set->count; i++) {
        bend -= set->hub[i] * o->e.z[i];
    }
    const double nominal = per_mode * bend / set->hub[0];

    // the reading of it, without the other modes and the motion
    const double drive = o->torque_per_volt * in->voltage;
    const double others =
        arm_observer_force(o, &o->e, drive) - per_mode * o->stiffness * o->e.z[0];
    const double read = in->force - others;

    // both sums, in which old readings fade, and their quotient
    const double kept = 1 - fmin(1, o->period / STIFF_MEMORY);
    const double weight = o->period * reading_weight * reading_weight;
    o->stiff_force = kept * o->stiff_force + weight * nominal * read;
    o->stiff_bend = kept * o->stiff_bend + weight * nominal * nominal;
    const double stiffness = (o->stiff_force + o->stiff_nominal) /
                             fmax(o->stiff_bend + o->stiff_nominal, 1e-12);
    o->stiffness = fmax(LEAST_STIFF, stiffness);
}

// Adds to an estimate in flight the variance of an impulse at the tip that no sensor saw:
// an impulse changes the rate of mode i by the length of the arm times tip_i for each N
// s.
static void doubt_tip(const arm_observer *o, estimator *e)
{
    const mode_set *free = &o->arm.free;
    const int n = free->count;
    const double angular_impulse = o->arm.length * TIP_IMPULSE;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            e->p[n + i][n + j] +=
                angular_impulse * angular_impulse * free->tip[i] * free->tip[j];
        }
    }
}

// Whether the tip was struck: the tachometer's reading differs from the rate of the
// estimate in flight by more than OUTLIER standard deviations.
static bool struck(const arm_observer *o, const hub_sensors *s,
                   const controller_input *in)
{
    const mode_set *free = &o->arm.free;
    double rate[N] = {0};
    memcpy(rate + free->count, free->hub, (size_t)free->count * sizeof *rate);
    const estimator_view view = estimator_look(&o->e, state_count(o), rate, 0);
    const double error = in->tachometer - view.expected;
    return error * error > OUTLIER * OUTLIER * (view.variance + s->rate_variance);
}

// Moves the estimate from the sample before to this one, first under the old command,
// then under the present one, and takes in the readings of the motion.
static void follow_motion(arm_observer *o, const hub_sensors *s,
                          const controller_input *in)
{
    const modal_model *models = o->touches ? o->contact_model : o->free_model;
    if (o->delay > 0) {
        predict_state(o, &o->e, &models[0], o->delay, o->last_voltage);
    }
    if (o->delay < o->period) {
        predict_state(o, &o->e, &models[1], o->period - o->delay, in->voltage);
    }
    if (!o->touches && struck(o, s, in)) {
        doubt_tip(o, &o->e);
    }
    take_motion(o, s, in);
}

// Follows the motion for the second estimate, `flown`, that of a tip which the wall has
// thrown back. The observer becomes one in flight meanwhile; estimate and misfit of the
// tip that stays are put back afterwards.
static void follow_flight(arm_observer *o, const hub_sensors *s,
                          const controller_input *in, int felt)
{
    const estimator in_contact = o->e;
    const double missed = o->missed;
    o->e = o->flown;
    o->touches = false;

    // a reading of force without contact is an impulse at the tip
    follow_motion(o, s, in);
    if (felt > 0) {
        doubt_tip(o, &o->e);
    }

    o->flown = o->e;
    o->e = in_contact;
    o->missed = missed;
    o->touches = true;
    o->young = in->time - o->since < YOUNG;
}

void arm_observer_sample(arm_observer *o, const hub_sensors *s,
                         const controller_input *in, int felt)
{
    // the motion, in both estimates while the tip may still be thrown back
    o->moves = s->moves;
    if (o->touches && o->young) {
        follow_flight(o, s, in, felt);
    }
    follow_motion(o, s, in);
    o->last_voltage = in->voltage;

    // the first reading of a contact shows its impulse
    if (o->touches && felt > 1) {
        learn_stiffness(o, in, take_force(o, in));
    }

    // where the wall is, and in flight between which angles the next touch will be
    if (o->touches) {
        o->wall = o->e.z[wall_index(o)];
        o->wall_variance = o->e.p[wall_index(o)][wall_index(o)];
    }
    o->tip_before = o->tip_now;
    o->tip_now = arm_observer_tip(o, &o->e);
}

estimator arm_observer_ahead(const arm_observer *o, double voltage)
{
    estimator ahead = o->e;
    if (o->delay > 0) {
        predict_state(o, &ahead, o->touches ? &o->contact_model[0] : &o->free_model[0],
                      o->delay, voltage);
    }
    return ahead;
}

bool arm_observer_returns(const arm_observer *o)
{
    const mode_set *free = &o->arm.free;
    return o->touches && o->young &&
           add_products(0, free->count, free->tip, o->flown.z + free->count) > 0;
}

// --- touch and flight ------------------------------------------------------------------

// The wall's angle at a touch, and its variance [rad], [rad2]. The tip met the wall
// anywhere between its last two angles, a uniform distribution: its mean is their middle,
// its variance the square of their distance over 12. A wall that was known before is the
// mean of that and of the known angle, each weighted with the other's variance.
static double wall_at_touch(const arm_observer *o, double *variance)
{
    const double distance = o->tip_now - o->tip_before;
    const double middle = (o->tip_now + o->tip_before) / 2;
    *variance = distance * distance / 12 + 1e-6;
    if (!(o->wall_variance < HUGE_VAL)) {
        return middle;
    }
    const double known = o->wall_variance + 1e-6, seen = *variance;
    *variance = known * seen / (known + seen);
    return (middle * known + o->wall * seen) / (known + seen);
}

void arm_observer_touch(arm_observer *o, double time)
{
    assert(!o->touches);
    const mode_set *contact = &o->arm.contact;
    const int m = contact->count, n = o->arm.free.count, wall = 2 * m;
    double variance;
    o->met = wall_at_touch(o, &variance);

    // a second estimate, of a tip that is thrown back, goes on in flight
    o->flown = o->e;
    o->young = true;
    doubt_tip(o, &o->flown);

    // a_contact = X a_free, and the rates as well (reduced_arm.h); the unknown torque
    // stays
    double t[N][N] = {{0}};
    for (int i = 0; i < m; i++) {
        for (int j = 0; j < n; j++) {
            t[i][j] = t[m + i][n + j] = o->arm.touch[i][j];
        }
    }
    t[wall + 1][2 * n] = 1;
    estimator_transform(&o->e, 2 * n + 1, 2 * m + 2, t);

    // The coordinates count from the wall, a - p theta_wall, and share its variance; the
    // impulse leaves the rates in some doubt
    o->e.z[wall] = o->met;
    o->e.p[wall][wall] = variance;
    for (int i = 0; i < m; i++) {
        o->e.z[i] -= contact->momentum[i] * o->met;
        o->e.p[wall][i] = o->e.p[i][wall] = -contact->momentum[i] * variance;
        for (int j = 0; j < m; j++) {
            o->e.p[i][j] += contact->momentum[i] * contact->momentum[j] * variance;
        }
        const double rate_change =
            contact->hub[i] * ARM_OBSERVER_TORQUE_NOISE * o->period;
        o->e.p[m + i][m + i] += rate_change * rate_change;
    }
    o->touches = true;
    o->since = time;
}

void arm_observer_leave(arm_observer *o, double time)
{
    assert(o->touches);
    const mode_set *free = &o->arm.free;
    const int m = o->arm.contact.count, n = free->count, wall = 2 * m;

    if (o->young) {
        // the tip may not have stayed in a young contact: the second estimate is the one
        o->e = o->flown;
    } else {
        // a_free = X'a_contact + p_free theta_wall (reduced_arm.h), and the rates
        double t[N][N] = {{0}};
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < m; j++) {
                t[i][j] = t[n + i][m + j] = o->arm.touch[j][i];
            }
            t[i][wall] = free->momentum[i];
        }
        t[2 * n][wall + 1] = 1;
        estimator_transform(&o->e, 2 * m + 2, 2 * n + 1, t);
        doubt_tip(o, &o->e);
    }
    o->touches = false;
    o->since = time;
    o->tip_before = o->tip_now = o->wall;
}
