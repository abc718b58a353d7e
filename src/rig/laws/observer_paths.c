#include "src/rig/laws/observer_paths.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "src/base/plain_math.h"

// --- an approach that leaves no vibration ----------------------------------------------

// Share of speeding up after which slowing down may begin: early where the touch is fast,
// with a brisk start, which shows the law which arm it is on; late where it is slow, as
// the angle by which an early plan falls short of the wall is made at that speed.
#define EARLY      0.3
#define LATE       0.7
#define LATE_SPEED 0.085 // that share times the speed of the touch, of two links [rad/s]
// largest speed of the way: of a faster one a wrong model leaves vibration [rad/s]
#define CRUISE 1.2

// Puts the plan at a uniform rotation without vibration, before both ramps. In a uniform
// rotation at a speed v [rad/s] each mode has the rate v momentum_i and no deflection.
static void start_at_speed(smooth_approach *p, const observer_design *d, double speed)
{
    const mode_set *set = &d->observer.arm.free;
    memset(p->state, 0, sizeof p->state);
    for (int i = 0; i < set->count; i++) {
        p->state[set->count + i] = set->momentum[i] * speed;
    }
    p->start_speed = speed;
    p->ramp[SPEED_UP].elapsed = p->ramp[SLOW_DOWN].elapsed = 0;
}

double smooth_approach_speed(const smooth_approach *p, const observer_design *d)
{
    // the first mode of the free arm is its rotation
    const mode_set *set = &d->observer.arm.free;
    return p->state[set->count] / set->momentum[0];
}

// Share of a ramp that is made a time t after its beginning. The acceleration is a
// trapezoid of length T that rises over an edge e, stays at 1/(T - e) and falls over e;
// the share is its integral:
//
//     t^2/(2 e (T - e)),    (t - e/2)/(T - e),    1 - (T - t)^2/(2 e (T - e))
static double ramp_share(const observer_design *d, double t)
{
    const double T = d->ramp_time, edge = d->ramp_edge, top = 1 / (T - edge);
    t = fmax(0, fmin(t, T));
    if (t < edge) {
        return top * t * t / (2 * edge);
    }
    double left = T - t;
    if (left < edge) {
        return 1 - top * left * left / (2 * edge);
    }
    return top * (t - edge / 2);
}

double smooth_approach_follow(smooth_approach *p, const observer_design *d)
{
    // the change of speed that the ramps under way make in this period
    const int ramps = p->slows ? SLOW_DOWN + 1 : SPEED_UP + 1;
    double torque = 0;
    for (int i = 0; i < ramps; i++) {
        speed_ramp *ramp = &p->ramp[i];
        double share_before = ramp_share(d, ramp->elapsed);
        ramp->elapsed += p->period;
        torque += (ramp_share(d, ramp->elapsed) - share_before) * ramp->change;
    }

    // the mean torque that this takes, and the arm's motion under it
    torque *= d->observer.arm.inertia / p->period;
    modal_model_step(&d->plan_model, p->state, torque);
    return torque;
}

// How far the tip overshoots its final angle, at most, while the rotation is slowed down
// by 1 rad/s: the beam bends on when the hub stops. The result is in rad for each rad/s,
// which is [s]. It is found by planning such a stop.
static double tip_overshoot(const smooth_approach *p, const observer_design *d)
{
    const mode_set *set = &d->observer.arm.free;
    smooth_approach stop = {.period = p->period, .ramp[SPEED_UP].change = -1};
    double greatest = -HUGE_VAL, tip = 0;
    start_at_speed(&stop, d, 1);
    while (stop.ramp[SPEED_UP].elapsed < d->ramp_time) {
        smooth_approach_follow(&stop, d);
        tip = 0;
        for (int i = 0; i < set->count; i++) {
            tip += set->tip[i] * stop.state[i];
        }
        greatest = fmax(greatest, tip);
    }
    return greatest - tip;
}

