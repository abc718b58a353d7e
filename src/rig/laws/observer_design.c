#include "src/rig/laws/observer_design.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/plain_math.h"
#include "src/rig/estimation/estimator.h"

#define PI 3.14159265358979323846

// The numbers of the design, derived in docs/explanation/control-design.md.
#define TRAVEL_TIME 0.05 // in which the arm takes up a wanted speed [s],
#define LAND_TIME   0.02 // and after a bounce [s]
#define SOFT_SPEED  0.2  // of a soft touch, for every newton wanted [rad/s/N],
#define MOST_SPEED  0.45 // with two links at most [rad/s],
#define LEAST_SPEED 0.12 // and no less, so as to come in time [rad/s],
#define LEAST_LINKS 0.32 // least speed with more than two modes [rad/s]
// share of the effort that damping the tip may cost on a wall that gives
#define SOFT_EFFORT 0.25
// least excess of p h over 1 for which the divergence of the force is computed
#define LEAST_MARGIN 0.05

// Samples the equations of modal coordinates and rates, free or in contact, under a
// command whose unit gives a torque [N m]. The states are the coordinates from `first`
// on, then all rates; with `first` = 1 the angle of the free arm's rotation, on which no
// force depends, is left out.
static void command_model(double hub_damping, double period, const mode_set *set,
                          int first, double torque_per_command, sampled_model *model)
{
    const int n = set->count, k = n - first;
    double rate[ESTIMATOR_STATES][ESTIMATOR_STATES] = {{0}};
    double input[ESTIMATOR_STATES] = {0};

    // a_i'' = -w_i^2 a_i - c_i a_i' + h_i (torque - damping hub rate)
    for (int i = 0; i < n; i++) {
        if (i >= first) {
            rate[i - first][k + i] = 1;
            rate[k + i][i - first] = -set->square[i];
        }
        rate[k + i][k + i] = -set->damping[i];
        for (int j = 0; j < n; j++) {
            rate[k + i][k + j] -= hub_damping * set->hub[i] * set->hub[j];
        }
        input[k + i] = set->hub[i] * torque_per_command;
    }
    sampled_model_init(model, k + n, rate, input, period);
}

// Finds the gains whose feedback makes the least of the integral of twice the energy of
// the deviation plus effort times the squared command. `first` is that of command_model.
// False if the Riccati equation has no stabilising solution.
static bool find_gain(const controller_setup *setup, const mode_set *set, int first,
                      double effort, double *gains)
{
    const int n = set->count;
    sampled_model model;
    command_model(setup->hub_damping, setup->period, set, first, setup->torque_per_volt,
                  &model);

    // twice the energy, sum a_i'^2 + w_i^2 a_i^2: of motion, and of bending
    double weight[ESTIMATOR_STATES] = {0};
    for (int i = 0; i < n; i++) {
        weight[n - first + i] = 1;
        if (i >= first) {
            weight[i - first] = set->square[i];
        }
    }
    return quadratic_gain(&model, weight, effort, gains + first);
}

// The gains in flight, with the effort for which the rotation alone would have a time
// constant [s]: a' = h K u with u = -a'/sqrt(effort) decays in sqrt(effort)/(h K). The
// angle itself is not fed back.
static bool find_flight_gain(const observer_design *d, const controller_setup *setup,
                             double time, double *gains)
{
    const mode_set *set = &d->observer.arm.free;
    const double time_constant = set->hub[0] * setup->torque_per_volt * time;
    return find_gain(setup, set, 1, time_constant * time_constant, gains);
}

// The gains in contact, with the effort for which the first mode alone would be
// critically damped: a'' = -w^2 a + h K u with u = -a'/sqrt(effort) is, for h
// K/sqrt(effort) = 2 w. At a wall that gives, the effort is less, so that the swinging of
// the tip is damped too.
static bool find_press_gain(observer_design *d, const controller_setup *setup, bool gives)
{
    const mode_set *set = &d->observer.arm.contact;
    const double drive = set->hub[0] * setup->torque_per_volt;
    const double share = gives ? SOFT_EFFORT : 1;
    const double effort = share * drive * drive / (4 * set->square[0]);
    return find_gain(setup, set, 0, effort, d->press_gain);
}

