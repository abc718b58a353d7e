#include "src/rig/laws/observer_paths.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "src/base/plain_math.h"

// --- an approach that leaves no vibration ----------------------------------------------

// Share of a change of speed after which the next one may begin. An early one asks for a
// brisk start, which shows what arm it is; what the arm then falls short by is made at
// the speed of the touch, which takes long where that is slow.
#define EARLY      0.3
#define LATE       0.7
#define FAST_TOUCH 0.3 // speed from which a touch of two links is fast [rad/s]

// The plan from a rotation at a speed, without vibration, all changes still to be made.
static void plan_from(smooth_approach *p, const observer_design *d, double speed)
{
    const mode_set *set = &d->observer.arm.free;
    memset(p->state, 0, sizeof p->state);
    for (int i = 0; i < set->count; i++) {
        p->state[set->count + i] = set->momentum[i] * speed;
    }
    p->from = speed;
    p->changing[0] = p->changing[1] = 0;
}

double smooth_approach_speed(const smooth_approach *p, const observer_design *d)
{
    const mode_set *set = &d->observer.arm.free;
    return p->state[set->count] / set->momentum[0];
}

// Share of a change of speed that is made after a time: the integral of a trapezoid,
// which is one vibration's period as a box convolved with the next one's.
static double share_changed(const observer_design *d, double t)
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
    // the torque of the changes of speed under way, as its mean over the period
    const int changes = p->slows ? 2 : 1;
    double torque = 0;
    for (int i = 0; i < changes; i++) {
        double before = share_changed(d, p->changing[i]);
        p->changing[i] += p->period;
        torque += (share_changed(d, p->changing[i]) - before) * p->change[i];
    }
    torque *= d->observer.arm.inertia / p->period;

    // the arm under that
    sampled_model_step(&d->plan_model, p->state, torque);
    return torque;
}

// How far the tip goes at most beyond where a change of the rotation's speed by -1 rad/s
// to rest ends, as the beam bends on [s].
static double swing_beyond(const smooth_approach *p, const observer_design *d)
{
    const mode_set *set = &d->observer.arm.free;
    smooth_approach stop = {.period = p->period, .change = {-1}};
    double most = -HUGE_VAL, tip = 0;
    plan_from(&stop, d, 1);
    while (stop.changing[0] < d->ramp_time) {
        smooth_approach_follow(&stop, d);
        tip = 0;
        for (int i = 0; i < set->count; i++) {
            tip += set->tip[i] * stop.state[i];
        }
        most = fmax(most, tip);
    }
    return most - tip;
}

void smooth_approach_begin(smooth_approach *p, const observer_design *d, double angle)
{
    assert(p->period > 0);
    const double T = d->ramp_time, soft = d->arrival_speed, beyond = swing_beyond(p, d);
    const double room = p->guarded - angle - soft * (T / 2 - beyond);

    // from rest to the cruising speed
    if (!(p->overlap > 0)) {
        const bool fast = d->observer.arm.free.count == 2 && soft > FAST_TOUCH;
        if (fast) {
            p->overlap = EARLY;
        } else {
            p->overlap = LATE;
        }
    }
    p->start_angle = angle;
    p->change[0] = fmax(soft, fmin(d->top_speed, room / (p->overlap * T + beyond)));
    p->change[1] = 0;
    p->beyond = beyond * (p->change[0] - soft);
    p->slows = !(p->change[0] > soft);
    plan_from(p, d, 0);
}

void smooth_approach_slow(smooth_approach *p, const observer_design *d, double tip,
                          double turned)
{
    const double T = d->ramp_time, cruise = p->change[0], soft = d->arrival_speed;
    if (!p->slows && p->changing[0] >= p->overlap * T) {
        const double unmade = fmax(0, T - p->changing[0]);
        const double way =
            cruise * (T - unmade * unmade / (2 * T)) + (soft - cruise) * T / 2;
        // what speeds the beam up still bends it back where the next change is early
        const double at = p->overlap < LATE ? turned : tip;
        if (p->guarded - p->beyond - at <= way) {
            p->slows = true;
            p->change[1] = soft - cruise;
        }
    } else if (p->slows && !p->searches && tip > p->passed && p->changing[1] >= T) {
        // the wall is further than believed
        p->searches = true;
        p->from = soft;
        p->change[0] = d->touch_speed - soft;
        p->change[1] = p->changing[0] = p->changing[1] = 0;
    }
}