void smooth_approach_begin(smooth_approach *p, const observer_design *d, double angle)
{
    assert(p->period > 0);
    const double T = d->ramp_time, soft = d->arrival_speed;
    const double overshoot = tip_overshoot(p, d); // for each rad/s of slowing down [s]

    // how early slowing down may begin
    if (!(p->overlap > 0)) {
        p->overlap = LATE;
        if (d->observer.arm.free.count == 2) {
            p->overlap = fmax(EARLY, fmin(LATE_SPEED / soft, LATE));
        }
    }

    // The cruising speed v for which slowing down, begun as early as it may, ends with
    // the tip's overshoot at the wall's nearest angle. With the overlap o the angle from
    // here to there is
    //
    //     v o T + soft T/2 + (v - soft) overshoot
    const double room = p->wall_nearest - angle - soft * (T / 2 - overshoot);
    const double cruise =
        fmax(soft, fmin(fmin(d->top_speed, CRUISE), room / (p->overlap * T + overshoot)));

    // and the plan for it, at rest
    p->start_angle = angle;
    p->ramp[SPEED_UP].change = cruise;
    p->ramp[SLOW_DOWN].change = 0;
    p->overshoot = overshoot * (cruise - soft);
    p->slows = !(cruise > soft);
    start_at_speed(p, d, 0);
}

// Angle by which the rotation goes on until it has slowed down, if slowing down begins at
// once [rad]. Over the length T of a ramp its speed is cruise times the share of speeding
// up that is made, plus (soft - cruise) times that of slowing down. With uniform ramps,
// and u the time that speeding up still takes, the integral of that is
//
//     cruise (T - u^2/(2 T)) + (soft - cruise) T/2
static double slowing_angle(const smooth_approach *p, const observer_design *d)
{
    const double T = d->ramp_time, soft = d->arrival_speed;
    const double cruise = p->ramp[SPEED_UP].change;
    const double u = fmax(0, T - p->ramp[SPEED_UP].elapsed);
    return cruise * (T - u * u / (2 * T)) + (soft - cruise) * T / 2;
}

void smooth_approach_advance(smooth_approach *p, const observer_design *d, double tip,
                             double rotation)
{
    const double T = d->ramp_time, soft = d->arrival_speed;
    speed_ramp *speed_up = &p->ramp[SPEED_UP], *slow_down = &p->ramp[SLOW_DOWN];

    // Cruising: slow down as soon as the angle left takes it. Where slowing down begins
    // early, speeding up still bends the beam back, and the tip's angle would mislead.
    if (!p->slows && speed_up->elapsed >= p->overlap * T) {
        const double angle = p->overlap < LATE ? rotation : tip;
        if (p->wall_nearest - p->overshoot - angle <= slowing_angle(p, d)) {
            p->slows = true;
            slow_down->change = soft - speed_up->change;
        }
        return;
    }

    // Slowed down: search for a wall that is further than it probably is
    if (p->slows && !p->searches && tip > p->wall_furthest && slow_down->elapsed >= T) {
        p->searches = true;
        p->start_speed = soft;
        speed_up->change = d->touch_speed - soft;
        slow_down->change = 0;
        speed_up->elapsed = slow_down->elapsed = 0;
    }
}

void smooth_approach_restart(smooth_approach *p, const observer_design *d)
{
    // how far the ramps are; slowing down began at speed_up - slow_down
    const double speed_up = p->ramp[SPEED_UP].elapsed;
    const double slow_down = p->ramp[SLOW_DOWN].elapsed;
    const bool slows = p->slows;

    // the plan of the other design, from its beginning to where the ramps are
    if (!slows) {
        smooth_approach_begin(p, d, p->start_angle);
    }
    start_at_speed(p, d, p->start_speed);
    while (p->ramp[SPEED_UP].elapsed < speed_up) {
        const double half_period = p->period / 2; // equal times may differ by rounding
        p->slows =
            slows && p->ramp[SPEED_UP].elapsed > speed_up - slow_down - half_period;
        smooth_approach_follow(p, d);
    }
    p->slows = slows;
}