// Computes the speeds of the approach and the length of its changes of speed. After a
// touch in uniform rotation v the first mode has a' = p v. With the
// force as input it obeys a'' = s^2 (a - h L f/w^2), s^2 = w^2/(p h - 1): the force w^2
// (a + a'/s)/(h L) stops it. Until the first command after the touch takes effect, this
// force grows as exp(s t). A constant acceleration for one period of the free arm's first
// vibration leaves none behind.
static void find_speeds(observer_design *d, const controller_setup *setup,
                        const observer_task *task)
{
    const reduced_arm *arm = &d->observer.arm;
    const mode_set *set = &arm->contact;
    const double square = set->square[0], h = set->hub[0], p = set->momentum[0];

    // the top speed is the one that the approach voltage keeps up against friction
    double held = setup->torque_per_volt * fabs(task->approach_voltage) - setup->stiction;
    d->top_speed = fmax(0, held) / fmax(setup->hub_damping, 1e-9);
    d->touch_speed = d->top_speed;

    // The touch is to be slow enough to be stopped by a force x for which the rise begins
    // with the least force: f = 2 x - w (observer_paths.h) is that share of w for x =
    // (1 + share) w/2
    d->divergence = sqrt(square / fmax(p * h - 1, LEAST_MARGIN));
    if (p * h > 1) {
        double s = d->divergence, share = (1 + OBSERVER_LEAST_FORCE) / 2;
        double stopped = task->stopping_force * h * arm->length * s / (square * p) *
                         plain_exp(-s * (setup->period + setup->delay));
        d->touch_speed = fmin(d->touch_speed, share * stopped);
    }

    // A soft touch keeps a wall from throwing the tip back; but an arm of more than two
    // modes vibrates off the wall under the small force that a soft touch begins with
    if (arm->free.count > 2) {
        d->arrival_speed = fmin(d->top_speed, fmax(d->touch_speed, LEAST_LINKS));
    } else {
        d->arrival_speed =
            fmin(d->touch_speed, fmax(LEAST_SPEED, SOFT_SPEED * task->force));
    }

    // two links are thrown back by a fast touch, behind a hub that gives, too
    if (setup->links <= 2) {
        d->arrival_speed = fmin(d->arrival_speed, MOST_SPEED);
    }

    // changes of speed take a period of the first vibration, with edges of the second's
    d->ramp_edge = 0;
    if (arm->free.count > 2) {
        d->ramp_edge = 2 * PI / sqrt(arm->free.square[2]);
    }
    d->ramp_time = 2 * PI / sqrt(arm->free.square[1]) + d->ramp_edge;
}

const char *observer_design_init(observer_design *d, const controller_setup *setup,
                                 const observer_task *task)
{
    assert(setup->torque_per_volt > 0);
    const char *refusal =
        arm_observer_init(&d->observer, setup, task->force, task->tip_mass,
                          task->wall_stiffness > 0 ? task->wall_stiffness : HUGE_VAL);
    if (refusal != NULL) {
        return refusal;
    }
    if (!find_flight_gain(d, setup, TRAVEL_TIME, d->travel_gain) ||
        !find_flight_gain(d, setup, LAND_TIME, d->land_gain) ||
        !find_press_gain(d, setup, task->wall_stiffness > 0)) {
        return "the Riccati equation of its gains has no stabilising solution";
    }

    // the plan is made without damping
    const mode_set *set = &d->observer.arm.free;
    const double no_damping[REDUCED_MODES] = {0};
    const modal_motion smooth = {set->count, set->square, no_damping, set->hub, 0};
    modal_model_init(&d->plan_model, &smooth, setup->period);
    find_speeds(d, setup, task);
    return NULL;
}

void observer_design_flight(const observer_design *d, sampled_model *model)
{
    const arm_observer *o = &d->observer;
    command_model(o->hub_damping, o->period, &o->arm.free, 0, 1, model);
}

// --- the arms that the law holds possible ----------------------------------------------

// ratio of stiffnesses up to which an arm is not told apart from the one given
#define AS_STIFF 1.25
// compliance of a hub on a spring, as a share of the beam's at the wall
#define HUB_GIVES (1.0 / 6)
// difference of -2 log likelihood that leaves no doubt, 2 log(1e6)
#define NO_DOUBT 28
// further difference for arms that bounces or a wrong inertia may look like
#define HANDICAP 30
// difference from which on an arm is followed no longer, 2 log(1e54)
#define HOPELESS 250

const observer_design *observer_arms_design(const observer_arms *a)
{
    return &a->arms[a->on];
}

const arm_observer *observer_arms_observer(const observer_arms *a)
{
    return &a->arms[a->on].observer;
}