void smooth_approach_restart(smooth_approach *p, const observer_design *d)
{
    const double first = p->changing[0], second = p->changing[1];
    const bool slows = p->slows;
    if (!slows) {
        smooth_approach_begin(p, d, p->start_angle);
    }
    plan_from(p, d, p->from);
    while (p->changing[0] < first) {
        p->slows = slows && p->changing[0] > first - second - p->period / 2;
        smooth_approach_follow(p, d);
    }
    p->slows = slows;
}

// --- the quickest touch ----------------------------------------------------------------

enum {
    LATER = 2,       // periods by which a plan may be put off
    FIXED = 1,       // periods that leave nothing to choose
    MOST_STEPS = 30, // of Newton's method,
    HALVINGS = 8     // and of each of them
};
#define RESERVE 0.2  // share of the torque that the first plan keeps
#define NEAR    1e-6 // of what all torques can do, by which an equation may be missed
#define DAMPED  1e-6 // share of the unbounded Hessian that is added to it

static double sum_of(const quickest_touch *q, const double *row, const double *z)
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
    q->flight = d->flight_model;

    // what the touch makes of the state
    const double scale = contact->square[0] / (contact->hub[0] * arm->length);
    for (int i = 0; i < n; i++) {
        q->tip[i] = set->tip[i];
        q->force[i] = scale * arm->touch[0][i];
        q->force[n + i] = q->force[i] / d->divergence;
    }
    q->force_per_wall = -scale * contact->momentum[0];

    // and what each torque adds to that
    double z[ESTIMATOR_STATES] = {0};
    for (int k = 0; k < QUICKEST_PERIODS; k++) {
        sampled_model_step(&q->flight, z, k == 0 ? 1 : 0);
        q->tip_gain[k] = sum_of(q, q->tip, z);
        q->force_gain[k] = sum_of(q, q->force, z);
    }
}

// --- torques for both equations --------------------------------------------------------

// The torques T_k = clip(x tip_gain_k + y force_gain_k) of n periods have the least sum
// of squares of all within the limits that add as much to tip and F; x and y are the
// multipliers of both equations.
typedef struct two_equations {
    int n;
    double tip, force; // to be added [rad], [N]
    double most;       // torque, either way [N m]
    double x, y;
} two_equations;

// The dual function, which is minimised over x and y: convex, quadratic between the
// bounds.
typedef struct dual {
    double value, slope[2], bend[3]; // bend: second derivatives xx, xy, yy
} dual;

static double torque_at(const quickest_touch *q, const two_equations *e, int k)
{
    double free = e->x * q->tip_gain[k] + e->y * q->force_gain[k];
    return fmax(-e->most, fmin(free, e->most));
}

static dual dual_at(const quickest_touch *q, const two_equations *e)
{
    dual d = {.value = -e->x * e->tip - e->y * e->force, .slope = {-e->tip, -e->force}};
    for (int k = 0; k < e->n; k++) {
        const double a = q->tip_gain[k], b = q->force_gain[k],
                     torque = torque_at(q, e, k);
        d.value += torque * (e->x * a + e->y * b - torque / 2);
        d.slope[0] += torque * a;
        d.slope[1] += torque * b;
        if (fabs(torque) < e->most) {
            d.bend[0] += a * a;
            d.bend[1] += a * b;
            d.bend[2] += b * b;
        }
    }
    return d;
}

// As much of a step (dx, dy) as lowers the dual function by a tenth of what its slope
// promises, at least a 128th of it.
static dual take_step(const quickest_touch *q, two_equations *e, const dual *now,
                      double dx, double dy)
{
    const double descent = dx * now->slope[0] + dy * now->slope[1];
    two_equations next = *e;
    dual there = *now;
    double share = 1;
    for (int j = 0; j < HALVINGS; j++, share /= 2) {
        next.x = e->x + share * dx;
        next.y = e->y + share * dy;
        there = dual_at(q, &next);
        if (there.value <= now->value + 0.1 * share * descent) {
            break;
        }
    }
    *e = next;
    return there;
}

