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
#define MOST_SPEED  0.45 // at most [rad/s],
#define LEAST_SPEED 0.12 // and no less, so as to come in time [rad/s],
#define LEAST_LINKS 0.32 // nor than this with more than two links [rad/s]
// share of the effort that damping the tip may cost on a wall that gives
#define SOFT_EFFORT 0.25
// of p h over 1, below which the force does not run away with the motion
#define LEAST_MARGIN 0.05

// Modal coordinates and rates of one state over a period, under a command that gives so
// much torque each [N m]; the angle of the rotation, which nothing brings back, is left
// out where `first` is 1.
static void command_model(const controller_setup *setup, const mode_set *set, int first,
                          double torque_per_command, sampled_model *model)
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
            rate[k + i][k + j] -= setup->hub_damping * set->hub[i] * set->hub[j];
        }
        input[k + i] = set->hub[i] * torque_per_command;
    }
    sampled_model_init(model, k + n, rate, input, setup->period);
}

// Gains for which the energy of the motion, relative to the wanted rotation or to the
// rest, and an effort together are the least; `first` as of command_model.
static bool find_gain(const controller_setup *setup, const mode_set *set, int first,
                      double effort, double *gains)
{
    const int n = set->count;
    sampled_model model;
    quadratic_cost cost = {.growth = 1};
    command_model(setup, set, first, setup->torque_per_volt, &model);

    // twice the energy: of motion, and of bending
    for (int i = 0; i < n; i++) {
        double strain[ESTIMATOR_STATES] = {0}, motion[ESTIMATOR_STATES] = {0};
        motion[n - first + i] = 1;
        quadratic_cost_add(&cost, model.n, motion, 0, 1);
        if (i >= first) {
            strain[i - first] = 1;
            quadratic_cost_add(&cost, model.n, strain, 0, set->square[i]);
        }
    }
    cost.effort = effort;
    return quadratic_gain(&model, &cost, gains + first);
}

// In flight: the effort with which the rotation alone has a time constant [s]; the angle
// itself is not fed back.
static bool find_flight_gain(const observer_design *d, const controller_setup *setup,
                             double time, double *gains)
{
    const mode_set *set = &d->observer.arm.free;
    const double time_constant = set->hub[0] * setup->torque_per_volt * time;
    return find_gain(setup, set, 1, time_constant * time_constant, gains);
}

// In contact: the effort with which the first mode alone is critically damped: a'' = -w^2
// a + h K u with u = -a'/sqrt(effort) has 2 w for h K / sqrt(effort). At a wall that
// gives the tip's swinging is to be damped, too.
static bool find_press_gain(observer_design *d, const controller_setup *setup, bool gives)
{
    const mode_set *set = &d->observer.arm.contact;
    const double drive = set->hub[0] * setup->torque_per_volt;
    const double share = gives ? SOFT_EFFORT : 1;
    const double effort = share * drive * drive / (4 * set->square[0]);
    return find_gain(setup, set, 0, effort, d->press_gain);
}

// The speeds. After a touch in uniform rotation v the first mode has a' = p v. With the
// force as input it obeys a'' = s^2 (a - h L f/w^2), s^2 = w^2/(p h - 1): the force w^2
// (a + a'/s)/(h L) stops it, after a time of noticing in which it grows as exp(s t). A
// constant acceleration for one period of the free arm's first vibration leaves none
// behind.
static void find_speeds(observer_design *d, const controller_setup *setup,
                        const observer_task *task)
{
    const reduced_arm *arm = &d->observer.arm;
    const mode_set *set = &arm->contact;
    const double square = set->square[0], h = set->hub[0], p = set->momentum[0];

    // the fastest is what the approach voltage holds against friction
    double held = setup->torque_per_volt * fabs(task->approach_voltage) - setup->stiction;
    d->top_speed = fmax(0, held) / fmax(setup->hub_damping, 1e-9);
    d->touch_speed = d->top_speed;

    // the touch is slow enough to be stopped, and fast enough for a rise that begins with
    // the least force: f = 2 x - w for the stopping force x (observer_paths.h)
    d->divergence = sqrt(square / fmax(p * h - 1, LEAST_MARGIN));
    if (p * h > 1) {
        double s = d->divergence, share = (1 + OBSERVER_LEAST_FORCE) / 2;
        double stopped = task->stopping_force * h * arm->length * s / (square * p) *
                         plain_exp(-s * (setup->period + setup->delay));
        d->touch_speed = fmin(d->touch_speed, share * stopped);
    }

    // a wall that throws back is met softly; more links than two vibrate off under the
    // small force that a soft touch begins with
    if (arm->free.count > 2) {
        d->arrival_speed = fmin(d->top_speed, fmax(d->touch_speed, LEAST_LINKS));
    } else {
        d->arrival_speed = fmin(fmin(d->touch_speed, MOST_SPEED),
                                fmax(LEAST_SPEED, SOFT_SPEED * task->force));
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
    command_model(setup, &d->observer.arm.free, 0, 1, &d->flight_model);

    // the plan is made without damping
    controller_setup smooth = *setup;
    mode_set undamped = d->observer.arm.free;
    smooth.hub_damping = 0;
    memset(undamped.damping, 0, sizeof undamped.damping);
    command_model(&smooth, &undamped, 0, 1, &d->plan_model);
    find_speeds(d, setup, task);
    return NULL;
}

// --- the arms that the law holds possible ----------------------------------------------

// ratio of stiffnesses up to which an arm is one with that told of
#define AS_STIFF 1.25
#define HUB_GIVES                                                                        \
    (1.0 / 6)       // of the beam's compliance at the wall, that of a hub on a spring
#define NO_DOUBT 28 // of -2 log likelihood, 2 log(1e6),
// more of it where bounces or a wrong inertia look like the arm
#define HANDICAP 30

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
    static const double masses[] = {0.04, 0.08}; // [kg]
    static const double walls[] = {60, 150, 375,
                                   940}; // a frequency within a quarter [N/m]
    a->count = a->on = 0;
    a->thrown = false;
    const char *refusal = observer_design_init(&a->arms[a->count++], setup, task);
    if (refusal != NULL) {
        return refusal;
    }

    // beams of other numbers of links
    const double told = reduced_arm_compliance(&a->arms[0].observer.arm);
    for (size_t i = 0; i < sizeof links / sizeof links[0] && refusal == NULL; i++) {
        observer_design *d = &a->arms[a->count];
        controller_setup other = *setup;
        other.links = links[i];
        refusal = observer_design_init(d, &other, task);
        if (refusal != NULL) {
            break;
        }

        // one as stiff as that told of is none of its own
        const double ratio = reduced_arm_compliance(&d->observer.arm) / told;
        if (fmax(ratio, 1 / ratio) > AS_STIFF) {
            a->count++;
        }
    }

    // a spring k1 at the hub gives 4 k2/k1 of what a beam of two links does
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
        arm_observer_sample(&a->arms[i].observer, &a->sensors, &read, felt);
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
    const bool touches = observer_arms_observer(a)->touches;
    const int count = touches ? a->loaded : a->count;
    int best = a->on;
    double least = observer_arms_observer(a)->missed - NO_DOUBT;
    for (int i = 0; i < count; i++) {
        // walls that give and masses have to be that much better
        const bool gives = i >= a->giving && i < a->loaded;
        double missed = a->arms[i].observer.missed;
        if (i >= a->giving) {
            missed += HANDICAP;
        }
        if (missed < least && !(gives && a->thrown)) {
            best = i;
            least = missed;
        }
    }
    if (best == a->on) {
        return false;
    }
    a->on = best;
    return true;
}