const char *observer_arms_init(observer_arms *a, const controller_setup *setup,
                               const observer_task *task)
{
    static const int links[] = {2, 3, 6};
    static const double masses[] = {0.06}; // [kg]

    // steps that leave the frequency of any wall between within a quarter [N/m]
    static const double walls[] = {60, 150, 375, 940};

    // the arm that the setup describes
    a->count = a->on = 0;
    a->thrown = false;
    const char *refusal = observer_design_init(&a->arms[a->count++], setup, task);
    if (refusal != NULL) {
        return refusal;
    }

    // beams of other numbers of links
    const double compliance = reduced_arm_compliance(&a->arms[0].observer.arm);
    for (size_t i = 0; i < sizeof links / sizeof links[0] && refusal == NULL; i++) {
        observer_design *d = &a->arms[a->count];
        controller_setup other = *setup;
        other.links = links[i];
        refusal = observer_design_init(d, &other, task);
        if (refusal != NULL) {
            break;
        }

        // one as stiff as the arm of the setup is not kept
        const double ratio = reduced_arm_compliance(&d->observer.arm) / compliance;
        if (fmax(ratio, 1 / ratio) > AS_STIFF) {
            a->count++;
        }
    }

    // a hub on a spring k1, whose compliance is 4 k2/k1 that of a beam of two links
    controller_setup other = *setup;
    other.hub_spring = 4 * setup->k2 / HUB_GIVES;
    if (refusal == NULL && setup->hub_spring > 2 * other.hub_spring) {
        refusal = observer_design_init(&a->arms[a->count++], &other, task);
    }

    // walls that give, on which the tip swings
    a->giving = a->count;
    for (size_t i = 0; i < sizeof walls / sizeof walls[0] && refusal == NULL; i++) {
        observer_task gives = *task;
        gives.wall_stiffness = walls[i];
        refusal = observer_design_init(&a->arms[a->count++], setup, &gives);
    }

    // masses at the tip, which only a flight shows
    a->loaded = a->count;
    for (size_t i = 0; i < sizeof masses / sizeof masses[0] && refusal == NULL; i++) {
        observer_task loaded = *task;
        loaded.tip_mass = masses[i];
        refusal = observer_design_init(&a->arms[a->count++], setup, &loaded);
    }
    return refusal;
}

void observer_arms_start(observer_arms *a, const controller_input *in)
{
    hub_sensors_start(&a->sensors, in);
    for (int i = 0; i < a->count; i++) {
        arm_observer_start(&a->arms[i].observer, in);
    }
}

void observer_arms_know_wall(observer_arms *a, double angle)
{
    for (int i = 0; i < a->count; i++) {
        arm_observer_know_wall(&a->arms[i].observer, angle);
    }
}

void observer_arms_sample(observer_arms *a, const controller_input *in, int felt)
{
    const controller_input read =
        hub_sensors_read(&a->sensors, in, a->arms[0].observer.period);
    for (int i = 0; i < a->count; i++) {
        arm_observer *o = &a->arms[i].observer;
        if (o->missed < HUGE_VAL) {
            arm_observer_sample(o, &a->sensors, &read, felt);
        }
    }
}

void observer_arms_touch(observer_arms *a, double time)
{
    for (int i = 0; i < a->count; i++) {
        arm_observer_touch(&a->arms[i].observer, time);
    }
}

void observer_arms_leave(observer_arms *a, double time)
{
    a->thrown = true;
    for (int i = 0; i < a->count; i++) {
        arm_observer_leave(&a->arms[i].observer, time);
    }
}

bool observer_arms_choose(observer_arms *a)
{
    // a contact does not show a mass at the tip
    const bool touches = observer_arms_observer(a)->touches;
    const int count = touches ? a->loaded : a->count;

    // another arm has to explain the readings better than the present one by NO_DOUBT
    const double present = observer_arms_observer(a)->missed;
    int best = a->on;
    double least = present - NO_DOUBT;
    for (int i = 0; i < count; i++) {
        // one that explains them far worse is out of the question, and so is a wall that
        // gives once the tip has left it
        const bool gives = i >= a->giving && i < a->loaded;
        double *missed = &a->arms[i].observer.missed;
        if (*missed > present + HOPELESS || (gives && a->thrown && i != a->on)) {
            *missed = HUGE_VAL;
        }

        // walls that give and masses at the tip have to be better still
        const double handicap = i >= a->giving ? HANDICAP : 0;
        if (*missed + handicap < least) {
            best = i;
            least = *missed + handicap;
        }
    }

    if (best == a->on) {
        return false;
    }
    a->on = best;
    return true;
}
