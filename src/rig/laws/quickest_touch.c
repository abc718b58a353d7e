#include "src/rig/laws/quickest_touch.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum {
    LATER = 2,       // periods by which a plan may be put off
    FIXED = 1,       // periods that leave nothing to choose
    MOST_STEPS = 30, // of Newton's method,
    HALVINGS = 8     // and of each of them
};
#define RESERVE 0.2  // share of the torque that the first plan keeps
#define NEAR    1e-6 // of what all torques can do, by which an equation may be missed
#define DAMPED  1e-6 // share of the unbounded Hessian that is added to it

// State after a period under a torque.
static void fly(const quickest_touch *q, double *z, double torque)
{
    const int n = q->flight.n;
    double next[ESTIMATOR_STATES];
    for (int i = 0; i < n; i++) {
        next[i] = q->flight.b[i] * torque;
        for (int j = 0; j < n; j++) {
            next[i] += q->flight.a[i][j] * z[j];
        }
    }
    memcpy(z, next, (size_t)n * sizeof z[0]);
}

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
    assert(q != NULL && d != NULL);
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
        fly(q, z, k == 0 ? 1 : 0);
        q->tip_gain[k] = sum_of(q, q->tip, z);
        q->force_gain[k] = sum_of(q, q->force, z);
    }
}

// --- torques for both equations -----------------------------------------------------------------

// The torques T_k = clip(x tip_gain_k + y force_gain_k) of n periods have the least sum of squares
// of all within the limits that add as much to tip and F; x and y are the multipliers of both
// equations.
typedef struct two_equations {
    int n;
    double tip, force; // to be added [rad], [N]
    double most;       // torque, either way [N m]
    double x, y;
} two_equations;

// The dual function, which is minimised over x and y: convex, quadratic between the bounds.
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
        const double a = q->tip_gain[k], b = q->force_gain[k], torque = torque_at(q, e, k);
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

// Finds both multipliers by Newton's method. False if no torques do it.
static bool solve(const quickest_touch *q, two_equations *e)
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

        // Newton's step, regularised so that it exists even with all torques at their bounds
        const double a = d.bend[0] + DAMPED * whole.bend[0], b = d.bend[1];
        const double c = d.bend[2] + DAMPED * whole.bend[2], determinant = a * c - b * b;
        const double dx = (b * d.slope[1] - c * d.slope[0]) / determinant;
        const double dy = (b * d.slope[0] - a * d.slope[1]) / determinant;
        const double descent = dx * d.slope[0] + dy * d.slope[1];

        // as much of it as lowers the function
        two_equations next = *e;
        dual there = d;
        double share = 1;
        for (int j = 0; j < HALVINGS; j++, share /= 2) {
            next.x = e->x + share * dx;
            next.y = e->y + share * dy;
            there = dual_at(q, &next);
            if (there.value <= d.value + 0.1 * share * descent) {
                break;
            }
        }
        *e = next;
        d = there;
    }
    return false;
}

// --- plans --------------------------------------------------------------------------------------

bool quickest_touch_plan(quickest_touch *q, const quickest_task *task)
{
    assert(q != NULL && task != NULL && task->low < task->high);
    if (q->planned && q->left <= FIXED) {
        return true;
    }

    // torques are measured from the middle of the attainable range
    const double middle = (task->low + task->high) / 2, half = (task->high - task->low) / 2;
    const double most = q->planned ? half : (1 - RESERVE) * half;
    const int first = q->planned ? q->left : FIXED + 1;
    const int last = q->planned ? q->left + LATER : QUICKEST_PERIODS;

    // the first number of periods that is enough
    double z[ESTIMATOR_STATES];
    memcpy(z, task->z, (size_t)q->flight.n * sizeof z[0]);
    for (int n = 1; n <= last && n <= QUICKEST_PERIODS; n++) {
        fly(q, z, middle);
        two_equations e = {.n = n,
                           .tip = task->wall - sum_of(q, q->tip, z),
                           .force = task->force - q->force_per_wall * task->wall -
                                    sum_of(q, q->force, z),
                           .most = most};
        if (n < first || !solve(q, &e)) {
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
    assert(q != NULL && q->left > 0);
    return q->torque[--q->left];
}