// Finds both multipliers by Newton's method. False if no torques do it.
static bool solve_equations(const quickest_touch *q, two_equations *e)
{
    // scales of both equations
    two_equations unbounded = *e;
    unbounded.most = HUGE_VAL;
    unbounded.x = unbounded.y = e->x = e->y = 0;
    const dual whole = dual_at(q, &unbounded);
    const double near_tip = NEAR * e->most * sqrt(whole.bend[0]);
    const double near_force = NEAR * e->most * sqrt(whole.bend[2]);

    dual d = dual_at(q, e);
    for (int i = 0; i < MOST_STEPS; i++) {
        if (fabs(d.slope[0]) <= near_tip && fabs(d.slope[1]) <= near_force) {
            return true;
        }

        // Newton's step, regularised so that it exists even with all torques at their
        // bounds
        const double a = d.bend[0] + DAMPED * whole.bend[0], b = d.bend[1];
        const double c = d.bend[2] + DAMPED * whole.bend[2], determinant = a * c - b * b;
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
    if (q->planned && q->left <= FIXED) {
        return true;
    }

    // torques are measured from the middle of the attainable range
    const double middle = (task->low + task->high) / 2,
                 half = (task->high - task->low) / 2;
    const double most = q->planned ? half : (1 - RESERVE) * half;
    const int first = q->planned ? q->left : FIXED + 1;
    const int last = q->planned ? q->left + LATER : QUICKEST_PERIODS;

    // the first number of periods that is enough
    double z[ESTIMATOR_STATES];
    memcpy(z, task->z, (size_t)q->flight.n * sizeof z[0]);
    for (int n = 1; n <= last && n <= QUICKEST_PERIODS; n++) {
        sampled_model_step(&q->flight, z, middle);
        two_equations e = {.n = n,
                           .tip = task->wall - sum_of(q, q->tip, z),
                           .force = task->force - q->force_per_wall * task->wall -
                                    sum_of(q, q->force, z),
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
#define SLOWEST 0.98 // share of the wanted force that a motion may lack at most

// The force that it has to begin with, NaN where it may begin as it costs least.
static double first_bound(const force_rise_task *task, double off)
{
    const double end = task->end, least = off > task->least - end ? task->least : 0;
    if (2 * off < least - end) {
        return least;
    }
    if (2 * off > task->most - end && off < task->most - end) {
        return task->most;
    }
    return (double)NAN;
}

force_rise force_rise_begin(const force_rise_task *task)
{
    assert(task->divergence > 0 && task->end > 0 && task->least >= 0);
    const double s = task->divergence, end = task->end;
    double off = fmax(task->coordinate + task->rate / s - end, -SLOWEST * end);
    force_rise r = {.begun = task->time,
                    .divergence = s,
                    .from = task->coordinate,
                    .end = end,
                    .off = off,
                    .bound = first_bound(task, off)};

    // at a bound y' = s (y - bound + w), until twice y is what the bound leaves
    if (!isnan(r.bound)) {
        double left = r.bound - end;
        off = left / 2;
        r.bounded = plain_log((off - left) / (r.off - left)) / s;
    }
    r.time = r.bounded + plain_log(fmax(1, 2 * fabs(off) / (RISEN * end))) / s;
    return r;
}

void force_rise_at(const force_rise *r, double time, double way[3])
{
    const double s = r->divergence, end = r->end;
    double t = time - r->begun, from = r->from, off = r->off;

    // at the bound, a'' = s^2 (a - bound)
    if (r->bounded > 0) {
        double grown = plain_exp(s * fmin(t, r->bounded));
        double growing = (off + end - r->bound) / 2, dying = from - r->bound - growing;
        from = r->bound + growing * grown + dying / grown;
        off = (off + end - r->bound) * grown + r->bound - end;
        if (t < r->bounded) {
            way[0] = from;
            way[1] = s * (off + end - from);
            way[2] = s * s * (from - r->bound);
            return;
        }
        t -= r->bounded;
    }

    // and then as it costs least
    double kept = plain_exp(-s * t);
    way[0] = end + (from - end + s * t * off) * kept;
    way[1] = s * (end + off * kept - way[0]);
    way[2] = s * s * (way[0] - end - 2 * off * kept);
}

bool force_rise_moves(const force_rise *r, double time)
{
    return time - r->begun < r->time;
}