// --- the quickest touch ----------------------------------------------------------------

enum {
    MOST_DELAY = 2,    // periods by which a later plan may miss the planned touch
    FIXED_PERIODS = 1, // last ones, not planned again: two equations need two torques
    NEWTON_STEPS = 30, // of Newton's method at most,
    STEP_HALVINGS = 8  // and lengths of each step that are tried
};
#define RESERVE 0.2 // share of the torque that the first plan keeps
// error of an equation that is allowed, as a share of what all torques can do
#define TOLERANCE 1e-6
// share of the unbounded problem's Hessian that is added to the Hessian
#define REGULARISATION 1e-6

// A linear function of the state z of the free arm.
static double row_times_state(const quickest_touch *q, const double *row, const double *z)
{
    double sum = 0;
    for (int i = 0; i < q->flight.n; i++) {
        sum += row[i] * z[i];
    }
    return sum;
}

void quickest_touch_init(quickest_touch *q, const observer_design *d)
{
    const reduced_arm *arm = &d->observer.arm;
    const mode_set *set = &arm->free, *contact = &arm->contact;
    const int n = set->count;
    memset(q, 0, sizeof *q);
    observer_design_flight(d, &q->flight);

    // the rows of the tip's angle and of F: a is the first mode in contact after the
    // touch, and scale its w^2/(h L)
    const double scale = contact->square[0] / (contact->hub[0] * arm->length);
    for (int i = 0; i < n; i++) {
        q->tip[i] = set->tip[i];
        q->force[i] = scale * arm->touch[0][i];
        q->force[n + i] = q->force[i] / d->divergence;
    }
    q->force_per_wall = -scale * contact->momentum[0];

    // the response of both to a torque of 1 N m in the first period, k periods later
    double z[ESTIMATOR_STATES] = {0};
    for (int k = 0; k < QUICKEST_PERIODS; k++) {
        sampled_model_step(&q->flight, z, k == 0 ? 1 : 0);
        q->tip_gain[k] = row_times_state(q, q->tip, z);
        q->force_gain[k] = row_times_state(q, q->force, z);
    }
}

// --- torques for both equations --------------------------------------------------------

// Of all torques of n periods within the limits that add given amounts to the tip's angle
// and to F, those with the least sum of squares are
//
//     T_k = clip(x tip_gain_k + y force_gain_k),
//
// where x and y are the Lagrange multipliers of the two equations.
typedef struct two_equations {
    int n;
    double tip, force; // to be added [rad], [N]
    double most;       // torque, either way [N m]
    double x, y;       // multipliers
} two_equations;

// The dual function of that problem at one x and y, negated, so that the multipliers are
// its minimum. It is convex, and quadratic as long as the same torques are at a bound:
//
//     sum over k of (T_k (x tip_gain_k + y force_gain_k) - T_k^2/2) - x tip - y force
//
// Its slope is the error of both equations.
typedef struct dual {
    double value, slope[2], bend[3]; // bend: second derivatives xx, xy, yy
} dual;

// Torque k periods before the last one, by the multipliers and within the limits [N m].
static double torque_at(const quickest_touch *q, const two_equations *e, int k)
{
    double unbounded = e->x * q->tip_gain[k] + e->y * q->force_gain[k];
    return fmax(-e->most, fmin(unbounded, e->most));
}

// The dual function, its slope and its second derivatives at the present multipliers.

