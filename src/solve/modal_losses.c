#include <math.h>
#include <string.h>

#include "src/solve/modal_loops.h"
#include "src/solve/modal_parts.h"

enum { LEAST_HUB_STEPS = 6 };

#define HUB_TURN   0.75 // of the fastest of them from step to step [rad]
#define LOW_TURN   24   // rate times time up to which modes are taken together
#define SLOW_DECAY 1    // of an overdamped mode until then, which a series takes

// --- walks ------------------------------------------------------------------------------------

// Puts the walk of the first `count` modes at the stride's start.
static void walk_begin(modal_stride *s, int count)
{
    modal_walk *w = &s->walk;
    const size_t whole = ((size_t)count + MODAL_LANES - 1) / MODAL_LANES * MODAL_LANES;
    const size_t size = whole * sizeof(double);
    const int e = s->modes->across;
    w->count = count;
    w->step = w->time = 0;

    // from rest at the stride's start, under its polynomials
    memset(w->x, 0, size);
    memcpy(w->y, s->start, size);
    for (int j = 0; j < MODAL_NODES; j++) {
        memcpy(w->force[j], s->force[j], size);
        memcpy(w->drift[j], s->drift[j], size);
        if (e >= 0 && e < count) {
            w->force[j][e] = w->y[e] = 0;
        }
    }
}

// Sets the length of the walk's steps [s].
static void walk_set_step(modal_stride *s, double step)
{
    if (s->walk.step != step) {
        s->walk.step = step;
        modal_fill_table(s, step, MODAL_NODES, s->walk.count, &s->walk.at);
    }
}

// Takes the walk on by one step.
static void walk_on(modal_stride *s)
{
    modal_walk *w = &s->walk;
    modal_loops_here()->walk(s, w);
    w->time += w->step;
}

// --- losses -----------------------------------------------------------------------------------

// Weights of the products of two polynomials' coefficients in an integral until t.
static void set_weights(modal_weights weights, double t)
{
    static const double factorial[MODAL_NODES] = {1, 1, 2, 6, 24, 120};
    double power = t;
    for (int sum = 0; sum < 2 * MODAL_NODES - 1; sum++) {
        for (int i = 0; i < MODAL_NODES; i++) {
            const int j = sum - i;
            if (j >= 0 && j < MODAL_NODES) {
                weights[i][j] = power / ((sum + 1) * factorial[i] * factorial[j]);
            }
        }
        power *= t;
    }
}

// Integral of the product of two polynomials sum p[j] t^j / j!.
static double product_integral(const double *p, const double *q, modal_weights weights)
{
    double sum = 0;
    for (int i = 0; i < MODAL_NODES; i++) {
        for (int j = 0; j < MODAL_NODES; j++) {
            sum += p[i] * q[j] * weights[i][j];
        }
    }
    return sum;
}

// The hub's velocity without what vibrates fast, beyond the low modes: a series, and decays.
typedef struct hub_motion {
    double power[MODAL_SERIES]; // sum power[j] t^j / j! [rad/s]
    int terms;                  // of them
    modal_decays decays;        // [rad/s]
} hub_motion;

// The polynomial that solves u' + rate u = sum n[j] t^j / j!.
static void settle(double rate, const double *n, double *settled)
{
    const double per_rate = 1 / rate;
    double g = 0;
    for (int j = MODAL_NODES - 1; j >= 0; j--) {
        settled[j] = g = (n[j] - g) * per_rate;
    }
}

// Adds `weight` times u, u' + rate u = n(t) from u = start. Where it hardly decays the series has
// all of it: what it settles at and the decay would be large and of opposite sign.
static void add_decay(hub_motion *h, double rate, double length, double start, const double *n,
                      double weight)
{
    double settled[MODAL_NODES];
    if (rate * length <= SLOW_DECAY) {
        double g = start;
        for (int j = 0; j < MODAL_SERIES; j++) {
            h->power[j] += weight * g;
            g = (j < MODAL_NODES ? n[j] : 0) - rate * g;
        }
        h->terms = MODAL_SERIES;
        return;
    }
    settle(rate, n, settled);
    for (int j = 0; j < MODAL_NODES; j++) {
        h->power[j] += weight * settled[j];
    }
    h->decays.now[h->decays.count] = weight * (start - settled[0]);
    h->decays.rate[h->decays.count++] = rate;
}

// Adds an overdamped mode: u = x' + fast x and v = x' + slow x decay at slow and fast, and
// x' = (fast v - slow u) / (fast - slow). What v begins with is over in no time; returns the loss
// in that.
static double add_overdamped(const modal_stride *s, int k, double length, hub_motion *h)
{
    const double hub = s->modes->by_dof[k], damping = s->damping[k], rate = s->modes->rate[k];
    const double root = fmax(sqrt((damping - rate) * (damping + rate)), 1e-4 * rate);
    const double slow = rate * rate / (damping + root), fast = damping + root;
    const double per = 1 / (fast - slow), speed = s->start[k] + s->drift[0][k];
    double n[MODAL_NODES], settled[MODAL_NODES];
    for (int j = 0; j < MODAL_NODES; j++) {
        const double turn = j + 1 < MODAL_NODES ? s->drift[j + 1][k] : 0;
        n[j] = s->force[j][k] + 2 * damping * s->drift[j][k] + turn;
    }

    add_decay(h, slow, length, speed, n, -hub * slow * per);
    settle(fast, n, settled);
    for (int j = 0; j < MODAL_NODES; j++) {
        h->power[j] += hub * fast * per * settled[j];
    }
    const double lost = fast * per * (speed - settled[0]);
    return s->viscous[k] * lost * lost * (1 - modal_decay(-2 * fast * length)) / (2 * fast);
}