static dual dual_at(const quickest_touch *q, const two_equations *e)
{
    dual d = {.value = -e->x * e->tip - e->y * e->force, .slope = {-e->tip, -e->force}};
    for (int k = 0; k < e->n; k++) {
        const double a = q->tip_gain[k], b = q->force_gain[k];
        const double torque = torque_at(q, e, k);
        d.value += torque * (e->x * a + e->y * b - torque / 2);
        d.slope[0] += torque * a;
        d.slope[1] += torque * b;

        // a torque at its bound does not change with the multipliers
        if (fabs(torque) < e->most) {
            d.bend[0] += a * a;
            d.bend[1] += a * b;
            d.bend[2] += b * b;
        }
    }
    return d;
}

// Moves the multipliers along a step (dx, dy) from where the dual function is `start`,
// and returns the dual function at their new values. The step is halved until it lowers
// the function by at least a tenth of what the slope promises (Armijo's rule), down to a
// 128th of its length.
static dual take_step(const quickest_touch *q, two_equations *e, const dual *start,
                      double dx, double dy)
{
    const double descent = dx * start->slope[0] + dy * start->slope[1];
    two_equations next = *e;
    dual next_dual = *start;
    double share = 1;
    for (int j = 0; j < STEP_HALVINGS; j++, share /= 2) {
        next.x = e->x + share * dx;
        next.y = e->y + share * dy;
        next_dual = dual_at(q, &next);
        if (next_dual.value <= start->value + 0.1 * share * descent) {
            break;
        }
    }
    *e = next;
    return next_dual;
}

// Finds both multipliers by Newton's method. False if no torques within the limits solve
// the equations.
static bool solve_equations(const quickest_touch *q, two_equations *e)
{
    // The errors that are allowed: without bounds the second derivatives are the sums of
    // the squared gains, so most sqrt(bend) is about what all torques together can do
    two_equations unbounded = *e;
    unbounded.most = HUGE_VAL;
    unbounded.x = unbounded.y = e->x = e->y = 0;
    const dual whole = dual_at(q, &unbounded);
    const double tip_error = TOLERANCE * e->most * sqrt(whole.bend[0]);
    const double force_error = TOLERANCE * e->most * sqrt(whole.bend[2]);

    // from no torque at all
    dual d = dual_at(q, e);
    for (int i = 0; i < NEWTON_STEPS; i++) {
        if (fabs(d.slope[0]) <= tip_error && fabs(d.slope[1]) <= force_error) {
            return true;
        }

        // Newton's step solves [a b; b c] (dx, dy) = -slope; it is regularised so that
        // it exists even with all torques at their bounds
        const double a = d.bend[0] + REGULARISATION * whole.bend[0], b = d.bend[1];
        const double c = d.bend[2] + REGULARISATION * whole.bend[2],
                     determinant = a * c - b * b;
        const double dx = (b * d.slope[1] - c * d.slope[0]) / determinant;
        const double dy = (b * d.slope[0] - a * d.slope[1]) / determinant;
        d = take_step(q, e, &d, dx, dy);
    }
    return false;
}

// --- plans -----------------------------------------------------------------------------

bool quickest_touch_plan(quickest_touch *q, const quickest_task *task)
{
    assert(task->low < task->high);
    if (q->planned && q->left <= FIXED_PERIODS) {
        return true;
    }

    // torques are measured from the middle of the attainable range
    const double middle = (task->low + task->high) / 2;
    const double half_range = (task->high - task->low) / 2;

    // the first plan may take any number of periods, with some torque in reserve; a later
    // one takes those that are left, or a few more
    double most = (1 - RESERVE) * half_range;
    int first = FIXED_PERIODS + 1, last = QUICKEST_PERIODS;
    if (q->planned) {
        most = half_range;
        first = q->left;
        last = q->left + MOST_DELAY;
    }

    // z becomes the state after n periods under the middle torque; the plan is for the
    // first n in which torques about it make up for what z lacks
    double z[ESTIMATOR_STATES];
    memcpy(z, task->z, (size_t)q->flight.n * sizeof z[0]);
    for (int n = 1; n <= last && n <= QUICKEST_PERIODS; n++) {
        sampled_model_step(&q->flight, z, middle);
        two_equations e = {.n = n,
                           .tip = task->wall - row_times_state(q, q->tip, z),
                           .force = task->force - q->force_per_wall * task->wall -
                                    row_times_state(q, q->force, z),
                           .most = most};
        if (n < first || !solve_equations(q, &e)) {
            continue;
        }
        for (int k = 0; k < n; k++) {
            q->torque[k] = middle + torque_at(q, &e, k);
        }
        q->left = n;
        q->planned = true;
        break;
    }
    return q->planned;
}

double quickest_touch_next(quickest_touch *q)
{
    assert(q->left > 0);
    return q->torque[--q->left];
}

// --- from the touch to the wanted force ------------------------------------------------

#define RISEN   0.05 // share of the wanted force within which the rise is over
#define SLOWEST 0.98 // share of the wanted force that a stopping force may lack at most

// The bound at which the force has to begin, NaN where the force of the least cost, end +
// 2 excess, is between the bounds. A bound helps only where it brings the stopping force,
// end + excess, towards the wanted one: the least force has to be below it (or none is
// used), and the greatest above it.
static double first_bound(const force_rise_task *task, double excess)
{
    const double end = task->end;
    const double least = excess > task->least - end ? task->least : 0;
    if (2 * excess < least - end) {
        return least;
    }
    if (2 * excess > task->most - end && excess < task->most - end) {
        return task->most;
    }
    return (double)NAN;
}

force_rise force_rise_begin(const force_rise_task *task)
{
    assert(task->divergence > 0 && task->end > 0 && task->least >= 0);
    const double s = task->divergence, end = task->end;
    double excess = fmax(task->coordinate + task->rate / s - end, -SLOWEST * end);
    force_rise r = {.begun = task->time,
                    .divergence = s,
                    .start = task->coordinate,
                    .end = end,
                    .excess = excess,
                    .bound = first_bound(task, excess)};

    // With the force at a bound the excess y obeys y' = s (y - bound + w), so y - bound +
    // w grows as exp(s t). The force leaves the bound when that of the least cost, w + 2
    // y, has come to it.
    if (!isnan(r.bound)) {
        double bound_excess = r.bound - end;
        excess = bound_excess / 2;
        r.bound_time = plain_log((excess - bound_excess) / (r.excess - bound_excess)) / s;
    }

    // from then on the force differs from the wanted one by 2 y exp(-s t)
    r.time = r.bound_time + plain_log(fmax(1, 2 * fabs(excess) / (RISEN * end))) / s;
    return r;
}

void force_rise_at(const force_rise *r, double time, double motion[3])
{
    const double s = r->divergence, end = r->end;
    double t = time - r->begun, start = r->start, excess = r->excess;

    // At the bound a'' = s^2 (a - bound): a - bound is the sum of a part that grows as
    // exp(s t) and one that decays as exp(-s t), and the excess grows with the first.
    if (r->bound_time > 0) {
        double growth = plain_exp(s * fmin(t, r->bound_time));
        double growing = (excess + end - r->bound) / 2;
        double decaying = start - r->bound - growing;
        start = r->bound + growing * growth + decaying / growth;
        excess = (excess + end - r->bound) * growth + r->bound - end;
        if (t < r->bound_time) {
            motion[0] = start;
            motion[1] = s * (excess + end - start);
            motion[2] = s * s * (start - r->bound);
            return;
        }
        t -= r->bound_time;
    }

    // after that, the course of the least cost (observer_paths.h), with a' = s (x - a)
    // and a'' = s^2 (a - f)
    double decay = plain_exp(-s * t);
    motion[0] = end + (start - end + s * t * excess) * decay;
    motion[1] = s * (end + excess * decay - motion[0]);
    motion[2] = s * s * (motion[0] - end - 2 * excess * decay);
}

bool force_rise_moves(const force_rise *r, double time)
{
    return time - r->begun < r->time;
}