// Adds a mode that is not a low one; returns the loss of its own that is in its vibration alone.
static double add_to_hub(const modal_stride *s, int k, const modal_mode_losses *losses,
                         hub_motion *h)
{
    const double hub = s->modes->by_dof[k], damping = s->damping[k];
    if (damping >= s->modes->rate[k]) {
        return add_overdamped(s, k, losses->time, h);
    }
    for (int j = 0; j + 1 < MODAL_NODES; j++) {
        h->power[j] += hub * s->followed[j + 1][k];
    }
    return damping > 0 ? losses->vibrating[k] * s->viscous[k] / (2 * damping) : 0;
}

// What the hub's viscous damping takes from the low modes and the rest's slow motion together: the
// trapezoidal rule with corrected ends on a walk that resolves them.
static double hub_loss(modal_stride *s, const arm *a, double t, int low, hub_motion *rest)
{
    const modal_loops *loops = modal_loops_here();
    const double *hub = s->modes->by_dof;
    double sum = 0, first_slope = 0, last_slope = 0;
    modal_walk *w = &s->walk;

    // hub's velocity and its slope from step to step
    walk_begin(s, low);
    const double turn = low > 0 ? s->modes->rate[low - 1] * t : 0;
    const int steps = (int)fmax(LEAST_HUB_STEPS, ceil(turn / HUB_TURN));
    walk_set_step(s, t / steps);
    modal_decays *decays = &rest->decays;
    for (int k = 0; k < decays->count; k++) {
        decays->factor[k] = modal_decay(-decays->rate[k] * w->step);
    }
    for (int k = decays->count; k % MODAL_LANES != 0; k++) {
        decays->now[k] = decays->rate[k] = decays->factor[k] = 0;
    }
    for (int i = 0; i <= steps; i++) {
        const double x = w->time;
        double speed = 0, slope = 0, power = 1;
        for (int j = 0; j < rest->terms; j++) {
            speed += power * rest->power[j];
            slope += j + 1 < rest->terms ? power * rest->power[j + 1] : 0;
            power *= x / (j + 1);
        }
        const glance decaying = loops->decay(decays);
        speed += decaying.value;
        slope += decaying.slope;
        for (int k = 0; k < low; k++) {
            const double rate = s->modes->rate[k];
            speed += hub[k] * (w->y[k] + w->drift[0][k]);
            slope += hub[k] * (w->force[0][k] + w->drift[1][k] - rate * rate * w->x[k] -
                               2 * s->damping[k] * w->y[k]);
        }
        sum += (i == 0 || i == steps ? 0.5 : 1) * speed * speed;
        first_slope = i == 0 ? 2 * speed * slope : first_slope;
        last_slope = 2 * speed * slope;
        if (i < steps) {
            walk_on(s);
        }
    }

    return a->motor.damping * w->step * (sum + w->step * (first_slope - last_slope) / 12);
}

modal_losses modal_stride_losses(modal_stride *s, const arm *a, double t)
{
    const int e = s->modes->across;
    modal_losses lost = {0};

    // modes slow enough to be taken together
    int low = 0;
    while (low < s->count && low != e && s->modes->rate[low] * t < LOW_TURN &&
           s->damping[low] * t < LOW_TURN) {
        low++;
    }

    // the hub's motion beyond them
    const ptrdiff_t row = s->row;
    hub_motion rest = {
        .terms = MODAL_NODES,
        .decays = {.now = s->columns, .rate = s->columns + row, .factor = s->columns + 2 * row}};
    for (int j = 0; e >= 0 && j < MODAL_NODES; j++) {
        rest.power[j] = s->modes->by_dof[e] * s->drift[j][e];
    }

    // mode by mode
    modal_mode_losses losses = {
        .time = t, .all = s->more_columns, .vibrating = s->more_columns + row};
    set_weights(losses.weights, t);
    modal_loops_here()->losses(s, &losses);
    for (int k = 0; k < s->count; k++) {
        const double rate = s->modes->rate[k], twice = 2 * s->damping[k];
        if (k == e || twice == 0) {
            continue;
        }

        // in the springs, and at the hub beyond what the slow modes do together
        lost.damping += losses.all[k] * s->per_stiffness * rate * rate / twice;
        if (a->motor.damping > 0 && k >= low) {
            lost.viscous += add_to_hub(s, k, &losses, &rest);
        }
    }

    // that vector's own, and the slow modes' at the hub
    if (e >= 0) {
        double across[MODAL_NODES];
        for (int j = 0; j < MODAL_NODES; j++) {
            across[j] = s->drift[j][e];
        }
        lost.damping +=
            s->per_stiffness * s->modes->stiff * product_integral(across, across, losses.weights);
    }
    lost.viscous += a->motor.damping > 0 ? hub_loss(s, a, t, low, &rest) : 0;
    return lost;
}
